//! Interpolation at Chebyshev points: a smooth function becomes a polynomial whose last coefficients tell its error.

use crate::series::{Rows, rows};

/// Points, and coefficients.
pub(crate) const POINTS: usize = 20;

/// A polynomial in rows of four coefficients.
pub(crate) type Polynomial = Rows<{ POINTS / 4 }>;

/// cos(π m/40) for whole m: by series on the first eighth of the circle, by symmetry elsewhere.
const fn cosine(m: usize) -> f64 {
    const QUARTER: usize = POINTS;
    let m = m % (4 * QUARTER);
    if m > 2 * QUARTER {
        return cosine(4 * QUARTER - m);
    }
    if m > QUARTER {
        return -cosine(2 * QUARTER - m);
    }
    let (from_axis, first) = if 2 * m <= QUARTER { (m, 0) } else { (QUARTER - m, 1) };
    let angle = core::f64::consts::FRAC_PI_2 * from_axis as f64 / QUARTER as f64;
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

/// The points on (-1, 1), falling.
pub(crate) static POINT: [f64; POINTS] = {
    let mut table = [0.0; POINTS];
    let mut j = 0;
    while j < POINTS {
        table[j] = cosine(2 * j + 1);
        j += 1;
    }
    table
};

/// T_n at point j, at `[j][n]`.
static AT_POINTS: [[f64; POINTS]; POINTS] = {
    let mut table = [[0.0; POINTS]; POINTS];
    let mut j = 0;
    while j < POINTS {
        let mut n = 0;
        while n < POINTS {
            table[j][n] = cosine(n * (2 * j + 1));
            n += 1;
        }
        j += 1;
    }
    table
};

/// Powers of z in T_n(shift + scale z), at `[n][power]`: whole numbers below 2⁵³.
const fn powers_in(shift: f64, scale: f64) -> [[f64; POINTS]; POINTS] {
    let mut table = [[0.0; POINTS]; POINTS];
    table[0][0] = 1.0;
    table[1][0] = shift;
    table[1][1] = scale;
    let mut n = 2;
    while n < POINTS {
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
static AROUND_MIDDLE: [[f64; POINTS]; POINTS] = powers_in(0.0, 1.0);
/// Powers of (1+z)/2, from 0 to 1.
static FROM_END: [[f64; POINTS]; POINTS] = powers_in(-1.0, 2.0);

/// A function by its coefficients of T_0, T_1, ...
#[derive(Debug, Clone, Copy)]
pub(crate) struct Interpolant([f64; POINTS]);

impl Interpolant {
    /// Through a function's values at the points.
    pub fn through(value: impl FnMut(f64) -> f64) -> Interpolant {
        let mut coefficients = [0.0; POINTS];
        for (value, at_point) in POINT.map(value).iter().zip(&AT_POINTS) {
            coefficients.iter_mut().zip(at_point).for_each(|(sum, t)| *sum += value * t);
        }
        coefficients.iter_mut().for_each(|sum| *sum *= 2.0 / POINTS as f64);
        if let Some(first) = coefficients.first_mut() {
            *first *= 0.5;
        }
        Interpolant(coefficients)
    }

    /// Whether the last two coefficients are rounding.
    pub fn is_resolved(&self) -> bool {
        let &[first, .., last_but_one, last] = &self.0;
        last_but_one.abs().max(last.abs()) <= 1e-15 * first.abs()
    }

    /// Coefficients of the powers of z from those of the first `used` Chebyshev polynomials.
    fn powers(&self, table: &[[f64; POINTS]; POINTS], used: usize) -> [f64; POINTS] {
        let mut powers = [0.0; POINTS];
        for (coefficient, row) in self.0.iter().zip(table).take(used) {
            powers.iter_mut().zip(row).for_each(|(sum, power)| *sum += coefficient * power);
        }
        powers
    }

    /// The integral over z from the middle of (-1, 1), as a polynomial in z. There is no room for what the last coefficient
    /// would add.
    pub fn integral(&self) -> Polynomial {
        let powers = self.powers(&AROUND_MIDDLE, POINTS - 1);
        let mut integral = [0.0; POINTS];
        for ((place, power), n) in integral.iter_mut().skip(1).zip(powers).zip(1..) {
            *place = power / n as f64;
        }
        rows(&integral)
    }

    /// As a polynomial in y = (1+z)/2.
    pub fn powers_from_end(&self) -> [f64; POINTS] {
        self.powers(&FROM_END, POINTS)
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
    use crate::series::{sum, value_and_slope};

    #[test]
    fn points_and_values_are_cosines() {
        for (j, row) in AT_POINTS.iter().enumerate() {
            for (n, value) in row.iter().enumerate() {
                let exact = (core::f64::consts::PI * (n * (2 * j + 1)) as f64 / (2 * POINTS) as f64).cos();
                // The argument here is rounded, by up to 60 times a unit of rounding.
                assert!((value - exact).abs() < 2e-14);
            }
            // T_2 = 2 T_1² - 1, to the rounding of either.
            assert!((row[2] - (2.0 * row[1] * row[1] - 1.0)).abs() < 4e-16);
        }
    }

    #[test]
    fn an_exponential_is_resolved_integrated_and_averaged() {
        let interpolant = Interpolant::through(f64::exp);
        assert!(interpolant.is_resolved());
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
        assert!(!Interpolant::through(f64::abs).is_resolved());
    }
}
