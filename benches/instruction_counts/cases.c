/* cases.c: one call for each case, between the marks that callgrind counts by. Every call is made once before it is counted,
   so that what the loader does the first time is not counted; and so no call may change its own input. */
#include <microslip.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <valgrind/callgrind.h>
#ifdef __GLIBC__
#include <gnu/libc-version.h>
#endif

enum { POINTS = 100, CONTACTS = 100, AMPLITUDES = 20, SLIDERS = 10 };
enum { REVERSALS = 16, LENGTH = 5 + 3 * REVERSALS }; /* of a state */
enum { HARMONICS = 9, SAMPLES = 256, N = 2 * HARMONICS + 1 }; /* at most */

static const double PI = 3.14159265358979323846;

static mslip_parameters flat_parameters;
static mslip_elliptic_parameters ellipse_parameters;
static mslip_contact flat, cylinder, ellipse, open_contact;

/* Room for the outputs of any case. */
static double out[4][CONTACTS * N * N];

static void check(const char *name, int32_t status)
{
    if (status != MSLIP_OK) {
        fprintf(stderr, "%s: %s\n", name, mslip_status_text(status));
        exit(1);
    }
}

#define COUNT(name, call) \
    do { \
        int32_t status_; \
        check(name, (call)); \
        CALLGRIND_ZERO_STATS; \
        status_ = (call); \
        CALLGRIND_DUMP_STATS_AT(name); \
        check(name, status_); \
    } while (0)

/* What the numbers depend on beside the library: the mathematical library, and the processor that it sees. */
static void print_host(void)
{
#ifdef __GLIBC__
    printf("# libc: glibc %s\n", gnu_get_libc_version());
#else
    printf("# libc: unknown\n");
#endif
#if defined(__x86_64__) && defined(__GNUC__)
    printf("# processor: x86-64%s%s\n", __builtin_cpu_supports("avx2") ? " avx2" : "",
           __builtin_cpu_supports("fma") ? " fma" : "");
#else
    printf("# processor: other\n");
#endif
}

static void prepare(void)
{
    mslip_parameters p;
    mslip_elliptic_parameters e;

    mslip_parameters_default(&p);
    p.flat_half_width = 3e-4;
    p.edge_radius = 2e-3;
    p.length = 2e-2;
    p.normal_force = 200.0;
    p.friction_coefficient = 0.4;
    p.material[0].young_modulus = p.material[1].young_modulus = 2e11;
    p.material[0].poisson_ratio = p.material[1].poisson_ratio = 0.3;
    flat_parameters = p;
    check("flat", mslip_contact_init(&p, &flat));
    p.flat_half_width = 0.0;
    check("cylinder", mslip_contact_init(&p, &cylinder));
    p.normal_force = 0.0;
    check("open", mslip_contact_init(&p, &open_contact));

    mslip_elliptic_parameters_default(&e);
    e.semi_axis_x = 8e-4;
    e.semi_axis_y = 1.5e-3;
    e.normal_force = 50.0;
    e.friction_coefficient = 0.9;
    e.material[0] = e.material[1] = p.material[0];
    ellipse_parameters = e;
    check("ellipse", mslip_contact_init_elliptic(&e, &ellipse));
}

static void count_preparation(void)
{
    static mslip_contact contact;
    mslip_parameters p = flat_parameters;

    COUNT("contact_init.flat", mslip_contact_init(&p, &contact));
    p.flat_half_width = 0.0;
    COUNT("contact_init.cylinder", mslip_contact_init(&p, &contact));
    COUNT("contact_init.ellipse", mslip_contact_init_elliptic(&ellipse_parameters, &contact));
}

/* From a hundredth of an end to the end. */
static void spread(double end, double *points)
{
    for (int i = 0; i < POINTS; ++i) {
        points[i] = end * (i + 1) / POINTS;
    }
}

static void count_curve(void)
{
    double u[POINTS], far[POINTS], force[POINTS], x[POINTS];
    const double some = 0.7 * flat.slip_force;

    spread(0.99 * flat.slip_displacement, u);
    spread(0.99 * flat.slip_force, force);
    spread(flat.half_width, x);
    for (int i = 0; i < POINTS; ++i) {
        far[i] = flat.slip_displacement * (2 + i);
    }
    COUNT("monotonic_force.nothing", mslip_monotonic_force(&flat, POINTS, u, NULL, NULL, NULL));
    COUNT("monotonic_force.force", mslip_monotonic_force(&flat, POINTS, u, out[0], NULL, NULL));
    COUNT("monotonic_force.stiffness", mslip_monotonic_force(&flat, POINTS, u, out[0], out[1], NULL));
    COUNT("monotonic_force.stick", mslip_monotonic_force(&flat, POINTS, u, out[0], NULL, out[2]));
    COUNT("monotonic_force.all", mslip_monotonic_force(&flat, POINTS, u, out[0], out[1], out[2]));
    COUNT("monotonic_force.slip", mslip_monotonic_force(&flat, POINTS, far, out[0], out[1], out[2]));
    COUNT("monotonic_displacement.nothing", mslip_monotonic_displacement(&flat, POINTS, force, NULL, NULL, NULL));
    COUNT("monotonic_displacement.displacement", mslip_monotonic_displacement(&flat, POINTS, force, out[0], NULL, NULL));
    COUNT("monotonic_displacement.all", mslip_monotonic_displacement(&flat, POINTS, force, out[0], out[1], out[2]));
    COUNT("dissipated_energy.nothing", mslip_dissipated_energy(&flat, POINTS, force, NULL));
    COUNT("dissipated_energy.energy", mslip_dissipated_energy(&flat, POINTS, force, out[0]));
    COUNT("tractions.nothing", mslip_tractions(&flat, some, POINTS, x, NULL, NULL));
    COUNT("tractions.pressure", mslip_tractions(&flat, some, POINTS, x, out[0], NULL));
    COUNT("tractions.all", mslip_tractions(&flat, some, POINTS, x, out[0], out[1]));
    COUNT("slip.nothing", mslip_slip(&flat, some, POINTS, x, NULL, NULL));
    COUNT("slip.slip", mslip_slip(&flat, some, POINTS, x, out[0], NULL));
    COUNT("slip.all", mslip_slip(&flat, some, POINTS, x, out[0], out[1]));

    spread(0.99 * cylinder.slip_displacement, u);
    COUNT("monotonic_force.cylinder", mslip_monotonic_force(&cylinder, POINTS, u, out[0], NULL, NULL));
    spread(0.99 * ellipse.slip_displacement, u);
    COUNT("monotonic_force.ellipse", mslip_monotonic_force(&ellipse, POINTS, u, out[0], NULL, NULL));
}

static void count_memory(void)
{
    static double initial[LENGTH], nested[LENGTH], sliding[LENGTH], end[LENGTH];
    const double slip = flat.slip_displacement, reversals[4] = { 0.8 * slip, -0.6 * slip, 0.4 * slip, -0.2 * slip };
    double path[POINTS], rising[POINTS], away[POINTS], x[POINTS];
    const size_t length = LENGTH;

    check("state", mslip_state_length(REVERSALS) == LENGTH ? mslip_state_init(length, initial) : MSLIP_STATE_TOO_SHORT);
    check("nested", mslip_masing_path(&flat, length, initial, 4, reversals, nested, NULL, NULL, NULL));
    check("sliding", mslip_masing_update(&flat, length, initial, 3.0 * slip, sliding, NULL, NULL, NULL));
    COUNT("masing_update.nothing", mslip_masing_update(&flat, length, nested, 0.1 * slip, NULL, NULL, NULL, NULL));
    COUNT("masing_update.initial", mslip_masing_update(&flat, length, initial, 0.5 * slip, end, out[0], out[1], NULL));
    COUNT("masing_update.initial_energy",
          mslip_masing_update(&flat, length, initial, 0.5 * slip, end, out[0], out[1], out[2]));
    COUNT("masing_update.nested", mslip_masing_update(&flat, length, nested, 0.1 * slip, end, out[0], out[1], NULL));
    COUNT("masing_update.nested_energy",
          mslip_masing_update(&flat, length, nested, 0.1 * slip, end, out[0], out[1], out[2]));
    COUNT("masing_update.slip", mslip_masing_update(&flat, length, sliding, 4.0 * slip, end, out[0], out[1], out[2]));
    COUNT("masing_update.into_slip", mslip_masing_update(&flat, length, initial, 2.0 * slip, end, out[0], out[1], out[2]));

    /* Two periods; one rise; gross slip from the first step on. */
    for (int i = 0; i < POINTS; ++i) {
        path[i] = 0.8 * slip * sin(4.0 * PI * (i + 0.5) / POINTS);
        rising[i] = 0.9 * slip * (i + 1) / POINTS;
        away[i] = slip * (2 + i);
    }
    COUNT("masing_path.state", mslip_masing_path(&flat, length, initial, POINTS, path, end, NULL, NULL, NULL));
    COUNT("masing_path.force", mslip_masing_path(&flat, length, initial, POINTS, path, end, out[0], NULL, NULL));
    COUNT("masing_path.stiffness", mslip_masing_path(&flat, length, initial, POINTS, path, end, out[0], out[1], NULL));
    COUNT("masing_path.energy", mslip_masing_path(&flat, length, initial, POINTS, path, end, NULL, NULL, out[2]));
    COUNT("masing_path.all", mslip_masing_path(&flat, length, initial, POINTS, path, end, out[0], out[1], out[2]));
    COUNT("masing_path.rising", mslip_masing_path(&flat, length, initial, POINTS, rising, end, out[0], out[1], out[2]));
    COUNT("masing_path.slip", mslip_masing_path(&flat, length, initial, POINTS, away, end, out[0], out[1], out[2]));
    COUNT("masing_path.first_slips", mslip_masing_path(&flat, length, initial, 1, away, end, out[0], out[1], out[2]));
    COUNT("masing_path.next_slips", mslip_masing_path(&flat, length, sliding, 1, away + 2, end, out[0], out[1], out[2]));

    spread(flat.half_width, x);
    COUNT("masing_tractions.all", mslip_masing_tractions(&flat, length, nested, POINTS, x, out[0], out[1]));
}

static void count_cycles(void)
{
    double amplitude[AMPLITUDES], far[AMPLITUDES];

    for (int i = 0; i < AMPLITUDES; ++i) {
        amplitude[i] = flat.slip_displacement * (i + 0.5) / AMPLITUDES;
        far[i] = flat.slip_displacement * (2 + i);
    }
    COUNT("complex_stiffness.nothing", mslip_complex_stiffness(&flat, AMPLITUDES, amplitude, NULL, NULL, NULL, NULL));
    COUNT("complex_stiffness.real", mslip_complex_stiffness(&flat, AMPLITUDES, amplitude, out[0], NULL, NULL, NULL));
    COUNT("complex_stiffness.imaginary", mslip_complex_stiffness(&flat, AMPLITUDES, amplitude, NULL, out[1], NULL, NULL));
    COUNT("complex_stiffness.real_slope", mslip_complex_stiffness(&flat, AMPLITUDES, amplitude, NULL, NULL, out[2], NULL));
    COUNT("complex_stiffness.imaginary_slope",
          mslip_complex_stiffness(&flat, AMPLITUDES, amplitude, NULL, NULL, NULL, out[3]));
    COUNT("complex_stiffness.all", mslip_complex_stiffness(&flat, AMPLITUDES, amplitude, out[0], out[1], out[2], out[3]));
    COUNT("complex_stiffness.slip", mslip_complex_stiffness(&flat, AMPLITUDES, far, out[0], out[1], out[2], out[3]));
    COUNT("jenkins_equivalent.all", mslip_jenkins_equivalent(&flat, amplitude[AMPLITUDES / 2], out[0], out[1]));
    COUNT("iwan_equivalent.all", mslip_iwan_equivalent(&flat, SLIDERS, out[0], out[1], out[2]));
    COUNT("hysteresis_loop.nothing", mslip_hysteresis_loop(&flat, amplitude[15], POINTS, NULL, NULL));
    COUNT("hysteresis_loop.displacement", mslip_hysteresis_loop(&flat, amplitude[15], POINTS, out[0], NULL));
    COUNT("hysteresis_loop.all", mslip_hysteresis_loop(&flat, amplitude[15], POINTS, out[0], out[1]));
}

static double *workspace(size_t harmonics, size_t samples, int32_t rule)
{
    size_t length = mslip_harmonic_workspace_length(harmonics, samples, rule);
    double *w = malloc(length * sizeof *w);

    check("workspace", w == NULL ? MSLIP_NULL_POINTER : mslip_harmonic_workspace_init(harmonics, samples, rule, length, w));
    return w;
}

/* The cases of one pair of harmonics and samples; NAME is a literal. */
#define COUNT_HARMONIC(name, w, u) \
    do { \
        COUNT(name ".nothing", mslip_harmonic_force(&flat, w, u, NULL, NULL, NULL)); \
        COUNT(name ".force", mslip_harmonic_force(&flat, w, u, out[0], NULL, NULL)); \
        COUNT(name ".jacobian", mslip_harmonic_force(&flat, w, u, out[0], out[1], NULL)); \
        COUNT(name ".energy", mslip_harmonic_force(&flat, w, u, out[0], NULL, out[2])); \
        COUNT(name ".all", mslip_harmonic_force(&flat, w, u, out[0], out[1], out[2])); \
    } while (0)

static void count_harmonic_force(void)
{
    /* One harmonic with a mean; and one motion with even harmonics, and without. */
    const double slip = flat.slip_displacement;
    const double one[3] = { 0.05 * slip, 0.7 * slip, 0.2 * slip };
    const double odd[N] = { 0.0, 0.7 * slip, 0.2 * slip, 0.0, 0.0, 0.05 * slip, 0.03 * slip };
    double even[N], far[N], half_way[SAMPLES];
    double *w1 = workspace(1, 64, MSLIP_UNIFORM_SAMPLING), *w5 = workspace(5, 128, MSLIP_UNIFORM_SAMPLING);
    double *w9 = workspace(9, 256, MSLIP_UNIFORM_SAMPLING), *event_driven = workspace(5, 128, MSLIP_EVENT_DRIVEN);

    for (int i = 0; i < N; ++i) {
        even[i] = odd[i];
        far[i] = 1e3 * odd[i];
    }
    even[0] = 0.05 * slip, even[3] = 0.04 * slip;
    COUNT_HARMONIC("harmonic_force.1x64", w1, one);
    COUNT_HARMONIC("harmonic_force.5x128", w5, even);
    COUNT_HARMONIC("harmonic_force.9x256", w9, even);
    COUNT("harmonic_force.5x128.odd_force", mslip_harmonic_force(&flat, w5, odd, out[0], NULL, NULL));
    COUNT("harmonic_force.5x128.odd_jacobian", mslip_harmonic_force(&flat, w5, odd, out[0], out[1], NULL));
    COUNT("harmonic_force.5x128.odd_all", mslip_harmonic_force(&flat, w5, odd, out[0], out[1], out[2]));
    COUNT("harmonic_force.5x128.slip", mslip_harmonic_force(&flat, w5, far, out[0], out[1], out[2]));
    COUNT("harmonic_force.5x128.open", mslip_harmonic_force(&open_contact, w5, even, out[0], out[1], out[2]));

    COUNT_HARMONIC("harmonic_force.5x128.event_driven", event_driven, even);
    const size_t length = mslip_harmonic_workspace_length(5, 128, MSLIP_UNIFORM_SAMPLING);
    COUNT("harmonic_workspace_init.5x128", mslip_harmonic_workspace_init(5, 128, MSLIP_UNIFORM_SAMPLING, length, w5));

    /* What a harmonic force needs at least: a point of the curve for each sample, at half the distance from the last reversal. */
    for (int i = 0; i < SAMPLES; ++i) {
        half_way[i] = 0.35 * slip * (1.0 - cos(2.0 * PI * (i + 0.5) / 64.0));
    }
    COUNT("samples.1x64.points", mslip_monotonic_force(&flat, 64, half_way, out[0], NULL, NULL));
    COUNT("samples.5x128.points", mslip_monotonic_force(&flat, 128, half_way, out[0], NULL, NULL));
    COUNT("samples.9x256.points", mslip_monotonic_force(&flat, 256, half_way, out[0], NULL, NULL));
    free(w1), free(w5), free(w9), free(event_driven);
}

static void count_batches(void)
{
    static mslip_contact contacts[CONTACTS], open_ones[CONTACTS];
    static double u[CONTACTS], coefficients[3 * CONTACTS], states[CONTACTS * LENGTH], ends[CONTACTS * LENGTH];
    static const int32_t inactive[CONTACTS], shared[CONTACTS];
    double *w = workspace(1, 64, MSLIP_UNIFORM_SAMPLING);

    for (int i = 0; i < CONTACTS; ++i) {
        contacts[i] = flat;
        open_ones[i] = open_contact;
        u[i] = coefficients[3 * i + 1] = flat.slip_displacement * (i + 0.5) / CONTACTS;
        coefficients[3 * i] = 0.05 * u[i];
        check("state", mslip_state_init(LENGTH, states + i * LENGTH));
    }
#define COUNT_BATCHES(name, n_contacts, c, index, active) \
    do { \
        COUNT("batch_complex_stiffness." name, \
              mslip_batch_complex_stiffness(CONTACTS, n_contacts, c, index, active, u, out[0], out[1], out[2], out[3])); \
        COUNT("batch_masing_update." name, \
              mslip_batch_masing_update(CONTACTS, n_contacts, c, index, active, LENGTH, states, u, ends, out[0], out[1], \
                                        out[2])); \
        COUNT("batch_harmonic_force." name, \
              mslip_batch_harmonic_force(CONTACTS, n_contacts, c, index, active, w, coefficients, out[0], out[1], out[2])); \
    } while (0)
    COUNT_BATCHES("all", CONTACTS, contacts, NULL, NULL);
    COUNT_BATCHES("shared", 1, &flat, shared, NULL);
    COUNT_BATCHES("inactive", CONTACTS, contacts, NULL, inactive);
    COUNT_BATCHES("open", CONTACTS, open_ones, NULL, NULL);
    COUNT("batch_complex_stiffness.singly", mslip_complex_stiffness(&flat, CONTACTS, u, out[0], out[1], out[2], out[3]));
    free(w);
}

int main(void)
{
    print_host();
    prepare();
    count_preparation();
    count_curve();
    count_memory();
    count_cycles();
    count_harmonic_force();
    count_batches();
    return 0;
}
