module wrappers
  ! Procedures of an application that hand their optional arguments on, in the forms of the head comment of the module: the array
  ! dummy arguments are contiguous or have explicit shape.
  use microslip
  use checks, only: wp
  implicit none
  private
  public :: contiguous_force, explicit_force, allocatable_force, batch_force

contains

  subroutine contiguous_force(contact, workspace, displacement, status, force, jacobian, dissipated)
    type(mslip_contact), intent(in) :: contact
    real(wp), intent(inout) :: workspace(:)
    real(wp), intent(in) :: displacement(:)
    integer(mslip_int), intent(out) :: status
    real(wp), intent(inout), optional, contiguous :: force(:), jacobian(:, :)
    real(wp), intent(inout), optional :: dissipated

    call mslip_harmonic_force(contact, workspace, displacement, status, force, jacobian, dissipated)
  end subroutine contiguous_force

  subroutine explicit_force(contact, length, workspace, n, displacement, status, force, jacobian, dissipated)
    type(mslip_contact), intent(in) :: contact
    integer, intent(in) :: length, n
    real(wp), intent(inout) :: workspace(length)
    real(wp), intent(in) :: displacement(n)
    integer(mslip_int), intent(out) :: status
    real(wp), intent(inout), optional :: force(n), jacobian(n, n), dissipated

    call mslip_harmonic_force(contact, workspace, displacement, status, force, jacobian, dissipated)
  end subroutine explicit_force

  subroutine allocatable_force(contact, workspace, displacement, status, force)
    type(mslip_contact), intent(in) :: contact
    real(wp), intent(inout), allocatable :: workspace(:)
    real(wp), intent(in) :: displacement(:)
    integer(mslip_int), intent(out) :: status
    real(wp), intent(inout), allocatable, optional :: force(:)

    if (present(force)) then
      call mslip_harmonic_force(contact, workspace, displacement, status, force)
    else
      call mslip_harmonic_force(contact, workspace, displacement, status)
    end if
  end subroutine allocatable_force

  subroutine batch_force(contacts, workspace, displacement, status, index, active, force, dissipated)
    type(mslip_contact), intent(in) :: contacts(:)
    real(wp), intent(inout) :: workspace(:)
    real(wp), intent(in) :: displacement(:, :)
    integer(mslip_int), intent(out) :: status
    integer(mslip_int), intent(in), optional, contiguous :: index(:), active(:)
    real(wp), intent(inout), optional, contiguous :: force(:, :), dissipated(:)

    call mslip_batch_harmonic_force(contacts, workspace, displacement, status, index, active, force, dissipated=dissipated)
  end subroutine batch_force

end module wrappers

program test_wrappers
  ! Through wrappers each output has the bits of a direct call: absent, unallocated or disassociated, and as a section with strides.
  use microslip
  use checks
  use wrappers
  implicit none

  integer, parameter :: n = 3

  type :: coefficient
    real(wp) :: displacement = 0, force = 0
  end type coefficient

  type(mslip_contact) :: contact, contacts(2)
  type(coefficient) :: parts(n)
  real(wp), allocatable :: workspace(:), no_force(:), no_jacobian(:, :), no_scalar, force(:)
  real(wp), pointer, contiguous :: force_pointer(:) => null(), jacobian_pointer(:, :) => null()
  real(wp), pointer :: scalar_pointer => null(), section(:) => null()
  real(wp), target :: table(2*n, 2*n)
  real(wp) :: u(n), expected(n), expected_jacobian(n, n), expected_energy, energy, energies(2), cube(7, 3, 4)
  integer(mslip_int) :: status, index(4), active(4)

  call mslip_contact_init(flat_parameters(1), contact, status)
  allocate (workspace(mslip_harmonic_workspace_length(1_mslip_size, 64_mslip_size)))
  call mslip_harmonic_workspace_init(1_mslip_size, 64_mslip_size, workspace, status)
  table = 0
  u = [0.0_wp, 0.8_wp*contact%slip_displacement, 0.0_wp]
  call mslip_harmonic_force(contact, workspace, u, status, expected, expected_jacobian, expected_energy)
  call check_status('direct call', status, MSLIP_OK)

  call contiguous_force(contact, workspace, u, status)
  call check_status('contiguous: absent', status, MSLIP_OK)
  call contiguous_force(contact, workspace, u, status, no_force, no_jacobian, no_scalar)
  call check_status('contiguous: unallocated', status, MSLIP_OK)
  call contiguous_force(contact, workspace, u, status, force_pointer, jacobian_pointer, scalar_pointer)
  call check_status('contiguous: disassociated', status, MSLIP_OK)
  call contiguous_force(contact, workspace, u, status, table(1, 1:n), table(2::2, 2::2), energy)
  call check_results('contiguous: sections', table(1, 1:n), table(2::2, 2::2), energy)
  parts%displacement = u(n:1:-1)
  call contiguous_force(contact, workspace, parts(n:1:-1)%displacement, status, parts%force)
  call check_same('contiguous: components', parts%force, expected)
  section => table(n, n:1:-1)
  call contiguous_force(contact, workspace, u, status, section)
  call check_same('contiguous: pointer to a section', section, expected)

  call explicit_force(contact, size(workspace), workspace, n, u, status)
  call check_status('explicit shape: absent', status, MSLIP_OK)
  call explicit_force(contact, size(workspace), workspace, n, u, status, no_force, no_jacobian, no_scalar)
  call check_status('explicit shape: unallocated', status, MSLIP_OK)
  call explicit_force(contact, size(workspace), workspace, n, u, status, table(n, 1:n), table(2::2, 2::2), energy)
  call check_results('explicit shape: sections', table(n, 1:n), table(2::2, 2::2), energy)

  call allocatable_force(contact, workspace, u, status)
  call check_status('allocatable: absent', status, MSLIP_OK)
  call allocatable_force(contact, workspace, u, status, force)
  call check_status('allocatable: unallocated', status, MSLIP_OK)
  force = 0*u
  call allocatable_force(contact, workspace, u, status, force)
  call check_same('allocatable: allocated', force, expected)

  call mslip_harmonic_force(contact, workspace, u, status, force_pointer, jacobian_pointer, scalar_pointer)
  call check_status('direct: disassociated', status, MSLIP_OK)

  contacts = contact
  call batch_force(contacts, workspace, spread(u, 2, 2), status)
  call check_status('batch: absent', status, MSLIP_OK)
  index = [2, -1, 1, -1]
  active = 1
  energies = 0
  cube = 0
  call batch_force(contacts, workspace, spread(u, 2, 2), status, index(1::2), active(4:1:-3), cube(2:6:2, 2, 4:1:-3), &
    energies(2:1:-1))
  call check_same('batch: sections', cube(2:6:2, 2, 1), expected)
  call check_same('batch: energies', energies, spread(expected_energy, 1, 2))
  call report()

contains

  subroutine check_results(name, force, jacobian, dissipated)
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: force(n), jacobian(n, n), dissipated

    call check_same(name, [force, reshape(jacobian, [n*n]), dissipated], &
      [expected, reshape(expected_jacobian, [n*n]), expected_energy])
  end subroutine check_results

end program test_wrappers
