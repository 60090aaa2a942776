/* Every parameter of a contact with every kind of invalid value: its own status, and nothing modified. */
#include "rejection.h"

/* The parameters of both kinds of contact as arrays of doubles, and their names. */
enum { FLAT, ELLIPTIC, KINDS, MAX_FIELDS = 9 };

typedef struct {
    const char *name;
    int32_t status;
    int zero_is_allowed;
    double largest; /* valid value */
} field;

static const struct {
    const char *function;
    size_t bytes;
    int fields;
    field field[MAX_FIELDS];
} kinds[KINDS] = {
    { "mslip_contact_init", sizeof(mslip_parameters), 9,
      { { "flat_half_width", MSLIP_BAD_FLAT_HALF_WIDTH, 1, DBL_MAX },
        { "edge_radius", MSLIP_BAD_EDGE_RADIUS, 0, DBL_MAX },
        { "length", MSLIP_BAD_LENGTH, 0, DBL_MAX },
        { "normal_force", MSLIP_BAD_NORMAL_FORCE, 1, DBL_MAX },
        { "friction_coefficient", MSLIP_BAD_FRICTION_COEFFICIENT, 1, DBL_MAX },
        { "material[0].young_modulus", MSLIP_BAD_YOUNG_MODULUS, 0, DBL_MAX },
        { "material[0].poisson_ratio", MSLIP_BAD_POISSON_RATIO, 1, 0.5 },
        { "material[1].young_modulus", MSLIP_BAD_YOUNG_MODULUS, 0, DBL_MAX },
        { "material[1].poisson_ratio", MSLIP_BAD_POISSON_RATIO, 1, 0.5 } } },
    { "mslip_contact_init_elliptic", sizeof(mslip_elliptic_parameters), 8,
      { { "semi_axis_x", MSLIP_BAD_SEMI_AXIS_X, 0, DBL_MAX },
        { "semi_axis_y", MSLIP_BAD_SEMI_AXIS_Y, 0, DBL_MAX },
        { "normal_force", MSLIP_BAD_NORMAL_FORCE, 1, DBL_MAX },
        { "friction_coefficient", MSLIP_BAD_FRICTION_COEFFICIENT, 1, DBL_MAX },
        { "material[0].young_modulus", MSLIP_BAD_YOUNG_MODULUS, 0, DBL_MAX },
        { "material[0].poisson_ratio", MSLIP_BAD_POISSON_RATIO, 1, 0.5 },
        { "material[1].young_modulus", MSLIP_BAD_YOUNG_MODULUS, 0, DBL_MAX },
        { "material[1].poisson_ratio", MSLIP_BAD_POISSON_RATIO, 1, 0.5 } } },
};

static region *parameters[KINDS], *output;

static double *value_at(int kind, int i)
{
    return (double *)last(parameters[kind], kinds[kind].bytes) + i;
}

static mslip_contact *contact(void)
{
    return last(output, sizeof(mslip_contact));
}

static int32_t init(int kind)
{
    void *p = last(parameters[kind], kinds[kind].bytes);
    return kind == FLAT ? mslip_contact_init(p, contact()) : mslip_contact_init_elliptic(p, contact());
}

/* One invalid value among otherwise valid parameters. */
static void rejected(int kind, int i, double value, int32_t status, const char *what)
{
    char row[128];
    double good = *value_at(kind, i);
    snprintf(row, sizeof row, "%s %s", kinds[kind].field[i].name, what);
    memcpy(value_at(kind, i), &value, sizeof value);
    remember_regions();
    check_rejected(init(kind), status, kinds[kind].function, row);
    *value_at(kind, i) = good;
}

static int is_possible(const mslip_contact *c)
{
    const double values[6] = { c->composite_modulus, c->half_width, c->slip_force, c->slip_displacement, c->initial_stiffness,
                               c->slip_energy };
    for (int i = 0; i < 6; ++i) {
        if (!(isfinite(values[i]) && values[i] >= 0.0)) {
            return 0;
        }
    }
    /* Either all quantities of friction vanish, or none. */
    return c->composite_modulus > 0.0 && (c->slip_force > 0.0) == (c->initial_stiffness > 0.0) &&
           (c->slip_force > 0.0) == (c->slip_displacement > 0.0) && (c->slip_force > 0.0) == (c->slip_energy > 0.0);
}

/* An extreme value that is valid by itself: either a contact with possible values, or a status for the combination. */
static void extreme(int kind, int i, double value)
{
    double good = *value_at(kind, i);
    int32_t status;
    *value_at(kind, i) = value;
    remember_regions();
    status = init(kind);
    if (status == MSLIP_OK) {
        CHECK(raised() == 0 && is_possible(contact()) && region_is_unchanged(parameters[kind]));
        restore_regions();
    } else {
        CHECK(status == MSLIP_OUT_OF_RANGE || (kind == FLAT && status == MSLIP_LENGTH_TOO_SHORT));
        check_rejected(status, status, kinds[kind].function, kinds[kind].field[i].name);
    }
    *value_at(kind, i) = good;
}

static void test_every_value(void)
{
    static const double extremes[] = { 5e-324, 1e-310, 1e-300, 1e-200, 1e-160, 1e-100, 1e100, 1e160, 1e200, 1e300, DBL_MAX };
    for (int kind = 0; kind < KINDS; ++kind) {
        for (int i = 0; i < kinds[kind].fields; ++i) {
            const field *f = &kinds[kind].field[i];
            for (int k = 0; k < NON_FINITE; ++k) {
                rejected(kind, i, from_bits(non_finite[k]), f->status, "is not finite");
            }
            rejected(kind, i, -1.0, f->status, "has the wrong sign");
            rejected(kind, i, -5e-324, f->status, "has the wrong sign, and is subnormal");
            rejected(kind, i, -DBL_MAX, f->status, "has the wrong sign, and is the largest double");
            if (!f->zero_is_allowed) {
                rejected(kind, i, 0.0, f->status, "is zero");
                rejected(kind, i, -0.0, f->status, "is minus zero");
            }
            if (f->largest < DBL_MAX) {
                rejected(kind, i, f->largest * (1.0 + DBL_EPSILON), f->status, "is just too large");
                rejected(kind, i, DBL_MAX, f->status, "is too large");
                extreme(kind, i, f->largest);
            }
            if (f->zero_is_allowed) {
                extreme(kind, i, 0.0);
                extreme(kind, i, -0.0);
            }
            for (size_t k = 0; k < sizeof extremes / sizeof *extremes; ++k) {
                if (extremes[k] <= f->largest) {
                    extreme(kind, i, extremes[k]);
                }
            }
        }
    }
}

/* Any two values extreme at once. */
static void test_pairs(void)
{
    static const double extremes[] = { 5e-324, 1e-300, 1e-150, 1e150, 1e300 };
    enum { COUNT = sizeof extremes / sizeof *extremes };
    for (int kind = 0; kind < KINDS; ++kind) {
        for (int i = 0; i < kinds[kind].fields; ++i) {
            for (int j = 0; j < kinds[kind].fields; ++j) {
                for (int k = 0; k < COUNT * COUNT; ++k) {
                    double good = *value_at(kind, i), value = extremes[k / COUNT];
                    if (i != j && value <= kinds[kind].field[i].largest && extremes[k % COUNT] <= kinds[kind].field[j].largest) {
                        *value_at(kind, i) = value;
                        extreme(kind, j, extremes[k % COUNT]);
                        *value_at(kind, i) = good;
                    }
                }
            }
        }
    }
}

/* The first invalid field determines the status. */
static void test_order(void)
{
    for (int kind = 0; kind < KINDS; ++kind) {
        double good[MAX_FIELDS];
        for (int i = kinds[kind].fields - 1; i >= 0; --i) {
            good[i] = *value_at(kind, i);
            *value_at(kind, i) = -1.0;
            remember_regions();
            check_rejected(init(kind), kinds[kind].field[i].status, kinds[kind].function, "this and all later fields are negative");
        }
        memcpy(value_at(kind, 0), good, (size_t)kinds[kind].fields * sizeof *good);
    }
}

static void test_reference(void)
{
    static const int32_t bad[] = { -1, 2, 255, INT32_MAX, INT32_MIN };
    mslip_parameters *p = last(parameters[FLAT], sizeof *p);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        p->displacement_reference = bad[i];
        remember_regions();
        check_rejected(init(FLAT), MSLIP_BAD_DISPLACEMENT_REFERENCE, "mslip_contact_init", "displacement_reference");
    }
    p->displacement_reference = MSLIP_CENTRE_POINT;
}

/* Values that are valid one by one, but not together. */
static void test_inconsistent(void)
{
    mslip_parameters *p = last(parameters[FLAT], sizeof *p);
    const mslip_parameters good = *p;
    const double half_width = flat_contact().half_width;
    const struct {
        double length, flat_half_width, edge_radius;
        int32_t reference, status;
    } rows[] = {
        { 0.49 * half_width, good.flat_half_width, good.edge_radius, MSLIP_CENTRE_POINT, MSLIP_LENGTH_TOO_SHORT },
        { 0.49 * half_width, good.flat_half_width, good.edge_radius, MSLIP_RIGID_STRIP, MSLIP_LENGTH_TOO_SHORT },
        { good.length, 2.1 * good.length, good.edge_radius, MSLIP_CENTRE_POINT, MSLIP_LENGTH_TOO_SHORT },
        { good.length, good.flat_half_width, 1e6, MSLIP_CENTRE_POINT, MSLIP_LENGTH_TOO_SHORT },
        { good.length, good.flat_half_width, 1e300, MSLIP_CENTRE_POINT, MSLIP_OUT_OF_RANGE },
        { 1e-300, good.flat_half_width, good.edge_radius, MSLIP_CENTRE_POINT, MSLIP_OUT_OF_RANGE },
        { good.length, 1e200, good.edge_radius, MSLIP_CENTRE_POINT, MSLIP_OUT_OF_RANGE },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        p->length = rows[i].length;
        p->flat_half_width = rows[i].flat_half_width;
        p->edge_radius = rows[i].edge_radius;
        p->displacement_reference = rows[i].reference;
        remember_regions();
        check_rejected(init(FLAT), rows[i].status, "mslip_contact_init", "inconsistent values");
    }
    *p = good;
}

static void test_pointers(void)
{
    void *p = last(parameters[FLAT], sizeof(mslip_parameters));
    void *e = last(parameters[ELLIPTIC], sizeof(mslip_elliptic_parameters));
    const int32_t expected = MSLIP_NULL_POINTER;

    remember_regions();
    check_rejected(mslip_contact_init(NULL, contact()), expected, "mslip_contact_init", "p");
    check_rejected(mslip_contact_init(p, NULL), expected, "mslip_contact_init", "contact");
    check_rejected(mslip_contact_init(NULL, NULL), expected, "mslip_contact_init", "both");
    check_rejected(mslip_contact_init_elliptic(NULL, contact()), expected, "mslip_contact_init_elliptic", "p");
    check_rejected(mslip_contact_init_elliptic(e, NULL), expected, "mslip_contact_init_elliptic", "contact");
    mslip_parameters_default(NULL);
    mslip_elliptic_parameters_default(NULL);
    CHECK(raised() == 0 && nothing_changed());
}

/* Unset values are rejected, the first one determining the status. */
static void test_unset(void)
{
    mslip_parameters *p = last(parameters[FLAT], sizeof *p);
    mslip_elliptic_parameters *e = last(parameters[ELLIPTIC], sizeof *e);
    const mslip_parameters flat = *p;
    const mslip_elliptic_parameters ellipse = *e;
    for (int i = 0; i < kinds[FLAT].fields; ++i) {
        mslip_parameters_default(p);
        memcpy(p, &flat, (size_t)i * sizeof(double));
        remember_regions();
        check_rejected(init(FLAT), kinds[FLAT].field[i].status, "mslip_contact_init", "unset");
    }
    for (int i = 0; i < kinds[ELLIPTIC].fields; ++i) {
        mslip_elliptic_parameters_default(e);
        memcpy(e, &ellipse, (size_t)i * sizeof(double));
        remember_regions();
        check_rejected(init(ELLIPTIC), kinds[ELLIPTIC].field[i].status, "mslip_contact_init_elliptic", "unset");
    }
    *p = flat;
    *e = ellipse;
}

int main(int argc, char **argv)
{
    check_arguments(argc, argv);
    for (int kind = 0; kind < KINDS; ++kind) {
        parameters[kind] = make_region(kinds[kind].bytes);
    }
    output = make_region(sizeof(mslip_contact));
    *(mslip_parameters *)last(parameters[FLAT], sizeof(mslip_parameters)) = flat_parameters();
    *(mslip_elliptic_parameters *)last(parameters[ELLIPTIC], sizeof(mslip_elliptic_parameters)) = elliptic_parameters();

    test_every_value();
    test_pairs();
    test_order();
    test_reference();
    test_inconsistent();
    test_pointers();
    test_unset();
    check_every_code_was_seen(PARAMETERS);
    return check_report();
}
