//! Derivatives of a step: those of the state at its end and of the force, from those at its start, for C columns at once; exact, by
//! differentiating the equations of the slip.
//!
//! At the solution the set of slipping points is fixed, and the angles of the tractions follow from the linear system of Newton's
//! method with its inverse J:
//!
//! ```text
//! dθ = J (n × dσ + σ × dn),   dσ = U' w (dv* - dU q - U e dp) + d(U' w) (v* - v) at fixed angles,   dq = p de + e dp
//! ```
//!
//! The springs follow as `dv = U dq + dU q`. U, w and p depend on the load through the last shell only. Points that stick within are
//! eliminated with the pivots of the step. What is kept of a spring is its derivative less that of the displacement of the contact, which
//! does not change as long as the spring sticks.

use super::springs::{Both, PARTS, PressedSlopes, Row, Springs, add, at, dot};
use super::spring_state::SpringState;
use super::step::{Increment, StepRecord};
use crate::shape::TINY;
use crate::simd::dispatch;

/// Derivatives of a value, a column per parameter.
pub(crate) type Columns<const C: usize> = [f64; C];
/// Those of a row.
type Rows<const N: usize, const C: usize> = [[f64; C]; N];

/// Rows of the derivatives of a state of N springs.
pub(crate) const fn rows(n: usize) -> usize {
    2 + (4 + 2 * PARTS) * n
}

/// Derivatives of a state.
pub(crate) struct Derivatives<'a, const N: usize, const C: usize> {
    /// Of the displacement since the contact closed.
    displacement: &'a mut Both<Columns<C>>,
    /// Of the springs, less that of the displacement; of the tractions.
    springs: Both<&'a mut Rows<N, C>>,
    tractions: Both<&'a mut Rows<N, C>>,
    fine: Both<&'a mut [Rows<N, C>; PARTS]>,
}

impl<'a, const N: usize, const C: usize> Derivatives<'a, N, C> {
    /// Of [`rows`].
    #[inline(always)]
    pub fn new(values: &'a mut [[f64; C]]) -> Option<Derivatives<'a, N, C>> {
        let (displacement, values) = values.split_first_chunk_mut()?;
        let ([x, y, r_x, r_y], fine) = values.as_chunks_mut::<N>().0.split_first_chunk_mut()?;
        let (fine_x, fine) = fine.split_first_chunk_mut()?;
        let fine = [fine_x, fine.first_chunk_mut()?];
        Some(Derivatives { displacement, springs: [x, y], tractions: [r_x, r_y], fine })
    }
}

/// Derivatives of the motion: its displacements, and the normal component at its end and at its start.
#[derive(Debug, Clone, Copy)]
pub(crate) struct IncrementColumns<const C: usize> {
    pub by: Both<Columns<C>>,
    pub end: Columns<C>,
    pub start: Columns<C>,
}

/// A step that was taken.
pub(crate) struct Taken<'a, const N: usize> {
    pub springs: &'a Springs<'a, N>,
    /// The state at its end.
    pub new: &'a SpringState<N>,
    pub motion: &'a Increment,
    pub record: &'a StepRecord<N>,
    /// Derivatives of the normal state at the end and at the start.
    pub slopes: PressedSlopes,
    pub start_slopes: PressedSlopes,
}

/// y += a x.
#[inline(always)]
fn put<const C: usize>(y: &mut Columns<C>, a: f64, x: &Columns<C>) {
    add(y, a, x);
}

#[inline(always)]
fn scaled<const C: usize>(a: f64, x: &Columns<C>) -> Columns<C> {
    let mut y = [0.0; C];
    for c in 0..C {
        y[c] = a * x[c];
    }
    y
}

#[inline(always)]
fn sum_of<const C: usize>(a: &Columns<C>, b: &Columns<C>) -> Columns<C> {
    let mut y = [0.0; C];
    for c in 0..C {
        y[c] = a[c] + b[c];
    }
    y
}

/// Derivatives with respect to the normal component, at fixed angles and springs.
struct LoadSlopes<const N: usize> {
    /// dF_i of the last shell, which is dp_i.
    pressure: Row<N>,
    /// dU_jl, from the first slipping point on.
    column: Both<Row<N>>,
    /// Of the stiffness of the last spring.
    stiffness: Both<f64>,
    /// Of σ_l through U and w, and of σ through the pressures.
    last: Both<f64>,
    sigma: Both<Row<N>>,
}

impl<const N: usize> LoadSlopes<N> {
    #[inline(always)]
    fn new(taken: &Taken<N>) -> LoadSlopes<N> {
        let Taken { springs, new, motion, record, slopes, .. } = *taken;
        let (edge, slip) = (&new.edge, &record.slip);
        let last = edge.last.min(N - 1);
        let mut load = LoadSlopes {
            pressure: [0.0; N],
            column: [[0.0; N]; 2],
            stiffness: [0.0; 2],
            last: [0.0; 2],
            sigma: [[0.0; N]; 2],
        };
        let [_, by_size] = springs.reach(last, &motion.now);
        for i in 0..N {
            load.pressure[i] = by_size[i] * slopes.size;
        }
        for k in 0..2 {
            load.stiffness[k] = (slopes.load - edge.secant[k] * slopes.shift[k]) / edge.step[k];
            if record.slipping() == 0 {
                continue;
            }
            for i in slip.first..last {
                if slip.contains(i) {
                    add(&mut load.sigma[k], -load.pressure[i] * slip.e[k][i], &slip.square[k][i]);
                }
            }
            for j in slip.first..=last {
                let change = slopes.shift[k] - dot(&springs.displacement[k][j], &load.pressure);
                load.column[k][j] = change;
                load.last[k] += change * edge.stiffness_of(springs, k, j) * (record.trial[k][j] - new.v[k][j]);
            }
            load.last[k] += edge.step[k] * load.stiffness[k] * (record.trial[k][last] - new.v[k][last]);
        }
        load
    }
}

/// Replaces the derivatives of the state at the start of a step by those at its end; those of the force. `inner` is the first shell whose
/// spring has slipped, or was engaged, since the contact closed.
#[inline(always)]
pub(crate) fn tangent<const N: usize, const C: usize>(
    taken: &Taken<N>,
    columns: &IncrementColumns<C>,
    derivatives: &mut Derivatives<N, C>,
    inner: usize,
) -> Both<Columns<C>> {
    dispatch!(
        kernel,
        [const N: usize, const C: usize]
        taken: &Taken<N>,
        columns: &IncrementColumns<C>,
        derivatives: &mut Derivatives<N, C>,
        inner: usize => Both<Columns<C>>
    )
}

/// The first shell whose spring has slipped or was engaged, from that before the step.
pub(crate) fn inner_after<const N: usize>(taken: &Taken<N>, inner: usize) -> usize {
    let Taken { springs, new, motion, record, .. } = *taken;
    let mut inner = inner;
    if motion.per_rise[0] > 0.0 {
        inner = inner.min(record.last_before);
    }
    if record.slips {
        inner = inner.min(if record.slip.converged { record.slip.first } else { 0 });
    }
    for row in &record.fine_square {
        inner = (springs.under_flat..inner.min(N)).find(|j| *j <= new.edge.last && row[*j] > 1.0).unwrap_or(inner);
    }
    inner
}

#[inline(always)]
fn kernel<const N: usize, const C: usize>(
    taken: &Taken<N>,
    columns: &IncrementColumns<C>,
    derivatives: &mut Derivatives<N, C>,
    inner: usize,
) -> Both<Columns<C>> {
    let Taken { new, motion, record, slopes, start_slopes, .. } = *taken;
    let (edge, slip) = (&new.edge, &record.slip);
    let last = edge.last.min(N - 1);
    let load = LoadSlopes::new(taken);
    // The trial state. Springs that are engaged in the step did not follow the displacement before.
    let rises = motion.per_rise[0] > 0.0;
    for k in 0..2 {
        if !rises {
            break;
        }
        let before = derivatives.displacement[k];
        for j in record.last_before..=last {
            let row = &mut derivatives.springs[k][j];
            if j > record.last_before {
                *row = scaled(-1.0, &before);
            }
            follow(row, k, record.part[k][j], motion, columns, [&slopes, &start_slopes]);
        }
    }
    for k in 0..2 {
        derivatives.displacement[k] = sum_of(&derivatives.displacement[k], &columns.by[k]);
    }
    let mut first = last + 1;
    if record.slipping() != 0 {
        first = slip.first.min(N - 1);
        slide(taken, &load, columns, derivatives);
    } else if record.slips {
        for j in 0..=last {
            let limit = at(&record.limit, j);
            returned(at(&new.v, j), limit, 1.0 + record.overshoot[j], slopes.shift, &columns.end, j, derivatives);
        }
    }
    stuck_tractions(taken, &load, first, columns, derivatives);
    let mut force = [[0.0; C]; 2];
    for k in 0..2 {
        let mut sum = scaled(new.v[k][last] * load.stiffness[k], &columns.end);
        put(&mut sum, edge.secant[k], &derivatives.displacement[k]);
        for j in inner..=last {
            put(&mut sum, record.stiffness[k][j], &derivatives.springs[k][j]);
        }
        force[k] = sum;
    }
    fine(taken, columns, derivatives, &load, inner, &mut force);
    // Coulomb's bound.
    let size = (record.sum[0] * record.sum[0] + record.sum[1] * record.sum[1]).sqrt().max(TINY);
    if size > motion.now.load {
        let (ratio, x, y) = (motion.now.load / size, record.sum[0] / size, record.sum[1] / size);
        for c in 0..C {
            let along = x * force[0][c] + y * force[1][c];
            let bound = slopes.load * columns.end[c];
            force[0][c] = ratio * (force[0][c] - x * along) + x * bound;
            force[1][c] = ratio * (force[1][c] - y * along) + y * bound;
        }
    }
    force
}

/// The trial state of a spring that follows a part of the motion.
#[inline(always)]
fn follow<const C: usize>(
    row: &mut Columns<C>,
    k: usize,
    part: f64,
    motion: &Increment,
    columns: &IncrementColumns<C>,
    [slopes, start_slopes]: [&PressedSlopes; 2],
) {
    if part < 1.0 {
        let rate = motion.by[k] * motion.per_rise[k];
        put(row, part - 1.0, &columns.by[k]);
        put(row, rate * (1.0 - part) * slopes.shift[k], &columns.end);
        put(row, rate * part * start_slopes.shift[k], &columns.start);
    }
}

/// Springs and tractions of slipping points.
#[inline(always)]
#[expect(clippy::too_many_lines, reason = "the equations in their order")]
fn slide<const N: usize, const C: usize>(
    taken: &Taken<N>,
    load: &LoadSlopes<N>,
    columns: &IncrementColumns<C>,
    derivatives: &mut Derivatives<N, C>,
) {
    let Taken { springs, new, record, slopes, .. } = *taken;
    let StepRecord { slip, trial, limit, overshoot, start, .. } = record;
    let edge = &new.edge;
    let (first, last) = (slip.first.min(N - 1), edge.last.min(N - 1));
    let entry = |k: usize, j: usize, i: usize| if i < last { springs.displacement[k][j][i] } else { edge.column[k][j] };
    // dσ at fixed angles.
    let mut sigma = [[[0.0; C]; N]; 2];
    for k in 0..2 {
        let mut relaxed = [[0.0; C]; N];
        let (at_edge, displacement) = (slip.q[k][last], derivatives.displacement[k]);
        for j in first..=last {
            let w = record.stiffness[k][j];
            let mut row = scaled(w, &sum_of(&derivatives.springs[k][j], &displacement));
            put(&mut row, -w * load.column[k][j] * at_edge, &columns.end);
            relaxed[j] = row;
        }
        for i in first..=last {
            let mut sum = scaled(if i == last { load.last[k] } else { 0.0 }, &columns.end);
            for j in first..=i {
                let factor = entry(k, j, i);
                for c in 0..C {
                    sum[c] += factor * relaxed[j][c];
                }
            }
            sigma[k][i] = sum;
        }
        for n in 0..slip.count.min(N) {
            let t = slip.points[n].min(N - 1);
            let there = sigma[k][t];
            for i in first..=last {
                if i != t {
                    put(&mut sigma[k][i], -slip.square[k][t][i] * slip.pivots[k][t], &there);
                }
            }
        }
        for i in first..=last {
            if slip.contains(i) {
                put(&mut sigma[k][i], load.sigma[k][i], &columns.end);
            }
        }
    }
    // n × dσ + σ × dn.
    let mut right = [[0.0; C]; N];
    for i in first..=last {
        if !slip.contains(i) {
            continue;
        }
        let mut row = scaled(slip.n[0][i], &sigma[1][i]);
        put(&mut row, -slip.n[1][i], &sigma[0][i]);
        let (e_x, e_y, r_x, r_y) = (slip.e[0][i], slip.e[1][i], start[0][i], start[1][i]);
        let (along, u) = (e_x * r_x + e_y * r_y, 2.0 * (r_x * r_x + r_y * r_y) - 1.0);
        if along > 0.0 && u > 0.0 {
            let (s_x, s_y) = (slip.sigma[0][i], slip.sigma[1][i]);
            let (factor, per_over) = (slip.per_along[i], 1.0 / (1.0 + overshoot[i] * (1.0 / 3.0)));
            let (beta, across) = (factor * along, s_y * r_x - s_x * r_y);
            let by_square = 8.0 * along * u * per_over;
            put(&mut row, (factor * e_x + by_square * r_x) * across + beta * s_y, &derivatives.tractions[0][i]);
            put(&mut row, (factor * e_y + by_square * r_y) * across - beta * s_x, &derivatives.tractions[1][i]);
            if overshoot[i] > 0.0 {
                let by_over = -beta * (1.0 / 3.0) * per_over * across / (1.0 + overshoot[i]);
                for k in 0..2 {
                    let ratio = trial[k][i] / limit[k][i];
                    let factor = by_over * ratio / limit[k][i];
                    put(&mut row, factor, &derivatives.springs[k][i]);
                    put(&mut row, factor, &derivatives.displacement[k]);
                    put(&mut row, -factor * ratio * slopes.shift[k], &columns.end);
                }
            }
        }
        right[i] = row;
    }
    // Angles and tractions.
    let mut q = sigma;
    for i in first..=last {
        if !slip.contains(i) {
            continue;
        }
        let mut angle = [0.0; C];
        for m in first..=last {
            let factor = slip.inverse[m][i];
            for c in 0..C {
                angle[c] += factor * right[m][c];
            }
        }
        let (x, y, p) = (slip.e[0][i], slip.e[1][i], edge.pressure[i]);
        derivatives.tractions[0][i] = scaled(-y, &angle);
        derivatives.tractions[1][i] = scaled(x, &angle);
        for (k, along) in [x, y].into_iter().enumerate() {
            let mut row = scaled(p, &derivatives.tractions[k][i]);
            put(&mut row, along * load.pressure[i], &columns.end);
            q[k][i] = row;
        }
    }
    for n in (0..slip.count.min(N)).rev() {
        let t = slip.points[n].min(N - 1);
        for k in 0..2 {
            let mut row = sigma[k][t];
            for m in first..=last {
                let known = slip.contains(m) || (n + 1..slip.count.min(N)).any(|later| slip.points[later] == m);
                if known {
                    put(&mut row, -slip.square[k][t][m], &q[k][m]);
                }
            }
            q[k][t] = scaled(slip.pivots[k][t], &row);
            let per_pressure = 1.0 / edge.pressure[t];
            let mut row = scaled(per_pressure, &q[k][t]);
            put(&mut row, -per_pressure * load.pressure[t] * new.tractions[k][t], &columns.end);
            derivatives.tractions[k][t] = row;
        }
    }
    for k in 0..2 {
        let displacement = derivatives.displacement[k];
        for j in first..=last {
            let mut row = scaled(load.column[k][j] * slip.q[k][last], &columns.end);
            put(&mut row, -1.0, &displacement);
            for i in j..=last {
                let factor = entry(k, j, i);
                for c in 0..C {
                    row[c] += factor * q[k][i][c];
                }
            }
            derivatives.springs[k][j] = row;
        }
    }
}

/// Tractions of the points before the first slipping one, over the pressure, where the direction of the next slip depends on them.
#[inline(always)]
fn stuck_tractions<const N: usize, const C: usize>(
    taken: &Taken<N>,
    load: &LoadSlopes<N>,
    first: usize,
    columns: &IncrementColumns<C>,
    derivatives: &mut Derivatives<N, C>,
) {
    let Taken { springs, new, slopes, .. } = *taken;
    let edge = &new.edge;
    let last = edge.last.min(N - 1);
    for i in 0..N.min(first).min(last + 1) {
        let (x, y) = (new.tractions[0][i], new.tractions[1][i]);
        if x * x + y * y <= 0.5 {
            continue;
        }
        for k in 0..2 {
            let (step, outer) = (edge.step[k], new.v[k][last]);
            let per_pressure = 1.0 / edge.pressure[i];
            let reach = edge.reach[i] / step;
            let by_load =
                load.pressure[i] * (outer / step - new.tractions[k][i]) - reach * outer / step * slopes.shift[k];
            let mut row = scaled(by_load * per_pressure, &columns.end);
            put(&mut row, reach * per_pressure, &derivatives.springs[k][last]);
            put(&mut row, reach * per_pressure, &derivatives.displacement[k]);
            let mut before = 0.0;
            for j in i..=last {
                let factor = if j < last { springs.traction[j][i] * springs.per_step[k][j] * per_pressure } else { 0.0 };
                put(&mut row, factor - before, &derivatives.springs[k][j]);
                before = factor;
            }
            derivatives.tractions[k][i] = row;
        }
    }
}

/// Derivatives of a spring that returned to its limit, `v = v*/over`, from those of its trial state.
#[inline(always)]
fn returned<const N: usize, const C: usize>(
    end: Both<f64>,
    limit: Both<f64>,
    over: f64,
    shift: Both<f64>,
    end_column: &Columns<C>,
    j: usize,
    derivatives: &mut Derivatives<N, C>,
) {
    if over <= 1.0 {
        return;
    }
    let [d_x, d_y] = *derivatives.displacement;
    let [rows_x, rows_y] = &mut derivatives.springs;
    return_row(end, limit, over, shift, end_column, [&d_x, &d_y], [&mut rows_x[j], &mut rows_y[j]]);
}

#[inline(always)]
fn return_row<const C: usize>(
    end: Both<f64>,
    limit: Both<f64>,
    over: f64,
    shift: Both<f64>,
    end_column: &Columns<C>,
    [d_x, d_y]: [&Columns<C>; 2],
    [x, y]: [&mut Columns<C>; 2],
) {
    let per_over = 1.0 / over;
    let weights = [0, 1].map(|k| end[k] / limit[k] / limit[k] * per_over);
    let by_load = -over * (weights[0] * end[0] / limit[0] * shift[0] + weights[1] * end[1] / limit[1] * shift[1]);
    for c in 0..C {
        let (v_x, v_y) = (x[c] + d_x[c], y[c] + d_y[c]);
        // d(over)/over, and v = v*/over.
        let change = weights[0] * v_x + weights[1] * v_y + by_load * end_column[c];
        x[c] = per_over * v_x - end[0] * change - d_x[c];
        y[c] = per_over * v_y - end[1] * change - d_y[c];
    }
}

/// The fine correction.
#[inline(always)]
fn fine<const N: usize, const C: usize>(
    taken: &Taken<N>,
    columns: &IncrementColumns<C>,
    derivatives: &mut Derivatives<N, C>,
    load: &LoadSlopes<N>,
    inner: usize,
    force: &mut Both<Columns<C>>,
) {
    let Taken { springs, new, motion, record, slopes, start_slopes } = *taken;
    let edge = &new.edge;
    let last = edge.last.min(N - 1);
    let [d_x, d_y] = *derivatives.displacement;
    let rises = motion.per_rise[0] > 0.0;
    let [fine_x, fine_y] = &mut derivatives.fine;
    for (r, (x, y)) in fine_x.iter_mut().zip(fine_y.iter_mut()).enumerate() {
        for j in inner.max(springs.under_flat)..=last {
            let (x, y) = (&mut x[j], &mut y[j]);
            if j == last && r > edge.part {
                continue;
            }
            let limit = [0, 1].map(|k| motion.now.shift[k] - springs.fine_shift[k][r][j]);
            if rises && j >= record.last_before {
                let share = motion.share(limit[0], limit[1]);
                let engaged = j > record.last_before || r > record.part_before;
                for (k, (row, d)) in [(&mut *x, &d_x), (&mut *y, &d_y)].into_iter().enumerate() {
                    if engaged {
                        // Less the displacement at the start.
                        *row = columns.by[k];
                        put(row, -1.0, d);
                    }
                    follow(row, k, share[k], motion, columns, [&slopes, &start_slopes]);
                }
            }
            let square = record.fine_square[r][j];
            if square > 1.0 {
                let end = [new.fine[0][r][j], new.fine[1][r][j]];
                return_row(end, limit, square.sqrt(), slopes.shift, &columns.end, [&d_x, &d_y], [&mut *x, &mut *y]);
            }
            let w = |k: usize| if j == last { edge.fine_stiffness[k][r] } else { springs.fine_stiffness[k][r][j] };
            put(&mut force[0], w(0), x);
            put(&mut force[1], w(1), y);
        }
    }
    for k in 0..2 {
        put(&mut force[k], edge.fine_secant[k] - edge.secant[k], if k == 0 { &d_x } else { &d_y });
        let slope = (slopes.load - edge.fine_secant[k] * slopes.shift[k]) / edge.fine_step[k];
        let by_load = new.fine[k][edge.part][last] * slope - new.fine[k][0][last] * load.stiffness[k];
        put(&mut force[k], by_load, &columns.end);
    }
}
