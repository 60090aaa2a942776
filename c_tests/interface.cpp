// The header in C++17. Threads are tested by the applications of verification/embedding.
#include "check.h"

#include <microslip.h>
#include <type_traits>

static_assert(std::is_trivially_copyable<mslip_contact>::value, "contacts may be stored and sent");
static_assert(std::is_standard_layout<mslip_contact>::value, "contacts are plain data");
static_assert(sizeof(mslip_contact) == 2264 && sizeof(mslip_parameters) == 104, "the layout is fixed");
static_assert(std::is_trivially_copyable<mslip_element>::value, "elements may be stored and sent");
static_assert(std::is_standard_layout<mslip_element>::value, "elements are plain data");

namespace {

void test_rejection()
{
    mslip_parameters p;
    mslip_parameters_default(&p);
    mslip_contact contact;
    CHECK(mslip_contact_init(&p, &contact) == MSLIP_BAD_FLAT_HALF_WIDTH);
    CHECK(mslip_contact_init(nullptr, &contact) == MSLIP_NULL_POINTER);
    mslip_element element;
    CHECK(mslip_element_init(&p, 1, MSLIP_INPUT_APPROACH, &element) == MSLIP_BAD_FLAT_HALF_WIDTH);
}

} // namespace

int main(int argc, char **argv)
{
    check_arguments(argc, argv);
    test_rejection();
    return check_report();
}
