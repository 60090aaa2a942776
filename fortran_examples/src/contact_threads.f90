!> Many contacts on OpenMP threads: bytes, time, and results that are bitwise equal for any number of threads.
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

  integer(mslip_size), parameter :: harmonics = 5, samples = 128, reversals = 8
  integer, parameter :: m = 2 * int(harmonics) + 1
  integer, parameter :: chunk = 64             !! contacts of one call: their Jacobians stay in the cache
  integer, parameter :: steps = 32             !! time steps of a period
  type(mslip_contact), allocatable :: contacts(:)
  real(wp), allocatable :: displacement(:,:), one_thread(:,:), results(:,:)
  real(wp) :: start, seconds, seconds_of_one
  integer :: n, threads, i

  n = positive_argument(1, 20000)
  allocate (contacts(n), displacement(m, n))
  allocate (one_thread(2 * m + 1 + steps, n), results(2 * m + 1 + steps, n))
  call progress('bytes: contact '//text(storage_size(contacts) / 8)//', state for '//text(int(reversals))//' reversals '// &
                text(8 * int(mslip_state_length(reversals)))//', workspace with '//text(int(samples))//' samples '// &
                text(8 * int(mslip_harmonic_workspace_length(harmonics, samples))))
  call cpu_time(start)
  do i = 1, n
    call prepare(i, contacts(i))
  end do
  call cpu_time(seconds)
  call progress('initialisation: '//text(1.0e6_wp * (seconds - start) / n, '(f8.3)')//' us per contact')

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

  !> Eight geometries, each under different loads.
  subroutine prepare(i, contact)
    integer, intent(in) :: i
    type(mslip_contact), intent(inout) :: contact
    type(mslip_parameters) :: p
    integer(mslip_int) :: status

    p = mslip_parameters(flat_half_width=1.0e-4_wp * mod(i, 8), edge_radius=5.0e-3_wp, length=10.0e-3_wp, &
                         normal_force=50.0_wp + mod(i, 1000), friction_coefficient=0.4_wp, &
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
    allocate (workspace(mslip_harmonic_workspace_length(harmonics, samples)))
    call mslip_harmonic_workspace_init(harmonics, samples, workspace, status)
    call require(status)
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

  pure real(wp) function phase(step)
    integer, intent(in) :: step
    phase = cos(2.0_wp * pi * step / steps)
  end function phase

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

  subroutine require(status)
    integer(mslip_int), intent(in) :: status
    if (status /= MSLIP_OK) call fail(mslip_status_text(status))
  end subroutine require
end program contact_threads
