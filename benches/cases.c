/* cases.c: contacts from the cylinder to nearly flat, motions with one to nine harmonics, and the exact values. */
#include "cases.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

FILE *truth_rows, *truth_values;

test_case case_of(double shape)
{
    /* Edge radii that give the half-width. */
    static const double radius[][2] = { { 0.0, 0.5394218155202255 }, { 0.3, 0.33651164572610426 },
                                        { 0.9, 0.02016686362555004 }, { 0.999, 2.047374118452045e-05 } };
    test_case c = { .shape = shape };
    mslip_parameters *p = &c.parameters;
    mslip_parameters_default(p);
    for (size_t i = 0; i < sizeof radius / sizeof *radius; ++i) {
        p->edge_radius = radius[i][0] == shape ? radius[i][1] : p->edge_radius;
    }
    p->flat_half_width = shape * 0.5e-3;
    p->length = 20e-3;
    p->displacement_reference = MSLIP_CENTRE_POINT;
    p->normal_force = 800.0;
    p->friction_coefficient = 0.5;
    p->material[0].young_modulus = p->material[1].young_modulus = 2e11;
    p->material[0].poisson_ratio = p->material[1].poisson_ratio = 0.3;
    require(mslip_contact_init(p, &c.contact));
    for (int k = 0; k < BANKS; ++k) {
        c.bank[k] = sliders_fitted(&c.contact, (size_t)1 << 2 * k);
    }
    for (int k = 0; k < RULES; ++k) {
        c.paper[k] = paper_of(p, (int)(4.0 * pow(2.0, 3.0 * k / (RULES - 1)) + 0.5));
    }
    return c;
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
    top = harmonics == 1 ? 2.0 : top; /* one harmonic: its phase */
    const double shift = 2.0 * PI / 3.0 - top;
    c[0] = 0.1 * size;
    for (int k = 1; k <= harmonics; ++k) {
        const double phase = 2.0 * k * k + k * shift, amplitude = size / (0.5 * (high - low)) / (k * k);
        c[2 * k - 1] = amplitude * cos(phase);
        c[2 * k] = amplitude * sin(phase);
    }
}

void truth(const mslip_parameters *p, const char *task, int n, const double *arguments, int values, double *value)
{
    char row[8192], expected[8192];
    int end = snprintf(row, sizeof row, "%s,%.17g,%.17g,%.17g,%.17g,%.17g", task, p->flat_half_width, p->edge_radius, p->length,
                       p->normal_force, p->friction_coefficient);
    for (int i = 0; i < 2; ++i) {
        end += sprintf(row + end, ",%.17g,%.17g", p->material[i].young_modulus, p->material[i].poisson_ratio);
    }
    for (int i = 0; i < n; ++i) {
        end += sprintf(row + end, ",%.17g", arguments[i]);
    }
    sprintf(row + end, "\n");
    if (!truth_values) {
        fputs(row, truth_rows);
        for (int i = 0; i < values; ++i) {
            value[i] = NAN;
        }
        return;
    }
    char text[8192], *next = text;
    if (!fgets(expected, sizeof expected, truth_rows) || strcmp(expected, row) || !fgets(text, sizeof text, truth_values)) {
        fprintf(stderr, "The reference was evaluated for other rows, not %s", row);
        exit(1);
    }
    for (int i = 0; i < values; ++i) {
        value[i] = strtod(next, &next);
        next += *next == ',';
    }
}
