use super::*;
use crate::constant_load::contact::tests::parameters;
use crate::element::{Directions, NormalInput};
use crate::fourier::angle;
use crate::one_direction::{advance, state};
use crate::parameters::{EllipticParameters, Material, Parameters};
use std::vec;
use std::vec::Vec;

const INPUTS: [NormalInput; 2] = [NormalInput::Approach, NormalInput::Force];

/// A cylinder, a flat with rounded edges, the same without friction, and a sphere.
fn elements(input: NormalInput) -> Vec<Element> {
    let steel = Material { young_modulus: 2e11, poisson_ratio: 0.3 };
    let sphere = EllipticParameters {
        semi_axis_x: 2e-4,
        semi_axis_y: 2e-4,
        normal_force: 150.0,
        friction_coefficient: 0.4,
        material: [steel; 2],
        ..EllipticParameters::default()
    };
    let element = |parameters: Parameters| Element::rounded_flat(&parameters, Directions::One, input).unwrap();
    let flat = |flat| element(parameters(flat));
    let frictionless = element(Parameters { friction_coefficient: 0.0, ..parameters(50e-6) });
    vec![flat(0.0), flat(50e-6), frictionless, Element::elliptic(&sphere, Directions::One, input).unwrap()]
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

/// Odd orders of u and even ones of the normal component only.
fn half_wave_symmetric(mut displacement: Vec<f64>) -> Vec<f64> {
    let coefficients = displacement.len() / 2;
    for (c, value) in displacement.iter_mut().enumerate() {
        let (order, parity) = if c < coefficients { (c.div_ceil(2), 1) } else { ((c - coefficients).div_ceil(2), 0) };
        if order % 2 != parity {
            *value = 0.0;
        }
    }
    displacement
}

fn sampled(coefficients: &[f64], samples: usize) -> Vec<f64> {
    let function = |c: usize, n: usize| {
        let angle = angle(c.div_ceil(2), n, samples);
        if c > 0 && c.is_multiple_of(2) { angle.sin() } else { angle.cos() }
    };
    (0..samples).map(|n| coefficients.iter().enumerate().map(|(c, a)| a * function(c, n)).sum()).collect()
}

fn coefficients_of(values: &[f64], harmonics: usize) -> Vec<f64> {
    let samples = values.len();
    (0..=2 * harmonics)
        .map(|c| {
            let function = |n: usize| {
                let angle = angle(c.div_ceil(2), n, samples);
                if c > 0 && c.is_multiple_of(2) { angle.sin() } else { angle.cos() }
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
    let mut advance = |u: f64, w: f64| advance(element, &mut memory, [u, w], true).unwrap();
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
    let output = HarmonicOutput {
        force: Some(&mut force),
        jacobian: Some(&mut jacobian),
        dissipated: Some(&mut energy),
        drift: None,
    };
    evaluate(element, memory, displacement, output).unwrap();
    (force, jacobian, energy)
}

fn force_of(element: &Element, memory: &mut [f64], displacement: &[f64]) -> Vec<f64> {
    let mut force = vec![f64::NAN; displacement.len()];
    let output = HarmonicOutput { force: Some(&mut force), jacobian: None, dissipated: None, drift: None };
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
        for (harmonics, samples) in [(1, 3), (1, 16), (2, 33), (3, 34), (4, 64), (5, 11), (9, 100), (12, 40)] {
            let mut memory = workspace(harmonics, samples);
            for [size, mean, swing] in SCENES {
                if mean < 0.0 && !element.by_approach() {
                    continue;
                }
                for round in 0..9 {
                    let mut displacement = motion(&element, harmonics, size, mean, swing, &mut random);
                    if round % 3 == 0 && element.by_approach() {
                        displacement = half_wave_symmetric(displacement);
                    }
                    if round == 8 {
                        // 1 + cos t: exactly 0 at the sample in the middle of an even number.
                        let normal = &mut displacement[2 * harmonics + 1..];
                        normal.fill(0.0);
                        normal[..2].fill(0.5 * mean.max(0.0) * scales(&element).0);
                    }
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
    let (mut count, mut corners) = (0, 0);
    for element in INPUTS.into_iter().flat_map(elements) {
        let (input, shift, load) = scales(&element);
        for (harmonics, samples) in [(1, 16), (4, 33), (5, 64), (9, 50), (12, 30)] {
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
                        let unit = if j < n / 2 { 0.4 * shift } else { input };
                        let mut difference = |step: f64| {
                            let mut at = |step: f64| {
                                let mut moved = displacement.clone();
                                moved[j] += step * unit;
                                force_of(&element, &mut memory, &moved)
                            };
                            let (plus, minus) = (at(step), at(-step));
                            plus.into_iter().zip(minus).map(move |(plus, minus)| (plus - minus) / (2.0 * step * load))
                        };
                        // Extrapolated to order four.
                        let (coarse, fine) = (difference(4e-6).collect::<Vec<_>>(), difference(2e-6));
                        for (i, (coarse, fine)) in coarse.into_iter().zip(fine).enumerate() {
                            let exact = (4.0 * fine - coarse) / 3.0;
                            worst = worst.max((exact - jacobian[i + n * j] * unit / load).abs());
                        }
                    }
                    // Rarely a corner lies between the points of a difference.
                    count += 1;
                    corners += usize::from(worst > 5e-9);
                    assert!(worst < 0.02, "{harmonics} {samples} {size} {mean} {swing}: {worst}");
                }
            }
        }
    }
    assert!(corners * 100 < count, "{corners} of {count}");
}

#[test]
fn half_of_a_half_wave_symmetric_motion_is_enough() {
    let mut random = Scattered(6);
    for element in INPUTS.into_iter().flat_map(elements) {
        let (input, shift, load) = scales(&element);
        for (harmonics, samples) in [(1, 16), (4, 34), (5, 64), (9, 50)] {
            let mut memory = workspace(harmonics, samples);
            for [size, mean, swing] in SCENES.into_iter().filter(|scene| scene[1] > 0.3 || element.by_approach()) {
                let displacement =
                    half_wave_symmetric(motion(&element, harmonics, size, mean, 0.7 * swing, &mut random));
                let half = all(&element, &mut memory, &displacement);
                // Not symmetric, but by a negligible amount.
                let mut not_quite = displacement.clone();
                not_quite[0] = 1e-200;
                let whole = all(&element, &mut memory, &not_quite);
                assert!((half.2 - whole.2).abs() <= 1e-12 * whole.2 + 1e-16 * load * shift);
                let largest = load * (mean.abs() + swing).max(1.0).powi(2);
                for (one, two) in half.0.iter().zip(&whole.0) {
                    assert!((one - two).abs() < 1e-14 * largest, "{harmonics} {samples} {size} {mean}: {one} {two}");
                }
                let n = displacement.len();
                for (index, (one, two)) in half.1.iter().zip(&whole.1).enumerate() {
                    let unit = if index < n * n / 2 { element.friction_coefficient * shift } else { input };
                    assert!(
                        (one - two).abs() * unit < 1e-11 * largest,
                        "{harmonics} {samples} {size} {index}: {one} {two}"
                    );
                }
            }
        }
    }
}

#[test]
fn negative_normal_forces_are_rejected_but_for_rounding() {
    let element = elements(NormalInput::Force)[0];
    let mut memory = workspace(2, 16);
    let mut displacement = [0.0; 10];
    displacement[1] = 1e-6;
    for (mean, cosine, is_valid) in [
        (100.0, 100.0, true),
        (100.0, 100.0 * (1.0 + 1e-15), true),
        (100.0, 100.0 * (1.0 + 1e-13), false),
        (-1.0, 0.0, false),
        (-1.0, 3.0, false),
        (0.0, 0.0, true),
        (0.0, 1e-3, false),
    ] {
        (displacement[5], displacement[6]) = (mean, cosine);
        let (mut force, mut jacobian, mut energy) = ([7.0; 10], [7.0; 100], 7.0);
        let output = HarmonicOutput {
            force: Some(&mut force),
            jacobian: Some(&mut jacobian),
            dissipated: Some(&mut energy),
            drift: None,
        };
        let result = evaluate(&element, &mut memory, &displacement, output);
        assert_eq!(result, if is_valid { Ok(()) } else { Err(Error::BadNormalForce) }, "{mean} {cosine}");
        assert!(is_valid || (energy == 7.0 && force.iter().chain(&jacobian).all(|value| *value == 7.0)));
        assert!(!is_valid || (force[5..] == displacement[5..] && force[1].is_finite()));
    }
}
