//! Products and inverses of the matrices of a step, in vectors of the processor.

use super::nodes::{Matrix, Row, SPRINGS};
use crate::numerics::guard::TINY;
use crate::numerics::lanes::Lanes;
use crate::numerics::slices::PanicFreeSlice;

/// Σ x_m A_m, with the rows A_m of a matrix in a range.
pub(super) fn times(matrix: &Matrix, [first, end]: [usize; 2], x: &Row) -> Row {
    let mut y = Row::ZERO;
    for m in first..end.min(SPRINGS) {
        y += x[m] * matrix[m];
    }
    y
}

/// Σ x_i y_i, added up in vectors of four.
pub(crate) fn dot(x: &Row, y: &Row) -> f64 {
    let sums = (*x * *y).blocks().iter().fold(Lanes::<4>::ZERO, |sums, block| sums + Lanes(*block));
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// Eliminates point i of a symmetric matrix A, in place: the Schur complement of A_ii between the others, A_im/A_ii in
/// row and column i, -1/A_ii on the diagonal. When all points are eliminated, -A⁻¹ is left.
pub(super) fn eliminate(matrix: &mut Matrix, i: usize, [first, end]: [usize; 2]) {
    let i = i.min(SPRINGS - 1);
    let pivot = matrix[i][i];
    let per_pivot = 1.0 / if pivot.abs() > TINY { pivot } else { TINY };
    let row = per_pivot * matrix[i];
    for m in first..end.min(SPRINGS) {
        let x = matrix[m][i];
        if m != i {
            matrix[m] -= x * row;
            matrix[m][i] = x * per_pivot;
        }
    }
    matrix[i] = row;
    matrix[i][i] = -per_pivot;
}

/// A x of several x at once, with the part of a symmetric matrix A in a range.
pub(super) fn times_symmetric<const L: usize>(
    rows: &Matrix,
    [first, end]: [usize; 2],
    x: &[Lanes<L>; SPRINGS],
) -> [Lanes<L>; SPRINGS] {
    let mut y = [Lanes::ZERO; SPRINGS];
    for i in first..end.min(SPRINGS) {
        for m in first..end.min(SPRINGS) {
            y[i] += rows[i][m] * x[m];
        }
    }
    y
}

/// U x in place, of several x at once, with the part of an upper triangular matrix U in a range.
pub(super) fn times_upper<const L: usize>(rows: &Matrix, [first, end]: [usize; 2], x: &mut [Lanes<L>; SPRINGS]) {
    for i in first..end.min(SPRINGS) {
        let mut sum = Lanes::ZERO;
        for m in i..end.min(SPRINGS) {
            sum += rows[i][m] * x[m];
        }
        x[i] = sum;
    }
}

/// U' x in place, as [`times_upper`].
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
