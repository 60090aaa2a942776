//! Interpolation at Chebyshev points: a smooth function becomes a polynomial whose last coefficients tell its error.

use crate::numerics::polynomial::{Rows, rows};

/// Coefficients that a polynomial has, and points of interpolation at most.
pub(crate) const TERMS: usize = 20;

/// A polynomial in rows of four coefficients.
pub(crate) type Polynomial = Rows<{ TERMS / 4 }>;

/// cos(m π/2/quarter) for whole m: by series on the first eighth of the circle, by symmetry elsewhere.
const fn cosine(m: usize, quarter: usize) -> f64 {
    let m = m % (4 * quarter);
    if m > 2 * quarter {
        return cosine(4 * quarter - m, quarter);
    }
    if m > quarter {
        return -cosine(2 * quarter - m, quarter);
    }
    let (from_axis, first) = if 2 * m <= quarter { (m, 0) } else { (quarter - m, 1) };
    let angle = core::f64::consts::FRAC_PI_2 * from_axis as f64 / quarter as f64;
    // Σ (-1)ⁿ x²ⁿ⁺ᶠ/(2n+f)!, f = 0 the cosine, f = 1 the sine.
    let mut sum = 0.0;
    let mut n = 10;
    while n > 0 {
        n -= 1;
        let next = (2 * n + 1 + first) as f64 * (2 * n + 2 + first) as f64;
        sum = 1.0 - angle * angle / next * sum;
    }
    if first == 0 { sum } else { angle * sum }
}

/// Powers of z in T_n(shift + scale z), at `[n][power]`: whole numbers below 2⁵³.
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

/// Powers of z on (-1, 1).
static AROUND_MIDDLE: [[f64; TERMS]; TERMS] = powers_in(0.0, 1.0);
/// Powers of (1+z)/2, from 0 to 1.
static FROM_END: [[f64; TERMS]; TERMS] = powers_in(-1.0, 2.0);

/// A function by its coefficients of T_0, T_1, ...
#[derive(Debug, Clone, Copy)]
pub(crate) struct Interpolant<const N: usize>([f64; N]);

impl<const N: usize> Interpolant<N> {
    /// The points on (-1, 1), falling.
    pub const POINTS: [f64; N] = {
        let mut table = [0.0; N];
        let mut j = 0;
        while j < N {
            table[j] = cosine(2 * j + 1, N);
            j += 1;
        }
        table
    };

    /// T_n at point j, at `[j][n]`.
    const AT_POINTS: [[f64; N]; N] = {
        let mut table = [[0.0; N]; N];
        let mut j = 0;
        while j < N {
            let mut n = 0;
            while n < N {
                table[j][n] = cosine(n * (2 * j + 1), N);
                n += 1;
            }
            j += 1;
        }
        table
    };

    /// Through a function's values at the points.
    pub fn through(value: impl FnMut(f64) -> f64) -> Interpolant<N> {
        let mut coefficients = [0.0; N];
        for (value, at_point) in Self::POINTS.map(value).iter().zip(const { &Self::AT_POINTS }) {
            coefficients.iter_mut().zip(at_point).for_each(|(sum, t)| *sum += value * t);
        }
        coefficients.iter_mut().for_each(|sum| *sum *= 2.0 / N as f64);
        if let Some(first) = coefficients.first_mut() {
            *first *= 0.5;
        }
        Interpolant(coefficients)
    }

    /// Whether the last two coefficients are as small as is asked for.
    pub fn is_converged(&self, tolerance: f64) -> bool {
        let &[.., last_but_one, last] = self.0.as_slice() else { return false };
        last_but_one.abs().max(last.abs()) <= tolerance
    }

    /// The coefficient of T_0: the mean over the points.
    pub fn mean(&self) -> f64 {
        self.0.first().copied().unwrap_or(0.0)
    }

    /// Coefficients of the powers of z from those of the first `used` Chebyshev polynomials.
    fn powers(&self, table: &[[f64; TERMS]; TERMS], used: usize) -> [f64; TERMS] {
        let mut powers = [0.0; TERMS];
        for (coefficient, row) in self.0.iter().zip(table).take(used) {
            powers.iter_mut().zip(row).for_each(|(sum, power)| *sum += coefficient * power);
        }
        powers
    }

    /// The integral over z from the middle of (-1, 1), as a polynomial in z. There is no room for what the twentieth
    /// coefficient would add.
    pub fn integral(&self) -> Polynomial {
        let powers = self.powers(&AROUND_MIDDLE, TERMS - 1);
        let mut integral = [0.0; TERMS];
        for ((place, power), n) in integral.iter_mut().skip(1).zip(powers).zip(1..) {
            *place = power / n as f64;
        }
        rows(&integral)
    }

    /// As a polynomial in y = (1+z)/2.
    pub fn powers_from_end(&self) -> [f64; TERMS] {
        self.powers(&FROM_END, TERMS)
    }

    /// The mean over (0, y), as a polynomial in y = (1+z)/2.
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

    fn values_are_cosines<const N: usize>() {
        for (j, row) in Interpolant::<N>::AT_POINTS.iter().enumerate() {
            for (n, value) in row.iter().enumerate() {
                let exact = (core::f64::consts::PI * (n * (2 * j + 1)) as f64 / (2 * N) as f64).cos();
                // The argument here is rounded, by up to 60 times a unit of rounding.
                assert!((value - exact).abs() < 2e-14);
            }
            // T_2 = 2 T_1² - 1, to the rounding of either.
            assert!((row[2] - (2.0 * row[1] * row[1] - 1.0)).abs() < 4e-16);
        }
    }

    #[test]
    fn points_and_values_are_cosines() {
        values_are_cosines::<16>();
        values_are_cosines::<20>();
    }

    #[test]
    fn an_exponential_is_resolved_integrated_and_averaged() {
        let interpolant = Interpolant::<20>::through(f64::exp);
        assert!(interpolant.is_converged(1e-15));
        for z in [-1.0, -0.3, 0.0, 0.77, 1.0_f64] {
            let (integral, slope) = value_and_slope(&interpolant.integral(), z);
            // A few units of rounding of e; the derivative weighs twenty terms by up to nineteen.
            assert!((integral - (z.exp() - 1.0)).abs() < 2e-15, "{z}");
            assert!((slope - z.exp()).abs() < 8e-15, "{z} {slope}");
            let y: f64 = 0.5 * (1.0 + z);
            let mean = sum(interpolant.mean_from_end().iter().copied(), y);
            let exact = if y > 0.0 { 0.5 * (z.exp() - (-1f64).exp()) / y } else { (-1f64).exp() };
            assert!((mean / exact - 1.0).abs() < 2e-15, "{z}");
        }
        assert!(!Interpolant::<20>::through(f64::abs).is_converged(1e-15));
    }

    #[test]
    fn cosines_go_round_the_circle() {
        for quarter in [1, 3, 16, 20] {
            for m in 0..=9 * quarter {
                let exact = (core::f64::consts::FRAC_PI_2 * m as f64 / quarter as f64).cos();
                // The argument of the exact one is rounded, at up to two turns and a quarter.
                assert!((cosine(m, quarter) - exact).abs() < 3e-15, "{m} {quarter}");
            }
        }
    }

    #[test]
    fn powers_make_chebyshev_polynomials() {
        for (shift, scale) in [(0.0, 1.0), (-1.0, 2.0)] {
            for (n, row) in powers_in(shift, scale).iter().enumerate() {
                for z in [-1.0, -0.4, 0.3, 0.9_f64] {
                    let x = (z - shift) / scale;
                    let value = row.iter().rev().fold(0.0, |sum, power| sum * x + power);
                    // The powers' coefficients grow with the polynomial's value outside of -1 to 1.
                    let size = row.iter().rev().fold(0.0, |sum, power| sum * x.abs() + power.abs());
                    assert!((value - (n as f64 * z.acos()).cos()).abs() < 2e-14 + 4e-15 * size, "{n} {z}");
                }
            }
        }
    }
}
