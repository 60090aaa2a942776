//! Polynomials evaluated by four interleaved Horner schemes, two pairs of numbers, to shorten the chain of dependent
//! operations.

use super::const_math::tabulate;
use super::lanes::Lanes;

/// Coefficients of x⁰, x¹, ... in rows of four.
pub(crate) type PolynomialRows<const R: usize> = [[f64; 4]; R];

/// Arranges coefficients in rows.
pub(crate) const fn rows<const N: usize, const R: usize>(terms: &[f64; N]) -> PolynomialRows<R> {
    assert!(N == 4 * R);
    tabulate!(R, |r| [terms[4 * r], terms[4 * r + 1], terms[4 * r + 2], terms[4 * r + 3]])
}

/// Value at x of a polynomial given by its rows.
#[inline]
pub(crate) fn value(rows: &[[f64; 4]], x: f64) -> f64 {
    values_and_slopes::<1, false>(rows, Lanes([x])).0[0]
}

/// Value and derivative at x.
#[inline(always)]
pub(crate) fn value_and_slope(rows: &[[f64; 4]], x: f64) -> (f64, f64) {
    let (value, slope) = values_and_slopes::<1, true>(rows, Lanes([x]));
    (value[0], slope[0])
}

/// Values and derivatives at L places, the bits of which do not depend on L. Without slopes these are 0.
#[inline(always)]
pub(crate) fn values_and_slopes<const L: usize, const SLOPES: bool>(
    rows: &[[f64; 4]],
    x: Lanes<L>,
) -> (Lanes<L>, Lanes<L>) {
    let zero = Lanes([0.0; L]);
    let square = x * x;
    let step = square * square;
    // Sums of every fourth power, and their derivatives by x⁴.
    let (mut sums, mut slopes) = ([zero; 4], [zero; 4]);
    for (n, row) in rows.iter().rev().enumerate() {
        for c in 0..4 {
            if SLOPES && n > 0 {
                slopes[c] = if n > 1 { slopes[c] * step + sums[c] } else { sums[c] };
            }
            sums[c] = if n > 0 { sums[c] * step + row[c] } else { Lanes([row[c]; L]) };
        }
    }
    let value = (sums[0] + sums[2] * square) + (sums[1] + sums[3] * square) * x;
    if !SLOPES {
        return (value, zero);
    }
    let (twice, cube) = (2.0 * x, 4.0 * (square * x));
    let even_rate = sums[2] * twice + (slopes[0] + slopes[2] * square) * cube;
    let odd_rate = sums[3] * twice + (slopes[1] + slopes[3] * square) * cube;
    (value, (sums[1] + sums[3] * square) + (even_rate + odd_rate * x))
}
