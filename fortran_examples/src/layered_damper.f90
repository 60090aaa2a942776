!> What a layer in series with the damper changes: resonance and peak of a case whose first contact is the damper.
!>
!>     layered_damper CASE
!>
!> Prints the rows of a table: layer, then Hz and um at each normal force of the damper. Layers have 0.3, 1 and 3 times the compliance
!> of the damper's contact under this force; that of a rough one grows as the load decreases.
program layered_damper
  use basics, only: argument, fail, pi, text, wp
  use case_input, only: case_data, prepare_problem, read_case
  use continuation, only: follow_response, refine_peak, response_path
  use fourier_series, only: series_peak
  use harmonic_balance, only: balance_point, balance_problem, evaluate, structure_response
  use microslip, only: mslip_contact, mslip_contact_init, mslip_int, mslip_layer, MSLIP_OK
  implicit none

  real(wp), parameter :: normal_forces(3) = [2.0_wp, 7.0_wp, 250.0_wp], shares(3) = [0.3_wp, 1.0_wp, 3.0_wp]
  !> N_c over N; 0 is a constant stiffness.
  real(wp), parameter :: stiffening(2) = [0.0_wp, 0.05_wp]
  character(len=8), parameter :: kinds(2) = ['constant', 'rough   ']
  type(case_data) :: data
  integer :: i, kind

  call read_case(trim(argument(1, 'layered_damper CASE')), data)
  print '(a)', '| none |'//cells(0.0_wp, 0.0_wp)
  do kind = 1, size(kinds)
    do i = 1, size(shares)
      print '(a)', '| '//text(shares(i), '(f3.1)')//' times, '//trim(kinds(kind))//' |'//cells(shares(i), stiffening(kind))
    end do
  end do

contains

  function cells(share, stiffening) result(row)
    real(wp), intent(in) :: share, stiffening
    character(len=:), allocatable :: row
    real(wp) :: hertz, peak
    integer :: i

    row = ''
    do i = 1, size(normal_forces)
      call set_layer(normal_forces(i), share, stiffening)
      call find_peak(hertz, peak)
      row = row//' '//text(hertz, '(f5.1)')//', '//text(1.0e6_wp * peak, '(f5.2)')//' |'
    end do
  end function cells

  subroutine set_layer(normal_force, share, stiffening)
    real(wp), intent(in) :: normal_force, share, stiffening
    type(mslip_contact) :: contact
    integer(mslip_int) :: status

    associate (p => data%contacts(1)%parameters)
      p%normal_force = normal_force
      p%layer = mslip_layer(0.0_wp, 0.0_wp, 0.0_wp)
      call mslip_contact_init(p, contact, status)
      if (status /= MSLIP_OK) call fail('the contact of the damper is not accepted')
      p%layer = mslip_layer(0.0_wp, share / contact%initial_stiffness, stiffening * normal_force)
    end associate
  end subroutine set_layer

  subroutine find_peak(hertz, peak)
    real(wp), intent(out) :: hertz, peak
    type(balance_problem) :: problem
    type(balance_point) :: point
    type(response_path) :: path
    real(wp), allocatable :: displacement(:,:), amplitude(:)
    real(wp) :: response(2 * data%harmonics + 1, size(data%model%dof_name))
    real(wp) :: omega
    integer :: i

    call prepare_problem(data, 1.0_wp, data%harmonics, data%samples, problem)
    call follow_response(problem, 2.0_wp * pi * data%frequency_from, 2.0_wp * pi * data%frequency_to, path)
    allocate (amplitude(path%points), displacement(2 * data%harmonics + 1, size(problem%incidence, 2)))
    do i = 1, path%points
      call evaluate(problem, path%omega(i), path%displacement(:, :, i), point)
      response = structure_response(problem, point)
      amplitude(i) = series_peak(response(:, data%response_dof))
    end do
    call refine_peak(problem, path, amplitude, data%response_dof, omega, displacement)
    call evaluate(problem, omega, displacement, point)
    response = structure_response(problem, point)
    hertz = omega / (2.0_wp * pi)
    peak = series_peak(response(:, data%response_dof))
  end subroutine find_peak
end program layered_damper
