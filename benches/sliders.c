/* sliders.c: parallel spring-sliders on the initial loading curve, in harmonic motion and in a time step.
 *
 * Alternating frequency/time: a slider that has last slipped at sample m has the derivative k (row_n - row_m) at sample n, with
 * row_n = [1, cos t_n, sin t_n, ...]. jenkins_aft steps through every sample of two periods, as solvers do.
 *
 * sliders_aft steps through reversals only. Between two of them a slider first sticks and then slips; the sample at which it
 * begins to slip is found by bisection, and sums over samples come from prefix sums of cos kt and sin kt up to k = 2H, since
 * products of two rows are sums of such. */
#include "sliders.h"
#include "measure.h"
#include "paper_quadrature.h"

#include <math.h>
#include <string.h>

static double sum_of(const double *sum)
{
    return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

sliders sliders_of(size_t n, const double *stiffness, const double *slip)
{
    const size_t padded = (n + LANES - 1) / LANES * LANES;
    const sliders s = { n, padded, allocate(padded * sizeof(double)), allocate(padded * sizeof(double)) };
    memcpy(s.stiffness, stiffness, n * sizeof(double));
    memcpy(s.slip, slip, n * sizeof(double));
    return s;
}

sliders sliders_fitted(const mslip_contact *contact, size_t n)
{
    double error, *stiffness = allocate(n * sizeof(double)), *slip = allocate(n * sizeof(double));
    if (n == 1) {
        *stiffness = contact->initial_stiffness;
        *slip = contact->slip_force;
    } else {
        require(mslip_iwan_equivalent(contact, n, stiffness, slip, &error));
    }
    return sliders_of(n, stiffness, slip);
}

sliders jenkins_fitted(const mslip_contact *contact, double amplitude)
{
    double stiffness, slip;
    if (mslip_jenkins_equivalent(contact, amplitude, &stiffness, &slip) != MSLIP_OK) {
        return sliders_fitted(contact, 1);
    }
    return sliders_of(1, &stiffness, &slip);
}

/* Two passes: the sums of force and stiffness together would not fit into the registers. */
void sliders_curve(const void *context, size_t n, const double *displacement, double *force, double *stiffness)
{
    const sliders *s = context;
    for (size_t i = 0; i < n; ++i) {
        double t[LANES] = { 0 }, k[LANES] = { 0 };
        for (size_t j = 0; j < s->padded; j += LANES) {
            for (int l = 0; l < LANES; ++l) {
                const double trial = s->stiffness[j + l] * displacement[i], slip = s->slip[j + l];
                t[l] += trial < slip ? trial : slip;
            }
        }
        for (size_t j = 0; j < s->padded; j += LANES) {
            for (int l = 0; l < LANES; ++l) {
                k[l] += s->stiffness[j + l] * displacement[i] < s->slip[j + l] ? s->stiffness[j + l] : 0.0;
            }
        }
        force[i] = sum_of(t);
        stiffness[i] = sum_of(k);
    }
}

void sliders_stiffness(const void *context, double amplitude, double result[4])
{
    const sliders *s = context;
    double stick = 0.0, real = 0.0, imaginary = 0.0, d_real = 0.0, d_imaginary = 0.0;
    for (size_t i = 0; i < s->n; ++i) {
        const double k = s->stiffness[i];
        if (s->slip[i] >= k * amplitude) {
            stick += k;
            continue;
        }
        /* cos(theta) = 1 - 2y; y: the displacement at which it slips over the amplitude. */
        const double y = s->slip[i] / k / amplitude, cosine = 1.0 - 2.0 * y, sine = 2.0 * sqrt(y * (1.0 - y));
        real += k * (acos(cosine) - sine * cosine);
        imaginary += k * sine * sine;
        d_real -= k * y * sine;
        d_imaginary -= k * y * cosine;
    }
    result[0] = stick + real / PI;
    result[1] = imaginary / PI;
    result[2] = 4.0 * d_real / (PI * amplitude);
    result[3] = 4.0 * d_imaginary / (PI * amplitude);
}

double sliders_step(const sliders *s, double *restrict forces, double du, double *stiffness)
{
    double t[LANES] = { 0 }, k[LANES] = { 0 };
    for (size_t j = 0; j < s->padded; j += LANES) {
        for (int l = 0; l < LANES; ++l) {
            const double slip = s->slip[j + l], trial = forces[j + l] + s->stiffness[j + l] * du;
            double f = trial < slip ? trial : slip;
            f = f > -slip ? f : -slip;
            forces[j + l] = f;
            t[l] += f;
        }
    }
    for (size_t j = 0; j < s->padded; j += LANES) {
        for (int l = 0; l < LANES; ++l) {
            k[l] += fabs(forces[j + l]) < s->slip[j + l] ? s->stiffness[j + l] : 0.0;
        }
    }
    *stiffness = sum_of(k);
    return sum_of(t);
}

struct aft {
    int harmonics, samples, coefficients;
    int stride;       /* of a row, a multiple of 4, padded with 0 */
    int width;        /* of a prefix sum, 4H + 1 */
    double *rows;
    double *prefix;   /* sums over up to two periods of [1, cos t, ..., sin 2Ht] */
    double *u, *f;    /* displacements of two periods; forces of one */
    double *product;  /* the Jacobian before scaling, stride x stride */
    double *anchored; /* per sample: sums over sliders that have last slipped there */
    int *reversals;
};

aft *aft_of(int harmonics, int samples)
{
    aft *a = allocate(sizeof *a);
    *a = (aft) { .harmonics = harmonics, .samples = samples, .coefficients = 2 * harmonics + 1,
                 .stride = (2 * harmonics + 4) / 4 * 4, .width = 4 * harmonics + 1 };
    const size_t n = (size_t)samples, stride = (size_t)a->stride, width = (size_t)a->width;
    a->rows = allocate(n * stride * sizeof(double));
    a->prefix = allocate((2 * n + 1) * width * sizeof(double));
    a->u = allocate(2 * n * sizeof(double));
    a->f = allocate(n * sizeof(double));
    a->product = allocate(stride * stride * sizeof(double));
    a->anchored = allocate(n * stride * sizeof(double));
    a->reversals = allocate((n + 1) * sizeof *a->reversals);
    for (int i = 0; i < 2 * samples; ++i) {
        double *before = a->prefix + (size_t)i * width, *after = before + width;
        for (int k = 0; k < a->width; ++k) {
            const int harmonic = (k + 1) / 2;
            const double t = 2.0 * PI * ((double)(harmonic * i % samples) / samples);
            const double value = k && k % 2 == 0 ? sin(t) : cos(t);
            after[k] = before[k] + value;
            if (i < samples && k < a->coefficients) {
                a->rows[i * a->stride + k] = value;
            }
        }
    }
    return a;
}

static void synthesize(aft *a, const double *c)
{
    for (int n = 0; n < a->samples; ++n) {
        const double *row = a->rows + n * a->stride;
        double u = 0.0;
        for (int k = 0; k < a->coefficients; ++k) {
            u += row[k] * c[k];
        }
        a->u[n] = u;
    }
}

static void transform(const aft *a, double *force)
{
    double sum[64] = { 0 };
    for (int n = 0; n < a->samples; ++n) {
        const double *row = a->rows + n * a->stride;
        for (int k = 0; k < a->stride; ++k) {
            sum[k] += row[k] * a->f[n];
        }
    }
    for (int k = 0; k < a->coefficients; ++k) {
        force[k] = (k ? 2.0 : 1.0) / a->samples * sum[k];
    }
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

void jenkins_aft(aft *a, const sliders *one, const double *c, double *force, double *jacobian)
{
    const double k = *one->stiffness, slip = *one->slip;
    synthesize(a, c);
    /* The sample at which it slipped last; -1 if it never did. */
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
        transform(a, force);
        return;
    }
    static const double zero[64] = { 0 };
    double d[64];
    memset(a->product, 0, sizeof(double) * (size_t)(a->stride * a->stride));
    for (int n = 0; n < a->samples; ++n) {
        const double trial = z + k * (a->u[n] - before);
        before = a->u[n];
        z = clamped(trial, slip);
        a->f[n] = z;
        if (z == trial) {
            const double *row = a->rows + n * a->stride, *anchor = last < 0 ? zero : a->rows + last * a->stride;
            for (int j = 0; j < a->stride; ++j) {
                d[j] = k * (row[j] - anchor[j]);
            }
            add_product(a, row, d);
        } else {
            last = n;
        }
    }
    transform(a, force);
    write_jacobian(a, jacobian);
}

/* Samples of the period after which the motion reverses. */
static int find_reversals(aft *a)
{
    int reversals = 0, direction = 0, first = 0;
    for (int n = 0; n < a->samples; ++n) {
        const double du = a->u[n + 1] - a->u[n];
        const int now = (du > 0.0) - (du < 0.0);
        if (now && direction && now != direction) {
            a->reversals[reversals++] = n;
        }
        if (now) {
            first = first ? first : now;
            direction = now;
        }
    }
    /* Across the end of the period. */
    if (reversals && direction != first) {
        a->reversals[reversals++] = a->samples;
    }
    return reversals;
}

/* Contributions of the sliders: k times sums over segments of stick, and constants times sums of rows. */
typedef struct {
    double stick[128]; /* k sums of cos, sin up to 2H */
    double rows[64];   /* constant parts of the force times sums of rows */
} sums;

static void add_slider(aft *a, int reversals, double k, double slip, sums *sums, int with_jacobian)
{
    const double *u = a->u;
    const int period = a->samples;
    /* The first period, from the unloaded state. */
    int at = 0, anchor = -1;
    double trial = k * u[0], z = clamped(trial, slip);
    anchor = z == trial ? anchor : 0;
    for (int i = 0; i < reversals; ++i) {
        trial = z + k * (u[a->reversals[i]] - u[at]);
        at = a->reversals[i];
        z = clamped(trial, slip);
        anchor = z == trial ? anchor : at % period;
    }
    /* The second: from the last reversal to itself. */
    int from = at - period;
    for (int i = 0; i < reversals; ++i) {
        const int to = a->reversals[i], whole = from < 0 ? period : 0; /* indices start at 0 */
        const int begin = from + whole, end = to + whole;
        trial = z + k * (u[end] - u[begin]);
        const double limit = clamped(trial, slip);
        const int slips = limit != trial;
        int last_stick = end;
        if (slips) {
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
            last_stick = low;
        }
        const double *p0 = a->prefix + (begin + 1) * a->width, *p1 = a->prefix + (last_stick + 1) * a->width;
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
        anchor = slips ? to % period : anchor;
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

void sliders_aft(aft *a, const sliders *s, const double *c, double *force, double *jacobian)
{
    const int m = a->coefficients;
    sums sums = { { 0 }, { 0 } };
    synthesize(a, c);
    memcpy(a->u + a->samples, a->u, (size_t)a->samples * sizeof(double));
    const int reversals = find_reversals(a);
    for (size_t i = 0; i < s->n; ++i) {
        add_slider(a, reversals, s->stiffness[i], s->slip[i], &sums, jacobian != NULL);
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
        /* Sliders that slip only on the way to sample 0 are anchored there. */
        for (int t = -1; t < reversals; ++t) {
            const int anchor = t < 0 ? 0 : a->reversals[t] % a->samples;
            double *anchored = a->anchored + anchor * a->stride;
            const double *row = a->rows + anchor * a->stride;
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
