//! Imports only go down: the table of `docs/architecture.md` has the modules that each module of `src/` imports, all of them above
//! it there, and no files of a module import each other in a circle. Test modules are not read.

#[path = "common/sources.rs"]
mod sources;

use std::collections::{BTreeMap, BTreeSet};

/// Paths that start at `crate` or `super`, as paths from the crate: each name in braces is a path of its own.
fn paths(module: &str, text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (start, _) in text.match_indices("crate::").chain(text.match_indices("super::")) {
        if text[..start].ends_with("::") || text[..start].ends_with('$') {
            continue;
        }
        let path: String = text[start..].chars().take_while(|c| c.is_alphanumeric() || "_:".contains(*c)).collect();
        let names = text[start + path.len()..].strip_prefix('{').map_or("", |rest| rest.split(';').next().unwrap());
        let supers = path.matches("super::").count();
        let parents: Vec<_> = module.split("::").collect();
        let base =
            if supers > 0 { parents[..parents.len() - supers.min(parents.len())].join("::") } else { String::new() };
        let path = path.replace("crate::", "").replace("super::", "");
        for name in names.split(|c: char| !c.is_alphanumeric() && c != '_').chain([""]) {
            found.push([base.as_str(), path.trim_end_matches(':'), name].join("::"));
        }
    }
    found
}

/// The file that a path leads to.
fn file_of<'f>(path: &str, files: &'f BTreeMap<String, String>) -> Option<&'f String> {
    let names: Vec<_> = path.split("::").filter(|name| !name.is_empty()).collect();
    (1..=names.len()).rev().find_map(|n| files.get_key_value(&names[..n].join("::")).map(|(name, _)| name))
}

#[test]
fn imports_only_go_down() {
    let without_comments =
        |text: String| text.lines().map(|line| line.split("//").next().unwrap().to_owned() + "\n").collect();
    let module = |path: String| path.trim_end_matches(".rs").replace('/', "::");
    let files = sources::sources().into_iter().map(|(path, text)| (module(path), without_comments(text)));
    let files: BTreeMap<String, String> = files.filter(|(module, _)| module != "lib").collect();
    let mut imports: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (module, text) in &files {
        let used = paths(module, text).into_iter().filter_map(|path| file_of(&path, &files));
        imports.insert(module, used.map(String::as_str).filter(|used| used != module).collect());
    }
    // The table: rows `| module | imports |` of module names in backticks, here with what the source imports.
    let document = sources::read("docs/architecture.md");
    let top = |module: &str| module.split("::").next().unwrap().to_owned();
    let mut found: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for (module, used) in &imports {
        let own = top(module);
        found.entry(own.clone()).or_default().extend(used.iter().map(|used| top(used)).filter(|used| *used != own));
    }
    let names = |cell: &str| cell.split('`').skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>();
    let mut above = BTreeSet::new();
    let table = document.lines().skip_while(|line| !line.starts_with("| module | imports |")).skip(2);
    for row in table.take_while(|line| line.starts_with('|')) {
        let modules = names(row.split('|').nth(1).unwrap());
        for module in &modules {
            let used = found.remove(module).unwrap_or_default();
            assert!(used.is_subset(&above), "{module} imports modules below it in the table: {used:?}");
            let used: Vec<_> = used.iter().map(|used| format!("`{used}`")).collect();
            let own: Vec<_> = modules.iter().map(|module| format!("`{module}`")).collect();
            let right = format!("| {} | {} |", own.join(", "), used.join(", ")).replace("|  |", "| |");
            assert!(row == right, "docs/architecture.md: write\n{right}\ninstead of\n{row}");
        }
        above.extend(modules);
    }
    assert!(found.is_empty(), "not in the table of docs/architecture.md: {found:?}");
    assert!(imports.values().map(BTreeSet::len).sum::<usize>() > 200, "the imports were not found");
    // No circles: files without imports that are left, one after the other.
    while let Some(leaf) = imports.iter().find(|(_, used)| used.is_empty()).map(|(module, _)| *module) {
        imports.remove(leaf);
        imports.values_mut().for_each(|used| used.retain(|name| *name != leaf));
    }
    assert!(imports.is_empty(), "imports in a circle: {:?}", imports.keys());
}
