//! N, U and S as Taylor series of one of them about a size, for the tables of elements.

use crate::numerics::slices::PanicFreeSlice;
use crate::shape::{Quantity, Shape};

/// Number of Taylor coefficients in a [`Series`].
pub(crate) const ORDER: usize = 16;

/// Taylor coefficients.
pub(crate) type Series = [f64; ORDER];

/// The series of the argument itself, `x (1 + ε)`.
pub(crate) fn identity(x: f64) -> Series {
    let mut series = [0.0; ORDER];
    (series[0], series[1]) = (x, x);
    series
}

/// Term k of the product of two series.
pub(crate) fn product_term(one: &Series, other: &Series, k: usize) -> f64 {
    one.iter().zip(other.part(..=k).iter().rev()).map(|(one, other)| one * other).sum()
}

/// Appends term k to the series of a quotient and returns it, given term k of the numerator and the reciprocal of term 0 of the
/// denominator.
pub(crate) fn add_quotient_term(
    quotient: &mut Series,
    numerator: f64,
    denominator: &Series,
    reciprocal: f64,
    k: usize,
) -> f64 {
    let term = (numerator - product_term(quotient, denominator, k)) * reciprocal;
    quotient.set(k, term);
    term
}

impl Shape {
    /// Taylor series of N, U and S about a size with leg > 0, as functions of one of the three.
    pub fn series(&self, leg: f64, argument: Quantity) -> [Series; 3] {
        if self.layer.is_none() {
            return self.reference_size.series(self, leg, argument);
        }
        // As functions of the load N (1 + ε).
        let [load, mut approach, mut shift] = self.reference_size.series(self, leg, Quantity::Load);
        for (k, term) in self.layer.series(self.load(leg)).iter().enumerate() {
            approach[k] += self.layer.normal * term;
            shift[k] += self.layer.tangential * term;
        }
        match argument {
            Quantity::Load => [load, approach, shift],
            Quantity::Approach => {
                let powers = inverse_powers(&approach);
                [composed(&load, &powers), identity(approach[0]), composed(&shift, &powers)]
            }
            Quantity::Shift => {
                let powers = inverse_powers(&shift);
                [composed(&load, &powers), composed(&approach, &powers), identity(shift[0])]
            }
        }
    }
}

/// Powers of the series t(ε) that inverts `f(t) = f_0 (1 + ε)`, at `[power][order]`.
fn inverse_powers(function: &Series) -> [Series; ORDER] {
    let mut powers = [[0.0; ORDER]; ORDER];
    powers[0][0] = 1.0;
    let (mut inverse, per_slope) = ([0.0; ORDER], 1.0 / function[1]);
    for order in 1..ORDER {
        // The orders of t², t³, ... need lower orders of t only.
        let mut sum = if order == 1 { function[0] } else { 0.0 };
        for (power, coefficient) in function.iter().enumerate().take(order + 1).skip(2) {
            let product = product_term(&inverse, &powers.or_zero(power - 1), order);
            powers.as_flattened_mut().set(ORDER * power + order, product);
            sum -= coefficient * product;
        }
        inverse.set(order, sum * per_slope);
        powers[1].set(order, sum * per_slope);
    }
    powers
}

/// `f(t(ε))` from the powers of t.
fn composed(function: &Series, powers: &[Series; ORDER]) -> Series {
    let mut series = [0.0; ORDER];
    // From the highest power, the smallest terms, on.
    for (coefficient, power) in function.iter().zip(powers).rev() {
        series.iter_mut().zip(power).for_each(|(sum, term)| *sum += coefficient * term);
    }
    series
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constant_load::contact::tests::{elliptic, parameters};
    use crate::shape::{Geometry, LayerCompliance};

    #[test]
    fn the_curvature_of_the_load_is_that_of_its_series() {
        let shapes = [parameters(0.0), parameters(50e-6), parameters(3e-3)].map(|flat| flat.shape().unwrap());
        for bare in shapes.into_iter().chain([elliptic(1e-4, 2e-4).shape().unwrap()]) {
            for stiffening_load in [f64::NAN, 0.0, 150.0, 1.5] {
                let mut shape = bare;
                if stiffening_load >= 0.0 {
                    let compliance = bare.compliance(Quantity::Shift, bare.at_load(150.0));
                    let (normal_compliance, tangential_compliance) = (compliance, compliance);
                    let layer = crate::parameters::Layer {
                        normal_compliance,
                        tangential_compliance,
                        stiffening_load,
                        reference_load: 0.0,
                    };
                    (shape.layer, _) = LayerCompliance::new(&layer, 150.0).unwrap();
                }
                for load in [1e-6, 1e-2, 1.0, 150.0, 1500.0] {
                    let leg = shape.at_load(load);
                    let [series, _, [shift, ..]] = shape.series(leg, Quantity::Shift);
                    let (one, other) = (shape.load_curvature(leg), 2.0 * series[2] / (shift * shift));
                    // The recurrences of the series lose some digits where load and shift are nearly proportional.
                    assert!((one / other - 1.0).abs() < 1e-12, "{stiffening_load} {load} {one} {other}");
                }
            }
        }
    }
}
