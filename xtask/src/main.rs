//! Chores of this repository that need a Rust program.

fn main() {
    let header = cbindgen::Builder::new()
        .with_crate(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
        .generate()
        .expect("the sources can be parsed");
    header.write(std::io::stdout());
}
