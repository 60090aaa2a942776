/* The stack of a call: at most what docs/cluster.md states, of which half is used, and a thread has room for two calls. */
#include "check.h"

#include <microslip.h>
#include <pthread.h>
#include <stdint.h>

enum { WORDS = 1 << 17, STATE = 1000, SAMPLES = 16, COEFFICIENTS = 9 };
static const uint64_t pattern = 0xa5a5a5a5a5a5a5a5;
static uint64_t stack[WORDS];

#define OK(call) CHECK((call) == MSLIP_OK)

/* The deepest calls: initialisation, steps and harmonic forces, of a flat with a rough layer. */
static void make_calls(int32_t directions)
{
    static double state[STATE], workspace[1 << 13], force[COEFFICIENTS], matrix[COEFFICIENTS * COEFFICIENTS];
    static mslip_contact contact;
    static mslip_element element;
    const size_t m = (size_t)directions + 1;
    double energy, steps[][3] = { { 0.0, 0.0, 0.0 }, { 1e-8, 1e-8, 1e-8 }, { 0.1, 0.3, 0.7 }, { -0.1, 0.1, 0.9 }, { 9.0, 5.0, 0.2 } };
    double motion[COEFFICIENTS] = { 0.1, 0.7, 0.2, 0.0, 0.3, 0.4, 0.5, 0.2, 0.1 };
    mslip_parameters p = flat_parameters(1e-4, 0.3);
    OK(mslip_contact_init(&p, &contact));
    p.layer.tangential_compliance = p.layer.normal_compliance = 1.0 / contact.initial_stiffness;
    p.layer.stiffening_load = 1.0;
    OK(mslip_contact_init(&p, &contact));
    OK(mslip_element_init(&p, directions, MSLIP_INPUT_APPROACH, &element));
    const double unit = element.approach;
    OK(mslip_element_state_init(directions, STATE, state));
    for (size_t i = 0; i < sizeof steps / sizeof *steps; ++i) {
        for (size_t k = 0; k < 3; ++k) {
            steps[i][k] *= unit;
        }
        steps[i][m - 1] = steps[i][2];
        OK(mslip_batch_element_update(1, 1, &element, NULL, NULL, STATE, state, steps[i], state, force, matrix, &energy, NULL));
    }
    for (size_t k = 0; k < COEFFICIENTS; ++k) {
        motion[k] *= unit;
    }
    OK(mslip_element_workspace_init(directions, 1, SAMPLES, MSLIP_UNIFORM_SAMPLING, 2,
                                    mslip_element_workspace_length(directions, 1, SAMPLES, MSLIP_UNIFORM_SAMPLING), workspace));
    OK(mslip_batch_element_harmonic_force(1, 1, &element, NULL, NULL, workspace, motion, force, matrix, &energy, NULL, NULL));
    OK(mslip_harmonic_workspace_init(1, SAMPLES, MSLIP_EVENT_DRIVEN,
                                     mslip_harmonic_workspace_length(1, SAMPLES, MSLIP_EVENT_DRIVEN), workspace));
    OK(mslip_harmonic_sensitivity(&contact, workspace, motion, force, matrix));
}

static void *measure(void *directions)
{
    const volatile char here = 0;
    size_t i = 0, *depth = (size_t *)directions;
    make_calls((int32_t)*depth);
    while (stack[i] == pattern) {
        ++i;
    }
    *depth = (size_t)((uintptr_t)&here - (uintptr_t)&stack[i]);
    return NULL;
}

int main(int argc, char **argv)
{
    char text[256];
    unsigned stated[3] = { 0, 0, 0 }, thread = 0;
    FILE *document = fopen("docs/cluster.md", "r");
    check_arguments(argc, argv);
    while (document != NULL && thread == 0 && fgets(text, sizeof text, document) != NULL) {
        sscanf(text, "- **Stack**: at most %u kB per call, %u kB with two directions; `OMP_STACKSIZE=%uk`", &stated[1], &stated[2],
               &thread);
    }
    CHECK(document != NULL && fclose(document) == 0 && thread >= 2 * stated[2]);
    for (int32_t directions = 1; directions <= 2; ++directions) {
        size_t depth = (size_t)directions;
        pthread_attr_t attributes;
        pthread_t id;
        /* Before, so that the linker, which takes stack of its own, has resolved the functions of the C library. */
        make_calls(directions);
        for (size_t i = 0; i < WORDS; ++i) {
            stack[i] = pattern;
        }
        CHECK(pthread_attr_init(&attributes) == 0 && pthread_attr_setstack(&attributes, stack, sizeof stack) == 0
              && pthread_create(&id, &attributes, measure, &depth) == 0 && pthread_join(id, NULL) == 0);
        printf("%d: %zu of %u kB\n", (int)directions, depth, stated[directions]);
        CHECK(depth <= 1024 * (size_t)stated[directions] && depth >= 512 * (size_t)stated[directions]);
    }
    return check_report();
}
