//! The C drivers against the archive as cargo builds it.
//!
//! `cargo test` leaves no archive of its own, so one is built here, apart from the build that runs the tests.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Where the archive and the drivers are built.
fn build_directory() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("c_drivers")
}

fn run(command: &mut Command) -> String {
    let program = command.get_program().to_string_lossy().into_owned();
    let output = command.output().unwrap_or_else(|error| panic!("{program}: {error}"));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{program} failed\n{text}{}", String::from_utf8_lossy(&output.stderr));
    text
}

/// The archive, and what it is to be linked with.
fn archive() -> &'static (PathBuf, Vec<String>) {
    static ARCHIVE: OnceLock<(PathBuf, Vec<String>)> = OnceLock::new();
    ARCHIVE.get_or_init(|| {
        let mut cargo = Command::new(env!("CARGO"));
        cargo.current_dir(root()).args(["rustc", "--release", "--locked", "--lib", "--crate-type", "staticlib"]);
        cargo.arg("--target-dir").arg(build_directory()).args(["--", "--print", "native-static-libs"]);
        let output = cargo.output().expect("cargo runs");
        let messages = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{messages}");
        let libraries = messages.lines().find_map(|line| line.split_once("native-static-libs: "));
        let libraries = libraries.map_or(Vec::new(), |(_, names)| names.split(' ').map(str::to_owned).collect());
        (build_directory().join("release/libmicroslip.a"), libraries)
    })
}

/// Builds and runs a driver, and once more with floating-point traps.
fn drive(name: &str) {
    let (archive, libraries) = archive();
    let program = build_directory().join(name);
    let triple = run(Command::new("rustc").arg("-vV"));
    let triple = triple.lines().find_map(|line| line.strip_prefix("host: ")).expect("rustc names its host");
    let compiler = cc::Build::new().target(triple).host(triple).opt_level(1).cargo_metadata(false).get_compiler();
    let mut build = compiler.to_command();
    build.args(["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]).arg("-I").arg(root().join("include"));
    build.arg(root().join("c_tests").join(name).with_extension("c")).arg(archive).args(libraries).arg("-lm");
    if std::env::var_os("LLVM_PROFILE_FILE").is_some() {
        // Counters of coverage in the archive are written at the end by what this name brings along.
        build.arg("-Wl,-u,__llvm_profile_runtime");
    }
    run(build.arg("-o").arg(&program));
    for arguments in [&[][..], &["--trap"]] {
        let text = run(Command::new(&program).args(arguments).current_dir(root()));
        let last = text.lines().last().unwrap_or_default();
        assert!(last.ends_with(" passed, 0 failed") && !last.starts_with("0 "), "{name}: {text}");
    }
}

#[test]
fn layout() {
    drive("layout");
}

#[test]
fn interface() {
    drive("interface");
}

#[test]
fn masing() {
    drive("masing");
}

#[test]
fn batch() {
    drive("batch");
}

#[test]
fn harmonic() {
    drive("harmonic");
}

#[test]
fn equivalents() {
    drive("equivalents");
}

#[test]
fn bad_parameters() {
    drive("bad_parameters");
}

#[test]
fn bad_arguments() {
    drive("bad_arguments");
}

#[test]
fn bad_memory() {
    drive("bad_memory");
}

#[test]
fn environment() {
    drive("environment");
}

#[test]
fn golden() {
    drive("golden");
}

/// No driver is forgotten above.
#[test]
fn every_driver_is_run() {
    let source = std::fs::read_to_string(root().join(file!())).expect("this file is there");
    for entry in std::fs::read_dir(root().join("c_tests")).expect("the drivers are there") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|extension| extension == "c") {
            let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
            assert!(source.contains(&format!("drive(\"{name}\")")), "{name} is not run");
        }
    }
}
