//! Commands under a normal force that varies, with separation.

use crate::args::{Loop, Normal};
use crate::commands::{DISPLACEMENT, FORCE, Report, check_range, grid, panels, scaled};
use crate::contact_spec::ContactSpec;
use crate::error::{CliError, Result, in_option};
use crate::number::format_number;
use crate::plot::{Axis, Line, Panel, rounded};
use crate::table::Table;
use crate::units::Quantity::{Angle, Energy, Force, Length, Stiffness};
use microslip::Error;
use microslip::constant_load::Law;
use microslip::element::{Directions, Element, NormalInput};
use microslip::one_direction::{OneDirection, state_length};

pub const NORMAL_FORCE: Axis = Axis::linear("normal force", Force);

pub fn normal(options: &Normal, spec: &ContactSpec) -> Result<Report> {
    let element = spec.element(Directions::One, NormalInput::Approach)?;
    let at_approach = |option: &str, approach: f64| {
        element.check_approach(approach).map_err(in_option(option, approach))?;
        let point = element.normal_force_at(approach);
        Ok(vec![approach, point.value, point.slope, element.half_width_under(point.value)])
    };
    let at_force = |&force: &f64| {
        element.check_normal_force(force).map_err(in_option("--force", force))?;
        let point = element.approach_under(force);
        // An open contact has no stiffness.
        let stiffness = if force > 0.0 { 1.0 / point.slope } else { 0.0 };
        Ok(vec![point.value, force, stiffness, element.half_width_under(force)])
    };
    let forces = scaled(&options.force, options.relative, element.normal_force);
    let mut approaches = scaled(&options.approach, options.relative, element.approach);
    if forces.is_empty() && approaches.is_empty() {
        let factor = if options.relative { element.approach } else { 1.0 };
        let end = options.to.map_or(element.approach, |to| to * factor);
        at_approach("--to", end)?;
        check_range("--to", end, 0.0..=f64::INFINITY)?;
        approaches = grid(end, options.points);
    }
    let approaches = approaches.into_iter().map(|approach| at_approach("--approach", approach));
    let rows = forces.iter().map(at_force).chain(approaches).collect::<Result<Vec<_>>>()?;
    let columns = [("approach", Length), ("normal_force", Force), ("stiffness", Stiffness), ("half_width", Length)];
    // Stiffness and half-width may jump as the contact closes.
    let is_drawn = |row: &[f64], i: usize| i < 2 || row[1] > 0.0;
    let drawn = |row: &Vec<f64>| (0..row.len()).map(|i| if is_drawn(row, i) { row[i] } else { f64::NAN }).collect();
    let panels = panels(Axis::linear("approach", Length), &columns, &rows.iter().map(drawn).collect::<Vec<_>>());
    Ok(Report::new(spec, Table::of_numbers(&columns, spec.units, &rows), panels))
}

/// The state of an open contact at displacement 0.
pub fn new_state(pieces: usize) -> Result<Vec<f64>> {
    let mut state = vec![0.0; state_length(pieces)];
    OneDirection::state_init(&mut state).map_err(|error| CliError::Input(error.to_string()))?;
    Ok(state)
}

/// Steps of a period, at least, from which a loop and its energy are computed.
const STEPS_OF_PERIOD: usize = 4096;

/// Loops under `N (1 + a cos(ωt + φ))`, or 0 where that is negative, for `u = û cos ωt`.
pub fn swinging_loop(options: &Loop, spec: &ContactSpec, amplitudes: &[f64]) -> Result<Report> {
    let (element, units) = (spec.element(Directions::One, NormalInput::Force)?, spec.units);
    let (mean, n) = (element.normal_force, options.points as usize);
    let given = options.normal_amplitude.unwrap_or_default() * if options.relative { mean } else { 1.0 };
    if !(given >= 0.0 && given.is_finite()) {
        return Err(in_option("--normal-amplitude", given)(Error::BadForceAmplitude));
    }
    for phase in &options.phase {
        check_range("--phase", *phase, -360.0..=360.0)?;
    }
    let steps = n * STEPS_OF_PERIOD.div_ceil(n);
    let (mut rows, mut forces, mut loads) = (Vec::new(), Vec::new(), Vec::new());
    let name = |amplitude: f64| match amplitudes {
        [_] => String::new(),
        _ => format!("±{}, ", rounded(amplitude, Length, units)),
    };
    for &amplitude in amplitudes {
        let error = in_option("--amplitude", amplitude);
        let hysteresis = spec.contact.hysteresis_loop(amplitude).map_err(error)?;
        let constant = spec.contact.complex_stiffness(amplitude).map_err(error)?.dissipated;
        for &phase in &options.phase {
            let at = |i: usize| {
                let angle = |degrees: f64| (degrees + 360.0 * (i % steps) as f64 / steps as f64).to_radians();
                [amplitude * angle(0.0).cos(), (mean + given * angle(phase).cos()).max(0.0)]
            };
            let (period, dissipated) = steady_period(&element, &(0..=steps).map(at).collect::<Vec<_>>())?;
            let row = |[displacement, normal_force, force]: &[f64; 3]| {
                vec![amplitude, phase, *displacement, *normal_force, *force, dissipated, constant]
            };
            let size = format!("{}{}°", name(amplitude), format_number(phase));
            let points = |x: usize, y: usize| period.iter().map(|point| (point[x], point[y])).collect();
            let (stroke, name) = (forces.len(), format!("{size}: {}", rounded(dissipated, Energy, units)));
            forces.push(Line { stroke, name, points: points(0, 2) });
            loads.push(Line { stroke, name: String::new(), points: points(0, 1) });
            rows.extend(period.iter().step_by(steps / n).map(row));
        }
        let points = (0..=n).map(|i| (hysteresis.displacement(i, n), hysteresis.force(i, n))).collect();
        let name = format!("{}constant load: {}", name(amplitude), rounded(constant, Energy, units));
        forces.push(Line { stroke: forces.len(), name, points });
    }
    let columns = [
        ("amplitude", Length),
        ("phase", Angle),
        ("displacement", Length),
        ("normal_force", Force),
        ("force", Force),
        ("dissipated", Energy),
        ("dissipated_constant", Energy),
    ];
    let panels = vec![
        Panel { x: DISPLACEMENT, y: FORCE, lines: forces }.into(),
        Panel { x: DISPLACEMENT, y: NORMAL_FORCE, lines: loads }.into(),
    ];
    let report = Report::new(spec, Table::of_numbers(&columns, units, &rows), panels);
    let load = [mean, given].map(|force| rounded(force, Force, units)).join(" ± ");
    let remark = "dissipated: energy per cycle; dissipated_constant: under the constant normal force";
    Ok(report.under(spec, &load).with_remark(remark))
}

/// The second of two periods, `[displacement, normal force, force]` from the first point to its repetition, and its dissipated
/// energy. They start at the largest normal force, under which the contact was displaced.
fn steady_period(element: &Element, path: &[[f64; 2]]) -> Result<(Vec<[f64; 3]>, f64)> {
    let steps = path.len() - 1;
    let mut state = new_state(2 * steps)?;
    let first = (0..steps).fold(0, |best, i| if path[i][1] > path[best][1] { i } else { best });
    let mut go = |to: [f64; 2]| {
        let step = OneDirection::step(element, &mut state, to).map_err(|error| CliError::Input(error.to_string()))?;
        Ok::<_, CliError>(([to[0], to[1], step.force[0]], step.dissipated))
    };
    go([0.0, path[first][1]])?;
    for i in 0..=steps {
        go(path[(first + i) % steps])?;
    }
    let (mut period, mut dissipated) = (vec![[0.0; 3]; steps + 1], 0.0);
    for i in 1..=steps {
        let index = (first + i) % steps;
        let (point, energy) = go(path[index])?;
        period[index] = point;
        dissipated += energy;
    }
    period[steps] = period[0];
    Ok((period, dissipated))
}
