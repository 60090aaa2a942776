/* task_many.c: the cost of one item in a batch of 1 to 100,000, whose contacts differ in load. */
#include "measure.h"
#include "tasks.h"

#include <stdlib.h>
#include <string.h>

enum { KINDS = 64, STATE = 8, HARMONICS = 1, SAMPLES = 64, COEFFICIENTS = 2 * HARMONICS + 1 };

static size_t most, state_length;
static mslip_contact *contacts;
static double *amplitude, *out[4], *states, *displacement[2], *coefficients, *jacobians, *forces, *workspace;
static struct { double stiffness, slip, force, tangent; } *elements; /* spring-sliders */

typedef struct { size_t n; int back; } job;

static double complex_stiffness(void *context)
{
    const job *j = context;
    mslip_batch_complex_stiffness(j->n, j->n, contacts, NULL, NULL, amplitude, out[0], out[1], out[2], out[3]);
    return out[0][j->n - 1];
}

/* Back and forth: every run reverses every contact. */
static double masing_update(void *context)
{
    job *j = context;
    j->back = !j->back;
    mslip_batch_masing_update(j->n, j->n, contacts, NULL, NULL, state_length, states, displacement[j->back], states, out[0],
                              out[1], NULL);
    return out[0][j->n - 1];
}

static double harmonic_force(void *context)
{
    const job *j = context;
    mslip_batch_harmonic_force(j->n, j->n, contacts, NULL, NULL, workspace, coefficients, forces, jacobians, NULL);
    return forces[COEFFICIENTS * j->n - 1];
}

static double jenkins(void *context)
{
    job *j = context;
    j->back = !j->back;
    for (size_t i = 0; i < j->n; ++i) {
        const double du = displacement[j->back][i] - displacement[!j->back][i];
        jenkins_step(elements[i].stiffness, elements[i].slip, &elements[i].force, du, &elements[i].tangent);
    }
    return elements[j->n - 1].force;
}

static void allocate(const subject *s)
{
    const size_t workspace_length = mslip_harmonic_workspace_length(HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING);
    mslip_contact kind[KINDS];
    for (int i = 0; i < KINDS; ++i) {
        mslip_parameters p = s->parameters;
        p.normal_force *= 0.5 + (double)i / KINDS;
        succeed(mslip_contact_init(&p, &kind[i]));
    }
    state_length = mslip_state_length(STATE);
    contacts = malloc(most * sizeof *contacts);
    elements = calloc(most, sizeof *elements);
    amplitude = malloc(most * sizeof(double));
    states = malloc(most * state_length * sizeof(double));
    coefficients = malloc(most * COEFFICIENTS * sizeof(double));
    forces = malloc(most * COEFFICIENTS * sizeof(double));
    jacobians = malloc(most * COEFFICIENTS * COEFFICIENTS * sizeof(double));
    workspace = malloc(workspace_length * sizeof(double));
    succeed(mslip_harmonic_workspace_init(HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING, workspace_length, workspace));
    for (int i = 0; i < 4; ++i) {
        out[i] = calloc(most, sizeof(double));
    }
    for (int i = 0; i < 2; ++i) {
        displacement[i] = malloc(most * sizeof(double));
    }
    for (size_t i = 0; i < most; ++i) {
        contacts[i] = kind[i % KINDS];
        const double slip = contacts[i].slip_displacement;
        amplitude[i] = 0.7 * slip;
        displacement[0][i] = 0.7 * slip;
        displacement[1][i] = -0.5 * slip;
        elements[i].stiffness = contacts[i].initial_stiffness;
        elements[i].slip = 0.5 * contacts[i].slip_force;
        motion_of(HARMONICS, 0.7 * slip, coefficients + COEFFICIENTS * i);
        succeed(mslip_state_init(state_length, states + state_length * i));
    }
}

static void release(void)
{
    double *const arrays[] = { amplitude, out[0], out[1], out[2], out[3], states, displacement[0], displacement[1],
                               coefficients, jacobians, forces, workspace };
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; ++i) {
        free(arrays[i]);
    }
    free(contacts);
    free(elements);
}

static void add(const char *method, work *run, size_t n)
{
    job *j = context_of(sizeof *j);
    j->n = n;
    entry *e = entry_add("many", method, run, j, (double)n);
    e->parameter = (double)n;
    e->is_yardstick = run == jenkins;
    e->harmonics = run == harmonic_force ? HARMONICS : 0;
    e->samples = run == harmonic_force ? SAMPLES : 0;
    e->jacobian = run == harmonic_force;
}

void task_many(const subject *s, const extent *x)
{
    const size_t first = entry_count;
    most = x->most_contacts;
    allocate(s);
    for (size_t n = 1; n <= most; n *= 10) {
        for (size_t part = 1; part <= 3 && part * n <= most; part += 2) {
            add("batch_complex_stiffness", complex_stiffness, part * n);
            add("batch_masing_update", masing_update, part * n);
            add("batch_harmonic_force", harmonic_force, part * n);
            add("Jenkins step", jenkins, part * n);
        }
    }
    for (size_t i = first; i < entry_count; ++i) {
        entries[i].shape = s->shape;
        entries[i].amplitude = 0.7;
    }
    measure(first);
    release();
}
