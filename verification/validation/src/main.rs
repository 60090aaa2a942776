//! The law against Kalker and Vollebregt's boundary-element code CONTACT, row by row; in two directions against boundary elements
//! of our own; a sphere against published formulas; strips of finite length against boundary elements; a sliding cylinder against
//! published measurements.
//!
//! - `validation` writes the data of the figures to `target/figures`, and the tables of `docs/validation.md`;
//! - `validation --check` compares the tables with what the library computes now, and the differences with their bounds.

#[path = "../../paper/src/documents.rs"]
mod documents;
mod finite_elements;
mod fretting;
#[path = "../../../tests/golden/table.rs"]
mod golden;
mod histories;
mod mindlin;
mod parts;
#[path = "../../../tests/common/one_direction.rs"]
mod path;
mod rebound;
mod springs;
mod strips;
#[allow(dead_code, reason = "parametric curves are drawn by the other program")]
#[path = "../../paper/src/table.rs"]
mod table;
mod two_directions;

use documents::Documents;
use std::process::ExitCode;

/// The page of the tables.
const PAGE: &str = "validation.md";

/// A table of Markdown as CSV.
fn csv(table: &str) -> String {
    let rows = table.lines().filter(|line| !line.starts_with("|---"));
    rows.map(|line| line.trim_matches(['|', ' ']).replace(", ", "; ").replace(" | ", ",") + "\n").collect()
}

fn main() -> ExitCode {
    let Some(mut documents) = Documents::from_arguments() else {
        eprintln!("usage: validation [--check]");
        return ExitCode::from(2);
    };
    let comparisons = [
        histories::compare,
        mindlin::compare,
        two_directions::compare,
        springs::compare,
        rebound::compare,
        strips::compare,
        parts::compare,
        finite_elements::compare,
        fretting::compare,
        fretting::opening,
    ];
    comparisons.iter().for_each(|compare| compare(&mut documents));
    documents.report()
}
