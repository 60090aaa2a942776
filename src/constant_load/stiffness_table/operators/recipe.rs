//! How the operators are computed. Gauss-Legendre rules of 32 nodes are exact to rounding: where a root begins in a piece or next
//! to it, its square root is the variable.

use super::{All, FAR_TERMS, FIRST, Functionals, OPERATORS, Operator, Operators, TOP};
use crate::numerics::chebyshev::{Interpolant, TERMS};
use crate::numerics::quadrature::{MAX_GAUSS_BLOCKS, gauss_rule};
use core::array::from_fn;
use std::format;
use std::string::String;

const GAUSS: &[[[f64; 4]; 2]] = gauss_rule(MAX_GAUSS_BLOCKS);

/// `sqrt(x)` of a normal number, or 0: Newton's method from half the exponent.
fn square_root(x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    let mut root = f64::from_bits((x.to_bits() >> 1) + (1023 << 51));
    let mut rounds = 0;
    while rounds < 5 {
        root = 0.5 * (root + x / root);
        rounds += 1;
    }
    root
}

/// `(3 + z)/4`, from 1/2 to 1, at a row point.
fn v_at<const ROWS: usize>(row: usize) -> f64 {
    0.25 * (3.0 + Interpolant::<ROWS>::POINTS[row])
}

fn power(x: f64, n: usize) -> f64 {
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
    fn add(&mut self, x: f64, weight: f64, chebyshev: bool) {
        let (mut before, mut value, mut n) = (x, 1.0, 0);
        while n < N {
            self.moments[n] += weight * value;
            let next = if chebyshev { 2.0 * x * value - before } else { x * value };
            (before, value) = (value, next);
            n += 1;
        }
    }

    /// The weights of the values at the points.
    fn weights(&self) -> [f64; N] {
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
fn coefficients<const INPUTS: usize, const N: usize>(rows: &[[f64; INPUTS]; N]) -> Operator<INPUTS, N> {
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
fn weight_at(v: f64, first: bool) -> f64 {
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
    fn at<const N: usize>(self, v_row: f64) -> Functional<N> {
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

    fn operator<const INPUTS: usize, const ROWS: usize>(self) -> Operator<INPUTS, ROWS> {
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
fn quotient(v: f64, w: f64) -> f64 {
    let (v2, w2) = (v * v, w * w);
    (v + w) * (v2 + w2) * (v2 * v2 + w2 * w2)
}

impl<const N: usize> Operators<N> {
    fn compute() -> Operators<N> {
        Operators {
            below: Kernel::Below.operator(),
            above: Kernel::Above { factor: 1.0 }.operator(),
            above_before: Kernel::Above { factor: 256.0 }.operator(),
            mean: Kernel::Mean.operator(),
            energy: Kernel::Energy.operator(),
            inverse: powers_of_s(-2),
            inverse_roots: [powers_of_s(-1), powers_of_s(-3), powers_of_s(-5), powers_of_s(-7)],
        }
    }
}

impl<const N: usize> Functionals<N> {
    fn compute() -> Functionals<N> {
        Functionals {
            below_next: Kernel::BelowNext.operator(),
            above_next: Kernel::Above { factor: 1.0 / 256.0 }.operator(),
            root_moments: from_fn(|k| moment(-1 - 2 * k as i32, N == FIRST)),
            root_moment: moment(1, N == FIRST),
            moments: from_fn(|k| moment(2 * k as i32, false)),
        }
    }
}

fn compute() -> All {
    All {
        to_first: Operators::compute(),
        to_others: Operators::compute(),
        of_first: Functionals::compute(),
        of_others: Functionals::compute(),
        powers: from_fn(|k| powers_of_s(2 * k as i32)),
        outer_below: outer_operator(1.0),
        outer_above: outer_operator(-1.0),
        outer_root_moments: from_fn(|k| outer(0.0, Some(-1 - 2 * k as i32))),
        outer_root_moment: outer(0.0, Some(1)),
        far: far_operator(),
        far_first: far(1.0),
        far_second: far(1.0 / 256.0),
        far_roots: far_roots(),
    }
}

/// The value as Rust prints it: each number is the shortest that is read as the same double.
#[test]
fn the_file_holds_what_the_recipe_gives() {
    let (mut text, mut column) = (String::new(), 0);
    for word in format!("{:?}", compute()).split_whitespace() {
        column += word.len() + 1;
        let wraps = column > 130;
        column = if wraps { word.len() } else { column };
        text += if wraps { "\n" } else { " " };
        text += word;
    }
    let path = std::env::temp_dir().join("values.in");
    if text.trim() != include_str!("values.in").trim() {
        std::fs::write(&path, text.trim()).unwrap();
        panic!("the values of the recipe are in {}", path.display());
    }
}

/// Weights of `∫ f s^p ds` over a piece, p = power/2, or of that of φ on the first.
fn moment<const N: usize>(half_powers: i32, first: bool) -> [f64; N] {
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

fn v_power(v: f64, exponent: i32) -> f64 {
    if exponent >= 0 { power(v, exponent as usize) } else { 1.0 / power(v, -exponent as usize) }
}

/// Coefficients of `s^p`, p = power/2.
fn powers_of_s<const N: usize>(half_powers: i32) -> [f64; N] {
    let mut rows = [[0.0; 1]; N];
    let mut row = 0;
    while row < N {
        rows[row][0] = v_power(v_at::<N>(row), 4 * half_powers);
        row += 1;
    }
    coefficients(&rows)[0]
}

/// Beyond the pieces, `ρ = 1 - x` from TOP to 1, the input is a polynomial in `y = x/(1 - TOP)`: integrals of
/// `sqrt(x) f/(sqrt(ρ) + sqrt(ρ - e))`, e at most TOP, or with p of `sqrt(x) f ρ^p`.
fn outer(e: f64, half_powers: Option<i32>) -> [f64; TERMS] {
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

fn outer_operator(sign: f64) -> Operator<TERMS, FIRST> {
    let mut rows = [[0.0; TERMS]; FIRST];
    let mut row = 0;
    while row < FIRST {
        rows[row] = outer(sign * TOP * power(v_at::<FIRST>(row), 8), None);
        row += 1;
    }
    coefficients(&rows)
}

/// Beyond the pieces of gross slip, from the first polynomial.
fn far_operator() -> Operator<TERMS, FAR_TERMS> {
    let mut rows = [[0.0; TERMS]; FAR_TERMS];
    let mut row = 0;
    while row < FAR_TERMS {
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

/// For all pieces but the first two.
fn far_roots() -> Operator<2, FAR_TERMS> {
    let mut rows = [[0.0; 2]; FAR_TERMS];
    let mut row = 0;
    while row < FAR_TERMS {
        let q = far_at(row);
        let root = square_root(1.0 - q);
        rows[row] = [root, 0.5 * q / root];
        row += 1;
    }
    coefficients(&rows)
}

/// q at a row point.
fn far_at(row: usize) -> f64 {
    0.5 * (1.0 + Interpolant::<FAR_TERMS>::POINTS[row]) / (1.0 + TOP)
}

fn far<const N: usize>(scale: f64) -> Operator<N, FAR_TERMS> {
    let mut rows = [[0.0; N]; FAR_TERMS];
    let mut row = 0;
    while row < FAR_TERMS {
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

    #[test]
    fn square_root_agrees_with_the_standard_library() {
        for x in [0.0, 1e-300, 1e-9, 0.5, 1.0, 2.0, 3.7, 1e200f64] {
            assert!((square_root(x) - x.sqrt()).abs() <= f64::EPSILON * x.sqrt(), "{x}");
        }
    }

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

    #[test]
    fn outer_integrals_are_elementary() {
        let direct = OPERATORS.outer_root_moment;
        // ∫ sqrt(x (1-x)) over (0, 0.4).
        let angle = (0.4f64).sqrt().asin();
        assert!((direct[0] - 0.25 * (angle - 0.25 * (4.0 * angle).sin())).abs() < 1e-15);
    }
}
