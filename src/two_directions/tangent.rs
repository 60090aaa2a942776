//! Derivatives of a step whose values are known: one more step of Newton's method from the solution of each slip.
//!
//! A step is linear in small changes of the motion and of the springs at its start, so many are propagated at once, in lanes. Changes of the
//! parameters of the contact add terms to them, with the changes dC and dk of the shells:
//!
//! ```text
//! C dv = dq - dC v,   dr = C⁻¹'[k (dv* - dv) + dk (v* - v) - dC' r],   e × dr + de × r = 0,   de = e⊥ dθ
//! ```

use super::matrix::{dot, times_symmetric, times_upper, times_upper_transposed};
use super::nodes::{FLAT_EDGE, Matrix, NEIGHBOUR, Nodes, PerAxis, Row, SHIFT, SPRINGS, by_axis};
use super::shells::{ScaledNormalState, Shells, Springs, minus_next};
use super::slip::{Set, Slip, set_metric, within};
use super::step::{
    Displacements, LENGTH_SLIP_THRESHOLD, LoadedContact, ReleasedSpring, SMALLEST_LENGTH, SpringMotion, StepWork,
    per_length_beyond,
};
use crate::numerics::guard::quotient;
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
    pub shells: Shells,
    pub shift: PerAxis<f64>,
    pub load: f64,
    /// The limit of the spring at the edge.
    pub edge_limit: PerAxis<f64>,
}

impl ContactSlopes {
    /// Derivatives by the normal component: those of the last shell only.
    pub fn by_load(nodes: &Nodes, contact: &LoadedContact) -> ContactSlopes {
        let slopes = &contact.slopes;
        let mut slopes_of_contact =
            ContactSlopes { shift: slopes.shift, load: slopes.load, ..ContactSlopes::default() };
        if contact.now.load > 0.0 {
            slopes_of_contact.edge_limit = by_axis(|axis| slopes.shift[axis] - slopes.inside_shift[axis]);
            (slopes_of_contact.shells.first, slopes_of_contact.shells.last) =
                (contact.shells.first, contact.shells.last);
            slopes_of_contact.shells.set_last_slopes(nodes, &contact.shells, &contact.now, slopes, None);
        }
        slopes_of_contact
    }

    /// Derivatives by the reference size of the nodes, from those of the nodes.
    pub fn by_reference(nodes: &Nodes, slopes: &Nodes, contact: &LoadedContact) -> ContactSlopes {
        let mut slopes_of_contact = ContactSlopes::default();
        if contact.now.load > 0.0 {
            slopes_of_contact.shells = Shells::before(slopes, contact.shells.first, contact.shells.last);
            slopes_of_contact.shells.set_last_slopes(
                nodes,
                &contact.shells,
                &contact.now,
                &ScaledNormalState::default(),
                Some(slopes),
            );
        }
        slopes_of_contact
    }
}

/// Derivatives of nodes by the logarithm of the reference size.
pub(crate) fn slopes_of_nodes([larger, smaller]: [&Nodes; 2]) -> Nodes {
    let mut slopes = *larger;
    for (slope, smaller) in slopes.as_flattened_mut().iter_mut().zip(smaller.as_flattened()) {
        *slope = (*slope - smaller) * (0.5 / NEIGHBOUR);
    }
    slopes
}

/// Terms of the derivative by one parameter of a contact in the changes of its springs.
pub(crate) struct ParameterTerms {
    /// Derivatives of S at the start and at the end, of S of the nodes and of N.
    shift_before: PerAxis<f64>,
    shift: PerAxis<f64>,
    nodes: PerAxis<Row>,
    load: f64,
    /// What the derivatives of the stiffnesses add to that of the force, and the derivatives of the limit of the spring at the edge at the end
    /// and at the start.
    force: PerAxis<f64>,
    edge_limit: PerAxis<f64>,
    edge_limit_before: PerAxis<f64>,
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
            shift_before: none,
            shift: none,
            nodes: rows,
            load: 0.0,
            force: none,
            edge_limit: none,
            edge_limit_before: none,
            middle: SlipTerms::NONE,
            end: SlipTerms::NONE,
        }
    };

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
        (self.shift_before, self.shift, self.load) = (from.shift, to.shift, to.load);
        (self.edge_limit_before, self.edge_limit) = (from.edge_limit, to.edge_limit);
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
    /// What a term of all parameters adds.
    fn sum(&self, term: impl Fn(&ParameterTerms) -> f64) -> Lanes<4> {
        let [a, b, c] = &self.tangent.terms;
        let [by_a, by_b, by_c] = self.changes;
        term(a) * by_a + term(b) * by_b + term(c) * by_c
    }

    /// Changes of the limit of a spring.
    fn limit(&self, axis: usize, j: usize) -> Lanes<4> {
        self.sum(|terms| terms.shift[axis] - terms.nodes[axis][j])
    }
}

/// A step through which changes are propagated: the contact at its end, and what the parameters add.
pub(crate) struct Propagation<'a> {
    pub contact: &'a LoadedContact,
    pub nodes: &'a Nodes,
    pub motion: &'a SpringMotion,
    pub step: &'a StepWork,
    pub parameters: ParameterChanges<'a>,
}

impl Propagation<'_> {
    /// Propagates changes of the springs and of the displacement: those of the springs after the step, in place, and of the force, which is
    /// not yet bounded.
    pub fn propagate<const L: usize>(
        &self,
        displacement: &PerAxis<Lanes<L>>,
        springs: &mut SpringChanges<L>,
    ) -> PerAxis<Lanes<L>> {
        let Propagation { contact, motion, step, parameters, .. } = self;
        let used = contact.used();
        let old = springs.v;
        let v = &mut springs.v;
        for axis in 0..2 {
            let rise = contact.now.shift[axis] - motion.shift_before[axis];
            for j in 0..SPRINGS {
                v[axis][j] = used[j] * (v[axis][j] + step.parts[axis][j] * displacement[axis]);
                if step.parts[axis][j] < 1.0 {
                    // The part of springs that are engaged in the step is their limit over the rise.
                    let rises = parameters.sum(|terms| terms.shift[axis] - terms.shift_before[axis]);
                    let part = used[j] * parameters.limit(axis, j) - step.parts[axis][j] * rises;
                    v[axis][j].add_first((motion.displacement[axis] / rise.max(SMALLEST_LENGTH)) * part);
                }
            }
        }
        self.release(v);
        if step.blend.part < 1.0 {
            for axis in 0..2 {
                for j in 0..SPRINGS {
                    v[axis][j] = 0.5 * (v[axis][j] + old[axis][j]);
                }
            }
            let tangent = parameters.tangent;
            step.middle
                .differentiate(&tangent.middle, step.middle_springs(motion), v, parameters, |terms| &terms.middle);
            for axis in 0..2 {
                for j in 0..SPRINGS {
                    v[axis][j] = used[j] * (2.0 * v[axis][j] - old[axis][j]);
                }
            }
            step.end.differentiate(&tangent.end, &step.springs, v, parameters, |terms| &terms.end);
        }
        springs.edge = self.move_edge(displacement, &springs.edge);
        if step.blend.part > 0.0 {
            self.blend(displacement, &old, springs);
        }
        let mut force = [Lanes::ZERO; 2];
        for axis in 0..2 {
            for j in 0..SPRINGS {
                force[axis] += step.springs.stiffness[axis][j] * springs.v[axis][j];
            }
            force[axis] += contact.shells.edge_stiffness[axis] * springs.edge[axis];
            force[axis].add_first(parameters.sum(|terms| terms.force[axis]));
        }
        force
    }

    /// Changes of the trial state of springs that are released.
    fn release<const L: usize>(&self, v: &mut PerAxis<Changes<L>>) {
        let Propagation { contact, nodes, motion, step, parameters, .. } = self;
        let fall = motion.shift_before[0] - contact.now.shift[0];
        if motion.constant_load || fall <= 0.0 {
            return;
        }
        let limits = contact.limits(nodes);
        for j in contact.shells.range() {
            let limit = [limits[0][j].max(SMALLEST_LENGTH), limits[1][j].max(SMALLEST_LENGTH)];
            let trial = [step.old.v[0][j] + motion.displacement[0], step.old.v[1][j] + motion.displacement[1]];
            let released = ReleasedSpring::new(limit, fall, trial);
            if released.scale >= 1.0 {
                continue;
            }
            // Four divisors, not three: the compiler would divide by what is beside them in the vector register.
            let divisors = Lanes([limit[0], limit[1], released.length.max(1.0), limit[0] + fall]);
            let [per_x, per_y, per_length, per_before] = *(1.0 / divisors);
            let by_limit = by_axis(|axis| parameters.limit(axis, j));
            let by_before = parameters.sum(|terms| terms.shift_before[0] - terms.nodes[0][j]);
            let by_part = released.excess_share * (per_x * by_limit[0] - per_before * by_before);
            let mut ratio = [v[0][j], v[1][j]];
            for axis in 0..2 {
                ratio[axis].add_first(-released.ratio[axis] * by_limit[axis]);
                ratio[axis] = [per_x, per_y][axis] * ratio[axis];
            }
            let length = per_length * (released.ratio[0] * ratio[0] + released.ratio[1] * ratio[1]);
            let mut scale = per_length * (released.excess_share - released.scale) * length;
            scale.add_first((per_length * (released.length - 1.0)) * by_part);
            for axis in 0..2 {
                v[axis][j] = limit[axis] * (released.scale * ratio[axis] + released.ratio[axis] * scale);
                v[axis][j].add_first((released.ratio[axis] * released.scale) * by_limit[axis]);
            }
        }
    }

    /// Changes of the spring at the edge, from those of its old displacement.
    fn move_edge<const L: usize>(
        &self,
        displacement: &PerAxis<Lanes<L>>,
        old: &PerAxis<Lanes<L>>,
    ) -> PerAxis<Lanes<L>> {
        let Propagation { contact, motion, step, parameters, .. } = self;
        let (mut ratio, edge) = ([Lanes::ZERO; 2], &step.edge);
        let limit = contact.edge_limits().map(|limit| limit.max(SMALLEST_LENGTH));
        for axis in 0..2 {
            ratio[axis] = edge.part[axis] * displacement[axis] + edge.kept[axis] * old[axis];
            let rise = (contact.now.shift[axis] - motion.shift_before[axis]).max(limit[axis]);
            let [per_rise, per_before] =
                [motion.displacement[axis] / rise, step.old.edge[axis] / edge.limit_before[axis]];
            ratio[axis].add_first(parameters.sum(|terms| {
                let (rise, mut sum) =
                    (terms.shift[axis] - terms.shift_before[axis], -edge.ratio[axis] * terms.edge_limit[axis]);
                if edge.part[axis] < 1.0 {
                    sum += per_rise * (terms.edge_limit[axis] - edge.part[axis] * rise);
                }
                if edge.kept[axis] < 1.0 && edge.kept[axis] > 0.0 {
                    sum +=
                        per_before * (terms.edge_limit[axis] - rise - edge.kept[axis] * terms.edge_limit_before[axis]);
                }
                sum
            }));
            ratio[axis] = (1.0 / limit[axis]) * ratio[axis];
        }
        let (mut end, mut e) = (ratio, edge.ratio);
        if edge.slips {
            e = edge.ratio.map(|ratio| edge.scale * ratio);
            end = across(e, edge.scale, ratio);
        }
        for axis in 0..2 {
            end[axis] = limit[axis] * end[axis];
            end[axis].add_first(e[axis] * parameters.sum(|terms| terms.edge_limit[axis]));
        }
        end
    }

    /// Changes of the springs that end in gross slip to a part, `v = (1 - part) v + part l e`, from those of the springs before the step.
    fn blend<const L: usize>(
        &self,
        displacement: &PerAxis<Lanes<L>>,
        old: &PerAxis<Changes<L>>,
        springs: &mut SpringChanges<L>,
    ) {
        let Propagation { contact, nodes, motion, step, parameters, .. } = self;
        let (blend, first) = (&step.blend, contact.shells.innermost());
        let (mut travel, mut distance) = (*displacement, Lanes::ZERO);
        for axis in 0..2 {
            let (limit, before) =
                (contact.now.shift[axis].max(SMALLEST_LENGTH), motion.shift_before[axis].max(SMALLEST_LENGTH));
            travel[axis] += blend.cut[axis] * old[axis][first];
            // A constant load is the limit of falling ones.
            if contact.now.shift[axis] <= motion.shift_before[axis] {
                let cut = parameters.sum(|terms| (limit / before) * terms.shift_before[axis] - terms.shift[axis]);
                travel[axis].add_first((step.old.v[axis][first] / before) * cut);
            }
            let mut ratio = travel[axis];
            ratio.add_first(-blend.ratio[axis] * parameters.sum(|terms| terms.shift[axis]));
            distance += (quotient(blend.ratio[axis], blend.distance) / limit) * ratio;
        }
        let (by_part, by_e) = (blend.part_slope * distance, across(blend.e, blend.per_length, travel));
        let blended = |axis: usize, value: f64, changes: Lanes<L>, limit: f64, by_limit: Lanes<4>| {
            let (part, e) = (blend.part, blend.e[axis]);
            let mut changes = (1.0 - part) * changes + (limit * e - value) * by_part + (part * limit) * by_e[axis];
            changes.add_first((part * e) * by_limit);
            changes
        };
        let (used, limits, edge_limits) = (contact.used(), contact.limits(nodes), contact.edge_limits());
        for axis in 0..2 {
            for (j, changes) in springs.v[axis].iter_mut().enumerate() {
                let (value, by_limit) = (step.end.points.v[axis][j], used[j] * parameters.limit(axis, j));
                *changes = blended(axis, value, *changes, limits[axis][j], by_limit);
            }
            let by_limit = parameters.sum(|terms| terms.edge_limit[axis]);
            let (limit, end) = (edge_limits[axis], &step.edge);
            let value = limit * end.scale * end.ratio[axis];
            springs.edge[axis] = blended(axis, value, springs.edge[axis], limit, by_limit);
        }
    }

    /// Changes of a force that Coulomb's law bounds.
    pub fn within_friction_limit<const L: usize>(
        &self,
        force: PerAxis<f64>,
        [x, y]: PerAxis<Lanes<L>>,
    ) -> PerAxis<Lanes<L>> {
        let bound = self.contact.now.load;
        let Some(per) = per_length_beyond(force, LENGTH_SLIP_THRESHOLD * bound) else { return [x, y] };
        let e = force.map(|force| force * per);
        let by_bound = self.parameters.sum(|terms| terms.load);
        let mut slopes = across(e, bound * per, [x, y]);
        for axis in 0..2 {
            slopes[axis].add_first(e[axis] * by_bound);
        }
        slopes
    }
}

/// The part of changes across a direction, times a factor.
fn across<const L: usize>(e: PerAxis<f64>, factor: f64, [x, y]: PerAxis<Lanes<L>>) -> PerAxis<Lanes<L>> {
    let turn = factor * (e[0] * y - e[1] * x);
    [-e[1] * turn, e[0] * turn]
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
        self.turn(jacobian, v, range);
        for axis in 0..2 {
            times_upper(&springs.inverse[axis], range, &mut v[axis]);
            for j in first..end {
                v[axis][j].add_first(own[axis][j]);
            }
        }
    }

    /// Changes of the tractions, in place of those of slip at the present tractions.
    fn turn<const L: usize>(&self, jacobian: &SlipJacobian, slip: &mut PerAxis<Changes<L>>, range: [usize; 2]) {
        let [first, end] = range.map(|i| i.min(SPRINGS));
        let (points, SlipJacobian { metric, inverse }) = (&self.points, jacobian);
        let sticks = !points.set & within([first, end]);
        if sticks != 0 {
            eliminate(metric, slip, [first, end], (points.set, sticks));
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
            // What these take from the tractions of others.
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
fn eliminate<const L: usize>(
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
