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

use super::HarmonicOutput;
use super::steady_state::{Branch, SteadyState};
use super::sums::{Rows, Sums, blocks, fill_table};
use super::waves::{complete_jacobian, fill_columns, sample, scale};
use super::workspace::{Blocks, HEADER, Parts, Size, WorkspaceLayout};
use crate::contact::Contact;
use crate::curve::Response;
use crate::error::Error;
use crate::memory::{self, Reversal, State};
use crate::seal::Kind;
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
    const KIND: Kind = Kind::Equidistant;

    fn of(size: Size) -> Layout {
        Layout(size)
    }

    fn rows(&self) -> usize {
        self.0.samples + 8
    }

    fn tables(&self) -> usize {
        let up_to_2h = 4 * blocks(2 * self.0.harmonics);
        self.half() * (self.0.coefficients() + 2 * up_to_2h) + self.0.harmonics
    }

    fn length(&self) -> usize {
        let (up_to_h, up_to_2h) = (4 * blocks(self.0.harmonics), 4 * blocks(2 * self.0.harmonics));
        let walk = 3 * self.0.samples + self.reversals() * (3 + self.0.coefficients());
        HEADER + self.tables() + walk + 2 * up_to_h + 4 * up_to_2h + 4 * self.0.coefficients()
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
    /// Displacement and force of each reversal.
    reversals: &'a mut [f64],
    /// Sample of each reversal.
    turned_at: &'a mut [f64],
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
        Ok(Workspace {
            harmonics: layout.0.harmonics,
            samples: layout.0.samples,
            half,
            columns: parts.take(half * coefficients)?,
            tables: [parts.take_blocks(half * up_to_2h)?, parts.take_blocks(half * up_to_2h)?],
            cotangents: parts.take(layout.0.harmonics)?,
            displacement: parts.take(layout.0.samples)?,
            force: parts.take(layout.0.samples)?,
            stiffness: parts.take(layout.0.samples)?,
            reversals: parts.take(2 * layout.reversals())?,
            turned_at: parts.take(layout.reversals())?,
            gradients: parts.take(layout.reversals() * coefficients)?,
            force_sums: Sums([parts.take_blocks(up_to_h)?, parts.take_blocks(up_to_h)?]),
            branch_sums: Sums([parts.take_blocks(up_to_2h)?, parts.take_blocks(up_to_2h)?]),
            stiffness_sums: Sums([parts.take_blocks(up_to_2h)?, parts.take_blocks(up_to_2h)?]),
            start: parts.take(coefficients)?,
            waves: parts.take(coefficients)?,
            weighted: parts.take(coefficients)?,
            row: parts.take(coefficients)?,
        })
    }

    /// 2H + 1.
    pub fn coefficients(&self) -> usize {
        2 * self.harmonics + 1
    }
}

/// The outputs that are wanted, of a contact with friction.
#[inline(always)]
pub(super) fn harmonic_force(
    contact: &Contact,
    workspace: &mut Workspace,
    displacement: &[f64],
    output: HarmonicOutput,
) {
    let wanted = output.wanted();
    let HarmonicOutput { force, mut jacobian, dissipated } = output;
    let mirrored = sample(workspace.columns, workspace.half, workspace.displacement, displacement);
    let mut walk = Walk { steady: SteadyState::new(contact, wanted, dissipated.is_some()), mirrored };
    walk.through_period(workspace, &mut jacobian);
    if let (Some(dissipated), Some(energy)) = (dissipated, walk.steady.energy_of_period(mirrored)) {
        *dissipated = energy;
    }
    // The half that was not walked counts as much as the other.
    let mean = if mirrored { 2.0 } else { 1.0 } / workspace.samples as f64;
    if let Some(force) = force {
        workspace.force_sums.spread(force);
        scale(force, mean);
    }
    if let Some(jacobian) = jacobian {
        let sums = |order| workspace.stiffness_sums.of_order(order);
        complete_jacobian(jacobian, workspace.harmonics, sums, mean, mirrored);
    }
}

/// How many values one after the other, at most `left`, are not the first that `ends` says ends their run; and the last of
/// them.
#[inline(always)]
fn run(parts: [&[f64]; 2], left: usize, first: f64, ends: impl Fn(f64, f64) -> bool) -> (usize, f64) {
    let (mut at, mut count) = (first, 0);
    for part in parts {
        for &next in part.get(..left - count).unwrap_or(part) {
            if ends(at, next) {
                return (count, at);
            }
            at = next;
            count += 1;
        }
    }
    (count, at)
}

/// The walk from sample to sample.
struct Walk<'c> {
    steady: SteadyState<'c>,
    /// One half of the period is walked: the other is its mirror image.
    mirrored: bool,
}

impl Walk<'_> {
    /// Leads the contact from the farthest sample through a period, or half of it: the Fourier sums, and the Jacobian's part of
    /// every reversal.
    #[inline(always)]
    fn through_period(&mut self, workspace: &mut Workspace, jacobian: &mut Option<&mut [f64]>) {
        let samples = workspace.samples;
        let after = |sample: usize| if sample + 1 >= samples { 0 } else { sample + 1 };
        let mut left = if self.mirrored { workspace.half } else { samples };
        let mut before = workspace.farthest(left);
        self.begin(workspace, before);
        workspace.force_sums.clear();
        workspace.stiffness_sums.clear();
        while left > 0 {
            let sample = after(before);
            self.pass(workspace, before, sample);
            let count = 1 + self.stay(workspace.displacement, sample, left - 1);
            before = self.follow_branch(workspace, sample, count, jacobian);
            left -= count;
        }
    }

    /// How many samples after this one, at most `left`, lie on the branch as well.
    #[inline(always)]
    fn stay(&mut self, displacement: &[f64], sample: usize, left: usize) -> usize {
        let (ahead, behind) =
            displacement.split_at_checked(sample + 1).map_or((&[][..], displacement), |(b, a)| (a, b));
        let entered = behind.last().copied().unwrap_or(0.0);
        let Branch { direction, end, slides, .. } = self.steady.branch;
        let (count, at) = if direction > 0.0 {
            let end = if slides { f64::INFINITY } else { end };
            run([ahead, behind], left, entered, |at, next| next < at || next >= end)
        } else {
            let end = if slides { f64::NEG_INFINITY } else { end };
            run([ahead, behind], left, entered, |at, next| next > at || next <= end)
        };
        if count > 0 {
            self.steady.account_for(entered, at);
        }
        count
    }

    /// Force and stiffness at the farthest sample.
    #[inline(always)]
    fn begin(&mut self, workspace: &mut Workspace, sample: usize) {
        let displacement = workspace.displacement.get(sample).copied().unwrap_or(0.0);
        let response = self.steady.begin(displacement);
        if let (Some(force), Some(stiffness)) = (workspace.force.get_mut(sample), workspace.stiffness.get_mut(sample)) {
            Response { force: *force, stiffness: *stiffness } = response;
        }
    }

    /// A step that may turn, close loops or slip: on which branch it ends.
    #[inline(always)]
    fn pass(&mut self, workspace: &mut Workspace, before: usize, sample: usize) {
        let displacement = |sample: usize| workspace.displacement.get(sample).copied().unwrap_or(0.0);
        let (from, target) = (displacement(before), displacement(sample));
        let now = Reversal { displacement: from, force: workspace.force.get(before).copied().unwrap_or(0.0) };
        let used = workspace.reversals.get(..2 * self.steady.depth).unwrap_or(&[]);
        let state = State::of(self.steady.virgin, now, used);
        let slip = self.steady.contact.slip_displacement;
        let energy = &mut self.steady.energy;
        let course = memory::follow(&state, slip, target, |stretch| {
            if let Some(energy) = energy {
                energy.add(&stretch);
            }
        });
        if course.turned {
            self.remember(workspace, before, now);
        }
        self.steady.depth = course.depth;
        self.steady.virgin = self.steady.virgin.after(self.steady.contact, &course, target);
        let newest =
            Branch::newest(workspace.reversals, course.depth, self.steady.virgin.origin, course.direction, slip);
        self.steady.branch = Branch { slides: course.slides, ..newest };
    }

    /// Keeps the point at a sample as the newest reversal.
    #[inline(always)]
    fn remember(&self, workspace: &mut Workspace, sample: usize, now: Reversal) {
        let depth = self.steady.depth;
        if self.steady.wanted.stiffness {
            workspace.differentiate(sample, if self.steady.branch.reversed { depth } else { 0 });
            let n = workspace.coefficients().max(1);
            if let Some(gradient) = workspace.gradients.chunks_exact_mut(n).nth(depth) {
                gradient.iter_mut().zip(workspace.row.iter()).for_each(|(kept, now)| *kept = *now);
            }
        }
        if let Some([displacement, force]) = workspace.reversals.chunks_exact_mut(2).nth(depth) {
            (*displacement, *force) = (now.displacement, now.force);
        }
        if let Some(turned_at) = workspace.turned_at.get_mut(depth) {
            *turned_at = sample as f64;
        }
    }

    /// Force and stiffness of consecutive samples on the branch, their Fourier sums, and the branch's part of the Jacobian
    /// beyond `Σ k φ ⊗ φ`; the last of the samples.
    #[inline(always)]
    fn follow_branch(
        &self,
        workspace: &mut Workspace,
        first: usize,
        count: usize,
        jacobian: &mut Option<&mut [f64]>,
    ) -> usize {
        let (branch, contact, wanted) = (self.steady.branch, self.steady.contact, self.steady.wanted);
        let responder = branch.responder(contact);
        let (mut next, mut left) = (first, count);
        if wanted.stiffness && !branch.slides {
            workspace.branch_sums.clear();
        }
        while left > 0 {
            // Neither beyond the middle, where the tables begin anew, nor beyond the end.
            let boundary = if next < workspace.half { workspace.half } else { workspace.samples };
            let rows = Rows::of(next, workspace.half);
            let range = next..boundary.min(next + left);
            let length = range.len();
            next = if range.end == workspace.samples { 0 } else { range.end };
            left -= length;
            if !(wanted.force || wanted.stiffness) {
                continue;
            }
            let parts = (
                workspace.displacement.get(range.clone()),
                workspace.force.get_mut(range.clone()),
                workspace.stiffness.get_mut(range),
            );
            let (Some(displacement), Some(force), Some(stiffness)) = parts else { break };
            if branch.slides {
                force.fill(branch.direction * contact.slip_force);
                stiffness.fill(0.0);
            } else if wanted.stiffness {
                for ((force, stiffness), &displacement) in force.iter_mut().zip(stiffness.iter_mut()).zip(displacement)
                {
                    Response { force: *force, stiffness: *stiffness } = responder.at(displacement);
                }
                workspace.branch_sums.add(&workspace.tables, 0, &rows, stiffness);
                workspace.branch_sums.add(&workspace.tables, 1, &rows, stiffness);
            } else {
                for (force, &displacement) in force.iter_mut().zip(displacement) {
                    *force = responder.at(displacement).force;
                }
            }
            if wanted.force {
                if !self.mirrored {
                    workspace.force_sums.add(&workspace.tables, 0, &rows, force);
                }
                workspace.force_sums.add(&workspace.tables, 1, &rows, force);
            }
        }
        if let Some(jacobian) = jacobian
            && !branch.slides
        {
            workspace.stiffness_sums.add_all(&workspace.branch_sums);
            if branch.reversed {
                workspace.add_reversal(first, next, count, self.steady.depth, jacobian);
            }
        }
        if next == 0 { workspace.samples - 1 } else { next - 1 }
    }
}

impl Workspace<'_> {
    /// The first of the samples farthest from 0, among so many.
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
            let turned_at = self.turned_at.get(depth).copied().unwrap_or(0.0);
            Self::phi(self.columns, self.half, turned_at as usize, self.start);
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
        let turned_at = self.turned_at.get(depth.wrapping_sub(1)).copied().unwrap_or(0.0);
        Self::phi(columns, half, turned_at as usize, self.start);
        self.branch_sums.spread(self.weighted);
        let gradient = self.gradients.chunks_exact(n).nth(depth.wrapping_sub(1)).unwrap_or(&[]);
        for ((column, start), gradient) in jacobian.chunks_exact_mut(n).zip(self.start.iter()).zip(gradient) {
            for ((j, wave), weighted) in column.iter_mut().zip(self.waves.iter()).zip(self.weighted.iter()) {
                *j += gradient * wave - start * weighted;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::tests::{FLATS, contact, ellipse};
    use crate::harmonic_force::Rule::Equidistant;
    use crate::harmonic_force::tests::{SHAPE, compute as all, scaled, workspace};
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
                    let (force, _, energy) = all(&contact, &mut workspace(Equidistant, 1, samples), &displacement);
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
            let mut memory = workspace(Equidistant, 3, samples);
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
        let mut memory = workspace(Equidistant, 3, 32);
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
