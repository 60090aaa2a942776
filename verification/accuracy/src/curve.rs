//! Contact fields, the monotonic curve and the energy per cycle.

use crate::call;
use crate::cases::{Case, Dice, text};
use crate::real::Real;
use crate::reference::{Law, Point};
use crate::tally::Tally;

/// One contact: its fields.
pub fn fields(dice: &mut Dice, kind: &'static str, tally: &mut Tally) {
    let Case { contact, reference, .. } = dice.case(kind, &mut tally.refused);
    let law = reference.law(0);
    let place = || text(&reference.given);
    let unit = &law.displacement_unit;
    let mut check = |name, got, exact: Real, condition: f64| {
        tally.check((name, kind, "contacts"), got, &exact, condition, place);
    };
    check("composite_modulus", contact.composite_modulus, law.composite_modulus.clone(), 0.0);
    check("half_width", contact.half_width, law.half_width.clone(), 0.0);
    check("slip_force", contact.slip_force, law.slip_force.clone(), 0.0);
    check("slip_displacement", contact.slip_displacement, unit * &law.slip_approach, 1.0 / law.slip_approach.f64());
    check(
        "initial_stiffness",
        contact.initial_stiffness,
        &law.stiffness_unit / &law.full_stick,
        1.0 / law.full_stick.f64(),
    );
    check("slip_energy", contact.slip_energy, law.energy_unit() * law.slip_point().energy, 0.0);
}

/// ε as it enters the neighbours of an input.
pub fn moved(value: f64, units: f64) -> f64 {
    value * (1.0 + units * f64::EPSILON)
}

fn size(law: &Law, point: &Point) -> Real {
    &law.half_width * &point.size
}

/// Forces given: displacement, compliance, stick half-width, energy.
pub fn at_forces(case: &Case, dice: &mut Dice, count: usize, tally: &mut Tally) {
    for _ in 0..count {
        let (share, range) = dice.share_of_force();
        at_force(case, share * case.contact.slip_force, range, tally);
    }
}

pub fn at_force(case: &Case, force: f64, range: &'static str, tally: &mut Tally) {
    let Case { contact, reference, kind } = case;
    let (law, point) = reference.at_force(force);
    let place = || format!("{} T {force:e}", text(&reference.given));
    let [displacement, compliance, stick] = call::displacement(contact, force);
    let rate = if point.rest.is_zero() { 0.0 } else { (&point.tau * &point.curvature).f64() };
    let stiff = point.compliance.f64();
    let around = |f: &dyn Fn(&Law, &Point) -> Real| {
        Some(Vec::from([-4.0, 4.0].map(|units| {
            let (law, point) = reference.at_force(moved(force, units));
            f(&law, &point)
        })))
    };
    let exact = &law.displacement_unit * &point.approach;
    let condition = (&point.tau / &point.approach).f64();
    tally.check(("displacement", kind, range), displacement, &exact, condition, place);
    let of = |law: &Law, point: &Point| &point.compliance / &law.stiffness_unit;
    let exact = of(&law, &point);
    tally.check_between(("compliance", kind, range), compliance, &exact, &exact, (1.0 + rate) / stiff, place, || {
        around(&of)
    });
    let exact = size(&law, &point);
    tally.check_between(("stick_half_width", kind, range), stick, &exact, &exact, rate, place, || around(&size));
    let exact = law.energy_unit() * &point.energy;
    tally.check(("dissipated_energy", kind, range), call::energy(contact, force), &exact, 0.0, place);
}

/// A displacement over that of gross slip, and its range.
pub fn share_of_slip(dice: &mut Dice, half: f64) -> (f64, &'static str) {
    match dice.below(9) {
        0 if dice.chance(0.05) => (dice.power(-100.0, -12.0), "-> 0"),
        0 | 1 => (dice.power(-12.0, -3.0), "-> 0"),
        2 | 3 => (1.0 - dice.power(-16.0, -3.0), "-> slip"),
        4 => {
            let places = [0.4, 0.8, 0.97, 0.999, half];
            let octave = 1.0 - 0.6 * 0.25f64.powi(dice.below(6) as i32);
            let place = dice.below(10);
            (dice.near(if place < 5 { places[place] } else { octave }, 64), "switches")
        }
        5 if dice.chance(0.2) => (1.0 + dice.power(-16.0, 3.0), "beyond slip"),
        _ => (dice.between(1e-3, 0.999), "between"),
    }
}

/// The displacement at τ = 1/2 over that of gross slip.
pub fn half_share(case: &Case) -> f64 {
    call::displacement(&case.contact, 0.5 * case.contact.slip_force)[0] / case.contact.slip_displacement
}

/// Displacements given: force, stiffness, stick half-width.
pub fn at_displacements(case: &Case, dice: &mut Dice, count: usize, tally: &mut Tally) {
    let half = half_share(case);
    for _ in 0..count {
        let (share, range) = share_of_slip(dice, half);
        at_displacement(case, share * case.contact.slip_displacement, range, tally);
    }
}

pub fn at_displacement(case: &Case, displacement: f64, range: &'static str, tally: &mut Tally) {
    let Case { contact, reference, kind } = case;
    let place = || format!("{} u {displacement:e}", text(&reference.given));
    let [force, stiffness, stick] = call::force(contact, displacement);
    let (law, point) = reference.at_displacement(displacement, force);
    let slips = point.rest.is_zero();
    let of_stiffness = |law: &Law, point: &Point| {
        if point.rest.is_zero() { law.real(0.0) } else { &law.stiffness_unit / &point.compliance }
    };
    let of_size = |law: &Law, point: &Point| if point.rest.is_zero() { law.real(0.0) } else { size(law, point) };
    let around = |f: &dyn Fn(&Law, &Point) -> Real| {
        // The displacement of gross slip is rounded too.
        let units = 4.0 * (2.0 + 1.0 / law.slip_approach.f64());
        Some(Vec::from([-units, units].map(|units| {
            let (law, point) = reference.at_displacement(moved(displacement, units), force);
            f(&law, &point)
        })))
    };
    let stiff = point.compliance.f64();
    let rate = ((&point.approach + &point.tau) * &point.curvature).f64() / stiff;
    let (soft, rate) = (1.0 / stiff, if slips { 0.0 } else { rate });
    tally.check(("force", kind, range), force, &(&law.slip_force * &point.tau), soft, place);
    let exact = of_stiffness(&law, &point);
    tally.check_between(("stiffness", kind, range), stiffness, &exact, &exact, soft * (1.0 + rate), place, || {
        around(&of_stiffness)
    });
    let exact = of_size(&law, &point);
    tally.check_between(("stick_half_width_inverse", kind, range), stick, &exact, &exact, rate, place, || {
        around(&of_size)
    });
}

/// Neighbouring doubles across every place where another formula takes over: how far back what should grow steps.
pub fn neighbours(case: &Case, dice: &mut Dice, tally: &mut Tally) {
    let Case { contact, reference, kind } = case;
    let half = half_share(case);
    let soft = 1.0 / reference.law(0).full_stick.f64();
    let octaves = (0..6).map(|j| 1.0 - 0.6 * 0.25f64.powi(j));
    let places: Vec<f64> = [0.4, 0.8, 0.97, 0.999, 1.0, 1.05, half, dice.unit()].into_iter().chain(octaves).collect();
    for place in places {
        let start = place * contact.slip_displacement;
        let start = f64::from_bits(start.to_bits() - 64);
        let mut last: Option<[f64; 6]> = None;
        for step in 0..129 {
            let displacement = f64::from_bits(start.to_bits() + step);
            let [force, stiffness, stick] = call::force(contact, displacement);
            let [real, ..] = call::complex_stiffness(contact, displacement);
            let share = place.min(1.0) * contact.slip_force;
            let load = f64::from_bits(share.to_bits() - 64 + step).min(contact.slip_force);
            let [displaced, _, _] = call::displacement(contact, load);
            let now = [force, -stiffness, -stick, -real, displaced, call::energy(contact, load)];
            if let Some(last) = last {
                let names = [
                    "force_steps_back",
                    "stiffness_steps_back",
                    "stick_half_width_steps_back",
                    "k_real_steps_back",
                    "displacement_steps_back",
                    "energy_steps_back",
                ];
                for (name, (now, last)) in names.into_iter().zip(now.into_iter().zip(last)) {
                    let inputs = || format!("{} u {displacement:e} T {load:e}", text(&reference.given));
                    let exact = Real::new(64, if now < last { last } else { now });
                    tally.check((name, kind, "switches"), now, &exact, soft, inputs);
                }
            }
            last = Some(now);
        }
    }
}

/// The error that parallel spring-sliders announce, against the largest between their polygon and the curve.
pub fn sliders(case: &Case, dice: &mut Dice, tally: &mut Tally) {
    let Case { contact, reference, kind } = case;
    let n = 1 + dice.below(12);
    let (stiffness, force, announced) = call::iwan(contact, n);
    let law = reference.law(0);
    let mut corners: Vec<(Real, Real)> = stiffness
        .iter()
        .zip(&force)
        .filter(|(stiffness, _)| **stiffness > 0.0)
        .map(|(k, f)| (law.real(*k) / &law.stiffness_unit, law.real(*f) / &law.slip_force))
        .collect();
    corners.sort_by(|one, two| (&one.1 / &one.0).partial_cmp(&(&two.1 / &two.0)).unwrap());
    let polygon = |x: &Real| corners.iter().fold(law.real(0.0), |sum, (k, f)| sum + (k * x).min(f));
    let near = |x: &Real| call::force(contact, (x * &law.displacement_unit).f64())[0] / contact.slip_force;
    let mut worst = law.real(0.0);
    // Above at the corners, below where the curve has the side's slope.
    let mut slope = corners.iter().fold(law.real(0.0), |sum, (k, _)| sum + k);
    let mut from = law.real(0.0);
    for (k, f) in &corners {
        let corner = f / k;
        let curve = law.at_approach(&corner, &law.real(near(&corner))).tau;
        worst = worst.max(&(polygon(&corner) - curve).abs());
        let (mut low, mut high) = (from.clone(), corner.clone().min(&law.slip_approach));
        // An extremum needs half of the digits only.
        for _ in 0..30 {
            let middle = (&low + &high) / 2.0;
            let compliance = law.at_approach(&middle, &law.real(near(&middle))).compliance;
            if 1.0 / compliance > slope { low = middle } else { high = middle }
        }
        let curve = law.at_approach(&low, &law.real(near(&low))).tau;
        worst = worst.max(&(curve - polygon(&low)).abs());
        slope = slope - k;
        from = corner;
    }
    let inputs = || format!("{} sliders {n}", text(&reference.given));
    // Nothing below rounding of mu N can be told.
    let scale = &worst + 1e-9;
    tally.check_scaled(("iwan_force_error", kind, "1 to 12 sliders"), announced, &worst, &scale, 0.0, inputs);
}
