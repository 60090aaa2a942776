//! Derivatives of a step with respect to any number of parameters, its columns: exact, by differentiating the equations of the slip.
//!
//! The map B depends on the load through the column of the last spring only. With `h = B (dz* - dB'σ) + dB z - e dp` the multipliers
//! change by `dσ = S (h - p e' dθ)`, and the angles by `K dθ = -(dσ at fixed angles) × n - σ × dn`, with the factors of Newton's method.

use super::edge::Map;
use super::fine::Share;
use super::slip::{DirectionSlopes, at as point, product, solve_columns};
use super::springs::{Both, FINE, Row, SPRINGS, Springs};
use super::step::{Course, Memory, Motion};
use crate::shape::TINY;

/// Rows of the derivatives of a memory: springs, tractions, fine bank.
const TRACTIONS: usize = 2 * SPRINGS;
const FINE_ROWS: usize = 4 * SPRINGS;
pub(crate) const ROWS: usize = FINE_ROWS + 2 * FINE;
/// Rows of scratch memory.
pub(crate) const SCRATCH: usize = 7 * SPRINGS + 2;

/// Derivatives of the motion, a row of columns each: displacements; N, S of both directions and w² at the end; S at the start.
pub(crate) struct MotionColumns<'a> {
    pub by: Both<&'a [f64]>,
    pub load: &'a [f64],
    pub shift: Both<&'a [f64]>,
    pub size: &'a [f64],
    pub before: Both<&'a [f64]>,
}

/// A step that was taken.
pub(crate) struct Taken<'a> {
    pub springs: &'a Springs,
    /// The memory at the start and at the end.
    pub memories: [&'a Memory; 2],
    pub motion: &'a Motion,
    pub course: &'a Course,
}

/// Row r of a matrix of rows of n columns.
#[inline(always)]
fn row(matrix: &[f64], n: usize, r: usize) -> &[f64] {
    matrix.get(r * n..(r + 1) * n).unwrap_or(&[])
}

#[inline(always)]
fn row_mut(matrix: &mut [f64], n: usize, r: usize) -> &mut [f64] {
    matrix.get_mut(r * n..(r + 1) * n).unwrap_or(&mut [])
}

/// y += a x.
#[inline(always)]
fn add(y: &mut [f64], a: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += a * x;
    }
}

/// Row `to` += a × row `from`.
#[inline(always)]
fn add_row(matrix: &mut [f64], n: usize, to: usize, a: f64, from: usize) {
    let split = to.max(from) * n;
    if to == from || split > matrix.len() {
        return;
    }
    let (low, high) = matrix.split_at_mut(split);
    if to > from {
        add(high.get_mut(..n).unwrap_or(&mut []), a, row(low, n, from));
    } else {
        add(row_mut(low, n, to), a, high.get(..n).unwrap_or(&[]));
    }
}

/// Replaces the derivatives of the memory at the start of a step, `ROWS` rows of n columns, by those at its end, and writes those of
/// the force of both directions.
#[inline(always)]
#[expect(clippy::too_many_lines, reason = "the equations of a step, in its order")]
pub(crate) fn step(
    taken: &Taken,
    columns: &MotionColumns,
    memory: &mut [f64],
    scratch: &mut [f64],
    force: Both<&mut [f64]>,
) {
    let Taken { springs, memories: [old, new], motion, course } = *taken;
    let n = columns.load.len();
    let Course { edge, .. } = course;
    let last = edge.last.min(SPRINGS - 1);
    let share = Share::new(&motion.before, &motion.now);
    let map = Map::new(springs, edge);
    let [force_x, force_y] = force;
    force_x.fill(0.0);
    force_y.fill(0.0);
    // Trial displacements of the springs.
    for k in 0..2 {
        for j in 0..SPRINGS {
            let place = row_mut(memory, n, k * SPRINGS + j);
            if j > last || j >= springs.used {
                place.fill(0.0);
                continue;
            }
            let part = share.of(k, motion.now.shift[k] - springs.shift[k][j]);
            add(place, part, columns.by[k]);
            if part < 1.0 {
                let rate = motion.by[k] * share.per_rise[k];
                add(place, rate * (1.0 - part), columns.shift[k]);
                add(place, rate * part, columns.before[k]);
            }
        }
    }
    // d(w_last), over w; d(reach) over d(w²).
    let per_step = [1.0 / edge.step[0], 1.0 / edge.step[1]];
    let mut reach = [0.0; SPRINGS];
    for i in 0..SPRINGS {
        if i < last {
            let height = (motion.now.size - springs.point[i]).max(TINY).sqrt();
            reach[i] = 0.5 * springs.weight[last] * springs.unit[i] / height;
        }
    }
    let trial: Both<Row> = core::array::from_fn(|k| {
        core::array::from_fn(|j| {
            if j > last || j >= springs.used {
                return 0.0;
            }
            let part = share.of(k, motion.now.shift[k] - springs.shift[k][j]);
            old.springs[k][j] + motion.by[k] * part
        })
    });
    // The rows of the springs as z* = sqrt(w) v*: the change of the last root.
    let per_root = [1.0 / edge.root[0], 1.0 / edge.root[1]];
    let root_change = |k: usize, column: usize| {
        let at = |values: &[f64]| values.get(column).copied().unwrap_or(0.0);
        0.5 * per_root[k] * per_step[k] * (at(columns.load) - edge.secant[k] * at(columns.shift[k]))
    };
    for k in 0..2 {
        for j in 0..SPRINGS {
            let root = map.root[k][j];
            row_mut(memory, n, k * SPRINGS + j).iter_mut().for_each(|value| *value *= root);
        }
        for (column, value) in row_mut(memory, n, k * SPRINGS + last).iter_mut().enumerate() {
            *value += root_change(k, column) * trial[k][last];
        }
    }
    // d(column of B) at a point.
    let column_change = |k: usize, i: usize, column: usize| {
        let at = |values: &[f64]| values.get(column).copied().unwrap_or(0.0);
        let grown = reach[i] * at(columns.size) - edge.slope(k, i) * at(columns.shift[k]);
        (grown * per_step[k] - map.column[k][i] * root_change(k, column)) * per_root[k]
    };
    let end: Both<Row> = core::array::from_fn(|k| core::array::from_fn(|j| new.springs[k][j] * map.root[k][j]));
    // Rows of the scratch memory: h of both directions, the angles, dσ, and single rows.
    let (h, angles, sigma_rows) = (0, 2 * SPRINGS, 3 * SPRINGS);
    let converged = course.slip.as_ref().filter(|slipped| slipped.slip.converged);
    if let Some(slipped) = converged {
        let slip = &slipped.slip;
        scratch.get_mut(..n * SCRATCH).unwrap_or(&mut []).fill(0.0);
        // z* - dB'σ.
        for k in 0..2 {
            for i in 0..SPRINGS {
                if slip.slips[i] {
                    let sigma = slip.sigma[k][i];
                    for (column, value) in row_mut(memory, n, k * SPRINGS + last).iter_mut().enumerate() {
                        *value -= column_change(k, i, column) * sigma;
                    }
                }
            }
        }
        for i in 0..SPRINGS {
            if !slip.slips[i] {
                continue;
            }
            for k in 0..2 {
                let entries = map.row(k, i);
                let place = row_mut(scratch, n, h + k * SPRINGS + i);
                for j in i..SPRINGS {
                    if j <= last {
                        add(place, entries[j], row(memory, n, k * SPRINGS + j));
                    }
                }
                for (column, value) in place.iter_mut().enumerate() {
                    *value += column_change(k, i, column) * end[k][last];
                }
                if i < last {
                    add(place, -slip.e[k][i] * reach[i], columns.size);
                }
            }
        }
        // dσ at fixed angles, and the right-hand sides of the angles.
        for i in 0..SPRINGS {
            if !slip.slips[i] {
                continue;
            }
            let start = [slipped.start[0][i], slipped.start[1][i]];
            let direction = DirectionSlopes::new(&point(&slip.e, i), &start, slipped.overshoot[i]);
            let (n_x, n_y) = (direction.vector[0], direction.vector[1]);
            for j in 0..SPRINGS {
                if slip.slips[j] {
                    add_row(scratch, n, angles + i, -n_y * slip.inverse[0][i][j], h + j);
                    add_row(scratch, n, angles + i, n_x * slip.inverse[1][i][j], h + SPRINGS + j);
                }
            }
            let sigma = [slip.sigma[0][i], slip.sigma[1][i]];
            let turned = |vector: &Both<f64>| sigma[0] * vector[1] - sigma[1] * vector[0];
            let place = row_mut(scratch, n, angles + i);
            for k in 0..2 {
                add(place, -turned(&direction.by_start[k]), row(memory, n, TRACTIONS + k * SPRINGS + i));
            }
            // The overshoot, from z* again.
            let per_overshoot = turned(&direction.by_overshoot);
            if per_overshoot != 0.0 && slipped.overshoot[i] > 0.0 {
                let over = 1.0 + slipped.overshoot[i];
                for k in 0..2 {
                    let limit = motion.now.shift[k] - springs.shift[k][i];
                    let ratio = trial[k][i] / limit.max(TINY);
                    let factor = -per_overshoot * ratio / (over * limit.max(TINY));
                    // The trial displacement: without what was subtracted from the last row.
                    let part = share.of(k, limit);
                    if i < last {
                        add(place, factor / map.root[k][i], row(memory, n, k * SPRINGS + i));
                    } else {
                        for (column, value) in place.iter_mut().enumerate() {
                            let mut change = row(memory, n, k * SPRINGS + i).get(column).copied().unwrap_or(0.0);
                            for m in 0..SPRINGS {
                                if slip.slips[m] {
                                    change += column_change(k, m, column) * slip.sigma[k][m];
                                }
                            }
                            change = (change - root_change(k, column) * trial[k][i]) * per_root[k];
                            *value += factor * change;
                        }
                    }
                    let _ = part;
                    add(place, -factor * ratio, columns.shift[k]);
                }
            }
        }
        let angle_rows = scratch.get_mut(angles * n..(angles + SPRINGS) * n).unwrap_or(&mut []);
        solve_columns(&slip.factors, slip.first, last, angle_rows, n);
        // h - p e' dθ, dσ and the springs.
        for i in 0..SPRINGS {
            if slip.slips[i] {
                let p = edge.pressure[i];
                add_row(scratch, n, h + i, p * slip.e[1][i], angles + i);
                add_row(scratch, n, h + SPRINGS + i, -p * slip.e[0][i], angles + i);
            }
        }
        for k in 0..2 {
            for i in 0..SPRINGS {
                if !slip.slips[i] {
                    continue;
                }
                row_mut(scratch, n, sigma_rows).fill(0.0);
                for j in 0..SPRINGS {
                    if slip.slips[j] {
                        add_row(scratch, n, sigma_rows, slip.inverse[k][i][j], h + k * SPRINGS + j);
                    }
                }
                let entries = map.row(k, i);
                for j in i..SPRINGS {
                    if j <= last {
                        add(row_mut(memory, n, k * SPRINGS + j), -entries[j], row(scratch, n, sigma_rows));
                    }
                }
            }
        }
    } else if let Some(slipped) = &course.slip {
        for k in 0..2 {
            for j in 0..SPRINGS {
                let scale = 1.0 / (1.0 + slipped.overshoot[j]);
                row_mut(memory, n, k * SPRINGS + j).iter_mut().for_each(|value| *value *= scale);
            }
        }
    }
    // Tractions over the pressure.
    for i in 0..SPRINGS {
        let slides = converged.filter(|slipped| slipped.slip.slips[i]);
        for k in 0..2 {
            let place = row_mut(memory, n, TRACTIONS + k * SPRINGS + i);
            place.fill(0.0);
            if i > last {
                continue;
            }
            if let Some(slipped) = slides {
                let e = point(&slipped.slip.e, i);
                add(place, if k == 0 { -e[1] } else { e[0] }, row(scratch, n, angles + i));
                continue;
            }
            let per_pressure = 1.0 / edge.pressure[i].max(TINY);
            let entries = map.row(k, i);
            for j in i..SPRINGS {
                if j <= last {
                    add_row(memory, n, TRACTIONS + k * SPRINGS + i, entries[j] * per_pressure, k * SPRINGS + j);
                }
            }
            let place = row_mut(memory, n, TRACTIONS + k * SPRINGS + i);
            for (column, value) in place.iter_mut().enumerate() {
                *value += column_change(k, i, column) * end[k][last] * per_pressure;
            }
            if i < last {
                add(place, -new.tractions[k][i] * reach[i] * per_pressure, columns.size);
            }
        }
    }
    // Back to v, and the force.
    for k in 0..2 {
        let sum = if k == 0 { &mut *force_x } else { &mut *force_y };
        for (column, value) in row_mut(memory, n, k * SPRINGS + last).iter_mut().enumerate() {
            *value -= root_change(k, column) * new.springs[k][last];
        }
        for j in 0..SPRINGS {
            if j > last {
                continue;
            }
            let root = map.root[k][j];
            let place = row_mut(memory, n, k * SPRINGS + j);
            let per_root = if root > 0.0 { 1.0 / root.max(TINY) } else { 0.0 };
            place.iter_mut().for_each(|value| *value *= per_root);
            add(sum, root * root, place);
        }
        // The stiffness of the last spring.
        let factor = per_step[k] * new.springs[k][last];
        add(sum, factor, columns.load);
        add(sum, -factor * edge.secant[k], columns.shift[k]);
    }
    fine(taken, &share, columns, memory, [&mut *force_x, &mut *force_y]);
    // Coulomb's bound.
    let size = product(&course.sum, &course.sum).sqrt().max(TINY);
    if size > motion.now.load {
        let (ratio, e) = (motion.now.load / size, [course.sum[0] / size, course.sum[1] / size]);
        for ((x, y), load) in force_x.iter_mut().zip(force_y.iter_mut()).zip(columns.load) {
            let along = e[0] * *x + e[1] * *y;
            *x = ratio * (*x - e[0] * along) + e[0] * load;
            *y = ratio * (*y - e[1] * along) + e[1] * load;
        }
    }
}

/// The same for the fine bank.
#[inline(always)]
fn fine(
    taken: &Taken,
    share: &Share,
    columns: &MotionColumns,
    memory: &mut [f64],
    [force_x, force_y]: Both<&mut [f64]>,
) {
    let Taken { springs, memories: [old, new], motion, course } = *taken;
    let n = columns.load.len();
    let Course { edge, fine, .. } = course;
    let rows = memory.get_mut(FINE_ROWS * n..).unwrap_or(&mut []);
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
            let part = share.of(k, limit[k]);
            trial[k] = old.fine[k][j] + motion.by[k] * part;
            let place = if k == 0 { &mut *x } else { &mut *y };
            add(place, part, columns.by[k]);
            if part < 1.0 {
                let rate = motion.by[k] * share.per_rise[k];
                add(place, rate * (1.0 - part), columns.shift[k]);
                add(place, rate * part, columns.before[k]);
            }
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
