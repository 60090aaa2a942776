!> A case: a file of namelist groups, and the harmonic balance that it describes. A `!` starts a comment. An unknown group or
!> variable and a missing value are errors.
!>
!> Units are SI, frequencies in Hz, angles and phases in degrees. Paths are relative to the working directory. Defaults in brackets:
!>
!>   &model
!>     name: output files start with it
!>     matrices: the Matrix Market files ..._mass.mtx, ..._damping.mtx, ..._stiffness.mtx (coordinate real symmetric)
!>     driven_dof(:), amplitude(:), phase(:): force amplitude * cos(omega t + phase), N and degrees [phase 0]
!>     loaded_dof(:), static_force(:): static forces; the load factor multiplies them [none]
!>     response_dof: degree of freedom whose amplitude is reported
!>   &contact, one for each; a missing value is that of the contact before it
!>     name: in the columns of the results
!>     law: 'microslip', 'spring-slider' with the same initial stiffness and slip force, or 'element': varying normal force
!>     dof: relative displacement: first minus second; 0 is the ground. An element has four: x and y of the first body, x and
!>       y of the second
!>     angle: of an element: from x to the tangential direction; the normal, 90 degrees ahead, points into the second body
!>       [0]
!>     interference: of an element: approach of the undeformed structure; a gap is negative [0]
!>     count: number of identical contacts that share the displacement [1]
!>     load_varied: whether the load factor multiplies the normal force [.true.]
!>     flat_half_width, edge_radius, length, friction_coefficient, young_modulus(2), poisson_ratio(2): as in the library
!>     normal_force: an element takes the expected one, for its tables and for the springs of harmonic 0 only
!>     displacement_reference: 'rigid_strip', for machines, or 'centre_point', as in the paper
!>   &harmonic_balance
!>     harmonics, samples: highest harmonic, and samples of a period [5, 128]
!>     periods: of elements, before the period that is returned [3]
!>     tolerance: of the residual, relative to the displacement of each contact [1e-9]
!>   &sweep
!>     frequency_from, frequency_to: range of the continuation
!>     load_factors(:), excitation_factors(:): one response for each pair [1]
!>   &points
!>     frequency(:), excitation_factor(:): single frequencies [1]
!>   &time_integration, any number
!>     frequency, load_factor, excitation_factor: at which time integration is compared [factors 1]
!>     harmonics(:), samples: of the balances compared [samples 1024]
!>     steps_per_period: of Newmark's method [1024]
!>     max_periods, steady_tolerance: time integration ends when the remaining transient is below the tolerance, relative to
!>       the response [1000, 1e-5]
!>     allowed_difference: of the peaks by time integration and by the balance of the case; a larger one is an error [no
!>       limit]
module case_input
  use basics, only: fail, name_length, path_length, pi, wp
  use friction_contacts, only: friction_contact, law_element, law_microslip, law_slider
  use harmonic_balance, only: balance_problem
  use linear_structure, only: read_structure, structure
  use microslip, only: MSLIP_CENTRE_POINT, MSLIP_RIGID_STRIP
  implicit none
  private
  public :: read_case, prepare_problem

  integer, parameter :: max_list_size = 64
  real(wp), parameter :: unset = -huge(1.0_wp)             !! a variable that is not in the file

  !> A group &time_integration.
  type, public :: integration_input
    real(wp) :: frequency, load_factor, excitation_factor
    integer, allocatable :: harmonics(:)                   !! of the balances to compare with
    integer :: samples, steps_per_period, max_periods
    real(wp) :: steady_tolerance, allowed_difference
  end type integration_input

  type, public :: case_data
    character(len=name_length) :: name = ' '               !! output files start with it
    type(structure) :: model
    type(friction_contact), allocatable :: contacts(:)
    complex(wp), allocatable :: excitation(:)              !! F in Re(F exp(i omega t)), N
    real(wp), allocatable :: static_load(:)                !! N
    integer :: response_dof = 0, harmonics = 5, samples = 128, periods = 3
    real(wp) :: tolerance = 1.0e-9_wp
    real(wp) :: range(2) = 0.0_wp                                          !! angular frequencies of &sweep
    real(wp), allocatable :: load_factors(:), excitation_factors(:)        !! of &sweep; empty without the group
    real(wp), allocatable :: frequencies(:), point_factors(:)              !! Hz, and excitation factors, of &points; likewise
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
    call check_group_names()
    call read_model()
    call read_contacts()
    call read_harmonic_balance()
    call read_sweep()
    call read_points()
    call read_time_integration()
    close (unit)

  contains

    !> A misspelt group would otherwise be ignored.
    subroutine check_group_names()
      character(len=*), parameter :: known(*) = [character(len=16) :: 'model', 'contact', 'harmonic_balance', 'sweep', 'points', &
                                                 'time_integration']
      character(len=512) :: line

      do
        read (unit, '(a)', iostat=status) line
        if (status /= 0) exit
        if (line(1:1) == '&') call require(any(known == line(2:)), line(2:), 'unknown group')
      end do
    end subroutine check_group_names

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

    subroutine read_model()
      character(len=name_length) :: name
      character(len=path_length) :: matrices
      integer :: driven_dof(max_list_size), loaded_dof(max_list_size), response_dof, n, i
      real(wp), dimension(max_list_size) :: amplitude, phase, static_force
      namelist /model/ name, matrices, driven_dof, amplitude, phase, loaded_dof, static_force, response_dof

      name = ' '; matrices = ' '; driven_dof = 0; amplitude = 0.0_wp; phase = 0.0_wp; loaded_dof = 0; static_force = 0.0_wp
      response_dof = 0
      rewind (unit)
      read (unit, nml=model, iostat=status, iomsg=message)
      call require(found('model'), 'model', 'must be given')
      call read_structure(trim(matrices), data%model)
      n = size(data%model%mass, 1)
      call require(len_trim(name) > 0 .and. min(minval(driven_dof), minval(loaded_dof)) >= 0 .and. response_dof >= 1 .and. &
                   max(maxval(driven_dof), maxval(loaded_dof), response_dof) <= n, 'model', 'name or a degree of freedom is wrong')
      allocate (data%excitation(n), source=(0.0_wp, 0.0_wp))
      allocate (data%static_load(n), source=0.0_wp)
      do i = 1, max_list_size
        ! amplitude * cos(omega t + phase)
        if (driven_dof(i) > 0) data%excitation(driven_dof(i)) = amplitude(i) * exp(cmplx(0.0_wp, phase(i) * pi / 180.0_wp, wp))
        if (loaded_dof(i) > 0) data%static_load(loaded_dof(i)) = static_force(i)
      end do
      data%name = name
      data%response_dof = response_dof
    end subroutine read_model

    !> A variable that is not given keeps the value of the contact before. The library checks geometry, load and material.
    subroutine read_contacts()
      character(len=name_length) :: name, law, displacement_reference
      integer :: dof(4), count, n
      logical :: load_varied
      real(wp) :: angle, interference
      real(wp) :: flat_half_width, edge_radius, length, normal_force, friction_coefficient, young_modulus(2), poisson_ratio(2)
      type(friction_contact) :: c
      namelist /contact/ name, law, dof, angle, interference, count, load_varied, flat_half_width, edge_radius, length, &
        normal_force, friction_coefficient, young_modulus, poisson_ratio, displacement_reference

      law = ' '; displacement_reference = ' '; count = 1; load_varied = .true.; angle = 0.0_wp; interference = 0.0_wp
      flat_half_width = unset; edge_radius = unset; length = unset; normal_force = unset; friction_coefficient = unset
      young_modulus = unset; poisson_ratio = unset
      rewind (unit)
      allocate (data%contacts(0))
      do
        name = ' '
        dof = -1
        read (unit, nml=contact, iostat=status, iomsg=message)
        if (.not. found('contact')) exit
        n = findloc([dof, -1], -1, dim=1) - 1
        call require(any(law == [character(len=name_length) :: law_microslip, law_slider, law_element]), 'contact', &
                     'law must be "'//law_microslip//'", "'//law_slider//'" or "'//law_element//'"')
        call require(n == merge(4, 2, law == law_element) .and. all(dof(:n) >= 0) .and. &
                     all(dof <= size(data%model%mass, 1)) .and. count > 0 .and. len_trim(name) > 0, 'contact', &
                     'name, dof or count is wrong')
        call require(any(displacement_reference == [character(len=name_length) :: 'rigid_strip', 'centre_point']), 'contact', &
                     'displacement_reference must be "rigid_strip", for machines, or "centre_point", as in the paper')
        c%name = name; c%law = law; c%dof = dof; c%angle = angle; c%count = count
        c%interference = merge(interference, 0.0_wp, law == law_element)
        c%load_varied = load_varied
        associate (p => c%parameters)
          p%flat_half_width = flat_half_width; p%edge_radius = edge_radius; p%length = length; p%normal_force = normal_force
          p%friction_coefficient = friction_coefficient
          p%material%young_modulus = young_modulus
          p%material%poisson_ratio = poisson_ratio
          p%displacement_reference = merge(MSLIP_RIGID_STRIP, MSLIP_CENTRE_POINT, displacement_reference == 'rigid_strip')
        end associate
        data%contacts = [data%contacts, c]
      end do
      call require(size(data%contacts) > 0, 'contact', 'must be given')
    end subroutine read_contacts

    subroutine read_harmonic_balance()
      integer :: harmonics, samples, periods
      real(wp) :: tolerance
      namelist /harmonic_balance/ harmonics, samples, periods, tolerance

      harmonics = data%harmonics; samples = data%samples; periods = data%periods; tolerance = data%tolerance
      rewind (unit)
      read (unit, nml=harmonic_balance, iostat=status, iomsg=message)
      if (.not. found('harmonic_balance')) return
      call require(harmonics >= 1 .and. samples > 2 * harmonics .and. periods >= 1 .and. tolerance > 0.0_wp, 'harmonic_balance', &
                   'harmonics and periods must be 1 or more, samples above twice the harmonics')
      data%harmonics = harmonics; data%samples = samples; data%periods = periods; data%tolerance = tolerance
    end subroutine read_harmonic_balance

    subroutine read_sweep()
      real(wp) :: frequency_from, frequency_to, load_factors(max_list_size), excitation_factors(max_list_size)
      namelist /sweep/ frequency_from, frequency_to, load_factors, excitation_factors

      frequency_from = 0.0_wp; frequency_to = 0.0_wp; load_factors = unset; excitation_factors = unset
      allocate (data%load_factors(0), data%excitation_factors(0))
      rewind (unit)
      read (unit, nml=sweep, iostat=status, iomsg=message)
      if (.not. found('sweep')) return
      call require(frequency_from > 0.0_wp .and. frequency_to > frequency_from, 'sweep', 'frequencies must increase')
      data%range = 2.0_wp * pi * [frequency_from, frequency_to]
      data%load_factors = pack(load_factors, load_factors > unset)
      data%excitation_factors = pack(excitation_factors, excitation_factors > unset)
      if (size(data%load_factors) == 0) data%load_factors = 0.0_wp * data%excitation_factors + 1.0_wp
      if (size(data%excitation_factors) == 0) data%excitation_factors = 0.0_wp * data%load_factors + 1.0_wp
      call require(size(data%load_factors) == size(data%excitation_factors), 'sweep', 'factors differ in number')
    end subroutine read_sweep

    subroutine read_points()
      real(wp) :: frequency(max_list_size), excitation_factor(max_list_size)
      namelist /points/ frequency, excitation_factor

      frequency = unset; excitation_factor = 1.0_wp
      rewind (unit)
      read (unit, nml=points, iostat=status, iomsg=message)
      if (.not. found('points')) frequency = unset
      data%frequencies = pack(frequency, frequency > unset)
      data%point_factors = excitation_factor(:size(data%frequencies))
    end subroutine read_points

    subroutine read_time_integration()
      real(wp) :: frequency, load_factor, excitation_factor, steady_tolerance, allowed_difference
      integer :: harmonics(max_list_size), samples, steps_per_period, max_periods
      namelist /time_integration/ frequency, load_factor, excitation_factor, harmonics, samples, steps_per_period, max_periods, &
        steady_tolerance, allowed_difference

      allocate (data%integrations(0))
      rewind (unit)
      do
        frequency = unset; load_factor = 1.0_wp; excitation_factor = 1.0_wp; harmonics = 0; samples = 1024
        steps_per_period = 1024; max_periods = 1000; steady_tolerance = 1.0e-5_wp; allowed_difference = huge(1.0_wp)
        read (unit, nml=time_integration, iostat=status, iomsg=message)
        if (.not. found('time_integration')) exit
        call require(frequency > 0.0_wp .and. any(harmonics > 0) .and. samples > 2 * maxval(harmonics) .and. &
                     steps_per_period >= 16, 'time_integration', 'frequency, harmonics, samples or steps_per_period is wrong')
        data%integrations = [data%integrations, integration_input(frequency, load_factor, excitation_factor, &
          pack(harmonics, harmonics > 0), samples, steps_per_period, max_periods, steady_tolerance, allowed_difference)]
      end do
    end subroutine read_time_integration
  end subroutine read_case

  !> The load factor multiplies static loads and the normal forces of the contacts with `load_varied`.
  subroutine prepare_problem(data, load_factor, excitation_factor, harmonics, samples, problem)
    type(case_data), intent(in) :: data
    real(wp), intent(in) :: load_factor, excitation_factor
    integer, intent(in) :: harmonics, samples
    type(balance_problem), intent(out) :: problem

    problem%model = data%model
    problem%harmonics = harmonics
    problem%tolerance = data%tolerance
    problem%excitation = excitation_factor * data%excitation
    problem%static_load = load_factor * data%static_load
    call problem%contacts%prepare(data%contacts, load_factor, harmonics, samples, data%periods, size(data%excitation), &
                                  problem%incidence)
    allocate (problem%offset(problem%contacts%components), problem%springs(problem%contacts%components), source=0.0_wp)
    problem%offset(problem%contacts%items%last) = data%contacts%interference
    problem%springs(problem%contacts%items%last) = problem%contacts%items%normal_stiffness
  end subroutine prepare_problem
end module case_input
