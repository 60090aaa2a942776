/* mistakes.c NAME: what a host must not do, so that a tool that watches for it can show that it sees into the library. */
#include "use.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static mslip_contact contact;
static double *shared;

/* One displacement more than there are. */
static int overrun(void)
{
    double *motion = (double *)malloc(4 * sizeof *motion), force[5];
    memset(motion, 0, 4 * sizeof *motion);
    return mslip_monotonic_force(&contact, 5, motion, force, NULL, NULL);
}

/* One force more than there is room for. */
static int overflow(void)
{
    double motion[5] = { 0.0, 1e-7, 2e-7, 3e-7, 4e-7 }, *force = (double *)malloc(4 * sizeof *force);
    return mslip_monotonic_force(&contact, 5, motion, force, NULL, NULL);
}

static int uninitialised(void)
{
    double *motion = (double *)malloc(4 * sizeof *motion), force[4];
    return mslip_monotonic_force(&contact, 4, motion, force, NULL, NULL);
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

/* Two threads with one workspace. */
static int race(void)
{
    const size_t n = mslip_harmonic_workspace_length(1, 64, MSLIP_UNIFORM_SAMPLING);
    shared = (double *)malloc(n * sizeof *shared);
    mslip_harmonic_workspace_init(1, 64, MSLIP_UNIFORM_SAMPLING, n, shared);
#ifdef _OPENMP
#pragma omp parallel num_threads(2)
    harmonic_force(NULL);
#else
    pthread_t threads[2];
    for (int i = 0; i < 2; ++i) {
        pthread_create(&threads[i], NULL, harmonic_force, NULL);
    }
    for (int i = 0; i < 2; ++i) {
        pthread_join(threads[i], NULL);
    }
#endif
    return 0;
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        int (*make)(void);
    } mistakes[] = { { "overrun", overrun }, { "overflow", overflow }, { "uninitialised", uninitialised }, { "race", race } };
    initialise(0, &contact);
    for (size_t i = 0; i < sizeof mistakes / sizeof *mistakes; ++i) {
        if (argc == 2 && strcmp(argv[1], mistakes[i].name) == 0) {
            return mistakes[i].make();
        }
    }
    fprintf(stderr, "usage: mistakes overrun|overflow|uninitialised|race\n");
    return 2;
}
