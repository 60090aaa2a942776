//! Harmonic force of a periodic motion in two tangential directions, by uniform sampling.
//!
//! The motion is u, v and the normal component (the approach w or the normal force N), each `c0 + Σ (a_k cos kt + b_k sin kt)`, at N
//! uniformly spaced instants from t = 0. Between the samples the path is that of a step of the element. Steady state: the element is
//! pressed by the normal force of the sample at which that is largest (the first such sample) with no tangential displacement, is
//! displaced to that sample at constant normal force, and advanced along a number of periods and one more from there, which counts. The
//! springs are aligned with the largest normal force.
//!
//! The Jacobian is the exact derivative of these steps: the derivatives of the state with respect to all coefficients are carried
//! along. The tables and the contact have derivatives by the load at both ends of a step and by the alignment, the springs by the
//! coefficients too, to which the former are added after each step.

use super::Requested;
use super::contact::{Contact, Pressed, derive};
use super::path::Path;
use super::scalar::{Dual, Real};
use super::slip::Slips;
use super::step::{advance, bounded, separated, step};
use super::tables::{ALIGNMENT, Both, DualRows, END, N, PARAMETERS, ROWS, Rows, START, Units, fill, under_flat};
use super::trial::{Motion, SPRINGS, Springs, Values, trial};
use crate::element::{Element, Normal};
use crate::error::Error;
use crate::fourier::angle;
use crate::fourier::workspace::{Layout, Parts, Size};
use crate::limits::check_coefficients;
use crate::simd::{dispatch, has_avx2, on_avx2_only, plus};
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

/// Columns that are advanced at once: for one harmonic and without AVX2, and for more harmonics.
const NARROW: usize = 12;
const WIDE: usize = 36;

/// Doubles of a sample: the motion, the normal force and its derivative, and the tangential forces.
const SAMPLE: usize = 8;

/// An opened workspace.
#[derive(Debug)]
pub struct Workspace<'a> {
    size: Size,
    /// Columns that are advanced at once.
    lanes: usize,
    /// Values of `[1, cos t, sin t, ...]`, sample after sample.
    basis: &'a mut [f64],
    samples: &'a mut [[f64; SAMPLE]],
    /// Tables of the springs, those of a slightly larger and a smaller reference size, and with the derivatives by its logarithm.
    tables: &'a mut [Rows],
    dual_tables: &'a mut [DualRows],
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
        // One column for each coefficient of the motion, in whole blocks: in each, those of the normal component, of u and of v.
        let columns = |lanes: usize| lanes * size.coefficients().div_ceil(lanes / 3);
        let widest = if 3 * size.coefficients() <= NARROW { NARROW } else { WIDE };
        let lanes = if has_avx2() { widest } else { NARROW };
        let (reserved, columns, sums) = (columns(widest), columns(lanes), 2 * size.coefficients());
        let first = |count: usize, values: &'a mut [f64]| values.get_mut(..count).unwrap_or(&mut []);
        Ok(Workspace {
            size,
            lanes,
            basis: parts.take(size.coefficients() * size.samples)?,
            samples: parts.take(SAMPLE * size.samples)?.as_chunks_mut().0,
            tables: parts.take(3 * N * ROWS)?.as_chunks_mut::<N>().0.as_chunks_mut().0,
            dual_tables: parts.take(4 * N * ROWS)?.as_chunks_mut().0.as_chunks_mut::<N>().0.as_chunks_mut().0,
            derivatives: first(SPRINGS * columns, parts.take(SPRINGS * reserved)?),
            forces: first(2 * columns, parts.take(2 * reserved)?),
            sums: first(sums * columns, parts.take(sums * reserved)?),
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
/// counts and the one before, over μ times the largest normal force; 0 if the contact opens.
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
    walk(element, workspace, output);
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
    tables: &'a Rows,
    dual_tables: &'a DualRows,
    at: [f64; 3],
    /// The contact, its derivatives by the normal component, those with respect to parameters, and its normal force.
    contact: Contact<f64>,
    slopes: Pressed<f64>,
    derived: Option<Contact<Dual<1>>>,
    normal: Normal,
    springs: Values,
    slip: Slips,
    inverse: Both<super::tables::Matrix>,
    /// The derivative of the logarithm of the reference size by the largest normal component.
    by_top: f64,
}

/// What a step gives besides the state.
struct Taken {
    force: Both<f64>,
    dissipated: f64,
    /// Springs at the start, the motion, and whether the contact was closed.
    old: Values,
    motion: Motion<f64, f64>,
    path: Path,
    /// The derivatives of the state before, by the normal component.
    before: Pressed<f64>,
    closed: [bool; 2],
}

impl<'a> Walk<'a> {
    /// Pressed by a normal component.
    fn new(element: &'a Element, units: Units, tables: (&'a Rows, &'a DualRows), top: f64) -> Walk<'a> {
        let mut walk = Walk {
            element,
            units,
            tables: tables.0,
            dual_tables: tables.1,
            at: [0.0, 0.0, top],
            contact: Contact::NONE,
            slopes: Pressed::NONE,
            derived: None,
            normal: Normal::OPEN,
            springs: [[0.0; N]; SPRINGS / N],
            slip: Slips::NONE,
            inverse: [[[0.0; N]; N]; 2],
            by_top: 0.0,
        };
        walk.press(top);
        walk.by_top = if walk.normal.load >= walk.units.load * 0.99 { 0.5 * walk.slopes.size } else { 0.0 };
        walk
    }

    /// Advances to a sample.
    fn advance(&mut self, to: [f64; 3], requested: Requested) -> Taken {
        let (was_closed, closes) = (self.contact.now.load > 0.0, self.element.is_closed(to[2]));
        let closed = [was_closed, closes];
        let same = was_closed && to[2].to_bits() == self.at[2].to_bits();
        let path = Path::new(self.element, &self.units, [self.at, to], closed);
        let (from, old, before) = (self.contact, self.springs, if was_closed { self.slopes } else { Pressed::NONE });
        self.at = to;
        if !closes {
            let energy = was_closed && requested.energy;
            let dissipated = if energy { separated(self.tables, &from, &Pressed::NONE, path.by, &old) } else { 0.0 };
            self.open();
            let motion = path.motion(&from, &from, true);
            return Taken { force: [0.0; 2], dissipated: dissipated * path.scale, old, motion, path, before, closed };
        }
        if !same {
            self.press(to[2]);
        }
        let motion = path.motion(&from, &self.contact, same);
        let trial = trial(self.tables, &self.contact, &motion, &old);
        self.slip.find(self.tables, &self.contact, &self.inverse, &motion, (&trial, &old), requested.tangent);
        let contacts = [&from, &self.contact];
        let (force, dissipated) =
            advance(self.tables, contacts, &motion, &self.slip, requested.energy, &mut self.springs);
        let force = bounded(force, self.contact.now.load);
        Taken { force, dissipated: dissipated * path.scale, old, motion, path, before, closed }
    }

    /// The contact under a normal component that closes it.
    fn press(&mut self, input: f64) {
        self.normal = self.element.normal(input);
        let now;
        [now, self.slopes] = Pressed::new(self.element, &self.units, input, &self.normal);
        let under_flat = under_flat(self.element, &self.units);
        self.contact = Contact::press(self.tables, &now, under_flat, &mut self.inverse);
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
        if !taken.closed[1] {
            workspace.forces.fill(0.0);
        } else if workspace.lanes == NARROW {
            differentiate::<{ NARROW / 4 }, { NARROW / 4 + 1 }>(workspace, self, taken, samples);
        } else {
            differentiate::<{ WIDE / 4 }, { WIDE / 4 + 1 }>(workspace, self, taken, samples);
        }
        if counts && let [_, Some(index), _] = samples {
            let basis = row(workspace.basis, workspace.size.coefficients(), index);
            accumulate(workspace.sums, basis, workspace.forces);
        }
    }

    fn open(&mut self) {
        (self.contact, self.springs, self.normal) = (Contact::NONE, [[0.0; N]; SPRINGS / N], Normal::OPEN);
    }
}

/// Columns of the springs in the workspace, beside their values at the start of a step.
struct Columns<'a, const L: usize> {
    values: &'a Values,
    springs: &'a mut [[[f64; 4]; L]; SPRINGS],
    /// Derivatives of the parameters of a contact by the coefficients.
    parameters: &'a [[[f64; 4]; L]; PARAMETERS],
}

impl<const L: usize> Columns<'_, L> {
    /// Columns of a number: derivatives by the parameters, which are in its first block, are added.
    #[inline(always)]
    fn of<const M: usize>(&self, x: &Dual<M>) -> [[f64; 4]; L] {
        let mut columns = [[0.0; 4]; L];
        for (column, slopes) in columns.iter_mut().zip(x.0.iter().skip(1)) {
            *column = *slopes;
        }
        let slopes = &x.0[0];
        for p in 0..PARAMETERS {
            for c in 0..L / 3 {
                columns[c] = plus(columns[c], slopes[p], self.parameters[p][c]);
            }
        }
        columns
    }
}

/// With a block of the parameters: M = L + 1.
impl<const L: usize, const M: usize> Springs<Dual<M>> for Columns<'_, L> {
    const KEPT: bool = true;

    #[inline(always)]
    fn get(&self, place: usize) -> Dual<M> {
        let mut dual = Dual::constant(0.0);
        if let (Some(value), Some(columns)) = (self.values.as_flattened().get(place), self.springs.get(place)) {
            dual = Dual::constant(*value);
            for (slopes, column) in dual.0.iter_mut().skip(1).zip(columns) {
                *slopes = *column;
            }
        }
        dual
    }

    #[inline(always)]
    fn put(&mut self, place: usize, x: Dual<M>) {
        let columns = self.of(&x);
        if let Some(place) = self.springs.get_mut(place) {
            *place = columns;
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

/// A step in columns: the derivatives of both forces. Many columns have long code, which exists for AVX2 only.
fn columns<const L: usize, const M: usize>(
    tables: &DualRows,
    contact: &Contact<Dual<1>>,
    motion: &Motion<Dual<1>, Dual<M>>,
    slip: &Slips,
    springs: &mut Columns<L>,
) -> Both<[[f64; 4]; L]> {
    if 4 * L > NARROW {
        let forces = on_avx2_only(
            #[inline(always)]
            || columns_kernel(tables, contact, motion, slip, springs),
        );
        return forces.unwrap_or([[[0.0; 4]; L]; 2]);
    }
    dispatch!(columns_kernel(tables, contact, motion, slip, springs))
}

#[inline(always)]
fn columns_kernel<const L: usize, const M: usize>(
    tables: &DualRows,
    contact: &Contact<Dual<1>>,
    motion: &Motion<Dual<1>, Dual<M>>,
    slip: &Slips,
    springs: &mut Columns<L>,
) -> Both<[[f64; 4]; L]> {
    let force = step(&tables, contact, motion, slip, springs);
    [springs.of(&force[0]), springs.of(&force[1])]
}

/// Tables with their derivatives by the logarithm of the reference size, from those of a slightly larger and a smaller one.
fn derive_tables(
    element: &Element,
    units: &Units,
    tables: &Rows,
    [larger, smaller]: [&mut Rows; 2],
    dual_tables: &mut DualRows,
) {
    fill(larger, element, units, 1.0 + NEIGHBOUR);
    fill(smaller, element, units, 1.0 - NEIGHBOUR);
    let neighbours = larger.as_flattened().iter().zip(smaller.as_flattened());
    let places = dual_tables.as_flattened_mut().iter_mut().zip(tables.as_flattened());
    for ((place, value), (larger, smaller)) in places.zip(neighbours) {
        let mut dual = Dual::<1>::constant(*value);
        dual.0[0][ALIGNMENT] = (larger - smaller) * (0.5 / NEIGHBOUR);
        [*place] = dual.0;
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
fn walk(element: &Element, workspace: &mut Workspace, output: HarmonicOutput) {
    let Size { samples: count, periods, .. } = workspace.size;
    let HarmonicOutput { force, jacobian, dissipated, drift } = output;
    let requested = Requested { tangent: jacobian.is_some(), energy: dissipated.is_some() };
    let (largest, top) = first_of_largest_load(workspace);
    let slides = element.friction_coefficient > 0.0 && element.is_closed(top);
    let top_load = if slides { element.normal(top).load } else { element.normal_force };
    let units = Units::of(element, top_load);
    let unit = element.friction_coefficient * units.load;
    // A contact that opens forgets: whatever was before, the second period is the steady state.
    let opens = workspace.samples.iter().any(|sample| !element.is_closed(sample[2]));
    let periods = if opens { 1 } else { periods };
    let (mut energy, mut largest_change) = (0.0, 0.0f64);
    let memory = (core::mem::take(&mut workspace.tables), core::mem::take(&mut workspace.dual_tables));
    if slides && let ([tables, larger, smaller, ..], [dual_tables, ..]) = (&mut *memory.0, &mut *memory.1) {
        fill(tables, element, &units, 1.0);
        if requested.tangent {
            derive_tables(element, &units, tables, [larger, smaller], dual_tables);
            workspace.derivatives.fill(0.0);
            workspace.sums.fill(0.0);
        }
        let mut walk = Walk::new(element, units, (tables, dual_tables), top);
        let mut before = None;
        for step in 0..=(periods + 1) * count {
            let index = (largest + step).checked_rem(count).unwrap_or(0);
            let counts = step > periods * count;
            let taken =
                walk.advance(workspace.place(index), Requested { energy: requested.energy && counts, ..requested });
            if requested.tangent {
                let fades = step % FADING == 0;
                walk.differentiate(workspace, &taken, [before, Some(index), Some(largest)], [fades, counts]);
            }
            before = Some(index);
            energy += taken.dissipated;
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
    (workspace.tables, workspace.dual_tables) = memory;
    if let Some(dissipated) = dissipated {
        *dissipated = energy * unit * element.friction_coefficient * units.shift;
    }
    if let Some(force) = force {
        write_force(workspace, force);
    }
    if let Some(jacobian) = jacobian {
        write_jacobian(workspace, slides.then_some(unit), jacobian);
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
    let lanes = if workspace.lanes == NARROW { NARROW } else { WIDE };
    let lane = |j: usize| {
        let (component, coefficient) = ((j / n + 1) % 3, j % n);
        coefficient / (lanes / 3) * lanes + component * (lanes / 3) + coefficient % (lanes / 3)
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
fn differentiate<const L: usize, const M: usize>(
    workspace: &mut Workspace,
    walk: &mut Walk,
    taken: &Taken,
    samples: [Option<usize>; 3],
) {
    let n = workspace.coefficients();
    let [start, end, top] = samples.map(|index| index.map_or(&[][..], |index| row(workspace.basis, n, index)));
    let at = |basis: &[f64], c: usize| basis.get(c).copied().unwrap_or(0.0);
    let per_scale = 1.0 / walk.element.input_scale();
    let Taken { motion, path, before, old, .. } = taken;
    if walk.derived.is_none() {
        walk.derived = Some(derive(&walk.contact, walk.dual_tables, &walk.slopes));
    }
    let Some(contact) = &walk.derived else { return };
    let mut shift = motion.before.map(Dual::constant);
    shift.iter_mut().zip(before.shift).for_each(|(shift, slope)| shift.0[0][START] = slope);
    let (forces_x, forces_y) = workspace.forces.split_at_mut(workspace.forces.len() / 2);
    let blocks = workspace.derivatives.as_chunks_mut::<4>().0.as_chunks_mut::<L>().0;
    let memories = blocks.as_chunks_mut::<SPRINGS>().0.iter_mut();
    let [forces_x, forces_y] = [forces_x, forces_y].map(|forces| forces.as_chunks_mut::<4>().0.as_chunks_mut().0);
    for (block, (memory, (x, y))) in memories.zip(forces_x.iter_mut().zip(forces_y)).enumerate() {
        let mut by = motion.by.map(Dual::<M>::constant);
        let mut parameters = [[[0.0; 4]; L]; PARAMETERS];
        let each = 4 * L / 3;
        for c in 0..each.min(n - block * each) {
            let (coefficient, part, lane) = (block * each + c, c / 4, c % 4);
            let (from, to) = (at(start, coefficient), at(end, coefficient));
            for k in 0..2 {
                by[k].0[1 + part][lane] =
                    path.per_input[k][0] * (per_scale * from) + path.per_input[k][1] * (per_scale * to);
                by[k].0[1 + (1 + k) * (L / 3) + part][lane] = path.per_distance * (to - from);
            }
            // The load at the start of the first step is that of the largest one.
            let [from, to, top] = [from, to, at(top, coefficient)].map(|input| per_scale * input);
            parameters[START][part][lane] = if start.is_empty() { top } else { from };
            (parameters[END][part][lane], parameters[ALIGNMENT][part][lane]) = (to, walk.by_top * top);
        }
        let motion = Motion { before: shift, by, constant_load: motion.constant_load };
        let mut springs = Columns { values: old, springs: memory, parameters: &parameters };
        [*x, *y] = columns(walk.dual_tables, contact, &motion, &walk.slip, &mut springs);
    }
}
