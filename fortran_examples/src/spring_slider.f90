!> The spring-slider (Jenkins element) of today's forced-response codes: a spring in series with a Coulomb slider.
!>
!> The alternating frequency/time method follows the same definition as microslip's: equidistant samples from t = 0,
!> the second of two periods from the virgin state, and the exact derivative of that computation. A sample that slips
!> has no derivative; one that sticks has, with phi the row 1, cos, sin, ... and a the last sample that slipped,
!>
!>     force = force(a) + k (u - u(a)),    d force = k (phi - phi(a)),
!>
!> so that the Jacobian needs the sums of phi and of the products of two of its functions over the samples that stick. The
!> products of two waves are waves, up to the harmonic 2H, and sums over consecutive samples are differences of tables.
module spring_slider
  use fourier_series, only: coefficient_count, series_basis, series_projection
  use kinds, only: wp
  implicit none
  private
  public :: make_slider_tables, slider_step, slider_harmonic_force

  type, public :: slider
    real(wp) :: stiffness = 0.0_wp
    real(wp) :: slip_force = 0.0_wp
  end type slider

  !> What all sliders share that have the same harmonics and samples.
  type, public :: slider_tables
    real(wp), allocatable :: basis(:,:)            !! (sample, coefficient): displacement = basis * coefficients
    real(wp), allocatable :: projection(:,:)       !! (coefficient, sample): coefficients = projection * force
    real(wp), allocatable :: cumulative(:,:)       !! (function, 0 to samples): sums of 1, cos, sin, ... to 2H
  end type slider_tables

contains

  pure subroutine make_slider_tables(harmonics, samples, tables)
    integer, intent(in) :: harmonics, samples
    type(slider_tables), intent(out) :: tables
    real(wp) :: products(samples, coefficient_count(2 * harmonics))
    integer :: i

    tables%basis = series_basis(harmonics, samples)
    tables%projection = series_projection(harmonics, samples)
    products = series_basis(2 * harmonics, samples)
    allocate (tables%cumulative(size(products, 2), 0:samples))
    tables%cumulative(:, 0) = 0.0_wp
    do i = 1, samples
      tables%cumulative(:, i) = tables%cumulative(:, i - 1) + products(i, :)
    end do
  end subroutine make_slider_tables

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
  pure subroutine slider_harmonic_force(element, tables, coefficients, force, jacobian, dissipated)
    type(slider), intent(in) :: element
    type(slider_tables), intent(in) :: tables
    real(wp), intent(in) :: coefficients(:)
    real(wp), intent(out) :: force(:), jacobian(:,:), dissipated
    real(wp), dimension(0:size(tables%basis, 1)) :: displacement, history
    real(wp) :: beyond(size(tables%basis, 1)), f
    real(wp), dimension(size(tables%cumulative, 1)) :: run, stuck
    integer :: n, m, i, j, before, anchor

    n = size(tables%basis, 1)
    m = size(tables%basis, 2)
    displacement = coefficients(1)
    do j = 2, m
      displacement(1:) = displacement(1:) + coefficients(j) * tables%basis(:, j)
    end do

    ! The first period, from the virgin state; `anchor` is the last sample that slipped.
    displacement(0) = 0.0_wp
    f = 0.0_wp
    anchor = 0
    do i = 1, n
      f = f + element%stiffness * (displacement(i) - displacement(i - 1))
      if (abs(f) >= element%slip_force) anchor = i
      f = max(-element%slip_force, min(element%slip_force, f))
      history(i) = f
    end do
    ! The second repeats the first from where the two meet.
    displacement(0) = displacement(n)
    history(0) = f
    do i = 1, n
      f = f + element%stiffness * (displacement(i) - displacement(i - 1))
      f = max(-element%slip_force, min(element%slip_force, f))
      if (.not. abs(f - history(i)) > 0.0_wp) exit
      history(i) = f
    end do
    ! By how much the spring alone would exceed the slip force.
    beyond = abs(history(:n - 1) + element%stiffness * (displacement(1:) - displacement(:n - 1))) - element%slip_force
    force = matmul(tables%projection, history(1:))
    dissipated = 0.0_wp
    if (element%stiffness > 0.0_wp) then
      dissipated = element%slip_force * sum(max(beyond, 0.0_wp)) / element%stiffness
    end if

    stuck = 0.0_wp
    jacobian = 0.0_wp
    i = 1
    do while (i <= n)
      if (beyond(i) >= 0.0_wp) then
        anchor = i
        i = i + 1
        cycle
      end if
      before = i - 1
      do while (i <= n)
        if (beyond(i) >= 0.0_wp) exit
        i = i + 1
      end do
      run = tables%cumulative(:, i - 1) - tables%cumulative(:, before)
      stuck = stuck + run
      if (anchor == 0) cycle
      do j = 1, m
        jacobian(:, j) = jacobian(:, j) - run(:m) * tables%basis(anchor, j)
      end do
    end do
    call add_products(stuck, jacobian)
    jacobian = element%stiffness * 2.0_wp / n * jacobian
    jacobian(1, :) = 0.5_wp * jacobian(1, :)
  end subroutine slider_harmonic_force

  !> Adds to matrix(i, j) the sum of function i times function j, made of the sums of the functions to twice the harmonics.
  pure subroutine add_products(sums, matrix)
    real(wp), intent(in) :: sums(:)
    real(wp), intent(inout) :: matrix(:,:)
    real(wp) :: cosines(0:size(sums) / 2), sines(0:size(sums) / 2), difference
    integer :: k, l

    do k = 0, size(sums) / 2
      cosines(k) = sums(max(2*k, 1))
      sines(k) = merge(0.0_wp, sums(2*k + 1), k == 0)
    end do
    matrix(:, 1) = matrix(:, 1) + sums(:size(matrix, 1))
    do l = 1, size(matrix, 2) / 2
      matrix(1, 2*l) = matrix(1, 2*l) + cosines(l)
      matrix(1, 2*l + 1) = matrix(1, 2*l + 1) + sines(l)
      do k = 1, size(matrix, 1) / 2
        difference = sign(1, k - l) * sines(abs(k - l))    ! of sin((k - l) t)
        matrix(2*k, 2*l) = matrix(2*k, 2*l) + 0.5_wp * (cosines(abs(k - l)) + cosines(k + l))
        matrix(2*k + 1, 2*l) = matrix(2*k + 1, 2*l) + 0.5_wp * (sines(k + l) + difference)
        matrix(2*k, 2*l + 1) = matrix(2*k, 2*l + 1) + 0.5_wp * (sines(k + l) - difference)
        matrix(2*k + 1, 2*l + 1) = matrix(2*k + 1, 2*l + 1) + 0.5_wp * (cosines(abs(k - l)) - cosines(k + l))
      end do
    end do
  end subroutine add_products
end module spring_slider
