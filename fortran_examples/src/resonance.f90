!> The resonance peak on a response path, between its points.
module resonance
  use continuation, only: response_path
  use fourier_series, only: series_peak
  use harmonic_balance, only: balance_point, balance_problem, solve_at, structure_response
  use kinds, only: wp
  implicit none
  private
  public :: refine_peak

  integer, parameter :: max_steps = 40
  real(wp), parameter :: amplitude_tolerance = 1.0e-9_wp
  real(wp), parameter :: golden = 0.381966011250105_wp

contains

  !> `amplitude` holds the peak over the period of degree of freedom `dof` at every point of the path. Where the path
  !> does not advance in frequency around its largest point, that point is the answer.
  subroutine refine_peak(problem, path, amplitude, dof, omega, displacement)
    type(balance_problem), intent(inout) :: problem
    type(response_path), intent(in) :: path
    real(wp), intent(in) :: amplitude(:)
    integer, intent(in) :: dof
    real(wp), intent(out) :: omega, displacement(:,:)
    type(balance_point) :: point
    real(wp) :: x(3), y(3), trial(size(displacement, 1), size(displacement, 2)), vertex, gain, top
    real(wp) :: previous_width, width
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
    do step = 1, max_steps
      call parabola_vertex(x, y, vertex, gain)
      width = x(3) - x(1)
      if (gain <= amplitude_tolerance * y(2)) exit
      ! Golden section where the parabola does not narrow the bracket.
      if (width > 0.7_wp * previous_width) vertex = x(2) + golden * merge(x(3) - x(2), x(1) - x(2), &
                                                                          x(3) - x(2) > x(2) - x(1))
      previous_width = width
      trial = displacement
      call solve_at(problem, vertex, trial, point, converged)
      if (.not. converged) exit
      associate (response => structure_response(problem, point))
        top = series_peak(response(:, dof))
      end associate
      if (top >= y(2)) then
        displacement = trial
        omega = vertex
        if (vertex > x(2)) then
          x = [x(2), vertex, x(3)]
          y = [y(2), top, y(3)]
        else
          x = [x(1), vertex, x(2)]
          y = [y(1), top, y(2)]
        end if
      else if (vertex > x(2)) then
        x(3) = vertex
        y(3) = top
      else
        x(1) = vertex
        y(1) = top
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
end module resonance
