!> Real Fourier series over one period of the excitation: coefficients [c0, cos 1, sin 1, cos 2, sin 2, ...] of
!> x(t) = c0 + sum over k of cos_k cos(k omega t) + sin_k sin(k omega t).
module fourier_series
  use basics, only: pi, wp
  implicit none
  private
  public :: series_basis, series_peak, harmonic_amplitude, get_harmonic, set_harmonic

contains

  !> The functions 1, cos, sin, ... at uniformly spaced instants from t = 0: signal = basis * coefficients.
  pure function series_basis(harmonics, samples) result(basis)
    integer, intent(in) :: harmonics, samples
    real(wp) :: basis(samples, 2 * harmonics + 1)
    real(wp) :: phase(samples)
    integer :: i, k

    basis(:, 1) = 1.0_wp
    do k = 1, harmonics
      ! The product is reduced as an integer, so that high harmonics are as accurate as low ones.
      phase = [(2.0_wp * pi * real(modulo(k * (i - 1), samples), wp) / real(samples, wp), i=1, samples)]
      basis(:, 2*k) = cos(phase)
      basis(:, 2*k + 1) = sin(phase)
    end do
  end function series_basis

  !> Largest distance from the mean over the period: the largest sample, refined by the parabola through its neighbours.
  pure function series_peak(coefficients) result(peak)
    real(wp), intent(in) :: coefficients(:)
    real(wp) :: peak
    integer, parameter :: samples_per_harmonic = 64
    real(wp) :: basis(samples_per_harmonic * (size(coefficients) / 2), size(coefficients)), signal(size(basis, 1))
    real(wp) :: slope, curvature
    integer :: samples, i

    samples = size(signal)
    basis = series_basis(size(coefficients) / 2, samples)
    signal = abs(matmul(basis(:, 2:), coefficients(2:)))
    i = maxloc(signal, dim=1)
    peak = signal(i)
    associate (before => signal(modulo(i - 2, samples) + 1), after => signal(modulo(i, samples) + 1))
      slope = 0.5_wp * (after - before)
      curvature = before - 2.0_wp * peak + after
    end associate
    if (curvature < 0.0_wp) peak = peak - 0.5_wp * slope**2 / curvature
  end function series_peak

  !> Amplitude of each harmonic from 0; that of harmonic 0 is the absolute mean.
  pure function harmonic_amplitude(coefficients) result(amplitude)
    real(wp), intent(in) :: coefficients(:)
    real(wp) :: amplitude(0:size(coefficients) / 2)

    amplitude = [abs(coefficients(1)), hypot(coefficients(2::2), coefficients(3::2))]
  end function harmonic_amplitude

  !> X in Re(X exp(i k omega t)), from the coefficients (coefficient, signal) of some signals.
  pure function get_harmonic(coefficients, k) result(amplitude)
    real(wp), intent(in) :: coefficients(:,:)
    integer, intent(in) :: k
    complex(wp) :: amplitude(size(coefficients, 2))

    amplitude = coefficients(1, :)
    if (k > 0) amplitude = cmplx(coefficients(2*k, :), -coefficients(2*k + 1, :), wp)
  end function get_harmonic

  pure subroutine set_harmonic(coefficients, k, amplitude)
    real(wp), intent(inout) :: coefficients(:,:)
    integer, intent(in) :: k
    complex(wp), intent(in) :: amplitude(:)

    coefficients(max(2*k, 1), :) = real(amplitude)
    if (k > 0) coefficients(2*k + 1, :) = -aimag(amplitude)
  end subroutine set_harmonic
end module fourier_series
