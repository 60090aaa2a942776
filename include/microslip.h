/* microslip.h: the C interface of microslip (C99 and C++11). Made from the Rust source by `make header`. */

#ifndef MICROSLIP_H
#define MICROSLIP_H

#include <stddef.h>
#include <stdint.h>

// Version of the library that this header belongs to: its first number.
#define MSLIP_VERSION_MAJOR 0
// Its second number.
#define MSLIP_VERSION_MINOR 1
// Its third number.
#define MSLIP_VERSION_PATCH 0

// Raised whenever a name, a meaning or a size of this interface changes.
#define MSLIP_ABI_VERSION 2

// Displacement of the centre point under a line of uniform traction: the paper's Eq. 5-10.
#define MSLIP_CENTRE_POINT 0

// Displacement of a rigid strip, corrected to three-dimensional contact mechanics.
#define MSLIP_RIGID_STRIP 1

// Harmonic force from equidistant samples of a period.
#define MSLIP_EQUIDISTANT 0

// Harmonic force from Gauss-Legendre nodes between the instants at which the displacement turns, a loop closes or gross slip
// starts.
#define MSLIP_BETWEEN_REVERSALS 1

// All went well.
#define MSLIP_OK 0

// A required pointer is NULL.
#define MSLIP_NULL_POINTER 1

// flat_half_width is not a finite number >= 0.
#define MSLIP_BAD_FLAT_HALF_WIDTH 2

// edge_radius is not a finite number > 0.
#define MSLIP_BAD_EDGE_RADIUS 3

// length is not a finite number > 0.
#define MSLIP_BAD_LENGTH 4

// normal_force is not a finite number >= 0.
#define MSLIP_BAD_NORMAL_FORCE 5

// friction_coefficient is not a finite number >= 0.
#define MSLIP_BAD_FRICTION_COEFFICIENT 6

// A young_modulus is not a finite number > 0.
#define MSLIP_BAD_YOUNG_MODULUS 7

// A poisson_ratio is not in 0 <= nu <= 0.5.
#define MSLIP_BAD_POISSON_RATIO 8

// displacement_reference is neither MSLIP_CENTRE_POINT nor MSLIP_RIGID_STRIP.
#define MSLIP_BAD_DISPLACEMENT_REFERENCE 9

// semi_axis_x is not a finite number > 0.
#define MSLIP_BAD_SEMI_AXIS_X 10

// semi_axis_y is not a finite number > 0.
#define MSLIP_BAD_SEMI_AXIS_Y 11

// 2 length <= half-width, or the initial stiffness would not be positive.
#define MSLIP_LENGTH_TOO_SHORT 12

// Half-width, force, displacement or energy would be beyond about 1e-150 to 1e150.
#define MSLIP_OUT_OF_RANGE 13

// The contact was never prepared, belongs to another version, or its memory was changed.
#define MSLIP_BAD_CONTACT 20

// The state was never initialised, is cut short, or its memory was changed.
#define MSLIP_BAD_STATE 21

// The workspace was never initialised, or its memory was changed.
#define MSLIP_BAD_WORKSPACE 22

// state_length is below mslip_state_length(0).
#define MSLIP_STATE_TOO_SHORT 23

// The state holds no further reversal.
#define MSLIP_STATE_FULL 24

// workspace_length is below mslip_harmonic_workspace_length.
#define MSLIP_WORKSPACE_TOO_SHORT 25

// A force is not finite.
#define MSLIP_BAD_FORCE 30

// |force| exceeds mu N.
#define MSLIP_FORCE_EXCEEDS_SLIP 31

// A displacement is not finite, or beyond 1e150.
#define MSLIP_BAD_DISPLACEMENT 32

// A position x is not finite.
#define MSLIP_BAD_POSITION 33

// A displacement amplitude is not finite, negative, or beyond 1e150.
#define MSLIP_BAD_AMPLITUDE 34

// A force amplitude is not finite, or negative.
#define MSLIP_BAD_FORCE_AMPLITUDE 35

// The number of harmonics is 0, or beyond 2^24.
#define MSLIP_BAD_HARMONICS 36

// The number of samples does not exceed twice the number of harmonics, or is beyond 2^24.
#define MSLIP_BAD_SAMPLES 37

// The number of sliders is 0, or beyond 65536.
#define MSLIP_BAD_COUNT 38

// rule is neither MSLIP_EQUIDISTANT nor MSLIP_BETWEEN_REVERSALS.
#define MSLIP_BAD_RULE 39

// Slip is not available for an elliptical contact.
#define MSLIP_NOT_AVAILABLE 40

// An array is too long to be addressed, which every function with a length may answer; in Fortran also: too short, or of a
// size that does not agree with the others.
#define MSLIP_BAD_ARRAY_SIZE 90

// A pointer is not a multiple of 8 bytes, for flags of 4, which every function with pointers may answer.
#define MSLIP_BAD_ALIGNMENT 91

// Isotropic, linearly elastic material of one body.
typedef struct mslip_material {
    // Young's modulus E > 0 [Pa].
    double young_modulus;
    // Poisson's ratio, 0 <= nu <= 0.5 [-].
    double poisson_ratio;
} mslip_material;

// Flat with rounded edges on a flat (Eq. 1-24); a cylinder when the flat has no width.
typedef struct mslip_parameters {
    // Half-width a >= 0 of the flat [m]; 0 is a Hertzian cylinder.
    double flat_half_width;
    // Radius R > 0 of the rounded edges (of the cylinder when a = 0) [m].
    double edge_radius;
    // Length L > 0 of the contact along its line [m]; the model needs 2L > b and a positive initial stiffness.
    double length;
    // Normal force N >= 0 on the whole contact [N]; 0 is an open contact: no force, no stiffness.
    double normal_force;
    // Coulomb's friction coefficient mu >= 0 [-].
    double friction_coefficient;
    // The two bodies.
    struct mslip_material material[2];
    // `MSLIP_CENTRE_POINT` (0, the paper's displacement) or `MSLIP_RIGID_STRIP` (1, corrected to 3-D).
    int32_t displacement_reference;
    // Not read; 0.
    int32_t reserved;
} mslip_parameters;

// Elliptical Hertz contact (section 3.3); a sphere when both semi-axes are equal.
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
} mslip_elliptic_parameters;

// A contact: prepared once, then only read. Plain data of fixed size that may be copied, stored and sent.
// An open contact (N = 0) has zero width, force and stiffness.
typedef struct mslip_contact {
    // E*, Eq. 2 [Pa].
    double composite_modulus;
    // Half-width b of the contact under its normal force [m]; elliptical: semi_axis_x.
    double half_width;
    // mu N [N].
    double slip_force;
    // Displacement at which gross slip starts on the monotonic curve [m].
    double slip_displacement;
    // dT/d(displacement) at 0 [N/m].
    double initial_stiffness;
    // Dissipated per cycle at incipient gross slip [J].
    double slip_energy;
    // Prepared coefficients and marks: not to be read or written.
    double reserved[243];
} mslip_contact;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Version of the library, "1.2.3".
const char *mslip_version(void);

// Version of this interface: equals MSLIP_ABI_VERSION of the header that belongs to the library.
int32_t mslip_abi_version(void);

// What a status says is wrong, and what is allowed: a static sentence.
const char *mslip_status_text(int32_t status);

// Parameters with every number unset (NaN), so that a forgotten one is refused by name; the centre point as reference.
// NULL is ignored.
//
// Memory: `p` is NULL or points to parameters.
void mslip_parameters_default(struct mslip_parameters *p);

// Elliptical parameters with every number unset (NaN). NULL is ignored.
//
// Memory: `p` is NULL or points to parameters.
void mslip_elliptic_parameters_default(struct mslip_elliptic_parameters *p);

// Prepares the contact of a flat with rounded edges, or of a cylinder (Eq. 1, 2, 10).
//
// Returns MSLIP_NULL_POINTER, the code of the first parameter that is not allowed, MSLIP_LENGTH_TOO_SHORT or
// MSLIP_OUT_OF_RANGE; then the contact is unchanged.
//
// Memory: `p` and `contact` are NULL or point to what their types say.
int32_t mslip_contact_init(const struct mslip_parameters *p,
                           struct mslip_contact *contact);

// Prepares a contact as mslip_contact_init does, with the same numbers in it, but faster where `like` has the same shape: it
// differs in the friction coefficient only, or in scale by powers of 2. Otherwise it takes as long. contact may be like.
//
// Returns what mslip_contact_init returns, or MSLIP_BAD_CONTACT; then the contact is unchanged.
//
// Memory: All pointers are NULL or point to what their types say.
int32_t mslip_contact_init_like(const struct mslip_parameters *p,
                                const struct mslip_contact *like,
                                struct mslip_contact *contact);

// Prepares an elliptical Hertz contact (section 3.3); a sphere when both semi-axes are equal.
//
// Returns MSLIP_NULL_POINTER, the code of the first parameter that is not allowed, or MSLIP_OUT_OF_RANGE; then the contact
// is unchanged.
//
// Memory: `p` and `contact` are NULL or point to what their types say.
int32_t mslip_contact_init_elliptic(const struct mslip_elliptic_parameters *p,
                                    struct mslip_contact *contact);

// Tractions [Pa] at x[n] [m] along the width, under a monotonically grown force [N] (Eq. 17, 21-24); 0 outside the
// contact. Elliptical: on the x axis.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE, MSLIP_FORCE_EXCEEDS_SLIP or MSLIP_BAD_POSITION.
//
// Memory: Pointers are NULL or point to n numbers; outputs overlap nothing.
int32_t mslip_tractions(const struct mslip_contact *contact,
                        double force,
                        size_t n,
                        const double *x,
                        double *pressure,
                        double *shear);

// Relative slip [m] (Eq. 15) and frictional damage parameter mu p |s| [N/m] (section 3.5) at x[n] [m], under a
// monotonically grown force [N]; 0 in the stick zone and outside the contact.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE, MSLIP_FORCE_EXCEEDS_SLIP, MSLIP_BAD_POSITION, or
// MSLIP_NOT_AVAILABLE for an elliptical contact.
//
// Memory: Pointers are NULL or point to n numbers; outputs overlap nothing.
int32_t mslip_slip(const struct mslip_contact *contact,
                   double force,
                   size_t n,
                   const double *x,
                   double *slip,
                   double *damage);

// Monotonic curve (Eq. 10), odd in the force: displacement [m], compliance [m/N] and stick half-width [m] at
// force[n] [N]. The compliance at mu N is infinite for a cylinder and an elliptical contact.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE or MSLIP_FORCE_EXCEEDS_SLIP.
//
// Memory: Pointers are NULL or point to n numbers; outputs overlap nothing.
int32_t mslip_monotonic_displacement(const struct mslip_contact *contact,
                                     size_t n,
                                     const double *force,
                                     double *displacement,
                                     double *compliance,
                                     double *stick_half_width);

// Inverse of the monotonic curve, odd in the displacement: force [N], stiffness [N/m] and stick half-width [m] at
// displacement[n] [m]. Beyond slip_displacement the force stays at mu N, and stiffness and stick half-width are 0.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT or MSLIP_BAD_DISPLACEMENT.
//
// Memory: Pointers are NULL or point to n numbers; outputs overlap nothing.
int32_t mslip_monotonic_force(const struct mslip_contact *contact,
                              size_t n,
                              const double *displacement,
                              double *force,
                              double *stiffness,
                              double *stick_half_width);

// Doubles of a state that holds that many nested reversals.
size_t mslip_state_length(size_t reversals);

// Makes a virgin state: no force, no displacement. A state goes on wherever its numbers are copied: one that is full at the
// beginning of a longer array, one with room to spare in a shorter, as long as that holds its reversals.
//
// Returns MSLIP_NULL_POINTER or MSLIP_STATE_TOO_SHORT.
//
// Memory: `state` is NULL or points to state_length numbers.
int32_t mslip_state_init(size_t state_length,
                         double *state);

// Leads a contact from a state to a displacement [m]: force [N], tangent stiffness [N/m], and energy dissipated by this
// step [J] (Eq. 11, 12). state1 may be state0; where it is NULL the new state is not kept.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_STATE, MSLIP_BAD_DISPLACEMENT, or
// MSLIP_STATE_FULL where a further reversal would have to be remembered than the state holds.
//
// Memory: Pointers are NULL or point to state_length numbers (states) or one; state1 is state0 or overlaps nothing.
int32_t mslip_masing_update(const struct mslip_contact *contact,
                            size_t state_length,
                            const double *state0,
                            double displacement,
                            double *state1,
                            double *force,
                            double *stiffness,
                            double *dissipated);

// Leads a contact through n displacements [m]; force[n] [N], stiffness[n] [N/m] and dissipated[n] [J] are those of
// each step. state1 holds the last state and may be state0; where it is NULL the last state is not kept.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_STATE, MSLIP_BAD_DISPLACEMENT, or
// MSLIP_STATE_FULL where the path nests more reversals than the state holds. A path with more turning points than the
// state has room for, or one whose state is not kept, may nest 2048 at most, and takes 40 kB of stack.
//
// Memory: Pointers are NULL or point to state_length numbers (states) or n; state1 is state0 or overlaps nothing.
int32_t mslip_masing_path(const struct mslip_contact *contact,
                          size_t state_length,
                          const double *state0,
                          size_t n,
                          const double *displacement,
                          double *state1,
                          double *force,
                          double *stiffness,
                          double *dissipated);

// Tractions [Pa] at x[n] [m] after any history (Eq. 21 superposed by Masing's rule).
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_STATE, MSLIP_BAD_POSITION, or
// MSLIP_FORCE_EXCEEDS_SLIP for the state of another contact.
//
// Memory: Pointers are NULL or point to state_length numbers (the state) or n; outputs overlap nothing.
int32_t mslip_masing_tractions(const struct mslip_contact *contact,
                               size_t state_length,
                               const double *state,
                               size_t n,
                               const double *x,
                               double *pressure,
                               double *shear);

// Closed loop between +amplitude and -amplitude [m]: displacement[n] [m] and force[n] [N] at n equidistant instants of one
// period of amplitude cos(t), from t = 0.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT or MSLIP_BAD_AMPLITUDE.
//
// Memory: Pointers are NULL or point to n numbers; outputs overlap nothing.
int32_t mslip_hysteresis_loop(const struct mslip_contact *contact,
                              double amplitude,
                              size_t n,
                              double *displacement,
                              double *force);

// Energy [J] dissipated per cycle between ± force_amplitude[n] [N], from 0 to mu N (Eq. 13-16).
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE_AMPLITUDE or MSLIP_FORCE_EXCEEDS_SLIP.
//
// Memory: Pointers are NULL or point to n numbers; outputs overlap nothing.
int32_t mslip_dissipated_energy(const struct mslip_contact *contact,
                                size_t n,
                                const double *force_amplitude,
                                double *energy);

// Complex (harmonic) stiffness K' + iK'' [N/m] at displacement amplitude[n] >= 0 [m] and its derivatives by the amplitude
// [N/m^2] (section 3.4); an amplitude of 0 gives the initial stiffness.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT or MSLIP_BAD_AMPLITUDE.
//
// Memory: Pointers are NULL or point to n numbers; outputs overlap nothing.
int32_t mslip_complex_stiffness(const struct mslip_contact *contact,
                                size_t n,
                                const double *amplitude,
                                double *k_real,
                                double *k_imag,
                                double *dk_real,
                                double *dk_imag);

// Doubles of a workspace for so many harmonics H >= 1 and samples > 2H a period; 0 where these are not allowed. The rule
// is MSLIP_EQUIDISTANT.
size_t mslip_harmonic_workspace_length(size_t harmonics,
                                       size_t samples);

// Prepares a workspace: tables for one pair of harmonics and samples, and scratch memory. One for each thread. The rule is
// MSLIP_EQUIDISTANT.
//
// Returns MSLIP_BAD_HARMONICS, MSLIP_BAD_SAMPLES, MSLIP_NULL_POINTER or MSLIP_WORKSPACE_TOO_SHORT.
//
// Memory: `workspace` is NULL or points to workspace_length numbers.
int32_t mslip_harmonic_workspace_init(size_t harmonics,
                                      size_t samples,
                                      size_t workspace_length,
                                      double *workspace);

// mslip_harmonic_workspace_length for a rule, MSLIP_EQUIDISTANT or MSLIP_BETWEEN_REVERSALS; 0 for another.
size_t mslip_harmonic_workspace_length_rule(size_t harmonics,
                                            size_t samples,
                                            int32_t rule);

// mslip_harmonic_workspace_init for a rule. MSLIP_EQUIDISTANT samples a period at equal distances: its error falls with the
// square of their number. MSLIP_BETWEEN_REVERSALS finds the instants at which the displacement turns, a loop closes or gross
// slip starts, and puts about as many Gauss-Legendre nodes as there are samples between them, 8 at least between two: its
// error falls exponentially, and the energy is exact. It looks for the instants on a grid of `samples`, at least 16 H.
//
// Returns MSLIP_BAD_RULE or the codes of mslip_harmonic_workspace_init.
//
// Memory: `workspace` is NULL or points to workspace_length numbers.
int32_t mslip_harmonic_workspace_init_rule(size_t harmonics,
                                           size_t samples,
                                           int32_t rule,
                                           size_t workspace_length,
                                           double *workspace);

// Harmonic force by alternating between frequency and time, in steady state (the second of two periods from the virgin
// state), by the rule of the workspace. Coefficients [c0, cos1, sin1, cos2, sin2, ...], 2H+1 of them: displacement [m],
// force [N]; jacobian [N/m] is d force_i / d displacement_j, (2H+1) x (2H+1), column-major, exact for this definition;
// where two samples are equally far at a turning point, or one is just at gross slip, it is that of one side. With
// MSLIP_BETWEEN_REVERSALS it is the rule applied to the exact derivative of the integrals, and as good as the force.
// dissipated [J] is per period.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_WORKSPACE or MSLIP_BAD_DISPLACEMENT.
//
// Memory: `workspace` is NULL or was initialised; the others are NULL or as long as said; outputs overlap nothing.
int32_t mslip_harmonic_force(const struct mslip_contact *contact,
                             double *workspace,
                             const double *displacement,
                             double *force,
                             double *jacobian,
                             double *dissipated);

// The spring-slider with the same K' and K'' at a displacement amplitude [m]: stiffness [N/m] and slip force [N]. At the
// amplitude 0: the initial stiffness, and mu N. Both are 0 for a contact that carries no force.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT or MSLIP_BAD_AMPLITUDE.
//
// Memory: Pointers are NULL or point to one item; outputs overlap nothing.
int32_t mslip_jenkins_equivalent(const struct mslip_contact *contact,
                                 double amplitude,
                                 double *stiffness,
                                 double *slip_force);

// n parallel spring-sliders with the contact's monotonic curve to the smallest error that n allow: stiffness[n] [N/m],
// slip_force[n] [N], adding up to mu N, and force_error, the largest error of the force over mu N. All are 0 for a contact
// that carries no force.
//
// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT or MSLIP_BAD_COUNT.
//
// Memory: Pointers are NULL or point to n numbers (force_error: one); outputs overlap nothing.
int32_t mslip_iwan_equivalent(const struct mslip_contact *contact,
                              size_t n,
                              double *stiffness,
                              double *slip_force,
                              double *force_error);

// mslip_complex_stiffness of n contacts, one amplitude each. Items whose active flag is 0 are skipped.
//
// Returns the codes of mslip_complex_stiffness; then no item has written anything.
//
// Memory: Pointers are NULL or point to n items; outputs overlap nothing.
int32_t mslip_interface_complex_stiffness(size_t n,
                                          const struct mslip_contact *contacts,
                                          const int32_t *active,
                                          const double *amplitude,
                                          double *k_real,
                                          double *k_imag,
                                          double *dk_real,
                                          double *dk_imag);

// mslip_masing_update of n contacts: states hold state_length numbers an item, item after item; displacement, force,
// stiffness and dissipated one. Items whose active flag is 0 are skipped, their states too. states1 may be states0.
//
// Returns the codes of mslip_masing_update; then no item has written anything.
//
// Memory: Pointers are NULL or as long as said; states1 is states0 or overlaps nothing.
int32_t mslip_interface_masing_update(size_t n,
                                      const struct mslip_contact *contacts,
                                      const int32_t *active,
                                      size_t state_length,
                                      const double *states0,
                                      const double *displacement,
                                      double *states1,
                                      double *force,
                                      double *stiffness,
                                      double *dissipated);

// mslip_harmonic_force of n contacts through one workspace: displacement and force hold 2H+1 numbers an item, jacobian
// (2H+1)^2, dissipated one. Items whose active flag is 0 are skipped.
//
// Returns the codes of mslip_harmonic_force; then no item has written anything.
//
// Memory: `workspace` is NULL or was initialised; the others are NULL or as long as said; outputs overlap nothing.
int32_t mslip_interface_harmonic_force(size_t n,
                                       const struct mslip_contact *contacts,
                                       const int32_t *active,
                                       double *workspace,
                                       const double *displacement,
                                       double *force,
                                       double *jacobian,
                                       double *dissipated);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* MICROSLIP_H */
