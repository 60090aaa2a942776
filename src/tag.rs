//! Tags: the first double of each buffer that the library initialises in memory of the calling application.
//!
//! A tag encodes the kind of the buffer, the version of its layout and one count, so that uninitialised memory and buffers of other
//! versions are detected by one comparison. It is a normal double, preserved by decimal output with 17 digits.

/// Version of the layout of contacts, states and workspaces.
pub(crate) const LAYOUT: u64 = 5;

/// Kind of a buffer: the leading 16 bits of its tag, a double of about 1e64.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(u16)]
pub enum Kind {
    State = 0x4d53,
    ElementState = 0x4d45,
    UniformSampling = 0x4d55,
    EventDriven = 0x4d3a,
    ElementSampling = 0x4d46,
    Samples = 0x4d4e,
    TwoDirectionsState = 0x4d58,
    TwoDirectionsSampling = 0x4d57,
    Periods = 0x4d50,
}

const COUNT_BITS: u32 = 40;

impl Kind {
    #[inline(always)]
    const fn leading_bits(self) -> u64 {
        ((self as u64) << 8) | LAYOUT
    }

    /// Tag of a buffer of this kind with a count below 2^40.
    #[inline(always)]
    pub const fn tag(self, count: usize) -> f64 {
        f64::from_bits((self.leading_bits() << COUNT_BITS) | (count as u64 & ((1 << COUNT_BITS) - 1)))
    }

    /// Count in a tag; `None` unless it is a tag of this kind and layout.
    #[inline(always)]
    pub const fn count(self, tag: f64) -> Option<usize> {
        let bits = tag.to_bits();
        if bits >> COUNT_BITS == self.leading_bits() { Some((bits & ((1 << COUNT_BITS) - 1)) as usize) } else { None }
    }
}
