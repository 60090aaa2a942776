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
use super::nodes::{FLAT_EDGE, Nodes, PerAxis, Row, SHIFT, SPRINGS, by_axis, length};
use super::shells::{Pressed, Shells, Springs};
use super::slip::{Metric, Slip, lanes_of, within};
use crate::numerics::guard::{TINY, quotient, root};
use crate::numerics::lanes::Lanes;

/// A contact under a load: its normal state, with derivatives by the normal component over its scale, and its shells.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LoadedContact {
    pub now: Pressed,
    pub slopes: Pressed,
    pub shells: Shells,
}

impl LoadedContact {
    /// A contact that is open.
    pub const OPEN: LoadedContact = LoadedContact { now: Pressed::NONE, slopes: Pressed::NONE, shells: Shells::NONE };

    pub fn new(nodes: &Nodes, [now, slopes]: &[Pressed; 2]) -> LoadedContact {
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
pub(crate) const LEAST: f64 = 1e-40;

/// Displacements over the innermost limit between which a step erases the memory.
const BLEND_RANGE: [f64; 2] = [2.5, 5.0];

/// How far a step slides: the displacement δ, and that part of the innermost spring which a falling load cuts off, over the innermost limit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GrossSlipBlend {
    /// The part of the springs that ends in gross slip, 0 to 1, and its derivative by the distance.
    pub part: f64,
    pub slope: f64,
    /// The part of the innermost spring that is cut off.
    pub cut: PerAxis<f64>,
    /// The distance over the limits, in both directions and its length; its direction, and 1 over its length \[in the unit of S\].
    pub ratio: PerAxis<f64>,
    pub distance: f64,
    pub e: PerAxis<f64>,
    pub per_length: f64,
}

impl GrossSlipBlend {
    fn new(to: &LoadedContact, motion: &SpringMotion, old: &Displacements) -> GrossSlipBlend {
        let (mut slide, mut cut, mut ratio) = (motion.displacement, [0.0; 2], [0.0; 2]);
        for axis in 0..2 {
            let limit = to.now.shift[axis].max(LEAST);
            cut[axis] =
                (1.0 - limit / motion.shift_before[axis].max(limit)) * f64::from(u8::from(!motion.constant_load));
            slide[axis] += cut[axis] * old.v[axis][to.shells.first.min(FLAT_EDGE)];
            ratio[axis] = slide[axis] / limit;
        }
        let distance = length(ratio);
        let per_length = 1.0 / length(slide).max(LEAST);
        let x = ((distance - BLEND_RANGE[0]) / (BLEND_RANGE[1] - BLEND_RANGE[0])).clamp(0.0, 1.0);
        let slope = 6.0 * x * (1.0 - x) / (BLEND_RANGE[1] - BLEND_RANGE[0]);
        let e = slide.map(|slide| slide * per_length);
        GrossSlipBlend { part: x * x * (3.0 - 2.0 * x), slope, cut, ratio, distance, e, per_length }
    }
}

/// The limit of a spring at the start over that at the end, from which on the spring is released in the step.
const LARGEST_FALL: f64 = 4.0;

/// A spring whose limit falls to a small part, and vanishes if the edge passes its node: it slips for the most part on its own, before the
/// others. Its trial state exceeds its limit by a part of the excess only, which is 0 if the spring is gone at the end.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Released {
    /// The trial state over the limit, and its length.
    pub ratio: PerAxis<f64>,
    pub length: f64,
    /// The part of the excess that is left, and the factor by which the trial state is reduced.
    pub part: f64,
    pub scale: f64,
}

impl Released {
    pub fn new(limit: PerAxis<f64>, fall: f64, trial: PerAxis<f64>) -> Released {
        let ratio = by_axis(|axis| trial[axis] / limit[axis].max(LEAST));
        let length = length(ratio);
        let part = (LARGEST_FALL * limit[0] / (limit[0] + fall).max(LEAST)).min(1.0);
        let scale = if length > 1.0 { (1.0 + part * (length - 1.0)) / length.max(1.0) } else { 1.0 };
        Released { ratio, length, part, scale }
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
    pub far: GrossSlipBlend,
    pub edge: EdgeSpring,
}

/// The spring at the edge: the parts of the displacement and of its old one that it follows and keeps, its trial displacement over its limit,
/// the length of this, and whether it slips.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EdgeSpring {
    pub part: PerAxis<f64>,
    pub kept: PerAxis<f64>,
    /// Its limit at the start.
    pub limit_before: PerAxis<f64>,
    pub ratio: PerAxis<f64>,
    pub length: f64,
    pub slips: bool,
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
            far: GrossSlipBlend {
                part: 0.0,
                slope: 0.0,
                cut: none,
                ratio: none,
                distance: 0.0,
                e: none,
                per_length: 0.0,
            },
            edge: EdgeSpring { part: none, kept: none, limit_before: none, ratio: none, length: 0.0, slips: false },
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
        derivatives: bool,
    ) -> PerAxis<f64> {
        if !motion.constant_load || self.springs.shells.last != to.shells.last {
            self.springs.set(nodes, [&to.shells; 2]);
        }
        self.old = *springs;
        self.far = GrossSlipBlend::new(to, motion, springs);
        self.stick(nodes, to, motion);
        if self.far.part < 1.0 {
            self.slip(nodes, [from, to], motion, derivatives);
        } else {
            (self.middle.points.set, self.end.points.set) = (0, 0);
        }
        let (mut force, rest) = ([0.0; 2], 1.0 - self.far.part);
        self.move_edge([from, to], motion, springs);
        for axis in 0..2 {
            springs.v[axis] = self.end.points.v[axis];
            if self.far.part > 0.0 {
                let gross_slip = self.far.part * self.far.e[axis] * to.limits(nodes)[axis];
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
                let parts = limits[axis] * (1.0 / rise.max(LEAST));
                self.parts[axis] = parts.map(|part| part.min(1.0));
            }
            self.trial[axis] = to.used() * (self.old.v[axis] + self.parts[axis] * motion.displacement[axis]);
        }
        let fall = motion.shift_before[0] - to.now.shift[0];
        if motion.constant_load || fall <= (LARGEST_FALL - 1.0) * limits[0][to.shells.last.min(SPRINGS - 1)] {
            return;
        }
        for j in to.shells.range() {
            let kept = Released::new([limits[0][j], limits[1][j]], fall, [self.trial[0][j], self.trial[1][j]]);
            for axis in 0..2 {
                self.trial[axis][j] *= kept.scale;
            }
        }
    }

    /// Slip in the middle and at the end.
    fn slip(&mut self, nodes: &Nodes, [from, to]: [&LoadedContact; 2], motion: &SpringMotion, derivatives: bool) {
        let half = by_axis(|axis| 0.5 * (self.old.v[axis] + self.trial[axis]));
        if motion.constant_load {
            self.middle.find(&mut self.metric, &self.springs, &half, to.now.load, derivatives);
        } else {
            self.between.set(nodes, [&from.shells, &to.shells]);
            self.middle.find(&mut self.metric, &self.between, &half, f64::NAN, derivatives);
        }
        let used = to.used();
        let beyond = by_axis(|axis| used * (2.0 * self.middle.points.v[axis] - self.old.v[axis]));
        self.end.find(&mut self.metric, &self.springs, &beyond, to.now.load, derivatives);
    }

    /// The spring at the edge is another one under another load: a rising load keeps that part of it which is still at the edge.
    fn move_edge(&mut self, [from, to]: [&LoadedContact; 2], motion: &SpringMotion, springs: &mut Displacements) {
        let [limit, before] = [to, from].map(|contact| contact.edge_limits().map(|limit| limit.max(LEAST)));
        for axis in 0..2 {
            let rise = to.now.shift[axis] - motion.shift_before[axis];
            self.edge.part[axis] = limit[axis] / rise.max(limit[axis]);
            self.edge.limit_before[axis] = before[axis];
            self.edge.kept[axis] = ((limit[axis] - rise) / self.edge.limit_before[axis]).clamp(0.0, 1.0);
            let old = self.edge.kept[axis] * self.old.edge[axis];
            self.edge.ratio[axis] = (old + self.edge.part[axis] * motion.displacement[axis]) / limit[axis];
        }
        self.edge.length = length(self.edge.ratio);
        self.edge.slips = self.edge.length > ROUNDING;
        let scale = (1.0 - self.far.part) / if self.edge.slips { self.edge.length } else { 1.0 };
        for axis in 0..2 {
            springs.edge[axis] = limit[axis] * (scale * self.edge.ratio[axis] + self.far.part * self.far.e[axis]);
        }
    }
}

/// The largest length of a state over its limit that sticks: one that has slipped may round.
pub(crate) const ROUNDING: f64 = 1.0 + 1e-12;

/// A force within Coulomb's bound.
pub(crate) fn within_friction_limit(force: PerAxis<f64>, bound: f64) -> PerAxis<f64> {
    let length = length(force);
    let scale = if length > bound { quotient(bound, length) } else { 1.0 };
    force.map(|force| force * scale)
}

/// Energy that the springs dissipate in a step, each from where its path leaves its limit.
///
/// The slip of a spring acts against the mean of two displacements, `k (v_c + v)·(v* - v)/2`. v_c is the first point of the straight path from
/// v_0 to v* with |v| = m l: the limit moves evenly from its value at the start to that at the end, and m = |v|/l at the end of the step, less
/// than 1 if neighbours turn the tractions. A spring that slips far slips in the direction of its end from the beginning.
#[inline(never)]
pub(crate) fn dissipated(
    nodes: &Nodes,
    [from, to]: [&LoadedContact; 2],
    motion: &SpringMotion,
    step: &StepWork,
    new: &Displacements,
) -> f64 {
    let mut energy = if to.now.shift[0] < from.now.shift[0] {
        separated(nodes, from, &to.now, motion.displacement, &step.old)
    } else {
        0.0
    };
    if step.middle.points.set != 0 || step.end.points.set != 0 || step.far.part > 0.0 {
        let limits = to.limits(nodes);
        let follow = by_axis(|axis| step.old.v[axis] + step.parts[axis] * motion.displacement[axis]);
        for j in to.shells.range() {
            let per_limit = by_axis(|axis| 1.0 / limits[axis][j].max(LEAST));
            let ratio = (motion.shift_before[0] - nodes[SHIFT][j]).max(0.0) * per_limit[0];
            let old = by_axis(|axis| step.old.v[axis][j] * per_limit[axis]);
            let trial = by_axis(|axis| follow[axis][j] * per_limit[axis]);
            let end = by_axis(|axis| new.v[axis][j] * per_limit[axis]);
            let (way, fall) = ([trial[0] - old[0], trial[1] - old[1]], ratio - 1.0);
            let m = end[0] * end[0] + end[1] * end[1];
            // |v|² = m² l² along the path: a quadratic equation.
            let part = first_exceedance(
                way[0] * way[0] + way[1] * way[1] - m * fall * fall,
                old[0] * way[0] + old[1] * way[1] + m * ratio * fall,
                old[0] * old[0] + old[1] * old[1] - m * ratio * ratio,
            );
            for axis in 0..2 {
                let v = new.v[axis][j];
                let leaves = step.old.v[axis][j] + part * (follow[axis][j] - step.old.v[axis][j]);
                let leaves = leaves + step.far.part * ((ratio - fall * part) * v - leaves);
                energy += 0.5 * step.springs.stiffness[axis][j] * (leaves + v) * (follow[axis][j] - v);
            }
        }
    }
    energy.max(0.0)
}

/// Energy of springs that lose contact in a step to a lower load: each slips from where it reaches its limit, which falls to 0 within the
/// part `limit/fall` of the motion, to nothing.
pub(crate) fn separated(
    nodes: &Nodes,
    from: &LoadedContact,
    now: &Pressed,
    displacement: PerAxis<f64>,
    old: &Displacements,
) -> f64 {
    let mut energy = 0.0;
    let fall = by_axis(|axis| from.now.shift[axis] - now.shift[axis]);
    let limits = from.limits(nodes);
    let stiffness = by_axis(|axis| from.shells.stiffness(axis, &quotient(1.0, from.shells.shift_step[axis])));
    for j in from.shells.range() {
        if now.load > 0.0 && nodes[SHIFT][j] < now.shift[0] {
            continue;
        }
        let limit = by_axis(|axis| limits[axis][j].max(LEAST));
        let rate = by_axis(|axis| limit[axis] / fall[axis].max(limit[axis]) * displacement[axis]);
        let v = by_axis(|axis| old.v[axis][j]);
        let (x, y, dx, dy) = (v[0] / limit[0], v[1] / limit[1], rate[0] / limit[0], rate[1] / limit[1]);
        let part = first_exceedance(dx * dx + dy * dy - 1.0, x * dx + y * dy + 1.0, x * x + y * y - 1.0);
        for axis in 0..2 {
            let leaves = v[axis] + part * rate[axis];
            energy += 0.5 * stiffness[axis][j] * leaves * ((1.0 - part) * rate[axis] + leaves);
        }
    }
    energy.max(0.0)
}

/// The first x in [0, 1] at which `a x² + 2 b x + c` becomes positive; 1 if there is none.
fn first_exceedance(a: f64, b: f64, c: f64) -> f64 {
    let root = root(b * b - a * c);
    // Quotients are at most 1 by their divisors: others may overflow.
    let fraction = |x: f64, divisor: f64| x.max(TINY) / divisor.max(x.max(TINY));
    let outwards = if c < 0.0 { fraction(-c, b + root) } else { 0.0 };
    let inwards = if a > 0.0 { fraction(root - b, a) } else { 1.0 };
    (if b >= 0.0 { outwards } else { inwards }).max(0.0)
}
