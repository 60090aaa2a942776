/* varying_slider.c: spring-slider under a varying normal force with separation.
 *
 *   N_n = max(0, k_n w_n),   T_n = clamp(T_{n-1} + k (u_n - u_{n-1}), -mu N_n, mu N_n)
 *
 * Steady state: the second of two periods from T = 0, left at the sample at which it meets the first; one period from an open sample.
 * With m the last sample before n that slipped or was open, and s_m its direction of slip (0 if open), a sample that sticks has
 * T_n = T_m + k (u_n - u_m):
 *
 *   dT_n/du = k (row_n - row_m),   dT_n/dw = s_m mu k_n row_m;      slip: dT_n/du = 0, dT_n/dw = s_n mu k_n row_n
 *
 * with row_n = [1, cos t_n, sin t_n, ...]. Sums of products of two rows follow from sums of single functions up to the order 2H,
 * so that runs of samples in the same state take differences of prefix sums. */
#include "varying_slider.h"
#include "measure.h"
#include "paper_quadrature.h"

#include <math.h>
#include <string.h>

enum { MOST_SAMPLES = 1024, MOST_ROW = 64 };

struct varying_aft {
    int harmonics, samples, coefficients, stride, width;
    double *rows;    /* samples x stride: 1, cos t, sin t, ... */
    double *columns; /* coefficients x samples */
    double *prefix;  /* (samples + 1) x width: sums of 1, cos t, ..., sin 2Ht over the samples before */
    double *step, *limit, *normal, *force, *trial, *matrices;
    double (*anchor_sums)[MOST_ROW];
};

varying_aft *varying_aft_of(int harmonics, int samples)
{
    varying_aft *a = allocate(sizeof *a);
    const size_t n = (size_t)samples, c = (size_t)(2 * harmonics + 1);
    *a = (varying_aft) { .harmonics = harmonics, .samples = samples, .coefficients = (int)c,
                         .stride = (int)((c + 3) / 4 * 4), .width = (4 * harmonics + 4) / 4 * 4 };
    a->rows = doubles(n * (size_t)a->stride);
    a->columns = doubles(n * c);
    a->prefix = doubles((n + 1) * (size_t)a->width);
    a->step = doubles(n + 1);
    a->limit = doubles(n);
    a->normal = doubles(n);
    a->force = doubles(n);
    a->trial = doubles(n);
    a->matrices = doubles(3 * (size_t)(a->stride * a->stride));
    a->anchor_sums = allocate(n * sizeof *a->anchor_sums);
    for (int i = 0; i < samples; ++i) {
        double *next = a->prefix + (i + 1) * a->width;
        memcpy(next, next - a->width, (size_t)a->width * sizeof *next);
        for (int k = 0; k <= 2 * harmonics; ++k) {
            const double t = 2.0 * PI * ((double)(k * i % samples) / samples), pair[2] = { cos(t), sin(t) };
            for (int sine = 0; sine <= (k > 0); ++sine) {
                const int at = k ? 2 * k - 1 + sine : 0;
                next[at] += pair[sine];
                if (k <= harmonics) {
                    a->rows[i * a->stride + at] = a->columns[at * samples + i] = pair[sine];
                }
            }
        }
    }
    return a;
}

static void synthesise(const varying_aft *a, const double *restrict coefficients, double *restrict values)
{
    const int n = a->samples;
    for (int i = 0; i < n; ++i) {
        values[i] = coefficients[0];
    }
    for (int c = 1; c < a->coefficients; ++c) {
        const double *restrict column = a->columns + c * n, factor = coefficients[c];
        for (int i = 0; i < n; ++i) {
            values[i] += factor * column[i];
        }
    }
}

static void analyse(const varying_aft *a, const double *restrict values, double *restrict coefficients)
{
    const int n = a->samples;
    double sum[MOST_ROW] = { 0.0 };
    for (int i = 0; i < n; ++i) {
        const double *restrict row = a->rows + i * a->stride;
        for (int c = 0; c < a->stride; ++c) {
            sum[c] += row[c] * values[i];
        }
    }
    for (int c = 0; c < a->coefficients; ++c) {
        coefficients[c] = (c ? 2.0 : 1.0) / n * sum[c];
    }
}

static inline double clamped(double trial, double limit)
{
    const double below = trial < limit ? trial : limit;
    return below > -limit ? below : -limit;
}

/* Forces of the steady state; returns the sample at which its period starts. */
static int advance(varying_aft *a, const varying_slider *s, const double *displacement)
{
    const int n = a->samples;
    double u[MOST_SAMPLES], least = INFINITY, force = 0.0;
    u[0] = u[n - 1] = 0.0;
    synthesise(a, displacement, u);
    synthesise(a, displacement + a->coefficients, a->normal);
    a->step[0] = s->stiffness * (u[0] - u[n - 1]);
    for (int i = 1; i < n; ++i) {
        a->step[i] = s->stiffness * (u[i] - u[i - 1]);
    }
    for (int i = 0; i < n; ++i) {
        const double load = s->normal_stiffness * a->normal[i], closed = load > 0.0 ? load : 0.0;
        a->normal[i] = closed;
        a->limit[i] = s->friction_coefficient * closed;
        least = closed < least ? closed : least;
    }
    if (least > 0.0) {
        a->trial[0] = s->stiffness * u[0];
        a->force[0] = force = clamped(a->trial[0], a->limit[0]);
        for (int i = 1; i < n; ++i) {
            const double trial = force + a->step[i];
            force = clamped(trial, a->limit[i]);
            a->trial[i] = trial;
            a->force[i] = force;
        }
        for (int i = 0; i < n; ++i) {
            const double trial = force + a->step[i];
            force = clamped(trial, a->limit[i]);
            const int met = i > 0 && force == a->force[i] && trial == a->trial[i];
            a->trial[i] = trial;
            a->force[i] = force;
            if (met) {
                break;
            }
        }
        return 0;
    }
    int start = 0;
    while (a->limit[start] > 0.0) {
        ++start;
    }
    for (int k = 0, i = start; k < n; ++k, i = i + 1 < n ? i + 1 : 0) {
        const double trial = force + a->step[i];
        force = clamped(trial, a->limit[i]);
        a->trial[i] = trial;
        a->force[i] = force;
    }
    return start;
}

enum { STICK, SLIP, OPEN };
static inline int state_of(const varying_aft *a, int i)
{
    return a->limit[i] == 0.0 ? OPEN : a->force[i] == a->trial[i] ? STICK : SLIP;
}

static inline double direction(const varying_aft *a, int i)
{
    return a->force[i] > 0.0 ? 1.0 : -1.0;
}

/* The last sample before `start` that did not stick, or -1. */
static int last_anchor(const varying_aft *a, int start)
{
    for (int k = 1; k <= a->samples; ++k) {
        const int i = start - k < 0 ? start - k + a->samples : start - k;
        if (state_of(a, i) != STICK) {
            return i;
        }
    }
    return -1;
}

static void write_jacobian(const varying_aft *a, const varying_slider *s, double *jacobian)
{
    const int c = a->coefficients, n = 2 * c, stride = a->stride;
    const double *tu = a->matrices, *tw = tu + stride * stride, *nw = tw + stride * stride;
    for (int j = 0; j < c; ++j) {
        for (int i = 0; i < c; ++i) {
            const double weight = (i ? 2.0 : 1.0) / a->samples;
            jacobian[i + j * n] = s->stiffness * weight * tu[j * stride + i];
            jacobian[c + i + j * n] = 0.0;
            jacobian[i + (c + j) * n] = s->friction_coefficient * s->normal_stiffness * weight * tw[j * stride + i];
            jacobian[c + i + (c + j) * n] = s->normal_stiffness * weight * nw[j * stride + i];
        }
    }
}

static inline void add_outer(double *restrict matrix, const double *row, const double *column, double factor, int n, int stride)
{
    for (int j = 0; j < n; ++j) {
        const double scale = factor * column[j];
        for (int i = 0; i < stride; ++i) {
            matrix[j * stride + i] += row[i] * scale;
        }
    }
}

void varying_slider_stepped(varying_aft *a, const varying_slider *s, const double *displacement, double *force, double *jacobian)
{
    static const double zeros[MOST_ROW];
    const int start = advance(a, s, displacement), stride = a->stride, c = a->coefficients, n = a->samples;
    analyse(a, a->force, force);
    analyse(a, a->normal, force + c);
    if (!jacobian) {
        return;
    }
    double *tu = a->matrices, *tw = tu + stride * stride, *nw = tw + stride * stride;
    memset(a->matrices, 0, 3 * sizeof(double) * (size_t)(stride * stride));
    int anchor = last_anchor(a, start);
    for (int k = 0, i = start; k < n; ++k, i = i + 1 < n ? i + 1 : 0) {
        const double *row = a->rows + i * stride;
        const int state = state_of(a, i);
        if (state == OPEN) {
            anchor = i;
            continue;
        }
        add_outer(nw, row, row, 1.0, c, stride);
        if (state == SLIP) {
            anchor = i;
            add_outer(tw, row, row, direction(a, i), c, stride);
            continue;
        }
        const double *from = anchor < 0 ? zeros : a->rows + anchor * stride;
        double difference[MOST_ROW];
        for (int j = 0; j < stride; ++j) {
            difference[j] = row[j] - from[j];
        }
        add_outer(tu, row, difference, 1.0, c, stride);
        if (anchor >= 0 && state_of(a, anchor) == SLIP) {
            add_outer(tw, row, from, direction(a, anchor), c, stride);
        }
    }
    write_jacobian(a, s, jacobian);
}

/* Sum of row x row from the sums of 1, cos t, sin t, ..., sin 2Ht. */
static void products(const varying_aft *a, const double *sums, double *matrix)
{
    const int h = a->harmonics, stride = a->stride;
    for (int q = 0; q <= h; ++q) {
        for (int p = 0; p <= h; ++p) {
            const int d = p > q ? p - q : q - p, at_p = p ? 2 * p - 1 : 0, at_q = q ? 2 * q - 1 : 0;
            const double c_sum = sums[p + q ? 2 * (p + q) - 1 : 0], s_sum = p + q ? sums[2 * (p + q)] : 0.0;
            const double c_difference = sums[d ? 2 * d - 1 : 0], s_size = d ? sums[2 * d] : 0.0;
            const double s_difference = p < q ? -s_size : s_size;
            matrix[at_q * stride + at_p] = 0.5 * (c_difference + c_sum);
            if (p) {
                matrix[at_q * stride + 2 * p] = 0.5 * (s_sum + s_difference);
            }
            if (q) {
                matrix[2 * q * stride + at_p] = 0.5 * (s_sum - s_difference);
            }
            if (p && q) {
                matrix[2 * q * stride + 2 * p] = 0.5 * (c_difference - c_sum);
            }
        }
    }
}

void varying_slider_by_runs(varying_aft *a, const varying_slider *s, const double *displacement, double *force, double *jacobian)
{
    const int start = advance(a, s, displacement), stride = a->stride, c = a->coefficients, n = a->samples, width = a->width;
    analyse(a, a->force, force);
    analyse(a, a->normal, force + c);
    if (!jacobian) {
        return;
    }
    double *tu = a->matrices, *tw = tu + stride * stride, *nw = tw + stride * stride;
    double stick[2 * MOST_ROW] = { 0.0 }, slip[2 * MOST_ROW] = { 0.0 }, closed[2 * MOST_ROW] = { 0.0 };
    struct { int anchor; double sign; } runs[MOST_SAMPLES];
    int count = 0, anchor = last_anchor(a, start);
    for (int k = 0, length; k < n; k += length) {
        const int i = start + k < n ? start + k : start + k - n, state = state_of(a, i);
        const double sign = direction(a, i);
        int end = i + 1;
        for (length = 1; k + length < n && end < n && state_of(a, end) == state && (state != SLIP || direction(a, end) == sign);
             ++length) {
            ++end;
        }
        const double *from = a->prefix + i * width, *to = a->prefix + end * width;
        if (state == STICK) {
            runs[count].anchor = anchor;
            runs[count].sign = anchor >= 0 && state_of(a, anchor) == SLIP ? direction(a, anchor) : 0.0;
            for (int j = 0; j < width; ++j) {
                stick[j] += to[j] - from[j];
                closed[j] += to[j] - from[j];
            }
            for (int j = 0; j < c; ++j) {
                a->anchor_sums[count][j] = to[j] - from[j];
            }
            ++count;
        } else {
            for (int j = 0; state == SLIP && j < width; ++j) {
                slip[j] += sign * (to[j] - from[j]);
                closed[j] += to[j] - from[j];
            }
            anchor = end - 1;
        }
    }
    products(a, stick, tu);
    products(a, slip, tw);
    products(a, closed, nw);
    for (int r = 0; r < count; ++r) {
        if (runs[r].anchor >= 0) {
            const double *row = a->rows + runs[r].anchor * stride, *sums = a->anchor_sums[r];
            for (int j = 0; j < c; ++j) {
                const double by_u = row[j], by_w = runs[r].sign * row[j];
                for (int i = 0; i < c; ++i) {
                    tu[j * stride + i] -= sums[i] * by_u;
                    tw[j * stride + i] += sums[i] * by_w;
                }
            }
        }
    }
    write_jacobian(a, s, jacobian);
}

void varying_slider_step(const varying_slider *s, double state[2], double displacement, double approach, double force[2], double tangent[4])
{
    const double load = approach > 0.0 ? s->normal_stiffness * approach : 0.0, limit = s->friction_coefficient * load;
    const double trial = state[1] + s->stiffness * (displacement - state[0]), traction = clamped(trial, limit);
    const int sticks = traction == trial;
    state[0] = displacement;
    state[1] = force[0] = traction;
    force[1] = load;
    tangent[0] = sticks && limit > 0.0 ? s->stiffness : 0.0;
    tangent[1] = 0.0;
    tangent[3] = approach > 0.0 ? s->normal_stiffness : 0.0;
    tangent[2] = sticks ? 0.0 : (traction > 0.0 ? s->friction_coefficient : -s->friction_coefficient) * tangent[3];
}
