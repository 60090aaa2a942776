//! The figures of the paper and of the guide computed by the library, and a check of each claim of the paper.
//!
//! - `paper` writes the data of the figures to `target/figures`, the tables of claims in `docs/paper.md`, and the tables of samples and of
//!   periods in `docs/guide.md`;
//! - `paper --check` compares the tables with what the library computes now.

mod cases;
mod claims;
mod documents;
mod drawings;
mod equations;
mod periods;
mod samples;
mod swing;
mod table;

use claims::Claim;
use documents::{Documents, between};
use std::process::ExitCode;

fn main() -> ExitCode {
    let Some(mut documents) = Documents::from_arguments() else {
        eprintln!("usage: paper [--check]");
        return ExitCode::from(2);
    };
    let claims = claims::all();
    for (figure, claims) in &claims {
        documents.results.extend(claims.iter().map(|(computed, stands)| {
            if *stands { Ok(()) } else { Err(format!("{figure}: the verdict is not true: {computed}")) }
        }));
    }
    drawings::all().iter().for_each(|table| documents.data(table));
    documents.page("paper.md", |old| with_claims(old, &claims));
    documents.page("guide.md", |old| between(old, "samples of elements", |_| Ok(samples::table())));
    documents.page("guide.md", |old| between(old, "periods of elements", |_| Ok(periods::table())));
    documents.report()
}

/// The page with the results of the claims in the third column of the tables between its markers.
fn with_claims(page: &str, tables: &[(&str, Vec<Claim>)]) -> Result<String, String> {
    tables.iter().try_fold(page.to_owned(), |page, (name, claims)| {
        between(&page, &format!("claims {name}"), |old| {
            let mut rows: Vec<String> = old.lines().map(str::to_owned).collect();
            if rows.len() != claims.len() + 2 {
                return Err(format!("docs/paper.md: not {} rows in {name}", claims.len()));
            }
            for (row, (computed, _)) in rows[2..].iter_mut().zip(claims) {
                let [place, claim, _, verdict] = row.split(" | ").collect::<Vec<_>>()[..] else {
                    return Err(format!("docs/paper.md: {row}: not four cells"));
                };
                *row = format!("{place} | {claim} | {computed} | {verdict}");
            }
            Ok(rows.join("\n") + "\n")
        })
    })
}
