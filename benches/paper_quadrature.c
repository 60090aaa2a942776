/* paper_quadrature.c: Eq. 10 with the corrected tractions of Eq. 17 and 22 by quadrature, and its inverse.
 *
 * The unknown of the root finding is the stick zone, so that Eq. 1 need not be solved; the slope is the tangent compliance of
 * Eq. 8. Both make the paper's method faster than as printed. */
#include "bench.h"

#include <math.h>

/* Eq. 1, corrected: the load that makes c = sqrt(a^2 + w^2) the half-width, times 4R/E*. */
static double scaled_load(double flat, double w)
{
    return 2.0 * (flat * flat + w * w) * atan2(w, flat) - 2.0 * flat * w;
}

/* Pressure of a flat with rounded edges, half-width c, load per length P: Eq. 17, corrected. */
typedef struct { double half_width, phi0, opening, scale; } pressure;

static pressure pressure_of(double flat, double w, double load)
{
    pressure p = { .half_width = hypot(flat, w), .phi0 = atan2(flat, w) };
    p.opening = PI - 2.0 * p.phi0;
    p.scale = 2.0 / PI * load / p.half_width / (p.opening - sin(2.0 * p.phi0));
    return p;
}

static double pressure_at(const pressure *p, double x)
{
    if (x >= p->half_width) {
        return 0.0;
    }
    const double sine = x / p->half_width, phi = asin(sine);
    double value = p->opening * sqrt(1.0 - sine * sine);
    if (p->phi0 > 0.0 && phi != p->phi0) {
        value += sine * log(fabs(sin(phi + p->phi0) / sin(phi - p->phi0)))
            + sin(p->phi0) * log(fabs(tan(0.5 * (phi + p->phi0)) * tan(0.5 * (phi - p->phi0))));
    }
    return p->scale * value;
}

/* Eq. 22: the shear traction over mu is a pressure minus that of the stick zone. */
typedef struct { pressure contact, stick; double half_width; int sticks; } traction;

/* -(q/mu) ln(x/b) at x = b sin(angle), times dx/d(angle). */
static double integrand(const traction *q, double angle)
{
    const double sine = sin(angle), x = q->half_width * sine;
    const double stick = q->sticks ? pressure_at(&q->stick, x) : 0.0;
    return -(pressure_at(&q->contact, x) - stick) * log(sine) * q->half_width * cos(angle);
}

/* tanh-sinh rule: exponentially convergent for the kinks and logarithms at the ends of the interval. */
static double integral(const traction *q, double from, double to, int nodes)
{
    const double h = 3.2 / nodes;
    double sum = 0.0;
    for (int k = -nodes; k <= nodes; ++k) {
        const double s = 0.5 * PI * sinh(k * h), weight = 0.5 * PI * h * cosh(k * h) / (cosh(s) * cosh(s));
        sum += weight * integrand(q, from + (to - from) / (1.0 + exp(-2.0 * s)));
    }
    return 0.5 * (to - from) * sum;
}

static double force_at(const paper *p, double w)
{
    return p->slip_force * (1.0 - scaled_load(p->flat, w) / scaled_load(p->flat, p->w));
}

/* Eq. 10. */
static double displacement_at(const paper *p, double w)
{
    const double load = p->load * scaled_load(p->flat, w) / scaled_load(p->flat, p->w);
    const traction q = { .contact = pressure_of(p->flat, p->w, p->load), .half_width = p->half_width,
                         .sticks = w > 0.0, .stick = w > 0.0 ? pressure_of(p->flat, w, load) : (pressure) { 0 } };
    /* The tractions have kinks at the edges of the flat and of the stick zone. */
    const double edges[4] = { 0.0, asin(p->flat / p->half_width), asin(fmin(1.0, hypot(p->flat, w) / p->half_width)),
                              0.5 * PI };
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) {
        sum += edges[i + 1] > edges[i] ? integral(&q, edges[i], edges[i + 1], p->nodes) : 0.0;
    }
    const double tangential = p->friction * (p->load - load);
    return 2.0 / (PI * p->modulus)
        * (2.0 * p->friction * sum + tangential * (log(p->length / p->half_width) + p->poisson));
}

/* Eq. 8. */
static double stiffness_at(const paper *p, double w)
{
    return 0.5 * PI * p->modulus * p->length / (p->poisson + log(2.0 * p->length / hypot(p->flat, w)));
}

/* d(displacement)/dw <= 0. */
static double slope_at(const paper *p, double w)
{
    return -p->slip_force * 4.0 * w * atan2(w, p->flat) / scaled_load(p->flat, p->w) / stiffness_at(p, w);
}

paper paper_of(const mslip_parameters *p, double half_width, int nodes)
{
    const double nu = p->material[0].poisson_ratio;
    paper paper = { .flat = p->flat_half_width, .length = p->length, .friction = p->friction_coefficient,
                    .load = p->normal_force / p->length, .modulus = 0.5 * p->material[0].young_modulus / (1.0 - nu * nu),
                    .poisson = nu / (1.0 - nu), .slip_force = p->friction_coefficient * p->normal_force,
                    .nodes = nodes };
    paper.half_width = half_width;
    paper.w = sqrt(half_width * half_width - paper.flat * paper.flat);
    paper.slip_displacement = displacement_at(&paper, 0.0);
    return paper;
}

/* The stick zone at 0 <= displacement < slip_displacement, by Newton's method with bisection. */
static double stick_zone(const paper *p, double displacement)
{
    const double tolerance = 1e-9 * p->w; /* of the last step but one: convergence is quadratic */
    const double remaining = 1.0 - displacement / p->slip_displacement; /* scales as w^2 (cylinder) to w^3 (flat) */
    double low = 0.0, high = p->w, w = p->w * pow(remaining, 1.0 / (2.0 + p->flat / p->half_width)), step = p->w;
    for (int i = 0; i < 60 && step > tolerance; ++i) {
        const double excess = displacement_at(p, w) - displacement;
        if (excess > 0.0) {
            low = w;
        } else {
            high = w;
        }
        double next = w - excess / slope_at(p, w);
        if (!(next > low && next < high)) {
            next = fabs(next - w) < tolerance ? w : 0.5 * (low + high);
        }
        step = fabs(next - w);
        w = next;
    }
    return w;
}

void paper_curve(const void *context, size_t n, const double *displacement, double *force, double *stiffness)
{
    const paper *p = context;
    for (size_t i = 0; i < n; ++i) {
        const int slips = displacement[i] >= p->slip_displacement;
        const double w = slips ? 0.0 : stick_zone(p, displacement[i]);
        force[i] = force_at(p, w);
        stiffness[i] = slips ? 0.0 : stiffness_at(p, w);
    }
}

void paper_stiffness(const void *context, double amplitude, double result[4])
{
    const paper *p = context;
    const int slips = amplitude >= p->slip_displacement, n = p->nodes;
    const double inner = slips ? 0.0 : stick_zone(p, amplitude), half = 0.5 * (p->w - inner);
    const double top = force_at(p, inner), k = slips ? 0.0 : stiffness_at(p, inner);
    double real = 0.0, d_real = 0.0, area = 0.0;
    /* Stick zones at Chebyshev nodes: Gauss-Chebyshev weights for the square roots at both ends, Fejer's for smooth integrands. */
    for (int i = 0; i < n; ++i) {
        const double angle = PI * (i + 0.5) / n, w = inner + half * (1.0 + cos(angle));
        double fejer = 1.0;
        for (int j = 1; j <= n / 2; ++j) {
            fejer -= 2.0 * cos(2.0 * j * angle) / (4.0 * j * j - 1.0);
        }
        const double u = displacement_at(p, w), x = fmin(fmax(u / amplitude, 0.0), 1.0 - 1e-16);
        const double du = -slope_at(p, w) * half, dt = stiffness_at(p, w) * du;
        real += sqrt(x * (1.0 - x)) * dt * PI / n * sin(angle);
        d_real += sqrt(x / (1.0 - x)) * (1.0 - 2.0 * x) * dt * PI / n * sin(angle);
        area += (force_at(p, w) * du - u * dt) * 2.0 / n * fejer;
    }
    const double beyond = slips ? amplitude - p->slip_displacement : 0.0;
    result[0] = 8.0 / (PI * amplitude) * real;
    result[1] = 4.0 * (area + top * beyond) / (PI * amplitude * amplitude);
    result[2] = (-4.0 / (PI * amplitude) * d_real - result[0]) / amplitude;
    result[3] = 4.0 * (top - amplitude * k) / (PI * amplitude * amplitude) - 2.0 * result[1] / amplitude;
}
