//! The tables: a row for each output, and a row for each region.

use crate::bounds::{BOUNDS, PROMISES, cells};
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
    for (output, k) in BOUNDS.iter() {
        let Some((key, cell)) = worst(tally, output) else { continue };
        let broken: u64 = of(tally, output).map(|(_, cell)| cell.broken).sum();
        if broken == 0 {
            passed += 1;
        } else {
            failed += 1;
            println!("{output}: {broken} of {} beyond {k} ε", tally.points(output));
            println!("  worst {:.2} ε, error {:.1e}, κ {:.1e}", cell.worst, cell.error, cell.condition);
            println!("  {}, {}: {}", key.1, key.2, cell.inputs);
        }
    }
    (passed, failed)
}

/// The table of promises with the new worst errors.
pub fn write_promises(tally: &Tally, path: &Path) {
    let mut rows = PROMISES.lines();
    let mut csv = rows.next().expect("a head").to_owned() + "\n";
    for row in rows {
        let mut cells = cells(row).into_iter().map(str::to_owned).collect::<Vec<_>>();
        let output = &cells[0];
        if let Some((_, cell)) = worst(tally, output) {
            let plain = of(tally, output).map(|(_, cell)| cell.plain).fold(0.0, f64::max);
            let points = tally.points(output) as f64;
            let measured = [format!("{:.2}", cell.worst), format!("{plain:.1e}"), format!("{points:.1e}")];
            cells.splice(5..8, measured);
        }
        csv += &(cells.join(",") + "\n");
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
