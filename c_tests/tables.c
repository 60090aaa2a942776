/* The installed archive against every reference table: each function of the interface as a single call or step, as a path, and as a
 * batch, with the same bits. Inputs of the tables are doubles, so that a difference is an error of the library or a rounding that the
 * definition of a quantity amplifies. Then the ends of the curves, and contacts without a tangential force.
 *
 *     tables [--trap] [DIRECTORY] */
#include "check.h"

#include <microslip.h>
#include <float.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

enum { MOST_STEPS = 512, STATE = 2000, COMPONENTS = 3, MOST_CONTACTS = 64 };
static const double PI = 3.14159265358979323846;
/* Relative errors of a constant load. */
#define TOLERANCE 1e-13
#define OK(call) CHECK((call) == MSLIP_OK)

/* --- Tables --- */

static const char *directory = "tests/golden";

/* The present row of a table. */
typedef struct {
    FILE *file;
    const char *name;
    int line, columns;
    const char *column[40], *cell[40];
    char header[1024], text[8192];
} table;

static int split(char *line, const char **part)
{
    int parts = 0;
    for (char *next = strtok(line, ",\r\n"); next != NULL && parts < 40; next = strtok(NULL, ",\r\n")) {
        part[parts++] = next;
    }
    return parts;
}

/* Reads the next row; 0 at the end. A table has at least one row. */
static int next_row(table *t, const char *name)
{
    if (t->file == NULL) {
        char path[4096];
        snprintf(path, sizeof path, "%s/%s.csv", directory, name);
        t->name = name;
        t->line = 1;
        t->file = fopen(path, "r");
        if (t->file == NULL || fgets(t->header, sizeof t->header, t->file) == NULL) {
            fprintf(stderr, "%s cannot be read\n", path);
            exit(2);
        }
        t->columns = split(t->header, t->column);
    }
    if (fgets(t->text, sizeof t->text, t->file) == NULL) {
        CHECK(t->line > 1);
        fclose(t->file);
        return 0;
    }
    ++t->line;
    CHECK(split(t->text, t->cell) == t->columns);
    return 1;
}

static const char *word(const table *t, const char *column)
{
    for (int i = 0; i < t->columns; ++i) {
        if (strcmp(t->column[i], column) == 0) return t->cell[i];
    }
    return "";
}

static int has(const table *t, const char *column)
{
    return *word(t, column) != '\0';
}

/* The value in a column; NaN without it. */
static double get(const table *t, const char *column)
{
    return has(t, column) ? strtod(word(t, column), NULL) : (double)NAN;
}

static void compare(const table *t, const char *column, double got, double want, double tolerance)
{
    check_near(got, want, tolerance, t->name, t->line, column);
}

/* A value against that of its column, relative to it. */
static void relative(const table *t, const char *column, double got, double tolerance)
{
    const double want = get(t, column);
    compare(t, column, got, want, isinf(want) ? 0.0 : tolerance * fabs(want));
}

/* --- Contacts and elements of a row --- */

static mslip_layer layer_of(const table *t)
{
    const mslip_layer none = { 0.0, 0.0, 0.0, 0.0 }, layer = { get(t, "c_n"), get(t, "c_t"), get(t, "N_c"), get(t, "N_layer") };
    return has(t, "c_n") ? layer : none;
}

static void set_materials(const table *t, mslip_material material[2])
{
    const int same = !has(t, "E1");
    for (int i = 0; i < 2; ++i) {
        material[i].young_modulus = get(t, same ? "E" : i ? "E2" : "E1");
        material[i].poisson_ratio = get(t, same ? "nu" : i ? "nu2" : "nu1");
    }
}

static mslip_parameters line_of(const table *t, double normal_force)
{
    mslip_parameters p;
    mslip_parameters_default(&p);
    p.flat_half_width = get(t, "a");
    p.edge_radius = get(t, "R");
    p.length = get(t, "L");
    p.normal_force = normal_force;
    p.friction_coefficient = has(t, "mu") ? get(t, "mu") : 0.5;
    p.displacement_reference = MSLIP_CENTRE_POINT;
    set_materials(t, p.material);
    p.layer = layer_of(t);
    return p;
}

/* Semi-axes, which are those under N_ref, or under the normal force of the row. */
static mslip_elliptic_parameters ellipse_of(const table *t, double normal_force)
{
    mslip_elliptic_parameters p;
    const int scaled = has(t, "N_ref");
    const double scale = scaled && normal_force > 0.0 ? cbrt(normal_force / get(t, "N_ref")) : 1.0;
    mslip_elliptic_parameters_default(&p);
    p.semi_axis_x = scale * get(t, scaled ? "semi_x" : "semi_axis_x");
    p.semi_axis_y = scale * get(t, scaled ? "semi_y" : "semi_axis_y");
    p.normal_force = normal_force > 0.0 ? normal_force : get(t, "N_ref");
    p.friction_coefficient = has(t, "mu") ? get(t, "mu") : 0.5;
    set_materials(t, p.material);
    p.layer = layer_of(t);
    return p;
}

/* An element for loads up to this one, or for smaller loads if that is too large for the length, or for N_c. */
static void init_element(const table *t, double normal_force, int32_t directions, int32_t normal_input, mslip_element *element)
{
    normal_force = has(t, "N_c") ? fmin(normal_force, 999.0 * get(t, "N_c")) : normal_force;
    if (isnan(get(t, "a"))) {
        const mslip_elliptic_parameters p = ellipse_of(t, normal_force);
        OK(mslip_element_init_elliptic(&p, directions, normal_input, element));
        return;
    }
    mslip_parameters p = line_of(t, normal_force);
    int32_t status;
    while ((status = mslip_element_init(&p, directions, normal_input, element)) == MSLIP_LENGTH_TOO_SHORT) {
        p.normal_force /= 4.0;
    }
    CHECK(status == MSLIP_OK && mslip_element_check(element) == MSLIP_OK);
}

/* --- Steps, paths and batches of both laws --- */

/* A contact, or an element of one direction or two. */
typedef struct {
    const mslip_contact *contact;
    const mslip_element *element;
} law;

static size_t components(const law *l)
{
    return l->element == NULL ? 1 : 1 + (size_t)l->element->directions;
}

static int32_t init_state(const law *l, size_t length, double *state)
{
    return l->element == NULL ? mslip_state_init(length, state) : mslip_element_state_init(l->element->directions, length, state);
}

static int32_t step(const law *l, size_t length, const double *from, const double *u, double *to, double *force, double *tangent,
                    double *energy)
{
    return l->element == NULL ? mslip_masing_update(l->contact, length, from, *u, to, force, tangent, energy)
                              : mslip_element_update(l->element, length, from, u, to, force, tangent, energy);
}

static int32_t path(const law *l, size_t length, const double *from, size_t n, const double *u, double *to, double *force,
                    double *tangent, double *energy)
{
    return l->element == NULL ? mslip_masing_path(l->contact, length, from, n, u, to, force, tangent, energy)
                              : mslip_element_path(l->element, length, from, n, u, to, force, tangent, energy);
}

static int32_t batch(const law *l, size_t length, const double *from, const double *u, double *to, double *force, double *tangent,
                     double *energy)
{
    static const int32_t index[2] = { 0, 0 };
    return l->element == NULL
               ? mslip_batch_masing_update(2, 1, l->contact, index, NULL, length, from, u, to, force, tangent, energy)
               : mslip_batch_element_update(2, 1, l->element, index, NULL, length, from, u, to, force, tangent, energy);
}

/* The results of a history. */
typedef struct {
    double force[MOST_STEPS][COMPONENTS], tangent[MOST_STEPS][COMPONENTS * COMPONENTS], energy[MOST_STEPS], state[STATE];
} results;

static int same(const double *p, const double *q, size_t n)
{
    return memcmp(p, q, n * sizeof *p) == 0;
}

/* The doubles of a state in use: the number of reversals or knots is in the tag; the springs of two directions fill theirs. */
static size_t used(const law *l, const double *state)
{
    uint64_t tag;
    memcpy(&tag, state, sizeof tag);
    const size_t count = (size_t)(tag & 0xff);
    return l->element == NULL ? 5 + 3 * count : l->element->directions == 1 ? 8 + 4 * count : mslip_element_state_length(2, 0);
}

static int same_results(const law *l, const results *r, size_t n, const double *force, const double *tangent, const double *energy,
                        const double *state)
{
    const size_t m = components(l), length = used(l, r->state);
    int holds = same(energy, r->energy, n) && (state == NULL || same(state, r->state, length));
    for (size_t i = 0; i < n; ++i) {
        holds &= same(force + i * m, r->force[i], m) && same(tangent + i * m * m, r->tangent[i], m * m);
    }
    return holds;
}

/* Step by step, each with a new state; then in place, discarded, as a path in one part and in two, and in a batch with the mirrored
   motion: the same bits. */
static void run(const law *l, size_t length, size_t n, const double *u, results *r)
{
    static double force[MOST_STEPS * COMPONENTS], tangent[MOST_STEPS * COMPONENTS * COMPONENTS], energy[MOST_STEPS];
    static double states[2][STATE], state[STATE], trial[STATE], pair[2 * STATE];
    const size_t m = components(l), half = n / 2;
    int holds = 1;
    OK(init_state(l, length, states[0]));
    OK(init_state(l, length, state));
    for (size_t i = 0; i < n; ++i) {
        const double *from = states[i % 2];
        OK(step(l, length, from, u + i * m, states[1 - i % 2], r->force[i], r->tangent[i], &r->energy[i]));
        memcpy(trial, state, sizeof trial);
        OK(step(l, length, state, u + i * m, NULL, force, NULL, NULL));
        holds &= same(force, r->force[i], m) && same(trial, state, length);
        OK(step(l, length, state, u + i * m, state, NULL, tangent, energy));
        holds &= same(tangent, r->tangent[i], m * m) && same(energy, &r->energy[i], 1);
        OK(l->element == NULL ? mslip_state_check(length, state)
                              : mslip_element_state_check(l->element->directions, length, state));
    }
    memcpy(r->state, states[n % 2], sizeof r->state);
    CHECK(holds && same(state, r->state, used(l, r->state)));

    for (int discarded = 0; discarded < 2; ++discarded) {
        OK(init_state(l, length, state));
        OK(path(l, length, state, n, u, discarded ? NULL : state, force, tangent, energy));
        CHECK(same_results(l, r, n, force, tangent, energy, discarded ? NULL : state));
    }
    /* The state is stored in between. */
    memset(force, 0xff, sizeof force);
    OK(init_state(l, length, trial));
    OK(path(l, length, trial, half, u, trial, force, tangent, energy));
    memcpy(state, trial, sizeof state);
    OK(path(l, length, state, n - half, u + half * m, state, force + half * m, tangent + half * m * m, energy + half));
    CHECK(same_results(l, r, n, force, tangent, energy, state));

    OK(init_state(l, length, pair));
    OK(init_state(l, length, pair + length));
    for (size_t i = 0; i < n; ++i) {
        double both[2 * COMPONENTS], forces[2 * COMPONENTS], tangents[2 * COMPONENTS * COMPONENTS], energies[2];
        for (size_t k = 0; k < m; ++k) {
            both[m + k] = u[i * m + k];
            both[k] = l->element != NULL && k + 1 == m ? both[m + k] : -both[m + k];
        }
        OK(batch(l, length, pair, both, pair, forces, tangents, energies));
        holds &= same(forces + m, r->force[i], m) && same(tangents + m * m, r->tangent[i], m * m) && energies[1] == r->energy[i];
        /* Mirror images, but for the direction of slip that rounding decides if the force does not change. */
        const double slip_force = l->element == NULL ? l->contact->slip_force
                                                     : l->element->friction_coefficient * l->element->normal_force;
        const double distance = l->element == NULL ? l->contact->slip_displacement : l->element->approach;
        if (m < COMPONENTS) {
            CHECK_NEAR(forces[0], -forces[m], 1e-14 * slip_force);
            CHECK_NEAR(energies[0], energies[1], 1e-14 * slip_force * distance);
        }
    }
    CHECK(holds && same(pair + length, r->state, used(l, r->state)));
}

/* --- A constant normal force --- */

typedef struct {
    mslip_parameters parameters;
    mslip_contact contact;
    mslip_element element;
} reference_contact;
static reference_contact contacts[MOST_CONTACTS];

static const reference_contact *contact_of(const table *t)
{
    return &contacts[(int)get(t, "contact")];
}

static void check_contacts(void)
{
    table t = { 0 };
    for (int i = 0; next_row(&t, "contacts"); ++i) {
        reference_contact *r = &contacts[i];
        CHECK(i < MOST_CONTACTS && get(&t, "contact") == i);
        r->parameters = line_of(&t, get(&t, "N"));
        OK(mslip_contact_init(&r->parameters, &r->contact));
        OK(mslip_contact_check(&r->contact));
        OK(mslip_element_init(&r->parameters, 1, MSLIP_INPUT_NORMAL_FORCE, &r->element));
        relative(&t, "E_star", r->contact.composite_modulus, 1e-15);
        relative(&t, "b", r->contact.half_width, TOLERANCE);
        relative(&t, "slip_force", r->contact.slip_force, DBL_EPSILON);
        relative(&t, "slip_displacement", r->contact.slip_displacement, TOLERANCE);
        relative(&t, "initial_stiffness", r->contact.initial_stiffness, TOLERANCE);
        relative(&t, "slip_energy", r->contact.slip_energy, TOLERANCE);
    }
}

/* Relative error of the stick half-width c due to four roundings of tau. From g(w_c) = (1-tau) g(w_b), with g' = 4 w psi and
   g <= 2 w^2 psi: dc/c = w dw/c^2 <= (w/c)^2 dtau/(2 (1-tau)). */
static double stick_uncertainty(const reference_contact *r, double force, double stick)
{
    const double a = r->parameters.flat_half_width, tau = fabs(force) / r->contact.slip_force;
    const double moving = stick > a ? (1.0 - a / stick) * (1.0 + a / stick) : 0.0;
    return tau < 1.0 ? 2.0 * DBL_EPSILON * tau / (1.0 - tau) * moving : 0.0;
}

static void check_monotonic(void)
{
    table t = { 0 }, inverse = { 0 }, energies = { 0 };
    while (next_row(&t, "monotonic")) {
        const reference_contact *r = contact_of(&t);
        const double force = get(&t, "T"), load = r->parameters.normal_force, stick = get(&t, "stick_half_width");
        const double uncertainty = stick_uncertainty(r, force, stick), compliance = get(&t, "compliance");
        /* The compliance is logarithmic in c. */
        const double unit = 2.0 / (PI * r->contact.composite_modulus * r->parameters.length) * uncertainty;
        double got[3], u;
        OK(mslip_monotonic_displacement(&r->contact, 1, &force, &got[0], &got[1], &got[2]));
        relative(&t, "displacement", got[0], TOLERANCE);
        relative(&t, "stick_half_width", got[2], TOLERANCE + uncertainty);
        compare(&t, "compliance", got[1], compliance, isinf(compliance) ? 0.0 : TOLERANCE * compliance + unit);
        OK(mslip_element_displacement(&r->element, 0, 1, &force, &load, &u, NULL));
        relative(&t, "displacement", u, TOLERANCE);
    }
    while (next_row(&inverse, "monotonic_inverse")) {
        const reference_contact *r = contact_of(&inverse);
        const double u = get(&inverse, "displacement");
        double force, by_sensitivity, sensitivity[MSLIP_PARAMETER_COUNT];
        OK(mslip_monotonic_force(&r->contact, 1, &u, &force, NULL, NULL));
        relative(&inverse, "T", force, TOLERANCE);
        OK(mslip_monotonic_sensitivity(&r->contact, 1, &u, &by_sensitivity, sensitivity));
        CHECK_RELATIVE(by_sensitivity, force, 1e-14);
    }
    while (next_row(&energies, "energy")) {
        const double force = get(&energies, "T");
        double energy;
        OK(mslip_dissipated_energy(&contact_of(&energies)->contact, 1, &force, &energy));
        relative(&energies, "dissipated_per_cycle", energy, TOLERANCE);
    }
}

/* K of one amplitude, of a table, and in a batch, where it has the bits of the first. */
static void check_complex_stiffness(void)
{
    static const char *const columns[] = { "k_real", "k_imag", "dk_real", "dk_imag" };
    static const int32_t index[2] = { 0, 0 };
    static double memory[2048];
    table t = { 0 };
    const size_t length = mslip_stiffness_table_length();
    CHECK(length <= sizeof memory / sizeof *memory);
    while (next_row(&t, "complex_stiffness")) {
        const mslip_contact *contact = &contact_of(&t)->contact;
        const double u = get(&t, "amplitude"), size = hypot(get(&t, "k_real"), get(&t, "k_imag")), twice[2] = { 2.0 * u, u };
        double got[2][4], both[4][2], slider[2], loop[2][8];
        OK(mslip_complex_stiffness(contact, 1, &u, &got[0][0], &got[0][1], &got[0][2], &got[0][3]));
        OK(mslip_stiffness_table_init(contact, length, memory));
        OK(mslip_complex_stiffness_tabulated(contact, memory, 1, &u, &got[1][0], &got[1][1], &got[1][2], &got[1][3]));
        OK(mslip_batch_complex_stiffness(2, 1, contact, index, NULL, twice, both[0], both[1], both[2], both[3]));
        /* The slipped length is a difference of two displacements: of a nearly flat contact it is all rounding. */
        const int slips = u >= contact->slip_displacement * (1.0 - 4.0 * DBL_EPSILON);
        const double slipped = slips ? 8.0 * DBL_EPSILON * contact->slip_force * contact->slip_displacement : 0.0;
        for (int k = 0; k < 4; ++k) {
            const double want = get(&t, columns[k]), own = fabs(want), rounding = k == 1 ? slipped / (PI * u * u) : 0.0;
            CHECK(isfinite(got[0][k]) && isfinite(got[1][k]) && both[k][1] == got[0][k]);
            /* At a jump the table has NaN, and the library one side. Errors of a derivative are relative to K over an amplitude. */
            if (!isnan(want)) {
                compare(&t, columns[k], got[0][k], want, k < 2 ? TOLERANCE * own + rounding : 10.0 * TOLERANCE * (size / u + own));
                compare(&t, columns[k], got[1][k], want, k < 2 ? TOLERANCE * size + rounding : TOLERANCE * (size / u + own));
            }
        }
        const double energy = get(&t, "dissipated_per_cycle");
        compare(&t, "dissipated_per_cycle", PI * got[0][1] * u * u, energy, 2.0 * TOLERANCE * energy + slipped);
        /* The spring-slider has the same K' and K''. Its angle is a root of rounding if it hardly slips, or slips all the time. */
        OK(mslip_jenkins_equivalent(contact, u, &slider[0], &slider[1]));
        const double cosine = 1.0 - 2.0 * slider[1] / (slider[0] * u);
        if (fabs(cosine) < 0.99) {
            const double theta = acos(cosine);
            CHECK_NEAR(slider[0] / PI * (theta - sin(theta) * cosine), got[0][0], 1e-11 * size);
            CHECK_NEAR(slider[0] / PI * sin(theta) * sin(theta), got[0][1], 1e-11 * size);
        }
        /* Masing: twice the monotonic force of half the displacement since the reversal. */
        OK(mslip_hysteresis_loop(contact, u, 8, loop[0], loop[1]));
        for (int i = 0; i < 4; ++i) {
            const double way = 0.5 * (u - loop[0][i]);
            double force;
            OK(mslip_monotonic_force(contact, 1, &way, &force, NULL, NULL));
            CHECK_NEAR(loop[0][i], u * cos(0.25 * PI * i), 4.0 * DBL_EPSILON * u);
            CHECK_NEAR(loop[1][i], loop[1][0] - 2.0 * force, TOLERANCE * loop[1][0]);
            CHECK_NEAR(loop[1][i + 4], -loop[1][i], TOLERANCE * loop[1][0]);
        }
    }
}

static void check_histories(void)
{
    static double u[MOST_STEPS], want[MOST_STEPS];
    static results r;
    static table t;
    const size_t length = mslip_state_length(64);
    double largest = 0.0, history = -1.0;
    size_t n = 0;
    law l = { NULL, NULL };
    for (int more = 1; more;) {
        more = next_row(&t, "histories");
        if (n > 0 && (!more || get(&t, "history") != history)) {
            run(&l, length, n, u, &r);
            for (size_t i = 0; i < n; ++i) {
                /* A force is a sum over reversals and has the rounding error of the largest term. */
                largest = fmax(i == 0 ? 0.0 : largest, fabs(want[i]));
                compare(&t, "T of the history above", r.force[i][0], want[i], 2.0 * TOLERANCE * largest);
            }
            n = 0;
        }
        CHECK(n < MOST_STEPS);
        if (more) {
            history = get(&t, "history");
            l.contact = &contact_of(&t)->contact;
            u[n] = get(&t, "displacement");
            want[n++] = get(&t, "T");
        }
    }
}

/* The harmonic force of a contact, in a batch and with its sensitivity, and of its element under a constant load. */
static void check_harmonic_force(void)
{
    enum { HARMONICS = 3, N = 2 * HARMONICS + 1 };
    static const int32_t index[2] = { 0, 0 };
    table t = { 0 };
    while (next_row(&t, "harmonic_force")) {
        const reference_contact *r = contact_of(&t);
        const size_t samples = (size_t)get(&t, "samples");
        const size_t length = mslip_harmonic_workspace_length(HARMONICS, samples, MSLIP_UNIFORM_SAMPLING);
        const size_t of_element = mslip_element_workspace_length(1, HARMONICS, samples, MSLIP_UNIFORM_SAMPLING);
        double *workspace = malloc(length * sizeof *workspace), *varying = malloc(of_element * sizeof *varying);
        double u[2 * N], v[4 * N] = { 0.0 }, want[N], force[N], sensitivity[N * MSLIP_PARAMETER_COUNT], energy[2], largest = 0.0;
        double both[2 * N], jacobian[N * N], jacobians[2 * N * N], forces[6 * N], drift[4];
        for (int i = 0; i < N; ++i) {
            char column[8];
            snprintf(column, sizeof column, "u%d", i);
            v[i] = v[2 * N + i] = u[N + i] = u[i] = get(&t, column);
            *column = 'f';
            want[i] = get(&t, column);
            largest = fmax(largest, fabs(want[i]));
        }
        v[N] = v[3 * N] = r->parameters.normal_force;
        OK(mslip_harmonic_workspace_init(HARMONICS, samples, MSLIP_UNIFORM_SAMPLING, length, workspace));
        OK(mslip_harmonic_force(&r->contact, workspace, u, force, jacobian, &energy[0]));
        OK(mslip_batch_harmonic_force(2, 1, &r->contact, index, NULL, workspace, u, both, jacobians, energy));
        CHECK(same(both + N, force, N) && same(jacobians + N * N, jacobian, N * N) && energy[0] == energy[1]);
        OK(mslip_harmonic_sensitivity(&r->contact, workspace, u, both, sensitivity));
        CHECK(same(both, force, N));
        OK(mslip_element_workspace_init(1, HARMONICS, samples, MSLIP_UNIFORM_SAMPLING, 2, of_element, varying));
        OK(mslip_element_harmonic_force(&r->element, varying, v, forces, NULL, NULL, drift));
        OK(mslip_batch_element_harmonic_force(2, 1, &r->element, index, NULL, varying, v, forces + 2 * N, NULL, energy, drift + 2));
        for (int i = 0; i < N; ++i) {
            compare(&t, "harmonic of the force", force[i], want[i], 2.0 * TOLERANCE * largest);
            compare(&t, "harmonic of the force of the element", forces[i], want[i], 1e-12 * largest);
            compare(&t, "normal force", forces[N + i], v[N + i], TOLERANCE * v[N]);
        }
        free(workspace);
        free(varying);
    }
}

/* Relative error, due to the rounding of x and of the edge, of a quantity that decreases to zero at the edge as a power of the
   distance. */
static double edge_uncertainty(double power, double x, double edge, double uncertainty)
{
    const double distance = fabs(edge - fabs(x)) / fmax(edge, DBL_MIN);
    return power * (uncertainty + 4.0 * DBL_EPSILON) / fmax(distance, DBL_EPSILON);
}

/* Tractions of a contact, of a history that leads to the force, and of its element; slip and damage. */
static void check_fields(void)
{
    static double state[STATE], own[STATE];
    table t = { 0 }, slip = { 0 };
    while (next_row(&t, "tractions")) {
        const reference_contact *r = contact_of(&t);
        const double force = get(&t, "T"), x = get(&t, "x"), pressure = get(&t, "pressure"), shear = get(&t, "shear");
        const double mu = r->parameters.friction_coefficient, limit = mu * pressure;
        double got[2], stick, u, step_to[2] = { 0.0, r->parameters.normal_force };
        OK(mslip_monotonic_displacement(&r->contact, 1, &force, &u, NULL, &stick));
        const double at_b = TOLERANCE + edge_uncertainty(0.5, x, r->contact.half_width, 0.0);
        /* The shear is the difference of mu p and, within the stick zone, of the same with its edge at c. */
        const double uncertainty = stick_uncertainty(r, force, stick), inner = fmax(0.0, limit - fabs(shear));
        const double allowed = at_b * limit + inner * edge_uncertainty(0.5, x, stick, uncertainty);
        OK(mslip_tractions(&r->contact, force, 1, &x, &got[0], &got[1]));
        relative(&t, "pressure", got[0], at_b);
        compare(&t, "shear", got[1], shear, allowed);
        OK(mslip_state_init(STATE, state));
        OK(mslip_masing_update(&r->contact, STATE, state, u, state, NULL, NULL, NULL));
        OK(mslip_masing_tractions(&r->contact, STATE, state, 1, &x, &got[0], &got[1]));
        relative(&t, "pressure", got[0], at_b);
        /* The stick zone follows from the displacement, which has the rounding of ten of T or so. */
        const double by_path = allowed + 10.0 * inner * edge_uncertainty(0.5, x, stick, uncertainty) + 1e-11 * limit;
        const int is_smooth = fabs(fabs(x) - stick) > 1e-6 * r->contact.half_width && fabs(force) < 0.999999 * r->contact.slip_force;
        if (is_smooth) compare(&t, "shear", got[1], shear, by_path);
        OK(mslip_element_state_init(1, STATE, own));
        OK(mslip_element_update(&r->element, STATE, own, step_to, own, NULL, NULL, NULL));
        step_to[0] = u;
        OK(mslip_element_update(&r->element, STATE, own, step_to, own, NULL, NULL, NULL));
        OK(mslip_element_tractions(&r->element, STATE, own, 1, &x, &got[0], &got[1]));
        if (is_smooth && at_b < 1e-11) compare(&t, "pressure", got[0], pressure, 1e-9 * pressure);
        if (is_smooth && at_b < 1e-11) compare(&t, "shear", got[1], shear, by_path + 1e-9 * limit);
    }
    while (next_row(&slip, "slip")) {
        const reference_contact *r = contact_of(&slip);
        const double force = get(&slip, "T"), x = get(&slip, "x");
        double got[2], stick;
        OK(mslip_monotonic_displacement(&r->contact, 1, &force, NULL, NULL, &stick));
        OK(mslip_slip(&r->contact, force, 1, &x, &got[0], &got[1]));
        /* Slip scales as the 3/2 to 5/2 power of the distance from the stick zone. */
        const double allowed = TOLERANCE + edge_uncertainty(2.5, x, stick, stick_uncertainty(r, force, stick));
        relative(&slip, "slip", got[0], allowed);
        relative(&slip, "damage", got[1], allowed + edge_uncertainty(0.5, x, r->contact.half_width, 0.0));
    }
}

static void check_elliptic(void)
{
    table t = { 0 };
    while (next_row(&t, "elliptic")) {
        const mslip_elliptic_parameters p = ellipse_of(&t, get(&t, "N"));
        const double force = get(&t, "T"), displacement = get(&t, "displacement");
        mslip_contact contact;
        double got;
        OK(mslip_contact_init_elliptic(&p, &contact));
        relative(&t, "initial_stiffness", contact.initial_stiffness, TOLERANCE);
        /* Near mu N the curve varies as (1-tau)^(2/3), which amplifies roundings of T and of mu N, five times in the energy. */
        const double remaining = fmax(0.0, 1.0 - force / contact.slip_force);
        const double rounding = pow(remaining + 2.0 * DBL_EPSILON, 2.0 / 3.0) - pow(remaining, 2.0 / 3.0);
        OK(mslip_monotonic_displacement(&contact, 1, &force, &got, NULL, NULL));
        relative(&t, "displacement", got, TOLERANCE + rounding);
        OK(mslip_monotonic_force(&contact, 1, &displacement, &got, NULL, NULL));
        relative(&t, "T", got, TOLERANCE);
        OK(mslip_dissipated_energy(&contact, 1, &force, &got));
        relative(&t, "dissipated_per_cycle", got, TOLERANCE + 5.0 * rounding);
    }
}

/* The strip of the boundary element tables: half-width 1, and mu N such that the unit of displacement, 2 mu P/(pi E*), is 1. */
static void init_strip(double aspect_ratio, double a, double nu, mslip_contact *contact)
{
    const double w = sqrt((1.0 - a) * (1.0 + a)), g = 2.0 * atan2(w, a) - 2.0 * a * w;
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
    OK(mslip_contact_init(&p, contact));
    CHECK_NEAR(contact->half_width, 1.0, TOLERANCE);
}

/* MSLIP_RIGID_STRIP against three-dimensional boundary elements, under the uniform pressure of the strip (variant i) and under the true
   one (ii), for which the law holds: within 0.3 % up to 0.98 mu N for L/2b >= 5 and nu = 0.3. The code CONTACT differs from the boundary
   elements by up to 0.14 %. */
static void check_strip(void)
{
    static const char *const levels[] = { "0.3", "0.6", "0.9", "0.98" };
    table t = { 0 }, code = { 0 };
    mslip_contact contact;
    while (next_row(&t, "strip_3d")) {
        const double nu = get(&t, "nu"), ratio = get(&t, "AR"), in_3d = get(&t, "C0_3D");
        const int is_uniform = strcmp(word(&t, "variant"), "i") == 0, holds = !is_uniform && nu == 0.3, stocky = ratio < 5.0;
        init_strip(ratio, get(&t, "a"), nu, &contact);
        /* The fitted constant of the law has three decimals, that of the table has more. */
        const double compliance = contact.slip_force / contact.initial_stiffness;
        compare(&t, "C0_closed", compliance, get(&t, "C0_closed"), 2e-4);
        if (is_uniform || holds) {
            compare(&t, "C0_3D", compliance, in_3d, (is_uniform ? 0.0025 : stocky ? 0.018 : 0.0045) * in_3d);
        }
        for (int i = 0; i < 4 && !is_uniform; ++i) {
            char by_law[32], by_elements[32];
            const double force = strtod(levels[i], NULL) * contact.slip_force;
            double displacement;
            snprintf(by_law, sizeof by_law, "dclosed_%s", levels[i]);
            snprintf(by_elements, sizeof by_elements, "d3D_%s", levels[i]);
            OK(mslip_monotonic_displacement(&contact, 1, &force, &displacement, NULL, NULL));
            compare(&t, by_law, displacement, get(&t, by_law), 2e-4);
            if (holds) relative(&t, by_elements, displacement, stocky ? 0.014 : 0.003);
        }
    }
    while (next_row(&code, "strip_3d_contact")) {
        if (strcmp(word(&code, "variant"), "ii") == 0 && get(&code, "nu") == 0.3) {
            init_strip(get(&code, "AR"), get(&code, "a"), 0.3, &contact);
            const double force = get(&code, "tau") * contact.slip_force;
            double displacement;
            OK(mslip_monotonic_displacement(&contact, 1, &force, &displacement, NULL, NULL));
            relative(&code, "delta_CONTACT", displacement, get(&code, "AR") < 5.0 ? 0.0154 : 0.0044);
        }
    }
}

/* --- A varying normal force --- */

/* Both directions of the normal law, by elements of both inputs and for three largest loads. */
static void check_normal_law(const char *name)
{
    static const double factors[] = { 1.0, 1e6, 1e-3 };
    static mslip_element element;
    table t = { 0 };
    while (next_row(&t, name)) {
        const double force = get(&t, "N"), approach = get(&t, "u_n"), stiffness = get(&t, "dN_dun"), size = get(&t, "size");
        const double slope = has(&t, "c_n") ? 1e-12 : 1e-13; /* the singularities of a layer are closer to the pieces of the tables */
        for (int k = 0; k < 6; ++k) {
            double got[3];
            init_element(&t, factors[k / 2] * force, 1, MSLIP_INPUT_APPROACH + k % 2, &element);
            OK(mslip_normal_force(&element, 1, &approach, &got[0], &got[1], &got[2]));
            compare(&t, "N", got[0], force, 1e-14 * force);
            compare(&t, "dN_dun", got[1], stiffness, slope * stiffness);
            compare(&t, "size", got[2], size, 1e-14 * size);
            OK(mslip_normal_approach(&element, 1, &force, &got[0], &got[1], &got[2]));
            compare(&t, "u_n", got[0], approach, 1e-14 * approach);
            compare(&t, "1/dN_dun", got[1], 1.0 / stiffness, slope / stiffness);
            compare(&t, "size", got[2], size, 1e-14 * size);
        }
    }
}

enum { MOST_ROWS = 128, VALUES = 8 };
static const char *const columns[VALUES] = { "delta", "u_n", "N", "T", "dissipated", "dT_ddelta", "dT_dun", "dN_dun" };
enum { DELTA, APPROACH, LOAD, FORCE, ENERGY, BY_DELTA, BY_APPROACH, STIFFNESS };

/* A history whose first row is the present one of a table: with this normal input and the tables of a multiple of its largest load.
   Differences in units of mu N_max, N_max, mu N_max u_max, and of the stiffnesses at the largest load. */
static void check_history(const table *t, size_t steps, double rows[][VALUES], int32_t normal_input, double factor, int is_rounded)
{
    static mslip_element element, at_largest;
    static double u[2 * MOST_ROWS];
    static results r;
    const int by_force = normal_input == MSLIP_INPUT_NORMAL_FORCE;
    const double mu = get(t, "mu"), energy_tolerance = is_rounded || has(t, "c_n") ? 1e-12 : 1e-13;
    const double tolerance = is_rounded ? 1e-13 : 1e-14;
    double largest = 0.0, farthest = 0.0;
    for (size_t i = 0; i < steps; ++i) {
        largest = fmax(largest, rows[i][LOAD]);
        farthest = fmax(farthest, fabs(rows[i][DELTA]));
        u[2 * i] = rows[i][DELTA];
        u[2 * i + 1] = rows[i][by_force ? LOAD : APPROACH];
    }
    init_element(t, factor * largest, 1, normal_input, &element);
    init_element(t, largest, 1, normal_input, &at_largest);
    const law l = { NULL, &element };
    run(&l, mslip_element_state_length(1, 64), steps, u, &r);
    for (size_t i = 0; i < steps; ++i) {
        const double *v = rows[i], slip_force = mu * largest, by_approach = by_force ? v[STIFFNESS] : 1.0;
        const table at = { .name = t->name, .line = t->line + (int)i };
        compare(&at, "T", r.force[i][0], v[FORCE], tolerance * slip_force);
        compare(&at, "N", r.force[i][1], v[LOAD], tolerance * largest);
        compare(&at, "dissipated", r.energy[i], v[ENERGY], energy_tolerance * slip_force * farthest);
        CHECK(r.energy[i] >= 0.0 && fabs(r.force[i][0]) <= mu * r.force[i][1] * (1.0 + 4.0 * DBL_EPSILON));
        CHECK(r.tangent[i][1] == 0.0 && isfinite(r.tangent[i][0]) && isfinite(r.tangent[i][2]));
        if (!isnan(v[BY_DELTA])) { /* not at corners */
            compare(&at, "dT_ddelta", r.tangent[i][0], v[BY_DELTA], 1e-11 * at_largest.tangential_stiffness);
        }
        if (!isnan(v[BY_APPROACH])) {
            compare(&at, "dT_dun", r.tangent[i][2] * by_approach, v[BY_APPROACH], 1e-11 * mu * at_largest.normal_stiffness);
        }
        compare(&at, "dN_dun", r.tangent[i][3] * by_approach, v[STIFFNESS], 1e-11 * at_largest.normal_stiffness);
    }
}

static void check_varying_load(const char *name)
{
    static double rows[MOST_ROWS][VALUES];
    static table t, first;
    double history = 0.0;
    int opens = 0, histories = 0;
    size_t steps = 0;
    memset(&t, 0, sizeof t);
    for (int more = 1; more;) {
        more = next_row(&t, name);
        if (steps > 0 && (!more || get(&t, "history") != history)) {
            const int by_force = strcmp(word(&first, "control"), "N") == 0;
            const int32_t given = MSLIP_INPUT_APPROACH + by_force;
            /* Tables for a million times this load, or as large as the length and N_c allow, and for a thousandth. */
            check_history(&first, steps, rows, given, 1.0, 0);
            check_history(&first, steps, rows, given, 1e6, 0);
            check_history(&first, steps, rows, given, 1e-3, 0);
            /* The other input is rounded. */
            if (!opens) check_history(&first, steps, rows, MSLIP_INPUT_NORMAL_FORCE - by_force, 1.0, 1);
            ++histories;
            steps = 0;
        }
        CHECK(steps < MOST_ROWS);
        if (more) {
            if (steps == 0) {
                first = t;
                for (int i = 0; i < t.columns; ++i) {
                    first.cell[i] = first.text + (t.cell[i] - t.text);
                    first.column[i] = first.header + (t.column[i] - t.header);
                }
                opens = 0;
                history = get(&t, "history");
            }
            for (int i = 0; i < VALUES; ++i) {
                rows[steps][i] = get(&t, columns[i]);
            }
            opens |= rows[steps++][LOAD] <= 0.0;
        }
    }
    CHECK(histories == 60);
}

/* Two directions along motions of every contact: Coulomb's law and the normal law hold, and far in gross slip the force has the direction
   of slip. The displacement under a static force carries that force. Values are compared by `verification/validation`. */
static void check_two_directions(void)
{
    enum { STEPS = 10 };
    /* A first contact off the centre, microslip, reversals, gross slip in two directions, separation. */
    static const double motion[STEPS][3] = {
        { 0.05, -0.02, 0.0 }, { 0.1, 0.02, 0.4 }, { 0.3, -0.1, 0.7 }, { 0.1, -0.2, 0.9 }, { 0.2, -0.2, 0.9 },
        { 20.0, 15.0, 0.6 },  { 19.0, 16.0, 0.8 }, { 0.0, 0.0, 0.0 },  { -0.2, 0.1, 0.5 }, { -0.2, 0.1, 0.5 },
    };
    static mslip_element element;
    static results r;
    table t = { 0 };
    while (next_row(&t, "contacts")) {
        for (int32_t input = MSLIP_INPUT_APPROACH; input <= MSLIP_INPUT_NORMAL_FORCE; ++input) {
            const mslip_parameters p = contact_of(&t)->parameters;
            const double slip_force = contact_of(&t)->contact.slip_force, mu = p.friction_coefficient;
            const law l = { NULL, &element };
            double u[3 * STEPS];
            /* Springs along y have the stiffness of a longer strip only. */
            if (mslip_element_init(&p, 2, input, &element) == MSLIP_LENGTH_TOO_SHORT) continue;
            const double whole = input == MSLIP_INPUT_NORMAL_FORCE ? p.normal_force : element.approach;
            for (int i = 0; i < 3 * STEPS; ++i) {
                u[i] = motion[i / 3][i % 3] * (i % 3 == 2 ? whole : slip_force / element.tangential_stiffness);
            }
            run(&l, mslip_element_state_length(2, 0), STEPS, u, &r);
            for (int i = 0; i < STEPS; ++i) {
                const double *force = r.force[i], *tangent = r.tangent[i], w = u[3 * i + 2];
                double normal[2] = { w, w > 0.0 };
                if (input == MSLIP_INPUT_APPROACH) OK(mslip_normal_force(&element, 1, &w, &normal[0], &normal[1], NULL));
                CHECK(hypot(force[0], force[1]) <= mu * force[2] * (1.0 + 1e-12) && r.energy[i] >= 0.0);
                CHECK(force[2] == normal[0] && (w == 0.0 || tangent[8] == normal[1]) && tangent[2] == 0.0 && tangent[5] == 0.0);
                CHECK(force[2] > 0.0 || (force[0] == 0.0 && force[1] == 0.0));
            }
            CHECK_NEAR(r.force[5][0], 0.8 * mu * r.force[5][2], 0.02 * slip_force);
            CHECK_NEAR(r.force[5][1], 0.6 * mu * r.force[5][2], 0.02 * slip_force);
            for (int32_t direction = 0; direction < 2; ++direction) {
                static double state[STATE];
                double step_to[3] = { 0.0, 0.0, whole }, force = 0.4 * slip_force, displacement, found[3];
                OK(mslip_element_displacement(&element, direction, 1, &force, &p.normal_force, &displacement, NULL));
                OK(mslip_element_state_init(2, STATE, state));
                OK(mslip_element_update(&element, STATE, state, step_to, state, NULL, NULL, NULL));
                step_to[direction] = displacement;
                OK(mslip_element_update(&element, STATE, state, step_to, state, found, NULL, NULL));
                /* The law of two directions has the curve of its springs. */
                CHECK_RELATIVE(found[direction], force, 2e-5);
            }
        }
    }
}

/* --- Limits --- */

/* Both ends of the monotonic curve, by force and by displacement: at the onset of gross slip the stick zone is the flat, beyond it has no
   width; a force above mu N by a rounding error counts as mu N. Twelve spring-sliders have the reported error. */
static void check_ends_of_the_curve(void)
{
    enum { SLIDERS = 12, POINTS = 4001 };
    table t = { 0 };
    while (next_row(&t, "contacts")) {
        const reference_contact *r = contact_of(&t);
        const mslip_contact *contact = &r->contact;
        const double a = r->parameters.flat_half_width, slip = contact->slip_displacement, mu_n = contact->slip_force, zero = 0.0;
        const double forces[2] = { mu_n, -mu_n * (1.0 + 2.0 * DBL_EPSILON) };
        const double displacements[3] = { slip, -nextafter(slip, INFINITY), 2.0 * slip };
        double u[2], c[3], force[3], stiffness[3], k[SLIDERS], limit[SLIDERS], error, worst = 0.0;
        OK(mslip_monotonic_displacement(contact, 2, forces, u, NULL, c));
        CHECK(u[0] == slip && u[1] == -slip);
        CHECK_RELATIVE(c[0], a, 2.0 * DBL_EPSILON);
        CHECK_RELATIVE(c[1], a, 2.0 * DBL_EPSILON);
        OK(mslip_monotonic_force(contact, 3, displacements, force, stiffness, c));
        CHECK(force[0] == mu_n && force[1] == -mu_n && force[2] == mu_n && c[1] == 0.0 && c[2] == 0.0);
        CHECK(is_near(c[0], a, 2.0 * DBL_EPSILON * a) && stiffness[1] == 0.0 && stiffness[2] == 0.0);
        OK(mslip_monotonic_force(contact, 1, &zero, force, stiffness, c));
        CHECK(force[0] == 0.0 && stiffness[0] == contact->initial_stiffness && c[0] == contact->half_width);
        OK(mslip_iwan_equivalent(contact, SLIDERS, k, limit, &error));
        for (int i = 0; i < POINTS; ++i) {
            const double displacement = 1.2 * slip * i / (POINTS - 1);
            double exact, sum = 0.0;
            OK(mslip_monotonic_force(contact, 1, &displacement, &exact, NULL, NULL));
            for (int j = 0; j < SLIDERS; ++j) {
                sum += fmin(k[j] * displacement, limit[j]);
            }
            worst = fmax(worst, fabs(sum - exact) / mu_n);
        }
        CHECK(worst <= error * (1.0 + 1e-9) + 1e-14 && (worst >= 0.9 * error || error < 1e-12));
    }
}

/* Without friction or normal force a contact and an element have no tangential force. */
static void check_no_tangential_force(void)
{
    static double state[STATE];
    for (int open = 0; open < 2; ++open) {
        mslip_parameters p = contacts[3].parameters;
        mslip_contact contact;
        mslip_element element;
        double force[2], tangent[4], energy, k[4], u = 1e-7, step_to[2] = { 1e-7, 50.0 };
        *(open ? &p.normal_force : &p.friction_coefficient) = 0.0;
        OK(mslip_contact_init(&p, &contact));
        OK(mslip_complex_stiffness(&contact, 1, &u, &k[0], &k[1], &k[2], &k[3]));
        CHECK(contact.slip_force == 0.0 && k[0] == 0.0 && k[1] == 0.0 && k[2] == 0.0 && k[3] == 0.0);
        OK(mslip_state_init(STATE, state));
        OK(mslip_masing_update(&contact, STATE, state, u, state, force, tangent, &energy));
        CHECK(force[0] == 0.0 && tangent[0] == 0.0 && energy == 0.0);
        CHECK(mslip_monotonic_displacement(&contact, 1, &u, force, NULL, NULL) == MSLIP_FORCE_EXCEEDS_SLIP);
        p.normal_force = contacts[3].parameters.normal_force;
        OK(mslip_element_init(&p, 1, MSLIP_INPUT_NORMAL_FORCE, &element));
        step_to[1] = open ? 0.0 : 50.0;
        OK(mslip_element_state_init(1, STATE, state));
        OK(mslip_element_update(&element, STATE, state, step_to, state, force, tangent, &energy));
        CHECK(force[0] == 0.0 && force[1] == step_to[1] && tangent[0] == 0.0 && tangent[2] == 0.0 && energy == 0.0);
    }
}

int main(int argc, char **argv)
{
    const int argument = check_arguments(argc, argv);
    char version[64];
    directory = argument < argc ? argv[argument] : directory;
    snprintf(version, sizeof version, "%d.%d.%d", MSLIP_VERSION_MAJOR, MSLIP_VERSION_MINOR, MSLIP_VERSION_PATCH);
    CHECK(strcmp(mslip_version(), version) == 0 && mslip_abi_version() == MSLIP_ABI_VERSION);
    check_contacts();
    check_monotonic();
    check_complex_stiffness();
    check_histories();
    check_harmonic_force();
    check_fields();
    check_elliptic();
    check_strip();
    check_normal_law("normal_law");
    check_normal_law("layer_normal_law");
    check_varying_load("varying_load");
    check_varying_load("layer_varying_load");
    check_two_directions();
    check_ends_of_the_curve();
    check_no_tangential_force();
    return check_report();
}
