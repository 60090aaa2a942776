/* sliders.h: spring-sliders (Jenkins elements), one or a bank in parallel (Iwan), as solvers use them today. */
#ifndef SLIDERS_H
#define SLIDERS_H

#include <stddef.h>

/* In 8 lanes: the arrays are padded with sliders of no stiffness. */
enum { LANES = 8 };

typedef struct sliders {
    size_t n, padded;
    double *stiffness, *slip; /* slip force of each */
} sliders;

sliders sliders_of(size_t n, const double *stiffness, const double *slip);
void sliders_free(sliders *s);

/* Force and stiffness on the virgin curve. */
void sliders_curve(const void *sliders, size_t n, const double *displacement, double *force, double *stiffness);
/* K', K'', and their derivatives by the amplitude, in closed form for each slider. */
void sliders_stiffness(const sliders *s, double amplitude, double result[4]);

/* One time step: forces of the sliders in, and out. Where `stiffness` is NULL it is not computed. */
double sliders_step(const sliders *s, double *forces, double du, double *stiffness);

/* One element, for time marching. */
static inline double jenkins_step(double stiffness, double slip, double *force, double du, double *tangent)
{
    const double trial = *force + stiffness * du;
    const double limited = trial > slip ? slip : trial < -slip ? -slip : trial;
    *tangent = trial == limited ? stiffness : 0.0;
    return *force = limited;
}

/* Alternating frequency/time: tables of one number of harmonics and samples, and scratch memory. */
typedef struct aft aft;
aft *aft_of(int harmonics, int samples, size_t sliders);
void aft_free(aft *a);

/* Displacements of two periods, 2 x samples of them, and the harmonics of the forces of one. */
const double *aft_displacements(aft *a, const double *coefficients);
void aft_transform(const aft *a, const double *forces, double *force);

/* Coefficients [c0, cos1, sin1, ...]; jacobian (2H+1) x (2H+1), column-major, or NULL. All of these give the same. */
void jenkins_stepped(aft *a, const sliders *one, const double *displacement, double *force, double *jacobian);
void sliders_stepped(aft *a, const sliders *s, const double *displacement, double *force, double *jacobian);
void sliders_by_reversals(aft *a, const sliders *s, const double *displacement, double *force, double *jacobian);

#endif
