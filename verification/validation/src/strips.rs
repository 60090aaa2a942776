//! Strips of finite length: the centre point of the paper and `MSLIP_RIGID_STRIP` against boundary elements in three dimensions
//! (`tests/golden/strip_3d.csv`), which agree with CONTACT to 0.14 % (`strip_3d_contact.csv`).

use crate::PAGE;
use crate::documents::Documents;
use crate::golden::{Row, table};
use microslip::parameters::{CENTRE_POINT, RIGID_STRIP};
use microslip::{Contact, Material, Parameters};
use reference::family::load_of_size;
use std::f64::consts::PI;

const POISSON_RATIO: f64 = 0.3;
/// T/(mu N) in the names of the columns; the energies begin with the second one.
const LEVELS: [(&str, f64); 4] = [("0.3", 0.3), ("0.6", 0.6), ("0.9", 0.9), ("0.98", 0.98)];

/// The range of errors.
type Range = [f64; 2];

pub fn range(errors: impl Iterator<Item = f64>) -> Range {
    errors.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}

fn within([low, high]: Range, least: f64, most: f64) -> bool {
    least <= low && low <= high && high <= most
}

/// A strip of half-width 1. The units are such that 2 mu P/(pi E*) and E* are 1, and energies are per mu N.
pub fn parameters(aspect_ratio: f64, a: f64, displacement_reference: i32) -> Parameters {
    let g = load_of_size(a, ((1.0 - a) * (1.0 + a)).sqrt());
    let length = 2.0 * aspect_ratio;
    let normal_force = PI * length;
    let young_modulus = 2.0 * (1.0 - POISSON_RATIO * POISSON_RATIO);
    Parameters {
        flat_half_width: a,
        edge_radius: g * length / (4.0 * normal_force),
        length,
        normal_force,
        friction_coefficient: 0.5,
        material: [Material { young_modulus, poisson_ratio: POISSON_RATIO }; 2],
        displacement_reference,
        ..Parameters::default()
    }
}

fn contact(aspect_ratio: f64, a: f64, displacement_reference: i32) -> Contact {
    Contact::rounded_flat(&parameters(aspect_ratio, a, displacement_reference)).expect("a contact")
}

/// The errors of the law against boundary elements, `law/elements - 1`.
fn per_cent(law: f64, elements: f64) -> f64 {
    100.0 * (law / elements - 1.0)
}

/// The table, and the checks of what the documents state: a row for each length. The rows of the true pressure are those that the
/// law describes. Displacements are compared up to 0.98 mu N, apart from that of gross slip.
pub fn compare(documents: &mut Documents) {
    let mut text = String::from(
        "| L/2b | displacement, centre point | displacement, rigid strip | onset of gross slip | energy |\n\
         |---:|---:|---:|---:|---:|\n",
    );
    let is_described = |row: &Row| row.text("variant") == "ii" && row["nu"] == POISSON_RATIO;
    let rows: Vec<Row> = table("strip_3d").into_iter().filter(is_described).collect();
    for aspect_ratio in [2.5, 5.0, 10.0, 20.0] {
        let rows: Vec<&Row> = rows.iter().filter(|row| row["AR"] == aspect_ratio).collect();
        assert_eq!(rows.len(), 3, "a cylinder and two flats");
        let displacement = |reference: i32| {
            range(rows.iter().flat_map(|row| {
                let contact = contact(aspect_ratio, row["a"], reference);
                let initial = per_cent(contact.slip_force / contact.initial_stiffness, row["C0_3D"]);
                let at = move |&(name, level): &(&str, f64)| {
                    let point = contact.curve_at_force(level * contact.slip_force).expect("a point");
                    per_cent(point.displacement(), row[&format!("d3D_{name}")[..]])
                };
                LEVELS.iter().map(at).chain([initial])
            }))
        };
        let strip = |row: &Row| contact(aspect_ratio, row["a"], RIGID_STRIP);
        let energies = rows.iter().flat_map(|row| {
            let contact = strip(row);
            LEVELS[1..].iter().map(move |(name, level)| {
                let energy = contact.dissipated_energy(level * contact.slip_force).expect("an energy");
                per_cent(energy / contact.slip_force, row[&format!("W3D_{name}")[..]])
            })
        });
        let (centre_point, rigid_strip) = (displacement(CENTRE_POINT), displacement(RIGID_STRIP));
        let onset = range(rows.iter().map(|row| per_cent(strip(row).slip_displacement, row["d3D_1"])));
        let energy = range(energies);
        let cell = |[low, high]: Range, digits: usize| format!("{low:+.digits$} to {high:+.digits$}");
        let cells = [cell(centre_point, 1), cell(rigid_strip, 2), cell(onset, 1), cell(energy, 1)];
        text += &format!("| {aspect_ratio} | {} |\n", cells.join(" | "));
        let slender = aspect_ratio >= 5.0;
        let holds = within(centre_point, 7.0, 13.0)
            && within(rigid_strip, if slender { -0.5 } else { -1.8 }, 0.5)
            && (!slender || within(energy, -7.0, 7.0) && within(onset, -6.0, -3.5));
        documents.check(holds, format!("strips of L/2b = {aspect_ratio}: {cells:?}"));
    }
    documents.table(PAGE, "strips", &text);
    // CONTACT itself: short strips, and slender ones.
    let rows: Vec<Row> = table("strip_3d_contact").into_iter().filter(is_described).collect();
    for (is_short, bound) in [(true, 1.54), (false, 0.44)] {
        let errors = range(rows.iter().filter(|row| (row["AR"] < 5.0) == is_short).map(|row| {
            let contact = contact(row["AR"], row["a"], RIGID_STRIP);
            let point = contact.curve_at_force(row["tau"] * contact.slip_force).expect("a point");
            per_cent(point.displacement(), row["delta_CONTACT"])
        }));
        documents.check(within(errors, -bound, bound), format!("strips by CONTACT: {errors:?} %"));
    }
}
