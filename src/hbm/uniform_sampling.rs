//! Harmonic force by alternating frequency/time (AFT) with uniformly spaced samples.
//!
//! The displacement is sampled, the law is advanced from sample to sample, and the forces are transformed back. The error is
//! O(samples⁻²); the Jacobian is exact for the discrete sums, see `jacobian`. The sums Σ φ over the samples of a branch are geometric
//! series.

use super::fourier::{fill_columns, normalise, synthesise};
use super::fourier_sums::{FourierSums, TableRows, block_count, fill_table};
use super::sampled_gradients::SampledGradients;
use super::workspace::{Blocks, HEADER, Parts, Size, WorkspaceLayout, padded};
use super::{HarmonicOutput, Requested, jacobian};
use crate::error::Error;
use crate::law::{BranchRange, Evaluator, Law, Point, Response, Reversal};
use crate::tag::Kind;
use core::f64::consts::PI;

/// Lengths of the parts of a workspace.
pub(super) struct Layout(Size);

impl Layout {
    /// Samples in the tables: half a period, after which odd orders change their sign; a whole period if the number is odd.
    fn half(&self) -> usize {
        if self.0.samples.is_multiple_of(2) { self.0.samples / 2 } else { self.0.samples }
    }

    /// Capacity for reversals: one per sample, and one more.
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

    fn max_rows(&self) -> usize {
        self.0.samples + 8
    }

    fn tables_length(&self) -> usize {
        let (half, up_to_2h) = (self.half(), 4 * block_count(2 * self.0.harmonics));
        padded(half * self.0.coefficients()) + 2 * padded(half * up_to_2h) + padded(self.0.harmonics)
    }

    fn length(&self) -> usize {
        let (n, reversals) = (self.0.coefficients(), self.reversals());
        let sums = 2 * 4 * block_count(self.0.harmonics) + 4 * 4 * block_count(2 * self.0.harmonics);
        let stack = padded(3 * reversals) + padded(reversals) + padded(reversals * n);
        HEADER + self.tables_length() + 3 * padded(self.0.samples) + stack + sums + 4 * padded(n)
    }

    fn fill_tables(&self, tables: &mut Parts) -> Result<(), Error> {
        let (Size { harmonics, samples }, half) = (self.0, self.half());
        fill_columns(tables.take(half * self.0.coefficients())?, samples, half);
        for parity in [0, 1] {
            let table = tables.take_blocks(half * block_count(2 * harmonics))?;
            fill_table(table, parity, 2 * harmonics, samples, half);
        }
        // 1/(exp(imΔ) - 1) = -1/2 - (i/2) cot(mΔ/2), with Δ the step.
        for (m, cotangent) in (1..).zip(tables.take(harmonics)?) {
            let (sine, cosine) = (PI * m as f64 / samples as f64).sin_cos();
            *cotangent = 0.5 * cosine / sine;
        }
        Ok(())
    }
}

/// An opened workspace.
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
    /// Columns 1, cos t, sin t, cos 2t, ... over the samples of half a period.
    columns: &'a [f64],
    /// Tables of the even and of the odd orders up to 2H over the samples of half a period.
    tables: [&'a Blocks; 2],
    displacement: &'a mut [f64],
    force: &'a mut [f64],
    stiffness: &'a mut [f64],
    gradients: SampledGradients<'a>,
    /// Fourier sums: of the force, of the stiffness on one branch, and of the stiffness on all branches.
    force_sums: FourierSums<'a>,
    branch_sums: FourierSums<'a>,
    stiffness_sums: FourierSums<'a>,
}

impl<'a> Workspace<'a> {
    /// Opens an initialised workspace.
    ///
    /// # Errors
    /// `BadWorkspace` if uninitialised or too short.
    #[inline(always)]
    pub fn new(workspace: &'a mut [f64]) -> Result<Workspace<'a>, Error> {
        let (layout, mut parts) = Layout::open(workspace)?;
        let (half, coefficients) = (layout.half(), layout.0.coefficients());
        let (up_to_h, up_to_2h) = (block_count(layout.0.harmonics), block_count(2 * layout.0.harmonics));
        // Parts in the order of the workspace: tables, samples, gradients, sums, rows.
        let columns: &[f64] = parts.take(half * coefficients)?;
        let tables: [&Blocks; 2] = [parts.take_blocks(half * up_to_2h)?, parts.take_blocks(half * up_to_2h)?];
        let cotangents = parts.take(layout.0.harmonics)?;
        let samples = layout.0.samples;
        let [displacement, force, stiffness] = [parts.take(samples)?, parts.take(samples)?, parts.take(samples)?];
        let (reversed_at, gradients) =
            (parts.take(layout.reversals())?, parts.take(layout.reversals() * coefficients)?);
        let mut sums = |blocks| Ok(FourierSums([parts.take_blocks(blocks)?, parts.take_blocks(blocks)?]));
        let (force_sums, branch_sums, stiffness_sums) = (sums(up_to_h)?, sums(up_to_2h)?, sums(up_to_2h)?);
        let gradients = SampledGradients {
            coefficients,
            half,
            columns,
            cotangents,
            samples: reversed_at,
            gradients,
            phi: parts.take(coefficients)?,
            phi_sums: parts.take(coefficients)?,
            stiffness_sums: parts.take(coefficients)?,
            row: parts.take(coefficients)?,
        };
        let buffers = Buffers {
            harmonics: layout.0.harmonics,
            samples,
            half,
            columns,
            tables,
            displacement,
            force,
            stiffness,
            gradients,
            force_sums,
            branch_sums,
            stiffness_sums,
        };
        Ok(Workspace { reversals: parts.take(3 * layout.reversals())?.as_chunks_mut().0, buffers })
    }

    /// 2H + 1.
    pub fn coefficients(&self) -> usize {
        self.buffers.gradients.coefficients
    }
}

/// Computes the requested outputs.
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
    let half_wave_symmetric = synthesise(buffers.columns, buffers.half, buffers.displacement, displacement);
    let law = law(reversals, dissipated.is_some());
    let mut period = Period { law, requested, half_wave_symmetric };
    period.integrate(buffers, &mut jacobian);
    if let (Some(dissipated), Some(energy)) = (dissipated, period.law.dissipated()) {
        *dissipated = if half_wave_symmetric { 2.0 * energy } else { energy };
    }
    // Under half-wave symmetry the sums are those of half a period.
    let weight = if half_wave_symmetric { 2.0 } else { 1.0 } / buffers.samples as f64;
    if let Some(force) = force {
        buffers.force_sums.copy_to(force);
        normalise(force, weight);
    }
    if let Some(jacobian) = jacobian {
        let sums = |order| buffers.stiffness_sums.of_order(order);
        jacobian::complete(jacobian, buffers.harmonics, sums, weight, half_wave_symmetric);
    }
}

/// Number of values, at most `limit`, before the first for which `ends(previous, value)`; and the last value before it.
#[inline(always)]
fn count_until(parts: [&[f64]; 2], limit: usize, first: f64, ends: impl Fn(f64, f64) -> bool) -> (usize, f64) {
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

/// Integration over a period, sample by sample.
struct Period<L> {
    law: L,
    requested: Requested,
    /// Only one half of the period is evaluated.
    half_wave_symmetric: bool,
}

impl<L: Law> Period<L> {
    /// Integrates a period, or half of it, from the farthest sample: Fourier sums, and the terms of the reversals of the Jacobian.
    #[inline(always)]
    fn integrate(&mut self, buffers: &mut Buffers, jacobian: &mut Option<&mut [f64]>) {
        let samples = buffers.samples;
        let after = |sample: usize| if sample + 1 >= samples { 0 } else { sample + 1 };
        let mut remaining = if self.half_wave_symmetric { buffers.half } else { samples };
        let mut before = farthest(buffers.displacement, remaining);
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

    /// Number of samples after `sample`, at most `limit`, on the same branch.
    #[inline(always)]
    fn samples_on_branch(&mut self, displacement: &[f64], sample: usize, limit: usize) -> usize {
        let (earlier, later) = displacement.split_at_checked(sample + 1).unwrap_or((displacement, &[]));
        let entered = earlier.last().copied().unwrap_or(0.0);
        let BranchRange { direction, end, .. } = self.law.branch();
        let (count, last) = if direction > 0.0 {
            count_until([later, earlier], limit, entered, |last, next| next < last || next >= end)
        } else {
            count_until([later, earlier], limit, entered, |last, next| next > last || next <= end)
        };
        if count > 0 {
            self.law.account_for(entered, last);
        }
        count
    }

    /// Enters the steady state at the farthest sample.
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
            let index = self.law.branch().depth - 1;
            if self.requested.stiffness {
                let stiffness = buffers.stiffness.get(before).copied().unwrap_or(0.0);
                buffers.gradients.store(index, before, left, stiffness);
            }
        }
    }

    /// Evaluates `count` consecutive samples on the present branch, and adds them to the Fourier sums and the terms of the reversals
    /// of the Jacobian. Returns the last of the samples.
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
            // At most up to the middle or the end of the period, at which the tables start again.
            let boundary = if next < buffers.half { buffers.half } else { buffers.samples };
            let rows = TableRows::at(next, buffers.half);
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
                let (gradients, sums) = (&mut buffers.gradients, &buffers.branch_sums);
                gradients.add_branch_term(first, next, count, branch.depth, sums, jacobian);
            }
        }
        if next == 0 { buffers.samples - 1 } else { next - 1 }
    }
}

/// Index of the first of the leading `count` samples with the largest magnitude.
#[inline(always)]
fn farthest(displacement: &[f64], count: usize) -> usize {
    let samples = displacement.get(..count).unwrap_or(displacement);
    let larger = |one: f64, two: f64| if two > one { two } else { one };
    let (blocks, remainder) = samples.as_chunks::<4>();
    let mut lanes = [0.0; 4];
    for block in blocks {
        for k in 0..4 {
            lanes[k] = larger(lanes[k], block[k].abs());
        }
    }
    let [one, two, three, four] = lanes;
    let mut largest = larger(larger(one, two), larger(three, four));
    for value in remainder {
        largest = larger(largest, value.abs());
    }
    samples.iter().position(|value| value.abs() == largest).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constant_load::contact::tests::{FLATS, contact, ellipse};
    use crate::hbm::Rule::UniformSampling;
    use crate::hbm::tests::{SHAPE, compute as all, scaled, workspace};
    use std::vec;
    use std::vec::Vec;

    /// The error of the trapezoidal sum over a period is due to jumps of odd derivatives. At a reversal the first derivative is
    /// continuous: O(samples⁻⁴) if the reversals are samples. Otherwise the loop is too small by O(samples⁻²).
    #[test]
    fn one_harmonic_converges_to_the_complex_stiffness_at_order_two_or_four() {
        for contact in FLATS.map(contact).into_iter().chain([ellipse(1e-4, 2e-4)]) {
            let amplitude = 0.7 * contact.slip_displacement;
            let exact = contact.complex_stiffness(amplitude).unwrap();
            for (offset, order) in [(0.0, 4), (0.5, 2)] {
                let errors = [64, 128, 256, 512].map(|samples| {
                    let (sine, cosine) = (2.0 * PI * offset / samples as f64).sin_cos();
                    let displacement = [0.0, amplitude * cosine, amplitude * sine];
                    let (force, _, energy) = all(&contact, &mut workspace(UniformSampling, 1, samples), &displacement);
                    // If the reversals are samples the energy is exact.
                    assert!(offset > 0.0 || (energy / exact.dissipated() - 1.0).abs() < 1e-13);
                    // Shifted back by the offset; F = (K' + iK'') A corresponds to K' A cos t - K'' A sin t.
                    let real = (cosine * force[1] + sine * force[2]) / amplitude;
                    let imaginary = (sine * force[1] - cosine * force[2]) / amplitude;
                    (real - exact.real()).hypot(imaginary - exact.imaginary())
                });
                for pair in errors.windows(2) {
                    // The next term of the error is O(samples⁻²) smaller, with a factor below 100.
                    let converges = (0.95..1.05).contains(&(pair[0] / pair[1] / 2f64.powi(order)));
                    assert!(converges || pair[1] < 1e-13 * exact.real(), "{offset} {errors:?} {}", exact.real());
                }
                assert!(errors[3] < 1e-4 * exact.imaginary() + 1e-13 * exact.real(), "{offset} {errors:?}");
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
                // Each pair is rotated by its order times the shift.
                let shift = |vector: &[f64]| {
                    let mut shifted = vector.to_vec();
                    for k in 1..=n / 2 {
                        let (sine, cosine) = (2.0 * PI * (k * by) as f64 / samples as f64).sin_cos();
                        let (a, b) = (vector[2 * k - 1], vector[2 * k]);
                        shifted[2 * k - 1] = cosine * a + sine * b;
                        shifted[2 * k] = cosine * b - sine * a;
                    }
                    shifted
                };
                let (shifted, shifted_jacobian, shifted_energy) = all(&contact, &mut memory, &shift(&displacement));
                assert!((shifted_energy / energy - 1.0).abs() < 1e-12, "{by}");
                for (one, two) in shifted.iter().zip(shift(&force)) {
                    // The shift of the displacement has an error of a few units of rounding.
                    assert!((one - two).abs() < 2e-14 * contact.slip_force, "{by}");
                }
                // J R = R J, column by column.
                for j in 0..n {
                    let mut unit = vec![0.0; n];
                    unit[j] = 1.0;
                    let times = |matrix: &[f64], vector: &[f64]| -> Vec<f64> {
                        (0..n).map(|i| (0..n).map(|k| matrix[i + n * k] * vector[k]).sum()).collect()
                    };
                    let one = times(&shifted_jacobian, &shift(&unit));
                    let two = shift(&times(&jacobian, &unit));
                    for (one, two) in one.iter().zip(two) {
                        // Near gross slip rounding errors of the displacement are amplified in the stiffness.
                        assert!((one - two).abs() < 1e-9 * contact.initial_stiffness, "{by}: {one} {two}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_small_motion_is_elastic_and_the_force_of_a_large_one_is_a_square_wave() {
        let contact = contact(0.0);
        let mut memory = workspace(UniformSampling, 3, 32);
        let (_, jacobian, _) = all(&contact, &mut memory, &[1e-9 * contact.slip_displacement; 7]);
        for (index, value) in jacobian.iter().enumerate() {
            let expected = if index % 8 == 0 { contact.initial_stiffness } else { 0.0 };
            // The curvature changes the slope by 1e-9.
            assert!((value - expected).abs() < 1e-8 * contact.initial_stiffness, "{index}");
        }
        let huge = 1e9 * contact.slip_displacement;
        let (force, _, energy) = all(&contact, &mut memory, &[0.0, 0.0, huge, 0.0, 0.0, 0.0, 0.0]);
        // At 32 samples the first coefficient of sign(cos t) is cot(π/32)/8 instead of 4/π.
        assert!((force[1] / contact.slip_force * (PI / 32.0).tan() * 8.0 - 1.0).abs() < 1e-14);
        assert!((energy / (4.0 * contact.slip_force * huge) - 1.0).abs() < 1e-8);
    }
}
