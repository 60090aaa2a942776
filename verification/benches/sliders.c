/* sliders.c: spring-sliders in harmonic motion.
 *
 * Alternating frequency/time steps through every sample of two periods, as solvers do; the second one counts. A slider j with a
 * limit that may vary, in one direction or in the plane by radial return:
 *
 *   P = T_{n-1} + k_j (u_n - u_{n-1}),   T_n = P if |P| <= mu_j N_n, otherwise mu_j N_n P / |P|,   N_n = max(0, k_n w_n)
 *
 * The derivatives of T with respect to all coefficients of u, v, w are advanced with it. */
#include "bench.h"

#include <math.h>
#include <string.h>

enum { ROW = 20, COLUMNS = 40 }; /* 2H + 1 padded to a multiple of 4, of one and of all displacements */

sliders sliders_of(size_t n, const double *stiffness, const double *slip)
{
    const sliders s = { n, doubles(n), doubles(n) };
    memcpy(s.stiffness, stiffness, n * sizeof(double));
    memcpy(s.slip, slip, n * sizeof(double));
    return s;
}

sliders sliders_fitted(const mslip_contact *contact, size_t n, double amplitude)
{
    double error, *stiffness = doubles(n), *slip = doubles(n);
    if (n > 1) {
        require(mslip_iwan_equivalent(contact, n, stiffness, slip, &error));
    } else if (amplitude == 0.0 || mslip_jenkins_equivalent(contact, amplitude, stiffness, slip) != MSLIP_OK) {
        *stiffness = contact->initial_stiffness;
        *slip = contact->slip_force;
    }
    return sliders_of(n, stiffness, slip);
}

static double sliders_step(const sliders *s, double load, double *restrict forces, double du)
{
    const double *restrict stiffness = s->stiffness, *restrict slips = s->slip;
    double total = 0.0;
    for (size_t j = 0; j < s->n; ++j) {
        const double slip = load * slips[j], trial = forces[j] + stiffness[j] * du, f = trial < slip ? trial : slip;
        forces[j] = f > -slip ? f : -slip;
        total += forces[j];
    }
    return total;
}

struct aft {
    sliders sliders;
    double normal_stiffness;
    int directions, harmonics, samples, stride;
    double *rows;             /* 1, cos t, sin t, ..., padded with 0 */
    double *product;          /* the Jacobian before scaling, rows padded to the stride */
    double *force[2], *part;  /* of each slider, and of its trial force that friction bears */
    double (*derivative)[2][COLUMNS];
};

aft *aft_of(int directions, double normal_stiffness, int harmonics, int samples, const sliders *s)
{
    aft *a = allocate(sizeof *a);
    *a = (aft) { .sliders = *s, .normal_stiffness = normal_stiffness, .directions = directions, .harmonics = harmonics,
                 .samples = samples, .stride = (2 * harmonics + 4) / 4 * 4, .product = doubles(3 * ROW * COLUMNS),
                 .part = doubles(s->n), .force = { doubles(s->n), doubles(s->n) },
                 .derivative = allocate(s->n * sizeof *a->derivative) };
    a->rows = doubles((size_t)(samples * a->stride));
    for (int i = 0; i < samples; ++i) {
        double *row = a->rows + i * a->stride;
        row[0] = 1.0;
        for (int k = 1; k <= harmonics; ++k) {
            row[2 * k - 1] = cos(2.0 * PI * (k * i % samples) / samples);
            row[2 * k] = sin(2.0 * PI * (k * i % samples) / samples);
        }
    }
    return a;
}

static void step_in_plane(aft *a, double load, const double motion[2], double total[2])
{
    total[0] = total[1] = 0.0;
    for (size_t s = 0; s < a->sliders.n; ++s) {
        const double k = a->sliders.stiffness[s], limit = load * a->sliders.slip[s];
        const double x = a->force[0][s] + k * motion[0], y = a->force[1][s] + k * motion[1], size = sqrt(x * x + y * y);
        const double part = size <= limit ? 1.0 : limit / size;
        a->part[s] = part;
        total[0] += a->force[0][s] = part * x;
        total[1] += a->force[1][s] = part * y;
    }
}

/* Derivatives of the force of a slider, from the changes of u and v and from the derivative of the load, padded to the stride. */
static inline __attribute__((always_inline)) void differentiate(aft *a, size_t s, double load, const double *change,
                                                                const double *load_change, int directions, int varies, int stride)
{
    double *x = a->derivative[s][0], *y = a->derivative[s][1];
    const double k = a->sliders.stiffness[s], slip = a->sliders.slip[s], fx = a->force[0][s], fy = a->force[1][s];
    const int sticks = directions == 1 ? fabs(fx) < load * slip : a->part[s] == 1.0;
    if (directions == 1 && !sticks) {
        const double sign = fx > 0.0 ? slip : -slip;
        for (int j = 0; j < stride; ++j) {
            x[j] = 0.0;
        }
        for (int j = 0; varies && j < stride; ++j) {
            x[stride + j] = sign * load_change[j];
        }
        return;
    }
    for (int j = 0; j < stride; ++j) {
        x[j] += k * change[j];
    }
    for (int j = 0; directions == 2 && j < stride; ++j) {
        y[stride + j] += k * change[j];
    }
    if (sticks) {
        return;
    }
    const double size = sqrt(fx * fx + fy * fy), part = a->part[s];
    const double e[2] = { size > 0.0 ? fx / size : 0.0, size > 0.0 ? fy / size : 0.0 };
    for (int j = 0; j < 3 * stride; ++j) {
        const double across = part * (e[0] * y[j] - e[1] * x[j]);
        x[j] = -e[1] * across;
        y[j] = e[0] * across;
    }
    for (int j = 0; varies && j < stride; ++j) {
        x[2 * stride + j] += e[0] * slip * load_change[j];
        y[2 * stride + j] += e[1] * slip * load_change[j];
    }
}

/* The Jacobian: product += row (x) derivative. */
static inline void add_product(double *restrict product, const double *restrict row, const double *restrict derivative, int columns,
                               int stride)
{
    for (int j = 0; j < columns; ++j) {
        const double factor = derivative[j];
        double *restrict column = product + j * stride;
        for (int k = 0; factor != 0.0 && k < stride; k += 4) {
            for (int l = k; l < k + 4; ++l) {
                column[l] += row[l] * factor;
            }
        }
    }
}

/* The number of directions and whether the load varies are constants of each caller. */
static inline __attribute__((always_inline)) void harmonic(aft *a, const double *d, double *force, double *jacobian, int directions,
                                                           int varies)
{
    const int c = 2 * a->harmonics + 1, stride = a->stride, blocks = directions + varies, columns = blocks * stride, n = a->samples;
    const size_t sliders = a->sliders.n;
    double before[2] = { 0.0 }, zeros[ROW] = { 0.0 }, sums[3][ROW] = { { 0.0 } }, change[ROW], load_change[ROW], sum[2][COLUMNS];
    double *products[3] = { a->product, a->product + columns * stride, a->product + 2 * columns * stride };
    const double *row_before = zeros;
    memset(a->force[0], 0, sliders * sizeof(double));
    memset(a->force[1], 0, sliders * sizeof(double));
    memset(a->derivative, 0, sliders * sizeof *a->derivative);
    memset(a->product, 0, (size_t)(blocks * columns * stride) * sizeof(double));
    for (int i = 0; i < 2 * n; ++i) {
        const double *row = a->rows + (i < n ? i : i - n) * stride;
        double now[3] = { 0.0 }, motion[2], total[3], tangent;
        for (int b = 0; b < blocks; ++b) {
            for (int j = 0; j < c; ++j) {
                now[b] += row[j] * d[b * c + j];
            }
        }
        for (int b = 0; b < directions; ++b) {
            motion[b] = now[b] - before[b];
            before[b] = now[b];
        }
        const double load = !varies ? 1.0 : now[directions] > 0.0 ? a->normal_stiffness * now[directions] : 0.0;
        total[directions] = load;
        if (directions == 2) {
            step_in_plane(a, load, motion, total);
        } else if (sliders == 1) {
            total[0] = jenkins_step(*a->sliders.stiffness, load * *a->sliders.slip, a->force[0], motion[0], &tangent);
        } else {
            total[0] = sliders_step(&a->sliders, load, a->force[0], motion[0]);
        }
        for (int j = 0; j < stride; ++j) {
            change[j] = row[j] - row_before[j];
            load_change[j] = load > 0.0 ? a->normal_stiffness * row[j] : 0.0;
        }
        for (size_t s = 0; s < sliders; ++s) {
            differentiate(a, s, load, change, load_change, directions, varies, stride);
        }
        row_before = row;
        if (i < n) {
            continue;
        }
        for (int b = 0; b < blocks; ++b) {
            for (int k = 0; k < stride; ++k) {
                sums[b][k] += row[k] * total[b];
            }
        }
        for (int b = 0; b < directions; ++b) {
            for (int j = 0; j < columns && sliders > 1; ++j) {
                sum[b][j] = 0.0;
            }
            for (size_t s = 0; s < sliders && sliders > 1; ++s) {
                for (int j = 0; j < columns; ++j) {
                    sum[b][j] += a->derivative[s][b][j];
                }
            }
            add_product(products[b], row, sliders > 1 ? sum[b] : a->derivative[0][b], columns, stride);
        }
        if (varies && load > 0.0) {
            add_product(products[directions] + directions * stride * stride, row, load_change, stride, stride);
        }
    }
    for (int r = 0; r < blocks * c; ++r) {
        const double weight = (r % c ? 2.0 : 1.0) / n;
        force[r] = weight * sums[r / c][r % c];
        for (int j = 0; j < blocks * c; ++j) {
            jacobian[r + j * blocks * c] = weight * products[r / c][(j / c * stride + j % c) * stride + r % c];
        }
    }
}

void sliders_harmonic(aft *a, const double *displacement, double *force, double *jacobian)
{
    if (a->directions == 2) {
        harmonic(a, displacement, force, jacobian, 2, 1);
    } else if (a->normal_stiffness > 0.0) {
        harmonic(a, displacement, force, jacobian, 1, 1);
    } else {
        harmonic(a, displacement, force, jacobian, 1, 0);
    }
}
