/* task_march.c: steps of a time march, each a Masing update against a step of a spring-slider. */
#include "measure.h"
#include "tasks.h"

#include <math.h>
#include <string.h>

enum { STEPS = 1000, KNOWN = 200, STATE = 64, MOST_SLIDERS = 4096 };

static double path[STEPS], truth[KNOWN];

typedef struct {
    const mslip_contact *contact;
    const law *law;
    const sliders *sliders;
    size_t state_length;
    double state[512], forces[MOST_SLIDERS];
    double force[STEPS], stiffness[STEPS];
} job;

static double updates(void *context)
{
    job *j = context;
    mslip_state_init(j->state_length, j->state);
    for (int i = 0; i < STEPS; ++i) {
        mslip_masing_update(j->contact, j->state_length, j->state, path[i], j->state, &j->force[i], &j->stiffness[i], NULL);
    }
    return j->force[STEPS - 1] + j->stiffness[STEPS / 2];
}

static double whole_path(void *context)
{
    job *j = context;
    mslip_state_init(j->state_length, j->state);
    mslip_masing_path(j->contact, j->state_length, j->state, STEPS, path, j->state, j->force, j->stiffness, NULL);
    return j->force[STEPS - 1] + j->stiffness[STEPS / 2];
}

static double closed_form(void *context)
{
    job *j = context;
    closed_form_path(j->law, STEPS, path, j->force, j->stiffness);
    return j->force[STEPS - 1] + j->stiffness[STEPS / 2];
}

static double bank(void *context)
{
    job *j = context;
    double before = 0.0;
    memset(j->forces, 0, j->sliders->padded * sizeof(double));
    for (int i = 0; i < STEPS; ++i) {
        j->force[i] = sliders_step(j->sliders, j->forces, path[i] - before, &j->stiffness[i]);
        before = path[i];
    }
    return j->force[STEPS - 1] + j->stiffness[STEPS / 2];
}

static double jenkins(void *context)
{
    job *j = context;
    const double stiffness = *j->sliders->stiffness, slip = *j->sliders->slip;
    double before = 0.0, force = 0.0;
    for (int i = 0; i < STEPS; ++i) {
        j->force[i] = jenkins_step(stiffness, slip, &force, path[i] - before, &j->stiffness[i]);
        before = path[i];
    }
    return j->force[STEPS - 1] + j->stiffness[STEPS / 2];
}

static entry *add(const subject *s, const char *method, work *run, const sliders *sliders, double parameter)
{
    job *j = context_of(sizeof *j);
    j->contact = &s->contact;
    j->law = &s->law;
    j->sliders = sliders;
    j->state_length = mslip_state_length(STATE);
    entry *e = entry_add("march", method, run, j, STEPS);
    e->parameter = parameter;
    e->error = 0.0;
    sink = run(j);
    double largest = 0.0;
    for (int i = 0; i < KNOWN; ++i) {
        e->error = fmax(e->error, fabs(j->force[i] - truth[i]));
        largest = fmax(largest, fabs(truth[i]));
    }
    e->error /= largest;
    return e;
}

void task_march(const subject *s, const extent *x)
{
    for (int a = 0; a < x->amplitudes; ++a) {
        const double size = x->amplitude[a] * s->contact.slip_displacement;
        const size_t first = entry_count;
        for (int i = 0; i < STEPS; ++i) {
            /* A beat of two tones, 40 steps to the longer period. */
            const double t = 2.0 * PI * i / 40.0;
            path[i] = size * (0.7 * sin(t) + 0.3 * sin(2.618034 * t + 0.5));
        }
        reference_path(s->truth, KNOWN, path, truth);
        add(s, "microslip", updates, NULL, 0);
        add(s, "microslip whole path", whole_path, NULL, 0);
        add(s, "closed form by Newton", closed_form, NULL, 0);
        for (int n = 4; n <= x->most_sliders && n <= MOST_SLIDERS; n *= 4) {
            add(s, "sliders", bank, bank_of(s, n), n);
        }
        add(s, "Jenkins", jenkins, kept(jenkins_of(s, size)), 0)->is_yardstick = 1;
        for (size_t i = first; i < entry_count; ++i) {
            entries[i].shape = s->shape;
            entries[i].amplitude = x->amplitude[a];
        }
        measure(first);
    }
}
