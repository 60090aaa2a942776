/* The C interface, function by function: results, rejections, and unmodified outputs. */
#include "fixture.h"

static const double PI = 3.14159265358979323846;

static void test_version(void)
{
    char text[64];
    snprintf(text, sizeof text, "%d.%d.%d", MSLIP_VERSION_MAJOR, MSLIP_VERSION_MINOR, MSLIP_VERSION_PATCH);
    CHECK(strcmp(mslip_version(), text) == 0);
    CHECK(mslip_abi_version() == MSLIP_ABI_VERSION);
}

/* Each status has a fixed number and a message of its own. */
static void test_status(void)
{
    static const struct {
        int32_t code, number;
    } status[] = {
        { MSLIP_OK, 0 },
        { MSLIP_NULL_POINTER, 1 },
        { MSLIP_BAD_FLAT_HALF_WIDTH, 2 },
        { MSLIP_BAD_EDGE_RADIUS, 3 },
        { MSLIP_BAD_LENGTH, 4 },
        { MSLIP_BAD_NORMAL_FORCE, 5 },
        { MSLIP_BAD_FRICTION_COEFFICIENT, 6 },
        { MSLIP_BAD_YOUNG_MODULUS, 7 },
        { MSLIP_BAD_POISSON_RATIO, 8 },
        { MSLIP_BAD_DISPLACEMENT_REFERENCE, 9 },
        { MSLIP_BAD_SEMI_AXIS_X, 10 },
        { MSLIP_BAD_SEMI_AXIS_Y, 11 },
        { MSLIP_LENGTH_TOO_SHORT, 12 },
        { MSLIP_OUT_OF_RANGE, 13 },
        { MSLIP_BAD_CONTACT, 20 },
        { MSLIP_BAD_STATE, 21 },
        { MSLIP_BAD_WORKSPACE, 22 },
        { MSLIP_STATE_TOO_SHORT, 23 },
        { MSLIP_WORKSPACE_TOO_SHORT, 25 },
        { MSLIP_BAD_FORCE, 30 },
        { MSLIP_FORCE_EXCEEDS_SLIP, 31 },
        { MSLIP_BAD_DISPLACEMENT, 32 },
        { MSLIP_BAD_POSITION, 33 },
        { MSLIP_BAD_AMPLITUDE, 34 },
        { MSLIP_BAD_FORCE_AMPLITUDE, 35 },
        { MSLIP_BAD_HARMONICS, 36 },
        { MSLIP_BAD_SAMPLES, 37 },
        { MSLIP_BAD_COUNT, 38 },
        { MSLIP_BAD_RULE, 39 },
        { MSLIP_NOT_AVAILABLE, 40 },
        { MSLIP_BAD_INDEX, 41 },
        { MSLIP_BAD_ARRAY_SIZE, 90 },
        { MSLIP_BAD_ALIGNMENT, 91 },
    };
    static const int32_t unknown[] = { -1, 14, 24, 92, INT32_MAX, INT32_MIN };
    const size_t codes = sizeof status / sizeof *status;

    for (size_t i = 0; i < codes; ++i) {
        const char *text = mslip_status_text(status[i].code);
        CHECK(status[i].code == status[i].number);
        CHECK(text != NULL && strlen(text) > 1);
        for (size_t j = 0; j < i; ++j) {
            CHECK(strcmp(text, mslip_status_text(status[j].code)) != 0);
        }
        CHECK(strcmp(text, mslip_status_text(unknown[0])) != 0);
    }
    for (size_t i = 0; i < sizeof unknown / sizeof *unknown; ++i) {
        CHECK(strlen(mslip_status_text(unknown[i])) > 1);
    }
}

/* A rejected initialisation does not modify the contact. */
static void flat_rejected(const mslip_parameters *p, int32_t status, const char *file, int line)
{
    mslip_contact contact, before;
    memset(&contact, 0x5a, sizeof contact);
    before = contact;
    check_that(mslip_contact_init(p, &contact) == status, file, line, "the parameters are rejected");
    check_that(memcmp(&contact, &before, sizeof contact) == 0, file, line, "the contact is unmodified");
}

static void elliptic_rejected(const mslip_elliptic_parameters *p, int32_t status, const char *file, int line)
{
    mslip_contact contact, before;
    memset(&contact, 0x5a, sizeof contact);
    before = contact;
    check_that(mslip_contact_init_elliptic(p, &contact) == status, file, line, "the parameters are rejected");
    check_that(memcmp(&contact, &before, sizeof contact) == 0, file, line, "the contact is unmodified");
}

#define FLAT_REJECTED(field, value, status) \
    do { \
        mslip_parameters p_ = flat_parameters(); \
        p_.field = (value); \
        flat_rejected(&p_, (status), __FILE__, __LINE__); \
    } while (0)

#define ELLIPTIC_REJECTED(field, value, status) \
    do { \
        mslip_elliptic_parameters p_ = elliptic_parameters(); \
        p_.field = (value); \
        elliptic_rejected(&p_, (status), __FILE__, __LINE__); \
    } while (0)

static void test_contact_init(void)
{
    mslip_parameters p = flat_parameters();
    mslip_contact contact;

    CHECK(mslip_contact_init(NULL, &contact) == MSLIP_NULL_POINTER);
    CHECK(mslip_contact_init(&p, NULL) == MSLIP_NULL_POINTER);
    CHECK(mslip_contact_init(NULL, NULL) == MSLIP_NULL_POINTER);
    mslip_parameters_default(NULL);

    for (int i = 0; i < 3; ++i) {
        FLAT_REJECTED(flat_half_width, not_finite[i], MSLIP_BAD_FLAT_HALF_WIDTH);
        FLAT_REJECTED(edge_radius, not_finite[i], MSLIP_BAD_EDGE_RADIUS);
        FLAT_REJECTED(length, not_finite[i], MSLIP_BAD_LENGTH);
        FLAT_REJECTED(normal_force, not_finite[i], MSLIP_BAD_NORMAL_FORCE);
        FLAT_REJECTED(friction_coefficient, not_finite[i], MSLIP_BAD_FRICTION_COEFFICIENT);
        for (int body = 0; body < 2; ++body) {
            FLAT_REJECTED(material[body].young_modulus, not_finite[i], MSLIP_BAD_YOUNG_MODULUS);
            FLAT_REJECTED(material[body].poisson_ratio, not_finite[i], MSLIP_BAD_POISSON_RATIO);
        }
    }
    FLAT_REJECTED(flat_half_width, -1e-300, MSLIP_BAD_FLAT_HALF_WIDTH);
    FLAT_REJECTED(edge_radius, 0.0, MSLIP_BAD_EDGE_RADIUS);
    FLAT_REJECTED(edge_radius, -1.0, MSLIP_BAD_EDGE_RADIUS);
    FLAT_REJECTED(length, 0.0, MSLIP_BAD_LENGTH);
    FLAT_REJECTED(length, -1.0, MSLIP_BAD_LENGTH);
    FLAT_REJECTED(normal_force, -1.0, MSLIP_BAD_NORMAL_FORCE);
    FLAT_REJECTED(friction_coefficient, -1.0, MSLIP_BAD_FRICTION_COEFFICIENT);
    for (int body = 0; body < 2; ++body) {
        FLAT_REJECTED(material[body].young_modulus, 0.0, MSLIP_BAD_YOUNG_MODULUS);
        FLAT_REJECTED(material[body].young_modulus, -2e11, MSLIP_BAD_YOUNG_MODULUS);
        FLAT_REJECTED(material[body].poisson_ratio, 0.51, MSLIP_BAD_POISSON_RATIO);
        FLAT_REJECTED(material[body].poisson_ratio, -1.0, MSLIP_BAD_POISSON_RATIO);
    }
    FLAT_REJECTED(displacement_reference, 2, MSLIP_BAD_DISPLACEMENT_REFERENCE);
    FLAT_REJECTED(displacement_reference, -1, MSLIP_BAD_DISPLACEMENT_REFERENCE);
    FLAT_REJECTED(length, 1e-4, MSLIP_LENGTH_TOO_SHORT);
    FLAT_REJECTED(edge_radius, 1e6, MSLIP_LENGTH_TOO_SHORT);

    /* Each value is valid, but the results would overflow. */
    FLAT_REJECTED(edge_radius, 1e300, MSLIP_OUT_OF_RANGE);
    FLAT_REJECTED(normal_force, 1e300, MSLIP_OUT_OF_RANGE);

    /* No friction: no tangential force. */
    p.friction_coefficient = 0.0;
    CHECK(mslip_contact_init(&p, &contact) == MSLIP_OK);
    CHECK(contact.slip_force == 0.0 && contact.slip_displacement == 0.0 && contact.slip_energy == 0.0);

    /* Incompressible bodies, and one stiff on one soft. */
    p = flat_parameters();
    p.material[0].poisson_ratio = 0.5;
    p.material[1].poisson_ratio = 0.0;
    p.material[1].young_modulus = 1e9;
    CHECK(mslip_contact_init(&p, &contact) == MSLIP_OK);
    CHECK_RELATIVE(contact.composite_modulus, 1.0 / (0.75 / 2e11 + 1.0 / 1e9), 1e-15);

    /* The order of the bodies does not matter. */
    mslip_parameters swapped = p;
    mslip_contact other;
    swapped.material[0] = p.material[1];
    swapped.material[1] = p.material[0];
    CHECK(mslip_contact_init(&swapped, &other) == MSLIP_OK);
    CHECK_RELATIVE(other.initial_stiffness, contact.initial_stiffness, 1e-15);

    /* A rigid strip is stiffer than the centre point of the paper, by a few per cent. */
    p = flat_parameters();
    contact = flat_contact();
    p.displacement_reference = MSLIP_RIGID_STRIP;
    CHECK(mslip_contact_init(&p, &other) == MSLIP_OK);
    CHECK(other.initial_stiffness > 1.05 * contact.initial_stiffness);
    CHECK(other.initial_stiffness < 1.15 * contact.initial_stiffness);
    CHECK(other.half_width == contact.half_width && other.slip_energy == contact.slip_energy);
}

static void test_contact_values(void)
{
    mslip_contact contact = flat_contact();
    CHECK_RELATIVE(contact.composite_modulus, 1.091822251337482244e11, 1e-15);
    CHECK_RELATIVE(contact.half_width, 3.046707440322853866e-4, 1e-13);
    CHECK_RELATIVE(contact.slip_force, 74.32608, 1e-15);
    CHECK_RELATIVE(contact.slip_displacement, 1.160863650672488743e-7, 1e-13);
    CHECK_RELATIVE(contact.initial_stiffness, 6.410124131749484778e8, 1e-13);
    CHECK_RELATIVE(contact.slip_energy, 1.513179513084728612e-8, 1e-13);

    contact = elliptic_contact();
    CHECK(contact.half_width == 8.469711632573419636885181e-4);
    CHECK_RELATIVE(contact.initial_stiffness, 2.29525436694702534600547e8, 1e-13);
    CHECK_RELATIVE(contact.slip_displacement, 2.739171219416586140e-7, 1e-13);
    CHECK_RELATIVE(contact.slip_energy, 9.184762061174029561e-6, 1e-13);

    contact = open_contact();
    CHECK_RELATIVE(contact.composite_modulus, 1.091822251337482244e11, 1e-15);
    CHECK(contact.half_width == 0.0 && contact.slip_force == 0.0 && contact.slip_displacement == 0.0);
    CHECK(contact.initial_stiffness == 0.0 && contact.slip_energy == 0.0);
}

static void test_elliptic_init(void)
{
    mslip_elliptic_parameters p = elliptic_parameters();
    mslip_contact contact;

    CHECK(mslip_contact_init_elliptic(NULL, &contact) == MSLIP_NULL_POINTER);
    CHECK(mslip_contact_init_elliptic(&p, NULL) == MSLIP_NULL_POINTER);
    mslip_elliptic_parameters_default(NULL);
    for (int i = 0; i < 3; ++i) {
        ELLIPTIC_REJECTED(semi_axis_x, not_finite[i], MSLIP_BAD_SEMI_AXIS_X);
        ELLIPTIC_REJECTED(semi_axis_y, not_finite[i], MSLIP_BAD_SEMI_AXIS_Y);
        ELLIPTIC_REJECTED(normal_force, not_finite[i], MSLIP_BAD_NORMAL_FORCE);
        ELLIPTIC_REJECTED(friction_coefficient, not_finite[i], MSLIP_BAD_FRICTION_COEFFICIENT);
        for (int body = 0; body < 2; ++body) {
            ELLIPTIC_REJECTED(material[body].young_modulus, not_finite[i], MSLIP_BAD_YOUNG_MODULUS);
            ELLIPTIC_REJECTED(material[body].poisson_ratio, not_finite[i], MSLIP_BAD_POISSON_RATIO);
        }
    }
    ELLIPTIC_REJECTED(semi_axis_x, 0.0, MSLIP_BAD_SEMI_AXIS_X);
    ELLIPTIC_REJECTED(semi_axis_x, -1e-3, MSLIP_BAD_SEMI_AXIS_X);
    ELLIPTIC_REJECTED(semi_axis_y, 0.0, MSLIP_BAD_SEMI_AXIS_Y);
    ELLIPTIC_REJECTED(semi_axis_y, -1e-3, MSLIP_BAD_SEMI_AXIS_Y);
    ELLIPTIC_REJECTED(normal_force, -1.0, MSLIP_BAD_NORMAL_FORCE);
    ELLIPTIC_REJECTED(friction_coefficient, -0.1, MSLIP_BAD_FRICTION_COEFFICIENT);
    ELLIPTIC_REJECTED(material[1].young_modulus, 0.0, MSLIP_BAD_YOUNG_MODULUS);
    ELLIPTIC_REJECTED(material[0].poisson_ratio, 0.51, MSLIP_BAD_POISSON_RATIO);

    /* A sphere is Mindlin's: 8 G* a, with 1/G* the sum of (2-nu)/G. */
    p.semi_axis_y = p.semi_axis_x;
    CHECK(mslip_contact_init_elliptic(&p, &contact) == MSLIP_OK);
    CHECK_RELATIVE(contact.initial_stiffness,
                   8.0 * p.semi_axis_x / (2.0 * (2.0 - 0.45) * 2.0 * (1.0 + 0.45) / 2.1e11), 1e-13);

    p.normal_force = 0.0;
    CHECK(mslip_contact_init_elliptic(&p, &contact) == MSLIP_OK);
    CHECK(contact.slip_force == 0.0 && contact.initial_stiffness == 0.0);
}

static void test_monotonic_displacement(void)
{
    static const size_t n[3] = { 5, 5, 5 };
    const mslip_contact contact = flat_contact(), cylinder = cylinder_contact(), open = open_contact();
    const double slip = contact.slip_force;
    double force[5] = { 0.0, 7.432608, -37.16304, 66.893472, 0.0 };
    double bad[3] = { 1.0, 2.0, 3.0 };

    force[4] = slip;
    EVERY_SUBSET(3, n, mslip_monotonic_displacement(&contact, 5, force, OUT(0), OUT(1), OUT(2)));
    CHECK(reference[0][0] == 0.0 && reference[2][0] == contact.half_width);
    CHECK_RELATIVE(reference[1][0], 1.0 / contact.initial_stiffness, 1e-13);
    CHECK_RELATIVE(reference[0][1], 1.159624136290906280e-8, 1e-13);
    CHECK_RELATIVE(reference[0][2], -5.800552424694284567e-8, 1e-13);
    CHECK_RELATIVE(reference[1][2], 1.561712205449132719e-9, 1e-13);
    CHECK_RELATIVE(reference[2][2], 3.029462980411792095e-4, 1e-13);
    CHECK_RELATIVE(reference[0][3], 1.044617062707688215e-7, 1e-13);
    CHECK(reference[0][4] == contact.slip_displacement && reference[2][4] == 3e-4);

    poison();
    CHECK(mslip_monotonic_displacement(&contact, 0, force, out[0], out[1], out[2]) == MSLIP_OK && untouched());

    /* A rounding beyond mu N is mu N. */
    bad[0] = slip * (1.0 + 2.0 * DBL_EPSILON);
    bad[1] = -bad[0];
    CHECK(mslip_monotonic_displacement(&contact, 2, bad, out[0], NULL, out[2]) == MSLIP_OK);
    CHECK(out[0][0] == contact.slip_displacement && out[0][1] == -contact.slip_displacement && out[2][1] == 3e-4);
    CHECK(mslip_monotonic_displacement(&cylinder, 1, &cylinder.slip_force, NULL, out[1], out[2]) == MSLIP_OK);
    CHECK(isinf(out[1][0]) && out[1][0] > 0.0 && out[2][0] == 0.0);

    /* The last of several values is invalid: nothing is written for the others. */
    bad[1] = 2.0;
    bad[2] = slip * (1.0 + 1e-12);
    REJECTED(mslip_monotonic_displacement(&contact, 3, bad, out[0], out[1], out[2]), MSLIP_FORCE_EXCEEDS_SLIP);
    bad[2] = -2.0 * slip;
    REJECTED(mslip_monotonic_displacement(&contact, 3, bad, out[0], out[1], out[2]), MSLIP_FORCE_EXCEEDS_SLIP);
    for (int i = 0; i < 3; ++i) {
        bad[2] = not_finite[i];
        REJECTED(mslip_monotonic_displacement(&contact, 3, bad, out[0], out[1], out[2]), MSLIP_BAD_FORCE);
    }
    REJECTED(mslip_monotonic_displacement(NULL, 1, force, out[0], out[1], out[2]), MSLIP_NULL_POINTER);
    REJECTED(mslip_monotonic_displacement(&contact, 1, NULL, out[0], out[1], out[2]), MSLIP_NULL_POINTER);
    for (int i = 0; i < UNINITIALISED; ++i) {
        const mslip_contact uninitialised = uninitialised_contact(i);
        REJECTED(mslip_monotonic_displacement(&uninitialised, 1, force, out[0], out[1], out[2]), MSLIP_BAD_CONTACT);
    }

    CHECK(mslip_monotonic_displacement(&open, 1, force, out[0], NULL, out[2]) == MSLIP_OK);
    CHECK(out[0][0] == 0.0 && out[2][0] == 0.0);
    REJECTED(mslip_monotonic_displacement(&open, 2, force, out[0], out[1], out[2]), MSLIP_FORCE_EXCEEDS_SLIP);
}

static void test_monotonic_force(void)
{
    static const size_t n[3] = { 5, 5, 5 };
    const mslip_contact contact = flat_contact(), open = open_contact();
    double displacement[5] = { 0.0, 1.159624136290906280e-8, -5.800552424694284567e-8, 1.044617062707688215e-7, 1.0 };
    double bad[2] = { 1e-9, 0.0 };

    EVERY_SUBSET(3, n, mslip_monotonic_force(&contact, 5, displacement, OUT(0), OUT(1), OUT(2)));
    CHECK(reference[0][0] == 0.0 && reference[1][0] == contact.initial_stiffness);
    CHECK(reference[2][0] == contact.half_width);
    CHECK_RELATIVE(reference[0][1], 7.432608, 1e-13);
    CHECK_RELATIVE(reference[0][2], -37.16304, 1e-13);
    CHECK_RELATIVE(reference[1][2], 1.0 / 1.561712205449132719e-9, 1e-13);
    CHECK_RELATIVE(reference[2][2], 3.029462980411792095e-4, 1e-13);
    CHECK_RELATIVE(reference[0][3], 66.893472, 1e-13);
    CHECK(reference[0][4] == contact.slip_force && reference[1][4] == 0.0 && reference[2][4] == 0.0);

    poison();
    CHECK(mslip_monotonic_force(&contact, 0, displacement, out[0], out[1], out[2]) == MSLIP_OK && untouched());
    for (int i = 0; i < 3; ++i) {
        bad[1] = not_finite[i];
        REJECTED(mslip_monotonic_force(&contact, 2, bad, out[0], out[1], out[2]), MSLIP_BAD_DISPLACEMENT);
    }
    REJECTED(mslip_monotonic_force(NULL, 1, displacement, out[0], out[1], out[2]), MSLIP_NULL_POINTER);
    REJECTED(mslip_monotonic_force(&contact, 1, NULL, out[0], out[1], out[2]), MSLIP_NULL_POINTER);
    for (int i = 0; i < UNINITIALISED; ++i) {
        const mslip_contact uninitialised = uninitialised_contact(i);
        REJECTED(mslip_monotonic_force(&uninitialised, 1, displacement, out[0], out[1], out[2]), MSLIP_BAD_CONTACT);
    }

    CHECK(mslip_monotonic_force(&open, 5, displacement, out[0], out[1], out[2]) == MSLIP_OK);
    for (int i = 0; i < 5; ++i) {
        CHECK(out[0][i] == 0.0 && out[1][i] == 0.0 && out[2][i] == 0.0);
    }
}

/* At the onset of gross slip the stick zone is the flat, by force and by displacement; beyond, nothing sticks. */
static void test_onset_of_gross_slip(void)
{
    const mslip_contact contacts[] = { flat_contact(), cylinder_contact(), elliptic_contact() };
    const double flat[] = { 3e-4, 0.0, 0.0 };
    for (int i = 0; i < 3; ++i) {
        for (int sign = -1; sign <= 1; sign += 2) {
            const double slip = sign * contacts[i].slip_displacement, force = sign * contacts[i].slip_force;
            const double displacement[] = { slip, sign * nextafter(fabs(slip), INFINITY), 2.0 * slip };
            CHECK(mslip_monotonic_displacement(&contacts[i], 1, &force, out[0], NULL, out[2]) == MSLIP_OK);
            CHECK(out[0][0] == slip && out[2][0] == flat[i]);
            CHECK(mslip_monotonic_force(&contacts[i], 3, displacement, out[0], out[1], out[2]) == MSLIP_OK);
            CHECK(out[0][0] == force && out[2][0] == flat[i]);
            for (int k = 1; k < 3; ++k) {
                CHECK(out[0][k] == force && out[1][k] == 0.0 && out[2][k] == 0.0);
            }
        }
    }
}

static void test_tractions(void)
{
    static const size_t n[2] = { 5, 5 };
    const mslip_contact contact = flat_contact(), open = open_contact();
    const double x[5] = { 0.0, 1e-4, -1e-4, 3.02e-4, 4e-4 };
    double bad[2] = { 0.0, 0.0 };
    double force = 37.16304;

    EVERY_SUBSET(2, n, mslip_tractions(&contact, force, 5, x, OUT(0), OUT(1)));
    CHECK(reference[0][0] > 0.0 && reference[1][0] > 0.0 && reference[1][0] < 0.417 * reference[0][0]);
    CHECK(reference[0][1] == reference[0][2] && reference[1][1] == reference[1][2]);
    /* 3.02e-4 is between c and b... */
    CHECK(reference[1][3] > 0.0 && reference[1][3] <= 0.417 * reference[0][3] * (1.0 + 1e-15));
    /* ... and 4e-4 outside. */
    CHECK(reference[0][4] == 0.0 && reference[1][4] == 0.0);

    /* The pressure carries the normal force, the shear the tangential one. */
    enum { POINTS = 20000 };
    double load = 0.0, shear = 0.0, step = 2.0 * contact.half_width / POINTS;
    for (int i = 0; i < POINTS; ++i) {
        double position = -contact.half_width + (i + 0.5) * step;
        CHECK(mslip_tractions(&contact, force, 1, &position, out[0], out[1]) == MSLIP_OK);
        load += out[0][0] * step * 1.97e-2;
        shear += out[1][0] * step * 1.97e-2;
    }
    CHECK_RELATIVE(load, 178.24, 1e-4);
    CHECK_RELATIVE(shear, force, 1e-4);

    poison();
    CHECK(mslip_tractions(&contact, force, 0, x, out[0], out[1]) == MSLIP_OK && untouched());
    REJECTED(mslip_tractions(&contact, 1.01 * contact.slip_force, 5, x, out[0], out[1]), MSLIP_FORCE_EXCEEDS_SLIP);
    for (int i = 0; i < 3; ++i) {
        REJECTED(mslip_tractions(&contact, not_finite[i], 5, x, out[0], out[1]), MSLIP_BAD_FORCE);
        bad[1] = not_finite[i];
        REJECTED(mslip_tractions(&contact, force, 2, bad, out[0], out[1]), MSLIP_BAD_POSITION);
    }
    REJECTED(mslip_tractions(NULL, force, 5, x, out[0], out[1]), MSLIP_NULL_POINTER);
    REJECTED(mslip_tractions(&contact, force, 5, NULL, out[0], out[1]), MSLIP_NULL_POINTER);
    for (int i = 0; i < UNINITIALISED; ++i) {
        const mslip_contact uninitialised = uninitialised_contact(i);
        REJECTED(mslip_tractions(&uninitialised, force, 5, x, out[0], out[1]), MSLIP_BAD_CONTACT);
    }

    CHECK(mslip_tractions(&open, 0.0, 5, x, out[0], out[1]) == MSLIP_OK);
    for (int i = 0; i < 5; ++i) {
        CHECK(out[0][i] == 0.0 && out[1][i] == 0.0);
    }

    /* Elliptical: Hertz's pressure on the x axis. */
    const mslip_contact ellipse = elliptic_contact();
    const mslip_elliptic_parameters e = elliptic_parameters();
    double peak = 1.5 * e.normal_force / (PI * e.semi_axis_x * e.semi_axis_y), half = 0.5 * e.semi_axis_x;
    CHECK(mslip_tractions(&ellipse, 0.0, 1, &half, out[0], out[1]) == MSLIP_OK);
    CHECK_RELATIVE(out[0][0], peak * sqrt(0.75), 1e-13);
    CHECK(out[1][0] == 0.0);
}

static void test_slip(void)
{
    static const size_t n[2] = { 4, 4 };
    const mslip_contact contact = flat_contact(), ellipse = elliptic_contact(), open = open_contact();
    const double x[4] = { 0.0, 3.021230441095456675619502e-4, -3.021230441095456675619502e-4, 3.01e-4 };
    double bad[2] = { 0.0, 0.0 };
    double force = 52.02825599999999894862412;

    EVERY_SUBSET(2, n, mslip_slip(&contact, force, 4, x, OUT(0), OUT(1)));
    CHECK(reference[0][0] == 0.0 && reference[1][0] == 0.0);
    CHECK_RELATIVE(reference[0][1], 1.061303013690233280875049e-12, 1e-11);
    CHECK_RELATIVE(reference[1][1], 4.206320358142159672260915e-5, 1e-11);
    CHECK(reference[0][1] == reference[0][2] && reference[1][1] == reference[1][2]);
    CHECK(reference[0][3] == 0.0 && reference[1][3] == 0.0); /* within the stick zone */

    poison();
    CHECK(mslip_slip(&contact, force, 0, x, out[0], out[1]) == MSLIP_OK && untouched());
    REJECTED(mslip_slip(&contact, 1.01 * contact.slip_force, 4, x, out[0], out[1]), MSLIP_FORCE_EXCEEDS_SLIP);
    REJECTED(mslip_slip(&ellipse, 0.0, 4, x, out[0], out[1]), MSLIP_NOT_AVAILABLE);
    for (int i = 0; i < 3; ++i) {
        REJECTED(mslip_slip(&contact, not_finite[i], 4, x, out[0], out[1]), MSLIP_BAD_FORCE);
        bad[1] = not_finite[i];
        REJECTED(mslip_slip(&contact, force, 2, bad, out[0], out[1]), MSLIP_BAD_POSITION);
    }
    REJECTED(mslip_slip(NULL, force, 4, x, out[0], out[1]), MSLIP_NULL_POINTER);
    REJECTED(mslip_slip(&contact, force, 4, NULL, out[0], out[1]), MSLIP_NULL_POINTER);
    for (int i = 0; i < UNINITIALISED; ++i) {
        const mslip_contact uninitialised = uninitialised_contact(i);
        REJECTED(mslip_slip(&uninitialised, force, 4, x, out[0], out[1]), MSLIP_BAD_CONTACT);
    }
    CHECK(mslip_slip(&open, 0.0, 4, x, out[0], out[1]) == MSLIP_OK);
    CHECK(out[0][1] == 0.0 && out[1][1] == 0.0);
}

static void test_hysteresis_loop(void)
{
    enum { POINTS = 16 };
    static const size_t n[2] = { POINTS, POINTS };
    const mslip_contact contact = flat_contact(), open = open_contact();
    double amplitude = 1.044617062707688214555373e-7;

    EVERY_SUBSET(2, n, mslip_hysteresis_loop(&contact, amplitude, POINTS, OUT(0), OUT(1)));
    CHECK(reference[0][0] == amplitude);
    CHECK_RELATIVE(reference[1][0], 66.89347200000000270847522, 1e-13);
    for (int i = 0; i < POINTS / 2; ++i) {
        CHECK_NEAR(reference[0][i], amplitude * cos(2.0 * PI * i / POINTS), 4.0 * DBL_EPSILON * amplitude);
        CHECK_NEAR(reference[1][i + POINTS / 2], -reference[1][i], 1e-13 * 66.9);
    }
    /* A quarter of a period after the reversal, Masing: 2 M(q) = amplitude. */
    double half = 0.5 * amplitude;
    CHECK(mslip_monotonic_force(&contact, 1, &half, out[0], NULL, NULL) == MSLIP_OK);
    CHECK_NEAR(reference[1][POINTS / 4], reference[1][0] - 2.0 * out[0][0], 1e-13 * 66.9);

    poison();
    CHECK(mslip_hysteresis_loop(&contact, amplitude, 0, out[0], out[1]) == MSLIP_OK && untouched());
    CHECK(mslip_hysteresis_loop(&contact, 0.0, 2, out[0], out[1]) == MSLIP_OK);
    CHECK(out[0][0] == 0.0 && out[1][0] == 0.0 && out[1][1] == 0.0);
    REJECTED(mslip_hysteresis_loop(&contact, -amplitude, 4, out[0], out[1]), MSLIP_BAD_AMPLITUDE);
    for (int i = 0; i < 3; ++i) {
        REJECTED(mslip_hysteresis_loop(&contact, not_finite[i], 4, out[0], out[1]), MSLIP_BAD_AMPLITUDE);
    }
    REJECTED(mslip_hysteresis_loop(NULL, amplitude, 4, out[0], out[1]), MSLIP_NULL_POINTER);
    for (int i = 0; i < UNINITIALISED; ++i) {
        const mslip_contact uninitialised = uninitialised_contact(i);
        REJECTED(mslip_hysteresis_loop(&uninitialised, amplitude, 4, out[0], out[1]), MSLIP_BAD_CONTACT);
    }
    CHECK(mslip_hysteresis_loop(&open, amplitude, 4, NULL, out[1]) == MSLIP_OK);
    CHECK(out[1][0] == 0.0 && out[1][1] == 0.0 && out[1][2] == 0.0 && out[1][3] == 0.0);
}

static void test_dissipated_energy(void)
{
    static const size_t n[1] = { 3 };
    const mslip_contact contact = flat_contact(), open = open_contact();
    double force[3] = { 0.0, 52.02825599999999894862412, 0.0 };
    double bad[2] = { 1.0, 0.0 };

    force[2] = contact.slip_force;
    EVERY_SUBSET(1, n, mslip_dissipated_energy(&contact, 3, force, OUT(0)));
    CHECK(reference[0][0] == 0.0);
    CHECK_RELATIVE(reference[0][1], 4.484095259973649129007684e-9, 1e-13);
    CHECK_RELATIVE(reference[0][2], contact.slip_energy, 1e-13);

    poison();
    CHECK(mslip_dissipated_energy(&contact, 0, force, out[0]) == MSLIP_OK && untouched());
    bad[1] = -1.0;
    REJECTED(mslip_dissipated_energy(&contact, 2, bad, out[0]), MSLIP_BAD_FORCE_AMPLITUDE);
    bad[1] = 1.01 * contact.slip_force;
    REJECTED(mslip_dissipated_energy(&contact, 2, bad, out[0]), MSLIP_FORCE_EXCEEDS_SLIP);
    for (int i = 0; i < 3; ++i) {
        bad[1] = not_finite[i];
        REJECTED(mslip_dissipated_energy(&contact, 2, bad, out[0]), MSLIP_BAD_FORCE_AMPLITUDE);
    }
    REJECTED(mslip_dissipated_energy(NULL, 1, force, out[0]), MSLIP_NULL_POINTER);
    REJECTED(mslip_dissipated_energy(&contact, 1, NULL, out[0]), MSLIP_NULL_POINTER);
    for (int i = 0; i < UNINITIALISED; ++i) {
        const mslip_contact uninitialised = uninitialised_contact(i);
        REJECTED(mslip_dissipated_energy(&uninitialised, 1, force, out[0]), MSLIP_BAD_CONTACT);
    }
    CHECK(mslip_dissipated_energy(&open, 1, force, out[0]) == MSLIP_OK && out[0][0] == 0.0);
}

static void test_complex_stiffness(void)
{
    static const size_t n[4] = { 3, 3, 3, 3 };
    const mslip_contact contact = flat_contact(), open = open_contact();
    const double amplitude[3] = { 0.0, 8.126045554707419915799969e-8, 1.741295476008732971448891e-7 };
    double bad[2] = { 1e-8, 0.0 };

    EVERY_SUBSET(4, n, mslip_complex_stiffness(&contact, 3, amplitude, OUT(0), OUT(1), OUT(2), OUT(3)));
    CHECK(reference[0][0] == contact.initial_stiffness && reference[1][0] == 0.0);
    CHECK(isfinite(reference[2][0]) && isfinite(reference[3][0]));
    CHECK_RELATIVE(reference[0][1], 6.405352888907346572928486e8, 1e-13);
    CHECK_RELATIVE(reference[1][1], 2.164458549776912572520963e5, 1e-13);
    CHECK_RELATIVE(reference[2][1], -6.607999923090809247957577e12, 1e-9);
    CHECK_RELATIVE(reference[3][1], 3.27862057261536322870796e12, 1e-9);
    CHECK_RELATIVE(reference[0][2], 4.533728628514166399295569e8, 1e-13);
    CHECK_RELATIVE(reference[1][2], 1.813168961661543728829526e8, 1e-13);

    poison();
    CHECK(mslip_complex_stiffness(&contact, 0, amplitude, out[0], out[1], out[2], out[3]) == MSLIP_OK && untouched());
    bad[1] = -1e-8;
    REJECTED(mslip_complex_stiffness(&contact, 2, bad, out[0], out[1], out[2], out[3]), MSLIP_BAD_AMPLITUDE);
    for (int i = 0; i < 3; ++i) {
        bad[1] = not_finite[i];
        REJECTED(mslip_complex_stiffness(&contact, 2, bad, out[0], out[1], out[2], out[3]), MSLIP_BAD_AMPLITUDE);
    }
    REJECTED(mslip_complex_stiffness(NULL, 1, amplitude, out[0], out[1], out[2], out[3]), MSLIP_NULL_POINTER);
    REJECTED(mslip_complex_stiffness(&contact, 1, NULL, out[0], out[1], out[2], out[3]), MSLIP_NULL_POINTER);
    for (int i = 0; i < UNINITIALISED; ++i) {
        const mslip_contact uninitialised = uninitialised_contact(i);
        REJECTED(mslip_complex_stiffness(&uninitialised, 1, amplitude, out[0], out[1], out[2], out[3]), MSLIP_BAD_CONTACT);
    }
    CHECK(mslip_complex_stiffness(&open, 3, amplitude, out[0], out[1], out[2], out[3]) == MSLIP_OK);
    for (int i = 0; i < 3; ++i) {
        CHECK(out[0][i] == 0.0 && out[1][i] == 0.0 && out[2][i] == 0.0 && out[3][i] == 0.0);
    }
}

/* No friction: pressure, and no tangential force. */
static void test_frictionless(void)
{
    mslip_parameters p = flat_parameters();
    mslip_contact contact;
    const double zero = 0.0, displacement = 1e-6, force = 1e-3;
    double state[64];
    size_t length = mslip_state_length(1);

    p.friction_coefficient = 0.0;
    CHECK(mslip_contact_init(&p, &contact) == MSLIP_OK);
    CHECK(mslip_monotonic_force(&contact, 1, &displacement, out[0], out[1], out[2]) == MSLIP_OK);
    CHECK(out[0][0] == 0.0 && out[1][0] == 0.0 && out[2][0] == 0.0);
    CHECK(mslip_monotonic_displacement(&contact, 1, &zero, out[0], out[1], out[2]) == MSLIP_OK && out[0][0] == 0.0);
    REJECTED(mslip_monotonic_displacement(&contact, 1, &force, out[0], out[1], out[2]), MSLIP_FORCE_EXCEEDS_SLIP);
    CHECK(mslip_tractions(&contact, 0.0, 1, &zero, out[0], out[1]) == MSLIP_OK);
    CHECK(out[0][0] > 0.0 && out[1][0] == 0.0);
    CHECK(mslip_slip(&contact, 0.0, 1, &zero, out[0], out[1]) == MSLIP_OK && out[0][0] == 0.0 && out[1][0] == 0.0);
    CHECK(mslip_complex_stiffness(&contact, 1, &displacement, out[0], out[1], out[2], out[3]) == MSLIP_OK);
    CHECK(out[0][0] == 0.0 && out[1][0] == 0.0 && out[2][0] == 0.0 && out[3][0] == 0.0);
    CHECK(mslip_hysteresis_loop(&contact, 1e-6, 1, out[0], out[1]) == MSLIP_OK && out[1][0] == 0.0);
    CHECK(mslip_state_init(length, state) == MSLIP_OK);
    CHECK(mslip_masing_update(&contact, length, state, 1e-6, state, out[0], out[1], out[2]) == MSLIP_OK);
    CHECK(mslip_masing_update(&contact, length, state, -1e-6, state, out[0], out[1], out[2]) == MSLIP_OK);
    CHECK(out[0][0] == 0.0 && out[1][0] == 0.0 && out[2][0] == 0.0);
}

/* The smallest and the largest displacements have finite results. */
static void test_extremes(void)
{
    static const double size[] = { 5e-324, 1e-300, 1e-150, 1.0, 1e100, 1e150 };
    const mslip_contact contacts[3] = { flat_contact(), cylinder_contact(), elliptic_contact() };
    double state[64];
    size_t length = mslip_state_length(2);

    for (int c = 0; c < 3; ++c) {
        const mslip_contact *contact = &contacts[c];
        for (size_t i = 0; i < sizeof size / sizeof *size; ++i) {
            const double large = size[i] > 0.5;
            CHECK(mslip_complex_stiffness(contact, 1, &size[i], out[0], out[1], out[2], out[3]) == MSLIP_OK);
            CHECK(isfinite(out[0][0]) && isfinite(out[1][0]) && isfinite(out[2][0]) && isfinite(out[3][0]));
            CHECK(out[0][0] >= 0.0 && out[0][0] <= contact->initial_stiffness * (1.0 + 1e-15) && out[1][0] >= 0.0);
            CHECK(mslip_monotonic_force(contact, 1, &size[i], out[0], out[1], out[2]) == MSLIP_OK);
            CHECK(large ? out[0][0] == contact->slip_force
                        : is_near(out[0][0], contact->initial_stiffness * size[i], 1e-15 * out[0][0] + 1e-300));
            CHECK(mslip_hysteresis_loop(contact, size[i], 8, out[0], out[1]) == MSLIP_OK);
            CHECK(fabs(out[1][3]) <= contact->slip_force && fabs(out[0][3]) <= size[i]);
            CHECK(mslip_jenkins_equivalent(contact, size[i], out[0], out[1]) == MSLIP_OK);
            CHECK(isfinite(out[0][0]) && out[0][0] >= 0.0 && isfinite(out[1][0]) && out[1][0] >= 0.0);
            CHECK(mslip_state_init(length, state) == MSLIP_OK);
            CHECK(mslip_masing_update(contact, length, state, size[i], state, out[0], out[1], out[2]) == MSLIP_OK);
            CHECK(mslip_masing_update(contact, length, state, -size[i], state, out[0], out[1], out[2]) == MSLIP_OK);
            CHECK(isfinite(out[2][0]) && out[2][0] >= 0.0 && (!large || out[0][0] == -contact->slip_force));
        }
    }
}

int main(int argc, char **argv)
{
    check_arguments(argc, argv);
    test_version();
    test_status();
    test_contact_init();
    test_contact_values();
    test_elliptic_init();
    test_monotonic_displacement();
    test_monotonic_force();
    test_onset_of_gross_slip();
    test_tractions();
    test_slip();
    test_hysteresis_loop();
    test_dissipated_energy();
    test_complex_stiffness();
    test_frictionless();
    test_extremes();
    return check_report();
}
