//! Complex stiffness, and the equivalent spring-slider.

use crate::bounds::find;
use crate::call;
use crate::curve::{half_share, share_of_slip};
use crate::sampler::{Case, Sampler, text};
use crate::tally::Tally;
use reference::Real;
use reference::stiffness::{cycle_energy, imaginary_part, real_part};
use std::f64::consts::PI;

/// Some amplitudes of a contact: each is a quadrature.
pub fn at_amplitudes(case: &Case, sampler: &mut Sampler, tally: &mut Tally) {
    let half = half_share(case);
    for _ in 0..5 {
        let (share, range) = match sampler.below(4) {
            0 => (sampler.between(1.0, 3.0), "beyond slip"),
            1 if sampler.chance(0.5) => (sampler.power(0.0, 12.0), "beyond slip"),
            2 if sampler.chance(0.2) => (sampler.near(1.05, 64), "switches"),
            _ => share_of_slip(sampler, half),
        };
        if (share - 1.0).abs() > 1e-5 {
            at_amplitude(case, share * case.contact.slip_displacement, range, tally);
        }
    }
}

pub fn at_amplitude(case: &Case, amplitude: f64, range: &'static str, tally: &mut Tally) {
    let Case { contact, reference, kind } = case;
    let got = call::complex_stiffness(contact, amplitude);
    let (law, point) = reference.at_displacement(amplitude);
    let mut at = tally.at(kind, range, || format!("{} A {amplitude:e}", text(&reference.input)));
    let x = law.x(amplitude);
    let energy = cycle_energy(&law, &x, &point).0;
    let [imaginary, imaginary_rate] = imaginary_part(&law, &x, &point);
    let soft = 1.0 / law.full_stick.f64();
    let unit = &law.stiffness_unit;
    let slope_unit = unit / &law.displacement_unit;
    // Beyond gross slip E = E_slip + 4 (x - x_s), with the promised error of x_s.
    let slips = amplitude > contact.slip_displacement;
    let slip = if slips { find("slip_displacement") / find("k_imag") * (4.0 * &x / &energy).f64() } else { 0.0 };
    let [real, real_rate] = real_part(reference, &x);
    let size = (real.square() + imaginary.square()).sqrt();
    // dE/dx = 4 (τ - x/(Λ+λ)) changes by 4 x h''/(Λ+λ)³ per distance from gross slip, which has the promised error of x_s.
    let slope = if point.slips() {
        0.0
    } else {
        (&point.curvature / (&point.compliance * point.compliance.square() * &size)).f64()
    };
    let near = find("slip_displacement") / find("dk_imag") * 4.0 / PI * (1.0 + law.x_slip.f64()) * slope;
    let scale = size / &x * &slope_unit;
    let exact = [unit * &real, unit * &imaginary, &slope_unit * real_rate, &slope_unit * imaginary_rate];
    let conditions = [soft, 3.0 * soft + slip, soft, 3.0 * soft + near];
    for (i, output) in ["k_real", "k_imag", "dk_real", "dk_imag"].into_iter().enumerate() {
        let scale = if i < 2 { &exact[i] } else { &scale };
        at.check_scaled(output, got[i], &exact[i], scale, conditions[i]);
    }
    let (stiffness, force) = spring_slider(&real, &imaginary, &x);
    let got = call::jenkins(contact, amplitude);
    at.check("jenkins_stiffness", got[0], &(unit * stiffness), 3.0 * soft);
    let exact = &law.slip_force * force;
    at.check("jenkins_slip_force", got[1], &exact, 3.0 * soft);
}

/// Stiffness and slip force of the spring-slider with K' and K'' at an amplitude: sin²Θ = ratio (Θ - sin Θ cos Θ).
fn spring_slider(real: &Real, imaginary: &Real, amplitude: &Real) -> (Real, Real) {
    let bits = 256;
    let ratio = (imaginary / real).at(bits);
    let sine = |t: &Real| 2.0 * t / (1.0 + t.square());
    // t = tan(Θ/2), by bisection of its logarithm to 30 digits: near 0 and π the angle itself has fewer.
    let (mut low, mut high) = (Real::new(bits, 1e-20), Real::new(bits, 1e120));
    for _ in 0..110 {
        let t = (&low * &high).sqrt();
        let (angle, sine) = (2.0 * t.atan2(&Real::new(bits, 1.0)), sine(&t));
        let cosine = (1.0 - t.square()) / (1.0 + t.square());
        if sine.square() > &ratio * (angle - &sine * cosine) { low = t } else { high = t }
    }
    let stiffness = Real::pi(bits) * imaginary / sine(&low).square();
    let force = &stiffness * amplitude * low.square() / (1.0 + low.square());
    (stiffness, force)
}
