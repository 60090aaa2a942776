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
//! Every amount comes as a [`Split`]: what is lost and what rests, each accurate where it is small.

use crate::origin::Origin;
use crate::quadrature::TANH_SINH;

/// An amount divided in two: `lost + rest` is the whole. Neither is computed from the other where it is the smaller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Split {
    pub lost: f64,
    pub rest: f64,
}

/// One member of the family: a stick zone.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Member {
    /// τ and 1 - τ.
    pub load: Split,
    /// x, and what is left of it until gross slip.
    pub approach: Split,
    /// λ; infinite at the point to which an elliptical contact or a cylinder shrinks.
    pub excess: f64,
    /// σ, the family's own measure of size, where it was the way to find the member; else it follows from λ.
    pub measure: Option<f64>,
}

/// A member with what integrals over the family need there.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Station {
    pub approach: Split,
    /// Λ + λ.
    pub compliance: f64,
    /// -dτ/dσ and -dλ/dσ, with σ the family's own measure of size.
    pub load_rate: f64,
    pub excess_rate: f64,
}

/// A place along the width. The differences come from the user's own lengths: between a nearly flat contact's flat and
/// its edge, x/b alone has few digits left.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    /// |x|/b.
    pub x: f64,
    /// (|x| - a)/b.
    pub beyond_flat: f64,
    /// (b - |x|)/b.
    pub inside_edge: f64,
}

/// A family of contact sizes with its load and its tangential approach.
pub(crate) trait ContactFamily {
    /// The curve near the origin, for τ <= 1/2.
    fn origin(&self) -> &Origin;

    /// x at which only the smallest member is left: gross slip.
    fn slip_approach(&self) -> f64;

    /// The member at a load lost of at least 1/2, given by what rests, `0 <= rest <= 1/2`.
    fn at_load_rest(&self, rest: f64) -> Member;

    /// The member at an approach lost of at least that at τ = 1/2, given by what rests until gross slip.
    fn at_approach_rest(&self, rest: f64) -> Member;

    /// Energy dissipated per cycle between ±τ, at least 1/2, in units of force times approach (Eq. 13-16).
    fn dissipation_beyond_half(&self, member: &Member) -> f64;

    /// c/b of a member.
    fn size(&self, member: &Member) -> f64;

    /// The family's own measure of size, σ from 0 for the smallest member to 1 for b, of a member.
    fn measure(&self, member: &Member) -> f64;

    /// The member of that measure.
    fn station(&self, measure: f64) -> Station;

    /// ln of twice the ratio of the largest member's measure to the distance of the nearest branch point from that of the
    /// smallest.
    fn spread(&self) -> f64;

    /// Pressure at a place, in units of N/(bL) or, elliptical, of N over the product of the semi-axes.
    fn pressure(&self, place: &Place) -> f64;

    /// Traction in those units, over μ, under a monotonically grown force: the pressure of b less that of the stick zone
    /// (Eq. 21).
    fn shear(&self, place: &Place, stick: &Member) -> f64;

    /// Relative slip at a place (Eq. 15), in units of approach; `None` where the family has no closed form.
    fn slip(&self, place: &Place, stick: &Member) -> Option<f64>;

    /// The member at which a load is lost.
    fn at_load(&self, load: Split) -> Member {
        if load.lost <= 0.5 { self.origin().at_load(load, self.slip_approach()) } else { self.at_load_rest(load.rest) }
    }

    /// The member at which an approach is lost: the inverse of the monotonic curve.
    fn at_approach(&self, approach: Split) -> Member {
        let origin = self.origin();
        if approach.lost <= origin.half_approach {
            origin.at_approach(approach)
        } else {
            self.at_approach_rest(approach.rest)
        }
    }

    /// Energy dissipated per cycle between ±τ, in units of force times approach (Eq. 13-16).
    fn dissipation(&self, member: &Member) -> f64 {
        let tau = member.load.lost;
        if tau <= 0.5 { self.origin().dissipation(tau) } else { self.dissipation_beyond_half(member) }
    }

    /// Derivative of the dissipation by τ: `4 (τ λ - h)`.
    fn dissipation_slope(&self, member: &Member) -> f64 {
        let tau = member.load.lost;
        if tau <= 0.5 {
            self.origin().dissipation_slope(tau)
        } else {
            4.0 * (tau * self.compliance(member) - member.approach.lost)
        }
    }

    /// dx/dτ = Λ + λ.
    fn compliance(&self, member: &Member) -> f64 {
        self.origin().compliance + member.excess
    }
}

/// `∫ f dσ` over the members of measures between `from` and `to`, for f that is a root at both ends or better.
pub(crate) fn integrate(family: &dyn ContactFamily, from: f64, to: f64, mut f: impl FnMut(&Station) -> f64) -> f64 {
    let length = to - from;
    length * TANH_SINH.iter().map(|node| node.weight * f(&family.station(from + length * node.from_0))).sum::<f64>()
}
