//! Common parts of the harmonic forces of all laws: outputs, Fourier transforms, and their tables and memory.
//!
//! - [`workspace`]: header and layout of workspaces;
//! - `folded`: synthesis and sums over uniformly spaced samples, folded by symmetry;
//! - `rows`: 1, cos t, sin t, ... at the samples, their sums and outer products;
//! - `sampled_jacobian`: the Jacobian from Fourier sums and outer products.

pub(crate) mod folded;
pub(crate) mod rows;
pub(crate) mod sampled_jacobian;
pub(crate) mod workspace;

use crate::error::Error;
use crate::limits::check_coefficients;
use crate::numerics::slices::PanicFreeSlice;
use core::f64::consts::PI;

/// Outputs: the coefficients of the force, its Jacobian (column-major) and the energy; `None` is not computed.
#[derive(Debug)]
pub struct HarmonicOutput<'a> {
    /// 2H + 1 coefficients of the force \[N\].
    pub force: Option<&'a mut [f64]>,
    /// (2H + 1)² derivatives of force i with respect to displacement j \[N/m\] at `i + (2H + 1) j`.
    pub jacobian: Option<&'a mut [f64]>,
    /// Energy dissipated per period \[J\]; of an element the work of the tangential force.
    pub dissipated: Option<&'a mut f64>,
    /// An estimate of the largest difference of the tangential force between the last period and the steady state, over mu times
    /// the largest normal force; 0 but for two directions.
    pub drift: Option<&'a mut f64>,
}

impl HarmonicOutput<'_> {
    /// Checks the n coefficients of a displacement, and the lengths of the outputs.
    /// Errors: `BadArraySize`, `BadDisplacement`.
    pub(crate) fn check(&self, n: usize, displacement: &[f64]) -> Result<(), Error> {
        let fits = |output: &Option<&mut [f64]>, length: usize| output.as_ref().is_none_or(|o| o.len() == length);
        if displacement.len() != n || !fits(&self.force, n) || !fits(&self.jacobian, n * n) {
            return Err(Error::BadArraySize);
        }
        check_coefficients(displacement)
    }
}

/// The largest value of a function over an array, without the values beyond its last whole block of four.
pub(crate) fn largest_of(values: &[f64], of: fn(f64) -> f64) -> f64 {
    let mut lanes = [f64::MIN; 4];
    for block in values.blocks::<4>() {
        for k in 0..4 {
            let value = of(block[k]);
            lanes[k] = if value > lanes[k] { value } else { lanes[k] };
        }
    }
    lanes.into_iter().fold(f64::MIN, f64::max)
}

/// `2π order sample/samples`; the number of periods is reduced to its fraction before the multiplication by π.
pub(crate) fn angle(order: usize, sample: usize, samples: usize) -> f64 {
    let fraction = (order * sample % samples.max(1)) as f64 / samples.max(1) as f64;
    2.0 * PI * fraction
}

/// The value of row c of 1, cos t, sin t, cos 2t, ... at one of the samples of a period.
pub(crate) fn basis(c: usize, sample: usize, samples: usize) -> f64 {
    let angle = angle(c.div_ceil(2), sample, samples);
    if c > 0 && c.is_multiple_of(2) { angle.sin() } else { angle.cos() }
}

/// Completes Fourier sums over half a period by the other half, in which the function keeps (+1) or changes (-1) its sign.
pub(crate) fn complete_half_wave(sums: &mut [f64], sign: f64) {
    for (c, sum) in sums.iter_mut().enumerate() {
        *sum *= if c.div_ceil(2).is_multiple_of(2) == (sign > 0.0) { 2.0 } else { 0.0 };
    }
}

/// Scales Fourier sums to coefficients: the constant by `weight`, harmonics by twice that.
pub(crate) fn normalise(sums: &mut [f64], weight: f64) {
    sums.iter_mut().for_each(|sum| *sum *= 2.0 * weight);
    if let Some(constant) = sums.first_mut() {
        *constant *= 0.5;
    }
}

/// The work of the tangential forces in a period \[J\]: `π Σ k (c_k s'_k - s_k c'_k)` from the n coefficients
/// `[c_0, c_1, s_1, ...]` of the force in each tangential direction, and those of the displacement. In the steady state it is the
/// energy dissipated, which is not negative; rounding below 0 counts as 0.
pub(crate) fn work(n: usize, displacement: &[f64], force: &[f64]) -> f64 {
    let mut work = 0.0;
    for (displacement, force) in displacement.chunks_exact(n.max(1)).zip(force.chunks_exact(n.max(1))) {
        let [displacement, force] = [displacement, force].map(|all| all.get(1..).unwrap_or(&[]).blocks::<2>());
        for (order, ([cos, sin], [force_cos, force_sin])) in (1..=n).zip(displacement.iter().zip(force)) {
            work += order as f64 * (force_cos * sin - force_sin * cos);
        }
    }
    PI * work.max(0.0)
}
