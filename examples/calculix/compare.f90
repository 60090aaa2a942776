! compare RESULTS [JOBS]: the results of CalculiX against the library and, if the directory of its jobs is given, against a
! solution of the same equations by other means.
!
! RESULTS has law.inp and, for the job static, a table of time, displacement of the tip, displacement and force of the contact, and
! dissipated energy; frequency.csv has the square of the lowest angular frequency; element.inp and the tables of the jobs lifting and
! orbit are those of the element with a normal direction. JOBS has the tables of the dynamic jobs, matrices.sti, .mas and .dof and
! the loads over time; the curves of the figure are written there.
program compare
  use, intrinsic :: iso_fortran_env, only: error_unit
  use microslip
  implicit none

  integer, parameter :: wp = mslip_real
  ! CalculiX prints seven digits. Its forces and corrections are converged to 1e-9 and its loads have 12 digits, which may add up
  ! to as much again in the structural solution.
  real(wp), parameter :: rounding = 5e-7_wp, structural = 2*rounding
  ! Impacts amplify the differences.
  real(wp), parameter :: lifting_tolerance = 1e-5_wp
  integer, parameter :: displacement = 3, force = 4, dissipated = 5               ! columns
  character(len=256) :: results, jobs
  type(mslip_contact) :: contact
  type(mslip_element) :: element
  integer :: m = 2                                                                ! components of its displacement
  integer :: passed = 0, failed = 0
  external :: dgesv, dposv, dsygv

  call get_command_argument(1, results)
  call get_command_argument(2, jobs)
  call initialise_contact()
  call compare_law('static', 100)
  if (jobs /= '') call compare_law('dynamic', 2)
  call initialise_element(1)
  call compare_element('lifting')
  if (jobs /= '') call compare_element('lifting_dynamic')
  call initialise_element(2)
  call compare_element('orbit')
  if (jobs /= '') call compare_element('orbit_dynamic')
  if (jobs /= '') call compare_structure()
  print '(i0, a, i0, a)', passed, ' passed, ', failed, ' failed'
  if (failed > 0) stop 1

contains

  !> The parameters in a file of results.
  function parameters_of(name) result(p)
    character(len=*), intent(in) :: name
    type(mslip_parameters) :: p
    real(wp) :: c(9)
    integer :: unit

    open (newunit=unit, file=trim(results)//'/'//name, status='old', action='read')
    read (unit, *)  ! the keyword
    read (unit, *) c
    close (unit)
    p = mslip_parameters(flat_half_width=c(1), edge_radius=c(2), length=c(3), normal_force=c(4), friction_coefficient=c(5), &
      material=[mslip_material(c(6), c(7)), mslip_material(c(8), c(9))], displacement_reference=MSLIP_CENTRE_POINT)
  end function parameters_of

  subroutine initialise_contact()
    integer :: status

    call mslip_contact_init(parameters_of('law.inp'), contact, status)
    call require(status)
  end subroutine initialise_contact

  !> The element with one or two directions of sliding.
  subroutine initialise_element(directions)
    integer, intent(in) :: directions
    integer :: status

    call mslip_element_init(parameters_of('element.inp'), directions, MSLIP_INPUT_APPROACH, element, status)
    call require(status)
    m = directions + 1
  end subroutine initialise_element

  !> The element along the displacements that CalculiX printed, a step for each increment.
  subroutine compare_element(job)
    character(len=*), intent(in) :: job
    real(wp), allocatable :: table(:, :), f(:, :), dissipated(:), state(:)
    real(wp) :: slip, error_u, error_w, error_t
    integer :: i, n, u, w, t, energy, status            ! columns: time, tip, tangential displacement and w, T and N, dissipated

    u = m + 2
    w = 2*m + 1
    t = w + 1
    energy = 3*m + 2
    call read_table(table_of(job), energy, table)
    n = size(table, 2)
    allocate (f(m, n), dissipated(n), state(mslip_element_state_length(m - 1, 64_mslip_size)))
    call mslip_element_state_init(m - 1, state, status)
    call mslip_element_path_advance(element, state, table(u:w, :), status, force=f, dissipated=dissipated)
    call require(status)
    error_u = rounding*maxval(norm2(table(u:w - 1, :), 1))
    error_w = rounding*maxval(abs(table(w, :)))
    slip = element%friction_coefficient*maxval(f(m, :))
    error_t = 2*element%tangential_stiffness*error_u + 2*element%friction_coefficient*element%normal_stiffness*error_w &
      + rounding*slip
    call check(job//': normal force along the path', maxval(abs(f(m, :) - table(w + m, :))), &
      element%normal_stiffness*error_w + rounding*maxval(f(m, :)), maxval(f(m, :)))
    call check(job//': force along the path', maxval(norm2(f(:m - 1, :) - table(t:t + m - 2, :), 1)), error_t, slip)
    dissipated = [(sum(dissipated(:i)), i=1, n)]
    call check(job//': energy along the path', maxval(abs(dissipated - table(energy, :))), &
      20*(slip*error_u + error_t*maxval(norm2(table(u:w - 1, :), 1))) + rounding*dissipated(n), dissipated(n))
  end subroutine compare_element

  !> The law along the displacements that CalculiX printed, with straight segments of `parts` steps between them.
  subroutine compare_law(job, parts)
    character(len=*), intent(in) :: job
    integer, intent(in) :: parts
    real(wp), allocatable :: table(:, :), path(:), f(:), energy(:), state(:)
    real(wp) :: error
    integer :: i, n, reversals, status, unit

    call read_table(table_of(job), 5, table)
    n = size(table, 2)
    associate (u => [0.0_wp, table(displacement, :)])
      path = [(u((i - 1)/parts + 1) + (u((i - 1)/parts + 2) - u((i - 1)/parts + 1))*(mod(i - 1, parts) + 1)/parts, i=1, n*parts)]
      reversals = count((u(3:) - u(2:n))*(u(2:n) - u(:n - 1)) < 0)
    end associate
    allocate (f(n*parts), energy(n*parts), state(mslip_state_length(30_mslip_size)))
    call mslip_state_init(state, status)
    call mslip_masing_path_advance(contact, state, path, status, force=f, dissipated=energy)
    call require(status)
    error = rounding*maxval(abs(table(displacement, :)))
    ! The law is a sum of sliders, and the force of each changes by at most twice that of its spring if the whole history of
    ! displacements changes by this error.
    call check(job//': force along the displacements', maxval(abs(f(parts::parts) - table(force, :))), &
      2*contact%initial_stiffness*error + rounding*contact%slip_force, contact%slip_force)
    ! The energy has the errors of the displacements at the reversals and at the end, each times the range of the force at most.
    energy = [(sum(energy(:i)), i=1, n*parts)]
    call check(job//': energy along the displacements', maxval(abs(energy(parts::parts) - table(dissipated, :))), &
      2*(reversals + 1)*contact%slip_force*error + rounding*energy(n*parts), energy(n*parts))

    if (jobs == '') return
    open (newunit=unit, file=trim(jobs)//'/'//job//'_curve.csv', action='write')
    write (unit, '(a)') 'displacement,force', '0,0'
    write (unit, '(es14.7, ",", es14.7)') (path(i), f(i), i=1, n*parts)
    close (unit)
  end subroutine compare_law

  !> The blade with the element under static loads and by the trapezoidal rule; the lowest natural frequency with the contact.
  subroutine compare_structure()
    real(wp), allocatable :: stiffness(:, :), mass(:, :), table(:, :), inverse_squares(:), work(:)
    real(wp) :: lowest
    integer :: rubbing, i, n

    n = equation(' ')
    rubbing = equation('103.3')
    stiffness = read_matrix('matrices.sti', n)
    mass = read_matrix('matrices.mas', n)

    call initialise_element(1)
    call compare_lifting('lifting', stiffness, mass)
    call compare_lifting('lifting_dynamic', stiffness, mass)
    call initialise_element(2)
    call compare_lifting('orbit', stiffness, mass)
    call compare_lifting('orbit_dynamic', stiffness, mass)

    call read_table(trim(results)//'/frequency.csv', 1, table)
    stiffness(rubbing, rubbing) = stiffness(rubbing, rubbing) + contact%initial_stiffness
    allocate (inverse_squares(n), work(64*n))
    ! M x = K x/omega^2: the mass matrix is singular, because the incompatible modes have no mass.
    call dsygv(1, 'N', 'U', n, mass, n, stiffness, n, inverse_squares, work, size(work), i)
    if (i /= 0) call stop_with('the stiffness matrix is not positive definite')
    lowest = 1/inverse_squares(n)
    call check('frequency: lowest, squared', abs(lowest - table(1, 1)), structural*lowest, lowest)
  end subroutine compare_structure

  function inverse_of(matrix) result(inverse)
    real(wp), intent(in) :: matrix(:, :)
    real(wp), dimension(size(matrix, 1), size(matrix, 1)) :: factors, inverse
    integer :: i, n, status

    n = size(matrix, 1)
    factors = matrix
    inverse = 0
    do i = 1, n
      inverse(i, i) = 1
    end do
    call dposv('U', n, n, factors, n, inverse, n, status)
    if (status /= 0) call stop_with('a matrix of CalculiX is not positive definite')
  end function inverse_of

  !> Trapezoidal rule with `rate` = 2/step: (K + rate^2 M) u = load - contact force + M (inertia). Static if `rate` is 0. Forces at
  !> the tip in y and z, or x, y and z; the element slides in y, or y and x, and closes in -z.
  subroutine compare_lifting(job, stiffness, mass)
    character(len=*), intent(in) :: job
    real(wp), intent(in) :: stiffness(:, :), mass(:, :)
    character(len=*), parameter :: names(3) = [character(len=12) :: 'tip', 'displacement', 'force']
    real(wp), allocatable :: loads(:, :), table(:, :), own(:, :)
    real(wp) :: state(mslip_element_state_length(m - 1, 64_mslip_size)), rate, largest, side(size(mass, 1), m)
    real(wp), dimension(size(mass, 1)) :: u, velocity, acceleration, inertia
    real(wp) :: inverse(size(mass, 1), size(mass, 1))
    integer :: tip_equations(m), axes(m), i, j, status

    call read_table(trim(jobs)//'/'//job//'_load.csv', m + 1, loads)
    call read_table(table_of(job), 3*m + 2, table)
    rate = 0
    if (index(job, 'dynamic') > 0) rate = 2/loads(1, 2)
    axes = [2, (1, i=3, m), 3]
    side = 0
    do j = 1, m
      tip_equations(j) = equation('113.'//achar(iachar('3') - m + j))
      side(equation('103.'//achar(iachar('0') + axes(j))), j) = merge(-1, 1, j == m)
    end do
    inverse = inverse_of(stiffness + rate**2*mass)
    call mslip_element_state_init(m - 1, state, status)
    allocate (own, mold=table)
    u = 0
    velocity = 0
    acceleration = 0
    do i = 1, size(table, 2)
      inertia = rate**2*u + 2*rate*velocity + acceleration
      u = matmul(mass, inertia)
      u(tip_equations) = u(tip_equations) + [(at_time(loads(1:j + 1:j, :), table(1, i)), j=1, m)]
      u = matmul(inverse, u)
      call element_equilibrium(matmul(u, side), matmul(transpose(side), matmul(inverse, side)), state, &
        own(m + 2:2*m + 1, i), own(2*m + 2:3*m + 1, i))
      u = u - matmul(inverse, matmul(side, own(2*m + 2:3*m + 1, i)))
      own(2:m + 1, i) = u(tip_equations)
      inertia = rate**2*u - inertia  ! the new acceleration
      if (rate > 0) velocity = velocity + (acceleration + inertia)/rate
      acceleration = inertia
    end do
    do i = 2, 3*m + 1
      largest = maxval(abs(own(i, :)))
      call check(job//': structural solution, '//trim(names((i - 2)/m + 1))//' '//achar(iachar('1') + mod(i - 2, m)), &
        maxval(abs(own(i, :) - table(i, :))), lifting_tolerance*largest, largest)
    end do
  end subroutine compare_lifting

  !> Equilibrium u = free - compliance*force of element and structure: Newton's method with the tangent of the element; a step that
  !> does not reduce the residual is halved.
  subroutine element_equilibrium(free, compliance, state, u, f)
    real(wp), intent(in) :: free(m), compliance(m, m)
    real(wp), intent(inout) :: state(:)
    real(wp), intent(out) :: u(m), f(m)
    real(wp) :: trial(size(state)), tangent(m, m), matrix(m, m), residual(m), step(m), last
    integer :: i, j, status, pivots(m)

    u = free
    step = 0
    last = huge(last)
    do i = 1, 200
      call mslip_element_update(element, state, u + step, trial, status, f, tangent)
      residual = free - u - step - matmul(compliance, f)
      if (status /= MSLIP_OK .or. norm2(residual) >= last) then
        if (norm2(step) <= 4*spacing(norm2(u))) exit
        step = step/2
        cycle
      end if
      u = u + step
      last = norm2(residual)
      matrix = matmul(compliance, tangent)
      do j = 1, m
        matrix(j, j) = matrix(j, j) + 1
      end do
      step = residual
      call dgesv(m, 1, matrix, m, pivots, step, m, status)
    end do
    if (i > 200) call stop_with('no equilibrium')
    call mslip_element_update(element, state, u, trial, status, f)
    call require(status)
    state = trial
  end subroutine element_equilibrium

  subroutine check(name, difference, allowed, largest)
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: difference, allowed, largest
    logical :: ok

    ok = difference <= allowed .and. largest > 0
    passed = passed + merge(1, 0, ok)
    failed = failed + merge(0, 1, ok)
    print '(a, t58, es8.1, a, es8.1, a, es8.1, a)', name, difference/largest, ' of ', largest, ', allowed ', allowed/largest, &
      merge('        ', '  FAILED', ok)
  end subroutine check

  !> The table of a job: of a static one in the results, of a dynamic one with the jobs.
  function table_of(job) result(file)
    character(len=*), intent(in) :: job
    character(len=:), allocatable :: file

    file = trim(merge(jobs, results, index(job, 'dynamic') > 0))//'/'//job//'.csv'
  end function table_of

  !> Values of a table, a column for each line; lines that do not begin with a number are skipped.
  subroutine read_table(file, columns, table)
    character(len=*), intent(in) :: file
    integer, intent(in) :: columns
    real(wp), allocatable, intent(out) :: table(:, :)
    real(wp), allocatable :: values(:)
    real(wp) :: row(columns)
    character(len=256) :: line
    integer :: unit, status

    allocate (values(0))
    open (newunit=unit, file=file, status='old', action='read')
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      if (scan(line(1:1), '+-.0123456789') == 0) cycle
      read (line, *) row
      values = [values, row]
    end do
    close (unit)
    if (size(values) == 0) call stop_with(file//' has no numbers')
    table = reshape(values, [columns, size(values)/columns])
  end subroutine read_table

  !> A symmetric matrix of order n of which one triangle is stored, a line for each entry.
  function read_matrix(name, n) result(matrix)
    character(len=*), intent(in) :: name
    integer, intent(in) :: n
    real(wp) :: matrix(n, n), value
    integer :: unit, status, i, j

    matrix = 0
    open (newunit=unit, file=trim(jobs)//'/'//name, status='old', action='read')
    do
      read (unit, *, iostat=status) i, j, value
      if (status /= 0) exit
      matrix(i, j) = value
      matrix(j, i) = value
    end do
    close (unit)
  end function read_matrix

  !> Number of the equation "node.direction", of all equations if blank.
  integer function equation(requested)
    character(len=*), intent(in) :: requested
    character(len=32) :: line
    integer :: unit, status

    open (newunit=unit, file=trim(jobs)//'/matrices.dof', status='old', action='read')
    equation = 0
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      equation = equation + 1
      if (adjustl(line) == requested) exit
    end do
    close (unit)
    if (requested /= ' ' .and. status /= 0) call stop_with('no equation '//requested)
  end function equation

  !> Linear interpolation between the lines of a table.
  pure real(wp) function at_time(table, time) result(value)
    real(wp), intent(in) :: table(:, :), time
    integer :: i

    i = max(2, min(size(table, 2), count(table(1, :) < time) + 1))
    value = table(2, i) + (table(2, i - 1) - table(2, i))*(table(1, i) - time)/(table(1, i) - table(1, i - 1))
  end function at_time

  subroutine require(status)
    integer, intent(in) :: status
    if (status /= MSLIP_OK) call stop_with(mslip_status_text(status))
  end subroutine require

  subroutine stop_with(reason)
    character(len=*), intent(in) :: reason
    write (error_unit, '(2a)') 'compare: ', reason
    stop 2
  end subroutine stop_with
end program compare
