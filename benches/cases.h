/* cases.h: the contacts, the motions and the exact values. */
#ifndef CASES_H
#define CASES_H

#include "measure.h"
#include "paper_quadrature.h"
#include "sliders.h"

/* The cases of a run: full, or quick. */
typedef struct extent {
    int shapes, amplitudes, orders;
    const double *shape, *amplitude; /* a/b; displacement over that of gross slip */
    const int *order;                /* harmonics */
    int least_samples, most_samples; /* powers of 2 */
    int most_sliders;                /* powers of 4 */
    int most_contacts;               /* powers of 10 */
} extent;

/* A steel contact of half-width 0.5 mm under 800 N, and what competitors derive from it. */
enum { BANKS = 7, RULES = 6 };
typedef struct test_case {
    double shape; /* a/b */
    mslip_parameters parameters;
    mslip_contact contact;
    sliders bank[BANKS]; /* 1, 4, 16, ... sliders, fitted by the library */
    paper paper[RULES];  /* 4 to 32 nodes */
} test_case;

test_case case_of(double shape);

/* A task adds entries for all amplitudes of a contact and measures them. A new one is a file and a line in main.c. */
typedef void task(const test_case *c, const extent *x);
task task_force, task_stiffness, task_harmonic, task_time_step, task_batch, task_element, task_two_directions;

/* Name of a motion of task_element or task_two_directions, or NULL. */
const char *element_motion(int motion);
const char *two_directions_motion(int motion);

/* Coefficients [mean, cos 1, sin 1, ...] of a motion with half range `size`, whose maximum lies a third of a step from a
   sample for every power of two. */
void motion_of(int harmonics, double size, double *coefficients);

/* Values of the multi-precision reference; NaN while `truth_rows` only lists its input. */
void truth(const mslip_parameters *p, const char *task, int n, const double *arguments, int values, double *value);
extern FILE *truth_rows, *truth_values; /* its input and, unless NULL, its output */

#endif
