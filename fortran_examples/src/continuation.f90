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
  public :: follow_response, refine_peak, solve_within

  type, public :: response_path
    integer :: points = 0
    real(wp), allocatable :: omega(:)
    real(wp), allocatable :: displacement(:,:,:)   !! (coefficient, component, point)
  end type response_path

  ! Relative change of the displacements in one step; fewest steps over the whole range of frequencies.
  real(wp), parameter :: max_step = 0.2_wp, min_step = 1.0e-6_wp
  integer, parameter :: steps_over_range = 40, max_points = 5000
  integer, parameter :: corrector_steps = 12, few_steps = 3, many_steps = 6
  real(wp), parameter :: min_tangent_cosine = 0.9_wp

contains

  !> From `omega_from` to `omega_to`, in either direction.
  subroutine follow_response(problem, omega_from, omega_to, path)
    type(balance_problem), intent(inout) :: problem
    real(wp), intent(in) :: omega_from, omega_to
    type(response_path), intent(out) :: path
    type(balance_point) :: point
    real(wp), allocatable :: u(:,:), scale(:), tangent(:), previous(:)
    real(wp) :: omega, step, direction
    logical :: converged
    integer :: m, components, iterations

    m = 2 * problem%harmonics + 1
    components = size(problem%incidence, 2)
    direction = sign(1.0_wp, omega_to - omega_from)
    allocate (u(m, components), tangent(m * components + 1), previous(m * components + 1), scale(m * components + 1))
    allocate (path%omega(max_points), path%displacement(m, components, max_points))

    omega = omega_from
    call solve_from_rest(problem, omega, u, point, converged)
    if (.not. converged) call fail('no harmonic balance found at the first frequency, '//hertz(omega))
    call start_path()
    do while (direction * (omega - omega_to) < 0.0_wp)
      call advance(step, min_tangent_cosine)
      if (converged) then
        call append()
        if (iterations <= few_steps) step = min(1.5_wp * step, max_step)
        if (iterations >= many_steps) step = 0.6_wp * step
      else
        step = 0.4_wp * step
      end if
      if (step < min_step .or. direction * (omega - omega_from) < 0.0_wp) call jump()
    end do

  contains

    !> Continues beyond a corner. Where a nearly flat contact reaches gross slip, the path may turn by more than a right angle:
    !> no tangent leads on, or the one that is found leads back.
    subroutine jump()
      real(wp) :: reached, distance, last(m, components)

      last = u
      reached = direction * maxval(direction * path%omega(:path%points))
      distance = (omega_to - omega_from) / (10 * steps_over_range)
      do
        omega = reached + distance
        u = last
        call solve_at(problem, omega, u, point, converged)
        if (.not. converged) call solve_from_rest(problem, omega, u, point, converged)
        if (converged) exit
        distance = 1.5_wp * distance
        if (abs(distance) > 0.25_wp * abs(omega_to - omega_from)) then
          call fail('no harmonic balance found at '//hertz(omega))
        end if
      end do
      call start_path()
    end subroutine jump

    !> The first point of the path, or that after a jump.
    subroutine start_path()
      call append()
      call set_scale()
      previous = 0.0_wp
      previous(m * components + 1) = direction
      call path_tangent()
      step = 0.1_wp * max_step
    end subroutine start_path

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

      do i = 1, components
        vibration = max(norm2(u(2:, i)), 1.0e-6_wp * norm2(u(2:, :)))
        scale((i - 1) * m + 1) = max(abs(u(1, i)), vibration)
        scale((i - 1) * m + 2:i * m) = vibration
      end do
      scale(:m * components) = sqrt(real(components, wp)) * scale(:m * components)
      scale(m * components + 1) = abs(omega_to - omega_from) / (steps_over_range * max_step)
    end subroutine set_scale

    !> Unit tangent of the path at the present point, in the direction of `previous`.
    subroutine path_tangent()
      real(wp) :: right(m * components + 1, 1)
      logical :: singular

      right = 0.0_wp
      right(m * components + 1, 1) = 1.0_wp
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
      real(wp) :: matrix(m * components + 1, m * components + 1)
      integer :: n, i

      n = m * components
      do i = 1, n
        matrix(:n, i) = point%jacobian(:, i) * scale(i) / scale(:n)
      end do
      matrix(:n, n + 1) = reshape(point%by_omega, [n]) * scale(n + 1) / scale(:n)
      matrix(n + 1, :) = border
      call solve(matrix, right, singular)
    end subroutine bordered_solve

    !> One step of this length: predictor along the tangent, corrector in the plane normal to it. If it does not converge, or the
    !> path bends too sharply, the start is restored.
    subroutine advance(length, min_cosine)
      real(wp), intent(in) :: length, min_cosine
      real(wp) :: u_start(m, components), omega_start, distance, right(m * components + 1, 1)
      real(wp) :: tangent_start(m * components + 1)
      logical :: singular
      integer :: n

      n = m * components
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
        converged = dot_product(tangent, previous) >= min_cosine .or. length <= 10.0_wp * min_step
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

  !> At one frequency: from a guess with any number of harmonics, if given; if that fails, from rest; and then along the response
  !> from another frequency, as near as possible, toward the nearer end of a range.
  subroutine solve_within(problem, range, omega, displacement, point, converged, guess)
    type(balance_problem), intent(inout) :: problem
    real(wp), intent(in) :: range(2), omega
    real(wp), intent(out), contiguous :: displacement(:,:)
    type(balance_point), intent(inout) :: point
    logical, intent(out) :: converged
    real(wp), intent(in), optional :: guess(:,:)
    type(response_path) :: path
    real(wp) :: end_of_range, distance, start
    integer :: m

    converged = .false.
    if (present(guess)) then
      m = min(size(guess, 1), size(displacement, 1))
      displacement = 0.0_wp
      displacement(:m, :) = guess(:m, :)
      call solve_at(problem, omega, displacement, point, converged)
    end if
    if (.not. converged) call solve_from_rest(problem, omega, displacement, point, converged)
    if (converged .or. range(2) <= range(1)) return
    end_of_range = merge(range(1), range(2), 2.0_wp * omega < sum(range))
    distance = 0.03_wp * omega
    do
      start = merge(end_of_range, omega + sign(distance, end_of_range - omega), distance >= abs(end_of_range - omega))
      call solve_from_rest(problem, start, displacement, point, converged)
      if (converged) exit
      if (distance >= abs(end_of_range - omega)) return
      distance = 1.5_wp * distance
    end do
    call follow_response(problem, start, omega, path)
    displacement = path%displacement(:, :, path%points)
    call solve_at(problem, omega, displacement, point, converged)
  end subroutine solve_within

  real(wp) function peak_of(problem, point, dof)
    type(balance_problem), intent(in) :: problem
    type(balance_point), intent(in) :: point
    integer, intent(in) :: dof
    real(wp) :: response(2 * problem%harmonics + 1, size(problem%incidence, 1))

    response = structure_response(problem, point)
    peak_of = series_peak(response(:, dof))
  end function peak_of

  !> Resonance peak between the points of a path. `amplitude` has the peak over the period of degree of freedom `dof` at every
  !> point. If the frequency is not monotonic around the largest point, that point is the result.
  subroutine refine_peak(problem, path, amplitude, dof, omega, displacement)
    type(balance_problem), intent(inout) :: problem
    type(response_path), intent(in) :: path
    real(wp), intent(in) :: amplitude(:)
    integer, intent(in) :: dof
    real(wp), intent(out) :: omega, displacement(:,:)
    real(wp), parameter :: amplitude_tolerance = 1.0e-9_wp, golden = 0.381966011250105_wp
    type(balance_point) :: point
    real(wp) :: x(3), y(3), trial(size(displacement, 1), size(displacement, 2)), vertex, gain, top, previous_width, width
    logical :: converged
    integer :: largest, step

    largest = maxloc(amplitude, dim=1)
    omega = path%omega(largest)
    displacement = path%displacement(:, :, largest)
    if (largest == 1 .or. largest == path%points) return
    x = path%omega(largest - 1:largest + 1)
    y = amplitude(largest - 1:largest + 1)
    if (x(1) >= x(2) .or. x(2) >= x(3)) return

    previous_width = huge(previous_width)
    do step = 1, 40
      call parabola_vertex(x, y, vertex, gain)
      width = x(3) - x(1)
      if (gain <= amplitude_tolerance * y(2)) exit
      ! Golden section if the parabola does not narrow the bracket.
      if (width > 0.7_wp * previous_width) vertex = x(2) + golden * merge(x(3) - x(2), x(1) - x(2), &
                                                                          x(3) - x(2) > x(2) - x(1))
      previous_width = width
      trial = displacement
      call solve_at(problem, vertex, trial, point, converged)
      if (.not. converged) exit
      top = peak_of(problem, point, dof)
      if (top >= y(2)) then
        displacement = trial
        omega = vertex
        ! The former middle is the new end on the other side.
        x(merge(1, 3, vertex > x(2))) = x(2)
        y(merge(1, 3, vertex > x(2))) = y(2)
        x(2) = vertex
        y(2) = top
      else
        y(merge(3, 1, vertex > x(2))) = top
        x(merge(3, 1, vertex > x(2))) = vertex
      end if
    end do
  end subroutine refine_peak

  !> Vertex of the parabola through three points, the middle one not below the others, and its height above that one.
  pure subroutine parabola_vertex(x, y, vertex, gain)
    real(wp), intent(in) :: x(3), y(3)
    real(wp), intent(out) :: vertex, gain
    real(wp) :: left, right, slope_left, slope_right, curvature, slope

    left = x(2) - x(1)
    right = x(3) - x(2)
    slope_left = (y(2) - y(1)) / left
    slope_right = (y(3) - y(2)) / right
    curvature = (slope_right - slope_left) / (left + right)
    slope = (slope_left * right + slope_right * left) / (left + right)
    vertex = x(2)
    gain = 0.0_wp
    if (curvature < 0.0_wp) then
      vertex = x(2) - 0.5_wp * slope / curvature
      gain = -0.25_wp * slope**2 / curvature
    end if
  end subroutine parabola_vertex

  function hertz(omega) result(string)
    real(wp), intent(in) :: omega
    character(len=:), allocatable :: string

    string = text(omega / (2.0_wp * pi), '(f12.3)')//' Hz'
  end function hertz
end module continuation
