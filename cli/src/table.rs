//! Tables of results, as CSV.

use crate::number::format_list;
use crate::units::{Quantity, Units};

/// A table of results.
#[derive(Debug)]
pub struct Table {
    header: String,
    rows: Vec<String>,
}

impl Table {
    /// Rows of numbers; each column has a name and a quantity.
    pub fn of_numbers(columns: &[(&str, Quantity)], units: Units, rows: &[Vec<f64>]) -> Table {
        let header = |(name, quantity): &(&str, Quantity)| format!("{name} [{}]", units.unit(*quantity));
        let header = columns.iter().map(header).collect::<Vec<_>>().join(",");
        Table { header, rows: rows.iter().map(|row| format_list(row)).collect() }
    }

    pub fn of_text(header: &str, rows: Vec<String>) -> Table {
        Table { header: header.to_owned(), rows }
    }

    /// The table after lines of comments.
    pub fn csv(&self, comments: &[String]) -> String {
        let comments = comments.iter().map(|comment| format!("# {comment}\n"));
        let rows = [&self.header].into_iter().chain(&self.rows).map(|row| format!("{row}\n"));
        comments.chain(rows).collect()
    }
}
