/* task_two_directions.c: steps and harmonic force of an element with two tangential directions; the latter against one spring-slider
 * and a bank of spring-sliders with a varying limit in the plane, by radial return:
 *
 *   P = T_{n-1} + k_j (u_n - u_{n-1}),   T_n = P if |P| <= mu_j N_n, otherwise mu_j N_n P / |P|,   N_n = max(0, k_n w_n)
 *
 * The derivatives of T with respect to all coefficients of u, v, w are advanced with it through two periods; the second one counts. */
#include "cases.h"

#include <math.h>
#include <string.h>

enum { STEPS = 64, SPRINGS = 64, ROW = 11, COLUMNS = 3 * ROW };

/* Amplitudes over the slip displacement of the mean load, the part of it along y, and the swing of the approach over its mean. */
static const struct { const char *name; double u, along_y, swing; } motions[] = {
    { "circle, nearly stuck", 0.001, 1.0, 0.0 }, { "circle", 0.3, 1.0, 0.0 }, { "circle", 0.6, 1.0, 0.0 }, { "circle", 0.9, 1.0, 0.0 },
    { "circle, gross slip", 1.3, 1.0, 0.0 }, { "circle, varying load", 0.6, 1.0, 0.3 }, { "along x", 0.6, 0.0, 0.0 },
};
enum { MOTIONS = sizeof motions / sizeof *motions, VARYING_LOAD = 5 };

typedef struct { double force[2], derivative[2][COLUMNS]; } spring;

typedef struct {
    const mslip_element *element;
    int harmonics, springs, tangent_requested; /* springs = 0: microslip */
    int step;                                  /* of a period, or all if negative */
    size_t state_length;
    double *workspace, *states, *state, *path;
    double stiffness, friction, normal_stiffness, (*rows)[ROW]; /* 1, cos t, sin t, ... */
    spring *bank;
    double displacement[COLUMNS], force[COLUMNS], tangent[9], *jacobian;
} job;

/* Columns of the derivatives: c coefficients each of u, v and w. */
static void advance(spring *s, double k, double friction, int c, const double motion[2], const double *change, double load,
                    const double *load_change)
{
    double *x = s->derivative[0], *y = s->derivative[1];
    const double trial[2] = { s->force[0] + k * motion[0], s->force[1] + k * motion[1] }, limit = friction * load;
    const double size = sqrt(trial[0] * trial[0] + trial[1] * trial[1]), part = size <= limit ? 1.0 : limit / size;
    for (int j = 0; j < c; ++j) {
        x[j] += k * change[j];
        y[c + j] += k * change[j];
    }
    s->force[0] = part * trial[0];
    s->force[1] = part * trial[1];
    if (size <= limit) {
        return;
    }
    const double e[2] = { trial[0] / size, trial[1] / size };
    for (int j = 0; j < 3 * c; ++j) {
        const double across = part * (e[0] * y[j] - e[1] * x[j]);
        x[j] = -e[1] * across;
        y[j] = e[0] * across;
    }
    for (int j = 0; j < c; ++j) {
        x[2 * c + j] += e[0] * friction * load_change[j];
        y[2 * c + j] += e[1] * friction * load_change[j];
    }
}

static void bank_harmonic_force(job *b)
{
    const int c = 2 * b->harmonics + 1, n = 3 * c;
    const double *d = b->displacement;
    double before[2] = { 0.0, 0.0 }, row_before[ROW] = { 0.0 }, transposed[COLUMNS * COLUMNS] = { 0.0 };
    memset(b->bank, 0, (size_t)b->springs * sizeof *b->bank);
    memset(b->force, 0, sizeof b->force);
    for (int i = 0; i < 2 * STEPS; ++i) {
        const double *row = b->rows[i % STEPS];
        double now[3] = { 0.0 }, motion[2], change[ROW], load_change[ROW], sum[3] = { 0.0 }, derivative[3][COLUMNS] = { { 0.0 } };
        for (int j = 0; j < c; ++j) {
            for (int m = 0; m < 3; ++m) {
                now[m] += row[j] * d[m * c + j];
            }
        }
        for (int j = 0; j < c; ++j) {
            change[j] = row[j] - row_before[j];
            row_before[j] = row[j];
            load_change[j] = derivative[2][2 * c + j] = now[2] > 0.0 ? b->normal_stiffness * row[j] : 0.0;
        }
        for (int m = 0; m < 2; ++m) {
            motion[m] = now[m] - before[m];
            before[m] = now[m];
        }
        const double load = sum[2] = fmax(0.0, b->normal_stiffness * now[2]);
        for (int s = 0; s < b->springs; ++s) { /* slip displacements uniformly distributed from 0 */
            const double weight = (2 * s + 1) / (double)(b->springs * b->springs);
            advance(b->bank + s, b->stiffness / b->springs, weight * b->friction, c, motion, change, load, load_change);
            for (int m = 0; m < 2 && i >= STEPS; ++m) {
                sum[m] += b->bank[s].force[m];
                for (int j = 0; j < n; ++j) {
                    derivative[m][j] += b->bank[s].derivative[m][j];
                }
            }
        }
        for (int m = 0; m < 3 && i >= STEPS; ++m) {
            for (int k = 0; k < c; ++k) {
                const double factor = (k ? 2.0 : 1.0) / STEPS * row[k];
                double *to = transposed + (m * c + k) * n;
                b->force[m * c + k] += factor * sum[m];
                for (int j = 0; j < n; ++j) {
                    to[j] += factor * derivative[m][j];
                }
            }
        }
    }
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            b->jacobian[i + j * n] = transposed[i * n + j];
        }
    }
}

static double run_harmonic(void *context)
{
    job *j = context;
    if (j->springs) {
        bank_harmonic_force(j);
    } else {
        mslip_element_harmonic_force(j->element, j->workspace, j->displacement, j->force, j->tangent_requested ? j->jacobian : NULL, NULL);
    }
    return j->force[1] + j->jacobian[1];
}

static double run_steps(void *context)
{
    job *j = context;
    const int one = j->step >= 0, first = one ? j->step : 0, end = one ? first + 1 : STEPS;
    double *tangent = j->tangent_requested ? j->tangent : NULL;
    for (int i = first; i < end; ++i) {
        const double *from = one || i == 0 ? j->states + (size_t)i * j->state_length : j->state;
        mslip_element_update(j->element, j->state_length, from, j->path + 3 * i, j->state, j->force, tangent, NULL);
    }
    return j->force[0] + j->tangent[0];
}

static job *add(const char *task, const char *method, work *work, const job *prototype, int motion)
{
    job *kept = allocate(sizeof *kept);
    *kept = *prototype;
    entry *e = entry_add(task, method, work, kept, work == run_steps && kept->step < 0 ? STEPS : 1);
    e->harmonics = kept->harmonics;
    e->samples = kept->harmonics ? STEPS : 0;
    e->jacobian = kept->tangent_requested;
    e->parameter = motion;
    work(kept);
    return kept;
}

/* u, v, w at a phase, from the slip displacement and the approach of the mean load. */
static void displacement_at(int motion, double slip, double approach, double t, double *d)
{
    d[0] = motions[motion].u * slip * cos(t);
    d[1] = motions[motion].along_y * motions[motion].u * slip * sin(t);
    d[2] = approach * (1.0 + motions[motion].swing * cos(t - 1.0));
}

static void add_steps(const mslip_element *element, int motion, double slip, double approach)
{
    job j = { .element = element, .step = -1, .state_length = mslip_element_state_length(2, 0) };
    const size_t length = j.state_length;
    j.states = allocate((STEPS + 1) * length * sizeof *j.states);
    j.state = allocate(length * sizeof *j.state);
    j.path = allocate(3 * STEPS * sizeof *j.path);
    for (int i = 0; i < STEPS; ++i) {
        displacement_at(motion, slip, approach, 2.0 * PI * (i + 1) / STEPS, j.path + 3 * i);
    }
    /* Pressed first; then two periods, of which the states before the steps of the second are kept. */
    double pressed[3];
    displacement_at(motion, 0.0, approach, 0.0, pressed);
    require(mslip_element_state_init(2, length, j.state));
    require(mslip_element_update(element, length, j.state, pressed, j.state, NULL, NULL, NULL));
    for (int i = 0; i < 2 * STEPS; ++i) {
        memcpy(j.states + (size_t)(i % STEPS) * length, j.state, length * sizeof *j.state);
        require(mslip_element_update(element, length, j.state, j.path + 3 * (i % STEPS), j.state, NULL, NULL, NULL));
    }
    for (int tangent = 0; tangent <= 1; ++tangent) {
        j.tangent_requested = tangent;
        for (j.step = 0; j.step < STEPS; ++j.step) {
            add("two directions step", "microslip, one step", run_steps, &j, motion);
        }
        j.step = -1;
        add("two directions step", "microslip", run_steps, &j, motion);
    }
}

/* Largest difference between the Jacobian and central differences of the force, over the largest entry of its column. */
static double jacobian_error(job *b)
{
    const int n = 3 * (2 * b->harmonics + 1);
    static double exact[COLUMNS * COLUMNS];
    double error = 0.0;
    memcpy(exact, b->jacobian, (size_t)(n * n) * sizeof *exact);
    for (int j = 0; j < n; ++j) {
        const double middle = b->displacement[j], h = 1e-6 * fabs(b->displacement[j / (n / 3) < 2 ? 1 : 2 * n / 3]);
        double forces[2][COLUMNS], largest = 0.0, difference = 0.0;
        for (int side = 0; side < 2; ++side) {
            b->displacement[j] = side ? middle + h : middle - h;
            bank_harmonic_force(b);
            memcpy(forces[side], b->force, sizeof b->force);
        }
        b->displacement[j] = middle;
        for (int i = 0; i < n; ++i) {
            largest = fmax(largest, fabs(exact[i + j * n]));
            difference = fmax(difference, fabs((forces[1][i] - forces[0][i]) / (2.0 * h) - exact[i + j * n]));
        }
        error = fmax(error, difference / largest);
    }
    bank_harmonic_force(b);
    return error;
}

static double *workspace_of(int harmonics, int samples)
{
    const size_t h = (size_t)harmonics, s = (size_t)samples,
                 length = mslip_element_workspace_length(2, h, s, MSLIP_UNIFORM_SAMPLING);
    double *workspace = allocate(length * sizeof *workspace);
    /* As many periods as the points are walked through. */
    require(mslip_element_workspace_init(2, h, s, MSLIP_UNIFORM_SAMPLING, 1, length, workspace));
    return workspace;
}

/* The circle with varying load. */
static job harmonic_job(const mslip_element *element, int harmonics, double slip, double approach)
{
    job j = { .element = element, .harmonics = harmonics, .tangent_requested = 1, .normal_stiffness = element->normal_force / element->approach };
    const int c = 2 * harmonics + 1;
    j.rows = allocate(STEPS * sizeof *j.rows);
    j.bank = allocate(SPRINGS * sizeof *j.bank);
    j.jacobian = allocate(COLUMNS * COLUMNS * sizeof *j.jacobian);
    j.workspace = workspace_of(harmonics, STEPS);
    for (int m = 0; m < 3; ++m) {
        double at[2][3];
        displacement_at(VARYING_LOAD, slip, approach, 0.0, at[0]);
        displacement_at(VARYING_LOAD, slip, approach, 0.5 * PI, at[1]);
        const double mean = m < 2 ? 0.0 : approach;
        j.displacement[m * c] = mean;
        j.displacement[m * c + 1] = at[0][m] - mean;
        j.displacement[m * c + 2] = at[1][m] - mean;
    }
    for (int i = 0; i < STEPS; ++i) {
        j.rows[i][0] = 1.0;
        for (int k = 1; k <= harmonics; ++k) {
            j.rows[i][2 * k - 1] = cos(2.0 * PI * (k * i % STEPS) / STEPS);
            j.rows[i][2 * k] = sin(2.0 * PI * (k * i % STEPS) / STEPS);
        }
    }
    return j;
}

/* Errors are those against 16 times as many samples. One spring-slider: with the K' and K'' of the contact at this amplitude and the mean load. 64: with its stiffness and friction. */
static void add_harmonic(const mslip_element *element, const mslip_contact *contact, int harmonics, double slip, double approach)
{
    job j = harmonic_job(element, harmonics, slip, approach), exact = j;
    exact.workspace = workspace_of(harmonics, 16 * STEPS);
    run_harmonic(&exact);
    const size_t first = entry_count;
    add("two directions harmonic", "microslip", run_harmonic, &j, VARYING_LOAD);
    require(mslip_jenkins_equivalent(contact, motions[VARYING_LOAD].u * slip, &j.stiffness, &j.friction));
    j.friction /= contact->slip_force / element->friction_coefficient;
    for (j.springs = 1; j.springs <= SPRINGS; j.springs *= SPRINGS) {
        const char *method = j.springs > 1 ? "64 spring-sliders" : "spring-slider";
        job *bank = add("two directions harmonic", method, run_harmonic, &j, VARYING_LOAD);
        check_below("Jacobian of spring-sliders in the plane, by differences", jacobian_error(bank), 1e-6);
        j.stiffness = element->tangential_stiffness;
        j.friction = element->friction_coefficient;
    }
    for (entry *e = entries + first; e < entries + entry_count; ++e) {
        e->error = first_harmonic_error(((const job *)e->context)->force, exact.force, 2, 2 * harmonics + 1);
    }
}

void task_two_directions(const test_case *c, const extent *x)
{
    (void)x;
    static mslip_element of_contact;
    const mslip_element *element = &of_contact;
    mslip_parameters p = c->parameters;
    p.normal_force *= 1.6; /* the largest load of the swing */
    require(mslip_element_init(&p, 2, MSLIP_INPUT_APPROACH, &of_contact));
    const double slip = c->contact.slip_displacement;
    double approach;
    require(mslip_normal_approach(element, 1, &c->parameters.normal_force, &approach, NULL, NULL));
    for (int motion = 0; motion < MOTIONS; ++motion) {
        const size_t first = entry_count, mark = memory_mark();
        add_steps(element, motion, slip, approach);
        for (int h = 1; h <= 5 && motion == VARYING_LOAD; h += 4) {
            add_harmonic(element, &c->contact, h, slip, approach);
        }
        measure(first, c->shape, motions[motion].u, mark);
    }
}

const char *two_directions_motion(int motion)
{
    return motion < MOTIONS ? motions[motion].name : NULL;
}
