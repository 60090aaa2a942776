//! Products and factors of the matrices of a step, in vectors of the processor.

use super::nodes::{Matrix, Row, SPRINGS};
use crate::numerics::guard::TINY;
use crate::numerics::lanes::Lanes;
use crate::numerics::total::Total;

/// Σ x_m A_m, of the rows A_m of a matrix, from one to another.
pub(super) fn times(matrix: &Matrix, [first, end]: [usize; 2], x: &Row) -> Row {
    let mut y = Row::ZERO;
    for m in first..end.min(SPRINGS) {
        y += x[m] * matrix[m];
    }
    y
}

/// Σ x_i y_i, in an order of vectors.
pub(crate) fn dot(x: &Row, y: &Row) -> f64 {
    let sums = (*x * *y).blocks().iter().fold(Lanes::<4>::ZERO, |sums, block| sums + Lanes(*block));
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// The unit vectors, and the ones before each.
const UNITS: Matrix = {
    let mut units = [Row::ZERO; SPRINGS];
    let mut i = 0;
    while i < SPRINGS {
        units[i].0[i] = 1.0;
        i += 1;
    }
    units
};
const BEFORE: Matrix = {
    let mut before = [Row::ZERO; SPRINGS];
    let mut i = 0;
    while i < SPRINGS * SPRINGS {
        before[i / SPRINGS].0[i % SPRINGS] = if i % SPRINGS < i / SPRINGS { 1.0 } else { 0.0 };
        i += 1;
    }
    before
};

/// A symmetric matrix J of the points from one to another as `J = L D L'`. With `F = L⁻¹ D`, `J⁻¹ = D⁻¹ F' D⁻¹ F D⁻¹`.
pub(crate) struct Factors {
    /// -F, a row for each point.
    rows: Matrix,
    /// -F, a row for each column.
    columns: Matrix,
    /// 1/D.
    per_pivot: Row,
}

impl Factors {
    pub const NONE: Factors =
        Factors { rows: [Row::ZERO; SPRINGS], columns: [Row::ZERO; SPRINGS], per_pivot: Row::ZERO };

    /// Factorises the sum of a diagonal and of a matrix whose rows are given. Below a pivot the rows are eliminated but for its own column,
    /// which becomes one of -F. Single elements are chosen by their place in the lanes: a vector that is loaded right after one of its elements
    /// was stored would wait for it.
    pub fn set(&mut self, [first, end]: [usize; 2], diagonal: &Row, row: impl Fn(usize) -> Row) {
        let Factors { rows, columns, per_pivot } = self;
        for i in first..end.min(SPRINGS) {
            rows[i] = row(i);
        }
        for p in first..end.min(SPRINGS) {
            let pivot = rows[p][p] + diagonal[p];
            let per = 1.0 / if pivot.abs() > TINY { pivot } else { TINY };
            let pivot_row = rows[p] * (1.0 - UNITS[p]);
            rows[p] = BEFORE[p] * rows[p] - pivot * UNITS[p];
            per_pivot[p] = per;
            for i in p + 1..end.min(SPRINGS) {
                let factor = per * rows[i][p];
                rows[i] -= factor * pivot_row;
            }
        }
        for j in first..end.min(SPRINGS) {
            columns[j] = Lanes(core::array::from_fn(|i| rows[i][j]));
        }
    }

    /// J⁻¹ x of x that is 0 at other points.
    pub fn solve(&self, range: [usize; 2], x: &Row) -> Row {
        let y = self.per_pivot * times(&self.columns, range, &(self.per_pivot * *x));
        self.per_pivot * times(&self.rows, range, &y)
    }

    /// J⁻¹ x in place, of several x at once.
    pub fn solve_lanes<const L: usize>(&self, range: [usize; 2], x: &mut [Lanes<L>; SPRINGS]) {
        let per_pivots = |x: &mut [Lanes<L>; SPRINGS]| {
            for i in 0..SPRINGS {
                x[i] = self.per_pivot[i] * x[i];
            }
        };
        per_pivots(x);
        times_upper_transposed(&self.columns, range, x);
        per_pivots(x);
        times_upper(&self.columns, range, x);
        per_pivots(x);
    }
}

/// U x in place, of several x at once, by rows of an upper triangular matrix U from one to another.
pub(super) fn times_upper<const L: usize>(rows: &Matrix, [first, end]: [usize; 2], x: &mut [Lanes<L>; SPRINGS]) {
    for i in first..end.min(SPRINGS) {
        let mut sum = Lanes::ZERO;
        for m in i..end.min(SPRINGS) {
            sum += rows[i][m] * x[m];
        }
        x[i] = sum;
    }
}

/// U' x in place.
pub(super) fn times_upper_transposed<const L: usize>(
    rows: &Matrix,
    [first, end]: [usize; 2],
    x: &mut [Lanes<L>; SPRINGS],
) {
    for i in (first..end).rev().map(|i| i.min(SPRINGS - 1)) {
        let mut sum = Lanes::ZERO;
        for m in first..(i + 1).min(end) {
            sum += rows[m][i] * x[m];
        }
        x[i] = sum;
    }
}
