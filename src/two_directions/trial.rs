//! The trial state of a step, in which all springs stick, and the springs.

use super::contact::Contact;
use super::scalar::{Over, Real};
use super::tables::{Both, FINE, MAP, N, Row, Rows, starts};
use crate::simd::dispatch;

/// Places of the springs: their displacements, r of the points, and the displacements of the fine springs, x before y.
pub(crate) const TRACTION: usize = 2 * N;
pub(crate) const FINE_SPRING: usize = 4 * N;
pub(crate) const SPRINGS: usize = FINE_SPRING + 2 * FINE;

/// The springs as values.
pub(crate) type Values = [Row<f64>; SPRINGS / N];

/// Springs as numbers of a kind.
pub(crate) trait Springs<X> {
    /// Whether the springs are kept, and r of points that stick: with values, the trial state gives it.
    const KEPT: bool;
    const TRACTIONS: bool;
    fn get(&self, place: usize) -> X;
    fn put(&mut self, place: usize, x: X);
}

/// Before a step, without derivatives.
impl<X: Real> Springs<X> for &Values {
    const KEPT: bool = false;
    const TRACTIONS: bool = false;

    #[inline(always)]
    fn get(&self, place: usize) -> X {
        X::constant(self.as_flattened().get(place).copied().unwrap_or(0.0))
    }

    #[inline(always)]
    fn put(&mut self, _: usize, _: X) {}
}

impl Springs<f64> for &mut Values {
    const KEPT: bool = true;
    const TRACTIONS: bool = false;

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

/// A step, straight in S and in the displacement: S at the start, the displacement, and whether the load is that of the start.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion<A, X> {
    pub before: Both<A>,
    pub by: Both<X>,
    pub constant_load: bool,
}

/// The part of the motion that a spring follows: from where the load reaches its size on.
#[inline(always)]
pub(crate) fn moved<A: Real, X: Over<A>>(limit: A, rise: A, by: X) -> X {
    if limit.value() < rise.value() { by.times(limit * rise.inverse()) } else { by }
}

/// The largest |r|² of a trial state that sticks: a state that has slipped may round.
pub(crate) const ROUNDING: f64 = 1.0 + 1e-12;

/// The state in which all springs stick. Under a constant load r changes by the motion of the last shell; of springs it would have the
/// rounding errors of their differences.
#[repr(align(32))]
pub(crate) struct Trial {
    /// v*, r*, and the springs over their limits.
    pub v: Both<Row<f64>>,
    pub r: Both<Row<f64>>,
    pub over_limit: Both<Row<f64>>,
    /// Whether |r| exceeds 1 at no point.
    pub sticks: bool,
}

/// The trial state of a step of values.
pub(crate) fn trial(t: &Rows, c: &Contact<f64>, motion: &Motion<f64, f64>, old: &Values) -> Trial {
    dispatch!(trial_kernel(t, c, motion, old))
}

#[inline(always)]
fn trial_kernel(t: &Rows, c: &Contact<f64>, motion: &Motion<f64, f64>, old: &Values) -> Trial {
    let (last, start) = (c.last.min(N - 1), starts(c.under_flat));
    let (mut all, mut r, mut over_limit) = ([[0.0; N]; 2], [[0.0; N]; 2], [[0.0; N]; 2]);
    for k in 0..2 {
        let (mut limit, mut v) = ([1.0; N], [0.0; N + 1]);
        let rise = c.now.shift[k] - motion.before[k];
        for j in 0..=last {
            limit[j] = c.limit(&t, k, start[j]);
            v[j] = old[k][j] + moved(limit[j], rise, motion.by[k]);
        }
        r[k] = if motion.constant_load { old[2 + k] } else { tractions(t, c, k, &v) };
        let moved = if motion.constant_load { motion.by[k] } else { 0.0 };
        for i in 0..N {
            r[k][i] += c.edge[k][i] * c.per_pressure[i] * moved;
            (all[k][i], over_limit[k][i]) = (v[i], v[i] / limit[i]);
        }
    }
    let mut largest = 0.0;
    for i in 0..N {
        let square = r[0][i] * r[0][i] + r[1][i] * r[1][i];
        largest = if square > largest { square } else { largest };
    }
    Trial { v: all, r, over_limit, sticks: largest <= ROUNDING }
}

/// r of displacements of the springs, 0 behind the last one.
#[inline(always)]
pub(crate) fn tractions(t: &Rows, c: &Contact<f64>, k: usize, v: &[f64; N + 1]) -> Row<f64> {
    let mut r = [0.0; N];
    for j in 0..=c.last.min(N - 1) {
        let (d, row) = (v[j] - v[j + 1], if j < c.last { &t[MAP + k * N + j] } else { &c.edge[k] });
        for i in 0..N {
            r[i] += d * row[i];
        }
    }
    for i in 0..N {
        r[i] *= c.per_pressure[i];
    }
    r
}
