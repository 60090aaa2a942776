//! Kernels: the compliance of a flat punch as a function of its half-width s, except for a factor and a constant, which all punches
//! of a shape have in common.

use crate::numerics::guard::{TINY, quotient};

/// The kernel of a shape.
pub(crate) enum Kernel {
    /// ln(1/s).
    Line,
    /// 1/s.
    Point,
}

impl Kernel {
    /// The value, given 1/s.
    pub fn value(self, reciprocal: f64) -> f64 {
        match self {
            Kernel::Line => reciprocal.ln(),
            Kernel::Point => reciprocal,
        }
    }

    /// The relative growth ds/s over the decrease of the kernel that it causes, and the power of s with which this ratio grows.
    pub fn reach(self, half_width: f64) -> (f64, f64) {
        match self {
            Kernel::Line => (1.0, 0.0),
            Kernel::Point => (half_width, 1.0),
        }
    }

    /// The increase of the kernel from s = 1 down to s, given s and 1 - s².
    pub fn increase(self, half_width: f64, square_difference: f64) -> f64 {
        let square = half_width * half_width;
        match self {
            Kernel::Line if square < 0.5 => -0.5 * square.max(TINY).ln(),
            Kernel::Line => -0.5 * (-square_difference).max(-0.5).ln_1p(),
            Kernel::Point => quotient(1.0, half_width) - 1.0,
        }
    }

    /// 1 - s² at a given increase of the kernel: the inverse of `increase`.
    pub fn square_difference(self, increase: f64) -> f64 {
        match self {
            Kernel::Line => -(-2.0 * increase).exp_m1(),
            Kernel::Point => {
                // Infinite for s = 0.
                let increase = increase.min(1.0 / TINY);
                let consumed = increase / (1.0 + increase);
                consumed * (2.0 - consumed)
            }
        }
    }
}
