//! Derivatives of a step with respect to any number of parameters, its columns: exact, by differentiating the equations of the slip.
//!
//! The map B depends on the load through the column of the last spring only. With `h = B (dz* - dB'σ) + dB z - e dp` the multipliers
//! change by `dσ = S (h - p e' dθ)`, and the angles by `K dθ = -(dσ at fixed angles) × n - σ × dn`, with the factors of Newton's method.

use super::columns::{add, add_row, row, row_mut, scale};
use super::edge::{Map, Share};
use super::slip::{DirectionSlopes, at, product, solve_columns};
use super::spring_state::SpringState;
use super::step::{Increment, SlipRecord, StepRecord};
use crate::element::springs::{Both, FINE, Row, SPRINGS, Springs};
use crate::shape::TINY;
use crate::simd::dispatch;

/// Rows of the derivatives of a state: springs, tractions, fine bank.
const TRACTIONS: usize = 2 * SPRINGS;
const FINE_ROWS: usize = 4 * SPRINGS;
pub(crate) const ROWS: usize = FINE_ROWS + 2 * FINE;
/// Rows of scratch memory: h of both directions, the angles, and one row.
const ANGLES: usize = 2 * SPRINGS;
const SINGLE: usize = 3 * SPRINGS;
pub(crate) const SCRATCH: usize = SINGLE + 1;

/// Derivatives of the motion, a row of columns each: displacements; N, S of both directions and w² at the end; S at the start.
pub(crate) struct IncrementColumns<'a> {
    pub by: Both<&'a [f64]>,
    pub load: &'a [f64],
    pub shift: Both<&'a [f64]>,
    pub size: &'a [f64],
    pub before: Both<&'a [f64]>,
}

/// A step, and what was recorded of it.
pub(crate) struct RecordedStep<'a> {
    pub springs: &'a Springs,
    /// The state at the start and at the end.
    pub memories: [&'a SpringState; 2],
    pub motion: &'a Increment,
    pub record: &'a StepRecord,
}

/// Derivatives of a quantity of direction k by w², S_k and N at the end.
#[derive(Debug, Clone, Copy, Default)]
struct Slopes {
    size: f64,
    shift: f64,
    load: f64,
}

impl Slopes {
    /// place += factor × the change of the quantity.
    #[inline(always)]
    fn add(&self, place: &mut [f64], factor: f64, columns: &IncrementColumns, k: usize) {
        if self.size != 0.0 {
            add(place, factor * self.size, columns.size);
        }
        add(place, factor * self.shift, columns.shift[k]);
        add(place, factor * self.load, columns.load);
    }
}

/// What the edge depends on the load through: the pressures, and the root of the stiffness and the column of the last spring.
struct EdgeSlopes {
    /// dp_i/d(w²).
    pressure: Row,
    /// d(root)/root.
    root: Both<Slopes>,
    column: Both<[Slopes; SPRINGS]>,
}

impl EdgeSlopes {
    #[inline(always)]
    fn new(recorded: &RecordedStep, map: &Map) -> EdgeSlopes {
        let RecordedStep { springs, motion, record, .. } = *recorded;
        let edge = &record.edge;
        let last = edge.last.min(SPRINGS - 1);
        let mut slopes = EdgeSlopes {
            pressure: [0.0; SPRINGS],
            root: [Slopes::default(); 2],
            column: [[Slopes::default(); SPRINGS]; 2],
        };
        for i in 0..last {
            let height = (motion.now.size - springs.point[i]).max(TINY).sqrt();
            slopes.pressure[i] = 0.5 * springs.weight[last] * springs.unit[i] / height;
        }
        for k in 0..2 {
            let (per_root, per_step) = (1.0 / edge.root[k], 1.0 / edge.step[k]);
            let load = 0.5 * per_root * per_root * per_step;
            let root = Slopes { size: 0.0, shift: -load * edge.secant[k], load };
            slopes.root[k] = root;
            for i in 0..SPRINGS {
                if i <= last {
                    let column = map.column[k][i];
                    slopes.column[k][i] = Slopes {
                        size: slopes.pressure[i] * per_step * per_root,
                        shift: -edge.slope(k, i) * per_step * per_root - column * root.shift,
                        load: -column * root.load,
                    };
                }
            }
        }
        slopes
    }
}

/// Replaces the derivatives of the state at the start of a step, `ROWS` rows of n columns, by those at its end, and writes those of
/// the force of both directions.
#[inline(always)]
pub(crate) fn step(
    recorded: &RecordedStep,
    columns: &IncrementColumns,
    derivatives: &mut [f64],
    scratch: &mut [f64],
    force: Both<&mut [f64]>,
) {
    dispatch!(
        kernel,
        recorded: &RecordedStep,
        columns: &IncrementColumns,
        derivatives: &mut [f64],
        scratch: &mut [f64],
        force: Both<&mut [f64]> => ()
    );
}

#[inline(always)]
fn kernel(
    recorded: &RecordedStep,
    columns: &IncrementColumns,
    derivatives: &mut [f64],
    scratch: &mut [f64],
    [force_x, force_y]: Both<&mut [f64]>,
) {
    let RecordedStep { springs, memories: [_, new], motion, record } = *recorded;
    let (n, last) = (columns.load.len(), record.edge.last.min(SPRINGS - 1));
    let share = Share::new(&motion.before, &motion.now);
    let map = Map::new(springs, &record.edge);
    let edge = EdgeSlopes::new(recorded, &map);
    let slipped = record.slip.as_ref();
    let converged = slipped.filter(|slipped| slipped.slip.converged);
    trial(recorded, &share, columns, derivatives);
    if let Some(slipped) = converged {
        scratch.get_mut(..n * SCRATCH).unwrap_or(&mut []).fill(0.0);
        directions(recorded, slipped, columns, derivatives, scratch);
    }
    // From v to z = sqrt(w) v.
    let trial = slipped.map_or(&new.springs, |slipped| &slipped.trial);
    for k in 0..2 {
        for j in 0..SPRINGS {
            scale(row_mut(derivatives, n, k * SPRINGS + j), map.root[k][j]);
        }
        edge.root[k].add(row_mut(derivatives, n, k * SPRINGS + last), map.root[k][last] * trial[k][last], columns, k);
    }
    if let Some(slipped) = converged {
        slip(recorded, slipped, &map, &edge, columns, derivatives, scratch);
    } else if let Some(slipped) = slipped {
        for k in 0..2 {
            for j in 0..SPRINGS {
                scale(row_mut(derivatives, n, k * SPRINGS + j), 1.0 / (1.0 + slipped.overshoot[j]));
            }
        }
    }
    tractions(recorded, converged, &map, &edge, columns, derivatives, scratch);
    // Back to v, and the force.
    force_x.fill(0.0);
    force_y.fill(0.0);
    for k in 0..2 {
        let sum = if k == 0 { &mut *force_x } else { &mut *force_y };
        let outer = new.springs[k][last];
        edge.root[k].add(row_mut(derivatives, n, k * SPRINGS + last), -map.root[k][last] * outer, columns, k);
        for j in 0..SPRINGS {
            if j <= last {
                let (root, place) = (map.root[k][j], row_mut(derivatives, n, k * SPRINGS + j));
                scale(place, if root > 0.0 { 1.0 / root.max(TINY) } else { 0.0 });
                add(sum, root * root, place);
            }
        }
        // The stiffness of the last spring.
        edge.root[k].add(sum, 2.0 * map.root[k][last] * map.root[k][last] * outer, columns, k);
    }
    fine(recorded, &share, columns, derivatives, [&mut *force_x, &mut *force_y]);
    // Coulomb's bound.
    let size = product(&record.sum, &record.sum).sqrt().max(TINY);
    if size > motion.now.load {
        let (ratio, e) = (motion.now.load / size, [record.sum[0] / size, record.sum[1] / size]);
        for ((x, y), load) in force_x.iter_mut().zip(force_y.iter_mut()).zip(columns.load) {
            let along = e[0] * *x + e[1] * *y;
            *x = ratio * (*x - e[0] * along) + e[0] * load;
            *y = ratio * (*y - e[1] * along) + e[1] * load;
        }
    }
}

/// Trial displacements of the springs.
#[inline(always)]
fn trial(recorded: &RecordedStep, share: &Share, columns: &IncrementColumns, derivatives: &mut [f64]) {
    let RecordedStep { springs, motion, record, .. } = *recorded;
    let n = columns.load.len();
    for k in 0..2 {
        for j in 0..SPRINGS {
            let place = row_mut(derivatives, n, k * SPRINGS + j);
            if j > record.edge.last || j >= springs.used {
                place.fill(0.0);
                continue;
            }
            share.differentiate(place, motion.now.shift[k] - springs.shift[k][j], motion, columns, k);
        }
    }
}

impl Share {
    /// Adds the derivatives of the part of the motion that a spring follows, at the distance S_b - S_j.
    #[inline(always)]
    fn differentiate(&self, place: &mut [f64], limit: f64, motion: &Increment, columns: &IncrementColumns, k: usize) {
        let part = self.of(k, limit);
        add(place, part, columns.by[k]);
        if part < 1.0 {
            let rate = motion.by[k] * self.per_rise[k];
            add(place, rate * (1.0 - part), columns.shift[k]);
            add(place, rate * part, columns.before[k]);
        }
    }
}

/// The change of the directions of slip at fixed angles, by tractions at the start and by overshoots of the trial state: -σ × dn.
#[inline(always)]
fn directions(
    recorded: &RecordedStep,
    slipped: &SlipRecord,
    columns: &IncrementColumns,
    derivatives: &[f64],
    scratch: &mut [f64],
) {
    let RecordedStep { springs, motion, .. } = *recorded;
    let n = columns.load.len();
    let SlipRecord { slip, start, overshoot, trial, .. } = slipped;
    for i in 0..SPRINGS {
        if !slip.slips[i] {
            continue;
        }
        let direction = DirectionSlopes::new(&at(&slip.e, i), &at(start, i), overshoot[i]);
        let sigma = at(&slip.sigma, i);
        let turned = |vector: &Both<f64>| sigma[0] * vector[1] - sigma[1] * vector[0];
        let place = row_mut(scratch, n, ANGLES + i);
        let per_over = turned(&direction.by_overshoot) / (1.0 + overshoot[i]);
        for k in 0..2 {
            add(place, -turned(&direction.by_start[k]), row(derivatives, n, TRACTIONS + k * SPRINGS + i));
            if per_over != 0.0 && overshoot[i] > 0.0 {
                let limit = (motion.now.shift[k] - springs.shift[k][i]).max(TINY);
                let ratio = trial[k][i] / limit;
                let factor = per_over * ratio / limit;
                add(place, -factor, row(derivatives, n, k * SPRINGS + i));
                add(place, factor * ratio, columns.shift[k]);
            }
        }
    }
}

/// Springs and angles, from z* and the change of the directions.
#[inline(always)]
fn slip(
    recorded: &RecordedStep,
    slipped: &SlipRecord,
    map: &Map,
    edge: &EdgeSlopes,
    columns: &IncrementColumns,
    derivatives: &mut [f64],
    scratch: &mut [f64],
) {
    let pressure = &recorded.record.edge.pressure;
    let (n, last) = (columns.load.len(), map.last.min(SPRINGS - 1));
    let SlipRecord { slip, start, overshoot, end, .. } = slipped;
    let slipping = || (0..SPRINGS).filter(|i| slip.slips[*i]).map(|i| i.min(SPRINGS - 1));
    for k in 0..2 {
        // z* - dB'σ.
        for i in slipping() {
            edge.column[k][i].add(row_mut(derivatives, n, k * SPRINGS + last), -slip.sigma[k][i], columns, k);
        }
        for i in slipping() {
            let entries = map.row(k, i);
            let place = row_mut(scratch, n, k * SPRINGS + i);
            for j in i..SPRINGS {
                if j <= last {
                    add(place, entries[j], row(derivatives, n, k * SPRINGS + j));
                }
            }
            edge.column[k][i].add(place, end[k][last], columns, k);
            add(place, -slip.e[k][i] * edge.pressure[i], columns.size);
        }
    }
    // dσ at fixed angles × n.
    for i in slipping() {
        let n_i = DirectionSlopes::new(&at(&slip.e, i), &at(start, i), overshoot[i]).vector;
        for j in slipping() {
            add_row(scratch, n, ANGLES + i, -n_i[1] * slip.inverse[0][i][j], j);
            add_row(scratch, n, ANGLES + i, n_i[0] * slip.inverse[1][i][j], SPRINGS + j);
        }
    }
    let angles = scratch.get_mut(ANGLES * n..SINGLE * n).unwrap_or(&mut []);
    solve_columns(&slip.factors, slip.first, last, angles, n);
    // h - p e' dθ, dσ and the springs.
    for i in slipping() {
        add_row(scratch, n, i, pressure[i] * slip.e[1][i], ANGLES + i);
        add_row(scratch, n, SPRINGS + i, -pressure[i] * slip.e[0][i], ANGLES + i);
    }
    for k in 0..2 {
        for i in slipping() {
            row_mut(scratch, n, SINGLE).fill(0.0);
            for j in slipping() {
                add_row(scratch, n, SINGLE, slip.inverse[k][i][j], k * SPRINGS + j);
            }
            let entries = map.row(k, i);
            for j in i..SPRINGS {
                if j <= last {
                    add(row_mut(derivatives, n, k * SPRINGS + j), -entries[j], row(scratch, n, SINGLE));
                }
            }
        }
    }
}

/// Tractions over the pressure, from z and the angles.
#[inline(always)]
fn tractions(
    recorded: &RecordedStep,
    slipped: Option<&SlipRecord>,
    map: &Map,
    edge: &EdgeSlopes,
    columns: &IncrementColumns,
    derivatives: &mut [f64],
    scratch: &[f64],
) {
    let RecordedStep { memories: [_, new], record, .. } = *recorded;
    let (n, last) = (columns.load.len(), map.last.min(SPRINGS - 1));
    for i in 0..SPRINGS {
        let slides = slipped.filter(|slipped| slipped.slip.slips[i]);
        let per_pressure = 1.0 / record.edge.pressure[i].max(TINY);
        for k in 0..2 {
            let r = TRACTIONS + k * SPRINGS + i;
            row_mut(derivatives, n, r).fill(0.0);
            if i > last {
                continue;
            }
            if let Some(slipped) = slides {
                let [x, y] = at(&slipped.slip.e, i);
                add(row_mut(derivatives, n, r), if k == 0 { -y } else { x }, row(scratch, n, ANGLES + i));
                continue;
            }
            let entries = map.row(k, i);
            for j in i..SPRINGS {
                if j <= last {
                    add_row(derivatives, n, r, entries[j] * per_pressure, k * SPRINGS + j);
                }
            }
            let outer = new.springs[k][last] * map.root[k][last];
            let place = row_mut(derivatives, n, r);
            edge.column[k][i].add(place, outer * per_pressure, columns, k);
            add(place, -new.tractions[k][i] * edge.pressure[i] * per_pressure, columns.size);
        }
    }
}

/// The same for the fine bank.
#[inline(always)]
fn fine(
    recorded: &RecordedStep,
    share: &Share,
    columns: &IncrementColumns,
    derivatives: &mut [f64],
    [force_x, force_y]: Both<&mut [f64]>,
) {
    let RecordedStep { springs, memories: [old, new], motion, record } = *recorded;
    let n = columns.load.len();
    let StepRecord { edge, fine, .. } = record;
    let rows = derivatives.get_mut(FINE_ROWS * n..).unwrap_or(&mut []);
    let (rows_x, rows_y) = rows.split_at_mut((FINE * n).min(rows.len()));
    for j in 0..FINE {
        let (x, y) = (row_mut(rows_x, n, j), row_mut(rows_y, n, j));
        if j > fine.last {
            x.fill(0.0);
            y.fill(0.0);
            continue;
        }
        let limit: Both<f64> = core::array::from_fn(|k| motion.now.shift[k] - springs.fine_shift[k][j]);
        let mut trial = [0.0; 2];
        for k in 0..2 {
            trial[k] = old.fine[k][j] + motion.by[k] * share.of(k, limit[k]);
            share.differentiate(if k == 0 { &mut *x } else { &mut *y }, limit[k], motion, columns, k);
        }
        let ratios = [trial[0] / limit[0].max(TINY), trial[1] / limit[1].max(TINY)];
        let over2 = product(&ratios, &ratios);
        if over2 > 1.0 {
            // v = v*/over.
            let per_over = 1.0 / over2.max(TINY).sqrt();
            let weights: Both<f64> = core::array::from_fn(|k| ratios[k] / over2.max(TINY) / limit[k].max(TINY));
            let turns: Both<f64> = core::array::from_fn(|k| weights[k] * ratios[k]);
            for (column, (x, y)) in x.iter_mut().zip(y.iter_mut()).enumerate() {
                let at = |k: usize| columns.shift[k].get(column).copied().unwrap_or(0.0);
                // d(over)/over.
                let change = weights[0] * *x + weights[1] * *y - turns[0] * at(0) - turns[1] * at(1);
                *x = per_over * (*x - trial[0] * change);
                *y = per_over * (*y - trial[1] * change);
            }
        }
        add(force_x, fine.stiffness[0][j], x);
        add(force_y, fine.stiffness[1][j], y);
    }
    for k in 0..2 {
        let sum = if k == 0 { &mut *force_x } else { &mut *force_y };
        let factor = new.fine[k][fine.last.min(FINE - 1)] / fine.step[k];
        add(sum, factor, columns.load);
        add(sum, -factor * fine.secant[k], columns.shift[k]);
        let factor = -new.fine[k][fine.coarse.min(FINE - 1)] / edge.step[k];
        add(sum, factor, columns.load);
        add(sum, -factor * edge.secant[k], columns.shift[k]);
    }
}
