//! Columns of numbers from the tables that test rigs and programs write.
//!
//! The middle one of the lines that start with a number shows the form of the rows: separator, number of columns, and which of
//! these are numbers. The first line of this form is the first row; all later lines but comments must be rows. The header is the
//! nearest line above with a name for each column; a row of units may lie between. A number has one decimal mark, the same in the
//! whole table: what two rules could read differently is rejected.

use crate::error::{CliError, Result};
use crate::files::{TABLE_SIZE, read_bytes};
use crate::number::parse_number;
use crate::units::{Quantity, Unit, Units, unit};
use std::path::Path;

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

    /// The values of one column.
    pub fn column(&self, index: usize) -> Vec<f64> {
        self.rows.iter().map(|row| row.values[index]).collect()
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
    /// The unit of the values, from the one in the header or the given one.
    pub quantity: Quantity,
    pub units: Units,
    pub given: Option<Unit>,
    /// Whether a table without this column is rejected.
    pub is_required: bool,
}

/// Largest number of rows: more than an hour at 1 kHz. A history needs less than 0.5 kB of memory for each.
const MAX_ROWS: usize = 4_000_000;

/// The text of a file: UTF-8, UTF-16 with a byte-order mark, or else Latin-1, with one kind of line ends, blanks and minus signs.
pub fn read_table(path: &Path) -> Result<String> {
    let bytes = read_bytes(path, TABLE_SIZE)?;
    let utf16 = |of: fn([u8; 2]) -> u16| {
        let units: Vec<_> = bytes[2..].chunks_exact(2).map(|pair| of([pair[0], pair[1]])).collect();
        String::from_utf16_lossy(&units)
    };
    let text = match bytes[..] {
        [0xff, 0xfe, ..] => utf16(u16::from_le_bytes),
        [0xfe, 0xff, ..] => utf16(u16::from_be_bytes),
        _ => String::from_utf8(bytes).unwrap_or_else(|error| error.into_bytes().into_iter().map(char::from).collect()),
    };
    if text.contains('\0') {
        return Err(CliError::in_file(path, "this is no text; save the table as text in UTF-8"));
    }
    Ok(text.replace("\r\n", "\n").replace('\r', "\n").replace('\u{2212}', "-").replace('\u{a0}', " "))
}

/// The lines of a table. A separator is a letter, or none for blanks.
struct Source<'a> {
    separator: Option<char>,
    count: usize,
    /// Line number of the header, its cells, and those of the row of units; without a header, that of the first row.
    header: usize,
    names: Vec<String>,
    units: Vec<String>,
    rows: Vec<(usize, &'a str)>,
}

/// The cells of a line. Separators in quotes separate nothing.
fn split(line: &str, separator: Option<char>) -> Vec<&str> {
    let mut quoted = false;
    let ends = |letter: char| {
        quoted ^= letter == '"';
        !quoted && separator.map_or(letter.is_whitespace(), |separator| letter == separator)
    };
    let cells = line.split(ends).map(|cell| cell.trim().trim_matches('"').trim());
    cells.filter(|cell| separator.is_some() || !cell.is_empty()).collect()
}

/// Whether a cell starts like a number, even if it is invalid.
fn is_number(cell: &str) -> bool {
    let digits = cell.trim_start_matches(['+', '-']).trim_start_matches(['.', ',']);
    digits.starts_with(|letter: char| letter.is_ascii_digit()) || is_missing(cell) || parse_number(cell).is_ok()
}

/// Whether a cell has no value: empty, or one of the names of NaN.
fn is_missing(cell: &str) -> bool {
    matches!(cell.to_ascii_lowercase().as_str(), "nan" | "na" | "n/a" | "#n/a" | "null" | "none" | "-nan" | "nan(ind)")
}

const COMMENTS: [&str; 4] = ["#", "%", "!", "//"];

fn is_comment(line: &str) -> bool {
    COMMENTS.iter().any(|mark| line.trim_start().starts_with(mark)) && !line.to_ascii_lowercase().starts_with("#n/a")
}

/// The separator of a row. Blanks separate numbers with decimal commas: `0,5 1,5`.
fn separator_of(row: &str) -> Option<char> {
    let blanks = split(row, None);
    let found = [';', '\t'].into_iter().find(|separator| row.contains(*separator));
    let are_numbers = || blanks.len() > 1 && blanks.iter().all(|cell| parse_number(&cell.replace(',', ".")).is_ok());
    found.or(match row.contains(',') {
        true if are_numbers() => None,
        false if blanks.len() > 1 => None,
        _ => Some(','),
    })
}

/// The names of a header above rows of the given number of columns, separated like these or otherwise. One name more is that of a
/// column of comments.
fn header(line: &str, separator: Option<char>, count: usize) -> Option<Vec<String>> {
    let mut words = line.split_whitespace().collect::<Vec<_>>().join(" ");
    for (apart, joined) in [(" (", "("), (" [", "["), (" {", "{"), (" <", "<"), (" / ", "/")] {
        words = words.replace(apart, joined);
    }
    let wide = || line.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect();
    let forms = [separator, Some(';'), Some('\t'), Some(',')].into_iter().flatten();
    let forms = forms.map(|separator| split(line, Some(separator))).chain([wide(), split(&words, None)]);
    let is_prose = |cell: &&str| ["and", "or", "of", "in", "vs", "vs.", "versus", "against", "over"].contains(cell);
    let fits = |(i, cells): &(usize, Vec<&str>)| {
        let has_comments = *i == 0 && separator.is_some() && cells.len() == count + 1;
        let are_names = !cells.iter().any(|cell| is_number(cell)) && cells.iter().any(|cell| !cell.is_empty());
        (cells.len() == count || has_comments) && are_names && !cells.iter().any(is_prose)
    };
    let (_, names) = forms.enumerate().find(fits)?;
    Some(names.into_iter().map(str::to_owned).collect())
}

/// A unit in brackets, or without.
fn bare(cell: &str) -> &str {
    cell.trim().trim_matches(['(', ')', '[', ']', '{', '}', '<', '>']).trim()
}

/// Whether the cells are those of a row of units, whose first one may name it: `Y_Unit_Label`.
fn are_units(cells: &[String]) -> bool {
    let named = usize::from(is_label(&cells[0]));
    let known = |cell: &String| unit(bare(cell)).is_some();
    cells[named..].iter().all(|cell| known(cell) || ["", "-"].contains(&bare(cell))) && cells[named..].iter().any(known)
}

fn is_label(cell: &str) -> bool {
    cell.to_lowercase().contains("unit")
}

impl<'a> Source<'a> {
    fn new(text: &'a str, skipped: usize, no_numbers: &str) -> std::result::Result<Source<'a>, String> {
        let lines = text.trim_start_matches('\u{feff}').lines().zip(1..).skip(skipped);
        let mut lines: Vec<_> = lines.map(|(line, number)| (number, line.trim_matches(' '))).collect();
        let stated = lines.first().and_then(|(_, line)| line.trim_matches('"').strip_prefix("sep="));
        let starts = |line: &str| {
            split(line.trim_start_matches([';', ',', '\t']), None)
                .first()
                .is_some_and(|cell| is_number(cell.trim_matches('"')))
        };
        let is_row = |(_, line): &&(usize, &str)| !is_comment(line) && starts(line);
        let count = lines.iter().filter(is_row).count();
        let (_, form) = lines.iter().filter(is_row).nth(count.saturating_sub(1) / 2).copied().ok_or(no_numbers)?;
        let separator = stated.and_then(|text| text.chars().next()).map_or_else(|| separator_of(form), Some);
        if let Some(last) = separator.filter(|separator| form.ends_with(*separator)) {
            lines.iter_mut().for_each(|(_, line)| *line = line.strip_suffix(last).unwrap_or(line));
        }
        let form = split(separator.and_then(|last| form.strip_suffix(last)).unwrap_or(form), separator);
        let has_form = |(_, line): &(usize, &str)| {
            let cells = split(line, separator);
            let mut pairs = cells.iter().zip(&form);
            let fits = pairs.all(|(cell, of_form)| !is_number(of_form) || is_number(cell) || cell.is_empty());
            cells.len() == form.len() && fits && starts(line) && !is_comment(line)
        };
        let first = lines.iter().position(has_form).ok_or(no_numbers)?;
        let (above, rows) = lines.split_at(first);
        let rows: Vec<_> =
            rows.iter().copied().filter(|(_, line)| !line.trim().is_empty() && !is_comment(line)).collect();

        let above: Vec<_> = above.iter().rev().copied().filter(|(_, line)| !line.trim().is_empty()).collect();
        if let Some((number, line)) = above.first().filter(|(_, line)| !is_comment(line)) {
            let cells = split(line, separator);
            if cells.iter().all(|cell| is_number(cell)) {
                return Err(format!(
                    "line {number}: {} columns, but line {} has {}; is a comma the decimal separator? --skip {number} leaves it out",
                    cells.len(),
                    rows[0].0,
                    form.len()
                ));
            }
        }
        let headers = above.iter().filter_map(|(number, line)| {
            let line = line.trim_start_matches(['#', '%', '!', '/', ' ']);
            Some((*number, header(line, separator, form.len())?))
        });
        let headers: Vec<_> = headers.collect();
        // A row of units is next to the names, or labelled.
        let is_row =
            |(i, (_, cells)): &(usize, &(usize, Vec<String>))| are_units(cells) && (*i < 2 || is_label(&cells[0]));
        let of_units = headers.iter().enumerate().find(is_row);
        let units = of_units.map_or(Vec::new(), |(_, (_, units))| units.clone());
        let of_names = headers.iter().find(|(_, cells)| *cells != units).or(headers.first());
        let (header, names) = of_names.cloned().unwrap_or((rows[0].0, Vec::new()));
        if separator == Some(',') && names.is_empty() && rows.iter().all(|(_, line)| may_have_decimal_commas(line)) {
            return Err(format!(
                "line {}: a comma may separate columns or be the decimal separator; name the columns in a header, or write \
                 decimal points, or separate the columns by semicolons",
                rows[0].0
            ));
        }
        Ok(Source { separator, count: form.len().max(names.len()), header, names, units, rows })
    }
}

/// Reads columns of a table: the first, which is the selected one, the one of the default name, or the only one; the second, if
/// it is selected or has its default name in the header; and the first of the alternatives of which that is true.
pub fn parse_columns(
    text: &str,
    skipped: usize,
    [spec, second]: [&ColumnSpec; 2],
    alternatives: &[ColumnSpec],
) -> std::result::Result<InputTable, String> {
    let source = Source::new(text, skipped, &format!("the table has no {}s", spec.default_name()))?;
    let in_header = |reason| format!("line {}: {reason}", source.header);
    let mut found = vec![spec.find(&source).map_err(in_header)?];
    let (mut options, mut has_second, mut alternative) = (vec![spec.option], false, None);
    for (i, other) in [second].into_iter().chain(alternatives).enumerate().filter(|(_, other)| other.is_in(&source)) {
        let column = other.find(&source).map_err(in_header)?;
        match found.iter().position(|(known, _)| *known == column.0) {
            Some(known) if other.selected.is_some() => {
                return Err(in_header(format!("{} and {} select the same column", options[known], other.option)));
            }
            Some(_) => continue,
            None => found.push(column),
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
    let label = |&(index, _): &(usize, f64)| {
        source.names.get(index).map_or(format!("{}", index + 1), |cell| name_of(cell).to_owned())
    };
    let labels: Vec<_> = if source.count > 1 { found.iter().map(label).collect() } else { Vec::new() };
    let mut table = InputTable { has_second, alternative, rows: Vec::new(), labels };
    let mark = DecimalMark::of(&source)?;
    for &(line, row) in &source.rows {
        if table.rows.len() == MAX_ROWS {
            return Err(format!("line {line}: a table has at most {MAX_ROWS} rows"));
        }
        let cells = split(row, source.separator);
        let (count, expected) = (cells.len(), source.count);
        let last = found.iter().map(|(index, _)| *index).fold(0, usize::max);
        if !cells.iter().any(|cell| is_number(cell) || cell.is_empty()) {
            return Err(format!(
                "line {line}: {row:?} is no row of the table, which starts in line {}; delete what follows the table, and give \
                 each table a file of its own",
                source.rows[0].0
            ));
        }
        if count <= last {
            return Err(format!("line {line}: only {count} of {expected} columns"));
        }
        if count > expected {
            let cause = "is a comma the decimal separator? Then separate the columns by semicolons";
            return Err(format!("line {line}: {count} columns, but the first row has {expected}; {cause}"));
        }
        let value = |(i, (index, factor)): (usize, &(usize, f64))| {
            let place = place(line, table.labels.get(i));
            let is_last = || source.rows.last().is_some_and(|(last, _)| *last == line);
            let cut_off = || if is_last() { "; is the file cut off?" } else { "" };
            let value = mark.value(cells[*index]).map(|value| factor * value);
            value.map_err(|reason| format!("{place}: {:?}: {reason}{}", cells[*index], cut_off()))
        };
        let values = found.iter().enumerate().map(value).collect::<std::result::Result<_, _>>()?;
        table.rows.push(InputRow { line, values });
    }
    Ok(table)
}

/// The decimal mark of a table. A number that has both a point and a comma has the mark last, and groups of three digits before.
struct DecimalMark(char);

impl DecimalMark {
    fn of(source: &Source) -> std::result::Result<DecimalMark, String> {
        let is_plain = |cell: &&str| cell.bytes().all(|byte| byte.is_ascii_digit() || b"+-.,eEdD".contains(&byte));
        let cells = || {
            let rows = source.rows.iter().copied();
            let of_row =
                |(line, row)| split(row, source.separator).into_iter().filter(is_plain).map(move |cell| (line, cell));
            rows.flat_map(of_row)
        };
        if let Some((_, both)) = cells().find(|(_, cell)| cell.contains('.') && cell.contains(',')) {
            return Ok(DecimalMark(if both.rfind('.') > both.rfind(',') { '.' } else { ',' }));
        }
        let mut commas = cells().filter(|(_, cell)| cell.contains(',')).peekable();
        let Some(&(line, cell)) = commas.peek() else { return Ok(DecimalMark('.')) };
        // 1,234 but not 0,234 or 1,23.
        let may_be_thousands = |(_, cell): (usize, &str)| {
            let cell = cell.trim_start_matches(['+', '-']);
            let is_group = |group: &str| group.len() == 3 && group.bytes().all(|byte| byte.is_ascii_digit());
            cell.split_once(',').is_some_and(|(first, rest)| {
                !first.is_empty() && !first.starts_with('0') && rest.split(',').all(is_group)
            })
        };
        if commas.all(may_be_thousands) && cells().all(|(_, cell)| !cell.contains('.')) {
            return Err(format!(
                "line {line}: {cell:?} may have a decimal comma or a comma before thousands; write decimal points"
            ));
        }
        Ok(DecimalMark(','))
    }

    /// A number, NaN for a cell without a value.
    fn value(&self, cell: &str) -> std::result::Result<f64, String> {
        if cell.is_empty() || is_missing(cell) {
            return Ok(f64::NAN);
        }
        let other = if self.0 == ',' { '.' } else { ',' };
        let (whole, fraction) = cell.split_at(cell.find(self.0).unwrap_or(cell.len()));
        let mut groups = whole.trim_start_matches(['+', '-']).split(other);
        let first = groups.next().unwrap_or_default().len();
        let has_groups = !fraction.is_empty() && (1..=3).contains(&first) && groups.all(|group| group.len() == 3);
        let text = match cell.contains(other) {
            true if has_groups => cell.replace(other, ""),
            true => {
                return Err(format!(
                    "not a number; other numbers have decimal {}",
                    if other == '.' { "commas" } else { "points" }
                ));
            }
            false => cell.to_owned(),
        };
        let number = parse_number(&text.replace(self.0, ".")).ok().or_else(|| clock(&text));
        number.ok_or_else(|| "not a number".to_owned())
    }
}

/// Seconds of a time of day, also after a date: `2024-03-01 12:00:01.5`.
fn clock(cell: &str) -> Option<f64> {
    let time = cell.rsplit([' ', 'T']).next()?;
    let parts: Vec<f64> = time.split(':').map(|part| parse_number(part).ok()).collect::<Option<_>>()?;
    (parts.len() > 1).then(|| {
        parts.iter().fold(0.0, |seconds, part| 60.0 * seconds + part) * if parts.len() == 2 { 60.0 } else { 1.0 }
    })
}

/// Whether a row of a table without points may be one of decimal commas: an integer is followed by digits, 0,5e-6.
fn may_have_decimal_commas(line: &str) -> bool {
    let is_integer = |cell: &str| cell.bytes().all(|byte| byte.is_ascii_digit()) && !cell.is_empty();
    let is_whole = |cell: &str| is_integer(cell.strip_prefix(['+', '-']).unwrap_or(cell));
    let is_fraction = |cell: &str| is_integer(cell.split(['e', 'E', 'd', 'D']).next().unwrap_or_default());
    let cells: Vec<_> = line.split(',').map(str::trim).collect();
    !line.contains('.') && cells.windows(2).any(|pair| is_whole(pair[0]) && is_fraction(pair[1]))
}

/// The name in a cell of the header, and its unit: in brackets, or the last word after a blank, slash, comma or underline if that is a unit.
fn name_and_unit(cell: &str) -> (&str, Option<&str>) {
    if let Some((name, text)) =
        cell.split_once(['[', '(', '{', '<']).filter(|(name, _)| cell.ends_with(BRACKETS) && !name.is_empty())
    {
        return (name.trim(), Some(bare(text)).filter(|text| !["", "-"].contains(text)));
    }
    match cell.rsplit_once([' ', '/', ',', '_']).map(|(name, last)| (name.trim_matches([' ', '/', ',', '_']), last)) {
        Some((name, last)) if !name.is_empty() && unit(last).is_some() => (name, Some(last)),
        _ => (cell, None),
    }
}

fn name_of(cell: &str) -> &str {
    name_and_unit(cell).0
}

const BRACKETS: [char; 4] = [']', ')', '}', '>'];

/// Names are compared without regard to capitals, blanks and hyphens.
fn plain(name: &str) -> String {
    name.to_lowercase().replace([' ', '-'], "_")
}

impl<'a> ColumnSpec<'a> {
    pub fn new(
        option: &'static str,
        selected: &'a Option<String>,
        names: &'a [&'static str],
        quantity: Quantity,
        units: Units,
    ) -> ColumnSpec<'a> {
        ColumnSpec { option, selected: selected.as_deref(), names, quantity, units, given: None, is_required: false }
    }

    pub fn required(self) -> ColumnSpec<'a> {
        ColumnSpec { is_required: true, ..self }
    }

    /// The columns that have the selected name, or the first default one that the header has.
    fn named(&self, source: &Source) -> Vec<usize> {
        let with = |name: &str| -> Vec<usize> {
            let is = |cell: &String| [cell, name_of(cell)].iter().any(|other| plain(other) == plain(name));
            (0..source.names.len()).filter(|i| is(&source.names[*i])).collect()
        };
        let defaults = self.names.iter().map(|name| with(name)).find(|found| !found.is_empty());
        self.selected.map_or_else(|| defaults.unwrap_or_default(), with)
    }

    /// Whether the column is selected, or its default name is in the header.
    fn is_in(&self, source: &Source) -> bool {
        self.is_required || self.selected.is_some() || !self.named(source).is_empty()
    }

    fn default_name(&self) -> &'static str {
        self.names.first().copied().unwrap_or_default()
    }

    /// Index of the column, and the factor to its unit.
    fn find(&self, source: &Source) -> std::result::Result<(usize, f64), String> {
        let option = self.option;
        let name = self.selected.unwrap_or(self.default_name());
        let columns = match source.names.iter().map(|cell| name_of(cell)).collect::<Vec<_>>() {
            names if names.is_empty() => format!("the {} columns have no names", source.count),
            names => format!("the columns are {}", names.join(", ")),
        };
        let number = self.selected.and_then(|selected| selected.parse::<usize>().ok());
        let index = match self.named(source)[..] {
            [index] => index,
            [_, _, ..] => {
                return Err(format!("several columns are named {name}: select one by its number, {option} NUMBER"));
            }
            [] => match number {
                Some(number) if (1..=source.count).contains(&number) => number - 1,
                None if self.selected.is_none() && source.count == 1 => 0,
                None if self.selected.is_none() => {
                    let by_name = if source.names.is_empty() { String::new() } else { format!("{option} NAME or ") };
                    let select = format!("select one by {by_name}{option} NUMBER, from 1 to {}", source.count);
                    return Err(format!("no column is named {name}; {columns}: {select}"));
                }
                _ => return Err(format!("no column {name}; {columns}, by their numbers 1 to {}", source.count)),
            },
        };
        Ok((index, self.factor(source, index)?))
    }

    /// The factor from the unit of a column to the one of the command.
    fn factor(&self, source: &Source, index: usize) -> std::result::Result<f64, String> {
        let cell = source.names.get(index).map_or("", String::as_str);
        let (name, in_name) = name_and_unit(cell);
        let in_row = source.units.get(index).map(|cell| bare(cell)).filter(|cell| !["", "-"].contains(cell));
        // A last word that is no unit of this quantity is part of the name.
        let is_bare = |text: &&str| unit(text).is_some_and(|unit| unit.quantity == self.quantity);
        let stated = in_row.or(in_name.filter(|text| cell.ends_with(BRACKETS) || is_bare(text)));
        let found = stated.and_then(unit);
        if self.quantity == Quantity::Time {
            // No result depends on it.
            return Ok(1.0);
        }
        let target = self.units.in_si(self.quantity);
        match (stated, found, self.given) {
            (Some(text), None, None) => {
                Err(format!("column {name} is in {text:?}, which is no unit of {}", self.quantity.known()))
            }
            (Some(text), Some(found), _) if found.quantity != self.quantity => Err(format!(
                "column {name} is in {text}, not in {}",
                self.given.map_or(self.units.unit(self.quantity), |given| given.name)
            )),
            (Some(text), Some(found), Some(given)) if found.in_si != given.in_si => {
                Err(format!("column {name} is in {text}, not in {}: correct --data-units or the header", given.name))
            }
            (_, found, given) => Ok(found.or(given).map_or(1.0, |unit| unit.in_si / target)),
        }
    }
}
