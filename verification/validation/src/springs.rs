//! The law for two directions against a solution of its equations with many springs and small steps,
//! `tests/golden/two_directions_reference.csv`.

use crate::PAGE;
use crate::documents::Documents;
use crate::golden::{Row, table};
use crate::two_directions::{Point, difference, drive, percent, signed, sums, worse};
use microslip::element::{Directions, Element, NormalInput};
use microslip::parameters::CENTRE_POINT;
use microslip::{EllipticParameters, Layer, Material, Parameters};
use reference::family::load_of_size;
use std::f64::consts::{PI, TAU};

/// A motion of a contact, by its row of the file: their names are followed by numbers.
struct Case {
    row: Row,
    contact: &'static str,
    motion: &'static str,
    numbers: Vec<f64>,
}

/// Rows of a period, of which the second one counts, and of its beginning.
const PERIOD: u32 = 48;
const ENTRY: u32 = 6;
/// Forces are compared at every second row of the period.
const EVERY: u32 = 2;
const INSTANTS: u32 = PERIOD / EVERY;
const LARGEST_LOAD: f64 = 1000.0;
const FRICTION: f64 = 0.5;
const SLIP_FORCE: f64 = FRICTION * LARGEST_LOAD;
const BODY: Material = Material { young_modulus: 2e11, poisson_ratio: 0.3 };

/// The contact of a shape, by parameters for a multiple of the largest load. The half-width of a flat of a/b is 0.5 mm under the
/// largest load.
fn element(shape: &str, layer: Layer, factor: f64) -> Element {
    let (normal_force, friction_coefficient, material) = (factor * LARGEST_LOAD, FRICTION, [BODY; 2]);
    let semi_axes: [f64; 2] = match shape {
        "sphere" => [5e-4; 2],
        "ellipse" => [9e-4, 3e-4],
        ratio => {
            let (b, length, ratio) = (5e-4, 3.25e-3, ratio.parse::<f64>().expect("a/b"));
            let modulus = 0.5 * BODY.young_modulus / (1.0 - BODY.poisson_ratio.powi(2));
            let size = b * b * load_of_size(ratio, (1.0 - ratio * ratio).sqrt());
            let parameters = Parameters {
                flat_half_width: ratio * b,
                edge_radius: modulus * length * size / (4.0 * LARGEST_LOAD),
                length,
                normal_force,
                friction_coefficient,
                displacement_reference: CENTRE_POINT,
                material,
                layer,
                ..Parameters::default()
            };
            return Element::rounded_flat(&parameters, Directions::Two, NormalInput::Force).expect("an element");
        }
    };
    let [semi_axis_x, semi_axis_y] = semi_axes.map(|axis| factor.cbrt() * axis);
    let parameters =
        EllipticParameters { semi_axis_x, semi_axis_y, normal_force, friction_coefficient, material, layer };
    Element::elliptic(&parameters, Directions::Two, NormalInput::Force).expect("an element")
}

/// Rows of the table.
const CONTACTS: [&str; 7] =
    ["a/b = 0", "a/b = 0.001", "a/b = 0.1 to 0.97", "sphere", "ellipse 3:1", "linear layer", "rough layer"];

/// All rows of the file, which the contacts with layers have for a few motions of each kind only.
fn cases() -> Vec<Case> {
    let case = |row: Row| {
        let mut words = row.text("motion").split(' ');
        let motion = words.next().expect("a motion");
        let numbers = words.map(|word| word.parse().expect("a number")).collect();
        Case { contact: row.text("contact"), row, motion, numbers }
    };
    table("two_directions_reference").into_iter().map(case).collect()
}

impl Case {
    /// The row of the table.
    fn group_of_contact(&self) -> usize {
        match self.contact {
            "0" => 0,
            "0.001" => 1,
            "sphere" => 3,
            "ellipse" => 4,
            layered if layered.ends_with("linear layer") => 5,
            layered if layered.ends_with("rough layer") => 6,
            _ => 2,
        }
    }

    /// The column of the table.
    fn group_of_motion(&self) -> usize {
        match self.motion {
            "circle" if self.numbers[0] >= 0.3 => 2,
            "circle" => usize::from(![0.05, 0.1].contains(&self.numbers[0])),
            "ellipse" => 3,
            "line" => 4,
            "varying" => 5,
            _ => 6,
        }
    }

    /// u, v and N, from a sticking contact on. Amplitudes are in units of the displacement of gross slip across the line.
    fn path(&self, element: &Element) -> Vec<[f64; 3]> {
        let load = |variation: f64, angle: f64| 1.0 - 0.5 * variation * (1.0 - angle.cos());
        let at = |t: f64| match (self.motion, &self.numbers[..]) {
            ("circle", &[radius]) => [radius * t.cos(), radius * t.sin(), 1.0],
            // 3:1, the long axis at 30°.
            ("ellipse", &[radius]) => {
                let (sin, cos) = (PI / 6.0).sin_cos();
                let [long, short] = [radius * t.cos(), radius / 3.0 * t.sin()];
                [long * cos - short * sin, long * sin + short * cos, 1.0]
            }
            // At an angle in degrees; neither displacement nor load has a period.
            ("line", &[degrees]) => {
                let (along, (sin, cos)) = (0.6 * t.cos() + 0.3 * (0.6 * t).sin(), degrees.to_radians().sin_cos());
                [along * cos, along * sin, load(0.95, 1.7 * t)]
            }
            // A circle while the load varies with this order and phase in degrees.
            ("varying", &[radius, order, phase]) => {
                [radius * t.cos(), radius * t.sin(), load(0.95, order * t + phase.to_radians())]
            }
            // A displacement along x beside a vibration along y, while the load varies by this part.
            ("shear", &[variation]) => [0.4, 0.3 * t.sin(), load(variation, 2.0 * t)],
            _ => panic!("{:?}: no motion", self.row),
        };
        let [u, v, load] = at(0.0);
        let entry = (0..ENTRY).map(|i| f64::from(i) / f64::from(ENTRY)).map(|part| [part * u, part * v, load]);
        let periods = (0..=2 * PERIOD).map(|i| at(TAU * f64::from(i) / f64::from(PERIOD)));
        let slip = FRICTION * element.shift_under(LARGEST_LOAD);
        entry.chain(periods).map(|[u, v, load]| [slip * u, slip * v, LARGEST_LOAD * load]).collect()
    }

    /// Forces of the counted period, each with the energy since the one before.
    fn counted(points: &[Point]) -> Vec<Point> {
        sums(&points[points.len() - PERIOD as usize..], EVERY as usize)
    }

    /// The law by parameters for a multiple of the largest load.
    fn law(&self, factor: f64) -> Vec<Point> {
        let (shape, kind) = self.contact.split_once(' ').unwrap_or((self.contact, ""));
        let mut layer = Layer::none();
        if !kind.is_empty() {
            // As compliant as the contact; rough: N_c = N/100.
            let compliance = 1.0 / element(shape, layer, 1.0).tangential_stiffness;
            layer = Layer {
                tangential_compliance: compliance,
                normal_compliance: 0.6 * compliance,
                stiffening_load: if kind == "rough layer" { 0.01 * LARGEST_LOAD } else { 0.0 },
                reference_load: LARGEST_LOAD,
            };
        }
        let element = element(shape, layer, factor);
        Case::counted(&drive(&element, self.path(&element).into_iter()))
    }

    /// The forces of the row, and the energy in the first one of them.
    fn solved(&self) -> Vec<Point> {
        let force = |i: u32| ["x", "y"].map(|k| SLIP_FORCE * self.row[&*format!("{k}{i}")]);
        let dissipated = |i: u32| if i == 0 { self.row["energy"] } else { 0.0 };
        (0..INSTANTS).map(|i| Point { force: force(i), dissipated: dissipated(i) }).collect()
    }
}

/// Columns of the table.
const GROUPS: [&str; 7] = [
    "circles 0.05, 0.1",
    "circles 0.06 to 0.2",
    "circles 0.3 to 1.3",
    "ellipses",
    "lines, load varies",
    "circles, load varies",
    "static shear",
];
/// Number of the rows of the file.
const ROWS: usize = 288;
/// The load of other parameters over the largest one: nodes follow the load, not the parameters.
const OTHER_LOAD: f64 = 3.0;
/// Bounds on the errors of force and energy. On a line N(S) is a polygon of the shells: N'' of a sphere rises to infinity at S = 0,
/// and the knee of a rough layer is at 1 % of the load. In the plane each shell has one point, and in the smallest circles one or
/// two shells slip. The energy of steps beside static shear lacks the change of the stiffness with the load.
fn bounds(contact: usize, motion: usize) -> [f64; 2] {
    // The last row is that of all contacts by parameters for a larger load.
    let of_line = [0.004, 0.004, 0.004, 0.01, 0.01, 0.01, 0.015, 0.015][contact];
    let of_rough_layer = if contact < 6 { 0.008 } else { 0.012 };
    let of_circle = [[0.001, 0.08], [0.004, 0.18], [of_rough_layer, 0.04]];
    let of_others = [[0.008, 0.04], [of_line, 0.02], [0.008, 0.04], [0.005, 0.4]];
    of_circle.into_iter().chain(of_others).nth(motion).expect("a column")
}

/// The checks, and the table.
pub fn compare(documents: &mut Documents) {
    // Errors of the force over the largest μN, and of the energy over its value.
    let mut errors = [[[0.0; 2]; GROUPS.len()]; CONTACTS.len() + 1];
    let cases = cases();
    for case in &cases {
        let (solved, motion) = (case.solved(), case.group_of_motion());
        for (contact, factor) in [(case.group_of_contact(), 1.0), (CONTACTS.len(), OTHER_LOAD)] {
            worse(&mut errors[contact][motion], difference(&case.law(factor), &solved, SLIP_FORCE));
        }
    }
    documents.check(cases.len() == ROWS, format!("{} rows instead of {ROWS}", cases.len()));
    let heads = GROUPS.map(|group| format!(" {group} |")).concat();
    let mut table = format!("| contact |{heads}\n|---|{}\n", "---:|".repeat(GROUPS.len()));
    let other = format!("all, parameters of {OTHER_LOAD} times the load");
    for (contact, (name, errors)) in CONTACTS.into_iter().chain([&*other]).zip(errors).enumerate() {
        for (motion, [force, energy]) in errors.into_iter().enumerate() {
            let [largest_force, largest_energy] = bounds(contact, motion);
            let holds = force <= largest_force && energy.abs() <= largest_energy;
            documents.check(holds, format!("{name}, {}: errors {force:.1e}, {energy:.1e}", GROUPS[motion]));
        }
        let cells = errors.map(|[force, energy]| format!(" {}, {} |", percent(force), signed(energy)));
        table += &format!("| {name} |{}\n", cells.concat());
    }
    documents.table(PAGE, "equations in two directions", &table);
}
