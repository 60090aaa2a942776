/* Masing's rule through the C interface: states, return-point memory, bounded memory, tractions after reversals. */
#include "fixture.h"

#include <stdlib.h>

enum { REVERSALS = 8, STATE = 128 };

static size_t length; /* of a state of REVERSALS */

static void start(double *state)
{
    CHECK(mslip_state_init(length, state) == MSLIP_OK);
}

/* Force after one more step, state in place. */
static double step(const mslip_contact *contact, double *state, double displacement)
{
    double force = NAN;
    CHECK(mslip_masing_update(contact, length, state, displacement, state, &force, NULL, NULL) == MSLIP_OK);
    return force;
}

static double monotonic(const mslip_contact *contact, double displacement)
{
    double force = NAN;
    CHECK(mslip_monotonic_force(contact, 1, &displacement, &force, NULL, NULL) == MSLIP_OK);
    return force;
}

static void test_state(void)
{
    const size_t least = mslip_state_length(0);

    CHECK(least == mslip_state_length(1) && least == mslip_state_length(2));
    for (size_t reversals = 3; reversals < 100; ++reversals) {
        CHECK(mslip_state_length(reversals) > mslip_state_length(reversals - 1));
    }
    length = mslip_state_length(REVERSALS);
    if (length > STATE || 3 * length > CAPACITY) {
        fprintf(stderr, "a state of %d reversals has %lu doubles\n", REVERSALS, (unsigned long)length);
        exit(2);
    }

    poison();
    CHECK(mslip_state_init(length, out[0]) == MSLIP_OK);
    CHECK(is_poison(out[0] + length, CAPACITY - length));
    REJECTED(mslip_state_init(least - 1, out[0]), MSLIP_STATE_TOO_SHORT);
    REJECTED(mslip_state_init(0, out[0]), MSLIP_STATE_TOO_SHORT);
    CHECK(mslip_state_init(length, NULL) == MSLIP_NULL_POINTER);
}

static void test_update(void)
{
    const mslip_contact contact = flat_contact(), open = open_contact();
    const size_t lengths[4] = { length, 1, 1, 1 };
    double initial[STATE], state[STATE], junk[STATE];
    double displacement = 8.126045554707419915799969e-8;

    start(initial);
    EVERY_SUBSET(4, lengths,
                 mslip_masing_update(&contact, length, initial, displacement, OUT(0), OUT(1), OUT(2), OUT(3)));
    /* From the unloaded state, the monotonic curve. */
    CHECK_RELATIVE(reference[1][0], monotonic(&contact, displacement), 1e-14);
    CHECK(mslip_monotonic_force(&contact, 1, &displacement, NULL, out[0], NULL) == MSLIP_OK);
    CHECK_RELATIVE(reference[2][0], out[0][0], 1e-13);
    /* One loading dissipates a quarter of the cycle. */
    CHECK(mslip_dissipated_energy(&contact, 1, &reference[1][0], out[0]) == MSLIP_OK);
    CHECK_RELATIVE(reference[3][0], out[0][0] / 4.0, 1e-12);

    /* In place gives the same bits. */
    memcpy(state, initial, sizeof state);
    CHECK(mslip_masing_update(&contact, length, state, displacement, state, NULL, NULL, NULL) == MSLIP_OK);
    CHECK(same_bits(state, reference[0], length));

    for (int i = 0; i < 3; ++i) {
        REJECTED(mslip_masing_update(&contact, length, initial, not_finite[i], out[0], out[1], out[2], out[3]),
                MSLIP_BAD_DISPLACEMENT);
    }
    REJECTED(mslip_masing_update(NULL, length, initial, 0.0, out[0], out[1], out[2], out[3]), MSLIP_NULL_POINTER);
    REJECTED(mslip_masing_update(&contact, length, NULL, 0.0, out[0], out[1], out[2], out[3]), MSLIP_NULL_POINTER);
    REJECTED(mslip_masing_update(&contact, mslip_state_length(0) - 1, initial, 0.0, out[0], out[1], out[2], out[3]),
            MSLIP_STATE_TOO_SHORT);
    for (int i = 0; i < UNINITIALISED; ++i) {
        const mslip_contact uninitialised = uninitialised_contact(i);
        REJECTED(mslip_masing_update(&uninitialised, length, initial, 0.0, out[0], out[1], out[2], out[3]),
                MSLIP_BAD_CONTACT);
        memset(junk, i == 0 ? 0 : 0xff, sizeof junk);
        REJECTED(mslip_masing_update(&contact, length, junk, 0.0, out[0], out[1], out[2], out[3]), MSLIP_BAD_STATE);
    }

    memcpy(state, initial, sizeof state);
    CHECK(mslip_masing_update(&open, length, state, 1e-6, state, out[1], out[2], out[3]) == MSLIP_OK);
    CHECK(out[1][0] == 0.0 && out[2][0] == 0.0 && out[3][0] == 0.0);
    CHECK(mslip_masing_update(&open, length, state, -1e-6, state, out[1], out[2], out[3]) == MSLIP_OK);
    CHECK(out[1][0] == 0.0 && out[2][0] == 0.0 && out[3][0] == 0.0);
}

/* A branch is measured from its reversal, closes its loop, and continues as if the loop had not been. */
static void test_return_point_memory(void)
{
    const mslip_contact contact = flat_contact();
    const double slip = contact.slip_displacement;
    double state[STATE], without[STATE];
    double peak, force;

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
    double fine[STATE];
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

/* A closed cycle dissipates the energy of mslip_dissipated_energy; gross slip adds its own. */
static void test_dissipation(void)
{
    const mslip_contact contact = flat_contact();
    const double amplitude = 0.7 * contact.slip_displacement;
    double state[STATE], force, energy, cycle = 0.0, one;

    start(state);
    force = step(&contact, state, amplitude);
    for (int i = 0; i < 2; ++i) {
        CHECK(mslip_masing_update(&contact, length, state, i == 0 ? -amplitude : amplitude, state, NULL, NULL, &one)
              == MSLIP_OK);
        cycle += one;
    }
    CHECK(mslip_dissipated_energy(&contact, 1, &force, &energy) == MSLIP_OK);
    CHECK_RELATIVE(cycle, energy, 1e-12);

    /* The same in many small steps, each of which dissipates. */
    double fine = 0.0, least = INFINITY;
    for (int i = 1; i <= 200; ++i) {
        double t = i <= 100 ? 1.0 - 0.02 * i : -1.0 + 0.02 * (i - 100);
        CHECK(mslip_masing_update(&contact, length, state, t * amplitude, state, NULL, NULL, &one) == MSLIP_OK);
        fine += one;
        least = fmin(least, one);
    }
    CHECK(least >= 0.0);
    CHECK_RELATIVE(fine, energy, 1e-12);

    start(state);
    CHECK(mslip_masing_update(&contact, length, state, 3.0 * contact.slip_displacement, state, NULL, NULL, &one)
          == MSLIP_OK);
    CHECK_RELATIVE(one, contact.slip_energy / 4.0 + 2.0 * contact.slip_force * contact.slip_displacement, 1e-12);
}

static void test_path(void)
{
    enum { STEPS = 9 };
    const mslip_contact contact = flat_contact();
    const size_t lengths[4] = { length, STEPS, STEPS, STEPS };
    double displacement[STEPS] = { 0.3, 0.6, -0.2, 0.1, 0.0, 0.05, 0.5, 1.7, -0.4 };
    double initial[STATE], state[STATE], junk[STATE];

    for (int i = 0; i < STEPS; ++i) {
        displacement[i] *= contact.slip_displacement;
    }
    start(initial);
    EVERY_SUBSET(4, lengths, mslip_masing_path(&contact, length, initial, STEPS, displacement, OUT(0), OUT(1), OUT(2),
                                               OUT(3)));

    /* Step by step, and in two parts, gives the same bits. */
    memcpy(state, initial, sizeof state);
    for (int i = 0; i < STEPS; ++i) {
        CHECK(mslip_masing_update(&contact, length, state, displacement[i], state, out[1] + i, out[2] + i, out[3] + i)
              == MSLIP_OK);
    }
    CHECK(same_bits(state, reference[0], length));
    CHECK(same_bits(out[1], reference[1], STEPS) && same_bits(out[2], reference[2], STEPS));
    CHECK(same_bits(out[3], reference[3], STEPS));
    memcpy(state, initial, sizeof state);
    CHECK(mslip_masing_path(&contact, length, state, 4, displacement, state, out[1], NULL, NULL) == MSLIP_OK);
    CHECK(mslip_masing_path(&contact, length, state, STEPS - 4, displacement + 4, state, out[1] + 4, NULL, NULL)
          == MSLIP_OK);
    CHECK(same_bits(state, reference[0], length) && same_bits(out[1], reference[1], STEPS));

    /* No step. */
    poison();
    CHECK(mslip_masing_path(&contact, length, initial, 0, displacement, out[0], out[1], out[2], out[3]) == MSLIP_OK);
    CHECK(same_bits(out[0], initial, length) && is_poison(out[1], 3 * CAPACITY));

    displacement[STEPS - 1] = NAN;
    REJECTED(mslip_masing_path(&contact, length, initial, STEPS, displacement, out[0], out[1], out[2], out[3]),
            MSLIP_BAD_DISPLACEMENT);
    REJECTED(mslip_masing_path(NULL, length, initial, 1, displacement, out[0], out[1], out[2], out[3]),
            MSLIP_NULL_POINTER);
    REJECTED(mslip_masing_path(&contact, length, NULL, 1, displacement, out[0], out[1], out[2], out[3]),
            MSLIP_NULL_POINTER);
    REJECTED(mslip_masing_path(&contact, length, initial, 1, NULL, out[0], out[1], out[2], out[3]), MSLIP_NULL_POINTER);
    for (int i = 0; i < UNINITIALISED; ++i) {
        const mslip_contact uninitialised = uninitialised_contact(i);
        REJECTED(mslip_masing_path(&uninitialised, length, initial, 1, displacement, out[0], out[1], out[2], out[3]),
                MSLIP_BAD_CONTACT);
        memset(junk, i == 0 ? 0 : 0xff, sizeof junk);
        REJECTED(mslip_masing_path(&contact, length, junk, 1, displacement, out[0], out[1], out[2], out[3]),
                MSLIP_BAD_STATE);
    }
}

/* A slowly decaying vibration, each swing of which adds a reversal, and the way back through the displacement of each of them. */
enum { SWINGS = 600, VIBRATION = 2 * SWINGS - 1 };
static double vibration(const mslip_contact *contact, int i)
{
    const int swing = i < SWINGS ? i : VIBRATION - 1 - i;
    return (swing % 2 == 0 ? 0.95 : -0.95) * pow(0.99, swing) * (i < SWINGS ? 1.0 : 1.001) * contact->slip_displacement;
}

static double state_error(size_t state_length, const double *state)
{
    double error = NAN;
    CHECK(mslip_state_check(state_length, state) == MSLIP_OK);
    CHECK(mslip_state_error(state_length, state, &error) == MSLIP_OK);
    return error;
}

/* The force of a state with room for all reversals is exact. That of a shorter one has the same bits until a pair of reversals is
   merged, then an error within the reported bound, also on the way back through all loops, and again none after gross slip. */
static void test_bounded_memory(void)
{
    static const size_t reversals[] = { 2, 8, 32 };
    static double exact_state[5 + 3 * SWINGS], state[5 + 3 * 32];
    const mslip_contact contacts[] = { flat_contact(), cylinder_contact(), elliptic_contact() };
    const size_t exact_length = mslip_state_length(SWINGS);
    CHECK(exact_length == sizeof exact_state / sizeof *exact_state);
    for (int c = 0; c < 3; ++c) {
        const mslip_contact *contact = &contacts[c];
        double largest[3] = { 0.0 };
        for (int m = 0; m < 3; ++m) {
            const size_t n = mslip_state_length(reversals[m]);
            double exact, force, error = 0.0;
            CHECK(mslip_state_init(exact_length, exact_state) == MSLIP_OK && mslip_state_init(n, state) == MSLIP_OK);
            for (int i = 0; i < VIBRATION; ++i) {
                const double displacement = vibration(contact, i);
                CHECK(mslip_masing_update(contact, exact_length, exact_state, displacement, exact_state, &exact, NULL, NULL)
                      == MSLIP_OK);
                CHECK(mslip_masing_update(contact, n, state, displacement, state, &force, NULL, NULL) == MSLIP_OK);
                error = state_error(n, state);
                largest[m] = fmax(largest[m], error);
                CHECK(error >= 0.0 && error <= contact->slip_force && fabs(force - exact) <= error);
                CHECK(i < SWINGS ? (error == 0.0) == (i <= (int)reversals[m]) : 1);
                CHECK(error > 0.0 || same_bits(&force, &exact, 1));
            }
            CHECK(state_error(exact_length, exact_state) == 0.0);
            /* Gross slip, and a reversal after it. */
            for (int i = 0; i < 3; ++i) {
                const double displacement = contact->slip_displacement * (i == 0 ? 3.0 : i == 1 ? 2.4 : 2.6);
                CHECK(mslip_masing_update(contact, exact_length, exact_state, displacement, exact_state, &exact, NULL, NULL)
                      == MSLIP_OK);
                CHECK(mslip_masing_update(contact, n, state, displacement, state, &force, NULL, NULL) == MSLIP_OK);
                CHECK(same_bits(&force, &exact, 1) && state_error(n, state) == 0.0);
            }
        }
        /* More reversals have less error. */
        CHECK(largest[1] < 0.5 * largest[0] && largest[2] < 0.5 * largest[1]);
    }
}

/* A path in a short state has the bits of single steps; one whose new state is discarded has those of 128 reversals. */
static void test_path_of_many_reversals(void)
{
    enum { LONG = 5 + 3 * SWINGS, COPY = 128 };
    static double displacement[VIBRATION], force[VIBRATION], other_force[VIBRATION], state[LONG], other[LONG];
    const mslip_contact contact = flat_contact();
    const size_t short_length = mslip_state_length(2), copy_length = mslip_state_length(COPY);
    for (int i = 0; i < VIBRATION; ++i) {
        displacement[i] = vibration(&contact, i);
    }
    CHECK(mslip_state_init(short_length, state) == MSLIP_OK && mslip_state_init(short_length, other) == MSLIP_OK);
    CHECK(mslip_masing_path(&contact, short_length, state, VIBRATION, displacement, state, force, NULL, NULL) == MSLIP_OK);
    for (int i = 0; i < VIBRATION; ++i) {
        CHECK(mslip_masing_update(&contact, short_length, other, displacement[i], other, &other_force[i], NULL, NULL) == MSLIP_OK);
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

/* A state copied to the beginning of a longer array, whatever the rest of that contains, continues with more reversals. */
static void test_longer_state(void)
{
    enum { STEPS = 20 };
    const mslip_contact contact = flat_contact();
    const size_t enough = mslip_state_length(STEPS);
    double state[STATE], longer[STATE], moved[STATE], force, expected;

    CHECK(enough <= STATE);
    start(state);
    CHECK(mslip_state_init(enough, longer) == MSLIP_OK);
    for (int i = 0; i <= REVERSALS; ++i) {
        CHECK(step(&contact, state, vibration(&contact, i)) != 0.0);
        CHECK(mslip_masing_update(&contact, enough, longer, vibration(&contact, i), longer, NULL, NULL, NULL) == MSLIP_OK);
    }
    memset(moved, 0xff, sizeof moved);
    memcpy(moved, state, length * sizeof(double));
    for (int i = REVERSALS + 1; i < STEPS; ++i) {
        const double displacement = vibration(&contact, i);
        CHECK(mslip_masing_update(&contact, enough, moved, displacement, moved, &force, NULL, NULL) == MSLIP_OK);
        CHECK(mslip_masing_update(&contact, enough, longer, displacement, longer, &expected, NULL, NULL) == MSLIP_OK);
        CHECK(same_bits(&force, &expected, 1) && state_error(enough, moved) == 0.0);
    }
    CHECK(same_bits(moved, longer, mslip_state_length(STEPS - 1)));
}

static void test_tractions(void)
{
    enum { POINTS = 5 };
    static const size_t lengths[2] = { POINTS, POINTS };
    const mslip_contact contact = flat_contact(), open = open_contact();
    const double x[POINTS] = { 0.0, 1e-4, -2.99e-4, 3.02e-4, 4e-4 };
    const double bad[2] = { 0.0, NAN };
    double state[STATE], junk[STATE];
    double force, reversed[POINTS];

    /* After one loading, the tractions of that loading. */
    start(state);
    force = step(&contact, state, 0.6 * contact.slip_displacement);
    EVERY_SUBSET(2, lengths, mslip_masing_tractions(&contact, length, state, POINTS, x, OUT(0), OUT(1)));
    CHECK(mslip_tractions(&contact, force, POINTS, x, out[0], out[1]) == MSLIP_OK);
    for (int i = 0; i < POINTS; ++i) {
        CHECK_RELATIVE(reference[0][i], out[0][i], 1e-14);
        CHECK_NEAR(reference[1][i], out[1][i], 1e-12 * out[0][i]);
    }

    /* After a reversal, minus twice those of half the range. */
    double back = 0.5 * (force - step(&contact, state, 0.1 * contact.slip_displacement));
    CHECK(mslip_masing_tractions(&contact, length, state, POINTS, x, NULL, reversed) == MSLIP_OK);
    CHECK(mslip_tractions(&contact, back, POINTS, x, out[0], out[2]) == MSLIP_OK);
    for (int i = 0; i < POINTS; ++i) {
        CHECK_NEAR(reversed[i], out[1][i] - 2.0 * out[2][i], 1e-12 * out[0][i]);
    }

    poison();
    CHECK(mslip_masing_tractions(&contact, length, state, 0, x, out[0], out[1]) == MSLIP_OK && untouched());
    REJECTED(mslip_masing_tractions(&contact, length, state, 2, bad, out[0], out[1]), MSLIP_BAD_POSITION);
    REJECTED(mslip_masing_tractions(NULL, length, state, 1, x, out[0], out[1]), MSLIP_NULL_POINTER);
    REJECTED(mslip_masing_tractions(&contact, length, NULL, 1, x, out[0], out[1]), MSLIP_NULL_POINTER);
    REJECTED(mslip_masing_tractions(&contact, length, state, 1, NULL, out[0], out[1]), MSLIP_NULL_POINTER);
    for (int i = 0; i < UNINITIALISED; ++i) {
        const mslip_contact uninitialised = uninitialised_contact(i);
        REJECTED(mslip_masing_tractions(&uninitialised, length, state, 1, x, out[0], out[1]), MSLIP_BAD_CONTACT);
        memset(junk, i == 0 ? 0 : 0xff, sizeof junk);
        REJECTED(mslip_masing_tractions(&contact, length, junk, 1, x, out[0], out[1]), MSLIP_BAD_STATE);
    }
    start(state);
    CHECK(mslip_masing_tractions(&open, length, state, POINTS, x, out[0], out[1]) == MSLIP_OK);
    CHECK(out[0][0] == 0.0 && out[1][0] == 0.0);
}

int main(int argc, char **argv)
{
    check_arguments(argc, argv);
    test_state();
    test_update();
    test_return_point_memory();
    test_dissipation();
    test_path();
    test_bounded_memory();
    test_path_of_many_reversals();
    test_longer_state();
    test_tractions();
    return check_report();
}
