/* calls.h: an application that calls the interface, on contacts and elements of every kind. C99 and C++11. */
#ifndef CALLS_H
#define CALLS_H

#include <microslip.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { CONTACTS = 32 };

/* Initialises one of the contacts and its element; from CONTACTS on with parameters over many decades, of which some are rejected: whether
   these are accepted. */
int initialise(int which, mslip_contact *contact, mslip_element *element);

/* The bits of all results with one contact and element, which threads may share, and with all of them and some
   others. Arrays have exact lengths on the
   heap. */
uint64_t hash_of_one(const mslip_contact *contact, const mslip_element *element);
uint64_t hash_of_all(int others);

#ifdef __cplusplus
}
#endif

#endif
