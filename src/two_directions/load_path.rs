//! A step of springs between contacts that may be open: the part of the path in contact, in the units of the springs.

use crate::element::springs::{Both, Pressed};
use crate::element::{Element, Normal};
use crate::two_directions::spring_state::{LONGEST, SpringState};
use crate::two_directions::state::Header;
use crate::two_directions::step::{self, Increment, StepRecord};
use crate::two_directions::tangent::{self, IncrementColumns, ROWS, RecordedStep, SCRATCH};
use crate::two_directions::{Requested, Step, stick};

/// A step of springs from a contact, open or closed, to another one.
pub(super) struct LoadPath {
    pub to: Header,
    pub normal: Normal,
    pub closed: bool,
    pub was_closed: bool,
    /// In the units of the springs, which follow the part of the distance that is in contact.
    pub motion: Increment,
    distance: Both<f64>,
    part: f64,
    /// Derivatives of the part with respect to the normal component at the start and at the end.
    part_slopes: [f64; 2],
    /// Displacement per unit of the springs, and the factor by which a motion was shortened.
    unit: f64,
    scale: f64,
}

impl LoadPath {
    pub fn new(element: &Element, from: &Header, [u, v, input]: [f64; 3]) -> LoadPath {
        let (was_closed, closed) = (from.load > 0.0, element.is_closed(input));
        let same = was_closed && input.to_bits() == from.input.to_bits();
        let normal = if closed { element.normal(input) } else { Normal::OPEN };
        let to = Header { displacement: [u, v], input, load: normal.load, shift: normal.shift, ..Header::NONE };
        // The part of the path in contact, as in one direction.
        let (start, end) = (from.input, input);
        let (part, part_slopes) = match (was_closed, closed) {
            (true, false) => (element.crossing(start, end.min(0.0)), [0.0; 2]),
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
        let scale = if longest > LONGEST { longest / LONGEST } else { 1.0 };
        let before = if was_closed { element.pressed(from.load, from.shift) } else { Pressed::default() };
        let now = match (closed, same) {
            (true, true) => before,
            (true, false) => element.pressed(normal.load, normal.shift),
            _ => Pressed::default(),
        };
        let motion = Increment { before, now, by: by.map(|by| by / scale), constant_load: same };
        LoadPath { to, normal, closed, was_closed, motion, distance, part, part_slopes, unit, scale }
    }

    /// Advances the state. The tangent is that of the normal force only.
    pub fn advance(
        &self,
        element: &Element,
        state: &mut SpringState,
        requested: Requested,
        record: &mut StepRecord,
    ) -> Step {
        let force_unit = element.friction_coefficient * element.normal_force;
        let energy_unit = force_unit * self.unit * self.scale;
        let mut step = Step::NONE;
        (step.force[2], step.tangent[8]) = (self.normal.load, self.normal.load_slope);
        if !self.closed {
            if self.was_closed && requested.energy {
                step.dissipated = energy_unit * step::separated(&element.springs, state, &self.motion);
            }
            *state = SpringState::RELAXED;
            return step;
        }
        if !self.was_closed {
            *state = SpringState::RELAXED;
        }
        let flags = [requested.energy, requested.tangent];
        let outcome = step::step(&element.springs, state, &self.motion, flags, record);
        (step.force[0], step.force[1]) = (force_unit * outcome.force[0], force_unit * outcome.force[1]);
        step.dissipated = energy_unit * outcome.dissipated;
        step
    }

    /// Derivative of the motion by a displacement.
    pub fn per_distance(&self) -> f64 {
        self.part / self.unit / self.scale
    }

    /// Derivatives of the motion by the normal component at the start and at the end.
    pub fn per_input(&self, k: usize) -> [f64; 2] {
        self.part_slopes.map(|slope| self.distance[k] * slope / self.unit / self.scale)
    }
}

/// A step of springs, from a contact that may be open.
pub(super) fn advance_springs(
    element: &Element,
    from: &Header,
    state: &mut SpringState,
    displacement: [f64; 3],
    requested: Requested,
) -> (Step, Header) {
    let path = LoadPath::new(element, from, displacement);
    if from.offset != [0.0; 2] {
        stick::settle(&element.springs, state, &path.motion.before, &from.offset);
    }
    let old = requested.tangent.then_some(*state);
    let mut record = StepRecord::new();
    let mut step = path.advance(element, state, requested, &mut record);
    if let Some(old) = &old
        && path.closed
    {
        tangent(element, &path, [old, state], &record, &mut step.tangent);
    }
    (step, Header { sum: record.sum, ..path.to })
}

/// The tangent of a step of springs: its derivatives for the columns u, v, w.
#[inline(never)]
fn tangent(
    element: &Element,
    path: &LoadPath,
    memories: [&SpringState; 2],
    record: &StepRecord,
    tangent: &mut [f64; 9],
) {
    let slopes = element.pressed_slopes(&path.normal);
    let per_distance = path.per_distance();
    let columns = IncrementColumns {
        by: [&[per_distance, 0.0, path.per_input(0)[1], 0.0], &[0.0, per_distance, path.per_input(1)[1], 0.0]],
        load: &[0.0, 0.0, slopes.load, 0.0],
        shift: [&[0.0, 0.0, slopes.shift[0], 0.0], &[0.0, 0.0, slopes.shift[1], 0.0]],
        size: &[0.0, 0.0, slopes.size, 0.0],
        before: [&[0.0; 4], &[0.0; 4]],
    };
    let (mut rows, mut scratch) = ([0.0; 4 * ROWS], [0.0; 4 * SCRATCH]);
    let (mut x, mut y) = ([0.0; 4], [0.0; 4]);
    let recorded = RecordedStep { springs: &element.springs, memories, motion: &path.motion, record };
    tangent::step(&recorded, &columns, &mut rows, &mut scratch, [&mut x, &mut y]);
    let unit = element.friction_coefficient * element.normal_force;
    for column in 0..3 {
        tangent[3 * column] = unit * x[column];
        tangent[3 * column + 1] = unit * y[column];
    }
}
