module checks
  ! Checks that are counted: a failure is printed with its values and does not stop the program. Parameters for tests.
  use microslip, only: MSLIP_CENTRE_POINT, mslip_int, mslip_material, mslip_parameters, mslip_real, mslip_status_text
  implicit none
  private
  public :: wp, untouched, flat_parameters, check, check_status, check_close, check_same, report

  integer, parameter :: wp = mslip_real
  ! The value of outputs before a call, to check that a rejected call does not modify them.
  real(wp), parameter :: untouched = -777.0_wp

  integer :: passed = 0, failed = 0

contains

  pure function flat_parameters(i) result(flat)
    ! The contacts of a batch differ by their loads; the first has 800 N.
    integer, intent(in) :: i
    type(mslip_parameters) :: flat

    flat = mslip_parameters(flat_half_width=5.0e-4_wp, edge_radius=3.0e-3_wp, length=2.0e-2_wp, normal_force=790.0_wp + 10*i, &
      friction_coefficient=0.5_wp, material=[mslip_material(1.14e11_wp, 0.32_wp), mslip_material(2.0e11_wp, 0.29_wp)], &
      displacement_reference=MSLIP_CENTRE_POINT)
  end function flat_parameters

  subroutine check(name, condition)
    character(len=*), intent(in) :: name
    logical, intent(in) :: condition

    if (condition) then
      passed = passed + 1
    else
      failed = failed + 1
      print '(2a)', 'FAILED: ', name
    end if
  end subroutine check

  subroutine check_status(name, status, expected)
    character(len=*), intent(in) :: name
    integer(mslip_int), intent(in) :: status, expected

    call check(name, status == expected)
    if (status /= expected) then
      print '(2x,a,i0,2a)', 'status   ', status, ': ', mslip_status_text(status)
      print '(2x,a,i0,2a)', 'expected ', expected, ': ', mslip_status_text(expected)
    end if
  end subroutine check_status

  subroutine check_close(name, value, expected, tolerance)
    ! The difference relative to the expected value, or absolute if 0 is expected.
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: value, expected, tolerance

    real(wp) :: scale
    logical :: close

    scale = abs(expected)
    if (.not. scale > 0) scale = 1
    close = abs(value - expected) <= tolerance*scale
    call check(name, close)
    if (.not. close) print '(2x,a,es24.16,a,es24.16,a,es9.1)', 'got', value, ', expected', expected, ', tolerance', tolerance
  end subroutine check_close

  subroutine check_same(name, values, expected)
    ! Equal values; 0 and -0 are equal.
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: values(:), expected(:)

    integer :: i
    logical :: same

    same = size(values) == size(expected)
    if (same) same = all(abs(values - expected) <= 0)
    call check(name, same)
    if (.not. same) print '(2x,es24.16,es24.16)', (values(i), expected(i), i = 1, min(size(values), size(expected)))
  end subroutine check_same

  subroutine report()
    print '(i0,a,i0,a)', passed, ' passed, ', failed, ' failed'
    if (failed > 0) error stop 1
  end subroutine report

end module checks
