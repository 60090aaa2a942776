/* sliders.c: a bank of spring-sliders on the virgin curve, in harmonic motion, and in a time step. */
#include "sliders.h"
#include "law.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double *lanes(size_t n, const double *values)
{
    const size_t padded = (n + LANES - 1) / LANES * LANES;
    double *array = aligned_alloc(64, padded * sizeof *array);
    memset(array, 0, padded * sizeof *array);
    memcpy(array, values, n * sizeof *array);
    return array;
}

sliders sliders_of(size_t n, const double *stiffness, const double *slip)
{
    return (sliders) { n, (n + LANES - 1) / LANES * LANES, lanes(n, stiffness), lanes(n, slip) };
}

void sliders_free(sliders *s)
{
    free(s->stiffness);
    free(s->slip);
}

static double sum_of(const double *sum)
{
    return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

/* Force and stiffness in two passes: the sums of both at once would not fit into the registers. */
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

void sliders_stiffness(const sliders *s, double amplitude, double result[4])
{
    double stuck = 0.0, real = 0.0, imaginary = 0.0, real_slope = 0.0, imaginary_slope = 0.0;
    for (size_t i = 0; i < s->n; ++i) {
        const double k = s->stiffness[i];
        if (s->slip[i] >= k * amplitude) {
            stuck += k;
            continue;
        }
        /* cos(theta) = 1 - 2y/A, y the displacement at which it slips. */
        const double y = s->slip[i] / k / amplitude, cosine = 1.0 - 2.0 * y, sine = 2.0 * sqrt(y * (1.0 - y));
        real += k * (acos(cosine) - sine * cosine);
        imaginary += k * sine * sine;
        real_slope -= k * y * sine;
        imaginary_slope -= k * y * cosine;
    }
    result[0] = stuck + real / PI;
    result[1] = imaginary / PI;
    result[2] = 4.0 * real_slope / (PI * amplitude);
    result[3] = 4.0 * imaginary_slope / (PI * amplitude);
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
    for (size_t j = 0; stiffness && j < s->padded; j += LANES) {
        for (int l = 0; l < LANES; ++l) {
            k[l] += fabs(forces[j + l]) < s->slip[j + l] ? s->stiffness[j + l] : 0.0;
        }
    }
    if (stiffness) {
        *stiffness = sum_of(k);
    }
    return sum_of(t);
}
