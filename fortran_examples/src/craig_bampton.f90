!> Reduction to boundary degrees of freedom, which stay physical, and modes with the boundary fixed
!> (Craig and Bampton, AIAA Journal 6, 1968).
module craig_bampton
  use dense_algebra, only: solve, symmetric_modes
  use kinds, only: wp
  implicit none
  private
  public :: reduce

contains

  !> Reduced order: the boundary in the order given, then `mode_count` modal coordinates.
  subroutine reduce(mass, stiffness, boundary, mode_count, reduced_mass, reduced_stiffness)
    real(wp), intent(in) :: mass(:,:), stiffness(:,:)
    integer, intent(in) :: boundary(:), mode_count
    real(wp), allocatable, intent(out) :: reduced_mass(:,:), reduced_stiffness(:,:)
    real(wp), allocatable :: basis(:,:), constraint(:,:), factor(:,:), modes(:,:), omega(:)
    integer, allocatable :: interior(:)
    integer :: n, nb, i

    n = size(mass, 1)
    nb = size(boundary)
    interior = pack([(i, i=1, n)], [(all(boundary /= i), i=1, n)])

    ! Static deflections of the interior under unit displacements of the boundary.
    factor = stiffness(interior, interior)
    constraint = -stiffness(interior, boundary)
    call solve(factor, constraint)

    allocate (omega(size(interior)), modes(size(interior), size(interior)))
    call symmetric_modes(stiffness(interior, interior), mass(interior, interior), omega, modes)

    allocate (basis(n, nb + mode_count), source=0.0_wp)
    do i = 1, nb
      basis(boundary(i), i) = 1.0_wp
    end do
    basis(interior, 1:nb) = constraint
    do i = 1, mode_count
      ! The sign of a mode is arbitrary; a fixed choice makes the files independent of the LAPACK at hand.
      basis(interior, nb + i) = sign(1.0_wp, sum(modes(:, i))) * modes(:, i)
    end do

    reduced_mass = matmul(transpose(basis), matmul(mass, basis))
    reduced_stiffness = matmul(transpose(basis), matmul(stiffness, basis))
    reduced_mass = 0.5_wp * (reduced_mass + transpose(reduced_mass))
    reduced_stiffness = 0.5_wp * (reduced_stiffness + transpose(reduced_stiffness))
  end subroutine reduce
end module craig_bampton
