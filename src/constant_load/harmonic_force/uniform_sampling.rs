//! Harmonic force by alternating frequency/time (AFT) with uniformly spaced samples.
//!
//! The displacement is sampled, the law advanced from branch to branch, the forces of each branch are evaluated four at a time, and
//! transformed back. The error is O(samples⁻²). The Jacobian is exact for the discrete sums: `Σ k φ ⊗ φ` follows from Fourier sums of
//! the stiffness, and `sampled_terms` adds the terms of the reversals.

use super::motion::fill_phi;
use super::reversal_terms::{BRANCH, Branches, ENTRY, ReversalTerms};
use super::sensitivity::{self, ReversalSensitivities};
use super::{HarmonicOutput, Requested};
use crate::constant_load::contact::Contact;
use crate::constant_load::evaluator::BEYOND;
use crate::constant_load::memory::{Branch, Point, Reversal};
use crate::constant_load::steady_state::SteadyState;
use crate::error::Error;
use crate::fourier::folded::{self, FoldedFourier, sample_length};
use crate::fourier::rows::{OuterProducts, Rows, fill_rows, outer_products_length, row_blocks, rows_length};
use crate::fourier::sampled_jacobian::{self, Assembly};
use crate::fourier::workspace::{HEADER, Parts, Size, WorkspaceLayout, padded};
use crate::fourier::{angle, normalise};
use crate::simd::dispatch;
use crate::tag::Kind;

/// Lengths of the parts of a workspace.
pub(super) struct Layout(Size);

impl Layout {
    /// Capacity for reversals and branches: one per sample, and one more.
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
        2 * self.0.samples + 16
    }

    fn tables_length(&self) -> usize {
        let Size { harmonics, samples, .. } = self.0;
        folded::table_length(samples, 2 * harmonics) + rows_length(harmonics, samples)
    }

    fn length(&self) -> usize {
        let (Size { harmonics, samples, .. }, reversals) = (self.0, self.reversals());
        let terms = padded(BRANCH * reversals) + padded(ENTRY * reversals) + 8 * row_blocks(harmonics) * reversals;
        HEADER
            + self.tables_length()
            + folded::scratch_length(samples, 2 * harmonics)
            + sample_length(samples)
            + 5 * path_length(samples)
            + padded(3 * reversals)
            + terms
            + outer_products_length::<1>(harmonics, reversals)
            + sampled_jacobian::memory_length(harmonics)
    }

    fn fill_tables(&self, tables: &mut Parts) -> Result<(), Error> {
        let Size { harmonics, samples, .. } = self.0;
        let table = tables.take(folded::table_length(samples, 2 * harmonics))?;
        folded::fill_table(table, samples, 2 * harmonics);
        fill_rows(tables.take(rows_length(harmonics, samples))?, harmonics, samples);
        Ok(())
    }
}

/// An opened workspace.
#[derive(Debug)]
pub(super) struct Workspace<'a> {
    size: Size,
    fourier: FoldedFourier<'a>,
    /// The stack of reversals of the law.
    reversals: &'a mut [Reversal],
    /// Displacements, then forces or stiffnesses, at the samples of a period.
    period: &'a mut [f64],
    path: Path<'a>,
    terms: ReversalTerms<'a>,
    assembly: Assembly<'a>,
}

impl<'a> Workspace<'a> {
    /// Opens an initialised workspace.
    ///
    /// # Errors
    /// `BadWorkspace` if uninitialised or too short.
    pub fn new(workspace: &'a mut [f64]) -> Result<Workspace<'a>, Error> {
        let (layout, mut parts) = Layout::open(workspace)?;
        let (size, capacity) = (layout.0, layout.reversals());
        let Size { harmonics, samples: count, .. } = size;
        let mut fourier = FoldedFourier::take(&mut parts, count, 2 * harmonics)?;
        let rows = Rows::take(&mut parts, harmonics, count)?;
        fourier.take_scratch(&mut parts)?;
        let period = parts.take(sample_length(count))?;
        let mut array = || parts.take(path_length(count));
        let ([displacement, force, stiffness], scratch) = ([array()?, array()?, array()?], [array()?, array()?]);
        let branches = Branches::new(parts.take(BRANCH * capacity)?);
        let reversals = parts.take(3 * capacity)?.as_chunks_mut().0;
        let entries = parts.take(ENTRY * capacity)?.as_chunks_mut().0;
        let sums = parts.take_blocks(2 * row_blocks(harmonics) * capacity)?;
        let outer = OuterProducts::take(&mut parts, harmonics, capacity)?;
        let assembly = Assembly::take(&mut parts, size)?;
        let path = Path { displacement, force, stiffness, scratch, branches };
        let terms = ReversalTerms { rows, entries, sums, outer };
        Ok(Workspace { size, fourier, reversals, period, path, terms, assembly })
    }

    /// 2H + 1.
    pub fn coefficients(&self) -> usize {
        self.size.coefficients()
    }
}

/// Computes the requested outputs.
pub(super) fn harmonic_force(
    contact: &Contact,
    workspace: &mut Workspace,
    displacement: &[f64],
    output: HarmonicOutput,
) {
    let Workspace { size, fourier, reversals, period, path, terms, assembly } = workspace;
    let HarmonicOutput { force, jacobian, dissipated, .. } = output;
    let order = sample(size.samples, fourier, period, path, displacement);
    let Order { count, farthest, half_wave_symmetric } = order;
    let length = order.length();
    let mut law = SteadyState::new(contact, reversals, dissipated.is_some());
    let requested = Requested { force: force.is_some() || jacobian.is_some(), stiffness: jacobian.is_some() };
    path.advance(&mut law, length, requested);
    if let (Some(dissipated), Some(energy)) = (dissipated, law.dissipated()) {
        *dissipated = if half_wave_symmetric { 2.0 * energy } else { energy };
    }
    if let Some(force) = force {
        order.sum(fourier, path.force, -1.0, period, force);
        normalise(force, 1.0 / count as f64);
    }
    if let Some(jacobian) = jacobian {
        terms.gather(&path.branches, farthest, path.stiffness);
        order.sum(fourier, path.stiffness, 1.0, period, assembly.sums);
        let length = size.coefficients().max(1);
        let symmetry = if half_wave_symmetric { Some(1.0) } else { None };
        assembly.write(&terms.outer, 0, symmetry, jacobian, length);
    }
}

/// Computes the derivatives with respect to the parameters.
pub(super) fn harmonic_sensitivity(
    contact: &Contact,
    workspace: &mut Workspace,
    displacement: &[f64],
    sensitivity: &mut [f64],
) {
    let Workspace { size, fourier, reversals, period, path, terms, .. } = workspace;
    let order = sample(size.samples, fourier, period, path, displacement);
    let mut law = SteadyState::new(contact, reversals, false);
    let mut stack = ReversalSensitivities::new(terms.sums.as_flattened_mut());
    let (mut from, row) = (at(path.displacement, 0), path.force.get_mut(..size.coefficients()).unwrap_or(&mut []));
    law.begin(from);
    let mut now = law.sensitivity(from);
    sensitivity.fill(0.0);
    for (n, &displacement) in path.displacement.iter().enumerate().take(order.length() + 1).skip(1) {
        if displacement != from {
            if law.advance(Point { displacement: from, force: 0.0 }, displacement) {
                stack.store(&law, now);
            }
            (now, from) = (stack.at(&law, displacement), displacement);
        }
        fill_phi(row, angle(1, order.farthest + n, order.count));
        sensitivity::add(sensitivity, 1.0, row, now);
    }
    sensitivity::complete(sensitivity, 1.0 / order.length() as f64, order.half_wave_symmetric);
}

/// Samples a displacement, from the farthest sample on.
#[inline(always)]
fn sample(count: usize, fourier: &FoldedFourier, period: &mut [f64], path: &mut Path, displacement: &[f64]) -> Order {
    dispatch!(sample_kernel(count, fourier, period, path, displacement))
}

#[inline(always)]
fn sample_kernel(
    count: usize,
    fourier: &FoldedFourier,
    period: &mut [f64],
    path: &mut Path,
    displacement: &[f64],
) -> Order {
    fourier.synthesis_kernel(displacement, period);
    let even_order = |c: usize| c.div_ceil(2).is_multiple_of(2);
    let only_odd_orders = displacement.iter().enumerate().all(|(c, value)| !even_order(c) || *value == 0.0);
    let mut order = Order { count, farthest: 0, half_wave_symmetric: count.is_multiple_of(2) && only_odd_orders };
    order.farthest = farthest(period, order.length());
    rotate(period.get(..count).unwrap_or(&[]), order.farthest, path.displacement);
    if let Some(end) = path.displacement.get_mut(count) {
        *end = at(period, order.farthest);
    }
    order
}

/// Order of the samples on a path.
#[derive(Debug, Clone, Copy)]
struct Order {
    count: usize,
    farthest: usize,
    half_wave_symmetric: bool,
}

impl Order {
    /// Samples to be evaluated.
    #[inline(always)]
    fn length(&self) -> usize {
        if self.half_wave_symmetric { self.count / 2 } else { self.count }
    }

    /// Fourier sums of the values of a path, which ends at the farthest sample; they are copied to the samples of the period. Under
    /// half-wave symmetry the path is first completed by values of the given sign.
    #[inline(always)]
    fn sum(&self, fourier: &mut FoldedFourier, path: &mut [f64], sign: f64, period: &mut [f64], sums: &mut [f64]) {
        dispatch!(self.sum_kernel(fourier, path, sign, period, sums));
    }

    #[inline(always)]
    fn sum_kernel(
        &self,
        fourier: &mut FoldedFourier,
        path: &mut [f64],
        sign: f64,
        period: &mut [f64],
        sums: &mut [f64],
    ) {
        let values = path.get_mut(1..=self.count).unwrap_or(&mut []);
        if self.half_wave_symmetric
            && let Some((first, second)) = values.split_at_mut_checked(self.count / 2)
        {
            second.iter_mut().zip(first).for_each(|(second, first)| *second = sign * *first);
        }
        rotate(values, self.count - 1 - self.farthest, period);
        fourier.sum_kernel(period, sums);
    }
}

/// Values at the samples in the order of time, from the farthest one on, and the branches on which they lie.
#[derive(Debug)]
struct Path<'a> {
    displacement: &'a mut [f64],
    force: &'a mut [f64],
    stiffness: &'a mut [f64],
    /// Scratch memory of evaluators.
    scratch: [&'a mut [f64]; 2],
    branches: Branches<'a>,
}

/// Length of the arrays of a [`Path`].
fn path_length(samples: usize) -> usize {
    padded(samples + 1 + BEYOND)
}

impl Path<'_> {
    /// Advances the law from the farthest sample along `length` further ones, and evaluates force and stiffness if requested.
    fn advance(&mut self, law: &mut SteadyState, length: usize, requested: Requested) {
        let Path { displacement, force, stiffness, scratch, branches } = self;
        let mut from = Point { displacement: at(displacement, 0), force: 0.0 };
        let response = law.begin(from.displacement);
        from.force = response.force;
        if let (Some(force), Some(stiffness)) = (force.first_mut(), stiffness.first_mut()) {
            (*force, *stiffness) = (response.force, response.stiffness);
        }
        branches.clear();
        let mut next = 1;
        while next <= length {
            let entered = at(displacement, next);
            law.advance(from, entered);
            let branch = law.branch();
            let Some(rest) = displacement.get(next..) else { return };
            let count = count_on_branch(rest, &branch).min(length + 1 - next);
            branches.push(count, branch.depth);
            from.displacement = at(displacement, next + count - 1);
            if count > 1 {
                law.account_for(entered, from.displacement);
            }
            if requested.force
                && let (Some(force), Some(stiffness)) = (force.get_mut(next..), stiffness.get_mut(next..))
            {
                if branch.gross_slip {
                    let slip_force = law.response(0.0).force;
                    force.iter_mut().take(count).for_each(|force| *force = slip_force);
                    stiffness.iter_mut().take(count).for_each(|stiffness| *stiffness = 0.0);
                } else {
                    let [one, two] = scratch;
                    if requested.stiffness {
                        law.evaluator().along::<true>(count, rest, [one, two], force, stiffness);
                    } else {
                        law.evaluator().along::<false>(count, rest, [one, two], force, stiffness);
                    }
                }
                from.force = at(force, count - 1);
            }
            next += count;
        }
    }
}

#[inline(always)]
fn at(values: &[f64], index: usize) -> f64 {
    values.get(index).copied().unwrap_or(0.0)
}

/// Copies a period so that it starts at a sample.
#[inline(always)]
fn rotate(from: &[f64], first: usize, to: &mut [f64]) {
    let (before, after) = from.split_at_checked(first).unwrap_or((from, &[]));
    to.iter_mut().zip(after).for_each(|(to, from)| *to = *from);
    let to = to.get_mut(after.len()..).unwrap_or(&mut []);
    to.iter_mut().zip(before).for_each(|(to, from)| *to = *from);
}

/// Number of samples, the first included, before the motion reverses or reaches the end of the branch.
#[inline(always)]
fn count_on_branch(samples: &[f64], branch: &Branch) -> usize {
    let (direction, end) = (branch.direction, branch.direction * branch.end);
    let continues = |last: f64, next: f64| {
        let (last, next) = (direction * last, direction * next);
        let (continues, is_inside) = (next >= last, next < end);
        continues & is_inside
    };
    let later = samples.get(1..).unwrap_or(&[]);
    let mut count = 1;
    for ([a, b, c, d], [e, f, g, h]) in samples.as_chunks::<4>().0.iter().zip(later.as_chunks::<4>().0) {
        if continues(*a, *e) & continues(*b, *f) & continues(*c, *g) & continues(*d, *h) {
            count += 4;
            continue;
        }
        for (last, next) in [(a, e), (b, f), (c, g)] {
            if !continues(*last, *next) {
                break;
            }
            count += 1;
        }
        return count;
    }
    let rest = samples.iter().zip(later).skip(count - 1);
    count + rest.take_while(|(last, next)| continues(**last, **next)).count()
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
    let has = |block: &[f64; 4]| block.iter().fold(false, |has, value| has | (value.abs() == largest));
    let before = 4 * blocks.iter().position(has).unwrap_or(blocks.len());
    before + samples.iter().skip(before).position(|value| value.abs() == largest).unwrap_or(0)
}

#[cfg(test)]
mod tests {

    use crate::constant_load::contact::tests::{FLATS, contact, ellipse};
    use crate::constant_load::harmonic_force::Rule::UniformSampling;
    use crate::constant_load::harmonic_force::tests::{SHAPE, compute as all, scaled, workspace};
    use core::f64::consts::PI;
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
