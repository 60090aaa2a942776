//! The command `history`: a table of displacements, from the unloaded contact on, in one tangential direction or two, under a
//! constant normal force or a varying one.

use crate::args::History;
use crate::columns::{ColumnSpec, InputTable, parse_columns, read_table};
use crate::commands::{DISPLACEMENT, FORCE, Report, pairs};
use crate::contact_spec::ContactSpec;
use crate::error::{CliError, Result};
use crate::number::format_number;
use crate::plot::{Axis, Line, Panel, Row, rounded};
use crate::table::Table;
use crate::units::Quantity::{self, Energy, Force, Length, Stiffness};
use crate::varying_load::{NORMAL_FORCE, new_state};
use microslip::Error;
use microslip::constant_load::state::state_length;
use microslip::constant_load::{ConstantLoad, Law as _};
use microslip::element::{Directions, NormalInput};
use microslip::one_direction::OneDirection;
use microslip::two_directions::TwoDirections;
use std::iter::once;

/// Points of a picture: between the rows all given values change in proportion.
const POINTS: usize = 20_000;

/// Into how many parts a picture divides the step to a row.
fn parts_of_step(table: &InputTable) -> usize {
    (POINTS / table.rows.len()).clamp(1, 500)
}

/// The given values, of which the normal force is left out, and the results. Rows end with the energies of [`ENERGIES`].
struct Applied {
    rows: Vec<Vec<f64>>,
    points: Vec<Vec<f64>>,
    /// Place of the first result.
    results: usize,
}

const ENERGIES: [(&str, Quantity); 2] = [("dissipated", Energy), ("dissipated_total", Energy)];
const ENERGIES_REMARK: &str = "dissipated: energy of each step; dissipated_total: energy up to the end of the step";

pub fn history(options: &History, spec: &ContactSpec) -> Result<Report> {
    let path = &options.displacements;
    let new = |option, selected, names, quantity| ColumnSpec::new(option, selected, names, quantity, spec.units);
    let column = new("--column", &options.column, &["displacement", "displacement_x"], Length);
    let column_y = new("--column-y", &options.column_y, &["displacement_y"], Length);
    // A selected column of normal forces leaves no choice.
    let approach: &[&str] = if options.normal_force_column.is_some() { &[] } else { &["approach"] };
    let specs = [
        column,
        column_y,
        new("--approach-column", &options.approach_column, approach, Length),
        new("--normal-force-column", &options.normal_force_column, &["normal_force"], Force),
    ];
    let table =
        parse_columns(&read_table(path)?, options.skip, &specs).map_err(|reason| CliError::in_file(path, reason))?;
    let inputs = [(2, NormalInput::Approach), (3, NormalInput::Force)];
    let input = inputs.into_iter().find(|(column, _)| table.has(*column)).map(|(_, input)| input);
    let mut report = match input {
        _ if table.has(1) => in_two_directions(options, spec, input, &table),
        None => under_constant_load(options, spec, &table),
        Some(input) => in_one_direction(options, spec, input, &table),
    }?;
    report.warnings.extend(table.warning);
    Ok(report)
}

/// Applies the rows of a table, multiplied by the factors; a step returns its results and its energy.
fn apply(
    options: &History,
    table: &InputTable,
    factors: &[f64],
    results: usize,
    mut state: Vec<f64>,
    step: impl Fn(&mut [f64], &[f64]) -> std::result::Result<(Vec<f64>, f64), Error>,
) -> Result<Applied> {
    let parts = parts_of_step(table);
    let mut applied = Applied { rows: Vec::new(), points: Vec::new(), results };
    let (mut from, mut total) = (vec![0.0; factors.len()], 0.0);
    for row in &table.rows {
        let to: Vec<_> = row.values.iter().zip(factors).map(|(value, factor)| value * factor).collect();
        // Long histories have long states: copied only if steps are divided.
        let mut divided = if parts > 1 { state.clone() } else { Vec::new() };
        for part in 1..parts {
            let fraction = part as f64 / parts as f64;
            let at: Vec<_> = from.iter().zip(&to).map(|(from, to)| from + (to - from) * fraction).collect();
            if let Ok((found, _)) = step(&mut divided, &at) {
                applied.points.push([&at[..results], &found].concat());
            }
        }
        let (found, dissipated) = step(&mut state, &to).map_err(|error| {
            let is_large = |value: &f64| error == Error::BadDisplacement && (value.is_nan() || value.abs() > 1e150);
            let index = to.iter().position(is_large).unwrap_or(to.len() - 1);
            let (place, value) = (table.place(row, index), format_number(to[index]));
            CliError::in_file(&options.displacements, format!("{place}: {value}: {error}"))
        })?;
        total += dissipated;
        let point = [&to[..results], &found].concat();
        applied.rows.push([&point[..], &[dissipated, total]].concat());
        applied.points.push(point);
        from = to;
    }
    Ok(applied)
}

impl Applied {
    /// From the unloaded contact on.
    fn line(&self, stroke: usize, name: &str, point: impl Fn(&[f64]) -> (f64, f64)) -> Line {
        let points = once((0.0, 0.0)).chain(self.points.iter().map(|at| point(at))).collect();
        Line { stroke, name: name.to_owned(), points }
    }

    fn panel(&self, x: Axis, y: Axis, [at_x, at_y]: [usize; 2]) -> Panel {
        Panel { x, y, lines: vec![self.line(0, "", |at| (at[at_x], at[at_y]))] }
    }

    fn table(&self, spec: &ContactSpec, given: &[(&str, Quantity)], results: &[(&str, Quantity)]) -> Table {
        Table::of_numbers(&[&given[..self.results], results, &ENERGIES].concat(), spec.units, &self.rows)
    }

    /// Least and largest normal force, which is the result at a place.
    fn range(&self, place: usize) -> [f64; 2] {
        let forces = pairs(&self.rows, place, place);
        let ends = (f64::INFINITY, 0.0);
        forces.iter().fold(ends.into(), |[least, largest]: [f64; 2], at| [least.min(at.0), largest.max(at.0)])
    }
}

fn under_constant_load(options: &History, spec: &ContactSpec, table: &InputTable) -> Result<Report> {
    let contact = &spec.contact;
    // A history has no more reversals than rows: none is merged, and the results are exact.
    let mut state = vec![0.0; state_length(table.rows.len())];
    ConstantLoad::state_init(&mut state).map_err(|error| CliError::in_file(&options.displacements, error))?;
    let factor = if options.relative { contact.slip_displacement } else { 1.0 };
    let applied = apply(options, table, &[factor], 1, state, |state, to| {
        let step = ConstantLoad::step(contact, state, to[0])?;
        Ok((vec![step.force, step.tangent], step.dissipated))
    })?;
    let rows = applied.table(spec, &[("displacement", Length)], &[("force", Force), ("stiffness", Stiffness)]);
    let panels = vec![applied.panel(DISPLACEMENT, FORCE, [0, 1]).into()];
    Ok(Report::new(spec, rows, panels).with_remark(ENERGIES_REMARK))
}

fn in_one_direction(options: &History, spec: &ContactSpec, input: NormalInput, table: &InputTable) -> Result<Report> {
    let element = spec.element(Directions::One, input)?;
    let by_approach = input == NormalInput::Approach;
    let of_normal = if by_approach { element.approach } else { element.normal_force };
    let factors = if options.relative { [spec.contact.slip_displacement, of_normal] } else { [1.0; 2] };
    // A step adds at most one piece: none is merged, and the results are exact.
    let state = new_state(table.rows.len() + parts_of_step(table))?;
    let n = 1 + usize::from(by_approach);
    let applied = apply(options, table, &factors, n, state, |state, to| {
        let step = OneDirection::step(&element, state, [to[0], to[1]])?;
        let [tangential, normal] = step.force;
        Ok((vec![normal, tangential, step.tangent[0]], step.dissipated))
    })?;
    let results = [("normal_force", Force), ("force", Force), ("stiffness", Stiffness)];
    let rows = applied.table(spec, &[("displacement", Length), ("approach", Length)], &results);
    let [least, largest] = applied.range(n);
    let limit = element.friction_coefficient * largest;
    let cone =
        Line { stroke: 1, name: "±μN".to_owned(), points: vec![(largest, limit), (0.0, 0.0), (largest, -limit)] };
    let mut in_cone = applied.panel(NORMAL_FORCE, FORCE, [n, n + 1]);
    in_cone.lines.push(cone);
    let panels = vec![
        applied.panel(DISPLACEMENT, FORCE, [0, n + 1]).into(),
        applied.panel(DISPLACEMENT, NORMAL_FORCE, [0, n]).into(),
        in_cone.into(),
    ];
    let range = [least, largest].map(|force| rounded(force, Force, spec.units)).join(" to ");
    let remark = format!("stiffness: by the displacement; {ENERGIES_REMARK}");
    Ok(Report::new(spec, rows, panels).under(spec, &range).with_remark(&remark))
}

/// Under the normal force of the parameters without another input.
fn in_two_directions(
    options: &History,
    spec: &ContactSpec,
    input: Option<NormalInput>,
    table: &InputTable,
) -> Result<Report> {
    let element = spec.element(Directions::Two, input.unwrap_or(NormalInput::Force))?;
    let by_approach = input == Some(NormalInput::Approach);
    let of_normal = if by_approach { element.approach } else { element.normal_force };
    let along = spec.contact.slip_displacement;
    let factors = if options.relative { [along, along, of_normal] } else { [1.0; 3] };
    let mut state = vec![0.0; TwoDirections::STATE_LENGTH];
    TwoDirections::state_init(&mut state).map_err(|error| CliError::in_file(&options.displacements, error))?;
    let n = 2 + usize::from(by_approach);
    let applied = apply(options, table, &factors, n, state, |state, to| {
        let to = [to[0], to[1], to.get(2).copied().unwrap_or(element.normal_force)];
        let step = TwoDirections::step(&element, state, to)?;
        let [x, y, normal] = step.force;
        Ok((vec![normal, x, y], step.dissipated))
    })?;
    let given = [("displacement_x", Length), ("displacement_y", Length), ("approach", Length)];
    let rows = applied.table(spec, &given, &[("normal_force", Force), ("force_x", Force), ("force_y", Force)]);
    let [least, largest] = applied.range(n);
    let limit = element.friction_coefficient * largest;
    let orbit = |x, y, quantity, places| applied.panel(Axis::linear(x, quantity), Axis::linear(y, quantity), places);
    let orbits = vec![
        orbit("displacement x", "displacement y", Length, [0, 1]),
        orbit("force x", "force y", Force, [n + 1, n + 2]),
    ];
    let loops = [0, 1].map(|i| applied.line(i + 1, ["x", "y"][i], |at| (at[i], at[n + 1 + i])));
    let magnitudes = vec![
        applied.line(0, "", |at| (at[n], at[n + 1].hypot(at[n + 2]))),
        Line { stroke: 3, name: "μN".to_owned(), points: vec![(0.0, 0.0), (largest, limit)] },
    ];
    let magnitude = Axis::linear("magnitude of the tangential force", Force);
    let panels = vec![
        Row { panels: orbits, equal_scales: true },
        Panel { x: DISPLACEMENT, y: FORCE, lines: loops.into() }.into(),
        Panel { x: NORMAL_FORCE, y: magnitude, lines: magnitudes }.into(),
    ];
    let report = Report::new(spec, rows, panels).with_remark(ENERGIES_REMARK);
    if input.is_none() {
        return Ok(report);
    }
    let range = [least, largest].map(|force| rounded(force, Force, spec.units)).join(" to ");
    Ok(report.under(spec, &range))
}
