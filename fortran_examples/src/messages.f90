!> Errors that end a program, and text made of numbers.
module messages
  use, intrinsic :: iso_c_binding, only: c_int
  use, intrinsic :: iso_fortran_env, only: error_unit, output_unit
  use kinds, only: wp
  implicit none
  private
  public :: fail, progress, text

  !> A number as the shortest text that is still readable.
  interface text
    module procedure text_of_integer, text_of_real
  end interface text

  !> What `fail` calls before it ends the process: where others wait for this one, it ends them too.
  procedure(), pointer, public :: end_others => null()

  interface
    ! STOP would print the pending floating-point flags after the message, which says nothing to a user.
    subroutine c_exit(code) bind(c, name='exit')
      import :: c_int
      integer(c_int), value :: code
    end subroutine c_exit
  end interface

contains

  !> Ends the program with exit code 1. `message` says where, what is wrong and what is allowed.
  subroutine fail(message)
    character(len=*), intent(in) :: message

    flush (output_unit)
    write (error_unit, '(2a)') 'error: ', message
    flush (error_unit)
    if (associated(end_others)) call end_others()
    call c_exit(1_c_int)
  end subroutine fail

  !> One line of progress, shown at once even through a pipe.
  subroutine progress(message)
    character(len=*), intent(in) :: message

    write (output_unit, '(a)') message
    flush (output_unit)
  end subroutine progress

  pure function text_of_integer(number) result(string)
    integer, intent(in) :: number
    character(len=:), allocatable :: string
    character(len=20) :: buffer

    write (buffer, '(i0)') number
    string = trim(buffer)
  end function text_of_integer

  pure function text_of_real(number, format) result(string)
    real(wp), intent(in) :: number
    character(len=*), intent(in), optional :: format
    character(len=:), allocatable :: string
    character(len=40) :: buffer

    if (present(format)) then
      write (buffer, format) number
    else
      write (buffer, '(es11.4)') number
    end if
    string = trim(adjustl(buffer))
  end function text_of_real
end module messages
