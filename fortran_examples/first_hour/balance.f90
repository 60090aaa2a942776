program balance
  ! Two masses in a row, the second with a friction contact to the ground: harmonic balance by the alternating
  ! frequency/time method and Newton's method. It knows the contact only by its harmonic force:
  !
  !   contact_init(harmonics)                       once
  !   contact_force(u, force, jacobian)             coefficients of u -> those of the force, and d force_i / d u_j
  !
  ! x(t) = c0 + sum over k of cosk cos(k w t) + sink sin(k w t), coefficients in the order c0, cos1, sin1, cos2, sin2, ...
  implicit none
  integer, parameter :: wp = kind(1.0d0), harmonics = 5, m = 2*harmonics + 1, n = 2*m
  real(wp), parameter :: pi = acos(-1.0_wp), tolerance = 1e-12_wp      ! of the excitation: rounding errors are smaller
  real(wp), parameter :: mass(2, 2) = reshape([1.0_wp, 0.0_wp, 0.0_wp, 0.5_wp], [2, 2])  ! kg
  real(wp), parameter :: damping(2, 2) = reshape([30.0_wp, -10.0_wp, -10.0_wp, 10.0_wp], [2, 2])      ! N s/m
  real(wp), parameter :: stiffness(2, 2) = reshape([2.5e7_wp, -2.0e7_wp, -2.0e7_wp, 2.1e7_wp], [2, 2])    ! N/m
  real(wp), parameter :: excitation = 15                                                ! N, cosine at mass 1
  real(wp), parameter :: frequency(8) = [300, 500, 650, 690, 710, 750, 790, 900]        ! Hz
  real(wp) :: linear(n, n), jacobian(n, n), residual(n), x(n)
  integer :: i
  external :: dgesv                                    ! LAPACK

  call contact_init(harmonics)
  print '(a)', 'frequency_hz,amplitude_1_um,amplitude_2_um,contact_energy_uj'
  x = 0                                                ! the first step is that of the stuck contact
  do i = 1, size(frequency)
    call follow(frequency(max(1, i - 1)), frequency(i))
    print '(f6.1, 3(",", f11.6))', frequency(i), 1e6_wp*hypot(x(2), x(3)), 1e6_wp*hypot(x(m + 2), x(m + 3)), &
      1e-6_wp*nint(1e12_wp*contact_energy(2*pi*frequency(i)))             ! rounded, so that 0 has no sign
  end do

contains

  ! From the solution at one frequency to that at another, by Newton's method; if it fails, by way of the frequency between.
  recursive subroutine follow(from, to)
    real(wp), intent(in) :: from, to
    real(wp) :: start(n), last(n), step(n), size_of_residual
    integer :: iteration, halving, pivots(n), info

    start = x
    call linear_part(2*pi*to)
    call evaluate
    do iteration = 1, 30
      size_of_residual = norm2(residual)
      if (size_of_residual < tolerance*excitation) return
      last = x
      step = residual
      call dgesv(n, 1, jacobian, n, pivots, step, n, info)
      do halving = 0, 10                               ! a step that does not reduce the residual is halved
        x = last - step/2**halving
        call evaluate
        if (norm2(residual) < size_of_residual) exit
      end do
    end do
    if (abs(to - from) < 1e-3_wp) error stop 'no convergence'
    x = start
    call follow(from, (from + to)/2)
    call follow((from + to)/2, to)
  end subroutine follow

  ! The matrix of all harmonics: K - (k w)^2 M on both coefficients of harmonic k, and k w D from one to the other.
  subroutine linear_part(omega)
    real(wp), intent(in) :: omega
    integer :: k

    linear = 0
    linear(1::m, 1::m) = stiffness
    do k = 1, harmonics
      linear(2*k::m, 2*k::m) = stiffness - (k*omega)**2*mass
      linear(2*k + 1::m, 2*k + 1::m) = linear(2*k::m, 2*k::m)
      linear(2*k::m, 2*k + 1::m) = k*omega*damping
      linear(2*k + 1::m, 2*k::m) = -k*omega*damping
    end do
  end subroutine linear_part

  ! The residual at x and its Jacobian: the structure, less the excitation, plus the contact at mass 2.
  subroutine evaluate
    real(wp) :: force(m), slope(m, m)

    call contact_force(x(m + 1:), force, slope)
    residual = matmul(linear, x)
    residual(2) = residual(2) - excitation
    residual(m + 1:) = residual(m + 1:) + force
    jacobian = linear
    jacobian(m + 1:, m + 1:) = jacobian(m + 1:, m + 1:) + slope
  end subroutine evaluate

  ! Energy per period: the work of the excitation, less the energy of the dashpots.
  real(wp) function contact_energy(omega)
    real(wp), intent(in) :: omega
    integer :: c

    contact_energy = pi*excitation*x(3)
    do c = 2, m
      contact_energy = contact_energy - pi*omega*(c/2)**2*dot_product(x([c, m + c]), matmul(damping, x([c, m + c])))
    end do
  end function contact_energy
end program balance
