//! The memory diagram in characteristic coordinates, and the step of Coulomb's law in it.
//!
//! With `u(S) = o + ∫ D dS` from the centre of the contact to S, the coordinates `ξ = u(S) - mu S` and `η = u(S) + mu S` turn the
//! diagram into a curve from (o, o) to the point of the whole contact, (u - mu S_b, u + mu S_b), on which ξ does not rise and η
//! does not fall because |D| <= mu. It is a polygon: its knots are stored from the centre outwards. A step to the point (ξ1, η1)
//! removes all knots outside the quadrant ξ > ξ1, η < η1:
//!
//! - none removed: the straight piece to the new point is appended, everything sticks;
//! - all removed: gross slip, the new diagram is one straight piece of slope ±mu, parallel to an axis;
//! - otherwise the polygon is cut where it leaves the quadrant, and closed by a line parallel to an axis: the slip zone.
//!
//! This covers a load that rises, falls or stays, slip of either direction, and its erasure by a falling load.

use crate::element::{Element, NormalState};
use crate::numerics::record::{record, records_mut};
use crate::numerics::slices::PanicFreeSlice;

record! {
    /// A knot of the diagram.
    pub(crate) struct Knot {
        pub xi: f64,
        pub eta: f64,
        /// Normal force of the size S of the knot.
        pub load: f64,
        /// Tangential force of the diagram up to the knot.
        pub force: f64,
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
        friction_coefficient * slope(inner.xi - self.xi, self.eta - inner.eta)
    }
}

/// D/mu of a piece by its lengths in both coordinates: exactly ±1 in a slip zone, which is parallel to an axis.
pub(crate) fn slope(falling: f64, rising: f64) -> f64 {
    match (falling > 0.0, rising > 0.0) {
        (false, false) => 0.0,
        (false, true) => 1.0,
        (true, false) => -1.0,
        (true, true) => (rising - falling) / (rising + falling).max(f64::MIN_POSITIVE),
    }
}

/// The results of a step: T, ∂T/∂u and ∂T/∂(input).
pub(crate) type DiagramForce = [f64; 3];

/// A diagram that a step changes.
pub(crate) trait Diagram {
    /// Knots from the centre outwards, at least one.
    fn knots(&self) -> &[Knot];

    /// Keeps the given number of knots from the centre outwards, and appends others.
    fn replace<const N: usize>(&mut self, kept: usize, new: [Knot; N]);
}

/// A diagram that is read only: its changes are discarded.
impl Diagram for &[Knot] {
    fn knots(&self) -> &[Knot] {
        self
    }

    fn replace<const N: usize>(&mut self, _: usize, _: [Knot; N]) {}
}

/// The end of a step: its point in characteristic coordinates, and the normal state there.
struct End {
    friction_coefficient: f64,
    xi: f64,
    eta: f64,
    normal: NormalState,
}

impl End {
    /// The outermost knot, within Coulomb's bound, which a sum of forces may exceed by rounding.
    fn knot(&self, force: f64) -> Knot {
        let (load, limit) = (self.normal.load, self.friction_coefficient * self.normal.load);
        let bounded = |force: f64| if force > limit { limit } else { force };
        Knot { xi: self.xi, eta: self.eta, load, force: -bounded(-bounded(force)) }
    }
}

/// The step to a closed contact with the given normal state at the displacement u.
pub(crate) fn step(
    element: &Element,
    diagram: &mut impl Diagram,
    displacement: f64,
    normal: &NormalState,
) -> DiagramForce {
    let mu = element.friction_coefficient;
    let (xi, eta) = (displacement - mu * normal.shift, displacement + mu * normal.shift);
    let end = End { friction_coefficient: mu, xi, eta, normal: *normal };
    let inside = |knot: &Knot| knot.xi > xi && knot.eta < eta;
    let knots = diagram.knots();
    let kept = knots.iter().rposition(inside).map_or(0, |last| last + 1);
    let (stays, beyond) = knots.split_at_checked(kept).unwrap_or((knots, &[]));
    match (stays.last().copied(), beyond.first().copied()) {
        (None, _) => slip_grossly(diagram, displacement, &end),
        (Some(inner), None) => stick(element, diagram, kept, &inner, &end),
        (Some(inner), Some(outer)) => cut(element, diagram, kept, [&inner, &outer], &end),
    }
}

/// Gross slip: one piece of slope ±mu.
fn slip_grossly(diagram: &mut impl Diagram, displacement: f64, end: &End) -> DiagramForce {
    let &End { friction_coefficient: mu, xi, eta, normal: NormalState { load, load_slope, .. } } = end;
    let knots = diagram.knots();
    let centre = knots.first().map_or(displacement, |knot| knot.xi);
    // A contact whose mu S is below the rounding of its displacement slips on in the direction of its last force.
    let before = knots.last().map_or(0.0, |knot| knot.force);
    let (slip_slope, origin) = match (centre <= xi, centre >= eta) {
        (true, true) => (if before == 0.0 { 0.0 } else { mu.copysign(before) }, xi),
        (true, false) => (mu, xi),
        _ => (-mu, eta),
    };
    let force = slip_slope * load;
    diagram.replace(0, [Knot::centre(origin), Knot { xi, eta, load, force }]);
    [force, 0.0, slip_slope * load_slope]
}

/// Everything sticks: a piece with D = Δu/ΔS from the outermost knot `inner`.
fn stick(element: &Element, diagram: &mut impl Diagram, kept: usize, inner: &Knot, end: &End) -> DiagramForce {
    let &End { friction_coefficient: mu, xi, eta, normal: NormalState { load, shift, load_slope, shift_slope } } = end;
    let (falling, rising) = (inner.xi - xi, eta - inner.eta);
    let per_shift = 1.0 / (rising + falling);
    let slope = mu * ((rising - falling) * per_shift);
    let rise = element.per_two_mu * (rising + falling);
    // The secant stiffness is the slope in the middle of the piece up to (rise/distance)²/24, with the distance from the
    // singularities of N(S), and a difference whose rounding errors are relative to the rise: the better one of both.
    let extent = inner.xi.abs().max(inner.eta.abs()).max(eta.abs()) * (2.0 * element.per_two_mu);
    let share = rise / shift.min(element.largest_shift - shift).max(rise);
    let secant = if share * share * rise < 24.0 * f64::EPSILON * extent {
        let (_, [stiffness]) = element.loads_at::<true, 1>(&[shift - 0.5 * rise]);
        stiffness
    } else {
        (load - inner.load) * (2.0 * mu * per_shift)
    };
    let end = end.knot(inner.force + slope * (load - inner.load));
    diagram.replace(kept, [end]);
    [end.force, secant, slope * (load_slope - secant * shift_slope)]
}

/// The piece from `inner` to `outer` leaves the quadrant through one of its sides, where a slip zone cuts it, or through its
/// corner.
fn cut(
    element: &Element,
    diagram: &mut impl Diagram,
    kept: usize,
    [inner, outer]: [&Knot; 2],
    end: &End,
) -> DiagramForce {
    let &End { friction_coefficient: mu, xi, eta, normal: NormalState { load, load_slope, shift_slope, .. } } = end;
    let (falling, rising) = (inner.xi - outer.xi, outer.eta - inner.eta);
    let [to_side, to_other] = match (falling > 0.0, rising > 0.0) {
        (true, true) => shares([inner.xi - xi, eta - inner.eta], [falling, rising]),
        // A slip zone, the common case, is parallel to one side: no division delays the table.
        (true, false) => [0.0, PAST_END],
        _ => [PAST_END, 0.0],
    };
    let slope = outer.slope_from(inner, mu);
    if to_side == to_other {
        // The contact recedes through the piece, or stays: nothing slips.
        let stays = (outer.xi, outer.eta) == (xi, eta);
        let end = end.knot(if stays { outer.force } else { inner.force + slope * (load - inner.load) });
        diagram.replace(kept, [end]);
        return [end.force, load_slope / shift_slope, 0.0];
    }
    let (cut_xi, cut_eta, slip_slope) = if to_side < to_other {
        (xi, inner.eta + rising * to_side, mu)
    } else {
        (inner.xi - falling * to_other, eta, -mu)
    };
    // A step to the same displacement changes no bit of the diagram.
    let at_outer = if slip_slope > 0.0 { outer.xi == xi } else { outer.eta == eta };
    let (cut_xi, cut_eta) = if at_outer { (outer.xi, outer.eta) } else { (cut_xi, cut_eta) };
    let cut_shift = (element.per_two_mu * (cut_eta - cut_xi)).max(0.0);
    let ([cut_load], [cut_stiffness]) = element.loads_at::<true, 1>(&[cut_shift]);
    let cut = if at_outer {
        *outer
    } else {
        let force = inner.force + slope * (cut_load - inner.load);
        Knot { xi: cut_xi, eta: cut_eta, load: cut_load, force }
    };
    let end = end.knot(cut.force + slip_slope * (load - cut.load));
    if cut.xi > xi || cut.eta < eta {
        diagram.replace(kept, [cut, end]);
    } else {
        diagram.replace(kept, [end]);
    }
    [end.force, cut_stiffness, slip_slope * (load_slope - cut_stiffness * shift_slope)]
}

/// A share that means: beyond the end of the piece.
const PAST_END: f64 = 2.0;

/// The shares of a piece up to both sides of the quadrant, from the distances of the sides and the lengths of the piece in both
/// coordinates.
#[cold]
#[inline(never)]
fn shares(distances: [f64; 2], lengths: [f64; 2]) -> [f64; 2] {
    // Numerator and divisor are selected before the division, because compilers divide before they compare (`numerics/guard.rs`),
    // and a distance over a subnormal length overflows.
    let share = |distance: f64, length: f64| {
        let (numerator, denominator) = if length >= distance { (distance, length) } else { (PAST_END, 1.0) };
        numerator / denominator
    };
    [share(distances[0], lengths[0]), share(distances[1], lengths[1])]
}

/// The diagram in a state, or in other memory of the caller.
pub(crate) struct Polygon<'a> {
    friction_coefficient: f64,
    knots: &'a mut [Knot],
    pub used: usize,
    /// Whether the last step has replaced all knots.
    pub anew: bool,
    /// Sum of the changes of the force at the knots beyond merged pieces.
    change: f64,
    /// Sum of the magnitudes of these changes: the bound on the error of the force.
    pub error: f64,
}

impl Diagram for Polygon<'_> {
    fn knots(&self) -> &[Knot] {
        self.knots.part(..self.used)
    }

    fn replace<const N: usize>(&mut self, kept: usize, new: [Knot; N]) {
        self.anew = kept == 0;
        self.used = kept;
        match self.knots.get_mut(kept..).and_then(<[_]>::first_chunk_mut) {
            Some(places) => {
                *places = new;
                self.used += N;
            }
            None => new.into_iter().for_each(|knot| self.push(knot)),
        }
    }
}

impl Polygon<'_> {
    pub fn new(friction_coefficient: f64, knots: &mut [f64], used: usize) -> Polygon<'_> {
        Polygon { friction_coefficient, knots: records_mut(knots), used, anew: false, change: 0.0, error: 0.0 }
    }

    /// Appends a knot; if there is no room, two pieces are merged.
    #[cold]
    #[inline(never)]
    pub fn push(&mut self, mut knot: Knot) {
        knot.force += self.change;
        if self.used == self.knots.len() {
            let change = self.merge(knot);
            self.change += change;
            self.error += change.abs();
            knot.force += change;
        }
        self.used += usize::from(self.knots.set(self.used, knot));
    }

    /// Removes the knot, the centre excepted, whose removal changes later forces least, and returns the change of the force beyond
    /// it.
    ///
    /// Without the knot B the pieces A-B and B-C become one: D its mean over S, which keeps the displacement of the diagram.
    /// Tangential forces beyond change by the integral of the change of D over N. This also bounds the change of all later forces:
    /// every size s is a slider of limit `mu (S_b - S)` that carries the displacement of the diagram from s to S_b with the weight
    /// d(1/K_t), two such sliders under one motion never move apart, and between A and C these displacements have changed in one
    /// direction.
    fn merge(&mut self, next: Knot) -> f64 {
        let knot = |index: usize| self.knots().get(index).copied().unwrap_or(next);
        let change_without = |index: usize| {
            let (inner, outer) = (knot(index - 1), knot(index + 1));
            let slope = outer.slope_from(&inner, self.friction_coefficient);
            inner.force + slope * (outer.load - inner.load) - outer.force
        };
        let (mut least, mut removed) = (f64::INFINITY, 0);
        for index in 1..self.used {
            let change = change_without(index);
            if change.abs() < least.abs() {
                (least, removed) = (change, index);
            }
        }
        if removed == 0 {
            return 0.0;
        }
        let outer = self.knots.part_mut(removed..self.used);
        for index in 1..outer.len() {
            let knot = outer.or_zero(index);
            outer.set(index - 1, Knot { force: knot.force + least, ..knot });
        }
        self.used -= 1;
        least
    }
}
