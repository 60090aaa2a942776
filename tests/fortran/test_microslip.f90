program test_microslip
  ! The Fortran module: every output in its place (reference values of 50 digits and more), strides, and equal bits of single calls,
  ! calls in place and batches. The tests in Rust and C have the relations of the model.
  use microslip
  use checks
  implicit none

  real(wp), parameter :: pi = 3.141592653589793238462643_wp
  real(wp), parameter :: tight = 1.0e-12_wp

  type(mslip_contact) :: cylinder, flat, open_contact

  call initialise()
  call test_library()
  call test_contacts()
  call test_tractions_and_slip()
  call test_monotonic()
  call test_history()
  call test_state()
  call test_bounded_memory()
  call test_masing_tractions()
  call test_cycles()
  call test_stiffness_table()
  call test_harmonic_force()
  call test_event_driven()
  call test_batch()
  call test_index()
  call test_equivalents()
  call test_elliptic()
  call test_strides()
  call test_element()
  call test_element_law()
  call test_element_steps()
  call test_element_harmonic_force()
  call test_element_batch()
  call test_two_directions()
  call report()

contains

  function cylinder_parameters() result(p)
    type(mslip_parameters) :: p

    p = mslip_parameters(flat_half_width=0.0_wp, edge_radius=5.0e-3_wp, length=3.67e-2_wp, normal_force=2268.49_wp, &
      friction_coefficient=0.647_wp, material=[mslip_material(1.14e11_wp, 0.29_wp), mslip_material(1.14e11_wp, 0.29_wp)], &
      displacement_reference=MSLIP_CENTRE_POINT)
  end function cylinder_parameters

  function flat_parameters() result(p)
    type(mslip_parameters) :: p

    call mslip_parameters_default(p)
    p%flat_half_width = 5.0e-4_wp
    p%edge_radius = 3.0e-3_wp
    p%length = 2.0e-2_wp
    p%normal_force = 800.0_wp
    p%friction_coefficient = 0.5_wp
    p%displacement_reference = MSLIP_CENTRE_POINT
    p%material(1) = mslip_material(young_modulus=1.14e11_wp, poisson_ratio=0.32_wp)
    p%material(2) = mslip_material(young_modulus=2.0e11_wp, poisson_ratio=0.29_wp)
  end function flat_parameters

  subroutine initialise()
    type(mslip_parameters) :: p
    integer(mslip_int) :: status

    p = cylinder_parameters()
    call check('no warning', mslip_parameters_warning(p, 1_mslip_int) == '' .and. mslip_parameters_warning(p, 0_mslip_int) == '')
    p%friction_coefficient = 45
    p%length = 1.0e-3_wp*p%length
    call check('warnings', index(mslip_parameters_warning(p, 1_mslip_int), 'length is implausible') == 1 .and. &
      index(mslip_parameters_warning(p, 2_mslip_int), 'friction_coefficient is implausible') == 1 .and. &
      mslip_parameters_warning(p, 3_mslip_int) == '')
    call check('warning of an ellipse', index(mslip_elliptic_parameters_warning(mslip_elliptic_parameters(1.0_wp, 1e-3_wp, 1.0_wp, &
      0.5_wp, spread(mslip_material(2.0e11_wp, 0.3_wp), 1, 2)), 1_mslip_int), 'semi_axis_x is implausible') == 1)
    call mslip_contact_init(cylinder_parameters(), cylinder, status)
    call check_status('initialise the cylinder', status, MSLIP_OK)
    call mslip_contact_init(flat_parameters(), flat, status)
    call check_status('initialise the rounded flat', status, MSLIP_OK)
    p = flat_parameters()
    p%normal_force = 0.0_wp
    call mslip_contact_init(p, open_contact, status)
    call check_status('initialise the open contact', status, MSLIP_OK)
  end subroutine initialise

  function initial_state(reversals) result(state)
    integer(mslip_size), intent(in) :: reversals
    real(wp) :: state(mslip_state_length(reversals))

    integer(mslip_int) :: status

    call mslip_state_init(state, status)
    call check_status('initialise a state', status, MSLIP_OK)
  end function initial_state

  subroutine test_library()
    character(len=:), allocatable :: version
    integer :: i

    call check_status('interface version', mslip_abi_version(), MSLIP_MODULE_ABI_VERSION)
    version = mslip_version()
    call check('the version has three parts: '//version, &
      verify(version, '0123456789.') == 0 .and. count([(version(i:i) == '.', i = 1, len(version))]) == 2)
    call check('a message names its parameter', index(mslip_status_text(MSLIP_BAD_EDGE_RADIUS), 'edge_radius') > 0)
    call check('a message for an unknown status', len(mslip_status_text(-5_mslip_int)) > 0)
    call check('size of a contact: no padding', storage_size(cylinder) == 64*(6 + size(cylinder%reserved)))
    call check('size of a material', storage_size(mslip_material(1.0_wp, 0.3_wp)) == 2*64)
    call check('size of the parameters', storage_size(flat_parameters()) == 14*64)
  end subroutine test_library

  subroutine test_contacts()
    call check_close('cylinder: composite modulus', cylinder%composite_modulus, 6.223386832623648791206915e10_wp, tight)
    call check_close('cylinder: half-width', cylinder%half_width, 7.951738063115647130842421e-5_wp, tight)
    call check_close('cylinder: slip force', cylinder%slip_force, 1.467713029999999903099788e3_wp, tight)
    call check_close('cylinder: slip displacement', cylinder%slip_displacement, 3.164852942650645410867699e-6_wp, tight)
    call check_close('cylinder: initial stiffness', cylinder%initial_stiffness, 4.957981696888936309416248e8_wp, tight)
    call check_close('cylinder: slip energy', cylinder%slip_energy, 6.004399245114452465823618e-4_wp, tight)
  end subroutine test_contacts

  subroutine test_tractions_and_slip()
    real(wp), parameter :: x(*) = [0.0_wp, 5.041659951103544647435517e-4_wp, -5.084970613574993835923066e-4_wp, &
      5.221640639421487595228655e-4_wp]
    real(wp), parameter :: slip_x(*) = [5.104521634622967559899442e-4_wp, -5.15124991499941011288688e-4_wp, 0.0_wp]
    real(wp) :: pressure(4), shear(4), slip(3), damage(3)
    integer(mslip_int) :: status

    call mslip_tractions(flat, 240.0_wp, x, status, pressure, shear)
    call check_status('tractions', status, MSLIP_OK)
    call check_close('pressure at the centre', pressure(1), 2.495666190496205156006766e7_wp, tight)
    call check_close('pressure on the edge', pressure(2), 1.736473833135778835662131e8_wp, tight)
    call check_close('pressure in the slip zone', pressure(3), 1.667609708598286950076217e8_wp, tight)
    call check_close('shear at the centre', shear(1), 7.441286904801234009224208e6_wp, tight)
    call check_close('shear on the edge', shear(2), 4.0548663302965473860377e7_wp, tight)
    call check_close('shear in the slip zone', shear(3), 6.135332025372574580298507e7_wp, 1.0e-10_wp)
    call check_same('no tractions outside', [pressure(4), shear(4)], [0.0_wp, 0.0_wp])
    call mslip_tractions(flat, flat%slip_force, x, status, pressure, shear)
    call check_close('gross slip: shear is friction times pressure', shear(2), 0.5_wp*pressure(2), tight)

    call mslip_slip(flat, 280.0_wp, slip_x, status, slip, damage)
    call check_status('slip', status, MSLIP_OK)
    call check_close('slip near the stick zone', slip(1), 1.967416135320787743593932e-9_wp, 1.0e-10_wp)
    call check_close('slip near the rim', slip(2), 9.403969409667750594649537e-9_wp, 1.0e-10_wp)
    call check_close('damage near the stick zone', damage(1), 1.524392901733578085021671e-1_wp, 1.0e-10_wp)
    call check_same('no slip in the stick zone', [slip(3), damage(3)], [0.0_wp, 0.0_wp])
  end subroutine test_tractions_and_slip

  subroutine test_monotonic()
    real(wp), parameter :: force(*) = [7.338565149999999448482413e2_wp, -7.338565149999999448482413e2_wp, 0.0_wp]
    real(wp) :: displacement(3), compliance(3), stick(3), back(3), stiffness(3), one, two, three
    integer(mslip_int) :: status

    call mslip_monotonic_displacement(cylinder, force, status, displacement, compliance, stick)
    call check_status('monotonic displacement', status, MSLIP_OK)
    call check_close('cylinder: displacement', displacement(1), 1.511535017706025140782537e-6_wp, tight)
    call check_close('cylinder: compliance', compliance(1), 2.113551007129302142742128e-9_wp, tight)
    call check_close('cylinder: stick half-width', stick(1), 5.622727906648257149453722e-5_wp, tight)
    call check_same('odd in the force', [displacement(2), compliance(2), stick(2)], [-displacement(1), compliance(1), stick(1)])
    call check_close('no force, no slip', stick(3), cylinder%half_width, tight)
    call mslip_monotonic_displacement(flat, 280.0_wp, status, one, two, three)
    call check_status('monotonic displacement, one force', status, MSLIP_OK)
    call check_close('flat: displacement', one, 5.332941007254045813362338e-7_wp, tight)
    call check_close('flat: compliance', two, 1.908487237106152845365004e-9_wp, tight)
    call check_close('flat: stick half-width', three, 5.076484666397101623682588e-4_wp, tight)
    call mslip_monotonic_force(cylinder, [1.898911765590387203629847e-6_wp, 4.0e-6_wp, -4.0e-6_wp], status, back, stiffness, stick)
    call check_status('monotonic force', status, MSLIP_OK)
    call check_close('cylinder: force', back(1), 9.155161736711421042837688e2_wp, tight)
    call check_same('force in gross slip', back(2:3), [cylinder%slip_force, -cylinder%slip_force])
    call check_same('stiffness in gross slip', stiffness(2:3), [0.0_wp, 0.0_wp])
    call mslip_monotonic_displacement(cylinder, back(1), status, compliance=two, stick_half_width=three)
    call check_close('stiffness and compliance are inverse', stiffness(1)*two, 1.0_wp, tight)
    call check_close('the same stick zone', stick(1), three, tight)
    call mslip_monotonic_force(flat, 4.575600268998791383145996e-7_wp, status, one)
    call check_close('flat: force', one, 2.403040474733021236845971e2_wp, tight)
    call mslip_monotonic_force(flat, 0.0_wp, status, stiffness=two, stick_half_width=three)
    call check_close('flat: stiffness at 0', two, flat%initial_stiffness, tight)
    call check_close('flat: stick half-width at 0', three, flat%half_width, tight)
  end subroutine test_monotonic

  subroutine test_history()
    ! A random history; the expected forces are those of 1,500 sliders.
    real(wp), parameter :: displacement(*) = [1.914742209093313144178863e-6_wp, 2.611273826781315490221623e-6_wp, &
      -6.135044920310610393080018e-7_wp, 5.952452643016515262749271e-7_wp, 3.353829542160012347620313e-6_wp, &
      6.231586436802244498376485e-7_wp, -3.399302160532311508598117e-6_wp, 1.439628185901378384090651e-7_wp]
    real(wp), parameter :: expected(*) = [9.228650897869313018877909e2_wp, 1.238496256519557238194705e3_wp, &
      -3.244442460629692682092653e2_wp, 2.703737152270186349707299e2_wp, 1.467713029999999903099788e3_wp, &
      1.387644856827132352327478e2_wp, -1.467713029999999903099788e3_wp, 2.446969700644779323837263e2_wp]
    real(wp), dimension(mslip_state_length(8_mslip_size)) :: state, next, start, last
    real(wp), dimension(size(displacement)) :: force, stiffness, dissipated, step_force, step_stiffness, step_dissipated
    integer :: i
    integer(mslip_int) :: status

    start = initial_state(8_mslip_size)
    call mslip_masing_path(cylinder, start, displacement, last, status, force, stiffness, dissipated)
    call check_status('path', status, MSLIP_OK)
    do i = 1, size(displacement)
      call check_close('force of a history', force(i), expected(i), tight)
    end do
    call check('a path never gains energy', all(dissipated >= 0.0_wp))

    state = start
    do i = 1, size(displacement)
      call mslip_masing_update(cylinder, state, displacement(i), next, status, step_force(i), step_stiffness(i), &
        step_dissipated(i))
      call check_status('step', status, MSLIP_OK)
      state = next
    end do
    call check_same('steps and path: force', step_force, force)
    call check_same('steps and path: stiffness', step_stiffness, stiffness)
    call check_same('steps and path: energy', step_dissipated, dissipated)
    call check_same('steps and path: state', state, last)

    state = start
    do i = 1, size(displacement)
      call mslip_masing_advance(cylinder, state, displacement(i), status, step_force(i), step_stiffness(i), &
        step_dissipated(i))
      call check_status('step in place', status, MSLIP_OK)
    end do
    call check_same('steps in place: results', [step_force, step_stiffness, step_dissipated], [force, stiffness, dissipated])
    call check_same('steps in place: state', state, last)

    state = start
    call mslip_masing_path_advance(cylinder, state, displacement, status, step_force, step_stiffness, step_dissipated)
    call check_status('path in place', status, MSLIP_OK)
    call check_same('path in place: results', [step_force, step_stiffness, step_dissipated], [force, stiffness, dissipated])
    call check_same('path in place: state', state, last)
  end subroutine test_history

  subroutine test_state()
    real(wp), dimension(mslip_state_length(4_mslip_size)) :: state, before, branched
    real(wp) :: force, stiffness, dissipated, other(3)
    type(mslip_contact) :: contact
    integer(mslip_int) :: status
    integer :: file

    state = initial_state(4_mslip_size)
    call mslip_masing_advance(flat, state, 6.0e-7_wp, status)
    before = state
    call mslip_masing_update(flat, before, 1.0e-7_wp, branched, status, force, stiffness, dissipated)
    state = before
    call mslip_masing_advance(flat, state, 1.0e-7_wp, status, other(1), other(2), other(3))
    call check_same('step and step in place: results', other, [force, stiffness, dissipated])
    call check_same('step and step in place: state', state, branched)
    call mslip_masing_advance(flat, state, 1.0e-7_wp, status, dissipated=dissipated)
    call check_same('a step of zero dissipates nothing', [dissipated], [0.0_wp])

    ! A contact and a state from a restart file continue with the same bits.
    open (newunit=file, status='scratch', form='unformatted')
    write (file) flat, state
    rewind (file)
    read (file) contact, before
    close (file)
    call mslip_contact_check(contact, status)
    call check_status('a contact from a restart file', status, MSLIP_OK)
    call mslip_state_check(before, status)
    call check_status('a state from a restart file', status, MSLIP_OK)
    call mslip_masing_advance(flat, state, 0.5e-7_wp, status, other(1))
    call mslip_masing_advance(contact, before, 0.5e-7_wp, status, other(2))
    call check_same('a step from a restart file', [state, other(1)], [before, other(2)])
    call check('fewer than 2 reversals count as 2', mslip_state_length(0_mslip_size) == mslip_state_length(2_mslip_size))
  end subroutine test_state

  subroutine test_bounded_memory()
    ! Three nested reversals: one more than the shortest state holds.
    real(wp) :: short(mslip_state_length(2_mslip_size)), long(mslip_state_length(3_mslip_size)), error(2)
    integer(mslip_int) :: status
    integer :: i

    short = initial_state(2_mslip_size)
    long = initial_state(3_mslip_size)
    do i = 1, 4
      call mslip_masing_advance(flat, short, 6.0e-7_wp*(-0.9_wp)**i, status)
      call mslip_masing_advance(flat, long, 6.0e-7_wp*(-0.9_wp)**i, status)
    end do
    call mslip_state_error(short, error(1), status)
    call check_status('error of merged reversals', status, MSLIP_OK)
    call mslip_state_error(long, error(2), status)
    call check('merged reversals have an error', error(1) > 0)
    call check_same('without merged reversals no error', error(2:2), [0.0_wp])
  end subroutine test_bounded_memory

  subroutine test_masing_tractions()
    real(wp), parameter :: x(*) = [0.0_wp, 5.041659951103544647435517e-4_wp, -5.084970613574993835923066e-4_wp]
    real(wp) :: state(mslip_state_length(4_mslip_size))
    real(wp), dimension(3) :: pressure, shear, expected_pressure, expected_shear
    real(wp) :: force
    integer(mslip_int) :: status

    state = initial_state(4_mslip_size)
    call mslip_masing_tractions(flat, state, x, status, pressure, shear)
    call check_status('tractions of the initial state', status, MSLIP_OK)
    call check_same('no shear in the initial state', shear, [0.0_wp, 0.0_wp, 0.0_wp])
    call mslip_masing_advance(flat, state, 6.0e-7_wp, status, force)
    call mslip_masing_tractions(flat, state, x, status, shear=shear)
    call mslip_tractions(flat, force, x, status, expected_pressure, expected_shear)
    call check_same('pressure does not depend on the history', pressure, expected_pressure)
    call check_close('shear of initial loading', shear(3), expected_shear(3), 1.0e-10_wp)
  end subroutine test_masing_tractions

  subroutine test_cycles()
    real(wp), parameter :: amplitude(*) = [2.215397059855451631689037e-6_wp, 0.0_wp, 4.0e-6_wp]
    integer, parameter :: points = 64
    real(wp) :: displacement(points), force(points), energy(2), one, two, three, four
    real(wp), dimension(3) :: k_real, k_imag, dk_real, dk_imag
    integer(mslip_int) :: status

    call mslip_hysteresis_loop(flat, 6.0e-7_wp, displacement, force, status)
    call check_status('loop', status, MSLIP_OK)
    call mslip_monotonic_force(flat, 6.0e-7_wp, status, one)
    call check_close('loop: upper tip', force(1), one, tight)
    call check_close('loop: lower tip', force(1 + points/2), -one, tight)
    call check_same('loop: displacement of both tips', displacement([1, 1 + points/2]), [6.0e-7_wp, -6.0e-7_wp])
    call mslip_dissipated_energy(cylinder, [7.338565149999999448482413e2_wp, 0.0_wp], energy, status)
    call check_status('energy', status, MSLIP_OK)
    call check_close('cylinder: energy', energy(1), 3.413670261284926416770211e-5_wp, tight)
    call check_same('no energy without force', energy(2:2), [0.0_wp])
    call mslip_dissipated_energy(flat, 280.0_wp, one, status)
    call check_close('flat: energy', one, 3.739442453289347648327259e-7_wp, tight)
    call mslip_complex_stiffness(cylinder, amplitude, status, k_real, k_imag, dk_real, dk_imag)
    call check_status('complex stiffness', status, MSLIP_OK)
    call check_close('cylinder: K real', k_real(1), 4.793831517097887468202623e8_wp, tight)
    call check_close('cylinder: K imaginary', k_imag(1), 8.258055366786249018238412e6_wp, tight)
    call check_close('cylinder: derivative of K real', dk_real(1), -1.001340633888202033348637e13_wp, 1.0e-9_wp)
    call check_close('cylinder: derivative of K imaginary', dk_imag(1), 6.094501234861984024140468e12_wp, 1.0e-9_wp)
    call check_close('K real at amplitude 0', k_real(2), cylinder%initial_stiffness, tight)
    call check_same('K imaginary at amplitude 0', k_imag(2:2), [0.0_wp])
    call mslip_complex_stiffness(flat, 1.14390006724969779284694e-6_wp, status, one, two, three, four)
    call check_close('flat: K real', one, 3.713375827392842405803951e8_wp, tight)
    call check_close('flat: K imaginary', two, 1.487174776364493773899325e8_wp, tight)
    call check_close('flat: derivative of K real', three, -3.669713057051442291731717e14_wp, tight)
    call check_close('flat: derivative of K imaginary', four, 1.292006122587372052624562e14_wp, tight)
    call mslip_complex_stiffness(flat, 1.14390006724969779284694e-6_wp, status, k_imag=one)
    call check_same('K imaginary alone', [one], [two])
  end subroutine test_cycles

  subroutine test_stiffness_table()
    ! Within the documented 1e-13 of |K| and of |K|/amplitude of the sum of both errors.
    integer, parameter :: points = 12
    real(wp), parameter :: fraction(points) = [0.0_wp, 0.1_wp, 0.3_wp, 0.41_wp, 0.7_wp, 0.99_wp, 1.0_wp - 1.0e-9_wp, 1.0_wp, &
      1.01_wp, 1.5_wp, 2.0_wp, 50.0_wp]
    real(wp), dimension(points) :: amplitude, k_real, k_imag, dk_real, dk_imag, one, two, three, four, size_of_k
    real(wp) :: table(mslip_stiffness_table_length()), rows(2, mslip_stiffness_table_length()), a, b, c, d
    integer(mslip_int) :: status

    call mslip_stiffness_table_init(flat, table, status)
    call check_status('table', status, MSLIP_OK)
    amplitude = fraction*flat%slip_displacement
    call mslip_complex_stiffness_tabulated(flat, table, amplitude, status, one, two, three, four)
    call check_status('stiffness from a table', status, MSLIP_OK)
    call mslip_complex_stiffness(flat, amplitude, status, k_real, k_imag, dk_real, dk_imag)
    size_of_k = hypot(k_real, k_imag)
    call check('K from a table', all(abs(one - k_real) <= 2.0e-13_wp*size_of_k .and. abs(two - k_imag) <= 2.0e-13_wp*size_of_k))
    ! The quadrature for dK' has an error of up to 2e-12 just beyond gross slip.
    call check('derivatives of K from a table', all(abs(three - dk_real)*amplitude <= 2.0e-12_wp*size_of_k &
      .and. abs(four - dk_imag)*amplitude <= 2.0e-13_wp*size_of_k))
    call mslip_complex_stiffness_tabulated(flat, table, amplitude(5), status, a, b, c, d)
    call check_status('stiffness of one amplitude from a table', status, MSLIP_OK)
    call check_same('stiffness of one amplitude from a table', [a, b, c, d], [one(5), two(5), three(5), four(5)])
    k_imag = untouched
    call mslip_complex_stiffness_tabulated(flat, table, amplitude(1::2), status, k_imag=k_imag(1::2))
    call check_same('strides: stiffness from a table', k_imag(1::2), two(1::2))
    call check_same('strides: gaps of the stiffness are not written', k_imag(2::2), spread(untouched, 1, points/2))
    rows = 0
    call mslip_stiffness_table_init(flat, rows(2, :), status)
    call mslip_complex_stiffness_tabulated(flat, rows(2, :), amplitude(5), status, a)
    call check_status('strides: table', status, MSLIP_OK)
    call check_same('strides: table', [a], [one(5)])
    call check_same('strides: gaps of the table are not written', rows(1, :), spread(0.0_wp, 1, size(rows, 2)))

    call mslip_stiffness_table_init(open_contact, table, status)
    call check_status('table of an open contact', status, MSLIP_OK)
    call mslip_complex_stiffness_tabulated(open_contact, table, amplitude, status, one, two, three, four)
    call check_status('stiffness of an open contact from a table', status, MSLIP_OK)
    call check_same('stiffness of an open contact from a table', [one, two, three, four], spread(0.0_wp, 1, 4*points))
  end subroutine test_stiffness_table

  subroutine test_harmonic_force()
    integer(mslip_size), parameter :: harmonics = 3, samples = 128
    real(wp), parameter :: displacement(*) = [-6.667142217335999407015783e-8_wp, 1.06764006276638462077436e-6_wp, 0.0_wp, &
      -3.276903017350883034497792e-7_wp, 1.945554323004438200443256e-7_wp, 3.004528388385735681161094e-7_wp, &
      -6.385483210854492738741284e-8_wp]
    real(wp), parameter :: expected(*) = [1.242778811039784882321255e2_wp, 3.127197957636783986432537e2_wp, &
      -2.337981528009959481468708e2_wp, -9.353392540431687732443905e1_wp, 1.214800760707371553515095e2_wp, &
      6.722106958983998626542111e1_wp, -4.333697401361703158366392e1_wp]
    real(wp) :: workspace(mslip_harmonic_workspace_length(harmonics, samples)), force(7), again(7), jacobian(7, 7)
    real(wp) :: dissipated
    real(wp), parameter :: cosine(*) = [0.0_wp, 6.0e-7_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp]
    real(wp) :: by_parameter(7, MSLIP_PARAMETER_COUNT), by_row(MSLIP_PARAMETER_COUNT, 2), curve(2), normal_force
    integer(mslip_int) :: status
    integer :: i

    call mslip_harmonic_workspace_init(harmonics, samples, workspace, status)
    call check_status('workspace', status, MSLIP_OK)
    call mslip_harmonic_force(flat, workspace, displacement, status, force, jacobian, dissipated)
    call check_status('harmonic force', status, MSLIP_OK)
    do i = 1, 7
      call check_close('coefficient of the force', force(i), expected(i), 1.0e-11_wp)
    end do

    ! Under one cosine the first harmonic is the complex stiffness, as far as the sampling allows.
    call mslip_harmonic_force(flat, workspace, cosine, status, force, dissipated=dissipated)
    call mslip_complex_stiffness(flat, 6.0e-7_wp, status, again(1), again(2))
    call check_close('first cosine', force(2), again(1)*6.0e-7_wp, 1.0e-3_wp)
    call check_close('first sine', -force(3), again(2)*6.0e-7_wp, 5.0e-3_wp)
    call check_close('energy of a cycle', dissipated, pi*again(2)*6.0e-7_wp**2, tight)

    ! All forces in proportion: N dT/dN + E* dT/dE* = T. Beyond gross slip T = mu N.
    call mslip_harmonic_sensitivity(flat, workspace, displacement, status, again, by_parameter)
    call check_status('harmonic sensitivity', status, MSLIP_OK)
    call mslip_monotonic_sensitivity(flat, [2.0e-7_wp, 1.0e-3_wp], status, curve, by_row)
    call check_status('monotonic sensitivity', status, MSLIP_OK)
    normal_force = by_row(MSLIP_BY_FRICTION_COEFFICIENT, 2)
    call check_close('slip force', normal_force*by_row(MSLIP_BY_NORMAL_FORCE, 2), flat%slip_force, tight)
    call check_close('force in proportion', normal_force*by_row(MSLIP_BY_NORMAL_FORCE, 1) + &
      flat%composite_modulus*by_row(MSLIP_BY_COMPOSITE_MODULUS, 1), curve(1), tight)
    do i = 1, 7
      call check_close('coefficient in proportion', normal_force*by_parameter(i, MSLIP_BY_NORMAL_FORCE) + &
        flat%composite_modulus*by_parameter(i, MSLIP_BY_COMPOSITE_MODULUS), again(i), tight)
    end do
    call check('no even harmonics', maxval(abs([force(1), force(4), force(5)])) <= tight*flat%slip_force)
  end subroutine test_harmonic_force

  subroutine test_event_driven()
    integer(mslip_size), parameter :: harmonics = 3, samples = 64
    integer(mslip_int), parameter :: rule = MSLIP_EVENT_DRIVEN
    real(wp), parameter :: amplitude = 6.0e-7_wp, cosine(*) = [0.0_wp, amplitude, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp]
    real(wp) :: workspace(mslip_harmonic_workspace_length(harmonics, samples, rule)), force(7), jacobian(7, 7)
    real(wp) :: dissipated, k_real, k_imag
    integer(mslip_size) :: found(2)
    integer(mslip_int) :: status, found_rule

    call mslip_harmonic_workspace_init(harmonics, samples, workspace, status, rule)
    call check_status('event-driven workspace', status, MSLIP_OK)
    call mslip_harmonic_force(flat, workspace, cosine, status, force, jacobian, dissipated)
    call check_status('event-driven harmonic force', status, MSLIP_OK)
    ! Under one cosine the first harmonic is the complex stiffness, to rounding.
    call mslip_complex_stiffness(flat, amplitude, status, k_real, k_imag)
    call check_close('event-driven: first cosine', force(2), k_real*amplitude, tight)
    call check_close('event-driven: first sine', -force(3), k_imag*amplitude, tight)
    call check_close('event-driven: energy of a cycle', dissipated, pi*k_imag*amplitude**2, tight)
    call check('event-driven: no even harmonics', maxval(abs([force(1), force(4), force(5)])) <= tight*flat%slip_force)
    ! A change of phase rotates the force.
    call check_close('event-driven: change of phase, real', jacobian(3, 3), k_real, tight)
    call check_close('event-driven: change of phase, imaginary', jacobian(2, 3), k_imag, tight)

    call mslip_harmonic_workspace_size(workspace, found(1), found(2), found_rule, status)
    call check('size of an event-driven workspace', all(found == [harmonics, samples]) .and. found_rule == rule)
    call mslip_harmonic_workspace_init(1_mslip_size, 8_mslip_size, workspace, status)
    call mslip_harmonic_workspace_size(workspace, found(1), found(2), found_rule, status)
    call check('the default is uniform sampling', all(found == [1, 8]) .and. found_rule == MSLIP_UNIFORM_SAMPLING)
  end subroutine test_event_driven

  subroutine test_batch()
    ! A batch of three contacts gives, bit for bit, the results of each alone; the second is skipped if there are flags.
    integer(mslip_size), parameter :: harmonics = 1, samples = 64
    integer(mslip_int), parameter :: active(*) = [1_mslip_int, 0_mslip_int, 1_mslip_int]
    real(wp), parameter :: amplitude(*) = [6.0e-7_wp, 2.0e-6_wp, 9.0e-7_wp]
    real(wp), parameter :: coefficients(*, *) = reshape([1.0e-8_wp, 6.0e-7_wp, 0.0_wp, 0.0_wp, 2.0e-6_wp, 1.0e-7_wp, &
      0.0_wp, 9.0e-7_wp, 0.0_wp], [3, 3])
    type(mslip_contact) :: contacts(3)
    real(wp), dimension(3) :: a, b, c, d, one, energy
    real(wp), dimension(3, 3) :: force, flagged
    real(wp) :: jacobian(3, 3, 3), single(3, 3)
    real(wp), dimension(mslip_state_length(4_mslip_size), 3) :: states, start, updated
    real(wp) :: alone(mslip_state_length(4_mslip_size)), workspace(mslip_harmonic_workspace_length(harmonics, samples))
    integer(mslip_int) :: status
    integer :: i

    contacts = [flat, cylinder, flat]
    call mslip_batch_complex_stiffness(contacts, amplitude, status, k_real=a, k_imag=b, dk_real=c, dk_imag=d)
    call check_status('batch: complex stiffness', status, MSLIP_OK)
    do i = 1, 3
      call mslip_complex_stiffness(contacts(i), amplitude(i), status, one(1), one(2), one(3), alone(1))
      call check_same('batch: complex stiffness of each', [a(i), b(i), c(i), d(i)], [one, alone(1)])
    end do
    one = untouched
    call mslip_batch_complex_stiffness(contacts, amplitude, status, active=active, k_real=one)
    call check_same('batch: complex stiffness, one skipped', one, [a(1), untouched, a(3)])

    do i = 1, 3
      start(:, i) = initial_state(4_mslip_size)
    end do
    states = start
    updated = start
    call mslip_batch_masing_update(contacts, states, amplitude, updated, status, force=a, stiffness=b, dissipated=c)
    call check_status('batch: step', status, MSLIP_OK)
    call check_same('batch: the states before the step are kept', [states], [start])
    do i = 1, 3
      alone = start(:, i)
      call mslip_masing_advance(contacts(i), alone, amplitude(i), status, one(1), one(2), one(3))
      call check_same('batch: step of each', [a(i), b(i), c(i)], one)
      call check_same('batch: state of each', updated(:, i), alone)
    end do
    call mslip_batch_masing_advance(contacts, states, amplitude, status)
    call check_status('batch: step in place, nothing requested', status, MSLIP_OK)
    call check_same('batch: step in place', [states], [updated])
    states = start
    call mslip_batch_masing_advance(contacts, states, amplitude, status, force=one, stiffness=d, dissipated=energy)
    call check_same('batch: step in place: results', [one, d, energy], [a, b, c])
    states = start
    d = untouched
    call mslip_batch_masing_advance(contacts, states, amplitude, status, active=active, force=d)
    call check_same('batch: step in place, one skipped', d, [a(1), untouched, a(3)])
    call check_same('batch: step in place, states', [states], [updated(:, 1), start(:, 2), updated(:, 3)])
    states = start
    states(:, 2) = untouched
    call mslip_batch_masing_update(contacts, start, amplitude, states, status, active=active)
    call check_same('batch: step, one skipped', [states], &
      [updated(:, 1), spread(untouched, 1, size(updated, 1)), updated(:, 3)])

    call mslip_harmonic_workspace_init(harmonics, samples, workspace, status)
    call mslip_batch_harmonic_force(contacts, workspace, coefficients, status, force=force, jacobian=jacobian, dissipated=a)
    call check_status('batch: harmonic force', status, MSLIP_OK)
    do i = 1, 3
      call mslip_harmonic_force(contacts(i), workspace, coefficients(:, i), status, one, single, b(i))
      call check_same('batch: harmonic force of each', [one, single], [force(:, i), jacobian(:, :, i)])
    end do
    call check_same('batch: energy of each', a, b)
    flagged = untouched
    call mslip_batch_harmonic_force(contacts, workspace, coefficients, status, active=active, force=flagged)
    call check_same('batch: harmonic force, one skipped', [flagged], [force(:, 1), spread(untouched, 1, 3), force(:, 3)])
  end subroutine test_batch

  subroutine test_index()
    ! Five items share two contacts, or more contacts than are used; indices count from 1.
    integer(mslip_size), parameter :: harmonics = 1, samples = 64
    integer, parameter :: items = 5
    integer(mslip_int), parameter :: index(items) = [2_mslip_int, 1_mslip_int, 1_mslip_int, 2_mslip_int, 1_mslip_int]
    real(wp), parameter :: amplitude(items) = [6.0e-7_wp, 2.0e-6_wp, 9.0e-7_wp, 3.0e-7_wp, 1.0e-7_wp]
    type(mslip_contact) :: contacts(2), each(items)
    real(wp), dimension(items) :: a, b
    real(wp), dimension(mslip_state_length(2_mslip_size), items) :: start, states, expected
    real(wp), dimension(3, items) :: coefficients, force, expected_force
    real(wp) :: workspace(mslip_harmonic_workspace_length(harmonics, samples))
    integer(mslip_int) :: status, active(items)

    contacts = [flat, cylinder]
    each = contacts(index)
    start = spread(initial_state(2_mslip_size), 2, items)
    coefficients = 0
    coefficients(2, :) = amplitude
    call mslip_harmonic_workspace_init(harmonics, samples, workspace, status)

    call mslip_batch_complex_stiffness(contacts, amplitude, status, index, k_real=a)
    call check_status('index: complex stiffness', status, MSLIP_OK)
    call mslip_batch_complex_stiffness(each, amplitude, status, k_real=b)
    call check_same('index: complex stiffness', a, b)
    expected = start
    states = start
    call mslip_batch_masing_update(each, start, amplitude, expected, status, force=b)
    call mslip_batch_masing_update(contacts, start, amplitude, states, status, index, force=a)
    call check_status('index: step', status, MSLIP_OK)
    call check_same('index: step', [a, [states]], [b, [expected]])
    states = start
    call mslip_batch_masing_advance(contacts, states, amplitude, status, index, force=a)
    call check_status('index: step in place', status, MSLIP_OK)
    call check_same('index: step in place', [a, [states]], [b, [expected]])
    call mslip_batch_harmonic_force(each, workspace, coefficients, status, force=expected_force)
    call mslip_batch_harmonic_force(contacts, workspace, coefficients, status, index, force=force)
    call check_status('index: harmonic force', status, MSLIP_OK)
    call check_same('index: harmonic force', [force], [expected_force])
    call mslip_batch_complex_stiffness(each, amplitude(1:2), status, [5_mslip_int, 1_mslip_int], k_real=a(1:2))
    call mslip_complex_stiffness(each(5), amplitude(1), status, a(3))
    call check_same('index: more contacts than items', a(1:1), a(3:3))

    a = untouched
    active = 1
    active(4) = 0
    call mslip_batch_complex_stiffness(contacts, amplitude, status, index, active, a)
    call check_status('index and flags', status, MSLIP_OK)
    call mslip_batch_complex_stiffness(each, amplitude, status, k_real=b)
    call check_same('index and flags', a, [b(1:3), untouched, b(5)])
  end subroutine test_index

  subroutine test_equivalents()
    integer, parameter :: sliders = 40, points = 4000
    real(wp) :: stiffness(sliders), slip_force(sliders), k, s, error, largest, force, displacement
    integer(mslip_int) :: status
    integer :: i

    call mslip_jenkins_equivalent(flat, 0.0_wp, k, s, status)
    call check_status('Jenkins element', status, MSLIP_OK)
    call check_close('Jenkins element at amplitude 0: stiffness', k, flat%initial_stiffness, tight)
    call check_close('Jenkins element at amplitude 0: slip force', s, flat%slip_force, tight)
    call mslip_jenkins_equivalent(open_contact, 1.0e-6_wp, k, s, status)
    call check_status('Jenkins element of an open contact', status, MSLIP_OK)
    call check_same('Jenkins element of an open contact: no force, no stiffness', [k, s], [0.0_wp, 0.0_wp])

    call mslip_iwan_equivalent(cylinder, stiffness, slip_force, status, error)
    call check_status('Iwan model', status, MSLIP_OK)
    call check_close('Iwan model: slip forces add up', sum(slip_force), cylinder%slip_force, tight)
    largest = 0
    do i = 0, points
      displacement = 1.2_wp*cylinder%slip_displacement*real(i, wp)/points
      call mslip_monotonic_force(cylinder, displacement, status, force)
      largest = max(largest, abs(sum(min(stiffness*displacement, slip_force)) - force)/cylinder%slip_force)
    end do
    call check('Iwan model: the error is a bound', largest <= error*(1.0_wp + 1.0e-6_wp))
    call check('Iwan model: the bound is reached', largest >= 0.9_wp*error)
    call mslip_iwan_equivalent(cylinder, stiffness(1:10), slip_force(1:10), status)
    call check_status('Iwan model without its error', status, MSLIP_OK)
    call mslip_iwan_equivalent(cylinder, stiffness(1:10), slip_force(1:10), status, largest)
    call check('Iwan model: fewer sliders, larger error', largest > error)
    call mslip_iwan_equivalent(open_contact, stiffness(1:3), slip_force(1:3), status, error)
    call check_same('Iwan model of an open contact', [stiffness(1:3), slip_force(1:3), error], spread(0.0_wp, 1, 7))
  end subroutine test_equivalents

  subroutine test_elliptic()
    type(mslip_elliptic_parameters) :: p
    type(mslip_contact) :: sphere
    real(wp) :: displacement, energy, pressure(2), shear(2), peak
    integer(mslip_int) :: status

    call mslip_contact_init_elliptic(p, sphere, status)
    call check_status('elliptic parameters never set', status, MSLIP_BAD_SEMI_AXIS_X)
    call mslip_elliptic_parameters_default(p)
    p%semi_axis_x = 1.186981199180470441384427e-5_wp
    call mslip_contact_init_elliptic(p, sphere, status)
    call check_status('second axis not set', status, MSLIP_BAD_SEMI_AXIS_Y)
    p%semi_axis_y = p%semi_axis_x
    p%normal_force = 3.03773141743209933451908e1_wp
    p%friction_coefficient = 8.572754015446252262577786e-1_wp
    p%material = [mslip_material(1.0e9_wp, 0.45_wp), mslip_material(1.0e9_wp, 0.45_wp)]
    call mslip_contact_init_elliptic(p, sphere, status)
    call check_status('sphere', status, MSLIP_OK)
    call mslip_contact_check(sphere, status)
    call check_status('check of a sphere', status, MSLIP_OK)
    call check_close('sphere: initial stiffness', sphere%initial_stiffness, 1.056268030416436432300851e4_wp, tight)
    call check_same('sphere: half-width', [sphere%half_width], [p%semi_axis_x])
    call mslip_monotonic_displacement(sphere, 1.302086210331913207483012e1_wp, status, displacement)
    call check_close('sphere: displacement', displacement, 1.368468846551502869721604e-3_wp, tight)
    call mslip_dissipated_energy(sphere, 1.302086210331913207483012e1_wp, energy, status)
    call check_close('sphere: energy', energy, 2.713315709751587538399524e-3_wp, tight)
    call mslip_tractions(sphere, sphere%slip_force/2.0_wp, [0.0_wp, 2.0e-5_wp], status, pressure, shear)
    peak = 1.5_wp*p%normal_force/(pi*p%semi_axis_x**2)
    call check_close('sphere: peak pressure', pressure(1), peak, tight)
    call check_close('sphere: shear at the centre', shear(1), p%friction_coefficient*peak* &
      (1.0_wp - 0.5_wp**(1.0_wp/3.0_wp)), tight)
    call check_same('sphere: no tractions outside', [pressure(2), shear(2)], [0.0_wp, 0.0_wp])
  end subroutine test_elliptic

  subroutine test_strides()
    ! Sections that are not contiguous, as arguments of every kind, and arrays without elements.
    real(wp) :: x(6), shear(6), dense(3), table(2, mslip_state_length(2_mslip_size)), state(mslip_state_length(2_mslip_size))
    real(wp) :: force, expected
    type(mslip_contact) :: contacts(4)
    integer(mslip_int) :: status, index(6), active(6)

    x = [0.0_wp, untouched, 2.0e-4_wp, untouched, 5.05e-4_wp, untouched]
    shear = untouched
    call mslip_tractions(flat, 100.0_wp, x(1::2), status, shear=shear(1::2))
    call check_status('strides: tractions', status, MSLIP_OK)
    call mslip_tractions(flat, 100.0_wp, [0.0_wp, 2.0e-4_wp, 5.05e-4_wp], status, shear=dense)
    call check_same('strides: tractions of each', shear(1::2), dense)
    call check_same('strides: gaps are not written', shear(2::2), spread(untouched, 1, 3))
    associate (places => x(1::2))  ! gfortran loses the stride of an associate name if the dummy argument is contiguous
      call mslip_tractions(flat, 100.0_wp, places, status, shear=x(2::2))
    end associate
    call check_same('strides: associate name', x(2::2), dense)

    state = initial_state(2_mslip_size)
    table(1, :) = state
    table(2, :) = state
    call mslip_masing_advance(flat, table(1, :), 3.0e-7_wp, status, force)
    call mslip_masing_advance(flat, state, 3.0e-7_wp, status, expected)
    call check_same('strides: state', [table(1, :), force], [state, expected])
    call mslip_masing_update(flat, table(1, :), 2.0e-7_wp, table(2, :), status, force)
    call mslip_masing_advance(flat, state, 2.0e-7_wp, status, expected)
    call check_same('strides: new state', [table(2, :), force], [state, expected])
    associate (row => table(2, :))
      call mslip_state_check(row, status)
      call check_status('strides: state that is only read', status, MSLIP_OK)
    end associate

    contacts = [flat, open_contact, cylinder, open_contact]
    active = [1_mslip_int, 0_mslip_int, 0_mslip_int, 0_mslip_int, 1_mslip_int, 0_mslip_int]
    dense = untouched
    call mslip_batch_complex_stiffness(contacts(1::2), [0.0_wp, 0.0_wp], status, active=active(1:4:2), k_real=dense(1:2))
    call check_status('strides: contacts', status, MSLIP_OK)
    call check_same('strides: contacts and flags', dense, [flat%initial_stiffness, untouched, untouched])
    index = [3_mslip_int, 0_mslip_int, 1_mslip_int, 0_mslip_int, 3_mslip_int, 0_mslip_int]
    call mslip_batch_complex_stiffness(contacts, spread(0.0_wp, 1, 3), status, index(1::2), k_real=dense)
    call check_same('strides: index', dense, &
      [cylinder%initial_stiffness, flat%initial_stiffness, cylinder%initial_stiffness])

    call mslip_monotonic_force(flat, x(1:0), status, shear(1:0))
    call check_status('no points', status, MSLIP_OK)
    call mslip_batch_complex_stiffness(contacts(1:0), x(1:0), status, index(1:0), active(1:0), shear(1:0))
    call check_status('no contacts', status, MSLIP_OK)
    call mslip_batch_masing_advance(contacts(1:0), table(:, 1:0), x(1:0), status)
    call check_status('no states', status, MSLIP_OK)
  end subroutine test_strides

  function element_of(normal_input) result(element)
    ! The geometry and materials of a history of the reference table.
    integer(mslip_int), intent(in) :: normal_input
    type(mslip_element) :: element

    type(mslip_parameters) :: p
    integer(mslip_int) :: status

    p = mslip_parameters(flat_half_width=1.75081e-4_wp, edge_radius=8.63e-3_wp, length=1.23e-3_wp, normal_force=17.0_wp, &
      friction_coefficient=0.35_wp, material=spread(mslip_material(6.2e11_wp, 0.22_wp), 1, 2), &
      displacement_reference=MSLIP_CENTRE_POINT)
    call mslip_element_init(p, 1_mslip_int, normal_input, element, status)
    call check_status('initialise an element', status, MSLIP_OK)
  end function element_of

  function element_state(pieces) result(state)
    integer(mslip_size), intent(in) :: pieces
    real(wp) :: state(mslip_element_state_length(1_mslip_int, pieces))

    integer(mslip_int) :: status

    call mslip_element_state_init(1_mslip_int, state, status)
    call check_status('initialise the state of an element', status, MSLIP_OK)
  end function element_state

  subroutine test_element()
    ! Rows of the reference table: rising and falling loads, slip in both directions, gross slip.
    integer, parameter :: steps = 6
    real(wp), parameter :: displacement(2, steps) = reshape([ &
      2.5047919856428545e-8_wp, 3.943122714139546e-8_wp, 1.1722536786874625e-8_wp, 5.4339586390886424e-8_wp, &
      1.7079577218179037e-8_wp, 3.593852562408462e-8_wp, -2.3732980213700233e-10_wp, 5.754622795830807e-8_wp, &
      -1.795778517140069e-8_wp, 1.9485592645523398e-8_wp, 1.6062677298597924e-9_wp, 6.064170373418358e-8_wp], [2, steps])
    real(wp), parameter :: force(2, steps) = reshape([ &
      3.314151429997902627204149_wp, 9.469004085708293821309359_wp, 0.4107581168609077725519811_wp, 13.07442920778120653977642_wp, &
      1.580569807443908937563438_wp, 8.626046604468900418559391_wp, -2.187056528062207239562684_wp, 13.85138983478861544399583_wp, &
      -1.632725642307153993068073_wp, 4.664930406591868847572388_wp, 2.625664475971551520214349_wp, &
      14.6018862471478065027045_wp], [2, steps])
    real(wp), parameter :: tangent(3, steps) = reshape([ &
      0.0_wp, 84505839.81871214203114223_wp, 241445256.6248918496922968_wp, &
      217416195.9873673571446466_wp, -421256.4434870667255680024_wp, 242218902.8986542490946348_wp, &
      217301373.9878601149513024_wp, -159794.3659726366703727244_wp, 241250259.1740997628163813_wp, &
      216664700.6164961777598001_wp, -762222.9469269016266874917_wp, 242375203.1114422999890495_wp, &
      0.0_wp, -84078118.44527620451852819_wp, 240223195.5579320281501561_wp, &
      216600009.2455030531718391_wp, 834114.0392402721081600488_wp, 242523259.2990325285858671_wp], [3, steps])
    real(wp), parameter :: dissipated(steps) = [1.614628639645999951714049e-8_wp, 1.341500451784501531208109e-11_wp, &
      4.784880355286872540729054e-12_wp, 6.237209838520305805897411e-11_wp, 5.326530241686197046080525e-8_wp, &
      2.526574107512012322715549e-11_wp]
    type(mslip_element) :: element
    real(wp), dimension(mslip_element_state_length(1_mslip_int, 16_mslip_size)) :: old, new
    real(wp) :: found(2), slopes(2, 2), energy
    integer(mslip_int) :: status
    integer :: i

    element = element_of(MSLIP_INPUT_APPROACH)
    call mslip_element_check(element, status)
    call check_status('check of an element', status, MSLIP_OK)
    call check('size of an element: no padding', storage_size(element) == 64*(8 + size(element%reserved)))
    call check('kind of an element', element%directions == 1 .and. element%normal_input == MSLIP_INPUT_APPROACH)
    call check_close('element: friction coefficient', element%friction_coefficient, 0.35_wp, tight)
    call check_close('element: normal force', element%normal_force, 17.0_wp, tight)
    old = element_state(16_mslip_size)
    do i = 1, steps
      call mslip_element_update(element, old, displacement(:, i), new, status, found, slopes, energy)
      call check_status('element: step', status, MSLIP_OK)
      call check_close('element: tangential force', found(1), force(1, i), tight)
      call check_close('element: normal force of a step', found(2), force(2, i), tight)
      call check_close('element: energy', energy, dissipated(i), 1.0e-10_wp)
      call check('element: dT/du', abs(slopes(1, 1) - tangent(1, i)) <= 1.0e-11_wp*element%tangential_stiffness)
      call check('element: dT/dw', abs(slopes(1, 2) - tangent(2, i)) <= 1.0e-11_wp*element%normal_stiffness)
      call check_close('element: dN/dw', slopes(2, 2), tangent(3, i), 1.0e-11_wp)
      call check_same('element: dN/du', slopes(2:2, 1), [0.0_wp])
      call mslip_element_state_check(1_mslip_int, new, status)
      call check_status('element: check of a state', status, MSLIP_OK)
      old = new
    end do
    call mslip_element_state_error(1_mslip_int, new, energy, status)
    call check_same('element: nothing was merged', [energy], [0.0_wp])
  end subroutine test_element

  subroutine test_element_law()
    ! The normal law of a row of the reference table, both ways, and its end.
    type(mslip_element) :: element
    real(wp) :: found(3), values(2), slopes(2), widths(2), back(2)
    integer(mslip_int) :: status
    integer(mslip_int), parameter :: inputs(2) = [MSLIP_INPUT_APPROACH, MSLIP_INPUT_NORMAL_FORCE]
    integer :: i

    do i = 1, 2
      element = element_of(inputs(i))
      call mslip_normal_force(element, 5.4339586390886424e-8_wp, status, found(1), found(2), found(3))
      call check_status('normal force', status, MSLIP_OK)
      call check_close('normal force', found(1), 13.07442920778120653977642_wp, tight)
      call check_close('normal stiffness', found(2), 242218902.8986542490946348_wp, tight)
      call mslip_normal_approach(element, found(1), status, values(1), slopes(1), widths(1))
      call check_close('approach', values(1), 5.4339586390886424e-8_wp, tight)
      call check_close('normal compliance', slopes(1)*found(2), 1.0_wp, tight)
      call check_close('half-width', widths(1), found(3), tight)
      call mslip_normal_force(element, [element%approach, -1.0e-6_wp], status, values, slopes, widths)
      call check_status('normal forces', status, MSLIP_OK)
      call check_close('normal force of the parameters', values(1), element%normal_force, tight)
      call check_close('half-width of the parameters', widths(1), element%half_width, tight)
      call check_same('open', [values(2), slopes(2), widths(2)], spread(0.0_wp, 1, 3))
      call mslip_normal_approach(element, values, status, back, slopes, widths)
      call check_status('approaches', status, MSLIP_OK)
      call check_close('approach of the parameters', back(1), element%approach, tight)
      call check_same('approach without a force', [back(2), widths(2)], [0.0_wp, 0.0_wp])
      call mslip_normal_approach(element, values, status, compliance=slopes)
      call check_close('normal stiffness of the parameters', slopes(1)*element%normal_stiffness, 1.0_wp, tight)
    end do
  end subroutine test_element_law

  subroutine test_element_steps()
    ! In place, as a path and with sections: the same bits. Tractions carry the forces. An elliptical element.
    integer, parameter :: steps = 14, points = 2000              ! the contact is closed in the end
    type(mslip_element) :: element, sphere
    type(mslip_elliptic_parameters) :: p
    real(wp) :: displacement(2, steps), force(2, steps), tangent(2, 2, steps), dissipated(steps)
    real(wp) :: path_force(2, steps), path_tangent(2, 2, steps), path_dissipated(steps), scattered(3, 2, steps)
    real(wp), dimension(mslip_element_state_length(1_mslip_int, 16_mslip_size)) :: state, start, last
    real(wp) :: shortest(mslip_element_state_length(1_mslip_int, 0_mslip_size)), error, angle
    real(wp) :: half_width
    real(wp), dimension(points) :: x, weight, pressure, shear
    integer(mslip_int) :: status
    integer :: i

    element = element_of(MSLIP_INPUT_NORMAL_FORCE)
    displacement(1, :) = [(1.0e-8_wp*sin(1.7_wp*i), i = 1, steps)]
    displacement(2, :) = [(max(9.0_wp + 10.0_wp*sin(0.9_wp*i), 0.0_wp), i = 1, steps)]
    start = element_state(16_mslip_size)
    state = start
    do i = 1, steps
      call mslip_element_advance(element, state, displacement(:, i), status, force(:, i), tangent(:, :, i), dissipated(i))
      call check_status('element: step in place', status, MSLIP_OK)
    end do
    call check_same('element: the given normal force', force(2, :), displacement(2, :))
    call mslip_element_path(element, start, displacement, last, status, path_force, path_tangent, path_dissipated)
    call check_status('element: path', status, MSLIP_OK)
    call check_same('element: path', [path_force, path_tangent, path_dissipated], [force, tangent, dissipated])
    call check_same('element: the state before a path is kept', start, element_state(16_mslip_size))
    last = start
    scattered = untouched
    scattered(2, :, :) = displacement
    call mslip_element_path_advance(element, last, scattered(2, :, :), status, force=scattered(1, :, :))
    call check_status('element: path in place, sections', status, MSLIP_OK)
    call check_same('element: path in place, sections', [scattered(1, :, :)], [force])
    call check_same('element: gaps are not written', [scattered(3, :, :)], spread(untouched, 1, 2*steps))
    call check_same('element: state after a path', last(:12), state(:12))
    call mslip_element_path(element, start, displacement(:, 1:0), last, status)
    call check_status('element: path without steps', status, MSLIP_OK)

    call mslip_normal_approach(element, force(2, steps), status, half_width=half_width)
    do i = 1, points
      angle = pi*(real(i, wp) - 0.5_wp)/points
      x(i) = half_width*cos(angle)
      weight(i) = 1.23e-3_wp*half_width*pi/points*sin(angle)
    end do
    call mslip_element_tractions(element, state, x, status, pressure, shear)
    call check_status('element: tractions', status, MSLIP_OK)
    call check_close('element: pressure carries the normal force', sum(weight*pressure), force(2, steps), 1.0e-5_wp)
    call check('element: shear carries the tangential force', abs(sum(weight*shear) - force(1, steps)) <= 1.0e-5_wp*force(2, steps))
    call mslip_element_tractions(element, state, [2.0_wp*element%half_width], status, shear=shear(1:1))
    call check_same('element: no tractions outside', shear(1:1), [0.0_wp])

    call mslip_element_state_init(1_mslip_int, shortest, status)
    do i = 1, 10
      call mslip_element_advance(element, shortest, [1.0e-10_wp*(-1)**i, 1.0_wp + i], status)
    end do
    call mslip_element_state_error(1_mslip_int, shortest, error, status)
    call check('element: a bound on the error of merged pieces', error > 0 .and. error < 0.35_wp*17)

    p = mslip_elliptic_parameters(1.0e-4_wp, 1.0e-4_wp, 50.0_wp, 0.5_wp, spread(mslip_material(2.0e11_wp, 0.3_wp), 1, 2))
    call mslip_element_init_elliptic(p, 1_mslip_int, MSLIP_INPUT_APPROACH, sphere, status)
    call check_status('element of a sphere', status, MSLIP_OK)
    ! Hertz: N = 4/3 E* a^3/R, w = a^2/R.
    call check_close('sphere: approach', sphere%approach, 0.75_wp*50.0_wp/(sphere%composite_modulus*1.0e-4_wp), tight)
    ! Mindlin: K_t/K_n = 2 (1 - nu)/(2 - nu).
    call check_close('sphere: tangential stiffness', sphere%tangential_stiffness/sphere%normal_stiffness, 1.4_wp/1.7_wp, tight)
  end subroutine test_element_steps

  subroutine test_element_harmonic_force()
    ! At constant load that of a contact. The Jacobian is the derivative of the force, also with separation.
    integer, parameter :: h = 2, m = 2*h + 1
    integer(mslip_size), parameter :: harmonics = h, samples = 64
    type(mslip_parameters) :: p
    type(mslip_contact) :: contact
    type(mslip_element) :: element
    real(wp) :: workspace(mslip_element_workspace_length(1_mslip_int, harmonics, samples)), energy(2), step
    real(wp) :: of_contact(mslip_harmonic_workspace_length(harmonics, samples)), expected(m), square(m, m)
    real(wp), dimension(2*m) :: displacement, force, other, changed
    real(wp) :: jacobian(2*m, 2*m)
    integer(mslip_size) :: found(3)
    integer(mslip_int) :: status, kinds(2)
    integer :: j

    call mslip_element_workspace_init(1_mslip_int, harmonics, samples, 0_mslip_size, workspace, status)
    call check_status('element: workspace', status, MSLIP_OK)
    call mslip_element_workspace_size(workspace, kinds(1), found(1), found(2), kinds(2), found(3), status)
    call check('element: size of a workspace', all(found == [harmonics, samples, 1_mslip_size]) .and. &
      all(kinds == [1_mslip_int, MSLIP_UNIFORM_SAMPLING]))
    call mslip_harmonic_workspace_init(harmonics, samples, of_contact, status)
    p = flat_parameters()
    call mslip_contact_init(p, contact, status)
    call mslip_element_init(p, 1_mslip_int, MSLIP_INPUT_NORMAL_FORCE, element, status)
    displacement = 0
    displacement(1:m) = [0.0_wp, 3.0e-7_wp, 1.0e-7_wp, 0.0_wp, 2.0e-8_wp]
    displacement(m + 1) = 800
    call mslip_element_harmonic_force(element, workspace, displacement, status, force, jacobian, energy(1))
    call check_status('element: harmonic force', status, MSLIP_OK)
    call mslip_harmonic_force(contact, of_contact, displacement(1:m), status, expected, square, energy(2))
    call check('element: harmonic force at constant load', all(abs(force(1:m) - expected) <= 1.0e-11_wp*contact%slip_force))
    call check('element: constant normal force', all(abs(force(m + 1:) - displacement(m + 1:)) <= 1.0e-12_wp*800))
    call check_close('element: energy at constant load', energy(1), energy(2), 1.0e-9_wp)
    call check('element: Jacobian at constant load', &
      all(abs(jacobian(1:m, 1:m) - square) <= 1.0e-9_wp*contact%initial_stiffness))

    element = element_of(MSLIP_INPUT_APPROACH)
    displacement = 0
    displacement(2) = 1.2e-8_wp
    displacement(5) = 3.0e-9_wp
    displacement(m + 1:m + 3) = [2.0e-8_wp, 1.0e-8_wp, 2.4e-8_wp]
    call mslip_element_harmonic_force(element, workspace, displacement, status, force, jacobian, energy(1), drift=energy(2))
    call check_status('element: harmonic force with separation', status, MSLIP_OK)
    call check('element: positive energy, no drift', energy(1) > 0 .and. .not. abs(energy(2)) > 0)
    step = 1.0e-14_wp
    do j = 1, 2*m
      changed = displacement
      changed(j) = changed(j) + step
      call mslip_element_harmonic_force(element, workspace, changed, status, other)
      changed(j) = displacement(j) - step
      call mslip_element_harmonic_force(element, workspace, changed, status, force)
      call check('element: Jacobian', all(abs((other - force)/(2*step) - jacobian(:, j)) <= 1.0e-4_wp*element%normal_stiffness))
    end do
  end subroutine test_element_harmonic_force

  subroutine test_element_batch()
    ! Single calls and batches have the same bits; items share elements by an index from 1; an item is skipped if flagged.
    integer, parameter :: n = 4
    integer(mslip_size), parameter :: harmonics = 1, samples = 16
    integer(mslip_int), parameter :: index(n) = [2_mslip_int, 1_mslip_int, 2_mslip_int, 1_mslip_int]
    integer(mslip_int), parameter :: active(n) = [1_mslip_int, 1_mslip_int, 0_mslip_int, 5_mslip_int]
    real(wp), parameter :: displacement(2, n) = reshape([1.0e-8_wp, 5.0e-8_wp, 2.0e-8_wp, 6.0e-8_wp, -1.0e-8_wp, 3.0e-8_wp, &
      4.0e-9_wp, -1.0e-9_wp], [2, n])
    type(mslip_element), allocatable :: elements(:), each(:)
    type(mslip_parameters) :: p
    real(wp), dimension(mslip_element_state_length(1_mslip_int, 4_mslip_size), n) :: start, states, expected
    real(wp), dimension(mslip_element_workspace_length(1_mslip_int, harmonics, samples)) :: workspace
    real(wp) :: force(2, n), tangent(2, 2, n), dissipated(n), all_force(2, n), all_tangent(2, 2, n), all_dissipated(n)
    real(wp) :: coefficients(6, n), harmonic(6, n), jacobian(6, 6, n), energy(n), one(6), square(6, 6), single
    integer(mslip_int) :: status
    integer :: i

    p = flat_parameters()
    allocate (elements(2), each(n))
    elements(1) = element_of(MSLIP_INPUT_APPROACH)
    call mslip_element_init(p, 1_mslip_int, MSLIP_INPUT_APPROACH, elements(2), status)
    each = elements(index)
    start = spread(element_state(4_mslip_size), 2, n)
    expected = start
    do i = 1, n
      call mslip_element_advance(each(i), expected(:, i), displacement(:, i), status, force(:, i), tangent(:, :, i), dissipated(i))
      call check_status('element: single step', status, MSLIP_OK)
    end do
    states = start
    call mslip_batch_element_update(each, start, displacement, states, status, force=all_force, tangent=all_tangent, &
      dissipated=all_dissipated)
    call check_status('element: batch', status, MSLIP_OK)
    call check_same('element: batch', [all_force, all_tangent, all_dissipated], [force, tangent, dissipated])
    call check_same('element: states of a batch', [states], [expected])
    states = start
    all_force = untouched
    call mslip_batch_element_advance(elements, states, displacement, status, index, active, all_force)
    call check_status('element: batch in place with index and flags', status, MSLIP_OK)
    call check_same('element: batch in place with index and flags', [all_force], &
      [force(:, 1:2), spread(untouched, 1, 2), force(:, 4)])
    call check_same('element: skipped state', [states], [expected(:, 1:2), start(:, 3), expected(:, 4)])
    call mslip_batch_element_advance(elements(1:0), states(:, 1:0), displacement(:, 1:0), status)
    call check_status('element: no items', status, MSLIP_OK)

    call mslip_element_workspace_init(1_mslip_int, harmonics, samples, 0_mslip_size, workspace, status)
    coefficients = 0
    coefficients(2, :) = displacement(1, :)
    coefficients(4, :) = displacement(2, :)
    coefficients(6, :) = 1.0e-8_wp
    harmonic = untouched
    call mslip_batch_element_harmonic_force(elements, workspace, coefficients, status, index, active, harmonic, jacobian, energy)
    call check_status('element: batch of harmonic forces', status, MSLIP_OK)
    do i = 1, n
      if (active(i) == 0) cycle
      call mslip_element_harmonic_force(each(i), workspace, coefficients(:, i), status, one, square, single)
      call check_same('element: harmonic force of each', [harmonic(:, i), [jacobian(:, :, i)], energy(i)], [one, [square], single])
    end do
    call check_same('element: skipped harmonic force', harmonic(:, 3), spread(untouched, 1, 6))
    call mslip_batch_element_harmonic_force(each, workspace, coefficients, status, force=harmonic)
    call check_same('element: the last harmonic force', harmonic(:, n), one)
  end subroutine test_element_batch

  subroutine test_two_directions()
    ! Steps in place, a path and a batch have the same bits as single steps; so do batches of harmonic forces. At a constant normal
    ! force that comes back.
    integer, parameter :: n = 6, h = 1, m = 3*(2*h + 1)
    integer(mslip_int), parameter :: two = 2
    integer(mslip_size), parameter :: harmonics = h, samples = 16
    type(mslip_element) :: element
    type(mslip_elliptic_parameters) :: p
    real(wp), dimension(mslip_element_state_length(two, 0_mslip_size)) :: start, state, new
    real(wp), dimension(mslip_element_state_length(two, 0_mslip_size), n) :: states, all_states
    real(wp) :: workspace(mslip_element_workspace_length(two, harmonics, samples))
    real(wp) :: displacement(3, n), force(3, n), tangent(3, 3, n), dissipated(n)
    real(wp) :: all_force(3, n), all_tangent(3, 3, n), all_dissipated(n)
    real(wp) :: coefficients(m, 2), harmonic(m, 2), jacobian(m, m, 2), energy(2), one(m), square(m, m), single, error
    real(wp) :: drift(2), own_drift
    integer(mslip_size) :: found(3)
    integer(mslip_int) :: status, kinds(2)
    integer :: i

    p = mslip_elliptic_parameters(1.0e-4_wp, 1.0e-4_wp, 50.0_wp, 0.5_wp, spread(mslip_material(2.0e11_wp, 0.3_wp), 1, 2))
    call mslip_element_init_elliptic(p, two, MSLIP_INPUT_NORMAL_FORCE, element, status)
    call check_status('two directions: element', status, MSLIP_OK)
    call check('two directions: element', element%directions == 2)
    call mslip_element_state_init(two, start, status)
    call check_status('two directions: state', status, MSLIP_OK)
    displacement(1, :) = [(1.0e-7_wp*sin(1.7_wp*i), i = 1, n)]
    displacement(2, :) = [(1.0e-7_wp*cos(1.3_wp*i), i = 1, n)]
    displacement(3, :) = [(max(30.0_wp*sin(0.9_wp*i), 0.0_wp), i = 1, n)]
    state = start
    do i = 1, n
      call mslip_element_update(element, state, displacement(:, i), new, status, force(:, i), tangent(:, :, i), dissipated(i))
      call check_status('two directions: update', status, MSLIP_OK)
      call mslip_element_advance(element, state, displacement(:, i), status, all_force(:, i), all_tangent(:, :, i), &
        all_dissipated(i))
      call check_status('two directions: step in place', status, MSLIP_OK)
    end do
    call check_same('two directions: step in place', [all_force, all_tangent, all_dissipated], [force, tangent, dissipated])
    call mslip_element_state_check(two, state, status)
    call check_status('two directions: check of a state', status, MSLIP_OK)
    call mslip_element_state_error(two, state, error, status)
    call check('two directions: a bound on the error', status == MSLIP_OK .and. error >= 0)
    call check_same('two directions: the given normal force', force(3, :), displacement(3, :))
    call check_same('two directions: dN/dN', tangent(3, 3, n:n), [merge(1.0_wp, 0.0_wp, displacement(3, n) > 0)])
    call mslip_element_path(element, start, displacement, new, status, all_force, all_tangent, all_dissipated)
    call check_status('two directions: path', status, MSLIP_OK)
    call check_same('two directions: path', [all_force, all_tangent, all_dissipated], [force, tangent, dissipated])
    all_tangent = untouched
    all_dissipated = untouched
    state = start
    call mslip_element_path_advance(element, state, displacement, status, all_force, all_tangent, all_dissipated)
    call check_same('two directions: path in place', [all_force, all_tangent, all_dissipated], [force, tangent, dissipated])

    ! Each displacement as the first step of an item, with one element for all.
    states = spread(start, 2, n)
    call mslip_batch_element_update([element], states, displacement, all_states, status, spread(1_mslip_int, 1, n), &
      force=all_force, tangent=all_tangent, dissipated=all_dissipated)
    call check_status('two directions: batch', status, MSLIP_OK)
    do i = 1, n
      state = start
      call mslip_element_advance(element, state, displacement(:, i), status, force(:, i), tangent(:, :, i), dissipated(i))
      call check_same('two directions: states of a batch', all_states(:, i), state)
    end do
    call check_same('two directions: batch', [all_force, all_tangent, all_dissipated], [force, tangent, dissipated])
    all_tangent = untouched
    all_dissipated = untouched
    call mslip_batch_element_advance(spread(element, 1, n), states, displacement, status, force=all_force, tangent=all_tangent, &
      dissipated=all_dissipated)
    call check_status('two directions: batch in place', status, MSLIP_OK)
    call check_same('two directions: batch in place', [all_force, all_tangent, all_dissipated], [force, tangent, dissipated])

    call mslip_element_workspace_init(two, harmonics, samples, 3_mslip_size, workspace, status)
    call check_status('two directions: workspace', status, MSLIP_OK)
    call mslip_element_workspace_size(workspace, kinds(1), found(1), found(2), kinds(2), found(3), status)
    call check('two directions: size of a workspace', all(found == [harmonics, samples, 3_mslip_size]) .and. &
      all(kinds == [two, MSLIP_UNIFORM_SAMPLING]))
    coefficients(:, 1) = [2.0e-7_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 5.0e-8_wp, 30.0_wp, 0.0_wp, 0.0_wp]
    coefficients(:, 2) = [0.0_wp, 5.0e-8_wp, 0.0_wp, 2.0e-7_wp, 1.0e-8_wp, 0.0_wp, 30.0_wp, 1.0_wp, 0.5_wp]
    call mslip_batch_element_harmonic_force(spread(element, 1, 2), workspace, coefficients, status, force=harmonic, &
      jacobian=jacobian, dissipated=energy, drift=drift)
    call check_status('two directions: batch of harmonic forces', status, MSLIP_OK)
    call check('two directions: drift', all(drift > 0 .and. drift < 0.1_wp))
    do i = 1, 2
      call mslip_element_harmonic_force(element, workspace, coefficients(:, i), status, one, square, single, own_drift)
      call check_status('two directions: harmonic force', status, MSLIP_OK)
      call check_same('two directions: harmonic force', [harmonic(:, i), [jacobian(:, :, i)], energy(i), drift(i)], &
        [one, [square], single, own_drift])
      call check('two directions: normal force', all(abs(one(7:9) - coefficients(7:9, i)) <= 1.0e-12_wp*30))
    end do
  end subroutine test_two_directions

end program test_microslip
