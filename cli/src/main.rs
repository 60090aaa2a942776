//! The command line of microslip, for whoever wants numbers before linking anything.
//!
//! `arguments` is what can be asked, `parameters` and `path` are what is read, `commands` what is computed, `table` and
//! `picture` how it is shown, `output` where it goes.

mod arguments;
mod commands;
mod digits;
mod output;
mod parameters;
mod path;
mod picture;
mod refusal;
mod table;
mod units;

use arguments::{About, Arguments, Command};
use clap::error::ErrorKind;
use clap::{Args, CommandFactory, Parser};
use commands::Answer;
use parameters::{Described, describe};
use picture::Format;
use refusal::{Outcome, Refusal, usage};
use std::fmt::Display;
use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    match run(&Arguments::parse().command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(Refusal::Input(sentence)) => {
            // Where there is no standard error there is nobody to tell.
            let _ = writeln!(io::stderr(), "microslip: {}", sentence.trim_end());
            ExitCode::from(1)
        }
        Err(Refusal::Usage(sentence)) => Arguments::command().error(ErrorKind::ValueValidation, sentence).exit(),
    }
}

fn run(command: &Command) -> Outcome<()> {
    match command {
        Command::Contact(about) => give(about, None, |_, contact| Ok(commands::contact(contact))),
        Command::Tractions(about) => give(about, None, commands::tractions),
        Command::Curve(about) => give(about, None, commands::curve),
        Command::Loop(about) => give(about, None, commands::hysteresis_loop),
        Command::Stiffness(about) => give(about, None, commands::stiffness),
        Command::History(about) => give(about, Some(&about.question.displacements), commands::history),
        Command::Jenkins(about) => give(about, None, commands::jenkins_equivalent),
        Command::Iwan(about) => give(about, None, commands::iwan_equivalent),
        Command::Example { elliptic: false } => output::to_stdout(include_bytes!("../example.toml")),
        Command::Example { elliptic: true } => output::to_stdout(include_bytes!("../example_elliptic.toml")),
    }
}

/// Computes the answer and writes it where the user wants it, all of it or nothing.
fn give<Question: Args>(
    about: &About<Question>,
    displacements: Option<&Path>,
    answer: impl FnOnce(&Question, Described) -> Outcome<Answer>,
) -> Outcome<()> {
    let About { question, source, output } = about;
    let parameters = source.file.as_deref();
    let inputs: Vec<_> = parameters.into_iter().chain(displacements).collect();
    let outputs: Vec<_> = output.out.as_deref().into_iter().chain(output.plot.as_deref()).collect();
    output::keep_apart(&inputs, &outputs)?;
    let plot = output.plot.as_deref().map(|path| Ok((path, format_of(path)?))).transpose()?;
    if [parameters, displacements] == [Some(Path::new("-")); 2] {
        return usage("standard input cannot be both the parameter file and the displacements");
    }

    let answer = answer(question, describe(parameters, &source.given)?)?;
    let not_made = |error: &dyn Display| Refusal::Input(format!("the result cannot be written: {error}"));
    let table = answer.table().map_err(|error| not_made(&error))?;
    if let Some((path, format)) = plot {
        let picture = answer.picture().draw(format).map_err(|error| not_made(&error))?;
        output::to_file(path, &picture)?;
    }
    match &output.out {
        Some(path) => output::to_file(path, &table),
        None => output::to_stdout(&table),
    }
}

fn format_of(path: &Path) -> Outcome<Format> {
    let ends_with = |wanted| path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(wanted));
    match [ends_with("svg"), ends_with("png")] {
        [true, _] => Ok(Format::Svg),
        [_, true] => Ok(Format::Png),
        _ => usage(format!("--plot {}: the name must end with .svg or .png", path.display())),
    }
}
