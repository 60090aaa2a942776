/* reference.c: the law in quadruple precision from the paper's integrals over the sizes of contact.
 *
 * A flat punch of half-width c adds compliance ln(2L/c) + nu/(1-nu) (Eq. 8) and, as the contact grows, the load
 * dP = E* psi w dw / R, w = sqrt(c^2 - a^2), psi = atan(w/a). Integrals of these over w are load and displacement of Eq. 10
 * with the order of integration exchanged: no closed form is used. */
#include "reference.h"
#include "law.h"

#include <math.h>
#include <quadmath.h>
#include <stdlib.h>

typedef __float128 quad;

struct reference {
    quad flat, length, radius, friction, modulus, poisson;
    quad w;
    quad force_unit, displacement_unit; /* of the integrals below */
    quad slip_force, slip_displacement;
    law start; /* only for first guesses in double precision */
};

/* tanh-sinh on (0, 1): the distance of a node from the nearer end, and its weight. */
enum { HALF = 68 };
static quad distance[HALF + 1], weight[HALF + 1];

/* Gauss-Legendre on (0, 1). */
enum { GAUSS = 32 };
static quad gauss_node[GAUSS], gauss_weight[GAUSS];

static void prepare_rule(void)
{
    const quad h = 1.0Q / 16;
    for (int k = 0; k <= HALF; ++k) {
        const quad x = M_PIq * sinhq(k * h), away = expq(-x);
        distance[k] = away / (1 + away);
        weight[k] = h * M_PIq * coshq(k * h) * away / ((1 + away) * (1 + away));
    }
    for (int i = 0; i < GAUSS; ++i) {
        quad x = cosq(M_PIq * (i + 0.75Q) / (GAUSS + 0.5Q)), slope = 1;
        for (int step = 0; step < 8; ++step) {
            quad p = 1, before = 0;
            for (int j = 1; j <= GAUSS; ++j) {
                const quad next = ((2 * j - 1) * x * p - (j - 1) * before) / j;
                before = p;
                p = next;
            }
            slope = GAUSS * (x * p - before) / (x * x - 1);
            x -= p / slope;
        }
        gauss_node[i] = (1 - x) / 2;
        gauss_weight[i] = 1 / ((1 - x * x) * slope * slope);
    }
}

/* Way from the first end to node k, -HALF <= k <= HALF, of a stretch: to all digits, however near the end. */
static quad way_to(quad width, int k)
{
    return k < 0 ? width * distance[-k] : width - width * distance[k];
}

/* Integrals of w psi and of (ln(2L/c) + nu/(1-nu)) w psi. */
typedef struct { quad load, approach; } integrals;

static quad load_slope(const reference *r, quad w)
{
    return w * (r->flat > 0 ? atan2q(w, r->flat) : M_PI_2q);
}

static quad compliance(const reference *r, quad w)
{
    return r->poisson + logq(4 * r->length * r->length / (r->flat * r->flat + w * w)) / 2;
}

static void add_node(const reference *r, quad w, quad dw, integrals *sum)
{
    const quad load = load_slope(r, w) * dw;
    sum->load += load;
    sum->approach += load * compliance(r, w);
}

static integrals between(const reference *r, quad from, quad width)
{
    integrals sum = { 0, 0 };
    if (r->flat == 0) {
        /* w log w at the end: every other node is enough, and weights fall below 1e-24 soon. */
        enum { INNER = 56 };
        for (int k = -INNER; k <= INNER; k += 2) {
            add_node(r, from + way_to(width, k), 2 * width * weight[abs(k)], &sum);
        }
        return sum;
    }
    /* Smooth, but for poles at w = +-ia: stretches not much longer than the way to these. */
    while (width > 0) {
        const quad longest = 2 * from + 4 * r->flat, stretch = width > longest ? longest : width;
        for (int i = 0; i < GAUSS; ++i) {
            add_node(r, from + stretch * gauss_node[i], stretch * gauss_weight[i], &sum);
        }
        from += stretch;
        width -= stretch;
    }
    return sum;
}


static quad tangent(const reference *r, quad w)
{
    return M_PI_2q * r->modulus * r->length / compliance(r, w);
}

reference *reference_of(const mslip_parameters *p)
{
    reference *r = malloc(sizeof *r);
    *r = (reference) { .flat = p->flat_half_width, .length = p->length, .radius = p->edge_radius,
                       .friction = p->friction_coefficient };
    prepare_rule();
    quad soft[2];
    for (int i = 0; i < 2; ++i) {
        const quad nu = p->material[i].poisson_ratio;
        soft[i] = (1 - nu * nu) / p->material[i].young_modulus;
        r->poisson += soft[i] * nu / (1 - nu);
    }
    r->modulus = 1 / (soft[0] + soft[1]);
    r->poisson *= r->modulus;

    /* The load is convex in w: Newton from above. */
    const quad load = (quad)p->normal_force / r->length, wanted = load * r->radius / r->modulus;
    quad w = sqrtq(4 * wanted / M_PIq);
    while (between(r, 0, w).load < wanted) {
        w *= 2;
    }
    for (quad step = w; fabsq(step) > 1e-17Q * w;) {
        step = (between(r, 0, w).load - wanted) / load_slope(r, w);
        w -= step;
    }
    r->w = w;
    r->force_unit = r->friction * r->length * r->modulus / r->radius;
    r->displacement_unit = 2 * r->friction / (M_PIq * r->radius);
    r->slip_force = r->friction * p->normal_force;
    r->slip_displacement = r->displacement_unit * between(r, 0, w).approach;
    r->start = law_of(p);
    return r;
}

/* Stick zone at 0 < displacement < slip; the closed form's guess, then Newton. Also the force there. */
static quad stick(const reference *r, quad displacement, quad *force)
{
    /* From the end that is nearer. */
    const int late = displacement > r->slip_displacement / 2;
    const quad wanted = (late ? r->slip_displacement - displacement : displacement) / r->displacement_unit;
    double guess = (double)displacement / (double)r->slip_displacement * r->start.slip_displacement;
    quad w = guess < r->start.slip_displacement ? closed_form_stick(&r->start, guess) : 0;
    w *= r->w / (quad)r->start.w;
    if (!(w > 0 && w < r->w)) {
        w = late ? 1e-6Q * r->w : r->w - wanted / (load_slope(r, r->w) * compliance(r, r->w));
    }
    quad load = 0;
    for (int i = 0; i < 100; ++i) {
        const integrals way = late ? between(r, 0, w) : between(r, w, r->w - w);
        const quad slope = load_slope(r, w), excess = way.approach - wanted;
        quad next = w - (late ? 1 : -1) * excess / (slope * compliance(r, w));
        if (next <= 0 || next >= r->w) {
            next = next <= 0 ? w / 2 : (w + r->w) / 2;
        }
        const quad step = next - w;
        load = way.load + (late ? 1 : -1) * slope * step;
        w = next;
        if (fabsq(step) < 1e-13Q * fminq(w, r->w - w)) {
            break;
        }
    }
    *force = late ? r->slip_force - r->force_unit * load : r->force_unit * load;
    return w;
}

static quad curve(const void *context, quad displacement, quad *stiffness)
{
    const reference *r = context;
    if (displacement >= r->slip_displacement) {
        *stiffness = 0;
        return r->slip_force;
    }
    if (displacement <= 0) {
        *stiffness = tangent(r, r->w);
        return 0;
    }
    quad force;
    *stiffness = tangent(r, stick(r, displacement, &force));
    return force;
}

#define REAL quad
#define WALK quad
#define CURVE curve
#define SLIP(r) (((const reference *)(r))->slip_displacement)
#define FORCE(r) (((const reference *)(r))->slip_force)
#include "masing.inc.h"

double reference_slip_displacement(const reference *r)
{
    return (double)r->slip_displacement;
}

void reference_curve(const reference *r, double displacement, double *force, double *stiffness)
{
    quad k;
    *force = (double)curve(r, displacement, &k);
    *stiffness = (double)k;
}

double reference_displacement(const reference *r, double force)
{
    /* Stick zone by bisection and Newton on the load. */
    const quad wanted = (quad)force / r->force_unit;
    quad low = 0, high = r->w, w = r->w / 2;
    for (int i = 0; i < 200; ++i) {
        const quad excess = between(r, w, r->w - w).load - wanted;
        if (excess > 0) {
            low = w;
        } else {
            high = w;
        }
        quad next = w + excess / load_slope(r, w);
        if (!(next > low && next < high)) {
            next = (low + high) / 2;
        }
        const quad step = fabsq(next - w);
        w = next;
        if (step < 1e-28Q * r->w) {
            break;
        }
    }
    return (double)(r->displacement_unit * between(r, w, r->w - w).approach);
}

void reference_stiffness(const reference *r, double amplitude, double result[4])
{
    /* With X = M/amplitude, over the forces T up to that of the amplitude (at most mu N):
         K' amplitude  = (8/pi) int sqrt(X (1-X)) dT,        d(K' amplitude) = -(4/pi) int sqrt(X/(1-X)) (1-2X) dT/amplitude,
         E = 8 int T dM - 4 T M up to slip,                dE = 4 (T - amplitude k). */
    const quad a = amplitude;
    const int slides = a >= r->slip_displacement;
    quad top = r->slip_force, inner = 0, k = 0;
    if (!slides) {
        inner = stick(r, a, &top);
        k = tangent(r, inner);
    }
    quad real = 0, real_slope = 0, area = 0;
    /* Stretches as in `between`; the roots are at the outer ends. */
    for (quad before = 0, after = r->w - inner, width; after > 0; before += width) {
        const quad longest = 2 * (inner + before) + 4 * r->flat;
        width = r->flat > 0 && after > longest ? longest : after;
        after -= width;
        for (int i = -HALF; i <= HALF; ++i) {
            /* What lies between the node and the ends is integrated from them, so that 1 - X keeps its digits. */
            const quad from = before + way_to(width, i), w = inner + from;
            const integrals way = between(r, w, after + way_to(width, -i)), left = between(r, inner, from);
            const quad x = r->displacement_unit * way.approach / a;
            const quad rest = (slides ? 1 - r->slip_displacement / a : 0) + r->displacement_unit * left.approach / a;
            const quad slope = load_slope(r, w) * width * weight[abs(i)], force = r->force_unit * slope; /* dT */
            real += sqrtq(x * rest) * force;
            real_slope += sqrtq(x / rest) * (rest - x) * force;
            area += r->force_unit * way.load * compliance(r, w) * r->displacement_unit * slope;
        }
    }
    const quad reached = slides ? r->slip_displacement : a;
    const quad energy = 8 * area - 4 * top * reached + (slides ? 4 * top * (a - reached) : 0);
    real *= 8 / (M_PIq * a);
    real_slope = (-4 / (M_PIq * a) * real_slope - real) / a;
    const quad imaginary = energy / (M_PIq * a * a);
    result[0] = (double)real;
    result[1] = (double)imaginary;
    result[2] = (double)real_slope;
    result[3] = (double)(4 * (top - a * k) / (M_PIq * a * a) - 2 * imaginary / a);
}

void reference_path(const reference *r, int n, const double *displacement, double *force)
{
    quad_walk walk;
    quad_start(&walk, r);
    for (int i = 0; i < n; ++i) {
        quad_move(&walk, displacement[i]);
        force[i] = (double)walk.force;
    }
}

/* A trigonometric sum and its derivative by t. */
static quad motion(int harmonics, const double *c, quad t, quad *rate)
{
    quad u = c[0], v = 0, sine, cosine;
    for (int k = 1; k <= harmonics; ++k) {
        sincosq(k * t, &sine, &cosine);
        u += c[2 * k - 1] * cosine + c[2 * k] * sine;
        v += k * (c[2 * k] * cosine - c[2 * k - 1] * sine);
    }
    *rate = v;
    return u;
}

static quad rate_of(int harmonics, const double *c, quad t)
{
    quad rate;
    motion(harmonics, c, t, &rate);
    return rate;
}

/* Between two times the rate changes its sign: when. */
static quad turning_time(int harmonics, const double *c, quad from, quad to)
{
    const int rises = rate_of(harmonics, c, to) > 0;
    while (to - from > 1e-33Q * to) {
        const quad middle = (from + to) / 2;
        if (middle == from || middle == to) {
            break;
        }
        if ((rate_of(harmonics, c, middle) > 0) == rises) {
            to = middle;
        } else {
            from = middle;
        }
    }
    return to;
}

/* On a monotonic stretch of time: when the motion is at u. */
static quad time_at(int harmonics, const double *c, quad from, quad to, int direction, quad u)
{
    quad t = (from + to) / 2, rate;
    for (int i = 0; i < 200; ++i) {
        const quad excess = motion(harmonics, c, t, &rate) - u;
        if (direction * excess > 0) {
            to = t;
        } else {
            from = t;
        }
        quad next = t - excess / rate;
        if (!(next > from && next < to)) {
            next = (from + to) / 2;
        }
        if (fabsq(next - t) < 1e-32Q) {
            break;
        }
        t = next;
    }
    return t;
}

static void add_branch(const quad_walk *walk, int slides, int harmonics, const double *c, quad from, quad to, quad *sum)
{
    for (int i = -HALF; i <= HALF; ++i) {
        const quad t = from + way_to(to - from, i);
        quad ignored, force = walk->direction * FORCE(walk->law), sine, cosine;
        if (!slides) {
            force = quad_on_branch(walk, motion(harmonics, c, t, &ignored), &ignored);
        }
        force *= weight[abs(i)] * (to - from);
        sum[0] += force / 2;
        for (int k = 1; k <= harmonics; ++k) {
            sincosq(k * t, &sine, &cosine);
            sum[2 * k - 1] += cosine * force;
            sum[2 * k] += sine * force;
        }
    }
}

void reference_harmonics(const reference *r, int harmonics, const double *c, double *force)
{
    enum { SCAN = 2048, MOST = 64 };
    quad turn[MOST + 1], ignored;
    int turns = 0;
    for (int i = 0; i < SCAN && turns < MOST; ++i) {
        const quad from = 2 * M_PIq * i / SCAN, to = 2 * M_PIq * (i + 1) / SCAN;
        if ((rate_of(harmonics, c, from) > 0) != (rate_of(harmonics, c, to) > 0)) {
            turn[turns++] = turning_time(harmonics, c, from, to);
        }
    }
    turn[turns] = turn[0] + 2 * M_PIq;

    /* The first period, from the virgin state; then on to its first turning point. */
    quad_walk walk;
    quad u[MOST + 1] = { 0 };
    quad_start(&walk, r);
    quad_move(&walk, motion(harmonics, c, 0, &ignored));
    for (int i = 0; i < turns; ++i) {
        u[i] = motion(harmonics, c, turn[i], &ignored);
        quad_move(&walk, u[i]);
    }
    u[turns] = u[0];
    quad_move(&walk, u[0]);

    quad sum[64] = { 0 };
    for (int i = 0; i < turns; ++i) {
        const int direction = u[i + 1] > u[i] ? 1 : -1;
        quad from = turn[i];
        int slides = 0;
        quad_turn(&walk, direction);
        /* Branch by branch; the last one, and gross slip, go to the end. */
        while (!slides && direction * (u[i + 1] - quad_end(&walk)) > 0) {
            const quad to = time_at(harmonics, c, from, turn[i + 1], direction, quad_end(&walk));
            add_branch(&walk, 0, harmonics, c, from, to, sum);
            from = to;
            if (walk.depth) {
                quad_forget(&walk);
            } else {
                slides = 1;
            }
        }
        add_branch(&walk, slides, harmonics, c, from, turn[i + 1], sum);
        quad_move(&walk, u[i + 1]);
    }
    for (int k = 0; k <= 2 * harmonics; ++k) {
        force[k] = (double)(sum[k] / M_PIq);
    }
}

void reference_samples(const reference *r, int harmonics, int samples, const double *c, double *force)
{
    quad sum[64] = { 0 }, ignored;
    quad_walk walk;
    quad_start(&walk, r);
    for (int n = 0; n < 2 * samples; ++n) {
        const quad t = 2 * M_PIq * (n % samples) / samples;
        quad_move(&walk, motion(harmonics, c, t, &ignored));
        if (n >= samples) {
            sum[0] += walk.force;
            for (int k = 1; k <= harmonics; ++k) {
                quad sine, cosine;
                sincosq(k * t, &sine, &cosine);
                sum[2 * k - 1] += 2 * cosine * walk.force;
                sum[2 * k] += 2 * sine * walk.force;
            }
        }
    }
    for (int k = 0; k <= 2 * harmonics; ++k) {
        force[k] = (double)(sum[k] / samples);
    }
}
