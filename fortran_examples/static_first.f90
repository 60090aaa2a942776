program static_first
  ! A body on springs that is pressed against a wall and sheared, then shaken. The static state is known, from a static analysis with
  ! normal force N0 and shear Ts in the contact, and the displacements of the body are measured from it. The harmonic balance is
  ! solved by Newton's method for rising excitations: along the shear with one direction of sliding, then across it with two, where
  ! the vibration reduces the shear over many periods. A small drift shows that the default number of periods is sufficient.
  use microslip
  implicit none

  integer, parameter :: wp = mslip_real
  integer(mslip_size), parameter :: harmonics = 1, samples = 128
  integer, parameter :: n = 3                                             ! coefficients of each component: mean, cos, sin
  real(wp), parameter :: normal_force = 800, shear = 150                  ! N, of the static state
  real(wp), parameter :: mass = 0.5_wp, spring = 20e6_wp, damper = 200    ! kg, N/m, Ns/m: the same in both directions
  real(wp), parameter :: omega = 8*atan(1.0_wp)*2000                      ! rad/s

  type(mslip_parameters) :: p
  type(mslip_element) :: element
  real(wp), allocatable :: workspace(:)
  real(wp), allocatable, dimension(:) :: x, static, excitation, force     ! of u, then of v if there are two directions, then of w
  real(wp), allocatable :: body(:, :), jacobian(:, :)
  real(wp) :: w0, u0, dissipated, drift
  integer(mslip_int) :: status, directions
  integer :: level, c, unknowns

  ! A flat contact with rounded edges and a rough layer; normal_force of the parameters is the largest one that is tabulated.
  call mslip_parameters_default(p)
  p%flat_half_width = 0.5e-3_wp
  p%edge_radius = 3e-3_wp
  p%length = 20e-3_wp
  p%normal_force = 2*normal_force
  p%friction_coefficient = 0.5_wp
  p%material = mslip_material(2e11_wp, 0.3_wp)
  p%displacement_reference = MSLIP_RIGID_STRIP
  p%layer = mslip_layer(1e-9_wp, 1e-9_wp, 100.0_wp, 2*normal_force)
  do directions = 1, 2
    call vibrate
  end do

contains

  subroutine vibrate
    call mslip_element_init(p, directions, MSLIP_INPUT_APPROACH, element, status)
    call check
    workspace = [(0.0_wp, c=1, int(mslip_element_workspace_length(directions, harmonics, samples)))]
    call mslip_element_workspace_init(directions, harmonics, samples, 0_mslip_size, workspace, status)
    call check

    ! The static state of the contact: approach and displacement that carry N0 and Ts.
    call mslip_normal_approach(element, normal_force, status, approach=w0)
    call check
    call mslip_element_displacement(element, 0_mslip_int, shear, normal_force, status, displacement=u0)
    call check
    unknowns = (directions + 1)*n
    static = [u0, (0.0_wp, c=2, unknowns)]
    static(unknowns - 2) = w0
    print '(a,i0,a,f7.4,a,f7.4,a)', 'directions: ', directions, ', static state: u', 1e6*u0, ' um, w', 1e6*w0, ' um'

    ! Stiffness, inertia and damping of the body.
    body = reshape([(0.0_wp, c=1, unknowns**2)], [unknowns, unknowns])
    do c = 1, unknowns, n
      body(c, c) = spring
      body(c + 1, c + 1) = spring - mass*omega**2
      body(c + 2, c + 2) = body(c + 1, c + 1)
      body(c + 1, c + 2) = damper*omega
      body(c + 2, c + 1) = -damper*omega
    end do

    print '(a)', 'excitation   vibration    mean u  mean shear   mean N  dissipated    drift'
    x = 0*static
    force = x
    excitation = x
    jacobian = body
    c = (directions - 1)*n                                                ! the component that is shaken, with w
    do level = 0, 4
      call follow(25.0_wp*max(0, level - 1), 25.0_wp*level)
      print '(f8.0,a,f11.4,a,f7.3,a,f8.1,a,f8.1,a,f8.3,a,es9.1)', excitation(c + 2), ' N', 1e6*norm2(x(c + 2:c + 3)), ' um', &
        1e6*abs(x(1)), ' um', force(1), ' N', force(unknowns - 2), ' N', 1e6*dissipated, ' uJ', drift
    end do
  end subroutine vibrate

  ! From the solution at one excitation to that at another, by Newton's method; if it fails, by way of the excitation between. The
  ! contact carries the static forces at x = 0, so that they are subtracted from its mean forces.
  recursive subroutine follow(from, to)
    real(wp), intent(in) :: from, to
    real(wp) :: start(unknowns), residual(unknowns), matrix(unknowns, unknowns)
    integer :: iteration, pivots(unknowns), info
    external :: dgesv                                                     ! LAPACK

    start = x
    excitation(c + 2) = to
    excitation(unknowns - 1) = 0.3_wp*to
    do iteration = 1, 30
      call mslip_element_harmonic_force(element, workspace, static + x, status, force, jacobian, dissipated, drift)
      if (status /= MSLIP_OK) exit
      residual = matmul(body, x) + force - excitation
      residual(1) = residual(1) - shear
      residual(unknowns - 2) = residual(unknowns - 2) - normal_force
      if (maxval(abs(residual)) < 1e-9_wp*normal_force) return
      matrix = body + jacobian
      call dgesv(unknowns, 1, matrix, unknowns, pivots, residual, unknowns, info)
      x = x - residual
    end do
    if (to - from < 0.1_wp) error stop 'no equilibrium'
    x = start
    call follow(from, (from + to)/2)
    call follow((from + to)/2, to)
  end subroutine follow

  subroutine check
    if (status /= MSLIP_OK) then
      print '(a)', mslip_status_text(status)
      error stop 1
    end if
  end subroutine check

end program static_first
