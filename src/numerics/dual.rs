//! Numbers with derivatives: a formula that is written for any number gives its values, and its derivatives in many
//! directions at once.

use super::guard::{TINY, quotient, root};
use super::lanes::Lanes;
use core::ops::{Add, Mul, Sub};

/// A number, with or without derivatives.
pub(crate) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Mul<f64, Output = Self>
{
    fn constant(value: f64) -> Self;
    fn value(self) -> f64;
    /// a/b for b >= 0, see [`quotient`].
    fn quotient(self, divisor: Self) -> Self;
    /// √x for x >= 0 but for rounding errors, see [`root`].
    fn root(self) -> Self;

    /// The larger of both, the first one if they are equal.
    fn max(self, other: Self) -> Self {
        if other.value() > self.value() { other } else { self }
    }

    /// The smaller of both, the first one if they are equal.
    fn min(self, other: Self) -> Self {
        if other.value() < self.value() { other } else { self }
    }

    /// The number between 0 and 1; the nearer of both beyond, where derivatives are 0.
    fn clamp_to_unit(self) -> Self {
        let value = self.value();
        if value > 0.0 && value < 1.0 { self } else { Self::constant(if value > 0.0 { 1.0 } else { 0.0 }) }
    }
}

impl Number for f64 {
    fn constant(value: f64) -> f64 {
        value
    }

    fn value(self) -> f64 {
        self
    }

    fn quotient(self, divisor: f64) -> f64 {
        quotient(self, divisor)
    }

    fn root(self) -> f64 {
        root(self)
    }
}

/// A number and its derivatives in L directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Dual<const L: usize> {
    pub value: f64,
    pub slopes: Lanes<L>,
}

impl<const L: usize> Number for Dual<L> {
    fn constant(value: f64) -> Self {
        Dual { value, slopes: Lanes::ZERO }
    }

    fn value(self) -> f64 {
        self.value
    }

    fn quotient(self, divisor: Self) -> Self {
        let per_divisor = reciprocal(divisor.value);
        let value = self.value * per_divisor;
        Dual { value, slopes: per_divisor * (self.slopes - value * divisor.slopes) }
    }

    fn root(self) -> Self {
        let per_root = reciprocal_root(self.value);
        let by_value = if self.value > 0.0 { 0.5 * per_root } else { 0.0 };
        Dual { value: self.value.max(0.0) * per_root, slopes: by_value * self.slopes }
    }
}

/// 1/x for x >= 0. Not inlined, as [`reciprocal_root`], see `numerics/guard.rs`.
#[inline(never)]
fn reciprocal(x: f64) -> f64 {
    quotient(1.0, x)
}

#[inline(never)]
fn reciprocal_root(x: f64) -> f64 {
    1.0 / x.max(TINY).sqrt()
}

impl<const L: usize> Add for Dual<L> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Dual { value: self.value + other.value, slopes: self.slopes + other.slopes }
    }
}

impl<const L: usize> Sub for Dual<L> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Dual { value: self.value - other.value, slopes: self.slopes - other.slopes }
    }
}

impl<const L: usize> Mul for Dual<L> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Dual { value: self.value * other.value, slopes: self.value * other.slopes + other.value * self.slopes }
    }
}

impl<const L: usize> Mul<f64> for Dual<L> {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Dual { value: self.value * factor, slopes: self.slopes * factor }
    }
}
