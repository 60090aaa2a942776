/* calls.c: see calls.h. Inputs are computed by + - * / only, so that they are the same with every compiler. */
#include "calls.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* N: number of points and steps, for which the states are too short. MOST: arrays of a call. */
enum { N = 9, HARMONICS = 3, COEFFICIENTS = 7, SAMPLES = 64, PERIODS = 2, SLIDERS = 8, MOST = 8 };

/* Arrays of a call, whose bits are hashed (FNV-1a). */
typedef struct {
    uint64_t hash;
    double *array[MOST];
    size_t length[MOST], arrays;
} results;

static double *new_array(results *r, size_t n)
{
    double *array = (double *)malloc(n * sizeof *array);
    if (array == NULL || r->arrays == MOST) {
        abort();
    }
    r->length[r->arrays] = n;
    return r->array[r->arrays++] = array;
}

/* Outputs of these lengths. */
static double **outputs(results *r, size_t a, size_t b, size_t c, size_t d)
{
    double **first = r->array + r->arrays;
    const size_t lengths[4] = { a, b, c, d };
    for (int i = 0; i < 4 && lengths[i] > 0; ++i) {
        new_array(r, lengths[i]);
    }
    return first;
}

static void accept(int32_t status)
{
    if (status != MSLIP_OK && status != MSLIP_NOT_AVAILABLE && status != MSLIP_OUT_OF_RANGE && status != MSLIP_LENGTH_TOO_SHORT) {
        fprintf(stderr, "%s\n", mslip_status_text(status));
        abort();
    }
}

static void finish(results *r, int32_t status)
{
    accept(status);
    for (; r->arrays > 0; free(r->array[r->arrays])) {
        const unsigned char *byte = (const unsigned char *)r->array[--r->arrays];
        for (size_t i = 0; status == MSLIP_OK && i < r->length[r->arrays] * sizeof(double); ++i) {
            r->hash = (r->hash ^ byte[i]) * UINT64_C(0x100000001b3);
        }
    }
}

/* Multiples of a unit from microslip to gross slip, also next to its onset. */
static double *multiples(results *r, double unit, double largest)
{
    static const double all[N] = { 0.0, 1e-9, 0.3, 0.9, 0.9995, 1.0, 1.0005, 1.03, 2.5 };
    double *values = new_array(r, N);
    for (int i = 0; i < N; ++i) {
        values[i] = unit * (all[i] < largest ? all[i] : largest);
    }
    return values;
}

/* A motion with a mean and more than two reversals per period. */
static double *motion(results *r, double unit, size_t components, double normal)
{
    double *values = new_array(r, components * COEFFICIENTS);
    for (size_t i = 0; i < components * COEFFICIENTS; ++i) {
        const size_t k = i % COEFFICIENTS;
        const int is_normal = components > 1 && i / COEFFICIENTS == components - 1;
        values[i] = is_normal ? normal * (k == 0 ? 0.6 : k < 3 ? 0.25 : 0.0) : unit * (k == 1 ? 1.1 : k == 0 ? 0.1 : 0.9 / (double)k);
    }
    return values;
}

static void call_contact(results *r, const mslip_contact *c)
{
    const double force = c->slip_force, unit = c->slip_displacement;
    const size_t length = mslip_state_length(3), jacobian = COEFFICIENTS * COEFFICIENTS;
    double *x = multiples(r, c->half_width, 1.1), **o = outputs(r, N, N, 0, 0);
    finish(r, mslip_tractions(c, 0.3 * force, N, x, o[0], o[1]));
    x = multiples(r, c->half_width, 1.1), o = outputs(r, N, N, 0, 0);
    finish(r, mslip_slip(c, 0.3 * force, N, x, o[0], o[1]));
    x = multiples(r, force, 1.0), o = outputs(r, N, N, N, N);
    finish(r, mslip_monotonic_displacement(c, N, x, o[0], o[1], o[2]) | mslip_dissipated_energy(c, N, x, o[3]));
    x = multiples(r, unit, 3.0), o = outputs(r, N, N, N, MSLIP_PARAMETER_COUNT * N);
    finish(r, mslip_monotonic_force(c, N, x, o[0], o[1], o[2]) | mslip_monotonic_sensitivity(c, N, x, NULL, o[3]));
    x = multiples(r, unit, 3.0), o = outputs(r, N, N, N, N);
    finish(r, mslip_complex_stiffness(c, N, x, o[0], o[1], o[2], o[3]));
    o = outputs(r, N, N, SLIDERS, SLIDERS);
    finish(r, mslip_hysteresis_loop(c, 1.3 * unit, N, o[0], o[1]) | mslip_iwan_equivalent(c, SLIDERS, o[2], o[3], NULL));
    /* More nested reversals than the state can hold. */
    x = new_array(r, N);
    for (int i = 0; i < N; ++i) {
        x[i] = unit * (i % 2 == 0 ? 1.0 : -1.0) * (0.9 - 0.09 * (double)i);
    }
    o = outputs(r, length, N, N, N);
    accept(mslip_state_init(length, o[0]));
    finish(r, mslip_masing_path(c, length, o[0], N, x, o[0], o[1], o[2], o[3]));
    for (int32_t rule = MSLIP_UNIFORM_SAMPLING; rule <= MSLIP_EVENT_DRIVEN; ++rule) {
        const size_t n = mslip_harmonic_workspace_length(HARMONICS, SAMPLES, rule);
        double *workspace = (double *)malloc(n * sizeof *workspace);
        x = motion(r, unit, 1, 0.0), o = outputs(r, COEFFICIENTS, jacobian, 1, COEFFICIENTS * MSLIP_PARAMETER_COUNT);
        accept(mslip_harmonic_workspace_init(HARMONICS, SAMPLES, rule, n, workspace));
        accept(mslip_batch_harmonic_force(1, 1, c, NULL, NULL, workspace, x, o[0], o[1], o[2], NULL));
        finish(r, mslip_harmonic_sensitivity(c, workspace, x, NULL, o[3]));
        free(workspace);
    }
}

static void call_element(results *r, const mslip_element *e)
{
    const int32_t directions = e->directions;
    const size_t m = (size_t)directions + 1, length = mslip_element_state_length(directions, 4), all = m * COEFFICIENTS,
                 n = mslip_element_workspace_length(directions, HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING);
    const int by_force = e->normal_input == MSLIP_INPUT_NORMAL_FORCE;
    const double normal = by_force ? e->normal_force : e->approach;
    double *x = multiples(r, e->approach, 2.0), **o = outputs(r, N, N, N, 0);
    finish(r, mslip_normal_force(e, N, x, o[0], o[1], o[2]));
    x = multiples(r, e->normal_force, 2.0), o = outputs(r, N, N, N, 0);
    finish(r, mslip_normal_approach(e, N, x, o[0], o[1], o[2]));
    x = multiples(r, e->friction_coefficient * e->normal_force, 1.0), o = outputs(r, N, N, N, 0);
    for (int i = 0; i < N; ++i) {
        o[2][i] = e->normal_force;
    }
    finish(r, mslip_element_displacement(e, 0, N, x, o[2], o[0], o[1]));
    /* More pieces than the state can hold, slip, gross slip, separation. */
    x = new_array(r, m * N);
    for (size_t i = 0; i < m * N; ++i) {
        const size_t step = i / m;
        const double to_and_fro = (step + i) % 2 == 0 ? 1.0 : -1.0;
        x[i] = i % m == m - 1 ? normal * (step == 6 ? (by_force ? 0.0 : -0.1) : 0.1 + 0.1 * (double)step)
                              : e->approach * to_and_fro * (step == 5 ? 3.0 : 0.02 * (double)step);
    }
    o = outputs(r, length, m * N, m * m * N, N);
    memset(o[0], 0, length * sizeof(double)); /* a state is written as far as it is in use */
    accept(mslip_element_state_init(directions, length, o[0]));
    finish(r, mslip_element_path(e, length, o[0], N, x, o[0], o[1], o[2], o[3]));
    double *workspace = (double *)malloc(n * sizeof *workspace);
    x = motion(r, 0.3 * e->approach, m, normal), o = outputs(r, all, all * all, 1, 1);
    accept(mslip_element_workspace_init(directions, HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING, PERIODS, n, workspace));
    finish(r, mslip_batch_element_harmonic_force(1, 1, e, NULL, NULL, workspace, x, o[0], o[1], o[2], o[3], NULL));
    free(workspace);
}

/* A random factor within the given number of decades, from a sequence of random numbers; 1 if the sequence is 0. */
static double decades(uint64_t *sequence, int most)
{
    double factor = 1.0;
    if (*sequence != 0) {
        *sequence = *sequence * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        factor += (double)(*sequence >> 44) / 131072.0;
        for (uint64_t n = *sequence >> 33 & 1023; n % 16 > 0 && most-- > 0; n -= 1) {
            factor *= *sequence >> 43 & 1 ? 10.0 : 0.1;
        }
    }
    return factor;
}

/* Initialises one of the contacts and its element; from CONTACTS on with parameters over many decades, of which some are rejected: whether
   these are accepted. */
static int initialise(int which, mslip_contact *contact, mslip_element *element)
{
    enum { FLAT, CYLINDER, NEARLY_FLAT, RIGID, SHORT, ELLIPSE, SPHERE, LAYER, KINDS };
    const int kind = which % KINDS, size = which / KINDS;
    const int32_t normal_input = which / 3 % 2 == 0 ? MSLIP_INPUT_APPROACH : MSLIP_INPUT_NORMAL_FORCE, directions = 1 + size % 2;
    const mslip_material steel = { 2.1e11, 0.3 };
    uint64_t sequence = which < CONTACTS ? 0 : (uint64_t)which;
    int32_t status;
    if (kind == ELLIPSE || kind == SPHERE) {
        mslip_elliptic_parameters e;
        mslip_elliptic_parameters_default(&e);
        e.semi_axis_x = 8e-4 * decades(&sequence, 6);
        e.semi_axis_y = kind == SPHERE ? e.semi_axis_x : 1.5e-3 * decades(&sequence, 6);
        e.normal_force = (40.0 + size % 8) * decades(&sequence, 12);
        e.friction_coefficient = 0.4;
        e.material[0] = e.material[1] = steel;
        status = mslip_contact_init_elliptic(&e, contact) | mslip_element_init_elliptic(&e, directions, normal_input, element);
    } else {
        mslip_parameters p;
        mslip_parameters_default(&p);
        p.flat_half_width = kind == CYLINDER ? 0.0 : (kind == NEARLY_FLAT ? 1e-3 : 3e-4) * decades(&sequence, 9);
        p.edge_radius = (kind == NEARLY_FLAT ? 1e-7 : 2e-3) * decades(&sequence, 6);
        p.length = kind == SHORT ? 1e-3 : 2e-2;
        p.normal_force = (10.0 + size % 8) * decades(&sequence, 12);
        p.friction_coefficient = 0.4;
        p.displacement_reference = kind == RIGID ? MSLIP_RIGID_STRIP : MSLIP_CENTRE_POINT;
        p.material[0] = p.material[1] = steel;
        p.layer.normal_compliance = p.layer.tangential_compliance = kind == LAYER ? 1e-9 * decades(&sequence, 9) : 0.0;
        p.layer.stiffening_load = kind == LAYER ? decades(&sequence, 9) : p.layer.stiffening_load;
        status = mslip_contact_init(&p, contact) | mslip_element_init(&p, directions, normal_input, element);
    }
    if (status == MSLIP_OK ? mslip_contact_check(contact) != MSLIP_OK || mslip_element_check(element) != MSLIP_OK : which < CONTACTS) {
        abort();
    }
    return status == MSLIP_OK;
}

static uint64_t hash_of_one(const mslip_contact *contact, const mslip_element *element)
{
    results r;
    r.hash = UINT64_C(0xcbf29ce484222325);
    r.arrays = 0;
    call_contact(&r, contact);
    call_element(&r, element);
    return r.hash;
}

uint64_t hash_of_all(int others)
{
    mslip_contact contact;
    mslip_element *element = (mslip_element *)malloc(sizeof *element);
    uint64_t hash = mslip_abi_version() == MSLIP_ABI_VERSION;
    for (int which = 0; which < CONTACTS + others; ++which) {
        if (initialise(which, &contact, element)) {
            hash = hash * 31 + hash_of_one(&contact, element);
        }
    }
    free(element);
    return hash;
}
