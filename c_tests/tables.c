/* The installed archive against the reference tables of contacts and of their histories: each step by step, as a path, and in a batch, with
 * the same bits. Inputs of the tables are doubles, so that a difference is an error of the library. What the library calculates otherwise
 * is compared with multi-precision by `verification/verify`, in Rust.
 *
 *     tables [--trap] [DIRECTORY] */
#include "check.h"

#include <microslip.h>
#include <float.h>
#include <stdint.h>
#include <stdlib.h>

enum { MOST_STEPS = 512, STATE = 198, MOST_CONTACTS = 64 };
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

static mslip_parameters parameters_of(const table *t)
{
    mslip_parameters p;
    mslip_parameters_default(&p);
    p.flat_half_width = get(t, "a");
    p.edge_radius = get(t, "R");
    p.length = get(t, "L");
    p.normal_force = get(t, "N");
    p.friction_coefficient = get(t, "mu");
    p.displacement_reference = MSLIP_CENTRE_POINT;
    for (int i = 0; i < 2; ++i) {
        p.material[i].young_modulus = get(t, i == 0 ? "E1" : "E2");
        p.material[i].poisson_ratio = get(t, i == 0 ? "nu1" : "nu2");
    }
    return p;
}

static mslip_contact contacts[MOST_CONTACTS];

static void check_contacts(void)
{
    table t = { 0 };
    for (int i = 0; next_row(&t, "contacts"); ++i) {
        mslip_contact *c = &contacts[i];
        const mslip_parameters p = parameters_of(&t);
        CHECK(i < MOST_CONTACTS && get(&t, "contact") == i);
        OK(mslip_contact_init(&p, c));
        OK(mslip_contact_check(c));
        relative(&t, "E_star", c->composite_modulus, 1e-15);
        relative(&t, "b", c->half_width, TOLERANCE);
        relative(&t, "slip_force", c->slip_force, DBL_EPSILON);
        relative(&t, "slip_displacement", c->slip_displacement, TOLERANCE);
        relative(&t, "initial_stiffness", c->initial_stiffness, TOLERANCE);
        relative(&t, "slip_energy", c->slip_energy, TOLERANCE);
    }
}

/* --- Histories --- */

typedef struct {
    double force[MOST_STEPS], stiffness[MOST_STEPS], energy[MOST_STEPS], state[STATE];
} results;

static int same(const results *p, const results *q, size_t n)
{
    const size_t bytes = n * sizeof(double), used = 6 + 3 * (size_t)p->state[1];
    return !memcmp(p->force, q->force, bytes) && !memcmp(p->stiffness, q->stiffness, bytes) && !memcmp(p->energy, q->energy, bytes)
        && !memcmp(p->state, q->state, used * sizeof(double));
}

/* Step by step, each with a new state; as a path in place; in a batch, beside another contact: the same bits. */
static void run(const mslip_contact *c, size_t n, const double *u, results *r)
{
    static results other;
    static double states[2][STATE], pair[2 * STATE];
    mslip_contact both[2];
    both[0] = contacts[0];
    both[1] = *c;
    OK(mslip_state_init(STATE, states[0]));
    for (size_t i = 0; i < n; ++i) {
        OK(mslip_masing_update(c, STATE, states[i % 2], u[i], states[1 - i % 2], &r->force[i], &r->stiffness[i], &r->energy[i]));
    }
    memcpy(r->state, states[n % 2], sizeof r->state);

    OK(mslip_state_init(STATE, other.state));
    OK(mslip_masing_path(c, STATE, other.state, n, u, other.state, other.force, other.stiffness, other.energy));
    CHECK(same(r, &other, n));

    memset(&other, 0xff, sizeof other);
    OK(mslip_state_init(STATE, pair));
    OK(mslip_state_init(STATE, pair + STATE));
    for (size_t i = 0; i < n; ++i) {
        double to[2] = { 0.0, 0.0 }, force[2], stiffness[2], energy[2];
        to[1] = u[i];
        OK(mslip_batch_masing_update(2, 2, both, NULL, NULL, STATE, pair, to, pair, force, stiffness, energy, NULL));
        CHECK(force[0] == 0.0);
        other.force[i] = force[1];
        other.stiffness[i] = stiffness[1];
        other.energy[i] = energy[1];
    }
    memcpy(other.state, pair + STATE, sizeof other.state);
    CHECK(same(r, &other, n));
}

static void check_histories(void)
{
    static double u[MOST_STEPS], want[MOST_STEPS];
    static results r;
    static table t;
    double largest = 0.0, history = -1.0;
    size_t n = 0;
    const mslip_contact *contact = NULL;
    for (int more = 1; more;) {
        more = next_row(&t, "histories");
        if (n > 0 && (!more || get(&t, "history") != history)) {
            run(contact, n, u, &r);
            for (size_t i = 0; i < n; ++i) {
                /* A force is a sum over reversals and has the rounding error of the largest term. */
                largest = fmax(i == 0 ? 0.0 : largest, fabs(want[i]));
                compare(&t, "T of the history above", r.force[i], want[i], 2.0 * TOLERANCE * largest);
            }
            n = 0;
        }
        CHECK(n < MOST_STEPS);
        if (more) {
            history = get(&t, "history");
            contact = &contacts[(int)get(&t, "contact")];
            u[n] = get(&t, "displacement");
            want[n++] = get(&t, "T");
        }
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
    return check_report();
}
