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
//! With the load g of a size in units of the shape, and β and γ the means of the compliance Λ beyond that of the size and of its
//! product with the load, both shapes have the same sums,
//!
//! ```text
//! N ~ g,     U, S = N (Λ + β),     M = N² (Λ + γ)/2,
//! ```
//!
//! to which a layer in series adds its own.

mod hertz_ellipse;
pub(crate) mod layer;
pub(crate) mod rounded_flat;
pub(crate) mod rounded_punch;
pub(crate) mod series;
pub(crate) mod stick_zone;
pub(crate) mod tractions;

use crate::error::Error;
pub(crate) use crate::numerics::guard::TINY;
use crate::numerics::guard::quotient;
use crate::numerics::roots::logarithmic_newton;
use crate::parameters::Common;
pub(crate) use layer::LayerCompliance;
pub(crate) use rounded_flat::size_under_load;
pub(crate) use rounded_punch::RoundedPunch;
use tractions::{SurfacePoint, difference_of_heights};

/// A complementary pair of amounts, `consumed + remaining`. Neither is computed from the other if it is the smaller.
#[derive(Debug, Clone, Copy, PartialEq)]
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

/// What grows with the size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
    /// Checks the ranges of all parameters; those that all shapes have.
    /// Errors: the error of the first parameter, in the order of the fields, that is NaN, infinite or out of range.
    fn checked(&self) -> Result<Common, Error>;

    /// The shape of parameters that were checked, N > 0, without their layer.
    /// Errors: `OutOfRange` if derived quantities are not representable; `LengthTooShort` if 2L <= b or if the tangential stiffness
    /// at b would not be positive.
    fn shape(&self) -> Result<Shape, Error>;

    /// Errors: `OutOfRange` if the laws of an element would not be representable.
    fn check_element(&self, modulus: f64) -> Result<(), Error>;
}

/// A nested family of contact sizes, with a layer in series. A size is given by its leg \[m\], which is 0 for the smallest one:
/// the semi-axis x of an ellipse, `sqrt(s² - a²)` of a flat with rounded edges.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Shape {
    /// Half-width a of the flat \[m\]; 0 for an ellipse.
    pub flat: f64,
    /// L, or the semi-axis x under the normal force of the parameters \[m\].
    length: f64,
    /// N/g.
    load_scale: f64,
    /// K_t/Λ \[m/N\]; 1 for an ellipse.
    compliance_scale: f64,
    /// χ of U and of S, or C_n and C_t.
    constants: [f64; 2],
    /// Without the layer, S = `per_approach` U + `per_load` N in each direction of the plane of contact.
    pub per_approach: [f64; 2],
    pub per_load: [f64; 2],
    /// Pressure over the integrals of the tractions.
    pressure_scale: f64,
    /// The largest size for which the laws hold in both directions of the plane of contact; 0 unless set by an element.
    pub largest: f64,
    /// The half-width under the normal force of the parameters \[m\], and the punch with lengths over it.
    pub reference: (f64, RoundedPunch),
    /// E* \[Pa\].
    pub composite_modulus: f64,
    pub layer: LayerCompliance,
}

/// Smallest Λ for which the laws are inverted: the approach is largest at Λ = 0.
const SMALLEST_COMPLIANCE: f64 = 1.0 / 16.0;

/// 2^498: the largest load \[N\], approach and shift \[m\] of an ellipse or of a layer.
const LARGEST: f64 = f64::from_bits((1023 + 498) << 52);

impl Shape {
    fn is_elliptic(&self) -> bool {
        self.reference.1.is_elliptic()
    }

    /// The constant of U or of S.
    fn constant(&self, quantity: Quantity) -> f64 {
        self.constants[usize::from(quantity == Quantity::Shift)]
    }

    /// The punch of a size; of an ellipse over that of the parameters.
    fn punch_at(&self, leg: f64) -> RoundedPunch {
        if self.is_elliptic() { RoundedPunch::ellipse(leg / self.length) } else { RoundedPunch::new(self.flat, leg) }
    }

    /// Half-width s \[m\]; for an ellipse the semi-axis x.
    pub fn half_width(&self, leg: f64) -> f64 {
        if self.is_elliptic() { leg } else { self.punch_at(leg).half_width }
    }

    /// N \[N\].
    pub fn load(&self, leg: f64) -> f64 {
        self.load_scale * self.punch_at(leg).load()
    }

    /// K_n or K_t \[m/N\] without the layer, or 1 for N.
    fn own_compliance(&self, quantity: Quantity, punch: &RoundedPunch) -> f64 {
        match quantity {
            Quantity::Load => 1.0,
            _ if self.is_elliptic() => quotient(self.constant(quantity), punch.leg),
            _ => self.compliance_scale * self.log_compliance(punch.half_width, self.constant(quantity)),
        }
    }

    /// `ln(2L/s) + constant`.
    fn log_compliance(&self, half_width: f64, constant: f64) -> f64 {
        (2.0 * self.length / half_width.max(TINY * self.length).max(TINY)).ln() + constant
    }

    /// N, U or S without the layer \[N, m\], given g and its derivative by N.
    fn own_value(&self, quantity: Quantity, punch: &RoundedPunch, load: f64, compliance: f64) -> f64 {
        self.load_scale
            * match quantity {
                Quantity::Load => load,
                _ if self.is_elliptic() => 1.5 * load * compliance,
                _ => load * (compliance + self.compliance_scale * punch.beta(load)),
            }
    }

    /// N, U or S \[N, m\].
    pub fn value(&self, quantity: Quantity, leg: f64) -> f64 {
        self.value_and_compliance(quantity, leg)[0]
    }

    /// The derivative of N, U or S by N: 1, K_n, K_t \[m/N\].
    pub fn compliance(&self, quantity: Quantity, leg: f64) -> f64 {
        let (own, unloaded) = (self.own_compliance(quantity, &self.punch_at(leg)), self.layer.unloaded(quantity));
        if unloaded > 0.0 { own + unloaded * self.layer.softness(self.load(leg)) } else { own }
    }

    /// N, U or S and its derivative by N.
    pub fn value_and_compliance(&self, quantity: Quantity, leg: f64) -> [f64; 2] {
        self.sums(quantity, &self.punch_at(leg))
    }

    fn sums(&self, quantity: Quantity, punch: &RoundedPunch) -> [f64; 2] {
        let (load, unloaded) = (punch.load(), self.layer.unloaded(quantity));
        let mut compliance = self.own_compliance(quantity, punch);
        let mut value = self.own_value(quantity, punch, load, compliance);
        if unloaded > 0.0 {
            value += unloaded * self.layer.extent(self.load_scale * load);
            compliance += unloaded * self.layer.softness(self.load_scale * load);
        }
        [value, compliance]
    }

    /// d²N/dS² \[N/m²\] at a size > 0: the decrease of the compliance with the load, over the cube of the compliance. A layer has its
    /// compliance over N + N_c as decrease.
    pub fn load_curvature(&self, leg: f64) -> f64 {
        let punch = self.punch_at(leg);
        let (own, load) = (self.own_compliance(Quantity::Shift, &punch), self.load_scale * punch.load());
        let [decrease, _] = punch.decrease();
        let decrease = if self.is_elliptic() { own } else { self.compliance_scale * decrease };
        let layer = self.layer.compliance(load);
        let stiffness = 1.0 / (own + layer);
        let per_load = decrease / (self.load_scale * punch.load_slope()) + layer * self.layer.hardening(load);
        per_load * stiffness * stiffness * stiffness
    }

    /// M = ∫ N dS \[J\].
    pub fn potential(&self, leg: f64) -> f64 {
        let punch = self.punch_at(leg);
        let (load, compliance) = (punch.load(), self.own_compliance(Quantity::Shift, &punch));
        let mean = if self.is_elliptic() { 0.2 * compliance } else { self.compliance_scale * punch.gamma(load) };
        let load = self.load_scale * load;
        // The square of a small load would underflow.
        let own = 0.5 * load * (load * (compliance + mean));
        if self.layer.tangential > 0.0 { own + self.layer.potential(load) } else { own }
    }

    /// N, and S in both directions.
    pub fn load_and_shifts(&self, leg: f64) -> [f64; 3] {
        let punch = self.punch_at(leg);
        let (load, compliance) = (punch.load(), self.own_compliance(Quantity::Approach, &punch));
        let approach = self.own_value(Quantity::Approach, &punch, load, compliance);
        let load = self.load_scale * load;
        let layer = self.layer.shift(load);
        let shift = |k: usize| self.per_approach[k] * approach + self.per_load[k] * load + layer;
        [load, shift(0), shift(1)]
    }

    /// K_t in a direction of a flat punch of the half-width s below that of the flat: a load of 0. Not used without a flat.
    pub fn compliance_under_flat(&self, k: usize, half_width: f64) -> f64 {
        let own = self.compliance_scale * self.log_compliance(half_width, self.constants[0]);
        self.per_approach[k] * own + self.per_load[k] + self.layer.compliance(0.0)
    }

    /// N/g \[N/m²\], with g the square of a length in the law of loads. Not used without a flat.
    pub fn load_per_square(&self) -> f64 {
        self.load_scale
    }

    /// The pressure that a size adds, times sqrt(s² - x²)/s and in any unit: dp/d(s²).
    pub fn pressure_weight(&self, leg: f64) -> f64 {
        if self.is_elliptic() { 1.0 } else { self.punch_at(leg).psi }
    }

    /// The size under a normal force \[N\], and d(leg²)/dN \[m²/N\].
    pub fn size_under(&self, load: f64) -> [f64; 2] {
        let load = load / self.load_scale;
        if self.is_elliptic() {
            let leg = self.length * load.cbrt();
            let load = self.load(leg).max(TINY);
            return [leg, 2.0 / 3.0 * (leg / load) * leg];
        }
        let punch = RoundedPunch::from_load(self.flat, load);
        [punch.leg, quotient(0.5, self.load_scale * punch.psi)]
    }

    /// The size under a normal force \[N\].
    pub fn at_load(&self, load: f64) -> f64 {
        self.size_under(load)[0]
    }

    /// The size at which N, U or S has a value: Newton's method in the logarithms. The size at which the contact alone has the
    /// value and that at which the layer alone has it are both too large; at the smaller one of both the sum is at most twice the
    /// value.
    pub fn size_at(&self, quantity: Quantity, value: f64) -> f64 {
        if quantity == Quantity::Load || value <= 0.0 {
            return self.at_load(value.max(0.0));
        }
        let constant = self.constant(quantity);
        let of_contact = if self.is_elliptic() {
            self.length * (value / (1.5 * constant * self.load_scale)).sqrt()
        } else {
            let compliance = self.compliance_scale * self.log_compliance(self.reference.0, constant).max(1.0);
            RoundedPunch::initial_guess_leg(self.flat, value / (self.load_scale * compliance))
        };
        let unloaded = self.layer.unloaded(quantity);
        if self.is_elliptic() && unloaded <= 0.0 {
            return of_contact;
        }
        let mut start = of_contact;
        if unloaded > 0.0 {
            // A soft layer stiffens exponentially: alone it may carry a load that no size has.
            let of_layer = self.layer.load_of_extent(value / unloaded);
            start = if of_layer < self.load(start) { self.at_load(of_layer) } else { start };
        }
        logarithmic_newton(value, start, |leg| {
            let punch = self.punch_at(leg);
            let [sum, compliance] = self.sums(quantity, &punch);
            if compliance <= 0.0 {
                // Beyond the largest size, half of it. The steps from below do not overshoot, because the logarithm is concave.
                return [2.0 * value, 1.0];
            }
            // dN/d(ln leg).
            [sum, self.load_scale * punch.load_slope() * compliance / sum]
        })
    }

    /// The largest size for which the laws hold: for a flat with rounded edges that at which the smaller one of both Λ is 1/16, and
    /// both vanish near s = 2L; for an ellipse, and with a layer, by loads and displacements up to 2^498. Negative if that is less
    /// than a.
    pub fn largest_size(&self) -> f64 {
        let [normal, tangential] = self.constants;
        let largest = if self.is_elliptic() {
            let by_load = (LARGEST / self.load_scale).cbrt();
            let compliance = 1.5 * normal.max(tangential);
            self.length * by_load.min((LARGEST / (compliance * self.load_scale)).sqrt())
        } else {
            self.size_of_half_width(normal.min(tangential).min(0.0) - SMALLEST_COMPLIANCE)
        };
        let compliance = self.layer.normal.max(self.layer.tangential);
        if compliance <= 1.0 { largest } else { largest.min(self.at_load(LARGEST / compliance)) }
    }

    /// The largest size for which the laws hold in both directions.
    pub fn largest_in_plane(&self) -> f64 {
        let [_, per_approach] = self.per_approach;
        // K_y = 1/16 or more, as for the other two.
        let bound = (SMALLEST_COMPLIANCE - self.per_load[1] / self.compliance_scale) / per_approach - self.constants[0];
        if self.is_elliptic() { self.largest_size() } else { self.largest_size().min(self.size_of_half_width(-bound)) }
    }

    /// The size with the half-width 2L exp(bound); negative if that is less than a.
    fn size_of_half_width(&self, bound: f64) -> f64 {
        let half_width = 2.0 * self.length * bound.exp();
        let (less, more) = (half_width - self.flat, half_width + self.flat);
        less.signum() * (less.abs() * more).sqrt()
    }

    /// Pressure \[Pa\] at x \[m\] along the width that the sizes from `from` to `to` carry (Eq. 17:
    /// `dp = E* ψ leg d leg/(πR sqrt(s² - x²))`); 0 outside the contact. For an ellipse on the x axis: differences of
    /// `(3/2) N0/(π b² l) sqrt(s² - x²)`, the pressure of the size s.
    pub fn pressure_between(&self, from: f64, to: f64, x: f64) -> f64 {
        if self.is_elliptic() {
            // The squares of distant points are not representable.
            let x = x.abs().min(from.max(to));
            let square = |s: f64| (s - x) * (s + x);
            return self.pressure_scale * difference_of_heights(square(to), square(from), (to - from) * (to + from));
        }
        // Lengths in units of the larger half-width.
        let half_width = self.half_width(to);
        let unit = half_width.max(TINY);
        let point = SurfacePoint::new(x, half_width, self.flat);
        let squares = ((to - from) / unit) * ((to + from) / unit);
        self.pressure_scale
            * unit
            * tractions::pressure_between(self.flat / unit, from / unit, to / unit, squares, &point)
    }
}
