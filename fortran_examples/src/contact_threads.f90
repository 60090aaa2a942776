!> Many contacts distributed over OpenMP threads: memory, time, and results that are bitwise equal for any number of threads.
!>
!>     contact_threads [CONTACTS [MAX_THREADS]]
!>
!> Each thread has a workspace of its own and evaluates chunks of the contacts. The amplitudes grow from the first contact,
!> which hardly slips, to the last, far in gross slip, so that equal numbers of contacts are unequal work.
program contact_threads
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: pi, wp
  use messages, only: fail, progress, text
  use microslip
  use omp_lib, only: omp_get_num_threads, omp_get_wtime, omp_sched_dynamic, omp_sched_kind, omp_sched_static, omp_set_schedule
  implicit none

  integer(mslip_size), parameter :: harmonics = 5, samples = 128, nodes = 32, reversals = 8
  integer, parameter :: m = 2 * int(harmonics) + 1
  integer, parameter :: chunk = 64             !! contacts of one call: their Jacobians stay in the cache
  integer, parameter :: steps = 32             !! time steps of a period
  integer, parameter :: distinct = 1000        !! contacts that differ in geometry or load
  ! Results of one contact: forces, a product with the Jacobian, energy, and the force at each time step.
  integer, parameter :: result_length = 2 * m + 1 + steps
  integer, parameter :: repetitions = 5        !! of a measurement; the shortest time counts
  real(wp), parameter :: min_amplitude = 0.02_wp, max_amplitude = 3.0_wp      !! in slip_displacement
  type(mslip_contact), allocatable :: contacts(:)
  real(wp), allocatable :: displacement(:,:), alone(:,:), together(:,:)
  real(wp) :: one_thread
  integer :: max_contacts, max_threads, threads

  max_contacts = argument(1, 20000)
  max_threads = argument(2, 2)
  allocate (contacts(max_contacts), displacement(m, max_contacts))
  allocate (alone(result_length, max_contacts), together(result_length, max_contacts))

  call report_memory()
  call report_preparation()
  call report_calls(0.3_wp, 'in microslip, 0.3 slip_displacement')
  call report_calls(2.0_wp, 'in gross slip, 2 slip_displacement')

  call spread_amplitudes()
  one_thread = seconds_of_work(1, omp_sched_static, alone)
  call report_threads(1, 'static', one_thread)
  threads = 2
  do while (threads <= max_threads)
    call report_threads(threads, 'static', seconds_of_work(threads, omp_sched_static, together))
    call report_threads(threads, 'dynamic', seconds_of_work(threads, omp_sched_dynamic, together))
    threads = 2 * threads
  end do

contains

  integer function argument(place, default) result(number)
    integer, intent(in) :: place, default
    character(len=20) :: given
    integer :: status

    number = default
    if (command_argument_count() < place) return
    call get_command_argument(place, given)
    read (given, *, iostat=status) number
    if (status /= 0 .or. number < 1) call fail('argument "'//trim(given)//'": must be a number, 1 or more')
  end function argument

  subroutine report_memory()
    call progress('bytes of a contact '//text(storage_size(contacts) / 8)// &
                  ', of a state for '//text(int(reversals))//' reversals '// &
                  text(int(8 * mslip_state_length(reversals)))// &
                  ', of a workspace for H = '//text(int(harmonics))//' and '//text(int(samples))//' samples '// &
                  text(int(8 * mslip_harmonic_workspace_length(harmonics, samples)))// &
                  ', event-driven with '//text(int(nodes))//' nodes '// &
                  text(int(8 * mslip_harmonic_workspace_length(harmonics, nodes, MSLIP_EVENT_DRIVEN))))
  end subroutine report_memory

  !> Contact i: eight geometries, each under loads of its own, so that contacts i and i + distinct are equal.
  subroutine prepare(i, contact)
    integer, intent(in) :: i
    type(mslip_contact), intent(inout) :: contact
    type(mslip_parameters) :: p
    integer(mslip_int) :: status

    call mslip_parameters_default(p)
    p%flat_half_width = 1.0e-4_wp * mod(i, 8)
    p%edge_radius = 5.0e-3_wp
    p%length = 10.0e-3_wp
    p%normal_force = 50.0_wp + mod(i, distinct)
    p%friction_coefficient = 0.4_wp
    p%material = mslip_material(114.0e9_wp, 0.32_wp)
    call mslip_contact_init(p, contact, status)
    call require(status)
  end subroutine prepare

  subroutine report_preparation()
    real(wp) :: start, elapsed
    integer :: i

    call cpu_time(start)
    do i = 1, max_contacts
      call prepare(i, contacts(i))
    end do
    elapsed = 0.0_wp
    call count_time(elapsed, start)
    call progress('initialisation: '//microseconds(elapsed)//' us per contact')
  end subroutine report_preparation

  !> The time of each call on one thread, all contacts at one amplitude.
  subroutine report_calls(amplitude, condition)
    real(wp), intent(in) :: amplitude
    character(len=*), intent(in) :: condition
    real(wp), allocatable :: workspace(:), nodes_workspace(:), force(:,:), jacobian(:,:,:), states(:,:), shared_states(:,:)
    real(wp) :: dissipated(chunk), start, elapsed(6)
    integer(mslip_int) :: status, index(max_contacts)
    integer :: first, last, n, step, i

    call new_workspace(samples, MSLIP_UNIFORM_SAMPLING, workspace)
    call new_workspace(nodes, MSLIP_EVENT_DRIVEN, nodes_workspace)
    allocate (force(m, chunk), jacobian(m, m, chunk))
    do i = 1, max_contacts
      displacement(:, i) = motion(amplitude * contacts(i)%slip_displacement, i)
    end do
    elapsed = 0.0_wp
    do first = 1, max_contacts, chunk
      last = min(first + chunk - 1, max_contacts)
      n = last - first + 1
      call cpu_time(start)
      call mslip_batch_harmonic_force(contacts(first:last), workspace, displacement(:, first:last), status, &
                                      force=force(:, :n))
      call require(status)
      call count_time(elapsed(1), start)
      call mslip_batch_harmonic_force(contacts(first:last), workspace, displacement(:, first:last), status, &
                                      force=force(:, :n), jacobian=jacobian(:, :, :n), dissipated=dissipated(:n))
      call require(status)
      call count_time(elapsed(2), start)
      call mslip_batch_harmonic_force(contacts(first:last), nodes_workspace, displacement(:, first:last), status, &
                                      force=force(:, :n), jacobian=jacobian(:, :, :n), dissipated=dissipated(:n))
      call require(status)
      call count_time(elapsed(3), start)
      states = unloaded_states(n)
      call cpu_time(start)
      do step = 1, steps
        call mslip_batch_masing_advance(contacts(first:last), states, &
                                        displacement(2, first:last) * cos(2 * pi * step / steps), status, &
                                        force=force(1, :n), stiffness=dissipated(:n))
        call require(status)
      end do
      call count_time(elapsed(4), start)
    end do
    ! In the order of a time integration: each step of all contacts, which are not in the cache.
    states = unloaded_states(max_contacts)
    call cpu_time(start)
    do step = 1, steps
      do first = 1, max_contacts, chunk
        last = min(first + chunk - 1, max_contacts)
        n = last - first + 1
        call mslip_batch_masing_advance(contacts(first:last), states(:, first:last), &
                                        displacement(2, first:last) * cos(2 * pi * step / steps), status, &
                                        force=force(1, :n), stiffness=dissipated(:n))
        call require(status)
      end do
    end do
    call count_time(elapsed(5), start)
    ! The same with an index: equal items share one contact, and these contacts stay in the cache.
    index = [(mod(i - 1, distinct) + 1, i=1, max_contacts)]
    shared_states = unloaded_states(max_contacts)
    call cpu_time(start)
    do step = 1, steps
      do first = 1, max_contacts, chunk
        last = min(first + chunk - 1, max_contacts)
        n = last - first + 1
        call mslip_batch_masing_advance(contacts(:min(distinct, max_contacts)), shared_states(:, first:last), &
                                        displacement(2, first:last) * cos(2 * pi * step / steps), status, &
                                        index=index(first:last), force=force(1, :n), stiffness=dissipated(:n))
        call require(status)
      end do
    end do
    call count_time(elapsed(6), start)
    if (any(transfer(states, [0_int64]) /= transfer(shared_states, [0_int64]))) call fail('shared contacts: other results')
    call progress(condition//', us per contact: harmonic force '//microseconds(elapsed(1))//', with Jacobian '// &
                  microseconds(elapsed(2))//', event-driven '//microseconds(elapsed(3))//', time step '// &
                  microseconds(elapsed(4) / steps)//', from memory '//microseconds(elapsed(5) / steps)// &
                  ', from memory with shared contacts '//microseconds(elapsed(6) / steps))
  end subroutine report_calls

  !> Processor time, which is independent of other processes.
  subroutine count_time(elapsed, start)
    real(wp), intent(inout) :: elapsed, start
    real(wp) :: now

    call cpu_time(now)
    elapsed = elapsed + (now - start)
    start = now
  end subroutine count_time

  subroutine spread_amplitudes()
    real(wp) :: amplitude
    integer :: i

    do i = 1, max_contacts
      amplitude = min_amplitude * (max_amplitude / min_amplitude)**(real(i - 1, wp) / max(max_contacts - 1, 1))
      displacement(:, i) = motion(amplitude * contacts(i)%slip_displacement, i)
    end do
  end subroutine spread_amplitudes

  !> A first harmonic and smaller higher ones.
  pure function motion(amplitude, i) result(coefficients)
    real(wp), intent(in) :: amplitude
    integer, intent(in) :: i
    real(wp) :: coefficients(m)
    integer :: k

    coefficients(1) = 0.0_wp
    do k = 1, int(harmonics)
      coefficients(2 * k) = amplitude * cos(real(i * k, wp)) / k**3
      coefficients(2 * k + 1) = amplitude * sin(real(i * k, wp)) / k**3
    end do
  end function motion

  !> Wall time of the work.
  real(wp) function seconds_of_work(threads, schedule, results) result(seconds)
    integer, intent(in) :: threads
    integer(omp_sched_kind), intent(in) :: schedule
    real(wp), intent(inout) :: results(:,:)
    real(wp) :: start
    integer :: repetition

    call omp_set_schedule(schedule, 0)
    seconds = huge(seconds)
    do repetition = 1, repetitions
      results = 0.0_wp
      start = omp_get_wtime()
      call work(threads, results)
      seconds = min(seconds, omp_get_wtime() - start)
    end do
  end function seconds_of_work

  !> The evaluations of a solver, on the given number of threads.
  subroutine work(threads, results)
    integer, intent(in) :: threads
    real(wp), intent(inout) :: results(:,:)
    real(wp), allocatable :: workspace(:), jacobian(:,:,:), states(:,:), force(:), stiffness(:)
    integer(mslip_int) :: status
    integer :: first, last, n, step, i

    !$omp parallel num_threads(threads) default(none) shared(threads, max_contacts, contacts, displacement, results) &
    !$omp private(workspace, jacobian, states, force, stiffness, status, first, last, n, step, i)
    if (omp_get_num_threads() /= threads) call fail(text(threads)//' threads are not available')
    call new_workspace(samples, MSLIP_UNIFORM_SAMPLING, workspace)
    allocate (jacobian(m, m, chunk), force(chunk), stiffness(chunk))
    !$omp do schedule(runtime)
    do first = 1, max_contacts, chunk
      last = min(first + chunk - 1, max_contacts)
      n = last - first + 1
      call mslip_batch_harmonic_force(contacts(first:last), workspace, displacement(:, first:last), status, &
                                      force=results(:m, first:last), jacobian=jacobian(:, :, :n), &
                                      dissipated=results(2 * m + 1, first:last))
      call require(status)
      ! A solver adds the Jacobian to its matrix, or multiplies with it, while the chunk is in the cache.
      do i = first, last
        results(m + 1:2 * m, i) = matmul(jacobian(:, :, i - first + 1), displacement(:, i))
      end do
      states = unloaded_states(n)
      do step = 1, steps
        call mslip_batch_masing_advance(contacts(first:last), states, &
                                        displacement(2, first:last) * cos(2 * pi * step / steps), status, &
                                        force=force(:n), stiffness=stiffness(:n))
        call require(status)
        results(2 * m + 1 + step, first:last) = force(:n)
      end do
    end do
    !$omp end do
    !$omp end parallel
  end subroutine work

  subroutine report_threads(threads, schedule, seconds)
    integer, intent(in) :: threads
    character(len=*), intent(in) :: schedule
    real(wp), intent(in) :: seconds
    logical :: same

    same = .true.
    if (threads > 1) same = all(transfer(alone, [0_int64]) == transfer(together, [0_int64]))
    call progress(text(threads)//' threads, '//schedule//': '//text(seconds, '(f8.3)')//' s, '// &
                  text(one_thread / seconds, '(f6.2)')//' times as fast as one thread'// &
                  trim(merge(', bitwise equal', ', NOT EQUAL    ', same)))
    if (.not. same) call fail(text(threads)//' threads: results differ from those of one')
  end subroutine report_threads

  subroutine new_workspace(points, rule, workspace)
    integer(mslip_size), intent(in) :: points
    integer(mslip_int), intent(in) :: rule
    real(wp), allocatable, intent(out) :: workspace(:)
    integer(mslip_int) :: status

    allocate (workspace(mslip_harmonic_workspace_length(harmonics, points, rule)))
    call mslip_harmonic_workspace_init(harmonics, points, workspace, status, rule)
    call require(status)
  end subroutine new_workspace

  function unloaded_states(n) result(states)
    integer, intent(in) :: n
    real(wp) :: states(mslip_state_length(reversals), n)
    integer(mslip_int) :: status
    integer :: i

    do i = 1, n
      call mslip_state_init(states(:, i), status)
      call require(status)
    end do
  end function unloaded_states

  function microseconds(seconds) result(string)
    real(wp), intent(in) :: seconds
    character(len=:), allocatable :: string
    string = text(1.0e6_wp * seconds / max_contacts, '(f8.3)')
  end function microseconds

  subroutine require(status)
    integer(mslip_int), intent(in) :: status
    if (status /= MSLIP_OK) call fail(mslip_status_text(status))
  end subroutine require
end program contact_threads
