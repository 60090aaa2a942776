/* threads.c: contacts and elements shared by 1 to 8 threads, each with workspaces of its own, give the results of one
   thread, bit by bit. The first call is made by
   several threads at once. */
#include "calls.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 8 };

static mslip_contact contacts[CONTACTS];
static mslip_element elements[CONTACTS];
static uint64_t hashes[CONTACTS];
static int threads;

/* The contacts of one thread: every MOST-th, or every threads-th. */
static void *initialise_some(void *first)
{
    for (mslip_contact *contact = (mslip_contact *)first; contact < contacts + CONTACTS; contact += MOST) {
        initialise((int)(contact - contacts), contact, &elements[contact - contacts]);
    }
    return NULL;
}

static void *call_some(void *first)
{
    for (mslip_contact *contact = (mslip_contact *)first; contact < contacts + CONTACTS; contact += threads) {
        hashes[contact - contacts] = hash_of_one(contact, &elements[contact - contacts]);
    }
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

int main(void)
{
    uint64_t expected[CONTACTS];
    on_threads(MOST, initialise_some);
    for (int i = 0; i < CONTACTS; ++i) {
        static mslip_contact contact;
        static mslip_element element;
        initialise(i, &contact, &element);
        if (memcmp(&contact, &contacts[i], sizeof contact) != 0 || memcmp(&element, &elements[i], sizeof element) != 0) {
            return printf("contact or element %d is another if initialised by several threads\n", i), 1;
        }
    }
    for (threads = 1; threads <= MOST; threads *= 2) {
        memset(hashes, 0, sizeof hashes);
        on_threads(threads, call_some);
        if (threads == 1) {
            memcpy(expected, hashes, sizeof expected);
        } else if (memcmp(expected, hashes, sizeof expected) != 0) {
            return printf("other results with %d threads\n", threads), 1;
        }
    }
    return 0;
}
