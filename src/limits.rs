//! Limits of inputs: displacements, and products and quotients of parameters whose intermediate results could overflow or
//! underflow.

use crate::error::{Error, ensure};
use crate::numerics::fp_class::{abs_le, is_finite};

/// The bound keeps products with forces and energies representable.
pub(crate) const MAX_DISPLACEMENT: f64 = 1e150;

/// `BadDisplacement` unless it is finite and at most 1e150 in magnitude.
pub(crate) fn check_displacement(displacement: f64) -> Result<(), Error> {
    ensure(abs_le(displacement, MAX_DISPLACEMENT), Error::BadDisplacement)
}

/// Rejects coefficients that are not finite or too large.
/// Errors: `BadDisplacement`.
pub(crate) fn check_coefficients(displacement: &[f64]) -> Result<(), Error> {
    displacement.iter().try_for_each(|&coefficient| check_displacement(coefficient))
}

/// Checks a tangential force of at most a limit, but for rounding.
/// Errors: `BadForce` if it is not finite, `ForceExceedsSlip`.
pub(crate) fn check_force(force: f64, limit: f64) -> Result<(), Error> {
    ensure(is_finite(force), Error::BadForce)?;
    ensure(abs_le(force, limit * (1.0 + 8.0 * f64::EPSILON)), Error::ForceExceedsSlip)
}

/// `BadPosition` unless all positions are finite.
pub(crate) fn check_positions(x: &[f64]) -> Result<(), Error> {
    ensure(x.iter().all(|&x| is_finite(x)), Error::BadPosition)
}

/// Largest exponent of 2 of an intermediate product: squares remain representable.
pub(crate) const LARGEST_EXPONENT: i32 = 500;

/// The exponent of 2 of a quotient of products, from the exponents of the factors alone, so that nothing overflows.
pub(crate) fn exponent_of(numerators: &[f64], denominators: &[f64]) -> i32 {
    let exponent = |value: &f64| ((value.to_bits() >> 52) & 0x7ff) as i32 - 1023;
    numerators.iter().map(exponent).sum::<i32>() - denominators.iter().map(exponent).sum::<i32>()
}

/// `OutOfRange` if a product is not between 2^-500 and 2^500.
pub(crate) fn in_range(factors: &[f64]) -> Result<(), Error> {
    quotient_in_range(factors, &[])
}

/// `OutOfRange` if a quotient of products is not between 2^-500 and 2^500.
pub(crate) fn quotient_in_range(numerators: &[f64], denominators: &[f64]) -> Result<(), Error> {
    ensure(exponent_of(numerators, denominators).abs() <= LARGEST_EXPONENT, Error::OutOfRange)
}
