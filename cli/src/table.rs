//! Tables as CSV: results, and columns of an input file.

use crate::error::{CliError, Result};
use crate::files::{TABLE_SIZE, read_text};
use crate::number::{format_list, parse_number};
use crate::units::{Quantity, Units};
use std::path::Path;

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

/// A row of an input table: its line number in the file, and the values of the columns that a command reads.
#[derive(Debug)]
pub struct InputRow {
    pub line: usize,
    pub values: Vec<f64>,
}

/// The columns that a command reads.
#[derive(Debug)]
pub struct InputTable {
    /// Whether the second column was read.
    pub has_second: bool,
    /// The alternative that was read as the last column: its place among them.
    pub alternative: Option<usize>,
    pub rows: Vec<InputRow>,
    /// Names of the columns in messages; none if the table has one column only.
    labels: Vec<String>,
}

impl InputTable {
    /// Where a value is, for messages.
    pub fn place(&self, row: &InputRow, index: usize) -> String {
        place(row.line, self.labels.get(index))
    }
}

fn place(line: usize, label: Option<&String>) -> String {
    label.map_or_else(|| format!("line {line}"), |label| format!("line {line}, column {label}"))
}

/// A column that a command reads.
#[derive(Debug, Clone, Copy)]
pub struct ColumnSpec<'a> {
    /// The option that selects it, and the value of that option: a name or a number from 1.
    pub option: &'static str,
    pub selected: Option<&'a str>,
    /// Names in the header if no other is selected.
    pub names: &'a [&'static str],
    /// The unit that the header may name.
    pub unit: &'a str,
}

/// Reads columns of a CSV file: the first, which is the selected one, the one of the default name, or the only one; the second, if
/// it is selected or has its default name in the header; and the first of the alternatives of which that is true.
pub fn read_columns(path: &Path, columns: [&ColumnSpec; 2], alternatives: &[ColumnSpec]) -> Result<InputTable> {
    let text = read_text(path, TABLE_SIZE)?;
    parse_columns(&text, columns, alternatives).map_err(|reason| CliError::in_file(path, reason))
}

/// Largest number of rows: more than an hour at 1 kHz. A history needs less than 0.5 kB of memory for each.
const MAX_ROWS: usize = 4_000_000;

/// [`read_columns`] from the text of a file.
pub fn parse_columns(
    text: &str,
    [spec, second]: [&ColumnSpec; 2],
    alternatives: &[ColumnSpec],
) -> std::result::Result<InputTable, String> {
    let lines = text.trim_start_matches('\u{feff}').lines().map(str::trim).zip(1..);
    let lines = lines.filter(|(line, _)| !line.is_empty() && !line.starts_with('#'));
    let no_numbers = || format!("the table has no {}s", spec.default_name());
    let (first, number) = lines.clone().next().ok_or_else(no_numbers)?;
    let separator = [';', '\t'].into_iter().find(|separator| first.contains(*separator)).unwrap_or(',');
    let split = |line| -> Vec<&str> {
        let cells = str::split(line, separator);
        cells.map(|cell| cell.trim().trim_matches('"').trim()).collect()
    };
    let first = split(first);
    let numbers = lines.clone().skip(usize::from(is_header(&first)));
    let decimal_comma = separator != ',' && numbers.clone().any(|(line, _)| line.contains(','));
    if separator == ',' && !is_header(&first) && lines.clone().all(|(line, _)| may_have_decimal_commas(line)) {
        return Err(format!(
            "line {number}: a comma may separate columns or be the decimal separator; name the columns in a header, or write \
             decimal points, or separate the columns by semicolons"
        ));
    }
    let in_header = |reason| format!("line {number}: {reason}");
    let mut indices = vec![spec.find(&first).map_err(in_header)?];
    let (mut options, mut has_second, mut alternative) = (vec![spec.option], false, None);
    for (i, other) in [second].into_iter().chain(alternatives).enumerate().filter(|(_, other)| other.is_in(&first)) {
        let index = other.find(&first).map_err(in_header)?;
        match indices.iter().position(|known| *known == index) {
            Some(known) if other.selected.is_some() => {
                return Err(in_header(format!("{} and {} select the same column", options[known], other.option)));
            }
            Some(_) => continue,
            None => indices.push(index),
        }
        options.push(other.option);
        match i.checked_sub(1) {
            None => has_second = true,
            Some(place) => {
                alternative = Some(place);
                break;
            }
        }
    }
    let label =
        |index: &usize| if is_header(&first) { name_of(first[*index]).to_owned() } else { format!("{}", index + 1) };
    let labels: Vec<_> = if first.len() > 1 { indices.iter().map(label).collect() } else { Vec::new() };
    let mut table = InputTable { has_second, alternative, rows: Vec::new(), labels };
    for (cells, line) in numbers.map(|(cells, line)| (split(cells), line)) {
        if table.rows.len() == MAX_ROWS {
            return Err(format!("line {line}: a table has at most {MAX_ROWS} rows"));
        }
        let (count, expected) = (cells.len(), first.len());
        if count < expected {
            return Err(format!("line {line}: only {count} of {expected} columns"));
        }
        if count > expected {
            let cause = "is a comma the decimal separator? Then separate the columns by semicolons";
            return Err(format!("line {line}: {count} columns, but the first row has {expected}; {cause}"));
        }
        let value = |(i, index): (usize, &usize)| {
            let (cell, place) = (cells[*index], place(line, table.labels.get(i)));
            let number = match decimal_comma {
                true if cell.contains('.') => Err("not a number; other numbers have decimal commas"),
                true => parse_number(&cell.replace(',', ".")),
                false => parse_number(cell),
            };
            let of_separator = "columns are separated by commas, semicolons or tabs";
            number.map_err(|reason| format!("{place}: {cell:?}: {reason}; {of_separator}"))
        };
        let values = indices.iter().enumerate().map(value).collect::<std::result::Result<_, _>>()?;
        table.rows.push(InputRow { line, values });
    }
    if table.rows.is_empty() { Err(no_numbers()) } else { Ok(table) }
}

/// Whether a row of a table without points may be one of decimal commas: an integer is followed by digits, 0,5e-6.
fn may_have_decimal_commas(line: &str) -> bool {
    let is_integer = |cell: &str| cell.bytes().all(|byte| byte.is_ascii_digit()) && !cell.is_empty();
    let is_whole = |cell: &str| is_integer(cell.strip_prefix(['+', '-']).unwrap_or(cell));
    let is_fraction = |cell: &str| is_integer(cell.split(['e', 'E', 'd', 'D']).next().unwrap_or_default());
    let cells: Vec<_> = line.split(',').map(str::trim).collect();
    !line.contains('.') && cells.windows(2).any(|pair| is_whole(pair[0]) && is_fraction(pair[1]))
}

/// Whether the first row has names. A cell that starts like a number is a number, even if invalid.
fn is_header(cells: &[&str]) -> bool {
    let starts_number = |cell: &str| cell.starts_with(|letter: char| letter.is_ascii_digit() || "+-.".contains(letter));
    cells.iter().all(|cell| !starts_number(cell) && parse_number(cell).is_err())
}

/// The name in a cell of the header: without its unit.
fn name_of(cell: &str) -> &str {
    cell.split('[').next().unwrap_or_default().trim()
}

impl<'a> ColumnSpec<'a> {
    pub fn new(
        option: &'static str,
        selected: &'a Option<String>,
        names: &'a [&'static str],
        unit: &'a str,
    ) -> ColumnSpec<'a> {
        ColumnSpec { option, selected: selected.as_deref(), names, unit }
    }

    /// Whether the column is selected, or its default name is in the header.
    fn is_in(&self, first: &[&str]) -> bool {
        self.selected.is_some() || (is_header(first) && first.iter().any(|cell| self.names.contains(&name_of(cell))))
    }

    fn default_name(&self) -> &'static str {
        self.names.first().copied().unwrap_or_default()
    }

    /// Index of the column, from the cells of the first row.
    fn find(&self, first: &[&str]) -> std::result::Result<usize, String> {
        let names: Vec<_> = first.iter().map(|cell| name_of(cell)).collect();
        let default = || self.names.iter().find(|name| names.contains(name)).copied();
        let name = self.selected.or_else(default).unwrap_or(self.default_name());
        if is_header(first) && names.iter().filter(|other| **other == name).count() > 1 {
            return Err(format!("several columns are named {name}: {} must select one by its number", self.option));
        }
        if let Some(index) = names.iter().position(|other| is_header(first) && *other == name) {
            let expected = self.unit;
            return match first[index].split_once('[').map(|(_, unit)| unit.trim_end_matches(']').trim()) {
                Some(unit) if unit != expected => {
                    Err(format!("column {name} is in {unit}, not in {expected} (see --units, or --data-units of fit)"))
                }
                _ => Ok(index),
            };
        }
        let number = self.selected.and_then(|selected| selected.parse::<usize>().ok());
        match (self.selected, number) {
            (Some(_), Some(number)) if (1..=first.len()).contains(&number) => Ok(number - 1),
            (Some(_), _) if is_header(first) => Err(format!("no column {name}; the columns are {}", names.join(", "))),
            (Some(_), _) => Err(format!("no column {name}; the columns are 1 to {}", first.len())),
            (None, _) if first.len() == 1 => Ok(0),
            (None, _) => {
                let (count, option) = (first.len(), self.option);
                Err(format!("{option} must select one of the {count} columns, by its name in the header or its number"))
            }
        }
    }
}
