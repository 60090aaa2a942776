//! Histories that the boundary-element code CONTACT computed, in `tests/golden/contact_code`. Files are in mm, N, MPa and mJ; here
//! everything is in SI units.

use crate::csv;
use crate::documents::Documents;
use crate::path::Path;
use microslip::element::{Directions, Element, NormalInput};
use microslip::{EllipticParameters, Material, Parameters};

/// Steps of the law for each row, straight in both forces.
const SUBSTEPS: u32 = 6;
/// Largest difference of the approach of a line contact, relative: four printed digits.
const APPROACH: f64 = 6e-4;

/// The contacts of the files: names there and in the table; friction coefficient, shear modulus and Poisson's ratio; a, R and L, of
/// the sphere only its radius.
const SHAPES: [(&str, &str, [f64; 3], [f64; 3]); 3] = [
    ("cylinder", "cylinder", [0.3, 82e9, 0.28], [0.0, 0.5, 0.2]),
    ("roundedflat", "flat with rounded edges", [0.5, 76.9231e9, 0.3], [0.5e-3, 3e-3, 20e-3]),
    ("sphere", "sphere", [0.4, 200e6, 0.42], [0.0, 0.05, 0.0]),
];

/// Paths in the names of the files, and in the table.
const PATHS: [[&str; 2]; 5] = [
    ["constN", "constant load"],
    ["steps", "seven straight paths"],
    ["phase0", "load swings, 0°"],
    ["phase90", "load swings, 90°"],
    ["phase180", "load swings, 180°"],
];

/// Largest difference of displacements, relative: the error of CONTACT.
///
/// - Always that of its mesh (the sphere is cut into squares, 31 along the diameter), and of the four printed digits of each
///   increment.
/// - Under a changing load also that of its steps: what comes into contact within a step is free of traction at its end, an error
///   of first order in the change of the width. The flat hardly changes its width; in phase and in antiphase nothing slips.
fn bound(shape: &str, path: &str) -> f64 {
    match (shape, path) {
        ("cylinder", "phase90") => 1.2e-3,
        ("cylinder", _) => 2.5e-4,
        ("roundedflat", "constN") => 5e-4,
        ("roundedflat", _) => 3e-4,
        (_, "phase90") => 4e-3,
        (_, _) => 2.5e-3,
    }
}

/// Its losses are those of 24 steps in a cycle; under a constant load they are those of the law, except that a flat slips in one or
/// two of its elements only.
fn bounds_of_dissipation(shape: &str, path: &str) -> [f64; 2] {
    match (shape, path) {
        ("roundedflat", "constN") => [0.6, 1.4],
        (_, "constN") => [0.98, 1.01],
        (_, _) => [0.85, 1.02],
    }
}

/// The element of one of them, its tables up to a normal force, with the normal force as its input.
fn element(friction_and_material: [f64; 3], lengths: [f64; 3], normal_force: f64) -> Element {
    let [friction_coefficient, shear_modulus, poisson_ratio] = friction_and_material;
    let [flat_half_width, edge_radius, length] = lengths;
    let young_modulus = 2.0 * (1.0 + poisson_ratio) * shear_modulus;
    let line = Parameters {
        flat_half_width,
        edge_radius,
        length,
        normal_force,
        friction_coefficient,
        material: [Material { young_modulus, poisson_ratio }; 2],
        displacement_reference: microslip::parameters::CENTRE_POINT,
        ..Parameters::default()
    };
    line_or_sphere(&line, Directions::One)
}

/// The element of a line contact, or of a sphere by its contact circle (Hertz) if there is no length; by the normal force.
pub fn line_or_sphere(parameters: &Parameters, directions: Directions) -> Element {
    let Parameters { length, edge_radius, normal_force, friction_coefficient, material, .. } = *parameters;
    if length > 0.0 {
        return Element::rounded_flat(parameters, directions, NormalInput::Force).expect("an element");
    }
    // b³ = 3 N R/(4 E*), with E* of two equal bodies.
    let modulus = 0.5 * material[0].young_modulus / (1.0 - material[0].poisson_ratio.powi(2));
    let semi_axis = (0.75 * normal_force * edge_radius / modulus).cbrt();
    let sphere = EllipticParameters {
        semi_axis_x: semi_axis,
        semi_axis_y: semi_axis,
        normal_force,
        friction_coefficient,
        material,
        ..EllipticParameters::default()
    };
    Element::elliptic(&sphere, directions, NormalInput::Force).expect("an element")
}

/// N, T, displacement, dissipated energy so far and normal approach of each row of a file, whose head is a comment.
fn rows(name: &str) -> Vec<[f64; 5]> {
    let file = format!("{}/../../tests/golden/contact_code/{name}.csv", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{file}: {error}"));
    let row = |line: &str| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        [cells[1], cells[2], 1e-3 * cells[3], 1e-3 * cells[4], 1e-3 * cells[5]]
    };
    text.lines().filter(|line| !line.starts_with('#')).map(row).collect()
}

/// The checks, and the table.
pub fn compare(documents: &mut Documents) {
    let mut table = String::from("| contact | path | rows | displacement | dissipation |\n|---|---|---:|---:|---:|\n");
    for (contact, [path, title]) in SHAPES.into_iter().flat_map(|contact| PATHS.map(|path| (contact, path))) {
        let (shape, title_of_shape, friction_and_material, lengths) = contact;
        let name = format!("{shape}_{path}");
        let rows = rows(&name);
        let largest = |column: usize| rows.iter().map(|row| row[column].abs()).fold(0.0, f64::max);
        let (element, scale) = (element(friction_and_material, lengths, largest(0)), largest(2));
        // Twice the shift under the largest force: beyond it there is gross slip.
        let distance = 4.0 * element.friction_coefficient * element.shift_under(element.normal_force);
        let mut law = Path::new(&element, 256);
        let (mut last, mut energy, mut difference) = (rows[0], 0.0, 0.0_f64);
        for (i, row) in rows.iter().enumerate() {
            // The first row is one step from the open contact.
            let parts = if i == 0 { 1 } else { SUBSTEPS };
            for part in 1..=parts {
                let along = |i: usize| last[i] + (row[i] - last[i]) * f64::from(part) / f64::from(parts);
                energy += law.pull([0.0, 1.0], along(1), along(0), distance).dissipated;
            }
            difference = difference.max((row[2] - law.displacement).abs() / scale);
            last = *row;
            if shape != "sphere" {
                let approach = (row[4] / element.approach_under(row[0]).value - 1.0).abs();
                documents.check(approach <= APPROACH, format!("{name}: approaches differ by {approach:.1e}"));
            }
        }
        let ([low, high], dissipated) = (bounds_of_dissipation(shape, path), last[3] / energy);
        documents.check(difference <= bound(shape, path), format!("{name}: displacements differ by {difference:.1e}"));
        documents.check((low..=high).contains(&dissipated), format!("{name}: {dissipated:.2} of the dissipation"));
        table += &format!("| {} | {title} | {} | {difference:.1e} | {dissipated:.2} |\n", title_of_shape, rows.len());
    }
    documents.page("boundary_elements.csv", |_| Ok(csv(&table)));
}
