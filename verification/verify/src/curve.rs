//! Contact fields, the monotonic curve and the energy per cycle.

use crate::call;
use crate::sampler::{Case, Sampler, text};
use crate::tally::Tally;
use reference::{Law, Point, Real};

/// The fields of a contact.
pub fn fields(case: &Case, _: &mut Sampler, tally: &mut Tally) {
    let Case { contact, reference, kind } = case;
    let law = reference.law(0);
    let mut at = tally.at(kind, "contacts", || text(&reference.input));
    at.check("composite_modulus", contact.composite_modulus, &law.composite_modulus, 0.0);
    at.check("half_width", contact.half_width, &law.half_width, 0.0);
    at.check("slip_force", contact.slip_force, &law.slip_force, 0.0);
    let exact = &law.displacement_unit * &law.x_slip;
    at.check("slip_displacement", contact.slip_displacement, &exact, 1.0 / law.x_slip.f64());
    let exact = &law.stiffness_unit / &law.full_stick;
    at.check("initial_stiffness", contact.initial_stiffness, &exact, 1.0 / law.full_stick.f64());
    at.check("slip_energy", contact.slip_energy, &(law.energy_unit() * law.slip_point().energy), 0.0);
}

/// A value changed by the given number of ε.
pub fn moved(value: f64, units: f64) -> f64 {
    value * (1.0 + units * f64::EPSILON)
}

fn size(law: &Law, point: &Point) -> Real {
    &law.half_width * &point.size
}

/// At given forces: displacement, compliance, stick half-width, energy.
pub fn at_forces(case: &Case, sampler: &mut Sampler, tally: &mut Tally) {
    for _ in 0..50 {
        let (share, range) = sampler.share_of_force();
        at_force(case, share * case.contact.slip_force, range, tally);
    }
}

pub fn at_force(case: &Case, force: f64, range: &'static str, tally: &mut Tally) {
    let Case { contact, reference, kind } = case;
    let (law, point) = reference.at_force(force);
    let mut at = tally.at(kind, range, || format!("{} T {force:e}", text(&reference.input)));
    let [displacement, compliance, stick] = call::displacement(contact, force);
    let (rate, stiff) = (point.rate(), point.compliance.f64());
    let around = |f: &dyn Fn(&Law, &Point) -> Real| -> Vec<Real> {
        let at = |units| reference.at_force(moved(force, units));
        [-4.0, 4.0].map(at).map(|(law, point)| f(&law, &point)).into()
    };
    let exact = &law.displacement_unit * &point.x;
    let condition = (&point.tau / &point.x).f64();
    at.check("displacement", displacement, &exact, condition);
    let of = |law: &Law, point: &Point| &point.compliance / &law.stiffness_unit;
    let (exact, soft) = (of(&law, &point), (1.0 + rate) / stiff);
    at.check_between("compliance", compliance, &exact, &exact, soft, || around(&of));
    let exact = size(&law, &point);
    at.check_between("stick_half_width", stick, &exact, &exact, rate, || around(&size));
    let exact = law.energy_unit() * &point.energy;
    at.check("dissipated_energy", call::energy(contact, force), &exact, 0.0);
}

/// A displacement over that of gross slip, and its range.
pub fn share_of_slip(sampler: &mut Sampler, half: f64) -> (f64, &'static str) {
    match sampler.below(9) {
        0 if sampler.chance(0.05) => (sampler.power(-100.0, -12.0), "-> 0"),
        0 | 1 => (sampler.power(-12.0, -3.0), "-> 0"),
        2 | 3 => (1.0 - sampler.power(-16.0, -3.0), "-> slip"),
        4 => {
            let places = [0.4, 0.8, 0.97, 0.999, half];
            let interval = 1.0 - 0.6 * 0.25f64.powi(sampler.below(6) as i32);
            let place = sampler.below(10);
            (sampler.near(if place < 5 { places[place] } else { interval }, 64), "switches")
        }
        5 if sampler.chance(0.2) => (1.0 + sampler.power(-16.0, 3.0), "beyond slip"),
        _ => (sampler.between(1e-3, 0.999), "between"),
    }
}

/// The displacement at τ = 1/2 over that of gross slip.
pub fn half_share(case: &Case) -> f64 {
    call::displacement(&case.contact, 0.5 * case.contact.slip_force)[0] / case.contact.slip_displacement
}

/// At given displacements: force, stiffness, stick half-width.
pub fn at_displacements(case: &Case, sampler: &mut Sampler, tally: &mut Tally) {
    let half = half_share(case);
    for _ in 0..50 {
        let (share, range) = share_of_slip(sampler, half);
        at_displacement(case, share * case.contact.slip_displacement, range, tally);
    }
}

pub fn at_displacement(case: &Case, displacement: f64, range: &'static str, tally: &mut Tally) {
    let Case { contact, reference, kind } = case;
    let mut at = tally.at(kind, range, || format!("{} u {displacement:e}", text(&reference.input)));
    let [force, stiffness, stick] = call::force(contact, displacement);
    let (law, point) = reference.at_displacement(displacement);
    let of_stiffness = |law: &Law, point: &Point| &law.stiffness_unit * point.stiffness();
    let of_size = |law: &Law, point: &Point| if point.slips() { law.real(0.0) } else { size(law, point) };
    let around = |f: &dyn Fn(&Law, &Point) -> Real| -> Vec<Real> {
        // The displacement of gross slip is rounded too.
        let units = 4.0 * (2.0 + 1.0 / law.x_slip.f64());
        let at = |units| reference.at_displacement(moved(displacement, units));
        [-units, units].map(at).map(|(law, point)| f(&law, &point)).into()
    };
    let stiff = point.compliance.f64();
    let rate = ((&point.x + &point.tau) * &point.curvature).f64() / stiff;
    let (soft, rate) = (1.0 / stiff, if point.slips() { 0.0 } else { rate });
    at.check("force", force, &(&law.slip_force * &point.tau), soft);
    let exact = of_stiffness(&law, &point);
    let condition = soft * (1.0 + rate);
    at.check_between("stiffness", stiffness, &exact, &exact, condition, || around(&of_stiffness));
    let exact = of_size(&law, &point);
    at.check_between("stick_half_width_inverse", stick, &exact, &exact, rate, || around(&of_size));
}

/// At given displacements: derivatives of the force with respect to the parameters, against differences.
pub fn sensitivities(case: &Case, sampler: &mut Sampler, tally: &mut Tally) {
    let half = half_share(case);
    for _ in 0..10 {
        let (share, range) = share_of_slip(sampler, half);
        sensitivity(case, share * case.contact.slip_displacement, range, tally);
    }
}

const NAMES: [&str; 6] = [
    "sensitivity_by_normal_force",
    "sensitivity_by_friction",
    "sensitivity_by_flat",
    "sensitivity_by_radius",
    "sensitivity_by_length",
    "sensitivity_by_modulus",
];

pub fn sensitivity(case: &Case, displacement: f64, range: &'static str, tally: &mut Tally) {
    let Case { contact, reference, kind } = case;
    let (law, point) = reference.at_displacement(displacement);
    // The displacement of gross slip, at which they jump, is rounded.
    let x = law.x(displacement) / &law.x_slip;
    if (x - 1.0).abs().f64() < 16.0 * f64::EPSILON * (1.0 + 1.0 / law.x_slip.f64()) {
        return;
    }
    let mut at = tally.at(kind, range, || format!("{} u {displacement:e}", text(&reference.input)));
    let (_, got) = call::sensitivity(contact, displacement);
    let exact = reference.differences(displacement);
    let stiff = point.compliance.f64();
    let rate = if point.slips() { 0.0 } else { ((&point.x + &point.tau) * &point.curvature).f64() / stiff };
    // The sum of the sizes of the terms: shares of the force, and of the compliances of it.
    let force = &law.slip_force * &point.tau;
    let scale = &force * law.real(1.0 + 1.0 / stiff);
    let values = reference.values();
    for (((name, exact), got), value) in NAMES.into_iter().zip(&exact).zip(got).zip(values) {
        let got = law.real(got) * value;
        at.check_scaled(name, got.f64(), exact, &scale, (1.0 + rate) / stiff + rate);
    }
}

/// The error reported for parallel spring-sliders, against the largest distance between their polygon and the curve.
pub fn sliders(case: &Case, sampler: &mut Sampler, tally: &mut Tally) {
    of_sliders(case, 1 + sampler.below(12), tally);
}

pub fn of_sliders(case: &Case, n: usize, tally: &mut Tally) {
    let Case { contact, reference, kind } = case;
    let ([stiffness, force], reported) = call::iwan(contact, n);
    let law = reference.law(0);
    let mut corners: Vec<(Real, Real)> = stiffness
        .iter()
        .zip(&force)
        .filter(|(stiffness, _)| **stiffness > 0.0)
        .map(|(k, f)| (law.real(*k) / &law.stiffness_unit, law.real(*f) / &law.slip_force))
        .collect();
    corners.sort_by(|one, two| (&one.1 / &one.0).partial_cmp(&(&two.1 / &two.0)).unwrap());
    let polygon = |x: &Real| corners.iter().fold(law.real(0.0), |sum, (k, f)| sum + (k * x).min(f));
    let mut worst = law.real(0.0);
    // The polygon is farthest above the curve at corners, and below it where the curve has the slope of a side.
    let mut slope = corners.iter().fold(law.real(0.0), |sum, (k, _)| sum + k);
    let mut from = law.real(0.0);
    for (k, f) in &corners {
        let corner = f / k;
        let curve = law.at_x(&corner).tau;
        worst = worst.max(&(polygon(&corner) - curve).abs());
        let (mut low, mut high) = (from.clone(), corner.clone().min(&law.x_slip));
        // An extremum needs half of the digits only.
        for _ in 0..30 {
            let middle = (&low + &high) / 2.0;
            let compliance = law.at_x(&middle).compliance;
            if 1.0 / compliance > slope { low = middle } else { high = middle }
        }
        let curve = law.at_x(&low).tau;
        worst = worst.max(&(curve - polygon(&low)).abs());
        slope = slope - k;
        from = corner;
    }
    let inputs = || format!("{} sliders {n}", text(&reference.input));
    // Errors below 1e-9 of mu N count as that.
    let scale = &worst + 1e-9;
    tally.at(kind, "1 to 12 sliders", inputs).check_scaled("iwan_force_error", reported, &worst, &scale, 0.0);
}
