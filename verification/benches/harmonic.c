/* harmonic.c: harmonic force of a contact and of elements with one and two tangential directions, and steps of elements. */
#include "bench.h"

#include <math.h>
#include <string.h>

enum { MOST = 38, COMPARED = 128 }; /* coefficients; samples at which sliders are compared at equal samples */

typedef struct {
    const mslip_contact *contact;
    const mslip_element *element; /* instead of the contact */
    aft *aft;                     /* sliders, instead of both */
    double *workspace;
    int harmonics, blocks, jacobian_requested;
    double displacement[MOST], force[MOST], jacobian[MOST * MOST];
} job;

static double run(void *context)
{
    job *j = context;
    double *jacobian = j->jacobian_requested ? j->jacobian : NULL;
    if (j->aft) {
        sliders_harmonic(j->aft, j->displacement, j->force, jacobian);
    } else if (j->element) {
        mslip_element_harmonic_force(j->element, j->workspace, j->displacement, j->force, jacobian, NULL);
    } else {
        mslip_harmonic_force(j->contact, j->workspace, j->displacement, j->force, jacobian, NULL);
    }
    return j->force[1] + j->jacobian[1];
}

/* Error of the first harmonic of the tangential forces, relative to it. */
static double first_harmonic(const job *j, const double *exact)
{
    const int coefficients = 2 * j->harmonics + 1;
    double difference = 0.0, size = 0.0;
    for (int b = 0; b == 0 || b < j->blocks - 1; ++b) {
        for (int i = b * coefficients + 1; i <= b * coefficients + 2; ++i) {
            difference = hypot(difference, j->force[i] - exact[i]);
            size = hypot(size, exact[i]);
        }
    }
    return difference / size;
}

/* Largest difference between the Jacobian and central differences of the force, over the largest entry of the block of columns. */
static double jacobian_error(job j)
{
    const int c = 2 * j.harmonics + 1, n = j.blocks * c;
    double error = 0.0, largest = 0.0, difference = 0.0, forces[2][MOST];
    run(&j);
    j.jacobian_requested = 0;
    for (int k = 0; k < n; ++k) {
        const double middle = j.displacement[k], *block = j.displacement + k / c * c;
        const double h = 1e-7 * fmax(fabs(block[0]), hypot(block[1], block[2]));
        for (int side = 0; side < 2; ++side) {
            j.displacement[k] = side ? middle + h : middle - h;
            run(&j);
            memcpy(forces[side], j.force, sizeof j.force);
        }
        j.displacement[k] = middle;
        for (int i = 0; i < n; ++i) {
            const double exact = j.jacobian[i + k * n];
            largest = fmax(fabs(exact), k % c || i ? largest : 0.0);
            difference = fmax(fabs((forces[1][i] - forces[0][i]) / (2.0 * h) - exact), k % c || i ? difference : 0.0);
        }
        error = fmax(error, k % c == c - 1 ? difference / largest : 0.0);
    }
    return error;
}

static double *workspace_of(const job *j, int samples, int32_t rule)
{
    const size_t h = (size_t)j->harmonics, n = (size_t)samples, directions = (size_t)j->blocks - 1,
                 length = j->element ? mslip_element_workspace_length(directions, h, n, rule)
                                     : mslip_harmonic_workspace_length(h, n, rule);
    double *workspace = doubles(length);
    /* In the plane, as many periods as the sliders walk through. */
    require(j->element ? mslip_element_workspace_init(directions, h, n, rule, directions - 1, length, workspace)
                       : mslip_harmonic_workspace_init(h, n, rule, length, workspace));
    return workspace;
}

static void add(const entry *call, const char *method, double parameter, const job *j, const double *exact, const double *sums)
{
    entry e = *call;
    e.method = method;
    e.parameter = parameter;
    e.harmonics = j->harmonics;
    e.jacobian = j->jacobian_requested;
    e.run = run;
    e.items = 1;
    entry *added = entry_add(e, j, sizeof *j);
    added->error = first_harmonic(added->context, exact);
    added->sample_error = sums ? first_harmonic(added->context, sums) : -1.0;
    if (j->aft && j->jacobian_requested && e.samples == 64 && parameter <= 64.0) {
        check_below("Jacobian of spring-sliders by differences", jacobian_error(*j), 1e-6);
    }
}

/* Coefficients [mean, cos 1, sin 1, ...] of a motion with half range `size`, whose maximum lies a third of a step from a sample for
   every power of two. */
static void motion_of(int harmonics, double size, double *c)
{
    enum { SCAN = 1 << 12 };
    double low = 0.0, high = 0.0, top = 0.0;
    for (int i = 0; i < SCAN; ++i) {
        double u = 0.0;
        for (int k = 1; k <= harmonics; ++k) {
            u += cos(2.0 * PI * k * i / SCAN - 2.0 * k * k) / (k * k);
        }
        top = u > high ? 2.0 * PI * i / SCAN : top;
        low = fmin(low, u);
        high = fmax(high, u);
    }
    top = harmonics == 1 ? 2.0 : top; /* one harmonic: its phase */
    const double shift = 2.0 * PI / 3.0 - top;
    c[0] = 0.1 * size;
    for (int k = 1; k <= harmonics; ++k) {
        const double phase = 2.0 * k * k + k * shift, amplitude = size / (0.5 * (high - low)) / (k * k);
        c[2 * k - 1] = amplitude * cos(phase);
        c[2 * k] = amplitude * sin(phase);
    }
}

void set_up_harmonic(const test_case *t, const extent *x, int k)
{
    const double amplitude = x->amplitude[k / 3], size = amplitude * t->contact.slip_displacement;
    const sliders jenkins = sliders_fitted(&t->contact, 1, size);
    const int harmonics = 1 + k % 3 * 4, coefficients = 2 * harmonics + 1;
    double arguments[1 + MOST] = { 0.0 }, exact[MOST], sums[MOST];
    motion_of(harmonics, size, arguments + 1);
    truth(&t->parameters, "harmonic", 1 + coefficients, arguments, coefficients, exact);
    arguments[0] = COMPARED;
    truth(&t->parameters, "harmonic", 1 + coefficients, arguments, coefficients, sums);
    entry call = { .task = "harmonic", .amplitude = amplitude };
    for (call.samples = x->least_samples; call.samples <= x->most_samples; call.samples *= 2) {
        const int n = call.samples;
        job j = { .contact = &t->contact, .harmonics = harmonics, .blocks = 1 };
        memcpy(j.displacement, arguments + 1, sizeof(double) * (size_t)coefficients);
        for (; n > 2 * harmonics && j.jacobian_requested <= 1; ++j.jacobian_requested) {
            const double *at_samples = n == COMPARED ? sums : NULL;
            j.aft = NULL;
            j.workspace = workspace_of(&j, n, MSLIP_EVENT_DRIVEN);
            add(&call, "microslip event-driven", 0.0, &j, exact, at_samples);
            j.workspace = workspace_of(&j, n, MSLIP_UNIFORM_SAMPLING);
            add(&call, "microslip", 0.0, &j, exact, at_samples);
            for (int b = 0; b == 0 || (n == COMPARED && b < BANKS && (int)t->bank[b].n <= x->most_sliders); ++b) {
                const sliders *bank = b ? &t->bank[b] : &jenkins;
                j.aft = aft_of(1, 0.0, harmonics, n, bank);
                add(&call, b ? "sliders" : "spring-slider", b ? (double)bank->n : 0.0, &j, exact, at_samples);
            }
        }
    }
}

/* One direction. Amplitudes: u over mu S of the largest load, mean and swing of the approach over its largest value, and parts of
   the swing in phase with u and a quarter of a period later. */
static const struct { const char *name; double u, mean, swing, in_phase, quadrature; } line[LINE_MOTIONS] = {
    { "varying load", 0.2, 0.45, 0.35, 0.32, 0.7 },
    { "load varying by 5 %", 0.2, 0.45, 0.05, 0.32, 0.7 },
    { "in phase, half stuck", 0.2, 0.45, 0.35, 0.792, 0.1 },
    { "separation", 0.5, 0.35, 0.6, 0.32, 0.7 },
    { "gross slip", 1.2, 0.45, 0.35, 0.32, 0.7 },
    { "gross slip and separation", 1.2, 0.35, 0.6, 0.32, 0.7 },
    { "constant load", 0.3, 1.0, 0.0, 0.0, 0.0 },
};

static void line_motion(const test_case *t, const mslip_element *element, int motion, int harmonics, double *displacement)
{
    const double u = line[motion].u * t->contact.slip_displacement, w = element->approach;
    double *normal = displacement + 2 * harmonics + 1;
    displacement[0] = 0.03 * u;
    displacement[1] = u;
    displacement[2] = 0.11 * u;
    normal[0] = line[motion].mean * w;
    normal[1] = line[motion].in_phase * line[motion].swing * w;
    normal[2] = line[motion].quadrature * line[motion].swing * w;
    for (int k = 2; k <= harmonics; ++k) {
        displacement[2 * k - 1] = 0.3 * u / (k * k);
        displacement[2 * k] = -0.13 * u / (k * k);
        normal[2 * k - 1] = 0.1 * line[motion].swing * w / (k * k);
        normal[2 * k] = 0.07 * line[motion].swing * w / (k * k);
    }
}

/* Two directions. Amplitudes over the slip displacement of the mean load, the part of it along y, and the swing of the approach
   over its mean. */
static const struct { const char *name; double u, along_y, swing; } plane[PLANE_MOTIONS] = {
    { "circle, nearly stuck", 0.001, 1.0, 0.0 }, { "circle, 0.3", 0.3, 1.0, 0.0 }, { "circle, 0.6", 0.6, 1.0, 0.0 },
    { "circle, 0.9", 0.9, 1.0, 0.0 }, { "circle, gross slip", 1.3, 1.0, 0.0 },
    { "circle, varying load", 0.6, 1.0, 0.3 }, { "along x", 0.6, 0.0, 0.0 },
};
enum { VARYING_LOAD = 5 };

/* u, v, w at a phase, from the slip displacement and the approach of the mean load. */
static void plane_motion(int motion, double slip, double approach, double t, double *d)
{
    d[0] = plane[motion].u * slip * cos(t);
    d[1] = plane[motion].along_y * plane[motion].u * slip * sin(t);
    d[2] = approach * (1.0 + plane[motion].swing * cos(t - 1.0));
}

static const mslip_element *element_of(const test_case *t, int directions, double load)
{
    mslip_element *element = allocate(sizeof *element);
    mslip_parameters p = t->parameters;
    p.normal_force *= load;
    require(mslip_element_init(&p, directions, MSLIP_INPUT_APPROACH, element));
    return element;
}

/* Microslip and sliders at the same samples; errors are those against 16 times as many. */
static void add_elements(entry call, job j, const sliders *slider, const sliders *bank)
{
    const double normal_stiffness = j.element->normal_force / j.element->approach;
    job exact = j;
    exact.workspace = workspace_of(&j, 16 * call.samples, MSLIP_UNIFORM_SAMPLING);
    run(&exact);
    j.workspace = workspace_of(&j, call.samples, MSLIP_UNIFORM_SAMPLING);
    add(&call, "microslip", 0.0, &j, exact.force, NULL);
    for (; slider; slider = slider == bank ? NULL : bank) {
        j.aft = aft_of(j.blocks - 1, normal_stiffness, j.harmonics, call.samples, slider);
        add(&call, slider->n > 1 ? "sliders" : "spring-slider", slider->n > 1 ? (double)slider->n : 0.0, &j, exact.force, NULL);
    }
}

void set_up_element(const test_case *t, const extent *x, int motion)
{
    const mslip_element *element = element_of(t, 1, 1.0);
    const sliders slider = sliders_of(1, &element->tangential_stiffness, &element->friction_coefficient);
    for (int harmonics = 1; harmonics <= 9; harmonics += 4) {
        const entry call = { .task = "element", .motion = line[motion].name, .amplitude = line[motion].u,
                             .samples = harmonics < 5 ? 64 : harmonics < 9 ? 128 : 256 };
        for (int jacobian = 0; jacobian <= 1; ++jacobian) {
            job j = { .element = element, .harmonics = harmonics, .blocks = 2, .jacobian_requested = jacobian };
            line_motion(t, element, motion, harmonics, j.displacement);
            add_elements(call, j, &slider, NULL);
        }
    }
}

/* The circle with varying load. One spring-slider: with the K' and K'' of the contact at this amplitude and the mean load. 64: with
   its stiffness and friction, and slip displacements uniformly distributed from 0. */
void set_up_plane(const test_case *t, const extent *x, int k)
{
    enum { BANK = 64 };
    const mslip_element *element = element_of(t, 2, 1.6); /* the largest load of the swing */
    const double slip = t->contact.slip_displacement;
    double stiffness[BANK], friction[BANK], approach, one_stiffness, one_friction, at[2][3];
    require(mslip_normal_approach(element, 1, &t->parameters.normal_force, &approach, NULL, NULL));
    require(mslip_jenkins_equivalent(&t->contact, plane[VARYING_LOAD].u * slip, &one_stiffness, &one_friction));
    one_friction /= t->parameters.normal_force;
    for (int s = 0; s < BANK; ++s) {
        stiffness[s] = element->tangential_stiffness / BANK;
        friction[s] = (2 * s + 1) / (double)(BANK * BANK) * element->friction_coefficient;
    }
    const sliders one = sliders_of(1, &one_stiffness, &one_friction), bank = sliders_of(BANK, stiffness, friction);
    job j = { .element = element, .harmonics = 1 + 4 * k, .blocks = 3, .jacobian_requested = 1 };
    const int c = 2 * j.harmonics + 1;
    plane_motion(VARYING_LOAD, slip, approach, 0.0, at[0]);
    plane_motion(VARYING_LOAD, slip, approach, 0.5 * PI, at[1]);
    for (int m = 0; m < 3; ++m) {
        j.displacement[m * c] = m < 2 ? 0.0 : approach;
        j.displacement[m * c + 1] = at[0][m] - j.displacement[m * c];
        j.displacement[m * c + 2] = at[1][m] - j.displacement[m * c];
    }
    const entry call = { .task = "two directions", .motion = plane[VARYING_LOAD].name, .amplitude = plane[VARYING_LOAD].u,
                         .samples = 64 };
    add_elements(call, j, &one, &bank);
}

enum { STEPS = 256, PLANE_STEPS = 64 };

typedef struct {
    const mslip_element *element;
    size_t state_length;
    double stiffness, normal_stiffness; /* of the slider */
    double path[2 * STEPS], displacement[3], *from, *state, force[3], tangent[9];
    int tangent_requested;
} step_job;

static double run_steps(void *context)
{
    step_job *j = context;
    require(mslip_element_state_init(1, j->state_length, j->state));
    for (int i = 0; i < STEPS; ++i) {
        mslip_element_update(j->element, j->state_length, j->state, j->path + 2 * i, j->state, j->force, j->tangent, NULL);
    }
    return j->force[0] + j->tangent[0];
}

static double run_slider_steps(void *context)
{
    step_job *j = context;
    const double friction = j->element->friction_coefficient;
    double u = 0.0, force = 0.0, *tangent = j->tangent;
    for (int i = 0; i < STEPS; ++i) {
        const double w = j->path[2 * i + 1], load = w > 0.0 ? j->normal_stiffness * w : 0.0;
        jenkins_step(j->stiffness, friction * load, &force, j->path[2 * i] - u, &tangent[0]);
        u = j->path[2 * i];
        tangent[3] = w > 0.0 ? j->normal_stiffness : 0.0;
        tangent[2] = tangent[0] > 0.0 ? 0.0 : (force > 0.0 ? friction : -friction) * tangent[3];
    }
    return force + tangent[0] + tangent[2] + tangent[3];
}

void set_up_element_step(const test_case *t, const extent *x, int motion)
{
    const mslip_element *element = element_of(t, 1, 1.0);
    step_job j = { .element = element, .state_length = mslip_element_state_length(1, STEPS),
                   .stiffness = element->tangential_stiffness, .normal_stiffness = element->normal_force / element->approach };
    double d[6];
    line_motion(t, element, motion, 1, d);
    j.state = doubles(j.state_length);
    for (int i = 0; i < STEPS; ++i) {
        const double angle = 2.0 * PI * i / STEPS;
        j.path[2 * i] = d[0] + d[1] * cos(angle) + d[2] * sin(angle);
        j.path[2 * i + 1] = d[3] + d[4] * cos(angle) + d[5] * sin(angle);
    }
    entry e = { .task = "element step", .motion = line[motion].name, .method = "microslip", .amplitude = line[motion].u,
                .run = run_steps, .items = STEPS };
    entry_add(e, &j, sizeof j);
    e.method = "spring-slider";
    e.run = run_slider_steps;
    entry_add(e, &j, sizeof j);
}

static double run_step(void *context)
{
    step_job *j = context;
    double *tangent = j->tangent_requested ? j->tangent : NULL;
    mslip_element_update(j->element, j->state_length, j->from, j->displacement, j->state, j->force, tangent, NULL);
    return j->force[0] + j->tangent[0];
}

/* Each step of the second period, after the element is pressed. */
void set_up_plane_step(const test_case *t, const extent *x, int motion)
{
    const double slip = t->contact.slip_displacement;
    step_job j = { .element = element_of(t, 2, 1.6), .state_length = mslip_element_state_length(2, 0) };
    double approach, *now = doubles(j.state_length);
    require(mslip_normal_approach(j.element, 1, &t->parameters.normal_force, &approach, NULL, NULL));
    j.state = doubles(j.state_length);
    plane_motion(motion, 0.0, approach, 0.0, j.displacement);
    require(mslip_element_state_init(2, j.state_length, now));
    require(mslip_element_update(j.element, j.state_length, now, j.displacement, now, NULL, NULL, NULL));
    for (int i = 0; i < 2 * PLANE_STEPS; ++i) {
        plane_motion(motion, slip, approach, 2.0 * PI * (i + 1) / PLANE_STEPS, j.displacement);
        j.from = memcpy(doubles(j.state_length), now, j.state_length * sizeof *now);
        for (j.tangent_requested = 0; j.tangent_requested <= 1 && i >= PLANE_STEPS; ++j.tangent_requested) {
            entry_add((entry) { .task = "step in two directions", .motion = plane[motion].name, .method = "microslip",
                                .run = run_step, .amplitude = plane[motion].u, .jacobian = j.tangent_requested, .items = 1 },
                      &j, sizeof j);
        }
        require(mslip_element_update(j.element, j.state_length, now, j.displacement, now, NULL, NULL, NULL));
    }
}
