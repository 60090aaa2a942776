!> The friction contacts of a model, each with the microslip law or as a spring-slider. All calls of the library that a
!> harmonic balance or a time integration needs are in this module:
!>
!>     once            mslip_contact_init, mslip_harmonic_workspace_init        in prepare
!>     balance         mslip_batch_harmonic_force                               in harmonic_force
!>     time step       mslip_state_init, mslip_batch_masing_update              in start_history, try_step
!>     results         mslip_monotonic_force, mslip_state_error                 in min_stick_half_width, force_error
module friction_contacts
  use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
  use basics, only: fail, name_length, wp
  use fourier_series, only: series_basis
  use microslip
  use spring_slider, only: make_slider_tables, slider, slider_harmonic_force, slider_step, slider_tables
  implicit none
  private

  character(len=*), parameter, public :: law_microslip = 'microslip', law_slider = 'spring-slider'

  type, public :: contact_input
    character(len=name_length) :: name = ' '
    character(len=name_length) :: law = ' '
    integer :: dof(2) = -1                !! relative displacement: first minus second; 0 is the ground
    integer :: count = 1                  !! number of identical contacts that share the displacement
    logical :: load_varied = .true.       !! the load factor multiplies the normal force
    type(mslip_parameters) :: parameters
  end type contact_input

  type, public :: contact_set
    character(len=name_length), allocatable :: name(:)
    integer, allocatable :: count(:)
    integer(mslip_int), allocatable :: active(:)            !! 1: microslip law, 0: spring-slider
    type(mslip_contact), allocatable :: prepared(:)
    type(slider), allocatable :: sliders(:)                 !! with initial stiffness and slip force of the microslip contacts
    type(slider_tables) :: tables                           !! of the spring-sliders
    real(wp), allocatable :: workspace(:)                   !! of the microslip law
    real(wp), allocatable :: fine_basis(:,:)                !! Fourier functions at the instants searched for extremes
  contains
    procedure :: prepare
    procedure :: harmonic_force
    procedure :: start_history
    procedure :: try_step
    procedure :: steady_cycle
    procedure :: min_stick_half_width
    procedure :: force_error
  end type contact_set

  !> Load history of all contacts up to an instant.
  type, public :: contact_history
    real(wp), allocatable :: states(:,:)                    !! of the microslip law
    real(wp), allocatable :: displacement(:), force(:)      !! of the spring-sliders
  end type contact_history

  !> Nested reversals that a state holds exactly. A steady state with some harmonics has a few.
  integer(mslip_size), parameter, public :: max_reversals = 32

contains

  !> `load_factor` multiplies the normal force of the contacts with `load_varied`.
  subroutine prepare(self, inputs, load_factor, harmonics, samples)
    class(contact_set), intent(inout) :: self
    type(contact_input), intent(in) :: inputs(:)
    real(wp), intent(in) :: load_factor
    integer, intent(in) :: harmonics, samples
    type(mslip_parameters) :: parameters
    integer(mslip_size) :: h, n
    integer(mslip_int) :: status
    integer :: i

    if (mslip_abi_version() /= MSLIP_MODULE_ABI_VERSION) call fail('libmicroslip and the module are of different versions')
    self%name = inputs%name
    self%count = inputs%count
    self%active = merge(1_mslip_int, 0_mslip_int, inputs%law == law_microslip)
    self%prepared = [(mslip_contact(), i=1, size(inputs))]
    do i = 1, size(inputs)
      parameters = inputs(i)%parameters
      if (inputs(i)%load_varied) parameters%normal_force = load_factor * parameters%normal_force
      call mslip_contact_init(parameters, self%prepared(i), status)
      call require(status, self%name(i))
    end do
    self%sliders = [(slider(self%prepared(i)%initial_stiffness, self%prepared(i)%slip_force), i=1, size(inputs))]

    h = harmonics
    n = samples
    if (allocated(self%workspace)) deallocate (self%workspace)
    allocate (self%workspace(mslip_harmonic_workspace_length(h, n)))
    call mslip_harmonic_workspace_init(h, n, self%workspace, status)
    call require(status, 'workspace')
    call make_slider_tables(harmonics, samples, self%tables)
    self%fine_basis = series_basis(harmonics, 256)
  end subroutine prepare

  !> Fourier coefficients of all contact forces from those of the displacements, (coefficient, contact), the exact Jacobian
  !> jacobian(:, :, i) = d force(:, i) / d displacement(:, i), and the energy dissipated per period.
  subroutine harmonic_force(self, displacement, force, jacobian, dissipated)
    class(contact_set), intent(inout) :: self
    real(wp), intent(in), contiguous :: displacement(:,:)
    real(wp), intent(out), contiguous :: force(:,:), jacobian(:,:,:), dissipated(:)
    integer(mslip_int) :: status
    integer :: i

    call mslip_batch_harmonic_force(self%prepared, self%workspace, displacement, status, active=self%active, &
                                    force=force, jacobian=jacobian, dissipated=dissipated)
    call require(status, 'contacts')
    do i = 1, size(self%count)
      if (self%active(i) == 0) then
        call slider_harmonic_force(self%sliders(i), self%tables, displacement(:, i), force(:, i), jacobian(:, :, i), &
                                   dissipated(i))
      end if
      force(:, i) = self%count(i) * force(:, i)
      jacobian(:, :, i) = self%count(i) * jacobian(:, :, i)
      dissipated(i) = self%count(i) * dissipated(i)
    end do
  end subroutine harmonic_force

  !> The unloaded contacts at displacement zero.
  subroutine start_history(self, history)
    class(contact_set), intent(in) :: self
    type(contact_history), intent(out) :: history
    integer(mslip_int) :: status
    integer :: i

    allocate (history%states(mslip_state_length(max_reversals), size(self%count)))
    allocate (history%displacement(size(self%count)), history%force(size(self%count)), source=0.0_wp)
    do i = 1, size(self%count)
      call mslip_state_init(history%states(:, i), status)
      call require(status, self%name(i))
    end do
  end subroutine start_history

  !> Forces and tangent stiffnesses after a trial step from `history`, which is not modified: a Newton iteration may try any
  !> displacement. `next` is the history to continue with if the step is accepted.
  subroutine try_step(self, history, displacement, force, stiffness, next)
    class(contact_set), intent(in) :: self
    type(contact_history), intent(in) :: history
    real(wp), intent(in), contiguous :: displacement(:)
    real(wp), intent(out), contiguous :: force(:), stiffness(:)
    type(contact_history), intent(inout) :: next
    real(wp) :: energy
    integer(mslip_int) :: status
    integer :: i

    if (.not. allocated(next%states)) next = history
    call mslip_batch_masing_update(self%prepared, history%states, displacement, next%states, status, &
                                   active=self%active, force=force, stiffness=stiffness)
    call require(status, 'contacts')
    do i = 1, size(self%count)
      if (self%active(i) == 0) then
        call slider_step(self%sliders(i), history%displacement(i), history%force(i), displacement(i), &
                         force(i), stiffness(i), energy)
      end if
    end do
    next%displacement = displacement
    next%force = force
    force = self%count * force
    stiffness = self%count * stiffness
  end subroutine try_step

  !> History and forces, (instant, contact), after two periods of a motion from the unloaded state: the second is steady.
  subroutine steady_cycle(self, displacement, history, force)
    class(contact_set), intent(in) :: self
    real(wp), intent(in) :: displacement(:,:)
    type(contact_history), intent(out) :: history
    real(wp), intent(out) :: force(:,:)
    type(contact_history) :: next
    real(wp), dimension(size(force, 2)) :: f, stiffness
    integer :: period, i

    call self%start_history(history)
    do period = 1, 2
      do i = 1, size(displacement, 1)
        call self%try_step(history, displacement(i, :), f, stiffness, next)
        history = next
        force(i, :) = f
      end do
    end do
  end subroutine steady_cycle

  !> Smallest half-width of the stick zone during a period, 0 in gross slip; NaN for a spring-slider.
  real(wp) function min_stick_half_width(self, i, coefficients) result(half_width)
    class(contact_set), intent(in) :: self
    integer, intent(in) :: i
    real(wp), intent(in) :: coefficients(:)
    real(wp) :: displacement(size(self%fine_basis, 1))
    integer(mslip_int) :: status

    half_width = ieee_value(half_width, ieee_quiet_nan)
    if (self%active(i) == 0) return
    ! Masing's rule: the branch between the extremes of a period has the stick zone of initial loading by half their distance.
    displacement = matmul(self%fine_basis, coefficients)
    call mslip_monotonic_force(self%prepared(i), 0.5_wp * (maxval(displacement) - minval(displacement)), status, &
                               stick_half_width=half_width)
    call require(status, self%name(i))
  end function min_stick_half_width

  !> Bound on the error of the forces of one contact (of `count` identical ones): reversals in excess of `max_reversals` are
  !> merged into others.
  real(wp) function force_error(self, history, i)
    class(contact_set), intent(in) :: self
    type(contact_history), intent(in) :: history
    integer, intent(in) :: i
    integer(mslip_int) :: status

    call mslip_state_error(history%states(:, i), force_error, status)
    call require(status, self%name(i))
  end function force_error

  subroutine require(status, name)
    integer(mslip_int), intent(in) :: status
    character(len=*), intent(in) :: name

    if (status /= MSLIP_OK) call fail('contact "'//trim(name)//'": '//mslip_status_text(status))
  end subroutine require
end module friction_contacts
