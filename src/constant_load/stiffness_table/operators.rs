//! The linear maps from the tangent stiffness of the curve to the polynomials of a stiffness table. They are the same for all contacts:
//! integrals of Chebyshev polynomials over a piece, computed at compile time.
//!
//! Pieces of both sides of gross slip are similar: piece m is `e = TOP 256⁻ᵐ s` with `s = v⁸` from 1/256 to 1 and `v = (3 + z)/4`, z
//! from -1 to 1. An operator maps what the tangent stiffness gives at the points of one piece (index i) to Chebyshev coefficients
//! (index n) of a function on the same or a neighbouring one. The input is `φ = sqrt(1 - ρ) k`, but k on the first piece, where the
//! root is not smooth. Gauss-Legendre rules of 32 nodes are exact to rounding: where a root
//! begins in a piece or next to it, its square root is the variable.

use crate::numerics::chebyshev::{Interpolant, TERMS};
use crate::numerics::const_math::square_root;
use crate::numerics::quadrature::{MAX_GAUSS_BLOCKS, gauss_rule};

/// Interpolation points of the first piece, which is the closest to singularities beyond zero displacement, and of the others.
pub(super) const FIRST: usize = 32;
pub(super) const POINTS: usize = 24;
/// Largest e of the first piece.
pub(super) const TOP: f64 = 0.6;
/// Terms of a Taylor series in a ratio of at most 1/256.
pub(super) const TAYLOR: usize = 7;
/// The same for a contribution that is at most 256^(-3/2) of the whole.
pub(super) const INNER_TAYLOR: usize = 4;

/// Chebyshev coefficients n for input i, at `[i][n]`.
type Operator<const INPUTS: usize, const TERMS: usize> = [[f64; TERMS]; INPUTS];

const GAUSS: &[[[f64; 4]; 2]] = gauss_rule(MAX_GAUSS_BLOCKS);

/// `(3 + z)/4`, from 1/2 to 1, at a row point.
const fn v_at<const ROWS: usize>(row: usize) -> f64 {
    0.25 * (3.0 + Interpolant::<ROWS>::POINTS[row])
}

const fn power(x: f64, n: usize) -> f64 {
    let (mut product, mut square, mut n) = (1.0, x, n);
    while n > 0 {
        if n % 2 == 1 {
            product *= square;
        }
        square *= square;
        n /= 2;
    }
    product
}

/// A linear functional of the input: integrals of its basis functions, Chebyshev polynomials in z or powers of y.
#[derive(Clone, Copy)]
struct Functional<const N: usize> {
    moments: [f64; N],
}

impl<const N: usize> Functional<N> {
    const ZERO: Functional<N> = Functional { moments: [0.0; N] };

    /// Adds `weight f(x)`, with `T_0(x) = 1, T_1(x) = x, ...` or the powers of x as basis.
    const fn add(&mut self, x: f64, weight: f64, chebyshev: bool) {
        let (mut before, mut value, mut n) = (x, 1.0, 0);
        while n < N {
            self.moments[n] += weight * value;
            let next = if chebyshev { 2.0 * x * value - before } else { x * value };
            (before, value) = (value, next);
            n += 1;
        }
    }

    /// The weights of the values at the points.
    const fn weights(&self) -> [f64; N] {
        let at_points = &Interpolant::<N>::AT_POINTS;
        let mut weights = [0.0; N];
        let mut i = 0;
        while i < N {
            let (point, mut sum, mut n) = (&at_points[i], 0.5 * self.moments[0], 1);
            while n < N {
                sum += self.moments[n] * point[n];
                n += 1;
            }
            weights[i] = 2.0 / N as f64 * sum;
            i += 1;
        }
        weights
    }
}

/// Chebyshev coefficients of the functions whose values at the points of an interpolant are the rows.
const fn coefficients<const INPUTS: usize, const N: usize>(rows: &[[f64; INPUTS]; N]) -> Operator<INPUTS, N> {
    let at_points = &Interpolant::<N>::AT_POINTS;
    let mut operator = [[0.0; N]; INPUTS];
    let mut i = 0;
    while i < INPUTS {
        let mut n = 0;
        while n < N {
            let (mut sum, mut row) = (0.0, 0);
            while row < N {
                sum += at_points[row][n] * rows[row][i];
                row += 1;
            }
            operator[i][n] = (if n == 0 { 1.0 } else { 2.0 }) / N as f64 * sum;
            n += 1;
        }
        i += 1;
    }
    operator
}

/// `φ` over the input at s.
const fn weight_at(v: f64, first: bool) -> f64 {
    if first { square_root(1.0 - TOP * power(v, 8)) } else { 1.0 }
}

/// Kernels of integrals over a piece for a point at `e`, in units of the scale of the piece or, for `Energy`, of the row.
#[derive(Clone, Copy)]
enum Kernel {
    /// `∫ φ/(sqrt(s) + sqrt(s - e)) ds` beyond e plus `(1/e) ∫ sqrt(s) φ ds` up to e, in the piece of e.
    Below,
    /// The first of both, for e in the next piece.
    BelowNext,
    /// `∫ φ/(sqrt(s) + sqrt(s + e)) ds` with e in the piece times that factor.
    Above { factor: f64 },
    /// `(1/e) ∫ f ds` up to e, in the piece of e.
    Mean,
    /// `∫ (1 - 2s/e) f ds` up to e, in the piece of e.
    Energy,
}

impl Kernel {
    const fn at<const N: usize>(self, v_row: f64) -> Functional<N> {
        let first = N == FIRST;
        let mut functional = Functional::<N>::ZERO;
        let e = power(v_row, 8);
        let mut node = 0;
        while node < 4 * GAUSS.len() {
            let [nodes, weights] = GAUSS[node / 4];
            let (x, weight) = (nodes[node % 4], weights[node % 4]);
            // v, and 8 v⁷ dv; up to e; beyond e; beyond the singularity below the piece.
            let lower = (0.5 + (v_row - 0.5) * x, (v_row - 0.5) * weight);
            let upper = (v_row + (1.0 - v_row) * x * x, (1.0 - v_row) * 2.0 * x * weight);
            match self {
                Kernel::Below => {
                    let (v, dv) = lower;
                    functional.add(4.0 * v - 3.0, weight_at(v, first) * 8.0 * power(v, 11) * dv / e, true);
                    let (v, dv) = upper;
                    let root = x * square_root((1.0 - v_row) * quotient(v, v_row));
                    let measure = weight_at(v, first) * 8.0 * power(v, 7) * dv;
                    functional.add(4.0 * v - 3.0, measure / (power(v, 4) + root), true);
                }
                Kernel::BelowNext => {
                    let singular = 0.5 * v_row;
                    let (from, to) = (square_root(0.5 - singular), square_root(1.0 - singular));
                    let t = from + (to - from) * x;
                    let (v, dv) = (singular + t * t, 2.0 * t * (to - from) * weight);
                    let root = t * square_root(quotient(v, singular));
                    let measure = weight_at(v, first) * 8.0 * power(v, 7) * dv;
                    functional.add(4.0 * v - 3.0, measure / (power(v, 4) + root), true);
                }
                Kernel::Above { factor } => {
                    let v = 0.5 + 0.5 * x;
                    let root = square_root(power(v, 8) + factor * e);
                    let measure = weight_at(v, first) * 4.0 * power(v, 7) * weight;
                    functional.add(4.0 * v - 3.0, measure / (power(v, 4) + root), true);
                }
                Kernel::Mean => {
                    let (v, dv) = lower;
                    functional.add(4.0 * v - 3.0, 8.0 * power(v, 7) * dv / e, true);
                }
                Kernel::Energy => {
                    let (v, dv) = lower;
                    functional.add(4.0 * v - 3.0, (1.0 - 2.0 * power(v, 8) / e) * 8.0 * power(v, 7) * dv, true);
                }
            }
            node += 1;
        }
        functional
    }

    const fn operator<const INPUTS: usize, const ROWS: usize>(self) -> Operator<INPUTS, ROWS> {
        let mut rows = [[0.0; INPUTS]; ROWS];
        let mut row = 0;
        while row < ROWS {
            rows[row] = self.at::<INPUTS>(v_at::<ROWS>(row)).weights();
            row += 1;
        }
        coefficients(&rows)
    }
}

/// `(v⁸ - w⁸)/(v - w)`.
const fn quotient(v: f64, w: f64) -> f64 {
    let (v2, w2) = (v * v, w * w);
    (v + w) * (v2 + w2) * (v2 * v2 + w2 * w2)
}

/// The operators to a piece with as many terms as points.
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

impl<const N: usize> Operators<N> {
    const ALL: Operators<N> = Operators {
        below: Kernel::Below.operator(),
        above: Kernel::Above { factor: 1.0 }.operator(),
        above_before: Kernel::Above { factor: 256.0 }.operator(),
        mean: Kernel::Mean.operator(),
        energy: Kernel::Energy.operator(),
        inverse: powers_of_s(-2),
        inverse_roots: [powers_of_s(-1), powers_of_s(-3), powers_of_s(-5), powers_of_s(-7)],
    };
}

pub(super) static TO_FIRST: Operators<FIRST> = Operators::ALL;
pub(super) static TO_OTHERS: Operators<POINTS> = Operators::ALL;

/// Functionals of a piece, and the operators from it to the next piece towards gross slip.
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

impl<const N: usize> Functionals<N> {
    const ALL: Functionals<N> = {
        let mut root_moments = [[0.0; N]; TAYLOR];
        let mut k = 0;
        while k < TAYLOR {
            root_moments[k] = moment(-1 - 2 * k as i32, N == FIRST);
            k += 1;
        }
        Functionals {
            below_next: Kernel::BelowNext.operator(),
            above_next: Kernel::Above { factor: 1.0 / 256.0 }.operator(),
            root_moments,
            root_moment: moment(1, N == FIRST),
            moments: [moment(0, false), moment(2, false), moment(4, false), moment(6, false)],
        }
    };
}

pub(super) static OF_FIRST: Functionals<FIRST> = Functionals::ALL;
pub(super) static OF_OTHERS: Functionals<POINTS> = Functionals::ALL;

/// Weights of `∫ f s^p ds` over a piece, p = power/2, or of that of φ on the first.
const fn moment<const N: usize>(half_powers: i32, first: bool) -> [f64; N] {
    let mut functional = Functional::<N>::ZERO;
    let mut node = 0;
    while node < 4 * GAUSS.len() {
        let [nodes, weights] = GAUSS[node / 4];
        let v = 0.5 + 0.5 * nodes[node % 4];
        // s^p ds = 8 v^(8p + 7) dv.
        let measure = weight_at(v, first) * 4.0 * v_power(v, 4 * half_powers + 7) * weights[node % 4];
        functional.add(4.0 * v - 3.0, measure, true);
        node += 1;
    }
    functional.weights()
}

const fn v_power(v: f64, exponent: i32) -> f64 {
    if exponent >= 0 { power(v, exponent as usize) } else { 1.0 / power(v, -exponent as usize) }
}

/// Coefficients of `s^p`, p = power/2.
const fn powers_of_s<const N: usize>(half_powers: i32) -> [f64; N] {
    let mut rows = [[0.0; 1]; N];
    let mut row = 0;
    while row < N {
        rows[row][0] = v_power(v_at::<N>(row), 4 * half_powers);
        row += 1;
    }
    coefficients(&rows)[0]
}

/// Coefficients of `s^k`.
pub(super) static POWERS: [[f64; POINTS]; TAYLOR] = {
    let mut table = [[0.0; POINTS]; TAYLOR];
    let mut k = 0;
    while k < TAYLOR {
        table[k] = powers_of_s(2 * k as i32);
        k += 1;
    }
    table
};

/// Beyond the pieces, `ρ = 1 - x` from TOP to 1, the input is a polynomial in `y = x/(1 - TOP)`: integrals of
/// `sqrt(x) f/(sqrt(ρ) + sqrt(ρ - e))`, e at most TOP, or with p of `sqrt(x) f ρ^p`.
const fn outer(e: f64, half_powers: Option<i32>) -> [f64; TERMS] {
    let mut functional = Functional::<TERMS>::ZERO;
    let (half, end) = (0.5 * (1.0 - TOP), 1.0 - TOP);
    let (from, to) = (square_root(TOP - e), square_root(1.0 - half - e));
    let mut node = 0;
    while node < 4 * GAUSS.len() {
        let [nodes, weights] = GAUSS[node / 4];
        let (t, weight) = (nodes[node % 4], weights[node % 4]);
        // Half of the range from either end, each without its root.
        let from_end = from + (to - from) * t;
        let parts = [
            (half * t * t, 2.0 * half * t * weight),
            (1.0 - e - from_end * from_end, 2.0 * from_end * (to - from) * weight),
        ];
        let mut part = 0;
        while part < 2 {
            let (x, dx) = parts[part];
            let rho = 1.0 - x;
            let kernel = match half_powers {
                None => 1.0 / (square_root(rho) + square_root(rho - e)),
                Some(p) if p >= 0 => power(square_root(rho), p as usize),
                Some(p) => 1.0 / power(square_root(rho), -p as usize),
            };
            functional.add(x / end, square_root(x) * kernel * dx, false);
            part += 1;
        }
        node += 1;
    }
    functional.moments
}

const fn outer_operator(sign: f64) -> Operator<TERMS, FIRST> {
    let mut rows = [[0.0; TERMS]; FIRST];
    let mut row = 0;
    while row < FIRST {
        rows[row] = outer(sign * TOP * power(v_at::<FIRST>(row), 8), None);
        row += 1;
    }
    coefficients(&rows)
}

pub(super) static OUTER_BELOW: Operator<TERMS, FIRST> = outer_operator(1.0);
pub(super) static OUTER_ABOVE: Operator<TERMS, FIRST> = outer_operator(-1.0);
/// Integrals of `sqrt(x) y^n ρ^(-1/2-k)`.
pub(super) static OUTER_ROOT_MOMENTS: [[f64; TERMS]; TAYLOR] = {
    let mut table = [[0.0; TERMS]; TAYLOR];
    let mut k = 0;
    while k < TAYLOR {
        table[k] = outer(0.0, Some(-1 - 2 * k as i32));
        k += 1;
    }
    table
};
/// Integrals of `sqrt(x) y^n sqrt(ρ)`.
pub(super) static OUTER_ROOT_MOMENT: [f64; TERMS] = outer(0.0, Some(1));

/// Beyond the pieces of gross slip: coefficients over q/q_max, `q = 1/ξ`, of `∫ sqrt(1 - q x) φ dx` from the first polynomial.
pub(super) static OUTER_FAR: Operator<TERMS, TERMS> = far_operator();

const fn far_operator() -> Operator<TERMS, TERMS> {
    let mut rows = [[0.0; TERMS]; TERMS];
    let mut row = 0;
    while row < TERMS {
        let q = far_at(row);
        let mut functional = Functional::<TERMS>::ZERO;
        let mut node = 0;
        while node < 4 * GAUSS.len() {
            let [nodes, weights] = GAUSS[node / 4];
            let t = nodes[node % 4];
            let x = (1.0 - TOP) * t * t;
            let measure = 2.0 * (1.0 - TOP) * t * weights[node % 4];
            functional.add(t * t, square_root(x * (1.0 - q * x)) * measure, false);
            node += 1;
        }
        rows[row] = functional.moments;
        row += 1;
    }
    coefficients(&rows)
}
/// The same from the first two pieces, in units of their scales.
pub(super) static FAR_FIRST: Operator<FIRST, TERMS> = far(1.0);
pub(super) static FAR_SECOND: Operator<POINTS, TERMS> = far(1.0 / 256.0);
/// Coefficients of `sqrt(1-q)` and of `q/(2 sqrt(1-q))`: the same of all others, by the first two moments.
pub(super) static FAR_ROOTS: Operator<2, TERMS> = far_roots();

const fn far_roots() -> Operator<2, TERMS> {
    let mut rows = [[0.0; 2]; TERMS];
    let mut row = 0;
    while row < TERMS {
        let q = far_at(row);
        let root = square_root(1.0 - q);
        rows[row] = [root, 0.5 * q / root];
        row += 1;
    }
    coefficients(&rows)
}

/// q at a row point.
const fn far_at(row: usize) -> f64 {
    0.5 * (1.0 + Interpolant::<TERMS>::POINTS[row]) / (1.0 + TOP)
}

const fn far<const N: usize>(scale: f64) -> Operator<N, TERMS> {
    let mut rows = [[0.0; N]; TERMS];
    let mut row = 0;
    while row < TERMS {
        let q = far_at(row);
        let mut functional = Functional::<N>::ZERO;
        let mut node = 0;
        while node < 4 * GAUSS.len() {
            let [nodes, weights] = GAUSS[node / 4];
            let v = 0.5 + 0.5 * nodes[node % 4];
            let rho = TOP * scale * power(v, 8);
            let measure = weight_at(v, N == FIRST) * 4.0 * power(v, 7) * weights[node % 4];
            functional.add(4.0 * v - 3.0, square_root(1.0 - q + q * rho) * measure, true);
            node += 1;
        }
        rows[row] = functional.weights();
        row += 1;
    }
    coefficients(&rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// For φ = 1 the integrals are elementary. Those of the next piece have a root or a branch point where it ends, which 16 terms do not
    /// resolve to rounding.
    #[test]
    fn operators_integrate_constants_exactly() {
        let start: f64 = 1.0 / 256.0;
        let check = |name: &str, operator: &Operator<16, 16>, tolerance: f64, exact: &dyn Fn(f64) -> f64| {
            for (row, z) in Interpolant::<16>::POINTS.into_iter().enumerate() {
                let e = power(v_at::<16>(row), 8);
                let sum: f64 = operator
                    .iter()
                    .flat_map(|column| column.iter().enumerate().map(|(n, c)| c * (n as f64 * z.acos()).cos()))
                    .sum();
                assert!((sum - exact(e)).abs() < tolerance, "{name} {e}: {sum} {}", exact(e));
            }
        };
        let roots = |from: f64, e: f64| {
            (1.0 - (1.0 - e).powf(1.5) - from.powf(1.5) + (from - e).max(0.0).powf(1.5)) / (1.5 * e)
        };
        let sums = |e: f64| ((1.0 + e).powf(1.5) - 1.0 - (start + e).powf(1.5) + start.powf(1.5)) / (1.5 * e);
        check("below", &Kernel::Below.operator(), 1e-13, &|e| roots(start, e));
        check("below, next", &Kernel::BelowNext.operator(), 1e-10, &|e| roots(start, start * e));
        check("above", &Kernel::Above { factor: 1.0 }.operator(), 1e-13, &sums);
        check("above, next", &Kernel::Above { factor: start }.operator(), 1e-10, &|e| sums(start * e));
        check("above, before", &Kernel::Above { factor: 256.0 }.operator(), 1e-13, &|e| sums(256.0 * e));
        check("mean", &Kernel::Mean.operator(), 1e-13, &|e| (e - start) / e);
        check("energy", &Kernel::Energy.operator(), 1e-13, &|e| e - start - (e * e - start * start) / e);
        for half_powers in [-13, -1, 1, 2, 6] {
            let p = 1.0 + 0.5 * f64::from(half_powers);
            let sum: f64 = moment::<16>(half_powers, false).iter().sum();
            assert!((sum / ((1.0 - start.powf(p)) / p) - 1.0).abs() < 1e-13, "{half_powers} {sum}");
        }
    }

    /// At run time as by the compiler.
    #[test]
    fn outer_integrals_are_those_of_the_table() {
        assert_eq!(outer_operator(1.0), OUTER_BELOW);
        assert_eq!(far::<POINTS>(1.0 / 256.0), FAR_SECOND);
        assert_eq!(far_operator(), OUTER_FAR);
        assert_eq!(far_roots(), FAR_ROOTS);
        let (direct, tabulated) = (outer(0.0, Some(1)), &OUTER_ROOT_MOMENT);
        assert_eq!(&direct, tabulated);
        // ∫ sqrt(x (1-x)) over (0, 0.4).
        let angle = (0.4f64).sqrt().asin();
        assert!((direct[0] - 0.25 * (angle - 0.25 * (4.0 * angle).sin())).abs() < 1e-15);
    }
}
