//! Derivatives of a step whose values are known: one more step of Newton's method from the solution of each slip.
//!
//! A step is linear in small changes of the motion and of the springs at its start, so many are propagated at once, in lanes. Changes of the
//! parameters of the contact add terms to them, with the changes dC and dk of the shells:
//!
//! ```text
//! C dv = dq - dC v,   dr = C⁻¹'[k (dv* - dv) + dk (v* - v) - dC' r],   e × dr + de × r = 0,   de = e⊥ dθ
//! ```

use super::matrix::{dot, times_symmetric, times_upper, times_upper_transposed};
use super::nodes::{DIFFERENCE_STEP, FLAT_EDGE, Matrix, Nodes, PerAxis, Row, SHIFT, SPRINGS, by_axis};
use super::shells::{ScaledNormalState, Shells, Springs, minus_next};
use super::slip::{Set, Slip, set_metric, within};
use super::step::{
    Displacements, GrossSlipBlend, LENGTH_SLIP_THRESHOLD, LoadedContact, SpringMotion, StepWork, edge_spring, released,
    releases, within_friction_limit,
};
use crate::numerics::dual::{Dual, Number};
use crate::numerics::lanes::Lanes;

/// Changes of each spring.
pub(crate) type Changes<const L: usize> = [Lanes<L>; SPRINGS];

/// Changes of the springs, and of the spring at the edge.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SpringChanges<const L: usize> {
    pub v: PerAxis<Changes<L>>,
    pub edge: PerAxis<Lanes<L>>,
}

impl<const L: usize> SpringChanges<L> {
    pub const ZERO: Self = SpringChanges { v: [[Lanes::ZERO; SPRINGS]; 2], edge: [Lanes::ZERO; 2] };
}

/// Parameters of a contact: the normal component over its scale at the end and at the start of the step, and the logarithm of
/// the reference size of the nodes.
pub(crate) const END: usize = 0;
pub(crate) const START: usize = 1;
pub(crate) const REFERENCE: usize = 2;
pub(crate) const PARAMETERS: usize = 3;

/// A contact's derivatives by one of its parameters.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ContactSlopes {
    pub now: ScaledNormalState,
    pub shells: Shells,
}

impl ContactSlopes {
    /// Derivatives by the normal component: of the shells only those of the last one.
    pub fn by_load(nodes: &Nodes, contact: &LoadedContact) -> ContactSlopes {
        ContactSlopes::new(nodes, contact, &contact.slopes, None)
    }

    /// Derivatives by the reference size of the nodes, from those of the nodes.
    pub fn by_reference(nodes: &Nodes, by_nodes: &Nodes, contact: &LoadedContact) -> ContactSlopes {
        ContactSlopes::new(nodes, contact, &ScaledNormalState::default(), Some(by_nodes))
    }

    fn new(nodes: &Nodes, contact: &LoadedContact, now: &ScaledNormalState, by_nodes: Option<&Nodes>) -> ContactSlopes {
        let mut slopes = ContactSlopes { now: *now, ..ContactSlopes::default() };
        if contact.now.load > 0.0 {
            slopes.shells = Shells::before(by_nodes, contact.shells.first, contact.shells.last);
            slopes.shells.set_last_slopes(nodes, &contact.shells, [&contact.now, now], by_nodes);
        }
        slopes
    }
}

/// Derivatives of nodes by the logarithm of the reference size.
pub(crate) fn slopes_of_nodes([larger, smaller]: [&Nodes; 2]) -> Nodes {
    let mut slopes = *larger;
    for (slope, smaller) in slopes.as_flattened_mut().iter_mut().zip(smaller.as_flattened()) {
        *slope = (*slope - smaller) * (0.5 / DIFFERENCE_STEP);
    }
    slopes
}

/// Terms of the derivative by one parameter of a contact in the changes of its springs.
pub(crate) struct ParameterTerms {
    /// Derivatives of the normal state at the start and at the end, and of S of the nodes.
    states: [ScaledNormalState; 2],
    nodes: PerAxis<Row>,
    /// What the derivatives of the stiffnesses add to that of the force.
    force: PerAxis<f64>,
    middle: SlipTerms,
    end: SlipTerms,
}

/// Terms of a slip: dC v; dk (v* - v) - dC' r, in which the pressures are constant; and r dp/p, which is what their changes add to the slip.
struct SlipTerms {
    tractions: PerAxis<Row>,
    forces: PerAxis<Row>,
    slip: PerAxis<Row>,
}

impl SlipTerms {
    const NONE: SlipTerms = {
        let zero = [Row::ZERO; 2];
        SlipTerms { tractions: zero, forces: zero, slip: zero }
    };

    /// Sets the terms of a parameter by which the shells from one on, and the nodes, have derivatives.
    fn set(
        &mut self,
        springs: &Springs,
        (ends, nodes, from): ([&Shells; 2], Option<&Nodes>, usize),
        trial: &PerAxis<Row>,
        slip: &Slip,
    ) {
        let (shells, slip) = (&springs.shells, &slip.points);
        if slip.set == 0 {
            return;
        }
        let (shell_slopes, mut by_pressure) = (Shells::middle(ends), Row::ZERO);
        let (mut tractions, mut sums) = ([Row::ZERO; 2], [Row::ZERO; 2]);
        let falls = by_axis(|axis| minus_next(&slip.v[axis]) * springs.per_shift[axis]);
        let slipped = by_axis(|axis| slip.r[axis] * springs.per_pressure);
        for j in from.max(shells.range().start)..shells.range().end {
            let pressure = Shells::middle_pressure(ends, nodes, j);
            if j >= FLAT_EDGE {
                by_pressure += pressure;
            }
            for axis in 0..2 {
                let per_shift = springs.per_shift[axis][j];
                let row = pressure - shell_slopes.shift_step[axis][j] * per_shift * springs.pressure[j];
                tractions[axis] += falls[axis][j] * row;
                sums[axis][j] = per_shift * dot(&slipped[axis], &row);
            }
        }
        by_pressure = springs.per_pressure * by_pressure;
        for axis in 0..2 {
            self.forces[axis] = stiffness_slopes(springs, axis, &shell_slopes) * (trial[axis] - slip.v[axis])
                - minus_previous(&sums[axis]);
            self.tractions[axis] = springs.per_pressure * tractions[axis] - slip.q[axis] * by_pressure;
            self.slip[axis] = slip.r[axis] * by_pressure;
        }
    }
}

/// x_j - x_{j-1}.
fn minus_previous(x: &Row) -> Row {
    let mut differences = *x;
    for j in 1..SPRINGS {
        differences[j] -= x[j - 1];
    }
    differences
}

/// Derivatives of k_j.
fn stiffness_slopes(springs: &Springs, axis: usize, slopes: &Shells) -> Row {
    let secants = (slopes.load_step[axis]
        - springs.shells.load_step[axis] * springs.per_shift[axis] * slopes.shift_step[axis])
        * springs.per_shift[axis];
    minus_previous(&secants)
}

impl ParameterTerms {
    pub const NONE: ParameterTerms = {
        let (none, rows) = ([0.0; 2], [Row::ZERO; 2]);
        ParameterTerms {
            states: [ScaledNormalState::NONE; 2],
            nodes: rows,
            force: none,
            middle: SlipTerms::NONE,
            end: SlipTerms::NONE,
        }
    };

    /// The derivative of the limit of a spring.
    fn limit(&self, axis: usize, j: usize) -> f64 {
        self.states[1].shift[axis] - self.nodes[axis][j]
    }

    /// Sets the terms of a parameter by which the contact at the start, that at the end, or both have derivatives, and the nodes.
    #[inline(never)]
    pub fn set(
        &mut self,
        contact: &LoadedContact,
        (step, motion, new): (&StepWork, &SpringMotion, &Displacements),
        [from, to]: [Option<&ContactSlopes>; 2],
        nodes: Option<&Nodes>,
    ) {
        let none = ContactSlopes::default();
        // By the load, only the last shells have derivatives.
        let lasts = [from, to].map(|slopes| slopes.map_or(SPRINGS, |slopes| slopes.shells.last));
        let first = if nodes.is_some() { 0 } else { lasts[0].min(lasts[1]) };
        let [from, to] = [from, to].map(|slopes| slopes.unwrap_or(&none));
        let ends = [&from.shells, &to.shells];
        self.middle.set(step.middle_springs(motion), (ends, nodes, first), &step.middle_trial(), &step.middle);
        self.end.set(&step.springs, ([ends[1]; 2], nodes, first), &step.end_trial(contact), &step.end);
        self.force = by_axis(|axis| {
            dot(&new.v[axis], &stiffness_slopes(&step.springs, axis, ends[1]))
                + new.edge[axis] * to.shells.edge_stiffness[axis]
        });
        self.nodes = by_axis(|axis| nodes.map_or(Row::ZERO, |nodes| Lanes(nodes[SHIFT + axis])));
        self.states = [from.now, to.now];
    }
}

/// Derivatives of a slip by its trial state: the metric K of its points, and -J⁻¹.
struct SlipJacobian {
    metric: PerAxis<Matrix>,
    inverse: Matrix,
}

impl SlipJacobian {
    const NONE: SlipJacobian = SlipJacobian { metric: [[Row::ZERO; SPRINGS]; 2], inverse: [Row::ZERO; SPRINGS] };

    fn set(&mut self, springs: &Springs, slip: &Slip) {
        let (points, range) = (&slip.points, slip.range(springs));
        if points.set != 0 {
            set_metric(&mut self.metric, springs, range, points.set);
            points.invert(&mut self.inverse, &self.metric, range);
        }
    }
}

/// What is linear in a step: both slips, and the terms of each parameter of the contact.
pub(crate) struct StepTangent {
    pub terms: [ParameterTerms; PARAMETERS],
    middle: SlipJacobian,
    end: SlipJacobian,
}

impl StepTangent {
    pub const NONE: StepTangent =
        StepTangent { terms: [ParameterTerms::NONE; PARAMETERS], middle: SlipJacobian::NONE, end: SlipJacobian::NONE };

    /// Sets the derivatives of both slips.
    pub fn set_slips(&mut self, step: &StepWork, motion: &SpringMotion) {
        self.middle.set(step.middle_springs(motion), &step.middle);
        self.end.set(&step.springs, &step.end);
    }
}

/// The tangent of a step, and by how much each parameter of the contact changes in the first four of the lanes that are propagated.
pub(crate) struct ParameterChanges<'a> {
    pub tangent: &'a StepTangent,
    pub changes: [Lanes<4>; PARAMETERS],
}

impl ParameterChanges<'_> {
    /// The sum of a term times the change of its parameter, over all parameters.
    fn sum(&self, term: impl Fn(&ParameterTerms) -> f64) -> Lanes<4> {
        let [a, b, c] = &self.tangent.terms;
        let [by_a, by_b, by_c] = self.changes;
        term(a) * by_a + term(b) * by_b + term(c) * by_c
    }
}

/// A step through which changes are propagated: the contact at both ends, and what the parameters add.
pub(crate) struct Propagation<'a> {
    pub contacts: [&'a LoadedContact; 2],
    pub nodes: &'a Nodes,
    pub motion: &'a SpringMotion,
    pub step: &'a StepWork,
    pub parameters: ParameterChanges<'a>,
}

impl Propagation<'_> {
    /// A number that the parameters change.
    fn dual<const L: usize>(&self, value: f64, slope: impl Fn(&ParameterTerms) -> f64) -> Dual<L> {
        let mut dual = Dual::constant(value);
        dual.slopes.add_first(self.parameters.sum(slope));
        dual
    }

    /// The normal states at the start and at the end.
    fn states<const L: usize>(&self) -> [ScaledNormalState<Dual<L>>; 2] {
        core::array::from_fn(|end| {
            let values = self.contacts[end].now.values();
            let number = |i: usize| self.dual(values[i], |terms| terms.states[end].values()[i]);
            ScaledNormalState::from_values(core::array::from_fn(number))
        })
    }

    /// Propagates changes of the springs and of the displacement: those of the springs after the step, in place, and of the force, which is
    /// not yet bounded.
    pub fn propagate<const L: usize>(
        &self,
        displacement: &PerAxis<Lanes<L>>,
        springs: &mut SpringChanges<L>,
    ) -> PerAxis<Lanes<L>> {
        let Propagation { contacts: [_, to], nodes, motion, step, parameters } = self;
        let (used, limits, old) = (to.used(), to.limits(nodes), *springs);
        let displacement = by_axis(|axis| Dual { value: motion.displacement[axis], slopes: displacement[axis] });
        let [before, now] = self.states();
        let limit = |j: usize| by_axis(|axis| self.dual(limits[axis][j], |terms| used[j] * terms.limit(axis, j)));
        let v = &mut springs.v;
        for axis in 0..2 {
            let rise = now.shift[axis] - before.shift[axis];
            for j in 0..SPRINGS {
                v[axis][j] = used[j] * (v[axis][j] + step.parts[axis][j] * displacement[axis].slopes);
                if step.parts[axis][j] < 1.0 {
                    // The part of springs that are engaged in the step is their limit over the rise.
                    v[axis][j] += displacement[axis].value * limit(j)[axis].quotient(rise).slopes;
                }
            }
        }
        let fall = before.shift[0] - now.shift[0];
        if releases(fall.value, limits[0][to.shells.last.min(SPRINGS - 1)]) {
            for j in to.shells.range() {
                let follow = |axis: usize| step.old.v[axis][j] + step.parts[axis][j] * motion.displacement[axis];
                let trial = by_axis(|axis| Dual { value: follow(axis), slopes: v[axis][j] });
                [v[0][j], v[1][j]] = released(limit(j), fall, trial).map(|trial| trial.slopes);
            }
        }
        if step.blend.part < 1.0 {
            for axis in 0..2 {
                for j in 0..SPRINGS {
                    v[axis][j] = 0.5 * (v[axis][j] + old.v[axis][j]);
                }
            }
            let tangent = parameters.tangent;
            step.middle
                .differentiate(&tangent.middle, step.middle_springs(motion), v, parameters, |terms| &terms.middle);
            for axis in 0..2 {
                for j in 0..SPRINGS {
                    v[axis][j] = used[j] * (2.0 * v[axis][j] - old.v[axis][j]);
                }
            }
            step.end.differentiate(&tangent.end, &step.springs, v, parameters, |terms| &terms.end);
        }
        let old_edge = by_axis(|axis| Dual { value: step.old.edge[axis], slopes: old.edge[axis] });
        springs.edge = edge_spring([&before, &now], &displacement, old_edge).map(|edge| edge.slopes);
        if step.blend.part > 0.0 {
            let first = to.shells.innermost();
            let innermost = by_axis(|axis| Dual { value: step.old.v[axis][first], slopes: old.v[axis][first] });
            let blend = GrossSlipBlend::new([&before, &now], &displacement, innermost);
            let edge_limits = now.edge_limits();
            for axis in 0..2 {
                for j in 0..SPRINGS {
                    let v = Dual { value: step.end.points.v[axis][j], slopes: springs.v[axis][j] };
                    springs.v[axis][j] = blend.of_spring(axis, v, limit(j)[axis]).slopes;
                }
                let edge = Dual { value: step.edge[axis], slopes: springs.edge[axis] };
                springs.edge[axis] = blend.of_spring(axis, edge, edge_limits[axis]).slopes;
            }
        }
        let mut force = [Lanes::ZERO; 2];
        for axis in 0..2 {
            for j in 0..SPRINGS {
                force[axis] += step.springs.stiffness[axis][j] * springs.v[axis][j];
            }
            force[axis] += to.shells.edge_stiffness[axis] * springs.edge[axis];
            force[axis].add_first(parameters.sum(|terms| terms.force[axis]));
        }
        force
    }

    /// Changes of a force that Coulomb's law bounds.
    pub fn within_friction_limit<const L: usize>(
        &self,
        force: PerAxis<f64>,
        slopes: PerAxis<Lanes<L>>,
    ) -> PerAxis<Lanes<L>> {
        let bound = self.dual(self.contacts[1].now.load, |terms| terms.states[1].load);
        let force = by_axis(|axis| Dual { value: force[axis], slopes: slopes[axis] });
        within_friction_limit(force, bound, LENGTH_SLIP_THRESHOLD).map(|force| force.slopes)
    }
}

impl Slip {
    /// Changes of springs after slip, in place of those of the trial state.
    fn differentiate<const L: usize>(
        &self,
        jacobian: &SlipJacobian,
        springs: &Springs,
        v: &mut PerAxis<Changes<L>>,
        parameters: &ParameterChanges,
        slip_of: impl Fn(&ParameterTerms) -> &SlipTerms,
    ) {
        if self.points.set == 0 {
            return;
        }
        let range = self.range(springs);
        let [first, end] = range;
        // The springs at the present tractions, and the slip at them.
        let mut own = [[Lanes::<4>::ZERO; SPRINGS]; 2];
        for axis in 0..2 {
            for j in first..end {
                own[axis][j] = -parameters.sum(|terms| slip_of(terms).tractions[axis][j]);
            }
            times_upper(&springs.inverse[axis], range, &mut own[axis]);
            for j in first..end {
                v[axis][j].add_first(-own[axis][j]);
                v[axis][j] = springs.stiffness[axis][j] * v[axis][j];
                v[axis][j].add_first(parameters.sum(|terms| slip_of(terms).forces[axis][j]));
            }
            times_upper_transposed(&springs.inverse[axis], range, &mut v[axis]);
            for i in first..end {
                v[axis][i].add_first(parameters.sum(|terms| slip_of(terms).slip[axis][i]));
            }
        }
        self.tractions_of(jacobian, v, range);
        for axis in 0..2 {
            times_upper(&springs.inverse[axis], range, &mut v[axis]);
            for j in first..end {
                v[axis][j].add_first(own[axis][j]);
            }
        }
    }

    /// Changes of the tractions, in place of those of slip at the present tractions.
    fn tractions_of<const L: usize>(&self, jacobian: &SlipJacobian, slip: &mut PerAxis<Changes<L>>, range: [usize; 2]) {
        let [first, end] = range.map(|i| i.min(SPRINGS));
        let (points, SlipJacobian { metric, inverse }) = (&self.points, jacobian);
        let sticks = !points.set & within([first, end]);
        if sticks != 0 {
            condense_sticking_points(metric, slip, [first, end], (points.set, sticks));
        }
        let mut across = [Lanes::ZERO; SPRINGS];
        for m in first..end {
            if points.set >> m & 1 == 1 {
                across[m] = points.e[0][m] * slip[1][m] - points.e[1][m] * slip[0][m];
            }
        }
        times_symmetric(inverse, [first, end], &mut across);
        for i in first..end {
            if points.set >> i & 1 == 1 {
                (slip[0][i], slip[1][i]) = (points.e[1][i] * across[i], -points.e[0][i] * across[i]);
            }
        }
        if sticks != 0 {
            // Subtract the effect of the points that slip on the tractions of those that stick.
            for axis in 0..2 {
                for i in first..end {
                    for m in first..end {
                        if sticks >> i & points.set >> m & 1 == 1 {
                            let taken = metric[axis][m][i] * slip[axis][m];
                            slip[axis][i] -= taken;
                        }
                    }
                }
            }
        }
    }
}

/// Eliminates the points that stick between others: the change of slip of such a point becomes the change of its traction, and is subtracted
/// from the change of slip of the others by their share.
#[inline(never)]
fn condense_sticking_points<const L: usize>(
    metric: &PerAxis<Matrix>,
    slip: &mut PerAxis<Changes<L>>,
    [first, end]: [usize; 2],
    (set, sticks): (Set, Set),
) {
    for axis in 0..2 {
        let own = slip[axis];
        for i in first..end.min(SPRINGS) {
            let mut sum = if set >> i & 1 == 1 { own[i] } else { Lanes::ZERO };
            for m in first..end.min(SPRINGS) {
                if sticks >> m & 1 == 1 {
                    sum -= metric[axis][m][i] * own[m];
                }
            }
            slip[axis][i] = sum;
        }
    }
}
