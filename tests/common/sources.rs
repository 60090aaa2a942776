//! The source of the library, for tests of its structure.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// A file of the repository.
pub fn read(path: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

/// The files of `src` by their paths there, without their test modules, which are the last items.
pub fn sources() -> BTreeMap<String, String> {
    let mut files = BTreeMap::new();
    add("src", &mut files);
    files
}

fn add(folder: &str, files: &mut BTreeMap<String, String>) {
    for entry in fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)).unwrap() {
        let entry = entry.unwrap();
        let path = format!("{folder}/{}", entry.file_name().to_str().unwrap());
        if entry.path().is_dir() {
            add(&path, files);
        } else if entry.file_name() != "tests.rs" {
            let text = read(&path);
            let (code, tests) = text.split_once("#[cfg(test)]\n").unwrap_or((&text, ""));
            let items = tests.lines().filter(|line| line.starts_with(|c: char| c.is_alphabetic())).count();
            assert!(items == usize::from(!tests.is_empty()), "{path}: the test module is not the last item");
            files.insert(path["src/".len()..].to_owned(), code.to_owned());
        }
    }
}
