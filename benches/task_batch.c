/* task_batch.c: one item of a batch of 1 to 100,000 contacts, which differ in load: from cache-resident to memory-bound. */
#include "cases.h"


enum { KINDS = 64, REVERSALS = 8, HARMONICS = 1, SAMPLES = 64, N = 2 * HARMONICS + 1 };

typedef struct { double stiffness, slip, force, tangent; } element;
typedef struct {
    size_t items, state_length;
    int back; /* every run reverses every contact */
    mslip_contact *contacts;
    element *elements;
    double *amplitude, *states, *displacement[2], *coefficients, *workspace, *forces, *jacobians, *out[4];
} job;

static double complex_stiffness(void *context)
{
    const job *j = context;
    mslip_batch_complex_stiffness(j->items, j->items, j->contacts, NULL, NULL, j->amplitude, j->out[0], j->out[1], j->out[2],
                                  j->out[3]);
    return j->out[0][j->items - 1];
}

static double masing_update(void *context)
{
    job *j = context;
    j->back = !j->back;
    mslip_batch_masing_update(j->items, j->items, j->contacts, NULL, NULL, j->state_length, j->states,
                              j->displacement[j->back], j->states, j->out[0], j->out[1], NULL);
    return j->out[0][j->items - 1];
}

static double harmonic_force(void *context)
{
    const job *j = context;
    mslip_batch_harmonic_force(j->items, j->items, j->contacts, NULL, NULL, j->workspace, j->coefficients, j->forces,
                               j->jacobians, NULL);
    return j->forces[N * j->items - 1];
}

static double jenkins(void *context)
{
    job *j = context;
    j->back = !j->back;
    for (size_t i = 0; i < j->items; ++i) {
        const double du = j->displacement[j->back][i] - j->displacement[!j->back][i];
        jenkins_step(j->elements[i].stiffness, j->elements[i].slip, &j->elements[i].force, du, &j->elements[i].tangent);
    }
    return j->elements[j->items - 1].force;
}

static double *doubles(size_t n)
{
    return allocate(n * sizeof(double));
}

static job job_of(const test_case *c, size_t n)
{
    const size_t length = mslip_harmonic_workspace_length(HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING);
    const size_t state = mslip_state_length(REVERSALS);
    job j = { .items = n, .state_length = state, .contacts = allocate(n * sizeof(mslip_contact)),
              .elements = allocate(n * sizeof(element)), .amplitude = doubles(n), .states = doubles(n * state),
              .displacement = { doubles(n), doubles(n) }, .coefficients = doubles(n * N), .workspace = doubles(length),
              .forces = doubles(n * N), .jacobians = doubles(n * N * N),
              .out = { doubles(n), doubles(n), doubles(n), doubles(n) } };
    require(mslip_harmonic_workspace_init(HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING, length, j.workspace));
    for (size_t i = 0; i < n; ++i) {
        mslip_parameters p = c->parameters;
        p.normal_force *= 0.5 + (double)(i % KINDS) / KINDS;
        if (i < KINDS) {
            require(mslip_contact_init(&p, &j.contacts[i]));
        } else {
            j.contacts[i] = j.contacts[i % KINDS];
        }
        const mslip_contact *contact = &j.contacts[i];
        j.amplitude[i] = j.displacement[0][i] = 0.7 * contact->slip_displacement;
        j.displacement[1][i] = -0.5 * contact->slip_displacement;
        j.elements[i] = (element) { .stiffness = contact->initial_stiffness, .slip = 0.5 * contact->slip_force };
        j.coefficients[N * i + 1] = j.amplitude[i];
        require(mslip_state_init(state, j.states + state * i));
    }
    return j;
}

void task_batch(const test_case *c, const extent *x)
{
    static const struct { const char *method; work *run; } functions[] = {
        { "mslip_batch_complex_stiffness", complex_stiffness }, { "mslip_batch_masing_update", masing_update },
        { "mslip_batch_harmonic_force", harmonic_force }, { "spring-slider, one step", jenkins } };
    for (int n = 1; n <= x->most_contacts; n *= 10) {
        for (size_t k = 0; k < sizeof functions / sizeof *functions; ++k) {
            const size_t first = entry_count, mark = memory_mark();
            job *j = allocate(sizeof *j);
            *j = job_of(c, (size_t)n);
            entry_add("batch", functions[k].method, functions[k].run, j, n)->parameter = n;
            measure(first, c->shape, 0.7, mark);
        }
    }
}
