! The contact after: a patch of microslip under a constant normal force.
module patch
  use microslip
  implicit none
  integer(mslip_size), parameter :: samples = 128
  type(mslip_contact) :: contact
  real(mslip_real), allocatable :: workspace(:)
  integer :: coefficients
end module patch

subroutine contact_init(harmonics)
  use patch
  implicit none
  integer, intent(in) :: harmonics
  type(mslip_parameters) :: p
  integer(mslip_int) :: status

  call mslip_parameters_default(p)
  p%flat_half_width = 0.2e-3_mslip_real; p%edge_radius = 5e-3_mslip_real; p%length = 10e-3_mslip_real       ! m
  p%normal_force = 150; p%friction_coefficient = 0.4_mslip_real                                             ! N, -
  p%material = mslip_material(114e9_mslip_real, 0.32_mslip_real)                                            ! Pa, -
  p%displacement_reference = MSLIP_RIGID_STRIP                          ! the contact of a machine, in three dimensions
  call mslip_contact_init(p, contact, status)
  if (status /= MSLIP_OK) then; print '(a)', mslip_status_text(status); error stop; end if
  coefficients = 2*harmonics + 1
  allocate (workspace(mslip_harmonic_workspace_length(int(harmonics, mslip_size), samples)))
  call mslip_harmonic_workspace_init(int(harmonics, mslip_size), samples, workspace, status)
  if (status /= MSLIP_OK) then; print '(a)', mslip_status_text(status); error stop; end if
  print '(a, es13.6, a, f6.2, a)', 'initial stiffness', contact%initial_stiffness, ' N/m, slip force', contact%slip_force, ' N'
end subroutine contact_init

subroutine contact_force(u, force, jacobian)
  use patch
  implicit none
  real(mslip_real), intent(in) :: u(coefficients)
  real(mslip_real), intent(out) :: force(coefficients), jacobian(coefficients, coefficients)
  integer(mslip_int) :: status

  call mslip_harmonic_force(contact, workspace, u, status, force, jacobian)
  if (status /= MSLIP_OK) then; print '(a)', mslip_status_text(status); error stop; end if
end subroutine contact_force
