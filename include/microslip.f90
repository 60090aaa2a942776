module microslip
  !! Tangential friction contact with microslip for blade dynamics: the law of M. Allara, "A model for the
  !! characterization of friction contacts in turbine blades", Journal of Sound and Vibration 320 (2009) 527-544. The
  !! equations cited below are those of that paper.
  !!
  !! The module needs a Fortran 2008 compiler and is shipped as source, because module files depend on the compiler:
  !! compile it with the program and link `-lmicroslip -lm`.
  !!
  !! **Units.** Any one consistent set; the text names SI. Forces are totals, not per unit length. A positive
  !! displacement gives a positive force.
  !!
  !! **Arguments.** The order is: inputs, required outputs, `status`, optional arguments. The number of points is the
  !! size of the arrays; all arrays of one call that hold a number for each point have the same size. An optional
  !! output that is absent is not computed. Sections with strides are allowed. But of a name for one, `associate
  !! (row => table(1, :))`, gfortran 12 forgets the stride where the argument is changed: there pass `table(1, :)` itself.
  !!
  !! **Errors.** `status` is `MSLIP_OK`, or a code that `mslip_status_text` explains; then no other argument was
  !! changed. Arrays whose sizes disagree give `MSLIP_BAD_ARRAY_SIZE`. A number that is infinite or not a number is
  !! refused. A contact, state or workspace that was never initialised is recognised and refused.
  !!
  !! **Threads.** Nothing is kept between calls: any thread may call anything on its own data, and contacts, once
  !! prepared, may be shared. A call takes at most 40 kB of stack (`OMP_STACKSIZE`).
  use, intrinsic :: iso_c_binding, only: c_char, c_double, c_f_pointer, c_int32_t, c_int64_t, c_loc, &
    c_null_ptr, c_ptr, c_size_t
  implicit none
  private

  public :: mslip_version, mslip_abi_version, mslip_status_text
  public :: mslip_parameters_default, mslip_elliptic_parameters_default
  public :: mslip_contact_init, mslip_contact_init_like, mslip_contact_init_elliptic
  public :: mslip_tractions, mslip_slip
  public :: mslip_monotonic_displacement, mslip_monotonic_force
  public :: mslip_state_length, mslip_state_init
  public :: mslip_masing_update, mslip_masing_path, mslip_masing_tractions
  public :: mslip_hysteresis_loop, mslip_dissipated_energy, mslip_complex_stiffness
  public :: mslip_harmonic_workspace_length, mslip_harmonic_workspace_init, mslip_harmonic_force
  public :: mslip_interface_complex_stiffness, mslip_interface_masing_update, mslip_interface_harmonic_force
  public :: mslip_jenkins_equivalent, mslip_iwan_equivalent

  integer, parameter, public :: mslip_real = c_double  !! Kind of every real number.
  integer, parameter, public :: mslip_int = c_int32_t  !! Kind of status codes, flags and choices.
  integer, parameter, public :: mslip_size = c_size_t  !! Kind of counts and lengths.

  integer(mslip_int), parameter, public :: MSLIP_MODULE_ABI_VERSION = 2
    !! Version of the C interface that this module was written for (`MSLIP_ABI_VERSION` of the C header; Fortran does not
    !! tell that name from the function `mslip_abi_version`, with which it is to be compared).

  integer(mslip_int), parameter, public :: MSLIP_CENTRE_POINT = 0
    !! The displacement is that of the centre of the contact, as in the paper.
  integer(mslip_int), parameter, public :: MSLIP_RIGID_STRIP = 1
    !! The displacement is that of a rigid strip: Eq. 10 corrected to three-dimensional contact mechanics.
  integer(mslip_int), parameter, public :: MSLIP_EQUIDISTANT = 0
    !! `rule`: samples at equal distances.
  integer(mslip_int), parameter, public :: MSLIP_BETWEEN_REVERSALS = 1
    !! `rule`: Gauss-Legendre nodes between the instants at which the displacement turns, a loop closes or gross slip starts.

  ! Status codes: the numbers of the C header, fixed for good.
  integer(mslip_int), parameter, public :: MSLIP_OK = 0  !! Done.
  integer(mslip_int), parameter, public :: MSLIP_NULL_POINTER = 1  !! Never from this module: an argument of a C function was NULL.
  integer(mslip_int), parameter, public :: MSLIP_BAD_FLAT_HALF_WIDTH = 2  !! `flat_half_width` is to be >= 0.
  integer(mslip_int), parameter, public :: MSLIP_BAD_EDGE_RADIUS = 3  !! `edge_radius` is to be > 0.
  integer(mslip_int), parameter, public :: MSLIP_BAD_LENGTH = 4  !! `length` is to be > 0.
  integer(mslip_int), parameter, public :: MSLIP_BAD_NORMAL_FORCE = 5  !! `normal_force` is to be >= 0.
  integer(mslip_int), parameter, public :: MSLIP_BAD_FRICTION_COEFFICIENT = 6  !! `friction_coefficient` is to be >= 0.
  integer(mslip_int), parameter, public :: MSLIP_BAD_YOUNG_MODULUS = 7  !! `young_modulus` is to be > 0.
  integer(mslip_int), parameter, public :: MSLIP_BAD_POISSON_RATIO = 8  !! `poisson_ratio` is to be 0 to 0.5.
  integer(mslip_int), parameter, public :: MSLIP_BAD_DISPLACEMENT_REFERENCE = 9  !! `displacement_reference` is none of those.
  integer(mslip_int), parameter, public :: MSLIP_BAD_SEMI_AXIS_X = 10  !! `semi_axis_x` is to be > 0.
  integer(mslip_int), parameter, public :: MSLIP_BAD_SEMI_AXIS_Y = 11  !! `semi_axis_y` is to be > 0.
  integer(mslip_int), parameter, public :: MSLIP_LENGTH_TOO_SHORT = 12  !! The length does not suit the half-width of contact.
  integer(mslip_int), parameter, public :: MSLIP_OUT_OF_RANGE = 13  !! The parameters together give numbers out of range.
  integer(mslip_int), parameter, public :: MSLIP_BAD_CONTACT = 20  !! The contact was never prepared.
  integer(mslip_int), parameter, public :: MSLIP_BAD_STATE = 21  !! The state was never initialised.
  integer(mslip_int), parameter, public :: MSLIP_BAD_WORKSPACE = 22  !! The workspace was never initialised.
  integer(mslip_int), parameter, public :: MSLIP_STATE_TOO_SHORT = 23  !! See `mslip_state_length`.
  integer(mslip_int), parameter, public :: MSLIP_STATE_FULL = 24  !! The state cannot hold one more reversal.
  integer(mslip_int), parameter, public :: MSLIP_WORKSPACE_TOO_SHORT = 25  !! See `mslip_harmonic_workspace_length`.
  integer(mslip_int), parameter, public :: MSLIP_BAD_FORCE = 30  !! A force is not finite.
  integer(mslip_int), parameter, public :: MSLIP_FORCE_EXCEEDS_SLIP = 31  !! A force exceeds `slip_force`.
  integer(mslip_int), parameter, public :: MSLIP_BAD_DISPLACEMENT = 32  !! A displacement is not finite, or exceeds 1e150.
  integer(mslip_int), parameter, public :: MSLIP_BAD_POSITION = 33  !! A position is not finite.
  integer(mslip_int), parameter, public :: MSLIP_BAD_AMPLITUDE = 34  !! An amplitude is to be 0 to 1e150.
  integer(mslip_int), parameter, public :: MSLIP_BAD_FORCE_AMPLITUDE = 35  !! A force amplitude is to be >= 0 and finite.
  integer(mslip_int), parameter, public :: MSLIP_BAD_HARMONICS = 36  !! The number of harmonics is to be 1 to 2**24.
  integer(mslip_int), parameter, public :: MSLIP_BAD_SAMPLES = 37  !! Samples: more than twice the harmonics, up to 2**24.
  integer(mslip_int), parameter, public :: MSLIP_BAD_COUNT = 38  !! The number of sliders is to be 1 to 65536.
  integer(mslip_int), parameter, public :: MSLIP_BAD_RULE = 39  !! `rule` is none of those.
  integer(mslip_int), parameter, public :: MSLIP_NOT_AVAILABLE = 40  !! Elliptical contacts have no slip.
  integer(mslip_int), parameter, public :: MSLIP_BAD_ARRAY_SIZE = 90  !! Sizes of arrays disagree.
  integer(mslip_int), parameter, public :: MSLIP_BAD_ALIGNMENT = 91  !! An array does not stand at a multiple of 8 bytes.

  ! A number nobody has set: outside the range of every parameter, so that mslip_contact_init refuses it by name.
  real(mslip_real), parameter :: unset = -2.0_mslip_real

  type, bind(c), public :: mslip_material
    !! Isotropic linear elastic body.
    real(mslip_real) :: young_modulus = unset  !! Young's modulus, Pa, > 0.
    real(mslip_real) :: poisson_ratio = unset  !! Poisson's ratio, 0 to 0.5.
  end type mslip_material

  type, bind(c), public :: mslip_parameters
    !! Flat with rounded edges pressed on a flat (Eq. 1-24). A number left unset is refused by `mslip_contact_init`.
    real(mslip_real) :: flat_half_width = unset  !! Half-width a of the flat, m, >= 0; 0 is a Hertzian cylinder.
    real(mslip_real) :: edge_radius = unset
      !! Radius R of the edges, m, > 0. Eq. 1 is taken with twice its printed right-hand side, which alone tends to
      !! Hertz's cylinder as a tends to 0; passing 2R gives the relation as printed.
    real(mslip_real) :: length = unset
      !! Length L along the line of contact, m; 2L has to exceed the half-width of contact b, and the initial stiffness
      !! has to be positive.
    real(mslip_real) :: normal_force = unset  !! Normal force N, N, >= 0; 0 is an open contact: no force, no stiffness.
    real(mslip_real) :: friction_coefficient = unset  !! Friction coefficient mu, >= 0.
    type(mslip_material) :: material(2)  !! The two bodies.
    integer(mslip_int) :: displacement_reference = MSLIP_CENTRE_POINT
      !! `MSLIP_CENTRE_POINT`, as in the paper, or `MSLIP_RIGID_STRIP`.
    integer(mslip_int) :: reserved = 0  !! Leave 0.
  end type mslip_parameters

  type, bind(c), public :: mslip_elliptic_parameters
    !! Elliptical Hertzian contact (section 3.3); a sphere where both axes are equal. A number left unset is refused by
    !! `mslip_contact_init_elliptic`.
    real(mslip_real) :: semi_axis_x = unset  !! Semi-axis in the direction of the tangential force, m, > 0.
    real(mslip_real) :: semi_axis_y = unset  !! Semi-axis across the tangential force, m, > 0.
    real(mslip_real) :: normal_force = unset  !! Normal force N, N, >= 0; 0 is an open contact.
    real(mslip_real) :: friction_coefficient = unset  !! Friction coefficient mu, >= 0.
    type(mslip_material) :: material(2)  !! The two bodies.
  end type mslip_elliptic_parameters

  integer, parameter :: contact_bytes = 1992, readable_numbers = 6
  integer, parameter :: reserved_numbers = contact_bytes/8 - readable_numbers

  type, bind(c), public :: mslip_contact
    !! A contact, prepared once by `mslip_contact_init` or `mslip_contact_init_elliptic` and then only read. Plain data: it
    !! may be copied, written to restart files and sent through MPI. The numbers below are results; do not set them.
    real(mslip_real) :: composite_modulus = 0  !! E*, Pa (Eq. 2).
    real(mslip_real) :: half_width = 0  !! Half-width of contact b, m; of an elliptical contact the x semi-axis.
    real(mslip_real) :: slip_force = 0  !! mu N, N: the tangential force in gross slip.
    real(mslip_real) :: slip_displacement = 0  !! Displacement at which gross slip starts, m.
    real(mslip_real) :: initial_stiffness = 0  !! Derivative of the force by the displacement at 0, N/m.
    real(mslip_real) :: slip_energy = 0  !! Energy dissipated per cycle at incipient gross slip, J (Eq. 16).
    real(mslip_real) :: reserved(reserved_numbers) = 0  !! Not to be changed; public, for `write` takes no private component.
  end type mslip_contact

  ! A workspace begins with numbers of this module, by which the sizes of the arrays can be checked: the mark of an
  ! initialised workspace, its length, and the number 2H+1 of coefficients. The workspace of the C function follows.
  integer, parameter :: workspace_header = 3
  integer(c_int64_t), parameter :: workspace_mark = transfer(-5.7238113e286_mslip_real, 0_c_int64_t)

  ! Where an array without elements lies: c_loc is defined for arrays with elements only.
  real(mslip_real), target :: no_elements(1) = 0

  interface mslip_monotonic_displacement
    !! Displacement under a force grown monotonically from 0.
    module procedure monotonic_displacement_scalar, monotonic_displacement_array
  end interface mslip_monotonic_displacement

  interface mslip_monotonic_force
    !! Force at a displacement grown monotonically from 0.
    module procedure monotonic_force_scalar, monotonic_force_array
  end interface mslip_monotonic_force

  interface mslip_masing_update
    !! One step of the displacement, with return-point memory; in place, or with the new state in `state_new`.
    module procedure masing_update_in_place, masing_update_separate
  end interface mslip_masing_update

  interface mslip_masing_path
    !! Many steps of the displacement, with return-point memory; in place, or with the last state in `state_new`.
    module procedure masing_path_in_place, masing_path_separate
  end interface mslip_masing_path

  interface mslip_dissipated_energy
    !! Energy dissipated per cycle of the force.
    module procedure dissipated_energy_scalar, dissipated_energy_array
  end interface mslip_dissipated_energy

  interface mslip_complex_stiffness
    !! Harmonic stiffness at an amplitude of the displacement, and its derivative.
    module procedure complex_stiffness_scalar, complex_stiffness_array
  end interface mslip_complex_stiffness

  interface mslip_interface_masing_update
    !! One step of the displacement of many contacts; in place, or with the new states in `states_new`.
    module procedure interface_masing_update_in_place, interface_masing_update_separate
  end interface mslip_interface_masing_update

  interface locate
    ! C address of an array, and whether it has the size it should. Called for those optional arrays only that are
    ! present: handed on absent, a contiguous one is taken by compilers' sanitizers for a NULL pointer in use.
    module procedure locate_array, locate_matrix, locate_matrices, locate_flags
  end interface locate

  interface

    pure function mslip_abi_version() bind(c, name='mslip_abi_version') result(version)
      !! Version of the interface of the linked library. The module belongs to the library where this equals
      !! `MSLIP_MODULE_ABI_VERSION`.
      import :: mslip_int
      integer(mslip_int) :: version  !! Version of the interface, > 0.
    end function mslip_abi_version

    subroutine mslip_parameters_default(parameters) bind(c, name='mslip_parameters_default')
      !! Every number unset (not a number, so that one forgotten is refused), `MSLIP_CENTRE_POINT`.
      import :: mslip_parameters
      type(mslip_parameters), intent(out) :: parameters  !! The parameters to reset.
    end subroutine mslip_parameters_default

    subroutine mslip_elliptic_parameters_default(parameters) bind(c, name='mslip_elliptic_parameters_default')
      !! Every number unset (not a number, so that one forgotten is refused).
      import :: mslip_elliptic_parameters
      type(mslip_elliptic_parameters), intent(out) :: parameters  !! The parameters to reset.
    end subroutine mslip_elliptic_parameters_default

    pure function mslip_state_length(reversals) bind(c, name='mslip_state_length') result(length)
      !! Length of a state that holds so many nested reversals of the displacement. May dimension an array.
      import :: mslip_size
      integer(mslip_size), value, intent(in) :: reversals  !! Nested reversals, >= 0.
      integer(mslip_size) :: length  !! Numbers that the state has to have.
    end function mslip_state_length

  end interface

  ! The C functions behind the procedures of this module; type(c_ptr) is what may be NULL, or may be given twice.
  interface

    pure function c_strlen(text) bind(c, name='strlen') result(length)
      import :: c_ptr, c_size_t
      type(c_ptr), value, intent(in) :: text
      integer(c_size_t) :: length
    end function c_strlen

    pure function c_version() bind(c, name='mslip_version') result(text)
      import :: c_ptr
      type(c_ptr) :: text
    end function c_version

    pure function c_status_text(status) bind(c, name='mslip_status_text') result(text)
      import :: c_ptr, mslip_int
      integer(mslip_int), value, intent(in) :: status
      type(c_ptr) :: text
    end function c_status_text

    function c_contact_init(parameters, contact) bind(c, name='mslip_contact_init') result(status)
      import :: mslip_contact, mslip_int, mslip_parameters
      type(mslip_parameters), intent(in) :: parameters
      type(mslip_contact), intent(inout) :: contact
      integer(mslip_int) :: status
    end function c_contact_init

    function c_contact_init_like(parameters, like, contact) bind(c, name='mslip_contact_init_like') result(status)
      import :: mslip_contact, mslip_int, mslip_parameters
      type(mslip_parameters), intent(in) :: parameters
      type(mslip_contact), intent(in) :: like
      type(mslip_contact), intent(inout) :: contact
      integer(mslip_int) :: status
    end function c_contact_init_like

    function c_contact_init_elliptic(parameters, contact) bind(c, name='mslip_contact_init_elliptic') result(status)
      import :: mslip_contact, mslip_elliptic_parameters, mslip_int
      type(mslip_elliptic_parameters), intent(in) :: parameters
      type(mslip_contact), intent(inout) :: contact
      integer(mslip_int) :: status
    end function c_contact_init_elliptic

    function c_tractions(contact, force, n, x, pressure, shear) bind(c, name='mslip_tractions') result(status)
      import :: c_ptr, mslip_contact, mslip_int, mslip_real, mslip_size
      type(mslip_contact), intent(in) :: contact
      real(mslip_real), value, intent(in) :: force
      integer(mslip_size), value, intent(in) :: n
      real(mslip_real), intent(in) :: x(*)
      type(c_ptr), value, intent(in) :: pressure, shear
      integer(mslip_int) :: status
    end function c_tractions

    function c_slip(contact, force, n, x, slip, damage) bind(c, name='mslip_slip') result(status)
      import :: c_ptr, mslip_contact, mslip_int, mslip_real, mslip_size
      type(mslip_contact), intent(in) :: contact
      real(mslip_real), value, intent(in) :: force
      integer(mslip_size), value, intent(in) :: n
      real(mslip_real), intent(in) :: x(*)
      type(c_ptr), value, intent(in) :: slip, damage
      integer(mslip_int) :: status
    end function c_slip

    function c_monotonic_displacement(contact, n, force, displacement, compliance, stick_half_width) &
      bind(c, name='mslip_monotonic_displacement') result(status)
      import :: c_ptr, mslip_contact, mslip_int, mslip_real, mslip_size
      type(mslip_contact), intent(in) :: contact
      integer(mslip_size), value, intent(in) :: n
      real(mslip_real), intent(in) :: force(*)
      type(c_ptr), value, intent(in) :: displacement, compliance, stick_half_width
      integer(mslip_int) :: status
    end function c_monotonic_displacement

    function c_monotonic_force(contact, n, displacement, force, stiffness, stick_half_width) &
      bind(c, name='mslip_monotonic_force') result(status)
      import :: c_ptr, mslip_contact, mslip_int, mslip_real, mslip_size
      type(mslip_contact), intent(in) :: contact
      integer(mslip_size), value, intent(in) :: n
      real(mslip_real), intent(in) :: displacement(*)
      type(c_ptr), value, intent(in) :: force, stiffness, stick_half_width
      integer(mslip_int) :: status
    end function c_monotonic_force

    function c_state_init(state_length, state) bind(c, name='mslip_state_init') result(status)
      import :: c_ptr, mslip_int, mslip_size
      integer(mslip_size), value, intent(in) :: state_length
      type(c_ptr), value, intent(in) :: state
      integer(mslip_int) :: status
    end function c_state_init

    function c_masing_update(contact, state_length, state0, displacement, state1, force, stiffness, dissipated) &
      bind(c, name='mslip_masing_update') result(status)
      import :: c_ptr, mslip_contact, mslip_int, mslip_real, mslip_size
      type(mslip_contact), intent(in) :: contact
      integer(mslip_size), value, intent(in) :: state_length
      type(c_ptr), value, intent(in) :: state0
      real(mslip_real), value, intent(in) :: displacement
      type(c_ptr), value, intent(in) :: state1, force, stiffness, dissipated
      integer(mslip_int) :: status
    end function c_masing_update

    function c_masing_path(contact, state_length, state0, n, displacement, state1, force, stiffness, dissipated) &
      bind(c, name='mslip_masing_path') result(status)
      import :: c_ptr, mslip_contact, mslip_int, mslip_real, mslip_size
      type(mslip_contact), intent(in) :: contact
      integer(mslip_size), value, intent(in) :: state_length
      type(c_ptr), value, intent(in) :: state0
      integer(mslip_size), value, intent(in) :: n
      real(mslip_real), intent(in) :: displacement(*)
      type(c_ptr), value, intent(in) :: state1, force, stiffness, dissipated
      integer(mslip_int) :: status
    end function c_masing_path

    function c_masing_tractions(contact, state_length, state, n, x, pressure, shear) &
      bind(c, name='mslip_masing_tractions') result(status)
      import :: c_ptr, mslip_contact, mslip_int, mslip_real, mslip_size
      type(mslip_contact), intent(in) :: contact
      integer(mslip_size), value, intent(in) :: state_length
      type(c_ptr), value, intent(in) :: state
      integer(mslip_size), value, intent(in) :: n
      real(mslip_real), intent(in) :: x(*)
      type(c_ptr), value, intent(in) :: pressure, shear
      integer(mslip_int) :: status
    end function c_masing_tractions

    function c_hysteresis_loop(contact, amplitude, n, displacement, force) &
      bind(c, name='mslip_hysteresis_loop') result(status)
      import :: c_ptr, mslip_contact, mslip_int, mslip_real, mslip_size
      type(mslip_contact), intent(in) :: contact
      real(mslip_real), value, intent(in) :: amplitude
      integer(mslip_size), value, intent(in) :: n
      type(c_ptr), value, intent(in) :: displacement, force
      integer(mslip_int) :: status
    end function c_hysteresis_loop

    function c_dissipated_energy(contact, n, force_amplitude, energy) &
      bind(c, name='mslip_dissipated_energy') result(status)
      import :: c_ptr, mslip_contact, mslip_int, mslip_real, mslip_size
      type(mslip_contact), intent(in) :: contact
      integer(mslip_size), value, intent(in) :: n
      real(mslip_real), intent(in) :: force_amplitude(*)
      type(c_ptr), value, intent(in) :: energy
      integer(mslip_int) :: status
    end function c_dissipated_energy

    function c_complex_stiffness(contact, n, amplitude, k_real, k_imag, dk_real, dk_imag) &
      bind(c, name='mslip_complex_stiffness') result(status)
      import :: c_ptr, mslip_contact, mslip_int, mslip_real, mslip_size
      type(mslip_contact), intent(in) :: contact
      integer(mslip_size), value, intent(in) :: n
      real(mslip_real), intent(in) :: amplitude(*)
      type(c_ptr), value, intent(in) :: k_real, k_imag, dk_real, dk_imag
      integer(mslip_int) :: status
    end function c_complex_stiffness

    pure function c_harmonic_workspace_length(harmonics, samples, rule) &
      bind(c, name='mslip_harmonic_workspace_length_rule') result(length)
      import :: mslip_int, mslip_size
      integer(mslip_size), value, intent(in) :: harmonics, samples
      integer(mslip_int), value, intent(in) :: rule
      integer(mslip_size) :: length
    end function c_harmonic_workspace_length

    function c_harmonic_workspace_init(harmonics, samples, rule, workspace_length, workspace) &
      bind(c, name='mslip_harmonic_workspace_init_rule') result(status)
      import :: c_ptr, mslip_int, mslip_size
      integer(mslip_size), value, intent(in) :: harmonics, samples, workspace_length
      integer(mslip_int), value, intent(in) :: rule
      type(c_ptr), value, intent(in) :: workspace
      integer(mslip_int) :: status
    end function c_harmonic_workspace_init

    function c_harmonic_force(contact, workspace, displacement, force, jacobian, dissipated) &
      bind(c, name='mslip_harmonic_force') result(status)
      import :: c_ptr, mslip_contact, mslip_int, mslip_real
      type(mslip_contact), intent(in) :: contact
      type(c_ptr), value, intent(in) :: workspace
      real(mslip_real), intent(in) :: displacement(*)
      type(c_ptr), value, intent(in) :: force, jacobian, dissipated
      integer(mslip_int) :: status
    end function c_harmonic_force

    function c_interface_complex_stiffness(n, contacts, active, amplitude, k_real, k_imag, dk_real, dk_imag) &
      bind(c, name='mslip_interface_complex_stiffness') result(status)
      import :: c_ptr, mslip_contact, mslip_int, mslip_real, mslip_size
      integer(mslip_size), value, intent(in) :: n
      type(mslip_contact), intent(in) :: contacts(*)
      type(c_ptr), value, intent(in) :: active
      real(mslip_real), intent(in) :: amplitude(*)
      type(c_ptr), value, intent(in) :: k_real, k_imag, dk_real, dk_imag
      integer(mslip_int) :: status
    end function c_interface_complex_stiffness

    function c_interface_masing_update(n, contacts, active, state_length, states0, displacement, states1, &
      force, stiffness, dissipated) bind(c, name='mslip_interface_masing_update') result(status)
      import :: c_ptr, mslip_contact, mslip_int, mslip_real, mslip_size
      integer(mslip_size), value, intent(in) :: n
      type(mslip_contact), intent(in) :: contacts(*)
      type(c_ptr), value, intent(in) :: active
      integer(mslip_size), value, intent(in) :: state_length
      type(c_ptr), value, intent(in) :: states0
      real(mslip_real), intent(in) :: displacement(*)
      type(c_ptr), value, intent(in) :: states1, force, stiffness, dissipated
      integer(mslip_int) :: status
    end function c_interface_masing_update

    function c_interface_harmonic_force(n, contacts, active, workspace, displacement, force, jacobian, dissipated) &
      bind(c, name='mslip_interface_harmonic_force') result(status)
      import :: c_ptr, mslip_contact, mslip_int, mslip_real, mslip_size
      integer(mslip_size), value, intent(in) :: n
      type(mslip_contact), intent(in) :: contacts(*)
      type(c_ptr), value, intent(in) :: active, workspace
      real(mslip_real), intent(in) :: displacement(*)
      type(c_ptr), value, intent(in) :: force, jacobian, dissipated
      integer(mslip_int) :: status
    end function c_interface_harmonic_force

    function c_jenkins_equivalent(contact, amplitude, stiffness, slip_force) &
      bind(c, name='mslip_jenkins_equivalent') result(status)
      import :: mslip_contact, mslip_int, mslip_real
      type(mslip_contact), intent(in) :: contact
      real(mslip_real), value, intent(in) :: amplitude
      real(mslip_real), intent(inout) :: stiffness, slip_force
      integer(mslip_int) :: status
    end function c_jenkins_equivalent

    function c_iwan_equivalent(contact, n, stiffness, slip_force, force_error) &
      bind(c, name='mslip_iwan_equivalent') result(status)
      import :: c_ptr, mslip_contact, mslip_int, mslip_size
      type(mslip_contact), intent(in) :: contact
      integer(mslip_size), value, intent(in) :: n
      type(c_ptr), value, intent(in) :: stiffness, slip_force, force_error
      integer(mslip_int) :: status
    end function c_iwan_equivalent

  end interface

contains

  ! ---------------------------------------------------------------------------------------------------------------------
  ! Version and status

  function mslip_version() result(text)
    !! Version of the linked library, such as "1.2.3".
    character(len=c_strlen(c_version())) :: text  !! The text, without blanks around it.

    text = text_of(c_version())
  end function mslip_version

  function mslip_status_text(status) result(text)
    !! What a status code means: what is wrong and what is allowed, in one sentence. Any number may be asked for.
    integer(mslip_int), intent(in) :: status  !! A status code.
    character(len=c_strlen(c_status_text(status))) :: text  !! The text, without blanks around it.

    text = text_of(c_status_text(status))
  end function mslip_status_text

  ! ---------------------------------------------------------------------------------------------------------------------
  ! Preparing a contact

  subroutine mslip_contact_init(parameters, contact, status)
    !! Prepare the contact of a flat with rounded edges on a flat (Eq. 1-24), a cylinder where the flat has no width.
    type(mslip_parameters), intent(in) :: parameters  !! Geometry, load and materials.
    type(mslip_contact), intent(inout) :: contact  !! The prepared contact.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, or the code of the first parameter out of range; `MSLIP_LENGTH_TOO_SHORT` where the length is too small
      !! for the half-width of contact; `MSLIP_OUT_OF_RANGE` where a result is not a representable number.

    status = c_contact_init(parameters, contact)
  end subroutine mslip_contact_init

  subroutine mslip_contact_init_like(parameters, like, contact, status)
    !! Prepare a contact as `mslip_contact_init` does, with the same numbers in it, but faster where `like` has the same
    !! shape: it differs in the friction coefficient only, or in scale by powers of 2.
    type(mslip_parameters), intent(in) :: parameters  !! Geometry, load and materials.
    type(mslip_contact), intent(in) :: like  !! A prepared contact.
    type(mslip_contact), intent(inout) :: contact  !! The prepared contact.
    integer(mslip_int), intent(out) :: status  !! As from `mslip_contact_init`, or `MSLIP_BAD_CONTACT`.

    status = c_contact_init_like(parameters, like, contact)
  end subroutine mslip_contact_init_like

  subroutine mslip_contact_init_elliptic(parameters, contact, status)
    !! Prepare an elliptical Hertzian contact (section 3.3), a sphere where both axes are equal.
    type(mslip_elliptic_parameters), intent(in) :: parameters  !! Geometry, load and materials.
    type(mslip_contact), intent(inout) :: contact  !! The prepared contact.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, or the code of the first parameter out of range; `MSLIP_OUT_OF_RANGE` where a result is not a
      !! representable number.

    status = c_contact_init_elliptic(parameters, contact)
  end subroutine mslip_contact_init_elliptic

  ! ---------------------------------------------------------------------------------------------------------------------
  ! Monotonic loading

  subroutine mslip_tractions(contact, force, x, status, pressure, shear)
    !! Tractions along the width under a tangential force grown monotonically from 0 (Eq. 17-24). Those of an elliptical
    !! contact are on the x axis.
    type(mslip_contact), intent(in) :: contact  !! A prepared contact.
    real(mslip_real), intent(in) :: force  !! Tangential force, N; its magnitude is at most `slip_force`.
    real(mslip_real), intent(in) :: x(:)  !! Positions from the centre, m; outside the contact tractions are 0.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or what was refused.
    real(mslip_real), intent(inout), optional, target, contiguous :: pressure(:)  !! Pressure, Pa, at each x.
    real(mslip_real), intent(inout), optional, target, contiguous :: shear(:)  !! Shear traction, Pa, at each x.

    integer(mslip_size) :: n
    type(c_ptr) :: at(2)
    logical :: agree

    n = size(x, kind=mslip_size)
    at = c_null_ptr
    agree = .true.
    if (present(pressure)) call locate(pressure, n, at(1), agree)
    if (present(shear)) call locate(shear, n, at(2), agree)
    status = MSLIP_BAD_ARRAY_SIZE
    if (agree) status = c_tractions(contact, force, n, x, at(1), at(2))
  end subroutine mslip_tractions

  subroutine mslip_slip(contact, force, x, status, slip, damage)
    !! Relative slip of the surfaces (Eq. 15) and frictional damage parameter, friction coefficient times pressure times
    !! slip (section 3.5), under a tangential force grown monotonically from 0.
    type(mslip_contact), intent(in) :: contact  !! A prepared contact, not an elliptical one (`MSLIP_NOT_AVAILABLE`).
    real(mslip_real), intent(in) :: force  !! Tangential force, N; its magnitude is at most `slip_force`.
    real(mslip_real), intent(in) :: x(:)  !! Positions from the centre, m.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or what was refused.
    real(mslip_real), intent(inout), optional, target, contiguous :: slip(:)  !! Slip, m, at each x; 0 where it sticks.
    real(mslip_real), intent(inout), optional, target, contiguous :: damage(:)  !! Damage parameter, N/m, at each x.

    integer(mslip_size) :: n
    type(c_ptr) :: at(2)
    logical :: agree

    n = size(x, kind=mslip_size)
    at = c_null_ptr
    agree = .true.
    if (present(slip)) call locate(slip, n, at(1), agree)
    if (present(damage)) call locate(damage, n, at(2), agree)
    status = MSLIP_BAD_ARRAY_SIZE
    if (agree) status = c_slip(contact, force, n, x, at(1), at(2))
  end subroutine mslip_slip

  subroutine monotonic_displacement_array(contact, force, status, displacement, compliance, stick_half_width)
    !! Displacements under tangential forces each grown monotonically from 0 (Eq. 10); odd in the force.
    type(mslip_contact), intent(in) :: contact  !! A prepared contact.
    real(mslip_real), intent(in) :: force(:)
      !! Tangential forces, N; magnitudes at most `slip_force` (`MSLIP_FORCE_EXCEEDS_SLIP`).
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or what was refused.
    real(mslip_real), intent(inout), optional, target, contiguous :: displacement(:)  !! Displacement, m, for each force.
    real(mslip_real), intent(inout), optional, target, contiguous :: compliance(:)
      !! Derivative of the displacement by the force, m/N; +infinity at `slip_force` where the flat has no width.
    real(mslip_real), intent(inout), optional, target, contiguous :: stick_half_width(:)
      !! Half-width of the stick zone, m, between the half-widths of the flat and of contact; of an elliptical contact
      !! the x semi-axis of the stick ellipse.

    integer(mslip_size) :: n
    type(c_ptr) :: at(3)
    logical :: agree

    n = size(force, kind=mslip_size)
    at = c_null_ptr
    agree = .true.
    if (present(displacement)) call locate(displacement, n, at(1), agree)
    if (present(compliance)) call locate(compliance, n, at(2), agree)
    if (present(stick_half_width)) call locate(stick_half_width, n, at(3), agree)
    status = MSLIP_BAD_ARRAY_SIZE
    if (agree) status = c_monotonic_displacement(contact, n, force, at(1), at(2), at(3))
  end subroutine monotonic_displacement_array

  subroutine monotonic_displacement_scalar(contact, force, status, displacement, compliance, stick_half_width)
    !! Displacement under a tangential force grown monotonically from 0 (Eq. 10); odd in the force.
    type(mslip_contact), intent(in) :: contact  !! A prepared contact.
    real(mslip_real), intent(in) :: force  !! Tangential force, N; its magnitude is at most `slip_force`.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or what was refused.
    real(mslip_real), intent(inout), optional, target :: displacement  !! Displacement, m.
    real(mslip_real), intent(inout), optional, target :: compliance
      !! Derivative of the displacement by the force, m/N; +infinity at `slip_force` where the flat has no width.
    real(mslip_real), intent(inout), optional, target :: stick_half_width  !! Half-width of the stick zone, m.

    status = c_monotonic_displacement(contact, 1_mslip_size, [force], &
      address_scalar(displacement), address_scalar(compliance), address_scalar(stick_half_width))
  end subroutine monotonic_displacement_scalar

  subroutine monotonic_force_array(contact, displacement, status, force, stiffness, stick_half_width)
    !! Tangential forces at displacements each grown monotonically from 0: the inverse of Eq. 10, odd in the displacement.
    !! Beyond `slip_displacement` the force stays at `slip_force` and the stiffness is 0.
    type(mslip_contact), intent(in) :: contact  !! A prepared contact.
    real(mslip_real), intent(in) :: displacement(:)  !! Displacements, m; at most 1e150 in size.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or what was refused.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:)  !! Force, N, at each displacement.
    real(mslip_real), intent(inout), optional, target, contiguous :: stiffness(:)
      !! Derivative of the force by the displacement, N/m.
    real(mslip_real), intent(inout), optional, target, contiguous :: stick_half_width(:)  !! Half-width of the stick zone, m.

    integer(mslip_size) :: n
    type(c_ptr) :: at(3)
    logical :: agree

    n = size(displacement, kind=mslip_size)
    at = c_null_ptr
    agree = .true.
    if (present(force)) call locate(force, n, at(1), agree)
    if (present(stiffness)) call locate(stiffness, n, at(2), agree)
    if (present(stick_half_width)) call locate(stick_half_width, n, at(3), agree)
    status = MSLIP_BAD_ARRAY_SIZE
    if (agree) status = c_monotonic_force(contact, n, displacement, at(1), at(2), at(3))
  end subroutine monotonic_force_array

  subroutine monotonic_force_scalar(contact, displacement, status, force, stiffness, stick_half_width)
    !! Tangential force at a displacement grown monotonically from 0: the inverse of Eq. 10, odd in the displacement.
    !! Beyond `slip_displacement` the force stays at `slip_force` and the stiffness is 0.
    type(mslip_contact), intent(in) :: contact  !! A prepared contact.
    real(mslip_real), intent(in) :: displacement  !! Displacement, m; at most 1e150 in size.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or what was refused.
    real(mslip_real), intent(inout), optional, target :: force  !! Force, N.
    real(mslip_real), intent(inout), optional, target :: stiffness  !! Derivative of the force by the displacement, N/m.
    real(mslip_real), intent(inout), optional, target :: stick_half_width  !! Half-width of the stick zone, m.

    status = c_monotonic_force(contact, 1_mslip_size, [displacement], &
      address_scalar(force), address_scalar(stiffness), address_scalar(stick_half_width))
  end subroutine monotonic_force_scalar

  ! ---------------------------------------------------------------------------------------------------------------------
  ! Any history: Masing rule (Eq. 11, 12) with return-point memory

  subroutine mslip_state_init(state, status)
    !! The virgin state: no displacement, no force, no memory.
    real(mslip_real), intent(inout), target, contiguous :: state(:)
      !! The state; at least `mslip_state_length(0)` numbers. Its size decides how many nested reversals it holds; one that is
      !! full goes on at the beginning of a longer array.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK` or `MSLIP_STATE_TOO_SHORT`.

    status = c_state_init(size(state, kind=mslip_size), address(state))
  end subroutine mslip_state_init

  subroutine masing_update_in_place(contact, state, displacement, status, force, stiffness, dissipated)
    !! One step, from where the state is to a displacement, in place.
    type(mslip_contact), intent(in) :: contact  !! A prepared contact.
    real(mslip_real), intent(inout), target, contiguous :: state(:)  !! State before and after the step.
    real(mslip_real), intent(in) :: displacement  !! Displacement at the end of the step, m; at most 1e150 in size.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`; `MSLIP_STATE_FULL` where the state would have to hold more reversals than it can; or what was refused.
    real(mslip_real), intent(inout), optional, target :: force  !! Force at the end of the step, N.
    real(mslip_real), intent(inout), optional, target :: stiffness
      !! Derivative of the force by the displacement at the end of the step, N/m.
    real(mslip_real), intent(inout), optional, target :: dissipated  !! Energy dissipated by the step, J.

    status = c_masing_update(contact, size(state, kind=mslip_size), address(state), displacement, address(state), &
      address_scalar(force), address_scalar(stiffness), address_scalar(dissipated))
  end subroutine masing_update_in_place

  subroutine masing_update_separate(contact, state, displacement, status, force, stiffness, dissipated, state_new)
    !! One step, from where the state is to a displacement; the state before the step is kept.
    type(mslip_contact), intent(in) :: contact  !! A prepared contact.
    real(mslip_real), intent(in), target, contiguous :: state(:)  !! State before the step.
    real(mslip_real), intent(in) :: displacement  !! Displacement at the end of the step, m; at most 1e150 in size.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`; `MSLIP_STATE_FULL` where the state would have to hold more reversals than it can; or what was refused.
    real(mslip_real), intent(inout), optional, target :: force  !! Force at the end of the step, N.
    real(mslip_real), intent(inout), optional, target :: stiffness
      !! Derivative of the force by the displacement at the end of the step, N/m.
    real(mslip_real), intent(inout), optional, target :: dissipated  !! Energy dissipated by the step, J.
    real(mslip_real), intent(inout), target, contiguous :: state_new(:)
      !! State after the step; another array than `state`, of the same size.

    status = MSLIP_BAD_ARRAY_SIZE
    if (size(state_new) /= size(state)) return
    status = c_masing_update(contact, size(state, kind=mslip_size), address(state), displacement, address(state_new), &
      address_scalar(force), address_scalar(stiffness), address_scalar(dissipated))
  end subroutine masing_update_separate

  subroutine masing_path_in_place(contact, state, displacement, status, force, stiffness, dissipated)
    !! Many steps, from where the state is through the displacements in turn, in place.
    type(mslip_contact), intent(in) :: contact  !! A prepared contact.
    real(mslip_real), intent(inout), target, contiguous :: state(:)  !! State before the first and after the last step.
    real(mslip_real), intent(in) :: displacement(:)  !! Displacement at the end of each step, m.
    integer(mslip_int), intent(out) :: status  !! As for `mslip_masing_update`; a refused step refuses the whole path.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:)  !! Force at the end of each step, N.
    real(mslip_real), intent(inout), optional, target, contiguous :: stiffness(:)
      !! Derivative of the force by the displacement at the end of each step, N/m.
    real(mslip_real), intent(inout), optional, target, contiguous :: dissipated(:)  !! Energy dissipated by each step, J.

    integer(mslip_size) :: n
    type(c_ptr) :: at(3)
    logical :: agree

    n = size(displacement, kind=mslip_size)
    at = c_null_ptr
    agree = .true.
    if (present(force)) call locate(force, n, at(1), agree)
    if (present(stiffness)) call locate(stiffness, n, at(2), agree)
    if (present(dissipated)) call locate(dissipated, n, at(3), agree)
    status = MSLIP_BAD_ARRAY_SIZE
    if (agree) status = c_masing_path(contact, size(state, kind=mslip_size), address(state), n, displacement, &
      address(state), at(1), at(2), at(3))
  end subroutine masing_path_in_place

  subroutine masing_path_separate(contact, state, displacement, status, force, stiffness, dissipated, state_new)
    !! Many steps, from where the state is through the displacements in turn; the first state is kept.
    type(mslip_contact), intent(in) :: contact  !! A prepared contact.
    real(mslip_real), intent(in), target, contiguous :: state(:)  !! State before the first step.
    real(mslip_real), intent(in) :: displacement(:)  !! Displacement at the end of each step, m.
    integer(mslip_int), intent(out) :: status  !! As for `mslip_masing_update`; a refused step refuses the whole path.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:)  !! Force at the end of each step, N.
    real(mslip_real), intent(inout), optional, target, contiguous :: stiffness(:)
      !! Derivative of the force by the displacement at the end of each step, N/m.
    real(mslip_real), intent(inout), optional, target, contiguous :: dissipated(:)  !! Energy dissipated by each step, J.
    real(mslip_real), intent(inout), target, contiguous :: state_new(:)
      !! State after the last step; another array than `state`, of the same size.

    integer(mslip_size) :: n
    type(c_ptr) :: at(3)
    logical :: agree

    n = size(displacement, kind=mslip_size)
    at = c_null_ptr
    agree = size(state_new) == size(state)
    if (present(force)) call locate(force, n, at(1), agree)
    if (present(stiffness)) call locate(stiffness, n, at(2), agree)
    if (present(dissipated)) call locate(dissipated, n, at(3), agree)
    status = MSLIP_BAD_ARRAY_SIZE
    if (agree) status = c_masing_path(contact, size(state, kind=mslip_size), address(state), n, displacement, &
      address(state_new), at(1), at(2), at(3))
  end subroutine masing_path_separate

  subroutine mslip_masing_tractions(contact, state, x, status, pressure, shear)
    !! Tractions along the width in a state (Eq. 17-24, one term for each reversal remembered).
    type(mslip_contact), intent(in) :: contact  !! The contact that led to the state.
    real(mslip_real), intent(in), target, contiguous :: state(:)  !! A state; it is not changed.
    real(mslip_real), intent(in) :: x(:)  !! Positions from the centre, m.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or what was refused.
    real(mslip_real), intent(inout), optional, target, contiguous :: pressure(:)  !! Pressure, Pa, at each x.
    real(mslip_real), intent(inout), optional, target, contiguous :: shear(:)  !! Shear traction, Pa, at each x.

    integer(mslip_size) :: n
    type(c_ptr) :: at(2)
    logical :: agree

    n = size(x, kind=mslip_size)
    at = c_null_ptr
    agree = .true.
    if (present(pressure)) call locate(pressure, n, at(1), agree)
    if (present(shear)) call locate(shear, n, at(2), agree)
    status = MSLIP_BAD_ARRAY_SIZE
    if (agree) status = c_masing_tractions(contact, size(state, kind=mslip_size), address(state), n, x, at(1), at(2))
  end subroutine mslip_masing_tractions

  ! ---------------------------------------------------------------------------------------------------------------------
  ! Cycles

  subroutine mslip_hysteresis_loop(contact, amplitude, displacement, force, status)
    !! The closed loop between +amplitude and -amplitude (Eq. 11, 12): n points of one period of amplitude*cos(t), from
    !! t = 0, at equal distances of t. The point at t = 2 pi, equal to the first, is not among them.
    type(mslip_contact), intent(in) :: contact  !! A prepared contact.
    real(mslip_real), intent(in) :: amplitude  !! Amplitude of the displacement, m, 0 to 1e150.
    real(mslip_real), intent(inout), target, contiguous :: displacement(:)  !! Displacement of each point, m.
    real(mslip_real), intent(inout), target, contiguous :: force(:)  !! Force of each point, N.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or what was refused.

    status = MSLIP_BAD_ARRAY_SIZE
    if (size(force) /= size(displacement)) return
    status = c_hysteresis_loop(contact, amplitude, size(force, kind=mslip_size), address(displacement), address(force))
  end subroutine mslip_hysteresis_loop

  subroutine dissipated_energy_array(contact, force_amplitude, energy, status)
    !! Energy dissipated per cycle of the force between +amplitude and -amplitude (Eq. 13-16).
    type(mslip_contact), intent(in) :: contact  !! A prepared contact.
    real(mslip_real), intent(in) :: force_amplitude(:)  !! Amplitudes of the force, N, 0 to `slip_force`.
    real(mslip_real), intent(inout), target, contiguous :: energy(:)  !! Energy per cycle, J, for each amplitude.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or what was refused.

    status = MSLIP_BAD_ARRAY_SIZE
    if (size(energy) /= size(force_amplitude)) return
    status = c_dissipated_energy(contact, size(energy, kind=mslip_size), force_amplitude, address(energy))
  end subroutine dissipated_energy_array

  subroutine dissipated_energy_scalar(contact, force_amplitude, energy, status)
    !! Energy dissipated per cycle of the force between +amplitude and -amplitude (Eq. 13-16).
    type(mslip_contact), intent(in) :: contact  !! A prepared contact.
    real(mslip_real), intent(in) :: force_amplitude  !! Amplitude of the force, N, 0 to `slip_force`.
    real(mslip_real), intent(inout), target :: energy  !! Energy per cycle, J.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or what was refused.

    status = c_dissipated_energy(contact, 1_mslip_size, [force_amplitude], address_scalar(energy))
  end subroutine dissipated_energy_scalar

  subroutine complex_stiffness_array(contact, amplitude, status, k_real, k_imag, dk_real, dk_imag)
    !! Harmonic contact stiffness K' + iK'' at amplitudes of the displacement (section 3.4): the first harmonic of the
    !! force over that of the displacement, in rotating-vector form; K'' >= 0. And its derivatives by the amplitude.
    type(mslip_contact), intent(in) :: contact  !! A prepared contact.
    real(mslip_real), intent(in) :: amplitude(:)
      !! Amplitudes of the displacement, m, 0 to 1e150; 0 gives the initial stiffness.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or what was refused.
    real(mslip_real), intent(inout), optional, target, contiguous :: k_real(:)  !! K', N/m, at each amplitude.
    real(mslip_real), intent(inout), optional, target, contiguous :: k_imag(:)  !! K'', N/m, at each amplitude.
    real(mslip_real), intent(inout), optional, target, contiguous :: dk_real(:)  !! dK'/d(amplitude), N/m2.
    real(mslip_real), intent(inout), optional, target, contiguous :: dk_imag(:)  !! dK''/d(amplitude), N/m2.

    integer(mslip_size) :: n
    type(c_ptr) :: at(4)
    logical :: agree

    n = size(amplitude, kind=mslip_size)
    at = c_null_ptr
    agree = .true.
    if (present(k_real)) call locate(k_real, n, at(1), agree)
    if (present(k_imag)) call locate(k_imag, n, at(2), agree)
    if (present(dk_real)) call locate(dk_real, n, at(3), agree)
    if (present(dk_imag)) call locate(dk_imag, n, at(4), agree)
    status = MSLIP_BAD_ARRAY_SIZE
    if (agree) status = c_complex_stiffness(contact, n, amplitude, at(1), at(2), at(3), at(4))
  end subroutine complex_stiffness_array

  subroutine complex_stiffness_scalar(contact, amplitude, status, k_real, k_imag, dk_real, dk_imag)
    !! Harmonic contact stiffness K' + iK'' at an amplitude of the displacement (section 3.4): the first harmonic of the
    !! force over that of the displacement, in rotating-vector form; K'' >= 0. And its derivatives by the amplitude.
    type(mslip_contact), intent(in) :: contact  !! A prepared contact.
    real(mslip_real), intent(in) :: amplitude  !! Amplitude of the displacement, m, 0 to 1e150; 0 gives the initial stiffness.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or what was refused.
    real(mslip_real), intent(inout), optional, target :: k_real  !! K', N/m.
    real(mslip_real), intent(inout), optional, target :: k_imag  !! K'', N/m.
    real(mslip_real), intent(inout), optional, target :: dk_real  !! dK'/d(amplitude), N/m2.
    real(mslip_real), intent(inout), optional, target :: dk_imag  !! dK''/d(amplitude), N/m2.

    status = c_complex_stiffness(contact, 1_mslip_size, [amplitude], &
      address_scalar(k_real), address_scalar(k_imag), address_scalar(dk_real), address_scalar(dk_imag))
  end subroutine complex_stiffness_scalar

  ! ---------------------------------------------------------------------------------------------------------------------
  ! Several harmonics: alternating frequency/time

  pure function mslip_harmonic_workspace_length(harmonics, samples, rule) result(needed)
    !! Length of the workspace of `mslip_harmonic_force`; 0 where the arguments are out of range. May dimension an array.
    !! It is larger than that of the C function of this name, and a workspace serves this module only.
    integer(mslip_size), intent(in) :: harmonics  !! Highest harmonic H, >= 1.
    integer(mslip_size), intent(in) :: samples  !! Instants of a period, > 2H.
    integer(mslip_int), intent(in), optional :: rule  !! `MSLIP_EQUIDISTANT` (the default) or `MSLIP_BETWEEN_REVERSALS`.
    integer(mslip_size) :: needed  !! Numbers that the workspace has to have.

    needed = c_harmonic_workspace_length(harmonics, samples, chosen(rule))
    ! A C length beyond the largest integer of this kind arrives negative.
    if (needed > 0 .and. needed <= huge(needed) - workspace_header) then
      needed = needed + workspace_header
    else
      needed = 0
    end if
  end function mslip_harmonic_workspace_length

  subroutine mslip_harmonic_workspace_init(harmonics, samples, workspace, status, rule)
    !! Fill a workspace: tables of the cosines and sines, and room. Done once; each thread needs a workspace of its own.
    integer(mslip_size), intent(in) :: harmonics  !! Highest harmonic H, >= 1.
    integer(mslip_size), intent(in) :: samples  !! Instants of a period, > 2H.
    real(mslip_real), intent(inout), target, contiguous :: workspace(:)
      !! The workspace; at least `mslip_harmonic_workspace_length(harmonics, samples, rule)` numbers.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, `MSLIP_BAD_HARMONICS`, `MSLIP_BAD_SAMPLES`, `MSLIP_BAD_RULE` or `MSLIP_WORKSPACE_TOO_SHORT`.
    integer(mslip_int), intent(in), optional :: rule
      !! `MSLIP_EQUIDISTANT`: samples at equal distances from t = 0 (the default). `MSLIP_BETWEEN_REVERSALS`: about as many
      !! nodes between the instants at which the displacement turns, a loop closes or gross slip starts; far more accurate.

    if (size(workspace) > workspace_header) then
      status = c_harmonic_workspace_init(harmonics, samples, chosen(rule), &
        size(workspace, kind=mslip_size) - workspace_header, c_loc(workspace(workspace_header + 1)))
    else
      status = c_harmonic_workspace_init(harmonics, samples, chosen(rule), 0_mslip_size, c_loc(no_elements))
    end if
    if (status /= MSLIP_OK) return
    call mark_workspace(workspace, int(mslip_harmonic_workspace_length(harmonics, samples, rule), c_int64_t), &
      int(2*harmonics + 1, c_int64_t))
  end subroutine mslip_harmonic_workspace_init

  subroutine mslip_harmonic_force(contact, workspace, displacement, status, force, jacobian, dissipated)
    !! Fourier coefficients of the force under a periodic displacement, in the steady state: of the second of two periods
    !! from the virgin state, by the rule of the workspace. All coefficients are in the order
    !! [c0, cos 1, sin 1, cos 2, sin 2, ...].
    type(mslip_contact), intent(in) :: contact  !! A prepared contact.
    real(mslip_real), intent(inout), target, contiguous :: workspace(:)
      !! An initialised workspace (`MSLIP_BAD_WORKSPACE`); it decides H.
    real(mslip_real), intent(in) :: displacement(:)  !! 2H+1 coefficients of the displacement, m.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or what was refused.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:)  !! 2H+1 coefficients of the force, N.
    real(mslip_real), intent(inout), optional, target, contiguous :: jacobian(:, :)
      !! (2H+1, 2H+1): derivative of force coefficient i by displacement coefficient j in element (i, j), N/m; exact for
      !! the sampled problem, and between reversals as good as the force.
    real(mslip_real), intent(inout), optional, target :: dissipated  !! Energy dissipated per period, J.

    integer(mslip_size) :: m
    type(c_ptr) :: at(2)
    logical :: agree

    call open_workspace(workspace, m, status)
    if (status /= MSLIP_OK) return
    at = c_null_ptr
    agree = size(displacement, kind=mslip_size) == m
    if (present(force)) call locate(force, m, at(1), agree)
    if (present(jacobian)) call locate(jacobian, [m, m], at(2), agree)
    status = MSLIP_BAD_ARRAY_SIZE
    if (agree) status = c_harmonic_force(contact, c_loc(workspace(workspace_header + 1)), displacement, at(1), at(2), &
      address_scalar(dissipated))
  end subroutine mslip_harmonic_force

  ! ---------------------------------------------------------------------------------------------------------------------
  ! Many contacts at once: item i uses contacts(i), and is skipped where active(i) is 0

  subroutine mslip_interface_complex_stiffness(contacts, amplitude, status, active, k_real, k_imag, dk_real, dk_imag)
    !! `mslip_complex_stiffness` of n contacts.
    type(mslip_contact), intent(in) :: contacts(:)  !! n prepared contacts.
    real(mslip_real), intent(in) :: amplitude(:)  !! n amplitudes of the displacement, m, 0 to 1e150.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or what was refused.
    integer(mslip_int), intent(in), optional, target, contiguous :: active(:)
      !! n flags: where 0 the item is skipped and its outputs keep what they held. Absent: none is skipped.
    real(mslip_real), intent(inout), optional, target, contiguous :: k_real(:)  !! n values of K', N/m.
    real(mslip_real), intent(inout), optional, target, contiguous :: k_imag(:)  !! n values of K'', N/m.
    real(mslip_real), intent(inout), optional, target, contiguous :: dk_real(:)  !! n values of dK'/d(amplitude), N/m2.
    real(mslip_real), intent(inout), optional, target, contiguous :: dk_imag(:)  !! n values of dK''/d(amplitude), N/m2.

    integer(mslip_size) :: n
    type(c_ptr) :: at(5)
    logical :: agree

    n = size(contacts, kind=mslip_size)
    at = c_null_ptr
    agree = size(amplitude, kind=mslip_size) == n
    if (present(active)) call locate(active, n, at(1), agree)
    if (present(k_real)) call locate(k_real, n, at(2), agree)
    if (present(k_imag)) call locate(k_imag, n, at(3), agree)
    if (present(dk_real)) call locate(dk_real, n, at(4), agree)
    if (present(dk_imag)) call locate(dk_imag, n, at(5), agree)
    status = MSLIP_BAD_ARRAY_SIZE
    if (agree) status = c_interface_complex_stiffness(n, contacts, at(1), amplitude, at(2), at(3), at(4), at(5))
  end subroutine mslip_interface_complex_stiffness

  subroutine interface_masing_update_in_place(contacts, states, displacement, status, active, force, stiffness, dissipated)
    !! `mslip_masing_update` of n contacts, in place. Where one is refused, none is updated.
    type(mslip_contact), intent(in) :: contacts(:)  !! n prepared contacts.
    real(mslip_real), intent(inout), target, contiguous :: states(:, :)
      !! (state length, n): the state of each contact before and after the step.
    real(mslip_real), intent(in) :: displacement(:)  !! n displacements at the end of the step, m.
    integer(mslip_int), intent(out) :: status  !! As for `mslip_masing_update`.
    integer(mslip_int), intent(in), optional, target, contiguous :: active(:)
      !! n flags: where 0 the item is skipped, its state and outputs keep what they held. Absent: none is skipped.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:)  !! n forces, N.
    real(mslip_real), intent(inout), optional, target, contiguous :: stiffness(:)  !! n stiffnesses, N/m.
    real(mslip_real), intent(inout), optional, target, contiguous :: dissipated(:)  !! n energies dissipated by the step, J.

    integer(mslip_size) :: n
    type(c_ptr) :: at(5)
    logical :: agree

    n = size(contacts, kind=mslip_size)
    at = c_null_ptr
    agree = size(displacement, kind=mslip_size) == n
    if (present(active)) call locate(active, n, at(1), agree)
    call locate(states, [size(states, 1, mslip_size), n], at(2), agree)
    if (present(force)) call locate(force, n, at(3), agree)
    if (present(stiffness)) call locate(stiffness, n, at(4), agree)
    if (present(dissipated)) call locate(dissipated, n, at(5), agree)
    status = MSLIP_BAD_ARRAY_SIZE
    if (agree) status = c_interface_masing_update(n, contacts, at(1), size(states, 1, mslip_size), at(2), displacement, &
      at(2), at(3), at(4), at(5))
  end subroutine interface_masing_update_in_place

  subroutine interface_masing_update_separate(contacts, states, displacement, status, active, force, stiffness, &
    dissipated, states_new)
    !! `mslip_masing_update` of n contacts; the states before the step are kept. Where one is refused, none is updated.
    type(mslip_contact), intent(in) :: contacts(:)  !! n prepared contacts.
    real(mslip_real), intent(in), target, contiguous :: states(:, :)
      !! (state length, n): the state of each contact before the step.
    real(mslip_real), intent(in) :: displacement(:)  !! n displacements at the end of the step, m.
    integer(mslip_int), intent(out) :: status  !! As for `mslip_masing_update`.
    integer(mslip_int), intent(in), optional, target, contiguous :: active(:)
      !! n flags: where 0 the item is skipped, its new state and outputs keep what they held. Absent: none is skipped.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:)  !! n forces, N.
    real(mslip_real), intent(inout), optional, target, contiguous :: stiffness(:)  !! n stiffnesses, N/m.
    real(mslip_real), intent(inout), optional, target, contiguous :: dissipated(:)  !! n energies dissipated by the step, J.
    real(mslip_real), intent(inout), target, contiguous :: states_new(:, :)
      !! (state length, n): the state of each contact after the step; another array than `states`, of the same shape.

    integer(mslip_size) :: n
    type(c_ptr) :: at(6)
    logical :: agree

    n = size(contacts, kind=mslip_size)
    at = c_null_ptr
    agree = size(displacement, kind=mslip_size) == n
    if (present(active)) call locate(active, n, at(1), agree)
    call locate(states, [size(states, 1, mslip_size), n], at(2), agree)
    call locate(states_new, shape(states, mslip_size), at(3), agree)
    if (present(force)) call locate(force, n, at(4), agree)
    if (present(stiffness)) call locate(stiffness, n, at(5), agree)
    if (present(dissipated)) call locate(dissipated, n, at(6), agree)
    status = MSLIP_BAD_ARRAY_SIZE
    if (agree) status = c_interface_masing_update(n, contacts, at(1), size(states, 1, mslip_size), at(2), displacement, &
      at(3), at(4), at(5), at(6))
  end subroutine interface_masing_update_separate

  subroutine mslip_interface_harmonic_force(contacts, workspace, displacement, status, active, force, jacobian, dissipated)
    !! `mslip_harmonic_force` of n contacts, with one workspace.
    type(mslip_contact), intent(in) :: contacts(:)  !! n prepared contacts.
    real(mslip_real), intent(inout), target, contiguous :: workspace(:)
      !! An initialised workspace (`MSLIP_BAD_WORKSPACE`); it decides H.
    real(mslip_real), intent(in) :: displacement(:, :)  !! (2H+1, n): coefficients of each displacement, m.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or what was refused.
    integer(mslip_int), intent(in), optional, target, contiguous :: active(:)
      !! n flags: where 0 the item is skipped and its outputs keep what they held. Absent: none is skipped.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:, :)
      !! (2H+1, n): coefficients of each force, N.
    real(mslip_real), intent(inout), optional, target, contiguous :: jacobian(:, :, :)
      !! (2H+1, 2H+1, n): derivative of force coefficient i by displacement coefficient j of item k in element (i, j, k), N/m.
    real(mslip_real), intent(inout), optional, target, contiguous :: dissipated(:)
      !! n energies dissipated per period, J.

    integer(mslip_size) :: m, n
    type(c_ptr) :: at(4)
    logical :: agree

    call open_workspace(workspace, m, status)
    if (status /= MSLIP_OK) return
    n = size(contacts, kind=mslip_size)
    at = c_null_ptr
    agree = all(shape(displacement, mslip_size) == [m, n])
    if (present(active)) call locate(active, n, at(1), agree)
    if (present(force)) call locate(force, [m, n], at(2), agree)
    if (present(jacobian)) call locate(jacobian, [m, m, n], at(3), agree)
    if (present(dissipated)) call locate(dissipated, n, at(4), agree)
    status = MSLIP_BAD_ARRAY_SIZE
    if (agree) status = c_interface_harmonic_force(n, contacts, at(1), c_loc(workspace(workspace_header + 1)), &
      displacement, at(2), at(3), at(4))
  end subroutine mslip_interface_harmonic_force

  ! ---------------------------------------------------------------------------------------------------------------------
  ! For solvers that know spring-sliders only

  subroutine mslip_jenkins_equivalent(contact, amplitude, stiffness, slip_force, status)
    !! The one spring-slider (Jenkins element) that has the K' and K'' of the contact at an amplitude; at 0 it has the
    !! initial stiffness, and slips at `slip_force`.
    type(mslip_contact), intent(in) :: contact  !! A prepared contact.
    real(mslip_real), intent(in) :: amplitude  !! Amplitude of the displacement, m, 0 to 1e150.
    real(mslip_real), intent(inout) :: stiffness  !! Stiffness of the spring, N/m.
    real(mslip_real), intent(inout) :: slip_force  !! Force at which the slider slips, N.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, or what was refused. Both are 0 for a contact that carries no force.

    status = c_jenkins_equivalent(contact, amplitude, stiffness, slip_force)
  end subroutine mslip_jenkins_equivalent

  subroutine mslip_iwan_equivalent(contact, stiffness, slip_force, status, force_error)
    !! The parallel bank of n >= 1 spring-sliders (Iwan model) with the smallest error of the monotonic force; it follows
    !! any history as the contact does. All numbers are 0 for a contact that carries no force.
    type(mslip_contact), intent(in) :: contact  !! A prepared contact.
    real(mslip_real), intent(inout), target, contiguous :: stiffness(:)  !! Stiffness of each spring, N/m.
    real(mslip_real), intent(inout), target, contiguous :: slip_force(:)
      !! Force at which each slider slips, N; the sum is `slip_force` of the contact.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or what was refused.
    real(mslip_real), intent(inout), optional, target :: force_error
      !! Largest error of the monotonic force, over `slip_force` of the contact.

    status = MSLIP_BAD_ARRAY_SIZE
    if (size(slip_force) /= size(stiffness)) return
    status = c_iwan_equivalent(contact, size(stiffness, kind=mslip_size), address(stiffness), address(slip_force), &
      address_scalar(force_error))
  end subroutine mslip_iwan_equivalent

  ! ---------------------------------------------------------------------------------------------------------------------
  ! Between Fortran and C

  function text_of(text) result(copy)
    ! A C string as Fortran text. Its length is not deferred: with -fno-automatic gfortran 12 returns such a text empty.
    type(c_ptr), intent(in) :: text
    character(len=c_strlen(text)) :: copy

    character(kind=c_char), pointer :: characters(:)
    integer :: i

    call c_f_pointer(text, characters, [len(copy)])
    do i = 1, len(copy)
      copy(i:i) = characters(i)
    end do
  end function text_of

  pure function chosen(rule)
    ! The rule that is given, or the default. A function, because a pure procedure with a local variable is refused where a
    ! compiler is told to keep all of them (-fno-automatic).
    integer(mslip_int), intent(in), optional :: rule
    integer(mslip_int) :: chosen

    chosen = MSLIP_EQUIDISTANT
    if (present(rule)) chosen = rule
  end function chosen

  pure subroutine mark_workspace(workspace, needed, m)
    ! What a workspace begins with: a seal, its length and its number of coefficients, which must agree when they are read.
    real(mslip_real), intent(inout), contiguous :: workspace(:)
    integer(c_int64_t), intent(in) :: needed, m

    workspace(1:workspace_header) = transfer([workspace_seal(needed, m), needed, m], workspace, workspace_header)
  end subroutine mark_workspace

  pure function workspace_seal(needed, m) result(seal)
    integer(c_int64_t), intent(in) :: needed, m
    integer(c_int64_t) :: seal

    seal = ieor(workspace_mark, ieor(needed, ishftc(m, 24)))
  end function workspace_seal

  subroutine open_workspace(workspace, m, status)
    ! The number of coefficients of a workspace. All is read as bits, because what an array holds that was never
    ! initialised may trap as a number.
    real(mslip_real), intent(in) :: workspace(:)
    integer(mslip_size), intent(out) :: m
    integer(mslip_int), intent(out) :: status

    integer(c_int64_t) :: header(workspace_header)

    m = 0
    status = MSLIP_BAD_WORKSPACE
    if (size(workspace) <= workspace_header) return
    header = transfer(workspace(1:workspace_header), header)
    if (header(1) /= workspace_seal(header(2), header(3))) return
    if (size(workspace, kind=mslip_size) < header(2)) then
      status = MSLIP_WORKSPACE_TOO_SHORT
    else
      m = int(header(3), mslip_size)
      status = MSLIP_OK
    end if
  end subroutine open_workspace

  function address_scalar(a) result(at)
    ! C address of an optional number, NULL where it is absent.
    real(mslip_real), intent(in), optional, target :: a
    type(c_ptr) :: at

    at = c_null_ptr
    if (present(a)) at = c_loc(a)
  end function address_scalar

  function address(a) result(at)
    ! C address of an array.
    real(mslip_real), intent(in), target, contiguous :: a(:)
    type(c_ptr) :: at

    at = c_loc(no_elements)
    if (size(a) > 0) at = c_loc(a)
  end function address

  subroutine locate_array(a, n, at, agree)
    real(mslip_real), intent(in), target, contiguous :: a(:)
    integer(mslip_size), intent(in) :: n
    type(c_ptr), intent(out) :: at
    logical, intent(inout) :: agree

    at = address(a)
    agree = agree .and. size(a, kind=mslip_size) == n
  end subroutine locate_array

  subroutine locate_matrix(a, extents, at, agree)
    real(mslip_real), intent(in), target, contiguous :: a(:, :)
    integer(mslip_size), intent(in) :: extents(2)
    type(c_ptr), intent(out) :: at
    logical, intent(inout) :: agree

    at = c_loc(no_elements)
    if (size(a) > 0) at = c_loc(a)
    agree = agree .and. all(shape(a, mslip_size) == extents)
  end subroutine locate_matrix

  subroutine locate_matrices(a, extents, at, agree)
    real(mslip_real), intent(in), target, contiguous :: a(:, :, :)
    integer(mslip_size), intent(in) :: extents(3)
    type(c_ptr), intent(out) :: at
    logical, intent(inout) :: agree

    at = c_loc(no_elements)
    if (size(a) > 0) at = c_loc(a)
    agree = agree .and. all(shape(a, mslip_size) == extents)
  end subroutine locate_matrices

  subroutine locate_flags(a, n, at, agree)
    integer(mslip_int), intent(in), target, contiguous :: a(:)
    integer(mslip_size), intent(in) :: n
    type(c_ptr), intent(out) :: at
    logical, intent(inout) :: agree

    at = c_loc(no_elements)
    if (size(a) > 0) at = c_loc(a)
    agree = agree .and. size(a, kind=mslip_size) == n
  end subroutine locate_flags

end module microslip
