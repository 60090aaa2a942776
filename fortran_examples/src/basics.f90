!> Kinds, text made of numbers, tables of comma-separated values, and errors that end a program.
module basics
  use, intrinsic :: iso_c_binding, only: c_int
  use, intrinsic :: iso_fortran_env, only: error_unit, output_unit, real64
  implicit none
  private
  public :: argument, fail, open_table, progress, text

  integer, parameter, public :: wp = real64
  real(wp), parameter, public :: pi = acos(-1.0_wp)
  !> Format of a row of a table, with as many digits as restore the same doubles.
  character(len=*), parameter, public :: row = '(*(g0,:,","))'
  integer, parameter, public :: path_length = 256, name_length = 32

  interface text
    module procedure text_of_integer, text_of_real
  end interface text

  interface
    ! STOP would also print the pending floating-point flags.
    subroutine c_exit(code) bind(c, name='exit')
      import :: c_int
      integer(c_int), value :: code
    end subroutine c_exit
  end interface

contains

  !> Ends the program with exit code 1.
  subroutine fail(message)
    character(len=*), intent(in) :: message

    flush (output_unit)
    write (error_unit, '(2a)') 'error: ', message
    flush (error_unit)
    call c_exit(1_c_int)
  end subroutine fail

  !> One line of output, flushed for pipes.
  subroutine progress(message)
    character(len=*), intent(in) :: message

    write (output_unit, '(a)') message
    flush (output_unit)
  end subroutine progress

  !> Command line argument; `usage` is printed if it is missing.
  function argument(position, usage) result(value)
    integer, intent(in) :: position
    character(len=*), intent(in) :: usage
    character(len=path_length) :: value

    if (command_argument_count() < position) call fail('usage: '//usage)
    call get_command_argument(position, value)
  end function argument

  pure function text_of_integer(number) result(string)
    integer, intent(in) :: number
    character(len=:), allocatable :: string
    character(len=20) :: buffer

    write (buffer, '(i0)') number
    string = trim(buffer)
  end function text_of_integer

  pure function text_of_real(number, format) result(string)
    real(wp), intent(in) :: number
    character(len=*), intent(in) :: format
    character(len=:), allocatable :: string
    character(len=40) :: buffer

    write (buffer, format) number
    string = trim(adjustl(buffer))
  end function text_of_real

  !> Unit of a new file with this first line.
  integer function open_table(path, header) result(unit)
    character(len=*), intent(in) :: path, header
    character(len=200) :: message
    integer :: status

    open (newunit=unit, file=path, status='replace', action='write', iostat=status, iomsg=message)
    if (status /= 0) call fail(path//': cannot be written: '//trim(message))
    write (unit, '(a)') header
  end function open_table
end module basics
