/* The Masing rule through the C interface: memory of reversals, states, tractions after reversals. */
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
    size_t none = mslip_state_length(0);

    CHECK(none > 0);
    for (size_t reversals = 1; reversals < 100; ++reversals) {
        CHECK(mslip_state_length(reversals) > mslip_state_length(reversals - 1));
    }
    length = mslip_state_length(REVERSALS);
    if (length > STATE || 3 * length > CAPACITY) {
        fprintf(stderr, "a state of %d reversals has %lu numbers\n", REVERSALS, (unsigned long)length);
        exit(2);
    }

    poison();
    CHECK(mslip_state_init(length, out[0]) == MSLIP_OK);
    CHECK(is_poison(out[0] + length, CAPACITY - length));
    REFUSED(mslip_state_init(none - 1, out[0]), MSLIP_STATE_TOO_SHORT);
    REFUSED(mslip_state_init(0, out[0]), MSLIP_STATE_TOO_SHORT);
    CHECK(mslip_state_init(length, NULL) == MSLIP_NULL_POINTER);
}

static void test_update(void)
{
    const mslip_contact contact = flat_contact(), open = open_contact();
    const size_t lengths[4] = { length, 1, 1, 1 };
    double virgin[STATE], state[STATE], junk[STATE];
    double displacement = 8.126045554707419915799969e-8;

    start(virgin);
    EVERY_SUBSET(4, lengths,
                 mslip_masing_update(&contact, length, virgin, displacement, OUT(0), OUT(1), OUT(2), OUT(3)));
    /* From the virgin state, the monotonic curve. */
    CHECK_RELATIVE(reference[1][0], monotonic(&contact, displacement), 1e-14);
    CHECK(mslip_monotonic_force(&contact, 1, &displacement, NULL, out[0], NULL) == MSLIP_OK);
    CHECK_RELATIVE(reference[2][0], out[0][0], 1e-13);
    /* One loading dissipates a quarter of the cycle. */
    CHECK(mslip_dissipated_energy(&contact, 1, &reference[1][0], out[0]) == MSLIP_OK);
    CHECK_RELATIVE(reference[3][0], out[0][0] / 4.0, 1e-12);

    /* In place gives the same bits. */
    memcpy(state, virgin, sizeof state);
    CHECK(mslip_masing_update(&contact, length, state, displacement, state, NULL, NULL, NULL) == MSLIP_OK);
    CHECK(same_bits(state, reference[0], length));

    for (int i = 0; i < 3; ++i) {
        REFUSED(mslip_masing_update(&contact, length, virgin, not_finite[i], out[0], out[1], out[2], out[3]),
                MSLIP_BAD_DISPLACEMENT);
    }
    REFUSED(mslip_masing_update(NULL, length, virgin, 0.0, out[0], out[1], out[2], out[3]), MSLIP_NULL_POINTER);
    REFUSED(mslip_masing_update(&contact, length, NULL, 0.0, out[0], out[1], out[2], out[3]), MSLIP_NULL_POINTER);
    REFUSED(mslip_masing_update(&contact, mslip_state_length(0) - 1, virgin, 0.0, out[0], out[1], out[2], out[3]),
            MSLIP_STATE_TOO_SHORT);
    for (int i = 0; i < UNPREPARED; ++i) {
        const mslip_contact unprepared = unprepared_contact(i);
        REFUSED(mslip_masing_update(&unprepared, length, virgin, 0.0, out[0], out[1], out[2], out[3]),
                MSLIP_BAD_CONTACT);
        memset(junk, i == 0 ? 0 : 0xff, sizeof junk);
        REFUSED(mslip_masing_update(&contact, length, junk, 0.0, out[0], out[1], out[2], out[3]), MSLIP_BAD_STATE);
    }

    memcpy(state, virgin, sizeof state);
    CHECK(mslip_masing_update(&open, length, state, 1e-6, state, out[1], out[2], out[3]) == MSLIP_OK);
    CHECK(out[1][0] == 0.0 && out[2][0] == 0.0 && out[3][0] == 0.0);
    CHECK(mslip_masing_update(&open, length, state, -1e-6, state, out[1], out[2], out[3]) == MSLIP_OK);
    CHECK(out[1][0] == 0.0 && out[2][0] == 0.0 && out[3][0] == 0.0);
}

/* A branch measures from its reversal, closes its loop, and goes on as if the loop had never been. */
static void test_return_point_memory(void)
{
    const mslip_contact contact = flat_contact();
    const double slip = contact.slip_displacement;
    double state[STATE], without[STATE];
    double peak, force;

    start(state);
    CHECK(step(&contact, state, 0.0) == 0.0); /* a first step of zero is no step */
    peak = step(&contact, state, 0.6 * slip);
    CHECK_RELATIVE(peak, monotonic(&contact, 0.6 * slip), 1e-14);

    /* Masing: half the way back costs twice the monotonic force of the half. */
    force = step(&contact, state, 0.2 * slip);
    CHECK_NEAR(force, peak - 2.0 * monotonic(&contact, 0.2 * slip), 1e-13 * peak);
    CHECK(step(&contact, state, 0.2 * slip) == force); /* no step */
    /* A loop within the loop. */
    CHECK_NEAR(step(&contact, state, 0.4 * slip), force + 2.0 * monotonic(&contact, 0.1 * slip), 1e-13 * peak);
    CHECK_NEAR(step(&contact, state, 0.2 * slip), force, 1e-13 * peak);
    /* Beyond its foot the outer branch goes on. */
    CHECK_NEAR(step(&contact, state, -0.1 * slip), peak - 2.0 * monotonic(&contact, 0.35 * slip), 1e-13 * peak);
    /* Back at the first reversal, and on along the monotonic curve. */
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

    /* Gross slip forgets everything. */
    CHECK(step(&contact, state, 5.0 * slip) == contact.slip_force);
    CHECK(step(&contact, without, 5.0 * slip) == contact.slip_force);
    CHECK(step(&contact, state, 4.0 * slip) == step(&contact, without, 4.0 * slip));
    CHECK(step(&contact, state, -4.0 * slip) == -contact.slip_force);
}

/* A closed cycle dissipates what mslip_dissipated_energy says, and gross slip the rest. */
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

    /* The same in many small steps, none of which gains energy. */
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
    double virgin[STATE], state[STATE], junk[STATE];

    for (int i = 0; i < STEPS; ++i) {
        displacement[i] *= contact.slip_displacement;
    }
    start(virgin);
    EVERY_SUBSET(4, lengths, mslip_masing_path(&contact, length, virgin, STEPS, displacement, OUT(0), OUT(1), OUT(2),
                                               OUT(3)));

    /* Step by step, and in two parts, gives the same bits. */
    memcpy(state, virgin, sizeof state);
    for (int i = 0; i < STEPS; ++i) {
        CHECK(mslip_masing_update(&contact, length, state, displacement[i], state, out[1] + i, out[2] + i, out[3] + i)
              == MSLIP_OK);
    }
    CHECK(same_bits(state, reference[0], length));
    CHECK(same_bits(out[1], reference[1], STEPS) && same_bits(out[2], reference[2], STEPS));
    CHECK(same_bits(out[3], reference[3], STEPS));
    memcpy(state, virgin, sizeof state);
    CHECK(mslip_masing_path(&contact, length, state, 4, displacement, state, out[1], NULL, NULL) == MSLIP_OK);
    CHECK(mslip_masing_path(&contact, length, state, STEPS - 4, displacement + 4, state, out[1] + 4, NULL, NULL)
          == MSLIP_OK);
    CHECK(same_bits(state, reference[0], length) && same_bits(out[1], reference[1], STEPS));

    /* No step. */
    poison();
    CHECK(mslip_masing_path(&contact, length, virgin, 0, displacement, out[0], out[1], out[2], out[3]) == MSLIP_OK);
    CHECK(same_bits(out[0], virgin, length) && is_poison(out[1], 3 * CAPACITY));

    displacement[STEPS - 1] = NAN;
    REFUSED(mslip_masing_path(&contact, length, virgin, STEPS, displacement, out[0], out[1], out[2], out[3]),
            MSLIP_BAD_DISPLACEMENT);
    REFUSED(mslip_masing_path(NULL, length, virgin, 1, displacement, out[0], out[1], out[2], out[3]),
            MSLIP_NULL_POINTER);
    REFUSED(mslip_masing_path(&contact, length, NULL, 1, displacement, out[0], out[1], out[2], out[3]),
            MSLIP_NULL_POINTER);
    REFUSED(mslip_masing_path(&contact, length, virgin, 1, NULL, out[0], out[1], out[2], out[3]), MSLIP_NULL_POINTER);
    for (int i = 0; i < UNPREPARED; ++i) {
        const mslip_contact unprepared = unprepared_contact(i);
        REFUSED(mslip_masing_path(&unprepared, length, virgin, 1, displacement, out[0], out[1], out[2], out[3]),
                MSLIP_BAD_CONTACT);
        memset(junk, i == 0 ? 0 : 0xff, sizeof junk);
        REFUSED(mslip_masing_path(&contact, length, junk, 1, displacement, out[0], out[1], out[2], out[3]),
                MSLIP_BAD_STATE);
    }
}

/* A state that can hold no more reversals refuses the step and stays as it was; a longer one goes on. */
static void test_full_state(void)
{
    enum { STEPS = 20 };
    const mslip_contact contact = flat_contact();
    double virgin[STATE], displacement[STEPS], before[STATE];
    int32_t status = MSLIP_OK;
    int taken = 0;

    /* Ever smaller swings: each adds a reversal. */
    for (int i = 0; i < STEPS; ++i) {
        displacement[i] = (i % 2 == 0 ? 0.9 : -0.9) * pow(0.8, i) * contact.slip_displacement;
    }
    start(virgin);
    memcpy(before, virgin, sizeof before);
    while (taken < STEPS && status == MSLIP_OK) {
        memcpy(before, virgin, sizeof before);
        status = mslip_masing_update(&contact, length, virgin, displacement[taken++], virgin, NULL, NULL, NULL);
    }
    CHECK(status == MSLIP_STATE_FULL);
    CHECK(same_bits(virgin, before, length));
    CHECK(taken == REVERSALS + 2); /* the first step leaves the virgin state, each further one adds a reversal */

    /* Copied to the beginning of a longer array, whatever else is in that, it goes on as if it had always been there. */
    size_t enough = mslip_state_length(STEPS);
    double longer[STATE], moved[STATE], force, expected;
    CHECK(enough <= STATE);
    CHECK(mslip_state_init(enough, longer) == MSLIP_OK);
    CHECK(mslip_masing_path(&contact, enough, longer, (size_t)(taken - 1), displacement, longer, NULL, NULL, NULL)
          == MSLIP_OK);
    memset(moved, 0xff, sizeof moved);
    memcpy(moved, virgin, length * sizeof(double));
    for (int i = taken - 1; i < STEPS; ++i) {
        CHECK(mslip_masing_update(&contact, enough, moved, displacement[i], moved, &force, NULL, NULL) == MSLIP_OK);
        CHECK(mslip_masing_update(&contact, enough, longer, displacement[i], longer, &expected, NULL, NULL) == MSLIP_OK);
        CHECK(same_bits(&force, &expected, 1));
    }
    CHECK(same_bits(moved, longer, mslip_state_length(STEPS - 1)));

    start(virgin);
    REFUSED(mslip_masing_path(&contact, length, virgin, STEPS, displacement, out[0], out[1], out[2], out[3]),
            MSLIP_STATE_FULL);

    /* A closed loop frees its place. */
    CHECK(mslip_masing_path(&contact, length, virgin, REVERSALS + 1, displacement, virgin, NULL, NULL, NULL)
          == MSLIP_OK);
    CHECK(step(&contact, virgin, displacement[0]) > 0.0);
    CHECK(step(&contact, virgin, displacement[1]) < 0.0);
}

static void test_tractions(void)
{
    enum { POINTS = 5 };
    static const size_t lengths[2] = { POINTS, POINTS };
    const mslip_contact contact = flat_contact(), open = open_contact();
    const double x[POINTS] = { 0.0, 1e-4, -2.99e-4, 3.02e-4, 4e-4 };
    const double bad[2] = { 0.0, NAN };
    double state[STATE], junk[STATE];
    double force, turned[POINTS];

    /* After one loading, the tractions of that loading. */
    start(state);
    force = step(&contact, state, 0.6 * contact.slip_displacement);
    EVERY_SUBSET(2, lengths, mslip_masing_tractions(&contact, length, state, POINTS, x, OUT(0), OUT(1)));
    CHECK(mslip_tractions(&contact, force, POINTS, x, out[0], out[1]) == MSLIP_OK);
    for (int i = 0; i < POINTS; ++i) {
        CHECK_RELATIVE(reference[0][i], out[0][i], 1e-14);
        CHECK_NEAR(reference[1][i], out[1][i], 1e-12 * out[0][i]);
    }

    /* After a reversal, less twice those of half the way back. */
    double back = 0.5 * (force - step(&contact, state, 0.1 * contact.slip_displacement));
    CHECK(mslip_masing_tractions(&contact, length, state, POINTS, x, NULL, turned) == MSLIP_OK);
    CHECK(mslip_tractions(&contact, back, POINTS, x, out[0], out[2]) == MSLIP_OK);
    for (int i = 0; i < POINTS; ++i) {
        CHECK_NEAR(turned[i], out[1][i] - 2.0 * out[2][i], 1e-12 * out[0][i]);
    }

    poison();
    CHECK(mslip_masing_tractions(&contact, length, state, 0, x, out[0], out[1]) == MSLIP_OK && untouched());
    REFUSED(mslip_masing_tractions(&contact, length, state, 2, bad, out[0], out[1]), MSLIP_BAD_POSITION);
    REFUSED(mslip_masing_tractions(NULL, length, state, 1, x, out[0], out[1]), MSLIP_NULL_POINTER);
    REFUSED(mslip_masing_tractions(&contact, length, NULL, 1, x, out[0], out[1]), MSLIP_NULL_POINTER);
    REFUSED(mslip_masing_tractions(&contact, length, state, 1, NULL, out[0], out[1]), MSLIP_NULL_POINTER);
    for (int i = 0; i < UNPREPARED; ++i) {
        const mslip_contact unprepared = unprepared_contact(i);
        REFUSED(mslip_masing_tractions(&unprepared, length, state, 1, x, out[0], out[1]), MSLIP_BAD_CONTACT);
        memset(junk, i == 0 ? 0 : 0xff, sizeof junk);
        REFUSED(mslip_masing_tractions(&contact, length, junk, 1, x, out[0], out[1]), MSLIP_BAD_STATE);
    }
    start(state);
    CHECK(mslip_masing_tractions(&open, length, state, POINTS, x, out[0], out[1]) == MSLIP_OK);
    CHECK(out[0][0] == 0.0 && out[1][0] == 0.0);
}

/* Many contacts at once are as many single calls, to the last bit. */
static void test_interface(void)
{
    enum { ITEMS = 3 };
    static const int32_t active[ITEMS] = { 1, 0, -1 };
    const mslip_contact contacts[ITEMS] = { flat_contact(), elliptic_contact(), cylinder_contact() };
    const size_t lengths[4] = { ITEMS * length, ITEMS, ITEMS, ITEMS };
    mslip_contact unprepared[ITEMS];
    double states[ITEMS * STATE], single[STATE];
    double displacement[ITEMS] = { 3e-8, -5e-8, 6e-8 };

    for (int i = 0; i < ITEMS; ++i) {
        start(states + i * length);
        step(&contacts[i], states + i * length, -2e-8);
    }
    EVERY_SUBSET(4, lengths, mslip_interface_masing_update(ITEMS, contacts, NULL, length, states, displacement, OUT(0),
                                                           OUT(1), OUT(2), OUT(3)));
    for (int i = 0; i < ITEMS; ++i) {
        double force, stiffness, dissipated;
        CHECK(mslip_masing_update(&contacts[i], length, states + i * length, displacement[i], single, &force,
                                  &stiffness, &dissipated) == MSLIP_OK);
        CHECK(same_bits(single, reference[0] + i * length, length));
        CHECK(force == reference[1][i] && stiffness == reference[2][i] && dissipated == reference[3][i]);
    }

    /* Item 1 rests: its outputs are untouched, and nothing of it is looked at. */
    memcpy(unprepared, contacts, sizeof unprepared);
    unprepared[1] = unprepared_contact(1);
    displacement[1] = NAN;
    poison();
    CHECK(mslip_interface_masing_update(ITEMS, unprepared, active, length, states, displacement, out[0], out[1], out[2],
                                        out[3]) == MSLIP_OK);
    CHECK(is_poison(out[0] + length, length) && is_poison(out[1] + 1, 1) && is_poison(out[2] + 1, 1));
    CHECK(is_poison(out[3] + 1, 1));
    CHECK(same_bits(out[0], reference[0], length) && same_bits(out[0] + 2 * length, reference[0] + 2 * length, length));
    CHECK(out[1][0] == reference[1][0] && out[1][2] == reference[1][2]);

    /* At work it is refused, and nothing is written for the others either. */
    REFUSED(mslip_interface_masing_update(ITEMS, unprepared, NULL, length, states, displacement, out[0], out[1], out[2],
                                          out[3]), MSLIP_BAD_CONTACT);
    REFUSED(mslip_interface_masing_update(ITEMS, contacts, NULL, length, states, displacement, out[0], out[1], out[2],
                                          out[3]), MSLIP_BAD_DISPLACEMENT);
    displacement[1] = 0.0;
    memset(states + 2 * length, 0, length * sizeof *states);
    REFUSED(mslip_interface_masing_update(ITEMS, contacts, NULL, length, states, displacement, out[0], out[1], out[2],
                                          out[3]), MSLIP_BAD_STATE);
    REFUSED(mslip_interface_masing_update(ITEMS, NULL, NULL, length, states, displacement, out[0], out[1], out[2],
                                          out[3]), MSLIP_NULL_POINTER);
    REFUSED(mslip_interface_masing_update(ITEMS, contacts, NULL, length, NULL, displacement, out[0], out[1], out[2],
                                          out[3]), MSLIP_NULL_POINTER);
    REFUSED(mslip_interface_masing_update(ITEMS, contacts, NULL, length, states, NULL, out[0], out[1], out[2],
                                          out[3]), MSLIP_NULL_POINTER);
    REFUSED(mslip_interface_masing_update(2, contacts, NULL, 1, states, displacement, out[0], out[1], out[2], out[3]),
            MSLIP_STATE_TOO_SHORT);
    poison();
    CHECK(mslip_interface_masing_update(0, contacts, NULL, length, states, displacement, out[0], out[1], out[2], out[3])
          == MSLIP_OK && untouched());

    /* In place. */
    CHECK(mslip_interface_masing_update(2, contacts, NULL, length, states, displacement, states, NULL, NULL, NULL)
          == MSLIP_OK);
    CHECK(same_bits(states, reference[0], length));
}

int main(int argc, char **argv)
{
    check_arguments(argc, argv);
    test_state();
    test_update();
    test_return_point_memory();
    test_dissipation();
    test_path();
    test_full_state();
    test_tractions();
    test_interface();
    return check_report();
}
