/* Sizes and offsets of the structures, on which the Fortran module and stored contacts depend. */
#include "check.h"

#include <microslip.h>
#include <stddef.h>

/* An array of negative length does not compile, in C99 and in C++. */
#define AT_COMPILE_TIME(name, condition) typedef char name[(condition) ? 1 : -1]
#define OFFSET(type, field, bytes) AT_COMPILE_TIME(type##_##field, offsetof(type, field) == (bytes))
#define SIZE(type, bytes) AT_COMPILE_TIME(type##_size, sizeof(type) == (bytes))

OFFSET(mslip_material, young_modulus, 0);
OFFSET(mslip_material, poisson_ratio, 8);
SIZE(mslip_material, 16);

OFFSET(mslip_parameters, flat_half_width, 0);
OFFSET(mslip_parameters, edge_radius, 8);
OFFSET(mslip_parameters, length, 16);
OFFSET(mslip_parameters, normal_force, 24);
OFFSET(mslip_parameters, friction_coefficient, 32);
OFFSET(mslip_parameters, material, 40);
OFFSET(mslip_parameters, displacement_reference, 72);
OFFSET(mslip_parameters, springs, 76);
SIZE(mslip_parameters, 80);

OFFSET(mslip_elliptic_parameters, semi_axis_x, 0);
OFFSET(mslip_elliptic_parameters, semi_axis_y, 8);
OFFSET(mslip_elliptic_parameters, normal_force, 16);
OFFSET(mslip_elliptic_parameters, friction_coefficient, 24);
OFFSET(mslip_elliptic_parameters, material, 32);
OFFSET(mslip_elliptic_parameters, springs, 64);
OFFSET(mslip_elliptic_parameters, reserved, 68);
SIZE(mslip_elliptic_parameters, 72);

OFFSET(mslip_contact, composite_modulus, 0);
OFFSET(mslip_contact, half_width, 8);
OFFSET(mslip_contact, slip_force, 16);
OFFSET(mslip_contact, slip_displacement, 24);
OFFSET(mslip_contact, initial_stiffness, 32);
OFFSET(mslip_contact, slip_energy, 40);
OFFSET(mslip_contact, reserved, 48);
SIZE(mslip_contact, 2032);

OFFSET(mslip_element, composite_modulus, 0);
OFFSET(mslip_element, friction_coefficient, 8);
OFFSET(mslip_element, normal_force, 16);
OFFSET(mslip_element, half_width, 24);
OFFSET(mslip_element, approach, 32);
OFFSET(mslip_element, normal_stiffness, 40);
OFFSET(mslip_element, tangential_stiffness, 48);
OFFSET(mslip_element, directions, 56);
OFFSET(mslip_element, normal_input, 60);
OFFSET(mslip_element, reserved, 64);
AT_COMPILE_TIME(mslip_element_directions_size, sizeof(((mslip_element *)0)->directions) == 4);
AT_COMPILE_TIME(mslip_element_normal_input_size, sizeof(((mslip_element *)0)->normal_input) == 4);
SIZE(mslip_element, 17336);

/* The library writes the fields at the offsets of the header, and nothing else. */
int main(int argc, char **argv)
{
    struct {
        unsigned char before[64];
        mslip_parameters parameters;
        unsigned char between[64];
        mslip_elliptic_parameters elliptic;
        unsigned char gap[64];
        mslip_contact contact;
        unsigned char gap_before_element[64];
        mslip_element element;
        unsigned char after[64];
    } memory;
    unsigned char guard[64];
    int body;

    check_arguments(argc, argv);
    memset(&memory, 0x5a, sizeof memory);
    memset(guard, 0x5a, sizeof guard);

    mslip_parameters_default(&memory.parameters);
    mslip_elliptic_parameters_default(&memory.elliptic);
    CHECK(memory.parameters.displacement_reference == MSLIP_CENTRE_POINT && memory.parameters.springs == 0);
    CHECK(memory.elliptic.springs == 0 && memory.elliptic.reserved == 0);
    memory.parameters.flat_half_width = 0.0;
    memory.parameters.edge_radius = 5e-3;
    memory.parameters.length = 2e-2;
    memory.parameters.normal_force = 100.0;
    memory.parameters.friction_coefficient = 0.5;
    for (body = 0; body < 2; ++body) {
        memory.parameters.material[body].young_modulus = 2e11;
        memory.parameters.material[body].poisson_ratio = 0.5;
    }
    CHECK(mslip_contact_init(&memory.parameters, &memory.contact) == MSLIP_OK);
    CHECK_RELATIVE(memory.contact.composite_modulus, 2e11 / 1.5, 1e-15);
    CHECK_RELATIVE(memory.contact.slip_force, 50.0, 1e-15);

    CHECK(mslip_element_init(&memory.parameters, 1, MSLIP_INPUT_NORMAL_FORCE, &memory.element) == MSLIP_OK);
    CHECK_RELATIVE(memory.element.composite_modulus, 2e11 / 1.5, 1e-15);
    CHECK_RELATIVE(memory.element.half_width, memory.contact.half_width, 1e-13);
    CHECK_RELATIVE(memory.element.tangential_stiffness, memory.contact.initial_stiffness, 1e-13);
    CHECK(memory.element.friction_coefficient == 0.5 && memory.element.normal_force == 100.0);
    CHECK(memory.element.approach > 0.0 && memory.element.normal_stiffness > memory.element.tangential_stiffness);
    CHECK(memory.element.directions == 1 && memory.element.normal_input == MSLIP_INPUT_NORMAL_FORCE);

    CHECK(memcmp(memory.before, guard, sizeof guard) == 0 && memcmp(memory.between, guard, sizeof guard) == 0);
    CHECK(memcmp(memory.gap_before_element, guard, sizeof guard) == 0);
    CHECK(memcmp(memory.gap, guard, sizeof guard) == 0 && memcmp(memory.after, guard, sizeof guard) == 0);
    return check_report();
}
