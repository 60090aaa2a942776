!> What a layer in series with the damper changes: resonance and peak of a case whose first contact is the damper.
!>
!>     layered_damper CASE
!>
!> Prints the rows of a table: layer, then Hz and um at each normal force of the damper. Layers have 0.3, 1 and 3 times the compliance
!> of the damper's contact under this force; that of a rough one grows as the load decreases.
program layered_damper
  use basics, only: argument, fail, pi, text, wp
  use case_input, only: case_data, prepare_problem, read_case
  use continuation, only: find_peak
  use harmonic_balance, only: balance_point, balance_problem
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
    type(balance_problem) :: problem
    type(balance_point) :: point
    real(wp), allocatable :: displacement(:,:)
    real(wp) :: omega, peak
    integer :: i

    row = ''
    do i = 1, size(normal_forces)
      call set_layer(normal_forces(i), share, stiffening)
      call prepare_problem(data, 1.0_wp, data%harmonics, data%samples, problem)
      call find_peak(problem, 2.0_wp * pi * [data%frequency_from, data%frequency_to], data%response_dof, omega, peak, &
                     displacement, point)
      row = row//' '//text(omega / (2.0_wp * pi), '(f5.1)')//', '//text(1.0e6_wp * peak, '(f5.2)')//' |'
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
end program layered_damper
