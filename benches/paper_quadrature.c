/* paper_quadrature.c: Eq. 10 with the mended tractions of Eq. 17 and 22, and its inverse by root finding.
 *
 * The unknown of the root finding is the stick zone, so that Eq. 1 need not be solved once more for every force, and its
 * slope is the tangent compliance (Eq. 8): the paper's way at its best. */
#include "paper_quadrature.h"

#include <math.h>
#include <stdlib.h>

void gauss_legendre(int n, const double **nodes, const double **weights)
{
    enum { LARGEST = 1024 };
    static double *kept[LARGEST + 1];
    if (!kept[n]) {
        kept[n] = malloc(2 * (size_t)n * sizeof **kept);
        for (int i = 0; i < n; ++i) {
            long double x = cosl(3.14159265358979323846L * (i + 0.75L) / (n + 0.5L)), slope = 1.0L;
            for (int k = 0; k < 8; ++k) {
                long double p = 1.0L, before = 0.0L;
                for (int j = 1; j <= n; ++j) {
                    const long double next = ((2 * j - 1) * x * p - (j - 1) * before) / j;
                    before = p;
                    p = next;
                }
                slope = n * (x * p - before) / (x * x - 1.0L);
                x -= p / slope;
            }
            kept[n][i] = (double)(0.5L * (1.0L - x));
            kept[n][n + i] = (double)(1.0L / ((1.0L - x * x) * slope * slope));
        }
    }
    *nodes = kept[n];
    *weights = kept[n] + n;
}

/* Pressure under the flat with rounded edges, half-width c, load P: Eq. 17 as mended. */
typedef struct { double half_width, phi0, opening, unit; } pressure;

static pressure pressure_of(double flat, double w, double load)
{
    pressure p = { .half_width = hypot(flat, w), .phi0 = atan2(flat, w) };
    p.opening = PI - 2.0 * p.phi0;
    p.unit = 2.0 / PI * load / p.half_width / (p.opening - sin(2.0 * p.phi0));
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
    return p->unit * value;
}

typedef struct { pressure outer, inner; double half_width, load; int sticks; } traction;

/* -q ln(x/b) over mu, at x = b sin(angle), times dx/d(angle). */
static double integrand(const traction *q, double angle)
{
    const double sine = sin(angle), x = q->half_width * sine;
    const double stuck = q->sticks ? pressure_at(&q->inner, x) : 0.0;
    return -(pressure_at(&q->outer, x) - stuck) * log(sine) * q->half_width * cos(angle);
}

static double gauss(const traction *q, int n)
{
    const double *nodes, *weights;
    double sum = 0.0;
    gauss_legendre(n, &nodes, &weights);
    for (int i = 0; i < n; ++i) {
        sum += weights[i] * integrand(q, 0.5 * PI * nodes[i]);
    }
    return 0.5 * PI * sum;
}

/* Gauss-Kronrod 7-15, halved until both agree. */
static double adaptive(const traction *q, double from, double to, double tolerance, int depth)
{
    static const double node[8] = { 0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
        0.864864423359769072789712788640926, 0.741531185599394439863864773280788, 0.586087235467691130294144691693507,
        0.405845151377397166906606412076961, 0.207784955007898467600689403773245, 0.0 };
    static const double kronrod[8] = { 0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
        0.104790010322250183839876322541518, 0.140653259715525918745189590510238, 0.169004726639267902826583426598550,
        0.190350578064785409913256402421014, 0.204432940075298892414161999234649, 0.209482141084727828012999174891714 };
    static const double seven[4] = { 0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
        0.381830050505118944950369775488975, 0.417959183673469387755102040816327 };
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    double fine = 0.0, coarse = 0.0;
    for (int i = 0; i < 8; ++i) {
        double sum = integrand(q, middle + half * node[i]);
        if (i < 7) {
            sum += integrand(q, middle - half * node[i]);
        }
        fine += kronrod[i] * sum;
        coarse += i % 2 ? seven[i / 2] * sum : 0.0;
    }
    fine *= half;
    coarse *= half;
    if (fabs(fine - coarse) <= tolerance || depth == 0) {
        return fine;
    }
    /* Halved no further than rounding allows. */
    const double half_tolerance = fmax(0.5 * tolerance, 1e-15 * q->load);
    return adaptive(q, from, middle, half_tolerance, depth - 1) + adaptive(q, middle, to, half_tolerance, depth - 1);
}

double paper_displacement(const void *context, double w)
{
    const paper *paper = context;
    const law *law = &paper->law;
    const double sticks = law_size_of_load(law->flat, w) / law->size_of_load;
    const double force = law->friction * law->load * (1.0 - sticks);
    traction q = { .outer = pressure_of(law->flat, law->w, law->load), .half_width = law->half_width, .load = law->load,
                   .sticks = w > 0.0 && sticks > 0.0 };
    if (q.sticks) {
        q.inner = pressure_of(law->flat, w, law->load * sticks);
    }
    double integral;
    if (paper->nodes > 0) {
        integral = gauss(&q, paper->nodes);
    } else {
        /* The tractions have kinks at the edge of the flat and of the stick zone. */
        const double edges[4] = { 0.0, asin(law->flat / law->half_width),
                                  asin(fmin(1.0, hypot(law->flat, w) / law->half_width)), 0.5 * PI };
        integral = 0.0;
        for (int i = 0; i < 3; ++i) {
            if (edges[i + 1] > edges[i]) {
                integral += adaptive(&q, edges[i], edges[i + 1], paper->tolerance * law->load, 40);
            }
        }
    }
    return 2.0 / (PI * law->modulus)
        * (2.0 * law->friction * integral + force * (log(law->length / law->half_width) + law->poisson));
}

paper paper_of(const law *law, int nodes, double tolerance)
{
    paper paper = { .law = *law, .nodes = nodes, .tolerance = tolerance };
    paper.slip_displacement = paper_displacement(&paper, 0.0);
    return paper;
}

double paper_stick(const paper *paper, double displacement)
{
    const double tolerance = paper->nodes > 0 ? 1e-10 : fmax(0.1 * paper->tolerance, 1e-12);
    return law_stick(&paper->law, displacement, paper->slip_displacement, tolerance, paper_displacement, paper);
}

void paper_curve(const void *context, size_t n, const double *displacement, double *force, double *stiffness)
{
    const paper *paper = context;
    for (size_t i = 0; i < n; ++i) {
        force[i] = paper->law.slip_force;
        stiffness[i] = 0.0;
        if (displacement[i] < paper->slip_displacement) {
            const double w = paper_stick(paper, displacement[i]);
            force[i] = law_force(&paper->law, w);
            stiffness[i] = law_stiffness(&paper->law, w);
        }
    }
}
