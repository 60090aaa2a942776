//! The state of an element with two directions in the caller's memory, and a step of it.
//!
//! ```text
//! [tag, normal force and its derivative, v, u, normal component, key of the element, units of the springs (3),
//!  spring at the edge (2), a double that needs 17 digits | normal state in these units, and its derivatives (7 each) |
//!  springs | turned | nodes]
//! ```
//!
//! in rows of as many doubles as springs. A contact that opens has the state of a new one.
//!
//! The nodes are those of the largest load since the contact closed. A step to a larger one first moves them to its load, by as little as the
//! load exceeds theirs: so the force is continuous in the load. Moved springs are the polygon of the springs over S. An overload is forgotten
//! in gross slip of one direction: there all springs are at their limits, which any nodes represent.

use super::TwoDirections;
use super::energy::{dissipated, separated};
use super::harmonic_force::{HarmonicOutput, TwoDirectionsWorkspace, harmonic_force};
use super::nodes::{
    FLAT_EDGE, LEG_SQUARED, NEIGHBOUR, Nodes, POINT_SQUARED, PRESSURE, PerAxis, ROWS, SHIFT, SPRINGS, Units, by_axis,
    fill, first_shell, last_node, length,
};
use super::path::{ContactPath, LONGEST};
use super::shells::{Pressed, VALUES};
use super::step::{Displacements, LEAST, LoadedContact, SpringMotion, StepWork, within_friction_limit};
use super::tangent::{
    ContactSlopes, END, PARAMETERS, ParameterChanges, ParameterTerms, Propagation, REFERENCE, SpringChanges,
    slopes_of_nodes,
};
use crate::element::{Directions, Element, Normal};
use crate::error::Error;
use crate::law::{Law, PathOutput, Requested, StepOf, StepResult};
use crate::limits::check_displacement;
use crate::numerics::fp_class::is_finite;
use crate::numerics::guard::quotient;
use crate::numerics::lanes::Lanes;
use crate::numerics::total::Total;
use crate::tag::Kind;

/// The largest load of the nodes over the present one that gross slip does not forget: nodes of such a load are accurate enough.
const REMEMBERED: f64 = 3.0;
/// The distance of the force from Coulomb's bound, over it, up to which all points slip in one direction, and from twice which on they do not:
/// then springs at other nodes carry the same force, but for rounding.
const SAME_DIRECTION: f64 = 1e-13;
/// Changes of the load of the nodes that are worth new ones.
const LEAST_CHANGE: f64 = 1e-3;
/// Lanes of both displacements in a tangent, beside those of the normal component and of the nodes.
const ALONG: [usize; 2] = [1, 3];
/// The rounding error of the load of nodes.
const ROUNDING: f64 = 1e-12;

/// Decimal text of 16 significant digits or fewer changes this double, which is halfway between two numbers of 16 digits: the state of a
/// closed contact is rejected then. Its springs at the edge are so stiff that rounding errors of their limits would be amplified.
const ALL_DIGITS: f64 = 1_000.000_000_000_000_5;

const HEADER_ROWS: usize = 2;
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
        element.check_normal(element.by_approach(), input)
    }

    fn state_check(state: &[f64]) -> Result<(), Error> {
        TwoDirections::check_header(state)?;
        let mut copy = [0.0; LENGTH];
        Self::copy_used(state, &mut copy);
        let Some(memory) = State::split(&mut copy) else { return Err(Error::StateTooShort) };
        if !state.iter().take(LENGTH).all(|value| is_finite(*value)) {
            return Err(Error::BadState);
        }
        let (at, springs, nodes) = (memory.place(), memory.springs(), &*memory.nodes);
        if at.normal_force == 0.0 {
            return Ok(());
        }
        let Units { load, shift, leg } = at.units;
        let [now, slopes] = &at.pressed;
        let positive = [at.normal_force, load, shift, leg, now.load, now.shift[0], now.shift[1], now.leg_squared];
        let small = slopes.values().iter().all(|slope| slope.abs() <= 1.0 / LEAST);
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
            springs.v[axis].iter().zip(limits.iter()).all(|(v, limit)| v.abs() <= limit + rounding)
                && springs.edge[axis].abs() <= contact.edge_limits()[axis] + rounding
        });
        let [.., all_digits, _, _, _, _, _, _, _] = memory.header[0];
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

    fn advance(element: &Element, state: &mut [f64], to: [f64; 3], requested: Requested) -> StepOf<Self> {
        State::split(state).map_or(StepResult::NONE, |mut state| state.advance(element, to, requested))
    }

    #[inline(never)]
    fn path_in_copy(element: &Element, state: &[f64], path: &[[f64; 3]], output: PathOutput<Self>) {
        let mut copy = [0.0; LENGTH];
        Self::copy_used(state, &mut copy);
        Self::path(element, &mut copy, path, output);
    }
}

/// Where a contact is; open if the normal force is 0.
#[derive(Debug, Clone, Copy, Default)]
struct ContactState {
    displacement: [f64; 3],
    normal_force: f64,
    load_slope: f64,
    /// Of the element whose nodes these are.
    key: f64,
    units: Units,
    pressed: [Pressed; 2],
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

    fn place(&self) -> ContactState {
        let [first, [now @ .., _, _, _, _, _, _, a, b, c, d, e, f, g]] = *self.header;
        let [_, normal_force, load_slope, v, u, input, key, load, shift, leg, ..] = first;
        ContactState {
            displacement: [u, v, input],
            normal_force,
            load_slope,
            key,
            units: Units { load, shift, leg },
            pressed: [Pressed::from_values(now), Pressed::from_values([a, b, c, d, e, f, g])],
        }
    }

    fn springs(&self) -> Displacements {
        let ([x, y], [.., edge_x, edge_y, _, _, _, _, _, _, _, _]) = (*self.v, self.header[0]);
        Displacements { v: [Lanes(x), Lanes(y)], edge: [edge_x, edge_y] }
    }

    fn write(&mut self, at: &ContactState, springs: &Displacements) {
        let ContactState { displacement: [u, v, input], normal_force, load_slope, key, units, pressed } = *at;
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
        let closes = element.is_closed(to[2]);
        let (mut at, mut springs, mut result) = (self.place(), self.springs(), StepResult::NONE);
        if element.friction_coefficient == 0.0 || !(closes || at.normal_force > 0.0) {
            // Without friction, or open before and after, only the position changes.
            if closes {
                let normal = element.normal(to[2]);
                (result.force[2], result.tangent[8]) = (normal.load, normal.load_slope);
            }
            self.open(to);
            return result;
        }
        if at.key != element.key {
            // The springs of another element relax where they are.
            springs = Displacements::NONE;
            at = ContactState { displacement: at.displacement, key: element.key, ..ContactState::default() };
            if element.is_closed(at.displacement[2]) && self.header[0][1] > 0.0 {
                at.set_nodes(element, self.nodes, element.normal(at.displacement[2]).load);
            }
        }
        let was_closed = at.normal_force > 0.0;
        let same = closes && was_closed && to[2].to_bits() == at.displacement[2].to_bits();
        let normal = match (closes, same) {
            (true, false) => element.normal(to[2]),
            _ => Normal { load: at.normal_force, load_slope: at.load_slope, ..Normal::OPEN },
        };
        let (mut from, mut old_nodes) = (LoadedContact::OPEN, None);
        if was_closed {
            from = LoadedContact::new(self.nodes, &at.pressed);
        } else {
            // Springs that close in a step all carry the same part of it, at any nodes.
            at.units = Units::at_load(element, normal.load);
            fill(self.nodes, element, &at.units, 1.0);
        }
        if was_closed && normal.load > at.units.load * (1.0 + ROUNDING) {
            let old = OldNodes { units: at.units, springs, nodes: *self.nodes, contact: from };
            at.set_nodes(element, self.nodes, normal.load);
            springs = old.moved_to(self.nodes, &at.pressed[0], &at.units);
            from = LoadedContact::new(self.nodes, &at.pressed);
            old_nodes = Some(old);
        }
        let path = ContactPath::new(element, &at.units, [at.displacement, to], [was_closed, closes]);
        let unit = element.friction_coefficient * at.units.load;
        let energy_unit = unit * element.friction_coefficient * at.units.shift * path.scale;
        if !closes {
            if requested.energy {
                let energy = separated(self.nodes, &from, &Pressed::default(), path.displacement, &springs);
                result.dissipated = energy_unit * energy;
            }
            self.open(to);
            return result;
        }
        let mut pressed = None;
        if !same {
            at.pressed = Pressed::new(element, &at.units, to[2], &normal);
            pressed = Some(LoadedContact::new(self.nodes, &at.pressed));
        }
        let contact = pressed.as_ref().unwrap_or(&from);
        let motion =
            SpringMotion { shift_before: from.now.shift, displacement: path.displacement, constant_load: same };
        let mut step = StepWork::NONE;
        (step.middle.turned, step.end.turned) = (Lanes(self.turned[0]), Lanes(self.turned[1]));
        let contacts = [&from, contact];
        let force = step.advance(self.nodes, contacts, &motion, &mut springs, requested.tangent);
        let [x, y] = within_friction_limit(force, contact.now.load);
        result.force = [unit * x, unit * y, normal.load];
        if requested.tangent {
            let units = [unit * path.per_distance, unit / element.input_scale()];
            let old_nodes = old_nodes.as_ref().map(|old_nodes| (old_nodes, element, &at.units));
            let slopes = tangent(self.nodes, contacts, (&path, &motion), (&step, &springs, force), old_nodes);
            result.tangent = tangent_of(slopes, units, normal.load_slope);
        }
        if requested.energy {
            result.dissipated = energy_unit * dissipated(self.nodes, contacts, &motion, &step, &springs);
        }
        *self.turned = [step.middle.turned.0, step.end.turned.0];
        (at.displacement, at.normal_force, at.load_slope) = (to, normal.load, normal.load_slope);
        let load = at.remembered_load(contact, &step, &springs, [x, y]);
        if load < at.units.load * (1.0 - LEAST_CHANGE) {
            let old = OldNodes { units: at.units, springs, nodes: *self.nodes, contact: *contact };
            at.set_nodes(element, self.nodes, load);
            springs = old.moved_to(self.nodes, &at.pressed[0], &at.units);
        }
        self.write(&at, &springs);
        result
    }

    /// The state of a new contact, at a place.
    fn open(&mut self, displacement: [f64; 3]) {
        if self.header[0][6] != 0.0 {
            (*self.turned, *self.nodes) = ([[0.0; SPRINGS]; 2], [[0.0; SPRINGS]; ROWS]);
        }
        self.write(&ContactState { displacement, ..ContactState::default() }, &Displacements::NONE);
    }
}

impl ContactState {
    /// Nodes of a load.
    #[inline(never)]
    fn set_nodes(&mut self, element: &Element, nodes: &mut Nodes, load: f64) {
        let input = self.displacement[2];
        let normal = element.normal(input);
        self.units = Units::at_load(element, load);
        fill(nodes, element, &self.units, 1.0);
        self.pressed = Pressed::new(element, &self.units, input, &normal);
        (self.normal_force, self.load_slope) = (normal.load, normal.load_slope);
    }

    /// The load of the nodes after a step with this force. Gross slip in one direction forgets an overload, as the innermost spring slips.
    fn remembered_load(
        &self,
        contact: &LoadedContact,
        step: &StepWork,
        springs: &Displacements,
        force: PerAxis<f64>,
    ) -> f64 {
        let (load, largest) = (REMEMBERED * self.normal_force, self.units.load);
        if largest <= load {
            return largest;
        }
        let aligned = 2.0 - (1.0 - quotient(length(force), contact.now.load)) / SAME_DIRECTION;
        if aligned <= 0.0 {
            return largest;
        }
        let first = contact.shells.innermost();
        let slip =
            by_axis(|axis| (step.trial[axis][first] - springs.v[axis][first]) / contact.now.shift[axis].max(LEAST));
        load + (largest - load) / (1.0 + aligned.min(1.0) * length(slip))
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
    let (mut terms, mut by_parameters) = ([ParameterTerms::NONE; PARAMETERS], [Lanes::ZERO; PARAMETERS]);
    (by_parameters[END][END], by_parameters[REFERENCE][REFERENCE]) = (1.0, 1.0);
    for axis in 0..2 {
        (displacement[axis][END], displacement[axis][ALONG[axis]]) = (path.per_input[axis][1], 1.0);
    }
    let slopes = ContactSlopes::by_load(nodes, contact);
    terms[END].set(contact, (step, motion), [None, Some(&slopes)], None);
    if let Some((old_nodes, element, units)) = old_nodes {
        let mut neighbours = [[[0.0; SPRINGS]; ROWS]; 2];
        let springs = [1.0 + NEIGHBOUR, 1.0 - NEIGHBOUR].map(|size| {
            let nodes = &mut neighbours[usize::from(size < 1.0)];
            fill(nodes, element, units, size);
            old_nodes.moved_to(nodes, &from.now, units)
        });
        for axis in 0..2 {
            for j in 0..SPRINGS {
                changes.v[axis][j][REFERENCE] = (0.5 / NEIGHBOUR) * (springs[0].v[axis][j] - springs[1].v[axis][j]);
            }
        }
        let [larger, smaller] = &neighbours;
        let by_nodes = slopes_of_nodes([larger, smaller]);
        let slopes = [from, contact].map(|contact| ContactSlopes::by_reference(nodes, &by_nodes, contact));
        terms[REFERENCE].set(contact, (step, motion), [Some(&slopes[0]), Some(&slopes[1])], Some(&by_nodes));
    }
    let parameters = ParameterChanges { terms: &terms, changes: by_parameters };
    let propagation = Propagation { contact, nodes, motion, step, new: springs, parameters };
    let by_force = propagation.propagate(&displacement, &mut changes);
    let slopes = propagation.within_friction_limit(force, by_force);
    // The size is the reference size.
    slopes.map(|slopes| {
        [slopes[END] + 0.5 * contact.slopes.leg_squared * slopes[REFERENCE], slopes[ALONG[0]], slopes[ALONG[1]]]
    })
}

/// Springs at nodes of another load.
struct OldNodes {
    units: Units,
    springs: Displacements,
    nodes: Nodes,
    contact: LoadedContact,
}

impl OldNodes {
    /// The springs at new nodes, in their units: their displacements are polygons over S, with the old nodes as corners.
    fn moved_to(&self, nodes: &Nodes, now: &Pressed, units: &Units) -> Displacements {
        let (ratio, first) = (self.units.shift / units.shift, self.contact.shells.innermost());
        let last = last_node(nodes, now.inside_shift[0]);
        let mut new = Displacements { edge: self.springs.edge.map(|edge| ratio * edge), ..Displacements::NONE };
        let limits = self.contact.limits(&self.nodes);
        for axis in 0..2 {
            let (limits, old) = (limits[axis], &self.springs.v[axis]);
            // A flat that was too small for the old nodes moves with the innermost spring.
            for j in first_shell(nodes)..FLAT_EDGE {
                new.v[axis][j] = ratio * old[j.max(first)];
            }
            for (place, node) in new.v[axis].iter_mut().zip(&nodes[SHIFT + axis]).take(last + 1).skip(FLAT_EDGE) {
                let corners = limits.iter().zip(old.iter()).take(self.contact.shells.range().end).skip(FLAT_EDGE).rev();
                *place = ratio * polygon((now.shift[axis] - node) / ratio, corners.map(|(limit, v)| [*limit, *v]));
            }
        }
        new
    }
}

/// The value at an abscissa of a polygon that begins at (0, 0).
fn polygon(at: f64, corners: impl Iterator<Item = [f64; 2]>) -> f64 {
    let mut before = [0.0; 2];
    for corner in corners {
        if corner[0] >= at {
            return before[1] + quotient(at - before[0], corner[0] - before[0]) * (corner[1] - before[1]);
        }
        before = corner;
    }
    before[1]
}

/// The tangent from the derivatives of both forces by the normal component, u and v, in the units of the springs.
fn tangent_of(slopes: [[f64; 3]; 2], [per_distance, per_input]: [f64; 2], load_slope: f64) -> [f64; 9] {
    let [[w_x, x_x, x_y], [w_y, y_x, y_y]] = slopes;
    let [xx, yx, xy, yy] = [x_x, y_x, x_y, y_y].map(|slope| per_distance * slope);
    [xx, yx, 0.0, xy, yy, 0.0, per_input * w_x, per_input * w_y, load_slope]
}
