/* The installed archive against the reference tables of contacts and of their histories: each step by step, as a path, and in a batch, with
 * the same bits. Inputs of the tables are doubles, so that a difference is an error of the library. What the library calculates otherwise
 * is compared with multi-precision by `verification/verify`, in Rust.
 *
 *     tables [--trap] [DIRECTORY] */
#include "check.h"

#include <microslip.h>
#include <float.h>
#include <stdlib.h>

enum { STATE = 198, MOST_CONTACTS = 64, PARAMETERS = 9, FIELDS = 6 };
/* Relative errors of a constant load. */
#define TOLERANCE 1e-13
#define OK(call) CHECK((call) == MSLIP_OK)

/* --- Tables --- */

static const char *directory = "tests/golden";

/* A table of numbers with these columns, at its first row. */
static FILE *open_table(const char *name, const char *columns)
{
    char path[4096], header[1024];
    snprintf(path, sizeof path, "%s/%s.csv", directory, name);
    FILE *file = fopen(path, "r");
    if (file == NULL || fgets(header, sizeof header, file) == NULL || strncmp(header, columns, strlen(columns)) != 0) {
        fprintf(stderr, "%s cannot be read\n", path);
        exit(2);
    }
    return file;
}

/* Reads the next row; 0 at the end. */
static int next_row(FILE *file, double *row, int columns)
{
    int found = 0;
    while (found < columns && fscanf(file, "%lf%*c", &row[found]) == 1) {
        ++found;
    }
    CHECK(found == columns || (found == 0 && feof(file)));
    return found == columns;
}

static mslip_contact contacts[MOST_CONTACTS];

/* Parameters and results are in the order of the fields of their structures. */
static void check_contacts(void)
{
    static const double tolerance[FIELDS] = { 1e-15, TOLERANCE, DBL_EPSILON, TOLERANCE, TOLERANCE, TOLERANCE };
    double row[1 + PARAMETERS + FIELDS] = { 0 }, found[FIELDS];
    FILE *table = open_table("contacts", "contact,a,R,L,N,mu,E1,nu1,E2,nu2,"
                                         "E_star,b,slip_force,slip_displacement,initial_stiffness,slip_energy");
    for (int i = 0; next_row(table, row, 1 + PARAMETERS + FIELDS); ++i) {
        mslip_parameters p;
        mslip_parameters_default(&p);
        p.displacement_reference = MSLIP_CENTRE_POINT;
        memcpy(&p, row + 1, PARAMETERS * sizeof(double));
        CHECK(i < MOST_CONTACTS && row[0] == i);
        OK(mslip_contact_init(&p, &contacts[i]));
        OK(mslip_contact_check(&contacts[i]));
        memcpy(found, &contacts[i], sizeof found);
        for (int k = 0; k < FIELDS; ++k) {
            const double want = row[1 + PARAMETERS + k];
            check_near(found[k], want, tolerance[k] * fabs(want), "contacts", i + 2, "a field");
        }
    }
    CHECK(row[0] > 0.0);
    fclose(table);
}

/* --- Histories --- */

/* Each step with a new state, as a path in place, and in a batch beside another contact: the same bits. */
static void check_histories(void)
{
    static double state[2][STATE], path[STATE], pair[2 * STATE];
    FILE *table = open_table("histories", "history,contact,displacement,T");
    double largest = 0.0, history = -1.0, row[4] = { 0 };
    for (int i = 0; next_row(table, row, 4); ++i) {
        const double u = row[2], want = row[3], to[2] = { 0.0, u };
        const mslip_contact both[2] = { contacts[0], contacts[(int)row[1]] };
        double *old = state[i % 2], *new = state[1 - i % 2], one[3], other[3], force[2], stiffness[2], energy[2];
        if (row[0] != history) {
            history = row[0];
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
        check_near(one[0], want, 2.0 * TOLERANCE * largest, "histories", i + 2, "T");
    }
    CHECK(history > 0.0);
    fclose(table);
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
