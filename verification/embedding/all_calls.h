/* all_calls.h: an application that calls every function of the interface, on contacts and elements of every kind. C99 and C++11. */
#ifndef ALL_CALLS_H
#define ALL_CALLS_H

#include "../../c_tests/outputs.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { CONTACTS = 32, RULES = 2, MOST_ARRAYS = 16 };

/* A sequence of calls with a contact and an element, which may be shared by threads, and workspaces of its own. Arrays have exact
   lengths on the heap; after each call all are added to the hash, bit by bit, and freed. */
struct sequence {
    const mslip_contact *contact;
    const mslip_element *element;
    double *workspace[RULES];
    double *element_workspace;
    uint64_t hash;
    double *array[MOST_ARRAYS];
    size_t length[MOST_ARRAYS];
    size_t arrays;
};

/* The element may be NULL. */
void initialise(int which, mslip_contact *contact, mslip_element *element);
void begin_sequence(struct sequence *sequence);
void end_sequence(struct sequence *sequence);
void make_call(struct sequence *sequence, size_t call);

/* The hash of all calls with one contact and element, and with all of them. */
uint64_t hash_of_one(struct sequence *sequence, const mslip_contact *contact, const mslip_element *element);
uint64_t hash_of_all(void);

#ifdef __cplusplus
}
#endif

#endif
