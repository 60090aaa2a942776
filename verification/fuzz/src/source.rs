//! An input, read from its front: choices, lengths and numbers.

/// The bytes of an input; zeros follow its end.
pub struct Source<'a> {
    bytes: &'a [u8],
    /// Numbers drawn before, to be met again.
    past: [f64; 8],
    next: usize,
}

/// Where the library's own comparisons are, and the ends of what doubles can be.
const SPECIAL: [f64; 20] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    5e-324,
    -5e-324,
    f64::MIN_POSITIVE,
    1e-300,
    1e-160,
    1e-8,
    0.5,
    1e150,
    -1e150,
    1.000_000_000_000_000_2e150,
    1e160,
    f64::MAX,
    f64::MIN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
];

impl<'a> Source<'a> {
    pub fn new(bytes: &'a [u8]) -> Source<'a> {
        Source { bytes, past: [0.0; 8], next: 0 }
    }

    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    pub fn byte(&mut self) -> u8 {
        match self.bytes.split_first() {
            Some((first, rest)) => {
                self.bytes = rest;
                *first
            }
            None => 0,
        }
    }

    /// One of `count` choices.
    pub fn below(&mut self, count: usize) -> usize {
        self.byte() as usize % count
    }

    fn signed(&mut self) -> i32 {
        self.byte() as i8 as i32
    }

    fn word(&mut self) -> i32 {
        i16::from_le_bytes([self.byte(), self.byte()]) as i32
    }

    /// Any number; most are some multiple of `scale`, or of numbers drawn before.
    pub fn number(&mut self, scale: f64) -> f64 {
        let neighbour = |value: f64, by: i32| f64::from_bits(value.to_bits().wrapping_add_signed(by.into()));
        let kind = self.byte();
        let number = match kind % 16 {
            0..6 => scale * (self.word() as f64 / 8192.0),
            6 => scale * (1.0 - 2f64.powi(-(self.byte() as i32 % 64))),
            7 => scale * 2f64.powi(self.signed()),
            8 => neighbour(scale, self.signed() / 16),
            9 | 10 => self.past[self.byte() as usize % 8],
            11 => neighbour(self.past[self.byte() as usize % 8], self.signed() / 16),
            12 => self.past[self.byte() as usize % 8] + scale * self.word() as f64 * 2f64.powi(-24),
            13 => SPECIAL[self.byte() as usize % SPECIAL.len()],
            14 => self.past[self.byte() as usize % 8] * (self.signed() as f64 / 64.0),
            // Any bits: a signalling NaN among them.
            _ => f64::from_bits(u64::from_le_bytes([(); 8].map(|()| self.byte()))),
        };
        let number = if kind & 0x80 != 0 { -number } else { number };
        self.past[self.next % 8] = number;
        self.next += 1;
        number
    }

    /// 1 mostly, or another power of 2.
    pub fn power(&mut self) -> f64 {
        let byte = self.byte();
        if byte < 128 { 1.0 } else { 2f64.powi(byte as i8 as i32 / 2 + 32) }
    }

    /// A number near `typical` mostly, for the fields of parameters.
    pub fn magnitude(&mut self, typical: f64) -> f64 {
        match self.byte() {
            0..64 => typical,
            64..192 => typical * 2f64.powf(self.signed() as f64 / 8.0),
            192..224 => typical * 2f64.powi(4 * self.signed()),
            _ => self.number(typical),
        }
    }

    /// How many numbers an array has: a few mostly.
    pub fn length(&mut self) -> usize {
        let byte = self.byte() as usize;
        if byte < 224 { byte % 9 } else { byte - 223 }
    }

    /// More numbers than memory can hold, rarely.
    pub fn huge(&mut self) -> Option<usize> {
        const LEAST: usize = isize::MAX as usize / 8 + 1;
        match self.byte() {
            0xff => Some(usize::MAX),
            0xfe => Some(LEAST),
            0xfd => Some(isize::MAX as usize),
            0xfc => Some(1 << 61),
            _ => None,
        }
    }
}

/// Displacements without a pattern: anywhere within a width that may shrink, or where one of the last was.
pub struct Scatter {
    state: u32,
    width: f64,
    decay: f64,
}

impl Scatter {
    pub fn new(source: &mut Source, width: f64) -> Scatter {
        let decay = 1.0 - 2f64.powi(-(source.byte() as i32 % 16));
        Scatter { state: source.byte() as u32 | 1, width, decay }
    }

    pub fn next(&mut self, before: &[f64]) -> f64 {
        self.state = self.state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        self.width *= self.decay;
        let back = (self.state >> 8) as usize % 16 + 1;
        match before.len().checked_sub(back) {
            Some(place) if self.state >> 30 == 0 => before[place],
            _ => self.width * ((self.state >> 8) as f64 * 2f64.powi(-23) - 1.0),
        }
    }
}
