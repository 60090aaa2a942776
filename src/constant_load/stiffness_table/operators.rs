//! The linear maps from the tangent stiffness of the curve to the polynomials of a stiffness table. They are the same for all contacts:
//! integrals of Chebyshev polynomials over a piece.
//!
//! Pieces of both sides of gross slip are similar: piece m is `e = TOP 256⁻ᵐ s` with `s = v⁸` from 1/256 to 1 and `v = (3 + z)/4`, z
//! from -1 to 1. An operator maps what the tangent stiffness gives at the points of one piece (index i) to Chebyshev coefficients
//! (index n) of a function on the same or a neighbouring one. The input is `φ = sqrt(1 - ρ) k`, but k on the first piece, where the
//! root is not smooth.
//!
//! The values are in `operators/values.in`, which is generated: `recipe` computes them, and its tests compare every digit.

#[cfg(test)]
mod recipe;

use crate::numerics::chebyshev::TERMS;

/// Interpolation points of the first piece, which is the closest to singularities beyond zero displacement, and of the others.
pub(super) const FIRST: usize = 32;
pub(super) const POINTS: usize = 24;
/// Largest e of the first piece.
pub(super) const TOP: f64 = 0.6;
/// Terms beyond the pieces of gross slip: the derivative of those that are left out is n² times as large.
pub(super) const FAR_TERMS: usize = 24;
/// Terms of a Taylor series in a ratio of at most 1/256.
pub(super) const TAYLOR: usize = 7;
/// The same for a contribution that is at most 256^(-3/2) of the whole.
pub(super) const INNER_TAYLOR: usize = 4;

/// Chebyshev coefficients n for input i, at `[i][n]`.
type Operator<const INPUTS: usize, const TERMS: usize> = [[f64; TERMS]; INPUTS];

/// The operators to a piece with as many terms as points.
#[derive(Debug)]
pub(super) struct Operators<const N: usize> {
    /// G below gross slip, from the piece of e.
    pub below: Operator<N, N>,
    /// G beyond, from the piece of |e|, and from the next one towards gross slip.
    pub above: Operator<N, N>,
    pub above_before: Operator<POINTS, N>,
    /// `(1/e) ∫ f ds` and `∫ (1 - 2s/e) f ds` up to e.
    pub mean: Operator<N, N>,
    pub energy: Operator<N, N>,
    /// `1/s` and `s^(-1/2-k)`.
    pub inverse: [f64; N],
    pub inverse_roots: [[f64; N]; INNER_TAYLOR],
}

/// Functionals of a piece, and the operators from it to the next piece towards gross slip.
#[derive(Debug)]
pub(super) struct Functionals<const N: usize> {
    /// G below and beyond gross slip.
    pub below_next: Operator<N, POINTS>,
    pub above_next: Operator<N, POINTS>,
    /// Weights of `∫ φ s^(-1/2-k) ds` and of `∫ φ sqrt(s) ds`.
    pub root_moments: [[f64; N]; TAYLOR],
    pub root_moment: [f64; N],
    /// Weights of `∫ φ s^k ds`, for the first piece of `∫ f s^k ds`.
    pub moments: [[f64; N]; INNER_TAYLOR],
}

/// All operators.
#[derive(Debug)]
pub(super) struct All {
    /// To the first piece and to the others.
    pub to_first: Operators<FIRST>,
    pub to_others: Operators<POINTS>,
    /// Of the first piece and of the others.
    pub of_first: Functionals<FIRST>,
    pub of_others: Functionals<POINTS>,
    /// Coefficients of `s^k`.
    pub powers: [[f64; POINTS]; TAYLOR],
    /// Beyond the pieces, `ρ = 1 - x` from TOP to 1, the input is a polynomial in `y = x/(1 - TOP)`: its contributions to G below and
    /// beyond gross slip on the first piece.
    pub outer_below: Operator<TERMS, FIRST>,
    pub outer_above: Operator<TERMS, FIRST>,
    /// Integrals of `sqrt(x) y^n ρ^(-1/2-k)` and of `sqrt(x) y^n sqrt(ρ)`.
    pub outer_root_moments: [[f64; TERMS]; TAYLOR],
    pub outer_root_moment: [f64; TERMS],
    /// Beyond the pieces of gross slip: coefficients over q/q_max, `q = 1/ξ`, of `∫ sqrt(1 - q x) φ dx` from the first polynomial, and
    /// from the first two pieces, in units of their scales.
    pub far: Operator<TERMS, FAR_TERMS>,
    pub far_first: Operator<FIRST, FAR_TERMS>,
    pub far_second: Operator<POINTS, FAR_TERMS>,
    /// Coefficients of `sqrt(1-q)` and of `q/(2 sqrt(1-q))`: the same of all others, by the first two moments.
    pub far_roots: Operator<2, FAR_TERMS>,
}

/// The file holds what Rust prints for the value.
pub(super) static OPERATORS: All = include!("operators/values.in");
