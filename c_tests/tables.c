/* The installed archive against the reference tables of contacts and of their histories: each step by step, as a path, and in a batch,
 * with the same bits. Inputs of the tables are doubles, so that a difference is an error of the library. Then motions in two directions,
 * the ends of the curves, and contacts without a tangential force. The other tables are read in Python, and the values of all functions
 * are compared with multi-precision by `verification/verify`.
 *
 *     tables [--trap] [DIRECTORY] */
#include "check.h"

#include <microslip.h>
#include <float.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

enum { MOST_STEPS = 512, STATE = 2000, COMPONENTS = 3, MOST_CONTACTS = 64 };
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

static double get(const table *t, const char *column)
{
    return strtod(word(t, column), NULL);
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

static mslip_parameters line_of(const table *t, double normal_force)
{
    mslip_parameters p;
    mslip_parameters_default(&p);
    p.flat_half_width = get(t, "a");
    p.edge_radius = get(t, "R");
    p.length = get(t, "L");
    p.normal_force = normal_force;
    p.friction_coefficient = get(t, "mu");
    p.displacement_reference = MSLIP_CENTRE_POINT;
    for (int i = 0; i < 2; ++i) {
        p.material[i].young_modulus = get(t, i == 0 ? "E1" : "E2");
        p.material[i].poisson_ratio = get(t, i == 0 ? "nu1" : "nu2");
    }
    return p;
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
               ? mslip_batch_masing_update(2, 1, l->contact, index, NULL, length, from, u, to, force, tangent, energy, NULL)
               : mslip_batch_element_update(2, 1, l->element, index, NULL, length, from, u, to, force, tangent, energy, NULL);
}

/* The results of a history. */
typedef struct {
    double force[MOST_STEPS][COMPONENTS], tangent[MOST_STEPS][COMPONENTS * COMPONENTS], energy[MOST_STEPS], state[STATE];
} results;

static int same(const double *p, const double *q, size_t n)
{
    return memcmp(p, q, n * sizeof *p) == 0;
}

/* The doubles of a state in use: the number of reversals or pieces is the second one; the springs of two directions fill theirs. */
static size_t used(const law *l, const double *state)
{
    if (l->element != NULL && l->element->directions == 2) {
        return mslip_element_state_length(2, 0);
    }
    const size_t count = (size_t)state[1];
    return l->element == NULL ? 6 + 3 * count : 9 + 4 * (count + 1);
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

/* Step by step, each with a new state; then in place, discarded, as a path in one part and in two, the second one to a new state, and in
   a batch with the mirrored motion: the same bits. */
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

    OK(init_state(l, length, state));
    OK(path(l, length, state, n, u, state, force, tangent, energy));
    CHECK(same_results(l, r, n, force, tangent, energy, state));
    /* The state is stored in between. */
    memset(force, 0xff, sizeof force);
    OK(init_state(l, length, trial));
    OK(path(l, length, trial, half, u, trial, force, tangent, energy));
    for (int discarded = 0; discarded < 2; ++discarded) {
        memset(state, 0xff, sizeof state);
        OK(path(l, length, trial, n - half, u + half * m, discarded ? NULL : state, force + half * m, tangent + half * m * m,
                energy + half));
        CHECK(same_results(l, r, n, force, tangent, energy, discarded ? NULL : state));
    }

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
        relative(&t, "E_star", r->contact.composite_modulus, 1e-15);
        relative(&t, "b", r->contact.half_width, TOLERANCE);
        relative(&t, "slip_force", r->contact.slip_force, DBL_EPSILON);
        relative(&t, "slip_displacement", r->contact.slip_displacement, TOLERANCE);
        relative(&t, "initial_stiffness", r->contact.initial_stiffness, TOLERANCE);
        relative(&t, "slip_energy", r->contact.slip_energy, TOLERANCE);
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
            /* With a state that merges reversals first. */
            run(&l, mslip_state_length(5), n, u, &r);
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

/* --- A varying normal force --- */

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
                /* The law of two directions has the curve of its springs: 18 chords of equal errors, 1 / (8 18^2) of mu N. */
                CHECK_NEAR(found[direction], force, 4e-4 * slip_force);
            }
        }
    }
}

/* --- Limits --- */

/* Both ends of the monotonic curve, by force and by displacement: at the onset of gross slip the stick zone is the flat, beyond it has no
   width; a force above mu N by a rounding error counts as mu N. */
static void check_ends_of_the_curve(void)
{
    table t = { 0 };
    while (next_row(&t, "contacts")) {
        const reference_contact *r = contact_of(&t);
        const mslip_contact *contact = &r->contact;
        const double a = r->parameters.flat_half_width, slip = contact->slip_displacement, mu_n = contact->slip_force, zero = 0.0;
        const double forces[2] = { mu_n, -mu_n * (1.0 + 2.0 * DBL_EPSILON) };
        const double displacements[3] = { slip, -nextafter(slip, INFINITY), 2.0 * slip };
        double u[2], c[3], force[3], stiffness[3];
        OK(mslip_monotonic_displacement(contact, 2, forces, u, NULL, c));
        CHECK(u[0] == slip && u[1] == -slip);
        CHECK_RELATIVE(c[0], a, 2.0 * DBL_EPSILON);
        CHECK_RELATIVE(c[1], a, 2.0 * DBL_EPSILON);
        OK(mslip_monotonic_force(contact, 3, displacements, force, stiffness, c));
        CHECK(force[0] == mu_n && force[1] == -mu_n && force[2] == mu_n && c[1] == 0.0 && c[2] == 0.0);
        CHECK(is_near(c[0], a, 2.0 * DBL_EPSILON * a) && stiffness[1] == 0.0 && stiffness[2] == 0.0);
        OK(mslip_monotonic_force(contact, 1, &zero, force, stiffness, c));
        CHECK(force[0] == 0.0 && stiffness[0] == contact->initial_stiffness && c[0] == contact->half_width);
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
    check_histories();
    check_two_directions();
    check_ends_of_the_curve();
    check_no_tangential_force();
    return check_report();
}
