program bad_input
  ! What the module adds to the C functions, for every procedure, by a table: the same results as C, with each subset of the
  ! optional outputs; sizes of arrays, which it checks or passes; indices, which count from 1. An error modifies no output. What the
  ! C functions reject is tested in Rust.
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_int64_t, c_loc, c_null_ptr, c_ptr, c_size_t
  use microslip
  use checks
  implicit none

  integer, parameter :: n = 3, harmonics = 2, m = 2*harmonics + 1
  integer(mslip_size), parameter :: h = harmonics, samples = 16, periods = 2, reversals = 4, pieces = 4
  integer(mslip_int), parameter :: one = 1

  type :: procedure_info
    character(len=32) :: name
    character(len=5) :: outputs          ! Four outputs, o: optional, r: required; the new state, s: one, b: of a batch.
    character :: memory = ' '            ! s: state, w: workspace.
    logical :: batch = .false., element = .false.
  end type procedure_info

  include 'procedures.f90'

  ! One component is allocated; if none is, the argument is absent.
  type :: output
    real(wp), allocatable :: s, v(:), m(:, :), t(:, :, :)
  end type output

  type(procedure_info) :: tested
  character(len=:), allocatable :: name
  type(mslip_contact), allocatable :: contacts(:)
  type(mslip_element), allocatable :: elements(:)
  type(output), target :: out(5)
  real(wp), allocatable, target :: x(:), u(:, :), state(:), states(:, :), workspace(:)
  real(wp), allocatable :: vector(:), vectors(:, :)  ! Displacements of an element.
  integer(mslip_int), allocatable, target :: index(:), active(:), from_zero(:)
  integer(mslip_size) :: failed_item
  real(wp) :: scalar
  integer(mslip_int) :: status
  integer(mslip_int) :: directions  ! Of the elements.
  integer :: p, parts, me           ! Components of a displacement of an element, and their coefficients.

  do directions = 2, 1, -1
    parts = int(directions) + 1
    me = parts*m
    do p = 1, size(procedures)
      tested = procedures(p)
      name = trim(tested%name)//': '
      if (directions == 2 .and. (.not. tested%element .or. tested%name == 'element_tractions')) cycle
      call test_subsets()
      call test_sizes()
      call test_lengths()
      if (tested%batch) call test_index()
    end do
  end do
  call test_short_memory()
  call report()

contains

  subroutine set_up()
    ! Valid arguments of procedure p, and unset outputs of the required shapes.
    integer(mslip_int) :: ok
    integer :: i, items

    items = merge(n, 1, tested%batch)
    contacts = [(mslip_contact(), i = 1, items)]
    elements = [(mslip_element(), i = 1, items)]
    do i = 1, items
      call mslip_contact_init(flat_parameters(i), contacts(i), ok)
      call mslip_element_init(flat_parameters(i), directions, MSLIP_INPUT_APPROACH, elements(i), ok)
    end do
    vector = [spread(1.0e-7_wp, 1, int(directions)), 2.0e-7_wp]
    vectors = spread(vector, 2, n)
    scalar = 1.0e-7_wp
    x = [1.0e-7_wp, 2.0e-7_wp, 3.0e-7_wp]
    u = spread([0.0_wp, 3.0e-7_wp, 1.0e-7_wp, 0.0_wp, 2.0e-8_wp], 2, items)
    if (allocated(index)) deallocate (index, active)
    if (tested%batch) then
      index = [2_mslip_int, 1_mslip_int, 3_mslip_int]
      active = spread(1_mslip_int, 1, n)
    end if
    state = spread(0.0_wp, 1, int(mslip_state_length(reversals)))
    call mslip_state_init(state, ok)
    call mslip_masing_path_advance(contacts(1), state, [2.0e-7_wp, 0.5e-7_wp, 1.5e-7_wp], ok)
    workspace = spread(0.0_wp, 1, int(mslip_harmonic_workspace_length(h, samples)))
    call mslip_harmonic_workspace_init(h, samples, workspace, ok)
    if (tested%element) then
      state = spread(0.0_wp, 1, int(mslip_element_state_length(directions, pieces)))
      call mslip_element_state_init(directions, state, ok)
      call mslip_element_path_advance(elements(1), state, reshape([spread(1.0e-8_wp, 1, int(directions)), 1.0e-7_wp, &
        spread(0.0_wp, 1, int(directions)), 2.0e-7_wp], [parts, 2]), ok)
      call check_status('set up: state', ok, MSLIP_OK)
      u = spread([reshape([real(wp) ::], [int(directions)*m], pad=[0.0_wp, 3.0e-7_wp, 1.0e-7_wp, 0.0_wp, 2.0e-8_wp]), &
        2.0e-7_wp, 5.0e-8_wp, 0.0_wp, 0.0_wp, 1.0e-8_wp], 2, items)
      workspace = spread(0.0_wp, 1, int(mslip_element_workspace_length(directions, h, samples)))
      call mslip_element_workspace_init(directions, h, samples, periods, workspace, ok)
    end if
    states = spread(state, 2, n)
    call check_status('set up', ok, MSLIP_OK)
    do i = 1, size(out)
      call remove(out(i))
    end do
    call set_outputs()
    if (tested%outputs(5:5) == 's') out(5)%v = spread(untouched, 1, size(state))
    if (tested%outputs(5:5) == 'b') out(5)%m = reshape([real(wp) ::], shape(states), pad=[untouched])
  end subroutine set_up

  subroutine remove(one)
    type(output), intent(inout) :: one

    if (allocated(one%s)) deallocate (one%s)
    if (allocated(one%v)) deallocate (one%v)
    if (allocated(one%m)) deallocate (one%m)
    if (allocated(one%t)) deallocate (one%t)
  end subroutine remove

  include 'calls.f90'

  function address(one)
    ! Of the component that is allocated.
    type(output), intent(in), target :: one
    type(c_ptr) :: address

    address = c_null_ptr
    if (allocated(one%s)) address = c_loc(one%s)
    if (allocated(one%v)) address = c_loc(one%v)
    if (allocated(one%m)) address = c_loc(one%m)
    if (allocated(one%t)) address = c_loc(one%t)
  end function address

  pure function flat(one) result(values)
    type(output), intent(in) :: one
    real(wp), allocatable :: values(:)

    values = [real(wp) ::]
    if (allocated(one%s)) values = [one%s]
    if (allocated(one%v)) values = one%v
    if (allocated(one%m)) values = [one%m]
    if (allocated(one%t)) values = [one%t]
  end function flat

  pure logical function is_untouched(values)
    ! Compared as bits: a value written in error may be NaN.
    real(wp), intent(in) :: values(:)

    is_untouched = all(transfer(values, [0_c_int64_t]) == transfer(untouched, 0_c_int64_t))
  end function is_untouched

  subroutine rejected(what, expected)
    ! The call has this status and modifies no output and no state.
    character(len=*), intent(in) :: what
    integer(mslip_int), intent(in) :: expected

    real(wp) :: before(size(state) + size(states))
    integer :: i

    before = [state, states]
    failed_item = -1
    call perform()
    if (tested%batch) call check(name//what//': the failed item', &
      failed_item == merge(n, 0, expected == MSLIP_BAD_INDEX))
    call check_status(name//what, status, expected)
    call check(name//what//': nothing modified', all([(is_untouched(flat(out(i))), i = 1, size(out))]) &
      .and. all(transfer([state, states], [0_c_int64_t]) == transfer(before, [0_c_int64_t])))
  end subroutine rejected

  subroutine test_subsets()
    type(output) :: all_outputs(size(out))
    real(wp), allocatable :: advanced(:)
    integer :: subset, i

    call set_up()
    call perform()
    all_outputs = out
    call check_status(tested%name, status, MSLIP_OK)
    if (allocated(advanced)) deallocate (advanced)  ! Static variables keep it.
    allocate (advanced, source=[state, states])
    call set_up()
    if (allocated(index)) from_zero = index - one
    call perform_in_c()
    call check_status(name//'C', status, MSLIP_OK)
    do i = 1, size(out)
      call check_same(name//'C', flat(out(i)), flat(all_outputs(i)))
    end do
    call check(name//'C: the same state', all(transfer([state, states], [0_c_int64_t]) == &
      transfer(advanced, [0_c_int64_t])))
    call check(name//'all outputs are written', &
      .not. any([(size(flat(out(i))) > 0 .and. is_untouched(flat(out(i))), i = 1, size(out))]))
    do subset = 0, 15
      call set_up()
      do i = 1, 4
        if (tested%outputs(i:i) == 'o' .and. .not. btest(subset, i - 1)) call remove(out(i))
      end do
      call perform()
      call check_status(name//'a subset of the outputs', status, MSLIP_OK)
      do i = 1, size(out)
        if (size(flat(out(i))) > 0) call check_same(name//'a subset of the outputs', flat(out(i)), &
          flat(all_outputs(i)))
      end do
    end do
  end subroutine test_subsets

  subroutine test_sizes()
    ! Each array is longer by one, in each of its dimensions.
    integer :: i, d, extent(3)

    do i = 1, size(out)
      call set_up()
      if (allocated(out(i)%v)) then
        out(i)%v = spread(untouched, 1, size(out(i)%v) + 1)
        call rejected('size', MSLIP_BAD_ARRAY_SIZE)
      end if
      do d = 1, 3
        call set_up()
        if (allocated(out(i)%m)) extent(:2) = shape(out(i)%m)
        if (allocated(out(i)%t)) extent = shape(out(i)%t)
        extent(d) = extent(d) + 1
        if (allocated(out(i)%t)) then
          out(i)%t = reshape([real(wp) ::], extent, pad=[untouched])
          call rejected('size', MSLIP_BAD_ARRAY_SIZE)
        else if (allocated(out(i)%m) .and. d < 3) then
          out(i)%m = reshape([real(wp) ::], extent(:2), pad=[untouched])
          call rejected('size', MSLIP_BAD_ARRAY_SIZE)
        end if
      end do
    end do
    call set_up()
    u = reshape([u], shape(u) + [1, 0], pad=[0.0_wp])
    if (tested%memory == 'w') call rejected('coefficients', MSLIP_BAD_COEFFICIENTS)
    if (tested%element .and. tested%memory == 's' .and. tested%name /= 'element_tractions') then
      call set_up()
      vector = [vector, 0.0_wp]
      vectors = reshape([vectors], [parts + 1, n], pad=[0.0_wp])
      call rejected('components', MSLIP_BAD_ARRAY_SIZE)
      vector = vector(:parts - 1)
      vectors = vectors(:parts - 1, :)
      call rejected('components', MSLIP_BAD_ARRAY_SIZE)
    end if
    if (.not. tested%batch) return
    call set_up()
    index = [index, 1_mslip_int]
    call rejected('size of index', MSLIP_BAD_ARRAY_SIZE)
    call set_up()
    active = [active, 1_mslip_int]
    call rejected('size of active', MSLIP_BAD_ARRAY_SIZE)
    call set_up()
    x = [x, 0.0_wp]
    u = reshape([u], shape(u) + [0, 1], pad=[0.0_wp])
    vectors = reshape([vectors], [parts, n + 1], pad=[0.0_wp])
    call rejected('size of the input', MSLIP_BAD_ARRAY_SIZE)
    call set_up()
    states = reshape([states], [size(states, 1), n + 1], pad=[0.0_wp])
    if (tested%memory == 's') call rejected('number of states', MSLIP_BAD_ARRAY_SIZE)
  end subroutine test_sizes

  subroutine test_lengths()
    ! States and workspaces are truncated.
    call set_up()
    state = state(:3)
    states = states(:3, :)
    workspace = workspace(:size(workspace) - 1)
    if (tested%outputs(5:5) == 's') out(5)%v = out(5)%v(:3)
    if (tested%outputs(5:5) == 'b') out(5)%m = out(5)%m(:3, :)
    if (tested%memory == 's') call rejected('a truncated state', MSLIP_STATE_TOO_SHORT)
    if (tested%memory == 'w') call rejected('a truncated workspace', MSLIP_WORKSPACE_TOO_SHORT)
    workspace = workspace(:2)
    if (tested%memory == 'w') call rejected('a workspace of two values', MSLIP_WORKSPACE_TOO_SHORT)
  end subroutine test_lengths

  subroutine test_index()
    integer(mslip_int), parameter :: bad_index(4) = [0_mslip_int, int(n + 1, mslip_int), -huge(1_mslip_int), huge(1_mslip_int)]
    integer :: k

    do k = 1, size(bad_index)
      call set_up()
      index(n) = bad_index(k)
      call rejected('index', MSLIP_BAD_INDEX)
    end do
    active(n) = 0
    failed_item = -1
    call perform()
    call check_status(name//'an invalid item is skipped', status, MSLIP_OK)
    call check(name//'no failed item', failed_item == -1)
  end subroutine test_index

  subroutine test_short_memory()
    ! The sizes that the procedures without outputs pass are those of their arrays.
    integer(mslip_size) :: found(3)
    integer(mslip_int) :: kinds(2)
    real(wp) :: error

    error = untouched
    found = -1
    kinds = -1
    p = 1
    tested = procedures(p)
    call set_up()
    call mslip_state_init(state(:4), status)
    call check_status('initialisation of a short state', status, MSLIP_STATE_TOO_SHORT)
    call mslip_state_error(state(:0), error, status)
    call check_status('error of a short state', status, MSLIP_STATE_TOO_SHORT)
    call mslip_element_state_error(one, state(:0), error, status)
    call check_status('error of a short state of an element', status, MSLIP_STATE_TOO_SHORT)
    call mslip_harmonic_workspace_size(workspace(:size(workspace) - 1), found(1), found(2), kinds(1), status)
    call check_status('size of a short workspace', status, MSLIP_WORKSPACE_TOO_SHORT)
    workspace = spread(untouched, 1, int(mslip_element_workspace_length(one, h, samples)))
    call mslip_element_workspace_init(one, h, samples, periods, workspace(:size(workspace) - 1), status)
    call check_status('initialisation of a short workspace of an element', status, MSLIP_WORKSPACE_TOO_SHORT)
    call mslip_element_workspace_init(one, h, samples, periods, workspace, status)
    call mslip_element_workspace_size(workspace(:size(workspace) - 1), kinds(1), found(1), found(2), kinds(2), found(3), status)
    call check_status('size of a short workspace of an element', status, MSLIP_WORKSPACE_TOO_SHORT)
    call check('nothing is written', is_untouched([error]) .and. all(found == -1) .and. all(kinds == -1))
  end subroutine test_short_memory

end program bad_input
