//! Numbers over which the law is written: f64, dual numbers, which are a value with derivatives, and derivatives of known values.

use crate::simd::plus;
use core::ops::{Add, Mul, Sub};

/// An array of the values of an expression for 0 and 1. In kernels, in place of `map`: closures would be compiled for the baseline.
macro_rules! both {
    (|$k:pat_param| $value:expr) => {
        [
            {
                let $k = 0;
                $value
            },
            {
                let $k = 1;
                $value
            },
        ]
    };
}

pub(crate) use both;

/// A number of the law.
pub(crate) trait Linear: Copy + Add<Output = Self> + Sub<Output = Self> {
    /// Whether it has derivatives.
    const DERIVED: bool;
    fn constant(value: f64) -> Self;
    /// The value; 0 if it is known elsewhere.
    fn value(&self) -> f64;
    fn scale(self, factor: f64) -> Self;
    /// A function of the number, from its value and its derivative.
    fn chain(self, value: f64, slope: f64) -> Self;

    /// `self += x factor`
    fn add_scaled(&mut self, x: &Self, factor: f64);
}

/// A number that has its value. Guards and choices depend on the value only.
pub(crate) trait Real: Linear + Mul<Output = Self> {
    /// The number, or another one that is larger: guards divisors, as the compiler may divide before it compares.
    #[inline(always)]
    fn at_least(self, least: f64) -> Self {
        if self.value() > least { self } else { Self::constant(least) }
    }

    /// 1/x of a number that is not 0.
    #[inline(always)]
    fn inverse(self) -> Self {
        let value = 1.0 / self.value();
        self.chain(value, -value * value)
    }

    /// The root of a number > 0.
    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value().sqrt();
        self.chain(root, 0.5 / root)
    }
}

/// Numbers that those of a contact scale.
pub(crate) trait Over<A>: Linear {
    fn minus(self, a: A) -> Self;
    fn times(self, a: A) -> Self;

    /// The product of two numbers, of which these are the values.
    fn product(self, other: Self, values: [f64; 2]) -> Self;

    /// `self += x a`
    #[inline(always)]
    fn add_product(&mut self, x: &Self, a: A) {
        *self = *self + x.times(a);
    }
}

impl<A: Real> Over<A> for A {
    #[inline(always)]
    fn minus(self, a: A) -> A {
        self - a
    }

    #[inline(always)]
    fn times(self, a: A) -> A {
        self * a
    }

    #[inline(always)]
    fn product(self, other: A, _: [f64; 2]) -> A {
        self * other
    }
}

impl Linear for f64 {
    const DERIVED: bool = false;

    #[inline(always)]
    fn constant(value: f64) -> f64 {
        value
    }

    #[inline(always)]
    fn value(&self) -> f64 {
        *self
    }

    #[inline(always)]
    fn scale(self, factor: f64) -> f64 {
        self * factor
    }

    #[inline(always)]
    fn chain(self, value: f64, _: f64) -> f64 {
        value
    }

    #[inline(always)]
    fn add_scaled(&mut self, x: &f64, factor: f64) {
        *self += x * factor;
    }
}

impl Real for f64 {}

/// Derivatives in blocks of four lanes, which the compiler makes vectors of. The last lane of a single block is the value; several blocks
/// have none.
#[derive(Debug, Clone, Copy)]
#[repr(align(32))]
pub(crate) struct Dual<const B: usize>(pub [[f64; 4]; B]);

/// The lane of a value.
const VALUE: usize = 3;

impl<const B: usize> Dual<B> {
    #[inline(always)]
    fn with_value(mut self, value: f64) -> Self {
        if B == 1 {
            self.0[0][VALUE] = value;
        }
        self
    }
}

impl<const B: usize> Linear for Dual<B> {
    const DERIVED: bool = true;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        Dual([[0.0; 4]; B]).with_value(value)
    }

    #[inline(always)]
    fn value(&self) -> f64 {
        if B == 1 { self.0[0][VALUE] } else { 0.0 }
    }

    #[inline(always)]
    fn scale(mut self, factor: f64) -> Self {
        for b in 0..B {
            let [x, y, z, w] = self.0[b];
            self.0[b] = [x * factor, y * factor, z * factor, w * factor];
        }
        self
    }

    #[inline(always)]
    fn chain(self, value: f64, slope: f64) -> Self {
        self.scale(slope).with_value(value)
    }

    #[inline(always)]
    fn add_scaled(&mut self, x: &Self, factor: f64) {
        for b in 0..B {
            self.0[b] = plus(self.0[b], factor, x.0[b]);
        }
    }
}

impl Real for Dual<1> {}

/// Derivatives of known values by what a contact does not depend on.
impl<const B: usize> Over<f64> for Dual<B> {
    #[inline(always)]
    fn minus(self, _: f64) -> Self {
        self
    }

    #[inline(always)]
    fn times(self, a: f64) -> Self {
        self.scale(a)
    }

    #[inline(always)]
    fn product(self, other: Self, [value, other_value]: [f64; 2]) -> Self {
        let mut product = self.scale(other_value);
        product.add_scaled(&other, value);
        product
    }
}

impl<const B: usize> Add for Dual<B> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, other: Self) -> Self {
        for b in 0..B {
            let ([x, y, z, w], [p, q, r, s]) = (self.0[b], other.0[b]);
            self.0[b] = [x + p, y + q, z + r, w + s];
        }
        self
    }
}

impl<const B: usize> Sub for Dual<B> {
    type Output = Self;
    #[inline(always)]
    fn sub(mut self, other: Self) -> Self {
        for b in 0..B {
            let ([x, y, z, w], [p, q, r, s]) = (self.0[b], other.0[b]);
            self.0[b] = [x - p, y - q, z - r, w - s];
        }
        self
    }
}

impl Mul for Dual<1> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let mut product = self.scale(other.value());
        product.add_scaled(&other.with_value(0.0), self.value());
        product
    }
}
