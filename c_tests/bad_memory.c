/* Contacts, states and workspaces of which something was changed: refused wherever that is, and nothing written. What passes for
   whole in spite of that neither crashes nor writes beyond its outputs. Copies are as good as what was copied. */
#include "bad_calls.h"

/* Numbers without a pattern, the same every time. */
static uint64_t random_bits(void)
{
    static uint64_t state = 88172645463325252u;
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return state;
}

static void flip(void *word, int bit)
{
    uint64_t bits;
    memcpy(&bits, word, sizeof bits);
    bits ^= (uint64_t)1 << bit;
    memcpy(word, &bits, sizeof bits);
}

/* The outputs of a call with good arguments, to compare others with. */
static unsigned char *good_outputs[5];

static region *output_region(int i)
{
    return i < 4 ? out_regions[i] : state1_region;
}

static void remember_outputs(void)
{
    for (int i = 0; i < 5; ++i) {
        const region *r = output_region(i);
        good_outputs[i] = realloc(good_outputs[i], r->bytes);
        memcpy(good_outputs[i], r->start, r->bytes);
    }
}

static int outputs_are_the_same(void)
{
    int same = 1;
    for (int i = 0; i < 5; ++i) {
        const region *r = output_region(i);
        same &= memcmp(good_outputs[i], r->start, r->bytes) == 0;
    }
    return same;
}

/* Each bit of so many words, one at a time: all refused, and nothing is written. */
static void every_bit_is_refused(const function *f, void *memory, size_t words, int32_t status, const char *what)
{
    remember_regions();
    for (size_t i = 0; i < words; ++i) {
        unsigned char *word = (unsigned char *)memory + 8 * i;
        int refusals_ = 0;
        for (int bit = 0; bit < 64; ++bit) {
            flip(word, bit);
            refusals_ += f->call() == status;
            flip(word, bit);
        }
        if (!CHECK(refusals_ == 64 && raised() == 0 && nothing_changed())) {
            printf("    %s, word %d of %s: %d of 64 bits are refused\n", f->name, (int)i, what, refusals_);
            restore_regions();
        }
    }
}

static void test_contact_bits(const function *f)
{
    set_up(f);
    for (size_t i = 0; i < (f->takes & IS_BATCH ? ITEMS : 1); ++i) {
        every_bit_is_refused(f, &contacts()[i], sizeof(mslip_contact) / 8, MSLIP_BAD_CONTACT, "a contact");
    }
}

/* Contacts that were cut, shifted, mixed, or have nothing but what they begin and end with. */
static void test_contact_pieces(const function *f)
{
    enum { WORDS = sizeof(mslip_contact) / 8 };
    const mslip_contact other = elliptic_contact();
    mslip_contact good;
    set_up(f);
    good = contacts()[0];
    for (size_t words = 0; words < WORDS; ++words) {
        memset(&contacts()[0], 0, sizeof good);
        memcpy(&contacts()[0], &good, 8 * words);
        refused(f, MSLIP_BAD_CONTACT, "a contact that was cut");
        contacts()[0] = other;
        memcpy(&contacts()[0], &good, 8 * words);
        if (words > 0 && memcmp(&contacts()[0], &good, sizeof good) != 0) {
            refused(f, MSLIP_BAD_CONTACT, "one contact over another");
        }
    }
    memmove((unsigned char *)&contacts()[0] + 8, &good, sizeof good - 8);
    refused(f, MSLIP_BAD_CONTACT, "a contact that was shifted");
    for (size_t i = 0; i < sizeof good; ++i) {
        ((unsigned char *)&contacts()[0])[i] = ((const unsigned char *)&good)[i ^ 7];
    }
    refused(f, MSLIP_BAD_CONTACT, "a contact in the other order of bytes");
    for (int i = 0; i < 100; ++i) {
        for (size_t k = 0; k < WORDS; ++k) {
            const uint64_t word = random_bits();
            memcpy((unsigned char *)&contacts()[0] + 8 * k, &word, 8);
        }
        refused(f, MSLIP_BAD_CONTACT, "random bits");
        /* With the marks at both ends of the reserved numbers. */
        contacts()[0].reserved[0] = good.reserved[0];
        contacts()[0].reserved[1] = good.reserved[1];
        contacts()[0].reserved[241] = good.reserved[241];
        contacts()[0].reserved[242] = good.reserved[242];
        refused(f, MSLIP_BAD_CONTACT, "random bits between marks");
    }
}

/* A contact with another mark that adds up none the less: of another version of the library. */
static void test_contact_of_another_version(const function *f)
{
    uint64_t mark, sum;
    set_up(f);
    memcpy(&mark, &contacts()[0].reserved[0], sizeof mark);
    memcpy(&sum, &contacts()[0].reserved[241], sizeof sum);
    for (uint64_t off = 1; off < 200; ++off) {
        const uint64_t other = mark + off, balance = sum - off;
        memcpy(&contacts()[0].reserved[0], &other, sizeof other);
        memcpy(&contacts()[0].reserved[241], &balance, sizeof balance);
        refused(f, MSLIP_BAD_CONTACT, "a contact of another version");
    }
}

/* Two changes that cannot be told by a sum: whatever is answered, it comes, and nothing beyond the outputs is written. The numbers
   may be of any kind, and are not trapped. */
static void test_changes_that_pass(const function *f, int times)
{
    enum { WORDS = sizeof(mslip_contact) / 8 };
    set_up(f);
    for (int i = 0; i < times; ++i) {
        uint64_t *words = (uint64_t *)(void *)contacts();
        const size_t one = random_bits() % WORDS, two = random_bits() % WORDS;
        const uint64_t before[2] = { words[one], words[two] }, change = (uint64_t)1 << random_bits() % 64;
        int holds = 1;
        words[one] += change;
        words[two] -= change;
        remember_regions();
        f->call();
        for (int k = 0; k < regions_made; ++k) {
            const region *r = &regions[k];
            const size_t outputs = k >= regions_made - 4 ? f->out[k - (regions_made - 4)] * 8
                                   : r == state1_region  ? f->state1 * 8
                                   : r == workspace_region && (f->takes & TAKES_WORKSPACE) ? workspace_lengths[f->rule] * 8
                                                                                            : 0;
            holds &= memcmp(r->start, r->before, r->bytes - outputs) == 0;
        }
        CHECK(holds);
        words[two] = before[1];
        words[one] = before[0];
        if (i % 64 == 0) {
            set_up(f);
        }
    }
    feclearexcept(FE_ALL_EXCEPT);
}

static void test_state_bits(const function *f)
{
    const size_t used = mslip_state_length(HELD);
    set_up(f);
    for (size_t i = 0; i < (f->takes & IS_BATCH ? ITEMS : 1); ++i) {
        every_bit_is_refused(f, states0() + i * STATE, used, MSLIP_BAD_STATE, "a state");
    }
    /* What lies beyond is not looked at. */
    accepted(f, "a good state");
    remember_outputs();
    for (size_t i = used; i < STATE; ++i) {
        memset(&states0()[i], 0xff, sizeof(double));
    }
    CHECK(f->call() == MSLIP_OK && raised() == 0);
    memcpy(state1_region->start, good_outputs[4], state1_region->bytes);
    CHECK(outputs_are_the_same());
}

/* Reversals exchanged, and all but the first number of a state random. */
static void test_state_pieces(const function *f)
{
    const size_t first = mslip_state_length(0);
    double pair[2], mark;
    set_up(f);
    memcpy(pair, &states0()[first], sizeof pair);
    memcpy(&states0()[first], &states0()[first + 2], sizeof pair);
    memcpy(&states0()[first + 2], pair, sizeof pair);
    refused(f, MSLIP_BAD_STATE, "reversals exchanged");
    set_up(f);
    memmove(&states0()[1], &states0()[2], 8 * sizeof(double));
    refused(f, MSLIP_BAD_STATE, "a state that was shifted");
    set_up(f);
    mark = states0()[0];
    for (int i = 0; i < 200; ++i) {
        for (size_t k = 0; k < STATE; ++k) {
            const uint64_t word = random_bits();
            memcpy(&states0()[k], &word, sizeof word);
        }
        refused(f, MSLIP_BAD_STATE, "random bits");
        states0()[0] = mark;
        states0()[1] = i % (REVERSALS + 2);
        refused(f, MSLIP_BAD_STATE, "random bits behind a mark");
    }
    set_up(f);
    memcpy(states0(), contacts(), STATE * sizeof(double));
    refused(f, MSLIP_BAD_STATE, "a contact for a state");
}

/* A workspace begins with what must be as it was made. The rest is scratch, of which nothing is read before it is written. */
static void test_workspace_bits(const function *f)
{
    const size_t length = workspace_lengths[f->rule], least = 4 + SAMPLES / 2 * COEFFICIENTS;
    size_t sealed = 0;
    set_up(f);
    /* Before the first use, when all of the scratch memory is 0. */
    every_bit_is_refused(f, call.workspace, least, MSLIP_BAD_WORKSPACE, "a new workspace");
    accepted(f, "a good workspace");
    remember_outputs();
    remember_regions();
    for (size_t i = 0; i < length; ++i) {
        int refusals_ = 0, same = 0;
        for (int bit = 0; bit < 64; ++bit) {
            int32_t status;
            flip(&call.workspace[i], bit);
            status = f->call();
            refusals_ += status == MSLIP_BAD_WORKSPACE;
            same += status == MSLIP_OK && outputs_are_the_same();
            if (status == MSLIP_BAD_WORKSPACE) {
                flip(&call.workspace[i], bit);
            }
        }
        CHECK((refusals_ == 64 && i == sealed) || (same == 64 && i >= least));
        sealed += refusals_ == 64;
        CHECK(raised() == 0);
    }
    CHECK(sealed >= least && sealed < length && nothing_changed_but_scratch(f));
}

static void test_workspace_pieces(const function *f)
{
    const size_t length = workspace_lengths[f->rule];
    const function *update = find("mslip_masing_update");
    double mark, state[STATE];
    set_up(f);
    mark = call.workspace[0];
    for (int i = 0; i < 200; ++i) {
        for (size_t k = 0; k < length; ++k) {
            const uint64_t word = random_bits();
            memcpy(&call.workspace[k], &word, sizeof word);
        }
        refused(f, MSLIP_BAD_WORKSPACE, "random bits");
        call.workspace[0] = mark;
        refused(f, MSLIP_BAD_WORKSPACE, "random bits behind a mark");
        call.workspace[1] = 1.0 + i % 7;
        call.workspace[2] = 1.0 + i;
        if (call.workspace[1] != HARMONICS || call.workspace[2] != SAMPLES) {
            refused(f, MSLIP_BAD_WORKSPACE, "a mark with another size");
        }
    }
    set_up(update);
    memcpy(state, states0(), sizeof state);
    set_up(f);
    memcpy(call.workspace, state, sizeof state);
    refused(f, MSLIP_BAD_WORKSPACE, "a state for a workspace");
    set_up(f);
    memmove(&call.workspace[0], &call.workspace[1], (length - 1) * sizeof(double));
    refused(f, MSLIP_BAD_WORKSPACE, "a workspace that was shifted");
    set_up(f);
    memset(&call.workspace[8], 0, (length - 8) * sizeof(double));
    refused(f, MSLIP_BAD_WORKSPACE, "a workspace that was cut");
    /* One of fewer harmonics is a workspace, too: it takes and writes as many numbers as it has. */
    set_up(f);
    CHECK(mslip_harmonic_workspace_init_rule(1, 12, f->rule, length, call.workspace) == MSLIP_OK);
    remember_regions();
    CHECK(f->call() == MSLIP_OK && raised() == 0);
    const size_t items = f->takes & IS_BATCH ? ITEMS : 1;
    CHECK(memcmp(&call.out[0][3 * items], out_regions[0]->before + out_regions[0]->bytes - (f->out[0] - 3 * items) * 8,
                 (f->out[0] - 3 * items) * 8) == 0);
    CHECK(memcmp(&call.out[1][9 * items], out_regions[1]->before + out_regions[1]->bytes - (f->out[1] - 9 * items) * 8,
                 (f->out[1] - 9 * items) * 8) == 0);
}

/* Everything copied to another place, from which the same bits follow. */
static void test_copies(const function *f)
{
    const size_t items = f->takes & IS_BATCH ? ITEMS : 1;
    mslip_contact *contact = malloc(items * sizeof *contact);
    double *state = malloc(items * STATE * sizeof *state), *workspace = malloc(workspace_region->bytes);
    set_up(f);
    accepted(f, "what is to be copied");
    remember_outputs();
    memcpy(contact, call.contacts, items * sizeof *contact);
    call.contacts = contact;
    if (f->takes & TAKES_STATE) {
        memcpy(state, call.state0, items * STATE * sizeof *state);
        call.state0 = state;
    }
    if (f->takes & TAKES_WORKSPACE) {
        memcpy(workspace, call.workspace, workspace_lengths[f->rule] * sizeof *workspace);
        call.workspace = workspace;
    }
    accepted(f, "copies");
    CHECK(outputs_are_the_same());
    if (f->state1 > 0) {
        /* In place the same as apart. */
        for (int i = 0; i < 4; ++i) {
            memset(out_regions[i]->start, 0xff, out_regions[i]->bytes);
        }
        double *apart = call.state1;
        call.state1 = state;
        CHECK(f->call() == MSLIP_OK && same_bits(state, apart, f->state1) && outputs_are_the_same());
    }
    free(contact);
    free(state);
    free(workspace);
}

int main(int argc, char **argv)
{
    check_arguments(argc, argv);
    make_regions();
    for (int i = 0; i < FUNCTIONS; ++i) {
        const function *f = &functions[i];
        test_contact_bits(f);
        test_contact_pieces(f);
        test_contact_of_another_version(f);
        if (f->takes & TAKES_STATE) {
            test_state_bits(f);
            test_state_pieces(f);
        }
        if (f->takes & TAKES_WORKSPACE) {
            test_workspace_bits(f);
            test_workspace_pieces(f);
        }
        test_copies(f);
    }
#ifdef __GLIBC__
    fedisableexcept(FE_ALL_EXCEPT);
#endif
    for (int i = 0; i < FUNCTIONS; ++i) {
        test_changes_that_pass(&functions[i], functions[i].takes & IS_SLIDERS ? 200 : 4000);
    }
    return check_report();
}
