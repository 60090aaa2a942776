//! A step of a contact that is closed at its end.
//!
//! The springs first stick: they follow the displacement δ, those that a rising load engages in the step the part
//! `(S_b - S_j)/ΔS_b` of it. Slip is found twice, so that it has the direction of the middle of the step and not of its
//! end:
//!
//! 1. in the middle, `v_m` from `(v_0 + v*)/2`, with the shells of the middle;
//! 2. at the end, `v_1` from `2 v_m - v_0`, where the tractions exceed their bound to second order only.
//!
//! On a straight path that is exact. A displacement of several times the innermost limit erases the memory: the springs
//! end in gross slip in its direction, `v_j = (S_b - S_j) δ/|δ|`.
//!
//! One more spring carries the sizes from one just inside the edge on. It slips on its own, and makes the stiffness of
//! a stuck contact exact.
//!
//! A step is written once, for numbers with derivatives or without ([`Number`]): only the slip at the points has
//! derivatives of its own, in [`tangent`](super::tangent).

use super::nodes::{Nodes, PerAxis, Row, SPRINGS, by_axis, length, mask_of, points_in};
use super::path::ContactPath;
use super::shells::{ScaledNormalState, Shells, Springs};
use super::slip::{Metric, Slip};
use crate::numerics::dual::Number;
use crate::numerics::lanes::Lanes;
use crate::numerics::record::record;
use core::ops::Range;

/// A contact under a load, by default open: its normal state, with derivatives by the normal component over its scale,
/// and its shells.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct LoadedContact {
    pub normal: ScaledNormalState,
    pub slopes: ScaledNormalState,
    pub shells: Shells,
}

impl LoadedContact {
    pub fn new(nodes: &Nodes, [normal, slopes]: &[ScaledNormalState; 2]) -> LoadedContact {
        LoadedContact { normal: *normal, slopes: *slopes, shells: Shells::new(nodes, normal) }
    }

    /// The limits S_b - S_j of the displacements of the springs; 0 beyond the edge.
    pub fn limits(&self, nodes: &Nodes) -> PerAxis<Row> {
        by_axis(|axis| self.in_use() * (self.normal.shift[axis] - nodes.shift[axis]))
    }

    /// 1 for springs in use, 0 for those beyond the edge.
    pub fn in_use(&self) -> Row {
        mask_of(points_in([self.shells.first, self.shells.last + 1]))
    }
}

/// A number of each spring in each direction.
pub(crate) type PerSpring<T> = PerAxis<[T; SPRINGS]>;

/// The values of a function of the direction and the spring.
pub(crate) fn by_spring<T>(value: impl Fn(usize, usize) -> T) -> PerSpring<T> {
    by_axis(|axis| core::array::from_fn(|j| value(axis, j)))
}

/// Replaces each value by that of a function of the direction, the spring and the value.
pub(crate) fn update<T: Copy>(values: &mut PerSpring<T>, change: impl Fn(usize, usize, T) -> T) {
    for axis in 0..2 {
        for j in 0..SPRINGS {
            values[axis][j] = change(axis, j, values[axis][j]);
        }
    }
}

record! {
    /// The springs: displacements, and those of the spring at the edge.
    pub(crate) struct Displacements<T = f64> {
        pub v: PerSpring<T>,
        pub edge: PerAxis<T>,
    }
}

impl Displacements {
    pub const ZERO: Displacements = Displacements { v: [[0.0; SPRINGS]; 2], edge: [0.0; 2] };
}

/// Limits below this, in the unit of the springs, are rounding errors. The fourth power of a motion over it stays
/// finite.
pub(crate) const SMALLEST_LENGTH: f64 = 1e-40;

/// Displacements over the innermost limit between which a step erases the memory.
const BLEND_RANGE: [f64; 2] = [2.5, 5.0];

/// The blend of the springs into gross slip in the direction of the motion.
struct GrossSlipBlend<T> {
    /// The part of the springs that ends in gross slip, 0 to 1.
    part: T,
    /// The direction of the motion.
    e: PerAxis<T>,
}

impl<T: Number> GrossSlipBlend<T> {
    /// The blend for a displacement, to which the part of the innermost spring is added that a falling load cuts off.
    fn new([before, now]: &[ScaledNormalState<T>; 2], displacement: PerAxis<T>, innermost: PerAxis<T>) -> Self {
        let limit = now.shift.map(at_least_smallest);
        let travel = by_axis(|axis| {
            let kept = limit[axis].quotient(before.shift[axis].max(limit[axis]));
            displacement[axis] + (T::constant(1.0) - kept) * innermost[axis]
        });
        let distance = length(by_axis(|axis| travel[axis].quotient(limit[axis])));
        let [begins, ends] = BLEND_RANGE;
        let x = ((distance - T::constant(begins)) * (1.0 / (ends - begins))).clamp_to_unit();
        let length = at_least_smallest(length(travel));
        GrossSlipBlend { part: x * x * (T::constant(3.0) - x * 2.0), e: travel.map(|travel| travel.quotient(length)) }
    }

    /// The displacement of a spring: v, but for the part that ends in gross slip, at its limit.
    fn of_spring(&self, axis: usize, v: T, limit: T) -> T {
        (T::constant(1.0) - self.part) * v + self.part * self.e[axis] * limit
    }
}

fn at_least_smallest<T: Number>(length: T) -> T {
    length.max(T::constant(SMALLEST_LENGTH))
}

/// A spring is released if its limit falls by more than this factor in the step.
const RELEASE_RATIO: f64 = 4.0;

/// The trial state of a spring whose limit falls by more than `RELEASE_RATIO` in the step, or to 0 if the edge passes
/// its node. It slips mostly on its own, before the others: only a share of the excess of its trial state over its
/// limit is left for the joint slip.
///
/// Not inlined, so that no other numbers are divided beside its quotients, see `numerics/guard.rs`.
#[inline(never)]
fn released<T: Number>(limit: PerAxis<T>, fall: T, trial: PerAxis<T>) -> PerAxis<T> {
    let length = length(by_axis(|axis| trial[axis].quotient(at_least_smallest(limit[axis]))));
    if length.value() <= 1.0 {
        return trial;
    }
    let share = (limit[0] * RELEASE_RATIO).quotient(at_least_smallest(limit[0] + fall)).clamp_to_unit();
    let scale = (T::constant(1.0) + share * (length - T::constant(1.0))).quotient(length);
    trial.map(|trial| trial * scale)
}

/// The spring at the edge after a step. It moves with the edge: under a rising load only that part of the old spring is
/// kept which is still at the edge.
#[inline(never)]
fn edge_spring<T: Number>(states: &[ScaledNormalState<T>; 2], displacement: PerAxis<T>, old: PerAxis<T>) -> PerAxis<T> {
    let [before, limit] = states.each_ref().map(|state| state.edge_limits().map(at_least_smallest));
    let ratio = by_axis(|axis| {
        let rise = states[1].shift[axis] - states[0].shift[axis];
        let part = limit[axis].quotient(limit[axis].max(rise));
        let kept = (limit[axis] - rise).quotient(before[axis]).clamp_to_unit();
        (kept * old[axis] + part * displacement[axis]).quotient(limit[axis])
    });
    let length = length(ratio);
    let slips = length.value() > LENGTH_SLIP_THRESHOLD;
    let scale = if slips { T::constant(1.0).quotient(length) } else { T::constant(1.0) };
    by_axis(|axis| limit[axis] * (scale * ratio[axis]))
}

/// The two stages of a step at which slip is found, in this order.
#[derive(Clone, Copy)]
pub(crate) enum Stage {
    Middle,
    End,
}

impl Stage {
    /// The value of this stage.
    pub fn pick<T>(self, [middle, end]: &[T; 2]) -> &T {
        match self {
            Stage::Middle => middle,
            Stage::End => end,
        }
    }
}

/// The data of a step: numbers with derivatives or without.
pub(crate) struct StepInput<T> {
    /// The normal states at the start and at the end.
    pub states: [ScaledNormalState<T>; 2],
    pub displacement: PerAxis<T>,
    pub old: Displacements<T>,
    /// The springs in use at the end of the step, and the limits and stiffnesses of all springs there, 0 for those that
    /// are not in use.
    pub used: Range<usize>,
    pub limits: PerSpring<T>,
    pub stiffness: PerSpring<T>,
    pub edge_stiffness: PerAxis<T>,
}

/// The springs after a step.
pub(crate) struct StepOutput<T> {
    pub springs: Displacements<T>,
    /// The force, which is not yet bounded.
    pub force: PerAxis<T>,
    /// The part of the springs that ends in gross slip.
    pub gross_slip: T,
}

impl<T: Number> StepInput<T> {
    /// The springs after the step. The function `slip` replaces a trial state of each stage by the springs after slip.
    pub fn advance(&self, mut slip: impl FnMut(Stage, &mut PerSpring<T>)) -> StepOutput<T> {
        let StepInput { states, displacement, old, limits, stiffness, .. } = self;
        let blend = GrossSlipBlend::new(states, *displacement, by_axis(|axis| old.v[axis][self.used.start]));
        let mut v = self.follow();
        self.release(&mut v);
        if blend.part.value() < 1.0 {
            update(&mut v, |axis, j, v| (old.v[axis][j] + v) * 0.5);
            slip(Stage::Middle, &mut v);
            update(&mut v, |axis, j, v| self.if_used(j, v * 2.0 - old.v[axis][j]));
            slip(Stage::End, &mut v);
        }
        let mut edge = edge_spring(states, *displacement, old.edge);
        if blend.part.value() > 0.0 {
            let edge_limits = states[1].edge_limits();
            update(&mut v, |axis, j, v| blend.of_spring(axis, v, limits[axis][j]));
            edge = by_axis(|axis| blend.of_spring(axis, edge[axis], edge_limits[axis]));
        }
        let force = by_axis(|axis| {
            let forces = stiffness[axis].iter().zip(v[axis]).map(|(stiffness, v)| *stiffness * v);
            forces.fold(self.edge_stiffness[axis] * edge[axis], |sum, force| sum + force)
        });
        StepOutput { springs: Displacements { v, edge }, force, gross_slip: blend.part }
    }

    /// The value of a spring if it is in use, 0 otherwise.
    fn if_used(&self, j: usize, value: T) -> T {
        if self.used.contains(&j) { value } else { T::constant(0.0) }
    }

    /// The springs if they follow the displacement. Those that a rising load engages follow the part (S_b - S_j)/ΔS_b
    /// of it.
    fn follow(&self) -> PerSpring<T> {
        let (one, mut v) = (T::constant(1.0), self.old.v);
        let rise = by_axis(|axis| self.states[1].shift[axis] - self.states[0].shift[axis]);
        let per_rise = rise.map(|rise| one.quotient(at_least_smallest(rise)));
        update(&mut v, |axis, j, v| {
            let part = if rise[axis].value() > 0.0 { (self.limits[axis][j] * per_rise[axis]).min(one) } else { one };
            self.if_used(j, v + part * self.displacement[axis])
        });
        v
    }

    /// Replaces the trial states of springs whose limits fall steeply, see [`released`].
    fn release(&self, trial: &mut PerSpring<T>) {
        let [before, now] = &self.states;
        let (fall, edge) = (before.shift[0] - now.shift[0], now.edge_limits());
        // Limits up to the size inside the edge vanish where a spring falls out of use.
        let limit = |j: usize| by_axis(|axis| self.limits[axis][j.min(SPRINGS - 1)] - edge[axis]);
        if fall.value() > (RELEASE_RATIO - 1.0) * limit(self.used.end.max(1) - 1)[0].value() {
            for j in self.used.start..self.used.end.min(SPRINGS) {
                [trial[0][j], trial[1][j]] = released(limit(j), fall, by_axis(|axis| trial[axis][j]));
            }
        }
    }
}

/// A step while it is computed, and what its derivatives and its energy need.
pub(crate) struct SolvedStep {
    /// The springs at the start, and as they would be if they followed the displacement without slip.
    pub old: Displacements,
    pub follow: PerSpring<f64>,
    /// The part of the springs that ends in gross slip.
    pub gross_slip: f64,
    /// The springs of the contact at the end and, if the load changes, in the middle.
    pub end_springs: Springs,
    middle_springs: Springs,
    /// The slip of both stages.
    pub slips: [Slip; 2],
    /// K of the last slip.
    metric: Metric,
}

impl SolvedStep {
    pub const ZERO: SolvedStep = SolvedStep {
        old: Displacements::ZERO,
        follow: [[0.0; SPRINGS]; 2],
        gross_slip: 0.0,
        end_springs: Springs::ZERO,
        middle_springs: Springs::ZERO,
        slips: [Slip::ZERO, Slip::ZERO],
        metric: Metric::ZERO,
    };

    /// Advances springs from one contact to another: the force, which is not yet bounded.
    #[inline(never)]
    pub fn advance(
        &mut self,
        nodes: &Nodes,
        [from, to]: [&LoadedContact; 2],
        path: &ContactPath,
        springs: &mut Displacements,
    ) -> PerAxis<f64> {
        if !path.constant_load || self.end_springs.shells.last != to.shells.last {
            self.end_springs.set(nodes, [&to.shells; 2]);
        }
        self.old = *springs;
        let input = StepInput {
            states: [from.normal, to.normal],
            displacement: path.displacement,
            old: *springs,
            used: to.shells.range(),
            limits: to.limits(nodes).map(|limits| limits.0),
            stiffness: self.end_springs.stiffness.map(|stiffness| stiffness.0),
            edge_stiffness: to.shells.edge_stiffness,
        };
        self.slips.iter_mut().for_each(|slip| slip.points.set = 0);
        let output = input.advance(|stage, v| {
            let (springs, load) = match stage {
                Stage::Middle if !path.constant_load => {
                    self.middle_springs.set(nodes, [&from.shells, &to.shells]);
                    (&self.middle_springs, Metric::NEVER_REUSED)
                }
                _ => (&self.end_springs, to.normal.load),
            };
            let slip = &mut self.slips[stage as usize];
            slip.find(&mut self.metric, springs, v.map(Lanes), load);
            *v = slip.points.v.map(|v| v.0);
        });
        (self.follow, self.gross_slip, *springs) = (input.follow(), output.gross_slip, output.springs);
        output.force
    }

    /// The springs of the contact at a stage.
    pub fn springs(&self, stage: Stage, path: &ContactPath) -> &Springs {
        match stage {
            Stage::Middle if !path.constant_load => &self.middle_springs,
            _ => &self.end_springs,
        }
    }
}

/// A spring slips if its length over its limit is more than this: one that is at its limit may exceed it by rounding.
pub(super) const LENGTH_SLIP_THRESHOLD: f64 = 1.0 + 1e-12;

/// Scales a force to Coulomb's bound if it exceeds an allowed factor times the bound. A factor slightly above 1 keeps
/// the tangent of a stuck contact whose force exceeds the bound by rounding. Not inlined, as [`released`].
#[inline(never)]
pub(crate) fn within_friction_limit<T: Number>(force: PerAxis<T>, bound: T, allowed: f64) -> PerAxis<T> {
    let length = length(force);
    let exceeds = length.value() > allowed * bound.value();
    if exceeds { force.map(|force| force * bound.quotient(length)) } else { force }
}
