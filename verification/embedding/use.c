/* use.c: see use.h. Inputs are made by + - * / alone, so that every compiler makes the same. */
#include "use.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 9, HARMONICS = 3, SAMPLES = 64, REVERSALS = 6, STEPS = 41, ITEMS = 2, SLIDERS = 7 };

uint64_t hashed(uint64_t hash, const void *bytes, size_t n)
{
    const unsigned char *byte = (const unsigned char *)bytes; /* FNV-1a */
    for (size_t i = 0; i < n; ++i) {
        hash = (hash ^ byte[i]) * UINT64_C(0x100000001b3);
    }
    return hash;
}

static double *doubles(size_t n)
{
    double *memory = (double *)malloc(n * sizeof *memory);
    if (memory == NULL) {
        abort();
    }
    return memory;
}

static void accept(int32_t status)
{
    if (status != MSLIP_OK) {
        fprintf(stderr, "%s\n", mslip_status_text(status));
        abort();
    }
}

/* Outputs of a call that succeeded: hashed and freed. */
static void take(struct visit *visit, double *output, size_t n)
{
    visit->hash = hashed(visit->hash, output, n * sizeof *output);
    free(output);
}

void initialise(int which, mslip_contact *contact)
{
    enum { FLAT, CYLINDER, NEARLY_FLAT, RIGID, SHORT, ELLIPSE, SPHERE, OPEN, KINDS };
    const int kind = which % KINDS, size = which / KINDS;
    const mslip_material steel = { 2.1e11, 0.3 };

    if (kind == ELLIPSE || kind == SPHERE) {
        mslip_elliptic_parameters p;
        mslip_elliptic_parameters_default(&p);
        p.semi_axis_x = 8e-4;
        p.semi_axis_y = kind == SPHERE ? 8e-4 : 1.5e-3;
        p.normal_force = 40.0 + size;
        p.friction_coefficient = 0.4;
        p.material[0] = p.material[1] = steel;
        accept(mslip_contact_init_elliptic(&p, contact));
        return;
    }
    mslip_parameters p;
    mslip_parameters_default(&p);
    p.flat_half_width = kind == CYLINDER ? 0.0 : kind == NEARLY_FLAT ? 1e-3 : 3e-4;
    p.edge_radius = kind == NEARLY_FLAT ? 1e-7 : 2e-3;
    p.length = kind == SHORT ? 1.7e-4 : 2e-2;
    p.normal_force = kind == OPEN ? 0.0 : 10.0 + size;
    p.friction_coefficient = 0.4;
    p.material[0] = p.material[1] = steel;
    p.displacement_reference = kind == RIGID ? MSLIP_RIGID_STRIP : MSLIP_CENTRE_POINT;
    accept(mslip_contact_init(&p, contact));
}

double *workspace(int32_t rule)
{
    const size_t n = mslip_harmonic_workspace_length(HARMONICS, SAMPLES, rule);
    double *memory = doubles(n);
    accept(mslip_harmonic_workspace_init(HARMONICS, SAMPLES, rule, n, memory));
    return memory;
}

/* Multiples of a unit from microslip to gross slip, the last stretch before it and the first beyond it included. */
static double *multiples(double unit, size_t n, double largest)
{
    static const double all[POINTS] = { 0.0, 1e-9, 0.3, 0.9, 0.9995, 1.0, 1.0005, 1.03, 2.5 };
    double *x = doubles(n);
    for (size_t i = 0; i < n; ++i) {
        const double multiple = all[i % POINTS];
        x[i] = unit * (multiple < largest ? multiple : largest);
    }
    return x;
}

/* Swings that grow and shrink. */
static double *path(const mslip_contact *contact, size_t n)
{
    double *x = doubles(n);
    for (size_t i = 0; i < n; ++i) {
        const double t = (double)(i % 9) - 4.0, sign = i % 2 == 0 ? 1.0 : -1.0;
        x[i] = contact->slip_displacement * (i % 3 == 0 ? 0.3 * t : sign * (0.9 - 0.1 * t));
    }
    return x;
}

static void tractions(struct visit *visit)
{
    double *x = multiples(visit->contact->half_width, POINTS, 1.1);
    double *pressure = doubles(POINTS), *shear = doubles(POINTS);
    accept(mslip_tractions(visit->contact, 0.7 * visit->contact->slip_force, POINTS, x, pressure, shear));
    take(visit, pressure, POINTS);
    take(visit, shear, POINTS);
    free(x);
}

static void slip(struct visit *visit)
{
    double *x = multiples(visit->contact->half_width, POINTS, 1.1);
    double *motion = doubles(POINTS), *damage = doubles(POINTS);
    const int32_t status = mslip_slip(visit->contact, 0.7 * visit->contact->slip_force, POINTS, x, motion, damage);
    if (status == MSLIP_NOT_AVAILABLE) {
        free(motion);
        free(damage);
    } else {
        accept(status);
        take(visit, motion, POINTS);
        take(visit, damage, POINTS);
    }
    free(x);
}

static void displacement(struct visit *visit)
{
    double *force = multiples(visit->contact->slip_force, POINTS, 1.0);
    double *motion = doubles(POINTS), *compliance = doubles(POINTS), *stick = doubles(POINTS);
    accept(mslip_monotonic_displacement(visit->contact, POINTS, force, motion, compliance, stick));
    take(visit, motion, POINTS);
    take(visit, compliance, POINTS);
    take(visit, stick, POINTS);
    free(force);
}

static void force(struct visit *visit)
{
    double *motion = multiples(visit->contact->slip_displacement, POINTS, 3.0);
    double *response = doubles(POINTS), *stiffness = doubles(POINTS), *stick = doubles(POINTS);
    accept(mslip_monotonic_force(visit->contact, POINTS, motion, response, stiffness, stick));
    take(visit, response, POINTS);
    take(visit, stiffness, POINTS);
    take(visit, stick, POINTS);
    free(motion);
}

static void update(struct visit *visit)
{
    const size_t n = mslip_state_length(REVERSALS);
    double *before = doubles(n), *after = doubles(n), *response = doubles(3), *motion = path(visit->contact, STEPS);
    accept(mslip_state_init(n, before));
    for (size_t i = 0; i < STEPS; ++i) {
        accept(mslip_masing_update(visit->contact, n, before, motion[i], after, response, response + 1, response + 2));
        memcpy(before, after, n * sizeof *before);
        visit->hash = hashed(visit->hash, response, 3 * sizeof *response);
    }
    take(visit, after, n);
    free(before);
    free(response);
    free(motion);
}

/* The path has more nested reversals than the state: reversals are merged. */
static void whole_path(struct visit *visit)
{
    const size_t n = mslip_state_length(REVERSALS);
    double *state = doubles(n), *motion = path(visit->contact, STEPS);
    double *response = doubles(STEPS), *stiffness = doubles(STEPS), *energy = doubles(STEPS), error;
    accept(mslip_state_init(n, state));
    accept(mslip_masing_path(visit->contact, n, state, STEPS, motion, state, response, stiffness, energy));
    accept(mslip_state_check(n, state));
    accept(mslip_state_error(n, state, &error));
    visit->hash = hashed(visit->hash, &error, sizeof error);
    take(visit, state, n);
    take(visit, response, STEPS);
    take(visit, stiffness, STEPS);
    take(visit, energy, STEPS);
    free(motion);
}

static void tractions_after(struct visit *visit)
{
    const size_t n = mslip_state_length(REVERSALS);
    double *state = doubles(n), *motion = path(visit->contact, STEPS);
    double *x = multiples(visit->contact->half_width, POINTS, 1.1);
    double *pressure = doubles(POINTS), *shear = doubles(POINTS);
    accept(mslip_state_init(n, state));
    accept(mslip_masing_path(visit->contact, n, state, STEPS, motion, state, NULL, NULL, NULL));
    accept(mslip_masing_tractions(visit->contact, n, state, POINTS, x, pressure, shear));
    take(visit, pressure, POINTS);
    take(visit, shear, POINTS);
    free(state);
    free(motion);
    free(x);
}

static void loop(struct visit *visit)
{
    double *motion = doubles(STEPS), *response = doubles(STEPS);
    accept(mslip_hysteresis_loop(visit->contact, 0.9 * visit->contact->slip_displacement, STEPS, motion, response));
    take(visit, motion, STEPS);
    take(visit, response, STEPS);
}

static void energy(struct visit *visit)
{
    double *amplitude = multiples(visit->contact->slip_force, POINTS, 1.0), *dissipated = doubles(POINTS);
    accept(mslip_dissipated_energy(visit->contact, POINTS, amplitude, dissipated));
    take(visit, dissipated, POINTS);
    free(amplitude);
}

static void stiffness(struct visit *visit)
{
    double *amplitude = multiples(visit->contact->slip_displacement, POINTS, 3.0);
    double *k[4];
    for (int i = 0; i < 4; ++i) {
        k[i] = doubles(POINTS);
    }
    accept(mslip_complex_stiffness(visit->contact, POINTS, amplitude, k[0], k[1], k[2], k[3]));
    for (int i = 0; i < 4; ++i) {
        take(visit, k[i], POINTS);
    }
    free(amplitude);
}

/* Coefficients of a displacement with a mean, and with more than two reversals a period. */
static double *coefficients(const mslip_contact *contact, size_t items)
{
    const size_t n = 2 * HARMONICS + 1;
    double *c = doubles(items * n);
    for (size_t i = 0; i < items * n; ++i) {
        c[i] = contact->slip_displacement * (i % n == 1 ? 1.1 : i % n == 0 ? 0.1 : 0.9 / (double)(i % n));
    }
    return c;
}

static void harmonic_force(struct visit *visit, int32_t rule)
{
    const size_t n = 2 * HARMONICS + 1;
    double *motion = coefficients(visit->contact, 1), *response = doubles(n), *jacobian = doubles(n * n);
    double *dissipated = doubles(1);
    accept(mslip_harmonic_force(visit->contact, visit->workspace[rule], motion, response, jacobian, dissipated));
    take(visit, response, n);
    take(visit, jacobian, n * n);
    take(visit, dissipated, 1);
    free(motion);
}

static void uniform_sampling(struct visit *visit)
{
    harmonic_force(visit, MSLIP_UNIFORM_SAMPLING);
}

static void event_driven(struct visit *visit)
{
    harmonic_force(visit, MSLIP_EVENT_DRIVEN);
}

static void workspaces(struct visit *visit)
{
    const size_t n = mslip_harmonic_workspace_length(HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING);
    double *memory = doubles(n);
    size_t size[2];
    int32_t rule;
    accept(mslip_harmonic_workspace_init(HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING, n, memory));
    accept(mslip_harmonic_workspace_size(memory, &size[0], &size[1], &rule));
    visit->hash = hashed(visit->hash, size, sizeof size);
    take(visit, memory, n);
    free(workspace(MSLIP_EVENT_DRIVEN));
}

static void jenkins(struct visit *visit)
{
    double *slider = doubles(2);
    accept(mslip_jenkins_equivalent(visit->contact, 0.8 * visit->contact->slip_displacement, slider, slider + 1));
    take(visit, slider, 2);
}

static void iwan(struct visit *visit)
{
    double *spring = doubles(SLIDERS), *slider = doubles(SLIDERS), *error = doubles(1);
    accept(mslip_iwan_equivalent(visit->contact, SLIDERS, spring, slider, error));
    take(visit, spring, SLIDERS);
    take(visit, slider, SLIDERS);
    take(visit, error, 1);
}

/* All items of a batch share one contact. */
static const int32_t shared[ITEMS] = { 0 };

static void batch_stiffness(struct visit *visit)
{
    double *amplitude = multiples(visit->contact->slip_displacement, ITEMS, 3.0);
    double *k[4];
    for (int i = 0; i < 4; ++i) {
        k[i] = doubles(ITEMS);
    }
    accept(mslip_batch_complex_stiffness(ITEMS, 1, visit->contact, shared, NULL, amplitude, k[0], k[1], k[2], k[3]));
    for (int i = 0; i < 4; ++i) {
        take(visit, k[i], ITEMS);
    }
    free(amplitude);
}

static void batch_update(struct visit *visit)
{
    const size_t n = mslip_state_length(REVERSALS);
    double *states = doubles(ITEMS * n), *motion = path(visit->contact, ITEMS);
    double *response = doubles(ITEMS), *tangent = doubles(ITEMS), *dissipated = doubles(ITEMS);
    for (size_t i = 0; i < ITEMS; ++i) {
        accept(mslip_state_init(n, states + i * n));
    }
    accept(mslip_batch_masing_update(ITEMS, 1, visit->contact, shared, NULL, n, states, motion, states, response, tangent,
                                     dissipated));
    take(visit, states, ITEMS * n);
    take(visit, response, ITEMS);
    take(visit, tangent, ITEMS);
    take(visit, dissipated, ITEMS);
    free(motion);
}

static void batch_force(struct visit *visit)
{
    const size_t n = 2 * HARMONICS + 1;
    for (int rule = 0; rule < RULES; ++rule) {
        double *motion = coefficients(visit->contact, ITEMS), *response = doubles(ITEMS * n);
        double *jacobian = doubles(ITEMS * n * n), *dissipated = doubles(ITEMS);
        accept(mslip_batch_harmonic_force(ITEMS, 1, visit->contact, shared, NULL, visit->workspace[rule], motion, response,
                                          jacobian, dissipated));
        take(visit, response, ITEMS * n);
        take(visit, jacobian, ITEMS * n * n);
        take(visit, dissipated, ITEMS);
        free(motion);
    }
}

static void initialisation(struct visit *visit)
{
    mslip_contact contact;
    for (int which = 0; which < CONTACTS; ++which) {
        initialise(which, &contact);
        accept(mslip_contact_check(&contact));
        visit->hash = hashed(visit->hash, &contact, sizeof contact);
    }
}

static void version(struct visit *visit)
{
    const int32_t abi = mslip_abi_version();
    if (abi != MSLIP_ABI_VERSION) {
        abort();
    }
    visit->hash = hashed(visit->hash, mslip_version(), strlen(mslip_version()));
}

const struct call calls[] = {
    { "version", version, 16 },
    { "initialisation of a contact", initialisation, 16 },
    { "initialisation of a workspace", workspaces, 16 },
    { "mslip_tractions", tractions, 16 },
    { "mslip_slip", slip, 16 },
    { "mslip_monotonic_displacement", displacement, 16 },
    { "mslip_monotonic_force", force, 16 },
    { "mslip_masing_update", update, 16 },
    { "mslip_masing_path", whole_path, 40 },
    { "mslip_masing_tractions", tractions_after, 40 },
    { "mslip_hysteresis_loop", loop, 16 },
    { "mslip_dissipated_energy", energy, 16 },
    { "mslip_complex_stiffness", stiffness, 16 },
    { "mslip_harmonic_force, uniform sampling", uniform_sampling, 16 },
    { "mslip_harmonic_force, event-driven", event_driven, 16 },
    { "mslip_jenkins_equivalent", jenkins, 16 },
    { "mslip_iwan_equivalent", iwan, 16 },
    { "mslip_batch_complex_stiffness", batch_stiffness, 16 },
    { "mslip_batch_masing_update", batch_update, 16 },
    { "mslip_batch_harmonic_force", batch_force, 16 },
};
const size_t number_of_calls = sizeof calls / sizeof *calls;

uint64_t visit_one(const mslip_contact *contact, double *const workspaces_of_thread[RULES])
{
    struct visit visit = { contact, { workspaces_of_thread[0], workspaces_of_thread[1] }, UINT64_C(0xcbf29ce484222325) };
    for (size_t i = 0; i < number_of_calls; ++i) {
        calls[i].make(&visit);
    }
    return visit.hash;
}

uint64_t visit_all(void)
{
    double *own[RULES] = { workspace(MSLIP_UNIFORM_SAMPLING), workspace(MSLIP_EVENT_DRIVEN) };
    uint64_t hash = 0;
    for (int which = 0; which < CONTACTS; ++which) {
        mslip_contact contact;
        initialise(which, &contact);
        const uint64_t one = visit_one(&contact, own);
        hash = hashed(hash, &one, sizeof one);
    }
    free(own[0]);
    free(own[1]);
    return hash;
}
