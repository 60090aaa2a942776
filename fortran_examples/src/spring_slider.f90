!> The spring-slider (Jenkins element): a spring in series with a Coulomb slider, for comparison with the microslip law.
module spring_slider
  use basics, only: wp
  use fourier_series, only: series_basis
  implicit none
  private
  public :: make_slider_tables, slider_step, slider_harmonic_force

  type, public :: slider
    real(wp) :: stiffness = 0.0_wp
    real(wp) :: slip_force = 0.0_wp
  end type slider

  !> Shared by all sliders with the same harmonics and samples.
  type, public :: slider_tables
    real(wp), allocatable :: basis(:,:)            !! (coefficient, sample): displacement = coefficients * basis
    real(wp), allocatable :: projection(:,:)       !! (coefficient, sample): coefficients = projection * force
  end type slider_tables

contains

  pure subroutine make_slider_tables(harmonics, samples, tables)
    integer, intent(in) :: harmonics, samples
    type(slider_tables), intent(out) :: tables

    tables%basis = transpose(series_basis(harmonics, samples))
    tables%projection = tables%basis * (2.0_wp / samples)
    tables%projection(1, :) = 0.5_wp * tables%projection(1, :)
  end subroutine make_slider_tables

  !> From (displacement_old, force_old) to `displacement`.
  pure subroutine slider_step(element, displacement_old, force_old, displacement, force, tangent, dissipated)
    type(slider), intent(in) :: element
    real(wp), intent(in) :: displacement_old, force_old, displacement
    real(wp), intent(out) :: force, tangent, dissipated
    real(wp) :: elastic

    elastic = force_old + element%stiffness * (displacement - displacement_old)
    force = max(-element%slip_force, min(element%slip_force, elastic))
    tangent = merge(element%stiffness, 0.0_wp, abs(elastic) < element%slip_force)
    dissipated = 0.0_wp
    if (element%stiffness > 0.0_wp) dissipated = element%slip_force * abs(elastic - force) / element%stiffness
  end subroutine slider_step

  !> Coefficients of the force by the alternating frequency/time method: uniform samples from t = 0, the second of two periods
  !> from the unloaded state. `jacobian` is its exact derivative, `dissipated` the energy of the period.
  pure subroutine slider_harmonic_force(element, tables, coefficients, force, jacobian, dissipated)
    type(slider), intent(in) :: element
    type(slider_tables), intent(in) :: tables
    real(wp), intent(in) :: coefficients(:)
    real(wp), intent(out) :: force(:), jacobian(:,:), dissipated
    real(wp), dimension(size(tables%basis, 2)) :: displacement, history, tangent, loss
    real(wp) :: derivative(size(coefficients), size(tables%basis, 2)), u, f
    integer :: period, i, anchor

    displacement = matmul(coefficients, tables%basis)
    u = 0.0_wp
    f = 0.0_wp
    anchor = 0
    do period = 1, 2
      do i = 1, size(displacement)
        call slider_step(element, u, f, displacement(i), history(i), tangent(i), loss(i))
        u = displacement(i)
        f = history(i)
        if (.not. tangent(i) > 0.0_wp) anchor = i
        if (period == 1) cycle
        ! In slip the force is constant; a sticking sample has f = f(anchor) + k (u - u(anchor)), anchor the last in slip.
        derivative(:, i) = 0.0_wp
        if (tangent(i) > 0.0_wp) derivative(:, i) = tables%basis(:, i)
        if (tangent(i) > 0.0_wp .and. anchor > 0) derivative(:, i) = derivative(:, i) - tables%basis(:, anchor)
      end do
    end do
    force = matmul(tables%projection, history)
    jacobian = element%stiffness * matmul(tables%projection, transpose(derivative))
    dissipated = sum(loss)
  end subroutine slider_harmonic_force
end module spring_slider
