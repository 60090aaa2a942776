program test_microslip
  ! The Fortran module where it is more than its C functions, with which `bad_input` compares every procedure: constants, texts and
  ! types, strides and arrays without elements, and unformatted restart files; `restarts` has those of text.
  use microslip
  use checks
  implicit none

  real(wp), parameter :: tight = 1.0e-12_wp

  type(mslip_contact) :: cylinder, flat, open_contact

  call initialise()
  call test_library()
  call test_state()
  call test_workspaces()
  call test_elliptic()
  call test_face()
  call test_strides()
  call test_element_curve()
  call test_element_memory()
  call report()

contains

  subroutine initialise()
    type(mslip_parameters) :: p
    integer(mslip_int) :: status

    p = flat_parameters(1)
    p%flat_half_width = 0
    call mslip_contact_init(p, cylinder, status)
    call check_status('initialise the cylinder', status, MSLIP_OK)
    call check('no warning', mslip_parameters_warning(p, 1_mslip_int) == '' .and. mslip_parameters_warning(p, 0_mslip_int) == '')
    p%friction_coefficient = 45
    p%length = 1.0e-3_wp*p%length
    call check('warnings', index(mslip_parameters_warning(p, 1_mslip_int), 'length is implausible') == 1 .and. &
      index(mslip_parameters_warning(p, 2_mslip_int), 'friction_coefficient is implausible') == 1 .and. &
      mslip_parameters_warning(p, 3_mslip_int) == '')
    call check('warning of an ellipse', index(mslip_elliptic_parameters_warning(mslip_elliptic_parameters(1.0_wp, 1e-3_wp, 1.0_wp, &
      0.5_wp, spread(mslip_material(2.0e11_wp, 0.3_wp), 1, 2)), 1_mslip_int), 'semi_axis_x is implausible') == 1)
    call mslip_contact_init(flat_parameters(1), flat, status)
    call check_status('initialise the rounded flat', status, MSLIP_OK)
    call mslip_parameters_default(p)
    call mslip_contact_init(p, open_contact, status)
    call check_status('default parameters', status, MSLIP_BAD_FLAT_HALF_WIDTH)
    call mslip_contact_init(flat_parameters(-79), open_contact, status)  ! no load
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
    call check('size of the parameters', storage_size(flat_parameters(1)) == 14*64)
  end subroutine test_library

  subroutine test_state()
    ! A contact and a state from an unformatted restart file continue with the same bits.
    real(wp), dimension(mslip_state_length(4_mslip_size)) :: state, restart
    real(wp) :: force(2)
    type(mslip_contact) :: contact
    integer(mslip_int) :: status
    integer :: file

    state = initial_state(4_mslip_size)
    call mslip_masing_advance(flat, state, 6.0e-7_wp, status)
    open (newunit=file, status='scratch', form='unformatted')
    write (file) flat, state
    rewind (file)
    read (file) contact, restart
    close (file)
    call mslip_contact_check(contact, status)
    call check_status('a contact from a restart file', status, MSLIP_OK)
    call mslip_masing_advance(flat, state, 0.5e-7_wp, status, force(1))
    call mslip_masing_advance(contact, restart, 0.5e-7_wp, status, force(2))
    call check_status('a state from a restart file', status, MSLIP_OK)
    call check_same('a step from a restart file', [restart, force(2)], [state, force(1)])
  end subroutine test_state

  subroutine test_workspaces()
    ! Sizes come back in their places; the default rule, and parameters by their constants.
    integer(mslip_size), parameter :: harmonics = 3, samples = 64, periods = 5
    integer(mslip_int), parameter :: rules(2) = [MSLIP_UNIFORM_SAMPLING, MSLIP_EVENT_DRIVEN], two = 2
    real(wp) :: workspace(mslip_harmonic_workspace_length(harmonics, samples)), force(2)
    real(wp) :: of_element(mslip_element_workspace_length(two, harmonics, samples)), by_row(MSLIP_PARAMETER_COUNT, 2), load
    integer(mslip_size) :: found(3)
    integer(mslip_int) :: status, kinds(2)
    integer :: i

    do i = 1, 3
      if (i < 3) call mslip_harmonic_workspace_init(harmonics, samples, workspace, status, rules(min(i, 2)))
      if (i == 3) call mslip_harmonic_workspace_init(harmonics, samples, workspace, status)
      call check_status('workspace', status, MSLIP_OK)
      call mslip_harmonic_workspace_size(workspace, found(1), found(2), kinds(1), status)
      call check('size of a workspace', all(found(:2) == [harmonics, samples]) .and. kinds(1) == rules(mod(i - 1, 2) + 1))
    end do
    call mslip_element_workspace_init(two, harmonics, samples, periods, of_element, status)
    call check_status('element: workspace', status, MSLIP_OK)
    call mslip_element_workspace_size(of_element, kinds(1), found(1), found(2), kinds(2), found(3), status)
    call check('element: size of a workspace', all(found == [harmonics, samples, periods]) .and. &
      all(kinds == [two, MSLIP_UNIFORM_SAMPLING]))
    ! Beyond gross slip T = mu N.
    call mslip_monotonic_sensitivity(flat, [2.0e-7_wp, 1.0e-3_wp], status, force, by_row)
    call check_status('sensitivity', status, MSLIP_OK)
    load = by_row(MSLIP_BY_FRICTION_COEFFICIENT, 2)
    call check_close('slip force', load*by_row(MSLIP_BY_NORMAL_FORCE, 2), flat%slip_force, tight)
  end subroutine test_workspaces

  subroutine test_elliptic()
    type(mslip_elliptic_parameters) :: p
    type(mslip_contact) :: sphere
    integer(mslip_int) :: status

    call mslip_contact_init_elliptic(p, sphere, status)
    call check_status('elliptic parameters never set', status, MSLIP_BAD_SEMI_AXIS_X)
    call mslip_elliptic_parameters_default(p)
    p%semi_axis_x = 1.186981199180470441384427e-5_wp
    call mslip_contact_init_elliptic(p, sphere, status)
    call check_status('second axis not set', status, MSLIP_BAD_SEMI_AXIS_Y)
  end subroutine test_elliptic

  subroutine test_face()
    ! Two parts of two pairs in sections; other shapes.
    type(mslip_parameters) :: parts(3)
    real(wp), dimension(4, 3) :: area, pressure
    real(wp) :: weight(2, 2), wide(2, 3)
    integer(mslip_int) :: status

    area = untouched
    pressure = untouched
    area(1::3, 1::2) = reshape([1.0e-6_wp, 3.0e-6_wp, 4.0e-6_wp, 0.0_wp], [2, 2])
    pressure(1::3, 1::2) = reshape([2.0e6_wp, 2.0e6_wp, 1.0e6_wp, 9.0e6_wp], [2, 2])
    call mslip_face_parts(flat_parameters(1), area(1::3, 1::2), pressure(1::3, 1::2), parts(1::2), status, weight)
    call check_status('face: sections', status, MSLIP_OK)
    call check_close('face: force of the last part', parts(3)%normal_force, 4.0_wp, 1e-15_wp)
    call check_close('face: modulus', parts(1)%material(2)%young_modulus, 1.0e11_wp, 1e-15_wp)
    call check('face: gaps are not written', .not. parts(2)%length > 0)
    call check('face: weights', all(abs(weight - reshape([0.25_wp, 0.75_wp, 1.0_wp, 0.0_wp], [2, 2])) < 1e-15_wp))
    call mslip_face_parts(flat_parameters(1), area(1::3, 1::2), pressure(1::3, 1::2), parts, status)
    call check_status('face: three parts', status, MSLIP_BAD_ARRAY_SIZE)
    call mslip_face_parts(flat_parameters(1), area(1::3, 1::2), pressure(1::3, :), parts(:2), status)
    call check_status('face: other pressures', status, MSLIP_BAD_ARRAY_SIZE)
    call mslip_face_parts(flat_parameters(1), area(1::3, 1::2), pressure(1::3, 1::2), parts(:2), status, wide)
    call check_status('face: other weights', status, MSLIP_BAD_ARRAY_SIZE)
    call mslip_face_parts(flat_parameters(1), area, pressure, parts, status)
    call check_status('face: negative areas', status, MSLIP_BAD_AREA)
  end subroutine test_face

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

  subroutine test_element_curve()
    ! At the normal force of the parameters the curve begins with the tangential stiffness; a point alone has the bits of several.
    type(mslip_element) :: element
    real(wp) :: displacement(2), compliance(2), one(2)
    integer(mslip_int) :: status

    call mslip_element_init(flat_parameters(1), 1_mslip_int, MSLIP_INPUT_APPROACH, element, status)
    call check_status('initialise an element', status, MSLIP_OK)
    call mslip_element_displacement(element, 0_mslip_int, [0.0_wp, 100.0_wp], [800.0_wp, 600.0_wp], status, displacement, &
      compliance)
    call check_status('element: curve', status, MSLIP_OK)
    call check_same('element: no force', displacement(1:1), [0.0_wp])
    call check_close('element: initial compliance', compliance(1)*element%tangential_stiffness, 1.0_wp, tight)
    call mslip_element_displacement(element, 0_mslip_int, 100.0_wp, 600.0_wp, status, one(1), one(2))
    call check_same('element: one point of the curve', one, [displacement(2), compliance(2)])
    call mslip_element_displacement(element, 1_mslip_int, 100.0_wp, 600.0_wp, status)
    call check_status('element: no second direction', status, MSLIP_BAD_DIRECTIONS)
    call mslip_element_displacement(element, 0_mslip_int, [100.0_wp], [800.0_wp, 600.0_wp], status)
    call check_status('element: a normal force for each force', status, MSLIP_BAD_ARRAY_SIZE)
  end subroutine test_element_curve

  subroutine test_element_memory()
    ! A path in place with sections, and without steps. An elliptical element.
    integer, parameter :: steps = 14
    type(mslip_element) :: element, sphere
    type(mslip_elliptic_parameters) :: p
    real(wp) :: displacement(2, steps), force(2, steps), scattered(3, 2, steps)
    real(wp), dimension(mslip_element_state_length(1_mslip_int, 16_mslip_size)) :: start, last
    integer(mslip_int) :: status
    integer :: i

    call mslip_element_init(flat_parameters(1), 1_mslip_int, MSLIP_INPUT_NORMAL_FORCE, element, status)
    call check_status('initialise an element', status, MSLIP_OK)
    call check('size of an element: no padding', storage_size(element) == 64*(8 + size(element%reserved)))
    call check('fields of an element', element%directions == 1 .and. element%normal_input == MSLIP_INPUT_NORMAL_FORCE)
    call check_same('fields of an element', [element%friction_coefficient, element%normal_force], [0.5_wp, 800.0_wp])
    displacement(1, :) = [(5.0e-7_wp*sin(1.7_wp*i), i = 1, steps)]
    displacement(2, :) = [(max(450.0_wp + 500.0_wp*sin(0.9_wp*i), 0.0_wp), i = 1, steps)]
    call mslip_element_state_init(1_mslip_int, start, status)
    call check_status('initialise the state of an element', status, MSLIP_OK)
    last = start
    call mslip_element_path_advance(element, start, displacement, status, force)
    call check_same('element: the given normal force', force(2, :), displacement(2, :))
    scattered = untouched
    scattered(2, :, :) = displacement
    call mslip_element_path_advance(element, last, scattered(2, :, :), status, force=scattered(1, :, :))
    call check_status('element: path in place, sections', status, MSLIP_OK)
    call check_same('element: path in place, sections', [scattered(1, :, :)], [force])
    call check_same('element: gaps are not written', [scattered(3, :, :)], spread(untouched, 1, 2*steps))
    call check_same('element: state after a path', last(:12), start(:12))
    call mslip_element_path(element, start, displacement(:, 1:0), last, status)
    call check_status('element: path without steps', status, MSLIP_OK)

    p = mslip_elliptic_parameters(1.0e-4_wp, 1.0e-4_wp, 50.0_wp, 0.5_wp, spread(mslip_material(2.0e11_wp, 0.3_wp), 1, 2))
    call mslip_element_init_elliptic(p, 2_mslip_int, MSLIP_INPUT_APPROACH, sphere, status)
    call check_status('element of a sphere', status, MSLIP_OK)
    call check('element of a sphere: two directions', sphere%directions == 2)
  end subroutine test_element_memory

end program test_microslip
