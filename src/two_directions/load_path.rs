//! A step of springs between contacts that may be open: the part of the path in contact, in the units of the springs.

use crate::element::springs::{Both, Pressed};
use crate::element::{Element, Normal};
use crate::two_directions::spring_state::{LONGEST, Memory};
use crate::two_directions::state::Header;
use crate::two_directions::step::{self, Course, Motion};
use crate::two_directions::tangent::{self, MotionColumns, ROWS, SCRATCH, Taken};
use crate::two_directions::{Requested, Step, stick};

/// A step of springs from a contact, open or closed, to another one.
pub(super) struct Passage {
    pub to: Header,
    pub normal: Normal,
    pub closed: bool,
    pub was_closed: bool,
    /// In the units of the springs, which follow the part of the distance that is in contact.
    pub motion: Motion,
    distance: Both<f64>,
    part: f64,
    /// Derivatives of the part with respect to the normal component at the start and at the end.
    part_slopes: [f64; 2],
    /// Displacement per unit of the springs, and the factor by which a motion was shortened.
    unit: f64,
    stretch: f64,
}

impl Passage {
    pub fn new(element: &Element, from: &Header, [u, v, input]: [f64; 3]) -> Passage {
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
    pub fn advance(&self, element: &Element, memory: &mut Memory, requested: Requested, course: &mut Course) -> Step {
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
        let outcome = step::step(&element.springs, memory, &self.motion, flags, course);
        (step.force[0], step.force[1]) = (force_unit * outcome.force[0], force_unit * outcome.force[1]);
        step.dissipated = energy_unit * outcome.dissipated;
        step
    }

    /// Derivative of the motion by a displacement.
    pub fn per_distance(&self) -> f64 {
        self.part / self.unit / self.stretch
    }

    /// Derivatives of the motion by the normal component at the start and at the end.
    pub fn per_input(&self, k: usize) -> [f64; 2] {
        self.part_slopes.map(|slope| self.distance[k] * slope / self.unit / self.stretch)
    }
}

/// A step of springs, from a contact that may be open.
pub(super) fn advance_springs(
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
    if let Some(old) = old
        && passage.closed
    {
        let old = if passage.was_closed { old } else { Memory::RELAXED };
        tangent(element, &passage, [&old, memory], &course, &mut step.tangent);
    }
    (step, Header { sum: course.sum, ..passage.to })
}

/// The tangent of a step of springs: its derivatives for the columns u, v, w.
#[inline(never)]
fn tangent(element: &Element, passage: &Passage, memories: [&Memory; 2], course: &Course, tangent: &mut [f64; 9]) {
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
    tangent::step(&taken, &columns, &mut rows, &mut scratch, [&mut x, &mut y]);
    let unit = element.friction_coefficient * element.normal_force;
    for column in 0..3 {
        tangent[3 * column] = unit * x[column];
        tangent[3 * column + 1] = unit * y[column];
    }
}
