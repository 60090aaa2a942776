//! Harmonic force of a periodic motion in two tangential directions, by uniform sampling.
//!
//! The motion is u, v and the normal component (the approach w or the normal force N), each `c0 + Σ (a_k cos kt + b_k sin kt)`, at N
//! uniformly spaced instants from t = 0. Between the samples the path is that of a step of the element. Steady state: the element is
//! pressed by the normal force of the sample at which that is largest (the first such sample) with no tangential displacement, is
//! displaced to that sample at constant normal force, and advanced along a number of periods and one more from there, which counts. The
//! springs are aligned with the largest normal force.
//!
//! The Jacobian is the exact derivative of these steps: the derivatives of the state with respect to all coefficients are carried
//! along. Those of a step by parameters of the contact, the load at both ends and the alignment, are computed once; those by the
//! springs at its start are advanced for a few coefficients at once, and the former are added to them.

use super::contact::{Contact, Pressed};
use super::path::Path;
use super::scalar::{Dual, Linear};
use super::slip::Slips;
use super::step::{advance, bounded, derivatives, step};
use super::tables::{
    ALIGNMENT, Both, DualRows, END, Matrix, N, PARAMETERS, ROWS, Rows, START, Units, fill, under_flat,
};
use super::trial::{Derivatives, Motion, SPRINGS, Springs, Values, trial};
use crate::element::{Element, Normal};
use crate::error::Error;
use crate::fourier::workspace::{Layout, Parts, Size};
use crate::fourier::{angle, work};
use crate::limits::check_coefficients;
use crate::simd::{dispatch, plus};
use crate::tag::Kind;

pub use crate::fourier::HarmonicOutput;

/// Number of doubles in a workspace for the given number of harmonics and of samples per period; 0 if these are not allowed.
pub fn workspace_length(harmonics: usize, samples: usize) -> usize {
    Workspace::length_or_zero(Size { harmonics, samples, periods: 0 })
}

/// Initialises a workspace: tables for the given harmonics and samples, the number of periods before the one that counts (0: the
/// default, 3), and scratch memory.
/// Errors: `BadHarmonics` unless 1 <= harmonics <= 2^24, `BadSamples` unless 2 harmonics < samples <= 2^24, `BadPeriods` for more
/// than 65536; `WorkspaceTooShort`.
pub fn workspace_init(harmonics: usize, samples: usize, periods: usize, workspace: &mut [f64]) -> Result<(), Error> {
    Workspace::init(Size { harmonics, samples, periods }, workspace)
}

/// Relative distance of the sizes whose tables are differentiated: the error is the square of it times the third derivative, up to 1e5 where
/// nodes are close, and a rounding error over it.
const NEIGHBOUR: f64 = 1e-6;

/// Columns that are advanced at once, those of the normal component, of u and of v in a block each.
const COLUMNS: usize = 12;
type Columns = Dual<{ COLUMNS / 4 }>;

/// Doubles of a sample: the motion, the normal force and its derivative, and the tangential forces.
const SAMPLE: usize = 8;

/// An opened workspace.
#[derive(Debug)]
pub struct Workspace<'a> {
    size: Size,
    /// Values of `[1, cos t, sin t, ...]`, sample after sample.
    basis: &'a mut [f64],
    samples: &'a mut [[f64; SAMPLE]],
    /// Tables of the springs, their derivatives by the logarithm of the reference size, and those of a slightly smaller one.
    tables: &'a mut [Rows],
    /// Derivatives of the springs, and those of both forces, block after block of columns.
    derivatives: &'a mut [f64],
    forces: &'a mut [f64],
    sums: &'a mut [f64],
}

impl<'a> Layout<'a> for Workspace<'a> {
    const KIND: Kind = Kind::TwoDirectionsSampling;
    /// Static shear is shaken out over many periods: the table of `periods` in the guide has the errors.
    const PERIODS: usize = 3;

    fn max_rows(size: Size) -> usize {
        8 * size.samples + 256
    }

    fn take(size: Size, parts: &mut Parts<'a>) -> Result<Workspace<'a>, Error> {
        // One column for each coefficient of the motion, in whole blocks.
        let (columns, sums) = (COLUMNS * size.coefficients().div_ceil(COLUMNS / 3), 2 * size.coefficients());
        Ok(Workspace {
            size,
            basis: parts.take(size.coefficients() * size.samples)?,
            samples: parts.take(SAMPLE * size.samples)?.as_chunks_mut().0,
            tables: parts.take(3 * N * ROWS)?.as_chunks_mut::<N>().0.as_chunks_mut().0,
            derivatives: parts.take(SPRINGS * columns)?,
            forces: parts.take(2 * columns)?,
            sums: parts.take(sums * columns)?,
        })
    }

    fn fill(&mut self) {
        let samples = self.size.samples;
        for (sample, values) in self.basis.chunks_exact_mut(self.size.coefficients().max(1)).enumerate() {
            for (c, value) in values.iter_mut().enumerate() {
                let angle = angle(c.div_ceil(2), sample, samples);
                *value = if c % 2 == 0 && c > 0 { angle.sin() } else { angle.cos() };
            }
        }
    }
}

impl<'a> Workspace<'a> {
    /// Opens an initialised workspace.
    /// Errors: `BadWorkspace` if uninitialised or too short.
    pub fn new(memory: &'a mut [f64]) -> Result<Workspace<'a>, Error> {
        Workspace::open(memory)
    }

    /// 2H + 1.
    pub fn coefficients(&self) -> usize {
        self.size.coefficients()
    }

    /// Checks a motion: all of a batch are checked before the first output is written.
    /// Errors: those of [`harmonic_force`].
    pub(crate) fn check(&mut self, element: &Element, displacement: &[f64]) -> Result<(), Error> {
        check_coefficients(displacement)?;
        let input = displacement.get(2 * self.coefficients()..).unwrap_or(&[]);
        let mean = input.first().copied().unwrap_or(0.0);
        let amplitude: f64 = input.iter().skip(1).map(|value| value.abs()).sum();
        if (element.by_approach() || mean >= amplitude)
            && element.check_normal(element.by_approach(), mean + amplitude).is_ok()
        {
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
            element.check_normal(element.by_approach(), sample[2])?;
        }
        Ok(())
    }

    /// The displacement and the normal component at a sample.
    fn place(&self, index: usize) -> [f64; 3] {
        self.samples.get(index).map_or([0.0; 3], |[u, v, input, ..]| [*u, *v, *input])
    }
}

/// Harmonic force of a periodic motion, given by its 3 (2H + 1) coefficients: those of u, of v \[m\], and of the normal component, the
/// approach \[m\] or the normal force \[N\].
///
/// The force has 3 (2H + 1) coefficients \[N\], Tx, Ty, N. The Jacobian has (3 (2H + 1))² entries, column by column: their derivatives
/// with respect to the coefficients of the motion. The drift is the largest difference of the tangential force between the period that
/// counts and the one before, over μ times the largest normal force; 0 if the contact opens. The energy is the [`work`] of Tx and Ty.
/// Errors: `BadArraySize` if a length does not agree with the workspace; `BadDisplacement` if a coefficient is not finite or
/// exceeds 1e150; `BadNormalForce` if a sample of the normal force is negative by more than rounding; `LengthTooShort` if the
/// contact would become too wide for its length.
pub fn harmonic_force(
    element: &Element,
    workspace: &mut Workspace,
    displacement: &[f64],
    output: HarmonicOutput,
) -> Result<(), Error> {
    let n = workspace.coefficients();
    output.check(3 * n, displacement)?;
    workspace.synthesise(element, displacement)?;
    walk(element, workspace, displacement, output);
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

/// The walk along a motion that was synthesised.
struct Walk<'a> {
    element: &'a Element,
    units: Units,
    tables: DualRows<'a>,
    at: [f64; 3],
    /// The contact, its derivatives by the parameters, and its normal force.
    contact: Contact<f64>,
    derived: Option<Contact<Dual<1>>>,
    normal: Normal,
    springs: Values,
    slip: Slips,
    inverse: Both<Matrix>,
    /// Derivatives of the springs after a step by the parameters.
    by_parameters: [[f64; 4]; SPRINGS],
    /// The derivative of the logarithm of the reference size by the largest normal component.
    by_top: f64,
}

/// What a step gives besides the state.
struct Taken {
    force: Both<f64>,
    /// Springs at the start, the motion, and whether the contact was closed.
    old: Values,
    motion: Motion<f64, f64>,
    path: Path,
    /// The derivatives of S at the start by the normal component.
    before: Both<f64>,
    closed: [bool; 2],
}

impl<'a> Walk<'a> {
    /// Pressed by a normal component.
    fn new(element: &'a Element, units: Units, tables: DualRows<'a>, top: f64) -> Walk<'a> {
        let mut walk = Walk {
            element,
            units,
            tables,
            at: [0.0, 0.0, top],
            contact: Contact::default(),
            derived: None,
            normal: Normal::OPEN,
            springs: [[0.0; N]; SPRINGS / N],
            slip: Slips::default(),
            inverse: [[[0.0; N]; N]; 2],
            by_parameters: [[0.0; 4]; SPRINGS],
            by_top: 0.0,
        };
        walk.press(top);
        walk.by_top = if walk.normal.load >= walk.units.load * 0.99 { 0.5 * walk.contact.slopes.size } else { 0.0 };
        walk
    }

    /// Advances to a sample.
    fn advance(&mut self, to: [f64; 3], derivatives: bool) -> Taken {
        let (was_closed, closes) = (self.contact.now.load > 0.0, self.element.is_closed(to[2]));
        let closed = [was_closed, closes];
        let same = was_closed && to[2].to_bits() == self.at[2].to_bits();
        let path = Path::new(self.element, &self.units, [self.at, to], closed);
        let (from, old) = (self.contact, self.springs);
        let (before, constant_load) = (from.slopes.shift, same || !closes);
        let motion = Motion { before: from.now.shift, by: path.by, constant_load };
        self.at = to;
        if !closes {
            self.open();
            return Taken { force: [0.0; 2], old, motion, path, before, closed };
        }
        if !same {
            self.press(to[2]);
        }
        self.slip.trial = trial(self.tables.values, &self.contact, &motion, &old);
        self.slip.find(self.tables.values, &self.contact, &self.inverse, &motion, &old, derivatives);
        let contacts = [&from, &self.contact];
        let (force, _) = advance(self.tables.values, contacts, &motion, &self.slip, false, &mut self.springs);
        let force = bounded(force, self.contact.now.load);
        Taken { force, old, motion, path, before, closed }
    }

    /// The contact under a normal component that closes it.
    fn press(&mut self, input: f64) {
        self.normal = self.element.normal(input);
        let now = Pressed::new(self.element, &self.units, input, &self.normal);
        let under_flat = under_flat(self.element, &self.units);
        self.contact = Contact::press(self.tables.values, &now, under_flat, &mut self.inverse);
        self.derived = None;
    }

    /// Derivatives of the springs and the forces after a step between samples; those of forces are summed if the step counts.
    fn differentiate(
        &mut self,
        workspace: &mut Workspace,
        taken: &Taken,
        samples: [Option<usize>; 3],
        [fades, counts]: [bool; 2],
    ) {
        if taken.closed != [true, true] {
            workspace.derivatives.fill(0.0);
        } else if fades {
            fade(workspace.derivatives);
        }
        if taken.closed[1] {
            differentiate(workspace, self, taken, samples);
        } else {
            workspace.forces.fill(0.0);
        }
        if counts && let [_, Some(index), _] = samples {
            let basis = row(workspace.basis, workspace.size.coefficients(), index);
            accumulate(workspace.sums, basis, workspace.forces);
        }
    }

    fn open(&mut self) {
        (self.contact, self.springs, self.normal) = (Contact::default(), [[0.0; N]; SPRINGS / N], Normal::OPEN);
    }
}

/// Derivatives of the parameters of a contact by the coefficients of the normal component.
type Parameters = [[f64; 4]; PARAMETERS];

/// Columns, and what follows from the derivatives by the parameters of the contact.
#[inline(always)]
fn with_parameters(mut columns: Columns, slopes: &[f64; 4], parameters: &Parameters) -> Columns {
    for p in 0..PARAMETERS {
        columns.0[0] = plus(columns.0[0], slopes[p], parameters[p]);
    }
    columns
}

/// Columns of the springs in the workspace, beside the derivatives after a step by the parameters.
struct SpringColumns<'a> {
    columns: &'a mut [[[f64; 4]; COLUMNS / 4]; SPRINGS],
    slopes: &'a [[f64; 4]; SPRINGS],
    parameters: &'a Parameters,
}

impl Springs<Columns> for SpringColumns<'_> {
    #[inline(always)]
    fn get(&self, place: usize) -> Columns {
        self.columns.get(place).map_or(Dual::constant(0.0), |columns| Dual(*columns))
    }

    #[inline(always)]
    fn put(&mut self, place: usize, x: Columns) {
        if let (Some(there), Some(slopes)) = (self.columns.get_mut(place), self.slopes.get(place)) {
            *there = with_parameters(x, slopes, self.parameters).0;
        }
    }
}

/// Derivatives below are 0, after this number of steps: memory that fades would end in subnormal numbers, which are slow.
const LEAST_SLOPE: f64 = 1e-200;
const FADING: usize = 8;

fn fade(derivatives: &mut [f64]) {
    for x in derivatives {
        *x = if x.abs() > LEAST_SLOPE { *x } else { 0.0 };
    }
}

/// Tables of a slightly smaller reference size, and derivatives by its logarithm in place of the tables of a larger one.
fn derive_tables(element: &Element, units: &Units, [slopes, smaller]: [&mut Rows; 2]) {
    fill(slopes, element, units, 1.0 + NEIGHBOUR);
    fill(smaller, element, units, 1.0 - NEIGHBOUR);
    for (larger, smaller) in slopes.as_flattened_mut().iter_mut().zip(smaller.as_flattened()) {
        *larger = (*larger - smaller) * (0.5 / NEIGHBOUR);
    }
}

/// The normal forces of a motion that was synthesised.
fn without_friction(element: &Element, samples: &mut [[f64; SAMPLE]]) {
    for sample in samples {
        let normal = if element.is_closed(sample[2]) { element.normal(sample[2]) } else { Normal::OPEN };
        [sample[3], sample[4], sample[5], sample[6]] = [normal.load, normal.load_slope, 0.0, 0.0];
    }
}

/// The periods of a motion that was synthesised. Not inlined: its frame is not that of a call with one direction.
#[inline(never)]
fn walk(element: &Element, workspace: &mut Workspace, displacement: &[f64], output: HarmonicOutput) {
    let Size { samples: count, periods, .. } = workspace.size;
    let HarmonicOutput { force, jacobian, dissipated, drift } = output;
    let (largest, top) = first_of_largest_load(workspace);
    let slides = element.friction_coefficient > 0.0 && element.is_closed(top);
    let top_load = if slides { element.normal(top).load } else { element.normal_force };
    let units = Units::of(element, top_load);
    let unit = element.friction_coefficient * units.load;
    // A contact that opens forgets: whatever was before, the second period is the steady state.
    let opens = workspace.samples.iter().any(|sample| !element.is_closed(sample[2]));
    let periods = if opens { 1 } else { periods };
    let mut largest_change = 0.0f64;
    let memory = core::mem::take(&mut workspace.tables);
    if slides && let [tables, slopes, smaller] = &mut *memory {
        fill(tables, element, &units, 1.0);
        if jacobian.is_some() {
            derive_tables(element, &units, [slopes, smaller]);
            workspace.derivatives.fill(0.0);
            workspace.sums.fill(0.0);
        }
        let mut walk = Walk::new(element, units, DualRows { values: tables, slopes: (1.0, slopes) }, top);
        let mut before = None;
        for step in 0..=(periods + 1) * count {
            let index = (largest + step).checked_rem(count).unwrap_or(0);
            let counts = step > periods * count;
            let taken = walk.advance(workspace.place(index), jacobian.is_some());
            if jacobian.is_some() {
                let fades = step % FADING == 0;
                walk.differentiate(workspace, &taken, [before, Some(index), Some(largest)], [fades, counts]);
            }
            before = Some(index);
            if let Some(sample) = workspace.samples.get_mut(index) {
                let [x, y] = taken.force.map(|force| unit * force);
                let change = (x - sample[5]).powi(2) + (y - sample[6]).powi(2);
                largest_change = if counts { largest_change.max(change) } else { 0.0 };
                [sample[3], sample[4], sample[5], sample[6]] = [walk.normal.load, walk.normal.load_slope, x, y];
            }
        }
    } else {
        without_friction(element, workspace.samples);
    }
    workspace.tables = memory;
    if let Some(jacobian) = jacobian {
        write_jacobian(workspace, slides.then_some(unit), jacobian);
    }
    // The sums serve the Jacobian only, and have more than as many places as the force.
    let (sums, n) = (core::mem::take(&mut workspace.sums), workspace.coefficients());
    if let Some(force) = force.or(sums.get_mut(..3 * n).filter(|_| dissipated.is_some())) {
        write_force(workspace, force);
        if let Some(dissipated) = dissipated {
            *dissipated = work(n, displacement.get(..2 * n).unwrap_or(&[]), force);
        }
    }
    workspace.sums = sums;
    if let Some(drift) = drift {
        let slip_force = (element.friction_coefficient * top_load).max(f64::MIN_POSITIVE);
        *drift = if slides && !opens { largest_change.sqrt() / slip_force } else { 0.0 };
    }
}

fn write_force(workspace: &Workspace, force: &mut [f64]) {
    let (n, per_sample) = (workspace.coefficients(), 1.0 / workspace.size.samples as f64);
    force.fill(0.0);
    for (sample, basis) in workspace.samples.iter().zip(workspace.basis.chunks_exact(n)) {
        let [_, _, _, load, _, x, y, _] = *sample;
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
    let columns = workspace.forces.len() / 2;
    let weight = |c: usize| if c == 0 { per_sample } else { 2.0 * per_sample };
    let lane = |j: usize| {
        let (component, coefficient) = ((j / n + 1) % 3, j % n);
        coefficient / 4 * COLUMNS + component * 4 + coefficient % 4
    };
    for (j, column) in jacobian.chunks_exact_mut(3 * n).enumerate() {
        for (c, place) in column.iter_mut().enumerate().take(2 * n) {
            let sum = workspace.sums.get(c * columns + lane(j)).copied().unwrap_or(0.0);
            *place = unit.map_or(0.0, |unit| unit * weight(c % n) * sum);
        }
        column.iter_mut().skip(2 * n).for_each(|place| *place = 0.0);
    }
    for (sample, basis) in workspace.samples.iter().zip(workspace.basis.chunks_exact(n)) {
        let slope = sample[4];
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
    dispatch!({
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
    });
}

/// Derivatives of the springs and of the tangential forces at the end of a step between samples.
fn differentiate(workspace: &mut Workspace, walk: &mut Walk, taken: &Taken, samples: [Option<usize>; 3]) {
    let n = workspace.coefficients();
    let [start, end, top] = samples.map(|index| index.map_or(&[][..], |index| row(workspace.basis, n, index)));
    let at = |basis: &[f64], c: usize| basis.get(c).copied().unwrap_or(0.0);
    let per_scale = 1.0 / walk.element.input_scale();
    let Taken { motion, path, before, old, .. } = taken;
    let derived = walk.derived.get_or_insert_with(|| walk.contact.derived(&walk.tables, true));
    let mut dual = Motion {
        before: motion.before.map(Dual::constant),
        by: motion.by.map(Dual::constant),
        constant_load: motion.constant_load,
    };
    dual.before.iter_mut().zip(*before).for_each(|(shift, slope)| shift.0[0][START] = slope);
    let slopes = &mut walk.by_parameters;
    let force = derivatives(
        &walk.tables,
        (derived, &walk.inverse),
        &dual,
        &walk.slip,
        &mut Derivatives { values: old, slopes },
    );
    // What the bound makes of derivatives of the force.
    let [x, y] = force.map(|force| force.value());
    let within =
        bounded([Dual([[1.0, 0.0, 0.0, x]]), Dual([[0.0, 1.0, 0.0, y]])], Dual::constant(walk.contact.now.load));
    let force = bounded(force, derived.now.load);
    let (forces_x, forces_y) = workspace.forces.split_at_mut(workspace.forces.len() / 2);
    let blocks = workspace.derivatives.as_chunks_mut::<4>().0.as_chunks_mut::<{ COLUMNS / 4 }>().0;
    let memories = blocks.as_chunks_mut::<SPRINGS>().0.iter_mut();
    let [forces_x, forces_y] = [forces_x, forces_y].map(|forces| forces.as_chunks_mut::<4>().0.as_chunks_mut().0);
    for (block, (columns, (to_x, to_y))) in memories.zip(forces_x.iter_mut().zip(forces_y)).enumerate() {
        let (mut by, mut parameters) = ([Columns::constant(0.0); 2], [[0.0; 4]; PARAMETERS]);
        for lane in 0..4.min(n - 4 * block) {
            let (from, to) = (at(start, 4 * block + lane), at(end, 4 * block + lane));
            for k in 0..2 {
                by[k].0[0][lane] = path.per_input[k][0] * (per_scale * from) + path.per_input[k][1] * (per_scale * to);
                by[k].0[1 + k][lane] = path.per_distance * (to - from);
            }
            // The load at the start of the first step is that of the largest one.
            let [from, to, top] = [from, to, at(top, 4 * block + lane)].map(|input| per_scale * input);
            parameters[START][lane] = if start.is_empty() { top } else { from };
            (parameters[END][lane], parameters[ALIGNMENT][lane]) = (to, walk.by_top * top);
        }
        let motion = Motion { before: motion.before, by, constant_load: motion.constant_load };
        let mut springs = SpringColumns { columns, slopes, parameters: &parameters };
        let (rows, contact, slip) = (walk.tables.values, (&walk.contact, &walk.inverse), &walk.slip);
        let [x, y] = dispatch!(step(&rows, contact, &motion, slip, &mut springs));
        for (k, to) in [to_x, to_y].into_iter().enumerate() {
            let [by_x, by_y, ..] = within[k].0[0];
            *to = with_parameters(x.scale(by_x) + y.scale(by_y), &force[k].0[0], &parameters).0;
        }
    }
}
