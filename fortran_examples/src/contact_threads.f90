!> Many contacts on OpenMP threads: bytes, time per contact, and results that are bitwise equal for any number of threads.
!>
!>     contact_threads [CONTACTS [MAX_THREADS]]
!>
!> `work` is the pattern: each thread has a workspace of its own and evaluates chunks of the contacts. The amplitudes grow from
!> the first contact, in microslip, to the last, far in gross slip, so that equal numbers of contacts are unequal work.
program contact_threads
  use, intrinsic :: iso_fortran_env, only: int64
  use basics, only: fail, pi, progress, text, wp
  use microslip
  use omp_lib, only: omp_get_num_threads, omp_get_wtime
  implicit none

  integer(mslip_size), parameter :: harmonics = 5, samples = 128, nodes = 32, reversals = 8
  integer, parameter :: m = 2 * int(harmonics) + 1
  integer, parameter :: chunk = 64             !! contacts of one call: their Jacobians stay in the cache
  integer, parameter :: steps = 32             !! time steps of a period
  integer, parameter :: distinct = 1000        !! contacts that differ in geometry or load
  type(mslip_contact), allocatable :: contacts(:)
  real(wp), allocatable :: displacement(:,:), one_thread(:,:), results(:,:)
  real(wp) :: start, seconds, seconds_of_one
  integer :: n, threads, i

  n = positive_argument(1, 20000)
  allocate (contacts(n), displacement(m, n))
  allocate (one_thread(2 * m + 1 + steps, n), results(2 * m + 1 + steps, n))
  call progress('bytes: contact '//text(storage_size(contacts) / 8)//', state for '//text(int(reversals))//' reversals '// &
                text(8 * int(mslip_state_length(reversals)))//', workspace with '//text(int(samples))//' samples '// &
                text(8 * int(mslip_harmonic_workspace_length(harmonics, samples)))//', event-driven with '// &
                text(int(nodes))//' nodes '// &
                text(8 * int(mslip_harmonic_workspace_length(harmonics, nodes, MSLIP_EVENT_DRIVEN))))
  call cpu_time(start)
  do i = 1, n
    call prepare(i, contacts(i))
  end do
  call progress('initialisation: '//microseconds(start, n)//' us per contact')
  call report_calls(0.3_wp, 'in microslip, 0.3 slip_displacement')
  call report_calls(2.0_wp, 'in gross slip, 2 slip_displacement')

  do i = 1, n
    call set_motion(i, 0.02_wp * 150.0_wp**(real(i - 1, wp) / max(n - 1, 1)))
  end do
  threads = 1
  seconds_of_one = 0.0_wp
  do while (threads <= positive_argument(2, 2))
    seconds = huge(seconds)
    do i = 1, 5
      results = 0.0_wp
      start = omp_get_wtime()
      call work(threads)
      seconds = min(seconds, omp_get_wtime() - start)
    end do
    if (threads == 1) one_thread = results
    if (threads == 1) seconds_of_one = seconds
    if (.not. bitwise_equal(one_thread, results)) call fail(text(threads)//' threads: results differ from those of one')
    call progress(text(threads)//' threads: '//text(seconds, '(f8.3)')//' s, '//text(seconds_of_one / seconds, '(f6.2)')// &
                  ' times as fast as one, bitwise equal results')
    threads = 2 * threads
  end do

contains

  integer function positive_argument(position, default) result(number)
    integer, intent(in) :: position, default
    character(len=20) :: given
    integer :: status

    number = default
    if (command_argument_count() < position) return
    call get_command_argument(position, given)
    read (given, *, iostat=status) number
    if (status /= 0 .or. number < 1) call fail('argument "'//trim(given)//'": must be a number, 1 or more')
  end function positive_argument

  !> Eight geometries, each under different loads; contacts i and i + distinct are equal.
  subroutine prepare(i, contact)
    integer, intent(in) :: i
    type(mslip_contact), intent(inout) :: contact
    type(mslip_parameters) :: p
    integer(mslip_int) :: status

    p = mslip_parameters(flat_half_width=1.0e-4_wp * mod(i, 8), edge_radius=5.0e-3_wp, length=10.0e-3_wp, &
                         normal_force=50.0_wp + mod(i, distinct), friction_coefficient=0.4_wp, &
                         material=[mslip_material(114.0e9_wp, 0.32_wp), mslip_material(114.0e9_wp, 0.32_wp)], &
                         displacement_reference=MSLIP_RIGID_STRIP)
    call mslip_contact_init(p, contact, status)
    call require(status)
  end subroutine prepare

  !> A first harmonic of this amplitude, relative to slip_displacement, and smaller higher ones.
  subroutine set_motion(i, amplitude)
    integer, intent(in) :: i
    real(wp), intent(in) :: amplitude
    integer :: k

    displacement(1, i) = 0.0_wp
    do k = 1, int(harmonics)
      displacement(2*k:2*k + 1, i) = amplitude * contacts(i)%slip_displacement / k**3 * &
                                     [cos(real(i * k, wp)), sin(real(i * k, wp))]
    end do
  end subroutine set_motion

  !> Force and Jacobian of a balance, and a period of time steps, of all contacts on the given number of threads.
  subroutine work(threads)
    integer, intent(in) :: threads
    real(wp), allocatable :: workspace(:), jacobian(:,:,:), states(:,:), force(:)
    integer(mslip_int) :: status
    integer :: first, last, step, i

    !$omp parallel num_threads(threads) default(none) shared(threads, n, contacts, displacement, results) &
    !$omp private(workspace, jacobian, states, force, status, first, last, step, i)
    if (omp_get_num_threads() /= threads) call fail(text(threads)//' threads are not available')
    call new_workspace(samples, MSLIP_UNIFORM_SAMPLING, workspace)
    allocate (jacobian(m, m, chunk), force(chunk))
    !$omp do schedule(static)
    do first = 1, n, chunk
      last = min(first + chunk - 1, n)
      call mslip_batch_harmonic_force(contacts(first:last), workspace, displacement(:, first:last), status, &
                                      force=results(:m, first:last), jacobian=jacobian(:, :, :last - first + 1), &
                                      dissipated=results(2 * m + 1, first:last))
      call require(status)
      ! A solver adds the Jacobian to its matrix, or multiplies with it, while the chunk is in the cache.
      do i = first, last
        results(m + 1:2 * m, i) = matmul(jacobian(:, :, i - first + 1), displacement(:, i))
      end do
      call start_states(last - first + 1, states)
      do step = 1, steps
        call mslip_batch_masing_advance(contacts(first:last), states, displacement(2, first:last) * phase(step), status, &
                                        force=force(:last - first + 1))
        call require(status)
        results(2 * m + 1 + step, first:last) = force(:last - first + 1)
      end do
    end do
    !$omp end do
    !$omp end parallel
  end subroutine work

  !> Processor time of each call on one thread, all contacts at one amplitude.
  subroutine report_calls(amplitude, condition)
    real(wp), intent(in) :: amplitude
    character(len=*), intent(in) :: condition
    real(wp), allocatable :: workspace(:), states(:,:), shared_states(:,:)
    integer :: i

    do i = 1, n
      call set_motion(i, amplitude)
    end do
    call progress(condition//', us per contact:')
    call new_workspace(samples, MSLIP_UNIFORM_SAMPLING, workspace)
    call progress('  force and Jacobian              '//microseconds_of_force(workspace))
    call new_workspace(nodes, MSLIP_EVENT_DRIVEN, workspace)
    call progress('  the same, event-driven          '//microseconds_of_force(workspace))
    call cpu_time(start)
    do i = 1, n, chunk
      call start_states(min(chunk, n - i + 1), states)
      call all_steps(states, i, min(i + chunk - 1, n), shared=.false.)
    end do
    call progress('  time step of a chunk in cache   '//microseconds(start, n * steps))
    call start_states(n, states)
    call cpu_time(start)
    call all_steps(states, 1, n, shared=.false.)
    call progress('  time step of all contacts       '//microseconds(start, n * steps))
    call start_states(n, shared_states)
    call cpu_time(start)
    call all_steps(shared_states, 1, n, shared=.true.)
    call progress('  the same, contacts by index     '//microseconds(start, n * steps))
    if (.not. bitwise_equal(states, shared_states)) call fail('shared contacts: results differ')
  end subroutine report_calls

  function microseconds_of_force(workspace) result(string)
    real(wp), intent(inout), contiguous :: workspace(:)
    character(len=:), allocatable :: string
    real(wp) :: force(m, chunk), jacobian(m, m, chunk), dissipated(chunk)
    integer(mslip_int) :: status
    integer :: first, last, k

    call cpu_time(start)
    do first = 1, n, chunk
      last = min(first + chunk - 1, n)
      k = last - first + 1
      call mslip_batch_harmonic_force(contacts(first:last), workspace, displacement(:, first:last), status, &
                                      force=force(:, :k), jacobian=jacobian(:, :, :k), dissipated=dissipated(:k))
      call require(status)
    end do
    string = microseconds(start, n)
  end function microseconds_of_force

  !> Each step of the contacts `from` to `to` before the next step. `shared`: equal items share one contact through `index`.
  subroutine all_steps(states, from, to, shared)
    real(wp), intent(inout), contiguous :: states(:,:)
    integer, intent(in) :: from, to
    logical, intent(in) :: shared
    real(wp) :: force(chunk), stiffness(chunk), u(chunk)
    integer(mslip_int) :: status, index(chunk)
    integer :: step, first, last, k, i

    do step = 1, steps
      do first = from, to, chunk
        last = min(first + chunk - 1, to)
        k = last - first + 1
        u(:k) = displacement(2, first:last) * phase(step)
        index(:k) = [(mod(i - 1, distinct) + 1, i=first, last)]
        if (shared) then
          call mslip_batch_masing_advance(contacts(:min(distinct, n)), states(:, first - from + 1:last - from + 1), u(:k), &
                                          status, index=index(:k), force=force(:k), stiffness=stiffness(:k))
        else
          call mslip_batch_masing_advance(contacts(first:last), states(:, first - from + 1:last - from + 1), u(:k), &
                                          status, force=force(:k), stiffness=stiffness(:k))
        end if
        call require(status)
      end do
    end do
  end subroutine all_steps

  pure real(wp) function phase(step)
    integer, intent(in) :: step
    phase = cos(2.0_wp * pi * step / steps)
  end function phase

  subroutine new_workspace(points, rule, workspace)
    integer(mslip_size), intent(in) :: points
    integer(mslip_int), intent(in) :: rule
    real(wp), allocatable, intent(out) :: workspace(:)
    integer(mslip_int) :: status

    allocate (workspace(mslip_harmonic_workspace_length(harmonics, points, rule)))
    call mslip_harmonic_workspace_init(harmonics, points, workspace, status, rule)
    call require(status)
  end subroutine new_workspace

  subroutine start_states(count, states)
    integer, intent(in) :: count
    real(wp), allocatable, intent(out) :: states(:,:)
    integer(mslip_int) :: status
    integer :: i

    allocate (states(mslip_state_length(reversals), count))
    do i = 1, count
      call mslip_state_init(states(:, i), status)
      call require(status)
    end do
  end subroutine start_states

  pure logical function bitwise_equal(a, b)
    real(wp), intent(in) :: a(:,:), b(:,:)
    bitwise_equal = all(transfer(a, [0_int64]) == transfer(b, [0_int64]))
  end function bitwise_equal

  function microseconds(start, calls) result(string)
    real(wp), intent(in) :: start
    integer, intent(in) :: calls
    character(len=:), allocatable :: string
    real(wp) :: now

    call cpu_time(now)
    string = text(1.0e6_wp * (now - start) / calls, '(f8.3)')
  end function microseconds

  subroutine require(status)
    integer(mslip_int), intent(in) :: status
    if (status /= MSLIP_OK) call fail(mslip_status_text(status))
  end subroutine require
end program contact_threads
