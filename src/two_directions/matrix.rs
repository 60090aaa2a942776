//! Products and inverses of the matrices of a step, in vectors of the processor.

use super::nodes::{Matrix, N, Row};
use crate::numerics::guard::TINY;
use crate::numerics::lanes::Lanes;

/// Σ x_m matrix[m], of the rows from one to another.
pub(super) fn times(matrix: &Matrix, [first, end]: [usize; 2], x: &Row) -> Row {
    let mut y = Row::ZERO;
    for m in first..end.min(N) {
        y += x[m] * matrix[m];
    }
    y
}

/// Inverts the sum of a matrix and a diagonal in place, by Gauss-Jordan elimination with pivots of two rows, for the points from one to
/// another. Single elements are chosen by their place in the lanes: a vector that is loaded right after one of its elements was stored
/// would wait for it.
pub(super) fn invert(matrix: &mut Matrix, diagonal: &Row, [first, end]: [usize; 2]) {
    for h in 0..N / 2 {
        let (p, q, mut keep) = (2 * h, 2 * h + 1, Lanes([1.0; N]));
        if q < first || p >= end {
            continue;
        }
        let (a, b, c, d) = (matrix[p][p] + diagonal[p], matrix[p][q], matrix[q][p], matrix[q][q] + diagonal[q]);
        let det = a * d - b * c;
        let per_det = 1.0 / if det.abs() > TINY { det } else { TINY };
        let (a, b, c, d) = (a * per_det, b * per_det, c * per_det, d * per_det);
        let (mut upper, mut lower) = (matrix[p], matrix[q]);
        for j in 0..N {
            let (unit_p, unit_q) = (f64::from(j == p), f64::from(j == q));
            keep[j] = 1.0 - unit_p - unit_q;
            let (x, y) = (upper[j] * keep[j] + unit_p, lower[j] * keep[j] + unit_q);
            (upper[j], lower[j]) = (d * x - b * y, a * y - c * x);
        }
        for i in 2 * (first / 2)..end.min(N) {
            let (x, y) = (matrix[i][p], matrix[i][q]);
            matrix[i] = matrix[i] * keep - x * upper - y * lower;
        }
        (matrix[p], matrix[q]) = (upper, lower);
    }
}
