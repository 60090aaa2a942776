use super::*;
use crate::constant_load::contact::tests::parameters;
use crate::hbm::Rule;
use crate::hbm::fourier::angle;
use crate::parameters::{EllipticParameters, Material};
use crate::varying_load::element::NormalInput;
use crate::varying_load::state;
use std::vec;
use std::vec::Vec;

const INPUTS: [NormalInput; 2] = [NormalInput::Approach, NormalInput::Force];

/// A cylinder, a flat with rounded edges, and a sphere.
fn elements(input: NormalInput) -> [Element; 3] {
    let steel = Material { young_modulus: 2e11, poisson_ratio: 0.3 };
    let sphere = EllipticParameters {
        semi_axis_x: 2e-4,
        semi_axis_y: 2e-4,
        normal_force: 150.0,
        friction_coefficient: 0.4,
        material: [steel; 2],
    };
    let flat = |flat| Element::rounded_flat(&parameters(flat), input).unwrap();
    [flat(0.0), flat(50e-6), Element::elliptic(&sphere, input).unwrap()]
}

/// Uniformly distributed values from -1 to 1.
struct Scattered(u64);

impl Scattered {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// The largest values of input, shift and normal force that occur.
fn scales(element: &Element) -> (f64, f64, f64) {
    let shift = element.shift_under(element.normal_force);
    let input = if element.by_approach() { element.approach } else { element.normal_force };
    (input, shift, element.normal_force)
}

/// A motion of given sizes: of u over mu S, of the normal component about its mean over the largest.
fn motion(element: &Element, harmonics: usize, size: f64, mean: f64, swing: f64, random: &mut Scattered) -> Vec<f64> {
    let (input, shift, _) = scales(element);
    let coefficients = 2 * harmonics + 1;
    let mut displacement = vec![0.0; 2 * coefficients];
    for c in 0..coefficients {
        let order = c.div_ceil(2).max(1) as f64;
        displacement[c] = size * element.friction_coefficient * shift * random.next() / (order * order);
        displacement[coefficients + c] = swing * input * random.next() / (order * order);
    }
    displacement[coefficients] = mean * input;
    if !element.by_approach() {
        // Without negative forces, but down to zero if the swing is large.
        let samples = sampled(&displacement[coefficients..], 997);
        let least = samples.iter().copied().fold(f64::MAX, f64::min);
        displacement[coefficients] += (-least).max(0.0) * (1.0 + 1e-3);
    }
    displacement
}

fn sampled(coefficients: &[f64], samples: usize) -> Vec<f64> {
    let function = |c: usize, n: usize| {
        let angle = angle(c.div_ceil(2), n, samples);
        if c % 2 == 0 && c > 0 { angle.sin() } else { angle.cos() }
    };
    (0..samples).map(|n| coefficients.iter().enumerate().map(|(c, a)| a * function(c, n)).sum()).collect()
}

fn coefficients_of(values: &[f64], harmonics: usize) -> Vec<f64> {
    let samples = values.len();
    (0..=2 * harmonics)
        .map(|c| {
            let function = |n: usize| {
                let angle = angle(c.div_ceil(2), n, samples);
                if c % 2 == 0 && c > 0 { angle.sin() } else { angle.cos() }
            };
            let sum: f64 = values.iter().enumerate().map(|(n, value)| value * function(n)).sum();
            sum * if c == 0 { 1.0 } else { 2.0 } / samples as f64
        })
        .collect()
}

/// The definition, step by step: force and energy.
fn by_definition(element: &Element, samples: usize, displacement: &[f64]) -> (Vec<f64>, f64) {
    let (u, w) = displacement.split_at(displacement.len() / 2);
    let harmonics = u.len() / 2;
    let (u, mut w) = (sampled(u, samples), sampled(w, samples));
    if !element.by_approach() {
        w.iter_mut().for_each(|w| *w = w.max(0.0));
    }
    let mut memory = vec![0.0; state::state_length(2 * samples)];
    state::state_init(&mut memory).unwrap();
    let largest = w.iter().copied().fold(f64::MIN, f64::max);
    let start = w.iter().position(|w| *w == largest).unwrap();
    let mut advance = |u: f64, w: f64| state::advance(element, &mut memory, [u, w], true).unwrap();
    advance(0.0, largest);
    advance(u[start], largest);
    let (mut force, mut energy) = (vec![[0.0; 2]; samples], 0.0);
    for step in 1..=2 * samples {
        let n = (start + step) % samples;
        let result = advance(u[n], w[n]);
        if step > samples {
            force[n] = result.force;
            energy += result.dissipated;
        }
    }
    let part = |index: usize| {
        let values: Vec<f64> = force.iter().map(|force| force[index]).collect();
        coefficients_of(&values, harmonics)
    };
    ([part(0), part(1)].concat(), energy)
}

fn workspace(harmonics: usize, samples: usize) -> Vec<f64> {
    let mut memory = vec![f64::NAN; workspace_length(harmonics, samples)];
    workspace_init(harmonics, samples, &mut memory).unwrap();
    memory
}

/// Compiled once for all tests.
#[inline(never)]
fn evaluate(element: &Element, memory: &mut [f64], displacement: &[f64], output: HarmonicOutput) -> Result<(), Error> {
    harmonic_force(element, &mut Workspace::new(memory)?, displacement, output)
}

fn all(element: &Element, memory: &mut [f64], displacement: &[f64]) -> (Vec<f64>, Vec<f64>, f64) {
    let n = displacement.len();
    let (mut force, mut jacobian, mut energy) = (vec![f64::NAN; n], vec![f64::NAN; n * n], f64::NAN);
    let output =
        HarmonicOutput { force: Some(&mut force), jacobian: Some(&mut jacobian), dissipated: Some(&mut energy) };
    evaluate(element, memory, displacement, output).unwrap();
    (force, jacobian, energy)
}

fn force_of(element: &Element, memory: &mut [f64], displacement: &[f64]) -> Vec<f64> {
    let mut force = vec![f64::NAN; displacement.len()];
    let output = HarmonicOutput { force: Some(&mut force), jacobian: None, dissipated: None };
    evaluate(element, memory, displacement, output).unwrap();
    force
}

/// Sizes of u, means and swings: microslip, mostly stuck, separation, gross slip, both, beyond the tables, open throughout, almost no
/// motion, constant.
const SCENES: [[f64; 3]; 10] = [
    [0.3, 0.5, 0.3],
    [0.05, 0.5, 0.4],
    [0.6, 0.2, 0.6],
    [3.0, 0.5, 0.3],
    [3.0, 0.2, 0.6],
    [1.0, 3.0, 2.0],
    [1.0, -3.0, 0.5],
    [1e-9, 0.5, 1e-9],
    [0.5, 0.7, 0.0],
    [3.0, 0.7, 0.0],
];

#[test]
fn force_and_energy_are_those_of_the_definition() {
    let mut random = Scattered(1);
    for element in INPUTS.into_iter().flat_map(elements) {
        for (harmonics, samples) in [(1, 3), (1, 16), (2, 33), (3, 34), (4, 64), (5, 11), (9, 100)] {
            let mut memory = workspace(harmonics, samples);
            for [size, mean, swing] in SCENES {
                if mean < 0.0 && !element.by_approach() {
                    continue;
                }
                for _ in 0..8 {
                    let displacement = motion(&element, harmonics, size, mean, swing, &mut random);
                    let (force, energy) = by_definition(&element, samples, &displacement);
                    let (mine, _, my_energy) = all(&element, &mut memory, &displacement);
                    let largest = scales(&element).2 * (mean.abs() + swing).max(1.0).powi(2);
                    for (one, two) in mine.iter().zip(&force) {
                        assert!(
                            (one - two).abs() < 1e-13 * largest,
                            "{harmonics} {samples} {size} {mean} {swing}: {mine:?} {force:?}"
                        );
                    }
                    let error = (my_energy - energy).abs();
                    let (_, shift, _) = scales(&element);
                    assert!(
                        error < 1e-11 * energy + 1e-14 * largest * shift * size.max(1.0),
                        "{harmonics} {samples} {size} {mean} {swing}: {my_energy} {energy}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_jacobian_is_the_derivative_of_the_force() {
    let mut random = Scattered(2);
    let (mut count, mut bad) = (0, 0);
    for element in INPUTS.into_iter().flat_map(elements) {
        let (input, shift, load) = scales(&element);
        for (harmonics, samples) in [(1, 16), (4, 33), (5, 64), (9, 50)] {
            let mut memory = workspace(harmonics, samples);
            for [size, mean, swing] in SCENES {
                if mean < 0.0 && !element.by_approach() || size < 1e-3 {
                    continue;
                }
                for _ in 0..3 {
                    let displacement = motion(&element, harmonics, size, mean, swing, &mut random);
                    let n = displacement.len();
                    let (_, jacobian, _) = all(&element, &mut memory, &displacement);
                    let mut worst: f64 = 0.0;
                    for j in 0..n {
                        let step = 1e-6 * if j < n / 2 { element.friction_coefficient * shift } else { input };
                        let mut at = |factor: f64| {
                            let mut moved = displacement.clone();
                            moved[j] += factor * step;
                            force_of(&element, &mut memory, &moved)
                        };
                        let (plus, minus) = (at(1.0), at(-1.0));
                        let scale = step / load;
                        for i in 0..n {
                            let difference = (plus[i] - minus[i]) / (2.0 * step);
                            worst = worst.max((difference - jacobian[i + n * j]).abs() * step / 1e-6 / load);
                        }
                        let _ = scale;
                    }
                    count += 1;
                    if worst > 2e-8 {
                        bad += 1;
                        std::println!(
                            "H={harmonics} N={samples} {size} {mean} {swing} {:?} worst {worst:.1e}",
                            element.by_approach()
                        );
                    }
                }
            }
        }
    }
    std::println!("{bad} of {count}");
    assert!(bad == 0);
}
