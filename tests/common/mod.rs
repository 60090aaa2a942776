//! Calls of the library, each compiled once for all tests of a crate: the functions themselves are inlined into every caller; and
//! random numbers.
#![allow(dead_code, reason = "not every crate uses all of them")]

pub mod one_direction;
pub mod two_directions;

use microslip::Contact;
use microslip::constant_load::harmonic_force::{HarmonicOutput, Rule, Workspace, harmonic_force};
use microslip::constant_load::state::state_length;
use microslip::constant_load::{ConstantLoad, Law};

/// Force and Jacobian, column-major, and dissipated energy of a motion of n coefficients.
pub fn outputs<E>(
    n: usize,
    compute: impl FnOnce(HarmonicOutput) -> Result<(), E>,
) -> Result<(Vec<f64>, Vec<f64>, f64), E> {
    let (mut force, mut jacobian, mut dissipated) = (vec![f64::NAN; n], vec![f64::NAN; n * n], f64::NAN);
    compute(HarmonicOutput {
        force: Some(&mut force),
        jacobian: Some(&mut jacobian),
        dissipated: Some(&mut dissipated),
        drift: None,
    })?;
    Ok((force, jacobian, dissipated))
}

/// Those of a contact.
#[inline(never)]
pub fn harmonic(contact: &Contact, rule: Rule, samples: usize, displacement: &[f64]) -> (Vec<f64>, Vec<f64>, f64) {
    let harmonics = displacement.len() / 2;
    let mut memory = vec![0.0; rule.workspace_length(harmonics, samples)];
    rule.workspace_init(harmonics, samples, &mut memory).unwrap();
    let mut workspace = Workspace::new(&mut memory).unwrap();
    outputs(displacement.len(), |output| harmonic_force(contact, &mut workspace, displacement, output)).unwrap()
}

/// Uniform random numbers: a linear congruential generator of 64 bits.
pub struct Random(pub u64);

impl Random {
    /// From 0 to 1.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// From -1 to 1.
    pub fn signed(&mut self) -> f64 {
        2.0 * self.next() - 1.0
    }

    pub fn below(&mut self, bound: usize) -> usize {
        (self.next() * bound as f64) as usize
    }
}

/// The seed of random cases: `MICROSLIP_SEED`, or 1.
pub fn seed() -> u64 {
    std::env::var("MICROSLIP_SEED").map_or(1, |seed| seed.parse().expect("MICROSLIP_SEED is a number"))
}

pub fn unloaded(reversals: usize) -> Vec<f64> {
    let mut state = vec![0.0; state_length(reversals)];
    ConstantLoad::state_init(&mut state).unwrap();
    state
}

/// Advances a state; force, stiffness and dissipated energy.
#[inline(never)]
pub fn advance(contact: &Contact, state: &mut [f64], displacement: f64) -> (f64, f64, f64) {
    let step = ConstantLoad::step(contact, state, displacement).unwrap();
    (step.force, step.tangent, step.dissipated)
}

/// A state after decimal text of this number of significant digits, as C and Fortran print it.
pub fn as_text(state: &[f64], digits: usize) -> Vec<f64> {
    state.iter().map(|value| format!("{value:.*e}", digits - 1).parse().unwrap()).collect()
}
