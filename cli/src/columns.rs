//! Columns of numbers from the tables that test rigs and programs write.
//!
//! - Rows: the form that most lines have, their separator and which of their columns are numbers. The first line of this form is
//!   the first row. Text after the last row is left out; between rows only comments are.
//! - Numbers: one decimal mark in the whole table, that of the first number which has no other meaning. A cell without a number is
//!   a missing value.
//! - Names and units: of the nearest line above with a name for each column, preferably one of those that are looked for; a row of
//!   units may be near.

use crate::error::{CliError, Result};
use crate::files::{TABLE_SIZE, read_bytes};
use crate::number::parse_number;
use crate::units::{Quantity, Unit, Units, unit};
use std::path::Path;

/// A row of an input table: its line number in the file, and the values of the columns that were found.
#[derive(Debug)]
pub struct InputRow {
    pub line: usize,
    pub values: Vec<f64>,
}

/// The columns that a command reads.
#[derive(Debug)]
pub struct InputTable {
    /// The columns that were found: their places among those that were looked for.
    found: Vec<usize>,
    pub rows: Vec<InputRow>,
    /// Names of the columns in messages; none if the table has one column only.
    labels: Vec<String>,
    /// What was left out after the last row.
    pub warning: Option<String>,
}

impl InputTable {
    /// Where a value is, for messages.
    pub fn place(&self, row: &InputRow, index: usize) -> String {
        place(row.line, self.labels.get(index))
    }

    pub fn has(&self, column: usize) -> bool {
        self.found.contains(&column)
    }

    /// The values of a column; `None` if it was not found.
    pub fn column(&self, column: usize) -> Option<Vec<f64>> {
        let index = self.found.iter().position(|found| *found == column)?;
        Some(self.rows.iter().map(|row| row.values[index]).collect())
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

/// The text of a file: UTF-8, UTF-16 or else Latin-1, with one kind of line ends, blanks, minus signs and apostrophes.
pub fn read_table(path: &Path) -> Result<String> {
    let bytes = read_bytes(path, TABLE_SIZE)?;
    let utf16 = |of: fn([u8; 2]) -> u16| {
        let units: Vec<_> = bytes.chunks_exact(2).map(|pair| of([pair[0], pair[1]])).collect();
        String::from_utf16_lossy(&units)
    };
    let text = match bytes[..] {
        [0xff, 0xfe, ..] | [1..=0xff, 0, ..] => utf16(u16::from_le_bytes),
        [0xfe, 0xff, ..] | [0, 1..=0xff, ..] => utf16(u16::from_be_bytes),
        _ => String::from_utf8(bytes).unwrap_or_else(|error| error.into_bytes().into_iter().map(char::from).collect()),
    };
    if text.contains('\0') {
        return Err(CliError::in_file(path, "this is no text; save the table as text in UTF-8"));
    }
    let text = text.replace("\r\n", "\n").replace('\r', "\n");
    let letters: [(&[char], &str); 3] =
        [(&['\u{2212}', '\u{2013}'], "-"), (&['\u{a0}', '\u{2009}', '\u{202f}'], " "), (&['\u{2019}'], "'")];
    Ok(letters.into_iter().fold(text, |text, (from, to)| text.replace(from, to)))
}

/// The cells of a line; `None` separates by blanks. Separators in quotes separate nothing.
fn split(line: &str, separator: Option<char>) -> Vec<&str> {
    let mut quoted = false;
    let ends = |letter: char| {
        quoted ^= letter == '"';
        !quoted && separator.map_or(letter.is_whitespace(), |separator| letter == separator)
    };
    let cells = line.split(ends).map(|cell| cell.trim().trim_matches(['"', '\'']).trim());
    cells.filter(|cell| separator.is_some() || !cell.is_empty()).collect()
}

/// The number of cells without empty ones at the end, which separators at the end of a line leave.
fn length(cells: &[&str]) -> usize {
    cells.iter().rposition(|cell| !cell.is_empty()).map_or(0, |last| last + 1)
}

/// Whether a cell starts like a number, even if it is invalid, or is a name of no number.
fn is_number(cell: &str) -> bool {
    let digits = cell.trim_start_matches(['+', '-']).trim_start_matches(['.', ',']);
    let missing = ["-", "--", "na", "n/a", "#n/a", "n.a.", "null", "none"];
    digits.starts_with(|letter: char| letter.is_ascii_digit())
        || parse_number(cell).is_ok()
        || missing.contains(&cell.to_ascii_lowercase().as_str())
}

/// Whether a cell has no value: it is empty, text, or an error of a program, as 1.#QNAN and #DIV/0!.
fn is_missing(cell: &str) -> bool {
    !cell.contains(|letter: char| letter.is_ascii_digit()) || cell.contains('#')
}

const COMMENTS: [&str; 5] = ["#", "%", "!", "//", ";"];
/// Marks before the names in a header.
const MARKS: [char; 8] = ['#', '%', '!', '/', ';', '*', '-', '\''];

/// Errors of spreadsheets are no comments, nor is an empty first cell.
fn is_comment(line: &str, separator: Option<char>) -> bool {
    let is_cell = ["#N/A", "#DIV", "#NUM", "#VAL", "#REF"].iter().any(|error| line.starts_with(error))
        || separator.is_some_and(|separator| line.starts_with(separator));
    !is_cell && COMMENTS.iter().any(|mark| line.starts_with(mark))
}

/// The separator of a row. Blanks separate numbers with decimal commas: `0,5 1,5`.
fn separator_of(row: &str) -> Option<char> {
    let blanks = split(row, None);
    let are_numbers =
        || blanks.len() > 1 && blanks.iter().all(|cell| number(cell, ',').is_some() && !cell.ends_with(','));
    let found = [';', '\t', '|'].into_iter().find(|separator| row.trim().contains(*separator));
    found.or(match row.contains(',') {
        true if are_numbers() => None,
        false if blanks.len() > 1 => None,
        _ => Some(','),
    })
}

/// The form of a row: its separator, and which of its columns are numbers.
#[derive(Debug, PartialEq)]
struct Form {
    separator: Option<char>,
    numbers: Vec<bool>,
}

/// Lines from which the form is found, of more only some.
const LINES: usize = 2000;

impl Form {
    /// The form that has most numbers in all its lines.
    fn of<'a>(lines: impl Iterator<Item = &'a str>, stated: Option<char>) -> Option<Form> {
        let mut forms: Vec<(Form, usize)> = Vec::new();
        for line in lines.filter(|line| !is_comment(line, Some(';'))) {
            let separator = stated.map_or_else(|| separator_of(line), Some);
            let cells = split(line, separator);
            let numbers: Vec<_> = cells[..length(&cells)].iter().map(|cell| is_number(cell)).collect();
            let (form, count) = (Form { separator, numbers }, cells.iter().filter(|cell| is_number(cell)).count());
            match forms.iter_mut().find(|(known, _)| *known == form) {
                Some((_, known)) => *known += count,
                None => forms.push((form, count)),
            }
        }
        forms.into_iter().filter(|(_, count)| *count > 0).max_by_key(|(_, count)| *count).map(|(form, _)| form)
    }

    fn split<'a>(&self, line: &'a str) -> Vec<&'a str> {
        split(line.split(" # ").next().unwrap_or_default(), self.separator)
    }

    /// Whether the cells have a number where the form has one, or nothing.
    fn fits(&self, cells: &[&str]) -> bool {
        let mut pairs = cells.iter().zip(&self.numbers);
        cells.len() >= self.numbers.len()
            && cells.iter().any(|cell| is_number(cell))
            && pairs.all(|(cell, is_needed)| !is_needed || is_number(cell) || cell.is_empty())
    }
}

/// The lines of a table.
struct Source<'a> {
    form: Form,
    count: usize,
    /// Line number of the header, its cells, and those of the row of units; without a header, that of the first row.
    header: usize,
    names: Vec<String>,
    units: Vec<String>,
    /// The number of names in the line above the rows, if it is not that of the columns.
    other_names: Option<(usize, usize)>,
    rows: Vec<(usize, &'a str)>,
    /// What follows the last row.
    rest: Option<(usize, &'a str)>,
}

/// The names of a header above rows of the given number of columns, separated like these or otherwise. One name more is that of a
/// column of comments.
fn header(
    line: &str,
    separator: Option<char>,
    count: usize,
    is_wanted: &dyn Fn(&[String]) -> bool,
) -> Option<Vec<String>> {
    let mut words = line.split_whitespace().collect::<Vec<_>>().join(" ");
    for (apart, joined) in [(" (", "("), (" [", "["), (" {", "{"), (" <", "<"), (" / ", "/")] {
        words = words.replace(apart, joined);
    }
    let wide = || line.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect();
    let forms = [separator, Some(';'), Some('\t'), Some(',')].into_iter().flatten();
    let forms = forms.map(|separator| split(line, Some(separator))).chain([wide(), split(&words, None)]);
    let is_prose =
        |cell: &String| ["and", "or", "of", "in", "vs", "vs.", "versus", "against", "over"].contains(&cell.as_str());
    let names = |(i, cells): (usize, Vec<&str>)| {
        let has_comments = i == 0 && separator.is_some() && length(&cells) == count + 1;
        let names: Vec<_> =
            cells[..length(&cells).max(count).min(cells.len())].iter().map(|cell| (*cell).to_owned()).collect();
        let are_names = !names.iter().any(|cell| is_number(cell) || is_prose(cell)) && length(&cells) > 0;
        ((names.len() == count || has_comments) && (are_names || is_wanted(&names))).then_some(names)
    };
    forms.enumerate().find_map(names)
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
    fn new(text: &'a str, skipped: usize, specs: &[ColumnSpec]) -> std::result::Result<Source<'a>, String> {
        let is_edge = |letter: char| letter == ' ' || letter == '\u{feff}' || (letter.is_control() && letter != '\t');
        let lines = text.lines().zip(1..).skip(skipped).map(|(line, number)| (number, line.trim_matches(is_edge)));
        let lines: Vec<_> = lines.filter(|(_, line)| !line.chars().all(|letter| " \t,;|".contains(letter))).collect();
        let stated = lines.first().and_then(|(_, line)| {
            let line = line.trim_matches('"');
            line.get(..4).filter(|key| key.eq_ignore_ascii_case("sep="))?;
            line.chars().nth(4)
        });
        let sample = lines.iter().step_by(1 + lines.len() / LINES).map(|(_, line)| *line);
        let no_rows = || format!("the table has no {}s", specs[0].default_name());
        let form = Form::of(sample, stated).ok_or_else(no_rows)?;
        let (separator, count) = (form.separator, form.numbers.len());
        let is_row = |(_, line): &(usize, &str)| !is_comment(line, separator) && form.fits(&form.split(line));
        let is_text = |(_, line): &(usize, &str)| !form.split(line).first().is_none_or(|cell| is_number(cell));
        let first = lines.iter().position(is_row).ok_or_else(no_rows)?;
        let last = lines.iter().rposition(|line| is_row(line) || !is_text(line)).unwrap_or(first);
        let is_data = |(_, line): &&(usize, &str)| !is_comment(line, separator);
        let rows: Vec<_> = lines[first..=last].iter().filter(is_data).copied().collect();
        let rest = lines[last + 1..].iter().find(is_data).copied();

        let is_other = |(_, line): &&(usize, &str)| {
            let cells = form.split(line);
            let are_few = cells.len() < count && !cells.iter().all(|cell| is_number(cell));
            are_few || !cells.iter().any(|cell| is_number(cell))
        };
        if let Some((number, line)) = rows.iter().find(is_other) {
            return Err(format!(
                "line {number}: {line:?} is no row of the table, which starts in line {}; give each table a file of its own, or \
                 leave out lines at the start with --skip",
                rows[0].0
            ));
        }

        let above: Vec<_> = lines[..first].iter().rev().copied().collect();
        let next = above.first().map(|&(number, line)| (number, length(&split(line, separator)), line));
        let are_numbers = |line| split(line, separator).iter().all(|cell| is_number(cell));
        if let Some((number, columns, line)) = next.filter(|(.., line)| are_numbers(line)) {
            return Err(format!(
                "line {number}: {line:?} has {columns} columns, but line {} has {count}{}; --skip {number} leaves it out",
                rows[0].0,
                of_comma(separator)
            ));
        }
        let is_wanted = |cells: &[String]| specs.iter().any(|spec| !spec.named(cells).is_empty());
        let headers = above.iter().filter_map(|&(number, line)| {
            let remark = line.get(..4).filter(|mark| mark.eq_ignore_ascii_case("rem "));
            let line = remark.map_or(line, |mark| &line[mark.len()..]);
            let unmarked = line.trim_start_matches(MARKS).trim_start();
            let found = [line, unmarked].into_iter().filter_map(|line| header(line, separator, count, &is_wanted));
            Some((number, found.max_by_key(|cells| is_wanted(cells))?))
        });
        let headers: Vec<_> = headers.collect();
        // A row of units is near the names, or labelled.
        let is_of_units =
            |(i, (_, cells)): &(usize, &(usize, Vec<String>))| are_units(cells) && (*i < 2 || is_label(&cells[0]));
        let units = headers.iter().enumerate().find(is_of_units).map_or(Vec::new(), |(_, (_, units))| units.clone());
        let of_names = headers.iter().find(|(_, cells)| is_wanted(cells));
        let of_names = of_names.or(headers.iter().find(|(_, cells)| *cells != units)).or(headers.first());
        let (header, names) = of_names.cloned().unwrap_or((rows[0].0, Vec::new()));
        let other_names = next.filter(|_| names.is_empty()).map(|(number, columns, _)| (number, columns));
        let may_be_decimal = |(_, line): &(usize, &str)| {
            let cells = form.split(line);
            !line.contains('.') && cells.windows(2).any(|pair| number(&pair.join(","), ',').is_some())
        };
        if separator == Some(',') && names.is_empty() && rows.iter().all(may_be_decimal) {
            return Err(format!(
                "line {}: a comma may separate columns or be the decimal separator; name the columns in a header, or write \
                 decimal points, or separate the columns by semicolons",
                rows[0].0
            ));
        }
        let count = count.max(names.len());
        Ok(Source { form, count, header, names, units, other_names, rows, rest })
    }
}

fn of_comma(separator: Option<char>) -> &'static str {
    if separator == Some(',') {
        "; is a comma the decimal separator? Then separate the columns by semicolons"
    } else {
        ""
    }
}

/// Reads the first column, which is the selected one, the one of the default name, or the only one, and of the others those that
/// are required, selected, or have their default name in the header.
pub fn parse_columns(text: &str, skipped: usize, specs: &[ColumnSpec]) -> std::result::Result<InputTable, String> {
    let source = Source::new(text, skipped, specs)?;
    let form = &source.form;
    let in_header = |reason| format!("line {}: {reason}", source.header);
    let (mut found, mut columns): (Vec<usize>, Vec<(usize, f64)>) = (Vec::new(), Vec::new());
    for (i, spec) in specs.iter().enumerate().filter(|(i, spec)| *i == 0 || spec.is_in(&source)) {
        let column = spec.find(&source).map_err(in_header)?;
        match columns.iter().position(|(known, _)| *known == column.0) {
            Some(known) if spec.selected.is_some() => {
                let known = specs[found[known]].option;
                return Err(in_header(format!("{known} and {} select the same column", spec.option)));
            }
            Some(_) => {}
            None => (found.push(i), columns.push(column)).1,
        }
    }
    let label = |&(index, _): &(usize, f64)| {
        source.names.get(index).map_or(format!("{}", index + 1), |cell| name_of(cell).to_owned())
    };
    let labels: Vec<_> = if source.count > 1 { columns.iter().map(label).collect() } else { Vec::new() };
    let warning =
        source.rest.map(|(line, text)| format!("line {line}: {text:?} and what follows is no row; it is left out"));
    let mut table = InputTable { found, rows: Vec::new(), labels, warning };
    let mark = decimal_mark(&source)?;
    let needed = columns.iter().map(|(index, _)| *index).fold(0, usize::max);
    for &(line, row) in &source.rows {
        if table.rows.len() == MAX_ROWS {
            return Err(format!("line {line}: a table has at most {MAX_ROWS} rows"));
        }
        let cells = form.split(row);
        let (count, expected) = (length(&cells), source.count);
        let is_last = source.rows.last().is_some_and(|(last, _)| *last == line);
        let cut_off = if is_last { "; is the file cut off?" } else { "" };
        if cells.len() <= needed {
            return Err(format!("line {line}: only {count} of {expected} columns{cut_off}"));
        }
        if count > expected {
            let comma = of_comma(form.separator);
            return Err(format!("line {line}: {count} columns, but line {} has {expected}{comma}", source.rows[0].0));
        }
        let value = |(i, (index, factor)): (usize, &(usize, f64))| {
            let cell = cells[*index];
            let value = match specs[table.found[i]].quantity {
                _ if is_missing(cell) => Some(f64::NAN),
                // No result depends on a time.
                Quantity::Time => Some(seconds(cell, mark).unwrap_or(f64::NAN)),
                _ => number(cell, mark),
            };
            let invalid = || {
                let other = if mark == '.' { "points" } else { "commas" };
                let is_valid = |cell: &str| number(cell, ',').or(number(cell, '.')).is_some();
                let hint = match cell.trim_end_matches(|letter: char| letter.is_alphabetic() || letter == ' ') {
                    _ if is_valid(cell) => format!("; other numbers have decimal {other}"),
                    start if start.len() < cell.len() && is_valid(start) => "; write its unit in the header".to_owned(),
                    _ => cut_off.to_owned(),
                };
                format!("{}: {cell:?}: not a number{hint}", place(line, table.labels.get(i)))
            };
            value.map(|value| factor * value).ok_or_else(invalid)
        };
        let values = columns.iter().enumerate().map(value).collect::<std::result::Result<_, _>>()?;
        table.rows.push(InputRow { line, values });
    }
    Ok(table)
}

/// The decimal mark of a table: the only one with which some cell is a number.
fn decimal_mark(source: &Source) -> std::result::Result<char, String> {
    let mut comma = None;
    for &(line, row) in &source.rows {
        for cell in source.form.split(row) {
            match ['.', ','].map(|mark| number(cell, mark).is_some()) {
                [true, false] => return Ok('.'),
                [false, true] => return Ok(','),
                [true, true] if cell.contains(',') => comma = comma.or(Some((line, cell))),
                _ => {}
            }
        }
    }
    comma.map_or(Ok('.'), |(line, cell)| {
        Err(format!("line {line}: {cell:?} may have a decimal comma or a comma before thousands; write decimal points"))
    })
}

/// A number with this decimal mark. Between groups of three digits may be the other mark, a blank or an apostrophe.
fn number(cell: &str, mark: char) -> Option<f64> {
    let (whole, fraction) = cell.split_at(cell.find(mark).unwrap_or(cell.len()));
    let ends = [if mark == ',' { '.' } else { ',' }, ' ', '\''];
    let groups: Vec<_> = whole.trim_start_matches(['+', '-']).split(ends).collect();
    let is_group = |group: &&str| group.len() == 3 && group.bytes().all(|byte| byte.is_ascii_digit());
    let are_groups =
        (1..=3).contains(&groups[0].len()) && !groups[0].starts_with('0') && groups[1..].iter().all(is_group);
    if groups.len() > 1 && !are_groups {
        return None;
    }
    parse_number(&(whole.replace(ends, "") + &fraction.replace(mark, "."))).ok()
}

/// A time, also one of day, with a date or without: `2024-03-01 12:00:01.5`, `12:00:01,5 PM`.
fn seconds(cell: &str, mark: char) -> Option<f64> {
    let mut words = cell.split([' ', 'T', 'Z', '+']);
    let Some(clock) = words.clone().find(|word| word.contains(':')) else { return number(words.next()?, mark) };
    let mut parts = clock.split(':').map(|part| number(&part.replace(',', "."), '.')).collect::<Option<Vec<_>>>()?;
    if cell.ends_with('M') {
        parts[0] = parts[0] % 12.0 + if cell.ends_with("PM") { 12.0 } else { 0.0 };
    }
    Some(parts.iter().zip([3600.0, 60.0, 1.0]).map(|(part, unit)| part * unit).sum())
}

/// The name in a cell of the header, and its unit: in brackets, or the last word after a blank or a mark if that is a unit.
fn name_and_unit(cell: &str) -> (&str, Option<&str>) {
    let marks = [' ', '/', ',', '_', ':', '-'];
    let mut brackets = cell.split(BRACKETS[0]);
    let name = brackets.next().unwrap_or_default().trim_matches(marks);
    let brackets: Vec<_> = brackets
        .map(|text| bare(text.split(BRACKETS[1]).next().unwrap_or_default()))
        .filter(|text| !["", "-"].contains(text))
        .collect();
    if cell.contains(BRACKETS[0]) && !name.is_empty() {
        return (name, brackets.iter().find(|text| unit(text).is_some()).or(brackets.first()).copied());
    }
    match cell.rsplit_once(marks).map(|(name, last)| (name.trim_matches(marks), last)) {
        Some((name, last)) if !name.is_empty() && unit(last).is_some() => {
            (name.strip_suffix(" in").unwrap_or(name), Some(last))
        }
        _ => (cell, None),
    }
}

fn name_of(cell: &str) -> &str {
    name_and_unit(cell).0
}

const BRACKETS: [[char; 4]; 2] = [['[', '(', '{', '<'], [']', ')', '}', '>']];

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
    fn named(&self, names: &[String]) -> Vec<usize> {
        let with = |name: &str| -> Vec<usize> {
            let is = |cell: &String| [cell, name_of(cell)].iter().any(|other| plain(other) == plain(name));
            (0..names.len()).filter(|i| is(&names[*i])).collect()
        };
        let defaults = self.names.iter().map(|name| with(name)).find(|found| !found.is_empty());
        self.selected.map_or_else(|| defaults.unwrap_or_default(), with)
    }

    /// Whether the column is selected, or its default name is in the header.
    fn is_in(&self, source: &Source) -> bool {
        self.is_required || self.selected.is_some() || !self.named(&source.names).is_empty()
    }

    fn default_name(&self) -> &'static str {
        self.names.first().copied().unwrap_or_default()
    }

    /// Index of the column, and the factor to its unit.
    fn find(&self, source: &Source) -> std::result::Result<(usize, f64), String> {
        let option = self.option;
        let name = self.selected.unwrap_or(self.default_name());
        let columns = match source.names.iter().map(|cell| name_of(cell)).collect::<Vec<_>>() {
            names if names.is_empty() => {
                let comma = if source.other_names.is_some() { of_comma(source.form.separator) } else { "" };
                let others = source.other_names.map(|(line, names)| format!("; line {line} has {names}{comma}"));
                format!("the {} columns have no names{}", source.count, others.unwrap_or_default())
            }
            names => format!("the columns are {}", names.join(", ")),
        };
        let number = self.selected.and_then(|selected| selected.parse::<usize>().ok());
        let index = match self.named(&source.names)[..] {
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
        let stated = in_row.or(in_name.filter(|text| cell.contains(BRACKETS[0]) || is_bare(text)));
        let found = stated.and_then(unit);
        if self.quantity == Quantity::Time {
            // No result depends on it.
            return Ok(1.0);
        }
        let target = self.units.in_si(self.quantity);
        match (stated, found, self.given) {
            (Some(text), None, None) => {
                let known = self.quantity.known();
                Err(format!("column {name} is in {text:?}, which is no unit of {known}; correct the header"))
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
