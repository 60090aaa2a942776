//! The law for two tangential directions against Coulomb's law with vectors of traction and slip at 56 elements of a half-space
//! line (`tests/golden/two_directions.csv`) and at squares of a sphere's contact (`two_directions_sphere.csv`), and against smaller
//! steps.

use crate::golden;
use microslip::element::{Directions, Element, NormalInput};
use microslip::law::{StepOf, StepResult};
use microslip::two_directions::{Law, TwoDirections};
use microslip::{EllipticParameters, Material, Parameters};
use std::f64::consts::TAU;
use std::fmt::Write;

/// A path of the files.
struct Path {
    shape: &'static str,
    name: &'static str,
    /// With the largest load of the path; a sphere has no length.
    parameters: Parameters,
    rows: Vec<Row>,
}

struct Row {
    /// u, v, N.
    displacement: [f64; 3],
    force: [f64; 2],
    dissipated: f64,
}

/// Force and dissipated energy after a step.
#[derive(Clone, Copy)]
pub struct Point {
    pub force: [f64; 2],
    pub dissipated: f64,
}

impl From<StepOf<TwoDirections>> for Point {
    fn from(StepResult { force: [x, y, _], dissipated, .. }: StepOf<TwoDirections>) -> Point {
        Point { force: [x, y], dissipated }
    }
}

/// The errors of a path.
struct Errors {
    path: Path,
    /// Largest error of the force over the largest mu N, and error of the dissipated energy over its value.
    of_law: [f64; 2],
    /// The same for two elements at right angles, each moved in one direction.
    of_two: [f64; 2],
}

fn paths() -> Vec<Path> {
    let mut paths: Vec<Path> = Vec::new();
    for row in ["two_directions", "two_directions_sphere"].into_iter().flat_map(golden::table) {
        let name = row.text("path");
        let shape = match (row["a"] > 0.0, row["L"] > 0.0) {
            (true, _) => "flat",
            (false, true) => "cylinder",
            (false, false) => "sphere",
        };
        let (displacement, load) = (["u", "v", "N"].map(|name| row[name]), row["N"]);
        let solved = Row { displacement, force: [row["Tx"], row["Ty"]], dissipated: row["dissipated"] };
        match paths.last_mut() {
            Some(path) if (path.shape, path.name) == (shape, name) => {
                path.parameters.normal_force = path.parameters.normal_force.max(load);
                path.rows.push(solved);
            }
            _ => {
                let body = Material { young_modulus: row["E"], poisson_ratio: row["nu"] };
                let parameters = Parameters {
                    normal_force: load,
                    friction_coefficient: row["mu"],
                    material: [body; 2],
                    ..golden::geometry(&row)
                };
                paths.push(Path { shape, name, parameters, rows: vec![solved] });
            }
        }
    }
    paths
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
    path.map(|displacement| Point::from(to(displacement))).collect()
}

fn element(parameters: &Parameters) -> Element {
    let Parameters { length, edge_radius, normal_force, friction_coefficient, material, .. } = *parameters;
    if length > 0.0 {
        return Element::rounded_flat(parameters, Directions::Two, NormalInput::Force).expect("an element");
    }
    // Hertz: b³ = 3 N R/(4 E*), with E* of two equal bodies.
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
    Element::elliptic(&sphere, Directions::Two, NormalInput::Force).expect("an element")
}

/// Largest distance of the forces over a force; dissipated energy over that of the others, less 1.
pub fn difference(points: &[Point], others: &[Point], force: f64) -> [f64; 2] {
    let distance = |(a, b): (&Point, &Point)| (a.force[0] - b.force[0]).hypot(a.force[1] - b.force[1]) / force;
    let energy = |points: &[Point]| points.iter().map(|point| point.dissipated).sum::<f64>();
    [points.iter().zip(others).map(distance).fold(0.0, f64::max), energy(points) / energy(others) - 1.0]
}

fn compare(path: Path) -> Errors {
    let element = element(&path.parameters);
    let along = |factors: [f64; 2]| {
        let rows = path.rows.iter().map(|row| row.displacement);
        drive(&element, rows.map(move |[u, v, load]| [factors[0] * u, factors[1] * v, load]))
    };
    let (law, across, lengthwise) = (along([1.0, 1.0]), along([1.0, 0.0]), along([0.0, 1.0]));
    let sum = |(x, y): (&Point, &Point)| Point {
        force: [x.force[0] + y.force[0], x.force[1] + y.force[1]],
        dissipated: x.dissipated + y.dissipated,
    };
    let two: Vec<Point> = across.iter().zip(&lengthwise).map(sum).collect();
    let solved: Vec<Point> =
        path.rows.iter().map(|row| Point { force: row.force, dissipated: row.dissipated }).collect();
    let slip_force = path.parameters.friction_coefficient * path.parameters.normal_force;
    let [of_law, of_two] = [&law, &two].map(|points| difference(points, &solved, slip_force));
    Errors { of_law, of_two, path }
}

impl Errors {
    fn row(&self) -> String {
        let shape = self.path.shape;
        let name = match self.path.name {
            "circle0.4_loadvaries" => "circle 0.4, N from 0.4 to 1".to_owned(),
            "circle0.4_nearseparation" => "circle 0.4, N from 0.04 to 1".to_owned(),
            "ellipse2to1" => "ellipse 2:1".to_owned(),
            "eight" => "figure of eight".to_owned(),
            "Lpath" => "L".to_owned(),
            "walk" => "random, coarse steps".to_owned(),
            "collinear45" => "line at 45°".to_owned(),
            circle => circle.replace("circle", "circle "),
        };
        let errors = [self.of_law, self.of_two];
        let cells = errors.map(|[force, energy]| format!(" {} | {} |", percent(force), signed(energy)));
        format!("| {shape} | {name} |{}\n", cells.concat())
    }
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
    let orbit = &points[points.len() - steps as usize..];
    let sum = |points: &[Point]| Point {
        force: points[points.len() - 1].force,
        dissipated: points.iter().map(|point| point.dissipated).sum(),
    };
    orbit.chunks(steps as usize / INSTANTS).map(sum).collect()
}

/// Forces of orbits are compared at these instants.
const INSTANTS: usize = 12;
const AMPLITUDES: [f64; 4] = [0.3, 0.6, 0.9, 1.3];
const STEPS: [u32; 4] = [12, 24, 48, 96];
/// Number of steps with a hundredth of the error of the finest row of the table.
const CONVERGED: u32 = 960;

/// Cylinder and flat of the file.
fn shapes() -> Vec<Parameters> {
    let line = |path: &Path| path.name == "circle0.3" && path.shape != "sphere";
    paths().into_iter().filter(line).map(|path| path.parameters).collect()
}

/// The worst of both shapes for each amplitude: a cell for each.
fn cells(errors: impl Fn(&Parameters, f64) -> [f64; 2]) -> String {
    let mut cells = String::new();
    for amplitude in AMPLITUDES {
        let worst = shapes().iter().map(|shape| errors(shape, amplitude)).fold([0.0; 2], |worst, [force, energy]| {
            [f64::max(worst[0], force), if energy.abs() > f64::abs(worst[1]) { energy } else { worst[1] }]
        });
        write!(cells, " {}, {} |", percent(worst[0]), signed(worst[1])).expect("a string");
    }
    cells + "\n"
}

/// Errors of steps per orbit.
fn steps_row(steps: u32) -> String {
    let errors = |shape: &Parameters, amplitude: f64| {
        let element = element(shape);
        let of = |steps: u32| circle(&element, element.normal_force, amplitude, steps);
        difference(&of(steps), &of(CONVERGED), element.friction_coefficient * element.normal_force)
    };
    format!("| {steps} |") + &cells(errors)
}

/// Bounds on the errors of force and energy.
const FORCE: f64 = 0.008;
const ENERGY: f64 = 0.05;

/// The comparison with the file.
pub struct Comparison(Vec<Errors>);

impl Comparison {
    pub fn new() -> Comparison {
        Comparison(paths().into_iter().map(compare).collect())
    }

    /// The checks, a message for each that fails.
    pub fn results(&self) -> Vec<Result<(), String>> {
        let check = |errors: &Errors| {
            let Errors { path, of_law: [force, energy], of_two: [_, energy_of_two], .. } = errors;
            // Otherwise the comparison could not distinguish the law from two elements.
            let holds = *force <= FORCE && energy.abs() <= ENERGY && energy_of_two.abs() > 2.0 * ENERGY;
            let Path { shape, name, .. } = path;
            if holds { Ok(()) } else { Err(format!("{shape}, {name}: errors {force:.1e}, {energy:.1e}")) }
        };
        self.0.iter().map(check).collect()
    }

    /// The tables of `docs/validation.md`, with the names of their markers.
    pub fn tables(&self) -> [(&'static str, String); 2] {
        let mut paths = String::from(
            "| contact | path | force | energy | two elements: force | energy |\n\
             |---|---|---:|---:|---:|---:|\n",
        );
        self.0.iter().for_each(|errors| paths += &errors.row());
        let amplitudes = AMPLITUDES.map(|amplitude| format!(" circle {amplitude} |")).concat();
        let head = format!("| steps |{amplitudes}\n|---:|{}\n", "---:|".repeat(AMPLITUDES.len()));
        let steps = head + &STEPS.map(steps_row).concat();
        [("paths in two directions", paths), ("steps in two directions", steps)]
    }
}
