/* tasks.h: what is asked of the laws. Each adds its entries and measures them. */
#ifndef TASKS_H
#define TASKS_H

#include "cases.h"

/* How much of everything. */
typedef struct extent {
    const char *name;
    int shapes, amplitudes, orders; /* the first so many, of those listed below */
    const double *shape, *amplitude;
    const int *order;
    int least_samples, most_samples; /* powers of two */
    int most_sliders;                /* powers of four, from 4 */
    int most_nodes;                  /* powers of two, from 8 */
    size_t most_contacts;            /* powers of ten, and three times as many */
} extent;

void task_force(const subject *s, const extent *x);
void task_stiffness(const subject *s, const extent *x);
void task_harmonic(const subject *s, const extent *x, int harmonics);
void task_march(const subject *s, const extent *x);
void task_prepare(const subject *s);
void task_many(const subject *s, const extent *x);

/* A bank that is released with its group. */
const sliders *kept(sliders s);

#endif
