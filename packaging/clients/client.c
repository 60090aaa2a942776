/* Client in C: checks that header and library agree, and computes a force. */
#include <microslip.h>
#include <stdio.h>
#include <string.h>

#define TEXT_OF(x) #x
#define TEXT(x) TEXT_OF(x)

int main(void)
{
    const char *version = TEXT(MSLIP_VERSION_MAJOR) "." TEXT(MSLIP_VERSION_MINOR) "." TEXT(MSLIP_VERSION_PATCH);
    mslip_parameters p;
    mslip_contact contact;
    double displacement, force;
    int status;

    mslip_parameters_default(&p);
    p.flat_half_width = 0.5e-3, p.edge_radius = 3e-3, p.length = 20e-3;
    p.normal_force = 800, p.friction_coefficient = 0.5;
    p.material[0].young_modulus = p.material[1].young_modulus = 2e11;
    p.material[0].poisson_ratio = p.material[1].poisson_ratio = 0.3;
    p.displacement_reference = MSLIP_RIGID_STRIP;
    status = mslip_contact_init(&p, &contact);
    if (status != MSLIP_OK) return puts(mslip_status_text(status)), 1;

    displacement = 2 * contact.slip_displacement;
    status = mslip_monotonic_force(&contact, 1, &displacement, &force, NULL, NULL);
    if (status != MSLIP_OK) return puts(mslip_status_text(status)), 1;

    /* In gross slip the force is mu N: 0.5 times 800 N, a product without rounding. */
    if (force != 400) return puts("the force of gross slip is not mu N"), 1;
    if (mslip_abi_version() != MSLIP_ABI_VERSION) return puts("header and library have different interfaces"), 1;
    if (strcmp(mslip_version(), version) != 0) return puts("header and library have different versions"), 1;
    printf("microslip %s\n", version);
    return 0;
}
