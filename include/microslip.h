/* microslip.h: the C interface of microslip (C99 and C++11). Generated from the Rust source by `make header`.
 *
 * Conventions
 *
 * Units       One consistent set; the text names SI. Forces are totals (N), not per unit length.
 * Signs       A positive displacement gives a positive force: the internal force of the contact.
 * Errors      Every function that can fail returns MSLIP_OK (0) or a positive status code; mslip_status_text has the message. On an
 *             error no output is modified. Infinite and NaN inputs are rejected.
 * Outputs     An output that is NULL is not computed.
 * Memory      Each pointer is NULL or valid for what it stands for: as many items as its text says, [n] or one for each of n; one if
 *             that says nothing; a state or other memory for as many doubles as the length that is passed with it. Contacts,
 *             elements, states and tables may be memory of that size which was never initialised, a workspace must have been.
 * Aliasing    Output buffers must not alias any other argument, except where stated.
 * Ownership   All memory is the caller's: contacts, states, workspaces and tables are plain data that may be copied, stored in
 *             restart files and sent through MPI. The fields of mslip_contact may be read; everything else is reserved. A call
 *             recognises memory that was never initialised, is too short, or belongs to another version of this interface; the
 *             _check functions validate memory from outside the process in full.
 * Threads     Nothing is kept between calls: any thread may call any function on its own data. Contacts and tables are only read
 *             and may be shared; each thread needs a workspace of its own.
 * Harmonics   Coefficients of a periodic quantity are [c0, cos1, sin1, cos2, sin2, ...], 2H+1 for H harmonics.
 * Jacobians   Column-major: element (i, j) is at i + j * rows. A default (row-major) NumPy array holds the transpose.
 */

#ifndef MICROSLIP_H
#define MICROSLIP_H

#include <stddef.h>
#include <stdint.h>

// Version of the library that this header belongs to: major.
#define MSLIP_VERSION_MAJOR 0
// Version of the library: minor.
#define MSLIP_VERSION_MINOR 1
// Version of the library: patch.
#define MSLIP_VERSION_PATCH 0

// a required pointer is NULL
#define MSLIP_NULL_POINTER 1

// flat_half_width must be finite and >= 0
#define MSLIP_BAD_FLAT_HALF_WIDTH 2

// edge_radius must be finite and > 0
#define MSLIP_BAD_EDGE_RADIUS 3

// length must be finite and > 0
#define MSLIP_BAD_LENGTH 4

// normal_force must be finite and >= 0, in the parameters of an element > 0; so must each step and sample of a given normal force
#define MSLIP_BAD_NORMAL_FORCE 5

// friction_coefficient must be finite and >= 0
#define MSLIP_BAD_FRICTION_COEFFICIENT 6

// each young_modulus must be finite and > 0
#define MSLIP_BAD_YOUNG_MODULUS 7

// each poisson_ratio must be between 0 and 0.5
#define MSLIP_BAD_POISSON_RATIO 8

// displacement_reference must be MSLIP_RIGID_STRIP, the contact of a machine, or MSLIP_CENTRE_POINT, that of the paper, 7 to 13 % more compliant
#define MSLIP_BAD_DISPLACEMENT_REFERENCE 9

// semi_axis_x must be finite and > 0
#define MSLIP_BAD_SEMI_AXIS_X 10

// semi_axis_y must be finite and > 0
#define MSLIP_BAD_SEMI_AXIS_Y 11

// length too small for the half-width b of the contact, or approach or force of an element too large: requires 2*length > b and a positive initial stiffness
#define MSLIP_LENGTH_TOO_SHORT 12

// parameters out of range: a derived quantity would exceed 1e-150 .. 1e150
#define MSLIP_OUT_OF_RANGE 13

// normal_compliance of a layer must be finite and >= 0, and under normal_force at most 2^40 times that of the contact and 0 or 1e-150 .. 1e150
#define MSLIP_BAD_NORMAL_COMPLIANCE 15

// tangential_compliance of a layer must be finite and >= 0, and under normal_force at most 2^40 times that of the contact and 0 or 1e-150 .. 1e150
#define MSLIP_BAD_TANGENTIAL_COMPLIANCE 16

// stiffening_load of a layer must be 0, infinite, or at least 1e-3 of normal_force
#define MSLIP_BAD_STIFFENING_LOAD 17

// reference_load of a layer must be between 0 (for normal_force) and 1e150; the compliances under normal_force may be at most 2^40 times those under this load
#define MSLIP_BAD_REFERENCE_LOAD 18

// invalid contact: uninitialised, corrupted, or created by an incompatible version of the library
#define MSLIP_BAD_CONTACT 20

// invalid state: uninitialised, truncated, corrupted, or created by an incompatible version of the library
#define MSLIP_BAD_STATE 21

// invalid workspace: uninitialised, or created by an incompatible version of the library
#define MSLIP_BAD_WORKSPACE 22

// state_length must be at least mslip_state_length(0) or mslip_element_state_length(directions, 0)
#define MSLIP_STATE_TOO_SHORT 23

// invalid element: uninitialised, corrupted, or created by an incompatible version of the library
#define MSLIP_BAD_ELEMENT 24

// workspace_length must be at least mslip_harmonic_workspace_length or mslip_element_workspace_length
#define MSLIP_WORKSPACE_TOO_SHORT 25

// invalid table: uninitialised, of another shape than the contact, or created by an incompatible version of the library
#define MSLIP_BAD_TABLE 26

// table_length must be at least mslip_stiffness_table_length
#define MSLIP_TABLE_TOO_SHORT 27

// a force must be finite
#define MSLIP_BAD_FORCE 30

// a force must not exceed mu N in magnitude
#define MSLIP_FORCE_EXCEEDS_SLIP 31

// a displacement must be finite and at most 1e150 in magnitude
#define MSLIP_BAD_DISPLACEMENT 32

// a position x must be finite
#define MSLIP_BAD_POSITION 33

// a displacement amplitude must be between 0 and 1e150
#define MSLIP_BAD_AMPLITUDE 34

// a force amplitude must be finite and >= 0
#define MSLIP_BAD_FORCE_AMPLITUDE 35

// the number of harmonics must be between 1 and 2^24
#define MSLIP_BAD_HARMONICS 36

// the number of samples must exceed twice the number of harmonics and be at most 2^24
#define MSLIP_BAD_SAMPLES 37

// the number of sliders must be between 1 and 65536
#define MSLIP_BAD_COUNT 38

// rule must be MSLIP_UNIFORM_SAMPLING or MSLIP_EVENT_DRIVEN
#define MSLIP_BAD_RULE 39

// not available for this kind of contact; elements have uniform sampling only; for two directions no tractions
#define MSLIP_NOT_AVAILABLE 40

// an index must refer to one of the n_contacts contacts or n_elements elements
#define MSLIP_BAD_INDEX 41

// directions must be 1 or 2, equal for all elements, states and workspaces of a call
#define MSLIP_BAD_DIRECTIONS 42

// normal_input must be MSLIP_INPUT_APPROACH or MSLIP_INPUT_NORMAL_FORCE
#define MSLIP_BAD_NORMAL_INPUT 43

// the number of periods before the one that counts must be at most 65536
#define MSLIP_BAD_PERIODS 44

// a displacement must have the number of coefficients of the workspace: 2*harmonics + 1 for each component (in Fortran)
#define MSLIP_BAD_COEFFICIENTS 45

// the shape of an optional argument, a state or a second input does not agree with that of the first input (in Fortran), or an array is too long to be addressed
#define MSLIP_BAD_ARRAY_SIZE 90

// misaligned pointer: doubles need 8-byte, int32 flags 4-byte alignment
#define MSLIP_BAD_ALIGNMENT 91

// Version of this interface: incremented whenever a name, a meaning or a size changes.
#define MSLIP_ABI_VERSION 5

// Displacement of the centre point under a line of uniform traction: Eq. 5-10 of the paper.
#define MSLIP_CENTRE_POINT 0

// Displacement of a rigid strip, corrected to three-dimensional contact mechanics.
#define MSLIP_RIGID_STRIP 1

// Harmonic force from uniformly spaced samples of a period; its Jacobian is exact for this discretisation.
#define MSLIP_UNIFORM_SAMPLING 0

// Harmonic force from Gauss-Legendre nodes between the events: reversals, loop closures, onset of gross slip.
#define MSLIP_EVENT_DRIVEN 1

// The normal component of a displacement is the normal approach [m]; if it is not positive, the contact is open.
#define MSLIP_INPUT_APPROACH 16

// The normal component of a displacement is the normal force [N] itself.
#define MSLIP_INPUT_NORMAL_FORCE 17

// Row of a sensitivity: derivative with respect to the normal force N.
#define MSLIP_BY_NORMAL_FORCE 0

// Derivative with respect to the friction coefficient mu.
#define MSLIP_BY_FRICTION_COEFFICIENT 1

// Derivative with respect to the half-width a of the flat; from above if a = 0.
#define MSLIP_BY_FLAT_HALF_WIDTH 2

// Derivative with respect to the edge radius R.
#define MSLIP_BY_EDGE_RADIUS 3

// Derivative with respect to the length L.
#define MSLIP_BY_LENGTH 4

// Derivative with respect to E* at constant Poisson's ratios and a constant ratio of Young's moduli.
#define MSLIP_BY_COMPOSITE_MODULUS 5

// Derivative with respect to the tangential compliance of the layer under its reference load; without a layer, with respect to one
// that is added.
#define MSLIP_BY_LAYER_COMPLIANCE 6

// Number of parameters: rows of a sensitivity.
#define MSLIP_PARAMETER_COUNT 7

// Success.
#define MSLIP_OK 0

// Isotropic, linearly elastic material of one body.
typedef struct mslip_material {
    // Young's modulus E > 0 [Pa].
    double young_modulus;
    // Poisson's ratio, 0 <= nu <= 0.5 [-].
    double poisson_ratio;
} mslip_material;

// A compliant layer in series with the contact: roughness, a coating, the body around the contact, the rig. It carries the forces of
// the contact. Its compliances are at most 2^40 times those of the contact, and loads of an element with a layer at most 2^40 times the
// normal force of the parameters.
typedef struct mslip_layer {
    // Normal compliance c_n >= 0 under the reference load [m/N]; 0: none. A contact under a constant normal force does not use it.
    double normal_compliance;
    // Tangential compliance c_t >= 0 under the reference load [m/N]; 0: none.
    double tangential_compliance;
    // N_c [N]: the stiffness grows in proportion to N + N_c, N_c at least 1e-3 of the normal force of the parameters; 0 or infinite:
    // the stiffness is constant.
    double stiffening_load;
    // Reference load N_r, 0 <= N_r <= 1e150 [N]: the load under which the compliances were measured; 0: the normal force of the
    // parameters. Under N they are c (N_r + N_c)/(N + N_c).
    double reference_load;
} mslip_layer;

// Flat with rounded edges on a flat (Eq. 1-24); a cylinder if the flat has no width.
typedef struct mslip_parameters {
    // Half-width a >= 0 of the flat [m]; 0 is a Hertzian cylinder.
    double flat_half_width;
    // Radius R > 0 of the rounded edges (of the cylinder if a = 0) [m].
    double edge_radius;
    // Length L > 0 of the contact along its line [m]; the model needs 2L > b and a positive initial stiffness.
    double length;
    // Normal force N >= 0 on the whole contact [N]; 0 is an open contact: no force, no stiffness.
    double normal_force;
    // Coulomb's friction coefficient mu >= 0 [-].
    double friction_coefficient;
    // The two bodies.
    struct mslip_material material[2];
    // A layer in series with the contact; all zero: none.
    struct mslip_layer layer;
    // `MSLIP_RIGID_STRIP` (1, corrected to 3-D, for the contact of a machine) or `MSLIP_CENTRE_POINT` (0, as in the paper).
    int32_t displacement_reference;
    // Not read; set to 0.
    int32_t reserved;
} mslip_parameters;

// Elliptical Hertz contact (section 3.3); a sphere if both semi-axes are equal.
typedef struct mslip_elliptic_parameters {
    // Semi-axis b > 0 of the contact ellipse along the tangential force [m].
    double semi_axis_x;
    // Semi-axis l > 0 of the contact ellipse across the tangential force [m].
    double semi_axis_y;
    // Normal force N >= 0 [N]; 0 is an open contact.
    double normal_force;
    // Coulomb's friction coefficient mu >= 0 [-].
    double friction_coefficient;
    // The two bodies.
    struct mslip_material material[2];
    // A layer in series with the contact; all zero: none.
    struct mslip_layer layer;
} mslip_elliptic_parameters;

// A contact under a constant normal force: initialised once and only read afterwards. Plain data of fixed size that may be copied,
// stored and sent. An open contact (N = 0) has zero width, force and stiffness.
typedef struct mslip_contact {
    // E*, Eq. 2 [Pa].
    double composite_modulus;
    // Half-width b of the contact under its normal force [m]; elliptical: semi_axis_x.
    double half_width;
    // mu N [N].
    double slip_force;
    // Displacement at the onset of gross slip on the monotonic curve [m].
    double slip_displacement;
    // Tangent stiffness at zero displacement [N/m].
    double initial_stiffness;
    // Energy dissipated per cycle at incipient gross slip [J].
    double slip_energy;
    // Internal tables.
    double reserved[373];
} mslip_contact;

// A friction contact element: the law under a normal force that varies, with separation. Initialised once and only read afterwards;
// it serves any number of contact points of its geometry. Plain data of fixed size that may be copied, stored and sent.
typedef struct mslip_element {
    // E*, Eq. 2 [Pa].
    double composite_modulus;
    // Coulomb's friction coefficient.
    double friction_coefficient;
    // The largest normal force that the tables cover [N]; larger ones are exact, but slower.
    double normal_force;
    // Half-width of the contact under that force [m]; elliptical: the semi-axis x.
    double half_width;
    // Normal approach under that force [m].
    double approach;
    // dN/d(approach) under that force [N/m].
    double normal_stiffness;
    // dT/d(displacement) of a fully stuck contact under that force, x direction [N/m].
    double tangential_stiffness;
    // Number of tangential directions, 1 or 2: a displacement is [u, w] or [u, v, w], a force [T, N] or [Tx, Ty, N].
    int32_t directions;
    // MSLIP_INPUT_APPROACH or MSLIP_INPUT_NORMAL_FORCE.
    int32_t normal_input;
    // Internal tables.
    double reserved[1856];
} mslip_element;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Version of the library, "1.2.3".
const char *mslip_version(void);

// Version of this interface: equals MSLIP_ABI_VERSION of the header that belongs to the library.
int32_t mslip_abi_version(void);

// Message of a status code: a static string, never NULL.
const char *mslip_status_text(int32_t status);

// Sets all parameters to NaN and the displacement reference to -1, so that an omitted one is rejected by its own status code, and
// the layer to none. NULL is ignored.
void mslip_parameters_default(struct mslip_parameters *p);

// Sets all parameters to NaN. NULL is ignored.
void mslip_elliptic_parameters_default(struct mslip_elliptic_parameters *p);

// Warning i >= 0 of parameters that are valid but implausible: another unit, an exchanged pair, a contact for which the model is
// inaccurate. A static text, NULL if there are no more: for the host to print. Lengths are in m and moduli in Pa, or in mm and MPa if
// both moduli are at most 1.3e6. Any value of any parameter is accepted; errors are those of mslip_contact_init.
const char *mslip_parameters_warning(const struct mslip_parameters *p,
                                     int32_t i);

// Warning i >= 0 of the parameters of an elliptical contact, as mslip_parameters_warning.
const char *mslip_elliptic_parameters_warning(const struct mslip_elliptic_parameters *p, int32_t i);

// Initialises the contact of a flat with rounded edges, or of a cylinder (Eq. 1, 2, 10).
//
// Returns MSLIP_NULL_POINTER, the code of the first invalid parameter, MSLIP_LENGTH_TOO_SHORT or
// MSLIP_OUT_OF_RANGE; the contact is unchanged then.
int32_t mslip_contact_init(const struct mslip_parameters *p, struct mslip_contact *contact);

// Initialises an elliptical Hertz contact (section 3.3); a sphere if both semi-axes are equal.
//
// Returns MSLIP_NULL_POINTER, the code of the first invalid parameter, or MSLIP_OUT_OF_RANGE; the contact is
// unchanged then.
int32_t mslip_contact_init_elliptic(const struct mslip_elliptic_parameters *p,
                                    struct mslip_contact *contact);

// Validates a contact that was read from a file or a message: its checksum must be that written at initialisation. Other functions
// only check a tag.
//
// Returns MSLIP_NULL_POINTER or MSLIP_BAD_CONTACT.
int32_t mslip_contact_check(const struct mslip_contact *contact);

// Tractions [Pa] at x[n] [m] along the width, under a monotonically increasing force [N] (Eq. 17, 21-24); 0 outside the
// contact. Elliptical: on the x axis.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE, MSLIP_FORCE_EXCEEDS_SLIP or MSLIP_BAD_POSITION.
int32_t mslip_tractions(const struct mslip_contact *contact,
                        double force,
                        size_t n,
                        const double *x,
                        double *pressure,
                        double *shear);

// Relative slip [m] (Eq. 15) and frictional damage parameter mu p |s| [N/m] (section 3.5) at x[n] [m], under a
// monotonically increased force [N]; 0 in the stick zone and outside the contact.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE, MSLIP_FORCE_EXCEEDS_SLIP, MSLIP_BAD_POSITION, or
// MSLIP_NOT_AVAILABLE for an elliptical contact.
int32_t mslip_slip(const struct mslip_contact *contact,
                   double force,
                   size_t n,
                   const double *x,
                   double *slip,
                   double *damage);

// Monotonic (initial loading) curve (Eq. 10), odd in the force: displacement [m], compliance [m/N] and stick half-width [m] at
// force[n] [N]. At mu N the compliance is infinite for a cylinder and an elliptical contact, and the stick half-width is that of
// the flat, a.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE or MSLIP_FORCE_EXCEEDS_SLIP.
int32_t mslip_monotonic_displacement(const struct mslip_contact *contact,
                                     size_t n,
                                     const double *force,
                                     double *displacement,
                                     double *compliance,
                                     double *stick_half_width);

// Inverse of the monotonic curve, odd in the displacement: force [N], stiffness [N/m] and stick half-width [m] at
// displacement[n] [m]. At slip_displacement the stick half-width is a, as at mu N; beyond, the force stays at mu N, and stiffness
// and stick half-width are 0.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT or MSLIP_BAD_DISPLACEMENT.
int32_t mslip_monotonic_force(const struct mslip_contact *contact,
                              size_t n,
                              const double *displacement,
                              double *force,
                              double *stiffness,
                              double *stick_half_width);

// Derivatives of the force of the monotonic curve with respect to the parameters at displacement[n] [m], which stays fixed:
// force[n] [N] and sensitivity, MSLIP_PARAMETER_COUNT x n, column-major. The derivatives of force i are sensitivity[7 i +
// MSLIP_BY_...], in [N] over the unit of the parameter. Beyond slip_displacement they are those of mu N; so are, one-sided, those of a
// contact with mu = 0 or N = 0 at any displacement but 0.
//
// Of an elliptical contact the bodies keep their shapes, so that the ellipse changes with N and E*. The derivative with respect to the
// edge radius is that for bodies whose radii of curvature change in proportion, with R = 4 E* semi_axis_x^3/(3 N): of a sphere, its
// radius. Those with respect to a and L are 0. A layer is the same body under any N: its compliance under the reference load, and both
// its loads, stay fixed. A reference_load of 0 stays at the N of the contact.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_ARRAY_SIZE or MSLIP_BAD_DISPLACEMENT.
int32_t mslip_monotonic_sensitivity(const struct mslip_contact *contact,
                                    size_t n,
                                    const double *displacement,
                                    double *force,
                                    double *sensitivity);

// Number of doubles in a state with a capacity of `reversals` nested reversals, at least 2. A state is never full: if the capacity
// is exceeded, the pair of adjacent reversals whose removal changes later forces least is removed.
size_t mslip_state_length(size_t reversals);

// Initialises a state: unloaded, with zero force and displacement.
//
// Returns MSLIP_NULL_POINTER or MSLIP_STATE_TOO_SHORT.
int32_t mslip_state_init(size_t state_length, double *state);

// Validates a state that was read from a file or a message: all values must be finite and the reversals nested. Other functions only
// check a tag and the number of reversals.
//
// Returns MSLIP_NULL_POINTER, MSLIP_STATE_TOO_SHORT or MSLIP_BAD_STATE.
int32_t mslip_state_check(size_t state_length,
                          const double *state);

// Bound on the error [N] of the force due to removed reversals: 0 if none was removed since the last gross slip.
//
// Returns MSLIP_NULL_POINTER, MSLIP_STATE_TOO_SHORT or MSLIP_BAD_STATE.
int32_t mslip_state_error(size_t state_length,
                          const double *state,
                          double *force_error);

// Advances the contact state to a displacement [m]: force [N], tangent stiffness [N/m], and energy dissipated in this step [J]
// (Eq. 11, 12). state_new may alias state_old; if NULL, the new state is discarded.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_STATE or MSLIP_BAD_DISPLACEMENT.
int32_t mslip_masing_update(const struct mslip_contact *contact,
                            size_t state_length,
                            const double *state_old,
                            double displacement,
                            double *state_new,
                            double *force,
                            double *stiffness,
                            double *dissipated);

// Advances the contact state through n displacements [m]; force[n] [N], stiffness[n] [N/m] and dissipated[n] [J] are those
// of each step. state_new receives the last state and may alias state_old. If NULL, the new state is discarded; the path is then
// evaluated with a capacity of at most 128 nested reversals.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_STATE or MSLIP_BAD_DISPLACEMENT.
int32_t mslip_masing_path(const struct mslip_contact *contact,
                          size_t state_length,
                          const double *state_old,
                          size_t n,
                          const double *displacement,
                          double *state_new,
                          double *force,
                          double *stiffness,
                          double *dissipated);

// Tractions [Pa] at x[n] [m] after an arbitrary load history (Eq. 21, superposed by Masing's rule).
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_STATE, MSLIP_BAD_POSITION, or
// MSLIP_FORCE_EXCEEDS_SLIP for the state of another contact.
int32_t mslip_masing_tractions(const struct mslip_contact *contact,
                               size_t state_length,
                               const double *state,
                               size_t n,
                               const double *x,
                               double *pressure,
                               double *shear);

// Hysteresis loop of the displacement amplitude cos(t), amplitude in [m]: displacement[n] [m] and force[n] [N] at n uniformly
// spaced instants of one period, from t = 0.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT or MSLIP_BAD_AMPLITUDE.
int32_t mslip_hysteresis_loop(const struct mslip_contact *contact,
                              double amplitude,
                              size_t n,
                              double *displacement,
                              double *force);

// Energy [J] dissipated per cycle between +- force_amplitude[n] [N], each from 0 to mu N (Eq. 13-16).
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE_AMPLITUDE or MSLIP_FORCE_EXCEEDS_SLIP.
int32_t mslip_dissipated_energy(const struct mslip_contact *contact,
                                size_t n,
                                const double *force_amplitude,
                                double *energy);

// Complex (harmonic) stiffness K' + iK'' [N/m] at displacement amplitude[n] >= 0 [m] and its derivatives with respect to
// the amplitude [N/m^2] (section 3.4); at amplitude 0: the initial stiffness.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT or MSLIP_BAD_AMPLITUDE.
int32_t mslip_complex_stiffness(const struct mslip_contact *contact,
                                size_t n,
                                const double *amplitude,
                                double *k_real,
                                double *k_imag,
                                double *dk_real,
                                double *dk_imag);

// Number of doubles in a table of the complex stiffness.
size_t mslip_stiffness_table_length(void);

// Initialises a table of the complex stiffness of all contacts of a shape: those that differ in friction coefficient or scale
// share it. 2L/b, a/b and Poisson's ratios are the shape of a line contact; that of all elliptic contacts is the same.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT or MSLIP_TABLE_TOO_SHORT.
int32_t mslip_stiffness_table_init(const struct mslip_contact *contact,
                                   size_t table_length,
                                   double *table);

// mslip_complex_stiffness from a table of mslip_stiffness_table_init: a few polynomials for each amplitude, at any amplitude, with
// errors of 1e-13 of |K| and of |K|/amplitude. For a contact with Λ below 0.9, 2L/b below about 2, it is mslip_complex_stiffness.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_TABLE or MSLIP_BAD_AMPLITUDE.
int32_t mslip_complex_stiffness_tabulated(const struct mslip_contact *contact,
                                          const double *table,
                                          size_t n,
                                          const double *amplitude,
                                          double *k_real,
                                          double *k_imag,
                                          double *dk_real,
                                          double *dk_imag);

// Jenkins element (spring and slider in series) with the same K' and K'' at a displacement amplitude [m]: stiffness [N/m] and slip
// force [N]. At amplitude 0: the initial stiffness and mu N. Both are 0 if mu N = 0.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT or MSLIP_BAD_AMPLITUDE.
int32_t mslip_jenkins_equivalent(const struct mslip_contact *contact,
                                 double amplitude,
                                 double *stiffness,
                                 double *slip_force);

// Iwan model of n parallel Jenkins elements that approximates the monotonic curve with the smallest maximum error: stiffness[n]
// [N/m], slip_force[n] [N] of sum mu N, and force_error, the maximum error of the force on the monotonic curve divided by
// mu N. After m nested reversals the error is at most (1 + 2m) force_error; measured: 3 in loops, 10 to 15 in random
// histories, 6 to 43 in decaying vibrations. All are 0 if mu N = 0.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT or MSLIP_BAD_COUNT.
int32_t mslip_iwan_equivalent(const struct mslip_contact *contact,
                              size_t n,
                              double *stiffness,
                              double *slip_force,
                              double *force_error);

// Number of doubles in a workspace for H harmonics, H >= 1, more than 2H samples per period, and a rule, MSLIP_UNIFORM_SAMPLING or
// MSLIP_EVENT_DRIVEN; 0 if these are not allowed.
size_t mslip_harmonic_workspace_length(size_t harmonics,
                                       size_t samples,
                                       int32_t rule);

// Initialises a workspace: tables for one (harmonics, samples, rule), and scratch memory. Each thread needs its own.
//
// MSLIP_UNIFORM_SAMPLING evaluates `samples` uniformly spaced instants of a period; its error decreases as samples^-2.
// MSLIP_EVENT_DRIVEN locates reversals, loop closures and the onset of gross slip, and distributes about `samples` Gauss-Legendre
// nodes per period between them, at least 8 between two events. Its error decreases exponentially, more slowly for more harmonics:
// 16 (H+1) nodes have worst measured errors of 1e-7 of mu N in the force and 1e-4 of the initial stiffness in the Jacobian; the
// energy is exact to rounding. It searches for reversals on a grid of at least `samples` and 16 H instants.
//
// Returns MSLIP_BAD_RULE, MSLIP_BAD_HARMONICS, MSLIP_BAD_SAMPLES, MSLIP_NULL_POINTER or MSLIP_WORKSPACE_TOO_SHORT.
int32_t mslip_harmonic_workspace_init(size_t harmonics,
                                      size_t samples,
                                      int32_t rule,
                                      size_t workspace_length,
                                      double *workspace);

// Number of harmonics and of samples, and rule, of an initialised workspace. Outputs may be NULL.
//
// Returns MSLIP_NULL_POINTER or MSLIP_BAD_WORKSPACE.
int32_t mslip_harmonic_workspace_size(const double *workspace,
                                      size_t *harmonics,
                                      size_t *samples,
                                      int32_t *rule);

// Number of doubles in a workspace of elements with 1 or 2 tangential directions for H harmonics, H >= 1, more than 2H samples per
// period, and MSLIP_UNIFORM_SAMPLING; 0 if these are not allowed or not available.
size_t mslip_element_workspace_length(int32_t directions,
                                      size_t harmonics,
                                      size_t samples,
                                      int32_t rule);

// Initialises a workspace of elements: tables for one (directions, harmonics, samples, rule), and scratch memory. Each thread
// needs its own. periods is the number of periods that are walked before the one that counts, at most 65536. 0 is the default:
// 3 with two directions; 1 with one, where more change nothing and cost nothing.
//
// Returns MSLIP_BAD_DIRECTIONS, MSLIP_BAD_RULE, MSLIP_NOT_AVAILABLE for MSLIP_EVENT_DRIVEN, MSLIP_BAD_HARMONICS,
// MSLIP_BAD_SAMPLES, MSLIP_BAD_PERIODS, MSLIP_NULL_POINTER or MSLIP_WORKSPACE_TOO_SHORT.
int32_t mslip_element_workspace_init(int32_t directions,
                                     size_t harmonics,
                                     size_t samples,
                                     int32_t rule,
                                     size_t periods,
                                     size_t workspace_length,
                                     double *workspace);

// Number of directions, of harmonics and of samples, rule, and number of periods before the one that counts (never 0), of an
// initialised workspace of elements. Outputs may be NULL.
//
// Returns MSLIP_NULL_POINTER or MSLIP_BAD_WORKSPACE.
int32_t mslip_element_workspace_size(const double *workspace,
                                     int32_t *directions,
                                     size_t *harmonics,
                                     size_t *samples,
                                     int32_t *rule,
                                     size_t *periods);

// Harmonic force of an element in steady state, by alternating frequency/time (AFT). displacement and force hold component after
// component, each 2H+1 coefficients [c0, cos1, sin1, cos2, sin2, ...]: with one tangential direction m = 2 components, u [m]
// and w, T and N [N], with two directions m = 3, u, v [m] and w, Tx, Ty and N [N]. The normal component w of the
// displacement is the approach [m] or the normal force [N]. jacobian is d force_i / d displacement_j, m(2H+1) x m(2H+1),
// column-major: the exact derivative of the discrete force, one-sided at corners. dissipated [J] is the energy per period.
//
// Steady state: the element is pressed by the normal force of the sample at which that is largest (the first such sample) with no
// tangential displacement, is displaced to that sample at constant normal force, and advances from there through the periods of the
// workspace and one more, which counts. The Jacobian is that for a fixed start. If w is constant, any swing of it moves the start to
// another sample, and the mean tangential force may depend on the start.
//
// With one direction the period that counts is the steady state. With two, a mean tangential force beside a vibration across it is
// shaken out over many periods: drift is the largest difference of the tangential force between the last period and the one
// before, over mu times the largest normal force; 0 with one direction, and for a contact that opens, because it forgets. With 1
// period before the one that counts, the drift contains the first loading. A drift is not an error.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_ELEMENT, MSLIP_BAD_WORKSPACE, MSLIP_BAD_DIRECTIONS for the workspace of another number of
// directions, MSLIP_BAD_DISPLACEMENT, MSLIP_BAD_NORMAL_FORCE if the normal force of a sample is negative, or
// MSLIP_LENGTH_TOO_SHORT if the contact would be too wide for its length at a sample.
int32_t mslip_element_harmonic_force(const struct mslip_element *element,
                                     double *workspace,
                                     const double *displacement,
                                     double *force,
                                     double *jacobian,
                                     double *dissipated,
                                     double *drift);

// Harmonic force in steady state (the second of two periods from the initial, unloaded state), by alternating frequency/time (AFT)
// with the rule of the workspace. displacement [m] and force [N] are 2H+1 coefficients, [c0, cos1, sin1, cos2, sin2, ...];
// jacobian [N/m] is d force_i / d displacement_j, (2H+1) x (2H+1), column-major; dissipated [J] is the energy per period.
//
// With MSLIP_UNIFORM_SAMPLING the Jacobian is the exact derivative of the discrete force, one-sided if two samples at a reversal
// are equal or a sample is at the onset of gross slip. With MSLIP_EVENT_DRIVEN it is the rule applied to the exact derivative of
// the integrals; it converges more slowly than the force.
//
// The contact is unloaded at displacement 0, so the mean force depends on the mean displacement c0 unless the motion slips
// grossly. For displacements measured from another position, pass c0 minus the unloaded position.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_WORKSPACE or MSLIP_BAD_DISPLACEMENT.
int32_t mslip_harmonic_force(const struct mslip_contact *contact,
                             double *workspace,
                             const double *displacement,
                             double *force,
                             double *jacobian,
                             double *dissipated);

// Derivatives of the harmonic force with respect to the parameters at fixed coefficients of the displacement: displacement [m] and
// force [N] as of mslip_harmonic_force, and sensitivity, (2H+1) x MSLIP_PARAMETER_COUNT, column-major. The derivative of force
// coefficient i is sensitivity[i + (2H+1) MSLIP_BY_...], in [N] over the unit of the parameter. The parameters are those of
// mslip_monotonic_sensitivity.
//
// With MSLIP_UNIFORM_SAMPLING the derivatives are the exact ones of the discrete force, one-sided if a sample is at the onset of gross
// slip. With MSLIP_EVENT_DRIVEN they are the rule applied to the exact derivatives of the integrals, and converge more slowly than the
// force.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_WORKSPACE or MSLIP_BAD_DISPLACEMENT.
int32_t mslip_harmonic_sensitivity(const struct mslip_contact *contact,
                                   double *workspace,
                                   const double *displacement,
                                   double *force,
                                   double *sensitivity);

// Initialises the element of a flat with rounded edges, or of a cylinder. normal_force of the parameters, > 0, is the largest
// force for which the element is tabulated; larger ones are exact, but slower, and with two directions less accurate. directions
// is the number of tangential directions, 1 or 2: a displacement is [u, w] or [u, v, w], a force [T, N] or [Tx, Ty, N].
// normal_input is MSLIP_INPUT_APPROACH, w is the normal approach [m], or MSLIP_INPUT_NORMAL_FORCE, w is the normal force [N].
//
// In a step the contact is open if w is at most 2^-150 of its value under normal_force, with two directions 2^-80. With two
// directions forces beyond 2^150 and approaches beyond 2^100 times that value are rejected as those of a contact too wide for its
// length.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_DIRECTIONS, MSLIP_BAD_NORMAL_INPUT, the code of the first invalid parameter,
// MSLIP_LENGTH_TOO_SHORT, or MSLIP_OUT_OF_RANGE; the element is unchanged then.
int32_t mslip_element_init(const struct mslip_parameters *p,
                           int32_t directions,
                           int32_t normal_input,
                           struct mslip_element *element);

// Initialises the element of an elliptical Hertz contact; a sphere if both semi-axes are equal. normal_force of the parameters, >
// 0, is the force of the semi-axes and the largest one for which the element is tabulated; larger ones are exact, but slower,
// and with two directions less accurate. directions and normal_input are those of mslip_element_init.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_DIRECTIONS, MSLIP_BAD_NORMAL_INPUT, the code of the first invalid parameter,
// or MSLIP_OUT_OF_RANGE; the element is unchanged then.
int32_t mslip_element_init_elliptic(const struct mslip_elliptic_parameters *p,
                                    int32_t directions,
                                    int32_t normal_input,
                                    struct mslip_element *element);

// Validates an element that was read from a file or a message: its checksum must be that written at initialisation. Other
// functions only check a tag.
//
// Returns MSLIP_NULL_POINTER or MSLIP_BAD_ELEMENT.
int32_t mslip_element_check(const struct mslip_element *element);

// The normal law: normal force [N], normal stiffness [N/m] and half-width of the contact [m] at approach[n] [m]. An
// approach <= 0 gives 0, 0, 0.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_ELEMENT, MSLIP_BAD_DISPLACEMENT, or MSLIP_LENGTH_TOO_SHORT for an approach at which the
// contact would be too wide for its length.
int32_t mslip_normal_force(const struct mslip_element *element,
                           size_t n,
                           const double *approach,
                           double *normal_force,
                           double *stiffness,
                           double *half_width);

// The inverse normal law: approach [m], compliance [m/N] and half-width [m] under normal_force[n] [N]. At 0 the
// compliance of a cylinder and of an ellipse is infinite.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_ELEMENT, MSLIP_BAD_NORMAL_FORCE, or MSLIP_LENGTH_TOO_SHORT for a force under which the
// contact would be too wide for its length.
int32_t mslip_normal_approach(const struct mslip_element *element,
                              size_t n,
                              const double *normal_force,
                              double *approach,
                              double *compliance,
                              double *half_width);

// The monotonic curve of an element at a constant normal force: the displacement [m] that carries force[n] [N], at most mu N
// in magnitude, under normal_force[n] [N], and the compliance [m/N] there, in the direction 0 (x) or, of an element with two
// directions, 1 (y). At mu N the compliance of a cylinder and of an ellipse is infinite; so it is without friction and without a
// normal force.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_ELEMENT, MSLIP_BAD_DIRECTIONS for another direction, MSLIP_BAD_NORMAL_FORCE,
// MSLIP_LENGTH_TOO_SHORT for a normal force under which the contact would be too wide for its length, MSLIP_BAD_FORCE or
// MSLIP_FORCE_EXCEEDS_SLIP.
int32_t mslip_element_displacement(const struct mslip_element *element,
                                   int32_t direction,
                                   size_t n,
                                   const double *force,
                                   const double *normal_force,
                                   double *displacement,
                                   double *compliance);

// Number of doubles in the state of an element; 0 if directions is neither 1 nor 2. For one tangential direction it has a capacity
// of `pieces` pieces of the memory diagram, at least 4, and is never full: if the capacity is exceeded, the two adjacent pieces
// are merged for which later forces change least. For two directions the length is fixed, and `pieces` is ignored; as long as v
// does not change, the state is a memory diagram of that length.
size_t mslip_element_state_length(int32_t directions,
                                  size_t pieces);

// Initialises the state of an element with 1 or 2 tangential directions: open, at zero displacement.
//
// Returns MSLIP_BAD_DIRECTIONS, MSLIP_NULL_POINTER or MSLIP_STATE_TOO_SHORT.
int32_t mslip_element_state_init(int32_t directions,
                                 size_t state_length,
                                 double *state);

// Validates the state of an element that was read from a file or a message: all values must be finite and possible, for one
// direction the pieces nested. Other functions only check a tag and the number of pieces.
//
// Returns MSLIP_BAD_DIRECTIONS, also for the state of another number of directions, MSLIP_NULL_POINTER, MSLIP_STATE_TOO_SHORT or
// MSLIP_BAD_STATE.
int32_t mslip_element_state_check(int32_t directions,
                                  size_t state_length,
                                  const double *state);

// Bound on the error [N] of the tangential force due to merged pieces: 0 if none was merged since the last gross slip or
// separation. For two directions it is that bound as long as v has not changed since the contact closed, and 0 otherwise: pieces are
// merged only there. The error of the law for two directions is not included.
//
// Returns MSLIP_BAD_DIRECTIONS, also for the state of another number of directions, MSLIP_NULL_POINTER, MSLIP_STATE_TOO_SHORT or
// MSLIP_BAD_STATE.
int32_t mslip_element_state_error(int32_t directions,
                                  size_t state_length,
                                  const double *state,
                                  double *force_error);

// Advances the state of an element to a displacement: [u, w] with one tangential direction, [u, v, w] with two, tangential
// displacements [m] and the normal approach [m] or the normal force [N]. With m = 2 or 3 components, force[m] [N] is
// [T, N] or [Tx, Ty, N], tangent[m m] [N/m] is d force_i / d displacement_j, m x m, column-major, consistent with the step
// and one-sided at corners, dissipated [J] the energy dissipated in this step. state_new may alias state_old; if NULL, the new
// state is discarded. Only the used part of the new state is written: initialise both states to store or compare whole arrays.
// Within a step the path is straight in the tangential displacement and the tangential shift S of the contact size.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_ELEMENT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_DIRECTIONS for the state of another number of
// directions, MSLIP_BAD_STATE, MSLIP_BAD_DISPLACEMENT, MSLIP_BAD_NORMAL_FORCE, or MSLIP_LENGTH_TOO_SHORT if the contact would be
// too wide for its length.
int32_t mslip_element_update(const struct mslip_element *element,
                             size_t state_length,
                             const double *state_old,
                             const double *displacement,
                             double *state_new,
                             double *force,
                             double *tangent,
                             double *dissipated);

// Advances the state of an element through n displacements. With m = 2 components for one tangential direction, [u, w], and m =
// 3 for two, [u, v, w], displacement and force hold m doubles per step, tangent m x m, dissipated one; units are those of
// mslip_element_update. state_new receives the last state and may alias state_old. If NULL, the new state is discarded; for one
// direction the path is then evaluated with a capacity of at most 256 pieces.
//
// Returns the codes of mslip_element_update; all outputs are unchanged then.
int32_t mslip_element_path(const struct mslip_element *element,
                           size_t state_length,
                           const double *state_old,
                           size_t n,
                           const double *displacement,
                           double *state_new,
                           double *force,
                           double *tangent,
                           double *dissipated);

// Pressure and shear traction [Pa] at x[n] [m] along the width after a load history; 0 outside the contact. Elliptical: on
// the x axis. For one tangential direction.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_ELEMENT, MSLIP_NOT_AVAILABLE for two directions, MSLIP_STATE_TOO_SHORT,
// MSLIP_BAD_DIRECTIONS for the state of two directions, MSLIP_BAD_STATE or MSLIP_BAD_POSITION.
int32_t mslip_element_tractions(const struct mslip_element *element,
                                size_t state_length,
                                const double *state,
                                size_t n,
                                const double *x,
                                double *pressure,
                                double *shear);

// mslip_complex_stiffness for n items, one amplitude each. Item i uses contacts[index[i]], or contacts[i] if index is NULL.
// If active is not NULL and active[i] is 0, item i is skipped.
//
// Returns MSLIP_BAD_INDEX or the codes of mslip_complex_stiffness; all outputs are unchanged then.
int32_t mslip_batch_complex_stiffness(size_t n,
                                      size_t n_contacts,
                                      const struct mslip_contact *contacts,
                                      const int32_t *index,
                                      const int32_t *active,
                                      const double *amplitude,
                                      double *k_real,
                                      double *k_imag,
                                      double *dk_real,
                                      double *dk_imag);

// mslip_masing_update for n items: states hold state_length doubles per item, contiguously; displacement, force, stiffness and
// dissipated one. states_new may alias states_old. Item i uses contacts[index[i]], or contacts[i] if index is NULL. If
// active is not NULL and active[i] is 0, item i is skipped, and its state is not written.
//
// Returns MSLIP_BAD_INDEX or the codes of mslip_masing_update; all outputs are unchanged then.
int32_t mslip_batch_masing_update(size_t n,
                                  size_t n_contacts,
                                  const struct mslip_contact *contacts,
                                  const int32_t *index,
                                  const int32_t *active,
                                  size_t state_length,
                                  const double *states_old,
                                  const double *displacement,
                                  double *states_new,
                                  double *force,
                                  double *stiffness,
                                  double *dissipated);

// mslip_harmonic_force for n items with one workspace: displacement and force hold 2H+1 doubles per item, jacobian (2H+1)^2,
// dissipated one. Item i uses contacts[index[i]], or contacts[i] if index is NULL. If active is not NULL and active[i] is
// 0, item i is skipped.
//
// Returns MSLIP_BAD_INDEX or the codes of mslip_harmonic_force; all outputs are unchanged then.
int32_t mslip_batch_harmonic_force(size_t n,
                                   size_t n_contacts,
                                   const struct mslip_contact *contacts,
                                   const int32_t *index,
                                   const int32_t *active,
                                   double *workspace,
                                   const double *displacement,
                                   double *force,
                                   double *jacobian,
                                   double *dissipated);

// mslip_element_update for n items, all with the same number of tangential directions: states hold state_length doubles per item,
// contiguously; with m = 2 components for one direction, 3 for two, displacement and force hold m doubles per item, tangent m x m,
// dissipated one. states_new may alias states_old. Item i uses elements[index[i]], or elements[i] if index is NULL. If
// active is not NULL and active[i] is 0, item i is skipped, and its state is not written; m is that of the first item that is
// not skipped.
//
// Returns MSLIP_BAD_INDEX, MSLIP_BAD_DIRECTIONS for elements or states of different numbers of directions, or the codes of
// mslip_element_update; all outputs are unchanged then.
int32_t mslip_batch_element_update(size_t n,
                                   size_t n_elements,
                                   const struct mslip_element *elements,
                                   const int32_t *index,
                                   const int32_t *active,
                                   size_t state_length,
                                   const double *states_old,
                                   const double *displacement,
                                   double *states_new,
                                   double *force,
                                   double *tangent,
                                   double *dissipated);

// mslip_element_harmonic_force for n items with one workspace: with m = 2 components for a workspace of one tangential direction,
// 3 for one of two, displacement and force hold m(2H+1) doubles per item, jacobian (m(2H+1))^2, dissipated and drift one. Item i uses
// elements[index[i]], or elements[i] if index is NULL. If active is not NULL and active[i] is 0, item i is skipped.
//
// Returns MSLIP_BAD_INDEX or the codes of mslip_element_harmonic_force, MSLIP_BAD_DIRECTIONS for an element with another number of
// directions than the workspace; all outputs are unchanged then.
int32_t mslip_batch_element_harmonic_force(size_t n,
                                           size_t n_elements,
                                           const struct mslip_element *elements,
                                           const int32_t *index,
                                           const int32_t *active,
                                           double *workspace,
                                           const double *displacement,
                                           double *force,
                                           double *jacobian,
                                           double *dissipated,
                                           double *drift);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* MICROSLIP_H */
