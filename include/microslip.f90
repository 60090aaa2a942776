module microslip
  !! Tangential friction contact with microslip for blade dynamics: the law of M. Allara, "A model for the
  !! characterization of friction contacts in turbine blades", Journal of Sound and Vibration 320 (2009) 527-544. The
  !! equations cited below are those of that paper.
  !!
  !! The module needs a Fortran 2008 compiler and is shipped as source, because module files depend on the compiler:
  !! compile it with the program and link `-lmicroslip -lm`.
  !!
  !! ## Conventions
  !!
  !! **Units.** Any one consistent set; the text names SI. Forces are totals, not per unit length.
  !!
  !! **Signs.** A positive displacement gives a positive force, the internal force of the contact.
  !!
  !! **Arguments.** The order is: required arguments in the order of C, `status`, optional arguments. Lengths are the sizes
  !! of the arrays; all arrays of a call with one value per point have the same size. An optional output that is absent
  !! is not computed. Sections with strides are allowed. But of an associate name, `associate (row => table(1, :))`,
  !! gfortran 12 may lose the stride: pass `table(1, :)` itself.
  !!
  !! **Wrappers.** A procedure of your own may pass its optional dummy arguments on to the module. Declare such arrays
  !! `contiguous` or with explicit shape: gfortran 12, mostly at `-O0`, crashes if any other array is absent. Pass a dummy
  !! argument that is `allocatable` or a `pointer` only if it is `present`: gfortran and flang crash if it is absent. An
  !! unallocated array as actual argument is absent; so is a disassociated `pointer, contiguous`, but of any other
  !! disassociated pointer to an array gfortran reads the shape.
  !!
  !! **Components.** In a type of your own give a component its default, `type(mslip_parameters) :: p = mslip_parameters()`: in a
  !! constructor flang and the standard require a value of a component that has none.
  !!
  !! **Ownership.** All memory is the caller's, and nothing is kept between calls. Contacts, elements, states, workspaces
  !! and tables are plain data: they may be copied, written to restart files and sent through MPI. Components of a contact or
  !! an element are results; do not set them. Memory that comes from outside the process is validated in full by the
  !! procedures named `_check`. Nothing is allocated, except that a batch call copies its `index`, 4 bytes per item, because
  !! it counts from 1 and that of C from 0, and that the compiler copies sections with strides.
  !!
  !! **Aliasing.** An output must not share memory with any other argument. For a step in place there are the procedures
  !! named `_advance`.
  !!
  !! **Threads.** Any thread may call any procedure on its own data. Contacts, elements and tables may be shared; each thread
  !! needs a workspace of its own. `docs/cluster.md` states the stack of a call (`OMP_STACKSIZE`). Do not compile the module with
  !! options that make local variables static (gfortran: `-fno-automatic`) if several threads call it.
  !!
  !! **Errors.** `status` is `MSLIP_OK` or a positive code, explained by `mslip_status_text`. On an error no other argument
  !! is modified. Arrays whose sizes disagree give `MSLIP_BAD_ARRAY_SIZE`. Infinite values and NaN are rejected, and so is
  !! a contact, element, state, workspace or table that was never initialised. A library with another interface than the module
  !! initialises none: `MSLIP_BAD_CONTACT` or `MSLIP_BAD_ELEMENT`.
  !!
  !! **Harmonics.** Fourier coefficients are in the order [c0, cos 1, sin 1, cos 2, sin 2, ...], 2H+1 of them; of an element
  !! component after component: those of the tangential one or two, then those of the normal one. A Jacobian has the derivative of
  !! force coefficient i with respect to displacement coefficient j in element (i, j), column-major: a default NumPy array of the
  !! same memory holds its transpose.
  use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_double, c_f_pointer, c_int32_t, c_loc, c_null_ptr, c_ptr, c_size_t
  implicit none
  private

  public :: mslip_version, mslip_abi_version, mslip_status_text, mslip_parameters_warning, mslip_elliptic_parameters_warning
  public :: mslip_parameters_default, mslip_elliptic_parameters_default
  public :: mslip_face_parts, mslip_harmonic_workspace_size, mslip_element_workspace_size
  ! <generated: public>
  public :: mslip_contact_init, mslip_contact_init_elliptic, mslip_contact_check, mslip_tractions, mslip_slip, &
    mslip_monotonic_displacement, mslip_monotonic_force, mslip_monotonic_sensitivity, mslip_state_length, &
    mslip_state_init, mslip_state_check, mslip_state_error, mslip_masing_update, mslip_masing_advance, &
    mslip_masing_path, mslip_masing_path_advance, mslip_masing_tractions, mslip_hysteresis_loop, &
    mslip_dissipated_energy, mslip_complex_stiffness, mslip_jenkins_equivalent, mslip_iwan_equivalent, &
    mslip_harmonic_workspace_length, mslip_harmonic_workspace_init, mslip_harmonic_force, mslip_harmonic_sensitivity, &
    mslip_batch_complex_stiffness, mslip_batch_masing_update, mslip_batch_masing_advance, mslip_batch_harmonic_force, &
    mslip_element_init, mslip_element_init_elliptic, mslip_element_check, mslip_normal_force, mslip_normal_approach, &
    mslip_element_displacement, mslip_element_state_length, mslip_element_state_init, mslip_element_state_check, &
    mslip_element_state_error, mslip_element_update, mslip_element_advance, mslip_element_path, &
    mslip_element_path_advance, mslip_element_tractions, mslip_element_workspace_length, mslip_element_workspace_init, &
    mslip_element_harmonic_force, mslip_batch_element_update, mslip_batch_element_advance, &
    mslip_batch_element_harmonic_force
  ! </generated>

  integer, parameter, public :: mslip_real = c_double  !! Kind of every real value.
  integer, parameter, public :: mslip_int = c_int32_t  !! Kind of status codes, flags and choices.
  integer, parameter, public :: mslip_size = c_size_t  !! Kind of counts and lengths.

  ! <generated: constants>
  integer(mslip_int), parameter, public :: MSLIP_NULL_POINTER = 1  !! a required pointer is NULL
  integer(mslip_int), parameter, public :: MSLIP_BAD_FLAT_HALF_WIDTH = 2  !! flat_half_width must be finite and >= 0
  integer(mslip_int), parameter, public :: MSLIP_BAD_EDGE_RADIUS = 3  !! edge_radius must be finite and > 0
  integer(mslip_int), parameter, public :: MSLIP_BAD_LENGTH = 4  !! length must be finite and > 0
  integer(mslip_int), parameter, public :: MSLIP_BAD_NORMAL_FORCE = 5
    !! normal_force must be finite and >= 0, in the parameters of an element > 0; so must each step and sample of a
    !! given normal force
  integer(mslip_int), parameter, public :: MSLIP_BAD_FRICTION_COEFFICIENT = 6  !! friction_coefficient must be finite and >= 0
  integer(mslip_int), parameter, public :: MSLIP_BAD_YOUNG_MODULUS = 7  !! each young_modulus must be finite and > 0
  integer(mslip_int), parameter, public :: MSLIP_BAD_POISSON_RATIO = 8  !! each poisson_ratio must be between 0 and 0.5
  integer(mslip_int), parameter, public :: MSLIP_BAD_DISPLACEMENT_REFERENCE = 9
    !! displacement_reference must be MSLIP_RIGID_STRIP, the contact of a machine, or MSLIP_CENTRE_POINT, that of the
    !! paper, 7 to 13 % more compliant
  integer(mslip_int), parameter, public :: MSLIP_BAD_SEMI_AXIS_X = 10  !! semi_axis_x must be finite and > 0
  integer(mslip_int), parameter, public :: MSLIP_BAD_SEMI_AXIS_Y = 11  !! semi_axis_y must be finite and > 0
  integer(mslip_int), parameter, public :: MSLIP_LENGTH_TOO_SHORT = 12
    !! length too small for the half-width b of the contact, or approach or force of an element too large: requires
    !! 2*length > b and a positive initial stiffness
  integer(mslip_int), parameter, public :: MSLIP_OUT_OF_RANGE = 13
    !! parameters out of range: a derived quantity would exceed 1e-150 .. 1e150
  integer(mslip_int), parameter, public :: MSLIP_BAD_NORMAL_COMPLIANCE = 15
    !! normal_compliance of a layer must be finite and >= 0, and under normal_force at most 2^40 times that of the
    !! contact and 0 or 1e-150 .. 1e150
  integer(mslip_int), parameter, public :: MSLIP_BAD_TANGENTIAL_COMPLIANCE = 16
    !! tangential_compliance of a layer must be finite and >= 0, and under normal_force at most 2^40 times that of the
    !! contact and 0 or 1e-150 .. 1e150
  integer(mslip_int), parameter, public :: MSLIP_BAD_STIFFENING_LOAD = 17
    !! stiffening_load of a layer must be 0, infinite, or at least 1e-3 of normal_force
  integer(mslip_int), parameter, public :: MSLIP_BAD_REFERENCE_LOAD = 18
    !! reference_load of a layer must be between 0 (for normal_force) and 1e150; the compliances under normal_force may
    !! be at most 2^40 times those under this load
  integer(mslip_int), parameter, public :: MSLIP_BAD_CONTACT = 20
    !! invalid contact: uninitialised, corrupted, written as text of fewer than 17 digits, or created by an incompatible
    !! version of the library
  integer(mslip_int), parameter, public :: MSLIP_BAD_STATE = 21
    !! invalid state: uninitialised, truncated, corrupted, written as text of too few digits (17 are always enough), or
    !! created by an incompatible version of the library
  integer(mslip_int), parameter, public :: MSLIP_BAD_WORKSPACE = 22
    !! invalid workspace: uninitialised, or created by an incompatible version of the library
  integer(mslip_int), parameter, public :: MSLIP_STATE_TOO_SHORT = 23
    !! state_length must be at least mslip_state_length(0) or mslip_element_state_length(directions, 0)
  integer(mslip_int), parameter, public :: MSLIP_BAD_ELEMENT = 24
    !! invalid element: uninitialised, corrupted, written as text of fewer than 17 digits, or created by an incompatible
    !! version of the library
  integer(mslip_int), parameter, public :: MSLIP_WORKSPACE_TOO_SHORT = 25
    !! workspace_length must be at least mslip_harmonic_workspace_length or mslip_element_workspace_length
  integer(mslip_int), parameter, public :: MSLIP_BAD_FORCE = 30  !! a force must be finite
  integer(mslip_int), parameter, public :: MSLIP_FORCE_EXCEEDS_SLIP = 31  !! a force must not exceed mu N in magnitude
  integer(mslip_int), parameter, public :: MSLIP_BAD_DISPLACEMENT = 32
    !! a displacement must be finite and at most 1e150 in magnitude
  integer(mslip_int), parameter, public :: MSLIP_BAD_POSITION = 33  !! a position x must be finite
  integer(mslip_int), parameter, public :: MSLIP_BAD_AMPLITUDE = 34  !! a displacement amplitude must be between 0 and 1e150
  integer(mslip_int), parameter, public :: MSLIP_BAD_FORCE_AMPLITUDE = 35  !! a force amplitude must be finite and >= 0
  integer(mslip_int), parameter, public :: MSLIP_BAD_HARMONICS = 36  !! the number of harmonics must be between 1 and 2^24
  integer(mslip_int), parameter, public :: MSLIP_BAD_SAMPLES = 37
    !! the number of samples must exceed twice the number of harmonics and be at most 2^24
  integer(mslip_int), parameter, public :: MSLIP_BAD_COUNT = 38  !! the number of sliders must be between 1 and 65536
  integer(mslip_int), parameter, public :: MSLIP_BAD_RULE = 39  !! rule must be MSLIP_UNIFORM_SAMPLING or MSLIP_EVENT_DRIVEN
  integer(mslip_int), parameter, public :: MSLIP_NOT_AVAILABLE = 40
    !! not available for this kind of contact; elements have uniform sampling only; for two directions no tractions
  integer(mslip_int), parameter, public :: MSLIP_BAD_INDEX = 41
    !! an index must refer to one of the n_contacts contacts or n_elements elements
  integer(mslip_int), parameter, public :: MSLIP_BAD_DIRECTIONS = 42
    !! directions must be 1 or 2, equal for all elements, states and workspaces of a call
  integer(mslip_int), parameter, public :: MSLIP_BAD_NORMAL_INPUT = 43
    !! normal_input must be MSLIP_INPUT_APPROACH or MSLIP_INPUT_NORMAL_FORCE
  integer(mslip_int), parameter, public :: MSLIP_BAD_PERIODS = 44  !! the number of periods must be at most 65536
  integer(mslip_int), parameter, public :: MSLIP_BAD_COEFFICIENTS = 45
    !! a displacement must have the number of coefficients of the workspace: 2*harmonics + 1 for each component (in
    !! Fortran)
  integer(mslip_int), parameter, public :: MSLIP_BAD_AREA = 46
    !! each area must be between 0 and 1e50, and that of each part at least 1e-50
  integer(mslip_int), parameter, public :: MSLIP_BAD_PRESSURE = 47
    !! each pressure must be between 0 and 1e50, and the normal force of a face at least 1e-50
  integer(mslip_int), parameter, public :: MSLIP_BAD_ARRAY_SIZE = 90
    !! the shape of an optional argument, a state or a second input does not agree with that of the first input (in
    !! Fortran), or an array is too long to be addressed
  integer(mslip_int), parameter, public :: MSLIP_BAD_ALIGNMENT = 91
    !! misaligned pointer: doubles need 8-byte, int32 flags 4-byte alignment
  integer(mslip_int), parameter, public :: MSLIP_MODULE_ABI_VERSION = 6
    !! Version of this interface: incremented whenever a name, a meaning or a size changes.
  integer(mslip_int), parameter, public :: MSLIP_CENTRE_POINT = 0
    !! Displacement of the centre point under a line of uniform traction: Eq. 5-10 of the paper.
  integer(mslip_int), parameter, public :: MSLIP_RIGID_STRIP = 1
    !! Displacement of a rigid strip, corrected to three-dimensional contact mechanics.
  integer(mslip_int), parameter, public :: MSLIP_UNIFORM_SAMPLING = 0
    !! Harmonic force from uniformly spaced samples of a period; its Jacobian is exact for this discretisation.
  integer(mslip_int), parameter, public :: MSLIP_EVENT_DRIVEN = 1
    !! Harmonic force from Gauss-Legendre nodes between the events: reversals, loop closures, onset of gross slip.
  integer(mslip_int), parameter, public :: MSLIP_INPUT_APPROACH = 16
    !! The normal component of a displacement is the normal approach [m]; if it is not positive, the contact is open.
  integer(mslip_int), parameter, public :: MSLIP_INPUT_NORMAL_FORCE = 17
    !! The normal component of a displacement is the normal force [N] itself.
  integer(mslip_int), parameter, public :: MSLIP_BY_NORMAL_FORCE = 1
    !! Row of a sensitivity: derivative with respect to the normal force N.
  integer(mslip_int), parameter, public :: MSLIP_BY_FRICTION_COEFFICIENT = 2
    !! Derivative with respect to the friction coefficient mu.
  integer(mslip_int), parameter, public :: MSLIP_BY_FLAT_HALF_WIDTH = 3
    !! Derivative with respect to the half-width a of the flat; from above if a = 0.
  integer(mslip_int), parameter, public :: MSLIP_BY_EDGE_RADIUS = 4  !! Derivative with respect to the edge radius R.
  integer(mslip_int), parameter, public :: MSLIP_BY_LENGTH = 5  !! Derivative with respect to the length L.
  integer(mslip_int), parameter, public :: MSLIP_BY_COMPOSITE_MODULUS = 6
    !! Derivative with respect to E* at constant Poisson's ratios and a constant ratio of Young's moduli.
  integer(mslip_int), parameter, public :: MSLIP_BY_LAYER_COMPLIANCE = 7
    !! Derivative with respect to the tangential compliance of the layer under its reference load; without a layer, with
    !! respect to one that is added.
  integer(mslip_int), parameter, public :: MSLIP_PARAMETER_COUNT = 7  !! Number of parameters: rows of a sensitivity.
  integer(mslip_int), parameter, public :: MSLIP_OK = 0  !! Success.
  ! </generated>

  ! Outside the range of every parameter, so that mslip_contact_init rejects a value left unset by name.
  real(mslip_real), parameter :: unset = -2.0_mslip_real

  type, bind(c), public :: mslip_material
    !! Isotropic, linearly elastic material of one body.
    real(mslip_real) :: young_modulus = unset  !! Young's modulus E > 0 [Pa].
    real(mslip_real) :: poisson_ratio = unset  !! Poisson's ratio, 0 to 0.5.
  end type mslip_material

  type, bind(c), public :: mslip_layer
    !! A compliant layer in series with the contact: roughness, a coating, the body around the contact, the rig. It carries the
    !! forces of the contact.
    real(mslip_real) :: normal_compliance = 0
      !! Compliance c_n >= 0 under the reference load [m/N]; 0: none. Not used under a constant normal force.
    real(mslip_real) :: tangential_compliance = 0  !! Compliance c_t >= 0 under the reference load [m/N]; 0: none.
    real(mslip_real) :: stiffening_load = 0
      !! N_c [N], at least 1e-3 of normal_force: the stiffness grows in proportion to N + N_c; 0 or infinite: constant stiffness.
    real(mslip_real) :: reference_load = 0
      !! N_r [N]: the load under which the compliances were measured; 0: normal_force. Under N they are c (N_r + N_c)/(N + N_c).
  end type mslip_layer

  type, bind(c), public :: mslip_parameters
    !! Flat with rounded edges on a flat (Eq. 1-24). `mslip_contact_init` rejects a value left unset.
    real(mslip_real) :: flat_half_width = unset  !! Half-width a >= 0 of the flat [m]; 0 is a Hertzian cylinder.
    real(mslip_real) :: edge_radius = unset
      !! Radius R > 0 of the edges [m]. Eq. 1 is used with twice its printed right-hand side, which alone tends to Hertz's
      !! cylinder as a tends to 0; passing 2R gives the relation as printed.
    real(mslip_real) :: length = unset
      !! Length L along the line of contact [m]; 2L must exceed the half-width b of the contact, and the initial stiffness
      !! must be positive.
    real(mslip_real) :: normal_force = unset  !! Normal force N >= 0 [N]; 0 is an open contact: no force, no stiffness.
    real(mslip_real) :: friction_coefficient = unset  !! Friction coefficient mu >= 0.
    type(mslip_material) :: material(2) = mslip_material()  !! The two bodies.
    type(mslip_layer) :: layer = mslip_layer()  !! A layer in series with the contact; all zero: none.
    integer(mslip_int) :: displacement_reference = -1
      !! `MSLIP_RIGID_STRIP`, corrected to 3-D, for the contact of a machine, or `MSLIP_CENTRE_POINT`, as in the paper.
    integer(mslip_int) :: reserved = 0  !! Not read.
  end type mslip_parameters

  type, bind(c), public :: mslip_elliptic_parameters
    !! Elliptical Hertz contact (section 3.3); a sphere if both semi-axes are equal. `mslip_contact_init_elliptic` rejects a
    !! value left unset.
    real(mslip_real) :: semi_axis_x = unset  !! Semi-axis along the tangential force [m], > 0.
    real(mslip_real) :: semi_axis_y = unset  !! Semi-axis across the tangential force [m], > 0.
    real(mslip_real) :: normal_force = unset  !! Normal force N >= 0 [N]; 0 is an open contact.
    real(mslip_real) :: friction_coefficient = unset  !! Friction coefficient mu >= 0.
    type(mslip_material) :: material(2) = mslip_material()  !! The two bodies.
    type(mslip_layer) :: layer = mslip_layer()  !! A layer in series with the contact; all zero: none.
  end type mslip_elliptic_parameters

  ! The reserved components are public, because `write` rejects types with private ones.
  ! <generated: types>
  type, bind(c), public :: mslip_contact
    !! A contact under a constant normal force: initialised once and only read afterwards. Plain data of fixed size that
    !! may be copied, stored and sent. An open contact (N = 0) has zero width, force and stiffness.
    real(mslip_real) :: composite_modulus = 0  !! E*, Eq. 2 [Pa].
    real(mslip_real) :: half_width = 0  !! Half-width b of the contact under its normal force [m]; elliptical: semi_axis_x.
    real(mslip_real) :: slip_force = 0  !! mu N [N].
    real(mslip_real) :: slip_displacement = 0  !! Displacement at the onset of gross slip on the monotonic curve [m].
    real(mslip_real) :: initial_stiffness = 0  !! Tangent stiffness at zero displacement [N/m].
    real(mslip_real) :: slip_energy = 0  !! Energy dissipated per cycle at incipient gross slip [J].
    real(mslip_real) :: reserved(373) = 0  !! Internal tables.
  end type mslip_contact
  type, bind(c), public :: mslip_element
    !! A friction contact element: the law under a normal force that varies, with separation. Initialised once and only
    !! read afterwards; it serves any number of contact points of its geometry. Plain data of fixed size that may be
    !! copied, stored and sent.
    real(mslip_real) :: composite_modulus = 0  !! E*, Eq. 2 [Pa].
    real(mslip_real) :: friction_coefficient = 0  !! Coulomb's friction coefficient.
    real(mslip_real) :: normal_force = 0  !! The largest normal force that the tables cover [N]; larger ones are exact, but slower.
    real(mslip_real) :: half_width = 0  !! Half-width of the contact under that force [m]; elliptical: the semi-axis x.
    real(mslip_real) :: approach = 0  !! Normal approach under that force [m].
    real(mslip_real) :: normal_stiffness = 0  !! dN/d(approach) under that force [N/m].
    real(mslip_real) :: tangential_stiffness = 0
      !! dT/d(displacement) of a fully stuck contact under that force, x direction [N/m].
    integer(mslip_int) :: directions = 0
      !! Number of tangential directions, 1 or 2: a displacement is [u, w] or [u, v, w], a force [T, N] or [Tx, Ty, N].
    integer(mslip_int) :: normal_input = 0  !! MSLIP_INPUT_APPROACH or MSLIP_INPUT_NORMAL_FORCE.
    real(mslip_real) :: reserved(1853) = 0  !! Internal tables.
  end type mslip_element
  ! </generated>

  ! The address of arrays without elements: c_loc is defined for arrays with elements only.
  real(mslip_real), target :: no_elements(1) = 0

  ! <generated: interfaces>

  interface mslip_monotonic_displacement
    !! Monotonic (initial loading) curve (Eq. 10), odd in the force: displacement [m], compliance [m/N] and stick
    !! half-width [m] at force(n) [N]. At mu N the compliance is infinite for a cylinder and an elliptical contact, and
    !! the stick half-width is that of the flat, a.
    !!
    !! Since 0.1.0 (interface 6).
    module procedure monotonic_displacement_array, monotonic_displacement_scalar
  end interface mslip_monotonic_displacement

  interface mslip_monotonic_force
    !! Inverse of the monotonic curve, odd in the displacement: force [N], stiffness [N/m] and stick half-width [m] at
    !! displacement(n) [m]. At slip_displacement the stick half-width is a, as at mu N; beyond, the force stays at mu N,
    !! and stiffness and stick half-width are 0.
    !!
    !! Since 0.1.0 (interface 6).
    module procedure monotonic_force_array, monotonic_force_scalar
  end interface mslip_monotonic_force

  interface mslip_dissipated_energy
    !! Energy [J] dissipated per cycle between +- force_amplitude(n) [N], each from 0 to mu N (Eq. 13-16).
    !!
    !! Since 0.1.0 (interface 6).
    module procedure dissipated_energy_array, dissipated_energy_scalar
  end interface mslip_dissipated_energy

  interface mslip_complex_stiffness
    !! Complex (harmonic) stiffness K' + iK'' [N/m] at displacement amplitude(n) >= 0 [m] and its derivatives with
    !! respect to the amplitude [N/m^2] (section 3.4); at amplitude 0: the initial stiffness.
    !!
    !! Since 0.1.0 (interface 6).
    module procedure complex_stiffness_array, complex_stiffness_scalar
  end interface mslip_complex_stiffness

  interface mslip_normal_force
    !! The normal law: normal force [N], normal stiffness [N/m] and half-width of the contact [m] at approach(n) [m]. An
    !! approach <= 0 gives 0, 0, 0.
    !!
    !! Since 0.1.0 (interface 6).
    module procedure normal_force_array, normal_force_scalar
  end interface mslip_normal_force

  interface mslip_normal_approach
    !! The inverse normal law: approach [m], compliance [m/N] and half-width [m] under normal_force(n) [N]. At 0 the
    !! compliance of a cylinder and of an ellipse is infinite.
    !!
    !! Since 0.1.0 (interface 6).
    module procedure normal_approach_array, normal_approach_scalar
  end interface mslip_normal_approach

  interface mslip_element_displacement
    !! The monotonic curve of an element at a constant normal force: the displacement [m] that carries force(n) [N], at
    !! most mu N in magnitude, under normal_force(n) [N], and the compliance [m/N] there, in the direction 0 (x) or, of
    !! an element with two directions, 1 (y). At mu N the compliance of a cylinder and of an ellipse is infinite; so it
    !! is without friction and without a normal force.
    !!
    !! Since 0.1.0 (interface 6).
    module procedure element_displacement_array, element_displacement_scalar
  end interface mslip_element_displacement
  ! </generated>

  interface address_of
    ! C address of a required array, or of an optional scalar: NULL if absent.
    module procedure address_of_array, address_of_scalar
  end interface address_of

  interface check_array
    ! C address of an array, and MSLIP_BAD_ARRAY_SIZE for another shape than the required one. To be called for the
    ! optional arrays that are present only: if an absent one is handed on, sanitizers report the use of a NULL pointer.
    module procedure check_vector, check_matrix, check_matrices, check_flags
  end interface check_array

  interface
    pure function c_strlen(text) bind(c, name='strlen') result(length)
      import :: c_ptr, c_size_t
      type(c_ptr), value, intent(in) :: text
      integer(c_size_t) :: length
    end function c_strlen
  end interface

  ! <generated: functions>
  interface

    pure type(c_ptr) function c_version() bind(c, name='mslip_version')
      import
    end function c_version

    pure integer(c_int32_t) function c_abi_version() bind(c, name='mslip_abi_version')
      import
    end function c_abi_version

    pure type(c_ptr) function c_status_text(status) bind(c, name='mslip_status_text')
      import
      integer(c_int32_t), value :: status
    end function c_status_text

    subroutine c_parameters_default(p) bind(c, name='mslip_parameters_default')
      import
      type(mslip_parameters), intent(inout) :: p
    end subroutine c_parameters_default

    subroutine c_elliptic_parameters_default(p) bind(c, name='mslip_elliptic_parameters_default')
      import
      type(mslip_elliptic_parameters), intent(inout) :: p
    end subroutine c_elliptic_parameters_default

    pure type(c_ptr) function c_parameters_warning(p, i) bind(c, name='mslip_parameters_warning')
      import
      type(mslip_parameters), intent(in) :: p
      integer(c_int32_t), value :: i
    end function c_parameters_warning

    pure type(c_ptr) function c_elliptic_parameters_warning(p, i) bind(c, name='mslip_elliptic_parameters_warning')
      import
      type(mslip_elliptic_parameters), intent(in) :: p
      integer(c_int32_t), value :: i
    end function c_elliptic_parameters_warning

    integer(c_int32_t) function c_contact_init(p, contact) bind(c, name='mslip_contact_init')
      import
      type(mslip_parameters), intent(in) :: p
      type(mslip_contact), intent(inout) :: contact
    end function c_contact_init

    integer(c_int32_t) function c_contact_init_elliptic(p, contact) bind(c, name='mslip_contact_init_elliptic')
      import
      type(mslip_elliptic_parameters), intent(in) :: p
      type(mslip_contact), intent(inout) :: contact
    end function c_contact_init_elliptic

    integer(c_int32_t) function c_face_parts(p, n, pairs, area, pressure, parts, weight) &
      bind(c, name='mslip_face_parts')
      import
      type(mslip_parameters), intent(in) :: p
      integer(c_size_t), value :: n, pairs
      real(c_double), intent(in) :: area(*), pressure(*)
      type(mslip_parameters), intent(inout) :: parts(*)
      type(c_ptr), value :: weight
    end function c_face_parts

    integer(c_int32_t) function c_contact_check(contact) bind(c, name='mslip_contact_check')
      import
      type(mslip_contact), intent(in) :: contact
    end function c_contact_check

    integer(c_int32_t) function c_tractions(contact, force, n, x, pressure, shear) bind(c, name='mslip_tractions')
      import
      type(mslip_contact), intent(in) :: contact
      real(c_double), value :: force
      integer(c_size_t), value :: n
      real(c_double), intent(in) :: x(*)
      type(c_ptr), value :: pressure, shear
    end function c_tractions

    integer(c_int32_t) function c_slip(contact, force, n, x, slip, damage) bind(c, name='mslip_slip')
      import
      type(mslip_contact), intent(in) :: contact
      real(c_double), value :: force
      integer(c_size_t), value :: n
      real(c_double), intent(in) :: x(*)
      type(c_ptr), value :: slip, damage
    end function c_slip

    integer(c_int32_t) function c_monotonic_displacement(contact, n, force, displacement, compliance, &
      stick_half_width) bind(c, name='mslip_monotonic_displacement')
      import
      type(mslip_contact), intent(in) :: contact
      integer(c_size_t), value :: n
      real(c_double), intent(in) :: force(*)
      type(c_ptr), value :: displacement, compliance, stick_half_width
    end function c_monotonic_displacement

    integer(c_int32_t) function c_monotonic_force(contact, n, displacement, force, stiffness, stick_half_width) &
      bind(c, name='mslip_monotonic_force')
      import
      type(mslip_contact), intent(in) :: contact
      integer(c_size_t), value :: n
      real(c_double), intent(in) :: displacement(*)
      type(c_ptr), value :: force, stiffness, stick_half_width
    end function c_monotonic_force

    integer(c_int32_t) function c_monotonic_sensitivity(contact, n, displacement, force, sensitivity) &
      bind(c, name='mslip_monotonic_sensitivity')
      import
      type(mslip_contact), intent(in) :: contact
      integer(c_size_t), value :: n
      real(c_double), intent(in) :: displacement(*)
      type(c_ptr), value :: force, sensitivity
    end function c_monotonic_sensitivity

    pure integer(c_size_t) function c_state_length(reversals) bind(c, name='mslip_state_length')
      import
      integer(c_size_t), value :: reversals
    end function c_state_length

    integer(c_int32_t) function c_state_init(state_length, state) bind(c, name='mslip_state_init')
      import
      integer(c_size_t), value :: state_length
      type(c_ptr), value :: state
    end function c_state_init

    integer(c_int32_t) function c_state_check(state_length, state) bind(c, name='mslip_state_check')
      import
      integer(c_size_t), value :: state_length
      real(c_double), intent(in) :: state(*)
    end function c_state_check

    integer(c_int32_t) function c_state_error(state_length, state, force_error) bind(c, name='mslip_state_error')
      import
      integer(c_size_t), value :: state_length
      real(c_double), intent(in) :: state(*)
      type(c_ptr), value :: force_error
    end function c_state_error

    integer(c_int32_t) function c_masing_update(contact, state_length, state_old, displacement, state_new, force, &
      stiffness, dissipated) bind(c, name='mslip_masing_update')
      import
      type(mslip_contact), intent(in) :: contact
      integer(c_size_t), value :: state_length
      type(c_ptr), value :: state_old, state_new, force, stiffness, dissipated
      real(c_double), value :: displacement
    end function c_masing_update

    integer(c_int32_t) function c_masing_path(contact, state_length, state_old, n, displacement, state_new, force, &
      stiffness, dissipated) bind(c, name='mslip_masing_path')
      import
      type(mslip_contact), intent(in) :: contact
      integer(c_size_t), value :: state_length, n
      type(c_ptr), value :: state_old, state_new, force, stiffness, dissipated
      real(c_double), intent(in) :: displacement(*)
    end function c_masing_path

    integer(c_int32_t) function c_masing_tractions(contact, state_length, state, n, x, pressure, shear) &
      bind(c, name='mslip_masing_tractions')
      import
      type(mslip_contact), intent(in) :: contact
      integer(c_size_t), value :: state_length, n
      real(c_double), intent(in) :: state(*), x(*)
      type(c_ptr), value :: pressure, shear
    end function c_masing_tractions

    integer(c_int32_t) function c_hysteresis_loop(contact, amplitude, n, displacement, force) &
      bind(c, name='mslip_hysteresis_loop')
      import
      type(mslip_contact), intent(in) :: contact
      real(c_double), value :: amplitude
      integer(c_size_t), value :: n
      type(c_ptr), value :: displacement, force
    end function c_hysteresis_loop

    integer(c_int32_t) function c_dissipated_energy(contact, n, force_amplitude, energy) &
      bind(c, name='mslip_dissipated_energy')
      import
      type(mslip_contact), intent(in) :: contact
      integer(c_size_t), value :: n
      real(c_double), intent(in) :: force_amplitude(*)
      type(c_ptr), value :: energy
    end function c_dissipated_energy

    integer(c_int32_t) function c_complex_stiffness(contact, n, amplitude, k_real, k_imag, dk_real, dk_imag) &
      bind(c, name='mslip_complex_stiffness')
      import
      type(mslip_contact), intent(in) :: contact
      integer(c_size_t), value :: n
      real(c_double), intent(in) :: amplitude(*)
      type(c_ptr), value :: k_real, k_imag, dk_real, dk_imag
    end function c_complex_stiffness

    integer(c_int32_t) function c_jenkins_equivalent(contact, amplitude, stiffness, slip_force) &
      bind(c, name='mslip_jenkins_equivalent')
      import
      type(mslip_contact), intent(in) :: contact
      real(c_double), value :: amplitude
      type(c_ptr), value :: stiffness, slip_force
    end function c_jenkins_equivalent

    integer(c_int32_t) function c_iwan_equivalent(contact, n, stiffness, slip_force, force_error) &
      bind(c, name='mslip_iwan_equivalent')
      import
      type(mslip_contact), intent(in) :: contact
      integer(c_size_t), value :: n
      type(c_ptr), value :: stiffness, slip_force, force_error
    end function c_iwan_equivalent

    pure integer(c_size_t) function c_harmonic_workspace_length(harmonics, samples, rule) &
      bind(c, name='mslip_harmonic_workspace_length')
      import
      integer(c_size_t), value :: harmonics, samples
      integer(c_int32_t), value :: rule
    end function c_harmonic_workspace_length

    integer(c_int32_t) function c_harmonic_workspace_init(harmonics, samples, rule, workspace_length, workspace) &
      bind(c, name='mslip_harmonic_workspace_init')
      import
      integer(c_size_t), value :: harmonics, samples, workspace_length
      integer(c_int32_t), value :: rule
      type(c_ptr), value :: workspace
    end function c_harmonic_workspace_init

    integer(c_int32_t) function c_harmonic_workspace_size(workspace, harmonics, samples, rule) &
      bind(c, name='mslip_harmonic_workspace_size')
      import
      real(c_double), intent(in) :: workspace(*)
      type(c_ptr), value :: harmonics, samples, rule
    end function c_harmonic_workspace_size

    pure integer(c_size_t) function c_element_workspace_length(directions, harmonics, samples, rule) &
      bind(c, name='mslip_element_workspace_length')
      import
      integer(c_int32_t), value :: directions, rule
      integer(c_size_t), value :: harmonics, samples
    end function c_element_workspace_length

    integer(c_int32_t) function c_element_workspace_init(directions, harmonics, samples, rule, periods, &
      workspace_length, workspace) bind(c, name='mslip_element_workspace_init')
      import
      integer(c_int32_t), value :: directions, rule
      integer(c_size_t), value :: harmonics, samples, periods, workspace_length
      type(c_ptr), value :: workspace
    end function c_element_workspace_init

    integer(c_int32_t) function c_element_workspace_size(workspace, directions, harmonics, samples, rule, periods) &
      bind(c, name='mslip_element_workspace_size')
      import
      real(c_double), intent(in) :: workspace(*)
      type(c_ptr), value :: directions, harmonics, samples, rule, periods
    end function c_element_workspace_size

    integer(c_int32_t) function c_element_harmonic_force(element, workspace, displacement, force, jacobian, &
      dissipated, drift) bind(c, name='mslip_element_harmonic_force')
      import
      type(mslip_element), intent(in) :: element
      type(c_ptr), value :: workspace, force, jacobian, dissipated, drift
      real(c_double), intent(in) :: displacement(*)
    end function c_element_harmonic_force

    integer(c_int32_t) function c_harmonic_force(contact, workspace, displacement, force, jacobian, dissipated) &
      bind(c, name='mslip_harmonic_force')
      import
      type(mslip_contact), intent(in) :: contact
      type(c_ptr), value :: workspace, force, jacobian, dissipated
      real(c_double), intent(in) :: displacement(*)
    end function c_harmonic_force

    integer(c_int32_t) function c_harmonic_sensitivity(contact, workspace, displacement, force, sensitivity) &
      bind(c, name='mslip_harmonic_sensitivity')
      import
      type(mslip_contact), intent(in) :: contact
      type(c_ptr), value :: workspace, force, sensitivity
      real(c_double), intent(in) :: displacement(*)
    end function c_harmonic_sensitivity

    integer(c_int32_t) function c_element_init(p, directions, normal_input, element) &
      bind(c, name='mslip_element_init')
      import
      type(mslip_parameters), intent(in) :: p
      integer(c_int32_t), value :: directions, normal_input
      type(mslip_element), intent(inout) :: element
    end function c_element_init

    integer(c_int32_t) function c_element_init_elliptic(p, directions, normal_input, element) &
      bind(c, name='mslip_element_init_elliptic')
      import
      type(mslip_elliptic_parameters), intent(in) :: p
      integer(c_int32_t), value :: directions, normal_input
      type(mslip_element), intent(inout) :: element
    end function c_element_init_elliptic

    integer(c_int32_t) function c_element_check(element) bind(c, name='mslip_element_check')
      import
      type(mslip_element), intent(in) :: element
    end function c_element_check

    integer(c_int32_t) function c_normal_force(element, n, approach, normal_force, stiffness, half_width) &
      bind(c, name='mslip_normal_force')
      import
      type(mslip_element), intent(in) :: element
      integer(c_size_t), value :: n
      real(c_double), intent(in) :: approach(*)
      type(c_ptr), value :: normal_force, stiffness, half_width
    end function c_normal_force

    integer(c_int32_t) function c_normal_approach(element, n, normal_force, approach, compliance, half_width) &
      bind(c, name='mslip_normal_approach')
      import
      type(mslip_element), intent(in) :: element
      integer(c_size_t), value :: n
      real(c_double), intent(in) :: normal_force(*)
      type(c_ptr), value :: approach, compliance, half_width
    end function c_normal_approach

    integer(c_int32_t) function c_element_displacement(element, direction, n, force, normal_force, displacement, &
      compliance) bind(c, name='mslip_element_displacement')
      import
      type(mslip_element), intent(in) :: element
      integer(c_int32_t), value :: direction
      integer(c_size_t), value :: n
      real(c_double), intent(in) :: force(*), normal_force(*)
      type(c_ptr), value :: displacement, compliance
    end function c_element_displacement

    pure integer(c_size_t) function c_element_state_length(directions, pieces) &
      bind(c, name='mslip_element_state_length')
      import
      integer(c_int32_t), value :: directions
      integer(c_size_t), value :: pieces
    end function c_element_state_length

    integer(c_int32_t) function c_element_state_init(directions, state_length, state) &
      bind(c, name='mslip_element_state_init')
      import
      integer(c_int32_t), value :: directions
      integer(c_size_t), value :: state_length
      type(c_ptr), value :: state
    end function c_element_state_init

    integer(c_int32_t) function c_element_state_check(directions, state_length, state) &
      bind(c, name='mslip_element_state_check')
      import
      integer(c_int32_t), value :: directions
      integer(c_size_t), value :: state_length
      real(c_double), intent(in) :: state(*)
    end function c_element_state_check

    integer(c_int32_t) function c_element_state_error(directions, state_length, state, force_error) &
      bind(c, name='mslip_element_state_error')
      import
      integer(c_int32_t), value :: directions
      integer(c_size_t), value :: state_length
      real(c_double), intent(in) :: state(*)
      type(c_ptr), value :: force_error
    end function c_element_state_error

    integer(c_int32_t) function c_element_update(element, state_length, state_old, displacement, state_new, force, &
      tangent, dissipated) bind(c, name='mslip_element_update')
      import
      type(mslip_element), intent(in) :: element
      integer(c_size_t), value :: state_length
      type(c_ptr), value :: state_old, state_new, force, tangent, dissipated
      real(c_double), intent(in) :: displacement(*)
    end function c_element_update

    integer(c_int32_t) function c_element_path(element, state_length, state_old, n, displacement, state_new, force, &
      tangent, dissipated) bind(c, name='mslip_element_path')
      import
      type(mslip_element), intent(in) :: element
      integer(c_size_t), value :: state_length, n
      type(c_ptr), value :: state_old, state_new, force, tangent, dissipated
      real(c_double), intent(in) :: displacement(*)
    end function c_element_path

    integer(c_int32_t) function c_element_tractions(element, state_length, state, n, x, pressure, shear) &
      bind(c, name='mslip_element_tractions')
      import
      type(mslip_element), intent(in) :: element
      integer(c_size_t), value :: state_length, n
      real(c_double), intent(in) :: state(*), x(*)
      type(c_ptr), value :: pressure, shear
    end function c_element_tractions

    integer(c_int32_t) function c_batch_complex_stiffness(n, n_contacts, contacts, index, active, amplitude, k_real, &
      k_imag, dk_real, dk_imag, failed_item) bind(c, name='mslip_batch_complex_stiffness')
      import
      integer(c_size_t), value :: n, n_contacts
      type(mslip_contact), intent(in) :: contacts(*)
      type(c_ptr), value :: index, active, k_real, k_imag, dk_real, dk_imag, failed_item
      real(c_double), intent(in) :: amplitude(*)
    end function c_batch_complex_stiffness

    integer(c_int32_t) function c_batch_masing_update(n, n_contacts, contacts, index, active, state_length, &
      states_old, displacement, states_new, force, stiffness, dissipated, failed_item) &
      bind(c, name='mslip_batch_masing_update')
      import
      integer(c_size_t), value :: n, n_contacts, state_length
      type(mslip_contact), intent(in) :: contacts(*)
      type(c_ptr), value :: index, active, states_old, states_new, force, stiffness, dissipated, failed_item
      real(c_double), intent(in) :: displacement(*)
    end function c_batch_masing_update

    integer(c_int32_t) function c_batch_harmonic_force(n, n_contacts, contacts, index, active, workspace, &
      displacement, force, jacobian, dissipated, failed_item) bind(c, name='mslip_batch_harmonic_force')
      import
      integer(c_size_t), value :: n, n_contacts
      type(mslip_contact), intent(in) :: contacts(*)
      type(c_ptr), value :: index, active, workspace, force, jacobian, dissipated, failed_item
      real(c_double), intent(in) :: displacement(*)
    end function c_batch_harmonic_force

    integer(c_int32_t) function c_batch_element_update(n, n_elements, elements, index, active, state_length, &
      states_old, displacement, states_new, force, tangent, dissipated, failed_item) &
      bind(c, name='mslip_batch_element_update')
      import
      integer(c_size_t), value :: n, n_elements, state_length
      type(mslip_element), intent(in) :: elements(*)
      type(c_ptr), value :: index, active, states_old, states_new, force, tangent, dissipated, failed_item
      real(c_double), intent(in) :: displacement(*)
    end function c_batch_element_update

    integer(c_int32_t) function c_batch_element_harmonic_force(n, n_elements, elements, index, active, workspace, &
      displacement, force, jacobian, dissipated, drift, failed_item) &
      bind(c, name='mslip_batch_element_harmonic_force')
      import
      integer(c_size_t), value :: n, n_elements
      type(mslip_element), intent(in) :: elements(*)
      type(c_ptr), value :: index, active, workspace, force, jacobian, dissipated, drift, failed_item
      real(c_double), intent(in) :: displacement(*)
    end function c_batch_element_harmonic_force

  end interface
  ! </generated>

contains

  ! ---------------------------------------------------------------------------------------------------------------------
  ! Version and status

  function mslip_version() result(text)
    !! Version of the linked library, such as "1.2.3".
    !!
    !! Since 0.1.0 (interface 6).
    character(len=c_strlen(c_version())) :: text  !! The text, without blanks around it.

    text = text_of(c_version())
  end function mslip_version

  pure function mslip_abi_version() result(version)
    !! Interface version of the linked library. The library belongs to the module if this equals
    !! `MSLIP_MODULE_ABI_VERSION`.
    !!
    !! Since 0.1.0 (interface 6).
    integer(mslip_int) :: version  !! Interface version, > 0.

    version = c_abi_version()
  end function mslip_abi_version

  function mslip_status_text(status) result(text)
    !! The message of a status code: what is wrong and what is allowed. Any value is accepted.
    !!
    !! Since 0.1.0 (interface 6).
    integer(mslip_int), intent(in) :: status  !! A status code.
    character(len=c_strlen(c_status_text(status))) :: text  !! The text, without blanks around it.

    text = text_of(c_status_text(status))
  end function mslip_status_text

  pure function length_of(text) result(length)
    ! 0 without a text. It stands before its use: otherwise gfortran takes its interface for an implicit one.
    type(c_ptr), intent(in) :: text
    integer(c_size_t) :: length

    length = 0
    if (c_associated(text)) length = c_strlen(text)
  end function length_of

  function mslip_parameters_warning(parameters, i) result(text)
    !! Warning i >= 1 of parameters that are valid but implausible: another unit, an exchanged pair, a contact for which the
    !! model is inaccurate. Empty if there are no more. Lengths are in m and moduli in Pa, or in mm and MPa if both moduli are at
    !! most 1.3e6.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_parameters), intent(in) :: parameters  !! The parameters; any value is accepted.
    integer(mslip_int), intent(in) :: i  !! Number of the warning.
    character(len=length_of(c_parameters_warning(parameters, i - 1_mslip_int))) :: text  !! The text, without blanks around it.

    text = ''
    if (len(text) > 0) text = text_of(c_parameters_warning(parameters, i - 1_mslip_int))
  end function mslip_parameters_warning

  function mslip_elliptic_parameters_warning(parameters, i) result(text)
    !! Warning i >= 1 of the parameters of an elliptical contact, as `mslip_parameters_warning`.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_elliptic_parameters), intent(in) :: parameters  !! The parameters; any value is accepted.
    integer(mslip_int), intent(in) :: i  !! Number of the warning.
    character(len=length_of(c_elliptic_parameters_warning(parameters, i - 1_mslip_int))) :: text  !! As above.

    text = ''
    if (len(text) > 0) text = text_of(c_elliptic_parameters_warning(parameters, i - 1_mslip_int))
  end function mslip_elliptic_parameters_warning

  ! ---------------------------------------------------------------------------------------------------------------------
  ! Defaults, parts of a face, and sizes of workspaces

  subroutine mslip_parameters_default(parameters)
    !! Every value unset (NaN, the displacement reference -1), so that a forgotten one is rejected by name.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_parameters), intent(out) :: parameters  !! The parameters to reset.

    call c_parameters_default(parameters)
  end subroutine mslip_parameters_default

  subroutine mslip_elliptic_parameters_default(parameters)
    !! Every value unset (NaN, so that a forgotten one is rejected by name).
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_elliptic_parameters), intent(out) :: parameters  !! The parameters to reset.

    call c_elliptic_parameters_default(parameters)
  end subroutine mslip_elliptic_parameters_default

  subroutine mslip_face_parts(parameters, area, pressure, parts, status, weight)
    !! Divides a face with an uneven pressure along its length into n parts, each with a normal force of its own: `parts` are the
    !! parameters of their contacts or elements, whose forces add up to that of the face. A part is a row of pairs of opposite
    !! nodes in the direction of motion. The displacements of a part are the sums of those of its pairs times `weight`, and a pair
    !! carries its weight times the forces of the part.
    !!
    !! The `normal_force` of the whole face is not read: it is the sum of pressures times areas, also for a layer whose
    !! `reference_load` is 0. A part whose normal force is below 1e-50 is open: its `normal_force` is 0, its weights are in
    !! proportion to the areas, and it does not count in the length. An element requires a `normal_force` > 0, the largest in its
    !! motion: set that of each part before `mslip_element_init`.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_parameters), intent(in) :: parameters  !! Geometry and materials of the whole face.
    real(mslip_real), intent(in) :: area(:, :)  !! (pairs, n): area of each pair [m2]; 0 fills up a shorter row.
    real(mslip_real), intent(in) :: pressure(:, :)  !! (pairs, n): pressure at each pair [Pa], >= 0.
    type(mslip_parameters), intent(inout) :: parts(:)  !! (n): the parameters of each part.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, `MSLIP_BAD_AREA`, `MSLIP_BAD_PRESSURE`, the code of the first other parameter that is invalid, or
      !! `MSLIP_OUT_OF_RANGE`.
    real(mslip_real), intent(inout), optional, target, contiguous :: weight(:, :)  !! (pairs, n): share of each pair in its part.

    integer(mslip_size) :: pairs, n
    type(c_ptr) :: ptr

    pairs = size(area, 1, mslip_size)
    n = size(area, 2, mslip_size)
    ptr = c_null_ptr
    status = MSLIP_OK
    if (present(weight)) call check_array(weight, [pairs, n], ptr, status)
    if (any(shape(pressure) /= shape(area)) .or. size(parts) /= n) status = MSLIP_BAD_ARRAY_SIZE
    if (status == MSLIP_OK) status = c_face_parts(parameters, n, pairs, area, pressure, parts, ptr)
  end subroutine mslip_face_parts

  subroutine mslip_harmonic_workspace_size(workspace, harmonics, samples, rule, status)
    !! The arguments with which a workspace was initialised.
    !!
    !! Since 0.1.0 (interface 6).
    real(mslip_real), intent(in), contiguous :: workspace(:)  !! An initialised workspace.
    integer(mslip_size), intent(inout) :: harmonics  !! Highest harmonic H.
    integer(mslip_size), intent(inout) :: samples  !! Samples per period.
    integer(mslip_int), intent(inout) :: rule  !! `MSLIP_UNIFORM_SAMPLING` or `MSLIP_EVENT_DRIVEN`.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, `MSLIP_BAD_WORKSPACE` or `MSLIP_WORKSPACE_TOO_SHORT`.

    integer(mslip_size), target :: sizes(2)
    integer(mslip_int), target :: its_rule
    integer(mslip_size) :: n

    n = size(workspace, kind=mslip_size)
    status = MSLIP_WORKSPACE_TOO_SHORT
    ! C reads the header, which the shortest workspace contains.
    if (n < c_harmonic_workspace_length(1_mslip_size, 3_mslip_size, MSLIP_UNIFORM_SAMPLING)) return
    status = c_harmonic_workspace_size(workspace, c_loc(sizes(1)), c_loc(sizes(2)), c_loc(its_rule))
    if (status /= MSLIP_OK) return
    if (n < c_harmonic_workspace_length(sizes(1), sizes(2), its_rule)) then
      status = MSLIP_WORKSPACE_TOO_SHORT
      return
    end if
    harmonics = sizes(1)
    samples = sizes(2)
    rule = its_rule
  end subroutine mslip_harmonic_workspace_size

  subroutine mslip_element_workspace_size(workspace, directions, harmonics, samples, rule, periods, status)
    !! The arguments with which a workspace of elements was initialised.
    !!
    !! Since 0.1.0 (interface 6).
    real(mslip_real), intent(in), contiguous :: workspace(:)  !! An initialised workspace.
    integer(mslip_int), intent(inout) :: directions  !! Number of tangential directions.
    integer(mslip_size), intent(inout) :: harmonics  !! Highest harmonic H.
    integer(mslip_size), intent(inout) :: samples  !! Samples per period.
    integer(mslip_int), intent(inout) :: rule  !! `MSLIP_UNIFORM_SAMPLING`.
    integer(mslip_size), intent(inout) :: periods  !! Periods before the one that counts, > 0.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, `MSLIP_BAD_WORKSPACE` or `MSLIP_WORKSPACE_TOO_SHORT`.

    integer(mslip_size), target :: sizes(3)
    integer(mslip_int), target :: kinds(2)
    integer(mslip_size) :: n

    n = size(workspace, kind=mslip_size)
    status = MSLIP_WORKSPACE_TOO_SHORT
    ! C reads the header, which the shortest workspaces contain.
    if (n < min(c_element_workspace_length(1_mslip_int, 1_mslip_size, 3_mslip_size, MSLIP_UNIFORM_SAMPLING), &
      c_element_workspace_length(2_mslip_int, 1_mslip_size, 3_mslip_size, MSLIP_UNIFORM_SAMPLING))) return
    status = c_element_workspace_size(workspace, c_loc(kinds(1)), c_loc(sizes(1)), c_loc(sizes(2)), c_loc(kinds(2)), &
      c_loc(sizes(3)))
    if (status /= MSLIP_OK) return
    if (n < c_element_workspace_length(kinds(1), sizes(1), sizes(2), kinds(2))) then
      status = MSLIP_WORKSPACE_TOO_SHORT
      return
    end if
    directions = kinds(1)
    harmonics = sizes(1)
    samples = sizes(2)
    rule = kinds(2)
    periods = sizes(3)
  end subroutine mslip_element_workspace_size

  ! <generated: procedures>

  ! ---------------------------------------------------------------------------------------------------------------------
  ! Parameters and contacts

  subroutine mslip_contact_init(parameters, contact, status)
    !! Initialises the contact of a flat with rounded edges, or of a cylinder (Eq. 1, 2, 10).
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_parameters), intent(in) :: parameters  !! Geometry, load and materials.
    type(mslip_contact), intent(inout) :: contact  !! The contact.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, the code of the first invalid parameter, MSLIP_LENGTH_TOO_SHORT or MSLIP_OUT_OF_RANGE; the contact
      !! is unchanged then.

    status = MSLIP_BAD_CONTACT
    if (c_abi_version() == MSLIP_MODULE_ABI_VERSION) status = c_contact_init(parameters, contact)
  end subroutine mslip_contact_init

  subroutine mslip_contact_init_elliptic(parameters, contact, status)
    !! Initialises an elliptical Hertz contact (section 3.3); a sphere if both semi-axes are equal.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_elliptic_parameters), intent(in) :: parameters  !! Geometry, load and materials.
    type(mslip_contact), intent(inout) :: contact  !! The contact.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, the code of the first invalid parameter, or MSLIP_OUT_OF_RANGE; the contact is unchanged then.

    status = MSLIP_BAD_CONTACT
    if (c_abi_version() == MSLIP_MODULE_ABI_VERSION) status = c_contact_init_elliptic(parameters, contact)
  end subroutine mslip_contact_init_elliptic

  subroutine mslip_contact_check(contact, status)
    !! Validates a contact that was read from a file or a message: its checksum must be that written at initialisation,
    !! which detects any single changed bit. Text needs 17 digits; initialise it again instead. Other functions only
    !! check a tag.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_contact), intent(in) :: contact  !! The contact.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or MSLIP_BAD_CONTACT.

    status = c_contact_check(contact)
  end subroutine mslip_contact_check

  ! ---------------------------------------------------------------------------------------------------------------------
  ! Monotonic loading

  subroutine mslip_tractions(contact, force, x, status, pressure, shear)
    !! Tractions [Pa] at x(n) [m] along the width, under a monotonically increasing force [N] (Eq. 17, 21-24); 0 outside
    !! the contact. Elliptical: on the x axis.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_contact), intent(in) :: contact  !! An initialised contact.
    real(mslip_real), intent(in) :: force  !! Tangential force [N]; its magnitude is at most `slip_force`.
    real(mslip_real), intent(in) :: x(:)  !! Positions from the centre [m].
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE, MSLIP_FORCE_EXCEEDS_SLIP or MSLIP_BAD_POSITION.
    real(mslip_real), intent(inout), optional, target, contiguous :: pressure(:)  !! Pressure at each x [Pa].
    real(mslip_real), intent(inout), optional, target, contiguous :: shear(:)  !! Shear traction at each x [Pa].

    integer(mslip_size) :: n
    type(c_ptr) :: ptr(2)

    n = size(x, kind=mslip_size)
    ptr = c_null_ptr
    status = MSLIP_OK
    if (present(pressure)) call check_array(pressure, n, ptr(1), status)
    if (present(shear)) call check_array(shear, n, ptr(2), status)
    if (status == MSLIP_OK) status = c_tractions(contact, force, n, x, ptr(1), ptr(2))
  end subroutine mslip_tractions

  subroutine mslip_slip(contact, force, x, status, slip, damage)
    !! Relative slip [m] (Eq. 15) and frictional damage parameter mu p |s| [N/m] (section 3.5) at x(n) [m], under a
    !! monotonically increased force [N]; 0 in the stick zone and outside the contact.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_contact), intent(in) :: contact  !! An initialised contact.
    real(mslip_real), intent(in) :: force  !! Tangential force [N]; its magnitude is at most `slip_force`.
    real(mslip_real), intent(in) :: x(:)  !! Positions from the centre [m].
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE, MSLIP_FORCE_EXCEEDS_SLIP, MSLIP_BAD_POSITION, or
      !! MSLIP_NOT_AVAILABLE for an elliptical contact.
    real(mslip_real), intent(inout), optional, target, contiguous :: slip(:)  !! Slip at each x [m].
    real(mslip_real), intent(inout), optional, target, contiguous :: damage(:)  !! Damage parameter at each x [N/m].

    integer(mslip_size) :: n
    type(c_ptr) :: ptr(2)

    n = size(x, kind=mslip_size)
    ptr = c_null_ptr
    status = MSLIP_OK
    if (present(slip)) call check_array(slip, n, ptr(1), status)
    if (present(damage)) call check_array(damage, n, ptr(2), status)
    if (status == MSLIP_OK) status = c_slip(contact, force, n, x, ptr(1), ptr(2))
  end subroutine mslip_slip

  subroutine monotonic_displacement_array(contact, force, status, displacement, compliance, stick_half_width)
    !! `mslip_monotonic_displacement` of n values.
    type(mslip_contact), intent(in) :: contact  !! An initialised contact.
    real(mslip_real), intent(in) :: force(:)  !! Tangential force [N]; its magnitude is at most `slip_force`.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE or MSLIP_FORCE_EXCEEDS_SLIP.
    real(mslip_real), intent(inout), optional, target, contiguous :: displacement(:)  !! Displacement under the force [m].
    real(mslip_real), intent(inout), optional, target, contiguous :: compliance(:)
      !! Derivative of the displacement with respect to the force [m/N].
    real(mslip_real), intent(inout), optional, target, contiguous :: stick_half_width(:)
      !! Half-width of the stick zone [m]; of an elliptical contact the x semi-axis of the stick ellipse.

    integer(mslip_size) :: n
    type(c_ptr) :: ptr(3)

    n = size(force, kind=mslip_size)
    ptr = c_null_ptr
    status = MSLIP_OK
    if (present(displacement)) call check_array(displacement, n, ptr(1), status)
    if (present(compliance)) call check_array(compliance, n, ptr(2), status)
    if (present(stick_half_width)) call check_array(stick_half_width, n, ptr(3), status)
    if (status == MSLIP_OK) status = c_monotonic_displacement(contact, n, force, ptr(1), ptr(2), ptr(3))
  end subroutine monotonic_displacement_array

  subroutine monotonic_displacement_scalar(contact, force, status, displacement, compliance, stick_half_width)
    !! `mslip_monotonic_displacement` of one value.
    type(mslip_contact), intent(in) :: contact  !! An initialised contact.
    real(mslip_real), intent(in) :: force  !! Tangential force [N]; its magnitude is at most `slip_force`.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE or MSLIP_FORCE_EXCEEDS_SLIP.
    real(mslip_real), intent(inout), optional, target :: displacement  !! Displacement under the force [m].
    real(mslip_real), intent(inout), optional, target :: compliance
      !! Derivative of the displacement with respect to the force [m/N].
    real(mslip_real), intent(inout), optional, target :: stick_half_width
      !! Half-width of the stick zone [m]; of an elliptical contact the x semi-axis of the stick ellipse.

    status = c_monotonic_displacement(contact, 1_mslip_size, [force], address_of(displacement), &
      address_of(compliance), address_of(stick_half_width))
  end subroutine monotonic_displacement_scalar

  subroutine monotonic_force_array(contact, displacement, status, force, stiffness, stick_half_width)
    !! `mslip_monotonic_force` of n values.
    type(mslip_contact), intent(in) :: contact  !! An initialised contact.
    real(mslip_real), intent(in) :: displacement(:)  !! Displacement [m]; its magnitude is at most 1e150.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, MSLIP_BAD_CONTACT or MSLIP_BAD_DISPLACEMENT.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:)  !! Force at the displacement [N].
    real(mslip_real), intent(inout), optional, target, contiguous :: stiffness(:)
      !! Derivative of the force with respect to the displacement [N/m].
    real(mslip_real), intent(inout), optional, target, contiguous :: stick_half_width(:)
      !! Half-width of the stick zone [m]; of an elliptical contact the x semi-axis of the stick ellipse.

    integer(mslip_size) :: n
    type(c_ptr) :: ptr(3)

    n = size(displacement, kind=mslip_size)
    ptr = c_null_ptr
    status = MSLIP_OK
    if (present(force)) call check_array(force, n, ptr(1), status)
    if (present(stiffness)) call check_array(stiffness, n, ptr(2), status)
    if (present(stick_half_width)) call check_array(stick_half_width, n, ptr(3), status)
    if (status == MSLIP_OK) status = c_monotonic_force(contact, n, displacement, ptr(1), ptr(2), ptr(3))
  end subroutine monotonic_force_array

  subroutine monotonic_force_scalar(contact, displacement, status, force, stiffness, stick_half_width)
    !! `mslip_monotonic_force` of one value.
    type(mslip_contact), intent(in) :: contact  !! An initialised contact.
    real(mslip_real), intent(in) :: displacement  !! Displacement [m]; its magnitude is at most 1e150.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, MSLIP_BAD_CONTACT or MSLIP_BAD_DISPLACEMENT.
    real(mslip_real), intent(inout), optional, target :: force  !! Force at the displacement [N].
    real(mslip_real), intent(inout), optional, target :: stiffness
      !! Derivative of the force with respect to the displacement [N/m].
    real(mslip_real), intent(inout), optional, target :: stick_half_width
      !! Half-width of the stick zone [m]; of an elliptical contact the x semi-axis of the stick ellipse.

    status = c_monotonic_force(contact, 1_mslip_size, [displacement], address_of(force), address_of(stiffness), &
      address_of(stick_half_width))
  end subroutine monotonic_force_scalar

  subroutine mslip_monotonic_sensitivity(contact, displacement, status, force, sensitivity)
    !! Derivatives of the force of the monotonic curve with respect to the parameters at displacement(n) [m], which
    !! stays fixed: force(n) [N] and sensitivity, MSLIP_PARAMETER_COUNT x n, column-major. Beyond slip_displacement they
    !! are those of mu N; so are, one-sided, those of a contact with mu = 0 or N = 0 at any displacement but 0.
    !!
    !! Of an elliptical contact the bodies keep their shapes, so that the ellipse changes with N and E*. The derivative
    !! with respect to the edge radius is that for bodies whose radii of curvature change in proportion, with R = 4 E*
    !! semi_axis_x^3/(3 N): of a sphere, its radius. Those with respect to a and L are 0. A layer is the same body under
    !! any N: its compliance under the reference load, and both its loads, stay fixed. A reference_load of 0 stays at
    !! the N of the contact.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_contact), intent(in) :: contact  !! An initialised contact.
    real(mslip_real), intent(in) :: displacement(:)  !! Displacements [m]; magnitudes are at most 1e150.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, MSLIP_BAD_CONTACT, MSLIP_BAD_ARRAY_SIZE or MSLIP_BAD_DISPLACEMENT.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:)  !! Forces [N].
    real(mslip_real), intent(inout), optional, target, contiguous :: sensitivity(:, :)
      !! (p, n): Derivatives of each force, in rows `MSLIP_BY_...` [N over the unit of the parameter].

    integer(mslip_size) :: n
    type(c_ptr) :: ptr(2)

    n = size(displacement, kind=mslip_size)
    ptr = c_null_ptr
    status = MSLIP_OK
    if (present(force)) call check_array(force, n, ptr(1), status)
    if (present(sensitivity)) call check_array(sensitivity, [int(MSLIP_PARAMETER_COUNT, mslip_size), n], ptr(2), &
      status)
    if (status == MSLIP_OK) status = c_monotonic_sensitivity(contact, n, displacement, ptr(1), ptr(2))
  end subroutine mslip_monotonic_sensitivity

  ! ---------------------------------------------------------------------------------------------------------------------
  ! Any load history: Masing's rule (Eq. 11, 12) with return-point memory

  pure function mslip_state_length(reversals) result(length)
    !! Number of doubles in a state with a capacity of `reversals` nested reversals, at least 2. A state is never full:
    !! if the capacity is exceeded, the pair of adjacent reversals whose removal changes later forces least is removed.
    !!
    !! Since 0.1.0 (interface 6).
    integer(mslip_size), intent(in) :: reversals  !! Nested reversals, >= 0.
    integer(mslip_size) :: length  !! The length. It may dimension an array.

    length = c_state_length(reversals)
  end function mslip_state_length

  subroutine mslip_state_init(state, status)
    !! Initialises a state: unloaded, with zero force and displacement.
    !!
    !! Since 0.1.0 (interface 6).
    real(mslip_real), intent(inout), target, contiguous :: state(:)
      !! The state, of at least `mslip_state_length(2)` values. Its size decides how many nested reversals it holds.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or MSLIP_STATE_TOO_SHORT.

    status = c_state_init(size(state, kind=mslip_size), address_of(state))
  end subroutine mslip_state_init

  subroutine mslip_state_check(state, status)
    !! Validates a state that was read from a file or a message: all values must be finite and the reversals nested.
    !! Other functions only check a tag and the number of reversals.
    !!
    !! A state that was decimal text of 17 significant digits has every bit. With 15 or 16 digits later forces are right
    !! to 1e-12 mu N (if reversals were removed, within mslip_state_error), or the state is rejected, because rounding
    !! has moved one reversal onto another; with fewer digits it is rejected. Not detected: values that another history
    !! leads to, such as a force or a displacement of which one bit has changed. A file needs a checksum of its own
    !! against that.
    !!
    !! Since 0.1.0 (interface 6).
    real(mslip_real), intent(in) :: state(:)  !! A state.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, MSLIP_STATE_TOO_SHORT or MSLIP_BAD_STATE.

    status = c_state_check(size(state, kind=mslip_size), state)
  end subroutine mslip_state_check

  subroutine mslip_state_error(state, force_error, status)
    !! Bound on the error [N] of the force due to removed reversals: 0 if none was removed since the last gross slip.
    !!
    !! Since 0.1.0 (interface 6).
    real(mslip_real), intent(in) :: state(:)  !! A state.
    real(mslip_real), intent(inout), target :: force_error  !! Bound on the error [N].
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, MSLIP_STATE_TOO_SHORT or MSLIP_BAD_STATE.

    status = c_state_error(size(state, kind=mslip_size), state, address_of(force_error))
  end subroutine mslip_state_error

  subroutine mslip_masing_update(contact, state_old, displacement, state_new, status, force, stiffness, dissipated)
    !! Advances the contact state to a displacement [m]: force [N], tangent stiffness [N/m], and energy dissipated in
    !! this step [J] (Eq. 11, 12).
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_contact), intent(in) :: contact  !! An initialised contact.
    real(mslip_real), intent(in), target, contiguous :: state_old(:)  !! State before the step or path.
    real(mslip_real), intent(in) :: displacement  !! Displacement at the end of the step [m]; its magnitude is at most 1e150.
    real(mslip_real), intent(inout), target, contiguous :: state_new(:)
      !! New state, of the same size. For a step or path in place use the procedure named `_advance`.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_CONTACT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_STATE or MSLIP_BAD_DISPLACEMENT.
    real(mslip_real), intent(inout), optional, target :: force  !! Force at the end of the step [N].
    real(mslip_real), intent(inout), optional, target :: stiffness
      !! Derivative of the force with respect to the displacement at the end of the step [N/m].
    real(mslip_real), intent(inout), optional, target :: dissipated  !! Energy dissipated by the step [J].

    type(c_ptr) :: ptr(1)

    ptr = c_null_ptr
    status = MSLIP_OK
    call check_array(state_new, size(state_old, kind=mslip_size), ptr(1), status)
    if (status == MSLIP_OK) status = c_masing_update(contact, size(state_old, kind=mslip_size), &
      address_of(state_old), displacement, ptr(1), address_of(force), address_of(stiffness), address_of(dissipated))
  end subroutine mslip_masing_update

  subroutine mslip_masing_advance(contact, state, displacement, status, force, stiffness, dissipated)
    !! `mslip_masing_update` in place: the new state replaces the old one.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_contact), intent(in) :: contact  !! An initialised contact.
    real(mslip_real), intent(inout), target, contiguous :: state(:)  !! State before and after the step or path.
    real(mslip_real), intent(in) :: displacement  !! Displacement at the end of the step [m]; its magnitude is at most 1e150.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_CONTACT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_STATE or MSLIP_BAD_DISPLACEMENT.
    real(mslip_real), intent(inout), optional, target :: force  !! Force at the end of the step [N].
    real(mslip_real), intent(inout), optional, target :: stiffness
      !! Derivative of the force with respect to the displacement at the end of the step [N/m].
    real(mslip_real), intent(inout), optional, target :: dissipated  !! Energy dissipated by the step [J].

    status = c_masing_update(contact, size(state, kind=mslip_size), address_of(state), displacement, &
      address_of(state), address_of(force), address_of(stiffness), address_of(dissipated))
  end subroutine mslip_masing_advance

  subroutine mslip_masing_path(contact, state_old, displacement, state_new, status, force, stiffness, dissipated)
    !! Advances the contact state through n displacements [m]; force(n) [N], stiffness(n) [N/m] and dissipated(n) [J]
    !! are those of each step.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_contact), intent(in) :: contact  !! An initialised contact.
    real(mslip_real), intent(in), target, contiguous :: state_old(:)  !! State before the step or path.
    real(mslip_real), intent(in) :: displacement(:)  !! Displacement at the end of the step [m]; its magnitude is at most 1e150.
    real(mslip_real), intent(inout), target, contiguous :: state_new(:)
      !! New state, of the same size. For a step or path in place use the procedure named `_advance`.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_CONTACT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_STATE or MSLIP_BAD_DISPLACEMENT.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:)  !! Force at the end of the step [N].
    real(mslip_real), intent(inout), optional, target, contiguous :: stiffness(:)
      !! Derivative of the force with respect to the displacement at the end of the step [N/m].
    real(mslip_real), intent(inout), optional, target, contiguous :: dissipated(:)  !! Energy dissipated by the step [J].

    integer(mslip_size) :: n
    type(c_ptr) :: ptr(4)

    n = size(displacement, kind=mslip_size)
    ptr = c_null_ptr
    status = MSLIP_OK
    call check_array(state_new, size(state_old, kind=mslip_size), ptr(1), status)
    if (present(force)) call check_array(force, n, ptr(2), status)
    if (present(stiffness)) call check_array(stiffness, n, ptr(3), status)
    if (present(dissipated)) call check_array(dissipated, n, ptr(4), status)
    if (status == MSLIP_OK) status = c_masing_path(contact, size(state_old, kind=mslip_size), address_of(state_old), &
      n, displacement, ptr(1), ptr(2), ptr(3), ptr(4))
  end subroutine mslip_masing_path

  subroutine mslip_masing_path_advance(contact, state, displacement, status, force, stiffness, dissipated)
    !! `mslip_masing_path` in place: the new state replaces the old one.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_contact), intent(in) :: contact  !! An initialised contact.
    real(mslip_real), intent(inout), target, contiguous :: state(:)  !! State before and after the step or path.
    real(mslip_real), intent(in) :: displacement(:)  !! Displacement at the end of the step [m]; its magnitude is at most 1e150.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_CONTACT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_STATE or MSLIP_BAD_DISPLACEMENT.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:)  !! Force at the end of the step [N].
    real(mslip_real), intent(inout), optional, target, contiguous :: stiffness(:)
      !! Derivative of the force with respect to the displacement at the end of the step [N/m].
    real(mslip_real), intent(inout), optional, target, contiguous :: dissipated(:)  !! Energy dissipated by the step [J].

    integer(mslip_size) :: n
    type(c_ptr) :: ptr(3)

    n = size(displacement, kind=mslip_size)
    ptr = c_null_ptr
    status = MSLIP_OK
    if (present(force)) call check_array(force, n, ptr(1), status)
    if (present(stiffness)) call check_array(stiffness, n, ptr(2), status)
    if (present(dissipated)) call check_array(dissipated, n, ptr(3), status)
    if (status == MSLIP_OK) status = c_masing_path(contact, size(state, kind=mslip_size), address_of(state), n, &
      displacement, address_of(state), ptr(1), ptr(2), ptr(3))
  end subroutine mslip_masing_path_advance

  subroutine mslip_masing_tractions(contact, state, x, status, pressure, shear)
    !! Tractions [Pa] at x(n) [m] after an arbitrary load history (Eq. 21, superposed by Masing's rule).
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_contact), intent(in) :: contact  !! An initialised contact.
    real(mslip_real), intent(in) :: state(:)  !! A state.
    real(mslip_real), intent(in) :: x(:)  !! Positions from the centre [m].
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_CONTACT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_STATE, MSLIP_BAD_POSITION, or
      !! MSLIP_FORCE_EXCEEDS_SLIP for the state of another contact.
    real(mslip_real), intent(inout), optional, target, contiguous :: pressure(:)  !! Pressure at each x [Pa].
    real(mslip_real), intent(inout), optional, target, contiguous :: shear(:)  !! Shear traction at each x [Pa].

    integer(mslip_size) :: n
    type(c_ptr) :: ptr(2)

    n = size(x, kind=mslip_size)
    ptr = c_null_ptr
    status = MSLIP_OK
    if (present(pressure)) call check_array(pressure, n, ptr(1), status)
    if (present(shear)) call check_array(shear, n, ptr(2), status)
    if (status == MSLIP_OK) status = c_masing_tractions(contact, size(state, kind=mslip_size), state, n, x, ptr(1), &
      ptr(2))
  end subroutine mslip_masing_tractions

  ! ---------------------------------------------------------------------------------------------------------------------
  ! Cycles

  subroutine mslip_hysteresis_loop(contact, amplitude, displacement, force, status)
    !! Hysteresis loop of the displacement amplitude cos(t), amplitude in [m]: displacement(n) [m] and force(n) [N] at n
    !! uniformly spaced instants of one period, from t = 0.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_contact), intent(in) :: contact  !! An initialised contact.
    real(mslip_real), intent(in) :: amplitude  !! Amplitude of the displacement [m], 0 to 1e150.
    real(mslip_real), intent(inout), target, contiguous :: displacement(:)  !! Displacement of each point [m].
    real(mslip_real), intent(inout), target, contiguous :: force(:)  !! Force of each point [N].
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, MSLIP_BAD_CONTACT or MSLIP_BAD_AMPLITUDE.

    integer(mslip_size) :: n
    type(c_ptr) :: ptr(2)

    n = size(displacement, kind=mslip_size)
    ptr = c_null_ptr
    status = MSLIP_OK
    call check_array(displacement, n, ptr(1), status)
    call check_array(force, n, ptr(2), status)
    if (status == MSLIP_OK) status = c_hysteresis_loop(contact, amplitude, n, ptr(1), ptr(2))
  end subroutine mslip_hysteresis_loop

  subroutine dissipated_energy_array(contact, force_amplitude, energy, status)
    !! `mslip_dissipated_energy` of n values.
    type(mslip_contact), intent(in) :: contact  !! An initialised contact.
    real(mslip_real), intent(in) :: force_amplitude(:)  !! Amplitude of the force [N], 0 to `slip_force`.
    real(mslip_real), intent(inout), target, contiguous :: energy(:)  !! Energy per cycle [J].
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE_AMPLITUDE or MSLIP_FORCE_EXCEEDS_SLIP.

    integer(mslip_size) :: n
    type(c_ptr) :: ptr(1)

    n = size(force_amplitude, kind=mslip_size)
    ptr = c_null_ptr
    status = MSLIP_OK
    call check_array(energy, n, ptr(1), status)
    if (status == MSLIP_OK) status = c_dissipated_energy(contact, n, force_amplitude, ptr(1))
  end subroutine dissipated_energy_array

  subroutine dissipated_energy_scalar(contact, force_amplitude, energy, status)
    !! `mslip_dissipated_energy` of one value.
    type(mslip_contact), intent(in) :: contact  !! An initialised contact.
    real(mslip_real), intent(in) :: force_amplitude  !! Amplitude of the force [N], 0 to `slip_force`.
    real(mslip_real), intent(inout), target :: energy  !! Energy per cycle [J].
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE_AMPLITUDE or MSLIP_FORCE_EXCEEDS_SLIP.

    status = c_dissipated_energy(contact, 1_mslip_size, [force_amplitude], address_of(energy))
  end subroutine dissipated_energy_scalar

  subroutine complex_stiffness_array(contact, amplitude, status, k_real, k_imag, dk_real, dk_imag)
    !! `mslip_complex_stiffness` of n values.
    type(mslip_contact), intent(in) :: contact  !! An initialised contact.
    real(mslip_real), intent(in) :: amplitude(:)  !! Amplitude of the displacement [m], 0 to 1e150; 0 gives the initial stiffness.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, MSLIP_BAD_CONTACT or MSLIP_BAD_AMPLITUDE.
    real(mslip_real), intent(inout), optional, target, contiguous :: k_real(:)  !! K' [N/m].
    real(mslip_real), intent(inout), optional, target, contiguous :: k_imag(:)  !! K'' [N/m], >= 0.
    real(mslip_real), intent(inout), optional, target, contiguous :: dk_real(:)  !! dK'/d(amplitude) [N/m2].
    real(mslip_real), intent(inout), optional, target, contiguous :: dk_imag(:)  !! dK''/d(amplitude) [N/m2].

    integer(mslip_size) :: n
    type(c_ptr) :: ptr(4)

    n = size(amplitude, kind=mslip_size)
    ptr = c_null_ptr
    status = MSLIP_OK
    if (present(k_real)) call check_array(k_real, n, ptr(1), status)
    if (present(k_imag)) call check_array(k_imag, n, ptr(2), status)
    if (present(dk_real)) call check_array(dk_real, n, ptr(3), status)
    if (present(dk_imag)) call check_array(dk_imag, n, ptr(4), status)
    if (status == MSLIP_OK) status = c_complex_stiffness(contact, n, amplitude, ptr(1), ptr(2), ptr(3), ptr(4))
  end subroutine complex_stiffness_array

  subroutine complex_stiffness_scalar(contact, amplitude, status, k_real, k_imag, dk_real, dk_imag)
    !! `mslip_complex_stiffness` of one value.
    type(mslip_contact), intent(in) :: contact  !! An initialised contact.
    real(mslip_real), intent(in) :: amplitude  !! Amplitude of the displacement [m], 0 to 1e150; 0 gives the initial stiffness.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, MSLIP_BAD_CONTACT or MSLIP_BAD_AMPLITUDE.
    real(mslip_real), intent(inout), optional, target :: k_real  !! K' [N/m].
    real(mslip_real), intent(inout), optional, target :: k_imag  !! K'' [N/m], >= 0.
    real(mslip_real), intent(inout), optional, target :: dk_real  !! dK'/d(amplitude) [N/m2].
    real(mslip_real), intent(inout), optional, target :: dk_imag  !! dK''/d(amplitude) [N/m2].

    status = c_complex_stiffness(contact, 1_mslip_size, [amplitude], address_of(k_real), address_of(k_imag), &
      address_of(dk_real), address_of(dk_imag))
  end subroutine complex_stiffness_scalar

  ! ---------------------------------------------------------------------------------------------------------------------
  ! Spring-slider substitutes for solvers without an element of this kind

  subroutine mslip_jenkins_equivalent(contact, amplitude, stiffness, slip_force, status)
    !! Jenkins element (spring and slider in series) with the same K' and K'' at a displacement amplitude [m]: stiffness
    !! [N/m] and slip force [N]. At amplitude 0: the initial stiffness and mu N. Both are 0 if mu N = 0.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_contact), intent(in) :: contact  !! An initialised contact.
    real(mslip_real), intent(in) :: amplitude  !! Amplitude of the displacement [m], 0 to 1e150.
    real(mslip_real), intent(inout), target :: stiffness  !! Stiffness of the spring [N/m].
    real(mslip_real), intent(inout), target :: slip_force  !! Slip force of the slider [N].
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, MSLIP_BAD_CONTACT or MSLIP_BAD_AMPLITUDE.

    status = c_jenkins_equivalent(contact, amplitude, address_of(stiffness), address_of(slip_force))
  end subroutine mslip_jenkins_equivalent

  subroutine mslip_iwan_equivalent(contact, stiffness, slip_force, status, force_error)
    !! Iwan model of n parallel Jenkins elements that approximates the monotonic curve with the smallest maximum error:
    !! stiffness(n) [N/m], slip_force(n) [N] of sum mu N, and force_error, the maximum error of the force on the
    !! monotonic curve divided by mu N. After m nested reversals the error is at most (1 + 2m) force_error; measured: 3
    !! in loops, 10 to 15 in random histories, 6 to 43 in decaying vibrations. All are 0 if mu N = 0.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_contact), intent(in) :: contact  !! An initialised contact.
    real(mslip_real), intent(inout), target, contiguous :: stiffness(:)  !! Stiffness of each spring [N/m].
    real(mslip_real), intent(inout), target, contiguous :: slip_force(:)
      !! Slip force of each slider [N]; the sum is `slip_force` of the contact.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, MSLIP_BAD_CONTACT or MSLIP_BAD_COUNT.
    real(mslip_real), intent(inout), optional, target :: force_error
      !! Maximum error of the force on the monotonic curve, relative to `slip_force` of the contact.

    integer(mslip_size) :: n
    type(c_ptr) :: ptr(2)

    n = size(stiffness, kind=mslip_size)
    ptr = c_null_ptr
    status = MSLIP_OK
    call check_array(stiffness, n, ptr(1), status)
    call check_array(slip_force, n, ptr(2), status)
    if (status == MSLIP_OK) status = c_iwan_equivalent(contact, n, ptr(1), ptr(2), address_of(force_error))
  end subroutine mslip_iwan_equivalent

  ! ---------------------------------------------------------------------------------------------------------------------
  ! Several harmonics: alternating frequency/time

  pure function mslip_harmonic_workspace_length(harmonics, samples, rule) result(length)
    !! Number of doubles in a workspace for H harmonics, H >= 1, more than 2H samples per period, and a rule,
    !! MSLIP_UNIFORM_SAMPLING or MSLIP_EVENT_DRIVEN; 0 if these are not allowed.
    !!
    !! Since 0.1.0 (interface 6).
    integer(mslip_size), intent(in) :: harmonics  !! Highest harmonic H, >= 1.
    integer(mslip_size), intent(in) :: samples  !! Samples per period, > 2H.
    integer(mslip_int), intent(in), optional :: rule  !! `MSLIP_UNIFORM_SAMPLING` (the default) or `MSLIP_EVENT_DRIVEN`.
    integer(mslip_size) :: length  !! The length. It may dimension an array.

    ! A C length beyond the largest integer of this kind arrives negative.
    length = max(c_harmonic_workspace_length(harmonics, samples, rule_or_default(rule)), 0_mslip_size)
  end function mslip_harmonic_workspace_length

  subroutine mslip_harmonic_workspace_init(harmonics, samples, workspace, status, rule)
    !! Initialises a workspace: tables for one (harmonics, samples, rule), and scratch memory. Each thread needs its
    !! own.
    !!
    !! MSLIP_UNIFORM_SAMPLING evaluates `samples` uniformly spaced instants of a period; its error decreases as
    !! samples^-2. MSLIP_EVENT_DRIVEN locates reversals, loop closures and the onset of gross slip, and distributes
    !! about `samples` Gauss-Legendre nodes per period between them, at least 8 between two events; three times as many
    !! if a layer has an N_c below a quarter of the normal force. Its error decreases exponentially, more slowly for
    !! more harmonics: 16 (H+1) nodes have worst measured errors of 2e-6 of mu N in the force and 5e-4 of the initial
    !! stiffness in the Jacobian; the energy is exact to rounding. It searches for reversals on a grid of at least
    !! `samples` and 16 H instants.
    !!
    !! Since 0.1.0 (interface 6).
    integer(mslip_size), intent(in) :: harmonics  !! Highest harmonic H, >= 1.
    integer(mslip_size), intent(in) :: samples  !! Samples per period, > 2H.
    real(mslip_real), intent(inout), target, contiguous :: workspace(:)
      !! The workspace, of at least `mslip_harmonic_workspace_length(harmonics, samples, rule)` values.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, or MSLIP_BAD_RULE, MSLIP_BAD_HARMONICS, MSLIP_BAD_SAMPLES, MSLIP_WORKSPACE_TOO_SHORT.
    integer(mslip_int), intent(in), optional :: rule  !! `MSLIP_UNIFORM_SAMPLING` (the default) or `MSLIP_EVENT_DRIVEN`.

    status = c_harmonic_workspace_init(harmonics, samples, rule_or_default(rule), size(workspace, kind=mslip_size), &
      address_of(workspace))
  end subroutine mslip_harmonic_workspace_init

  subroutine mslip_harmonic_force(contact, workspace, displacement, status, force, jacobian, dissipated)
    !! Harmonic force in steady state (the second of two periods from the initial, unloaded state), by alternating
    !! frequency/time (AFT) with the rule of the workspace. displacement [m] and force [N] are 2H+1 coefficients, [c0,
    !! cos1, sin1, cos2, sin2, ...]; jacobian [N/m] is d force_i / d displacement_j, (2H+1) x (2H+1), column-major;
    !! dissipated [J] is the energy per period.
    !!
    !! With MSLIP_UNIFORM_SAMPLING the Jacobian is the exact derivative of the discrete force, one-sided if two samples
    !! at a reversal are equal or a sample is at the onset of gross slip. With MSLIP_EVENT_DRIVEN it is the rule applied
    !! to the exact derivative of the integrals; it converges more slowly than the force.
    !!
    !! The contact is unloaded at displacement 0, so the mean force depends on the mean displacement c0 unless the
    !! motion slips grossly. For displacements measured from another position, pass c0 minus the unloaded position.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_contact), intent(in) :: contact  !! An initialised contact.
    real(mslip_real), intent(inout), target, contiguous :: workspace(:)
      !! An initialised workspace; it decides H, and that of an element m.
    real(mslip_real), intent(in) :: displacement(:)  !! Coefficients of the displacement [m].
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, MSLIP_BAD_CONTACT, MSLIP_BAD_WORKSPACE or MSLIP_BAD_DISPLACEMENT.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:)  !! Coefficients of the force [N].
    real(mslip_real), intent(inout), optional, target, contiguous :: jacobian(:, :)
      !! (k, k): Derivatives of the force coefficients with respect to the displacement coefficients [N/m].
    real(mslip_real), intent(inout), optional, target :: dissipated  !! Energy dissipated per period [J].

    integer(mslip_size) :: k
    type(c_ptr) :: ptr(2)

    call count_coefficients(workspace, k, status)
    if (status /= MSLIP_OK) return
    ptr = c_null_ptr
    if (present(force)) call check_array(force, k, ptr(1), status)
    if (present(jacobian)) call check_array(jacobian, [k, k], ptr(2), status)
    if (size(displacement, kind=mslip_size) /= k) status = MSLIP_BAD_COEFFICIENTS
    if (status == MSLIP_OK) status = c_harmonic_force(contact, address_of(workspace), displacement, ptr(1), ptr(2), &
      address_of(dissipated))
  end subroutine mslip_harmonic_force

  subroutine mslip_harmonic_sensitivity(contact, workspace, displacement, status, force, sensitivity)
    !! Derivatives of the harmonic force with respect to the parameters at fixed coefficients of the displacement:
    !! displacement [m] and force [N] as of mslip_harmonic_force, and sensitivity, (2H+1) x MSLIP_PARAMETER_COUNT,
    !! column-major. The parameters are those of mslip_monotonic_sensitivity.
    !!
    !! With MSLIP_UNIFORM_SAMPLING the derivatives are the exact ones of the discrete force, one-sided if a sample is at
    !! the onset of gross slip. With MSLIP_EVENT_DRIVEN they are the rule applied to the exact derivatives of the
    !! integrals, and converge more slowly than the force.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_contact), intent(in) :: contact  !! An initialised contact.
    real(mslip_real), intent(inout), target, contiguous :: workspace(:)
      !! An initialised workspace; it decides H, and that of an element m.
    real(mslip_real), intent(in) :: displacement(:)  !! Coefficients of the displacement [m].
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, MSLIP_BAD_CONTACT, MSLIP_BAD_WORKSPACE or MSLIP_BAD_DISPLACEMENT.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:)  !! Coefficients of the force [N].
    real(mslip_real), intent(inout), optional, target, contiguous :: sensitivity(:, :)
      !! (k, p): Derivatives of the force coefficients, in columns `MSLIP_BY_...` [N over the unit of the parameter].

    integer(mslip_size) :: k
    type(c_ptr) :: ptr(2)

    call count_coefficients(workspace, k, status)
    if (status /= MSLIP_OK) return
    ptr = c_null_ptr
    if (present(force)) call check_array(force, k, ptr(1), status)
    if (present(sensitivity)) call check_array(sensitivity, [k, int(MSLIP_PARAMETER_COUNT, mslip_size)], ptr(2), &
      status)
    if (size(displacement, kind=mslip_size) /= k) status = MSLIP_BAD_COEFFICIENTS
    if (status == MSLIP_OK) status = c_harmonic_sensitivity(contact, address_of(workspace), displacement, ptr(1), &
      ptr(2))
  end subroutine mslip_harmonic_sensitivity

  ! ---------------------------------------------------------------------------------------------------------------------
  ! Batches: n items at once. Item i uses contacts(index(i)), or contacts(i) without an index

  subroutine mslip_batch_complex_stiffness(contacts, amplitude, status, index, active, k_real, k_imag, dk_real, &
    dk_imag, failed_item)
    !! mslip_complex_stiffness for n items, one amplitude each.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_contact), intent(in) :: contacts(:)  !! Initialised contacts.
    real(mslip_real), intent(in) :: amplitude(:)  !! Amplitude of the displacement [m], 0 to 1e150; 0 gives the initial stiffness.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, MSLIP_BAD_INDEX or the codes of mslip_complex_stiffness.
    integer(mslip_int), intent(in), optional :: index(:)
      !! n indices of contacts or elements, from 1 (`MSLIP_BAD_INDEX`). Absent: each item has its own.
    integer(mslip_int), intent(in), optional, target, contiguous :: active(:)
      !! n flags: an item with flag 0 is skipped, and its state and outputs keep their values. Absent: no item is
      !! skipped.
    real(mslip_real), intent(inout), optional, target, contiguous :: k_real(:)  !! K' [N/m].
    real(mslip_real), intent(inout), optional, target, contiguous :: k_imag(:)  !! K'' [N/m], >= 0.
    real(mslip_real), intent(inout), optional, target, contiguous :: dk_real(:)  !! dK'/d(amplitude) [N/m2].
    real(mslip_real), intent(inout), optional, target, contiguous :: dk_imag(:)  !! dK''/d(amplitude) [N/m2].
    integer(mslip_size), intent(inout), optional :: failed_item
      !! On an error the first item at fault, from 1; 0 if the error is not the error of an item. Not written on
      !! success.

    integer(mslip_size) :: n
    integer(mslip_int), allocatable, target :: from_zero(:)
    integer(mslip_size), target :: failed
    type(c_ptr) :: ptr(6)

    n = size(amplitude, kind=mslip_size)
    failed = n
    ptr = c_null_ptr
    call check_index(size(contacts, kind=mslip_size), n, index, from_zero, ptr(1), status)
    if (present(active)) call check_array(active, n, ptr(2), status)
    if (present(k_real)) call check_array(k_real, n, ptr(3), status)
    if (present(k_imag)) call check_array(k_imag, n, ptr(4), status)
    if (present(dk_real)) call check_array(dk_real, n, ptr(5), status)
    if (present(dk_imag)) call check_array(dk_imag, n, ptr(6), status)
    if (status == MSLIP_OK) status = c_batch_complex_stiffness(n, size(contacts, kind=mslip_size), contacts, ptr(1), &
      ptr(2), amplitude, ptr(3), ptr(4), ptr(5), ptr(6), c_loc(failed))
    ! C counts from 0, and gives n if no item is at fault.
    if (present(failed_item) .and. status /= MSLIP_OK) failed_item = merge(failed + 1, 0_mslip_size, failed < n)
  end subroutine mslip_batch_complex_stiffness

  subroutine mslip_batch_masing_update(contacts, states_old, displacement, states_new, status, index, active, force, &
    stiffness, dissipated, failed_item)
    !! mslip_masing_update for n items: states hold state_length doubles per item, contiguously; displacement, force,
    !! stiffness and dissipated one.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_contact), intent(in) :: contacts(:)  !! Initialised contacts.
    real(mslip_real), intent(in), target, contiguous :: states_old(:, :)
      !! (state length, n): the state of each item before the step.
    real(mslip_real), intent(in) :: displacement(:)  !! Displacement at the end of the step [m]; its magnitude is at most 1e150.
    real(mslip_real), intent(inout), target, contiguous :: states_new(:, :)
      !! (state length, n): the state of each item after the step. For a step in place use the procedure named
      !! `_advance`.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, MSLIP_BAD_INDEX or the codes of mslip_masing_update.
    integer(mslip_int), intent(in), optional :: index(:)
      !! n indices of contacts or elements, from 1 (`MSLIP_BAD_INDEX`). Absent: each item has its own.
    integer(mslip_int), intent(in), optional, target, contiguous :: active(:)
      !! n flags: an item with flag 0 is skipped, and its state and outputs keep their values. Absent: no item is
      !! skipped.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:)  !! Force at the end of the step [N].
    real(mslip_real), intent(inout), optional, target, contiguous :: stiffness(:)
      !! Derivative of the force with respect to the displacement at the end of the step [N/m].
    real(mslip_real), intent(inout), optional, target, contiguous :: dissipated(:)  !! Energy dissipated by the step [J].
    integer(mslip_size), intent(inout), optional :: failed_item
      !! On an error the first item at fault, from 1; 0 if the error is not the error of an item. Not written on
      !! success.

    integer(mslip_size) :: n
    integer(mslip_int), allocatable, target :: from_zero(:)
    integer(mslip_size), target :: failed
    type(c_ptr) :: ptr(7)

    n = size(displacement, kind=mslip_size)
    failed = n
    ptr = c_null_ptr
    call check_index(size(contacts, kind=mslip_size), n, index, from_zero, ptr(1), status)
    if (present(active)) call check_array(active, n, ptr(2), status)
    call check_array(states_old, [size(states_old, 1, mslip_size), n], ptr(3), status)
    call check_array(states_new, [size(states_old, 1, mslip_size), n], ptr(4), status)
    if (present(force)) call check_array(force, n, ptr(5), status)
    if (present(stiffness)) call check_array(stiffness, n, ptr(6), status)
    if (present(dissipated)) call check_array(dissipated, n, ptr(7), status)
    if (status == MSLIP_OK) status = c_batch_masing_update(n, size(contacts, kind=mslip_size), contacts, ptr(1), &
      ptr(2), size(states_old, 1, mslip_size), ptr(3), displacement, ptr(4), ptr(5), ptr(6), ptr(7), c_loc(failed))
    ! C counts from 0, and gives n if no item is at fault.
    if (present(failed_item) .and. status /= MSLIP_OK) failed_item = merge(failed + 1, 0_mslip_size, failed < n)
  end subroutine mslip_batch_masing_update

  subroutine mslip_batch_masing_advance(contacts, states, displacement, status, index, active, force, stiffness, &
    dissipated, failed_item)
    !! `mslip_batch_masing_update` in place: the new state replaces the old one.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_contact), intent(in) :: contacts(:)  !! Initialised contacts.
    real(mslip_real), intent(inout), target, contiguous :: states(:, :)
      !! (state length, n): the state of each item before and after the step.
    real(mslip_real), intent(in) :: displacement(:)  !! Displacement at the end of the step [m]; its magnitude is at most 1e150.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, MSLIP_BAD_INDEX or the codes of mslip_masing_update.
    integer(mslip_int), intent(in), optional :: index(:)
      !! n indices of contacts or elements, from 1 (`MSLIP_BAD_INDEX`). Absent: each item has its own.
    integer(mslip_int), intent(in), optional, target, contiguous :: active(:)
      !! n flags: an item with flag 0 is skipped, and its state and outputs keep their values. Absent: no item is
      !! skipped.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:)  !! Force at the end of the step [N].
    real(mslip_real), intent(inout), optional, target, contiguous :: stiffness(:)
      !! Derivative of the force with respect to the displacement at the end of the step [N/m].
    real(mslip_real), intent(inout), optional, target, contiguous :: dissipated(:)  !! Energy dissipated by the step [J].
    integer(mslip_size), intent(inout), optional :: failed_item
      !! On an error the first item at fault, from 1; 0 if the error is not the error of an item. Not written on
      !! success.

    integer(mslip_size) :: n
    integer(mslip_int), allocatable, target :: from_zero(:)
    integer(mslip_size), target :: failed
    type(c_ptr) :: ptr(6)

    n = size(displacement, kind=mslip_size)
    failed = n
    ptr = c_null_ptr
    call check_index(size(contacts, kind=mslip_size), n, index, from_zero, ptr(1), status)
    if (present(active)) call check_array(active, n, ptr(2), status)
    call check_array(states, [size(states, 1, mslip_size), n], ptr(3), status)
    if (present(force)) call check_array(force, n, ptr(4), status)
    if (present(stiffness)) call check_array(stiffness, n, ptr(5), status)
    if (present(dissipated)) call check_array(dissipated, n, ptr(6), status)
    if (status == MSLIP_OK) status = c_batch_masing_update(n, size(contacts, kind=mslip_size), contacts, ptr(1), &
      ptr(2), size(states, 1, mslip_size), ptr(3), displacement, ptr(3), ptr(4), ptr(5), ptr(6), c_loc(failed))
    ! C counts from 0, and gives n if no item is at fault.
    if (present(failed_item) .and. status /= MSLIP_OK) failed_item = merge(failed + 1, 0_mslip_size, failed < n)
  end subroutine mslip_batch_masing_advance

  subroutine mslip_batch_harmonic_force(contacts, workspace, displacement, status, index, active, force, jacobian, &
    dissipated, failed_item)
    !! mslip_harmonic_force for n items with one workspace: displacement and force hold 2H+1 doubles per item, jacobian
    !! (2H+1)^2, dissipated one.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_contact), intent(in) :: contacts(:)  !! Initialised contacts.
    real(mslip_real), intent(inout), target, contiguous :: workspace(:)
      !! An initialised workspace; it decides H, and that of an element m.
    real(mslip_real), intent(in) :: displacement(:, :)  !! (k, n): Coefficients of the displacement [m].
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, MSLIP_BAD_INDEX or the codes of mslip_harmonic_force.
    integer(mslip_int), intent(in), optional :: index(:)
      !! n indices of contacts or elements, from 1 (`MSLIP_BAD_INDEX`). Absent: each item has its own.
    integer(mslip_int), intent(in), optional, target, contiguous :: active(:)
      !! n flags: an item with flag 0 is skipped, and its state and outputs keep their values. Absent: no item is
      !! skipped.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:, :)  !! (k, n): Coefficients of the force [N].
    real(mslip_real), intent(inout), optional, target, contiguous :: jacobian(:, :, :)
      !! (k, k, n): Derivatives of the force coefficients with respect to the displacement coefficients [N/m].
    real(mslip_real), intent(inout), optional, target, contiguous :: dissipated(:)  !! Energy dissipated per period [J].
    integer(mslip_size), intent(inout), optional :: failed_item
      !! On an error the first item at fault, from 1; 0 if the error is not the error of an item. Not written on
      !! success.

    integer(mslip_size) :: k, n
    integer(mslip_int), allocatable, target :: from_zero(:)
    integer(mslip_size), target :: failed
    type(c_ptr) :: ptr(5)

    call count_coefficients(workspace, k, status)
    if (present(failed_item) .and. status /= MSLIP_OK) failed_item = 0
    if (status /= MSLIP_OK) return
    n = size(displacement, 2, mslip_size)
    failed = n
    ptr = c_null_ptr
    call check_index(size(contacts, kind=mslip_size), n, index, from_zero, ptr(1), status)
    if (present(active)) call check_array(active, n, ptr(2), status)
    if (present(force)) call check_array(force, [k, n], ptr(3), status)
    if (present(jacobian)) call check_array(jacobian, [k, k, n], ptr(4), status)
    if (present(dissipated)) call check_array(dissipated, n, ptr(5), status)
    if (size(displacement, 1, mslip_size) /= k) status = MSLIP_BAD_COEFFICIENTS
    if (status == MSLIP_OK) status = c_batch_harmonic_force(n, size(contacts, kind=mslip_size), contacts, ptr(1), &
      ptr(2), address_of(workspace), displacement, ptr(3), ptr(4), ptr(5), c_loc(failed))
    ! C counts from 0, and gives n if no item is at fault.
    if (present(failed_item) .and. status /= MSLIP_OK) failed_item = merge(failed + 1, 0_mslip_size, failed < n)
  end subroutine mslip_batch_harmonic_force

  ! ---------------------------------------------------------------------------------------------------------------------
  ! Varying normal force with separation: friction contact elements
  !
  ! For one tangential direction, m = 2, a displacement is [u, w], a force [T, N], tangential and normal; for two, m = 3, they are
  ! [u, v, w] and [Tx, Ty, N].

  subroutine mslip_element_init(parameters, directions, normal_input, element, status)
    !! Initialises the element of a flat with rounded edges, or of a cylinder. normal_force of the parameters, > 0, is
    !! the largest force for which the element is tabulated. Larger ones are exact, but a step takes several times as
    !! long, with its energy tens of times, and with two directions it is less accurate. directions is the number of
    !! tangential directions, 1 or 2: a displacement is [u, w] or [u, v, w], a force [T, N] or [Tx, Ty, N]. normal_input
    !! is MSLIP_INPUT_APPROACH, w is the normal approach [m], or MSLIP_INPUT_NORMAL_FORCE, w is the normal force [N].
    !!
    !! In a step the contact is open if w is at most 2^-150 of its value under normal_force, with two directions 2^-80.
    !! With two directions forces beyond 2^150 and approaches beyond 2^100 times that value are rejected as those of a
    !! contact too wide for its length.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_parameters), intent(in) :: parameters  !! Geometry, load and materials.
    integer(mslip_int), intent(in) :: directions  !! Number of tangential directions, 1 or 2.
    integer(mslip_int), intent(in) :: normal_input
      !! The normal component of a displacement: `MSLIP_INPUT_APPROACH` or `MSLIP_INPUT_NORMAL_FORCE`.
    type(mslip_element), intent(inout) :: element  !! The element.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_DIRECTIONS, MSLIP_BAD_NORMAL_INPUT, the code of the first invalid parameter,
      !! MSLIP_LENGTH_TOO_SHORT, or MSLIP_OUT_OF_RANGE; the element is unchanged then.

    status = MSLIP_BAD_ELEMENT
    if (c_abi_version() == MSLIP_MODULE_ABI_VERSION) status = c_element_init(parameters, directions, normal_input, &
      element)
  end subroutine mslip_element_init

  subroutine mslip_element_init_elliptic(parameters, directions, normal_input, element, status)
    !! Initialises the element of an elliptical Hertz contact; a sphere if both semi-axes are equal. normal_force of the
    !! parameters, > 0, is the force of the semi-axes and the largest one for which the element is tabulated, as in
    !! mslip_element_init. directions and normal_input are those of mslip_element_init.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_elliptic_parameters), intent(in) :: parameters  !! Geometry, load and materials.
    integer(mslip_int), intent(in) :: directions  !! Number of tangential directions, 1 or 2.
    integer(mslip_int), intent(in) :: normal_input
      !! The normal component of a displacement: `MSLIP_INPUT_APPROACH` or `MSLIP_INPUT_NORMAL_FORCE`.
    type(mslip_element), intent(inout) :: element  !! The element.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_DIRECTIONS, MSLIP_BAD_NORMAL_INPUT, the code of the first invalid parameter, or
      !! MSLIP_OUT_OF_RANGE; the element is unchanged then.

    status = MSLIP_BAD_ELEMENT
    if (c_abi_version() == MSLIP_MODULE_ABI_VERSION) status = c_element_init_elliptic(parameters, directions, &
      normal_input, element)
  end subroutine mslip_element_init_elliptic

  subroutine mslip_element_check(element, status)
    !! Validates an element that was read from a file or a message: its checksum must be that written at initialisation,
    !! which detects any single changed bit. Text needs 17 digits; initialise it again instead. Other functions only
    !! check a tag.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_element), intent(in) :: element  !! The element.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or MSLIP_BAD_ELEMENT.

    status = c_element_check(element)
  end subroutine mslip_element_check

  subroutine normal_force_array(element, approach, status, normal_force, stiffness, half_width)
    !! `mslip_normal_force` of n values.
    type(mslip_element), intent(in) :: element  !! An initialised element.
    real(mslip_real), intent(in) :: approach(:)  !! Normal approach [m].
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_ELEMENT, MSLIP_BAD_DISPLACEMENT, or MSLIP_LENGTH_TOO_SHORT for an approach at which the
      !! contact would be too wide for its length.
    real(mslip_real), intent(inout), optional, target, contiguous :: normal_force(:)  !! Normal force at the approach [N].
    real(mslip_real), intent(inout), optional, target, contiguous :: stiffness(:)  !! Normal stiffness [N/m].
    real(mslip_real), intent(inout), optional, target, contiguous :: half_width(:)  !! Half-width of the contact [m].

    integer(mslip_size) :: n
    type(c_ptr) :: ptr(3)

    n = size(approach, kind=mslip_size)
    ptr = c_null_ptr
    status = MSLIP_OK
    if (present(normal_force)) call check_array(normal_force, n, ptr(1), status)
    if (present(stiffness)) call check_array(stiffness, n, ptr(2), status)
    if (present(half_width)) call check_array(half_width, n, ptr(3), status)
    if (status == MSLIP_OK) status = c_normal_force(element, n, approach, ptr(1), ptr(2), ptr(3))
  end subroutine normal_force_array

  subroutine normal_force_scalar(element, approach, status, normal_force, stiffness, half_width)
    !! `mslip_normal_force` of one value.
    type(mslip_element), intent(in) :: element  !! An initialised element.
    real(mslip_real), intent(in) :: approach  !! Normal approach [m].
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_ELEMENT, MSLIP_BAD_DISPLACEMENT, or MSLIP_LENGTH_TOO_SHORT for an approach at which the
      !! contact would be too wide for its length.
    real(mslip_real), intent(inout), optional, target :: normal_force  !! Normal force at the approach [N].
    real(mslip_real), intent(inout), optional, target :: stiffness  !! Normal stiffness [N/m].
    real(mslip_real), intent(inout), optional, target :: half_width  !! Half-width of the contact [m].

    status = c_normal_force(element, 1_mslip_size, [approach], address_of(normal_force), address_of(stiffness), &
      address_of(half_width))
  end subroutine normal_force_scalar

  subroutine normal_approach_array(element, normal_force, status, approach, compliance, half_width)
    !! `mslip_normal_approach` of n values.
    type(mslip_element), intent(in) :: element  !! An initialised element.
    real(mslip_real), intent(in) :: normal_force(:)  !! Normal force [N], >= 0.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_ELEMENT, MSLIP_BAD_NORMAL_FORCE, or MSLIP_LENGTH_TOO_SHORT for a force under which the
      !! contact would be too wide for its length.
    real(mslip_real), intent(inout), optional, target, contiguous :: approach(:)  !! Approach under the force [m].
    real(mslip_real), intent(inout), optional, target, contiguous :: compliance(:)  !! Normal compliance [m/N].
    real(mslip_real), intent(inout), optional, target, contiguous :: half_width(:)  !! Half-width of the contact [m].

    integer(mslip_size) :: n
    type(c_ptr) :: ptr(3)

    n = size(normal_force, kind=mslip_size)
    ptr = c_null_ptr
    status = MSLIP_OK
    if (present(approach)) call check_array(approach, n, ptr(1), status)
    if (present(compliance)) call check_array(compliance, n, ptr(2), status)
    if (present(half_width)) call check_array(half_width, n, ptr(3), status)
    if (status == MSLIP_OK) status = c_normal_approach(element, n, normal_force, ptr(1), ptr(2), ptr(3))
  end subroutine normal_approach_array

  subroutine normal_approach_scalar(element, normal_force, status, approach, compliance, half_width)
    !! `mslip_normal_approach` of one value.
    type(mslip_element), intent(in) :: element  !! An initialised element.
    real(mslip_real), intent(in) :: normal_force  !! Normal force [N], >= 0.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_ELEMENT, MSLIP_BAD_NORMAL_FORCE, or MSLIP_LENGTH_TOO_SHORT for a force under which the
      !! contact would be too wide for its length.
    real(mslip_real), intent(inout), optional, target :: approach  !! Approach under the force [m].
    real(mslip_real), intent(inout), optional, target :: compliance  !! Normal compliance [m/N].
    real(mslip_real), intent(inout), optional, target :: half_width  !! Half-width of the contact [m].

    status = c_normal_approach(element, 1_mslip_size, [normal_force], address_of(approach), address_of(compliance), &
      address_of(half_width))
  end subroutine normal_approach_scalar

  subroutine element_displacement_array(element, direction, force, normal_force, status, displacement, compliance)
    !! `mslip_element_displacement` of n values.
    type(mslip_element), intent(in) :: element  !! An initialised element.
    integer(mslip_int), intent(in) :: direction  !! The tangential direction, 0 (x) or, of an element with two directions, 1 (y).
    real(mslip_real), intent(in) :: force(:)
      !! Tangential force [N]; its magnitude is at most the friction coefficient times `normal_force`.
    real(mslip_real), intent(in) :: normal_force(:)  !! Normal force [N], >= 0.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_ELEMENT, MSLIP_BAD_DIRECTIONS for another direction, MSLIP_BAD_NORMAL_FORCE,
      !! MSLIP_LENGTH_TOO_SHORT for a normal force under which the contact would be too wide for its length,
      !! MSLIP_BAD_FORCE or MSLIP_FORCE_EXCEEDS_SLIP.
    real(mslip_real), intent(inout), optional, target, contiguous :: displacement(:)  !! Displacement that carries the force [m].
    real(mslip_real), intent(inout), optional, target, contiguous :: compliance(:)
      !! Derivative of the displacement with respect to the force [m/N].

    integer(mslip_size) :: n
    type(c_ptr) :: ptr(2)

    n = size(force, kind=mslip_size)
    ptr = c_null_ptr
    status = MSLIP_OK
    if (size(normal_force, kind=mslip_size) /= n) status = MSLIP_BAD_ARRAY_SIZE
    if (present(displacement)) call check_array(displacement, n, ptr(1), status)
    if (present(compliance)) call check_array(compliance, n, ptr(2), status)
    if (status == MSLIP_OK) status = c_element_displacement(element, direction, n, force, normal_force, ptr(1), &
      ptr(2))
  end subroutine element_displacement_array

  subroutine element_displacement_scalar(element, direction, force, normal_force, status, displacement, compliance)
    !! `mslip_element_displacement` of one value.
    type(mslip_element), intent(in) :: element  !! An initialised element.
    integer(mslip_int), intent(in) :: direction  !! The tangential direction, 0 (x) or, of an element with two directions, 1 (y).
    real(mslip_real), intent(in) :: force
      !! Tangential force [N]; its magnitude is at most the friction coefficient times `normal_force`.
    real(mslip_real), intent(in) :: normal_force  !! Normal force [N], >= 0.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_ELEMENT, MSLIP_BAD_DIRECTIONS for another direction, MSLIP_BAD_NORMAL_FORCE,
      !! MSLIP_LENGTH_TOO_SHORT for a normal force under which the contact would be too wide for its length,
      !! MSLIP_BAD_FORCE or MSLIP_FORCE_EXCEEDS_SLIP.
    real(mslip_real), intent(inout), optional, target :: displacement  !! Displacement that carries the force [m].
    real(mslip_real), intent(inout), optional, target :: compliance
      !! Derivative of the displacement with respect to the force [m/N].

    status = c_element_displacement(element, direction, 1_mslip_size, [force], [normal_force], &
      address_of(displacement), address_of(compliance))
  end subroutine element_displacement_scalar

  pure function mslip_element_state_length(directions, pieces) result(length)
    !! Number of doubles in the state of an element; 0 if directions is neither 1 nor 2. For one tangential direction it
    !! has a capacity of `pieces` pieces of the memory diagram, at least 4, and is never full: if the capacity is
    !! exceeded, the two adjacent pieces are merged for which later forces change least. For two directions the length
    !! is fixed, and `pieces` is ignored.
    !!
    !! Since 0.1.0 (interface 6).
    integer(mslip_int), intent(in) :: directions  !! Number of tangential directions, 1 or 2.
    integer(mslip_size), intent(in) :: pieces  !! Pieces of the memory diagram, >= 0; ignored for two directions.
    integer(mslip_size) :: length  !! The length. It may dimension an array.

    length = c_element_state_length(directions, pieces)
  end function mslip_element_state_length

  subroutine mslip_element_state_init(directions, state, status)
    !! Initialises the state of an element with 1 or 2 tangential directions: open, at zero displacement.
    !!
    !! Since 0.1.0 (interface 6).
    integer(mslip_int), intent(in) :: directions  !! Number of tangential directions, 1 or 2.
    real(mslip_real), intent(inout), target, contiguous :: state(:)
      !! The state, of at least `mslip_element_state_length(directions, 4)` values. Its size decides how many pieces it
      !! holds.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or MSLIP_BAD_DIRECTIONS, MSLIP_STATE_TOO_SHORT.

    status = c_element_state_init(directions, size(state, kind=mslip_size), address_of(state))
  end subroutine mslip_element_state_init

  subroutine mslip_element_state_check(directions, state, status)
    !! Validates the state of an element that was read from a file or a message: all values must be finite and possible,
    !! for one direction the pieces nested. Other functions only check a tag and the number of pieces.
    !!
    !! A state that was decimal text of 17 significant digits has every bit. With 15 or 16 digits later forces of one
    !! direction are right to 1e-12 mu N (if pieces were merged, within mslip_element_state_error); two directions need
    !! 17 digits unless the contact is open. A state of fewer digits is rejected. Not detected: values that another
    !! history leads to, such as a force or a displacement of which one bit has changed. A file needs a checksum of its
    !! own against that.
    !!
    !! Since 0.1.0 (interface 6).
    integer(mslip_int), intent(in) :: directions  !! Number of tangential directions, 1 or 2.
    real(mslip_real), intent(in) :: state(:)  !! A state.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_DIRECTIONS, also for the state of another number of directions, MSLIP_STATE_TOO_SHORT or
      !! MSLIP_BAD_STATE.

    status = c_element_state_check(directions, size(state, kind=mslip_size), state)
  end subroutine mslip_element_state_check

  subroutine mslip_element_state_error(directions, state, force_error, status)
    !! Bound on the error [N] of the tangential force due to merged pieces: 0 if none was merged since the last gross
    !! slip or separation. For two directions it is 0: the error of their law is not included.
    !!
    !! Since 0.1.0 (interface 6).
    integer(mslip_int), intent(in) :: directions  !! Number of tangential directions, 1 or 2.
    real(mslip_real), intent(in) :: state(:)  !! A state.
    real(mslip_real), intent(inout), target :: force_error  !! Bound on the error [N].
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_DIRECTIONS, also for the state of another number of directions, MSLIP_STATE_TOO_SHORT or
      !! MSLIP_BAD_STATE.

    status = c_element_state_error(directions, size(state, kind=mslip_size), state, address_of(force_error))
  end subroutine mslip_element_state_error

  subroutine mslip_element_update(element, state_old, displacement, state_new, status, force, tangent, dissipated)
    !! Advances the state of an element to a displacement: [u, w] with one tangential direction, [u, v, w] with two,
    !! tangential displacements [m] and the normal approach [m] or the normal force [N]. With m = 2 or 3 components,
    !! force(m) [N] is [T, N] or [Tx, Ty, N], tangent(m m) [N/m] is d force_i / d displacement_j, m x m, column-major,
    !! consistent with the step and one-sided at corners, dissipated [J] the energy dissipated in this step. Only the
    !! used part of the new state is written: initialise both states to store or compare whole arrays. Within a step the
    !! path is straight in the tangential displacement and the tangential shift S of the contact size. A step of no
    !! length changes neither force nor state; its tangent is with one direction the tangent of the step before, with
    !! two that of the stuck contact.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_element), intent(in) :: element  !! An initialised element.
    real(mslip_real), intent(in), target, contiguous :: state_old(:)  !! State before the step or path.
    real(mslip_real), intent(in) :: displacement(:)
      !! Tangential displacements [m], then the normal approach [m] or the normal force [N] at the end of the step.
    real(mslip_real), intent(inout), target, contiguous :: state_new(:)
      !! New state, of the same size. For a step or path in place use the procedure named `_advance`.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_ELEMENT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_DIRECTIONS for the state of another number of
      !! directions, MSLIP_BAD_STATE, MSLIP_BAD_DISPLACEMENT, MSLIP_BAD_NORMAL_FORCE, or MSLIP_LENGTH_TOO_SHORT if the
      !! contact would be too wide for its length.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:)
      !! Tangential forces, then the normal force at the end of the step [N].
    real(mslip_real), intent(inout), optional, target, contiguous :: tangent(:, :)
      !! (m, m): Derivative of force component i with respect to displacement component j.
    real(mslip_real), intent(inout), optional, target :: dissipated  !! Energy dissipated by the step [J].

    integer(mslip_size) :: m
    type(c_ptr) :: ptr(3)

    m = components(element, size(displacement, kind=mslip_size))
    ptr = c_null_ptr
    status = MSLIP_OK
    if (size(displacement, kind=mslip_size) /= m) status = MSLIP_BAD_ARRAY_SIZE
    call check_array(state_new, size(state_old, kind=mslip_size), ptr(1), status)
    if (present(force)) call check_array(force, m, ptr(2), status)
    if (present(tangent)) call check_array(tangent, [m, m], ptr(3), status)
    if (status == MSLIP_OK) status = c_element_update(element, size(state_old, kind=mslip_size), &
      address_of(state_old), displacement, ptr(1), ptr(2), ptr(3), address_of(dissipated))
  end subroutine mslip_element_update

  subroutine mslip_element_advance(element, state, displacement, status, force, tangent, dissipated)
    !! `mslip_element_update` in place: the new state replaces the old one.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_element), intent(in) :: element  !! An initialised element.
    real(mslip_real), intent(inout), target, contiguous :: state(:)  !! State before and after the step or path.
    real(mslip_real), intent(in) :: displacement(:)
      !! Tangential displacements [m], then the normal approach [m] or the normal force [N] at the end of the step.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_ELEMENT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_DIRECTIONS for the state of another number of
      !! directions, MSLIP_BAD_STATE, MSLIP_BAD_DISPLACEMENT, MSLIP_BAD_NORMAL_FORCE, or MSLIP_LENGTH_TOO_SHORT if the
      !! contact would be too wide for its length.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:)
      !! Tangential forces, then the normal force at the end of the step [N].
    real(mslip_real), intent(inout), optional, target, contiguous :: tangent(:, :)
      !! (m, m): Derivative of force component i with respect to displacement component j.
    real(mslip_real), intent(inout), optional, target :: dissipated  !! Energy dissipated by the step [J].

    integer(mslip_size) :: m
    type(c_ptr) :: ptr(2)

    m = components(element, size(displacement, kind=mslip_size))
    ptr = c_null_ptr
    status = MSLIP_OK
    if (size(displacement, kind=mslip_size) /= m) status = MSLIP_BAD_ARRAY_SIZE
    if (present(force)) call check_array(force, m, ptr(1), status)
    if (present(tangent)) call check_array(tangent, [m, m], ptr(2), status)
    if (status == MSLIP_OK) status = c_element_update(element, size(state, kind=mslip_size), address_of(state), &
      displacement, address_of(state), ptr(1), ptr(2), address_of(dissipated))
  end subroutine mslip_element_advance

  subroutine mslip_element_path(element, state_old, displacement, state_new, status, force, tangent, dissipated)
    !! Advances the state of an element through n displacements. With m = 2 components for one tangential direction, [u,
    !! w], and m = 3 for two, [u, v, w], displacement and force hold m doubles per step, tangent m x m, dissipated one;
    !! units are those of mslip_element_update.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_element), intent(in) :: element  !! An initialised element.
    real(mslip_real), intent(in), target, contiguous :: state_old(:)  !! State before the step or path.
    real(mslip_real), intent(in) :: displacement(:, :)
      !! (m, n): Tangential displacements [m], then the normal approach [m] or the normal force [N] at the end of the
      !! step.
    real(mslip_real), intent(inout), target, contiguous :: state_new(:)
      !! New state, of the same size. For a step or path in place use the procedure named `_advance`.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or the codes of mslip_element_update.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:, :)
      !! (m, n): Tangential forces, then the normal force at the end of the step [N].
    real(mslip_real), intent(inout), optional, target, contiguous :: tangent(:, :, :)
      !! (m, m, n): Derivative of force component i with respect to displacement component j.
    real(mslip_real), intent(inout), optional, target, contiguous :: dissipated(:)  !! Energy dissipated by the step [J].

    integer(mslip_size) :: m, n
    type(c_ptr) :: ptr(4)

    m = components(element, size(displacement, 1, mslip_size))
    n = size(displacement, 2, mslip_size)
    ptr = c_null_ptr
    status = MSLIP_OK
    if (size(displacement, 1, mslip_size) /= m) status = MSLIP_BAD_ARRAY_SIZE
    call check_array(state_new, size(state_old, kind=mslip_size), ptr(1), status)
    if (present(force)) call check_array(force, [m, n], ptr(2), status)
    if (present(tangent)) call check_array(tangent, [m, m, n], ptr(3), status)
    if (present(dissipated)) call check_array(dissipated, n, ptr(4), status)
    if (status == MSLIP_OK) status = c_element_path(element, size(state_old, kind=mslip_size), &
      address_of(state_old), n, displacement, ptr(1), ptr(2), ptr(3), ptr(4))
  end subroutine mslip_element_path

  subroutine mslip_element_path_advance(element, state, displacement, status, force, tangent, dissipated)
    !! `mslip_element_path` in place: the new state replaces the old one.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_element), intent(in) :: element  !! An initialised element.
    real(mslip_real), intent(inout), target, contiguous :: state(:)  !! State before and after the step or path.
    real(mslip_real), intent(in) :: displacement(:, :)
      !! (m, n): Tangential displacements [m], then the normal approach [m] or the normal force [N] at the end of the
      !! step.
    integer(mslip_int), intent(out) :: status  !! `MSLIP_OK`, or the codes of mslip_element_update.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:, :)
      !! (m, n): Tangential forces, then the normal force at the end of the step [N].
    real(mslip_real), intent(inout), optional, target, contiguous :: tangent(:, :, :)
      !! (m, m, n): Derivative of force component i with respect to displacement component j.
    real(mslip_real), intent(inout), optional, target, contiguous :: dissipated(:)  !! Energy dissipated by the step [J].

    integer(mslip_size) :: m, n
    type(c_ptr) :: ptr(3)

    m = components(element, size(displacement, 1, mslip_size))
    n = size(displacement, 2, mslip_size)
    ptr = c_null_ptr
    status = MSLIP_OK
    if (size(displacement, 1, mslip_size) /= m) status = MSLIP_BAD_ARRAY_SIZE
    if (present(force)) call check_array(force, [m, n], ptr(1), status)
    if (present(tangent)) call check_array(tangent, [m, m, n], ptr(2), status)
    if (present(dissipated)) call check_array(dissipated, n, ptr(3), status)
    if (status == MSLIP_OK) status = c_element_path(element, size(state, kind=mslip_size), address_of(state), n, &
      displacement, address_of(state), ptr(1), ptr(2), ptr(3))
  end subroutine mslip_element_path_advance

  subroutine mslip_element_tractions(element, state, x, status, pressure, shear)
    !! Pressure and shear traction [Pa] at x(n) [m] along the width after a load history; 0 outside the contact.
    !! Elliptical: on the x axis. For one tangential direction.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_element), intent(in) :: element  !! An initialised element.
    real(mslip_real), intent(in) :: state(:)  !! A state.
    real(mslip_real), intent(in) :: x(:)  !! Positions from the centre [m].
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_ELEMENT, MSLIP_NOT_AVAILABLE for two directions, MSLIP_STATE_TOO_SHORT,
      !! MSLIP_BAD_DIRECTIONS for the state of two directions, MSLIP_BAD_STATE or MSLIP_BAD_POSITION.
    real(mslip_real), intent(inout), optional, target, contiguous :: pressure(:)  !! Pressure at each x [Pa].
    real(mslip_real), intent(inout), optional, target, contiguous :: shear(:)  !! Shear traction at each x [Pa].

    integer(mslip_size) :: n
    type(c_ptr) :: ptr(2)

    n = size(x, kind=mslip_size)
    ptr = c_null_ptr
    status = MSLIP_OK
    if (present(pressure)) call check_array(pressure, n, ptr(1), status)
    if (present(shear)) call check_array(shear, n, ptr(2), status)
    if (status == MSLIP_OK) status = c_element_tractions(element, size(state, kind=mslip_size), state, n, x, ptr(1), &
      ptr(2))
  end subroutine mslip_element_tractions

  pure function mslip_element_workspace_length(directions, harmonics, samples, rule) result(length)
    !! Number of doubles in a workspace of elements with 1 or 2 tangential directions for H harmonics, H >= 1, more than
    !! 2H samples per period, and MSLIP_UNIFORM_SAMPLING; 0 if these are not allowed or not available.
    !!
    !! Since 0.1.0 (interface 6).
    integer(mslip_int), intent(in) :: directions  !! Number of tangential directions, 1 or 2.
    integer(mslip_size), intent(in) :: harmonics  !! Highest harmonic H, >= 1.
    integer(mslip_size), intent(in) :: samples  !! Samples per period, > 2H.
    integer(mslip_int), intent(in), optional :: rule  !! `MSLIP_UNIFORM_SAMPLING`, the default and the only one.
    integer(mslip_size) :: length  !! The length. It may dimension an array.

    ! A C length beyond the largest integer of this kind arrives negative.
    length = max(c_element_workspace_length(directions, harmonics, samples, rule_or_default(rule)), 0_mslip_size)
  end function mslip_element_workspace_length

  subroutine mslip_element_workspace_init(directions, harmonics, samples, periods, workspace, status, rule)
    !! Initialises a workspace of elements: tables for one (directions, harmonics, samples, rule), and scratch memory.
    !! Each thread needs its own. periods is the number of periods that are applied before the returned one, at most
    !! 65536. 0 is the default: 4 with two directions; 1 with one, where a larger number changes neither results nor
    !! time.
    !!
    !! Since 0.1.0 (interface 6).
    integer(mslip_int), intent(in) :: directions  !! Number of tangential directions, 1 or 2.
    integer(mslip_size), intent(in) :: harmonics  !! Highest harmonic H, >= 1.
    integer(mslip_size), intent(in) :: samples  !! Samples per period, > 2H.
    integer(mslip_size), intent(in) :: periods
      !! Periods that are applied before the returned one, at most 65536; 0 is the default: 4 with two directions, 1
      !! with one.
    real(mslip_real), intent(inout), target, contiguous :: workspace(:)
      !! The workspace, of at least `mslip_element_workspace_length(directions, harmonics, samples, rule)` values.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, or MSLIP_BAD_DIRECTIONS, MSLIP_BAD_RULE, MSLIP_NOT_AVAILABLE for MSLIP_EVENT_DRIVEN,
      !! MSLIP_BAD_HARMONICS, MSLIP_BAD_SAMPLES, MSLIP_BAD_PERIODS, MSLIP_WORKSPACE_TOO_SHORT.
    integer(mslip_int), intent(in), optional :: rule  !! `MSLIP_UNIFORM_SAMPLING`, the default and the only one.

    status = c_element_workspace_init(directions, harmonics, samples, rule_or_default(rule), periods, &
      size(workspace, kind=mslip_size), address_of(workspace))
  end subroutine mslip_element_workspace_init

  subroutine mslip_element_harmonic_force(element, workspace, displacement, status, force, jacobian, dissipated, &
    drift)
    !! Harmonic force of an element in steady state, by alternating frequency/time (AFT). displacement and force hold
    !! component after component, each 2H+1 coefficients [c0, cos1, sin1, cos2, sin2, ...]: with one tangential
    !! direction m = 2 components, u [m] and w, T and N [N], with two directions m = 3, u, v [m] and w, Tx, Ty and N
    !! [N]. The normal component w of the displacement is the approach [m] or the normal force [N]. jacobian is d
    !! force_i / d displacement_j, m(2H+1) x m(2H+1), column-major: the exact derivative of the discrete force,
    !! one-sided at corners. dissipated [J] is the work of the tangential force in the returned period, pi sum k (c_k
    !! s'_k - s_k c'_k) from the coefficients of force and displacement, over the tangential directions; if rounding
    !! makes it negative, 0.
    !!
    !! Steady state: at the first sample of the largest normal force the element is pressed without tangential
    !! displacement and then displaced at constant normal force. It advances from there through the periods of the
    !! workspace and one more, which is returned. The Jacobian is the derivative for a fixed start. If w is constant,
    !! any variation of w moves the start to another sample, and the mean tangential force may depend on the start.
    !!
    !! With one direction the returned period is the steady state. With two, a vibration across a mean tangential force
    !! reduces that force over many periods. Before the last two, of which the second is returned, the motion advances
    !! by 32 samples for each cycle of the highest harmonic, if there are more. With 3 periods or more, the memory after
    !! the second is extrapolated by 1.75 times its change in that period. drift estimates the largest difference of the
    !! tangential force between the returned period and the steady state, over mu times the largest normal force; 0 with
    !! one direction, and for a contact that opens, because that erases its memory. A drift is not an error. While the
    !! force drifts, dissipated contains the change of the stored energy.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_element), intent(in) :: element  !! An initialised element.
    real(mslip_real), intent(inout), target, contiguous :: workspace(:)
      !! An initialised workspace; it decides H, and that of an element m.
    real(mslip_real), intent(in) :: displacement(:)
      !! Coefficients of the tangential displacements [m], then of the normal approach [m] or the normal force [N].
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_ELEMENT, MSLIP_BAD_WORKSPACE, MSLIP_BAD_DIRECTIONS for the workspace of another number of
      !! directions, MSLIP_BAD_DISPLACEMENT, MSLIP_BAD_NORMAL_FORCE if the normal force of a sample is negative, or
      !! MSLIP_LENGTH_TOO_SHORT if the contact would be too wide for its length at a sample.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:)
      !! Coefficients of the tangential forces, then of the normal force [N].
    real(mslip_real), intent(inout), optional, target, contiguous :: jacobian(:, :)
      !! (k, k): Derivatives of the force coefficients with respect to the displacement coefficients.
    real(mslip_real), intent(inout), optional, target :: dissipated
      !! Work of the tangential force in the returned period, the energy dissipated [J].
    real(mslip_real), intent(inout), optional, target :: drift
      !! Estimate of the largest difference of the tangential force from the steady state, over mu times the largest
      !! normal force.

    integer(mslip_size) :: k
    type(c_ptr) :: ptr(2)

    call count_element_coefficients(workspace, k, status)
    if (status /= MSLIP_OK) return
    ptr = c_null_ptr
    if (present(force)) call check_array(force, k, ptr(1), status)
    if (present(jacobian)) call check_array(jacobian, [k, k], ptr(2), status)
    if (size(displacement, kind=mslip_size) /= k) status = MSLIP_BAD_COEFFICIENTS
    if (status == MSLIP_OK) status = c_element_harmonic_force(element, address_of(workspace), displacement, ptr(1), &
      ptr(2), address_of(dissipated), address_of(drift))
  end subroutine mslip_element_harmonic_force

  subroutine mslip_batch_element_update(elements, states_old, displacement, states_new, status, index, active, &
    force, tangent, dissipated, failed_item)
    !! mslip_element_update for n items, all with the same number of tangential directions: states hold state_length
    !! doubles per item, contiguously; with m = 2 components for one direction, 3 for two, displacement and force hold m
    !! doubles per item, tangent m x m, dissipated one; m is that of the first item that is not skipped.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_element), intent(in) :: elements(:)  !! Initialised elements.
    real(mslip_real), intent(in), target, contiguous :: states_old(:, :)
      !! (state length, n): the state of each item before the step.
    real(mslip_real), intent(in) :: displacement(:, :)
      !! (m, n): Tangential displacements [m], then the normal approach [m] or the normal force [N] at the end of the
      !! step.
    real(mslip_real), intent(inout), target, contiguous :: states_new(:, :)
      !! (state length, n): the state of each item after the step. For a step in place use the procedure named
      !! `_advance`.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_INDEX, MSLIP_BAD_DIRECTIONS for elements or states of different numbers of directions, or
      !! the codes of mslip_element_update.
    integer(mslip_int), intent(in), optional :: index(:)
      !! n indices of contacts or elements, from 1 (`MSLIP_BAD_INDEX`). Absent: each item has its own.
    integer(mslip_int), intent(in), optional, target, contiguous :: active(:)
      !! n flags: an item with flag 0 is skipped, and its state and outputs keep their values. Absent: no item is
      !! skipped.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:, :)
      !! (m, n): Tangential forces, then the normal force at the end of the step [N].
    real(mslip_real), intent(inout), optional, target, contiguous :: tangent(:, :, :)
      !! (m, m, n): Derivative of force component i with respect to displacement component j.
    real(mslip_real), intent(inout), optional, target, contiguous :: dissipated(:)  !! Energy dissipated by the step [J].
    integer(mslip_size), intent(inout), optional :: failed_item
      !! On an error the first item at fault, from 1; 0 if the error is not the error of an item. Not written on
      !! success.

    integer(mslip_size) :: m, n
    integer(mslip_int), allocatable, target :: from_zero(:)
    integer(mslip_size), target :: failed
    type(c_ptr) :: ptr(7)

    m = size(displacement, 1, mslip_size)
    n = size(displacement, 2, mslip_size)
    failed = n
    ptr = c_null_ptr
    call check_index(size(elements, kind=mslip_size), n, index, from_zero, ptr(1), status)
    if (present(active)) call check_array(active, n, ptr(2), status)
    call check_array(states_old, [size(states_old, 1, mslip_size), n], ptr(3), status)
    call check_array(states_new, [size(states_old, 1, mslip_size), n], ptr(4), status)
    if (present(force)) call check_array(force, [m, n], ptr(5), status)
    if (present(tangent)) call check_array(tangent, [m, m, n], ptr(6), status)
    if (present(dissipated)) call check_array(dissipated, n, ptr(7), status)
    if (status == MSLIP_OK) call check_components(elements, m, n, index, active, status)
    if (status == MSLIP_OK) status = c_batch_element_update(n, size(elements, kind=mslip_size), elements, ptr(1), &
      ptr(2), size(states_old, 1, mslip_size), ptr(3), displacement, ptr(4), ptr(5), ptr(6), ptr(7), c_loc(failed))
    ! C counts from 0, and gives n if no item is at fault.
    if (present(failed_item) .and. status /= MSLIP_OK) failed_item = merge(failed + 1, 0_mslip_size, failed < n)
  end subroutine mslip_batch_element_update

  subroutine mslip_batch_element_advance(elements, states, displacement, status, index, active, force, tangent, &
    dissipated, failed_item)
    !! `mslip_batch_element_update` in place: the new state replaces the old one.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_element), intent(in) :: elements(:)  !! Initialised elements.
    real(mslip_real), intent(inout), target, contiguous :: states(:, :)
      !! (state length, n): the state of each item before and after the step.
    real(mslip_real), intent(in) :: displacement(:, :)
      !! (m, n): Tangential displacements [m], then the normal approach [m] or the normal force [N] at the end of the
      !! step.
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_INDEX, MSLIP_BAD_DIRECTIONS for elements or states of different numbers of directions, or
      !! the codes of mslip_element_update.
    integer(mslip_int), intent(in), optional :: index(:)
      !! n indices of contacts or elements, from 1 (`MSLIP_BAD_INDEX`). Absent: each item has its own.
    integer(mslip_int), intent(in), optional, target, contiguous :: active(:)
      !! n flags: an item with flag 0 is skipped, and its state and outputs keep their values. Absent: no item is
      !! skipped.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:, :)
      !! (m, n): Tangential forces, then the normal force at the end of the step [N].
    real(mslip_real), intent(inout), optional, target, contiguous :: tangent(:, :, :)
      !! (m, m, n): Derivative of force component i with respect to displacement component j.
    real(mslip_real), intent(inout), optional, target, contiguous :: dissipated(:)  !! Energy dissipated by the step [J].
    integer(mslip_size), intent(inout), optional :: failed_item
      !! On an error the first item at fault, from 1; 0 if the error is not the error of an item. Not written on
      !! success.

    integer(mslip_size) :: m, n
    integer(mslip_int), allocatable, target :: from_zero(:)
    integer(mslip_size), target :: failed
    type(c_ptr) :: ptr(6)

    m = size(displacement, 1, mslip_size)
    n = size(displacement, 2, mslip_size)
    failed = n
    ptr = c_null_ptr
    call check_index(size(elements, kind=mslip_size), n, index, from_zero, ptr(1), status)
    if (present(active)) call check_array(active, n, ptr(2), status)
    call check_array(states, [size(states, 1, mslip_size), n], ptr(3), status)
    if (present(force)) call check_array(force, [m, n], ptr(4), status)
    if (present(tangent)) call check_array(tangent, [m, m, n], ptr(5), status)
    if (present(dissipated)) call check_array(dissipated, n, ptr(6), status)
    if (status == MSLIP_OK) call check_components(elements, m, n, index, active, status)
    if (status == MSLIP_OK) status = c_batch_element_update(n, size(elements, kind=mslip_size), elements, ptr(1), &
      ptr(2), size(states, 1, mslip_size), ptr(3), displacement, ptr(3), ptr(4), ptr(5), ptr(6), c_loc(failed))
    ! C counts from 0, and gives n if no item is at fault.
    if (present(failed_item) .and. status /= MSLIP_OK) failed_item = merge(failed + 1, 0_mslip_size, failed < n)
  end subroutine mslip_batch_element_advance

  subroutine mslip_batch_element_harmonic_force(elements, workspace, displacement, status, index, active, force, &
    jacobian, dissipated, drift, failed_item)
    !! mslip_element_harmonic_force for n items with one workspace: with m = 2 components for a workspace of one
    !! tangential direction, 3 for one of two, displacement and force hold m(2H+1) doubles per item, jacobian
    !! (m(2H+1))^2, dissipated and drift one.
    !!
    !! Since 0.1.0 (interface 6).
    type(mslip_element), intent(in) :: elements(:)  !! Initialised elements.
    real(mslip_real), intent(inout), target, contiguous :: workspace(:)
      !! An initialised workspace; it decides H, and that of an element m.
    real(mslip_real), intent(in) :: displacement(:, :)
      !! (k, n): Coefficients of the tangential displacements [m], then of the normal approach [m] or the normal force
      !! [N].
    integer(mslip_int), intent(out) :: status
      !! `MSLIP_OK`, MSLIP_BAD_INDEX or the codes of mslip_element_harmonic_force, MSLIP_BAD_DIRECTIONS for an element
      !! with another number of directions than the workspace.
    integer(mslip_int), intent(in), optional :: index(:)
      !! n indices of contacts or elements, from 1 (`MSLIP_BAD_INDEX`). Absent: each item has its own.
    integer(mslip_int), intent(in), optional, target, contiguous :: active(:)
      !! n flags: an item with flag 0 is skipped, and its state and outputs keep their values. Absent: no item is
      !! skipped.
    real(mslip_real), intent(inout), optional, target, contiguous :: force(:, :)
      !! (k, n): Coefficients of the tangential forces, then of the normal force [N].
    real(mslip_real), intent(inout), optional, target, contiguous :: jacobian(:, :, :)
      !! (k, k, n): Derivatives of the force coefficients with respect to the displacement coefficients.
    real(mslip_real), intent(inout), optional, target, contiguous :: dissipated(:)
      !! Work of the tangential force in the returned period, the energy dissipated [J].
    real(mslip_real), intent(inout), optional, target, contiguous :: drift(:)
      !! Estimate of the largest difference of the tangential force from the steady state, over mu times the largest
      !! normal force.
    integer(mslip_size), intent(inout), optional :: failed_item
      !! On an error the first item at fault, from 1; 0 if the error is not the error of an item. Not written on
      !! success.

    integer(mslip_size) :: k, n
    integer(mslip_int), allocatable, target :: from_zero(:)
    integer(mslip_size), target :: failed
    type(c_ptr) :: ptr(6)

    call count_element_coefficients(workspace, k, status)
    if (present(failed_item) .and. status /= MSLIP_OK) failed_item = 0
    if (status /= MSLIP_OK) return
    n = size(displacement, 2, mslip_size)
    failed = n
    ptr = c_null_ptr
    call check_index(size(elements, kind=mslip_size), n, index, from_zero, ptr(1), status)
    if (present(active)) call check_array(active, n, ptr(2), status)
    if (present(force)) call check_array(force, [k, n], ptr(3), status)
    if (present(jacobian)) call check_array(jacobian, [k, k, n], ptr(4), status)
    if (present(dissipated)) call check_array(dissipated, n, ptr(5), status)
    if (present(drift)) call check_array(drift, n, ptr(6), status)
    if (size(displacement, 1, mslip_size) /= k) status = MSLIP_BAD_COEFFICIENTS
    if (status == MSLIP_OK) status = c_batch_element_harmonic_force(n, size(elements, kind=mslip_size), elements, &
      ptr(1), ptr(2), address_of(workspace), displacement, ptr(3), ptr(4), ptr(5), ptr(6), c_loc(failed))
    ! C counts from 0, and gives n if no item is at fault.
    if (present(failed_item) .and. status /= MSLIP_OK) failed_item = merge(failed + 1, 0_mslip_size, failed < n)
  end subroutine mslip_batch_element_harmonic_force
  ! </generated>

  ! ---------------------------------------------------------------------------------------------------------------------
  ! Conversion between Fortran and C

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

  pure function rule_or_default(rule)
    ! A function, because a pure procedure with a local variable is rejected with -fno-automatic.
    integer(mslip_int), intent(in), optional :: rule
    integer(mslip_int) :: rule_or_default

    rule_or_default = MSLIP_UNIFORM_SAMPLING
    if (present(rule)) rule_or_default = rule
  end function rule_or_default

  pure function components(element, given) result(m)
    ! The number of components of a displacement of an element; the given one if it is uninitialised, which C rejects.
    type(mslip_element), intent(in) :: element
    integer(mslip_size), intent(in) :: given
    integer(mslip_size) :: m

    m = given
    if (element%directions == 1) m = 2
    if (element%directions == 2) m = 3
  end function components

  subroutine check_components(elements, m, n, index, active, status)
    ! The first active item decides for C how many components all have; if it has no element, none is read.
    type(mslip_element), intent(in) :: elements(:)
    integer(mslip_size), intent(in) :: m, n
    integer(mslip_int), intent(in), optional :: index(:), active(:)
    integer(mslip_int), intent(inout) :: status

    integer(mslip_size) :: i, item
    logical :: is_active

    if (m < 2 .or. m > 3) status = MSLIP_BAD_ARRAY_SIZE
    do i = 1, n
      is_active = .true.
      if (present(active)) is_active = active(i) /= 0
      if (.not. is_active) cycle
      item = i
      if (present(index)) item = index(i)
      if (item < 1 .or. item > size(elements, kind=mslip_size)) exit
      if (components(elements(item), m) /= m) status = MSLIP_BAD_ARRAY_SIZE
      exit
    end do
  end subroutine check_components

  subroutine count_coefficients(workspace, m, status)
    ! The number 2H+1 of coefficients of a workspace.
    real(mslip_real), intent(in), contiguous :: workspace(:)
    integer(mslip_size), intent(out) :: m
    integer(mslip_int), intent(out) :: status

    integer(mslip_size) :: samples
    integer(mslip_int) :: rule

    m = 0
    call mslip_harmonic_workspace_size(workspace, m, samples, rule, status)
    m = 2*m + 1
  end subroutine count_coefficients

  subroutine count_element_coefficients(workspace, m, status)
    ! The number m(2H+1) of coefficients of a workspace of elements.
    real(mslip_real), intent(in), contiguous :: workspace(:)
    integer(mslip_size), intent(out) :: m
    integer(mslip_int), intent(out) :: status

    integer(mslip_size) :: samples, periods
    integer(mslip_int) :: directions, rule

    m = 0
    directions = 0
    call mslip_element_workspace_size(workspace, directions, m, samples, rule, periods, status)
    m = (directions + 1)*(2*m + 1)
  end subroutine count_element_coefficients

  subroutine check_index(n_laws, n, index, from_zero, ptr, status)
    ! The index of a batch as a copy that counts from 0; without an index, each of the n items has a contact or element of its own.
    integer(mslip_size), intent(in) :: n_laws, n
    integer(mslip_int), intent(in), optional :: index(:)
    integer(mslip_int), intent(out), allocatable, target :: from_zero(:)
    type(c_ptr), intent(inout) :: ptr
    integer(mslip_int), intent(out) :: status

    integer :: failure

    status = MSLIP_OK
    if (present(index)) then
      allocate (from_zero(size(index, kind=mslip_size)), stat=failure)
      if (failure /= 0) then
        status = MSLIP_BAD_ARRAY_SIZE
      else
        from_zero(:) = max(index, 0_mslip_int) - 1_mslip_int
        call check_array(from_zero, n, ptr, status)
      end if
    else if (n_laws /= n) then
      status = MSLIP_BAD_ARRAY_SIZE
    end if
  end subroutine check_index

  function address_of_scalar(a) result(ptr)
    real(mslip_real), intent(in), optional, target :: a
    type(c_ptr) :: ptr

    ptr = c_null_ptr
    if (present(a)) ptr = c_loc(a)
  end function address_of_scalar

  function address_of_array(a) result(ptr)
    real(mslip_real), intent(in), target, contiguous :: a(:)
    type(c_ptr) :: ptr

    ptr = c_loc(no_elements)
    if (size(a, kind=mslip_size) > 0) ptr = c_loc(a)
  end function address_of_array

  subroutine check_vector(a, extent, ptr, status)
    real(mslip_real), intent(in), target, contiguous :: a(:)
    integer(mslip_size), intent(in) :: extent
    type(c_ptr), intent(out) :: ptr
    integer(mslip_int), intent(inout) :: status

    ptr = address_of(a)
    if (size(a, kind=mslip_size) /= extent) status = MSLIP_BAD_ARRAY_SIZE
  end subroutine check_vector

  subroutine check_matrix(a, extents, ptr, status)
    real(mslip_real), intent(in), target, contiguous :: a(:, :)
    integer(mslip_size), intent(in) :: extents(2)
    type(c_ptr), intent(out) :: ptr
    integer(mslip_int), intent(inout) :: status

    ptr = c_loc(no_elements)
    if (size(a, kind=mslip_size) > 0) ptr = c_loc(a)
    if (any(shape(a, mslip_size) /= extents)) status = MSLIP_BAD_ARRAY_SIZE
  end subroutine check_matrix

  subroutine check_matrices(a, extents, ptr, status)
    real(mslip_real), intent(in), target, contiguous :: a(:, :, :)
    integer(mslip_size), intent(in) :: extents(3)
    type(c_ptr), intent(out) :: ptr
    integer(mslip_int), intent(inout) :: status

    ptr = c_loc(no_elements)
    if (size(a, kind=mslip_size) > 0) ptr = c_loc(a)
    if (any(shape(a, mslip_size) /= extents)) status = MSLIP_BAD_ARRAY_SIZE
  end subroutine check_matrices

  subroutine check_flags(a, extent, ptr, status)
    integer(mslip_int), intent(in), target, contiguous :: a(:)
    integer(mslip_size), intent(in) :: extent
    type(c_ptr), intent(out) :: ptr
    integer(mslip_int), intent(inout) :: status

    ptr = c_loc(no_elements)
    if (size(a, kind=mslip_size) > 0) ptr = c_loc(a)
    if (size(a, kind=mslip_size) /= extent) status = MSLIP_BAD_ARRAY_SIZE
  end subroutine check_flags

end module microslip
