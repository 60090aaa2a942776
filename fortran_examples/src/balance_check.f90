!> Checks of the harmonic balance without stored results, at the single frequencies of a case:
!> the derivatives of the residual against central differences, the energy supplied against that dissipated, and the harmonic
!> force of the contacts against two periods of time steps.
!>
!>     balance_check CASE
program balance_check
  use basics, only: argument, fail, pi, progress, text, wp
  use case_input, only: case_data, prepare_problem, read_case
  use fourier_series, only: get_harmonic, series_basis
  use harmonic_balance, only: balance_point, balance_problem, evaluate, solve_from_rest, structure_response
  implicit none

  ! Rounding of 1e-16/1e-6, more where the residual is a small difference; the curvature of the laws adds about as much.
  real(wp), parameter :: relative_step = 1.0e-6_wp, derivative_tolerance = 1.0e-5_wp
  ! Energies are those of the continuous motion, the balance that of the samples: they differ by about 1e-3 with 64.
  real(wp), parameter :: energy_tolerance = 1.0e-2_wp
  ! Rounding.
  real(wp), parameter :: step_tolerance = 1.0e-10_wp
  type(case_data) :: data
  type(balance_problem) :: problem
  type(balance_point) :: point
  real(wp), allocatable :: displacement(:,:)
  real(wp) :: omega
  logical :: converged
  integer :: i

  call read_case(trim(argument(1, 'balance_check CASE')), data)
  if (size(data%frequencies) == 0) call fail('frequency is needed')
  call prepare_problem(data, 1.0_wp, data%harmonics, data%samples, problem)
  allocate (displacement(2 * data%harmonics + 1, size(data%contacts)))
  do i = 1, size(data%frequencies)
    omega = 2.0_wp * pi * data%frequencies(i)
    call solve_from_rest(problem, omega, displacement, point, converged)
    if (.not. converged) call fail('no harmonic balance found at '//text(data%frequencies(i), '(f12.3)')//' Hz')
    call check('energy', energy_difference(), energy_tolerance)
    call check('derivatives', derivative_difference(), derivative_tolerance)
    call check('time steps', step_difference(), step_tolerance)
  end do

contains

  subroutine check(name, difference, tolerance)
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: difference, tolerance

    call progress(text(data%frequencies(i), '(f12.2)')//' Hz, '//name//': '//text(difference, '(es8.1)'))
    if (.not. difference <= tolerance) call fail(name//': the difference is too large')
  end subroutine check

  !> Energy supplied per period by the excitation minus that dissipated by damping and contacts, relative.
  real(wp) function energy_difference() result(difference)
    real(wp) :: response(size(displacement, 1), size(problem%excitation)), supplied, damped
    complex(wp) :: amplitude(size(problem%excitation))
    integer :: k

    response = structure_response(problem, point)
    damped = 0.0_wp
    supplied = pi * dot_product(response(3, :), problem%excitation)
    do k = 1, data%harmonics
      amplitude = get_harmonic(response, k)
      damped = damped + pi * k * omega * k * real(dot_product(amplitude, matmul(problem%model%damping, amplitude)))
    end do
    difference = abs(supplied - damped - sum(point%dissipated)) / supplied
  end function energy_difference

  !> Largest difference of a column of the Jacobian, or of dR/domega, from central differences, relative to the column.
  real(wp) function derivative_difference() result(worst)
    type(balance_point) :: here, ahead, behind
    real(wp) :: moved(size(displacement, 1), size(displacement, 2)), step
    integer :: coefficient, contact, m

    m = size(displacement, 1)
    call evaluate(problem, omega, displacement, here)
    step = relative_step * omega
    call evaluate(problem, omega + step, displacement, ahead)
    call evaluate(problem, omega - step, displacement, behind)
    worst = difference(here%by_omega, (ahead%residual - behind%residual) / (2.0_wp * step))
    do contact = 1, size(displacement, 2)
      step = relative_step * norm2(displacement(2:, contact))
      do coefficient = 1, m
        moved = displacement
        moved(coefficient, contact) = displacement(coefficient, contact) + step
        call evaluate(problem, omega, moved, ahead)
        moved(coefficient, contact) = displacement(coefficient, contact) - step
        call evaluate(problem, omega, moved, behind)
        worst = max(worst, difference(reshape(here%jacobian(:, (contact - 1) * m + coefficient), shape(moved)), &
                                      (ahead%residual - behind%residual) / (2.0_wp * step)))
      end do
    end do
  end function derivative_difference

  !> Largest difference of the force coefficients of a contact from those of the forces of time steps at the samples, relative.
  real(wp) function step_difference() result(worst)
    real(wp), allocatable :: states(:,:)
    real(wp) :: basis(data%samples, size(displacement, 1)), force(data%samples, size(displacement, 2))
    real(wp) :: coefficients(size(displacement, 1), size(displacement, 2))
    integer :: j

    basis = series_basis(data%harmonics, data%samples)
    call problem%contacts%steady_cycle(matmul(basis, displacement), states, force)
    coefficients = 2.0_wp / data%samples * matmul(transpose(basis), force)
    coefficients(1, :) = 0.5_wp * coefficients(1, :)
    worst = 0.0_wp
    do j = 1, size(displacement, 2)
      worst = max(worst, maxval(abs(coefficients(:, j) - point%force(:, j))) / maxval(abs(point%force(:, j))))
    end do
  end function step_difference

  pure real(wp) function difference(column, reference)
    real(wp), intent(in) :: column(:,:), reference(:,:)
    difference = maxval(abs(column - reference)) / maxval(abs(reference))
  end function difference
end program balance_check
