//! The error of the harmonic force of an element against the number of samples.

use crate::cases::Case;
use microslip::element::{Directions, Element, NormalInput};
use microslip::one_direction::harmonic_force::{
    HarmonicOutput, OneDirectionWorkspace, harmonic_force, workspace_init, workspace_length,
};
use std::f64::consts::TAU;

const SAMPLES: [usize; 3] = [64, 128, 256];
const CONVERGED: usize = 1 << 14;
/// Shifts of time over which the worst error is taken: samples may meet an event or miss it.
const SHIFTS: usize = 16;

/// A motion in units of the displacement of gross slip and of the approach under the force of the parameters.
struct Motion {
    name: &'static str,
    /// Amplitude of the displacement; mean, swing and phase of the approach.
    displacement: f64,
    mean: f64,
    swing: f64,
    phase: f64,
}

const MOTIONS: [Motion; 4] = [
    Motion { name: "microslip, constant load", displacement: 0.5, mean: 0.7, swing: 0.0, phase: 0.0 },
    Motion { name: "microslip, load varies by 40 %", displacement: 0.5, mean: 0.7, swing: 0.28, phase: 0.25 },
    Motion { name: "gross slip, load varies by 40 %", displacement: 2.0, mean: 0.7, swing: 0.28, phase: 0.25 },
    Motion { name: "separation", displacement: 0.7, mean: 0.3, swing: 0.6, phase: 0.25 },
];

/// The rows of the table: worst error of the coefficients of T over that of its first order, and of the energy over its value, for
/// both numbers of harmonics.
pub fn table() -> String {
    let element = Case::flat(0.0, 20.0).element(Directions::One, NormalInput::Approach);
    let heads = SAMPLES.map(|samples| format!(" T, {samples} | energy, {samples} |")).concat();
    let mut text = format!("| motion |{heads}\n|---|{}\n", "---:|---:|".repeat(SAMPLES.len()));
    for motion in &MOTIONS {
        let cells = SAMPLES.map(|samples| {
            let [one, five] = [1, 5].map(|harmonics| worst_errors(&element, motion, harmonics, samples));
            format!(" {:.0e} | {:.0e} |", one[0].max(five[0]), one[1].max(five[1]))
        });
        text += &format!("| {} |{}\n", motion.name, cells.concat());
    }
    text
}

/// Amplitudes of the table of roundings over that of gross slip.
const AMPLITUDES: [f64; 4] = [1e-1, 1e-2, 1e-4, 1e-6];

/// The rows of the table of roundings: the largest relative difference of the energies of a motion and of the same motion some
/// samples later, which has the same samples; rounded up to a power of ten.
pub fn roundings() -> String {
    let cells = AMPLITUDES.map(|amplitude| format!("{amplitude:.0e} | "));
    let mut text =
        format!("| contact | load | {}\n|---|---|{}\n", cells.concat().trim_end(), "---:|".repeat(AMPLITUDES.len()));
    for (name, flat) in [("cylinder", 0.0), ("flat, a/b = 0.9", 0.9)] {
        let element = Case::flat(flat, 20.0).element(Directions::One, NormalInput::Approach);
        for (load, swing) in [("constant", 0.0), ("varies by 40 %", 0.28)] {
            let cells = AMPLITUDES.map(|displacement| {
                let motion = Motion { name, displacement, mean: 0.7, swing, phase: 0.25 };
                let energies = (0..SAMPLES[0]).map(|shift| {
                    let coefficients = motion.coefficients(&element, 1, shift as f64 / SAMPLES[0] as f64);
                    evaluate(&element, &coefficients, 1, SAMPLES[0]).1
                });
                let (least, largest) = energies.fold((f64::MAX, 0.0_f64), |(a, b), e| (a.min(e), b.max(e)));
                format!(" {:.0e} |", 10f64.powf((1.0 - least / largest).log10().ceil()))
            });
            text += &format!("| {name} | {load} |{}\n", cells.concat());
        }
    }
    text
}

fn worst_errors(element: &Element, motion: &Motion, harmonics: usize, samples: usize) -> [f64; 2] {
    let (mut worst, coefficients) = ([0.0_f64; 2], 2 * harmonics + 1);
    for shift in 0..SHIFTS {
        let displacement = motion.coefficients(element, harmonics, shift as f64 / (SHIFTS * SAMPLES[0]) as f64);
        let [one, exact] = [samples, CONVERGED].map(|samples| evaluate(element, &displacement, harmonics, samples));
        let first = exact.0[1].hypot(exact.0[2]);
        let error =
            one.0.iter().zip(&exact.0).take(coefficients).map(|(one, exact)| (one - exact).abs()).fold(0.0, f64::max);
        worst = [worst[0].max(error / first), worst[1].max((one.1 / exact.1 - 1.0).abs())];
    }
    worst
}

impl Motion {
    /// Coefficients of both components, from a time given as a part of the period.
    fn coefficients(&self, element: &Element, harmonics: usize, time: f64) -> Vec<f64> {
        let unit = element.friction_coefficient * element.shift_under(element.normal_force);
        let mut coefficients = vec![0.0; 2 * (2 * harmonics + 1)];
        let (tangential, normal) = coefficients.split_at_mut(2 * harmonics + 1);
        let add = |component: &mut [f64], order: usize, amplitude: f64, phase: f64| {
            let (sine, cosine) = (TAU * (order as f64 * time + phase)).sin_cos();
            component[2 * order - 1] += amplitude * sine;
            component[2 * order] += amplitude * cosine;
        };
        add(tangential, 1, self.displacement * unit, 0.0);
        add(normal, 1, self.swing * element.approach, self.phase);
        for order in 2..=harmonics {
            let part = 0.3 / (order * order) as f64;
            add(tangential, order, part * self.displacement * unit, 0.1 * order as f64);
            add(normal, order, part * self.swing * element.approach, 0.2 * order as f64);
        }
        normal[0] = self.mean * element.approach;
        coefficients
    }
}

/// Force and energy.
fn evaluate(element: &Element, displacement: &[f64], harmonics: usize, samples: usize) -> (Vec<f64>, f64) {
    let mut memory = vec![0.0; workspace_length(harmonics, samples)];
    workspace_init(harmonics, samples, &mut memory).expect("allowed numbers");
    let mut workspace = OneDirectionWorkspace::new(&mut memory).expect("an initialised workspace");
    let (mut force, mut energy) = (vec![0.0; displacement.len()], 0.0);
    let output = HarmonicOutput { force: Some(&mut force), jacobian: None, dissipated: Some(&mut energy), drift: None };
    harmonic_force(element, &mut workspace, displacement, output).expect("a motion within the range");
    (force, energy)
}
