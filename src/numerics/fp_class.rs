//! What a number is, told by its bits. A comparison with a signalling NaN would trap, and one of several numbers at once with any
//! NaN: what a caller passes is compared as a number only when it is known to be one.

/// Whether `|value| <= bound`, for a bound >= 0. Bits of positive numbers are in the numbers' order, and NaNs come last.
#[inline(always)]
pub(crate) fn abs_le(value: f64, bound: f64) -> bool {
    value.abs().to_bits() <= bound.to_bits()
}

#[inline(always)]
pub(crate) fn is_finite(value: f64) -> bool {
    abs_le(value, f64::MAX)
}

/// Whether `0 <= value <= bound`.
#[inline(always)]
pub(crate) fn in_0_to(bound: f64, value: f64) -> bool {
    abs_le(value, bound) && value.to_bits() <= (-0.0f64).to_bits()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_tell_what_comparisons_tell() {
        let signalling = f64::from_bits(0x7ff0_0000_0000_0001);
        let values = [0.0, 5e-324, 0.25, 0.5, 0.5f64.next_up(), 1.0, f64::MAX, f64::INFINITY, f64::NAN, signalling];
        for value in values.into_iter().flat_map(|value| [value, -value]) {
            assert_eq!(is_finite(value), value.is_finite(), "{value}");
            for bound in [0.0, 0.5, f64::MAX] {
                assert_eq!(abs_le(value, bound), value.abs() <= bound, "{value} {bound}");
                assert_eq!(in_0_to(bound, value), (0.0..=bound).contains(&value), "{value} {bound}");
            }
        }
    }
}
