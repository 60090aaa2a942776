/* negative_controls.c NAME: errors of a calling application that sanitizers and valgrind have to detect inside the library. */
#include "all_calls.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static mslip_contact contact;
static double *shared;

static int monotonic_force(size_t inputs, size_t outputs, int initialised)
{
    double *u = (double *)malloc(inputs * sizeof *u), *force = (double *)malloc(outputs * sizeof *force);
    if (initialised) {
        memset(u, 0, inputs * sizeof *u);
    }
    return mslip_monotonic_force(&contact, 5, u, force, NULL, NULL);
}

static void *harmonic_force(void *unused)
{
    const double motion[3] = { 0.0, contact.slip_displacement, 0.0 };
    double force[3];
    for (int i = 0; i < 1000; ++i) {
        mslip_harmonic_force(&contact, shared, motion, force, NULL, NULL);
    }
    return unused;
}

static int race(void)
{
    const size_t n = mslip_harmonic_workspace_length(1, 64, MSLIP_UNIFORM_SAMPLING);
    pthread_t threads[2];
    shared = (double *)malloc(n * sizeof *shared);
    mslip_harmonic_workspace_init(1, 64, MSLIP_UNIFORM_SAMPLING, n, shared);
    for (int i = 0; i < 2; ++i) {
        pthread_create(&threads[i], NULL, harmonic_force, NULL);
    }
    for (int i = 0; i < 2; ++i) {
        pthread_join(threads[i], NULL);
    }
    return 0;
}

int main(int argc, char **argv)
{
    const char *name = argc == 2 ? argv[1] : "";
    initialise(0, &contact, NULL);
    return strcmp(name, "read") == 0          ? monotonic_force(4, 5, 1)
        : strcmp(name, "write") == 0          ? monotonic_force(5, 4, 1)
        : strcmp(name, "uninitialised") == 0  ? monotonic_force(5, 5, 0)
        : strcmp(name, "race") == 0           ? race()
                                              : 2;
}
