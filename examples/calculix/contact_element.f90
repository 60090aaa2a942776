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
! added to the approach. N is the largest normal force expected, not a load. State variables: T, N, or Tx, Ty, N; those of
! contact_point, which are the energy dissipated so far, u, w, or u, v, w, and the state of the law.
module contact_element
  use, intrinsic :: iso_fortran_env, only: error_unit
  use contact_point
  use microslip
  implicit none
  private
  public :: count_components, directions, stick, update, fail

  integer, parameter, public :: wp = mslip_real

  integer(mslip_int), parameter :: reference = MSLIP_CENTRE_POINT  ! as in results/

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

  !> The stiffness of the sticking contact under N.
  subroutine stick(element, constants, stiffness)
    integer, intent(in) :: element
    real(wp), intent(in) :: constants(9)
    real(wp), intent(out) :: stiffness(:, :)
    integer(mslip_int) :: status

    call contact_stiffness(constants, reference, size(stiffness, 1, mslip_int) - 1, stiffness, status)
    if (status /= MSLIP_OK) call fail(element, mslip_status_text(status))
  end subroutine stick

  !> A trial step: forces and stiffness at a displacement, from the variables of the last accepted increment to those of this
  !> attempt. `accepted` is false if the displacement is not finite or beyond the range of the law: Newton's method has diverged.
  subroutine update(element, constants, displacement, start, before, after, stiffness, accepted)
    integer, intent(in) :: element
    real(wp), intent(in) :: constants(10), displacement(:), start(:), before(:)
    real(wp), intent(inout) :: after(:)
    real(wp), intent(out) :: stiffness(:, :)
    logical, intent(out) :: accepted
    real(wp), dimension(size(displacement)) :: offset, force
    real(wp) :: dissipated
    integer(mslip_int) :: m, status

    m = size(displacement, kind=mslip_int)
    offset = 0
    offset(m) = constants(10)
    ! Initial state variables of CalculiX are 0.
    if (all(abs(before(2*m + 2:)) <= 0) .and. any(abs(start) > 0)) call fail(element, 'it is displaced and has no load ' // &
      'history (restart files of CalculiX have state variables only if the model has a *CONTACT PAIR)')
    call contact_step(constants(:9), reference, m - 1, start + offset, displacement + offset, &
      before(m + 1:), after(m + 1:), force, stiffness, dissipated, status)
    accepted = .not. increment_too_long(status)
    if (.not. accepted) return
    if (status /= MSLIP_OK) call fail(element, mslip_status_text(status))
    after(:m) = force
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
  integer :: first, second, material, m

  first = kon(ipkon(i) + 1)
  second = kon(ipkon(i) + 2)
  material = ielmat(1, i)
  m = count_components(i, nelcon(1, material), elcon(1, 1, material))
  call evaluate(directions(i, m, ielprop(i), prop))

contains

  subroutine evaluate(d)
    implicit none
    real(wp), intent(in) :: d(:, :)
    real(wp) :: force(m), stiffness(m, m), nodal_force(3)
    logical :: accepted

    if (iperturb(1) >= 2) then
      call update(i, elcon(1, 1, material), relative(v, d), relative(vini, d), xstateini(:, 1, i), xstate(:, 1, i), stiffness, &
        accepted)
      if (.not. accepted) then
        qa(3) = 0.25_wp  ! requests a quarter of the increment
        return
      end if
      force = xstate(1:m, 1, i)
    else
      ! Small vibrations about any state have the initial stiffness. So has the first iteration of a step with moving supports
      ! (-1), which requires the change of the force alone.
      if (nmethod == 1 .and. iperturb(1) /= -1) &
        call fail(i, 'the step is linear; after *FREQUENCY a static step needs NLGEOM')
      call stick(i, elcon(1, 1, material), stiffness)
      force = matmul(stiffness, relative(v, d))
      if (iperturb(1) == -1) force = force - matmul(stiffness, relative(vold, d))
    end if

    ! The matrix of CalculiX is symmetric: the tangential force follows the normal one, not the reverse, and this coupling is
    ! left to the iterations, as is the antisymmetric part of the coupling of the tangential directions.
    stiffness(:m - 1, m) = 0
    stiffness(m, :m - 1) = 0
    if (icmd /= 3) xstiff(1:m**2, 1, i) = [(stiffness + transpose(stiffness))/2]
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
