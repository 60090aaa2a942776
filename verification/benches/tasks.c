/* tasks.c: forces, stiffness and steps of single contacts, and batches. */
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
    double exact[FEW], value[2];
    for (int i = 0; i < POINTS; ++i) {
        points[i] = largest * (0.5 + 0.5 * (1 + i * 617 % POINTS) / POINTS); /* in irregular order */
    }
    for (int i = 0; i < FEW; ++i) {
        few[i] = points[i * STRIDE];
        truth(&c->parameters, "force", 1, &few[i], 2, value);
        exact[i] = value[0];
    }
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

static double run_element_init(void *parameters)
{
    static mslip_element element;
    require(mslip_element_init(parameters, 1, MSLIP_INPUT_APPROACH, &element));
    return element.approach;
}

void set_up_initialisation(const test_case *c, const extent *x, int k)
{
    double value[5];
    truth(&c->parameters, "contact", 0, NULL, 5, value);
    entry e = { .task = "initialisation", .method = "microslip", .run = run_contact_init, .items = 1 };
    entry_add(e, &c->parameters, sizeof c->parameters)->error = fabs(c->contact.slip_displacement / value[2] - 1.0);
    e.task = "initialisation of an element";
    e.run = run_element_init;
    entry_add(e, &c->parameters, sizeof c->parameters);
}

enum { AMPLITUDES = 16 };
typedef void stiffness(const void *law, double amplitude, double result[4]);
typedef struct {
    stiffness *stiffness; /* NULL: microslip */
    const void *law;
    int n;
    double amplitude[AMPLITUDES], out[AMPLITUDES][4];
    double real[AMPLITUDES], imaginary[AMPLITUDES], d_real[AMPLITUDES], d_imaginary[AMPLITUDES];
} stiffness_job;

static double run_stiffness(void *context)
{
    stiffness_job *j = context;
    const size_t n = (size_t)j->n;
    for (int i = 0; j->stiffness && i < j->n; ++i) {
        j->stiffness(j->law, j->amplitude[i], j->out[i]);
    }
    if (!j->stiffness) {
        mslip_complex_stiffness(j->law, n, j->amplitude, j->real, j->imaginary, j->d_real, j->d_imaginary);
    }
    return j->real[0] + j->out[0][0];
}

static void add_stiffness(const entry *e, double (*exact)[4], const char *method, double parameter, const stiffness_job *job)
{
    entry *added = entry_add(*e, job, sizeof *job);
    const stiffness_job *j = added->context;
    added->method = method;
    added->parameter = parameter;
    added->items = j->n;
    for (int i = 0; i < j->n; ++i) {
        const double own[4] = { j->real[i], j->imaginary[i], j->d_real[i], j->d_imaginary[i] };
        const double *got = j->stiffness ? j->out[i] : own, *k = exact[i], size = hypot(k[0], k[1]);
        added->error = fmax(added->error, hypot(got[0] - k[0], got[1] - k[1]) / size);
        added->error = fmax(added->error, hypot(got[2] - k[2], got[3] - k[3]) * j->amplitude[i] / size);
    }
}

void set_up_stiffness(const test_case *c, const extent *x, int a)
{
    enum { N = 8 };
    double exact[N][4];
    const entry e = { .task = "stiffness", .amplitude = x->amplitude[a], .run = run_stiffness };
    stiffness_job j = { .law = &c->contact, .n = N };
    for (int i = 0; i < N; ++i) {
        j.amplitude[i] = x->amplitude[a] * c->contact.slip_displacement * (1.0 - 0.05 * (i * 3 % N) / N);
        truth(&c->parameters, "stiffness", 1, &j.amplitude[i], 4, exact[i]);
    }
    add_stiffness(&e, exact, "microslip", 0.0, &j);
    j.stiffness = sliders_stiffness;
    for (int k = 0; k < BANKS && (int)c->bank[k].n <= x->most_sliders; ++k) {
        j.law = &c->bank[k];
        add_stiffness(&e, exact, k ? "sliders" : "spring-slider", k ? (double)c->bank[k].n : 0.0, &j);
    }
}

/* A call of one amplitude, in units of gross slip. */
static void add_amplitude(const test_case *c, const char *motion, double amplitude)
{
    const entry e = { .task = "stiffness", .motion = motion, .method = "microslip", .amplitude = amplitude, .run = run_stiffness,
                      .items = 1 };
    const stiffness_job j = { .law = &c->contact, .n = 1, .amplitude = { amplitude * c->contact.slip_displacement } };
    entry_add(e, &j, sizeof j);
}

void set_up_range(const test_case *c, const extent *x, int i)
{
    add_amplitude(c, "up to twice gross slip", 2.0 * (i + 1) / x->grid);
}

void set_up_near_slip(const test_case *c, const extent *x, int i)
{
    (void)x;
    add_amplitude(c, "near gross slip", 1.0 + (i % 2 ? 1.0 : -1.0) * pow(0.1, 1 + i / 2));
}

enum { STEPS = 1000, KNOWN = 200, REVERSALS = 64, MOST_SLIDERS = 4096 };
static double path[STEPS];

typedef struct {
    const mslip_contact *contact; /* NULL: sliders */
    const sliders *sliders;
    size_t state_length;
    int in_place;
    double states[2][6 + 3 * REVERSALS], forces[MOST_SLIDERS], force[STEPS], stiffness[STEPS];
} step_job;

static double run_steps(void *context)
{
    step_job *j = context;
    double *from = j->states[0], *to = j->states[j->in_place ? 0 : 1];
    mslip_state_init(j->state_length, from);
    for (int i = 0; i < STEPS; ++i) {
        mslip_masing_update(j->contact, j->state_length, from, path[i], to, &j->force[i], &j->stiffness[i], NULL);
        double *const next = from; /* a new state: as in an iteration, which keeps the one before the step */
        from = to;
        to = next;
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
    const size_t first = entry_count;
    entry e = { .task = "time step", .amplitude = x->amplitude[a], .items = STEPS };
    step_job *j = allocate(sizeof *j);
    double exact[KNOWN];
    for (int i = 0; i < STEPS; ++i) {
        const double t = 2.0 * PI * i / 40.0; /* two tones, 40 steps per period of the slower one */
        path[i] = size * (0.7 * sin(t) + 0.3 * sin(2.618034 * t + 0.5));
    }
    truth(&c->parameters, "masing", KNOWN, path, KNOWN, exact);
    *j = (step_job) { .contact = &c->contact, .state_length = mslip_state_length(REVERSALS) };
    e.run = run_steps;
    for (j->in_place = 1; j->in_place >= 0; --j->in_place) {
        e.method = j->in_place ? "microslip" : "microslip, new state";
        entry_add(e, j, sizeof *j);
    }
    e.run = run_slider_steps;
    const sliders jenkins = sliders_fitted(&c->contact, 1, size), *one = memcpy(allocate(sizeof jenkins), &jenkins, sizeof jenkins);
    for (int k = 0; k < BANKS && (int)c->bank[k].n <= x->most_sliders; ++k) {
        j->sliders = k ? &c->bank[k] : one;
        e.method = k ? "sliders" : "spring-slider";
        e.parameter = k ? (double)c->bank[k].n : 0.0;
        entry_add(e, j, sizeof *j);
    }
    for (entry *i = entries + first; i < entries + entry_count; ++i) {
        double largest = 0.0, error = 0.0;
        for (int k = 0; k < KNOWN; ++k) {
            error = fmax(error, fabs(((const step_job *)i->context)->force[k] - exact[k]));
            largest = fmax(largest, fabs(exact[k]));
        }
        i->error = error / largest;
    }
}

/* A batch of contacts of different loads that share 64 initialised ones, from cache-resident to memory-bound; steps of a period. */
enum { KINDS = 64, BATCH_REVERSALS = 8, BATCH_STEPS = 16 };
typedef struct { double stiffness, slip, force, tangent; } slider;
typedef struct {
    size_t items, state_length;
    mslip_contact *contacts;
    int32_t *kind; /* indices of contacts */
    slider *sliders;
    double *states, *displacement[BATCH_STEPS], *force, *stiffness;
} batch;

static double batch_update(void *context)
{
    const batch *j = context;
    for (int k = 0; k < BATCH_STEPS; ++k) {
        require(mslip_batch_masing_update(j->items, KINDS, j->contacts, j->kind, NULL, j->state_length, j->states,
                                          j->displacement[k], j->states, j->force, j->stiffness, NULL));
    }
    return j->force[j->items - 1];
}

static double batch_jenkins(void *context)
{
    const batch *j = context;
    for (int k = 0; k < BATCH_STEPS; ++k) {
        const double *from = j->displacement[(k + BATCH_STEPS - 1) % BATCH_STEPS], *to = j->displacement[k];
        for (size_t i = 0; i < j->items; ++i) {
            slider *s = &j->sliders[i];
            jenkins_step(s->stiffness, s->slip, &s->force, to[i] - from[i], &s->tangent);
        }
    }
    return j->sliders[j->items - 1].force;
}

void set_up_batch(const test_case *c, const extent *x, int decade)
{
    const size_t n = (size_t)(100.0 * pow(10.0, decade)), length = mslip_state_length(BATCH_REVERSALS);
    batch j = { .items = n, .state_length = length, .contacts = allocate(KINDS * sizeof(mslip_contact)),
                .states = doubles(n * length), .kind = allocate(n * sizeof(int32_t)), .sliders = allocate(n * sizeof(slider)),
                .force = doubles(n), .stiffness = doubles(n) };
    for (int i = 0; i < KINDS; ++i) {
        mslip_parameters p = c->parameters;
        p.normal_force *= 0.5 + (double)i / KINDS;
        require(mslip_contact_init(&p, &j.contacts[i]));
    }
    for (int k = 0; k < BATCH_STEPS; ++k) {
        j.displacement[k] = doubles(n);
        for (size_t i = 0; i < n; ++i) {
            j.displacement[k][i] = 0.7 * j.contacts[i % KINDS].slip_displacement * cos(2.0 * PI * k / BATCH_STEPS);
        }
    }
    for (size_t i = 0; i < n; ++i) {
        const mslip_contact *contact = &j.contacts[i % KINDS];
        j.kind[i] = (int32_t)(i % KINDS);
        j.sliders[i] = (slider) { .stiffness = contact->initial_stiffness, .slip = 0.5 * contact->slip_force };
        require(mslip_state_init(length, j.states + length * i));
    }
    entry e = { .task = "step of a batch", .method = "microslip", .amplitude = 0.7, .parameter = (double)n, .run = batch_update,
                .items = (double)n * BATCH_STEPS };
    entry_add(e, &j, sizeof j);
    e.method = "spring-slider";
    e.run = batch_jenkins;
    entry_add(e, &j, sizeof j);
}
