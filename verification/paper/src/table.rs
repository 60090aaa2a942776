//! Tables of numbers as CSV files; the names of the columns are the legend of the figure.

/// Columns of equal length.
pub struct Table {
    pub name: &'static str,
    columns: Vec<(String, Vec<f64>)>,
}

impl Table {
    pub fn new(name: &'static str) -> Table {
        Table { name, columns: Vec::new() }
    }

    #[must_use]
    pub fn column(mut self, name: impl Into<String>, values: Vec<f64>) -> Table {
        assert!(self.columns.iter().all(|(_, others)| others.len() == values.len()), "columns of equal length");
        assert!(values.iter().all(|value| value.is_finite()), "{}: finite numbers", self.name);
        let name = name.into();
        assert!(!name.contains(','), "{name}: a comma would make two columns");
        self.columns.push((name, rounded(values)));
        self
    }

    /// Two columns of a parametric curve.
    #[must_use]
    pub fn curve(self, name: &str, x: Vec<f64>, y: Vec<f64>) -> Table {
        self.column(format!("x of {name}"), x).column(name, y)
    }

    /// The last of six digits is below the resolution of any picture.
    pub fn csv(&self) -> String {
        let names: Vec<&str> = self.columns.iter().map(|(name, _)| name.as_str()).collect();
        let mut text = names.join(",") + "\n";
        for row in 0..self.columns.first().map_or(0, |(_, values)| values.len()) {
            let cells = self.columns.iter().map(|(_, values)| format!("{:.5e}", values[row]));
            text += &(cells.collect::<Vec<_>>().join(",") + "\n");
        }
        text
    }
}

/// Rounding errors are set to zero: they depend on the machine.
fn rounded(mut values: Vec<f64>) -> Vec<f64> {
    let small = 1e-12 * values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    values.iter_mut().filter(|value| value.abs() < small).for_each(|value| *value = 0.0);
    values
}
