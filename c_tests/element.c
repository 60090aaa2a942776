/* Friction contact elements against the tables of high-precision reference values, as single steps, paths and batches.
 *
 *     element [--trap] [DIRECTORY]
 *
 * Then what the tables do not cover: mirrored motions, tables for much larger and much smaller loads, restarts, states of any
 * length, separation, loads that vanish or are the largest for the length, merged pieces, two directions, tractions. */
#include "table.h"

#include <float.h>
#include <stddef.h>
#include <stdint.h>

enum { MOST_STEPS = 128, PIECES = 64, STATE = 8 + 4 * (PIECES + 1), LONGEST = 1800 };

static const double PI = 3.14159265358979323846;

/* Differences allowed from the tables, in units of mu N_max, N_max, mu N_max u_max, and of the stiffnesses at the largest load: as
   in the tests in Rust. */
typedef struct {
    double tangential, normal, energy, slope;
} tolerances;
static const tolerances tight = { 1e-14, 1e-14, 1e-13, 1e-11 }, tight_with_layer = { 1e-14, 1e-14, 1e-12, 1e-11 };

/* Each table without a layer, and with one: its compliances under N_layer and N_c. */
#define OF_CONTACT "contact,a,R,L,semi_x,semi_y,N_ref,E1,nu1,E2,nu2,"
#define OF_LAYER "c_n,c_t,N_layer,N_c,"
#define OF_HISTORY "mu,pattern,control,step,N,u_n,delta,T,dT_ddelta,dT_dun,dN_dun,dissipated,stored,end"
#define OF_NORMAL_LAW "given,N,u_n,size,tangential_approach,dN_dun,dS_dun"
enum { HISTORY, CONTACT, A, R, L, SEMI_X, SEMI_Y, N_REF, E1, NU1, E2, NU2, C_N, C_T, N_LAYER, N_C, MU, PATTERN, CONTROL, STEP, N, U_N,
       DELTA, T, DT_DDELTA, DT_DUN, DN_DUN, DISSIPATED, STORED, END, COLUMNS };

/* A row of either table from column CONTACT on, without a layer with zeros for it; returns the first value behind. */
static const double *with_layer(const double *v, int layered, double *row)
{
    memset(row, 0, (MU - CONTACT) * sizeof *row);
    memcpy(row, v, ((layered ? MU : C_N) - CONTACT) * sizeof *row);
    return v + (layered ? MU : C_N) - CONTACT;
}

/* The layer of a row: its compliances are measured under N_layer. */
static mslip_layer layer_of(const double *v)
{
    const mslip_layer layer = { v[C_N], v[C_T], v[N_C], v[N_LAYER] };
    return layer;
}

/* A history of the table. */
typedef struct {
    int line, steps, by_force, opens;
    double row[MOST_STEPS][COLUMNS];
    double largest_force, largest_displacement;
} history;

/* An element for loads up to this one, or for smaller loads if that is too large for the length, or for N_c. */
static void init_from_row(const double *v, double mu, double normal_force, int32_t normal_input, mslip_element *element)
{
    mslip_material material[2] = { { v[E1], v[NU1] }, { v[E2], v[NU2] } };
    normal_force = v[N_LAYER] > 0.0 ? fmin(normal_force, 999.0 * v[N_C]) : normal_force;
    if (isnan(v[A])) {
        mslip_elliptic_parameters p;
        const double scale = normal_force > 0.0 ? cbrt(normal_force / v[N_REF]) : 1.0;
        mslip_elliptic_parameters_default(&p);
        p.semi_axis_x = scale * v[SEMI_X];
        p.semi_axis_y = scale * v[SEMI_Y];
        p.normal_force = normal_force > 0.0 ? normal_force : v[N_REF];
        p.friction_coefficient = mu;
        memcpy(p.material, material, sizeof material);
        p.layer = layer_of(v);
        CHECK(mslip_element_init_elliptic(&p, 1, normal_input, element) == MSLIP_OK);
        return;
    }
    mslip_parameters p;
    int32_t status;
    mslip_parameters_default(&p);
    p.flat_half_width = v[A];
    p.edge_radius = v[R];
    p.length = v[L];
    p.normal_force = normal_force;
    p.friction_coefficient = mu;
    p.displacement_reference = MSLIP_CENTRE_POINT;
    memcpy(p.material, material, sizeof material);
    p.layer = layer_of(v);
    while ((status = mslip_element_init(&p, 1, normal_input, element)) == MSLIP_LENGTH_TOO_SHORT) {
        p.normal_force /= 4.0;
    }
    CHECK(status == MSLIP_OK && mslip_element_check(element) == MSLIP_OK);
}

/* The results of a history. */
typedef struct {
    double force[MOST_STEPS][2], tangent[MOST_STEPS][4], dissipated[MOST_STEPS], state[STATE];
} results;

static int same(const void *p, const void *q, size_t doubles)
{
    return memcmp(p, q, doubles * sizeof(double)) == 0;
}

/* The part of a state that is in use: 8 doubles and 4 for each knot, whose number is in the tag. */
static size_t used(const double *state)
{
    uint64_t tag;
    memcpy(&tag, state, sizeof tag);
    return 8 + 4 * (size_t)(tag & 0xff);
}

static void init_state(size_t length, double *state)
{
    CHECK(mslip_element_state_init(1, length, state) == MSLIP_OK);
}

/* Step by step, each with a new state. */
static void walk(const mslip_element *element, int steps, double displacement[][2], results *r)
{
    double states[2][STATE];
    init_state(STATE, states[0]);
    for (int i = 0; i < steps; ++i) {
        CHECK(mslip_element_update(element, STATE, states[i % 2], displacement[i], states[1 - i % 2], r->force[i], r->tangent[i],
                                   &r->dissipated[i]) == MSLIP_OK);
    }
    memcpy(r->state, states[steps % 2], sizeof r->state);
    CHECK(mslip_element_state_check(1, STATE, r->state) == MSLIP_OK);
}

static int same_results(const results *one, const results *other, int steps)
{
    const size_t n = (size_t)steps;
    return same(one->force, other->force, 2 * n) && same(one->tangent, other->tangent, 4 * n) &&
           same(one->dissipated, other->dissipated, n) && used(one->state) == used(other->state) &&
           same(one->state, other->state, used(one->state));
}

/* In place, as a path, as a path whose state is discarded, in a batch with a mirrored motion, from a copy of the state, and with a
   shorter array: the same bits. */
static void check_same_bits(const mslip_element *element, int steps, double displacement[][2], const results *expected)
{
    static results r, mirrored;
    double state[2 * STATE], old[2 * STATE], both[2][2], force[2][2], tangent[2][4], energy[2], trial[2];
    const size_t n = (size_t)steps;

    init_state(STATE, r.state);
    for (int i = 0; i < steps; ++i) {
        memcpy(state, r.state, sizeof r.state);
        CHECK(mslip_element_update(element, STATE, r.state, displacement[i], NULL, trial, NULL, NULL) == MSLIP_OK);
        CHECK(same(trial, expected->force[i], 2) && same(state, r.state, STATE));
        CHECK(mslip_element_update(element, STATE, r.state, displacement[i], r.state, r.force[i], r.tangent[i], &r.dissipated[i])
              == MSLIP_OK);
    }
    CHECK(same_results(&r, expected, steps));

    init_state(STATE, old);
    memset(&r, 0xff, sizeof r);
    CHECK(mslip_element_path(element, STATE, old, n, displacement[0], r.state, r.force[0], r.tangent[0], r.dissipated) == MSLIP_OK);
    CHECK(same_results(&r, expected, steps));
    memset(r.force, 0xff, sizeof r.force);
    CHECK(mslip_element_path(element, STATE, old, n, displacement[0], NULL, r.force[0], r.tangent[0], r.dissipated) == MSLIP_OK);
    CHECK(same_results(&r, expected, steps));
    /* Two parts; the state was stored in between. */
    const size_t half = n / 2;
    memset(&r, 0xff, sizeof r);
    CHECK(mslip_element_path(element, STATE, old, half, displacement[0], old, r.force[0], r.tangent[0], r.dissipated) == MSLIP_OK);
    memcpy(r.state, old, sizeof r.state);
    memset(old, 0xff, sizeof old);
    CHECK(mslip_element_path(element, STATE, r.state, n - half, displacement[half], r.state, r.force[half], r.tangent[half],
                             r.dissipated + half) == MSLIP_OK);
    CHECK(same_results(&r, expected, steps));

    init_state(STATE, state);
    init_state(STATE, state + STATE);
    for (int i = 0; i < steps; ++i) {
        static const int32_t index[2] = { 0, 0 };
        memcpy(both[0], displacement[i], sizeof both[0]);
        both[1][0] = -both[0][0];
        both[1][1] = both[0][1];
        CHECK(mslip_batch_element_update(2, 1, element, index, NULL, STATE, state, both[0], state, force[0], tangent[0], energy)
              == MSLIP_OK);
        for (int k = 0; k < 2; ++k) {
            results *to = k ? &mirrored : &r;
            memcpy(to->force[i], force[k], sizeof force[k]);
            memcpy(to->tangent[i], tangent[k], sizeof tangent[k]);
            to->dissipated[i] = energy[k];
        }
        /* Mirror images, but for the direction of slip that rounding decides if the force does not change. */
        const double slip_force = element->friction_coefficient * element->normal_force;
        CHECK_NEAR(force[1][0], -force[0][0], 1e-14 * slip_force);
        CHECK_NEAR(energy[1], energy[0], 1e-14 * slip_force * element->approach);
        CHECK(force[1][1] == force[0][1] && tangent[1][3] == tangent[0][3]);
    }
    memcpy(r.state, state, sizeof r.state);
    CHECK(same_results(&r, expected, steps));

    /* Any length that holds all pieces; doubles that do not make a whole piece are not used. */
    for (size_t length = STATE - 4; length < STATE; ++length) {
        memset(&r, 0xff, sizeof r);
        init_state(length, old);
        CHECK(mslip_element_path(element, length, old, n, displacement[0], r.state, r.force[0], r.tangent[0], r.dissipated)
              == MSLIP_OK);
        CHECK(same_results(&r, expected, steps));
    }
}

/* A history with the normal force or the approach as input. */
static void replay(const history *h, int32_t normal_input, double factor, tolerances allowed)
{
    static double displacement[MOST_STEPS][2];
    static mslip_element element, at_largest;
    static results r;
    const double mu = h->row[0][MU], slip_force = mu * h->largest_force;
    const int by_force = normal_input == MSLIP_INPUT_NORMAL_FORCE;
    init_from_row(h->row[0], mu, factor * h->largest_force, normal_input, &element);
    init_from_row(h->row[0], mu, h->largest_force, normal_input, &at_largest);
    for (int i = 0; i < h->steps; ++i) {
        displacement[i][0] = h->row[i][DELTA];
        displacement[i][1] = h->row[i][by_force ? N : U_N];
    }
    walk(&element, h->steps, displacement, &r);
    for (int i = 0; i < h->steps; ++i) {
        const double *v = h->row[i];
        const table at = { NULL, "varying_load", h->line + i, 0, { NULL }, { 0.0 }, "" };
        const double by_approach = by_force ? v[DN_DUN] : 1.0;
        compare(&at, "T", r.force[i][0], v[T], allowed.tangential * slip_force);
        compare(&at, "N", r.force[i][1], v[N], allowed.normal * h->largest_force);
        compare(&at, "energy", r.dissipated[i], v[DISSIPATED], allowed.energy * slip_force * h->largest_displacement);
        CHECK(r.dissipated[i] >= 0.0 && fabs(r.force[i][0]) <= mu * r.force[i][1] * (1.0 + 4.0 * DBL_EPSILON));
        CHECK(r.tangent[i][1] == 0.0 && isfinite(r.tangent[i][0]) && isfinite(r.tangent[i][2]));
        if (!isnan(v[DT_DDELTA])) { /* not at corners */
            compare(&at, "dT/d(delta)", r.tangent[i][0], v[DT_DDELTA], allowed.slope * at_largest.tangential_stiffness);
        }
        if (!isnan(v[DT_DUN])) {
            compare(&at, "dT/d(u_n)", r.tangent[i][2] * by_approach, v[DT_DUN], allowed.slope * mu * at_largest.normal_stiffness);
        }
        compare(&at, "dN/d(u_n)", r.tangent[i][3] * by_approach, v[DN_DUN], allowed.slope * at_largest.normal_stiffness);
    }
    if (factor == 1.0) {
        check_same_bits(&element, h->steps, displacement, &r);
    }
}

static void replay_all_ways(const history *h)
{
    const int32_t given = h->by_force ? MSLIP_INPUT_NORMAL_FORCE : MSLIP_INPUT_APPROACH;
    const tolerances allowed = h->row[0][N_LAYER] > 0.0 ? tight_with_layer : tight;
    replay(h, given, 1.0, allowed);
    /* Tables for a million times this load, or as large as the length and N_c allow, and for a thousandth. */
    replay(h, given, 1e6, allowed);
    replay(h, given, 1e-3, allowed);
    if (!h->opens) {
        /* The other input is rounded. */
        const tolerances rounded = { 1e-13, 1e-13, 1e-12, 1e-11 };
        replay(h, h->by_force ? MSLIP_INPUT_APPROACH : MSLIP_INPUT_NORMAL_FORCE, 1.0, rounded);
    }
}

static void check_histories(int layered)
{
    static history h;
    static table t;
    double row[COLUMNS];
    int more, histories = 0;
    t = layered ? open_table("layer_varying_load", "history," OF_CONTACT OF_LAYER OF_HISTORY)
                : open_table("varying_load", "history," OF_CONTACT OF_HISTORY);
    do {
        more = next_row(&t);
        if (more) {
            row[HISTORY] = t.value[HISTORY];
            memcpy(&row[MU], with_layer(&t.value[CONTACT], layered, &row[CONTACT]), (COLUMNS - MU) * sizeof *row);
        }
        if (h.steps > 0 && (!more || row[HISTORY] != h.row[0][HISTORY])) {
            replay_all_ways(&h);
            memset(&h, 0, sizeof h);
            ++histories;
        }
        if (more) {
            if (h.steps == MOST_STEPS) {
                fprintf(stderr, "a history ending at line %d: the history is too long\n", t.line);
                exit(2);
            }
            h.line = h.steps == 0 ? t.line : h.line;
            h.by_force = strcmp(t.text[layered ? CONTROL : CONTROL - (MU - C_N)], "N") == 0;
            h.opens |= row[N] <= 0.0;
            h.largest_force = fmax(h.largest_force, row[N]);
            h.largest_displacement = fmax(h.largest_displacement, fabs(row[DELTA]));
            memcpy(h.row[h.steps++], row, sizeof h.row[0]);
        }
    } while (more);
    CHECK(histories == 60);
}

/* Both directions of the normal law, by elements of both inputs and for three largest loads. */
static void check_normal_law(int layered)
{
    static table t;
    static mslip_element element;
    static const double factors[] = { 1.0, 1e6, 1e-3 };
    t = layered ? open_table("layer_normal_law", OF_CONTACT OF_LAYER OF_NORMAL_LAW)
                : open_table("normal_law", OF_CONTACT OF_NORMAL_LAW);
    enum { GIVEN, FORCE, APPROACH, SIZE, SHIFT, STIFFNESS };
    while (next_row(&t)) {
        double row[COLUMNS], got[3];
        const double *v = with_layer(t.value, layered, &row[CONTACT]), force = v[FORCE], approach = v[APPROACH];
        const double slope = layered ? 1e-12 : 1e-13; /* the singularities of a layer are closer to the pieces of the tables */
        for (int k = 0; k < 6; ++k) {
            init_from_row(row, 0.5, factors[k / 2] * force, MSLIP_INPUT_APPROACH + k % 2, &element);
            accepted(&t, mslip_normal_force(&element, 1, &approach, &got[0], &got[1], &got[2]));
            compare(&t, "N", got[0], force, 1e-14 * force);
            compare(&t, "dN/d(u_n)", got[1], v[STIFFNESS], slope * v[STIFFNESS]);
            compare(&t, "size", got[2], v[SIZE], 1e-14 * v[SIZE]);
            accepted(&t, mslip_normal_approach(&element, 1, &force, &got[0], &got[1], &got[2]));
            compare(&t, "u_n", got[0], approach, 1e-14 * approach);
            compare(&t, "1/(dN/d(u_n))", got[1], 1.0 / v[STIFFNESS], slope / v[STIFFNESS]);
            compare(&t, "size", got[2], v[SIZE], 1e-14 * v[SIZE]);
        }
    }
}

/* Cylinder, flats of a/b = 0.5 and 0.97, sphere. */
enum { SPHERE = 3, KINDS };
static void init_kind_of(int kind, double friction_coefficient, int32_t directions, int32_t normal_input, mslip_element *element)
{
    static const double flats[] = { 0.0, 6e-5, 5e-4 };
    if (kind == SPHERE) {
        const mslip_elliptic_parameters p = { 2e-4, 2e-4, 800.0, friction_coefficient, { { 2e11, 0.3 }, { 2e11, 0.3 } },
                                              { 0.0, 0.0, 0.0, 0.0 }, 0, 0 };
        CHECK(mslip_element_init_elliptic(&p, directions, normal_input, element) == MSLIP_OK);
    } else {
        mslip_parameters p;
        mslip_parameters_default(&p);
        p.flat_half_width = flats[kind];
        p.edge_radius = 3e-3;
        p.length = 20e-3;
        p.normal_force = 800.0;
        p.displacement_reference = MSLIP_CENTRE_POINT;
        p.friction_coefficient = friction_coefficient;
        p.material[0].young_modulus = p.material[1].young_modulus = 2e11;
        p.material[0].poisson_ratio = p.material[1].poisson_ratio = 0.3;
        CHECK(mslip_element_init(&p, directions, normal_input, element) == MSLIP_OK);
    }
}

/* The displacement under a static force at a constant normal force carries that force, in each direction, and its statuses. */
static void test_static_displacement(void)
{
    static mslip_element element;
    for (int kind = 0; kind < KINDS; ++kind) {
        for (int32_t directions = 1; directions <= 2; ++directions) {
            double force[2] = { 150.0, -60.0 }, normal_force[2] = { 400.0, 123.0 }, u[2] = { 7.0, 7.0 }, compliance[2];
            init_kind_of(kind, 0.5, directions, MSLIP_INPUT_NORMAL_FORCE, &element);
            for (int32_t direction = 0; direction < directions; ++direction) {
                CHECK(mslip_element_displacement(&element, direction, 2, force, normal_force, u, compliance) == MSLIP_OK);
                for (int i = 0; i < 2; ++i) {
                    double state[LONGEST], step[3] = { 0.0, 0.0, 0.0 }, found[3], tangent[9];
                    const int m = directions + 1;
                    CHECK(mslip_element_state_init(directions, LONGEST, state) == MSLIP_OK);
                    step[directions] = normal_force[i];
                    CHECK(mslip_element_update(&element, LONGEST, state, step, state, NULL, NULL, NULL) == MSLIP_OK);
                    step[direction] = u[i];
                    CHECK(mslip_element_update(&element, LONGEST, state, step, state, found, tangent, NULL) == MSLIP_OK);
                    /* The law of two directions has the curve of its springs along y. */
                    const double allowed = direction == 0 ? 1e-13 : 2e-3;
                    CHECK_RELATIVE(found[direction], force[i], allowed);
                    CHECK_RELATIVE(1.0 / compliance[i], tangent[direction * (m + 1)], direction == 0 ? 1e-11 : 2e-2);
                }
            }
            u[0] = 7.0;
            CHECK(mslip_element_displacement(&element, directions, 1, force, normal_force, u, NULL) == MSLIP_BAD_DIRECTIONS);
            CHECK(mslip_element_displacement(&element, -1, 1, force, normal_force, u, NULL) == MSLIP_BAD_DIRECTIONS);
            CHECK(mslip_element_displacement(NULL, 0, 1, force, normal_force, u, NULL) == MSLIP_NULL_POINTER);
            CHECK(mslip_element_displacement(&element, 0, 1, NULL, normal_force, u, NULL) == MSLIP_NULL_POINTER);
            CHECK(mslip_element_displacement(&element, 0, 1, force, NULL, u, NULL) == MSLIP_NULL_POINTER);
            force[1] = 0.5 * normal_force[1] * (1.0 + 1e-12);
            CHECK(mslip_element_displacement(&element, 0, 2, force, normal_force, u, NULL) == MSLIP_FORCE_EXCEEDS_SLIP);
            normal_force[1] = -1.0;
            CHECK(mslip_element_displacement(&element, 0, 2, force, normal_force, u, NULL) == MSLIP_BAD_NORMAL_FORCE);
            normal_force[1] = 0.0;
            force[1] = (double)INFINITY;
            CHECK(mslip_element_displacement(&element, 0, 2, force, normal_force, u, NULL) == MSLIP_BAD_FORCE);
            CHECK(u[0] == 7.0);
            force[1] = 0.0;
            CHECK(mslip_element_displacement(&element, 0, 2, force, normal_force, u, compliance) == MSLIP_OK);
            CHECK(u[1] == 0.0 && isinf(compliance[1]));
        }
    }
}

static void init_kind(int kind, double friction_coefficient, int32_t normal_input, mslip_element *element)
{
    init_kind_of(kind, friction_coefficient, 1, normal_input, element);
}

/* One step in place. */
static int32_t advance(const mslip_element *element, double *state, double u, double w, double *force, double *energy)
{
    const double displacement[2] = { u, w };
    return mslip_element_update(element, STATE, state, displacement, state, force, NULL, energy);
}

/* Separation erases the memory, and the contact closes with the displacement at which the path is at no load. Loads that vanish, or
   nearly: the forces and energies stay finite and continuous. */
static void test_separation(void)
{
    static mslip_element element;
    static const double vanishing[] = { 0.0, -0.0, 5e-324, 1e-310, 1e-300, 1e-150, 1e-70, 1e-55 };
    double state[STATE], fresh[STATE], force[2], expected[2], energy, total;
    for (int kind = 0; kind < KINDS; ++kind) {
        for (int input = MSLIP_INPUT_APPROACH; input <= MSLIP_INPUT_NORMAL_FORCE; ++input) {
            init_kind(kind, 0.5, input, &element);
            const double unit = 400.0 / element.tangential_stiffness;
            const double whole = input == MSLIP_INPUT_APPROACH ? element.approach : 800.0;
            for (size_t k = 0; k < sizeof vanishing / sizeof *vanishing; ++k) {
                /* Constant displacement and falling load; then slip on the way to separation. */
                for (int slips = 0; slips < 2; ++slips) {
                    init_state(STATE, state);
                    CHECK(advance(&element, state, 0.1 * unit, 0.6 * whole, force, &energy) == MSLIP_OK);
                    CHECK(advance(&element, state, 0.3 * unit, whole, force, &total) == MSLIP_OK);
                    for (int step = 1; step <= 3; ++step) {
                        const double w = step < 3 ? whole * (1.0 - step / 3.0) : vanishing[k] * whole;
                        const double u = (0.3 + 0.1 * slips * step) * unit;
                        CHECK(advance(&element, state, u, w, force, &energy) == MSLIP_OK);
                        CHECK(isfinite(force[0]) && fabs(force[0]) <= 0.5 * force[1] * (1.0 + 4.0 * DBL_EPSILON));
                        CHECK(isfinite(energy) && energy >= 0.0);
                        total += energy;
                    }
                    CHECK(total > 0.0 && total < 1e-3 && force[1] <= 1e-50);
                    CHECK(mslip_element_state_check(1, STATE, state) == MSLIP_OK);
                    /* As a new contact that closes from there. */
                    init_state(STATE, fresh);
                    const double start = slips ? 0.6 * unit : 0.3 * unit;
                    CHECK(advance(&element, fresh, start, 0.0, NULL, NULL) == MSLIP_OK);
                    CHECK(advance(&element, fresh, 0.5 * unit, 0.8 * whole, expected, NULL) == MSLIP_OK);
                    CHECK(advance(&element, state, 0.5 * unit, 0.8 * whole, force, NULL) == MSLIP_OK);
                    CHECK_NEAR(force[0], expected[0], 1e-13 * 400.0);
                    CHECK_NEAR(force[1], expected[1], 1e-13 * 800.0);
                }
            }
        }
        /* Open from w = w0 to w = -w0: the path is at no load half-way. */
        init_kind(kind, 0.5, MSLIP_INPUT_APPROACH, &element);
        const double w = element.approach, u = 0.2 * 400.0 / element.tangential_stiffness;
        init_state(STATE, state);
        CHECK(advance(&element, state, u, -w, force, &energy) == MSLIP_OK);
        CHECK(force[0] == 0.0 && force[1] == 0.0 && energy == 0.0);
        CHECK(advance(&element, state, 3.0 * u, w, force, NULL) == MSLIP_OK);
        init_state(STATE, fresh);
        CHECK(advance(&element, fresh, 2.0 * u, 0.0, NULL, NULL) == MSLIP_OK);
        CHECK(advance(&element, fresh, 3.0 * u, w, expected, NULL) == MSLIP_OK);
        CHECK(force[0] > 0.0);
        CHECK_RELATIVE(force[0], expected[0], 1e-13);
    }
}

/* Elements for nearly the largest load that their length allows: the tables are exact up to that load. */
static void test_largest_load(void)
{
    static mslip_element elements[2];
    mslip_parameters p;
    mslip_parameters_default(&p);
    p.edge_radius = 3e-3;
    p.length = 1e-3;
    p.friction_coefficient = 0.5;
    p.displacement_reference = MSLIP_CENTRE_POINT;
    p.material[0].young_modulus = p.material[1].young_modulus = 2e11;
    p.material[0].poisson_ratio = p.material[1].poisson_ratio = 0.3;
    for (int flat = 0; flat < 3; ++flat) {
        double low = 1.0, high = 1e12, force[2][2], energy[2], state[2][STATE];
        p.flat_half_width = 5e-4 * flat;
        while (high - low > 1e-13 * high) {
            p.normal_force = 0.5 * (low + high);
            *(mslip_element_init(&p, 1, MSLIP_INPUT_NORMAL_FORCE, &elements[0]) == MSLIP_OK ? &low : &high) = p.normal_force;
        }
        for (int input = MSLIP_INPUT_APPROACH; input <= MSLIP_INPUT_NORMAL_FORCE; ++input) {
            for (int k = 0; k < 2; ++k) {
                p.normal_force = low * (k ? 1e-3 : 1.0);
                CHECK(mslip_element_init(&p, 1, input, &elements[k]) == MSLIP_OK);
                init_state(STATE, state[k]);
            }
            for (int i = 1; i <= 50; ++i) {
                const double largest = input == MSLIP_INPUT_APPROACH ? elements[0].approach : elements[0].normal_force;
                const double w = largest * i / 50.0 * (1.0 - 1e-9);
                const double u = 1e-3 * elements[0].approach * (i % 7 - 3);
                for (int k = 0; k < 2; ++k) {
                    CHECK(advance(&elements[k], state[k], u, w, force[k], &energy[k]) == MSLIP_OK);
                }
                CHECK_NEAR(force[0][0], force[1][0], 1e-12 * low);
                CHECK_NEAR(force[0][1], force[1][1], 1e-12 * low);
                CHECK_NEAR(energy[0], energy[1], 1e-12 * low * elements[0].approach);
            }
        }
    }
}

/* No friction: no tangential force, no energy, and the normal law. */
static void test_frictionless(void)
{
    static mslip_element element;
    for (int kind = 0; kind < KINDS; ++kind) {
        double state[STATE], force[2], tangent[4], energy, normal[2];
        init_kind(kind, 0.0, MSLIP_INPUT_APPROACH, &element);
        init_state(STATE, state);
        for (int i = 0; i < 10; ++i) {
            const double step[2] = { (i % 3 - 1) * 1e-7, element.approach * (0.3 * (i % 5) - 0.2) };
            CHECK(mslip_element_update(&element, STATE, state, step, state, force, tangent, &energy) == MSLIP_OK);
            CHECK(mslip_normal_force(&element, 1, &step[1], &normal[0], &normal[1], NULL) == MSLIP_OK);
            CHECK(force[0] == 0.0 && tangent[0] == 0.0 && tangent[2] == 0.0 && energy == 0.0);
            CHECK(force[1] == normal[0] && tangent[3] == normal[1] && (step[1] > 0.0) == (normal[0] > 0.0));
        }
    }
}

/* The shortest state merges pieces: the force differs by at most the reported error, which gross slip and separation reset. */
static void test_merged_pieces(void)
{
    static mslip_element element;
    enum { STEPS = 40 };
    const size_t least = mslip_element_state_length(1, 0);
    CHECK(mslip_element_state_length(1, PIECES) == STATE && mslip_element_state_length(1, 4) == least);
    for (int kind = 0; kind < KINDS; ++kind) {
        double state[STATE], shortest[STATE], force[2], merged[2], error = 0.0, none;
        init_kind(kind, 0.5, MSLIP_INPUT_NORMAL_FORCE, &element);
        const double unit = 400.0 / element.tangential_stiffness;
        init_state(STATE, state);
        init_state(least, shortest);
        for (int i = 0; i < STEPS; ++i) {
            const double step[2] = { unit * (0.1 * sin(2.6 * i) + 0.004 * i), 800.0 * (0.1 + 0.02 * i) };
            CHECK(mslip_element_update(&element, STATE, state, step, state, force, NULL, NULL) == MSLIP_OK);
            CHECK(mslip_element_update(&element, least, shortest, step, shortest, merged, NULL, NULL) == MSLIP_OK);
            CHECK(mslip_element_state_error(1, least, shortest, &error) == MSLIP_OK);
            CHECK(mslip_element_state_error(1, STATE, state, &none) == MSLIP_OK && none == 0.0);
            CHECK(fabs(merged[0] - force[0]) <= error + 1e-12 && merged[1] == force[1]);
            CHECK(mslip_element_state_check(1, least, shortest) == MSLIP_OK);
        }
        CHECK(error > 0.0 && error < 0.1 * 400.0);
        /* A path whose state is discarded merges as well. */
        double path[STEPS][2], forces[2][STEPS][2];
        for (int i = 0; i < STEPS; ++i) {
            path[i][0] = unit * (0.1 * sin(2.6 * i) + 0.004 * i);
            path[i][1] = 800.0 * (0.1 + 0.02 * i);
        }
        init_state(least, state);
        CHECK(mslip_element_path(&element, least, state, STEPS, path[0], NULL, forces[0][0], NULL, NULL) == MSLIP_OK);
        CHECK(mslip_element_path(&element, least, state, STEPS, path[0], state, forces[1][0], NULL, NULL) == MSLIP_OK);
        CHECK(same(forces[0], forces[1], 2 * STEPS) && forces[0][STEPS - 1][0] == merged[0]);
        const double far[2] = { 100.0 * unit, 700.0 }, open[2] = { 0.0, 0.0 };
        memcpy(state, shortest, sizeof state);
        CHECK(mslip_element_update(&element, least, shortest, far, shortest, NULL, NULL, NULL) == MSLIP_OK);
        CHECK(mslip_element_state_error(1, least, shortest, &error) == MSLIP_OK && error == 0.0);
        CHECK(mslip_element_update(&element, least, state, open, state, NULL, NULL, NULL) == MSLIP_OK);
        CHECK(mslip_element_state_error(1, least, state, &error) == MSLIP_OK && error == 0.0);
    }
}

/* Steps of two directions: a first contact off the centre, microslip, reversals, gross slip in two directions, separation. */
enum { STEPS_OF_TWO = 10 };
static const double steps_of_two[STEPS_OF_TWO][3] = {
    { 0.05, -0.02, 0.0 }, { 0.1, 0.02, 0.4 }, { 0.3, -0.1, 0.7 }, { 0.1, -0.2, 0.9 }, { 0.2, -0.2, 0.9 },
    { 20.0, 15.0, 0.6 },  { 19.0, 16.0, 0.8 }, { 0.0, 0.0, 0.0 },  { -0.2, 0.1, 0.5 }, { -0.2, 0.1, 0.5 },
};

/* Two directions: single steps, steps in place, steps and paths whose state is discarded, paths and batches have the same bits,
   also if fewer outputs are requested. Coulomb's law, the normal law and the signs of the energies hold. */
static void test_two_directions(void)
{
    static mslip_element element;
    static double old[LONGEST], state[LONGEST], other[LONGEST], states[2 * LONGEST];
    const size_t length = mslip_element_state_length(2, 0);
    CHECK(length > 0 && length <= LONGEST && mslip_element_state_length(2, 1000) == length);
    for (int kind = 0; kind < KINDS; ++kind) {
        for (int input = MSLIP_INPUT_APPROACH; input <= MSLIP_INPUT_NORMAL_FORCE; ++input) {
            double path[STEPS_OF_TWO][3], forces[STEPS_OF_TWO][3], tangents[STEPS_OF_TWO][9], energies[STEPS_OF_TWO];
            double all_forces[STEPS_OF_TWO][3], all_tangents[STEPS_OF_TWO][9], all_energies[STEPS_OF_TWO];
            init_kind_of(kind, 0.5, 2, input, &element);
            CHECK(element.directions == 2 && mslip_element_check(&element) == MSLIP_OK);
            CHECK(mslip_element_state_init(2, LONGEST, old) == MSLIP_OK && mslip_element_state_check(2, LONGEST, old) == MSLIP_OK);
            memcpy(state, old, sizeof state);
            memcpy(other, old, sizeof other);
            for (int i = 0; i < STEPS_OF_TWO; ++i) {
                double force[3], tangent[9], energy, normal[2];
                const double *s = steps_of_two[i], unit = 400.0 / element.tangential_stiffness;
                path[i][0] = unit * s[0];
                path[i][1] = unit * s[1];
                path[i][2] = s[2] * (input == MSLIP_INPUT_NORMAL_FORCE ? 800.0 : element.approach);
                /* The state is discarded; with a new state; in place, with all outputs and with none. */
                CHECK(mslip_element_update(&element, length, state, path[i], NULL, force, tangent, &energy) == MSLIP_OK);
                memcpy(states, state, sizeof state);
                CHECK(mslip_element_update(&element, length, state, path[i], other, forces[i], tangents[i], &energies[i])
                      == MSLIP_OK);
                CHECK(same(state, states, LONGEST) && same(force, forces[i], 3) && same(tangent, tangents[i], 9));
                CHECK(energy == energies[i] && mslip_element_state_check(2, length, other) == MSLIP_OK);
                CHECK(mslip_element_update(&element, length, state, path[i], state, force, NULL, NULL) == MSLIP_OK);
                CHECK(same(state, other, length) && same(force, forces[i], 3));
                CHECK(mslip_element_update(&element, length, states, path[i], states, NULL, tangent, NULL) == MSLIP_OK);
                CHECK(same(states, other, length) && same(tangent, tangents[i], 9));
                CHECK(hypot(force[0], force[1]) <= 0.5 * force[2] * (1.0 + 1e-12) && energy >= 0.0 && isfinite(energy));
                if (input == MSLIP_INPUT_APPROACH) {
                    CHECK(mslip_normal_force(&element, 1, &path[i][2], &normal[0], &normal[1], NULL) == MSLIP_OK);
                } else {
                    normal[0] = path[i][2];
                    normal[1] = normal[0] > 0.0;
                }
                CHECK(force[2] == normal[0] && (path[i][2] == 0.0 || tangent[8] == normal[1]));
                CHECK(tangent[2] == 0.0 && tangent[5] == 0.0 && (force[2] > 0.0 || (force[0] == 0.0 && force[1] == 0.0)));
            }
            /* Far in gross slip the force has the direction of slip. */
            CHECK_NEAR(forces[5][0], 0.5 * forces[5][2] * 0.8, 0.02 * 400.0);
            CHECK_NEAR(forces[5][1], 0.5 * forces[5][2] * 0.6, 0.02 * 400.0);
            CHECK(energies[5] > 0.0);
            /* Paths: with a new state, in two parts in place, and with the state discarded. */
            for (int discarded = 0; discarded < 2; ++discarded) {
                memset(other, 0xff, sizeof other);
                CHECK(mslip_element_path(&element, length, old, STEPS_OF_TWO, path[0], discarded ? NULL : other, all_forces[0],
                                         all_tangents[0], all_energies) == MSLIP_OK);
                CHECK(same(all_forces, forces, 3 * STEPS_OF_TWO) && same(all_tangents, tangents, 9 * STEPS_OF_TWO));
                CHECK(same(all_energies, energies, STEPS_OF_TWO) && (discarded || same(other, state, length)));
            }
            memcpy(other, old, sizeof other);
            CHECK(mslip_element_path(&element, length, other, 4, path[0], other, all_forces[0], NULL, NULL) == MSLIP_OK);
            CHECK(mslip_element_path(&element, length, other, STEPS_OF_TWO - 4, path[4], other, all_forces[4], NULL, NULL)
                  == MSLIP_OK);
            CHECK(same(all_forces, forces, 3 * STEPS_OF_TWO) && same(other, state, length));
            /* A batch with another motion, and a longer state. */
            memcpy(states, old, sizeof old);
            memcpy(states + LONGEST, old, sizeof old);
            for (int i = 0; i < STEPS_OF_TWO; ++i) {
                static const int32_t index[2] = { 0, 0 };
                double both[2][3], force[2][3], tangent[2][9], energy[2];
                memcpy(both[0], path[STEPS_OF_TWO - 1 - i], sizeof both[0]);
                memcpy(both[1], path[i], sizeof both[1]);
                CHECK(mslip_batch_element_update(2, 1, &element, index, NULL, LONGEST, states, both[0], states, force[0],
                                                 tangent[0], energy) == MSLIP_OK);
                CHECK(same(force[1], forces[i], 3) && same(tangent[1], tangents[i], 9) && energy[1] == energies[i]);
            }
            CHECK(same(states + LONGEST, state, length));
        }
    }
}

/* The tractions of a line contact obey Coulomb's law and carry the forces. */
static void test_tractions(void)
{
    enum { POINTS = 20000 };
    static double x[POINTS], pressure[POINTS], shear[POINTS];
    static mslip_element element;
    for (int kind = 0; kind < SPHERE; ++kind) {
        static const double steps[][2] = { { 0.1, 0.4 }, { 0.3, 0.9 }, { 0.7, 0.8 }, { 0.5, 1.1 }, { -0.2, 0.9 }, { 0.3, 1.0 } };
        double state[STATE], force[2], sum[2] = { 0.0, 0.0 };
        int holds = 1;
        init_kind(kind, 0.5, MSLIP_INPUT_NORMAL_FORCE, &element);
        init_state(STATE, state);
        for (size_t i = 0; i < sizeof steps / sizeof *steps; ++i) {
            const double u = steps[i][0] * 400.0 / element.tangential_stiffness;
            CHECK(advance(&element, state, u, 800.0 * steps[i][1], force, NULL) == MSLIP_OK);
        }
        /* The last load is that of the parameters. */
        for (int i = 0; i < POINTS; ++i) {
            x[i] = element.half_width * cos(PI * (i + 0.5) / POINTS);
        }
        CHECK(mslip_element_tractions(&element, STATE, state, POINTS, x, pressure, shear) == MSLIP_OK);
        for (int i = 0; i < POINTS; ++i) {
            const double strip = 20e-3 * element.half_width * PI / POINTS * sin(PI * (i + 0.5) / POINTS);
            sum[0] += shear[i] * strip;
            sum[1] += pressure[i] * strip;
            holds &= fabs(shear[i]) <= 0.5 * pressure[i] + 1e-13 * 1e9;
        }
        CHECK(holds);
        CHECK_NEAR(sum[0], force[0], 1e-6 * 400.0);
        CHECK_NEAR(sum[1], force[1], 1e-6 * 800.0);
        x[0] = 1.001 * element.half_width;
        CHECK(mslip_element_tractions(&element, STATE, state, 1, x, pressure, shear) == MSLIP_OK);
        CHECK(pressure[0] == 0.0 && shear[0] == 0.0);
    }
}

int main(int argc, char **argv)
{
    table_arguments(argc, argv);
    check_histories(0);
    check_histories(1);
    check_normal_law(0);
    check_normal_law(1);
    test_static_displacement();
    test_separation();
    test_largest_load();
    test_frictionless();
    test_merged_pieces();
    test_two_directions();
    test_tractions();
    return check_report();
}
