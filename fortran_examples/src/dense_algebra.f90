!> LAPACK with the sizes taken from the arrays.
module dense_algebra
  use basics, only: fail, text, wp
  implicit none
  private
  public :: solve, symmetric_modes

  !> Solves A X = B. A is destroyed, B becomes X.
  interface solve
    module procedure solve_real, solve_complex
  end interface solve

contains

  !> Without `singular` a singular matrix ends the program.
  subroutine solve_real(a, b, singular)
    real(wp), intent(inout) :: a(:,:), b(:,:)
    logical, intent(out), optional :: singular
    integer :: pivot(size(a, 1)), info
    external :: dgesv

    call dgesv(size(a, 1), size(b, 2), a, size(a, 1), pivot, b, size(b, 1), info)
    if (present(singular)) then
      singular = info /= 0
    else if (info /= 0) then
      call fail('linear system of order '//text(size(a, 1))//' is singular')
    end if
  end subroutine solve_real

  subroutine solve_complex(a, b)
    complex(wp), intent(inout) :: a(:,:), b(:,:)
    integer :: pivot(size(a, 1)), info
    external :: zgesv

    call zgesv(size(a, 1), size(b, 2), a, size(a, 1), pivot, b, size(b, 1), info)
    if (info /= 0) call fail('dynamic stiffness of order '//text(size(a, 1))//' is singular')
  end subroutine solve_complex

  !> Natural angular frequencies, ascending, and mass-normalised modes of K x = omega**2 M x.
  subroutine symmetric_modes(stiffness, mass, omega, modes)
    real(wp), intent(in) :: stiffness(:,:), mass(:,:)
    real(wp), intent(out) :: omega(:), modes(:,:)
    real(wp) :: mass_factor(size(mass, 1), size(mass, 1)), work(64 * size(mass, 1))
    integer :: info, n
    external :: dsygv

    n = size(mass, 1)
    modes = stiffness
    mass_factor = mass
    call dsygv(1, 'V', 'U', n, modes, n, mass_factor, n, omega, work, size(work), info)
    if (info /= 0) call fail('eigenvalue solution of order '//text(n)//' failed: is the mass matrix positive definite?')
    omega = sqrt(max(omega, 0.0_wp))
  end subroutine symmetric_modes
end module dense_algebra
