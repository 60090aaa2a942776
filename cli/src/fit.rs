//! The command `fit`: measured loops in, law out.

use crate::args::{Fit, Fixable, ShapeOption};
use crate::columns::{ColumnSpec, parse_columns, read_table};
use crate::commands::{Report, panel};
use crate::contact_spec::ContactSpec;
use crate::error::{CliError, Result, usage};
use crate::files::{check_outputs, write_file};
use crate::number::format_number;
use crate::plot::{Axis, Line, Panel, Row, rounded};
use crate::table::Table;
use crate::units::Quantity::{Energy, Force, Length, Number, Stiffness, Time};
use crate::units::Units;
use microslip_fit::{CauseKind, Estimate, FittedLoop, Measurement, Misfit, NormalForce, Options, ShapeParameter};
use std::path::{Path, PathBuf};

/// Exit status if the law does not explain the loops.
const NOT_EXPLAINED: u8 = 3;
/// Loops that a picture has at most.
const LOOPS: usize = 4;

pub fn fit(options: &Fit, spec: &ContactSpec) -> Result<Report> {
    let extra: Vec<&Path> = [&options.fitted, &options.json].into_iter().flatten().map(PathBuf::as_path).collect();
    check_outputs(&options.measured.iter().map(PathBuf::as_path).collect::<Vec<_>>(), &extra)?;
    let measured = options.measured.iter().enumerate().map(|(index, path)| measurement(options, spec, index, path));
    let (measured, warnings): (Vec<_>, Vec<_>) = measured.collect::<Result<Vec<_>>>()?.into_iter().unzip();
    let contact = spec.given.contact()?;
    let found = microslip_fit::fit(&contact, &measured, &fixed(options, spec))
        .map_err(|error| CliError::Input(error.to_string()))?;
    if let Some(path) = &options.fitted {
        let units = if spec.units == Units::Mm { "units = \"mm\"\n" } else { "" };
        let (comments, parameters): (Vec<_>, Vec<_>) =
            found.contact_toml.lines().partition(|line| line.starts_with('#'));
        write_file(path, format!("{}\n{units}{}\n", comments.join("\n"), parameters.join("\n")).as_bytes())?;
    }
    if let Some(path) = &options.json {
        let json = serde_json::to_vec(&found).map_err(|error| CliError::in_file(path, error))?;
        write_file(path, &json)?;
    }

    let mut report = Report::new(spec, table(&found, spec.units), panels(&found));
    for sentence in &found.verdict {
        report = report.with_remark(sentence);
    }
    let slider = &found.spring_slider;
    let friction = format_number((slider.friction_coefficient * 1e4).round() / 1e4);
    report.picture.caption = format!(
        "μ = {:.4}, misfit {}; spring-slider: μ = {friction}, misfit {}",
        found.friction_coefficient.value,
        rounded(found.law.force_rms, Force, spec.units),
        rounded(slider.misfit.force_rms, Force, spec.units)
    );
    report.status = if found.explanation.explained { 0 } else { NOT_EXPLAINED };
    report.warnings.extend(warnings.into_iter().flatten().flatten().chain(found.warnings));
    Ok(report)
}

/// The measurement of a file, in the units of the contact, and warnings.
fn measurement(
    options: &Fit,
    spec: &ContactSpec,
    index: usize,
    path: &Path,
) -> Result<(Measurement, [Option<String>; 2])> {
    let units = options.data_units;
    let given = |quantity| units.map(|units| if quantity == Length { units.length } else { units.force });
    let of = |option, selected, names, quantity| ColumnSpec {
        given: given(quantity).filter(|_| quantity != Time),
        ..ColumnSpec::new(option, selected, names, quantity, spec.units)
    };
    // Given loads leave no choice.
    let normal: &[&str] = if options.loads.is_empty() { &["normal_force"] } else { &[] };
    let specs = [
        of("--column", &options.column, &["displacement"], Length),
        of("--force-column", &options.force_column, &["force"], Force).required(),
        of("--normal-force-column", &options.normal_force_column, normal, Force),
        of("--time-column", &options.time_column, &["time"], Time),
    ];
    let table =
        parse_columns(&read_table(path)?, options.skip, &specs).map_err(|reason| CliError::in_file(path, reason))?;
    if options.loads.len() > 1 && options.loads.len() != options.measured.len() {
        return usage(format!("--loads has {} values for {} tables", options.loads.len(), options.measured.len()));
    }
    // Whatever the headers of the tables state.
    let factor = units.unwrap_or(spec.units.of_data()).force.in_si / spec.units.in_si(Force);
    let load = match options.loads[..] {
        [] => table.column(2).map(NormalForce::Samples),
        [one] => Some(NormalForce::Constant(factor * one)),
        _ => Some(NormalForce::Constant(factor * options.loads.get(index).copied().unwrap_or(f64::NAN))),
    };
    let [displacement, force] = [0, 1].map(|column| table.column(column).unwrap_or_default());
    let time = table.column(3);
    let name = path.to_string_lossy().into_owned();
    let has_invalid_times = time.iter().flatten().any(|time| !time.is_finite());
    let warnings = [
        table.warning.map(|warning| format!("{name}: {warning}")),
        has_invalid_times.then(|| format!("{name}: some times are not read; equal steps of time are assumed")),
    ];
    let time = time.filter(|_| !has_invalid_times);
    Ok((Measurement { name, displacement, force, normal_force: load, time }, warnings))
}

fn fixed(options: &Fit, spec: &ContactSpec) -> Options {
    let value = |parameter: Fixable, default: Option<f64>| {
        let given = options.fix.iter().find(|(fixed, _)| *fixed == parameter);
        given.and_then(|(_, value)| value.or(default))
    };
    Options {
        friction_coefficient: value(Fixable::FrictionCoefficient, spec.given.friction_coefficient),
        series_compliance: value(Fixable::SeriesCompliance, Some(0.0)),
        contact_compliance: value(Fixable::ContactCompliance, Some(1.0)),
        parallel_stiffness: value(Fixable::ParallelStiffness, Some(0.0)),
        shape: match options.shape {
            _ if options.fix.iter().any(|(fixed, _)| *fixed == Fixable::Shape) => ShapeParameter::Fixed,
            ShapeOption::FlatHalfWidth => ShapeParameter::FlatHalfWidth,
            ShapeOption::EdgeRadius => ShapeParameter::EdgeRadius,
        },
    }
}

fn table(found: &microslip_fit::Report, units: Units) -> Table {
    let [force, stiffness] = [Force, Stiffness].map(|quantity| units.unit(quantity));
    let compliance = format!("{}/N", units.unit(Length));
    let estimate = |(name, at, unit): (&str, &Estimate, &str)| {
        let [value, lower] = [at.value, at.lower].map(format_number);
        let upper = at.upper.map_or(String::new(), format_number);
        format!("{name},{value},{lower},{upper},{unit},{}", at.status.name())
    };
    let shape = found.shape.iter().map(|shape| ("flat_half_width_over_half_width", shape, "-"));
    let estimates = [
        ("friction_coefficient", &found.friction_coefficient, "-"),
        ("series_compliance", &found.series_compliance, compliance.as_str()),
        ("series_stiffening", &found.series_stiffening, "-"),
        ("contact_compliance", &found.contact_compliance, "-"),
        ("parallel_stiffness", &found.parallel_stiffness, stiffness),
        ("total_compliance", &found.total_compliance, compliance.as_str()),
    ];
    let mut rows: Vec<_> = estimates.into_iter().chain(shape).map(estimate).collect();
    let number = |name: &str, value: f64, unit: &str| format!("{name},{},,,{unit},", format_number(value));
    let misfit = |prefix: &str, misfit: &Misfit| {
        [
            number(&format!("{prefix}force_rms"), misfit.force_rms, force),
            number(&format!("{prefix}force_max"), misfit.force_max, force),
            number(&format!("{prefix}energy_error"), misfit.energy, "-"),
        ]
    };
    let explanation = &found.explanation;
    let explained = if explanation.explained { "explained" } else { "not_explained" };
    rows.push(number("noise_rms", explanation.noise, force));
    rows.push(format!("misfit_over_noise,{},,,-,{explained}", format_number(explanation.misfit / explanation.noise)));
    for cause in &explanation.causes {
        let unit = match cause.kind {
            CauseKind::Lag => "samples",
            CauseKind::Play => units.unit(Length),
            _ => "-",
        };
        rows.push(format!("{},{},,,{unit},cause", cause.kind.name(), format_number(cause.size)));
    }
    rows.extend(misfit("", &found.law));
    let slider = &found.spring_slider;
    rows.push(number("spring_slider_friction_coefficient", slider.friction_coefficient, "-"));
    rows.push(number("spring_slider_stiffness", slider.stiffness, stiffness));
    rows.extend(misfit("spring_slider_", &slider.misfit));
    for (one, i) in found.loops.iter().zip(1..) {
        rows.push(number(&format!("loop_{i}_energy_measured"), one.measured_energy, units.unit(Energy)));
        rows.push(number(&format!("loop_{i}_energy"), one.energy, units.unit(Energy)));
    }
    Table::of_text("quantity,value,lower,upper,unit,status", rows)
}

/// Each loop beside the differences from it, and the misfit over the shape.
fn panels(found: &microslip_fit::Report) -> Vec<Row> {
    let of_loop = |one: &FittedLoop| {
        let line = |stroke: usize, name: &str, forces: Vec<f64>| Line {
            stroke,
            name: name.to_owned(),
            points: one.displacement.iter().copied().zip(forces).collect(),
        };
        let less = |forces: &[f64]| one.measured_force.iter().zip(forces).map(|(one, other)| one - other).collect();
        let of_force =
            |name, lines| Panel { x: Axis::linear("displacement", Length), y: Axis::linear(name, Force), lines };
        let loops =
            [(0, "measured", &one.measured_force), (1, "law", &one.force), (2, "spring-slider", &one.slider_force)];
        let panels = vec![
            of_force("force", loops.map(|(stroke, name, forces)| line(stroke, name, forces.clone())).into()),
            of_force(
                "measured - computed",
                loops[1..].iter().map(|(i, _, forces)| line(*i, "", less(forces))).collect(),
            ),
        ];
        Row { panels, equal_scales: false }
    };
    let mut rows: Vec<_> = found.loops.iter().take(LOOPS).map(of_loop).collect();
    if !found.profile.is_empty() {
        // Rounded, so that a flat profile looks flat.
        let points = found.profile.iter().map(|at| (at.shape, (1e3 * at.relative_rms).round() / 1e3)).collect();
        rows.push(panel(Axis::linear("a/b", Number), Axis::linear("misfit over the least", Number), points));
    }
    rows
}
