//! The law for two tangential directions. A displacement is `[u, v, w]` or `[u, v, N]`, a force `[Tx, Ty, N]`.
//!
//! The contact is a family of nested sizes, as in one direction, but slip has a direction of its own at each point. Springs at nodes of
//! the family carry the displacement of the sizes within; the tractions at one point of each shell are a triangular map of them, and
//! Coulomb's law holds at these points, with slip in the direction of the traction.
//!
//! - `springs`: the nodes of a shape and the map, independent of the load;
//! - `edge`: the shell that ends at the present size;
//! - `slip`: Coulomb's law at the points, by Newton's method;
//! - `fine`: correction by a finer bank of springs;
//! - `step`, `sensitivity`: a step, and its derivatives, as `columns`;
//! - `stick`: a step in which nothing slips;
//! - [`harmonic_force`]: Fourier coefficients of the forces of a periodic motion.
//!
//! A motion on a line parallel to x is that of one direction: as long as v does not change, the state is the memory diagram of
//! [`crate::varying_load::state`]. The first step with a change of v turns it into springs, the next separation back.
//!
//! ```text
//! on a line:  [tag 0, v, state of one direction]
//! springs:    [tag 1, v, u, normal component, N, S, offset (2), force (2), 0, 0,
//!              springs, tractions, reach, pressure, fine bank]
//! ```

pub mod harmonic_force;

pub(crate) mod columns;
pub(crate) mod edge;
pub(crate) mod fine;
pub(crate) mod sensitivity;
pub(crate) mod slip;
pub(crate) mod springs;
pub(crate) mod step;
pub(crate) mod stick;

use crate::constant_load::contact::check_displacement;
use crate::error::Error;
use crate::numerics::fp_class::is_finite;
use crate::tag::Kind;
use crate::varying_load::element::{Element, Normal};
use crate::varying_load::path::{self, advance_along};
use crate::varying_load::state;
use edge::{Edge, Map, Pressed};
use sensitivity::{MotionColumns, ROWS, SCRATCH, Taken};
use slip::product;
use springs::{Both, FINE, SPRINGS, Springs};
use step::{Course, Memory, Motion};
use stick::{Stored, Stuck};

pub use crate::varying_load::path::PathOutput;

const HEADER: usize = 12;
const LENGTH: usize = HEADER + 6 * SPRINGS + 2 * FINE;
/// Values before the state of one direction.
const LINE: usize = 2;

/// Number of doubles in a state.
#[must_use]
pub const fn state_length() -> usize {
    LENGTH
}

/// Result of a step: forces `[Tx, Ty, N]`, tangent 3 x 3 (column-major), 0 unless requested, and dissipated energy.
pub type Step = path::StepResult<[f64; 3], [f64; 9]>;

/// Results of a step that are requested besides the force.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Requested {
    pub tangent: bool,
    pub energy: bool,
    pub kernel: Kernel,
}

/// [`sensitivity::step`].
pub(crate) type Differentiate = for<'a> fn(&Taken<'a>, &MotionColumns<'a>, &mut [f64], &mut [f64], Both<&mut [f64]>);

/// A step of springs and its derivatives, compiled for a kind of processor.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Kernel {
    pub step: fn(&Springs, &mut Memory, &Motion, [bool; 2], &mut Course) -> step::Outcome,
    pub differentiate: Differentiate,
    pub stuck: fn(&Springs, &Stored, &Pressed, &Both<f64>) -> Option<Stuck>,
}

impl Kernel {
    /// For any processor.
    pub const BASELINE: Kernel = Kernel { step: step::step, differentiate: sensitivity::step, stuck: stick::stuck };
}

/// Initialises a state: open, at displacement 0 and normal component 0.
///
/// # Errors
/// `StateTooShort` for fewer than [`state_length`] doubles.
pub fn state_init(state: &mut [f64]) -> Result<(), Error> {
    let state = state.get_mut(..LENGTH).ok_or(Error::StateTooShort)?;
    state.fill(0.0);
    let Some((header, line)) = state.split_first_chunk_mut::<LINE>() else { return Err(Error::StateTooShort) };
    header[0] = Kind::TwoDirectionsState.tag(ON_LINE);
    state::state_init(line)
}

/// Counts in the tag: the two kinds of states.
const ON_LINE: usize = 0;
const SPRUNG: usize = 1;

/// Checks the length and the tag of a state.
///
/// # Errors
/// `StateTooShort` for fewer than [`state_length`] doubles; `BadState` for an array that is no state.
#[inline(always)]
pub(crate) fn check_header(state: &[f64]) -> Result<(), Error> {
    if state.len() < LENGTH {
        return Err(Error::StateTooShort);
    }
    check_tag(state.first().copied().unwrap_or(0.0), state.len())?;
    match line_of(state) {
        Some(line) => state::check_header(line),
        None => Ok(()),
    }
}

/// Rejects the tag of what is no state of that length.
#[inline(always)]
pub(crate) fn check_tag(tag: f64, _state_length: usize) -> Result<(), Error> {
    match Kind::TwoDirectionsState.count(tag) {
        Some(ON_LINE | SPRUNG) => Ok(()),
        _ => Err(Error::BadState),
    }
}

/// The state of one direction in a state on a line.
fn line_of(state: &[f64]) -> Option<&[f64]> {
    let on_line = Kind::TwoDirectionsState.count(*state.first()?) == Some(ON_LINE);
    state.get(LINE..LENGTH).filter(|_| on_line)
}

/// Validates a state in full: finite values, springs and tractions within their limits. For states from outside the process.
///
/// # Errors
/// `StateTooShort`; `BadState` for an array that was not initialised, or whose values no history leads to.
pub fn state_check(state: &[f64]) -> Result<(), Error> {
    check_header(state)?;
    let used = state.get(..LENGTH).ok_or(Error::StateTooShort)?;
    if !used.iter().all(|value| is_finite(*value)) {
        return Err(Error::BadState);
    }
    if let Some(line) = line_of(state) {
        return state::state_check(line);
    }
    let (header, Some(memory)) = (read_header(state), stored(state)) else { return Err(Error::StateTooShort) };
    let bounded = |x: f64, y: f64| x * x + y * y <= 1.0 + 1e-9;
    let [x, y] = memory.tractions;
    let within = x.iter().zip(y).all(|(x, y)| x.abs() <= 2.0 && y.abs() <= 2.0 && bounded(*x, *y));
    let positive = memory.reach.iter().chain(memory.pressure).all(|value| *value >= 0.0);
    let loads = header.load > 0.0 && header.shift > 0.0;
    let held = header.offset.iter().all(|offset| offset.abs() <= LONGEST);
    if within && positive && loads && held { Ok(()) } else { Err(Error::BadState) }
}

/// A bound on the error of the force \[N\] from merging pieces of the diagram on a line; 0 otherwise.
#[must_use]
pub fn force_error(state: &[f64]) -> f64 {
    line_of(state).map_or(0.0, state::force_error)
}

/// Checks the displacement of a step.
///
/// # Errors
/// `BadDisplacement`, `BadNormalForce` or `LengthTooShort`.
#[inline(always)]
pub(crate) fn check_step(element: &Element, &[u, v, input]: &[f64; 3]) -> Result<(), Error> {
    check_displacement(u)?;
    check_displacement(v)?;
    element.check_input(input)
}

/// Where a contact with springs is.
#[derive(Debug, Clone, Copy)]
struct Header {
    displacement: Both<f64>,
    input: f64,
    load: f64,
    shift: f64,
    /// Motion of the springs since they last changed, and the sum of their forces then.
    offset: Both<f64>,
    sum: Both<f64>,
}

impl Header {
    /// Without springs.
    const NONE: Header =
        Header { displacement: [0.0; 2], input: 0.0, load: 0.0, shift: 0.0, offset: [0.0; 2], sum: [0.0; 2] };
}

#[inline(always)]
fn stored(state: &[f64]) -> Option<Stored<'_>> {
    Stored::new(state.get(HEADER..)?)
}

#[inline(always)]
fn read_header(state: &[f64]) -> Header {
    let [_, v, u, input, load, shift, offset_x, offset_y, sum_x, sum_y, ..] =
        *state.first_chunk::<HEADER>().unwrap_or(&[0.0; HEADER]);
    Header { displacement: [u, v], input, load, shift, offset: [offset_x, offset_y], sum: [sum_x, sum_y] }
}

/// Writes a state of springs.
fn write(state: &mut [f64], header: &Header, memory: &Memory) {
    let Some((place, mut rest)) = state.split_first_chunk_mut::<HEADER>() else { return };
    let Header { displacement: [u, v], input, load, shift, offset: [x, y], sum: [sum_x, sum_y] } = *header;
    *place = [Kind::TwoDirectionsState.tag(SPRUNG), v, u, input, load, shift, x, y, sum_x, sum_y, 0.0, 0.0];
    let mut put = |from: &[f64]| {
        if let Some((values, behind)) = core::mem::take(&mut rest).split_at_mut_checked(from.len()) {
            values.copy_from_slice(from);
            rest = behind;
        }
    };
    memory.springs.iter().for_each(|row| put(row));
    memory.tractions.iter().for_each(|row| put(row));
    put(&memory.reach);
    put(&memory.pressure);
    memory.fine.iter().for_each(|row| put(row));
}

/// A step whose new state is discarded, with a state and a displacement that were checked.
pub(crate) fn trial(element: &Element, old: &[f64], displacement: [f64; 3], requested: Requested) -> Step {
    if line_of(old).is_none()
        && let Some((step, _)) = stick(element, old, displacement, requested)
    {
        return step;
    }
    let mut copy = [0.0; LENGTH];
    copy_used(old, &mut copy);
    advance_checked(element, &mut copy, displacement, requested)
}

/// A step in place, with a state and a displacement that were checked.
pub(crate) fn advance_checked(
    element: &Element,
    state: &mut [f64],
    [u, v, input]: [f64; 3],
    requested: Requested,
) -> Step {
    let Some(state) = state.first_chunk_mut::<LENGTH>() else { return Step::NONE };
    let closes = element.is_closed(input);
    // In one place for all cases: it is large.
    let mut memory;
    let from = match line_of(state.as_slice()) {
        Some(line) => {
            let (old_v, there) = (state[1], state::view(line));
            let from = header_of(&there, old_v);
            // Without friction, or open before and after, only the position changes.
            let free = element.friction_coefficient == 0.0 || (there.load == 0.0 && !closes);
            if old_v != v && !free {
                memory = Memory::RELAXED;
                fill_from_diagram(&mut memory, element, &from, there.knots);
                from
            } else {
                // Of the third component, the diagram has no stiffness: that of the springs.
                let mut yy = 0.0;
                if requested.tangent && !free && closes {
                    memory = Memory::RELAXED;
                    fill_from_diagram(&mut memory, element, &from, there.knots);
                    let requested = Requested { energy: false, ..requested };
                    yy = advance_springs(element, &from, &mut memory, [u, v, input], requested).0.tangent[4];
                }
                let Some((header, line)) = state.split_first_chunk_mut::<LINE>() else { return Step::NONE };
                header[1] = v;
                let step = state::advance_checked(element, line, [u, input], requested.energy);
                let ([x, normal], [xx, _, xw, ww]) = (step.force, step.tangent);
                return Step {
                    force: [x, 0.0, normal],
                    tangent: [xx, 0.0, 0.0, 0.0, yy, 0.0, xw, 0.0, ww],
                    dissipated: step.dissipated,
                };
            }
        }
        None => {
            if let Some((step, offset)) = stick(element, state, [u, v, input], requested) {
                (state[1], state[2], state[6], state[7]) = (v, u, offset[0], offset[1]);
                return step;
            }
            memory = Memory::RELAXED;
            if let Some(stored) = stored(state) {
                stored.copy_to(&mut memory);
            }
            read_header(state)
        }
    };
    let (step, header) = advance_springs(element, &from, &mut memory, [u, v, input], requested);
    if header.load > 0.0 {
        write(state, &header, &memory);
    } else {
        // Separated: the line of the next contact begins here.
        state.fill(0.0);
        let _ = state_init(state);
        if let Some((header, line)) = state.split_first_chunk_mut::<LINE>() {
            header[1] = v;
            state::advance_checked(element, line, [u, input], false);
        }
    }
    step
}

/// A step under the load of the state in which nothing slips, and the offset at its end.
#[inline(always)]
fn stick(element: &Element, state: &[f64], [u, v, input]: [f64; 3], requested: Requested) -> Option<(Step, Both<f64>)> {
    let header = read_header(state);
    if input.to_bits() != header.input.to_bits() {
        return None;
    }
    let per_unit = 1.0 / (element.friction_coefficient * element.shift_unit());
    let by = [u - header.displacement[0], v - header.displacement[1]];
    let offset = [header.offset[0] + by[0] * per_unit, header.offset[1] + by[1] * per_unit];
    // Far beyond all limits the squares overflow.
    if offset[0].abs().max(offset[1].abs()) > LONGEST {
        return None;
    }
    let now = element.pressed_without_size(header.load, header.shift);
    let stuck = (requested.kernel.stuck)(&element.springs, &stored(state)?, &now, &offset)?;
    let Stuck { stiffness: [k_x, k_y], .. } = stuck;
    let sum = [header.sum[0] + k_x * offset[0], header.sum[1] + k_y * offset[1]];
    if product(&sum, &sum) > now.load * now.load {
        return None;
    }
    let unit = element.friction_coefficient * element.normal_force;
    let mut step = Step { force: [unit * sum[0], unit * sum[1], header.load], ..Step::NONE };
    if requested.tangent {
        let normal = element.normal(input);
        let slopes = element.pressed_slopes(&normal);
        step.tangent[8] = normal.load_slope;
        for k in 0..2 {
            step.tangent[4 * k] = unit * stuck.stiffness[k] * per_unit;
            step.tangent[6 + k] = unit * (stuck.per_load[k] * slopes.load + stuck.per_shift[k] * slopes.shift[k]);
        }
    }
    Some((step, offset))
}

/// The header of a diagram.
fn header_of(view: &state::View, v: f64) -> Header {
    Header {
        displacement: [view.displacement, v],
        input: view.input,
        load: view.load,
        shift: view.shift,
        ..Header::NONE
    }
}

/// Writes the springs of a diagram to a relaxed memory: their displacements are those of the sizes from theirs on.
fn fill_from_diagram(memory: &mut Memory, element: &Element, header: &Header, knots: &[[f64; 4]]) {
    if header.load <= 0.0 {
        return;
    }
    let springs = &element.springs;
    let (unit, now) = (element.shift_unit(), element.pressed(header.load, header.shift));
    let mu = element.friction_coefficient;
    let [u, _] = header.displacement;
    let at = |shift: f64| {
        // P(S) of the polygon; beyond its end the displacement is that of the contact.
        let target = shift * unit;
        let mut inner = knots.first().copied().unwrap_or([u, u, 0.0, 0.0]);
        for knot in knots {
            let [xi, eta, ..] = *knot;
            let end = 0.5 * (eta - xi) / mu;
            if end > target {
                let start = 0.5 * (inner[1] - inner[0]) / mu;
                let part = ((target - start) / (end - start).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
                let position = |knot: &[f64; 4]| 0.5 * (knot[0] - u) + 0.5 * (knot[1] - u);
                return -(position(&inner) + part * (position(knot) - position(&inner))) / (mu * unit);
            }
            inner = *knot;
        }
        0.0
    };
    let edge = Edge::new(springs, &now, None);
    for j in 0..SPRINGS {
        if j <= edge.last {
            memory.springs[0][j] = at(springs.shift[0][j]);
        }
    }
    for j in 0..FINE {
        if springs.fine_shift[0][j] < now.shift[0] {
            memory.fine[0][j] = at(springs.fine_shift[0][j]);
        }
    }
    let map = Map::new(springs, &edge);
    let mut scaled = memory.springs;
    for j in 0..SPRINGS {
        scaled[0][j] *= map.root[0][j];
    }
    let mut tractions = [[0.0; SPRINGS]; 2];
    map.tractions(&scaled, &[false; SPRINGS], &mut tractions);
    let [tractions, _] = tractions;
    for i in 0..SPRINGS {
        if i <= edge.last {
            memory.tractions[0][i] = (tractions[i] / edge.pressure[i]).clamp(-1.0, 1.0);
        }
    }
    (memory.reach, memory.pressure) = (edge.reach, edge.pressure);
}

/// A motion over more than this many slip displacements is shortened to it: the force does not depend on the rest, and the energy is proportional.
const LONGEST: f64 = 1e9;

/// A step of springs from a contact, open or closed, to another one.
struct Passage {
    to: Header,
    normal: Normal,
    closed: bool,
    was_closed: bool,
    /// In the units of the springs, which follow the part of the distance that is in contact.
    motion: Motion,
    distance: Both<f64>,
    part: f64,
    /// Derivatives of the part with respect to the normal component at the start and at the end.
    part_slopes: [f64; 2],
    /// Displacement per unit of the springs, and the factor by which a motion was shortened.
    unit: f64,
    stretch: f64,
}

impl Passage {
    fn new(element: &Element, from: &Header, [u, v, input]: [f64; 3]) -> Passage {
        let (was_closed, closed) = (from.load > 0.0, element.is_closed(input));
        let same = was_closed && input.to_bits() == from.input.to_bits();
        let normal = if closed { element.normal(input) } else { Normal::OPEN };
        let to = Header { displacement: [u, v], input, load: normal.load, shift: normal.shift, ..Header::NONE };
        // The part of the path in contact, as in one direction.
        let (start, end) = (from.input, input);
        let (part, part_slopes) = match (was_closed, closed) {
            (true, false) if element.by_approach() => (start / (start - end.min(0.0)).max(f64::MIN_POSITIVE), [0.0; 2]),
            (false, true) if element.by_approach() => {
                let (start, per) = (start.min(0.0), 1.0 / (end - start.min(0.0)).max(f64::MIN_POSITIVE));
                (end * per, [end * per * per, -start * per * per])
            }
            _ => (1.0, [0.0; 2]),
        };
        let distance = [u - from.displacement[0], v - from.displacement[1]];
        let unit = element.friction_coefficient * element.shift_unit();
        let by = distance.map(|distance| part * distance / unit);
        let longest = by[0].abs().max(by[1].abs());
        let stretch = if longest > LONGEST { longest / LONGEST } else { 1.0 };
        let before = if was_closed { element.pressed(from.load, from.shift) } else { Pressed::default() };
        let now = match (closed, same) {
            (true, true) => before,
            (true, false) => element.pressed(normal.load, normal.shift),
            _ => Pressed::default(),
        };
        let motion = Motion { before, now, by: by.map(|by| by / stretch), constant_load: same };
        Passage { to, normal, closed, was_closed, motion, distance, part, part_slopes, unit, stretch }
    }

    /// Advances the memory. The tangent is that of the normal force only.
    fn advance(&self, element: &Element, memory: &mut Memory, requested: Requested, course: &mut Course) -> Step {
        let force_unit = element.friction_coefficient * element.normal_force;
        let energy_unit = force_unit * self.unit * self.stretch;
        let mut step = Step::NONE;
        (step.force[2], step.tangent[8]) = (self.normal.load, self.normal.load_slope);
        if !self.closed {
            if self.was_closed && requested.energy {
                step.dissipated = energy_unit * step::separated(&element.springs, memory, &self.motion);
            }
            *memory = Memory::RELAXED;
            return step;
        }
        if !self.was_closed {
            *memory = Memory::RELAXED;
        }
        let flags = [requested.energy, requested.tangent];
        let outcome = (requested.kernel.step)(&element.springs, memory, &self.motion, flags, course);
        (step.force[0], step.force[1]) = (force_unit * outcome.force[0], force_unit * outcome.force[1]);
        step.dissipated = energy_unit * outcome.dissipated;
        step
    }

    /// Derivative of the motion by a displacement.
    fn per_distance(&self) -> f64 {
        self.part / self.unit / self.stretch
    }

    /// Derivatives of the motion by the normal component at the start and at the end.
    fn per_input(&self, k: usize) -> [f64; 2] {
        self.part_slopes.map(|slope| self.distance[k] * slope / self.unit / self.stretch)
    }
}

/// A step of springs, from a contact that may be open.
fn advance_springs(
    element: &Element,
    from: &Header,
    memory: &mut Memory,
    displacement: [f64; 3],
    requested: Requested,
) -> (Step, Header) {
    let passage = Passage::new(element, from, displacement);
    if from.offset != [0.0; 2] {
        stick::settle(&element.springs, memory, &passage.motion.before, &from.offset);
    }
    let old = requested.tangent.then_some(*memory);
    let mut course = Course::new();
    let mut step = passage.advance(element, memory, requested, &mut course);
    if let Some(old) = &old
        && passage.closed
    {
        tangent(element, &passage, [old, memory], &course, requested.kernel, &mut step.tangent);
    }
    (step, Header { sum: course.sum, ..passage.to })
}

/// The tangent of a step of springs: its derivatives for the columns u, v, w.
#[inline(never)]
fn tangent(
    element: &Element,
    passage: &Passage,
    memories: [&Memory; 2],
    course: &Course,
    kernel: Kernel,
    tangent: &mut [f64; 9],
) {
    let slopes = element.pressed_slopes(&passage.normal);
    let per_distance = passage.per_distance();
    let columns = MotionColumns {
        by: [&[per_distance, 0.0, passage.per_input(0)[1], 0.0], &[0.0, per_distance, passage.per_input(1)[1], 0.0]],
        load: &[0.0, 0.0, slopes.load, 0.0],
        shift: [&[0.0, 0.0, slopes.shift[0], 0.0], &[0.0, 0.0, slopes.shift[1], 0.0]],
        size: &[0.0, 0.0, slopes.size, 0.0],
        before: [&[0.0; 4], &[0.0; 4]],
    };
    let (mut rows, mut scratch) = ([0.0; 4 * ROWS], [0.0; 4 * SCRATCH]);
    let (mut x, mut y) = ([0.0; 4], [0.0; 4]);
    let taken = Taken { springs: &element.springs, memories, motion: &passage.motion, course };
    (kernel.differentiate)(&taken, &columns, &mut rows, &mut scratch, [&mut x, &mut y]);
    let unit = element.friction_coefficient * element.normal_force;
    for column in 0..3 {
        tangent[3 * column] = unit * x[column];
        tangent[3 * column + 1] = unit * y[column];
    }
}

/// A step in place.
///
/// # Errors
/// `StateTooShort`, `BadState`, `BadDisplacement`, `BadNormalForce` or `LengthTooShort`.
pub fn advance(element: &Element, state: &mut [f64], displacement: [f64; 3]) -> Result<Step, Error> {
    check_header(state)?;
    check_step(element, &displacement)?;
    Ok(advance_checked(
        element,
        state,
        displacement,
        Requested { tangent: true, energy: true, kernel: Kernel::BASELINE },
    ))
}

/// Checks a path: three doubles per step.
///
/// # Errors
/// Those of [`check_step`].
pub(crate) fn check_path(element: &Element, path: &[f64]) -> Result<(), Error> {
    path.as_chunks().0.iter().try_for_each(|displacement| check_step(element, displacement))
}

/// Advances a state through displacements, three doubles per step.
///
/// # Errors
/// `StateTooShort`, `BadState`, `BadDisplacement`, `BadNormalForce` or `LengthTooShort`; the state is unchanged then.
pub fn path(element: &Element, state: &mut [f64], path: &[f64], output: PathOutput) -> Result<(), Error> {
    path_by(element, state, path, output, Kernel::BASELINE)
}

/// As [`path`], with a kernel.
pub(crate) fn path_by(
    element: &Element,
    state: &mut [f64],
    path: &[f64],
    output: PathOutput,
    kernel: Kernel,
) -> Result<(), Error> {
    check_header(state)?;
    check_path(element, path)?;
    let requested = Requested { tangent: output.tangent.is_some(), energy: output.dissipated.is_some(), kernel };
    advance_along(path, output, |displacement| advance_checked(element, state, displacement, requested));
    Ok(())
}

/// As [`path_by`], from a copy of the state.
pub(crate) fn path_in_copy(
    element: &Element,
    state: &[f64],
    steps: &[f64],
    output: PathOutput,
    kernel: Kernel,
) -> Result<(), Error> {
    let mut copy = [0.0; LENGTH];
    copy_used(state, &mut copy);
    path_by(element, &mut copy, steps, output, kernel)
}

/// Copies what is in use of a state whose header was checked to one that is as long.
#[inline(always)]
pub(crate) fn copy_used(from: &[f64], to: &mut [f64]) {
    if let (Some(from), Some(to)) = (from.first_chunk::<LENGTH>(), to.first_chunk_mut::<LENGTH>()) {
        *to = *from;
    }
}
