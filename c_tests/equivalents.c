/* Sliders that stand in for the contact, through the C interface. */
#include "fixture.h"

static const double PI = 3.14159265358979323846;

static void test_jenkins_equivalent(void)
{
    static const size_t n[2] = { 1, 1 };
    const mslip_contact contact = flat_contact(), open = open_contact();
    const double amplitude = 1.741295476008732971448891e-7;
    double k, slip_force, theta;

    EVERY_SUBSET(2, n, mslip_jenkins_equivalent(&contact, amplitude, OUT(0), OUT(1)));
    k = reference[0][0];
    slip_force = reference[1][0];
    /* The slider of this stiffness and slip force has the K' and K'' of the contact. */
    CHECK(slip_force > 0.0 && slip_force < k * amplitude);
    theta = acos(1.0 - 2.0 * slip_force / (k * amplitude));
    CHECK_RELATIVE(k / PI * (theta - 0.5 * sin(2.0 * theta)), 4.533728628514166399295569e8, 1e-12);
    CHECK_RELATIVE(4.0 * slip_force * (amplitude - slip_force / k) / (PI * amplitude * amplitude),
                   1.813168961661543728829526e8, 1e-12);

    REJECTED(mslip_jenkins_equivalent(&contact, -amplitude, out[0], out[1]), MSLIP_BAD_AMPLITUDE);
    for (int i = 0; i < 3; ++i) {
        REJECTED(mslip_jenkins_equivalent(&contact, not_finite[i], out[0], out[1]), MSLIP_BAD_AMPLITUDE);
    }
    REJECTED(mslip_jenkins_equivalent(NULL, amplitude, out[0], out[1]), MSLIP_NULL_POINTER);
    for (int i = 0; i < UNINITIALISED; ++i) {
        const mslip_contact uninitialised = uninitialised_contact(i);
        REJECTED(mslip_jenkins_equivalent(&uninitialised, amplitude, out[0], out[1]), MSLIP_BAD_CONTACT);
    }
    (void)open;
}

/* Largest difference between the sliders and the curve, over mu N, at many displacements. */
static double iwan_difference(const mslip_contact *contact, size_t n, const double *stiffness, const double *slip_force)
{
    enum { POINTS = 4001 };
    double largest = 0.0;
    for (int i = 0; i < POINTS; ++i) {
        double displacement = 1.2 * contact->slip_displacement * i / (POINTS - 1), exact, sliders = 0.0;
        CHECK(mslip_monotonic_force(contact, 1, &displacement, &exact, NULL, NULL) == MSLIP_OK);
        for (size_t j = 0; j < n; ++j) {
            sliders += fmin(stiffness[j] * displacement, slip_force[j]);
        }
        largest = fmax(largest, fabs(sliders - exact));
    }
    return largest / contact->slip_force;
}

static void test_iwan_equivalent(void)
{
    enum { SLIDERS = 12 };
    static const size_t n[3] = { SLIDERS, SLIDERS, 1 };
    const mslip_contact contact = flat_contact(), open = open_contact();
    double sum = 0.0, found;

    EVERY_SUBSET(3, n, mslip_iwan_equivalent(&contact, SLIDERS, OUT(0), OUT(1), OUT(2)));
    for (int i = 0; i < SLIDERS; ++i) {
        CHECK(reference[0][i] > 0.0 && reference[1][i] > 0.0);
        sum += reference[1][i];
    }
    CHECK_RELATIVE(sum, contact.slip_force, 1e-12);
    found = iwan_difference(&contact, SLIDERS, reference[0], reference[1]);
    /* The promise is the largest error, so a sample of them comes close and never exceeds it. */
    CHECK(found <= reference[2][0] * (1.0 + 1e-9) + 1e-14);
    CHECK(found >= 0.9 * reference[2][0]);
    CHECK(reference[2][0] < 0.1);

    REJECTED(mslip_iwan_equivalent(&contact, 0, out[0], out[1], out[2]), MSLIP_BAD_COUNT);
    REJECTED(mslip_iwan_equivalent(NULL, 2, out[0], out[1], out[2]), MSLIP_NULL_POINTER);
    for (int i = 0; i < UNINITIALISED; ++i) {
        const mslip_contact uninitialised = uninitialised_contact(i);
        REJECTED(mslip_iwan_equivalent(&uninitialised, 2, out[0], out[1], out[2]), MSLIP_BAD_CONTACT);
    }
    (void)open;
}

int main(int argc, char **argv)
{
    check_arguments(argc, argv);
    test_jenkins_equivalent();
    test_iwan_equivalent();
    return check_report();
}
