/* measure.h: measurements, their errors and times. */
#ifndef MEASURE_H
#define MEASURE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Does the work once; the result depends on all of it, so that none is optimised away. */
typedef double work(void *context);

/* One method at one task. Unset numbers are -1 and empty in the CSV file. */
typedef struct entry {
    const char *task, *method;
    double shape, amplitude;     /* a/b, and displacement over that of gross slip */
    int harmonics, samples, jacobian;
    double parameter;            /* nodes, sliders, contacts */
    double error;                /* relative, against the multi-precision reference; harmonic force: against exact integrals */
    double sample_error;         /* harmonic force: against the reference with the same samples */
    double median, low, high;    /* time of one item [ns]: 50, 10 and 90 % of the rounds */
    work *run;
    void *context;
    double items;                /* points, steps, calls, contacts in one run */
} entry;

extern entry *entries;
extern size_t entry_count;

entry *entry_add(const char *task, const char *method, work *run, void *context, double items);
entry *entry_add_logarithm(const char *task); /* one logarithm, the unit of other times */
void entries_write(FILE *file);

/* Error of the first harmonic of some components of a force, relative to it; each has so many coefficients. */
double first_harmonic_error(const double *force, const double *exact, int components, int coefficients);

/* Times all entries from `first` on, interleaved, sets their shape and amplitude, and frees memory down to the mark. */
void measure(size_t first, double shape, double amplitude, size_t mark);
extern int rounds; /* per entry; the slowest have fewer; 0: nothing is timed */

/* Zeroed memory, aligned for vectors, until it is freed down to a mark. */
void *allocate(size_t bytes);
double *doubles(size_t n);
size_t memory_mark(void);
void free_to(size_t mark);

/* Counts a check that a value is below a bound, and prints it if not. */
void check_below(const char *what, double value, double bound);
extern int checks_passed, checks_failed;

double median_of(double *values, size_t n); /* sorts them */
void require(int32_t status);               /* MSLIP_OK, or prints the message and exits */

#endif
