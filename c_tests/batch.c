/* Outputs of every function: each subset has the bits of the full call. Each item of a batch has the bits of a single call with its
   contact or element, whether these are shared by an index or not. Items that are not active keep their outputs. */
#include "calls.h"

enum { SHARED = 3, MOST = ITEMS * (STATE + ELEMENT_SQUARE) };
static const int32_t shared_index[ITEMS] = { 2, 0, 2, 1, 2 };
static double expected[OUTPUTS][MOST];

/* Valid arguments. A batch has contacts of three kinds: one per item, or shared and the last ones before the protected page. */
static void set_up_contacts(const function *f, int shared)
{
    set_up(f);
    fill_outputs();
    if (!(f->takes & IS_BATCH)) {
        return;
    }
    for (size_t i = 0; i < ITEMS; ++i) {
        set_law(f, i, shared_index[i]);
    }
    fill_states(f);
    call.index = NULL;
    if (shared) {
        call.index = last(index_region, sizeof shared_index);
        memcpy(INDICES, shared_index, sizeof shared_index);
        if (f->takes & IS_ELEMENT) {
            call.elements = last(element_region, SHARED * sizeof(mslip_element));
        } else {
            call.contacts = last(contact_region, SHARED * sizeof(mslip_contact));
        }
        for (int i = 0; i < SHARED; ++i) {
            set_law(f, (size_t)i, i);
        }
        call.n_contacts = SHARED;
    }
}

/* The results of the full call, or for a batch those of single calls. */
static void call_singly(const function *f)
{
    const size_t items = items_of(f);
    const function *single = f;
    set_up_contacts(f, 0);
    if (f->takes & IS_BATCH) {
        char name[64] = "mslip_";
        strcat(name, f->name + strlen("mslip_batch_"));
        single = find(name, f->rule);
        call.n = 1;
    }
    const arguments first = call;
    for (size_t i = 0; i < items; ++i) {
        if (f->takes & IS_BATCH) {
            call.contacts = f->takes & IS_ELEMENT ? NULL : &first.contacts[i];
            call.elements = f->takes & IS_ELEMENT ? &first.elements[i] : NULL;
            call.input = first.input + i * (f->inputs / items);
            call.scalar = call.input[0];
            call.state = f->takes & TAKES_STATE ? first.state + i * STATE : NULL;
        }
        CHECK(single->call() == MSLIP_OK);
        for (int k = 0; k < OUTPUTS; ++k) {
            const size_t length = f->out[k] / items;
            if (length > 0) {
                memcpy(&expected[k][i * length], call.out[k], length * sizeof(double));
                call.out[k] += length;
            }
        }
    }
}

/* Requested outputs of active items have the expected bits; all others keep their bits. */
static void check_call(const function *f, int shared, int requested, int active_items)
{
    double unset[MOST], *outputs[OUTPUTS];
    int holds;
    memset(unset, 0xff, sizeof unset);
    set_up_contacts(f, shared);
    for (size_t i = 0; (f->takes & IS_BATCH) && i < ITEMS; ++i) {
        ACTIVE[i] = active_items >> i & 1 ? (int32_t)i - 7 : 0;
    }
    for (int k = 0; k < OUTPUTS; ++k) {
        outputs[k] = call.out[k];
        call.out[k] = requested >> k & 1 ? outputs[k] : NULL;
    }
    holds = f->call() == MSLIP_OK && raised() == 0;
    for (int k = 0; k < OUTPUTS; ++k) {
        const size_t length = f->out[k] / items_of(f);
        for (size_t i = 0; i < items_of(f) && length > 0; ++i) {
            const int written = (requested >> k & 1) && (active_items >> i & 1);
            holds &= same_bits(outputs[k] + i * length, written ? &expected[k][i * length] : unset, length);
        }
    }
    if (!CHECK(holds)) {
        printf("    %s, shared %d, outputs %x, active %x\n", f->name, shared, (unsigned)requested, (unsigned)active_items);
    }
}

int main(int argc, char **argv)
{
    enum { ALL_OUTPUTS = (1 << OUTPUTS) - 1, ALL_ITEMS = (1 << ITEMS) - 1 };
    check_arguments(argc, argv);
    make_regions();
    for (int i = 0; i < FUNCTIONS; ++i) {
        const function *f = &functions[i];
        const int is_batch = (f->takes & IS_BATCH) != 0;
        call_singly(f);
        for (int shared = 0; shared <= is_batch; ++shared) {
            for (int outputs = 0; outputs <= ALL_OUTPUTS; ++outputs) {
                check_call(f, shared, outputs, ALL_ITEMS);
            }
            for (int items = 0; is_batch && items <= ALL_ITEMS; ++items) {
                check_call(f, shared, ALL_OUTPUTS, items);
            }
            if (is_batch && f->out[0] > 0) {
                set_up_contacts(f, shared);
                call.out[0] = STATES;
                CHECK(f->call() == MSLIP_OK && same_states(f, STATES, expected[0]));
            }
        }
    }
    return check_report();
}
