! An OpenMP host: contacts shared by threads, each with a workspace of its own, give the bits of one thread.
program threads
  use microslip
  implicit none
  integer(mslip_size), parameter :: harmonics = 3, samples = 64
  integer, parameter :: n = 2*int(harmonics) + 1, items = 48
  type(mslip_contact) :: contacts(items)
  real(mslip_real) :: alone(n*n + n + 1, items), together(n*n + n + 1, items)
  integer :: count, passed, failed, i

  !$omp parallel do num_threads(8)
  do i = 1, items
    call prepare(i, contacts(i))
  end do
  call work(1, alone)
  passed = 0; failed = 0; count = 2
  do while (count <= 8)
    call work(count, together)
    do i = 1, items
      if (all(transfer(alone(:, i), [0_mslip_size]) == transfer(together(:, i), [0_mslip_size]))) then
        passed = passed + 1
      else
        failed = failed + 1
      end if
    end do
    count = 2*count
  end do
  print '(i0, a, i0, a)', passed, ' passed, ', failed, ' failed'
  if (failed > 0) error stop

contains

  subroutine prepare(item, contact)
    integer, intent(in) :: item
    type(mslip_contact), intent(out) :: contact
    type(mslip_parameters) :: p
    integer(mslip_int) :: status
    call mslip_parameters_default(p)
    p%flat_half_width = 1e-4_mslip_real*mod(item, 4); p%edge_radius = 2e-3_mslip_real; p%length = 2e-2_mslip_real
    p%normal_force = 10 + item; p%friction_coefficient = 0.4_mslip_real
    p%material = mslip_material(2.1e11_mslip_real, 0.3_mslip_real)
    call mslip_contact_init(p, contact, status)
    if (status /= MSLIP_OK) error stop 'no contact'
  end subroutine prepare

  subroutine work(threads, answers)
    integer, intent(in) :: threads
    real(mslip_real), intent(out) :: answers(:, :)
    integer :: k
    !$omp parallel do num_threads(threads) schedule(dynamic)
    do k = 1, items
      call ask(contacts(k), mod(k, 2), answers(:, k))
    end do
  end subroutine work

  subroutine ask(contact, rule, answer)
    type(mslip_contact), intent(in) :: contact
    integer, intent(in) :: rule
    real(mslip_real), intent(out) :: answer(:)
    real(mslip_real), allocatable :: workspace(:)
    real(mslip_real) :: displacement(n), jacobian(n, n)
    integer(mslip_int) :: status
    allocate (workspace(mslip_harmonic_workspace_length(harmonics, samples, int(rule, mslip_int))))
    call mslip_harmonic_workspace_init(harmonics, samples, workspace, status, int(rule, mslip_int))
    if (status /= MSLIP_OK) error stop 'no workspace'
    displacement = 0.1_mslip_real*contact%slip_displacement
    displacement(2) = 1.1_mslip_real*contact%slip_displacement
    call mslip_harmonic_force(contact, workspace, displacement, status, answer(:n), jacobian, answer(n*n + n + 1))
    if (status /= MSLIP_OK) error stop 'no force'
    answer(n + 1:n + n*n) = reshape(jacobian, [n*n])
  end subroutine ask
end program threads
