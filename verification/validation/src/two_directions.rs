//! The law for two tangential directions against Coulomb's law with vectors of traction and slip at 56 elements of a half-space
//! line (`tests/golden/two_directions.csv`) and at squares of a sphere's contact (`two_directions_sphere.csv`), and against smaller
//! steps.
//!
//! The elements of a line have exact pressures; 16 and 32 substeps of each row are extrapolated. Their error is half of the last
//! change and the change to 84 elements. The squares of the sphere, 45 along the diameter, have the mean pressure over each; 6 and
//! 12 substeps are extrapolated.

use crate::documents::Documents;
use crate::golden::{self, Row};
use crate::histories::line_or_sphere;
use crate::strips::range;
use crate::{PAGE, csv};
use microslip::element::{Directions, Element};
use microslip::law::StepResult;
use microslip::two_directions::{Law, TwoDirections};
use microslip::{Material, Parameters};
use std::f64::consts::TAU;

/// Force at the end of a row of a path, and energy dissipated in the row.
#[derive(Debug, Clone, Copy)]
pub struct Point {
    pub force: [f64; 2],
    pub dissipated: f64,
}

/// A path of the files.
struct Path {
    shape: &'static str,
    name: &'static str,
    /// With the largest load of the path; a sphere has no length.
    parameters: Parameters,
    /// u, v and N, and what the boundary elements find.
    displacements: Vec<[f64; 3]>,
    solved: Vec<Point>,
}

fn paths() -> Vec<Path> {
    let place = |row: &Row| {
        let shape = match (row["a"] > 0.0, row["L"] > 0.0) {
            (true, _) => "flat",
            (false, true) => "cylinder",
            (false, false) => "sphere",
        };
        (shape, row.text("path"))
    };
    let path = |rows: &[Row]| {
        let ((shape, name), row) = (place(&rows[0]), &rows[0]);
        let parameters = Parameters {
            normal_force: rows.iter().map(|row| row["N"]).fold(0.0, f64::max),
            friction_coefficient: row["mu"],
            material: [Material { young_modulus: row["E"], poisson_ratio: row["nu"] }; 2],
            ..golden::geometry(row)
        };
        let displacements = rows.iter().map(|row| ["u", "v", "N"].map(|name| row[name])).collect();
        let solved = |row: &Row| Point { force: [row["Tx"], row["Ty"]], dissipated: row["dissipated"] };
        Path { shape, name, parameters, displacements, solved: rows.iter().map(solved).collect() }
    };
    let rows: Vec<Row> = ["two_directions", "two_directions_sphere"].into_iter().flat_map(golden::table).collect();
    rows.chunk_by(|one, next| place(one) == place(next)).map(path).collect()
}

/// The law along displacements; pressed at the first one without tangential force.
pub fn drive(element: &Element, path: impl Iterator<Item = [f64; 3]>) -> Vec<Point> {
    let mut state = vec![0.0; TwoDirections::STATE_LENGTH];
    TwoDirections::state_init(&mut state).expect("a state");
    let mut to = |displacement: [f64; 3]| TwoDirections::step(element, &mut state, displacement).expect("a step");
    let mut path = path.peekable();
    if let Some([u, v, _]) = path.peek() {
        to([*u, *v, 0.0]);
    }
    let point = |displacement| {
        let StepResult { force: [x, y, _], dissipated, .. } = to(displacement);
        Point { force: [x, y], dissipated }
    };
    path.map(point).collect()
}

/// The last forces of the given number of points, each with the energy of all.
pub fn sums(points: &[Point], number: usize) -> Vec<Point> {
    let sum = |points: &[Point]| Point {
        force: points[points.len() - 1].force,
        dissipated: points.iter().map(|point| point.dissipated).sum(),
    };
    points.chunks(number).map(sum).collect()
}

/// Largest distance of the forces over a force; dissipated energy over that of the others, less 1.
pub fn difference(points: &[Point], others: &[Point], force: f64) -> [f64; 2] {
    let distance = |(a, b): (&Point, &Point)| (a.force[0] - b.force[0]).hypot(a.force[1] - b.force[1]) / force;
    let energy = |points: &[Point]| points.iter().map(|point| point.dissipated).sum::<f64>();
    [points.iter().zip(others).map(distance).fold(0.0, f64::max), energy(points) / energy(others) - 1.0]
}

/// The larger errors of force and energy.
pub fn worse(worst: &mut [f64; 2], [force, energy]: [f64; 2]) {
    worst[0] = worst[0].max(force);
    worst[1] = if energy.abs() > worst[1].abs() { energy } else { worst[1] };
}

/// Errors of the force over the largest mu N and of the dissipated energy over its value: of the law, and of two elements at right
/// angles, each moved in one direction.
fn errors(path: &Path) -> [[f64; 2]; 2] {
    let element = line_or_sphere(&path.parameters, Directions::Two);
    let along = |factors: [f64; 2]| {
        drive(&element, path.displacements.iter().map(move |[u, v, load]| [factors[0] * u, factors[1] * v, *load]))
    };
    let (law, across, lengthwise) = (along([1.0, 1.0]), along([1.0, 0.0]), along([0.0, 1.0]));
    let sum = |(x, y): (&Point, &Point)| Point {
        force: [x.force[0] + y.force[0], x.force[1] + y.force[1]],
        dissipated: x.dissipated + y.dissipated,
    };
    let two: Vec<Point> = across.iter().zip(&lengthwise).map(sum).collect();
    let slip_force = path.parameters.friction_coefficient * path.parameters.normal_force;
    [&law, &two].map(|points| difference(points, &path.solved, slip_force))
}

/// The groups of paths in the table of the page.
const GROUPS: [&str; 3] = ["circles 0.3 to 1.3", "other paths", "circle 0.4, load varies"];

/// The group of a path.
fn group(path: &str) -> &'static str {
    GROUPS[match path.starts_with("circle") {
        false => 1,
        true if path.contains('_') => 2,
        true => 0,
    }]
}

/// Two significant digits are enough for an error.
pub fn percent(value: f64) -> String {
    let percent = 100.0 * value;
    if percent < 2.0 { format!("{percent:.2}") } else { format!("{percent:.0}") }
}

pub fn signed(value: f64) -> String {
    let percent = 100.0 * value;
    let digits = usize::from(percent.abs() < 9.95);
    // No sign of what is rounded to zero.
    if percent.abs() < 0.05 { "0".to_owned() } else { format!("{percent:+.digits$}") }
}

/// A circle of an amplitude in units of the displacement of gross slip across the line, under a constant load, entered along x.
fn circle(element: &Element, load: f64, amplitude: f64, steps: u32) -> Vec<Point> {
    let radius = amplitude * element.friction_coefficient * element.shift_under(load);
    let entry = (0..=steps / 4).map(move |i| [radius * f64::from(4 * i) / f64::from(steps), 0.0, load]);
    let orbit = (1..=steps).map(move |i| {
        let (sin, cos) = (TAU * f64::from(i) / f64::from(steps)).sin_cos();
        [radius * cos, radius * sin, load]
    });
    let points = drive(element, entry.chain(orbit));
    sums(&points[points.len() - steps as usize..], steps as usize / INSTANTS)
}

/// Forces of orbits are compared at these instants.
const INSTANTS: usize = 12;
const AMPLITUDES: [f64; 4] = [0.3, 0.6, 0.9, 1.3];
const STEPS: [u32; 4] = [12, 24, 48, 96];
/// Number of steps with a hundredth of the error of the finest row of the table.
const CONVERGED: u32 = 960;

/// Bounds on the errors of force and energy.
const FORCE: f64 = 0.008;
const ENERGY: f64 = 0.05;

/// The comparison with the files, and the errors of steps of a circle: the worst of cylinder and flat.
pub fn compare(documents: &mut Documents) {
    let heads = "| contact | path | force | energy | two elements: force | two elements: energy |\n|---|---|---:|---:|---:|---:|\n";
    let paths = paths();
    let all: Vec<[[f64; 2]; 2]> = paths.iter().map(errors).collect();
    let mut table = heads.to_owned();
    for (path, errors) in paths.iter().zip(&all) {
        let [[force, energy], [_, energy_of_two]] = *errors;
        // Otherwise the comparison could not distinguish the law from two elements.
        let holds = force <= FORCE && energy.abs() <= ENERGY && energy_of_two.abs() > 2.0 * ENERGY;
        documents.check(holds, format!("{}, {}: errors {force:.1e}, {energy:.1e}", path.shape, path.name));
        let cells = errors.map(|[force, energy]| format!(" {} | {} |", percent(force), signed(energy)));
        table += &format!("| {} | {} |{}\n", path.shape, path.name, cells.concat());
    }
    documents.page("two_directions.csv", |_| Ok(csv(&table)));
    let mut table = heads.to_owned();
    for shape in ["cylinder", "flat", "sphere"] {
        for name in GROUPS {
            let of_group = |(path, _): &(&Path, _)| path.shape == shape && group(path.name) == name;
            let found: Vec<&[[f64; 2]; 2]> =
                paths.iter().zip(&all).filter(of_group).map(|(_, errors)| errors).collect();
            if found.is_empty() {
                continue;
            }
            let cells = [0, 1].map(|kind| {
                let force = range(found.iter().map(|errors| errors[kind][0]))[1];
                let [least, most] = range(found.iter().map(|errors| errors[kind][1])).map(signed);
                let energy = if least == most { least } else { format!("{least} to {most}") };
                format!(" {} | {energy} |", percent(force))
            });
            table += &format!("| {shape} | {name} |{}\n", cells.concat());
        }
    }
    documents.table(PAGE, "paths in two directions", &table);
    let amplitudes = AMPLITUDES.map(|amplitude| format!(" circle {amplitude} |")).concat();
    let mut table = format!("| steps |{amplitudes}\n|---:|{}\n", "---:|".repeat(AMPLITUDES.len()));
    for steps in STEPS {
        table += &format!("| {steps} |");
        for amplitude in AMPLITUDES {
            let mut worst = [0.0; 2];
            for path in paths.iter().filter(|path| path.name == "circle0.3" && path.shape != "sphere") {
                let element = line_or_sphere(&path.parameters, Directions::Two);
                let [of, exact] = [steps, CONVERGED].map(|n| circle(&element, element.normal_force, amplitude, n));
                worse(&mut worst, difference(&of, &exact, element.friction_coefficient * element.normal_force));
            }
            table += &format!(" {}, {} |", percent(worst[0]), signed(worst[1]));
        }
        table.push('\n');
    }
    documents.table(PAGE, "steps in two directions", &table);
}
