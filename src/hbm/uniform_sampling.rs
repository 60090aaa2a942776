//! Harmonic force by alternating between frequency and time.
//!
//! The displacement is sampled at equidistant instants, the contact is led through them, and its forces are transformed back.
//! The Jacobian follows the memory exactly:
//!
//! ```text
//! J = Σ φ ⊗ dT = Σ k φ ⊗ φ - Σ_r (Σ k φ) ⊗ φ_r + Σ_r (Σ φ) ⊗ dT_r,
//! ```
//!
//! the inner sums over the samples on one branch. The first sum is made of the Fourier sums of k up to the order 2H, the last
//! is geometric.

use super::fourier::{complete_jacobian, fill_columns, sample, scale};
use super::fourier_sums::{Rows, Sums, blocks, fill_table};
use super::workspace::{Blocks, HEADER, Parts, Size, WorkspaceLayout, padded};
use super::{HarmonicOutput, Requested};
use crate::error::Error;
use crate::law::{BranchRange, Evaluator, Law, Point, Response, Reversal};
use crate::tag::Kind;
use core::f64::consts::PI;

/// Doubles of the parts of a workspace.
pub(super) struct Layout(Size);

impl Layout {
    /// Samples after which the tables repeat, but for the sign of odd orders: half a period if it has a middle.
    fn half(&self) -> usize {
        if self.0.samples.is_multiple_of(2) { self.0.samples / 2 } else { self.0.samples }
    }

    /// A period nests at most as many reversals as it has samples.
    fn reversals(&self) -> usize {
        self.0.samples + 1
    }
}

impl WorkspaceLayout for Layout {
    const KIND: Kind = Kind::UniformSampling;

    fn of(size: Size) -> Layout {
        Layout(size)
    }

    fn size(&self) -> Size {
        self.0
    }

    fn rows(&self) -> usize {
        self.0.samples + 8
    }

    fn tables(&self) -> usize {
        let (half, up_to_2h) = (self.half(), 4 * blocks(2 * self.0.harmonics));
        padded(half * self.0.coefficients()) + 2 * padded(half * up_to_2h) + padded(self.0.harmonics)
    }

    fn length(&self) -> usize {
        let (n, reversals) = (self.0.coefficients(), self.reversals());
        let sums = 2 * 4 * blocks(self.0.harmonics) + 4 * 4 * blocks(2 * self.0.harmonics);
        let stack = padded(3 * reversals) + padded(reversals) + padded(reversals * n);
        HEADER + self.tables() + 3 * padded(self.0.samples) + stack + sums + 4 * padded(n)
    }

    fn fill_tables(&self, tables: &mut Parts) -> Result<(), Error> {
        let (Size { harmonics, samples }, half) = (self.0, self.half());
        fill_columns(tables.take(half * self.0.coefficients())?, samples, half);
        for parity in [0, 1] {
            let table = tables.take_blocks(half * blocks(2 * harmonics))?;
            fill_table(table, parity, 2 * harmonics, samples, half);
        }
        // 1/(exp(imΔ) - 1) = -1/2 - (i/2) cot(mΔ/2), Δ one step.
        for (m, cotangent) in (1..).zip(tables.take(harmonics)?) {
            let (sine, cosine) = (PI * m as f64 / samples as f64).sin_cos();
            *cotangent = 0.5 * cosine / sine;
        }
        Ok(())
    }
}

/// A workspace as it is used.
#[derive(Debug)]
pub(super) struct Workspace<'a> {
    /// The stack of reversals of the law.
    reversals: &'a mut [Reversal],
    buffers: Buffers<'a>,
}

/// Tables, samples and sums.
#[derive(Debug)]
struct Buffers<'a> {
    harmonics: usize,
    samples: usize,
    half: usize,
    /// Over the samples of half a period, for each coefficient: 1, cos t, sin t, cos 2t, ...
    columns: &'a [f64],
    /// Even and odd orders up to 2H, four numbers of each sample together, over the samples of half a period.
    tables: [&'a Blocks; 2],
    /// cot(π m/samples)/2 for the orders m.
    cotangents: &'a [f64],
    displacement: &'a mut [f64],
    force: &'a mut [f64],
    stiffness: &'a mut [f64],
    /// Sample of each reversal.
    reversed_at: &'a mut [f64],
    /// dT_r of each reversal, a row over the coefficients.
    gradients: &'a mut [f64],
    /// Fourier sums: of the force, of the stiffness on one branch and on all.
    force_sums: Sums<'a>,
    branch_sums: Sums<'a>,
    stiffness_sums: Sums<'a>,
    /// Rows over the coefficients: φ_r, Σ φ and Σ k φ of a branch, and one more.
    start: &'a mut [f64],
    waves: &'a mut [f64],
    weighted: &'a mut [f64],
    row: &'a mut [f64],
}

impl<'a> Workspace<'a> {
    /// Takes a prepared workspace into use.
    ///
    /// # Errors
    /// `BadWorkspace` for memory that was not initialised, or was changed.
    #[inline(always)]
    pub fn new(workspace: &'a mut [f64]) -> Result<Workspace<'a>, Error> {
        let (layout, mut parts) = Layout::open(workspace)?;
        let (half, coefficients) = (layout.half(), layout.0.coefficients());
        let (up_to_h, up_to_2h) = (blocks(layout.0.harmonics), blocks(2 * layout.0.harmonics));
        let buffers = Buffers {
            harmonics: layout.0.harmonics,
            samples: layout.0.samples,
            half,
            columns: parts.take(half * coefficients)?,
            tables: [parts.take_blocks(half * up_to_2h)?, parts.take_blocks(half * up_to_2h)?],
            cotangents: parts.take(layout.0.harmonics)?,
            displacement: parts.take(layout.0.samples)?,
            force: parts.take(layout.0.samples)?,
            stiffness: parts.take(layout.0.samples)?,
            reversed_at: parts.take(layout.reversals())?,
            gradients: parts.take(layout.reversals() * coefficients)?,
            force_sums: Sums([parts.take_blocks(up_to_h)?, parts.take_blocks(up_to_h)?]),
            branch_sums: Sums([parts.take_blocks(up_to_2h)?, parts.take_blocks(up_to_2h)?]),
            stiffness_sums: Sums([parts.take_blocks(up_to_2h)?, parts.take_blocks(up_to_2h)?]),
            start: parts.take(coefficients)?,
            waves: parts.take(coefficients)?,
            weighted: parts.take(coefficients)?,
            row: parts.take(coefficients)?,
        };
        Ok(Workspace { reversals: parts.take(3 * layout.reversals())?.as_chunks_mut().0, buffers })
    }

    /// 2H + 1.
    pub fn coefficients(&self) -> usize {
        self.buffers.coefficients()
    }
}

/// The requested outputs.
#[inline(always)]
pub(super) fn harmonic_force<'w, L: Law>(
    law: impl FnOnce(&'w mut [Reversal], bool) -> L,
    workspace: &'w mut Workspace,
    displacement: &[f64],
    output: HarmonicOutput,
) {
    let Workspace { reversals, buffers } = workspace;
    let requested = output.requested();
    let HarmonicOutput { force, mut jacobian, dissipated } = output;
    let half_wave_symmetric = sample(buffers.columns, buffers.half, buffers.displacement, displacement);
    let law = law(reversals, dissipated.is_some());
    let mut walk = Walk { law, requested, half_wave_symmetric };
    walk.through_period(buffers, &mut jacobian);
    if let (Some(dissipated), Some(energy)) = (dissipated, walk.law.dissipated()) {
        *dissipated = if half_wave_symmetric { 2.0 * energy } else { energy };
    }
    // The second half of the period counts as much as the first.
    let mean = if half_wave_symmetric { 2.0 } else { 1.0 } / buffers.samples as f64;
    if let Some(force) = force {
        buffers.force_sums.copy_to(force);
        scale(force, mean);
    }
    if let Some(jacobian) = jacobian {
        let sums = |order| buffers.stiffness_sums.of_order(order);
        complete_jacobian(jacobian, buffers.harmonics, sums, mean, half_wave_symmetric);
    }
}

/// Length of the run of values, `limit` at most, before the first that `ends` the run; and the last value of the run.
#[inline(always)]
fn run(parts: [&[f64]; 2], limit: usize, first: f64, ends: impl Fn(f64, f64) -> bool) -> (usize, f64) {
    let (mut last, mut count) = (first, 0);
    for part in parts {
        for &next in part.get(..limit - count).unwrap_or(part) {
            if ends(last, next) {
                return (count, last);
            }
            last = next;
            count += 1;
        }
    }
    (count, last)
}

/// The period, sample by sample.
struct Walk<L> {
    law: L,
    requested: Requested,
    /// Only one half of the period is evaluated.
    half_wave_symmetric: bool,
}

impl<L: Law> Walk<L> {
    /// Advances from the farthest sample through a period, or half of it: the Fourier sums, and the contribution of each reversal
    /// to the Jacobian.
    #[inline(always)]
    fn through_period(&mut self, buffers: &mut Buffers, jacobian: &mut Option<&mut [f64]>) {
        let samples = buffers.samples;
        let after = |sample: usize| if sample + 1 >= samples { 0 } else { sample + 1 };
        let mut remaining = if self.half_wave_symmetric { buffers.half } else { samples };
        let mut before = buffers.farthest(remaining);
        self.begin(buffers, before);
        buffers.force_sums.clear();
        buffers.stiffness_sums.clear();
        while remaining > 0 {
            let sample = after(before);
            self.step(buffers, before, sample);
            let count = 1 + self.samples_on_branch(buffers.displacement, sample, remaining - 1);
            before = self.evaluate_branch(buffers, sample, count, jacobian);
            remaining -= count;
        }
    }

    /// Number of samples after `sample`, `limit` at most, that lie on the same branch.
    #[inline(always)]
    fn samples_on_branch(&mut self, displacement: &[f64], sample: usize, limit: usize) -> usize {
        let (behind, ahead) = displacement.split_at_checked(sample + 1).unwrap_or((displacement, &[]));
        let entered = behind.last().copied().unwrap_or(0.0);
        let BranchRange { direction, end, .. } = self.law.branch();
        let (count, last) = if direction > 0.0 {
            run([ahead, behind], limit, entered, |last, next| next < last || next >= end)
        } else {
            run([ahead, behind], limit, entered, |last, next| next > last || next <= end)
        };
        if count > 0 {
            self.law.account_for(entered, last);
        }
        count
    }

    /// Force and stiffness at the farthest sample.
    #[inline(always)]
    fn begin(&mut self, buffers: &mut Buffers, sample: usize) {
        let displacement = buffers.displacement.get(sample).copied().unwrap_or(0.0);
        let response = self.law.begin(displacement);
        if let (Some(force), Some(stiffness)) = (buffers.force.get_mut(sample), buffers.stiffness.get_mut(sample)) {
            Response { force: *force, stiffness: *stiffness } = response;
        }
    }

    /// Applies one step, which may reverse, close loops or slip.
    #[inline(always)]
    fn step(&mut self, buffers: &mut Buffers, before: usize, sample: usize) {
        let displacement = |sample: usize| buffers.displacement.get(sample).copied().unwrap_or(0.0);
        let force = buffers.force.get(before).copied().unwrap_or(0.0);
        let from = Point { displacement: displacement(before), force };
        let left = self.law.branch().depth;
        if self.law.advance(from, displacement(sample)) {
            // The point lies on the branch that was left, one reversal deeper.
            buffers.store_reversal(before, left, self.law.branch().depth - 1, self.requested.stiffness);
        }
    }

    /// Force and stiffness of `count` consecutive samples on the branch, their Fourier sums, and the contribution of the branch to
    /// the Jacobian beyond `Σ k φ ⊗ φ`; the last of the samples.
    #[inline(always)]
    fn evaluate_branch(
        &self,
        buffers: &mut Buffers,
        first: usize,
        count: usize,
        jacobian: &mut Option<&mut [f64]>,
    ) -> usize {
        let (branch, requested) = (self.law.branch(), self.requested);
        let evaluator = self.law.evaluator();
        let (mut next, mut remaining) = (first, count);
        if requested.stiffness && !branch.gross_slip {
            buffers.branch_sums.clear();
        }
        while remaining > 0 {
            // Neither across the middle of the period, where the tables start again, nor across its end.
            let boundary = if next < buffers.half { buffers.half } else { buffers.samples };
            let rows = Rows::of(next, buffers.half);
            let range = next..boundary.min(next + remaining);
            let length = range.len();
            next = if range.end == buffers.samples { 0 } else { range.end };
            remaining -= length;
            if !(requested.force || requested.stiffness) {
                continue;
            }
            let parts = (
                buffers.displacement.get(range.clone()),
                buffers.force.get_mut(range.clone()),
                buffers.stiffness.get_mut(range),
            );
            let (Some(displacement), Some(force), Some(stiffness)) = parts else { break };
            if branch.gross_slip {
                force.fill(self.law.response(0.0).force);
                stiffness.fill(0.0);
            } else if requested.stiffness {
                for ((force, stiffness), &displacement) in force.iter_mut().zip(stiffness.iter_mut()).zip(displacement)
                {
                    Response { force: *force, stiffness: *stiffness } = evaluator.at(displacement);
                }
                buffers.branch_sums.add(&buffers.tables, 0, &rows, stiffness);
                buffers.branch_sums.add(&buffers.tables, 1, &rows, stiffness);
            } else {
                for (force, &displacement) in force.iter_mut().zip(displacement) {
                    *force = evaluator.at(displacement).force;
                }
            }
            if requested.force {
                if !self.half_wave_symmetric {
                    buffers.force_sums.add(&buffers.tables, 0, &rows, force);
                }
                buffers.force_sums.add(&buffers.tables, 1, &rows, force);
            }
        }
        if let Some(jacobian) = jacobian
            && !branch.gross_slip
        {
            buffers.stiffness_sums.add_all(&buffers.branch_sums);
            if branch.depth > 0 {
                buffers.add_reversal(first, next, count, branch.depth, jacobian);
            }
        }
        if next == 0 { buffers.samples - 1 } else { next - 1 }
    }
}

impl Buffers<'_> {
    /// 2H + 1.
    fn coefficients(&self) -> usize {
        2 * self.harmonics + 1
    }

    /// Stores sample and gradient of a reversal, number `place` on the stack, on the branch that leaves reversal `left`.
    #[inline(always)]
    fn store_reversal(&mut self, sample: usize, left: usize, place: usize, with_gradient: bool) {
        if with_gradient {
            self.differentiate(sample, left);
            let n = self.coefficients().max(1);
            if let Some(gradient) = self.gradients.chunks_exact_mut(n).nth(place) {
                gradient.iter_mut().zip(self.row.iter()).for_each(|(stored, row)| *stored = *row);
            }
        }
        if let Some(reversed_at) = self.reversed_at.get_mut(place) {
            *reversed_at = sample as f64;
        }
    }

    /// The first sample of largest magnitude among the first `among`.
    #[inline(always)]
    fn farthest(&self, among: usize) -> usize {
        let samples = self.displacement.get(..among).unwrap_or(self.displacement);
        let larger = |one: f64, two: f64| if two > one { two } else { one };
        let (fours, others) = samples.as_chunks::<4>();
        let mut lanes = [0.0; 4];
        for four in fours {
            for k in 0..4 {
                lanes[k] = larger(lanes[k], four[k].abs());
            }
        }
        let [one, two, three, four] = lanes;
        let mut largest = larger(larger(one, two), larger(three, four));
        for other in others {
            largest = larger(largest, other.abs());
        }
        samples.iter().position(|value| value.abs() == largest).unwrap_or(0)
    }

    /// φ of a sample into a row over the coefficients.
    #[inline(always)]
    fn phi(columns: &[f64], half: usize, sample: usize, row: &mut [f64]) {
        let Rows { first, sign, .. } = Rows::of(sample, half);
        let half = half.max(1);
        let Some((constant, pairs)) = row.split_first_mut() else { return };
        *constant = 1.0;
        let mut odd = true;
        let waves = columns.get(half..).unwrap_or(&[]).chunks_exact((2 * half).max(1));
        for ([cosine, sine], columns) in pairs.as_chunks_mut::<2>().0.iter_mut().zip(waves) {
            let at = |place: usize| columns.get(place).copied().unwrap_or(0.0);
            let sign = if odd { sign } else { 1.0 };
            (*cosine, *sine) = (sign * at(first), sign * at(half + first));
            odd = !odd;
        }
    }

    /// dT of a sample on the branch from the reversal of that depth, the virgin curve at 0: `k (φ - φ_r) + dT_r`.
    #[inline(always)]
    fn differentiate(&mut self, sample: usize, depth: usize) {
        let k = self.stiffness.get(sample).copied().unwrap_or(0.0);
        Self::phi(self.columns, self.half, sample, self.row);
        if let Some(depth) = depth.checked_sub(1) {
            let reversed_at = self.reversed_at.get(depth).copied().unwrap_or(0.0);
            Self::phi(self.columns, self.half, reversed_at as usize, self.start);
            let gradient = self.gradients.chunks_exact(2 * self.harmonics + 1).nth(depth).unwrap_or(&[]);
            for ((row, start), gradient) in self.row.iter_mut().zip(self.start.iter()).zip(gradient) {
                *row = k * (*row - start) + gradient;
            }
        } else {
            self.row.iter_mut().for_each(|row| *row *= k);
        }
    }

    /// Adds `(Σ φ) ⊗ dT_r - (Σ k φ) ⊗ φ_r` of a branch that begins with sample `first`, `count` long, so that `next` follows.
    #[inline(always)]
    fn add_reversal(&mut self, first: usize, next: usize, count: usize, depth: usize, jacobian: &mut [f64]) {
        let n = self.coefficients().max(1);
        let (columns, half) = (self.columns, self.half);
        Self::phi(columns, half, first, self.start);
        Self::phi(columns, half, next, self.row);
        // Σ exp(imt) = [exp(im t_next) - exp(im t_first)]/(exp(imΔ) - 1).
        if let Some(waves) = self.waves.first_mut() {
            *waves = count as f64;
        }
        for (((sum, first), next), cotangent) in self
            .waves
            .get_mut(1..)
            .unwrap_or(&mut [])
            .chunks_exact_mut(2)
            .zip(self.start.get(1..).unwrap_or(&[]).chunks_exact(2))
            .zip(self.row.get(1..).unwrap_or(&[]).chunks_exact(2))
            .zip(self.cotangents)
        {
            if let ([cosines, sines], &[c0, s0], &[c1, s1]) = (sum, first, next) {
                let (c, s) = (c1 - c0, s1 - s0);
                (*cosines, *sines) = (-0.5 * c + cotangent * s, -0.5 * s - cotangent * c);
            }
        }
        let reversed_at = self.reversed_at.get(depth.wrapping_sub(1)).copied().unwrap_or(0.0);
        Self::phi(columns, half, reversed_at as usize, self.start);
        self.branch_sums.copy_to(self.weighted);
        let gradient = self.gradients.chunks_exact(n).nth(depth.wrapping_sub(1)).unwrap_or(&[]);
        for ((column, &start), &gradient) in jacobian.chunks_exact_mut(n).zip(self.start.iter()).zip(gradient) {
            add_difference(column, gradient, self.waves, start, self.weighted);
        }
    }
}

/// Adds `a x - b y`, four elements together.
#[inline(always)]
fn add_difference(target: &mut [f64], a: f64, x: &[f64], b: f64, y: &[f64]) {
    let (blocks, others) = target.as_chunks_mut::<4>();
    let ((x, other_x), (y, other_y)) = (x.as_chunks::<4>(), y.as_chunks::<4>());
    for ((block, x), y) in blocks.iter_mut().zip(x).zip(y) {
        for k in 0..4 {
            block[k] += a * x[k] - b * y[k];
        }
    }
    for ((other, x), y) in others.iter_mut().zip(other_x).zip(other_y) {
        *other += a * x - b * y;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constant_load::contact::tests::{FLATS, contact, ellipse};
    use crate::hbm::Rule::UniformSampling;
    use crate::hbm::tests::{SHAPE, compute as all, scaled, workspace};
    use std::vec;
    use std::vec::Vec;

    /// The trapezoidal sum over a period errs by the jumps of odd derivatives. At a reversal the first has none: samples⁻⁴
    /// where samples are reversals, but samples⁻² where they miss them, by a part of a step, and the loop is smaller.
    #[test]
    fn one_harmonic_tends_to_the_complex_stiffness_as_samples_to_the_minus_two_or_four() {
        for contact in FLATS.map(contact).into_iter().chain([ellipse(1e-4, 2e-4)]) {
            let amplitude = 0.7 * contact.slip_displacement;
            let exact = contact.complex_stiffness(amplitude).unwrap();
            for (missed, power) in [(0.0, 4), (0.5, 2)] {
                let off = [64, 128, 256, 512].map(|samples| {
                    let (sine, cosine) = (2.0 * PI * missed / samples as f64).sin_cos();
                    let displacement = [0.0, amplitude * cosine, amplitude * sine];
                    let (force, _, energy) = all(&contact, &mut workspace(UniformSampling, 1, samples), &displacement);
                    // Where the reversals are samples the energy is that of the loop at once.
                    assert!(missed > 0.0 || (energy / exact.dissipated() - 1.0).abs() < 1e-13);
                    // Turned back by what was missed; F = (K' + iK'') A is K' A cos t - K'' A sin t.
                    let real = (cosine * force[1] + sine * force[2]) / amplitude;
                    let imaginary = (sine * force[1] - cosine * force[2]) / amplitude;
                    (real - exact.real()).hypot(imaginary - exact.imaginary())
                });
                for pair in off.windows(2) {
                    // The next term is smaller by samples⁻², with a factor below 100. Rounding ends it.
                    let falls = (0.95..1.05).contains(&(pair[0] / pair[1] / 2f64.powi(power)));
                    assert!(falls || pair[1] < 1e-13 * exact.real(), "{missed} {off:?} {}", exact.real());
                }
                assert!(off[3] < 1e-4 * exact.imaginary() + 1e-13 * exact.real(), "{missed} {off:?}");
            }
        }
    }

    #[test]
    fn a_shift_in_time_shifts_force_and_jacobian() {
        let samples = 48;
        for (contact, size) in [(contact(50e-6), 0.9), (contact(0.0), 0.5), (contact(1e-6), 2.5)] {
            let mut memory = workspace(UniformSampling, 3, samples);
            let n = SHAPE.len();
            let displacement = scaled(&contact, &SHAPE, size);
            let (force, jacobian, energy) = all(&contact, &mut memory, &displacement);
            for by in [1, 7, 24, 31] {
                // Each pair (cos k, sin k) turns by k times the shift.
                let turn = |vector: &[f64]| {
                    let mut turned = vector.to_vec();
                    for k in 1..=n / 2 {
                        let (sine, cosine) = (2.0 * PI * (k * by) as f64 / samples as f64).sin_cos();
                        let (a, b) = (vector[2 * k - 1], vector[2 * k]);
                        turned[2 * k - 1] = cosine * a + sine * b;
                        turned[2 * k] = cosine * b - sine * a;
                    }
                    turned
                };
                let (shifted, its_jacobian, same) = all(&contact, &mut memory, &turn(&displacement));
                assert!((same / energy - 1.0).abs() < 1e-12, "{by}");
                for (one, two) in shifted.iter().zip(turn(&force)) {
                    // Displacements come out of the turn with a few units of rounding.
                    assert!((one - two).abs() < 2e-14 * contact.slip_force, "{by}");
                }
                // J R = R J, column by column.
                for j in 0..n {
                    let mut unit = vec![0.0; n];
                    unit[j] = 1.0;
                    let times = |matrix: &[f64], vector: &[f64]| -> Vec<f64> {
                        (0..n).map(|i| (0..n).map(|k| matrix[i + n * k] * vector[k]).sum()).collect()
                    };
                    let one = times(&its_jacobian, &turn(&unit));
                    let two = turn(&times(&jacobian, &unit));
                    for (one, two) in one.iter().zip(two) {
                        // Near gross slip a unit of rounding of the displacement is worth many of the stiffness.
                        assert!((one - two).abs() < 1e-9 * contact.initial_stiffness, "{by}: {one} {two}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_small_motion_meets_a_spring_and_a_large_one_a_square_wave() {
        let contact = contact(0.0);
        let mut memory = workspace(UniformSampling, 3, 32);
        let (_, jacobian, _) = all(&contact, &mut memory, &[1e-9 * contact.slip_displacement; 7]);
        for (place, value) in jacobian.iter().enumerate() {
            let expected = if place % 8 == 0 { contact.initial_stiffness } else { 0.0 };
            // The bend of the curve is 1e-9 of its slope there.
            assert!((value - expected).abs() < 1e-8 * contact.initial_stiffness, "{place}");
        }
        let huge = 1e9 * contact.slip_displacement;
        let (force, _, energy) = all(&contact, &mut memory, &[0.0, 0.0, huge, 0.0, 0.0, 0.0, 0.0]);
        // The sign of cos at 32 samples has cot(π/32)/8 for 4/π.
        assert!((force[1] / contact.slip_force * (PI / 32.0).tan() * 8.0 - 1.0).abs() < 1e-14);
        assert!((energy / (4.0 * contact.slip_force * huge) - 1.0).abs() < 1e-8);
    }
}
