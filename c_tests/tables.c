/* The installed archive against the reference tables of contacts and of their histories: each step by step, as a path, and in a batch, with
 * the same bits. Inputs of the tables are doubles, so that a difference is an error of the library. What the library calculates otherwise
 * is compared with multi-precision by `verification/verify`, in Rust.
 *
 *     tables [--trap] [DIRECTORY] */
#include "check.h"

#include <microslip.h>
#include <float.h>
#include <stdlib.h>

enum { STATE = 198, MOST_CONTACTS = 64 };
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

/* Each step with a new state, as a path in place, and in a batch beside another contact: the same bits. */
static void check_histories(void)
{
    static double state[2][STATE], path[STATE], pair[2 * STATE];
    table t = { 0 };
    double largest = 0.0, history = -1.0;
    for (int i = 0; next_row(&t, "histories"); ++i) {
        const double u = get(&t, "displacement"), want = get(&t, "T"), to[2] = { 0.0, u };
        const mslip_contact both[2] = { contacts[0], contacts[(int)get(&t, "contact")] };
        double *old = state[i % 2], *new = state[1 - i % 2], one[3], other[3], force[2], stiffness[2], energy[2];
        if (get(&t, "history") != history) {
            history = get(&t, "history");
            largest = 0.0;
            OK(mslip_state_init(STATE, old));
            OK(mslip_state_init(STATE, path));
            OK(mslip_state_init(STATE, pair));
            OK(mslip_state_init(STATE, pair + STATE));
        }
        OK(mslip_masing_update(&both[1], STATE, old, u, new, &one[0], &one[1], &one[2]));
        OK(mslip_masing_path(&both[1], STATE, path, 1, &u, path, &other[0], &other[1], &other[2]));
        OK(mslip_batch_masing_update(2, 2, both, NULL, NULL, STATE, pair, to, pair, force, stiffness, energy, NULL));
        CHECK(memcmp(one, other, sizeof one) == 0 && one[0] == force[1] && one[1] == stiffness[1] && one[2] == energy[1]);
        const size_t used = (6 + 3 * (size_t)new[1]) * sizeof(double);
        CHECK(force[0] == 0.0 && memcmp(new, path, used) == 0 && memcmp(new, pair + STATE, used) == 0);
        /* A force is a sum over reversals and has the rounding error of the largest term. */
        largest = fmax(largest, fabs(want));
        compare(&t, "T", one[0], want, 2.0 * TOLERANCE * largest);
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
