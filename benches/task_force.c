/* task_force.c: force and stiffness at given displacements, 1,000 at once. */
#include "measure.h"
#include "paper_quadrature.h"
#include "tasks.h"

#include <math.h>

/* Whatever takes too long for all points has every 100th; errors are taken at these. */
enum { POINTS = 1000, STRIDE = 100, FEW = POINTS / STRIDE };

static double points[POINTS], few[FEW], truth[FEW];

typedef void curve(const void *law, size_t n, const double *displacement, double *force, double *stiffness);
typedef struct { curve *curve; const void *law; int all; } job;

static void microslip_curve(const void *contact, size_t n, const double *displacement, double *force, double *stiffness)
{
    mslip_monotonic_force(contact, n, displacement, force, stiffness, NULL);
}

static void jenkins_curve(const void *contact, size_t n, const double *displacement, double *force, double *stiffness)
{
    const double k = ((const mslip_contact *)contact)->initial_stiffness, slip = ((const mslip_contact *)contact)->slip_force;
    for (size_t i = 0; i < n; ++i) {
        const double trial = k * displacement[i];
        force[i] = trial < slip ? trial : slip;
        stiffness[i] = trial < slip ? k : 0.0;
    }
}

static double run(void *context)
{
    const job *j = context;
    double force[POINTS], stiffness[POINTS];
    const size_t n = j->all ? POINTS : FEW;
    j->curve(j->law, n, j->all ? points : few, force, stiffness);
    return force[n - 1] + stiffness[n / 2];
}

static entry *add(const char *method, curve *curve, const void *law, double parameter, int all)
{
    job *j = context_of(sizeof *j);
    double force[FEW], stiffness[FEW];
    *j = (job) { curve, law, all };
    entry *e = entry_add("force", method, run, j, all ? POINTS : FEW);
    e->parameter = parameter;
    e->error = 0.0;
    curve(law, FEW, few, force, stiffness);
    for (int i = 0; i < FEW; ++i) {
        e->error = fmax(e->error, fabs(force[i] / truth[i] - 1.0));
    }
    return e;
}

static const paper *quadrature(const subject *s, int nodes, double tolerance)
{
    paper *p = context_of(sizeof *p);
    *p = paper_of(&s->law, nodes, tolerance);
    return p;
}

void task_force(const subject *s, const extent *x)
{
    for (int a = 0; a < x->amplitudes; ++a) {
        const double reached = x->amplitude[a] * s->contact.slip_displacement;
        const size_t first = entry_count;
        for (int i = 0; i < POINTS; ++i) {
            /* From half of it to all of it, in no order: nothing may be guessed from the point before. */
            points[i] = reached * (0.5 + 0.5 * (1 + i * 617 % POINTS) / POINTS);
        }
        for (int i = 0; i < FEW; ++i) {
            double ignored;
            few[i] = points[i * STRIDE];
            reference_curve(s->truth, few[i], &truth[i], &ignored);
        }
        add("microslip", microslip_curve, &s->contact, 0, 1);
        add("closed form by Newton", closed_form_curve, &s->law, 0, 1);
        for (int n = 8; n <= x->most_nodes; n *= 2) {
            add("Eq. 10 by Gauss-Legendre", paper_curve, quadrature(s, n, 0.0), n, 0);
        }
        for (double tolerance = 1e-2; tolerance > 5e-13; tolerance *= 0.01) {
            add("Eq. 10 by adaptive Gauss-Kronrod", paper_curve, quadrature(s, 0, tolerance), tolerance, 0);
        }
        for (int n = 4; n <= x->most_sliders; n *= 4) {
            add("sliders", sliders_curve, bank_of(s, n), n, n <= 256);
        }
        add("Jenkins", jenkins_curve, &s->contact, 0, 1)->is_yardstick = 1;
        for (size_t i = first; i < entry_count; ++i) {
            entries[i].shape = s->shape;
            entries[i].amplitude = x->amplitude[a];
        }
        measure(first);
    }
}
