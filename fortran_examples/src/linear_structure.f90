!> The linear part of a model: symmetric matrices in Matrix Market files.
module linear_structure
  use basics, only: fail, text, wp
  implicit none
  private
  public :: read_structure

  type, public :: structure
    real(wp), allocatable :: mass(:,:), damping(:,:), stiffness(:,:)
  end type structure

contains

  !> From the files PREFIX_mass.mtx, PREFIX_damping.mtx and PREFIX_stiffness.mtx.
  subroutine read_structure(prefix, model)
    character(len=*), intent(in) :: prefix
    type(structure), intent(out) :: model

    call read_matrix(prefix//'_mass.mtx', model%mass)
    call read_matrix(prefix//'_damping.mtx', model%damping)
    call read_matrix(prefix//'_stiffness.mtx', model%stiffness)
    if (any([size(model%damping, 1), size(model%stiffness, 1)] /= size(model%mass, 1))) call fail(prefix//': sizes differ')
  end subroutine read_structure

  !> The lower triangle of a symmetric matrix as triples (https://math.nist.gov/MatrixMarket/formats.html).
  subroutine read_matrix(path, matrix)
    character(len=*), intent(in) :: path
    real(wp), allocatable, intent(out) :: matrix(:,:)
    character(len=512) :: line
    real(wp) :: value
    integer :: unit, status, n, columns, entries, i, j, k

    open (newunit=unit, file=path, status='old', action='read', iostat=status)
    if (status /= 0) call fail(path//': cannot be opened')
    read (unit, '(a)', iostat=status) line
    if (line /= '%%MatrixMarket matrix coordinate real symmetric') call fail(path//': must be a real symmetric coordinate matrix')
    do while (line(1:1) == '%' .and. status == 0)
      read (unit, '(a)', iostat=status) line
    end do
    read (line, *, iostat=status) n, columns, entries
    if (status /= 0 .or. n /= columns) call fail(path//': expected the size of the matrix and the number of its entries')
    allocate (matrix(n, n), source=0.0_wp)
    do k = 1, entries
      read (unit, *, iostat=status) i, j, value
      if (status /= 0 .or. min(i, j) < 1 .or. max(i, j) > n) call fail(path//': expected row, column, value '//text(k))
      matrix(i, j) = value
      matrix(j, i) = value
    end do
    close (unit)
  end subroutine read_matrix
end module linear_structure
