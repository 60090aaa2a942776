!> Forced response of several cases at many loads and frequencies, shared by the ranks of MPI.
!>
!>     mpirun -n RANKS response_sweep DIRECTORY BLOCKS POINTS CASE...
!>
!> The range of frequencies of each case and load is cut into BLOCKS of POINTS. Written to DIRECTORY, the same for any
!> number of ranks:
!> * sweep.dat        the records of the units, written as they come. A run that finds the file solves what is missing.
!> * sweep.csv        amplitude of the response and energies at every frequency
!> * sweep_peaks.csv  for each case and load the largest amplitude, and of each contact there, in the instant of the largest
!>                    excitation, the largest shear traction
!>
!> Rank 0 prepares all contacts and sends them. It hands out the units, gathers their records, and solves units itself
!> while there is nothing to gather; so that nobody waits for it the others have their next unit before they finish one.
program response_sweep
  use, intrinsic :: iso_fortran_env, only: int64, output_unit
  use csv_output, only: csv_file
  use kinds, only: path_length, wp
  use messages, only: end_others, fail, progress, text
  use microslip, only: MSLIP_OK, mslip_contact_check, mslip_int, mslip_masing_tractions, mslip_state_check, mslip_status_text
  use mpi_f08
  use sweep_results, only: checksum, results_file
  use sweep_units, only: frequency_sweep, point_amplitude, point_energy, point_found, prepare_contacts, read_sweep
  implicit none

  integer, parameter :: no_unit = 0, units_ahead = 2
  character(len=path_length) :: directory
  character(len=path_length), allocatable :: case_files(:)
  type(frequency_sweep) :: sweep
  real(wp), allocatable :: record(:)
  integer :: rank, ranks, i
  ! Data of rank 0.
  type(results_file) :: results
  integer, allocatable :: missing(:)                     !! units that were not found in the file
  integer, allocatable :: in_work(:)                     !! units that each other rank has
  real(wp), allocatable, asynchronous :: arriving(:)
  type(MPI_Request) :: receipt
  integer :: handed_out = 0, finished = 0                !! of the missing units
  real(wp) :: start

  call MPI_Init()
  end_others => abort_all
  call MPI_Comm_rank(MPI_COMM_WORLD, rank)
  call MPI_Comm_size(MPI_COMM_WORLD, ranks)
  if (command_argument_count() < 4) call fail('usage: response_sweep DIRECTORY BLOCKS POINTS CASE...')
  call get_command_argument(1, directory)
  allocate (case_files(command_argument_count() - 3))
  do i = 1, size(case_files)
    call get_command_argument(i + 3, case_files(i))
  end do
  call read_sweep(case_files, positive_argument(2), positive_argument(3), sweep)
  allocate (record(sweep%record_length()))

  if (rank == 0) call prepare_contacts(sweep)
  call MPI_Bcast(sweep%contacts, storage_size(sweep%contacts) / 8 * size(sweep%contacts), MPI_BYTE, 0, MPI_COMM_WORLD)
  call check_contacts()
  if (rank == 0) then
    call lead()
  else
    call follow()
  end if
  call MPI_Finalize()

contains

  !> Contacts that come from another process are validated once.
  subroutine check_contacts()
    integer(mslip_int) :: status
    integer :: contact, load

    do load = 1, size(sweep%load_factor)
      do contact = 1, size(sweep%cases(sweep%case_of(load))%contacts)
        call mslip_contact_check(sweep%contacts(contact, load), status)
        if (status /= MSLIP_OK) call fail('contact from rank 0: '//mslip_status_text(status))
      end do
    end do
  end subroutine check_contacts

  !> Not every launcher ends the other ranks if one has ended.
  subroutine abort_all()
    call MPI_Abort(MPI_COMM_WORLD, 1)
  end subroutine abort_all

  integer function positive_argument(place) result(number)
    integer, intent(in) :: place
    character(len=path_length) :: argument
    integer :: status

    number = 0
    call get_command_argument(place, argument)
    read (argument, *, iostat=status) number
    if (status /= 0) number = 0
    if (number < 1) call fail('argument "'//trim(argument)//'": must be a number, 1 or more')
  end function positive_argument

  !> The record of one unit is on its way while the next is solved: MPI_Send might wait for rank 0.
  subroutine follow()
    real(wp), asynchronous :: leaving(size(record))
    type(MPI_Request) :: departure
    integer :: unit

    departure = MPI_REQUEST_NULL
    do
      call MPI_Recv(unit, 1, MPI_INTEGER, 0, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE)
      if (unit == no_unit) exit
      call sweep%solve(unit, record)
      call MPI_Wait(departure, MPI_STATUS_IGNORE)
      leaving = record
      call MPI_Isend(leaving, 8 * size(leaving), MPI_BYTE, 0, 0, MPI_COMM_WORLD, departure)
    end do
    call MPI_Wait(departure, MPI_STATUS_IGNORE)
  end subroutine follow

  subroutine lead()
    type(MPI_Status) :: message
    integer :: unit, other, pass
    logical :: found, arrived

    call results%open(trim(directory)//'/sweep.dat', sweep_key(), sweep%units(), size(record))
    allocate (missing(0))
    do unit = 1, sweep%units()
      call results%find(unit, record, found)
      if (.not. found) missing = [missing, unit]
    end do
    call progress(text(sweep%units())//' units, '//text(sweep%units() - size(missing))//' of them found, '// &
                  text(ranks)//' ranks')

    start = MPI_Wtime()
    allocate (in_work(ranks - 1), source=0)
    allocate (arriving, mold=record)
    do pass = 1, units_ahead
      do other = 1, ranks - 1
        if (handed_out < size(missing)) call hand_out(other)
      end do
    end do
    do other = 1, ranks - 1
      if (in_work(other) == 0) call dismiss(other)
    end do
    if (any(in_work > 0)) call expect()
    do
      do while (any(in_work > 0))
        if (handed_out < size(missing)) then
          call MPI_Test(receipt, arrived, message)
          if (.not. arrived) exit
        else
          call MPI_Wait(receipt, message)
        end if
        record = arriving
        other = message%MPI_SOURCE
        in_work(other) = in_work(other) - 1
        if (handed_out < size(missing)) then
          call hand_out(other)
        else if (in_work(other) == 0) then
          call dismiss(other)
        end if
        if (any(in_work > 0)) call expect()
        call keep(other)
      end do
      if (handed_out == size(missing)) exit
      handed_out = handed_out + 1
      call sweep%solve(missing(handed_out), record)
      call keep(0)
    end do
    call progress('solved in '//text(MPI_Wtime() - start, '(f10.2)')//' s')
    call write_tables()
    call results%close()
  end subroutine lead

  subroutine hand_out(other)
    integer, intent(in) :: other

    handed_out = handed_out + 1
    in_work(other) = in_work(other) + 1
    call MPI_Send(missing(handed_out), 1, MPI_INTEGER, other, 0, MPI_COMM_WORLD)
  end subroutine hand_out

  !> The record of the rank that finishes next.
  subroutine expect()
    call MPI_Irecv(arriving, 8 * size(arriving), MPI_BYTE, MPI_ANY_SOURCE, 0, MPI_COMM_WORLD, receipt)
  end subroutine expect

  subroutine dismiss(other)
    integer, intent(in) :: other
    call MPI_Send(no_unit, 1, MPI_INTEGER, other, 0, MPI_COMM_WORLD)
  end subroutine dismiss

  subroutine keep(source)
    integer, intent(in) :: source
    real(wp) :: seconds

    call results%keep(record)
    finished = finished + 1
    seconds = MPI_Wtime() - start
    call progress('unit '//text(finished)//'/'//text(size(missing))//': '//sweep%description(nint(record(1)))// &
                  ', rank '//text(source)//', '//text(seconds, '(f10.1)')//' s, '// &
                  text(seconds / finished * (size(missing) - finished), '(f10.1)')//' s left')
  end subroutine keep

  !> A checksum of all that the records depend on.
  integer(int64) function sweep_key() result(key)
    integer :: case

    key = checksum(0_int64, transfer(sweep%contacts, [0.0_wp]))
    do case = 1, size(sweep%cases)
      associate (data => sweep%cases(case))
        key = checksum(key, [data%model%mass, data%model%damping, data%model%stiffness])
        key = checksum(key, [data%excitation_amplitude, data%excitation_phase, data%tolerance, data%frequency_from, &
                             data%frequency_to, real([data%excited_dof, data%response_dof, data%harmonics, &
                                                      data%samples, sweep%blocks, sweep%points], wp)])
        key = checksum(key, real([(data%contacts(i)%dof, data%contacts(i)%count, i=1, size(data%contacts))], wp))
      end associate
    end do
  end function sweep_key

  subroutine write_tables()
    type(csv_file) :: table, peaks
    real(wp), allocatable :: row(:,:), state(:,:), peak_state(:,:)
    real(wp) :: peak_amplitude, peak_frequency
    logical :: found
    integer :: unit, point, contact, load, contacts

    peak_amplitude = -1.0_wp
    peak_frequency = 0.0_wp
    allocate (peak_state(0, 0))
    call table%open(trim(directory)//'/sweep.csv')
    call peaks%open(trim(directory)//'/sweep_peaks.csv')
    call table%add('case,load_factor,frequency_hz,amplitude_m,found')
    call peaks%add('case,load_factor,frequency_hz,amplitude_m')
    do contact = 1, sweep%max_contacts
      call table%add('dissipated_'//text(contact)//'_J')
      call peaks%add('shear_'//text(contact)//'_Pa')
    end do
    call table%end_row()
    call peaks%end_row()
    do unit = 1, sweep%units()
      call results%find(unit, record, found)
      if (.not. found) call fail('the record of unit '//text(unit)//' cannot be read back')
      call sweep%unpack(record, row, state)
      load = sweep%load_of(unit)
      associate (data => sweep%cases(sweep%case_of(load)))
        contacts = size(data%contacts)
        do point = 1, sweep%points
          call table%add(data%name)
          call table%add(sweep%load_factor(load))
          call table%add(sweep%frequency(unit, point))
          call table%add(row(point_amplitude, point))
          call table%add(nint(row(point_found, point)))
          call table%add(row(point_energy:, point))
          call table%end_row()
        end do
        point = maxloc(row(point_amplitude, :), dim=1)
        if (row(point_amplitude, point) > peak_amplitude) then
          peak_amplitude = row(point_amplitude, point)
          peak_frequency = sweep%frequency(unit, point)
          peak_state = state
        end if
        if (mod(unit, sweep%blocks) == 0) then
          call peaks%add(data%name)
          call peaks%add(sweep%load_factor(load))
          call peaks%add(peak_frequency)
          call peaks%add(peak_amplitude)
          call peaks%add([(max_shear(load, contact, peak_state(:, contact)), contact=1, contacts), &
                          (0.0_wp, contact=contacts + 1, sweep%max_contacts)])
          call peaks%end_row()
          peak_amplitude = -1.0_wp
        end if
      end associate
    end do
    call table%close()
    call peaks%close()
    call progress('wrote '//trim(directory)//'/sweep.csv and sweep_peaks.csv')
  end subroutine write_tables

  !> For a contact that rank 0 prepared, in a state that comes from a file, and perhaps from another rank before.
  real(wp) function max_shear(load, contact, state)
    integer, intent(in) :: load, contact
    real(wp), intent(in) :: state(:)
    integer, parameter :: positions = 201
    real(wp) :: x(positions), shear(positions)
    integer(mslip_int) :: status
    integer :: j

    x = sweep%contacts(contact, load)%half_width * [(2.0_wp * j / (positions - 1) - 1.0_wp, j=0, positions - 1)]
    call mslip_state_check(state, status)
    if (status == MSLIP_OK) call mslip_masing_tractions(sweep%contacts(contact, load), state, x, status, shear=shear)
    if (status /= MSLIP_OK) call fail('shear tractions: '//mslip_status_text(status))
    max_shear = maxval(abs(shear))
  end function max_shear
end program response_sweep
