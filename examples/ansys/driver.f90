! Calls the bodies of the user subroutines for ANSYS as a contact element does: see ../host.f90.
module ansys_calls
  use checks
  use contact_bodies
  use host
  use microslip
  implicit none
  public

  integer, parameter :: points = 3
  ! a, R, L, N, mu, E1, nu1, E2, nu2, area
  real(wp), parameter :: areas(points) = [20e-6_wp, 30e-6_wp, 10e-6_wp]      ! of the points: shares of one contact, m2
  real(wp), parameter :: properties(10) = [0.5e-3_wp, 3e-3_wp, 20e-3_wp, 1600.0_wp, 0.5_wp, 2e11_wp, 0.3_wp, 2e11_wp, 0.3_wp, &
    60e-6_wp]
  real(wp), parameter :: gap = 1e-6_wp                          ! m
  real(wp), parameter :: penalty = 5e12_wp                      ! normal stiffness of the element beside the friction, Pa/m
  integer :: directions = 1

contains

  !> The unknowns are slip and penetration; the element has a penalty for the latter.
  subroutine call_friction(point, x_start, x, before, after, force, tangent, dissipated, ratio)
    integer, intent(in) :: point
    real(wp), intent(in) :: x_start(:), x(:), before(:)
    real(wp), intent(out) :: after(:), force(:), tangent(:, :), dissipated, ratio
    real(wp) :: shear(size(x) - 1), by_slip(size(x) - 1, size(x) - 1), by_pressure(size(x) - 1), contact_stiffness
    integer(mslip_int) :: status
    integer :: m

    m = size(x)
    shear = 0
    by_slip = 0
    by_pressure = 0
    dissipated = 0
    after = before
    call friction_body(m, properties, x(:m-1) - x_start(:m-1), penalty*x_start(m), penalty*x(m), before, after, shear, by_slip, &
      by_pressure, dissipated, status)
    ratio = request(status)
    contact_stiffness = merge(penalty, 0.0_wp, x(m) > 0)
    force = areas(point)*[shear, contact_stiffness*x(m)]
    tangent(:m-1, :m-1) = areas(point)*by_slip
    tangent(:m-1, m) = areas(point)*by_pressure*contact_stiffness
    tangent(m, :m-1) = 0
    tangent(m, m) = areas(point)*contact_stiffness
    dissipated = areas(point)*dissipated
  end subroutine call_friction

  !> The unknowns are slip and penetration.
  subroutine call_interaction(point, x_start, x, before, after, force, tangent, dissipated, ratio)
    integer, intent(in) :: point
    real(wp), intent(in) :: x_start(:), x(:), before(:)
    real(wp), intent(out) :: after(:), force(:), tangent(:, :), dissipated, ratio
    integer(mslip_int) :: status

    force = 0
    tangent = 0
    dissipated = 0
    after = before
    call interaction_body(size(x), properties, -gap, x_start, x, before, after, force, tangent, dissipated, status)
    ratio = request(status)
    force = areas(point)*force
    tangent = areas(point)*tangent
    dissipated = areas(point)*dissipated
  end subroutine call_interaction

  !> As an element would: 1, a shorter substep, or the end.
  function request(status) result(ratio)
    integer(mslip_int), intent(in) :: status
    real(wp) :: ratio

    ratio = 1
    if (increment_too_long(status)) then
      ratio = 0.5_wp
    else if (status /= MSLIP_OK) then
      print '(a)', mslip_status_text(status)
      error stop 1
    end if
  end function request

end module ansys_calls

program driver
  use ansys_calls
  implicit none

  call check('state variables in 2-D: start and finish of a point fit into an element', 2*contact_variables(1) <= 840)
  do directions = 1, 2
    call run(model('friction', MSLIP_INPUT_NORMAL_FORCE, call_friction))
    call run(model('interaction', MSLIP_INPUT_APPROACH, call_interaction))
    call test_closing()
  end do
  call report()

contains

  function model(name, normal_input, call_user)
    character(len=*), intent(in) :: name
    integer, intent(in) :: normal_input
    procedure(call_friction) :: call_user
    type(contact_model) :: model

    model = points_of(name, spread(element_of(properties(:9), directions, normal_input), 1, points), areas/properties(10), &
      contact_variables(directions), call_user)
    if (normal_input == MSLIP_INPUT_APPROACH) then
      model%offset(directions + 1) = -gap
    else
      model%to_law(directions + 1, directions + 1, :) = properties(10)*penalty
    end if
  end function model

  !> A contact that was open has lost its history, even if the friction was not called meanwhile.
  subroutine test_closing()
    real(wp), dimension(contact_variables(directions)) :: initial, slipped, after
    real(wp), dimension(directions + 1) :: x0, x, far, force, expected
    real(wp) :: tangent(directions + 1, directions + 1), dissipated, ratio

    initial = 0
    x0 = 0
    x = 0
    x(1) = 2e-8_wp                                              ! sticks while the contact closes
    x(directions + 1) = 1e-6_wp
    far = x
    far(1) = 5e-6_wp                                            ! slips grossly
    call call_friction(1, x0, x, initial, after, expected, tangent, dissipated, ratio)
    call call_friction(1, x0, far, initial, slipped, force, tangent, dissipated, ratio)
    call call_friction(1, x0, x, slipped, after, force, tangent, dissipated, ratio)
    call check('friction, closing: history begins anew', norm2(force - expected) <= 1e-12_wp*norm2(expected))
    call check('friction, closing: energy so far', after(1) >= slipped(1) .and. slipped(1) > 0)
  end subroutine test_closing

end program driver
