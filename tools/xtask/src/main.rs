//! Chores that need the Rust source as data:
//!
//! - `header` writes the generated files and blocks: `include/microslip.h`, blocks of `include/microslip.f90`,
//!   `python/microslip/_constants.py`, tables of calls for the tests, the record of the binary interface. `header --check` fails if the
//!   committed ones are stale.

use std::env;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let result = match arguments.join(" ").as_str() {
        "header" => xtask::write_header(),
        "header --check" => xtask::check_header(),
        _ => Err("usage: xtask header [--check]".to_owned()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}
