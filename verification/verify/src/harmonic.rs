//! The harmonic force by uniform sampling, against the definition of that rule.

use crate::call;
use crate::sampler::{Case, Sampler, text};
use crate::tally::Tally;
use reference::harmonic::sampled;

/// Coefficients, in displacements of gross slip.
fn coefficients(sampler: &mut Sampler, harmonics: usize) -> Vec<f64> {
    let size = match sampler.below(4) {
        0 => sampler.power(-6.0, -1.0),
        1 => sampler.power(0.0, 2.0),
        _ => sampler.between(0.1, 1.5),
    };
    let mean = if sampler.chance(0.5) { size * sampler.between(-1.0, 1.0) } else { 0.0 };
    let mut all = vec![mean];
    for k in 1..=harmonics {
        let share = if k == 1 { 1.0 } else { sampler.power(-3.0, 0.0) };
        all.extend([size * share * sampler.between(-1.0, 1.0), size * share * sampler.between(-1.0, 1.0)]);
    }
    all
}

pub fn uniform_sampling(case: &Case, sampler: &mut Sampler, tally: &mut Tally) {
    let (harmonics, samples, range) = [
        (1, 8, "H = 1, 8 samples"),
        (2, 16, "H = 2, 16"),
        (4, 16, "H = 4, 16"),
        (7, 16, "H = 7, 16"),
        (3, 64, "H = 3, 64"),
    ][sampler.below(5)];
    let displacement: Vec<f64> =
        coefficients(sampler, harmonics).iter().map(|share| share * case.contact.slip_displacement).collect();
    at(case, samples, &displacement, range, tally);
}

pub fn at(case: &Case, samples: usize, displacement: &[f64], range: &'static str, tally: &mut Tally) {
    let Case { contact, reference, kind } = case;
    let law = reference.law(50);
    let (force, jacobian, dissipated) = call::harmonic(contact, samples, displacement);
    let u: Vec<_> = displacement.iter().map(|u| law.x(*u)).collect();
    let total: f64 = u.iter().map(|u| u.abs().f64()).sum();
    let (mut condition, mut jumps) = (0.0f64, false);
    let exact = sampled(&law, &u, samples, |history| {
        for point in history.reversals.iter().map(|reversal| &reversal.point).filter(|point| !point.slips()) {
            jumps |= (&point.x / &law.x_slip - 1.0).abs().f64() < 1e-9;
            let stiffness = point.stiffness();
            let rate = (&point.curvature * &stiffness * &stiffness * &stiffness).f64() * total;
            condition = condition.max(rate * law.full_stick.f64()).max(stiffness.f64());
        }
    });
    if jumps {
        return; // the Jacobian is discontinuous at gross slip
    }
    let mut at = tally.at(kind, range, || format!("{} samples {samples} u {displacement:?}", text(&reference.input)));
    let soft = 1.0 / law.full_stick.f64();
    // The displacement of a sample has the rounding of all coefficients.
    let scale = &law.slip_force * law.real(exact.size + soft * total);
    for (got, exact) in force.iter().zip(&exact.force) {
        at.check_scaled("harmonic_force", *got, &(&law.slip_force * exact), &scale, soft);
    }
    let scale = &law.stiffness_unit / &law.full_stick;
    for (got, exact) in jacobian.iter().zip(&exact.jacobian) {
        let exact = &law.stiffness_unit * exact;
        at.check_scaled("harmonic_jacobian", *got, &exact, &scale, soft + condition);
    }
    let slip = if total > law.x_slip.f64() { 4.0 * total } else { 0.0 };
    let scale = law.energy_unit() * (&exact.dissipated.size + slip);
    let exact = law.energy_unit() * &exact.dissipated.energy;
    at.check_scaled("harmonic_dissipated", dissipated, &exact, &scale, 3.0 * soft);
}
