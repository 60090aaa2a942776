//! `rug::Float` with operators that keep the larger precision of both operands.

use rug::Float;
use rug::float::Constant;
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

#[derive(Debug, Clone, PartialEq, PartialOrd)]
pub struct Real(Float);

macro_rules! unary {
    ($($name:ident)*) => { $(pub fn $name(&self) -> Real { Real(self.0.clone().$name()) })* };
}

impl Real {
    pub fn new(bits: u32, value: f64) -> Real {
        Real(Float::with_val(bits, value))
    }

    pub fn parse(bits: u32, text: &str) -> Real {
        Real(Float::with_val(bits, Float::parse(text).unwrap_or_else(|error| panic!("{text}: {error}"))))
    }

    pub fn pi(bits: u32) -> Real {
        Real(Float::with_val(bits, Constant::Pi))
    }

    pub fn bits(&self) -> u32 {
        self.0.prec()
    }

    /// Rounded to another precision.
    pub fn at(&self, bits: u32) -> Real {
        Real(Float::with_val(bits, &self.0))
    }

    pub fn f64(&self) -> f64 {
        self.0.to_f64()
    }

    /// The least exponent of 2 above the absolute value; very small for 0.
    pub fn exponent(&self) -> i32 {
        self.0.get_exp().unwrap_or(i32::MIN / 8)
    }

    pub fn is_zero(&self) -> bool {
        self.0.is_zero()
    }

    pub fn is_finite(&self) -> bool {
        self.0.is_finite()
    }

    pub fn is_positive(&self) -> bool {
        self.0.cmp0() == Some(Ordering::Greater)
    }

    unary!(sqrt cbrt abs ln ln_1p exp acosh square);

    pub fn atan2(&self, x: &Real) -> Real {
        Real(self.0.clone().atan2(&x.0))
    }

    pub fn sin_cos(&self) -> (Real, Real) {
        let (sine, cosine) = self.0.clone().sin_cos(Float::new(self.bits()));
        (Real(sine), Real(cosine))
    }

    pub fn max(self, other: &Real) -> Real {
        if self < *other { other.clone() } else { self }
    }

    pub fn min(self, other: &Real) -> Real {
        if self > *other { other.clone() } else { self }
    }
}

macro_rules! implement {
    ($trait:ident, $method:ident, $left:ty, $right:ty, |$a:ident, $b:ident| $result:expr) => {
        impl $trait<$right> for $left {
            type Output = Real;
            fn $method(self, $b: $right) -> Real {
                let $a = self;
                $result
            }
        }
    };
}

macro_rules! operator {
    ($trait:ident, $method:ident, $of:tt) => {
        implement!($trait, $method, &Real, &Real, |a, b| Real(Float::with_val(a.bits().max(b.bits()), &a.0 $of &b.0)));
        implement!($trait, $method, &Real, Real, |a, b| a $of &b);
        implement!($trait, $method, Real, &Real, |a, b| if a.bits() < b.bits() { &a $of b } else { Real(a.0 $of &b.0) });
        implement!($trait, $method, Real, Real, |a, b| a $of &b);
        implement!($trait, $method, &Real, f64, |a, b| Real(Float::with_val(a.bits(), &a.0 $of b)));
        implement!($trait, $method, Real, f64, |a, b| Real(a.0 $of b));
        implement!($trait, $method, f64, &Real, |a, b| Real(Float::with_val(b.bits(), a $of &b.0)));
        implement!($trait, $method, f64, Real, |a, b| Real(a $of b.0));
    };
}

operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

impl Neg for Real {
    type Output = Real;
    fn neg(self) -> Real {
        Real(-self.0)
    }
}

impl Neg for &Real {
    type Output = Real;
    fn neg(self) -> Real {
        -self.clone()
    }
}
