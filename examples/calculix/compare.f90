! compare RESULTS [MATRICES]: the results of CalculiX against the library and, if the matrices of the blade are given, against
! the same problem solved here.
!
! RESULTS holds law.inp and, for the jobs static and dynamic, tables of time, displacement of the tip, displacement and
! force of the contact, and energy dissipated until then; frequency.csv has the square of the lowest circular frequency.
! MATRICES holds matrices.sti, .mas and .dof and the loads over time; curves for a picture are written there.
program compare
  use, intrinsic :: iso_fortran_env, only: error_unit
  use microslip
  implicit none
  integer, parameter :: wp = mslip_real

  ! CalculiX prints seven digits.
  real(wp), parameter :: rounding = 5e-7_wp
  ! Its forces and corrections are converged to 1e-9, and its loads are given to 12 digits: beside what is rounded in
  ! printing, that may be as much again.
  real(wp), parameter :: against_own_solution = 2*rounding

  interface
    subroutine dpotrf(uplo, n, a, lda, info)
      import :: wp
      character, intent(in) :: uplo
      integer, intent(in) :: n, lda
      real(wp), intent(inout) :: a(lda, *)
      integer, intent(out) :: info
    end subroutine dpotrf
    subroutine dpotrs(uplo, n, nrhs, a, lda, b, ldb, info)
      import :: wp
      character, intent(in) :: uplo
      integer, intent(in) :: n, nrhs, lda, ldb
      real(wp), intent(in) :: a(lda, *)
      real(wp), intent(inout) :: b(ldb, *)
      integer, intent(out) :: info
    end subroutine dpotrs
  end interface

  character(len=256) :: results, matrices
  type(mslip_contact) :: contact
  integer :: passed = 0, failed = 0

  call get_command_argument(1, results)
  call get_command_argument(2, matrices)
  contact = contact_of(trim(results)//'/law.inp')
  call compare_law('static')
  call compare_law('dynamic')
  if (matrices /= '') then
    call compare_structure()
    call write_curve('static', 100)
    call write_curve('dynamic', 2)
  end if
  print '(i0, a, i0, a)', passed, ' passed, ', failed, ' failed'
  if (failed > 0) stop 1

contains

  !> The law along the displacements that CalculiX printed.
  subroutine compare_law(job)
    character(len=*), intent(in) :: job
    real(wp), allocatable :: table(:, :), displacement(:), force(:), dissipated(:), state(:)
    real(wp) :: displaced
    integer :: i, n, reversals, status

    call read_table(trim(results)//'/'//job//'.csv', 5, table)
    displacement = table(3, :)
    n = size(displacement)
    allocate (force(n), dissipated(n), state(mslip_state_length(30_mslip_size)))
    call mslip_state_init(state, status)
    if (status == MSLIP_OK) &
      call mslip_masing_path_advance(contact, state, displacement, status, force=force, dissipated=dissipated)
    if (status /= MSLIP_OK) call give_up(mslip_status_text(status))
    do i = 2, n
      dissipated(i) = dissipated(i - 1) + dissipated(i)
    end do
    displaced = rounding*maxval(abs(displacement))
    ! The law is a sum of sliders, and a slider's force changes by at most twice what its spring's does where the whole
    ! history of displacements is changed by so much.
    call check(job//': force along the displacements', maxval(abs(force - table(4, :))), &
      2*contact%initial_stiffness*displaced + rounding*contact%slip_force, contact%slip_force)
    ! The error of the energy is due to those of the displacements at the reversals and at the end: at most the whole range
    ! of the force times these.
    reversals = count((displacement(3:) - displacement(2:n - 1))*(displacement(2:n - 1) - displacement(:n - 2)) < 0)
    call check(job//': energy along the displacements', maxval(abs(dissipated - table(5, :))), &
      2*(reversals + 1)*contact%slip_force*displaced + rounding*dissipated(n), dissipated(n))
  end subroutine compare_law

  !> For the figure: the law along straight segments between the displacements that CalculiX printed.
  subroutine write_curve(job, parts)
    character(len=*), intent(in) :: job
    integer, intent(in) :: parts
    real(wp), allocatable :: table(:, :), state(:)
    real(wp) :: force, displacement, before
    integer :: i, j, status, unit

    call read_table(trim(results)//'/'//job//'.csv', 5, table)
    allocate (state(mslip_state_length(30_mslip_size)))
    call mslip_state_init(state, status)
    open (newunit=unit, file=trim(matrices)//'/'//job//'_curve.csv', action='write')
    write (unit, '(a)') 'displacement,force', '0,0'
    before = 0
    do i = 1, size(table, 2)
      do j = 1, parts
        displacement = before + (table(3, i) - before)*j/parts
        if (status == MSLIP_OK) call mslip_masing_advance(contact, state, displacement, status, force)
        if (status /= MSLIP_OK) call give_up(mslip_status_text(status))
        write (unit, '(es14.7, a, es14.7)') displacement, ',', force
      end do
      before = table(3, i)
    end do
    close (unit)
  end subroutine write_curve

  !> The blade with the contact, solved here: loads one by one, trapezoidal rule in time, lowest frequency.
  subroutine compare_structure()
    real(wp), allocatable :: stiffness(:, :), mass(:, :)
    integer :: n, tip, rub

    n = equation(0, 0)
    tip = equation(113, 3)
    rub = equation(103, 3)
    stiffness = read_matrix('matrices.sti', n)
    mass = read_matrix('matrices.mas', n)
    call compare_static(stiffness, tip, rub)
    call compare_dynamic(stiffness, mass, tip, rub)
    call compare_frequency(stiffness, mass, rub)
  end subroutine compare_structure

  subroutine compare_static(stiffness, tip, rub)
    real(wp), intent(in) :: stiffness(:, :)
    integer, intent(in) :: tip, rub
    real(wp), allocatable :: factor(:, :), unit_load(:, :), table(:, :), loads(:, :), own(:, :), state(:)
    real(wp) :: load
    integer :: i, n, status

    n = size(stiffness, 1)
    allocate (unit_load(n, 2), state(mslip_state_length(30_mslip_size)))
    allocate (factor, source=stiffness)
    call factorise(factor)
    unit_load = 0
    unit_load(tip, 1) = 1
    unit_load(rub, 2) = 1
    call solve(factor, unit_load)
    call read_table(trim(results)//'/static.csv', 5, table)
    call read_table(trim(matrices)//'/static_load.csv', 2, loads)
    own = table
    call mslip_state_init(state, status)
    do i = 1, size(table, 2)
      load = at_time(loads, table(1, i))
      call rest(load*unit_load(rub, 1), unit_load(rub, 2), state, own(3, i), own(4, i))
      own(2, i) = load*unit_load(tip, 1) - own(4, i)*unit_load(tip, 2)
    end do
    call check_columns('static', table, own)
  end subroutine compare_static

  subroutine compare_dynamic(stiffness, mass, tip, rub)
    real(wp), intent(in) :: stiffness(:, :), mass(:, :)
    integer, intent(in) :: tip, rub
    real(wp), allocatable :: factor(:, :), contact_load(:, :), place(:, :), old(:), speed(:), acceleration(:)
    real(wp), allocatable :: inertia(:), table(:, :), loads(:, :), own(:, :), state(:)
    real(wp) :: step
    integer :: i, n, status

    n = size(stiffness, 1)
    allocate (contact_load(n, 1), place(n, 1), state(mslip_state_length(30_mslip_size)))
    call read_table(trim(results)//'/dynamic.csv', 5, table)
    call read_table(trim(matrices)//'/dynamic_load.csv', 2, loads)
    step = (loads(1, size(loads, 2)) - loads(1, 1))/(size(loads, 2) - 1)
    allocate (factor, source=stiffness + 4/step**2*mass)
    call factorise(factor)
    contact_load = 0
    contact_load(rub, 1) = 1
    call solve(factor, contact_load)
    own = table
    call mslip_state_init(state, status)
    place = 0
    allocate (old(n), speed(n), acceleration(n), source=0.0_wp)  ! the force begins at nothing
    do i = 1, size(table, 2)
      old = place(:, 1)
      inertia = 4/step**2*old + 4/step*speed + acceleration
      place(:, 1) = matmul(mass, inertia)
      place(tip, 1) = place(tip, 1) + loads(2, i + 1)
      call solve(factor, place)
      call rest(place(rub, 1), contact_load(rub, 1), state, own(3, i), own(4, i))
      place = place - own(4, i)*contact_load
      own(2, i) = place(tip, 1)
      inertia = 4/step**2*place(:, 1) - inertia  ! the new acceleration
      speed = speed + step/2*(acceleration + inertia)
      acceleration = inertia
    end do
    call check_columns('dynamic', table, own)
  end subroutine compare_dynamic

  !> Lowest frequency with the initial stiffness of the contact, by inverse iteration.
  subroutine compare_frequency(stiffness, mass, rub)
    real(wp), intent(in) :: stiffness(:, :), mass(:, :)
    integer, intent(in) :: rub
    real(wp), allocatable :: factor(:, :), mode(:, :), moved(:), table(:, :)
    real(wp) :: square
    integer :: i

    allocate (factor, source=stiffness)
    factor(rub, rub) = factor(rub, rub) + contact%initial_stiffness
    call factorise(factor)
    allocate (mode(size(stiffness, 1), 1), source=1.0_wp)
    do i = 1, 30  ! the next is 24 times as large
      moved = matmul(mass, mode(:, 1))
      mode(:, 1) = moved
      call solve(factor, mode)
      square = dot_product(mode(:, 1), moved)/dot_product(mode(:, 1), matmul(mass, mode(:, 1)))
      mode = mode/norm2(mode)
    end do
    call read_table(trim(results)//'/frequency.csv', 1, table)
    call check('frequency: lowest, squared', abs(square - table(1, 1)), against_own_solution*square, square)
  end subroutine compare_frequency

  !> Equilibrium of a structure that is displaced by `free` without the contact and by `free - compliance*force` with it:
  !> Newton's method within bounds, since force increases with displacement and is at most mu N. Trial steps start from `state`,
  !> which becomes that of the solution.
  subroutine rest(free, compliance, state, displacement, force)
    real(wp), intent(in) :: free, compliance
    real(wp), intent(inout) :: state(:)
    real(wp), intent(out) :: displacement, force
    real(wp) :: trial(size(state)), low, high, excess, stiffness
    integer :: i, status

    low = free - compliance*contact%slip_force
    high = free + compliance*contact%slip_force
    displacement = (low + high)/2
    do i = 1, 200
      call mslip_masing_update(contact, state, displacement, trial, status, force, stiffness)
      if (status /= MSLIP_OK) call give_up(mslip_status_text(status))
      excess = displacement - free + compliance*force
      if (excess > 0) high = displacement
      if (excess < 0) low = displacement
      if (high - low <= 4*spacing(displacement) .or. abs(excess) <= 2*spacing(free)) exit
      displacement = displacement - excess/(1 + compliance*stiffness)
      if (displacement <= low .or. displacement >= high) displacement = (low + high)/2
    end do
    state = trial
  end subroutine rest

  subroutine check_columns(job, table, own)
    character(len=*), intent(in) :: job
    real(wp), intent(in) :: table(:, :), own(:, :)
    character(len=*), parameter :: names(2:4) = [character(len=27) :: 'displacement of the tip', &
      'displacement of the contact', 'force of the contact']
    integer :: i

    do i = 2, 4
      call check(job//': own solution, '//trim(names(i)), maxval(abs(own(i, :) - table(i, :))), &
        against_own_solution*maxval(abs(own(i, :))), maxval(abs(own(i, :))))
    end do
  end subroutine check_columns

  subroutine check(name, difference, allowed, largest)
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: difference, allowed, largest

    if (difference <= allowed .and. largest > 0) then
      passed = passed + 1
    else
      failed = failed + 1
    end if
    print '(a, t52, es8.1, a, es8.1, a, es8.1, a)', name, difference/largest, ' of ', largest, ', allowed ', allowed/largest, &
      merge('        ', '  FAILED', difference <= allowed .and. largest > 0)
  end subroutine check

  function contact_of(file) result(prepared)
    character(len=*), intent(in) :: file
    type(mslip_contact) :: prepared
    type(mslip_parameters) :: p
    real(wp) :: constants(9)
    integer :: unit, status

    open (newunit=unit, file=file, status='old', action='read')
    read (unit, *)  ! the keyword
    read (unit, *) constants
    close (unit)
    call mslip_parameters_default(p)
    p%flat_half_width = constants(1)
    p%edge_radius = constants(2)
    p%length = constants(3)
    p%normal_force = constants(4)
    p%friction_coefficient = constants(5)
    p%material = [mslip_material(constants(6), constants(7)), mslip_material(constants(8), constants(9))]
    call mslip_contact_init(p, prepared, status)
    if (status /= MSLIP_OK) call give_up(mslip_status_text(status))
  end function contact_of

  !> Numbers of a table, a column for each line; lines that do not begin with a number are passed over.
  subroutine read_table(file, columns, table)
    character(len=*), intent(in) :: file
    integer, intent(in) :: columns
    real(wp), allocatable, intent(out) :: table(:, :)
    real(wp) :: row(columns)
    character(len=256) :: line
    integer :: unit, status

    allocate (table(columns, 0))
    open (newunit=unit, file=file, status='old', action='read')
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      if (scan(line(1:1), '+-.0123456789') == 0) cycle
      read (line, *) row
      table = reshape([table, row], [columns, size(table, 2) + 1])
    end do
    close (unit)
    if (size(table) == 0) call give_up(file//' has no numbers')
  end subroutine read_table

  !> A symmetric matrix of which one half is stored, a line for each entry.
  function read_matrix(name, n) result(matrix)
    character(len=*), intent(in) :: name
    integer, intent(in) :: n
    real(wp), allocatable :: matrix(:, :)
    real(wp) :: value
    integer :: unit, i, j, status

    allocate (matrix(n, n), source=0.0_wp)
    open (newunit=unit, file=trim(matrices)//'/'//name, status='old', action='read')
    do
      read (unit, *, iostat=status) i, j, value
      if (status /= 0) exit
      matrix(i, j) = value
      matrix(j, i) = value
    end do
    close (unit)
  end function read_matrix

  !> Number of the equation of a node's direction; of all of them for node 0.
  function equation(node, axis) result(number)
    integer, intent(in) :: node, axis
    integer :: number, unit, status
    character(len=32) :: line, requested

    write (requested, '(i0, a, i0)') node, '.', axis
    open (newunit=unit, file=trim(matrices)//'/matrices.dof', status='old', action='read')
    number = 0
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      number = number + 1
      if (adjustl(line) == requested) exit
    end do
    close (unit)
    if (node /= 0 .and. status /= 0) call give_up('no equation '//trim(requested))
  end function equation

  !> Linear between the lines of a table.
  function at_time(table, time) result(value)
    real(wp), intent(in) :: table(:, :), time
    real(wp) :: value
    integer :: i

    i = max(2, min(size(table, 2), count(table(1, :) < time) + 1))
    value = table(2, i) + (table(2, i - 1) - table(2, i))*(table(1, i) - time)/(table(1, i) - table(1, i - 1))
  end function at_time

  subroutine factorise(matrix)
    real(wp), intent(inout) :: matrix(:, :)
    integer :: info

    call dpotrf('U', size(matrix, 1), matrix, size(matrix, 1), info)
    if (info /= 0) call give_up('a matrix of CalculiX is not positive')
  end subroutine factorise

  subroutine solve(factor, vectors)
    real(wp), intent(in) :: factor(:, :)
    real(wp), intent(inout) :: vectors(:, :)
    integer :: info

    call dpotrs('U', size(factor, 1), size(vectors, 2), factor, size(factor, 1), vectors, size(factor, 1), info)
    if (info /= 0) call give_up('dpotrs')
  end subroutine solve

  subroutine give_up(reason)
    character(len=*), intent(in) :: reason

    write (error_unit, '(2a)') 'compare: ', reason
    stop 2
  end subroutine give_up

end program compare
