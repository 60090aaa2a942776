!> Many contacts on OpenMP threads: time, and results that are bitwise equal for any number of threads.
!>
!>     contact_threads CONTACTS MAX_THREADS
!>
!> `work` is the pattern: each thread has a workspace of its own and evaluates chunks of the contacts. The amplitudes grow from
!> the first contact, in microslip, to the last, far in gross slip, so that equal numbers of contacts are unequal work.
program contact_threads
  use, intrinsic :: iso_fortran_env, only: int64
  use basics, only: argument, fail, path_length, pi, progress, text, wp
  use microslip
  use omp_lib, only: omp_get_num_threads, omp_get_wtime
  implicit none

  integer(mslip_size), parameter :: harmonics = 5, samples = 128, reversals = 8
  integer, parameter :: m = 2 * int(harmonics) + 1
  integer, parameter :: chunk = 64             !! contacts of one call: their Jacobians stay in the cache
  integer, parameter :: steps = 32             !! time steps of a period
  character(len=*), parameter :: usage = 'contact_threads CONTACTS MAX_THREADS'
  character(len=path_length) :: given
  type(mslip_contact), allocatable :: contacts(:)
  real(wp), allocatable :: displacement(:,:), one_thread(:,:), results(:,:)
  real(wp) :: start
  integer :: n, most, threads, i

  given = argument(1, usage)
  read (given, *) n
  given = argument(2, usage)
  read (given, *) most
  allocate (contacts(n), displacement(m, n))
  allocate (results(2 * m + 1 + steps, n), one_thread(2 * m + 1 + steps, n))
  do i = 1, n
    call prepare(i, 0.02_wp * 150.0_wp**(real(i - 1, wp) / max(n - 1, 1)))
  end do
  threads = 1
  do while (threads <= most)
    results = 0.0_wp
    start = omp_get_wtime()
    call work(threads)
    call progress(text(threads)//' threads: '//text(omp_get_wtime() - start, '(f8.3)')//' s')
    if (threads == 1) one_thread = results
    if (any(transfer(one_thread, [0_int64]) /= transfer(results, [0_int64]))) call fail('results differ from those of one thread')
    threads = 2 * threads
  end do

contains

  !> Eight geometries, each under different loads; a first harmonic of this amplitude, relative to slip_displacement, and smaller
  !> higher ones.
  subroutine prepare(i, amplitude)
    integer, intent(in) :: i
    real(wp), intent(in) :: amplitude
    type(mslip_parameters) :: p
    integer(mslip_int) :: status
    integer :: k

    call mslip_parameters_default(p)
    p%flat_half_width = 1.0e-4_wp * mod(i, 8)
    p%edge_radius = 5.0e-3_wp
    p%length = 10.0e-3_wp
    p%normal_force = 50.0_wp + mod(i, 1000)
    p%friction_coefficient = 0.4_wp
    p%material = mslip_material(114.0e9_wp, 0.32_wp)
    p%displacement_reference = MSLIP_RIGID_STRIP
    call mslip_contact_init(p, contacts(i), status)
    call require(status)
    displacement(1, i) = 0.0_wp
    do k = 1, int(harmonics)
      displacement(2*k:2*k + 1, i) = amplitude * contacts(i)%slip_displacement / k**3 * [cos(real(i * k, wp)), sin(real(i * k, wp))]
    end do
  end subroutine prepare

  !> Force and Jacobian of a balance, and a period of time steps, of all contacts on the given number of threads.
  subroutine work(threads)
    integer, intent(in) :: threads
    real(wp), allocatable :: workspace(:), jacobian(:,:,:), states(:,:)
    integer(mslip_int) :: status
    integer :: first, last, step, i

    !$omp parallel num_threads(threads) default(none) shared(threads, n, contacts, displacement, results) &
    !$omp private(workspace, jacobian, states, status, first, last, step, i)
    if (omp_get_num_threads() /= threads) call fail(text(threads)//' threads are not available')
    allocate (workspace(mslip_harmonic_workspace_length(harmonics, samples)))
    call mslip_harmonic_workspace_init(harmonics, samples, workspace, status)
    call require(status)
    allocate (jacobian(m, m, chunk), states(mslip_state_length(reversals), chunk))
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
        call mslip_state_init(states(:, i - first + 1), status)
      end do
      do step = 1, steps
        call mslip_batch_masing_advance(contacts(first:last), states(:, :last - first + 1), &
                                        displacement(2, first:last) * cos(2.0_wp * pi * step / steps), status, &
                                        force=results(2 * m + 1 + step, first:last))
        call require(status)
      end do
    end do
    !$omp end do
    !$omp end parallel
  end subroutine work

  subroutine require(status)
    integer(mslip_int), intent(in) :: status
    if (status /= MSLIP_OK) call fail(mslip_status_text(status))
  end subroutine require
end program contact_threads
