!> Real Fourier series with coefficients [c0, cos 1, sin 1, cos 2, sin 2, ...] over one period of the excitation.
module fourier_series
  use kinds, only: pi, wp
  implicit none
  private
  public :: coefficient_count, series_basis, series_projection, series_peak, harmonic_amplitude, as_complex

contains

  pure integer function coefficient_count(harmonics)
    integer, intent(in) :: harmonics
    coefficient_count = 2 * harmonics + 1
  end function coefficient_count

  !> Values of the functions 1, cos, sin, ... at equidistant instants from t = 0: signal = basis * coefficients.
  pure function series_basis(harmonics, samples) result(basis)
    integer, intent(in) :: harmonics, samples
    real(wp) :: basis(samples, 2 * harmonics + 1)
    real(wp) :: phase
    integer :: i, k

    basis(:, 1) = 1.0_wp
    do k = 1, harmonics
      do i = 1, samples
        ! The product is reduced as an integer, so that high harmonics lose no accuracy.
        phase = 2.0_wp * pi * real(modulo(k * (i - 1), samples), wp) / real(samples, wp)
        basis(i, 2*k) = cos(phase)
        basis(i, 2*k + 1) = sin(phase)
      end do
    end do
  end function series_basis

  !> coefficients = projection * signal.
  pure function series_projection(harmonics, samples) result(projection)
    integer, intent(in) :: harmonics, samples
    real(wp) :: projection(2 * harmonics + 1, samples), basis(samples, 2 * harmonics + 1)

    basis = series_basis(harmonics, samples)
    projection = transpose(basis) * (2.0_wp / samples)
    projection(1, :) = 0.5_wp * projection(1, :)
  end function series_projection

  !> Largest absolute value over the period: the largest sample, refined by the parabola through its neighbours.
  pure function series_peak(coefficients) result(peak)
    real(wp), intent(in) :: coefficients(:)
    real(wp) :: peak
    integer, parameter :: samples_per_harmonic = 64
    real(wp) :: basis(samples_per_harmonic * (size(coefficients) / 2), size(coefficients)), signal(size(basis, 1))
    real(wp) :: slope, curvature
    integer :: samples, i

    samples = size(signal)
    basis = series_basis(size(coefficients) / 2, samples)
    signal = abs(matmul(basis, coefficients))
    i = maxloc(signal, dim=1)
    peak = signal(i)
    associate (before => signal(modulo(i - 2, samples) + 1), after => signal(modulo(i, samples) + 1))
      slope = 0.5_wp * (after - before)
      curvature = before - 2.0_wp * peak + after
    end associate
    if (curvature < 0.0_wp) peak = peak - 0.5_wp * slope**2 / curvature
  end function series_peak

  !> Amplitude of each harmonic, 0 to H; that of harmonic 0 is the absolute mean.
  pure function harmonic_amplitude(coefficients) result(amplitude)
    real(wp), intent(in) :: coefficients(:)
    real(wp) :: amplitude(0:size(coefficients) / 2)
    integer :: k

    amplitude(0) = abs(coefficients(1))
    do k = 1, size(coefficients) / 2
      amplitude(k) = hypot(coefficients(2*k), coefficients(2*k + 1))
    end do
  end function harmonic_amplitude

  !> X in Re(X exp(i k omega t)), for harmonic k.
  pure complex(wp) function as_complex(coefficients, k)
    real(wp), intent(in) :: coefficients(:)
    integer, intent(in) :: k

    if (k == 0) then
      as_complex = cmplx(coefficients(1), 0.0_wp, wp)
    else
      as_complex = cmplx(coefficients(2*k), -coefficients(2*k + 1), wp)
    end if
  end function as_complex
end module fourier_series
