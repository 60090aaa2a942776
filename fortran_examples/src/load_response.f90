!> Results of a case at one load factor: the response over frequency, its peak, and the hysteresis loops at the peak.
module load_response
  use case_input, only: case_data
  use case_problem, only: prepare_problem
  use continuation, only: follow_response, response_path, step_control
  use fourier_series, only: coefficient_count, harmonic_amplitude, series_peak
  use harmonic_balance, only: balance_point, balance_problem, evaluate, structure_response
  use kinds, only: pi, wp
  use resonance, only: refine_peak
  implicit none
  private
  public :: respond

  integer, parameter, public :: loop_points = 256

  type, public :: response_row
    real(wp) :: omega = 0.0_wp
    real(wp) :: amplitude = 0.0_wp                     !! peak over the period of the response
    real(wp), allocatable :: harmonic(:)               !! amplitudes of the response
    real(wp), allocatable :: dissipated(:)             !! by each contact in a period
    real(wp), allocatable :: min_stick_half_width(:)         !! of each contact
  end type response_row

  type, public :: contact_loop
    !> `slip_part` is the displacement less that of a contact that sticks everywhere.
    real(wp), dimension(loop_points) :: displacement = 0.0_wp, force = 0.0_wp, slip_part = 0.0_wp
  end type contact_loop

  type, public :: load_result
    type(response_path) :: path
    type(response_row), allocatable :: row(:)          !! for each point of the path
    type(response_row) :: peak
    type(contact_loop), allocatable :: loop(:)         !! for each contact, at the peak
  end type load_result

contains

  subroutine respond(data, load_factor, problem, response)
    type(case_data), intent(in) :: data
    real(wp), intent(in) :: load_factor
    type(balance_problem), intent(out) :: problem
    type(load_result), intent(out) :: response
    type(balance_point) :: point
    type(step_control) :: control
    real(wp) :: displacement(coefficient_count(data%harmonics), size(data%contacts)), omega
    integer :: i

    call prepare_problem(data, load_factor, data%harmonics, data%samples, problem)
    associate (path => response%path)
      call follow_response(problem, 2.0_wp * pi * data%frequency_from, 2.0_wp * pi * data%frequency_to, control, path)
      allocate (response%row(path%points))
      do i = 1, path%points
        call fill_row(path%omega(i), path%displacement(:, :, i), response%row(i))
      end do
      call refine_peak(problem, path, response%row%amplitude, data%response_dof, omega, displacement)
    end associate
    call fill_row(omega, displacement, response%peak)
    allocate (response%loop(size(data%contacts)))
    do i = 1, size(data%contacts)
      associate (loop => response%loop(i), stiffness => problem%contacts%initial_stiffness(i))
        call problem%contacts%steady_loop(i, displacement(:, i), loop%displacement, loop%force)
        if (stiffness > 0.0_wp) loop%slip_part = loop%displacement - loop%force / stiffness
      end associate
    end do

  contains

    !> The row of a converged balance.
    subroutine fill_row(omega, displacement, row)
      real(wp), intent(in) :: omega
      real(wp), intent(in), contiguous :: displacement(:,:)
      type(response_row), intent(out) :: row
      real(wp) :: motion(size(displacement, 1), size(data%model%dof_name))
      integer :: i

      call evaluate(problem, omega, displacement, point)
      motion = structure_response(problem, point)
      row%omega = omega
      row%amplitude = series_peak(motion(:, data%response_dof))
      row%harmonic = harmonic_amplitude(motion(:, data%response_dof))
      row%dissipated = point%dissipated
      row%min_stick_half_width = [(problem%contacts%min_stick_half_width(i, displacement(:, i)), i=1, size(displacement, 2))]
    end subroutine fill_row
  end subroutine respond
end module load_response
