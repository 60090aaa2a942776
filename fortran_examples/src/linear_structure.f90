!> The linear part of a model: matrices from files, and the names of its degrees of freedom.
module linear_structure
  use kinds, only: name_length, wp
  use matrix_market, only: read_matrix
  use messages, only: fail, text
  implicit none
  private
  public :: read_structure, read_dof_map, write_dof_map

  type, public :: structure
    real(wp), allocatable :: mass(:,:), damping(:,:), stiffness(:,:)
    character(len=name_length), allocatable :: dof_name(:)
  end type structure

contains

  subroutine read_structure(mass_file, damping_file, stiffness_file, dof_file, model)
    character(len=*), intent(in) :: mass_file, damping_file, stiffness_file, dof_file
    type(structure), intent(out) :: model

    call read_dof_map(dof_file, model%dof_name)
    call read_square(mass_file, model%mass)
    call read_square(damping_file, model%damping)
    call read_square(stiffness_file, model%stiffness)

  contains

    subroutine read_square(path, matrix)
      character(len=*), intent(in) :: path
      real(wp), allocatable, intent(out) :: matrix(:,:)
      integer :: n

      call read_matrix(trim(path), matrix)
      n = size(model%dof_name)
      if (any(shape(matrix) /= n)) then
        call fail(trim(path)//': the matrix must have '//text(n)//' rows and columns, as many as '// &
                  trim(dof_file)//' has degrees of freedom')
      end if
      ! The condensation to the contacts uses the symmetry.
      if (maxval(abs(matrix - transpose(matrix))) > 1.0e-12_wp * maxval(abs(matrix))) then
        call fail(trim(path)//': the matrix must be symmetric')
      end if
    end subroutine read_square
  end subroutine read_structure

  !> Lines "number name", numbered from 1; lines that start with # are comments.
  subroutine read_dof_map(path, names)
    character(len=*), intent(in) :: path
    character(len=name_length), allocatable, intent(out) :: names(:)
    character(len=512) :: line, message
    character(len=name_length) :: name
    integer :: unit, status, line_number, dof

    open (newunit=unit, file=path, status='old', action='read', iostat=status, iomsg=message)
    if (status /= 0) call fail(trim(path)//': cannot be opened: '//trim(message))
    allocate (names(0))
    line_number = 0
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      line_number = line_number + 1
      if (len_trim(line) == 0 .or. line(1:1) == '#') cycle
      read (line, *, iostat=status) dof, name
      if (status /= 0) call bad('expected a number and a name')
      if (dof /= size(names) + 1) call bad('degrees of freedom must be numbered 1, 2, 3, ...')
      if (any(names == name)) call bad('the name '//trim(name)//' occurs twice')
      names = [names, name]
    end do
    close (unit)
    if (size(names) == 0) call bad('no degree of freedom found')

  contains

    subroutine bad(what)
      character(len=*), intent(in) :: what
      call fail(trim(path)//', line '//text(line_number)//': '//what)
    end subroutine bad
  end subroutine read_dof_map

  subroutine write_dof_map(path, comment, names)
    character(len=*), intent(in) :: path, comment
    character(len=*), intent(in) :: names(:)
    character(len=200) :: message
    integer :: unit, status, i

    open (newunit=unit, file=path, status='replace', action='write', iostat=status, iomsg=message)
    if (status /= 0) call fail(path//': cannot be written: '//trim(message))
    write (unit, '(2a)') '# ', comment
    do i = 1, size(names)
      write (unit, '(i0, 1x, a)') i, trim(names(i))
    end do
    close (unit)
  end subroutine write_dof_map
end module linear_structure
