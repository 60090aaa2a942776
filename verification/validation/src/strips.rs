//! Strips of finite length: the centre point of the paper and `MSLIP_RIGID_STRIP` against boundary elements in three dimensions
//! (`tests/golden/strip_3d.csv`), which agree with CONTACT to 0.14 % (`strip_3d_contact.csv`).

use crate::PAGE;
use crate::documents::Documents;
use crate::golden::{Row, table};
use microslip::parameters::{CENTRE_POINT, RIGID_STRIP};
use microslip::{Contact, Material, Parameters};
use std::f64::consts::PI;

const POISSON_RATIO: f64 = 0.3;
/// T/(mu N) in the names of the columns; the energies begin with the second one.
const LEVELS: [(&str, f64); 4] = [("0.3", 0.3), ("0.6", 0.6), ("0.9", 0.9), ("0.98", 0.98)];

/// Errors of the law in per cent.
#[derive(Clone, Copy)]
struct Range(f64, f64);

impl Range {
    fn of(errors: impl Iterator<Item = f64>) -> Range {
        errors.fold(Range(f64::INFINITY, f64::NEG_INFINITY), |range, x| Range(range.0.min(x), range.1.max(x)))
    }

    fn within(self, low: f64, high: f64) -> bool {
        low <= self.0 && self.1 <= high
    }
}

/// Errors over all shapes of one length, up to 0.98 mu N unless it is the onset of gross slip.
struct Errors {
    aspect_ratio: f64,
    centre_point: Range,
    rigid_strip: Range,
    onset: Range,
    energy: Range,
}

/// A strip of half-width 1. The units are such that 2 mu P/(pi E*) and E* are 1, and energies are per mu N.
fn contact(aspect_ratio: f64, a: f64, displacement_reference: i32) -> Contact {
    let w = ((1.0 - a) * (1.0 + a)).sqrt();
    let g = 2.0 * w.atan2(a) - 2.0 * a * w;
    let length = 2.0 * aspect_ratio;
    let normal_force = PI * length;
    let young_modulus = 2.0 * (1.0 - POISSON_RATIO * POISSON_RATIO);
    let parameters = Parameters {
        flat_half_width: a,
        edge_radius: g * length / (4.0 * normal_force),
        length,
        normal_force,
        friction_coefficient: 0.5,
        material: [Material { young_modulus, poisson_ratio: POISSON_RATIO }; 2],
        displacement_reference,
        ..Parameters::default()
    };
    Contact::rounded_flat(&parameters).expect("a contact")
}

/// The rows of the true pressure, which are those that the law describes, one length after the other.
fn errors() -> Vec<Errors> {
    let rows = table("strip_3d");
    let rows = rows.iter().filter(|row| row.text("variant") == "ii" && row["nu"] == POISSON_RATIO);
    let per_cent = |law: f64, elements: f64| 100.0 * (law / elements - 1.0);
    let of_length = |aspect_ratio: f64| {
        let rows: Vec<&Row> = rows.clone().filter(|row| row["AR"] == aspect_ratio).collect();
        assert_eq!(rows.len(), 3, "a cylinder and two flats");
        let displacement = |reference: i32| {
            Range::of(rows.iter().flat_map(|row| {
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
        let energy = |row| {
            let contact = strip(row);
            LEVELS[1..].iter().map(move |(name, level)| {
                let energy = contact.dissipated_energy(level * contact.slip_force).expect("an energy");
                per_cent(energy / contact.slip_force, row[&format!("W3D_{name}")[..]])
            })
        };
        Errors {
            aspect_ratio,
            centre_point: displacement(CENTRE_POINT),
            rigid_strip: displacement(RIGID_STRIP),
            onset: Range::of(rows.iter().map(|row| per_cent(strip(row).slip_displacement, row["d3D_1"]))),
            energy: Range::of(rows.iter().copied().flat_map(energy)),
        }
    };
    [2.5, 5.0, 10.0, 20.0].into_iter().map(of_length).collect()
}

/// Errors of the law in per cent against CONTACT itself: of short strips, and of slender ones.
fn errors_by_contact() -> [Range; 2] {
    let rows = table("strip_3d_contact");
    [true, false].map(|is_short| {
        Range::of(rows.iter().filter(|row| row.text("variant") == "ii").filter_map(|row| {
            let [aspect_ratio, a, nu, tau, elements] = ["AR", "a", "nu", "tau", "delta_CONTACT"].map(|name| row[name]);
            let contact = contact(aspect_ratio, a, RIGID_STRIP);
            let point = contact.curve_at_force(tau * contact.slip_force).expect("a point");
            let is_of_range = nu == POISSON_RATIO && (aspect_ratio < 5.0) == is_short;
            is_of_range.then(|| 100.0 * (point.displacement() / elements - 1.0))
        }))
    })
}

/// The table, and the checks of what the documents state.
pub fn compare(documents: &mut Documents) {
    let mut table = String::from(
        "| L/2b | displacement, centre point | displacement, rigid strip | onset of gross slip | energy |\n\
         |---:|---:|---:|---:|---:|\n",
    );
    for errors in errors() {
        let Errors { aspect_ratio, centre_point, rigid_strip, onset, energy } = errors;
        let range = |Range(low, high): Range, digits: usize| format!("{low:+.digits$} to {high:+.digits$}");
        let cells = [range(centre_point, 1), range(rigid_strip, 2), range(onset, 1), range(energy, 1)];
        table += &format!("| {aspect_ratio} | {} |\n", cells.join(" | "));
        let slender = aspect_ratio >= 5.0;
        let holds = centre_point.within(7.0, 13.0)
            && rigid_strip.within(if slender { -0.5 } else { -1.8 }, 0.5)
            && (!slender || energy.within(-7.0, 7.0) && onset.within(-6.0, -3.5));
        documents.check(holds, format!("strips of L/2b = {aspect_ratio}: {cells:?}"));
    }
    for (range, bound) in errors_by_contact().into_iter().zip([1.54, 0.44]) {
        let holds = range.within(-bound, bound) && range.0 <= range.1;
        documents.check(holds, format!("strips by CONTACT: {} to {} %", range.0, range.1));
    }
    documents.table(PAGE, "strips", &table);
}
