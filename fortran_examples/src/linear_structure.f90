!> The linear part of a model: symmetric matrices in Matrix Market files, and the names of its degrees of freedom.
module linear_structure
  use basics, only: fail, name_length, open_table, text, wp
  implicit none
  private
  public :: read_structure, read_matrix

  type, public :: structure
    real(wp), allocatable :: mass(:,:), damping(:,:), stiffness(:,:)
    character(len=name_length), allocatable :: dof_name(:)
  end type structure

contains

  subroutine read_structure(mass_file, damping_file, stiffness_file, dof_file, model)
    character(len=*), intent(in) :: mass_file, damping_file, stiffness_file, dof_file
    type(structure), intent(out) :: model

    call read_dof_names(dof_file, model%dof_name)
    call read_matrix(mass_file, size(model%dof_name), model%mass)
    call read_matrix(damping_file, size(model%dof_name), model%damping)
    call read_matrix(stiffness_file, size(model%dof_name), model%stiffness)
  end subroutine read_structure

  !> Lines "number name", numbered from 1; # starts a comment.
  subroutine read_dof_names(path, names)
    character(len=*), intent(in) :: path
    character(len=name_length), allocatable, intent(out) :: names(:)
    character(len=512) :: line
    character(len=name_length) :: name
    integer :: unit, status, dof

    open (newunit=unit, file=path, status='old', action='read', iostat=status)
    if (status /= 0) call fail(trim(path)//': cannot be opened')
    allocate (names(0))
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      if (len_trim(line) == 0 .or. line(1:1) == '#') cycle
      read (line, *, iostat=status) dof, name
      if (status /= 0 .or. dof /= size(names) + 1) call fail(trim(path)//': expected "'//text(size(names) + 1)//' name"')
      names = [names, name]
    end do
    close (unit)
  end subroutine read_dof_names

  !> A symmetric matrix of order n from a real Matrix Market file (https://math.nist.gov/MatrixMarket/formats.html) with its
  !> lower triangle ("symmetric") or all entries ("general"), column by column ("array") or as triples ("coordinate").
  subroutine read_matrix(path, n, matrix)
    character(len=*), intent(in) :: path
    integer, intent(in) :: n
    real(wp), allocatable, intent(out) :: matrix(:,:)
    character(len=512) :: line
    character(len=20) :: banner, object, layout, field, symmetry
    real(wp) :: value
    integer :: unit, status, rows, columns, entries, i, j, k
    logical :: triples, symmetric

    open (newunit=unit, file=path, status='old', action='read', iostat=status)
    call require(status == 0, 'cannot be opened')
    read (unit, *, iostat=status) banner, object, layout, field, symmetry
    triples = layout == 'coordinate'
    symmetric = symmetry == 'symmetric'
    call require(status == 0 .and. banner == '%%MatrixMarket' .and. object == 'matrix' .and. field == 'real' .and. &
                 (triples .or. layout == 'array') .and. (symmetric .or. symmetry == 'general'), &
                 'must begin with "%%MatrixMarket matrix array|coordinate real general|symmetric"')
    do
      read (unit, '(a)', iostat=status) line
      call require(status == 0, 'ends before the size of the matrix')
      if (len_trim(line) > 0 .and. line(1:1) /= '%') exit
    end do
    entries = 0
    if (triples) then
      read (line, *, iostat=status) rows, columns, entries
    else
      read (line, *, iostat=status) rows, columns
    end if
    call require(status == 0 .and. all([rows, columns] == n), 'must have '//text(n)//' rows and columns')

    allocate (matrix(n, n), source=0.0_wp)
    do k = 1, entries
      read (unit, *, iostat=status) i, j, value
      call require(status == 0 .and. min(i, j) >= 1 .and. max(i, j) <= n, 'expected row, column, value '//text(k))
      call store()
    end do
    if (.not. triples) then
      do j = 1, n
        do i = merge(j, 1, symmetric), n
          read (unit, *, iostat=status) value
          call require(status == 0, 'expected the value of row '//text(i)//', column '//text(j))
          call store()
        end do
      end do
    end if
    close (unit)
    ! The condensation to the contacts uses the symmetry.
    call require(maxval(abs(matrix - transpose(matrix))) <= 1.0e-12_wp * maxval(abs(matrix)), 'must be symmetric')

  contains

    subroutine store()
      matrix(i, j) = value
      if (symmetric) matrix(j, i) = value
    end subroutine store

    subroutine require(condition, message)
      logical, intent(in) :: condition
      character(len=*), intent(in) :: message
      if (.not. condition) call fail(trim(path)//': '//message)
    end subroutine require
  end subroutine read_matrix
end module linear_structure
