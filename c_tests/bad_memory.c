/* Invalid memory. A call recognises contacts, elements, states, workspaces and tables that are uninitialised, of another layout or
   too short by their tags; the _check functions recognise any changed bit of a contact or an element, and states that are not finite
   or not nested. Arbitrary bytes behind a valid tag neither crash nor hang a call, which writes its outputs only. Copies are
   equivalent to their originals. */
#include "calls.h"

/* 64-bit words: a contact has its tag in word 6, an element in word 8, a state and a table in word 0, a workspace in words 0 and
   1. The count of a tag is in its lower 40 bits. */
enum { CONTACT_WORDS = sizeof(mslip_contact) / 8, CONTACT_TAG = 6, ELEMENT_WORDS = sizeof(mslip_element) / 8, ELEMENT_TAG = 8,
       COUNT_BITS = 40, HEADER = 4 };
static const uint64_t kind_and_layout = UINT64_MAX << COUNT_BITS;

/* Pseudorandom bits, the same in every run. */
static uint64_t random_bits(void)
{
    static uint64_t state = 88172645463325252u;
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return state;
}

static void set_word(void *memory, size_t i, uint64_t bits)
{
    memcpy((unsigned char *)memory + 8 * i, &bits, sizeof bits);
}

static uint64_t get_word(const void *memory, size_t i)
{
    uint64_t bits;
    memcpy(&bits, (const unsigned char *)memory + 8 * i, sizeof bits);
    return bits;
}

static void flip(void *memory, size_t i, int bit)
{
    set_word(memory, i, get_word(memory, i) ^ (uint64_t)1 << bit);
}

static size_t tag_of_law(const function *f)
{
    return f->takes & IS_ELEMENT ? ELEMENT_TAG : CONTACT_TAG;
}

/* The outputs of a valid call. */
static unsigned char *valid_outputs[OUTPUTS];

static void save_outputs(void)
{
    for (int i = 0; i < OUTPUTS; ++i) {
        valid_outputs[i] = realloc(valid_outputs[i], out_regions[i]->bytes);
        memcpy(valid_outputs[i], out_regions[i]->start, out_regions[i]->bytes);
    }
}

/* The same bits as in the valid call, from the given output on. */
static int same_outputs_from(int first)
{
    int same = 1;
    for (int i = first; i < OUTPUTS; ++i) {
        same &= memcmp(valid_outputs[i], out_regions[i]->start, out_regions[i]->bytes) == 0;
    }
    return same;
}

/* Each of these bits of a tag, alone. */
static void tag_bits_are_rejected(const function *f, void *tag, uint64_t bits, int32_t status, const char *what)
{
    for (int bit = 0; bit < 64; ++bit) {
        if (bits >> bit & 1) {
            flip(tag, 0, bit);
            rejected(f, status, what);
            flip(tag, 0, bit);
        }
    }
}

/* One bit of a contact's tag is the geometry, three of an element's that, the normal input and the directions, one of a workspace's
   the rule. */
static void test_tags(const function *f)
{
    set_up(f);
    for (size_t i = 0; i < items_of(f); ++i) {
        const uint64_t bits = UINT64_MAX - (f->takes & IS_ELEMENT ? 7 : 1);
        tag_bits_are_rejected(f, (double *)law_at(f, i) + tag_of_law(f), bits, status_of_law(f), "the tag of a contact or element");
    }
    for (size_t i = 0; (f->takes & TAKES_STATE) && i < items_of(f); ++i) {
        const uint64_t most = f->takes & IS_ELEMENT ? PIECES + 1 : REVERSALS;
        const uint64_t counts[] = { most + 1, 2000, (uint64_t)1 << 32, ((uint64_t)1 << COUNT_BITS) - 1 };
        double *state = STATES + i * STATE;
        const uint64_t tag = get_word(state, 0);
        tag_bits_are_rejected(f, state, kind_and_layout, MSLIP_BAD_STATE, "the tag of a state");
        for (size_t k = 0; directions_for(f) == 1 && k < LENGTH(counts); ++k) {
            set_word(state, 0, (tag & kind_and_layout) | counts[k]);
            rejected(f, MSLIP_BAD_STATE, "more reversals or knots than the length holds");
        }
        set_word(state, 0, tag);
    }
    if (f->takes & TAKES_WORKSPACE) {
        static const uint64_t sizes[][3] = { { 0, 16, 1 }, { 2, 0, 1 }, { 2, 4, 1 }, { 2, (1 << 24) + 1, 1 },
                                             { (1 << 24) + 1, (1 << 24), 1 }, { 2, 16, 0 }, { 2, 16, (1 << 16) + 1 } };
        const uint64_t tags[3] = { get_word(call.workspace, 0), get_word(call.workspace, 1), get_word(call.workspace, 2) };
        tag_bits_are_rejected(f, &call.workspace[0], kind_and_layout, MSLIP_BAD_WORKSPACE, "the first tag");
        tag_bits_are_rejected(f, &call.workspace[1], kind_and_layout, MSLIP_BAD_WORKSPACE, "the second tag");
        tag_bits_are_rejected(f, &call.workspace[2], kind_and_layout, MSLIP_BAD_WORKSPACE, "the third tag");
        for (size_t k = 0; k < LENGTH(sizes); ++k) {
            for (size_t i = 0; i < 3; ++i) {
                set_word(call.workspace, i, (tags[i] & kind_and_layout) | sizes[k][i]);
            }
            rejected(f, MSLIP_BAD_WORKSPACE, "a size that is not allowed");
        }
        set_up(f);
        memmove(&call.workspace[0], &call.workspace[1], (workspace_length(f) - 1) * sizeof(double));
        rejected(f, MSLIP_BAD_WORKSPACE, "a shifted workspace");
    }
    if (f->takes & TAKES_TABLE) {
        set_up(f);
        tag_bits_are_rejected(f, call.table, kind_and_layout, MSLIP_BAD_TABLE, "the tag of a table");
        memmove(&call.table[0], &call.table[1], (mslip_stiffness_table_length() - 1) * sizeof(double));
        rejected(f, MSLIP_BAD_TABLE, "a shifted table");
    }
}

/* The beginning of a buffer of another kind, and random bytes. */
enum { COPIED = 40 };
static void test_other_buffers(const function *f)
{
    double state[COPIED];
    set_up(find(f->takes & IS_ELEMENT ? "mslip_masing_update" : "mslip_element_update", 0));
    memcpy(state, STATES, sizeof state);
    set_up(f);
    memcpy(law_at(f, 0), state, sizeof state);
    memcpy((double *)law_at(f, 0) + tag_of_law(f), state, sizeof(double));
    rejected(f, status_of_law(f), "a state as contact or element");
    set_up(f);
    memmove(law_at(f, 0), (double *)law_at(f, 0) + 1, law_size(f) - 8);
    rejected(f, status_of_law(f), "a shifted contact or element");
    set_up(f);
    if (f->takes & TAKES_STATE) {
        memcpy(STATES, state, sizeof state);
        rejected(f, MSLIP_BAD_STATE, "the state of an element as that of a contact, or the reverse");
        memcpy(STATES, (double *)law_at(f, 0) + tag_of_law(f), COPIED * sizeof(double));
        rejected(f, MSLIP_BAD_STATE, "a contact or element as state");
    }
    if (f->takes & TAKES_WORKSPACE) {
        memcpy(call.workspace, state, sizeof state);
        rejected(f, MSLIP_BAD_WORKSPACE, "a state as workspace");
    }
    if (f->takes & TAKES_TABLE) {
        memcpy(call.table, state, sizeof state);
        rejected(f, MSLIP_BAD_TABLE, "a state as table");
        memcpy(call.table, (double *)law_at(f, 0) + tag_of_law(f), COPIED * sizeof(double));
        rejected(f, MSLIP_BAD_TABLE, "a contact as table");
    }
    set_up(f);
    for (int i = 0; i < 100; ++i) {
        for (size_t k = 0; k < law_size(f) / 8; ++k) {
            set_word(law_at(f, 0), k, random_bits());
        }
        rejected(f, status_of_law(f), "random bytes");
    }
}

/* Any changed bit of an element; elements that were truncated, shifted or mixed. */
static void test_element_check(void)
{
    static mslip_element element;
    for (int by_force = 0; by_force < 2; ++by_force) {
        const mslip_element *valid = by_force ? element_of(ELLIPSE, TWO_DIRECTIONS + 1) : element_of(FLAT, 0);
        const mslip_element *other = element_of(CYLINDER, by_force);
        int found = 0;
        element = *valid;
        CHECK(mslip_element_check(&element) == MSLIP_OK);
        for (size_t bit = 0; bit < 64 * ELEMENT_WORDS; ++bit) {
            flip(&element, bit / 64, bit % 64);
            found += mslip_element_check(&element) == MSLIP_BAD_ELEMENT;
            flip(&element, bit / 64, bit % 64);
        }
        CHECK(found == 64 * ELEMENT_WORDS);
        for (size_t k = 0; k < 2 * ELEMENT_WORDS; ++k) {
            memset(&element, 0, sizeof element);
            element = k % 2 ? *other : element;
            memcpy(&element, valid, k / 2 * 8);
            const int same = memcmp(&element, valid, sizeof element) == 0 || memcmp(&element, other, sizeof element) == 0;
            CHECK(mslip_element_check(&element) == (same ? MSLIP_OK : MSLIP_BAD_ELEMENT));
        }
        memmove(&element, &valid->friction_coefficient, sizeof element - 8);
        CHECK(mslip_element_check(&element) == MSLIP_BAD_ELEMENT);
    }
    CHECK(raised() == 0);
}

/* Any changed bit of a contact; contacts that were truncated, shifted, mixed or sent in the other byte order. */
static void test_contact_check(void)
{
    for (int kind = 0; kind < KINDS; ++kind) {
        const mslip_contact valid = contact_of(kind), other = contact_of((kind + 1) % KINDS);
        mslip_contact contact = valid;
        int found = 0;
        CHECK(mslip_contact_check(&contact) == MSLIP_OK);
        for (size_t bit = 0; bit < 64 * CONTACT_WORDS; ++bit) {
            flip(&contact, bit / 64, bit % 64);
            found += mslip_contact_check(&contact) == MSLIP_BAD_CONTACT;
            flip(&contact, bit / 64, bit % 64);
        }
        CHECK(found == 64 * CONTACT_WORDS);
        for (size_t k = 0; k < 2 * CONTACT_WORDS; ++k) {
            memset(&contact, 0, sizeof contact);
            contact = k % 2 ? other : contact;
            memcpy(&contact, &valid, k / 2 * 8);
            const int same = memcmp(&contact, &valid, sizeof contact) == 0 || memcmp(&contact, &other, sizeof contact) == 0;
            CHECK(mslip_contact_check(&contact) == (same ? MSLIP_OK : MSLIP_BAD_CONTACT));
        }
        memmove(&contact, &valid.half_width, sizeof contact - 8);
        CHECK(mslip_contact_check(&contact) == MSLIP_BAD_CONTACT);
        for (size_t k = 0; k < sizeof contact; ++k) {
            ((unsigned char *)&contact)[k] = ((const unsigned char *)&valid)[k ^ 7];
        }
        CHECK(mslip_contact_check(&contact) == MSLIP_BAD_CONTACT);
    }
    CHECK(raised() == 0);
}

/* The state is rejected by the check of its kind if element i has this value, and then restored. */
static void check_finds(size_t i, double value, const char *what)
{
    const double valid = STATES[i];
    memcpy(&STATES[i], &value, sizeof value);
    if (!CHECK((call.elements != NULL ? mslip_element_state_check(call.elements->directions, STATE, STATES)
                                      : mslip_state_check(STATE, STATES))
               == MSLIP_BAD_STATE)) {
        printf("    %s: element %d, %g\n", what, (int)i, value);
    }
    STATES[i] = valid;
}

/* A state of every history is valid; one with a value that is not finite, of the wrong sign or not nested is not. */
static void test_state_check(void)
{
    enum { SLIP_DIRECTION = 2, FIRST = 5, PER_REVERSAL = 3 };
    const function *f = find("mslip_masing_update", 0);
    const size_t used = mslip_state_length(USED);
    for (int kind = 0; kind < KINDS; ++kind) {
        const mslip_contact contact = contact_of(kind);
        const double slip = kind < OPEN ? contact.slip_displacement : 1e-7;
        set_up(f);
        CHECK(mslip_state_init(STATE, STATES) == MSLIP_OK && mslip_state_check(STATE, STATES) == MSLIP_OK);
        for (int i = 0; i < 3000; ++i) {
            const double any = (double)(random_bits() % 1000) / 350 - 1.4;
            const double displacement = slip * (i % 100 < 50 ? decaying(i % 50 % 20) * 5e7 : any);
            CHECK(mslip_masing_update(&contact, STATE, STATES, displacement, STATES, NULL, NULL, NULL) == MSLIP_OK);
            CHECK(mslip_state_check(STATE, STATES) == MSLIP_OK);
        }
    }
    set_up(f);
    for (size_t i = 1; i < used; ++i) {
        for (int k = 0; k < NON_FINITE; ++k) {
            check_finds(i, from_bits(non_finite[k]), "not finite");
        }
    }
    check_finds(SLIP_DIRECTION, 0.5, "slip direction");
    check_finds(SLIP_DIRECTION, -2.0, "slip direction");
    for (size_t i = 0; i < USED; ++i) {
        check_finds(FIRST + PER_REVERSAL * i + 2, -1e-3, "negative error");
        check_finds(FIRST + PER_REVERSAL * i, i % 2 == 0 ? -1.0 : 1.0, "not nested");
        if (i > 0) {
            check_finds(FIRST + PER_REVERSAL * i, i % 2 == 0 ? 1.0 : -1.0, "not nested");
        }
    }
    check_finds(1, 1.0, "not nested");
    check_finds(1, -1.0, "not nested");
    /* Doubles beyond the reversals are unused. */
    memset(&STATES[used], 0xff, (STATE - used) * sizeof(double));
    CHECK(mslip_state_check(STATE, STATES) == MSLIP_OK && raised() == 0);
}

/* As for contacts, after histories with separation: a state of every history is valid, one with any of these values is not. */
static void test_element_state_check(void)
{
    enum { FIRST = 8, PER_KNOT = 4, LAST = FIRST + PER_KNOT * USED_PIECES };
    for (int variant = 0; variant < VARIANTS; ++variant) {
        const function *f = find("mslip_element_update", variant);
        const int32_t input = normal_input_of(variant), directions = directions_of(variant);
        for (int kind = 0; kind < KINDS; ++kind) {
            const mslip_element *element = element_of(kind, variant);
            const double largest = input == MSLIP_INPUT_APPROACH ? element->approach : element->normal_force;
            set_up(f);
            CHECK(mslip_element_state_init(directions, STATE, STATES) == MSLIP_OK);
            CHECK(mslip_element_state_check(directions, STATE, STATES) == MSLIP_OK);
            for (int i = 0; i < 3000; ++i) {
                const double u = (double)(random_bits() % 1000) / 500 - 1.0, w = (double)(random_bits() % 1000) / 800 - 0.1;
                const double part = i % 100 < 30 ? 0.03 : 1.0; /* many pieces, or gross slip */
                const double normal = largest * (input == MSLIP_INPUT_NORMAL_FORCE ? fmax(w, 0.0) : w);
                const double tangential = part * u * element->approach, across = part * element->approach * (w - 0.5);
                const double step[] = { tangential, directions == 1 ? normal : across, normal };
                CHECK(mslip_element_update(element, STATE, STATES, step, STATES, NULL, NULL, NULL) == MSLIP_OK);
                if (!CHECK(mslip_element_state_check(directions, STATE, STATES) == MSLIP_OK)) {
                    printf("    element %d, variant %d, step %d\n", kind, variant, i);
                }
            }
        }
        set_up(f);
        for (size_t i = 1; i < used_state(f); ++i) {
            for (int k = 0; k < NON_FINITE; ++k) {
                check_finds(i, from_bits(non_finite[k]), "not finite");
            }
        }
        for (size_t i = 3; directions == 1 && i < FIRST; ++i) {
            check_finds(i, -1e-3, "negative");
        }
        for (size_t i = FIRST; directions == 1 && i < LAST; i += PER_KNOT) {
            check_finds(i, -1.0, "a size that decreases");
            check_finds(i + 1, 1.0, "a size that decreases");
            check_finds(i + 2, -1.0, "a negative force");
        }
        if (directions == 1) {
            check_finds(1, 1.0, "a displacement outside of the last knot");
            check_finds(3, 1e-6 * STATES[3], "less than the last knot");
        }
        memset(&STATES[used_state(f)], 0xff, (STATE - used_state(f)) * sizeof(double));
        CHECK(mslip_element_state_check(directions, STATE, STATES) == MSLIP_OK && raised() == 0);
    }
}

/* Copies at other addresses give the same bits, and so does an update in place. Unused doubles of a state and the scratch memory of
   a workspace, do not affect the results. */
static void test_copies(const function *f)
{
    const size_t items = items_of(f), length = workspace_length(f), used = used_state(f);
    void *laws = malloc(items * law_size(f));
    double *state = malloc(items * STATE * sizeof *state), *workspace = malloc((length + 1) * sizeof *workspace);
    double *table = malloc(mslip_stiffness_table_length() * sizeof *table);
    set_up(f);
    accepted(f, "the originals");
    save_outputs();
    memcpy(laws, law_at(f, 0), items * law_size(f));
    call.contacts = f->takes & IS_ELEMENT ? NULL : laws;
    call.elements = f->takes & IS_ELEMENT ? laws : NULL;
    if (f->takes & TAKES_STATE) {
        memcpy(state, call.state, items * STATE * sizeof *state);
        call.state = state;
    }
    if (f->takes & TAKES_WORKSPACE) {
        memcpy(workspace, call.workspace, length * sizeof *workspace);
        call.workspace = workspace;
    }
    if (f->takes & TAKES_TABLE) {
        memcpy(table, call.table, mslip_stiffness_table_length() * sizeof *table);
        call.table = table;
    }
    accepted(f, "copies");
    CHECK(same_outputs_from(0));
    if (f->out[0] > 0) {
        const double *separate = call.out[0];
        call.out[0] = state;
        CHECK(f->call() == MSLIP_OK && same_states(f, state, separate) && same_outputs_from(1));
    }
    set_up(f);
    if (f->takes & TAKES_STATE) {
        for (size_t i = 0; i < items; ++i) {
            memset(&STATES[i * STATE + used], 0xff, (STATE - used) * sizeof(double));
        }
        CHECK(f->call() == MSLIP_OK && raised() == 0 && same_outputs_from(1));
    }
    if (f->takes & TAKES_WORKSPACE) {
        size_t scratch = 0;
        CHECK(f->call() == MSLIP_OK);
        init_workspace(f, HARMONICS, SAMPLES, length, workspace);
        for (size_t i = 0; i < length; ++i) {
            if (get_word(workspace, i) != get_word(call.workspace, i)) {
                set_word(call.workspace, i, UINT64_MAX);
                ++scratch;
            }
        }
        CHECK(scratch > 0 && same_bits(workspace, call.workspace, 3));
        CHECK(f->call() == MSLIP_OK && raised() == 0 && same_outputs_from(0));
        /* A longer workspace may be used for fewer harmonics. */
        const size_t one = f->takes & IS_ELEMENT ? 3 * components_of(f) : 3;
        const size_t columns = strstr(f->name, "sensitivity") ? MSLIP_PARAMETER_COUNT : one;
        const size_t lengths[3] = { 0, one * items, one * columns * items };
        init_workspace(f, 1, 12, length, call.workspace);
        for (size_t i = 0; (f->takes & IS_ELEMENT) && i < f->inputs; ++i) {
            const int normal = APPROACH_COEFFICIENT + normal_input_of(f->rule) - MSLIP_INPUT_APPROACH;
            INPUT[i] = valid_value(i % one < one - 3 ? DISPLACEMENT : normal, i % one == one - 3 ? 0 : 1, 0.0);
        }
        CHECK(f->call() == MSLIP_OK && raised() == 0);
        for (int i = 1; i < 3; ++i) {
            const size_t unused = (f->out[i] - lengths[i]) * 8, end = out_regions[i]->bytes - unused;
            CHECK(memcmp(out_regions[i]->start + end, valid_outputs[i] + end, unused) == 0);
        }
    }
    free(laws);
    free(state);
    free(workspace);
    free(table);
}

/* A word that may be anything: random bits, or an extreme value. */
static uint64_t arbitrary_word(void)
{
    static const uint64_t extreme[] = { 0, 0x8000000000000000, 1, 0x7ff8000000000000, 0x7ff0000000000001, 0x7ff0000000000000,
                                        0xfff0000000000000, 0x7fefffffffffffff, 0x3ff0000000000000, 0xbff0000000000000,
                                        0x3e70000000000000, 0x5fe0000000000000, 0x0010000000000000 };
    const uint64_t bits = random_bits();
    return bits % 2 ? random_bits() : extreme[bits / 2 % LENGTH(extreme)];
}

/* Overwrites some words of a buffer from the first on, or all of them. */
static void scatter(void *memory, size_t first, size_t words)
{
    const size_t count = random_bits() % 3 ? 1 + random_bits() % 4 : words;
    for (size_t i = 0; i < count; ++i) {
        set_word(memory, first + (count == words ? i : random_bits() % words), arbitrary_word());
    }
}

/* The status is not specified; the call returns and writes its outputs only. */
static void returns(const function *f)
{
    int holds = 1;
    save_regions();
    f->call();
    for (int k = 0; k < regions_made; ++k) {
        const region *r = &regions[k];
        size_t writable = r == workspace_region && (f->takes & TAKES_WORKSPACE) ? workspace_length(f) : 0;
        for (int i = 0; i < OUTPUTS; ++i) {
            writable += r == out_regions[i] ? f->out[i] : 0;
        }
        holds &= !r->in_use || memcmp(r->start, r->before, r->bytes - 8 * writable) == 0;
    }
    if (!CHECK(holds)) {
        printf("    %s wrote outside of its outputs\n", f->name);
    }
}

static void test_arbitrary_bytes(const function *f, int times)
{
    for (int i = 0; i < times; ++i) {
        set_up(f);
        void *law = law_at(f, random_bits() % items_of(f));
        const uint64_t tag = get_word(law, tag_of_law(f)) ^ (random_bits() % 4 == 0);
        scatter(law, 0, law_size(f) / 8);
        set_word(law, tag_of_law(f), tag);
        returns(f);
        /* First with this contact or element, then with a valid one. */
        for (int valid = 0; (f->takes & TAKES_STATE) && valid < 2; ++valid) {
            double *state = STATES + random_bits() % items_of(f) * STATE;
            const uint64_t count = random_bits() % (REVERSALS + 1);
            if (directions_for(f) == 1) {
                set_word(state, 0, (get_word(state, 0) & kind_and_layout) | count);
            }
            scatter(state, 1, STATE - 1);
            returns(f);
            mslip_state_check(STATE, state);
            mslip_state_error(STATE, state, call.out[1]);
            mslip_element_state_check(directions_for(f), STATE, state);
            mslip_element_state_error(directions_for(f), STATE, state, call.out[1]);
            set_up(f);
        }
        if (f->takes & TAKES_WORKSPACE) {
            set_up(f);
            scatter(call.workspace, HEADER, workspace_length(f) - HEADER);
            returns(f);
        }
        if (f->takes & TAKES_TABLE) {
            const size_t first = random_bits() % 8 == 0 ? 1 : 3; /* with or without the shape */
            set_up(f);
            scatter(call.table, first, mslip_stiffness_table_length() - first);
            returns(f);
        }
    }
    feclearexcept(FE_ALL_EXCEPT);
}

int main(int argc, char **argv)
{
    check_arguments(argc, argv);
    make_regions();
    test_contact_check();
    test_element_check();
    test_state_check();
    test_element_state_check();
    for (int i = 0; i < FUNCTIONS; ++i) {
        test_tags(&functions[i]);
        test_other_buffers(&functions[i]);
        test_copies(&functions[i]);
    }
#ifdef __GLIBC__
    fedisableexcept(FE_ALL_EXCEPT);
#endif
    for (int i = 0; i < FUNCTIONS; ++i) {
#ifdef __unix__
        alarm(600); /* a call that hangs is a failure */
#endif
        /* A batch makes the steps and forces of a single call, for five items; a slider takes a search. */
        test_arbitrary_bytes(&functions[i], functions[i].takes & (IS_IWAN | IS_BATCH) ? 200 : 2000);
    }
    for (int i = 0; i < OUTPUTS; ++i) {
        free(valid_outputs[i]);
    }
    return check_report();
}
