! A finite-element program in miniature, to test user subroutines: contact points between springs whose other ends are moved.
! Increments with Newton iterations, each from the state variables at the start of the increment; rejected increments, whose state
! variables are restored; a restart from a file. Forces, tangents and energies are compared with the library along the displacements
! of the accepted increments. With OpenMP, threads share the points.
module host
  use checks
  use microslip
  implicit none
  private
  public :: contact_model, element_of, points_of, run

  abstract interface
    !> One call of the user subroutine: from displacement and state variables at the start of the increment to those of the trial.
    !> A shorter increment is wanted if `ratio` is below 1.
    subroutine user_subroutine(point, x_start, x, before, after, force, tangent, dissipated, ratio)
      import :: wp
      integer, intent(in) :: point
      real(wp), intent(in) :: x_start(:), x(:), before(:)
      real(wp), intent(out) :: after(:), force(:), tangent(:, :), dissipated, ratio
    end subroutine user_subroutine
  end interface

  type :: contact_model
    character(len=32) :: name = ''
    integer :: points = 0, unknowns = 0, variables = 0          ! unknowns and state variables of each point
    integer :: energy = 1                                       ! which state variable is the energy dissipated so far
    logical :: called_if_open = .true.
    type(mslip_element), allocatable :: elements(:)             ! of each point
    real(wp), allocatable :: to_law(:, :, :)                    ! displacement of the law at a point: to_law x + offset
    real(wp), allocatable :: from_law(:, :, :)                  ! force of the program: from_law times that of the law
    real(wp), allocatable :: offset(:), share(:)                ! share: energy of the program over that of the law
    real(wp), allocatable :: spring(:)                          ! stiffness of the spring at each unknown
    procedure(user_subroutine), pointer, nopass :: call_user => null()
  end type contact_model

  type :: history
    integer :: n = 0                                            ! increments
    real(wp), allocatable :: x(:, :, :), force(:, :, :), tangent(:, :, :, :), dissipated(:, :), tangent_errors(:)
  end type history

  integer, parameter :: longest = 2000
  real(wp), parameter :: usual_step = 0.01_wp, restart_time = 0.5_wp

contains

  !> The element of a, R, L, N, mu, E1, nu1, E2, nu2.
  function element_of(c, directions, normal_input) result(element)
    real(wp), intent(in) :: c(:)
    integer, intent(in) :: directions, normal_input
    type(mslip_element) :: element
    integer(mslip_int) :: status

    call mslip_element_init(mslip_parameters(c(1), c(2), c(3), c(4), c(5), [mslip_material(c(6), c(7)), &
      mslip_material(c(8), c(9))], displacement_reference=MSLIP_RIGID_STRIP), directions, normal_input, element, status)
    call check_status('element', status, MSLIP_OK)
  end function element_of

  !> Points with these elements: the unknowns of the program are those of the law, and force and energy a share of the element's.
  function points_of(name, elements, share, variables, call_user) result(model)
    character(len=*), intent(in) :: name
    type(mslip_element), intent(in) :: elements(:)
    real(wp), intent(in) :: share(:)
    integer, intent(in) :: variables
    procedure(user_subroutine) :: call_user
    type(contact_model) :: model
    integer :: j, m

    m = elements(1)%directions + 1
    write (model%name, '(2a, i0)') name, ', directions: ', m - 1
    model%points = size(elements)
    model%unknowns = m
    model%variables = variables
    model%elements = elements
    model%share = share
    allocate (model%to_law(m, m, size(elements)), model%from_law(m, m, size(elements)), source=0.0_wp)
    do j = 1, m
      model%to_law(j, j, :) = 1
      model%from_law(j, j, :) = share
    end do
    model%offset = spread(0.0_wp, 1, m)
    model%spring = spread(0.3_wp*elements(1)%tangential_stiffness, 1, m)
    model%call_user => call_user
  end function points_of

  subroutine run(model)
    type(contact_model), intent(in) :: model
    type(history) :: whole, resumed
    real(wp), dimension(model%variables, model%points) :: final, again
    character(len=*), parameter :: file = 'restart.dat'
    integer :: rejected, n

    call analyse(model, .false., file, whole, final, rejected)
    call analyse(model, .true., file, resumed, again, n)
    call check(trim(model%name)//': restart, state variables', all(abs(final - again) <= 0))
    n = whole%n - resumed%n
    call check(trim(model%name)//': restart, displacements', n > 10 .and. resumed%n > 10)
    if (n >= 0) call check_same(trim(model%name)//': restart, displacements', &
      [resumed%x(:, :, :resumed%n)], [whole%x(:, :, n:whole%n)])
    call check(trim(model%name)//': rejected increments', rejected > whole%n/20)
    print '(2a, i0, a, i0, a)', model%name, ' ', whole%n, ' increments, ', rejected, ' rejected'
    call compare_with_differences(model, whole)
    call compare_with_library(model, whole)
    call balance_energy(model, whole, final)
    call exceed_range(model, final)
  end subroutine run

  !> All increments from t = 0, or from the restart file, to t = 1.
  subroutine analyse(model, resume, file, h, variables, rejected)
    type(contact_model), intent(in) :: model
    logical, intent(in) :: resume
    character(len=*), intent(in) :: file
    type(history), intent(out) :: h
    real(wp), intent(out) :: variables(:, :)
    integer, intent(out) :: rejected
    real(wp), dimension(model%unknowns, model%points) :: x, x_start, force
    real(wp) :: before(model%variables, model%points), tangent(model%unknowns, model%unknowns, model%points)
    real(wp) :: dissipated(model%points), t, dt
    integer :: attempts, unit
    logical :: converged, stored

    allocate (h%x(model%unknowns, model%points, 0:longest), h%force(model%unknowns, model%points, 0:longest))
    allocate (h%tangent(model%unknowns, model%unknowns, model%points, longest), h%dissipated(model%points, longest))
    allocate (h%tangent_errors(0))
    x_start = 0
    force = 0
    before = 0                                                  ! as a program starts
    t = 0
    dt = usual_step
    attempts = 0
    rejected = 0
    stored = resume
    if (resume) then
      open (newunit=unit, file=file, form='unformatted', status='old', action='read')
      read (unit) t, dt, attempts, x_start, force, before
      close (unit, status='delete')
    end if
    h%x(:, :, 0) = x_start
    h%force(:, :, 0) = force

    do while (t < 1 .and. h%n < longest .and. dt > 1e-7_wp)
      attempts = attempts + 1
      call iterate(model, min(t + dt, 1.0_wp), x_start, before, x, variables, force, tangent, dissipated, converged)
      if (.not. converged .or. modulo(attempts, 9) == 0) then   ! some rejections of increments that converged
        rejected = rejected + 1
        dt = dt/2
        cycle                                                   ! from `before` again
      end if
      if (.not. resume) h%tangent_errors = [h%tangent_errors, differences(model, x_start, x, before, tangent)]
      h%n = h%n + 1
      h%x(:, :, h%n) = x
      h%force(:, :, h%n) = force
      h%tangent(:, :, :, h%n) = tangent
      h%dissipated(:, h%n) = dissipated
      x_start = x
      before = variables
      t = min(t + dt, 1.0_wp)
      dt = min(2*dt, usual_step)
      if (t > restart_time .and. .not. stored) then
        open (newunit=unit, file=file, form='unformatted', status='replace', action='write')
        write (unit) t, dt, attempts, x_start, force, before
        close (unit)
        stored = .true.
      end if
    end do
    call check(trim(model%name)//': reaches the end', .not. t < 1)
  end subroutine analyse

  !> Newton's method for the equilibrium of all points with their springs.
  subroutine iterate(model, t, x_start, before, x, after, force, tangent, dissipated, converged)
    type(contact_model), intent(in) :: model
    real(wp), intent(in) :: t, x_start(:, :), before(:, :)
    real(wp), intent(out) :: x(:, :), after(:, :), force(:, :), tangent(:, :, :), dissipated(:)
    logical, intent(out) :: converged
    real(wp) :: residual(model%unknowns), matrix(model%unknowns, model%unknowns), ratio, tolerance
    logical :: close(model%points), failed
    integer :: iteration, i, j, pivots(model%unknowns), info
    external :: dgesv

    x = x_start
    tolerance = 1e-10_wp*maxval(model%spring)*model%elements(1)%approach
    do iteration = 1, 16
      failed = .false.
      !$omp parallel do private(residual, matrix, ratio, j, pivots, info) reduction(.or.: failed)
      do i = 1, model%points
        call model%call_user(i, x_start(:, i), x(:, i), before(:, i), after(:, i), force(:, i), tangent(:, :, i), dissipated(i), &
          ratio)
        failed = failed .or. ratio < 1
        residual = model%spring*(x(:, i) - anchor(model, i, t)) + force(:, i)
        close(i) = norm2(residual) <= tolerance
        if (.not. close(i)) then
          matrix = tangent(:, :, i)
          do j = 1, model%unknowns
            matrix(j, j) = matrix(j, j) + model%spring(j)
          end do
          call dgesv(size(residual), 1, matrix, size(residual), pivots, residual, size(residual), info)
          x(:, i) = x(:, i) - residual
        end if
      end do
      converged = all(close) .and. .not. failed
      if (converged .or. failed) return
    end do
  end subroutine iterate

  !> Position of the other ends of the springs of a point: pressed, moved around circles that grow, opened and closed, opened.
  function anchor(model, point, t)
    type(contact_model), intent(in) :: model
    integer, intent(in) :: point
    real(wp), intent(in) :: t
    real(wp) :: anchor(model%unknowns)
    real(wp), parameter :: pi = acos(-1.0_wp)
    real(wp) :: law(model%elements(point)%directions + 1), slip, amplitude, phase, normal
    integer :: m

    associate (element => model%elements(point))
      m = element%directions + 1
      slip = element%friction_coefficient*element%normal_force/element%tangential_stiffness
    end associate
    phase = 2*pi*(4*max(0.0_wp, t - 0.1_wp) + 0.07_wp*point)
    amplitude = 5*slip*max(0.0_wp, t - 0.1_wp)
    law(1) = amplitude*cos(phase)
    if (m == 3) law(2) = 0.7_wp*amplitude*sin(phase)
    normal = min(1.0_wp, t/0.1_wp, (1 - t)/0.1_wp) - 0.3_wp
    if (model%elements(point)%normal_input == MSLIP_INPUT_APPROACH) then
      if (t > 0.6_wp .and. t < 0.7_wp) normal = normal - 2*sin(pi*(t - 0.6_wp)/0.1_wp)
      law(m) = model%elements(point)%approach*normal*(1 + 0.3_wp*sin(1.7_wp*phase)) - model%offset(m)
    else
      law(m) = model%elements(point)%normal_force*normal*(1 + 0.3_wp*sin(1.7_wp*phase))
    end if
    law = law/sum(model%to_law(:, :, point)**2, 2)              ! its rows are at right angles
    anchor = matmul(law, model%to_law(:, :, point))
  end function anchor

  !> Largest error of each tangent against central differences from the same start, where the contact is closed.
  function differences(model, x_start, x, before, tangent) result(errors)
    type(contact_model), intent(in) :: model
    real(wp), intent(in) :: x_start(:, :), x(:, :), before(:, :), tangent(:, :, :)
    real(wp), allocatable :: errors(:)
    real(wp), dimension(model%unknowns) :: ahead, behind, step
    real(wp) :: after(model%variables), unused(model%unknowns, model%unknowns), column(model%unknowns), dissipated, ratio, worst
    integer :: i, j

    allocate (errors(0))
    do i = 1, model%points
      if (.not. maxval(abs(tangent(:, :, i))) > 0) cycle
      worst = 0
      do j = 1, model%unknowns
        step = 0
        step(j) = 1e-6_wp*model%elements(i)%approach
        call model%call_user(i, x_start(:, i), x(:, i) + step, before(:, i), after, ahead, unused, dissipated, ratio)
        call model%call_user(i, x_start(:, i), x(:, i) - step, before(:, i), after, behind, unused, dissipated, ratio)
        column = (ahead - behind)/(2*step(j))
        worst = max(worst, maxval(abs(column - tangent(:, j, i))))
      end do
      errors = [errors, worst/maxval(abs(tangent(:, :, i)))]
    end do
  end function differences

  subroutine compare_with_differences(model, h)
    type(contact_model), intent(in) :: model
    type(history), intent(in) :: h
    integer :: good, fair, n

    n = size(h%tangent_errors)
    good = count(h%tangent_errors < 1e-7_wp)
    fair = count(h%tangent_errors < 1e-4_wp)
    print '(a, i0, a, i0, a, i0)', '  tangents against differences: ', n, ', below 1e-7: ', good, ', below 1e-4: ', fair
    ! Not all: a difference may cross a corner of the law.
    call check(trim(model%name)//': tangents against differences', n > 100 .and. good > n/2 .and. fair > 0.98_wp*n)
  end subroutine compare_with_differences

  !> The library along the displacements of the accepted increments.
  subroutine compare_with_library(model, h)
    type(contact_model), intent(in) :: model
    type(history), intent(in) :: h
    real(wp), dimension(mslip_element_state_length(model%elements(1)%directions, 64_mslip_size)) :: state, trial
    real(wp), dimension(model%elements(1)%directions + 1) :: d, force
    real(wp) :: tangent(size(d), size(d)), dissipated, errors(3), scales(3), slipped, d_last
    logical :: closing
    integer(mslip_int) :: status
    integer :: i, j

    errors = 0
    scales = 0
    slipped = 0
    do i = 1, model%points
      call mslip_element_state_init(model%elements(i)%directions, state, status)
      if (status == MSLIP_OK) call mslip_element_advance(model%elements(i), state, model%offset, status)
      d_last = 0
      do j = 1, h%n
        d = matmul(model%to_law(:, :, i), h%x(:, i, j)) + model%offset
        closing = j == 1
        if (model%elements(i)%normal_input == MSLIP_INPUT_NORMAL_FORCE) then
          closing = .not. d_last > 0
          d_last = d(size(d))
          d(size(d)) = max(d_last, 0.0_wp)
          if (.not. (d_last > 0 .or. model%called_if_open)) cycle
        end if
        trial = state
        if (status == MSLIP_OK) call mslip_element_update(model%elements(i), state, d, trial, status, force, tangent, dissipated)
        if (status /= MSLIP_OK) then
          call check_status(trim(model%name)//': library', status, MSLIP_OK)
          return
        end if
        state = trial
        slipped = max(slipped, norm2(force(:size(d)-1))/max(1e-3_wp, model%elements(i)%friction_coefficient*force(size(d))))
        call compare(1, matmul(model%from_law(:, :, i), force), h%force(:, i, j))
        if (closing .and. .not. model%called_if_open) cycle     ! without friction
        call compare(2, [matmul(model%from_law(:, :, i), matmul(tangent, model%to_law(:, :, i)))], [h%tangent(:, :, i, j)])
        call compare(3, [model%share(i)*dissipated], [h%dissipated(i, j)])
      end do
    end do
    errors = errors/scales
    print '(a, 3es9.1, a, f6.3)', '  force, tangent, energy against the library:', errors, ', largest T/(mu N):', slipped
    call check(trim(model%name)//': slips grossly', slipped > 0.999_wp)
    ! The program computes the same displacements in another order, and so differs by rounding, amplified near gross slip.
    call check(trim(model%name)//': force against the library', errors(1) < 1e-12_wp)
    call check(trim(model%name)//': tangent against the library', errors(2) < 1e-8_wp)
    call check(trim(model%name)//': energy against the library', errors(3) < 1e-10_wp)

  contains

    subroutine compare(k, expected, values)
      integer, intent(in) :: k
      real(wp), intent(in) :: expected(:), values(:)

      scales(k) = max(scales(k), maxval(abs(expected)))
      errors(k) = max(errors(k), maxval(abs(values - expected)))
    end subroutine compare

  end subroutine compare_with_library

  !> From open to open, the work done on a contact is the energy that it dissipates.
  subroutine balance_energy(model, h, final)
    type(contact_model), intent(in) :: model
    type(history), intent(in) :: h
    real(wp), intent(in) :: final(:, :)
    real(wp) :: work, dissipated
    integer :: j

    work = 0
    do j = 1, h%n
      work = work + sum((h%force(:, :, j) + h%force(:, :, j-1))*(h%x(:, :, j) - h%x(:, :, j-1)))/2
    end do
    dissipated = sum(h%dissipated(:, :h%n))
    print '(a, es10.3, a, es10.3, a)', '  dissipated ', dissipated, ' J, work ', work, ' J'
    call check_close(trim(model%name)//': energy in the state variables', sum(model%share*final(model%energy, :)), dissipated, &
      1e-12_wp)
    call check(trim(model%name)//': no energy is gained', all(h%dissipated(:, :h%n) >= 0))
    ! The trapezoidal rule in some hundred increments.
    call check_close(trim(model%name)//': energy balance', dissipated, work, 0.03_wp)
  end subroutine balance_energy

  !> A trial far beyond the range of the law: a shorter increment is wanted, and the state variables are those of the start.
  subroutine exceed_range(model, before)
    type(contact_model), intent(in) :: model
    real(wp), intent(in) :: before(:, :)
    real(wp) :: x(model%unknowns), after(model%variables), force(model%unknowns), tangent(model%unknowns, model%unknowns)
    real(wp) :: dissipated, ratio

    x = 1e6_wp*model%to_law(size(model%to_law, 1), :, 1)
    x = x/norm2(model%to_law(size(model%to_law, 1), :, 1))
    call model%call_user(1, 0*x, x, before(:, 1), after, force, tangent, dissipated, ratio)
    call check(trim(model%name)//': a shorter increment', ratio < 1)
    call check_same(trim(model%name)//': state variables after an error', after, before(:, 1))
  end subroutine exceed_range

end module host
