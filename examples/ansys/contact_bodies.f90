! The bodies of ANSYS user subroutines for friction (userfric) and for the whole contact interaction (userinter), without their
! argument lists, which could not be established from public sources: README.md tells what to pass from the lists in the files
! that come with ANSYS.
!
! `properties`: a, R, L [m], N [N] (the largest force expected), mu, E1 [Pa], nu1, E2 [Pa], nu2, sum of the areas of all points of
! the contact [m2]. Each point has the law of the whole contact at its own relative displacement; its stress is the force over the
! whole area, so the points share the force by their areas (../README.md).
!
! `start` and `finish` are the state variables of the last converged substep and of this iteration, contact_variables(ndim - 1) of
! each; 1 is the energy dissipated so far [J]. All are 0 at the start of an analysis. They must not be the same array: each
! iteration is a trial step from the last converged substep.
!
! On an error no output is modified. If increment_too_long(status), request a bisection of the substep; otherwise stop with
! mslip_status_text(status).
module contact_bodies
  use microslip
  use contact_point
  implicit none
  private
  public :: contact_variables, friction_body, increment_too_long, interaction_body

contains

  !> Shear stress and its derivatives from the slip increment of the substep and the pressures at its start and now. A contact that
  !> was open at the start of the substep has lost its history: it closes at the start of the increment.
  subroutine friction_body(ndim, properties, slip_increment, pressure_start, pressure, start, finish, shear, shear_by_slip, &
      shear_by_pressure, dissipated, status)
    integer, intent(in) :: ndim                                 ! 2 or 3
    real(mslip_real), intent(in) :: properties(10)
    real(mslip_real), intent(in) :: slip_increment(ndim - 1)    ! total, the elastic one included [m]
    real(mslip_real), intent(in) :: pressure_start, pressure    ! [Pa]; compression is positive
    real(mslip_real), intent(in) :: start(:)
    real(mslip_real), intent(inout) :: finish(:)
    real(mslip_real), intent(inout) :: shear(ndim - 1)          ! [Pa]; positive for positive slip
    real(mslip_real), intent(inout) :: shear_by_slip(ndim - 1, ndim - 1), shear_by_pressure(ndim - 1)   ! [Pa/m], [1]
    real(mslip_real), intent(inout) :: dissipated               ! by this substep, per unit area [J/m2]
    integer(mslip_int), intent(out) :: status
    real(mslip_real) :: before(size(start)), first(ndim), last(ndim), force(ndim), tangent(ndim, ndim), energy

    before = start
    first(:ndim-1) = start(2:ndim)
    first(ndim) = max(pressure_start, 0.0_mslip_real)*properties(10)
    last(:ndim-1) = first(:ndim-1) + slip_increment
    last(ndim) = max(pressure, 0.0_mslip_real)*properties(10)
    if (.not. first(ndim) > 0) before(ndim+2:) = 0
    call contact_step(properties(:9), MSLIP_RIGID_STRIP, ndim - 1, MSLIP_INPUT_NORMAL_FORCE, first, last, before, finish, force, &
      tangent, energy, status)
    if (status /= MSLIP_OK) return
    shear = force(:ndim-1)/properties(10)
    shear_by_slip = tangent(:ndim-1, :ndim-1)/properties(10)
    shear_by_pressure = tangent(:ndim-1, ndim)
    dissipated = energy/properties(10)
  end subroutine friction_body

  !> Stresses and their derivatives from the relative displacement at the start of the substep and now: the tangential components,
  !> then the penetration, negative if there is a gap.
  subroutine interaction_body(ndim, properties, approach, displacement_start, displacement, start, finish, stress, stiffness, &
      dissipated, status)
    integer, intent(in) :: ndim                                 ! 2 or 3
    real(mslip_real), intent(in) :: properties(10)
    real(mslip_real), intent(in) :: approach                    ! at penetration 0 [m]; negative: a gap
    real(mslip_real), intent(in) :: displacement_start(ndim), displacement(ndim)   ! [m]
    real(mslip_real), intent(in) :: start(:)
    real(mslip_real), intent(inout) :: finish(:)
    real(mslip_real), intent(inout) :: stress(ndim)             ! [Pa]; compression is positive
    real(mslip_real), intent(inout) :: stiffness(ndim, ndim)    ! stress by displacement [Pa/m]; not symmetric
    real(mslip_real), intent(inout) :: dissipated               ! by this substep, per unit area [J/m2]
    integer(mslip_int), intent(out) :: status
    real(mslip_real) :: first(ndim), last(ndim), force(ndim), tangent(ndim, ndim), energy

    first = [displacement_start(:ndim-1), displacement_start(ndim) + approach]
    last = [displacement(:ndim-1), displacement(ndim) + approach]
    call contact_step(properties(:9), MSLIP_RIGID_STRIP, ndim - 1, MSLIP_INPUT_APPROACH, first, last, start, finish, &
      force, tangent, energy, status)
    if (status /= MSLIP_OK) return
    stress = force/properties(10)
    stiffness = tangent/properties(10)
    dissipated = energy/properties(10)
  end subroutine interaction_body

end module contact_bodies
