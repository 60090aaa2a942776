//! The tables: a row for each output in the document, and a row for each region in a CSV.

use crate::bounds::BOUNDS;
use crate::tally::{Cell, Key, Tally};
use std::fmt::Write;
use std::path::Path;

fn of<'a>(tally: &'a Tally, output: &'a str) -> impl Iterator<Item = (&'a Key, &'a Cell)> {
    tally.cells.iter().filter(move |(key, _)| key.0 == output)
}

/// The region in which an output is worst.
fn worst<'a>(tally: &'a Tally, output: &'a str) -> Option<(&'a Key, &'a Cell)> {
    of(tally, output).max_by(|one, two| one.1.worst.total_cmp(&two.1.worst))
}

/// Number of outputs within their bound, and beyond it; the latter are printed.
pub fn summary(tally: &Tally) -> (usize, usize) {
    let (mut passed, mut failed) = (0, 0);
    for bound in BOUNDS {
        let Some((key, cell)) = worst(tally, bound.output) else { continue };
        let broken: u64 = of(tally, bound.output).map(|(_, cell)| cell.broken).sum();
        if broken == 0 {
            passed += 1;
        } else {
            failed += 1;
            println!("{}: {broken} of {} beyond {} ε", bound.output, tally.points(bound.output), bound.k);
            println!("  worst {:.2} ε, error {:.1e}, κ {:.1e}", cell.worst, cell.error, cell.condition);
            println!("  {}, {}: {}", key.1, key.2, cell.inputs);
        }
    }
    (passed, failed)
}

fn table(tally: &Tally) -> String {
    let mut text = String::from(
        "| output | domain | promised k | relative to | κ | worst k | worst error, κ <= 1 | points | reason |\n\
         |---|---|---:|---|---|---:|---:|---:|---|\n",
    );
    for bound in BOUNDS {
        let Some((_, cell)) = worst(tally, bound.output) else { continue };
        let plain = of(tally, bound.output).map(|(_, cell)| cell.plain).fold(0.0, f64::max);
        let points = tally.points(bound.output);
        writeln!(
            text,
            "| `{}` | {} | {} | {} | {} | {:.2} | {:.1e} | {:.1e} | {} |",
            bound.output,
            bound.domain,
            bound.k,
            bound.scale,
            bound.condition,
            cell.worst,
            plain,
            points as f64,
            bound.reason
        )
        .unwrap();
    }
    text
}

/// Replaces the table between two markers of a document.
pub fn write_table(tally: &Tally, path: &Path) {
    let (begin, end) = ("<!-- errors: begin -->\n", "<!-- errors: end -->");
    let old = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let (head, rest) = old.split_once(begin).expect("markers");
    let (_, tail) = rest.split_once(end).expect("markers");
    std::fs::write(path, format!("{head}{begin}{}{end}{tail}", table(tally))).unwrap();
}

/// A row for each region.
pub fn write_regions(tally: &Tally, path: &Path) {
    let mut csv = "output,contact,range,points,between,broken,worst_k,error,condition,plain_error,inputs\n".to_owned();
    for (key, cell) in &tally.cells {
        writeln!(
            csv,
            "{},\"{}\",\"{}\",{},{},{},{:.4e},{:.3e},{:.3e},{:.3e},\"{}\"",
            key.0,
            key.1,
            key.2,
            cell.points,
            cell.between,
            cell.broken,
            cell.worst,
            cell.error,
            cell.condition,
            cell.plain,
            cell.inputs
        )
        .unwrap();
    }
    std::fs::write(path, csv).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
}
