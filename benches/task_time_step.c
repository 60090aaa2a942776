/* task_time_step.c: force and stiffness after each step of a time integration. */
#include "cases.h"

#include <math.h>
#include <string.h>

enum { STEPS = 1000, KNOWN = 200, REVERSALS = 64, MOST_SLIDERS = 4096 };
static double path[STEPS], exact[KNOWN];

typedef struct {
    const mslip_contact *contact;
    const sliders *sliders;
    size_t state_length;
    double state[5 + 3 * REVERSALS], trial[5 + 3 * REVERSALS], forces[MOST_SLIDERS];
    double force[STEPS], stiffness[STEPS];
} job;

static double microslip(void *context)
{
    job *j = context;
    mslip_state_init(j->state_length, j->state);
    for (int i = 0; i < STEPS; ++i) {
        mslip_masing_update(j->contact, j->state_length, j->state, path[i], j->state, &j->force[i], &j->stiffness[i], NULL);
    }
    return j->force[STEPS - 1] + j->stiffness[STEPS / 2];
}

/* As in an iteration, which keeps the state before the step. */
static double new_states(void *context)
{
    job *j = context;
    double *from = j->state, *to = j->trial;
    mslip_state_init(j->state_length, from);
    for (int i = 0; i < STEPS; ++i) {
        mslip_masing_update(j->contact, j->state_length, from, path[i], to, &j->force[i], &j->stiffness[i], NULL);
        double *const next = from;
        from = to;
        to = next;
    }
    return j->force[STEPS - 1] + j->stiffness[STEPS / 2];
}

static double parallel_sliders(void *context)
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

static double spring_slider(void *context)
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

static void add(const test_case *c, const char *method, work *run, const sliders *sliders, double parameter)
{
    job *j = allocate(sizeof *j);
    j->contact = &c->contact;
    j->sliders = sliders;
    j->state_length = mslip_state_length(REVERSALS);
    entry *e = entry_add("time step", method, run, j, STEPS);
    double largest = 0.0;
    e->parameter = parameter;
    run(j);
    e->error = 0.0;
    for (int i = 0; i < KNOWN; ++i) {
        e->error = fmax(e->error, fabs(j->force[i] - exact[i]));
        largest = fmax(largest, fabs(exact[i]));
    }
    e->error /= largest;
}

void task_time_step(const test_case *c, const extent *x)
{
    for (int a = 0; a < x->amplitudes; ++a) {
        const double size = x->amplitude[a] * c->contact.slip_displacement;
        const size_t first = entry_count, mark = memory_mark();
        const sliders jenkins = jenkins_fitted(&c->contact, size);
        for (int i = 0; i < STEPS; ++i) {
            const double t = 2.0 * PI * i / 40.0; /* two tones, 40 steps per period of the slower one */
            path[i] = size * (0.7 * sin(t) + 0.3 * sin(2.618034 * t + 0.5));
        }
        truth(&c->parameters, "masing", KNOWN, path, KNOWN, exact);
        add(c, "microslip", microslip, NULL, -1.0);
        add(c, "microslip, new state", new_states, NULL, -1.0);
        entry_add_logarithm("time step");
        for (int k = 1; k < BANKS && (int)c->bank[k].n <= x->most_sliders; ++k) {
            add(c, "sliders", parallel_sliders, &c->bank[k], (double)c->bank[k].n);
        }
        add(c, "spring-slider", spring_slider, &jenkins, -1.0);
        measure(first, c->shape, x->amplitude[a], mark);
    }
}
