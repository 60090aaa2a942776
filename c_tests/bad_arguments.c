/* Every argument of every function that takes a contact, a state or a workspace, with every kind of invalid value: its own status,
   nothing modified, and no floating-point exception. Extreme valid values: finite results. */
#include "bad_calls.h"

/* Invalid finite values and their status; multiples of the slip force for forces. */
static const struct {
    int kind;
    double value;
    int32_t status;
} bad_values[] = {
    { FORCE, 1.001, MSLIP_FORCE_EXCEEDS_SLIP },
    { FORCE, -1.001, MSLIP_FORCE_EXCEEDS_SLIP },
    { FORCE, 1e300, MSLIP_FORCE_EXCEEDS_SLIP },
    { FORCE, -1e300, MSLIP_FORCE_EXCEEDS_SLIP },
    { FORCE_AMPLITUDE, 1.001, MSLIP_FORCE_EXCEEDS_SLIP },
    { FORCE_AMPLITUDE, 1e300, MSLIP_FORCE_EXCEEDS_SLIP },
    { FORCE_AMPLITUDE, -1.0, MSLIP_BAD_FORCE_AMPLITUDE },
    { FORCE_AMPLITUDE, -1e-320, MSLIP_BAD_FORCE_AMPLITUDE },
    { FORCE_AMPLITUDE, -1e300, MSLIP_BAD_FORCE_AMPLITUDE },
    { DISPLACEMENT, 1.0000001e150, MSLIP_BAD_DISPLACEMENT },
    { DISPLACEMENT, -1.0000001e150, MSLIP_BAD_DISPLACEMENT },
    { DISPLACEMENT, DBL_MAX, MSLIP_BAD_DISPLACEMENT },
    { DISPLACEMENT, -DBL_MAX, MSLIP_BAD_DISPLACEMENT },
    { AMPLITUDE, 1.0000001e150, MSLIP_BAD_AMPLITUDE },
    { AMPLITUDE, DBL_MAX, MSLIP_BAD_AMPLITUDE },
    { AMPLITUDE, -1.0, MSLIP_BAD_AMPLITUDE },
    { AMPLITUDE, -5e-324, MSLIP_BAD_AMPLITUDE },
    { AMPLITUDE, -DBL_MAX, MSLIP_BAD_AMPLITUDE },
};

/* Extreme valid values. */
static const struct {
    int kind;
    double value;
} extreme_values[] = {
    { POSITION, 0.0 }, { POSITION, -0.0 }, { POSITION, 5e-324 }, { POSITION, -1e-300 }, { POSITION, 1e300 },
    { POSITION, -DBL_MAX },
    { FORCE, 0.0 }, { FORCE, -0.0 }, { FORCE, 1e-320 }, { FORCE, -1e-300 }, { FORCE, 1.0 }, { FORCE, -1.0 },
    { FORCE_AMPLITUDE, 0.0 }, { FORCE_AMPLITUDE, -0.0 }, { FORCE_AMPLITUDE, 1e-320 }, { FORCE_AMPLITUDE, 1e-300 },
    { FORCE_AMPLITUDE, 1.0 },
    { DISPLACEMENT, 0.0 }, { DISPLACEMENT, -0.0 }, { DISPLACEMENT, 5e-324 }, { DISPLACEMENT, -1e-300 }, { DISPLACEMENT, 1e-150 },
    { DISPLACEMENT, 1.0 }, { DISPLACEMENT, 1e150 }, { DISPLACEMENT, -1e150 },
    { AMPLITUDE, 0.0 }, { AMPLITUDE, -0.0 }, { AMPLITUDE, 5e-324 }, { AMPLITUDE, 1e-300 }, { AMPLITUDE, 1e-150 },
    { AMPLITUDE, 1.0 }, { AMPLITUDE, 1e150 },
};

static double in_units(int kind, double value)
{
    return kind == FORCE || kind == FORCE_AMPLITUDE ? value * contacts()[0].slip_force : value;
}

/* One value of a call: invalid in every way, and extreme. */
static void test_value(const function *f, int kind, double *place, const char *where)
{
    const double good = *place;
    for (int k = 0; k < NON_FINITE; ++k) {
        memcpy(place, &non_finite[k], sizeof *place);
        rejected(f, status_of_non_finite(kind), where);
    }
    for (size_t k = 0; k < sizeof bad_values / sizeof *bad_values; ++k) {
        if (bad_values[k].kind == kind) {
            *place = in_units(kind, bad_values[k].value);
            rejected(f, bad_values[k].status, where);
        }
    }
    for (size_t k = 0; k < sizeof extreme_values / sizeof *extreme_values; ++k) {
        if (extreme_values[k].kind == kind) {
            *place = in_units(kind, extreme_values[k].value);
            accepted(f, where);
        }
    }
    *place = good;
}

static void test_values(const function *f)
{
    if (f->scalar != NONE) {
        test_value(f, f->scalar, &call.scalar, "the scalar");
    }
    for (size_t i = 0; i < f->inputs; ++i) {
        test_value(f, f->kind, &input()[i], "an element of the array");
    }
    /* The whole array at once. */
    for (size_t k = 0; f->inputs > 0 && k < sizeof extreme_values / sizeof *extreme_values; ++k) {
        if (extreme_values[k].kind == f->kind) {
            for (size_t i = 0; i < f->inputs; ++i) {
                input()[i] = in_units(f->kind, extreme_values[k].value);
            }
            accepted(f, "all elements of the array");
        }
    }
    set_up(f);
}

/* The address half an item further. */
static void *misaligned(const void *pointer, size_t item)
{
    return (char *)(size_t)pointer + item / 2;
}

/* Each pointer in turn is misaligned. */
static void test_alignment(const function *f)
{
    call.contacts = misaligned(call.contacts, sizeof(double));
    rejected(f, MSLIP_BAD_ALIGNMENT, "contact is misaligned");
    set_up(f);
    if (f->takes & IS_BATCH) {
        call.index = misaligned(call.index, sizeof(int32_t));
        rejected(f, MSLIP_BAD_ALIGNMENT, "index is misaligned");
        set_up(f);
        call.active = misaligned(call.active, sizeof(int32_t));
        rejected(f, MSLIP_BAD_ALIGNMENT, "active is misaligned");
        set_up(f);
    }
    if (f->inputs > 0) {
        call.input = misaligned(call.input, sizeof(double));
        rejected(f, MSLIP_BAD_ALIGNMENT, "the array is misaligned");
        set_up(f);
    }
    if (f->takes & TAKES_STATE) {
        call.state0 = misaligned(call.state0, sizeof(double));
        rejected(f, MSLIP_BAD_ALIGNMENT, "state is misaligned");
        set_up(f);
    }
    if (call.state1 != NULL) {
        call.state1 = misaligned(call.state1, sizeof(double));
        rejected(f, MSLIP_BAD_ALIGNMENT, "the new state is misaligned");
        set_up(f);
    }
    if (f->takes & TAKES_WORKSPACE) {
        call.workspace = misaligned(call.workspace, sizeof(double));
        rejected(f, MSLIP_BAD_ALIGNMENT, "workspace is misaligned");
        set_up(f);
    }
    for (size_t i = 0; i < sizeof call.out / sizeof *call.out; ++i) {
        if (call.out[i] != NULL) {
            call.out[i] = misaligned(call.out[i], sizeof(double));
            rejected(f, MSLIP_BAD_ALIGNMENT, "an output is misaligned");
            set_up(f);
        }
    }
}

static void test_pointers(const function *f)
{
    call.contacts = NULL;
    rejected(f, MSLIP_NULL_POINTER, "contact is NULL");
    set_up(f);
    if (f->inputs > 0) {
        call.input = NULL;
        rejected(f, MSLIP_NULL_POINTER, "the array is NULL");
        set_up(f);
    }
    if (f->takes & TAKES_STATE) {
        call.state0 = NULL;
        rejected(f, MSLIP_NULL_POINTER, "state is NULL");
        set_up(f);
    }
    if (f->takes & TAKES_WORKSPACE) {
        call.workspace = NULL;
        rejected(f, MSLIP_NULL_POINTER, "workspace is NULL");
        set_up(f);
    }
    test_alignment(f);
    /* Without outputs a call only checks its inputs. */
    call.state1 = NULL;
    memset(call.out, 0, sizeof call.out);
    remember_regions();
    CHECK(f->call() == MSLIP_OK && raised() == 0 && nothing_changed_but_scratch(f));
    set_up(f);
}

/* More items than memory can hold, and none. */
static void test_counts(const function *f)
{
    static const size_t too_many[] = { SIZE_MAX, SIZE_MAX / 2 + 1, SIZE_MAX / 8, SIZE_MAX / 16 + 1 };
    for (size_t i = 0; (f->takes & TAKES_COUNT) && i < sizeof too_many / sizeof *too_many; ++i) {
        call.n = too_many[i];
        rejected(f, MSLIP_BAD_ARRAY_SIZE, "n");
        memset(call.out, 0, sizeof call.out);
        rejected(f, MSLIP_BAD_ARRAY_SIZE, "n, without outputs");
        set_up(f);
        if (f->takes & IS_BATCH) {
            call.n_contacts = too_many[i];
            rejected(f, MSLIP_BAD_ARRAY_SIZE, "n_contacts");
            set_up(f);
        }
    }
    for (size_t i = 0; (f->takes & TAKES_STATE) && i < sizeof too_many / sizeof *too_many; ++i) {
        call.state_length = too_many[i];
        rejected(f, MSLIP_BAD_ARRAY_SIZE, "state_length");
        set_up(f);
    }
    if ((f->takes & TAKES_COUNT) && !(f->takes & IS_SLIDERS)) {
        call.n = call.n_contacts = 0;
        call.input = NULL;
        call.index = call.active = NULL;
        if (f->takes & IS_BATCH) {
            call.contacts = NULL;
            call.state0 = NULL;
        }
        call.state1 = NULL;
        remember_regions();
        CHECK(f->call() == MSLIP_OK && raised() == 0 && nothing_changed());
        set_up(f);
    }
}

static void test_sliders(void)
{
    static const size_t bad[] = { 0, 65537, 1000000, SIZE_MAX / 16 };
    const function *f = find("mslip_iwan_equivalent", 0);
    set_up(f);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        call.n = bad[i];
        rejected(f, MSLIP_BAD_COUNT, "n");
    }
}

/* Uninitialised states, and rejected updates in place. */
static void test_states(const function *f)
{
    const size_t bytes = (f->takes & IS_BATCH ? ITEMS : 1) * STATE * sizeof(double);
    for (int fill = 0; fill < 256; fill += 51) {
        memset(states0(), fill, bytes);
        rejected(f, MSLIP_BAD_STATE, "an uninitialised state");
    }
    set_up(f);
    for (int in_place = 0; f->state1 > 0 && in_place < 2; ++in_place) {
        double *value = f->inputs > 0 ? &input()[f->inputs - 1] : &call.scalar;
        call.state1 = in_place ? states0() : NULL;
        for (int k = 0; k < NON_FINITE; ++k) {
            memcpy(value, &non_finite[k], sizeof *value);
            rejected(f, MSLIP_BAD_DISPLACEMENT, in_place ? "in place" : "without a new state");
        }
        set_up(f);
    }
}

/* Uninitialised workspaces. */
static void test_workspaces(const function *f)
{
    for (int fill = 0; fill < 256; fill += 51) {
        memset(call.workspace, fill, workspace_lengths[f->rule] * sizeof(double));
        rejected(f, MSLIP_BAD_WORKSPACE, "an uninitialised workspace");
    }
    set_up(f);
}

/* Uninitialised contacts. */
static void test_contacts(const function *f)
{
    const size_t bytes = (f->takes & IS_BATCH ? ITEMS : 1) * sizeof(mslip_contact);
    for (int fill = 0; fill < 256; fill += 51) {
        memset(contacts(), fill, bytes);
        rejected(f, MSLIP_BAD_CONTACT, "an uninitialised contact");
    }
    set_up(f);
}

/* State lengths below the minimum, below what the reversals need, and between two capacities. */
static void test_state_lengths(const function *f)
{
    const size_t least = mslip_state_length(0), used = mslip_state_length(HELD);
    for (size_t length = 0; length < least; ++length) {
        call.state_length = length;
        rejected(f, MSLIP_STATE_TOO_SHORT, "state_length");
    }
    set_up(f);
    if (f->takes & IS_BATCH) {
        return; /* the length of one is that of all */
    }
    for (size_t length = least; length < used; ++length) {
        call.state_length = length;
        rejected(f, MSLIP_BAD_STATE, "state_length is less than the reversals need");
    }
    /* Doubles beyond the last whole reversal are unused, and copied. */
    call.state_length = STATE - 1;
    remember_regions();
    CHECK(f->call() == MSLIP_OK && raised() == 0 && region_is_unchanged(state0_region));
    if (f->state1 > 0) {
        CHECK(same_bits(&call.state1[STATE - 3], &states0()[STATE - 3], 2));
        CHECK(same_bits(&call.state1[STATE - 1], (double *)(state1_region->before + state1_region->bytes) - 1, 1));
    }
    set_up(f);
}

static void test_state_init(void)
{
    const function *f = find("mslip_masing_update", 0);
    const size_t least = mslip_state_length(0);
    set_up(f);
    remember_regions();
    for (size_t length = 0; length < least; ++length) {
        check_rejected(mslip_state_init(length, call.state1), MSLIP_STATE_TOO_SHORT, "mslip_state_init", "state_length");
        check_rejected(mslip_state_init(length, NULL), MSLIP_NULL_POINTER, "mslip_state_init", "state");
    }
    check_rejected(mslip_state_init(SIZE_MAX, call.state1), MSLIP_BAD_ARRAY_SIZE, "mslip_state_init", "state_length");
    check_rejected(mslip_state_init(SIZE_MAX / 8, call.state1), MSLIP_BAD_ARRAY_SIZE, "mslip_state_init", "state_length");
    check_rejected(mslip_state_init(STATE, NULL), MSLIP_NULL_POINTER, "mslip_state_init", "state");
    CHECK(mslip_state_length(SIZE_MAX) == SIZE_MAX && mslip_state_length(SIZE_MAX / 2) == SIZE_MAX);
}

/* mslip_state_check and mslip_state_error. */
static void test_state_queries(void)
{
    const double unset = 77.0;
    double *state, *error;
    set_up(find("mslip_masing_update", 0));
    state = states0();
    error = call.out[0];
    *error = unset;
    remember_regions();
    for (int i = 0; i < 2; ++i) {
        const char *name = i == 0 ? "mslip_state_check" : "mslip_state_error";
#define QUERY(length, state) (i == 0 ? mslip_state_check(length, state) : mslip_state_error(length, state, error))
        check_rejected(QUERY(STATE, NULL), MSLIP_NULL_POINTER, name, "state");
        check_rejected(QUERY(0, NULL), MSLIP_NULL_POINTER, name, "state");
        check_rejected(QUERY(STATE, misaligned(state, sizeof *state)), MSLIP_BAD_ALIGNMENT, name, "state");
        check_rejected(QUERY(SIZE_MAX / 8, state), MSLIP_BAD_ARRAY_SIZE, name, "state_length");
        for (size_t length = 0; length < mslip_state_length(HELD); ++length) {
            check_rejected(QUERY(length, state), length < mslip_state_length(0) ? MSLIP_STATE_TOO_SHORT : MSLIP_BAD_STATE, name,
                           "state_length");
        }
        check_rejected(QUERY(STATE, (double *)(void *)out_regions[3]->start), MSLIP_BAD_STATE,
                       name, "an uninitialised state");
        CHECK(QUERY(STATE, state) == MSLIP_OK);
#undef QUERY
    }
    CHECK(*error == 0.0);
    CHECK(mslip_state_error(STATE, state, NULL) == MSLIP_OK && raised() == 0);
    *error = unset;
    remember_regions();
    check_rejected(mslip_state_error(STATE, state, misaligned(error, sizeof *error)), MSLIP_BAD_ALIGNMENT, "mslip_state_error",
                   "force_error");
}

static void test_contact_check(void)
{
    set_up(&functions[0]);
    CHECK(mslip_contact_check(contacts()) == MSLIP_OK);
    remember_regions();
    check_rejected(mslip_contact_check(NULL), MSLIP_NULL_POINTER, "mslip_contact_check", "contact");
    check_rejected(mslip_contact_check(misaligned(contacts(), 8)), MSLIP_BAD_ALIGNMENT, "mslip_contact_check", "contact");
    for (int i = 0; i < UNINITIALISED; ++i) {
        contacts()[0] = uninitialised_contact(i);
        remember_regions();
        check_rejected(mslip_contact_check(contacts()), MSLIP_BAD_CONTACT, "mslip_contact_check", "uninitialised");
    }
}

static void test_workspace_size(void)
{
    for (int32_t rule = 0; rule < 2; ++rule) {
        const function *f = find("mslip_harmonic_force", rule);
        size_t harmonics = 0, samples = 0;
        int32_t found = -1;
        set_up(f);
        remember_regions();
        CHECK(mslip_harmonic_workspace_size(call.workspace, &harmonics, NULL, NULL) == MSLIP_OK && harmonics == HARMONICS);
        CHECK(mslip_harmonic_workspace_size(call.workspace, NULL, &samples, NULL) == MSLIP_OK && samples == SAMPLES);
        CHECK(mslip_harmonic_workspace_size(call.workspace, NULL, NULL, &found) == MSLIP_OK && found == rule);
        CHECK(mslip_harmonic_workspace_size(call.workspace, NULL, NULL, NULL) == MSLIP_OK && nothing_changed());
        harmonics = samples = 7;
        found = 7;
        for (int i = 0; i < 6; ++i) {
            static const int32_t expected[] = { MSLIP_NULL_POINTER,  MSLIP_BAD_ALIGNMENT, MSLIP_BAD_ALIGNMENT,
                                                MSLIP_BAD_ALIGNMENT, MSLIP_BAD_ALIGNMENT, MSLIP_BAD_WORKSPACE };
            const double *workspace = i == 0 ? NULL : i == 1 ? misaligned(call.workspace, 8) : call.workspace;
            size_t *h = i == 2 ? misaligned(&harmonics, sizeof harmonics) : &harmonics;
            size_t *s = i == 3 ? misaligned(&samples, sizeof samples) : &samples;
            int32_t *r = i == 4 ? misaligned(&found, sizeof found) : &found;
            if (i == 5) {
                memset(call.workspace, 0x5a, workspace_lengths[rule] * sizeof(double));
                remember_regions();
            }
            check_rejected(mslip_harmonic_workspace_size(workspace, h, s, r), expected[i], "mslip_harmonic_workspace_size", "any");
            CHECK(harmonics == 7 && samples == 7 && found == 7);
        }
    }
}

/* Workspaces of invalid size, rule or length. */
static void test_workspace_init(void)
{
    enum { BIG = 1 << 24 };
    static const struct {
        size_t harmonics, samples;
        int32_t status;
    } rows[] = {
        { 0, 16, MSLIP_BAD_HARMONICS },
        { 0, 0, MSLIP_BAD_HARMONICS },
        { BIG + 1, SIZE_MAX, MSLIP_BAD_HARMONICS },
        { SIZE_MAX, SIZE_MAX, MSLIP_BAD_HARMONICS },
        { SIZE_MAX / 2 + 1, 1, MSLIP_BAD_HARMONICS }, /* twice this is 0 */
        { 2, 0, MSLIP_BAD_SAMPLES },
        { 2, 4, MSLIP_BAD_SAMPLES },
        { BIG, BIG, MSLIP_BAD_SAMPLES },
        { 2, BIG + 1, MSLIP_BAD_SAMPLES },
        { 2, SIZE_MAX, MSLIP_BAD_SAMPLES },
        { 2, SIZE_MAX / 2 + 1, MSLIP_BAD_SAMPLES },
        { BIG / 2 - 1, BIG, MSLIP_WORKSPACE_TOO_SHORT }, /* the largest allowed */
        { 2, 16, MSLIP_WORKSPACE_TOO_SHORT },
    };
    static const int32_t rules[] = { MSLIP_UNIFORM_SAMPLING, MSLIP_EVENT_DRIVEN };
    static const int32_t invalid_rules[] = { -1, 2, INT32_MAX, INT32_MIN };
    double *memory;

    set_up(find("mslip_harmonic_force", MSLIP_UNIFORM_SAMPLING));
    memory = call.workspace;
    remember_regions();
    for (int r = 0; r < 2; ++r) {
        for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
            const size_t h = rows[i].harmonics, s = rows[i].samples, length = mslip_harmonic_workspace_length(h, s, rules[r]);
            const int32_t status = rows[i].status;
            CHECK((length == 0) == (status != MSLIP_WORKSPACE_TOO_SHORT));
            const size_t lengths[] = { 0, 1, 4, length > 0 ? length - 1 : 100 };
            for (int k = 0; k < 4; ++k) {
                check_rejected(mslip_harmonic_workspace_init(h, s, rules[r], lengths[k], memory), status,
                               "mslip_harmonic_workspace_init", "harmonics, samples, workspace_length");
            }
        }
        check_rejected(mslip_harmonic_workspace_init(2, 16, rules[r], SIZE_MAX, memory), MSLIP_BAD_ARRAY_SIZE,
                      "mslip_harmonic_workspace_init", "workspace_length");
        check_rejected(mslip_harmonic_workspace_init(2, 16, rules[r], 1000, NULL), MSLIP_NULL_POINTER,
                      "mslip_harmonic_workspace_init", "workspace");
    }
    for (int i = 0; i < 4; ++i) {
        CHECK(mslip_harmonic_workspace_length(2, 16, invalid_rules[i]) == 0);
        check_rejected(mslip_harmonic_workspace_init(2, 16, invalid_rules[i], 1000, memory), MSLIP_BAD_RULE,
                      "mslip_harmonic_workspace_init", "rule");
    }
}

/* Slip is not available for elliptical contacts. */
static void test_elliptic_slip(void)
{
    const function *f = find("mslip_slip", 0);
    set_up(f);
    contacts()[0] = elliptic_contact();
    rejected(f, MSLIP_NOT_AVAILABLE, "an elliptical contact");
    memset(call.out, 0, sizeof call.out);
    rejected(f, MSLIP_NOT_AVAILABLE, "an elliptical contact, without outputs");
}

/* The state of another contact: tractions of forces beyond mu N are rejected, and a step has a possible result. */
static void test_state_of_another_contact(void)
{
    const function *tractions = find("mslip_masing_tractions", 0), *update = find("mslip_masing_update", 0);
    mslip_parameters p = flat_parameters();
    static const double friction[] = { 1e-6, 0.01, 0.2, 0.41, 10.0, 0.0 };
    for (size_t i = 0; i < sizeof friction / sizeof *friction; ++i) {
        set_up(tractions);
        p.friction_coefficient = friction[i];
        CHECK(mslip_contact_init(&p, &contacts()[0]) == MSLIP_OK);
        if (friction[i] < 0.05) {
            rejected(tractions, MSLIP_FORCE_EXCEEDS_SLIP, "the state of a stronger contact");
        } else if (friction[i] > 1.0) {
            accepted(tractions, "the state of a weaker contact");
        }
        set_up(update);
        CHECK(mslip_contact_init(&p, &contacts()[0]) == MSLIP_OK);
        for (int k = -20; k <= 20; ++k) {
            call.scalar = 1e-8 * k;
            accepted(update, "the state of another contact");
            CHECK(fabs(*call.out[0]) <= contacts()[0].slip_force && *call.out[1] >= 0.0 && *call.out[2] >= 0.0);
        }
    }
}

/* One invalid item at any place: no item is modified. A skipped item is neither checked nor modified. */
static void test_batches(const function *f)
{
    const int32_t bad_index[] = { -1, ITEMS, INT32_MAX, INT32_MIN };
    for (size_t bad = 0; bad < ITEMS; ++bad) {
        for (int skipped = 0; skipped < 2; ++skipped) {
            set_up(f);
            active()[bad] = !skipped;
            const mslip_contact good = contacts()[bad];
            for (int i = 0; i < UNINITIALISED; ++i) {
                contacts()[bad] = uninitialised_contact(i);
                if (skipped) {
                    accepted_but(f, bad, "an invalid contact is skipped");
                } else {
                    rejected(f, MSLIP_BAD_CONTACT, "one contact is invalid");
                }
            }
            contacts()[bad] = good;
            for (size_t i = 0; i < sizeof bad_index / sizeof *bad_index; ++i) {
                indices()[bad] = bad_index[i];
                if (skipped) {
                    accepted_but(f, bad, "an invalid index is skipped");
                } else {
                    rejected(f, MSLIP_BAD_INDEX, "one index is invalid");
                }
            }
            indices()[bad] = (int32_t)bad;
            for (size_t k = 0; k < f->inputs / ITEMS; ++k) {
                double *place = &input()[bad * (f->inputs / ITEMS) + k];
                const double before = *place;
                for (int i = 0; i < NON_FINITE; ++i) {
                    memcpy(place, &non_finite[i], sizeof *place);
                    if (skipped) {
                        accepted_but(f, bad, "a non-finite value is skipped");
                    } else {
                        rejected(f, status_of_non_finite(f->kind), "one value is not finite");
                    }
                }
                *place = before;
            }
            if (f->takes & TAKES_STATE) {
                states0()[bad * STATE] = 0.0;
                if (skipped) {
                    accepted_but(f, bad, "an invalid state is skipped");
                } else {
                    rejected(f, MSLIP_BAD_STATE, "one state is invalid");
                }
            }
        }
    }
    /* No item is active: no contact is checked. */
    set_up(f);
    memset(contacts(), 0xff, ITEMS * sizeof(mslip_contact));
    memset(active(), 0, ITEMS * sizeof(int32_t));
    remember_regions();
    CHECK(f->call() == MSLIP_OK && raised() == 0 && nothing_changed_but_scratch(f));
    /* Fewer contacts than items. */
    for (int indexed = 0; indexed < 2; ++indexed) {
        for (size_t n_contacts = 0; n_contacts < ITEMS; ++n_contacts) {
            set_up(f);
            call.index = indexed ? call.index : NULL;
            call.n_contacts = n_contacts;
            rejected(f, MSLIP_BAD_INDEX, "fewer contacts than items");
        }
    }
    /* Any flag but 0 is active. */
    set_up(f);
    static const int32_t nonzero[ITEMS] = { 1, -1, INT32_MAX, INT32_MIN, 2 };
    memcpy(active(), nonzero, sizeof nonzero);
    accepted(f, "flags");
    memset(&contacts()[3], 0, sizeof(mslip_contact));
    rejected(f, MSLIP_BAD_CONTACT, "an item with any flag but 0");
}

/* Every status has its message, and no other number has one. */
static void test_messages(void)
{
    const char *unknown = mslip_status_text(-1);
    int known = 0;
    for (int i = 0; i < REJECTIONS; ++i) {
        CHECK(strstr(mslip_status_text(rejections[i].code), rejections[i].excerpt) != NULL);
    }
    for (int32_t code = 1; code < 1000; ++code) {
        known += strcmp(mslip_status_text(code), unknown) != 0;
    }
    CHECK(known == REJECTIONS);
    CHECK(strcmp(mslip_status_text(MSLIP_OK), unknown) != 0);
    CHECK(strcmp(mslip_status_text(INT32_MIN), unknown) == 0 && strcmp(mslip_status_text(INT32_MAX), unknown) == 0);
}

int main(int argc, char **argv)
{
    check_arguments(argc, argv);
    make_regions();
    for (int i = 0; i < FUNCTIONS; ++i) {
        const function *f = &functions[i];
        set_up(f);
        accepted(f, "valid arguments");
        test_values(f);
        test_pointers(f);
        test_counts(f);
        test_contacts(f);
        if (f->takes & TAKES_STATE) {
            test_states(f);
            test_state_lengths(f);
        }
        if (f->takes & TAKES_WORKSPACE) {
            test_workspaces(f);
        }
        if (f->takes & IS_BATCH) {
            test_batches(f);
        }
    }
    test_sliders();
    test_state_init();
    test_state_queries();
    test_contact_check();
    test_workspace_init();
    test_workspace_size();
    test_elliptic_slip();
    test_state_of_another_contact();
    test_messages();
    check_every_code_was_seen(ARGUMENTS);
    return check_report();
}
