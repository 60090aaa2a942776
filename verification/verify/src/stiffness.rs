//! Complex stiffness, the equivalent spring-slider, and the event-driven harmonic force of one harmonic.

use crate::bounds::find;
use crate::call;
use crate::curve::{half_share, share_of_slip};
use crate::sampler::{Case, Sampler, text};
use crate::tally::Tally;
use microslip::ffi::MSLIP_EVENT_DRIVEN;
use reference::Real;
use reference::law::bits_for;
use reference::quadrature::Quadrature;
use reference::stiffness::{cycle_energy, imaginary_part, real_part};
use std::f64::consts::PI;

/// K' and its derivative in units.
fn real(case: &Case, x: &Real) -> [Real; 2] {
    let share = x / &case.reference.law(0).x_slip;
    let law = case.reference.law(64 + bits_for(&share) + bits_for(&(1.0 - &share).abs()));
    real_part(&law, &Quadrature::new(law.bits), &x.at(law.bits))
}

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
    let plain = call::complex_stiffness(contact, amplitude);
    let (law, point) = reference.at_displacement(amplitude);
    let place = || format!("{} A {amplitude:e}", text(&reference.input));
    let x = law.x(amplitude);
    let energy = cycle_energy(&law, &x, &point).0;
    let [imaginary, imaginary_rate] = imaginary_part(&law, &x, &point);
    let soft = 1.0 / law.full_stick.f64();
    let unit = &law.stiffness_unit;
    let slope_unit = unit / &law.displacement_unit;
    // Beyond gross slip E = E_slip + 4 (x - x_s), with the promised error of x_s.
    let slips = amplitude > contact.slip_displacement;
    let slip = if slips { find("slip_displacement").k / find("k_imag").k * (4.0 * &x / &energy).f64() } else { 0.0 };
    let [real, real_rate] = real(case, &x);
    let size = (real.square() + imaginary.square()).sqrt();
    // dE/dx = 4 (τ - x/(Λ+λ)) changes by 4 x h''/(Λ+λ)³ per distance from gross slip, which has the promised error of x_s.
    let slope = if point.slips() {
        0.0
    } else {
        (&point.curvature / (&point.compliance * point.compliance.square() * &size)).f64()
    };
    let near = find("slip_displacement").k / find("dk_imag").k * 4.0 / PI * (1.0 + law.x_slip.f64()) * slope;
    let scale = size / &x * &slope_unit;
    let exact = [unit * &real, unit * &imaginary, &slope_unit * real_rate, &slope_unit * imaginary_rate];
    let conditions = [soft, 3.0 * soft + slip, soft, 3.0 * soft + near];
    let mut check = |names: [&'static str; 4], got: [f64; 4]| {
        for i in 0..2 {
            tally.check((names[i], kind, range), got[i], &exact[i], conditions[i], place);
        }
        for i in 2..4 {
            tally.check_scaled((names[i], kind, range), got[i], &exact[i], &scale, conditions[i], place);
        }
    };
    check(["k_real", "k_imag", "dk_real", "dk_imag"], plain);
    let (stiffness, force) = spring_slider(&real, &imaginary, &x);
    let got = call::jenkins(contact, amplitude);
    tally.check(("jenkins_stiffness", kind, range), got[0], &(unit * stiffness), 3.0 * soft, place);
    let exact = &law.slip_force * force;
    tally.check(("jenkins_slip_force", kind, range), got[1], &exact, 3.0 * soft, place);
}

/// The event-driven harmonic force of a cosine about a mean, by K', K'' and the curve.
pub fn event_driven(case: &Case, sampler: &mut Sampler, tally: &mut Tally) {
    let samples = if sampler.chance(0.5) { 64 } else { 512 };
    if case.reference.law(0).full_stick.f64() < 0.3 {
        return; // the curve bends sharply and the rule converges slowly
    }
    let share = if sampler.chance(0.3) { sampler.power(0.003, 1.0) } else { sampler.power(-2.0, -0.005) };
    let (sine, cosine) = sampler.between(-3.2, 3.2).sin_cos();
    let mean = if sampler.chance(0.3) { 0.0 } else { share * sampler.between(-1.0, 1.0) };
    let slip = case.contact.slip_displacement;
    of_cosine(case, samples, [mean * slip, share * slip * cosine, share * slip * sine], tally);
}

pub fn of_cosine(case: &Case, samples: usize, u: [f64; 3], tally: &mut Tally) {
    let Case { contact, reference, kind } = case;
    let (names, range) = if samples < 100 {
        (["event_driven_64_force", "event_driven_64_jacobian", "event_driven_dissipated"], "64 nodes")
    } else {
        (["event_driven_force", "event_driven_jacobian", "event_driven_dissipated"], "512 nodes")
    };
    let mean = u[0];
    let (force, jacobian, dissipated) = call::harmonic(contact, samples, MSLIP_EVENT_DRIVEN, &u);
    let law = reference.law(64);
    let v = u.map(|u| law.x(u));
    let amplitude = (v[1].square() + v[2].square()).sqrt();
    let (one, farthest) = (law.at_x(&amplitude), law.at_x(&(v[0].abs() + &amplitude)));
    let ends = [&amplitude, &(v[0].abs() + &amplitude)];
    if ends.iter().any(|end| (*end / &law.x_slip - 1.0).abs().f64() < 1e-9) {
        return;
    }
    let [real, real_rate] = real(case, &amplitude);
    let energy = cycle_energy(&law, &amplitude, &one).0;
    let [imaginary, imaginary_rate] = imaginary_part(&law, &amplitude, &one);
    let sign = if mean == 0.0 { 0.0 } else { mean.signum() };
    let exact =
        [(&farthest.tau - &one.tau) * sign, &real * &v[1] + &imaginary * &v[2], &real * &v[2] - &imaginary * &v[1]];
    let soft = 1.0 / law.full_stick.f64();
    let place = || format!("{} samples {samples} u {u:?}", text(&reference.input));
    let scale = &law.slip_force * (farthest.tau.f64() + soft * (v[0].abs() + &amplitude).f64());
    for (got, exact) in force.iter().zip(&exact) {
        tally.check_scaled((names[0], kind, range), *got, &(&law.slip_force * exact), &scale, soft, place);
    }
    let unit = law.energy_unit();
    let exact = &unit * &energy;
    let loose = &unit * (&energy + if amplitude.f64() > 0.5 * law.x_slip.f64() { 4.0 * amplitude.f64() } else { 0.0 });
    tally.check_scaled((names[2], kind, range), dissipated, &exact, &loose, 3.0 * soft, place);
    if mean == 0.0 {
        return; // the derivative by the mean is one-sided
    }
    let direction = [&v[1] / &amplitude, &v[2] / &amplitude];
    let slope = [&real_rate * &v[1] + &imaginary_rate * &v[2], &real_rate * &v[2] - &imaginary_rate * &v[1]];
    let (far, near) = (farthest.stiffness(), one.stiffness());
    let scale = &law.stiffness_unit / &law.full_stick;
    for j in 0..3 {
        for i in 0..3 {
            let exact = match (i, j) {
                (0, 0) => far.clone(),
                (0, j) => (&far - &near) * sign * &direction[j - 1],
                (_, 0) => law.real(0.0),
                (i, j) => {
                    let own = if i == j {
                        real.clone()
                    } else if i == 1 {
                        imaginary.clone()
                    } else {
                        -&imaginary
                    };
                    own + &slope[i - 1] * &direction[j - 1]
                }
            };
            let rate = [&one, &farthest].map(|point| match point.slips() {
                true => 0.0,
                false => (&point.x * &point.curvature / point.compliance.square()).f64(),
            });
            let condition = soft + rate[0].max(rate[1]);
            let exact = &law.stiffness_unit * exact;
            tally.check_scaled((names[1], kind, range), jacobian[i + 3 * j], &exact, &scale, condition, place);
        }
    }
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
