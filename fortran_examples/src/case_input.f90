!> A case: a file of namelist groups (cases/README.md), and the harmonic balance that it describes.
module case_input
  use basics, only: fail, name_length, path_length, pi, text, wp
  use friction_contacts, only: add_incidence, contact_input, law_element, law_microslip, law_slider, with_friction, with_spring, &
    without_force
  use harmonic_balance, only: balance_problem
  use linear_structure, only: read_structure, structure
  use microslip, only: MSLIP_CENTRE_POINT, MSLIP_RIGID_STRIP, mslip_layer, mslip_parameters
  implicit none
  private
  public :: read_case, prepare_problem

  integer, parameter :: max_list_size = 64
  real(wp), parameter :: unset = -huge(1.0_wp)             !! a variable that is not in the file

  !> A group &time_integration.
  type, public :: integration_input
    real(wp), allocatable :: frequencies(:)                !! Hz
    integer, allocatable :: harmonics(:), samples(:)       !! of the balances to compare with
    real(wp) :: load_factor = 1.0_wp, excitation_factor = 1.0_wp
    real(wp) :: steady_tolerance = 1.0e-5_wp, allowed_difference = huge(1.0_wp)
    integer :: steps_per_period = 1024, max_periods = 1000
  end type integration_input

  type, public :: case_data
    character(len=name_length) :: name = ' '               !! output files start with it
    type(structure) :: model
    type(contact_input), allocatable :: contacts(:)
    integer, allocatable :: excited_dof(:)
    real(wp), allocatable :: excitation_amplitude(:), excitation_phase(:)   !! N, degrees
    integer :: response_dof = 0
    integer, allocatable :: loaded_dof(:)                                   !! static loads; empty without the group &static_load
    real(wp), allocatable :: static_load(:)                                 !! N
    integer :: harmonics = 5, samples = 128, periods = 3
    real(wp) :: tolerance = 1.0e-9_wp
    real(wp) :: frequency_from = 0.0_wp, frequency_to = 0.0_wp             !! Hz, of &sweep
    real(wp), allocatable :: load_factors(:), excitation_factors(:)        !! of &sweep; empty without the group
    real(wp), allocatable :: frequencies(:)                                !! Hz, of &points; empty without the group
    real(wp) :: point_load_factor = 1.0_wp
    real(wp), allocatable :: point_excitation_factors(:)
    type(integration_input), allocatable :: integrations(:)
  end type case_data

contains

  subroutine read_case(path, data)
    character(len=*), intent(in) :: path
    type(case_data), intent(out) :: data
    character(len=512) :: message
    character(len=name_length) :: group
    integer :: unit, status

    open (newunit=unit, file=path, status='old', action='read', iostat=status, iomsg=message)
    if (status /= 0) call fail(trim(path)//': cannot be opened: '//trim(message))
    call check_group_names()
    call read_output()
    call read_model()
    call read_excitation()
    call read_static_load()
    call read_contacts()
    call read_harmonic_balance()
    call read_sweep()
    call read_points()
    call read_time_integration()
    close (unit)

  contains

    !> A misspelt group, or a last one without its end, would otherwise be ignored.
    subroutine check_group_names()
      character(len=*), parameter :: known = &
        ' output model excitation static_load contact harmonic_balance sweep points time_integration '
      character(len=512) :: line
      logical :: open
      integer :: first

      open = .false.
      do
        read (unit, '(a)', iostat=status) line
        if (status /= 0) exit
        if (adjustl(line) == '/') open = .false.
        first = index(line, '&')
        if (first == 0 .or. len_trim(line(:max(first, 1) - 1)) > 0) cycle
        group = line(first + 1:first + scan(line(first + 1:)//' ', ' /,!') - 1)
        call require(index(known, ' '//trim(group)//' ') > 0, 'unknown; known are'//known)
        open = .true.
      end do
      call require(.not. open, 'a line "/" must end it')
    end subroutine check_group_names

    subroutine require(condition, problem)
      logical, intent(in) :: condition
      character(len=*), intent(in) :: problem

      if (.not. condition) call fail(trim(path)//', group &'//trim(group)//': '//problem)
    end subroutine require

    !> Whether `status` of a read statement is that of a group; the end of the file is an error for a required group.
    logical function found(required)
      logical, intent(in) :: required

      found = .not. is_iostat_end(status)
      call require(status == 0 .or. (.not. found .and. .not. required), trim(message))
    end function found

    subroutine start(name)
      character(len=*), intent(in) :: name

      group = name
      rewind (unit)
    end subroutine start

    subroutine read_output()
      character(len=name_length) :: name
      namelist /output/ name

      name = ' '
      call start('output')
      read (unit, nml=output, iostat=status, iomsg=message)
      if (found(.true.)) call require(len_trim(name) > 0 .and. scan(trim(name), ' /') == 0, 'name must be a word without "/"')
      data%name = name
    end subroutine read_output

    subroutine read_model()
      character(len=path_length) :: mass, damping, stiffness, dof_map
      namelist /model/ mass, damping, stiffness, dof_map

      mass = ' '
      damping = ' '
      stiffness = ' '
      dof_map = ' '
      call start('model')
      read (unit, nml=model, iostat=status, iomsg=message)
      if (found(.true.)) call read_structure(mass, damping, stiffness, dof_map, data%model)
    end subroutine read_model

    subroutine read_excitation()
      integer :: dof(max_list_size), response_dof, n
      real(wp) :: amplitude(max_list_size), phase(max_list_size)
      namelist /excitation/ dof, amplitude, phase, response_dof

      dof = -1
      amplitude = unset
      phase = 0.0_wp
      response_dof = -1
      call start('excitation')
      read (unit, nml=excitation, iostat=status, iomsg=message)
      n = count(dof /= -1)
      if (found(.true.)) call require(n > 0 .and. all(amplitude(:n) > unset), 'dof and amplitude must be given')
      call check_dof([dof(:n), response_dof], 1)
      data%excited_dof = dof(:n)
      data%excitation_amplitude = amplitude(:n)
      data%excitation_phase = phase(:n)
      data%response_dof = response_dof
    end subroutine read_excitation

    subroutine read_static_load()
      integer :: dof(max_list_size), n
      real(wp) :: force(max_list_size)
      namelist /static_load/ dof, force

      dof = -1
      force = unset
      call start('static_load')
      read (unit, nml=static_load, iostat=status, iomsg=message)
      n = 0
      if (found(.false.)) then
        n = count(dof /= -1)
        call require(n > 0 .and. all(force(:n) > unset), 'dof and force must be given')
        call check_dof(dof(:n), 1)
      end if
      data%loaded_dof = dof(:n)
      data%static_load = force(:n)
    end subroutine read_static_load

    !> A variable that is not given keeps the value of the contact before. The library checks geometry, load and material.
    subroutine read_contacts()
      character(len=name_length) :: name, law, second_direction, displacement_reference
      integer :: dof(6), count
      logical :: load_varied
      integer :: m
      real(wp) :: angle, interference
      real(wp) :: flat_half_width, edge_radius, length, normal_force, friction_coefficient, young_modulus(2), poisson_ratio(2)
      real(wp) :: normal_compliance, tangential_compliance, stiffening_load, reference_load
      character(len=path_length) :: parameter_file
      type(contact_input) :: c
      namelist /contact/ name, law, dof, second_direction, angle, interference, count, load_varied, parameter_file, &
        flat_half_width, edge_radius, length, normal_force, friction_coefficient, young_modulus, poisson_ratio, &
        displacement_reference, normal_compliance, tangential_compliance, stiffening_load, reference_load

      law = ' '
      second_direction = with_friction
      displacement_reference = ' '
      count = 1
      load_varied = .true.
      angle = 0.0_wp
      interference = 0.0_wp
      flat_half_width = unset
      edge_radius = unset
      length = unset
      normal_force = unset
      friction_coefficient = unset
      young_modulus = unset
      poisson_ratio = unset
      normal_compliance = 0.0_wp
      tangential_compliance = 0.0_wp
      stiffening_load = 0.0_wp
      reference_load = 0.0_wp
      parameter_file = ' '
      call start('contact')
      allocate (data%contacts(0))
      do
        name = ' '
        dof = -1
        read (unit, nml=contact, iostat=status, iomsg=message)
        if (.not. found(size(data%contacts) == 0)) exit
        call require(len_trim(name) > 0 .and. all(data%contacts%name /= name), 'name must be given, another for each contact')
        call require(any(law == [character(len=name_length) :: law_microslip, law_slider, law_element]), &
                     'law must be "'//law_microslip//'", "'//law_slider//'" or "'//law_element//'"')
        call require(any(displacement_reference == [character(len=name_length) :: 'rigid_strip', 'centre_point']) .or. &
                     len_trim(parameter_file) > 0, &
                     'displacement_reference must be "rigid_strip", for machines, or "centre_point", as in the paper')
        if (dof(3) == -1) then
          call check_dof(dof(:2), 0)
          call require(dof(1) /= dof(2), 'dof must be two different degrees of freedom; 0 is the ground')
          call require(law /= law_element .and. abs(interference) <= 0.0_wp, 'an element has four or six degrees of freedom')
        else
          m = merge(2, 3, dof(5) == -1)
          call check_dof(dof(:2*m), 0)
          call require(any(dof(:m) /= dof(m+1:2*m)), 'the two bodies must not be the same')
        end if
        call require(any(second_direction == [character(len=name_length) :: with_friction, with_spring, without_force]), &
                     'second_direction must be "'//with_friction//'", "'//with_spring//'" or "'//without_force//'"')
        call require(dof(5) == -1 .or. law == law_element .or. second_direction /= with_friction, &
                     'only an element has friction in a second direction')
        call require(count > 0, 'count must be 1 or more')
        c = contact_input(name, law, dof, angle, interference, second_direction, count, load_varied)
        c%parameters%flat_half_width = flat_half_width
        c%parameters%edge_radius = edge_radius
        c%parameters%length = length
        c%parameters%normal_force = normal_force
        c%parameters%friction_coefficient = friction_coefficient
        c%parameters%material%young_modulus = young_modulus
        c%parameters%material%poisson_ratio = poisson_ratio
        c%parameters%displacement_reference = merge(MSLIP_RIGID_STRIP, MSLIP_CENTRE_POINT, &
                                                    displacement_reference == 'rigid_strip')
        c%parameters%layer = mslip_layer(normal_compliance, tangential_compliance, stiffening_load, reference_load)
        if (len_trim(parameter_file) > 0) call read_parameter_file(parameter_file, c%parameters)
        data%contacts = [data%contacts, c]
      end do
    end subroutine read_contacts

    subroutine read_harmonic_balance()
      integer :: harmonics, samples, periods
      real(wp) :: tolerance
      namelist /harmonic_balance/ harmonics, samples, periods, tolerance

      harmonics = data%harmonics
      samples = data%samples
      periods = data%periods
      tolerance = data%tolerance
      call start('harmonic_balance')
      read (unit, nml=harmonic_balance, iostat=status, iomsg=message)
      if (.not. found(.false.)) return
      call require(harmonics >= 1 .and. samples > 2 * harmonics, 'harmonics must be 1 or more, samples above twice that')
      call require(periods >= 1, 'periods must be 1 or more')
      call require(tolerance >= 1.0e-13_wp .and. tolerance <= 1.0e-3_wp, 'tolerance must be from 1e-13 to 1e-3')
      data%harmonics = harmonics
      data%samples = samples
      data%periods = periods
      data%tolerance = tolerance
    end subroutine read_harmonic_balance

    subroutine read_sweep()
      real(wp) :: frequency_from, frequency_to, load_factors(max_list_size), excitation_factors(max_list_size)
      namelist /sweep/ frequency_from, frequency_to, load_factors, excitation_factors

      frequency_from = unset
      frequency_to = unset
      load_factors = unset
      load_factors(1) = 1.0_wp
      excitation_factors = unset
      excitation_factors(1) = 1.0_wp
      call start('sweep')
      allocate (data%load_factors(0), data%excitation_factors(0))
      read (unit, nml=sweep, iostat=status, iomsg=message)
      if (.not. found(.false.)) return
      call require(frequency_from > 0.0_wp .and. frequency_to > frequency_from, '0 < frequency_from < frequency_to is required')
      data%frequency_from = frequency_from
      data%frequency_to = frequency_to
      data%load_factors = positive('load_factors', load_factors)
      data%excitation_factors = positive('excitation_factors', excitation_factors)
      if (size(data%load_factors) == 1) data%load_factors = spread(data%load_factors(1), 1, size(data%excitation_factors))
      if (size(data%excitation_factors) == 1) data%excitation_factors = spread(data%excitation_factors(1), 1, &
                                                                               size(data%load_factors))
      call require(size(data%load_factors) == size(data%excitation_factors), 'load_factors and excitation_factors differ in number')
    end subroutine read_sweep

    subroutine read_points()
      real(wp) :: frequency(max_list_size), load_factor, excitation_factor(max_list_size)
      namelist /points/ frequency, load_factor, excitation_factor

      frequency = unset
      load_factor = 1.0_wp
      excitation_factor = unset
      excitation_factor(1) = 1.0_wp
      call start('points')
      allocate (data%frequencies(0), data%point_excitation_factors(0))
      read (unit, nml=points, iostat=status, iomsg=message)
      if (.not. found(.false.)) return
      data%frequencies = positive('frequency', frequency)
      data%point_load_factor = load_factor
      data%point_excitation_factors = positive('excitation_factor', excitation_factor)
      associate (n => size(data%frequencies))
        if (size(data%point_excitation_factors) == 1) data%point_excitation_factors = spread(excitation_factor(1), 1, n)
        call require(load_factor > 0.0_wp .and. size(data%point_excitation_factors) == n, &
                     'load_factor must be positive, excitation_factor one or as many as the frequencies')
      end associate
    end subroutine read_points

    subroutine read_time_integration()
      type(integration_input) :: defaults, group_data
      real(wp) :: frequency(max_list_size), load_factor, excitation_factor, steady_tolerance, allowed_difference
      integer :: harmonics(max_list_size), samples(max_list_size), steps_per_period, max_periods
      namelist /time_integration/ frequency, load_factor, excitation_factor, harmonics, samples, steps_per_period, max_periods, &
        steady_tolerance, allowed_difference

      call start('time_integration')
      allocate (data%integrations(0))
      do
        frequency = unset
        harmonics = 0
        load_factor = defaults%load_factor
        excitation_factor = defaults%excitation_factor
        samples = 0
        samples(1) = 1024
        steps_per_period = defaults%steps_per_period
        max_periods = defaults%max_periods
        steady_tolerance = defaults%steady_tolerance
        allowed_difference = defaults%allowed_difference
        read (unit, nml=time_integration, iostat=status, iomsg=message)
        if (.not. found(.false.)) exit
        if (samples(2) == 0) samples = samples(1)
        call require(any(harmonics > 0) .and. all(harmonics >= 0) .and. all(samples > 2 * harmonics .or. harmonics == 0), &
                     'harmonics must be 1 or more, samples above twice that')
        call require(steps_per_period >= 16 .and. max_periods >= 2, 'steps_per_period >= 16 and max_periods >= 2 are required')
        call require(min(load_factor, excitation_factor, steady_tolerance, allowed_difference) > 0.0_wp, &
                     'a factor or tolerance is not positive')
        group_data = integration_input(positive('frequency', frequency), pack(harmonics, harmonics > 0), &
                                       pack(samples, harmonics > 0), load_factor, excitation_factor, steady_tolerance, &
                                       allowed_difference, steps_per_period, max_periods)
        data%integrations = [data%integrations, group_data]
      end do
    end subroutine read_time_integration

    function positive(variable, list) result(given)
      character(len=*), intent(in) :: variable
      real(wp), intent(in) :: list(:)
      real(wp), allocatable :: given(:)

      given = pack(list, list > unset)
      call require(size(given) > 0 .and. all(given > 0.0_wp), variable//' must list values > 0')
    end function positive

    subroutine check_dof(dof, lowest)
      integer, intent(in) :: dof(:), lowest

      call require(all(dof >= lowest .and. dof <= size(data%model%dof_name)), &
                   'a degree of freedom is not within '//text(lowest)//' .. '//text(size(data%model%dof_name)))
    end subroutine check_dof
  end subroutine read_case

  !> The load factor multiplies static loads and the normal forces of the contacts with `load_varied`.
  subroutine prepare_problem(data, load_factor, harmonics, samples, problem, excitation_factor)
    type(case_data), intent(in) :: data
    real(wp), intent(in) :: load_factor
    integer, intent(in) :: harmonics, samples
    type(balance_problem), intent(out) :: problem
    real(wp), intent(in), optional :: excitation_factor
    real(wp) :: phase
    integer :: i, dofs

    dofs = size(data%model%dof_name)
    problem%model = data%model
    problem%harmonics = harmonics
    problem%tolerance = data%tolerance
    call problem%contacts%prepare(data%contacts, load_factor, harmonics, samples, data%periods)
    associate (first => problem%contacts%first, last => problem%contacts%last)
      allocate (problem%incidence(dofs, maxval(last)), source=0.0_wp)
      do i = 1, size(data%contacts)
        call add_incidence(data%contacts(i), problem%incidence(:, first(i):last(i)))
      end do
    end associate
    allocate (problem%excitation(dofs), source=(0.0_wp, 0.0_wp))
    do i = 1, size(data%excited_dof)
      associate (force => problem%excitation(data%excited_dof(i)))
        ! amplitude * cos(omega t + phase)
        phase = data%excitation_phase(i) * pi / 180.0_wp
        force = force + data%excitation_amplitude(i) * cmplx(cos(phase), sin(phase), wp)
      end associate
    end do
    if (present(excitation_factor)) problem%excitation = excitation_factor * problem%excitation
    allocate (problem%static_load(dofs), source=0.0_wp)
    do i = 1, size(data%loaded_dof)
      associate (force => problem%static_load(data%loaded_dof(i)))
        force = force + load_factor * data%static_load(i)
      end associate
    end do
  end subroutine prepare_problem

  !> The parameters of a parameter file of the command line, such as `microslip fit --fitted` writes: lines `key = value` and tables
  !> [[material]], one of both bodies or one of each. Other forms of TOML are errors.
  subroutine read_parameter_file(path, parameters)
    character(len=*), intent(in) :: path
    type(mslip_parameters), intent(out) :: parameters
    character(len=512) :: line
    integer :: unit, status, equals, bodies

    open (newunit=unit, file=path, status='old', action='read', iostat=status)
    if (status /= 0) call fail(trim(path)//': cannot be opened')
    bodies = 0
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      line = adjustl(line(:index(line//'#', '#') - 1))
      equals = index(line, '=')
      if (line == '[[material]]') then
        bodies = bodies + 1
        if (bodies > 2) call fail(trim(path)//': more than two tables [[material]]')
      else if (len_trim(line) > 0) then
        if (equals == 0) call fail(trim(path)//': not a line "key = value": '//trim(line))
        call set(trim(line(:equals - 1)), trim(adjustl(line(equals + 1:))))
      end if
    end do
    close (unit)
    if (bodies == 1) parameters%material(2) = parameters%material(1)

  contains

    subroutine set(key, value)
      character(len=*), intent(in) :: key, value
      real(wp) :: number

      number = 0.0_wp
      read (value, *, iostat=status) number
      select case (key)
      case ('flat_half_width'); parameters%flat_half_width = number
      case ('edge_radius'); parameters%edge_radius = number
      case ('length'); parameters%length = number
      case ('normal_force'); parameters%normal_force = number
      case ('friction_coefficient'); parameters%friction_coefficient = number
      case ('normal_compliance'); parameters%layer%normal_compliance = number
      case ('tangential_compliance'); parameters%layer%tangential_compliance = number
      case ('stiffening_load'); parameters%layer%stiffening_load = number
      case ('reference_load'); parameters%layer%reference_load = number
      case ('young_modulus'); parameters%material(max(bodies, 1))%young_modulus = number
      case ('poisson_ratio'); parameters%material(max(bodies, 1))%poisson_ratio = number
      case ('displacement_reference')
        parameters%displacement_reference = merge(MSLIP_RIGID_STRIP, MSLIP_CENTRE_POINT, value == '"rigid_strip"')
        status = merge(0, 1, any(value == [character(len=14) :: '"rigid_strip"', '"centre_point"']))
      case ('units'); status = merge(0, 1, value == '"si"')
      case default; status = 1
      end select
      if (status /= 0) call fail(trim(path)//': '//key//' = '//value//' is not possible here')
    end subroutine set
  end subroutine read_parameter_file

end module case_input
