//! Products and inverses of the matrices of a step, in vectors of the processor.

use super::tables::{Matrix, N, Row};
use crate::shape::TINY;

/// The largest size, in an order of vectors.
#[inline(always)]
pub(super) fn largest(x: &Row<f64>) -> f64 {
    let mut sizes = [0.0; 4];
    for b in 0..N / 4 {
        for lane in 0..4 {
            let size = x[4 * b + lane].abs();
            sizes[lane] = if size > sizes[lane] { size } else { sizes[lane] };
        }
    }
    let [a, b, c, d] = sizes;
    let (a, b) = (if a > c { a } else { c }, if b > d { b } else { d });
    if a > b { a } else { b }
}

/// Σ x_i y_i, in an order of vectors.
#[inline(always)]
pub(super) fn dot(x: &Row<f64>, y: &Row<f64>) -> f64 {
    let mut sums = [0.0; 4];
    for b in 0..N / 4 {
        for lane in 0..4 {
            sums[lane] += x[4 * b + lane] * y[4 * b + lane];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// Σ x_m matrix[m][i] of several matrices: rows of points that stick are 0.
#[inline(always)]
pub(super) fn times<const K: usize>(
    matrices: [&Matrix; K],
    [first, end]: [usize; 2],
    x: &[Row<f64>; K],
) -> [Row<f64>; K] {
    let mut y = [[0.0; N]; K];
    for m in first..end {
        for k in 0..K {
            for i in 0..N {
                y[k][i] += x[k][m] * matrices[k][m][i];
            }
        }
    }
    y
}

/// Inverts the sum of a matrix and a diagonal in place, by Gauss-Jordan elimination with pivots of two rows, for the points from one to
/// another. Single elements are chosen by their place in the lanes: a vector that is loaded right after one of its elements was stored
/// would wait for it.
#[inline(always)]
pub(super) fn invert(matrix: &mut Matrix, diagonal: &Row<f64>, [first, end]: [usize; 2]) {
    for h in 0..N / 2 {
        let (p, q, mut keep) = (2 * h, 2 * h + 1, [0.0; N]);
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
            let mut row = matrix[i];
            for j in 0..N {
                row[j] = row[j] * keep[j] - x * upper[j] - y * lower[j];
            }
            matrix[i] = row;
        }
        (matrix[p], matrix[q]) = (upper, lower);
    }
}
