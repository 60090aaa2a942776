//! Calls of the C interface with traps, with some of their outputs and with all of them.

use microslip::Error;
use microslip::ffi::MSLIP_OK;
use std::ptr::null_mut;

/// Initial value of all memory, also of outputs: a NaN that is no tag.
pub const UNTOUCHED: f64 = f64::from_bits(0x7ff8_5ee5_5ee5_5ee5);

pub fn untouched(values: &[f64]) -> bool {
    values.iter().all(|value| value.to_bits() == UNTOUCHED.to_bits())
}

pub fn same(one: &[f64], two: &[f64]) -> bool {
    one.len() == two.len() && one.iter().zip(two).all(|(one, two)| one.to_bits() == two.to_bits())
}

pub fn not_negative(value: f64) -> bool {
    value >= 0.0 && value.is_finite()
}

/// Asserts a bound of all values; NaN violates it.
#[macro_export]
macro_rules! all {
    ($values:expr, $bound:expr) => {
        assert!($values.iter().copied().all($bound), "{}: {:?}", stringify!($bound), $values)
    };
}

/// The control word of SSE with invalid operation, division by zero and overflow unmasked, or with all exceptions masked.
#[cfg(target_arch = "x86_64")]
fn set_traps(trap: bool) {
    let word: u32 = if trap { 0x1f80 & !(0x080 | 0x200 | 0x400) } else { 0x1f80 };
    unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const word, options(nostack)) }
}

#[cfg(not(target_arch = "x86_64"))]
fn set_traps(_: bool) {}

/// The status of a call, which must be a declared one; floating-point exceptions of valid calls end the run.
pub fn status(valid: bool, function: impl FnOnce() -> i32) -> i32 {
    set_traps(valid);
    let status = function();
    set_traps(false);
    assert!(status == MSLIP_OK || Error::ALL.iter().any(|error| error.code() == status), "undeclared status {status}");
    status
}

/// Calls a function with some of its outputs, and again with all of them: `None` if rejected, or if the memory is not valid.
pub fn run<const K: usize>(
    valid: bool,
    omitted: u8,
    lengths: [usize; K],
    mut function: impl FnMut([*mut f64; K]) -> i32,
) -> Option<[Vec<f64>; K]> {
    let mut some = lengths.map(|length| vec![UNTOUCHED; length]);
    let mut k = 0;
    let pointers = some.each_mut().map(|output| {
        k += 1;
        if omitted >> (k - 1) & 1 == 1 { null_mut() } else { output.as_mut_ptr() }
    });
    let first = status(valid, || function(pointers));
    if first != MSLIP_OK {
        assert!(some.iter().all(|output| untouched(output)), "a rejected call has modified an output: {some:?}");
        return None;
    }
    if !valid {
        return None;
    }
    let mut all = lengths.map(|length| vec![UNTOUCHED; length]);
    let pointers = all.each_mut().map(Vec::as_mut_ptr);
    assert!(status(true, || function(pointers)) == MSLIP_OK, "accepted with some outputs, rejected with all");
    for (k, (some, all)) in some.iter().zip(&all).enumerate() {
        assert!(omitted >> k & 1 == 1 || same(some, all), "output {k} is {some:?}, with all outputs {all:?}");
    }
    Some(all)
}
