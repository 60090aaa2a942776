//! A size of a shape, and what follows from the formulas of the shape for each size.
//!
//! A size is given by its leg, which is 0 for the smallest size, and by the half-width a of the flat: `s = sqrt(a² + leg²)`. The
//! load g follows from ψ, and the means of the load and of its square over the compliance Λ from both:
//!
//! ```text
//! dg = 4 leg ψ d leg,       β = -(1/g) ∫ g dΛ,       γ = -(1/g²) ∫ g² dΛ       from leg = 0 on.
//! ```
//!
//! Each shape has closed forms for ψ, g, β and γ; derivatives and inverses follow from ψ and from the kernel. All lengths of a size
//! have one unit, which the caller chooses or the shape prescribes.

use crate::numerics::guard::{TINY, quotient};
use crate::shape::ShapeKind;
use crate::shape::kernel::Kernel;

/// One size of a shape; plain data.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Size {
    /// Half-width a of the flat.
    pub flat: f64,
    pub leg: f64,
    pub half_width: f64,
    pub psi: f64,
    /// The number of a [`ShapeKind`]: the memory of a caller may have any bits until its tag is checked.
    pub kind: u64,
}

impl Size {
    pub fn new(kind: ShapeKind, flat: f64, leg: f64) -> Size {
        Size { flat, kind: kind as u64, ..Size::default() }.resized(leg)
    }

    /// The shape. [`Size::new`] sets its number from a shape, so that there are no other numbers.
    pub fn kind(&self) -> ShapeKind {
        const HERTZ_ELLIPSE: u64 = ShapeKind::HertzEllipse as u64;
        match self.kind {
            HERTZ_ELLIPSE => ShapeKind::HertzEllipse,
            _ => ShapeKind::RoundedFlat,
        }
    }

    /// Whether load and shift are powers of leg.
    pub fn is_power_law(&self) -> bool {
        self.kind() == ShapeKind::HertzEllipse
    }

    pub fn kernel(&self) -> Kernel {
        if self.is_power_law() { Kernel::Point } else { Kernel::Line }
    }

    /// Another size of the same shape and flat.
    pub fn resized(&self, leg: f64) -> Size {
        let size = Size { leg, half_width: (self.flat * self.flat + leg * leg).sqrt(), ..*self };
        Size { psi: size.angle(), ..size }
    }

    /// The size that carries a load, given that this size nearly does. One Newton step is enough if it is at most 1e-9 of leg,
    /// because the square of the step is then below rounding.
    pub fn at_load_near(&self, load: f64) -> Size {
        let step = quotient(load - self.load(), 4.0 * self.leg * self.psi);
        if step.abs() > 1e-9 * self.leg { self.at_load(load) } else { self.resized(self.leg + step) }
    }

    /// Derivative of g with respect to ln leg.
    pub fn load_slope(&self) -> f64 {
        4.0 * self.leg * self.leg * self.psi
    }

    /// Decrease of the compliance with the load, -dΛ/dg.
    pub fn decrease_with_load(&self) -> f64 {
        let (reach, _) = self.kernel().reach(self.half_width);
        1.0 / (4.0 * (self.half_width * self.half_width * reach) * self.psi).max(TINY)
    }

    /// Decrease of the compliance with ln leg, and the derivative of this decrease with respect to ln leg.
    pub fn decrease(&self) -> [f64; 2] {
        let share = self.leg * self.leg / (self.half_width * self.half_width).max(TINY);
        let (reach, order) = self.kernel().reach(self.half_width);
        let decrease = quotient(share, reach);
        [decrease, decrease * (2.0 * (1.0 - share) - order * share)]
    }

    /// The size as a function of a quantity whose derivative with respect to leg is proportional to leg ψ Λ, expanded about this
    /// size. `power` is d ln(value)/d ln leg, `slope_of_psi` is d ln ψ/d ln leg and `slope_of_compliance` is -d ln Λ/d ln leg, the
    /// latter two with their derivatives with respect to ln leg.
    pub fn inverse(
        &self,
        value: f64,
        power: f64,
        slope_of_psi: [f64; 2],
        slope_of_compliance: [f64; 2],
    ) -> InversePower {
        // First and second derivative of the logarithm of the power with respect to ln leg.
        let first = 2.0 + slope_of_psi[0] - slope_of_compliance[0] - power;
        let second = slope_of_psi[1] - slope_of_compliance[1] - power * first;
        // The lower bound keeps the third power finite.
        let inverse = 1.0 / power.max(1e-20);
        let square = inverse * inverse;
        let cubic = inverse * (1.0 + square * (4.0 * first * first - 2.0 * second - 1.0)) * (1.0 / 3.0);
        InversePower { leg: self.leg, value, coefficients: [inverse, -square * first, cubic] }
    }
}

/// leg as a function of a quantity that scales nearly as a power of leg, close to leg_0: the expansion of
/// `(leg - leg_0)/(leg + leg_0)` in powers of `(value - value_0)/(value + value_0)`, up to the third.
///
/// Both variables are hyperbolic tangents of half a logarithm, of leg/leg_0 and of value/value_0. For a constant power of 2 to 3
/// and a value 20 % away the error is below 2e-6 of leg.
#[derive(Default)]
pub(crate) struct InversePower {
    leg: f64,
    value: f64,
    coefficients: [f64; 3],
}

impl InversePower {
    /// leg - leg_0.
    pub fn step(&self, value: f64) -> f64 {
        let [first, second, third] = self.coefficients;
        let x = quotient(value - self.value, value + self.value);
        // leg changes by at most a factor of 3.
        let ratio = (x * (first + x * (second + x * third))).clamp(-0.5, 0.5);
        2.0 * self.leg * ratio / (1.0 - ratio)
    }

    /// leg.
    pub fn leg(&self, value: f64) -> f64 {
        self.leg + self.step(value)
    }
}
