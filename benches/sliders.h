/* sliders.h: spring-sliders (Jenkins elements), one or many in parallel (Iwan), implemented as fast as we can.
 *
 * An element with a normal degree of freedom would add its functions here, and a file task_*.c that times them. */
#ifndef SLIDERS_H
#define SLIDERS_H

#include "../c_tests/outputs.h"

/* Parallel sliders; the arrays are padded to whole lanes with sliders without stiffness. */
enum { LANES = 8 };
typedef struct sliders {
    size_t n, padded;
    double *stiffness, *slip; /* slip: slip force of each */
} sliders;

sliders sliders_of(size_t n, const double *stiffness, const double *slip);
sliders sliders_fitted(const mslip_contact *contact, size_t n); /* one: initial stiffness and slip force */
sliders jenkins_fitted(const mslip_contact *contact, double amplitude); /* with K' and K'' of the contact */

/* Force and stiffness on the initial loading curve. */
void sliders_curve(const void *sliders, size_t n, const double *displacement, double *force, double *stiffness);
/* K', K'' and their derivatives with respect to the amplitude, in closed form for each slider. */
void sliders_stiffness(const void *sliders, double amplitude, double result[4]);
/* One time step, which updates the forces of the sliders. */
double sliders_step(const sliders *s, double *forces, double du, double *stiffness);

/* One element. */
static inline double jenkins_step(double stiffness, double slip, double *force, double du, double *tangent)
{
    const double trial = *force + stiffness * du;
    const double limited = trial > slip ? slip : trial < -slip ? -slip : trial;
    *tangent = trial == limited ? stiffness : 0.0;
    return *force = limited;
}

/* Alternating frequency/time: Fourier tables and buffers for one number of harmonics and samples. */
typedef struct aft aft;
aft *aft_of(int harmonics, int samples);

/* Coefficients [mean, cos 1, sin 1, ...] of displacement and force; jacobian (2H+1) x (2H+1), column-major, or NULL. */
typedef void aft_method(aft *a, const sliders *s, const double *displacement, double *force, double *jacobian);
aft_method jenkins_aft;            /* one slider, sample by sample */
aft_method sliders_aft; /* any number; only reversals are stepped */

#endif
