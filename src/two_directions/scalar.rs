//! Numbers over which the law is written: f64, and dual numbers, a value with derivatives.

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

/// A number of the law. Guards and choices depend on the value only.
pub(crate) trait Real: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// Whether it has derivatives.
    const DERIVED: bool;
    fn constant(value: f64) -> Self;
    fn value(&self) -> f64;
    fn scale(self, factor: f64) -> Self;
    /// A function of the number, from its value and its derivative.
    fn chain(self, value: f64, slope: f64) -> Self;

    /// `self += x factor`
    fn add_scaled(&mut self, x: &Self, factor: f64);

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

/// Numbers that those of a contact scale: the latter have the first of their derivatives only.
pub(crate) trait Over<A>: Real {
    fn minus(self, a: A) -> Self;
    fn times(self, a: A) -> Self;

    /// `self += x a`
    fn add_product(&mut self, x: &Self, a: A);
}

impl Real for f64 {
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

impl Over<f64> for f64 {
    #[inline(always)]
    fn minus(self, a: f64) -> f64 {
        self - a
    }

    #[inline(always)]
    fn times(self, a: f64) -> f64 {
        self * a
    }

    #[inline(always)]
    fn add_product(&mut self, x: &f64, a: f64) {
        *self += x * a;
    }
}

/// Derivatives and, in the last lane of the first block, a value: blocks of four lanes are what the compiler makes vectors of.
#[derive(Debug, Clone, Copy)]
#[repr(align(32))]
pub(crate) struct Dual<const B: usize>(pub [[f64; 4]; B]);

/// The lane of a value.
const VALUE: usize = 3;

impl<const B: usize> Dual<B> {
    #[inline(always)]
    fn with_value(mut self, value: f64) -> Self {
        self.0[0][VALUE] = value;
        self
    }

    /// Adds the derivatives of a number of a contact, times a factor.
    #[inline(always)]
    fn plus_slopes(mut self, factor: f64, Dual([[x, y, z, _]]): Dual<1>) -> Self {
        self.0[0] = plus(self.0[0], factor, [x, y, z, 0.0]);
        self
    }
}

impl<const B: usize> Real for Dual<B> {
    const DERIVED: bool = true;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        Dual([[0.0; 4]; B]).with_value(value)
    }

    #[inline(always)]
    fn value(&self) -> f64 {
        self.0[0][VALUE]
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

impl<const B: usize> Mul for Dual<B> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let (value, mut product) = (self.value(), self.scale(other.value()));
        product.add_scaled(&other, value);
        product.with_value(value * other.value())
    }
}

/// The numbers of a contact have one block.
impl<const B: usize> Over<Dual<1>> for Dual<B> {
    #[inline(always)]
    fn minus(mut self, a: Dual<1>) -> Self {
        let ([x, y, z, w], [p, q, r, s]) = (self.0[0], a.0[0]);
        self.0[0] = [x - p, y - q, z - r, w - s];
        self
    }

    #[inline(always)]
    fn times(self, a: Dual<1>) -> Self {
        self.scale(a.value()).plus_slopes(self.value(), a)
    }

    #[inline(always)]
    fn add_product(&mut self, x: &Self, a: Dual<1>) {
        *self = *self + x.times(a);
    }
}
