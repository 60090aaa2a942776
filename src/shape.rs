//! The one abstraction of a contact: a nested family of contact sizes (Jäger, Ciavarella 1998).
//!
//! A contact under a growing normal load runs through sizes c, each with its load P(c) and its tangential approach S(c),
//! `dS = (compliance at c) dP`. Under the present load, the contact has size b. Every tangential state is then a
//! difference of two members of the family,
//!
//! ```text
//! Q = μ [P(b) - P(c)],        δ ∝ μ [S(b) - S(c)]                  c: the stick zone
//! ```
//!
//! and every history is a signed sum of such differences. The monotonic curve, the memory, the energy and the harmonics
//! rest on the trait below, without knowing which contact it is. A normal load that varies moves b along the family.
//!
//! Here loads are in units of P(b), sizes in units of b, approaches in a unit of the family's choice. Three numbers
//! describe how a member c lies in the family:
//!
//! - `τ = 1 - P(c)/P(b)`, the load lost between b and c: the tangential force over its largest value;
//! - `x = S(b) - S(c)`, the approach lost: the tangential displacement;
//! - `Λ + λ = dx/dτ`, the compliance, with λ = 0 at b.
//!
//! Every amount comes as a [`Complement`]: what is lost and what rests, each accurate where it is small.

pub(crate) mod hertz_ellipse;
pub(crate) mod rounded_flat;
pub(crate) mod rounded_punch;
pub(crate) mod small_load;
pub(crate) mod tractions;

use crate::numerics::quadrature::TANH_SINH;
use crate::shape::small_load::SmallLoadSeries;

/// An amount divided in two: `consumed + remaining` is the whole. Neither is computed from the other where it is the smaller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Complement {
    pub consumed: f64,
    pub remaining: f64,
}

/// One member of the family: a stick zone.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StickZone {
    /// τ and 1 - τ.
    pub load: Complement,
    /// x, and what is left of it until gross slip.
    pub shift: Complement,
    /// λ; infinite at the point to which an elliptical contact or a cylinder shrinks.
    pub compliance_increase: f64,
    /// σ, the family's own measure of size, where it was the way to find the member; else it follows from λ.
    pub size_parameter: Option<f64>,
}

/// A member with what integrals over the family need there.
#[derive(Debug, Clone, Copy)]
pub(crate) struct QuadraturePoint {
    pub shift: Complement,
    /// Λ + λ.
    pub compliance: f64,
    /// -dτ/dσ and -dλ/dσ, with σ the family's own measure of size.
    pub dload_dsigma: f64,
    pub dcompliance_dsigma: f64,
}

/// A place along the width. The differences come from the user's own lengths: between a nearly flat contact's flat and
/// its edge, x/b alone has few digits left.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SurfacePoint {
    /// |x|/b.
    pub x: f64,
    /// (|x| - a)/b.
    pub past_flat: f64,
    /// (b - |x|)/b.
    pub from_edge: f64,
}

/// A family of contact sizes with its load and its tangential approach.
pub(crate) trait SizeFamily {
    /// The curve near the origin, for τ <= 1/2.
    fn origin(&self) -> &SmallLoadSeries;

    /// x at which only the smallest member is left: gross slip.
    fn slip_shift(&self) -> f64;

    /// The member at a load lost of at least 1/2, given by what rests, `0 <= remaining <= 1/2`.
    fn at_load_remaining(&self, remaining: f64) -> StickZone;

    /// The member at an approach lost of at least that at τ = 1/2, given by what rests until gross slip.
    fn at_shift_remaining(&self, remaining: f64) -> StickZone;

    /// Energy dissipated per cycle between ±τ, at least 1/2, in units of force times approach (Eq. 13-16).
    fn dissipation_beyond_half(&self, member: &StickZone) -> f64;

    /// c/b of a member.
    fn size(&self, member: &StickZone) -> f64;

    /// The family's own measure of size, σ from 0 for the smallest member to 1 for b, of a member.
    fn size_parameter(&self, member: &StickZone) -> f64;

    /// The member of that measure.
    fn station(&self, size_parameter: f64) -> QuadraturePoint;

    /// ln of twice the ratio of the largest member's measure to the distance of the nearest branch point from that of the
    /// smallest.
    fn log_branch_distance(&self) -> f64;

    /// Pressure at a place, in units of N/(bL) or, elliptical, of N over the product of the semi-axes.
    fn pressure(&self, place: &SurfacePoint) -> f64;

    /// Traction in those units, over μ, under a monotonically grown force: the pressure of b less that of the stick zone
    /// (Eq. 21).
    fn shear(&self, place: &SurfacePoint, stick: &StickZone) -> f64;

    /// Relative slip at a place (Eq. 15), in units of approach; `None` where the family has no closed form.
    fn slip(&self, place: &SurfacePoint, stick: &StickZone) -> Option<f64>;

    /// The member at which a load is lost.
    fn at_load(&self, load: Complement) -> StickZone {
        if load.consumed <= 0.5 {
            self.origin().at_load(load, self.slip_shift())
        } else {
            self.at_load_remaining(load.remaining)
        }
    }

    /// The member at which an approach is lost: the inverse of the monotonic curve.
    fn at_shift(&self, shift: Complement) -> StickZone {
        let origin = self.origin();
        if shift.consumed <= origin.half_shift {
            origin.at_shift(shift)
        } else {
            self.at_shift_remaining(shift.remaining)
        }
    }

    /// Energy dissipated per cycle between ±τ, in units of force times approach (Eq. 13-16).
    fn dissipation(&self, member: &StickZone) -> f64 {
        let tau = member.load.consumed;
        if tau <= 0.5 { self.origin().dissipation(tau) } else { self.dissipation_beyond_half(member) }
    }

    /// Derivative of the dissipation by τ: `4 (τ λ - h)`.
    fn d_dissipation(&self, member: &StickZone) -> f64 {
        let tau = member.load.consumed;
        if tau <= 0.5 {
            self.origin().d_dissipation(tau)
        } else {
            4.0 * (tau * self.compliance(member) - member.shift.consumed)
        }
    }

    /// dx/dτ = Λ + λ.
    fn compliance(&self, member: &StickZone) -> f64 {
        self.origin().compliance + member.compliance_increase
    }
}

/// `∫ f dσ` over the members of measures between `from` and `to`, for f that is a root at both ends or better.
pub(crate) fn integrate(
    family: &dyn SizeFamily,
    from: f64,
    to: f64,
    mut f: impl FnMut(&QuadraturePoint) -> f64,
) -> f64 {
    let length = to - from;
    length * TANH_SINH.iter().map(|node| node.weight * f(&family.station(from + length * node.from_0))).sum::<f64>()
}
