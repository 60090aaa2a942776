/* tasks.c: initialisation of a contact, and a step of a time integration. */
#include "bench.h"

#include <math.h>

static double run_contact_init(void *parameters)
{
    mslip_contact contact;
    require(mslip_contact_init(parameters, &contact));
    return contact.slip_displacement;
}

void set_up_initialisation(const test_case *c, const extent *x, int k)
{
    entry_add((entry) { .task = "initialisation", .method = "microslip", .run = run_contact_init, .items = 1 }, &c->parameters,
              sizeof c->parameters);
}

enum { STEPS = 1000, STATE = 198 };
static double path[STEPS];

typedef struct {
    const mslip_contact *contact; /* NULL: the slider */
    sliders slider;
    double state[STATE], force[STEPS], stiffness[STEPS];
} step_job;

static double run_steps(void *context)
{
    step_job *j = context;
    mslip_state_init(STATE, j->state);
    for (int i = 0; i < STEPS; ++i) {
        mslip_masing_update(j->contact, STATE, j->state, path[i], j->state, &j->force[i], &j->stiffness[i], NULL);
    }
    return j->force[STEPS - 1] + j->stiffness[STEPS / 2];
}

static double run_slider_steps(void *context)
{
    step_job *j = context;
    const double stiffness = *j->slider.stiffness, slip = *j->slider.slip;
    double before = 0.0, force = 0.0;
    for (int i = 0; i < STEPS; ++i) {
        j->force[i] = jenkins_step(stiffness, slip, &force, path[i] - before, &j->stiffness[i]);
        before = path[i];
    }
    return j->force[STEPS - 1] + j->stiffness[STEPS / 2];
}

void set_up_step(const test_case *c, const extent *x, int a)
{
    const double size = x->amplitude[a] * c->contact.slip_displacement;
    entry e = { .task = "time step", .method = "microslip", .amplitude = x->amplitude[a], .run = run_steps, .items = STEPS };
    const step_job j = { .contact = &c->contact, .slider = sliders_fitted(&c->contact, 1, size) };
    for (int i = 0; i < STEPS; ++i) {
        const double t = 2.0 * PI * i / 40.0; /* two tones, 40 steps per period of the slower one */
        path[i] = size * (0.7 * sin(t) + 0.3 * sin(2.618034 * t + 0.5));
    }
    entry_add(e, &j, sizeof j);
    e.method = "spring-slider";
    e.run = run_slider_steps;
    entry_add(e, &j, sizeof j);
}
