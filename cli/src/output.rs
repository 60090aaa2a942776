//! Where results go: standard output, or files that are whole or not there.

use crate::refusal::{Outcome, Refusal, input, usage};
use std::fs::{self, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Writes to standard output; a reader that has seen enough is no error.
pub fn to_stdout(bytes: &[u8]) -> Outcome<()> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => input(format!("standard output: {error}")),
        _ => Ok(()),
    }
}

/// Writes a file beside its place and moves it there. What is no file, such as `/dev/null` or a pipe, is written to.
pub fn to_file(path: &Path, bytes: &[u8]) -> Outcome<()> {
    write(path, bytes).map_err(|error| Refusal::in_file(path, error))
}

fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if fs::metadata(path).is_ok_and(|existing| !existing.is_file()) {
        return OpenOptions::new().write(true).open(path)?.write_all(bytes);
    }
    let path = same_place(path); // so that a link stays one
    let directory = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666)); // less the umask
    let mut file = builder.prefix(".microslip").tempfile_in(directory)?;
    file.write_all(bytes)?;
    file.persist(&path)?;
    Ok(())
}

fn same_place(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

/// Refuses outputs that would replace an input or each other.
pub fn keep_apart(inputs: &[&Path], outputs: &[&Path]) -> Outcome<()> {
    for (i, output) in outputs.iter().enumerate() {
        let is_output = |other: &&&Path| same_place(other) == same_place(output);
        if inputs.iter().any(|input| is_output(&input)) {
            return usage(format!("{} is an input and is not overwritten", output.display()));
        }
        if outputs[..i].iter().any(|other| is_output(&other)) {
            return usage(format!("{} cannot be both the table and the picture", output.display()));
        }
    }
    Ok(())
}
