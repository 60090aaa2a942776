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

subject subject_of(double shape)
{
    subject s = { .shape = shape, .parameters = parameters_of(shape) };
    succeed(mslip_contact_init(&s.parameters, &s.contact));
    s.law = law_of(&s.parameters);
    s.truth = reference_of(&s.parameters);
    return s;
}

void subject_free(subject *s)
{
    free(s->truth);
}

sliders bank_of(const subject *s, size_t n)
{
    double *stiffness = malloc(n * sizeof *stiffness), *slip = malloc(n * sizeof *slip), error;
    if (n == 1) {
        *stiffness = s->contact.initial_stiffness;
        *slip = s->contact.slip_force;
    } else {
        succeed(mslip_iwan_equivalent(&s->contact, n, stiffness, slip, &error));
    }
    const sliders bank = sliders_of(n, stiffness, slip);
    free(stiffness);
    free(slip);
    return bank;
}

sliders jenkins_of(const subject *s, double amplitude)
{
    double stiffness, slip;
    if (mslip_jenkins_equivalent(&s->contact, amplitude, &stiffness, &slip) != MSLIP_OK) {
        return bank_of(s, 1);
    }
    return sliders_of(1, &stiffness, &slip);
}

void motion_of(int harmonics, double size, double *c)
{
    double low = 0.0, high = 0.0;
    c[0] = 0.0;
    for (int k = 1; k <= harmonics; ++k) {
        c[2 * k - 1] = cos(2.0 * k * k) / (k * k);
        c[2 * k] = sin(2.0 * k * k) / (k * k);
    }
    for (int i = 0; i < 4096; ++i) {
        double u = 0.0;
        for (int k = 1; k <= harmonics; ++k) {
            u += c[2 * k - 1] * cos(2.0 * PI * k * i / 4096.0) + c[2 * k] * sin(2.0 * PI * k * i / 4096.0);
        }
        low = fmin(low, u);
        high = fmax(high, u);
    }
    for (int k = 1; k <= 2 * harmonics; ++k) {
        c[k] *= size / (0.5 * (high - low));
    }
    c[0] = 0.1 * size;
}
