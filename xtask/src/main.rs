//! Chores that need the Rust source as data:
//!
//! - `header` writes `include/microslip.h`, `header --check` fails when the committed one is stale;
//! - `symbols` prints the names of the exported functions.

use std::env;
use std::fs;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let result = match arguments[..] {
        ["header"] => write_header(),
        ["header", "--check"] => xtask::check_header(),
        ["symbols"] => {
            xtask::symbols().iter().for_each(|name| println!("{name}"));
            Ok(())
        }
        _ => Err("usage: xtask header [--check] | symbols".to_owned()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn write_header() -> Result<(), String> {
    let path = xtask::header_path();
    fs::write(&path, xtask::header()).map_err(|e| format!("{}: {e}", path.display()))
}
