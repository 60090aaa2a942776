//! The state of an element with two directions in the caller's memory, and a step of it.
//!
//! ```text
//! [tag, normal force and its derivative, v, u, normal component, key of the element, units of the springs (3),
//!  spring at the edge (2), a double that needs 17 digits | normal state in these units, and its derivatives (7 each) |
//!  springs | turned | nodes]
//! ```
//!
//! in rows of as many doubles as springs. A contact that opens has the state of a new one.

use super::TwoDirections;
use super::energy::{dissipated, separated};
use super::harmonic_force::{HarmonicOutput, TwoDirectionsWorkspace, harmonic_force};
use super::moving_nodes::{ContactState, OldNodes};
use super::nodes::{
    DIFFERENCE_STEP, FLAT_EDGE, LEG_SQUARED, Nodes, POINT_SQUARED, PRESSURE, PerAxis, ROWS, SHIFT, SPRINGS, Units, fill,
};
use super::path::{ContactPath, LONGEST};
use super::shells::{ScaledNormalState, VALUES};
use super::step::{Displacements, LoadedContact, SMALLEST_LENGTH, SpringMotion, StepWork, within_friction_limit};
use super::tangent::{
    ContactSlopes, END, PARAMETERS, ParameterChanges, Propagation, REFERENCE, SpringChanges, StepTangent,
    slopes_of_nodes,
};
use crate::element::{Directions, Element, Normal};
use crate::error::Error;
use crate::law::{Law, Requested, StepOf, StepResult};
use crate::limits::check_displacement;
use crate::numerics::fp_class::is_finite;
use crate::numerics::lanes::Lanes;
use crate::numerics::total::Total;
use crate::tag::Kind;

/// Lanes of both displacements in a tangent, beside those of the normal component and of the nodes.
const DISPLACEMENT_LANES: [usize; 2] = [1, 3];
/// The rounding error of the load of nodes.
const LOAD_TOLERANCE: f64 = 1e-12;

/// Decimal text of 16 significant digits or fewer changes this double, which is halfway between two numbers of 16 digits: the state of a
/// closed contact is rejected then. Its springs at the edge are so stiff that rounding errors of their limits would be amplified.
const ALL_DIGITS: f64 = 1_000.000_000_000_000_5;

const HEADER_ROWS: usize = 2;
/// Places in the header.
const KEY: usize = 6;
const ALL_DIGITS_AT: usize = 12;
const STATE_ROWS: usize = HEADER_ROWS + 4 + ROWS;
pub(super) const LENGTH: usize = SPRINGS * STATE_ROWS;

impl Law for TwoDirections {
    type Item = Element;
    type Vector = [f64; 3];
    type Tangent = [f64; 9];
    type Workspace<'a> = TwoDirectionsWorkspace<'a>;

    const STATE_LENGTH: usize = LENGTH;
    const STATE: Kind = Kind::TwoDirectionsState;
    const OTHER_STATE: Option<Kind> = Some(Kind::ElementState);

    fn check(element: &Element) -> Result<(), Error> {
        element.check_directions(Directions::Two)
    }

    fn check_motion(element: &Element, workspace: &mut TwoDirectionsWorkspace, motion: &[f64]) -> Result<(), Error> {
        workspace.check(element, motion)
    }

    fn harmonic_force(
        element: &Element,
        workspace: &mut TwoDirectionsWorkspace,
        motion: &[f64],
        output: HarmonicOutput,
    ) -> Result<(), Error> {
        harmonic_force(element, workspace, motion, output)
    }

    fn check_step(element: &Element, &[u, v, input]: &[f64; 3]) -> Result<(), Error> {
        check_displacement(u)?;
        check_displacement(v)?;
        element.check_input(input)
    }

    fn state_check(state: &[f64]) -> Result<(), Error> {
        TwoDirections::check_header(state)?;
        let mut copy = [0.0; LENGTH];
        Self::copy_used(state, &mut copy);
        let Some(memory) = State::split(&mut copy) else { return Err(Error::StateTooShort) };
        if !state.iter().take(LENGTH).all(|value| is_finite(*value)) {
            return Err(Error::BadState);
        }
        let (at, nodes) = (memory.read(), &*memory.nodes);
        if at.normal_force == 0.0 {
            return Ok(());
        }
        let Units { load, shift, leg } = at.units;
        let [now, slopes] = &at.pressed;
        let positive = [at.normal_force, load, shift, leg, now.load, now.shift[0], now.shift[1], now.leg_squared];
        let small = slopes.values().iter().all(|slope| slope.abs() <= 1.0 / SMALLEST_LENGTH);
        // The nodes lie in order. Only places of points and sizes over that of the flat may be negative, only pressures under sharp edges great.
        let ordered = [SHIFT, SHIFT + 1].into_iter().all(|row| nodes[row].iter().skip(FLAT_EDGE).is_sorted());
        let tables = nodes.iter().enumerate().all(|(row, values)| {
            let least = if row == LEG_SQUARED || row == POINT_SQUARED { f64::MIN } else { 0.0 };
            let most = if row < PRESSURE { LONGEST } else { LONGEST * LONGEST };
            values.iter().all(|value| (least..=most).contains(value))
        });
        let turned = memory.turned.as_flattened().iter().all(|tangent| tangent.abs() <= 1.0);
        let contact = LoadedContact::new(nodes, &at.pressed);
        let within = (0..2).all(|axis| {
            let (limits, rounding) = (contact.limits(nodes)[axis], 1e-9 * now.shift[axis] + 1e-30);
            at.springs.v[axis].iter().zip(limits.iter()).all(|(v, limit)| v.abs() <= limit + rounding)
                && at.springs.edge[axis].abs() <= now.edge_limits()[axis] + rounding
        });
        let all_digits = memory.header[0][ALL_DIGITS_AT];
        let positive = positive.iter().all(|value| *value > 0.0);
        if all_digits == ALL_DIGITS && positive && small && ordered && tables && turned && within {
            Ok(())
        } else {
            Err(Error::BadState)
        }
    }

    fn trial(element: &Element, old: &[f64], displacement: [f64; 3], requested: Requested) -> StepOf<Self> {
        let mut copy = [0.0; LENGTH];
        Self::copy_used(old, &mut copy);
        Self::advance(element, &mut copy, displacement, requested)
    }

    #[inline(never)]
    fn in_copy(_: &Element, state: &[f64], steps: impl FnOnce(&mut [f64])) {
        let mut copy = [0.0; LENGTH];
        Self::copy_used(state, &mut copy);
        steps(&mut copy);
    }

    fn advance(element: &Element, state: &mut [f64], to: [f64; 3], requested: Requested) -> StepOf<Self> {
        State::split(state).map_or(StepResult::NONE, |mut state| state.advance(element, to, requested))
    }
}

/// The parts of a state.
struct State<'a> {
    header: &'a mut [[f64; SPRINGS]; HEADER_ROWS],
    v: &'a mut PerAxis<[f64; SPRINGS]>,
    turned: &'a mut PerAxis<[f64; SPRINGS]>,
    nodes: &'a mut Nodes,
}

impl State<'_> {
    fn split(state: &mut [f64]) -> Option<State<'_>> {
        let (header, rest) = state.blocks_mut::<SPRINGS>().split_first_chunk_mut()?;
        let (v, rest) = rest.split_first_chunk_mut()?;
        let (turned, rest) = rest.split_first_chunk_mut()?;
        Some(State { header, v, turned, nodes: rest.first_chunk_mut()? })
    }

    fn read(&self) -> ContactState {
        let [first, second] = &*self.header;
        let [_, normal_force, load_slope, v, u, input, key, load, shift, leg, edge_x, edge_y, ..] = *first;
        let pressed = |from: usize| ScaledNormalState::from_values(core::array::from_fn(|i| second[from + i]));
        ContactState {
            displacement: [u, v, input],
            normal_force,
            load_slope,
            key,
            units: Units { load, shift, leg },
            pressed: [pressed(0), pressed(SPRINGS - VALUES)],
            springs: Displacements { v: self.v.map(Lanes), edge: [edge_x, edge_y] },
        }
    }

    fn write(&mut self, at: &ContactState) {
        let ContactState { displacement: [u, v, input], normal_force, load_slope, key, units, pressed, springs } = *at;
        let Units { load, shift, leg } = units;
        let ([x, y], tag) = (springs.edge, Kind::TwoDirectionsState.tag());
        let all_digits = if normal_force > 0.0 { ALL_DIGITS } else { 0.0 };
        *self.header = [[0.0; SPRINGS]; HEADER_ROWS];
        let [first, second] = &mut *self.header;
        first.copy_from(&[tag, normal_force, load_slope, v, u, input, key, load, shift, leg, x, y, all_digits]);
        second.copy_from(&pressed[0].values());
        second.part_mut(SPRINGS - VALUES..).copy_from(&pressed[1].values());
        *self.v = [springs.v[0].0, springs.v[1].0];
    }

    /// A step.
    fn advance(&mut self, element: &Element, to: [f64; 3], requested: Requested) -> StepOf<TwoDirections> {
        let (closes, mut at) = (element.is_closed(to[2]), self.read());
        if element.friction_coefficient == 0.0 || !(closes || at.normal_force > 0.0) {
            // Without friction, or open before and after, only the position changes.
            let normal = if closes { element.normal(to[2]) } else { Normal::OPEN };
            let mut result = StepResult::NONE;
            (result.force[2], result.tangent[8]) = (normal.load, normal.load_slope);
            self.open(to);
            return result;
        }
        if at.key != element.key {
            // The springs of another element relax where they are.
            let was_closed = at.normal_force > 0.0 && element.is_closed(at.displacement[2]);
            at = ContactState { key: element.key, ..ContactState::open_at(at.displacement) };
            if was_closed {
                at.set_nodes(element, self.nodes, element.normal(at.displacement[2]).load);
            }
        }
        if closes { self.step(element, at, to, requested) } else { self.separate(element, &at, to, requested) }
    }

    /// A step of a contact that is closed at its end.
    fn step(
        &mut self,
        element: &Element,
        mut at: ContactState,
        to: [f64; 3],
        requested: Requested,
    ) -> StepOf<TwoDirections> {
        let was_closed = at.normal_force > 0.0;
        let same = was_closed && to[2].to_bits() == at.displacement[2].to_bits();
        let normal = if same {
            Normal { load: at.normal_force, load_slope: at.load_slope, ..Normal::OPEN }
        } else {
            element.normal(to[2])
        };
        let (mut from, mut old_nodes) = (LoadedContact::default(), None);
        if was_closed {
            from = LoadedContact::new(self.nodes, &at.pressed);
            if normal.load > at.units.load * (1.0 + LOAD_TOLERANCE) {
                old_nodes = Some(at.move_nodes(element, self.nodes, &from, normal.load));
                from = LoadedContact::new(self.nodes, &at.pressed);
            }
        } else {
            // Springs that close in a step all carry the same part of it, at any nodes.
            at.units = Units::at_load(element, normal.load);
            fill(self.nodes, element, &at.units, 1.0);
        }
        let path = ContactPath::new(element, &at.units, [at.displacement, to], [was_closed, true]);
        let unit = element.friction_coefficient * at.units.load;
        let mut contact = from;
        if !same {
            at.pressed = ScaledNormalState::new(element, &at.units, to[2], &normal);
            contact = LoadedContact::new(self.nodes, &at.pressed);
        }
        let motion = SpringMotion { displacement: path.displacement, constant_load: same };
        let mut step = StepWork::NONE;
        (step.middle.turned, step.end.turned) = (Lanes(self.turned[0]), Lanes(self.turned[1]));
        let contacts = [&from, &contact];
        let force = step.advance(self.nodes, contacts, &motion, &mut at.springs);
        let [x, y] = within_friction_limit(force, contact.now.load, 1.0);
        let mut result = StepResult { force: [unit * x, unit * y, normal.load], ..StepResult::NONE };
        if requested.tangent {
            let units = [unit * path.per_distance, unit / element.input_scale()];
            let old_nodes = old_nodes.as_ref().map(|old_nodes| (old_nodes, element, &at.units));
            let slopes = tangent(self.nodes, contacts, (&path, &motion), (&step, &at.springs, force), old_nodes);
            result.tangent = tangent_of(slopes, units, normal.load_slope);
        }
        if requested.energy {
            let unit = unit * element.friction_coefficient * at.units.shift * path.scale;
            result.dissipated = unit * dissipated(self.nodes, contacts, &motion, &step, &at.springs);
        }
        *self.turned = [step.middle.turned.0, step.end.turned.0];
        (at.displacement, at.normal_force, at.load_slope) = (to, normal.load, normal.load_slope);
        if let Some(load) = at.load_of_nodes_after_gross_slip(&contact, &step, [x, y]) {
            at.move_nodes(element, self.nodes, &contact, load);
        }
        self.write(&at);
        result
    }

    /// A step of a contact that is open at its end.
    fn separate(
        &mut self,
        element: &Element,
        at: &ContactState,
        to: [f64; 3],
        requested: Requested,
    ) -> StepOf<TwoDirections> {
        let mut result = StepResult::NONE;
        if requested.energy && at.normal_force > 0.0 {
            let from = LoadedContact::new(self.nodes, &at.pressed);
            let path = ContactPath::new(element, &at.units, [at.displacement, to], [true, false]);
            let unit = element.friction_coefficient * at.units.load;
            let unit = unit * element.friction_coefficient * at.units.shift * path.scale;
            result.dissipated =
                unit * separated(self.nodes, &from, &ScaledNormalState::default(), path.displacement, &at.springs);
        }
        self.open(to);
        result
    }

    /// The state of a new contact, at a displacement.
    fn open(&mut self, displacement: [f64; 3]) {
        if self.header[0][KEY] != 0.0 {
            (*self.turned, *self.nodes) = ([[0.0; SPRINGS]; 2], [[0.0; SPRINGS]; ROWS]);
        }
        self.write(&ContactState::open_at(displacement));
    }
}

/// Derivatives of the force of a step: by the normal component and by both displacements of the springs. If the nodes have moved to the load
/// at the end, it depends on them too.
#[inline(never)]
fn tangent(
    nodes: &Nodes,
    [from, contact]: [&LoadedContact; 2],
    (path, motion): (&ContactPath, &SpringMotion),
    (step, springs, force): (&StepWork, &Displacements, PerAxis<f64>),
    old_nodes: Option<(&OldNodes, &Element, &Units)>,
) -> [[f64; 3]; 2] {
    let (mut displacement, mut changes) = ([Lanes::<4>::ZERO; 2], SpringChanges::ZERO);
    let (mut tangent, mut by_parameters) = (StepTangent::NONE, [Lanes::ZERO; PARAMETERS]);
    tangent.set_slips(step, motion);
    (by_parameters[END][END], by_parameters[REFERENCE][REFERENCE]) = (1.0, 1.0);
    for axis in 0..2 {
        (displacement[axis][END], displacement[axis][DISPLACEMENT_LANES[axis]]) = (path.per_input[axis][1], 1.0);
    }
    let slopes = ContactSlopes::by_load(nodes, contact);
    let values = (step, motion, springs);
    tangent.terms[END].set(contact, values, [None, Some(&slopes)], None);
    if let Some((old_nodes, element, units)) = old_nodes {
        let mut neighbours = [[[0.0; SPRINGS]; ROWS]; 2];
        let moved = [1.0 + DIFFERENCE_STEP, 1.0 - DIFFERENCE_STEP].map(|size| {
            let nodes = &mut neighbours[usize::from(size < 1.0)];
            fill(nodes, element, units, size);
            old_nodes.moved_to(nodes, &from.now, units)
        });
        for axis in 0..2 {
            for j in 0..SPRINGS {
                changes.v[axis][j][REFERENCE] = (0.5 / DIFFERENCE_STEP) * (moved[0].v[axis][j] - moved[1].v[axis][j]);
            }
        }
        let [larger, smaller] = &neighbours;
        let by_nodes = slopes_of_nodes([larger, smaller]);
        let slopes = [from, contact].map(|contact| ContactSlopes::by_reference(nodes, &by_nodes, contact));
        tangent.terms[REFERENCE].set(contact, values, [Some(&slopes[0]), Some(&slopes[1])], Some(&by_nodes));
    }
    let parameters = ParameterChanges { tangent: &tangent, changes: by_parameters };
    let propagation = Propagation { contacts: [from, contact], nodes, motion, step, parameters };
    let by_force = propagation.propagate(&displacement, &mut changes);
    let slopes = propagation.within_friction_limit(force, by_force);
    // The size is the reference size.
    slopes.map(|slopes| {
        [
            slopes[END] + 0.5 * contact.slopes.leg_squared * slopes[REFERENCE],
            slopes[DISPLACEMENT_LANES[0]],
            slopes[DISPLACEMENT_LANES[1]],
        ]
    })
}

/// The tangent from the derivatives of both forces by the normal component, u and v, in the units of the springs.
fn tangent_of(slopes: [[f64; 3]; 2], [per_distance, per_input]: [f64; 2], load_slope: f64) -> [f64; 9] {
    let [[w_x, x_x, x_y], [w_y, y_x, y_y]] = slopes;
    let [xx, yx, xy, yy] = [x_x, y_x, x_y, y_y].map(|slope| per_distance * slope);
    [xx, yx, 0.0, xy, yy, 0.0, per_input * w_x, per_input * w_y, load_slope]
}
