//! Derivatives of a step whose values are known.
//!
//! The springs after a step depend on the springs before, on the displacement, and on three parameters of the contact:
//! the normal component at both ends, and the reference size of the nodes. [`StepInput::advance`] is the step for
//! numbers with derivatives, too. Only the slip of a stage needs formulas of its own, because its values come from an
//! iteration: one more step of Newton's method from the solution. With the trial state v*, the springs v, their
//! tractions q and the slip r of [`slip`](super::slip),
//!
//! ```text
//! q = C v              dq = C dv + dC v
//! C' r = k (v* - v)    dr = C⁻¹'[k (dv* - dv) + dk (v* - v) - dC' r]
//! e × r = 0            e × dr + de × r = 0,   de = e⊥ dθ  at points that slip;   dr = 0  at those that stick
//! ```
//!
//! in three stages: dv and dr as if dq were 0, dq from the last line with -J⁻¹, and dv = C⁻¹ (dq - dC v)
//! ([`Slip::differentiate`]). What dC and dk, the changes of the shells, add is the same for all changes of a
//! parameter. It is computed once a step ([`ParameterTerms`]); then changes by many coefficients are propagated,
//! several at once in the lanes of a number ([`Propagation`]).
//!
//! `tests/two_directions.rs` compares Jacobians of random motions with differences. A wrong derivative by one
//! parameter, with the others right, shows in the normal component or in a load beyond that of the nodes only.

use super::matrix::{dot, times_symmetric, times_upper, times_upper_transposed};
use super::nodes::{FLAT_EDGE, Matrix, Nodes, PerAxis, PointSet, Row, SPRINGS, by_axis, points_in};
use super::path::ContactPath;
use super::shells::{ScaledNormalState, Shells, Springs, minus_next};
use super::slip::{Points, Slip, set_metric};
use super::step::{
    Displacements, LENGTH_SLIP_THRESHOLD, LoadedContact, PerSpring, SolvedStep, Stage, StepInput, by_spring, update,
    within_friction_limit,
};
use crate::numerics::dual::{Dual, Number};
use crate::numerics::lanes::Lanes;

/// A value for each parameter of a step: the normal component over its scale at the start and at the end, and the
/// logarithm of the reference size of the nodes.
#[derive(Clone, Copy, Default)]
pub(crate) struct PerParameter<T> {
    pub start: T,
    pub end: T,
    pub reference: T,
}

/// Derivatives of the shells of a contact by the normal component over its scale, and by the logarithm of the reference
/// size if the nodes depend on it.
#[derive(Clone, Copy)]
pub(crate) struct ContactSlopes {
    by_load: Shells,
    by_reference: Shells,
}

impl ContactSlopes {
    pub fn new(nodes: &Nodes, node_slopes: Option<&Nodes>, contact: &LoadedContact) -> ContactSlopes {
        let LoadedContact { normal, slopes, shells } = contact;
        if normal.load == 0.0 {
            return ContactSlopes { by_load: Shells::ZERO, by_reference: Shells::ZERO };
        }
        ContactSlopes {
            by_load: shells.slopes((nodes, None), [normal, slopes]),
            by_reference: shells.slopes((nodes, node_slopes), [normal, &ScaledNormalState::ZERO]),
        }
    }
}

/// Additions to the changes of a step by a change of one parameter.
#[derive(Clone, Copy)]
struct ParameterTerms {
    /// Derivatives of the normal state at the start and at the end, and of S of the nodes.
    states: [ScaledNormalState; 2],
    shift_of_nodes: PerAxis<Row>,
    /// Derivatives of the stiffnesses at the end.
    stiffness: PerAxis<Row>,
    edge_stiffness: PerAxis<f64>,
    slips: [SlipTerms; 2],
}

/// Additions to the changes of a slip by a change of one parameter, see the equations above: `dC v` to the tractions,
/// `dk (v* - v) - dC' r` at constant p to the forces of the springs, and `r dp/p` to the slip.
#[derive(Clone, Copy)]
struct SlipTerms {
    tractions: PerAxis<Row>,
    forces: PerAxis<Row>,
    slip: PerAxis<Row>,
}

impl SlipTerms {
    const ZERO: SlipTerms = {
        let zero = [Row::ZERO; 2];
        SlipTerms { tractions: zero, forces: zero, slip: zero }
    };

    /// Sets the terms, given the derivatives of the shells at both ends and of the nodes; those of shells before
    /// `first` are 0. The values are [`Springs::set`].
    fn set(&mut self, springs: &Springs, slip: &Slip, (ends, nodes, first): ([&Shells; 2], Option<&Nodes>, usize)) {
        let (shells, trial, slip) = (&springs.shells, &slip.trial, &slip.points);
        if slip.set == 0 {
            return;
        }
        let (shell_slopes, mut by_pressure) = (Shells::middle(ends), Row::ZERO);
        let (mut tractions, mut sums) = ([Row::ZERO; 2], [Row::ZERO; 2]);
        let gradients = by_axis(|axis| minus_next(&slip.v[axis]) * springs.per_delta_shift[axis]);
        let slipped = by_axis(|axis| slip.r[axis] * springs.per_pressure);
        for j in first.max(shells.range().start)..shells.range().end {
            let pressure = Shells::middle_pressure(ends, nodes, j);
            if j >= FLAT_EDGE {
                by_pressure += pressure;
            }
            for axis in 0..2 {
                let per_delta_shift = springs.per_delta_shift[axis][j];
                let row = pressure - shell_slopes.delta_shift[axis][j] * per_delta_shift * springs.pressure[j];
                tractions[axis] += gradients[axis][j] * row;
                sums[axis][j] = per_delta_shift * dot(&slipped[axis], &row);
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

/// x_j - x_{j-1}, with 0 before the first one.
fn minus_previous(x: &Row) -> Row {
    let mut differences = *x;
    for j in 1..SPRINGS {
        differences[j] -= x[j - 1];
    }
    differences
}

/// Derivatives of k_j, see [`Shells::stiffness`], but for its lower bound, which only keeps rounding errors from being
/// negative.
fn stiffness_slopes(springs: &Springs, axis: usize, slopes: &Shells) -> Row {
    let secants = (slopes.delta_load[axis]
        - springs.shells.delta_load[axis] * springs.per_delta_shift[axis] * slopes.delta_shift[axis])
        * springs.per_delta_shift[axis];
    minus_previous(&secants)
}

impl ParameterTerms {
    const ZERO: ParameterTerms = ParameterTerms {
        states: [ScaledNormalState::ZERO; 2],
        shift_of_nodes: [Row::ZERO; 2],
        stiffness: [Row::ZERO; 2],
        edge_stiffness: [0.0; 2],
        slips: [SlipTerms::ZERO; 2],
    };

    /// Sets the terms, given the derivatives of the normal states at both ends, and those of the shells as in
    /// [`SlipTerms::set`].
    #[inline(never)]
    fn set(
        &mut self,
        (solved, path): (&SolvedStep, &ContactPath),
        states: [ScaledNormalState; 2],
        (ends, nodes, first): ([&Shells; 2], Option<&Nodes>, usize),
    ) {
        let [_, end] = ends;
        for (stage, ends) in [(Stage::Middle, ends), (Stage::End, [end; 2])] {
            let (terms, slip) = (&mut self.slips[stage as usize], &solved.slips[stage as usize]);
            terms.set(solved.springs(stage, path), slip, (ends, nodes, first));
        }
        self.stiffness = by_axis(|axis| stiffness_slopes(&solved.end_springs, axis, end));
        self.edge_stiffness = end.edge_stiffness;
        self.shift_of_nodes = nodes.map_or([Row::ZERO; 2], |nodes| nodes.shift);
        self.states = states;
    }
}

/// Derivatives of a slip by its trial state: the metric K of its points, and -J⁻¹.
struct SlipJacobian {
    metric: PerAxis<Matrix>,
    inverse: Matrix,
}

impl SlipJacobian {
    const ZERO: SlipJacobian = SlipJacobian { metric: [[Row::ZERO; SPRINGS]; 2], inverse: [Row::ZERO; SPRINGS] };

    fn set(&mut self, springs: &Springs, slip: &Slip) {
        let (points, range) = (&slip.points, slip.range(springs));
        if points.set != 0 {
            set_metric(&mut self.metric, springs, range, points.set);
            points.invert(&mut self.inverse, &self.metric, range);
        }
    }
}

/// The derivatives of a step: those of both slips, and the terms of each parameter.
pub(crate) struct StepTangent {
    terms: PerParameter<ParameterTerms>,
    slips: [SlipJacobian; 2],
}

impl StepTangent {
    pub const ZERO: StepTangent = StepTangent {
        terms: PerParameter { start: ParameterTerms::ZERO, end: ParameterTerms::ZERO, reference: ParameterTerms::ZERO },
        slips: [SlipJacobian::ZERO, SlipJacobian::ZERO],
    };

    /// Sets the derivatives of a step between contacts, given those of their shells, and of the nodes if they depend on
    /// the reference size.
    pub fn set(
        &mut self,
        (solved, path): (&SolvedStep, &ContactPath),
        [from, to]: [&LoadedContact; 2],
        [by_from, by_to]: [&ContactSlopes; 2],
        node_slopes: Option<&Nodes>,
    ) {
        let (none, terms) = (ScaledNormalState::ZERO, &mut self.terms);
        // By the load, only the last shells have derivatives.
        let by_start = ([&by_from.by_load, &Shells::ZERO], None, from.shells.last);
        let by_end = ([&Shells::ZERO, &by_to.by_load], None, to.shells.last);
        terms.start.set((solved, path), [from.slopes, none], by_start);
        terms.end.set((solved, path), [none, to.slopes], by_end);
        if node_slopes.is_some() {
            terms.reference.set(
                (solved, path),
                [none; 2],
                ([&by_from.by_reference, &by_to.by_reference], node_slopes, 0),
            );
        }
        for stage in [Stage::Middle, Stage::End] {
            self.slips[stage as usize].set(solved.springs(stage, path), &solved.slips[stage as usize]);
        }
    }
}

/// Changes of the parameters in the first four of the lanes that are propagated, and what they act on.
pub(crate) struct ParameterChanges<'a> {
    pub tangent: &'a StepTangent,
    pub changes: PerParameter<Lanes<4>>,
}

impl ParameterChanges<'_> {
    /// The sum of a term times the change of its parameter, over all parameters.
    fn sum(&self, term: impl Fn(&ParameterTerms) -> f64) -> Lanes<4> {
        let PerParameter { start, end, reference } = &self.tangent.terms;
        let changes = &self.changes;
        term(end) * changes.end + term(start) * changes.start + term(reference) * changes.reference
    }

    /// A number that the parameters change.
    fn dual<const L: usize>(&self, value: f64, slope: impl Fn(&ParameterTerms) -> f64) -> Dual<L> {
        let mut dual = Dual::constant(value);
        dual.slopes.add_first(self.sum(slope));
        dual
    }
}

/// A step through which changes are propagated.
pub(crate) struct Propagation<'a> {
    pub contacts: [&'a LoadedContact; 2],
    pub nodes: &'a Nodes,
    pub path: &'a ContactPath,
    pub solved: &'a SolvedStep,
    pub parameters: ParameterChanges<'a>,
}

impl Propagation<'_> {
    /// Propagates changes of the displacement and of the springs: those of the springs after the step, in place, and of
    /// the force.
    pub fn propagate<const L: usize>(
        &self,
        displacement: &PerAxis<Lanes<L>>,
        springs: &mut Displacements<Lanes<L>>,
    ) -> PerAxis<Lanes<L>> {
        let Propagation { contacts, nodes, path, solved, parameters } = self;
        let [_, to] = contacts;
        let state = |end: usize| {
            let values = contacts[end].normal.values();
            let number = |i: usize| parameters.dual(values[i], |terms| terms.states[end].values()[i]);
            ScaledNormalState::from_values(core::array::from_fn(number))
        };
        let dual = |value: f64, slopes: Lanes<L>| Dual { value, slopes };
        let (in_use, limits) = (to.in_use(), to.limits(nodes));
        let limit = |axis: usize, j: usize| {
            let slope = |terms: &ParameterTerms| terms.states[1].shift[axis] - terms.shift_of_nodes[axis][j];
            parameters.dual(limits[axis][j], |terms| in_use[j] * slope(terms))
        };
        let (stiffness, edge_stiffness) = (&solved.end_springs.stiffness, to.shells.edge_stiffness);
        let input = StepInput {
            displacement: by_axis(|axis| dual(path.displacement[axis], displacement[axis])),
            old: Displacements {
                v: by_spring(|axis, j| dual(solved.old.v[axis][j], springs.v[axis][j])),
                edge: by_axis(|axis| dual(solved.old.edge[axis], springs.edge[axis])),
            },
            used: to.shells.range(),
            limits: by_spring(limit),
            stiffness: by_spring(|axis, j| parameters.dual(stiffness[axis][j], |terms| terms.stiffness[axis][j])),
            edge_stiffness: by_axis(|axis| parameters.dual(edge_stiffness[axis], |terms| terms.edge_stiffness[axis])),
            states: [state(0), state(1)],
        };
        let output = input.advance(|stage, v| {
            let (mut changes, slip) = (by_spring(|axis, j| v[axis][j].slopes), stage.pick(&solved.slips));
            slip.differentiate(stage, solved.springs(stage, path), &mut changes, parameters);
            update(v, |axis, j, _| dual(slip.points.v[axis][j], changes[axis][j]));
        });
        let bound = input.states[1].load;
        let force = within_friction_limit(output.force, bound, LENGTH_SLIP_THRESHOLD);
        let Displacements { v, edge } = &output.springs;
        update(&mut springs.v, |axis, j, _| v[axis][j].slopes);
        springs.edge = edge.map(|edge| edge.slopes);
        force.map(|force| force.slopes)
    }
}

impl Slip {
    /// Replaces changes of the trial state of a stage by those of the springs after slip.
    fn differentiate<const L: usize>(
        &self,
        stage: Stage,
        springs: &Springs,
        v: &mut PerSpring<Lanes<L>>,
        parameters: &ParameterChanges,
    ) {
        if self.points.set == 0 {
            return;
        }
        let range = self.range(springs);
        let [first, end] = range;
        // dv and dr at constant tractions, dq = 0.
        let mut own = [[Lanes::<4>::ZERO; SPRINGS]; 2];
        for axis in 0..2 {
            for j in first..end {
                own[axis][j] = -parameters.sum(|terms| stage.pick(&terms.slips).tractions[axis][j]);
            }
            times_upper(&springs.inverse[axis], range, &mut own[axis]);
            for j in first..end {
                v[axis][j].add_first(-own[axis][j]);
                v[axis][j] = springs.stiffness[axis][j] * v[axis][j];
                v[axis][j].add_first(parameters.sum(|terms| stage.pick(&terms.slips).forces[axis][j]));
            }
            times_upper_transposed(&springs.inverse[axis], range, &mut v[axis]);
            for i in first..end {
                v[axis][i].add_first(parameters.sum(|terms| stage.pick(&terms.slips).slip[axis][i]));
            }
        }
        self.tractions_of(stage.pick(&parameters.tangent.slips), v, range);
        for axis in 0..2 {
            times_upper(&springs.inverse[axis], range, &mut v[axis]);
            for j in first..end {
                v[axis][j].add_first(own[axis][j]);
            }
        }
    }

    /// Replaces dr at constant tractions, `C⁻¹'[...]`, by dq, which follows from `e × dr + de × r = 0`.
    fn tractions_of<const L: usize>(&self, jacobian: &SlipJacobian, slip: &mut PerSpring<Lanes<L>>, range: [usize; 2]) {
        let (Points { set, e, .. }, SlipJacobian { metric, inverse }) = (&self.points, jacobian);
        let sticks = !set & points_in(range);
        let is_in = |set: PointSet, i: usize| set >> i & 1 == 1;
        // The product of K with the changes of the points of a set.
        let product = |set: PointSet, changes: &PerSpring<Lanes<L>>| {
            by_axis(|axis| {
                let of_set = |i: usize| if is_in(set, i) { changes[axis][i] } else { Lanes::ZERO };
                times_symmetric(&metric[axis], range, &core::array::from_fn(of_set))
            })
        };
        if sticks != 0 {
            // Points that stick between others are eliminated from K: their changes of slip become changes of their
            // tractions, and are subtracted from those of the others by their share.
            let taken = product(sticks, slip);
            update(slip, |axis, i, slip| if is_in(sticks, i) { -taken[axis][i] } else { slip - taken[axis][i] });
        }
        let across = core::array::from_fn(|i| {
            let across = e[0][i] * slip[1][i] - e[1][i] * slip[0][i];
            if is_in(*set, i) { across } else { Lanes::ZERO }
        });
        let across = times_symmetric(inverse, range, &across);
        for i in 0..SPRINGS {
            if is_in(*set, i) {
                (slip[0][i], slip[1][i]) = (e[1][i] * across[i], -e[0][i] * across[i]);
            }
        }
        if sticks != 0 {
            // The tractions of the points that slip change those of the points that stick.
            let taken = product(*set, slip);
            update(slip, |axis, i, slip| if is_in(sticks, i) { slip - taken[axis][i] } else { slip });
        }
    }
}
