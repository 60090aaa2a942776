//! Pressure, shear, slip and damage along the width.

use crate::call;
use crate::curve::moved;
use crate::sampler::{Case, Sampler, text};
use crate::tally::Tally;
use reference::{Input, Law, Point, Real};

/// ε by which position and force may be off, if the result is sensitive to that.
const UNITS: f64 = 8.0;

fn position(sampler: &mut Sampler, case: &Case, stick: f64, near_stick: bool) -> (f64, &'static str) {
    let b = case.contact.half_width;
    let flat = match &case.reference.input {
        Input::Flat(parameters) => parameters.flat_half_width,
        Input::Ellipse(_) => 0.0,
    };
    let sign = if sampler.chance(0.5) { 1.0 } else { -1.0 };
    let share = sign * sampler.power(-16.0, -1.0);
    match sampler.below(8) {
        0 if sampler.chance(0.2) => (0.0, "x = 0"),
        1 => (flat * (1.0 + share), "x -> a"),
        2 if near_stick => (stick * (1.0 + share), "x -> c"),
        3 if sampler.chance(0.2) => (sampler.near(b, 3), "x -> b"),
        3 => (b * (1.0 - share.abs()), "x -> b"),
        _ => (sign * b * sampler.unit(), "between"),
    }
}

fn place_of(law: &Law, x: f64) -> Real {
    law.real(x.abs()) / &law.half_width
}

/// Tractions and slip at some positions under some forces.
pub fn at_forces(case: &Case, sampler: &mut Sampler, tally: &mut Tally) {
    for _ in 0..6 {
        let (share, _) = sampler.share_of_force();
        at_force(case, share * case.contact.slip_force, sampler, tally);
    }
}

fn at_force(case: &Case, force: f64, sampler: &mut Sampler, tally: &mut Tally) {
    let [_, _, stick] = call::displacement(&case.contact, force);
    let near = sampler.chance(0.3);
    at_positions(case, force, &[(); 8].map(|()| position(sampler, case, stick, near)), near, tally);
}

/// At positions and their ranges; some may be near the edge of the stick zone.
pub fn at_positions(case: &Case, force: f64, spots: &[(f64, &'static str)], near: bool, tally: &mut Tally) {
    let Case { contact, reference, kind } = case;
    let x: Vec<f64> = spots.iter().map(|(x, _)| *x).collect();
    let [pressure, shear] = call::tractions(contact, force, &x);
    let no_slip = matches!(reference.input, Input::Ellipse(_));
    let [slip, damage] = if no_slip { [vec![], vec![]] } else { call::slip(contact, force, &x) };
    let (law, point) = reference.at_force_with(force, if near { 130 } else { 40 });
    let pressure_unit = law.pressure_unit.clone();
    let shear_unit = &law.friction * &pressure_unit;
    let slip_unit = law.displacement_unit.clone();
    let force = force.abs();
    let corners = |x: f64, f: &dyn Fn(&Law, &Real, &Point) -> Real| {
        let mut corners = Vec::new();
        // The edge of the stick zone has an error relative to b, which is larger relative to a narrow slip zone.
        let rate = if point.slips() { 1.0 } else { point.rate() };
        for at in [-UNITS, 0.0, UNITS] {
            let near = moved(force, at * (1.0 + 1.0 / rate.max(1e-300))).clamp(0.0, contact.slip_force);
            let (law, point) = reference.at_force_with(near, 130);
            let [low, high] = [-UNITS, UNITS].map(|at| place_of(&law, moved(x, at)));
            let middle = place_of(&law, x);
            for place in [&low, &((&low + &middle) / 2.0), &middle, &((&middle + &high) / 2.0), &high] {
                corners.push(f(&law, place, &point));
            }
            if high > law.real(1.0) {
                corners.push(law.real(0.0));
            }
            // The traction has a peak at c, and slip at b.
            for peak in [&point.size, &law.real(1.0)] {
                if &low < peak && peak < &high {
                    corners.push(f(&law, peak, &point));
                }
            }
        }
        corners
    };
    let rate = point.rate();
    for (i, &(x, range)) in spots.iter().enumerate() {
        let mut at = tally.at(kind, range, || format!("{} T {force:e} x {x:e}", text(&reference.input)));
        let spot = place_of(&law, x);
        let p = law.pressure(&spot, None);
        let from = |edge: &Real| (&spot / (&spot - edge)).abs().f64();
        let (from_b, from_c) = (from(&law.real(1.0)), (1.0 + rate) * from(&point.size));
        let exact = &pressure_unit * &p;
        at.check_between("pressure", pressure[i], &exact, &exact, from_b, || {
            [-UNITS, UNITS].map(|at| &pressure_unit * law.pressure(&place_of(&law, moved(x, at)), None)).into()
        });
        let q = if point.slips() { p.clone() } else { &p - law.pressure(&spot, Some(&point)) };
        let exact = &shear_unit * q;
        at.check_between("shear", shear[i], &exact, &exact, from_b + from_c, || {
            corners(x, &|law, x, point| &shear_unit * law.shear(x, point))
        });
        if no_slip {
            continue;
        }
        let outside = spot > law.real(1.0);
        let s = if outside { law.real(0.0) } else { law.slip(&spot, &point) };
        let exact = &slip_unit * &s;
        at.check_between("slip", slip[i], &exact, &exact, 1.5 * from_c, || {
            corners(x, &|law, x, point| &slip_unit * law.slip(x, point))
        });
        let unit = &slip_unit * &shear_unit;
        let exact = &unit * s * p;
        at.check_between("damage", damage[i], &exact, &exact, from_b + 1.5 * from_c, || {
            corners(x, &|law, x, point| &unit * law.slip(x, point) * law.pressure(x, None))
        });
    }
}
