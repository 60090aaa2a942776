!> All friction contacts of a model, each with the microslip law or as a spring-slider.
module friction_contacts
  use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
  use fourier_series, only: series_basis
  use kinds, only: name_length, wp
  use messages, only: fail
  use microslip
  use spring_slider, only: make_slider_tables, slider, slider_harmonic_force, slider_step, slider_tables
  implicit none
  private

  character(len=*), parameter, public :: law_microslip = 'microslip', law_slider = 'spring-slider'

  !> Input data of one contact.
  type, public :: contact_input
    character(len=name_length) :: name = ' '
    character(len=name_length) :: law = ' '
    integer :: dof(2) = -1                !! relative displacement: first minus second; 0 is the ground
    integer :: count = 1                  !! number of identical contacts that share the displacement
    logical :: load_varied = .true.       !! the normal force is multiplied by the load factor
    real(wp) :: spring_stiffness = 0.0_wp !! of a spring-slider; 0: the initial stiffness of the microslip law
    type(mslip_parameters) :: parameters
  end type contact_input

  type, public :: contact_set
    character(len=name_length), allocatable :: name(:)
    integer, allocatable :: count(:)
    integer(mslip_int), allocatable :: has_microslip(:)     !! 1 or 0: the flags `active` of the batch calls
    type(mslip_contact), allocatable :: prepared(:)
    type(slider), allocatable :: sliders(:)
    type(slider_tables) :: tables                           !! of the spring-sliders
    real(wp), allocatable :: workspace(:)                   !! of the microslip law
    real(wp), allocatable :: extremes_basis(:,:)            !! series at the points searched for the extremes of a displacement
  contains
    procedure :: prepare
    procedure :: prepare_harmonics
    procedure :: initial_stiffness
    procedure :: harmonic_force
    procedure :: steady_loop
    procedure :: min_stick_half_width
    procedure :: start_history
    procedure :: force_error
    procedure :: try_step
  end type contact_set

  !> Load history of all contacts up to an instant.
  type, public :: contact_history
    real(wp), allocatable :: states(:,:)                    !! of the microslip law
    real(wp), allocatable :: displacement(:), force(:)      !! of the spring-sliders
  end type contact_history

  ! Nested reversals that a state holds exactly. A steady state with some harmonics needs a few.
  integer(mslip_size), parameter, public :: max_reversals = 32
  integer, parameter :: extremes_points = 256

contains

  !> `load_factor` multiplies the normal force of the contacts that allow it.
  subroutine prepare(self, inputs, load_factor)
    class(contact_set), intent(inout) :: self
    type(contact_input), intent(in) :: inputs(:)
    real(wp), intent(in) :: load_factor
    type(mslip_parameters) :: parameters
    integer(mslip_int) :: status
    integer :: i

    if (mslip_abi_version() /= MSLIP_MODULE_ABI_VERSION) then
      call fail('libmicroslip and the module microslip are of different versions: rebuild with one installation')
    end if
    self%name = inputs%name
    self%count = inputs%count
    self%has_microslip = merge(1_mslip_int, 0_mslip_int, inputs%law == law_microslip)
    self%prepared = [(mslip_contact(), i=1, size(inputs))]
    self%sliders = [(slider(), i=1, size(inputs))]
    do i = 1, size(inputs)
      parameters = inputs(i)%parameters
      if (inputs(i)%load_varied) parameters%normal_force = load_factor * parameters%normal_force
      if (inputs(i)%law == law_microslip .or. inputs(i)%spring_stiffness <= 0.0_wp) then
        call mslip_contact_init(parameters, self%prepared(i), status)
        call require(status, self%name(i))
      end if
      if (inputs(i)%law == law_slider) then
        self%sliders(i)%slip_force = parameters%friction_coefficient * parameters%normal_force
        self%sliders(i)%stiffness = inputs(i)%spring_stiffness
        if (inputs(i)%spring_stiffness <= 0.0_wp) self%sliders(i)%stiffness = self%prepared(i)%initial_stiffness
      end if
    end do
  end subroutine prepare

  subroutine prepare_harmonics(self, harmonics, samples)
    class(contact_set), intent(inout) :: self
    integer, intent(in) :: harmonics, samples
    integer(mslip_int) :: status

    call make_slider_tables(harmonics, samples, self%tables)
    self%extremes_basis = series_basis(harmonics, extremes_points)
    if (allocated(self%workspace)) deallocate (self%workspace)
    allocate (self%workspace(mslip_harmonic_workspace_length(int(harmonics, mslip_size), int(samples, mslip_size))))
    call mslip_harmonic_workspace_init(int(harmonics, mslip_size), int(samples, mslip_size), self%workspace, status)
    if (status /= MSLIP_OK) call fail(mslip_status_text(status))
  end subroutine prepare_harmonics

  !> Coefficients of all contact forces; jacobian(:, :, i) is d force(:, i) / d displacement(:, i).
  subroutine harmonic_force(self, displacement, force, jacobian, dissipated)
    class(contact_set), intent(inout) :: self
    real(wp), intent(in), contiguous :: displacement(:,:)
    real(wp), intent(out), contiguous :: force(:,:), jacobian(:,:,:), dissipated(:)
    integer(mslip_int) :: status
    integer :: i

    if (any(self%has_microslip == 1)) then
      call mslip_batch_harmonic_force(self%prepared, self%workspace, displacement, status, &
                                      active=self%has_microslip, force=force, jacobian=jacobian, dissipated=dissipated)
      call require(status, 'contacts')
    end if
    do i = 1, size(self%count)
      if (self%has_microslip(i) == 0) then
        call slider_harmonic_force(self%sliders(i), self%tables, displacement(:, i), force(:, i), jacobian(:, :, i), &
                                   dissipated(i))
      end if
      if (self%count(i) > 1) then
        force(:, i) = self%count(i) * force(:, i)
        jacobian(:, :, i) = self%count(i) * jacobian(:, :, i)
        dissipated(i) = self%count(i) * dissipated(i)
      end if
    end do
  end subroutine harmonic_force

  !> Stiffness of one contact (of `count` identical ones) before any slip.
  pure real(wp) function initial_stiffness(self, i)
    class(contact_set), intent(in) :: self
    integer, intent(in) :: i

    if (self%has_microslip(i) == 1) then
      initial_stiffness = self%prepared(i)%initial_stiffness
    else
      initial_stiffness = self%sliders(i)%stiffness
    end if
  end function initial_stiffness

  !> Displacement and force of one contact (of `count` identical ones) over one period of a steady state.
  subroutine steady_loop(self, i, coefficients, displacement, force)
    class(contact_set), intent(in) :: self
    integer, intent(in) :: i
    real(wp), intent(in) :: coefficients(:)
    real(wp), intent(out) :: displacement(:), force(:)
    real(wp) :: two_periods(2 * size(displacement)), state(mslip_state_length(max_reversals))
    real(wp) :: basis(size(displacement), size(coefficients)), history(2 * size(displacement))
    real(wp) :: u0, f0, tangent, energy
    integer(mslip_int) :: status
    integer :: n, j

    n = size(displacement)
    basis = series_basis(size(coefficients) / 2, n)
    displacement = matmul(basis, coefficients)
    two_periods = [displacement, displacement]
    if (self%has_microslip(i) == 1) then
      call mslip_state_init(state, status)
      if (status == MSLIP_OK) call mslip_masing_path_advance(self%prepared(i), state, two_periods, status, force=history)
      call require(status, self%name(i))
    else
      u0 = 0.0_wp
      f0 = 0.0_wp
      do j = 1, size(two_periods)
        call slider_step(self%sliders(i), u0, f0, two_periods(j), history(j), tangent, energy)
        u0 = two_periods(j)
        f0 = history(j)
      end do
    end if
    force = history(n + 1:)
  end subroutine steady_loop

  !> Smallest half-width of the stick zone during a period, 0 in gross slip; NaN for a spring-slider.
  function min_stick_half_width(self, i, coefficients) result(half_width)
    class(contact_set), intent(in) :: self
    integer, intent(in) :: i
    real(wp), intent(in) :: coefficients(:)
    real(wp) :: half_width
    real(wp) :: displacement(extremes_points)
    integer(mslip_int) :: status

    half_width = ieee_value(half_width, ieee_quiet_nan)
    if (self%has_microslip(i) == 0) return
    ! By Masing's rule the branch between the extremes of a period has the stick zone of initial loading by half their
    ! distance.
    displacement = matmul(self%extremes_basis, coefficients)
    call mslip_monotonic_force(self%prepared(i), 0.5_wp * (maxval(displacement) - minval(displacement)), status, &
                               stick_half_width=half_width)
    call require(status, self%name(i))
  end function min_stick_half_width

  !> Load history and forces after a periodic motion from the unloaded state. `period` has the displacements of all
  !> contacts over one period, (instant, contact), and ends with the present instant.
  subroutine start_history(self, period, history, force)
    class(contact_set), intent(in) :: self
    real(wp), intent(in) :: period(:,:)
    type(contact_history), intent(out) :: history
    real(wp), intent(out) :: force(:)
    type(contact_history) :: next
    real(wp) :: stiffness(size(force))
    integer(mslip_int) :: status
    integer :: repetition, i, j

    allocate (history%states(mslip_state_length(max_reversals), size(force)))
    allocate (history%displacement(size(force)), history%force(size(force)), source=0.0_wp)
    do i = 1, size(force)
      call mslip_state_init(history%states(:, i), status)
      call require(status, self%name(i))
    end do
    next = history
    do repetition = 1, 2
      do j = 1, size(period, 1)
        call self%try_step(history, period(j, :), force, stiffness, next)
        history = next
      end do
    end do
  end subroutine start_history

  !> Bound on the error of the forces of one contact (of `count` identical ones) due to reversals that did not fit into its
  !> state and were merged.
  real(wp) function force_error(self, history, i)
    class(contact_set), intent(in) :: self
    type(contact_history), intent(in) :: history
    integer, intent(in) :: i
    integer(mslip_int) :: status

    force_error = 0.0_wp
    if (self%has_microslip(i) == 0) return
    call mslip_state_error(history%states(:, i), force_error, status)
    call require(status, self%name(i))
  end function force_error

  !> Forces and tangent stiffnesses after a trial step from `history`, which is not modified; `next` is the history to
  !> continue with if the step is accepted.
  subroutine try_step(self, history, displacement, force, stiffness, next)
    class(contact_set), intent(in) :: self
    type(contact_history), intent(in) :: history
    real(wp), intent(in), contiguous :: displacement(:)
    real(wp), intent(out), contiguous :: force(:), stiffness(:)
    type(contact_history), intent(inout) :: next
    real(wp) :: energy
    integer(mslip_int) :: status
    integer :: i

    if (any(self%has_microslip == 1)) then
      call mslip_batch_masing_update(self%prepared, history%states, displacement, next%states, status, &
                                     active=self%has_microslip, force=force, stiffness=stiffness)
      call require(status, 'contacts')
    end if
    do i = 1, size(self%count)
      if (self%has_microslip(i) == 0) then
        call slider_step(self%sliders(i), history%displacement(i), history%force(i), displacement(i), &
                         force(i), stiffness(i), energy)
      end if
    end do
    next%displacement = displacement
    next%force = force
    force = self%count * force
    stiffness = self%count * stiffness
  end subroutine try_step

  subroutine require(status, name)
    integer(mslip_int), intent(in) :: status
    character(len=*), intent(in) :: name

    if (status /= MSLIP_OK) call fail('contact "'//trim(name)//'": '//mslip_status_text(status))
  end subroutine require
end module friction_contacts
