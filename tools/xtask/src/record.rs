//! The record of the binary interface: constants, layouts, functions and lengths, as macros that a C compiler checks.

use std::collections::HashMap;
use std::fmt::Write;

use microslip::ffi;

use crate::interface::{declarations, items};
use crate::tables::wrapped;

const HEAD: &str = "\
/* The binary interface: programs that were linked with one library of this MSLIP_ABI_VERSION run with each other one. Written by
   `make header`, which may change this file until CHANGELOG.md has a release with the version, and only add to it afterwards.

   Numbers in STRUCTURE and FIELD are bytes, those in LENGTH doubles. The includer defines the macros. */
";

/// The record of the interface that the header declares.
pub fn record(header: &str) -> Result<String, String> {
    Ok([HEAD.to_owned(), constants(header), structures(header)?, functions(header)?, lengths()].join("\n"))
}

fn constants(header: &str) -> String {
    let defined = header.lines().filter_map(|line| line.strip_prefix("#define MSLIP_")?.split_once(' '));
    let constants = defined.filter(|(name, _)| !name.starts_with("VERSION_"));
    constants.map(|(name, value)| format!("CONSTANT(MSLIP_{name}, {value})\n")).collect()
}

/// The layouts by the rules of C on all platforms of the library: a type is aligned to its largest component.
fn structures(header: &str) -> Result<String, String> {
    let mut text = String::new();
    let mut types = HashMap::from([("double", (8, 8)), ("int32_t", (4, 4))]);
    for structure in header.split("typedef struct ").skip(1) {
        let (name, body) = structure.split_once(" {").ok_or("a structure without a name")?;
        let body = body.split_once('}').ok_or(format!("{name} has no end"))?.0;
        let (mut fields, mut end, mut largest) = (String::new(), 0_usize, 1);
        for line in body.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with("//")) {
            let declaration = line.trim_end_matches(';').trim_start_matches("struct ");
            let (kind, field) = declaration.split_once(' ').ok_or(format!("{name}: no field: {line}"))?;
            let (field, count) = field.trim_end_matches(']').split_once('[').unwrap_or((field, "1"));
            let number: usize = count.parse().map_err(|e| format!("{name}: {line}: {e}"))?;
            let (size, alignment) = *types.get(kind).ok_or(format!("{name}: {line}: unknown type"))?;
            let place = end.next_multiple_of(alignment);
            let _ = writeln!(fields, "FIELD({name}, {field}, {place}, {kind}, {count})");
            (end, largest) = (place + number * size, largest.max(alignment));
        }
        let size = end.next_multiple_of(largest);
        types.insert(name, (size, largest));
        let _ = write!(text, "STRUCTURE({name}, {size})\n{fields}");
    }
    Ok(text)
}

fn functions(header: &str) -> Result<String, String> {
    let mut text = String::new();
    for (head, arguments, _) in declarations(&items(header)) {
        let (result, name) = head.split_at(head.rfind([' ', '*']).ok_or(format!("no result: {head}"))? + 1);
        text += &wrapped(&format!("FUNCTION({}, {name}, ({arguments}))", result.trim()));
    }
    Ok(text)
}

/// Lengths of states and workspaces.
fn lengths() -> String {
    const SIZES: [usize; 2] = [0, 16];
    let mut text = String::new();
    let mut add = |call: &str, length: usize| {
        let _ = writeln!(text, "LENGTH(mslip_{call}, {length})");
    };
    for n in SIZES {
        add(&format!("state_length({n})"), ffi::mslip_state_length(n));
    }
    for rule in ["MSLIP_UNIFORM_SAMPLING", "MSLIP_EVENT_DRIVEN"] {
        let value = if rule == "MSLIP_EVENT_DRIVEN" { ffi::MSLIP_EVENT_DRIVEN } else { ffi::MSLIP_UNIFORM_SAMPLING };
        let length = ffi::mslip_harmonic_workspace_length(5, 128, value);
        add(&format!("harmonic_workspace_length(5, 128, {rule})"), length);
    }
    for directions in [1, 2] {
        for n in SIZES {
            let length = ffi::mslip_element_state_length(directions, n);
            add(&format!("element_state_length({directions}, {n})"), length);
        }
        let length = ffi::mslip_element_workspace_length(directions, 5, 128, ffi::MSLIP_UNIFORM_SAMPLING);
        add(&format!("element_workspace_length({directions}, 5, 128, MSLIP_UNIFORM_SAMPLING)"), length);
    }
    text
}

/// The entries of a record, each on one line.
fn entries(record: &str) -> Vec<String> {
    let mut entries: Vec<String> = Vec::new();
    for line in record.lines().skip_while(|line| !line.starts_with("CONSTANT")) {
        match entries.last_mut() {
            Some(last) if line.starts_with(' ') => *last = format!("{last} {}", line.trim()),
            _ => entries.push(line.to_owned()),
        }
    }
    entries
}

/// An error if an entry of a released version is gone.
pub fn is_compatible(old: &str, new: &str, changelog: &str) -> Result<(), String> {
    let (old, new) = (entries(old), entries(new));
    let Some(version) = old.iter().find_map(|entry| entry.strip_prefix("CONSTANT(MSLIP_ABI_VERSION, ")) else {
        return Ok(());
    };
    let version = version.trim_end_matches(')');
    let released = changelog.split("\n## ").skip(1).any(|section| {
        let heading = section.lines().next().unwrap_or_default();
        !heading.ends_with("unreleased") && section.contains(&format!("\nInterface {version} "))
    });
    let raised = old.iter().all(|entry| !entry.starts_with("CONSTANT(MSLIP_ABI_VERSION,") || !new.contains(entry));
    match old.iter().find(|entry| !new.contains(entry)) {
        Some(gone) if released && !raised => {
            Err(format!("{gone} is part of the released interface {version}: keep it, or raise MSLIP_ABI_VERSION"))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "
#define MSLIP_OK 0
#define MSLIP_ABI_VERSION 7

typedef struct mslip_pair {
    double value[3];
} mslip_pair;

extern \"C\" {

const char *mslip_name(void);
";

    /// Entries may be added; changed or removed ones need a new version once theirs is released.
    #[test]
    fn a_released_interface_is_kept() {
        let old = record(HEADER).unwrap();
        let (released, unreleased) = ("\n## [1.0] - 2026\n\nInterface 7 (", "\n## [1.0] - unreleased\n\nInterface 7 (");
        for (from, to, compatible) in [
            ("mslip_name(void)", "mslip_name(void);\nint32_t mslip_more(void)", true),
            ("mslip_name(void)", "mslip_name(int32_t which)", false),
            ("value[3]", "value[4]", false),
            ("MSLIP_OK 0", "MSLIP_OK 1", false),
            ("VERSION 7", "VERSION 8", true),
        ] {
            let new = record(&HEADER.replacen(from, to, 1)).unwrap();
            assert_eq!(is_compatible(&old, &new, released).is_ok(), compatible, "{to}");
            assert!(is_compatible(&old, &new, unreleased).is_ok(), "{to}");
        }
    }
}
