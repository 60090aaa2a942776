//! The tables: a row for each output, and a row for each region.

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

/// A row for each output.
pub fn write_promises(tally: &Tally, path: &Path) {
    let mut csv = "output,domain,promised_k,relative_to,condition,worst_k,worst_plain_error,points,reason\n".to_owned();
    for bound in BOUNDS {
        let Some((_, cell)) = worst(tally, bound.output) else { continue };
        let plain = of(tally, bound.output).map(|(_, cell)| cell.plain).fold(0.0, f64::max);
        let points = tally.points(bound.output) as f64;
        writeln!(
            csv,
            "{},\"{}\",{},\"{}\",\"{}\",{:.2},{plain:.1e},{points:.1e},\"{}\"",
            bound.output, bound.domain, bound.k, bound.scale, bound.condition, cell.worst, bound.reason
        )
        .unwrap();
    }
    write(path, &csv);
}

fn write(path: &Path, text: &str) {
    std::fs::write(path, text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
}

/// A row for each region.
pub fn write_regions(tally: &Tally, path: &Path) {
    let mut csv = "output,contact,range,points,between,broken,worst_k,error,condition,plain_error,inputs\n".to_owned();
    for ((output, contact, range), cell) in &tally.cells {
        let Cell { points, between, broken, worst, error, condition, plain, inputs } = cell;
        let numbers = format!("{points},{between},{broken},{worst:.4e},{error:.3e},{condition:.3e},{plain:.3e}");
        writeln!(csv, "{output},\"{contact}\",\"{range}\",{numbers},\"{inputs}\"").unwrap();
    }
    write(path, &csv);
}
