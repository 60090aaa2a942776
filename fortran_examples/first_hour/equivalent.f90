program equivalent
  ! A solver that knows only the Jenkins element of before.f90 gets the response of microslip, if kt and mu N are those of the
  ! equivalent slider at the amplitude of the contact: solve, take the amplitude, ask for kt and mu N, solve again until it stays.
  ! Two equal blades out of phase, with a cylinder as damper between the platforms: the coefficients x are those of a tip, g x those
  ! of the contact. For comparison the peaks by mslip_harmonic_force in place of the slider.
  use microslip
  use slider, only: wp, pi, samples, kt, mu_n
  implicit none
  integer(mslip_size), parameter :: harmonics = 3
  integer, parameter :: m = 2*harmonics + 1, plain_slider = 1, equivalent_slider = 2, microslip_law = 3
  real(wp), parameter :: mass = 0.12_wp, damping = 0.7_wp, stiffness = 1.1e6_wp, g = 0.08_wp      ! of the mode of a blade, SI
  real(wp), parameter :: excitation(7) = [10.0_wp, 5.0_wp, 2.0_wp, 1.0_wp, 0.5_wp, 0.2_wp, 0.05_wp]           ! N
  type(mslip_parameters) :: p
  type(mslip_contact) :: contact
  real(wp), allocatable :: workspace(:)
  real(wp) :: peak(3), x(m), amplitude
  integer(mslip_int) :: status
  integer :: i, law, step, iteration
  external :: contact_force, dgesv

  call mslip_parameters_default(p)
  p%flat_half_width = 0; p%edge_radius = 10e-3_wp; p%length = 3e-3_wp; p%friction_coefficient = 0.4_wp; p%normal_force = 800
  p%material = mslip_material(114e9_wp, 0.32_wp); p%displacement_reference = MSLIP_RIGID_STRIP
  call mslip_contact_init(p, contact, status)
  allocate (workspace(mslip_harmonic_workspace_length(harmonics, int(samples, mslip_size))))
  call mslip_harmonic_workspace_init(harmonics, int(samples, mslip_size), workspace, status)
  call contact_init(int(harmonics))
  ! Amplitude of the contact with the plain slider over slip_displacement; peaks in um; microslip over plain slider.
  do i = 1, size(excitation)
    peak = 0
    do law = plain_slider, microslip_law
      x = 0; kt = contact%initial_stiffness; mu_n = contact%slip_force
      do step = 0, 650
        call solve(2*pi*(480 + 0.1_wp*step))
        do iteration = 1, merge(100, 0, law == equivalent_slider)
          amplitude = hypot(x(2), x(3))
          call mslip_jenkins_equivalent(contact, g*amplitude, kt, mu_n, status)
          if (status /= MSLIP_OK) error stop 'jenkins_equivalent'
          call solve(2*pi*(480 + 0.1_wp*step))
          if (abs(hypot(x(2), x(3)) - amplitude) < 1e-6_wp*amplitude) exit
        end do
        peak(law) = max(peak(law), hypot(x(2), x(3)))
      end do
    end do
    print '("| ", f4.2, 3(" | ", f6.2), " | ", f4.2, " |")', g*peak(1)/contact%slip_displacement, 1e6_wp*peak, peak(3)/peak(1)
  end do

contains

  ! Your solver: harmonic balance at one frequency, from the last solution, by Newton's method.
  subroutine solve(omega)
    real(wp), intent(in) :: omega
    real(wp) :: linear(m, m), jacobian(m, m), slope(m, m), force(m), residual(m), last(m), change(m), before
    integer :: k, iteration, halving, pivots(m), info

    linear = 0; linear(1, 1) = stiffness
    do k = 2, m, 2
      linear(k, k:k + 1) = [stiffness - (k/2*omega)**2*mass, k/2*omega*damping]
      linear(k + 1, k:k + 1) = [-linear(k, k + 1), linear(k, k)]
    end do
    last = x; change = 0; before = huge(before)
    do iteration = 0, 60
      do halving = 0, 12                               ! a step that does not reduce the residual is halved
        x = last - change/2**halving
        if (law /= microslip_law) call contact_force(g*x, force, slope)
        if (law == microslip_law) call mslip_harmonic_force(contact, workspace, g*x, status, force, slope)
        residual = matmul(linear, x) + g/2*force       ! a half: the two platforms share the displacement
        residual(2) = residual(2) - excitation(i)
        if (norm2(residual) < before) exit
      end do
      before = norm2(residual)
      if (before < 1e-9_wp*excitation(i)) exit
      last = x; change = residual; jacobian = linear + g**2/2*slope
      call dgesv(m, 1, jacobian, m, pivots, change, m, info)
    end do
  end subroutine solve
end program equivalent
