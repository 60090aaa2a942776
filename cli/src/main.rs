//! The command line program of microslip: properties, curves and hysteresis of a contact, as CSV and as pictures.
//!
//! `args` defines the command line, `contact_spec` and `columns` read the input, `commands`, `varying_load`, `history`, `fit` and
//! `layer` compute, `plot` draws, and `files` reads and writes.

mod args;
mod canvas;
mod columns;
mod commands;
mod contact_spec;
mod error;
mod files;
mod fit;
mod history;
mod layer;
mod number;
mod plot;
mod table;
mod units;
mod varying_load;

use args::{Arguments, Command, ContactCommand};
use clap::error::ErrorKind;
use clap::{Args, FromArgMatches};
use commands::Report;
use contact_spec::ContactSpec;
use error::{CliError, Result, usage};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

fn main() -> ExitCode {
    let (mut program, matches) = (args::program(), args::program().get_matches());
    match Arguments::from_arg_matches(&matches).map_or_else(|error| error.exit(), |arguments| run(&arguments.command)) {
        Ok(status) => ExitCode::from(status),
        Err(CliError::Input(message)) => {
            print_message("error", &message);
            ExitCode::from(1)
        }
        Err(CliError::Usage(message)) => {
            // The usage of the command only.
            program.build();
            let command = matches.subcommand_name().and_then(|name| program.find_subcommand_mut(name));
            match command {
                Some(command) => command.error(ErrorKind::ValueValidation, message).exit(),
                None => program.error(ErrorKind::ValueValidation, message).exit(),
            }
        }
    }
}

/// Prints to standard error, if it is open, in the form of clap's messages.
fn print_message(kind: &str, message: &str) {
    let _ = writeln!(io::stderr(), "{kind}: {message}");
}

/// Runs a command; returns the exit status.
fn run(command: &Command) -> Result<u8> {
    match command {
        Command::Contact(command) => execute(command, &[], |_, spec| Ok(commands::contact(spec))),
        Command::Tractions(command) => execute(command, &[], commands::tractions),
        Command::Curve(command) => execute(command, &[], commands::curve),
        Command::Loop(command) => execute(command, &[], commands::hysteresis_loop),
        Command::Stiffness(command) => execute(command, &[], commands::stiffness),
        Command::History(command) => execute(command, &[&command.options.displacements], history::history),
        Command::Normal(command) => execute(command, &[], varying_load::normal),
        Command::Jenkins(command) => execute(command, &[], commands::jenkins_equivalent),
        Command::Iwan(command) => execute(command, &[], commands::iwan_equivalent),
        Command::Fit(command) => {
            let measured: Vec<_> = command.options.measured.iter().map(PathBuf::as_path).collect();
            execute(command, &measured, fit::fit)
        }
        Command::Layer(command) => execute(command, &[], layer::layer),
        Command::Example { elliptic: false } => files::write_stdout(include_bytes!("../example.toml")).map(|()| 0),
        Command::Example { elliptic: true } => {
            files::write_stdout(include_bytes!("../example_elliptic.toml")).map(|()| 0)
        }
    }
}

/// Computes the report of a command, then writes its table and picture.
fn execute<Options: Args>(
    command: &ContactCommand<Options>,
    data: &[&Path],
    compute: impl FnOnce(&Options, &ContactSpec) -> Result<Report>,
) -> Result<u8> {
    let ContactCommand { options, parameters, contact, output } = command;
    let (parameters, out, plot) = (parameters.as_deref(), output.out.as_deref(), output.plot.as_deref());
    let inputs: Vec<_> = parameters.into_iter().chain(data.iter().copied()).collect();
    files::check_outputs(&inputs, &out.into_iter().chain(plot).collect::<Vec<_>>())?;
    if inputs.iter().filter(|path| **path == Path::new("-")).count() > 1 {
        return usage("standard input cannot be both the parameter file and the table");
    }
    let plot = plot.map(|path| Ok((path, format_of(path)?))).transpose()?;
    let report = compute(options, &ContactSpec::read(parameters, contact)?)?;
    report.warnings.iter().for_each(|warning| print_message("warning", warning));
    if let Some((path, format)) = plot {
        let picture = format(report.picture.draw());
        let picture = picture.ok_or_else(|| CliError::in_file(path, "the picture is too large for the format"))?;
        files::write_file(path, &picture)?;
    }
    match out {
        Some(path) if path != Path::new("-") => files::write_file(path, report.csv().as_bytes()),
        _ => files::write_stdout(report.csv().as_bytes()),
    }?;
    Ok(report.status)
}

/// From SVG to the content of a file.
type Format = fn(String) -> Option<Vec<u8>>;

fn format_of(path: &Path) -> Result<Format> {
    let extension = path.extension().map(|extension| extension.to_ascii_lowercase());
    match extension.as_deref().and_then(|extension| extension.to_str()) {
        Some("svg") => Ok(|svg| Some(svg.into_bytes())),
        Some("png") => Ok(|svg| canvas::png(&svg)),
        _ => usage(format!("--plot {}: the extension must be .svg or .png", path.display())),
    }
}
