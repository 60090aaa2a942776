/* Random contacts, elements and motions from the whole range that is allowed, in the four rounding modes: no call raises an
   exception that may be trapped, every state that results passes its check, and no call takes more stack than docs/cluster.md
   states.

   extremes [FIRST [DRAWS]]: the number of a draw is its seed. */
#include "check.h"

#include "outputs.h"
#include <pthread.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>

#define LENGTH(array) (sizeof(array) / sizeof *(array))

/* --- Every function that takes a contact or an element and has outputs, with the memory of a call --- */

/* Variants of elements: the normal inputs, with one direction and with two. */
enum { VARIANTS = 4, TWO_DIRECTIONS = 2 };
static int32_t normal_input_of(int variant)
{
    return MSLIP_INPUT_APPROACH + variant % 2;
}

static int32_t directions_of(int variant)
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
enum { TAKES_STATE = 1 << ARG_STATE, TAKES_WORKSPACE = 1 << ARG_WORKSPACE, IS_BATCH = 1 << ARG_INDEX, IS_ELEMENT = 1 << 30 };

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

static void add_function(function f, int rule)
{
    const size_t components = f.takes & IS_ELEMENT ? (size_t)directions_of(rule) + 1 : 1;
    f.rule = rule;
    for (const argument *a = f.argument; a->name != NULL; ++a) {
        const size_t extent = extent_of(a->extents, ITEMS, components, COEFFICIENTS);
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

static void make_functions(void)
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

/* Memory of the arguments of a call, also for the longest workspace. */
static mslip_contact contact_memory[ITEMS];
static mslip_element element_memory[ITEMS];
static int32_t index_memory[ITEMS], active_memory[ITEMS];
static double input_memory[ITEMS * ALL_COEFFICIENTS], state_memory[ITEMS * STATE], workspace_memory[1 << 14];
static double out_memory[OUTPUTS][ITEMS * (STATE + ELEMENT_SQUARE)];

/* The quantity of input i: displacements of an element and their coefficients are normal after one or two tangential ones. */
static int kind_of_input(const function *f, size_t i)
{
    const size_t share = f->takes & TAKES_WORKSPACE ? COEFFICIENTS : 1;
    const int normal = share == 1 ? APPROACH : APPROACH_COEFFICIENT;
    const size_t m = (size_t)directions_of(f->rule) + 1;
    const int is_normal = (f->takes & IS_ELEMENT) && f->kind == DISPLACEMENT && i / share % m == m - 1;
    return !is_normal ? f->kind : normal_input_of(f->rule) == MSLIP_INPUT_APPROACH ? normal : normal + 1;
}

/* Memory of all arguments; contacts or elements, states and inputs are those of the caller. */
static void set_up(const function *f)
{
    memset(&call, 0, sizeof call);
    call.contacts = contact_memory;
    call.elements = element_memory;
    call.index = index_memory;
    call.active = active_memory;
    call.input = input_memory;
    call.state = state_memory;
    call.workspace = workspace_memory;
    call.n = call.n_contacts = ITEMS;
    call.state_length = STATE;
    for (int i = 0; i < ITEMS; ++i) {
        index_memory[i] = i;
        active_memory[i] = 1;
    }
    for (int i = 0; i < OUTPUTS; ++i) {
        call.out[i] = out_memory[i];
    }
    if (f->takes & TAKES_WORKSPACE) {
        /* An element has uniform sampling only. */
        const int is_element = (f->takes & IS_ELEMENT) != 0;
        const int32_t directions = directions_of(f->rule), uniform = MSLIP_UNIFORM_SAMPLING;
        const size_t n = is_element ? mslip_element_workspace_length(directions, HARMONICS, SAMPLES, uniform)
                                    : mslip_harmonic_workspace_length(HARMONICS, SAMPLES, f->rule);
        call.workspace_length = n;
        CHECK(n <= LENGTH(workspace_memory)
              && (is_element ? mslip_element_workspace_init(directions, HARMONICS, SAMPLES, uniform, PERIODS, n, workspace_memory)
                             : mslip_harmonic_workspace_init(HARMONICS, SAMPLES, f->rule, n, workspace_memory)) == MSLIP_OK);
    }
}

/* --- Random numbers --- */

static uint64_t seed;

static uint64_t bits(void)
{
    uint64_t z = (seed += 0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
}

static double uniform(double low, double high)
{
    return low + (high - low) * (double)(bits() >> 11) * 0x1p-53;
}

static double log_uniform(double low, double high)
{
    return exp(uniform(log(low), log(high)));
}

/* One in n. */
static int one_in(int n)
{
    return bits() % (uint64_t)n == 0;
}

static double sign(void)
{
    return one_in(2) ? -1.0 : 1.0;
}

/* --- Calls --- */

static uint64_t draw;
static int is_warm; /* the linker has resolved the functions of the C library, for which it takes stack of its own */
static int rounding;
static const int roundings[] = { FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO };

/* The thread's stack, of which a part below the caller is filled with a pattern, and the deepest use for each number of
   directions. */
enum { STACK = 1 << 20, FILLED = 320 * 1024, OWN_FRAME = 1024 };
static const uint64_t pattern = 0xa5a5a5a5a5a5a5a5;
static uint64_t *stack;
static size_t deepest[3];
static const char *deepest_name[3];

static void failed(const char *name, const char *what)
{
    if (!CHECK(0)) {
        printf("    draw %llu, rounding %d, %s: %s\n", (unsigned long long)draw, rounding, name, what);
    }
}

/* The words of the stack below this frame. */
static size_t words_below(void)
{
    const volatile char here = 0;
    return ((uintptr_t)&here - (uintptr_t)stack - OWN_FRAME) / sizeof *stack;
}

static int32_t status;
/* One past the words that are filled. */
static size_t end;

static void before_call(void)
{
    end = words_below();
    for (size_t i = end - FILLED / sizeof *stack; i < end; ++i) {
        stack[i] = pattern;
    }
    fesetround(roundings[rounding]);
    feclearexcept(FE_ALL_EXCEPT);
}

static int32_t after_call(const char *name, int32_t directions)
{
    const int flags = fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
    fesetround(FE_TONEAREST);
    size_t i = end - FILLED / sizeof *stack;
    while (i < end && stack[i] == pattern) {
        ++i;
    }
    const size_t depth = (end - i) * sizeof *stack + OWN_FRAME;
    if (is_warm && depth > deepest[directions]) {
        deepest[directions] = depth;
        deepest_name[directions] = name;
    }
    if (flags != 0) {
        failed(name, flags & FE_OVERFLOW ? "overflow" : flags & FE_INVALID ? "invalid operation" : "division by zero");
    }
    return status;
}

/* A call with contacts, 0 directions, or elements. */
#define MAKE(name, directions, call) (before_call(), status = (call), after_call(name, directions))

/* --- Contacts and elements --- */

static mslip_parameters line;
static mslip_elliptic_parameters ellipse;
static int is_elliptic;
static mslip_contact contact;
static int has_contact, has_element[VARIANTS];
static mslip_element elements[VARIANTS];
/* The largest approach and the largest normal force. */
static double largest[2];

static void draw_materials(mslip_material *material)
{
    for (int i = 0; i < 2; ++i) {
        material[i].young_modulus = one_in(4) ? log_uniform(1e-20, 1e30) : log_uniform(1e9, 1e12);
        material[i].poisson_ratio = one_in(4) ? 0.0 : one_in(4) ? 0.5 : uniform(0.0, 0.5);
    }
}

/* The length near the shortest one that is allowed with this force per length. */
static void shorten(int32_t directions)
{
    const double load = line.normal_force / line.length;
    double low = 1e-9 * line.length, high = line.length;
    for (int i = 0; i < 60; ++i) {
        line.length = sqrt(low) * sqrt(high);
        line.normal_force = load * line.length;
        const int is_long = directions == 0 ? mslip_contact_init(&line, &contact) == MSLIP_OK
                                            : mslip_element_init(&line, directions, MSLIP_INPUT_APPROACH, elements) == MSLIP_OK;
        *(is_long ? &high : &low) = line.length;
    }
    line.length = high * (1.0 + (one_in(2) ? uniform(0.0, 4.0) : log_uniform(1e-16, 1.0)));
    line.normal_force = load * line.length;
}

/* About as compliant as the contact, or of any magnitude. */
static double compliance(double stiffness)
{
    return one_in(8) ? 0.0 : (one_in(8) ? log_uniform(1e-200, 1e200) : log_uniform(1e-4, 1e4)) / stiffness;
}

/* A layer for every fourth contact that has a stiffness. */
static void draw_layer(void)
{
    mslip_layer layer;
    const double normal_force = is_elliptic ? ellipse.normal_force : line.normal_force;
    const int32_t alone = is_elliptic ? mslip_contact_init_elliptic(&ellipse, &contact) : mslip_contact_init(&line, &contact);
    if (alone != MSLIP_OK || contact.initial_stiffness <= 0.0) return;
    layer.normal_compliance = compliance(contact.initial_stiffness);
    layer.tangential_compliance = compliance(contact.initial_stiffness);
    layer.stiffening_load = one_in(3) ? 0.0 : normal_force * (one_in(8) ? log_uniform(1e-3, 1e100) : log_uniform(1e-3, 10.0));
    line.layer = ellipse.layer = layer;
}

/* A cylinder whose initial compliance is a rounding of 2L/b: upward, that of an interior stick zone comes out as 0. */
static void set_smallest_compliance(void)
{
    line.flat_half_width = 0.0;
    line.edge_radius = 0x1.a45ab24969372p-4;
    line.length = 0x1.defb5cf5285e8p-13;
    line.normal_force = 0x1.089908bc07ccfp+5;
    line.friction_coefficient = 0x1.470fb4015aec3p-1;
    line.displacement_reference = MSLIP_CENTRE_POINT;
    line.material[0] = (mslip_material){ 0x1.350a122719055p+37, 0.0 };
    line.material[1] = (mslip_material){ 2e11, 0.0 };
}

static void draw_parameters(void)
{
    /* Around usual values. */
    const double span = one_in(4) ? 1e60 : one_in(2) ? 1e6 : 10.0;
    const double normal_force = 100.0 * log_uniform(1.0 / span, span);
    const double friction = one_in(16) ? 0.0 : one_in(4) ? log_uniform(1e-20, 1e20) : uniform(0.01, 2.0);
    is_elliptic = one_in(3);
    mslip_parameters_default(&line);
    mslip_elliptic_parameters_default(&ellipse);
    line.edge_radius = 0.02 * log_uniform(1.0 / span, span);
    line.flat_half_width = one_in(3) ? 0.0 : line.edge_radius * (one_in(2) ? uniform(0.0, 0.2) : log_uniform(1e-20, 1e3));
    line.length = 0.02 * log_uniform(1.0 / span, span);
    line.normal_force = ellipse.normal_force = one_in(32) ? 0.0 : normal_force;
    line.friction_coefficient = ellipse.friction_coefficient = friction;
    line.displacement_reference = one_in(2) ? MSLIP_RIGID_STRIP : MSLIP_CENTRE_POINT;
    ellipse.semi_axis_x = 1e-3 * log_uniform(1.0 / span, span);
    ellipse.semi_axis_y = one_in(4) ? ellipse.semi_axis_x : ellipse.semi_axis_x * log_uniform(1e-3, 1e3);
    draw_materials(line.material);
    draw_materials(ellipse.material);
    rounding = one_in(2) ? 0 : (int)(bits() % LENGTH(roundings));
    if (!is_elliptic && line.normal_force > 0.0 && one_in(2)) {
        shorten((int32_t)(bits() % 3));
    }
    if (draw % 100 < 4) {
        is_elliptic = 0;
        rounding = (int)(draw % 4);
        set_smallest_compliance();
    } else if (one_in(4)) {
        draw_layer();
    }
}

/* The largest approach or force that is allowed, at least `from`. */
static double largest_normal(const mslip_element *element, double from, int by_force)
{
    double low = from, high = 1e150;
    for (int i = 0; i < 60; ++i) {
        const double middle = sqrt(low) * sqrt(high);
        MAKE("normal law", 1, by_force ? mslip_normal_approach(element, 1, &middle, NULL, NULL, NULL)
                                       : mslip_normal_force(element, 1, &middle, NULL, NULL, NULL));
        *(status == MSLIP_OK ? &low : &high) = middle;
    }
    return low;
}

static void init_laws(void)
{
    has_contact = MAKE("mslip_contact_init", 0, is_elliptic ? mslip_contact_init_elliptic(&ellipse, &contact)
                                                            : mslip_contact_init(&line, &contact)) == MSLIP_OK;
    for (int i = 0; i < VARIANTS; ++i) {
        const int32_t directions = directions_of(i), input = normal_input_of(i);
        has_element[i] = MAKE("mslip_element_init", directions,
                              is_elliptic ? mslip_element_init_elliptic(&ellipse, directions, input, &elements[i])
                                          : mslip_element_init(&line, directions, input, &elements[i])) == MSLIP_OK;
    }
    for (int by_force = 0; by_force < 2 && has_element[by_force]; ++by_force) {
        const mslip_element *element = &elements[by_force];
        largest[by_force] = largest_normal(element, by_force ? element->normal_force : element->approach, by_force);
    }
}

/* --- Motions --- */

/* A share of 1: usual, or of any magnitude. */
static double share(void)
{
    return one_in(8) ? 0.0 : one_in(8) ? 1.0 : one_in(2) ? uniform(0.0, 1.0) : log_uniform(1e-300, 1.0);
}

/* A normal motion from the least to the largest; an approach may be negative. */
static double normal_motion(const mslip_element *element, int by_force)
{
    const double whole = by_force ? element->normal_force : element->approach;
    const double beyond = one_in(4) ? largest[by_force] : whole * pow(largest[by_force] / whole, uniform(0.0, 1.0));
    return one_in(8) ? beyond : whole * (!by_force && one_in(6) ? -share() : share());
}

static double value_of(const function *f, const mslip_element *element, size_t i)
{
    const int kind = f->inputs > 0 && f->kind != NONE ? kind_of_input(f, i) : f->scalar;
    const double slip = element == NULL ? contact.slip_displacement
                                        : element->friction_coefficient * element->normal_force / element->tangential_stiffness;
    const double far = one_in(16) ? log_uniform(1.0, 1e100) : uniform(0.0, 3.0);
    switch (kind) {
        case X: return sign() * 1.1 * share() * (element == NULL ? contact.half_width : element->half_width);
        case FORCE: return sign() * share() * contact.slip_force;
        case FORCE_AMPLITUDE: return share() * contact.slip_force;
        case DISPLACEMENT: return fmax(-1e150, fmin(sign() * share() * far * slip, 1e150));
        case AMPLITUDE: return fmin(share() * far * slip, 1e150);
        case APPROACH:
        case NORMAL_FORCE: return normal_motion(element, kind == NORMAL_FORCE);
        case APPROACH_COEFFICIENT: /* may open */
        case FORCE_COEFFICIENT:    /* stays positive */
            if (i % COEFFICIENTS == 0) {
                return share() * (kind == FORCE_COEFFICIENT ? element->normal_force : element->approach);
            }
            return sign() * share() * (kind == FORCE_COEFFICIENT ? 0.24 : 0.4) * input_memory[i - i % COEFFICIENTS];
        default: return 0.0;
    }
}

static size_t accepted_calls[LENGTH(functions)];

/* A history of calls; each continues from the states of the one before. */
static void make_calls(int which)
{
    const function *f = &functions[which];
    const int is_element = (f->takes & IS_ELEMENT) != 0, has_scalar = f->scalar != NONE;
    const mslip_element *element = is_element ? &elements[f->rule] : NULL;
    const size_t items = f->takes & IS_BATCH ? ITEMS : 1, m = (size_t)directions_of(f->rule) + 1;
    const int32_t directions = is_element ? directions_of(f->rule) : 0;
    if (is_element ? !has_element[f->rule] : !has_contact) {
        return;
    }
    set_up(f);
    for (size_t i = 0; i < items; ++i) {
        element_memory[i] = is_element ? *element : element_memory[i];
        contact_memory[i] = contact;
        if (f->takes & TAKES_STATE) {
            double *state = state_memory + i * STATE;
            CHECK((is_element ? mslip_element_state_init(directions, STATE, state) : mslip_state_init(STATE, state)) == MSLIP_OK);
        }
    }
    for (int repeated = 0; repeated < (f->takes & TAKES_STATE ? 8 : 2); ++repeated) {
        /* Often the normal component, or all of a displacement, is that before. */
        for (size_t i = 0; i < f->inputs; ++i) {
            const int stays = is_element && f->kind == DISPLACEMENT && !(f->takes & TAKES_WORKSPACE) && (i >= m || repeated > 0)
                              && one_in(i % m == m - 1 ? 2 : 5);
            input_memory[i] = !stays ? value_of(f, element, i) : i >= m ? input_memory[i - m] : input_memory[f->inputs - m + i];
        }
        call.scalar = has_scalar ? value_of(&(function){ .scalar = f->scalar }, element, 0) : 0.0;
        for (int i = 0; i < OUTPUTS; ++i) {
            call.out[i] = f->out[i] > 0 && !one_in(6) ? out_memory[i] : NULL;
        }
        accepted_calls[which] += MAKE(f->name, directions, f->call()) == MSLIP_OK;
        if (status != MSLIP_OK || !(f->takes & TAKES_STATE) || call.out[0] == NULL) {
            continue;
        }
        memcpy(state_memory, call.out[0], f->out[0] * sizeof(double));
        for (size_t i = 0; i < items; ++i) {
            const double *state = state_memory + i * STATE;
            if (MAKE("state_check", directions, is_element ? mslip_element_state_check(directions, STATE, state)
                                                           : mslip_state_check(STATE, state)) != MSLIP_OK) {
                failed(f->name, "its state is rejected");
            }
        }
    }
}

/* The figures of docs/cluster.md: no call exceeds them, half of them is used, and a thread's stack has room for two calls. */
static void check_stack(void)
{
    FILE *document = fopen("docs/cluster.md", "r");
    char text[256];
    unsigned stated[3] = { 0, 0, 0 }, thread = 0;
    while (document != NULL && fgets(text, sizeof text, document) != NULL && thread == 0) {
        sscanf(text, "- **Stack**: at most %u kB per call, %u kB with two directions; `OMP_STACKSIZE=%uk`", &stated[1], &stated[2],
               &thread);
    }
    if (CHECK(document != NULL)) {
        fclose(document);
    }
    stated[0] = stated[1];
    for (int i = 0; i < 3; ++i) {
        printf("stack: %zu of %u kB by %s\n", deepest[i], stated[i], deepest_name[i]);
        CHECK(deepest[i] <= 1024 * (size_t)stated[i]);
    }
    CHECK(deepest[2] >= 512 * (size_t)stated[2] && thread >= 2 * stated[2]);
}

static uint64_t first_draw = 1, draws = 600;

static void *run(void *unused)
{
    for (uint64_t i = 0; i < draws; ++i) {
        seed = draw = first_draw + i;
        draw_parameters();
        init_laws();
        for (int which = 0; which < FUNCTIONS; ++which) {
            make_calls(which);
        }
        CHECK(1);
        is_warm = i >= 20;
    }
    return unused;
}

int main(int argc, char **argv)
{
    /* Traps stay disabled, so that a failure names its draw. */
    const int next = argc > 1 && strcmp(argv[1], "--trap") == 0 ? 2 : 1;
    first_draw = argc > next ? strtoull(argv[next], NULL, 10) : first_draw;
    draws = argc > next + 1 ? strtoull(argv[next + 1], NULL, 10) : draws;
    make_functions();
    pthread_attr_t attributes;
    pthread_t thread;
    stack = (uint64_t *)mmap(NULL, STACK, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (stack == MAP_FAILED || pthread_attr_init(&attributes) != 0 || pthread_attr_setstack(&attributes, stack, STACK) != 0
        || pthread_create(&thread, &attributes, run, NULL) != 0 || pthread_join(thread, NULL) != 0) {
        perror("thread");
        return 2;
    }
    if (draws >= 60) { /* enough for the deepest calls */
        for (int i = 0; i < FUNCTIONS; ++i) {
            if (!CHECK(accepted_calls[i] > draws / 2)) {
                printf("    %s: %llu of %llu calls were accepted\n", functions[i].name, (unsigned long long)accepted_calls[i],
                       (unsigned long long)draws);
            }
        }
        check_stack();
    }
    return check_report();
}
