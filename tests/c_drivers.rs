//! The drivers in C and Fortran with floating-point traps, against the library installed at `MICROSLIP_PREFIX`, or else
//! against the archive as cargo builds it.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

static ROOT: LazyLock<&Path> = LazyLock::new(|| Path::new(env!("CARGO_MANIFEST_DIR")));

/// Where the archive and the drivers are built.
static BUILD: LazyLock<PathBuf> = LazyLock::new(|| {
    let build = Path::new(env!("CARGO_TARGET_TMPDIR")).join("c_drivers");
    std::fs::create_dir_all(&build).unwrap();
    build
});

/// The include directory and the archive.
static LIBRARY: LazyLock<[PathBuf; 2]> = LazyLock::new(|| {
    if let Some(prefix) = std::env::var_os("MICROSLIP_PREFIX") {
        return ["include", "lib/libmicroslip.a"].map(|path| ROOT.join(&prefix).join(path));
    }
    let mut cargo = Command::new(env!("CARGO"));
    cargo.current_dir(*ROOT).args([
        "rustc",
        "--release",
        "--locked",
        "--lib",
        "--crate-type",
        "staticlib",
        "--target-dir",
    ]);
    run(cargo.arg(&*BUILD)).unwrap();
    [ROOT.join("include"), BUILD.join("release/libmicroslip.a")]
});

/// Standard output of a program that succeeds, or else everything it printed.
fn run(command: &mut Command) -> Result<String, String> {
    let output = command.output().map_err(|error| format!("{command:?}: {error}"))?;
    let [text, errors] = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    if output.status.success() { Ok(text) } else { Err(format!("{command:?}: {}\n{text}{errors}", output.status)) }
}

fn compiler() -> Command {
    let mut compiler = Command::new(std::env::var("CC").unwrap_or("cc".to_string()));
    compiler.args(["-O2", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-pthread", "-std=c99"]);
    compiler
}

/// Links the sources, runs the program, and checks that all of its checks passed.
fn drive(compiler: &mut Command, sources: &[PathBuf], program: &str) -> Result<(), String> {
    let [include, archive] = &*LIBRARY;
    let path = BUILD.join(program);
    compiler.arg("-I").arg(include).args(sources).arg(archive).args(["-lm", "-lpthread", "-ldl"]);
    run(compiler.arg("-o").arg(&path))?;
    let text = run(Command::new(&path).arg("--trap").current_dir(*ROOT))?;
    let last = text.lines().last().unwrap_or_default();
    if last.ends_with(" passed, 0 failed") && !last.starts_with("0 ") {
        Ok(())
    } else {
        Err(format!("{program}: {text}"))
    }
}

/// Runs all jobs at the same time, and fails with all of their errors.
fn run_all(jobs: Vec<impl FnOnce() -> Result<(), String> + Send>) {
    assert!(!jobs.is_empty());
    let errors: Vec<String> = std::thread::scope(|scope| {
        let threads: Vec<_> = jobs.into_iter().map(|job| scope.spawn(job)).collect();
        threads.into_iter().filter_map(|thread| thread.join().unwrap().err()).collect()
    });
    assert!(errors.is_empty(), "{}", errors.join("\n"));
}

#[test]
fn c() {
    let entries = std::fs::read_dir(ROOT.join("c_tests")).unwrap().map(|entry| entry.unwrap().path());
    let sources = entries.filter(|path| path.extension().is_some_and(|extension| extension == "c"));
    let jobs = sources.map(|source| {
        let program = source.file_stem().unwrap().to_string_lossy().into_owned();
        move || drive(&mut compiler(), &[source], &program)
    });
    run_all(jobs.collect());
}

/// The module compiles without warnings by both standards, and the tests pass with every default kind and with static variables.
/// flang has one standard, no traps, and rejects static variables in pure procedures.
#[test]
fn fortran() {
    let fortran = std::env::var("FC").unwrap_or("gfortran".to_string());
    let flang = fortran.contains("flang");
    let strict = if flang { "-Werror" } else { "-Wall -Wextra -pedantic -Werror -ffpe-trap=invalid,zero,overflow" };
    // The test of invalid input calls the C functions of the module, too.
    let bad_input = if flang { "-std=f2018 -cpp -Dprivate=public" } else { "-std=f2008 -cpp -Dprivate=public" };
    let mut runs =
        vec![("wrappers", "-std=f2018", "-O0"), ("wrappers", "-std=f2018", "-O2"), ("restarts", "-std=f2018", "-O2")];
    let options = ["", "-fdefault-real-8 -fdefault-integer-8", "-fno-automatic"];
    for options in &options[..if flang { 2 } else { 3 }] {
        runs.extend([("bad_input", bad_input, *options), ("test_microslip", "-std=f2018", options)]);
    }
    let jobs = runs.into_iter().enumerate().map(|(i, (name, standard, options))| {
        let fortran = &fortran;
        move || {
            let program = format!("{name}_{i}");
            let modules = BUILD.join(program.clone() + "_modules");
            std::fs::create_dir_all(&modules).unwrap();
            let sources = ["checks", name].map(|name| ROOT.join(format!("tests/fortran/{name}.f90")));
            let mut compiler = Command::new(fortran);
            compiler.args([options, standard, strict].iter().flat_map(|flags| flags.split_whitespace()));
            let sources = [&[LIBRARY[0].join("microslip.f90")][..], &sources].concat();
            drive(compiler.arg("-J").arg(modules), &sources, &program)
        }
    });
    run_all(jobs.collect());
}
