/* Batch calls: each item has the bits of a single call with its contact, whether contacts are shared by an index or not. Items that
   are not active keep their outputs. */
#include "bad_calls.h"

enum { SHARED = 3, BUFFERS = 5 };
static const int32_t shared_index[ITEMS] = { 2, 0, 2, 1, 2 };

/* Output buffers of a batch: the new states, and four arrays. */
static size_t buffer_length(const function *f, int i)
{
    return i == 0 ? f->state1 : f->out[i - 1];
}

static double *buffer(int i)
{
    return i == 0 ? call.state1 : call.out[i - 1];
}

static void set_buffer(int i, double *memory)
{
    *(i == 0 ? &call.state1 : &call.out[i - 1]) = memory;
}

static void fill_outputs(void)
{
    memset(state1_region->start, 0xff, state1_region->bytes);
    for (int i = 0; i < 4; ++i) {
        memset(out_regions[i]->start, 0xff, out_regions[i]->bytes);
    }
}

/* Valid arguments with contacts of three kinds: one per item, or shared, and then the last ones before the protected page. */
static void set_up_contacts(const function *f, int shared)
{
    const mslip_contact kinds[SHARED] = { flat_contact(), cylinder_contact(), elliptic_contact() };
    set_up(f);
    for (size_t i = 0; i < ITEMS; ++i) {
        contacts()[i] = kinds[shared_index[i]];
    }
    fill_states(f, HELD);
    call.index = NULL;
    if (shared) {
        call.index = last(index_region, sizeof shared_index);
        memcpy(indices(), shared_index, sizeof shared_index);
        call.contacts = last(contact_region, sizeof kinds);
        memcpy(contacts(), kinds, sizeof kinds);
        call.n_contacts = SHARED;
    }
}

static double expected[BUFFERS][ITEMS * (STATE + SQUARE)];

/* The results of single calls. */
static void call_singly(const function *f)
{
    char name[64] = "mslip_";
    const function *single;
    strcat(name, f->name + strlen("mslip_batch_"));
    single = find(name, f->rule);
    set_up_contacts(f, 0);
    fill_outputs();
    const double *const all = call.input;
    call.n = 1;
    for (size_t i = 0; i < ITEMS; ++i) {
        const double *const at = all + i * f->inputs / ITEMS;
        call.input = at;
        call.scalar = *at;
        CHECK(single->call() == MSLIP_OK);
        ++call.contacts;
        if (f->takes & TAKES_STATE) {
            call.state0 += STATE;
        }
        for (int k = 0; k < BUFFERS; ++k) {
            const size_t length = buffer_length(f, k) / ITEMS;
            if (length > 0) {
                memcpy(&expected[k][i * length], buffer(k), length * sizeof(double));
                set_buffer(k, buffer(k) + length);
            }
        }
    }
}

/* Requested outputs of active items have the bits of single calls; all else has its old bits. */
static int is_as_expected(const function *f, int requested, int active_items, double *const outputs[BUFFERS])
{
    int holds = 1;
    for (int k = 0; k < BUFFERS; ++k) {
        const size_t length = buffer_length(f, k) / ITEMS;
        for (size_t i = 0; i < ITEMS && length > 0; ++i) {
            const double *values = outputs[k] + i * length;
            if ((requested >> k & 1) && (active_items >> i & 1)) {
                holds &= same_bits(values, &expected[k][i * length], length);
            } else {
                for (size_t byte = 0; byte < length * sizeof(double); ++byte) {
                    holds &= ((const unsigned char *)values)[byte] == 0xff;
                }
            }
        }
    }
    return holds;
}

static void check_batch(const function *f, int shared, int requested, int active_items)
{
    double *outputs[BUFFERS];
    set_up_contacts(f, shared);
    fill_outputs();
    for (size_t i = 0; i < ITEMS; ++i) {
        active()[i] = active_items >> i & 1 ? (int32_t)i - 7 : 0;
    }
    for (int k = 0; k < BUFFERS; ++k) {
        outputs[k] = buffer(k);
        set_buffer(k, requested >> k & 1 ? outputs[k] : NULL);
    }
    if (!CHECK(f->call() == MSLIP_OK && raised() == 0 && is_as_expected(f, requested, active_items, outputs))) {
        printf("    %s, shared %d, outputs %x, active %x\n", f->name, shared, (unsigned)requested, (unsigned)active_items);
    }
}

int main(int argc, char **argv)
{
    enum { ALL_OUTPUTS = (1 << BUFFERS) - 1, ALL_ITEMS = (1 << ITEMS) - 1 };
    check_arguments(argc, argv);
    make_regions();
    for (int i = 0; i < FUNCTIONS; ++i) {
        const function *f = &functions[i];
        if (!(f->takes & IS_BATCH)) {
            continue;
        }
        call_singly(f);
        for (int shared = 0; shared < 2; ++shared) {
            for (int items = 0; items <= ALL_ITEMS; ++items) {
                check_batch(f, shared, ALL_OUTPUTS, items);
            }
            for (int outputs = 0; outputs <= ALL_OUTPUTS; ++outputs) {
                check_batch(f, shared, outputs, ALL_ITEMS);
            }
            if (f->state1 > 0) {
                set_up_contacts(f, shared);
                call.state1 = states0();
                CHECK(f->call() == MSLIP_OK && same_bits(states0(), expected[0], f->state1));
            }
        }
    }
    return check_report();
}
