/* task_element.c: harmonic force and steps of an element under a varying normal force, against one spring-slider with a varying limit. */
#include "cases.h"
#include "varying_slider.h"

#include <math.h>
#include <string.h>

enum { MOST = 38, STEPS = 256 };

/* Amplitudes: u over mu S of the largest load, mean and swing of the approach over its largest value, and parts of the swing in
   phase with u and a quarter of a period later. */
static const struct { const char *name; double u, mean, swing, in_phase, quadrature; } motions[] = {
    { "varying load", 0.2, 0.45, 0.35, 0.32, 0.7 },
    { "load varying by 5 %", 0.2, 0.45, 0.05, 0.32, 0.7 },
    { "in phase, half stuck", 0.2, 0.45, 0.35, 0.792, 0.1 },
    { "separation", 0.5, 0.35, 0.6, 0.32, 0.7 },
    { "gross slip", 1.2, 0.45, 0.35, 0.32, 0.7 },
    { "gross slip and separation", 1.2, 0.35, 0.6, 0.32, 0.7 },
    { "constant load", 0.3, 1.0, 0.0, 0.0, 0.0 },
};
enum { MOTIONS = sizeof motions / sizeof *motions };

typedef struct {
    varying_aft_method *method; /* NULL: microslip */
    varying_aft *aft;
    const varying_slider *slider;
    const mslip_element *element;
    const mslip_parameters *parameters;
    double *workspace, *state;
    size_t state_length;
    int jacobian_requested;
    double displacement[MOST], force[MOST], jacobian[MOST * MOST], path[2 * STEPS], tangent[4], stiffness[STEPS];
} job;

static double run(void *context)
{
    job *j = context;
    double *jacobian = j->jacobian_requested ? j->jacobian : NULL;
    if (j->method) {
        j->method(j->aft, j->slider, j->displacement, j->force, jacobian);
    } else {
        mslip_element_harmonic_force(j->element, j->workspace, j->displacement, j->force, jacobian, NULL);
    }
    return j->force[1] + j->jacobian[1];
}

static double run_steps(void *context)
{
    job *j = context;
    double slider[2] = { 0.0, 0.0 };
    if (j->element) {
        require(mslip_element_state_init(1, j->state_length, j->state));
    }
    for (int i = 0; i < STEPS; ++i) {
        if (j->element) {
            mslip_element_update(j->element, j->state_length, j->state, j->path + 2 * i, j->state, j->force, j->tangent, NULL);
        } else {
            varying_slider_step(j->slider, slider, j->path[2 * i], j->path[2 * i + 1], j->force, j->tangent);
        }
    }
    return j->force[0] + j->tangent[0];
}

static double run_init(void *context)
{
    job *j = context;
    static mslip_element element;
    require(mslip_element_init(j->parameters, 1, MSLIP_INPUT_APPROACH, &element));
    return element.approach;
}

static double run_normal_force(void *context)
{
    job *j = context;
    require(mslip_normal_force(j->element, STEPS, j->path, j->path + STEPS, j->stiffness, NULL));
    return j->path[STEPS] + j->stiffness[0];
}

static job *add(const char *task, const char *method, work *work, const job *prototype, int harmonics, int samples, int motion)
{
    job *kept = allocate(sizeof *kept);
    *kept = *prototype;
    entry *e = entry_add(task, method, work, kept, samples || work == run_init ? 1 : STEPS);
    e->harmonics = harmonics;
    e->samples = samples;
    e->jacobian = prototype->jacobian_requested;
    e->parameter = motion;
    work(kept);
    return kept;
}

static void motion_in(const mslip_element *element, double shift, int motion, int harmonics, double *displacement)
{
    const double u = motions[motion].u * element->friction_coefficient * shift, w = element->approach;
    double *normal = displacement + 2 * harmonics + 1;
    displacement[0] = 0.03 * u;
    displacement[1] = u;
    displacement[2] = 0.11 * u;
    normal[0] = motions[motion].mean * w;
    normal[1] = motions[motion].in_phase * motions[motion].swing * w;
    normal[2] = motions[motion].quadrature * motions[motion].swing * w;
    for (int k = 2; k <= harmonics; ++k) {
        displacement[2 * k - 1] = 0.3 * u / (k * k);
        displacement[2 * k] = -0.13 * u / (k * k);
        normal[2 * k - 1] = 0.1 * motions[motion].swing * w / (k * k);
        normal[2 * k] = 0.07 * motions[motion].swing * w / (k * k);
    }
}

static double *workspace_of(int harmonics, int samples)
{
    const size_t h = (size_t)harmonics, s = (size_t)samples,
                 length = mslip_element_workspace_length(1, h, s, MSLIP_UNIFORM_SAMPLING);
    double *workspace = allocate(length * sizeof *workspace);
    require(mslip_element_workspace_init(1, h, s, MSLIP_UNIFORM_SAMPLING, 0, length, workspace));
    return workspace;
}

static void add_harmonic(const mslip_element *element, const varying_slider *slider, double shift, int motion, int harmonics, int samples)
{
    const int n = 2 * (2 * harmonics + 1);
    /* Sixteen times as many samples: the errors of sampling are those of the square of the interval. */
    job exact = { .element = element, .workspace = workspace_of(harmonics, 16 * samples) };
    motion_in(element, shift, motion, harmonics, exact.displacement);
    run(&exact);
    for (int jacobian = 0; jacobian <= 1; ++jacobian) {
        job j = { .element = element, .slider = slider, .jacobian_requested = jacobian };
        j.workspace = workspace_of(harmonics, samples);
        motion_in(element, shift, motion, harmonics, j.displacement);
        add("element", "microslip", run, &j, harmonics, samples, motion);
        j.method = varying_slider_by_runs;
        j.aft = varying_aft_of(harmonics, samples);
        const job *plain = add("element", "spring-slider", run, &j, harmonics, samples, motion);
        j.method = varying_slider_stepped;
        const job *stepped = add("element", "spring-slider, stepped", run, &j, harmonics, samples, motion);
        for (entry *e = entries + entry_count - 3; e < entries + entry_count; ++e) {
            e->error = first_harmonic_error(((const job *)e->context)->force, exact.force, 1, 2 * harmonics + 1);
        }
        double difference = 0.0, largest = 1e-300;
        for (int i = 0; jacobian && i < n * n; ++i) {
            largest = fmax(largest, fabs(plain->jacobian[i]));
            difference = fmax(difference, fabs(plain->jacobian[i] - stepped->jacobian[i]));
        }
        check_below("Jacobian of a slider with a varying limit, by two methods", difference / largest, 1e-12);
    }
}

void task_element(const test_case *c, const extent *x)
{
    static mslip_element element;
    require(mslip_element_init(&c->parameters, 1, MSLIP_INPUT_APPROACH, &element));
    /* S of the largest load: the displacement of gross slip over mu. */
    const double shift = c->contact.slip_displacement / element.friction_coefficient;
    const varying_slider slider = { element.tangential_stiffness, element.normal_force / element.approach, element.friction_coefficient };
    const size_t begin = entry_count, bottom = memory_mark();
    job once = { .element = &element, .parameters = &c->parameters };
    for (int i = 0; i < STEPS; ++i) {
        once.path[i] = element.approach * (i + 1) / STEPS;
    }
    add("element initialisation", "microslip", run_init, &once, 0, 0, 0);
    add("normal force", "microslip", run_normal_force, &once, 0, 0, 0);
    entry_add_logarithm("normal force")->parameter = 0;
    measure(begin, c->shape, 0.0, bottom);
    for (int motion = 0; motion < MOTIONS; ++motion) {
        const size_t first = entry_count, mark = memory_mark();
        for (int o = 0; o < x->orders; ++o) {
            const int harmonics = x->order[o], samples = harmonics < 5 ? 64 : harmonics < 9 ? 128 : 256;
            add_harmonic(&element, &slider, shift, motion, harmonics, samples);
        }
        job j = { .element = &element, .slider = &slider, .state_length = mslip_element_state_length(1, STEPS) };
        j.state = allocate(j.state_length * sizeof *j.state);
        double displacement[6];
        motion_in(&element, shift, motion, 1, displacement);
        for (int i = 0; i < STEPS; ++i) {
            const double t = 2.0 * PI * i / STEPS;
            for (int k = 0; k < 2; ++k) {
                const double *p = displacement + 3 * k;
                j.path[2 * i + k] = p[0] + p[1] * cos(t) + p[2] * sin(t);
            }
        }
        add("element step", "microslip", run_steps, &j, 0, 0, motion);
        j.element = NULL;
        add("element step", "spring-slider", run_steps, &j, 0, 0, motion);
        measure(first, c->shape, motions[motion].u, mark);
    }
}

const char *element_motion(int motion)
{
    return motion < MOTIONS ? motions[motion].name : NULL;
}
