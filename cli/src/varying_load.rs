//! Commands under a normal force that varies, with separation.

use crate::args::{History, Loop, Normal};
use crate::columns::InputTable;
use crate::commands::{
    DISPLACEMENT, ENERGIES, ENERGIES_REMARK, FORCE, Report, STIFFNESS, check_range, grid, pairs, panel, parts_of_step,
    scaled,
};
use crate::contact_spec::ContactSpec;
use crate::error::{CliError, Result};
use crate::number::{Amount, format_number};
use crate::plot::{Axis, Line, Panel, Row, rounded};
use crate::table::Table;
use crate::units::Quantity::{Angle, Energy, Force, Length, Stiffness};
use microslip::Error;
use microslip::element::{Directions, Element, NormalInput};
use microslip::one_direction::{OneDirection, state_length};
use microslip::two_directions::{Law, TwoDirections};

const NORMAL_FORCE: Axis = Axis::linear("normal force", Force);

pub fn normal(options: &Normal, spec: &ContactSpec) -> Result<Report> {
    let element = spec.element(Directions::One, NormalInput::Approach)?;
    let at_approach = |option: &str, approach: f64| {
        element.check_approach(approach).map_err(|error| CliError::in_option(option, approach, error))?;
        let point = element.normal_force_at(approach);
        Ok(vec![approach, point.value, point.slope, element.half_width_under(point.value)])
    };
    let at_force = |&force: &f64| {
        element.check_normal_force(force).map_err(|error| CliError::in_option("--force", force, error))?;
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
    let approach = Axis::linear("approach", Length);
    // Both may jump as the contact closes.
    let of_closed =
        |y: usize| rows.iter().map(move |row| (row[0], if row[1] > 0.0 { row[y] } else { f64::NAN })).collect();
    let panels = vec![
        panel(approach, NORMAL_FORCE, pairs(&rows, 0, 1)),
        panel(approach, STIFFNESS, of_closed(2)),
        panel(approach, Axis::linear("half-width", Length), of_closed(3)),
    ];
    Ok(Report::new(spec, Table::of_numbers(&columns, spec.units, &rows), panels))
}

/// The state of an open contact at displacement 0.
fn new_state(pieces: usize) -> Result<Vec<f64>> {
    let mut state = vec![0.0; state_length(pieces)];
    OneDirection::state_init(&mut state).map_err(|error| CliError::Input(error.to_string()))?;
    Ok(state)
}

/// Pieces of the state from which a picture is drawn; what merging changes is invisible.
const PIECES_OF_PICTURE: usize = 256;

/// A step in two directions takes longer than one in one direction: fewer points are drawn.
const TRIALS_PER_POINT: usize = 5;

pub fn history(options: &History, spec: &ContactSpec, input: NormalInput, table: &InputTable) -> Result<Report> {
    let (element, path, count) = (spec.element(Directions::One, input)?, &options.displacements, table.rows.len());
    let by_approach = input == NormalInput::Approach;
    let of_normal = if by_approach { element.approach } else { element.normal_force };
    let factors = if options.relative { [spec.contact.slip_displacement, of_normal] } else { [1.0; 2] };
    // A step adds at most one piece: none is merged, and the results are exact.
    let (mut state, mut drawn) = (new_state(count)?, new_state(PIECES_OF_PICTURE)?);
    let parts = parts_of_step(count);
    let (mut rows, mut points, mut from) = (Vec::new(), vec![[0.0; 3]], [0.0; 2]);
    let (mut least, mut largest, mut total) = (f64::INFINITY, 0f64, 0.0);
    for row in &table.rows {
        let to = [row.values[0] * factors[0], row.values[1] * factors[1]];
        let step = OneDirection::step(&element, &mut state, to).map_err(|error| {
            let index = usize::from(error != Error::BadDisplacement || to[0].abs() <= 1e150);
            let (place, value) = (table.place(row, index), format_number(to[index]));
            CliError::in_file(path, format!("{place}: {value}: {error}"))
        })?;
        for part in 1..=parts {
            let fraction = f64::from(part) / f64::from(parts);
            let normal = normal_between(&element, from[1], to[1], fraction);
            let at = if part < parts { [from[0] + (to[0] - from[0]) * fraction, normal] } else { to };
            let step = OneDirection::step(&element, &mut drawn, at).map_err(|error| CliError::in_file(path, error))?;
            points.push([at[0], step.force[1], step.force[0]]);
        }
        let [tangential, normal] = step.force;
        (least, largest) = (least.min(normal), largest.max(normal));
        let given = [to[1]].into_iter().filter(|_| by_approach);
        total += step.dissipated;
        let results = [normal, tangential, step.tangent[0], step.dissipated, total];
        rows.push([to[0]].into_iter().chain(given).chain(results).collect());
        from = to;
    }
    let approach = [("approach", Length)].into_iter().filter(|_| by_approach);
    let others = [("normal_force", Force), ("force", Force), ("stiffness", Stiffness)];
    let columns: Vec<_> =
        [("displacement", Length)].into_iter().chain(approach).chain(others).chain(ENERGIES).collect();
    let line = |x: usize, y: usize| Line {
        stroke: 0,
        name: String::new(),
        points: points.iter().map(|point| (point[x], point[y])).collect(),
    };
    let limit = element.friction_coefficient * largest;
    let cone =
        Line { stroke: 1, name: "±μN".to_owned(), points: vec![(largest, limit), (0.0, 0.0), (largest, -limit)] };
    let panels = vec![
        Panel { x: DISPLACEMENT, y: FORCE, lines: vec![line(0, 2)] }.into(),
        Panel { x: DISPLACEMENT, y: NORMAL_FORCE, lines: vec![line(0, 1)] }.into(),
        Panel { x: NORMAL_FORCE, y: FORCE, lines: vec![line(1, 2), cone] }.into(),
    ];
    let report = Report::new(spec, Table::of_numbers(&columns, spec.units, &rows), panels);
    let range = format!("{} to {}", rounded(least, Force, spec.units), rounded(largest, Force, spec.units));
    Ok(report.under(spec, &range).with_remark(&format!("stiffness: by the displacement; {ENERGIES_REMARK}")))
}

/// Displacement and force.
type Point = [[f64; 3]; 2];

/// A history in both tangential directions; under the normal force of the parameters without another input.
pub fn history_in_two_directions(
    options: &History,
    spec: &ContactSpec,
    input: Option<NormalInput>,
    table: &InputTable,
) -> Result<Report> {
    let element = spec.element(Directions::Two, input.unwrap_or(NormalInput::Force))?;
    let (path, by_approach) = (&options.displacements, input == Some(NormalInput::Approach));
    let of_normal = if by_approach { element.approach } else { element.normal_force };
    let along = spec.contact.slip_displacement;
    let factors = if options.relative { [along, along, of_normal] } else { [1.0; 3] };
    let mut state = vec![0.0; TwoDirections::STATE_LENGTH];
    TwoDirections::state_init(&mut state).map_err(|error| CliError::in_file(path, error))?;
    let parts = parts_of_step(TRIALS_PER_POINT * table.rows.len());
    let (mut rows, mut points, mut from): (_, Vec<Point>, _) = (Vec::new(), vec![[[0.0; 3]; 2]], [0.0; 3]);
    let (mut least, mut largest, mut total) = (f64::INFINITY, 0f64, 0.0);
    for row in &table.rows {
        let given = |i: usize| row.values.get(i).map_or(element.normal_force, |value| value * factors[i]);
        let to = [given(0), given(1), given(2)];
        let go = |state: &mut [f64], to: [f64; 3]| {
            TwoDirections::step(&element, state, to).map_err(|error| {
                let is_large = |value: &f64| error == Error::BadDisplacement && (value.is_nan() || value.abs() > 1e150);
                let index = to.iter().position(is_large).unwrap_or(2);
                let (place, value) = (table.place(row, index), format_number(to[index]));
                CliError::in_file(path, format!("{place}: {value}: {error}"))
            })
        };
        for part in 1..parts {
            let fraction = f64::from(part) / f64::from(parts);
            let [x, y] = [0, 1].map(|i| from[i] + (to[i] - from[i]) * fraction);
            let at = [x, y, normal_between(&element, from[2], to[2], fraction)];
            points.push([at, go(&mut state.clone(), at)?.force]);
        }
        let step = go(&mut state, to)?;
        points.push([to, step.force]);
        let [force_x, force_y, normal] = step.force;
        (least, largest) = (least.min(normal), largest.max(normal));
        let given = to.into_iter().take(if by_approach { 3 } else { 2 });
        total += step.dissipated;
        rows.push(given.chain([normal, force_x, force_y, step.dissipated, total]).collect());
        from = to;
    }
    let approach = [("approach", Length)].into_iter().filter(|_| by_approach);
    let others = [("normal_force", Force), ("force_x", Force), ("force_y", Force)];
    let displacements = [("displacement_x", Length), ("displacement_y", Length)];
    let columns: Vec<_> = displacements.into_iter().chain(approach).chain(others).chain(ENERGIES).collect();
    let line = |stroke: usize, name: &str, point: &dyn Fn(&Point) -> (f64, f64)| Line {
        stroke,
        name: name.to_owned(),
        points: points.iter().map(point).collect(),
    };
    let limit = element.friction_coefficient * largest;
    let magnitude = Axis::linear("magnitude of the tangential force", Force);
    let orbits = [("displacement x", "displacement y", Length), ("force x", "force y", Force)];
    let orbits = [0, 1].map(|i| {
        let (x, y, quantity) = orbits[i];
        let lines = vec![line(0, "", &|point| (point[i][0], point[i][1]))];
        Panel { x: Axis::linear(x, quantity), y: Axis::linear(y, quantity), lines }
    });
    let loops = [0, 1].map(|i| line(i + 1, ["x", "y"][i], &|point| (point[0][i], point[1][i])));
    let magnitudes = vec![
        line(0, "", &|point| (point[1][2], point[1][0].hypot(point[1][1]))),
        Line { stroke: 3, name: "μN".to_owned(), points: vec![(0.0, 0.0), (largest, limit)] },
    ];
    let panels = vec![
        Row { panels: orbits.into(), equal_scales: true },
        Panel { x: DISPLACEMENT, y: FORCE, lines: loops.into() }.into(),
        Panel { x: NORMAL_FORCE, y: magnitude, lines: magnitudes }.into(),
    ];
    let report = Report::new(spec, Table::of_numbers(&columns, spec.units, &rows), panels);
    let report = report.with_remark(ENERGIES_REMARK);
    if input.is_none() {
        return Ok(report);
    }
    let range = format!("{} to {}", rounded(least, Force, spec.units), rounded(largest, Force, spec.units));
    Ok(report.under(spec, &range))
}

/// The normal component at a fraction of the displacement of a step, which is straight in the tangential shift; while open, in the
/// approach.
fn normal_between(element: &Element, from: f64, to: f64, fraction: f64) -> f64 {
    let by_approach = element.normal_input == NormalInput::Approach as i32;
    let load = |input: f64| if by_approach { element.normal_force_at(input).value } else { input };
    // The closed part of the path, between two fractions.
    let crossing = element.crossing(from, to);
    let (start, end) = match (from > 0.0, to > 0.0) {
        (true, true) => (0.0, 1.0),
        (true, false) => (0.0, crossing),
        (false, true) => (crossing, 1.0),
        (false, false) => (1.0, 1.0),
    };
    if fraction < start || fraction > end || start >= end {
        return if by_approach { from + (to - from) * fraction } else { 0.0 };
    }
    let [first, last] = [from, to].map(|input| element.shift_under(load(input.max(0.0))));
    let shift = first + (last - first) * (fraction - start) / (end - start);
    let normal_force = element.load_under(shift.max(0.0));
    if by_approach { element.approach_under(normal_force).value } else { normal_force }
}

/// Steps of a period, at least, from which a loop and its energy are computed.
const STEPS_OF_PERIOD: usize = 4096;

/// Loops under `N (1 + a cos(ωt + φ))`, or 0 where that is negative, for `u = û cos ωt`.
pub fn swinging_loop(options: &Loop, spec: &ContactSpec, amplitudes: &[f64]) -> Result<Report> {
    let (element, units) = (spec.element(Directions::One, NormalInput::Force)?, spec.units);
    let (mean, n) = (element.normal_force, options.points as usize);
    let given = match options.normal_amplitude {
        Some(Amount::Fraction(fraction)) => fraction * mean,
        Some(Amount::Absolute(multiple)) if options.relative => multiple * mean,
        Some(Amount::Absolute(force)) => force,
        None => 0.0,
    };
    if !(given >= 0.0 && given.is_finite()) {
        return Err(CliError::in_option("--normal-amplitude", given, Error::BadForceAmplitude));
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
    let mut strokes = 0..;
    let mut next_stroke = || strokes.next().unwrap_or_default();
    for &amplitude in amplitudes {
        let error = |error| CliError::in_option("--amplitude", amplitude, error);
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
            let of_loop: Vec<_> = period.iter().step_by(steps / n).map(row).collect();
            let size = format!("{}{}°", name(amplitude), format_number(phase));
            let points = |x: usize, y: usize| period.iter().map(|point| (point[x], point[y])).collect();
            let (stroke, name) = (next_stroke(), format!("{size}: {}", rounded(dissipated, Energy, units)));
            forces.push(Line { stroke, name, points: points(0, 2) });
            loads.push(Line { stroke, name: String::new(), points: points(0, 1) });
            rows.extend(of_loop);
        }
        let points = (0..=n).map(|i| (hysteresis.displacement(i, n), hysteresis.force(i, n))).collect();
        let name = format!("{}constant load: {}", name(amplitude), rounded(constant, Energy, units));
        forces.push(Line { stroke: next_stroke(), name, points });
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
