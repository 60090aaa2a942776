/* threads.c [asked]: contacts shared by threads, each with a workspace of its own, give the bits of one thread. The library is
   first called by several threads at once or, asked, before there are any. With -fopenmp the threads are OpenMP's, else
   POSIX's. */
#include "use.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 8 };

static mslip_contact contacts[CONTACTS];
static uint64_t answers[CONTACTS];
static int threads;

/* Every so many contacts, from the first one on. */
static void work(int first)
{
    double *own[RULES] = { workspace(MSLIP_UNIFORM_SAMPLING), workspace(MSLIP_EVENT_DRIVEN) };
    for (int i = first; i < CONTACTS; i += threads) {
        answers[i] = visit_one(&contacts[i], own);
    }
    free(own[0]);
    free(own[1]);
}

#ifdef _OPENMP
static void initialise_all(void)
{
#pragma omp parallel for num_threads(MOST)
    for (int i = 0; i < CONTACTS; ++i) {
        initialise(i, &contacts[i]);
    }
}

static void work_all(void)
{
#pragma omp parallel for num_threads(threads) schedule(static, 1)
    for (int i = 0; i < threads; ++i) {
        work(i);
    }
}
#else
static void *initialise_some(void *first)
{
    for (mslip_contact *contact = (mslip_contact *)first; contact < contacts + CONTACTS; contact += MOST) {
        initialise((int)(contact - contacts), contact);
    }
    return NULL;
}

static void *work_some(void *first)
{
    work((int)((mslip_contact *)first - contacts));
    return NULL;
}

static void on_threads(int n, void *(*run)(void *))
{
    pthread_t pool[MOST];
    for (int i = 0; i < n; ++i) {
        if (pthread_create(&pool[i], NULL, run, &contacts[i]) != 0) {
            abort();
        }
    }
    for (int i = 0; i < n; ++i) {
        pthread_join(pool[i], NULL);
    }
}

static void initialise_all(void)
{
    on_threads(MOST, initialise_some);
}

static void work_all(void)
{
    on_threads(threads, work_some);
}
#endif

int main(int argc, char **argv)
{
    uint64_t alone[CONTACTS];
    int passed = 0, failed = 0;

    if (argc > 1 && strcmp(argv[1], "asked") == 0) {
        initialise(0, contacts);
    }
    initialise_all();
    for (int i = 0; i < CONTACTS; ++i) {
        mslip_contact contact;
        initialise(i, &contact);
        ++*(memcmp(&contact, &contacts[i], sizeof contact) == 0 ? &passed : &failed);
    }
    for (threads = 1; threads <= MOST; threads *= 2) {
        memset(answers, 0, sizeof answers);
        work_all();
        if (threads == 1) {
            memcpy(alone, answers, sizeof alone);
        }
        for (int i = 0; i < CONTACTS; ++i) {
            ++*(answers[i] == alone[i] && answers[i] != 0 ? &passed : &failed);
        }
    }
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}
