//! Gradients dT_r of the reversals under uniform sampling, and their terms of the Jacobian.

use super::fourier_sums::{FourierSums, TableRows};
use super::jacobian::add_reversal_term;

/// Gradients of the reversals on the stack.
#[derive(Debug)]
pub(super) struct SampledGradients<'a> {
    /// 2H + 1.
    pub coefficients: usize,
    /// Samples of half a period, over which the columns extend.
    pub half: usize,
    /// Columns 1, cos t, sin t, cos 2t, ... over the first half of the samples.
    pub columns: &'a [f64],
    /// cot(π m/samples)/2 for the orders m.
    pub cotangents: &'a [f64],
    /// Sample of each reversal.
    pub samples: &'a mut [f64],
    /// dT_r of each reversal, a row over the coefficients.
    pub gradients: &'a mut [f64],
    /// Rows over the coefficients: φ_r, Σ φ and Σ k φ of a branch, and scratch memory.
    pub phi: &'a mut [f64],
    pub phi_sums: &'a mut [f64],
    pub stiffness_sums: &'a mut [f64],
    pub row: &'a mut [f64],
}

impl SampledGradients<'_> {
    /// Stores sample and gradient of the reversal at `index` on the stack: a point of the branch of depth `left` with the given
    /// stiffness.
    #[inline(always)]
    pub fn store(&mut self, index: usize, sample: usize, left: usize, stiffness: f64) {
        self.differentiate(sample, left, stiffness);
        if let Some(gradient) = self.gradients.chunks_exact_mut(self.coefficients.max(1)).nth(index) {
            gradient.iter_mut().zip(self.row.iter()).for_each(|(stored, row)| *stored = *row);
        }
        if let Some(stored) = self.samples.get_mut(index) {
            *stored = sample as f64;
        }
    }

    /// dT of a sample on the branch of a depth, 0 for the initial loading curve: `k (φ - φ_r) + dT_r`.
    #[inline(always)]
    fn differentiate(&mut self, sample: usize, depth: usize, k: f64) {
        fill_phi(self.columns, self.half, sample, self.row);
        if let Some(index) = depth.checked_sub(1) {
            let reversed_at = self.samples.get(index).copied().unwrap_or(0.0);
            fill_phi(self.columns, self.half, reversed_at as usize, self.phi);
            let gradient = self.gradients.chunks_exact(self.coefficients.max(1)).nth(index).unwrap_or(&[]);
            for ((row, phi), gradient) in self.row.iter_mut().zip(self.phi.iter()).zip(gradient) {
                *row = k * (*row - phi) + gradient;
            }
        } else {
            self.row.iter_mut().for_each(|row| *row *= k);
        }
    }

    /// Adds `(Σ φ) ⊗ dT_r - (Σ k φ) ⊗ φ_r` of a branch of `count` samples from `first` to the sample before `next`; `sums` are its
    /// Fourier sums of the stiffness.
    #[inline(always)]
    pub fn add_branch_term(
        &mut self,
        first: usize,
        next: usize,
        count: usize,
        depth: usize,
        sums: &FourierSums,
        jacobian: &mut [f64],
    ) {
        let (columns, half) = (self.columns, self.half);
        fill_phi(columns, half, first, self.phi);
        fill_phi(columns, half, next, self.row);
        // Geometric series: Σ exp(imt) = [exp(im t_next) - exp(im t_first)]/(exp(imΔ) - 1).
        if let Some(constant) = self.phi_sums.first_mut() {
            *constant = count as f64;
        }
        for (((sum, first), next), cotangent) in self
            .phi_sums
            .get_mut(1..)
            .unwrap_or(&mut [])
            .chunks_exact_mut(2)
            .zip(self.phi.get(1..).unwrap_or(&[]).chunks_exact(2))
            .zip(self.row.get(1..).unwrap_or(&[]).chunks_exact(2))
            .zip(self.cotangents)
        {
            if let ([cosines, sines], &[c0, s0], &[c1, s1]) = (sum, first, next) {
                let (c, s) = (c1 - c0, s1 - s0);
                (*cosines, *sines) = (-0.5 * c + cotangent * s, -0.5 * s - cotangent * c);
            }
        }
        let index = depth.wrapping_sub(1);
        let reversed_at = self.samples.get(index).copied().unwrap_or(0.0);
        fill_phi(columns, half, reversed_at as usize, self.phi);
        sums.copy_to(self.stiffness_sums);
        let gradient = self.gradients.chunks_exact(self.coefficients.max(1)).nth(index).unwrap_or(&[]);
        add_reversal_term(jacobian, self.phi, gradient, self.phi_sums, self.stiffness_sums);
    }
}

/// φ at a sample: the row 1, cos t, sin t, cos 2t, ...
#[inline(always)]
fn fill_phi(columns: &[f64], half: usize, sample: usize, row: &mut [f64]) {
    let TableRows { first, sign, .. } = TableRows::at(sample, half);
    let half = half.max(1);
    let Some((constant, pairs)) = row.split_first_mut() else { return };
    *constant = 1.0;
    let mut odd = true;
    let harmonics = columns.get(half..).unwrap_or(&[]).chunks_exact((2 * half).max(1));
    for ([cosine, sine], columns) in pairs.as_chunks_mut::<2>().0.iter_mut().zip(harmonics) {
        let at = |index: usize| columns.get(index).copied().unwrap_or(0.0);
        let sign = if odd { sign } else { 1.0 };
        (*cosine, *sine) = (sign * at(first), sign * at(half + first));
        odd = !odd;
    }
}
