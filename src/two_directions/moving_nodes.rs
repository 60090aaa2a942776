//! The contact between two steps, and its nodes, which move with the load.
//!
//! The nodes are those of the largest load since the contact closed. A step to a larger one first moves them to its load, by as little as the
//! load exceeds theirs: so the force is continuous in the load. Moved springs are the polygon of the springs over S. Gross slip of one
//! direction erases the memory of an overload: there all springs are at their limits, which any nodes represent.

use super::nodes::{FLAT_EDGE, Nodes, PerAxis, SHIFT, Units, by_axis, fill, first_shell, last_node, length};
use super::shells::ScaledNormalState;
use super::step::{Displacements, LoadedContact, SMALLEST_LENGTH, StepWork};
use crate::element::Element;
use crate::numerics::guard::quotient;

/// Gross slip leaves nodes whose load is at most this multiple of the present one: they are accurate enough.
const LARGEST_LOAD_OF_NODES: f64 = 3.0;
/// If the force is within this relative distance of Coulomb's bound, all points slip in one direction, and springs at any nodes carry the same
/// force but for rounding. Between one and two times this distance the effect vanishes linearly.
const SAME_DIRECTION: f64 = 1e-13;
/// Changes of the load of the nodes that are worth new ones.
const WORTH_NEW_NODES: f64 = 1e-3;

/// What is known of a contact between two steps; it is open if the normal force is 0.
#[derive(Debug, Clone, Copy)]
pub(super) struct ContactState {
    pub displacement: [f64; 3],
    pub normal_force: f64,
    pub load_slope: f64,
    /// The key of the element whose nodes these are.
    pub key: f64,
    pub units: Units,
    /// The normal state in these units, and its derivatives.
    pub pressed: [ScaledNormalState; 2],
    pub springs: Displacements,
}

impl ContactState {
    /// A contact that is open.
    pub fn open_at(displacement: [f64; 3]) -> ContactState {
        ContactState {
            displacement,
            normal_force: 0.0,
            load_slope: 0.0,
            key: 0.0,
            units: Units::default(),
            pressed: [ScaledNormalState::default(); 2],
            springs: Displacements::NONE,
        }
    }

    /// Nodes of a load.
    #[inline(never)]
    pub fn set_nodes(&mut self, element: &Element, nodes: &mut Nodes, load: f64) {
        let input = self.displacement[2];
        let normal = element.normal(input);
        self.units = Units::at_load(element, load);
        fill(nodes, element, &self.units, 1.0);
        self.pressed = ScaledNormalState::new(element, &self.units, input, &normal);
        (self.normal_force, self.load_slope) = (normal.load, normal.load_slope);
    }

    /// Moves the nodes and the springs of a contact to a load.
    pub fn move_nodes(&mut self, element: &Element, nodes: &mut Nodes, contact: &LoadedContact, load: f64) -> OldNodes {
        let old = OldNodes { units: self.units, springs: self.springs, nodes: *nodes, contact: *contact };
        self.set_nodes(element, nodes, load);
        self.springs = old.moved_to(nodes, &self.pressed[0], &self.units);
        old
    }

    /// Gross slip in one direction erases the memory of an overload, as the innermost spring slips: the load to which the nodes move after a
    /// step with this force, if that is worth new nodes.
    pub fn load_of_nodes_after_gross_slip(
        &self,
        contact: &LoadedContact,
        step: &StepWork,
        force: PerAxis<f64>,
    ) -> Option<f64> {
        let (load, largest) = (LARGEST_LOAD_OF_NODES * self.normal_force, self.units.load);
        let aligned = 2.0 - (1.0 - quotient(length(force), contact.now.load)) / SAME_DIRECTION;
        if largest <= load || aligned <= 0.0 {
            return None;
        }
        let first = contact.shells.innermost();
        let slip = by_axis(|axis| {
            (step.trial[axis][first] - self.springs.v[axis][first]) / contact.now.shift[axis].max(SMALLEST_LENGTH)
        });
        let nodes_load = load + (largest - load) / (1.0 + aligned.min(1.0) * length(slip));
        (nodes_load < largest * (1.0 - WORTH_NEW_NODES)).then_some(nodes_load)
    }
}

/// Springs at nodes of another load.
pub(super) struct OldNodes {
    units: Units,
    springs: Displacements,
    nodes: Nodes,
    contact: LoadedContact,
}

impl OldNodes {
    /// The springs at new nodes, in their units: their displacements are polygons over S, with the old nodes as corners.
    pub fn moved_to(&self, nodes: &Nodes, now: &ScaledNormalState, units: &Units) -> Displacements {
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
