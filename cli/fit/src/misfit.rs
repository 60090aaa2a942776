//! Whether the law explains the loops: the misfit against the noise, which is estimated without the law.
//!
//! This is the test of lack of fit with replicates: what differs from cycle to cycle at the same place of the loop is noise, of any
//! correlation that is short against a cycle; what repeats in each cycle is an error of the law.

use crate::cycles::Loop;
use crate::data::mean;
use nalgebra::{DMatrix, DVector};

/// The law explains a loop if its misfit is at most this factor times the noise. Rounding to the steps q of a digitiser has
/// errors up to q/2, less than twice its standard deviation q/sqrt(12). Of a misfit twice the noise 3/4 of the square repeat in
/// each cycle, and the intervals of the parameters, which take the residuals for random, no longer contain the error.
pub(crate) const FACTOR: f64 = 2.0;
/// Error of the model itself over the largest force: a smaller misfit is explained. Averaged samples cut off the kink of a
/// reversal, and corrections of reversals are of first order.
const MODEL_ERROR: f64 = 1e-3;

/// Residuals of a loop.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LoopMisfit<'a> {
    pub one: &'a Loop,
    /// Root mean square of the residuals.
    pub misfit: f64,
    /// The root mean square that noise, digitiser and errors of the model explain.
    pub noise: f64,
    /// Square of the error of the model.
    pub of_model: f64,
}

impl<'a> LoopMisfit<'a> {
    /// Of measured and computed forces, without offset and drift, and the stiffnesses of the loop.
    pub fn new(one: &'a Loop, forces: &[[f64; 2]], stiffnesses: &[f64]) -> LoopMisfit<'a> {
        let residuals: Vec<_> = forces.iter().map(|[measured, law]| measured - law).collect();
        let [of_displacement, of_force] = one.noise;
        let mean_square = |values: &[f64]| mean(values.iter().map(|value| value * value));
        let of_samples = of_force.powi(2) + mean_square(stiffnesses) * of_displacement.powi(2);
        let of_cycles = between_branches(one, &residuals, forces);
        let of_digits = one.resolution.powi(2) / 12.0;
        // The effect of a swing of the normal force is included to first order.
        let of_model = ((MODEL_ERROR + one.swing().powi(2)) * one.height()).powi(2);
        LoopMisfit {
            one,
            misfit: mean_square(&residuals).sqrt(),
            noise: (of_samples.max(of_cycles) + of_digits + of_model / FACTOR.powi(2)).sqrt(),
            of_model,
        }
    }

    pub fn ratio(&self) -> f64 {
        self.misfit / self.noise
    }
}

/// Variance of the noise from the differences of the residuals of a branch and of the same branch one cycle before, at the same
/// displacement, without the change of offset and height, which is no noise. Of a single cycle, both branches are compared, of
/// which one is mirrored.
fn between_branches(one: &Loop, residuals: &[f64], forces: &[[f64; 2]]) -> f64 {
    let turns = (1..one.samples.len()).filter(|i| one.samples[*i].direction != one.samples[i - 1].direction);
    let ends: Vec<_> = [0].into_iter().chain(turns).chain([one.samples.len()]).collect();
    let branches: Vec<_> = ends.windows(2).map(|pair| pair[0]..pair[1]).collect();
    let (before, sign) = if branches.len() > 2 { (2, 1.0) } else { (1, -1.0) };
    let (mut squares, mut degrees) = (0.0, 0.0);
    for (first, second) in branches.iter().zip(branches.iter().skip(before)) {
        let difference = |i: usize| {
            let distance = |j: &usize| (sign * one.samples[i].displacement - one.samples[*j].displacement).abs();
            let nearest = first.clone().min_by(|j, k| distance(j).total_cmp(&distance(k))).unwrap_or(i);
            residuals[i] - sign * residuals[nearest]
        };
        let law = |k: usize| forces[second.start + k][1];
        let columns = DMatrix::from_fn(second.len(), 3, |k, column| match column {
            0 => 1.0,
            1 => law(k),
            // A difference of both directions; from cycle to cycle none.
            _ if sign < 0.0 => law(k).abs(),
            _ => 0.0,
        });
        let differences = DVector::from_iterator(second.len(), second.clone().map(difference));
        // The decomposition does not end for what is not a number.
        if !differences.iter().all(|difference| difference.is_finite()) {
            continue;
        }
        if let Ok(changes) = columns.clone().svd(true, true).solve(&differences, 1e-12) {
            squares += (differences - columns * changes).norm_squared();
            degrees += (second.len() as f64 - 3.0).max(0.0);
        }
    }
    if degrees > 0.0 { squares / (2.0 * degrees) } else { 0.0 }
}
