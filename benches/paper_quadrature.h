/* paper_quadrature.h: the law as the paper computes it, Eq. 10 by numerical quadrature of the tractions. */
#ifndef PAPER_QUADRATURE_H
#define PAPER_QUADRATURE_H

#include "law.h"

typedef struct paper {
    law law;
    int nodes;                /* of one Gauss-Legendre rule over the half-width; 0: adaptive */
    double tolerance;         /* of the adaptive rule */
    double slip_displacement; /* as this quadrature sees it */
} paper;

paper paper_of(const law *law, int nodes, double tolerance);

/* Displacement at a stick zone, Eq. 10. */
double paper_displacement(const void *paper, double w);
double paper_stick(const paper *paper, double displacement);
void paper_curve(const void *paper, size_t n, const double *displacement, double *force, double *stiffness);

/* Nodes and weights of Gauss-Legendre on (0, 1), kept for later calls. */
void gauss_legendre(int n, const double **nodes, const double **weights);

#endif
