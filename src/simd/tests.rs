//! All calls that dispatch give the same bits on the vectors of this processor and on those of the baseline.

use crate::constant_load::ConstantLoad;
use crate::constant_load::contact::tests::{FLATS, contact, ellipse};
use crate::constant_load::harmonic_force::tests::{compute, workspace};
use crate::constant_load::harmonic_force::{HarmonicOutput, Rule, Workspace, harmonic_sensitivity};
use crate::constant_load::state::state_length;
use crate::element::{Directions, Element, NormalInput};
use crate::law::{Law, PathOutput};
use crate::one_direction::{self, OneDirection, harmonic_force as line};
use crate::two_directions::TwoDirections;
use crate::{Contact, Material, Parameters};
use core::cell::Cell;
use std::prelude::rust_2024::*;
use std::vec;

std::thread_local! {
    static BASELINE: Cell<bool> = const { Cell::new(false) };
}

pub(super) fn is_baseline() -> bool {
    BASELINE.get()
}

/// Computes with both; compares the bits, and that something was computed.
fn compare(what: &str, mut compute: impl FnMut() -> Vec<f64>) {
    let mut bits = |baseline| {
        BASELINE.set(baseline);
        compute().iter().map(|value| value.to_bits()).collect::<Vec<_>>()
    };
    let [dispatched, baseline] = [false, true].map(&mut bits);
    BASELINE.set(false);
    assert!(dispatched.iter().any(|bits| *bits != 0), "{what}");
    assert_eq!(dispatched, baseline, "{what}");
}

/// Contacts from the cylinder to the nearly flat, and an ellipse.
fn contacts() -> impl Iterator<Item = Contact> {
    FLATS.map(contact).into_iter().chain([ellipse(1e-4, 2e-4)])
}

/// Pseudorandom values from -size to size.
fn scattered(count: usize, mut bits: u64, size: f64) -> Vec<f64> {
    let mut next = || {
        bits = bits.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        size * ((bits >> 11) as f64 / (1u64 << 52) as f64 - 1.0)
    };
    (0..count).map(|_| next()).collect()
}

#[test]
fn the_curve_and_a_path() {
    for contact in contacts() {
        let displacement = scattered(1000, 1, 1.1 * contact.slip_displacement);
        compare("curve", || {
            let (mut force, mut stiffness) = (vec![0.0; 1000], vec![0.0; 1000]);
            contact.responses(&displacement, Some(&mut force), Some(&mut stiffness));
            [force, stiffness].concat()
        });
        compare("path", || {
            let mut state = vec![0.0; state_length(64)];
            ConstantLoad::state_init(&mut state).unwrap();
            let [mut force, mut stiffness, mut dissipated] = [(); 3].map(|()| vec![0.0; 1000]);
            let [one, two, three] = [&mut force, &mut stiffness, &mut dissipated].map(|v| Some(v.as_mut_slice()));
            let output = PathOutput { force: one, tangent: two, dissipated: three };
            ConstantLoad::path(&contact, &mut state, &displacement, output);
            [force, stiffness, dissipated, state].concat()
        });
    }
}

#[test]
fn the_complex_stiffness() {
    let parts = [1e-3, 0.2, 0.399, 0.41, 0.75, 0.9, 0.98, 0.9999, 1.0, 1.0001, 1.01, 1.2, 1.7, 30.0];
    for contact in contacts() {
        let amplitudes = parts.map(|part| part * contact.slip_displacement);
        for amplitude in amplitudes {
            compare("complex stiffness", || {
                let k = contact.complex_stiffness(amplitude).unwrap();
                vec![k.real, k.imaginary, k.d_real, k.d_imag]
            });
        }
    }
}

#[test]
fn the_harmonic_force() {
    for contact in contacts() {
        for (harmonics, samples, seed) in
            [(1, 64), (2, 7), (5, 128), (9, 255), (12, 60)].into_iter().flat_map(|(h, s)| [(h, s, 3), (h, s, 4)])
        {
            let n = 2 * harmonics + 1;
            let mut displacement = scattered(n, seed, 0.8 * contact.slip_displacement);
            if seed == 4 {
                let even = displacement.iter_mut().enumerate().filter(|(k, _)| k.div_ceil(2) % 2 == 0);
                even.for_each(|(_, coefficient)| *coefficient = 0.0);
            }
            for rule in [Rule::UniformSampling, Rule::EventDriven] {
                compare(&std::format!("{harmonics} {samples} {rule:?}"), || {
                    let mut memory = workspace(rule, harmonics, samples);
                    let (force, jacobian, dissipated) = compute(&contact, &mut memory, &displacement);
                    let mut sensitivity = vec![0.0; crate::PARAMETERS * n];
                    let mut workspace = Workspace::new(&mut memory).unwrap();
                    harmonic_sensitivity(&contact, &mut workspace, &displacement, &mut sensitivity);
                    [force, jacobian, vec![dissipated], sensitivity].concat()
                });
            }
        }
    }
}

#[test]
fn an_element() {
    let material = [Material { young_modulus: 2.1e11, poisson_ratio: 0.3 }; 2];
    for (flat_half_width, input) in [(0.0, NormalInput::Approach), (1e-4, NormalInput::Force)] {
        let parameters = Parameters {
            flat_half_width,
            edge_radius: 5e-3,
            length: 0.02,
            normal_force: 60.0,
            friction_coefficient: 0.5,
            material,
            displacement_reference: crate::parameters::CENTRE_POINT,
            ..Parameters::default()
        };
        let [one, two] = [Directions::One, Directions::Two]
            .map(|directions| Element::rounded_flat(&parameters, directions, input).unwrap());
        let largest = if input == NormalInput::Approach { one.approach } else { one.normal_force };
        let unit = 0.5 * one.shift_under(60.0);
        compare("steps", || {
            let mut values = Vec::new();
            let mut memory = [vec![0.0; one_direction::state_length(32)], vec![0.0; TwoDirections::STATE_LENGTH]];
            OneDirection::state_init(&mut memory[0]).unwrap();
            TwoDirections::state_init(&mut memory[1]).unwrap();
            for motion in scattered(600, 7, 1.0).as_chunks::<3>().0 {
                let [u, v, w] = [2.0 * unit * motion[0], 2.0 * unit * motion[1], largest * (0.5 + 0.45 * motion[2])];
                let line = OneDirection::step(&one, &mut memory[0], [u, w]).unwrap();
                values.extend(line.force.iter().chain(&line.tangent).chain([&line.dissipated]));
                let plane = TwoDirections::step(&two, &mut memory[1], [u, v, w]).unwrap();
                values.extend(plane.force.iter().chain(&plane.tangent).chain([&plane.dissipated]));
            }
            values
        });
        for (harmonics, samples, size) in [(1, 64, 0.3), (2, 7, 0.3), (5, 128, 3.0), (9, 255, 0.3), (11, 60, 0.3)] {
            let n = 2 * harmonics + 1;
            let mut displacement = scattered(n, 5, size * unit);
            displacement.extend(scattered(n, 6, 0.5 * largest / n as f64));
            displacement[n] = 0.5 * largest;
            compare(&std::format!("one direction {harmonics} {samples}"), || {
                let mut memory = vec![0.0; line::workspace_length(harmonics, samples)];
                line::workspace_init(harmonics, samples, &mut memory).unwrap();
                let mut workspace = line::Workspace::new(&mut memory).unwrap();
                let (mut force, mut jacobian, mut dissipated) = (vec![0.0; 2 * n], vec![0.0; 4 * n * n], [0.0]);
                let output = HarmonicOutput {
                    force: Some(&mut force),
                    jacobian: Some(&mut jacobian),
                    dissipated: dissipated.first_mut(),
                    drift: None,
                };
                line::harmonic_force(&one, &mut workspace, &displacement, output).unwrap();
                [force, jacobian, dissipated.to_vec()].concat()
            });
        }
    }
}
