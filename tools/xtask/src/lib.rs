//! What is generated from the Rust source: the C header, blocks of the Fortran module, and the names that they declare.

mod fortran;
mod interface;
mod record;
mod tables;
mod wrappers;

use std::fs;
use std::path::Path;

use cbindgen::{Bindings, Builder, Config};

const HEADER: &str = "include/microslip.h";
const MODULE: &str = "include/microslip.f90";
const PYTHON: &str = "python/microslip/_constants.py";
const TEST_OF_FORTRAN: [&str; 2] = ["tests/fortran/procedures.f90", "tests/fortran/calls.f90"];
const CALLS_OF_RUST: &str = "tests/calls/table.rs";
const RECORD: &str = "c_tests/abi.h";
const CHANGELOG: &str = "CHANGELOG.md";
const INCLUDE_GUARD: &str = "MICROSLIP_H";

/// The directory of the library's package.
fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

/// The text that the header should have.
pub fn header() -> String {
    // In the source, brackets are escaped because they would be links.
    let text = text_of(&bindings()).replace("\\[", "[").replace("\\]", "]");
    // Excluded items have left blank lines.
    let mut lines: Vec<&str> = text.lines().collect();
    lines.dedup_by(|line, before| line.is_empty() && before.is_empty());
    lines.into_iter().map(|line| since(line) + line + "\n").collect()
}

/// The end of the comment of a function that this line declares: since which version it exists.
fn since(line: &str) -> String {
    let declared = line.split_once('(').filter(|_| line.starts_with(char::is_alphabetic));
    let name = declared.and_then(|(head, _)| head.rsplit([' ', '*']).next()).filter(|name| name.starts_with("mslip_"));
    name.map_or(String::new(), |name| format!("//\n// Since {}.\n", interface::since(name)))
}

/// The generated files, as paths in the repository, with the texts that they should have.
fn generated() -> Result<[(&'static str, String); 7], String> {
    let header = header();
    let python = fortran::python(&header);
    let items = interface::items(&header);
    let prototypes = interface::prototypes(&items)?;
    let module = fortran::fill(&read(MODULE)?, &items, &prototypes).map_err(|e| format!("{MODULE}: {e}"))?;
    let functions = interface::functions(&prototypes)?;
    let [procedures, calls] = wrappers::test(&functions);
    let (procedures, calls) = ((TEST_OF_FORTRAN[0], procedures), (TEST_OF_FORTRAN[1], calls));
    let rust = (CALLS_OF_RUST, tables::rust(&functions));
    let record = record::record(&header)?;
    record::is_compatible(&read(RECORD).unwrap_or_default(), &record, &read(CHANGELOG)?)?;
    Ok([(HEADER, header), (RECORD, record), (MODULE, module), (PYTHON, python), rust, procedures, calls])
}

/// Writes the header and the generated blocks of the Fortran module.
pub fn write_header() -> Result<(), String> {
    for (file, text) in generated()? {
        // A file that is not written keeps its time, and nothing is built again.
        if read(file).ok().as_ref() != Some(&text) {
            fs::write(root().join(file), text).map_err(|e| format!("{file}: {e}"))?;
        }
    }
    Ok(())
}

/// Compares the committed header and Fortran module with the source; the error is a message for a person.
pub fn check_header() -> Result<(), String> {
    let mut stale = Vec::new();
    for (file, text) in generated()? {
        let committed = read(file)?;
        if committed != text {
            let line = committed.lines().zip(text.lines()).take_while(|(old, new)| old == new).count() + 1;
            stale.push(format!("{file} is stale from line {line}: run `make header` and commit the result"));
        }
    }
    if stale.is_empty() { Ok(()) } else { Err(stale.join("\n")) }
}

fn read(file: &str) -> Result<String, String> {
    fs::read_to_string(root().join(file)).map_err(|e| format!("{file}: {e}"))
}

fn text_of(bindings: &Bindings) -> String {
    let mut text = Vec::new();
    bindings.write(&mut text);
    String::from_utf8(text).expect("cbindgen writes UTF-8")
}

fn bindings() -> Bindings {
    let mut config = Config::from_file(root().join("tools/xtask/cbindgen.toml")).expect("cbindgen.toml");
    config.include_guard = Some(INCLUDE_GUARD.to_owned());
    config.after_includes = Some(version_macros() + &status_codes());
    // cbindgen includes whatever is public and could be C: items of the interface carry its prefix. Excluding an item can
    // expose others that only it had covered.
    loop {
        let bindings = Builder::new().with_crate(root()).with_config(config.clone()).generate();
        let bindings = bindings.unwrap_or_else(|e| panic!("no header can be generated from the source: {e}"));
        let outsiders = outsiders(&bindings);
        if outsiders.is_empty() {
            return bindings;
        }
        // cbindgen excludes a constant TYPE_NAME of a type by NAMETYPE.
        let of_types =
            outsiders.iter().filter_map(|name| name.split_once('_')).map(|(kind, name)| name.to_owned() + kind);
        config.export.exclude.extend(of_types.chain(outsiders.iter().cloned()));
    }
}

/// The constants, types and functions without the prefix of the interface.
fn outsiders(bindings: &Bindings) -> Vec<String> {
    let text = text_of(bindings);
    let declared = ["#define ", "typedef struct ", "enum "].into_iter().flat_map(|start| {
        let rest = text.lines().filter_map(move |line| line.strip_prefix(start));
        rest.filter_map(|rest| rest.split_ascii_whitespace().next())
    });
    let functions = bindings.dynamic_symbols_names();
    let ours = |name: &str| name.to_ascii_lowercase().starts_with("mslip_") || name == INCLUDE_GUARD;
    declared.chain(functions).filter(|name| !ours(name)).map(str::to_owned).collect()
}

/// The package's version, as macros: this crate and the library share one version.
fn version_macros() -> String {
    let version = ["MAJOR", "MINOR", "PATCH"].into_iter().zip(env!("CARGO_PKG_VERSION").split('.'));
    let comment = "// Version of the library that this header belongs to";
    version
        .map(|(name, n)| format!("\n{comment}: {}.\n#define MSLIP_VERSION_{name} {n}", name.to_lowercase()))
        .collect()
}

/// The status codes, from the library's own table: the macro that defines them is not expanded by cbindgen.
fn status_codes() -> String {
    let code = |error: &microslip::Error| format!("\n\n// {error}\n#define {} {}", error.constant(), error.code());
    microslip::Error::ALL.iter().map(code).collect()
}
