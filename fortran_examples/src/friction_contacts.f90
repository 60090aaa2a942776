!> The friction contacts of a model. All calls of the library that a harmonic balance or a time integration needs are in this
!> module:
!>
!>                     constant normal force                           varying normal force
!>     once            mslip_contact_init,                             mslip_element_init,
!>                     mslip_harmonic_workspace_init                   mslip_element_workspace_init       in prepare
!>     balance         mslip_batch_harmonic_force                      mslip_batch_element_harmonic_force in harmonic_force
!>     time step       mslip_state_init, mslip_batch_masing_update     mslip_element_state_init,
!>                                                                     mslip_batch_element_update         in start_history, try_step
!>     results         mslip_monotonic_force, mslip_state_error        mslip_normal_force, mslip_element_state_error
!>
!> A contact has one component, the tangential displacement; or two, that and the normal approach; or three, the displacements in
!> two tangential directions and the normal approach. The components of all contacts are numbered one after the other. An element
!> has two or three. A contact of constant normal force may have them as well; then its normal force is that of a linear spring and
!> does not change its friction. With three components the second tangential direction may be a linear spring or free instead.
module friction_contacts
  use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
  use basics, only: fail, name_length, pi, wp
  use fourier_series, only: series_basis
  use microslip
  use spring_slider, only: make_slider_tables, slider, slider_harmonic_force, slider_step, slider_tables
  implicit none
  private
  public :: add_incidence

  character(len=*), parameter, public :: law_microslip = 'microslip', law_slider = 'spring-slider', law_element = 'element'
  character(len=*), parameter, public :: with_friction = 'friction', with_spring = 'spring', without_force = 'free'
  integer, parameter, public :: max_components = 3

  type, public :: contact_input
    character(len=name_length) :: name = ' '
    character(len=name_length) :: law = ' '
    !> One component: the displacement is that of dof(1) minus that of dof(2). Two: (x, y) of the first body, dof(1:2), minus
    !> (x, y) of the second, dof(3:4). Three: (x, y, z) of each, z is the second tangential direction. 0 is the ground.
    integer :: dof(6) = -1
    real(wp) :: angle = 0.0_wp            !! from x to the tangential direction, degrees; the normal, 90 degrees ahead, points into
                                          !! the second body
    real(wp) :: interference = 0.0_wp     !! approach of the undeformed structure; a gap is negative
    character(len=name_length) :: second_direction = with_friction   !! of three components: friction, a spring, or free
    integer :: count = 1                  !! number of identical contacts that share the displacement
    logical :: load_varied = .true.       !! the load factor multiplies the normal force
    type(mslip_parameters) :: parameters = mslip_parameters()
  end type contact_input

  !> The elements with the same number of tangential directions: items of one call.
  type :: element_batch
    integer(mslip_int) :: directions = 0
    integer, allocatable :: contact(:)                      !! of each element
    integer, allocatable :: component(:,:)                  !! of each element, the normal one last
    type(mslip_element), allocatable :: elements(:)
    real(wp), allocatable :: workspace(:)
    ! Arguments of the calls, item after item.
    real(wp), allocatable :: u(:,:), f(:,:), df(:,:,:), energy(:), drift(:)
  end type element_batch

  type :: element_states
    real(wp), allocatable :: states(:,:)
  end type element_states

  type, public :: contact_set
    character(len=name_length), allocatable :: name(:)
    integer, allocatable :: count(:)
    integer, allocatable :: first(:), last(:)               !! components of each contact
    integer(mslip_int), allocatable :: active(:)            !! 1: microslip law, 0: another
    type(mslip_contact), allocatable :: prepared(:)         !! at the normal force of the case
    type(slider), allocatable :: sliders(:)                 !! with initial stiffness and slip force of the microslip contacts
    type(slider_tables) :: tables                           !! of the spring-sliders
    type(element_batch) :: batches(2)                       !! by the number of tangential directions
    real(wp), allocatable :: offset(:)                      !! of each component without any displacement of the structure
    real(wp), allocatable :: normal_stiffness(:)            !! of normal components, at the normal force of the case; else 0
    logical, allocatable :: is_linear(:)                    !! whether the force of a component is that of a spring,
    real(wp), allocatable :: spring(:)                      !! and its stiffness
    real(wp), allocatable :: workspace(:)
    integer :: periods = 3                                  !! before the returned one
    real(wp) :: drift = 0.0_wp                              !! the largest one of the elements in the last harmonic force
    real(wp), allocatable :: fine_basis(:,:)                !! Fourier functions at the instants searched for extremes
    ! Arguments of the calls, item after item.
    real(wp), allocatable, private :: u(:,:), f(:,:), df(:,:,:), energy(:)
  contains
    procedure :: prepare
    procedure :: harmonic_force
    procedure :: start_history
    procedure :: try_step
    procedure :: steady_cycle
    procedure :: min_stick_half_width
    procedure :: normal_extremes
    procedure :: force_error
    procedure, private :: find_element
  end type contact_set

  !> Load history of all contacts up to an instant.
  type, public :: contact_history
    real(wp), allocatable :: states(:,:)                    !! of the microslip law
    real(wp), allocatable :: displacement(:), force(:)      !! of the spring-sliders
    type(element_states) :: batches(2)
  end type contact_history

  !> Nested reversals, or pieces, that a state holds exactly. A steady state with some harmonics has a few.
  integer(mslip_size), parameter, public :: max_reversals = 32
  !> The force up to which elements are tabulated, relative to the normal force of the case.
  real(wp), parameter :: load_range = 4.0_wp

contains

  elemental integer function components(input)
    type(contact_input), intent(in) :: input
    components = 1 + merge(1, 0, input%dof(3) >= 0) + merge(1, 0, input%dof(5) >= 0)
  end function components

  !> The columns B of the components of a contact: displacement = B^T x, and forces on the structure = B f.
  pure subroutine add_incidence(input, columns)
    type(contact_input), intent(in) :: input
    real(wp), intent(inout) :: columns(:,:)
    real(wp) :: direction(3, 3)
    integer :: i, n

    n = components(input)
    if (n == 1) then
      do i = 1, 2
        if (input%dof(i) > 0) columns(input%dof(i), 1) = columns(input%dof(i), 1) + 3 - 2*i
      end do
    else
      direction = 0.0_wp
      direction(3, 2) = 1.0_wp
      associate (angle => input%angle * pi / 180.0_wp)
        direction(:2, 1) = [cos(angle), sin(angle)]
        direction(:, n) = [-sin(angle), cos(angle), 0.0_wp]
      end associate
      do i = 1, 2*n
        if (input%dof(i) > 0) columns(input%dof(i), :) = columns(input%dof(i), :) &
                                                         + merge(1, -1, i <= n) * direction(modulo(i - 1, n) + 1, :n)
      end do
    end if
  end subroutine add_incidence

  !> `load_factor` multiplies the normal force of the contacts with `load_varied`; `periods` are applied before the returned one.
  subroutine prepare(self, inputs, load_factor, harmonics, samples, periods)
    class(contact_set), intent(inout) :: self
    type(contact_input), intent(in) :: inputs(:)
    real(wp), intent(in) :: load_factor
    integer, intent(in) :: harmonics, samples, periods
    type(mslip_parameters) :: parameters
    type(mslip_element) :: element
    real(wp) :: normal_force, compliance
    integer(mslip_size) :: h, n
    integer(mslip_int) :: status, directions
    integer :: i, m, items

    if (mslip_abi_version() /= MSLIP_MODULE_ABI_VERSION) call fail('libmicroslip and the module are of different versions')
    items = size(inputs)
    h = harmonics
    n = samples
    m = 2 * harmonics + 1
    self%name = inputs%name
    self%count = inputs%count
    self%periods = periods
    self%last = [(sum(components(inputs(:i))), i=1, items)]
    self%first = self%last - components(inputs) + 1
    self%active = merge(1_mslip_int, 0_mslip_int, inputs%law == law_microslip)
    self%prepared = [(mslip_contact(), i=1, items)]
    do i = 1, size(self%batches)
      associate (batch => self%batches(i))
        batch%directions = int(i, mslip_int)
        batch%contact = [integer ::]
        batch%component = reshape([integer ::], [i + 1, 0])
        batch%elements = [mslip_element ::]
      end associate
    end do
    if (allocated(self%offset)) deallocate (self%offset, self%normal_stiffness, self%spring, self%is_linear)
    allocate (self%offset(self%last(items)), self%normal_stiffness(self%last(items)), self%spring(self%last(items)), source=0.0_wp)
    allocate (self%is_linear(self%last(items)), source=.false.)
    do i = 1, items
      parameters = inputs(i)%parameters
      if (inputs(i)%load_varied) parameters = under(parameters, load_factor * parameters%normal_force)
      call mslip_contact_init(parameters, self%prepared(i), status)
      call require(status, self%name(i))
      associate (first => self%first(i), last => self%last(i))
        if (last == first) cycle
        directions = 1
        if (last == first + 2) then
          if (inputs(i)%second_direction == with_friction) then
            directions = 2
          else
            self%is_linear(first + 1) = .true.
          end if
        end if
        normal_force = parameters%normal_force
        parameters = under(parameters, load_range * normal_force)
        call mslip_element_init(parameters, directions, MSLIP_INPUT_APPROACH, element, status)
        call require(status, self%name(i))
        call mslip_normal_approach(element, normal_force, status, compliance=compliance)
        call require(status, self%name(i))
        self%normal_stiffness(last) = inputs(i)%count / compliance
        if (last == first + 2 .and. inputs(i)%second_direction == with_spring) then
          self%spring(first + 1) = inputs(i)%count * second_stiffness(parameters, normal_force, self%name(i))
        end if
        self%offset(last) = inputs(i)%interference
        if (inputs(i)%law == law_element) then
          call add_element(self%batches(directions), i, [first, first + 1, last], element)
        else
          self%is_linear(last) = .true.
          self%spring(last) = self%normal_stiffness(last)
        end if
      end associate
    end do
    self%sliders = [(slider(self%prepared(i)%initial_stiffness, self%prepared(i)%slip_force), i=1, items)]

    if (allocated(self%workspace)) deallocate (self%workspace, self%u, self%f, self%df, self%energy)
    allocate (self%workspace(mslip_harmonic_workspace_length(h, n)))
    call mslip_harmonic_workspace_init(h, n, self%workspace, status)
    call require(status, 'workspace')
    allocate (self%u(m, items), self%f(m, items), self%df(m, m, items), self%energy(items))
    do i = 1, size(self%batches)
      associate (batch => self%batches(i))
        if (allocated(batch%workspace)) deallocate (batch%workspace, batch%u, batch%f, batch%df, batch%energy, batch%drift)
        allocate (batch%workspace(mslip_element_workspace_length(batch%directions, h, n)))
        call mslip_element_workspace_init(batch%directions, h, n, int(periods, mslip_size), batch%workspace, status)
        call require(status, 'workspace')
        items = size(batch%elements)
        allocate (batch%u((i + 1) * m, items), batch%f((i + 1) * m, items), batch%df((i + 1) * m, (i + 1) * m, items))
        allocate (batch%energy(items), batch%drift(items))
      end associate
    end do
    call make_slider_tables(harmonics, samples, self%tables)
    self%fine_basis = series_basis(harmonics, 256)
  end subroutine prepare

  !> The same contact, with the same layer, under another normal force.
  pure type(mslip_parameters) function under(parameters, normal_force) result(p)
    type(mslip_parameters), intent(in) :: parameters
    real(wp), intent(in) :: normal_force

    p = parameters
    p%normal_force = normal_force
    if (p%layer%reference_load <= 0.0_wp) p%layer%reference_load = parameters%normal_force
  end function under

  !> Stiffness of a stuck contact in the second tangential direction: that of the first small step after it is pressed.
  real(wp) function second_stiffness(parameters, normal_force, name) result(stiffness)
    type(mslip_parameters), intent(in) :: parameters
    real(wp), intent(in) :: normal_force
    character(len=*), intent(in) :: name
    integer(mslip_int), parameter :: directions = 2
    type(mslip_element) :: element
    real(wp) :: state(mslip_element_state_length(directions, max_reversals)), tangent(3, 3)
    integer(mslip_int) :: status

    tangent = 0.0_wp
    call mslip_element_init(parameters, directions, MSLIP_INPUT_NORMAL_FORCE, element, status)
    if (status == MSLIP_OK) call mslip_element_state_init(directions, state, status)
    if (status == MSLIP_OK) call mslip_element_advance(element, state, [0.0_wp, 0.0_wp, normal_force], status, tangent=tangent)
    call require(status, name)
    stiffness = tangent(2, 2)
  end function second_stiffness

  !> `places` are the components of the contact, of which an element of one tangential direction has the first and the last.
  subroutine add_element(batch, contact, places, element)
    type(element_batch), intent(inout) :: batch
    integer, intent(in) :: contact, places(3)
    type(mslip_element), intent(in) :: element
    integer :: items

    batch%contact = [batch%contact, contact]
    batch%elements = [batch%elements, element]
    items = size(batch%elements)
    if (batch%directions == 1) then
      batch%component = reshape([batch%component, places(1), places(3)], [2, items])
    else
      batch%component = reshape([batch%component, places], [3, items])
    end if
  end subroutine add_element

  !> Batch and number in it of the element of a contact; 0 if it has none.
  pure subroutine find_element(self, contact, batch, number)
    class(contact_set), intent(in) :: self
    integer, intent(in) :: contact
    integer, intent(out) :: batch, number

    do batch = size(self%batches), 1, -1
      number = findloc(self%batches(batch)%contact, contact, dim=1)
      if (number > 0) return
    end do
    batch = 0
  end subroutine find_element

  !> Fourier coefficients of all contact forces from those of the displacements, (coefficient, component), the exact Jacobian,
  !> and the energy dissipated per period by each contact. jacobian(:, :, p, j) has the derivatives of the force component p of a
  !> contact with respect to the displacement component j, which is one of that contact; others have none. A trial displacement
  !> far from any solution may press a contact beyond the range of the law: then `allowed` is false.
  subroutine harmonic_force(self, displacement, force, jacobian, dissipated, allowed)
    class(contact_set), intent(inout) :: self
    real(wp), intent(in), contiguous :: displacement(:,:)
    real(wp), intent(out), contiguous :: force(:,:), jacobian(:,:,:,:), dissipated(:)
    logical, intent(out) :: allowed
    integer(mslip_int) :: status
    integer :: i, j, k, m, e, p, q

    m = size(displacement, 1)
    self%u = displacement(:, self%first)
    call mslip_batch_harmonic_force(self%prepared, self%workspace, self%u, status, active=self%active, &
                                    force=self%f, jacobian=self%df, dissipated=self%energy)
    allowed = in_range(status)
    if (.not. allowed) return
    call require(status, 'contacts')
    jacobian = 0.0_wp
    self%drift = 0.0_wp
    do i = 1, size(self%count)
      j = self%first(i)
      do k = j, self%last(i)
        if (.not. self%is_linear(k)) cycle
        force(:, k) = self%spring(k) * displacement(:, k)
        do e = 1, m
          jacobian(e, e, k - j + 1, k) = self%spring(k)
        end do
      end do
      call self%find_element(i, p, e)
      if (e > 0) cycle
      if (self%active(i) == 0) then
        call slider_harmonic_force(self%sliders(i), self%tables, displacement(:, j), self%f(:, i), self%df(:, :, i), &
                                   self%energy(i))
      end if
      force(:, j) = self%count(i) * self%f(:, i)
      jacobian(:, :, 1, j) = self%count(i) * self%df(:, :, i)
      dissipated(i) = self%count(i) * self%energy(i)
    end do

    do i = 1, size(self%batches)
      associate (batch => self%batches(i))
        if (size(batch%elements) == 0) cycle
        do e = 1, size(batch%elements)
          batch%u(:, e) = reshape(displacement(:, batch%component(:, e)), [size(batch%u, 1)])
        end do
        call mslip_batch_element_harmonic_force(batch%elements, batch%workspace, batch%u, status, force=batch%f, &
                                                jacobian=batch%df, dissipated=batch%energy, drift=batch%drift)
        allowed = in_range(status)
        if (.not. allowed) return
        call require(status, 'elements')
        self%drift = max(self%drift, maxval(batch%drift))
        do e = 1, size(batch%elements)
          associate (count => self%count(batch%contact(e)), first => self%first(batch%contact(e)), places => batch%component(:, e))
            do q = 1, size(places)
              force(:, places(q)) = count * batch%f((q - 1) * m + 1:q * m, e)
              do p = 1, size(places)
                jacobian(:, :, places(p) - first + 1, places(q)) = &
                  count * batch%df((p - 1) * m + 1:p * m, (q - 1) * m + 1:q * m, e)
              end do
            end do
            dissipated(batch%contact(e)) = count * batch%energy(e)
          end associate
        end do
      end associate
    end do
  end subroutine harmonic_force

  !> The unloaded contacts at displacement zero; elements are open.
  subroutine start_history(self, history)
    class(contact_set), intent(in) :: self
    type(contact_history), intent(out) :: history
    integer(mslip_int) :: status
    integer :: i, e

    allocate (history%states(mslip_state_length(max_reversals), size(self%count)))
    allocate (history%displacement(size(self%count)), history%force(size(self%count)), source=0.0_wp)
    do i = 1, size(self%count)
      call mslip_state_init(history%states(:, i), status)
      call require(status, self%name(i))
    end do
    do i = 1, size(self%batches)
      associate (batch => self%batches(i))
        allocate (history%batches(i)%states(mslip_element_state_length(batch%directions, max_reversals), size(batch%elements)))
        do e = 1, size(batch%elements)
          call mslip_element_state_init(batch%directions, history%batches(i)%states(:, e), status)
          call require(status, self%name(batch%contact(e)))
        end do
      end associate
    end do
  end subroutine start_history

  !> Forces and tangent stiffnesses, both by component, after a trial step from `history`, which is not modified: a Newton
  !> iteration may try any displacement. `next` is the history to continue with if the step is accepted. `allowed` as in
  !> harmonic_force; without it such a displacement ends the program.
  subroutine try_step(self, history, displacement, force, tangent, next, allowed)
    class(contact_set), intent(in) :: self
    type(contact_history), intent(in) :: history
    real(wp), intent(in), contiguous :: displacement(:)
    real(wp), intent(out), contiguous :: force(:), tangent(:,:)
    type(contact_history), intent(inout) :: next
    logical, intent(out), optional :: allowed
    real(wp), dimension(size(self%count)) :: u, f, df
    real(wp), allocatable :: element_u(:,:), element_f(:,:), element_df(:,:,:)
    real(wp) :: energy
    integer(mslip_int) :: status
    integer :: i, j, e, items

    if (.not. allocated(next%states)) next = history
    u = displacement(self%first)
    f = 0.0_wp
    df = 0.0_wp
    call mslip_batch_masing_update(self%prepared, history%states, u, next%states, status, active=self%active, &
                                   force=f, stiffness=df)
    if (rejected()) return
    call require(status, 'contacts')
    tangent = 0.0_wp
    do i = 1, size(self%count)
      if (self%active(i) == 0) then
        call slider_step(self%sliders(i), history%displacement(i), history%force(i), u(i), f(i), df(i), energy)
      end if
      j = self%first(i)
      force(j) = self%count(i) * f(i)
      tangent(j, j) = self%count(i) * df(i)
    end do
    do j = 1, size(force)
      if (.not. self%is_linear(j)) cycle
      force(j) = self%spring(j) * displacement(j)
      tangent(j, j) = self%spring(j)
    end do
    next%displacement = u
    next%force = f

    do i = 1, size(self%batches)
      associate (batch => self%batches(i))
        items = size(batch%elements)
        if (items == 0) cycle
        element_u = reshape(displacement([batch%component]), [i + 1, items])
        element_f = element_u
        allocate (element_df(i + 1, i + 1, items))
        call mslip_batch_element_update(batch%elements, history%batches(i)%states, element_u, next%batches(i)%states, status, &
                                        force=element_f, tangent=element_df)
        if (rejected()) return
        call require(status, 'elements')
        do e = 1, items
          associate (count => self%count(batch%contact(e)), places => batch%component(:, e))
            force(places) = count * element_f(:, e)
            tangent(places, places) = count * element_df(:, :, e)
          end associate
        end do
        deallocate (element_df)
      end associate
    end do

  contains

    logical function rejected()
      rejected = .false.
      if (.not. present(allowed)) return
      allowed = in_range(status)
      rejected = .not. allowed
    end function rejected
  end subroutine try_step

  !> History and forces, (instant, component), in a period of a motion from the unloaded state, after those that are walked before.
  !> As in mslip_element_harmonic_force, elements start in the instant of the largest normal force, to which they are pressed
  !> and then displaced.
  subroutine steady_cycle(self, displacement, history, force)
    class(contact_set), intent(in) :: self
    real(wp), intent(in) :: displacement(:,:)
    type(contact_history), intent(out) :: history
    real(wp), intent(out) :: force(:,:)
    type(contact_history) :: next
    real(wp) :: f(size(force, 2)), tangent(size(force, 2), size(force, 2)), pressed(max_components)
    integer(mslip_int) :: status
    integer :: period, largest, i, b, e, m

    call self%start_history(history)
    pressed = 0.0_wp
    do b = 1, size(self%batches)
      m = b + 1
      do e = 1, size(self%batches(b)%elements)
        associate (motion => displacement(:, self%batches(b)%component(:, e)), element => self%batches(b)%elements(e), &
                   state => history%batches(b)%states(:, e))
          largest = maxloc(motion(:, m), dim=1)
          pressed(m) = motion(largest, m)
          call mslip_element_advance(element, state, pressed(:m), status)
          pressed(m) = 0.0_wp
          do i = largest, size(motion, 1)
            if (status == MSLIP_OK) call mslip_element_advance(element, state, motion(i, :), status)
          end do
        end associate
        call require(status, self%name(self%batches(b)%contact(e)))
      end do
    end do
    do period = 0, self%periods
      do i = 1, size(displacement, 1)
        call self%try_step(history, displacement(i, :), f, tangent, next)
        history = next
        force(i, :) = f
      end do
    end do
  end subroutine steady_cycle

  !> Smallest half-width of the stick zone during a period, 0 in gross slip, of a contact with constant normal force; NaN for
  !> others.
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

  !> Smallest and largest normal force of a contact of two or three components during a period, and the fraction of the period in
  !> which it is open; `coefficients` are those of the approach.
  subroutine normal_extremes(self, i, coefficients, smallest, largest, open_fraction)
    class(contact_set), intent(in) :: self
    integer, intent(in) :: i
    real(wp), intent(in) :: coefficients(:)
    real(wp), intent(out) :: smallest, largest, open_fraction
    real(wp), dimension(size(self%fine_basis, 1)) :: approach, normal_force
    integer(mslip_int) :: status
    integer :: b, e

    approach = matmul(self%fine_basis, coefficients)
    normal_force = self%normal_stiffness(self%last(i)) * approach
    open_fraction = 0.0_wp
    call self%find_element(i, b, e)
    if (e > 0) then
      call mslip_normal_force(self%batches(b)%elements(e), approach, status, normal_force=normal_force)
      call require(status, self%name(i))
      normal_force = self%count(i) * normal_force
      open_fraction = count(approach <= 0.0_wp) / real(size(approach), wp)
    end if
    smallest = minval(normal_force)
    largest = maxval(normal_force)
  end subroutine normal_extremes

  !> Bound on the error of the forces of one contact (of `count` identical ones): reversals in excess of `max_reversals` are
  !> merged into others.
  real(wp) function force_error(self, history, i)
    class(contact_set), intent(in) :: self
    type(contact_history), intent(in) :: history
    integer, intent(in) :: i
    integer(mslip_int) :: status
    integer :: b, e

    call self%find_element(i, b, e)
    if (e > 0) then
      call mslip_element_state_error(self%batches(b)%directions, history%batches(b)%states(:, e), force_error, status)
    else
      call mslip_state_error(history%states(:, i), force_error, status)
    end if
    call require(status, self%name(i))
  end function force_error

  !> Whether the status of a call is not that of a displacement beyond the range of the law: a contact as wide as it is long, or
  !> a displacement that is not finite.
  pure logical function in_range(status)
    integer(mslip_int), intent(in) :: status
    in_range = all(status /= [MSLIP_LENGTH_TOO_SHORT, MSLIP_BAD_DISPLACEMENT])
  end function in_range

  subroutine require(status, name)
    integer(mslip_int), intent(in) :: status
    character(len=*), intent(in) :: name

    if (status /= MSLIP_OK) call fail('contact "'//trim(name)//'": '//mslip_status_text(status))
  end subroutine require
end module friction_contacts
