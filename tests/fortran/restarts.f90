program restarts
  ! States that were text continue with the same forces, or are rejected: list-directed and namelist output, 16 and 15 digits.
  use microslip
  use checks
  implicit none

  character(len=*), parameter :: forms(4) = [character(len=13) :: 'list-directed', 'namelist', '(*(es23.15))', '(*(es22.14))']

  type(mslip_contact) :: contact
  type(mslip_element) :: elements(2)
  type(mslip_parameters) :: p
  real(wp) :: phase
  integer(mslip_int) :: status, directions

  p = flat_parameters(1)
  phase = 0.7_wp
  call mslip_contact_init(p, contact, status)
  call check_status('initialise the contact', status, MSLIP_OK)
  do directions = 1, 2
    call mslip_element_init(p, directions, MSLIP_INPUT_NORMAL_FORCE, elements(directions), status)
    call check_status('initialise an element', status, MSLIP_OK)
  end do
  call as_text(0_mslip_int, 10000, int(mslip_state_length(16_mslip_size)))
  call as_text(1_mslip_int, 10000, int(mslip_element_state_length(1_mslip_int, 16_mslip_size)))
  call as_text(2_mslip_int, 400, int(mslip_element_state_length(2_mslip_int, 0_mslip_size)))
  call report()

contains

  subroutine as_text(directions, states, length)
    ! Directions of elements; 0 for the contact.
    integer(mslip_int), intent(in) :: directions
    integer, intent(in) :: states, length

    character(len=120) :: name
    real(wp) :: state(length), text(length), to(3), force, restarted
    integer :: file, i, k, form, rejected(4), wrong(4)
    namelist /restart/ text

    open (newunit=file, status='scratch')
    rejected = 0
    wrong = 0
    do i = 1, states
      form = 1 + mod(i, 4)
      if (directions == 0) call mslip_state_init(state, status)
      if (directions > 0) call mslip_element_state_init(directions, state, status)
      do k = 1, 2 + mod(i, 9)
        call next(to)
        call advance(directions, state, to, force)
      end do

      text = state
      rewind (file)
      if (form == 1) write (file, *) text
      if (form == 2) write (file, nml=restart)
      if (form > 2) write (file, forms(form)) text
      text = untouched
      rewind (file)
      if (form == 2) read (file, nml=restart)
      if (form /= 2) read (file, *) text

      if (directions == 0) call mslip_state_check(text, status)
      if (directions > 0) call mslip_element_state_check(directions, text, status)
      if (status /= MSLIP_OK) then
        rejected(form) = rejected(form) + 1
        cycle
      end if
      call next(to)
      call advance(directions, state, to, force)
      call advance(directions, text, to, restarted)
      ! With all digits the same bits; otherwise rounding of displacements by 5e-15, times a stiffness of a few mu N over the
      ! largest.
      if (.not. abs(force - restarted) <= merge(0.0_wp, 1e-12_wp, form < 3)*contact%slip_force) wrong(form) = wrong(form) + 1
    end do
    close (file)
    do form = 1, 4
      write (name, '(2a, i0, a, i0, a, i0)') trim(forms(form)), ', directions ', directions, ': rejected ', rejected(form), &
        ', wrong ', wrong(form)
      ! A closed contact of two directions needs 17 digits.
      call check(name, wrong(form) == 0 .and. (rejected(form) == 0 .or. directions == 2 .and. form > 2))
    end do
  end subroutine as_text

  subroutine next(to)
    ! Displacements up to gross slip in both directions, and a normal force.
    real(wp), intent(out) :: to(3)

    integer :: i

    do i = 1, 3
      phase = sin(997*phase)
      to(i) = phase
    end do
    to = [1.2_wp*contact%slip_displacement*to(:2), p%normal_force*abs(to(3))]
  end subroutine next

  subroutine advance(directions, state, to, force)
    ! A step in place.
    integer(mslip_int), intent(in) :: directions
    real(wp), intent(inout) :: state(:)
    real(wp), intent(in) :: to(3)
    real(wp), intent(out) :: force

    real(wp) :: forces(3)

    select case (directions)
    case (0)
      call mslip_masing_advance(contact, state, to(1), status, forces(1))
    case (1)
      call mslip_element_advance(elements(1), state, to([1, 3]), status, forces(:2))
    case default
      call mslip_element_advance(elements(2), state, to, status, forces)
    end select
    force = forces(1)
    if (status /= MSLIP_OK) force = huge(force)
  end subroutine advance

end program restarts
