/* reference.h: what is true, in quadruple precision, by other means than the competitors'. Results are rounded to double. */
#ifndef REFERENCE_H
#define REFERENCE_H

#include <microslip.h>

typedef struct reference reference;

reference *reference_of(const mslip_parameters *p); /* to be freed */

double reference_slip_displacement(const reference *r);
void reference_curve(const reference *r, double displacement, double *force, double *stiffness);
double reference_displacement(const reference *r, double force);

/* K', K'', dK'/d(amplitude), dK''/d(amplitude) at an amplitude > 0. */
void reference_stiffness(const reference *r, double amplitude, double result[4]);

/* Forces after each of n displacements, from the virgin state. */
void reference_path(const reference *r, int n, const double *displacement, double *force);

/* Harmonics of the force in steady state: the limit of infinitely many samples, and the sums over some samples. */
void reference_harmonics(const reference *r, int harmonics, const double *displacement, double *force);
void reference_samples(const reference *r, int harmonics, int samples, const double *displacement, double *force);

#endif
