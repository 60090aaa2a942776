//! Harmonic force of a periodic motion in two tangential directions, by uniform sampling.
//!
//! The motion is u, v and the normal component (the approach w or the normal force N), each `c0 + Σ (a_k cos kt + b_k sin kt)`, at N
//! uniformly spaced instants from t = 0. Between the samples the path is that of a step of the element. Steady state: the element is
//! pressed by the normal force of the sample at which that is largest (the first such sample) with no tangential displacement, is
//! displaced to that sample at constant normal force, and advanced along a number of periods and one more from there, which counts. The
//! springs are aligned with the largest normal force.
//!
//! The Jacobian is the exact derivative of these steps: the derivatives of the state with respect to all coefficients are carried
//! along. A motion with v = 0 is that of one direction, whose force and Jacobian are used; only the stiffness along y is that of the
//! springs.

use super::advance::aligned;
use super::load_path::{LoadPath, Place};
use super::spring_state::SpringState;
use super::springs::{MOST, PressedSlopes, Springs, TABLES, fill};
use super::state::Header;
use super::step::StepRecord;
use super::tangent::{self, Derivatives, IncrementColumns, Parameter, Taken, Wide, inner_after, rows};
use super::{Requested, Step};
use crate::element::{Element, Normal};
use crate::error::Error;
use crate::fourier::workspace::{HEADER, Parts, Size, WorkspaceLayout, padded};
use crate::limits::check_coefficients;
use crate::one_direction::harmonic_force as one_direction;
use crate::simd::dispatch;
use crate::tag::Kind;
use core::f64::consts::TAU;

pub use crate::fourier::HarmonicOutput;

/// Number of doubles in a workspace for the given number of harmonics and of samples per period; 0 if these are not allowed.
#[must_use]
pub fn workspace_length(harmonics: usize, samples: usize) -> usize {
    Layout::new(Size::new(harmonics, samples)).map_or(0, |layout| layout.length())
}

/// Initialises a workspace: tables for the given harmonics and samples, the number of periods before the one that counts (0: the
/// default, 3), and scratch memory.
///
/// # Errors
/// `BadHarmonics` unless 1 <= harmonics <= 2^24, `BadSamples` unless 2 harmonics < samples <= 2^24, `BadPeriods` for more than 65536;
/// `WorkspaceTooShort`.
pub fn workspace_init(harmonics: usize, samples: usize, periods: usize, workspace: &mut [f64]) -> Result<(), Error> {
    Layout::init(Size::new(harmonics, samples).with_periods(periods), workspace)
}

/// Relative distance of the sizes whose tables are differentiated: the error is the square of it times the third derivative, up to 1e5 where
/// nodes are close, and a rounding error over it.
const NEIGHBOUR: f64 = 1e-6;

/// Columns that are advanced at once.
const BLOCK: usize = 12;

pub(crate) struct Layout(Size);

impl Layout {
    fn one_direction_length(&self) -> usize {
        padded(one_direction::workspace_length(self.0.harmonics, self.0.samples))
    }

    /// Blocks of columns, one for each coefficient of the motion.
    fn blocks(&self) -> usize {
        (3 * self.0.coefficients()).div_ceil(BLOCK)
    }

    /// Doubles of the motion, the force and the Jacobian of one direction.
    fn line_length(&self) -> usize {
        let n = 2 * self.0.coefficients();
        padded(n) + padded(n) + padded(n * n)
    }

    /// Sums of the derivatives of both forces times 1, cos t, sin t, ...
    fn sums_length(&self) -> usize {
        2 * self.0.coefficients() * self.blocks() * BLOCK
    }
}

/// Doubles of a sample: the motion, the normal state and its derivatives, w², and the tangential forces.
const SAMPLE: usize = 12;

impl WorkspaceLayout for Layout {
    const KIND: Kind = Kind::TwoDirectionsSampling;
    /// Static shear is shaken out over many periods: the table of `periods` in the guide has the errors.
    const PERIODS: usize = 3;

    fn of(size: Size) -> Layout {
        Layout(size)
    }

    fn size(&self) -> Size {
        self.0
    }

    fn max_rows(&self) -> usize {
        8 * self.0.samples + 256
    }

    fn tables_length(&self) -> usize {
        padded(self.0.coefficients() * self.0.samples) + self.one_direction_length()
    }

    fn length(&self) -> usize {
        HEADER
            + self.tables_length()
            + SAMPLE * self.0.samples
            + 3 * TABLES
            + (rows(MOST) + 2) * BLOCK * self.blocks()
            + self.sums_length()
            + self.line_length()
    }

    fn fill_tables(&self, tables: &mut Parts) -> Result<(), Error> {
        let Size { harmonics, samples, .. } = self.0;
        let n = self.0.coefficients();
        let basis = tables.take(n * samples)?;
        for (sample, values) in basis.chunks_exact_mut(n).enumerate() {
            for (c, value) in values.iter_mut().enumerate() {
                let turn = (c.div_ceil(2) * sample).checked_rem(samples).unwrap_or(0) as f64 / samples as f64;
                let angle = TAU * turn;
                *value = if c % 2 == 0 && c > 0 { angle.sin() } else { angle.cos() };
            }
        }
        one_direction::workspace_init(harmonics, samples, tables.take(self.one_direction_length())?)
    }
}

/// An opened workspace.
#[derive(Debug)]
pub struct Workspace<'a> {
    size: Size,
    /// Values of `[1, cos t, sin t, ...]`, sample after sample.
    basis: &'a [f64],
    one_direction: one_direction::Workspace<'a>,
    samples: &'a mut [[f64; SAMPLE]],
    /// Tables of the springs, their derivatives by the size of the alignment, and those of a slightly smaller size.
    springs: &'a mut [f64],
    /// Derivatives of the state, and those of both forces, block after block of columns.
    derivatives: &'a mut [[f64; BLOCK]],
    forces: &'a mut [[f64; BLOCK]],
    sums: &'a mut [f64],
    line: &'a mut [f64],
}

impl<'a> Workspace<'a> {
    /// Opens an initialised workspace.
    ///
    /// # Errors
    /// `BadWorkspace` if uninitialised or too short.
    pub fn new(memory: &'a mut [f64]) -> Result<Workspace<'a>, Error> {
        let (layout, mut parts) = Layout::open(memory)?;
        let (size, blocks) = (layout.0, layout.blocks());
        let basis = parts.take(size.coefficients() * size.samples)?;
        let one_direction = one_direction::Workspace::new(parts.take(layout.one_direction_length())?)?;
        Ok(Workspace {
            size,
            basis,
            one_direction,
            samples: parts.take(SAMPLE * size.samples)?.as_chunks_mut().0,
            springs: parts.take(3 * TABLES)?,
            derivatives: parts.take(rows(MOST) * BLOCK * blocks)?.as_chunks_mut().0,
            forces: parts.take(2 * BLOCK * blocks)?.as_chunks_mut().0,
            sums: parts.take(layout.sums_length())?,
            line: parts.take(layout.line_length())?,
        })
    }

    /// 2H + 1.
    #[must_use]
    pub fn coefficients(&self) -> usize {
        self.size.coefficients()
    }

    /// Checks a motion: all of a batch are checked before the first output is written.
    ///
    /// # Errors
    /// Those of [`harmonic_force`].
    pub(crate) fn check(&mut self, element: &Element, displacement: &[f64]) -> Result<(), Error> {
        check_coefficients(displacement)?;
        let input = displacement.get(2 * self.coefficients()..).unwrap_or(&[]);
        let mean = input.first().copied().unwrap_or(0.0);
        let amplitude: f64 = input.iter().skip(1).map(|value| value.abs()).sum();
        if (element.by_approach() || mean >= amplitude) && element.check_input(mean + amplitude).is_ok() {
            return Ok(());
        }
        self.synthesise(element, displacement)
    }

    /// Computes and checks the motion at the samples.
    fn synthesise(&mut self, element: &Element, displacement: &[f64]) -> Result<(), Error> {
        let n = self.coefficients();
        let input = displacement.get(2 * n..).unwrap_or(&[]);
        let rounding = 8.0 * f64::EPSILON * input.iter().map(|value| value.abs()).sum::<f64>();
        for (sample, basis) in self.samples.iter_mut().zip(self.basis.chunks_exact(n)) {
            *sample = [0.0; SAMPLE];
            for (values, place) in displacement.chunks_exact(n).zip(sample.iter_mut()) {
                *place = values.iter().zip(basis).map(|(value, basis)| value * basis).sum();
            }
            if !element.by_approach() {
                if sample[2] < -rounding {
                    return Err(Error::BadNormalForce);
                }
                sample[2] = sample[2].max(0.0);
            }
            element.check_input(sample[2])?;
        }
        Ok(())
    }

    /// Evaluates the normal states of the samples, with w² in the units of the springs.
    fn press(&mut self, element: &Element, from: &Header) {
        let (mut before, mut known) = (f64::NAN, Place::NONE);
        for sample in self.samples.iter_mut() {
            let [u, v, input, ..] = *sample;
            if input.to_bits() != before.to_bits() {
                known = Place::new(element, from, [u, v, input]);
            }
            before = input;
            let Normal { load, shift, load_slope, shift_slope } = known.normal;
            let closed = f64::from(u8::from(known.closed));
            *sample = [u, v, input, closed, load, shift, load_slope, shift_slope, known.size, 0.0, 0.0, 0.0];
        }
    }

    fn place(&self, index: usize) -> Place {
        let [u, v, input, closed, load, shift, load_slope, shift_slope, size, ..] =
            self.samples.get(index).copied().unwrap_or([0.0; SAMPLE]);
        let normal = Normal { load, shift, load_slope, shift_slope };
        Place { displacement: [u, v, input], closed: closed > 0.0, normal, size }
    }
}

/// Harmonic force of a periodic motion, given by its 3 (2H + 1) coefficients: those of u, of v \[m\], and of the normal component, the
/// approach \[m\] or the normal force \[N\].
///
/// The force has 3 (2H + 1) coefficients \[N\], Tx, Ty, N. The Jacobian has (3 (2H + 1))² entries, column by column: their derivatives
/// with respect to the coefficients of the motion. The drift is the largest difference of the tangential force between the period that
/// counts and the one before, over μ times the largest normal force; 0 if the contact opens or moves on a line.
///
/// # Errors
/// `BadArraySize` if a length does not agree with the workspace; `BadDisplacement` if a coefficient is not finite or exceeds 1e150;
/// `BadNormalForce` if a sample of the normal force is negative by more than rounding; `LengthTooShort` if the contact would become
/// too wide for its length.
pub fn harmonic_force(
    element: &Element,
    workspace: &mut Workspace,
    displacement: &[f64],
    output: HarmonicOutput,
) -> Result<(), Error> {
    let n = workspace.coefficients();
    let HarmonicOutput { mut force, mut jacobian, mut dissipated, mut drift } = output;
    let fits = |output: &Option<&mut [f64]>, length: usize| output.as_ref().is_none_or(|o| o.len() == length);
    if displacement.len() != 3 * n || !fits(&force, 3 * n) || !fits(&jacobian, 9 * n * n) {
        return Err(Error::BadArraySize);
    }
    check_coefficients(displacement)?;
    workspace.synthesise(element, displacement)?;
    let on_line = displacement.iter().skip(n).take(n).all(|value| *value == 0.0);
    if on_line {
        let with_jacobian = jacobian.is_some();
        line(element, workspace, displacement, force.as_deref_mut(), with_jacobian, dissipated.as_deref_mut())?;
        if let Some(drift) = drift.take() {
            *drift = 0.0;
        }
        if !with_jacobian {
            return Ok(());
        }
        (force, dissipated) = (None, None);
    }
    let output = HarmonicOutput { force, jacobian: jacobian.as_deref_mut(), dissipated, drift };
    match element.springs {
        8 => walk(element, workspace, output, &mut Walker::<8>::relaxed()),
        12 => walk(element, workspace, output, &mut Walker::<12>::relaxed()),
        _ => walk(element, workspace, output, &mut Walker::<16>::relaxed()),
    }
    if on_line && let Some(jacobian) = jacobian {
        merge_line(workspace, jacobian);
    }
    Ok(())
}

/// The first sample of largest normal force: its index and its normal component.
fn first_of_largest_load(workspace: &Workspace) -> (usize, f64) {
    let mut largest = (0, f64::MIN);
    for (index, sample) in workspace.samples.iter().enumerate() {
        largest = if sample[2] > largest.1 { (index, sample[2]) } else { largest };
    }
    largest
}

/// Springs that take the steps of a motion.
trait Walk {
    fn advance(&mut self, path: &LoadPath, springs: &Springs, requested: Requested) -> Step;

    /// What the derivatives of the step need, and the first shell whose spring has slipped, from that before the step.
    fn taken<'a>(
        &'a mut self,
        path: &'a LoadPath,
        springs: [&'a Springs<'a>; 2],
        slopes: [PressedSlopes; 2],
        inner: usize,
    ) -> (Taken<'a, MOST>, &'a [Parameter<MOST>; 2], usize);
}

/// The state of N springs and the last step.
struct Walker<const N: usize> {
    state: SpringState<N>,
    record: StepRecord<N>,
    wide: Wide,
}

impl<const N: usize> Walker<N> {
    fn relaxed() -> Walker<N> {
        Walker { state: SpringState::RELAXED, record: StepRecord::NONE, wide: Wide::NONE }
    }
}

impl<const N: usize> Walk for Walker<N> {
    fn advance(&mut self, path: &LoadPath, springs: &Springs, requested: Requested) -> Step {
        path.advance(springs, &mut self.state, requested, &mut self.record)
    }

    fn taken<'a>(
        &'a mut self,
        path: &'a LoadPath,
        [springs, table_slopes]: [&'a Springs<'a>; 2],
        [start_slopes, slopes]: [PressedSlopes; 2],
        inner: usize,
    ) -> (Taken<'a, MOST>, &'a [Parameter<MOST>; 2], usize) {
        let (new, record, motion) = (&self.state, &self.record, &path.motion);
        let taken = Taken { springs, new, motion, record, slopes, start_slopes, table_slopes: Some(table_slopes) };
        let (load, alignment) = (Parameter::load(&taken), Parameter::alignment(&taken, table_slopes));
        let inner = inner_after(&taken, inner);
        let (taken, parameters) = self.wide.of(&taken, [&load, &alignment]);
        (taken, parameters, inner)
    }
}

/// The periods of a motion that was synthesised.
fn walk(element: &Element, workspace: &mut Workspace, output: HarmonicOutput, walker: &mut dyn Walk) {
    let (n, Size { samples: count, periods, .. }) = (workspace.coefficients(), workspace.size);
    let HarmonicOutput { force, jacobian, dissipated, drift } = output;
    let requested = Requested { tangent: jacobian.is_some(), energy: dissipated.is_some() };
    let (largest, top) = first_of_largest_load(workspace);
    let slides = element.friction_coefficient > 0.0 && element.is_closed(top);
    let top_load = if slides { element.normal(top).load } else { element.normal_force };
    let mut from = aligned(element, &Header::NONE, top_load);
    workspace.press(element, &from);
    // A contact that opens forgets: whatever was before, the second period is the steady state.
    let opens = workspace.samples.iter().any(|sample| !element.is_closed(sample[2]));
    let periods = if opens { 1 } else { periods };
    let (mut energy, mut largest_change) = (0.0, 0.0f64);
    if slides {
        let memory = core::mem::take(&mut workspace.springs);
        let (tables, neighbours) = memory.split_at_mut(memory.len() / 3);
        let (slopes, smaller) = neighbours.split_at_mut(neighbours.len() / 2);
        fill(tables, element, &from.units, 1.0);
        if requested.tangent {
            fill(slopes, element, &from.units, 1.0 + NEIGHBOUR);
            fill(smaller, element, &from.units, 1.0 - NEIGHBOUR);
            for (slope, smaller) in slopes.iter_mut().zip(smaller) {
                *slope = (*slope - *smaller) * (0.5 / NEIGHBOUR);
            }
        }
        let at = |tables| Springs::new(from.under_flat, tables);
        if let (Some(springs), Some(table_slopes)) = (at(tables), at(slopes)) {
            // Of the logarithm of the reference size by the coefficients of the normal component.
            let top_normal = element.normal(top);
            let by_load = from.units.slopes(element, &top_normal, from.units.size_under(element, top_load)).size;
            let by_top = if top_load >= from.units.load * 0.99 { 0.5 * by_load } else { 0.0 };
            let mut slopes = PressedSlopes::default();
            let mut inner = MOST;
            if requested.tangent {
                workspace.derivatives.fill([0.0; BLOCK]);
                workspace.sums.fill(0.0);
            }
            let at_top = workspace.place(largest);
            let press = LoadPath::new(element, &from, &Place { displacement: [0.0, 0.0, top], ..at_top });
            walker.advance(&press, &springs, Requested { tangent: false, energy: false });
            from = press.to;
            let mut before = largest;
            for step in 0..=(periods + 1) * count {
                let index = (largest + step).checked_rem(count).unwrap_or(0);
                let counts = step > periods * count;
                let path = LoadPath::new(element, &from, &workspace.place(index));
                let asked = Requested { energy: requested.energy && counts, ..requested };
                let result = walker.advance(&path, &springs, asked);
                if requested.tangent {
                    if !path.closed || !path.was_closed {
                        workspace.derivatives.fill([0.0; BLOCK]);
                        inner = MOST;
                    }
                    if path.closed {
                        let start = if path.was_closed { slopes } else { PressedSlopes::default() };
                        slopes = path.to.units.slopes(element, &path.normal, path.to.size);
                        // The first displacement begins at rest, not at a sample, under the load of its sample.
                        let first = step == 0;
                        let start_slopes = if first { slopes } else { start };
                        let springs = [&springs, &table_slopes];
                        let (taken, parameters, now) = walker.taken(&path, springs, [start_slopes, slopes], inner);
                        inner = now;
                        let samples = [if first { None } else { Some(before) }, Some(index), Some(largest)];
                        differentiate(workspace, &path, &taken, parameters, samples, by_top, inner);
                    } else {
                        workspace.forces.fill([0.0; BLOCK]);
                    }
                    if counts {
                        let basis = row(workspace.basis, n, index);
                        accumulate(workspace.sums, basis, workspace.forces.as_flattened());
                    }
                }
                from = path.to;
                before = index;
                energy += result.dissipated * f64::from(u8::from(counts));
                let [x, y, _] = result.force;
                if let Some([.., x_place, y_place, _]) = workspace.samples.get_mut(index) {
                    if counts {
                        let (dx, dy) = (x - *x_place, y - *y_place);
                        largest_change = largest_change.max(dx * dx + dy * dy);
                    }
                    (*x_place, *y_place) = (x, y);
                }
            }
        }
        workspace.springs = memory;
    }
    if let Some(dissipated) = dissipated {
        *dissipated = energy;
    }
    if let Some(force) = force {
        write_force(workspace, force);
    }
    if let Some(jacobian) = jacobian {
        write_jacobian(workspace, slides.then_some(from.units.load * element.friction_coefficient), jacobian);
    }
    if let Some(drift) = drift {
        let slip_force = (element.friction_coefficient * top_load).max(f64::MIN_POSITIVE);
        *drift = if slides && !opens { largest_change.sqrt() / slip_force } else { 0.0 };
    }
}

fn write_force(workspace: &Workspace, force: &mut [f64]) {
    let (n, per_sample) = (workspace.coefficients(), 1.0 / workspace.size.samples as f64);
    force.fill(0.0);
    for (sample, basis) in workspace.samples.iter().zip(workspace.basis.chunks_exact(n)) {
        let [_, _, _, _, load, .., x, y, _] = *sample;
        for (places, value) in force.chunks_exact_mut(n).zip([x, y, load]) {
            for (c, (place, basis)) in places.iter_mut().zip(basis).enumerate() {
                *place += if c == 0 { per_sample } else { 2.0 * per_sample } * basis * value;
            }
        }
    }
}

/// The Jacobian from the sums, and that of the normal force.
fn write_jacobian(workspace: &Workspace, unit: Option<f64>, jacobian: &mut [f64]) {
    let (n, per_sample) = (workspace.coefficients(), 1.0 / workspace.size.samples as f64);
    let columns = workspace.forces.len() / 2 * BLOCK;
    let weight = |c: usize| if c == 0 { per_sample } else { 2.0 * per_sample };
    for (j, column) in jacobian.chunks_exact_mut(3 * n).enumerate() {
        for (c, place) in column.iter_mut().enumerate().take(2 * n) {
            let sum = workspace.sums.get(c * columns + j).copied().unwrap_or(0.0);
            *place = unit.map_or(0.0, |unit| unit * weight(c % n) * sum);
        }
        column.iter_mut().skip(2 * n).for_each(|place| *place = 0.0);
    }
    for (sample, basis) in workspace.samples.iter().zip(workspace.basis.chunks_exact(n)) {
        let slope = sample[6];
        for (column, basis_j) in jacobian.chunks_exact_mut(3 * n).skip(2 * n).zip(basis) {
            for ((c, place), basis_c) in column.iter_mut().skip(2 * n).enumerate().zip(basis) {
                *place += weight(c) * slope * basis_j * basis_c;
            }
        }
    }
}

/// Row r of a matrix with rows of n columns.
fn row(matrix: &[f64], n: usize, r: usize) -> &[f64] {
    matrix.get(r * n..(r + 1) * n).unwrap_or(&[])
}

/// Adds the derivatives of both forces times each value of the basis.
fn accumulate(sums: &mut [f64], basis: &[f64], forces: &[f64]) {
    dispatch!(accumulate_kernel(sums, basis, forces));
}

#[inline(always)]
fn accumulate_kernel(sums: &mut [f64], basis: &[f64], forces: &[f64]) {
    let half = forces.len() / 2;
    let of_both = sums.chunks_exact_mut((half * basis.len()).max(1)).zip(forces.chunks_exact(half.max(1)));
    for (sums, forces) in of_both {
        for (sums, value) in sums.chunks_exact_mut(half.max(1)).zip(basis) {
            for (sums, forces) in sums.as_chunks_mut::<4>().0.iter_mut().zip(forces.as_chunks::<4>().0) {
                for k in 0..4 {
                    sums[k] += value * forces[k];
                }
            }
        }
    }
}

/// Derivatives of the state and of the tangential forces at the end of a step between samples.
fn differentiate(
    workspace: &mut Workspace,
    path: &LoadPath,
    taken: &Taken<MOST>,
    parameters: &[Parameter<MOST>],
    samples: [Option<usize>; 3],
    by_top: f64,
    inner: usize,
) {
    let n = workspace.coefficients();
    let [start, end, top] = samples.map(|index| index.map_or(&[][..], |index| row(workspace.basis, n, index)));
    let at = |basis: &[f64], c: usize| basis.get(c).copied().unwrap_or(0.0);
    let (per_distance, per_input) = (path.per_distance(), [path.per_input(0), path.per_input(1)]);
    let (forces_x, forces_y) = workspace.forces.split_at_mut(workspace.forces.len() / 2);
    let memories = workspace.derivatives.chunks_exact_mut(rows(MOST));
    for (block, (memory, (x, y))) in memories.zip(forces_x.iter_mut().zip(forces_y)).enumerate() {
        let zero = [0.0; BLOCK];
        let mut columns = IncrementColumns { by: [zero; 2], end: zero, start: zero, alignment: zero };
        let (mut component, mut coefficient) = (block * BLOCK / n, block * BLOCK % n);
        for c in 0..BLOCK {
            let (from, to) = (at(start, coefficient), at(end, coefficient));
            match component {
                0 | 1 => columns.by[component.min(1)][c] = per_distance * (to - from),
                2 => {
                    for k in 0..2 {
                        columns.by[k][c] = per_input[k][0] * from + per_input[k][1] * to;
                    }
                    (columns.start[c], columns.end[c]) = (from, to);
                    columns.alignment[c] = by_top * at(top, coefficient);
                }
                _ => {}
            }
            coefficient += 1;
            if coefficient == n {
                (component, coefficient) = (component + 1, 0);
            }
        }
        let Some(mut derivatives) = Derivatives::<MOST, BLOCK>::new(memory) else { return };
        [*x, *y] = tangent::tangent(taken, parameters, &columns, &mut derivatives, inner);
    }
}

/// Force, energy and Jacobian of one direction, for a motion with v = 0; the Jacobian remains in the workspace.
fn line(
    element: &Element,
    workspace: &mut Workspace,
    displacement: &[f64],
    force: Option<&mut [f64]>,
    with_jacobian: bool,
    dissipated: Option<&mut f64>,
) -> Result<(), Error> {
    let n = workspace.coefficients();
    let mut parts = Parts::of(workspace.line);
    let (motion, result, matrix) = (parts.take(2 * n)?, parts.take(2 * n)?, parts.take(4 * n * n)?);
    let blocks = displacement.chunks_exact(n);
    for (place, values) in motion.chunks_exact_mut(n).zip(blocks.step_by(2)) {
        place.copy_from_slice(values);
    }
    let jacobian = if with_jacobian { Some(matrix) } else { None };
    let requested = force.is_some().then_some(&mut *result);
    let output = HarmonicOutput { force: requested, jacobian, dissipated, drift: None };
    one_direction::harmonic_force(element, &mut workspace.one_direction, motion, output)?;
    if let Some(force) = force {
        force.fill(0.0);
        for (place, values) in force.chunks_exact_mut(n).step_by(2).zip(result.chunks_exact(n)) {
            place.copy_from_slice(values);
        }
    }
    Ok(())
}

/// Replaces the Jacobian of u and the normal component by that of one direction; by symmetry they are independent of v.
fn merge_line(workspace: &mut Workspace, jacobian: &mut [f64]) {
    let n = workspace.coefficients();
    let mut parts = Parts::of(workspace.line);
    let (_, _, matrix) = (parts.take(2 * n), parts.take(2 * n), parts.take(4 * n * n));
    let matrix = matrix.unwrap_or(&mut []);
    for (j, column) in jacobian.chunks_exact_mut(3 * n).enumerate() {
        let lateral = j >= n && j < 2 * n;
        let source = if j < n { j } else { j.saturating_sub(n) };
        for (block, place) in column.chunks_exact_mut(n).enumerate() {
            if lateral != (block == 1) {
                place.fill(0.0);
            } else if !lateral {
                let from = 2 * n * source + if block == 0 { 0 } else { n };
                if let Some(values) = matrix.get(from..from + n) {
                    place.copy_from_slice(values);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::{Directions, NormalInput};
    use crate::parameters::{CENTRE_POINT, EllipticParameters, Layer, Material, Parameters};
    use std::prelude::rust_2024::*;
    use std::vec;

    const H: usize = 3;
    const COEFFICIENTS: usize = 3 * (2 * H + 1);
    const SAMPLES: usize = 32;

    fn elements() -> Vec<Element> {
        let material = [Material { young_modulus: 2e11, poisson_ratio: 0.3 }; 2];
        let flat = |flat_half_width, input| {
            let parameters = Parameters {
                flat_half_width,
                edge_radius: 0.05,
                length: 0.02,
                normal_force: 1000.0,
                friction_coefficient: 0.4,
                material,
                displacement_reference: CENTRE_POINT,
                layer: Layer::none(),
                springs: 0,
            };
            Element::rounded_flat(&parameters, Directions::Two, input).unwrap()
        };
        let ellipse = EllipticParameters {
            semi_axis_x: 1e-3,
            semi_axis_y: 2e-3,
            normal_force: 1000.0,
            friction_coefficient: 0.4,
            material,
            ..EllipticParameters::default()
        };
        let ellipse = Element::elliptic(&ellipse, Directions::Two, NormalInput::Force).unwrap();
        vec![flat(0.0, NormalInput::Approach), flat(1e-3, NormalInput::Force), ellipse]
    }

    /// Motions in units of the slip displacement and of the largest load: an ellipse, a figure of eight with a load that oscillates, one that
    /// separates, and one on a line.
    fn motion(element: &Element, kind: usize) -> [f64; COEFFICIENTS] {
        let n = 2 * H + 1;
        let unit = element.friction_coefficient * element.shift_under(element.normal_force);
        let full = if element.by_approach() { element.approach } else { element.normal_force };
        let mut motion = [0.0; COEFFICIENTS];
        let lateral = if kind == 3 { 0.0 } else { unit };
        (motion[0], motion[1], motion[3]) = (0.1 * unit, 0.7 * unit, 0.2 * unit);
        (motion[n + 2], motion[n + 4]) = (0.5 * lateral, 0.2 * lateral);
        motion[2 * n] = 0.7 * full;
        if kind > 0 {
            (motion[2 * n + 1], motion[2 * n + 4]) = (0.2 * full, 0.08 * full);
        }
        if kind == 2 && element.by_approach() {
            motion[2 * n] = 0.15 * full;
        }
        motion
    }

    struct Result {
        force: [f64; COEFFICIENTS],
        jacobian: Vec<f64>,
        dissipated: f64,
    }

    fn compute(element: &Element, motion: &[f64]) -> Result {
        let mut memory = vec![0.0; workspace_length(H, SAMPLES)];
        workspace_init(H, SAMPLES, 1, &mut memory).unwrap();
        let mut workspace = Workspace::new(&mut memory).unwrap();
        let mut result =
            Result { force: [0.0; COEFFICIENTS], jacobian: vec![0.0; COEFFICIENTS * COEFFICIENTS], dissipated: 0.0 };
        let output = HarmonicOutput {
            force: Some(&mut result.force),
            jacobian: Some(&mut result.jacobian),
            dissipated: Some(&mut result.dissipated),
            drift: None,
        };
        harmonic_force(element, &mut workspace, motion, output).unwrap();
        result
    }

    #[test]
    fn the_jacobian_is_the_derivative_of_the_force() {
        for element in elements() {
            let n = 2 * H + 1;
            let unit = element.friction_coefficient * element.shift_under(element.normal_force);
            let full = if element.by_approach() { element.approach } else { element.normal_force };
            for kind in 0..4 {
                let motion = motion(&element, kind);
                let result = compute(&element, &motion);
                for j in 0..COEFFICIENTS {
                    // On a line, the force off it is that of the springs, which differs by the error of the law.
                    if kind == 3 && j >= n && j < 2 * n {
                        continue;
                    }
                    // A amplitude of a constant load decides which sample is the first.
                    if kind == 0 && j > 2 * n {
                        continue;
                    }
                    let scale = if j < 2 * n { unit } else { full };
                    let h = 1e-6 * scale;
                    let moved = |h: f64| {
                        let mut motion = motion;
                        motion[j] += h;
                        compute(&element, &motion).force
                    };
                    // A point that begins to slip between both motions is a corner, which smaller differences avoid.
                    let steps = [h, h / 128.0];
                    let moved = steps.map(|h| [moved(h), moved(-h)]);
                    for i in 0..COEFFICIENTS {
                        let exact = result.jacobian[i + COEFFICIENTS * j];
                        // Central differences: h² times the third derivative, 1e-12, and rounding over h, 1e-8 of the force.
                        let error = |k: usize| {
                            let difference = (moved[k][0][i] - moved[k][1][i]) / (2.0 * steps[k]);
                            (difference - exact).abs() * scale / (0.4 * 1000.0)
                        };
                        let error = error(0).min(error(1));
                        assert!(error < 1e-6, "kind {kind}, entry {i} {j}: {exact:e}, error {error:e}");
                    }
                }
                assert!(result.dissipated > 0.0);
            }
        }
    }
}
