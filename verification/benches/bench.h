/* bench.h: what microslip is compared with, the contacts and motions, the measurements, and their report. */
#ifndef BENCH_H
#define BENCH_H

#include <microslip.h>
#include <stdio.h>

#define PI 3.14159265358979323846

/* Parallel sliders. */
typedef struct sliders {
    size_t n;
    double *stiffness, *slip; /* slip: slip force of each, or its coefficient of friction under a varying load */
} sliders;

sliders sliders_of(size_t n, const double *stiffness, const double *slip);
/* One: with K' and K'' of the contact at that amplitude, or for 0 and where none has them with its initial stiffness and slip force. */
sliders sliders_fitted(const mslip_contact *contact, size_t n, double amplitude);

/* One slider. */
static inline double jenkins_step(double stiffness, double slip, double *force, double du, double *tangent)
{
    const double trial = *force + stiffness * du;
    const double limited = trial > slip ? slip : trial < -slip ? -slip : trial;
    *tangent = trial == limited ? stiffness : 0.0;
    return *force = limited;
}

/* Alternating frequency/time: tables and buffers of sliders in one or two tangential directions. Normal stiffness 0: a constant
   load; otherwise the load is max(0, normal_stiffness w). */
typedef struct aft aft;
aft *aft_of(int directions, double normal_stiffness, int harmonics, int samples, const sliders *s);

/* Coefficients [mean, cos 1, sin 1, ...] of each displacement (u, v, w) and force; jacobian of as many rows and columns,
   column-major. */
void sliders_harmonic(aft *a, const double *displacement, double *force, double *jacobian);

/* Does the work once; the result depends on all of it, so that none is optimised away. */
typedef double work(void *context);

/* One method at one call of a task. */
typedef struct entry {
    const char *task, *method;
    double shape, amplitude;          /* a/b, and displacement over that of gross slip */
    int harmonics, samples;
    double error;                     /* of the first harmonic, relative, against far more samples; or -1 */
    double time;                      /* median over the rounds of one item [ns] */
    work *run;
    void *context;
    double items;                     /* points, steps, contacts in one run */
} entry;

extern entry entries[];
extern size_t entry_count;
extern int rounds; /* per entry; the slowest have fewer */

/* Adds an entry and runs it once. The entry keeps its own copy of the context, of the given number of bytes. */
entry *entry_add(entry e, const void *context, size_t bytes);
void measure(size_t first); /* times all entries from `first` on, interleaved */

/* Zeroed memory, aligned for vectors, until it is freed down to a mark. */
void *allocate(size_t bytes);
double *doubles(size_t n);
size_t memory_mark(void);
void free_to(size_t mark);

double median_of(double *values, size_t n); /* sorts them */
void require(int32_t status);               /* MSLIP_OK, or prints the message and exits */

/* The cases of a run: full, or quick. */
typedef struct extent {
    int shapes, amplitudes;
    const double *shape, *amplitude; /* a/b; displacement over that of gross slip */
    int least_samples, most_samples; /* powers of 2 */
    int most_sliders;                /* powers of 4 */
} extent;

/* A steel contact of half-width 0.5 mm under 800 N, and what competitors derive from it. */
enum { BANKS = 7 };
typedef struct test_case {
    double shape; /* a/b */
    mslip_parameters parameters;
    mslip_contact contact;
    sliders bank[BANKS]; /* 1, 4, 16, ... sliders, fitted by the library */
} test_case;
test_case case_of(double shape);

/* Adds the entries of one amplitude or number of harmonics, whose number is k. */
typedef void set_up(const test_case *c, const extent *x, int k);
set_up set_up_initialisation, set_up_harmonic, set_up_step, set_up_element, set_up_face, set_up_plane;

void write_tables(FILE *file);
void write_entries(FILE *file);

#endif
