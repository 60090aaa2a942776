//! The energy per cycle of a cylinder that slides while its load swings in phase with the motion, against published measurements:
//! S. Fouvry, P. Arnaud, A. Mignot, P. Neubauer, Tribology International 113 (2017) 460-473, table 1 and appendix A.
//!
//! The tests hold the sliding amplitude: half of the opening of the loop at zero tangential force. The rig is a spring between the
//! imposed displacement and the contact; at zero force it is relaxed, so the sliding amplitude is that of the contact.
//!
//! The same contact where it opens in every cycle: B. van Peteghem, S. Fouvry, J. Petit, Wear 271 (2011) 1535-1542, table 3
//! (`tests/golden/vanpeteghem2011_energy.csv`).

use crate::documents::Documents;
use crate::golden::table;
use crate::path::Path;
use crate::{PAGE, csv};
use microslip::element::{Directions, Element, NormalInput};
use microslip::parameters::RIGID_STRIP;
use microslip::{Material, Parameters};
use std::f64::consts::TAU;

/// Largest normal force \[N\], 1066 N/mm over 8 mm.
const LARGEST: f64 = 8528.0;
/// Sliding amplitude \[m\].
const SLIDING: f64 = 75e-6;
/// Imposed amplitude \[m\] under a constant load, the mean of 120 and 125 micrometres: it gives the stiffness of the rig.
const IMPOSED: f64 = 122.5e-6;
/// Friction coefficients of all tests.
const FRICTION: [f64; 2] = [0.60, 0.65];
/// Smallest over largest load; energy per cycle \[J\], means of 5000 cycles, at 3, 1 and 0.11 Hz; and what the page says of its
/// mean over that of the computed energies: agreement under a constant load, more and more overestimation as the load swings more.
const MEASURED: [(f64, [f64; 3], [f64; 2]); 5] = [
    (0.10, [0.608, 0.616, 0.644], [0.78, 0.85]),
    (0.25, [0.780, 0.846, 0.754], [0.83, 0.89]),
    (0.50, [1.008, 1.106, 0.978], [0.86, 0.91]),
    (0.75, [1.272, 1.336, 1.200], [0.9, 0.94]),
    (1.00, [1.552, 1.658, 1.430], [0.95, 1.0]),
];
/// Steps of a cycle: energies of 720 and of 1440 steps differ by 1e-5.
const STEPS: u32 = 720;
/// Of the sliding amplitude, relative.
const CONVERGED: f64 = 1e-9;

/// A cycle of an imposed amplitude.
struct Cycle {
    imposed: f64,
    /// Half of the opening of the loop at zero force \[m\].
    sliding: f64,
    dissipated: f64,
}

fn element(edge_radius: f64, length: f64, normal_force: f64, friction_coefficient: f64) -> Element {
    let parameters = Parameters {
        flat_half_width: 0.0,
        edge_radius,
        length,
        normal_force,
        friction_coefficient,
        material: [Material { young_modulus: 119e9, poisson_ratio: 0.29 }; 2],
        displacement_reference: RIGID_STRIP,
        ..Parameters::default()
    };
    Element::rounded_flat(&parameters, Directions::One, NormalInput::Force).expect("an element")
}

/// The last of some cycles, in which displacements over the amplitude and loads over the largest one follow a function of time in
/// periods; `rig`: the compliance of the rig.
fn cycle(element: &Element, amplitude: f64, rig: f64, periods: u32, at: impl Fn(f64) -> [f64; 2]) -> Cycle {
    let mut path = Path::new(element, 64);
    let (mut imposed, mut force) = (0.0, 0.0);
    let mut cycle = Cycle { imposed: amplitude, sliding: 0.0, dissipated: 0.0 };
    for i in 1..=periods * STEPS {
        let [displacement, load] = at(f64::from(i) / f64::from(STEPS));
        let target = amplitude * displacement;
        let step = path.pull([1.0, rig], target, load * element.normal_force, 4.0 * amplitude);
        if i > (periods - 1) * STEPS {
            cycle.dissipated += step.dissipated;
            if (step.force[0] > 0.0) != (force > 0.0) {
                let crossing = imposed + (target - imposed) * force / (force - step.force[0]);
                cycle.sliding += 0.5 * crossing * force.signum();
            }
        }
        (imposed, force) = (target, step.force[0]);
    }
    cycle
}

/// The steady cycle of an amplitude. `ratio`: smallest over largest load.
fn steady(element: &Element, ratio: f64, amplitude: f64, rig: f64) -> Cycle {
    let at = |t: f64| [(TAU * t).sin(), 0.5 * (1.0 + ratio + (1.0 - ratio) * (TAU * t).sin())];
    cycle(element, amplitude, rig, 2, at)
}

/// A cycle in which load and displacement rise together from 0, and fall together to 0: the contact opens.
fn opening_cycle(element: &Element, amplitude: f64) -> Cycle {
    cycle(element, amplitude, 0.0, 1, |t| [4.0 * t.min(1.0 - t), 2.0 * t.min(1.0 - t)])
}

/// The cycle of a sliding amplitude, by the secant method.
fn sliding_by(sliding: f64, at: impl Fn(f64) -> Cycle) -> Cycle {
    let (mut previous, mut now) = (at(1.3 * sliding), at(1.7 * sliding));
    while (now.sliding / sliding - 1.0).abs() > CONVERGED {
        let slope = (now.imposed - previous.imposed) / (now.sliding - previous.sliding);
        let next = at(now.imposed + (sliding - now.sliding) * slope);
        (previous, now) = (now, next);
    }
    now
}

/// Friction coefficient of the tests in which the contact opens, "about 0.7".
const FRICTION_OF_OPENING: f64 = 0.7;

/// The table of the tests in which the contact opens, and the checks of what the page says.
pub fn opening(documents: &mut Documents) {
    let mut text = String::from(
        "| test | load | Hz | sliding stroke, μm | measured | computed | measured/computed |\n|---:|---|---:|---:|---:|---:|---:|\n",
    );
    let element = element(80e-3, 8e-3, 8523.0, FRICTION_OF_OPENING);
    for row in table("vanpeteghem2011_energy") {
        let (opens, stroke, number) = (row.text("normal_force") == "variable", row["stroke_um"], row.text("test"));
        let computed = sliding_by(0.5e-6 * stroke, |amplitude| match opens {
            true => opening_cycle(&element, amplitude),
            false => steady(&element, 1.0, amplitude, 0.0),
        });
        let measured = row["energy_J"] / row["cycles"];
        let share = measured / computed.dissipated;
        let (load, frequency, energy) =
            (if opens { "opens" } else { "constant" }, row["frequency_Hz"], computed.dissipated);
        text +=
            &format!("| {number} | {load} | {frequency} | {stroke:.0} | {measured:.2} | {energy:.2} | {share:.2} |\n");
        let range = match (opens, number) {
            (true, _) => 0.70..1.13,
            (false, "6") => 1.3..1.4,
            (false, _) => 0.69..0.93,
        };
        documents.check(range.contains(&share), format!("table 3, test {number}: {share} of the energy"));
    }
    documents.page("opening.csv", |_| Ok(csv(&text)));
}

/// The checks, and the table of the page, with energies for both friction coefficients.
pub fn compare(documents: &mut Documents) {
    let elements = FRICTION.map(|mu| element(80e-3, 8e-3, LARGEST, mu));
    let held = |element: &Element, ratio: f64, rig: f64| {
        sliding_by(SLIDING, |amplitude| steady(element, ratio, amplitude, rig))
    };
    let rigs = elements
        .each_ref()
        .map(|element| (IMPOSED - held(element, 1.0, 0.0).imposed) / (element.friction_coefficient * LARGEST));
    let half_width = elements[0].half_width_under(LARGEST);
    // The authors give 1.29 mm.
    documents.check((half_width - 1.29e-3).abs() < 0.005e-3, format!("fretting: half-width {half_width:e}"));
    let mut text = String::from(
        "| N_min/N_max | measured: 3 Hz | 1 Hz | 0.11 Hz | computed | rigid | measured/computed |\n\
         |---:|---:|---:|---:|---:|---:|---:|\n",
    );
    for (ratio, measured, [least, most]) in MEASURED {
        let computed = [0, 1].map(|i: usize| held(&elements[i], ratio, rigs[i]).dissipated);
        let share = measured.iter().sum::<f64>() / 3.0 / (0.5 * (computed[0] + computed[1]));
        documents.check((least..=most).contains(&share), format!("fretting, ratio {ratio}: {share} of the energy"));
        // A rigid contact: 4 mu N SLIDING with the mean load.
        let rigid = FRICTION.map(|mu| 2.0 * mu * LARGEST * (1.0 + ratio) * SLIDING);
        let band = |[low, high]: [f64; 2]| format!("{low:.2} to {high:.2}");
        let measured = measured.map(|energy| format!("{energy:.2}")).join(" | ");
        text += &format!("| {ratio} | {measured} | {} | {} | {share:.2} |\n", band(computed), band(rigid));
    }
    documents.table(PAGE, "fretting", &text);
}
