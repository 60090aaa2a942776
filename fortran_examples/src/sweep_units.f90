!> A sweep cut into units that may be solved in any order and anywhere: one block of frequencies of one case at one load
!> factor. A unit starts from rest and depends on no other, so its record has the same bits whoever solves it.
module sweep_units
  use case_input, only: case_data, read_case
  use case_problem, only: prepare_problem
  use fourier_series, only: coefficient_count, series_basis, series_peak
  use friction_contacts, only: contact_history, contact_set, law_microslip, max_reversals
  use harmonic_balance, only: balance_point, balance_problem, solve_at, solve_from_rest, structure_response
  use kinds, only: pi, wp
  use messages, only: fail, text
  use microslip, only: mslip_contact, mslip_state_length
  implicit none
  private
  public :: prepare_contacts, read_sweep

  ! Values of a point before the energies of its contacts.
  integer, parameter, public :: point_amplitude = 1, point_found = 2, point_energy = 3

  type, public :: frequency_sweep
    type(case_data), allocatable :: cases(:)
    integer :: blocks = 0, points = 0                      !! of each load, of each block
    integer :: max_contacts = 0                           !! of a case
    integer, allocatable :: case_of(:)                     !! of each load of each case
    real(wp), allocatable :: load_factor(:)
    type(mslip_contact), allocatable :: contacts(:,:)      !! (contact, load), all prepared
    type(balance_problem), allocatable, private :: problems(:)
  contains
    procedure :: units => count_of_units
    procedure :: load_of
    procedure :: frequency
    procedure :: record_length
    procedure :: solve
    procedure :: unpack
    procedure :: description
  end type frequency_sweep

contains

  !> All but the contacts.
  subroutine read_sweep(files, blocks, points, sweep)
    character(len=*), intent(in) :: files(:)
    integer, intent(in) :: blocks, points
    type(frequency_sweep), intent(out) :: sweep
    integer :: i, j

    sweep%blocks = blocks
    sweep%points = points
    allocate (sweep%cases(size(files)), sweep%problems(size(files)))
    allocate (sweep%case_of(0), sweep%load_factor(0))
    do i = 1, size(files)
      call read_case(trim(files(i)), sweep%cases(i))
      associate (data => sweep%cases(i))
        if (size(data%load_factors) == 0) call fail(trim(files(i))//': a group &sweep is needed')
        if (any(data%contacts%law /= law_microslip)) then
          call fail(trim(files(i))//': every contact of a shared sweep must have law = "'//law_microslip//'"')
        end if
        call prepare_problem(data, 1.0_wp, data%harmonics, data%samples, sweep%problems(i))
        sweep%case_of = [sweep%case_of, (i, j=1, size(data%load_factors))]
        sweep%load_factor = [sweep%load_factor, data%load_factors]
        sweep%max_contacts = max(sweep%max_contacts, size(data%contacts))
      end associate
    end do
    allocate (sweep%contacts(sweep%max_contacts, size(sweep%load_factor)))
  end subroutine read_sweep

  subroutine prepare_contacts(sweep)
    type(frequency_sweep), intent(inout) :: sweep
    type(contact_set) :: set
    integer :: load

    do load = 1, size(sweep%load_factor)
      call set%prepare(sweep%cases(sweep%case_of(load))%contacts, sweep%load_factor(load))
      sweep%contacts(:size(set%prepared), load) = set%prepared
    end do
  end subroutine prepare_contacts

  pure integer function count_of_units(self)
    class(frequency_sweep), intent(in) :: self
    count_of_units = size(self%load_factor) * self%blocks
  end function count_of_units

  !> Units are numbered from 1, block by block of each load.
  pure integer function load_of(self, unit)
    class(frequency_sweep), intent(in) :: self
    integer, intent(in) :: unit
    load_of = (unit - 1) / self%blocks + 1
  end function load_of

  !> In Hz: the middle of each of the equal parts of the case's range.
  pure real(wp) function frequency(self, unit, point)
    class(frequency_sweep), intent(in) :: self
    integer, intent(in) :: unit, point
    real(wp) :: part

    associate (data => self%cases(self%case_of(self%load_of(unit))))
      part = (mod(unit - 1, self%blocks) * self%points + point - 0.5_wp) / (self%blocks * self%points)
      frequency = data%frequency_from + part * (data%frequency_to - data%frequency_from)
    end associate
  end function frequency

  !> Number of values in a record: the unit, its points and its states.
  pure integer function record_length(self)
    class(frequency_sweep), intent(in) :: self
    record_length = 1 + self%points * (point_energy - 1 + self%max_contacts) + self%max_contacts * state_length()
  end function record_length

  pure integer function state_length()
    state_length = int(mslip_state_length(max_reversals))
  end function state_length

  subroutine solve(self, unit, record)
    class(frequency_sweep), intent(inout), target :: self
    integer, intent(in) :: unit
    real(wp), intent(out) :: record(:)
    type(balance_problem), pointer :: problem
    type(case_data), pointer :: data
    type(balance_point) :: point
    type(contact_history) :: history
    real(wp), allocatable :: displacement(:,:), largest(:,:), force(:)
    real(wp) :: row(point_energy - 1 + self%max_contacts, self%points), state(state_length(), self%max_contacts)
    real(wp) :: omega
    logical :: found
    integer :: load, contacts, i

    load = self%load_of(unit)
    data => self%cases(self%case_of(load))
    problem => self%problems(self%case_of(load))
    contacts = size(data%contacts)
    problem%contacts%prepared = self%contacts(:contacts, load)

    allocate (displacement(coefficient_count(data%harmonics), contacts), force(contacts))
    allocate (largest, mold=displacement)
    largest = 0.0_wp
    row = 0.0_wp
    found = .false.
    do i = 1, self%points
      omega = 2.0_wp * pi * self%frequency(unit, i)
      if (found) call solve_at(problem, omega, displacement, point, found)
      if (.not. found) call solve_from_rest(problem, omega, displacement, point, found)
      if (.not. found) cycle
      associate (motion => structure_response(problem, point))
        row(point_amplitude, i) = series_peak(motion(:, data%response_dof))
      end associate
      row(point_found, i) = 1.0_wp
      row(point_energy:point_energy + contacts - 1, i) = point%dissipated
      if (row(point_amplitude, i) >= maxval(row(point_amplitude, :))) largest = displacement
    end do

    ! A period that ends where the excitation is largest.
    call problem%contacts%start_history(cshift(matmul(series_basis(data%harmonics, data%samples), largest), 1), &
                                        history, force)
    state = 0.0_wp
    state(:, :contacts) = history%states
    record = [real(unit, wp), row, state]
  end subroutine solve

  !> `row` has for each point its amplitude, whether a balance was found, and the energy dissipated by each contact in a
  !> period; `state` has the states of the contacts at the point of largest amplitude.
  pure subroutine unpack(self, record, row, state)
    class(frequency_sweep), intent(in) :: self
    real(wp), intent(in) :: record(:)
    real(wp), allocatable, intent(out) :: row(:,:), state(:,:)

    allocate (row(point_energy - 1 + self%max_contacts, self%points), state(state_length(), self%max_contacts))
    row = reshape(record(2:size(row) + 1), shape(row))
    state = reshape(record(size(row) + 2:), shape(state))
  end subroutine unpack

  function description(self, unit) result(string)
    class(frequency_sweep), intent(in) :: self
    integer, intent(in) :: unit
    character(len=:), allocatable :: string
    integer :: load

    load = self%load_of(unit)
    string = trim(self%cases(self%case_of(load))%name)//', load factor '//text(self%load_factor(load), '(f10.2)')// &
             ', '//text(self%frequency(unit, 1), '(f10.2)')//' to '// &
             text(self%frequency(unit, self%points), '(f10.2)')//' Hz'
  end function description
end module sweep_units
