//! The contact between two steps, and its nodes, which move with the load.
//!
//! The nodes are those of the largest load since the contact closed. A step to a larger one first moves them to its
//! load, by as little as the load exceeds theirs: so the force is continuous in the load. The displacements of the
//! springs over S are a polygon, whose values at the new nodes are the new displacements. Gross slip in one direction
//! erases the memory of an overload: all springs are at their limits, which any nodes represent.

use super::nodes::{FLAT_EDGE, NodeValues, Nodes, PerAxis, Row, Units, by_axis, length};
use super::path::ContactPath;
use super::shells::ScaledNormalState;
use super::step::{Displacements, LoadedContact, SMALLEST_LENGTH, SolvedStep, by_spring, within_friction_limit};
use crate::element::Element;
use crate::numerics::dual::Number;
use crate::numerics::guard::quotient;
use crate::numerics::record::record;
use crate::numerics::slices::Zero;
use crate::tag::Kind;
use core::ops::Range;

/// Gross slip leaves nodes whose load is at most this multiple of the present one: they are accurate enough.
const LARGEST_LOAD_OF_NODES: f64 = 3.0;
/// If the force is within this relative distance of Coulomb's bound, all points slip in one direction, and springs at
/// any nodes carry the same force but for rounding. Between one and two times this distance the effect vanishes
/// linearly.
const SAME_DIRECTION: f64 = 1e-13;
/// Nodes move to a smaller load if this changes by more than this part.
const WORTH_NEW_NODES: f64 = 1e-3;

/// Decimal text of 16 significant digits or fewer changes this double, which is halfway between two numbers of 16
/// digits: the state of a closed contact is rejected then. Its springs at the edge are so stiff that rounding errors of
/// their limits would be amplified.
pub(super) const ALL_DIGITS: f64 = 1_000.000_000_000_000_5;

record! {
    /// The state of a contact between two steps; the contact is open if the normal force is 0.
    pub(super) struct State {
        pub tag: f64,
        pub normal_force: f64,
        pub load_slope: f64,
        /// Tangential displacements and normal component.
        pub displacement: [f64; 3],
        /// The key of the element whose nodes these are.
        pub key: f64,
        pub units: Units,
        /// The normal state in these units, and its derivatives by the normal component over its scale.
        pub normal_states: [ScaledNormalState; 2],
        pub springs: Displacements,
        /// First guesses of the slips of a step in its middle and at its end.
        pub rotation_guess: [Row; 2],
        pub all_digits: f64,
        pub nodes: Nodes,
    }
}

pub(super) const LENGTH: usize = size_of::<State>() / size_of::<f64>();

impl State {
    /// The state of a new contact, at a displacement.
    pub fn open(displacement: [f64; 3]) -> State {
        State { tag: Kind::TwoDirectionsState.tag(), displacement, ..State::zero() }
    }

    /// The contact under the present load.
    pub fn contact(&self) -> LoadedContact {
        LoadedContact::new(&self.nodes, &self.normal_states)
    }

    /// Sets the normal state under a normal component that closes the contact: the contact with the present nodes.
    pub fn press(&mut self, element: &Element, input: f64) -> LoadedContact {
        let normal = element.normal(input);
        (self.normal_force, self.load_slope) = (normal.load, normal.load_slope);
        self.normal_states = ScaledNormalState::new(element, &self.units, input, &normal);
        self.contact()
    }

    /// Sets the units and nodes of a reference load.
    #[inline(never)]
    pub fn set_nodes(&mut self, element: &Element, load: f64) {
        self.units = Units::at_load(element, load);
        self.nodes.fill(element, &self.units, 1.0);
    }

    /// A step that keeps the nodes, to a contact that is closed. On entry the second contact is the present one, open
    /// or closed; on return the contacts are those at the start and at the end of the step.
    pub fn step_at_nodes(
        &mut self,
        element: &Element,
        contacts: &mut [LoadedContact; 2],
        to: [f64; 3],
        solved: &mut SolvedStep,
    ) -> Step {
        let [from, contact] = contacts;
        *from = *contact;
        let path = ContactPath::new(element, &self.units, [self.displacement, to], [from.normal.load > 0.0, true]);
        if !path.constant_load {
            *contact = self.press(element, to[2]);
        }
        self.displacement = to;
        let force = solved.advance(&self.nodes, [from, contact], &path, &mut self.springs);
        Step { path, force: within_friction_limit(force, contact.normal.load, 1.0) }
    }

    /// Moves the nodes of a contact to a reference load, and the springs with them: the springs before, and the contact
    /// with the new nodes.
    pub fn move_nodes(&mut self, element: &Element, old: &LoadedContact, load: f64) -> (OldSprings, LoadedContact) {
        let (springs, limits) = (self.springs, old.limits(&self.nodes));
        let old = OldSprings { shift_unit: self.units.shift, springs, limits, used: old.shells.range() };
        self.set_nodes(element, load);
        let [.., input] = self.displacement;
        let contact = self.press(element, input);
        self.springs = old.moved_to(&contact, &self.units, &self.nodes);
        (old, contact)
    }

    /// Gross slip in one direction erases the memory of an overload, as the innermost spring slips: the load to which
    /// the nodes move after a step with this force, if that is worth new nodes.
    pub fn load_of_nodes_after_gross_slip(
        &self,
        contact: &LoadedContact,
        solved: &SolvedStep,
        force: PerAxis<f64>,
    ) -> Option<f64> {
        let (load, largest) = (LARGEST_LOAD_OF_NODES * self.normal_force, self.units.load);
        let aligned = 2.0 - (1.0 - quotient(length(force), contact.normal.load)) / SAME_DIRECTION;
        if largest <= load || aligned <= 0.0 {
            return None;
        }
        let first = contact.shells.innermost();
        let slip = by_axis(|axis| {
            (solved.follow[axis][first] - self.springs.v[axis][first]) / contact.normal.shift[axis].max(SMALLEST_LENGTH)
        });
        let nodes_load = load + (largest - load) / (1.0 + aligned.min(1.0) * length(slip));
        (nodes_load < largest * (1.0 - WORTH_NEW_NODES)).then_some(nodes_load)
    }
}

/// Path and force of a step to a contact that is closed.
pub(super) struct Step {
    pub path: ContactPath,
    /// The tangential force over that of gross slip under the load of the nodes.
    pub force: PerAxis<f64>,
}

/// Springs at the nodes of another load, which have moved since.
pub(super) struct OldSprings {
    shift_unit: f64,
    springs: Displacements,
    limits: PerAxis<Row>,
    used: Range<usize>,
}

impl OldSprings {
    /// The springs at the nodes of a contact under the same load, which may have derivatives: their displacements are
    /// polygons over S, with the old nodes as corners.
    pub fn moved_to<T: Number>(
        &self,
        contact: &LoadedContact,
        units: &Units,
        nodes: &impl NodeValues<T>,
    ) -> Displacements<T> {
        let ratio = self.shift_unit / units.shift;
        let edge = self.springs.edge.map(|edge| T::constant(ratio * edge));
        let mut springs = Displacements { v: by_spring(|_, _| T::constant(0.0)), edge };
        for axis in 0..2 {
            let (limits, old) = (&self.limits[axis], &self.springs.v[axis]);
            for j in contact.shells.range() {
                let corners = limits.iter().zip(old).take(self.used.end).skip(FLAT_EDGE).rev();
                let limit = T::constant(contact.normal.shift[axis]) - nodes.get(|nodes| nodes.shift[axis][j]);
                springs.v[axis][j] = if j >= FLAT_EDGE {
                    polygon(limit * (1.0 / ratio), corners.map(|(limit, v)| [*limit, *v])) * ratio
                } else {
                    // A flat that was too small for the old nodes moves with the innermost spring.
                    T::constant(ratio * old[self.used.start.min(FLAT_EDGE)])
                };
            }
        }
        springs
    }
}

/// The value at an abscissa of a polygon that begins at (0, 0).
fn polygon<T: Number>(at: T, corners: impl Iterator<Item = [f64; 2]>) -> T {
    let mut before = [0.0; 2];
    for corner in corners {
        if corner[0] >= at.value() {
            let slope = quotient(corner[1] - before[1], corner[0] - before[0]);
            return T::constant(before[1]) + (at - T::constant(before[0])) * slope;
        }
        before = corner;
    }
    T::constant(before[1])
}
