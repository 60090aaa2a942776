!> A case: a file of namelist groups, and the harmonic balance that it describes. A `!` starts a comment. An unknown
!> variable and a missing value are errors.
!>
!> Units are SI, frequencies in Hz. Paths are relative to the working directory. Defaults in brackets:
!>
!>   &case
!>     name: output files start with it
!>     matrices: the Matrix Market files ..._mass.mtx, ..._damping.mtx, ..._stiffness.mtx (coordinate real symmetric)
!>     driven_dof(:), amplitude(:): force amplitude * cos(omega t), N; a negative amplitude is in opposite phase
!>     response_dof: degree of freedom whose amplitude is reported
!>     harmonics, samples: of the balance: highest harmonic, and samples of a period [5, 128]
!>     tolerance: of the residual, relative to the displacement of each contact [1e-9]
!>     frequency_from, frequency_to, load_factors(:): range of the continuation, and one response for each factor [none]
!>     frequency(:): single frequencies [none]
!>   &contact, one for each; a missing value is that of the contact before it
!>     name: in the columns of the results
!>     law: 'microslip', or 'spring-slider' with the same initial stiffness and slip force
!>     dof(2): relative displacement: first minus second; 0 is the ground
!>     count: number of identical contacts that share the displacement [1]
!>     load_varied: whether the load factor multiplies the normal force [.true.]
!>     p: mslip_parameters, of which the displacement reference is the rigid strip
!>   &time_integration, any number
!>     frequency, load_factor: at which time integration is compared [load_factor 1]
!>     harmonics(:), samples: of the balances compared [samples 1024]
!>     steps_per_period: of Newmark's method [1024]
!>     steady_tolerance: time integration ends when the remaining transient is below it, relative to the response [1e-5]
!>     allowed_difference: of the peaks by time integration and by the last balance; a larger one is an error [no limit]
module case_input
  use basics, only: fail, name_length, path_length, pi, wp
  use friction_contacts, only: friction_contact, law_microslip, law_slider
  use harmonic_balance, only: balance_problem
  use linear_structure, only: read_structure, structure
  use microslip, only: mslip_parameters, mslip_parameters_default, MSLIP_RIGID_STRIP
  implicit none
  private
  public :: read_case, prepare_problem

  integer, parameter :: max_list_size = 64
  real(wp), parameter :: unset = -huge(1.0_wp)             !! a variable that is not in the file

  !> A group &time_integration.
  type, public :: integration_input
    real(wp) :: frequency, load_factor
    integer, allocatable :: harmonics(:)                   !! of the balances to compare with
    integer :: samples, steps_per_period
    real(wp) :: steady_tolerance, allowed_difference
  end type integration_input

  type, public :: case_data
    character(len=name_length) :: name = ' '               !! output files start with it
    type(structure) :: model
    type(friction_contact), allocatable :: contacts(:)
    real(wp), allocatable :: excitation(:)                 !! F in F cos(omega t), N
    integer :: response_dof = 0, harmonics = 0, samples = 0
    real(wp) :: tolerance = 0.0_wp
    real(wp) :: range(2) = 0.0_wp                          !! angular frequencies of the continuation
    real(wp), allocatable :: load_factors(:)
    real(wp), allocatable :: frequencies(:)                !! Hz, single ones
    type(integration_input), allocatable :: integrations(:)
  end type case_data

contains

  subroutine read_case(path, data)
    character(len=*), intent(in) :: path
    type(case_data), intent(out) :: data
    character(len=512) :: message
    integer :: unit, status

    open (newunit=unit, file=path, status='old', action='read', iostat=status, iomsg=message)
    if (status /= 0) call fail(trim(path)//': cannot be opened: '//trim(message))
    call read_balance()
    call read_contacts()
    call read_time_integration()
    close (unit)

  contains

    subroutine require(condition, group, problem)
      logical, intent(in) :: condition
      character(len=*), intent(in) :: group, problem

      if (.not. condition) call fail(trim(path)//', group &'//trim(group)//': '//trim(problem))
    end subroutine require

    !> Whether the status of a read statement is that of a group and not of the end of the file.
    logical function found(group)
      character(len=*), intent(in) :: group

      found = .not. is_iostat_end(status)
      call require(status == 0 .or. .not. found, group, message)
    end function found

    subroutine read_balance()
      character(len=name_length) :: name
      character(len=path_length) :: matrices
      integer :: driven_dof(max_list_size), response_dof, harmonics, samples, n
      real(wp) :: tolerance, frequency_from, frequency_to
      real(wp), dimension(max_list_size) :: amplitude, load_factors, frequency
      namelist /case/ name, matrices, driven_dof, amplitude, response_dof, harmonics, samples, tolerance, frequency_from, &
        frequency_to, load_factors, frequency

      name = ' '; matrices = ' '; driven_dof = 0; amplitude = 0.0_wp; response_dof = 0
      harmonics = 5; samples = 128; tolerance = 1.0e-9_wp
      frequency_from = 0.0_wp; frequency_to = 0.0_wp; load_factors = unset; frequency = unset
      read (unit, nml=case, iostat=status, iomsg=message)
      call require(found('case'), 'case', 'must be given')
      call read_structure(trim(matrices), data%model)
      n = size(data%model%mass, 1)
      call require(len_trim(name) > 0 .and. minval(driven_dof) >= 0 .and. response_dof >= 1 .and. &
                   max(maxval(driven_dof), response_dof) <= n, 'case', 'name or a degree of freedom is wrong')
      call require(harmonics >= 1 .and. samples > 2 * harmonics .and. tolerance > 0.0_wp, 'case', &
                   'harmonics must be 1 or more, samples above twice the harmonics')
      allocate (data%excitation(n), source=0.0_wp)
      data%excitation(pack(driven_dof, driven_dof > 0)) = pack(amplitude, driven_dof > 0)
      data%name = name; data%response_dof = response_dof
      data%harmonics = harmonics; data%samples = samples; data%tolerance = tolerance
      data%range = 2.0_wp * pi * [frequency_from, frequency_to]
      data%load_factors = pack(load_factors, load_factors > unset)
      data%frequencies = pack(frequency, frequency > unset)
      call require(size(data%load_factors) == 0 .or. (frequency_from > 0.0_wp .and. frequency_to > frequency_from), 'case', &
                   'frequencies must increase')
    end subroutine read_balance

    !> A variable that is not given keeps the value of the contact before. The library checks geometry, load and material.
    subroutine read_contacts()
      character(len=name_length) :: name, law
      integer :: dof(2), count
      logical :: load_varied
      type(mslip_parameters) :: p
      type(friction_contact) :: c
      namelist /contact/ name, law, dof, count, load_varied, p

      law = ' '; count = 1; load_varied = .true.
      call mslip_parameters_default(p)
      p%displacement_reference = MSLIP_RIGID_STRIP
      rewind (unit)
      allocate (data%contacts(0))
      do
        name = ' '
        dof = -1
        read (unit, nml=contact, iostat=status, iomsg=message)
        if (.not. found('contact')) exit
        call require(any(law == [character(len=name_length) :: law_microslip, law_slider]), 'contact', &
                     'law must be "'//law_microslip//'" or "'//law_slider//'"')
        call require(all(dof >= 0) .and. all(dof <= size(data%model%mass, 1)) .and. count > 0 .and. len_trim(name) > 0, 'contact', &
                     'name, dof or count is wrong')
        c%name = name; c%law = law; c%dof = dof; c%count = count; c%load_varied = load_varied; c%parameters = p
        data%contacts = [data%contacts, c]
      end do
      call require(size(data%contacts) > 0, 'contact', 'must be given')
    end subroutine read_contacts

    subroutine read_time_integration()
      real(wp) :: frequency, load_factor, steady_tolerance, allowed_difference
      integer :: harmonics(max_list_size), samples, steps_per_period
      namelist /time_integration/ frequency, load_factor, harmonics, samples, steps_per_period, steady_tolerance, allowed_difference

      allocate (data%integrations(0))
      rewind (unit)
      do
        frequency = unset; load_factor = 1.0_wp; harmonics = 0; samples = 1024
        steps_per_period = 1024; steady_tolerance = 1.0e-5_wp; allowed_difference = huge(1.0_wp)
        read (unit, nml=time_integration, iostat=status, iomsg=message)
        if (.not. found('time_integration')) exit
        call require(frequency > 0.0_wp .and. any(harmonics > 0) .and. samples > 2 * maxval(harmonics) .and. &
                     steps_per_period >= 16, 'time_integration', 'frequency, harmonics, samples or steps_per_period is wrong')
        data%integrations = [data%integrations, integration_input(frequency, load_factor, pack(harmonics, harmonics > 0), samples, &
                                                                  steps_per_period, steady_tolerance, allowed_difference)]
      end do
    end subroutine read_time_integration
  end subroutine read_case

  !> The load factor multiplies the normal forces of the contacts with `load_varied`.
  subroutine prepare_problem(data, load_factor, harmonics, samples, problem)
    type(case_data), intent(in) :: data
    real(wp), intent(in) :: load_factor
    integer, intent(in) :: harmonics, samples
    type(balance_problem), intent(out) :: problem
    integer :: i

    problem%model = data%model
    problem%harmonics = harmonics
    problem%tolerance = data%tolerance
    problem%excitation = data%excitation
    call problem%contacts%prepare(data%contacts, load_factor, harmonics, samples)
    allocate (problem%incidence(size(data%excitation), size(data%contacts)), source=0.0_wp)
    do i = 1, size(data%contacts)
      associate (dof => data%contacts(i)%dof)
        if (dof(1) > 0) problem%incidence(dof(1), i) = 1.0_wp
        if (dof(2) > 0) problem%incidence(dof(2), i) = -1.0_wp
      end associate
    end do
  end subroutine prepare_problem
end module case_input
