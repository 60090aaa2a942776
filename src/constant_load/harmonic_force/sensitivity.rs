//! Derivatives of the harmonic force with respect to the parameters of the contact, for both quadrature rules.
//!
//! At a fixed displacement the instants of the reversals are fixed, and the force is continuous when a loop closes or gross slip
//! starts. The derivatives at a point are therefore the sum of two terms: the derivatives at the reversal that its branch leaves,
//! and the derivatives of the curve along the branch.

use crate::constant_load::steady_state::SteadyState;
use crate::numerics::slices::PanicFreeSlice;
use crate::parameters::Sensitivity;

/// The derivatives at the reversals on the stack; both rules keep them where the Jacobian has its terms of the reversals.
pub(super) struct ReversalSensitivities<'a>(&'a mut [Sensitivity]);

impl<'a> ReversalSensitivities<'a> {
    pub fn new(memory: &'a mut [f64]) -> ReversalSensitivities<'a> {
        ReversalSensitivities(memory.blocks_mut())
    }

    /// Stores the derivatives at the reversal that the present branch leaves.
    pub fn store(&mut self, steady_state: &SteadyState, sensitivity: Sensitivity) {
        self.0.set(steady_state.branch().depth.wrapping_sub(1), sensitivity);
    }

    /// The derivatives at a displacement on the present branch.
    pub fn sensitivity(&self, steady_state: &SteadyState, displacement: f64) -> Sensitivity {
        let (start, along) =
            (self.0.or_zero(steady_state.branch().depth.wrapping_sub(1)), steady_state.sensitivity(displacement));
        core::array::from_fn(|parameter| start[parameter] + along[parameter])
    }
}

#[cfg(test)]
mod tests {
    use crate::Contact;
    use crate::constant_load::harmonic_force::tests::{ODD, SHAPE, compute, scaled, workspace};
    use crate::constant_load::harmonic_force::{Rule, Workspace, harmonic_sensitivity};
    use crate::constant_load::sensitivity::tests::{cases, differences};
    use crate::parameters::PARAMETERS;
    use std::vec;
    use std::vec::Vec;

    const RULES: [Rule; 2] = [Rule::UniformSampling, Rule::EventDriven];

    fn sensitivity(contact: &Contact, memory: &mut [f64], displacement: &[f64]) -> Vec<f64> {
        let mut sensitivity = vec![f64::NAN; PARAMETERS * displacement.len()];
        harmonic_sensitivity(contact, &mut Workspace::new(memory).unwrap(), displacement, &mut sensitivity);
        sensitivity
    }

    /// Nested loops and odd harmonics, from microslip to gross slip; an odd number of samples too.
    #[test]
    fn derivatives_agree_with_differences() {
        for case in cases() {
            let contact = case.0(case.1);
            for (shape, size) in
                [&SHAPE[..], &ODD].into_iter().flat_map(|shape| [1e-6, 0.3, 0.9, 1.2, 4.0].map(|size| (shape, size)))
            {
                let motion = scaled(&contact, shape, size);
                for (rule, samples) in [(RULES[0], 64), (RULES[0], 63), (RULES[1], 256)] {
                    let mut memory = workspace(rule, shape.len() / 2, samples);
                    let exact = sensitivity(&contact, &mut memory, &motion);
                    let found = differences(&case, |contact| {
                        compute(contact, &mut workspace(rule, shape.len() / 2, samples), &motion).0
                    });
                    for (exact, (found, scale)) in exact.chunks(shape.len()).zip(&found) {
                        for (exact, found) in exact.iter().zip(found) {
                            let error = ((exact - found) / scale / size.min(1.0)).abs();
                            // Central differences with h = 1e-5, one-sided ones by a.
                            assert!(error < 2e-6, "{:?} {size} {rule:?}: {error:e}", case.1);
                        }
                    }
                }
            }
        }
    }

    /// A contact of little friction slips all the time: its derivatives are those without friction.
    #[test]
    fn derivatives_without_friction_are_one_sided() {
        for (with_friction, values) in cases() {
            let [normal_force, friction_coefficient, other @ ..] = values;
            let at = |normal: f64, friction: f64| {
                let [a, radius, length, factor, layer] = other;
                let (normal_force, friction) = (normal_force * normal, friction_coefficient * friction);
                with_friction([normal_force, friction, a, radius, length, factor, layer])
            };
            let displacement = scaled(&at(1.0, 1.0), &SHAPE, 1.0);
            for rule in RULES {
                let mut memory = workspace(rule, 3, 64);
                let [none, little] =
                    [0.0, 1e-9].map(|friction| sensitivity(&at(1.0, friction), &mut memory, &displacement));
                for (i, (none, little)) in none.iter().zip(&little).enumerate() {
                    // Those by the compliance of a layer over the stiffness.
                    let unit = if i < 42 { 1.0 } else { at(1.0, 1.0).initial_stiffness };
                    // It sticks for some times the square root of 1e-9 of the period after each reversal.
                    assert!((none - little).abs() < 1e-3 * normal_force * unit, "{none} {little}");
                }
                // The mean square of a wave that is +1 or -1 is 1; three harmonics hold most of it.
                let square: f64 = none[7..14].iter().map(|derivative| derivative * derivative).sum();
                assert!(square.sqrt() > 0.5 * normal_force);
                assert_eq!(sensitivity(&at(1.0, 1.0), &mut memory, &[0.0; 7]), [0.0; 49]);
            }
        }
    }
}
