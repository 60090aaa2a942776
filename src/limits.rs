//! Limits of inputs: displacements, and products and quotients of parameters whose intermediate results could overflow or underflow.

use crate::error::Error;
use crate::numerics::fp_class::{abs_le, is_finite};

/// The bound keeps products with forces and energies representable.
pub(crate) const MAX_DISPLACEMENT: f64 = 1e150;

/// `BadDisplacement` unless it is finite and at most 1e150 in magnitude.
pub(crate) fn check_displacement(displacement: f64) -> Result<(), Error> {
    if abs_le(displacement, MAX_DISPLACEMENT) { Ok(()) } else { Err(Error::BadDisplacement) }
}

/// Rejects coefficients that are not finite or too large.
/// Errors: `BadDisplacement`.
pub(crate) fn check_coefficients(displacement: &[f64]) -> Result<(), Error> {
    let are_allowed = displacement.iter().all(|&coefficient| abs_le(coefficient, MAX_DISPLACEMENT));
    if are_allowed { Ok(()) } else { Err(Error::BadDisplacement) }
}

/// Checks a tangential force of at most a limit, but for rounding.
/// Errors: `BadForce` if it is not finite, `ForceExceedsSlip`.
pub(crate) fn check_force(force: f64, limit: f64) -> Result<(), Error> {
    if abs_le(force, limit * (1.0 + 8.0 * f64::EPSILON)) {
        Ok(())
    } else if is_finite(force) {
        Err(Error::ForceExceedsSlip)
    } else {
        Err(Error::BadForce)
    }
}

/// `BadPosition` unless all positions are finite.
pub(crate) fn check_positions(x: &[f64]) -> Result<(), Error> {
    if x.iter().all(|&x| is_finite(x)) { Ok(()) } else { Err(Error::BadPosition) }
}

/// Largest exponent of 2 of an intermediate product: squares remain representable.
pub(crate) const LARGEST_EXPONENT: i32 = 500;

/// The exponent of 2 of a quotient of products, from the exponents of the factors alone, so that nothing overflows.
pub(crate) fn exponent_of(numerators: &[f64], denominators: &[f64]) -> i32 {
    let exponent = |value: &f64| ((value.to_bits() >> 52) & 0x7ff) as i32 - 1023;
    numerators.iter().map(exponent).sum::<i32>() - denominators.iter().map(exponent).sum::<i32>()
}

/// `OutOfRange` if a quotient of products is not between 2^-500 and 2^500.
pub(crate) fn in_range(numerators: &[f64], denominators: &[f64]) -> Result<(), Error> {
    if exponent_of(numerators, denominators).abs() <= LARGEST_EXPONENT { Ok(()) } else { Err(Error::OutOfRange) }
}
