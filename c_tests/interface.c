/* What the reference tables do not cover: the version, limits of the parameters, the ends of the curves, open and frictionless
   contacts, and spring-slider equivalents. */
#include "calls.h"

enum { CAPACITY = 32 };
static const double PI = 3.14159265358979323846;
static double out[4][CAPACITY];

static void test_version(void)
{
    char text[64];
    snprintf(text, sizeof text, "%d.%d.%d", MSLIP_VERSION_MAJOR, MSLIP_VERSION_MINOR, MSLIP_VERSION_PATCH);
    CHECK(strcmp(mslip_version(), text) == 0 && mslip_abi_version() == MSLIP_ABI_VERSION);
}

static void test_parameters(void)
{
    mslip_parameters p = flat_parameters();
    mslip_elliptic_parameters e = elliptic_parameters();
    mslip_contact contact, other;

    /* Incompressible bodies, and one stiff on one soft; the order of the bodies does not matter. */
    p.material[0].poisson_ratio = 0.5;
    p.material[1].poisson_ratio = 0.0;
    p.material[1].young_modulus = 1e9;
    CHECK(mslip_contact_init(&p, &contact) == MSLIP_OK);
    CHECK_RELATIVE(contact.composite_modulus, 1.0 / (0.75 / 2e11 + 1.0 / 1e9), 1e-15);
    const mslip_material first = p.material[0];
    p.material[0] = p.material[1];
    p.material[1] = first;
    CHECK(mslip_contact_init(&p, &other) == MSLIP_OK);
    CHECK_RELATIVE(other.initial_stiffness, contact.initial_stiffness, 1e-15);

    /* A rigid strip is stiffer than the centre point of the paper, by a few per cent. */
    p = flat_parameters();
    contact = contact_of(FLAT);
    p.displacement_reference = MSLIP_RIGID_STRIP;
    CHECK(mslip_contact_init(&p, &other) == MSLIP_OK);
    CHECK(other.initial_stiffness > 1.05 * contact.initial_stiffness && other.initial_stiffness < 1.15 * contact.initial_stiffness);
    CHECK(other.half_width == contact.half_width && other.slip_energy == contact.slip_energy);

    /* A sphere is Mindlin's: 8 G* a, with 1/G* the sum of (2-nu)/G. */
    contact = contact_of(ELLIPSE);
    CHECK(contact.half_width == e.semi_axis_x);
    e.semi_axis_y = e.semi_axis_x;
    CHECK(mslip_contact_init_elliptic(&e, &contact) == MSLIP_OK);
    CHECK_RELATIVE(contact.initial_stiffness, 8.0 * e.semi_axis_x / (2.0 * (2.0 - 0.45) * 2.0 * (1.0 + 0.45) / 2.1e11), 1e-13);
}

/* Both ends of the monotonic curve, by force and by displacement: at the onset of gross slip the stick zone is the flat, beyond it
   has no width; a force above mu N by a rounding error counts as mu N. */
static void test_ends_of_the_curve(void)
{
    static const double zero[2] = { 0.0, -0.0 };
    for (int kind = FLAT; kind <= ELLIPSE; ++kind) {
        const mslip_contact contact = contact_of(kind);
        const double stick = kind == FLAT ? 3e-4 : 0.0;
        CHECK(mslip_monotonic_displacement(&contact, 2, zero, out[0], out[1], out[2]) == MSLIP_OK);
        CHECK(out[0][0] == 0.0 && out[2][1] == contact.half_width);
        CHECK_RELATIVE(out[1][1], 1.0 / contact.initial_stiffness, 1e-13);
        CHECK(mslip_monotonic_force(&contact, 2, zero, out[0], out[1], out[2]) == MSLIP_OK);
        CHECK(out[0][0] == 0.0 && out[1][1] == contact.initial_stiffness && out[2][1] == contact.half_width);
        for (int sign = -1; sign <= 1; sign += 2) {
            const double slip = sign * contact.slip_displacement, force = sign * contact.slip_force;
            const double forces[] = { force, force * (1.0 + 2.0 * DBL_EPSILON) };
            const double displacements[] = { slip, sign * nextafter(fabs(slip), INFINITY), 2.0 * slip };
            CHECK(mslip_monotonic_displacement(&contact, 2, forces, out[0], out[1], out[2]) == MSLIP_OK);
            CHECK(out[0][0] == slip && out[0][1] == slip && out[2][0] == stick && out[2][1] == stick);
            CHECK(kind == FLAT ? isfinite(out[1][0]) : isinf(out[1][0]) && out[1][0] > 0.0);
            CHECK(mslip_monotonic_force(&contact, 3, displacements, out[0], out[1], out[2]) == MSLIP_OK);
            CHECK(out[0][0] == force && out[2][0] == stick);
            for (int k = 1; k < 3; ++k) {
                CHECK(out[0][k] == force && out[1][k] == 0.0 && out[2][k] == 0.0);
            }
        }
    }
}

static void test_tractions(void)
{
    enum { POINTS = 20000 };
    const mslip_contact contact = contact_of(FLAT), ellipse = contact_of(ELLIPSE);
    const mslip_elliptic_parameters e = elliptic_parameters();
    const double x[3] = { 2e-4, -2e-4, 4e-4 }, half = 0.5 * e.semi_axis_x, force = 37.16304;
    const double step = 2.0 * contact.half_width / POINTS, strip = step * flat_parameters().length;
    double load = 0.0, shear = 0.0;

    /* The pressure carries the normal force, the shear the tangential one. */
    for (int i = 0; i < POINTS; ++i) {
        const double position = -contact.half_width + (i + 0.5) * step;
        CHECK(mslip_tractions(&contact, force, 1, &position, out[0], out[1]) == MSLIP_OK);
        load += out[0][0] * strip;
        shear += out[1][0] * strip;
    }
    CHECK_RELATIVE(load, flat_parameters().normal_force, 1e-4);
    CHECK_RELATIVE(shear, force, 1e-4);
    /* Even, and zero outside; slip likewise. */
    CHECK(mslip_tractions(&contact, force, 3, x, out[0], out[1]) == MSLIP_OK);
    CHECK(out[0][0] == out[0][1] && out[1][0] == out[1][1] && out[0][2] == 0.0 && out[1][2] == 0.0);
    const double slip_x[4] = { 3.04e-4, -3.04e-4, 0.0, 3.1e-4 };
    CHECK(mslip_slip(&contact, force, 4, slip_x, out[0], out[1]) == MSLIP_OK);
    CHECK(out[0][0] > 0.0 && out[0][0] == out[0][1] && out[1][0] == out[1][1]);
    for (int i = 2; i < 4; ++i) {
        CHECK(out[0][i] == 0.0 && out[1][i] == 0.0);
    }
    /* Hertz's pressure on the x axis. */
    CHECK(mslip_tractions(&ellipse, 0.0, 1, &half, out[0], out[1]) == MSLIP_OK && out[1][0] == 0.0);
    CHECK_RELATIVE(out[0][0], 1.5 * e.normal_force / (PI * e.semi_axis_x * e.semi_axis_y) * sqrt(0.75), 1e-13);
}

static void test_hysteresis_loop(void)
{
    enum { POINTS = 16 };
    const mslip_contact contact = contact_of(FLAT);
    const double amplitude = 1.044617062707688214555373e-7, peak = 66.89347200000000270847522;
    CHECK(mslip_hysteresis_loop(&contact, amplitude, POINTS, out[0], out[1]) == MSLIP_OK && out[0][0] == amplitude);
    CHECK_RELATIVE(out[1][0], peak, 1e-13);
    for (int i = 0; i < POINTS / 2; ++i) {
        /* Masing: twice the monotonic force of half the displacement since the reversal. */
        const double half = 0.5 * (amplitude - out[0][i]);
        CHECK_NEAR(out[0][i], amplitude * cos(2.0 * PI * i / POINTS), 4.0 * DBL_EPSILON * amplitude);
        CHECK_NEAR(out[1][i + POINTS / 2], -out[1][i], 1e-13 * peak);
        CHECK(mslip_monotonic_force(&contact, 1, &half, out[2], NULL, NULL) == MSLIP_OK);
        CHECK_NEAR(out[1][i], peak - 2.0 * out[2][0], 1e-13 * peak);
    }
}

/* Without normal force or friction every output of a contact is zero, except the pressure under friction zero and displacements,
   compliances and states, which are not forces. */
static void test_no_tangential_force(void)
{
    make_regions();
    for (int i = 0; i < FUNCTIONS; ++i) {
        for (int kind = OPEN; kind <= FRICTIONLESS && !(functions[i].takes & IS_ELEMENT); ++kind) {
            const function *f = &functions[i];
            const int is_pressure = strstr(f->name, "tractions") != NULL;
            int zero = 1;
            set_up(f);
            for (size_t k = 0; k < items_of(f); ++k) {
                CONTACTS[k] = contact_of(kind);
            }
            fill_states(f);
            fill_table(f);
            call.scalar = f->scalar == FORCE ? 0.0 : call.scalar;
            for (size_t k = 0; k < f->inputs && (f->kind == FORCE || f->kind == FORCE_AMPLITUDE); ++k) {
                INPUT[k] = 0.0;
            }
            CHECK(f->call() == MSLIP_OK && raised() == 0);
            for (int k = 1; k < OUTPUTS; ++k) {
                const int is_force = !(is_pressure && k == 1 && kind == FRICTIONLESS) &&
                                     !(strstr(f->name, "hysteresis") && k == 1) && !(strstr(f->name, "monotonic_disp") && k > 1) &&
                                     !(strstr(f->name, "sensitivity") && k > 1);
                for (size_t j = 0; j < f->out[k] && is_force; ++j) {
                    zero &= call.out[k][j] == 0.0;
                }
            }
            if (!CHECK(zero && (!is_pressure || (call.out[1][2] > 0.0) == (kind == FRICTIONLESS)))) {
                printf("    %s, contact %d\n", f->name, kind);
            }
            if (f->kind == FORCE || f->kind == FORCE_AMPLITUDE) {
                INPUT[0] = 1e-3;
                CHECK(f->call() == MSLIP_FORCE_EXCEEDS_SLIP);
            }
        }
    }
}

/* Bounds of the results at the smallest and the largest displacements. */
static void test_extremes(void)
{
    static const double size[] = { 5e-324, 1e-300, 1e-150, 1.0, 1e100, 1e150 };
    double state[STATE];
    const size_t length = mslip_state_length(2);
    for (int kind = FLAT; kind <= ELLIPSE; ++kind) {
        const mslip_contact contact = contact_of(kind);
        for (size_t i = 0; i < LENGTH(size); ++i) {
            const int large = size[i] > 0.5;
            CHECK(mslip_complex_stiffness(&contact, 1, &size[i], out[0], out[1], out[2], out[3]) == MSLIP_OK);
            CHECK(out[0][0] >= 0.0 && out[0][0] <= contact.initial_stiffness * (1.0 + 1e-15) && out[1][0] >= 0.0);
            CHECK(mslip_monotonic_force(&contact, 1, &size[i], out[0], out[1], out[2]) == MSLIP_OK);
            CHECK(large ? out[0][0] == contact.slip_force
                        : is_near(out[0][0], contact.initial_stiffness * size[i], 1e-15 * out[0][0] + 1e-300));
            CHECK(mslip_hysteresis_loop(&contact, size[i], 8, out[0], out[1]) == MSLIP_OK);
            CHECK(fabs(out[1][3]) <= contact.slip_force && fabs(out[0][3]) <= size[i]);
            CHECK(mslip_jenkins_equivalent(&contact, size[i], out[0], out[1]) == MSLIP_OK);
            CHECK(isfinite(out[0][0]) && out[0][0] >= 0.0 && isfinite(out[1][0]) && out[1][0] >= 0.0);
            CHECK(mslip_state_init(length, state) == MSLIP_OK);
            CHECK(mslip_masing_update(&contact, length, state, size[i], state, out[0], out[1], out[2]) == MSLIP_OK);
            CHECK(mslip_masing_update(&contact, length, state, -size[i], state, out[0], out[1], out[2]) == MSLIP_OK);
            CHECK(isfinite(out[2][0]) && out[2][0] >= 0.0 && (!large || out[0][0] == -contact.slip_force));
        }
    }
}

/* The Jenkins element of this stiffness and slip force has the K' and K'' of the contact. */
static void test_jenkins_equivalent(void)
{
    const mslip_contact contact = contact_of(FLAT);
    const double amplitude = 1.741295476008732971448891e-7;
    double k, slip_force;
    CHECK(mslip_jenkins_equivalent(&contact, 0.0, &k, &slip_force) == MSLIP_OK);
    CHECK(k == contact.initial_stiffness && slip_force == contact.slip_force);
    CHECK(mslip_jenkins_equivalent(&contact, amplitude, &k, &slip_force) == MSLIP_OK);
    CHECK(slip_force > 0.0 && slip_force < k * amplitude);
    const double theta = acos(1.0 - 2.0 * slip_force / (k * amplitude));
    CHECK_RELATIVE(k / PI * (theta - 0.5 * sin(2.0 * theta)), 4.533728628514166399295569e8, 1e-12);
    CHECK_RELATIVE(4.0 * slip_force * (amplitude - slip_force / k) / (PI * amplitude * amplitude),
                   1.813168961661543728829526e8, 1e-12);
}

/* The reported error is the maximum, which a fine grid of displacements approaches and never exceeds. */
static void test_iwan_equivalent(void)
{
    enum { SLIDERS = 12, POINTS = 4001 };
    const mslip_contact contact = contact_of(FLAT);
    double sum = 0.0, largest = 0.0;
    CHECK(mslip_iwan_equivalent(&contact, SLIDERS, out[0], out[1], out[2]) == MSLIP_OK);
    for (int i = 0; i < SLIDERS; ++i) {
        CHECK(out[0][i] > 0.0 && out[1][i] > 0.0);
        sum += out[1][i];
    }
    CHECK_RELATIVE(sum, contact.slip_force, 1e-12);
    for (int i = 0; i < POINTS; ++i) {
        double displacement = 1.2 * contact.slip_displacement * i / (POINTS - 1), exact, force = 0.0;
        CHECK(mslip_monotonic_force(&contact, 1, &displacement, &exact, NULL, NULL) == MSLIP_OK);
        for (int j = 0; j < SLIDERS; ++j) {
            force += fmin(out[0][j] * displacement, out[1][j]);
        }
        largest = fmax(largest, fabs(force - exact) / contact.slip_force);
    }
    CHECK(largest <= out[2][0] * (1.0 + 1e-9) + 1e-14 && largest >= 0.9 * out[2][0] && out[2][0] < 0.1);
}

int main(int argc, char **argv)
{
    check_arguments(argc, argv);
    test_version();
    test_parameters();
    test_ends_of_the_curve();
    test_tractions();
    test_hysteresis_loop();
    test_no_tangential_force();
    test_extremes();
    test_jenkins_equivalent();
    test_iwan_equivalent();
    return check_report();
}
