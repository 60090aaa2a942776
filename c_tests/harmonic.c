/* Alternating frequency/time through the C interface: workspaces, forces, Jacobians, by both rules. */
#include "calls.h"

enum { H = 3, TABLE_SAMPLES = 128, FINE = 1024, NODES = 64, N = 2 * H + 1, GUARD = 8 };

static const double PI = 3.14159265358979323846;

/* Case 3 of the table of harmonic forces: contact 3. */
static const double displacement[N] = {
    -1.032743514817179949570389e-8, 3.482590952017465942897783e-7, 0.0, 4.000215146179563450994928e-8,
    9.733119336249038200948978e-9,  1.357006555907048139958686e-7, 6.745495473297667476041231e-8,
};
static const double force_of_table[N] = {
    -4.187659061710047803366514e-1, 4.143565000565348613576092e1, -7.64493260539773256124719e1,
    -1.081698314128846294125077,    -2.885322988101795434779141,  3.443354832948413483986706e1,
    -5.283214385921310379079379,
};

/* An initialised workspace; initialisation writes nothing beyond the reported length. */
static double *workspace_of(size_t samples, int32_t rule)
{
    const size_t length = mslip_harmonic_workspace_length(H, samples, rule);
    double *w = malloc((length + GUARD) * sizeof *w), guard[GUARD];
    memset(guard, 0x5a, sizeof guard);
    CHECK(length > 0 && w != NULL && mslip_harmonic_workspace_length(H + 1, samples, rule) > length);
    memcpy(w + length, guard, sizeof guard);
    CHECK(mslip_harmonic_workspace_init(H, samples, rule, length, w) == MSLIP_OK && same_bits(w + length, guard, GUARD));
    return w;
}

/* One harmonic: the complex stiffness, and the energy of its loop. A constant displacement: a constant force. */
static void check_harmonic(const mslip_contact *contact, double *w, int event_driven)
{
    const double amplitude = 0.8 * contact->slip_displacement;
    double k_real, k_imag, u[N] = { 0.0 }, force[N], energy, steady;
    u[1] = amplitude;
    CHECK(mslip_harmonic_force(contact, w, u, force, NULL, &energy) == MSLIP_OK);
    CHECK(mslip_complex_stiffness(contact, 1, &amplitude, &k_real, &k_imag, NULL, NULL) == MSLIP_OK);
    CHECK_RELATIVE(force[1], k_real * amplitude, event_driven ? 1e-12 : 1e-6);
    CHECK_NEAR(force[2], -k_imag * amplitude, (event_driven ? 1e-12 * k_real : 1e-4 * k_imag) * amplitude);
    CHECK_RELATIVE(energy, PI * k_imag * amplitude * amplitude, 1e-12);

    u[1] = 0.0;
    u[0] = 0.3 * contact->slip_displacement;
    CHECK(mslip_harmonic_force(contact, w, u, force, NULL, &energy) == MSLIP_OK);
    CHECK(mslip_monotonic_force(contact, 1, u, &steady, NULL, NULL) == MSLIP_OK);
    CHECK_RELATIVE(force[0], steady, 1e-13);
    for (int i = 1; i < N; ++i) {
        CHECK_NEAR(force[i], 0.0, 1e-14 * steady);
    }
    CHECK_NEAR(energy, 0.0, 1e-30);
}

/* The Jacobian is the derivative of the force: central differences, two steps extrapolated. */
static void check_jacobian(const mslip_contact *contact, double *w, const double *jacobian)
{
    static const double step[4] = { 1.0, -1.0, 0.5, -0.5 };
    const double h = 1e-3 * contact->slip_displacement;
    for (int j = 0; j < N; ++j) {
        double f[4][N];
        for (int k = 0; k < 4; ++k) {
            double moved[N];
            memcpy(moved, displacement, sizeof moved);
            moved[j] += step[k] * h;
            CHECK(mslip_harmonic_force(contact, w, moved, f[k], NULL, NULL) == MSLIP_OK);
        }
        for (int i = 0; i < N; ++i) {
            const double coarse = (f[0][i] - f[1][i]) / (2.0 * h), fine = (f[2][i] - f[3][i]) / h;
            CHECK_NEAR(jacobian[i + N * j], fine + (fine - coarse) / 3.0, 2e-3 * contact->initial_stiffness);
        }
    }
}

/* The table is for 128 uniformly spaced samples and has their error. Other calls in between do not affect the result. */
static void test_table(int32_t rule, size_t samples)
{
    const int event_driven = rule == MSLIP_EVENT_DRIVEN;
    const mslip_contact contact = contact_of(FLAT);
    double *w = workspace_of(samples, rule), *fine = workspace_of(event_driven ? samples : FINE, rule);
    double force[2][N], jacobian[2][N * N], energy[2];
    for (int i = 0; i < 2; ++i) {
        CHECK(mslip_harmonic_force(&contact, w, displacement, force[i], jacobian[i], &energy[i]) == MSLIP_OK);
        check_jacobian(&contact, w, jacobian[i]);
        check_harmonic(&contact, fine, event_driven);
    }
    for (int i = 0; i < N; ++i) {
        CHECK_NEAR(force[0][i], force_of_table[i], (event_driven ? 1e-2 : 2e-13) * 76.4);
    }
    CHECK(same_bits(force[0], force[1], N) && same_bits(jacobian[0], jacobian[1], N * N) && energy[0] == energy[1]);
    free(w);
    free(fine);
}

/* Motions of every kind and size have finite results, and forces of at most mu N. */
static void test_motions(int32_t rule)
{
    static const double shapes[][N] = {
        { 0.0 },
        { 1.0 },
        { 0.0, 1.0 },
        { 0.5, 0.0, 1.0 },
        { 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0 / 3.0 }, /* sin t - sin(3t)/3: flat at its reversals */
        { 0.0, 1.0, 0.0, -0.25 },                     /* cos t - cos(2t)/4: flat at a reversal */
        { 0.1, 0.3, -0.2, 0.2, 0.3, -0.4, 0.5 },
        { 0.0, 0.0, 0.0, 0.0, 0.0, 1.0 },
    };
    static const double sizes[] = { 1e-310, 1e-200, 1e-12, 0.3, 0.999999999999, 1.0, 1.5, 1e3, 1e17, 1e100 };
    double *w = workspace_of(NODES, rule);
    for (int kind = FLAT; kind <= OPEN; ++kind) {
        const mslip_contact contact = contact_of(kind);
        const double slip = kind < OPEN ? contact.slip_displacement : 1e-7;
        for (size_t i = 0; i < LENGTH(shapes) * LENGTH(sizes); ++i) {
            double u[N], force[N], jacobian[N * N], energy;
            int holds;
            for (int k = 0; k < N; ++k) {
                u[k] = shapes[i / LENGTH(sizes)][k] * sizes[i % LENGTH(sizes)] * slip;
            }
            holds = mslip_harmonic_force(&contact, w, u, force, jacobian, &energy) == MSLIP_OK;
            for (int k = 0; holds && k < N; ++k) {
                holds &= isfinite(force[k]) && fabs(force[k]) <= 1.3 * contact.slip_force;
            }
            for (int k = 0; holds && k < N * N; ++k) {
                holds &= !!isfinite(jacobian[k]);
            }
            CHECK(holds && isfinite(energy) && energy >= 0.0);
        }
    }
    free(w);
}

int main(int argc, char **argv)
{
    check_arguments(argc, argv);
    test_table(MSLIP_UNIFORM_SAMPLING, TABLE_SAMPLES);
    test_table(MSLIP_EVENT_DRIVEN, NODES);
    test_motions(MSLIP_UNIFORM_SAMPLING);
    test_motions(MSLIP_EVENT_DRIVEN);
    for (int kind = CYLINDER; kind <= ELLIPSE; ++kind) {
        const mslip_contact contact = contact_of(kind);
        double *w = workspace_of(NODES, MSLIP_EVENT_DRIVEN);
        check_harmonic(&contact, w, 1);
        free(w);
    }
    return check_report();
}
