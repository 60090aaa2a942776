/* cases.c: contacts from the cylinder to nearly flat, and the exact values. */
#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

FILE *truth_rows, *truth_values;

test_case case_of(double shape)
{
    const double b = 0.5e-3, a = shape * b, w = sqrt(b * b - a * a);
    test_case c = { .shape = shape };
    mslip_parameters *p = &c.parameters;
    mslip_parameters_default(p);
    p->flat_half_width = a;
    p->length = 20e-3;
    p->displacement_reference = MSLIP_CENTRE_POINT;
    p->normal_force = 800.0;
    p->friction_coefficient = 0.5;
    p->material[0].young_modulus = p->material[1].young_modulus = 2e11;
    p->material[0].poisson_ratio = p->material[1].poisson_ratio = 0.3;
    p->edge_radius = 1e11 / 0.91 * p->length / p->normal_force * 0.5 * (b * b * atan2(w, a) - a * w); /* Eq. 1 */
    require(mslip_contact_init(p, &c.contact));
    for (int k = 0; k < BANKS; ++k) {
        c.bank[k] = sliders_fitted(&c.contact, (size_t)1 << 2 * k, 0.0);
    }
    return c;
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
