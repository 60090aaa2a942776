//! Jacobian of the event-driven harmonic force from Fourier sums.
//!
//! With φ the row 1, cos t, sin t, cos 2t, ... and Σ the sum or integral over a period,
//!
//! ```text
//! J = Σ φ ⊗ dT = Σ k φ ⊗ φ + Σ_branches [(Σ φ) ⊗ dT_r - (Σ k φ) ⊗ φ_r].
//! ```
//!
//! The first term is composed of the Fourier sums of k up to the order 2H.

use super::columns::{add_difference, clear_opposite_parity};
use crate::fourier::normalise;
use crate::simd::dispatch;

/// Adds the term of a branch that leaves reversal r, `phi_sums ⊗ dT_r - stiffness_sums ⊗ φ_r`; all arguments are rows over the
/// coefficients.
#[inline(always)]
pub(super) fn add_reversal_term(
    jacobian: &mut [f64],
    phi: &[f64],
    gradient: &[f64],
    phi_sums: &[f64],
    stiffness_sums: &[f64],
) {
    dispatch!(reversal_kernel(jacobian, phi, gradient, phi_sums, stiffness_sums));
}

#[inline(always)]
fn reversal_kernel(jacobian: &mut [f64], phi: &[f64], gradient: &[f64], phi_sums: &[f64], stiffness_sums: &[f64]) {
    let columns = jacobian.chunks_exact_mut(phi_sums.len().max(1));
    for ((column, &phi), &gradient) in columns.zip(phi).zip(gradient) {
        add_difference(column, gradient, phi_sums, phi, stiffness_sums);
    }
}

/// Adds `Σ k φ ⊗ φ`, from the Fourier sums of k up to the order 2H: a product of two harmonics is composed of the sum and the
/// difference of their orders.
#[inline(always)]
fn add_products(jacobian: &mut [f64], harmonics: usize, sums: &[f64]) {
    let at = |index: usize| sums.get(index).copied().unwrap_or(0.0);
    let pair = |order: usize| if order == 0 { (at(0), 0.0) } else { (at(2 * order - 1), at(2 * order)) };
    let mut columns = jacobian.chunks_exact_mut((2 * harmonics + 1).max(1));
    for q in 0..=harmonics {
        let (Some(by_cosine), by_sine) = (columns.next(), if q > 0 { columns.next() } else { None }) else {
            return;
        };
        let by_sine = by_sine.unwrap_or(&mut []);
        for p in 0..=harmonics {
            let (c_sum, s_sum) = pair(p + q);
            let (c_difference, s_difference) = pair(p.abs_diff(q));
            let s_difference = if p < q { -s_difference } else { s_difference };
            let add = |column: &mut [f64], row: usize, value: f64| {
                if let Some(j) = column.get_mut(row) {
                    *j += 0.5 * value;
                }
            };
            let cosine_row = (2 * p).saturating_sub(1);
            add(by_cosine, cosine_row, c_difference + c_sum);
            add(by_sine, cosine_row, s_sum - s_difference);
            if p > 0 {
                add(by_cosine, 2 * p, s_sum + s_difference);
                add(by_sine, 2 * p, c_difference - c_sum);
            }
        }
    }
}

/// Completes the Jacobian, which holds the terms of the reversals, by `Σ k φ ⊗ φ`, and normalises it by `weight`. If
/// `half_wave_symmetric`, all sums are those of half a period.
#[inline(always)]
pub(super) fn complete(jacobian: &mut [f64], harmonics: usize, sums: &[f64], weight: f64, half_wave_symmetric: bool) {
    add_products(jacobian, harmonics, sums);
    for (c, column) in jacobian.chunks_exact_mut((2 * harmonics + 1).max(1)).enumerate() {
        normalise(column, weight);
        if half_wave_symmetric {
            clear_opposite_parity(c, column);
        }
    }
}
