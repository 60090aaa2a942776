/* bad_calls.h: a table of every function that takes a contact, and a valid call of each, of which tests invalidate one argument at
   a time. */
#ifndef BAD_CALLS_H
#define BAD_CALLS_H

#include "rejection.h"

enum { ITEMS = 5, HARMONICS = 2, SAMPLES = 16, COEFFICIENTS = 2 * HARMONICS + 1, SQUARE = COEFFICIENTS * COEFFICIENTS };
enum { REVERSALS = 12, STATE = 5 + 3 * REVERSALS, HELD = 3 };

/* Quantities. */
enum { NONE, POSITION, FORCE, FORCE_AMPLITUDE, DISPLACEMENT, AMPLITUDE };

/* Status of a quantity that is not finite. */
static inline int32_t status_of_non_finite(int kind)
{
    static const int32_t status[] = { MSLIP_OK, MSLIP_BAD_POSITION, MSLIP_BAD_FORCE, MSLIP_BAD_FORCE_AMPLITUDE,
                                      MSLIP_BAD_DISPLACEMENT, MSLIP_BAD_AMPLITUDE };
    return status[kind];
}

/* What a function takes beside a contact. The n of sliders is not the length of an input. */
enum { TAKES_COUNT = 1, TAKES_STATE = 2, TAKES_WORKSPACE = 4, IS_BATCH = 8, IS_SLIDERS = 16 };

static struct {
    const mslip_contact *contacts;
    const int32_t *index, *active;
    size_t n, n_contacts, state_length;
    double scalar;
    const double *input, *state0;
    double *state1, *workspace, *out[4];
} call;

#define CALL(name, ...) static int32_t call_##name(void) { return mslip_##name(__VA_ARGS__); }
CALL(tractions, call.contacts, call.scalar, call.n, call.input, call.out[0], call.out[1])
CALL(slip, call.contacts, call.scalar, call.n, call.input, call.out[0], call.out[1])
CALL(monotonic_displacement, call.contacts, call.n, call.input, call.out[0], call.out[1], call.out[2])
CALL(monotonic_force, call.contacts, call.n, call.input, call.out[0], call.out[1], call.out[2])
CALL(masing_update, call.contacts, call.state_length, call.state0, call.scalar, call.state1, call.out[0], call.out[1], call.out[2])
CALL(masing_path, call.contacts, call.state_length, call.state0, call.n, call.input, call.state1, call.out[0], call.out[1],
     call.out[2])
CALL(masing_tractions, call.contacts, call.state_length, call.state0, call.n, call.input, call.out[0], call.out[1])
CALL(hysteresis_loop, call.contacts, call.scalar, call.n, call.out[0], call.out[1])
CALL(dissipated_energy, call.contacts, call.n, call.input, call.out[0])
CALL(complex_stiffness, call.contacts, call.n, call.input, call.out[0], call.out[1], call.out[2], call.out[3])
CALL(harmonic_force, call.contacts, call.workspace, call.input, call.out[0], call.out[1], call.out[2])
CALL(jenkins_equivalent, call.contacts, call.scalar, call.out[0], call.out[1])
CALL(iwan_equivalent, call.contacts, call.n, call.out[0], call.out[1], call.out[2])
CALL(batch_complex_stiffness, call.n, call.n_contacts, call.contacts, call.index, call.active, call.input, call.out[0],
     call.out[1], call.out[2], call.out[3])
CALL(batch_masing_update, call.n, call.n_contacts, call.contacts, call.index, call.active, call.state_length, call.state0,
     call.input, call.state1, call.out[0], call.out[1], call.out[2])
CALL(batch_harmonic_force, call.n, call.n_contacts, call.contacts, call.index, call.active, call.workspace, call.input,
     call.out[0], call.out[1], call.out[2])

typedef struct {
    const char *name;
    int32_t (*call)(void);
    int takes, rule;
    int scalar;    /* quantity passed by value */
    int kind;      /* quantity of the input array */
    size_t inputs; /* its length */
    size_t state1; /* lengths of the outputs */
    size_t out[4];
} function;

#define FUNCTION(name) "mslip_" #name, call_##name
static const function functions[] = {
    { FUNCTION(tractions), TAKES_COUNT, 0, FORCE, POSITION, ITEMS, 0, { ITEMS, ITEMS } },
    { FUNCTION(slip), TAKES_COUNT, 0, FORCE, POSITION, ITEMS, 0, { ITEMS, ITEMS } },
    { FUNCTION(monotonic_displacement), TAKES_COUNT, 0, NONE, FORCE, ITEMS, 0, { ITEMS, ITEMS, ITEMS } },
    { FUNCTION(monotonic_force), TAKES_COUNT, 0, NONE, DISPLACEMENT, ITEMS, 0, { ITEMS, ITEMS, ITEMS } },
    { FUNCTION(masing_update), TAKES_STATE, 0, DISPLACEMENT, NONE, 0, STATE, { 1, 1, 1 } },
    { FUNCTION(masing_path), TAKES_STATE | TAKES_COUNT, 0, NONE, DISPLACEMENT, ITEMS, STATE,
      { ITEMS, ITEMS, ITEMS } },
    { FUNCTION(masing_tractions), TAKES_STATE | TAKES_COUNT, 0, NONE, POSITION, ITEMS, 0, { ITEMS, ITEMS } },
    { FUNCTION(hysteresis_loop), TAKES_COUNT, 0, AMPLITUDE, NONE, 0, 0, { ITEMS, ITEMS } },
    { FUNCTION(dissipated_energy), TAKES_COUNT, 0, NONE, FORCE_AMPLITUDE, ITEMS, 0, { ITEMS } },
    { FUNCTION(complex_stiffness), TAKES_COUNT, 0, NONE, AMPLITUDE, ITEMS, 0, { ITEMS, ITEMS, ITEMS, ITEMS } },
    { FUNCTION(harmonic_force), TAKES_WORKSPACE, MSLIP_UNIFORM_SAMPLING, NONE, DISPLACEMENT, COEFFICIENTS, 0,
      { COEFFICIENTS, SQUARE, 1 } },
    { FUNCTION(harmonic_force), TAKES_WORKSPACE, MSLIP_EVENT_DRIVEN, NONE, DISPLACEMENT, COEFFICIENTS, 0,
      { COEFFICIENTS, SQUARE, 1 } },
    { FUNCTION(jenkins_equivalent), 0, 0, AMPLITUDE, NONE, 0, 0, { 1, 1 } },
    { FUNCTION(iwan_equivalent), TAKES_COUNT | IS_SLIDERS, 0, NONE, NONE, 0, 0, { ITEMS, ITEMS, 1 } },
    { FUNCTION(batch_complex_stiffness), TAKES_COUNT | IS_BATCH, 0, NONE, AMPLITUDE, ITEMS, 0,
      { ITEMS, ITEMS, ITEMS, ITEMS } },
    { FUNCTION(batch_masing_update), TAKES_COUNT | TAKES_STATE | IS_BATCH, 0, NONE, DISPLACEMENT, ITEMS,
      ITEMS * STATE, { ITEMS, ITEMS, ITEMS } },
    { FUNCTION(batch_harmonic_force), TAKES_COUNT | TAKES_WORKSPACE | IS_BATCH, MSLIP_UNIFORM_SAMPLING, NONE,
      DISPLACEMENT, ITEMS * COEFFICIENTS, 0, { ITEMS * COEFFICIENTS, ITEMS * SQUARE, ITEMS } },
    { FUNCTION(batch_harmonic_force), TAKES_COUNT | TAKES_WORKSPACE | IS_BATCH, MSLIP_EVENT_DRIVEN, NONE,
      DISPLACEMENT, ITEMS * COEFFICIENTS, 0, { ITEMS * COEFFICIENTS, ITEMS * SQUARE, ITEMS } },
};
enum { FUNCTIONS = sizeof functions / sizeof *functions };

static inline const function *find(const char *name, int rule)
{
    for (int i = 0; i < FUNCTIONS; ++i) {
        if (strcmp(functions[i].name, name) == 0 && functions[i].rule == rule) {
            return &functions[i];
        }
    }
    fprintf(stderr, "no function %s\n", name);
    exit(2);
}

static region *contact_region, *index_region, *active_region, *input_region, *state0_region, *state1_region, *workspace_region;
static region *out_regions[4];
static size_t workspace_lengths[2];

static inline void make_regions(void)
{
    size_t largest;
    for (int rule = 0; rule < 2; ++rule) {
        workspace_lengths[rule] = mslip_harmonic_workspace_length(HARMONICS, SAMPLES, rule);
    }
    largest = workspace_lengths[workspace_lengths[1] > workspace_lengths[0]];
    contact_region = make_region(ITEMS * sizeof(mslip_contact));
    index_region = make_region(ITEMS * sizeof(int32_t));
    active_region = make_region(ITEMS * sizeof(int32_t));
    input_region = make_region(ITEMS * COEFFICIENTS * sizeof(double));
    state0_region = make_region(ITEMS * STATE * sizeof(double));
    state1_region = make_region(ITEMS * STATE * sizeof(double));
    workspace_region = make_region(largest * sizeof(double));
    for (int i = 0; i < 4; ++i) {
        out_regions[i] = make_region(ITEMS * SQUARE * sizeof(double));
    }
}

/* The inputs, to be modified by tests. */
static inline mslip_contact *contacts(void)
{
    return (mslip_contact *)(size_t)call.contacts;
}

static inline int32_t *indices(void)
{
    return (int32_t *)(size_t)call.index;
}

static inline int32_t *active(void)
{
    return (int32_t *)(size_t)call.active;
}

static inline double *input(void)
{
    return (double *)(size_t)call.input;
}

static inline double *states0(void)
{
    return (double *)(size_t)call.state0;
}

/* A decaying vibration: each displacement adds a reversal. */
static inline double decaying(int reversals)
{
    return (reversals % 2 == 0 ? 1e-8 : -1e-8) * (1.0 - 0.05 * reversals);
}

/* Initialises the states and advances each to the given number of nested reversals. */
static inline void fill_states(const function *f, int reversals)
{
    const size_t items = f->takes & IS_BATCH ? ITEMS : 1;
    for (size_t i = 0; (f->takes & TAKES_STATE) && i < items; ++i) {
        double *state = states0() + i * STATE;
        CHECK(mslip_state_init(STATE, state) == MSLIP_OK);
        for (int k = 0; k <= reversals; ++k) {
            CHECK(mslip_masing_update(&call.contacts[i], STATE, state, decaying(k), state, NULL, NULL, NULL) == MSLIP_OK);
        }
    }
}

static inline double valid_value(int kind, size_t i, double slip_force)
{
    switch (kind) {
        case POSITION: return 1e-4 * ((double)i - 2.0);
        case FORCE: return slip_force * (0.2 * (double)i - 0.35);
        case FORCE_AMPLITUDE: return 0.2 * slip_force * (double)i;
        case DISPLACEMENT: return 1e-8 * (1.3 * (double)(i % 4) - 2.0);
        case AMPLITUDE: return 4e-8 * (double)(i + 1);
        default: return 0.0;
    }
}

/* Valid arguments, each just before its protected page. Item i of a batch has contact i. */
static inline void set_up(const function *f)
{
    const size_t items = f->takes & IS_BATCH ? ITEMS : 1;
    mslip_contact *c = last(contact_region, items * sizeof *c);
    int32_t *index = last(index_region, ITEMS * sizeof *index), *flags = last(active_region, ITEMS * sizeof *flags);
    double *values = last(input_region, f->inputs * sizeof *values);

    memset(&call, 0, sizeof call);
    call.n = call.n_contacts = ITEMS;
    call.state_length = STATE;
    call.contacts = c;
    for (size_t i = 0; i < items; ++i) {
        c[i] = i % 3 == 0 ? flat_contact() : i % 3 == 1 ? cylinder_contact() : elliptic_contact();
    }
    for (size_t i = 0; i < ITEMS; ++i) {
        index[i] = (int32_t)i;
        flags[i] = 1;
    }
    call.index = f->takes & IS_BATCH ? index : NULL;
    call.active = f->takes & IS_BATCH ? flags : NULL;
    for (size_t i = 0; i < f->inputs; ++i) {
        values[i] = valid_value(f->kind, i, c->slip_force);
    }
    call.input = f->inputs > 0 ? values : NULL;
    call.scalar = valid_value(f->scalar, 3, c->slip_force);
    if (f->takes & TAKES_STATE) {
        call.state0 = last(state0_region, items * STATE * sizeof(double));
        fill_states(f, HELD);
    }
    if (f->takes & TAKES_WORKSPACE) {
        const size_t length = workspace_lengths[f->rule];
        call.workspace = last(workspace_region, length * sizeof(double));
        CHECK(mslip_harmonic_workspace_init(HARMONICS, SAMPLES, f->rule, length, call.workspace) == MSLIP_OK);
    }
    if (f->state1 > 0) {
        call.state1 = last(state1_region, f->state1 * sizeof(double));
    }
    for (int i = 0; i < 4; ++i) {
        call.out[i] = f->out[i] > 0 ? last(out_regions[i], f->out[i] * sizeof(double)) : NULL;
    }
}

/* The call is rejected with this status and modifies nothing. */
static inline void rejected(const function *f, int32_t status, const char *what)
{
    int32_t got;
    remember_regions();
    feclearexcept(FE_ALL_EXCEPT);
    got = f->call();
    check_rejected(got, status, f->name, what);
}

/* No bit changed, except in the scratch memory of a workspace. */
static inline int nothing_changed_but_scratch(const function *f)
{
    for (int i = 0; i < regions_made; ++i) {
        if (!region_is_unchanged(&regions[i]) && !((f->takes & TAKES_WORKSPACE) && &regions[i] == workspace_region)) {
            return 0;
        }
    }
    return 1;
}

/* An output is finite for all items but one, which is unchanged, and so is the memory before the output. */
static inline int is_written(const region *r, size_t length, size_t skipped)
{
    const size_t bytes = length * sizeof(double), share = length / ITEMS;
    const double *values = last(r, bytes), *before = (const double *)(r->before + r->bytes - bytes);
    if (memcmp(r->start, r->before, r->bytes - bytes) != 0) {
        return 0;
    }
    for (size_t i = 0; i < length; ++i) {
        if (skipped < ITEMS && i / share == skipped ? !same_bits(&values[i], &before[i], 1) : !isfinite(values[i])) {
            return 0;
        }
    }
    return 1;
}

/* The call succeeds and writes its outputs only, for all items but that one. */
static inline void accepted_but(const function *f, size_t skipped, const char *what)
{
    int32_t status;
    int flags, holds;
    /* NaN. */
    memset(state1_region->start, 0xff, state1_region->bytes);
    for (int i = 0; i < 4; ++i) {
        memset(out_regions[i]->start, 0xff, out_regions[i]->bytes);
    }
    remember_regions();
    feclearexcept(FE_ALL_EXCEPT);
    status = f->call();
    flags = raised();
    holds = status == MSLIP_OK && flags == 0 && region_is_unchanged(contact_region) && region_is_unchanged(index_region) &&
            region_is_unchanged(active_region) && region_is_unchanged(input_region) && region_is_unchanged(state0_region);
    for (int i = 0; i < 4; ++i) {
        holds &= is_written(out_regions[i], f->out[i], skipped);
    }
    holds &= f->state1 == 0 || is_written(state1_region, f->state1, skipped);
    if (!check_that(holds, __FILE__, __LINE__, "accepted, and finite")) {
        printf("    %s, %s: status %d, flags %x\n", f->name, what, (int)status, flags);
    }
}

static inline void accepted(const function *f, const char *what)
{
    accepted_but(f, ITEMS, what);
}

#endif
