/* Alternating frequency/time through the C interface: workspaces, forces, Jacobians. */
#include "fixture.h"

#include <stdlib.h>

enum { HARMONICS = 3, SAMPLES = 128, N = 2 * HARMONICS + 1 };

static const double PI = 3.14159265358979323846;
static size_t length; /* of a workspace of HARMONICS and SAMPLES */

/* Case 3 of the table of harmonic forces: contact 3. */
static const double displacement[N] = {
    -1.032743514817179949570389e-8, 3.482590952017465942897783e-7, 0.0, 4.000215146179563450994928e-8,
    9.733119336249038200948978e-9,  1.357006555907048139958686e-7, 6.745495473297667476041231e-8,
};
static const double force_of_table[N] = {
    -4.187659061710047803366514e-1, 4.143565000565348613576092e1, -7.64493260539773256124719e1,
    -1.081698314128846294125077,    -2.885322988101795434779141,  3.443354832948413483986706e1,
    -5.283214385921310079379079,
};

static double *workspace(void)
{
    double *w = malloc(length * sizeof *w);
    CHECK(w != NULL && mslip_harmonic_workspace_init(HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING, length, w) == MSLIP_OK);
    return w;
}

static void test_workspace(void)
{
    double *w;

    length = mslip_harmonic_workspace_length(HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING);
    CHECK(length > 0);
    CHECK(mslip_harmonic_workspace_length(HARMONICS + 1, SAMPLES, MSLIP_UNIFORM_SAMPLING) > length);
    CHECK(mslip_harmonic_workspace_length(HARMONICS, 2 * SAMPLES, MSLIP_UNIFORM_SAMPLING) > length);

    /* Nothing is written beyond the reported length. */
    w = malloc((length + 8) * sizeof *w);
    memset(w, 0x5a, (length + 8) * sizeof *w);
    CHECK(mslip_harmonic_workspace_init(HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING, length, w) == MSLIP_OK);
    CHECK(is_poison(w + length, 8));

    memset(w, 0x5a, (length + 8) * sizeof *w);
    CHECK(mslip_harmonic_workspace_init(HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING, length - 1, w) == MSLIP_WORKSPACE_TOO_SHORT);
    CHECK(mslip_harmonic_workspace_init(HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING, 0, w) == MSLIP_WORKSPACE_TOO_SHORT);
    CHECK(mslip_harmonic_workspace_init(0, SAMPLES, MSLIP_UNIFORM_SAMPLING, length, w) == MSLIP_BAD_HARMONICS);
    CHECK(mslip_harmonic_workspace_init(SIZE_MAX, SAMPLES, MSLIP_UNIFORM_SAMPLING, length, w) == MSLIP_BAD_HARMONICS);
    CHECK(mslip_harmonic_workspace_init(HARMONICS, 0, MSLIP_UNIFORM_SAMPLING, length, w) == MSLIP_BAD_SAMPLES);
    CHECK(mslip_harmonic_workspace_init(HARMONICS, 2 * HARMONICS, MSLIP_UNIFORM_SAMPLING, length, w) == MSLIP_BAD_SAMPLES);
    CHECK(mslip_harmonic_workspace_init(HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING, length, NULL) == MSLIP_NULL_POINTER);
    CHECK(is_poison(w, length + 8));
    free(w);
}

static void test_force(void)
{
    static const size_t lengths[3] = { N, N * N, 1 };
    const mslip_contact contact = flat_contact(), open = open_contact();
    double bad[N];
    double *w = workspace(), *junk = malloc(length * sizeof *junk);

    EVERY_SUBSET(3, lengths, mslip_harmonic_force(&contact, w, displacement, OUT(0), OUT(1), OUT(2)));
    for (int i = 0; i < N; ++i) {
        CHECK_NEAR(reference[0][i], force_of_table[i], 2e-13 * 76.4);
    }

    /* A constant displacement has a constant force. */
    double constant[N] = { 0.0 };
    constant[0] = 0.3 * contact.slip_displacement;
    CHECK(mslip_harmonic_force(&contact, w, constant, out[0], NULL, out[2]) == MSLIP_OK);
    double steady;
    CHECK(mslip_monotonic_force(&contact, 1, constant, &steady, NULL, NULL) == MSLIP_OK);
    CHECK_RELATIVE(out[0][0], steady, 1e-13);
    for (int i = 1; i < N; ++i) {
        CHECK_NEAR(out[0][i], 0.0, 1e-14 * steady);
    }
    CHECK_NEAR(out[2][0], 0.0, 1e-30);

    /* The Jacobian is the derivative of the force: central differences, two steps extrapolated. */
    for (int j = 0; j < N; ++j) {
        const double h = 1e-3 * contact.slip_displacement;
        double moved[N], f[4][N];
        for (int k = 0; k < 4; ++k) {
            static const double step[4] = { 1.0, -1.0, 0.5, -0.5 };
            memcpy(moved, displacement, sizeof moved);
            moved[j] += step[k] * h;
            CHECK(mslip_harmonic_force(&contact, w, moved, f[k], NULL, NULL) == MSLIP_OK);
        }
        for (int i = 0; i < N; ++i) {
            double coarse = (f[0][i] - f[1][i]) / (2.0 * h), fine = (f[2][i] - f[3][i]) / h;
            CHECK_NEAR(reference[1][i + N * j], fine + (fine - coarse) / 3.0, 2e-3 * contact.initial_stiffness);
        }
    }

    /* One harmonic at fine sampling: the complex stiffness, and the energy of its loop. */
    const double amplitude = 0.8 * contact.slip_displacement;
    double k_real, k_imag, single[N] = { 0.0 };
    size_t fine_length = mslip_harmonic_workspace_length(HARMONICS, 1024, MSLIP_UNIFORM_SAMPLING);
    double *fine = malloc(fine_length * sizeof *fine);
    CHECK(mslip_harmonic_workspace_init(HARMONICS, 1024, MSLIP_UNIFORM_SAMPLING, fine_length, fine) == MSLIP_OK);
    single[1] = amplitude;
    CHECK(mslip_harmonic_force(&contact, fine, single, out[0], NULL, out[2]) == MSLIP_OK);
    CHECK(mslip_complex_stiffness(&contact, 1, &amplitude, &k_real, &k_imag, NULL, NULL) == MSLIP_OK);
    CHECK_RELATIVE(out[0][1], k_real * amplitude, 1e-6);
    CHECK_NEAR(out[0][2], -k_imag * amplitude, 1e-4 * k_imag * amplitude);
    CHECK_RELATIVE(out[2][0], PI * k_imag * amplitude * amplitude, 1e-12);
    free(fine);

    for (int i = 0; i < 3; ++i) {
        memcpy(bad, displacement, sizeof bad);
        bad[N - 1] = not_finite[i];
        REJECTED(mslip_harmonic_force(&contact, w, bad, out[0], out[1], out[2]), MSLIP_BAD_DISPLACEMENT);
    }
    REJECTED(mslip_harmonic_force(NULL, w, displacement, out[0], out[1], out[2]), MSLIP_NULL_POINTER);
    REJECTED(mslip_harmonic_force(&contact, NULL, displacement, out[0], out[1], out[2]), MSLIP_NULL_POINTER);
    REJECTED(mslip_harmonic_force(&contact, w, NULL, out[0], out[1], out[2]), MSLIP_NULL_POINTER);
    for (int i = 0; i < UNINITIALISED; ++i) {
        const mslip_contact uninitialised = uninitialised_contact(i);
        REJECTED(mslip_harmonic_force(&uninitialised, w, displacement, out[0], out[1], out[2]), MSLIP_BAD_CONTACT);
        memset(junk, i == 0 ? 0 : 0xff, length * sizeof *junk);
        REJECTED(mslip_harmonic_force(&contact, junk, displacement, out[0], out[1], out[2]), MSLIP_BAD_WORKSPACE);
    }

    /* Earlier calls do not affect the result. */
    CHECK(mslip_harmonic_force(&contact, w, displacement, out[0], out[1], out[2]) == MSLIP_OK);
    CHECK(same_bits(out[0], reference[0], N) && same_bits(out[1], reference[1], N * N));
    CHECK(out[2][0] == reference[2][0]);

    CHECK(mslip_harmonic_force(&open, w, displacement, out[0], out[1], out[2]) == MSLIP_OK);
    for (int i = 0; i < N; ++i) {
        CHECK(out[0][i] == 0.0 && out[1][i] == 0.0);
    }
    CHECK(out[2][0] == 0.0);
    free(junk);
    free(w);
}

/* Gauss-Legendre nodes between the events. */
static void test_event_driven(void)
{
    enum { NODES = 64 };
    static const size_t lengths[3] = { N, N * N, 1 };
    const mslip_contact contacts[] = { flat_contact(), cylinder_contact(), elliptic_contact(), open_contact() };
    const int32_t rule = MSLIP_EVENT_DRIVEN;
    const size_t needed = mslip_harmonic_workspace_length(HARMONICS, NODES, rule);
    double *w = malloc((needed + 8) * sizeof *w);

    CHECK(needed > 0 && mslip_harmonic_workspace_length(HARMONICS, SAMPLES, MSLIP_UNIFORM_SAMPLING) == length);
    CHECK(mslip_harmonic_workspace_length(HARMONICS, NODES, 2) == 0);
    CHECK(mslip_harmonic_workspace_length(HARMONICS, NODES, -1) == 0);
    CHECK(mslip_harmonic_workspace_length(0, NODES, rule) == 0);
    CHECK(mslip_harmonic_workspace_length(SIZE_MAX, SIZE_MAX, rule) == 0);
    memset(w, 0x5a, (needed + 8) * sizeof *w);
    CHECK(mslip_harmonic_workspace_init(HARMONICS, NODES, 2, needed, w) == MSLIP_BAD_RULE);
    CHECK(mslip_harmonic_workspace_init(0, NODES, rule, needed, w) == MSLIP_BAD_HARMONICS);
    CHECK(mslip_harmonic_workspace_init(HARMONICS, 2 * HARMONICS, rule, needed, w) == MSLIP_BAD_SAMPLES);
    CHECK(mslip_harmonic_workspace_init(HARMONICS, NODES, rule, needed - 1, w) == MSLIP_WORKSPACE_TOO_SHORT);
    CHECK(mslip_harmonic_workspace_init(HARMONICS, NODES, rule, needed, NULL) == MSLIP_NULL_POINTER);
    CHECK(is_poison(w, needed + 8));
    CHECK(mslip_harmonic_workspace_init(HARMONICS, NODES, rule, needed, w) == MSLIP_OK);
    CHECK(is_poison(w + needed, 8));

    EVERY_SUBSET(3, lengths, mslip_harmonic_force(&contacts[0], w, displacement, OUT(0), OUT(1), OUT(2)));
    for (int i = 0; i < N; ++i) {
        /* The table is for 128 uniformly spaced samples and has their error. */
        CHECK_NEAR(reference[0][i], force_of_table[i], 1e-2 * 76.4);
    }

    for (int i = 0; i < 4; ++i) {
        /* Motions of every kind and size have finite results. */
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
        const double slip = contacts[i].slip_displacement > 0.0 ? contacts[i].slip_displacement : 1e-7;
        for (size_t shape = 0; shape < sizeof shapes / sizeof shapes[0]; ++shape) {
            for (size_t size = 0; size < sizeof sizes / sizeof sizes[0]; ++size) {
                double u[N];
                for (int k = 0; k < N; ++k) {
                    u[k] = shapes[shape][k] * sizes[size] * slip;
                }
                CHECK(mslip_harmonic_force(&contacts[i], w, u, out[0], out[1], out[2]) == MSLIP_OK);
                for (int k = 0; k < N; ++k) {
                    CHECK(isfinite(out[0][k]) && fabs(out[0][k]) <= 1.3 * contacts[i].slip_force);
                }
                for (int k = 0; k < N * N; ++k) {
                    CHECK(isfinite(out[1][k]));
                }
                CHECK(isfinite(out[2][0]) && out[2][0] >= 0.0);
            }
        }
    }

    /* One harmonic: the complex stiffness, and the energy of its loop. */
    for (int i = 0; i < 3; ++i) {
        const double amplitude = 0.8 * contacts[i].slip_displacement;
        double k_real, k_imag, single[N] = { 0.0 };
        single[1] = amplitude;
        CHECK(mslip_harmonic_force(&contacts[i], w, single, out[0], NULL, out[2]) == MSLIP_OK);
        CHECK(mslip_complex_stiffness(&contacts[i], 1, &amplitude, &k_real, &k_imag, NULL, NULL) == MSLIP_OK);
        CHECK_RELATIVE(out[0][1], k_real * amplitude, 1e-12);
        CHECK_NEAR(out[0][2], -k_imag * amplitude, 1e-12 * k_real * amplitude);
        CHECK_RELATIVE(out[2][0], PI * k_imag * amplitude * amplitude, 1e-12);
    }
    free(w);
}

int main(int argc, char **argv)
{
    check_arguments(argc, argv);
    test_workspace();
    test_force();
    test_event_driven();
    return check_report();
}
