//! The law in two directions: steps of a state in the caller's memory. A contact that opens has the state of a new one.

use super::TwoDirections;
use super::energy::{dissipated, separated};
use super::harmonic_force::{HarmonicOutput, TwoDirectionsWorkspace, harmonic_force};
use super::moving_nodes::{ALL_DIGITS, LENGTH, OldSprings, State, Step};
use super::nodes::{FLAT_EDGE, Nodes, PerAxis, Row, SPRINGS, Units};
use super::path::{ContactPath, MAX_MOTION};
use super::shells::ScaledNormalState;
use super::step::{Displacements, LoadedContact, SMALLEST_LENGTH, SolvedStep, by_spring};
use super::tangent::{ContactSlopes, ParameterChanges, PerParameter, Propagation, StepTangent};
use crate::element::{Directions, Element, NormalState};
use crate::error::{Error, ensure};
use crate::law::{Law, LawStep, Requested, StepResult};
use crate::limits::check_displacement;
use crate::numerics::fp_class::is_finite;
use crate::numerics::lanes::Lanes;
use crate::numerics::record::{records, records_mut};
use crate::tag::Kind;
use core::ops::RangeInclusive;

/// Nodes move to a load that exceeds theirs by more than this part, its rounding error.
const LOAD_TOLERANCE: f64 = 1e-12;

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
        let Some(state) =
            records::<State>(state).first().filter(|_| state.iter().take(LENGTH).all(|value| is_finite(*value)))
        else {
            return Err(Error::BadState);
        };
        let State {
            normal_force, units: Units { load, shift, leg }, normal_states: [now, slopes], springs, nodes, ..
        } = state;
        if *normal_force == 0.0 {
            return Ok(());
        }
        let positive = [*normal_force, *load, *shift, *leg, now.load, now.shift[0], now.shift[1], now.inside];
        let small = slopes.values().iter().all(|slope| slope.abs() <= 1.0 / SMALLEST_LENGTH);
        // The nodes lie in order. leg² and x² - a² are negative for the flat, and F_ij may be large under sharp edges.
        let ordered = nodes.shift.iter().all(|row| row.iter().skip(FLAT_EDGE).is_sorted());
        let within = |rows: &[Row], range: RangeInclusive<f64>| {
            rows.iter().flat_map(|row| row.iter()).all(|value| range.contains(value))
        };
        let [shift_x, shift_y] = nodes.shift;
        let [step_x, step_y] = nodes.delta_shift;
        let tables =
            within(&[nodes.load, shift_x, shift_y, nodes.psi, nodes.delta_load, step_x, step_y], 0.0..=MAX_MOTION)
                && within(&[nodes.leg_squared, nodes.point_squared], f64::MIN..=MAX_MOTION)
                && within(&nodes.pressure, 0.0..=MAX_MOTION * MAX_MOTION);
        let guesses = within(&state.rotation_guess, -1.0..=1.0);
        let limits = state.contact().limits(nodes);
        let bounded = (0..2).all(|axis| {
            let rounding = 1e-9 * now.shift[axis] + 1e-30;
            springs.v[axis].iter().zip(limits[axis].iter()).all(|(v, limit)| v.abs() <= limit + rounding)
                && springs.edge[axis].abs() <= now.edge_limits()[axis] + rounding
        });
        let positive = positive.iter().all(|value| *value > 0.0);
        ensure(
            state.all_digits == ALL_DIGITS && positive && small && ordered && tables && guesses && bounded,
            Error::BadState,
        )
    }

    fn trial(element: &Element, old: &[f64], displacement: [f64; 3], requested: Requested) -> LawStep<Self> {
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

    fn advance(element: &Element, state: &mut [f64], to: [f64; 3], requested: Requested) -> LawStep<Self> {
        records_mut::<State>(state).first_mut().map_or(StepResult::NONE, |state| state.advance(element, to, requested))
    }
}

/// The lane of changes of the normal component in a tangent, after those of both displacements.
const NORMAL_COMPONENT: usize = 2;

impl State {
    /// A step of a contact that may open or close.
    fn advance(&mut self, element: &Element, to: [f64; 3], requested: Requested) -> LawStep<TwoDirections> {
        let (closes, was_closed) = (element.is_closed(to[2]), self.normal_force > 0.0);
        if element.friction_coefficient == 0.0 || !(closes || was_closed) {
            // Without friction, or open before and after, only the position changes.
            let normal = if closes { element.normal(to[2]) } else { NormalState::OPEN };
            let mut result = StepResult::NONE;
            (result.force[2], result.tangent[8]) = (normal.load, normal.load_slope);
            *self = State::open(to);
            return result;
        }
        if self.key != element.key {
            // The state was advanced with another element: its position is kept, its springs relax.
            *self = State::open(self.displacement);
            let [.., input] = self.displacement;
            if was_closed && element.is_closed(input) {
                self.set_nodes(element, element.normal(input).load);
                self.press(element, input);
            }
        }
        (self.key, self.all_digits) = (element.key, ALL_DIGITS);
        if closes { self.step(element, to, requested) } else { self.separate(element, to, requested) }
    }

    /// A step of a contact that is closed at its end.
    fn step(&mut self, element: &Element, to: [f64; 3], requested: Requested) -> LawStep<TwoDirections> {
        let (mut contacts, mut old_springs) = ([LoadedContact::default(); 2], None);
        let load = element.normal(to[2]).load;
        if self.normal_force > 0.0 {
            contacts[1] = self.contact();
            if load > self.units.load * (1.0 + LOAD_TOLERANCE) {
                let (old, moved) = self.move_nodes(element, &contacts[1], load);
                (contacts[1], old_springs) = (moved, Some(old));
            }
        } else {
            // Springs that close in a step all carry the same part of it, at any nodes.
            self.set_nodes(element, load);
        }
        let mut solved = SolvedStep::ZERO;
        solved.slips.iter_mut().zip(self.rotation_guess).for_each(|(slip, guess)| slip.rotation_guess = guess);
        let Step { path, force: [x, y] } = self.step_at_nodes(element, &mut contacts, to, &mut solved);
        let (contacts, unit) = (contacts.each_ref(), element.friction_coefficient * self.units.load);
        let mut result = StepResult { force: [unit * x, unit * y, self.normal_force], ..StepResult::NONE };
        if requested.tangent {
            let node_slopes = old_springs.map(|old_springs| (old_springs, Nodes::slopes(element, &self.units)));
            let [x, y] = self.tangent(element, contacts, &path, &solved, node_slopes.as_ref());
            let (per_distance, per_input) = (unit * path.per_distance, unit / element.input_scale());
            let column = |lane: usize, unit: f64| [unit * x[lane], unit * y[lane]];
            let ([xx, yx], [xy, yy]) = (column(0, per_distance), column(1, per_distance));
            let [xn, yn] = column(NORMAL_COMPONENT, per_input);
            result.tangent = [xx, yx, 0.0, xy, yy, 0.0, xn, yn, self.load_slope];
        }
        if requested.energy {
            result.dissipated =
                self.energy_unit(element, &path) * dissipated(&self.nodes, contacts, &path, &solved, &self.springs);
        }
        self.rotation_guess = solved.slips.each_ref().map(|slip| slip.rotation_guess);
        if let Some(load) = self.load_of_nodes_after_gross_slip(contacts[1], &solved, [x, y]) {
            self.move_nodes(element, contacts[1], load);
        }
        result
    }

    /// Derivatives of the force of a step by both displacements of the springs and by the normal component over its
    /// scale. If the nodes have moved to the load at the end, its size is their reference size, and the springs before
    /// the step depend on it too.
    #[inline(never)]
    fn tangent(
        &self,
        element: &Element,
        contacts: [&LoadedContact; 2],
        path: &ContactPath,
        solved: &SolvedStep,
        moved: Option<&(OldSprings, Nodes)>,
    ) -> PerAxis<Lanes<4>> {
        let node_slopes = moved.map(|(_, node_slopes)| node_slopes);
        let (mut tangent, mut changes) = (StepTangent::ZERO, PerParameter::default());
        let [from, to] = contacts.map(|contact| ContactSlopes::new(&self.nodes, node_slopes, contact));
        tangent.set((solved, path), contacts, [&from, &to], node_slopes);
        changes.end = Lanes([0.0, 0.0, 1.0, 0.0]);
        let mut springs = Displacements { v: [[Lanes::ZERO; SPRINGS]; 2], edge: [Lanes::ZERO; 2] };
        if let Some((old_springs, node_slopes)) = moved {
            let [.., input] = self.displacement;
            let by_input = Units::logarithmic_slope(element, input);
            changes.reference = by_input * changes.end;
            let moved = old_springs.moved_to(contacts[0], &self.units, &(&self.nodes, Some(node_slopes)));
            springs.v = by_spring(|axis, j| moved.v[axis][j].slopes[0] * changes.reference);
        }
        let displacement = [Lanes([1.0, 0.0, path.per_input[0][1], 0.0]), Lanes([0.0, 1.0, path.per_input[1][1], 0.0])];
        let parameters = ParameterChanges { tangent: &tangent, changes };
        let propagation = Propagation { contacts, nodes: &self.nodes, path, solved, parameters };
        propagation.propagate(&displacement, &mut springs)
    }

    /// The unit of the energy of a step \[J\].
    fn energy_unit(&self, element: &Element, path: &ContactPath) -> f64 {
        let Units { load, shift, .. } = self.units;
        element.friction_coefficient * load * element.friction_coefficient * shift * path.scale
    }

    /// A step of a contact that is open at its end.
    fn separate(&mut self, element: &Element, to: [f64; 3], requested: Requested) -> LawStep<TwoDirections> {
        let mut result = StepResult::NONE;
        if requested.energy && self.normal_force > 0.0 {
            let path = ContactPath::new(element, &self.units, [self.displacement, to], [true, false]);
            let open = ScaledNormalState::ZERO;
            result.dissipated = self.energy_unit(element, &path)
                * separated(&self.nodes, &self.contact(), &open, path.displacement, &self.springs);
        }
        *self = State::open(to);
        result
    }
}
