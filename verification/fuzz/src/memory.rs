//! Arrays whose ends are guarded: by AddressSanitizer, which detects the end of an allocation, or by guard words.

/// Uninitialised memory: neither a tag nor a number.
pub const UNTOUCHED: f64 = f64::from_bits(0x7ff8_5ee5_5ee5_5ee5);

const GUARDS: usize = if cfg!(feature = "guards") { 2 } else { 0 };
const GUARD: u64 = 0x7ff8_0bad_0bad_0bad;

/// Doubles of exact length.
pub struct Array(Vec<f64>);

impl Array {
    pub fn new(length: usize, value: f64) -> Array {
        let mut cells = Vec::with_capacity(length + 2 * GUARDS);
        let guard = |cells: &mut Vec<f64>| cells.resize(cells.len() + GUARDS, f64::from_bits(GUARD));
        guard(&mut cells);
        cells.resize(GUARDS + length, value);
        guard(&mut cells);
        Array(cells)
    }

    pub fn of(values: impl ExactSizeIterator<Item = f64>) -> Array {
        let mut array = Array::new(values.len(), 0.0);
        array.values_mut().iter_mut().zip(values).for_each(|(place, value)| *place = value);
        array
    }

    pub fn copy(&self) -> Array {
        Array::of(self.values().iter().copied())
    }

    pub fn values(&self) -> &[f64] {
        &self.0[GUARDS..self.0.len() - GUARDS]
    }

    pub fn values_mut(&mut self) -> &mut [f64] {
        let end = self.0.len() - GUARDS;
        &mut self.0[GUARDS..end]
    }

    pub fn pointer(&self) -> *const f64 {
        self.values().as_ptr()
    }

    pub fn pointer_mut(&mut self) -> *mut f64 {
        self.values_mut().as_mut_ptr()
    }

    pub fn is(&self, other: &Array) -> bool {
        same(self.values(), other.values())
    }
}

/// Whether two arrays are equal, bit for bit.
pub fn same(one: &[f64], two: &[f64]) -> bool {
    // Doubles are bytes without gaps.
    let bytes =
        |numbers: &[f64]| unsafe { std::slice::from_raw_parts(numbers.as_ptr().cast::<u8>(), size_of_val(numbers)) };
    bytes(one) == bytes(two)
}

/// Length of the part of a state that is in use: a header of 5 doubles, whose first holds the number of reversals in its last 40
/// bits, and 3 for each of them.
pub fn used_length(state: &[f64]) -> usize {
    5 + 3 * (state[0].to_bits() & 0xff_ffff_ffff) as usize
}

impl Drop for Array {
    fn drop(&mut self) {
        let (front, back) = (&self.0[..GUARDS], &self.0[self.0.len() - GUARDS..]);
        assert!(front.iter().chain(back).all(|guard| guard.to_bits() == GUARD), "a guard word was overwritten");
    }
}

/// An output; `None` is not requested.
pub struct Output(pub Option<Array>);

impl Output {
    pub fn new(requested: bool, length: usize) -> Output {
        Output(requested.then(|| Array::new(length, UNTOUCHED)))
    }

    pub fn pointer(&mut self) -> *mut f64 {
        self.0.as_mut().map_or(std::ptr::null_mut(), Array::pointer_mut)
    }

    /// Empty for an output that is not requested.
    pub fn values(&self) -> &[f64] {
        self.0.as_ref().map_or(&[], Array::values)
    }

    pub fn is_untouched(&self) -> bool {
        self.values().iter().all(|value| value.to_bits() == UNTOUCHED.to_bits())
    }
}
