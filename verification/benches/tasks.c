/* tasks.c: force, stiffness, initialisation and steps of a contact. */
#include "bench.h"

#include <math.h>
#include <string.h>

enum { POINTS = 1000, STRIDE = 100, FEW = POINTS / STRIDE }; /* errors take every 100th point */
static double points[POINTS], few[FEW];

typedef void curve(const void *law, size_t n, const double *displacement, double *force, double *stiffness);
typedef struct { curve *curve; const void *law; } curve_job;

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

static double run_curve(void *context)
{
    const curve_job *j = context;
    double force[POINTS], stiffness[POINTS];
    j->curve(j->law, POINTS, points, force, stiffness);
    return force[POINTS - 1] + stiffness[POINTS / 2];
}

static void add_curve(const entry *e, const double *exact, const char *method, double parameter, curve_job job)
{
    double force[FEW], stiffness[FEW];
    entry *added = entry_add(*e, &job, sizeof job);
    added->method = method;
    added->parameter = parameter;
    added->items = POINTS;
    job.curve(job.law, FEW, few, force, stiffness);
    for (int i = 0; i < FEW; ++i) {
        added->error = fmax(added->error, fabs(force[i] / exact[i] - 1.0));
    }
}

void set_up_force(const test_case *c, const extent *x, int a)
{
    const double largest = x->amplitude[a] * c->contact.slip_displacement;
    const entry e = { .task = "force", .amplitude = x->amplitude[a], .run = run_curve };
    double exact[FEW];
    for (int i = 0; i < POINTS; ++i) {
        points[i] = largest * (0.5 + 0.5 * (1 + i * 617 % POINTS) / POINTS); /* in irregular order */
    }
    for (int i = 0; i < FEW; ++i) {
        few[i] = points[i * STRIDE];
    }
    microslip_curve(&c->contact, FEW, few, exact, NULL);
    add_curve(&e, exact, "microslip", 0.0, (curve_job) { microslip_curve, &c->contact });
    for (int k = 1; k < BANKS && (int)c->bank[k].n <= x->most_sliders; ++k) {
        add_curve(&e, exact, "sliders", (double)c->bank[k].n, (curve_job) { sliders_curve, &c->bank[k] });
    }
    add_curve(&e, exact, "spring-slider", 0.0, (curve_job) { jenkins_curve, &c->bank[0] });
}

static double run_contact_init(void *parameters)
{
    mslip_contact contact;
    require(mslip_contact_init(parameters, &contact));
    return contact.slip_displacement;
}

void set_up_initialisation(const test_case *c, const extent *x, int k)
{
    const entry e = { .task = "initialisation", .method = "microslip", .run = run_contact_init, .items = 1 };
    entry_add(e, &c->parameters, sizeof c->parameters);
}

enum { AMPLITUDES = 8 };
typedef void stiffness(const void *law, double amplitude, double result[4]);
typedef struct {
    stiffness *stiffness; /* NULL: microslip */
    const void *law;
    double amplitude[AMPLITUDES], out[AMPLITUDES][4];
    double real[AMPLITUDES], imaginary[AMPLITUDES], d_real[AMPLITUDES], d_imaginary[AMPLITUDES];
} stiffness_job;

static double run_stiffness(void *context)
{
    stiffness_job *j = context;
    for (int i = 0; j->stiffness && i < AMPLITUDES; ++i) {
        j->stiffness(j->law, j->amplitude[i], j->out[i]);
    }
    if (!j->stiffness) {
        mslip_complex_stiffness(j->law, AMPLITUDES, j->amplitude, j->real, j->imaginary, j->d_real, j->d_imaginary);
    }
    return j->real[0] + j->out[0][0];
}

static void add_stiffness(const entry *e, double (*exact)[4], const char *method, double parameter, const stiffness_job *job)
{
    entry *added = entry_add(*e, job, sizeof *job);
    const stiffness_job *j = added->context;
    added->method = method;
    added->parameter = parameter;
    added->items = AMPLITUDES;
    for (int i = 0; i < AMPLITUDES; ++i) {
        const double own[4] = { j->real[i], j->imaginary[i], j->d_real[i], j->d_imaginary[i] };
        const double *got = j->stiffness ? j->out[i] : own, *k = exact[i], size = hypot(k[0], k[1]);
        added->error = fmax(added->error, hypot(got[0] - k[0], got[1] - k[1]) / size);
        added->error = fmax(added->error, hypot(got[2] - k[2], got[3] - k[3]) * j->amplitude[i] / size);
    }
}

void set_up_stiffness(const test_case *c, const extent *x, int a)
{
    double exact[AMPLITUDES][4];
    const entry e = { .task = "stiffness", .amplitude = x->amplitude[a], .run = run_stiffness };
    stiffness_job j = { .law = &c->contact };
    for (int i = 0; i < AMPLITUDES; ++i) {
        double *k = exact[i];
        j.amplitude[i] = x->amplitude[a] * c->contact.slip_displacement * (1.0 - 0.05 * (i * 3 % AMPLITUDES) / AMPLITUDES);
        mslip_complex_stiffness(&c->contact, 1, &j.amplitude[i], &k[0], &k[1], &k[2], &k[3]);
    }
    add_stiffness(&e, exact, "microslip", 0.0, &j);
    j.stiffness = sliders_stiffness;
    for (int k = 0; k < BANKS && (int)c->bank[k].n <= x->most_sliders; ++k) {
        j.law = &c->bank[k];
        add_stiffness(&e, exact, k ? "sliders" : "spring-slider", k ? (double)c->bank[k].n : 0.0, &j);
    }
}

enum { STEPS = 1000, REVERSALS = 64, MOST_SLIDERS = 4096 };
static double path[STEPS];

typedef struct {
    const mslip_contact *contact; /* NULL: sliders */
    const sliders *sliders;
    double state[6 + 3 * REVERSALS], forces[MOST_SLIDERS], force[STEPS], stiffness[STEPS];
} step_job;

static double run_steps(void *context)
{
    step_job *j = context;
    const size_t length = sizeof j->state / sizeof *j->state;
    mslip_state_init(length, j->state);
    for (int i = 0; i < STEPS; ++i) {
        mslip_masing_update(j->contact, length, j->state, path[i], j->state, &j->force[i], &j->stiffness[i], NULL);
    }
    return j->force[STEPS - 1] + j->stiffness[STEPS / 2];
}

static double run_slider_steps(void *context)
{
    step_job *j = context;
    const sliders *s = j->sliders;
    const double stiffness = *s->stiffness, slip = *s->slip;
    double before = 0.0, force = 0.0;
    memset(j->forces, 0, s->padded * sizeof(double));
    for (int i = 0; i < STEPS && s->n == 1; ++i) {
        j->force[i] = jenkins_step(stiffness, slip, &force, path[i] - before, &j->stiffness[i]);
        before = path[i];
    }
    for (int i = 0; i < STEPS && s->n > 1; ++i) {
        j->force[i] = sliders_step(s, 1.0, j->forces, path[i] - before, &j->stiffness[i]);
        before = path[i];
    }
    return j->force[STEPS - 1] + j->stiffness[STEPS / 2];
}

void set_up_step(const test_case *c, const extent *x, int a)
{
    const double size = x->amplitude[a] * c->contact.slip_displacement;
    entry e = { .task = "time step", .method = "microslip", .amplitude = x->amplitude[a], .run = run_steps, .items = STEPS };
    step_job *j = allocate(sizeof *j);
    for (int i = 0; i < STEPS; ++i) {
        const double t = 2.0 * PI * i / 40.0; /* two tones, 40 steps per period of the slower one */
        path[i] = size * (0.7 * sin(t) + 0.3 * sin(2.618034 * t + 0.5));
    }
    *j = (step_job) { .contact = &c->contact };
    const step_job *exact = entry_add(e, j, sizeof *j)->context;
    e.run = run_slider_steps;
    const sliders jenkins = sliders_fitted(&c->contact, 1, size), *one = memcpy(allocate(sizeof jenkins), &jenkins, sizeof jenkins);
    for (int k = 0; k < BANKS && (int)c->bank[k].n <= x->most_sliders; ++k) {
        j->sliders = k ? &c->bank[k] : one;
        e.method = k ? "sliders" : "spring-slider";
        e.parameter = k ? (double)c->bank[k].n : 0.0;
        entry *added = entry_add(e, j, sizeof *j);
        double largest = 0.0, error = 0.0;
        for (int i = 0; i < STEPS; ++i) {
            error = fmax(error, fabs(((const step_job *)added->context)->force[i] - exact->force[i]));
            largest = fmax(largest, fabs(exact->force[i]));
        }
        added->error = error / largest;
    }
}
