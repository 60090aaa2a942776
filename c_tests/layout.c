/* The recorded interface: constants, sizes and offsets of the structures, on which the Fortran module and stored contacts depend,
   functions and lengths. */
#include "check.h"

#include <microslip.h>
#include <stddef.h>

/* An array of negative length does not compile, nor does a function that was declared otherwise. */
#define AT_COMPILE_TIME(name, condition) typedef char name[(condition) ? 1 : -1];
#define CONSTANT(name, value) AT_COMPILE_TIME(name##_value, name == (value))
#define STRUCTURE(type, bytes) AT_COMPILE_TIME(type##_size, sizeof(type) == (bytes))
#define FIELD(type, field, bytes, kind, count) \
    AT_COMPILE_TIME(type##_##field, offsetof(type, field) == (bytes) && sizeof(((type *)0)->field) == (count) * sizeof(kind))
#define FUNCTION(result, name, arguments) result name arguments;
#define LENGTH(call, doubles)
#include "abi.h"
#undef CONSTANT
#undef STRUCTURE
#undef FIELD
#undef FUNCTION
#undef LENGTH

static void check_lengths(void)
{
#define CONSTANT(name, value)
#define STRUCTURE(type, bytes)
#define FIELD(type, field, bytes, kind, count)
#define FUNCTION(result, name, arguments)
#define LENGTH(call, doubles) CHECK((call) == (doubles));
#include "abi.h"
}

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

    check_arguments(argc, argv);
    check_lengths();
    memset(&memory, 0x5a, sizeof memory);
    memset(guard, 0x5a, sizeof guard);

    mslip_parameters_default(&memory.parameters);
    mslip_elliptic_parameters_default(&memory.elliptic);
    CHECK(memory.parameters.displacement_reference == -1 && memory.parameters.reserved == 0);
    memory.parameters = flat_parameters(0.0, 0.5);
    CHECK(mslip_contact_init(&memory.parameters, &memory.contact) == MSLIP_OK);
    CHECK_RELATIVE(memory.contact.composite_modulus, 2e11 / 1.5, 1e-15);
    CHECK_RELATIVE(memory.contact.slip_force, 30.0, 1e-15);

    CHECK(mslip_element_init(&memory.parameters, 1, MSLIP_INPUT_NORMAL_FORCE, &memory.element) == MSLIP_OK);
    CHECK_RELATIVE(memory.element.composite_modulus, 2e11 / 1.5, 1e-15);
    CHECK_RELATIVE(memory.element.half_width, memory.contact.half_width, 1e-13);
    CHECK_RELATIVE(memory.element.tangential_stiffness, memory.contact.initial_stiffness, 1e-13);
    CHECK(memory.element.friction_coefficient == 0.5 && memory.element.normal_force == 60.0);
    CHECK(memory.element.approach > 0.0 && memory.element.normal_stiffness > memory.element.tangential_stiffness);
    CHECK(memory.element.directions == 1 && memory.element.normal_input == MSLIP_INPUT_NORMAL_FORCE);

    CHECK(memcmp(memory.before, guard, sizeof guard) == 0 && memcmp(memory.between, guard, sizeof guard) == 0);
    CHECK(memcmp(memory.gap_before_element, guard, sizeof guard) == 0);
    CHECK(memcmp(memory.gap, guard, sizeof guard) == 0 && memcmp(memory.after, guard, sizeof guard) == 0);
    return check_report();
}
