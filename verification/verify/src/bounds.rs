//! The promised error of each output, a row of `docs/promises.csv`: |error| <= k ε (1 + κ) scale, ε = 2⁻⁵².

use std::sync::LazyLock;

pub const EPSILON: f64 = f64::EPSILON;

/// Output, domain, k, scale, condition, then three columns that are measured, and the reason.
pub const PROMISES: &str = include_str!("../../../docs/promises.csv");

/// Outputs and their k, in the order of the table.
pub static BOUNDS: LazyLock<Vec<(&str, f64)>> = LazyLock::new(|| {
    let bound = |row| {
        let cells = cells(row);
        (cells[0], cells[2].parse().unwrap_or_else(|_| panic!("{row}: no k")))
    };
    PROMISES.lines().skip(1).map(bound).collect()
});

/// The cells of a row, which may be quoted.
pub fn cells(row: &str) -> Vec<&str> {
    let mut quoted = false;
    let separates = |character: char| {
        quoted ^= character == '"';
        character == ',' && !quoted
    };
    row.split(separates).collect()
}

/// k of an output.
pub fn find(output: &str) -> f64 {
    BOUNDS.iter().find(|bound| bound.0 == output).unwrap_or_else(|| panic!("no bound for {output}")).1
}
