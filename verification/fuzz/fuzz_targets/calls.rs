//! Sequences of calls of the C interface with contacts; see `microslip_fuzz::calls`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use microslip_fuzz::calls::{Input, run};

fuzz_target!(|input: Input| run(&input, false));
