//! Tables of numbers as CSV files, the columns under names that are the legend of the figure too.

use std::fmt::Write;

/// Columns of equal length.
pub struct Table {
    pub name: &'static str,
    columns: Vec<(String, Vec<f64>)>,
}

/// Digits of a number; the last is below what any picture shows.
const DIGITS: usize = 6;
/// What another machine's mathematical library may change: a unit of the last digit, at most 1e-5 of a number as large as the
/// largest of its column.
const ROUNDING: f64 = 1.001e-5;

impl Table {
    pub fn new(name: &'static str) -> Table {
        Table { name, columns: Vec::new() }
    }

    #[must_use]
    pub fn column(mut self, name: impl Into<String>, values: Vec<f64>) -> Table {
        assert!(self.columns.iter().all(|(_, others)| others.len() == values.len()), "columns of equal length");
        assert!(values.iter().all(|value| value.is_finite()), "{}: finite numbers", self.name);
        let name = name.into();
        assert!(!name.contains(','), "{name}: a comma would be two columns");
        self.columns.push((name, rounded(values)));
        self
    }

    /// Two columns of a curve of its own.
    #[must_use]
    pub fn curve(self, name: &str, x: Vec<f64>, y: Vec<f64>) -> Table {
        self.column(format!("x of {name}"), x).column(name, y)
    }

    pub fn csv(&self) -> String {
        let names: Vec<&str> = self.columns.iter().map(|(name, _)| name.as_str()).collect();
        let mut text = names.join(",") + "\n";
        for row in 0..self.columns.first().map_or(0, |(_, values)| values.len()) {
            let cells: Vec<String> = self.columns.iter().map(|(_, values)| number(values[row])).collect();
            writeln!(text, "{}", cells.join(",")).expect("text grows");
        }
        text
    }

    /// Compares with a file's text; the error says where they differ.
    pub fn check(&self, file: &str) -> Result<(), String> {
        let text = self.csv();
        let (mut ours, mut theirs) = (text.lines(), file.lines());
        if ours.next() != theirs.next() || text.lines().count() != file.lines().count() {
            return Err(format!("{}: other columns or rows", self.name));
        }
        for (row, (ours, theirs)) in ours.zip(theirs).enumerate() {
            let pairs = ours.split(',').zip(theirs.split(','));
            for ((column, values), (ours, theirs)) in self.columns.iter().zip(pairs) {
                let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
                let difference = match (ours.parse::<f64>(), theirs.parse::<f64>()) {
                    (Ok(ours), Ok(theirs)) => (ours - theirs).abs(),
                    _ => f64::INFINITY,
                };
                if difference > ROUNDING * largest {
                    return Err(format!("{}: {column}, row {}: {theirs}, not {ours}", self.name, row + 1));
                }
            }
        }
        Ok(())
    }
}

/// The same with rounding next to nothing taken for zero: each machine has another.
fn rounded(mut values: Vec<f64>) -> Vec<f64> {
    let small = 1e-12 * values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    values.iter_mut().filter(|value| value.abs() < small).for_each(|value| *value = 0.0);
    values
}

/// A number without trailing zeros, at most six digits.
fn number(value: f64) -> String {
    let text = format!("{value:.*e}", DIGITS - 1);
    let value: f64 = text.parse().expect("a number");
    if value != 0.0 && value.abs() < 1e-4 { format!("{value:e}") } else { format!("{}", value + 0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(values: &[f64]) -> Table {
        Table::new("table").column("x", values.to_vec())
    }

    #[test]
    fn numbers_have_six_digits_and_no_zeros_at_their_end() {
        let numbers = [0.0, -0.0, 0.1, 1.0 / 3.0, -2.0e-5 / 3.0, 123_456.78, 100.0];
        let texts = ["0", "0", "0.1", "0.333333", "-6.66667e-6", "123457", "100"];
        assert_eq!(numbers.map(number), texts);
    }

    #[test]
    fn a_table_differs_by_more_than_rounding_by_its_columns_and_by_its_length() {
        let file = table(&[1.0, 0.5]).csv();
        assert!(table(&[1.000_01, 0.500_01]).check(&file).is_ok());
        assert!(table(&[1.0, 0.5001]).check(&file).is_err());
        assert!(table(&[1.0]).check(&file).is_err());
        assert!(Table::new("table").column("y", vec![1.0, 0.5]).check(&file).is_err());
        assert!(table(&[1.0, 0.5]).check(&file.replace("0.5", "half")).is_err());
    }
}
