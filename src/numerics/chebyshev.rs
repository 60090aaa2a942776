//! Interpolation of values and slopes at Chebyshev points. For a smooth function the trailing coefficients estimate the
//! error.

use super::const_math::{cosine, tabulate};
use crate::numerics::polynomial::PolynomialRows;
use crate::numerics::slices::PanicFreeSlice;

/// Number of coefficients of a polynomial, and largest number of interpolation points.
pub(crate) const TERMS: usize = 20;

/// A polynomial in rows of four coefficients.
pub(crate) type Polynomial = PolynomialRows<{ TERMS / 4 }>;

/// Coefficients of the powers of z in T_n(shift + scale z), at `[n][power]`: integers, exact below 2⁵³.
const fn powers_in<const N: usize>(shift: f64, scale: f64) -> [[f64; N]; N] {
    let mut table = [[0.0; N]; N];
    table[0][0] = 1.0;
    table[1][0] = shift;
    table[1][1] = scale;
    let mut n = 2;
    while n < N {
        let mut k = 0;
        while k <= n {
            let below = if k > 0 { table[n - 1][k - 1] } else { 0.0 };
            table[n][k] = 2.0 * (shift * table[n - 1][k] + scale * below) - table[n - 2][k];
            k += 1;
        }
        n += 1;
    }
    table
}

/// Coefficients of the powers of z in the last M of the polynomials T_n(shift + scale z), n < N, each over its leading
/// coefficient.
pub(crate) const fn monic_powers<const N: usize, const M: usize>(shift: f64, scale: f64) -> [[f64; N]; M] {
    let powers = powers_in::<N>(shift, scale);
    tabulate!(M, |m| tabulate!(N, |k| powers[N - M + m][k] / powers[N - M + m][N - M + m]))
}

/// Expansion about the middle of (-1, 1), in powers of z.
static AROUND_MIDDLE: [[f64; 32]; 32] = powers_in(0.0, 1.0);
/// Expansion about the lower end, in powers of y = (1+z)/2 from 0 to 1.
static FROM_END: [[f64; 24]; 24] = powers_in(-1.0, 2.0);

/// 1/n, from n = 1: a table, because a vectorised division may divide by 0 in an unused lane (see `guard`).
pub(crate) static RECIPROCALS: [f64; TERMS] = tabulate!(TERMS, |n| 1.0 / (n as f64 + 1.0));

/// Value and slope of a function at a point.
#[derive(Clone, Copy, Default)]
pub(crate) struct SeriesPoint {
    pub value: f64,
    pub slope: f64,
}

/// A Chebyshev series: the coefficients of T_0, T_1, ...
#[derive(Clone, Copy)]
pub(crate) struct Interpolant<const N: usize>([f64; N]);

impl<const N: usize> Interpolant<N> {
    /// Interpolation points on (-1, 1), in descending order.
    pub const POINTS: [f64; N] = tabulate!(N, |j| cosine(2 * j + 1, N));

    /// T_n at point j, at `[j][n]`.
    const AT_POINTS: [[f64; N]; N] = tabulate!(N, |j| tabulate!(N, |n| cosine(n * (2 * j + 1), N)));

    /// sin θ sin (N-m)θ at `[j][m]`, with point j at cos θ.
    const SINES: [[f64; N]; N] = tabulate!(N, |j| tabulate!(N, |m| {
        // sin θ = cos(θ - π/2), in N parts of a quarter of a period.
        let (first, all) = (2 * j + 1, (N - m) * (2 * j + 1));
        cosine(first + 3 * N, N) * cosine(all + 3 * N, N)
    }));

    /// Values at the interpolation points, computed in their order.
    pub fn at_points<T: Copy + Default>(mut value: impl FnMut(f64) -> T) -> [T; N] {
        let mut values = [T::default(); N];
        values.iter_mut().zip(const { &Self::POINTS }).for_each(|(at_point, z)| *at_point = value(*z));
        values
    }

    /// The interpolant of values and slopes at N/2 Chebyshev points.
    ///
    /// At the M points T_M+k = -T_M-k, and sin θ dT_n/dz = n sin nθ has the same value for both. So the transforms
    /// `a_m = 2/M Σ f cos mθ` and `b_m = 2/M Σ f' sin θ sin mθ` equal `c_m - c_2M-m` and `m c_m + (2M-m) c_2M-m`.
    #[inline(never)]
    pub fn osculating<const M: usize>(tangents: &[SeriesPoint; M]) -> Interpolant<N> {
        const { assert!(N == 2 * M) };
        let mut coefficients = [0.0; N];
        let (values, slopes) = coefficients.split_at_mut(M);
        add_rows(values, tangents.iter().map(|at| at.value), const { &Interpolant::<M>::AT_POINTS });
        add_rows(slopes, tangents.iter().map(|at| at.slope), const { &Interpolant::<M>::SINES });
        values.iter_mut().for_each(|sum| *sum *= 2.0 / M as f64);
        slopes.iter_mut().for_each(|sum| *sum *= 1.0 / (M * M) as f64);
        if let [mean, ..] = values {
            *mean *= 0.5;
        }
        for ((value, slope), m) in values.iter_mut().skip(1).zip(slopes.iter_mut().skip(1).rev()).zip(1..) {
            *slope -= *value * (f64::from(m) / N as f64);
            *value += *slope;
        }
        Interpolant(coefficients)
    }

    /// Whether the last two coefficients are within the tolerance.
    pub fn is_converged(&self, tolerance: f64) -> bool {
        let &[.., last_but_one, last] = self.0.as_slice() else { return false };
        last_but_one.abs().max(last.abs()) <= tolerance
    }

    /// Coefficient of T_0: the mean of the values at the points.
    pub fn mean(&self) -> f64 {
        self.0.or_zero(0)
    }

    /// The coefficients of T_0, T_1, ...
    pub fn terms(&self) -> &[f64; N] {
        &self.0
    }

    /// The integral over z whose mean over the points of [`Interpolant::osculating`] is zero. The twentieth coefficient
    /// is dropped: its integral would exceed the degree.
    pub fn integral(&self) -> Interpolant<TERMS> {
        let mut padded = [0.0; TERMS + 1];
        padded.copy_from(self.0.part(..TERMS - 1));
        padded[0] *= 2.0;
        let mut integral = [0.0; TERMS];
        for n in 1..TERMS {
            integral[n] = 0.5 * RECIPROCALS[n - 1] * (padded[n - 1] - padded[n + 1]);
        }
        Interpolant(integral)
    }

    /// Coefficients of the powers of z.
    pub fn powers_from_middle(&self) -> [f64; N] {
        self.powers_of(&AROUND_MIDDLE)
    }

    /// Coefficients of the powers of y = (1+z)/2.
    pub fn powers_from_end(&self) -> [f64; N] {
        self.powers_of(&FROM_END)
    }

    /// Mean over (0, y), as a polynomial in y = (1+z)/2.
    pub fn mean_from_end(&self) -> [f64; N] {
        let mut powers = self.powers_from_end();
        powers.iter_mut().zip(&RECIPROCALS).for_each(|(power, reciprocal)| *power *= reciprocal);
        powers
    }

    fn powers_of<const M: usize>(&self, table: &[[f64; M]; M]) -> [f64; N] {
        let mut powers = [0.0; N];
        add_triangle(&mut powers, &self.0, table.as_flattened(), M);
        powers
    }
}

/// Adds rows, each times its factor.
#[inline(always)]
fn add_rows<const M: usize>(sums: &mut [f64], factors: impl Iterator<Item = f64>, rows: &[[f64; M]; M]) {
    for (factor, row) in factors.zip(rows) {
        sums.iter_mut().zip(row).for_each(|(sum, value)| *sum += factor * value);
    }
}

/// Adds the polynomials of degrees 0, 1, ... in the rows of a table of the given width, each times its factor. One
/// function serves all lengths; the compiler would unroll it for each of them.
#[inline(never)]
fn add_triangle(powers: &mut [f64], factors: &[f64], table: &[f64], width: usize) {
    for ((factor, row), terms) in factors.iter().zip(table.chunks_exact(width.max(1))).zip(1..) {
        powers.iter_mut().zip(row).take(terms).for_each(|(power, value)| *power += factor * value);
    }
}

/// Coefficients of the powers of z of a Chebyshev series. The terms at its end that are rounding errors, or exceed the
/// rows, are left out: their derivatives would be n² times as large.
pub(crate) fn powers<const R: usize>(series: &[f64]) -> PolynomialRows<R> {
    let mut result = [[0.0; 4]; R];
    add_powers(result.as_flattened_mut(), series);
    result
}

#[inline(never)]
fn add_powers(powers: &mut [f64], series: &[f64]) {
    let size = series.iter().fold(0.0, |size: f64, term| size.max(term.abs()));
    let used = series.iter().rposition(|term| term.abs() > f64::EPSILON * size).map_or(0, |last| last + 1);
    let kept = series.part(..used.min(powers.len()));
    add_triangle(powers, kept, AROUND_MIDDLE.as_flattened(), AROUND_MIDDLE.len());
}
