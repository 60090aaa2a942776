//! Input and output. "-" is standard input or standard output.

use crate::error::{CliError, Result, usage};
use std::fs;
use std::io::{self, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

/// Largest size of a parameter file, which has about 1 kB, in MB of 1e6 bytes.
pub const PARAMETERS_SIZE: u64 = 1;
/// Largest size of a table: an hour of a test rig, at 1 kHz with three columns of twelve letters, is 130 MB.
pub const TABLE_SIZE: u64 = 200;

/// Reads a file of at most `limit` MB: a device or a pipe may never end.
pub fn read_bytes(path: &Path, limit: u64) -> Result<Vec<u8>> {
    let (mut bytes, most) = (Vec::new(), 1_000_000 * limit);
    let outcome = match path.to_str() {
        Some("-") => io::stdin().take(most + 1).read_to_end(&mut bytes),
        _ => fs::File::open(path).and_then(|file| file.take(most + 1).read_to_end(&mut bytes)),
    };
    outcome.map_err(|error| CliError::in_file(path, error))?;
    if bytes.len() as u64 > most {
        return Err(CliError::in_file(path, format!("longer than {limit} MB; the input is not read further")));
    }
    Ok(bytes)
}

/// Reads a file of text in UTF-8.
pub fn read_text(path: &Path, limit: u64) -> Result<String> {
    String::from_utf8(read_bytes(path, limit)?).map_err(|error| {
        let valid = error.as_bytes().iter().take(error.utf8_error().valid_up_to());
        let line = 1 + valid.filter(|byte| **byte == b'\n').count();
        CliError::in_file(path, format!("line {line}: invalid UTF-8; save the file as UTF-8 text"))
    })
}

/// Writes to standard output. A closed pipe is no error: its reader needs no more.
pub fn write_stdout(bytes: &[u8]) -> Result<()> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(CliError::in_file(Path::new("standard output"), error))
        }
        _ => Ok(()),
    }
}

/// Writes a file in place: links are followed, and the permissions of an existing file stay.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<()> {
    let mut file = fs::File::create(path).map_err(|error| CliError::in_file(path, error))?;
    file.write_all(bytes).map_err(|error| CliError::in_file(path, format!("{error}; the file is incomplete")))
}

/// Rejects outputs that would overwrite an input or each other.
pub fn check_outputs(inputs: &[&Path], outputs: &[&Path]) -> Result<()> {
    let files = |paths: &[&Path]| -> Vec<PathBuf> {
        let paths = paths.iter().filter(|path| **path != Path::new("-"));
        paths.map(|path| fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf())).collect()
    };
    let (inputs, outputs) = (files(inputs), files(outputs));
    match outputs.iter().find(|path| inputs.contains(path)) {
        Some(path) => usage(format!("{} is an input and is not overwritten", path.display())),
        None if outputs.len() == 2 && outputs[0] == outputs[1] => usage("two outputs cannot be the same file"),
        None => Ok(()),
    }
}
