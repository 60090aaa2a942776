/* use.h: a host that calls every function of the interface, on contacts of every kind. C99 and C++11. */
#ifndef USE_H
#define USE_H

#include <microslip.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { CONTACTS = 32, RULES = 2 };

/* What one visit needs, and the hash of every bit that came back. Contacts are only read and may be shared; each thread has
   workspaces of its own, made by `workspace`, which the host frees. */
struct visit {
    const mslip_contact *contact;
    double *workspace[RULES];
    uint64_t hash;
};

/* One call of each function, with outputs in memory on the heap that is just as long as said, and the kilobytes of stack that
   it takes at most: 16, or what the header says. */
struct call {
    const char *name;
    void (*make)(struct visit *visit);
    size_t kilobytes;
};
extern const struct call calls[];
extern const size_t number_of_calls;

void initialise(int which, mslip_contact *contact);
double *workspace(int32_t rule);

/* The hash of all calls on one contact, and of those on all contacts. */
uint64_t visit_one(const mslip_contact *contact, double *const workspaces[RULES]);
uint64_t visit_all(void);

/* The hash of more bytes. */
uint64_t hashed(uint64_t hash, const void *bytes, size_t n);

#ifdef __cplusplus
}
#endif

#endif
