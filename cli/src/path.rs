//! A path of displacements from a table.

use crate::refusal::{Outcome, Refusal};
use crate::units::{Quantity, Units};
use csv::{ReaderBuilder, StringRecord, Trim};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// A displacement and the number of its row in the table, without comments and empty lines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    pub number: usize,
    pub displacement: f64,
}

/// Reads the column of that name or number, else the only one or the one called displacement.
pub fn read(path: &Path, column: Option<&str>, units: Units) -> Outcome<Vec<Row>> {
    let source: Box<dyn Read> = if path == Path::new("-") {
        Box::new(io::stdin())
    } else {
        Box::new(File::open(path).map_err(|error| Refusal::in_file(path, error))?)
    };
    let rows = parse(source, column, units)
        .and_then(|rows| if rows.is_empty() { Err("there are no displacements".to_owned()) } else { Ok(rows) });
    rows.map_err(|reason| Refusal::in_file(path, reason))
}

fn parse(source: impl Read, column: Option<&str>, units: Units) -> Result<Vec<Row>, String> {
    let mut reader =
        ReaderBuilder::new().has_headers(false).flexible(true).comment(Some(b'#')).trim(Trim::All).from_reader(source);
    let mut rows = Vec::new();
    let mut place = None;
    for (record, number) in reader.records().zip(1..) {
        let record = record.map_err(|error| error.to_string())?;
        // With these, a comma may be that of a number.
        if record.iter().any(|cell| cell.contains(';')) {
            return Err(format!("row {number}: columns are separated by commas, not by semicolons"));
        }
        let place = match place {
            Some(place) => place,
            None => *place.insert(find(&record, column, units)?),
        };
        let cell = record.get(place).ok_or(format!("row {number} has no column {}", place + 1))?;
        match number_in(cell) {
            Some(displacement) => rows.push(Row { number, displacement }),
            None if number == 1 && is_header(&record) => {}
            None => return Err(format!("row {number}: {cell:?} is not a number; columns are separated by commas")),
        }
    }
    Ok(rows)
}

/// A number, with the exponent that Fortran writes too: 1.0D-06.
fn number_in(cell: &str) -> Option<f64> {
    cell.replace(['d', 'D'], "e").parse().ok()
}

/// A first row of names. What begins as a number does is a number that cannot be read.
fn is_header(record: &StringRecord) -> bool {
    let begins_as_number =
        |cell: &str| cell.starts_with(|letter: char| letter.is_ascii_digit() || "+-.".contains(letter));
    record.iter().all(|cell| !begins_as_number(cell) && number_in(cell).is_none())
}

/// The column to take, from the first row.
fn find(first: &StringRecord, wanted: Option<&str>, units: Units) -> Result<usize, String> {
    let name_of = |cell: &str| cell.split('[').next().unwrap_or_default().trim().to_owned();
    let wanted_name = wanted.unwrap_or("displacement");
    let names = if is_header(first) { first.iter().map(name_of).collect() } else { Vec::new() };
    if let Some(place) = names.iter().position(|name| name == wanted_name) {
        let unit = first[place].split_once('[').map(|(_, rest)| rest.trim_end_matches(']').trim());
        let expected = units.unit(Quantity::Length);
        return match unit {
            Some(unit) if unit != expected => {
                Err(format!("column {wanted_name} is in {unit}, not in {expected} (see --units)"))
            }
            _ => Ok(place),
        };
    }
    match wanted {
        Some(wanted) => match wanted.parse::<usize>() {
            Ok(number) if (1..=first.len()).contains(&number) => Ok(number - 1),
            _ if names.is_empty() => Err(format!("there is no column {wanted}; columns are 1 to {}", first.len())),
            _ => Err(format!("there is no column {wanted}; columns are {}", names.join(", "))),
        },
        None if first.len() == 1 => Ok(0),
        None => Err(format!("which of the {} columns has the displacements? Name it by --column", first.len())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn displacements(text: &str, column: Option<&str>) -> Result<Vec<f64>, String> {
        Ok(parse(text.as_bytes(), column, Units::Si)?.iter().map(|row| row.displacement).collect())
    }

    #[test]
    fn a_column_is_found_by_its_name_its_number_or_alone() {
        let two = Ok(vec![1e-6, -2e-6]);
        assert_eq!(displacements("1e-6\n-2e-6\n", None), two);
        assert_eq!(displacements("\u{feff}u\n1e-6\n\n# rest\n-2e-6", None), two);
        assert_eq!(displacements("# c\ntime [s], displacement [m]\n0,1e-6\n1, -2e-6\n", None), two);
        assert_eq!(displacements("t,u\n0,1e-6\n1,-2e-6\n", Some("u")), two);
        assert_eq!(displacements("0,1e-6\n1,-2e-6\n", Some("2")), two);
        assert_eq!(displacements(" 1.0D-06\n-2.0d-06\n", None), two);
        let rows = parse(
            "x
1

#
2"
            .as_bytes(),
            None,
            Units::Si,
        )
        .unwrap();
        assert_eq!(rows.iter().map(|row| row.number).collect::<Vec<_>>(), [2, 3]);
    }

    #[test]
    fn what_cannot_be_read_is_named() {
        for (text, column, reason) in [
            ("1\nx\n", None, "row 2: \"x\" is not a number"),
            ("1.0-300\n1\n", None, "row 1: \"1.0-300\" is not a number"),
            ("0.0 1e-6\n0.1 2e-6\n", None, "columns are separated by commas"),
            ("0;1,0E-06\n", Some("2"), "row 1: columns are separated by commas, not by semicolons"),
            ("u\n", None, "no displacements"),
            ("t,u\n0,1\n", None, "which of the 2 columns"),
            ("t,u\n0,1\n", Some("w"), "there is no column w; columns are t, u"),
            ("0,1\n", Some("3"), "there is no column 3; columns are 1 to 2"),
            ("displacement [mm]\n1\n", None, "column displacement is in mm, not in m"),
            ("t,u\n0\n", Some("u"), "row 2 has no column 2"),
        ] {
            match displacements(text, column) {
                Err(error) => assert!(error.contains(reason), "{error}"),
                Ok(rows) => assert!(rows.is_empty() && reason == "no displacements", "{text}"),
            }
        }
    }
}
