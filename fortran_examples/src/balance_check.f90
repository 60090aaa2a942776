!> Checks of the harmonic balance without stored results.
!>
!>     balance_check CASE
!>
!> * The smallest stick zone of each contact with the microslip law: 0 in gross slip, wider than the flat before it.
!> * At the frequencies of the group &points of CASE:
!>   * the derivatives of the residual against central differences;
!>   * the energy supplied by the excitation against that dissipated by damping and contacts.
program balance_check
  use case_input, only: case_data, read_case
  use case_problem, only: prepare_problem
  use friction_contacts, only: law_microslip
  use fourier_series, only: as_complex
  use harmonic_balance, only: balance_point, balance_problem, evaluate, solve_from_rest, structure_response
  use kinds, only: path_length, pi, wp
  use messages, only: fail, progress, text
  implicit none

  ! Central differences with relative steps of 1e-6 leave about 1e-16/1e-6 of rounding, more where the residual is a
  ! small difference; the laws' curvature adds about as much.
  real(wp), parameter :: relative_step = 1.0e-6_wp, derivative_tolerance = 1.0e-5_wp
  ! The dissipated energy is that of the continuous motion, the balance that of the samples: their difference falls with
  ! the square of the samples and is about 1e-3 with 64.
  real(wp), parameter :: energy_tolerance = 1.0e-2_wp

  character(len=path_length) :: case_file
  type(case_data) :: data
  type(balance_problem) :: problem
  type(balance_point) :: point
  real(wp), allocatable :: displacement(:,:)
  real(wp) :: omega
  logical :: converged
  integer :: i

  if (command_argument_count() /= 1) call fail('usage: balance_check CASE')
  call get_command_argument(1, case_file)
  call read_case(trim(case_file), data)
  if (size(data%frequencies) == 0) call fail(trim(case_file)//': the group &points is missing')
  call prepare_problem(data, 1.0_wp, data%harmonics, data%samples, problem)
  allocate (displacement(2 * data%harmonics + 1, size(data%contacts)))
  call check_stick_zones()
  do i = 1, size(data%frequencies)
    omega = 2.0_wp * pi * data%frequencies(i)
    call solve_from_rest(problem, omega, displacement, point, converged)
    if (.not. converged) call fail('no harmonic balance found at '//text(data%frequencies(i))//' Hz')
    call check_energy()
    call check_derivatives()
  end do

contains

  subroutine check_stick_zones()
    real(wp) :: coefficients(2 * data%harmonics + 1), before, beyond
    integer :: contact

    coefficients = 0.0_wp
    do contact = 1, size(data%contacts)
      if (data%contacts(contact)%law /= law_microslip) cycle
      associate (prepared => problem%contacts%prepared(contact))
        coefficients(2) = 0.5_wp * prepared%slip_displacement
        before = problem%contacts%min_stick_half_width(contact, coefficients)
        coefficients(2) = 2.0_wp * prepared%slip_displacement
        beyond = problem%contacts%min_stick_half_width(contact, coefficients)
        if (.not. (before > data%contacts(contact)%parameters%flat_half_width .and. before < prepared%half_width)) then
          call fail('contact '//trim(data%contacts(contact)%name)//': the stick zone before gross slip is '//text(before)//' m')
        end if
        if (abs(beyond) > 0.0_wp) then
          call fail('contact '//trim(data%contacts(contact)%name)//': the stick zone in gross slip is '//text(beyond)//' m')
        end if
      end associate
    end do
  end subroutine check_stick_zones

  subroutine check_energy()
    real(wp) :: response(size(displacement, 1), size(problem%excitation)), supplied, damped, rubbed, difference
    complex(wp) :: amplitude(size(problem%excitation))
    integer :: k, j

    call evaluate(problem, omega, displacement, point)
    response = structure_response(problem, point)
    damped = 0.0_wp
    supplied = 0.0_wp
    do k = 1, data%harmonics
      amplitude = [(as_complex(response(:, j), k), j=1, size(amplitude))]
      damped = damped + pi * k * omega * k * real(dot_product(amplitude, matmul(problem%model%damping, amplitude)))
      if (k == 1) supplied = pi * aimag(dot_product(amplitude, problem%excitation))
    end do
    rubbed = sum(point%dissipated)
    difference = abs(supplied - damped - rubbed) / supplied
    call progress(text(data%frequencies(i), '(f10.2)')//' Hz: supplied '//text(supplied)//' J, damping '// &
                  text(damped)//' J, friction '//text(rubbed)//' J, difference '//text(difference, '(es8.1)'))
    if (.not. difference <= energy_tolerance) then
      call fail('the energy balance is off by more than '//text(energy_tolerance))
    end if
  end subroutine check_energy

  subroutine check_derivatives()
    type(balance_point) :: ahead, behind
    real(wp) :: moved(size(displacement, 1), size(displacement, 2)), step, worst, reference(size(displacement))
    integer :: coefficient, contact, column, m

    m = size(displacement, 1)
    worst = 0.0_wp
    do contact = 1, size(displacement, 2)
      step = relative_step * norm2(displacement(:, contact))
      do coefficient = 1, m
        column = (contact - 1) * m + coefficient
        moved = displacement
        moved(coefficient, contact) = displacement(coefficient, contact) + step
        call evaluate(problem, omega, moved, ahead)
        moved(coefficient, contact) = displacement(coefficient, contact) - step
        call evaluate(problem, omega, moved, behind)
        reference = reshape(ahead%residual - behind%residual, [size(displacement)]) / (2.0_wp * step)
        worst = max(worst, maxval(abs(point%jacobian(:, column) - reference)) / maxval(abs(reference)))
      end do
    end do
    step = relative_step * omega
    call evaluate(problem, omega + step, displacement, ahead)
    call evaluate(problem, omega - step, displacement, behind)
    reference = reshape(ahead%residual - behind%residual, [size(displacement)]) / (2.0_wp * step)
    worst = max(worst, maxval(abs(reshape(point%by_omega, [size(displacement)]) - reference)) / maxval(abs(reference)))
    call progress('    derivatives of the residual against central differences: '//text(worst, '(es8.1)'))
    if (.not. worst <= derivative_tolerance) then
      call fail('the derivatives differ from central differences by more than '//text(derivative_tolerance))
    end if
  end subroutine check_derivatives
end program balance_check
