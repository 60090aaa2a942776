//! The law for two directions against the slow reference of its equations with many springs and small steps, whose results are rows of
//! `tests/golden/two_directions_reference.csv`. `validation --reference` computes these rows: about ten minutes.

use crate::golden;
use crate::two_directions::{Point, difference, drive, percent, signed};
use microslip::element::{Directions, Element, NormalInput};
use microslip::parameters::CENTRE_POINT;
use microslip::{EllipticParameters, Layer, Material, Parameters};
use reference::Input;
use reference::two_directions::Contact;
use std::f64::consts::{PI, TAU};
use std::fmt::Write;
use std::thread;

/// A motion of a contact.
struct Case {
    contact: String,
    input: Input,
    motion: Motion,
}

/// Amplitudes are in units of the displacement of gross slip across the line, loads over the largest one.
#[derive(Clone, Copy, PartialEq)]
enum Motion {
    Circle(f64),
    /// 3:1, the long axis at 30°.
    Ellipse(f64),
    /// At an angle in degrees; neither displacement nor load has a period.
    Line(f64),
    /// A circle while the load varies with this order and phase in degrees.
    Varying(f64, [f64; 2]),
    /// A displacement along x beside a vibration along y, while the load varies by this part.
    Shear(f64),
}

const MOTIONS: [Motion; 17] = [
    Motion::Circle(0.05),
    Motion::Circle(0.1),
    Motion::Circle(0.3),
    Motion::Circle(0.6),
    Motion::Circle(0.9),
    Motion::Circle(1.3),
    Motion::Ellipse(0.3),
    Motion::Ellipse(0.9),
    Motion::Line(0.0),
    Motion::Line(30.0),
    Motion::Line(90.0),
    Motion::Varying(0.3, [1.0, 0.0]),
    Motion::Varying(0.3, [2.0, 60.0]),
    Motion::Varying(0.9, [1.0, 90.0]),
    Motion::Varying(0.9, [2.0, 0.0]),
    Motion::Shear(0.0),
    Motion::Shear(0.5),
];
/// Rows of a period, of which the second one counts, and of its beginning.
const PERIOD: u32 = 48;
const ENTRY: u32 = 6;
/// Steps of the reference in a row, and twice as many, extrapolated: with four times as many forces change by up to 3e-4 μN.
const STEPS: usize = 4;
/// Forces are compared at every second row of the period.
const EVERY: u32 = 2;
const INSTANTS: u32 = PERIOD / EVERY;
const LARGEST_LOAD: f64 = 1000.0;
const FRICTION: f64 = 0.5;
const SLIP_FORCE: f64 = FRICTION * LARGEST_LOAD;
const BODY: Material = Material { young_modulus: 2e11, poisson_ratio: 0.3 };

impl Motion {
    /// The column of the table.
    fn group(self) -> usize {
        match self {
            Motion::Circle(radius) => usize::from(radius >= 0.3),
            Motion::Ellipse(_) => 2,
            Motion::Line(_) => 3,
            Motion::Varying(..) => 4,
            Motion::Shear(_) => 5,
        }
    }

    /// u, v over the displacement of gross slip and the load over the largest one, from a sticking contact on.
    fn path(self) -> Vec<[f64; 3]> {
        let load = |variation: f64, angle: f64| 1.0 - 0.5 * variation * (1.0 - angle.cos());
        let at = |t: f64| match self {
            Motion::Circle(radius) => [radius * t.cos(), radius * t.sin(), 1.0],
            Motion::Ellipse(radius) => {
                let (sin, cos) = (PI / 6.0).sin_cos();
                let [long, short] = [radius * t.cos(), radius / 3.0 * t.sin()];
                [long * cos - short * sin, long * sin + short * cos, 1.0]
            }
            Motion::Line(degrees) => {
                let (along, (sin, cos)) = (0.6 * t.cos() + 0.3 * (0.6 * t).sin(), degrees.to_radians().sin_cos());
                [along * cos, along * sin, load(0.95, 1.7 * t)]
            }
            Motion::Varying(radius, [order, phase]) => {
                [radius * t.cos(), radius * t.sin(), load(0.95, order * t + phase.to_radians())]
            }
            Motion::Shear(variation) => [0.4, 0.3 * t.sin(), load(variation, 2.0 * t)],
        };
        let [u, v, load] = at(0.0);
        let entry = (0..ENTRY).map(|i| f64::from(i) / f64::from(ENTRY));
        let periods = (0..=2 * PERIOD).map(|i| TAU * f64::from(i) / f64::from(PERIOD));
        entry.map(|part| [part * u, part * v, load]).chain(periods.map(at)).collect()
    }

    /// Springs of the reference: so many that its own error is small. On lines 120 springs have one of 1e-4 μN.
    fn springs(self) -> usize {
        if matches!(self, Motion::Line(_)) { 120 } else { 60 }
    }

    fn name(self) -> String {
        match self {
            Motion::Circle(radius) => format!("circle {radius}"),
            Motion::Ellipse(radius) => format!("ellipse {radius}"),
            Motion::Line(degrees) => format!("line {degrees}"),
            Motion::Varying(radius, [order, phase]) => format!("varying {radius} {order} {phase}"),
            Motion::Shear(variation) => format!("shear {variation}"),
        }
    }
}

/// A flat of a/b under the largest load, b = 0.5 mm.
fn flat(ratio: f64, layer: Layer) -> Input {
    let (b, length) = (5e-4, 3.25e-3);
    let modulus = 0.5 * BODY.young_modulus / (1.0 - BODY.poisson_ratio.powi(2));
    let area = b * b * (ratio.acos() - ratio * (1.0 - ratio * ratio).sqrt());
    Input::Flat(Parameters {
        flat_half_width: ratio * b,
        edge_radius: modulus * length * area / (2.0 * LARGEST_LOAD),
        length,
        normal_force: LARGEST_LOAD,
        friction_coefficient: FRICTION,
        displacement_reference: CENTRE_POINT,
        material: [BODY; 2],
        layer,
        ..Parameters::default()
    })
}

fn ellipse([semi_axis_x, semi_axis_y]: [f64; 2], layer: Layer) -> Input {
    Input::Ellipse(EllipticParameters {
        semi_axis_x,
        semi_axis_y,
        normal_force: LARGEST_LOAD,
        friction_coefficient: FRICTION,
        material: [BODY; 2],
        layer,
    })
}

/// The same contact by parameters for another normal force.
fn at_load(input: &Input, normal_force: f64) -> Input {
    match *input {
        Input::Flat(parameters) => Input::Flat(Parameters { normal_force, ..parameters }),
        Input::Ellipse(parameters) => {
            let factor = (normal_force / parameters.normal_force).cbrt();
            let [semi_axis_x, semi_axis_y] = [parameters.semi_axis_x, parameters.semi_axis_y].map(|axis| factor * axis);
            Input::Ellipse(EllipticParameters { semi_axis_x, semi_axis_y, normal_force, ..parameters })
        }
    }
}

fn element(input: &Input) -> Element {
    match input {
        Input::Flat(parameters) => Element::rounded_flat(parameters, Directions::Two, NormalInput::Force),
        Input::Ellipse(parameters) => Element::elliptic(parameters, Directions::Two, NormalInput::Force),
    }
    .expect("an element")
}

/// Contacts and the rows of the table in which they are.
const CONTACTS: [&str; 7] =
    ["a/b = 0", "a/b = 0.001", "a/b = 0.1 to 0.97", "sphere", "ellipse 3:1", "linear layer", "rough layer"];

/// Every case of a row of the table.
fn cases(row: usize) -> Vec<Case> {
    let none = Layer::none();
    let sphere = [5e-4; 2];
    let contacts: Vec<(String, Input)> = match row {
        0 => vec![("0".to_owned(), flat(0.0, none))],
        1 => vec![("0.001".to_owned(), flat(0.001, none))],
        2 => [0.1, 0.5, 0.9, 0.97].map(|ratio| (ratio.to_string(), flat(ratio, none))).into(),
        3 => vec![("sphere".to_owned(), ellipse(sphere, none))],
        4 => vec![("ellipse".to_owned(), ellipse([9e-4, 3e-4], none))],
        _ => {
            let of = |input: &dyn Fn(Layer) -> Input, name: &str| {
                // As compliant as the contact; rough: N_c = N/100.
                let compliance = 1.0 / element(&input(none)).tangential_stiffness;
                let layer = Layer {
                    tangential_compliance: compliance,
                    normal_compliance: 0.6 * compliance,
                    stiffening_load: if row == 5 { 0.0 } else { 0.01 * LARGEST_LOAD },
                    reference_load: LARGEST_LOAD,
                };
                (format!("{name} {}", CONTACTS[row]), input(layer))
            };
            vec![
                of(&|layer| flat(0.0, layer), "0"),
                of(&|layer| flat(0.9, layer), "0.9"),
                of(&|layer| ellipse(sphere, layer), "sphere"),
            ]
        }
    };
    // A few motions of each kind are enough with layers.
    let motions = MOTIONS.into_iter().enumerate().filter(|(number, _)| row < 5 || number % 2 == 0);
    let motions: Vec<Motion> = motions.map(|(_, motion)| motion).collect();
    let of = |(contact, input): (String, Input)| {
        motions.iter().map(move |motion| Case { contact: contact.clone(), input, motion: *motion }).collect::<Vec<_>>()
    };
    contacts.into_iter().flat_map(of).collect()
}

impl Case {
    fn path(&self, element: &Element) -> Vec<[f64; 3]> {
        let slip = FRICTION * element.shift_under(LARGEST_LOAD);
        self.motion.path().into_iter().map(|[u, v, load]| [slip * u, slip * v, LARGEST_LOAD * load]).collect()
    }

    /// Forces of the counted period, each with the energy since the one before.
    fn counted(points: &[Point]) -> Vec<Point> {
        let sum = |points: &[Point]| Point {
            force: points[points.len() - 1].force,
            dissipated: points.iter().map(|point| point.dissipated).sum(),
        };
        points[points.len() - PERIOD as usize..].chunks(EVERY as usize).map(sum).collect()
    }

    /// The law by parameters for a multiple of the largest load.
    fn law(&self, factor: f64) -> Vec<Point> {
        let element = element(&at_load(&self.input, factor * LARGEST_LOAD));
        Case::counted(&drive(&element, self.path(&element).into_iter()))
    }

    fn solve(&self) -> Vec<Point> {
        let contact = Contact::new(&self.input, LARGEST_LOAD, self.motion.springs());
        let points = contact.solve(&self.path(&element(&self.input)), STEPS);
        let point =
            |point: &reference::two_directions::Point| Point { force: point.force, dissipated: point.dissipated };
        Case::counted(&points.iter().map(point).collect::<Vec<_>>())
    }

    /// A row of the file.
    fn row(&self) -> String {
        let points = self.solve();
        let energy: f64 = points.iter().map(|point| point.dissipated).sum();
        let force = points.iter().flat_map(|point| point.force).map(|force| format!(",{:.5}", force / SLIP_FORCE));
        format!("{},{},{energy:.5e}{}\n", self.contact, self.motion.name(), force.collect::<String>())
    }

    /// The forces of a row of the file, and the energy in the first one of them.
    fn read(&self, row: &golden::Row) -> Option<Vec<Point>> {
        let known = row.text("contact") == self.contact && row.text("motion") == self.motion.name();
        let force = |i: u32| ["x", "y"].map(|k| SLIP_FORCE * row[&*format!("{k}{i}")]);
        let dissipated = |i: u32| if i == 0 { row["energy"] } else { 0.0 };
        known.then(|| (0..INSTANTS).map(|i| Point { force: force(i), dissipated: dissipated(i) }).collect())
    }
}

/// Prints the file, computed by a thread for each row of the table.
pub fn print_reference() {
    let places = (0..INSTANTS).map(|i| format!(",x{i},y{i}"));
    println!("contact,motion,energy{}", places.collect::<String>());
    let rows = |contact: usize| cases(contact).iter().map(Case::row).collect::<String>();
    thread::scope(|scope| {
        let threads: Vec<_> = (0..CONTACTS.len()).map(|contact| scope.spawn(move || rows(contact))).collect();
        threads.into_iter().for_each(|thread| print!("{}", thread.join().expect("rows")));
    });
}

/// Columns of the table.
const GROUPS: [&str; 6] = [
    "circles 0.05, 0.1",
    "circles 0.3 to 1.3",
    "ellipses",
    "lines, load varies",
    "circles, load varies",
    "static shear",
];

/// Errors of the force over the largest μN, and of the energy over its value, in the columns of the table.
type Errors = [[f64; 2]; GROUPS.len()];

pub struct Comparison {
    errors: [Errors; CONTACTS.len()],
    /// The worst errors of all contacts by parameters for a larger load.
    other_load: Errors,
    results: Vec<Result<(), String>>,
}

fn worse(worst: &mut [f64; 2], [force, energy]: [f64; 2]) {
    worst[0] = worst[0].max(force);
    worst[1] = if energy.abs() > worst[1].abs() { energy } else { worst[1] };
}

impl Comparison {
    pub fn new() -> Comparison {
        let mut rows = golden::table("two_directions_reference").into_iter();
        let mut comparison = Comparison { errors: Default::default(), other_load: Default::default(), results: vec![] };
        for contact in 0..CONTACTS.len() {
            for case in &cases(contact) {
                let name = format!("{}, {}", case.contact, case.motion.name());
                let Some(solved) = rows.next().and_then(|row| case.read(&row)) else {
                    comparison.results.push(Err(format!("{name}: another row of the reference")));
                    return comparison;
                };
                let (law, group) = (case.law(1.0), case.motion.group());
                let errors = difference(&law, &solved, SLIP_FORCE);
                worse(&mut comparison.errors[contact][group], errors);
                let other = difference(&case.law(OTHER_LOAD), &solved, SLIP_FORCE);
                worse(&mut comparison.other_load[group], other);
                if (contact, case.motion) == COMPUTED_AGAIN {
                    let [force, energy] = difference(&case.solve(), &solved, SLIP_FORCE);
                    let holds = force < PRINTED && energy.abs() < PRINTED;
                    comparison.results.push(if holds {
                        Ok(())
                    } else {
                        Err(format!("{name}: the reference has changed"))
                    });
                }
            }
        }
        comparison
    }

    /// The checks, a message for each that fails.
    pub fn results(&self) -> Vec<Result<(), String>> {
        let mut results = self.results.clone();
        let mut check =
            |name: &str, group: usize, [force, energy]: [f64; 2], [largest_force, largest_energy]: [f64; 2]| {
                let holds = force <= largest_force && energy.abs() <= largest_energy;
                let message = || format!("{name}, {}: errors {force:.1e}, {energy:.1e}", GROUPS[group]);
                results.push(if holds { Ok(()) } else { Err(message()) });
            };
        for (contact, errors) in self.errors.iter().enumerate() {
            for (group, errors) in errors.iter().enumerate() {
                check(CONTACTS[contact], group, *errors, bounds(contact, group));
            }
        }
        for (group, errors) in self.other_load.iter().enumerate() {
            check("parameters of another load", group, *errors, bounds(CONTACTS.len() - 1, group));
        }
        results
    }

    pub fn table(&self) -> String {
        let heads = GROUPS.map(|group| format!(" {group} |")).concat();
        let mut table = format!("| contact |{heads}\n|---|{}\n", "---:|".repeat(GROUPS.len()));
        let mut add = |contact: &str, errors: &Errors| {
            let cells = errors.map(|[force, energy]| format!(" {}, {} |", percent(force), signed(energy)));
            writeln!(table, "| {contact} |{}", cells.concat()).expect("a string");
        };
        CONTACTS.iter().zip(&self.errors).for_each(|(contact, errors)| add(contact, errors));
        add(&format!("all, parameters of {OTHER_LOAD} times the load"), &self.other_load);
        table
    }
}

/// The load of other parameters over the largest one: nodes follow the load, not the parameters.
const OTHER_LOAD: f64 = 3.0;
/// A cheap case with a load that varies, which each run computes again; five digits are printed.
const COMPUTED_AGAIN: (usize, Motion) = (4, Motion::Shear(0.5));
const PRINTED: f64 = 2e-5;

/// Bounds on the errors of force and energy. On a line N(S) is a polygon of the shells: N'' of a sphere rises to infinity at S = 0, and the
/// knee of a rough layer is at 1 % of the load. In the plane each shell has one point, and in the
/// smallest circles one or two shells slip. The energy of steps beside static shear lacks the change of the stiffness with the load.
fn bounds(contact: usize, group: usize) -> [f64; 2] {
    let of_line = [0.004, 0.004, 0.004, 0.01, 0.01, 0.01, 0.015][contact];
    [[0.001, 0.08], [0.008, 0.04], [0.008, 0.04], [of_line, 0.02], [0.008, 0.04], [0.005, 0.3]][group]
}
