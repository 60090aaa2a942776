!> Many contacts shared by OpenMP threads: what they take of memory and time, and the same bits by any number of threads.
!>
!>     contact_threads [CONTACTS [MOST_THREADS]]
!>
!> The threads are given chunks of the contacts, and each has a workspace of its own. The amplitudes grow from the first
!> contact, which hardly slips, to the last, far in gross slip, so that equal numbers of contacts are unequal work.
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
  integer, parameter :: steps = 32             !! of a period, in time
  ! What is told of one contact: forces, a product with the Jacobian, energy, and the force at each step in time.
  integer, parameter :: answer_length = 2 * m + 1 + steps
  integer, parameter :: repetitions = 5        !! of which the shortest counts
  real(wp), parameter :: smallest = 0.02_wp, largest = 3.0_wp      !! amplitudes, of slip_displacement
  type(mslip_contact), allocatable :: contacts(:)
  real(wp), allocatable :: displacement(:,:), alone(:,:), together(:,:)
  real(wp) :: one_thread
  integer :: most_contacts, most_threads, threads

  most_contacts = argument(1, 20000)
  most_threads = argument(2, 2)
  allocate (contacts(most_contacts), displacement(m, most_contacts))
  allocate (alone(answer_length, most_contacts), together(answer_length, most_contacts))

  call tell_memory()
  call tell_preparation()
  call tell_calls(0.3_wp, 'in microslip, 0.3 slip_displacement')
  call tell_calls(2.0_wp, 'in gross slip, 2 slip_displacement')

  call spread_amplitudes()
  one_thread = seconds_of_work(1, omp_sched_static, alone)
  call tell_threads(1, 'static', one_thread)
  threads = 2
  do while (threads <= most_threads)
    call tell_threads(threads, 'static', seconds_of_work(threads, omp_sched_static, together))
    call tell_threads(threads, 'dynamic', seconds_of_work(threads, omp_sched_dynamic, together))
    threads = 2 * threads
  end do

contains

  integer function argument(place, otherwise) result(number)
    integer, intent(in) :: place, otherwise
    character(len=20) :: given
    integer :: status

    number = otherwise
    if (command_argument_count() < place) return
    call get_command_argument(place, given)
    read (given, *, iostat=status) number
    if (status /= 0 .or. number < 1) call fail('argument "'//trim(given)//'": must be a number, 1 or more')
  end function argument

  subroutine tell_memory()
    call progress('bytes of a contact '//text(storage_size(contacts) / 8)// &
                  ', of a state for '//text(int(reversals))//' reversals '// &
                  text(int(8 * mslip_state_length(reversals)))// &
                  ', of a workspace for H = '//text(int(harmonics))//' and '//text(int(samples))//' samples '// &
                  text(int(8 * mslip_harmonic_workspace_length(harmonics, samples)))// &
                  ', between reversals with '//text(int(nodes))//' nodes '// &
                  text(int(8 * mslip_harmonic_workspace_length(harmonics, nodes, MSLIP_BETWEEN_REVERSALS))))
  end subroutine tell_memory

  !> Eight geometries, each under its own load; `like` is given where a contact of the same shape is there.
  subroutine prepare(i, friction_coefficient, contact, like)
    integer, intent(in) :: i
    real(wp), intent(in) :: friction_coefficient
    type(mslip_contact), intent(inout) :: contact
    type(mslip_contact), intent(in), optional :: like
    type(mslip_parameters) :: p
    integer(mslip_int) :: status

    call mslip_parameters_default(p)
    p%flat_half_width = 1.0e-4_wp * mod(i, 8)
    p%edge_radius = 5.0e-3_wp
    p%length = 10.0e-3_wp
    p%normal_force = 50.0_wp + mod(i, 1000)
    p%friction_coefficient = friction_coefficient
    p%material = mslip_material(114.0e9_wp, 0.32_wp)
    if (present(like)) then
      call mslip_contact_init_like(p, like, contact, status)
    else
      call mslip_contact_init(p, contact, status)
    end if
    call require(status)
  end subroutine prepare

  subroutine tell_preparation()
    type(mslip_contact) :: contact
    real(wp) :: start, new, like
    integer :: i

    call cpu_time(start)
    do i = 1, most_contacts
      call prepare(i, 0.4_wp, contacts(i))
    end do
    new = 0.0_wp
    call count_time(new, start)
    do i = 1, most_contacts
      call prepare(i, 0.3_wp, contact, contacts(i))
    end do
    like = 0.0_wp
    call count_time(like, start)
    call progress('preparation: '//microseconds(new)//' us a contact, '//microseconds(like)//' us by one of the same shape')
  end subroutine tell_preparation

  !> The cost of each call by one thread, all contacts at one amplitude.
  subroutine tell_calls(amplitude, sentence)
    real(wp), intent(in) :: amplitude
    character(len=*), intent(in) :: sentence
    real(wp), allocatable :: workspace(:), nodes_workspace(:), force(:,:), jacobian(:,:,:), states(:,:)
    real(wp) :: dissipated(chunk), start, elapsed(5)
    integer(mslip_int) :: status
    integer :: first, last, n, step, i

    call new_workspace(samples, MSLIP_EQUIDISTANT, workspace)
    call new_workspace(nodes, MSLIP_BETWEEN_REVERSALS, nodes_workspace)
    allocate (force(m, chunk), jacobian(m, m, chunk))
    do i = 1, most_contacts
      displacement(:, i) = motion(amplitude * contacts(i)%slip_displacement, i)
    end do
    elapsed = 0.0_wp
    do first = 1, most_contacts, chunk
      last = min(first + chunk - 1, most_contacts)
      n = last - first + 1
      call cpu_time(start)
      call mslip_interface_harmonic_force(contacts(first:last), workspace, displacement(:, first:last), status, &
                                          force=force(:, :n))
      call require(status)
      call count_time(elapsed(1), start)
      call mslip_interface_harmonic_force(contacts(first:last), workspace, displacement(:, first:last), status, &
                                          force=force(:, :n), jacobian=jacobian(:, :, :n), dissipated=dissipated(:n))
      call require(status)
      call count_time(elapsed(2), start)
      call mslip_interface_harmonic_force(contacts(first:last), nodes_workspace, displacement(:, first:last), status, &
                                          force=force(:, :n), jacobian=jacobian(:, :, :n), dissipated=dissipated(:n))
      call require(status)
      call count_time(elapsed(3), start)
      states = virgin_states(n)
      call cpu_time(start)
      do step = 1, steps
        call mslip_interface_masing_update(contacts(first:last), states, &
                                           displacement(2, first:last) * cos(2 * pi * step / steps), status, &
                                           force=force(1, :n), stiffness=dissipated(:n))
        call require(status)
      end do
      call count_time(elapsed(4), start)
    end do
    ! As a march in time does it: all contacts at each step, none of them in the cache.
    states = virgin_states(most_contacts)
    call cpu_time(start)
    do step = 1, steps
      do first = 1, most_contacts, chunk
        last = min(first + chunk - 1, most_contacts)
        n = last - first + 1
        call mslip_interface_masing_update(contacts(first:last), states(:, first:last), &
                                           displacement(2, first:last) * cos(2 * pi * step / steps), status, &
                                           force=force(1, :n), stiffness=dissipated(:n))
        call require(status)
      end do
    end do
    call count_time(elapsed(5), start)
    call progress(sentence//', us a contact: harmonic force '//microseconds(elapsed(1))//', with Jacobian '// &
                  microseconds(elapsed(2))//', between reversals '//microseconds(elapsed(3))//', step in time '// &
                  microseconds(elapsed(4) / steps)//', of all in turn '//microseconds(elapsed(5) / steps))
  end subroutine tell_calls

  !> The processor's time, not that which others take from it.
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

    do i = 1, most_contacts
      amplitude = smallest * (largest / smallest)**(real(i - 1, wp) / max(most_contacts - 1, 1))
      displacement(:, i) = motion(amplitude * contacts(i)%slip_displacement, i)
    end do
  end subroutine spread_amplitudes

  !> A first harmonic with some of the others.
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

  !> The seconds that the work takes.
  real(wp) function seconds_of_work(threads, schedule, answer) result(seconds)
    integer, intent(in) :: threads
    integer(omp_sched_kind), intent(in) :: schedule
    real(wp), intent(inout) :: answer(:,:)
    real(wp) :: start
    integer :: repetition

    call omp_set_schedule(schedule, 0)
    seconds = huge(seconds)
    do repetition = 1, repetitions
      answer = 0.0_wp
      start = omp_get_wtime()
      call work(threads, answer)
      seconds = min(seconds, omp_get_wtime() - start)
    end do
  end function seconds_of_work

  !> Everything that a solver asks of the contacts, by so many threads.
  subroutine work(threads, answer)
    integer, intent(in) :: threads
    real(wp), intent(inout) :: answer(:,:)
    real(wp), allocatable :: workspace(:), jacobian(:,:,:), states(:,:), force(:), stiffness(:)
    integer(mslip_int) :: status
    integer :: first, last, n, step, i

    !$omp parallel num_threads(threads) default(none) shared(threads, most_contacts, contacts, displacement, answer) &
    !$omp private(workspace, jacobian, states, force, stiffness, status, first, last, n, step, i)
    if (omp_get_num_threads() /= threads) call fail('there are no '//text(threads)//' threads to be had')
    call new_workspace(samples, MSLIP_EQUIDISTANT, workspace)
    allocate (jacobian(m, m, chunk), force(chunk), stiffness(chunk))
    !$omp do schedule(runtime)
    do first = 1, most_contacts, chunk
      last = min(first + chunk - 1, most_contacts)
      n = last - first + 1
      call mslip_interface_harmonic_force(contacts(first:last), workspace, displacement(:, first:last), status, &
                                          force=answer(:m, first:last), jacobian=jacobian(:, :, :n), &
                                          dissipated=answer(2 * m + 1, first:last))
      call require(status)
      ! A host adds the Jacobian to its matrix, or multiplies with it, while the chunk is in the cache.
      do i = first, last
        answer(m + 1:2 * m, i) = matmul(jacobian(:, :, i - first + 1), displacement(:, i))
      end do
      states = virgin_states(n)
      do step = 1, steps
        call mslip_interface_masing_update(contacts(first:last), states, &
                                           displacement(2, first:last) * cos(2 * pi * step / steps), status, &
                                           force=force(:n), stiffness=stiffness(:n))
        call require(status)
        answer(2 * m + 1 + step, first:last) = force(:n)
      end do
    end do
    !$omp end do
    !$omp end parallel
  end subroutine work

  subroutine tell_threads(threads, schedule, seconds)
    integer, intent(in) :: threads
    character(len=*), intent(in) :: schedule
    real(wp), intent(in) :: seconds
    logical :: same

    same = .true.
    if (threads > 1) same = all(transfer(alone, [0_int64]) == transfer(together, [0_int64]))
    call progress(text(threads)//' threads, '//schedule//': '//text(seconds, '(f8.3)')//' s, '// &
                  text(one_thread / seconds, '(f6.2)')//' times one thread'// &
                  trim(merge(', same bits  ', ', OTHER BITS ', same)))
    if (.not. same) call fail(text(threads)//' threads: other bits than by one')
  end subroutine tell_threads

  subroutine new_workspace(points, rule, workspace)
    integer(mslip_size), intent(in) :: points
    integer(mslip_int), intent(in) :: rule
    real(wp), allocatable, intent(out) :: workspace(:)
    integer(mslip_int) :: status

    allocate (workspace(mslip_harmonic_workspace_length(harmonics, points, rule)))
    call mslip_harmonic_workspace_init(harmonics, points, workspace, status, rule)
    call require(status)
  end subroutine new_workspace

  function virgin_states(n) result(states)
    integer, intent(in) :: n
    real(wp) :: states(mslip_state_length(reversals), n)
    integer(mslip_int) :: status
    integer :: i

    do i = 1, n
      call mslip_state_init(states(:, i), status)
      call require(status)
    end do
  end function virgin_states

  function microseconds(seconds) result(string)
    real(wp), intent(in) :: seconds
    character(len=:), allocatable :: string
    string = text(1.0e6_wp * seconds / most_contacts, '(f8.3)')
  end function microseconds

  subroutine require(status)
    integer(mslip_int), intent(in) :: status
    if (status /= MSLIP_OK) call fail(mslip_status_text(status))
  end subroutine require
end program contact_threads
