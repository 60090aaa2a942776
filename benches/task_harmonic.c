/* task_harmonic.c: harmonic force of a motion of one to nine harmonics from samples, with and without its Jacobian. */
#include "cases.h"

#include <math.h>
#include <string.h>

enum { MOST = 19, COMPARED = 128 }; /* coefficients; samples at which sliders are compared at equal samples */

typedef struct {
    aft_method *method; /* NULL: microslip */
    aft *aft;
    const sliders *sliders;
    const mslip_contact *contact;
    double *workspace;
    int jacobian_requested;
    double displacement[MOST], force[MOST], jacobian[MOST * MOST];
} job;

static double run(void *context)
{
    job *j = context;
    double *jacobian = j->jacobian_requested ? j->jacobian : NULL;
    if (j->method) {
        j->method(j->aft, j->sliders, j->displacement, j->force, jacobian);
    } else {
        mslip_harmonic_force(j->contact, j->workspace, j->displacement, j->force, jacobian, NULL);
    }
    return j->force[1] + j->jacobian[1];
}

/* Error of the first harmonic, relative to it. */
static double first_harmonic(const double *got, const double *exact)
{
    return hypot(got[1] - exact[1], got[2] - exact[2]) / hypot(exact[1], exact[2]);
}

/* exact: NULL if errors are not measured. */
typedef struct { const char *task; int harmonics, samples, jacobian; const double *displacement, *exact, *sums; } call;

static job *add(const call *c, const char *method, job j, double parameter)
{
    job *kept = allocate(sizeof *kept);
    *kept = j;
    kept->jacobian_requested = c->jacobian;
    memcpy(kept->displacement, c->displacement, sizeof(double) * (size_t)(2 * c->harmonics + 1));
    entry *e = entry_add(c->task, method, run, kept, 1);
    e->harmonics = c->harmonics;
    e->samples = c->samples;
    e->jacobian = c->jacobian;
    e->parameter = parameter;
    run(kept);
    e->error = c->exact ? first_harmonic(kept->force, c->exact) : e->error;
    if (c->exact && c->samples == COMPARED) {
        e->sample_error = first_harmonic(kept->force, c->sums);
    }
    return kept;
}

static double *workspace_of(int harmonics, int samples, int32_t rule)
{
    const size_t h = (size_t)harmonics, n = (size_t)samples, length = mslip_harmonic_workspace_length(h, n, rule);
    double *workspace = allocate(length * sizeof *workspace);
    require(mslip_harmonic_workspace_init(h, n, rule, length, workspace));
    return workspace;
}

/* Largest difference of the Jacobians of two methods, over the initial stiffness. */
static double jacobian_difference(const test_case *t, int n, const job *a, const job *b)
{
    double difference = 0.0;
    for (int i = 0; i < n * n; ++i) {
        difference = fmax(difference, fabs(a->jacobian[i] - b->jacobian[i]) / t->contact.initial_stiffness);
    }
    return difference;
}

static void add_methods(const test_case *t, const call *c, const extent *x, const sliders *jenkins)
{
    const int h = c->harmonics, n = c->samples;
    job j = { .contact = &t->contact, .workspace = workspace_of(h, n, MSLIP_EVENT_DRIVEN) };
    add(c, "microslip event-driven", j, -1.0);
    j.workspace = workspace_of(h, n, MSLIP_UNIFORM_SAMPLING);
    const job *own = add(c, "microslip", j, -1.0);
    j = (job) { .method = jenkins_aft, .sliders = jenkins, .aft = aft_of(h, n) };
    const job *stepped = add(c, "spring-slider", j, -1.0);
    j.method = sliders_aft;
    const job *other = add(c, "spring-slider by reversals", j, -1.0);
    if (c->jacobian) {
        check_below("Jacobian of a slider, by two methods", jacobian_difference(t, 2 * h + 1, stepped, other), 1e-12);
    }
    for (int k = 1; n == COMPARED && k < BANKS && (int)t->bank[k].n <= x->most_sliders; ++k) {
        j.sliders = &t->bank[k];
        other = add(c, "sliders", j, (double)t->bank[k].n);
        if (t->bank[k].n == 1024 && c->jacobian) {
            check_below("Jacobian of 1024 sliders", jacobian_difference(t, 2 * h + 1, own, other), 1e-2);
        }
    }
}

void task_harmonic(const test_case *t, const extent *x)
{
    for (int o = 0; o < x->orders; ++o) {
        for (int a = 0; a < x->amplitudes; ++a) {
            const int harmonics = x->order[o], coefficients = 2 * harmonics + 1;
            const double size = x->amplitude[a] * t->contact.slip_displacement;
            const size_t first = entry_count, mark = memory_mark();
            const sliders jenkins = jenkins_fitted(&t->contact, size);
            double arguments[1 + MOST] = { 0.0 }, exact[MOST], sums[MOST];
            motion_of(harmonics, size, arguments + 1);
            truth(&t->parameters, "harmonic", 1 + coefficients, arguments, coefficients, exact);
            arguments[0] = COMPARED;
            truth(&t->parameters, "harmonic", 1 + coefficients, arguments, coefficients, sums);
            for (int samples = x->least_samples; samples <= x->most_samples; samples *= 2) {
                for (int jacobian = 0; samples > 2 * harmonics && jacobian <= 1; ++jacobian) {
                    const call c = { "harmonic", harmonics, samples, jacobian, arguments + 1, exact, sums };
                    add_methods(t, &c, x, &jenkins);
                }
            }
            measure(first, t->shape, x->amplitude[a], mark);
        }
    }
}
