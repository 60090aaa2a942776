//! A step of springs between contacts that may be open: the part of the path in contact, in the units of the springs.

use crate::element::{Element, Normal};
use crate::two_directions::spring_state::{LONGEST, SpringState};
use crate::two_directions::springs::{Both, Increment, Pressed, PressedSlopes, Springs};
use crate::two_directions::state::Header;
use crate::two_directions::step::{self, SLIPPED, StepRecord};
use crate::two_directions::tangent::{self, Derivatives, IncrementColumns, Parameter, Taken, inner_after};
use crate::two_directions::{Requested, Step, stick};

/// Where a step leads: its normal state, and w² in the units of the springs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub displacement: [f64; 3],
    pub closed: bool,
    pub normal: Normal,
    pub size: f64,
}

impl Place {
    pub const NONE: Place = Place { displacement: [0.0; 3], closed: false, normal: Normal::OPEN, size: 0.0 };

    pub fn new(element: &Element, from: &Header, displacement: [f64; 3]) -> Place {
        let [_, _, input] = displacement;
        if !element.is_closed(input) {
            return Place { displacement, ..Place::NONE };
        }
        let normal = element.normal(input);
        let same = from.load > 0.0 && input.to_bits() == from.input.to_bits();
        let size = if same { from.size } else { from.units.size_under(element, normal.load) };
        Place { displacement, closed: true, normal, size }
    }
}

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
    /// Displacement per unit of the springs, force per unit, and the factor by which a motion was shortened.
    unit: f64,
    pub force_unit: f64,
    scale: f64,
}

impl LoadPath {
    pub fn new(element: &Element, from: &Header, place: &Place) -> LoadPath {
        let Place { displacement: [u, v, input], closed, normal, size } = *place;
        let was_closed = from.load > 0.0;
        let same = was_closed && input.to_bits() == from.input.to_bits();
        let (load, shift) = (normal.load, normal.shift);
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
        let units = &from.units;
        let distance = [u - from.displacement[0], v - from.displacement[1]];
        let unit = element.friction_coefficient * units.shift;
        let by = distance.map(|distance| part * distance / unit);
        let longest = by[0].abs().max(by[1].abs());
        let scale = if longest > LONGEST { longest / LONGEST } else { 1.0 };
        let before = if was_closed { from.pressed(element) } else { Pressed::default() };
        let now = match (closed, same) {
            (true, true) => before,
            (true, false) => units.pressed(element, load, shift, size),
            _ => Pressed::default(),
        };
        let (offset, sum) = ([0.0; 2], [0.0; 2]);
        let to = Header { displacement: [u, v], input, load, shift, size: now.size, offset, sum, ..*from };
        let motion = Increment::new(before, now, by.map(|by| by / scale), same);
        let force_unit = element.friction_coefficient * units.load;
        LoadPath { to, normal, closed, was_closed, motion, distance, part, part_slopes, unit, force_unit, scale }
    }

    /// Advances the state. The tangent is that of the normal force only.
    #[inline(always)]
    pub fn advance<const N: usize>(
        &self,
        springs: &Springs,
        state: &mut SpringState<N>,
        requested: Requested,
        record: &mut StepRecord<N>,
    ) -> Step {
        let energy_unit = self.force_unit * self.unit * self.scale;
        let mut step = Step::NONE;
        (step.force[2], step.tangent[8]) = (self.normal.load, self.normal.load_slope);
        if !self.closed {
            if self.was_closed && requested.energy {
                step.dissipated = energy_unit * step::separated(springs, state, &self.motion, true);
            }
            *state = SpringState::RELAXED;
            return step;
        }
        if !self.was_closed {
            *state = SpringState::RELAXED;
        }
        let flags = [requested.energy, requested.tangent];
        let outcome = step::step(springs, state, &self.motion, flags, record);
        (step.force[0], step.force[1]) = (self.force_unit * outcome.force[0], self.force_unit * outcome.force[1]);
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
pub(super) fn advance_springs<const N: usize>(
    element: &Element,
    from: &Header,
    springs: &Springs,
    state: &mut SpringState<N>,
    displacement: [f64; 3],
    requested: Requested,
) -> (Step, Header) {
    let path = LoadPath::new(element, from, &Place::new(element, from, displacement));
    if from.offset != [0.0; 2] {
        stick::settle(springs, state, &from.offset);
    }
    let mut record = StepRecord::NONE;
    if !requested.tangent || !path.closed {
        let step = path.advance(springs, state, requested, &mut record);
        return (step, Header { sum: record.sum, ..path.to });
    }
    let old = *state;
    let mut step = path.advance(springs, state, requested, &mut record);
    let to = Header { sum: record.sum, ..path.to };
    tangent(element, &path, springs, state, &record, &mut step.tangent);
    if path.motion.constant_load && rests_at_limit(state, &record) {
        // The derivatives with respect to the load have two sides: that of its increase.
        let [u, v, input] = displacement;
        let place = Place::new(element, from, [u, v, input * (1.0 + INCREASE)]);
        let path = LoadPath::new(element, from, &place);
        let (mut increased, mut columns) = (old, [0.0; 9]);
        path.advance(springs, &mut increased, Requested { energy: false, ..requested }, &mut record);
        tangent(element, &path, springs, &increased, &record, &mut columns);
        (step.tangent[6], step.tangent[7]) = (columns[6], columns[7]);
    }
    (step, to)
}

/// Whether a point at its limit sticks: then the derivatives with respect to the load have two sides.
fn rests_at_limit<const N: usize>(state: &SpringState<N>, record: &StepRecord<N>) -> bool {
    let [x, y] = &state.tractions;
    (0..N).any(|i| x[i] * x[i] + y[i] * y[i] > SLIPPED && record.slipping() >> i & 1 == 0)
}

/// The relative increase of the normal component at which the one-sided derivative with respect to it is taken: its square root is above
/// the rounding errors of tractions, and the derivative changes by as little.
const INCREASE: f64 = 1e-9;

/// The tangent of a step of springs: its derivatives for the columns u, v, w.
#[inline(never)]
fn tangent<const N: usize>(
    element: &Element,
    path: &LoadPath,
    springs: &Springs,
    new: &SpringState<N>,
    record: &StepRecord<N>,
    tangent: &mut [f64; 9],
) {
    let per_distance = path.per_distance();
    let columns = IncrementColumns {
        by: [[per_distance, 0.0, path.per_input(0)[1], 0.0], [0.0, per_distance, path.per_input(1)[1], 0.0]],
        end: [0.0, 0.0, 1.0, 0.0],
        start: [0.0; 4],
        alignment: [0.0; 4],
    };
    let mut memory = [[0.0; 4]; tangent::rows(16)];
    let Some(mut derivatives) = Derivatives::<N, 4>::new(&mut memory) else { return };
    let slopes = path.to.units.slopes(element, &path.normal, path.to.size);
    let start_slopes = PressedSlopes::default();
    let taken = Taken { springs, new, motion: &path.motion, record, slopes, start_slopes, table_slopes: None };
    let inner = inner_after(&taken, N);
    let [x, y] = tangent::tangent(&taken, &[Parameter::load(&taken)], &columns, &mut derivatives, inner);
    for column in 0..3 {
        tangent[3 * column] = path.force_unit * x[column];
        tangent[3 * column + 1] = path.force_unit * y[column];
    }
}
