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

/// The state in which all springs stick.
#[repr(align(32))]
pub(crate) struct Trial {
    /// r*, and the springs over their limits.
    pub r: Both<Row<f64>>,
    pub over_limit: Both<Row<f64>>,
    /// Whether |r| exceeds 1 at no point.
    pub sticks: bool,
    pub by: Both<f64>,
    /// The last point.
    pub last: usize,
    pub load: f64,
}

/// The trial state of a step of values.
pub(crate) fn trial(t: &Rows, c: &Contact<f64>, motion: &Motion<f64, f64>, old: &Values) -> Trial {
    dispatch!(trial_kernel, t: &Rows, c: &Contact<f64>, motion: &Motion<f64, f64>, old: &Values => Trial)
}

#[inline(always)]
fn trial_kernel(t: &Rows, c: &Contact<f64>, motion: &Motion<f64, f64>, old: &Values) -> Trial {
    let (last, start) = (c.last.min(N - 1), starts(c.under_flat));
    let (mut r, mut over_limit) = ([[0.0; N]; 2], [[0.0; N]; 2]);
    for k in 0..2 {
        let (mut limit, mut v) = ([1.0; N], [0.0; N + 1]);
        let rise = c.now.shift[k] - motion.before[k];
        for j in 0..=last {
            limit[j] = c.limit(&t, k, start[j]);
            v[j] = old[k][j] + moved(limit[j], rise, motion.by[k]);
        }
        let mut q = [0.0; N];
        for j in 0..=last {
            let (d, row) = (v[j] - v[j + 1], if j < last { &t[MAP + k * N + j] } else { &c.edge[k] });
            for i in 0..N {
                q[i] += d * row[i];
            }
        }
        for i in 0..N {
            r[k][i] = q[i] * c.per_pressure[i];
            over_limit[k][i] = v[i] / limit[i];
        }
    }
    let mut largest = 0.0;
    for i in 0..N {
        let square = r[0][i] * r[0][i] + r[1][i] * r[1][i];
        largest = if square > largest { square } else { largest };
    }
    Trial { r, over_limit, sticks: largest <= ROUNDING, by: motion.by, last, load: c.now.load }
}

/// r of the springs.
pub(crate) fn tractions(springs: &Values) -> &Both<Row<f64>> {
    springs.last_chunk::<10>().and_then(|rows| rows.first_chunk()).unwrap_or(&[[0.0; N]; 2])
}
