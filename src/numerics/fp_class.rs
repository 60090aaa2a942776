//! Classification of doubles by their bit patterns, without floating-point exceptions.
//!
//! An ordered comparison with a NaN raises the invalid-operation exception, which traps if the application has enabled it. Arguments
//! of the C interface are therefore checked by integer comparisons.

/// Whether `|value| <= bound`, for a bound >= 0. The bit patterns of positive doubles are ordered as their values, NaNs last.
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
pub(crate) fn in_0_to(bound: f64, value: f64) -> bool {
    abs_le(value, bound) && value.to_bits() <= (-0.0f64).to_bits()
}

/// Whether `value <= bound`, for a bound >= 0 and a value that is not NaN: with NaN, true or false.
#[inline(always)]
pub(crate) fn le(value: f64, bound: f64) -> bool {
    // The bit patterns of negative doubles are negative integers.
    value.to_bits().cast_signed() <= bound.to_bits().cast_signed()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bit_patterns_agree_with_comparisons() {
        let signalling = f64::from_bits(0x7ff0_0000_0000_0001);
        let values = [0.0, 5e-324, 0.25, 0.5, 0.5f64.next_up(), 1.0, f64::MAX, f64::INFINITY, f64::NAN, signalling];
        for value in values.into_iter().flat_map(|value| [value, -value]) {
            assert_eq!(is_finite(value), value.is_finite(), "{value}");
            for bound in [0.0, 0.5, f64::MAX] {
                assert_eq!(abs_le(value, bound), value.abs() <= bound, "{value} {bound}");
                assert_eq!(in_0_to(bound, value), (0.0..=bound).contains(&value), "{value} {bound}");
                assert!(value.is_nan() || le(value, bound) == (value <= bound), "{value} {bound}");
            }
        }
    }
}
