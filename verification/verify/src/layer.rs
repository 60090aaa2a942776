//! Contacts with a layer in series: the monotonic curve, its inverse and the energy per cycle, at a constant normal force.

use crate::call;
use crate::curve::{at_displacement, at_force, half_share, share_of_slip};
use crate::sampler::{Case, Sampler};
use crate::tally::Tally;
use microslip::{EllipticParameters, Layer, Parameters};
use reference::{Input, Reference};

/// The input with a random layer, for a contact of the given stiffness.
pub fn random_input(input: &Input, stiffness: f64, sampler: &mut Sampler) -> Input {
    let (Input::Flat(Parameters { normal_force, .. }) | Input::Ellipse(EllipticParameters { normal_force, .. })) =
        input;
    let tangential_compliance = sampler.power(-3.0, 3.0) / stiffness;
    let stiffening_load = if sampler.chance(0.3) { f64::INFINITY } else { normal_force * sampler.power(-3.0, 2.0) };
    input.with_layer(Layer { normal_compliance: 0.0, tangential_compliance, stiffening_load, reference_load: 0.0 })
}

/// The contact with a layer, if the library accepts it.
pub fn with_layer(case: &Case, input: Input) -> Option<Case> {
    Some(Case { contact: call::prepare(&input)?, reference: Reference::new(input), kind: case.kind })
}

/// The contact with a random layer that the library accepts.
pub fn random(case: &Case, sampler: &mut Sampler) -> Case {
    loop {
        let input = random_input(&case.reference.input, case.contact.initial_stiffness, sampler);
        if let Some(layered) = with_layer(case, input) {
            return layered;
        }
    }
}

/// Curve, inverse and energy of a contact with a layer.
pub fn curve(case: &Case, sampler: &mut Sampler, tally: &mut Tally) {
    let layered = random(case, sampler);
    let half = half_share(&layered);
    for _ in 0..10 {
        let (share, range) = sampler.share_of_force();
        at_force(&layered, share * layered.contact.slip_force, range, tally);
        let (share, range) = share_of_slip(sampler, half);
        at_displacement(&layered, share * layered.contact.slip_displacement, range, tally);
    }
}
