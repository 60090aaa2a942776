//! Energy that springs dissipate in a step.
//!
//! A spring follows its trial path v + t (v* - v) until it reaches its limit, which changes evenly from l0 to l1 on the way, and slips
//! from there to v': with the mean of both tractions it dissipates `w (v_exit + v')·(v* - v')/2`. A spring of the law slips where the
//! traction at its point is at the limit; if it did so before, by the share β, it slips from the start.

use super::springs::Both;
use crate::shape::TINY;

/// Limits below this, in the unit of the springs, are rounding; fourth powers of a motion over it stay finite.
const LEAST_LIMIT: f64 = 1e-40;

/// The first t in [0, 1] at which `qa t² + 2 qb t + qc` becomes positive.
#[inline(always)]
pub(crate) fn exit(qa: f64, qb: f64, qc: f64) -> f64 {
    let square = qb * qb - qa * qc;
    let root = if square > 0.0 { square } else { 0.0 }.sqrt();
    // Quotients are at most 1 by their divisors: others may overflow.
    let ratio = |numerator: f64, divisor: f64| {
        let positive = if numerator > TINY { numerator } else { TINY };
        positive / if divisor > positive { divisor } else { positive }
    };
    let outwards = if qc < 0.0 { ratio(-qc, qb + root) } else { 0.0 };
    let inwards = if qa > 0.0 { ratio(root - qb, qa) } else { 1.0 };
    let part = if qb >= 0.0 { outwards } else { inwards };
    if part > 0.0 { part } else { 0.0 }
}

/// Energy of a spring of stiffness w that slips, from v over the trial state to its end, with the limits at the end, that at the start and
/// the share 1 - β of the path to the limit on which it sticks.
#[inline(always)]
pub(crate) fn slipped(
    w: Both<f64>,
    [old, trial, end]: [Both<f64>; 3],
    limit: Both<f64>,
    before: f64,
    sticks: f64,
) -> f64 {
    let per_limit = limit.map(|limit| 1.0 / if limit > LEAST_LIMIT { limit } else { LEAST_LIMIT });
    let ratio = before * per_limit[0];
    let (x, y) = (old[0] * per_limit[0], old[1] * per_limit[1]);
    let (dx, dy) = ((trial[0] - old[0]) * per_limit[0], (trial[1] - old[1]) * per_limit[1]);
    let change = ratio - 1.0;
    let (qa, qb) = (dx * dx + dy * dy - change * change, x * dx + y * dy + ratio * change);
    let part = sticks * exit(qa, qb, x * x + y * y - ratio * ratio);
    let of = |k: usize| w[k] * (old[k] + part * (trial[k] - old[k]) + end[k]) * (trial[k] - end[k]);
    0.5 * (of(0) + of(1))
}

/// Energy of a spring that loses contact: it slips from where it reaches its limit, which falls from that at the start to 0 within the part
/// `limit/fall` of the motion, to nothing.
#[inline(always)]
pub(crate) fn lost(w: Both<f64>, old: Both<f64>, limit: Both<f64>, fall: Both<f64>, by: Both<f64>) -> f64 {
    let limit = limit.map(|limit| limit.max(LEAST_LIMIT));
    let rate = [0, 1].map(|k| limit[k] / fall[k].max(limit[k]) * by[k]);
    let (x, y) = (old[0] / limit[0], old[1] / limit[1]);
    let (dx, dy) = (rate[0] / limit[0], rate[1] / limit[1]);
    let part = exit(dx * dx + dy * dy - 1.0, x * dx + y * dy + 1.0, x * x + y * y - 1.0);
    let of = |k: usize| {
        let leaves = old[k] + part * rate[k];
        w[k] * leaves * ((1.0 - part) * rate[k] + leaves)
    };
    0.5 * (of(0) + of(1))
}
