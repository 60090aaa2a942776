!> Forced response of a structure with friction contacts by multi-harmonic balance.
!>
!>     forced_response CASE DIRECTORY
!>
!> CASE is a file of namelist groups (case_input.f90). Written to DIRECTORY, for a case called NAME:
!> * for every load factor,
!>   NAME_response.csv  the response along the frequency,
!>   NAME_peaks.csv     the resonance peaks;
!> * with single frequencies,
!>   NAME_coefficients.csv  the harmonic coefficients of all degrees of freedom at single frequencies.
program forced_response
  use basics, only: argument, fail, open_table, pi, progress, row, text, wp
  use case_input, only: case_data, prepare_problem, read_case
  use continuation, only: follow_response, refine_peak, response_path
  use fourier_series, only: harmonic_amplitude, series_peak
  use harmonic_balance, only: balance_point, balance_problem, evaluate, solve_from_rest, structure_response
  implicit none

  character(len=*), parameter :: usage = 'forced_response CASE DIRECTORY'
  character(len=:), allocatable :: prefix
  type(case_data) :: data
  type(balance_problem) :: problem
  type(balance_point) :: point

  call read_case(trim(argument(1, usage)), data)
  prefix = trim(argument(2, usage))//'/'//trim(data%name)
  if (size(data%load_factors) + size(data%frequencies) == 0) call fail('load_factors or frequency is needed')
  if (size(data%frequencies) > 0) call solve_points()
  if (size(data%load_factors) > 0) call solve_sweep()

contains

  !> Columns: frequency_hz, dof, then c0, cos1, sin1, ... in metres: x(t) = c0 + sum of cosk cos(k omega t) +
  !> sink sin(k omega t) under the excitation amplitude * cos(omega t).
  subroutine solve_points()
    real(wp) :: displacement(2 * data%harmonics + 1, size(data%contacts))
    real(wp) :: response(2 * data%harmonics + 1, size(data%excitation))
    character(len=:), allocatable :: header
    logical :: converged
    integer :: table, i, k, dof

    header = 'frequency_hz,dof,c0'
    do k = 1, data%harmonics
      header = header//',cos'//text(k)//',sin'//text(k)
    end do
    table = open_table(prefix//'_coefficients.csv', header)
    call prepare_problem(data, 1.0_wp, data%harmonics, data%samples, problem)
    do i = 1, size(data%frequencies)
      call solve_from_rest(problem, 2.0_wp * pi * data%frequencies(i), displacement, point, converged)
      if (.not. converged) call fail('no harmonic balance found at '//text(data%frequencies(i), '(f12.3)')//' Hz')
      response = structure_response(problem, point)
      do dof = 1, size(response, 2)
        write (table, row) data%frequencies(i), dof, response(:, dof)
      end do
      call report('point '//text(i), data%frequencies(i), series_peak(response(:, data%response_dof)))
    end do
    close (table)
  end subroutine solve_points

  subroutine report(what, frequency, peak)
    character(len=*), intent(in) :: what
    real(wp), intent(in) :: frequency, peak

    call progress(trim(data%name)//', '//what//': '//text(1.0e6_wp * peak, '(f10.3)')//' um at '//text(frequency, '(f10.3)')//' Hz')
  end subroutine report

  subroutine solve_sweep()
    type(response_path) :: path
    real(wp) :: omega, peak, displacement(2 * data%harmonics + 1, size(data%contacts))
    real(wp), allocatable :: amplitude(:)
    integer :: responses, peaks, load, i

    responses = open_table(prefix//'_response.csv', response_header())
    peaks = open_table(prefix//'_peaks.csv', response_header())
    do load = 1, size(data%load_factors)
      call prepare_problem(data, data%load_factors(load), data%harmonics, data%samples, problem)
      call follow_response(problem, data%range(1), data%range(2), path)
      amplitude = [(0.0_wp, i=1, path%points)]
      do i = 1, path%points
        call write_row(responses, load, path%omega(i), path%displacement(:, :, i), amplitude(i))
      end do
      call refine_peak(problem, path, amplitude, data%response_dof, omega, displacement)
      call write_row(peaks, load, omega, displacement, peak)
      call report('load factor '//text(data%load_factors(load), '(f10.2)'), omega / (2.0_wp * pi), peak)
    end do
    close (responses)
    close (peaks)
  end subroutine solve_sweep

  function response_header() result(header)
    character(len=:), allocatable :: header
    integer :: i

    header = 'load,load_factor,frequency_hz,peak_m'
    do i = 0, data%harmonics
      header = header//',harmonic_'//text(i)//'_m'
    end do
    do i = 1, size(data%contacts)
      header = header//','//trim(data%contacts(i)%name)//'_dissipated_J'
    end do
  end function response_header

  !> `amplitude` is the peak over the period of the response.
  subroutine write_row(table, load, omega, displacement, amplitude)
    integer, intent(in) :: table, load
    real(wp), intent(in) :: omega, displacement(:,:)
    real(wp), intent(out) :: amplitude
    real(wp) :: response(size(displacement, 1), size(data%excitation))

    call evaluate(problem, omega, displacement, point)
    response = structure_response(problem, point)
    amplitude = series_peak(response(:, data%response_dof))
    write (table, row) load, data%load_factors(load), omega / (2.0_wp * pi), amplitude, &
      harmonic_amplitude(response(:, data%response_dof)), point%dissipated
  end subroutine write_row
end program forced_response
