//! Tractions of a cylinder on a flat by a finite-element model (`tests/golden/abaqus_mindlin.csv`), loaded and unloaded.

use crate::PAGE;
use crate::documents::Documents;
use crate::golden::{Row, table};
use microslip::constant_load::{ConstantLoad, Law, masing, state};
use microslip::{Contact, Material, Parameters};
use std::f64::consts::PI;

const FRICTION: f64 = 0.6;
/// Tangential force at the end of loading, over mu N.
const LOADED: f64 = 0.5;
/// Spacing of the nodes over the half-width.
const SPACING: f64 = 0.11;

/// A cylinder of half-width 1 and largest pressure 1.
fn contact() -> Contact {
    let length = 50.0;
    let parameters = Parameters {
        flat_half_width: 0.0,
        edge_radius: 1.0,
        length,
        normal_force: 0.5 * PI * length,
        friction_coefficient: FRICTION,
        // E* = 2: b² = 4 N R/(pi E* L).
        material: [Material { young_modulus: 4.0, poisson_ratio: 0.0 }; 2],
        displacement_reference: microslip::parameters::CENTRE_POINT,
        ..Parameters::default()
    };
    Contact::rounded_flat(&parameters).expect("a contact")
}

/// Largest differences of a case in per cent, of pressures over the largest one, and of shear tractions over mu times that: those
/// of nodes away from edges of contact and stick, and then those of all nodes in the contact.
fn differences(unloaded: bool) -> [f64; 4] {
    let contact = contact();
    let at = |force: f64| contact.curve_at_force(force * contact.slip_force).expect("below gross slip");
    // Masing's rule: half of the change of force is that of the curve.
    let (top, half) = (at(LOADED), at(0.5 * LOADED));
    let mut memory = vec![0.0; state::state_length(4)];
    ConstantLoad::state_init(&mut memory).expect("a state");
    let mut advance = |to: f64| ConstantLoad::step(&contact, &mut memory, to).expect("a step");
    advance(top.displacement());
    let mut edges = vec![contact.half_width, top.stick_half_width()];
    if unloaded {
        advance(top.displacement() - 2.0 * half.displacement());
        edges.push(half.stick_half_width());
    }
    // Loaded (1) or unloaded again (2).
    let is_of_case = |node: &Row| (node["case"] == 2.0) == unloaded && node["x_over_a"].abs() < 1.0;
    let nodes: Vec<Row> = table("abaqus_mindlin").into_iter().filter(is_of_case).collect();
    let x: Vec<f64> = nodes.iter().map(|node| node["x_over_a"] * contact.half_width).collect();
    let mut shear = vec![0.0; x.len()];
    masing::shear_tractions(&contact, &memory, &x, &mut shear).expect("a state");
    let largest = contact.pressure(0.0);
    let mut found = [0.0_f64; 4];
    for ((node, &x), shear) in nodes.iter().zip(&x).zip(shear) {
        let is_away = edges.iter().all(|edge| (x.abs() - edge).abs() > 2.0 * SPACING * contact.half_width);
        let pressure = node["p_over_p0"] - contact.pressure(x) / largest;
        for (i, difference) in [pressure, (node["q_over_p0"] - shear / largest) / FRICTION].into_iter().enumerate() {
            let difference = 100.0 * difference.abs();
            found[i] = found[i].max(if is_away { difference } else { 0.0 });
            found[2 + i] = found[2 + i].max(difference);
        }
    }
    found
}

/// The table of the page, and the checks.
pub fn compare(documents: &mut Documents) {
    let mut table = String::from(
        "| state | pressure | shear | pressure, all nodes | shear, all nodes |\n|---|---:|---:|---:|---:|\n",
    );
    for (unloaded, name) in [(false, "loaded to T = 0.5 μN"), (true, "unloaded to T = 0")] {
        let found = differences(unloaded);
        let [pressure, shear, all_pressures, all_shears] = found;
        table += &format!("| {name} | {pressure:.2} | {shear:.2} | {all_pressures:.1} | {all_shears:.1} |\n");
        // Away from edges: what its authors' mesh leaves of the peak pressure, and slip by the penalty of its contact. At an edge a
        // node has the mean over its spacing h of a traction that falls like c (1 - x²/c²)^(1/2): about half of c (h/c)^(1/2) =
        // 0.28.
        let holds = found.iter().zip([0.3, 0.6, 14.0, 14.0]).all(|(difference, bound)| *difference <= bound);
        documents.check(holds, format!("finite elements, {name}: {found:?}"));
    }
    documents.table(PAGE, "finite elements", &table);
}
