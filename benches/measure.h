/* measure.h: what is measured, how, and where it is kept. */
#ifndef MEASURE_H
#define MEASURE_H

#include <stddef.h>
#include <stdio.h>

/* Does the work once; the number it returns depends on all of it. */
typedef double work(void *context);

/* One method at one task. A group of them is measured together, one after the other in every round. */
typedef struct entry {
    const char *task, *method;
    double shape, amplitude; /* a/b, and displacement over that of gross slip; -1 where there is none */
    int harmonics, samples, jacobian;
    double parameter;        /* nodes, tolerance, sliders, contacts; 0 where there is none */
    double error;            /* relative, against the truth; -1 where none applies */
    double sample_error;     /* harmonic force: against the truth for the same samples */
    work *run;
    void *context;
    double items;            /* points, steps, calls, contacts in one run */
    int is_yardstick;        /* the spring-slider of its group */
    double median, low, high; /* of one item [ns]: 50, 10 and 90 % of the rounds */
    double per_log;          /* over one logarithm */
    double per_jenkins;      /* over the yardstick; -1 without one */
} entry;

extern entry *entries;
extern size_t entry_count;

/* Appends an entry that is all unset but for its names. */
entry *entry_add(const char *task, const char *method, work *run, void *context, double items);

/* Memory of a context, and what else a group needs: released when it has been measured. */
void *context_of(size_t bytes);
void release_later(void *thing, void (*release)(void *));

/* Measures all entries from `first` on, interleaved with logarithms, and frees their contexts. */
void measure(size_t first);

extern int rounds;          /* of every measurement; the slowest have fewer */
extern double log_median;   /* of one logarithm, in the last group */
double log_overall(void);   /* median of all groups */

/* As the CSV has it. */
void entries_write(FILE *file);

/* Results go here, so that none is optimised away. */
extern volatile double sink;

double seconds(void);
double median_of(double *values, size_t n); /* sorts them */
double quantile_of(const double *sorted, size_t n, double q);

#endif
