! Client in Fortran: computes a force. A module that does not agree with the library initialises no contact.
program client
  use microslip
  implicit none
  type(mslip_parameters) :: p
  type(mslip_contact) :: contact
  real(mslip_real) :: force(1)
  integer(mslip_int) :: status

  call mslip_parameters_default(p)
  p%flat_half_width = 0.5e-3_mslip_real; p%edge_radius = 3e-3_mslip_real; p%length = 20e-3_mslip_real
  p%normal_force = 800; p%friction_coefficient = 0.5_mslip_real
  p%material = mslip_material(2e11_mslip_real, 0.3_mslip_real)
  p%displacement_reference = MSLIP_RIGID_STRIP
  call mslip_contact_init(p, contact, status)
  if (status /= MSLIP_OK) then; print '(a)', mslip_status_text(status); error stop; end if
  call mslip_monotonic_force(contact, [2*contact%slip_displacement], status, force)
  if (status /= MSLIP_OK) then; print '(a)', mslip_status_text(status); error stop; end if

  ! In gross slip the force is mu N: 0.5 times 800 N, a product without rounding.
  if (any(force /= 400)) error stop 'the force of gross slip is not mu N'
  print '(2a)', 'microslip ', mslip_version()
end program client
