//! The committed C header is the one that the source makes.

#[test]
fn the_committed_header_is_the_source_s() {
    if let Err(message) = xtask::check_header() {
        panic!("{message}");
    }
}

#[test]
fn the_header_holds_nothing_but_the_interface() {
    let header = std::fs::read_to_string(xtask::header_path()).expect("the header is there");
    let names = |start: &str| -> Vec<String> {
        let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let rest = header.lines().filter_map(|line| line.strip_prefix(start));
        rest.map(|rest| rest.chars().take_while(|&c| is_name(c)).collect()).collect()
    };
    let constants = names("#define ");
    assert!(constants.len() > 30);
    for name in constants {
        assert!(name.starts_with("MSLIP_") || name == "MICROSLIP_H", "{name} is no constant of the interface");
    }
    let structures = names("typedef struct ");
    assert!(structures.len() >= 4);
    for name in structures {
        assert!(name.starts_with("mslip_"), "{name} is no structure of the interface");
    }
    let functions = xtask::symbols();
    assert!(functions.len() > 20);
    for name in functions {
        assert!(header.contains(&format!("{name}(")), "{name} is not declared");
    }
}

/// A function without a word about it is not finished.
#[test]
fn every_function_is_documented() {
    let header = std::fs::read_to_string(xtask::header_path()).expect("the header is there");
    let lines: Vec<&str> = header.lines().collect();
    for name in xtask::symbols() {
        let declared = lines.iter().position(|line| line.contains(&format!("{name}(")) && !line.starts_with("//"));
        let declared = declared.unwrap_or_else(|| panic!("{name} is not declared"));
        assert!(lines[declared - 1].starts_with("//"), "{name} has no comment");
    }
}
