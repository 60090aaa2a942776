//! Interpolation of values and slopes at Chebyshev points. For a smooth function the trailing coefficients estimate the error.

use super::const_math::cosine;
use crate::numerics::polynomial::{Rows, rows};

/// Largest number of coefficients of a polynomial.
pub(crate) const TERMS: usize = 20;

/// A polynomial in rows of four coefficients.
pub(crate) type Polynomial = Rows<{ TERMS / 4 }>;

/// Coefficients of the powers of z in T_n(shift + scale z), at `[n][power]`: integers below 2⁵³.
const fn powers_in(shift: f64, scale: f64) -> [[f64; TERMS]; TERMS] {
    let mut table = [[0.0; TERMS]; TERMS];
    table[0][0] = 1.0;
    table[1][0] = shift;
    table[1][1] = scale;
    let mut n = 2;
    while n < TERMS {
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

/// Expansion about the middle of (-1, 1), in powers of z.
static AROUND_MIDDLE: [[f64; TERMS]; TERMS] = powers_in(0.0, 1.0);
/// Expansion about the upper end, in powers of y = (1-z)/2 from 0 to 1.
static FROM_END: [[f64; TERMS]; TERMS] = powers_in(1.0, -2.0);

/// Value and slope of a function at a point.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Tangent {
    pub value: f64,
    pub slope: f64,
}

/// The M Chebyshev points `z = cos θ` on (-1, 1), in descending order.
pub(crate) struct Points<const M: usize>;

impl<const M: usize> Points<M> {
    pub const Z: [f64; M] = {
        let mut table = [0.0; M];
        let mut j = 0;
        while j < M {
            table[j] = cosine(2 * j + 1, M);
            j += 1;
        }
        table
    };

    /// cos mθ at `[j][m]`.
    const COSINES: [[f64; M]; M] = {
        let mut table = [[0.0; M]; M];
        let mut j = 0;
        while j < M {
            let mut m = 0;
            while m < M {
                table[j][m] = cosine(m * (2 * j + 1), M);
                m += 1;
            }
            j += 1;
        }
        table
    };

    /// sin θ sin (M-m)θ at `[j][m]`.
    const SINES: [[f64; M]; M] = {
        let mut table = [[0.0; M]; M];
        let mut j = 0;
        while j < M {
            let mut m = 0;
            while m < M {
                // sin θ = cos(π/2 - θ), in quarters of a period of M.
                let (first, all) = (2 * j + 1, (M - m) * (2 * j + 1));
                table[j][m] = cosine(5 * M - first, M) * cosine(5 * M + 4 * M * M - all, M);
                m += 1;
            }
            j += 1;
        }
        table
    };
}

/// A Chebyshev series: the coefficients of T_0, T_1, ...
#[derive(Debug, Clone, Copy)]
pub(crate) struct Interpolant<const N: usize>([f64; N]);

impl<const N: usize> Interpolant<N> {
    /// The interpolant of values and slopes at N/2 Chebyshev points.
    ///
    /// At the M points T_M+k = -T_M-k, and sin θ dT_n/dz = n sin nθ has the same value for both. So the transforms
    /// `a_m = 2/M Σ f cos mθ` and `b_m = 2/M Σ f' sin θ sin mθ` equal `c_m - c_2M-m` and `m c_m + (2M-m) c_2M-m`.
    pub fn through<const M: usize>(tangents: &[Tangent; M]) -> Interpolant<N> {
        const { assert!(N == 2 * M) };
        let mut coefficients = [0.0; N];
        let (values, slopes) = coefficients.split_at_mut(M);
        let tables = const { &Points::<M>::COSINES }.iter().zip(const { &Points::<M>::SINES });
        for (tangent, (cosines, sines)) in tangents.iter().zip(tables) {
            values.iter_mut().zip(cosines).for_each(|(sum, cosine)| *sum += tangent.value * cosine);
            slopes.iter_mut().zip(sines).for_each(|(sum, sine)| *sum += tangent.slope * sine);
        }
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
        self.0.first().copied().unwrap_or(0.0)
    }

    /// The integral over z whose mean over the points is zero. The twentieth coefficient is dropped: its integral would exceed the
    /// degree.
    pub fn integral(&self) -> Interpolant<TERMS> {
        let mut padded = [0.0; TERMS + 1];
        padded.iter_mut().zip(&self.0).take(TERMS - 1).for_each(|(target, coefficient)| *target = *coefficient);
        if let Some(first) = padded.first_mut() {
            *first *= 2.0;
        }
        let mut integral = [0.0; TERMS];
        for (((target, below), above), n) in
            integral.iter_mut().skip(1).zip(&padded).zip(padded.iter().skip(2)).zip(1..)
        {
            *target = (below - above) / f64::from(2 * n);
        }
        // T_N is -1 at all points.
        let mean = integral.get(N).copied();
        if let Some((first, mean)) = integral.first_mut().zip(mean) {
            *first = mean;
        }
        Interpolant(integral)
    }

    /// Conversion to powers of the variable of `table`.
    fn powers(&self, table: &[[f64; TERMS]; TERMS]) -> [f64; TERMS] {
        let mut powers = [0.0; TERMS];
        for (coefficient, row) in self.0.iter().zip(table) {
            powers.iter_mut().zip(row).for_each(|(sum, power)| *sum += coefficient * power);
        }
        powers
    }

    /// Coefficients of the powers of z.
    pub fn powers_from_middle(&self) -> Polynomial {
        rows(&self.powers(&AROUND_MIDDLE))
    }

    /// Coefficients of the powers of y = (1-z)/2.
    pub fn powers_from_end(&self) -> [f64; TERMS] {
        self.powers(&FROM_END)
    }

    /// Mean over (0, y), as a polynomial in y = (1-z)/2.
    pub fn mean_from_end(&self) -> Polynomial {
        let mut powers = self.powers_from_end();
        for (power, n) in powers.iter_mut().zip(1..) {
            *power /= n as f64;
        }
        rows(&powers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::polynomial::{sum, value_and_slope};
    use core::f64::consts::PI;

    fn check_tables<const M: usize>() {
        let tables = Points::<M>::COSINES.into_iter().zip(Points::<M>::SINES);
        for ((j, (cosines, sines)), z) in tables.enumerate().zip(Points::<M>::Z) {
            let theta = PI * (2 * j + 1) as f64 / (2 * M) as f64;
            for m in 0..M {
                // The arguments are rounded by up to 30 units of rounding.
                assert!((cosines[m] - (m as f64 * theta).cos()).abs() < 1e-14);
                assert!((sines[m] - theta.sin() * ((M - m) as f64 * theta).sin()).abs() < 1e-14);
            }
            assert_eq!(cosines[1], z);
            // T_2 = 2 T_1² - 1, up to the rounding of both sides.
            assert!((cosines[2] - (2.0 * z * z - 1.0)).abs() < 4e-16);
        }
    }

    #[test]
    fn tables_are_cosines_and_sines() {
        check_tables::<8>();
        check_tables::<10>();
    }

    fn through<const N: usize, const M: usize>(tangent: impl FnMut(f64) -> (f64, f64)) -> Interpolant<N> {
        Interpolant::through(&Points::<M>::Z.map(tangent).map(|(value, slope)| Tangent { value, slope }))
    }

    #[test]
    fn chebyshev_polynomials_are_reproduced() {
        for n in 0..20 {
            // T_n and its derivative at cos θ; the arguments are rounded, multiplied by up to n².
            let found = through::<20, 10>(|z| {
                let (theta, n) = (z.acos(), f64::from(n));
                ((n * theta).cos(), n * (n * theta).sin() / theta.sin())
            });
            for (k, coefficient) in found.0.iter().enumerate() {
                assert!((coefficient - if k == n as usize { 1.0 } else { 0.0 }).abs() < 1e-14, "{n} {k} {coefficient}");
            }
        }
    }

    #[test]
    fn the_exponential_is_interpolated_integrated_and_averaged() {
        let interpolant = through::<20, 10>(|z| (z.exp(), z.exp()));
        assert!(interpolant.is_converged(1e-15));
        for z in [-1.0, -0.3, 0.0, 0.77, 1.0_f64] {
            let integral = interpolant.integral().powers_from_middle();
            let (value, slope) = value_and_slope(&integral, z);
            let mean = Points::<10>::Z.iter().map(|z| value_and_slope(&integral, *z).0).sum::<f64>() / 10.0;
            assert!(mean.abs() < 1e-15);
            // A few units of rounding of e; the derivative multiplies twenty terms by up to nineteen.
            assert!((value - (z.exp() - interpolant.mean())).abs() < 2e-15, "{z}");
            assert!((slope - z.exp()).abs() < 8e-15, "{z} {slope}");
            let y: f64 = 0.5 * (1.0 - z);
            let mean = sum(interpolant.mean_from_end().iter().copied(), y);
            let exact = if y > 0.0 { 0.5 * (1f64.exp() - z.exp()) / y } else { 1f64.exp() };
            assert!((mean / exact - 1.0).abs() < 2e-15, "{z}");
        }
        assert!(!through::<20, 10>(|z| (z.abs(), z.signum())).is_converged(1e-15));
    }

    #[test]
    fn powers_in_sums_to_chebyshev_polynomials() {
        for (shift, scale) in [(0.0, 1.0), (-1.0, 2.0)] {
            for (n, row) in powers_in(shift, scale).iter().enumerate() {
                for z in [-1.0, -0.4, 0.3, 0.9_f64] {
                    let x = (z - shift) / scale;
                    let value = row.iter().rev().fold(0.0, |sum, power| sum * x + power);
                    // The rounding error scales as the sum of magnitudes, large for x outside -1 to 1.
                    let size = row.iter().rev().fold(0.0, |sum, power| sum * x.abs() + power.abs());
                    assert!((value - (n as f64 * z.acos()).cos()).abs() < 2e-14 + 4e-15 * size, "{n} {z}");
                }
            }
        }
    }
}
