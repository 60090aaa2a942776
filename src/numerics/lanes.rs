//! Several numbers that are computed together in one vector register of the processor, or in more than one.
//!
//! Operators act lane by lane, in the order in which they are written. Nothing is fused: each lane has the bits of the
//! same formula for one number.

use core::ops::{Add, AddAssign, Deref, DerefMut, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// L numbers.
#[repr(transparent)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lanes<const L: usize>(pub [f64; L]);

impl<const L: usize> Lanes<L> {
    pub const ZERO: Self = Lanes([0.0; L]);

    #[inline(always)]
    pub fn map(self, function: impl Fn(f64) -> f64) -> Self {
        let mut values = self.0;
        for value in &mut values {
            *value = function(*value);
        }
        Lanes(values)
    }

    /// Adds to the first lanes.
    #[inline(always)]
    pub fn add_first<const M: usize>(&mut self, other: Lanes<M>) {
        for (value, other) in self.0.iter_mut().zip(other.0) {
            *value += other;
        }
    }

    #[inline(always)]
    pub fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }

    #[inline(always)]
    pub fn max(self, least: f64) -> Self {
        self.map(|value| value.max(least))
    }
}

impl Lanes<4> {
    /// The sum of all lanes.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        let [a, b, c, d] = self.0;
        (a + c) + (b + d)
    }
}

impl<const L: usize> Default for Lanes<L> {
    #[inline(always)]
    fn default() -> Self {
        Self::ZERO
    }
}

impl<const L: usize> Deref for Lanes<L> {
    type Target = [f64; L];
    #[inline(always)]
    fn deref(&self) -> &[f64; L] {
        &self.0
    }
}

impl<const L: usize> DerefMut for Lanes<L> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64; L] {
        &mut self.0
    }
}

macro_rules! operator {
    ($($trait:ident $name:ident, $in_place:ident $name_in_place:ident $operator:tt;)*) => { $(
        impl<const L: usize> $trait for Lanes<L> {
            type Output = Self;
            fn $name(self, other: Self) -> Self {
                let mut values = self.0;
                for k in 0..L {
                    values[k] $operator other.0[k];
                }
                Lanes(values)
            }
        }
        impl<const L: usize> $trait<f64> for Lanes<L> {
            type Output = Self;
            fn $name(self, other: f64) -> Self {
                self.$name(Lanes([other; L]))
            }
        }
        impl<const L: usize> $trait<Lanes<L>> for f64 {
            type Output = Lanes<L>;
            fn $name(self, other: Lanes<L>) -> Lanes<L> {
                Lanes([self; L]).$name(other)
            }
        }
        impl<const L: usize> $in_place for Lanes<L> {
            #[inline(always)]
            fn $name_in_place(&mut self, other: Self) {
                *self = (*self).$name(other);
            }
        }
    )* };
}
operator! {
    Add add, AddAssign add_assign +=;
    Sub sub, SubAssign sub_assign -=;
    Mul mul, MulAssign mul_assign *=;
    Div div, DivAssign div_assign /=;
}

impl<const L: usize> Neg for Lanes<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::ZERO - self
    }
}
