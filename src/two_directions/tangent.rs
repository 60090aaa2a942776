//! Derivatives of a step whose values are known: one more step of Newton's method from the solution of each slip.
//!
//! A step is linear in small changes of the motion and of the springs at its start, so many are propagated at once, in lanes. Changes of the
//! parameters of the contact add terms to them, with the changes dC and dk of the shells:
//!
//! ```text
//! C dv = dq - dC v,   dr = C⁻¹'[k (dv* - dv) + dk (v* - v) - dC' r],   e × dr + de × r = 0,   de = e⊥ dθ
//! ```

use super::matrix::{dot, times_upper, times_upper_transposed};
use super::nodes::{Both, FLAT_EDGE, Matrix, N, NEIGHBOUR, Nodes, Row, SHIFT, both, length};
use super::shells::{Pressed, Shells, Springs, falls};
use super::slip::{Set, Slip, set_metric, within};
use super::step::{LEAST, LoadedContact, Released, SlipStep, StepMotion};
use crate::numerics::guard::quotient;
use crate::numerics::lanes::Lanes;

/// Changes of each spring.
pub(crate) type Changes<const L: usize> = [Lanes<L>; N];

/// Changes of the springs, and of the spring at the edge.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SpringChanges<const L: usize> {
    pub v: Both<Changes<L>>,
    pub edge: Both<Lanes<L>>,
}

impl<const L: usize> SpringChanges<L> {
    pub const ZERO: Self = SpringChanges { v: [[Lanes::ZERO; N]; 2], edge: [Lanes::ZERO; 2] };
}

/// Parameters of a contact: the normal component over its scale at the end and at the start of the step, and the logarithm of
/// the reference size of the nodes.
pub(crate) const END: usize = 0;
pub(crate) const START: usize = 1;
pub(crate) const REFERENCE: usize = 2;
pub(crate) const PARAMETERS: usize = 3;

/// A contact's derivatives by one of its parameters.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ContactSlopes {
    pub shells: Shells,
    pub shift: Both<f64>,
    pub load: f64,
    /// The limit of the spring at the edge.
    pub edge_limit: Both<f64>,
}

impl ContactSlopes {
    const NONE: ContactSlopes =
        ContactSlopes { shells: Shells::NONE, shift: [0.0; 2], load: 0.0, edge_limit: [0.0; 2] };

    /// By the normal component: of the last shell only.
    pub fn by_load(nodes: &Nodes, contact: &LoadedContact) -> ContactSlopes {
        let slopes = &contact.slopes;
        let mut slopes_of_contact = ContactSlopes { shift: slopes.shift, load: slopes.load, ..ContactSlopes::NONE };
        if contact.now.load > 0.0 {
            slopes_of_contact.edge_limit = both(|k| slopes.shift[k] - slopes.inside_shift[k]);
            (slopes_of_contact.shells.first, slopes_of_contact.shells.last) =
                (contact.shells.first, contact.shells.last);
            slopes_of_contact.shells.set_last_slopes(nodes, &contact.shells, &contact.now, slopes, None);
        }
        slopes_of_contact
    }

    /// By the reference size of the nodes, from derivatives of these.
    pub fn by_reference(nodes: &Nodes, slopes: &Nodes, contact: &LoadedContact) -> ContactSlopes {
        let mut slopes_of_contact = ContactSlopes::NONE;
        if contact.now.load > 0.0 {
            slopes_of_contact.shells = Shells::before(slopes, contact.shells.first, contact.shells.last);
            slopes_of_contact.shells.set_last_slopes(
                nodes,
                &contact.shells,
                &contact.now,
                &Pressed::default(),
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

/// What the derivative by one parameter of a contact adds to the changes of its springs.
pub(crate) struct ParameterTerms {
    /// S at the start and at the end, S of the nodes, N; stiffnesses at the end, and the limit of the spring at the edge.
    shift_before: Both<f64>,
    shift: Both<f64>,
    nodes: Both<Row>,
    load: f64,
    stiffness: Both<Row>,
    edge_stiffness: Both<f64>,
    edge_limit: Both<f64>,
    edge_limit_before: Both<f64>,
    middle: SlipTerms,
    end: SlipTerms,
}

/// Terms of a slip: dC v; dk (v* - v) - dC' r, in which the pressures are constant; and r dp/p, which is what their changes add to the slip.
struct SlipTerms {
    tractions: Both<Row>,
    forces: Both<Row>,
    slip: Both<Row>,
}

impl SlipTerms {
    const NONE: SlipTerms = {
        let zero = [Row::ZERO; 2];
        SlipTerms { tractions: zero, forces: zero, slip: zero }
    };

    /// Of a parameter by which the shells from one on, and the nodes, have derivatives.
    fn set(
        &mut self,
        springs: &Springs,
        (ends, nodes, from): ([&Shells; 2], Option<&Nodes>, usize),
        trial: &Both<Row>,
        slip: &Slip,
    ) {
        let (shells, slip) = (&springs.shells, &slip.points);
        if slip.set == 0 {
            return;
        }
        let (shell_slopes, mut by_pressure) = (Shells::middle(ends), Row::ZERO);
        let (mut tractions, mut sums) = ([Row::ZERO; 2], [Row::ZERO; 2]);
        let falls = both(|k| falls(&slip.v[k]) * springs.per_shift[k]);
        let slipped = both(|k| slip.r[k] * springs.per_pressure);
        for j in from.max(shells.range().start)..shells.range().end {
            let pressure = Shells::middle_pressure(ends, nodes, j);
            if j >= FLAT_EDGE {
                by_pressure += pressure;
            }
            for k in 0..2 {
                let per_shift = springs.per_shift[k][j];
                let row = pressure - shell_slopes.shift_step[k][j] * per_shift * springs.pressure[j];
                tractions[k] += falls[k][j] * row;
                sums[k][j] = per_shift * dot(&slipped[k], &row);
            }
        }
        by_pressure = springs.per_pressure * by_pressure;
        for k in 0..2 {
            self.forces[k] = stiffness_slopes(springs, k, &shell_slopes) * (trial[k] - slip.v[k]) - rises(&sums[k]);
            self.tractions[k] = springs.per_pressure * tractions[k] - slip.q[k] * by_pressure;
            self.slip[k] = slip.r[k] * by_pressure;
        }
    }
}

/// x_j - x_{j-1}.
fn rises(x: &Row) -> Row {
    let mut rises = *x;
    for j in 1..N {
        rises[j] -= x[j - 1];
    }
    rises
}

/// Derivatives of k_j.
fn stiffness_slopes(springs: &Springs, k: usize, slopes: &Shells) -> Row {
    let secants = (slopes.load_step[k] - springs.shells.load_step[k] * springs.per_shift[k] * slopes.shift_step[k])
        * springs.per_shift[k];
    rises(&secants)
}

impl ParameterTerms {
    pub const NONE: ParameterTerms = {
        let (none, rows) = ([0.0; 2], [Row::ZERO; 2]);
        ParameterTerms {
            shift_before: none,
            shift: none,
            nodes: rows,
            load: 0.0,
            stiffness: rows,
            edge_stiffness: none,
            edge_limit: none,
            edge_limit_before: none,
            middle: SlipTerms::NONE,
            end: SlipTerms::NONE,
        }
    };

    /// Of a parameter by which the contact at the start, that at the end, or both have derivatives, and the nodes.
    #[inline(never)]
    pub fn set(
        &mut self,
        contact: &LoadedContact,
        (step, constant_load): (&SlipStep, bool),
        [from, to]: [Option<&ContactSlopes>; 2],
        nodes: Option<&Nodes>,
    ) {
        let none = ContactSlopes::NONE;
        // By the load, only the last shells have derivatives.
        let lasts = [from, to].map(|slopes| slopes.map_or(N, |slopes| slopes.shells.last));
        let first = if nodes.is_some() { 0 } else { lasts[0].min(lasts[1]) };
        let [from, to] = [from, to].map(|slopes| slopes.unwrap_or(&none));
        let ends = [&from.shells, &to.shells];
        let between = if constant_load { &step.springs } else { &step.between };
        let half = both(|k| 0.5 * (step.old.v[k] + step.trial[k]));
        self.middle.set(between, (ends, nodes, first), &half, &step.middle);
        let used = contact.used();
        let beyond = both(|k| used * (2.0 * step.middle.points.v[k] - step.old.v[k]));
        self.end.set(&step.springs, ([ends[1]; 2], nodes, first), &beyond, &step.end);
        self.stiffness = both(|k| stiffness_slopes(&step.springs, k, ends[1]));
        self.nodes = both(|k| nodes.map_or(Row::ZERO, |nodes| Lanes(nodes[SHIFT + k])));
        (self.shift_before, self.shift, self.load) = (from.shift, to.shift, to.load);
        (self.edge_limit_before, self.edge_limit, self.edge_stiffness) =
            (from.edge_limit, to.edge_limit, to.shells.edge_stiffness);
    }
}

/// The terms of each parameter of a contact, and by how much the parameter changes in the first four of the lanes that are propagated.
pub(crate) struct ParameterChanges<'a> {
    pub terms: &'a [ParameterTerms; PARAMETERS],
    pub changes: [Lanes<4>; PARAMETERS],
}

impl ParameterChanges<'_> {
    /// What a term of all parameters adds.
    fn sum(&self, term: impl Fn(&ParameterTerms) -> f64) -> Lanes<4> {
        let [a, b, c] = self.terms;
        let [by_a, by_b, by_c] = self.changes;
        term(a) * by_a + term(b) * by_b + term(c) * by_c
    }

    /// Changes of the limit of a spring.
    fn limit(&self, k: usize, j: usize) -> Lanes<4> {
        self.sum(|terms| terms.shift[k] - terms.nodes[k][j])
    }
}

/// Propagates changes of the springs and of the displacement through a step: those of the springs after it, in place, and of the force, which is
/// not yet bounded.
pub(crate) fn propagate<const L: usize>(
    contact: &LoadedContact,
    nodes: &Nodes,
    (motion, displacement): (&StepMotion, &Both<Lanes<L>>),
    (step, new): (&SlipStep, &super::step::Displacements),
    springs: &mut SpringChanges<L>,
    parameters: &ParameterChanges,
) -> Both<Lanes<L>> {
    let used = contact.used();
    let SpringChanges { v, edge } = springs;
    let old = *v;
    for k in 0..2 {
        let rise = contact.now.shift[k] - motion.shift_before[k];
        for j in 0..N {
            v[k][j] = used[j] * (v[k][j] + step.parts[k][j] * displacement[k]);
            if step.parts[k][j] < 1.0 {
                // The part of springs that are engaged in the step is their limit over the rise.
                let rises = parameters.sum(|terms| terms.shift[k] - terms.shift_before[k]);
                let part = used[j] * parameters.limit(k, j) - step.parts[k][j] * rises;
                v[k][j].add_first((motion.displacement[k] / rise.max(LEAST)) * part);
            }
        }
    }
    release(contact, nodes, motion, step, v, parameters);
    let far = &step.far;
    if far.part < 1.0 {
        let between = if motion.constant_load { &step.springs } else { &step.between };
        for k in 0..2 {
            for j in 0..N {
                v[k][j] = 0.5 * (v[k][j] + old[k][j]);
            }
        }
        step.middle.differentiate(between, v, parameters, |terms| &terms.middle);
        for k in 0..2 {
            for j in 0..N {
                v[k][j] = used[j] * (2.0 * v[k][j] - old[k][j]);
            }
        }
        step.end.differentiate(&step.springs, v, parameters, |terms| &terms.end);
    }
    *edge = move_edge(contact, (motion, displacement), step, edge, parameters);
    if far.part > 0.0 {
        let changes = FarChanges::new(contact, (motion, displacement), step, &old, parameters);
        let (limits, edge_limits) = (contact.limits(nodes), contact.edge_limits());
        for k in 0..2 {
            for j in 0..N {
                let (value, by_limit) = (step.end.points.v[k][j], used[j] * parameters.limit(k, j));
                let limit = (limits[k][j], by_limit);
                v[k][j] = changes.blend((far.part, far.e[k], changes.e[k]), (v[k][j], value), limit);
            }
            let by_limit = parameters.sum(|terms| terms.edge_limit[k]);
            let (limit, end) = (edge_limits[k], &step.edge);
            let value = limit * end.ratio[k] / if end.slips { end.length.max(1.0) } else { 1.0 };
            edge[k] = changes.blend((far.part, far.e[k], changes.e[k]), (edge[k], value), (limit, by_limit));
        }
    }
    let mut force = [Lanes::ZERO; 2];
    for k in 0..2 {
        for j in 0..N {
            force[k] += step.springs.stiffness[k][j] * v[k][j];
        }
        force[k] += contact.shells.edge_stiffness[k] * edge[k];
        force[k].add_first(
            parameters.sum(|terms| dot(&new.v[k], &terms.stiffness[k]) + new.edge[k] * terms.edge_stiffness[k]),
        );
    }
    force
}

/// Changes of the trial state of springs that are released.
fn release<const L: usize>(
    contact: &LoadedContact,
    nodes: &Nodes,
    motion: &StepMotion,
    step: &SlipStep,
    v: &mut Both<Changes<L>>,
    parameters: &ParameterChanges,
) {
    let fall = motion.shift_before[0] - contact.now.shift[0];
    if motion.constant_load || fall <= 0.0 {
        return;
    }
    let limits = contact.limits(nodes);
    for j in contact.shells.range() {
        let limit = [limits[0][j].max(LEAST), limits[1][j].max(LEAST)];
        let trial = [step.old.v[0][j] + motion.displacement[0], step.old.v[1][j] + motion.displacement[1]];
        let released = Released::new(limit, fall, trial);
        if released.scale >= 1.0 {
            continue;
        }
        // Four divisors, not three: the compiler would divide by what is beside them in the vector register.
        let divisors = Lanes([limit[0], limit[1], released.length.max(1.0), limit[0] + fall]);
        let [per_x, per_y, per_length, per_before] = *(1.0 / divisors);
        let by_limit = both(|k| parameters.limit(k, j));
        let by_before = parameters.sum(|terms| terms.shift_before[0] - terms.nodes[0][j]);
        let by_part = released.part * (per_x * by_limit[0] - per_before * by_before);
        let mut ratio = [v[0][j], v[1][j]];
        for k in 0..2 {
            ratio[k].add_first(-released.ratio[k] * by_limit[k]);
            ratio[k] = [per_x, per_y][k] * ratio[k];
        }
        let length = per_length * (released.ratio[0] * ratio[0] + released.ratio[1] * ratio[1]);
        let mut scale = per_length * (released.part - released.scale) * length;
        scale.add_first((per_length * (released.length - 1.0)) * by_part);
        for k in 0..2 {
            v[k][j] = limit[k] * (released.scale * ratio[k] + released.ratio[k] * scale);
            v[k][j].add_first((released.ratio[k] * released.scale) * by_limit[k]);
        }
    }
}

/// Changes of a displacement that is far: of its part, and of its direction.
struct FarChanges<const L: usize> {
    part: Lanes<L>,
    e: Both<Lanes<L>>,
}

impl<const L: usize> FarChanges<L> {
    fn new(
        contact: &LoadedContact,
        (motion, displacement): (&StepMotion, &Both<Lanes<L>>),
        step: &SlipStep,
        old: &Both<Changes<L>>,
        parameters: &ParameterChanges,
    ) -> Self {
        let (far, first) = (&step.far, contact.shells.first.min(FLAT_EDGE));
        let (mut way, mut distance) = (*displacement, Lanes::ZERO);
        for k in 0..2 {
            let (limit, before) = (contact.now.shift[k].max(LEAST), motion.shift_before[k].max(LEAST));
            way[k] += far.cut[k] * old[k][first];
            // A constant load is the limit of falling ones.
            if contact.now.shift[k] <= motion.shift_before[k] {
                let cut = parameters.sum(|terms| (limit / before) * terms.shift_before[k] - terms.shift[k]);
                way[k].add_first((step.old.v[k][first] / before) * cut);
            }
            let mut ratio = way[k];
            ratio.add_first(-far.ratio[k] * parameters.sum(|terms| terms.shift[k]));
            distance += (quotient(far.ratio[k], far.distance) / limit) * ratio;
        }
        FarChanges { part: far.slope * distance, e: across(far.e, far.per_length, way) }
    }

    /// Changes of a spring with a limit that ends in gross slip to a part, `v = (1 - part) v + part l e`.
    fn blend(
        &self,
        (part, e, by_e): (f64, f64, Lanes<L>),
        (v, value): (Lanes<L>, f64),
        (limit, by_limit): (f64, Lanes<4>),
    ) -> Lanes<L> {
        let mut v = (1.0 - part) * v + (limit * e - value) * self.part + (part * limit) * by_e;
        v.add_first((part * e) * by_limit);
        v
    }
}

/// The part of changes across a direction, times a factor.
fn across<const L: usize>(e: Both<f64>, factor: f64, [x, y]: Both<Lanes<L>>) -> Both<Lanes<L>> {
    let turn = factor * (e[0] * y - e[1] * x);
    [-e[1] * turn, e[0] * turn]
}

/// Changes of the spring at the edge.
fn move_edge<const L: usize>(
    contact: &LoadedContact,
    (motion, displacement): (&StepMotion, &Both<Lanes<L>>),
    step: &SlipStep,
    old: &Both<Lanes<L>>,
    parameters: &ParameterChanges,
) -> Both<Lanes<L>> {
    let (mut ratio, edge) = ([Lanes::ZERO; 2], &step.edge);
    let limit = contact.edge_limits().map(|limit| limit.max(LEAST));
    for k in 0..2 {
        ratio[k] = edge.part[k] * displacement[k] + edge.kept[k] * old[k];
        let rise = (contact.now.shift[k] - motion.shift_before[k]).max(limit[k]);
        let [per_rise, per_before] = [motion.displacement[k] / rise, step.old.edge[k] / edge.limit_before[k]];
        ratio[k].add_first(parameters.sum(|terms| {
            let (rise, mut sum) = (terms.shift[k] - terms.shift_before[k], -edge.ratio[k] * terms.edge_limit[k]);
            if edge.part[k] < 1.0 {
                sum += per_rise * (terms.edge_limit[k] - edge.part[k] * rise);
            }
            if edge.kept[k] < 1.0 && edge.kept[k] > 0.0 {
                sum += per_before * (terms.edge_limit[k] - rise - edge.kept[k] * terms.edge_limit_before[k]);
            }
            sum
        }));
        ratio[k] = (1.0 / limit[k]) * ratio[k];
    }
    let (mut end, mut e) = (ratio, edge.ratio);
    if edge.slips {
        let per = quotient(1.0, edge.length);
        e = edge.ratio.map(|ratio| per * ratio);
        end = across(e, per, ratio);
    }
    for k in 0..2 {
        end[k] = limit[k] * end[k];
        end[k].add_first(e[k] * parameters.sum(|terms| terms.edge_limit[k]));
    }
    end
}

/// Changes of a force that Coulomb's law bounds.
pub(crate) fn bounded<const L: usize>(
    force: Both<f64>,
    bound: f64,
    [x, y]: Both<Lanes<L>>,
    parameters: &ParameterChanges,
) -> Both<Lanes<L>> {
    let length = length(force);
    if length <= super::step::ROUNDING * bound {
        return [x, y];
    }
    let per = quotient(1.0, length);
    let e = force.map(|force| force * per);
    let by_bound = parameters.sum(|terms| terms.load);
    let mut slopes = across(e, bound * per, [x, y]);
    for k in 0..2 {
        slopes[k].add_first(e[k] * by_bound);
    }
    slopes
}

impl Slip {
    /// Changes of springs after slip, in place of those of the trial state.
    fn differentiate<const L: usize>(
        &self,
        springs: &Springs,
        v: &mut Both<Changes<L>>,
        parameters: &ParameterChanges,
        slip_of: impl Fn(&ParameterTerms) -> &SlipTerms,
    ) {
        if self.points.set == 0 {
            return;
        }
        let (first, end) = (self.points.first.min(N), springs.shells.range().end.min(N));
        let range = [first, end];
        // The springs at the present tractions, and the slip at them.
        let mut own = [[Lanes::<4>::ZERO; N]; 2];
        for k in 0..2 {
            for j in first..end {
                own[k][j] = -parameters.sum(|terms| slip_of(terms).tractions[k][j]);
            }
            times_upper(&springs.inverse[k], range, &mut own[k]);
            for j in first..end {
                v[k][j].add_first(-own[k][j]);
                v[k][j] = springs.stiffness[k][j] * v[k][j];
                v[k][j].add_first(parameters.sum(|terms| slip_of(terms).forces[k][j]));
            }
            times_upper_transposed(&springs.inverse[k], range, &mut v[k]);
            for i in first..end {
                v[k][i].add_first(parameters.sum(|terms| slip_of(terms).slip[k][i]));
            }
        }
        self.turn(springs, v, range);
        for k in 0..2 {
            times_upper(&springs.inverse[k], range, &mut v[k]);
            for j in first..end {
                v[k][j].add_first(own[k][j]);
            }
        }
    }

    /// Changes of the tractions, in place of those of slip at the present tractions.
    fn turn<const L: usize>(&self, springs: &Springs, slip: &mut Both<Changes<L>>, [first, end]: [usize; 2]) {
        let Slip { points, solution, .. } = self;
        let (first, end) = (first.min(N), end.min(N));
        let sticks = !points.set & within([first, end]);
        let metric = (sticks != 0).then(|| {
            let mut metric = [[Row::ZERO; N]; 2];
            set_metric(&mut metric, springs, [first, end], points.set);
            metric
        });
        if let Some(metric) = &metric {
            eliminate(metric, slip, [first, end], (points.set, sticks));
        }
        let mut across = [Lanes::ZERO; N];
        for m in first..end {
            if points.set >> m & 1 == 1 {
                across[m] = points.e[0][m] * slip[1][m] - points.e[1][m] * slip[0][m];
            }
        }
        solution.solve_lanes([first, end], &mut across);
        for i in first..end {
            if points.set >> i & 1 == 1 {
                (slip[0][i], slip[1][i]) = (-points.e[1][i] * across[i], points.e[0][i] * across[i]);
            }
        }
        if let Some(metric) = &metric {
            // What these take from the tractions of others.
            for k in 0..2 {
                for i in first..end {
                    for m in first..end {
                        if sticks >> i & points.set >> m & 1 == 1 {
                            let taken = metric[k][m][i] * slip[k][m];
                            slip[k][i] -= taken;
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
    metric: &Both<Matrix>,
    slip: &mut Both<Changes<L>>,
    [first, end]: [usize; 2],
    (set, sticks): (Set, Set),
) {
    for k in 0..2 {
        let own = slip[k];
        for i in first..end.min(N) {
            let mut sum = if set >> i & 1 == 1 { own[i] } else { Lanes::ZERO };
            for m in first..end.min(N) {
                if sticks >> m & 1 == 1 {
                    sum -= metric[k][m][i] * own[m];
                }
            }
            slip[k][i] = sum;
        }
    }
}
