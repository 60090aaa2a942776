//! The springs, the trial state of a step, in which all stick, and the limits on the way.

use super::contact::Contact;
use super::matrix::largest;
use super::scalar::{Dual, Linear, Over, Real, both};
use super::tables::{Both, FINE, MAP, N, Row, Rows, Tables, starts};
use crate::shape::TINY;
use crate::simd::dispatch;

/// Places of the springs: their displacements, and those of the fine springs, x before y.
pub(crate) const FINE_SPRING: usize = 2 * N;
pub(crate) const SPRINGS: usize = FINE_SPRING + 2 * FINE;

/// The springs as values.
pub(crate) type Values = [Row<f64>; SPRINGS / N];

/// Springs as numbers of a kind.
pub(crate) trait Springs<X> {
    fn get(&self, place: usize) -> X;
    fn put(&mut self, place: usize, x: X);
}

impl Springs<f64> for &mut Values {
    #[inline(always)]
    fn get(&self, place: usize) -> f64 {
        self.as_flattened().get(place).copied().unwrap_or(0.0)
    }

    #[inline(always)]
    fn put(&mut self, place: usize, x: f64) {
        if let Some(there) = self.as_flattened_mut().get_mut(place) {
            *there = x;
        }
    }
}

/// Springs without derivatives before a step, and the derivatives after it if they are requested.
pub(crate) struct Derivatives<'a> {
    pub values: &'a Values,
    pub slopes: &'a mut [[f64; 4]],
}

impl Springs<Dual<1>> for Derivatives<'_> {
    #[inline(always)]
    fn get(&self, place: usize) -> Dual<1> {
        Dual::constant(self.values.as_flattened().get(place).copied().unwrap_or(0.0))
    }

    #[inline(always)]
    fn put(&mut self, place: usize, x: Dual<1>) {
        if let Some(there) = self.slopes.get_mut(place) {
            [*there] = x.0;
        }
    }
}

/// A step, straight in S and in the displacement: S at the start, the displacement, and whether the load is that of the start.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion<A, X> {
    pub before: Both<A>,
    pub by: Both<X>,
    pub constant_load: bool,
}

/// Limits and rises below this, in the unit of the springs, are rounding; fourth powers of a motion over it stay finite.
pub(crate) const LEAST: f64 = 1e-40;

/// The part of the motion that a spring follows: from where the load reaches its size on.
#[inline(always)]
pub(crate) fn moved<A: Real, X: Over<A>>(limit: A, rise: A, by: X) -> X {
    if limit.value() < rise.value() { by.times(limit * rise.at_least(LEAST).inverse()) } else { by }
}

/// The largest square of a state over its limit that sticks: one that has slipped may round.
pub(crate) const ROUNDING: f64 = 1.0 + 1e-12;

/// The direction of v/limit of a spring, and 1/(x y |v/limit|) with the limits x and y, negative if it sticks.
#[inline(always)]
pub(crate) fn direction(v: Both<f64>, [x, y]: Both<f64>) -> [f64; 3] {
    let (across, along, bound) = (v[0] * y, v[1] * x, x * y);
    let square = across * across + along * along;
    // A sum: of a maximum, the compiler would divide by what is less.
    let per_length = 1.0 / (square + TINY).sqrt();
    [
        across * per_length,
        along * per_length,
        if square > ROUNDING * (bound * bound) { per_length } else { -per_length },
    ]
}

/// A spring on its own, returned to its limit if it slips: by values `limit e`; e turns by `e × d(v/limit)` over the length of v/limit.
#[inline(always)]
pub(crate) fn returned<A: Real, X: Over<A>>(v: Both<X>, limit: &Both<A>, [e_x, e_y, per_length]: [f64; 3]) -> Both<X> {
    if per_length <= 0.0 {
        return v;
    }
    let ([x, y], mut turn) = (both!(|k| limit[k].value()), X::constant(0.0));
    if X::DERIVED {
        let [along, across] = [e_x * per_length, e_y * per_length];
        turn = v[1].scale(along * x).minus(limit[1].scale(across * v[0].value()));
        turn.add_scaled(&v[0], -across * y);
        turn = turn.minus(limit[0].scale(-along * v[1].value()));
    }
    [turn.scale(-e_y * x).minus(limit[0].scale(-e_x)), turn.scale(e_x * y).minus(limit[1].scale(-e_y))]
}

/// The most that the limit of a spring falls in a step with its neighbours. So a spring has left when the edge passes its node.
const LARGEST_FALL: f64 = 4.0;

/// Whether a limit with this value at the end falls by more.
#[inline(always)]
fn falls<A: Real>(limit: A, rise: A) -> bool {
    limit.value() * (LARGEST_FALL - 1.0) < -rise.value()
}

/// Whether that of the last spring does, the smallest one.
#[inline(always)]
pub(crate) fn some_leave<A: Real>(t: &impl Tables<A>, c: &Contact<A>, before: A) -> bool {
    falls(c.limit(t, 0, starts(c.under_flat)[c.last.min(N - 1)]), c.now.shift[0] - before)
}

/// How the springs that leave slip: as of [`direction`]; and the direction of v/limit at the start with the excess of its length over 1,
/// 0 within.
pub(crate) type Leaving = [([f64; 3], [f64; 3]); N];

/// Springs whose limits fall by more follow alone until these have fallen to that multiple of their ends: `old` becomes the springs there, and
/// v what sticks from there on. Neighbours may hold a spring beyond its limit: it then keeps that ratio. How they slip is found for values, and
/// given for derivatives.
#[cold]
#[inline(never)]
pub(crate) fn leave<A: Real, X: Over<A>>(
    t: &impl Tables<A>,
    c: &Contact<A>,
    motion: &Motion<A, X>,
    [old, v]: [&mut Both<Row<X>>; 2],
    leaves: &mut Leaving,
) {
    let rise = both!(|k| c.now.shift[k] - motion.before[k]);
    for j in 0..(c.last + 1).min(N) {
        let limit = both!(|k| c.limit(t, k, starts(c.under_flat)[j]));
        if !falls(limit[0], rise[0]) {
            continue;
        }
        let rest = limit[0].scale(1.0 - LARGEST_FALL) * rise[0].inverse();
        let by = both!(|k| motion.by[k].times(rest));
        let there = both!(|k| limit[k] - rise[k] * rest);
        let own = both!(|k| old[k][j] + motion.by[k] - by[k]);
        let ratio = both!(|k| old[k][j].times((limit[k] - rise[k]).inverse()));
        if !X::DERIVED {
            let [x, y] = both!(|k| ratio[k].value());
            let length = (x * x + y * y + TINY).sqrt();
            let excess = if length > 1.0 { [x / length, y / length, length - 1.0] } else { [0.0; 3] };
            let bound = both!(|k| there[k].value() * (1.0 + excess[2]));
            leaves[j] = (direction(both!(|k| own[k].value()), bound), excess);
        }
        let (direction, [x, y, excess]) = leaves[j];
        let bound = both!(|k| there[k].scale(1.0 + excess));
        let mut start = returned(own, &bound, direction);
        if X::DERIVED && direction[2] > 0.0 {
            // The bound has the value of the excess; it changes with the length of the ratio.
            let change = (ratio[0].scale(x) + ratio[1].scale(y)).chain(0.0, 1.0);
            for k in 0..2 {
                start[k].add_scaled(&change, direction[k] * there[k].value());
            }
        }
        for k in 0..2 {
            (old[k][j], v[k][j]) = (start[k], start[k] + by[k]);
        }
    }
}

/// The state in which all springs stick. Under a constant load r changes by the motion of the last shell; of springs it would have the
/// rounding errors of their differences.
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(32))]
pub(crate) struct Trial {
    /// The springs at the start, with the directions of those that leave, and v*; r of both.
    pub old: Both<Row<f64>>,
    pub leaves: Leaving,
    pub v: Both<Row<f64>>,
    pub start: Both<Row<f64>>,
    pub r: Both<Row<f64>>,
    /// Whether |r| exceeds 1 at no point.
    pub sticks: bool,
}

/// The trial state of a step of values.
pub(crate) fn trial(t: &Rows, c: &Contact<f64>, motion: &Motion<f64, f64>, old: &Values) -> Trial {
    dispatch!({
        let (last, start_of) = (c.last.min(N - 1), starts(c.under_flat));
        let (mut old, mut leaves, mut all) = (both!(|k| old[k]), Leaving::default(), [[0.0; N]; 2]);
        for k in 0..2 {
            let (rise, mut part) = (c.now.shift[k] - motion.before[k], [motion.by[k]; N]);
            if !motion.constant_load {
                for j in 0..=last {
                    part[j] = moved(c.limit(&t, k, start_of[j]), rise, motion.by[k]);
                }
            }
            for j in 0..N {
                all[k][j] = if j <= last { old[k][j] + part[j] } else { 0.0 };
            }
        }
        if !motion.constant_load && some_leave(&t, c, motion.before[0]) {
            leave(&t, c, motion, [&mut old, &mut all], &mut leaves);
        }
        let (mut start, mut r) = ([[0.0; N]; 2], [[0.0; N]; 2]);
        for k in 0..2 {
            start[k] = tractions(t, c, k, &old[k], 0);
            r[k] = if motion.constant_load { start[k] } else { tractions(t, c, k, &all[k], 0) };
            let moved = if motion.constant_load { motion.by[k] } else { 0.0 };
            for i in 0..N {
                r[k][i] += c.edge[k][i] * c.per_pressure[i] * moved;
            }
        }
        let mut squares = [0.0; N];
        for i in 0..N {
            squares[i] = r[0][i] * r[0][i] + r[1][i] * r[1][i];
        }
        Trial { old, leaves, v: all, start, r, sticks: largest(&squares) <= ROUNDING }
    })
}

/// r of displacements of the springs up to the last one, of which those before a first one are 0.
#[inline(always)]
pub(crate) fn tractions(t: &Rows, c: &Contact<f64>, k: usize, v: &Row<f64>, first: usize) -> Row<f64> {
    let (mut r, last) = ([0.0; N], c.last.min(N - 1));
    for j in first.max(1) - 1..last {
        let (d, row) = (v[j] - v[j + 1], &t[MAP + k * (N - 1) + j]);
        for i in 0..N {
            r[i] += d * row[i];
        }
    }
    for i in 0..N {
        r[i] = (r[i] + v[last] * c.edge[k][i]) * c.per_pressure[i];
    }
    r
}

/// The limits of the points at the start of a step over those at its end: tractions of gross slip there.
#[inline(always)]
pub(crate) fn limits_before<A: Real>(t: &impl Tables<A>, c: &Contact<A>, rise: A) -> Row<A> {
    let (last, start) = (c.last.min(N - 1), starts(c.under_flat));
    let (zero, mut limits) = (A::constant(0.0), [A::constant(0.0); N]);
    let at_edge = c.limit(t, 0, start[last]);
    if (at_edge - rise).value() > 0.0 && !falls(at_edge, rise) {
        // All springs were engaged: the limits of those within differ as they do at the end.
        for i in 0..=last {
            limits[i] = A::constant(1.0) - rise * c.edge[0][i] * c.per_pressure[i];
        }
        return limits;
    }
    let mut above = zero;
    for j in (0..=last).rev().map(|j| j.min(N - 1)) {
        let end = c.limit(t, 0, start[j]);
        let limit = if falls(end, rise) { end.scale(LARGEST_FALL) } else { end - rise };
        let limit = if limit.value() > 0.0 { limit } else { zero };
        for i in 0..=j {
            limits[i] = limits[i] + (limit - above) * c.map(t, 0, j, i);
        }
        above = limit;
    }
    for i in 0..=last {
        limits[i] = limits[i] * c.per_pressure[i];
    }
    limits
}

/// Displacements of the innermost spring over its limit between which a contact that slides forgets: farther, the springs end in gross slip
/// in one direction.
const FAR: [f64; 2] = [2.5, 5.0];

/// The part in which a contact that slides far forgets, from its trial state, with these values.
#[inline(always)]
pub(crate) fn slid<A: Real, X: Over<A>, T: Tables<A>>(
    t: &T,
    c: &Contact<A>,
    v: &Both<Row<X>>,
    values: &Both<Row<f64>>,
) -> X {
    let per_limit = both!(|k| c.limit(t, k, 0).inverse());
    let [x, y] = both!(|k| v[k][0].times(per_limit[k]));
    let (p, q) = (values[0][0] * per_limit[0].value(), values[1][0] * per_limit[1].value());
    let (root, per) = ((p * p + q * q).sqrt(), 1.0 / (FAR[1] - FAR[0]));
    // Bounded before it is squared: after a long slide its powers would overflow.
    let part = ((root - FAR[0]) * per).clamp(0.0, 1.0);
    let slope = 6.0 * part * (1.0 - part) * per / root.max(FAR[0]);
    (x.scale(p) + y.scale(q)).chain(part * part * (3.0 - 2.0 * part), slope)
}
