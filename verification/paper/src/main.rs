//! The figures of the paper computed by the library, and a check of each of its claims.
//!
//! - `paper` writes `docs/figures/data/*.csv` and the tables of claims in `docs/paper.md`;
//! - `paper --check` compares both with what the library computes now.

mod cases;
mod claims;
mod drawings;
mod equations;
mod table;

use claims::Claim;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

fn docs() -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs")).to_path_buf()
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let check = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => false,
        ["--check"] => true,
        _ => {
            eprintln!("usage: paper [--check]");
            return ExitCode::from(2);
        }
    };
    let claims = claims::all();
    let mut results: Vec<Result<(), String>> = claims.iter().map(verdict).collect();
    results.extend(if check { compare(&claims) } else { write(&claims) });
    let failures: Vec<&String> = results.iter().filter_map(|result| result.as_ref().err()).collect();
    failures.iter().for_each(|message| println!("{message}"));
    println!("{} passed, {} failed", results.len() - failures.len(), failures.len());
    if failures.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn verdict(claim: &Claim) -> Result<(), String> {
    if claim.stands { Ok(()) } else { Err(format!("{}: the verdict is not true: {}", claim.figure, claim.computed)) }
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

fn write_file(path: &Path, text: &str) -> Result<(), String> {
    fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}

fn write(claims: &[Claim]) -> Vec<Result<(), String>> {
    let data = docs().join("figures/data");
    let tables =
        drawings::all().into_iter().map(|table| write_file(&data.join(table.name).with_extension("csv"), &table.csv()));
    let page = docs().join("paper.md");
    let inserted = read(&page).and_then(|text| with_claims(&text, claims)).and_then(|text| write_file(&page, &text));
    tables.chain([inserted]).collect()
}

fn compare(claims: &[Claim]) -> Vec<Result<(), String>> {
    let data = docs().join("figures/data");
    let tables = drawings::all()
        .into_iter()
        .map(|table| read(&data.join(table.name).with_extension("csv")).and_then(|file| table.check(&file)));
    let stale = |text: String| {
        let fresh = with_claims(&text, claims)?;
        if text == fresh { Ok(()) } else { Err("docs/paper.md is stale: run `make figures`".to_owned()) }
    };
    tables.chain([read(&docs().join("paper.md")).and_then(stale)]).collect()
}

/// The page with the results of the claims in the third column of the tables between its markers.
fn with_claims(page: &str, claims: &[Claim]) -> Result<String, String> {
    let mut text = String::new();
    let mut left = page;
    for table in claims.chunk_by(|one, next| one.figure == next.figure) {
        let name = table[0].figure;
        let (begin, end) = (format!("<!-- claims {name}: begin -->\n"), format!("<!-- claims {name}: end -->"));
        let marked = left.split_once(&begin).and_then(|(before, rest)| Some((before, rest.split_once(&end)?)));
        let (before, (rows, after)) = marked.ok_or(format!("docs/paper.md: no {}…{end}", begin.trim_end()))?;
        text += &format!("{before}{begin}");
        let mut claims = table.iter();
        for (i, row) in rows.lines().enumerate() {
            let cells: Vec<&str> = row.split(" | ").collect();
            match (&cells[..], i) {
                (_, 0 | 1) => text += &format!("{row}\n"),
                ([place, claim, _, verdict], _) => {
                    let claim_of_row = claims.next().ok_or(format!("docs/paper.md: too many rows in {name}"))?;
                    text += &format!("{place} | {claim} | {} | {verdict}\n", claim_of_row.computed);
                }
                _ => return Err(format!("docs/paper.md: {row}: not four cells")),
            }
        }
        if claims.next().is_some() {
            return Err(format!("docs/paper.md: too few rows in {name}"));
        }
        text += &end;
        left = after;
    }
    Ok(text + left)
}
