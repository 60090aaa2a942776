//! The law against Kalker and Vollebregt's boundary-element code CONTACT, row by row; in two directions against boundary elements of
//! our own; strips of finite length against boundary elements; a sliding cylinder against published measurements.
//!
//! - `validation` writes the data of the figures to `target/figures`, and the tables of `docs/validation.md`;
//! - `validation --check` compares the tables with what the library computes now, and the differences with their bounds.

#[path = "../../paper/src/documents.rs"]
mod documents;
mod drive;
mod finite_elements;
mod fretting;
#[path = "../../../tests/golden/table.rs"]
mod golden;
mod histories;
mod rebound;
mod springs;
mod strips;
#[allow(dead_code, reason = "parametric curves are drawn by the other program")]
#[path = "../../paper/src/table.rs"]
mod table;
mod two_directions;

use documents::{Documents, between};
use drive::{Point, SUBSTEPS};
use histories::{History, Row, Shape};
use std::fmt::Write;
use std::process::ExitCode;

/// A history compared with the law along it.
struct Comparison {
    history: History,
    /// Largest difference of displacements, over the largest displacement.
    difference: f64,
    /// Energy dissipated according to CONTACT over that of the law.
    dissipated: f64,
    /// Largest difference of the approach of a line contact, relative.
    approach: f64,
}

/// Largest difference of displacements, relative: the error of CONTACT.
///
/// - Always that of its mesh (the sphere is cut into squares, 31 along the diameter), and of the four printed digits of each increment.
/// - Under a changing load also that of its steps: what comes into contact within a step is free of traction at its end, an error of
///   first order in the change of the width. The flat hardly changes its width; in phase and in antiphase nothing slips.
fn bound(history: &History) -> f64 {
    match (history.shape, history.name.split_once('_').map_or("", |(_, path)| path)) {
        (Shape::Cylinder, "phase90") => 1.2e-3,
        (Shape::Cylinder, _) => 2.5e-4,
        (Shape::RoundedFlat, "constN") => 5e-4,
        (Shape::RoundedFlat, _) => 3e-4,
        (Shape::Sphere, "phase90") => 4e-3,
        (Shape::Sphere, _) => 2.5e-3,
    }
}

/// Its losses are those of 24 steps in a cycle; under a constant load they are those of the law, except that a flat slips in one or two
/// of its elements only.
fn bounds_of_dissipation(history: &History) -> [f64; 2] {
    match (history.shape, history.name.ends_with("constN")) {
        (Shape::RoundedFlat, true) => [0.6, 1.4],
        (_, true) => [0.98, 1.01],
        (_, false) => [0.85, 1.02],
    }
}

/// Four printed digits.
const APPROACH: f64 = 6e-4;

fn compare(history: History) -> Comparison {
    let largest = history.rows.iter().map(|row| row.normal_force).fold(0.0, f64::max);
    let element = history.shape.element(largest).expect("an element");
    let law = drive::varying(&element, &history);
    let scale = history.rows.iter().map(|row| row.displacement.abs()).fold(0.0, f64::max);
    let at_rows: Vec<Point> = law.iter().copied().step_by(SUBSTEPS as usize).collect();
    let pairs = history.rows.iter().zip(&at_rows);
    let difference =
        pairs.map(|(row, point)| (row.displacement - point.displacement).abs() / scale).fold(0.0, f64::max);
    let approach = |row: &Row| {
        let computed = element.approach_under(row.normal_force).value;
        (row.approach / computed - 1.0).abs()
    };
    let last = at_rows[at_rows.len() - 1].dissipated;
    Comparison {
        difference,
        dissipated: history.rows[history.rows.len() - 1].dissipated / last,
        approach: history.rows.iter().map(approach).fold(0.0, f64::max),
        history,
    }
}

impl Comparison {
    /// The checks of a history, a message for each that fails.
    fn results(&self) -> Vec<Result<(), String>> {
        let name = self.history.name;
        let holds = |holds: bool, message: String| if holds { Ok(()) } else { Err(format!("{name}: {message}")) };
        let (bound, [low, high]) = (bound(&self.history), bounds_of_dissipation(&self.history));
        let mut results = vec![
            holds(self.difference <= bound, format!("displacements differ by {:.1e}", self.difference)),
            holds((low..=high).contains(&self.dissipated), format!("{:.2} of the dissipation", self.dissipated)),
        ];
        if self.history.shape != Shape::Sphere {
            results.push(holds(self.approach <= APPROACH, format!("approaches differ by {:.1e}", self.approach)));
        }
        results
    }

    fn row(&self) -> String {
        let Comparison { history, difference, dissipated, .. } = self;
        let (shape, path) = history.name.split_once('_').expect("shape and path");
        let shape = if shape == "roundedflat" { "flat with rounded edges" } else { shape };
        let path = match path {
            "constN" => "constant load".to_owned(),
            "steps" => "seven straight paths".to_owned(),
            _ => path.replace("phase", "load swings, ") + "°",
        };
        let rows = history.rows.len();
        format!("| {shape} | {path} | {rows} | {difference:.1e} | {dissipated:.2} |\n")
    }
}

/// A table of Markdown as CSV.
fn csv(table: &str) -> String {
    let rows = table.lines().filter(|line| !line.starts_with("|---"));
    rows.map(|line| line.trim_matches(['|', ' ']).replace(", ", "; ").replace(" | ", ",") + "\n").collect()
}

fn table_of(comparisons: &[Comparison]) -> String {
    let mut table = String::from("| contact | path | rows | displacement | dissipation |\n|---|---|---:|---:|---:|\n");
    comparisons.iter().for_each(|comparison| table.write_str(&comparison.row()).expect("a string"));
    table
}

fn main() -> ExitCode {
    if std::env::args().skip(1).eq(["--reference".to_owned()]) {
        springs::print_reference();
        return ExitCode::SUCCESS;
    }
    let Some(mut documents) = Documents::from_arguments() else {
        eprintln!("usage: validation [--check | --reference]");
        return ExitCode::from(2);
    };
    let comparisons: Vec<Comparison> = histories::all().into_iter().map(compare).collect();
    documents.results.extend(comparisons.iter().flat_map(Comparison::results));
    let springs = springs::Comparison::new();
    documents.results.extend(springs.results());
    let directions = two_directions::Comparison::new();
    documents.results.extend(directions.results());
    let (strips, strip_results) = strips::compare();
    documents.results.extend(strip_results);
    let (finite_elements, finite_element_results) = finite_elements::compare();
    documents.results.extend(finite_element_results);
    let fretting = fretting::Comparison::new();
    documents.results.extend(fretting.results());
    let (opening, opening_results) = fretting::opening();
    documents.results.extend(opening_results);
    let rebound = rebound::Comparison::new();
    documents.results.extend(rebound.results());
    rebound.drawings().iter().for_each(|table| documents.data(table));
    let mut tables = Vec::from(directions.tables());
    tables.push(("equations in two directions", springs.table()));
    let [measured, computed] = rebound.tables();
    tables.extend([("rebound", measured), ("rebound by finite elements", computed)]);
    tables.extend([("strips", strips), ("finite elements", finite_elements), ("fretting", fretting.table())]);
    documents.page("boundary_elements.csv", |_| Ok(csv(&table_of(&comparisons))));
    documents.page("opening.csv", |_| Ok(csv(&opening)));
    documents.page("validation.md", |old| {
        tables.iter().try_fold(old.to_owned(), |page, (name, table)| between(&page, name, |_| Ok(table.clone())))
    });
    documents.report()
}
