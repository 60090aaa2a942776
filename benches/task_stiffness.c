/* task_stiffness.c: complex stiffness K' + iK'' with both derivatives by the amplitude. */
#include "measure.h"
#include "paper_quadrature.h"
#include "tasks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 16 };

static double points[POINTS], truth[POINTS][4];

/* Section 3.4 as one would program it: Gauss-Legendre over the stick zones of the branch, with the roots at both ends mapped
   away by w = inner + (outer - inner) cos^2; the displacement of each from `displacement`. */
typedef struct {
    const law *law;
    displacement_function *displacement;
    const void *context;
    double slip_displacement, tolerance;
    int nodes;
} section_3_4;

static void by_quadrature(const section_3_4 *s, double amplitude, double result[4])
{
    const law *law = s->law;
    const double *nodes, *weights;
    const int slides = amplitude >= s->slip_displacement;
    double inner = 0.0;
    if (!slides) {
        inner = law_stick(law, amplitude, s->slip_displacement, s->tolerance, s->displacement, s->context);
    }
    const double top = law_force(law, inner), k = slides ? 0.0 : law_stiffness(law, inner);
    double real = 0.0, slope = 0.0, area = 0.0;
    gauss_legendre(s->nodes, &nodes, &weights);
    for (int i = 0; i < s->nodes; ++i) {
        const double angle = 0.5 * PI * nodes[i], cosine = cos(angle);
        const double w = inner + (law->w - inner) * cosine * cosine;
        const double dw = -weights[i] * 0.5 * PI * (law->w - inner) * sin(2.0 * angle);
        const double reached = s->displacement(s->context, w), x = fmin(fmax(reached / amplitude, 0.0), 1.0 - 1e-16);
        const double du = law_displacement_slope(law, w) * dw, dt = law_stiffness(law, w) * du;
        real += sqrt(x * (1.0 - x)) * dt;
        slope += sqrt(x / (1.0 - x)) * (1.0 - 2.0 * x) * dt;
        area += law_force(law, w) * du - reached * dt;
    }
    const double beyond = slides ? amplitude - s->slip_displacement : 0.0;
    result[0] = 8.0 / (PI * amplitude) * real;
    result[1] = 4.0 * (area + top * beyond) / (PI * amplitude * amplitude);
    result[2] = (-4.0 / (PI * amplitude) * slope - result[0]) / amplitude;
    result[3] = 4.0 * (top - amplitude * k) / (PI * amplitude * amplitude) - 2.0 * result[1] / amplitude;
}

static double closed_displacement(const void *law, double w)
{
    return law_displacement(law, w);
}

typedef void stiffness(const void *law, double amplitude, double result[4]);
typedef struct { stiffness *stiffness; const void *law; int points; } job;

static double run(void *context)
{
    const job *j = context;
    double result[4], sum = 0.0;
    for (int i = 0; i < j->points; ++i) {
        j->stiffness(j->law, points[i], result);
        sum += result[0] + result[1] + result[2] + result[3];
    }
    return sum;
}

static double run_microslip(void *contact)
{
    double out[4][POINTS];
    mslip_complex_stiffness(contact, POINTS, points, out[0], out[1], out[2], out[3]);
    return out[0][0] + out[1][1] + out[2][2] + out[3][3];
}

static void microslip_stiffness(const void *contact, double amplitude, double result[4])
{
    mslip_complex_stiffness(contact, 1, &amplitude, &result[0], &result[1], &result[2], &result[3]);
}

static void slider_stiffness(const void *bank, double amplitude, double result[4])
{
    sliders_stiffness(bank, amplitude, result);
}

static void quadrature_stiffness(const void *context, double amplitude, double result[4])
{
    by_quadrature(context, amplitude, result);
}

static entry *add(const char *method, stiffness *stiffness, const void *law, double parameter, int n)
{
    job *j = context_of(sizeof *j);
    *j = (job) { stiffness, law, n };
    entry *e = entry_add("stiffness", method, run, j, n);
    e->parameter = parameter;
    e->error = 0.0;
    for (int i = 0; i < n; ++i) {
        double got[4];
        const double *true_ = truth[i], size = hypot(true_[0], true_[1]);
        stiffness(law, points[i], got);
        e->error = fmax(e->error, hypot(got[0] - true_[0], got[1] - true_[1]) / size);
        e->error = fmax(e->error, hypot(got[2] - true_[2], got[3] - true_[3]) * points[i] / size);
    }
    return e;
}

void task_stiffness(const subject *s, const extent *x)
{
    for (int a = 0; a < x->amplitudes; ++a) {
        const size_t first = entry_count;
        for (int i = 0; i < POINTS; ++i) {
            points[i] = x->amplitude[a] * s->contact.slip_displacement * (1.0 - 0.05 * (i * 7 % POINTS) / POINTS);
            reference_stiffness(s->truth, points[i], truth[i]);
        }
        add("microslip", microslip_stiffness, &s->contact, 0, POINTS);
        entries[first].run = run_microslip;
        entries[first].context = (void *)&s->contact;
        for (int n = 4; n <= 64; n *= 2) {
            section_3_4 *closed = context_of(sizeof *closed);
            *closed = (section_3_4) { &s->law, closed_displacement, &s->law, s->law.slip_displacement, 1e-9, n };
            add("closed form by Gauss-Legendre", quadrature_stiffness, closed, n, POINTS);
        }
        for (int n = 4; n <= 256 && n <= 2 * x->most_nodes; n *= 2) {
            section_3_4 *nested = context_of(sizeof *nested);
            paper *paper = context_of(sizeof *paper);
            *paper = paper_of(&s->law, n, 0.0);
            *nested = (section_3_4) { &s->law, paper_displacement, paper, paper->slip_displacement, 1e-10, n };
            add("Eq. 10 by Gauss-Legendre", quadrature_stiffness, nested, n, 2);
        }
        for (double tolerance = 1e-2; tolerance > 5e-13; tolerance *= 0.01) {
            section_3_4 *nested = context_of(sizeof *nested);
            paper *paper = context_of(sizeof *paper);
            *paper = paper_of(&s->law, 0, tolerance);
            *nested = (section_3_4) { &s->law, paper_displacement, paper, paper->slip_displacement,
                                      fmax(1e-11, 0.1 * tolerance), (int)(-8.0 * log10(tolerance)) };
            add("Eq. 10 by adaptive Gauss-Kronrod", quadrature_stiffness, nested, tolerance, 1);
        }
        for (int n = 4; n <= x->most_sliders; n *= 4) {
            add("sliders", slider_stiffness, bank_of(s, n), n, POINTS);
        }
        add("Jenkins", slider_stiffness, bank_of(s, 1), 0, POINTS)->is_yardstick = 1;
        for (size_t i = first; i < entry_count; ++i) {
            entries[i].shape = s->shape;
            entries[i].amplitude = x->amplitude[a];
        }
        measure(first);
    }
}
