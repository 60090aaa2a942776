!> Newmark's method with constant average acceleration for a linear structure with friction contacts.
module newmark
  use basics, only: fail, text, wp
  use dense_algebra, only: solve
  use harmonic_balance, only: balance_problem
  implicit none
  private
  public :: prepare_newmark, newmark_step

  type, public :: motion
    real(wp), allocatable :: displacement(:), velocity(:), acceleration(:)
    real(wp), allocatable :: states(:,:)         !! of the contacts at the last instant
    real(wp), allocatable :: contact_displacement(:), contact_force(:)
  end type motion

  !> Constant matrices of Newmark's method.
  type, public :: newmark_scheme
    real(wp) :: step = 0.0_wp
    real(wp), allocatable :: inverse(:,:)        !! of M + step/2 D + step**2/4 K
    real(wp), allocatable :: by_force(:,:)       !! inverse times B
    real(wp), allocatable :: compliance(:,:)     !! step**2/4 B^T inverse B
    real(wp), allocatable :: contact_scale(:)    !! size of the displacement of each contact
  end type newmark_scheme

contains

  !> One step of Newmark's method; `excitation` is the force at its end. Since the structure is linear, the only unknowns are
  !> the relative displacements u of the contacts. It is written for the accelerations: in displacements, short steps would
  !> cancel.
  subroutine newmark_step(scheme, problem, excitation, state)
    type(newmark_scheme), intent(in) :: scheme
    type(balance_problem), intent(in) :: problem
    real(wp), intent(in) :: excitation(:)
    type(motion), intent(inout) :: state
    integer, parameter :: newton_steps = 50, halvings = 8
    real(wp), parameter :: newton_tolerance = 1.0e-12_wp
    real(wp), dimension(size(excitation)) :: displacement, velocity, acceleration
    real(wp), dimension(size(problem%incidence, 2)) :: u, u_free, force, tangent, residual, start
    real(wp) :: trial(size(state%states, 1), size(state%states, 2)), matrix(size(u), size(u)), correction(size(u), 1)
    real(wp) :: fraction, size_before
    integer :: iteration, halving, i

    associate (h => scheme%step, model => problem%model)
      displacement = state%displacement + h * state%velocity + 0.25_wp * h**2 * state%acceleration
      velocity = state%velocity + 0.5_wp * h * state%acceleration
      acceleration = matmul(scheme%inverse, excitation - matmul(model%damping, velocity) &
                            - matmul(model%stiffness, displacement))
      u_free = matmul(displacement + 0.25_wp * h**2 * acceleration, problem%incidence)

      u = matmul(displacement + 0.25_wp * h**2 * state%acceleration, problem%incidence)
      call try()
      do iteration = 1, newton_steps
        if (all(abs(residual) <= newton_tolerance * scheme%contact_scale)) exit
        do i = 1, size(u)
          matrix(:, i) = scheme%compliance(:, i) * tangent(i)
          matrix(i, i) = matrix(i, i) + 1.0_wp
        end do
        correction(:, 1) = residual
        call solve(matrix, correction)
        start = u
        size_before = norm2(residual / scheme%contact_scale)
        fraction = 1.0_wp
        ! A step that does not reduce the residual is halved, as in the balance.
        do halving = 0, halvings
          u = start + fraction * correction(:, 1)
          call try()
          if (norm2(residual / scheme%contact_scale) < size_before) exit
          fraction = 0.5_wp * fraction
        end do
      end do
      if (iteration > newton_steps) call fail('time step: no equilibrium within '//text(newton_steps)//' iterations')

      acceleration = acceleration - matmul(scheme%by_force, force)
      state%displacement = displacement + 0.25_wp * h**2 * acceleration
      state%velocity = velocity + 0.5_wp * h * acceleration
    end associate
    state%acceleration = acceleration
    state%states = trial                  ! the step is accepted
    state%contact_displacement = u
    state%contact_force = force

  contains

    !> A trial step of all contacts from the last accepted states, which are not modified.
    subroutine try()
      call problem%contacts%try_step(state%states, u, trial, force, tangent)
      residual = u_free - u - matmul(scheme%compliance, force)
    end subroutine try
  end subroutine newmark_step

  subroutine prepare_newmark(problem, step, contact_scale, scheme)
    type(balance_problem), intent(in) :: problem
    real(wp), intent(in) :: step, contact_scale(:)
    type(newmark_scheme), intent(out) :: scheme
    real(wp), allocatable :: matrix(:,:)
    integer :: i

    scheme%step = step
    scheme%contact_scale = contact_scale
    matrix = problem%model%mass + 0.5_wp * step * problem%model%damping + 0.25_wp * step**2 * problem%model%stiffness
    allocate (scheme%inverse(size(matrix, 1), size(matrix, 1)), source=0.0_wp)
    do i = 1, size(matrix, 1)
      scheme%inverse(i, i) = 1.0_wp
    end do
    call solve(matrix, scheme%inverse)
    scheme%by_force = matmul(scheme%inverse, problem%incidence)
    scheme%compliance = 0.25_wp * step**2 * matmul(transpose(problem%incidence), scheme%by_force)
  end subroutine prepare_newmark
end module newmark

!> Time integration by Newmark's method with constant average acceleration, compared with the harmonic balance in the steady
!> state.
!>
!>     time_integration CASE DIRECTORY
!>
!> Each group &time_integration of CASE has a frequency and numbers of harmonics. The motion starts from the last balance,
!> so that the transient is small, and is integrated until it is periodic. Written to DIRECTORY, for a case called NAME:
!> * NAME_comparison.csv  the differences, for every group and number of harmonics;
!> * NAME_waveforms.csv   displacement of the first contact over one period, by both; 0 harmonics: time integration;
!> * NAME_modes.csv       natural frequencies with the contacts at their initial stiffness, over that of the excitation, and the
!>   displacement of the first contact in each mode, relative to the largest: harmonics near such a mode are amplified;
!> * NAME_spectrum.csv    amplitude of each harmonic of the force of the first contact by time integration, over the first.
!>
!> The exit code is 1 if the peak of the last balance of a group differs by more than its allowed_difference.
program time_integration
  use basics, only: argument, fail, open_table, pi, progress, row, text, wp
  use case_input, only: case_data, integration_input, prepare_problem, read_case
  use dense_algebra, only: solve, symmetric_modes
  use fourier_series, only: harmonic_amplitude, series_basis, series_peak
  use harmonic_balance, only: balance_point, balance_problem, solve_at, solve_from_rest, structure_response
  use newmark, only: motion, newmark_scheme, newmark_step, prepare_newmark
  implicit none

  character(len=*), parameter :: usage = 'time_integration CASE DIRECTORY'
  integer, parameter :: waveform_points = 256, max_periods = 3000

  !> One period of the response, and of displacement and force of the first contact.
  type :: waveform
    real(wp), allocatable :: response(:), displacement(:), force(:)
  end type waveform

  character(len=:), allocatable :: prefix
  type(case_data) :: data
  integer :: table, waveforms, modes, spectrum, group

  call read_case(trim(argument(1, usage)), data)
  prefix = trim(argument(2, usage))//'/'//trim(data%name)
  if (size(data%integrations) == 0) call fail('a group &time_integration is needed')
  table = open_table(prefix//'_comparison.csv', 'load_factor,harmonics,peak_balance_m,peak_time_integration_m,'// &
    'peak_difference,response_difference,displacement_difference')
  waveforms = open_table(prefix//'_waveforms.csv', 'load_factor,harmonics,phase_rad,displacement_m')
  modes = open_table(prefix//'_modes.csv', 'load_factor,order,participation')
  spectrum = open_table(prefix//'_spectrum.csv', 'load_factor,harmonic,contact_force')
  do group = 1, size(data%integrations)
    call compare(data%integrations(group))
  end do

contains

  subroutine compare(input)
    type(integration_input), intent(in) :: input
    type(balance_problem) :: problem
    type(waveform) :: balances(size(input%harmonics)), integrated
    real(wp), allocatable :: displacement(:,:), response(:,:)
    real(wp) :: peak(size(balances)), integrated_peak, difference(3)
    integer :: k

    do k = 1, size(balances)
      call solve_balance(input, input%harmonics(k), problem, displacement, response, balances(k), peak(k))
    end do
    call integrate(input, problem, displacement, response, integrated)
    integrated_peak = maxval(abs(integrated%response - sum(integrated%response) / size(integrated%response)))
    call write_waveform(input, 0, integrated)
    call write_harmonics(input, problem, integrated%force)
    do k = 1, size(balances)
      difference = [abs(peak(k) / integrated_peak - 1.0_wp), &
                    relative_difference(balances(k)%response, integrated%response), &
                    relative_difference(balances(k)%displacement, integrated%displacement)]
      write (table, row) input%load_factor, input%harmonics(k), peak(k), integrated_peak, difference
      call write_waveform(input, input%harmonics(k), balances(k))
      call progress('  '//text(input%harmonics(k))//' harmonics: peak '//text(1.0e6_wp * peak(k), '(f10.4)')// &
                    ' um, time integration '//text(1.0e6_wp * integrated_peak, '(f10.4)')//' um, waveform '// &
                    text(difference(2), '(es8.1)')//', contact '//text(difference(3), '(es8.1)'))
    end do
    if (.not. difference(1) <= input%allowed_difference) &
      call fail('balance and time integration differ by more than '//text(input%allowed_difference, '(es8.1)'))
  end subroutine compare

  !> Steady state by harmonic balance: displacements of the contacts, of the structure, and the waveforms. On entry `displacement`
  !> may have those of another number of harmonics.
  subroutine solve_balance(input, harmonics, problem, displacement, response, waves, peak)
    type(integration_input), intent(in) :: input
    integer, intent(in) :: harmonics
    type(balance_problem), intent(out) :: problem
    real(wp), allocatable, intent(inout) :: displacement(:,:)
    real(wp), allocatable, intent(out) :: response(:,:)
    type(waveform), intent(out) :: waves
    real(wp), intent(out) :: peak
    type(balance_point) :: point
    real(wp) :: basis(input%steps_per_period, 2 * harmonics + 1), trial(2 * harmonics + 1, size(data%contacts))
    logical :: converged
    integer :: m

    call prepare_problem(data, input%load_factor, harmonics, input%samples, problem)
    converged = .false.
    if (allocated(displacement)) then
      trial = 0.0_wp
      m = min(size(trial, 1), size(displacement, 1))
      trial(:m, :) = displacement(:m, :)
      call solve_at(problem, 2.0_wp * pi * input%frequency, trial, point, converged)
    end if
    if (.not. converged) call solve_from_rest(problem, 2.0_wp * pi * input%frequency, trial, point, converged)
    if (.not. converged) call fail('no harmonic balance with '//text(harmonics)//' harmonics found')
    displacement = trial
    response = structure_response(problem, point)
    peak = series_peak(response(:, data%response_dof))
    basis = series_basis(harmonics, input%steps_per_period)
    waves%displacement = matmul(basis, displacement(:, 1))
    waves%response = matmul(basis, response(:, data%response_dof))
  end subroutine solve_balance

  !> Integrates until the remaining transient is below the tolerance of the group, relative to the response.
  subroutine integrate(input, problem, contact_displacement, response, waves)
    type(integration_input), intent(in) :: input
    type(balance_problem), intent(in) :: problem
    real(wp), intent(in) :: contact_displacement(:,:), response(:,:)
    type(waveform), intent(out) :: waves
    type(newmark_scheme) :: scheme
    type(motion) :: state
    real(wp) :: cosine(input%steps_per_period, 3), before(input%steps_per_period), decay, remaining
    integer :: j, k, period

    call prepare_newmark(problem, 1.0_wp / (input%frequency * input%steps_per_period), norm2(contact_displacement, dim=1), scheme)
    call start_motion(2.0_wp * pi * input%frequency, input%steps_per_period, problem, contact_displacement, response, state)
    cosine = series_basis(1, input%steps_per_period)
    waves%response = 0.0_wp * cosine(:, 2)
    waves%displacement = waves%response
    waves%force = waves%response
    decay = exp(-slowest_decay(problem) / input%frequency)
    do period = 1, max_periods
      before = waves%response
      do j = 1, input%steps_per_period
        k = modulo(j, input%steps_per_period) + 1
        call newmark_step(scheme, problem, problem%excitation * cosine(k, 2), state)
        waves%response(k) = state%displacement(data%response_dof)
        waves%displacement(k) = state%contact_displacement(1)
        waves%force(k) = state%contact_force(1)
      end do
      ! The sum of all further changes by a transient that shrinks by the factor `decay` in each period.
      remaining = relative_difference(before, waves%response) * decay / (1.0_wp - decay)
      if (remaining <= input%steady_tolerance) exit
    end do
    if (period > max_periods) call fail('not periodic after '//text(max_periods)//' periods')
    call progress(trim(data%name)//', '//text(input%frequency, '(f10.2)')//' Hz: periodic after '//text(period)//' periods of '// &
                  text(input%steps_per_period)//' steps, remaining transient '//text(remaining, '(es8.1)'))
  end subroutine integrate

  !> The motion of a balance at t = 0.
  subroutine start_motion(omega, steps, problem, contact_displacement, response, state)
    real(wp), intent(in) :: omega, contact_displacement(:,:), response(:,:)
    integer, intent(in) :: steps
    type(balance_problem), intent(in) :: problem
    type(motion), intent(out) :: state
    real(wp) :: basis(steps, size(response, 1)), rate(size(response, 1)), force(steps, size(contact_displacement, 2))
    real(wp) :: matrix(size(response, 2), size(response, 2)), right(size(response, 2), 1)
    integer :: k

    basis = series_basis(size(response, 1) / 2, steps)
    rate = 0.0_wp
    do k = 1, size(rate) / 2
      rate(2*k + 1) = k * omega       ! d/dt at t = 0: sine terms only
    end do
    state%displacement = matmul(basis(1, :), response)
    state%velocity = matmul(rate, response)
    ! Periods of the contacts that end at t = 0.
    call problem%contacts%steady_cycle(cshift(matmul(basis, contact_displacement), 1, dim=1), state%states, force)
    ! Acceleration from the equation of motion.
    matrix = problem%model%mass
    right(:, 1) = problem%excitation - matmul(problem%model%damping, state%velocity) &
                  - matmul(problem%model%stiffness, state%displacement) - matmul(problem%incidence, force(steps, :))
    call solve(matrix, right)
    state%acceleration = right(:, 1)
  end subroutine start_motion

  !> Lower bound of the rate at which a motion decays, by the damping of the structure alone: half the smallest eigenvalue of
  !> D x = lambda M x, for any stiffness. Friction can only increase it.
  real(wp) function slowest_decay(problem) result(rate)
    type(balance_problem), intent(in) :: problem
    real(wp) :: root(size(problem%excitation)), shapes(size(problem%excitation), size(problem%excitation))

    call symmetric_modes(problem%model%damping, problem%model%mass, root, shapes)
    rate = 0.5_wp * root(1)**2
    if (rate <= 0.0_wp) call fail('time integration needs a damping matrix that is positive definite')
  end function slowest_decay

  !> What decides how many harmonics a balance needs: the modes with sticking contacts, and the harmonics of the contact force.
  subroutine write_harmonics(input, problem, force)
    type(integration_input), intent(in) :: input
    real(wp), intent(in) :: force(:)
    type(balance_problem), intent(in) :: problem
    integer, parameter :: most = 61
    real(wp) :: scaled(size(problem%excitation), size(data%contacts)), amplitude(0:most)
    real(wp) :: omega(size(problem%excitation)), shown(size(omega)), shapes(size(omega), size(omega))
    integer :: i

    do i = 1, size(data%contacts)
      associate (c => problem%contacts%items(i))
        scaled(:, i) = c%count * c%contact%initial_stiffness * problem%incidence(:, i)
      end associate
    end do
    call symmetric_modes(problem%model%stiffness + matmul(scaled, transpose(problem%incidence)), problem%model%mass, omega, shapes)
    shown = abs(matmul(problem%incidence(:, 1), shapes))
    do i = 1, size(omega)
      write (modes, row) input%load_factor, omega(i) / (2.0_wp * pi * input%frequency), shown(i) / maxval(shown)
    end do
    amplitude = harmonic_amplitude(matmul(force, series_basis(most, size(force))))
    do i = 1, most
      write (spectrum, row) input%load_factor, i, amplitude(i) / amplitude(1)
    end do
  end subroutine write_harmonics

  subroutine write_waveform(input, harmonics, waves)
    type(integration_input), intent(in) :: input
    integer, intent(in) :: harmonics
    type(waveform), intent(in) :: waves
    integer :: j

    do j = 0, input%steps_per_period, max(1, input%steps_per_period / waveform_points)
      write (waveforms, row) input%load_factor, harmonics, 2.0_wp * pi * j / input%steps_per_period, &
        waves%displacement(modulo(j, input%steps_per_period) + 1)
    end do
  end subroutine write_waveform

  !> Largest difference over the period, relative to the largest value.
  pure real(wp) function relative_difference(a, reference)
    real(wp), intent(in) :: a(:), reference(:)
    relative_difference = maxval(abs(a - reference)) / maxval(abs(reference))
  end function relative_difference
end program time_integration
