/* law.h: the constants of one contact, as every competitor needs them, computed once. */
#ifndef LAW_H
#define LAW_H

#include <microslip.h>

#define PI 3.14159265358979323846

typedef struct law {
    double flat;              /* a */
    double half_width;        /* b */
    double w;                 /* sqrt(b^2 - a^2): sizes are measured by w, in which all is smooth */
    double size_of_load;      /* g(w) = 4 R P/E* */
    double mean;              /* B(w), the integral of g dc/c */
    double length, radius, modulus, friction;
    double poisson;           /* nu/(1-nu) */
    double compliance;        /* ln(2L/b) + nu/(1-nu), in the unit of compliance */
    double load;              /* P = N/L */
    double displacement_unit; /* 2 mu P/(pi E*) */
    double slip_force, slip_displacement, initial_stiffness;
} law;

/* Like bodies only: that is all the benchmark uses. */
law law_of(const mslip_parameters *p);

/* The elementary formulas, as they stand: stick zone w to load, approach, tangent stiffness. */
double law_size_of_load(double flat, double w);
double law_force(const law *law, double w);
double law_displacement(const law *law, double w);
double law_stiffness(const law *law, double w);
/* d(displacement)/dw, which is not positive. */
double law_displacement_slope(const law *law, double w);

/* Stick zone at a displacement in (0, slip_displacement): Newton's method on `displacement`, whatever computes it; it is
   given the slope, which is elementary. Stops at steps below `tolerance` times the contact's w. */
typedef double displacement_function(const void *context, double w);
double law_stick(const law *law, double displacement, double slip_displacement, double tolerance,
                 displacement_function *function, const void *context);

/* Newton's method on the closed form. */
double closed_form_stick(const law *law, double displacement);
void closed_form_curve(const void *law, size_t n, const double *displacement, double *force, double *stiffness);
/* The same under Masing's rule, along a path from the virgin state. */
void closed_form_path(const law *law, size_t n, const double *displacement, double *force, double *stiffness);

#endif
