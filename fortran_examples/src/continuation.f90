!> Response over a range of frequencies by pseudo-arc-length continuation.
!>
!> The path is followed in relative changes: the displacements of each contact are measured by their present size and
!> the frequency by a part of its range. So a step means the same on a sharp resonance and far from it, and a stuck
!> contact counts as much as one that slides a thousand times farther.
module continuation
  use dense_algebra, only: solve
  use harmonic_balance, only: balance_point, balance_problem, evaluate, newton_error, solve_from_rest
  use kinds, only: pi, wp
  use messages, only: fail, text
  implicit none
  private
  public :: follow_response

  type, public :: step_control
    real(wp) :: max_step = 0.2_wp          !! relative change of the displacements in one step
    real(wp) :: min_step = 1.0e-6_wp
    integer :: max_points = 5000
    integer :: steps_over_range = 40       !! fewest steps for the whole range of frequencies
  end type step_control

  type, public :: response_path
    integer :: points = 0
    real(wp), allocatable :: omega(:)
    real(wp), allocatable :: displacement(:,:,:)   !! (coefficient, contact, point)
  end type response_path

  integer, parameter :: corrector_steps = 12, few_steps = 3, many_steps = 6
  real(wp), parameter :: min_tangent_cosine = 0.9_wp

contains

  !> From `omega_from` to `omega_to`, in either direction.
  subroutine follow_response(problem, omega_from, omega_to, control, path)
    type(balance_problem), intent(inout) :: problem
    real(wp), intent(in) :: omega_from, omega_to
    type(step_control), intent(in) :: control
    type(response_path), intent(out) :: path
    type(balance_point) :: point
    real(wp), allocatable :: u(:,:), scale(:), tangent(:), previous(:)
    real(wp) :: omega, step, direction
    logical :: converged
    integer :: m, contacts, iterations

    m = 2 * problem%harmonics + 1
    contacts = size(problem%incidence, 2)
    direction = sign(1.0_wp, omega_to - omega_from)
    allocate (u(m, contacts), tangent(m * contacts + 1), previous(m * contacts + 1), scale(m * contacts + 1))
    allocate (path%omega(control%max_points), path%displacement(m, contacts, control%max_points))

    omega = omega_from
    call solve_from_rest(problem, omega, u, point, converged)
    if (.not. converged) call fail('no harmonic balance found at the first frequency, '//hertz(omega))
    call keep()
    call measure()
    previous = 0.0_wp
    previous(m * contacts + 1) = direction
    call path_tangent()

    step = 0.1_wp * control%max_step
    do while (direction * (omega - omega_to) < 0.0_wp)
      call advance()
      if (converged) then
        call keep()
        if (iterations <= few_steps) step = min(1.5_wp * step, control%max_step)
        if (iterations >= many_steps) step = 0.6_wp * step
      else
        step = 0.4_wp * step
        if (step < control%min_step) call fail('the continuation stops at '//hertz(omega)//': step too small')
      end if
    end do

  contains

    subroutine keep()
      if (path%points == control%max_points) then
        call fail('the continuation stops at '//hertz(omega)//': more than '//text(control%max_points)//' points')
      end if
      path%points = path%points + 1
      path%omega(path%points) = omega
      path%displacement(:, :, path%points) = u
    end subroutine keep

    !> Lengths by which the unknowns are measured, at the present point.
    subroutine measure()
      integer :: i

      do i = 1, contacts
        scale((i - 1) * m + 1:i * m) = sqrt(real(contacts, wp)) * max(norm2(u(:, i)), 1.0e-6_wp * norm2(u))
      end do
      scale(m * contacts + 1) = abs(omega_to - omega_from) / (control%steps_over_range * control%max_step)
    end subroutine measure

    !> Unit tangent of the path at the present point, on the side of `previous`.
    subroutine path_tangent()
      real(wp) :: right(m * contacts + 1, 1)
      logical :: singular

      right = 0.0_wp
      right(m * contacts + 1, 1) = 1.0_wp
      call bordered_solve(previous, right, singular)
      if (singular) call fail('the path has no tangent at '//hertz(omega))
      tangent = right(:, 1) / norm2(right)
      if (dot_product(tangent, previous) < 0.0_wp) tangent = -tangent
    end subroutine path_tangent

    !> Solves [dR/du dR/domega; border] x = right, in scaled unknowns, at `point`.
    subroutine bordered_solve(border, right, singular)
      real(wp), intent(in) :: border(:)
      real(wp), intent(inout) :: right(:,:)
      logical, intent(out) :: singular
      real(wp) :: matrix(m * contacts + 1, m * contacts + 1)
      integer :: n, i

      n = m * contacts
      do i = 1, n
        matrix(:n, i) = point%jacobian(:, i) * scale(i) / scale(:n)
      end do
      matrix(:n, n + 1) = reshape(point%by_omega, [n]) * scale(n + 1) / scale(:n)
      matrix(n + 1, :) = border
      call solve(matrix, right, singular)
    end subroutine bordered_solve

    !> One step of length `step`: predictor along the tangent, corrector in the plane across it. Unless it converges
    !> without too sharp a turn, everything stays as it was.
    subroutine advance()
      real(wp) :: u_start(m, contacts), omega_start, across, right(m * contacts + 1, 1)
      real(wp) :: tangent_start(m * contacts + 1)
      logical :: singular
      integer :: n

      n = m * contacts
      u_start = u
      omega_start = omega
      tangent_start = tangent
      u = u + reshape(step * tangent(:n) * scale(:n), shape(u))
      omega = omega + step * tangent(n + 1) * scale(n + 1)
      do iterations = 1, corrector_steps
        call evaluate(problem, omega, u, point)
        converged = newton_error(problem, u, point) <= 1.0_wp
        if (converged) exit
        across = dot_product(tangent(:n), reshape(u - u_start, [n]) / scale(:n)) &
                 + tangent(n + 1) * (omega - omega_start) / scale(n + 1) - step
        right(:n, 1) = -reshape(point%residual, [n]) / scale(:n)
        right(n + 1, 1) = -across
        call bordered_solve(tangent, right, singular)
        if (singular .or. norm2(right) > 10.0_wp) exit
        u = u + reshape(right(:n, 1) * scale(:n), shape(u))
        omega = omega + right(n + 1, 1) * scale(n + 1)
      end do

      if (converged) then
        previous = tangent
        call path_tangent()
        converged = dot_product(tangent, previous) >= min_tangent_cosine .or. step <= 10.0_wp * control%min_step
      end if
      if (converged) then
        ! The tangent is kept in unknowns, so that it may be measured anew at the new point.
        tangent = tangent * scale
        call measure()
        tangent = tangent / scale
        tangent = tangent / norm2(tangent)
        previous = tangent
      else
        u = u_start
        omega = omega_start
        tangent = tangent_start
      end if
    end subroutine advance
  end subroutine follow_response

  function hertz(omega) result(string)
    real(wp), intent(in) :: omega
    character(len=:), allocatable :: string

    string = text(omega / (2.0_wp * pi), '(f12.3)')//' Hz'
  end function hertz
end module continuation
