/* all_calls.h: an application that calls every function of the interface, on contacts of every kind. C99 and C++11. */
#ifndef ALL_CALLS_H
#define ALL_CALLS_H

#include <microslip.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { CONTACTS = 32, RULES = 2, MOST_ARRAYS = 16 };

/* A sequence of calls with a contact, which may be shared by threads, and workspaces of its own. Arrays have exact lengths on the
   heap; after each call all are added to the hash, bit by bit, and freed. */
struct sequence {
    const mslip_contact *contact;
    double *workspace[RULES];
    uint64_t hash;
    double *array[MOST_ARRAYS];
    size_t length[MOST_ARRAYS];
    size_t arrays;
};

struct call {
    const char *name;
    void (*make)(struct sequence *);
};
extern const struct call calls[];
extern const size_t number_of_calls;

void initialise(int which, mslip_contact *contact);
void begin_sequence(struct sequence *sequence);
void end_sequence(struct sequence *sequence);
void make_call(struct sequence *sequence, size_t call);

/* The hash of all calls with one contact, and with all contacts. */
uint64_t hash_of_contact(struct sequence *sequence, const mslip_contact *contact);
uint64_t hash_of_all(void);

#ifdef __cplusplus
}
#endif

#endif
