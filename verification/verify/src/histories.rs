//! Histories of displacements and normal inputs: regular, random, and adversarial ones that depend on comparisons and rounding.

use crate::sampler::{ElementCase, Sampler};
use microslip::ffi::MSLIP_INPUT_NORMAL_FORCE;

/// Kinds of histories of a contact; the last one, of subnormal displacements, is not compared with exact values.
pub const OF_CONTACTS: usize = 9;

/// Displacements of a contact.
pub fn of_contact(sampler: &mut Sampler, slip: f64, kind: usize, steps: usize) -> Vec<f64> {
    let top = slip
        * match sampler.below(4) {
            0 => sampler.power(-6.0, 0.0),
            1 => sampler.power(0.0, 2.0),
            _ => sampler.between(0.1, 1.5),
        };
    let (mut width, mut ratio, mut middle, mut speed) = (1.0, 0.85, 0.0, 1e-3);
    // Multiples of a unit repeat: a part of gross slip, its last digit, or the least number.
    let unit = if kind == OF_CONTACTS - 1 {
        f64::from_bits(1)
    } else {
        [slip / 16.0, slip.next_up() - slip][sampler.below(2)]
    };
    let mut path: Vec<f64> = Vec::with_capacity(steps);
    for i in 0..steps {
        let (last, random) = (path.last().copied().unwrap_or(0.0), sampler.between(-1.0, 1.0));
        path.push(match kind {
            // Nested loops inwards, then outwards, closing loop after loop.
            0 => {
                if i % 24 == 20 || sampler.chance(0.02) {
                    ratio = sampler.between(0.5, 0.999).powi(if ratio < 1.0 { -1 } else { 1 });
                }
                width = if (1e-6..=1.2).contains(&(width * ratio)) { width * ratio } else { 1.0 };
                top * width * if i % 2 == 0 { 1.0 } else { -1.0 }
            }
            1 => top * random,
            2 => last + 0.3 * top * random,
            // Cycles whose mean drifts far into gross slip and back.
            3 => {
                if sampler.chance(0.02) {
                    speed = sampler.power(-6.0, 0.0) * if middle > 0.0 { -1.0 } else { 1.0 };
                }
                middle += speed * slip;
                middle + top * (0.3 * i as f64).sin()
            }
            4 if i == 0 || sampler.chance(0.1) => 1.3 * slip * random,
            4 => sampler.near(last, 3),
            // Steps of every size, up to the largest displacements.
            5 => {
                let size = if sampler.chance(0.02) {
                    1e148 * sampler.power(-140.0, 0.0)
                } else {
                    slip * sampler.power(-18.0, 0.5)
                };
                size.copysign(random) + if sampler.chance(0.02) { 0.0 } else { last }
            }
            // Exactly to a reversal, its opposite, the onset of gross slip on either branch or zero; or to a neighbouring double.
            6 => {
                let old = if i == 0 { 0.0 } else { path[sampler.below(i)] };
                let targets = [
                    old,
                    old,
                    -old,
                    2.0 * last - old,
                    slip.copysign(random),
                    last - (2.0 * slip).copysign(random),
                    0.0,
                ];
                let (target, units) = (targets[sampler.below(7)], i64::from(sampler.chance(0.2)));
                sampler.near(target, units).clamp(-10.0 * slip, 10.0 * slip)
            }
            _ => (40.0 * random).round() * unit,
        });
    }
    path
}

/// Kinds of histories of an element: those of the ranges that are compared with exact values, then two more.
pub const RANGES: [&str; 6] =
    ["constant load", "load varies", "loads from 1e-6", "separation", "near-ties", "beyond the tables"];
pub const OF_ELEMENTS: usize = RANGES.len() + 2;
const SPIRALS: usize = RANGES.len();

/// Displacements and normal inputs of an element.
pub fn of_element(case: &ElementCase, sampler: &mut Sampler, kind: usize, steps: usize) -> Vec<[f64; 2]> {
    let ElementCase { element, .. } = case;
    let by_force = element.normal_input == MSLIP_INPUT_NORMAL_FORCE;
    let mu = element.friction_coefficient;
    let input_of = |load: f64| {
        let within = element.check_normal_force(load).is_ok();
        within.then(|| if by_force { load } else { element.approach_under(load).value })
    };
    let top = sampler.power(-1.5, 0.5);
    let constant = sampler.between(0.05, 1.0);
    let far = if sampler.chance(0.1) { sampler.power(0.0, 4.0) } else { 0.0 };
    let mut path: Vec<[f64; 2]> = Vec::with_capacity(steps);
    let (mut load_before, mut before) = (0.0, [0.0; 2]);
    for i in 0..steps {
        let share_before = load_before / element.normal_force;
        let share = match kind {
            0 => constant,
            2 => sampler.power(-6.0, 0.1),
            5 => sampler.power(-1.0, 3.0),
            // Loads that rise in small steps, each of which leaves a piece, and fall through all of them.
            SPIRALS => {
                if share_before > 0.95 {
                    0.05
                } else {
                    share_before + 0.02
                }
            }
            7 => sampler.power(-320.0, 0.0),
            _ if sampler.chance(0.2) => share_before,
            _ => sampler.between(0.05, 1.2),
        };
        let mut load = share * element.normal_force;
        let input = match input_of(load) {
            _ if matches!(kind, 3 | 7) && sampler.chance(0.3) => {
                load = 0.0;
                if by_force { 0.0 } else { -(sampler.below(3) as f64) * element.approach * sampler.unit() }
            }
            _ if kind == 4 && sampler.chance(0.3) && before[1] > 0.0 => {
                load = load_before;
                if sampler.chance(0.2) {
                    1e-25 * input_of(element.normal_force).expect("the load of the parameters")
                } else {
                    sampler.near(before[1], 2)
                }
            }
            Some(input) => input,
            None => {
                load = element.normal_force;
                input_of(load).expect("the load of the parameters")
            }
        };
        let reach = |load: f64| if load > 0.0 { mu * element.shift_under(load) } else { 0.0 };
        let (now, last) = (reach(load), reach(load_before));
        let unit = reach(element.normal_force);
        let displacement = match sampler.below(8) {
            _ if kind == SPIRALS => before[0] + (now - last) * sampler.between(-0.99, 0.99),
            _ if kind == 7 => unit.copysign(sampler.between(-1.0, 1.0)) * sampler.power(-300.0, 3.0),
            0 => before[0],
            1 => before[0] + (now - last) * sampler.between(-1.5, 1.5),
            2 => before[0] + now.max(last) * sampler.power(-16.0, -1.0),
            3 if kind == 4 => before[0] + (now - last).copysign(sampler.between(-1.0, 1.0)),
            3 if i > 0 => path[sampler.below(i)][0],
            4 if kind == 4 => sampler.near(before[0], 2),
            5 => before[0] - now.max(last) * sampler.power(-3.0, 0.3),
            _ => unit * (far + top * sampler.between(-1.0, 1.0)),
        };
        (load_before, before) = (load, [displacement, input]);
        path.push(before);
    }
    path
}
