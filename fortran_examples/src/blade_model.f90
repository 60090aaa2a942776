!> Writes the reduced model of two blades, or holds the files of an earlier run against it.
!>
!>     blade_model write DIRECTORY
!>     blade_model check DIRECTORY
program blade_model
  use blade_pair, only: build_blade_pair, full_blade, reduced_blade
  use dense_algebra, only: symmetric_modes
  use kinds, only: name_length, path_length, pi, wp
  use linear_structure, only: read_structure, structure, write_dof_map
  use matrix_market, only: write_symmetric_matrix
  use messages, only: fail, progress, text
  implicit none

  ! Matrices are compared entry by entry, relative to the diagonal. Another LAPACK moves the modes by its rounding
  ! error times the condition of the stiffness matrix, about 1e-16 * 1e6.
  real(wp), parameter :: tolerance = 1.0e-9_wp
  ! A reduction that moves a natural frequency of interest by more than this is of no use.
  real(wp), parameter :: reduction_tolerance = 1.0e-3_wp
  integer, parameter :: frequencies_of_interest = 4

  character(len=path_length) :: mode, directory
  real(wp), allocatable :: mass(:,:), damping(:,:), stiffness(:,:)
  character(len=name_length), allocatable :: names(:)

  if (command_argument_count() /= 2) call fail('usage: blade_model write|check DIRECTORY')
  call get_command_argument(1, mode)
  call get_command_argument(2, directory)

  call build_blade_pair(mass, damping, stiffness, names)
  call check_reduction()
  select case (mode)
  case ('write')
    call write_files(trim(directory)//'/blades')
  case ('check')
    call check_files(trim(directory)//'/blades')
  case default
    call fail('first argument "'//trim(mode)//'": must be write or check')
  end select

contains

  !> Natural frequencies of the reduced blade against those of all its elements, with open contacts.
  subroutine check_reduction()
    real(wp), allocatable :: m(:,:), k(:,:), full(:), reduced(:), modes(:,:)
    integer :: blade, i

    do blade = 1, 2
      call full_blade(blade, m, k)
      allocate (full(size(m, 1)), modes(size(m, 1), size(m, 1)))
      call symmetric_modes(k, m, full, modes)
      deallocate (modes)
      call reduced_blade(blade, m, k)
      allocate (reduced(size(m, 1)), modes(size(m, 1), size(m, 1)))
      call symmetric_modes(k, m, reduced, modes)
      do i = 1, frequencies_of_interest
        call progress('blade '//text(blade)//', mode '//text(i)//', contacts open: '// &
                      text(full(i) / (2.0_wp * pi), '(f10.2)')//' Hz, reduced '// &
                      text(reduced(i) / (2.0_wp * pi), '(f10.2)')//' Hz')
        if (abs(reduced(i) / full(i) - 1.0_wp) > reduction_tolerance) then
          call fail('the reduction moves natural frequency '//text(i)//' by more than '// &
                    text(reduction_tolerance)//': keep more modes')
        end if
      end do
      deallocate (full, reduced, modes)
    end do
  end subroutine check_reduction

  subroutine write_files(prefix)
    character(len=*), intent(in) :: prefix

    call write_symmetric_matrix(prefix//'_mass.mtx', 'mass of two blades, kg', mass)
    call write_symmetric_matrix(prefix//'_damping.mtx', 'damping of two blades, N s/m', damping)
    call write_symmetric_matrix(prefix//'_stiffness.mtx', 'stiffness of two blades, contacts open, N/m', stiffness)
    call write_dof_map(prefix//'_dof.txt', 'degrees of freedom of two blades; modes are mass-normalised', names)
    call progress('wrote '//prefix//'_{mass,damping,stiffness}.mtx and '//prefix//'_dof.txt')
  end subroutine write_files

  subroutine check_files(prefix)
    character(len=*), intent(in) :: prefix
    type(structure) :: stored

    call read_structure(prefix//'_mass.mtx', prefix//'_damping.mtx', prefix//'_stiffness.mtx', &
                        prefix//'_dof.txt', stored)
    if (size(stored%dof_name) /= size(names)) then
      call fail(prefix//'_dof.txt: '//text(size(names))//' degrees of freedom expected')
    end if
    if (any(stored%dof_name /= names)) call fail(prefix//'_dof.txt: names differ from the model')
    call compare(prefix//'_mass.mtx', stored%mass, mass)
    call compare(prefix//'_damping.mtx', stored%damping, damping)
    call compare(prefix//'_stiffness.mtx', stored%stiffness, stiffness)
    call progress('the files '//prefix//'_* agree with the model')
  end subroutine check_files

  subroutine compare(path, found, expected)
    character(len=*), intent(in) :: path
    real(wp), intent(in) :: found(:,:), expected(:,:)
    integer :: i, j

    do j = 1, size(expected, 2)
      do i = 1, size(expected, 1)
        if (.not. abs(found(i, j) - expected(i, j)) <= tolerance * sqrt(expected(i, i) * expected(j, j))) then
          call fail(path//': row '//text(i)//', column '//text(j)//' is '//text(found(i, j), '(es24.16)')// &
                    ', the model gives '//text(expected(i, j), '(es24.16)'))
        end if
      end do
    end do
  end subroutine compare
end program blade_model
