/* The C interface against every table of high-precision reference values for a constant normal force.
 *
 *     golden [--trap] [DIRECTORY]
 *
 * The inputs of the tables are doubles, so a difference is an error of the library, or a rounding error that the definition of a
 * quantity amplifies (mu N is rounded before it is compared with T, b before it is compared with x), which the tolerance covers. */
#include "table.h"

#include <microslip.h>
#include <float.h>
#include <stddef.h>
#include <stdlib.h>

enum { MAX_CONTACTS = 64, MAX_HISTORY = 512, REVERSALS = 64 };

static const double PI = 3.14159265358979323846;

typedef struct reference_contact {
    mslip_parameters parameters;
    mslip_contact contact;
    double slip_force; /* of the table */
} reference_contact;

/* Relative. */
#define TOLERANCE 1e-13

static reference_contact contacts[MAX_CONTACTS];
static int contact_count;

static const reference_contact *contact_of(const table *t, int column)
{
    int index = (int)t->value[column];
    if (index < 0 || index >= contact_count) {
        fprintf(stderr, "%s: line %d: no contact %d\n", t->name, t->line, index);
        exit(2);
    }
    return &contacts[index];
}

/* Relative error of the stick half-width c due to four roundings of tau. From g(w_c) = (1-tau) g(w_b), with g' = 4 w psi and
   g <= 2 w^2 psi: dc/c = w dw/c^2 <= (w/c)^2 dtau/(2 (1-tau)). */
static double stick_uncertainty(const reference_contact *r, double force, double stick)
{
    double a = r->parameters.flat_half_width;
    double tau = fabs(force) / r->slip_force;
    double moving = stick > a ? (1.0 - a / stick) * (1.0 + a / stick) : 0.0;
    return tau < 1.0 ? 2.0 * DBL_EPSILON * tau / (1.0 - tau) * moving : 0.0;
}

static void check_contacts(void)
{
    table t = open_table("contacts", "contact,a,R,L,N,mu,E1,nu1,E2,nu2,E_star,b,slip_force,slip_displacement,"
                                     "initial_stiffness,slip_energy");
    while (next_row(&t)) {
        const double *v = t.value;
        reference_contact *r = &contacts[contact_count];
        if (contact_count == MAX_CONTACTS || (int)v[0] != contact_count) {
            fprintf(stderr, "contacts: line %d is not contact %d\n", t.line, contact_count);
            exit(2);
        }
        ++contact_count;
        mslip_parameters_default(&r->parameters);
        r->parameters.displacement_reference = MSLIP_CENTRE_POINT;
        r->parameters.flat_half_width = v[1];
        r->parameters.edge_radius = v[2];
        r->parameters.length = v[3];
        r->parameters.normal_force = v[4];
        r->parameters.friction_coefficient = v[5];
        r->parameters.material[0].young_modulus = v[6];
        r->parameters.material[0].poisson_ratio = v[7];
        r->parameters.material[1].young_modulus = v[8];
        r->parameters.material[1].poisson_ratio = v[9];
        r->slip_force = v[12];

        accepted(&t, mslip_contact_init(&r->parameters, &r->contact));
        compare(&t, "E*", r->contact.composite_modulus, v[10], 1e-15 * v[10]);
        compare(&t, "b", r->contact.half_width, v[11], TOLERANCE * v[11]);
        compare(&t, "slip force", r->contact.slip_force, v[12], DBL_EPSILON * v[12]);
        compare(&t, "slip displacement", r->contact.slip_displacement, v[13], TOLERANCE * v[13]);
        compare(&t, "initial stiffness", r->contact.initial_stiffness, v[14], TOLERANCE * v[14]);
        compare(&t, "slip energy", r->contact.slip_energy, v[15], TOLERANCE * v[15]);
    }
}

static void check_monotonic(void)
{
    table t = open_table("monotonic", "contact,T,stick_half_width,displacement,compliance");
    while (next_row(&t)) {
        const reference_contact *r = contact_of(&t, 0);
        double force = t.value[1], stick = t.value[2], displacement = t.value[3], compliance = t.value[4];
        double got[3];
        double uncertainty = stick_uncertainty(r, force, stick);
        /* The compliance is logarithmic in c. */
        double unit = 2.0 / (PI * r->contact.composite_modulus * r->parameters.length);

        accepted(&t, mslip_monotonic_displacement(&r->contact, 1, &force, &got[0], &got[1], &got[2]));
        compare(&t, "displacement", got[0], displacement, TOLERANCE * displacement);
        compare(&t, "compliance", got[1], compliance,
                isinf(compliance) ? 0.0 : TOLERANCE * compliance + unit * uncertainty);
        compare(&t, "stick half-width", got[2], stick, (TOLERANCE + uncertainty) * stick);
    }
}

static void check_monotonic_inverse(void)
{
    table t = open_table("monotonic_inverse", "contact,displacement,T");
    while (next_row(&t)) {
        const reference_contact *r = contact_of(&t, 0);
        double force;
        accepted(&t, mslip_monotonic_force(&r->contact, 1, &t.value[1], &force, NULL, NULL));
        compare(&t, "force", force, t.value[2], TOLERANCE * t.value[2]);
    }
}

static void check_energy(void)
{
    table t = open_table("energy", "contact,T,dissipated_per_cycle");
    while (next_row(&t)) {
        const reference_contact *r = contact_of(&t, 0);
        double energy;
        accepted(&t, mslip_dissipated_energy(&r->contact, 1, &t.value[1], &energy));
        compare(&t, "energy", energy, t.value[2], TOLERANCE * t.value[2]);
    }
}

/* Errors of a table are relative to |K| and to |K|/amplitude. */
static void check_tabulated_stiffness(const table *t, const reference_contact *r, double slipped)
{
    static double memory[1024];
    double amplitude = t->value[1], size = hypot(t->value[2], t->value[3]), got[4];
    accepted(t, mslip_stiffness_table_init(&r->contact, sizeof memory / sizeof *memory, memory));
    accepted(t, mslip_complex_stiffness_tabulated(&r->contact, memory, 1, &amplitude, &got[0], &got[1], &got[2], &got[3]));
    for (int part = 0; part < 2; ++part) {
        double k = t->value[2 + part], derivative = t->value[4 + part];
        compare(t, part ? "K'' of a table" : "K' of a table", got[part], k,
                TOLERANCE * size + (part ? slipped / (PI * amplitude * amplitude) : 0.0));
        check_that(isfinite(got[2 + part]), t->name, t->line, "the derivative of K is finite");
        if (!isnan(derivative)) {
            compare(t, part ? "dK'' of a table" : "dK' of a table", got[2 + part], derivative,
                    TOLERANCE * (size / amplitude + fabs(derivative)));
        }
    }
}

static void check_complex_stiffness(void)
{
    table t = open_table("complex_stiffness",
                         "contact,amplitude,k_real,k_imag,dk_real,dk_imag,dissipated_per_cycle");
    while (next_row(&t)) {
        const reference_contact *r = contact_of(&t, 0);
        double amplitude = t.value[1], k_real = t.value[2], k_imag = t.value[3], energy = t.value[6];
        double got[4], slipped = 0.0;
        /* The slipped length is a difference of two displacements: of a nearly flat contact it is all rounding. */
        if (amplitude >= r->contact.slip_displacement * (1.0 - 4.0 * DBL_EPSILON)) {
            slipped = 4.0 * r->slip_force * 2.0 * DBL_EPSILON * r->contact.slip_displacement;
        }
        check_tabulated_stiffness(&t, r, slipped);
        accepted(&t, mslip_complex_stiffness(&r->contact, 1, &amplitude, &got[0], &got[1], &got[2], &got[3]));
        compare(&t, "K'", got[0], k_real, TOLERANCE * k_real);
        compare(&t, "K''", got[1], k_imag,
                TOLERANCE * k_imag + slipped / (PI * amplitude * amplitude));
        compare(&t, "pi K'' amplitude^2", PI * got[1] * amplitude * amplitude, energy,
                2.0 * TOLERANCE * energy + slipped);
        /* Errors of a derivative are relative to K over an amplitude; at a jump the table has NaN, and the library one side. */
        for (int part = 0; part < 2; ++part) {
            check_that(isfinite(got[2 + part]), t.name, t.line, "the derivative of K is finite");
            if (!isnan(t.value[4 + part])) {
                compare(&t, part ? "dK''" : "dK'", got[2 + part], t.value[4 + part],
                        10.0 * TOLERANCE * (hypot(k_real, k_imag) / amplitude + fabs(t.value[4 + part])));
            }
        }
    }
}

static void check_history(const table *t, const reference_contact *r, size_t n, const double *displacement,
                          const double *want)
{
    static double state[1024], force[MAX_HISTORY];
    size_t length = mslip_state_length(REVERSALS);
    double largest = 0.0;

    if (length > sizeof state / sizeof *state) {
        fprintf(stderr, "a state of %d reversals has %lu doubles\n", REVERSALS, (unsigned long)length);
        exit(2);
    }
    accepted(t, mslip_state_init(length, state));
    accepted(t, mslip_masing_path(&r->contact, length, state, n, displacement, state, force, NULL, NULL));
    for (size_t i = 0; i < n; ++i) {
        /* A force is a sum over reversals and has the rounding error of the largest term. */
        largest = fmax(largest, fabs(want[i]));
        compare(t, "force", force[i], want[i], 2.0 * TOLERANCE * largest);
    }
}

static void check_histories(void)
{
    static double displacement[MAX_HISTORY], force[MAX_HISTORY];
    table t = open_table("histories", "history,contact,displacement,T");
    const reference_contact *r = NULL;
    double history = -1.0;
    size_t n = 0;
    int more;

    do {
        more = next_row(&t);
        if (n > 0 && (!more || t.value[0] != history)) {
            check_history(&t, r, n, displacement, force);
            n = 0;
        }
        if (more) {
            if (n == MAX_HISTORY) {
                fprintf(stderr, "histories: line %d: the history is too long\n", t.line);
                exit(2);
            }
            history = t.value[0];
            r = contact_of(&t, 1);
            displacement[n] = t.value[2];
            force[n++] = t.value[3];
        }
    } while (more);
}

static void check_harmonic_force(void)
{
    enum { HARMONICS = 3, COEFFICIENTS = 2 * HARMONICS + 1 };
    table t = open_table("harmonic_force", "case,contact,samples,u0,u1,u2,u3,u4,u5,u6,f0,f1,f2,f3,f4,f5,f6");
    while (next_row(&t)) {
        const reference_contact *r = contact_of(&t, 1);
        size_t samples = (size_t)t.value[2];
        size_t length = mslip_harmonic_workspace_length(HARMONICS, samples, MSLIP_UNIFORM_SAMPLING);
        double *workspace = malloc(length * sizeof *workspace);
        double force[COEFFICIENTS], largest = 0.0;

        accepted(&t, mslip_harmonic_workspace_init(HARMONICS, samples, MSLIP_UNIFORM_SAMPLING, length, workspace));
        accepted(&t, mslip_harmonic_force(&r->contact, workspace, &t.value[3], force, NULL, NULL));
        for (int i = 0; i < COEFFICIENTS; ++i) {
            largest = fmax(largest, fabs(t.value[10 + i]));
        }
        for (int i = 0; i < COEFFICIENTS; ++i) {
            compare(&t, "harmonic of the force", force[i], t.value[10 + i], 2.0 * TOLERANCE * largest);
        }
        free(workspace);
    }
}

/* Relative error, due to the rounding of x and of the edge, of a quantity that decreases to zero at the edge as a power of the
   distance. */
static double edge_uncertainty(double power, double x, double edge, double uncertainty)
{
    double distance = fabs(edge - fabs(x)) / fmax(edge, DBL_MIN);
    return power * (uncertainty + 4.0 * DBL_EPSILON) / fmax(distance, DBL_EPSILON);
}

static void check_tractions(void)
{
    table t = open_table("tractions", "contact,T,x,pressure,shear");
    while (next_row(&t)) {
        const reference_contact *r = contact_of(&t, 0);
        double force = t.value[1], x = t.value[2], pressure = t.value[3], shear = t.value[4];
        double mu = r->parameters.friction_coefficient;
        double got[2], stick, relative, inner;

        accepted(&t, mslip_monotonic_displacement(&r->contact, 1, &force, NULL, NULL, &stick));
        accepted(&t, mslip_tractions(&r->contact, force, 1, &x, &got[0], &got[1]));
        relative = TOLERANCE + edge_uncertainty(0.5, x, r->contact.half_width, 0.0);
        compare(&t, "pressure", got[0], pressure, relative * pressure);
        /* The shear is the difference of mu p and, within the stick zone, of the same with its edge at c. */
        inner = fmax(0.0, mu * pressure - fabs(shear));
        relative *= mu * pressure;
        relative += inner * edge_uncertainty(0.5, x, stick, stick_uncertainty(r, force, stick));
        compare(&t, "shear", got[1], shear, relative);
    }
}

static void check_slip(void)
{
    table t = open_table("slip", "contact,T,x,slip,damage");
    while (next_row(&t)) {
        const reference_contact *r = contact_of(&t, 0);
        double force = t.value[1], x = t.value[2];
        double got[2], stick, relative;

        accepted(&t, mslip_monotonic_displacement(&r->contact, 1, &force, NULL, NULL, &stick));
        accepted(&t, mslip_slip(&r->contact, force, 1, &x, &got[0], &got[1]));
        /* Slip scales as the 3/2 to 5/2 power of the distance from the stick zone. */
        relative = TOLERANCE + edge_uncertainty(2.5, x, stick, stick_uncertainty(r, force, stick));
        compare(&t, "slip", got[0], t.value[3], relative * t.value[3]);
        relative += edge_uncertainty(0.5, x, r->contact.half_width, 0.0);
        compare(&t, "damage", got[1], t.value[4], relative * t.value[4]);
    }
}

static void check_elliptic(void)
{
    table t = open_table("elliptic", "case,semi_axis_x,semi_axis_y,N,mu,E,nu,initial_stiffness,T,displacement,"
                                     "dissipated_per_cycle");
    while (next_row(&t)) {
        const double *v = t.value;
        mslip_elliptic_parameters p;
        mslip_contact contact;
        double displacement, force, energy, remaining, rounding;

        mslip_elliptic_parameters_default(&p);
        p.semi_axis_x = v[1];
        p.semi_axis_y = v[2];
        p.normal_force = v[3];
        p.friction_coefficient = v[4];
        p.material[0].young_modulus = p.material[1].young_modulus = v[5];
        p.material[0].poisson_ratio = p.material[1].poisson_ratio = v[6];
        accepted(&t, mslip_contact_init_elliptic(&p, &contact));
        compare(&t, "initial stiffness", contact.initial_stiffness, v[7], 1e-13 * v[7]);
        /* Near mu N the curve varies as (1-tau)^(2/3), which amplifies roundings of T and of mu N, five times in the energy. */
        remaining = fmax(0.0, 1.0 - v[8] / contact.slip_force);
        rounding = pow(remaining + 2.0 * DBL_EPSILON, 2.0 / 3.0) - pow(remaining, 2.0 / 3.0);
        accepted(&t, mslip_monotonic_displacement(&contact, 1, &v[8], &displacement, NULL, NULL));
        compare(&t, "displacement", displacement, v[9], (1e-13 + rounding) * v[9]);
        accepted(&t, mslip_monotonic_force(&contact, 1, &v[9], &force, NULL, NULL));
        compare(&t, "force", force, v[8], 1e-13 * v[8]);
        accepted(&t, mslip_dissipated_energy(&contact, 1, &v[8], &energy));
        compare(&t, "energy", energy, v[10], (1e-13 + 5.0 * rounding) * v[10]);
    }
}

/* The strip of the boundary element tables: half-width 1, and mu N such that the unit of displacement, 2 mu P/(pi E*), is 1. */
static void init_strip(const table *t, double aspect_ratio, double a, double nu, mslip_contact *contact)
{
    double w = sqrt((1.0 - a) * (1.0 + a));
    double g = 2.0 * atan2(w, a) - 2.0 * a * w;
    mslip_parameters p;

    mslip_parameters_default(&p);
    p.flat_half_width = a;
    p.length = 2.0 * aspect_ratio;
    p.friction_coefficient = 0.5;
    p.material[0].young_modulus = p.material[1].young_modulus = 2.0 * (1.0 - nu * nu); /* E* = 1 */
    p.material[0].poisson_ratio = p.material[1].poisson_ratio = nu;
    p.normal_force = PI * p.length;
    p.edge_radius = g * p.length / (4.0 * p.normal_force);
    p.displacement_reference = MSLIP_RIGID_STRIP;
    accepted(t, mslip_contact_init(&p, contact));
    compare(t, "half-width of the strip", contact->half_width, 1.0, 1e-13);
}

/* MSLIP_RIGID_STRIP against three-dimensional boundary elements, under the uniform pressure of the strip (variant i) and
   under the true one (ii), for which the law holds: within 0.3 % up to 0.98 mu N for L/2b >= 5 and nu = 0.3. */
static void check_strip(void)
{
    static const double level[4] = { 0.3, 0.6, 0.9, 0.98 };
    table t = open_table("strip_3d",
                         "variant,AR,a,nu,n,Lam,C0_3D,C0_closed,d3D_0.3,dlaw_0.3,dclosed_0.3,d3D_0.6,dlaw_0.6,"
                         "dclosed_0.6,d3D_0.9,dlaw_0.9,dclosed_0.9,d3D_0.98,dlaw_0.98,dclosed_0.98,d3D_1,dlaw_1,"
                         "dclosed_1,W3D_0.6,Wlaw_0.6,Wclosed_0.6,W3D_0.9,Wlaw_0.9,Wclosed_0.9,W3D_0.98,Wlaw_0.98,"
                         "Wclosed_0.98,W3D_1,Wlaw_1,Wclosed_1,W1_exactform,grid_rel_diff_d,grid_rel_diff_W");
    while (next_row(&t)) {
        const double *v = t.value;
        const int is_uniform = strcmp(t.text[0], "i") == 0;
        int holds = !is_uniform && v[3] == 0.3;
        int stocky = v[1] < 5.0;
        double compliance;
        mslip_contact contact;

        init_strip(&t, v[1], v[2], v[3], &contact);
        compliance = contact.slip_force / contact.initial_stiffness;
        /* The fitted constant of the law has three decimals, that of the table has more. */
        compare(&t, "initial compliance", compliance, v[7], 2e-4);
        if (is_uniform) {
            compare(&t, "initial compliance against 3-D", compliance, v[6], 0.0025 * v[6]);
        } else if (holds) {
            compare(&t, "initial compliance against 3-D", compliance, v[6], (stocky ? 0.018 : 0.0045) * v[6]);
        }
        for (int i = 0; i < 4; ++i) {
            double force = level[i] * contact.slip_force, in_3d = v[8 + 3 * i], displacement;
            accepted(&t, mslip_monotonic_displacement(&contact, 1, &force, &displacement, NULL, NULL));
            if (!is_uniform) {
                compare(&t, "displacement", displacement, v[10 + 3 * i], 2e-4);
            }
            if (holds) {
                compare(&t, "displacement against 3-D", displacement, in_3d, (stocky ? 0.014 : 0.003) * in_3d);
            }
        }
    }
}

/* The same against the code CONTACT, from which the boundary elements differ by up to 0.14 %. */
static void check_strip_contact(void)
{
    table t = open_table("strip_3d_contact", "AR,a,n,variant,nu,tau,delta_CONTACT,delta_BEM,ratio");
    while (next_row(&t)) {
        const double *v = t.value;
        if (strcmp(t.text[3], "ii") == 0 && v[4] == 0.3) {
            mslip_contact contact;
            double force, displacement, allowed = v[0] < 5.0 ? 0.0154 : 0.0044;
            init_strip(&t, v[0], v[1], v[4], &contact);
            force = v[5] * contact.slip_force;
            accepted(&t, mslip_monotonic_displacement(&contact, 1, &force, &displacement, NULL, NULL));
            compare(&t, "displacement against CONTACT", displacement, v[6], allowed * v[6]);
        }
    }
}

int main(int argc, char **argv)
{
    table_arguments(argc, argv);
    check_contacts();
    check_monotonic();
    check_monotonic_inverse();
    check_energy();
    check_complex_stiffness();
    check_histories();
    check_harmonic_force();
    check_tractions();
    check_slip();
    check_elliptic();
    check_strip();
    check_strip_contact();
    return check_report();
}
