/* harmonic.c: harmonic force of a contact and of elements with one and two tangential directions. */
#include "bench.h"

#include <math.h>
#include <string.h>

/* Coefficients; samples of parallel sliders; nodes of a converged quadrature. */
enum { MOST = 38, COMPARED = 128, CONVERGED = 4096 };

typedef struct {
    const mslip_contact *contact;
    const mslip_element *element; /* instead of the contact */
    aft *aft;                     /* sliders, instead of both */
    double *workspace;
    int harmonics, blocks;
    double displacement[MOST], force[MOST], jacobian[MOST * MOST];
} job;

static double run(void *context)
{
    job *j = context;
    if (j->aft) {
        sliders_harmonic(j->aft, j->displacement, j->force, j->jacobian);
    } else if (j->element) {
        mslip_element_harmonic_force(j->element, j->workspace, j->displacement, j->force, j->jacobian, NULL, NULL);
    } else {
        mslip_harmonic_force(j->contact, j->workspace, j->displacement, j->force, j->jacobian, NULL);
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

static void add(const entry *call, const char *method, const job *j, const double *exact)
{
    entry e = *call;
    e.method = method;
    e.harmonics = j->harmonics;
    e.run = run;
    e.items = 1;
    entry *added = entry_add(e, j, sizeof *j);
    added->error = first_harmonic(added->context, exact);
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
    const int harmonics = 1 + k % 3 * 4;
    job exact = { .contact = &t->contact, .harmonics = harmonics, .blocks = 1 };
    motion_of(harmonics, size, exact.displacement);
    exact.workspace = workspace_of(&exact, CONVERGED, MSLIP_EVENT_DRIVEN);
    run(&exact);
    entry call = { .task = "harmonic", .amplitude = amplitude };
    for (int n = x->least_samples; n <= x->most_samples; n *= 2) {
        if (n <= 2 * harmonics) {
            continue;
        }
        call.samples = n;
        job j = exact;
        j.workspace = workspace_of(&j, n, MSLIP_EVENT_DRIVEN);
        add(&call, "microslip event-driven", &j, exact.force);
        j.workspace = workspace_of(&j, n, MSLIP_UNIFORM_SAMPLING);
        add(&call, "microslip", &j, exact.force);
        for (int b = 0; b == 0 || (n == COMPARED && b < BANKS && (int)t->bank[b].n <= x->most_sliders); ++b) {
            j.aft = aft_of(1, 0.0, harmonics, n, b ? &t->bank[b] : &jenkins);
            add(&call, b ? "sliders" : "spring-slider", &j, exact.force);
        }
    }
}

static const mslip_element *element_of(const test_case *t, int directions, double load)
{
    mslip_element *element = allocate(sizeof *element);
    mslip_parameters p = t->parameters;
    p.normal_force *= load;
    require(mslip_element_init(&p, directions, MSLIP_INPUT_APPROACH, element));
    return element;
}

/* Microslip and a slider at the same samples; errors are those against 16 times as many. */
static void add_elements(entry call, job j, const sliders *slider)
{
    const double normal_stiffness = j.element->normal_force / j.element->approach;
    job exact = j;
    exact.workspace = workspace_of(&j, 16 * call.samples, MSLIP_UNIFORM_SAMPLING);
    run(&exact);
    j.workspace = workspace_of(&j, call.samples, MSLIP_UNIFORM_SAMPLING);
    add(&call, "microslip", &j, exact.force);
    j.aft = aft_of(j.blocks - 1, normal_stiffness, j.harmonics, call.samples, slider);
    add(&call, "spring-slider", &j, exact.force);
}

/* Coefficients of the first harmonic in one direction: the displacements u and w of an element with this approach. */
static void first_harmonic_of(double u, double approach, double *c, int harmonics)
{
    const double normal[] = { 0.45 * approach, 0.32 * 0.35 * approach, 0.7 * 0.35 * approach };
    const double tangential[] = { 0.03 * u, u, 0.11 * u };
    memcpy(c, tangential, sizeof tangential);
    memcpy(c + 2 * harmonics + 1, normal, sizeof normal);
}

/* A face whose pressure varies along the length by 50 %: one element for each row of pairs of nodes. */
enum { ROWS = 10, PAIRS = 5, PER_ROW = 6 };
typedef struct {
    mslip_element *elements;
    double *workspace;
    double weight[ROWS][PAIRS], displacement[ROWS][PAIRS][PER_ROW], force[ROWS][PAIRS][PER_ROW];
    double motion[ROWS][PER_ROW], force_of_row[ROWS][PER_ROW], jacobian[ROWS][PER_ROW * PER_ROW];
} face;

static double run_face(void *context)
{
    face *f = context;
    for (int i = 0; i < ROWS; ++i) {
        for (int k = 0; k < PER_ROW; ++k) {
            f->motion[i][k] = 0.0;
            for (int j = 0; j < PAIRS; ++j) {
                f->motion[i][k] += f->weight[i][j] * f->displacement[i][j][k];
            }
        }
    }
    mslip_batch_element_harmonic_force(ROWS, ROWS, f->elements, NULL, NULL, f->workspace, *f->motion, *f->force_of_row, *f->jacobian,
                                       NULL, NULL, NULL);
    for (int i = 0; i < ROWS; ++i) {
        for (int j = 0; j < PAIRS; ++j) {
            for (int k = 0; k < PER_ROW; ++k) {
                f->force[i][j][k] = f->weight[i][j] * f->force_of_row[i][k];
            }
        }
    }
    return f->force[ROWS - 1][0][1] + f->jacobian[0][1];
}

void set_up_face(const test_case *t, const extent *x, int k)
{
    face f = { .elements = allocate(ROWS * sizeof *f.elements) };
    double area[ROWS][PAIRS], pressure[ROWS][PAIRS];
    mslip_parameters rows[ROWS];
    for (int i = 0; i < ROWS; ++i) {
        for (int j = 0; j < PAIRS; ++j) {
            area[i][j] = 1.0 / (ROWS * PAIRS);
            pressure[i][j] = t->parameters.normal_force * (1.0 + 0.5 * (2 * i + 1 - ROWS) / ROWS);
        }
    }
    require(mslip_face_parts(&t->parameters, ROWS, PAIRS, *area, *pressure, rows, *f.weight));
    for (int i = 0; i < ROWS; ++i) {
        require(mslip_element_init(&rows[i], 1, MSLIP_INPUT_APPROACH, &f.elements[i]));
        for (int j = 0; j < PAIRS; ++j) {
            first_harmonic_of(0.2 * t->contact.slip_displacement, f.elements[i].approach, f.displacement[i][j], 1);
        }
    }
    const job j = { .element = f.elements, .harmonics = 1, .blocks = 2 };
    f.workspace = workspace_of(&j, 64, MSLIP_UNIFORM_SAMPLING);
    entry_add((entry) { .task = "face", .method = "microslip", .amplitude = 0.2, .harmonics = 1, .samples = 64, .run = run_face,
                        .items = 1 }, &f, sizeof f);
}

/* Microslip in one direction under a load that varies, with a phase. */
void set_up_element(const test_case *t, const extent *x, int k)
{
    const mslip_element *element = element_of(t, 1, 1.0);
    const sliders slider = sliders_of(1, &element->tangential_stiffness, &element->friction_coefficient);
    const double u = 0.2 * t->contact.slip_displacement, w = element->approach, swing = 0.35 * w;
    for (int harmonics = 1; harmonics <= 9; harmonics += 4) {
        const entry call = { .task = "element", .amplitude = 0.2, .samples = harmonics < 5 ? 64 : harmonics < 9 ? 128 : 256 };
        job j = { .element = element, .harmonics = harmonics, .blocks = 2 };
        double *tangential = j.displacement, *normal = tangential + 2 * harmonics + 1;
        first_harmonic_of(u, w, j.displacement, harmonics);
        for (int h = 2; h <= harmonics; ++h) {
            tangential[2 * h - 1] = 0.3 * u / (h * h);
            tangential[2 * h] = -0.13 * u / (h * h);
            normal[2 * h - 1] = 0.1 * swing / (h * h);
            normal[2 * h] = 0.07 * swing / (h * h);
        }
        add_elements(call, j, &slider);
    }
}

/* A circle in the plane under a load that varies by 30 %, beside the spring-slider with the K' and K'' of the contact at this amplitude
   and the mean load. */
void set_up_plane(const test_case *t, const extent *x, int k)
{
    const mslip_element *element = element_of(t, 2, 1.6); /* the largest load */
    const double amplitude = 0.6 * t->contact.slip_displacement;
    double approach, stiffness, friction;
    require(mslip_normal_approach(element, 1, &t->parameters.normal_force, &approach, NULL, NULL));
    require(mslip_jenkins_equivalent(&t->contact, amplitude, &stiffness, &friction));
    friction /= t->parameters.normal_force;
    const sliders one = sliders_of(1, &stiffness, &friction);
    job j = { .element = element, .harmonics = 1 + 4 * k, .blocks = 3 };
    const int c = 2 * j.harmonics + 1;
    j.displacement[1] = amplitude;
    j.displacement[c + 2] = amplitude;
    j.displacement[2 * c] = approach;
    j.displacement[2 * c + 1] = 0.3 * approach * cos(1.0);
    j.displacement[2 * c + 2] = 0.3 * approach * sin(1.0);
    add_elements((entry) { .task = "two directions", .amplitude = 0.6, .samples = 64 }, j, &one);
}
