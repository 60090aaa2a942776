/* The binary interface: programs that were linked with one library of this MSLIP_ABI_VERSION run with each other one. Written by
   `make header`, which may change this file until CHANGELOG.md has a release with the version, and only add to it afterwards.

   Numbers in STRUCTURE and FIELD are bytes, those in LENGTH doubles. The includer defines the macros. */

CONSTANT(MSLIP_NULL_POINTER, 1)
CONSTANT(MSLIP_BAD_FLAT_HALF_WIDTH, 2)
CONSTANT(MSLIP_BAD_EDGE_RADIUS, 3)
CONSTANT(MSLIP_BAD_LENGTH, 4)
CONSTANT(MSLIP_BAD_NORMAL_FORCE, 5)
CONSTANT(MSLIP_BAD_FRICTION_COEFFICIENT, 6)
CONSTANT(MSLIP_BAD_YOUNG_MODULUS, 7)
CONSTANT(MSLIP_BAD_POISSON_RATIO, 8)
CONSTANT(MSLIP_BAD_DISPLACEMENT_REFERENCE, 9)
CONSTANT(MSLIP_BAD_SEMI_AXIS_X, 10)
CONSTANT(MSLIP_BAD_SEMI_AXIS_Y, 11)
CONSTANT(MSLIP_LENGTH_TOO_SHORT, 12)
CONSTANT(MSLIP_OUT_OF_RANGE, 13)
CONSTANT(MSLIP_BAD_NORMAL_COMPLIANCE, 15)
CONSTANT(MSLIP_BAD_TANGENTIAL_COMPLIANCE, 16)
CONSTANT(MSLIP_BAD_STIFFENING_LOAD, 17)
CONSTANT(MSLIP_BAD_REFERENCE_LOAD, 18)
CONSTANT(MSLIP_BAD_CONTACT, 20)
CONSTANT(MSLIP_BAD_STATE, 21)
CONSTANT(MSLIP_BAD_WORKSPACE, 22)
CONSTANT(MSLIP_STATE_TOO_SHORT, 23)
CONSTANT(MSLIP_BAD_ELEMENT, 24)
CONSTANT(MSLIP_WORKSPACE_TOO_SHORT, 25)
CONSTANT(MSLIP_BAD_FORCE, 30)
CONSTANT(MSLIP_FORCE_EXCEEDS_SLIP, 31)
CONSTANT(MSLIP_BAD_DISPLACEMENT, 32)
CONSTANT(MSLIP_BAD_POSITION, 33)
CONSTANT(MSLIP_BAD_AMPLITUDE, 34)
CONSTANT(MSLIP_BAD_FORCE_AMPLITUDE, 35)
CONSTANT(MSLIP_BAD_HARMONICS, 36)
CONSTANT(MSLIP_BAD_SAMPLES, 37)
CONSTANT(MSLIP_BAD_COUNT, 38)
CONSTANT(MSLIP_BAD_RULE, 39)
CONSTANT(MSLIP_NOT_AVAILABLE, 40)
CONSTANT(MSLIP_BAD_INDEX, 41)
CONSTANT(MSLIP_BAD_DIRECTIONS, 42)
CONSTANT(MSLIP_BAD_NORMAL_INPUT, 43)
CONSTANT(MSLIP_BAD_PERIODS, 44)
CONSTANT(MSLIP_BAD_COEFFICIENTS, 45)
CONSTANT(MSLIP_BAD_AREA, 46)
CONSTANT(MSLIP_BAD_PRESSURE, 47)
CONSTANT(MSLIP_BAD_ARRAY_SIZE, 90)
CONSTANT(MSLIP_BAD_ALIGNMENT, 91)
CONSTANT(MSLIP_ABI_VERSION, 6)
CONSTANT(MSLIP_CENTRE_POINT, 0)
CONSTANT(MSLIP_RIGID_STRIP, 1)
CONSTANT(MSLIP_UNIFORM_SAMPLING, 0)
CONSTANT(MSLIP_EVENT_DRIVEN, 1)
CONSTANT(MSLIP_INPUT_APPROACH, 16)
CONSTANT(MSLIP_INPUT_NORMAL_FORCE, 17)
CONSTANT(MSLIP_BY_NORMAL_FORCE, 0)
CONSTANT(MSLIP_BY_FRICTION_COEFFICIENT, 1)
CONSTANT(MSLIP_BY_FLAT_HALF_WIDTH, 2)
CONSTANT(MSLIP_BY_EDGE_RADIUS, 3)
CONSTANT(MSLIP_BY_LENGTH, 4)
CONSTANT(MSLIP_BY_COMPOSITE_MODULUS, 5)
CONSTANT(MSLIP_BY_LAYER_COMPLIANCE, 6)
CONSTANT(MSLIP_PARAMETER_COUNT, 7)
CONSTANT(MSLIP_OK, 0)

STRUCTURE(mslip_material, 16)
FIELD(mslip_material, young_modulus, 0, double, 1)
FIELD(mslip_material, poisson_ratio, 8, double, 1)
STRUCTURE(mslip_layer, 32)
FIELD(mslip_layer, normal_compliance, 0, double, 1)
FIELD(mslip_layer, tangential_compliance, 8, double, 1)
FIELD(mslip_layer, stiffening_load, 16, double, 1)
FIELD(mslip_layer, reference_load, 24, double, 1)
STRUCTURE(mslip_parameters, 112)
FIELD(mslip_parameters, flat_half_width, 0, double, 1)
FIELD(mslip_parameters, edge_radius, 8, double, 1)
FIELD(mslip_parameters, length, 16, double, 1)
FIELD(mslip_parameters, normal_force, 24, double, 1)
FIELD(mslip_parameters, friction_coefficient, 32, double, 1)
FIELD(mslip_parameters, material, 40, mslip_material, 2)
FIELD(mslip_parameters, layer, 72, mslip_layer, 1)
FIELD(mslip_parameters, displacement_reference, 104, int32_t, 1)
FIELD(mslip_parameters, reserved, 108, int32_t, 1)
STRUCTURE(mslip_elliptic_parameters, 96)
FIELD(mslip_elliptic_parameters, semi_axis_x, 0, double, 1)
FIELD(mslip_elliptic_parameters, semi_axis_y, 8, double, 1)
FIELD(mslip_elliptic_parameters, normal_force, 16, double, 1)
FIELD(mslip_elliptic_parameters, friction_coefficient, 24, double, 1)
FIELD(mslip_elliptic_parameters, material, 32, mslip_material, 2)
FIELD(mslip_elliptic_parameters, layer, 64, mslip_layer, 1)
STRUCTURE(mslip_contact, 3032)
FIELD(mslip_contact, composite_modulus, 0, double, 1)
FIELD(mslip_contact, half_width, 8, double, 1)
FIELD(mslip_contact, slip_force, 16, double, 1)
FIELD(mslip_contact, slip_displacement, 24, double, 1)
FIELD(mslip_contact, initial_stiffness, 32, double, 1)
FIELD(mslip_contact, slip_energy, 40, double, 1)
FIELD(mslip_contact, reserved, 48, double, 373)
STRUCTURE(mslip_element, 14888)
FIELD(mslip_element, composite_modulus, 0, double, 1)
FIELD(mslip_element, friction_coefficient, 8, double, 1)
FIELD(mslip_element, normal_force, 16, double, 1)
FIELD(mslip_element, half_width, 24, double, 1)
FIELD(mslip_element, approach, 32, double, 1)
FIELD(mslip_element, normal_stiffness, 40, double, 1)
FIELD(mslip_element, tangential_stiffness, 48, double, 1)
FIELD(mslip_element, directions, 56, int32_t, 1)
FIELD(mslip_element, normal_input, 60, int32_t, 1)
FIELD(mslip_element, reserved, 64, double, 1853)

FUNCTION(const char *, mslip_version, (void))
FUNCTION(int32_t, mslip_abi_version, (void))
FUNCTION(const char *, mslip_status_text, (int32_t status))
FUNCTION(void, mslip_parameters_default, (struct mslip_parameters *p))
FUNCTION(void, mslip_elliptic_parameters_default, (struct mslip_elliptic_parameters *p))
FUNCTION(const char *, mslip_parameters_warning, (const struct mslip_parameters *p, int32_t i))
FUNCTION(const char *, mslip_elliptic_parameters_warning, (const struct mslip_elliptic_parameters *p, int32_t i))
FUNCTION(int32_t, mslip_contact_init, (const struct mslip_parameters *p, struct mslip_contact *contact))
FUNCTION(int32_t, mslip_contact_init_elliptic, (const struct mslip_elliptic_parameters *p, struct mslip_contact *contact))
FUNCTION(int32_t, mslip_face_parts, (const struct mslip_parameters *p, size_t n, size_t pairs, const double *area,
     const double *pressure, struct mslip_parameters *parts, double *weight))
FUNCTION(int32_t, mslip_contact_check, (const struct mslip_contact *contact))
FUNCTION(int32_t, mslip_tractions, (const struct mslip_contact *contact, double force, size_t n, const double *x,
     double *pressure, double *shear))
FUNCTION(int32_t, mslip_slip, (const struct mslip_contact *contact, double force, size_t n, const double *x, double *slip,
     double *damage))
FUNCTION(int32_t, mslip_monotonic_displacement, (const struct mslip_contact *contact, size_t n, const double *force,
     double *displacement, double *compliance, double *stick_half_width))
FUNCTION(int32_t, mslip_monotonic_force, (const struct mslip_contact *contact, size_t n, const double *displacement,
     double *force, double *stiffness, double *stick_half_width))
FUNCTION(int32_t, mslip_monotonic_sensitivity, (const struct mslip_contact *contact, size_t n, const double *displacement,
     double *force, double *sensitivity))
FUNCTION(size_t, mslip_state_length, (size_t reversals))
FUNCTION(int32_t, mslip_state_init, (size_t state_length, double *state))
FUNCTION(int32_t, mslip_state_check, (size_t state_length, const double *state))
FUNCTION(int32_t, mslip_state_error, (size_t state_length, const double *state, double *force_error))
FUNCTION(int32_t, mslip_masing_update, (const struct mslip_contact *contact, size_t state_length, const double *state_old,
     double displacement, double *state_new, double *force, double *stiffness, double *dissipated))
FUNCTION(int32_t, mslip_masing_path, (const struct mslip_contact *contact, size_t state_length, const double *state_old,
     size_t n, const double *displacement, double *state_new, double *force, double *stiffness, double *dissipated))
FUNCTION(int32_t, mslip_masing_tractions, (const struct mslip_contact *contact, size_t state_length, const double *state,
     size_t n, const double *x, double *pressure, double *shear))
FUNCTION(int32_t, mslip_hysteresis_loop, (const struct mslip_contact *contact, double amplitude, size_t n,
     double *displacement, double *force))
FUNCTION(int32_t, mslip_dissipated_energy, (const struct mslip_contact *contact, size_t n, const double *force_amplitude,
     double *energy))
FUNCTION(int32_t, mslip_complex_stiffness, (const struct mslip_contact *contact, size_t n, const double *amplitude,
     double *k_real, double *k_imag, double *dk_real, double *dk_imag))
FUNCTION(int32_t, mslip_jenkins_equivalent, (const struct mslip_contact *contact, double amplitude, double *stiffness,
     double *slip_force))
FUNCTION(int32_t, mslip_iwan_equivalent, (const struct mslip_contact *contact, size_t n, double *stiffness,
     double *slip_force, double *force_error))
FUNCTION(size_t, mslip_harmonic_workspace_length, (size_t harmonics, size_t samples, int32_t rule))
FUNCTION(int32_t, mslip_harmonic_workspace_init, (size_t harmonics, size_t samples, int32_t rule, size_t workspace_length,
     double *workspace))
FUNCTION(int32_t, mslip_harmonic_workspace_size, (const double *workspace, size_t *harmonics, size_t *samples,
     int32_t *rule))
FUNCTION(size_t, mslip_element_workspace_length, (int32_t directions, size_t harmonics, size_t samples, int32_t rule))
FUNCTION(int32_t, mslip_element_workspace_init, (int32_t directions, size_t harmonics, size_t samples, int32_t rule,
     size_t periods, size_t workspace_length, double *workspace))
FUNCTION(int32_t, mslip_element_workspace_size, (const double *workspace, int32_t *directions, size_t *harmonics,
     size_t *samples, int32_t *rule, size_t *periods))
FUNCTION(int32_t, mslip_element_harmonic_force, (const struct mslip_element *element, double *workspace,
     const double *displacement, double *force, double *jacobian, double *dissipated, double *drift))
FUNCTION(int32_t, mslip_harmonic_force, (const struct mslip_contact *contact, double *workspace, const double *displacement,
     double *force, double *jacobian, double *dissipated))
FUNCTION(int32_t, mslip_harmonic_sensitivity, (const struct mslip_contact *contact, double *workspace,
     const double *displacement, double *force, double *sensitivity))
FUNCTION(int32_t, mslip_element_init, (const struct mslip_parameters *p, int32_t directions, int32_t normal_input,
     struct mslip_element *element))
FUNCTION(int32_t, mslip_element_init_elliptic, (const struct mslip_elliptic_parameters *p, int32_t directions,
     int32_t normal_input, struct mslip_element *element))
FUNCTION(int32_t, mslip_element_check, (const struct mslip_element *element))
FUNCTION(int32_t, mslip_normal_force, (const struct mslip_element *element, size_t n, const double *approach,
     double *normal_force, double *stiffness, double *half_width))
FUNCTION(int32_t, mslip_normal_approach, (const struct mslip_element *element, size_t n, const double *normal_force,
     double *approach, double *compliance, double *half_width))
FUNCTION(int32_t, mslip_element_displacement, (const struct mslip_element *element, int32_t direction, size_t n,
     const double *force, const double *normal_force, double *displacement, double *compliance))
FUNCTION(size_t, mslip_element_state_length, (int32_t directions, size_t pieces))
FUNCTION(int32_t, mslip_element_state_init, (int32_t directions, size_t state_length, double *state))
FUNCTION(int32_t, mslip_element_state_check, (int32_t directions, size_t state_length, const double *state))
FUNCTION(int32_t, mslip_element_state_error, (int32_t directions, size_t state_length, const double *state,
     double *force_error))
FUNCTION(int32_t, mslip_element_update, (const struct mslip_element *element, size_t state_length, const double *state_old,
     const double *displacement, double *state_new, double *force, double *tangent, double *dissipated))
FUNCTION(int32_t, mslip_element_path, (const struct mslip_element *element, size_t state_length, const double *state_old,
     size_t n, const double *displacement, double *state_new, double *force, double *tangent, double *dissipated))
FUNCTION(int32_t, mslip_element_tractions, (const struct mslip_element *element, size_t state_length, const double *state,
     size_t n, const double *x, double *pressure, double *shear))
FUNCTION(int32_t, mslip_batch_complex_stiffness, (size_t n, size_t n_contacts, const struct mslip_contact *contacts,
     const int32_t *index, const int32_t *active, const double *amplitude, double *k_real, double *k_imag, double *dk_real,
     double *dk_imag, size_t *failed_item))
FUNCTION(int32_t, mslip_batch_masing_update, (size_t n, size_t n_contacts, const struct mslip_contact *contacts,
     const int32_t *index, const int32_t *active, size_t state_length, const double *states_old, const double *displacement,
     double *states_new, double *force, double *stiffness, double *dissipated, size_t *failed_item))
FUNCTION(int32_t, mslip_batch_harmonic_force, (size_t n, size_t n_contacts, const struct mslip_contact *contacts,
     const int32_t *index, const int32_t *active, double *workspace, const double *displacement, double *force, double *jacobian,
     double *dissipated, size_t *failed_item))
FUNCTION(int32_t, mslip_batch_element_update, (size_t n, size_t n_elements, const struct mslip_element *elements,
     const int32_t *index, const int32_t *active, size_t state_length, const double *states_old, const double *displacement,
     double *states_new, double *force, double *tangent, double *dissipated, size_t *failed_item))
FUNCTION(int32_t, mslip_batch_element_harmonic_force, (size_t n, size_t n_elements, const struct mslip_element *elements,
     const int32_t *index, const int32_t *active, double *workspace, const double *displacement, double *force, double *jacobian,
     double *dissipated, double *drift, size_t *failed_item))

LENGTH(mslip_state_length(0), 12)
LENGTH(mslip_state_length(16), 54)
LENGTH(mslip_harmonic_workspace_length(5, 128, MSLIP_UNIFORM_SAMPLING), 13368)
LENGTH(mslip_harmonic_workspace_length(5, 128, MSLIP_EVENT_DRIVEN), 2664)
LENGTH(mslip_element_state_length(1, 0), 29)
LENGTH(mslip_element_state_length(1, 16), 77)
LENGTH(mslip_element_workspace_length(1, 5, 128, MSLIP_UNIFORM_SAMPLING), 16840)
LENGTH(mslip_element_state_length(2, 0), 475)
LENGTH(mslip_element_state_length(2, 16), 475)
LENGTH(mslip_element_workspace_length(2, 5, 128, MSLIP_UNIFORM_SAMPLING), 5660)
