//! The command line.

use crate::contact_spec::ContactArgs;
use crate::number::parse_number;
use crate::units::DataUnits;
use clap::{Arg, ArgAction, Args, Command as Program, CommandFactory, Parser, Subcommand, ValueEnum, value_parser};
use std::any::TypeId;
use std::path::PathBuf;

/// Friction law of a contact: properties, curves, hysteresis loops and complex stiffness as CSV and as pictures.
///
/// The contact is a flat with rounded edges, a cylinder or an elliptical Hertz contact. The normal force is
/// constant, or varies (history, loop). Parameters are given by a file, by options, or by both: options override the file.
#[derive(Debug, Parser)]
#[command(name = "microslip", version, verbatim_doc_comment, after_help = GENERAL_HELP)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

/// The program, with what all options of a kind have in common.
pub fn program() -> Program {
    Arguments::command().mut_subcommands(|command| command.mut_args(of_kind))
}

/// Numbers may be negative, or have exponents of Fortran. Lists are separated by commas. A grid has both ends at least.
fn of_kind(option: Arg) -> Arg {
    let is_number = option.get_value_parser().type_id() == TypeId::of::<f64>();
    let option = match option.get_id().as_str() {
        "points" => option.value_parser(value_parser!(u32).range(2..=1_000_000)),
        _ if is_number => option.value_parser(parse_number).allow_hyphen_values(true),
        _ => option,
    };
    if matches!(option.get_action(), ArgAction::Append) { option.value_delimiter(',') } else { option }
}

macro_rules! units_help {
    () => {
        "Units:
  Input and output are in SI units: m, N, Pa, N/m, J. With --units mm (in a parameter file: units = \"mm\")
  they are in mm, N, MPa, N/mm, mJ. Forces are totals of the contact.\n\n"
    };
}

/// Help after the options of a command: columns of its table, units, example.
macro_rules! help {
    ($columns:literal, $example:literal) => {
        concat!("Columns:\n  ", $columns, "\n\n", units_help!(), "Example:\n  microslip ", $example)
    };
}

const GENERAL_HELP: &str = concat!(
    units_help!(),
    "Numbers:
  Exponents are written 1e-6 or 1d-6, lists 5e-7,1e-6 without blanks or \"5e-7, 1e-6\" in quotes.

Tables:
  Columns are separated by commas, semicolons, tabs or blanks. Text before the first row of numbers, comments (#, %, !, //)
  and empty lines are not read, except names of the columns, and their units: \"force [kN]\", \"force (kN)\" or a row of units.
  The decimal mark is a point or, unless commas separate columns, a comma; what may be read in two ways is rejected.
  At most 4 million rows and 200 MB are read.

Results:
  CSV on standard output or in the file of --out: comments (#) with the command that repeats the result and the contact, a header
  with units, and numbers that are read back bit for bit. --plot also draws them.

Exit status:
  0: success; 1: invalid number or file; 2: invalid command line; 3: of `fit`, the law does not explain the loops.

Examples:
  microslip example > contact.toml
  microslip contact contact.toml
  microslip loop contact.toml --amplitude 2e-6,5e-6 --out loop.csv --plot loop.svg
  microslip stiffness contact.toml --normal-force 1200 --plot stiffness.png"
);

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Half-width, slip force and displacement, initial stiffness, slip energy, maximum pressure
    #[command(after_help = help!("quantity, value, unit", "contact contact.toml --plot pressure.svg"))]
    Contact(ContactCommand<NoOptions>),
    /// Pressure, shear, slip and frictional damage parameter along the width, under tangential forces
    #[command(after_help = help!(
        "force, x, pressure, shear; slip and damage (mu * pressure * |slip|) unless elliptical",
        "tractions contact.toml --relative --force 0.5,0.9 --plot tractions.svg"
    ))]
    Tractions(ContactCommand<Tractions>),
    /// Monotonic curve: force, stiffness and stick zone over the displacement
    #[command(after_help = help!(
        "displacement, force, stiffness, stick_half_width",
        "curve contact.toml --to 2e-6 --points 401 --out curve.csv"
    ))]
    Curve(ContactCommand<Curve>),
    /// Hysteresis loops between +amplitude and -amplitude under a constant or varying normal force
    #[command(after_help = help!(
        "amplitude, displacement, force, dissipated (energy per cycle)
  with --normal-amplitude: amplitude, phase, displacement, normal_force, force, dissipated,
  dissipated_constant (energy per cycle under the constant normal force)",
        "loop contact.toml --amplitude 5e-7,1e-6 --plot loop.svg
  microslip loop contact.toml --amplitude 1e-6 --normal-amplitude 320 --phase 0,90 --plot loop.svg"
    ))]
    Loop(ContactCommand<Loop>),
    /// Complex stiffness K' + iK'' over the displacement amplitude
    #[command(after_help = help!(
        "amplitude, k_real, k_imag, dk_real and dk_imag (derivatives by the amplitude), dissipated (energy per cycle)",
        "stiffness contact.toml --from 1e-8 --to 1e-4 --plot stiffness.svg"
    ))]
    Stiffness(ContactCommand<Amplitudes>),
    /// Force, stiffness and dissipated energy along a displacement history, in one tangential direction or two, under a constant or
    /// given normal force
    #[command(after_help = help!(
        "displacement, force, stiffness, dissipated (energy of each step), dissipated_total (energy up to the end of the step)
  if the normal force varies: displacement, approach (if given), normal_force, force, stiffness, dissipated, dissipated_total
  in two directions: displacement_x, displacement_y, approach (if given), normal_force, force_x, force_y, dissipated,
  dissipated_total",
        "history contact.toml --displacements measured.csv --column u --plot history.svg
  microslip history contact.toml --displacements measured.csv --column u --normal-force-column N
  microslip history contact.toml --displacements measured.csv --column u --column-y v --normal-force-column N"
    ))]
    History(ContactCommand<History>),
    /// Normal law: normal force, stiffness and half-width over the normal approach, from first contact
    #[command(after_help = help!(
        "approach, normal_force, stiffness, half_width",
        "normal contact.toml --plot normal.svg
  microslip normal contact.toml --force 100,400,800"
    ))]
    Normal(ContactCommand<Normal>),
    /// Equivalent Jenkins elements: spring-sliders of equal complex stiffness, over the displacement amplitude
    #[command(after_help = help!(
        "amplitude, stiffness, slip_force", "jenkins contact.toml --amplitude 1e-6"
    ))]
    Jenkins(ContactCommand<Amplitudes>),
    /// Iwan model: parallel spring-sliders that approximate the monotonic curve
    #[command(after_help = help!("slider, stiffness, slip_force", "iwan contact.toml --count 10 --plot iwan.svg"))]
    Iwan(ContactCommand<Iwan>),
    /// Fit friction coefficient, compliances and shape to measured loops of displacement and force
    #[command(after_help = help!(
        "quantity, value, lower, upper (95 % confidence), unit, status (fixed, determined, bounded, lower_bound, not_determined);
  comments have the verdict: whether the law explains the loops (exit status 3 if not), and which parameters they determine",
        "fit contact.toml --measured loop1.csv,loop2.csv --data-units um,N --loads 100,200 --plot fit.svg
  microslip fit contact.toml --measured rig1.csv,rig2.csv --column x --force-column F --normal-force-column N --fix shape"
    ))]
    Fit(ContactCommand<Fit>),
    /// Layer in series with the contact, from measured stiffnesses of both together, or the rms height of the roughness (Persson)
    #[command(after_help = help!(
        "quantity, value, lower, upper (of the literature), unit; comments have the lines of a parameter file and of Fortran",
        "layer contact.toml --measured-stiffness 60e6 --at 300
  microslip layer contact.toml --measured-stiffness 40e6,60e6 --at 150,300
  microslip layer contact.toml --rms-height 0.8e-6"
    ))]
    Layer(ContactCommand<LayerOptions>),
    /// Print a parameter file with comments
    #[command(after_help = "Example:\n  microslip example > contact.toml")]
    Example {
        /// Of an elliptical contact, in mm, N, MPa
        #[arg(long)]
        elliptic: bool,
    },
}

/// A command about a contact: its own options, the contact, and the output.
#[derive(Debug, Args)]
pub struct ContactCommand<Options: Args> {
    #[command(flatten)]
    pub options: Options,
    /// Parameter file (`microslip example` prints one); - is standard input
    #[arg(value_name = "PARAMETERS.toml")]
    pub parameters: Option<PathBuf>,
    #[command(flatten)]
    pub contact: ContactArgs,
    #[command(flatten)]
    pub output: Output,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
pub struct Output {
    /// File of the table; - is standard output [default: -]
    #[arg(long, value_name = "FILE.csv")]
    pub out: Option<PathBuf>,
    /// File of a picture, in the format of its extension
    #[arg(long, value_name = "FILE.svg|FILE.png")]
    pub plot: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct NoOptions {}

const RELATIVE: &str = "Forces are multiples of the slip force, displacements of the slip displacement";

#[derive(Debug, Args)]
pub struct Tractions {
    /// Tangential forces T, at most mu N in magnitude [default: half of mu N]
    #[arg(long, value_name = "N")]
    pub force: Vec<f64>,
    /// Positions along the width [default: points from -b to b, denser at the edges]
    #[arg(long, value_name = "m")]
    #[arg(conflicts_with = "points")]
    pub position: Vec<f64>,
    /// Number of positions
    #[arg(long, value_name = "COUNT", default_value_t = 201)]
    pub points: u32,
    #[arg(long, help = RELATIVE)]
    pub relative: bool,
}

#[derive(Debug, Args)]
pub struct LayerOptions {
    /// Measured tangential stiffness of contact and layer together, under one or two loads; two determine the stiffening load
    #[arg(long, value_name = "N/m")]
    pub measured_stiffness: Vec<f64>,
    /// Normal force of each measurement [default: the normal force]
    #[arg(long, value_name = "N")]
    #[arg(requires = "measured_stiffness")]
    pub at: Vec<f64>,
    /// Tangential force up to which the one measured stiffness is the secant from rest [default: 0, the initial stiffness]
    #[arg(long, value_name = "N")]
    #[arg(requires = "measured_stiffness")]
    pub secant_force: Option<f64>,
    /// Root mean square of the heights of both surfaces
    #[arg(long, value_name = "m")]
    pub rms_height: Option<f64>,
}

#[derive(Debug, Args)]
pub struct Curve {
    /// Largest displacement >= 0 of a uniform grid from 0 [default: 1.25 slip displacements]
    #[arg(long, value_name = "m")]
    pub to: Option<f64>,
    /// Number of points of the grid
    #[arg(long, value_name = "COUNT", default_value_t = 201)]
    pub points: u32,
    /// Displacements instead of a grid
    #[arg(long, value_name = "m")]
    #[arg(conflicts_with_all = ["to", "points"])]
    pub displacement: Vec<f64>,
    /// Forces, at most mu N in magnitude, instead of a grid
    #[arg(long, value_name = "N")]
    #[arg(conflicts_with_all = ["to", "points", "displacement"])]
    pub force: Vec<f64>,
    #[arg(long, help = RELATIVE)]
    pub relative: bool,
}

#[derive(Debug, Args)]
pub struct Loop {
    /// Displacement amplitudes [default: 0.5, 1 and 1.5 slip displacements]
    #[arg(long, value_name = "m")]
    pub amplitude: Vec<f64>,
    /// Number of points of a period, uniformly spaced in time; the first is repeated at the end
    #[arg(long, value_name = "COUNT", default_value_t = 200)]
    pub points: u32,
    /// Amplitude of a harmonic variation of the normal force about normal_force; the contact is open while the sum is
    /// negative
    #[arg(long, value_name = "N", requires = "phase")]
    pub normal_amplitude: Option<f64>,
    /// Phases by which the normal force leads the displacement, from -360 to 360
    #[arg(long, value_name = "DEGREES")]
    #[arg(requires = "normal_amplitude")]
    pub phase: Vec<f64>,
    /// Amplitudes are multiples of the slip displacement and of normal_force
    #[arg(long)]
    pub relative: bool,
}

#[derive(Debug, Args)]
pub struct Amplitudes {
    /// Smallest amplitude of a logarithmic grid [default: 0.01 slip displacements]
    #[arg(long, value_name = "m")]
    pub from: Option<f64>,
    /// Largest amplitude of the grid [default: 100 slip displacements]
    #[arg(long, value_name = "m")]
    pub to: Option<f64>,
    /// Number of amplitudes of the grid
    #[arg(long, value_name = "COUNT", default_value_t = 201)]
    pub points: u32,
    /// Amplitudes instead of a grid
    #[arg(long, value_name = "m")]
    #[arg(conflicts_with_all = ["from", "to", "points"])]
    pub amplitude: Vec<f64>,
    #[arg(long, help = RELATIVE)]
    pub relative: bool,
}

#[derive(Debug, Args)]
pub struct History {
    /// Table of displacements, one per row, from the unloaded contact at displacement 0; - is standard input
    #[arg(long, value_name = "FILE.csv", default_value = "-")]
    pub displacements: PathBuf,
    /// Column of the table: its name in the header, or its number from 1 [default: displacement or displacement_x, or the only
    /// one]
    #[arg(long, value_name = "NAME")]
    pub column: Option<String>,
    /// Column of displacements in the y direction, across the first [default: displacement_y, if there is one]
    #[arg(long, value_name = "NAME")]
    pub column_y: Option<String>,
    /// Column of normal approaches, 0 or less if the contact is open [default: approach, if there is one]
    #[arg(long, value_name = "NAME", conflicts_with = "normal_force_column")]
    pub approach_column: Option<String>,
    /// Column of normal forces, 0 if the contact is open [default: normal_force, if there is one and no approach]
    #[arg(long, value_name = "NAME")]
    pub normal_force_column: Option<String>,
    /// Number of lines at the start of a table that are not read
    #[arg(long, value_name = "LINES", default_value_t = 0)]
    pub skip: usize,
    /// Displacements are multiples of the slip displacement, normal forces of normal_force, approaches of the one under it
    #[arg(long)]
    pub relative: bool,
}

#[derive(Debug, Args)]
pub struct Normal {
    /// Largest approach >= 0 of a uniform grid from 0 [default: the approach under normal_force]
    #[arg(long, value_name = "m")]
    pub to: Option<f64>,
    /// Number of points of the grid
    #[arg(long, value_name = "COUNT", default_value_t = 201)]
    pub points: u32,
    /// Approaches instead of a grid; 0 or less if the contact is open
    #[arg(long, value_name = "m")]
    #[arg(conflicts_with_all = ["to", "points"])]
    pub approach: Vec<f64>,
    /// Normal forces instead of a grid
    #[arg(long, value_name = "N")]
    #[arg(conflicts_with_all = ["to", "points", "approach"])]
    pub force: Vec<f64>,
    /// Forces are multiples of normal_force, approaches of the one under it
    #[arg(long)]
    pub relative: bool,
}

#[derive(Debug, Args)]
pub struct Iwan {
    /// Number of spring-sliders
    #[arg(long, value_name = "COUNT", default_value_t = 5)]
    pub count: u32,
}

#[derive(Debug, Args)]
pub struct Fit {
    /// Tables of displacement and tangential force, each with at least one cycle, at any amplitudes and loads
    #[arg(long, value_name = "FILE.csv", required = true)]
    pub measured: Vec<PathBuf>,
    /// Column of displacements: its name in the header, or its number from 1 [default: displacement]
    #[arg(long, value_name = "NAME")]
    pub column: Option<String>,
    /// Column of tangential forces [default: force]
    #[arg(long, value_name = "NAME")]
    pub force_column: Option<String>,
    /// Column of normal forces [default: normal_force, if there is one]
    #[arg(long, value_name = "NAME", conflicts_with = "loads")]
    pub normal_force_column: Option<String>,
    /// Column of times, in which gaps are found [default: time, if there is one]
    #[arg(long, value_name = "NAME")]
    pub time_column: Option<String>,
    /// Number of lines at the start of a table that are not read
    #[arg(long, value_name = "LINES", default_value_t = 0)]
    pub skip: usize,
    /// Constant normal force of each table, or of all [default: normal_force of the contact]
    #[arg(long, value_name = "N")]
    pub loads: Vec<f64>,
    /// Units of displacement and forces in the tables, if their headers have none: m, cm, mm, um or nm; N, mN or kN [default: those
    /// of the contact]
    #[arg(long, value_name = "LENGTH,FORCE", value_parser = DataUnits::parse)]
    pub data_units: Option<DataUnits>,
    /// What is not fitted: friction_coefficient, series_compliance, contact_compliance (a factor on the displacements of the law),
    /// parallel_stiffness with a value [default: of the contact, 0, 1, 0], shape; in the units of the contact
    #[arg(long, value_name = "NAME[=VALUE]", value_parser = parse_fixed)]
    pub fix: Vec<(Fixable, Option<f64>)>,
    /// Parameter of shape that is fitted
    #[arg(long, value_name = "NAME", default_value = "flat_half_width")]
    pub shape: ShapeOption,
    /// File of the fitted contact, a parameter file
    #[arg(long, value_name = "FILE.toml", help_heading = "Output")]
    pub fitted: Option<PathBuf>,
    /// File of all results, with the loops
    #[arg(long, value_name = "FILE.json", help_heading = "Output")]
    pub json: Option<PathBuf>,
}

/// What a fit may leave as it is.
#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
#[value(rename_all = "snake_case")]
pub enum Fixable {
    FrictionCoefficient,
    SeriesCompliance,
    ContactCompliance,
    ParallelStiffness,
    Shape,
}

/// The parameter of shape of a fit.
#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
#[value(rename_all = "snake_case")]
pub enum ShapeOption {
    /// Half-width of the flat, with the radius of the contact
    FlatHalfWidth,
    /// Radius of the edges, with the flat of the contact
    EdgeRadius,
}

/// A name, or a name and a value: `contact_compliance=1`.
fn parse_fixed(text: &str) -> Result<(Fixable, Option<f64>), String> {
    let (name, value) = text.split_once('=').map_or((text, None), |(name, value)| (name, Some(value)));
    let parameter = Fixable::from_str(name.trim(), false)?;
    match value.map(parse_number).transpose()? {
        Some(_) if parameter == Fixable::Shape => Err("shape has no value: it is that of the contact".to_owned()),
        value => Ok((parameter, value)),
    }
}
