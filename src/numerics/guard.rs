//! Quotients without division by zero, and square roots without negative arguments.
//!
//! A compiler may divide first and select afterwards: `if b > 0 { a / b } else { 0 }` may compute a/0, which sets a
//! floating-point flag on which the application may trap. Choosing the divisor by a comparison of its own does not
//! help, because the compiler joins the two comparisons. So divisors and square roots take the maximum of their
//! argument and a bound, which no optimisation removes.
//!
//! A compiler may also place a quotient in a vector register next to unrelated numbers and divide by these as well.
//! Therefore a formula with several quotients multiplies by one reciprocal, or divides four numbers at once, or is in a
//! function that is never inlined.

use super::lanes::Lanes;
use core::ops::Div;

/// Lower bound of a divisor or of the argument of a logarithm whose result is not used.
pub(crate) const TINY: f64 = 1e-300;

/// One number, or several in lanes.
pub(crate) trait Guarded: Copy + Div<Output = Self> {
    /// The number, or the limit if that is larger or the number is NaN.
    fn at_least(self, least: f64) -> Self;
    fn sqrt(self) -> Self;
}

impl Guarded for f64 {
    #[inline(always)]
    fn at_least(self, least: f64) -> f64 {
        self.max(least)
    }

    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }
}

impl<const L: usize> Guarded for Lanes<L> {
    #[inline(always)]
    fn at_least(self, least: f64) -> Self {
        self.max(least)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Lanes::sqrt(self)
    }
}

/// A quotient by a divisor >= 0, which is limited below by `TINY`. Where the divisor may be 0, the numerator is not NaN and its
/// size at most 1e8.
#[inline(always)]
pub(crate) fn quotient<A: Div<X, Output = X>, X: Guarded>(numerator: A, divisor: X) -> X {
    numerator / divisor.at_least(TINY)
}

/// The square root of a number >= 0, or below 0 by rounding errors.
#[inline(always)]
pub(crate) fn root<X: Guarded>(x: X) -> X {
    x.at_least(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::hint::black_box;

    #[allow(unsafe_code)]
    unsafe extern "C" {
        safe fn feclearexcept(flags: i32) -> i32;
        safe fn fetestexcept(flags: i32) -> i32;
    }

    /// Invalid operation, division by zero, overflow.
    const TRAPS: i32 = if cfg!(target_arch = "x86_64") { 1 | 4 | 8 } else { 1 | 2 | 4 };

    /// The results, and whether an exception was raised that a program may trap. A quotient that a comparison of its
    /// own divisor discards is computed all the same.
    fn compute(numbers: [f64; 4]) -> ([[f64; 4]; 3], bool) {
        feclearexcept(TRAPS);
        let numbers = black_box(numbers);
        let discarded = numbers.map(|b| if b > 0.0 { quotient(b, b) } else { 0.0 });
        let found = black_box([*quotient(Lanes([1.0; 4]), Lanes(numbers)), *root(Lanes(numbers)), discarded]);
        (found, fetestexcept(TRAPS) != 0)
    }

    #[test]
    #[cfg_attr(miri, ignore = "floating-point flags")]
    fn quotients_and_roots_raise_no_exception() {
        let (found, raised) = compute([0.0, -1e-20, 4.0, 1e-310]);
        let (most, small) = (1.0 / TINY, 1e-310_f64);
        let expected = [[most, most, 0.25, most], [0.0, 0.0, 2.0, small.sqrt()], [0.0, 0.0, 1.0, small / TINY]];
        assert_eq!(found, expected);
        assert!(!raised);
    }
}
