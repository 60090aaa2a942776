! The contact before: one Jenkins element, a spring kt in series with a slider mu*N.
module slider
  implicit none
  integer, parameter :: wp = kind(1.0d0), samples = 128
  real(wp), parameter :: pi = acos(-1.0_wp)
  real(wp) :: kt = 2.171986e8_wp, mu_n = 60             ! kt: as printed by after
  real(wp), allocatable :: basis(:, :)
end module slider

subroutine contact_init(harmonics)
  use slider
  implicit none
  integer, intent(in) :: harmonics
  integer :: i, k

  allocate (basis(2*harmonics + 1, samples))
  do i = 1, samples
    basis(:, i) = [1.0_wp, (cos(2*pi*k*i/samples), sin(2*pi*k*i/samples), k = 1, harmonics)]
  end do
end subroutine contact_init

subroutine contact_force(u, force, jacobian)
  use slider
  implicit none
  real(wp), intent(in) :: u(size(basis, 1))
  real(wp), intent(out) :: force(size(basis, 1)), jacobian(size(basis, 1), size(basis, 1))
  real(wp) :: now, last, f, slope(size(basis, 1)), weight(size(basis, 1))
  integer :: period, i, j

  weight = 2.0_wp/samples
  weight(1) = 1.0_wp/samples
  f = 0; last = 0; slope = 0
  do period = 1, 2                                      ! the second one is steady
    force = 0; jacobian = 0
    do i = 1, samples
      now = dot_product(u, basis(:, i))
      f = f + kt*(now - last)                           ! the spring
      slope = slope + kt*basis(:, i)
      if (i > 1 .or. period > 1) slope = slope - kt*basis(:, modulo(i - 2, samples) + 1)
      if (abs(f) > mu_n) then                           ! the slider
        f = sign(mu_n, f)
        slope = 0
      end if
      last = now
      force = force + weight*basis(:, i)*f
      do j = 1, size(u)
        jacobian(:, j) = jacobian(:, j) + weight*basis(:, i)*slope(j)
      end do
    end do
  end do
end subroutine contact_force
