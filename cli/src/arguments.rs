//! The command line.

use crate::parameters::Given;
use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

/// The friction law of a contact: its numbers, curves, loops and complex stiffness as CSV and as pictures.
///
/// The contact is a flat with rounded edges, a cylinder or an elliptical Hertz contact, under a
/// constant normal force. A parameter file describes it, or flags, or both: flags override the file.
#[derive(Debug, Parser)]
#[command(name = "microslip", version, verbatim_doc_comment, after_help = NOTES)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

const NOTES: &str = "\
Units:
  All numbers, given and computed, are in SI units: m, N, Pa, N/m, J; with --units mm (in a
  parameter file: units = \"mm\") in mm, N, MPa, N/mm, mJ. Forces are those of the whole contact.

Results:
  CSV on standard output, or in the file after --out: comments (#) with the command that
  repeats the result, a header with units, numbers that read back as the same bits. --plot
  draws them too.

Exit status:
  0: done; 1: a number or a file was refused; 2: wrong usage.

For example:
  microslip example > contact.toml
  microslip contact contact.toml
  microslip loop contact.toml --amplitude 2e-6,5e-6 --out loop.csv --plot loop.svg
  microslip stiffness contact.toml --normal-force 1200 --plot stiffness.png";

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Half-width, slip force and displacement, initial stiffness, slip energy, largest pressure
    Contact(About<Itself>),
    /// Pressure, shear, slip and frictional damage along the width, under a force
    Tractions(About<Tractions>),
    /// The monotonic curve: force, stiffness and stick zone over the displacement
    Curve(About<Curve>),
    /// Hysteresis loops between +amplitude and -amplitude, and the energy they dissipate
    Loop(About<Loop>),
    /// Complex stiffness K' + iK'' over the displacement amplitude
    Stiffness(About<Amplitudes>),
    /// Force, stiffness and dissipated energy along any history of displacements
    History(About<History>),
    /// Jenkins' spring-slider of the same complex stiffness, over the displacement amplitude
    Jenkins(About<Amplitudes>),
    /// Iwan's model: parallel spring-sliders with the contact's monotonic curve
    Iwan(About<Iwan>),
    /// Print a parameter file with comments
    Example {
        /// Of an elliptical contact, in mm, N, MPa
        #[arg(long)]
        elliptic: bool,
    },
}

/// A question about a contact: what is asked, where the contact comes from, and where the answer goes.
#[derive(Debug, Args)]
pub struct About<Question: Args> {
    #[command(flatten)]
    pub question: Question,
    #[command(flatten)]
    pub source: Source,
    #[command(flatten)]
    pub output: Output,
}

/// Nothing but the contact itself.
#[derive(Debug, Args)]
pub struct Itself {}

/// Where the contact comes from.
#[derive(Debug, Args)]
pub struct Source {
    /// Parameter file (`microslip example` prints one), or - for standard input
    #[arg(value_name = "PARAMETERS.toml")]
    pub file: Option<PathBuf>,
    #[command(flatten)]
    pub given: Given,
}

/// Where results go.
#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
pub struct Output {
    /// Write the table to a file instead of standard output
    #[arg(long, value_name = "FILE.csv")]
    pub out: Option<PathBuf>,
    /// Draw a picture too, in the format that the name ends with
    #[arg(long, value_name = "FILE.svg|FILE.png")]
    pub plot: Option<PathBuf>,
}

const RELATIVE: &str =
    "Read forces as multiples of the slip force, displacements as multiples of the slip displacement";

#[derive(Debug, Args)]
pub struct Tractions {
    /// Tangential forces, at most mu N [default: half of mu N]
    #[arg(long, value_name = "N", value_delimiter = ',', allow_hyphen_values = true)]
    pub force: Vec<f64>,
    /// Positions along the width [default: points from -b to b, denser at the edges]
    #[arg(long, value_name = "m", value_delimiter = ',', allow_hyphen_values = true, conflicts_with = "points")]
    pub position: Vec<f64>,
    /// Number of positions
    #[arg(long, value_name = "COUNT", default_value_t = 201, value_parser = at_least_two())]
    pub points: u32,
    #[arg(long, help = RELATIVE)]
    pub relative: bool,
}

#[derive(Debug, Args)]
pub struct Curve {
    /// Largest displacement of an equidistant grid from 0 [default: 1.25 slip displacements]
    #[arg(long, value_name = "m", allow_hyphen_values = true)]
    pub to: Option<f64>,
    /// Number of points of the grid
    #[arg(long, value_name = "COUNT", default_value_t = 201, value_parser = at_least_two())]
    pub points: u32,
    /// These displacements instead of a grid
    #[arg(long, value_name = "m", value_delimiter = ',', allow_hyphen_values = true, conflicts_with_all = ["to", "points"])]
    pub displacement: Vec<f64>,
    /// These forces, at most mu N, instead of a grid
    #[arg(long, value_name = "N", value_delimiter = ',', allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["to", "points", "displacement"])]
    pub force: Vec<f64>,
    #[arg(long, help = RELATIVE)]
    pub relative: bool,
}

#[derive(Debug, Args)]
pub struct Loop {
    /// Displacement amplitudes [default: 0.5, 1 and 1.5 slip displacements]
    #[arg(long, value_name = "m", value_delimiter = ',', allow_hyphen_values = true)]
    pub amplitude: Vec<f64>,
    /// Instants of a period, equidistant in time; the first one closes the loop too
    #[arg(long, value_name = "COUNT", default_value_t = 200, value_parser = at_least_two())]
    pub points: u32,
    #[arg(long, help = RELATIVE)]
    pub relative: bool,
}

/// Displacement amplitudes, on a logarithmic grid or one by one.
#[derive(Debug, Args)]
pub struct Amplitudes {
    /// Smallest amplitude of a logarithmic grid [default: 0.01 slip displacements]
    #[arg(long, value_name = "m", allow_hyphen_values = true)]
    pub from: Option<f64>,
    /// Largest amplitude of the grid [default: 100 slip displacements]
    #[arg(long, value_name = "m", allow_hyphen_values = true)]
    pub to: Option<f64>,
    /// Number of amplitudes of the grid
    #[arg(long, value_name = "COUNT", default_value_t = 201, value_parser = at_least_two())]
    pub points: u32,
    /// These amplitudes instead of a grid
    #[arg(long, value_name = "m", value_delimiter = ',', allow_hyphen_values = true, conflicts_with_all = ["from", "to", "points"])]
    pub amplitude: Vec<f64>,
    #[arg(long, help = RELATIVE)]
    pub relative: bool,
}

#[derive(Debug, Args)]
pub struct History {
    /// Table of displacements, one a row, from the first loading on; - is standard input
    #[arg(long, value_name = "FILE.csv", default_value = "-")]
    pub displacements: PathBuf,
    /// The column to take, by its name in the header or its number from 1 [default: displacement, or the only one]
    #[arg(long, value_name = "NAME")]
    pub column: Option<String>,
    #[arg(long, help = RELATIVE)]
    pub relative: bool,
}

#[derive(Debug, Args)]
pub struct Iwan {
    /// Number of spring-sliders
    #[arg(long, value_name = "COUNT", default_value_t = 5)]
    pub count: u32,
}

/// A grid has its two ends; a million points are more than a picture can show.
fn at_least_two() -> clap::builder::RangedI64ValueParser<u32> {
    clap::value_parser!(u32).range(2..=1_000_000)
}
