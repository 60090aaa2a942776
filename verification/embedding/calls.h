/* calls.h: an application that calls the interface, on contacts and elements of every kind. C99 and C++11. */
#ifndef CALLS_H
#define CALLS_H

#include <microslip.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { CONTACTS = 32 };

/* The bits of all results with all contacts and elements, and with some others, whose parameters are over many decades. Arrays have exact
   lengths on the heap. */
uint64_t hash_of_all(int others);

#ifdef __cplusplus
}
#endif

#endif
