//! Calls of the C interface with changed arguments, one after the other; see `tests/calls/mutation.rs`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use microslip_fuzz::interface::mutation::{Bytes, mutated_call};

fuzz_target!(|bytes: &[u8]| {
    let mut bytes = Bytes::new(bytes);
    while !bytes.is_empty() {
        mutated_call(&mut bytes);
    }
});
