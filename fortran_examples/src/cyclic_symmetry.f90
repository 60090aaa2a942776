!> A bladed disc whose shrouds touch their neighbours, under a travelling excitation of one nodal diameter: the balance of one
!> sector with cyclic symmetry, and time steps of the whole ring, which know neither harmonics nor symmetry.
!>
!> Sector j + 1 moves as sector j does, earlier by the phase phi = 2 pi (nodal diameter)/(sectors): harmonic k of it is
!> exp(i k phi) times that of sector j. So one contact, between the right side of a sector and the left side of the next one,
!> closes the ring. With X_k of a sector, l and r the rows of the left and right side, T_k the harmonics of the contact force:
!>
!>     U_k = exp(i k phi) l X_k - r X_k = B_k^H X_k,    Z_k X_k + B_k T_k = F_k,    B_k = exp(-i k phi) l^T - r^T.
!>
!> Z_k has the linear coupling of the nodal diameter k n.
program cyclic_symmetry
  use basics, only: fail, open_table, csv, pi, text, wp
  use dense_algebra, only: solve
  use fourier_series, only: get_harmonic, series_basis, set_harmonic
  use microslip
  implicit none
  integer, parameter :: sectors = 8, diameter = 1, periods = 300, steps = 2048
  real(wp), parameter :: phi = 2*pi*diameter/sectors
  ! A blade moves circumferentially and twists; the twist in metres at the shroud. The twist is coupled to the motion.
  real(wp), parameter :: mass(2) = [2.0_wp, 0.5_wp], ratio = 0.01_wp                           ! kg, damping ratio
  real(wp), parameter :: stiffness(2, 2) = reshape([4.0e7_wp, 0.8e7_wp, 0.8e7_wp, 5.0e7_wp], [2, 2])     ! N/m
  real(wp), parameter :: disc = 1.0e7_wp                                     ! spring from each blade to the next one, N/m
  real(wp), parameter :: left(2) = [1.0_wp, -1.0_wp], right(2) = [1.0_wp, 1.0_wp]
  real(wp), parameter :: excitation = 40, frequency(5) = [600, 750, 780, 800, 850]               ! N, Hz
  ! Steps, harmonics and samples leave 2e-5 of the amplitude, less with more of them. A wrong sign of phi leaves 0.8, the linear
  ! coupling of the diameter n in place of k n 0.01.
  real(wp), parameter :: tolerance = 1e-4_wp
  type(mslip_parameters) :: p
  type(mslip_contact) :: contact
  integer(mslip_int) :: status
  real(wp) :: damping(2), motion(11, 2), more(63, 2), few, many, peak
  integer :: i, unit

  call mslip_parameters_default(p)
  p%flat_half_width = 0.2e-3_wp; p%edge_radius = 5e-3_wp; p%length = 10e-3_wp
  p%normal_force = 150; p%friction_coefficient = 0.4_wp
  p%material = mslip_material(114e9_wp, 0.32_wp)
  p%displacement_reference = MSLIP_RIGID_STRIP
  call mslip_contact_init(p, contact, status)
  if (status /= MSLIP_OK) call fail(mslip_status_text(status))
  damping = [(2*ratio*sqrt(stiffness(i, i)*mass(i)), i = 1, 2)]

  unit = open_table('results/cyclic_symmetry.csv', 'harmonics,frequency_hz,amplitude_m,twist_m,relative_m')
  do i = 1, size(frequency)
    call balance(2*pi*frequency(i), motion)
    call balance(2*pi*frequency(i), more)
    call ring(2*pi*frequency(i), motion, more, few, many, peak)
    print '(f7.1, a, es9.2, a, es8.1, a, es8.1, a)', frequency(i), ' Hz: amplitude', peak, ' m, differs from the ring by', few, &
      ' with 5 harmonics,', many, ' with 31'
    if (.not. many < tolerance) call fail('the balance of a sector differs from the ring')
  end do
  close (unit)

contains

  !> Coefficients of both degrees of freedom of sector 0, by Newton's method for U with halved steps.
  subroutine balance(omega, motion)
    real(wp), intent(in) :: omega
    real(wp), intent(out) :: motion(:, :)
    integer(mslip_size), parameter :: samples = 1024
    complex(wp) :: z(2, 2), b(2, 0:size(motion, 1)/2), reply(2, 2, 0:size(motion, 1)/2), compliance(0:size(motion, 1)/2), x(2)
    real(wp), dimension(size(motion, 1)) :: u, trial, residual, force, rows(2, size(motion, 1))
    real(wp) :: jacobian(size(u), size(u)), step(size(u), 1), last
    real(wp), allocatable :: workspace(:)
    integer :: harmonics, k, dof, iteration, halving

    harmonics = size(u)/2
    allocate (workspace(mslip_harmonic_workspace_length(int(harmonics, mslip_size), samples)))
    call mslip_harmonic_workspace_init(int(harmonics, mslip_size), samples, workspace, status)
    do k = 0, harmonics
      z = stiffness
      z(1, 1) = z(1, 1) + disc*(2 - 2*cos(k*phi))                                ! linear coupling: nodal diameter k n
      do dof = 1, 2
        z(dof, dof) = z(dof, dof) + cmplx(-mass(dof)*(k*omega)**2, k*omega*damping(dof), wp)
      end do
      b(:, k) = exp(cmplx(0.0_wp, -k*phi, wp))*left - right
      reply(:, 1, k) = b(:, k)                                                   ! to T_k, and below to F_k
      reply(:, 2, k) = [merge(excitation, 0.0_wp, k == 1), 0.0_wp]
      call solve(z, reply(:, :, k))
      compliance(k) = dot_product(b(:, k), reply(:, 1, k))                       ! the first argument is conjugated
    end do
    u = 0                                                                        ! as if stuck
    call set_harmonic(u, 1, dot_product(b(:, 1), reply(:, 2, 1))/(1 + compliance(1)*contact%initial_stiffness))
    step = 0
    last = huge(last)
    do iteration = 1, 100
      do halving = 0, 10
        trial = u - step(:, 1)/2**halving
        call mslip_harmonic_force(contact, workspace, trial, status, force, jacobian)
        if (status /= MSLIP_OK) call fail(mslip_status_text(status))
        do k = 0, harmonics                                                      ! U_k + C_k T_k - U_k without contact
          call set_harmonic(residual, k, get_harmonic(trial, k) + compliance(k)*get_harmonic(force, k) &
            - dot_product(b(:, k), reply(:, 2, k)))
        end do
        if (norm2(residual) < last) exit
      end do
      u = trial
      last = norm2(residual)
      if (last < 1e-12_wp*norm2(u)) exit
      jacobian(1, :) = real(compliance(0))*jacobian(1, :)
      do k = 1, harmonics                                                        ! U = cos - i sin
        rows = jacobian(2*k:2*k + 1, :)
        jacobian(2*k, :) = real(compliance(k))*rows(1, :) + aimag(compliance(k))*rows(2, :)
        jacobian(2*k + 1, :) = real(compliance(k))*rows(2, :) - aimag(compliance(k))*rows(1, :)
      end do
      do k = 1, size(u)
        jacobian(k, k) = jacobian(k, k) + 1
      end do
      step(:, 1) = residual
      call solve(jacobian, step)
    end do
    if (iteration > 100) call fail('no balance at '//text(omega/(2*pi), '(f8.1)')//' Hz')
    do k = 0, harmonics
      x = reply(:, 2, k) - reply(:, 1, k)*get_harmonic(force, k)
      call set_harmonic(motion(:, 1), k, x(1))
      call set_harmonic(motion(:, 2), k, x(2))
    end do
    write (unit, '(a)') text(harmonics)//','//text(omega/(2*pi), '(f8.1)')//csv([norm2(motion(2:3, 1)), &
      norm2(motion(2:3, 2)), norm2(u(2:3))])
  end subroutine balance

  !> Central differences of all sectors. In the last period: the amplitude, and over it the largest difference from both balances.
  subroutine ring(omega, motion, more, few, many, peak)
    real(wp), intent(in) :: omega, motion(:, :), more(:, :)
    real(wp), intent(out) :: few, many, peak
    real(wp), dimension(2, 0:sectors - 1) :: x, before, next, force
    real(wp) :: states(mslip_state_length(32_mslip_size), 0:sectors - 1), u(0:sectors - 1), t(0:sectors - 1), dt
    real(wp) :: basis(steps, size(more, 1)), series(steps, 2), longer(steps, 2)
    integer(mslip_int), parameter :: same(0:sectors - 1) = 1
    real(wp) :: load
    integer :: period, i, j, k

    dt = 2*pi/(omega*steps)
    basis = series_basis(size(more, 1)/2, steps)
    longer = matmul(basis, more)
    series = matmul(basis(:, :size(motion, 1)), motion)
    x = 0; before = 0; few = 0; many = 0; peak = 0
    do j = 0, sectors - 1
      call mslip_state_init(states(:, j), status)
    end do
    do period = 1, periods
      do i = 0, steps - 1
        if (period == periods) then
          do j = 0, sectors - 1                                                  ! earlier by j phi
            k = modulo(i + j*diameter*steps/sectors, steps) + 1
            peak = max(peak, abs(x(1, j)))
            few = max(few, maxval(abs(x(:, j) - series(k, :))))
            many = max(many, maxval(abs(x(:, j) - longer(k, :))))
          end do
        end if
        u = matmul(left, cshift(x, 1, 2)) - matmul(right, x)                     ! between j and j + 1
        call mslip_batch_masing_advance([contact], states, u, status, index=same, force=t)
        if (status /= MSLIP_OK) call fail(mslip_status_text(status))
        load = excitation*min(1.0_wp, (period + real(i, wp)/steps)/(periods/2))  ! slowly, or the transient leaves mean forces
        force = -matmul(stiffness, x)
        force(1, :) = force(1, :) + disc*(cshift(x(1, :), 1) - 2*x(1, :) + cshift(x(1, :), -1)) &
          + [(load*cos(omega*i*dt + j*phi), j = 0, sectors - 1)]
        do j = 1, 2
          force(j, :) = force(j, :) + right(j)*t - left(j)*cshift(t, -1)
          next(j, :) = (force(j, :) + mass(j)/dt**2*(2*x(j, :) - before(j, :)) + damping(j)/(2*dt)*before(j, :)) &
            /(mass(j)/dt**2 + damping(j)/(2*dt))
        end do
        before = x
        x = next
      end do
    end do
    few = few/peak
    many = many/peak
  end subroutine ring
end program cyclic_symmetry
