!> Compares a table with stored values.
!>
!>     compare_tables STORED FOUND
!>
!> STORED is a CSV file whose second line, "# tolerance,...", gives for each column the allowed relative difference, or
!> after "abs" the allowed absolute one; a column with tolerance 0 must agree as text. The exit code is 1 at the first
!> difference.
program compare_tables
  use kinds, only: path_length, wp
  use messages, only: fail, progress, text
  implicit none

  integer, parameter :: max_line_length = 4000, max_fields = 100
  character(len=path_length) :: stored_file, found_file
  character(len=max_line_length) :: stored, found
  character(len=40) :: tolerance_field(max_fields), stored_field(max_fields), found_field(max_fields)
  character(len=40) :: column(max_fields)
  integer :: stored_unit, found_unit, fields, row, i, stored_status, found_status
  real(wp) :: tolerance, worst

  if (command_argument_count() /= 2) call fail('usage: compare_tables STORED FOUND')
  call get_command_argument(1, stored_file)
  call get_command_argument(2, found_file)
  stored_unit = opened(stored_file)
  found_unit = opened(found_file)

  read (stored_unit, '(a)', iostat=stored_status) stored
  read (found_unit, '(a)', iostat=found_status) found
  if (stored_status /= 0 .or. found_status /= 0) call fail('a table is empty')
  if (stored /= found) call fail(trim(found_file)//': the columns are not those of '//trim(stored_file))
  call split(stored, column, fields)
  read (stored_unit, '(a)', iostat=stored_status) stored
  if (stored_status /= 0 .or. stored(1:11) /= '# tolerance') then
    call fail(trim(stored_file)//', line 2: must start with "# tolerance"')
  end if
  call split(stored(12:), tolerance_field, i)
  if (i /= fields) call fail(trim(stored_file)//', line 2: '//text(fields)//' tolerances expected, found '//text(i))

  worst = 0.0_wp
  row = 0
  do
    read (stored_unit, '(a)', iostat=stored_status) stored
    read (found_unit, '(a)', iostat=found_status) found
    if (stored_status /= 0 .or. found_status /= 0) exit
    row = row + 1
    call split(stored, stored_field, i)
    if (i /= fields) call fail(trim(stored_file)//', row '//text(row)//': '//text(fields)//' fields expected')
    call split(found, found_field, i)
    if (i /= fields) call fail(trim(found_file)//', row '//text(row)//': '//text(fields)//' fields expected')
    do i = 1, fields
      call compare_field()
    end do
  end do
  if (stored_status == 0 .or. found_status == 0) then
    call fail(trim(found_file)//': the number of rows is not that of '//trim(stored_file))
  end if
  if (row == 0) call fail(trim(stored_file)//' holds no row')
  call progress(trim(found_file)//' agrees with '//trim(stored_file)//': '//text(row)//' rows, largest difference '// &
                text(worst, '(es8.1)')//' of the tolerance')

contains

  subroutine compare_field()
    real(wp) :: expected, actual, difference
    logical :: absolute
    integer :: status(3)

    if (stored_field(i) == found_field(i)) return
    absolute = tolerance_field(i)(1:4) == 'abs '
    read (tolerance_field(i)(merge(5, 1, absolute):), *, iostat=status(1)) tolerance
    read (stored_field(i), *, iostat=status(2)) expected
    read (found_field(i), *, iostat=status(3)) actual
    if (any(status /= 0)) call differ('must be '//trim(stored_field(i)))
    if (tolerance <= 0.0_wp) call differ('must be exactly '//trim(stored_field(i)))
    difference = abs(actual - expected) / (tolerance * merge(1.0_wp, abs(expected), absolute))
    if (.not. difference <= 1.0_wp) then
      call differ('must be '//trim(stored_field(i))//' within '//trim(tolerance_field(i)))
    end if
    worst = max(worst, difference)
  end subroutine compare_field

  subroutine differ(demand)
    character(len=*), intent(in) :: demand
    call fail(trim(found_file)//', row '//text(row)//', column '//trim(column(i))//' is '//trim(found_field(i))// &
              ', '//demand)
  end subroutine differ

  integer function opened(path)
    character(len=*), intent(in) :: path
    character(len=200) :: message
    integer :: status

    open (newunit=opened, file=path, status='old', action='read', iostat=status, iomsg=message)
    if (status /= 0) call fail(trim(path)//': cannot be opened: '//trim(message))
  end function opened

  !> Fields between commas; a comma at the start opens an empty field that does not count.
  subroutine split(line, field, number)
    character(len=*), intent(in) :: line
    character(len=*), intent(out) :: field(:)
    integer, intent(out) :: number
    integer :: first, comma

    number = 0
    first = merge(2, 1, line(1:1) == ',')
    do
      comma = index(line(first:), ',')
      number = number + 1
      if (number > size(field)) call fail('a table has more than '//text(size(field))//' columns')
      if (comma == 0) then
        field(number) = line(first:)
        exit
      end if
      field(number) = line(first:first + comma - 2)
      first = first + comma
    end do
  end subroutine split
end program compare_tables
