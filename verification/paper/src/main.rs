//! The figures of the paper and of the guide computed by the library, and a check of each claim of the paper.
//!
//! - `paper` writes the data of the figures to `target/figures`, the claims in `docs/claims.csv`, the tables of samples and of
//!   periods in `docs/guide.md`, and that of the roundings of the work in `docs/accuracy.md`;
//! - `paper --check` compares the tables with what the library computes now.

mod cases;
mod claims;
mod documents;
mod drawings;
mod equations;
#[path = "../../../tests/common/one_direction.rs"]
mod path;
mod periods;
mod samples;
mod swing;
mod table;

use claims::Claim;
use documents::Documents;
use std::process::ExitCode;

fn main() -> ExitCode {
    let Some(mut documents) = Documents::from_arguments() else {
        eprintln!("usage: paper [--check]");
        return ExitCode::from(2);
    };
    let claims = claims::all();
    for (figure, claims) in &claims {
        for (computed, stands) in claims {
            documents.check(*stands, format!("{figure}: the verdict is not true: {computed}"));
        }
    }
    drawings::all().iter().for_each(|table| documents.data(table));
    documents.page("claims.csv", |old| with_claims(old, &claims));
    documents.table("guide.md", "samples of elements", &samples::table());
    documents.table("accuracy.md", "roundings of the work", &samples::roundings());
    documents.table("guide.md", "periods of elements", &periods::table());
    documents.report()
}

/// The file with the results of the claims in its fourth column.
fn with_claims(file: &str, tables: &[(&str, Vec<Claim>)]) -> Result<String, String> {
    let claims = tables.iter().flat_map(|(figure, claims)| claims.iter().map(move |claim| (figure, claim)));
    let (head, rows) = file.split_once('\n').ok_or("docs/claims.csv: empty")?;
    let mut text = head.to_owned() + "\n";
    if rows.lines().count() != tables.iter().map(|(_, claims)| claims.len()).sum::<usize>() {
        return Err("docs/claims.csv: another number of claims".to_owned());
    }
    for (row, (figure, (computed, _))) in rows.lines().zip(claims) {
        let [place, claim, _, verdict] = row.split("\",\"").collect::<Vec<_>>()[..] else {
            return Err(format!("docs/claims.csv: {row}: not five cells"));
        };
        if !place.starts_with(&format!("{figure},")) {
            return Err(format!("docs/claims.csv: {row}: not a claim of {figure}"));
        }
        text += &format!("{place}\",\"{claim}\",\"{computed}\",\"{verdict}\n");
    }
    Ok(text)
}
