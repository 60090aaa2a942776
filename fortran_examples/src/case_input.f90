!> A case: a file of namelist groups. Every group and variable is described in cases/README.md.
module case_input
  use friction_contacts, only: contact_input, law_microslip, law_slider
  use kinds, only: name_length, path_length, wp
  use linear_structure, only: read_structure, structure
  use messages, only: fail, text
  use microslip, only: MSLIP_CENTRE_POINT, MSLIP_RIGID_STRIP, mslip_parameters_default
  implicit none
  private
  public :: read_case

  integer, parameter, public :: max_list_size = 64
  ! What a variable holds that a case has not set; below the range of every variable.
  real(wp), parameter :: unset = -huge(1.0_wp)

  type, public :: case_data
    character(len=path_length) :: file = ' '
    character(len=name_length) :: name = ' '               !! of the case; output files start with it
    type(structure) :: model
    type(contact_input), allocatable :: contacts(:)
    real(wp), allocatable :: load_factors(:)
    integer, allocatable :: excited_dof(:)
    real(wp), allocatable :: excitation_amplitude(:), excitation_phase(:)   !! N, degrees
    integer :: response_dof = 0
    integer :: harmonics = 0, samples = 0
    real(wp) :: tolerance = 0.0_wp
    real(wp) :: frequency_from = 0.0_wp, frequency_to = 0.0_wp     !! Hz; both 0: no sweep
    real(wp), allocatable :: frequencies(:)                        !! Hz, for coefficients at single frequencies
    real(wp), allocatable :: integration_frequencies(:)            !! Hz, for time integration
    integer, allocatable :: integration_harmonics(:)
    real(wp) :: integration_load_factor = 1.0_wp
    integer :: integration_samples = 0, steps_per_period = 0, max_periods = 0
    real(wp) :: steady_tolerance = 0.0_wp, allowed_difference = 0.0_wp
  end type case_data

  character(len=*), parameter :: known_groups(8) = [character(len=16) :: 'output', 'model', 'excitation', 'contact', &
                                                    'harmonic_balance', 'sweep', 'points', 'time_integration']

contains

  subroutine read_case(path, data)
    character(len=*), intent(in) :: path
    type(case_data), intent(out) :: data
    character(len=name_length), allocatable :: group(:)
    integer, allocatable :: group_line(:)
    character(len=512) :: message
    integer :: unit, status

    data%file = path
    open (newunit=unit, file=path, status='old', action='read', iostat=status, iomsg=message)
    if (status /= 0) call fail(trim(path)//': cannot be opened: '//trim(message))
    call find_groups(path, unit, group, group_line)

    call read_output()
    call read_model()
    call read_excitation()
    call read_contacts()
    call read_harmonic_balance()
    call read_sweep()
    call read_points()
    call read_time_integration()
    close (unit)

  contains

    !> Goes to the start of the file and tells whether the group is there; `status` must be checked after reading.
    logical function present_group(name)
      character(len=*), intent(in) :: name

      present_group = any(group == name)
      rewind (unit)
    end function present_group

    subroutine need_group(name)
      character(len=*), intent(in) :: name
      if (.not. present_group(name)) call fail(trim(path)//': the group &'//name//' is missing')
    end subroutine need_group

    subroutine check_read(name, occurrence)
      character(len=*), intent(in) :: name
      integer, intent(in) :: occurrence
      if (status /= 0) call refuse(name, occurrence, trim(message))
    end subroutine check_read

    !> Ends the program: which group, where it starts, what is wrong.
    subroutine refuse(name, occurrence, what)
      character(len=*), intent(in) :: name, what
      integer, intent(in) :: occurrence
      integer :: i, seen

      seen = 0
      do i = 1, size(group)
        if (group(i) == name) seen = seen + 1
        if (seen == occurrence) exit
      end do
      i = min(i, size(group))
      call fail(trim(path)//', group &'//name//' at line '//text(group_line(i))//': '//what)
    end subroutine refuse

    subroutine read_output()
      character(len=name_length) :: name
      namelist /output/ name

      name = ' '
      call need_group('output')
      read (unit, nml=output, iostat=status, iomsg=message)
      call check_read('output', 1)
      if (len_trim(name) == 0 .or. scan(trim(name), ' /') > 0) then
        call refuse('output', 1, 'name must be a word without "/"')
      end if
      data%name = name
    end subroutine read_output

    subroutine read_model()
      character(len=path_length) :: mass, damping, stiffness, dof_map
      namelist /model/ mass, damping, stiffness, dof_map

      mass = ' '
      damping = ' '
      stiffness = ' '
      dof_map = ' '
      call need_group('model')
      read (unit, nml=model, iostat=status, iomsg=message)
      call check_read('model', 1)
      if (any([character(len=path_length) :: mass, damping, stiffness, dof_map] == ' ')) then
        call refuse('model', 1, 'mass, damping, stiffness and dof_map must name files')
      end if
      call read_structure(trim(mass), trim(damping), trim(stiffness), trim(dof_map), data%model)
    end subroutine read_model

    subroutine read_excitation()
      integer :: dof(max_list_size), response_dof, n
      real(wp) :: amplitude(max_list_size), phase(max_list_size)
      namelist /excitation/ dof, amplitude, phase, response_dof

      dof = -1
      amplitude = unset
      phase = 0.0_wp
      response_dof = -1
      call need_group('excitation')
      read (unit, nml=excitation, iostat=status, iomsg=message)
      call check_read('excitation', 1)
      n = count(dof /= -1)
      if (n == 0) call refuse('excitation', 1, 'dof is missing')
      call check_dof('excitation', 1, 'dof', dof(:n), 1)
      call check_dof('excitation', 1, 'response_dof', [response_dof], 1)
      if (any(amplitude(:n) <= unset)) then
        call refuse('excitation', 1, 'amplitude must be a number for each dof')
      end if
      if (all(amplitude(:n) <= 0.0_wp)) call refuse('excitation', 1, 'one amplitude must be > 0')
      data%excited_dof = dof(:n)
      data%excitation_amplitude = amplitude(:n)
      data%excitation_phase = phase(:n)
      data%response_dof = response_dof
    end subroutine read_excitation

    subroutine read_contacts()
      character(len=name_length) :: name, law, displacement_reference
      integer :: dof(2), count, i
      logical :: load_varied
      real(wp) :: flat_half_width, edge_radius, length, normal_force, friction_coefficient
      real(wp) :: young_modulus(2), poisson_ratio(2), spring_stiffness
      namelist /contact/ name, law, dof, count, load_varied, flat_half_width, edge_radius, length, normal_force, &
        friction_coefficient, young_modulus, poisson_ratio, displacement_reference, spring_stiffness

      call need_group('contact')
      allocate (data%contacts(number_of('contact')))
      do i = 1, size(data%contacts)
        name = ' '
        law = ' '
        displacement_reference = 'centre point'
        dof = -1
        count = 1
        load_varied = .true.
        flat_half_width = unset
        edge_radius = unset
        length = unset
        normal_force = unset
        friction_coefficient = unset
        young_modulus = unset
        poisson_ratio = unset
        spring_stiffness = 0.0_wp
        read (unit, nml=contact, iostat=status, iomsg=message)
        call check_read('contact', i)

        if (len_trim(name) == 0) call refuse('contact', i, 'name is missing')
        if (any(data%contacts(:i - 1)%name == name)) call refuse('contact', i, 'the name '//trim(name)//' occurs twice')
        if (law /= law_microslip .and. law /= law_slider) then
          call refuse('contact', i, 'law = "'//trim(law)//'": must be "'//law_microslip//'" or "'//law_slider//'"')
        end if
        call check_dof('contact', i, 'dof', dof, 0)
        if (dof(1) == dof(2)) call refuse('contact', i, 'dof must be two different degrees of freedom; 0 is the ground')
        if (count < 1) call refuse('contact', i, 'count = '//text(count)//': must be 1 or more')
        if (.not. spring_stiffness >= 0.0_wp) then
          call refuse('contact', i, 'spring_stiffness = '//text(spring_stiffness)// &
                      ': must be > 0, or 0 for the initial stiffness of the microslip law')
        end if
        ! With a stiffness given, a spring-slider asks the library nothing that would check these.
        if (.not. normal_force >= 0.0_wp) call refuse('contact', i, 'normal_force must be given and >= 0')
        if (.not. friction_coefficient >= 0.0_wp) then
          call refuse('contact', i, 'friction_coefficient must be given and >= 0')
        end if

        associate (c => data%contacts(i))
          c%name = name
          c%law = law
          c%dof = dof
          c%count = count
          c%load_varied = load_varied
          c%spring_stiffness = spring_stiffness
          call mslip_parameters_default(c%parameters)
          c%parameters%flat_half_width = flat_half_width
          c%parameters%edge_radius = edge_radius
          c%parameters%length = length
          c%parameters%normal_force = normal_force
          c%parameters%friction_coefficient = friction_coefficient
          c%parameters%material%young_modulus = young_modulus
          c%parameters%material%poisson_ratio = poisson_ratio
          select case (displacement_reference)
          case ('centre point')
            c%parameters%displacement_reference = MSLIP_CENTRE_POINT
          case ('rigid strip')
            c%parameters%displacement_reference = MSLIP_RIGID_STRIP
          case default
            call refuse('contact', i, 'displacement_reference must be "centre point" or "rigid strip"')
          end select
        end associate
      end do
    end subroutine read_contacts

    subroutine read_harmonic_balance()
      integer :: harmonics, samples
      real(wp) :: tolerance
      namelist /harmonic_balance/ harmonics, samples, tolerance

      harmonics = 5
      samples = 128
      tolerance = 1.0e-9_wp
      call need_group('harmonic_balance')
      read (unit, nml=harmonic_balance, iostat=status, iomsg=message)
      call check_read('harmonic_balance', 1)
      if (harmonics < 1) call refuse('harmonic_balance', 1, 'harmonics must be 1 or more')
      if (samples <= 2 * harmonics) call refuse('harmonic_balance', 1, 'samples must exceed twice the harmonics')
      if (.not. (tolerance >= 1.0e-13_wp .and. tolerance <= 1.0e-3_wp)) then
        call refuse('harmonic_balance', 1, 'tolerance must be from 1e-13 to 1e-3')
      end if
      data%harmonics = harmonics
      data%samples = samples
      data%tolerance = tolerance
    end subroutine read_harmonic_balance

    subroutine read_sweep()
      real(wp) :: frequency_from, frequency_to, load_factors(max_list_size)
      namelist /sweep/ frequency_from, frequency_to, load_factors

      allocate (data%load_factors(0))
      if (.not. present_group('sweep')) return
      frequency_from = unset
      frequency_to = unset
      load_factors = unset
      read (unit, nml=sweep, iostat=status, iomsg=message)
      call check_read('sweep', 1)
      if (.not. (frequency_from > 0.0_wp .and. frequency_to > 0.0_wp)) then
        call refuse('sweep', 1, 'frequency_from and frequency_to must be given, in Hz and > 0')
      end if
      if (frequency_from >= frequency_to) call refuse('sweep', 1, 'frequency_from must be below frequency_to')
      data%load_factors = pack(load_factors, load_factors > unset)
      if (size(data%load_factors) == 0) data%load_factors = [1.0_wp]
      if (any(data%load_factors <= 0.0_wp)) call refuse('sweep', 1, 'load_factors must be > 0')
      data%frequency_from = frequency_from
      data%frequency_to = frequency_to
    end subroutine read_sweep

    subroutine read_points()
      real(wp) :: frequency(max_list_size)
      namelist /points/ frequency

      allocate (data%frequencies(0))
      if (.not. present_group('points')) return
      frequency = unset
      read (unit, nml=points, iostat=status, iomsg=message)
      call check_read('points', 1)
      call positive_list('points', 'frequency', frequency, data%frequencies)
    end subroutine read_points

    subroutine read_time_integration()
      real(wp) :: frequency(max_list_size), load_factor, steady_tolerance, allowed_difference
      integer :: harmonics(max_list_size), samples, steps_per_period, max_periods
      namelist /time_integration/ frequency, load_factor, harmonics, samples, steps_per_period, max_periods, &
        steady_tolerance, allowed_difference

      allocate (data%integration_frequencies(0), data%integration_harmonics(0))
      if (.not. present_group('time_integration')) return
      frequency = unset
      load_factor = 1.0_wp
      harmonics = 0
      samples = 1024
      steps_per_period = 1024
      max_periods = 1000
      steady_tolerance = 1.0e-5_wp
      allowed_difference = huge(allowed_difference)
      read (unit, nml=time_integration, iostat=status, iomsg=message)
      call check_read('time_integration', 1)
      call positive_list('time_integration', 'frequency', frequency, data%integration_frequencies)
      data%integration_harmonics = pack(harmonics, harmonics /= 0)
      if (size(data%integration_harmonics) == 0) call refuse('time_integration', 1, 'harmonics must list one number or more')
      if (any(data%integration_harmonics < 1)) call refuse('time_integration', 1, 'harmonics must be 1 or more')
      if (samples <= 2 * maxval(data%integration_harmonics)) then
        call refuse('time_integration', 1, 'samples must exceed twice the harmonics')
      end if
      if (.not. load_factor > 0.0_wp) call refuse('time_integration', 1, 'load_factor must be > 0')
      if (steps_per_period < 16) call refuse('time_integration', 1, 'steps_per_period must be 16 or more')
      if (max_periods < 2) call refuse('time_integration', 1, 'max_periods must be 2 or more')
      if (.not. steady_tolerance > 0.0_wp) call refuse('time_integration', 1, 'steady_tolerance must be > 0')
      if (.not. allowed_difference > 0.0_wp) call refuse('time_integration', 1, 'allowed_difference must be > 0')
      data%integration_load_factor = load_factor
      data%integration_samples = samples
      data%steps_per_period = steps_per_period
      data%max_periods = max_periods
      data%steady_tolerance = steady_tolerance
      data%allowed_difference = allowed_difference
    end subroutine read_time_integration

    subroutine positive_list(name, variable, list, kept)
      character(len=*), intent(in) :: name, variable
      real(wp), intent(in) :: list(:)
      real(wp), allocatable, intent(out) :: kept(:)

      kept = pack(list, list > unset)
      if (size(kept) == 0) call refuse(name, 1, variable//' must list one number or more')
      if (any(kept <= 0.0_wp)) call refuse(name, 1, variable//' must be > 0')
    end subroutine positive_list

    integer function number_of(name)
      character(len=*), intent(in) :: name
      number_of = count(group == name)
    end function number_of

    subroutine check_dof(name, occurrence, variable, dof, lowest)
      character(len=*), intent(in) :: name, variable
      integer, intent(in) :: occurrence, dof(:), lowest
      integer :: i, n

      n = size(data%model%dof_name)
      do i = 1, size(dof)
        if (dof(i) < lowest .or. dof(i) > n) then
          call refuse(name, occurrence, variable//' = '//text(dof(i))//': must be from '//text(lowest)//' to '// &
                      text(n)//', the degrees of freedom of the model')
        end if
      end do
    end subroutine check_dof
  end subroutine read_case

  !> Names and lines of all groups; an unknown group would otherwise be passed over in silence.
  subroutine find_groups(path, unit, group, group_line)
    character(len=*), intent(in) :: path
    integer, intent(in) :: unit
    character(len=name_length), allocatable, intent(out) :: group(:)
    integer, allocatable, intent(out) :: group_line(:)
    character(len=512) :: line
    character(len=name_length) :: name
    integer :: status, line_number, first, i

    allocate (group(0), group_line(0))
    line_number = 0
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      line_number = line_number + 1
      first = verify(line, ' ')
      if (first == 0) cycle
      if (line(first:first) /= '&') cycle
      name = line(first + 1:first + scan(line(first + 1:)//' ', ' /,!') - 1)
      if (all(known_groups /= name)) then
        call fail(trim(path)//', line '//text(line_number)//': unknown group &'//trim(name)//'; known are '// &
                  trim(list_of_groups()))
      end if
      if (name /= 'contact' .and. any(group == name)) then
        call fail(trim(path)//', line '//text(line_number)//': the group &'//trim(name)//' occurs twice')
      end if
      group = [group, name]
      group_line = [group_line, line_number]
    end do

  contains

    function list_of_groups() result(list)
      character(len=200) :: list
      write (list, '(*(a, :, ", "))') ('&'//trim(known_groups(i)), i=1, size(known_groups))
    end function list_of_groups
  end subroutine find_groups
end module case_input
