/* calls.h: a table of every function that takes a contact or an element and has outputs, with the memory of a call. */
#ifndef CALLS_H
#define CALLS_H

#include "check.h"

#include "outputs.h"
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#define LENGTH(array) (sizeof(array) / sizeof *(array))

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

enum { ITEMS = 5, HARMONICS = 2, SAMPLES = 16, PERIODS = 2 };
enum { COEFFICIENTS = 2 * HARMONICS + 1 };
/* The largest numbers of components of a displacement, and of coefficients. */
enum { COMPONENTS = 3, ALL_COEFFICIENTS = COMPONENTS * COEFFICIENTS };
enum { ELEMENT_SQUARE = ALL_COEFFICIENTS * ALL_COEFFICIENTS };
/* The length of each state. */
enum { STATE = 1865 };

#include "functions.h"

/* The kinds of a function's arguments, by which the drivers distinguish functions. */
enum { TAKES_STATE = 1 << ARG_STATE, TAKES_WORKSPACE = 1 << ARG_WORKSPACE,
       TAKES_TABLE = 1 << ARG_TABLE, IS_BATCH = 1 << ARG_INDEX, IS_ELEMENT = 1 << 30 };

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
        f.takes = strstr(f.name, "element") || strstr(f.name, "normal_") ? IS_ELEMENT : 0;
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

/* The quantity of input i: displacements of an element and their coefficients are normal after one or two tangential ones. */
static inline int kind_of_input(const function *f, size_t i)
{
    const size_t share = f->takes & TAKES_WORKSPACE ? COEFFICIENTS : 1;
    const int normal = share == 1 ? APPROACH : APPROACH_COEFFICIENT;
    const size_t m = components_of(f);
    const int is_normal = (f->takes & IS_ELEMENT) && f->kind == DISPLACEMENT && i / share % m == m - 1;
    return !is_normal ? f->kind : normal_input_of(f->rule) == MSLIP_INPUT_APPROACH ? normal : normal + 1;
}

/* Memory of all arguments; contacts or elements, states, table and inputs are those of the caller. */
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
    }
    for (int i = 0; i < OUTPUTS; ++i) {
        call.out[i] = out_memory[i];
    }
    if (f->takes & TAKES_WORKSPACE) {
        init_workspace(f);
    }
}

#endif
