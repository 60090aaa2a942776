//! Range checks: products and quotients of parameters whose intermediate results could overflow or underflow.

use crate::error::Error;

/// Largest exponent of 2 of an intermediate product: squares remain representable.
pub(crate) const LARGEST_EXPONENT: i32 = 500;

/// The exponent of 2 of a quotient of products, from the exponents of the factors alone, so that nothing overflows.
pub(crate) fn exponent_of(numerators: &[f64], denominators: &[f64]) -> i32 {
    let exponent = |value: &f64| ((value.to_bits() >> 52) & 0x7ff) as i32 - 1023;
    numerators.iter().map(exponent).sum::<i32>() - denominators.iter().map(exponent).sum::<i32>()
}

/// # Errors
/// `OutOfRange` if a quotient of products is not between 2^-500 and 2^500.
pub(crate) fn in_range(numerators: &[f64], denominators: &[f64]) -> Result<(), Error> {
    if exponent_of(numerators, denominators).abs() <= LARGEST_EXPONENT { Ok(()) } else { Err(Error::OutOfRange) }
}
