/* calls.h: contacts and elements, memory that ends at a protected page, and a table of every function that takes one of them with a
   valid call of each, of which the drivers invalidate one argument at a time. */
#ifndef CALLS_H
#define CALLS_H

#include "check.h"

#include <float.h>
#include "outputs.h"
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#ifdef __unix__
#include <sys/mman.h>
#include <unistd.h>
#endif

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

static inline double from_bits(uint64_t bits)
{
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* NaN, quiet and signalling, of either sign, and infinities, as bits: an assignment of a double could trap. */
enum { NON_FINITE = 6 };
static const uint64_t non_finite[NON_FINITE] = {
    0x7ff8000000000000, 0xfff8000000000000, 0x7ff0000000000001, 0xfff4000000000000, 0x7ff0000000000000, 0xfff0000000000000,
};

/* Floating-point exceptions that an application may trap; cleared. */
static inline int raised(void)
{
    int flags = fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
    feclearexcept(FE_ALL_EXCEPT);
    return flags;
}

/* A buffer that ends at a protected page. */
enum { REGIONS = 14 };
typedef struct {
    unsigned char *start;
    size_t bytes;
} region;
static region regions[REGIONS];
static int regions_made;

static inline region *make_region(size_t bytes)
{
    region *r = &regions[regions_made++];
#ifdef __unix__
    size_t page = (size_t)sysconf(_SC_PAGESIZE);
    r->bytes = (bytes + page - 1) / page * page;
    r->start = mmap(NULL, r->bytes + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (r->start == MAP_FAILED || mprotect(r->start + r->bytes, page, PROT_NONE) != 0) {
        perror("mmap");
        exit(2);
    }
#else
    r->bytes = bytes;
    r->start = malloc(bytes);
#endif
    if (regions_made > REGIONS || r->start == NULL) {
        fputs("out of memory\n", stderr);
        exit(2);
    }
    memset(r->start, 0x5a, r->bytes);
    return r;
}

/* The last bytes of a region. */
static inline void *last(const region *r, size_t bytes)
{
    return r->start + r->bytes - bytes;
}

enum { ITEMS = 5, HARMONICS = 2, SAMPLES = 16, PERIODS = 2 };
enum { COEFFICIENTS = 2 * HARMONICS + 1, SQUARE = COEFFICIENTS * COEFFICIENTS };
/* The largest numbers of components of a displacement, and of coefficients. */
enum { COMPONENTS = 3, TANGENT = COMPONENTS * COMPONENTS, ALL_COEFFICIENTS = COMPONENTS * COEFFICIENTS };
enum { ELEMENT_SQUARE = ALL_COEFFICIENTS * ALL_COEFFICIENTS };
/* The state of a contact, which is also long enough for that of an element, and the reversals or pieces in use. */
enum { REVERSALS = 620, STATE = 5 + 3 * REVERSALS, USED = 3, PIECES = 463, USED_PIECES = 5 };

#include "functions.h"

/* The kinds of a function's arguments, by which the drivers distinguish functions. */
enum { TAKES_COUNT = 1 << ARG_COUNT, TAKES_STATE = 1 << ARG_STATE, TAKES_WORKSPACE = 1 << ARG_WORKSPACE,
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

/* First the functions with a contact or an element and outputs, then those that initialise or check memory; each with every rule of
   a workspace or every variant of an element. */
static function functions[128];
static int FUNCTIONS, ALL_FUNCTIONS;

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
    functions[ALL_FUNCTIONS++] = f;
}

static inline void make_functions(void)
{
    static const function described[] = {
#define FUNCTION(id, most, ...) { .name = "mslip_" #id, .call = call_##id, .directions = most, .argument = { __VA_ARGS__ } },
#include "functions.h"
    };
    for (int others = 0; others < 2; ++others) {
        for (size_t i = 0; i < LENGTH(described); ++i) {
            function f = described[i];
            f.takes = strstr(f.name, "element") || strstr(f.name, "normal_") ? IS_ELEMENT : strstr(f.name, "iwan") ? IS_IWAN : 0;
            for (const argument *a = f.argument; a->name != NULL; ++a) {
                f.takes |= 1u << a->kind;
            }
            const int is_other = !(f.takes & (1 << ARG_CONTACT | 1 << ARG_ELEMENT)) || !(f.takes & 1 << ARG_OUTPUT);
            const int has_rule = (f.takes & TAKES_WORKSPACE) || strstr(f.name, "workspace");
            const int rules = f.takes & IS_ELEMENT ? f.directions * 2 : has_rule ? 2 : 1;
            for (int rule = 0; is_other == others && rule < rules; ++rule) {
                add_function(f, rule);
            }
        }
        FUNCTIONS = others ? FUNCTIONS : ALL_FUNCTIONS;
    }
}

static inline const function *find(const char *name, int rule)
{
    for (int i = 0; i < ALL_FUNCTIONS; ++i) {
        if (strcmp(functions[i].name, name) == 0 && functions[i].rule == rule) {
            return &functions[i];
        }
    }
    fprintf(stderr, "no function %s\n", name);
    exit(2);
}

static inline const argument *argument_of(const function *f, int kind)
{
    const argument *a = f->argument;
    while (a->name != NULL && a->kind != kind) {
        ++a;
    }
    return a;
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

static region *contact_region, *element_region, *index_region, *active_region, *input_region, *state_region, *workspace_region;
static region *table_region, *out_regions[OUTPUTS];

/* The workspace of a function: an element has uniform sampling only. */
static inline size_t workspace_length_of(const function *f, size_t harmonics, size_t samples)
{
    return f->takes & IS_ELEMENT ? mslip_element_workspace_length(directions_for(f), harmonics, samples, MSLIP_UNIFORM_SAMPLING)
                                 : mslip_harmonic_workspace_length(harmonics, samples, f->rule);
}

static inline void init_workspace(const function *f, size_t harmonics, size_t samples, size_t length, double *workspace)
{
    CHECK((f->takes & IS_ELEMENT
               ? mslip_element_workspace_init(directions_for(f), harmonics, samples, MSLIP_UNIFORM_SAMPLING, PERIODS, length,
                                              workspace)
               : mslip_harmonic_workspace_init(harmonics, samples, f->rule, length, workspace)) == MSLIP_OK);
}

/* The length of the workspace that the calls of the table have; 0 if the function takes none. */
static inline size_t workspace_length(const function *f)
{
    return strstr(f->name, "workspace") || (f->takes & TAKES_WORKSPACE) ? workspace_length_of(f, HARMONICS, SAMPLES) : 0;
}

static inline void make_regions(void)
{
    size_t longest = STATE;
    make_functions();
    for (int i = 0; i < ALL_FUNCTIONS; ++i) {
        const size_t length = workspace_length(&functions[i]);
        longest = length > longest ? length : longest;
    }
    contact_region = make_region(ITEMS * sizeof(mslip_contact));
    element_region = make_region(ITEMS * sizeof(mslip_element));
    index_region = make_region(ITEMS * sizeof(int32_t));
    active_region = make_region(ITEMS * sizeof(int32_t));
    input_region = make_region(ITEMS * ALL_COEFFICIENTS * sizeof(double));
    state_region = make_region(ITEMS * STATE * sizeof(double));
    workspace_region = make_region(longest * sizeof(double));
    table_region = make_region(mslip_stiffness_table_length() * sizeof(double));
    for (int i = 0; i < OUTPUTS; ++i) {
        out_regions[i] = make_region(ITEMS * (STATE + ELEMENT_SQUARE) * sizeof(double));
    }
}

/* The inputs, to be modified by tests. */
#define CONTACTS ((mslip_contact *)(size_t)call.contacts)
#define ELEMENTS ((mslip_element *)(size_t)call.elements)
#define INDICES ((int32_t *)(size_t)call.index)
#define ACTIVE ((int32_t *)(size_t)call.active)
#define INPUT ((double *)(size_t)call.input)
#define STATES ((double *)(size_t)call.state)

/* The contact or the element of item i, its size, and the status of an invalid one. */
static inline void *law_at(const function *f, size_t i)
{
    return f->takes & IS_ELEMENT ? (void *)&ELEMENTS[i] : (void *)&CONTACTS[i];
}

static inline size_t law_size(const function *f)
{
    return f->takes & IS_ELEMENT ? sizeof(mslip_element) : sizeof(mslip_contact);
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

/* The status of input i if it is not finite. */
static inline int32_t status_of_input(const function *f, size_t i)
{
    return kind_of_input(f, i) == NORMAL_FORCE ? MSLIP_BAD_NORMAL_FORCE : argument_of(f, ARG_INPUT)->status;
}

/* Lengths of the shortest state, and of one for the reversals or pieces in use. */
static inline size_t least_state(const function *f)
{
    return f->takes & IS_ELEMENT ? mslip_element_state_length(directions_for(f), 0) : mslip_state_length(0);
}

/* Doubles of a state that a step writes: all, for an element those in use, with one direction 8 and 4 for each knot, whose number
   is in the tag. */
static inline size_t written_state(const function *f, const double *state)
{
    uint64_t tag;
    memcpy(&tag, state, sizeof tag);
    if ((f->takes & IS_ELEMENT) && directions_for(f) == 2) {
        return least_state(f);
    }
    return f->takes & IS_ELEMENT ? 8 + 4 * (size_t)(tag & 0xff) : STATE;
}

static inline int same_states(const function *f, const double *states, const double *others)
{
    int same = 1;
    for (size_t i = 0; i < f->out[0]; i += STATE) {
        same &= same_bits(states + i, others + i, written_state(f, states + i));
    }
    return same;
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

/* The state of a contact or element of the list, as filled for the first call. */
static inline const double *state_of(const function *f, int kind)
{
    static double states[VARIANTS + 1][KINDS][STATE];
    static int is_filled[VARIANTS + 1][KINDS];
    const int variant = f->takes & IS_ELEMENT ? f->rule : VARIANTS;
    if (!is_filled[variant][kind]) {
        const mslip_contact contact = contact_of(kind);
        memset(states[variant][kind], 0x5a, sizeof states[variant][kind]);
        fill_state(f, f->takes & IS_ELEMENT ? (const void *)element_of(kind, variant) : &contact, states[variant][kind]);
        is_filled[variant][kind] = 1;
    }
    return states[variant][kind];
}

/* Initialises the table of the shape of the contact. */
static inline void fill_table(const function *f)
{
    if (f->takes & TAKES_TABLE) {
        CHECK(mslip_stiffness_table_init(call.contacts, mslip_stiffness_table_length(), call.table) == MSLIP_OK);
    }
}

static inline void fill_outputs(void)
{
    for (int i = 0; i < OUTPUTS; ++i) {
        memset(out_regions[i]->start, 0xff, out_regions[i]->bytes); /* NaN */
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

/* The kind of the first contact or element of each call. */
static int first_kind;

/* Memory for an argument, just before a protected page. */
static inline void set_pointer(const argument *a, region *r, size_t bytes)
{
    void *const memory = last(r, bytes);
    memcpy((char *)&call + a->field, &memory, sizeof memory);
}

static inline void set_up_argument(const function *f, const argument *a)
{
    const size_t items = items_of(f);
    const double slip_force = (f->takes & IS_ELEMENT) ? 0.0 : contact_of(first_kind % 3).slip_force;
    const mslip_parameters p = flat_parameters();
    const mslip_elliptic_parameters e = elliptic_parameters();
    switch (a->kind) {
        case ARG_CONTACT:
        case ARG_ELEMENT:
            set_pointer(a, a->kind == ARG_ELEMENT ? element_region : contact_region, items * law_size(f));
            for (size_t i = 0; i < items; ++i) {
                set_law(f, i, (first_kind + (int)i) % 3);
            }
            break;
        case ARG_PARAMETERS:
        case ARG_ELLIPTIC_PARAMETERS: {
            const size_t bytes = a->kind == ARG_PARAMETERS ? sizeof p : sizeof e;
            set_pointer(a, input_region, bytes);
            memcpy(last(input_region, bytes), a->kind == ARG_PARAMETERS ? (const void *)&p : &e, bytes);
            break;
        }
        case ARG_NEW_CONTACT: set_pointer(a, contact_region, sizeof(mslip_contact)); break;
        case ARG_NEW_ELEMENT: set_pointer(a, element_region, sizeof(mslip_element)); break;
        case ARG_INDEX:
        case ARG_ACTIVE:
            set_pointer(a, a->kind == ARG_INDEX ? index_region : active_region, items * sizeof(int32_t));
            for (size_t i = 0; i < items; ++i) {
                *(a->kind == ARG_INDEX ? &INDICES[i] : &ACTIVE[i]) = a->kind == ARG_INDEX ? (int32_t)i : 1;
            }
            break;
        case ARG_STATE:
            set_pointer(a, state_region, items * STATE * sizeof(double));
            for (size_t i = 0; i < items; ++i) {
                memcpy(STATES + i * STATE, state_of(f, (first_kind + (int)i) % 3), STATE * sizeof(double));
            }
            break;
        case ARG_WORKSPACE:
            set_pointer(a, workspace_region, workspace_length(f) * sizeof(double));
            init_workspace(f, HARMONICS, SAMPLES, workspace_length(f), call.workspace);
            break;
        case ARG_TABLE:
            set_pointer(a, table_region, call.table_length * sizeof(double));
            fill_table(f);
            break;
        case ARG_BUFFER:
            set_pointer(a, strstr(f->name, "table") ? table_region : workspace_region,
                        (strstr(f->name, "table") ? call.table_length : strstr(f->name, "state") ? STATE : workspace_length(f))
                            * sizeof(double));
            break;
        case ARG_VALUE: call.scalar = valid_value(f->scalar, 3, slip_force); break;
        case ARG_INPUT:
            set_pointer(a, input_region, f->inputs * sizeof(double));
            for (size_t i = 0; i < f->inputs; ++i) {
                INPUT[i] = valid_value(kind_of_input(f, i), i, slip_force);
            }
            break;
        case ARG_NEW_STATE: set_pointer(a, out_regions[0], f->out[0] * sizeof(double)); break;
        case ARG_OUTPUT: {
            const size_t k = (a->field - offsetof(arguments, out)) / sizeof(double *);
            set_pointer(a, out_regions[k], f->out[k] * sizeof(double));
            break;
        }
        case ARG_FOUND_CHOICE: set_pointer(a, out_regions[*a->name == 'd'], sizeof(int32_t)); break;
        case ARG_FOUND_SIZE: set_pointer(a, out_regions[*a->name == 'p' ? 4 : 2 + (*a->name == 'h')], sizeof(size_t)); break;
        default: break;
    }
}

/* Valid arguments. Items have contacts or elements of three kinds by turns. */
static inline void set_up(const function *f)
{
    const int is_element = (f->takes & IS_ELEMENT) != 0;
    memset(&call, 0, sizeof call);
    call.n = call.n_contacts = ITEMS;
    call.state_length = STATE;
    call.workspace_length = workspace_length(f);
    call.table_length = mslip_stiffness_table_length();
    call.harmonics = HARMONICS;
    call.samples = SAMPLES;
    call.periods = PERIODS;
    call.directions = is_element ? directions_for(f) : 0;
    call.normal_input = normal_input_of(f->rule);
    call.rule = is_element ? MSLIP_UNIFORM_SAMPLING : f->rule;
    for (const argument *a = f->argument; a->name != NULL; ++a) {
        set_up_argument(f, a);
    }
}

#endif
