!> Resonance peaks of several cases at many normal forces on the ranks of MPI: the same bytes for any number of ranks.
!>
!>     mpirun -n RANKS response_sweep TABLE CASE...
!>
!> A unit is the response of one case at one load factor; unit i is solved by rank mod(i - 1, RANKS). Rank 0 initialises all
!> contacts, sends them as bytes, gathers the peaks and the states of the contacts there, and writes TABLE: for each unit
!> frequency and amplitude of the peak, and the largest shear traction of each contact in the instant of largest excitation.
program response_sweep
  use basics, only: argument, before_exit, csv, fail, open_table, pi, progress, text, wp
  use case_input, only: case_data, prepare_problem, read_case
  use continuation, only: find_peak
  use fourier_series, only: series_basis
  use friction_contacts, only: contact_history, law_microslip, max_reversals
  use harmonic_balance, only: balance_point, balance_problem
  use microslip
  use mpi_f08
  implicit none

  character(len=*), parameter :: usage = 'response_sweep TABLE CASE...'
  type(case_data), allocatable :: cases(:)
  type(balance_problem) :: problem
  type(mslip_contact), allocatable :: contacts(:,:)       !! (contact, unit)
  integer, allocatable :: case_of(:)                      !! of each unit
  real(wp), allocatable :: load_factor(:), own(:,:), gathered(:,:,:)
  real(wp) :: start
  integer(mslip_int) :: status
  integer :: rank, ranks, max_contacts, length, bytes, unit, i

  call MPI_Init()
  before_exit => abort_all
  call MPI_Comm_rank(MPI_COMM_WORLD, rank)
  call MPI_Comm_size(MPI_COMM_WORLD, ranks)
  start = MPI_Wtime()
  allocate (cases(max(command_argument_count() - 1, 1)), case_of(0), load_factor(0))
  do i = 1, size(cases)
    call read_case(trim(argument(i + 1, usage)), cases(i))
    if (any(cases(i)%contacts%law /= law_microslip)) call fail(trim(cases(i)%name)//': law must be microslip')
    load_factor = [load_factor, cases(i)%load_factors]
    case_of = [case_of, spread(i, 1, size(cases(i)%load_factors))]
  end do
  max_contacts = maxval([(size(cases(i)%contacts), i=1, size(cases))])

  ! A contact is plain data. Each is validated once where it arrives.
  allocate (contacts(max_contacts, size(case_of)))
  if (rank == 0) then
    do unit = 1, size(case_of)
      call prepare(unit)
      contacts(:size(problem%contacts%prepared), unit) = problem%contacts%prepared
    end do
  end if
  call MPI_Bcast(contacts, storage_size(contacts) / 8 * size(contacts), MPI_BYTE, 0, MPI_COMM_WORLD)

  length = 2 + max_contacts * int(mslip_state_length(max_reversals))
  allocate (own(length, (size(case_of) - 1) / ranks + 1), source=0.0_wp)
  do unit = rank + 1, size(case_of), ranks
    call solve_unit(own(:, (unit - 1) / ranks + 1))
  end do

  allocate (gathered(length, size(own, 2), ranks))
  bytes = 8 * size(own)
  call MPI_Gather(own, bytes, MPI_BYTE, gathered, bytes, MPI_BYTE, 0, MPI_COMM_WORLD)
  if (rank == 0) call write_table()
  call MPI_Finalize()

contains

  !> Not every launcher ends the other ranks if one has ended.
  subroutine abort_all()
    call MPI_Abort(MPI_COMM_WORLD, 1)
  end subroutine abort_all

  subroutine prepare(unit)
    integer, intent(in) :: unit

    associate (data => cases(case_of(unit)))
      call prepare_problem(data, load_factor(unit), data%harmonics, data%samples, problem)
    end associate
  end subroutine prepare

  !> Frequency and amplitude of the peak, then the states of the contacts there.
  subroutine solve_unit(record)
    real(wp), intent(out) :: record(:)
    type(balance_point) :: point
    type(contact_history) :: history
    real(wp), allocatable :: displacement(:,:), basis(:,:), force(:,:)
    real(wp) :: omega, peak
    integer :: i

    call prepare(unit)
    associate (data => cases(case_of(unit)), sent => contacts(:size(problem%contacts%prepared), unit))
      do i = 1, size(sent)
        call mslip_contact_check(sent(i), status)
        if (status /= MSLIP_OK) call fail('contact from rank 0: '//mslip_status_text(status))
      end do
      problem%contacts%prepared = sent
      call find_peak(problem, 2.0_wp * pi * [data%frequency_from, data%frequency_to], data%response_dof, omega, peak, &
                     displacement, point)
      ! A period that ends when the excitation is largest.
      allocate (force(data%samples, size(sent)))
      basis = cshift(series_basis(data%harmonics, data%samples), 1, dim=1)
      call problem%contacts%steady_cycle(matmul(basis, displacement), history, force)
      record = 0.0_wp
      record(:2) = [omega / (2.0_wp * pi), peak]
      record(3:2 + size(history%states)) = reshape(history%states, [size(history%states)])
    end associate
    call progress('rank '//text(rank)//': unit '//text(unit)//' of '//text(size(case_of)))
  end subroutine solve_unit

  subroutine write_table()
    integer, parameter :: positions = 201
    real(wp) :: x(positions), shear(positions), state(mslip_state_length(max_reversals)), max_shear(max_contacts)
    character(len=:), allocatable :: header
    integer :: table, contact, i

    header = 'case,load_factor,frequency_hz,amplitude_m'
    do contact = 1, max_contacts
      header = header//',shear_'//text(contact)//'_Pa'
    end do
    table = open_table(trim(argument(1, usage)), header)
    do unit = 1, size(case_of)
      associate (record => gathered(:, (unit - 1) / ranks + 1, mod(unit - 1, ranks) + 1))
        max_shear = 0.0_wp
        do contact = 1, size(cases(case_of(unit))%contacts)
          state = record(3 + (contact - 1) * size(state):2 + contact * size(state))
          x = contacts(contact, unit)%half_width * [(2.0_wp * i / (positions - 1) - 1.0_wp, i=0, positions - 1)]
          call mslip_state_check(state, status)
          if (status == MSLIP_OK) call mslip_masing_tractions(contacts(contact, unit), state, x, status, shear=shear)
          if (status /= MSLIP_OK) call fail('state of unit '//text(unit)//': '//mslip_status_text(status))
          max_shear(contact) = maxval(abs(shear))
        end do
        write (table, '(a)') trim(cases(case_of(unit))%name)//csv([load_factor(unit), record(:2), max_shear])
      end associate
    end do
    close (table)
    call progress(text(size(case_of))//' units, '//text(ranks)//' ranks: '//text(MPI_Wtime() - start, '(f8.2)')//' s')
  end subroutine write_table
end program response_sweep
