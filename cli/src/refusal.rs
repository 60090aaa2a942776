//! Why nothing was computed, in a sentence for the user.

use std::fmt::Display;
use std::path::Path;

#[derive(Debug)]
pub enum Refusal {
    /// The command line does not say what to do.
    Usage(String),
    /// A number, a parameter file or a table is not what it should be, or a file cannot be read or written.
    Input(String),
}

pub type Outcome<T> = Result<T, Refusal>;

pub fn usage<T>(sentence: impl Into<String>) -> Outcome<T> {
    Err(Refusal::Usage(sentence.into()))
}

pub fn input<T>(sentence: impl Into<String>) -> Outcome<T> {
    Err(Refusal::Input(sentence.into()))
}

impl Refusal {
    /// What is wrong in that file.
    pub fn in_file(path: &Path, reason: impl Display) -> Refusal {
        let name = if path == Path::new("-") { "standard input".into() } else { path.to_string_lossy() };
        Refusal::Input(format!("{name}: {reason}"))
    }

    /// What the library says of the value of that flag.
    pub fn of_flag(flag: &str, value: impl Display, error: microslip::Error) -> Refusal {
        Refusal::Input(format!("{flag} {value}: {error}"))
    }
}
