//! The part of a slip along r0, the traction at the start of a step, which is known before the slip is found.
//!
//! Points that slipped before turn during a step. By the trapezoidal rule half of their slip has the direction at the start, the rest that
//! at the end. The half is predicted from the slip σ by which the springs return to limits of their own, `C' σ = w (v* - v)`, in which each
//! spring is on its own: to its limit, or to the magnitude at which it rested at the start if the points from there outwards rest at the
//! limit in directions that turn slowly. What remains is a strictly convex problem: it has one solution, which depends continuously on all.

use super::contact::Contact;
use super::scalar::{Over, Real, both};
use super::tables::{Both, N, Row, Tables, starts};
use super::trial::{Motion, Springs, TRACTION};

/// Damping of the trapezoidal rule of points that slip far, and the part of the distance to its magnitude at the start that a spring rests
/// at: chosen on judged paths.
const DAMPING: f64 = 0.1;
const RESTING: f64 = 0.85;
/// Displacements of the innermost spring over its limit between which a contact that slides forgets.
const FAR: [f64; 2] = [2.5, 5.0];

/// The part of the slip of each point along r0 from the trial state v*, and its shares.
#[inline(always)]
pub(crate) fn predict<A: Real, X: Over<A>, T: Tables<A>, S: Springs<X>>(
    t: &T,
    c: &Contact<A>,
    motion: &Motion<A, X>,
    s: &S,
    v: &Both<Row<X>>,
    shares: &mut Row<f64>,
) -> Both<Row<X>> {
    let (zero, one, last, start) = (X::constant(0.0), X::constant(1.0), c.last.min(N - 1), starts(c.under_flat));
    let (mut slip, mut r, mut turn) = ([[zero; N]; 2], [[zero; N]; 2], [zero; N]);
    *shares = [0.0; N];
    for i in 0..(last + 1).min(N) {
        (r[0][i], r[1][i]) = (s.get(TRACTION + i), s.get(TRACTION + N + i));
        let u = (r[0][i] * r[0][i] + r[1][i] * r[1][i]).scale(2.0) - one;
        turn[i] = if u.value() > 0.0 { u } else { zero };
    }
    // Whether all points from there on rest at the limit, in directions that turn slowly.
    let mut rests = [zero; N];
    let (mut rest, mut outer) = (one, last + 1);
    // The compiler cannot know that a decreasing index is within bounds.
    for j in (0..=last).rev().map(|j| j.min(N - 1)) {
        let before = motion.before[0].value() - c.now.shift[0].value() + c.limit(t, 0, start[j]).value();
        if before > 0.0 {
            let square = turn[j] * turn[j];
            let fourth = square * square;
            let eighth = fourth * fourth;
            rest = rest * (eighth * eighth);
            if outer <= last {
                let next = outer.min(N - 1);
                let along = r[0][j] * r[0][next] + r[1][j] * r[1][next];
                let slowly = along * (X::constant(2.0) - along);
                rest = if along.value() > 0.0 { rest * slowly } else { zero };
            }
            outer = j;
        }
        rests[j] = rest;
    }
    let (mut total, mut sigma) = ([zero; 2], [[zero; N]; 2]);
    let mut first = N;
    let turns = (one - slid(t, c, v)).scale(0.5);
    for j in 0..(last + 1).min(N) {
        let limit = both!(|k| c.limit(t, k, start[j]));
        let length = length(&both!(|k| v[k][j]), &limit);
        let mut over = length;
        let mut weight = zero;
        if turn[j].value() > 0.0 {
            weight = turn[j] * turn[j] * turns * (excess(length).scale(DAMPING) + one).inverse();
            let before = both!(|k| motion.before[k] - c.now.shift[k] + limit[k]);
            if before[0].value() > 0.0 && rests[j].value() > 0.0 {
                let was = self::length(&both!(|k| s.get(k * N + j)), &before);
                if was.value() < 1.0 {
                    over = over * (one - (rests[j] * (one - was)).scale(RESTING)).inverse();
                }
            }
        }
        let over = excess(over);
        if over.value() > 0.0 {
            first = first.min(j);
            let part = over * (over + one).inverse();
            total = both!(|k| total[k] + (v[k][j] * part).times(c.stiffness(t, k, j)));
        }
        if first == N {
            continue;
        }
        for k in 0..2 {
            let mut sum = total[k];
            for i in first..j {
                sum = sum - sigma[k][i].times(c.map(t, k, j, i));
            }
            sigma[k][j] = sum.times(c.per_map(t, k, j));
        }
        let along = r[0][j] * sigma[0][j] + r[1][j] * sigma[1][j];
        if weight.value() > 0.0 && along.value() > 0.0 {
            shares[j] = weight.value();
            // The sums are of slips over the pressure.
            let size = along * weight;
            (slip[0][j], slip[1][j]) = (size * r[0][j], size * r[1][j]);
        }
    }
    slip
}

/// The part in which a contact that slides far forgets, from its trial state.
#[inline(always)]
pub(crate) fn slid<A: Real, X: Over<A>, T: Tables<A>>(t: &T, c: &Contact<A>, v: &Both<Row<X>>) -> X {
    let over = length(&both!(|k| v[k][0]), &both!(|k| c.limit(t, k, 0)));
    if over.value() <= FAR[0] {
        return X::constant(0.0);
    }
    if over.value() >= FAR[1] {
        return X::constant(1.0);
    }
    let part = (over - X::constant(FAR[0])).scale(1.0 / (FAR[1] - FAR[0]));
    part * part * (X::constant(3.0) - part.scale(2.0))
}

/// The size of a vector in units of both directions; 0 without derivatives.
#[inline(always)]
fn length<A: Real, X: Over<A>>(v: &Both<X>, unit: &Both<A>) -> X {
    let [x, y] = both!(|k| v[k].times(unit[k].inverse()));
    let square = x * x + y * y;
    if square.value() > f64::MIN_POSITIVE { square.sqrt() } else { X::constant(0.0) }
}

/// The excess over 1.
#[inline(always)]
fn excess<X: Real>(length: X) -> X {
    if length.value() > 1.0 { length - X::constant(1.0) } else { X::constant(0.0) }
}

/// Removes a slip from the springs: `v - w⁻¹ C' σ`, from σ over the pressure.
#[inline(always)]
pub(crate) fn release<A: Real, X: Over<A>, T: Tables<A>>(
    t: &T,
    c: &Contact<A>,
    k: usize,
    sigma: &Row<X>,
    set: u32,
    v: &mut Row<X>,
) {
    let last = c.last.min(N - 1);
    let first = (set.trailing_zeros() as usize).min(last);
    let mut before = X::constant(0.0);
    for j in first..=last {
        let mut sum = X::constant(0.0);
        for i in first..=j {
            if set >> i & 1 == 1 {
                sum.add_product(&sigma[i], c.map(t, k, j, i));
            }
        }
        v[j] = v[j] - (sum - before).times(c.flexibility(t, k, j));
        before = sum;
    }
}
