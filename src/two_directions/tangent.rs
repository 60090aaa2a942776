//! Derivatives of a step whose values are known: one more step of Newton's method from the solution of each slip.
//!
//! A step is linear in small changes, so many are propagated at once, in lanes: of the motion, of the springs at the start, and of parameters
//! of the contact. Those by parameters have terms of their own, with dC and dk of the shells:
//!
//! ```text
//! C dv = dq - dC v,   dr = C⁻¹'[k (dv* - dv) + dk (v* - v) - dC' r],   e × dr + de × r = 0,   de = e⊥ dθ
//! ```

use super::nodes::{Both, FLAT_EDGE, Matrix, N, NEIGHBOUR, Nodes, Row, SHIFT, both};
use super::shells::{Pressed, Shells, Springs, falls};
use super::slip::{Set, Slip, dot, within};
use super::step::{Contact, LEAST, Motion, Released, Step};
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

/// Parameters of a contact, a lane each: the normal component over its scale at the end and at the start of the step, and the logarithm of
/// the reference size of the nodes.
pub(crate) const END: usize = 0;
pub(crate) const START: usize = 1;
pub(crate) const REFERENCE: usize = 2;

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
    pub fn by_load(nodes: &Nodes, contact: &Contact) -> ContactSlopes {
        let slopes = &contact.slopes;
        let mut by = ContactSlopes { shift: slopes.shift, load: slopes.load, ..ContactSlopes::NONE };
        if contact.now.load > 0.0 {
            by.edge_limit = both(|k| slopes.shift[k] - slopes.inside_shift[k]);
            (by.shells.first, by.shells.last) = (contact.shells.first, contact.shells.last);
            by.shells.set_last_slopes(nodes, &contact.shells, &contact.now, slopes, None);
        }
        by
    }

    /// By the reference size of the nodes, from derivatives of these.
    pub fn by_reference(nodes: &Nodes, slopes: &Nodes, contact: &Contact) -> ContactSlopes {
        let mut by = ContactSlopes::NONE;
        if contact.now.load > 0.0 {
            by.shells = Shells::before(slopes, contact.shells.first, contact.shells.last);
            by.shells.set_last_slopes(nodes, &contact.shells, &contact.now, &Pressed::default(), Some(slopes));
        }
        by
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

/// What derivatives by parameters of a contact add to the changes of its springs.
pub(crate) struct Terms<const L: usize> {
    /// S at the start and at the end, S of the nodes, N; stiffnesses at the end, and the limit of the spring at the edge.
    pub before: Both<Lanes<L>>,
    pub now: Both<Lanes<L>>,
    pub nodes: Both<Changes<L>>,
    pub load: Lanes<L>,
    pub stiffness: Both<Changes<L>>,
    pub edge_stiffness: Both<Lanes<L>>,
    pub edge_limit: Both<Lanes<L>>,
    pub edge_before: Both<Lanes<L>>,
    middle: SlipTerms<L>,
    end: SlipTerms<L>,
}

/// Terms of a slip: dC v; dk (v* - v) - dC' r, in which the pressures are constant; and r dp/p, which is what their changes add to the slip.
struct SlipTerms<const L: usize> {
    tractions: Both<Changes<L>>,
    forces: Both<Changes<L>>,
    slip: Both<Changes<L>>,
}

impl<const L: usize> SlipTerms<L> {
    const ZERO: Self = {
        let zero = [[Lanes::ZERO; N]; 2];
        SlipTerms { tractions: zero, forces: zero, slip: zero }
    };

    /// Adds a parameter, by which the shells from one on, and the nodes, have derivatives.
    fn add(
        &mut self,
        lane: usize,
        springs: &Springs,
        (ends, nodes, from): ([&Shells; 2], Option<&Nodes>, usize),
        trial: &Both<Row>,
        slip: &Slip,
    ) {
        let (shells, slip, lane) = (&springs.shells, &slip.points, lane % L);
        if slip.set == 0 {
            return;
        }
        let (by, mut by_pressure) = (Shells::middle(ends), Row::ZERO);
        for j in from.max(FLAT_EDGE)..shells.range().end {
            by_pressure += Shells::middle_pressure(ends, nodes, j);
        }
        by_pressure = springs.per_pressure * by_pressure;
        for k in 0..2 {
            let (v, per_shift, slipped) = (&slip.v[k], &springs.per_shift[k], slip.r[k] * springs.per_pressure);
            let stiffness = stiffness_slopes(springs, k, &by);
            let (mut tractions, mut before, falls) = (Row::ZERO, 0.0, falls(v) * *per_shift);
            for j in shells.range() {
                let mut sum = 0.0;
                if j >= from {
                    let row =
                        Shells::middle_pressure(ends, nodes, j) - by.shift[k][j] * per_shift[j] * springs.pressure[j];
                    tractions += falls[j] * row;
                    sum = per_shift[j] * dot(&slipped, &row);
                }
                self.forces[k][j][lane] = stiffness[j] * (trial[k][j] - v[j]) - (sum - before);
                before = sum;
            }
            let tractions = springs.per_pressure * tractions - slip.q[k] * by_pressure;
            let slip = slip.r[k] * by_pressure;
            for i in 0..N {
                self.tractions[k][i][lane] = tractions[i];
                self.slip[k][i][lane] = slip[i];
            }
        }
    }
}

/// Derivatives of k_j.
fn stiffness_slopes(springs: &Springs, k: usize, by: &Shells) -> Row {
    let secants = (by.load[k] - springs.shells.load[k] * springs.per_shift[k] * by.shift[k]) * springs.per_shift[k];
    let mut stiffness = secants;
    for j in 1..N {
        stiffness[j] = secants[j] - secants[j - 1];
    }
    stiffness
}

impl<const L: usize> Terms<L> {
    pub const ZERO: Self = Terms {
        before: [Lanes::ZERO; 2],
        now: [Lanes::ZERO; 2],
        nodes: [[Lanes::ZERO; N]; 2],
        load: Lanes::ZERO,
        stiffness: [[Lanes::ZERO; N]; 2],
        edge_stiffness: [Lanes::ZERO; 2],
        edge_limit: [Lanes::ZERO; 2],
        edge_before: [Lanes::ZERO; 2],
        middle: SlipTerms::ZERO,
        end: SlipTerms::ZERO,
    };

    /// Adds a parameter in a lane: by which the contact at the start, that at the end, or both have derivatives, and of S of the nodes.
    #[inline(never)]
    pub fn add(
        &mut self,
        lane: usize,
        contact: &Contact,
        (step, constant_load): (&Step, bool),
        [from, to]: [Option<&ContactSlopes>; 2],
        nodes: Option<&Nodes>,
    ) {
        let none = Shells::NONE;
        let ends = [from, to].map(|by| by.map_or(&none, |by| &by.shells));
        let between = if constant_load { &step.springs } else { &step.between };
        // By the load, only the last shells have derivatives.
        let lasts = [from, to].map(|by| by.map_or(N, |by| by.shells.last));
        let first = if nodes.is_some() { 0 } else { lasts[0].min(lasts[1]) };
        let half = both(|k| 0.5 * (step.old.v[k] + step.trial[k]));
        self.middle.add(lane, between, (ends, nodes, first), &half, &step.middle);
        let used = contact.used();
        let beyond = both(|k| used * (2.0 * step.middle.points.v[k] - step.old.v[k]));
        self.end.add(lane, &step.springs, ([ends[1]; 2], nodes, first), &beyond, &step.end);
        let lane = lane % L;
        for k in 0..2 {
            let stiffness = stiffness_slopes(&step.springs, k, ends[1]);
            for j in 0..N {
                self.stiffness[k][j][lane] = stiffness[j];
                self.nodes[k][j][lane] = nodes.map_or(0.0, |nodes| nodes[SHIFT + k][j]);
            }
            self.before[k][lane] = from.map_or(0.0, |by| by.shift[k]);
            self.edge_stiffness[k][lane] = ends[1].edge[k];
            self.now[k][lane] = to.map_or(0.0, |by| by.shift[k]);
            self.edge_limit[k][lane] = to.map_or(0.0, |by| by.edge_limit[k]);
            self.edge_before[k][lane] = from.map_or(0.0, |by| by.edge_limit[k]);
        }
        self.load[lane] = to.map_or(0.0, |by| by.load);
    }
}

/// Propagates changes of the springs and of the displacement through a step: those of the springs after it, in place, and of the force, which is
/// not yet bounded.
pub(crate) fn propagate<const L: usize>(
    contact: &Contact,
    nodes: &Nodes,
    (motion, by): (&Motion, &Both<Lanes<L>>),
    (step, new): (&Step, &super::step::Displacements),
    springs: &mut SpringChanges<L>,
    terms: Option<&Terms<L>>,
) -> Both<Lanes<L>> {
    let used = contact.used();
    let old = springs.v;
    let mut v = old;
    for k in 0..2 {
        let rise = contact.now.shift[k] - motion.before[k];
        for j in 0..N {
            v[k][j] = used[j] * (v[k][j] + step.parts[k][j] * by[k]);
            if let Some(terms) = terms
                && step.parts[k][j] < 1.0
            {
                // The part of springs that are engaged in the step is their limit over the rise.
                let rises = terms.now[k] - terms.before[k];
                let part = used[j] * (terms.now[k] - terms.nodes[k][j]) - step.parts[k][j] * rises;
                v[k][j] += (motion.by[k] / rise.max(LEAST)) * part;
            }
        }
    }
    release(contact, nodes, motion, step, &mut v, terms);
    let far = &step.far;
    if far.part < 1.0 {
        let between = if motion.constant_load { &step.springs } else { &step.between };
        for k in 0..2 {
            for j in 0..N {
                v[k][j] = 0.5 * (v[k][j] + old[k][j]);
            }
        }
        step.middle.differentiate(between, &mut v, terms.map(|terms| &terms.middle));
        for k in 0..2 {
            for j in 0..N {
                v[k][j] = used[j] * (2.0 * v[k][j] - old[k][j]);
            }
        }
        step.end.differentiate(&step.springs, &mut v, terms.map(|terms| &terms.end));
    }
    let mut edges = move_edge(contact, (motion, by), step, &springs.edge, terms);
    if far.part > 0.0 {
        let changes = FarChanges::new(contact, (motion, by), step, &old, terms);
        let (limits, edge_limits) = (contact.limits(nodes), contact.edge_limits());
        for k in 0..2 {
            let (limits, by_limit) = (limits[k], |j: usize| match terms {
                Some(terms) => used[j] * (terms.now[k] - terms.nodes[k][j]),
                None => Lanes::ZERO,
            });
            for j in 0..N {
                let value = step.end.points.v[k][j];
                v[k][j] = changes.blend((far.part, far.e[k], changes.e[k]), (v[k][j], value), (limits[j], by_limit(j)));
            }
            let by_limit = terms.map_or(Lanes::ZERO, |terms| terms.edge_limit[k]);
            let (limit, edge) = (edge_limits[k], &step.edge);
            let value = limit * edge.ratio[k] / if edge.slips { edge.length.max(1.0) } else { 1.0 };
            edges[k] = changes.blend((far.part, far.e[k], changes.e[k]), (edges[k], value), (limit, by_limit));
        }
    }
    let mut force = [Lanes::ZERO; 2];
    for k in 0..2 {
        for j in 0..N {
            force[k] += step.springs.stiffness[k][j] * v[k][j];
            if let Some(terms) = terms {
                force[k] += new.v[k][j] * terms.stiffness[k][j];
            }
        }
        force[k] += contact.shells.edge[k] * edges[k];
        if let Some(terms) = terms {
            force[k] += new.edge[k] * terms.edge_stiffness[k];
        }
    }
    *springs = SpringChanges { v, edge: edges };
    force
}

/// Changes of the trial state of springs that are released.
fn release<const L: usize>(
    contact: &Contact,
    nodes: &Nodes,
    motion: &Motion,
    step: &Step,
    v: &mut Both<Changes<L>>,
    terms: Option<&Terms<L>>,
) {
    let fall = motion.before[0] - contact.now.shift[0];
    if motion.constant_load || fall <= 0.0 {
        return;
    }
    let limits = contact.limits(nodes);
    for j in contact.shells.range() {
        let limit = [limits[0][j].max(LEAST), limits[1][j].max(LEAST)];
        let trial = [step.old.v[0][j] + motion.by[0], step.old.v[1][j] + motion.by[1]];
        let released = Released::new(limit, fall, trial);
        if released.scale >= 1.0 {
            continue;
        }
        // Four divisors, not three: the compiler would divide by what is beside them in the vector register.
        let divisors = Lanes([limit[0], limit[1], released.length.max(1.0), limit[0] + fall]);
        let [per_x, per_y, per_length, per_before] = *(1.0 / divisors);
        let (mut by_limit, mut by_part) = ([Lanes::ZERO; 2], Lanes::ZERO);
        if let Some(terms) = terms {
            by_limit = [terms.now[0] - terms.nodes[0][j], terms.now[1] - terms.nodes[1][j]];
            by_part = (released.part * per_x) * by_limit[0]
                - (released.part * per_before) * (terms.before[0] - terms.nodes[0][j]);
        }
        let mut ratio = [Lanes::ZERO; 2];
        for k in 0..2 {
            ratio[k] = [per_x, per_y][k] * (v[k][j] - released.ratio[k] * by_limit[k]);
        }
        let length = per_length * (released.ratio[0] * ratio[0] + released.ratio[1] * ratio[1]);
        let scale = per_length * ((released.part - released.scale) * length + (released.length - 1.0) * by_part);
        for k in 0..2 {
            v[k][j] = limit[k] * (released.scale * ratio[k] + released.ratio[k] * scale)
                + (released.ratio[k] * released.scale) * by_limit[k];
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
        contact: &Contact,
        (motion, by): (&Motion, &Both<Lanes<L>>),
        step: &Step,
        old: &Both<Changes<L>>,
        terms: Option<&Terms<L>>,
    ) -> Self {
        let (far, first) = (&step.far, contact.shells.first.min(FLAT_EDGE));
        let (mut way, mut distance) = (*by, Lanes::ZERO);
        for k in 0..2 {
            let (limit, before) = (contact.now.shift[k].max(LEAST), motion.before[k].max(LEAST));
            way[k] += far.cut[k] * old[k][first];
            let mut by_limit = Lanes::ZERO;
            if let Some(terms) = terms {
                by_limit = terms.now[k];
                // A constant load is the limit of falling ones.
                if contact.now.shift[k] <= motion.before[k] {
                    way[k] += (step.old.v[k][first] / before) * ((limit / before) * terms.before[k] - terms.now[k]);
                }
            }
            distance += (quotient(far.ratio[k], far.distance) / limit) * (way[k] - far.ratio[k] * by_limit);
        }
        let turn = far.per_length * (far.e[0] * way[1] - far.e[1] * way[0]);
        FarChanges { part: far.slope * distance, e: [-far.e[1] * turn, far.e[0] * turn] }
    }

    /// Changes of a spring with a limit that ends in gross slip to a part, `v = (1 - part) v + part l e`.
    fn blend(
        &self,
        (part, e, by_e): (f64, f64, Lanes<L>),
        (v, value): (Lanes<L>, f64),
        (limit, by_limit): (f64, Lanes<L>),
    ) -> Lanes<L> {
        (1.0 - part) * v + (limit * e - value) * self.part + part * (limit * by_e + e * by_limit)
    }
}

/// Changes of the spring at the edge.
fn move_edge<const L: usize>(
    contact: &Contact,
    (motion, by): (&Motion, &Both<Lanes<L>>),
    step: &Step,
    old: &Both<Lanes<L>>,
    terms: Option<&Terms<L>>,
) -> Both<Lanes<L>> {
    let (mut ratio, edge) = ([Lanes::ZERO; 2], &step.edge);
    let limit = contact.edge_limits().map(|limit| limit.max(LEAST));
    for k in 0..2 {
        ratio[k] = edge.part[k] * by[k] + edge.kept[k] * old[k];
        if let Some(terms) = terms {
            if edge.part[k] < 1.0 {
                let rise = (contact.now.shift[k] - motion.before[k]).max(limit[k]);
                let part = terms.edge_limit[k] - edge.part[k] * (terms.now[k] - terms.before[k]);
                ratio[k] += (motion.by[k] / rise) * part;
            }
            if edge.kept[k] < 1.0 && edge.kept[k] > 0.0 {
                let kept = terms.edge_limit[k] - (terms.now[k] - terms.before[k]) - edge.kept[k] * terms.edge_before[k];
                ratio[k] += (step.old.edge[k] / edge.before[k]) * kept;
            }
            ratio[k] -= edge.ratio[k] * terms.edge_limit[k];
        }
        ratio[k] = (1.0 / limit[k]) * ratio[k];
    }
    let (mut end, mut e) = (ratio, edge.ratio);
    if edge.slips {
        let per = quotient(1.0, edge.length);
        e = edge.ratio.map(|ratio| per * ratio);
        let turn = per * (e[0] * ratio[1] - e[1] * ratio[0]);
        end = [-e[1] * turn, e[0] * turn];
    }
    for k in 0..2 {
        end[k] = limit[k] * end[k];
        if let Some(terms) = terms {
            end[k] += e[k] * terms.edge_limit[k];
        }
    }
    end
}

/// Changes of a force that Coulomb's law bounds.
pub(crate) fn bounded<const L: usize>(
    force: Both<f64>,
    bound: f64,
    [x, y]: Both<Lanes<L>>,
    by_bound: Option<Lanes<L>>,
) -> Both<Lanes<L>> {
    let length = (force[0] * force[0] + force[1] * force[1]).sqrt();
    if length <= super::step::ROUNDING * bound {
        return [x, y];
    }
    let per = quotient(1.0, length);
    let e = force.map(|force| force * per);
    let turn = (bound * per) * (e[0] * y - e[1] * x);
    let along = by_bound.unwrap_or(Lanes::ZERO);
    [e[0] * along - e[1] * turn, e[1] * along + e[0] * turn]
}

impl Slip {
    /// Changes of springs after slip, in place of those of the trial state.
    fn differentiate<const L: usize>(&self, springs: &Springs, v: &mut Both<Changes<L>>, terms: Option<&SlipTerms<L>>) {
        if self.points.set == 0 {
            return;
        }
        let (first, end) = (self.points.first.min(N), springs.shells.range().end.min(N));
        // The springs at the present tractions, and the slip at them. Both maps are triangular, and applied in place.
        let mut own = [[Lanes::ZERO; N]; 2];
        if let Some(terms) = terms {
            for k in 0..2 {
                for j in first..end {
                    let mut sum = Lanes::ZERO;
                    for i in j..end {
                        sum -= springs.inverse[k][j][i] * terms.tractions[k][i];
                    }
                    own[k][j] = sum;
                    v[k][j] -= sum;
                }
            }
        }
        for k in 0..2 {
            for j in first..end {
                v[k][j] = springs.stiffness[k][j] * v[k][j];
                if let Some(terms) = terms {
                    v[k][j] += terms.forces[k][j];
                }
            }
            for i in (first..end).rev().map(|i| i.min(N - 1)) {
                let mut sum = Lanes::ZERO;
                for j in first..=i {
                    sum += springs.inverse[k][j][i] * v[k][j];
                }
                v[k][i] = sum;
                if let Some(terms) = terms {
                    v[k][i] += terms.slip[k][i];
                }
            }
        }
        self.turn(v, [first, end]);
        for k in 0..2 {
            for j in first..end {
                let mut sum = own[k][j];
                for i in j..end {
                    sum += springs.inverse[k][j][i] * v[k][i];
                }
                v[k][j] = sum;
            }
        }
    }

    /// Changes of the tractions, in place of those of slip at the present tractions.
    fn turn<const L: usize>(&self, slip: &mut Both<Changes<L>>, [first, end]: [usize; 2]) {
        let Slip { points, metric, inverse, .. } = self;
        let (first, end) = (first.min(N), end.min(N));
        let sticks = !points.set & within([first, end]);
        if sticks != 0 {
            eliminate(metric, slip, [first, end], (points.set, sticks));
        }
        let mut across = [Lanes::ZERO; N];
        for m in first..end {
            if points.set >> m & 1 == 1 {
                across[m] = points.e[0][m] * slip[1][m] - points.e[1][m] * slip[0][m];
            }
        }
        for i in first..end {
            let mut turn = Lanes::ZERO;
            for m in first..end {
                turn += inverse[m][i] * across[m];
            }
            if points.set >> i & 1 == 1 {
                (slip[0][i], slip[1][i]) = (-points.e[1][i] * turn, points.e[0][i] * turn);
            }
        }
        if sticks != 0 {
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

/// Points in between that stick: their tractions at those of the others, in place of their slip, and the slip that the others take from it.
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
