//! Letters in the formulas of comments against the table of symbols of docs/derivation.md: one letter is one quantity in a module.

#[path = "common/sources.rs"]
mod sources;

use std::collections::BTreeMap;

/// Symbols with the modules in which they may stand, as paths below `src`; "" is every module.
type Table = BTreeMap<String, Vec<String>>;

/// The table of symbols: `| symbols | modules | meaning | origin |`.
fn table(page: &str) -> Table {
    let rows = page.lines().skip_while(|line| !line.starts_with("| symbol | modules |")).skip(2);
    let mut table = Table::new();
    for row in rows.take_while(|line| line.starts_with('|')) {
        let mut cells = row.split(" | ").map(|cell| cell.trim_matches(['|', ' ']));
        let (symbols, modules) = (cells.next().unwrap(), cells.next().unwrap());
        let modules = modules.split(", ").filter(|module| *module != "none");
        let modules = modules.map(|module| if module == "all" { "" } else { module.trim_matches('`') });
        let modules: Vec<String> = modules.map(str::to_owned).collect();
        for symbol in symbols.split([',', ';']) {
            table.entry(symbol.trim().to_owned()).or_default().extend(modules.clone());
        }
    }
    table
}

fn is_greek(letter: char) -> bool {
    ('α'..='ω').contains(&letter) || ('Α'..='Ω').contains(&letter)
}

/// The symbols of a formula: an index belongs to one only if the table has it; words, and functions of two letters, are none.
fn symbols(formula: &str, table: &Table) -> Vec<String> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || is_greek(c) || "_∂∫".contains(c);
    let tokens = formula.split(|c| !is_part(c)).map(|token| token.trim_start_matches(|c: char| c.is_ascii_digit()));
    let mut found = Vec::new();
    for token in tokens.filter(|token| !token.is_empty()) {
        let base = token.split('_').next().unwrap().trim_end_matches(|c: char| c.is_ascii_digit());
        let letters: Vec<char> = base.chars().collect();
        match letters[..] {
            _ if table.contains_key(token) => found.push(token.to_owned()),
            ['d' | 'δ' | 'Δ' | 'Σ' | '∂', letter] if base != "dw" => found.push(letter.to_string()),
            [_, _, ..] if base.is_ascii() => {}
            _ => found.extend(letters.iter().map(char::to_string)),
        }
    }
    found
}

/// The formulas of a line of a comment: all of it in a block, but for words; otherwise code, but for names, and Greek letters in
/// the text.
fn formulas(line: &str, in_block: bool) -> Vec<String> {
    if in_block {
        let is_word = |word: &&str| {
            word.len() > 1 && word.trim_end_matches([',', ';', '.', ':']).chars().all(|c| c.is_ascii_alphabetic())
        };
        return line.split(' ').filter(|word| !is_word(word)).map(str::to_owned).collect();
    }
    let mut found = Vec::new();
    let parts: Vec<&str> = line.split('`').collect();
    for (i, part) in parts.iter().enumerate() {
        let is_code = i % 2 == 1;
        if !is_code {
            found.extend(part.chars().filter(|c| is_greek(*c)).map(|c| c.to_string()));
            continue;
        }
        let name = part.trim_start_matches(|c: char| c.is_ascii_lowercase() || c == '_');
        let is_name = part.len() - name.len() > 2 && (name.is_empty() || name.starts_with('('));
        let is_formula = part.chars().count() < 3 || part.contains(|c| "=^²³+*/∫ΣΔ()|<>≤≥_-".contains(c));
        if is_formula && !is_name && !part.contains("::") && !parts[i - 1].ends_with('[') {
            found.push((*part).to_owned());
        }
    }
    found
}

/// The symbols of a file that the table does not have in its module.
fn disagreements(file: &str, text: &str, table: &Table) -> Vec<String> {
    let (mut found, mut in_block) = (Vec::new(), false);
    for (number, line) in text.lines().enumerate() {
        let line = line.trim_start();
        let Some(comment) = ["//!", "///", "// "].iter().find_map(|mark| line.strip_prefix(mark)) else {
            in_block = false;
            continue;
        };
        if let Some(kind) = comment.trim_start().strip_prefix("```") {
            in_block = kind == "text";
            continue;
        }
        for symbol in formulas(comment, in_block).iter().flat_map(|formula| symbols(formula, table)) {
            let modules = table.get(&symbol);
            if !modules.is_some_and(|modules| modules.iter().any(|module| file.starts_with(module.as_str()))) {
                found.push(format!("{file}:{}: {symbol}: {}", number + 1, comment.trim()));
            }
        }
    }
    found
}

#[test]
fn a_letter_is_one_quantity_in_a_module() {
    let table = table(&sources::read("docs/derivation.md"));
    assert!(table.len() > 60, "{table:?}");
    let found: Vec<_> = sources::sources().iter().flat_map(|(file, text)| disagreements(file, text, &table)).collect();
    assert!(found.is_empty(), "not in the table of docs/derivation.md, or not in these modules:\n{}", found.join("\n"));
}
