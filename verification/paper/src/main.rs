//! The figures of the paper and of the guide computed by the library, and a check of each claim of the paper.
//!
//! - `paper` writes `docs/figures/data/*.csv`, the tables of claims in `docs/paper.md` and the table of samples in `docs/guide.md`;
//! - `paper --check` compares them with what the library computes now.

mod cases;
mod claims;
mod drawings;
mod equations;
mod periods;
mod samples;
mod swing;
mod table;

use claims::Claim;
use std::fs;
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let check = match std::env::args().skip(1).collect::<Vec<_>>()[..] {
        [] => false,
        [ref option] if option == "--check" => true,
        _ => {
            eprintln!("usage: paper [--check]");
            return ExitCode::from(2);
        }
    };
    let claims = claims::all();
    let docs = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs"));
    let mut results = Vec::new();
    for (figure, (computed, stands)) in
        claims.iter().flat_map(|(figure, claims)| claims.iter().map(move |c| (figure, c)))
    {
        results.push(if *stands { Ok(()) } else { Err(format!("{figure}: the verdict is not true: {computed}")) });
    }
    for table in drawings::all() {
        let path = docs.join("figures/data").join(table.name).with_extension("csv");
        results.push(if check { read(&path).and_then(|file| table.check(&file)) } else { write(&path, &table.csv()) });
    }
    let mut update = |page: &str, with: &dyn Fn(&str) -> Result<String, String>| {
        let path = docs.join(page);
        results.push(read(&path).and_then(|old| match with(&old)? {
            new if !check => write(&path, &new),
            new if new == old => Ok(()),
            _ => Err(format!("docs/{page} is stale: run `make figures`")),
        }));
    };
    update("paper.md", &|old| with_claims(old, &claims));
    update("guide.md", &|old| {
        let (before, _, after) = marked(old, "samples of elements")?;
        Ok(format!("{before}{}{after}", samples::table()))
    });
    let failures: Vec<&String> = results.iter().filter_map(|result| result.as_ref().err()).collect();
    failures.iter().for_each(|message| println!("{message}"));
    println!("{} passed, {} failed", results.len() - failures.len(), failures.len());
    if failures.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}

/// A page up to and with the marker of the beginning, what is between the markers of a name, and the rest.
fn marked<'a>(page: &'a str, name: &str) -> Result<(&'a str, &'a str, &'a str), String> {
    let (begin, end) = (format!("<!-- {name}: begin -->\n"), format!("<!-- {name}: end -->"));
    let places = page.find(&begin).map(|at| at + begin.len()).zip(page.find(&end));
    let (from, to) = places.ok_or(format!("no {}…{end}", begin.trim_end()))?;
    let (before, rest) = page.split_at(from);
    let (rows, after) = rest.split_at_checked(to - from).ok_or(format!("{end} is before its beginning"))?;
    Ok((before, rows, after))
}

/// The page with the results of the claims in the third column of the tables between its markers.
fn with_claims(page: &str, tables: &[(&str, Vec<Claim>)]) -> Result<String, String> {
    let mut text = page.to_owned();
    for (name, claims) in tables {
        let (before, rows, after) = marked(&text, &format!("claims {name}"))?;
        let mut rows: Vec<String> = rows.lines().map(str::to_owned).collect();
        if rows.len() != claims.len() + 2 {
            return Err(format!("docs/paper.md: not {} rows in {name}", claims.len()));
        }
        for (row, (computed, _)) in rows[2..].iter_mut().zip(claims) {
            let [place, claim, _, verdict] = row.split(" | ").collect::<Vec<_>>()[..] else {
                return Err(format!("docs/paper.md: {row}: not four cells"));
            };
            *row = format!("{place} | {claim} | {computed} | {verdict}");
        }
        text = format!("{before}{}\n{after}", rows.join("\n"));
    }
    Ok(text)
}
