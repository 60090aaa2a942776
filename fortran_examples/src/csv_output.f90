!> Comma-separated tables with a header.
module csv_output
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: wp
  use messages, only: fail, text
  implicit none
  private

  type, public :: csv_file
    integer, private :: unit = 0
    integer(int64), private :: bytes = 0                   !! of all rows
    character(len=:), allocatable, private :: path, line
  contains
    procedure :: open => open_csv
    procedure, private :: add_text, add_integer, add_real, add_reals
    generic :: add => add_text, add_integer, add_real, add_reals
    procedure :: end_row
    procedure :: close => close_csv
  end type csv_file

contains

  subroutine open_csv(self, path)
    class(csv_file), intent(inout) :: self
    character(len=*), intent(in) :: path
    character(len=200) :: message
    integer :: status

    open (newunit=self%unit, file=path, status='replace', action='write', iostat=status, iomsg=message)
    if (status /= 0) call fail(path//': cannot be written: '//trim(message))
    self%path = path
    self%line = ''
    self%bytes = 0
  end subroutine open_csv

  subroutine add_text(self, field)
    class(csv_file), intent(inout) :: self
    character(len=*), intent(in) :: field

    if (len(self%line) > 0) self%line = self%line//','
    self%line = self%line//trim(field)
  end subroutine add_text

  subroutine add_integer(self, field)
    class(csv_file), intent(inout) :: self
    integer, intent(in) :: field

    call self%add_text(text(field))
  end subroutine add_integer

  !> 17 digits, so that a table read again gives the same doubles.
  subroutine add_real(self, field)
    class(csv_file), intent(inout) :: self
    real(wp), intent(in) :: field

    call self%add_text(text(field, '(es24.16e3)'))
  end subroutine add_real

  subroutine add_reals(self, fields)
    class(csv_file), intent(inout) :: self
    real(wp), intent(in) :: fields(:)
    integer :: i

    do i = 1, size(fields)
      call self%add_real(fields(i))
    end do
  end subroutine add_reals

  subroutine end_row(self)
    class(csv_file), intent(inout) :: self

    write (self%unit, '(a)') self%line
    self%bytes = self%bytes + len(self%line) + 1
    self%line = ''
  end subroutine end_row

  !> Not every Fortran library tells of a disk that is full: what the system has is counted.
  subroutine close_csv(self)
    class(csv_file), intent(inout) :: self
    integer(int64) :: bytes

    close (self%unit)
    inquire (file=self%path, size=bytes)
    if (bytes < self%bytes) call fail(self%path//': could not be written, for want of room')
  end subroutine close_csv
end module csv_output
