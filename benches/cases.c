/* cases.c: contacts from the cylinder to nearly flat, and motions with one to nine harmonics. */
#include "cases.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

const double shapes[SHAPES] = { 0.0, 0.3, 0.9, 0.999 };
const double amplitudes[AMPLITUDES] = { 0.01, 0.5, 0.95, 3.0 };
const int orders[ORDERS] = { 1, 5, 9 };

void succeed(int32_t status)
{
    if (status != MSLIP_OK) {
        fprintf(stderr, "microslip: %s\n", mslip_status_text(status));
        exit(1);
    }
}

mslip_parameters parameters_of(double shape)
{
    const double half_width = 0.5e-3;
    mslip_parameters p;
    mslip_parameters_default(&p);
    p.length = 20e-3;
    p.normal_force = 800.0;
    p.friction_coefficient = 0.5;
    p.material[0].young_modulus = p.material[1].young_modulus = 2e11;
    p.material[0].poisson_ratio = p.material[1].poisson_ratio = 0.3;
    p.flat_half_width = shape * half_width;
    /* The radius that makes the half-width of contact what it shall be. */
    const double modulus = 1e11 / (1.0 - 0.3 * 0.3), w = half_width * sqrt((1.0 - shape) * (1.0 + shape));
    p.edge_radius = law_size_of_load(p.flat_half_width, w) * modulus * p.length / (4.0 * p.normal_force);
    return p;
}

static sliders bank_fitted(const mslip_contact *contact, size_t n)
{
    double *stiffness = malloc(n * sizeof *stiffness), *slip = malloc(n * sizeof *slip), error;
    if (n == 1) {
        *stiffness = contact->initial_stiffness;
        *slip = contact->slip_force;
    } else {
        succeed(mslip_iwan_equivalent(contact, n, stiffness, slip, &error));
    }
    const sliders bank = sliders_of(n, stiffness, slip);
    free(stiffness);
    free(slip);
    return bank;
}

/* As banks are made by hand: corners at equal steps of the displacement, on the curve. */
static sliders bank_even(const mslip_contact *contact, size_t n)
{
    double *corner = malloc((n + 1) * sizeof *corner), *force = malloc((n + 1) * sizeof *force);
    double *stiffness = malloc(n * sizeof *stiffness), *slip = malloc(n * sizeof *slip);
    for (size_t k = 0; k <= n; ++k) {
        corner[k] = contact->slip_displacement * (double)k / (double)n;
    }
    succeed(mslip_monotonic_force(contact, n + 1, corner, force, NULL, NULL));
    for (size_t k = 0; k < n; ++k) {
        /* Slopes of the sides before and after a corner. */
        const double before = (force[k + 1] - force[k]) / (corner[k + 1] - corner[k]);
        const double after = k + 1 < n ? (force[k + 2] - force[k + 1]) / (corner[k + 2] - corner[k + 1]) : 0.0;
        stiffness[k] = before - after;
        slip[k] = stiffness[k] * corner[k + 1];
    }
    const sliders bank = sliders_of(n, stiffness, slip);
    free(corner);
    free(force);
    free(stiffness);
    free(slip);
    return bank;
}

subject subject_of(double shape, int most_sliders)
{
    subject s = { .shape = shape, .parameters = parameters_of(shape) };
    succeed(mslip_contact_init(&s.parameters, &s.contact));
    s.law = law_of(&s.parameters);
    s.truth = reference_of(&s.parameters);
    for (int k = 0, n = 1; k < BANKS && n <= most_sliders; ++k, n *= 4) {
        s.bank[k] = bank_fitted(&s.contact, (size_t)n);
        s.even[k] = bank_even(&s.contact, (size_t)n);
    }
    return s;
}

void subject_free(subject *s)
{
    free(s->truth);
    for (int k = 0; k < BANKS; ++k) {
        sliders_free(&s->bank[k]);
        sliders_free(&s->even[k]);
    }
}

static const sliders *of_number(const sliders *banks, int n)
{
    int k = 0;
    while (k < BANKS - 1 && banks[k].n < (size_t)n) {
        ++k;
    }
    return &banks[k];
}

const sliders *bank_of(const subject *s, int n)
{
    return of_number(s->bank, n);
}

const sliders *even_bank_of(const subject *s, int n)
{
    return of_number(s->even, n);
}

sliders jenkins_of(const subject *s, double amplitude)
{
    double stiffness, slip;
    if (mslip_jenkins_equivalent(&s->contact, amplitude, &stiffness, &slip) != MSLIP_OK) {
        return bank_fitted(&s->contact, 1);
    }
    return sliders_of(1, &stiffness, &slip);
}

void motion_of(int harmonics, double size, double *c)
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
    /* One harmonic has its top where its phase says; the others are shifted there, as well as the scan knows. */
    top = harmonics == 1 ? 2.0 : top;
    const double shift = 2.0 * PI / 3.0 - top;
    c[0] = 0.1 * size;
    for (int k = 1; k <= harmonics; ++k) {
        const double phase = 2.0 * k * k + k * shift, amplitude = size / (0.5 * (high - low)) / (k * k);
        c[2 * k - 1] = amplitude * cos(phase);
        c[2 * k] = amplitude * sin(phase);
    }
}
