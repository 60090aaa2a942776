!> Harmonic balance compared with direct time integration in the steady state.
!>
!>     time_integration CASE DIRECTORY
!>
!> The group &time_integration of CASE lists frequencies and numbers of harmonics. At each frequency the motion starts from
!> the balance with the most harmonics, so that the transient is small, and is integrated until it is periodic. Written to
!> DIRECTORY, for a case called NAME:
!> * NAME_comparison.csv  the differences, for every frequency and number of harmonics;
!> * NAME_waveforms.csv   one period of both: the response, and displacement and force of the first contact.
!>
!> The exit code is 1 if the peak of the balance of the case itself (&harmonic_balance) differs by more than the
!> allowed_difference of &time_integration.
program time_integration
  use case_input, only: case_data, read_case
  use case_problem, only: prepare_problem
  use csv_output, only: csv_file
  use dense_algebra, only: symmetric_modes
  use fourier_series, only: series_basis, series_peak
  use harmonic_balance, only: balance_point, balance_problem, solve_from_rest, structure_response
  use kinds, only: path_length, pi, wp
  use messages, only: fail, progress, text
  use newmark, only: initial_acceleration, motion, newmark_scheme, newmark_step, prepare_newmark
  implicit none

  integer, parameter :: shown_contact = 1
  integer, parameter :: waveform_points = 256

  !> One period of what is compared.
  type :: waveform
    real(wp), allocatable :: response(:), displacement(:), force(:)
  end type waveform

  character(len=path_length) :: case_file, directory
  type(case_data) :: data
  type(csv_file) :: table, waveforms
  integer :: i

  if (command_argument_count() /= 2) call fail('usage: time_integration CASE DIRECTORY')
  call get_command_argument(1, case_file)
  call get_command_argument(2, directory)
  call read_case(trim(case_file), data)
  if (size(data%integration_frequencies) == 0) call fail(trim(case_file)//': the group &time_integration is missing')

  call table%open(trim(directory)//'/'//trim(data%name)//'_comparison.csv')
  call table%add('load_factor,frequency_hz,harmonics,samples,peak_balance_m,peak_time_integration_m,peak_difference')
  call table%add('response_difference,displacement_difference,force_difference')
  call table%add('periods,steps_per_period,change_per_period,remaining_transient')
  call table%end_row()
  call waveforms%open(trim(directory)//'/'//trim(data%name)//'_waveforms.csv')
  call waveforms%add('frequency_hz,source,harmonics,points,phase_rad,response_m,contact_displacement_m,contact_force_N')
  call waveforms%end_row()
  do i = 1, size(data%integration_frequencies)
    call compare_at(data%integration_frequencies(i))
  end do
  call table%close()
  call waveforms%close()

contains

  !> The balances of the list, and that of the case itself, with fewer samples.
  subroutine compare_at(frequency)
    real(wp), intent(in) :: frequency
    type(balance_problem) :: problem
    type(waveform), allocatable :: balances(:)
    type(waveform) :: integrated
    real(wp), allocatable :: displacement(:,:), response(:,:), peak(:)
    integer, dimension(1 + size(data%integration_harmonics)) :: harmonics, samples
    real(wp) :: change, remaining, integrated_peak, difference(3)
    integer :: k, most, periods

    harmonics = [data%harmonics, data%integration_harmonics]
    samples(1) = data%samples
    samples(2:) = data%integration_samples
    allocate (balances(size(harmonics)), peak(size(harmonics)))
    most = maxloc(harmonics, dim=1)
    do k = 1, size(harmonics)
      if (k /= most) call balance_at(frequency, harmonics(k), samples(k), problem, displacement, response, &
                                     balances(k), peak(k))
    end do
    call balance_at(frequency, harmonics(most), samples(most), problem, displacement, response, &
                    balances(most), peak(most))
    call integrate(frequency, problem, displacement, response, integrated, periods, change, remaining)

    integrated_peak = maxval(abs(integrated%response))
    call add_waveform(frequency, 'time_integration', 0, data%steps_per_period, integrated)
    do k = 1, size(balances)
      difference = [relative_difference(balances(k)%response, integrated%response), &
                    relative_difference(balances(k)%displacement, integrated%displacement), &
                    relative_difference(balances(k)%force, integrated%force)]
      call table%add(data%integration_load_factor)
      call table%add(frequency)
      call table%add(harmonics(k))
      call table%add(samples(k))
      call table%add(peak(k))
      call table%add(integrated_peak)
      call table%add(abs(peak(k) / integrated_peak - 1.0_wp))
      call table%add(difference)
      call table%add(periods)
      call table%add(data%steps_per_period)
      call table%add([change, remaining])
      call table%end_row()
      call add_waveform(frequency, 'balance', harmonics(k), samples(k), balances(k))
      call progress('  '//text(harmonics(k))//' harmonics, '//text(samples(k))//' samples: peak '// &
                    text(1.0e6_wp * peak(k), '(f10.4)')//' um, time integration '// &
                    text(1.0e6_wp * integrated_peak, '(f10.4)')//' um, difference '// &
                    text(abs(peak(k) / integrated_peak - 1.0_wp), '(es8.1)')//', waveform '// &
                    text(difference(1), '(es8.1)')//', contact '//text(difference(2), '(es8.1)'))
    end do
    if (.not. abs(peak(1) / integrated_peak - 1.0_wp) <= data%allowed_difference) then
      call fail('the peak of the balance with '//text(harmonics(1))//' harmonics at '//text(frequency)// &
                ' Hz differs from that of time integration by more than '//text(data%allowed_difference))
    end if
  end subroutine compare_at

  !> Steady state by harmonic balance: displacements of the contacts, of the structure, and the waveforms.
  subroutine balance_at(frequency, harmonics, samples, problem, displacement, response, waves, peak)
    real(wp), intent(in) :: frequency
    integer, intent(in) :: harmonics, samples
    type(balance_problem), intent(out) :: problem
    real(wp), allocatable, intent(out) :: displacement(:,:), response(:,:)
    type(waveform), intent(out) :: waves
    real(wp), intent(out) :: peak
    type(balance_point) :: point
    logical :: converged

    call prepare_problem(data, data%integration_load_factor, harmonics, samples, problem)
    allocate (displacement(2 * harmonics + 1, size(data%contacts)))
    call solve_from_rest(problem, 2.0_wp * pi * frequency, displacement, point, converged)
    if (.not. converged) then
      call fail('no harmonic balance with '//text(harmonics)//' harmonics found at '//text(frequency)//' Hz')
    end if
    response = structure_response(problem, point)
    peak = series_peak(response(:, data%response_dof))
    waves%response = matmul(series_basis(harmonics, data%steps_per_period), response(:, data%response_dof))
    allocate (waves%displacement(data%steps_per_period), waves%force(data%steps_per_period))
    call problem%contacts%steady_loop(shown_contact, displacement(:, shown_contact), waves%displacement, waves%force)
  end subroutine balance_at

  !> Integrates until the remaining transient is below the tolerance of the case, relative to the response.
  subroutine integrate(frequency, problem, contact_displacement, response, waves, periods, change, remaining)
    real(wp), intent(in) :: frequency, contact_displacement(:,:), response(:,:)
    type(balance_problem), intent(in) :: problem
    type(waveform), intent(out) :: waves
    integer, intent(out) :: periods
    real(wp), intent(out) :: change, remaining
    type(newmark_scheme) :: scheme
    type(motion) :: state
    real(wp), allocatable :: excitation(:,:), before(:)
    real(wp) :: decay, force_error
    integer :: j, k

    call prepare_newmark(problem%model, problem%incidence, 1.0_wp / (frequency * data%steps_per_period), &
                         [(norm2(contact_displacement(:, k)), k=1, size(contact_displacement, 2))], scheme)
    call start_motion(2.0_wp * pi * frequency, problem, contact_displacement, response, state, excitation)
    allocate (waves%response(data%steps_per_period), source=0.0_wp)
    allocate (waves%displacement, waves%force, mold=waves%response)
    decay = exp(-slowest_decay(problem) / frequency)
    do periods = 1, data%max_periods
      before = waves%response
      do j = 1, data%steps_per_period
        k = modulo(j, data%steps_per_period) + 1
        call newmark_step(scheme, problem%model, problem%incidence, problem%contacts, excitation(:, k), state)
        waves%response(k) = state%displacement(data%response_dof)
        waves%displacement(k) = state%contact_displacement(shown_contact)
        waves%force(k) = state%contact_force(shown_contact) / data%contacts(shown_contact)%count
      end do
      change = relative_difference(before, waves%response)
      ! The remaining change by a transient that shrinks by the factor `decay` in each period.
      remaining = change * decay / (1.0_wp - decay)
      if (remaining <= data%steady_tolerance) exit
    end do
    ! Each period of a slowly decaying motion lies within the one before: its reversals are more than a state holds, and the
    ! least significant ones are merged.
    force_error = maxval([(problem%contacts%force_error(state%contacts, j), j=1, size(state%contact_force))])
    if (periods > data%max_periods) then
      call fail('the motion at '//text(frequency)//' Hz is not periodic after '//text(data%max_periods)// &
                ' periods: it still changes by '//text(change)//'; raise max_periods or steady_tolerance')
    end if
    call progress(text(frequency, '(f10.2)')//' Hz: periodic after '//text(periods)//' periods of '// &
                  text(data%steps_per_period)//' steps, change in the last '//text(change, '(es8.1)')// &
                  ', remaining transient '//text(remaining, '(es8.1)')//', force error of merged reversals '// &
                  text(force_error, '(es8.1)')//' N')
  end subroutine integrate

  !> The motion of a balance at t = 0, and the excitation at the instants of the steps: excitation(:, 1) is at t = 0.
  subroutine start_motion(omega, problem, contact_displacement, response, state, excitation)
    real(wp), intent(in) :: omega, contact_displacement(:,:), response(:,:)
    type(balance_problem), intent(in) :: problem
    type(motion), intent(out) :: state
    real(wp), allocatable, intent(out) :: excitation(:,:)
    real(wp), allocatable :: basis(:,:)
    real(wp) :: rate(size(response, 1))
    integer :: k

    allocate (basis(data%steps_per_period, size(response, 1)))
    basis = series_basis(size(response, 1) / 2, data%steps_per_period)
    allocate (excitation(size(response, 2), data%steps_per_period))
    do k = 1, size(excitation, 1)
      excitation(k, :) = real(problem%excitation(k)) * basis(:, 2) - aimag(problem%excitation(k)) * basis(:, 3)
    end do
    ! Velocity at t = 0: the sine terms only.
    rate = 0.0_wp
    do k = 1, size(rate) / 2
      rate(2*k + 1) = k * omega
    end do
    state%displacement = matmul(basis(1, :), response)
    state%velocity = matmul(rate, response)
    state%contact_displacement = matmul(state%displacement, problem%incidence)
    allocate (state%contact_force(size(data%contacts)))
    call problem%contacts%start_history(cshift(matmul(basis, contact_displacement), 1, dim=1), state%contacts, &
                                        state%contact_force)
    call initial_acceleration(problem%model, problem%incidence, excitation(:, 1), state)
  end subroutine start_motion

  !> Rate at which every motion decays at least, by the damping of the structure alone: half the least eigenvalue of
  !> D x = lambda M x, whatever the stiffness. Friction can only add to it.
  function slowest_decay(problem) result(rate)
    type(balance_problem), intent(in) :: problem
    real(wp) :: rate
    real(wp) :: root(size(problem%excitation)), modes(size(problem%excitation), size(problem%excitation))

    call symmetric_modes(problem%model%damping, problem%model%mass, root, modes)
    rate = 0.5_wp * root(1)**2
    if (rate <= 0.0_wp) call fail('time integration needs a damping matrix that is positive definite')
  end function slowest_decay

  !> Largest difference over the period, relative to the largest value.
  pure real(wp) function relative_difference(a, reference)
    real(wp), intent(in) :: a(:), reference(:)
    relative_difference = maxval(abs(a - reference)) / maxval(abs(reference))
  end function relative_difference

  !> `points` are the samples of a balance, or the steps of time integration.
  subroutine add_waveform(frequency, source, harmonics, points, waves)
    real(wp), intent(in) :: frequency
    character(len=*), intent(in) :: source
    integer, intent(in) :: harmonics, points
    type(waveform), intent(in) :: waves
    integer :: j, k, stride

    stride = max(1, data%steps_per_period / waveform_points)
    do j = 1, data%steps_per_period + 1, stride
      k = modulo(j - 1, data%steps_per_period) + 1
      call waveforms%add(frequency)
      call waveforms%add(source)
      call waveforms%add(harmonics)
      call waveforms%add(points)
      call waveforms%add(2.0_wp * pi * real(j - 1, wp) / real(data%steps_per_period, wp))
      call waveforms%add([waves%response(k), waves%displacement(k), waves%force(k)])
      call waveforms%end_row()
    end do
  end subroutine add_waveform
end program time_integration
