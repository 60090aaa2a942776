/* Every argument of every function with every kind of invalid value: its own status, nothing modified, and no floating-point
   exception. Extreme valid values: finite results. */
#include "calls.h"

/* Every status, its number and its message. Each must be returned by some call below. */
static const struct {
    int32_t code, number;
    const char *message;
} statuses[] = {
#define STATUS(code, number, message) { code, number, message },
#include "functions.h"
};

static void test_statuses(void)
{
    const char *unknown = mslip_status_text(-1);
    int known = 0;
    for (size_t i = 0; i < LENGTH(statuses); ++i) {
        CHECK(statuses[i].code == statuses[i].number);
        CHECK(strcmp(mslip_status_text(statuses[i].code), statuses[i].message) == 0);
        /* C takes the number of coefficients from the workspace. */
        if (statuses[i].code != MSLIP_BAD_COEFFICIENTS && !CHECK(seen[statuses[i].code])) {
            printf("    never returned: %s\n", statuses[i].message);
        }
    }
    for (int32_t code = 1; code < 1000; ++code) {
        known += strcmp(mslip_status_text(code), unknown) != 0;
    }
    CHECK(known == LENGTH(statuses));
    CHECK(MSLIP_OK == 0 && strcmp(mslip_status_text(MSLIP_OK), unknown) != 0 && strlen(unknown) > 1);
    CHECK(strcmp(mslip_status_text(INT32_MIN), unknown) == 0 && strcmp(mslip_status_text(INT32_MAX), unknown) == 0);
}

/* ---- Parameters ---- */

/* The parameters of contacts and elements of both kinds as arrays of doubles, with their largest valid values. An element has no
   tables for a normal force of 0. */
enum { ROUNDED, ELLIPTIC, ROUNDED_ELEMENT, ELLIPTIC_ELEMENT, SHAPES, MAX_FIELDS = 9 };
#define IS_ROUNDED(shape) ((shape) % 2 == ROUNDED)
#define LOAD_AND_MATERIAL(zero_load_is_valid) \
    { MSLIP_BAD_NORMAL_FORCE, zero_load_is_valid, DBL_MAX }, { MSLIP_BAD_FRICTION_COEFFICIENT, 1, DBL_MAX }, \
    { MSLIP_BAD_YOUNG_MODULUS, 0, DBL_MAX }, { MSLIP_BAD_POISSON_RATIO, 1, 0.5 }, \
    { MSLIP_BAD_YOUNG_MODULUS, 0, DBL_MAX }, { MSLIP_BAD_POISSON_RATIO, 1, 0.5 }
#define FLAT_GEOMETRY \
    { MSLIP_BAD_FLAT_HALF_WIDTH, 1, DBL_MAX }, { MSLIP_BAD_EDGE_RADIUS, 0, DBL_MAX }, { MSLIP_BAD_LENGTH, 0, DBL_MAX }
#define AXES { MSLIP_BAD_SEMI_AXIS_X, 0, DBL_MAX }, { MSLIP_BAD_SEMI_AXIS_Y, 0, DBL_MAX }
static const struct {
    const char *function;
    size_t bytes;
    int fields;
    struct {
        int32_t status;
        int zero_is_valid;
        double largest;
    } field[MAX_FIELDS];
} shapes[SHAPES] = {
    { "mslip_contact_init", sizeof(mslip_parameters), 9, { FLAT_GEOMETRY, LOAD_AND_MATERIAL(1) } },
    { "mslip_contact_init_elliptic", sizeof(mslip_elliptic_parameters), 8, { AXES, LOAD_AND_MATERIAL(1) } },
    { "mslip_element_init", sizeof(mslip_parameters), 9, { FLAT_GEOMETRY, LOAD_AND_MATERIAL(0) } },
    { "mslip_element_init_elliptic", sizeof(mslip_elliptic_parameters), 8, { AXES, LOAD_AND_MATERIAL(0) } },
};

static double *parameter(int shape, int i)
{
    return (double *)last(input_region, shapes[shape].bytes) + i;
}

static void set_parameters(int shape)
{
    const mslip_parameters p = flat_parameters();
    const mslip_elliptic_parameters e = elliptic_parameters();
    memcpy(parameter(shape, 0), IS_ROUNDED(shape) ? (const void *)&p : (const void *)&e, shapes[shape].bytes);
}

/* The variants of elements, by turns. */
static int32_t init(int shape)
{
    static int variant = 0;
    mslip_contact *contact = last(contact_region, sizeof *contact);
    mslip_element *element = last(element_region, sizeof *element);
    void *p = parameter(shape, 0);
    variant = (variant + 1) % VARIANTS;
    const int32_t directions = directions_of(variant), normal_input = normal_input_of(variant);
    switch (shape) {
        case ROUNDED: return mslip_contact_init(p, contact);
        case ELLIPTIC: return mslip_contact_init_elliptic(p, contact);
        case ROUNDED_ELEMENT: return mslip_element_init(p, directions, normal_input, element);
        default: return mslip_element_init_elliptic(p, directions, normal_input, element);
    }
}

static void bad_parameter(int shape, int i, double value, const char *what)
{
    const double good = *parameter(shape, i);
    memcpy(parameter(shape, i), &value, sizeof value);
    save_regions();
    if (!check_rejected(init(shape), shapes[shape].field[i].status, shapes[shape].function, what)) {
        printf("    parameter %d\n", i);
    }
    *parameter(shape, i) = good;
}

/* Either all quantities of friction vanish, or none. */
static int is_possible(const mslip_contact *c)
{
    const double values[] = { c->composite_modulus, c->half_width, c->slip_force, c->slip_displacement, c->initial_stiffness,
                              c->slip_energy };
    int holds = c->composite_modulus > 0.0;
    for (size_t i = 0; i < LENGTH(values); ++i) {
        holds &= isfinite(values[i]) && values[i] >= 0.0 && (i < 3 || (values[i] > 0.0) == (c->slip_force > 0.0));
    }
    return holds;
}

/* Finite and positive but for the friction coefficient, and so are the tractions and stiffnesses near and at the largest load. */
static int is_possible_element(const mslip_element *e)
{
    const double values[] = { e->composite_modulus, e->normal_force, e->half_width, e->approach, e->normal_stiffness,
                              e->tangential_stiffness };
    const int by_force = e->normal_input == MSLIP_INPUT_NORMAL_FORCE, m = e->directions + 1;
    double state[STATE], force[COMPONENTS], tangent[TANGENT], dissipated;
    int holds = isfinite(e->friction_coefficient) && e->friction_coefficient >= 0.0 && (m == 2 || m == 3);
    for (size_t i = 0; i < LENGTH(values); ++i) {
        holds &= isfinite(values[i]) && values[i] > 0.0;
    }
    holds &= mslip_element_check(e) == MSLIP_OK && mslip_element_state_init(e->directions, STATE, state) == MSLIP_OK;
    for (int i = 0; i < 4; ++i) {
        const double parts[4] = { 0.3, 1.0, 0.7, 1e-6 }, part = parts[i];
        const double shift = part * e->approach * fmin(e->friction_coefficient, 1.0);
        const double u = i % 2 ? shift : -shift, w = part * (by_force ? e->normal_force : e->approach);
        const double step[COMPONENTS] = { u, m == 2 ? w : 0.5 * u, w };
        holds &= mslip_element_update(e, STATE, state, step, state, force, tangent, &dissipated) == MSLIP_OK;
        const double normal = force[m - 1], tangential = m == 2 ? fabs(force[0]) : hypot(force[0], force[1]);
        holds &= normal > 0.0 && normal <= e->normal_force * (1.0 + 1e-13);
        holds &= tangential <= e->friction_coefficient * normal * (1.0 + (m == 2 ? DBL_EPSILON : 1e-12));
        for (int k = 0; k < m * m; ++k) {
            holds &= isfinite(tangent[k]) && (k % m < m - 1 || (tangent[k] > 0.0) == (k == m * m - 1));
        }
        holds &= isfinite(dissipated) && dissipated >= 0.0;
    }
    return holds;
}

/* An extreme valid value: either a possible contact or element, or a status for the combination. */
static void extreme_parameter(int shape, int i, double value)
{
    const double good = *parameter(shape, i);
    int32_t status;
    *parameter(shape, i) = value;
    save_regions();
    status = init(shape);
    if (status == MSLIP_OK) {
        const int flags = raised(), is_element = shape >= ROUNDED_ELEMENT;
        const region *law = is_element ? element_region : contact_region;
        const int holds = flags == 0 && nothing_changed_but(law) &&
                          (is_element ? is_possible_element(last(law, sizeof(mslip_element)))
                                      : is_possible(last(law, sizeof(mslip_contact))));
        if (!CHECK(holds && raised() == 0)) {
            printf("    %s, parameter %d: %g, flags %x\n", shapes[shape].function, i, value, (unsigned)flags);
        }
    } else {
        const int of_layer = i >= shapes[shape].fields &&
                             (status == MSLIP_BAD_NORMAL_COMPLIANCE || status == MSLIP_BAD_TANGENTIAL_COMPLIANCE);
        CHECK(status == MSLIP_OUT_OF_RANGE || of_layer || (IS_ROUNDED(shape) && status == MSLIP_LENGTH_TOO_SHORT));
        check_rejected(status, status, shapes[shape].function, "an extreme value");
    }
    *parameter(shape, i) = good;
}

static void test_parameters(int shape)
{
    static const double extremes[] = { 5e-324, 1e-310, 1e-300, 1e-200, 1e-160, 1e-100, 1e100, 1e160, 1e200, 1e300, DBL_MAX };
    static const double pairs[] = { 5e-324, 1e-300, 1e-150, 1e150, 1e300 };
    set_parameters(shape);
    for (int i = 0; i < shapes[shape].fields; ++i) {
        const double largest = shapes[shape].field[i].largest;
        for (int k = 0; k < NON_FINITE; ++k) {
            bad_parameter(shape, i, from_bits(non_finite[k]), "not finite");
        }
        bad_parameter(shape, i, -1.0, "negative");
        bad_parameter(shape, i, -5e-324, "negative and subnormal");
        bad_parameter(shape, i, -DBL_MAX, "the smallest double");
        for (int sign = -1; sign <= 1; sign += 2) {
            if (shapes[shape].field[i].zero_is_valid) {
                const double good = *parameter(shape, i);
                extreme_parameter(shape, i, sign * 0.0);
                *parameter(shape, i) = sign * 0.0;
                CHECK(init(shape) == MSLIP_OK);
                *parameter(shape, i) = good;
            } else {
                bad_parameter(shape, i, sign * 0.0, "zero");
            }
        }
        if (largest < DBL_MAX) {
            bad_parameter(shape, i, largest * (1.0 + DBL_EPSILON), "just too large");
            bad_parameter(shape, i, DBL_MAX, "too large");
            extreme_parameter(shape, i, largest);
        }
        for (size_t k = 0; k < LENGTH(extremes); ++k) {
            if (extremes[k] <= largest) {
                extreme_parameter(shape, i, extremes[k]);
            }
        }
        /* Two extreme values at once. */
        for (int j = 0; j < shapes[shape].fields; ++j) {
            for (size_t k = 0; k < LENGTH(pairs) * LENGTH(pairs); ++k) {
                const double good = *parameter(shape, i), value = pairs[k / LENGTH(pairs)], other = pairs[k % LENGTH(pairs)];
                if (i != j && value <= largest && other <= shapes[shape].field[j].largest) {
                    *parameter(shape, i) = value;
                    extreme_parameter(shape, j, other);
                    *parameter(shape, i) = good;
                }
            }
        }
    }
    /* Parameters are unset after the default; the first invalid one determines the status. */
    for (int i = 0; i < shapes[shape].fields; ++i) {
        set_parameters(shape);
        mslip_parameters unset;
        mslip_elliptic_parameters unset_elliptic;
        mslip_parameters_default(&unset);
        mslip_elliptic_parameters_default(&unset_elliptic);
        memcpy(parameter(shape, i), IS_ROUNDED(shape) ? &unset.flat_half_width : &unset_elliptic.semi_axis_x,
               (size_t)(shapes[shape].fields - i) * sizeof(double));
        bad_parameter(shape, i, *parameter(shape, i), "unset");
    }
}

/* The compliances and loads of a layer, behind the materials: invalid and extreme ones. */
static void test_layer(int shape)
{
    static const double extremes[] = { 0.0, 5e-324, 1e-300, 1e-160, 1e-12, 1e-8, 1.0, 1e160, DBL_MAX };
    const double largest = IS_ROUNDED(shape) ? flat_parameters().normal_force : elliptic_parameters().normal_force;
    const struct {
        int field;
        double value;
        int32_t status;
    } rows[] = {
        { 0, -1e-9, MSLIP_BAD_NORMAL_COMPLIANCE }, { 0, (double)INFINITY, MSLIP_BAD_NORMAL_COMPLIANCE },
        { 0, (double)NAN, MSLIP_BAD_NORMAL_COMPLIANCE }, { 1, -5e-324, MSLIP_BAD_TANGENTIAL_COMPLIANCE },
        { 1, (double)INFINITY, MSLIP_BAD_TANGENTIAL_COMPLIANCE }, { 1, (double)NAN, MSLIP_BAD_TANGENTIAL_COMPLIANCE },
        { 2, -1.0, MSLIP_BAD_STIFFENING_LOAD }, { 2, (double)NAN, MSLIP_BAD_STIFFENING_LOAD },
        { 2, 0.999e-3 * largest, MSLIP_BAD_STIFFENING_LOAD }, { 2, 5e-324, MSLIP_BAD_STIFFENING_LOAD },
        { 3, -5e-324, MSLIP_BAD_REFERENCE_LOAD }, { 3, (double)NAN, MSLIP_BAD_REFERENCE_LOAD }, { 3, 2e150, MSLIP_BAD_REFERENCE_LOAD },
        { 0, 1e-160, MSLIP_BAD_NORMAL_COMPLIANCE }, { 0, 1e160, MSLIP_BAD_NORMAL_COMPLIANCE },
        { 1, 1e-160, MSLIP_BAD_TANGENTIAL_COMPLIANCE }, { 1, 1e60, MSLIP_BAD_TANGENTIAL_COMPLIANCE },
    };
    set_parameters(shape);
    double *layer = parameter(shape, shapes[shape].fields);
    for (size_t i = 0; i < LENGTH(rows); ++i) {
        layer[rows[i].field] = rows[i].value;
        save_regions();
        check_rejected(init(shape), rows[i].status, shapes[shape].function, "a layer");
        layer[rows[i].field] = 0.0;
    }
    for (size_t i = 0; i < LENGTH(extremes) * LENGTH(extremes) * 3; ++i) {
        const double stiffening[] = { 0.0, 1e-3 * largest, 1e300 };
        layer[3] = extremes[i % 7];
        layer[0] = extremes[i % LENGTH(extremes)];
        layer[1] = extremes[i / LENGTH(extremes) % LENGTH(extremes)];
        extreme_parameter(shape, shapes[shape].fields + 2, stiffening[i / (LENGTH(extremes) * LENGTH(extremes))]);
    }
}

static const char *warning(int shape, int32_t i)
{
    const void *p = parameter(shape, 0);
    return IS_ROUNDED(shape) ? mslip_parameters_warning(p, i) : mslip_elliptic_parameters_warning(p, i);
}

/* Each implausible value has one warning, no plausible, unset or invalid value has any, and no exception is raised. */
static void test_warnings(int shape)
{
    const struct {
        int shape, field;
        double value;
        const char *start;
    } rows[] = {
        { ROUNDED, 0, 0.3, "flat_half_width is implausible" }, { ROUNDED, 1, 2.0, "edge_radius is implausible" },
        { ROUNDED, 1, 2e-6, "edge_radius is implausible" }, { ROUNDED, 2, 19.7, "length is implausible" },
        { ROUNDED, 2, 1.97e-5, "length is implausible" }, { ROUNDED, 4, 41.7, "friction_coefficient is implausible" },
        { ROUNDED, 5, 2e5, "young_modulus is implausible" }, { ROUNDED, 7, 2e17, "young_modulus is implausible" },
        { ROUNDED, 1, 2e-4, "edge_radius is below flat_half_width" }, { ROUNDED, 3, 3e5, "normal_force is implausible: b - a" },
        { ROUNDED, 2, 1e-3, "length is below two widths" }, { ROUNDED, 2, 1.5e-3, NULL }, { ROUNDED, 3, 2e5, NULL },
        { ELLIPTIC, 0, 0.85, "semi_axis_x is implausible" }, { ELLIPTIC, 1, 1.5e-7, "semi_axis_y is implausible" },
        { ELLIPTIC, 2, 6e4, "normal_force is implausible: the semi-axes" }, { ELLIPTIC, 2, 5e4, NULL },
        { ELLIPTIC, 3, 90.0, "friction_coefficient is implausible" }, { ELLIPTIC, 6, 2.1e5, "young_modulus is implausible" },
    };
    const uint64_t invalid[] = { 0x7ff0000000000001, 0x7ff8000000000000, 0x7ff0000000000000, 0xbff0000000000000 };
    const int lengths = IS_ROUNDED(shape) ? 3 : 2, modulus = lengths + 2;
    for (size_t i = 0; i < LENGTH(rows); ++i) {
        set_parameters(shape);
        *parameter(shape, rows[i].field) = rows[i].value;
        const char *text = rows[i].shape == shape ? warning(shape, 0) : rows[i].start;
        CHECK(rows[i].start == NULL ? text == NULL : text != NULL && strncmp(text, rows[i].start, strlen(rows[i].start)) == 0);
        CHECK(rows[i].shape != shape || (warning(shape, 1) == NULL && warning(shape, -1) == NULL));
    }
    for (int i = 0; i < shapes[shape].fields; ++i) {
        for (size_t k = 0; k < LENGTH(invalid); ++k) {
            set_parameters(shape);
            memcpy(parameter(shape, i), &invalid[k], sizeof invalid[k]);
            CHECK(warning(shape, 0) == NULL);
        }
    }
    /* Lengths in mm, with moduli in Pa and in MPa; all values unset. */
    set_parameters(shape);
    for (int i = 0; i < lengths; ++i) {
        *parameter(shape, i) *= 1e3;
    }
    CHECK(warning(shape, lengths - 1) != NULL && warning(shape, lengths) == NULL);
    *parameter(shape, modulus) = *parameter(shape, modulus + 2) *= 1e-6;
    CHECK(warning(shape, 0) == NULL);
    mslip_parameters_default(last(input_region, sizeof(mslip_parameters)));
    CHECK(mslip_parameters_warning(last(input_region, sizeof(mslip_parameters)), 0) == NULL && raised() == 0);
    CHECK(mslip_parameters_warning(NULL, 0) == NULL && mslip_elliptic_parameters_warning(NULL, 0) == NULL);
}

/* Values that are valid one by one, but not together, and invalid references of the displacement. */
static void test_combinations(void)
{
    const mslip_parameters good = flat_parameters();
    const double short_length = 0.49 * contact_of(FLAT).half_width;
    const struct {
        double length, flat_half_width, edge_radius;
        int32_t reference, status;
    } rows[] = {
        { short_length, good.flat_half_width, good.edge_radius, MSLIP_CENTRE_POINT, MSLIP_LENGTH_TOO_SHORT },
        { short_length, good.flat_half_width, good.edge_radius, MSLIP_RIGID_STRIP, MSLIP_LENGTH_TOO_SHORT },
        { good.length, 2.1 * good.length, good.edge_radius, MSLIP_CENTRE_POINT, MSLIP_LENGTH_TOO_SHORT },
        { good.length, good.flat_half_width, 1e6, MSLIP_CENTRE_POINT, MSLIP_LENGTH_TOO_SHORT },
        { good.length, good.flat_half_width, 1e300, MSLIP_CENTRE_POINT, MSLIP_OUT_OF_RANGE },
        { 1e-300, good.flat_half_width, good.edge_radius, MSLIP_CENTRE_POINT, MSLIP_OUT_OF_RANGE },
        { good.length, 1e200, good.edge_radius, MSLIP_CENTRE_POINT, MSLIP_OUT_OF_RANGE },
        { good.length, good.flat_half_width, good.edge_radius, -1, MSLIP_BAD_DISPLACEMENT_REFERENCE },
        { good.length, good.flat_half_width, good.edge_radius, 2, MSLIP_BAD_DISPLACEMENT_REFERENCE },
        { good.length, good.flat_half_width, good.edge_radius, 255, MSLIP_BAD_DISPLACEMENT_REFERENCE },
        { good.length, good.flat_half_width, good.edge_radius, INT32_MAX, MSLIP_BAD_DISPLACEMENT_REFERENCE },
        { good.length, good.flat_half_width, good.edge_radius, INT32_MIN, MSLIP_BAD_DISPLACEMENT_REFERENCE },
    };
    mslip_parameters *p = last(input_region, sizeof *p);
    for (size_t i = 0; i < LENGTH(rows); ++i) {
        *p = good;
        p->length = rows[i].length;
        p->flat_half_width = rows[i].flat_half_width;
        p->edge_radius = rows[i].edge_radius;
        p->displacement_reference = rows[i].reference;
        save_regions();
        check_rejected(init(ROUNDED), rows[i].status, "mslip_contact_init", "a combination");
        check_rejected(init(ROUNDED_ELEMENT), rows[i].status, "mslip_element_init", "a combination");
    }
    for (int shape = 0; shape < SHAPES; ++shape) {
        test_layer(shape);
        test_warnings(shape % 2);
    }
    save_regions();
    mslip_parameters_default(NULL);
    mslip_elliptic_parameters_default(NULL);
    CHECK(raised() == 0 && nothing_changed_but(NULL));
}

/* ---- Every argument of every function, by the table ---- */

/* Invalid finite values and their status, and extreme valid ones; forces as multiples of mu N. */
static const struct {
    int kind;
    double value;
    int32_t status;
} values[] = {
    { FORCE, 1.001, MSLIP_FORCE_EXCEEDS_SLIP }, { FORCE, -1.001, MSLIP_FORCE_EXCEEDS_SLIP },
    { FORCE, 1.0 + 1e-12, MSLIP_FORCE_EXCEEDS_SLIP },
    { FORCE, 1e300, MSLIP_FORCE_EXCEEDS_SLIP }, { FORCE, -1e300, MSLIP_FORCE_EXCEEDS_SLIP },
    { FORCE_AMPLITUDE, 1.001, MSLIP_FORCE_EXCEEDS_SLIP }, { FORCE_AMPLITUDE, 1e300, MSLIP_FORCE_EXCEEDS_SLIP },
    { FORCE_AMPLITUDE, -1.0, MSLIP_BAD_FORCE_AMPLITUDE }, { FORCE_AMPLITUDE, -1e-320, MSLIP_BAD_FORCE_AMPLITUDE },
    { FORCE_AMPLITUDE, -1e300, MSLIP_BAD_FORCE_AMPLITUDE },
    { DISPLACEMENT, 1.0000001e150, MSLIP_BAD_DISPLACEMENT }, { DISPLACEMENT, -1.0000001e150, MSLIP_BAD_DISPLACEMENT },
    { DISPLACEMENT, DBL_MAX, MSLIP_BAD_DISPLACEMENT }, { DISPLACEMENT, -DBL_MAX, MSLIP_BAD_DISPLACEMENT },
    { AMPLITUDE, 1.0000001e150, MSLIP_BAD_AMPLITUDE }, { AMPLITUDE, DBL_MAX, MSLIP_BAD_AMPLITUDE },
    { AMPLITUDE, -1.0, MSLIP_BAD_AMPLITUDE }, { AMPLITUDE, -5e-324, MSLIP_BAD_AMPLITUDE },
    { AMPLITUDE, -DBL_MAX, MSLIP_BAD_AMPLITUDE },
    { X, 0.0, 0 }, { X, -0.0, 0 }, { X, 5e-324, 0 }, { X, -1e-300, 0 }, { X, 1e300, 0 },
    { X, -DBL_MAX, 0 },
    { FORCE, 0.0, 0 }, { FORCE, -0.0, 0 }, { FORCE, 1e-320, 0 }, { FORCE, -1e-300, 0 }, { FORCE, 1.0, 0 }, { FORCE, -1.0, 0 },
    { FORCE_AMPLITUDE, 0.0, 0 }, { FORCE_AMPLITUDE, -0.0, 0 }, { FORCE_AMPLITUDE, 1e-320, 0 }, { FORCE_AMPLITUDE, 1e-300, 0 },
    { FORCE_AMPLITUDE, 1.0, 0 },
    { DISPLACEMENT, 0.0, 0 }, { DISPLACEMENT, -0.0, 0 }, { DISPLACEMENT, 5e-324, 0 }, { DISPLACEMENT, -1e-300, 0 },
    { DISPLACEMENT, 1e-150, 0 }, { DISPLACEMENT, 1.0, 0 }, { DISPLACEMENT, 1e150, 0 }, { DISPLACEMENT, -1e150, 0 },
    { AMPLITUDE, 0.0, 0 }, { AMPLITUDE, -0.0, 0 }, { AMPLITUDE, 5e-324, 0 }, { AMPLITUDE, 1e-300, 0 }, { AMPLITUDE, 1e-150, 0 },
    { AMPLITUDE, 1.0, 0 }, { AMPLITUDE, 1e150, 0 },
    { APPROACH, 1.0000001e150, MSLIP_BAD_DISPLACEMENT }, { APPROACH, -1.0000001e150, MSLIP_BAD_DISPLACEMENT },
    { APPROACH, DBL_MAX, MSLIP_BAD_DISPLACEMENT }, { APPROACH, -DBL_MAX, MSLIP_BAD_DISPLACEMENT },
    { NORMAL_FORCE, 1.0000001e150, MSLIP_BAD_NORMAL_FORCE }, { NORMAL_FORCE, DBL_MAX, MSLIP_BAD_NORMAL_FORCE },
    { NORMAL_FORCE, -1.0, MSLIP_BAD_NORMAL_FORCE }, { NORMAL_FORCE, -5e-324, MSLIP_BAD_NORMAL_FORCE },
    { NORMAL_FORCE, -DBL_MAX, MSLIP_BAD_NORMAL_FORCE },
    { APPROACH_COEFFICIENT, 1.0000001e150, MSLIP_BAD_DISPLACEMENT }, { APPROACH_COEFFICIENT, -DBL_MAX, MSLIP_BAD_DISPLACEMENT },
    { FORCE_COEFFICIENT, 1.0000001e150, MSLIP_BAD_DISPLACEMENT }, { FORCE_COEFFICIENT, -DBL_MAX, MSLIP_BAD_DISPLACEMENT },
    { APPROACH_COEFFICIENT, 1e150, MSLIP_LENGTH_TOO_SHORT }, { APPROACH_COEFFICIENT, 1.0, MSLIP_LENGTH_TOO_SHORT },
    { APPROACH, 1.0, MSLIP_LENGTH_TOO_SHORT }, { APPROACH, 1e150, MSLIP_LENGTH_TOO_SHORT },
    { NORMAL_FORCE, 1e12, MSLIP_LENGTH_TOO_SHORT }, { NORMAL_FORCE, 1e150, MSLIP_LENGTH_TOO_SHORT },
    { APPROACH, 0.0, 0 }, { APPROACH, -0.0, 0 }, { APPROACH, 5e-324, 0 }, { APPROACH, 1e-300, 0 }, { APPROACH, 1e-150, 0 },
    { APPROACH, 1e-20, 0 }, { APPROACH, 1e-5, 0 }, { APPROACH, -1e-300, 0 }, { APPROACH, -1.0, 0 }, { APPROACH, -1e150, 0 },
    { NORMAL_FORCE, 0.0, 0 }, { NORMAL_FORCE, -0.0, 0 }, { NORMAL_FORCE, 5e-324, 0 }, { NORMAL_FORCE, 1e-300, 0 },
    { NORMAL_FORCE, 1e-150, 0 }, { NORMAL_FORCE, 1e-12, 0 }, { NORMAL_FORCE, 1e4, 0 },
};

static double value_of(size_t i)
{
    const int is_force = values[i].kind == FORCE || values[i].kind == FORCE_AMPLITUDE;
    return values[i].value * (is_force ? call.contacts->slip_force : 1.0);
}


/* Valid values are skipped for items of a batch but the first and the last. */
static void test_value(const function *f, int kind, int32_t status, double *place, int is_inner)
{
    const double good = *place;
    const char *what = "a value";
    for (int k = 0; k < NON_FINITE; ++k) {
        memcpy(place, &non_finite[k], sizeof *place);
        rejected(f, status, what);
    }
    for (size_t i = 0; i < LENGTH(values); ++i) {
        /* Elliptical elements have no length. The compliance of a cylinder and of an ellipse at N = 0 is infinite. */
        const int has_ellipse = (f->takes & IS_BATCH) || first_kind == ELLIPSE;
        const int is_infinite = first_kind != FLAT && values[i].value == 0.0 && strcmp(f->name, "mslip_normal_approach") == 0;
        const int is_skipped = is_infinite || (is_inner && values[i].status == MSLIP_OK)
                               || (has_ellipse && values[i].status == MSLIP_LENGTH_TOO_SHORT);
        if (values[i].kind == kind && !is_skipped) {
            *place = value_of(i);
            rejected_unless_skipped(f, values[i].status == MSLIP_OK, ITEMS, values[i].status, what);
        }
    }
    *place = good;
}

static void test_values(const function *f)
{
    if (f->scalar != NONE) {
        test_value(f, f->scalar, argument_of(f, ARG_VALUE)->status, &call.scalar, 0);
    }
    for (size_t i = 0; i < f->inputs; ++i) {
        const int is_inner = i >= f->inputs / items_of(f) && i < f->inputs - f->inputs / items_of(f);
        test_value(f, kind_of_input(f, i), status_of_input(f, i), &INPUT[i], is_inner);
    }
    for (size_t k = 0; f->inputs > 0 && k < LENGTH(values); ++k) {
        int count = 0;
        set_up(f);
        for (size_t i = 0; i < f->inputs; ++i) {
            if (values[k].kind == kind_of_input(f, i) && values[k].status == MSLIP_OK) {
                INPUT[i] = value_of(k);
                ++count;
            }
        }
        if (count > 0 && !(first_kind != FLAT && values[k].value == 0.0 && strcmp(f->name, "mslip_normal_approach") == 0)) {
            accepted(f, "all array elements");
        }
    }
}

/* Misaligned, and NULL if it is required: of the outputs, with each subset of the others. */
static void test_pointer(const function *f, const argument *a, size_t item)
{
    char *const field = (char *)&call + a->field, *const no_pointer = NULL;
    char *good;
    memcpy(&good, field, sizeof good);
    char *const bad = good + item / 2;
    memcpy(field, &bad, sizeof bad);
    rejected(f, MSLIP_BAD_ALIGNMENT, a->name);
    memset(call.out, 0, a->kind == ARG_OUTPUT || a->kind == ARG_NEW_STATE ? 0 : sizeof call.out);
    rejected(f, MSLIP_BAD_ALIGNMENT, a->name);
    set_up(f);
    memcpy(field, &no_pointer, sizeof no_pointer);
    switch (a->kind) {
        case ARG_INDEX:
        case ARG_ACTIVE: accepted(f, "without index or flags"); break;
        case ARG_FOUND_CHOICE:
        case ARG_FOUND_SIZE: CHECK(f->call() == MSLIP_OK); break;
        case ARG_NEW_STATE:
        case ARG_OUTPUT: break; /* all subsets of the outputs in batch.c */
        default:
            rejected(f, MSLIP_NULL_POINTER, a->name);
            memset(call.out, 0, sizeof call.out);
            rejected(f, MSLIP_NULL_POINTER, a->name);
    }
}

static const size_t too_long[] = { SIZE_MAX, SIZE_MAX / 2 + 1, SIZE_MAX / 8, SIZE_MAX / 16 + 1 };

/* Counts beyond the address space, and 0, with no arrays. */
static void test_count(const function *f, const argument *a)
{
    size_t *const count = (size_t *)(void *)((char *)&call + a->field);
    for (size_t i = 0; i < LENGTH(too_long); ++i) {
        *count = too_long[i];
        rejected(f, MSLIP_BAD_ARRAY_SIZE, a->name);
        memset(call.out, 0, sizeof call.out);
        rejected(f, MSLIP_BAD_ARRAY_SIZE, "without outputs");
        set_up(f);
    }
    if (f->takes & IS_IWAN) {
        static const size_t bad[] = { 0, 65537, 1000000, SIZE_MAX / 16 };
        for (size_t i = 0; i < LENGTH(bad); ++i) {
            *count = bad[i];
            rejected(f, MSLIP_BAD_COUNT, "n");
        }
    } else if (a->kind == ARG_COUNT) {
        call.n = call.n_contacts = 0;
        call.input = NULL;
        call.index = call.active = NULL;
        if (f->takes & IS_BATCH) {
            call.contacts = NULL;
            call.elements = NULL;
            call.state = NULL;
        }
        call.out[0] = NULL;
        save_regions();
        CHECK(f->call() == MSLIP_OK && raised() == 0 && nothing_changed_but(NULL));
    }
}

/* Lengths beyond the address space; too short ones, of memory that ends at the protected page; states too short for their reversals
   or pieces. */
static void test_length(const function *f, const argument *a)
{
    size_t *const length = (size_t *)(void *)((char *)&call + a->field);
    const int is_state = a->field == offsetof(arguments, state_length), is_new = (f->takes & 1 << ARG_BUFFER) != 0;
    const size_t least = is_state ? least_state(f) : *length, full = *length;
    for (size_t i = 0; i < LENGTH(too_long) - 1; ++i) {
        *length = too_long[i];
        rejected(f, MSLIP_BAD_ARRAY_SIZE, a->name);
    }
    for (size_t i = 0; i < least; ++i) {
        if (is_state || i < 10 || i + 10 >= least) {
            const size_t unused = (full - i) * items_of(f);
            *length = i;
            if (is_new) {
                call.buffer += unused;
            } else {
                call.state += unused;
            }
            rejected(f, a->status, a->name);
            if (is_new) {
                call.buffer -= unused;
            } else {
                call.state -= unused;
            }
        }
    }
    for (*length = least; is_state && !is_new && !(f->takes & IS_BATCH) && *length < used_state(f); ++*length) {
        rejected(f, MSLIP_BAD_STATE, "less than the reversals or pieces need");
    }
}

/* The length of a workspace is 0 for arguments that are not allowed. */
static int has_workspace_length(const function *f)
{
    return (f->takes & IS_ELEMENT ? mslip_element_workspace_length(call.directions, call.harmonics, call.samples, call.rule)
                                  : mslip_harmonic_workspace_length(call.harmonics, call.samples, call.rule)) > 0;
}

static void test_sizes(const function *f, const argument *a)
{
    static const size_t periods[] = { 65537, SIZE_MAX / 2 + 1, SIZE_MAX };
    for (size_t i = 0; a->field == offsetof(arguments, periods) && i < LENGTH(periods); ++i) {
        call.periods = periods[i];
        rejected(f, a->status, a->name);
    }
    call.periods = PERIODS;
    enum { MOST = 1 << 24 };
    static const struct {
        size_t harmonics, samples;
        int32_t status;
    } rows[] = {
        { 0, 16, MSLIP_BAD_HARMONICS }, { 0, 0, MSLIP_BAD_HARMONICS }, { MOST + 1, SIZE_MAX, MSLIP_BAD_HARMONICS },
        { SIZE_MAX, SIZE_MAX, MSLIP_BAD_HARMONICS }, { SIZE_MAX / 2 + 1, 1, MSLIP_BAD_HARMONICS }, /* twice this is 0 */
        { 2, 0, MSLIP_BAD_SAMPLES }, { 2, 4, MSLIP_BAD_SAMPLES }, { MOST, MOST, MSLIP_BAD_SAMPLES },
        { 2, MOST + 1, MSLIP_BAD_SAMPLES }, { 2, SIZE_MAX, MSLIP_BAD_SAMPLES }, { 2, SIZE_MAX / 2 + 1, MSLIP_BAD_SAMPLES },
        { MOST / 2 - 1, MOST, MSLIP_WORKSPACE_TOO_SHORT }, /* the largest allowed */
    };
    for (size_t i = 0; i < LENGTH(rows); ++i) {
        call.harmonics = rows[i].harmonics;
        call.samples = rows[i].samples;
        CHECK(has_workspace_length(f) == (rows[i].status == MSLIP_WORKSPACE_TOO_SHORT));
        rejected(f, rows[i].status, "a size");
    }
}

/* Values that are not allowed; the arguments after it are not read. */
static void test_choice(const function *f, const argument *a)
{
    int32_t *const choice = (int32_t *)(void *)((char *)&call + a->field);
    const int is_directions = choice == &call.directions, is_rule = choice == &call.rule;
    /* MSLIP_BY_NORMAL_FORCE, 0, is no normal input. */
    const int32_t bad[] = { is_rule ? 2 : MSLIP_BY_NORMAL_FORCE, is_directions ? 3 : is_rule ? 7 : 1, -1, INT32_MAX, INT32_MIN };
    for (size_t i = 0; i < 2 * LENGTH(bad); ++i) {
        *choice = bad[i / 2];
        call.harmonics = i % 2 ? 0 : call.harmonics;
        call.normal_input += is_directions && i % 2 ? 7 : 0;
        CHECK(!is_rule || !has_workspace_length(f));
        rejected(f, a->status, a->name);
        set_up(f);
    }
    if (is_rule && (f->takes & IS_ELEMENT)) {
        CHECK(has_workspace_length(f));
        call.rule = MSLIP_EVENT_DRIVEN;
        CHECK(!has_workspace_length(f));
        rejected(f, MSLIP_NOT_AVAILABLE, a->name);
    } else if (is_directions && (f->takes & TAKES_STATE)) {
        call.directions = 3 - call.directions;
        rejected(f, MSLIP_BAD_DIRECTIONS, "a state with other directions");
    }
}

/* Contacts, elements, states, workspaces and tables that were never initialised, or have another number of directions. */
static void test_memory(const function *f, const argument *a, size_t bytes)
{
    void *memory;
    for (int fill = 0; fill < 256; fill += 51) {
        set_up(f);
        memcpy(&memory, (char *)&call + a->field, sizeof memory);
        memset(memory, fill, bytes);
        rejected(f, a->status, "uninitialised memory");
    }
    const int32_t directions = 3 - directions_for(f);
    const int other = (f->rule + TWO_DIRECTIONS) % VARIANTS, has_none = strcmp(f->name, "mslip_element_tractions") == 0;
    const function *of_contact = find("mslip_harmonic_force", MSLIP_UNIFORM_SAMPLING);
    if (a->kind == ARG_WORKSPACE) {
        /* Of the other law. */
        call.workspace = (double *)(void *)workspace_region->start;
        if (f->takes & IS_ELEMENT) {
            init_workspace(of_contact, 1, 8, workspace_length_of(of_contact, 1, 8), call.workspace);
        } else {
            CHECK(mslip_element_workspace_init(1 + f->rule, 1, 8, 0, 0, workspace_region->bytes / 8, call.workspace) == MSLIP_OK);
        }
        rejected(f, MSLIP_BAD_WORKSPACE, "a workspace of the other law");
    }
    if (!(f->takes & 1 << ARG_ELEMENT) || !(f->takes & (TAKES_STATE | TAKES_WORKSPACE))) {
        return;
    }
    for (size_t item = 0; item < items_of(f); ++item) {
        set_up(f);
        if (a->kind == ARG_WORKSPACE) {
            call.workspace = (double *)(void *)workspace_region->start;
            CHECK(mslip_element_workspace_init(directions, 1, 8, 0, 0, workspace_region->bytes / 8, call.workspace) == MSLIP_OK);
            rejected(f, MSLIP_BAD_DIRECTIONS, "a workspace with other directions");
        } else if (a->kind == ARG_STATE) {
            CHECK(mslip_element_state_init(directions, STATE, STATES + item * STATE) == MSLIP_OK);
            rejected(f, MSLIP_BAD_DIRECTIONS, "a state with other directions");
            if (directions == 1 && !(f->takes & IS_BATCH)) {
                call.state_length = mslip_element_state_length(1, 0);
                CHECK(mslip_element_state_init(1, call.state_length, STATES) == MSLIP_OK);
                rejected(f, MSLIP_BAD_DIRECTIONS, "a state of one direction, too short for two");
            }
        } else {
            ELEMENTS[item] = *element_of(FLAT, other);
            rejected(f, has_none ? MSLIP_NOT_AVAILABLE : MSLIP_BAD_DIRECTIONS, "an element with other directions");
            if (f->takes & IS_BATCH) {
                ACTIVE[item] = 0;
                accepted_except(f, item, "the element with other directions is skipped");
                INDICES[item] = (int32_t)(item + 1) % ITEMS;
                ACTIVE[item] = 1;
                accepted(f, "the element with other directions is not used");
            }
        }
    }
}

static void test_argument(const function *f, const argument *a)
{
    const size_t items = items_of(f);
    switch (a->kind) {
        case ARG_COUNT:
        case ARG_LAWS: test_count(f, a); return;
        case ARG_LENGTH: test_length(f, a); return;
        case ARG_SIZE: test_sizes(f, a); return;
        case ARG_CHOICE: test_choice(f, a); return;
        case ARG_VALUE: return;
        default: test_pointer(f, a, a->kind == ARG_INDEX || a->kind == ARG_ACTIVE || a->kind == ARG_FOUND_CHOICE ? 4 : 8);
    }
    switch (a->kind) {
        case ARG_CONTACT:
        case ARG_ELEMENT: test_memory(f, a, items * law_size(f)); break;
        case ARG_STATE: test_memory(f, a, items * STATE * sizeof(double)); break;
        case ARG_WORKSPACE: test_memory(f, a, workspace_length(f) * sizeof(double)); break;
        case ARG_TABLE: test_memory(f, a, mslip_stiffness_table_length() * sizeof(double)); break;
        default: break;
    }
}

static void test_function(const function *f)
{
    const int is_law = (f->takes & (1 << ARG_CONTACT | 1 << ARG_ELEMENT)) != 0;
    set_up(f);
    accepted(f, "valid arguments");
    if (f->takes & 1 << ARG_FOUND_SIZE) {
        CHECK(*call.found_harmonics == HARMONICS && *call.found_samples == SAMPLES && *call.found_rule == call.rule);
        CHECK(call.found_directions == NULL || (*call.found_directions == call.directions && *call.found_periods == PERIODS));
    }
    for (first_kind = FLAT; first_kind <= (is_law && (f->takes & IS_ELEMENT) ? ELLIPSE : FLAT); ++first_kind) {
        set_up(f);
        test_values(f);
    }
    first_kind = FLAT;
    for (const argument *a = f->argument; a->name != NULL; ++a) {
        set_up(f);
        test_argument(f, a);
    }
}

/* ---- What is special about some functions ---- */

/* Rejected updates in place. The new state keeps its doubles beyond state_length, and that of an element in an update all that are
   not in use. */
static void test_states(const function *f)
{
    set_up(f);
    for (int in_place = 0; f->out[0] > 0 && in_place < 2; ++in_place) {
        call.out[0] = in_place ? STATES : NULL;
        for (int k = 0; k < NON_FINITE; ++k) {
            memcpy(f->inputs > 0 ? &INPUT[f->inputs - 1] : &call.scalar, &non_finite[k], sizeof(double));
            rejected(f, f->inputs > 0 ? status_of_input(f, f->inputs - 1) : MSLIP_BAD_DISPLACEMENT,
                     in_place ? "in place" : "without a new state");
        }
        set_up(f);
    }
    if (f->takes & IS_BATCH) {
        return; /* the length of one state is that of all */
    }
    call.state_length = STATE - 1;
    save_regions();
    CHECK(f->call() == MSLIP_OK && raised() == 0 && is_unchanged(state_region));
    if (f->out[0] > 0) {
        const size_t written = written_state(f, call.out[0]), unused = (STATE - 1 - written) * sizeof(double);
        const unsigned char *last = out_regions[0]->before + out_regions[0]->bytes - sizeof(double);
        if (!(f->takes & IS_ELEMENT)) {
            CHECK(same_bits(&call.out[0][STATE - 3], &STATES[STATE - 3], 2));
        } else if (!strstr(f->name, "path")) {
            CHECK(memcmp(&call.out[0][written], last - unused, unused) == 0);
        }
        CHECK(memcmp(&call.out[0][STATE - 1], last, 8) == 0);
    }
}

/* One invalid item: no item is modified. An item that is not active is neither checked nor modified. */
static void test_batch(const function *f)
{
    static const int32_t bad_index[] = { -1, ITEMS, INT32_MAX, INT32_MIN }, nonzero[ITEMS] = { 1, -1, INT32_MAX, INT32_MIN, 2 };
    const size_t share = f->inputs / ITEMS;
    for (size_t bad = 0; bad < ITEMS; ++bad) {
        for (int skipped = 0; skipped < 2; ++skipped) {
            set_up(f);
            ACTIVE[bad] = !skipped;
            memset(law_at(f, bad), skipped ? 0xff : 0, law_size(f));
            rejected_unless_skipped(f, skipped, bad, status_of_law(f), "one contact or element is invalid");
            set_law(f, bad, (int)bad % 3);
            for (size_t i = 0; i < LENGTH(bad_index); ++i) {
                INDICES[bad] = bad_index[i];
                rejected_unless_skipped(f, skipped, bad, MSLIP_BAD_INDEX, "one index is invalid");
            }
            INDICES[bad] = (int32_t)bad;
            for (size_t k = 0; k < share * NON_FINITE; ++k) {
                double *place = &INPUT[bad * share + k / NON_FINITE];
                const double before = *place;
                memcpy(place, &non_finite[k % NON_FINITE], sizeof *place);
                rejected_unless_skipped(f, skipped, bad, status_of_input(f, bad * share + k / NON_FINITE),
                                        "one value is not finite");
                *place = before;
            }
            if (f->takes & TAKES_STATE) {
                STATES[bad * STATE] = 0.0;
                rejected_unless_skipped(f, skipped, bad, MSLIP_BAD_STATE, "one state is invalid");
            }
        }
    }
    /* No item is active: no contact is checked. */
    set_up(f);
    memset(law_at(f, 0), 0xff, ITEMS * law_size(f));
    memset(ACTIVE, 0, ITEMS * sizeof(int32_t));
    save_regions();
    CHECK(f->call() == MSLIP_OK && raised() == 0 && nothing_changed_but(workspace_region));
    for (size_t n_contacts = 0; n_contacts < 2 * ITEMS; ++n_contacts) {
        set_up(f);
        call.index = n_contacts % 2 ? call.index : NULL;
        call.n_contacts = n_contacts / 2;
        rejected(f, MSLIP_BAD_INDEX, "fewer contacts than items");
    }
    /* Any flag but 0 is active. */
    set_up(f);
    memcpy(ACTIVE, nonzero, sizeof nonzero);
    accepted(f, "flags");
    memset(law_at(f, 3), 0, law_size(f));
    rejected(f, status_of_law(f), "an item with any flag but 0");
}

/* Lengths beyond the address space, and errors of states without merged reversals or pieces. */
static void test_lengths(void)
{
    static const int32_t directions[] = { 0, 3, -1, INT32_MAX, INT32_MIN };
    for (size_t k = 0; k < LENGTH(directions); ++k) {
        CHECK(mslip_element_state_length(directions[k], (size_t)k) == 0);
    }
    CHECK(mslip_state_length(SIZE_MAX) == SIZE_MAX && mslip_state_length(SIZE_MAX / 2) == SIZE_MAX);
    CHECK(mslip_element_state_length(1, SIZE_MAX) == SIZE_MAX && mslip_element_state_length(1, SIZE_MAX / 4) == SIZE_MAX);
    CHECK(mslip_element_state_length(1, 0) == mslip_element_state_length(1, 4));
    CHECK(mslip_element_state_length(2, 0) > 0 && mslip_element_state_length(2, SIZE_MAX) == mslip_element_state_length(2, 0));
    set_up(find("mslip_masing_update", 0));
    CHECK(mslip_state_error(STATE, call.state, call.out[1]) == MSLIP_OK && *call.out[1] == 0.0);
    CHECK(mslip_state_error(STATE, call.state, NULL) == MSLIP_OK);
    for (int variant = 0; variant < VARIANTS; ++variant) {
        set_up(find("mslip_element_update", variant));
        CHECK(mslip_element_state_error(directions_of(variant), STATE, call.state, call.out[3]) == MSLIP_OK);
        CHECK(*call.out[3] >= 0.0 && mslip_element_state_error(directions_of(variant), STATE, call.state, NULL) == MSLIP_OK);
    }
}

/* Normal motions with an open contact, negative normal forces, and loads from the smallest to beyond the tables. */
static void test_normal_motions(const function *f)
{
    static const double sizes[] = { 0.0, 5e-324, 1e-310, 1e-300, 1e-200, 1e-100, 1e-65, 1e-55, 1e-30, 1e-6, 1e-3, 20.0 };
    const size_t items = items_of(f);
    const int by_force = normal_input_of(f->rule) == MSLIP_INPUT_NORMAL_FORCE;
    for (size_t k = 0; k < LENGTH(sizes); ++k) {
        for (int shape = 0; shape < 4; ++shape) {
            set_up(f);
            for (size_t i = 0; i < items * COEFFICIENTS; ++i) {
                const size_t place = ((i / COEFFICIENTS + 1) * components_of(f) - 1) * COEFFICIENTS + i % COEFFICIENTS;
                const double swing = shape == 0 ? 0.0 : shape == 1 ? 1.0 : shape == 2 ? 3.0 : -1.0;
                INPUT[place] *= sizes[k] * (i % COEFFICIENTS == 0 ? 1.0 : swing);
            }
            if (by_force && shape == 2 && sizes[k] > 1e-300) {
                rejected(f, MSLIP_BAD_NORMAL_FORCE, "a negative normal force"); /* an approach opens the contact */
            } else if (!by_force || shape != 2) {
                accepted(f, "normal motions");
            }
        }
    }
    set_up(f);
    INPUT[f->inputs - COEFFICIENTS] = by_force ? -1e-3 : -1.0;
    if (by_force) {
        rejected(f, MSLIP_BAD_NORMAL_FORCE, "a negative mean");
    } else {
        accepted(f, "open for the whole period");
    }
    set_up(f);
}

/* Tables of other shapes, for which nothing but friction coefficient and scale may differ. */
static void test_table(void)
{
    const function *f = find("mslip_complex_stiffness_tabulated", 0);
    const size_t length = mslip_stiffness_table_length();
    for (int change = 0; change < 8; ++change) {
        mslip_parameters p = flat_parameters();
        mslip_contact other;
        set_up(f);
        switch (change) {
            case 0: p.flat_half_width *= 1.0 + 1e-6; break;
            case 1: p.edge_radius *= 1.0 + 1e-6; break;
            case 2: p.length *= 1.0 + 1e-6; break;
            case 3: p.normal_force *= 1.0 + 1e-6; break;
            case 4: p.material[0].poisson_ratio += 1e-6; break;
            case 5: p.displacement_reference = MSLIP_RIGID_STRIP; break;
            default: break;
        }
        CHECK(mslip_contact_init(&p, &other) == MSLIP_OK);
        other = change == 6 ? contact_of(ELLIPSE) : change == 7 ? contact_of(OPEN) : other;
        CHECK(mslip_stiffness_table_init(&other, length, call.table) == MSLIP_OK);
        rejected(f, MSLIP_BAD_TABLE, "the table of another shape");
        memset(call.out, 0, sizeof call.out);
        rejected(f, MSLIP_BAD_TABLE, "the table of another shape, without outputs");
    }
}

/* Slip distributions of elliptical contacts, and the state of another contact. */
static void test_other_contacts(void)
{
    static const double friction[] = { 1e-6, 0.01, 0.2, 0.41, 10.0, 0.0 };
    const function *slip = find("mslip_slip", 0), *tractions = find("mslip_masing_tractions", 0);
    const function *update = find("mslip_masing_update", 0);
    mslip_parameters p = flat_parameters();
    set_up(slip);
    CONTACTS[0] = contact_of(ELLIPSE);
    rejected(slip, MSLIP_NOT_AVAILABLE, "an elliptical contact");
    memset(call.out, 0, sizeof call.out);
    rejected(slip, MSLIP_NOT_AVAILABLE, "an elliptical contact, without outputs");
    for (size_t i = 0; i < LENGTH(friction); ++i) {
        set_up(tractions);
        p.friction_coefficient = friction[i];
        CHECK(mslip_contact_init(&p, &CONTACTS[0]) == MSLIP_OK);
        if (friction[i] < 0.05) {
            rejected(tractions, MSLIP_FORCE_EXCEEDS_SLIP, "the state of a stronger contact");
        } else if (friction[i] > 1.0) {
            accepted(tractions, "the state of a weaker contact");
        }
        set_up(update);
        CHECK(mslip_contact_init(&p, &CONTACTS[0]) == MSLIP_OK);
        for (int k = -20; k <= 20; ++k) {
            call.scalar = 1e-8 * k;
            accepted(update, "the state of another contact");
            CHECK(fabs(*call.out[1]) <= call.contacts->slip_force && *call.out[2] >= 0.0 && *call.out[3] >= 0.0);
        }
    }
}


int main(int argc, char **argv)
{
    check_arguments(argc, argv);
    make_regions();
    for (int shape = 0; shape < SHAPES; ++shape) {
        test_parameters(shape);
    }
    test_combinations();
    for (int i = 0; i < ALL_FUNCTIONS; ++i) {
        const function *f = &functions[i];
        test_function(f);
        if (i < FUNCTIONS && (f->takes & TAKES_STATE)) {
            test_states(f);
        }
        if ((f->takes & IS_ELEMENT) && (f->takes & TAKES_WORKSPACE) && f->inputs > 0) {
            test_normal_motions(f);
        }
        if (f->takes & IS_BATCH) {
            test_batch(f);
        }
    }
    test_lengths();
    test_table();
    test_other_contacts();
    test_statuses();
    return check_report();
}
