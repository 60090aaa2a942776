//! Two directions: a mean displacement along x beside a vibration across it, over the periods that are walked before the one that
//! counts. The mean force along x is shaken out, and the energy of that is counted as one of the vibration.

use crate::cases::Case;
use crate::table::Table;
use microslip::element::{Directions, Element, NormalInput};
use microslip::two_directions::harmonic_force::{
    HarmonicOutput, Workspace, harmonic_force, workspace_init, workspace_length,
};

/// Walked before the one that counts.
const PERIODS: [usize; 11] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48];
/// For the steady state.
const MANY: usize = 400;
const SAMPLES: usize = 64;
/// 2H + 1, of one component.
const ROW: usize = 3;
/// The mean, over the shift of the slip force, and amplitudes across it.
const MEAN: f64 = 0.8;
const AMPLITUDES: [f64; 3] = [0.2, 0.3, 0.5];

/// Of a sphere: energy over that of the steady state, and mean force over the slip force.
pub fn tables() -> [Table; 2] {
    let element = Case::sphere().element_of(Directions::Two, NormalInput::Force);
    let at = PERIODS.map(|periods| periods as f64).to_vec();
    let mut tables = ["periods_a", "periods_b"].map(|name| Table::new(name).column("periods", at.clone()));
    for amplitude in AMPLITUDES {
        let [_, steady] = evaluate(&element, amplitude, MANY);
        let rows = PERIODS.map(|periods| evaluate(&element, amplitude, periods));
        let name = || format!("v = {amplitude} δs");
        let [a, b] = tables;
        tables = [
            a.column(name(), rows.iter().map(|[_, energy]| energy / steady).collect()),
            b.column(name(), rows.iter().map(|[force, _]| *force).collect()),
        ];
    }
    tables
}

/// Mean force along x over the slip force, and energy.
fn evaluate(element: &Element, amplitude: f64, periods: usize) -> [f64; 2] {
    let slip_force = element.friction_coefficient * element.normal_force;
    let unit = element.friction_coefficient * element.shift_under(element.normal_force);
    let mut motion = [0.0; 3 * ROW];
    (motion[0], motion[ROW + 2], motion[2 * ROW]) = (MEAN * unit, amplitude * unit, element.normal_force);
    let mut memory = vec![0.0; workspace_length(1, SAMPLES)];
    workspace_init(1, SAMPLES, periods, &mut memory).expect("allowed numbers");
    let mut workspace = Workspace::new(&mut memory).expect("an initialised workspace");
    let (mut force, mut energy) = ([0.0; 3 * ROW], 0.0);
    let output = HarmonicOutput { force: Some(&mut force), jacobian: None, dissipated: Some(&mut energy), drift: None };
    harmonic_force(element, &mut workspace, &motion, output).expect("a motion within the range");
    [force[0] / slip_force, energy]
}
