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
use crate::varying_load::diagram::{self, Diagram, Knot, Response};
use crate::varying_load::element::{Element, Normal};
use crate::varying_load::energy::{self, Path};
use crate::varying_load::path::{self, advance_along};

pub use crate::varying_load::path::PathOutput;

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
pub type Step = path::StepResult<[f64; 2], [f64; 4]>;

impl Step {
    const NONE: Step = Step { force: [0.0; 2], tangent: [0.0; 4], dissipated: 0.0 };
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
    if let Some(tag) = state.first_mut() {
        *tag = Kind::ElementState.tag(1);
    }
    Ok(())
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
    check_tag(state.first().copied().unwrap_or(0.0), state.len())
}

/// Rejects the tag of what is no state of that length.
#[inline(always)]
pub(crate) fn check_tag(tag: f64, state_length: usize) -> Result<(), Error> {
    match Kind::ElementState.count(tag) {
        Some(knots) if knots > 0 && HEADER + PER_KNOT * knots <= state_length => Ok(()),
        _ => Err(Error::BadState),
    }
}

/// A bound on the error of the force \[N\] from merging pieces; 0 while nothing was merged.
#[must_use]
pub fn force_error(state: &[f64]) -> f64 {
    state.get(ERROR).copied().unwrap_or(0.0)
}

const ERROR: usize = 7;

/// Values in the header of a state.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Point {
    pub displacement: f64,
    pub input: f64,
    pub normal: Normal,
    pub error: f64,
}

impl Point {
    #[inline(always)]
    fn read(&[_, displacement, input, load, shift, load_slope, shift_slope, error]: &[f64; HEADER]) -> Point {
        Point { displacement, input, normal: Normal { load, shift, load_slope, shift_slope }, error }
    }

    #[inline(always)]
    fn write(&self, used: usize, header: &mut [f64; HEADER]) {
        let Point { displacement, input, normal: Normal { load, shift, load_slope, shift_slope }, error } = *self;
        let tag = Kind::ElementState.tag(used);
        *header = [tag, displacement, input, load, shift, load_slope, shift_slope, error];
    }
}

/// A state whose header was checked: the tangential displacement, the normal force, and the knots.
pub(crate) struct View<'a> {
    pub displacement: f64,
    pub input: f64,
    pub load: f64,
    pub shift: f64,
    pub knots: &'a [[f64; PER_KNOT]],
}

pub(crate) fn view(state: &[f64]) -> View<'_> {
    let (header, knots) = parts(state);
    let Point { displacement, input, normal, .. } = Point::read(header);
    View { displacement, input, load: normal.load, shift: normal.shift, knots }
}

/// Header and knots in use of a state whose header was checked.
#[inline(always)]
fn parts(state: &[f64]) -> (&[f64; HEADER], &[[f64; PER_KNOT]]) {
    let (header, knots) = state.split_first_chunk().unwrap_or((&[0.0; HEADER], &[]));
    let used = Kind::ElementState.count(header[0]).unwrap_or(0);
    let knots = knots.as_chunks().0;
    (header, knots.get(..used).unwrap_or(knots))
}

/// A step to a displacement that was checked, from a point and its diagram. Returns the step and the new point.
#[inline(always)]
pub(crate) fn step(
    element: &Element,
    from: &Point,
    diagram: &mut impl Diagram,
    [displacement, input]: [f64; 2],
    with_energy: bool,
) -> (Step, Point) {
    if !(element.is_closed(input) && from.normal.load > 0.0 && element.friction_coefficient > 0.0) {
        return opening_or_closing(element, from, diagram, [displacement, input], with_energy);
    }
    let normal = if input.to_bits() == from.input.to_bits() { from.normal } else { element.normal(input) };
    let dissipated = if with_energy {
        let shift = [from.normal.shift, normal.shift];
        energy::dissipated(element, diagram.knots(), &Path { shift, displacement: displacement - from.displacement })
    } else {
        0.0
    };
    let Response { force, by_displacement, by_input } = diagram::step(element, diagram, displacement, &normal);
    let tangent = [by_displacement, 0.0, by_input, normal.load_slope];
    let step = Step { force: [force, normal.load], tangent, dissipated };
    (step, Point { displacement, input, normal, error: from.error })
}

/// A step from or to an open contact, and every step without friction: the diagram starts anew.
#[inline(never)]
fn opening_or_closing(
    element: &Element,
    from: &Point,
    diagram: &mut impl Diagram,
    [displacement, input]: [f64; 2],
    with_energy: bool,
) -> (Step, Point) {
    let friction = element.friction_coefficient > 0.0;
    let (was_closed, closed) = (from.normal.load > 0.0, element.is_closed(input));
    let normal = if closed { element.normal(input) } else { Normal::OPEN };
    let to = Point { displacement, input, normal, error: 0.0 };
    // The straight path passes N = 0 at this fraction; with the force as input at its open end.
    let start = if was_closed { from.input } else { from.input.min(0.0) };
    let end = if closed { input } else { input.min(0.0) };
    let fraction = match (was_closed, closed) {
        (true, false) | (false, true) if element.by_approach() => start / (start - end),
        (true, false) => 1.0,
        _ => 0.0,
    };
    let crossing = from.displacement + fraction * (displacement - from.displacement);
    let mut step = Step { force: [0.0, normal.load], tangent: [0.0, 0.0, 0.0, normal.load_slope], dissipated: 0.0 };
    if !closed || !friction {
        if with_energy && was_closed && friction {
            let path = Path { shift: [from.normal.shift, 0.0], displacement: crossing - from.displacement };
            step.dissipated = energy::dissipated(element, diagram.knots(), &path);
        }
        diagram.replace(0, [Knot::centre(displacement)]);
        return (step, to);
    }
    let centre = Knot::centre(crossing);
    let mut touching = Touching { knots: [centre.into()], sticks: false, diagram };
    if with_energy {
        let path = Path { shift: [0.0, normal.shift], displacement: displacement - crossing };
        step.dissipated = energy::dissipated(element, &touching.knots, &path);
    }
    let Response { force, mut by_displacement, mut by_input } =
        diagram::step(element, &mut touching, displacement, &normal);
    if touching.sticks && element.by_approach() {
        // The start of the path moves with its end.
        let distance = end - start;
        by_input -= by_displacement * ((displacement - from.displacement) / distance) * (start / distance);
        by_displacement *= end / distance;
    }
    step.force[0] = force;
    (step.tangent[0], step.tangent[2]) = (by_displacement, by_input);
    (step, to)
}

/// The diagram at first touch: its centre, not yet in the diagram that it replaces.
struct Touching<'a, D> {
    knots: [[f64; PER_KNOT]; 1],
    /// Whether the contact sticks to the displacement at which it closed.
    sticks: bool,
    diagram: &'a mut D,
}

impl<D: Diagram> Diagram for Touching<'_, D> {
    fn knots(&self) -> &[[f64; PER_KNOT]] {
        &self.knots
    }

    fn replace<const N: usize>(&mut self, kept: usize, new: [Knot; N]) {
        self.sticks = kept > 0;
        match new[..] {
            [end] if self.sticks => self.diagram.replace(0, [self.knots[0].into(), end]),
            _ => self.diagram.replace(0, new),
        }
    }
}

/// A step in place, with a state and a displacement that were checked.
#[inline(always)]
pub(crate) fn advance_checked(element: &Element, state: &mut [f64], displacement: [f64; 2], with_energy: bool) -> Step {
    let Some((header, knots)) = state.split_first_chunk_mut::<HEADER>() else { return Step::NONE };
    let used = Kind::ElementState.count(header[0]).unwrap_or(0);
    let mut polygon = Polygon::new(element.friction_coefficient, knots, used);
    let (step, mut to) = step(element, &Point::read(header), &mut polygon, displacement, with_energy);
    to.error = if polygon.anew { polygon.error } else { to.error + polygon.error };
    to.write(polygon.used, header);
    step
}

/// A step whose new state is discarded, with a state and a displacement that were checked.
#[inline(always)]
pub(crate) fn trial(element: &Element, state: &[f64], displacement: [f64; 2], with_energy: bool) -> Step {
    let (header, mut knots) = parts(state);
    step(element, &Point::read(header), &mut knots, displacement, with_energy).0
}

/// Copies what is in use of a state whose header was checked to one of the same length.
#[inline(always)]
pub(crate) fn copy_used(from: &[f64], to: &mut [f64]) {
    let used = HEADER + PER_KNOT * parts(from).1.len();
    if let (Some(from), Some(to)) = (from.get(..used), to.get_mut(..used)) {
        to.copy_from_slice(from);
    }
}

/// The diagram in a state, or in other memory of the caller.
pub(crate) struct Polygon<'a> {
    friction_coefficient: f64,
    knots: &'a mut [[f64; PER_KNOT]],
    used: usize,
    /// Whether no piece of the old diagram is left.
    anew: bool,
    /// Change of the force beyond merged pieces.
    change: f64,
    /// Sum of the magnitudes of these changes.
    error: f64,
}

impl Diagram for Polygon<'_> {
    #[inline(always)]
    fn knots(&self) -> &[[f64; PER_KNOT]] {
        self.knots.get(..self.used).unwrap_or(&[])
    }

    #[inline(always)]
    fn replace<const N: usize>(&mut self, kept: usize, new: [Knot; N]) {
        self.anew = kept == 0;
        self.used = kept;
        match self.knots.get_mut(kept..).and_then(<[_]>::first_chunk_mut) {
            Some(places) => {
                *places = new.map(Into::into);
                self.used += N;
            }
            None => new.into_iter().for_each(|knot| self.push(knot)),
        }
    }
}

impl Polygon<'_> {
    #[inline(always)]
    pub fn new(friction_coefficient: f64, knots: &mut [f64], used: usize) -> Polygon<'_> {
        let knots = knots.as_chunks_mut().0;
        Polygon { friction_coefficient, knots, used, anew: false, change: 0.0, error: 0.0 }
    }

    /// Appends a knot; if there is no room, two pieces are merged.
    #[cold]
    #[inline(never)]
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
/// `StateTooShort`, `BadState`, `BadDisplacement`, `BadNormalForce` or `LengthTooShort`.
pub fn advance(element: &Element, state: &mut [f64], displacement: [f64; 2], with_energy: bool) -> Result<Step, Error> {
    check_header(state)?;
    check_step(element, &displacement)?;
    Ok(advance_checked(element, state, displacement, with_energy))
}

/// Copies a state whose header was checked into one that may hold fewer pieces.
pub(crate) fn copy(element: &Element, from: &[f64], to: &mut [f64]) {
    let (Some((header, target)), Some(source)) = (to.split_first_chunk_mut::<HEADER>(), from.first_chunk::<HEADER>())
    else {
        return;
    };
    let mut polygon = Polygon::new(element.friction_coefficient, target, 0);
    parts(from).1.iter().for_each(|knot| polygon.push((*knot).into()));
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
    let (header, knots) = parts(state);
    let Point { displacement, normal, error, .. } = Point::read(header);
    let Normal { load, shift, load_slope, shift_slope } = normal;
    let finite =
        header.iter().all(|value| is_finite(*value)) && knots.as_flattened().iter().all(|value| is_finite(*value));
    if !finite || error < 0.0 || [load, shift, load_slope, shift_slope].iter().any(|value| *value < 0.0) {
        return Err(Error::BadState);
    }
    let (Some([xi, eta, first, _]), Some([last_xi, last_eta, last, _])) = (knots.first(), knots.last()) else {
        return Err(Error::BadState);
    };
    // A knot is located by ξ and η, each within two roundings of the larger one: S is within four of them over twice the size, and
    // N, of an exponent of at most 9, within 18, at both ends of a piece. The tables of N(S) and S(N) are within 1e-13 in every
    // rounding mode.
    let size = 0.5 * (last_eta - last_xi);
    let rounding = (36.0 * f64::EPSILON * last_xi.abs().max(last_eta.abs()) + 2e-13 * size) * load;
    let allowed = rounding.min(f64::MAX);
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

/// Checks a path: two doubles per step.
///
/// # Errors
/// Those of [`check_step`].
pub(crate) fn check_path(element: &Element, path: &[f64]) -> Result<(), Error> {
    path.as_chunks().0.iter().try_for_each(|displacement| check_step(element, displacement))
}

/// Checks the displacement of a step.
///
/// # Errors
/// `BadDisplacement`, `BadNormalForce` or `LengthTooShort`.
#[inline(always)]
pub(crate) fn check_step(element: &Element, &[displacement, input]: &[f64; 2]) -> Result<(), Error> {
    check_displacement(displacement)?;
    element.check_input(input)
}

/// Advances a state through displacements, two doubles per step, that were checked.
///
/// # Errors
/// `StateTooShort` or `BadState`, `BadDisplacement`, `BadNormalForce` or `LengthTooShort`; the state is unchanged then.
pub fn path(element: &Element, state: &mut [f64], path: &[f64], output: PathOutput) -> Result<(), Error> {
    check_header(state)?;
    check_path(element, path)?;
    let with_energy = output.dissipated.is_some();
    advance_along(path, output, |displacement| advance_checked(element, state, displacement, with_energy));
    Ok(())
}

/// As [`path`], from a copy of the state of the same length, but for at most 256 pieces.
pub(crate) fn path_in_copy(element: &Element, state: &[f64], steps: &[f64], output: PathOutput) -> Result<(), Error> {
    let mut buffer = [0.0; state_length(PIECES_OF_COPY)];
    let length = state.len().min(buffer.len());
    let buffer = buffer.get_mut(..length).ok_or(Error::StateTooShort)?;
    copy(element, state, buffer);
    path(element, buffer, steps, output)
}
