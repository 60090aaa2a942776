!> Forced response of a structure with friction contacts by multi-harmonic balance.
!>
!>     forced_response CASE DIRECTORY
!>
!> CASE is a file of namelist groups (cases/README.md). Written to DIRECTORY, for a case called NAME:
!> * with a group &sweep, for every load factor and excitation factor,
!>   NAME_response.csv  the response along the frequency,
!>   NAME_peaks.csv     the resonance peaks,
!>   NAME_loops.csv     displacement and force of every contact over a period of the peak;
!> * with a group &points,
!>   NAME_coefficients.csv  the harmonic coefficients of all degrees of freedom at single frequencies.
program forced_response
  use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
  use, intrinsic :: iso_fortran_env, only: int64
  use basics, only: argument, csv, fail, open_table, pi, progress, text, wp
  use case_input, only: case_data, prepare_problem, read_case
  use continuation, only: follow_response, refine_peak, response_path, solve_within
  use fourier_series, only: harmonic_amplitude, series_basis, series_peak
  use friction_contacts, only: contact_history
  use harmonic_balance, only: balance_point, balance_problem, evaluate, structure_response
  implicit none

  character(len=*), parameter :: usage = 'forced_response CASE DIRECTORY'
  integer, parameter :: loop_points = 256
  !> The forces of elements change by more than this from period to period: the balance needs more periods.
  real(wp), parameter :: large_drift = 1.0e-2_wp
  character(len=:), allocatable :: prefix
  type(case_data) :: data
  type(balance_problem) :: problem
  type(balance_point) :: point

  call read_case(trim(argument(1, usage)), data)
  prefix = trim(argument(2, usage))//'/'//trim(data%name)
  if (size(data%load_factors) + size(data%frequencies) == 0) call fail('a group &sweep or &points is needed')
  if (size(data%frequencies) > 0) call solve_points()
  if (size(data%load_factors) > 0) call solve_sweep()

contains

  !> Columns: frequency_hz, dof, then c0, cos1, sin1, ... in metres: x(t) = c0 + sum of cosk cos(k omega t) +
  !> sink sin(k omega t) under the excitation amplitude * cos(omega t + phase).
  subroutine solve_points()
    real(wp), allocatable :: displacement(:,:)
    real(wp) :: response(2 * data%harmonics + 1, size(data%model%dof_name))
    character(len=:), allocatable :: header
    logical :: converged
    integer :: table, i, k, dof

    header = 'frequency_hz,dof,c0'
    do k = 1, data%harmonics
      header = header//',cos'//text(k)//',sin'//text(k)
    end do
    table = open_table(prefix//'_coefficients.csv', header)
    do i = 1, size(data%frequencies)
      call prepare_problem(data, data%point_load_factor, data%harmonics, data%samples, problem, &
                           data%point_excitation_factors(i))
      if (i == 1) allocate (displacement(2 * data%harmonics + 1, size(problem%incidence, 2)))
      call solve_within(problem, 2.0_wp * pi * [data%frequency_from, data%frequency_to], &
                        2.0_wp * pi * data%frequencies(i), displacement, point, converged)
      if (.not. converged) call fail('no harmonic balance found at '//text(data%frequencies(i), '(f12.3)')//' Hz')
      response = structure_response(problem, point)
      do dof = 1, size(response, 2)
        write (table, '(a)') text(data%frequencies(i), '(es24.16e3)')//','//text(dof)//csv(response(:, dof))
      end do
      call progress(trim(data%name)//' '//text(i)//'/'//text(size(data%frequencies))//': '// &
                    text(data%frequencies(i), '(f12.3)')//' Hz, '//trim(data%model%dof_name(data%response_dof))// &
                    ' '//text(series_peak(response(:, data%response_dof)), '(es11.4)')//' m'// &
                    drift_message(problem%contacts%drift))
    end do
    close (table)
  end subroutine solve_points

  subroutine solve_sweep()
    type(response_path) :: path
    real(wp) :: omega, seconds, contact_seconds, drift
    real(wp), allocatable :: displacement(:,:), amplitude(:)
    character(len=:), allocatable :: header
    integer(int64) :: start, finish, rate
    integer :: responses, peaks, loops, load, i, points, iterations

    header = response_header()
    responses = open_table(prefix//'_response.csv', header)
    peaks = open_table(prefix//'_peaks.csv', header)
    loops = open_table(prefix//'_loops.csv', &
      'load,contact,phase_rad,displacement_m,force_N,approach_m,normal_force_N,'// &
      'displacement_y_m,force_y_N')
    points = 0
    iterations = 0
    contact_seconds = 0.0_wp
    call system_clock(start, rate)
    do load = 1, size(data%load_factors)
      call prepare_problem(data, data%load_factors(load), data%harmonics, data%samples, problem, data%excitation_factors(load))
      if (load == 1) allocate (displacement(2 * data%harmonics + 1, size(problem%incidence, 2)))
      call follow_response(problem, 2.0_wp * pi * data%frequency_from, 2.0_wp * pi * data%frequency_to, path)
      points = points + path%points
      allocate (amplitude(path%points))
      drift = 0.0_wp
      do i = 1, path%points
        call write_row(responses, load, path%omega(i), path%displacement(:, :, i), amplitude(i))
        drift = max(drift, problem%contacts%drift)
      end do
      call refine_peak(problem, path, amplitude, data%response_dof, omega, displacement)
      deallocate (amplitude)
      allocate (amplitude(1))
      call write_row(peaks, load, omega, displacement, amplitude(1))
      call write_loops(loops, load, displacement)
      call progress(trim(data%name)//' '//text(load)//'/'//text(size(data%load_factors))//': load factor '// &
                    text(data%load_factors(load), '(f10.2)')//', excitation '//text(data%excitation_factors(load), '(f10.3)')// &
                    ', peak '//text(1.0e6_wp * amplitude(1), '(f10.2)')//' um at '// &
                    text(omega / (2.0_wp * pi), '(f10.2)')//' Hz, '//text(path%points)//' points'//drift_message(drift))
      deallocate (amplitude)
      iterations = iterations + problem%evaluations
      contact_seconds = contact_seconds + problem%contact_seconds
    end do
    call system_clock(finish)
    seconds = real(finish - start, wp) / rate
    call progress(trim(data%name)//': '//text(seconds, '(f8.2)')//' s, '//text(points)//' points, '//text(iterations)// &
                  ' Newton iterations of '//text(1.0e6_wp * seconds / iterations, '(f8.1)')//' us, of that contact forces '// &
                  text(1.0e6_wp * contact_seconds / iterations, '(f8.1)')//' us')
    close (responses)
    close (peaks)
    close (loops)
  end subroutine solve_sweep

  !> Empty if the drift is small.
  function drift_message(drift) result(message)
    real(wp), intent(in) :: drift
    character(len=:), allocatable :: message

    message = ''
    if (drift > large_drift) message = ', not steady: drift '//text(drift, '(es8.1)')//' of mu N after '// &
                                       text(data%periods)//' period(s): raise periods in &harmonic_balance'
  end function drift_message

  function response_header() result(header)
    character(len=:), allocatable :: header, name
    integer :: i

    header = 'load,load_factor,excitation_factor,frequency_hz,peak_m'
    do i = 0, data%harmonics
      header = header//',harmonic_'//text(i)//'_m'
    end do
    header = header//',friction_damping_ratio'
    do i = 1, size(data%contacts)
      name = ','//trim(data%contacts(i)%name)
      header = header//name//'_normal_force_N'//name//'_dissipated_J'
      if (problem_components(i) == 1) then
        header = header//name//'_min_stick_half_width_m'
      else
        header = header//name//'_min_normal_force_N'//name//'_max_normal_force_N'//name//'_open_fraction'
      end if
    end do
  end function response_header

  pure integer function problem_components(i)
    integer, intent(in) :: i
    problem_components = merge(2, 1, data%contacts(i)%dof(3) >= 0)
  end function problem_components

  !> `amplitude` is the peak over the period of the response. The normal force is the mean one. The damping ratio of friction is
  !> the dissipated energy over 4 pi times the amplitude of the kinetic energy.
  subroutine write_row(table, load, omega, displacement, amplitude)
    integer, intent(in) :: table, load
    real(wp), intent(in) :: omega
    real(wp), intent(in), contiguous :: displacement(:,:)
    real(wp), intent(out) :: amplitude
    real(wp) :: response(size(displacement, 1), size(data%model%dof_name)), kinetic, extremes(3)
    real(wp) :: velocity(size(data%model%dof_name), 2)
    character(len=:), allocatable :: by_contact
    integer :: i

    call evaluate(problem, omega, displacement, point)
    response = structure_response(problem, point)
    amplitude = series_peak(response(:, data%response_dof))
    velocity = omega * transpose(response(2:3, :))
    kinetic = 0.5_wp * sum(velocity * matmul(problem%model%mass, velocity))
    by_contact = ''
    do i = 1, size(data%contacts)
      associate (c => data%contacts(i), first => problem%contacts%first(i), last => problem%contacts%last(i))
        if (first == last) then
          by_contact = by_contact//csv([c%parameters%normal_force * merge(data%load_factors(load), 1.0_wp, c%load_varied), &
                                        point%dissipated(i), problem%contacts%min_stick_half_width(i, displacement(:, first))])
        else
          call problem%contacts%normal_extremes(i, displacement(:, last), extremes(1), extremes(2), extremes(3))
          by_contact = by_contact//csv([point%force(1, last), point%dissipated(i), extremes])
        end if
      end associate
    end do
    write (table, '(a)') text(load)//csv([data%load_factors(load), data%excitation_factors(load), omega / (2.0_wp * pi), &
                                          amplitude, harmonic_amplitude(response(:, data%response_dof)), &
                                          sum(point%dissipated) / (4.0_wp * pi * kinetic)])//by_contact
  end subroutine write_row

  !> Hysteresis loops of all contacts.
  subroutine write_loops(table, load, displacement)
    integer, intent(in) :: table, load
    real(wp), intent(in) :: displacement(:,:)
    type(contact_history) :: history
    real(wp), dimension(loop_points, size(displacement, 2)) :: u, force
    real(wp) :: basis(loop_points, size(displacement, 1)), f, normal(2), second(2)
    integer :: contact, i, j

    basis = series_basis(data%harmonics, loop_points)
    u = matmul(basis, displacement)
    call problem%contacts%steady_cycle(u, history, force)
    do contact = 1, size(data%contacts)
      associate (first => problem%contacts%first(contact), last => problem%contacts%last(contact), &
                 items => data%contacts(contact)%count)
        do i = 0, loop_points      ! the first point again closes the loop
          j = modulo(i, loop_points) + 1
          f = force(j, first) / items
          normal = ieee_value(f, ieee_quiet_nan)
          second = normal
          if (last > first) normal = [u(j, last), force(j, last) / items]
          if (last > first + 1) second = [u(j, first + 1), force(j, first + 1) / items]
          write (table, '(a)') text(load)//','//trim(data%contacts(contact)%name)// &
            csv([2.0_wp * pi * i / loop_points, u(j, first), f, normal, second])
        end do
      end associate
    end do
  end subroutine write_loops
end program forced_response
