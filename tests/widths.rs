//! The C interface dispatches to the SIMD instructions of the processor; the Rust interface is compiled for the baseline. Both give
//! the same bits.

mod common;

use common::{harmonic, unloaded};
use microslip::constant_load::masing::{self, PathOutput};
use microslip::ffi::{
    MSLIP_EVENT_DRIVEN, MSLIP_UNIFORM_SAMPLING, mslip_complex_stiffness, mslip_complex_stiffness_tabulated,
    mslip_contact, mslip_element_harmonic_force, mslip_harmonic_force, mslip_harmonic_workspace_init,
    mslip_masing_path, mslip_monotonic_force, mslip_stiffness_table_init, mslip_stiffness_table_length,
};
use microslip::hbm::Rule;
use microslip::varying_load::element::{Directions, Element, NormalInput};
use microslip::varying_load::harmonic_force::{self, HarmonicOutput, Workspace};
use microslip::{Contact, Material, Parameters};
use std::ptr::null_mut;

/// Contacts from the cylinder to the nearly flat, slender and short, each also as in C.
fn contacts() -> Vec<(Contact, mslip_contact)> {
    let material = [Material { young_modulus: 2.1e11, poisson_ratio: 0.3 }; 2];
    let sizes = [0.0, 1e-6, 1e-4, 1e-2].iter().flat_map(|&flat| [0.02, 4e-4].map(|length| (flat, length)));
    sizes
        .filter_map(|(flat_half_width, length)| {
            let contact = Contact::rounded_flat(&Parameters {
                flat_half_width,
                edge_radius: 5e-3,
                length,
                normal_force: 3e3 * length,
                friction_coefficient: 0.5,
                material,
                ..Parameters::default()
            });
            contact.ok().map(|contact| (contact, contact.into()))
        })
        .collect()
}

/// Pseudorandom values from -size to size.
fn scattered(count: usize, mut bits: u64, size: f64) -> Vec<f64> {
    let mut next = || {
        bits = bits.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        size * ((bits >> 11) as f64 / (1u64 << 52) as f64 - 1.0)
    };
    (0..count).map(|_| next()).collect()
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

#[test]
fn the_curve_has_the_same_bits() {
    for (contact, in_c) in contacts() {
        let displacement = scattered(1000, 1, 1.1 * contact.slip_displacement);
        let (mut force, mut stiffness) = (vec![0.0; 1000], vec![0.0; 1000]);
        let (f, k) = (force.as_mut_ptr(), stiffness.as_mut_ptr());
        // SAFETY: arrays of the given lengths.
        assert_eq!(unsafe { mslip_monotonic_force(&raw const in_c, 1000, displacement.as_ptr(), f, k, null_mut()) }, 0);
        for ((&x, force), stiffness) in displacement.iter().zip(force).zip(stiffness) {
            let point = contact.curve_at_displacement(x).unwrap();
            assert_eq!(bits(&[point.force(), point.stiffness()]), bits(&[force, stiffness]));
        }
    }
}

#[test]
fn the_complex_stiffness_has_the_same_bits() {
    for (contact, in_c) in contacts() {
        for part in [1e-3, 0.2, 0.5, 0.75, 0.9, 0.98, 0.9999, 1.0, 1.01, 1.2, 30.0] {
            let amplitude = part * contact.slip_displacement;
            let mut outputs = [0.0; 4];
            let [a, b, c, d] = &mut outputs;
            // SAFETY: arrays of the given lengths.
            assert_eq!(unsafe { mslip_complex_stiffness(&raw const in_c, 1, &raw const amplitude, a, b, c, d) }, 0);
            let k = contact.complex_stiffness(amplitude).unwrap();
            assert_eq!(bits(&[k.real(), k.imaginary(), k.d_real(), k.d_imag()]), bits(&outputs), "{part}");
        }
    }
}

/// Four amplitudes at once, and one.
#[test]
fn a_stiffness_table_has_the_same_bits() {
    for (contact, in_c) in contacts() {
        let length = mslip_stiffness_table_length();
        let mut table = vec![0.0; length];
        // SAFETY: an array of the given length.
        assert_eq!(unsafe { mslip_stiffness_table_init(&raw const in_c, length, table.as_mut_ptr()) }, 0);
        let parts = [1e-3, 0.2, 0.399, 0.41, 0.75, 0.98, 0.9999, 1.0, 1.0001, 1.2, 1.7, 30.0];
        let amplitude = parts.map(|part| part * contact.slip_displacement);
        let run = |amplitude: &[f64]| {
            let mut outputs = [(); 4].map(|()| vec![0.0; amplitude.len()]);
            let [a, b, c, d] = outputs.each_mut().map(Vec::as_mut_ptr);
            let (x, n, table) = (amplitude.as_ptr(), amplitude.len(), table.as_ptr());
            // SAFETY: arrays of the given lengths.
            let status = unsafe { mslip_complex_stiffness_tabulated(&raw const in_c, table, n, x, a, b, c, d) };
            assert_eq!(status, 0);
            outputs
        };
        let all = run(&amplitude);
        for i in 0..parts.len() {
            let one = run(&amplitude[i..=i]);
            assert!(all.iter().zip(one).all(|(all, one)| all[i].to_bits() == one[0].to_bits()), "{}", parts[i]);
        }
    }
}

#[test]
fn a_path_has_the_same_bits() {
    for (contact, in_c) in contacts() {
        let n = 2000;
        let path = scattered(n, 2, 0.9 * contact.slip_displacement);
        let run = |through_c: bool| {
            let mut state = unloaded(64);
            let [mut force, mut stiffness, mut dissipated] = [vec![0.0; n], vec![0.0; n], vec![0.0; n]];
            if through_c {
                let (state, length) = (state.as_mut_ptr(), state.len());
                let [f, k, e] = [&mut force, &mut stiffness, &mut dissipated].map(Vec::as_mut_ptr);
                let (contact, path) = (&raw const in_c, path.as_ptr());
                // SAFETY: arrays of the given lengths.
                let status = unsafe { mslip_masing_path(contact, length, state, n, path, state, f, k, e) };
                assert_eq!(status, 0);
            } else {
                let [force, stiffness, dissipated] =
                    [&mut force, &mut stiffness, &mut dissipated].map(|v| Some(v.as_mut_slice()));
                masing::path(&contact, &mut state, &path, PathOutput { force, stiffness, dissipated });
            }
            [force, stiffness, dissipated, state].map(|values| bits(&values))
        };
        assert_eq!(run(true), run(false));
    }
}

#[test]
fn the_harmonic_force_has_the_same_bits() {
    for (contact, in_c) in contacts() {
        for (harmonics, samples, seed) in
            [(1, 64), (2, 7), (5, 128), (9, 255)].into_iter().flat_map(|(h, s)| [(h, s, 3), (h, s, 4)])
        {
            for (rule, number) in
                [(Rule::UniformSampling, MSLIP_UNIFORM_SAMPLING), (Rule::EventDriven, MSLIP_EVENT_DRIVEN)]
            {
                let n = 2 * harmonics + 1;
                let mut displacement = scattered(n, seed, 0.8 * contact.slip_displacement);
                if seed == 4 {
                    let even = displacement.iter_mut().enumerate().filter(|(k, _)| k.div_ceil(2) % 2 == 0);
                    even.for_each(|(_, coefficient)| *coefficient = 0.0);
                }
                let mut workspace = vec![0.0; rule.workspace_length(harmonics, samples)];
                let (mut force, mut jacobian, mut energy) = (vec![0.0; n], vec![0.0; n * n], 0.0);
                let (w, f, j, u) =
                    (workspace.as_mut_ptr(), force.as_mut_ptr(), jacobian.as_mut_ptr(), displacement.as_ptr());
                // SAFETY: arrays of the given lengths.
                unsafe {
                    assert_eq!(mslip_harmonic_workspace_init(harmonics, samples, number, workspace.len(), w), 0);
                    assert_eq!(mslip_harmonic_force(&raw const in_c, w, u, f, j, &raw mut energy), 0);
                }
                let expected = harmonic(&contact, rule, samples, &displacement);
                let expected = [bits(&expected.0), bits(&expected.1), bits(&[expected.2])];
                assert_eq!(
                    [bits(&force), bits(&jacobian), bits(&[energy])],
                    expected,
                    "{harmonics} {samples} {rule:?}"
                );
            }
        }
    }
}

#[test]
fn the_harmonic_force_of_an_element_has_the_same_bits() {
    let material = [Material { young_modulus: 2.1e11, poisson_ratio: 0.3 }; 2];
    for (flat_half_width, input) in [(0.0, NormalInput::Approach), (1e-4, NormalInput::Force)] {
        let parameters = Parameters {
            flat_half_width,
            edge_radius: 5e-3,
            length: 0.02,
            normal_force: 60.0,
            friction_coefficient: 0.5,
            material,
            ..Parameters::default()
        };
        let element = Element::rounded_flat(&parameters, Directions::One, input).unwrap();
        let largest = if input == NormalInput::Approach { element.approach } else { element.normal_force };
        for (harmonics, samples, size) in [(1, 64, 0.3), (2, 7, 0.3), (5, 128, 3.0), (9, 255, 0.3), (11, 60, 0.3)] {
            let n = 2 * harmonics + 1;
            let mut displacement = scattered(n, 5, size * 0.5 * element.shift_under(60.0));
            displacement.extend(scattered(n, 6, 0.5 * largest / n as f64));
            displacement[n] = 0.5 * largest;
            let mut workspace = vec![0.0; harmonic_force::workspace_length(harmonics, samples)];
            harmonic_force::workspace_init(harmonics, samples, &mut workspace).unwrap();
            let run = |workspace: &mut [f64], in_c: bool| {
                let (mut force, mut jacobian, mut energy) = (vec![0.0; 2 * n], vec![0.0; 4 * n * n], [0.0]);
                if in_c {
                    let element = (&raw const element).cast();
                    let (w, u) = (workspace.as_mut_ptr(), displacement.as_ptr());
                    let (f, j, e) = (force.as_mut_ptr(), jacobian.as_mut_ptr(), energy.as_mut_ptr());
                    // SAFETY: an element, a workspace, and arrays of the given lengths.
                    assert_eq!(unsafe { mslip_element_harmonic_force(element, w, u, f, j, e) }, 0);
                } else {
                    let output = HarmonicOutput {
                        force: Some(&mut force),
                        jacobian: Some(&mut jacobian),
                        dissipated: energy.first_mut(),
                    };
                    let mut workspace = Workspace::new(workspace).unwrap();
                    harmonic_force::harmonic_force(&element, &mut workspace, &displacement, output).unwrap();
                }
                [bits(&force), bits(&jacobian), bits(&energy)]
            };
            assert_eq!(run(&mut workspace, true), run(&mut workspace, false), "{harmonics} {samples}");
        }
    }
}
