/* task_stiffness.c: complex stiffness K' + iK'' with both derivatives with respect to the amplitude. */
#include "cases.h"

#include <math.h>

enum { POINTS = 8, FEW = 2, GRID = 200 };
static double points[POINTS], exact[POINTS][4];

typedef void stiffness(const void *law, double amplitude, double result[4]);
typedef struct { stiffness *stiffness; const void *law; int n; } job;

static void microslip_stiffness(const void *contact, double amplitude, double result[4])
{
    mslip_complex_stiffness(contact, 1, &amplitude, &result[0], &result[1], &result[2], &result[3]);
}

static double run(void *context)
{
    const job *j = context;
    double result[4], sum = 0.0;
    for (int i = 0; i < j->n; ++i) {
        j->stiffness(j->law, points[i], result);
        sum += result[0] + result[1] + result[2] + result[3];
    }
    return sum;
}

static double run_microslip(void *context)
{
    const job *j = context;
    double out[4][POINTS];
    mslip_complex_stiffness(j->law, POINTS, points, out[0], out[1], out[2], out[3]);
    return out[0][0] + out[1][1] + out[2][2] + out[3][3];
}

static entry *add(const char *method, stiffness *stiffness, const void *law, double parameter, int n)
{
    job *j = allocate(sizeof *j);
    *j = (job) { stiffness, law, n };
    entry *e = entry_add("stiffness", method, run, j, n);
    e->parameter = parameter;
    e->error = 0.0;
    for (int i = 0; i < n; ++i) {
        double got[4];
        const double *k = exact[i], size = hypot(k[0], k[1]);
        stiffness(law, points[i], got);
        e->error = fmax(e->error, hypot(got[0] - k[0], got[1] - k[1]) / size);
        e->error = fmax(e->error, hypot(got[2] - k[2], got[3] - k[3]) * points[i] / size);
    }
    return e;
}

/* Amplitudes of one call: one, or for the table some of a range. */
enum { BLOCK = 16 };
typedef struct { const mslip_contact *contact; const double *table; int n; double amplitude[BLOCK]; } call;

static double run_call(void *context)
{
    const call *k = context;
    double out[4][BLOCK];
    if (k->table) {
        mslip_complex_stiffness_tabulated(k->contact, k->table, k->n, k->amplitude, out[0], out[1], out[2], out[3]);
    } else {
        mslip_complex_stiffness(k->contact, k->n, k->amplitude, out[0], out[1], out[2], out[3]);
    }
    return out[0][0] + out[1][0] + out[2][0] + out[3][0];
}

typedef struct { const mslip_contact *contact; size_t length; double *table; } table_job;

static double run_table(void *context)
{
    const table_job *j = context;
    require(mslip_stiffness_table_init(j->contact, j->length, j->table));
    return j->table[j->length - 1];
}

/* A call of one amplitude, and one of a range with the table, in units of gross slip. */
static void time_range(const test_case *c, const double *table, const char *task, double from, double to)
{
    const size_t first = entry_count, mark = memory_mark();
    for (int tabulated = 0; tabulated < 2; ++tabulated) {
        call *k = allocate(sizeof *k);
        *k = (call) { &c->contact, tabulated ? table : NULL, tabulated ? BLOCK : 1, { to * c->contact.slip_displacement } };
        for (int i = 1; i < k->n; ++i) {
            k->amplitude[i] = (from + (to - from) * i / BLOCK) * c->contact.slip_displacement;
        }
        entry_add(task, tabulated ? "tabulated" : "microslip", run_call, k, k->n);
    }
    measure(first, c->shape, to, mark);
}

/* Amplitudes spaced uniformly up to twice the displacement of gross slip, and closer and closer to it on both sides. */
static void time_grid(const test_case *c)
{
    const size_t start = memory_mark();
    const size_t length = mslip_stiffness_table_length();
    table_job *j = allocate(sizeof *j);
    *j = (table_job) { &c->contact, length, allocate(length * sizeof(double)) };
    run_table(j);
    for (int i = 1; i <= GRID; ++i) {
        time_range(c, j->table, "stiffness over amplitude", 2.0 * (i - 1) / GRID, 2.0 * i / GRID);
    }
    for (double e = 0.1; e > 1e-15; e *= 0.1) {
        time_range(c, j->table, "stiffness near gross slip", 1.0 - 2.0 * e, 1.0 - e);
        time_range(c, j->table, "stiffness near gross slip", 1.0 + 2.0 * e, 1.0 + e);
    }
    const size_t first = entry_count, mark = memory_mark();
    entry_add("stiffness table", "microslip", run_table, j, 1);
    entry_add_logarithm("stiffness table");
    measure(first, c->shape, 0.0, mark);
    free_to(start);
}

void task_stiffness(const test_case *c, const extent *x)
{
    for (int a = 0; a < x->amplitudes; ++a) {
        const size_t first = entry_count, mark = memory_mark();
        for (int i = 0; i < POINTS; ++i) {
            points[i] = x->amplitude[a] * c->contact.slip_displacement * (1.0 - 0.05 * (i * 3 % POINTS) / POINTS);
            truth(&c->parameters, "stiffness", 1, &points[i], 4, exact[i]);
        }
        add("microslip", microslip_stiffness, &c->contact, -1.0, POINTS)->run = run_microslip;
        for (int k = 0; k < RULES; ++k) {
            add("quadrature", paper_stiffness, &c->paper[k], c->paper[k].nodes, FEW);
        }
        for (int k = 1; k < BANKS && (int)c->bank[k].n <= x->most_sliders; ++k) {
            add("sliders", sliders_stiffness, &c->bank[k], (double)c->bank[k].n, POINTS);
        }
        add("spring-slider", sliders_stiffness, &c->bank[0], -1.0, POINTS);
        measure(first, c->shape, x->amplitude[a], mark);
    }
    time_grid(c);
}
