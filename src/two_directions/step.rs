//! A step of a closed contact in both directions.
//!
//! The springs stick at first; a load that rises engages new ones, which follow the part of the motion from there on. If the
//! traction at no point then exceeds the pressure, this is the end of the step; otherwise the points slip. All in the units of the springs.

use super::edge::Edge;
use super::energy;
use super::fine;
use super::slip::{Guess, LARGEST_TURN, LOST, Problem, Set, Slip};
use super::spring_state::SpringState;
use super::springs::{Both, Fine, Increment, PARTS, Row, Springs, dot, largest, total, used};
use crate::shape::TINY;
use crate::simd::dispatch;

/// Excess of the square of a traction over that of its limit by which a state that has slipped may round: it sticks.
pub(crate) const ROUNDING: f64 = 1e-14;
/// |r|² from which on a point has slipped before.
pub(crate) const SLIPPED: f64 = 1.0 - 1e-9;

/// Cosine of the angle between the tractions before and of the trial state up to which the one before is the first guess.
const NEAR: f64 = 0.5;
/// Steps in which β grows.
const PARTS_OF_BETA: u8 = 8;
/// Cosine of the angle between a motion and a traction from which on a point turns back.
const BACKWARDS: f64 = 0.6;

/// What a step leads through.
#[repr(align(32))]
pub(crate) struct StepRecord<const N: usize> {
    /// Distances S_b - S_j, the parts of the motion that the springs follow, and the trial state; 1, 1 and 0 outside.
    pub limit: Both<Row<N>>,
    pub part: Both<Row<N>>,
    pub trial: Both<Row<N>>,
    /// Stiffnesses.
    pub stiffness: Both<Row<N>>,
    /// τ, and r at the start.
    pub overshoot: Row<N>,
    pub start: Both<Row<N>>,
    pub slip: Slip<N>,
    /// Factors by which the fine springs return to their limits.
    pub fine_scale: Fine<N>,
    /// The last shell at the start, and its part.
    pub last_before: usize,
    pub part_before: usize,
    /// Whether any point slips.
    pub slips: bool,
    /// Sum of the forces of the springs, before Coulomb's bound.
    pub sum: Both<f64>,
}

impl<const N: usize> StepRecord<N> {
    pub const NONE: StepRecord<N> = StepRecord {
        limit: [[1.0; N]; 2],
        part: [[1.0; N]; 2],
        trial: [[0.0; N]; 2],
        stiffness: [[0.0; N]; 2],
        overshoot: [0.0; N],
        start: [[0.0; N]; 2],
        slip: Slip::NONE,
        fine_scale: [[1.0; N]; PARTS],
        last_before: 0,
        part_before: 0,
        slips: false,
        sum: [0.0; 2],
    };

    /// Points that slip, found by Newton's method.
    #[inline(always)]
    pub fn slipping(&self) -> u32 {
        if self.slips && self.slip.converged { self.slip.set } else { 0 }
    }
}

/// Force and dissipated energy.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Outcome {
    pub force: Both<f64>,
    pub dissipated: f64,
}

/// Advances the state. Requested are the energy, and what the derivatives of the step need.
#[inline(always)]
pub(crate) fn step<const N: usize>(
    springs: &Springs,
    state: &mut SpringState<N>,
    motion: &Increment,
    requested: [bool; 2],
    record: &mut StepRecord<N>,
) -> Outcome {
    dispatch!(kernel(springs, state, motion, requested, record))
}

#[inline(always)]
fn kernel<const N: usize>(
    springs: &Springs,
    state: &mut SpringState<N>,
    motion: &Increment,
    [energy, derivatives]: [bool; 2],
    record: &mut StepRecord<N>,
) -> Outcome {
    let Increment { before, now, by, constant_load, .. } = motion;
    // Of springs that lose contact, before the edge is replaced.
    let mut dissipated =
        if energy && now.shift[0] < before.shift[0] { separated(springs, state, motion, false) } else { 0.0 };
    (record.last_before, record.part_before) = (state.edge.last, state.edge.part);
    if !constant_load {
        state.edge = Edge::new(springs, now);
    }
    let SpringState { v, tractions, edge, .. } = state;
    let last = edge.last.min(N - 1);
    let old = *v;
    let [mut limit_x, mut limit_y] = [[1.0; N]; 2];
    for j in 0..N {
        let inside = j <= last;
        limit_x[j] = if inside { now.shift[0] - springs.shift[0][j] } else { 1.0 };
        limit_y[j] = if inside { now.shift[1] - springs.shift[1][j] } else { 1.0 };
        let [x, y] = motion.share(limit_x[j], limit_y[j]);
        (record.part[0][j], record.part[1][j]) = (x, y);
        record.trial[0][j] = if inside { old[0][j] + by[0] * x } else { 0.0 };
        record.trial[1][j] = if inside { old[1][j] + by[1] * y } else { 0.0 };
    }
    record.limit = [limit_x, limit_y];
    let before_start = core::mem::replace(&mut record.start, *tractions);
    let mut q = [[0.0; N]; 2];
    for k in 0..2 {
        record.stiffness[k] = edge.stiffnesses(springs, k);
        if *constant_load {
            let per_step = by[k] / edge.step[k];
            for i in 0..N {
                q[k][i] = tractions[k][i] * edge.pressure[i] + edge.reach[i] * per_step;
            }
        } else {
            q[k] = edge.tractions(springs, k, &record.trial[k]);
        }
    }
    let mut beyond = [0.0; N];
    for i in 0..N {
        let p = edge.pressure[i];
        beyond[i] = q[0][i] * q[0][i] + q[1][i] * q[1][i] - p * p * (1.0 + ROUNDING);
    }
    record.slips = largest(&beyond) > 0.0;
    let mut end = record.trial;
    let slips = record.slips;
    if slips {
        slide(springs, edge, [&q[0], &q[1]], &before_start, by, &beyond, derivatives, record, &mut end);
        let every_point = record.slip.converged && record.slip.first == 0 && record.slip.count == 0;
        if !every_point {
            q = [edge.tractions(springs, 0, &end[0]), edge.tractions(springs, 1, &end[1])];
        }
        if energy {
            let loss = if *constant_load && record.slip.converged {
                pointwise(springs, edge, record)
            } else {
                of_springs(springs, last, record, motion, &old, &end)
            };
            dissipated += loss;
        }
    }
    // Tractions over the pressure, at most 1.
    let slipping = record.slipping();
    let mut r = [[0.0; N]; 2];
    for i in 0..N {
        let (x, y, p) = (q[0][i], q[1][i], edge.pressure[i]);
        let square = x * x + y * y;
        let bound = if square > p * p { square } else { p * p };
        let scale = if i <= last { 1.0 / bound.sqrt() } else { 0.0 };
        (r[0][i], r[1][i]) = (x * scale, y * scale);
    }
    if slipping != 0 {
        for k in 0..2 {
            for i in 0..N {
                r[k][i] = if record.slip.slips[i] > 0.0 { record.slip.e[k][i] } else { r[k][i] };
            }
        }
    }
    (*tractions, *v) = (r, end);
    let (addition, loss) = fine::step(springs, edge, &mut state.fine, motion, energy, &mut record.fine_scale);
    let sum = [dot(&record.stiffness[0], &end[0]) + addition[0], dot(&record.stiffness[1], &end[1]) + addition[1]];
    let over = ((sum[0] * sum[0] + sum[1] * sum[1]).sqrt() / now.load).max(1.0);
    record.sum = sum;
    Outcome { force: [sum[0] / over, sum[1] / over], dissipated: (dissipated + loss).max(0.0) }
}

/// The slip from a trial state that exceeds Coulomb's bound.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "parts of one step")]
fn slide<const N: usize>(
    springs: &Springs,
    edge: &Edge<N>,
    q: [&Row<N>; 2],
    before_start: &Both<Row<N>>,
    by: &Both<f64>,
    beyond: &Row<N>,
    derivatives: bool,
    record: &mut StepRecord<N>,
    end: &mut Both<Row<N>>,
) {
    let StepRecord { limit, trial, overshoot, start, slip, stiffness, .. } = record;
    let last = edge.last.min(N - 1);
    let ([mut trial_x, mut trial_y], [mut e_x, mut e_y]) = ([[0.0; N]; 2], [[0.0; N]; 2]);
    let (mut over, mut continues) = ([0.0; N], [0.0; N]);
    let backwards = -BACKWARDS * (by[0] * by[0] + by[1] * by[1]).sqrt();
    for i in 0..N {
        let (x, y) = (trial[0][i] / limit[0][i], trial[1][i] / limit[1][i]);
        let square = x * x + y * y;
        let outside = square > 1.0;
        let (x, y) = if outside { (x, y) } else { (q[0][i], q[1][i]) };
        let square = x * x + y * y;
        let length = (if square > TINY { square } else { TINY }).sqrt();
        let (x, y) = (x / length, y / length);
        over[i] = if outside { length - 1.0 } else { 0.0 };
        (trial_x[i], trial_y[i]) = (x, y);
        let (r_x, r_y) = (start[0][i], start[1][i]);
        let slipped = r_x * r_x + r_y * r_y > SLIPPED;
        let near = slipped && x * r_x + y * r_y > NEAR;
        // A point that slipped in the step before as well turns on.
        let (b_x, b_y) = (before_start[0][i], before_start[1][i]);
        let (cosine, sine) = (b_x * r_x + b_y * r_y, b_x * r_y - b_y * r_x);
        let square = cosine * cosine + sine * sine;
        let turns = square > SLIPPED && cosine > NEAR;
        let (cosine, sine) = if turns { (cosine, sine) } else { (1.0, 0.0) };
        let length = (if turns { square } else { 1.0 }).sqrt();
        let (on_x, on_y) = ((cosine * r_x - sine * r_y) / length, (cosine * r_y + sine * r_x) / length);
        (e_x[i], e_y[i]) = (if near { on_x } else { x }, if near { on_y } else { y });
        continues[i] = if slipped && r_x * by[0] + r_y * by[1] > backwards { 1.0 } else { 0.0 };
    }
    *overshoot = over;
    let (mut outside, mut set) = (0, 0);
    for i in (0..=last).rev() {
        let is_outside = over[i] > 0.0 || beyond[i] > 0.0;
        outside |= Set::from(is_outside) << i;
        // A point that slipped before continues if the next one outside does.
        let outer = set >> (i + 1) & 1 == 1;
        set |= Set::from(is_outside || (outer && continues[i] > 0.0)) << i;
    }
    let problem = Problem { springs, edge, stiffness, trial, start, overshoot };
    // A contact that slips on hardly turns; otherwise slip begins from the trial state.
    let from_start = Guess { e: [e_x, e_y], set, largest_turn: LARGEST_TURN, bends: 1.0 };
    let from_trial = Guess { e: [trial_x, trial_y], set: outside, largest_turn: LOST, bends: 1.0 };
    for guess in [from_start, from_trial] {
        slip.solve(&problem, &guess, derivatives, end);
        if slip.converged {
            return;
        }
    }
    // Where neither converges, once in 2e5 steps of random motions, β grows from 0, a convex problem.
    let mut guess = from_trial;
    for part in 0..=PARTS_OF_BETA {
        guess.bends = f64::from(part) / f64::from(PARTS_OF_BETA);
        slip.solve(&problem, &guess, derivatives, end);
        if !slip.converged {
            break;
        }
        (guess.e, guess.set) = (slip.e, slip.set);
    }
    if !slip.converged {
        // Never seen in 6e6 steps of random motions: each spring returns to its own limit.
        for k in 0..2 {
            for j in 0..N {
                end[k][j] = trial[k][j] / (1.0 + overshoot[j]);
            }
        }
    }
}

/// Energy dissipated at constant load: at each point the slip times the mean of the traction where its path leaves Coulomb's disc and at
/// the end.
#[inline(always)]
fn pointwise<const N: usize>(springs: &Springs, edge: &Edge<N>, record: &StepRecord<N>) -> f64 {
    let StepRecord { slip, start, stiffness, .. } = record;
    let last = edge.last.min(N - 1);
    // Σ C_ij²/w_j, the traction that a unit of slip at the point alone relaxes.
    let mut relaxed = [[0.0; N]; 2];
    for k in 0..2 {
        let (mut sum, mut before) = ([0.0; N], [0.0; N]);
        for j in slip.first..=last {
            let fixed = j < last;
            let row = if fixed { used(&springs.traction[j]) } else { &edge.reach };
            let per_step = if fixed { springs.per_step[k][j] } else { 1.0 / edge.step[k] };
            let per_stiffness = 1.0 / stiffness[k][j];
            for i in 0..N {
                let now = row[i] * per_step;
                let entry = if i <= j { now - before[i] } else { 0.0 };
                sum[i] += entry * entry * per_stiffness;
                before[i] = now;
            }
        }
        relaxed[k] = sum;
    }
    let mut energy = [0.0; N];
    for i in 0..N {
        let p = edge.pressure[i];
        let (s_x, s_y) = (slip.sigma[0][i], slip.sigma[1][i]);
        let (r_x, r_y) = (start[0][i] * p, start[1][i] * p);
        let (q_x, q_y) = (slip.e[0][i] * p, slip.e[1][i] * p);
        let (g_x, g_y) = (q_x + relaxed[0][i] * s_x - r_x, q_y + relaxed[1][i] * s_y - r_y);
        let inside = r_x * r_x + r_y * r_y - p * p;
        let inside = if inside < 0.0 { inside } else { 0.0 };
        let part = energy::exit(g_x * g_x + g_y * g_y, r_x * g_x + r_y * g_y, inside);
        let work = 0.5 * (s_x * (r_x + part * g_x + q_x) + s_y * (r_y + part * g_y + q_y));
        energy[i] = if slip.slips[i] > 0.0 && work > 0.0 { work } else { 0.0 };
    }
    total(&energy)
}

/// Energy dissipated by the springs under a load that changes.
#[inline(always)]
fn of_springs<const N: usize>(
    springs: &Springs,
    last: usize,
    record: &StepRecord<N>,
    motion: &Increment,
    old: &Both<Row<N>>,
    end: &Both<Row<N>>,
) -> f64 {
    let StepRecord { limit, trial, start, slip, stiffness, .. } = record;
    let mut energy = [0.0; N];
    let converged = if slip.converged { 1.0 } else { 0.0 };
    for j in 0..N {
        let inside = j <= last;
        let before = motion.before.shift[0] - springs.shift[0][j];
        let before = if inside && before > 0.0 { before } else { 0.0 };
        let old = [if inside { old[0][j] } else { 0.0 }, if inside { old[1][j] } else { 0.0 }];
        let (w, trial) = ([stiffness[0][j], stiffness[1][j]], [trial[0][j], trial[1][j]]);
        let along = slip.e[0][j] * start[0][j] + slip.e[1][j] * start[1][j];
        let beta = if along > 0.0 { slip.per_along[j] * along * slip.slips[j] * converged } else { 0.0 };
        let places = [old, trial, [end[0][j], end[1][j]]];
        energy[j] = energy::slipped(w, places, [limit[0][j], limit[1][j]], before, 1.0 - beta);
    }
    total(&energy).max(0.0)
}

/// Energy of the springs of the law and of the fine correction that lose contact in a step: all if it opens.
#[inline(never)]
pub(crate) fn separated<const N: usize>(
    springs: &Springs,
    state: &SpringState<N>,
    motion: &Increment,
    opens: bool,
) -> f64 {
    let Increment { before, now, by, .. } = motion;
    let edge = &state.edge;
    let outer = edge.last.min(N - 1);
    let last = if opens { 0 } else { springs.last_shell::<N>(now.shift[0]).min(outer) };
    let part = if opens { 0 } else { springs.last_part(last, now.shift[0]) };
    let fall = [before.shift[0] - now.shift[0], before.shift[1] - now.shift[1]];
    let mut energy = 0.0;
    for j in last..=outer {
        for r in 0..PARTS {
            if (!opens && j == last && r <= part) || (j == outer && r > edge.part) {
                continue;
            }
            let (mut limit, mut w, mut fine) = ([0.0; 2], edge.stiffness, [0.0; 2]);
            for k in 0..2 {
                limit[k] = (before.shift[k] - springs.fine_shift[k][r][j]).max(TINY);
                let inner = j < outer;
                w[k] = if inner { springs.stiffness[k][j] } else { w[k] };
                fine[k] = if inner { springs.fine_stiffness[k][r][j] } else { edge.fine_stiffness[k][r] };
            }
            if r == 0 {
                energy += energy::lost(w, [state.v[0][j], state.v[1][j]], limit, fall, *by);
            }
            if j >= springs.under_flat {
                energy += energy::lost(fine, [state.fine[0][r][j], state.fine[1][r][j]], limit, fall, *by);
            }
        }
    }
    energy.max(0.0)
}
