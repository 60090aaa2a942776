program bad_input
  ! Bad input, one at a time, from Fortran: NaN, quiet and signalling, infinities, and memory with changed bits. Each is
  ! rejected by its own status and no output is modified; compiled with traps, none raises a signal.
  use, intrinsic :: ieee_arithmetic, only: ieee_negative_inf, ieee_positive_inf, ieee_quiet_nan, ieee_value
  use, intrinsic :: iso_c_binding, only: c_int64_t
  use microslip
  use checks
  implicit none

  integer, parameter :: bad_values = 5, samples = 16, harmonics = 2, m = 2*harmonics + 1, items = 3
  integer(c_int64_t), parameter :: signalling(2) = [int(z'7FF0000000000001', c_int64_t), int(z'7FF4000000000000', c_int64_t)]

  type(mslip_contact) :: flat
  real(wp) :: bad(bad_values)

  call initialise()
  call test_parameters()
  call test_elliptic_parameters()
  call test_values()
  call test_batches()
  call test_contact_bits()
  call test_state_values()
  call test_restart_file()
  call test_workspace_values()
  call report()

contains

  pure function good_parameters() result(p)
    type(mslip_parameters) :: p

    p = mslip_parameters(flat_half_width=5.0e-4_wp, edge_radius=3.0e-3_wp, length=2.0e-2_wp, normal_force=800.0_wp, &
      friction_coefficient=0.5_wp, material=[mslip_material(1.14e11_wp, 0.32_wp), mslip_material(2.0e11_wp, 0.29_wp)])
  end function good_parameters

  subroutine initialise()
    integer(mslip_int) :: status

    bad(1) = ieee_value(1.0_wp, ieee_quiet_nan)
    bad(2) = ieee_value(1.0_wp, ieee_positive_inf)
    bad(3) = ieee_value(1.0_wp, ieee_negative_inf)
    bad(4:5) = transfer(signalling, bad, 2)
    call mslip_contact_init(good_parameters(), flat, status)
    call check_status('initialise', status, MSLIP_OK)
  end subroutine initialise

  logical function is_untouched(values)
    ! Compared as bits: a value written in error may be NaN.
    real(wp), intent(in) :: values(:)

    is_untouched = all(transfer(values, [0_c_int64_t]) == transfer(untouched, 0_c_int64_t))
  end function is_untouched

  pure function flipped(value, bit)
    real(wp), intent(in) :: value
    integer, intent(in) :: bit
    real(wp) :: flipped

    flipped = transfer(ieor(transfer(value, 0_c_int64_t), ishft(1_c_int64_t, bit)), value)
  end function flipped

  subroutine test_parameters()
    ! Every parameter in turn: NaN, infinite, of the wrong sign.
    integer(mslip_int), parameter :: expected(9) = [MSLIP_BAD_FLAT_HALF_WIDTH, MSLIP_BAD_EDGE_RADIUS, MSLIP_BAD_LENGTH, &
      MSLIP_BAD_NORMAL_FORCE, MSLIP_BAD_FRICTION_COEFFICIENT, MSLIP_BAD_YOUNG_MODULUS, MSLIP_BAD_POISSON_RATIO, &
      MSLIP_BAD_YOUNG_MODULUS, MSLIP_BAD_POISSON_RATIO]
    type(mslip_parameters) :: p
    type(mslip_contact) :: contact
    integer(mslip_int) :: status
    integer :: i, k

    do i = 1, size(expected)
      do k = 1, bad_values + 1
        p = good_parameters()
        select case (i)
        case (1); p%flat_half_width = bad_or_negative(k)
        case (2); p%edge_radius = bad_or_negative(k)
        case (3); p%length = bad_or_negative(k)
        case (4); p%normal_force = bad_or_negative(k)
        case (5); p%friction_coefficient = bad_or_negative(k)
        case (6); p%material(1)%young_modulus = bad_or_negative(k)
        case (7); p%material(1)%poisson_ratio = bad_or_negative(k)
        case (8); p%material(2)%young_modulus = bad_or_negative(k)
        case (9); p%material(2)%poisson_ratio = bad_or_negative(k)
        end select
        contact%half_width = untouched
        call mslip_contact_init(p, contact, status)
        call check_status('a parameter', status, expected(i))
        call check('a rejected contact is not modified', is_untouched([contact%half_width]))
      end do
    end do
  end subroutine test_parameters

  function bad_or_negative(k) result(value)
    integer, intent(in) :: k
    real(wp) :: value

    value = -1
    if (k <= bad_values) value = bad(min(k, bad_values))
  end function bad_or_negative

  subroutine test_elliptic_parameters()
    integer(mslip_int), parameter :: expected(6) = [MSLIP_BAD_SEMI_AXIS_X, MSLIP_BAD_SEMI_AXIS_Y, MSLIP_BAD_NORMAL_FORCE, &
      MSLIP_BAD_FRICTION_COEFFICIENT, MSLIP_BAD_YOUNG_MODULUS, MSLIP_BAD_POISSON_RATIO]
    type(mslip_elliptic_parameters) :: p
    type(mslip_contact) :: contact
    integer(mslip_int) :: status
    integer :: i, k

    do i = 1, size(expected)
      do k = 1, bad_values + 1
        p = mslip_elliptic_parameters(1.0e-3_wp, 2.0e-3_wp, 50.0_wp, 0.5_wp, &
          [mslip_material(2.0e11_wp, 0.3_wp), mslip_material(2.0e11_wp, 0.3_wp)])
        select case (i)
        case (1); p%semi_axis_x = bad_or_negative(k)
        case (2); p%semi_axis_y = bad_or_negative(k)
        case (3); p%normal_force = bad_or_negative(k)
        case (4); p%friction_coefficient = bad_or_negative(k)
        case (5); p%material(2)%young_modulus = bad_or_negative(k)
        case (6); p%material(2)%poisson_ratio = bad_or_negative(k)
        end select
        contact%half_width = untouched
        call mslip_contact_init_elliptic(p, contact, status)
        call check_status('a parameter of an ellipse', status, expected(i))
        call check('a rejected ellipse is not modified', is_untouched([contact%half_width]))
      end do
    end do
  end subroutine test_elliptic_parameters

  subroutine test_values()
    ! Each procedure with each bad value.
    real(wp) :: state(mslip_state_length(4_mslip_size)), next(mslip_state_length(4_mslip_size))
    real(wp) :: workspace(mslip_harmonic_workspace_length(int(harmonics, mslip_size), int(samples, mslip_size)))
    real(wp) :: x(3), a(3), b(3), c(3), d(3), displacement(m), force(m), jacobian(m, m), one, two, three
    integer(mslip_int) :: status
    integer :: k

    call mslip_state_init(state, status)
    call mslip_masing_advance(flat, state, 1.0e-7_wp, status)
    call mslip_harmonic_workspace_init(int(harmonics, mslip_size), int(samples, mslip_size), workspace, status)
    call check_status('workspace', status, MSLIP_OK)
    do k = 1, bad_values
      a = untouched; b = untouched; c = untouched; d = untouched; next = untouched
      force = untouched; jacobian = untouched; one = untouched; two = untouched; three = untouched
      x = [1.0e-5_wp, 2.0e-5_wp, bad(k)]
      call mslip_tractions(flat, 1.0_wp, x, status, a, b)
      call check_status('tractions: x', status, MSLIP_BAD_POSITION)
      call mslip_tractions(flat, bad(k), x(:2), status, a(:2), b(:2))
      call check_status('tractions: force', status, MSLIP_BAD_FORCE)
      call mslip_slip(flat, 1.0_wp, x, status, a, b)
      call check_status('slip: x', status, MSLIP_BAD_POSITION)
      call mslip_slip(flat, bad(k), x(:2), status, a(:2), b(:2))
      call check_status('slip: force', status, MSLIP_BAD_FORCE)
      call mslip_monotonic_displacement(flat, x, status, a, b, c)
      call check_status('monotonic_displacement', status, MSLIP_BAD_FORCE)
      call mslip_monotonic_displacement(flat, bad(k), status, one, two, three)
      call check_status('monotonic_displacement, one', status, MSLIP_BAD_FORCE)
      call mslip_monotonic_force(flat, x, status, a, b, c)
      call check_status('monotonic_force', status, MSLIP_BAD_DISPLACEMENT)
      call mslip_monotonic_force(flat, bad(k), status, one, two, three)
      call check_status('monotonic_force, one', status, MSLIP_BAD_DISPLACEMENT)
      call mslip_masing_update(flat, state, bad(k), next, status, one, two, three)
      call check_status('masing_update', status, MSLIP_BAD_DISPLACEMENT)
      call mslip_masing_advance(flat, state, bad(k), status, one, two, three)
      call check_status('masing_advance', status, MSLIP_BAD_DISPLACEMENT)
      call mslip_masing_path(flat, state, x, next, status, a, b, c)
      call check_status('masing_path', status, MSLIP_BAD_DISPLACEMENT)
      call mslip_masing_path_advance(flat, state, x, status, a, b, c)
      call check_status('masing_path_advance', status, MSLIP_BAD_DISPLACEMENT)
      call mslip_masing_tractions(flat, state, x, status, a, b)
      call check_status('masing_tractions', status, MSLIP_BAD_POSITION)
      call mslip_hysteresis_loop(flat, bad(k), a, b, status)
      call check_status('hysteresis_loop', status, MSLIP_BAD_AMPLITUDE)
      call mslip_dissipated_energy(flat, x, a, status)
      call check_status('dissipated_energy', status, MSLIP_BAD_FORCE_AMPLITUDE)
      call mslip_dissipated_energy(flat, bad(k), one, status)
      call check_status('dissipated_energy, one', status, MSLIP_BAD_FORCE_AMPLITUDE)
      call mslip_complex_stiffness(flat, x, status, a, b, c, d)
      call check_status('complex_stiffness', status, MSLIP_BAD_AMPLITUDE)
      call mslip_complex_stiffness(flat, bad(k), status, one, two, three)
      call check_status('complex_stiffness, one', status, MSLIP_BAD_AMPLITUDE)
      call mslip_jenkins_equivalent(flat, bad(k), one, two, status)
      call check_status('jenkins_equivalent', status, MSLIP_BAD_AMPLITUDE)
      displacement = 1.0e-7_wp
      displacement(m) = bad(k)
      call mslip_harmonic_force(flat, workspace, displacement, status, force, jacobian, one)
      call check_status('harmonic_force', status, MSLIP_BAD_DISPLACEMENT)
      call check('nothing written', is_untouched(a) .and. is_untouched(b) .and. is_untouched(c) .and. is_untouched(d) .and. &
        is_untouched(next) .and. is_untouched(force) .and. is_untouched(reshape(jacobian, [m*m])) .and. &
        is_untouched([one, two, three]))
    end do
    call mslip_masing_advance(flat, state, 1.0e-7_wp, status)
    call check_status('afterwards', status, MSLIP_OK)
  end subroutine test_values

  subroutine test_batches()
    ! One bad item: nothing is written; if it is skipped, it is not checked.
    type(mslip_contact) :: contacts(items), good
    real(wp), dimension(items) :: amplitude, displacement, a, b, c, d
    real(wp), dimension(mslip_state_length(4_mslip_size), items) :: states, next
    real(wp) :: workspace(mslip_harmonic_workspace_length(int(harmonics, mslip_size), int(samples, mslip_size)))
    real(wp) :: coefficients(m, items), force(m, items), jacobian(m, m, items)
    integer(mslip_int) :: status, active(items)
    integer :: i, k, which

    contacts = flat
    do i = 1, items
      call mslip_state_init(states(:, i), status)
    end do
    call mslip_harmonic_workspace_init(int(harmonics, mslip_size), int(samples, mslip_size), workspace, status)
    do which = 1, items
      do k = 1, bad_values + 1
        amplitude = 1.0e-7_wp
        displacement = 1.0e-7_wp
        coefficients = 1.0e-7_wp
        good = contacts(which)
        if (k <= bad_values) then
          amplitude(which) = bad_or_negative(k)
          displacement(which) = bad_or_negative(k)
          coefficients(1, which) = bad_or_negative(k)
        else
          contacts(which) = mslip_contact()
        end if
        a = untouched; b = untouched; c = untouched; d = untouched; next = untouched; force = untouched; jacobian = untouched
        call mslip_batch_complex_stiffness(contacts, amplitude, status, k_real=a, k_imag=b, dk_real=c, dk_imag=d)
        call check_status('batch: stiffness', status, merge(MSLIP_BAD_AMPLITUDE, MSLIP_BAD_CONTACT, k <= bad_values))
        call mslip_batch_masing_update(contacts, states, displacement, next, status, force=a, stiffness=b, dissipated=c)
        call check_status('batch: update', status, merge(MSLIP_BAD_DISPLACEMENT, MSLIP_BAD_CONTACT, k <= bad_values))
        call mslip_batch_harmonic_force(contacts, workspace, coefficients, status, force=force, jacobian=jacobian)
        call check_status('batch: force', status, merge(MSLIP_BAD_DISPLACEMENT, MSLIP_BAD_CONTACT, k <= bad_values))
        call check('batch: nothing written', is_untouched(a) .and. is_untouched(b) .and. is_untouched(c) .and. &
          is_untouched(d) .and. is_untouched(reshape(next, [size(next)])) .and. is_untouched(reshape(force, [size(force)])) &
          .and. is_untouched(reshape(jacobian, [size(jacobian)])))
        active = 1
        active(which) = 0
        call mslip_batch_complex_stiffness(contacts, amplitude, status, active=active, k_real=a, k_imag=b)
        call check_status('batch: one is skipped', status, MSLIP_OK)
        call mslip_batch_harmonic_force(contacts, workspace, coefficients, status, active=active, force=force)
        call check_status('batch: one is skipped', status, MSLIP_OK)
        call check('batch: all items but the skipped one are written', is_untouched([a(which), b(which), force(:, which)]) .and. &
          all([(is_untouched([a(i)]) .eqv. i == which, i = 1, items)]))
        contacts(which) = good
      end do
    end do
  end subroutine test_batches

  subroutine test_contact_bits()
    ! A value of a contact changed by hand, and any bit of it.
    type(mslip_contact) :: contact
    real(wp) :: words(storage_size(flat)/64)
    integer(mslip_int) :: status
    integer :: i, bit, rejections

    contact = flat
    contact%slip_force = 1.1_wp*contact%slip_force
    call mslip_contact_check(contact, status)
    call check_status('a changed slip force', status, MSLIP_BAD_CONTACT)
    rejections = 0
    do i = 1, size(words)
      do bit = 0, 63
        words = transfer(flat, words)
        words(i) = flipped(words(i), bit)
        contact = transfer(words, contact)
        call mslip_contact_check(contact, status)
        if (status == MSLIP_BAD_CONTACT) rejections = rejections + 1
      end do
    end do
    call check('the check of a contact finds every changed bit', rejections == 64*size(words))
  end subroutine test_contact_bits

  subroutine test_restart_file()
    ! A contact and a state written to a file and read back.
    type(mslip_contact) :: contact
    real(wp) :: state(mslip_state_length(4_mslip_size)), read_state(mslip_state_length(4_mslip_size)), force(2)
    integer(mslip_int) :: status
    integer :: file

    call mslip_state_init(state, status)
    call mslip_masing_advance(flat, state, 1.0e-7_wp, status)
    open (newunit=file, status='scratch', form='unformatted')
    write (file) flat, state
    rewind (file)
    read (file) contact, read_state
    close (file)
    call mslip_contact_check(contact, status)
    call check_status('a contact from a restart file', status, MSLIP_OK)
    call mslip_state_check(read_state, status)
    call check_status('a state from a restart file', status, MSLIP_OK)
    call mslip_masing_advance(flat, state, 0.5e-7_wp, status, force(1))
    call mslip_masing_advance(contact, read_state, 0.5e-7_wp, status, force(2))
    call check_status('a step from a restart file', status, MSLIP_OK)
    call check_same('a step from a restart file', force(2:), force(:1))
  end subroutine test_restart_file

  subroutine test_state_values()
    ! A bad value in any place of a state is found by the check; a state of bad values, or a truncated one, by every call.
    real(wp) :: state(mslip_state_length(4_mslip_size)), changed(mslip_state_length(4_mslip_size)), force
    integer(mslip_int) :: status
    integer :: i, k

    call mslip_state_init(state, status)
    call mslip_masing_path_advance(flat, state, [1.0e-7_wp, 0.5e-7_wp, 0.8e-7_wp], status)
    force = untouched
    do k = 1, bad_values
      do i = 1, int(mslip_state_length(2_mslip_size))
        changed = state
        changed(i) = bad(k)
        call mslip_state_check(changed, status)
        call check_status('check of a state with a bad value', status, MSLIP_BAD_STATE)
      end do
      changed(:) = bad(k)
      call mslip_masing_advance(flat, changed, 0.4e-7_wp, status, force)
      call check_status('a state of bad values', status, MSLIP_BAD_STATE)
    end do
    call mslip_masing_path_advance(flat, state, [0.6e-7_wp, 0.7e-7_wp], status)
    call mslip_masing_advance(flat, state(:mslip_state_length(2_mslip_size)), 0.65e-7_wp, status, force)
    call check_status('a state truncated below its reversals', status, MSLIP_BAD_STATE)
    call mslip_masing_advance(flat, state(:3), 0.4e-7_wp, status, force)
    call check_status('a truncated state', status, MSLIP_STATE_TOO_SHORT)
    call check('rejected states: nothing written', is_untouched([force]))
  end subroutine test_state_values

  subroutine test_workspace_values()
    ! Workspaces of both rules, overwritten and truncated.
    real(wp), allocatable :: workspace(:), changed(:)
    real(wp) :: displacement(m), force(m)
    integer(mslip_int) :: status, rule
    integer :: i

    displacement = 1.0e-7_wp
    do rule = MSLIP_UNIFORM_SAMPLING, MSLIP_EVENT_DRIVEN
      allocate (workspace(mslip_harmonic_workspace_length(int(harmonics, mslip_size), int(samples, mslip_size), rule)))
      call mslip_harmonic_workspace_init(int(harmonics, mslip_size), int(samples, mslip_size), workspace, status, rule)
      call check_status('workspace', status, MSLIP_OK)
      force = untouched
      do i = 1, bad_values
        changed = workspace
        changed(:) = bad(i)
        call mslip_harmonic_force(flat, changed, displacement, status, force)
        call check_status('a workspace of bad values', status, MSLIP_BAD_WORKSPACE)
      end do
      call mslip_harmonic_force(flat, workspace(:size(workspace) - 1), displacement, status, force)
      call check_status('a truncated workspace', status, MSLIP_WORKSPACE_TOO_SHORT)
      call check('rejected workspaces: nothing written', is_untouched(force))
      call mslip_harmonic_force(flat, workspace, displacement, status, force)
      call check_status('the workspace itself', status, MSLIP_OK)
      deallocate (workspace)
    end do
  end subroutine test_workspace_values

end program bad_input
