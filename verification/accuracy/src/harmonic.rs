//! The harmonic force: by its definition for uniform sampling, and by the exact integrals for one harmonic and the event-driven rule.

use crate::call;
use crate::cases::{Case, Dice, text};
use crate::history::{Memory, stiffness};
use crate::real::Real;
use crate::tally::Tally;
use microslip::ffi::MSLIP_UNIFORM_SAMPLING;

/// Coefficients, in displacements of gross slip.
fn coefficients(dice: &mut Dice, harmonics: usize) -> Vec<f64> {
    let size = match dice.below(4) {
        0 => dice.power(-6.0, -1.0),
        1 => dice.power(0.0, 2.0),
        _ => dice.between(0.1, 1.5),
    };
    let mean = if dice.chance(0.5) { size * dice.between(-1.0, 1.0) } else { 0.0 };
    let mut all = vec![mean];
    for k in 1..=harmonics {
        let share = if k == 1 { 1.0 } else { dice.power(-3.0, 0.0) };
        all.extend([size * share * dice.between(-1.0, 1.0), size * share * dice.between(-1.0, 1.0)]);
    }
    all
}

/// One displacement by uniform sampling.
pub fn uniform_sampling(case: &Case, dice: &mut Dice, tally: &mut Tally) {
    let Case { contact, reference, kind } = case;
    let law = reference.law(50);
    let (harmonics, samples, range) = [
        (1, 8, "H = 1, 8 samples"),
        (2, 16, "H = 2, 16"),
        (4, 16, "H = 4, 16"),
        (7, 16, "H = 7, 16"),
        (3, 64, "H = 3, 64"),
    ][dice.below(5)];
    let mut workspace = call::workspace(harmonics, samples, MSLIP_UNIFORM_SAMPLING);
    let displacement: Vec<f64> =
        coefficients(dice, harmonics).iter().map(|share| share * contact.slip_displacement).collect();
    let (force, jacobian, dissipated) = call::harmonic(contact, &mut workspace, &displacement);
    let width = displacement.len();
    let bits = law.bits;
    let basis: Vec<Vec<Real>> = (0..samples)
        .map(|i| {
            let mut row = vec![law.real(1.0)];
            for k in 1..=harmonics {
                let turn = (i * k % samples) as f64;
                let (sine, cosine) = (2.0 * Real::pi(bits) * turn / samples as f64).sin_cos();
                row.extend([cosine, sine]);
            }
            row
        })
        .collect();
    let given: Vec<Real> = displacement.iter().map(|u| law.real(*u) / &law.displacement_unit).collect();
    let total: f64 = given.iter().map(|u| u.abs().f64()).sum();
    let zero = || law.real(0.0);
    let mut memory = Memory::new(law.clone(), contact);
    let (mut sums, mut slopes) = (vec![zero(); width], vec![zero(); width * width]);
    let (mut energy, mut energy_size, mut size, mut condition) = (zero(), zero(), 0.0f64, 0.0f64);
    for step in 0..2 * samples {
        let i = step % samples;
        let u = basis[i].iter().zip(&given).fold(zero(), |sum, (b, u)| sum + b * u);
        let (lost, lost_size) = memory.go(&u, i, step >= samples);
        if step < samples {
            continue;
        }
        (energy, energy_size) = (energy + lost, energy_size + lost_size);
        size = size.max(memory.now().size.f64());
        let mut slope = vec![zero(); width];
        for pair in memory.reversals.windows(2) {
            let Some(point) = &pair[1].point else { continue };
            if (&point.approach / &law.slip_approach - 1.0).abs().f64() < 1e-9 && !point.rest.is_zero() {
                return; // the Jacobian jumps
            }
            let (stiff, _) = stiffness(point);
            if !point.rest.is_zero() {
                let rate = (&point.curvature * &stiff * &stiff * &stiff).f64() * total;
                condition = condition.max(rate * law.full_stick.f64()).max(stiff.f64());
            }
            for (j, slope) in slope.iter_mut().enumerate() {
                let before = if pair[0].sample == usize::MAX { zero() } else { basis[pair[0].sample][j].clone() };
                *slope = slope.clone() + &stiff * (&basis[pair[1].sample][j] - before);
            }
        }
        for l in 0..width {
            let weight = &basis[i][l] * if l == 0 { 1.0 } else { 2.0 } / samples as f64;
            sums[l] = &sums[l] + &weight * &memory.now().force;
            for j in 0..width {
                slopes[l + width * j] = &slopes[l + width * j] + &weight * &slope[j];
            }
        }
    }
    let place = || format!("{} samples {samples} u {displacement:?}", text(&reference.given));
    let soft = 1.0 / law.full_stick.f64();
    // A sample's displacement has the rounding of all coefficients.
    let scale = &law.slip_force * (size + soft * total);
    for (got, exact) in force.iter().zip(&sums) {
        tally.check_scaled(("harmonic_force", kind, range), *got, &(&law.slip_force * exact), &scale, soft, place);
    }
    let scale = &law.stiffness_unit / &law.full_stick;
    for (got, exact) in jacobian.iter().zip(&slopes) {
        let exact = &law.stiffness_unit * exact;
        tally.check_scaled(("harmonic_jacobian", kind, range), *got, &exact, &scale, soft + condition, place);
    }
    let unit = law.energy_unit();
    let scale = &unit * (energy_size + if total > law.slip_approach.f64() { 4.0 * total } else { 0.0 });
    tally.check_scaled(("harmonic_dissipated", kind, range), dissipated, &(&unit * energy), &scale, 3.0 * soft, place);
}
