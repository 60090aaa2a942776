/* cases.c: contacts from the cylinder to nearly flat. */
#include "bench.h"

#include <math.h>

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
