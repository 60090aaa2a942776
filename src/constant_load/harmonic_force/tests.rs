use super::*;
use crate::constant_load::contact::tests::contact;
use std::vec;
use std::vec::Vec;

const RULES: [Rule; 2] = [Rule::UniformSampling, Rule::EventDriven];

/// Coefficients of a motion with nested loops, and of one with odd harmonics only.
pub(super) const SHAPE: [f64; 7] = [0.2, 0.5, -0.1, 0.05, 0.3, -0.35, 0.2];
pub(super) const ODD: [f64; 7] = [0.0, 0.8, 0.1, 0.0, 0.0, -0.2, 0.3];

pub(super) fn scaled(contact: &Contact, shape: &[f64], size: f64) -> Vec<f64> {
    shape.iter().map(|c| c * size * contact.slip_displacement).collect()
}

pub(super) fn workspace(rule: Rule, harmonics: usize, samples: usize) -> Vec<f64> {
    let mut memory = vec![0.0; rule.workspace_length(harmonics, samples)];
    rule.workspace_init(harmonics, samples, &mut memory).unwrap();
    memory
}

/// Force, Jacobian and energy.
pub(super) type All = (Vec<f64>, Vec<f64>, f64);

pub(super) fn compute(contact: &Contact, memory: &mut [f64], displacement: &[f64]) -> All {
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

#[test]
fn an_invalid_header_or_length_of_a_workspace_is_rejected() {
    for rule in RULES {
        let good = workspace(rule, 3, 16);
        for (index, value) in
            [(0, 0.0), (0, f64::NAN), (0, good[1]), (1, 0.0), (1, 16.0), (1, f64::INFINITY), (1, good[0])]
        {
            let mut bad = good.clone();
            bad[index] = value;
            assert_eq!(Workspace::new(&mut bad).map(|_| ()), Err(Error::BadWorkspace), "{index} {value}");
        }
        let mut short = good.clone();
        short.pop();
        assert_eq!(Workspace::new(&mut short).map(|_| ()), Err(Error::BadWorkspace));
        assert_eq!(Workspace::new(&mut []).map(|_| ()), Err(Error::BadWorkspace));
        let header = good.first_chunk().unwrap();
        let (found, Size { harmonics, samples, .. }, length) = workspace_size(header).unwrap();
        assert_eq!((found, harmonics, samples, length), (rule, 3, 16, good.len()));
        // Memory beyond the extent is not written.
        let mut long = vec![-1.0; good.len() + 2];
        rule.workspace_init(3, 16, &mut long).unwrap();
        let contact = contact(50e-6);
        compute(&contact, &mut long, &scaled(&contact, &SHAPE, 1.0));
        assert_eq!(long.get(good.len()..), Some(&[-1.0, -1.0][..]));
    }
    // Neither rule accepts a workspace of the other.
    let [mut one, mut two] = RULES.map(|rule| workspace(rule, 3, 16));
    assert!(matches!(event_driven::Workspace::open(&mut one), Err(Error::BadWorkspace)));
    assert!(matches!(uniform_sampling::Workspace::open(&mut two), Err(Error::BadWorkspace)));
}

#[test]
fn results_do_not_depend_on_earlier_use_of_the_workspace() {
    for rule in RULES {
        let (contact, mut memory) = (contact(50e-6), workspace(rule, 3, 32));
        let motion = |size: f64| scaled(&contact, &SHAPE, size);
        let first = compute(&contact, &mut memory, &motion(0.8));
        compute(&contact, &mut memory, &motion(-3.0));
        assert_eq!(compute(&contact, &mut memory, &motion(0.8)), first);
        // Omitted outputs do not change the others.
        let mut force = vec![0.0; 7];
        let output = HarmonicOutput { force: Some(&mut force), jacobian: None, dissipated: None, drift: None };
        evaluate(&contact, &mut memory, &motion(0.8), output).unwrap();
        assert_eq!(force, first.0);
    }
}
