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

    pub fn is_positive(&self) -> bool {
        self.0.cmp0() == Some(Ordering::Greater)
    }

    unary!(sqrt cbrt abs ln exp atan acosh square);

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

macro_rules! operator {
    ($trait:ident, $method:ident, $symbol:tt) => {
        impl $trait<&Real> for &Real {
            type Output = Real;
            fn $method(self, other: &Real) -> Real {
                Real(Float::with_val(self.bits().max(other.bits()), &self.0 $symbol &other.0))
            }
        }
        impl $trait<Real> for &Real {
            type Output = Real;
            fn $method(self, other: Real) -> Real {
                self $symbol &other
            }
        }
        impl $trait<&Real> for Real {
            type Output = Real;
            fn $method(self, other: &Real) -> Real {
                if self.bits() >= other.bits() { Real(self.0 $symbol &other.0) } else { &self $symbol other }
            }
        }
        impl $trait<Real> for Real {
            type Output = Real;
            fn $method(self, other: Real) -> Real {
                self $symbol &other
            }
        }
        impl $trait<f64> for Real {
            type Output = Real;
            fn $method(self, other: f64) -> Real {
                Real(self.0 $symbol other)
            }
        }
        impl $trait<f64> for &Real {
            type Output = Real;
            fn $method(self, other: f64) -> Real {
                Real(Float::with_val(self.bits(), &self.0 $symbol other))
            }
        }
        impl $trait<Real> for f64 {
            type Output = Real;
            fn $method(self, other: Real) -> Real {
                Real(self $symbol other.0)
            }
        }
        impl $trait<&Real> for f64 {
            type Output = Real;
            fn $method(self, other: &Real) -> Real {
                Real(Float::with_val(other.bits(), self $symbol &other.0))
            }
        }
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
