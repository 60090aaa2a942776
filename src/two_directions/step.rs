//! A step of a closed contact in both directions.
//!
//! The springs stick at first; a load that rises engages new ones, which follow the part of the motion from there on. If the traction at no point then
//! exceeds the pressure, this is the end of the step; otherwise the points slip. All in the units of the springs.

use super::edge::{Edge, Map, Share};
use super::fine::{self, FineEdge};
use super::slip::{Problem, Slip, at, product};
use super::spring_state::SpringState;
use crate::element::springs::{Both, Pressed, Row, SPRINGS, Springs, dot};
use crate::shape::TINY;
use crate::simd::dispatch;

/// Excess of the square of a traction over that of its limit by which a state that has slipped may round: it sticks.
pub(crate) const ROUNDING: f64 = 1e-14;

/// A step, straight in S and in the displacement.
pub(crate) struct Increment {
    pub before: Pressed,
    pub now: Pressed,
    pub by: Both<f64>,
    /// Whether the load is that of the state.
    pub constant_load: bool,
}

/// What a step leads through.
#[repr(align(32))]
pub(crate) struct StepRecord {
    pub edge: Edge,
    pub fine: FineEdge,
    /// The slip, if there is any.
    pub slip: Option<SlipRecord>,
    /// Sum of the forces of the springs, before Coulomb's bound.
    pub sum: Both<f64>,
}

impl StepRecord {
    #[inline(always)]
    pub fn new() -> StepRecord {
        StepRecord { edge: Edge::NONE, fine: FineEdge::NONE, slip: None, sum: [0.0; 2] }
    }
}

/// A step with slip: the springs at its end in units of the roots, tractions there and over the pressure at the start.
pub(crate) struct SlipRecord {
    pub slip: Slip,
    /// Displacements of the springs of the trial state.
    pub trial: Both<Row>,
    pub end: Both<Row>,
    pub tractions: Both<Row>,
    pub start: Both<Row>,
    pub overshoot: Row,
}

impl SlipRecord {
    /// Zeros, which are written in place: a value that is returned takes as much stack again.
    const ZERO: SlipRecord = SlipRecord {
        slip: Slip::ZERO,
        trial: [[0.0; SPRINGS]; 2],
        end: [[0.0; SPRINGS]; 2],
        tractions: [[0.0; SPRINGS]; 2],
        start: [[0.0; SPRINGS]; 2],
        overshoot: [0.0; SPRINGS],
    };
}

/// Force and dissipated energy.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Outcome {
    pub force: Both<f64>,
    pub dissipated: f64,
}

/// Advances the state. Requested are the energy, and what the derivatives of the step need.
#[inline(always)]
pub(crate) fn step(
    springs: &Springs,
    state: &mut SpringState,
    motion: &Increment,
    requested: [bool; 2],
    record: &mut StepRecord,
) -> Outcome {
    dispatch!(
        kernel,
        springs: &Springs,
        state: &mut SpringState,
        motion: &Increment,
        requested: [bool; 2],
        record: &mut StepRecord => Outcome
    )
}

#[inline(always)]
fn kernel(
    springs: &Springs,
    state: &mut SpringState,
    motion: &Increment,
    [energy, factors]: [bool; 2],
    record: &mut StepRecord,
) -> Outcome {
    let Increment { before, now, by, constant_load } = motion;
    let edge = Edge::new(springs, now, constant_load.then_some((&state.shell_pressure, &state.pressure)));
    let last = edge.last.min(SPRINGS - 1);
    let share = Share::new(before, now);
    let old = state.springs;
    let (mut trial, mut limits) = ([[0.0; SPRINGS]; 2], [[0.0; SPRINGS]; 2]);
    for k in 0..2 {
        for j in 0..SPRINGS {
            let limit = now.shift[k] - springs.shift[k][j];
            limits[k][j] = limit;
            let inside = j <= last && j < springs.used;
            trial[k][j] = if inside { old[k][j] + by[k] * share.of(k, limit) } else { 0.0 };
        }
    }
    let mut root = springs.root;
    for k in 0..2 {
        root[k][last] = edge.root[k];
    }
    // Tractions of the trial state.
    let mut sticks = true;
    let mut tractions = [[0.0; SPRINGS]; 2];
    let map = if *constant_load {
        for k in 0..2 {
            let per_step = by[k] / edge.step[k];
            for i in 0..SPRINGS {
                tractions[k][i] = state.tractions[k][i] * edge.pressure[i] + edge.shell_pressure[i] * per_step;
            }
        }
        None
    } else {
        let map = Map::new(springs, &edge);
        let z = scaled(&trial, &map.root);
        map.tractions(&z, &[false; SPRINGS], &mut tractions);
        Some(map)
    };
    for i in 0..SPRINGS {
        let (x, y, p) = (tractions[0][i], tractions[1][i], edge.pressure[i]);
        sticks &= x * x + y * y <= p * p * (1.0 + ROUNDING) || i > last;
    }
    let mut dissipated = 0.0;
    let mut end = trial;
    record.slip = None;
    if !sticks {
        let map = map.unwrap_or_else(|| Map::new(springs, &edge));
        let slipped = record.slip.insert(SlipRecord::ZERO);
        slipped.slip.first = SPRINGS;
        slipped.trial = trial;
        slide(state, &edge, &map, by, [&trial, &limits, &tractions], factors, slipped);
        for k in 0..2 {
            let mut per_root = springs.per_root[k];
            per_root[last] = 1.0 / edge.root[k];
            for j in 0..SPRINGS {
                end[k][j] = slipped.end[k][j] * per_root[j];
            }
        }
        if energy && *constant_load {
            dissipated = pointwise(slipped, &map, &edge);
        }
        tractions = slipped.tractions;
    }
    let mut sum = [0.0; 2];
    for k in 0..2 {
        let mut weights = [0.0; SPRINGS];
        for j in 0..SPRINGS {
            weights[j] = if j <= last { root[k][j] * root[k][j] } else { 0.0 };
        }
        sum[k] = dot(&weights, &end[k]);
        if energy && !constant_load {
            for j in 0..SPRINGS {
                dissipated += 0.5 * weights[j] * (old[k][j] + end[k][j]) * (trial[k][j] - end[k][j]);
            }
        }
    }
    if energy && !constant_load {
        dissipated = dissipated.max(0.0) + separated_from(springs, &old, motion, Some(last));
    }
    for i in 0..SPRINGS {
        let (x, y, p) = (tractions[0][i], tractions[1][i], edge.pressure[i]);
        let scale = if i <= last { 1.0 / (x * x + y * y).max(p * p).max(TINY).sqrt() } else { 0.0 };
        (state.tractions[0][i], state.tractions[1][i]) = (x * scale, y * scale);
    }
    state.springs = end;
    (state.shell_pressure, state.pressure) = (edge.shell_pressure, edge.pressure);
    let fine = FineEdge::new(springs, now, &edge);
    let (addition, loss) = fine::step(springs, &fine, &mut state.fine, before, now, by, *constant_load);
    sum = [sum[0] + addition[0], sum[1] + addition[1]];
    let over = (product(&sum, &sum).sqrt() / now.load).max(1.0);
    let force = [sum[0] / over, sum[1] / over];
    (record.edge, record.fine, record.sum) = (edge, fine, sum);
    Outcome { force, dissipated: (dissipated + loss).max(0.0) }
}

#[inline(always)]
fn scaled(springs: &Both<Row>, root: &Both<Row>) -> Both<Row> {
    let mut scaled = *springs;
    for k in 0..2 {
        for j in 0..SPRINGS {
            scaled[k][j] *= root[k][j];
        }
    }
    scaled
}

/// The slip from a trial state that exceeds Coulomb's bound: displacements, distances to the present size, tractions.
#[inline(always)]
fn slide(
    state: &SpringState,
    edge: &Edge,
    map: &Map,
    by: &Both<f64>,
    [trial, limits, tractions]: [&Both<Row>; 3],
    factors: bool,
    slipped: &mut SlipRecord,
) {
    let last = edge.last;
    let SlipRecord { slip, end, tractions: end_tractions, start, overshoot, .. } = slipped;
    *start = state.tractions;
    for i in (0..SPRINGS).rev() {
        if i > last {
            continue;
        }
        let (x, y) = (trial[0][i] / limits[0][i].max(TINY), trial[1][i] / limits[1][i].max(TINY));
        let over = (x * x + y * y).sqrt();
        overshoot[i] = (over - 1.0).max(0.0);
        if over > 1.0 {
            let per_over = 1.0 / over.max(TINY);
            slip.begin(i, [x * per_over, y * per_over]);
            continue;
        }
        // A point that slipped before continues if the next one outside does, unless the motion turns back.
        let (x, y, p) = (tractions[0][i], tractions[1][i], edge.pressure[i]);
        let r = [start[0][i], start[1][i]];
        let slipped = product(&r, &r) > 1.0 - 1e-9 && product(&r, by) > 0.0 && slip.first == i + 1;
        if slipped || x * x + y * y > p * p {
            let per_length = 1.0 / (x * x + y * y).max(TINY).sqrt();
            slip.begin(i, [x * per_length, y * per_length]);
        }
    }
    let trial = scaled(trial, &map.root);
    let problem = Problem { map, trial: &trial, pressure: &edge.pressure, start, overshoot };
    slip.solve(&problem, factors, [end, end_tractions]);
    if !slip.converged {
        // Each spring returns to its own limit.
        for k in 0..2 {
            for j in 0..SPRINGS {
                end[k][j] = trial[k][j] / (1.0 + overshoot[j]);
            }
        }
        *end_tractions = [[0.0; SPRINGS]; 2];
        map.tractions(end, &[false; SPRINGS], end_tractions);
    }
}

/// Energy dissipated at constant load: at each point the slip times the mean of the traction where its path leaves Coulomb's disc and at the end.
#[inline(always)]
fn pointwise(slipped: &SlipRecord, map: &Map, edge: &Edge) -> f64 {
    let SlipRecord { slip, start, .. } = slipped;
    let mut energy = 0.0;
    for i in 0..SPRINGS {
        if i > edge.last || !slip.slips[i] {
            continue;
        }
        let sigma = at(&slip.sigma, i);
        let p = edge.pressure[i];
        let (end, r) = (at(&slip.e, i).map(|e| p * e), at(start, i).map(|r| p * r));
        let mut path = [0.0; 2];
        for k in 0..2 {
            let row = map.row(k, i);
            path[k] = end[k] + dot(&row, &row) * sigma[k] - r[k];
        }
        let (square, along) = (product(&path, &path), product(&r, &path));
        let inside = (p * p - product(&r, &r)).max(0.0);
        let root = (along * along + square * inside).sqrt();
        let part = (inside / (along + root).max(TINY)).min(1.0);
        let part = if along > 0.0 { part } else { ((root - along) / square.max(TINY)).min(1.0) };
        let exit = [r[0] + part * path[0], r[1] + part * path[1]];
        energy += (0.5 * (product(&sigma, &exit) + product(&sigma, &end))).max(0.0);
    }
    energy
}

/// Energy dissipated if the contact opens.
pub(crate) fn separated(springs: &Springs, state: &SpringState, motion: &Increment) -> f64 {
    separated_from(springs, &state.springs, motion, None)
}

/// Energy of the springs beyond the last one, which lose contact in a step: they slip from where they are to nothing.
fn separated_from(springs: &Springs, old: &Both<Row>, motion: &Increment, last: Option<usize>) -> f64 {
    let Increment { before, now, by, .. } = motion;
    let mut energy = 0.0;
    for j in 0..SPRINGS {
        let stays = last.is_some_and(|last| j <= last);
        if stays || j >= springs.used || springs.shift[0][j] >= before.shift[0] {
            continue;
        }
        let mut of_spring = 0.0;
        for k in 0..2 {
            let part = (before.shift[k] - springs.shift[k][j]).max(0.0) / (before.shift[k] - now.shift[k]).max(TINY);
            let weight = springs.root[k][j] * springs.root[k][j];
            of_spring += 0.5 * weight * old[k][j] * (old[k][j] + part * by[k]);
        }
        energy += of_spring.max(0.0);
    }
    energy
}
