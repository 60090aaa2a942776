//! Seals: what tells memory that the library made from other memory, and from memory that was changed since.
//!
//! A seal is a double. Its first 16 bits say what it belongs to, the others are a checksum. It is an ordinary finite number,
//! so that it survives where numbers are written as text, with 17 digits.

/// What a seal belongs to. As first bits of a double, numbers of about 1e64. Any two differ in two bits at least: one that
/// was changed in a bit is of no other kind.
#[derive(Debug, Clone, Copy)]
#[repr(u16)]
pub(crate) enum Kind {
    State = 0x4d53,
    /// Of the rule of equidistant samples, and of the one between reversals.
    Equidistant = 0x4d45,
    BetweenReversals = 0x4d42,
    Table = 0x4d54,
}

const BITS: u32 = 48;

/// The seal of a checksum. Whatever one bit changes in the checksum, it changes in the 48 bits that are left of it.
#[inline(always)]
pub(crate) fn seal(kind: Kind, checksum: u64) -> f64 {
    let folded = (checksum ^ (checksum >> BITS)) & ((1 << BITS) - 1);
    f64::from_bits(((kind as u64) << BITS) | folded)
}

/// Whether a seal is of that kind, whatever it seals.
#[inline(always)]
pub(crate) fn is_of(kind: Kind, seal: f64) -> bool {
    seal.to_bits() >> BITS == kind as u64
}

/// Checksum of a long table, as fast as memory is read: the sum of all words.
#[inline(always)]
pub(crate) fn of_table(words: &[f64]) -> u64 {
    words.iter().fold(0, |sum, word| sum.wrapping_add(word.to_bits()))
}

/// Checksum of a few numbers, each in its place: their sum with the weights 1, 3, 5, ... from the last to the first. Odd weights
/// lose no change of one word.
#[inline(always)]
pub(crate) fn of_places(words: impl Iterator<Item = f64>) -> u64 {
    let (sum, sum_of_sums) = words.fold((0u64, 0u64), |(sum, sum_of_sums), word| {
        let sum = sum.wrapping_add(word.to_bits());
        (sum, sum_of_sums.wrapping_add(sum))
    });
    sum_of_sums.wrapping_mul(2).wrapping_sub(sum)
}

/// A whole number as [`whole`] reads it. The conversion is signed: that of a number without sign is a difference, which is -0
/// where the host rounds downwards.
#[inline(always)]
pub(crate) fn of_whole(number: usize) -> f64 {
    number as i64 as f64
}

/// A whole number below 2^52, read off its bits: memory of unknown contents meets no arithmetic, which would trap.
#[inline(always)]
pub(crate) fn whole(value: f64) -> Option<usize> {
    let bits = value.to_bits();
    let significand = (bits & ((1 << 52) - 1)) | (1 << 52);
    match bits >> 52 {
        0 if bits == 0 => Some(0),
        exponent @ 1023..=1074 => {
            let fraction = 1075 - exponent;
            (significand & ((1 << fraction) - 1) == 0).then_some((significand >> fraction) as usize)
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_counts_and_every_place() {
        let words = [0.0, 1.5, -2.25e-300, 7e200, 0.0];
        let seals = |words: &[f64]| {
            [seal(Kind::Table, of_table(words)), seal(Kind::State, of_places(words.iter().copied()))].map(f64::to_bits)
        };
        let good = seals(&words);
        for (place, word) in words.iter().enumerate() {
            for bit in 0..64 {
                let mut bad = words;
                bad[place] = f64::from_bits(word.to_bits() ^ (1 << bit));
                let [table, places] = seals(&bad);
                assert!(table != good[0] && places != good[1], "{place} {bit}");
            }
        }
        let mut swapped = words;
        swapped.swap(1, 3);
        assert_ne!(seals(&swapped)[1], good[1]);
    }

    #[test]
    fn whole_numbers_are_read_off_their_bits() {
        for number in [0usize, 1, 2, 3, 6, 1000, 1 << 24, (1 << 52) - 1] {
            assert_eq!(whole(of_whole(number)), Some(number));
        }
        for value in [-0.0, -1.0, 0.5, 1.5, 1e-310, 1e300, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(whole(value), None, "{value}");
        }
    }

    #[test]
    fn a_seal_is_an_ordinary_number_of_its_kind() {
        for kind in [Kind::State, Kind::Equidistant, Kind::BetweenReversals, Kind::Table] {
            for checksum in [0, 1, u64::MAX, 0x7ff0_0000_0000_0000] {
                let seal = seal(kind, checksum);
                assert!(seal.is_normal() && is_of(kind, seal));
                assert_eq!(std::format!("{seal:.17e}").parse(), Ok(seal));
            }
        }
        assert!(!is_of(Kind::State, seal(Kind::Table, 1)));
        let kinds = [Kind::State, Kind::Equidistant, Kind::BetweenReversals, Kind::Table].map(|kind| kind as u16);
        for (place, one) in kinds.iter().enumerate() {
            assert!(kinds.iter().skip(place + 1).all(|two| (one ^ two).count_ones() > 1));
        }
    }
}
