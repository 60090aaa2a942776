! Calls the user subroutines for Abaqus as Abaqus does, as far as its documentation says: see ../host.f90.
module abaqus_calls
  use checks
  use contact_point
  use host
  use microslip
  implicit none
  public

  integer, parameter :: points = 3
  ! a, R, L, N, mu, E1, nu1, E2, nu2: a flat with rounded edges, a cylinder
  real(wp), parameter :: flat(9) = [0.5e-3_wp, 3e-3_wp, 20e-3_wp, 1600.0_wp, 0.5_wp, 2e11_wp, 0.3_wp, 2e11_wp, 0.3_wp]
  real(wp), parameter :: cylinder(9) = [0.0_wp, 50e-3_wp, 10e-3_wp, 900.0_wp, 0.3_wp, 1.1e11_wp, 0.32_wp, 2e11_wp, 0.3_wp]
  ! Directions x and z of each element.
  real(wp), parameter :: axes(6, points) = reshape([1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 1.0_wp, &
    1.0_wp, 2.0_wp, 2.0_wp, 2.0_wp, 1.0_wp, -2.0_wp, 0.0_wp, 3.0_wp, 4.0_wp, -1.0_wp, 0.0_wp, 0.0_wp], [6, points])
  real(wp), parameter :: interference = 1e-6_wp                 ! m
  ! Areas of the points of a contact pair, shares of one contact.
  real(wp), parameter :: areas(points) = [20e-6_wp, 30e-6_wp, 10e-6_wp], area = 60e-6_wp    ! m2
  real(wp), parameter :: penalty = 5e12_wp                      ! Pa/m, of Abaqus beside FRIC
  real(wp), parameter :: no_limit = 1e36_wp
  ! Arguments that the subroutines do not use, or not in these steps.
  real(wp), parameter :: zeros(12) = 0, unit_matrix(4) = [1.0_wp, 0.0_wp, 0.0_wp, 1.0_wp]
  character(len=80), parameter :: name = 'contact'
  integer :: directions = 1
  integer :: lflags(7) = [1, 0, 1, 0, 0, 0, 0]
  real(wp) :: params(3) = 0

contains

  function constants_of(point) result(constants)
    integer, intent(in) :: point
    real(wp) :: constants(9)

    constants = flat
    if (modulo(point, 2) == 0) constants = cylinder
  end function constants_of

  !> Rows: node 2 less node 1 in the directions of the element.
  function rows(point) result(b)
    integer, intent(in) :: point
    real(wp) :: b(directions + 1, 6), x(3), z(3)

    x = axes(1:3, point)/norm2(axes(1:3, point))
    z = axes(4:6, point)/norm2(axes(4:6, point))
    b(1, 4:6) = x
    if (directions == 2) b(2, 4:6) = [z(2)*x(3) - z(3)*x(2), z(3)*x(1) - z(1)*x(3), z(1)*x(2) - z(2)*x(1)]
    b(directions + 1, 4:6) = z
    b(:, 1:3) = -b(:, 4:6)
  end function rows

  subroutine call_uel(point, x_start, x, before, after, force, tangent, dissipated, ratio)
    integer, intent(in) :: point
    real(wp), intent(in) :: x_start(:), x(:), before(:)
    real(wp), intent(out) :: after(:), force(:), tangent(:, :), dissipated, ratio
    real(wp) :: rhs(6, 1), amatrx(6, 6), energy(8), props(16)
    external :: uel

    after = before
    props = [constants_of(point), interference, axes(:, point)]
    energy = 0
    energy(4) = before(7)
    ratio = no_limit
    call uel(rhs, amatrx, after, energy, 6, 1, size(after), props, size(props), zeros, 3, 2, x, x - x_start, zeros, zeros, &
      1, zeros, 0.01_wp, 1, 1, point, params, 0, [0], zeros, zeros, 1, lflags, 6, zeros, 1, ratio, &
      [int(MSLIP_RIGID_STRIP), directions], 2, 1.0_wp)
    force = -rhs(:, 1)
    tangent = amatrx
    dissipated = energy(4) - before(7)
  end subroutine call_uel

  !> The unknowns are those of Abaqus: overclosure, then tangential displacement.
  subroutine call_uinter(point, x_start, x, before, after, force, tangent, dissipated, ratio)
    integer, intent(in) :: point
    real(wp), intent(in) :: x_start(:), x(:), before(:)
    real(wp), intent(out) :: after(:), force(:), tangent(:, :), dissipated, ratio
    integer :: open_close

    after = before
    force = 0
    tangent = 0
    dissipated = 0
    ratio = no_limit
    open_close = -1
    call perturb_or_step(x, x - x_start, 0, after, force, tangent, dissipated, ratio, open_close)
    call check_quietly('UINTER: contact status', ratio < 1 .or. (open_close == 1 .eqv. force(1) > 0))
    force = areas(point)*force
    tangent = areas(point)*tangent
    dissipated = areas(point)*dissipated
  end subroutine call_uinter

  subroutine perturb_or_step(rdisp, drdisp, linper, statev, stress, ddsddr, sfd, pnewdt, open_close)
    real(wp), intent(in) :: rdisp(:), drdisp(:)
    integer, intent(in) :: linper
    real(wp), intent(inout) :: statev(:), stress(:), ddsddr(:, :), sfd, pnewdt
    integer, intent(inout) :: open_close
    integer :: state, discontinuity
    external :: uinter

    state = -1
    discontinuity = 0
    call uinter(stress, ddsddr, zeros, zeros, zeros, zeros, zeros, zeros, statev, zeros(1), sfd, zeros(2), zeros(3), zeros(4), &
      pnewdt, rdisp, drdisp, zeros, zeros, zeros, zeros, zeros, 0.01_wp, 0.0_wp, name, name, name, &
      [flat, interference, area, real(MSLIP_RIGID_STRIP, wp)], zeros, zeros, unit_matrix, areas(1), &
      1e-3_wp, 1, size(rdisp), size(statev), 1, 12, 3, 1, 1, 1, linper, open_close, state, discontinuity, 0)
  end subroutine perturb_or_step

  !> The unknowns are tangential displacement and overclosure; Abaqus has a penalty for the latter and calls FRIC if it is closed.
  subroutine call_fric(point, x_start, x, before, after, force, tangent, dissipated, ratio)
    integer, intent(in) :: point
    real(wp), intent(in) :: x_start(:), x(:), before(:)
    real(wp), intent(out) :: after(:), force(:), tangent(:, :), dissipated, ratio
    real(wp) :: tau(directions), ddtddg(directions, directions), ddtddp(directions)
    integer :: m, lm

    m = directions + 1
    after = before
    force = 0
    tangent = 0
    dissipated = 0
    ratio = no_limit
    if (.not. x(m) > 0) return
    tau = 0
    ddtddg = 0
    ddtddp = 0
    lm = merge(0, 2, x_start(m) > 0)
    call step_fric(lm, x(:directions) - x_start(:directions), penalty*x(m), penalty*(x(m) - max(x_start(m), 0.0_wp)), after, tau, &
      ddtddg, ddtddp, dissipated, ratio)
    force = areas(point)*[tau, penalty*x(m)]
    tangent(:directions, :directions) = areas(point)*ddtddg
    tangent(:directions, m) = areas(point)*penalty*ddtddp
    tangent(m, m) = areas(point)*penalty
    dissipated = areas(point)*dissipated
  end subroutine call_fric

  subroutine step_fric(lm, dgam, press, dpress, statev, tau, ddtddg, ddtddp, sfd, pnewdt)
    integer, intent(inout) :: lm
    real(wp), intent(in) :: dgam(:), press, dpress
    real(wp), intent(inout) :: statev(:), tau(:), ddtddg(:, :), ddtddp(:), sfd, pnewdt
    external :: fric

    call fric(lm, tau, ddtddg, ddtddp, zeros, zeros(1), sfd, zeros, pnewdt, statev, dgam, zeros, press, dpress, penalty, zeros, &
      1, 1, zeros, 0.01_wp, 1, name, name, name, 1, 1, 1, zeros, zeros, unit_matrix, zeros, zeros, size(dgam), 3, 1, &
      size(statev), 1e-3_wp, [flat, area, real(MSLIP_RIGID_STRIP, wp)], 11)
  end subroutine step_fric

  !> Counted only if it fails.
  subroutine check_quietly(name, condition)
    character(len=*), intent(in) :: name
    logical, intent(in) :: condition

    if (.not. condition) call check(name, .false.)
  end subroutine check_quietly

end module abaqus_calls

program driver
  use abaqus_calls
  implicit none
  integer(mslip_int) :: status

  do directions = 1, 2
    call run(uel_model())
    call test_uel_flags()
    call run(uinter_model())
    call test_uinter()
    call run(fric_model())
    call test_fric()
  end do
  call report()

contains

  function uel_model() result(model)
    type(contact_model) :: model
    integer :: i

    model = points_of('UEL', [(element_of(constants_of(i), directions, MSLIP_INPUT_APPROACH), i=1, points)], &
      spread(1.0_wp, 1, points), 6 + contact_variables(directions), call_uel)
    model%unknowns = 6
    model%to_law = reshape([(rows(i), i=1, points)], [directions + 1, 6, points])
    model%from_law = reshape([(transpose(rows(i)), i=1, points)], [6, directions + 1, points])
    model%offset(directions + 1) = interference
    model%energy = 7
    model%spring = spread(model%elements(1)%tangential_stiffness, 1, 6)
  end function uel_model

  function uinter_model() result(model)
    type(contact_model) :: model

    model = points_of('UINTER', spread(element_of(flat, directions, MSLIP_INPUT_APPROACH), 1, points), areas/area, &
      contact_variables(directions), call_uinter)
    model%to_law = cshift(model%to_law, -1, dim=2)
    model%from_law = cshift(model%from_law, -1, dim=1)
    model%offset(directions + 1) = interference
  end function uinter_model

  function fric_model() result(model)
    type(contact_model) :: model

    model = points_of('FRIC', spread(element_of(flat, directions, MSLIP_INPUT_NORMAL_FORCE), 1, points), areas/area, &
      contact_variables(directions), call_fric)
    model%to_law(directions + 1, directions + 1, :) = area*penalty
    model%called_if_open = .false.
  end function fric_model

  !> What UEL returns for each LFLAGS, in the increment after a step that slips.
  subroutine test_uel_flags()
    real(wp) :: before(6 + contact_variables(directions)), after(size(before)), x0(6), x(6), x2(6), dissipated, ratio
    real(wp), dimension(6) :: f0, f, f2
    real(wp), dimension(6, 6) :: k, k2, unused
    real(wp), parameter :: alpha = -0.05_wp
    integer, parameter :: kinds(4) = [3, 4, 100, 5]
    integer :: i, j

    x0 = 0
    x0(6) = 3e-6_wp
    x = [0.0_wp, 0.0_wp, 0.0_wp, 2e-6_wp, 0.0_wp, 4e-6_wp]
    x2 = x
    x2(4) = 1e-6_wp
    before = 0
    call call_uel(1, 0*x0, x0, before, after, f0, k, dissipated, ratio)
    before = after
    call call_uel(1, x0, x, before, after, f, k, dissipated, ratio)
    before = after                                              ! forces f at the end, f0 at its start
    call call_uel(1, x, x2, before, after, f2, k2, dissipated, ratio)

    lflags(3) = 2
    call call_uel(1, x, x2, before, after, f, k, dissipated, ratio)
    call check_same('UEL, stiffness only', [k], [k2])
    call check_same('UEL, stiffness only: state variables', after, before)
    do i = 1, 4
      lflags(3) = kinds(i)
      call call_uel(1, x, x2, before, after, f, k, dissipated, ratio)
      if (i < 4) call check_same('UEL, mass, damping, output', [k, f], [(0.0_wp, j=1, 42)])
      call check_same('UEL, residual only: state variables', after, before)
    end do
    lflags(3) = 5
    call call_uel(1, x, x2, before, after, f, unused, dissipated, ratio)
    call check_same('UEL, residual only', f, f2)

    params(1) = alpha
    lflags(1) = 11
    call call_uel(1, x, x2, before, after, f, unused, dissipated, ratio)
    associate (g1 => matmul(transpose(rows(1)), before(1:directions+1)), g0 => matmul(transpose(rows(1)), before(4:directions+4)))
      call check('UEL, dynamics: force at the start of the last increment', norm2(g0 - f0) <= 1e-14_wp*norm2(f0))
      call check('UEL, dynamics, half increment', norm2((1 + alpha)*f2 - alpha/2*(g1 + g0) - f) <= 1e-14_wp*norm2(f2))
      lflags(3) = 1
      call call_uel(1, x, x2, before, after, f, k, dissipated, ratio)
      call check('UEL, dynamics, residual', norm2((1 + alpha)*f2 - alpha*g1 - f) <= 1e-14_wp*norm2(f2))
      call check('UEL, dynamics, stiffness', norm2((1 + alpha)*k2 - k) <= 1e-14_wp*norm2(k2))
    end associate
    lflags(3) = 6
    call call_uel(1, x, x2, before, after, f, k, dissipated, ratio)
    call check_same('UEL, initial acceleration', [f, k], [f2, (0.0_wp, i=1, 36)])
    params = 0

    ! Linear perturbation: U is the base state, DU the perturbation.
    lflags(1) = 1
    lflags(3) = 2
    call call_uel(1, x, x, before, after, f, k2, dissipated, ratio)
    lflags(3:4) = 1
    call call_uel(1, x - x2, x, before, after, f, k, dissipated, ratio)
    call check_same('UEL, perturbation: stiffness', [k], [k2])
    call check_same('UEL, perturbation: state variables', after, before)
    call check('UEL, perturbation: force', norm2(f - matmul(k2, x2)) <= 1e-12_wp*norm2(f) .and. norm2(f) > 0)
    lflags = [1, 0, 1, 0, 0, 0, 0]

    ! The first increment starts from the interference, not from an open contact.
    call call_uel(1, 0*x, x, 0*before, after, f, k, dissipated, ratio)
    call check('UEL, first increment', norm2(f - matmul(transpose(rows(1)), &
      two_steps(element_of(constants_of(1), directions, MSLIP_INPUT_APPROACH), [(0.0_wp, i=1, directions), interference], &
      matmul(rows(1), x) + [(0.0_wp, i=1, directions), interference]))) <= 1e-12_wp*norm2(f))
  end subroutine test_uel_flags

  !> The force of the library after two steps.
  function two_steps(element, first, second) result(force)
    type(mslip_element), intent(in) :: element
    real(wp), intent(in) :: first(:), second(:)
    real(wp) :: force(size(first)), state(mslip_element_state_length(element%directions, 64_mslip_size))

    call mslip_element_state_init(element%directions, state, status)
    if (status == MSLIP_OK) call mslip_element_advance(element, state, first, status)
    if (status == MSLIP_OK) call mslip_element_advance(element, state, second, status, force)
    call check_status('library', status, MSLIP_OK)
  end function two_steps

  !> Points without a counterpart, perturbations, the sum over the points of a contact.
  subroutine test_uinter()
    real(wp) :: before(contact_variables(directions)), after(size(before)), sfd, ratio, dissipated
    real(wp), dimension(directions + 1) :: x0, x, stress, total
    real(wp), dimension(directions + 1, directions + 1) :: k, k2
    integer :: i, open_close

    before = 0
    x0 = 0
    x0(1) = -1e36_wp
    stress = 0
    ratio = no_limit
    call perturb_or_step(x0, 0*x0, 0, before, stress, k, sfd, ratio, open_close)
    call check_same('UINTER, no counterpart', [stress, k, sfd, real(open_close, wp)], [(0.0_wp, i=1, size(stress) + size(k) + 2)])
    call check('UINTER, no counterpart: no shorter increment', .not. ratio < 1)

    x0(1) = 3e-6_wp
    before = 0
    call perturb_or_step(x0, x0, 0, before, stress, k, sfd, ratio, open_close)
    x = x0
    x(2) = 1e-6_wp
    after = before
    call perturb_or_step(x, x - x0, 0, after, stress, k, sfd, ratio, open_close)
    before = after
    call perturb_or_step(x, 0*x, 0, after, stress, k2, sfd, ratio, open_close)
    after = before
    call perturb_or_step(x0, x0, 1, after, stress, k, sfd, ratio, open_close)
    call check_same('UINTER, perturbation: stiffness', [k], [k2])
    call check_same('UINTER, perturbation: stress', stress, matmul(k2, x0))
    call check_same('UINTER, perturbation: state variables', after, before)

    total = 0
    do i = 1, points
      before = 0
      call call_uinter(i, x0, x, before, after, stress, k, dissipated, ratio)
      total = total + stress
    end do
    associate (force => two_steps(element_of(flat, directions, MSLIP_INPUT_APPROACH), &
        cshift(x0, 1) + [(0.0_wp, i=1, directions), interference], cshift(x, 1) + [(0.0_wp, i=1, directions), interference]))
      call check('UINTER, first increment: sum over the points', norm2(cshift(total, 1) - force) <= 1e-14_wp*norm2(force))
    end associate
  end subroutine test_uinter

  !> A contact that was open has lost its history: pressed without tangential force, without friction in this increment.
  subroutine test_fric()
    real(wp) :: statev(contact_variables(directions)), sfd, ratio, energy
    real(wp), dimension(directions) :: dgam, tau, ddtddp
    real(wp) :: ddtddg(directions, directions)
    real(wp), parameter :: pressure = 5e6_wp                    ! Pa
    integer :: lm

    statev = 0
    dgam = 0
    dgam(1) = 2e-6_wp
    ratio = no_limit
    lm = 0
    call step_fric(lm, 0*dgam, pressure, pressure, statev, tau, ddtddg, ddtddp, sfd, ratio)
    call step_fric(lm, dgam, pressure, 0.0_wp, statev, tau, ddtddg, ddtddp, sfd, ratio)
    energy = statev(1)
    call check('FRIC, closed: relative motion', lm == 0 .and. tau(1) > 0 .and. energy > 0)
    lm = 2
    call step_fric(lm, dgam, pressure, pressure, statev, tau, ddtddg, ddtddp, sfd, ratio)
    call check('FRIC, closes: no friction', lm == 2)
    call check_same('FRIC, closes: energy so far', [statev(1)], [energy])
    lm = 0
    call step_fric(lm, -dgam/100, 2*pressure, pressure, statev, tau, ddtddg, ddtddp, sfd, ratio)

    call check_friction('FRIC, after that: history begins anew', tau, -dgam/100, pressure)
    statev = 0
    lm = 0
    call step_fric(lm, -dgam/100, 2*pressure, pressure, statev, tau, ddtddg, ddtddp, sfd, ratio)
    call check_friction('FRIC, first increment', tau, -dgam/100, pressure)
  end subroutine test_fric

  !> The shear stress of a contact that was pressed, then displaced under twice the pressure.
  subroutine check_friction(name, tau, displacement, pressure)
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: tau(:), displacement(:), pressure
    real(wp) :: force(directions + 1)
    integer :: i

    force = two_steps(element_of(flat, directions, MSLIP_INPUT_NORMAL_FORCE), [(0.0_wp, i=1, directions), pressure*area], &
      [displacement, 2*pressure*area])
    call check(name, norm2(tau*area - force(:directions)) <= 1e-12_wp*norm2(force))
  end subroutine check_friction

end program driver

!> Stand-in for the routine of Abaqus that ends the program.
subroutine xit()
  implicit none

  error stop 'XIT was called'
end subroutine xit
