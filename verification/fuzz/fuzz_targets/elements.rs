//! Sequences of calls of the C interface with elements; see `microslip_fuzz::calls`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use microslip_fuzz::calls::{Input, run};

fuzz_target!(|input: Input| run(&input, true));
