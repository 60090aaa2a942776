//! Data and tables of the documents in `docs/`: written, or with `--check` compared with what the library computes now.

use crate::table::Table;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// The documents of a program, and the results of its checks.
pub struct Documents {
    check: bool,
    results: Vec<Result<(), String>>,
}

impl Documents {
    /// By the arguments of the program; `None` if they are wrong.
    pub fn from_arguments() -> Option<Documents> {
        let arguments: Vec<String> = std::env::args().skip(1).collect();
        let check = arguments == ["--check"];
        (check || arguments.is_empty()).then(|| Documents { check, results: Vec::new() })
    }

    /// The data of a figure, from which `draw.sh` draws it: written only, the checks are of the claims.
    pub fn data(&mut self, table: &Table) {
        if !self.check {
            let directory = place("../target/figures");
            let path = directory.join(table.name).with_extension("csv");
            let made = fs::create_dir_all(directory).map_err(|error| format!("target/figures: {error}"));
            self.results.push(made.and_then(|()| write(&path, &table.csv())));
        }
    }

    /// A page with new tables.
    pub fn page(&mut self, name: &str, with_tables: impl FnOnce(&str) -> Result<String, String>) {
        let path = place(name);
        self.results.push(read(&path).and_then(|old| match with_tables(&old)? {
            new if !self.check => write(&path, &new),
            new if new == old => Ok(()),
            _ => Err(format!("docs/{name} is stale: run `make figures`")),
        }));
    }

    /// A table of a page, between the markers of a name.
    pub fn table(&mut self, page: &str, name: &str, table: &str) {
        let (begin, end) = (format!("<!-- {name}: begin -->\n"), format!("<!-- {name}: end -->"));
        self.page(page, |old| {
            let parts = old.split_once(&begin).and_then(|(before, rest)| Some((before, rest.split_once(&end)?.1)));
            let (before, after) = parts.ok_or(format!("docs/{page}: no {}…{end}", begin.trim_end()))?;
            Ok(format!("{before}{begin}{table}{end}{after}"))
        });
    }

    /// A check, with the message if it fails.
    pub fn check(&mut self, holds: bool, message: String) {
        self.results.push(if holds { Ok(()) } else { Err(message) });
    }

    /// Prints the failures and the counts.
    pub fn report(self) -> ExitCode {
        let failures: Vec<&String> = self.results.iter().filter_map(|result| result.as_ref().err()).collect();
        failures.iter().for_each(|message| println!("{message}"));
        println!("{} passed, {} failed", self.results.len() - failures.len(), failures.len());
        if failures.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
    }
}

fn place(name: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs")).join(name)
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}
