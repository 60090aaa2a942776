!> Many contacts on OpenMP threads, with results that are bitwise equal for any number of threads.
!>
!> `work` is the pattern: each thread has a workspace of its own and evaluates chunks of the contacts, with one batch call for each.
!> The amplitudes grow from the first contact, in microslip, to the last, far in gross slip.
program contact_threads
  use, intrinsic :: iso_fortran_env, only: int64
  use basics, only: fail, progress, text, wp
  use microslip
  use omp_lib, only: omp_get_num_threads
  implicit none

  integer(mslip_size), parameter :: harmonics = 5, samples = 128
  integer, parameter :: m = 2 * int(harmonics) + 1, n = 2000
  integer, parameter :: chunk = 64             !! contacts of one call: their Jacobians stay in the cache
  type(mslip_contact) :: contacts(n)
  type(mslip_parameters) :: p
  real(wp), dimension(m, n) :: displacement = 0.0_wp, force, one_thread
  integer(mslip_int) :: status
  integer :: i, threads

  call mslip_parameters_default(p)
  p%edge_radius = 5.0e-3_wp; p%length = 10.0e-3_wp; p%friction_coefficient = 0.4_wp
  p%material = mslip_material(114.0e9_wp, 0.32_wp); p%displacement_reference = MSLIP_RIGID_STRIP
  do i = 1, n
    p%flat_half_width = 1.0e-4_wp * mod(i, 8)
    p%normal_force = 50.0_wp + mod(i, 1000)
    call mslip_contact_init(p, contacts(i), status)
    call require(status)
    displacement(2, i) = 0.02_wp * 150.0_wp**(real(i, wp) / n) * contacts(i)%slip_displacement
    displacement(5, i) = 0.1_wp * displacement(2, i)
  end do
  do threads = 1, 4
    call work(threads)
    if (threads == 1) one_thread = force
    if (any(transfer(one_thread, [0_int64]) /= transfer(force, [0_int64]))) call fail('results differ from those of one thread')
    call progress(text(threads)//' threads: equal results')
  end do

contains

  subroutine work(threads)
    integer, intent(in) :: threads
    real(wp), allocatable :: workspace(:), jacobian(:,:,:)
    integer(mslip_int) :: status
    integer :: first, last

    !$omp parallel num_threads(threads) private(workspace, jacobian, status, last)
    if (omp_get_num_threads() /= threads) call fail(text(threads)//' threads are not available')
    allocate (workspace(mslip_harmonic_workspace_length(harmonics, samples)), jacobian(m, m, chunk))
    call mslip_harmonic_workspace_init(harmonics, samples, workspace, status)
    call require(status)
    !$omp do
    do first = 1, n, chunk
      last = min(first + chunk - 1, n)
      call mslip_batch_harmonic_force(contacts(first:last), workspace, displacement(:, first:last), status, &
                                      force=force(:, first:last), jacobian=jacobian(:, :, :last - first + 1))
      call require(status)
      ! A solver adds the Jacobian to its matrix, or multiplies with it, while the chunk is in the cache.
    end do
    !$omp end do
    !$omp end parallel
  end subroutine work

  subroutine require(status)
    integer(mslip_int), intent(in) :: status
    if (status /= MSLIP_OK) call fail(mslip_status_text(status))
  end subroutine require
end program contact_threads
