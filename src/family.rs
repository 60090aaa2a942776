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

/// Terms kept of the series at the origin: its radius of convergence is 1 and it is used up to τ = 1/2.
pub(crate) const TERMS: usize = 48;

/// The monotonic curve as a power series at the origin, `x = Λ τ + Σ h_n τⁿ`, n from 2.
///
/// Near the origin everything of interest is a small difference of two nearly equal members; the series has positive
/// terms only and loses nothing. One set of coefficients serves the curve, its slope and the energy:
/// `e = 4 ∫ t (τ - t) h''(t) dt = 4 Σ (n-1)/(n+1) h_n τⁿ⁺¹`.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Origin {
    /// Λ, the compliance of the full stick.
    pub(crate) compliance: f64,
    /// x at τ = 1/2.
    pub(crate) half_approach: f64,
    /// `h_{n+2} (n+1) (n+2)`: coefficients of the curvature h''.
    pub(crate) curvature: [f64; TERMS],
}

/// Sums of the series at one τ.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NearOrigin {
    /// h.
    pub approach: f64,
    /// λ = h'.
    pub compliance: f64,
    /// h''.
    pub curvature: f64,
}

impl Origin {
    /// The series from the coefficients of its curvature.
    pub(crate) const fn new(compliance: f64, curvature: [f64; TERMS]) -> Origin {
        let mut half_approach = 0.0;
        let mut n = TERMS;
        while n > 0 {
            n -= 1;
            half_approach = 0.5 * half_approach + curvature[n] * INTEGRALS[n].1;
        }
        Origin { compliance, half_approach: 0.5 * compliance + 0.25 * half_approach, curvature }
    }

    pub fn sums(&self, tau: f64) -> NearOrigin {
        let (mut approach, mut compliance, mut curvature) = (0.0, 0.0, 0.0);
        for (coefficient, (once, twice)) in self.curvature.iter().zip(INTEGRALS.iter()).rev() {
            approach = approach * tau + coefficient * twice;
            compliance = compliance * tau + coefficient * once;
            curvature = curvature * tau + coefficient;
        }
        NearOrigin { approach: approach * tau * tau, compliance: compliance * tau, curvature }
    }

    /// e at τ: 4 Σ (n-1)/(n+1) h_n τⁿ⁺¹.
    fn dissipation(&self, tau: f64) -> f64 {
        let cubic =
            self.curvature.iter().zip(DISSIPATION.iter()).rev().fold(0.0, |sum, (c, factor)| sum * tau + c * factor);
        cubic * tau * tau * tau
    }

    /// de/dτ at τ: 4 Σ (n-1) h_n τⁿ.
    fn dissipation_slope(&self, tau: f64) -> f64 {
        let square = self.curvature.iter().zip(INTEGRALS.iter()).rev().enumerate();
        let square = square.fold(0.0, |sum, (k, (c, (_, twice)))| sum * tau + c * twice * (TERMS - k) as f64);
        4.0 * square * tau * tau
    }

    fn at_load(&self, load: Split, slip_approach: f64) -> Member {
        let sums = self.sums(load.lost);
        let lost = self.compliance * load.lost + sums.approach;
        Member { load, approach: Split { lost, rest: slip_approach - lost }, excess: sums.compliance, measure: None }
    }

    /// Halley's iteration from the root of the series' first two terms, which lies above the solution by less than 5 %.
    fn at_approach(&self, approach: Split) -> Member {
        let [first, ..] = self.curvature;
        let linear = self.compliance;
        let mut tau = 2.0 * approach.lost / (linear + (linear * linear + 2.0 * first * approach.lost).sqrt());
        let mut sums = self.sums(tau);
        for _ in 0..4 {
            let slope = linear + sums.compliance;
            let newton = (linear * tau + sums.approach - approach.lost) / slope;
            let step = newton / (1.0 - 0.5 * newton * sums.curvature / slope);
            tau -= step;
            sums = self.sums(tau);
            if step.abs() <= 1e-6 * tau {
                break;
            }
        }
        Member { load: Split { lost: tau, rest: 1.0 - tau }, approach, excess: sums.compliance, measure: None }
    }
}

/// What one and two integrations make of τⁿ: 1/(n+1) and 1/((n+1)(n+2)).
const INTEGRALS: [(f64, f64); TERMS] = {
    let mut table = [(0.0, 0.0); TERMS];
    let mut k = 0;
    while k < TERMS {
        let n = k as f64;
        table[k] = (1.0 / (n + 1.0), 1.0 / ((n + 1.0) * (n + 2.0)));
        k += 1;
    }
    table
};

/// What the energy makes of τⁿ in h'': 4 / ((n+2)(n+3)).
const DISSIPATION: [f64; TERMS] = {
    let mut table = [0.0; TERMS];
    let mut k = 0;
    while k < TERMS {
        let n = k as f64;
        table[k] = 4.0 / ((n + 2.0) * (n + 3.0));
        k += 1;
    }
    table
};
