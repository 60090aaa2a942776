//! A table of results as CSV: comments that say how to repeat it, a header with units, numbers in the shortest digits that
//! read back as the same.

use crate::digits::digits;
use crate::units::{Quantity, Units};

#[derive(Debug)]
pub struct Table {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// Rows of numbers, under a name and a quantity for each column.
    pub fn of_numbers<'a>(
        columns: &[(&str, Quantity)],
        units: Units,
        rows: impl IntoIterator<Item = &'a Vec<f64>>,
    ) -> Table {
        let header = |(name, quantity): &(&str, Quantity)| format!("{name} [{}]", units.unit(*quantity));
        let cells = |row: &Vec<f64>| row.iter().map(|&value| digits(value)).collect();
        Table { header: columns.iter().map(header).collect(), rows: rows.into_iter().map(cells).collect() }
    }

    pub fn of_text<const COLUMNS: usize>(header: [&str; COLUMNS], rows: &[[String; COLUMNS]]) -> Table {
        Table { header: header.map(str::to_owned).into(), rows: rows.iter().map(|row| row.to_vec()).collect() }
    }

    /// # Errors
    /// None: it is written to memory.
    pub fn csv(&self, comments: &[String]) -> Result<Vec<u8>, csv::Error> {
        let mut bytes = Vec::new();
        for comment in comments {
            bytes.extend_from_slice(b"# ");
            bytes.extend_from_slice(comment.as_bytes());
            bytes.push(b'\n');
        }
        let mut writer = csv::Writer::from_writer(bytes);
        for row in [&self.header].into_iter().chain(&self.rows) {
            writer.write_record(row)?;
        }
        writer.into_inner().map_err(|error| error.into_error().into())
    }
}
