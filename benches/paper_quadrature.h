/* paper_quadrature.h: the law as Allara (2009) computes it: Eq. 10 by quadrature of the tractions, inverted by root finding. */
#ifndef PAPER_QUADRATURE_H
#define PAPER_QUADRATURE_H

#include "../c_tests/outputs.h"

#define PI 3.14159265358979323846

/* A contact of two bodies of the same material. Stick zones are measured by w = sqrt(c^2 - a^2), c their half-width. */
typedef struct paper {
    double flat, half_width, w;    /* a, b, and w of the whole contact */
    double load, modulus, length, friction, poisson; /* P = N/L, E*, L, mu, nu/(1 - nu) */
    double slip_force, slip_displacement;
    int nodes;                     /* of the quadrature: 2 nodes + 1 on each smooth part of the tractions */
} paper;

paper paper_of(const mslip_parameters *p, int nodes);

/* Force and tangent stiffness on the initial loading curve at n displacements >= 0. */
void paper_curve(const void *paper, size_t n, const double *displacement, double *force, double *stiffness);

/* Section 3.4: K', K'' and their derivatives with respect to the amplitude. */
void paper_stiffness(const void *paper, double amplitude, double result[4]);

#endif
