program restarts
  ! States that were list-directed or namelist output continue with the same bits. Those with fewer digits are tested in Rust.
  use microslip
  use checks
  implicit none

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
  call as_text(0_mslip_int, 1000, int(mslip_state_length(16_mslip_size)))
  call as_text(1_mslip_int, 1000, int(mslip_element_state_length(1_mslip_int, 16_mslip_size)))
  call as_text(2_mslip_int, 100, int(mslip_element_state_length(2_mslip_int, 0_mslip_size)))
  call report()

contains

  subroutine as_text(directions, states, length)
    ! Directions of elements; 0 for the contact.
    integer(mslip_int), intent(in) :: directions
    integer, intent(in) :: states, length

    character(len=40) :: name
    real(wp) :: state(length), text(length), to(3), force, restarted
    integer :: file, i, k, wrong
    namelist /restart/ text

    open (newunit=file, status='scratch')
    wrong = 0
    do i = 1, states
      if (directions == 0) call mslip_state_init(state, status)
      if (directions > 0) call mslip_element_state_init(directions, state, status)
      do k = 1, 2 + mod(i, 9)
        call next(to)
        call advance(directions, state, to, force)
      end do
      text = state
      rewind (file)
      if (mod(i, 2) == 0) write (file, *) text
      if (mod(i, 2) == 1) write (file, nml=restart)
      text = untouched
      rewind (file)
      if (mod(i, 2) == 0) read (file, *) text
      if (mod(i, 2) == 1) read (file, nml=restart)
      call next(to)
      call advance(directions, state, to, force)
      call advance(directions, text, to, restarted)
      if (.not. abs(force - restarted) <= 0) wrong = wrong + 1
    end do
    close (file)
    write (name, '(a, i0, a, i0)') 'text, directions ', directions, ': wrong ', wrong
    call check(name, wrong == 0)
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
