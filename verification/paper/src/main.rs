//! The figures of the paper, computed through the library, and what the paper claims, checked.
//!
//! - `figures` writes `docs/figures/data/*.csv` and the table of claims in `docs/paper.md`;
//! - `figures --check` computes all the same, and compares with what is there; the last line has the counts.

mod cases;
mod claims;
mod drawings;
mod equations;
mod table;

use claims::Claim;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

fn begin(figure: &str) -> String {
    format!("<!-- claims {figure}: begin -->\n")
}

fn end(figure: &str) -> String {
    format!("<!-- claims {figure}: end -->")
}

fn docs() -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs")).to_path_buf()
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let check = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => false,
        ["--check"] => true,
        _ => {
            eprintln!("usage: figures [--check]");
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
    let Claim { place, claim, computed, verdict, stands, .. } = claim;
    if *stands { Ok(()) } else { Err(format!("{place}: {claim}: not “{verdict}”: {computed}")) }
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
    tables.chain([read(&docs().join("paper.md")).and_then(stale)]).chain(pictures()).collect()
}

/// Every picture of the page is there, and every picture that is there is on the page.
fn pictures() -> Vec<Result<(), String>> {
    let page = read(&docs().join("paper.md")).unwrap_or_default();
    let Ok(files) = fs::read_dir(docs().join("figures")) else {
        return vec![Err("docs/figures: no such directory".to_owned())];
    };
    let mut names: Vec<String> = files.filter_map(|file| file.ok()?.file_name().into_string().ok()).collect();
    names.sort();
    let drawn = names.iter().filter(|name| name.ends_with(".svg")).map(|name| {
        let png = name.replace(".svg", ".png");
        match (page.contains(&format!("(figures/{name})")), names.contains(&png)) {
            (true, true) => Ok(()),
            (false, _) => Err(format!("docs/paper.md does not show {name}")),
            (_, false) => Err(format!("docs/figures: no {png}")),
        }
    });
    let shown = page.match_indices("(figures/").map(|(place, start)| {
        let name = page[place + start.len()..].split(')').next().unwrap_or_default();
        if names.iter().any(|file| file == name) {
            Ok(())
        } else {
            Err(format!("docs/paper.md shows {name}, which is not there"))
        }
    });
    drawn.chain(shown).collect()
}

/// The page with the claims between the markers of their figures.
fn with_claims(page: &str, claims: &[Claim]) -> Result<String, String> {
    let mut text = page.to_owned();
    for table in claims.chunk_by(|one, next| one.figure == next.figure) {
        let (begin, end) = (begin(table[0].figure), end(table[0].figure));
        let marked = text.split_once(&begin).and_then(|(before, rest)| Some((before, rest.split_once(&end)?.1)));
        let (before, after) = marked.ok_or(format!("docs/paper.md: no {}…{end}", begin.trim_end()))?;
        let row = |Claim { place, claim, computed, verdict, .. }: &Claim| {
            format!("| {place} | {claim} | {computed} | {verdict} |\n")
        };
        let rows: String = table.iter().map(row).collect();
        text = format!("{before}{begin}| where | claim | computed | verdict |\n|---|---|---|---|\n{rows}{end}{after}");
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_table_stands_between_its_markers_and_a_page_without_them_is_refused() {
        let claim = |figure, claim| Claim {
            figure,
            place: "1",
            claim,
            computed: "2".to_owned(),
            verdict: "holds",
            stands: true,
        };
        let claims = [claim("x", "c"), claim("x", "d"), claim("y", "e")];
        let page = format!("a\n{}old\n{}\nm\n{}{}\nz\n", begin("x"), end("x"), begin("y"), end("y"));
        let filled = with_claims(&page, &claims).unwrap();
        let head = "| where | claim | computed | verdict |\n|---|---|---|---|\n";
        let table = |figure, rows: &str| begin(figure) + head + rows + &end(figure);
        let (x, y) = ("| 1 | c | 2 | holds |\n| 1 | d | 2 | holds |\n", "| 1 | e | 2 | holds |\n");
        assert_eq!(filled, format!("a\n{}\nm\n{}\nz\n", table("x", x), table("y", y)));
        assert_eq!(with_claims(&filled, &claims).unwrap(), filled);
        assert!(with_claims("a", &claims).is_err());
    }
}
