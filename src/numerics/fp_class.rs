//! Classification of doubles by their bit patterns, without floating-point exceptions.
//!
//! An ordered comparison with a NaN raises the invalid-operation exception, and the application may have enabled a trap
//! on it. So arguments of the C interface are checked by integer comparisons.

/// Whether `|value| <= bound`, for a bound >= 0. The bit patterns of positive doubles are ordered as their values, NaNs
/// last.
#[inline(always)]
pub(crate) fn abs_le(value: f64, bound: f64) -> bool {
    value.abs().to_bits() <= bound.to_bits()
}

#[inline(always)]
pub(crate) fn is_finite(value: f64) -> bool {
    abs_le(value, f64::MAX)
}

/// Whether `0 <= value <= bound`; -0 is accepted.
#[inline(always)]
pub(crate) fn in_0_to(value: f64, bound: f64) -> bool {
    abs_le(value, bound) && value.to_bits() <= (-0.0f64).to_bits()
}

/// Whether `value <= bound`, for a bound >= 0. The result for a NaN depends on its sign and has no meaning, but no
/// exception is raised.
#[inline(always)]
pub(crate) fn le(value: f64, bound: f64) -> bool {
    // The bit patterns of negative doubles are negative integers.
    value.to_bits().cast_signed() <= bound.to_bits().cast_signed()
}
