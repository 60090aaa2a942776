//! Harmonic force by alternating frequency/time (AFT) with uniformly spaced samples.
//!
//! The displacement is sampled, the steady state is advanced from branch to branch, and the forces on each branch are evaluated
//! four at a time and transformed back. The error is O(samples⁻²). The Jacobian is the exact derivative of the discrete sums:
//! `Σ k φ ⊗ φ` follows from Fourier sums of the stiffness, and `reversal_terms` adds the terms of the reversals.

use super::reversal_terms::{self, ReversalTerms};
use super::sensitivity::ReversalSensitivities;
use super::{HarmonicOutput, RequestedOfCurve};
use crate::constant_load::contact::Contact;
use crate::constant_load::memory::{Branch, Point, Reversal};
use crate::constant_load::steady_state::SteadyState;
use crate::fourier::folded::FoldedFourier;
use crate::fourier::rows::{OuterProducts, Rows, row_blocks};
use crate::fourier::sampled_jacobian::Assembly;
use crate::fourier::workspace::{Layout, Parts, SamplingSize, padded};
use crate::fourier::{largest_of, normalise};
use crate::numerics::slices::{PanicFreeSlice, Stack};
use crate::parameters::{PARAMETERS, Sensitivity};
use crate::tag::Kind;

/// An opened workspace.
pub(super) struct UniformWorkspace<'a> {
    size: SamplingSize,
    fourier: FoldedFourier<'a>,
    /// The stack of reversals of the steady state.
    reversals: &'a mut [Reversal],
    path: SampledPath<'a>,
    terms: ReversalTerms<'a>,
    assembly: Assembly<'a>,
    /// Derivatives of the force with respect to the parameters at the samples after the farthest one.
    derivatives: &'a mut [Sensitivity],
}

impl<'a> Layout<'a> for UniformWorkspace<'a> {
    const KIND: Kind = Kind::UniformSampling;

    fn fill(&mut self) {
        self.fourier.fill();
        self.terms.rows.fill();
    }

    fn take(size: SamplingSize, parts: &mut Parts<'a>) -> UniformWorkspace<'a> {
        let SamplingSize { harmonics, samples: count, .. } = size;
        // At most one reversal and one branch at each sample, and one at the start.
        let capacity = count + 1;
        let fourier = FoldedFourier::take(parts, count, 2 * harmonics);
        let rows = Rows::take(parts, harmonics, count);
        // Whole blocks of four from any sample on.
        let [displacement, force, stiffness] = parts.take_arrays(2 * count + 7);
        let scratch = parts.take_arrays(count + 7);
        let branches = parts.take_records(capacity);
        let reversals = parts.take(3 * capacity).blocks_mut();
        let entries = parts.take_records(capacity);
        let sums = parts.take_blocks(2 * row_blocks(harmonics) * capacity);
        let outer = OuterProducts::take(parts, harmonics, capacity, 1);
        let assembly = Assembly::take(parts, harmonics, 1.0 / count as f64);
        let derivatives = parts.take(PARAMETERS * count).blocks_mut();
        let path = SampledPath { displacement, force, stiffness, scratch, branches };
        let terms = ReversalTerms { rows, entries, sums, outer };
        UniformWorkspace { size, fourier, reversals, path, terms, assembly, derivatives }
    }
}

/// Computes the requested outputs.
pub(super) fn harmonic_force(
    contact: &Contact,
    workspace: &mut UniformWorkspace,
    displacement: &[f64],
    output: HarmonicOutput,
) {
    let UniformWorkspace { size, fourier, reversals, path, terms, assembly, .. } = workspace;
    let HarmonicOutput { force, jacobian, dissipated, .. } = output;
    let FarthestPart { farthest, length, half_wave } = sample(size.samples, fourier, displacement, path.displacement);
    let symmetry = |sign: f64| half_wave.then_some(sign);
    let mut steady_state = SteadyState::new(contact, reversals, dissipated.is_some());
    let requested = RequestedOfCurve { force: force.is_some() || jacobian.is_some(), stiffness: jacobian.is_some() };
    let branches = path.advance(&mut steady_state, farthest, length, requested);
    if let (Some(dissipated), Some(energy)) = (dissipated, steady_state.dissipated()) {
        *dissipated = if half_wave { 2.0 * energy } else { energy };
    }
    if let Some(force) = force {
        fourier.sum_from(farthest + 1, symmetry(-1.0), path.force, force);
        normalise(force, 1.0 / size.samples as f64);
    }
    if let Some(jacobian) = jacobian {
        terms.gather(path.branches.part(..branches), path.stiffness);
        fourier.sum_from(farthest + 1, symmetry(1.0), path.stiffness, assembly.sums);
        assembly.set_products(&terms.outer, 0);
        assembly.write(symmetry(1.0), jacobian, size.coefficients());
    }
}

/// Computes the derivatives with respect to the parameters.
pub(super) fn harmonic_sensitivity(
    contact: &Contact,
    workspace: &mut UniformWorkspace,
    displacement: &[f64],
    sensitivity: &mut [f64],
) {
    let UniformWorkspace { size, fourier, reversals, path, terms, derivatives, .. } = workspace;
    let FarthestPart { farthest, length, half_wave } = sample(size.samples, fourier, displacement, path.displacement);
    let mut steady_state = SteadyState::new(contact, reversals, false);
    let mut stack = ReversalSensitivities::new(terms.sums.as_flattened_mut());
    let mut from = path.displacement.or_zero(farthest);
    steady_state.begin(from);
    let mut now = steady_state.sensitivity(from);
    for (i, &displacement) in path.displacement.part(farthest + 1..=farthest + length).iter().enumerate() {
        if displacement != from {
            if steady_state.advance(Point { displacement: from, force: 0.0 }, displacement) {
                stack.store(&steady_state, now);
            }
            (now, from) = (stack.sensitivity(&steady_state, displacement), displacement);
        }
        derivatives.set(i, now);
    }
    for (parameter, column) in (0..PARAMETERS).zip(sensitivity.chunks_exact_mut(size.coefficients().max(1))) {
        for (i, derivatives) in derivatives.iter().enumerate() {
            path.force.set(farthest + 1 + i, derivatives[parameter]);
        }
        fourier.sum_from(farthest + 1, half_wave.then_some(-1.0), path.force, column);
        normalise(column, 1.0 / size.samples as f64);
    }
}

/// The part of a period that is evaluated: the samples after the farthest one.
struct FarthestPart {
    farthest: usize,
    length: usize,
    /// Half a period is enough.
    half_wave: bool,
}

/// Samples a displacement along two periods, and chooses the part that is evaluated.
fn sample(count: usize, fourier: &FoldedFourier, displacement: &[f64], samples: &mut [f64]) -> FarthestPart {
    fourier.synthesise(displacement, samples);
    let even_order = |c: usize| c.div_ceil(2).is_multiple_of(2);
    let only_odd_orders = displacement.iter().enumerate().all(|(c, value)| !even_order(c) || *value == 0.0);
    let half_wave = count.is_multiple_of(2) && only_odd_orders;
    let length = if half_wave { count / 2 } else { count };
    // The first of these samples with the largest magnitude, which no sample exceeds.
    let largest = largest_of(samples.part(..padded(length)), f64::abs);
    let farthest = samples.iter().position(|value| value.abs() == largest).unwrap_or(0);
    FarthestPart { farthest, length, half_wave }
}

/// Values at the samples of two periods, of which one period is evaluated, and the branches on which these samples lie.
struct SampledPath<'a> {
    displacement: &'a mut [f64],
    force: &'a mut [f64],
    stiffness: &'a mut [f64],
    /// Scratch memory of branches.
    scratch: [&'a mut [f64]; 2],
    branches: &'a mut [reversal_terms::BranchSamples],
}

impl SampledPath<'_> {
    /// Advances the steady state from the farthest sample along `length` further samples, and evaluates force and stiffness if
    /// requested. Returns the number of branches.
    fn advance(
        &mut self,
        steady_state: &mut SteadyState,
        farthest: usize,
        length: usize,
        requested: RequestedOfCurve,
    ) -> usize {
        let SampledPath { displacement, force, stiffness, scratch, branches } = self;
        let mut from = Point { displacement: displacement.or_zero(farthest), force: 0.0 };
        let response = steady_state.begin(from.displacement);
        from.force = response.force;
        stiffness.set(farthest, response.stiffness);
        let mut branches = Stack { values: branches, depth: 0 };
        let (mut next, last) = (farthest + 1, farthest + length);
        while next <= last {
            let (entered, rest) = (displacement.or_zero(next), displacement.part(next..));
            steady_state.advance(from, entered);
            let branch = steady_state.branch();
            let count = count_on_branch(rest, &branch).min(last + 1 - next);
            let [first, on_branch, depth] = [next, count, branch.depth].map(|number| number as u64);
            branches.push(reversal_terms::BranchSamples { first, count: on_branch, depth });
            from.displacement = displacement.or_zero(next + count - 1);
            steady_state.account_for(entered, from.displacement);
            if requested.force {
                let (force, stiffness) = (force.part_mut(next..), stiffness.part_mut(next..));
                let scratch = scratch.each_mut().map(|array| &mut **array);
                if branch.gross_slip {
                    force.part_mut(..count).fill(branch.response(steady_state.contact, 0.0).force);
                    stiffness.part_mut(..count).fill(0.0);
                } else if requested.stiffness {
                    branch.along::<true>(steady_state.contact, count, rest, scratch, [force, stiffness]);
                } else {
                    branch.along::<false>(steady_state.contact, count, rest, scratch, [force, stiffness]);
                }
                from.force = force.or_zero(count - 1);
            }
            next += count;
        }
        branches.depth
    }
}

/// Number of samples, the first included, before the motion reverses or reaches the end of the branch.
fn count_on_branch(samples: &[f64], branch: &Branch) -> usize {
    let (direction, end) = (branch.direction, branch.direction * branch.end);
    let continues = |last: &f64, next: &f64| {
        let (continues, is_inside) = (direction * next >= direction * last, direction * next < end);
        continues & is_inside
    };
    1 + samples.iter().zip(samples.part(1..)).take_while(|(last, next)| continues(last, next)).count()
}
