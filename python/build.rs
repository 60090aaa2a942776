//! Writes the declarations of `microslip.h`, and those of the package, to `header.h` in the target directory, from which maturin
//! makes the Python bindings.

use std::path::PathBuf;
use std::{env, fs};

/// The functions of `src/lib.rs`.
const OWN: &str = "
int32_t microslip_python_fit(const char *problem, char **answer);
void microslip_python_free(char *text);
";

const HEADER: &str = "../include/microslip.h";

fn main() {
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("set by cargo"));
    let build = out.ancestors().find(|path| path.ends_with("build")).expect("OUT_DIR is below build/");
    let target = build.ancestors().nth(2).expect("build/ is in the directory of a profile");
    // With the option --target the profile is in the directory of the platform.
    let platform = env::var("TARGET").expect("set by cargo");
    let target = target.parent().filter(|_| target.ends_with(platform)).unwrap_or(target);
    let header = target.join("header.h");
    let text = declarations(&fs::read_to_string(HEADER).expect("include/microslip.h is beside python/")) + OWN;
    // Written only if it differs: a newer file causes another build.
    if fs::read_to_string(&header).ok().as_ref() != Some(&text) {
        fs::write(&header, text).expect("the target directory can be written");
    }
    println!("cargo::rerun-if-changed={HEADER}");
    println!("cargo::rerun-if-changed={}", header.display());
}

/// The header without what only a C compiler understands: inclusion guards, includes and the brackets of C++.
fn declarations(header: &str) -> String {
    let mut cplusplus = false;
    let mut kept = |line: &&str| {
        let bracket = cplusplus;
        cplusplus = (cplusplus || line.starts_with("#ifdef __cplusplus")) && !line.starts_with("#endif");
        let constant = line.starts_with("#define") && line.split_whitespace().count() == 3;
        !bracket && (constant || !line.starts_with('#'))
    };
    header.lines().filter(|line| kept(line)).flat_map(|line| [line, "\n"]).collect()
}
