use super::*;
use std::vec;
use std::vec::Vec;

/// Coefficients of a motion with nested loops, and of one with odd harmonics only.
pub(super) const SHAPE: [f64; 7] = [0.2, 0.5, -0.1, 0.05, 0.3, -0.35, 0.2];
pub(super) const ODD: [f64; 7] = [0.0, 0.8, 0.1, 0.0, 0.0, -0.2, 0.3];

pub(super) fn scaled(contact: &Contact, shape: &[f64], size: f64) -> Vec<f64> {
    shape.iter().map(|c| c * size * contact.slip_displacement).collect()
}

pub(crate) fn workspace(rule: Rule, harmonics: usize, samples: usize) -> Vec<f64> {
    let mut memory = vec![0.0; rule.workspace_length(harmonics, samples)];
    rule.workspace_init(harmonics, samples, &mut memory).unwrap();
    memory
}

/// Force, Jacobian and energy.
pub(crate) type All = (Vec<f64>, Vec<f64>, f64);

pub(crate) fn compute(contact: &Contact, memory: &mut [f64], displacement: &[f64]) -> All {
    let n = displacement.len();
    let (mut force, mut jacobian, mut energy) = (vec![f64::NAN; n], vec![f64::NAN; n * n], f64::NAN);
    let output = HarmonicOutput {
        force: Some(&mut force),
        jacobian: Some(&mut jacobian),
        dissipated: Some(&mut energy),
        drift: None,
    };
    evaluate(contact, memory, displacement, output).unwrap();
    (force, jacobian, energy)
}

/// Compiled once for all tests: the function itself is inlined into every caller.
#[inline(never)]
fn evaluate(contact: &Contact, memory: &mut [f64], displacement: &[f64], output: HarmonicOutput) -> Result<(), Error> {
    harmonic_force(contact, &mut Workspace::new(memory).unwrap(), displacement, output)
}
