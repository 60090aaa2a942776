/* rejection.h: invalid inputs, one at a time. All memory of a call ends at a protected page and is compared with a copy from before
   the call. */
#ifndef REJECTION_H
#define REJECTION_H

#include "fixture.h"

#include <stdint.h>
#include <stdlib.h>
#ifdef __unix__
#include <sys/mman.h>
#include <unistd.h>
#endif

static inline double from_bits(uint64_t bits)
{
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* NaN, quiet and signalling, of either sign, and infinities, as bits: an assignment of a double could trap. */
enum { NON_FINITE = 6 };
static const uint64_t non_finite[NON_FINITE] = {
    0x7ff8000000000000, 0xfff8000000000000, 0x7ff0000000000001, 0xfff4000000000000, 0x7ff0000000000000, 0xfff0000000000000,
};

/* Every status: an excerpt of its message, and the driver that tests it. */
enum { PARAMETERS, ARGUMENTS };
typedef struct {
    int32_t code;
    const char *excerpt;
    int driver;
} rejection;

static const rejection rejections[] = {
    { MSLIP_NULL_POINTER, "required pointer is NULL", ARGUMENTS },
    { MSLIP_BAD_FLAT_HALF_WIDTH, "flat_half_width must be finite and >= 0", PARAMETERS },
    { MSLIP_BAD_EDGE_RADIUS, "edge_radius must be finite and > 0", PARAMETERS },
    { MSLIP_BAD_LENGTH, "length must be finite and > 0", PARAMETERS },
    { MSLIP_BAD_NORMAL_FORCE, "normal_force must be finite and >= 0", PARAMETERS },
    { MSLIP_BAD_FRICTION_COEFFICIENT, "friction_coefficient must be finite and >= 0", PARAMETERS },
    { MSLIP_BAD_YOUNG_MODULUS, "young_modulus must be finite and > 0", PARAMETERS },
    { MSLIP_BAD_POISSON_RATIO, "poisson_ratio must be between 0 and 0.5", PARAMETERS },
    { MSLIP_BAD_DISPLACEMENT_REFERENCE, "displacement_reference must be MSLIP_CENTRE_POINT or MSLIP_RIGID_STRIP", PARAMETERS },
    { MSLIP_BAD_SEMI_AXIS_X, "semi_axis_x must be finite and > 0", PARAMETERS },
    { MSLIP_BAD_SEMI_AXIS_Y, "semi_axis_y must be finite and > 0", PARAMETERS },
    { MSLIP_LENGTH_TOO_SHORT, "requires 2*length > b", PARAMETERS },
    { MSLIP_OUT_OF_RANGE, "1e-150 .. 1e150", PARAMETERS },
    { MSLIP_BAD_CONTACT, "invalid contact", ARGUMENTS },
    { MSLIP_BAD_STATE, "invalid state", ARGUMENTS },
    { MSLIP_BAD_WORKSPACE, "invalid workspace", ARGUMENTS },
    { MSLIP_STATE_TOO_SHORT, "at least mslip_state_length(0)", ARGUMENTS },
    { MSLIP_WORKSPACE_TOO_SHORT, "at least the value of mslip_harmonic_workspace_length", ARGUMENTS },
    { MSLIP_BAD_FORCE, "a force must be finite", ARGUMENTS },
    { MSLIP_FORCE_EXCEEDS_SLIP, "must not exceed mu N", ARGUMENTS },
    { MSLIP_BAD_DISPLACEMENT, "a displacement must be finite and at most 1e150", ARGUMENTS },
    { MSLIP_BAD_POSITION, "a position x must be finite", ARGUMENTS },
    { MSLIP_BAD_AMPLITUDE, "a displacement amplitude must be between 0 and 1e150", ARGUMENTS },
    { MSLIP_BAD_FORCE_AMPLITUDE, "a force amplitude must be finite and >= 0", ARGUMENTS },
    { MSLIP_BAD_HARMONICS, "the number of harmonics must be between 1 and 2^24", ARGUMENTS },
    { MSLIP_BAD_SAMPLES, "the number of samples must exceed twice the number of harmonics", ARGUMENTS },
    { MSLIP_BAD_COUNT, "the number of sliders must be between 1 and 65536", ARGUMENTS },
    { MSLIP_BAD_RULE, "rule must be MSLIP_UNIFORM_SAMPLING or MSLIP_EVENT_DRIVEN", ARGUMENTS },
    { MSLIP_NOT_AVAILABLE, "not available for this kind of contact", ARGUMENTS },
    { MSLIP_BAD_INDEX, "an index must refer to one of the n_contacts contacts", ARGUMENTS },
    { MSLIP_BAD_ARRAY_SIZE, "too long to be addressed", ARGUMENTS },
    { MSLIP_BAD_ALIGNMENT, "misaligned pointer", ARGUMENTS },
};
enum { REJECTIONS = sizeof rejections / sizeof *rejections };

/* Codes of the rejections so far. */
static unsigned char seen[128];

static inline void check_every_code_was_seen(int driver)
{
    for (int i = 0; i < REJECTIONS; ++i) {
        if (rejections[i].driver == driver && !check_that(seen[rejections[i].code], __FILE__, __LINE__, "every code was returned")) {
            printf("    never returned: %d: %s\n", (int)rejections[i].code, mslip_status_text(rejections[i].code));
        }
    }
}

/* A buffer that ends at a protected page. */
enum { REGIONS = 12 };
typedef struct {
    unsigned char *start, *before;
    size_t bytes;
} region;
static region regions[REGIONS];
static int regions_made;

static inline region *make_region(size_t bytes)
{
    region *r = &regions[regions_made++];
#ifdef __unix__
    size_t page = (size_t)sysconf(_SC_PAGESIZE);
    r->bytes = (bytes + page - 1) / page * page;
    r->start = mmap(NULL, r->bytes + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (r->start == MAP_FAILED || mprotect(r->start + r->bytes, page, PROT_NONE) != 0) {
        perror("mmap");
        exit(2);
    }
#else
    r->bytes = bytes;
    r->start = malloc(bytes);
#endif
    r->before = malloc(r->bytes);
    if (regions_made > REGIONS || r->start == NULL || r->before == NULL) {
        fputs("out of memory\n", stderr);
        exit(2);
    }
    memset(r->start, 0x5a, r->bytes);
    return r;
}

/* The last bytes of a region. */
static inline void *last(const region *r, size_t bytes)
{
    return r->start + r->bytes - bytes;
}

static inline void remember_regions(void)
{
    for (int i = 0; i < regions_made; ++i) {
        memcpy(regions[i].before, regions[i].start, regions[i].bytes);
    }
}

static inline void restore_regions(void)
{
    for (int i = 0; i < regions_made; ++i) {
        memcpy(regions[i].start, regions[i].before, regions[i].bytes);
    }
}

static inline int region_is_unchanged(const region *r)
{
    return memcmp(r->start, r->before, r->bytes) == 0;
}

/* No bit of any region changed. */
static inline int nothing_changed(void)
{
    for (int i = 0; i < regions_made; ++i) {
        if (!region_is_unchanged(&regions[i])) {
            return 0;
        }
    }
    return 1;
}

/* Floating-point exceptions that an application may trap; cleared. */
static inline int raised(void)
{
    int flags = fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
    feclearexcept(FE_ALL_EXCEPT);
    return flags;
}

/* The call was rejected with this status and modified nothing. */
static inline int check_rejected(int32_t status, int32_t expected, const char *function, const char *what)
{
    int flags = raised(), untouched_ = nothing_changed();
    int holds = check_that(status == expected && flags == 0 && untouched_, __FILE__, __LINE__, "rejected, and nothing modified");
    if (!holds) {
        printf("    %s, %s: status %d, not %d; flags %x; %s\n", function, what, (int)status, (int)expected, flags,
               untouched_ ? "memory unmodified" : "memory was modified");
        restore_regions();
    }
    if (status >= 0 && status < (int32_t)sizeof seen) {
        seen[status] = 1;
    }
    return holds;
}

#endif
