!> The friction contacts of a model. All calls of the library that a harmonic balance or a time integration needs are in this module:
!>
!>                     constant normal force                           varying normal force
!>     once            mslip_contact_init,                             mslip_element_init,
!>                     mslip_harmonic_workspace_init                   mslip_element_workspace_init      in prepare
!>     balance         mslip_harmonic_force                            mslip_element_harmonic_force      in harmonic_force
!>     time step       mslip_state_init, mslip_masing_update           mslip_element_state_init,
!>                                                                     mslip_element_update              in start_history, try_step
!>
!> A contact has one component, the tangential displacement. An element has two, that and the normal approach. The components of all
!> contacts are numbered one after the other. Elements with two tangential directions are in static_first.f90.
!> A solver with thousands of contacts calls mslip_batch_* in place of these loops (contact_threads.f90).
module friction_contacts
  use basics, only: fail, name_length, pi, wp
  use fourier_series, only: series_basis
  use microslip
  implicit none
  private

  character(len=*), parameter, public :: law_microslip = 'microslip', law_slider = 'spring-slider', law_element = 'element'
  integer, parameter, public :: max_components = 2

  type, public :: friction_contact
    character(len=name_length) :: name = ' '
    character(len=name_length) :: law = ' '
    !> One component: the displacement is that of dof(1) minus that of dof(2). Two: (x, y) of the first body, dof(1:2), minus
    !> (x, y) of the second, dof(3:4). 0 is the ground.
    integer :: dof(4) = -1
    real(wp) :: angle = 0.0_wp            !! from x to the tangential direction, degrees; the normal, 90 degrees ahead, points into
                                          !! the second body
    real(wp) :: interference = 0.0_wp     !! approach of the undeformed structure; a gap is negative
    integer :: count = 1                  !! number of identical contacts that share the displacement
    logical :: load_varied = .true.       !! the load factor multiplies the normal force
    type(mslip_parameters) :: parameters
    ! From here on made by `prepare`.
    integer :: first = 0, last = 0        !! components
    type(mslip_contact) :: contact        !! also has stiffness and slip force of the spring-slider
    type(mslip_element) :: element
    real(wp) :: normal_stiffness = 0.0_wp !! of the element under the normal force of the case
  end type friction_contact

  type, public :: contact_set
    type(friction_contact), allocatable :: items(:)
    integer :: components = 0, periods = 3                  !! periods before the returned one
    real(wp) :: drift = 0.0_wp                              !! the largest of the elements in the last harmonic force
    real(wp), allocatable :: workspace(:), element_workspace(:), basis(:,:)
  contains
    procedure :: prepare
    procedure :: harmonic_force
    procedure :: start_history
    procedure :: try_step
    procedure :: steady_cycle
    procedure :: normal_extremes
  end type contact_set

  !> Load history of all contacts up to an instant, (double, contact); of a spring-slider displacement and force.
  type, public :: contact_history
    real(wp), allocatable :: states(:,:)
  end type contact_history

  !> Nested reversals, or pieces, that a state holds exactly. A steady state with some harmonics has a few.
  integer(mslip_size), parameter, public :: max_reversals = 32
  !> The force up to which elements are tabulated, relative to the normal force of the case.
  real(wp), parameter :: load_range = 4.0_wp
  integer(mslip_int), parameter :: directions = 1

contains

  !> `load_factor` multiplies the normal force of the contacts with `load_varied`; `periods` are applied before the returned one.
  !> `incidence` B has the components of the contacts: displacement = B^T x, and forces on the structure = B f.
  subroutine prepare(self, items, load_factor, harmonics, samples, periods, dofs, incidence)
    class(contact_set), intent(inout) :: self
    type(friction_contact), intent(in) :: items(:)
    real(wp), intent(in) :: load_factor
    integer, intent(in) :: harmonics, samples, periods, dofs
    real(wp), allocatable, intent(out) :: incidence(:,:)
    type(mslip_parameters) :: p
    real(wp) :: compliance
    integer(mslip_size) :: h, n
    integer(mslip_int) :: status
    integer :: i

    if (mslip_abi_version() /= MSLIP_MODULE_ABI_VERSION) call fail('libmicroslip and the module are of different versions')
    self%items = items
    self%periods = periods
    self%basis = series_basis(harmonics, samples)
    self%components = 0
    do i = 1, size(items)
      associate (c => self%items(i))
        c%first = self%components + 1
        p = c%parameters
        if (c%load_varied) p%normal_force = load_factor * p%normal_force
        call mslip_contact_init(p, c%contact, status)
        call require(status, c%name)
        if (c%law == law_element) then
          p%normal_force = load_range * p%normal_force
          call mslip_element_init(p, directions, MSLIP_INPUT_APPROACH, c%element, status)
          call require(status, c%name)
          call mslip_normal_approach(c%element, p%normal_force / load_range, status, compliance=compliance)
          call require(status, c%name)
          c%normal_stiffness = c%count / compliance
        end if
        c%last = c%first + merge(1, 0, c%law == law_element)
        self%components = c%last
      end associate
    end do
    allocate (incidence(dofs, self%components), source=0.0_wp)
    do i = 1, size(items)
      call add_incidence(self%items(i), incidence(:, self%items(i)%first:self%items(i)%last))
    end do

    h = harmonics
    n = samples
    if (allocated(self%workspace)) deallocate (self%workspace, self%element_workspace)
    allocate (self%workspace(mslip_harmonic_workspace_length(h, n)))
    call mslip_harmonic_workspace_init(h, n, self%workspace, status)
    call require(status, 'workspace')
    allocate (self%element_workspace(mslip_element_workspace_length(directions, h, n)))
    call mslip_element_workspace_init(directions, h, n, int(periods, mslip_size), self%element_workspace, status)
    call require(status, 'workspace')
  end subroutine prepare

  pure subroutine add_incidence(c, columns)
    type(friction_contact), intent(in) :: c
    real(wp), intent(inout) :: columns(:,:)
    real(wp) :: direction(2, 2), angle
    integer :: i, n

    n = c%last - c%first + 1
    angle = merge(c%angle * pi / 180.0_wp, 0.0_wp, n > 1)
    direction = reshape([cos(angle), sin(angle), -sin(angle), cos(angle)], [2, 2])
    do i = 1, 2*n
      if (c%dof(i) > 0) columns(c%dof(i), :) = columns(c%dof(i), :) + merge(1, -1, i <= n) * direction(modulo(i - 1, n) + 1, :n)
    end do
  end subroutine add_incidence

  !> Fourier coefficients of all contact forces from those of the displacements, (coefficient, component), the exact Jacobian,
  !> and the energy dissipated per period by each contact. jacobian(:, :, p, j) has the derivatives of the force component p of a
  !> contact with respect to the displacement component j, which is one of that contact; others have none. A trial displacement
  !> far from any solution may press a contact beyond the range of the law: then `allowed` is false.
  subroutine harmonic_force(self, displacement, force, jacobian, dissipated, allowed)
    class(contact_set), intent(inout) :: self
    real(wp), intent(in) :: displacement(:,:)
    real(wp), intent(out) :: force(:,:), jacobian(:,:,:,:), dissipated(:)
    logical, intent(out) :: allowed
    real(wp), dimension(max_components * size(displacement, 1)) :: u, f
    real(wp), allocatable :: df(:,:)
    real(wp) :: drift
    integer(mslip_int) :: status
    integer :: i, k, m, p, q

    m = size(displacement, 1)
    jacobian = 0.0_wp
    self%drift = 0.0_wp
    allowed = .true.
    do i = 1, size(self%items)
      associate (c => self%items(i))
        k = c%last - c%first + 1
        if (allocated(df)) deallocate (df)
        allocate (df(k * m, k * m))
        u(:k * m) = reshape(displacement(:, c%first:c%last), [k * m])
        status = MSLIP_OK
        select case (c%law)
        case (law_microslip)
          call mslip_harmonic_force(c%contact, self%workspace, u(:m), status, f(:m), df, dissipated(i))
        case (law_slider)
          call slider_harmonic_force(c%contact, self%basis, u(:m), f(:m), df, dissipated(i))
        case default
          call mslip_element_harmonic_force(c%element, self%element_workspace, u(:k * m), status, f(:k * m), df, &
                                            dissipated(i), drift)
          self%drift = max(self%drift, drift)
        end select
        allowed = in_range(status)
        if (.not. allowed) return
        call require(status, c%name)
        do q = 1, k
          force(:, c%first + q - 1) = c%count * f((q - 1) * m + 1:q * m)
          do p = 1, k
            jacobian(:, :, p, c%first + q - 1) = c%count * df((p - 1) * m + 1:p * m, (q - 1) * m + 1:q * m)
          end do
        end do
        dissipated(i) = c%count * dissipated(i)
      end associate
    end do
  end subroutine harmonic_force

  !> The unloaded contacts at displacement zero; elements are open.
  subroutine start_history(self, history)
    class(contact_set), intent(in) :: self
    type(contact_history), intent(out) :: history
    integer(mslip_int) :: status
    integer :: i

    allocate (history%states(max(mslip_element_state_length(directions, max_reversals), mslip_state_length(max_reversals)), &
                             size(self%items)), source=0.0_wp)
    do i = 1, size(self%items)
      status = MSLIP_OK
      if (self%items(i)%law == law_microslip) call mslip_state_init(history%states(:, i), status)
      if (self%items(i)%law == law_element) call mslip_element_state_init(directions, history%states(:, i), status)
      call require(status, self%items(i)%name)
    end do
  end subroutine start_history

  !> Forces and tangent stiffnesses, both by component, after a trial step from `history`, which is not modified: a Newton
  !> iteration may try any displacement. `next` is the history to continue with if the step is accepted. `allowed` as in
  !> harmonic_force.
  subroutine try_step(self, history, displacement, force, tangent, next, allowed)
    class(contact_set), intent(in) :: self
    type(contact_history), intent(in) :: history
    real(wp), intent(in) :: displacement(:)
    real(wp), intent(out) :: force(:), tangent(:,:)
    type(contact_history), intent(inout) :: next
    logical, intent(out) :: allowed
    real(wp) :: df(max_components, max_components)
    integer(mslip_int) :: status
    integer :: i, k

    if (.not. allocated(next%states)) next = history
    tangent = 0.0_wp
    do i = 1, size(self%items)
      associate (c => self%items(i), u => displacement(self%items(i)%first:self%items(i)%last), &
                 f => force(self%items(i)%first:self%items(i)%last), before => history%states(:, i), after => next%states(:, i))
        status = MSLIP_OK
        k = c%last - c%first + 1
        select case (c%law)
        case (law_microslip)
          call mslip_masing_update(c%contact, before, u(1), after, status, f(1), df(1, 1))
        case (law_slider)
          call slider_step(c%contact, before(:2), u(1), after(:2), df(1, 1))
          f(1) = after(2)
        case default
          call mslip_element_update(c%element, before, u, after, status, f, df(:k, :k))
        end select
        allowed = in_range(status)
        if (.not. allowed) return
        call require(status, c%name)
        f = c%count * f
        tangent(c%first:c%last, c%first:c%last) = c%count * df(:k, :k)
      end associate
    end do
  end subroutine try_step

  !> History and forces, (instant, component), in the last of `periods` periods of a motion after the first one from the unloaded
  !> state. As in mslip_element_harmonic_force, elements start in the instant of the largest normal force, to which they are pressed
  !> and then displaced.
  subroutine steady_cycle(self, displacement, history, force)
    class(contact_set), intent(in) :: self
    real(wp), intent(in) :: displacement(:,:)
    type(contact_history), intent(out) :: history
    real(wp), intent(out) :: force(:,:)
    type(contact_history) :: next
    real(wp) :: f(size(force, 2)), tangent(size(force, 2), size(force, 2))
    integer(mslip_int) :: status
    logical :: allowed
    integer :: period, largest, i, e

    call self%start_history(history)
    do e = 1, size(self%items)
      associate (c => self%items(e), state => history%states(:, e))
        if (c%law /= law_element) cycle
        largest = maxloc(displacement(:, c%last), dim=1)
        call mslip_element_advance(c%element, state, [0.0_wp, displacement(largest, c%last)], status)
        do i = largest, size(displacement, 1)
          if (status == MSLIP_OK) call mslip_element_advance(c%element, state, displacement(i, c%first:c%last), status)
        end do
        call require(status, c%name)
      end associate
    end do
    do period = 0, self%periods
      do i = 1, size(displacement, 1)
        call self%try_step(history, displacement(i, :), f, tangent, next, allowed)
        if (.not. allowed) call fail('a contact is pressed beyond the range of the law')
        history = next
        force(i, :) = f
      end do
    end do
  end subroutine steady_cycle

  !> Smallest and largest normal force of contact i during a period, and the fraction of the period in which it is open.
  subroutine normal_extremes(self, i, displacement, extremes)
    class(contact_set), intent(in) :: self
    integer, intent(in) :: i
    real(wp), intent(in) :: displacement(:,:)
    real(wp), intent(out) :: extremes(3)
    real(wp) :: basis(256, size(displacement, 1)), normal_force(256)
    integer(mslip_int) :: status

    associate (c => self%items(i))
      extremes = [c%contact%slip_force, c%contact%slip_force, 0.0_wp] / c%parameters%friction_coefficient
      if (c%law /= law_element) return
      basis = series_basis(size(displacement, 1) / 2, 256)
      call mslip_normal_force(c%element, matmul(basis, displacement(:, c%last)), status, normal_force=normal_force)
      call require(status, c%name)
      extremes = [minval(normal_force), maxval(normal_force), count(normal_force <= 0.0_wp) / 256.0_wp]
      extremes(:2) = c%count * extremes(:2)
    end associate
  end subroutine normal_extremes

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
