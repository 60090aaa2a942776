//! What each command computes: a table, a picture, and the command that repeats both.

use crate::arguments::{Amplitudes, Curve, History, Iwan, Loop, Tractions};
use crate::digits::{digits, list};
use crate::parameters::{Described, Shape};
use crate::path::{self, Row};
use crate::picture::{Axis, Line, Panel, Picture, rounded};
use crate::refusal::{Outcome, Refusal, input, usage};
use crate::table::Table;
use crate::units::Quantity;
use microslip::constant_load::equivalents::{SpringSlider, iwan, jenkins};
use microslip::constant_load::masing::{check_step, step, step_with_energy};
use microslip::constant_load::state::{state_init, state_length};
use microslip::{Contact, Error};
use std::f64::consts::PI;

/// The result of a command.
pub struct Answer {
    /// The command that repeats it.
    command: String,
    /// Further comments.
    remarks: Vec<String>,
    table: Table,
    panels: Vec<Panel>,
    described: Described,
}

impl Answer {
    fn new(name: &str, described: Described, options: &str, table: Table, panels: Vec<Panel>) -> Answer {
        let command = format!("microslip {name}{}{options}", described.flags());
        Answer { command, remarks: Vec::new(), table, panels, described }
    }

    fn with_remark(mut self, remark: &str) -> Answer {
        self.remarks.push(remark.to_owned());
        self
    }

    /// As CSV.
    ///
    /// # Errors
    /// None are expected: it is written to memory.
    pub fn table(&self) -> Result<Vec<u8>, csv::Error> {
        let mut comments = vec![format!("microslip {}", env!("CARGO_PKG_VERSION")), self.command.clone()];
        comments.extend(self.remarks.iter().cloned());
        self.table.csv(&comments)
    }

    pub fn picture(self) -> Picture {
        let Described { units, shape, .. } = self.described;
        let length = |name: &str, value: f64| format!("{name} = {}, ", rounded(value, Quantity::Length, units));
        let (geometry, normal_force, friction_coefficient) = match shape {
            Shape::RoundedFlat(p) => {
                let sizes = [("a", p.flat_half_width), ("R", p.edge_radius), ("L", p.length)];
                (sizes.map(|(name, value)| length(name, value)).concat(), p.normal_force, p.friction_coefficient)
            }
            Shape::Elliptic(p) => {
                let sizes = [("semi-axes b", p.semi_axis_x), ("l", p.semi_axis_y)];
                (sizes.map(|(name, value)| length(name, value)).concat(), p.normal_force, p.friction_coefficient)
            }
        };
        let load = rounded(normal_force, Quantity::Force, units);
        let caption = format!("{geometry}N = {load}, μ = {}", digits(friction_coefficient));
        Picture { caption, units, panels: self.panels }
    }
}

/// The given values, in units of the contact's own if relative.
fn scaled(values: &[f64], relative: bool, unit: f64) -> Vec<f64> {
    let factor = if relative { unit } else { 1.0 };
    values.iter().map(|value| value * factor).collect()
}

/// Uniformly spaced from 0 to the end, which is exact.
fn grid(end: f64, points: u32) -> Vec<f64> {
    (0..points).map(|i| f64::from(i) / f64::from(points - 1) * end).collect()
}

/// Uniformly spaced in the logarithm; both ends are exact.
fn logarithmic_grid(from: f64, to: f64, points: u32) -> Vec<f64> {
    let between = |part: f64| from.powf(1.0 - part) * to.powf(part);
    grid(1.0, points).into_iter().map(between).collect()
}

/// Across the contact from edge to edge, denser towards them: narrow slip zones and peaks of pressure are there.
fn across(described: &Described, points: u32) -> Vec<f64> {
    grid(PI, points).into_iter().map(|angle| -described.contact.half_width * angle.cos()).collect()
}

/// A line over a quantity that grows.
fn line_over(name: impl Into<String>, mut points: Vec<(f64, f64)>) -> Line {
    points.sort_by(|one, other| one.0.total_cmp(&other.0));
    Line { name: name.into(), points }
}

/// A panel of one line, without a name.
fn panel(x: Axis, y: Axis, points: Vec<(f64, f64)>) -> Panel {
    Panel { x, y, lines: vec![line_over("", points)] }
}

/// Two columns as points.
fn pairs(rows: &[Vec<f64>], x: usize, y: usize) -> Vec<(f64, f64)> {
    rows.iter().map(|row| (row[x], row[y])).collect()
}

const DISPLACEMENT: Axis = Axis::linear("displacement", Quantity::Length);
const AMPLITUDE: Axis = Axis::logarithmic("displacement amplitude", Quantity::Length);
const ACROSS: Axis = Axis::linear("x", Quantity::Length);
const STIFFNESS: Axis = Axis::linear("stiffness", Quantity::Stiffness);
const FORCE: Axis = Axis::linear("force", Quantity::Force);

pub fn contact(described: Described) -> Answer {
    let contact = &described.contact;
    let rows = [
        ("composite_modulus", contact.composite_modulus, Quantity::Pressure),
        ("half_width", contact.half_width, Quantity::Length),
        ("slip_force", contact.slip_force, Quantity::Force),
        ("slip_displacement", contact.slip_displacement, Quantity::Length),
        ("initial_stiffness", contact.initial_stiffness, Quantity::Stiffness),
        ("slip_energy", contact.slip_energy, Quantity::Energy),
        ("maximum_pressure", maximum_pressure(&described), Quantity::Pressure),
    ]
    .map(|(name, value, quantity)| [name.to_owned(), digits(value), described.units.unit(quantity).to_owned()]);
    let table = Table::of_text(["quantity", "value", "unit"], &rows);
    let pressure = across(&described, 201).into_iter().map(|x| (x, contact.pressure(x))).collect();
    let panels = vec![panel(ACROSS, Axis::linear("pressure", Quantity::Pressure), pressure)];
    Answer::new("contact", described, "", table, panels)
}

/// The largest pressure, in the middle of a cylinder and of an ellipse. On a flat the pressure grows up to its end, where its
/// slope is infinite, and has one maximum on the rounded edge: a golden section finds it.
fn maximum_pressure(described: &Described) -> f64 {
    let contact = &described.contact;
    let flat = match described.shape {
        Shape::RoundedFlat(parameters) if parameters.flat_half_width > 0.0 => parameters.flat_half_width,
        _ => return contact.pressure(0.0),
    };
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let (mut low, mut high) = (flat.min(contact.half_width), contact.half_width);
    // 0.618^80 is below the rounding of the interval.
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

/// The library's message on a force, with the value of mu N if that is exceeded.
fn refused_force(force: f64, contact: &Contact, error: Error) -> Refusal {
    match Refusal::of_flag("--force", digits(force), error) {
        Refusal::Input(sentence) if error == Error::ForceExceedsSlip => {
            Refusal::Input(format!("{sentence}, which is {} N", digits(contact.slip_force)))
        }
        refusal => refusal,
    }
}

fn refused_amplitude(amplitude: f64, error: Error) -> Refusal {
    Refusal::of_flag("--amplitude", digits(amplitude), error)
}

pub fn tractions(arguments: &Tractions, described: Described) -> Outcome<Answer> {
    let (contact, units) = (&described.contact, described.units);
    let mut forces = scaled(&arguments.force, arguments.relative, contact.slip_force);
    if forces.is_empty() {
        forces.push(0.5 * contact.slip_force);
    }
    let mut x = arguments.position.clone();
    if let Some(bad) = x.iter().find(|x| !x.is_finite()) {
        return Err(Refusal::of_flag("--position", digits(*bad), Error::BadPosition));
    }
    let mut options = format!(" --force {}", list(&forces));
    if x.is_empty() {
        x = across(&described, arguments.points);
        options.push_str(&format!(" --points {}", arguments.points));
    } else {
        options.push_str(&format!(" --position {}", list(&x)));
    }
    let slips = matches!(described.shape, Shape::RoundedFlat(_));
    let (mut rows, mut shear, mut slip) = (Vec::new(), Vec::new(), Vec::new());
    for force in forces {
        let point = contact.curve_at_force(force).map_err(|error| refused_force(force, contact, error))?;
        let row = |&x: &f64| {
            let row = [
                Some(force),
                Some(x),
                Some(contact.pressure(x)),
                Some(point.shear(x)),
                point.slip(x).ok(),
                point.damage(x).ok(),
            ];
            row.into_iter().flatten().collect::<Vec<_>>()
        };
        let at_force: Vec<_> = x.iter().map(row).collect();
        let size = rounded(force, Quantity::Force, units);
        shear.push(line_over(format!("shear at {size}"), pairs(&at_force, 1, 3)));
        if slips {
            slip.push(line_over(format!("slip at {size}"), pairs(&at_force, 1, 4)));
        }
        rows.extend(at_force);
    }
    shear.push(line_over("pressure", x.iter().map(|&x| (x, contact.pressure(x))).collect()));
    let mut panels = vec![Panel { x: ACROSS, y: Axis::linear("pressure, shear", Quantity::Pressure), lines: shear }];
    let mut columns = vec![
        ("force", Quantity::Force),
        ("x", Quantity::Length),
        ("pressure", Quantity::Pressure),
        ("shear", Quantity::Pressure),
    ];
    if slips {
        panels.push(Panel { x: ACROSS, y: Axis::linear("slip", Quantity::Length), lines: slip });
        columns.extend([("slip", Quantity::Length), ("damage", Quantity::Stiffness)]);
    }
    let table = Table::of_numbers(&columns, units, &rows);
    Ok(Answer::new("tractions", described, &options, table, panels))
}

pub fn curve(arguments: &Curve, described: Described) -> Outcome<Answer> {
    let (contact, units, relative) = (&described.contact, described.units, arguments.relative);
    let forces = scaled(&arguments.force, relative, contact.slip_force);
    let mut displacements = scaled(&arguments.displacement, relative, contact.slip_displacement);
    let at_force = |&force: &f64| {
        let point = contact.curve_at_force(force).map_err(|error| refused_force(force, contact, error))?;
        Ok(vec![point.displacement(), force, point.stiffness(), point.stick_half_width()])
    };
    let at_displacement = |flag: &str, displacement: f64| {
        let point = contact.curve_at_displacement(displacement);
        let point = point.map_err(|error| Refusal::of_flag(flag, digits(displacement), error))?;
        Ok(vec![displacement, point.force(), point.stiffness(), point.stick_half_width()])
    };
    let options = if !forces.is_empty() {
        format!(" --force {}", list(&forces))
    } else if !displacements.is_empty() {
        format!(" --displacement {}", list(&displacements))
    } else {
        let default = 1.25 * contact.slip_displacement;
        let end = arguments.to.map_or(default, |to| if relative { to * contact.slip_displacement } else { to });
        at_displacement("--to", end)?;
        displacements = grid(end, arguments.points);
        format!(" --to {} --points {}", digits(end), arguments.points)
    };
    let displacements = displacements.into_iter().map(|displacement| at_displacement("--displacement", displacement));
    let rows = forces.iter().map(at_force).chain(displacements).collect::<Outcome<Vec<_>>>()?;
    let columns = [
        ("displacement", Quantity::Length),
        ("force", Quantity::Force),
        ("stiffness", Quantity::Stiffness),
        ("stick_half_width", Quantity::Length),
    ];
    let table = Table::of_numbers(&columns, units, &rows);
    let panels = vec![
        panel(DISPLACEMENT, FORCE, pairs(&rows, 0, 1)),
        panel(DISPLACEMENT, STIFFNESS, pairs(&rows, 0, 2)),
        panel(DISPLACEMENT, Axis::linear("stick half-width", Quantity::Length), pairs(&rows, 0, 3)),
    ];
    Ok(Answer::new("curve", described, &options, table, panels))
}

pub fn hysteresis_loop(arguments: &Loop, described: Described) -> Outcome<Answer> {
    let (contact, units) = (&described.contact, described.units);
    let (given, relative) = match arguments.amplitude[..] {
        [] => (&[0.5, 1.0, 1.5][..], true),
        _ => (&arguments.amplitude[..], arguments.relative),
    };
    let amplitudes = scaled(given, relative, contact.slip_displacement);
    let options = format!(" --amplitude {} --points {}", list(&amplitudes), arguments.points);
    let (mut rows, mut lines) = (Vec::new(), Vec::new());
    for amplitude in amplitudes {
        let refuse = |error| refused_amplitude(amplitude, error);
        let hysteresis = contact.hysteresis_loop(amplitude).map_err(refuse)?;
        let dissipated = contact.complex_stiffness(amplitude).map_err(refuse)?.dissipated();
        let n = arguments.points as usize;
        let row = |i: usize| vec![amplitude, hysteresis.displacement(i, n), hysteresis.force(i, n), dissipated];
        let at_amplitude: Vec<_> = (0..=n).map(row).collect();
        let size = rounded(amplitude, Quantity::Length, units);
        let name = format!("±{size}, {}", rounded(dissipated, Quantity::Energy, units));
        lines.push(Line { name, points: pairs(&at_amplitude, 1, 2) });
        rows.extend(at_amplitude);
    }
    let columns = [
        ("amplitude", Quantity::Length),
        ("displacement", Quantity::Length),
        ("force", Quantity::Force),
        ("dissipated", Quantity::Energy),
    ];
    let table = Table::of_numbers(&columns, units, &rows);
    let panels = vec![Panel { x: DISPLACEMENT, y: FORCE, lines }];
    Ok(Answer::new("loop", described, &options, table, panels).with_remark("dissipated: energy per cycle"))
}

impl Amplitudes {
    /// The amplitudes, and the flags that repeat them.
    fn values(&self, contact: &Contact) -> Outcome<(Vec<f64>, String)> {
        let unit = contact.slip_displacement;
        if !self.amplitude.is_empty() {
            let amplitudes = scaled(&self.amplitude, self.relative, unit);
            let options = format!(" --amplitude {}", list(&amplitudes));
            return Ok((amplitudes, options));
        }
        if unit == 0.0 && (self.relative || self.from.is_none() || self.to.is_none()) {
            return input(
                "this contact carries no force and has no slip displacement: give --from and --to, or --amplitude",
            );
        }
        let end = |given: Option<f64>, multiple: f64| match given {
            Some(value) if !self.relative => value,
            _ => given.unwrap_or(multiple) * unit,
        };
        let (from, to) = (end(self.from, 0.01), end(self.to, 100.0));
        for (flag, amplitude) in [("--from", from), ("--to", to)] {
            contact.complex_stiffness(amplitude).map_err(|error| Refusal::of_flag(flag, digits(amplitude), error))?;
        }
        if !(from > 0.0 && from <= to) {
            return usage(format!("0 < --from <= --to is needed, not {} and {}", digits(from), digits(to)));
        }
        let options = format!(" --from {} --to {} --points {}", digits(from), digits(to), self.points);
        Ok((logarithmic_grid(from, to, self.points), options))
    }
}

pub fn stiffness(arguments: &Amplitudes, described: Described) -> Outcome<Answer> {
    let (contact, units) = (&described.contact, described.units);
    let (amplitudes, options) = arguments.values(contact)?;
    let row = |amplitude: f64| {
        let complex = contact.complex_stiffness(amplitude).map_err(|error| refused_amplitude(amplitude, error))?;
        Ok(vec![
            amplitude,
            complex.real(),
            complex.imaginary(),
            complex.d_real(),
            complex.d_imag(),
            complex.dissipated(),
        ])
    };
    let rows = amplitudes.into_iter().map(row).collect::<Outcome<Vec<_>>>()?;
    let columns = [
        ("amplitude", Quantity::Length),
        ("k_real", Quantity::Stiffness),
        ("k_imag", Quantity::Stiffness),
        ("dk_real", Quantity::StiffnessSlope),
        ("dk_imag", Quantity::StiffnessSlope),
        ("dissipated", Quantity::Energy),
    ];
    let table = Table::of_numbers(&columns, units, &rows);
    let lines = vec![line_over("K′", pairs(&rows, 0, 1)), line_over("K″", pairs(&rows, 0, 2))];
    let panels = vec![Panel { x: AMPLITUDE, y: Axis::linear("complex stiffness", Quantity::Stiffness), lines }];
    let answer = Answer::new("stiffness", described, &options, table, panels);
    Ok(answer.with_remark("dk_real, dk_imag: derivatives by the amplitude; dissipated: energy per cycle"))
}

pub fn history(arguments: &History, described: Described) -> Outcome<Answer> {
    let (contact, units) = (&described.contact, described.units);
    let path = path::read(&arguments.displacements, arguments.column.as_deref(), units)?;
    // No path has more reversals than rows, so none is merged.
    let mut state = vec![0.0; state_length(path.len())];
    state_init(&mut state).map_err(|error| Refusal::in_file(&arguments.displacements, error))?;
    // The picture follows the curve between the rows.
    let between = u32::try_from(2000 / path.len()).unwrap_or(1).max(1);
    let (mut rows, mut points) = (Vec::new(), vec![(0.0, 0.0)]);
    for Row { number, displacement } in path {
        let refuse = |error| Refusal::in_file(&arguments.displacements, format!("row {number}: {error}"));
        let displacement = if arguments.relative { displacement * contact.slip_displacement } else { displacement };
        check_step(&state, displacement).map_err(refuse)?;
        let from = rows.last().map_or(0.0, |row: &Vec<f64>| row[0]);
        for part in 1..between {
            let on_the_way = from + (displacement - from) * f64::from(part) / f64::from(between);
            points.push((on_the_way, step(contact, &state, on_the_way).force()));
        }
        let (step, dissipated) = step_with_energy(contact, &state, displacement);
        points.push((displacement, step.force()));
        rows.push(vec![displacement, step.force(), step.stiffness(), dissipated]);
        step.write(&mut state);
    }
    let mut options = format!(" --displacements {}", quoted(&arguments.displacements.to_string_lossy()));
    if let Some(column) = &arguments.column {
        options.push_str(&format!(" --column {}", quoted(column)));
    }
    if arguments.relative {
        options.push_str(" --relative");
    }
    let columns = [
        ("displacement", Quantity::Length),
        ("force", Quantity::Force),
        ("stiffness", Quantity::Stiffness),
        ("dissipated", Quantity::Energy),
    ];
    let table = Table::of_numbers(&columns, units, &rows);
    let panels = vec![Panel { x: DISPLACEMENT, y: FORCE, lines: vec![Line { name: String::new(), points }] }];
    Ok(Answer::new("history", described, &options, table, panels).with_remark("dissipated: energy of each step"))
}

/// For a shell, on one line.
fn quoted(word: &str) -> String {
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || "-_./".contains(letter);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_owned();
    }
    let word: String = word.chars().map(|letter| if letter.is_control() { '?' } else { letter }).collect();
    format!("'{}'", word.replace('\'', r"'\''"))
}

pub fn jenkins_equivalent(arguments: &Amplitudes, described: Described) -> Outcome<Answer> {
    let (contact, units) = (&described.contact, described.units);
    let (amplitudes, options) = arguments.values(contact)?;
    let row = |amplitude: f64| {
        let slider = jenkins(contact, amplitude).map_err(|error| refused_amplitude(amplitude, error))?;
        Ok(vec![amplitude, slider.stiffness, slider.slip_force])
    };
    let rows = amplitudes.into_iter().map(row).collect::<Outcome<Vec<_>>>()?;
    let columns =
        [("amplitude", Quantity::Length), ("stiffness", Quantity::Stiffness), ("slip_force", Quantity::Force)];
    let table = Table::of_numbers(&columns, units, &rows);
    let panels = vec![
        panel(AMPLITUDE, STIFFNESS, pairs(&rows, 0, 1)),
        panel(AMPLITUDE, Axis::linear("slip force", Quantity::Force), pairs(&rows, 0, 2)),
    ];
    Ok(Answer::new("jenkins", described, &options, table, panels))
}

pub fn iwan_equivalent(arguments: &Iwan, described: Described) -> Outcome<Answer> {
    let (contact, units) = (&described.contact, described.units);
    let mut sliders = Vec::new();
    let error = iwan(contact, arguments.count as usize, |slider| sliders.push(slider))
        .map_err(|error| Refusal::of_flag("--count", arguments.count, error))?;
    let rows: Vec<_> =
        sliders.iter().zip(1..).map(|(slider, i)| vec![f64::from(i), slider.stiffness, slider.slip_force]).collect();
    let columns = [("slider", Quantity::Number), ("stiffness", Quantity::Stiffness), ("slip_force", Quantity::Force)];
    let table = Table::of_numbers(&columns, units, &rows);

    let mut places = grid(1.25 * contact.slip_displacement, 201);
    // The corners too, as long as they can be seen.
    let corner = |slider: &SpringSlider| slider.slip_force / slider.stiffness;
    places.extend(sliders.iter().take(200).map(corner).filter(|place| place.is_finite()));
    let of_slider = |slider: &SpringSlider, place: f64| (slider.stiffness * place).min(slider.slip_force);
    let of_sliders = |place: f64| sliders.iter().map(|slider| of_slider(slider, place)).sum();
    let of_contact = |place: f64| contact.curve_at_displacement(place).map_or(f64::NAN, |point| point.force());
    let lines = vec![
        line_over("contact", places.iter().map(|&place| (place, of_contact(place))).collect()),
        line_over("spring-sliders", places.iter().map(|&place| (place, of_sliders(place))).collect()),
    ];
    let panels = vec![Panel { x: DISPLACEMENT, y: FORCE, lines }];
    let answer = Answer::new("iwan", described, &format!(" --count {}", arguments.count), table, panels);
    Ok(answer.with_remark(&format!("largest error of the force over mu N: {}", digits(error))))
}
