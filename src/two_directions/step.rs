//! A step of a contact that is closed at its end.
//!
//! The springs first stick: they follow the displacement δ, those that a rising load engages in the step the part `(S_b - S_j)/ΔS_b` of it.
//! Slip is found twice, so that it has the direction of the middle of the step and not of its end:
//!
//! 1. in the middle, `v_m` from `(v_0 + v*)/2`, with the shells of the middle;
//! 2. at the end, `v_1` from `2 v_m - v_0`, where the tractions exceed their bound to second order only.
//!
//! On a straight path that is exact. A displacement of several times the innermost limit erases the memory: the springs end in gross slip in
//! its direction, `v_j = (S_b - S_j) δ/|δ|`.
//!
//! The edge spring is one more spring from a size just inside the edge on, on its own: it makes the stuck stiffness that of the contact.
//!
//! The bounds beside the points are formulas of any number. With numbers that carry derivatives they are their own tangent.

use super::matrix::dot;
use super::nodes::{Nodes, PerAxis, Row, SHIFT, SPRINGS, by_axis};
use super::shells::{ScaledNormalState, Shells, Springs};
use super::slip::{Metric, Slip, lanes_of, within};
use crate::numerics::dual::Number;
use crate::numerics::lanes::Lanes;

/// A contact under a load, by default open: its normal state, with derivatives by the normal component over its scale, and its shells.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct LoadedContact {
    pub now: ScaledNormalState,
    pub slopes: ScaledNormalState,
    pub shells: Shells,
}

impl LoadedContact {
    pub fn new(nodes: &Nodes, [now, slopes]: &[ScaledNormalState; 2]) -> LoadedContact {
        LoadedContact { now: *now, slopes: *slopes, shells: Shells::new(nodes, now) }
    }

    /// The limits S_b - S_j of the springs, 0 beyond the edge.
    pub fn limits(&self, nodes: &Nodes) -> PerAxis<Row> {
        by_axis(|axis| self.used() * (self.now.shift[axis] - Lanes(nodes[SHIFT + axis])))
    }

    /// 1 for the springs in use, 0 for others.
    pub fn used(&self) -> Row {
        lanes_of(within([self.shells.first, self.shells.last + 1]))
    }
}

/// The springs: displacements, and those of the spring at the edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Displacements {
    pub v: PerAxis<Row>,
    pub edge: PerAxis<f64>,
}

impl Displacements {
    pub const NONE: Displacements = Displacements { v: [Row::ZERO; 2], edge: [0.0; 2] };
}

/// A step, straight in S and in the displacement: the displacement, and whether the load is that of the start.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SpringMotion {
    pub displacement: PerAxis<f64>,
    pub constant_load: bool,
}

/// Limits and rises below this, in the unit of the springs, are rounding; fourth powers of a motion over it stay finite.
pub(crate) const SMALLEST_LENGTH: f64 = 1e-40;

/// Displacements over the innermost limit between which a step erases the memory.
const BLEND_RANGE: [f64; 2] = [2.5, 5.0];

/// Blend of the springs into gross slip.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GrossSlipBlend<T> {
    /// The part of the springs that ends in gross slip, 0 to 1.
    pub part: T,
    /// The direction of the motion.
    e: PerAxis<T>,
}

impl<T: Number> GrossSlipBlend<T> {
    /// The blend for a displacement, to which the part of the innermost spring is added that a falling load cuts off.
    pub fn new(
        [before, now]: [&ScaledNormalState<T>; 2],
        displacement: &PerAxis<T>,
        innermost: PerAxis<T>,
    ) -> GrossSlipBlend<T> {
        let limit = now.shift.map(at_least_smallest);
        let travel = by_axis(|axis| {
            let cut = T::constant(1.0) - limit[axis].quotient(before.shift[axis].or_larger(limit[axis]));
            displacement[axis] + cut * innermost[axis]
        });
        let distance = length_of(by_axis(|axis| travel[axis].quotient(limit[axis])));
        let x =
            ((distance - T::constant(BLEND_RANGE[0])) * T::constant(1.0 / (BLEND_RANGE[1] - BLEND_RANGE[0]))).share();
        let length = at_least_smallest(length_of(travel));
        let part = x * x * (T::constant(3.0) - T::constant(2.0) * x);
        GrossSlipBlend { part, e: travel.map(|travel| travel.quotient(length)) }
    }

    /// A spring of a limit: v, but for the part that ends in gross slip.
    pub fn of_spring(&self, axis: usize, v: T, limit: T) -> T {
        (T::constant(1.0) - self.part) * v + self.part * self.e[axis] * limit
    }
}

fn at_least_smallest<T: Number>(length: T) -> T {
    length.or_larger(T::constant(SMALLEST_LENGTH))
}

/// The length of a vector of numbers with derivatives.
fn length_of<T: Number>([x, y]: PerAxis<T>) -> T {
    (x * x + y * y).root()
}

/// A spring is released if its limit falls by more than this factor in the step.
const RELEASE_RATIO: f64 = 4.0;

/// The trial state of a spring whose limit falls by more than `RELEASE_RATIO` in the step, or to 0 if the edge passes its node. It slips mostly on
/// its own, before the others: only a share of the excess of its trial state over its limit is left for the joint slip.
///
/// Not inlined: the compiler would divide by what is beside its quotients in the vector registers of a caller, too.
#[inline(never)]
pub(crate) fn released<T: Number>(limit: PerAxis<T>, fall: T, trial: PerAxis<T>) -> PerAxis<T> {
    let length = length_of(by_axis(|axis| trial[axis].quotient(at_least_smallest(limit[axis]))));
    if length.value() <= 1.0 {
        return trial;
    }
    let share = (T::constant(RELEASE_RATIO) * limit[0]).quotient(at_least_smallest(limit[0] + fall)).share();
    let scale = (T::constant(1.0) + share * (length - T::constant(1.0))).quotient(length);
    trial.map(|trial| trial * scale)
}

/// The spring at the edge after a step. It moves with the edge: under a rising load only that part of the old spring is kept which is still at
/// the edge.
#[inline(never)]
pub(crate) fn edge_spring<T: Number>(
    states: [&ScaledNormalState<T>; 2],
    displacement: &PerAxis<T>,
    old: PerAxis<T>,
) -> PerAxis<T> {
    let [before, limit] = states.map(|state| state.edge_limits().map(at_least_smallest));
    let ratio = by_axis(|axis| {
        let rise = states[1].shift[axis] - states[0].shift[axis];
        let part = limit[axis].quotient(limit[axis].or_larger(rise));
        let kept = (limit[axis] - rise).quotient(before[axis]).share();
        (kept * old[axis] + part * displacement[axis]).quotient(limit[axis])
    });
    let length = length_of(ratio);
    let scale =
        if length.value() > LENGTH_SLIP_THRESHOLD { T::constant(1.0).quotient(length) } else { T::constant(1.0) };
    by_axis(|axis| limit[axis] * (scale * ratio[axis]))
}

/// A step while it is computed, and what its derivatives and its energy need.
pub(crate) struct StepWork {
    /// The springs at the start and in the trial state, and the parts of the displacement that they follow.
    pub old: Displacements,
    pub trial: PerAxis<Row>,
    pub parts: PerAxis<Row>,
    /// The springs of the contact at the end, and of that in the middle if the load changes.
    pub springs: Springs,
    pub between: Springs,
    pub middle: Slip,
    pub end: Slip,
    /// K of the last slip.
    metric: Metric,
    pub blend: GrossSlipBlend<f64>,
    /// The spring at the edge, but for the part that ends in gross slip.
    pub edge: PerAxis<f64>,
}

impl StepWork {
    pub const NONE: StepWork = {
        let (none, rows) = ([0.0; 2], [Row::ZERO; 2]);
        StepWork {
            old: Displacements::NONE,
            trial: rows,
            parts: rows,
            springs: Springs::NONE,
            between: Springs::NONE,
            middle: Slip::NONE,
            end: Slip::NONE,
            metric: Metric::NONE,
            blend: GrossSlipBlend { part: 0.0, e: none },
            edge: none,
        }
    };

    /// Advances springs; the force, which is not yet bounded.
    #[inline(never)]
    pub fn advance(
        &mut self,
        nodes: &Nodes,
        [from, to]: [&LoadedContact; 2],
        motion: &SpringMotion,
        springs: &mut Displacements,
    ) -> PerAxis<f64> {
        if !motion.constant_load || self.springs.shells.last != to.shells.last {
            self.springs.set(nodes, [&to.shells; 2]);
        }
        self.old = *springs;
        let first = to.shells.innermost();
        let states = [&from.now, &to.now];
        self.blend = GrossSlipBlend::new(states, &motion.displacement, by_axis(|axis| springs.v[axis][first]));
        self.stick(nodes, [from, to], motion);
        if self.blend.part < 1.0 {
            self.slip(nodes, [from, to], motion);
        } else {
            (self.middle.points.set, self.end.points.set) = (0, 0);
        }
        self.edge = edge_spring(states, &motion.displacement, springs.edge);
        (springs.v, springs.edge) = (self.end.points.v, self.edge);
        if self.blend.part > 0.0 {
            let (limits, edge_limits) = (to.limits(nodes), to.now.edge_limits());
            for axis in 0..2 {
                for j in 0..SPRINGS {
                    springs.v[axis][j] = self.blend.of_spring(axis, springs.v[axis][j], limits[axis][j]);
                }
                springs.edge[axis] = self.blend.of_spring(axis, springs.edge[axis], edge_limits[axis]);
            }
        }
        by_axis(|axis| {
            dot(&self.springs.stiffness[axis], &springs.v[axis]) + to.shells.edge_stiffness[axis] * springs.edge[axis]
        })
    }

    /// The trial state, in which nothing slips.
    fn stick(&mut self, nodes: &Nodes, [from, to]: [&LoadedContact; 2], motion: &SpringMotion) {
        let limits = to.limits(nodes);
        for axis in 0..2 {
            self.parts[axis] = Lanes([1.0; SPRINGS]);
            let rise = to.now.shift[axis] - from.now.shift[axis];
            if !motion.constant_load && rise > 0.0 {
                let parts = limits[axis] * (1.0 / rise.max(SMALLEST_LENGTH));
                self.parts[axis] = parts.map(|part| part.min(1.0));
            }
            self.trial[axis] = to.used() * (self.old.v[axis] + self.parts[axis] * motion.displacement[axis]);
        }
        let fall = from.now.shift[0] - to.now.shift[0];
        if !releases(fall, limits[0][to.shells.last.min(SPRINGS - 1)]) {
            return;
        }
        for j in to.shells.range() {
            let [x, y] = by_axis(|axis| [limits[axis][j], self.trial[axis][j]]);
            [self.trial[0][j], self.trial[1][j]] = released([x[0], y[0]], fall, [x[1], y[1]]);
        }
    }

    /// Slip in the middle and at the end.
    fn slip(&mut self, nodes: &Nodes, [from, to]: [&LoadedContact; 2], motion: &SpringMotion) {
        let half = self.middle_trial();
        if motion.constant_load {
            self.middle.find(&mut self.metric, &self.springs, &half, to.now.load);
        } else {
            self.between.set(nodes, [&from.shells, &to.shells]);
            self.middle.find(&mut self.metric, &self.between, &half, Metric::NEVER_REUSED);
        }
        let beyond = self.end_trial(to);
        self.end.find(&mut self.metric, &self.springs, &beyond, to.now.load);
    }

    /// The springs of the contact in the middle of a step.
    pub fn middle_springs(&self, motion: &SpringMotion) -> &Springs {
        if motion.constant_load { &self.springs } else { &self.between }
    }

    /// The trial state of the slip in the middle: half of the step.
    pub fn middle_trial(&self) -> PerAxis<Row> {
        by_axis(|axis| 0.5 * (self.old.v[axis] + self.trial[axis]))
    }

    /// The trial state of the slip at the end: as far from the middle as the start.
    pub fn end_trial(&self, to: &LoadedContact) -> PerAxis<Row> {
        let used = to.used();
        by_axis(|axis| used * (2.0 * self.middle.points.v[axis] - self.old.v[axis]))
    }
}

/// Whether a load whose S falls by so much may release springs, the outermost of which has this limit.
pub(crate) fn releases(fall: f64, outermost: f64) -> bool {
    fall > (RELEASE_RATIO - 1.0) * outermost
}

/// A spring slips if its length over its limit is more than this: one that is at its limit may exceed it by rounding.
pub(crate) const LENGTH_SLIP_THRESHOLD: f64 = 1.0 + 1e-12;

/// Scales a force to Coulomb's bound if it exceeds an allowed factor times the bound. A factor slightly above 1 keeps the tangent of a stuck
/// contact whose force exceeds the bound by rounding. Not inlined, as [`released`].
#[inline(never)]
pub(crate) fn within_friction_limit<T: Number>(force: PerAxis<T>, bound: T, allowed: f64) -> PerAxis<T> {
    let length = length_of(force);
    let exceeds = length.value() > allowed * bound.value();
    if exceeds { force.map(|force| force * bound.quotient(length)) } else { force }
}
