//! Harmonic force of a periodic motion in two tangential directions, by uniform sampling.
//!
//! The motion is u, v and the normal component (the approach w or the normal force N), each `c0 + Σ (a_k cos kt + b_k sin kt)`, at N
//! uniformly spaced instants from t = 0. Between the samples the path is that of a step of the element. Steady state: the element is
//! pressed by the normal force of the sample at which that is largest (the first such sample) with no tangential displacement, is
//! displaced to that sample at constant normal force, and advanced along the periods of the workspace and one more, which counts.
//!
//! The Jacobian is the exact derivative of these steps: the derivatives of the memory with respect to all coefficients are carried
//! along through all periods. The drift compares the tangential forces of the last period with those of the one before; a contact that
//! opens forgets, and has none. A motion with v = 0 is that of one direction, whose force and Jacobian are used; only the stiffness along y is that of the
//! springs.

use super::Requested;
use super::columns::{row, row_mut};
use super::load_path::LoadPath;
use super::spring_state::SpringState;
use super::state::Header;
use super::step::StepRecord;
use super::tangent::{self, IncrementColumns, ROWS, RecordedStep, SCRATCH};
use crate::element::Element;
use crate::element::springs::PressedSlopes;
use crate::error::Error;
use crate::fourier::workspace::{HEADER, Parts, Size, WorkspaceLayout, padded};
use crate::limits::check_coefficients;
use crate::one_direction::harmonic_force as one_direction;
use crate::tag::Kind;
use core::f64::consts::TAU;

pub use crate::fourier::HarmonicOutput;

/// Number of doubles in a workspace for the given number of harmonics and of samples per period; 0 if these are not allowed.
#[must_use]
pub fn workspace_length(harmonics: usize, samples: usize) -> usize {
    Layout::new(Size::new(harmonics, samples)).map_or(0, |layout| layout.length())
}

/// Initialises a workspace: tables for the given harmonics and samples, the number of periods before the one that counts (0: the
/// default, 1), and scratch memory.
///
/// # Errors
/// `BadHarmonics` unless 1 <= harmonics <= 2^24, `BadSamples` unless 2 harmonics < samples <= 2^24, `BadPeriods` for more than 65536;
/// `WorkspaceTooShort`.
pub fn workspace_init(harmonics: usize, samples: usize, periods: usize, workspace: &mut [f64]) -> Result<(), Error> {
    Layout::init(Size::new(harmonics, samples).with_periods(periods), workspace)
}

/// Rows of columns besides the derivatives of the memory and their scratch memory: the motion, and the force.
const MOTION_ROWS: usize = 10;

pub(crate) struct Layout(Size);

impl Layout {
    fn one_direction_length(&self) -> usize {
        padded(one_direction::workspace_length(self.0.harmonics, self.0.samples))
    }

    /// Coefficients of the motion in whole vectors.
    fn columns(&self) -> usize {
        padded(3 * self.0.coefficients())
    }

    /// Doubles of the motion, the force and the Jacobian of one direction.
    fn line_length(&self) -> usize {
        let n = 2 * self.0.coefficients();
        padded(n) + padded(n) + padded(n * n)
    }
}

impl WorkspaceLayout for Layout {
    const KIND: Kind = Kind::TwoDirectionsSampling;

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
            + 4 * self.0.samples
            + padded(2 * self.0.samples)
            + (ROWS + SCRATCH + MOTION_ROWS) * self.columns()
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
    /// u, v, normal component.
    samples: &'a mut [[f64; 4]],
    /// Tx and Ty at the samples of the last period, over mu times the largest normal force.
    forces: &'a mut [[f64; 2]],
    /// Derivatives of the memory, their scratch memory, and those of the motion and of the force.
    derivatives: &'a mut [f64],
    scratch: &'a mut [f64],
    motion: &'a mut [f64],
    line: &'a mut [f64],
}

impl<'a> Workspace<'a> {
    /// Opens an initialised workspace.
    ///
    /// # Errors
    /// `BadWorkspace` if uninitialised or too short.
    pub fn new(memory: &'a mut [f64]) -> Result<Workspace<'a>, Error> {
        let (layout, mut parts) = Layout::open(memory)?;
        let (size, columns) = (layout.0, layout.columns());
        let basis = parts.take(size.coefficients() * size.samples)?;
        let one_direction = one_direction::Workspace::new(parts.take(layout.one_direction_length())?)?;
        Ok(Workspace {
            size,
            basis,
            one_direction,
            samples: parts.take_blocks(size.samples)?,
            forces: parts.take(2 * size.samples)?.as_chunks_mut().0,
            derivatives: parts.take(ROWS * columns)?,
            scratch: parts.take(SCRATCH * columns)?,
            motion: parts.take(MOTION_ROWS * columns)?,
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
            *sample = [0.0; 4];
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

    fn sample(&self, index: usize) -> [f64; 3] {
        let [u, v, input, _] = self.samples.get(index).copied().unwrap_or([0.0; 4]);
        [u, v, input]
    }
}

/// Harmonic force of a periodic motion, given by its 3 (2H + 1) coefficients: those of u, of v \[m\], and of the normal component, the
/// approach \[m\] or the normal force \[N\].
///
/// The force has 3 (2H + 1) coefficients \[N\], Tx, Ty, N. The Jacobian has (3 (2H + 1))² entries, column by column: their derivatives
/// with respect to the coefficients of the motion.
///
/// # Errors
/// `BadArraySize` if a length does not agree with the workspace; `BadDisplacement` if a coefficient is not finite or exceeds 1e150;
/// `BadNormalForce` if a sample of the normal force is negative by more than rounding; `LengthTooShort` if the contact would become
/// too wide for its length.
#[expect(clippy::too_many_lines, reason = "all periods, in their order")]
pub fn harmonic_force(
    element: &Element,
    workspace: &mut Workspace,
    displacement: &[f64],
    output: HarmonicOutput,
) -> Result<(), Error> {
    let (n, Size { samples: count, periods, .. }) = (workspace.coefficients(), workspace.size);
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
        if let Some(drift) = &mut drift {
            **drift = 0.0;
        }
        if !with_jacobian {
            return Ok(());
        }
        (force, dissipated) = (None, None);
    }
    let requested = Requested { tangent: jacobian.is_some(), energy: dissipated.is_some() };
    if let Some(force) = &mut force {
        force.fill(0.0);
    }
    if let Some(jacobian) = &mut jacobian {
        jacobian.fill(0.0);
        workspace.derivatives.fill(0.0);
    }
    // The first sample of largest normal force.
    let mut largest = 0;
    for (index, sample) in workspace.samples.iter().enumerate() {
        let so_far = workspace.samples.get(largest).map_or(f64::MIN, |sample| sample[2]);
        largest = if sample[2] > so_far { index } else { largest };
    }
    let top = workspace.sample(largest);
    // A contact that opens forgets: whatever was before, the second period is the steady state.
    let opens = workspace.samples.iter().any(|sample| !element.is_closed(sample[2]));
    let periods = if opens { 1 } else { periods };
    let has_drift = drift.is_some() && !on_line && !opens;
    let slip_force = if has_drift { element.friction_coefficient * element.normal(top[2]).load } else { 0.0 };
    let mut from = Header::NONE;
    let mut springs = SpringState::RELAXED;
    let mut record = StepRecord::new();
    let frictionless = element.friction_coefficient == 0.0;
    if !frictionless {
        let press = LoadPath::new(element, &from, [0.0, 0.0, top[2]]);
        press.advance(element, &mut springs, Requested { tangent: false, energy: false }, &mut record);
        from = press.to;
    }
    let (mut energy, mut largest_difference) = (0.0, 0f64);
    let per_sample = 1.0 / count as f64;
    let mut before = largest;
    // The first step displaces the pressed contact.
    let steps = (0..=periods).flat_map(|period| (usize::from(period > 0)..=count).map(move |step| (period, step)));
    for (period, step) in steps {
        let index = (largest + step).checked_rem(count).unwrap_or(0);
        let counts = period == periods;
        let to = workspace.sample(index);
        let (values, slope) = if frictionless {
            let normal = if element.is_closed(to[2]) { Some(element.normal(to[2])) } else { None };
            ([0.0, 0.0, normal.map_or(0.0, |normal| normal.load)], normal.map_or(0.0, |normal| normal.load_slope))
        } else {
            let path = LoadPath::new(element, &from, to);
            let old = requested.tangent.then_some(if path.was_closed { springs } else { SpringState::RELAXED });
            let result = path.advance(element, &mut springs, requested, &mut record);
            if let Some(old) = old {
                if !path.closed || !path.was_closed {
                    workspace.derivatives.fill(0.0);
                }
                if path.closed {
                    // The first displacement begins at rest, not at a sample.
                    let start = if (period, step) == (0, 0) { None } else { Some(before) };
                    differentiate(element, workspace, &path, [&old, &springs], &record, &from, [start, Some(index)]);
                } else {
                    workspace.motion.fill(0.0);
                }
            }
            from = path.to;
            energy += if counts { result.dissipated } else { 0.0 };
            (result.force, result.tangent[8])
        };
        before = index;
        if slip_force > 0.0 && step > 0 {
            let [x, y] = [values[0] / slip_force, values[1] / slip_force];
            if let Some(place) = workspace.forces.get_mut(index) {
                let [dx, dy] = [x - place[0], y - place[1]];
                largest_difference = if counts { largest_difference.max((dx * dx + dy * dy).sqrt()) } else { 0.0 };
                *place = [x, y];
            }
        }
        if !counts {
            continue;
        }
        let basis = row(workspace.basis, n, index);
        let weight = |c: usize, value: f64| if c == 0 { per_sample * value } else { 2.0 * per_sample * value };
        if let Some(force) = &mut force {
            for (places, value) in force.chunks_exact_mut(n).zip(values) {
                for (c, (place, basis)) in places.iter_mut().zip(basis).enumerate() {
                    *place += weight(c, *basis) * value;
                }
            }
        }
        if let Some(jacobian) = &mut jacobian {
            let columns = padded(3 * n);
            let (x, y) = (row(workspace.motion, columns, 8), row(workspace.motion, columns, 9));
            for (j, column) in jacobian.chunks_exact_mut(3 * n).enumerate() {
                let normal = if j >= 2 * n { slope * basis.get(j - 2 * n).copied().unwrap_or(0.0) } else { 0.0 };
                let at = |values: &[f64]| if frictionless { 0.0 } else { values.get(j).copied().unwrap_or(0.0) };
                for (places, value) in column.chunks_exact_mut(n).zip([at(x), at(y), normal]) {
                    for (c, (place, basis)) in places.iter_mut().zip(basis).enumerate() {
                        *place += weight(c, *basis) * value;
                    }
                }
            }
        }
    }
    if let Some(dissipated) = dissipated {
        *dissipated = energy;
    }
    if let Some(drift) = drift {
        *drift = largest_difference;
    }
    if on_line && let Some(jacobian) = jacobian {
        merge_line(workspace, jacobian);
    }
    Ok(())
}

/// Derivatives of the memory and of the force at the end of a step between samples; those of the force are rows 8 and 9 of the motion.
fn differentiate(
    element: &Element,
    workspace: &mut Workspace,
    path: &LoadPath,
    memories: [&SpringState; 2],
    record: &StepRecord,
    from: &Header,
    samples: [Option<usize>; 2],
) {
    let n = workspace.coefficients();
    let columns = padded(3 * n);
    let [start, end] = samples.map(|index| index.map_or(&[][..], |index| row(workspace.basis, n, index)));
    let slopes = element.pressed_slopes(&path.normal);
    let before = if path.was_closed && start.len() == n {
        element.pressed_slopes(&element.normal(from.input))
    } else {
        PressedSlopes::default()
    };
    let rows = &mut *workspace.motion;
    rows.fill(0.0);
    let mut put = |r: usize, block: usize, factor: f64, basis: &[f64]| {
        let place = row_mut(rows, columns, r).get_mut(block * n..(block + 1) * n).unwrap_or(&mut []);
        for (place, basis) in place.iter_mut().zip(basis) {
            *place += factor * basis;
        }
    };
    for k in 0..2 {
        put(k, k, path.per_distance(), end);
        put(k, k, -path.per_distance(), start);
        let [by_start, by_end] = path.per_input(k);
        put(k, 2, by_start, start);
        put(k, 2, by_end, end);
        put(3 + k, 2, slopes.shift[k], end);
        put(6 + k, 2, before.shift[k], start);
    }
    put(2, 2, slopes.load, end);
    put(5, 2, slopes.size, end);
    // At the first displacement the load was that of its sample from the beginning.
    if start.is_empty() {
        for k in 0..2 {
            put(6 + k, 2, slopes.shift[k], end);
        }
    }
    let (rows, forces) = workspace.motion.split_at_mut((8 * columns).min(workspace.motion.len()));
    let (x, y) = forces.split_at_mut(columns.min(forces.len()));
    let y = y.get_mut(..columns).unwrap_or(&mut []);
    let motion = IncrementColumns {
        by: [row(rows, columns, 0), row(rows, columns, 1)],
        load: row(rows, columns, 2),
        shift: [row(rows, columns, 3), row(rows, columns, 4)],
        size: row(rows, columns, 5),
        before: [row(rows, columns, 6), row(rows, columns, 7)],
    };
    let recorded = RecordedStep { springs: &element.springs, memories, motion: &path.motion, record };
    tangent::step(&recorded, &motion, workspace.derivatives, workspace.scratch, [&mut *x, &mut *y]);
    let unit = element.friction_coefficient * element.normal_force;
    x.iter_mut().chain(y).for_each(|value| *value *= unit);
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
                    let (high, low) = (moved(h), moved(-h));
                    for i in 0..COEFFICIENTS {
                        let difference = (high[i] - low[i]) / (2.0 * h);
                        let exact = result.jacobian[i + COEFFICIENTS * j];
                        // Central differences: h² times the third derivative, 1e-12, and rounding over h, 1e-10 of the force.
                        let error = (difference - exact).abs() * scale / (0.4 * 1000.0);
                        assert!(error < 1e-6, "kind {kind}, entry {i} {j}: {difference:e} {exact:e}, error {error:e}");
                    }
                }
                assert!(result.dissipated > 0.0);
            }
        }
    }
}
