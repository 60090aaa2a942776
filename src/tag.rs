//! Tags: the first double of each buffer that the library initialises in memory of the calling application.
//!
//! A tag encodes the kind of the buffer and the version of its layout, so that uninitialised memory and buffers of other versions
//! are detected by one comparison. It is a whole number of 15 digits of which the last is not 0: decimal text of 15 significant
//! digits or more preserves it, and text of fewer digits does not. Counts follow as doubles of their own, which are whole numbers
//! too.

/// Version of the layout of contacts, states and workspaces.
pub(crate) const LAYOUT: u64 = 6;

/// Kind of a buffer: the leading five digits of its tag.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(u16)]
pub enum Kind {
    State = 0x4d53,
    ElementState = 0x4d45,
    UniformSampling = 0x4d55,
    EventDriven = 0x4d3a,
    ElementSampling = 0x4d46,
    TwoDirectionsState = 0x4d58,
    TwoDirectionsSampling = 0x4d57,
}

impl Kind {
    /// Tag of a buffer of this kind.
    pub const fn tag(self) -> f64 {
        (self as u64 * 10_000_000_000 + 10 * LAYOUT + 1) as f64
    }

    pub const fn is_tag(self, value: f64) -> bool {
        value.to_bits() == self.tag().to_bits()
    }
}

/// 2^52: the sum with a smaller whole number has this number as its last 52 bits.
const WHOLE: f64 = f64::from_bits((1023 + 52) << 52);

/// A count as a double. Unsigned integers would be converted by a subtraction, which gives -0 if the rounding direction is
/// downwards.
pub(crate) fn stored(count: usize) -> f64 {
    count.cast_signed() as f64
}

/// The count that a double stores: the nearest whole number if the double was changed since then; `None` if no count is stored as
/// this double.
pub(crate) fn count(stored: f64) -> Option<usize> {
    // The bit patterns of negative doubles and NaNs are larger.
    if stored.to_bits() >= WHOLE.to_bits() {
        None
    } else {
        usize::try_from((stored + WHOLE).to_bits() - WHOLE.to_bits()).ok()
    }
}

/// Whether a double is a count.
pub(crate) fn is_count(stored: f64) -> bool {
    count(stored).is_some_and(|count| count as f64 == stored)
}
