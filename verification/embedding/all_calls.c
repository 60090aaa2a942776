/* all_calls.c: see all_calls.h. Inputs are computed by + - * / only, so that they are the same with every compiler. */
#include "all_calls.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Items, steps and points; of a state shorter than the steps need. */
enum { ITEMS = 9, HARMONICS = 3, COEFFICIENTS = 7, SAMPLES = 64, REVERSALS = 3, PIECES = 4 };

#include "../../c_tests/functions.h"

#define CALL(name, ...) \
    static int32_t call_##name(arguments call) \
    { \
        return mslip_##name(__VA_ARGS__); \
    }
#include "../../c_tests/functions.h"

typedef struct {
    const char *name;
    int32_t (*call)(arguments);
    argument arguments[MOST_ARGUMENTS]; /* until the first without a name */
} function;

static const function functions[] = {
#define FUNCTION(id, directions, ...) { #id, call_##id, { __VA_ARGS__ } },
#include "../../c_tests/functions.h"
};
enum { FUNCTIONS = sizeof functions / sizeof *functions };

/* Besides the functions: the versions. */
static const size_t number_of_calls = FUNCTIONS + 1;

static int takes(const function *f, int kind)
{
    const argument *a = f->arguments;
    while (a->name != NULL && a->kind != kind) {
        ++a;
    }
    return a->name != NULL;
}

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

/* A new array of n doubles, uninitialised. */
static double *array(struct sequence *s, size_t n)
{
    double *values = (double *)malloc(n * sizeof *values);
    if (s->arrays == MOST_ARRAYS || values == NULL) {
        abort();
    }
    s->array[s->arrays] = values;
    s->length[s->arrays++] = n;
    return values;
}

static void release(struct sequence *s)
{
    while (s->arrays > 0) {
        free(s->array[--s->arrays]);
    }
}

/* Multiples of a unit from microslip to gross slip, also next to its onset. */
static double multiple(size_t i, double unit, double largest)
{
    static const double all[] = { 0.0, 1e-9, 0.3, 0.9, 0.9995, 1.0, 1.0005, 1.03, 2.5 };
    return unit * (all[i % 9] < largest ? all[i % 9] : largest);
}

/* Value i of a quantity. Displacements: a path with more nested reversals than the state can hold; with more pieces, slip, gross
   slip and separation; coefficients with a mean, more than two reversals per period, and separation. */
static double value(const struct sequence *s, const function *f, int quantity, size_t i)
{
    const mslip_contact *c = s->contact;
    const mslip_element *e = s->element;
    const int of_element = takes(f, ARG_ELEMENT);
    const int by_force = of_element && e->normal_input == MSLIP_INPUT_NORMAL_FORCE;
    const double sign = i % 2 == 0 ? 1.0 : -1.0, normal = !of_element ? 0.0 : by_force ? e->normal_force : e->approach;
    switch (quantity) {
        case X: return multiple(i, of_element ? e->half_width : c->half_width, 1.1);
        case FORCE:
        case FORCE_AMPLITUDE: return multiple(i, c->slip_force, 1.0);
        case AMPLITUDE: return multiple(i, c->slip_displacement, 3.0);
        case APPROACH: return multiple(i, e->approach, 2.0);
        case NORMAL_FORCE: return multiple(i, e->normal_force, 2.0);
        default: break;
    }
    if (takes(f, ARG_WORKSPACE)) {
        const size_t all = COEFFICIENTS * (of_element ? 2u : 1u), k = i % all, harmonic = k % COEFFICIENTS;
        return !of_element      ? c->slip_displacement * (k == 1 ? 1.1 : k == 0 ? 0.1 : 0.9 / (double)k)
            : k < COEFFICIENTS  ? e->approach * (k == 1 ? 0.4 : 0.1 / (double)(k + 1))
            : harmonic == 0     ? normal * (by_force ? 0.6 : 0.3)
                                : normal * (harmonic < 3 ? 0.25 : 0.0);
    }
    if (of_element) {
        const size_t step = i / 2;
        const double t = (double)(step % 8), to_and_fro = step % 2 == 0 ? 1.0 : -1.0;
        return i % 2 == 1 ? normal * (step % 7 == 6 ? (by_force ? 0.0 : -0.1) : 0.1 + 0.14 * t)
                          : e->approach * (step % 8 < 5 ? 0.01 * to_and_fro : step % 8 == 5 ? 3.0 : 0.2 * to_and_fro * t);
    }
    return c->slip_displacement * (i % 3 == 0 ? 0.3 * ((double)i - 4.0) : sign * (0.9 - 0.1 * (double)i));
}

/* States after a step; of tractions, after slip. */
static double *states(struct sequence *s, int of_element, size_t items)
{
    const size_t n = of_element ? mslip_element_state_length(1, PIECES) : mslip_state_length(REVERSALS);
    double *memory = array(s, items * n);
    for (size_t i = 0; i < items; ++i) {
        double *state = memory + i * n;
        if (of_element) {
            const double normal = s->element->normal_input == MSLIP_INPUT_NORMAL_FORCE ? s->element->normal_force : s->element->approach;
            const double step[2][2] = { { 0.0, 0.8 * normal }, { 0.1 * s->element->approach, 0.6 * normal } };
            accept(mslip_element_state_init(1, n, state));
            accept(mslip_element_path(s->element, n, state, 2, step[0], state, NULL, NULL, NULL));
        } else {
            const double u = 0.7 * s->contact->slip_displacement, steps[2] = { u, -0.5 * u };
            accept(mslip_state_init(n, state));
            accept(mslip_masing_path(s->contact, n, state, 2, steps, state, NULL, NULL, NULL));
        }
    }
    return memory;
}

static double *workspace(int of_element, int32_t rule)
{
    const size_t n = of_element ? mslip_element_workspace_length(1, HARMONICS, SAMPLES, rule)
                                : mslip_harmonic_workspace_length(HARMONICS, SAMPLES, rule);
    double *memory = (double *)malloc(n * sizeof *memory);
    if (memory == NULL) {
        abort();
    }
    accept(of_element ? mslip_element_workspace_init(1, HARMONICS, SAMPLES, rule, 0, n, memory)
                      : mslip_harmonic_workspace_init(HARMONICS, SAMPLES, rule, n, memory));
    return memory;
}

/* Memory for an argument, if it is a pointer. */
static void *memory_of(struct sequence *s, const function *f, const argument *a, const arguments *call)
{
    const size_t items = takes(f, ARG_INDEX) ? ITEMS : 1;
    const int of_element = strstr(f->name, "element") != NULL;
    const size_t extent = extent_of(a->extents, ITEMS, takes(f, ARG_ELEMENT) ? 2 : 1, COEFFICIENTS);
    double *x;
    switch (a->kind) {
        case ARG_NEW_CONTACT: return array(s, sizeof(mslip_contact) / sizeof(double));
        case ARG_NEW_ELEMENT: return array(s, sizeof(mslip_element) / sizeof(double));
        case ARG_STATE:
        case ARG_NEW_STATE: return states(s, of_element, items);
        case ARG_BUFFER:
            return array(s, strstr(f->name, "state") ? call->state_length : call->workspace_length);
        case ARG_INPUT:
            x = array(s, extent);
            for (size_t i = 0; i < extent; ++i) {
                x[i] = value(s, f, a->quantity, i);
            }
            return x;
        case ARG_OUTPUT:
        case ARG_FOUND_CHOICE:
        case ARG_FOUND_SIZE:
            /* Outputs are uninitialised; an integer does not fill its array. */
            x = array(s, extent);
            if (a->kind != ARG_OUTPUT) {
                memset(x, 0, sizeof *x);
            }
            return x;
        default: return NULL;
    }
}

static mslip_parameters flat_parameters(void)
{
    const mslip_material steel = { 2.1e11, 0.3 };
    mslip_parameters p;
    mslip_parameters_default(&p);
    p.flat_half_width = 3e-4;
    p.edge_radius = 2e-3;
    p.length = 2e-2;
    p.normal_force = 10.0;
    p.friction_coefficient = 0.4;
    p.displacement_reference = MSLIP_CENTRE_POINT;
    p.material[0] = p.material[1] = steel;
    return p;
}

static mslip_elliptic_parameters elliptic_parameters(void)
{
    const mslip_material steel = { 2.1e11, 0.3 };
    mslip_elliptic_parameters p;
    mslip_elliptic_parameters_default(&p);
    p.semi_axis_x = 8e-4;
    p.semi_axis_y = 1.5e-3;
    p.normal_force = 40.0;
    p.friction_coefficient = 0.4;
    p.material[0] = p.material[1] = steel;
    return p;
}

/* All items of a batch share one contact. */
static void make_function(struct sequence *s, const function *f, int rule)
{
    static const int32_t shared[ITEMS] = { 0 };
    const int of_element = strstr(f->name, "element") != NULL;
    const mslip_parameters p = flat_parameters();
    const mslip_elliptic_parameters e = elliptic_parameters();
    arguments call;
    memset(&call, 0, sizeof call);
    call.contacts = s->contact;
    call.elements = s->element;
    call.parameters = &p;
    call.elliptic_parameters = &e;
    call.n = ITEMS;
    call.n_contacts = 1;
    call.index = shared;
    call.harmonics = HARMONICS;
    call.samples = SAMPLES;
    call.directions = 1;
    call.normal_input = MSLIP_INPUT_APPROACH;
    call.rule = rule;
    call.state_length = of_element ? mslip_element_state_length(1, PIECES) : mslip_state_length(REVERSALS);
    call.workspace_length = of_element ? mslip_element_workspace_length(1, HARMONICS, SAMPLES, rule)
                                       : mslip_harmonic_workspace_length(HARMONICS, SAMPLES, rule);
    call.workspace = of_element ? s->element_workspace : s->workspace[rule];
    for (const argument *a = f->arguments; a->name != NULL; ++a) {
        void *memory = memory_of(s, f, a, &call);
        if (a->kind == ARG_VALUE) {
            call.scalar = value(s, f, a->quantity, 2);
        } else if (memory != NULL) {
            memcpy((char *)&call + a->field, &memory, sizeof memory);
        }
    }
    const int32_t status = f->call(call);
    if (status == MSLIP_NOT_AVAILABLE || strstr(f->name, "workspace_init")) {
        release(s); /* scratch memory is not initialised */
    }
    if (status != MSLIP_NOT_AVAILABLE) {
        accept(status);
    }
}

void make_call(struct sequence *s, size_t call)
{
    if (call < FUNCTIONS) {
        const function *f = &functions[call];
        const int has_rule = takes(f, ARG_WORKSPACE) || strstr(f->name, "workspace");
        for (int rule = 0; rule < (has_rule && !strstr(f->name, "element") ? RULES : 1); ++rule) {
            make_function(s, f, rule);
        }
    } else {
        accept(mslip_abi_version() == MSLIP_ABI_VERSION ? MSLIP_OK : MSLIP_NOT_AVAILABLE);
        s->hash = hashed(s->hash, mslip_version(), strlen(mslip_version()));
    }
    for (size_t i = 0; i < s->arrays; ++i) {
        s->hash = hashed(s->hash, s->array[i], s->length[i] * sizeof(double));
    }
    release(s);
}

void initialise(int which, mslip_contact *contact, mslip_element *element)
{
    enum { FLAT, CYLINDER, NEARLY_FLAT, RIGID, SHORT, ELLIPSE, SPHERE, OPEN, KINDS };
    const int kind = which % KINDS, size = which / KINDS;
    const int32_t normal_input = which / 3 % 2 == 0 ? MSLIP_INPUT_APPROACH : MSLIP_INPUT_NORMAL_FORCE;
    mslip_parameters p = flat_parameters();
    mslip_elliptic_parameters e = elliptic_parameters();
    if (kind == ELLIPSE || kind == SPHERE) {
        e.semi_axis_y = kind == SPHERE ? 8e-4 : e.semi_axis_y;
        e.normal_force = 40.0 + size;
        accept(mslip_contact_init_elliptic(&e, contact));
        accept(element == NULL ? MSLIP_OK : mslip_element_init_elliptic(&e, 1, normal_input, element));
        return;
    }
    p.flat_half_width = kind == CYLINDER ? 0.0 : kind == NEARLY_FLAT ? 1e-3 : p.flat_half_width;
    p.edge_radius = kind == NEARLY_FLAT ? 1e-7 : p.edge_radius;
    p.length = kind == SHORT ? 1.7e-4 : p.length;
    p.normal_force = kind == OPEN ? 0.0 : 10.0 + size;
    p.displacement_reference = kind == RIGID ? MSLIP_RIGID_STRIP : MSLIP_CENTRE_POINT;
    accept(mslip_contact_init(&p, contact));
    p.normal_force = 10.0 + size;
    p.length = kind == SHORT ? 5e-4 : p.length; /* the normal law needs more of it */
    accept(element == NULL ? MSLIP_OK : mslip_element_init(&p, 1, normal_input, element));
}

void begin_sequence(struct sequence *s)
{
    s->arrays = 0;
    s->hash = UINT64_C(0xcbf29ce484222325);
    s->workspace[0] = workspace(0, MSLIP_UNIFORM_SAMPLING);
    s->workspace[1] = workspace(0, MSLIP_EVENT_DRIVEN);
    s->element_workspace = workspace(1, MSLIP_UNIFORM_SAMPLING);
}

void end_sequence(struct sequence *s)
{
    free(s->workspace[0]);
    free(s->workspace[1]);
    free(s->element_workspace);
}

uint64_t hash_of_one(struct sequence *s, const mslip_contact *contact, const mslip_element *element)
{
    s->contact = contact;
    s->element = element;
    s->hash = hashed(UINT64_C(0xcbf29ce484222325), contact, sizeof *contact);
    s->hash = hashed(s->hash, element, sizeof *element);
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
