/* varying_slider.h: spring-slider under a varying normal force with separation (Yang & Menq 1998; Petrov & Ewins 2003), one
 * tangential direction, implemented as fast as we can. */
#ifndef VARYING_SLIDER_H
#define VARYING_SLIDER_H

typedef struct varying_slider {
    double stiffness, normal_stiffness, friction_coefficient;
} varying_slider;

/* Fourier tables and buffers for one number of harmonics and of samples. */
typedef struct varying_aft varying_aft;
varying_aft *varying_aft_of(int harmonics, int samples);

/* Coefficients [mean, cos 1, sin 1, ...] of the tangential displacement and then of the normal approach, and of both forces;
   jacobian of 2(2H+1) columns, or NULL. */
typedef void varying_aft_method(varying_aft *a, const varying_slider *s, const double *displacement, double *force, double *jacobian);
varying_aft_method varying_slider_stepped; /* the Jacobian as a sum of outer products over the samples */
varying_aft_method varying_slider_by_runs; /* runs of samples in the same state, by prefix sums */

/* One time step: forces [T, N] and tangent, 2 x 2, column-major. state: displacement and tangential force. */
void varying_slider_step(const varying_slider *s, double state[2], double displacement, double approach, double force[2], double tangent[4]);

#endif
