!> Response over a range of frequencies by pseudo-arc-length continuation, and its resonance peak.
!>
!> Arc length is measured in relative changes: the displacements of each contact are scaled by their present size, vibration and
!> mean apart, and the frequency by a fraction of its range. So a step means the same on a sharp resonance and far from it, and a stuck contact
!> counts as much as one that slides a thousand times farther.
module continuation
  use basics, only: fail, pi, text, wp
  use dense_algebra, only: solve
  use fourier_series, only: series_peak
  use harmonic_balance, only: balance_point, balance_problem, evaluate, newton_error, solve_at, solve_from_rest, &
    structure_response
  implicit none
  private
  public :: follow_response, refine_peak

  type, public :: response_path
    integer :: points = 0
    real(wp), allocatable :: omega(:)
    real(wp), allocatable :: displacement(:,:,:)   !! (coefficient, contact, point)
  end type response_path

  ! Relative change of the displacements in one step; fewest steps over the whole range of frequencies.
  real(wp), parameter :: max_step = 0.2_wp, min_step = 1.0e-6_wp
  integer, parameter :: steps_over_range = 40, max_points = 5000
  integer, parameter :: corrector_steps = 12, few_steps = 3, many_steps = 6
  real(wp), parameter :: min_tangent_cosine = 0.9_wp

contains

  !> From `omega_from` to `omega_to`.
  subroutine follow_response(problem, omega_from, omega_to, path)
    type(balance_problem), intent(inout) :: problem
    real(wp), intent(in) :: omega_from, omega_to
    type(response_path), intent(out) :: path
    type(balance_point) :: point
    real(wp), allocatable :: u(:,:), scale(:), tangent(:), previous(:)
    real(wp) :: omega, step
    logical :: converged
    integer :: m, contacts, iterations

    m = 2 * problem%harmonics + 1
    contacts = size(problem%contacts%items)
    allocate (u(m, contacts), tangent(m * contacts + 1), previous(m * contacts + 1), scale(m * contacts + 1))
    allocate (path%omega(max_points), path%displacement(m, contacts, max_points))

    omega = omega_from
    call solve_from_rest(problem, omega, u, point, converged)
    if (.not. converged) call fail('no harmonic balance found at the first frequency, '//hertz(omega))
    call append()
    call set_scale()
    previous = 0.0_wp
    previous(m * contacts + 1) = 1.0_wp
    call path_tangent()
    step = 0.1_wp * max_step
    do while (omega < omega_to)
      call advance(step)
      if (converged) then
        call append()
        if (iterations <= few_steps) step = min(1.5_wp * step, max_step)
        if (iterations >= many_steps) step = 0.6_wp * step
      else
        step = 0.4_wp * step
      end if
      if (step < min_step) call fail('the continuation stops at '//hertz(omega)//': no tangent leads on')
    end do

  contains

    subroutine append()
      if (path%points == max_points) then
        call fail('the continuation stops at '//hertz(omega)//': more than '//text(max_points)//' points')
      end if
      path%points = path%points + 1
      path%omega(path%points) = omega
      path%displacement(:, :, path%points) = u
    end subroutine append

    !> Scale of each unknown at the present point.
    subroutine set_scale()
      real(wp) :: vibration
      integer :: i

      do i = 1, contacts
        vibration = max(norm2(u(2:, i)), 1.0e-6_wp * norm2(u(2:, :)))
        scale((i - 1) * m + 1) = max(abs(u(1, i)), vibration)
        scale((i - 1) * m + 2:i * m) = vibration
      end do
      scale(:m * contacts) = sqrt(real(contacts, wp)) * scale(:m * contacts)
      scale(m * contacts + 1) = (omega_to - omega_from) / (steps_over_range * max_step)
    end subroutine set_scale

    !> Unit tangent of the path at the present point, in the direction of `previous`.
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

    !> One step of this length: predictor along the tangent, corrector in the plane normal to it. If it does not converge, or the
    !> path bends too sharply, the start is restored.
    subroutine advance(length)
      real(wp), intent(in) :: length
      real(wp) :: u_start(m, contacts), omega_start, distance, right(m * contacts + 1, 1)
      real(wp) :: tangent_start(m * contacts + 1)
      logical :: singular
      integer :: n

      n = m * contacts
      u_start = u
      omega_start = omega
      tangent_start = tangent
      u = u + reshape(length * tangent(:n) * scale(:n), shape(u))
      omega = omega + length * tangent(n + 1) * scale(n + 1)
      do iterations = 1, corrector_steps
        call evaluate(problem, omega, u, point)
        converged = newton_error(problem, u, point) <= 1.0_wp
        if (converged) exit
        distance = dot_product(tangent(:n), reshape(u - u_start, [n]) / scale(:n)) &
                 + tangent(n + 1) * (omega - omega_start) / scale(n + 1) - length
        right(:n, 1) = -reshape(point%residual, [n]) / scale(:n)
        right(n + 1, 1) = -distance
        call bordered_solve(tangent, right, singular)
        if (singular .or. norm2(right) > 10.0_wp) exit
        u = u + reshape(right(:n, 1) * scale(:n), shape(u))
        omega = omega + right(n + 1, 1) * scale(n + 1)
      end do

      if (converged) then
        previous = tangent
        call path_tangent()
        converged = dot_product(tangent, previous) >= min_tangent_cosine .or. length <= 10.0_wp * min_step
      end if
      if (converged) then
        ! The same direction in the scale of the new point.
        tangent = tangent * scale
        call set_scale()
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

  !> Resonance peak between the points of a path, on finer and finer grids of frequencies. `amplitude` has the peak over the period
  !> of degree of freedom `dof` at every point. If the frequency is not monotonic around the largest point, that point is the result.
  subroutine refine_peak(problem, path, amplitude, dof, omega, displacement)
    type(balance_problem), intent(inout) :: problem
    type(response_path), intent(in) :: path
    real(wp), intent(in) :: amplitude(:)
    integer, intent(in) :: dof
    real(wp), intent(out) :: omega, displacement(:,:)
    integer, parameter :: grids = 8, intervals = 10
    type(balance_point) :: point
    real(wp) :: response(2 * problem%harmonics + 1, size(problem%excitation)), trial(size(displacement, 1), size(displacement, 2))
    real(wp) :: first, interval, largest
    logical :: converged
    integer :: top, grid, i

    top = maxloc(amplitude, dim=1)
    omega = path%omega(top)
    displacement = path%displacement(:, :, top)
    if (top == 1 .or. top == path%points) return
    if (path%omega(top - 1) >= omega .or. omega >= path%omega(top + 1)) return
    largest = amplitude(top)
    first = path%omega(top - 1)
    interval = (path%omega(top + 1) - first) / intervals
    do grid = 1, grids
      do i = 1, intervals - 1
        trial = displacement
        call solve_at(problem, first + i * interval, trial, point, converged)
        if (.not. converged) cycle
        response = structure_response(problem, point)
        if (series_peak(response(:, dof)) <= largest) cycle
        largest = series_peak(response(:, dof))
        omega = first + i * interval
        displacement = trial
      end do
      first = omega - interval
      interval = 2.0_wp * interval / intervals
    end do
  end subroutine refine_peak

  function hertz(omega) result(string)
    real(wp), intent(in) :: omega
    character(len=:), allocatable :: string

    string = text(omega / (2.0_wp * pi), '(f12.3)')//' Hz'
  end function hertz
end module continuation
