//! Numbers over which the law is written: f64, and dual numbers, a value with derivatives.

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

/// A value and M derivatives.
#[derive(Debug, Clone, Copy)]
#[repr(align(32))]
pub(crate) struct Dual<const M: usize> {
    pub slopes: [f64; M],
    pub value: f64,
}

/// Each derivative from those of one or two numbers.
macro_rules! slopes {
    (|$k:ident| $slope:expr) => {{
        let mut slopes = [0.0; M];
        for $k in 0..M {
            slopes[$k] = $slope;
        }
        slopes
    }};
}

impl<const M: usize> Real for Dual<M> {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Dual { slopes: [0.0; M], value }
    }

    #[inline(always)]
    fn value(&self) -> f64 {
        self.value
    }

    #[inline(always)]
    fn scale(self, factor: f64) -> Self {
        Dual { slopes: slopes!(|k| self.slopes[k] * factor), value: self.value * factor }
    }

    #[inline(always)]
    fn chain(self, value: f64, slope: f64) -> Self {
        Dual { slopes: slopes!(|k| self.slopes[k] * slope), value }
    }

    #[inline(always)]
    fn add_scaled(&mut self, x: &Self, factor: f64) {
        for k in 0..M {
            self.slopes[k] += x.slopes[k] * factor;
        }
        self.value += x.value * factor;
    }
}

impl<const M: usize> Add for Dual<M> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Dual { slopes: slopes!(|k| self.slopes[k] + other.slopes[k]), value: self.value + other.value }
    }
}

impl<const M: usize> Sub for Dual<M> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Dual { slopes: slopes!(|k| self.slopes[k] - other.slopes[k]), value: self.value - other.value }
    }
}

impl<const M: usize> Mul for Dual<M> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let slopes = slopes!(|k| self.slopes[k] * other.value + self.value * other.slopes[k]);
        Dual { slopes, value: self.value * other.value }
    }
}

impl<const M: usize, const P: usize> Over<Dual<P>> for Dual<M> {
    #[inline(always)]
    fn minus(mut self, a: Dual<P>) -> Self {
        for k in 0..P.min(M) {
            self.slopes[k] -= a.slopes[k];
        }
        self.value -= a.value;
        self
    }

    #[inline(always)]
    fn times(self, a: Dual<P>) -> Self {
        let mut product = self.scale(a.value);
        for k in 0..P.min(M) {
            product.slopes[k] += self.value * a.slopes[k];
        }
        product
    }

    #[inline(always)]
    fn add_product(&mut self, x: &Self, a: Dual<P>) {
        self.add_scaled(x, a.value);
        for k in 0..P.min(M) {
            self.slopes[k] += x.value * a.slopes[k];
        }
    }
}
