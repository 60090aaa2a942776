/* calls.h: contacts and elements, and a table of every function that takes one of them and has outputs, with a valid call of each. */
#ifndef CALLS_H
#define CALLS_H

#include "check.h"

#include <float.h>
#include "outputs.h"
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#define LENGTH(array) (sizeof(array) / sizeof *(array))

/* Rounded flat: contact 3 of the reference tables. */
static inline mslip_parameters flat_parameters(void)
{
    mslip_parameters p;
    mslip_parameters_default(&p);
    p.flat_half_width = 3e-4;
    p.edge_radius = 2e-3;
    p.length = 1.97e-2;
    p.normal_force = 178.24;
    p.friction_coefficient = 0.417;
    p.displacement_reference = MSLIP_CENTRE_POINT;
    p.material[0].young_modulus = p.material[1].young_modulus = 2e11;
    p.material[0].poisson_ratio = p.material[1].poisson_ratio = 0.29;
    return p;
}

/* Ellipse: case 1 of the table of elliptical contacts. */
static inline mslip_elliptic_parameters elliptic_parameters(void)
{
    mslip_elliptic_parameters p;
    mslip_elliptic_parameters_default(&p);
    p.semi_axis_x = 8.469711632573419636885181e-4;
    p.semi_axis_y = 1.556904140680311380770529e-3;
    p.normal_force = 46.68443584875135599077112;
    p.friction_coefficient = 0.8978145269586224053171009;
    p.material[0].young_modulus = p.material[1].young_modulus = 2.1e11;
    p.material[0].poisson_ratio = p.material[1].poisson_ratio = 0.45;
    return p;
}

/* The last two have no tangential force: no normal force, or no friction. An element is no OPEN one, but a rigid strip. */
enum { FLAT, CYLINDER, ELLIPSE, OPEN, FRICTIONLESS, KINDS };

static inline mslip_contact init_contact(int kind)
{
    mslip_parameters p = flat_parameters();
    mslip_elliptic_parameters e = elliptic_parameters();
    mslip_contact contact;
    p.flat_half_width *= kind != CYLINDER;
    p.normal_force *= kind != OPEN;
    p.friction_coefficient *= kind != FRICTIONLESS;
    CHECK((kind == ELLIPSE ? mslip_contact_init_elliptic(&e, &contact) : mslip_contact_init(&p, &contact)) == MSLIP_OK);
    return contact;
}

/* The contact as initialised by the first call. */
static inline mslip_contact contact_of(int kind)
{
    static mslip_contact contacts[KINDS];
    static int is_initialised[KINDS];
    if (!is_initialised[kind]) {
        contacts[kind] = init_contact(kind);
        is_initialised[kind] = 1;
    }
    return contacts[kind];
}

/* Variants of elements: the normal inputs, with one direction and with two. */
enum { VARIANTS = 4, TWO_DIRECTIONS = 2 };
static inline int32_t normal_input_of(int variant)
{
    return MSLIP_INPUT_APPROACH + variant % 2;
}

static inline int32_t directions_of(int variant)
{
    return 1 + variant / TWO_DIRECTIONS;
}

static inline void init_element(int kind, int variant, mslip_element *element)
{
    const int32_t directions = directions_of(variant), normal_input = normal_input_of(variant);
    mslip_parameters p = flat_parameters();
    mslip_elliptic_parameters e = elliptic_parameters();
    p.flat_half_width *= kind != CYLINDER;
    p.friction_coefficient *= kind != FRICTIONLESS;
    p.displacement_reference = kind == OPEN ? MSLIP_RIGID_STRIP : MSLIP_CENTRE_POINT;
    CHECK((kind == ELLIPSE ? mslip_element_init_elliptic(&e, directions, normal_input, element)
                           : mslip_element_init(&p, directions, normal_input, element)) == MSLIP_OK);
}

/* The element as initialised by the first call. */
static inline const mslip_element *element_of(int kind, int variant)
{
    static mslip_element elements[KINDS][VARIANTS];
    static int is_initialised[KINDS][VARIANTS];
    if (!is_initialised[kind][variant]) {
        init_element(kind, variant, &elements[kind][variant]);
        is_initialised[kind][variant] = 1;
    }
    return &elements[kind][variant];
}

static inline int same_bits(const double *p, const double *q, size_t n)
{
    return memcmp(p, q, n * sizeof *p) == 0;
}

enum { ITEMS = 5, HARMONICS = 2, SAMPLES = 16, PERIODS = 2 };
enum { COEFFICIENTS = 2 * HARMONICS + 1 };
/* The largest numbers of components of a displacement, and of coefficients. */
enum { COMPONENTS = 3, ALL_COEFFICIENTS = COMPONENTS * COEFFICIENTS };
enum { ELEMENT_SQUARE = ALL_COEFFICIENTS * ALL_COEFFICIENTS };
/* The length of each state, and the reversals or pieces in use. */
enum { STATE = 1865, USED = 3, USED_PIECES = 5 };

#include "functions.h"

/* The kinds of a function's arguments, by which the drivers distinguish functions. */
enum { TAKES_STATE = 1 << ARG_STATE, TAKES_WORKSPACE = 1 << ARG_WORKSPACE,
       TAKES_TABLE = 1 << ARG_TABLE, IS_BATCH = 1 << ARG_INDEX, IS_ELEMENT = 1 << 30, IS_IWAN = 1 << 29 };

static arguments call;

#define CALL(name, ...) \
    static int32_t call_##name(void) \
    { \
        return mslip_##name(__VA_ARGS__); \
    }
#include "functions.h"

typedef struct {
    const char *name;
    int32_t (*call)(void);
    int directions; /* the most */
    argument argument[MOST_ARGUMENTS]; /* until the first without a name */
    /* Derived from the arguments: */
    unsigned takes;
    int rule;            /* of the workspace; variant of the elements */
    int scalar;          /* quantity passed by value */
    int kind;            /* quantity of the input array; the tangential one of the displacements of an element */
    size_t inputs;       /* its length */
    size_t out[OUTPUTS]; /* lengths of the outputs */
} function;

/* Each with every rule of a workspace or every variant of an element. */
static function functions[128];
static int FUNCTIONS;

static inline size_t extent_of(const char *extents, size_t components)
{
    size_t extent = 1;
    for (; *extents != '\0'; ++extents) {
        const size_t factor = *extents == 'k' ? COEFFICIENTS : 1;
        extent *= *extents == 'n' ? ITEMS : *extents == 'p' ? MSLIP_PARAMETER_COUNT : components * factor;
    }
    return extent;
}

static inline void add_function(function f, int rule)
{
    const size_t components = f.takes & IS_ELEMENT ? (size_t)directions_of(rule) + 1 : 1;
    f.rule = rule;
    for (const argument *a = f.argument; a->name != NULL; ++a) {
        const size_t extent = extent_of(a->extents, components);
        if (a->kind == ARG_VALUE) {
            f.scalar = a->quantity;
        } else if (a->kind == ARG_INPUT) {
            f.kind = a->quantity;
            f.inputs = extent;
        } else if (a->kind == ARG_OUTPUT) {
            f.out[(a->field - offsetof(arguments, out)) / sizeof(double *)] = extent;
        } else if (a->kind == ARG_NEW_STATE) {
            f.out[0] = STATE * (f.takes & IS_BATCH ? ITEMS : 1);
        }
    }
    functions[FUNCTIONS++] = f;
}

static inline void make_functions(void)
{
    static const function described[] = {
#define FUNCTION(id, most, ...) { .name = "mslip_" #id, .call = call_##id, .directions = most, .argument = { __VA_ARGS__ } },
#include "functions.h"
    };
    for (size_t i = 0; i < LENGTH(described); ++i) {
        function f = described[i];
        f.takes = strstr(f.name, "element") || strstr(f.name, "normal_") ? IS_ELEMENT : strstr(f.name, "iwan") ? IS_IWAN : 0;
        for (const argument *a = f.argument; a->name != NULL; ++a) {
            f.takes |= 1u << a->kind;
        }
        if ((f.takes & (1 << ARG_CONTACT | 1 << ARG_ELEMENT)) && (f.takes & 1 << ARG_OUTPUT)) {
            const int rules = f.takes & IS_ELEMENT ? f.directions * 2 : f.takes & TAKES_WORKSPACE ? 2 : 1;
            for (int rule = 0; rule < rules; ++rule) {
                add_function(f, rule);
            }
        }
    }
}

static inline size_t items_of(const function *f)
{
    return f->takes & IS_BATCH ? ITEMS : 1;
}

/* Directions of a function's elements, and components of a displacement. */
static inline int32_t directions_for(const function *f)
{
    return directions_of(f->rule);
}

static inline size_t components_of(const function *f)
{
    return (size_t)directions_for(f) + 1;
}

/* Memory of the arguments of a call, also for the longest workspace. */
static mslip_contact contact_memory[ITEMS];
static mslip_element element_memory[ITEMS];
static int32_t index_memory[ITEMS], active_memory[ITEMS];
static double input_memory[ITEMS * ALL_COEFFICIENTS], state_memory[ITEMS * STATE], workspace_memory[1 << 14];
static double table_memory[1 << 10], out_memory[OUTPUTS][ITEMS * (STATE + ELEMENT_SQUARE)];

/* The length of a function's workspace; 0 if it takes none. An element has uniform sampling only. */
static inline size_t workspace_length(const function *f)
{
    return !(f->takes & TAKES_WORKSPACE) ? 0
        : f->takes & IS_ELEMENT
        ? mslip_element_workspace_length(directions_for(f), HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING)
        : mslip_harmonic_workspace_length(HARMONICS, SAMPLES, f->rule);
}

static inline void init_workspace(const function *f)
{
    CHECK((f->takes & IS_ELEMENT ? mslip_element_workspace_init(directions_for(f), HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING,
                                                                PERIODS, call.workspace_length, call.workspace)
                                 : mslip_harmonic_workspace_init(HARMONICS, SAMPLES, f->rule, call.workspace_length,
                                                                 call.workspace)) == MSLIP_OK);
}

/* The inputs, to be modified by tests. */
#define CONTACTS ((mslip_contact *)(size_t)call.contacts)
#define ELEMENTS ((mslip_element *)(size_t)call.elements)
#define INPUT ((double *)(size_t)call.input)
#define STATES ((double *)(size_t)call.state)

/* The contact or the element of item i. */
static inline void *law_at(const function *f, size_t i)
{
    return f->takes & IS_ELEMENT ? (void *)&ELEMENTS[i] : (void *)&CONTACTS[i];
}

static inline void set_law(const function *f, size_t i, int kind)
{
    if (f->takes & IS_ELEMENT) {
        ELEMENTS[i] = *element_of(kind, f->rule);
    } else {
        CONTACTS[i] = contact_of(kind);
    }
}

/* The quantity of input i: displacements of an element and their coefficients are normal after one or two tangential ones. */
static inline int kind_of_input(const function *f, size_t i)
{
    const size_t share = f->takes & TAKES_WORKSPACE ? COEFFICIENTS : 1;
    const int normal = share == 1 ? APPROACH : APPROACH_COEFFICIENT;
    const size_t m = components_of(f);
    const int is_normal = (f->takes & IS_ELEMENT) && f->kind == DISPLACEMENT && i / share % m == m - 1;
    return !is_normal ? f->kind : normal_input_of(f->rule) == MSLIP_INPUT_APPROACH ? normal : normal + 1;
}

/* A decaying vibration: each displacement adds a reversal. */
static inline double decaying(int reversals)
{
    return (reversals % 2 == 0 ? 1e-8 : -1e-8) * (1.0 - 0.05 * reversals);
}

/* A state of USED nested reversals; of an element one of USED_PIECES pieces, by a rising load with displacements to and fro, all
   sticking. */
static inline void fill_state(const function *f, const void *law, double *state)
{
    const mslip_element *element = law;
    if (!(f->takes & IS_ELEMENT)) {
        CHECK(mslip_state_init(STATE, state) == MSLIP_OK);
        for (int k = 0; k <= USED; ++k) {
            CHECK(mslip_masing_update(law, STATE, state, decaying(k), state, NULL, NULL, NULL) == MSLIP_OK);
        }
        return;
    }
    CHECK(mslip_element_state_init(element->directions, STATE, state) == MSLIP_OK);
    for (int k = 0; k < USED_PIECES; ++k) {
        const double u = 0.01 * element->friction_coefficient * element->approach * (k % 2 == 0 ? 1.0 : -1.0);
        const double whole = element->normal_input == MSLIP_INPUT_NORMAL_FORCE ? element->normal_force : element->approach;
        const double w = whole * (0.1 + 0.15 * k);
        const double step[COMPONENTS] = { u, element->directions == 1 ? w : 0.7 * u, w };
        CHECK(mslip_element_update(element, STATE, state, step, state, NULL, NULL, NULL) == MSLIP_OK);
    }
}

/* Fills the states for the contacts or elements of the call. */
static inline void fill_states(const function *f)
{
    for (size_t i = 0; (f->takes & TAKES_STATE) && i < items_of(f); ++i) {
        fill_state(f, law_at(f, i), STATES + i * STATE);
    }
}

/* Initialises the table of the shape of the contact. */
static inline void fill_table(const function *f)
{
    if (f->takes & TAKES_TABLE) {
        CHECK(mslip_stiffness_table_init(call.contacts, mslip_stiffness_table_length(), call.table) == MSLIP_OK);
    }
}

static inline double valid_value(int kind, size_t i, double slip_force)
{
    switch (kind) {
        case X: return 1e-4 * ((double)i - 2.0);
        case FORCE: return slip_force * (0.2 * (double)i - 0.35);
        case FORCE_AMPLITUDE: return 0.2 * slip_force * (double)i;
        case DISPLACEMENT: return 1e-8 * (1.3 * (double)(i % 4) - 2.0);
        case AMPLITUDE: return 4e-8 * (double)(i + 1);
        case APPROACH: return 6e-8 * (2.5 - (double)(i / 2 % 4)); /* the last of four is open */
        case NORMAL_FORCE: return 40.0 * (3.0 - (double)(i / 2 % 4));
        case APPROACH_COEFFICIENT: return 1.2e-7 * (i % COEFFICIENTS == 0 ? 1.0 : 0.15 * (double)(i % 2 + 1)); /* not open */
        case FORCE_COEFFICIENT: return 80.0 * (i % COEFFICIENTS == 0 ? 1.0 : 0.15 * (double)(i % 2 + 1));
        default: return 0.0;
    }
}

/* Valid arguments. Items have contacts or elements of three kinds by turns. */
static inline void set_up(const function *f)
{
    memset(&call, 0, sizeof call);
    call.contacts = contact_memory;
    call.elements = element_memory;
    call.index = index_memory;
    call.active = active_memory;
    call.input = input_memory;
    call.state = state_memory;
    call.workspace = workspace_memory;
    call.table = table_memory;
    call.n = call.n_contacts = ITEMS;
    call.state_length = STATE;
    call.workspace_length = workspace_length(f);
    call.table_length = mslip_stiffness_table_length();
    CHECK(call.workspace_length <= LENGTH(workspace_memory) && call.table_length <= LENGTH(table_memory));
    for (int i = 0; i < ITEMS; ++i) {
        index_memory[i] = i;
        active_memory[i] = 1;
        set_law(f, (size_t)i, i % 3);
    }
    for (int i = 0; i < OUTPUTS; ++i) {
        call.out[i] = out_memory[i];
    }
    fill_states(f);
    fill_table(f);
    if (f->takes & TAKES_WORKSPACE) {
        init_workspace(f);
    }
    const double slip_force = f->takes & IS_ELEMENT ? 0.0 : CONTACTS->slip_force;
    call.scalar = valid_value(f->scalar, 3, slip_force);
    for (size_t i = 0; i < f->inputs; ++i) {
        INPUT[i] = valid_value(kind_of_input(f, i), i, slip_force);
    }
}

#endif
