/* task_batch.c: one item of a batch of 100 to 1,000,000 contacts of different loads that share 64 initialised ones, and of elements
   that share one: from cache-resident to memory-bound. A step is one of a period. */
#include "cases.h"

#include <math.h>

enum { KINDS = 64, REVERSALS = 8, PIECES = 16, MOST_ELEMENTS = 100000, HARMONICS = 1, SAMPLES = 64, N = 2 * HARMONICS + 1,
       STEPS = 16 /* of a period */ };

typedef struct { double stiffness, slip, force, tangent; } slider;
typedef struct {
    size_t items, elements, state_length, element_state_length;
    mslip_contact contacts[KINDS];
    mslip_element element;
    int32_t *kind, *first; /* indices of contacts, and of the element */
    slider *sliders;
    double *amplitude, *states, *element_states, *displacement[STEPS], *element_displacement[STEPS], *coefficients, *workspace;
    double *forces, *jacobians, *out[4];
} job;

static double complex_stiffness(void *context)
{
    const job *j = context;
    require(mslip_batch_complex_stiffness(j->items, KINDS, j->contacts, j->kind, NULL, j->amplitude, j->out[0], j->out[1],
                                          j->out[2], j->out[3]));
    return j->out[0][j->items - 1];
}

static double masing_update(void *context)
{
    const job *j = context;
    for (int k = 0; k < STEPS; ++k) {
        require(mslip_batch_masing_update(j->items, KINDS, j->contacts, j->kind, NULL, j->state_length, j->states,
                                          j->displacement[k], j->states, j->out[0], j->out[1], NULL));
    }
    return j->out[0][j->items - 1];
}

static double element_update(void *context)
{
    const job *j = context;
    for (int k = 0; k < STEPS; ++k) {
        require(mslip_batch_element_update(j->elements, 1, &j->element, j->first, NULL, j->element_state_length, j->element_states,
                                           j->element_displacement[k], j->element_states, j->forces, j->jacobians, NULL));
    }
    return j->forces[0];
}

static double harmonic_force(void *context)
{
    const job *j = context;
    require(mslip_batch_harmonic_force(j->items, KINDS, j->contacts, j->kind, NULL, j->workspace, j->coefficients, j->forces,
                                       j->jacobians, NULL));
    return j->forces[N * j->items - 1];
}

static double jenkins(void *context)
{
    job *j = context;
    for (int k = 0; k < STEPS; ++k) {
        const double *from = j->displacement[(k + STEPS - 1) % STEPS], *to = j->displacement[k];
        for (size_t i = 0; i < j->items; ++i) {
            slider *s = &j->sliders[i];
            jenkins_step(s->stiffness, s->slip, &s->force, to[i] - from[i], &s->tangent);
        }
    }
    return j->sliders[j->items - 1].force;
}

static job *job_of(const test_case *c, size_t n)
{
    const size_t length = mslip_harmonic_workspace_length(HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING);
    job *j = allocate(sizeof *j);
    *j = (job) { .items = n, .elements = n < MOST_ELEMENTS ? n : MOST_ELEMENTS, .state_length = mslip_state_length(REVERSALS),
                 .element_state_length = mslip_element_state_length(1, PIECES), .kind = allocate(n * sizeof(int32_t)),
                 .first = allocate(n * sizeof(int32_t)), .sliders = allocate(n * sizeof(slider)), .amplitude = doubles(n),
                 .coefficients = doubles(n * N), .workspace = doubles(length), .forces = doubles(n * N),
                 .jacobians = doubles(n * N * N), .out = { doubles(n), doubles(n), doubles(n), doubles(n) } };
    j->states = doubles(n * j->state_length);
    j->element_states = doubles(j->elements * j->element_state_length);
    require(mslip_harmonic_workspace_init(HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING, length, j->workspace));
    require(mslip_element_init(&c->parameters, 1, MSLIP_INPUT_APPROACH, &j->element));
    for (int i = 0; i < KINDS; ++i) {
        mslip_parameters p = c->parameters;
        p.normal_force *= 0.5 + (double)i / KINDS;
        require(mslip_contact_init(&p, &j->contacts[i]));
    }
    for (int k = 0; k < STEPS; ++k) {
        j->displacement[k] = doubles(n);
        j->element_displacement[k] = doubles(2 * j->elements);
        const double t = 2.0 * PI * k / STEPS;
        for (size_t i = 0; i < n; ++i) {
            j->displacement[k][i] = 0.7 * j->contacts[i % KINDS].slip_displacement * cos(t);
        }
        for (size_t i = 0; i < j->elements; ++i) {
            j->element_displacement[k][2 * i] = 0.15 * j->element.approach * sin(t);
            j->element_displacement[k][2 * i + 1] = j->element.approach * (0.6 + 0.3 * cos(t + 0.7));
        }
    }
    for (size_t i = 0; i < n; ++i) {
        const mslip_contact *contact = &j->contacts[i % KINDS];
        j->kind[i] = (int32_t)(i % KINDS);
        j->amplitude[i] = 0.7 * contact->slip_displacement;
        j->sliders[i] = (slider) { .stiffness = contact->initial_stiffness, .slip = 0.5 * contact->slip_force };
        j->coefficients[N * i + 1] = j->amplitude[i];
        require(mslip_state_init(j->state_length, j->states + j->state_length * i));
    }
    for (size_t i = 0; i < j->elements; ++i) {
        require(mslip_element_state_init(1, j->element_state_length, j->element_states + j->element_state_length * i));
    }
    return j;
}

void task_batch(const test_case *c, const extent *x)
{
    static const struct { const char *method; work *run; int steps; } functions[] = {
        { "mslip_batch_complex_stiffness", complex_stiffness, 1 }, { "mslip_batch_masing_update", masing_update, STEPS },
        { "mslip_batch_element_update", element_update, STEPS }, { "mslip_batch_harmonic_force", harmonic_force, 1 },
        { "spring-slider, one step", jenkins, STEPS } };
    for (int n = 100; n <= x->most_contacts; n *= 10) {
        const size_t first = entry_count, mark = memory_mark();
        job *j = job_of(c, (size_t)n);
        for (size_t k = 0; k < sizeof functions / sizeof *functions; ++k) {
            if (functions[k].run != element_update || n <= MOST_ELEMENTS) {
                const double items = (double)n * functions[k].steps;
                entry_add("batch", functions[k].method, functions[k].run, j, items)->parameter = n;
            }
        }
        entry_add_logarithm("batch")->parameter = n;
        measure(first, c->shape, 0.7, mark);
    }
}
