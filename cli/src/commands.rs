//! The commands: each computes a table and a picture.

use crate::args::{Amplitudes, Curve, Iwan, Loop, Tractions};
use crate::contact_spec::ContactSpec;
use crate::error::{CliError, Result, in_option, input, usage};
use crate::number::format_number;
use crate::plot::{Axis, Line, Panel, Picture, Row, rounded};
use crate::table::Table;
use crate::units::Quantity::{self, Energy, Force, Length, Number, Pressure, Stiffness, StiffnessSlope};
use crate::varying_load;
use microslip::constant_load::equivalents::{SpringSlider, iwan, jenkins};
use microslip::{Contact, CurvePoint, Error};
use std::f64::consts::PI;
use std::ops::RangeInclusive;

/// The result of a command.
#[derive(Debug)]
pub struct Report {
    /// The program's version, the command that repeats the result, the contact, and remarks.
    comments: Vec<String>,
    pub warnings: Vec<String>,
    /// Exit status of the program, if it is not 0 although there is a result.
    pub status: u8,
    table: Table,
    pub picture: Picture,
}

impl Report {
    pub fn new(spec: &ContactSpec, table: Table, rows: Vec<Row>) -> Report {
        let normal_force = rounded(spec.given.normal_force.unwrap_or_default(), Force, spec.units);
        Report {
            comments: vec![
                format!("microslip {}", env!("CARGO_PKG_VERSION")),
                command_line(),
                format!("contact:{}", spec.given.options()),
            ],
            warnings: spec.given.implausible(),
            status: 0,
            table,
            picture: Picture { caption: caption(spec, &normal_force), units: spec.units, rows },
        }
    }

    /// The same report with another normal force in the caption of the picture.
    pub fn under(mut self, spec: &ContactSpec, normal_force: &str) -> Report {
        self.picture.caption = caption(spec, normal_force);
        self
    }

    pub fn with_remark(mut self, remark: &str) -> Report {
        self.comments.push(remark.to_owned());
        self
    }

    pub fn csv(&self) -> String {
        self.table.csv(&self.comments)
    }
}

/// The command that repeats the result, without its outputs.
fn command_line() -> String {
    let (mut words, mut arguments) = (vec!["microslip".to_owned()], std::env::args().skip(1));
    while let Some(word) = arguments.next() {
        match word.split_once('=').map_or(word.as_str(), |(option, _)| option) {
            "--out" | "--plot" if !word.contains('=') => drop(arguments.next()),
            "--out" | "--plot" => {}
            _ => words.push(quoted(&word)),
        }
    }
    words.join(" ")
}

/// Parameters of the contact.
fn caption(spec: &ContactSpec, normal_force: &str) -> String {
    let given = &spec.given;
    let sizes = [
        ("a", given.flat_half_width),
        ("R", given.edge_radius),
        ("L", given.length),
        ("semi-axes b", given.semi_axis_x),
        ("l", given.semi_axis_y),
    ];
    let size = |(name, value): (&str, Option<f64>)| {
        value.map(|value| format!("{name} = {}, ", rounded(value, Length, spec.units)))
    };
    let friction = format_number(given.friction_coefficient.unwrap_or_default());
    let sizes: String = sizes.into_iter().filter_map(size).collect();
    format!("{sizes}N = {normal_force}, μ = {friction}")
}

/// The given values, multiplied by the unit if they are relative.
pub fn scaled(values: &[f64], relative: bool, unit: f64) -> Vec<f64> {
    let factor = if relative { unit } else { 1.0 };
    values.iter().map(|value| value * factor).collect()
}

/// Rejects a value that an option does not allow.
pub fn check_range(option: &str, value: f64, range: RangeInclusive<f64>) -> Result<()> {
    if range.contains(&value) {
        return Ok(());
    }
    let [least, most] = [*range.start(), *range.end()].map(format_number);
    let allowed = if range.end().is_finite() { format!("{least} to {most}") } else { format!("{least} or more") };
    input(format!("{option} {}: must be {allowed}", format_number(value)))
}

/// Uniformly spaced from 0 to the end, which is exact.
pub fn grid(end: f64, points: u32) -> Vec<f64> {
    (0..points).map(|i| f64::from(i) / f64::from(points - 1) * end).collect()
}

/// From edge to edge of the contact, denser towards the edges: there are narrow slip zones and peaks of pressure.
fn across(contact: &Contact, points: u32) -> Vec<f64> {
    grid(PI, points).into_iter().map(|angle| -contact.half_width * angle.cos()).collect()
}

/// A line over an increasing quantity.
pub fn line_over(stroke: usize, name: impl Into<String>, mut points: Vec<(f64, f64)>) -> Line {
    points.sort_by(|one, other| one.0.total_cmp(&other.0));
    Line { stroke, name: name.into(), points }
}

/// A panel of one line, without a name.
pub fn panel(x: Axis, y: Axis, points: Vec<(f64, f64)>) -> Row {
    Panel { x, y, lines: vec![line_over(0, "", points)] }.into()
}

/// Two columns as points.
pub fn pairs(rows: &[Vec<f64>], x: usize, y: usize) -> Vec<(f64, f64)> {
    rows.iter().map(|row| (row[x], row[y])).collect()
}

/// A panel for each column over the first one, whose axis is given.
pub fn panels(x: Axis, columns: &[(&'static str, Quantity)], rows: &[Vec<f64>]) -> Vec<Row> {
    let axes = columns.iter().map(|(name, quantity)| Axis::linear(name, *quantity));
    axes.enumerate().skip(1).map(|(i, y)| panel(x, y, pairs(rows, 0, i))).collect()
}

pub const DISPLACEMENT: Axis = Axis::linear("displacement", Length);
const AMPLITUDE: Axis = Axis::logarithmic("displacement amplitude", Length);
const ACROSS: Axis = Axis::linear("x", Length);
pub const FORCE: Axis = Axis::linear("force", Force);

pub fn contact(spec: &ContactSpec) -> Report {
    let contact = &spec.contact;
    let properties = [
        ("composite_modulus", contact.composite_modulus, Pressure),
        ("half_width", contact.half_width, Length),
        ("slip_force", contact.slip_force, Force),
        ("slip_displacement", contact.slip_displacement, Length),
        ("initial_stiffness", contact.initial_stiffness, Stiffness),
        ("slip_energy", contact.slip_energy, Energy),
        ("maximum_pressure", maximum_pressure(spec), Pressure),
    ];
    let row = |(name, value, quantity)| format!("{name},{},{}", format_number(value), spec.units.unit(quantity));
    let table = Table::of_text("quantity,value,unit", properties.map(row).into());
    let pressure = across(contact, 201).into_iter().map(|x| (x, contact.pressure(x))).collect();
    let panels = vec![panel(ACROSS, Axis::linear("pressure", Pressure), pressure)];
    Report::new(spec, table, panels)
}

/// The maximum pressure: in the middle of a cylinder or an ellipse; on the rounded edge of a flat, where a golden-section search
/// finds the only maximum.
fn maximum_pressure(spec: &ContactSpec) -> f64 {
    let contact = &spec.contact;
    let flat = spec.given.flat_half_width.unwrap_or_default();
    if flat == 0.0 {
        return contact.pressure(0.0);
    }
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let (mut low, mut high) = (flat.min(contact.half_width), contact.half_width);
    // 0.618^80 is below the rounding error of the interval.
    for _ in 0..80 {
        let step = golden * (high - low);
        if contact.pressure(high - step) < contact.pressure(low + step) {
            low = high - step;
        } else {
            high = low + step;
        }
    }
    contact.pressure(0.5 * (low + high))
}

/// The point of the monotonic curve at a force.
fn point_at_force(contact: &Contact, force: f64) -> Result<CurvePoint<'_>> {
    contact.curve_at_force(force).map_err(|error| match in_option("--force", force)(error) {
        CliError::Input(message) if error == Error::ForceExceedsSlip => {
            CliError::Input(format!("{message}, which is {} N", format_number(contact.slip_force)))
        }
        other => other,
    })
}

pub fn tractions(options: &Tractions, spec: &ContactSpec) -> Result<Report> {
    let (contact, units) = (&spec.contact, spec.units);
    let mut forces = scaled(&options.force, options.relative, contact.slip_force);
    if forces.is_empty() {
        forces.push(0.5 * contact.slip_force);
    }
    if let Some(bad) = options.position.iter().find(|x| !x.is_finite()) {
        return Err(in_option("--position", *bad)(Error::BadPosition));
    }
    let x = match &options.position[..] {
        [] => across(contact, options.points),
        x => x.to_vec(),
    };
    let has_slip = !spec.given.is_elliptic();
    let (mut rows, mut shear, mut slip) = (Vec::new(), Vec::new(), Vec::new());
    for (stroke, force) in (1..).zip(forces) {
        let point = point_at_force(contact, force)?;
        let slip_at = |x| [point.slip(x), point.damage(x)].into_iter().flatten();
        let row = |&x: &f64| [force, x, contact.pressure(x), point.shear(x)].into_iter().chain(slip_at(x)).collect();
        let at_force: Vec<Vec<_>> = x.iter().map(row).collect();
        shear.push(line_over(stroke, format!("T = {}", rounded(force, Force, units)), pairs(&at_force, 1, 3)));
        if has_slip {
            slip.push(line_over(stroke, "", pairs(&at_force, 1, 4)));
        }
        rows.extend(at_force);
    }
    shear.push(line_over(0, "pressure", x.iter().map(|&x| (x, contact.pressure(x))).collect()));
    let mut panels: Vec<Row> =
        vec![Panel { x: ACROSS, y: Axis::linear("pressure, shear", Pressure), lines: shear }.into()];
    let mut columns = vec![("force", Force), ("x", Length), ("pressure", Pressure), ("shear", Pressure)];
    if has_slip {
        panels.push(Panel { x: ACROSS, y: Axis::linear("slip", Length), lines: slip }.into());
        columns.extend([("slip", Length), ("damage", Stiffness)]);
    }
    Ok(Report::new(spec, Table::of_numbers(&columns, units, &rows), panels))
}

pub fn curve(options: &Curve, spec: &ContactSpec) -> Result<Report> {
    let (contact, relative) = (&spec.contact, options.relative);
    let forces = scaled(&options.force, relative, contact.slip_force);
    let mut displacements = scaled(&options.displacement, relative, contact.slip_displacement);
    let at_force = |&force: &f64| {
        let point = point_at_force(contact, force)?;
        Ok(vec![point.displacement(), force, point.stiffness(), point.stick_half_width()])
    };
    let at_displacement = |option: &str, displacement: f64| {
        let point = contact.curve_at_displacement(displacement);
        let point = point.map_err(in_option(option, displacement))?;
        Ok(vec![displacement, point.force(), point.stiffness(), point.stick_half_width()])
    };
    if forces.is_empty() && displacements.is_empty() {
        let default = 1.25 * contact.slip_displacement;
        let end = options.to.map_or(default, |to| if relative { to * contact.slip_displacement } else { to });
        at_displacement("--to", end)?;
        check_range("--to", end, 0.0..=f64::INFINITY)?;
        displacements = grid(end, options.points);
    }
    let displacements = displacements.into_iter().map(|displacement| at_displacement("--displacement", displacement));
    let rows = forces.iter().map(at_force).chain(displacements).collect::<Result<Vec<_>>>()?;
    let columns = [("displacement", Length), ("force", Force), ("stiffness", Stiffness), ("stick_half_width", Length)];
    let panels = panels(DISPLACEMENT, &columns, &rows);
    Ok(Report::new(spec, Table::of_numbers(&columns, spec.units, &rows), panels))
}

pub fn hysteresis_loop(options: &Loop, spec: &ContactSpec) -> Result<Report> {
    let (contact, units) = (&spec.contact, spec.units);
    let (given, relative) = match options.amplitude[..] {
        [] => (&[0.5, 1.0, 1.5][..], true),
        _ => (&options.amplitude[..], options.relative),
    };
    let amplitudes = scaled(given, relative, contact.slip_displacement);
    if options.normal_amplitude.is_some() {
        return varying_load::swinging_loop(options, spec, &amplitudes);
    }
    let (mut rows, mut lines) = (Vec::new(), Vec::new());
    for (stroke, amplitude) in amplitudes.into_iter().enumerate() {
        let error = in_option("--amplitude", amplitude);
        let hysteresis = contact.hysteresis_loop(amplitude).map_err(error)?;
        let dissipated = contact.complex_stiffness(amplitude).map_err(error)?.dissipated;
        let n = options.points as usize;
        let row = |i: usize| vec![amplitude, hysteresis.displacement(i, n), hysteresis.force(i, n), dissipated];
        let at_amplitude: Vec<_> = (0..=n).map(row).collect();
        let size = rounded(amplitude, Length, units);
        let name = format!("±{size}, {}", rounded(dissipated, Energy, units));
        lines.push(Line { stroke, name, points: pairs(&at_amplitude, 1, 2) });
        rows.extend(at_amplitude);
    }
    let columns = [("amplitude", Length), ("displacement", Length), ("force", Force), ("dissipated", Energy)];
    let panels = vec![Panel { x: DISPLACEMENT, y: FORCE, lines }.into()];
    let report = Report::new(spec, Table::of_numbers(&columns, units, &rows), panels);
    Ok(report.with_remark("dissipated: energy per cycle"))
}

impl Amplitudes {
    fn values(&self, contact: &Contact) -> Result<Vec<f64>> {
        let unit = contact.slip_displacement;
        if !self.amplitude.is_empty() {
            return Ok(scaled(&self.amplitude, self.relative, unit));
        }
        if unit == 0.0 && (self.relative || self.from.is_none() || self.to.is_none()) {
            return input(
                "without friction or normal force there is no slip displacement: give --from and --to, or --amplitude",
            );
        }
        let end = |given: Option<f64>, multiple: f64| match given {
            Some(value) if !self.relative => value,
            _ => given.unwrap_or(multiple) * unit,
        };
        let (from, to) = (end(self.from, 0.01), end(self.to, 100.0));
        for (option, amplitude) in [("--from", from), ("--to", to)] {
            let error = in_option(option, amplitude);
            contact.complex_stiffness(amplitude).map_err(error)?;
        }
        if !(from > 0.0 && from <= to) {
            let [from_text, to_text] = [from, to].map(format_number);
            return usage(format!("0 < --from <= --to is required, not {from_text} and {to_text}"));
        }
        // Uniform in the logarithm; both ends are exact.
        let amplitude = |part: f64| from.powf(1.0 - part) * to.powf(part);
        Ok(grid(1.0, self.points).into_iter().map(amplitude).collect())
    }
}

pub fn stiffness(options: &Amplitudes, spec: &ContactSpec) -> Result<Report> {
    let amplitudes = options.values(&spec.contact)?;
    let row = |amplitude: f64| {
        let k = spec.contact.complex_stiffness(amplitude).map_err(in_option("--amplitude", amplitude))?;
        Ok(vec![amplitude, k.real, k.imaginary, k.d_real, k.d_imag, k.dissipated])
    };
    let rows = amplitudes.into_iter().map(row).collect::<Result<Vec<_>>>()?;
    let columns = [
        ("amplitude", Length),
        ("k_real", Stiffness),
        ("k_imag", Stiffness),
        ("dk_real", StiffnessSlope),
        ("dk_imag", StiffnessSlope),
        ("dissipated", Energy),
    ];
    let lines = vec![line_over(0, "K′", pairs(&rows, 0, 1)), line_over(1, "K″", pairs(&rows, 0, 2))];
    let panels = vec![Panel { x: AMPLITUDE, y: Axis::linear("complex stiffness", Stiffness), lines }.into()];
    let report = Report::new(spec, Table::of_numbers(&columns, spec.units, &rows), panels);
    Ok(report.with_remark("dk_real, dk_imag: derivatives by the amplitude; dissipated: energy per cycle"))
}

/// A word of a shell command, on one line.
pub fn quoted(word: &str) -> String {
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || "-_./".contains(letter);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace(char::is_control, "?").replace('\'', r"'\''"))
}

pub fn jenkins_equivalent(options: &Amplitudes, spec: &ContactSpec) -> Result<Report> {
    let amplitudes = options.values(&spec.contact)?;
    let row = |amplitude: f64| {
        let slider = jenkins(&spec.contact, amplitude).map_err(in_option("--amplitude", amplitude))?;
        Ok(vec![amplitude, slider.stiffness, slider.slip_force])
    };
    let rows = amplitudes.into_iter().map(row).collect::<Result<Vec<_>>>()?;
    let columns = [("amplitude", Length), ("stiffness", Stiffness), ("slip_force", Force)];
    let panels = panels(AMPLITUDE, &columns, &rows);
    Ok(Report::new(spec, Table::of_numbers(&columns, spec.units, &rows), panels))
}

pub fn iwan_equivalent(options: &Iwan, spec: &ContactSpec) -> Result<Report> {
    let contact = &spec.contact;
    let mut sliders = Vec::new();
    let error = iwan(contact, options.count as usize, |slider| sliders.push(slider))
        .map_err(in_option("--count", f64::from(options.count)))?;
    let rows: Vec<_> =
        sliders.iter().zip(1..).map(|(slider, i)| vec![f64::from(i), slider.stiffness, slider.slip_force]).collect();
    let columns = [("slider", Number), ("stiffness", Stiffness), ("slip_force", Force)];

    let mut displacements = grid(1.25 * contact.slip_displacement, 201);
    // The corners of the sum, as long as they are visible.
    let corner = |slider: &SpringSlider| slider.slip_force / slider.stiffness;
    displacements.extend(sliders.iter().take(200).map(corner).filter(|displacement| displacement.is_finite()));
    let of_slider = |slider: &SpringSlider, at: f64| (slider.stiffness * at).min(slider.slip_force);
    let of_sliders = |at: f64| -> f64 { sliders.iter().map(|slider| of_slider(slider, at)).sum() };
    let of_contact = |at: f64| contact.curve_at_displacement(at).map_or(f64::NAN, |point| point.force());
    // Both curves would coincide in one panel.
    let difference = |at: f64| of_sliders(at) - of_contact(at);
    let points = |force: &dyn Fn(f64) -> f64| displacements.iter().map(|&at| (at, force(at))).collect();
    let panels = vec![
        panel(DISPLACEMENT, FORCE, points(&of_contact)),
        panel(DISPLACEMENT, Axis::linear("force error of the sliders", Force), points(&difference)),
    ];
    let table = Table::of_numbers(&columns, spec.units, &rows);
    let report = Report::new(spec, table, panels);
    Ok(report.with_remark(&format!("largest error of the force over mu N: {}", format_number(error))))
}
