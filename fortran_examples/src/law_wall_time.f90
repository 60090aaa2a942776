!> What the microslip law costs a forced response, beside spring-sliders.
!>
!>     law_wall_time CASE DIRECTORY
!>
!> The response of CASE to all its load factors is computed in turns with the microslip law at every contact and with
!> spring-sliders of the same initial stiffness and slip force, and nothing else exchanged. Timed is all that
!> forced_response computes, from the preparation of the contacts to the loops at the peak, but not the writing of its
!> tables.
!> The two laws lead to other responses, hence to other numbers of points and of Newton iterations (evaluations of the
!> balance with its Jacobian, that for the tables at each point among them); so the time of one iteration is compared too,
!> and the time in the law alone. Written to DIRECTORY:
!> * law_wall_time.csv  for both laws and their ratio: points, Newton iterations, wall time, wall time of an iteration and
!>                      the part of that in the law
program law_wall_time
  use, intrinsic :: iso_fortran_env, only: int64
  use case_input, only: case_data, read_case
  use csv_output, only: csv_file
  use fourier_series, only: coefficient_count
  use friction_contacts, only: contact_set, law_microslip, law_slider
  use harmonic_balance, only: balance_problem
  use kinds, only: path_length, wp
  use load_response, only: load_result, respond
  use messages, only: fail, progress, text
  implicit none

  integer, parameter :: repetitions = 5, microslip = 1, sliders = 2
  character(len=path_length) :: case_file, directory
  type(case_data) :: data(2)
  real(wp), allocatable :: wall(:,:,:), law(:,:,:)      !! (repetition, load, law)
  real(wp) :: total(2), total_law(2)
  integer :: points(2), iterations(2), repetition, load, i, turn

  if (command_argument_count() /= 2) call fail('usage: law_wall_time CASE DIRECTORY')
  call get_command_argument(1, case_file)
  call get_command_argument(2, directory)
  call read_case(trim(case_file), data(microslip))
  if (size(data(microslip)%load_factors) == 0) call fail(trim(case_file)//': a group &sweep is needed')
  data(sliders) = data(microslip)
  data(microslip)%contacts%law = law_microslip
  data(sliders)%contacts%law = law_slider

  allocate (wall(repetitions, size(data(microslip)%load_factors), 2))
  allocate (law, mold=wall)
  do repetition = 1, repetitions
    points = 0
    iterations = 0
    do load = 1, size(wall, 2)
      call equal_stiffness(data(microslip)%load_factors(load))
      do turn = 1, 2
        ! The first in one repetition is the second in the next.
        i = merge(turn, 3 - turn, modulo(repetition, 2) == 1)
        call measure(data(i), data(i)%load_factors(load), points(i), iterations(i), wall(repetition, load, i), &
                     law(repetition, load, i))
      end do
    end do
  end do
  do i = 1, 2
    total(i) = sum([(median(wall(:, load, i)), load=1, size(wall, 2))])
    total_law(i) = sum([(median(law(:, load, i)), load=1, size(wall, 2))])
  end do
  ! The law was timed at the points alone.
  total_law = total_law / points
  call report()
  call write_table()

contains

  !> The stiffness of the sliders is set, so that no microslip contact is initialised for it.
  subroutine equal_stiffness(load_factor)
    real(wp), intent(in) :: load_factor
    type(contact_set) :: contacts
    integer :: i

    call contacts%prepare(data(microslip)%contacts, load_factor)
    do i = 1, size(data(sliders)%contacts)
      data(sliders)%contacts(i)%spring_stiffness = contacts%initial_stiffness(i)
    end do
  end subroutine equal_stiffness

  !> `law` is the time that the contacts need for force and Jacobian, once at every point of the response.
  subroutine measure(data, load_factor, points, iterations, wall, law)
    type(case_data), intent(in) :: data
    real(wp), intent(in) :: load_factor
    integer, intent(inout) :: points, iterations
    real(wp), intent(out) :: wall, law
    type(balance_problem) :: problem
    type(load_result) :: response
    real(wp), dimension(coefficient_count(data%harmonics), size(data%contacts)) :: force
    real(wp) :: jacobian(size(force, 1), size(force, 1), size(force, 2)), dissipated(size(force, 2))
    integer(int64) :: start
    integer :: i

    call system_clock(start)
    call respond(data, load_factor, problem, response)
    wall = seconds_since(start)
    points = points + response%path%points
    iterations = iterations + problem%evaluations

    call system_clock(start)
    do i = 1, response%path%points
      call problem%contacts%harmonic_force(response%path%displacement(:, :, i), force, jacobian, dissipated)
    end do
    law = seconds_since(start)
  end subroutine measure

  real(wp) function seconds_since(start)
    integer(int64), intent(in) :: start
    integer(int64) :: now, rate

    call system_clock(now, rate)
    seconds_since = real(now - start, wp) / real(rate, wp)
  end function seconds_since

  !> Of an odd number of values.
  pure real(wp) function median(values)
    real(wp), intent(in) :: values(:)
    integer :: i

    median = values(1)
    do i = 1, size(values)
      median = values(i)
      if (count(values < median) <= size(values) / 2 .and. count(values > median) <= size(values) / 2) return
    end do
  end function median

  subroutine report()
    call progress('Wall time with microslip against that with spring-sliders, '//trim(data(microslip)%name)//', '// &
                  text(size(wall, 2))//' loads, '//text(data(microslip)%harmonics)//' harmonics, '// &
                  text(data(microslip)%samples)//' samples, medians of '//text(repetitions)//' runs in turns:')
    call progress('  The same forced response takes '//text(total(microslip), '(f8.3)')//' s with microslip and '// &
                  text(total(sliders), '(f8.3)')//' s with spring-sliders: ratio of the wall times '//ratio(total)//'.')
    call progress('  With microslip it has '//text(points(microslip))//' points and '//text(iterations(microslip))// &
                  ' Newton iterations, with spring-sliders '//text(points(sliders))//' and '// &
                  text(iterations(sliders))//': ratio of the wall times of one iteration '// &
                  ratio(total / iterations)//'.')
    call progress('  Of an iteration of '//microseconds(total(microslip) / iterations(microslip))//' us and '// &
                  microseconds(total(sliders) / iterations(sliders))//' us, force and Jacobian of the '// &
                  text(size(data(microslip)%contacts))//' contacts take '//microseconds(total_law(microslip))// &
                  ' us and '//microseconds(total_law(sliders))//' us.')
  end subroutine report

  function ratio(pair) result(string)
    real(wp), intent(in) :: pair(2)
    character(len=:), allocatable :: string
    string = text(pair(microslip) / pair(sliders), '(f8.2)')
  end function ratio

  function microseconds(seconds) result(string)
    real(wp), intent(in) :: seconds
    character(len=:), allocatable :: string
    string = text(1.0e6_wp * seconds, '(f10.1)')
  end function microseconds

  subroutine write_table()
    type(csv_file) :: table
    integer :: i

    call table%open(trim(directory)//'/law_wall_time.csv')
    call table%add('law')
    call table%add('points')
    call table%add('newton_iterations')
    call table%add('wall_s')
    call table%add('wall_of_iteration_s')
    call table%add('law_in_iteration_s')
    call table%end_row()
    do i = 1, 2
      call table%add(data(i)%contacts(1)%law)
      call table%add(points(i))
      call table%add(iterations(i))
      call table%add([total(i), total(i) / iterations(i), total_law(i)])
      call table%end_row()
    end do
    call table%add('ratio')
    call table%add(real(points(microslip), wp) / points(sliders))
    call table%add(real(iterations(microslip), wp) / iterations(sliders))
    call table%add(total(microslip) / total(sliders))
    call table%add(total(microslip) / iterations(microslip) / (total(sliders) / iterations(sliders)))
    call table%add(total_law(microslip) / total_law(sliders))
    call table%end_row()
    call table%close()
  end subroutine write_table
end program law_wall_time
