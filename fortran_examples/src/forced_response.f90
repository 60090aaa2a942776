!> Forced response of a structure with friction contacts by multi-harmonic balance.
!>
!>     forced_response CASE DIRECTORY
!>
!> CASE is a file of namelist groups (cases/README.md). Written to DIRECTORY, for a case called NAME:
!> * with a group &sweep, for every load factor,
!>   NAME_response.csv  the response along the frequency,
!>   NAME_peaks.csv     the resonance peaks,
!>   NAME_loops.csv     displacement and force of every contact over a period of the peak;
!> * with a group &points,
!>   NAME_coefficients.csv  the harmonic coefficients of all degrees of freedom at single frequencies.
program forced_response
  use, intrinsic :: iso_fortran_env, only: int64
  use case_input, only: case_data, read_case
  use case_problem, only: prepare_problem
  use csv_output, only: csv_file
  use fourier_series, only: series_peak
  use harmonic_balance, only: balance_point, balance_problem, solve_from_rest, structure_response
  use kinds, only: path_length, pi, wp
  use load_response, only: contact_loop, load_result, loop_points, respond, response_row
  use messages, only: fail, progress, text
  implicit none

  character(len=path_length) :: case_file, directory
  type(case_data) :: data

  if (command_argument_count() /= 2) call fail('usage: forced_response CASE DIRECTORY')
  call get_command_argument(1, case_file)
  call get_command_argument(2, directory)
  call read_case(trim(case_file), data)
  if (size(data%load_factors) == 0 .and. size(data%frequencies) == 0) then
    call fail(trim(case_file)//': a group &sweep or &points is needed')
  end if
  if (size(data%frequencies) > 0) call solve_points()
  if (size(data%load_factors) > 0) call solve_sweeps()

contains

  !> Columns: frequency_hz, dof, then c0, cos1, sin1, ... in metres: x(t) = c0 + sum of cosk cos(k omega t) +
  !> sink sin(k omega t), where the excitation is amplitude * cos(omega t + phase). 17 digits.
  subroutine solve_points()
    type(balance_problem) :: problem
    type(balance_point) :: point
    type(csv_file) :: table
    real(wp) :: displacement(2 * data%harmonics + 1, size(data%contacts))
    real(wp) :: response(2 * data%harmonics + 1, size(data%model%dof_name))
    logical :: converged
    integer :: i, k, dof

    call prepare_problem(data, 1.0_wp, data%harmonics, data%samples, problem)
    call table%open(trim(directory)//'/'//trim(data%name)//'_coefficients.csv')
    call table%add('frequency_hz')
    call table%add('dof')
    call table%add('c0')
    do k = 1, data%harmonics
      call table%add('cos'//text(k))
      call table%add('sin'//text(k))
    end do
    call table%end_row()
    do i = 1, size(data%frequencies)
      call solve_from_rest(problem, 2.0_wp * pi * data%frequencies(i), displacement, point, converged)
      if (.not. converged) then
        call fail('no harmonic balance found at '//text(data%frequencies(i))//' Hz within tolerance '// &
                  text(data%tolerance))
      end if
      response = structure_response(problem, point)
      do dof = 1, size(response, 2)
        call table%add(data%frequencies(i))
        call table%add(dof)
        call table%add(response(:, dof))
        call table%end_row()
      end do
      call progress(trim(data%name)//' '//text(i)//'/'//text(size(data%frequencies))//': '// &
                    text(data%frequencies(i), '(f12.3)')//' Hz, '//trim(data%model%dof_name(data%response_dof))// &
                    ' '//text(series_peak(response(:, data%response_dof)))//' m')
    end do
    call table%close()
  end subroutine solve_points

  subroutine solve_sweeps()
    type(balance_problem) :: problem
    type(load_result) :: response
    type(csv_file) :: responses, peaks, loops
    integer(int64) :: clock_start, clock_end, clock_rate
    integer :: load, i
    character(len=:), allocatable :: prefix

    prefix = trim(directory)//'/'//trim(data%name)
    call responses%open(prefix//'_response.csv')
    call response_header(responses)
    call peaks%open(prefix//'_peaks.csv')
    call response_header(peaks)
    call loops%open(prefix//'_loops.csv')
    call loops%add('load')
    call loops%add('contact')
    call loops%add('phase_rad')
    call loops%add('displacement_m')
    call loops%add('force_N')
    call loops%add('slip_part_m')
    call loops%end_row()

    do load = 1, size(data%load_factors)
      call system_clock(clock_start, clock_rate)
      call respond(data, data%load_factors(load), problem, response)
      do i = 1, size(response%row)
        call write_row(responses, load, response%row(i))
      end do
      call write_row(peaks, load, response%peak)
      do i = 1, size(response%loop)
        call write_loop(loops, load, i, response%loop(i))
      end do
      call system_clock(clock_end)
      call progress(trim(data%name)//' '//text(load)//'/'//text(size(data%load_factors))//': load factor '// &
                    text(data%load_factors(load), '(f10.2)')//', peak '// &
                    text(1.0e6_wp * response%peak%amplitude, '(f10.2)')//' um at '// &
                    text(response%peak%omega / (2.0_wp * pi), '(f10.2)')//' Hz, '//text(response%path%points)// &
                    ' points, '//text(real(clock_end - clock_start, wp) / real(clock_rate, wp), '(f8.2)')//' s')
    end do
    call responses%close()
    call peaks%close()
    call loops%close()
  end subroutine solve_sweeps

  subroutine response_header(table)
    type(csv_file), intent(inout) :: table
    integer :: i, k

    call table%add('load')
    call table%add('load_factor')
    call table%add('frequency_hz')
    call table%add('peak_m')
    do k = 0, data%harmonics
      call table%add('harmonic_'//text(k)//'_m')
    end do
    do i = 1, size(data%contacts)
      call table%add(trim(data%contacts(i)%name)//'_normal_force_N')
      call table%add(trim(data%contacts(i)%name)//'_dissipated_J')
      call table%add(trim(data%contacts(i)%name)//'_min_stick_half_width_m')
    end do
    call table%end_row()
  end subroutine response_header

  subroutine write_row(table, load, row)
    type(csv_file), intent(inout) :: table
    integer, intent(in) :: load
    type(response_row), intent(in) :: row
    real(wp) :: normal_force
    integer :: i

    call table%add(load)
    call table%add(data%load_factors(load))
    call table%add(row%omega / (2.0_wp * pi))
    call table%add(row%amplitude)
    call table%add(row%harmonic)
    do i = 1, size(data%contacts)
      normal_force = data%contacts(i)%parameters%normal_force
      if (data%contacts(i)%load_varied) normal_force = data%load_factors(load) * normal_force
      call table%add(normal_force)
      call table%add(row%dissipated(i))
      call table%add(row%min_stick_half_width(i))
    end do
    call table%end_row()
  end subroutine write_row

  subroutine write_loop(table, load, contact, loop)
    type(csv_file), intent(inout) :: table
    integer, intent(in) :: load, contact
    type(contact_loop), intent(in) :: loop
    integer :: i, j

    ! The first point again at the end closes the loop.
    do i = 0, loop_points
      j = modulo(i, loop_points) + 1
      call table%add(load)
      call table%add(data%contacts(contact)%name)
      call table%add(2.0_wp * pi * real(i, wp) / real(loop_points, wp))
      call table%add(loop%displacement(j))
      call table%add(loop%force(j))
      call table%add(loop%slip_part(j))
      call table%end_row()
    end do
  end subroutine write_loop
end program forced_response
