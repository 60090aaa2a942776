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

use super::fine::{self, SLIPS};
use super::spring_state::SpringState;
use super::springs::{Both, Increment, MOST, PARTS, PressedSlopes, Row, Springs, add, at, dot, used};
use super::step::StepRecord;
use crate::shape::TINY;
use crate::simd::dispatch;
use core::slice::{from_mut, from_ref};

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

/// Derivatives of the motion: its displacements, the normal component at its end and at its start, and the logarithm of the size that the
/// springs are aligned with.
#[derive(Debug, Clone, Copy)]
pub(crate) struct IncrementColumns<const C: usize> {
    pub by: Both<Columns<C>>,
    pub end: Columns<C>,
    pub start: Columns<C>,
    pub alignment: Columns<C>,
}

/// A step that was taken.
pub(crate) struct Taken<'a, const N: usize> {
    pub springs: &'a Springs<'a>,
    /// The state at its end.
    pub new: &'a SpringState<N>,
    pub motion: &'a Increment,
    pub record: &'a StepRecord<N>,
    /// Derivatives of the normal state at the end and at the start.
    pub slopes: PressedSlopes,
    pub start_slopes: PressedSlopes,
    /// Derivatives of the tables by the logarithm of the size of the alignment, if requested.
    pub table_slopes: Option<&'a Springs<'a>>,
}

impl<const N: usize> Taken<'_, N> {
    /// The derivative of a distance from a node to the edge.
    #[inline(always)]
    fn limit_slope(&self, of: &Parameter<N>, [k, r, j]: [usize; 3]) -> f64 {
        match self.table_slopes {
            Some(slopes) => of.shift[k] - of.alignment * slopes.fine_shift[k][r.min(PARTS - 1)][j.min(N - 1)],
            None => of.shift[k],
        }
    }
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

/// The normal state and the alignment, which a step depends on besides the displacement and the state at its start: derivatives of the
/// step with respect to one of them, at fixed angles of slip and springs at the start.
pub(crate) struct Parameter<const N: usize> {
    /// Of the shift, and of the alignment.
    shift: Both<f64>,
    alignment: f64,
    /// Of the pressure; of σ through U and w, and through the pressures.
    pressure: Row<N>,
    sigma: Both<Row<N>>,
    sigma_by_pressure: Both<Row<N>>,
    /// Of the springs, dU q; of the tractions at fixed springs, and of the force.
    springs: Both<Row<N>>,
    tractions: Both<Row<N>>,
    force: Both<f64>,
}

impl<const N: usize> Parameter<N> {
    const NONE: Parameter<N> = Parameter {
        shift: [0.0; 2],
        alignment: 0.0,
        pressure: [0.0; N],
        sigma: [[0.0; N]; 2],
        sigma_by_pressure: [[0.0; N]; 2],
        springs: [[0.0; N]; 2],
        tractions: [[0.0; N]; 2],
        force: [0.0; 2],
    };

    /// The normal component at the end.
    #[inline(always)]
    pub fn load(taken: &Taken<N>) -> Parameter<N> {
        let mut load = Parameter::NONE;
        load.set_load(taken);
        load
    }

    fn set_load(&mut self, taken: &Taken<N>) {
        let load = self;
        dispatch!(by_load(load, taken));
    }

    /// The logarithm of the size of the alignment, by the derivatives of the tables.
    #[inline(always)]
    pub fn alignment(taken: &Taken<N>, slopes: &Springs) -> Parameter<N> {
        let mut alignment = Parameter::NONE;
        alignment.set_alignment(taken, slopes);
        alignment
    }

    fn set_alignment(&mut self, taken: &Taken<N>, slopes: &Springs) {
        let of = self;
        dispatch!(by_alignment(of, taken, slopes));
    }

    #[inline(always)]
    fn through_pressure(&mut self, taken: &Taken<N>) {
        let slip = &taken.record.slip;
        if taken.record.slipping() == 0 {
            return;
        }
        for k in 0..2 {
            for i in slip.first..N {
                if slip.contains(i) {
                    add(&mut self.sigma_by_pressure[k], -self.pressure[i] * slip.e[k][i], &slip.square[k][i]);
                }
            }
        }
    }
}

#[inline(always)]
fn by_load<const N: usize>(load: &mut Parameter<N>, taken: &Taken<N>) {
    let Taken { springs, new, motion, record, slopes, .. } = *taken;
    let (edge, slip) = (&new.edge, &record.slip);
    let last = edge.last.min(N - 1);
    [_, load.pressure] = springs.reach(last, &motion.now, &slopes);
    for k in 0..2 {
        let shift = slopes.shift[k];
        load.shift[k] = shift;
        let stiffness = (slopes.load - edge.secant[k] * shift) / edge.step[k];
        let fine_stiffness = (slopes.load - edge.fine_secant[k] * shift) / edge.fine_step[k];
        load.force[k] = (new.v[k][last] - new.fine[k][0][last]) * stiffness
            + new.fine[k][edge.part.min(PARTS - 1)][last] * fine_stiffness;
        let at_edge = new.v[k][last] / edge.step[k];
        for i in 0..N {
            load.tractions[k][i] = (load.pressure[i] - edge.reach[i] * shift / edge.step[k]) * at_edge;
        }
        if record.slipping() == 0 {
            continue;
        }
        let mut corner = edge.step[k] * stiffness * (record.trial[k][last] - new.v[k][last]);
        for j in slip.first..=last {
            let column = shift - dot(used(&springs.displacement[k][j]), &load.pressure);
            corner += column * record.stiffness[k][j] * (record.trial[k][j] - new.v[k][j]);
            load.springs[k][j] = column * slip.q[k][last];
        }
        load.sigma[k][last] = corner;
    }
    load.through_pressure(taken);
}

#[inline(always)]
fn by_alignment<const N: usize>(of: &mut Parameter<N>, taken: &Taken<N>, slopes: &Springs) {
    let Taken { springs, new, motion, record, .. } = *taken;
    let (slip, last) = (&record.slip, new.edge.last.min(N - 1));
    let change = new.edge.slope(springs, slopes, &motion.now);
    (of.alignment, of.pressure) = (1.0, change.pressure);
    for k in 0..2 {
        let stiffness = change.stiffnesses(slopes, k);
        of.tractions[k] = new.edge.tractions_slope([springs, slopes], &change, k, &new.v[k]);
        let mut force = dot(&stiffness, &new.v[k]);
        for r in 0..PARTS {
            force += dot(&fine::stiffnesses(slopes, &change, k, r), &new.fine[k][r]);
        }
        of.force[k] = force;
        if record.slipping() == 0 {
            continue;
        }
        let mut sigma = [0.0; N];
        for j in slip.first.min(N - 1)..=last {
            let (row, row_slope) = (new.edge.displacement(springs, k, j), change.displacement(slopes, k, j));
            of.springs[k][j] = dot(&row_slope, &slip.q[k]);
            let distance = record.trial[k][j] - new.v[k][j];
            add(&mut sigma, stiffness[j] * distance, &row);
            add(&mut sigma, record.stiffness[k][j] * distance, &row_slope);
        }
        of.sigma[k] = sigma;
    }
    of.through_pressure(taken);
}

/// A step among the largest number of springs, so that one function serves all sizes: what its derivatives need.
pub(crate) struct Wide {
    new: SpringState<MOST>,
    record: StepRecord<MOST>,
    parameters: [Parameter<MOST>; 2],
}

impl Wide {
    pub const NONE: Wide =
        Wide { new: SpringState::RELAXED, record: StepRecord::NONE, parameters: [Parameter::NONE; 2] };

    /// Copies a step.
    pub fn of<'a, const N: usize>(
        &'a mut self,
        taken: &Taken<'a, N>,
        parameters: [&Parameter<N>; 2],
    ) -> (Taken<'a, MOST>, &'a [Parameter<MOST>; 2]) {
        let Taken { springs, new, motion, record, slopes, start_slopes, table_slopes } = *taken;
        let (slip, edge) = (&record.slip, &new.edge);
        let Wide { new: to, record: wide, parameters: wide_parameters } = self;
        let (to_slip, to_edge) = (&mut wide.slip, &mut to.edge);
        let slides = record.slipping() != 0;
        if slides {
            for (from, to) in [
                (&slip.e, &mut to_slip.e),
                (&slip.n, &mut to_slip.n),
                (&slip.sigma, &mut to_slip.sigma),
                (&slip.pivots, &mut to_slip.pivots),
            ] {
                widen(from, to);
            }
            // The rows of slipping points.
            let matrices = [&slip.square[0], &slip.square[1], &slip.inverse];
            let [square_x, square_y] = &mut to_slip.square;
            for (from, to) in matrices.into_iter().zip([square_x, square_y, &mut to_slip.inverse]) {
                let rows = from.iter().zip(to).take(edge.last + 1).skip(slip.first);
                rows.for_each(|(from, to)| widen(from_ref(from), from_mut(to)));
            }
        }
        for (from, to) in [
            (&record.limit, &mut wide.limit),
            (&record.part, &mut wide.part),
            (&record.trial, &mut wide.trial),
            (&record.stiffness, &mut wide.stiffness),
            (&record.start, &mut wide.start),
            (&new.v, &mut to.v),
            (&new.tractions, &mut to.tractions),
            (&edge.column, &mut to_edge.column),
        ] {
            widen(from, to);
        }
        widen(new.fine.as_flattened(), to.fine.as_flattened_mut());
        widen(&record.fine_scale, &mut wide.fine_scale);
        for (from, to) in [
            (&slip.per_along, &mut to_slip.per_along),
            (&record.overshoot, &mut wide.overshoot),
            (&edge.reach, &mut to_edge.reach),
            (&edge.pressure, &mut to_edge.pressure),
        ] {
            widen(from_ref(from), from_mut(to));
        }
        for (from, to) in parameters.into_iter().zip(wide_parameters.iter_mut()) {
            (to.shift, to.alignment) = (from.shift, from.alignment);
            widen(from_ref(&from.pressure), from_mut(&mut to.pressure));
            widen(&from.tractions, &mut to.tractions);
            if slides {
                widen(&from.sigma, &mut to.sigma);
                widen(&from.sigma_by_pressure, &mut to.sigma_by_pressure);
                widen(&from.springs, &mut to.springs);
            }
            to.force = from.force;
        }
        for (from, to) in slip.points.iter().zip(to_slip.points.iter_mut()) {
            *to = *from;
        }
        (to_slip.count, to_slip.first) = (slip.count, slip.first);
        (to_slip.set, to_slip.converged) = (slip.set, slip.converged);
        (wide.last_before, wide.part_before) = (record.last_before, record.part_before);
        (wide.slips, wide.sum) = (record.slips, record.sum);
        (to_edge.last, to_edge.part) = (edge.last, edge.part);
        (to_edge.step, to_edge.fine_secant) = (edge.step, edge.fine_secant);
        to_edge.fine_stiffness = edge.fine_stiffness;
        (Taken { springs, new: to, motion, record: wide, slopes, start_slopes, table_slopes }, wide_parameters)
    }
}

/// Copies rows to the first places of wider ones.
fn widen<const N: usize>(from: &[Row<N>], to: &mut [Row<MOST>]) {
    dispatch!(widen_kernel(from, to));
}

#[inline(always)]
fn widen_kernel<const N: usize>(from: &[Row<N>], to: &mut [Row<MOST>]) {
    for (from, to) in from.iter().zip(to) {
        if let Some(place) = to.first_chunk_mut() {
            *place = *from;
        }
    }
}

/// Parameters, the load first, and their derivatives.
#[derive(Clone, Copy)]
struct Parameters<'a, const N: usize, const C: usize> {
    of: &'a [Parameter<N>],
    columns: [&'a Columns<C>; 2],
}

impl<'a, const N: usize, const C: usize> Parameters<'a, N, C> {
    #[inline(always)]
    fn iter(self) -> impl Iterator<Item = (&'a Parameter<N>, &'a Columns<C>)> {
        self.of.iter().zip(self.columns)
    }
}

/// Replaces the derivatives of the state at the start of a step by those at its end; those of the force. `inner` is the first shell whose
/// spring has slipped, or was engaged, since the contact closed.
#[inline(always)]
pub(crate) fn tangent<const N: usize, const C: usize>(
    taken: &Taken<N>,
    parameters: &[Parameter<N>],
    columns: &IncrementColumns<C>,
    derivatives: &mut Derivatives<N, C>,
    inner: usize,
) -> Both<Columns<C>> {
    dispatch!(kernel(taken, parameters, columns, derivatives, inner))
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
    let first = springs.under_flat;
    for row in &record.fine_scale {
        let slips = |(j, scale): (usize, &f64)| (j >= first && j <= new.edge.last && *scale < SLIPS).then_some(j);
        inner = row.iter().enumerate().find_map(slips).unwrap_or(N).min(inner);
    }
    inner
}

#[inline(always)]
fn kernel<const N: usize, const C: usize>(
    taken: &Taken<N>,
    parameters: &[Parameter<N>],
    columns: &IncrementColumns<C>,
    derivatives: &mut Derivatives<N, C>,
    inner: usize,
) -> Both<Columns<C>> {
    let Taken { new, motion, record, slopes, .. } = *taken;
    let (edge, slip) = (&new.edge, &record.slip);
    let last = edge.last.min(N - 1);
    let parameters = Parameters { of: parameters, columns: [&columns.end, &columns.alignment] };
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
            follow(row, [k, 0, j], record.part[k][j], taken, columns, parameters);
        }
    }
    for k in 0..2 {
        derivatives.displacement[k] = sum_of(&derivatives.displacement[k], &columns.by[k]);
    }
    let mut first = last + 1;
    if record.slipping() != 0 {
        first = slip.first.min(N - 1);
        slide(taken, parameters, derivatives);
    } else if record.slips {
        for j in 0..=last {
            if record.overshoot[j] > 0.0 {
                let per_limit = [1.0 / record.limit[0][j], 1.0 / record.limit[1][j]];
                let per_over = 1.0 / (1.0 + record.overshoot[j]);
                let returned = Returned { end: at(&new.v, j), per_over, per_limit, place: [0, j] };
                let displacement = *derivatives.displacement;
                let [x, y] = &mut derivatives.springs;
                returned.differentiate(taken, parameters, &displacement, [&mut x[j], &mut y[j]]);
            }
        }
    }
    stuck_tractions(taken, parameters, first, derivatives);
    let mut force = [[0.0; C]; 2];
    for k in 0..2 {
        let mut sum = scaled(edge.fine_secant[k], &derivatives.displacement[k]);
        for (of, column) in parameters.iter() {
            put(&mut sum, of.force[k], column);
        }
        for j in inner..=last {
            put(&mut sum, record.stiffness[k][j], &derivatives.springs[k][j]);
        }
        force[k] = sum;
    }
    fine_correction(taken, columns, parameters, derivatives, inner, &mut force);
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
fn follow<const N: usize, const C: usize>(
    row: &mut Columns<C>,
    [k, r, j]: [usize; 3],
    part: f64,
    taken: &Taken<N>,
    columns: &IncrementColumns<C>,
    parameters: Parameters<N, C>,
) {
    if part < 1.0 {
        let rate = taken.motion.by[k] * taken.motion.per_rise[k];
        put(row, part - 1.0, &columns.by[k]);
        for (of, column) in parameters.iter() {
            put(row, rate * taken.limit_slope(of, [k, r, j]), column);
        }
        put(row, -rate * part * taken.slopes.shift[k], &columns.end);
        put(row, rate * part * taken.start_slopes.shift[k], &columns.start);
    }
}

/// Springs and tractions of slipping points.
#[inline(always)]
#[expect(clippy::too_many_lines, reason = "the equations in their order")]
fn slide<const N: usize, const C: usize>(
    taken: &Taken<N>,
    parameters: Parameters<N, C>,
    derivatives: &mut Derivatives<N, C>,
) {
    let Taken { springs, new, record, .. } = *taken;
    let StepRecord { slip, trial, limit, overshoot, start, .. } = record;
    let edge = &new.edge;
    let (first, last) = (slip.first.min(N - 1), edge.last.min(N - 1));
    let entry = |k: usize, j: usize, i: usize| if i < last { springs.displacement[k][j][i] } else { edge.column[k][j] };
    // dσ at fixed angles.
    let (mut sigma_x, mut sigma_y) = ([[0.0; C]; N], [[0.0; C]; N]);
    let sigma = [&mut sigma_x, &mut sigma_y];
    for k in 0..2 {
        let mut relaxed = [[0.0; C]; N];
        let displacement = derivatives.displacement[k];
        for j in first..=last {
            let w = record.stiffness[k][j];
            let mut row = scaled(w, &sum_of(&derivatives.springs[k][j], &displacement));
            for (of, column) in parameters.iter() {
                put(&mut row, -w * of.springs[k][j], column);
            }
            relaxed[j] = row;
        }
        for i in first..=last {
            let mut sum = [0.0; C];
            for (of, column) in parameters.iter() {
                put(&mut sum, of.sigma[k][i], column);
            }
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
                for (of, column) in parameters.iter() {
                    put(&mut sigma[k][i], of.sigma_by_pressure[k][i], column);
                }
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
        if along > 0.0 && slip.per_along[i] > 0.0 {
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
                    for (of, column) in parameters.iter() {
                        put(&mut row, -factor * ratio * taken.limit_slope(of, [k, 0, i]), column);
                    }
                }
            }
        }
        right[i] = row;
    }
    // Angles and tractions.
    let q = sigma;
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
            for (of, column) in parameters.iter() {
                put(&mut row, along * of.pressure[i], column);
            }
            q[k][i] = row;
        }
    }
    for n in (0..slip.count.min(N)).rev() {
        let t = slip.points[n].min(N - 1);
        for k in 0..2 {
            let mut row = q[k][t];
            for m in first..=last {
                let known =
                    slip.contains(m) || slip.points.iter().take(slip.count).skip(n + 1).any(|later| *later == m);
                if known {
                    put(&mut row, -slip.square[k][t][m], &q[k][m]);
                }
            }
            q[k][t] = scaled(slip.pivots[k][t], &row);
            let per_pressure = 1.0 / edge.pressure[t];
            let mut row = scaled(per_pressure, &q[k][t]);
            for (of, column) in parameters.iter() {
                put(&mut row, -per_pressure * of.pressure[t] * new.tractions[k][t], column);
            }
            derivatives.tractions[k][t] = row;
        }
    }
    for k in 0..2 {
        let displacement = derivatives.displacement[k];
        for j in first..=last {
            let mut row = scaled(-1.0, &displacement);
            for (of, column) in parameters.iter() {
                put(&mut row, of.springs[k][j], column);
            }
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
    parameters: Parameters<N, C>,
    first: usize,
    derivatives: &mut Derivatives<N, C>,
) {
    let Taken { springs, new, .. } = *taken;
    let edge = &new.edge;
    let last = edge.last.min(N - 1);
    for i in 0..N.min(first).min(last + 1) {
        let (x, y) = (new.tractions[0][i], new.tractions[1][i]);
        if x * x + y * y <= 0.5 {
            continue;
        }
        for k in 0..2 {
            let per_pressure = 1.0 / edge.pressure[i];
            let reach = edge.reach[i] / edge.step[k];
            let mut row = [0.0; C];
            for (of, column) in parameters.iter() {
                let change = of.tractions[k][i] - new.tractions[k][i] * of.pressure[i];
                put(&mut row, change * per_pressure, column);
            }
            put(&mut row, reach * per_pressure, &derivatives.springs[k][last]);
            put(&mut row, reach * per_pressure, &derivatives.displacement[k]);
            let mut before = 0.0;
            for j in i..=last {
                let factor =
                    if j < last { springs.traction[j][i] * springs.per_step[k][j] * per_pressure } else { 0.0 };
                put(&mut row, factor - before, &derivatives.springs[k][j]);
                before = factor;
            }
            derivatives.tractions[k][i] = row;
        }
    }
}

/// A spring that returned to its limit, `v = v*/over`.
struct Returned {
    end: Both<f64>,
    per_over: f64,
    per_limit: Both<f64>,
    /// Part of the fine correction, and node.
    place: [usize; 2],
}

impl Returned {
    /// Derivatives of the spring from those of its trial state, less those of the displacement.
    #[inline(always)]
    fn differentiate<const N: usize, const C: usize>(
        &self,
        taken: &Taken<N>,
        parameters: Parameters<N, C>,
        [d_x, d_y]: &Both<Columns<C>>,
        [x, y]: [&mut Columns<C>; 2],
    ) {
        let Returned { end, per_over, per_limit, place: [r, j] } = *self;
        let ratios = [end[0] * per_limit[0], end[1] * per_limit[1]];
        let weights = [per_over * ratios[0] * per_limit[0], per_over * ratios[1] * per_limit[1]];
        // d(over)/over.
        let mut change = [0.0; C];
        for (of, column) in parameters.iter() {
            let by_x = ratios[0] * ratios[0] * per_limit[0] * taken.limit_slope(of, [0, r, j]);
            let by_y = ratios[1] * ratios[1] * per_limit[1] * taken.limit_slope(of, [1, r, j]);
            put(&mut change, -(by_x + by_y), column);
        }
        // Both are loaded before one is stored: the compiler would not combine them in vectors.
        let (mut to_x, mut to_y) = (*x, *y);
        for c in 0..C {
            let (v_x, v_y) = (to_x[c] + d_x[c], to_y[c] + d_y[c]);
            let change = weights[0] * v_x + weights[1] * v_y + change[c];
            to_x[c] = per_over * v_x - end[0] * change - d_x[c];
            to_y[c] = per_over * v_y - end[1] * change - d_y[c];
        }
        (*x, *y) = (to_x, to_y);
    }
}

/// The fine correction.
#[inline(always)]
fn fine_correction<const N: usize, const C: usize>(
    taken: &Taken<N>,
    columns: &IncrementColumns<C>,
    parameters: Parameters<N, C>,
    derivatives: &mut Derivatives<N, C>,
    inner: usize,
    force: &mut Both<Columns<C>>,
) {
    let Taken { springs, new, motion, record, .. } = *taken;
    let edge = &new.edge;
    let last = edge.last.min(N - 1);
    let displacement = *derivatives.displacement;
    let rises = motion.per_rise[0] > 0.0;
    let first = inner.max(springs.under_flat);
    let [fine_x, fine_y] = &mut derivatives.fine;
    for (r, (x, y)) in fine_x.iter_mut().zip(fine_y.iter_mut()).enumerate() {
        let stop = if r <= edge.part { last + 1 } else { last };
        for j in first..stop {
            let (x, y) = (&mut x[j], &mut y[j]);
            let limit = [0, 1].map(|k| motion.now.shift[k] - springs.fine_shift[k][r][j]);
            if rises && j >= record.last_before {
                let share = motion.share(limit[0], limit[1]);
                let engaged = j > record.last_before || r > record.part_before;
                for (k, row) in [&mut *x, &mut *y].into_iter().enumerate() {
                    if engaged {
                        // Less the displacement at the start.
                        *row = columns.by[k];
                        put(row, -1.0, &displacement[k]);
                    }
                    follow(row, [k, r, j], share[k], taken, columns, parameters);
                }
            }
            let per_over = record.fine_scale[r][j];
            if per_over < SLIPS {
                let end = [new.fine[0][r][j], new.fine[1][r][j]];
                let per_area = 1.0 / (limit[0] * limit[1]);
                let per_limit = [limit[1] * per_area, limit[0] * per_area];
                let returned = Returned { end, per_over, per_limit, place: [r, j] };
                returned.differentiate(taken, parameters, &displacement, [&mut *x, &mut *y]);
            }
            for (k, row) in [x, y].into_iter().enumerate() {
                let stiffness = if j < last { springs.fine_stiffness[k][r][j] } else { edge.fine_stiffness[k][r] };
                put(&mut force[k], stiffness, row);
            }
        }
    }
}
