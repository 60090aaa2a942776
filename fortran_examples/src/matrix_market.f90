!> Real matrices in Matrix Market files (https://math.nist.gov/MatrixMarket/formats.html), kept dense.
module matrix_market
  use kinds, only: wp
  use messages, only: fail, text
  implicit none
  private
  public :: read_matrix, write_symmetric_matrix

contains

  !> Reads `array` or `coordinate`, `real` or `integer`, `general` or `symmetric`.
  subroutine read_matrix(path, matrix)
    character(len=*), intent(in) :: path
    real(wp), allocatable, intent(out) :: matrix(:,:)
    character(len=512) :: line, message
    character(len=20) :: banner, object, layout, field, symmetry
    real(wp) :: value
    integer :: unit, status, line_number, rows, columns, entries, i, j, k
    logical :: symmetric

    open (newunit=unit, file=path, status='old', action='read', iostat=status, iomsg=message)
    if (status /= 0) call fail(path//': cannot be opened: '//trim(message))

    read (unit, '(a)', iostat=status) line
    line_number = 1
    if (status == 0) read (line, *, iostat=status) banner, object, layout, field, symmetry
    if (status /= 0) call bad('expected "%%MatrixMarket matrix <layout> <field> <symmetry>"')
    if (banner /= '%%MatrixMarket' .or. object /= 'matrix') call bad('not a Matrix Market matrix')
    if (all(layout /= ['array     ', 'coordinate'])) call bad('layout must be array or coordinate')
    if (all(field /= ['real   ', 'integer'])) call bad('field must be real or integer')
    if (all(symmetry /= ['general  ', 'symmetric'])) call bad('symmetry must be general or symmetric')
    symmetric = symmetry == 'symmetric'

    call next_line()
    if (layout == 'array') then
      read (line, *, iostat=status) rows, columns
    else
      read (line, *, iostat=status) rows, columns, entries
    end if
    if (status /= 0) call bad('expected the size of the matrix')
    if (rows < 1 .or. columns < 1) call bad('the size must be positive')
    if (symmetric .and. rows /= columns) call bad('a symmetric matrix must be square')

    allocate (matrix(rows, columns), source=0.0_wp)
    if (layout == 'array') then
      do j = 1, columns
        do i = merge(j, 1, symmetric), rows
          call next_line()
          read (line, *, iostat=status) value
          if (status /= 0) call bad('expected a number')
          call store()
        end do
      end do
    else
      do k = 1, entries
        call next_line()
        read (line, *, iostat=status) i, j, value
        if (status /= 0) call bad('expected row, column and value')
        if (min(i, j) < 1 .or. i > rows .or. j > columns) call bad('entry outside the matrix')
        call store()
      end do
    end if
    close (unit)

  contains

    subroutine store()
      matrix(i, j) = value
      if (symmetric) matrix(j, i) = value
    end subroutine store

    subroutine next_line()
      do
        read (unit, '(a)', iostat=status) line
        line_number = line_number + 1
        if (status /= 0) call bad('the file ends too early')
        if (len_trim(line) > 0 .and. line(1:1) /= '%') exit
      end do
    end subroutine next_line

    subroutine bad(what)
      character(len=*), intent(in) :: what
      call fail(path//', line '//text(line_number)//': '//what)
    end subroutine bad
  end subroutine read_matrix

  !> Lower triangle, 17 digits: reading it back gives the same doubles.
  subroutine write_symmetric_matrix(path, comment, matrix)
    character(len=*), intent(in) :: path, comment
    real(wp), intent(in) :: matrix(:,:)
    character(len=200) :: message
    integer :: unit, status, i, j

    open (newunit=unit, file=path, status='replace', action='write', iostat=status, iomsg=message)
    if (status /= 0) call fail(path//': cannot be written: '//trim(message))
    write (unit, '(a)') '%%MatrixMarket matrix array real symmetric'
    write (unit, '(2a)') '% ', comment
    write (unit, '(i0, 1x, i0)') shape(matrix)
    do j = 1, size(matrix, 2)
      do i = j, size(matrix, 1)
        write (unit, '(es24.16e3)') matrix(i, j)
      end do
    end do
    close (unit)
  end subroutine write_symmetric_matrix
end module matrix_market
