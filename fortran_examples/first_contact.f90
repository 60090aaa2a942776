program first_contact
  ! A cylindrical damper in harmonic motion with an amplitude of three micrometres, below gross slip.
  use microslip
  implicit none

  integer, parameter :: wp = mslip_real
  integer(mslip_size), parameter :: harmonics = 1, samples = 256
  real(wp), parameter :: amplitude = 3.0e-6_wp  ! m
  type(mslip_parameters) :: p
  type(mslip_contact) :: contact
  real(wp), allocatable :: workspace(:)
  real(wp) :: k_real, k_imag, force(3)
  integer(mslip_int) :: status

  p = mslip_parameters(flat_half_width=0.0_wp, edge_radius=10.0e-3_wp, length=3.0e-3_wp, normal_force=800.0_wp, &
    friction_coefficient=0.4_wp, material=[mslip_material(1.14e11_wp, 0.32_wp), mslip_material(1.14e11_wp, 0.32_wp)], &
    displacement_reference=MSLIP_RIGID_STRIP)
  allocate (workspace(mslip_harmonic_workspace_length(harmonics, samples)))

  if (mslip_parameters_warning(p, 1) /= '') print '(2a)', 'warning: ', mslip_parameters_warning(p, 1)  ! units, exchanged values
  ! Once for each contact, then any of the other calls. Every call returns a status.
  call mslip_contact_init(p, contact, status)
  if (status == MSLIP_OK) call mslip_complex_stiffness(contact, amplitude, status, k_real, k_imag)
  if (status == MSLIP_OK) call mslip_harmonic_workspace_init(harmonics, samples, workspace, status)
  if (status == MSLIP_OK) call mslip_harmonic_force(contact, workspace, [0.0_wp, amplitude, 0.0_wp], status, force)
  if (status /= MSLIP_OK) then
    print '(a)', mslip_status_text(status)
    error stop 1
  end if

  print '(a,f6.3,a)', 'gross slip starts at', contact%slip_displacement*1.0e6_wp, ' um'
  print '(a,f8.3,sp,f7.3,a)', 'stiffness:', k_real*1.0e-6_wp, k_imag*1.0e-6_wp, 'i N/um'
  print '(a,f8.3,a,sp,f7.3,a)', 'force:    ', force(2), ' cos t', force(3), ' sin t N'
end program first_contact
