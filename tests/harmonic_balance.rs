//! A mass on springs and a flat with a rough layer, under a static shear force, a vibration across it and a load that varies: harmonic balance
//! converges at every frequency.

mod common;

use common::two_directions::{element_of, layer_of, parameters};
use microslip::element::Element;
use microslip::parameters::Parameters;
use microslip::two_directions::harmonic_force::{
    HarmonicOutput, TwoDirectionsWorkspace, harmonic_force, workspace_init, workspace_length,
};

const HARMONICS: usize = 3;
const SAMPLES: usize = 64;
/// Coefficients of a component, and of the unknown components u and v.
const ROW: usize = 2 * HARMONICS + 1;
const UNKNOWNS: usize = 2 * ROW;
const COEFFICIENTS: usize = 3 * ROW;
/// Over the frequency of the mass on springs and the stuck contact: from the first to the last one in steps of the second.
const FREQUENCIES: [f64; 2] = [0.5, 0.025];
const STEPS: usize = 25;
/// Stiffness of the springs over that of the stuck contact, and damping ratio.
const SPRINGS: f64 = 0.05;
const DAMPING: f64 = 0.005;
/// Forces over mu N: static along x, vibrating along x and y; and those of the load over N.
const STATIC: f64 = 0.4;
const VIBRATING: [f64; 2] = [0.1, 0.3];
const LOAD: [f64; 3] = [0.65, 0.25, 0.1];

fn element(flat_half_width: f64, ratio: f64) -> Element {
    let bare = parameters(flat_half_width);
    element_of(&Parameters { layer: layer_of(&element_of(&bare), (1.0, ratio)), ..bare })
}

/// The solution of a system of equations, by elimination with pivots.
fn solved(mut a: [[f64; UNKNOWNS]; UNKNOWNS], mut b: [f64; UNKNOWNS]) -> [f64; UNKNOWNS] {
    for p in 0..UNKNOWNS {
        let pivot = (p..UNKNOWNS).max_by(|i, j| a[*i][p].abs().total_cmp(&a[*j][p].abs())).unwrap();
        a.swap(p, pivot);
        b.swap(p, pivot);
        let (row, value) = (a[p], b[p]);
        for i in p + 1..UNKNOWNS {
            let factor = a[i][p] / row[p];
            (p..UNKNOWNS).for_each(|j| a[i][j] -= factor * row[j]);
            b[i] -= factor * value;
        }
    }
    for p in (0..UNKNOWNS).rev() {
        let known: f64 = (p + 1..UNKNOWNS).map(|j| a[p][j] * b[j]).sum();
        b[p] = (b[p] - known) / a[p][p];
    }
    b
}

/// The residual over mu N of u and v in units of the displacement of gross slip, and its derivatives.
fn residual(
    element: &Element,
    workspace: &mut TwoDirectionsWorkspace,
    frequency: f64,
    motion: &[f64; UNKNOWNS],
) -> ([f64; UNKNOWNS], [[f64; UNKNOWNS]; UNKNOWNS]) {
    let unit = element.friction_coefficient * element.shift_under(element.normal_force);
    let slip_force = element.friction_coefficient * element.normal_force;
    let mut displacement = [0.0; COEFFICIENTS];
    (0..UNKNOWNS).for_each(|i| displacement[i] = motion[i] * unit);
    (0..3).for_each(|i| displacement[UNKNOWNS + i] = LOAD[i] * element.normal_force);
    let (mut force, mut jacobian) = ([0.0; COEFFICIENTS], [0.0; COEFFICIENTS * COEFFICIENTS]);
    let output =
        HarmonicOutput { force: Some(&mut force), jacobian: Some(&mut jacobian), dissipated: None, drift: None };
    harmonic_force(element, workspace, &displacement, output).unwrap();
    // The mass of which the frequency is 1 with the stuck contact.
    let stuck = element.tangential_stiffness * unit / slip_force;
    let (springs, mass) = (SPRINGS * stuck, (1.0 + SPRINGS) * stuck);
    let (mut value, mut slope) = ([0.0; UNKNOWNS], [[0.0; UNKNOWNS]; UNKNOWNS]);
    for i in 0..UNKNOWNS {
        value[i] = force[i] / slip_force;
        (0..UNKNOWNS).for_each(|j| slope[i][j] = jacobian[i + COEFFICIENTS * j] * unit / slip_force);
    }
    for row in [0, ROW] {
        for c in 0..ROW {
            let rate = frequency * c.div_ceil(2) as f64;
            let (stiffness, damping) = (springs - mass * rate * rate, 2.0 * DAMPING * mass * rate);
            // The rate of a cosine is a sine, and minus a cosine that of a sine.
            let other = if c % 2 == 1 { c + 1 } else { c.max(1) - 1 };
            let damping = if c % 2 == 1 { damping } else { -damping };
            slope[row + c][row + c] += stiffness;
            value[row + c] += stiffness * motion[row + c];
            if c > 0 {
                slope[row + c][row + other] += damping;
                value[row + c] += damping * motion[row + other];
            }
        }
    }
    value[0] -= STATIC;
    value[1] -= VIBRATING[0];
    value[ROW + 1] -= VIBRATING[1];
    (value, slope)
}

fn size(residual: &[f64; UNKNOWNS]) -> f64 {
    residual.iter().map(|value| value * value).sum::<f64>().sqrt()
}

#[test]
fn harmonic_balance_with_a_rough_layer_converges_at_every_frequency() {
    for (half_width, ratio) in [(1e-4, 0.03), (3e-3, 0.3)] {
        let element = element(half_width, ratio);
        for periods in [1, 3, 10] {
            let mut memory = vec![0.0; workspace_length(HARMONICS, SAMPLES)];
            workspace_init(HARMONICS, SAMPLES, periods, &mut memory).unwrap();
            let mut workspace = TwoDirectionsWorkspace::new(&mut memory).unwrap();
            let (mut motion, mut most, mut largest) = ([0.0; UNKNOWNS], 0, 0.0f64);
            for step in 0..STEPS {
                let frequency = FREQUENCIES[0] + FREQUENCIES[1] * step as f64;
                let mut balance = |motion: &[f64; UNKNOWNS]| residual(&element, &mut workspace, frequency, motion);
                let (mut value, mut slope) = balance(&motion);
                let mut steps = 0;
                while size(&value) > 1e-9 {
                    steps += 1;
                    assert!(steps < 50, "{half_width} {ratio}, {periods} periods, {frequency}: {:e}", size(&value));
                    let by = solved(slope, value);
                    for part in [1.0, 0.5, 0.25, 0.125, 0.0625, 0.03125] {
                        let mut next = motion;
                        (0..UNKNOWNS).for_each(|i| next[i] -= part * by[i]);
                        let (next_value, next_slope) = balance(&next);
                        let falls = size(&next_value) < size(&value);
                        if falls || part < 0.04 {
                            (motion, value, slope) = (next, next_value, next_slope);
                            break;
                        }
                    }
                }
                most = most.max(steps);
                largest = largest.max(motion[ROW + 1].hypot(motion[ROW + 2]));
            }
            println!("{half_width} {ratio}, {periods} periods: up to {most} steps, amplitude up to {largest:.2}");
            assert!(largest > 0.4);
        }
    }
}
