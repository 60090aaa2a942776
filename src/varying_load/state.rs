//! The state of an element in the caller's memory, and steps from it.
//!
//! ```text
//! [tag with the number of knots, displacement, normal component, N, S, dN/d(input), dS/d(input), force error,
//!      ξ, η, N and T of each knot, from the centre outwards]
//! ```

use crate::constant_load::contact::check_displacement;
use crate::error::Error;
use crate::tag::Kind;
use crate::varying_load::diagram::{self, Knot, Response};
use crate::varying_load::element::{Element, Normal};
use crate::varying_load::energy::{self, Path};

const HEADER: usize = 8;
const PER_KNOT: usize = 4;
/// Pieces that every state holds.
const MIN_PIECES: usize = 4;

/// Number of doubles in a state that holds `pieces` pieces of the diagram exactly; fewer than 4 count as 4.
#[must_use]
pub const fn state_length(pieces: usize) -> usize {
    let pieces = if pieces < MIN_PIECES { MIN_PIECES } else { pieces };
    // One knot more than pieces.
    pieces.saturating_add(1).saturating_mul(PER_KNOT).saturating_add(HEADER)
}

/// Result of a step: forces `[T, N]`, tangent `[∂T/∂u, ∂N/∂u, ∂T/∂w, ∂N/∂w]` (column-major) and dissipated energy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// `[T, N]` \[N\].
    pub force: [f64; 2],
    /// Columns by tangential displacement and by normal component.
    pub tangent: [f64; 4],
    /// \[J\]; 0 unless requested.
    pub dissipated: f64,
}

/// Initialises a state: open, at displacement 0 and normal component 0.
///
/// # Errors
/// `StateTooShort` for fewer than [`state_length`]`(0)` doubles.
pub fn state_init(state: &mut [f64]) -> Result<(), Error> {
    if state.len() < state_length(0) {
        return Err(Error::StateTooShort);
    }
    state.fill(0.0);
    write_tag(state, 1);
    Ok(())
}

fn write_tag(state: &mut [f64], knots: usize) {
    if let Some(tag) = state.first_mut() {
        *tag = Kind::ElementState.tag(knots);
    }
}

/// Checks the length, the tag and the number of knots of a state.
///
/// # Errors
/// `StateTooShort` for fewer than [`state_length`]`(0)` doubles; `BadState` for an array that is no state of that length.
#[inline(always)]
pub(crate) fn check_header(state: &[f64]) -> Result<(), Error> {
    if state.len() < state_length(0) {
        return Err(Error::StateTooShort);
    }
    match Kind::ElementState.count(state.first().copied().unwrap_or(0.0)) {
        Some(knots) if knots > 0 && HEADER + PER_KNOT * knots <= state.len() => Ok(()),
        _ => Err(Error::BadState),
    }
}

/// A bound on the error of the force \[N\] from merging pieces; 0 while nothing was merged.
#[must_use]
pub fn force_error(state: &[f64]) -> f64 {
    state.get(ERROR).copied().unwrap_or(0.0)
}

const ERROR: usize = 7;

/// A state whose header was checked.
struct View<'a> {
    displacement: f64,
    input: f64,
    normal: Normal,
    error: f64,
    knots: &'a [[f64; PER_KNOT]],
}

fn view(state: &[f64]) -> View<'_> {
    let (&[tag, displacement, input, load, shift, load_slope, shift_slope, error], knots) =
        state.split_first_chunk().unwrap_or((&[0.0; HEADER], &[]));
    let used = Kind::ElementState.count(tag).unwrap_or(0);
    let knots = knots.as_chunks().0;
    View {
        displacement,
        input,
        normal: Normal { load, shift, load_slope, shift_slope },
        error,
        knots: knots.get(..used).unwrap_or(knots),
    }
}

/// A step, with what it changes in the state.
pub(crate) struct Update {
    pub step: Step,
    header: [f64; HEADER - 1],
    /// Knots of the old state that stay, and the new ones.
    kept: usize,
    new: [Knot; 3],
    count: usize,
    friction_coefficient: f64,
}

/// Computes a step from a state whose header was checked.
///
/// # Errors
/// `BadDisplacement` or `BadNormalForce` for a component that is not allowed.
pub(crate) fn update(
    element: &Element,
    state: &[f64],
    [displacement, input]: [f64; 2],
    with_energy: bool,
) -> Result<Update, Error> {
    check_displacement(displacement)?;
    element.check_input(input)?;
    let old = view(state);
    let closed = input > 0.0;
    let normal = if !closed {
        Normal::OPEN
    } else if input.to_bits() == old.input.to_bits() {
        old.normal
    } else {
        element.normal(input)
    };
    let header = |error| {
        let Normal { load, shift, load_slope, shift_slope } = normal;
        [displacement, input, load, shift, load_slope, shift_slope, error]
    };
    let friction_coefficient = element.friction_coefficient;
    let without_friction = friction_coefficient == 0.0;
    let crossing = |start: f64| {
        // The straight path passes N = 0 at this displacement.
        let fraction = if element.by_approach() { old.input / (old.input - input) } else { start };
        old.displacement + fraction * (displacement - old.displacement)
    };
    if !closed || without_friction {
        let dissipated = if with_energy && old.normal.load > 0.0 && !without_friction {
            let path = Path { shift: [old.normal.shift, 0.0], displacement: crossing(1.0) - old.displacement };
            energy::dissipated(element, old.knots, &path)
        } else {
            0.0
        };
        let step = Step {
            force: [0.0, normal.load],
            tangent: [0.0, 0.0, 0.0, if closed { normal.load_slope } else { 0.0 }],
            dissipated,
        };
        let new = [Knot::centre(displacement); 3];
        return Ok(Update { step, header: header(0.0), kept: 0, new, count: 1, friction_coefficient });
    }
    let closing = old.normal.load <= 0.0;
    let touch: [f64; PER_KNOT];
    let touching: [[f64; PER_KNOT]; 1];
    let (knots, start) = if closing {
        let start = crossing(0.0);
        touch = Knot::centre(start).into();
        touching = [touch];
        (&touching[..], start)
    } else {
        (old.knots, old.displacement)
    };
    let change = diagram::step(element, knots, displacement, &normal);
    let Response { force, by_displacement, mut by_input } = change.response;
    let mut by_displacement = by_displacement;
    if closing && change.kept > 0 && element.by_approach() {
        // The start of the path moves with its end.
        let distance = input - old.input;
        by_input += by_displacement * (displacement - old.displacement) * -old.input / (distance * distance);
        by_displacement *= input / distance;
    }
    let dissipated = if with_energy {
        let path = Path {
            shift: [if closing { 0.0 } else { old.normal.shift }, normal.shift],
            displacement: displacement - start,
        };
        energy::dissipated(element, knots, &path)
    } else {
        0.0
    };
    let step =
        Step { force: [force, normal.load], tangent: [by_displacement, 0.0, by_input, normal.load_slope], dissipated };
    let first = change.centre.or((closing).then_some(Knot::centre(start)));
    let kept = if first.is_some() { 0 } else { change.kept };
    let mut new = [change.end; 3];
    let mut count = 0;
    for knot in [first, change.cut, Some(change.end)].into_iter().flatten() {
        if let Some(place) = new.get_mut(count) {
            *place = knot;
            count += 1;
        }
    }
    Ok(Update { step, header: header(if kept == 0 { 0.0 } else { old.error }), kept, new, count, friction_coefficient })
}

impl Update {
    /// Writes the new state; `old` is the state that the step started from, of the same length, or `None` if it is in `new`
    /// already.
    pub fn write(mut self, old: Option<&[f64]>, new: &mut [f64]) {
        if let Some(old) = old {
            let used = HEADER + PER_KNOT * self.kept;
            if let (Some(new), Some(old)) = (new.get_mut(HEADER..used), old.get(HEADER..used)) {
                new.copy_from_slice(old);
            }
        }
        let Some((header, knots)) = new.split_first_chunk_mut::<HEADER>() else { return };
        let knots = knots.as_chunks_mut::<PER_KNOT>().0;
        let mut kept = self.kept;
        let mut error = 0.0;
        while kept + self.count > knots.len() {
            let Some(change) = merge(self.friction_coefficient, knots, &mut kept, self.new[0]) else { return };
            self.new.iter_mut().for_each(|knot| knot.force += change);
            error += change.abs();
        }
        for (place, knot) in knots.iter_mut().skip(kept).zip(self.new.iter().take(self.count)) {
            *place = (*knot).into();
        }
        let [_, rest @ ..] = header;
        *rest = self.header;
        rest[HEADER - 2] += error;
        header[0] = Kind::ElementState.tag(kept + self.count);
    }
}

/// Removes the knot among the first `kept`, the centre excepted, whose removal changes later forces least, and returns the change
/// of the force beyond it.
///
/// Without the knot B the pieces A-B and B-C become one: D its mean over S, which keeps the displacement of the diagram.
/// Tangential forces beyond change by the integral of the change of D over N. This also bounds the change of all later forces:
/// every size s is a slider of limit `mu (S_b - S)` that carries the displacement of the diagram from s to S_b with the weight
/// d(1/K_t), two such sliders under one motion never move apart, and between A and C these displacements have changed in one
/// direction.
#[cold]
fn merge(friction_coefficient: f64, knots: &mut [[f64; PER_KNOT]], kept: &mut usize, next: Knot) -> Option<f64> {
    let knot = |index: usize| knots.get(index).filter(|_| index < *kept).copied().map_or(next, Knot::from);
    let change_without = |index: usize| {
        let (inner, outer) = (knot(index - 1), knot(index + 1));
        let slope = outer.slope_from(&inner, friction_coefficient);
        inner.force + slope * (outer.load - inner.load) - outer.force
    };
    let (index, change) = (1..*kept)
        .map(|index| (index, change_without(index)))
        .min_by(|one, other| one.1.abs().total_cmp(&other.1.abs()))?;
    knots.copy_within(index + 1..*kept, index);
    *kept -= 1;
    for [.., force] in knots.iter_mut().take(*kept).skip(index) {
        *force += change;
    }
    Some(change)
}

/// A step in place.
///
/// # Errors
/// `StateTooShort`, `BadState`, `BadDisplacement` or `BadNormalForce`.
pub fn advance(element: &Element, state: &mut [f64], displacement: [f64; 2], with_energy: bool) -> Result<Step, Error> {
    check_header(state)?;
    let update = update(element, state, displacement, with_energy)?;
    let step = update.step;
    update.write(None, state);
    Ok(step)
}
