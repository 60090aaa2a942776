//! Shapes: the nested family of sizes that a contact runs through under a growing normal load.
//!
//! A shape is defined by geometry and material, independently of the load. Each size s of the contact has a normal force N(s),
//! and as the load grows, every increment dN is carried like a flat punch of that size. It brings the bodies closer by `dU = K_n
//! dN` and makes a fully stuck contact more compliant by `dS = K_t dN`:
//!
//! ```text
//! N(s)  normal force                      K_n(s)  normal compliance of a punch of size s
//! U(s)  normal approach                   K_t(s)  tangential compliance
//! S(s)  tangential shift                  M(s) = ∫ N dS
//! ```
//!
//! The monotonic curve, hysteresis and energies follow from N and S alone (Jäger 1998; Ciavarella 1998), without the geometry.
//! Under a constant load only the sizes below the present one are involved: its stick zones.
//!
//! The three sums have the same form for all shapes. The load of a size is g, in a unit of the shape. The compliance of a punch of
//! this size is Λ; the smaller punches inside it are more compliant. The mean of their compliances over the load exceeds Λ by β,
//! and the mean weighted by their loads exceeds it by γ:
//!
//! ```text
//! N ~ g,     U, S ~ N (Λ + β),     M ~ N² (Λ + γ)/2
//! ```
//!
//! A layer in series adds its own terms. Λ is the kernel of a line or of a point contact, plus a constant that depends on the
//! direction.

mod hertz_ellipse;
pub(crate) mod kernel;
pub(crate) mod layer;
pub(crate) mod rounded_flat;
pub(crate) mod series;
pub(crate) mod size;
pub(crate) mod stick_zone;
pub(crate) mod tractions;

use crate::error::Error;
pub(crate) use crate::numerics::guard::TINY;
use crate::numerics::guard::quotient;
use crate::numerics::roots::logarithmic_newton;
use crate::parameters::Common;
pub(crate) use layer::LayerCompliance;
pub(crate) use rounded_flat::size_under_load;
use series::Series;
use size::Size;
use tractions::SurfacePoint;

/// The shapes; the formulas of each are in a file of its name.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum ShapeKind {
    RoundedFlat,
    HertzEllipse,
}

/// Methods of a size, each a function in the file of its shape.
macro_rules! of_shapes {
    ($($(#[$comment:meta])* $name:ident($($argument:ident: $type:ty),*) -> $result:ty;)*) => {
        impl Size {$(
            $(#[$comment])*
            pub fn $name(&self $(, $argument: $type)*) -> $result {
                match self.kind() {
                    ShapeKind::RoundedFlat => rounded_flat::$name(self $(, $argument)*),
                    ShapeKind::HertzEllipse => hertz_ellipse::$name(self $(, $argument)*),
                }
            }
        )*}
    };
}

of_shapes! {
    /// The angle ψ in dg = 4 leg ψ d leg, from a and leg; finite at leg = 0.
    angle() -> f64;
    /// The rate d ln ψ/d ln leg, and the derivative of this rate with respect to ln leg.
    rates() -> [f64; 2];
    /// The load g.
    load() -> f64;
    /// The mean β of the compliance increase, given g.
    beta(load: f64) -> f64;
    /// The mean γ of the compliance increase weighted by the load, given g.
    gamma(load: f64) -> f64;
    /// The size of the same flat that carries a load: the inverse of g.
    at_load(load: f64) -> Size;
    /// An estimate of the leg at which S has a value. `load` is this value over the compliance Λ of a size close to it. Exact
    /// for a power law if Λ is that of the size leg = 1.
    estimated_leg(load: f64) -> f64;
    /// Taylor series of N, U and S without a layer about a size with leg > 0, as functions of one of the three.
    series(shape: &Shape, leg: f64, argument: Quantity) -> [Series; 3];
    /// Pressure that the sizes between two legs add, in units of g/(4π) over an area; `legs` are both legs and the difference of
    /// their squares.
    pressure(legs: [f64; 3], point: &SurfacePoint) -> f64;
    /// Slip at a point outside this stick zone, in units of g/4; NaN if the shape has no closed form.
    slip(point: &SurfacePoint) -> f64;
}

/// An amount divided into two parts, `consumed + remaining`. The smaller part is never computed as a difference of the other two.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Complement {
    pub consumed: f64,
    pub remaining: f64,
}

impl Complement {
    /// The pair with the sum 1.
    pub fn of_remaining(remaining: f64) -> Complement {
        Complement { consumed: 1.0 - remaining, remaining }
    }
}

/// A quantity that grows with the size.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Quantity {
    /// Normal force N.
    Load,
    /// Normal approach U.
    Approach,
    /// Tangential shift S.
    Shift,
}

impl Quantity {
    /// N, U and S.
    pub const ALL: [Quantity; 3] = [Quantity::Load, Quantity::Approach, Quantity::Shift];
}

/// Geometry, material and load from which a shape follows.
pub(crate) trait Geometry {
    /// Checks the ranges of all parameters, and returns the parameters that all shapes have.
    /// Errors: the error of the first parameter, in the order of the fields, that is NaN, infinite or out of range.
    fn checked(&self) -> Result<Common, Error>;

    /// The shape of parameters that were checked, N > 0, without their layer.
    /// Errors: `OutOfRange` if derived quantities are not representable; `LengthTooShort` if 2L <= b or if the tangential stiffness
    /// at b would not be positive.
    fn shape(&self) -> Result<Shape, Error>;

    /// The largest size for which the laws hold in the given number of tangential directions, without a layer. Negative if that is
    /// less than a.
    /// Errors: `OutOfRange` if the laws of an element would not be representable.
    fn largest_size(&self, shape: &Shape, directions: usize) -> Result<f64, Error>;
}

/// A nested family of contact sizes, with a layer in series. A size is given by its leg \[m\], which is 0 for the smallest one:
/// the semi-axis x of an ellipse, `sqrt(s² - a²)` of a flat with rounded edges.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Shape {
    /// Half-width a of the flat \[m\]; 0 for an ellipse.
    pub flat: f64,
    /// The unit of the lengths in a [`Size`] of this shape \[m\]: 1 m, or the semi-axis x under the normal force of the parameters.
    unit: f64,
    /// The half-width, in this unit, at which the kernel has its value at 1: 2L, or 1.
    length: f64,
    /// Normal force over the load of a size: N/g.
    load_scale: f64,
    /// Coefficients of the compliances dU/dN, dS/dN along x and dS/dN along y, each `scale (kernel + offset)` with the scale in
    /// \[m/N\].
    compliances: [[f64; 2]; 3],
    /// Pressure over the integrals of the tractions.
    pressure_scale: f64,
    /// The largest size for which the laws hold; 0 unless set by an element.
    pub largest: f64,
    /// The half-width under the normal force of the parameters \[m\].
    pub reference_half_width: f64,
    /// The size under the normal force of the parameters, with lengths over its half-width.
    pub reference_size: Size,
    /// E* \[Pa\].
    pub composite_modulus: f64,
    pub layer: LayerCompliance,
}

/// 2^498: the largest load \[N\], approach and shift \[m\] of an ellipse or of a layer.
pub(crate) const LARGEST: f64 = f64::from_bits((1023 + 498) << 52);

impl Shape {
    /// A size that stands for the shape where only its flat is used.
    fn any_size(&self) -> Size {
        Size { flat: self.flat, ..self.reference_size }
    }

    fn size(&self, leg: f64) -> Size {
        self.any_size().resized(leg / self.unit)
    }

    /// Half-width s \[m\]; for an ellipse the semi-axis x.
    pub fn half_width(&self, leg: f64) -> f64 {
        self.size(leg).half_width * self.unit
    }

    /// N \[N\].
    pub fn load(&self, leg: f64) -> f64 {
        self.load_scale * self.size(leg).load()
    }

    /// Scale and offset of the compliance K_n or K_t.
    fn compliance_coefficients(&self, quantity: Quantity) -> [f64; 2] {
        self.compliances[usize::from(quantity == Quantity::Shift)]
    }

    /// dU/dN or dS/dN of a half-width in units of the sizes, without the layer \[m/N\].
    fn own_compliance(&self, [scale, offset]: [f64; 2], half_width: f64) -> f64 {
        let reciprocal = self.length / half_width.max(TINY * self.length).max(TINY);
        scale * (self.reference_size.kernel().value(reciprocal) + offset)
    }

    /// Λ of the size under the normal force of the parameters, without the layer (Eq. 10; 1 for an ellipse).
    pub fn full_stick(&self) -> f64 {
        let [_, offset] = self.compliance_coefficients(Quantity::Shift);
        self.own_compliance([1.0, offset], self.reference_half_width / self.unit)
    }

    /// The stiffness along x for Λ = 1 \[N/m\].
    pub fn stiffness_scale(&self) -> f64 {
        1.0 / self.compliance_coefficients(Quantity::Shift)[0]
    }

    /// The compliance of one direction (0: normal, 1: x, 2: y) as a multiple of that of another one and a constant \[m/N\].
    pub fn compliance_in_terms_of(&self, direction: usize, other: usize) -> [f64; 2] {
        let ([scale, offset], [of_other, offset_of_other]) = (self.compliances[direction], self.compliances[other]);
        [scale / of_other, scale * (offset - offset_of_other)]
    }

    /// U or S without the layer \[m\] and its derivative with respect to N, given the coefficients of the compliance and the load
    /// g.
    fn own_sums(&self, coefficients: [f64; 2], size: &Size, load: f64) -> [f64; 2] {
        let compliance = self.own_compliance(coefficients, size.half_width);
        [self.load_scale * (load * (compliance + coefficients[0] * size.beta(load))), compliance]
    }

    /// N, U or S \[N, m\].
    pub fn value(&self, quantity: Quantity, leg: f64) -> f64 {
        self.value_and_compliance(quantity, leg)[0]
    }

    /// The derivative of N, U or S with respect to N: 1, K_n or K_t \[m/N\].
    pub fn compliance(&self, quantity: Quantity, leg: f64) -> f64 {
        self.value_and_compliance(quantity, leg)[1]
    }

    /// N, U or S, and its derivative with respect to N.
    pub fn value_and_compliance(&self, quantity: Quantity, leg: f64) -> [f64; 2] {
        self.sums(quantity, &self.size(leg))
    }

    fn sums(&self, quantity: Quantity, size: &Size) -> [f64; 2] {
        let (load, unloaded) = (size.load(), self.layer.unloaded(quantity));
        if quantity == Quantity::Load {
            return [self.load_scale * load, 1.0];
        }
        let [mut value, mut compliance] = self.own_sums(self.compliance_coefficients(quantity), size, load);
        if unloaded > 0.0 {
            value += unloaded * self.layer.extent(self.load_scale * load);
            compliance += unloaded * self.layer.softness(self.load_scale * load);
        }
        [value, compliance]
    }

    /// d²N/dS² \[N/m²\] at a size > 0: the decrease of the compliance with the load, over the cube of the compliance. For a layer
    /// it is C/(N + N_c).
    pub fn load_curvature(&self, leg: f64) -> f64 {
        let size = self.size(leg);
        let shift = self.compliance_coefficients(Quantity::Shift);
        let (own, load) = (self.own_compliance(shift, size.half_width), self.load_scale * size.load());
        let layer = self.layer.compliance(load);
        let stiffness = 1.0 / (own + layer);
        let per_load = shift[0] * size.decrease_with_load() / self.load_scale + layer * self.layer.hardening(load);
        per_load * stiffness * stiffness * stiffness
    }

    /// M = ∫ N dS \[J\].
    pub fn potential(&self, leg: f64) -> f64 {
        let size = self.size(leg);
        let load = size.load();
        let shift = self.compliance_coefficients(Quantity::Shift);
        let mean = self.own_compliance(shift, size.half_width) + shift[0] * size.gamma(load);
        let load = self.load_scale * load;
        // The square of a small load would underflow.
        let own = 0.5 * load * (load * mean);
        if self.layer.tangential > 0.0 { own + self.layer.potential(load) } else { own }
    }

    /// The normal force N, and the shifts S along x and along y.
    pub fn load_and_shifts(&self, leg: f64) -> [f64; 3] {
        let size = self.size(leg);
        let load = size.load();
        let ([x, _], [ratio, per_load]) = (
            self.own_sums(self.compliance_coefficients(Quantity::Shift), &size, load),
            self.compliance_in_terms_of(2, 1),
        );
        let load = self.load_scale * load;
        let layer = self.layer.shift(load);
        [load, x + layer, ratio * x + per_load * load + layer]
    }

    /// The compliance K_t(a) of the flat in a direction, the limit for a load of 0. Not used without a flat.
    pub fn compliance_of_flat(&self, axis: usize) -> f64 {
        self.own_compliance(self.compliances[axis + 1], self.flat) + self.layer.compliance(0.0)
    }

    /// N/g \[N/m²\], with g the square of a length in the law of loads. Not used without a flat.
    pub fn load_per_square(&self) -> f64 {
        self.load_scale
    }

    /// The weight of a size in the pressure, dp/d(s²) sqrt(s² - x²)/s, in an arbitrary unit.
    pub fn pressure_weight(&self, leg: f64) -> f64 {
        let size = self.size(leg);
        quotient(size.psi, size.kernel().reach(size.half_width).0)
    }

    /// The size under a normal force \[N\], and d(leg²)/dN \[m²/N\].
    pub fn leg_and_slope_under(&self, load: f64) -> [f64; 2] {
        let size = self.any_size().at_load(load / self.load_scale);
        [self.unit * size.leg, quotient(0.5, self.load_scale * size.psi) * self.unit * self.unit]
    }

    /// The size under a normal force \[N\].
    pub fn at_load(&self, load: f64) -> f64 {
        self.leg_and_slope_under(load)[0]
    }

    /// The size at which N, U or S has a value: Newton's method in the logarithms. The size at which the contact alone has the
    /// value and that at which the layer alone has it are both too large; at the smaller one of both the sum is at most twice the
    /// value.
    pub fn leg_at(&self, quantity: Quantity, value: f64) -> f64 {
        if quantity == Quantity::Load || value <= 0.0 {
            return self.at_load(value.max(0.0));
        }
        let (coefficients, size) = (self.compliance_coefficients(quantity), self.any_size());
        let near = |compliance: f64| self.unit * size.estimated_leg(value / (self.load_scale * compliance));
        let unloaded = self.layer.unloaded(quantity);
        if size.is_power_law() && unloaded <= 0.0 {
            return near(coefficients[0]);
        }
        let half_width = self.reference_half_width / self.unit;
        let mut start = near(self.own_compliance(coefficients, half_width).max(coefficients[0]));
        if unloaded > 0.0 {
            // A soft layer stiffens exponentially: alone it may carry a load that no size has.
            let of_layer = self.layer.load_of_extent(value / unloaded);
            start = if of_layer < self.load(start) { self.at_load(of_layer) } else { start };
        }
        logarithmic_newton(value, start, |leg| {
            let size = self.size(leg);
            let [sum, compliance] = self.sums(quantity, &size);
            if compliance <= 0.0 {
                // Beyond the largest size, half of it. The steps from below do not overshoot, because the logarithm is concave.
                return [2.0 * value, 1.0];
            }
            // dN/d(ln leg).
            [sum, self.load_scale * size.load_slope() * compliance / sum]
        })
    }

    /// Pressure \[Pa\] at x \[m\] along the width that the sizes from `from` to `to` carry (Eq. 17:
    /// `dp = E* ψ leg d leg/(πR sqrt(s² - x²))`); 0 outside the contact.
    pub fn pressure_between(&self, from: f64, to: f64, x: f64) -> f64 {
        // Lengths in units of the larger half-width.
        let half_width = self.half_width(to);
        let unit = half_width.max(TINY);
        let point = SurfacePoint::new(x, half_width, self.flat);
        let square_difference = ((to - from) / unit) * ((to + from) / unit);
        let legs = [from / unit, to / unit, square_difference];
        let size = Size { flat: self.flat / unit, ..self.reference_size };
        self.pressure_scale * unit * size.pressure(legs, &point)
    }
}
