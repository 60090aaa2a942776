//! Errors of the program: messages for the user.

use crate::number::format_number;
use std::fmt::Display;
use std::path::Path;

#[derive(Debug)]
pub enum CliError {
    /// Invalid command line.
    Usage(String),
    /// Invalid number, parameter file or table, or a file that cannot be read or written.
    Input(String),
}

pub type Result<T> = std::result::Result<T, CliError>;

pub fn usage<T>(message: impl Into<String>) -> Result<T> {
    Err(CliError::Usage(message.into()))
}

pub fn input<T>(message: impl Into<String>) -> Result<T> {
    Err(CliError::Input(message.into()))
}

impl CliError {
    /// An error in a file, or in standard input.
    pub fn in_file(path: &Path, reason: impl Display) -> CliError {
        let name = if path == Path::new("-") { "standard input".into() } else { path.to_string_lossy() };
        CliError::Input(format!("{name}: {reason}"))
    }
}

/// Errors of the library about the value of an option.
pub fn in_option(option: &str, value: f64) -> impl Fn(microslip::Error) -> CliError + Copy {
    move |error| CliError::Input(format!("{option} {}: {error}", format_number(value)))
}
