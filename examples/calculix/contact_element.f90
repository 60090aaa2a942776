! The contact law as user element U1 of CalculiX 2.20: two nodes that slide on each other in one or two directions, press on each
! other and separate. The routines below have the names and arguments that CalculiX calls for this element, and replace those of its
! own U1, a beam.
!
!   *USER ELEMENT, TYPE=U1, NODES=2, INTEGRATION POINTS=1, MAXDOF=3
!   *ELEMENT, TYPE=U1, ELSET=rubbing
!   number, first node, second node
!   *MATERIAL, NAME=law
!   *USER MATERIAL, CONSTANTS=11
!   a, R, L, N, mu, E1, nu1, E2,
!   nu2, interference, directions of sliding (1 or 2)
!   *DEPVAR
!   5, with two directions of sliding 7, + the length of the state of an element
!   *USER SECTION, ELSET=rubbing, MATERIAL=law, CONSTANTS=6
!   direction of sliding, direction in which the second node approaches the first
!
! The displacement is that of the second node relative to the first in these directions, which do not rotate with the structure:
! u along the part of the direction of sliding that is normal to the approach, w along the approach and, with two directions of
! sliding, v along w x u. A line contact has u across the line and v along it. The interference, negative if there is a gap, is
! added to the approach. N is the largest normal force expected, not a load. State variables: T, N and u, w, or Tx, Ty, N and u, v,
! w; the energy dissipated so far; the state of the law.
module contact_element
  use, intrinsic :: iso_fortran_env, only: error_unit
  use microslip
  implicit none
  private
  public :: prepare, count_components, directions, update, fail

  integer, parameter, public :: wp = mslip_real

  type, public :: contact_law
    integer :: components                    !! of the displacement: tangential ones and the normal one
    type(mslip_element) :: element
    real(wp) :: offset(3) = 0                !! added to the displacement
    real(wp) :: initial_stiffness(3) = 0     !! sticking, at N
  end type contact_law

contains

  !> Components of the displacement, from the number of constants (CalculiX passes -100 less that number) and the last one.
  function count_components(element, kind_and_count, constants) result(components)
    integer, intent(in) :: element, kind_and_count
    real(wp), intent(in) :: constants(*)
    integer :: components

    components = 0
    if (kind_and_count == -111) components = 1 + nint(constants(11))
    if (components < 2 .or. components > 3) &
      call fail(element, 'its material must be a *USER MATERIAL with 11 constants, the last being 1 or 2')
  end function count_components

  !> The law of the element's material. It is initialised in every call: CalculiX calls from several threads.
  subroutine prepare(element, kind_and_count, constants, law)
    integer, intent(in) :: element, kind_and_count
    real(wp), intent(in) :: constants(*)
    type(contact_law), intent(out) :: law
    type(mslip_parameters) :: p
    real(wp) :: compliance
    integer(mslip_int) :: status, i

    law%components = count_components(element, kind_and_count, constants)
    call mslip_parameters_default(p)
    p%displacement_reference = MSLIP_CENTRE_POINT  ! as in results/
    p%flat_half_width = constants(1)
    p%edge_radius = constants(2)
    p%length = constants(3)
    p%normal_force = constants(4)
    p%friction_coefficient = constants(5)
    p%material = [mslip_material(constants(6), constants(7)), mslip_material(constants(8), constants(9))]
    call mslip_element_init(p, int(law%components - 1, mslip_int), MSLIP_INPUT_APPROACH, law%element, status)
    if (status /= MSLIP_OK) call fail(element, mslip_status_text(status))
    law%offset(law%components) = constants(10)
    law%initial_stiffness(law%components) = law%element%normal_stiffness
    do i = 1, law%components - 1
      call mslip_element_displacement(law%element, i - 1, 0.0_wp, p%normal_force, status, compliance=compliance)
      law%initial_stiffness(i) = 1/compliance
    end do
  end subroutine prepare

  !> Unit vectors of the components: sliding, the second direction of sliding, approach.
  function directions(element, components, property, properties) result(d)
    integer, intent(in) :: element, components, property
    real(wp), intent(in) :: properties(*)
    real(wp) :: d(3, components), second(3)

    d(:, components) = unit_vector(element, properties(property + 4:property + 6))
    second = unit_vector(element, cross(d(:, components), properties(property + 1:property + 3)))
    d(:, 1) = cross(second, d(:, components))
    if (components == 3) d(:, 2) = second
  end function directions

  function unit_vector(element, a)
    integer, intent(in) :: element
    real(wp), intent(in) :: a(3)
    real(wp) :: unit_vector(3)

    if (.not. norm2(a) > 0) call fail(element, 'the directions of its *USER SECTION must be neither zero nor parallel')
    unit_vector = a/norm2(a)
  end function unit_vector

  pure function cross(a, b)
    real(wp), intent(in) :: a(3), b(3)
    real(wp) :: cross(3)

    cross = [a(2)*b(3) - a(3)*b(2), a(3)*b(1) - a(1)*b(3), a(1)*b(2) - a(2)*b(1)]
  end function cross

  !> A trial step: forces and stiffness at a displacement, from the variables of the last accepted increment to those of this
  !> attempt. `accepted` is false if the displacement is not finite or beyond the range of the law: Newton's method has diverged.
  subroutine update(element, law, displacement, start, before, after, stiffness, accepted)
    integer, intent(in) :: element
    type(contact_law), intent(in) :: law
    real(wp), intent(in) :: displacement(:), start(:), before(:)
    real(wp), intent(inout) :: after(:)
    real(wp), intent(out) :: stiffness(:, :)
    logical, intent(out) :: accepted
    real(wp), dimension(size(before) - 2*law%components - 1) :: state, trial
    real(wp) :: force(law%components), moved(law%components), dissipated
    integer(mslip_int) :: status
    integer :: printed

    printed = 2*law%components + 1
    status = MSLIP_OK
    moved = displacement + law%offset(:law%components)
    state = before(printed + 1:)
    if (all(abs(state) <= 0)) then  ! initial state variables of CalculiX
      if (any(abs(start) > 0)) call fail(element, 'it is displaced and has no load history (restart files of CalculiX ' // &
        'have state variables only if the model has a *CONTACT PAIR)')
      call mslip_element_state_init(int(law%components - 1, mslip_int), state, status)
    end if
    if (status == MSLIP_OK) &
      call mslip_element_update(law%element, state, moved, trial, status, force, stiffness, dissipated)
    accepted = all(status /= [MSLIP_BAD_DISPLACEMENT, MSLIP_LENGTH_TOO_SHORT])
    if (.not. accepted) return
    if (status /= MSLIP_OK) call fail(element, mslip_status_text(status))
    after(1:printed) = [force, moved, before(printed) + dissipated]
    after(printed + 1:) = trial
  end subroutine update

  !> Ends the program: an error of the model.
  subroutine fail(element, reason)
    integer, intent(in) :: element
    character(len=*), intent(in) :: reason

    write (error_unit, '(a, i0, 2a)') ' *ERROR in the contact element ', element, ': ', reason
    stop 1
  end subroutine fail

end module contact_element

! The arguments below that are not used are not declared: they have types by their first letters, as in CalculiX.

!> Called in every iteration: nodal forces, state, and the stiffness, which is passed to e_c3d_u1 in xstiff.
subroutine resultsmech_u1(co, kon, ipkon, lakon, ne, v, stx, elcon, nelcon, rhcon, nrhcon, alcon, nalcon, alzero, &
    ielmat, ielorien, norien, orab, ntmat_, t0, t1, ithermal, prestr, iprestr, eme, iperturb, fn, iout, qa, vold, &
    nmethod, veold, dtime, time, ttime, plicon, nplicon, plkcon, nplkcon, xstateini, xstiff, xstate, npmat_, matname, &
    mi, ielas, icmd, ncmat_, nstate_, stiini, vini, ener, eei, enerini, istep, iinc, reltime, calcul_fn, calcul_qa, &
    calcul_cauchy, nener, ikin, nal, ne0, thicke, emeini, i, ielprop, prop, t0g, t1g)
  use contact_element
  implicit real(wp) (a-h, o-z)
  ! Used: node numbers of element i from kon(ipkon(i) + 1); displacements of this iteration, v, of the previous one, vold, and at
  ! the start of the increment, vini; constants of the material; properties of the section; state variables at the start
  ! (xstateini) and the end (xstate) of the increment.
  integer :: mi(*), ncmat_, ntmat_, nstate_, kon(*), ipkon(*), nelcon(2, *), ielmat(mi(3), *), iperturb(*), nmethod, icmd
  integer :: calcul_fn, calcul_qa, nal, i, ielprop(*)
  real(wp) :: v(0:mi(2), *), vold(0:mi(2), *), vini(0:mi(2), *), fn(0:mi(2), *), elcon(0:ncmat_, ntmat_, *), qa(*), prop(*)
  real(wp) :: xstateini(nstate_, mi(1), *), xstate(nstate_, mi(1), *), xstiff(27, mi(1), *)
  type(contact_law) :: law
  integer :: first, second, material

  first = kon(ipkon(i) + 1)
  second = kon(ipkon(i) + 2)
  material = ielmat(1, i)
  call prepare(i, nelcon(1, material), elcon(1, 1, material), law)
  call evaluate(directions(i, law%components, ielprop(i), prop))

contains

  subroutine evaluate(d)
    implicit none
    real(wp), intent(in) :: d(:, :)
    real(wp) :: force(size(d, 2)), stiffness(size(d, 2), size(d, 2)), nodal_force(3)
    logical :: accepted
    integer :: j

    if (iperturb(1) >= 2) then
      call update(i, law, relative(v, d), relative(vini, d), xstateini(:, 1, i), xstate(:, 1, i), stiffness, accepted)
      if (.not. accepted) then
        qa(3) = 0.25_wp  ! requests a quarter of the increment
        return
      end if
      force = xstate(1:size(force), 1, i)
    else
      ! Small vibrations about any state have the initial stiffness. So has the first iteration of a step with moving supports
      ! (-1), which requires the change of the force alone.
      if (nmethod == 1 .and. iperturb(1) /= -1) &
        call fail(i, 'the step is linear; after *FREQUENCY a static step needs NLGEOM')
      stiffness = 0
      do j = 1, size(force)
        stiffness(j, j) = law%initial_stiffness(j)
      end do
      force = matmul(stiffness, relative(v, d))
      if (iperturb(1) == -1) force = force - matmul(stiffness, relative(vold, d))
    end if

    ! The matrix of CalculiX is symmetric: the tangential force follows the normal one, not the reverse, and this coupling is
    ! left to the iterations, as is the antisymmetric part of the coupling of the tangential directions.
    associate (m => size(force))
      stiffness(:m - 1, m) = 0
      stiffness(m, :m - 1) = 0
      if (icmd /= 3) xstiff(1:m**2, 1, i) = [(stiffness + transpose(stiffness))/2]
    end associate
    nodal_force = matmul(d, force)
    if (calcul_fn == 1) then
      fn(1:3, second) = fn(1:3, second) + nodal_force
      fn(1:3, first) = fn(1:3, first) - nodal_force
    end if
    if (calcul_qa == 1) then  ! the sum whose mean the residual is compared with
      qa(1) = qa(1) + 2*sum(abs(nodal_force))
      nal = nal + 6
    end if
  end subroutine evaluate

  !> Displacement of the second node relative to the first.
  function relative(nodal, d)
    implicit none
    real(wp), intent(in) :: nodal(0:mi(2), *), d(:, :)
    real(wp) :: relative(size(d, 2))

    relative = matmul(nodal(1:3, second) - nodal(1:3, first), d)
  end function relative

end subroutine resultsmech_u1

!> The stiffness matrix. There is no mass and there are no loads.
subroutine e_c3d_u1(co, kon, lakonl, p1, p2, omx, bodyfx, nbody, s, sm, ff, nelem, nmethod, elcon, nelcon, rhcon, nrhcon, &
    alcon, nalcon, alzero, ielmat, ielorien, norien, orab, ntmat_, t0, t1, ithermal, vold, iperturb, nelemload, sideload, &
    xload, nload, idist, sti, stx, iexpl, plicon, nplicon, plkcon, nplkcon, xstiff, npmat_, dtime, matname, mi, ncmat_, &
    mass, stiffness, buckling, rhsi, intscheme, ttime, time, istep, iinc, coriolis, xloadold, reltime, ipompc, nodempc, &
    coefmpc, nmpc, ikmpc, ilmpc, veold, ne0, ipkon, thicke, integerglob, doubleglob, tieset, istartset, iendset, ialset, &
    ntie, nasym, ielprop, prop)
  use contact_element
  implicit real(wp) (a-h, o-z)
  integer :: nelem, mi(*), nelcon(2, *), ielmat(mi(3), *), ielprop(*), ncmat_, ntmat_
  real(wp) :: s(60, 60), sm(60, 60), ff(60), xstiff(27, mi(1), *), prop(*), elcon(0:ncmat_, ntmat_, *)
  real(wp) :: d(3, 3), k(3, 3)
  integer :: m

  m = count_components(nelem, nelcon(1, ielmat(1, nelem)), elcon(1, 1, ielmat(1, nelem)))
  d(:, :m) = directions(nelem, m, ielprop(nelem), prop)
  k = matmul(d(:, :m), matmul(reshape(xstiff(1:m**2, 1, nelem), [m, m]), transpose(d(:, :m))))
  s(1:3, 1:3) = k
  s(4:6, 4:6) = k
  s(1:3, 4:6) = -k
  s(4:6, 1:3) = -k
  sm(1:6, 1:6) = 0
  ff(1:6) = 0
end subroutine e_c3d_u1

!> Stresses and other fields at nodes: the contact has none.
subroutine extrapolate_u1(yi, yn, ipkon, inum, kon, lakon, nfield, nk, ne, mi, ndim, orab, ielorien, co, iorienloc, cflag, &
    vold, force, ielmat, thicke, ielprop, prop, i)
end subroutine extrapolate_u1
