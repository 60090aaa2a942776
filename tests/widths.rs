//! The C interface dispatches to the SIMD instructions of the processor; the modules themselves are compiled for the baseline.
//! Both give the same bits.

use microslip::constant_load::masing::{self, PathOutput};
use microslip::constant_load::state::state_length;
use microslip::ffi::{
    MSLIP_EVENT_DRIVEN, MSLIP_UNIFORM_SAMPLING, mslip_complex_stiffness, mslip_contact, mslip_harmonic_force,
    mslip_harmonic_workspace_init, mslip_masing_path, mslip_monotonic_force, mslip_state_init,
};
use microslip::hbm::{HarmonicOutput, Rule, Workspace, harmonic_force};
use microslip::{Contact, Material, Parameters};
use std::ptr::null_mut;

fn contacts() -> Vec<Contact> {
    let body = Material { young_modulus: 2.1e11, poisson_ratio: 0.3 };
    [0.0, 1e-6, 1e-4, 1e-2]
        .iter()
        .flat_map(|&flat_half_width| [0.02, 4e-4].map(|length| (flat_half_width, length)))
        .filter_map(|(flat_half_width, length)| {
            Contact::rounded_flat(&Parameters {
                flat_half_width,
                edge_radius: 5e-3,
                length,
                normal_force: 3e3 * length,
                friction_coefficient: 0.5,
                material: [body; 2],
                ..Parameters::default()
            })
            .ok()
        })
        .collect()
}

/// Pseudorandom numbers from -1 to 1.
fn scattered(count: usize, seed: u64) -> Vec<f64> {
    let mut bits = seed;
    let mut next = || {
        bits = bits.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (bits >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    (0..count).map(|_| next()).collect()
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

fn as_c(contact: &Contact) -> mslip_contact {
    (*contact).into()
}

#[test]
fn the_curve_has_the_same_bits() {
    for contact in contacts() {
        let displacement: Vec<f64> = scattered(1000, 1).iter().map(|x| 1.1 * x * contact.slip_displacement).collect();
        let (mut force, mut stiffness) = (vec![0.0; 1000], vec![0.0; 1000]);
        let (f, k) = (force.as_mut_ptr(), stiffness.as_mut_ptr());
        // SAFETY: arrays of the given lengths.
        assert_eq!(unsafe { mslip_monotonic_force(&as_c(&contact), 1000, displacement.as_ptr(), f, k, null_mut()) }, 0);
        for ((&x, force), stiffness) in displacement.iter().zip(force).zip(stiffness) {
            let point = contact.curve_at_displacement(x).unwrap();
            assert_eq!(bits(&[point.force(), point.stiffness()]), bits(&[force, stiffness]));
        }
    }
}

#[test]
fn the_complex_stiffness_has_the_same_bits() {
    for contact in contacts() {
        for part in [1e-3, 0.2, 0.5, 0.75, 0.9, 0.98, 0.9999, 1.0, 1.01, 1.2, 30.0] {
            let amplitude = part * contact.slip_displacement;
            let mut outputs = [0.0; 4];
            let [a, b, c, d] = &mut outputs;
            // SAFETY: arrays of the given lengths.
            assert_eq!(unsafe { mslip_complex_stiffness(&as_c(&contact), 1, &raw const amplitude, a, b, c, d) }, 0);
            let k = contact.complex_stiffness(amplitude).unwrap();
            assert_eq!(bits(&[k.real(), k.imaginary(), k.d_real(), k.d_imag()]), bits(&outputs), "{part}");
        }
    }
}

#[test]
fn a_path_has_the_same_bits() {
    for contact in contacts() {
        let n = 2000;
        let path: Vec<f64> = scattered(n, 2).iter().map(|x| 0.9 * x * contact.slip_displacement).collect();
        let run = |through_c: bool| {
            let mut state = vec![0.0; state_length(64)];
            let [mut force, mut stiffness, mut energy] = [vec![0.0; n], vec![0.0; n], vec![0.0; n]];
            // SAFETY: arrays of the given lengths.
            assert_eq!(unsafe { mslip_state_init(state.len(), state.as_mut_ptr()) }, 0);
            if through_c {
                let (state, length) = (state.as_mut_ptr(), state.len());
                let [f, k, e] = [force.as_mut_ptr(), stiffness.as_mut_ptr(), energy.as_mut_ptr()];
                // SAFETY: arrays of the given lengths.
                let status =
                    unsafe { mslip_masing_path(&as_c(&contact), length, state, n, path.as_ptr(), state, f, k, e) };
                assert_eq!(status, 0);
            } else {
                let (force, stiffness) = (Some(force.as_mut_slice()), Some(stiffness.as_mut_slice()));
                let output = PathOutput { force, stiffness, dissipated: Some(&mut energy) };
                masing::path(&contact, &mut state, &path, output);
            }
            [bits(&force), bits(&stiffness), bits(&energy), bits(&state)]
        };
        assert_eq!(run(true), run(false));
    }
}

#[test]
fn the_harmonic_force_has_the_same_bits() {
    for contact in contacts() {
        let sizes = [(1, 64), (2, 7), (5, 128), (9, 255)];
        let rules = [(Rule::UniformSampling, MSLIP_UNIFORM_SAMPLING), (Rule::EventDriven, MSLIP_EVENT_DRIVEN)];
        for ((harmonics, samples), (rule, number)) in sizes.into_iter().flat_map(|size| rules.map(|rule| (size, rule)))
        {
            let n = 2 * harmonics + 1;
            for (seed, odd) in [(3, false), (4, true)] {
                let mut displacement: Vec<f64> =
                    scattered(n, seed).iter().map(|x| 0.8 * x * contact.slip_displacement).collect();
                if odd {
                    let even = displacement.iter_mut().enumerate().filter(|(k, _)| k.div_ceil(2) % 2 == 0);
                    even.for_each(|(_, coefficient)| *coefficient = 0.0);
                }
                let run = |through_c: bool| {
                    let mut memory = vec![0.0; rule.workspace_length(harmonics, samples)];
                    let (workspace, length) = (memory.as_mut_ptr(), memory.len());
                    // SAFETY: an array of the given length.
                    let status =
                        unsafe { mslip_harmonic_workspace_init(harmonics, samples, number, length, workspace) };
                    assert_eq!(status, 0);
                    let (mut force, mut jacobian, mut energy) = (vec![0.0; n], vec![0.0; n * n], 0.0);
                    if through_c {
                        let (f, j) = (force.as_mut_ptr(), jacobian.as_mut_ptr());
                        let u = displacement.as_ptr();
                        // SAFETY: arrays of the given lengths.
                        let status =
                            unsafe { mslip_harmonic_force(&as_c(&contact), workspace, u, f, j, &raw mut energy) };
                        assert_eq!(status, 0);
                    } else {
                        let (force, jacobian) = (Some(force.as_mut_slice()), Some(jacobian.as_mut_slice()));
                        let output = HarmonicOutput { force, jacobian, dissipated: Some(&mut energy) };
                        let mut workspace = Workspace::new(&mut memory).unwrap();
                        harmonic_force(&contact, &mut workspace, &displacement, output).unwrap();
                    }
                    [bits(&force), bits(&jacobian), bits(&[energy])]
                };
                assert_eq!(run(true), run(false), "{harmonics} {samples} {rule:?}");
            }
        }
    }
}
