/* closed_form.c: the elementary formulas of the law, typed as they are read, with the C library's log and atan2. */
#include "law.h"

#include <math.h>

/* g(w) = 2 c^2 psi - 2 a w: the load that makes c = sqrt(a^2 + w^2) the half-width, times 4R/E*. */
double law_size_of_load(double flat, double w)
{
    return 2.0 * (flat * flat + w * w) * atan2(w, flat) - 2.0 * flat * w;
}

static double mean(double flat, double w)
{
    return (w * w + 3.0 * flat * flat) * atan2(w, flat) - 3.0 * flat * w;
}

law law_of(const mslip_parameters *p)
{
    law law = { .flat = p->flat_half_width, .length = p->length, .radius = p->edge_radius };
    const double nu = p->material[0].poisson_ratio;
    law.friction = p->friction_coefficient;
    law.modulus = 0.5 * p->material[0].young_modulus / (1.0 - nu * nu);
    law.load = p->normal_force / p->length;
    law.poisson = nu / (1.0 - nu);
    law.size_of_load = 4.0 * p->edge_radius * law.load / law.modulus;
    law.slip_force = p->friction_coefficient * p->normal_force;

    /* Newton from above: g is convex, and doubling passes the root. */
    law.w = sqrt(law.size_of_load / PI);
    while (law_size_of_load(law.flat, law.w) < law.size_of_load) {
        law.w *= 2.0;
    }
    for (int i = 0; i < 60; ++i) {
        double step = (law_size_of_load(law.flat, law.w) - law.size_of_load) / (4.0 * law.w * atan2(law.w, law.flat));
        law.w -= step;
        if (fabs(step) < 1e-15 * law.w) {
            break;
        }
    }
    law.size_of_load = law_size_of_load(law.flat, law.w);
    law.half_width = hypot(law.flat, law.w);
    law.mean = mean(law.flat, law.w);
    law.compliance = log(2.0 * law.length / law.half_width) + law.poisson;
    law.displacement_unit = 2.0 * law.friction * law.load / (PI * law.modulus);
    law.slip_displacement = law_displacement(&law, 0.0);
    law.initial_stiffness = law_stiffness(&law, law.w);
    return law;
}

double law_force(const law *law, double w)
{
    return law->slip_force * (1.0 - law_size_of_load(law->flat, w) / law->size_of_load);
}

double law_displacement(const law *law, double w)
{
    const double g = law_size_of_load(law->flat, w);
    const double narrower = g > 0.0 ? g * log(law->half_width / hypot(law->flat, w)) : 0.0;
    const double bend = law->mean - mean(law->flat, w) - narrower;
    return law->displacement_unit * (law->compliance * (law->size_of_load - g) + bend) / law->size_of_load;
}

static double compliance(const law *law, double w)
{
    return law->poisson + log(2.0 * law->length / hypot(law->flat, w));
}

double law_stiffness(const law *law, double w)
{
    return 0.5 * PI * law->modulus * law->length / compliance(law, w);
}

double law_displacement_slope(const law *law, double w)
{
    return -law->displacement_unit * compliance(law, w) * 4.0 * w * atan2(w, law->flat) / law->size_of_load;
}

double law_stick(const law *law, double displacement, double slip_displacement, double tolerance,
                 displacement_function *function, const void *context)
{
    /* Near gross slip what is left goes with w^2 (cylinder) to w^3 (flat). */
    const double rests = 1.0 - displacement / slip_displacement;
    double low = 0.0, high = law->w, w = law->w * pow(rests, 1.0 / (2.0 + law->flat / law->half_width));
    for (int i = 0; i < 60; ++i) {
        const double excess = function(context, w) - displacement;
        if (excess > 0.0) {
            low = w;
        } else {
            high = w;
        }
        double next = w - excess / law_displacement_slope(law, w);
        if (!(next > low && next < high)) {
            next = fabs(next - w) < tolerance * law->w ? w : 0.5 * (low + high);
        }
        const double step = fabs(next - w);
        w = next;
        if (step < tolerance * law->w) {
            break;
        }
    }
    return w;
}

static double closed_displacement(const void *context, double w)
{
    return law_displacement(context, w);
}

double closed_form_stick(const law *law, double displacement)
{
    return law_stick(law, displacement, law->slip_displacement, 1e-9, closed_displacement, law);
}

void closed_form_curve(const void *context, size_t n, const double *displacement, double *force, double *stiffness)
{
    const law *law = context;
    for (size_t i = 0; i < n; ++i) {
        const double size = fabs(displacement[i]);
        double t = law->slip_force, k = 0.0;
        if (size < law->slip_displacement && size > 0.0) {
            const double w = closed_form_stick(law, size);
            t = law_force(law, w);
            k = law_stiffness(law, w);
        } else if (size == 0.0) {
            t = 0.0;
            k = law->initial_stiffness;
        }
        force[i] = copysign(t, displacement[i]);
        stiffness[i] = k;
    }
}

static double curve_at(const law *law, double displacement, double *stiffness)
{
    double force;
    closed_form_curve(law, 1, &displacement, &force, stiffness);
    return force;
}

#define REAL double
#define WALK closed
#define CURVE curve_at
#define SLIP(l) (((const law *)(l))->slip_displacement)
#define FORCE(l) (((const law *)(l))->slip_force)
#include "masing.inc.h"

void closed_form_path(const law *law, size_t n, const double *displacement, double *force, double *stiffness)
{
    closed_walk walk;
    closed_start(&walk, law);
    walk.stiffness = law->initial_stiffness;
    for (size_t i = 0; i < n; ++i) {
        closed_move(&walk, displacement[i]);
        force[i] = walk.force;
        stiffness[i] = walk.stiffness;
    }
}
