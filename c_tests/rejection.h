/* refusal.h: bad input, one at a time. Everything that a call is given lies before a page that must not be touched, and all of it
   is compared with what it was. */
#ifndef REFUSAL_H
#define REFUSAL_H

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

/* Quiet and signalling, of either sign, and infinities: moved about, never computed with. */
enum { NOT_NUMBERS = 6 };
static const uint64_t not_numbers[NOT_NUMBERS] = {
    0x7ff8000000000000, 0xfff8000000000000, 0x7ff0000000000001, 0xfff4000000000000, 0x7ff0000000000000, 0xfff0000000000000,
};

/* Every status that there is, what its sentence names, what it says is allowed, and which driver has rows for it. */
enum { PARAMETERS, ARGUMENTS };
typedef struct {
    int32_t code;
    const char *names, *allows;
    int driver;
} refusal;

static const refusal refusals[] = {
    { MSLIP_NULL_POINTER, "pointer is NULL", "must be given", ARGUMENTS },
    { MSLIP_BAD_FLAT_HALF_WIDTH, "flat_half_width", "finite number >= 0", PARAMETERS },
    { MSLIP_BAD_EDGE_RADIUS, "edge_radius", "finite number > 0", PARAMETERS },
    { MSLIP_BAD_LENGTH, "length", "finite number > 0", PARAMETERS },
    { MSLIP_BAD_NORMAL_FORCE, "normal_force", "finite number >= 0", PARAMETERS },
    { MSLIP_BAD_FRICTION_COEFFICIENT, "friction_coefficient", "finite number >= 0", PARAMETERS },
    { MSLIP_BAD_YOUNG_MODULUS, "young_modulus", "finite number > 0", PARAMETERS },
    { MSLIP_BAD_POISSON_RATIO, "poisson_ratio", "0 <= nu <= 0.5", PARAMETERS },
    { MSLIP_BAD_DISPLACEMENT_REFERENCE, "displacement_reference", "MSLIP_CENTRE_POINT (0) or MSLIP_RIGID_STRIP (1)", PARAMETERS },
    { MSLIP_BAD_SEMI_AXIS_X, "semi_axis_x", "finite number > 0", PARAMETERS },
    { MSLIP_BAD_SEMI_AXIS_Y, "semi_axis_y", "finite number > 0", PARAMETERS },
    { MSLIP_LENGTH_TOO_SHORT, "length is too short", "2 length > b", PARAMETERS },
    { MSLIP_OUT_OF_RANGE, "together", "1e-150 to 1e150", PARAMETERS },
    { MSLIP_BAD_CONTACT, "contact", "mslip_contact_init", ARGUMENTS },
    { MSLIP_BAD_STATE, "state", "mslip_state_init", ARGUMENTS },
    { MSLIP_BAD_WORKSPACE, "workspace", "mslip_harmonic_workspace_init", ARGUMENTS },
    { MSLIP_STATE_TOO_SHORT, "state_length", "mslip_state_length", ARGUMENTS },
    { MSLIP_STATE_FULL, "reversal", "mslip_state_length", ARGUMENTS },
    { MSLIP_WORKSPACE_TOO_SHORT, "workspace_length", "mslip_harmonic_workspace_length", ARGUMENTS },
    { MSLIP_BAD_FORCE, "force", "finite number", ARGUMENTS },
    { MSLIP_FORCE_EXCEEDS_SLIP, "|force|", "slip_force", ARGUMENTS },
    { MSLIP_BAD_DISPLACEMENT, "displacement", "1e150", ARGUMENTS },
    { MSLIP_BAD_POSITION, "position x", "finite number", ARGUMENTS },
    { MSLIP_BAD_AMPLITUDE, "amplitude", "finite number >= 0, at most 1e150", ARGUMENTS },
    { MSLIP_BAD_FORCE_AMPLITUDE, "force_amplitude", "finite number >= 0", ARGUMENTS },
    { MSLIP_BAD_HARMONICS, "number of harmonics", "1 to 16777216", ARGUMENTS },
    { MSLIP_BAD_SAMPLES, "number of samples", "16777216", ARGUMENTS },
    { MSLIP_BAD_COUNT, "number of sliders", "1 to 65536", ARGUMENTS },
    { MSLIP_BAD_RULE, "rule", "MSLIP_EQUIDISTANT (0) or MSLIP_BETWEEN_REVERSALS (1)", ARGUMENTS },
    { MSLIP_NOT_AVAILABLE, "slip", "elliptical contact", ARGUMENTS },
    { MSLIP_BAD_ARRAY_SIZE, "array", "longer than memory", ARGUMENTS },
    { MSLIP_BAD_ALIGNMENT, "pointer", "multiple of", ARGUMENTS },
};
enum { REFUSALS = sizeof refusals / sizeof *refusals };

/* Codes that calls were refused with. */
static unsigned char seen[128];

static inline void check_every_code_was_seen(int driver)
{
    for (int i = 0; i < REFUSALS; ++i) {
        if (refusals[i].driver == driver && !check_that(seen[refusals[i].code], __FILE__, __LINE__, "every code has a row")) {
            printf("    none was refused with %d: %s\n", (int)refusals[i].code, mslip_status_text(refusals[i].code));
        }
    }
}

/* A piece of memory whose end is that of a page, with a page behind it that is not to be touched. */
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
        fputs("no memory\n", stderr);
        exit(2);
    }
    memset(r->start, 0x5a, r->bytes);
    return r;
}

/* The last so many bytes of a region. */
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

/* An operation that a host may trap was raised: tested after every call, whether or not it is trapped here. */
static inline int raised(void)
{
    int flags = fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
    feclearexcept(FE_ALL_EXCEPT);
    return flags;
}

/* One row: the call was refused with this status, and left everything as it was. */
static inline int check_refused(int32_t status, int32_t wanted, const char *function, const char *what)
{
    int flags = raised(), untouched_ = nothing_changed();
    int holds = check_that(status == wanted && flags == 0 && untouched_, __FILE__, __LINE__, "refused, and nothing written");
    if (!holds) {
        printf("    %s, %s: status %d, not %d; flags %x; %s\n", function, what, (int)status, (int)wanted, flags,
               untouched_ ? "untouched" : "memory was changed");
        restore_regions();
    }
    if (status >= 0 && status < (int32_t)sizeof seen) {
        seen[status] = 1;
    }
    return holds;
}

#endif
