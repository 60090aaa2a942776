/* fixture.h: contacts, and outputs filled with a pattern that shows what a call wrote. */
#ifndef FIXTURE_H
#define FIXTURE_H

#include "check.h"

#include <microslip.h>
#include <float.h>
#include <stddef.h>

/* Contact 3 of the table of contacts: a flat with rounded edges. */
static inline mslip_parameters flat_parameters(void)
{
    mslip_parameters p;
    mslip_parameters_default(&p);
    p.flat_half_width = 3e-4;
    p.edge_radius = 2e-3;
    p.length = 1.97e-2;
    p.normal_force = 178.24;
    p.friction_coefficient = 0.417;
    p.material[0].young_modulus = p.material[1].young_modulus = 2e11;
    p.material[0].poisson_ratio = p.material[1].poisson_ratio = 0.29;
    return p;
}

/* Case 1 of the table of elliptical contacts. */
static inline mslip_elliptic_parameters elliptic_parameters(void)
{
    mslip_elliptic_parameters p;
    mslip_elliptic_parameters_default(&p);
    p.semi_axis_x = 8.469711632573419636885181e-4;
    p.semi_axis_y = 1.556904140680311380770529e-3;
    p.normal_force = 46.68443584875135599077112;
    p.friction_coefficient = 0.8978145269586224053171009;
    p.material[0].young_modulus = p.material[1].young_modulus = 2.1e11;
    p.material[0].poisson_ratio = p.material[1].poisson_ratio = 0.45;
    return p;
}

static inline mslip_contact flat_contact(void)
{
    mslip_parameters p = flat_parameters();
    mslip_contact contact;
    CHECK(mslip_contact_init(&p, &contact) == MSLIP_OK);
    return contact;
}

static inline mslip_contact cylinder_contact(void)
{
    mslip_parameters p = flat_parameters();
    mslip_contact contact;
    p.flat_half_width = 0.0;
    CHECK(mslip_contact_init(&p, &contact) == MSLIP_OK);
    return contact;
}

static inline mslip_contact open_contact(void)
{
    mslip_parameters p = flat_parameters();
    mslip_contact contact;
    p.normal_force = 0.0;
    CHECK(mslip_contact_init(&p, &contact) == MSLIP_OK);
    return contact;
}

static inline mslip_contact elliptic_contact(void)
{
    mslip_elliptic_parameters p = elliptic_parameters();
    mslip_contact contact;
    CHECK(mslip_contact_init_elliptic(&p, &contact) == MSLIP_OK);
    return contact;
}

/* Contacts that were never initialised. */
enum { UNINITIALISED = 2 };
static inline mslip_contact uninitialised_contact(int which)
{
    mslip_contact contact;
    memset(&contact, which == 0 ? 0 : 0xff, sizeof contact);
    return contact;
}

/* The outputs of a call, filled with a pattern before it. */
enum { OUTPUTS = 4, CAPACITY = 256 };
static double out[OUTPUTS][CAPACITY];
static double reference[OUTPUTS][CAPACITY];

static inline void poison(void)
{
    memset(out, 0x5a, sizeof out);
}

static inline int is_poison(const double *p, size_t n)
{
    const unsigned char *bytes = (const unsigned char *)p;
    for (size_t i = 0; i < n * sizeof *p; ++i) {
        if (bytes[i] != 0x5a) {
            return 0;
        }
    }
    return 1;
}

static inline int untouched(void)
{
    return is_poison(out[0], OUTPUTS * CAPACITY);
}

static inline int same_bits(const double *p, const double *q, size_t n)
{
    return memcmp(p, q, n * sizeof *p) == 0;
}

/* The call is rejected with this status and writes no output. */
#define REJECTED(call, status) \
    do { \
        int32_t status_; \
        poison(); \
        status_ = (call); \
        if (!check_that(status_ == (status), __FILE__, __LINE__, #call " returns " #status)) { \
            printf("    status %d: %s\n", (int)status_, mslip_status_text(status_)); \
        } \
        check_that(untouched(), __FILE__, __LINE__, #call " writes nothing"); \
    } while (0)

/* Every subset of the outputs gives what all outputs gave. Within the call, OUT(i) is output i or NULL; output i holds
   lengths[i] doubles. The outputs of the full call stay in `reference`. */
#define OUT(i) (subset_ >> (i) & 1 ? out[i] : NULL)
#define EVERY_SUBSET(outputs, lengths, call) \
    do { \
        for (int subset_ = (1 << (outputs)) - 1; subset_ >= 0; --subset_) { \
            poison(); \
            check_that((call) == MSLIP_OK, __FILE__, __LINE__, #call); \
            if (subset_ == (1 << (outputs)) - 1) { \
                memcpy(reference, out, sizeof out); \
            } \
            check_that(subset_holds(subset_, outputs, lengths), __FILE__, __LINE__, \
                       #call " gives the same with fewer outputs"); \
        } \
    } while (0)

static inline int subset_holds(int subset, int outputs, const size_t *lengths)
{
    for (int i = 0; i < OUTPUTS; ++i) {
        size_t written = i < outputs && (subset >> i & 1) ? lengths[i] : 0;
        if (!same_bits(out[i], reference[i], written) || !is_poison(out[i] + written, CAPACITY - written)) {
            return 0;
        }
    }
    return 1;
}

/* Values that every input rejects. */
static const double not_finite[3] = { NAN, INFINITY, -INFINITY };

#endif
