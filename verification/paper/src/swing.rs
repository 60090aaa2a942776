//! The energy of a cycle under a swinging normal force `N0 (1 + α sin(ωt + φ))` over that under the constant N0.

use crate::cases::Case;
use crate::drawings::even;
use crate::path::Path;
use crate::table::Table;
use microslip::element::{Directions, Element, NormalInput};
use std::f64::consts::TAU;

const STEPS_OF_CYCLE: usize = 180;
/// Phases of a curve from 0 to 180 degrees: beyond, the tangential motion has the other sign, and the energy is the same.
const PHASES: usize = 36;
const LENGTH: f64 = 20.0;

/// What is harmonic, `sin ωt` times an amplitude.
#[derive(Clone, Copy)]
enum Motion {
    /// Tangential force, over μ N0.
    Force(f64),
    /// Displacement, over that of gross slip under N0.
    Displacement(f64),
}

pub fn tables() -> [Table; 4] {
    let phases = even(0.0, 180.0, PHASES);
    let table = |name, case: Case, motion, amplitudes: [f64; 4]| {
        let element = case.element(Directions::One, NormalInput::Force);
        let constant = energy(&case, &element, motion, 0.0, 0.0, STEPS_OF_CYCLE);
        amplitudes.iter().fold(Table::new(name).column("phase", phases.clone()), |table, &amplitude| {
            let ratio = |phase: &f64| energy(&case, &element, motion, amplitude, *phase, STEPS_OF_CYCLE) / constant;
            table.column(format!("α = {amplitude}"), phases.iter().map(ratio).collect())
        })
    };
    let (cylinder, flat) = (|| Case::flat(0.0, LENGTH), || Case::flat(0.9, LENGTH));
    let (small, gross) = ([0.1, 0.2, 0.4, 0.5], [0.1, 0.2, 0.5, 1.0]);
    [
        table("swing_a", cylinder(), Motion::Force(0.4), small),
        table("swing_b", flat(), Motion::Force(0.4), small),
        table("swing_c", cylinder(), Motion::Displacement(2.0), gross),
        table("swing_d", flat(), Motion::Displacement(2.0), gross),
    ]
}

/// Energy of the second of two cycles that start at the largest normal force, under which the contact was displaced.
fn energy(case: &Case, element: &Element, motion: Motion, swing: f64, phase: f64, steps: usize) -> f64 {
    let normal_force = |i: usize| {
        let turn = (i as f64 / steps as f64 + phase / 360.0).fract();
        case.normal_force * (1.0 + swing * (TAU * turn).sin())
    };
    let along = |i: usize| (TAU * (i % steps) as f64 / steps as f64).sin();
    let first = (0..steps).fold(0, |best, i| if normal_force(i) > normal_force(best) { i } else { best });
    let mut path = Path::new(element, 2 * steps + 2);
    path.displace(0.0, normal_force(first));
    let mut energy = 0.0;
    for i in 0..=2 * steps {
        let (along, load) = (along(first + i), normal_force(first + i));
        let step = match motion {
            Motion::Force(part) => {
                let distance = 8.0 * element.friction_coefficient * element.shift_under(load);
                path.pull([0.0, 1.0], part * along * case.contact.slip_force, load, distance)
            }
            Motion::Displacement(part) => path.displace(part * along * case.contact.slip_displacement, load),
        };
        energy += if i > steps { step.dissipated } else { 0.0 };
    }
    energy
}
