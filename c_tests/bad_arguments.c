/* Every argument of every function that takes a contact, a state or a workspace, with every kind of bad value: refused by a code of
   its own, nothing written, and no operation that may be trapped. Extreme values that are allowed: finite answers. */
#include "bad_calls.h"

/* What no number of a kind may be, and how it is refused; factors of the slip force for forces. */
static const struct {
    int kind;
    double value;
    int32_t status;
} bad_numbers[] = {
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

/* Extreme values that are allowed. */
static const struct {
    int kind;
    double value;
} good_numbers[] = {
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

/* Each number that a function takes, at each place: wrong in every way, and extreme. */
static void number_in_turn(const function *f, int kind, double *place, const char *where)
{
    const double good = *place;
    for (int k = 0; k < NOT_NUMBERS; ++k) {
        memcpy(place, &not_numbers[k], sizeof *place);
        refused(f, status_of_no_number(kind), where);
    }
    for (size_t k = 0; k < sizeof bad_numbers / sizeof *bad_numbers; ++k) {
        if (bad_numbers[k].kind == kind) {
            *place = in_units(kind, bad_numbers[k].value);
            refused(f, bad_numbers[k].status, where);
        }
    }
    for (size_t k = 0; k < sizeof good_numbers / sizeof *good_numbers; ++k) {
        if (good_numbers[k].kind == kind) {
            *place = in_units(kind, good_numbers[k].value);
            accepted(f, where);
        }
    }
    *place = good;
}

static void test_numbers(const function *f)
{
    if (f->scalar != NONE) {
        number_in_turn(f, f->scalar, &call.scalar, "the number");
    }
    for (size_t i = 0; i < f->inputs; ++i) {
        number_in_turn(f, f->kind, &input()[i], "a number of the array");
    }
    /* All of them at once. */
    for (size_t k = 0; f->inputs > 0 && k < sizeof good_numbers / sizeof *good_numbers; ++k) {
        if (good_numbers[k].kind == f->kind) {
            for (size_t i = 0; i < f->inputs; ++i) {
                input()[i] = in_units(f->kind, good_numbers[k].value);
            }
            accepted(f, "all numbers of the array");
        }
    }
    set_up(f);
}

/* The same address, and half an item. */
static void *askew(const void *pointer, size_t item)
{
    return (char *)(size_t)pointer + item / 2;
}

/* Each pointer in turn does not stand where its type may. */
static void test_alignment(const function *f)
{
    call.contacts = askew(call.contacts, sizeof(double));
    refused(f, MSLIP_BAD_ALIGNMENT, "contact is askew");
    set_up(f);
    if (call.active != NULL) {
        call.active = askew(call.active, sizeof(int32_t));
        refused(f, MSLIP_BAD_ALIGNMENT, "active is askew");
        set_up(f);
    }
    if (f->inputs > 0) {
        call.input = askew(call.input, sizeof(double));
        refused(f, MSLIP_BAD_ALIGNMENT, "the array is askew");
        set_up(f);
    }
    if (f->takes & TAKES_STATE) {
        call.state0 = askew(call.state0, sizeof(double));
        refused(f, MSLIP_BAD_ALIGNMENT, "state is askew");
        set_up(f);
    }
    if (call.state1 != NULL) {
        call.state1 = askew(call.state1, sizeof(double));
        refused(f, MSLIP_BAD_ALIGNMENT, "the new state is askew");
        set_up(f);
    }
    if (f->takes & TAKES_WORKSPACE) {
        call.workspace = askew(call.workspace, sizeof(double));
        refused(f, MSLIP_BAD_ALIGNMENT, "workspace is askew");
        set_up(f);
    }
    for (size_t i = 0; i < sizeof call.out / sizeof *call.out; ++i) {
        if (call.out[i] != NULL) {
            call.out[i] = askew(call.out[i], sizeof(double));
            refused(f, MSLIP_BAD_ALIGNMENT, "an output is askew");
            set_up(f);
        }
    }
}

static void test_pointers(const function *f)
{
    call.contacts = NULL;
    refused(f, MSLIP_NULL_POINTER, "contact is NULL");
    set_up(f);
    if (f->inputs > 0) {
        call.input = NULL;
        refused(f, MSLIP_NULL_POINTER, "the array is NULL");
        set_up(f);
    }
    if (f->takes & TAKES_STATE) {
        call.state0 = NULL;
        refused(f, MSLIP_NULL_POINTER, "state is NULL");
        set_up(f);
    }
    if (f->takes & TAKES_WORKSPACE) {
        call.workspace = NULL;
        refused(f, MSLIP_NULL_POINTER, "workspace is NULL");
        set_up(f);
    }
    test_alignment(f);
    /* What is NULL is not wanted: nothing but checks is left. */
    call.state1 = NULL;
    memset(call.out, 0, sizeof call.out);
    remember_regions();
    CHECK(f->call() == MSLIP_OK && raised() == 0 && nothing_changed_but_scratch(f));
    set_up(f);
}

/* So many items that their bytes cannot be counted, and none. */
static void test_counts(const function *f)
{
    static const size_t too_many[] = { SIZE_MAX, SIZE_MAX / 2 + 1, SIZE_MAX / 8, SIZE_MAX / 16 + 1 };
    for (size_t i = 0; (f->takes & TAKES_COUNT) && i < sizeof too_many / sizeof *too_many; ++i) {
        call.n = too_many[i];
        refused(f, MSLIP_BAD_ARRAY_SIZE, "n");
        /* Whatever else is asked for. */
        memset(call.out, 0, sizeof call.out);
        refused(f, MSLIP_BAD_ARRAY_SIZE, "n, and nothing is wanted");
        set_up(f);
    }
    for (size_t i = 0; (f->takes & TAKES_STATE) && i < sizeof too_many / sizeof *too_many; ++i) {
        call.state_length = too_many[i];
        refused(f, MSLIP_BAD_ARRAY_SIZE, "state_length");
        set_up(f);
    }
    if ((f->takes & TAKES_COUNT) && !(f->takes & IS_SLIDERS)) {
        call.n = 0;
        call.input = NULL;
        call.active = NULL;
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
    const function *f = find("mslip_iwan_equivalent");
    set_up(f);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        call.n = bad[i];
        refused(f, MSLIP_BAD_COUNT, "n");
    }
}

/* States that nobody initialised, and updates in place that are refused. */
static void test_states(const function *f)
{
    const size_t bytes = (f->takes & IS_BATCH ? ITEMS : 1) * STATE * sizeof(double);
    for (int fill = 0; fill < 256; fill += 51) {
        memset(states0(), fill, bytes);
        refused(f, MSLIP_BAD_STATE, "a state that was not initialised");
    }
    set_up(f);
    for (int in_place = 0; f->state1 > 0 && in_place < 2; ++in_place) {
        double *number = f->inputs > 0 ? &input()[f->inputs - 1] : &call.scalar;
        call.state1 = in_place ? states0() : NULL;
        for (int k = 0; k < NOT_NUMBERS; ++k) {
            memcpy(number, &not_numbers[k], sizeof *number);
            refused(f, MSLIP_BAD_DISPLACEMENT, in_place ? "in place" : "a state that is not kept");
        }
        fill_states(f);
        call.scalar = filled_turn();
        for (size_t k = 0; k < f->inputs; ++k) {
            input()[k] = filled_turn();
        }
        refused(f, MSLIP_STATE_FULL, in_place ? "in place" : "a state that is not kept");
        set_up(f);
    }
}

/* Workspaces that nobody initialised. */
static void test_workspaces(const function *f)
{
    for (int fill = 0; fill < 256; fill += 51) {
        memset(call.workspace, fill, workspace_lengths[f->rule] * sizeof(double));
        refused(f, MSLIP_BAD_WORKSPACE, "a workspace that was not initialised");
    }
    set_up(f);
}

/* Contacts that nobody prepared. */
static void test_contacts(const function *f)
{
    const size_t bytes = (f->takes & IS_BATCH ? ITEMS : 1) * sizeof(mslip_contact);
    for (int fill = 0; fill < 256; fill += 51) {
        memset(contacts(), fill, bytes);
        refused(f, MSLIP_BAD_CONTACT, "a contact that was not prepared");
    }
    set_up(f);
}

/* Lengths of states: too short for any, for what it holds, and odd. */
static void test_state_lengths(const function *f)
{
    const size_t none = mslip_state_length(0), used = none + 2 * HELD;
    for (size_t length = 0; length < none; ++length) {
        call.state_length = length;
        refused(f, MSLIP_STATE_TOO_SHORT, "state_length");
    }
    set_up(f);
    if (f->takes & IS_BATCH) {
        return; /* the length of one is that of all */
    }
    for (size_t length = none; length < used; ++length) {
        call.state_length = length;
        refused(f, MSLIP_BAD_STATE, "state_length is less than was used");
    }
    /* The last number of an odd length serves for nothing, and is copied. */
    call.state_length = STATE - 1;
    remember_regions();
    CHECK(f->call() == MSLIP_OK && raised() == 0 && region_is_unchanged(state0_region));
    if (f->state1 > 0) {
        CHECK(same_bits(&call.state1[STATE - 2], &states0()[STATE - 2], 1));
        CHECK(same_bits(&call.state1[STATE - 1], (double *)(state1_region->before + state1_region->bytes) - 1, 1));
    }
    set_up(f);
}

static void test_state_full(void)
{
    static const char *const names[] = { "mslip_masing_update", "mslip_masing_path", "mslip_interface_masing_update" };
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
        const function *f = find(names[i]);
        set_up(f);
        fill_states(f);
        call.scalar = filled_turn();
        for (size_t k = 0; k < f->inputs; ++k) {
            input()[k] = filled_turn();
        }
        refused(f, MSLIP_STATE_FULL, "one more reversal than there is room for");
        if (f->takes & IS_BATCH) {
            /* Each alone, as the others go on where they were going. */
            for (size_t bad = 0; bad < ITEMS; ++bad) {
                for (size_t k = 0; k < ITEMS; ++k) {
                    input()[k] = k == bad ? filled_turn() : filled_end();
                }
                refused(f, MSLIP_STATE_FULL, "one item has no room");
            }
        }
    }
}

static void test_state_init(void)
{
    const function *f = find("mslip_masing_update");
    const size_t none = mslip_state_length(0);
    set_up(f);
    remember_regions();
    for (size_t length = 0; length < none; ++length) {
        check_refused(mslip_state_init(length, call.state1), MSLIP_STATE_TOO_SHORT, "mslip_state_init", "state_length");
        check_refused(mslip_state_init(length, NULL), MSLIP_NULL_POINTER, "mslip_state_init", "state");
    }
    check_refused(mslip_state_init(SIZE_MAX, call.state1), MSLIP_BAD_ARRAY_SIZE, "mslip_state_init", "state_length");
    check_refused(mslip_state_init(SIZE_MAX / 8, call.state1), MSLIP_BAD_ARRAY_SIZE, "mslip_state_init", "state_length");
    check_refused(mslip_state_init(STATE, NULL), MSLIP_NULL_POINTER, "mslip_state_init", "state");
    CHECK(mslip_state_length(SIZE_MAX) == SIZE_MAX && mslip_state_length(SIZE_MAX / 2) == SIZE_MAX);
}

/* Workspaces that cannot be, and lengths that do not hold what is wanted. */
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
        { SIZE_MAX / 2 + 1, 1, MSLIP_BAD_HARMONICS }, /* twice of which is 0 */
        { 2, 0, MSLIP_BAD_SAMPLES },
        { 2, 4, MSLIP_BAD_SAMPLES },
        { BIG, BIG, MSLIP_BAD_SAMPLES },
        { 2, BIG + 1, MSLIP_BAD_SAMPLES },
        { 2, SIZE_MAX, MSLIP_BAD_SAMPLES },
        { 2, SIZE_MAX / 2 + 1, MSLIP_BAD_SAMPLES },
        { BIG / 2 - 1, BIG, MSLIP_WORKSPACE_TOO_SHORT }, /* the largest that there is */
        { 2, 16, MSLIP_WORKSPACE_TOO_SHORT },
    };
    static const int32_t rules[] = { MSLIP_EQUIDISTANT, MSLIP_BETWEEN_REVERSALS };
    static const int32_t no_rules[] = { -1, 2, INT32_MAX, INT32_MIN };
    double *memory;

    set_up(find("mslip_harmonic_force"));
    memory = call.workspace;
    remember_regions();
    for (int r = 0; r < 2; ++r) {
        for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
            const size_t h = rows[i].harmonics, s = rows[i].samples, length = mslip_harmonic_workspace_length_rule(h, s, rules[r]);
            const int32_t status = rows[i].status;
            CHECK((length == 0) == (status != MSLIP_WORKSPACE_TOO_SHORT));
            CHECK(r == 1 || mslip_harmonic_workspace_length(h, s) == length);
            const size_t lengths[] = { 0, 1, 4, length > 0 ? length - 1 : 100 };
            for (int k = 0; k < 4; ++k) {
                check_refused(mslip_harmonic_workspace_init_rule(h, s, rules[r], lengths[k], memory), status,
                              "mslip_harmonic_workspace_init_rule", "harmonics, samples, workspace_length");
                if (r == 0) {
                    check_refused(mslip_harmonic_workspace_init(h, s, lengths[k], memory), status, "mslip_harmonic_workspace_init",
                                  "harmonics, samples, workspace_length");
                }
            }
        }
        check_refused(mslip_harmonic_workspace_init_rule(2, 16, rules[r], SIZE_MAX, memory), MSLIP_BAD_ARRAY_SIZE,
                      "mslip_harmonic_workspace_init_rule", "workspace_length");
        check_refused(mslip_harmonic_workspace_init_rule(2, 16, rules[r], 1000, NULL), MSLIP_NULL_POINTER,
                      "mslip_harmonic_workspace_init_rule", "workspace");
    }
    check_refused(mslip_harmonic_workspace_init(2, 16, SIZE_MAX / 8, memory), MSLIP_BAD_ARRAY_SIZE,
                  "mslip_harmonic_workspace_init", "workspace_length");
    check_refused(mslip_harmonic_workspace_init(2, 16, 1000, NULL), MSLIP_NULL_POINTER, "mslip_harmonic_workspace_init",
                  "workspace");
    for (int i = 0; i < 4; ++i) {
        CHECK(mslip_harmonic_workspace_length_rule(2, 16, no_rules[i]) == 0);
        check_refused(mslip_harmonic_workspace_init_rule(2, 16, no_rules[i], 1000, memory), MSLIP_BAD_RULE,
                      "mslip_harmonic_workspace_init_rule", "rule");
    }
}

/* Elliptical contacts have no slip. */
static void test_foreign_contact(void)
{
    const function *f = find("mslip_slip");
    set_up(f);
    contacts()[0] = elliptic_contact();
    refused(f, MSLIP_NOT_AVAILABLE, "an elliptical contact");
    memset(call.out, 0, sizeof call.out);
    refused(f, MSLIP_NOT_AVAILABLE, "an elliptical contact, and nothing is wanted");
}

/* A state that another contact led to: tractions that cannot be are refused, and what a step answers is possible. */
static void test_state_of_another_contact(void)
{
    const function *tractions = find("mslip_masing_tractions"), *update = find("mslip_masing_update");
    mslip_parameters p = flat_parameters();
    static const double friction[] = { 1e-6, 0.01, 0.2, 0.41, 10.0, 0.0 };
    for (size_t i = 0; i < sizeof friction / sizeof *friction; ++i) {
        set_up(tractions);
        p.friction_coefficient = friction[i];
        CHECK(mslip_contact_init(&p, &contacts()[0]) == MSLIP_OK);
        if (friction[i] < 0.05) {
            refused(tractions, MSLIP_FORCE_EXCEEDS_SLIP, "the state of a stronger contact");
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

/* One bad item, wherever it is: none has written anything. One that is skipped is not looked at, and written by nobody. */
static void test_batches(const function *f)
{
    static const double what_is_skipped = 0.0;
    for (size_t bad = 0; bad < ITEMS; ++bad) {
        for (int skipped = 0; skipped < 2; ++skipped) {
            set_up(f);
            active()[bad] = !skipped;
            const mslip_contact good = contacts()[bad];
            for (int i = 0; i < UNPREPARED; ++i) {
                contacts()[bad] = unprepared_contact(i);
                if (skipped) {
                    skipped_alone(f, bad, "a bad contact is skipped");
                } else {
                    refused(f, MSLIP_BAD_CONTACT, "one contact is bad");
                }
            }
            contacts()[bad] = good;
            for (size_t k = 0; k < f->inputs / ITEMS; ++k) {
                double *place = &input()[bad * (f->inputs / ITEMS) + k];
                const double before = *place;
                for (int i = 0; i < NOT_NUMBERS; ++i) {
                    memcpy(place, &not_numbers[i], sizeof *place);
                    if (skipped) {
                        skipped_alone(f, bad, "what is no number is skipped");
                    } else {
                        refused(f, status_of_no_number(f->kind), "one number is none");
                    }
                }
                *place = before;
            }
            if (f->takes & TAKES_STATE) {
                memcpy(&states0()[bad * STATE], &what_is_skipped, sizeof what_is_skipped);
                if (skipped) {
                    skipped_alone(f, bad, "a bad state is skipped");
                } else {
                    refused(f, MSLIP_BAD_STATE, "one state is bad");
                }
            }
        }
    }
    /* All of them rest: no contact is looked at. */
    set_up(f);
    memset(contacts(), 0xff, ITEMS * sizeof(mslip_contact));
    memset(active(), 0, ITEMS * sizeof(int32_t));
    remember_regions();
    CHECK(f->call() == MSLIP_OK && raised() == 0 && nothing_changed_but_scratch(f));
    /* Any number but 0 is a yes. */
    set_up(f);
    static const int32_t yes[ITEMS] = { 1, -1, INT32_MAX, INT32_MIN, 2 };
    memcpy(active(), yes, sizeof yes);
    accepted(f, "flags");
    memset(&contacts()[3], 0, sizeof(mslip_contact));
    refused(f, MSLIP_BAD_CONTACT, "a flag is a yes");
}

/* Every code has a sentence that names what is wrong and what is allowed, and no other number has one. */
static void test_sentences(void)
{
    const char *unknown = mslip_status_text(-1);
    int known = 0;
    for (int i = 0; i < REFUSALS; ++i) {
        const char *text = mslip_status_text(refusals[i].code);
        CHECK(strstr(text, refusals[i].names) != NULL && strstr(text, refusals[i].allows) != NULL);
    }
    for (int32_t code = 1; code < 1000; ++code) {
        known += strcmp(mslip_status_text(code), unknown) != 0;
    }
    CHECK(known == REFUSALS);
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
        accepted(f, "all is well");
        test_numbers(f);
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
    test_state_full();
    test_state_init();
    test_workspace_init();
    test_foreign_contact();
    test_state_of_another_contact();
    test_sentences();
    check_every_code_was_seen(ARGUMENTS);
    return check_report();
}
