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

use super::matrix::dot;
use super::nodes::{Nodes, PerAxis, Row, SHIFT, SPRINGS, by_axis, length};
use super::shells::{ScaledNormalState, Shells, Springs};
use super::slip::{Metric, Slip, lanes_of, within};
use crate::numerics::guard::quotient;
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

    /// The limit of the spring at the edge.
    pub fn edge_limits(&self) -> PerAxis<f64> {
        by_axis(|axis| self.now.shift[axis] - self.now.inside_shift[axis])
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

/// A step, straight in S and in the displacement: S at the start, the displacement, and whether the load is that of the start.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SpringMotion {
    pub shift_before: PerAxis<f64>,
    pub displacement: PerAxis<f64>,
    pub constant_load: bool,
}

/// Limits and rises below this, in the unit of the springs, are rounding; fourth powers of a motion over it stay finite.
pub(crate) const SMALLEST_LENGTH: f64 = 1e-40;

/// Displacements over the innermost limit between which a step erases the memory.
const BLEND_RANGE: [f64; 2] = [2.5, 5.0];

/// Blend of the springs into gross slip, for a motion of several times the innermost limit: the displacement δ, and that part of the
/// innermost spring which a falling load cuts off.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GrossSlipBlend {
    /// The part of the springs that ends in gross slip, 0 to 1.
    pub part: f64,
    /// The derivative of this part by the distance.
    pub part_slope: f64,
    /// The part of the innermost spring that is cut off.
    pub cut: PerAxis<f64>,
    /// The motion over the limits, and the length of this: the distance.
    pub ratio: PerAxis<f64>,
    pub distance: f64,
    /// The direction of the motion, and 1 over its length \[in the unit of S\].
    pub e: PerAxis<f64>,
    pub per_length: f64,
}

impl GrossSlipBlend {
    fn new(to: &LoadedContact, motion: &SpringMotion, old: &Displacements) -> GrossSlipBlend {
        let (mut travel, mut cut, mut ratio) = (motion.displacement, [0.0; 2], [0.0; 2]);
        for axis in 0..2 {
            let limit = to.now.shift[axis].max(SMALLEST_LENGTH);
            cut[axis] =
                (1.0 - limit / motion.shift_before[axis].max(limit)) * f64::from(u8::from(!motion.constant_load));
            travel[axis] += cut[axis] * old.v[axis][to.shells.innermost()];
            ratio[axis] = travel[axis] / limit;
        }
        let distance = length(ratio);
        let per_length = 1.0 / length(travel).max(SMALLEST_LENGTH);
        let x = ((distance - BLEND_RANGE[0]) / (BLEND_RANGE[1] - BLEND_RANGE[0])).clamp(0.0, 1.0);
        let part_slope = 6.0 * x * (1.0 - x) / (BLEND_RANGE[1] - BLEND_RANGE[0]);
        let e = travel.map(|travel| travel * per_length);
        GrossSlipBlend { part: x * x * (3.0 - 2.0 * x), part_slope, cut, ratio, distance, e, per_length }
    }
}

/// A spring is released if its limit falls by more than this factor in the step.
const RELEASE_RATIO: f64 = 4.0;

/// A spring whose limit falls by more than `RELEASE_RATIO` in the step, or to 0 if the edge passes its node. It slips mostly on its own, before
/// the others: only `excess_share` of the excess of its trial state over its limit is left for the joint slip.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ReleasedSpring {
    /// The trial state over the limit, and its length.
    pub ratio: PerAxis<f64>,
    pub length: f64,
    /// The share of the excess that is left.
    pub excess_share: f64,
    /// The factor by which the trial state is reduced.
    pub scale: f64,
}

impl ReleasedSpring {
    /// Not inlined: the compiler would divide by what is beside its quotients in the vector registers of a caller, too.
    #[inline(never)]
    pub fn new(limit: PerAxis<f64>, fall: f64, trial: PerAxis<f64>) -> ReleasedSpring {
        let ratio = by_axis(|axis| trial[axis] / limit[axis].max(SMALLEST_LENGTH));
        let length = length(ratio);
        let excess_share = (RELEASE_RATIO * limit[0] / (limit[0] + fall).max(SMALLEST_LENGTH)).min(1.0);
        let scale = if length > 1.0 { (1.0 + excess_share * (length - 1.0)) / length.max(1.0) } else { 1.0 };
        ReleasedSpring { ratio, length, excess_share, scale }
    }
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
    pub blend: GrossSlipBlend,
    pub edge: EdgeSpring,
}

/// The spring at the edge: the parts of the displacement and of its old one that it follows and keeps, its trial displacement over its limit,
/// whether it slips, and the factor by which it is reduced then.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EdgeSpring {
    pub part: PerAxis<f64>,
    pub kept: PerAxis<f64>,
    /// The limit of the spring at the edge at the start.
    pub limit_before: PerAxis<f64>,
    pub ratio: PerAxis<f64>,
    pub slips: bool,
    pub scale: f64,
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
            blend: GrossSlipBlend {
                part: 0.0,
                part_slope: 0.0,
                cut: none,
                ratio: none,
                distance: 0.0,
                e: none,
                per_length: 0.0,
            },
            edge: EdgeSpring { part: none, kept: none, limit_before: none, ratio: none, slips: false, scale: 1.0 },
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
        self.blend = GrossSlipBlend::new(to, motion, springs);
        self.stick(nodes, to, motion);
        if self.blend.part < 1.0 {
            self.slip(nodes, [from, to], motion);
        } else {
            (self.middle.points.set, self.end.points.set) = (0, 0);
        }
        let (mut force, rest) = ([0.0; 2], 1.0 - self.blend.part);
        self.move_edge([from, to], motion, springs);
        for axis in 0..2 {
            springs.v[axis] = self.end.points.v[axis];
            if self.blend.part > 0.0 {
                let gross_slip = self.blend.part * self.blend.e[axis] * to.limits(nodes)[axis];
                springs.v[axis] = rest * self.end.points.v[axis] + gross_slip;
            }
            force[axis] = dot(&self.springs.stiffness[axis], &springs.v[axis])
                + to.shells.edge_stiffness[axis] * springs.edge[axis];
        }
        force
    }

    /// The trial state, in which nothing slips.
    fn stick(&mut self, nodes: &Nodes, to: &LoadedContact, motion: &SpringMotion) {
        let limits = to.limits(nodes);
        for axis in 0..2 {
            self.parts[axis] = Lanes([1.0; SPRINGS]);
            let rise = to.now.shift[axis] - motion.shift_before[axis];
            if !motion.constant_load && rise > 0.0 {
                let parts = limits[axis] * (1.0 / rise.max(SMALLEST_LENGTH));
                self.parts[axis] = parts.map(|part| part.min(1.0));
            }
            self.trial[axis] = to.used() * (self.old.v[axis] + self.parts[axis] * motion.displacement[axis]);
        }
        let fall = motion.shift_before[0] - to.now.shift[0];
        if motion.constant_load || fall <= (RELEASE_RATIO - 1.0) * limits[0][to.shells.last.min(SPRINGS - 1)] {
            return;
        }
        for j in to.shells.range() {
            let kept = ReleasedSpring::new([limits[0][j], limits[1][j]], fall, [self.trial[0][j], self.trial[1][j]]);
            for axis in 0..2 {
                self.trial[axis][j] *= kept.scale;
            }
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

    /// The spring at the edge is another one under another load: a rising load keeps that part of it which is still at the edge.
    fn move_edge(&mut self, [from, to]: [&LoadedContact; 2], motion: &SpringMotion, springs: &mut Displacements) {
        let [limit, before] = [to, from].map(|contact| contact.edge_limits().map(|limit| limit.max(SMALLEST_LENGTH)));
        for axis in 0..2 {
            let rise = to.now.shift[axis] - motion.shift_before[axis];
            self.edge.part[axis] = limit[axis] / rise.max(limit[axis]);
            self.edge.limit_before[axis] = before[axis];
            self.edge.kept[axis] = ((limit[axis] - rise) / self.edge.limit_before[axis]).clamp(0.0, 1.0);
            let old = self.edge.kept[axis] * self.old.edge[axis];
            self.edge.ratio[axis] = (old + self.edge.part[axis] * motion.displacement[axis]) / limit[axis];
        }
        let length = length(self.edge.ratio);
        self.edge.slips = length > LENGTH_SLIP_THRESHOLD;
        self.edge.scale = if self.edge.slips { 1.0 / length.max(1.0) } else { 1.0 };
        let scale = (1.0 - self.blend.part) * self.edge.scale;
        for axis in 0..2 {
            springs.edge[axis] = limit[axis] * (scale * self.edge.ratio[axis] + self.blend.part * self.blend.e[axis]);
        }
    }
}

/// The largest length of a state over its limit that sticks: one that has slipped may round.
pub(crate) const LENGTH_SLIP_THRESHOLD: f64 = 1.0 + 1e-12;

/// A force within Coulomb's bound.
pub(crate) fn within_friction_limit(force: PerAxis<f64>, bound: f64) -> PerAxis<f64> {
    match per_length_beyond(force, bound) {
        Some(per_length) => force.map(|force| force * (bound * per_length)),
        None => force,
    }
}

/// 1 over the length of a force that exceeds a bound. Not inlined, as [`ReleasedSpring::new`].
#[inline(never)]
pub(crate) fn per_length_beyond(force: PerAxis<f64>, bound: f64) -> Option<f64> {
    let length = length(force);
    (length > bound).then(|| quotient(1.0, length))
}
