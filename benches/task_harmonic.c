/* task_harmonic.c: harmonic force of a motion of 1 to 9 harmonics by samples, with and without its Jacobian. */
#include "measure.h"
#include "tasks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 19, MOST_SAMPLES = 1024 };

typedef void aft_method(aft *a, const sliders *s, const double *displacement, double *force, double *jacobian);

typedef struct {
    aft_method *method; /* NULL: microslip, or the closed form where there is a law */
    const law *law;
    aft *aft;
    const sliders *sliders;
    const mslip_contact *contact;
    double *workspace;
    int n, samples;
    double displacement[MOST], force[MOST], jacobian[MOST * MOST];
} job;

static double run(void *context)
{
    job *j = context;
    double *jacobian = j->n > 0 ? j->jacobian : NULL;
    if (j->method) {
        j->method(j->aft, j->sliders, j->displacement, j->force, jacobian);
    } else if (j->law) {
        static double forces[2 * MOST_SAMPLES], stiffness[2 * MOST_SAMPLES];
        const size_t samples = (size_t)j->samples;
        closed_form_path(j->law, 2 * samples, aft_displacements(j->aft, j->displacement), forces, stiffness);
        aft_transform(j->aft, forces + samples, j->force);
    } else {
        mslip_harmonic_force(j->contact, j->workspace, j->displacement, j->force, jacobian, NULL);
    }
    return j->force[1] + j->jacobian[1];
}

static void release_aft(void *a)
{
    aft_free(a);
}

/* Error of the first harmonic, relative to it. */
static double first_harmonic(const double *got, const double *truth)
{
    return hypot(got[1] - truth[1], got[2] - truth[2]) / hypot(truth[1], truth[2]);
}

typedef struct { const double *displacement, *limit, *sums; int harmonics, samples, jacobian; } call;

static entry *add(const call *c, const char *method, job j, double parameter)
{
    job *kept = context_of(sizeof *kept);
    *kept = j;
    kept->samples = c->samples;
    kept->n = c->jacobian ? 2 * c->harmonics + 1 : 0;
    memcpy(kept->displacement, c->displacement, sizeof(double) * (size_t)(2 * c->harmonics + 1));
    entry *e = entry_add("harmonic", method, run, kept, 1);
    e->harmonics = c->harmonics;
    e->samples = c->samples;
    e->jacobian = c->jacobian;
    e->parameter = parameter;
    sink = run(kept);
    e->error = first_harmonic(kept->force, c->limit);
    if (c->sums) {
        e->sample_error = first_harmonic(kept->force, c->sums);
    }
    return e;
}

static aft *tables(int harmonics, int samples, size_t n)
{
    aft *a = aft_of(harmonics, samples, n);
    release_later(a, release_aft);
    return a;
}

static double *workspace_of(int harmonics, int samples, int32_t rule)
{
    const size_t h = (size_t)harmonics, n = (size_t)samples;
    const size_t length = mslip_harmonic_workspace_length(h, n, rule);
    double *workspace = context_of(length * sizeof *workspace);
    succeed(mslip_harmonic_workspace_init(h, n, rule, length, workspace));
    return workspace;
}

void task_harmonic(const subject *s, const extent *x, int harmonics)
{
    for (int a = 0; a < x->amplitudes; ++a) {
        const double size = x->amplitude[a] * s->contact.slip_displacement;
        const size_t first = entry_count;
        const sliders *jenkins = kept(jenkins_of(s, size));
        double displacement[MOST], limit[MOST];
        motion_of(harmonics, size, displacement);
        reference_harmonics(s->truth, harmonics, displacement, limit);

        for (int samples = x->least_samples; samples <= x->most_samples; samples *= 2) {
            if (samples <= 2 * harmonics) {
                continue;
            }
            double sums[MOST];
            /* In quadruple precision many samples take long. */
            const int known = samples <= 128;
            if (known) {
                reference_samples(s->truth, harmonics, samples, displacement, sums);
            }
            for (int jacobian = 0; jacobian <= 1; ++jacobian) {
                const call c = { displacement, limit, known ? sums : NULL, harmonics, samples, jacobian };
                job j = { .contact = &s->contact, .workspace = workspace_of(harmonics, samples, MSLIP_UNIFORM_SAMPLING) };
                add(&c, "microslip", j, 0);
                j.workspace = workspace_of(harmonics, samples, MSLIP_EVENT_DRIVEN);
                add(&c, "microslip event-driven", j, 0)->sample_error = -1.0;
                if (!jacobian) {
                    j = (job) { .law = &s->law, .aft = tables(harmonics, samples, 1) };
                    add(&c, "closed form by Newton", j, 0);
                }
                j = (job) { .sliders = jenkins, .aft = tables(harmonics, samples, 1) };
                j.method = jenkins_stepped;
                add(&c, "Jenkins", j, 0)->is_yardstick = 1;
                j.method = sliders_by_reversals;
                add(&c, "Jenkins by reversals", j, 0);
                for (int n = 4; samples == 128 && n <= x->most_sliders; n *= 4) {
                    j = (job) { .sliders = bank_of(s, n), .aft = tables(harmonics, samples, (size_t)n) };
                    j.method = sliders_stepped;
                    add(&c, "sliders", j, n);
                    j.method = sliders_by_reversals;
                    add(&c, "sliders by reversals", j, n);
                    j.sliders = even_bank_of(s, n);
                    j.method = sliders_stepped;
                    add(&c, "sliders evenly spaced", j, n);
                }
            }
        }
        for (size_t i = first; i < entry_count; ++i) {
            entries[i].shape = s->shape;
            entries[i].amplitude = x->amplitude[a];
        }
        measure(first);
    }
}
