//! The state of an element in the caller's memory, and steps from it.
//!
//! ```text
//! [tag with the number of knots, displacement, normal component, N, S, dN/d(input), dS/d(input), force error,
//!      ξ, η, N and T of each knot, from the centre outwards]
//! ```

use crate::constant_load::contact::check_displacement;
use crate::error::Error;
use crate::numerics::fp_class::is_finite;
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
pub(crate) struct View<'a> {
    pub displacement: f64,
    input: f64,
    pub normal: Normal,
    error: f64,
    pub knots: &'a [[f64; PER_KNOT]],
}

pub(crate) fn view(state: &[f64]) -> View<'_> {
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
    check_step(element, &[displacement, input])?;
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
    // Not by the load, which a tiny approach may round to 0.
    let closing = old.input <= 0.0;
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
        by_input += by_displacement * ((displacement - old.displacement) / distance) * (-old.input / distance);
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
    #[inline(always)]
    pub fn write(self, old: Option<&[f64]>, new: &mut [f64]) {
        if let Some(old) = old {
            let used = HEADER + PER_KNOT * self.kept;
            if let (Some(new), Some(old)) = (new.get_mut(HEADER..used), old.get(HEADER..used)) {
                new.copy_from_slice(old);
            }
        }
        let Some((header, knots)) = new.split_first_chunk_mut::<HEADER>() else { return };
        let mut polygon = Polygon::new(self.friction_coefficient, knots, self.kept);
        self.new.into_iter().take(self.count).for_each(|knot| polygon.push(knot));
        let [tag, rest @ ..] = header;
        *tag = Kind::ElementState.tag(polygon.used);
        *rest = self.header;
        rest[HEADER - 2] += polygon.error;
    }
}

/// The knots of a state, while some are appended.
struct Polygon<'a> {
    friction_coefficient: f64,
    knots: &'a mut [[f64; PER_KNOT]],
    used: usize,
    /// Change of the force beyond merged pieces.
    change: f64,
    /// Sum of the magnitudes of these changes.
    error: f64,
}

impl Polygon<'_> {
    fn new(friction_coefficient: f64, knots: &mut [f64], used: usize) -> Polygon<'_> {
        Polygon { friction_coefficient, knots: knots.as_chunks_mut().0, used, change: 0.0, error: 0.0 }
    }

    /// Appends a knot, in place of another one if there is no room.
    #[inline(always)]
    fn push(&mut self, mut knot: Knot) {
        knot.force += self.change;
        if self.used == self.knots.len() {
            let change = self.merge(knot);
            self.change += change;
            self.error += change.abs();
            knot.force += change;
        }
        if let Some(place) = self.knots.get_mut(self.used) {
            *place = knot.into();
            self.used += 1;
        }
    }

    /// Removes the knot, the centre excepted, whose removal changes later forces least, and returns the change of the force beyond it.
    ///
    /// Without the knot B the pieces A-B and B-C become one: D its mean over S, which keeps the displacement of the diagram.
    /// Tangential forces beyond change by the integral of the change of D over N. This also bounds the change of all later forces:
    /// every size s is a slider of limit `mu (S_b - S)` that carries the displacement of the diagram from s to S_b with the weight
    /// d(1/K_t), two such sliders under one motion never move apart, and between A and C these displacements have changed in one
    /// direction.
    #[cold]
    #[inline(never)]
    fn merge(&mut self, next: Knot) -> f64 {
        let knot = |index: usize| {
            if index < self.used { self.knots.get(index).copied().map_or(next, Knot::from) } else { next }
        };
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
        let outer = self.knots.get_mut(removed..self.used).unwrap_or(&mut []);
        for index in 1..outer.len() {
            if let Some(&[xi, eta, load, force]) = outer.get(index)
                && let Some(place) = outer.get_mut(index - 1)
            {
                *place = [xi, eta, load, force + least];
            }
        }
        self.used -= 1;
        least
    }
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

/// Copies a state whose header was checked into one that may hold fewer pieces.
pub(crate) fn copy(element: &Element, from: &[f64], to: &mut [f64]) {
    let (Some((header, target)), Some(source)) = (to.split_first_chunk_mut::<HEADER>(), from.first_chunk::<HEADER>())
    else {
        return;
    };
    let mut polygon = Polygon::new(element.friction_coefficient, target, 0);
    view(from).knots.iter().for_each(|knot| polygon.push((*knot).into()));
    *header = *source;
    header[0] = Kind::ElementState.tag(polygon.used);
    header[ERROR] += polygon.error;
}

/// Validates a state in full: finite values, a monotone polygon from the centre to the present point. For states from outside the
/// process.
///
/// # Errors
/// `StateTooShort`; `BadState` for an array that was not initialised, or whose values no history leads to.
pub fn state_check(state: &[f64]) -> Result<(), Error> {
    check_header(state)?;
    let View { displacement, input, normal, error, knots } = view(state);
    let Normal { load, shift, load_slope, shift_slope } = normal;
    let finite =
        [displacement, input, load, shift, load_slope, shift_slope, error].iter().all(|value| is_finite(*value))
            && knots.as_flattened().iter().all(|value| is_finite(*value));
    if !finite || error < 0.0 || [load, shift, load_slope, shift_slope].iter().any(|value| *value < 0.0) {
        return Err(Error::BadState);
    }
    let (Some([xi, eta, first, _]), Some([last_xi, last_eta, last, _])) = (knots.first(), knots.last()) else {
        return Err(Error::BadState);
    };
    // A knot is located by ξ and η: its load has their rounding errors, relative to the size of the contact.
    let rounding = 16.0 * f64::EPSILON * last_xi.abs().max(last_eta.abs()) * load;
    let (size, allowed) = (0.5 * (last_eta - last_xi), rounding.min(f64::MAX));
    let monotone = |pair: &[[f64; PER_KNOT]]| match pair {
        [[xi, eta, inner, _], [next_xi, next_eta, outer, _]] => {
            next_xi <= xi && next_eta >= eta && (inner - outer).max(0.0) * size <= allowed
        }
        _ => true,
    };
    let centred = xi == eta && *first == 0.0 && *last <= load;
    // A frictionless or an open contact is its centre.
    let complete = knots.len() == 1 || (*last == load && *last_xi <= displacement && *last_eta >= displacement);
    if centred && complete && knots.windows(2).all(monotone) { Ok(()) } else { Err(Error::BadState) }
}

/// Pieces of the copy of a state that is discarded after a path.
const PIECES_OF_COPY: usize = 256;

/// Outputs of a path: `[T, N]`, tangents and energies, step after step; `None` is not computed.
#[derive(Debug)]
pub struct PathOutput<'a> {
    /// Two doubles per step \[N\].
    pub force: Option<&'a mut [f64]>,
    /// Four doubles per step.
    pub tangent: Option<&'a mut [f64]>,
    /// One double per step \[J\].
    pub dissipated: Option<&'a mut [f64]>,
}

/// Checks a path: two doubles per step.
///
/// # Errors
/// `BadDisplacement` or `BadNormalForce`.
pub(crate) fn check_path(element: &Element, path: &[f64]) -> Result<(), Error> {
    path.as_chunks().0.iter().try_for_each(|displacement| check_step(element, displacement))
}

/// # Errors
/// `BadDisplacement` or `BadNormalForce`.
#[inline(always)]
pub(crate) fn check_step(element: &Element, &[displacement, input]: &[f64; 2]) -> Result<(), Error> {
    check_displacement(displacement)?;
    element.check_input(input)
}

/// Advances a state through displacements, two doubles per step, that were checked.
///
/// # Errors
/// `StateTooShort` or `BadState`, and those of [`check_path`]; the state is unchanged then.
pub fn path(element: &Element, state: &mut [f64], path: &[f64], output: PathOutput) -> Result<(), Error> {
    check_header(state)?;
    check_path(element, path)?;
    let PathOutput { force, tangent, dissipated } = output;
    let with_energy = dissipated.is_some();
    let mut forces = force.unwrap_or(&mut []).as_chunks_mut().0.iter_mut();
    let mut tangents = tangent.unwrap_or(&mut []).as_chunks_mut().0.iter_mut();
    let mut energies = dissipated.unwrap_or(&mut []).iter_mut();
    for displacement in path.as_chunks().0 {
        let step = advance(element, state, *displacement, with_energy)?;
        forces.next().into_iter().for_each(|force| *force = step.force);
        tangents.next().into_iter().for_each(|tangent| *tangent = step.tangent);
        energies.next().into_iter().for_each(|energy| *energy = step.dissipated);
    }
    Ok(())
}

/// As [`path`], from a copy of the state that holds at most 256 pieces exactly.
pub(crate) fn path_in_copy(element: &Element, state: &[f64], steps: &[f64], output: PathOutput) -> Result<(), Error> {
    let mut buffer = [0.0; state_length(PIECES_OF_COPY)];
    copy(element, state, &mut buffer);
    path(element, &mut buffer, steps, output)
}
