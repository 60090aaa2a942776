! One contact point of a finite-element program: the steps that user subroutines of several programs have in common.
!
! A program passes state variables of the start of an increment, calls in every iteration with another trial displacement, and keeps
! the state variables of the last call if it accepts the increment. So every call is a trial step from `start` to `finish`.
!
! State variables, for m = directions + 1 components of the displacement:
!   1               energy dissipated so far [J]
!   2 ... m+1       displacement of the last step: [u, w] or [u, v, w] [m]
!   m+2 ...         state of the library
! `contact_variables(directions)` of them are needed. All are 0 at the start of an analysis: then the state is initialised here.
module contact_point
  use microslip
  implicit none
  private
  public :: contact_variables, contact_stiffness, contact_step, increment_too_long

  ! The initialisation of an element takes much longer than a step, so each thread keeps the elements of the last parameter sets.
  ! That needs OpenMP's threadprivate memory. Compiled without OpenMP the table would be shared by all threads, so it is not used
  ! (the line with the sentinel !$ is a comment then), and each call initialises the element: always correct, but slow.
  integer, parameter :: places = 8                              ! parameter sets kept by each thread

  type :: kept_element
    real(mslip_real) :: constants(9) = 0
    integer(mslip_int) :: choices(2) = -1
    type(mslip_element) :: element
  end type kept_element

  type(kept_element), save, target :: kept(places)
  integer, save :: last = 0
  !$omp threadprivate(kept, last)

contains

  !> Number of state variables of a point.
  pure function contact_variables(directions) result(n)
    integer(mslip_int), intent(in) :: directions
    integer :: n
    integer(mslip_size), parameter :: pieces = 64               ! of the memory diagram; ignored for two directions

    n = 2 + directions + int(mslip_element_state_length(directions, pieces))
  end function contact_variables

  !> A trial step. `constants` are a, R, L [m], N [N] (the largest force expected), mu, E1 [Pa], nu1, E2 [Pa], nu2. `first` is the
  !> displacement at the start of the increment; it is used for a point without history only, which is brought there without
  !> tangential force. On an error no output is modified.
  subroutine contact_step(constants, reference, directions, first, displacement, start, finish, force, tangent, dissipated, &
      status)
    real(mslip_real), intent(in) :: constants(9)
    integer(mslip_int), intent(in) :: reference                 ! MSLIP_CENTRE_POINT or MSLIP_RIGID_STRIP
    integer(mslip_int), intent(in) :: directions
    real(mslip_real), intent(in) :: first(:), displacement(:)   ! m values
    real(mslip_real), intent(in) :: start(:)                    ! state variables before the step
    real(mslip_real), intent(inout) :: finish(:)                ! state variables after the step
    real(mslip_real), intent(inout) :: force(:), tangent(:, :)  ! on the whole contact [N], [N/m]
    real(mslip_real), intent(inout) :: dissipated               ! by this step [J]
    integer(mslip_int), intent(out) :: status
    type(mslip_element), allocatable, target :: own
    type(mslip_element), pointer :: element
    real(mslip_real), dimension(max(0, size(start) - directions - 2)) :: state, trial
    integer :: m

    m = directions + 1
    call find_element(constants, [reference, directions], own, element, status)
    if (status /= MSLIP_OK) return
    state = start(m+2:)
    if (all(abs(state) <= 0)) then
      call mslip_element_state_init(directions, state, status)
      if (status == MSLIP_OK) call mslip_element_advance(element, state, [first(:directions), 0.0_mslip_real], status)
      if (status == MSLIP_OK) call mslip_element_advance(element, state, first, status)
      if (status /= MSLIP_OK) return
    end if
    trial = state
    call mslip_element_update(element, state, displacement, trial, status, force, tangent, dissipated)
    if (status == MSLIP_OK) finish = [start(1) + dissipated, displacement, trial]
  end subroutine contact_step

  !> Stiffness of a sticking contact under N [N/m], a diagonal matrix. The arguments are those of a step.
  subroutine contact_stiffness(constants, reference, directions, stiffness, status)
    real(mslip_real), intent(in) :: constants(9)
    integer(mslip_int), intent(in) :: reference, directions
    real(mslip_real), intent(out) :: stiffness(:, :)
    integer(mslip_int), intent(out) :: status
    type(mslip_element), allocatable, target :: own
    type(mslip_element), pointer :: element
    real(mslip_real) :: compliance
    integer(mslip_int) :: i

    stiffness = 0
    call find_element(constants, [reference, directions], own, element, status)
    if (status /= MSLIP_OK) return
    stiffness(directions + 1, directions + 1) = element%normal_stiffness
    do i = 1, directions
      call mslip_element_displacement(element, i - 1, 0.0_mslip_real, constants(4), status, compliance=compliance)
      stiffness(i, i) = 1/compliance
    end do
  end subroutine contact_stiffness

  !> Errors of a trial displacement, not of the model: the program should try a shorter increment.
  pure logical function increment_too_long(status)
    integer(mslip_int), intent(in) :: status

    increment_too_long = any(status == [MSLIP_BAD_DISPLACEMENT, MSLIP_LENGTH_TOO_SHORT])
  end function increment_too_long

  subroutine find_element(constants, choices, own, element, status)
    real(mslip_real), intent(in) :: constants(9)
    integer(mslip_int), intent(in) :: choices(2)
    type(mslip_element), intent(out), allocatable, target :: own
    type(mslip_element), intent(out), pointer :: element
    integer(mslip_int), intent(out) :: status
    type(mslip_parameters) :: p
    integer :: i
    logical :: keep

    keep = .false.
    !$ keep = .true.
    status = MSLIP_OK
    if (keep) then
      do i = 1, places
        element => kept(i)%element
        if (all(kept(i)%choices == choices) .and. .not. any(abs(kept(i)%constants - constants) > 0)) return
      end do
    end if
    p = mslip_parameters(flat_half_width=constants(1), edge_radius=constants(2), length=constants(3), normal_force=constants(4), &
      friction_coefficient=constants(5), material=[mslip_material(constants(6), constants(7)), &
      mslip_material(constants(8), constants(9))], displacement_reference=choices(1))
    allocate (own)
    element => own
    call mslip_element_init(p, choices(2), MSLIP_INPUT_APPROACH, own, status)
    if (status /= MSLIP_OK .or. .not. keep) return
    last = modulo(last, places) + 1
    kept(last) = kept_element(constants, choices, own)
    element => kept(last)%element
  end subroutine find_element

end module contact_point
