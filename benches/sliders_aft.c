/* sliders_aft.c: harmonic force of spring-sliders, with its exact Jacobian, in two ways.
 *
 * stepped: every sample of two periods, as solvers do today. A slider that has last slipped at sample m has
 *   dz_n = k (row_n - row_m),  row_n = [1, cos t_n, sin t_n, ...],
 * so that one element needs only m, and a bank one row of dz for each slider.
 *
 * by reversals: only turning points are stepped. Between two of them a slider sticks, then slips: where it starts to is found
 * by bisection among the samples, and sums over the stretches come from prefix sums of cos kt and sin kt up to k = 2H, for
 * products of rows are sums of such. */
#include "sliders.h"
#include "law.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct aft {
    int harmonics, samples, coefficients;
    int stride;       /* of a row, a multiple of 4: the rest is 0 */
    int width;        /* of a prefix sum, 4H + 1 */
    double *table;    /* rows */
    double *prefix;   /* over 2 periods and one row more: sums of [1, cos t, ..., sin 2Ht] */
    double *u, *f;    /* 2 periods of displacement; forces */
    double *product;  /* Jacobian at work, stride x stride */
    double *anchored; /* a row for each sample */
    int *turns;
    double *z, *dz;   /* of a bank: forces, and their derivatives, one array for each coefficient */
    double *sticks;   /* 1 or 0 */
};

static double *zeros(size_t n)
{
    const size_t bytes = (n * sizeof(double) + 63) / 64 * 64;
    double *array = aligned_alloc(64, bytes);
    memset(array, 0, bytes);
    return array;
}

aft *aft_of(int harmonics, int samples, size_t n)
{
    aft *a = malloc(sizeof *a);
    const size_t padded = (n + LANES - 1) / LANES * LANES;
    *a = (aft) { .harmonics = harmonics, .samples = samples, .coefficients = 2 * harmonics + 1,
                 .stride = (2 * harmonics + 4) / 4 * 4, .width = 4 * harmonics + 1 };
    const size_t rows = (size_t)samples, stride = (size_t)a->stride, width = (size_t)a->width;
    a->table = zeros(rows * stride);
    a->prefix = zeros((2 * rows + 1) * width);
    a->u = zeros(2 * rows);
    a->f = zeros(rows);
    a->product = zeros(stride * stride);
    a->anchored = zeros(rows * stride);
    a->turns = malloc((rows + 1) * sizeof *a->turns);
    a->z = zeros(padded);
    a->dz = zeros(padded * stride);
    a->sticks = zeros(padded);
    for (int n = 0; n < 2 * samples; ++n) {
        double *row = a->prefix + (size_t)n * width, *next = row + width;
        for (int k = 0; k <= 2 * harmonics; ++k) {
            const double t = 2.0 * PI * ((double)(k * n % samples) / samples), cosine = cos(t), sine = sin(t);
            next[k ? 2 * k - 1 : 0] = row[k ? 2 * k - 1 : 0] + cosine;
            if (k) {
                next[2 * k] = row[2 * k] + sine;
            }
            if (n < samples && k <= harmonics) {
                a->table[n * a->stride + (k ? 2 * k - 1 : 0)] = cosine;
                if (k) {
                    a->table[n * a->stride + 2 * k] = sine;
                }
            }
        }
    }
    return a;
}

void aft_free(aft *a)
{
    double *const arrays[] = { a->table, a->prefix, a->u, a->f, a->product, a->anchored, a->z, a->dz, a->sticks };
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; ++i) {
        free(arrays[i]);
    }
    free(a->turns);
    free(a);
}

static void displacements(aft *a, const double *c)
{
    for (int n = 0; n < a->samples; ++n) {
        const double *row = a->table + n * a->stride;
        double u = 0.0;
        for (int k = 0; k < a->coefficients; ++k) {
            u += row[k] * c[k];
        }
        a->u[n] = u;
    }
}

void aft_transform(const aft *a, const double *forces, double *force)
{
    double sum[64] = { 0 };
    for (int n = 0; n < a->samples; ++n) {
        const double *row = a->table + n * a->stride;
        for (int k = 0; k < a->stride; ++k) {
            sum[k] += row[k] * forces[n];
        }
    }
    for (int k = 0; k < a->coefficients; ++k) {
        force[k] = (k ? 2.0 : 1.0) / a->samples * sum[k];
    }
}

const double *aft_displacements(aft *a, const double *coefficients)
{
    displacements(a, coefficients);
    memcpy(a->u + a->samples, a->u, (size_t)a->samples * sizeof(double));
    return a->u;
}

/* product += row (x) d, columns of the Jacobian along d. */
static void add_product(const aft *a, const double *row, const double *d)
{
    for (int j = 0; j < a->coefficients; ++j) {
        double *column = a->product + j * a->stride;
        for (int i = 0; i < a->stride; ++i) {
            column[i] += row[i] * d[j];
        }
    }
}

static void write_jacobian(const aft *a, double *jacobian)
{
    for (int j = 0; j < a->coefficients; ++j) {
        for (int i = 0; i < a->coefficients; ++i) {
            jacobian[i + j * a->coefficients] = (i ? 2.0 : 1.0) / a->samples * a->product[i + j * a->stride];
        }
    }
}

static double clamped(double trial, double slip)
{
    const double f = trial < slip ? trial : slip;
    return f > -slip ? f : -slip;
}

void jenkins_stepped(aft *a, const sliders *one, const double *c, double *force, double *jacobian)
{
    const double k = *one->stiffness, slip = *one->slip;
    displacements(a, c);
    /* Where it slipped last; as long as it never has, all that moves it is the row itself. */
    double z = 0.0, before = 0.0;
    int last = -1;
    for (int n = 0; n < a->samples; ++n) {
        const double trial = z + k * (a->u[n] - before);
        before = a->u[n];
        z = clamped(trial, slip);
        last = z == trial ? last : n;
    }
    if (!jacobian) {
        for (int n = 0; n < a->samples; ++n) {
            z = clamped(z + k * (a->u[n] - before), slip);
            before = a->u[n];
            a->f[n] = z;
        }
        aft_transform(a, a->f, force);
        return;
    }
    static const double virgin[64] = { 0 };
    double d[64];
    memset(a->product, 0, sizeof(double) * (size_t)(a->stride * a->stride));
    for (int n = 0; n < a->samples; ++n) {
        const double trial = z + k * (a->u[n] - before);
        before = a->u[n];
        z = clamped(trial, slip);
        a->f[n] = z;
        if (z == trial) {
            const double *row = a->table + n * a->stride, *then = last < 0 ? virgin : a->table + last * a->stride;
            for (int j = 0; j < a->stride; ++j) {
                d[j] = k * (row[j] - then[j]);
            }
            add_product(a, row, d);
        } else {
            last = n;
        }
    }
    aft_transform(a, a->f, force);
    write_jacobian(a, jacobian);
}

static double sum_of(const double *sum)
{
    return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

/* One step of all sliders, then of their rows dz, one coefficient after the other; the sums over the sliders into d. */
static double step_with_rows(const aft *a, const sliders *s, double du, const double *row, const double *before, double *d)
{
    double *restrict z = a->z, *restrict sticks = a->sticks, all[LANES] = { 0 };
    for (size_t i = 0; i < s->padded; i += LANES) {
        for (int l = 0; l < LANES; ++l) {
            const double trial = z[i + l] + s->stiffness[i + l] * du, f = clamped(trial, s->slip[i + l]);
            z[i + l] = f;
            sticks[i + l] = f == trial ? 1.0 : 0.0;
            all[l] += f;
        }
    }
    for (int j = 0; j < a->coefficients; ++j) {
        double *restrict dz = a->dz + (size_t)j * s->padded, sum[LANES] = { 0 };
        const double change = row[j] - (before ? before[j] : 0.0);
        for (size_t i = 0; i < s->padded; i += LANES) {
            for (int l = 0; l < LANES; ++l) {
                const double value = sticks[i + l] * (dz[i + l] + s->stiffness[i + l] * change);
                dz[i + l] = value;
                sum[l] += value;
            }
        }
        d[j] = sum_of(sum);
    }
    return sum_of(all);
}

void sliders_stepped(aft *a, const sliders *s, const double *c, double *force, double *jacobian)
{
    double before = 0.0, d[64];
    const double *row_before = NULL;
    displacements(a, c);
    memset(a->z, 0, s->padded * sizeof(double));
    if (jacobian) {
        memset(a->dz, 0, s->padded * (size_t)a->coefficients * sizeof(double));
        memset(a->product, 0, sizeof(double) * (size_t)(a->stride * a->stride));
    }
    for (int n = 0; n < 2 * a->samples; ++n) {
        const int sample = n % a->samples;
        const double *row = a->table + sample * a->stride, du = a->u[sample] - before;
        if (jacobian) {
            a->f[sample] = step_with_rows(a, s, du, row, row_before, d);
            if (n >= a->samples) {
                add_product(a, row, d);
            }
        } else {
            a->f[sample] = sliders_step(s, a->z, du, NULL);
        }
        before = a->u[sample];
        row_before = row;
    }
    aft_transform(a, a->f, force);
    if (jacobian) {
        write_jacobian(a, jacobian);
    }
}

/* Samples of the period after which the motion turns. */
static int find_turns(aft *a)
{
    int turns = 0, direction = 0, first = 0;
    for (int n = 0; n < a->samples; ++n) {
        const double du = a->u[n + 1] - a->u[n];
        const int now = (du > 0.0) - (du < 0.0);
        if (now && direction && now != direction) {
            a->turns[turns++] = n;
        }
        if (now) {
            first = first ? first : now;
            direction = now;
        }
    }
    /* Across the end of the period. */
    if (turns && direction != first) {
        a->turns[turns++] = a->samples;
    }
    return turns;
}

/* What a slider leaves in the sums: k over the stretches that stick, and constants times rows. */
typedef struct {
    double stick[128]; /* k sums of cos, sin up to 2H */
    double rows[64];   /* constant parts of the force times sums of rows */
} sums;

static void add_slider(aft *a, int turns, double k, double slip, sums *sums, int with_jacobian)
{
    const double *u = a->u;
    const int period = a->samples;
    /* The first period, from the virgin state. A motion turns at least twice. */
    int at = 0, anchor = -1;
    double trial = k * u[0], z = clamped(trial, slip);
    anchor = z == trial ? anchor : 0;
    for (int i = 0; i < turns; ++i) {
        trial = z + k * (u[a->turns[i]] - u[at]);
        at = a->turns[i];
        z = clamped(trial, slip);
        anchor = z == trial ? anchor : at % period;
    }
    /* The second: from the last turning point to itself. */
    int from = at - period;
    for (int i = 0; i < turns; ++i) {
        const int to = a->turns[i], whole = from < 0 ? period : 0; /* counted from 0 */
        const int begin = from + whole, end = to + whole;
        trial = z + k * (u[end] - u[begin]);
        const double limit = clamped(trial, slip);
        const int slides = limit != trial;
        int sticks = end;
        if (slides) {
            /* The last sample that sticks. */
            int low = begin, high = end;
            while (high - low > 1) {
                const int middle = low + (high - low) / 2;
                const double there = z + k * (u[middle] - u[begin]);
                if (clamped(there, slip) == there) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            sticks = low;
        }
        const double *p0 = a->prefix + (begin + 1) * a->width, *p1 = a->prefix + (sticks + 1) * a->width;
        const double *p2 = a->prefix + (end + 1) * a->width, offset = z - k * u[begin];
        for (int j = 0; j < a->width; ++j) {
            sums->stick[j] += k * (p1[j] - p0[j]);
        }
        for (int j = 0; j < a->coefficients; ++j) {
            sums->rows[j] += offset * (p1[j] - p0[j]) + limit * (p2[j] - p1[j]);
        }
        if (with_jacobian && anchor >= 0) {
            double *anchored = a->anchored + anchor * a->stride;
            for (int j = 0; j < a->coefficients; ++j) {
                anchored[j] += k * (p1[j] - p0[j]);
            }
        }
        z = limit;
        anchor = slides ? to % period : anchor;
        from = to;
    }
}

/* Sum over samples of row (x) row, from the sums of cos and sin: products of circular functions are sums of them. */
static double product_of(const double *p, int i, int j)
{
    const int a = (i + 1) / 2, b = (j + 1) / 2, above = a + b, below = a > b ? a - b : b - a;
    const int i_sine = i && i % 2 == 0, j_sine = j && j % 2 == 0;
    const double cosine_above = p[above ? 2 * above - 1 : 0], cosine_below = p[below ? 2 * below - 1 : 0];
    const double sine_above = above ? p[2 * above] : 0.0, sine_below = below ? p[2 * below] : 0.0;
    if (i_sine && j_sine) {
        return 0.5 * (cosine_below - cosine_above);
    }
    if (i_sine || j_sine) {
        /* sin a cos b */
        const int sine_is_larger = i_sine ? a > b : b > a;
        return 0.5 * (sine_above + (sine_is_larger ? sine_below : -sine_below));
    }
    return 0.5 * (cosine_below + cosine_above);
}

void sliders_by_reversals(aft *a, const sliders *s, const double *c, double *force, double *jacobian)
{
    const int m = a->coefficients;
    sums sums = { { 0 }, { 0 } };
    aft_displacements(a, c);
    const int turns = find_turns(a);
    for (size_t i = 0; i < s->n; ++i) {
        add_slider(a, turns, s->stiffness[i], s->slip[i], &sums, jacobian != NULL);
    }
    for (int i = 0; i < m; ++i) {
        double sum = sums.rows[i];
        for (int j = 0; j < m; ++j) {
            const double product = product_of(sums.stick, i, j);
            sum += product * c[j];
            a->product[i + j * a->stride] = product;
        }
        force[i] = (i ? 2.0 : 1.0) / a->samples * sum;
    }
    if (jacobian) {
        /* Sliders that slip nowhere but on the way to sample 0 are anchored there. */
        for (int t = -1; t < turns; ++t) {
            const int anchor = t < 0 ? 0 : a->turns[t] % a->samples;
            double *anchored = a->anchored + anchor * a->stride;
            const double *row = a->table + anchor * a->stride;
            for (int j = 0; j < m; ++j) {
                for (int i = 0; i < m; ++i) {
                    a->product[i + j * a->stride] -= anchored[i] * row[j];
                }
            }
            memset(anchored, 0, sizeof(double) * (size_t)a->stride);
        }
        write_jacobian(a, jacobian);
    }
}
