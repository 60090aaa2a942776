!> A file of records of one length, each at the place of its unit and with a checksum: what was written before a run ended,
!> however it ended, is found by the next, and the complete file does not depend on the order of writing.
module sweep_results
  use, intrinsic :: iso_c_binding, only: c_double, c_long, c_size_t
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: wp
  use messages, only: fail
  implicit none
  private
  public :: checksum

  type, public :: results_file
    integer, private :: file = 0
    integer(int64), private :: key = 0_int64               !! of what the results depend on
  contains
    procedure :: open => open_results
    procedure :: find
    procedure :: keep
    procedure :: close => close_results
  end type results_file

  character(len=8), parameter :: mark = 'SWEEP  1'
  integer(int64), parameter :: header_bytes = 32, number_bytes = 8

  interface
    ! Of zlib.
    pure function crc32_z(start, numbers, bytes) bind(c, name='crc32_z') result(sum)
      import :: c_double, c_long, c_size_t
      integer(c_long), value, intent(in) :: start
      real(c_double), intent(in) :: numbers(*)
      integer(c_size_t), value, intent(in) :: bytes
      integer(c_long) :: sum
    end function crc32_z
  end interface

contains

  !> CRC-32 of the numbers, going on from that of others.
  pure integer(int64) function checksum(start, numbers)
    integer(int64), intent(in) :: start
    real(wp), intent(in), contiguous :: numbers(:)
    checksum = crc32_z(int(start, c_long), numbers, number_bytes * size(numbers, kind=c_size_t))
  end function checksum

  subroutine open_results(self, path, key, units, record_length)
    class(results_file), intent(inout) :: self
    character(len=*), intent(in) :: path
    integer(int64), intent(in) :: key
    integer, intent(in) :: units, record_length
    character(len=len(mark)) :: found_mark
    integer(int64) :: found(3)
    integer(int64) :: bytes
    integer :: status, unit

    self%key = key
    call connect()
    read (self%file, pos=1, iostat=status) found_mark, found
    if (status /= 0) then
      ! A new file, or one whose writer came no farther than this.
      write (self%file, pos=1) mark, key, int(units, int64), int(record_length, int64)
    else if (found_mark /= mark .or. any(found /= [key, int(units, int64), int(record_length, int64)])) then
      call fail(path//' has the results of other cases: remove it, or name another directory')
    end if
    ! The room for all records is taken now, for not every Fortran library tells of a disk that is full.
    inquire (self%file, size=bytes)
    do unit = int((bytes - header_bytes) / record_bytes(record_length)) + 1, units
      write (self%file, pos=place(unit, record_length)) spread(0_int64, 1, record_length + 1)
    end do
    close (self%file)
    inquire (file=path, size=bytes)
    if (bytes < place(units + 1, record_length) - 1) call fail(path//': there is no room for all records')
    call connect()

  contains

    subroutine connect()
      character(len=200) :: message

      open (newunit=self%file, file=path, access='stream', form='unformatted', action='readwrite', status='unknown', &
            iostat=status, iomsg=message)
      if (status /= 0) call fail(path//': cannot be opened: '//trim(message))
    end subroutine connect
  end subroutine open_results

  !> Whether the record of a unit is there and whole.
  subroutine find(self, unit, record, found)
    class(results_file), intent(in) :: self
    integer, intent(in) :: unit
    real(wp), intent(out), contiguous :: record(:)
    logical, intent(out) :: found
    integer(int64) :: sum
    integer :: status

    read (self%file, pos=place(unit, size(record)), iostat=status) record, sum
    found = status == 0
    if (found) found = sum == checksum(self%key, record) .and. nint(record(1)) == unit
  end subroutine find

  !> Writes a record, whose first number is that of the unit, and hands it to the system before it returns.
  subroutine keep(self, record)
    class(results_file), intent(in) :: self
    real(wp), intent(in), contiguous :: record(:)

    write (self%file, pos=place(nint(record(1)), size(record))) record, checksum(self%key, record)
    flush (self%file)
  end subroutine keep

  subroutine close_results(self)
    class(results_file), intent(in) :: self
    close (self%file)
  end subroutine close_results

  pure integer(int64) function place(unit, record_length)
    integer, intent(in) :: unit, record_length
    place = 1 + header_bytes + (unit - 1) * record_bytes(record_length)
  end function place

  !> With the checksum.
  pure integer(int64) function record_bytes(record_length)
    integer, intent(in) :: record_length
    record_bytes = number_bytes * (record_length + 1)
  end function record_bytes
end module sweep_results
