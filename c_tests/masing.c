/* Masing's rule through the C interface: states, return-point memory, bounded memory, tractions after reversals. */
#include "calls.h"

/* A state of few reversals. */
enum { FEW_REVERSALS = 12, SHORT = 5 + 3 * FEW_REVERSALS };

static void start(double *state)
{
    CHECK(mslip_state_init(SHORT, state) == MSLIP_OK);
}

/* Advances a state in place; the force. */
static double advance(const mslip_contact *contact, size_t length, double *state, double displacement)
{
    double force = NAN;
    CHECK(mslip_masing_update(contact, length, state, displacement, state, &force, NULL, NULL) == MSLIP_OK);
    return force;
}

static double step(const mslip_contact *contact, double *state, double displacement)
{
    return advance(contact, SHORT, state, displacement);
}

static double monotonic(const mslip_contact *contact, double displacement)
{
    double force = NAN;
    CHECK(mslip_monotonic_force(contact, 1, &displacement, &force, NULL, NULL) == MSLIP_OK);
    return force;
}

static void test_state(void)
{
    double state[SHORT + 1];
    CHECK(mslip_state_length(FEW_REVERSALS) == SHORT && mslip_state_length(0) == mslip_state_length(2));
    for (size_t reversals = 3; reversals < 100; ++reversals) {
        CHECK(mslip_state_length(reversals) > mslip_state_length(reversals - 1));
    }
    state[SHORT] = 77.0;
    start(state);
    CHECK(state[SHORT] == 77.0);
}

/* From the unloaded state: the monotonic curve and a quarter of the energy of a cycle. */
static void test_initial_loading(void)
{
    const mslip_contact contact = contact_of(FLAT);
    const double displacement = 8.126045554707419915799969e-8;
    double state[SHORT], force, stiffness, dissipated, expected;
    start(state);
    CHECK(mslip_masing_update(&contact, SHORT, state, displacement, NULL, &force, &stiffness, &dissipated) == MSLIP_OK);
    CHECK_RELATIVE(force, monotonic(&contact, displacement), 1e-14);
    CHECK(mslip_monotonic_force(&contact, 1, &displacement, NULL, &expected, NULL) == MSLIP_OK);
    CHECK_RELATIVE(stiffness, expected, 1e-13);
    CHECK(mslip_dissipated_energy(&contact, 1, &force, &expected) == MSLIP_OK);
    CHECK_RELATIVE(dissipated, expected / 4.0, 1e-12);
}

/* A branch starts at its reversal, closes its loop, and continues as if the loop had not been. */
static void test_return_point_memory(void)
{
    const mslip_contact contact = contact_of(FLAT);
    const double slip = contact.slip_displacement;
    double state[SHORT], without[SHORT], fine[SHORT], peak, force;

    start(state);
    CHECK(step(&contact, state, 0.0) == 0.0);
    peak = step(&contact, state, 0.6 * slip);
    CHECK_RELATIVE(peak, monotonic(&contact, 0.6 * slip), 1e-14);

    /* Masing: twice the monotonic force of half the range. */
    force = step(&contact, state, 0.2 * slip);
    CHECK_NEAR(force, peak - 2.0 * monotonic(&contact, 0.2 * slip), 1e-13 * peak);
    CHECK(step(&contact, state, 0.2 * slip) == force); /* a step of zero */
    /* A loop within the loop. */
    CHECK_NEAR(step(&contact, state, 0.4 * slip), force + 2.0 * monotonic(&contact, 0.1 * slip), 1e-13 * peak);
    CHECK_NEAR(step(&contact, state, 0.2 * slip), force, 1e-13 * peak);
    /* Beyond its start the outer branch continues. */
    CHECK_NEAR(step(&contact, state, -0.1 * slip), peak - 2.0 * monotonic(&contact, 0.35 * slip), 1e-13 * peak);
    /* Back at the first reversal, then along the monotonic curve. */
    CHECK_NEAR(step(&contact, state, 0.6 * slip), peak, 1e-13 * peak);
    force = step(&contact, state, 0.8 * slip);
    CHECK_NEAR(force, monotonic(&contact, 0.8 * slip), 1e-13 * peak);
    start(without);
    CHECK_NEAR(step(&contact, without, 0.8 * slip), force, 1e-13 * peak);

    /* The size of the steps does not matter. */
    start(fine);
    for (int i = 1; i <= 80; ++i) {
        step(&contact, fine, 0.01 * i * slip);
    }
    for (int i = 79; i >= -50; --i) {
        force = step(&contact, fine, 0.01 * i * slip);
    }
    CHECK_NEAR(step(&contact, without, -0.5 * slip), force, 1e-13 * peak);

    /* Gross slip erases the memory. */
    CHECK(step(&contact, state, 5.0 * slip) == contact.slip_force);
    CHECK(step(&contact, without, 5.0 * slip) == contact.slip_force);
    CHECK(step(&contact, state, 4.0 * slip) == step(&contact, without, 4.0 * slip));
    CHECK(step(&contact, state, -4.0 * slip) == -contact.slip_force);
}

/* A closed cycle, in 2 steps or in 200, dissipates the energy of mslip_dissipated_energy; gross slip adds its own. */
static void test_dissipation(void)
{
    const mslip_contact contact = contact_of(FLAT);
    const double amplitude = 0.7 * contact.slip_displacement;
    double state[SHORT], force, energy, one;

    start(state);
    force = step(&contact, state, amplitude);
    CHECK(mslip_dissipated_energy(&contact, 1, &force, &energy) == MSLIP_OK);
    for (int steps = 2; steps <= 200; steps += 198) {
        double sum = 0.0, least = INFINITY;
        for (int i = 1; i <= steps; ++i) {
            const double t = fabs(4.0 * i / steps - 2.0) - 1.0;
            CHECK(mslip_masing_update(&contact, SHORT, state, t * amplitude, state, NULL, NULL, &one) == MSLIP_OK);
            sum += one;
            least = fmin(least, one);
        }
        CHECK(least >= 0.0);
        CHECK_RELATIVE(sum, energy, 1e-12);
    }
    start(state);
    CHECK(mslip_masing_update(&contact, SHORT, state, 3.0 * contact.slip_displacement, state, NULL, NULL, &one) == MSLIP_OK);
    CHECK_RELATIVE(one, contact.slip_energy / 4.0 + 2.0 * contact.slip_force * contact.slip_displacement, 1e-12);
}

/* A path in one call, in two parts and step by step has the same bits. */
static void test_path(void)
{
    enum { STEPS = 9 };
    const mslip_contact contact = contact_of(FLAT);
    double displacement[STEPS] = { 0.3, 0.6, -0.2, 0.1, 0.0, 0.05, 0.5, 1.7, -0.4 };
    double state[3][SHORT], out[3][3][STEPS];

    for (int i = 0; i < STEPS; ++i) {
        displacement[i] *= contact.slip_displacement;
    }
    for (int parts = 0; parts < 3; ++parts) {
        const int size = parts == 0 ? STEPS : parts == 1 ? 4 : 1;
        start(state[parts]);
        for (int i = 0; i < STEPS; i += size) {
            const size_t n = (size_t)(i + size > STEPS ? STEPS - i : size);
            CHECK(mslip_masing_path(&contact, SHORT, state[parts], n, displacement + i, state[parts], out[parts][0] + i,
                                    out[parts][1] + i, out[parts][2] + i) == MSLIP_OK);
        }
        CHECK(same_bits(state[parts], state[0], mslip_state_length(2)) && same_bits(out[parts][0], out[0][0], 3 * STEPS));
    }
    start(state[1]);
    for (int i = 0; i < STEPS; ++i) {
        CHECK(mslip_masing_update(&contact, SHORT, state[1], displacement[i], state[1], out[1][0] + i, out[1][1] + i, out[1][2] + i)
              == MSLIP_OK);
    }
    CHECK(same_bits(state[1], state[0], mslip_state_length(2)) && same_bits(out[1][0], out[0][0], 3 * STEPS));
    /* A path of no steps copies the state. */
    CHECK(mslip_masing_path(&contact, SHORT, state[0], 0, displacement, state[1], NULL, NULL, NULL) == MSLIP_OK);
    CHECK(same_bits(state[1], state[0], SHORT));
}

/* A slowly decaying vibration, each half cycle of which adds a reversal, and the return through the displacement of each. */
enum { HALF_CYCLES = 600, VIBRATION = 2 * HALF_CYCLES - 1, LONG = 5 + 3 * HALF_CYCLES };
static double vibration(const mslip_contact *contact, int i)
{
    const int k = i < HALF_CYCLES ? i : VIBRATION - 1 - i;
    return (k % 2 == 0 ? 0.95 : -0.95) * pow(0.99, k) * (i < HALF_CYCLES ? 1.0 : 1.001) * contact->slip_displacement;
}

static double state_error(size_t length, const double *state)
{
    double error = NAN;
    CHECK(mslip_state_check(length, state) == MSLIP_OK && mslip_state_error(length, state, &error) == MSLIP_OK);
    return error;
}

/* The force of a state with room for all reversals is exact. That of a shorter one has the same bits until a pair of reversals is
   merged, then an error within the reported bound, also on the way back through all loops, and again none after gross slip. */
static void test_bounded_memory(void)
{
    static const size_t reversals[] = { 2, 8, 32 };
    static double exact_state[LONG], state[5 + 3 * 32];
    CHECK(mslip_state_length(HALF_CYCLES) == LONG);
    for (int kind = FLAT; kind <= ELLIPSE; ++kind) {
        const mslip_contact contact = contact_of(kind);
        double largest[3] = { 0.0 };
        for (int m = 0; m < 3; ++m) {
            const size_t n = mslip_state_length(reversals[m]);
            CHECK(mslip_state_init(LONG, exact_state) == MSLIP_OK && mslip_state_init(n, state) == MSLIP_OK);
            for (int i = 0; i < VIBRATION; ++i) {
                const double exact = advance(&contact, LONG, exact_state, vibration(&contact, i));
                const double force = advance(&contact, n, state, vibration(&contact, i)), error = state_error(n, state);
                largest[m] = fmax(largest[m], error);
                CHECK(error >= 0.0 && error <= contact.slip_force && fabs(force - exact) <= error);
                CHECK(i < HALF_CYCLES ? (error == 0.0) == (i <= (int)reversals[m]) : 1);
                CHECK(error > 0.0 || same_bits(&force, &exact, 1));
            }
            CHECK(state_error(LONG, exact_state) == 0.0);
            /* Gross slip, and a reversal after it. */
            for (int i = 0; i < 3; ++i) {
                const double displacement = contact.slip_displacement * (i == 0 ? 3.0 : i == 1 ? 2.4 : 2.6);
                const double exact = advance(&contact, LONG, exact_state, displacement);
                CHECK(advance(&contact, n, state, displacement) == exact && state_error(n, state) == 0.0);
            }
        }
        /* More reversals have less error. */
        CHECK(largest[1] < 0.5 * largest[0] && largest[2] < 0.5 * largest[1]);
    }
}

/* A path in a short state has the bits of single steps; one whose new state is discarded has those of 128 reversals. */
static void test_path_of_many_reversals(void)
{
    enum { COPY = 128 };
    static double displacement[VIBRATION], force[VIBRATION], other_force[VIBRATION], state[LONG], other[LONG];
    const mslip_contact contact = contact_of(FLAT);
    const size_t short_length = mslip_state_length(2), copy_length = mslip_state_length(COPY);
    for (int i = 0; i < VIBRATION; ++i) {
        displacement[i] = vibration(&contact, i);
    }
    CHECK(mslip_state_init(short_length, state) == MSLIP_OK && mslip_state_init(short_length, other) == MSLIP_OK);
    CHECK(mslip_masing_path(&contact, short_length, state, VIBRATION, displacement, state, force, NULL, NULL) == MSLIP_OK);
    for (int i = 0; i < VIBRATION; ++i) {
        other_force[i] = advance(&contact, short_length, other, displacement[i]);
    }
    CHECK(same_bits(force, other_force, VIBRATION) && same_bits(state, other, short_length));

    CHECK(mslip_state_init(LONG, state) == MSLIP_OK && mslip_state_init(copy_length, other) == MSLIP_OK);
    CHECK(mslip_masing_path(&contact, LONG, state, VIBRATION, displacement, NULL, force, NULL, NULL) == MSLIP_OK);
    CHECK(mslip_masing_path(&contact, copy_length, other, VIBRATION, displacement, other, other_force, NULL, NULL) == MSLIP_OK);
    CHECK(same_bits(force, other_force, VIBRATION));
    CHECK(mslip_masing_path(&contact, LONG, state, VIBRATION, displacement, state, other_force, NULL, NULL) == MSLIP_OK);
    /* The forces differ from the first merge on. */
    CHECK(same_bits(force, other_force, COPY) && !same_bits(force, other_force, VIBRATION));
}

/* A full state copied to the beginning of a longer array, whatever that contains, continues with more reversals. */
static void test_longer_state(void)
{
    enum { STEPS = 20, ENOUGH = 5 + 3 * STEPS };
    const mslip_contact contact = contact_of(FLAT);
    double state[SHORT], moved[ENOUGH], longer[ENOUGH];
    start(state);
    CHECK(mslip_state_init(ENOUGH, longer) == MSLIP_OK);
    memset(moved, 0xff, sizeof moved);
    for (int i = 0; i < STEPS; ++i) {
        const double displacement = vibration(&contact, i), expected = advance(&contact, ENOUGH, longer, displacement);
        if (i <= FEW_REVERSALS) {
            CHECK(step(&contact, state, displacement) == expected);
            memcpy(moved, state, sizeof state);
        } else {
            CHECK(advance(&contact, ENOUGH, moved, displacement) == expected && state_error(ENOUGH, moved) == 0.0);
        }
    }
    CHECK(same_bits(moved, longer, mslip_state_length(STEPS - 1)));
}

/* After one loading the tractions of that loading; after a reversal, minus twice those of half the range. */
static void test_tractions(void)
{
    enum { POINTS = 5 };
    const mslip_contact contact = contact_of(FLAT);
    const double x[POINTS] = { 0.0, 1e-4, -2.99e-4, 3.02e-4, 4e-4 };
    double state[SHORT], pressure[2][POINTS], loading[2][POINTS], shear[POINTS];
    start(state);
    const double force = step(&contact, state, 0.6 * contact.slip_displacement);
    CHECK(mslip_masing_tractions(&contact, SHORT, state, POINTS, x, pressure[0], loading[0]) == MSLIP_OK);
    CHECK(mslip_tractions(&contact, force, POINTS, x, pressure[1], loading[1]) == MSLIP_OK);
    const double half = 0.5 * (force - step(&contact, state, 0.1 * contact.slip_displacement));
    double reversed[POINTS];
    CHECK(mslip_masing_tractions(&contact, SHORT, state, POINTS, x, NULL, reversed) == MSLIP_OK);
    CHECK(mslip_tractions(&contact, half, POINTS, x, NULL, shear) == MSLIP_OK);
    for (int i = 0; i < POINTS; ++i) {
        CHECK_RELATIVE(pressure[0][i], pressure[1][i], 1e-14);
        CHECK_NEAR(loading[0][i], loading[1][i], 1e-12 * pressure[1][i]);
        CHECK_NEAR(reversed[i], loading[1][i] - 2.0 * shear[i], 1e-12 * pressure[1][i]);
    }
}

int main(int argc, char **argv)
{
    check_arguments(argc, argv);
    test_state();
    test_initial_loading();
    test_return_point_memory();
    test_dissipation();
    test_path();
    test_bounded_memory();
    test_path_of_many_reversals();
    test_longer_state();
    test_tractions();
    return check_report();
}
