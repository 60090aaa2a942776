program bad_input
  ! Every procedure with a contact or an element of one and of two directions, by a table: each subset of the optional outputs,
  ! arrays of wrong size, invalid values (quiet and signalling NaN, infinities), and memory that was never initialised or
  ! truncated. Each error has its own status and modifies no output; compiled with traps, none raises a signal.
  use, intrinsic :: ieee_arithmetic, only: ieee_negative_inf, ieee_positive_inf, ieee_quiet_nan, ieee_value
  use, intrinsic :: iso_c_binding, only: c_int64_t
  use microslip
  use checks
  implicit none

  integer, parameter :: n = 3, harmonics = 2, m = 2*harmonics + 1, bad_values = 5
  integer(mslip_size), parameter :: h = harmonics, samples = 16, periods = 2, reversals = 4, pieces = 4
  integer(mslip_int), parameter :: one = 1
  integer(c_int64_t), parameter :: signalling(2) = [int(z'7FF0000000000001', c_int64_t), int(z'7FF4000000000000', c_int64_t)]
  integer(mslip_int), parameter :: none = MSLIP_OK, force = MSLIP_BAD_FORCE, amplitude = MSLIP_BAD_AMPLITUDE, &
    force_amplitude = MSLIP_BAD_FORCE_AMPLITUDE, shift = MSLIP_BAD_DISPLACEMENT

  type :: procedure_info
    character(len=32) :: name
    integer(mslip_int) :: scalar, array  ! Status of an invalid scalar, and of an invalid element of the input array.
    character(len=5) :: outputs          ! Four outputs and the new state: shapes as in `set_up`, upper case if required.
    character :: memory = ' '            ! s: state, w: workspace, t: table.
    logical :: batch = .false., element = .false.
  end type procedure_info

  ! <generated: procedures>
  type(procedure_info), parameter :: procedures(40) = [ &
    procedure_info('tractions', MSLIP_BAD_FORCE, MSLIP_BAD_POSITION, 'vv', ' '), &
    procedure_info('slip', MSLIP_BAD_FORCE, MSLIP_BAD_POSITION, 'vv', ' '), &
    procedure_info('monotonic_displacement', none, MSLIP_BAD_FORCE, 'vvv', ' '), &
    procedure_info('monotonic_displacement, one', MSLIP_BAD_FORCE, none, 'sss', ' '), &
    procedure_info('monotonic_force', none, MSLIP_BAD_DISPLACEMENT, 'vvv', ' '), &
    procedure_info('monotonic_force, one', MSLIP_BAD_DISPLACEMENT, none, 'sss', ' '), &
    procedure_info('monotonic_sensitivity', none, MSLIP_BAD_DISPLACEMENT, 'vq', ' '), &
    procedure_info('masing_update', MSLIP_BAD_DISPLACEMENT, none, 'sss N', 's'), &
    procedure_info('masing_advance', MSLIP_BAD_DISPLACEMENT, none, 'sss', 's'), &
    procedure_info('masing_path', none, MSLIP_BAD_DISPLACEMENT, 'vvv N', 's'), &
    procedure_info('masing_path_advance', none, MSLIP_BAD_DISPLACEMENT, 'vvv', 's'), &
    procedure_info('masing_tractions', none, MSLIP_BAD_POSITION, 'vv', 's'), &
    procedure_info('hysteresis_loop', MSLIP_BAD_AMPLITUDE, none, 'VV', ' '), &
    procedure_info('dissipated_energy', none, MSLIP_BAD_FORCE_AMPLITUDE, 'V', ' '), &
    procedure_info('dissipated_energy, one', MSLIP_BAD_FORCE_AMPLITUDE, none, 'S', ' '), &
    procedure_info('complex_stiffness', none, MSLIP_BAD_AMPLITUDE, 'vvvv', ' '), &
    procedure_info('complex_stiffness, one', MSLIP_BAD_AMPLITUDE, none, 'ssss', ' '), &
    procedure_info('complex_stiffness_tabulated', none, MSLIP_BAD_AMPLITUDE, 'vvvv', 't'), &
    procedure_info('complex_stiffness_tabulated, one', MSLIP_BAD_AMPLITUDE, none, 'ssss', 't'), &
    procedure_info('jenkins_equivalent', MSLIP_BAD_AMPLITUDE, none, 'SS', ' '), &
    procedure_info('iwan_equivalent', none, none, 'VVs', ' '), &
    procedure_info('harmonic_force', none, MSLIP_BAD_DISPLACEMENT, 'cjs', 'w'), &
    procedure_info('harmonic_sensitivity', none, MSLIP_BAD_DISPLACEMENT, 'cr', 'w'), &
    procedure_info('batch_complex_stiffness', none, MSLIP_BAD_AMPLITUDE, 'vvvv', ' ', batch=.true.), &
    procedure_info('batch_masing_update', none, MSLIP_BAD_DISPLACEMENT, 'vvv B', 's', batch=.true.), &
    procedure_info('batch_masing_advance', none, MSLIP_BAD_DISPLACEMENT, 'vvv', 's', batch=.true.), &
    procedure_info('batch_harmonic_force', none, MSLIP_BAD_DISPLACEMENT, 'fkv', 'w', batch=.true.), &
    procedure_info('normal_force', none, MSLIP_BAD_DISPLACEMENT, 'vvv', ' ', element=.true.), &
    procedure_info('normal_force, one', MSLIP_BAD_DISPLACEMENT, none, 'sss', ' ', element=.true.), &
    procedure_info('normal_approach', none, MSLIP_BAD_NORMAL_FORCE, 'vvv', ' ', element=.true.), &
    procedure_info('normal_approach, one', MSLIP_BAD_NORMAL_FORCE, none, 'sss', ' ', element=.true.), &
    procedure_info('element_update', none, MSLIP_BAD_DISPLACEMENT, 'pts N', 's', element=.true.), &
    procedure_info('element_advance', none, MSLIP_BAD_DISPLACEMENT, 'pts', 's', element=.true.), &
    procedure_info('element_path', none, MSLIP_BAD_DISPLACEMENT, 'abv N', 's', element=.true.), &
    procedure_info('element_path_advance', none, MSLIP_BAD_DISPLACEMENT, 'abv', 's', element=.true.), &
    procedure_info('element_tractions', none, MSLIP_BAD_POSITION, 'vv', 's', element=.true.), &
    procedure_info('element_harmonic_force', none, MSLIP_BAD_DISPLACEMENT, 'dess', 'w', element=.true.), &
    procedure_info('batch_element_update', none, MSLIP_BAD_DISPLACEMENT, 'abv B', 's', batch=.true., element=.true.), &
    procedure_info('batch_element_advance', none, MSLIP_BAD_DISPLACEMENT, 'abv', 's', batch=.true., element=.true.), &
    procedure_info('batch_element_harmonic_force', none, MSLIP_BAD_DISPLACEMENT, 'ghvv', 'w', batch=.true., element=.true.)]
  ! </generated>

  ! One component is allocated; if none is, the argument is absent.
  type :: output
    real(wp), allocatable :: s, v(:), m(:, :), t(:, :, :)
  end type output

  type(mslip_contact), allocatable :: contacts(:)
  type(mslip_element), allocatable :: elements(:)
  type(output) :: out(5)
  real(wp), allocatable :: x(:), u(:, :), state(:), states(:, :), workspace(:), table(:)
  real(wp), allocatable :: vector(:), vectors(:, :)  ! Displacements of an element.
  integer(mslip_int), allocatable :: index(:), active(:)
  real(wp) :: scalar, bad(bad_values)
  integer(mslip_int) :: status
  integer(mslip_int) :: directions  ! Of the elements.
  integer :: p, components, me      ! Components of a displacement of an element, and their coefficients.

  bad(1) = ieee_value(1.0_wp, ieee_quiet_nan)
  bad(2) = ieee_value(1.0_wp, ieee_positive_inf)
  bad(3) = ieee_value(1.0_wp, ieee_negative_inf)
  bad(4:5) = transfer(signalling, bad, 2)
  do directions = 2, 1, -1
    components = int(directions) + 1
    me = components*m
    do p = 1, size(procedures)
      if (directions == 2 .and. (.not. procedures(p)%element .or. procedures(p)%name == 'element_tractions')) cycle
      call test_subsets()
      call test_sizes()
      call test_values()
      call test_memory()
      if (procedures(p)%batch) call test_batch()
    end do
    if (directions == 1) exit
    call test_two_directions()
  end do
  call test_parameters()
  call test_contact_check()
  call test_state_check()
  call test_workspace()
  call test_elements()
  call test_element_state()
  call test_element_workspace()
  call test_table()
  call check('every status is returned, but for NULL pointers and misaligned ones', &
    all([(was_returned(int(p, mslip_int)) .or. mslip_status_text(int(p, mslip_int)) == mslip_status_text(-1_mslip_int) &
    .or. p == MSLIP_NULL_POINTER .or. p == MSLIP_BAD_ALIGNMENT, p = 1, 127)]))
  call report()

contains

  pure function flat_parameters() result(flat)
    type(mslip_parameters) :: flat

    flat = mslip_parameters(flat_half_width=5.0e-4_wp, edge_radius=3.0e-3_wp, length=2.0e-2_wp, normal_force=800.0_wp, &
      friction_coefficient=0.5_wp, material=[mslip_material(1.14e11_wp, 0.32_wp), mslip_material(2.0e11_wp, 0.29_wp)], &
      displacement_reference=MSLIP_CENTRE_POINT)
  end function flat_parameters

  pure function ellipse_parameters() result(ellipse)
    type(mslip_elliptic_parameters) :: ellipse

    ellipse = mslip_elliptic_parameters(1.0e-3_wp, 2.0e-3_wp, 50.0_wp, 0.5_wp, spread(mslip_material(2.0e11_wp, 0.3_wp), 1, 2))
  end function ellipse_parameters

  subroutine set_up()
    ! Valid arguments of procedure p, and unset outputs of the required shapes.
    integer(mslip_int) :: ok
    integer :: i, items

    items = merge(n, 1, procedures(p)%batch)
    if (allocated(contacts)) deallocate (contacts)
    allocate (contacts(items))
    call mslip_contact_init(flat_parameters(), contacts(1), ok)
    contacts = contacts(1)
    if (allocated(elements)) deallocate (elements)
    allocate (elements(items))
    call mslip_element_init(flat_parameters(), directions, MSLIP_INPUT_APPROACH, elements(1), ok)
    elements = elements(1)
    vector = [spread(1.0e-7_wp, 1, int(directions)), 2.0e-7_wp]
    vectors = spread(vector, 2, n)
    scalar = 1.0e-7_wp
    x = [1.0e-7_wp, 2.0e-7_wp, 3.0e-7_wp]
    u = spread([0.0_wp, 3.0e-7_wp, 1.0e-7_wp, 0.0_wp, 2.0e-8_wp], 2, items)
    if (allocated(index)) deallocate (index)
    if (allocated(active)) deallocate (active)
    if (procedures(p)%batch) then
      index = [(int(i, mslip_int), i = 1, n)]
      active = spread(1_mslip_int, 1, n)
    end if
    state = spread(0.0_wp, 1, int(mslip_state_length(reversals)))
    call mslip_state_init(state, ok)
    call mslip_masing_path_advance(contacts(1), state, [2.0e-7_wp, 0.5e-7_wp, 1.5e-7_wp], ok)
    workspace = spread(0.0_wp, 1, int(mslip_harmonic_workspace_length(h, samples)))
    call mslip_harmonic_workspace_init(h, samples, workspace, ok)
    table = spread(0.0_wp, 1, int(mslip_stiffness_table_length()))
    call mslip_stiffness_table_init(contacts(1), table, ok)
    if (procedures(p)%element) then
      state = spread(0.0_wp, 1, int(mslip_element_state_length(directions, pieces)))
      call mslip_element_state_init(directions, state, ok)
      call mslip_element_path_advance(elements(1), state, reshape([spread(1.0e-8_wp, 1, int(directions)), 1.0e-7_wp, &
        spread(0.0_wp, 1, int(directions)), 2.0e-7_wp], [components, 2]), ok)
      call check_status('set up: state', ok, MSLIP_OK)
      u = spread([reshape([real(wp) ::], [int(directions)*m], pad=[0.0_wp, 3.0e-7_wp, 1.0e-7_wp, 0.0_wp, 2.0e-8_wp]), &
        2.0e-7_wp, 5.0e-8_wp, 0.0_wp, 0.0_wp, 1.0e-8_wp], 2, items)
      workspace = spread(0.0_wp, 1, int(mslip_element_workspace_length(directions, h, samples)))
      call mslip_element_workspace_init(directions, h, samples, periods, workspace, ok)
    end if
    states = spread(state, 2, n)
    call check_status('set up', ok, MSLIP_OK)
    do i = 1, size(out)
      out(i) = output()
      select case (procedures(p)%outputs(i:i))
      case ('s', 'S'); out(i)%s = untouched
      case ('v', 'V'); out(i)%v = spread(untouched, 1, n)
      case ('c'); out(i)%v = spread(untouched, 1, m)
      case ('N'); out(i)%v = spread(untouched, 1, size(state))
      case ('f'); out(i)%m = reshape([real(wp) ::], [m, n], pad=[untouched])
      case ('q'); out(i)%m = reshape([real(wp) ::], [int(MSLIP_PARAMETER_COUNT), n], pad=[untouched])
      case ('r'); out(i)%m = reshape([real(wp) ::], [m, int(MSLIP_PARAMETER_COUNT)], pad=[untouched])
      case ('j'); out(i)%m = reshape([real(wp) ::], [m, m], pad=[untouched])
      case ('B'); out(i)%m = reshape([real(wp) ::], shape(states), pad=[untouched])
      case ('k'); out(i)%t = reshape([real(wp) ::], [m, m, n], pad=[untouched])
      case ('p'); out(i)%v = spread(untouched, 1, components)
      case ('t'); out(i)%m = reshape([real(wp) ::], [components, components], pad=[untouched])
      case ('a'); out(i)%m = reshape([real(wp) ::], [components, n], pad=[untouched])
      case ('b'); out(i)%t = reshape([real(wp) ::], [components, components, n], pad=[untouched])
      case ('d'); out(i)%v = spread(untouched, 1, me)
      case ('e'); out(i)%m = reshape([real(wp) ::], [me, me], pad=[untouched])
      case ('g'); out(i)%m = reshape([real(wp) ::], [me, n], pad=[untouched])
      case ('h'); out(i)%t = reshape([real(wp) ::], [me, me, n], pad=[untouched])
      end select
    end do
  end subroutine set_up

  subroutine perform()
    select case (p)
    ! <generated: calls>
    case (1); call mslip_tractions(contacts(1), scalar, x, status, out(1)%v, out(2)%v)
    case (2); call mslip_slip(contacts(1), scalar, x, status, out(1)%v, out(2)%v)
    case (3); call mslip_monotonic_displacement(contacts(1), x, status, out(1)%v, out(2)%v, out(3)%v)
    case (4); call mslip_monotonic_displacement(contacts(1), scalar, status, out(1)%s, out(2)%s, out(3)%s)
    case (5); call mslip_monotonic_force(contacts(1), x, status, out(1)%v, out(2)%v, out(3)%v)
    case (6); call mslip_monotonic_force(contacts(1), scalar, status, out(1)%s, out(2)%s, out(3)%s)
    case (7); call mslip_monotonic_sensitivity(contacts(1), x, status, out(1)%v, out(2)%m)
    case (8); call mslip_masing_update(contacts(1), state, scalar, out(5)%v, status, out(1)%s, out(2)%s, out(3)%s)
    case (9); call mslip_masing_advance(contacts(1), state, scalar, status, out(1)%s, out(2)%s, out(3)%s)
    case (10); call mslip_masing_path(contacts(1), state, x, out(5)%v, status, out(1)%v, out(2)%v, out(3)%v)
    case (11); call mslip_masing_path_advance(contacts(1), state, x, status, out(1)%v, out(2)%v, out(3)%v)
    case (12); call mslip_masing_tractions(contacts(1), state, x, status, out(1)%v, out(2)%v)
    case (13); call mslip_hysteresis_loop(contacts(1), scalar, out(1)%v, out(2)%v, status)
    case (14); call mslip_dissipated_energy(contacts(1), x, out(1)%v, status)
    case (15); call mslip_dissipated_energy(contacts(1), scalar, out(1)%s, status)
    case (16); call mslip_complex_stiffness(contacts(1), x, status, out(1)%v, out(2)%v, out(3)%v, out(4)%v)
    case (17); call mslip_complex_stiffness(contacts(1), scalar, status, out(1)%s, out(2)%s, out(3)%s, out(4)%s)
    case (18); call mslip_complex_stiffness_tabulated(contacts(1), table, x, status, out(1)%v, out(2)%v, out(3)%v, &
      out(4)%v)
    case (19); call mslip_complex_stiffness_tabulated(contacts(1), table, scalar, status, out(1)%s, out(2)%s, &
      out(3)%s, out(4)%s)
    case (20); call mslip_jenkins_equivalent(contacts(1), scalar, out(1)%s, out(2)%s, status)
    case (21); call mslip_iwan_equivalent(contacts(1), out(1)%v, out(2)%v, status, out(3)%s)
    case (22); call mslip_harmonic_force(contacts(1), workspace, u(:, 1), status, out(1)%v, out(2)%m, out(3)%s)
    case (23); call mslip_harmonic_sensitivity(contacts(1), workspace, u(:, 1), status, out(1)%v, out(2)%m)
    case (24); call mslip_batch_complex_stiffness(contacts, x, status, index, active, out(1)%v, out(2)%v, out(3)%v, &
      out(4)%v)
    case (25); call mslip_batch_masing_update(contacts, states, x, out(5)%m, status, index, active, out(1)%v, &
      out(2)%v, out(3)%v)
    case (26); call mslip_batch_masing_advance(contacts, states, x, status, index, active, out(1)%v, out(2)%v, &
      out(3)%v)
    case (27); call mslip_batch_harmonic_force(contacts, workspace, u, status, index, active, out(1)%m, out(2)%t, &
      out(3)%v)
    case (28); call mslip_normal_force(elements(1), x, status, out(1)%v, out(2)%v, out(3)%v)
    case (29); call mslip_normal_force(elements(1), scalar, status, out(1)%s, out(2)%s, out(3)%s)
    case (30); call mslip_normal_approach(elements(1), x, status, out(1)%v, out(2)%v, out(3)%v)
    case (31); call mslip_normal_approach(elements(1), scalar, status, out(1)%s, out(2)%s, out(3)%s)
    case (32); call mslip_element_update(elements(1), state, vector, out(5)%v, status, out(1)%v, out(2)%m, out(3)%s)
    case (33); call mslip_element_advance(elements(1), state, vector, status, out(1)%v, out(2)%m, out(3)%s)
    case (34); call mslip_element_path(elements(1), state, vectors, out(5)%v, status, out(1)%m, out(2)%t, out(3)%v)
    case (35); call mslip_element_path_advance(elements(1), state, vectors, status, out(1)%m, out(2)%t, out(3)%v)
    case (36); call mslip_element_tractions(elements(1), state, x, status, out(1)%v, out(2)%v)
    case (37); call mslip_element_harmonic_force(elements(1), workspace, u(:, 1), status, out(1)%v, out(2)%m, &
      out(3)%s, out(4)%s)
    case (38); call mslip_batch_element_update(elements, states, vectors, out(5)%m, status, index, active, out(1)%m, &
      out(2)%t, out(3)%v)
    case (39); call mslip_batch_element_advance(elements, states, vectors, status, index, active, out(1)%m, &
      out(2)%t, out(3)%v)
    case (40); call mslip_batch_element_harmonic_force(elements, workspace, u, status, index, active, out(1)%m, &
      out(2)%t, out(3)%v, out(4)%v)
    ! </generated>
    end select
  end subroutine perform

  pure integer function place_of(name)
    character(len=*), intent(in) :: name

    do place_of = size(procedures), 1, -1
      if (procedures(place_of)%name == name) exit
    end do
  end function place_of

  pure function flat(one) result(values)
    type(output), intent(in) :: one
    real(wp), allocatable :: values(:)

    values = [real(wp) ::]
    if (allocated(one%s)) values = [one%s]
    if (allocated(one%v)) values = one%v
    if (allocated(one%m)) values = [one%m]
    if (allocated(one%t)) values = [one%t]
  end function flat

  pure logical function is_untouched(values)
    ! Compared as bits: a value written in error may be NaN.
    real(wp), intent(in) :: values(:)

    is_untouched = all(transfer(values, [0_c_int64_t]) == transfer(untouched, 0_c_int64_t))
  end function is_untouched

  subroutine rejected(what, expected)
    ! The call has this status and modifies no output and no state.
    character(len=*), intent(in) :: what
    integer(mslip_int), intent(in) :: expected

    real(wp) :: before(size(state) + size(states))
    integer :: i

    before = [state, states]
    call perform()
    call check_status(trim(procedures(p)%name)//': '//what, status, expected)
    call check(trim(procedures(p)%name)//', '//what//': nothing modified', all([(is_untouched(flat(out(i))), i = 1, size(out))]) &
      .and. all(transfer([state, states], [0_c_int64_t]) == transfer(before, [0_c_int64_t])))
  end subroutine rejected

  logical function is_optional(i)
    integer, intent(in) :: i

    is_optional = scan(procedures(p)%outputs(i:i), 'svcjfkptabdeghqr') > 0
  end function is_optional

  subroutine test_subsets()
    type(output) :: all_outputs(size(out))
    integer :: subset, i

    call set_up()
    call perform()
    all_outputs = out
    call check_status(procedures(p)%name, status, MSLIP_OK)
    call check(trim(procedures(p)%name)//': all outputs are written', &
      .not. any([(size(flat(out(i))) > 0 .and. is_untouched(flat(out(i))), i = 1, size(out))]))
    do subset = 0, 15
      call set_up()
      do i = 1, 4
        if (is_optional(i) .and. .not. btest(subset, i - 1)) out(i) = output()
      end do
      call perform()
      call check_status(trim(procedures(p)%name)//': a subset of the outputs', status, MSLIP_OK)
      do i = 1, size(out)
        if (size(flat(out(i))) > 0) call check_same(trim(procedures(p)%name)//': a subset of the outputs', flat(out(i)), &
          flat(all_outputs(i)))
      end do
    end do
  end subroutine test_subsets

  subroutine test_sizes()
    ! Each array is longer by one, in each of its dimensions.
    integer :: i, d, extent(3)

    do i = 1, size(out)
      call set_up()
      if (allocated(out(i)%v)) then
        out(i)%v = spread(untouched, 1, size(out(i)%v) + 1)
        call rejected('size', MSLIP_BAD_ARRAY_SIZE)
      end if
      do d = 1, 3
        call set_up()
        if (allocated(out(i)%m)) extent(:2) = shape(out(i)%m)
        if (allocated(out(i)%t)) extent = shape(out(i)%t)
        extent(d) = extent(d) + 1
        if (allocated(out(i)%t)) then
          out(i)%t = reshape([real(wp) ::], extent, pad=[untouched])
          call rejected('size', MSLIP_BAD_ARRAY_SIZE)
        else if (allocated(out(i)%m) .and. d < 3) then
          out(i)%m = reshape([real(wp) ::], extent(:2), pad=[untouched])
          call rejected('size', MSLIP_BAD_ARRAY_SIZE)
        end if
      end do
    end do
    call set_up()
    u = reshape([u], shape(u) + [1, 0], pad=[0.0_wp])
    if (procedures(p)%memory == 'w') call rejected('coefficients', MSLIP_BAD_COEFFICIENTS)
    if (procedures(p)%element .and. procedures(p)%memory == 's' .and. procedures(p)%array == shift) then
      call set_up()
      vector = [vector, 0.0_wp]
      vectors = reshape([vectors], [components + 1, n], pad=[0.0_wp])
      call rejected('components', MSLIP_BAD_ARRAY_SIZE)
      vector = vector(:components - 1)
      vectors = vectors(:components - 1, :)
      call rejected('components', MSLIP_BAD_ARRAY_SIZE)
    end if
    if (.not. procedures(p)%batch) return
    call set_up()
    index = [index, 1_mslip_int]
    call rejected('size of index', MSLIP_BAD_ARRAY_SIZE)
    call set_up()
    active = [active, 1_mslip_int]
    call rejected('size of active', MSLIP_BAD_ARRAY_SIZE)
    call set_up()
    x = [x, 0.0_wp]
    u = reshape([u], shape(u) + [0, 1], pad=[0.0_wp])
    vectors = reshape([vectors], [components, n + 1], pad=[0.0_wp])
    call rejected('size of the input', MSLIP_BAD_ARRAY_SIZE)
    call set_up()
    states = reshape([states], [size(states, 1), n + 1], pad=[0.0_wp])
    if (procedures(p)%memory == 's') call rejected('number of states', MSLIP_BAD_ARRAY_SIZE)
  end subroutine test_sizes

  subroutine test_values()
    integer :: k

    do k = 1, bad_values
      call set_up()
      scalar = bad(k)
      if (procedures(p)%scalar /= none) call rejected('scalar', procedures(p)%scalar)
      call set_up()
      x(n) = bad(k)
      u(m, size(u, 2)) = bad(k)
      vector(components - 1) = bad(k)
      vectors(components - 1, n) = bad(k)
      if (procedures(p)%array /= none) call rejected('array', procedures(p)%array)
      if (procedures(p)%element .and. procedures(p)%array == shift .and. procedures(p)%memory /= ' ') call test_normal_value(bad(k))
    end do
    do k = -1, 1, 2
      call set_up()
      scalar = 1.001_wp*k*contacts(1)%slip_force
      x(n) = scalar
      if (any([procedures(p)%scalar, procedures(p)%array] == force)) call rejected('a force beyond mu N', MSLIP_FORCE_EXCEEDS_SLIP)
      if (any([procedures(p)%scalar, procedures(p)%array] == force_amplitude)) &
        call rejected('a force amplitude', merge(MSLIP_BAD_FORCE_AMPLITUDE, MSLIP_FORCE_EXCEEDS_SLIP, k < 0))
      if (k < 0 .and. any([procedures(p)%scalar, procedures(p)%array] == amplitude)) call rejected('amplitude', amplitude)
    end do
  end subroutine test_values

  subroutine test_normal_value(value)
    ! The normal component of a displacement is an approach or a normal force.
    real(wp), intent(in) :: value

    integer(mslip_int) :: ok
    integer :: input, i

    do input = MSLIP_INPUT_APPROACH, MSLIP_INPUT_NORMAL_FORCE
      call set_up()
      do i = 1, size(elements)
        call mslip_element_init(flat_parameters(), directions, int(input, mslip_int), elements(i), ok)
      end do
      vector(components) = value
      vectors(components, n) = value
      u(me - m + 1, size(u, 2)) = value
      if (input == MSLIP_INPUT_APPROACH .or. procedures(p)%memory == 'w') then
        call rejected('a normal component', MSLIP_BAD_DISPLACEMENT)
      else
        call rejected('a normal component', MSLIP_BAD_NORMAL_FORCE)
      end if
      vector(components) = merge(1.0_wp, -1.0_wp, input == MSLIP_INPUT_APPROACH)
      vectors(components, n) = vector(components)
      u(me - m + 1, size(u, 2)) = vector(components)
      call rejected('a normal component', merge(MSLIP_LENGTH_TOO_SHORT, MSLIP_BAD_NORMAL_FORCE, input == MSLIP_INPUT_APPROACH))
    end do
  end subroutine test_normal_value

  subroutine test_memory()
    ! Contacts, elements, states, workspaces and tables that were never initialised, hold other values, or are truncated.
    integer :: k

    call set_up()
    contacts(size(contacts)) = mslip_contact()
    elements(size(elements)) = mslip_element()
    call rejected('an uninitialised contact or element', merge(MSLIP_BAD_ELEMENT, MSLIP_BAD_CONTACT, procedures(p)%element))
    if (procedures(p)%name == 'slip') then
      call set_up()
      call mslip_contact_init_elliptic(ellipse_parameters(), contacts(1), status)
      call rejected('an elliptical contact', MSLIP_NOT_AVAILABLE)
    end if
    do k = 0, bad_values
      call set_up()
      state = spread(0.0_wp, 1, size(state))
      if (k > 0) state = spread(bad(max(k, 1)), 1, size(state))
      states(:, n) = state
      workspace = spread(state(1), 1, size(workspace))
      if (procedures(p)%memory == 's') call rejected('an uninitialised state', MSLIP_BAD_STATE)
      table = spread(state(1), 1, size(table))
      if (procedures(p)%memory == 'w') call rejected('an uninitialised workspace', MSLIP_BAD_WORKSPACE)
      if (procedures(p)%memory == 't') call rejected('an uninitialised table', MSLIP_BAD_TABLE)
    end do
    call set_up()
    state = state(:3)
    states = states(:3, :)
    workspace = workspace(:size(workspace) - 1)
    table = table(:size(table) - 1)
    if (procedures(p)%outputs(5:5) == 'N') out(5)%v = out(5)%v(:3)
    if (procedures(p)%outputs(5:5) == 'B') out(5)%m = out(5)%m(:3, :)
    if (procedures(p)%memory == 's') call rejected('a truncated state', MSLIP_STATE_TOO_SHORT)
    if (procedures(p)%memory == 'w') call rejected('a truncated workspace', MSLIP_WORKSPACE_TOO_SHORT)
    if (procedures(p)%memory == 'w') then
      workspace = workspace(:2)
      call rejected('a workspace of two values', MSLIP_WORKSPACE_TOO_SHORT)
    end if
    if (procedures(p)%memory == 't') then
      call rejected('a truncated table', MSLIP_TABLE_TOO_SHORT)
      table = table(:0)
      call rejected('a table without elements', MSLIP_TABLE_TOO_SHORT)
    end if
  end subroutine test_memory

  subroutine test_batch()
    ! Indices count from 1. An item that is not active is neither checked nor modified.
    integer(mslip_int), parameter :: bad_index(4) = [0_mslip_int, int(n + 1, mslip_int), -huge(1_mslip_int), huge(1_mslip_int)]
    integer :: i, k

    do k = 1, size(bad_index)
      call set_up()
      index(n) = bad_index(k)
      call rejected('index', MSLIP_BAD_INDEX)
    end do
    do k = 1, 3
      call set_up()
      if (k == 1) x(n) = bad(4)
      if (k == 1) u(:, n) = bad(4)
      if (k == 1) vectors(:, n) = bad(4)
      if (k == 2) index(n) = 0
      if (k == 3) contacts(n) = mslip_contact()
      if (k == 3) elements(n) = mslip_element()
      active(n) = 0
      call perform()
      call check_status(trim(procedures(p)%name)//': an invalid item is skipped', status, MSLIP_OK)
      do i = 1, size(out)
        associate (values => flat(out(i)))
          call check(trim(procedures(p)%name)//': all items but the skipped one are written', size(values) == 0 &
            .or. (is_untouched(values(2*size(values)/n + 1:)) .and. .not. is_untouched(values(:2*size(values)/n))))
        end associate
      end do
    end do
  end subroutine test_batch

  subroutine test_parameters()
    ! Every parameter in turn: unset, invalid, negative; and combinations.
    integer(mslip_int), parameter :: expected(9) = [MSLIP_BAD_FLAT_HALF_WIDTH, MSLIP_BAD_EDGE_RADIUS, MSLIP_BAD_LENGTH, &
      MSLIP_BAD_NORMAL_FORCE, MSLIP_BAD_FRICTION_COEFFICIENT, MSLIP_BAD_YOUNG_MODULUS, MSLIP_BAD_POISSON_RATIO, &
      MSLIP_BAD_YOUNG_MODULUS, MSLIP_BAD_POISSON_RATIO]
    integer(mslip_int), parameter :: elliptic(9) = [MSLIP_BAD_SEMI_AXIS_X, MSLIP_BAD_SEMI_AXIS_Y, expected(4:), none]
    type(mslip_parameters) :: parameters, unset
    type(mslip_elliptic_parameters) :: ellipse
    type(mslip_contact) :: contact
    real(wp) :: values(14), value
    integer :: i, k

    call mslip_contact_init(unset, contact, status)
    call check_status('parameters never set', status, MSLIP_BAD_FLAT_HALF_WIDTH)
    contact%half_width = untouched
    do i = 1, size(expected)
      do k = 0, bad_values
        value = -1
        if (k > 0) value = bad(max(k, 1))
        values = transfer(flat_parameters(), values)
        values(i) = value
        call mslip_contact_init(transfer(values, parameters), contact, status)
        call check_status('a parameter', status, expected(i))
        if (elliptic(i) == none) cycle
        values(:13) = transfer(ellipse_parameters(), values, 13)
        values(i) = value
        call mslip_contact_init_elliptic(transfer(values(:13), ellipse), contact, status)
        call check_status('a parameter of an ellipse', status, elliptic(i))
      end do
      call mslip_parameters_default(unset)
      values = transfer(unset, values)
      values(:i - 1) = transfer(flat_parameters(), values, i - 1)
      call mslip_contact_init(transfer(values, parameters), contact, status)
      call check_status('an unset parameter', status, expected(i))
    end do
    call mslip_elliptic_parameters_default(ellipse)
    call mslip_contact_init_elliptic(ellipse, contact, status)
    call check_status('an unset ellipse', status, MSLIP_BAD_SEMI_AXIS_X)
    parameters = flat_parameters()
    parameters%displacement_reference = unset%displacement_reference
    call mslip_contact_init(parameters, contact, status)
    call check_status('an unset displacement reference', status, MSLIP_BAD_DISPLACEMENT_REFERENCE)
    ellipse = ellipse_parameters()
    ellipse%layer%normal_compliance = -1
    call mslip_contact_init_elliptic(ellipse, contact, status)
    call check_status('the normal compliance of a layer', status, MSLIP_BAD_NORMAL_COMPLIANCE)
    ellipse%layer = mslip_layer(0, -1, 0)
    call mslip_contact_init_elliptic(ellipse, contact, status)
    call check_status('the tangential compliance of a layer', status, MSLIP_BAD_TANGENTIAL_COMPLIANCE)
    ellipse%layer = mslip_layer(0, 0, -1)
    call mslip_contact_init_elliptic(ellipse, contact, status)
    call check_status('the stiffening load of a layer', status, MSLIP_BAD_STIFFENING_LOAD)
    ellipse%layer = mslip_layer(0, 0, 0, -1)
    call mslip_contact_init_elliptic(ellipse, contact, status)
    call check_status('the reference load of a layer', status, MSLIP_BAD_REFERENCE_LOAD)
    parameters = flat_parameters()
    parameters%length = 1.0e-4_wp
    call mslip_contact_init(parameters, contact, status)
    call check_status('a short length', status, MSLIP_LENGTH_TOO_SHORT)
    parameters%edge_radius = 1.0e300_wp
    call mslip_contact_init(parameters, contact, status)
    call check_status('a large radius', status, MSLIP_OUT_OF_RANGE)
    call check('a rejected contact is not modified', is_untouched([contact%half_width]))
  end subroutine test_parameters

  subroutine test_contact_check()
    ! Any changed bit of a contact.
    type(mslip_contact) :: contact
    real(wp) :: words(storage_size(contact)/64)
    integer :: i, bit, found

    call mslip_contact_init(flat_parameters(), contact, status)
    words = transfer(contact, words)
    call mslip_contact_check(contact, status)
    call check_status('check of a contact', status, MSLIP_OK)
    call mslip_contact_check(mslip_contact(), status)
    call check_status('check of an uninitialised contact', status, MSLIP_BAD_CONTACT)
    found = 0
    do i = 1, size(words)
      do bit = 0, 63
        words(i) = flipped(words(i), bit)
        call mslip_contact_check(transfer(words, contact), status)
        if (status == MSLIP_BAD_CONTACT) found = found + 1
        words(i) = flipped(words(i), bit)
      end do
    end do
    call check('the check of a contact finds every changed bit', found == 64*size(words))
  end subroutine test_contact_check

  pure function flipped(value, bit)
    real(wp), intent(in) :: value
    integer, intent(in) :: bit
    real(wp) :: flipped

    flipped = transfer(ieor(transfer(value, 0_c_int64_t), ishft(1_c_int64_t, bit)), value)
  end function flipped

  subroutine test_state_check()
    real(wp) :: changed(mslip_state_length(reversals)), error
    integer :: i, k

    p = place_of('masing_advance')
    call set_up()
    call mslip_state_check(state, status)
    call check_status('check of a state', status, MSLIP_OK)
    do k = 1, bad_values
      do i = 1, int(mslip_state_length(2_mslip_size))
        changed = state
        changed(i) = bad(k)
        call mslip_state_check(changed, status)
        call check_status('check of a state with an invalid value', status, MSLIP_BAD_STATE)
      end do
    end do
    call mslip_masing_path_advance(contacts(1), state, [0.8e-7_wp, 1.3e-7_wp, 1.0e-7_wp], status)
    state = state(:mslip_state_length(2_mslip_size))
    call rejected('a state truncated below its reversals', MSLIP_BAD_STATE)
    call mslip_state_check(state(:2), status)
    call check_status('check of a short state', status, MSLIP_STATE_TOO_SHORT)
    do i = 0, 1
      call mslip_state_init(state(1:i), status)
      call check_status('a short state', status, MSLIP_STATE_TOO_SHORT)
    end do
    error = untouched
    state = 0
    call mslip_state_error(state, error, status)
    call check_status('error of an uninitialised state', status, MSLIP_BAD_STATE)
    call check('error of an uninitialised state', is_untouched([error]))
  end subroutine test_state_check

  subroutine test_elements()
    ! Invalid parameters, numbers of directions and normal inputs; any changed bit.
    integer(mslip_int), parameter :: invalid(4) = [0_mslip_int, -1_mslip_int, 3_mslip_int, huge(one)]
    type(mslip_parameters) :: parameters
    type(mslip_elliptic_parameters) :: ellipse, unset
    type(mslip_element) :: element
    real(wp) :: words(storage_size(element)/64)
    integer :: i, bit, found, changed

    element%half_width = untouched
    do i = 1, size(invalid)
      call mslip_element_init(flat_parameters(), invalid(i), MSLIP_INPUT_APPROACH, element, status)
      call check_status('directions of an element', status, MSLIP_BAD_DIRECTIONS)
      call mslip_element_init_elliptic(ellipse_parameters(), invalid(i), MSLIP_INPUT_APPROACH, element, status)
      call check_status('directions of an elliptical element', status, MSLIP_BAD_DIRECTIONS)
      call check('no state for these directions', mslip_element_state_length(invalid(i), pieces) == 0)
    end do
    call mslip_element_init(flat_parameters(), one, 2_mslip_int, element, status)
    call check_status('normal input of an element', status, MSLIP_BAD_NORMAL_INPUT)
    call mslip_element_init_elliptic(ellipse_parameters(), one, -1_mslip_int, element, status)
    call check_status('normal input of an elliptical element', status, MSLIP_BAD_NORMAL_INPUT)
    call mslip_element_init(parameters, one, MSLIP_INPUT_APPROACH, element, status)
    call check_status('an element of unset parameters', status, MSLIP_BAD_FLAT_HALF_WIDTH)
    call mslip_element_init_elliptic(unset, one, MSLIP_INPUT_APPROACH, element, status)
    call check_status('an elliptical element of unset parameters', status, MSLIP_BAD_SEMI_AXIS_X)
    parameters = flat_parameters()
    parameters%normal_force = 0
    call mslip_element_init(parameters, one, MSLIP_INPUT_APPROACH, element, status)
    call check_status('an element without a largest normal force', status, MSLIP_BAD_NORMAL_FORCE)
    ellipse = ellipse_parameters()
    ellipse%normal_force = 0
    call mslip_element_init_elliptic(ellipse, one, MSLIP_INPUT_APPROACH, element, status)
    call check_status('an elliptical element without a largest normal force', status, MSLIP_BAD_NORMAL_FORCE)
    parameters = flat_parameters()
    parameters%length = 1.0e-4_wp
    call mslip_element_init(parameters, one, MSLIP_INPUT_APPROACH, element, status)
    call check_status('an element of a short length', status, MSLIP_LENGTH_TOO_SHORT)
    parameters%edge_radius = 1.0e300_wp
    call mslip_element_init(parameters, one, MSLIP_INPUT_APPROACH, element, status)
    call check_status('an element of a large radius', status, MSLIP_OUT_OF_RANGE)
    call check('a rejected element is not modified', is_untouched([element%half_width]))

    call mslip_element_check(element, status)
    call check_status('check of an uninitialised element', status, MSLIP_BAD_ELEMENT)
    call mslip_element_init(flat_parameters(), one, MSLIP_INPUT_APPROACH, element, status)
    call mslip_element_check(element, status)
    call check_status('check of an element', status, MSLIP_OK)
    words = transfer(element, words)
    found = 0
    changed = 0
    do i = 1, size(words), 7
      do bit = 0, 63, 3
        changed = changed + 1
        words(i) = flipped(words(i), bit)
        element = transfer(words, element)
        call mslip_element_check(element, status)
        if (status == MSLIP_BAD_ELEMENT) found = found + 1
        words(i) = flipped(words(i), bit)
      end do
    end do
    call check('the check of an element finds changed bits', found == changed)
  end subroutine test_elements

  subroutine test_two_directions()
    ! Elements, states and workspaces of one direction among those of two, the tractions of two directions, and skipped items.
    type(mslip_element) :: other
    real(wp), allocatable :: state_of_one(:), workspace_of_one(:)
    real(wp) :: error
    integer :: i

    call mslip_element_init(flat_parameters(), one, MSLIP_INPUT_APPROACH, other, status)
    state_of_one = spread(0.0_wp, 1, int(mslip_element_state_length(one, 500_mslip_size)))
    call mslip_element_state_init(one, state_of_one, status)
    workspace_of_one = spread(0.0_wp, 1, int(mslip_element_workspace_length(one, h, samples)))
    call mslip_element_workspace_init(one, h, samples, periods, workspace_of_one, status)
    call check_status('set up: one direction', status, MSLIP_OK)
    do i = 1, size(procedures)
      p = i
      if (.not. procedures(p)%element .or. procedures(p)%memory == ' ') cycle
      call set_up()
      if (procedures(p)%name == 'element_tractions') then
        call rejected('two directions', MSLIP_NOT_AVAILABLE)
        cycle
      end if
      elements(1) = other
      call rejected('one direction', merge(MSLIP_BAD_DIRECTIONS, MSLIP_BAD_ARRAY_SIZE, procedures(p)%memory == 'w'))
      if (procedures(p)%batch) then
        active(1) = 0
        call perform()
        call check_status(trim(procedures(p)%name)//': the only element of one direction is skipped', status, MSLIP_OK)
        call set_up()
        elements(n) = other
        call rejected('the last element has one direction', MSLIP_BAD_DIRECTIONS)
        active = 0
        call perform()
        call check_status(trim(procedures(p)%name)//': all items are skipped', status, MSLIP_OK)
      end if
      call set_up()
      workspace = workspace_of_one
      if (procedures(p)%memory == 'w') call rejected('the workspace of one direction', MSLIP_BAD_COEFFICIENTS)
      state = state_of_one
      states(:, n) = state_of_one(:size(states, 1))
      if (procedures(p)%outputs(5:5) == 'N') out(5)%v = spread(untouched, 1, size(state))
      if (procedures(p)%memory == 's') call rejected('the state of one direction', MSLIP_BAD_DIRECTIONS)
    end do
    error = untouched
    state_of_one = spread(0.0_wp, 1, int(mslip_element_state_length(2_mslip_int, 0_mslip_size)))
    call mslip_element_state_init(2_mslip_int, state_of_one, status)
    call check_status('state of two directions', status, MSLIP_OK)
    call mslip_element_state_check(one, state_of_one, status)
    call check_status('check of a state of two directions as one of one', status, MSLIP_BAD_DIRECTIONS)
    call mslip_element_state_error(one, state_of_one, error, status)
    call check_status('error of a state of two directions as one of one', status, MSLIP_BAD_DIRECTIONS)
    call check('no error of the other direction', is_untouched([error]))
    call mslip_element_state_error(2_mslip_int, state_of_one, error, status)
    call check('no error of an open contact', status == MSLIP_OK .and. error >= 0)
  end subroutine test_two_directions

  subroutine test_element_state()
    real(wp), allocatable :: changed(:)
    real(wp) :: error
    integer(mslip_int) :: invalid
    integer :: i, k

    p = place_of('element_advance')
    call set_up()
    call mslip_element_state_check(one, state, status)
    call check_status('check of the state of an element', status, MSLIP_OK)
    do k = 1, bad_values
      do i = 1, 16
        changed = state
        changed(i) = bad(k)
        call mslip_element_state_check(one, changed, status)
        call check_status('check of the state of an element with an invalid value', status, MSLIP_BAD_STATE)
      end do
    end do
    error = untouched
    do invalid = 0, 3, 3
      call mslip_element_state_init(invalid, state, status)
      call check_status('state of these directions', status, MSLIP_BAD_DIRECTIONS)
      call mslip_element_state_check(invalid, state, status)
      call check_status('check of these directions', status, MSLIP_BAD_DIRECTIONS)
      call mslip_element_state_error(invalid, state, error, status)
      call check_status('error of these directions', status, MSLIP_BAD_DIRECTIONS)
    end do
    call mslip_element_state_check(one, state, status)
    call check_status('check after rejected initialisations', status, MSLIP_OK)
    do i = 0, 27, 27
      call mslip_element_state_init(one, state(:i), status)
      call check_status('a short state of an element', status, MSLIP_STATE_TOO_SHORT)
      call mslip_element_state_check(one, state(:i), status)
      call check_status('check of a short state of an element', status, MSLIP_STATE_TOO_SHORT)
      call mslip_element_state_error(one, state(:i), error, status)
      call check_status('error of a short state of an element', status, MSLIP_STATE_TOO_SHORT)
    end do
    state = 0
    call mslip_element_state_error(one, state, error, status)
    call check_status('error of an uninitialised state of an element', status, MSLIP_BAD_STATE)
    call check('no error of rejected states', is_untouched([error]))
  end subroutine test_element_state

  subroutine test_element_workspace()
    integer(mslip_size) :: found(3)
    integer(mslip_int) :: kinds(2)
    integer :: last

    workspace = spread(untouched, 1, int(mslip_element_workspace_length(one, h, samples)))
    last = size(workspace)
    call mslip_element_workspace_init(0_mslip_int, h, samples, periods, workspace, status)
    call check_status('workspace: directions', status, MSLIP_BAD_DIRECTIONS)
    call mslip_element_workspace_init(one, 0_mslip_size, samples, periods, workspace, status)
    call check_status('workspace: no harmonics', status, MSLIP_BAD_HARMONICS)
    call mslip_element_workspace_init(one, h, 2*h, periods, workspace, status)
    call check_status('workspace: too few samples', status, MSLIP_BAD_SAMPLES)
    call mslip_element_workspace_init(one, h, samples, periods, workspace, status, 2_mslip_int)
    call check_status('workspace: unknown rule', status, MSLIP_BAD_RULE)
    call mslip_element_workspace_init(one, h, samples, periods, workspace, status, MSLIP_EVENT_DRIVEN)
    call check_status('workspace: event-driven', status, MSLIP_NOT_AVAILABLE)
    call mslip_element_workspace_init(one, h, samples, 65537_mslip_size, workspace, status)
    call check_status('workspace: too many periods', status, MSLIP_BAD_PERIODS)
    call mslip_element_workspace_init(one, h, samples, -1_mslip_size, workspace, status)
    call check_status('workspace: a negative number of periods', status, MSLIP_BAD_PERIODS)
    call mslip_element_workspace_init(one, h, samples, periods, workspace(1:last - 1), status)
    call check_status('workspace of an element too short by one', status, MSLIP_WORKSPACE_TOO_SHORT)
    call mslip_element_workspace_init(one, h, samples, periods, workspace(1:0), status)
    call check_status('workspace of an element without elements', status, MSLIP_WORKSPACE_TOO_SHORT)
    found = -1
    kinds = -1
    call mslip_element_workspace_size(workspace, kinds(1), found(1), found(2), kinds(2), found(3), status)
    call check_status('size of an uninitialised workspace of an element', status, MSLIP_BAD_WORKSPACE)
    call check('rejected workspaces of an element: nothing written', is_untouched(workspace))
    call mslip_element_workspace_init(one, h, samples, periods, workspace, status)
    call mslip_element_workspace_size(workspace(1:last - 1), kinds(1), found(1), found(2), kinds(2), found(3), status)
    call check_status('size of a truncated workspace of an element', status, MSLIP_WORKSPACE_TOO_SHORT)
    call check('rejected workspaces of an element: no size', all(found == -1) .and. all(kinds == -1))
    call check('no length for invalid sizes of an element', all([mslip_element_workspace_length(one, h, samples, 2_mslip_int), &
      mslip_element_workspace_length(one, 0_mslip_size, samples), mslip_element_workspace_length(3_mslip_int, h, samples), &
      mslip_element_workspace_length(one, -1_mslip_size, -1_mslip_size)] == 0))
  end subroutine test_element_workspace

  subroutine test_table()
    ! Tables of another shape, uninitialised contacts, and tables that are too short.
    type(mslip_parameters) :: parameters
    type(mslip_contact) :: contact
    integer :: last

    do p = place_of('complex_stiffness_tabulated'), place_of('complex_stiffness_tabulated, one')
      call set_up()
      parameters = flat_parameters()
      parameters%normal_force = 1.01_wp*parameters%normal_force
      call mslip_contact_init(parameters, contact, status)
      call mslip_stiffness_table_init(contact, table, status)
      call check_status('table of another shape', status, MSLIP_OK)
      call rejected('a table of another shape', MSLIP_BAD_TABLE)
      call mslip_contact_init_elliptic(ellipse_parameters(), contact, status)
      call mslip_stiffness_table_init(contact, table, status)
      call rejected('the table of an ellipse', MSLIP_BAD_TABLE)
      table(:size(state)) = state
      call rejected('a state as table', MSLIP_BAD_TABLE)
    end do
    table = untouched
    last = size(table)
    call mslip_stiffness_table_init(contacts(1), table(1:last - 1), status)
    call check_status('table too short by one', status, MSLIP_TABLE_TOO_SHORT)
    call mslip_stiffness_table_init(contacts(1), table(1:0), status)
    call check_status('table without elements', status, MSLIP_TABLE_TOO_SHORT)
    call mslip_stiffness_table_init(mslip_contact(), table, status)
    call check_status('table of an uninitialised contact', status, MSLIP_BAD_CONTACT)
    call check('rejected tables: nothing written', is_untouched(table))
  end subroutine test_table

  subroutine test_workspace()
    integer(mslip_size) :: found(2)
    integer(mslip_int) :: rule
    integer :: last

    workspace = spread(untouched, 1, int(mslip_harmonic_workspace_length(h, samples)))
    last = size(workspace)
    call mslip_harmonic_workspace_init(0_mslip_size, samples, workspace, status)
    call check_status('no harmonics', status, MSLIP_BAD_HARMONICS)
    call mslip_harmonic_workspace_init(h, 2*h, workspace, status)
    call check_status('too few samples', status, MSLIP_BAD_SAMPLES)
    call mslip_harmonic_workspace_init(h, samples, workspace, status, 2_mslip_int)
    call check_status('unknown rule', status, MSLIP_BAD_RULE)
    call mslip_harmonic_workspace_init(h, samples, workspace(1:last - 1), status)
    call check_status('workspace too short by one', status, MSLIP_WORKSPACE_TOO_SHORT)
    call mslip_harmonic_workspace_init(h, samples, workspace(1:0), status)
    call check_status('workspace without elements', status, MSLIP_WORKSPACE_TOO_SHORT)
    found = -1
    rule = -1
    call mslip_harmonic_workspace_size(workspace, found(1), found(2), rule, status)
    call check_status('size of an uninitialised workspace', status, MSLIP_BAD_WORKSPACE)
    call check('rejected workspaces: nothing written', is_untouched(workspace))
    call mslip_harmonic_workspace_init(h, samples, workspace, status)
    call mslip_harmonic_workspace_size(workspace(1:last - 1), found(1), found(2), rule, status)
    call check_status('size of a truncated workspace', status, MSLIP_WORKSPACE_TOO_SHORT)
    call check('rejected workspaces: no size', all(found == -1) .and. rule == -1)
    call check('no length for invalid sizes', all([mslip_harmonic_workspace_length(h, samples, 2_mslip_int), &
      mslip_harmonic_workspace_length(0_mslip_size, samples), mslip_harmonic_workspace_length(-1_mslip_size, -1_mslip_size)] == 0))
    p = place_of('iwan_equivalent')
    call set_up()
    deallocate (out(1)%v, out(2)%v)
    allocate (out(1)%v(0), out(2)%v(0))
    call rejected('no sliders', MSLIP_BAD_COUNT)
  end subroutine test_workspace

end program bad_input
