//! The error of a response in two directions against the number of periods before the one that counts: static shear along x is
//! shaken out by a vibration along y, over many periods. A mass on springs and a sphere under a constant normal force, by harmonic
//! balance of u and v with one harmonic.

use crate::cases::Case;
use microslip::element::{Directions, Element, NormalInput};
use microslip::two_directions::harmonic_force::{
    HarmonicOutput, TwoDirectionsWorkspace, harmonic_force, workspace_init, workspace_length,
};
use nalgebra::{SMatrix, SVector};

/// The last number is that of the steady state: 20 periods are within 0.1 % of it.
const PERIODS: [usize; 7] = [1, 2, 3, 4, 10, 20, 200];
const SAMPLES: usize = 64;
/// Coefficients of a component, of the unknown components u and v, and of u, v and N.
const ROW: usize = 3;
const UNKNOWNS: usize = 2 * ROW;
const SIZE: usize = 3 * ROW;
/// Static forces along x and excitations along y, over the slip force: the largest amplitudes are a third and two thirds of the
/// displacement of gross slip.
const LOADS: [[f64; 2]; 4] = [[0.3, 0.03], [0.3, 0.1], [0.8, 0.03], [0.8, 0.1]];
/// Over the frequency of the mass on springs and the stuck contact: about the resonances under these excitations.
const FREQUENCIES: [f64; 6] = [0.88, 0.91, 0.94, 0.96, 0.98, 1.0];
/// Stiffness of the springs over that of the stuck contact, and damping ratio.
const SPRINGS: f64 = 0.05;
const DAMPING: f64 = 0.005;

type Vector = SVector<f64, UNKNOWNS>;
type Matrix = SMatrix<f64, UNKNOWNS, UNKNOWNS>;

/// The rows of the table: worst errors of amplitude and energy over the largest ones of their response, and the largest drift.
pub fn table() -> String {
    let element = Case::sphere().element(Directions::Two, NormalInput::Force);
    let mut worst = [[0.0_f64; 3]; PERIODS.len() - 1];
    for load in LOADS {
        let responses = FREQUENCIES.map(|frequency| {
            let mut motion = Vector::zeros();
            PERIODS.map(|periods| solve(&element, load, frequency, periods, &mut motion))
        });
        let peaks = [0, 1].map(|i| responses.iter().map(|[.., steady]| steady[i]).fold(0.0, f64::max));
        for [found @ .., steady] in responses {
            for (worst, found) in worst.iter_mut().zip(found) {
                (0..2).for_each(|i| worst[i] = worst[i].max((found[i] - steady[i]).abs() / peaks[i]));
                worst[2] = worst[2].max(found[2]);
            }
        }
    }
    let rows = PERIODS.iter().zip(worst).map(|(periods, [amplitude, energy, drift])| {
        format!("| {periods} | {:.1} % | {:.1} % | {drift:.0e} |\n", 100.0 * amplitude, 100.0 * energy)
    });
    format!("| `periods` | amplitude | energy | drift |\n|---:|---:|---:|---:|\n{}", rows.collect::<String>())
}

/// Amplitude along y, energy and drift. The motion, u and v over the unit of displacement, is the first guess and then the
/// solution.
fn solve(element: &Element, load: [f64; 2], frequency: f64, periods: usize, motion: &mut Vector) -> [f64; 3] {
    let mut memory = vec![0.0; workspace_length(1, SAMPLES)];
    workspace_init(1, SAMPLES, periods, &mut memory).expect("allowed numbers");
    let mut workspace = TwoDirectionsWorkspace::new(&mut memory).expect("an initialised workspace");
    let slip_force = element.friction_coefficient * element.normal_force;
    let unit = element.friction_coefficient * element.shift_under(element.normal_force);
    let stuck = element.tangential_stiffness * unit / slip_force;
    // Forces of springs, mass and dashpot, over the slip force.
    let mut structure = Matrix::from_diagonal_element(SPRINGS * stuck);
    for i in [0, ROW] {
        let square = frequency * frequency * (1.0 + SPRINGS) * stuck;
        (1..ROW).for_each(|k| structure[(i + k, i + k)] -= square);
        let dashpot = 2.0 * DAMPING * frequency * (1.0 + SPRINGS) * stuck;
        (structure[(i + 1, i + 2)], structure[(i + 2, i + 1)]) = (dashpot, -dashpot);
    }
    let mut balance = |motion: &Vector| {
        let mut displacement = [element.normal_force, 0.0, 0.0].repeat(ROW);
        (0..UNKNOWNS).for_each(|i| displacement[i] = motion[i] * unit);
        let (mut force, mut jacobian, mut results) = ([0.0; SIZE], [0.0; SIZE * SIZE], [0.0; 2]);
        let ([energy, drift], jacobian_out) = (results.each_mut(), Some(&mut jacobian[..]));
        let (dissipated, drift) = (Some(energy), Some(drift));
        let output = HarmonicOutput { force: Some(&mut force), jacobian: jacobian_out, dissipated, drift };
        harmonic_force(element, &mut workspace, &displacement, output).expect("a motion within the range");
        let slope = structure + Matrix::from_fn(|i, j| jacobian[j * SIZE + i] * unit / slip_force);
        let mut residual = structure * motion + Vector::from_fn(|i, _| force[i] / slip_force);
        (residual[0], residual[ROW + 1]) = (residual[0] - load[0], residual[ROW + 1] - load[1]);
        (residual, slope, results)
    };
    // Newton's method, to far below the printed digits of the errors, and above the error of the directions of slip.
    let (mut residual, mut slope, mut results) = balance(motion);
    for _ in 0..100 {
        if residual.norm() < 1e-7 {
            return [motion[ROW + 1].hypot(motion[ROW + 2]), results[0], results[1]];
        }
        let mut step = slope.lu().solve(&residual).expect("a regular matrix");
        let mut trial = balance(&(*motion - step));
        while trial.0.norm() > residual.norm() && step.norm() > 1e-3 {
            step *= 0.5;
            trial = balance(&(*motion - step));
        }
        *motion -= step;
        (residual, slope, results) = trial;
    }
    panic!("no convergence: {load:?}, {frequency}, {periods} periods, {:e}", residual.norm());
}
