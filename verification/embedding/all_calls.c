/* all_calls.c: see all_calls.h. Inputs are computed by + - * / only, so that they are the same with every compiler. */
#include "all_calls.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    POINTS = 9, HARMONICS = 3, COEFFICIENTS = 7, SAMPLES = 64, REVERSALS = 6, STEPS = 41, ITEMS = 2, SLIDERS = 7,
    PIECES = 5, COMPONENTS = 2, TANGENT = 4, ALL = COMPONENTS * COEFFICIENTS
};

static uint64_t hashed(uint64_t hash, const void *bytes, size_t n)
{
    const unsigned char *byte = (const unsigned char *)bytes; /* FNV-1a */
    for (size_t i = 0; i < n; ++i) {
        hash = (hash ^ byte[i]) * UINT64_C(0x100000001b3);
    }
    return hash;
}

static void accept(int32_t status)
{
    if (status != MSLIP_OK) {
        fprintf(stderr, "%s\n", mslip_status_text(status));
        abort();
    }
}

/* New arrays of n doubles, uninitialised. */
static double **arrays(struct sequence *s, size_t count, size_t n)
{
    double **first = s->array + s->arrays;
    for (; count > 0; --count, ++s->arrays) {
        if (s->arrays == MOST_ARRAYS || (s->array[s->arrays] = (double *)malloc(n * sizeof(double))) == NULL) {
            abort();
        }
        s->length[s->arrays] = n;
    }
    return first;
}

static void release(struct sequence *s)
{
    while (s->arrays > 0) {
        free(s->array[--s->arrays]);
    }
}

/* Multiples of a unit from microslip to gross slip, also next to its onset. */
static double *multiples(struct sequence *s, double unit, double largest)
{
    static const double all[POINTS] = { 0.0, 1e-9, 0.3, 0.9, 0.9995, 1.0, 1.0005, 1.03, 2.5 };
    double *x = *arrays(s, 1, POINTS);
    for (size_t i = 0; i < POINTS; ++i) {
        x[i] = unit * (all[i] < largest ? all[i] : largest);
    }
    return x;
}

/* A path of increasing and decreasing amplitude with more nested reversals than the state can hold. */
static double *path(struct sequence *s)
{
    double *x = *arrays(s, 1, STEPS);
    for (size_t i = 0; i < STEPS; ++i) {
        const double t = (double)(i % 9) - 4.0, sign = i % 2 == 0 ? 1.0 : -1.0;
        x[i] = s->contact->slip_displacement * (i % 3 == 0 ? 0.3 * t : sign * (0.9 - 0.1 * t));
    }
    return x;
}

static double *states(struct sequence *s, size_t items)
{
    const size_t n = mslip_state_length(REVERSALS);
    double *memory = *arrays(s, 1, items * n);
    for (size_t i = 0; i < items; ++i) {
        accept(mslip_state_init(n, memory + i * n));
    }
    return memory;
}

/* Coefficients of displacements with a mean and more than two reversals per period. */
static double *coefficients(struct sequence *s, size_t items)
{
    double *c = *arrays(s, 1, items * COEFFICIENTS);
    for (size_t i = 0; i < items * COEFFICIENTS; ++i) {
        const size_t k = i % COEFFICIENTS;
        c[i] = s->contact->slip_displacement * (k == 1 ? 1.1 : k == 0 ? 0.1 : 0.9 / (double)k);
    }
    return c;
}

static double *workspace(int32_t rule)
{
    const size_t n = mslip_harmonic_workspace_length(HARMONICS, SAMPLES, rule);
    double *memory = (double *)malloc(n * sizeof *memory);
    if (memory == NULL) {
        abort();
    }
    accept(mslip_harmonic_workspace_init(HARMONICS, SAMPLES, rule, n, memory));
    return memory;
}

/* A path of an element with more pieces than the state can hold, slip in both directions, gross slip and separation. */
static double *element_path(struct sequence *s)
{
    double *x = *arrays(s, 1, COMPONENTS * STEPS);
    const mslip_element *e = s->element;
    const double unit = e->approach * (e->friction_coefficient > 0.0 ? e->friction_coefficient : 1.0);
    const int by_force = e->normal_input == MSLIP_NORMAL_FORCE;
    for (size_t i = 0; i < STEPS; ++i) {
        const double t = (double)(i % 8), sign = i % 2 == 0 ? 1.0 : -1.0;
        const double normal = i % 24 == 23 ? (by_force ? 0.0 : -0.1) : 0.1 + 0.14 * t;
        x[COMPONENTS * i] = unit * (i % 16 < 8 ? 0.01 * sign : i % 24 == 20 ? 3.0 : 0.2 * sign * t);
        x[COMPONENTS * i + 1] = (by_force ? e->normal_force : e->approach) * normal;
    }
    return x;
}

static double *element_states(struct sequence *s, size_t items)
{
    const size_t n = mslip_element_state_length(1, PIECES);
    double *memory = *arrays(s, 1, items * n);
    for (size_t i = 0; i < items; ++i) {
        accept(mslip_element_state_init(1, n, memory + i * n));
    }
    return memory;
}

/* Coefficients of displacements of an element; by approach it opens. */
static double *element_coefficients(struct sequence *s, size_t items)
{
    double *c = *arrays(s, 1, items * ALL);
    const mslip_element *e = s->element;
    const int by_force = e->normal_input == MSLIP_NORMAL_FORCE;
    for (size_t i = 0; i < items * ALL; ++i) {
        const size_t k = i % ALL, harmonic = k % COEFFICIENTS;
        const double normal = by_force ? e->normal_force : e->approach;
        c[i] = k < COEFFICIENTS ? e->approach * (k == 1 ? 0.4 : 0.1 / (double)(k + 1))
            : normal * (harmonic == 0 ? (by_force ? 0.6 : 0.3) : harmonic < 3 ? 0.25 : 0.0);
    }
    return c;
}

static void initialise_element(int which, const mslip_parameters *flat, const mslip_elliptic_parameters *ellipse,
                               mslip_element *element)
{
    const int32_t normal_input = which / 3 % 2 == 0 ? MSLIP_APPROACH : MSLIP_NORMAL_FORCE;
    if (element != NULL) {
        accept(flat != NULL ? mslip_element_init(flat, 1, normal_input, element)
                            : mslip_element_init_elliptic(ellipse, 1, normal_input, element));
    }
}

void initialise(int which, mslip_contact *contact, mslip_element *element)
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
        initialise_element(which, NULL, &p, element);
    } else {
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
        p.normal_force = 10.0 + size;
        p.length = kind == SHORT ? 5e-4 : p.length; /* the normal law needs more of it */
        initialise_element(which, &p, NULL, element);
    }
}

static void initialisation(struct sequence *s)
{
    mslip_contact contact;
    mslip_element *element = (mslip_element *)malloc(sizeof *element);
    if (element == NULL) {
        abort();
    }
    for (int which = 0; which < CONTACTS; ++which) {
        initialise(which, &contact, element);
        accept(mslip_contact_check(&contact));
        accept(mslip_element_check(element));
        s->hash = hashed(s->hash, &contact, sizeof contact);
        s->hash = hashed(s->hash, element, sizeof *element);
    }
    free(element);
}

static void workspaces(struct sequence *s)
{
    for (int32_t rule = 0; rule < RULES; ++rule) {
        size_t size[2];
        int32_t found;
        double *memory = workspace(rule);
        accept(mslip_harmonic_workspace_size(memory, &size[0], &size[1], &found));
        s->hash = hashed(hashed(s->hash, size, sizeof size), &found, sizeof found);
        free(memory);
    }
}

static void tractions(struct sequence *s)
{
    double *x = multiples(s, s->contact->half_width, 1.1), **o = arrays(s, 2, POINTS);
    accept(mslip_tractions(s->contact, 0.7 * s->contact->slip_force, POINTS, x, o[0], o[1]));
}

static void slip(struct sequence *s)
{
    double *x = multiples(s, s->contact->half_width, 1.1), **o = arrays(s, 2, POINTS);
    const int32_t status = mslip_slip(s->contact, 0.7 * s->contact->slip_force, POINTS, x, o[0], o[1]);
    if (status == MSLIP_NOT_AVAILABLE) {
        release(s);
    } else {
        accept(status);
    }
}

static void monotonic_displacement(struct sequence *s)
{
    double *x = multiples(s, s->contact->slip_force, 1.0), **o = arrays(s, 3, POINTS);
    accept(mslip_monotonic_displacement(s->contact, POINTS, x, o[0], o[1], o[2]));
}

static void monotonic_force(struct sequence *s)
{
    double *x = multiples(s, s->contact->slip_displacement, 3.0), **o = arrays(s, 3, POINTS);
    accept(mslip_monotonic_force(s->contact, POINTS, x, o[0], o[1], o[2]));
}

static void monotonic_sensitivity(struct sequence *s)
{
    double *x = multiples(s, s->contact->slip_displacement, 3.0), *force = *arrays(s, 1, POINTS);
    accept(mslip_monotonic_sensitivity(s->contact, POINTS, x, force, *arrays(s, 1, MSLIP_PARAMETER_COUNT * POINTS)));
}

static void masing_update(struct sequence *s)
{
    const size_t n = mslip_state_length(REVERSALS);
    double *state = states(s, 1), *u = path(s), *state_new = *arrays(s, 1, n), **o = arrays(s, 3, STEPS);
    for (size_t i = 0; i < STEPS; ++i) {
        accept(mslip_masing_update(s->contact, n, state, u[i], state_new, o[0] + i, o[1] + i, o[2] + i));
        memcpy(state, state_new, n * sizeof *state);
    }
}

static void masing_path(struct sequence *s)
{
    const size_t n = mslip_state_length(REVERSALS);
    double *state = states(s, 1), *u = path(s), **o = arrays(s, 4, STEPS), *error = *arrays(s, 1, 1);
    accept(mslip_masing_path(s->contact, n, state, STEPS, u, NULL, o[3], NULL, NULL));
    accept(mslip_masing_path(s->contact, n, state, STEPS, u, state, o[0], o[1], o[2]));
    accept(mslip_state_check(n, state));
    accept(mslip_state_error(n, state, error));
}

static void masing_tractions(struct sequence *s)
{
    const size_t n = mslip_state_length(REVERSALS);
    double *state = states(s, 1), *u = path(s), *x = multiples(s, s->contact->half_width, 1.1), **o = arrays(s, 2, POINTS);
    accept(mslip_masing_path(s->contact, n, state, STEPS, u, state, NULL, NULL, NULL));
    accept(mslip_masing_tractions(s->contact, n, state, POINTS, x, o[0], o[1]));
}

static void hysteresis_loop(struct sequence *s)
{
    double **o = arrays(s, 2, STEPS);
    accept(mslip_hysteresis_loop(s->contact, 0.9 * s->contact->slip_displacement, STEPS, o[0], o[1]));
}

static void dissipated_energy(struct sequence *s)
{
    double *x = multiples(s, s->contact->slip_force, 1.0), **o = arrays(s, 1, POINTS);
    accept(mslip_dissipated_energy(s->contact, POINTS, x, o[0]));
}

static void complex_stiffness(struct sequence *s)
{
    double *x = multiples(s, s->contact->slip_displacement, 3.0), **o = arrays(s, 4, POINTS);
    accept(mslip_complex_stiffness(s->contact, POINTS, x, o[0], o[1], o[2], o[3]));
}

/* The last call has amplitudes enough for a table of its own. */
static void stiffness_table(struct sequence *s)
{
    const size_t n = mslip_stiffness_table_length();
    double *table = *arrays(s, 1, n), *x = multiples(s, s->contact->slip_displacement, 3.0), **o = arrays(s, 4, POINTS);
    accept(mslip_stiffness_table_init(s->contact, n, table));
    accept(mslip_complex_stiffness_tabulated(s->contact, table, POINTS, x, o[0], o[1], o[2], o[3]));
    double *near_slip = *arrays(s, 1, POINTS), **near = arrays(s, 4, POINTS);
    for (size_t i = 0; i < POINTS; ++i) {
        near_slip[i] = s->contact->slip_displacement * (1.0 + 1e-3 * (double)(i + 1));
    }
    accept(mslip_complex_stiffness(s->contact, POINTS, near_slip, near[0], near[1], near[2], near[3]));
}

static void harmonic_force(struct sequence *s)
{
    for (int rule = 0; rule < RULES; ++rule) {
        double *u = coefficients(s, 1), *force = *arrays(s, 1, COEFFICIENTS);
        double *jacobian = *arrays(s, 1, COEFFICIENTS * COEFFICIENTS), *dissipated = *arrays(s, 1, 1);
        accept(mslip_harmonic_force(s->contact, s->workspace[rule], u, force, jacobian, dissipated));
    }
}

static void harmonic_sensitivity(struct sequence *s)
{
    for (int rule = 0; rule < RULES; ++rule) {
        double *u = coefficients(s, 1), *force = *arrays(s, 1, COEFFICIENTS);
        double *sensitivity = *arrays(s, 1, MSLIP_PARAMETER_COUNT * COEFFICIENTS);
        accept(mslip_harmonic_sensitivity(s->contact, s->workspace[rule], u, force, sensitivity));
    }
}

static void equivalents(struct sequence *s)
{
    double **jenkins = arrays(s, 2, 1), **iwan = arrays(s, 2, SLIDERS), *error = *arrays(s, 1, 1);
    accept(mslip_jenkins_equivalent(s->contact, 0.8 * s->contact->slip_displacement, jenkins[0], jenkins[1]));
    accept(mslip_iwan_equivalent(s->contact, SLIDERS, iwan[0], iwan[1], error));
}

/* All items of a batch share one contact. */
static const int32_t shared[ITEMS] = { 0 };

static void batch_complex_stiffness(struct sequence *s)
{
    double *x = coefficients(s, ITEMS), **o = arrays(s, 4, ITEMS);
    accept(mslip_batch_complex_stiffness(ITEMS, 1, s->contact, shared, NULL, x, o[0], o[1], o[2], o[3]));
}

static void batch_masing_update(struct sequence *s)
{
    const size_t n = mslip_state_length(REVERSALS);
    double *state = states(s, ITEMS), *u = coefficients(s, ITEMS), **o = arrays(s, 3, ITEMS);
    accept(mslip_batch_masing_update(ITEMS, 1, s->contact, shared, NULL, n, state, u, state, o[0], o[1], o[2]));
}

static void batch_harmonic_force(struct sequence *s)
{
    for (int rule = 0; rule < RULES; ++rule) {
        double *u = coefficients(s, ITEMS), *force = *arrays(s, 1, ITEMS * COEFFICIENTS);
        double *jacobian = *arrays(s, 1, ITEMS * COEFFICIENTS * COEFFICIENTS), *dissipated = *arrays(s, 1, ITEMS);
        accept(mslip_batch_harmonic_force(ITEMS, 1, s->contact, shared, NULL, s->workspace[rule], u, force, jacobian, dissipated));
    }
}

static void normal_law(struct sequence *s)
{
    double *x = multiples(s, s->element->approach, 2.0), **o = arrays(s, 3, POINTS), **inverse = arrays(s, 3, POINTS);
    accept(mslip_normal_force(s->element, POINTS, x, o[0], o[1], o[2]));
    accept(mslip_normal_approach(s->element, POINTS, o[0], inverse[0], inverse[1], inverse[2]));
}

static void element_update(struct sequence *s)
{
    const size_t n = mslip_element_state_length(1, PIECES);
    double *state = element_states(s, 1), *x = element_path(s), *state_new = element_states(s, 1);
    double *force = *arrays(s, 1, COMPONENTS * STEPS), *tangent = *arrays(s, 1, TANGENT * STEPS), *energy = *arrays(s, 1, STEPS);
    for (size_t i = 0; i < STEPS; ++i) {
        accept(mslip_element_update(s->element, n, state, x + COMPONENTS * i, state_new, force + COMPONENTS * i,
                                    tangent + TANGENT * i, energy + i));
        memcpy(state, state_new, n * sizeof *state);
    }
}

static void element_whole_path(struct sequence *s)
{
    const size_t n = mslip_element_state_length(1, PIECES);
    double *state = element_states(s, 1), *x = element_path(s), *discarded = *arrays(s, 1, COMPONENTS * STEPS);
    double *force = *arrays(s, 1, COMPONENTS * STEPS), *tangent = *arrays(s, 1, TANGENT * STEPS), *energy = *arrays(s, 1, STEPS);
    accept(mslip_element_path(s->element, n, state, STEPS, x, NULL, discarded, NULL, NULL));
    accept(mslip_element_path(s->element, n, state, STEPS, x, state, force, tangent, energy));
    accept(mslip_element_state_check(1, n, state));
    accept(mslip_element_state_error(1, n, state, *arrays(s, 1, 1)));
}

static void element_tractions(struct sequence *s)
{
    const size_t n = mslip_element_state_length(1, PIECES);
    double *state = element_states(s, 1), *path = element_path(s), *x = multiples(s, s->element->half_width, 1.1);
    double **o = arrays(s, 2, POINTS);
    accept(mslip_element_path(s->element, n, state, STEPS - 3, path, state, NULL, NULL, NULL));
    accept(mslip_element_tractions(s->element, n, state, POINTS, x, o[0], o[1]));
}

static double *make_element_workspace(void)
{
    const size_t n = mslip_element_workspace_length(1, HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING);
    double *memory = (double *)malloc(n * sizeof *memory);
    if (memory == NULL) {
        abort();
    }
    accept(mslip_element_workspace_init(1, HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING, n, memory));
    return memory;
}

static void element_workspaces(struct sequence *s)
{
    size_t size[2];
    int32_t kind[2];
    double *memory = make_element_workspace();
    accept(mslip_element_workspace_size(memory, &kind[0], &size[0], &size[1], &kind[1]));
    s->hash = hashed(hashed(s->hash, size, sizeof size), kind, sizeof kind);
    free(memory);
}

static void element_harmonic_force(struct sequence *s)
{
    double *x = element_coefficients(s, 1), *force = *arrays(s, 1, ALL), *jacobian = *arrays(s, 1, ALL * ALL);
    accept(mslip_element_harmonic_force(s->element, s->element_workspace, x, force, jacobian, *arrays(s, 1, 1)));
}

static void batch_element_update(struct sequence *s)
{
    const size_t n = mslip_element_state_length(1, PIECES);
    double *state = element_states(s, ITEMS), *x = element_path(s), *force = *arrays(s, 1, COMPONENTS * ITEMS);
    double *tangent = *arrays(s, 1, TANGENT * ITEMS), *energy = *arrays(s, 1, ITEMS);
    accept(mslip_batch_element_update(ITEMS, 1, s->element, shared, NULL, n, state, x, state, force, tangent, energy));
}

static void batch_element_harmonic_force(struct sequence *s)
{
    double *x = element_coefficients(s, ITEMS), *force = *arrays(s, 1, ITEMS * ALL), *jacobian = *arrays(s, 1, ITEMS * ALL * ALL);
    double *energy = *arrays(s, 1, ITEMS);
    accept(mslip_batch_element_harmonic_force(ITEMS, 1, s->element, shared, NULL, s->element_workspace, x, force, jacobian,
                                              energy));
}

static void version(struct sequence *s)
{
    if (mslip_abi_version() != MSLIP_ABI_VERSION) {
        abort();
    }
    s->hash = hashed(s->hash, mslip_version(), strlen(mslip_version()));
}

#define CALL(name) { #name, name }
const struct call calls[] = {
    CALL(version), CALL(initialisation), CALL(workspaces), CALL(tractions), CALL(slip), CALL(monotonic_displacement),
    CALL(monotonic_force), CALL(masing_update), CALL(masing_path), CALL(masing_tractions), CALL(hysteresis_loop),
    CALL(dissipated_energy), CALL(complex_stiffness), CALL(stiffness_table), CALL(harmonic_force), CALL(harmonic_sensitivity),
    CALL(monotonic_sensitivity), CALL(equivalents), CALL(batch_complex_stiffness),
    CALL(batch_masing_update), CALL(batch_harmonic_force), CALL(normal_law), CALL(element_update),
    { "element_path", element_whole_path }, CALL(element_tractions), CALL(element_workspaces), CALL(element_harmonic_force),
    CALL(batch_element_update), CALL(batch_element_harmonic_force),
};
const size_t number_of_calls = sizeof calls / sizeof *calls;

void begin_sequence(struct sequence *s)
{
    s->arrays = 0;
    s->hash = UINT64_C(0xcbf29ce484222325);
    s->workspace[0] = workspace(MSLIP_UNIFORM_SAMPLING);
    s->workspace[1] = workspace(MSLIP_EVENT_DRIVEN);
    s->element_workspace = make_element_workspace();
}

void end_sequence(struct sequence *s)
{
    free(s->workspace[0]);
    free(s->workspace[1]);
    free(s->element_workspace);
}

void make_call(struct sequence *s, size_t call)
{
    calls[call].make(s);
    for (size_t i = 0; i < s->arrays; ++i) {
        s->hash = hashed(s->hash, s->array[i], s->length[i] * sizeof(double));
    }
    release(s);
}

uint64_t hash_of_one(struct sequence *s, const mslip_contact *contact, const mslip_element *element)
{
    s->contact = contact;
    s->element = element;
    s->hash = UINT64_C(0xcbf29ce484222325);
    for (size_t i = 0; i < number_of_calls; ++i) {
        make_call(s, i);
    }
    return s->hash;
}

uint64_t hash_of_all(void)
{
    struct sequence s;
    uint64_t hash = 0;
    mslip_element *element = (mslip_element *)malloc(sizeof *element);
    if (element == NULL) {
        abort();
    }
    begin_sequence(&s);
    for (int which = 0; which < CONTACTS; ++which) {
        mslip_contact contact;
        initialise(which, &contact, element);
        const uint64_t one = hash_of_one(&s, &contact, element);
        hash = hashed(hash, &one, sizeof one);
    }
    end_sequence(&s);
    free(element);
    return hash;
}
