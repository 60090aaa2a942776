/* task_force.c: force and stiffness at a displacement, 1,000 points per call; and the initialisation of a contact. */
#include "cases.h"

#include <math.h>

/* Slow methods and errors take every 100th point. */
enum { POINTS = 1000, STRIDE = 100, FEW = POINTS / STRIDE };
static double points[POINTS], few[FEW], exact[FEW];

typedef void curve(const void *law, size_t n, const double *displacement, double *force, double *stiffness);
typedef struct { curve *curve; const void *law; int all; } job;

static void microslip_curve(const void *contact, size_t n, const double *displacement, double *force, double *stiffness)
{
    mslip_monotonic_force(contact, n, displacement, force, stiffness, NULL);
}

static void jenkins_curve(const void *bank, size_t n, const double *displacement, double *force, double *stiffness)
{
    const double k = *((const sliders *)bank)->stiffness, slip = *((const sliders *)bank)->slip;
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

static void add(const char *method, curve *curve, const void *law, double parameter, int all)
{
    job *j = allocate(sizeof *j);
    double force[FEW], stiffness[FEW];
    *j = (job) { curve, law, all };
    entry *e = entry_add("force", method, run, j, all ? POINTS : FEW);
    e->parameter = parameter;
    e->error = 0.0;
    curve(law, FEW, few, force, stiffness);
    for (int i = 0; i < FEW; ++i) {
        e->error = fmax(e->error, fabs(force[i] / exact[i] - 1.0));
    }
}

static double prepare(void *parameters)
{
    mslip_contact contact;
    mslip_contact_init(parameters, &contact);
    return contact.slip_displacement;
}

void task_force(const test_case *c, const extent *x)
{
    for (int a = 0; a < x->amplitudes; ++a) {
        const size_t first = entry_count, mark = memory_mark();
        const double largest = x->amplitude[a] * c->contact.slip_displacement;
        for (int i = 0; i < POINTS; ++i) {
            points[i] = largest * (0.5 + 0.5 * (1 + i * 617 % POINTS) / POINTS); /* in irregular order */
        }
        for (int i = 0; i < FEW; ++i) {
            double value[2];
            few[i] = points[i * STRIDE];
            truth(&c->parameters, "force", 1, &few[i], 2, value);
            exact[i] = value[0];
        }
        add("microslip", microslip_curve, &c->contact, -1.0, 1);
        for (int k = 0; k < RULES; ++k) {
            add("quadrature", paper_curve, &c->paper[k], c->paper[k].nodes, 0);
        }
        for (int k = 1; k < BANKS && (int)c->bank[k].n <= x->most_sliders; ++k) {
            add("sliders", sliders_curve, &c->bank[k], (double)c->bank[k].n, c->bank[k].n <= 256);
        }
        add("spring-slider", jenkins_curve, &c->bank[0], -1.0, 1);
        measure(first, c->shape, x->amplitude[a], mark);
    }
    const size_t first = entry_count;
    double value[5];
    truth(&c->parameters, "contact", 0, NULL, 5, value);
    entry *e = entry_add("initialisation", "microslip", prepare, (void *)&c->parameters, 1);
    e->error = fabs(c->contact.slip_displacement / value[2] - 1.0);
    measure(first, c->shape, -1.0, memory_mark());
}
