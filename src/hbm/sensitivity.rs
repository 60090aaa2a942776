//! Derivatives of the harmonic force with respect to the parameters of the contact, for both quadrature rules.
//!
//! At a fixed displacement the instants of the reversals are fixed, and the force is continuous where a loop closes or gross slip starts.
//! So the derivatives are those of the force along the branches: those at the reversal that a branch leaves, and its own.

use super::fourier::{clear_opposite_parity, normalise};
use crate::constant_load::sensitivity::{PARAMETERS, Sensitivity, times};
use crate::law::Law;

/// The derivatives at the reversals on the stack; both rules keep them where the Jacobian has its terms of the reversals.
pub(super) struct ReversalSensitivities<'a>(&'a mut [Sensitivity]);

impl<'a> ReversalSensitivities<'a> {
    pub fn new(memory: &'a mut [f64]) -> ReversalSensitivities<'a> {
        ReversalSensitivities(memory.as_chunks_mut().0)
    }

    /// Stores the derivatives at the reversal that the present branch leaves.
    pub fn store(&mut self, law: &impl Law, sensitivity: Sensitivity) {
        if let Some(place) = law.branch().depth.checked_sub(1).and_then(|index| self.0.get_mut(index)) {
            *place = sensitivity;
        }
    }

    /// The derivatives at a displacement on the present branch.
    pub fn at(&self, law: &impl Law, displacement: f64) -> Sensitivity {
        let start = law.branch().depth.checked_sub(1).and_then(|index| self.0.get(index));
        let (start, along) = (start.copied().unwrap_or_default(), law.sensitivity(displacement));
        core::array::from_fn(|parameter| start[parameter] + along[parameter])
    }
}

/// Adds the outer product of a row over the coefficients and the derivatives.
pub(super) fn add(sums: &mut [f64], weight: f64, row: &[f64], sensitivity: Sensitivity) {
    for (column, derivative) in sums.chunks_exact_mut(row.len().max(1)).zip(times(weight, sensitivity)) {
        column.iter_mut().zip(row).for_each(|(sum, phi)| *sum += derivative * phi);
    }
}

/// Scales the sums, those of half a period if `half_wave_symmetric`, to coefficients.
pub(super) fn complete(sums: &mut [f64], weight: f64, half_wave_symmetric: bool) {
    let length = sums.len() / PARAMETERS;
    for column in sums.chunks_exact_mut(length.max(1)) {
        normalise(column, weight);
        if half_wave_symmetric {
            clear_opposite_parity(1, column);
        }
    }
}
