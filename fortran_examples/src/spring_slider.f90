!> The spring-slider (Jenkins element) of today's forced-response codes: a spring in series with a Coulomb slider.
!>
!> The alternating frequency/time method follows the same definition as microslip's: equidistant samples from t = 0,
!> the second of two periods from the virgin state, and the exact derivative of that computation.
module spring_slider
  use kinds, only: wp
  implicit none
  private
  public :: slider_step, slider_harmonic_force

  type, public :: slider
    real(wp) :: stiffness = 0.0_wp
    real(wp) :: slip_force = 0.0_wp
  end type slider

contains

  !> Moves the slider from (displacement0, force0) to `displacement`.
  pure subroutine slider_step(element, displacement0, force0, displacement, force, tangent, dissipated)
    type(slider), intent(in) :: element
    real(wp), intent(in) :: displacement0, force0, displacement
    real(wp), intent(out) :: force, tangent, dissipated
    real(wp) :: elastic

    elastic = force0 + element%stiffness * (displacement - displacement0)
    force = max(-element%slip_force, min(element%slip_force, elastic))
    dissipated = 0.0_wp
    if (element%stiffness > 0.0_wp) dissipated = element%slip_force * abs(elastic - force) / element%stiffness
    tangent = merge(element%stiffness, 0.0_wp, abs(elastic) < element%slip_force)
  end subroutine slider_step

  !> Coefficients of the force for those of the displacement, with jacobian(i, j) = d force_i / d displacement_j and
  !> the energy dissipated in one period.
  pure subroutine slider_harmonic_force(element, basis, projection, coefficients, force, jacobian, dissipated)
    type(slider), intent(in) :: element
    real(wp), intent(in) :: basis(:,:), projection(:,:), coefficients(:)
    real(wp), intent(out) :: force(:), jacobian(:,:), dissipated
    real(wp) :: displacement(size(basis, 1)), force_history(size(basis, 1))
    real(wp) :: rate(size(basis, 2)), rate_history(size(basis, 1), size(basis, 2))
    real(wp) :: u0, u, f0, f, tangent, energy
    integer :: period, i

    displacement = matmul(basis, coefficients)
    u0 = 0.0_wp
    f0 = 0.0_wp
    rate = 0.0_wp    ! d(f0 - k u0)/d(coefficients): what a stuck step carries on unchanged
    do period = 1, 2
      dissipated = 0.0_wp
      do i = 1, size(displacement)
        u = displacement(i)
        call slider_step(element, u0, f0, u, f, tangent, energy)
        if (tangent <= 0.0_wp) rate = -element%stiffness * basis(i, :)
        rate_history(i, :) = rate + element%stiffness * basis(i, :)
        force_history(i) = f
        dissipated = dissipated + energy
        u0 = u
        f0 = f
      end do
    end do
    force = matmul(projection, force_history)
    jacobian = matmul(projection, rate_history)
  end subroutine slider_harmonic_force
end module spring_slider
