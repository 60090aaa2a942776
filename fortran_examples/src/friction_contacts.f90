!> The friction contacts of a model. All calls of the library that a harmonic balance or a time integration needs are here:
!>
!>     once            mslip_contact_init, mslip_harmonic_workspace_init      in prepare
!>     balance         mslip_harmonic_force                                   in harmonic_force
!>     time step       mslip_state_init, mslip_masing_update                  in start_history, try_step
!>
!> Contacts under a varying normal force have the same calls with mslip_element_* (static_first.f90). A solver with thousands of
!> contacts calls mslip_batch_* in place of these loops (contact_threads.f90).
module friction_contacts
  use basics, only: fail, name_length, wp
  use fourier_series, only: series_basis
  use microslip
  implicit none
  private

  character(len=*), parameter, public :: law_microslip = 'microslip', law_slider = 'spring-slider'

  type, public :: friction_contact
    character(len=name_length) :: name = ' ', law = ' '
    integer :: dof(2) = -1             !! the displacement is that of dof(1) minus that of dof(2); 0 is the ground
    integer :: count = 1               !! number of identical contacts that share the displacement
    logical :: load_varied = .true.    !! the load factor multiplies the normal force
    type(mslip_parameters) :: parameters
    type(mslip_contact) :: contact     !! made by `prepare`; also has stiffness and slip force of the spring-slider
  end type friction_contact

  type, public :: contact_set
    type(friction_contact), allocatable :: items(:)
    real(wp), allocatable :: workspace(:), basis(:,:)
  contains
    procedure :: prepare
    procedure :: harmonic_force
    procedure :: start_history
    procedure :: try_step
    procedure :: steady_cycle
  end type contact_set

  !> Nested reversals that a state holds exactly. A steady state with some harmonics has a few.
  integer(mslip_size), parameter :: max_reversals = 32

contains

  !> `load_factor` multiplies the normal force of the contacts with `load_varied`.
  subroutine prepare(self, items, load_factor, harmonics, samples)
    class(contact_set), intent(inout) :: self
    type(friction_contact), intent(in) :: items(:)
    real(wp), intent(in) :: load_factor
    integer, intent(in) :: harmonics, samples
    type(mslip_parameters) :: p
    integer(mslip_size) :: h, n
    integer(mslip_int) :: status
    integer :: i

    self%items = items
    self%basis = series_basis(harmonics, samples)
    do i = 1, size(items)
      p = items(i)%parameters
      if (items(i)%load_varied) p%normal_force = load_factor * p%normal_force
      call mslip_contact_init(p, self%items(i)%contact, status)
      call require(status, items(i)%name)
    end do
    h = harmonics
    n = samples
    self%workspace = [(0.0_wp, i=1, int(mslip_harmonic_workspace_length(h, n)))]
    call mslip_harmonic_workspace_init(h, n, self%workspace, status)
    call require(status, 'workspace')
  end subroutine prepare

  !> Fourier coefficients of all contact forces from those of the displacements, (coefficient, contact), the exact Jacobian of each
  !> contact, and the energy that it dissipates per period.
  subroutine harmonic_force(self, displacement, force, jacobian, dissipated)
    class(contact_set), intent(inout) :: self
    real(wp), intent(in) :: displacement(:,:)
    real(wp), intent(out) :: force(:,:), jacobian(:,:,:), dissipated(:)
    integer(mslip_int) :: status
    integer :: i

    do i = 1, size(self%items)
      associate (c => self%items(i))
        if (c%law == law_microslip) then
          call mslip_harmonic_force(c%contact, self%workspace, displacement(:, i), status, force(:, i), jacobian(:, :, i), &
                                    dissipated(i))
          call require(status, c%name)
        else
          call slider_harmonic_force(c%contact, self%basis, displacement(:, i), force(:, i), jacobian(:, :, i), dissipated(i))
        end if
        force(:, i) = c%count * force(:, i)
        jacobian(:, :, i) = c%count * jacobian(:, :, i)
        dissipated(i) = c%count * dissipated(i)
      end associate
    end do
  end subroutine harmonic_force

  !> States of the unloaded contacts at displacement zero, (double, contact); those of a spring-slider are displacement and force.
  subroutine start_history(self, states)
    class(contact_set), intent(in) :: self
    real(wp), allocatable, intent(out) :: states(:,:)
    integer(mslip_int) :: status
    integer :: i

    allocate (states(mslip_state_length(max_reversals), size(self%items)), source=0.0_wp)
    do i = 1, size(self%items)
      if (self%items(i)%law /= law_microslip) cycle
      call mslip_state_init(states(:, i), status)
      call require(status, self%items(i)%name)
    end do
  end subroutine start_history

  !> Forces and tangent stiffnesses after a trial step from the states `before`, which are not modified: a Newton iteration may try
  !> any displacement. `after` are the states to continue with if the step is accepted.
  subroutine try_step(self, before, displacement, after, force, tangent)
    class(contact_set), intent(in) :: self
    real(wp), intent(in) :: before(:,:), displacement(:)
    real(wp), intent(inout) :: after(:,:)
    real(wp), intent(out) :: force(:), tangent(:)
    integer(mslip_int) :: status
    integer :: i

    do i = 1, size(self%items)
      associate (c => self%items(i))
        if (c%law == law_microslip) then
          call mslip_masing_update(c%contact, before(:, i), displacement(i), after(:, i), status, force(i), tangent(i))
          call require(status, c%name)
        else
          call slider_step(c%contact, before(:2, i), displacement(i), after(:2, i), tangent(i))
          force(i) = after(2, i)
        end if
        force(i) = c%count * force(i)
        tangent(i) = c%count * tangent(i)
      end associate
    end do
  end subroutine try_step

  !> States, and forces (instant, contact), in the second period of a motion from the unloaded state.
  subroutine steady_cycle(self, displacement, states, force)
    class(contact_set), intent(in) :: self
    real(wp), intent(in) :: displacement(:,:)
    real(wp), allocatable, intent(out) :: states(:,:)
    real(wp), intent(out) :: force(:,:)
    real(wp), allocatable :: next(:,:)
    real(wp) :: tangent(size(force, 2))
    integer :: period, i

    call self%start_history(states)
    next = states
    do period = 1, 2
      do i = 1, size(displacement, 1)
        call self%try_step(states, displacement(i, :), next, force(i, :), tangent)
        states = next
      end do
    end do
  end subroutine steady_cycle

  !> The spring-slider (Jenkins element) of the same initial stiffness and slip force; states are displacement and force.
  pure subroutine slider_step(contact, before, displacement, after, tangent)
    type(mslip_contact), intent(in) :: contact
    real(wp), intent(in) :: before(2), displacement
    real(wp), intent(out) :: after(2), tangent
    real(wp) :: elastic

    elastic = before(2) + contact%initial_stiffness * (displacement - before(1))
    after = [displacement, max(-contact%slip_force, min(contact%slip_force, elastic))]
    tangent = merge(contact%initial_stiffness, 0.0_wp, abs(elastic) < contact%slip_force)
  end subroutine slider_step

  !> Its harmonic force by the alternating frequency/time method: uniform samples from t = 0, the second of two periods.
  pure subroutine slider_harmonic_force(contact, basis, coefficients, force, jacobian, dissipated)
    type(mslip_contact), intent(in) :: contact
    real(wp), intent(in) :: basis(:,:), coefficients(:)
    real(wp), intent(out) :: force(:), jacobian(:,:), dissipated
    real(wp), dimension(size(basis, 1), size(basis, 2)) :: weight, slope
    real(wp), dimension(size(basis, 1)) :: displacement, history
    real(wp) :: state(2), next(2), tangent, elastic
    integer :: period, i, anchor

    weight = 2.0_wp / size(basis, 1) * basis
    weight(:, 1) = 0.5_wp * weight(:, 1)
    displacement = matmul(basis, coefficients)
    state = 0.0_wp
    anchor = 0
    do period = 1, 2
      dissipated = 0.0_wp
      do i = 1, size(basis, 1)
        call slider_step(contact, state, displacement(i), next, tangent)
        elastic = state(2) + contact%initial_stiffness * (displacement(i) - state(1))
        dissipated = dissipated + contact%slip_force * abs(elastic - next(2)) / contact%initial_stiffness
        state = next
        history(i) = state(2)
        if (.not. tangent > 0.0_wp) anchor = i
        ! In slip the force is constant; a sticking sample has f = f(anchor) + k (u - u(anchor)), anchor the last in slip.
        slope(i, :) = 0.0_wp
        if (tangent > 0.0_wp) slope(i, :) = tangent * basis(i, :)
        if (tangent > 0.0_wp .and. anchor > 0) slope(i, :) = slope(i, :) - tangent * basis(anchor, :)
      end do
    end do
    force = matmul(history, weight)
    jacobian = matmul(transpose(weight), slope)
  end subroutine slider_harmonic_force

  subroutine require(status, name)
    integer(mslip_int), intent(in) :: status
    character(len=*), intent(in) :: name

    if (status /= MSLIP_OK) call fail('contact "'//trim(name)//'": '//mslip_status_text(status))
  end subroutine require
end module friction_contacts
