program equivalent
  ! A solver that knows only the Jenkins element of before.f90 gets the response of microslip, if kt and mu N are those of the
  ! equivalent slider at the amplitude of the contact: solve, take the amplitude, ask for kt and mu N, solve again until it stays.
  ! Two equal blades out of phase, with a cylinder as damper between the platforms: the coefficients x are those of a tip, g x those
  ! of the contact. For comparison the peaks by mslip_harmonic_force in place of the slider.
  use microslip
  use slider, only: wp, pi, samples, kt, mu_n
  implicit none
  integer, parameter :: harmonics = 3, m = 2*harmonics + 1
  real(wp), parameter :: mass = 0.12_wp, damping = 0.7_wp, stiffness = 1.1e6_wp, g = 0.08_wp      ! of the mode of a blade, SI
  real(wp), parameter :: excitation(7) = [10.0_wp, 5.0_wp, 2.0_wp, 1.0_wp, 0.5_wp, 0.2_wp, 0.05_wp]           ! N
  integer, parameter :: plain_slider = 1, equivalent_slider = 2, microslip_law = 3
  type(mslip_parameters) :: p
  type(mslip_contact) :: contact
  real(wp), allocatable :: workspace(:)
  real(wp) :: peak(3), force, x(m), residual(m), jacobian(m, m)
  integer(mslip_int) :: status
  integer :: i, law

  call mslip_parameters_default(p)
  p%flat_half_width = 0; p%edge_radius = 10e-3_wp; p%length = 3e-3_wp; p%friction_coefficient = 0.4_wp; p%normal_force = 800
  p%material = mslip_material(114e9_wp, 0.32_wp); p%displacement_reference = MSLIP_RIGID_STRIP
  call mslip_contact_init(p, contact, status); call check
  allocate (workspace(mslip_harmonic_workspace_length(int(harmonics, mslip_size), int(samples, mslip_size))))
  call mslip_harmonic_workspace_init(int(harmonics, mslip_size), int(samples, mslip_size), workspace, status); call check
  call contact_init(harmonics)
  ! Amplitude of the contact with the plain slider over slip_displacement; peaks in um; microslip over plain slider.
  do i = 1, size(excitation)
    force = excitation(i)
    do law = plain_slider, microslip_law
      call sweep(peak(law))
    end do
    print '("| ", f4.2, 3(" | ", f6.2), " | ", f4.2, " |")', g*peak(1)/contact%slip_displacement, 1e6_wp*peak, peak(3)/peak(1)
  end do

contains

  subroutine sweep(peak)
    real(wp), intent(out) :: peak
    real(wp) :: amplitude
    integer :: i, iteration

    x = 0; peak = 0
    kt = contact%initial_stiffness; mu_n = contact%slip_force
    do i = 0, 650
      call solve(2*pi*(480 + 0.1_wp*i))
      do iteration = 1, merge(100, 0, law == equivalent_slider)
        amplitude = hypot(x(2), x(3))
        call mslip_jenkins_equivalent(contact, g*amplitude, kt, mu_n, status); call check
        call solve(2*pi*(480 + 0.1_wp*i))
        if (abs(hypot(x(2), x(3)) - amplitude) < 1e-6_wp*amplitude) exit
      end do
      peak = max(peak, hypot(x(2), x(3)))
    end do
  end subroutine sweep

  ! Your solver: harmonic balance at one frequency, from the last solution, by Newton's method.
  subroutine solve(omega)
    real(wp), intent(in) :: omega
    real(wp) :: last(m), step(m), before
    integer :: iteration, halving, pivots(m), info
    external :: dgesv

    call evaluate(omega)
    do iteration = 1, 60
      before = norm2(residual)
      if (before < 1e-9_wp*force) exit
      last = x; step = residual
      call dgesv(m, 1, jacobian, m, pivots, step, m, info)
      do halving = 0, 12
        x = last - step/2**halving
        call evaluate(omega)
        if (norm2(residual) < before) exit
      end do
    end do
  end subroutine solve

  subroutine evaluate(omega)
    real(wp), intent(in) :: omega
    real(wp) :: reply(m), slope(m, m), dynamic
    integer :: k
    external :: contact_force

    if (law /= microslip_law) call contact_force(g*x, reply, slope)
    if (law == microslip_law) call mslip_harmonic_force(contact, workspace, g*x, status, reply, slope); call check
    residual = g/2*reply                                             ! a half: the two platforms share the displacement
    jacobian = g**2/2*slope
    residual(2) = residual(2) - force
    do k = 1, m
      dynamic = stiffness - (k/2*omega)**2*mass
      residual(k) = residual(k) + dynamic*x(k)
      jacobian(k, k) = jacobian(k, k) + dynamic
    end do
    do k = 2, m, 2
      residual(k:k + 1) = residual(k:k + 1) + k/2*omega*damping*[x(k + 1), -x(k)]
      jacobian(k, k + 1) = jacobian(k, k + 1) + k/2*omega*damping
      jacobian(k + 1, k) = jacobian(k + 1, k) - k/2*omega*damping
    end do
  end subroutine evaluate

  subroutine check
    if (status /= MSLIP_OK) then; print '(a)', mslip_status_text(status); error stop; end if
  end subroutine check
end program equivalent
