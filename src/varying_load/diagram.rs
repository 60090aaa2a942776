//! The memory diagram in characteristic coordinates, and the step of Coulomb's law in it.
//!
//! With `P(S) = o + ∫ D dS` from the centre of the contact to S, the coordinates `ξ = P - mu S` and `η = P + mu S` turn the
//! diagram into a curve from (o, o) to the point of the whole contact, (u - mu S_b, u + mu S_b), on which ξ does not rise and η
//! does not fall because |D| <= mu. It is a polygon: its knots are stored from the centre outwards. A step to the point (ξ1, η1)
//! removes all knots outside the quadrant ξ > ξ1, η < η1:
//!
//! - none removed: the straight piece to the new point is appended, everything sticks;
//! - all removed: gross slip, the new diagram is one straight piece of slope ±mu, parallel to an axis;
//! - otherwise the polygon is cut where it leaves the quadrant, and closed by a line parallel to an axis: the slip zone.
//!
//! This covers a load that rises, falls or stays, slip of either direction, and its erasure by a falling load.

use crate::varying_load::element::{Element, Normal};

/// A knot of the diagram.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Knot {
    pub xi: f64,
    pub eta: f64,
    /// Normal force of the size S of the knot.
    pub load: f64,
    /// Tangential force of the diagram up to the knot.
    pub force: f64,
}

impl From<[f64; 4]> for Knot {
    fn from([xi, eta, load, force]: [f64; 4]) -> Knot {
        Knot { xi, eta, load, force }
    }
}

impl From<Knot> for [f64; 4] {
    fn from(Knot { xi, eta, load, force }: Knot) -> [f64; 4] {
        [xi, eta, load, force]
    }
}

impl Knot {
    /// The centre of the contact: the displacement at which the diagram starts.
    pub const fn centre(displacement: f64) -> Knot {
        Knot { xi: displacement, eta: displacement, load: 0.0, force: 0.0 }
    }

    /// S.
    pub fn shift(&self, friction_coefficient: f64) -> f64 {
        0.5 * (self.eta - self.xi) / friction_coefficient
    }

    /// D of the piece that ends at this knot.
    pub fn slope_from(&self, inner: &Knot, friction_coefficient: f64) -> f64 {
        let (falling, rising) = (inner.xi - self.xi, self.eta - inner.eta);
        // Exactly ±mu in a slip zone, which is parallel to an axis.
        if falling <= 0.0 && rising <= 0.0 {
            0.0
        } else if falling <= 0.0 {
            friction_coefficient
        } else if rising <= 0.0 {
            -friction_coefficient
        } else {
            friction_coefficient * ((rising - falling) / (rising + falling))
        }
    }
}

/// Force and derivatives at the end of a step: ∂T/∂u and ∂T/∂(input).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Response {
    pub force: f64,
    pub by_displacement: f64,
    pub by_input: f64,
}

/// What replaces the outer part of a diagram: the knots that stay, and up to two new ones.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Change {
    /// Number of knots that stay.
    pub kept: usize,
    /// New knots; the first only if there is a slip zone.
    pub cut: Option<Knot>,
    pub end: Knot,
    /// The new centre in gross slip.
    pub centre: Option<Knot>,
    pub response: Response,
}

/// The step to a closed contact with the given normal state at the displacement u: `knots` is not empty, from the centre outwards.
#[inline(always)]
pub(crate) fn step(element: &Element, knots: &[[f64; 4]], displacement: f64, normal: &Normal) -> Change {
    let mu = element.friction_coefficient;
    let Normal { load, shift, load_slope, shift_slope } = *normal;
    let (xi, eta) = (displacement - mu * shift, displacement + mu * shift);
    let stiffness = normal.tangential_stiffness();
    // Coulomb's bound, of which a sum of forces may be off by rounding.
    let bounded = |force: f64| force.max(-mu * load).min(mu * load);
    let knot = |index: usize| knots.get(index).copied().map(Knot::from);
    let inside = |&[knot_xi, knot_eta, ..]: &[f64; 4]| knot_xi > xi && knot_eta < eta;
    let kept = knots.iter().rposition(inside).map_or(0, |last| last + 1);
    let Some(inner) = kept.checked_sub(1).and_then(knot) else {
        let centre = knot(0).map_or(displacement, |centre| centre.xi);
        // A size below the rounding of displacements keeps the direction of its slip.
        let before = knots.last().map_or(0.0, |&[.., force]| force);
        let (forward, backward) = (centre <= xi, centre >= eta);
        let (sign, origin) = match (forward, backward) {
            (true, true) => (if before == 0.0 { 0.0 } else { mu.copysign(before) }, xi),
            (true, false) => (mu, xi),
            _ => (-mu, eta),
        };
        let response = Response { force: sign * load, by_displacement: 0.0, by_input: sign * load_slope };
        let end = Knot { xi, eta, load, force: response.force };
        return Change { kept: 0, cut: None, end, centre: Some(Knot::centre(origin)), response };
    };
    let Some(outer) = knot(kept) else {
        // Everything sticks: a piece with D = Δu/ΔS.
        let (falling, rising) = (inner.xi - xi, eta - inner.eta);
        let slope = mu * ((rising - falling) / (rising + falling));
        let rise = 0.5 * (rising + falling) / mu;
        // The secant stiffness is the slope in the middle of the piece up to (rise/distance)²/24, with the distance from the singularities
        // of N(S), and a difference whose rounding errors are relative to the rise: the better one of both.
        let reach = inner.xi.abs().max(inner.eta.abs()).max(eta.abs()) / mu;
        let share = rise / shift.min(element.largest_shift - shift).max(rise);
        let secant = if share * share * rise < 24.0 * f64::EPSILON * reach {
            element.load_at_shift(shift - 0.5 * rise).1
        } else {
            (load - inner.load) / rise
        };
        let force = bounded(inner.force + slope * (load - inner.load));
        let by_input = slope * (stiffness - secant) * shift_slope;
        let response = Response { force, by_displacement: secant, by_input };
        return Change { kept, cut: None, end: Knot { xi, eta, load, force }, centre: None, response };
    };
    // The piece from `inner` to `outer` leaves the quadrant through one of its sides, or through its corner.
    let (falling, rising) = (inner.xi - outer.xi, outer.eta - inner.eta);
    let (to_xi, to_eta) = (inner.xi - xi, eta - inner.eta);
    // Shares of the piece up to both sides; beyond its end if one is not reached.
    let share = |distance: f64, length: f64| if length >= distance { distance / length } else { 2.0 };
    let (to_side, to_other) = (share(to_xi, falling), share(to_eta, rising));
    let slope = outer.slope_from(&inner, mu);
    if to_side == to_other {
        // The contact recedes through the piece, or stays: nothing slips.
        let stays = (outer.xi, outer.eta) == (xi, eta);
        let force = bounded(if stays { outer.force } else { inner.force + slope * (load - inner.load) });
        let response = Response { force, by_displacement: stiffness, by_input: 0.0 };
        return Change { kept, cut: None, end: Knot { xi, eta, load, force }, centre: None, response };
    }
    let forward = to_side < to_other;
    let (cut_xi, cut_eta, sign) =
        if forward { (xi, inner.eta + rising * to_side, mu) } else { (inner.xi - falling * to_other, eta, -mu) };
    // A step to the same displacement changes nothing, to the bit.
    let at_outer = if forward { outer.xi == xi } else { outer.eta == eta };
    let cut_eta = if at_outer { outer.eta } else { cut_eta };
    let cut_xi = if at_outer { outer.xi } else { cut_xi };
    let (cut_load, cut_stiffness) = element.load_at_shift((0.5 * (cut_eta - cut_xi) / mu).max(0.0));
    let cut = if at_outer {
        outer
    } else {
        let force = inner.force + slope * (cut_load - inner.load);
        Knot { xi: cut_xi, eta: cut_eta, load: cut_load, force }
    };
    let force = bounded(cut.force + sign * (load - cut.load));
    let response =
        Response { force, by_displacement: cut_stiffness, by_input: sign * (stiffness - cut_stiffness) * shift_slope };
    let cut = (cut.xi > xi || cut.eta < eta).then_some(cut);
    Change { kept, cut, end: Knot { xi, eta, load, force }, centre: None, response }
}
