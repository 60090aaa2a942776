//! Histories against a bank of 6,000 springs in parallel (Popov and Heß): spring j belongs to the size S_j, carries the displacement of
//! all sizes beyond it and slips at `mu (S_b - S_j)`. In one direction it is the law with its integral over the stiffness as a sum.

use crate::call::quiet;
use crate::element::prepare;
use crate::histories;
use crate::sampler::{ElementCase, Sampler};
use microslip::one_direction as state;
use reference::Input;
use reference::family::Given;

const SPRINGS: usize = 6000;

struct Bank {
    friction: f64,
    /// S_j, and the stiffness of each spring.
    size: Vec<f64>,
    stiffness: Vec<f64>,
    elongation: Vec<f64>,
    displacement: f64,
    /// S_b.
    contact: f64,
    /// Error of T per kink of the elongation over the stiffness: a cell of the sum is wrong by an eighth of its width squared times the
    /// jump of the slope, which is at most 2 mu dS/d(stiffness).
    per_kink: f64,
}

impl Bank {
    /// Cells of equal stiffness up to that of the largest load of the tables.
    fn new(case: &ElementCase) -> Bank {
        let ElementCase { element, reference, input, .. } = case;
        let family = &reference.family;
        let largest = family.find(Given::Load, &family.real(element.normal_force));
        // The size that touches first has a stiffness if it is a flat.
        let touching = match input {
            Input::Flat(parameters) if parameters.flat_half_width > 0.0 => {
                1.0 / family.size(&family.real(0.0)).tangential_compliance
            }
            _ => family.real(0.0),
        };
        let cell = (1.0 / &largest.tangential_compliance - &touching) / SPRINGS as f64;
        let (mut size, mut springs) = (vec![0.0], vec![touching.f64()]);
        for j in 0..SPRINGS {
            let middle = &touching + &cell * (j as f64 + 0.5);
            size.push(family.with_compliance(&(1.0 / middle)).shift.f64());
            springs.push(cell.f64());
        }
        let friction = element.friction_coefficient;
        // The largest dS/d(stiffness) between the middles of two cells, and up to half a cell beyond the last.
        let steepest = size.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
        Bank {
            friction,
            elongation: vec![0.0; size.len()],
            size,
            stiffness: springs,
            displacement: 0.0,
            contact: 0.0,
            per_kink: 0.26 * friction * steepest * cell.f64(),
        }
    }

    /// A step, straight in (S, u): force and dissipated energy.
    fn step(&mut self, displacement: f64, contact: f64) -> [f64; 2] {
        let (mu, motion, rise) = (self.friction, displacement - self.displacement, contact - self.contact);
        let (mut force, mut energy) = (0.0, 0.0);
        for ((size, stiffness), elongation) in self.size.iter().zip(&self.stiffness).zip(&mut self.elongation) {
            // The part of the step in which the spring is loaded, and its limit at both ends of it.
            let [before, after] = [self.contact, contact].map(|contact| mu * (contact - size));
            let part = match (before > 0.0, after > 0.0) {
                (true, true) => 1.0,
                (false, false) => continue,
                (true, false) => before / (before - after),
                (false, true) => after / (after - before),
            };
            let (motion, growth) = (motion * part, mu * rise * part);
            let (limit, last) = (before.max(0.0), after.max(0.0));
            let free = *elongation + motion;
            if free.abs() > last {
                // It slips in the direction of `free` from where it meets the limit on, by the excess over it.
                let slip = free.abs() - last;
                let rate = motion * free.signum() - growth;
                let fraction = (slip / rate).min(1.0);
                energy += stiffness * slip * (last - 0.5 * fraction * (last - limit));
                *elongation = last.copysign(free);
            } else {
                *elongation = free;
            }
            force += stiffness * *elongation;
        }
        (self.displacement, self.contact) = (displacement, contact);
        [force, energy]
    }
}

/// Compares an element whose input is the force with its bank.
pub fn compare(case: &ElementCase, sampler: &mut Sampler, _: &mut crate::Tally) {
    let Some((element, reference)) = prepare(&case.input, true) else { return };
    let case = &ElementCase { element, reference, input: case.input, kind: case.kind };
    let element = &case.element;
    let family = &case.reference.family;
    let (slip_force, mut bank) = (element.friction_coefficient * element.normal_force, Bank::new(case));
    let slip = element.friction_coefficient * element.shift_under(element.normal_force);
    let mut state = vec![0.0; state::state_length(500)];
    state::state_init(&mut state).expect("long enough");
    let pieces = |state: &[f64]| (state[0].to_bits() & 0xff_ffff_ffff) as usize;
    // All but loads beyond those of the bank.
    let kind = [0, 1, 3, 4, 6][sampler.below(5)];
    let path = histories::of_element(case, sampler, kind, 100);
    let mut farthest: f64 = slip;
    for (number, &[u, w]) in path.iter().enumerate().filter(|(_, [_, w])| *w <= element.normal_force) {
        let before = pieces(&state);
        let step = quiet("advance", || state::advance(element, &mut state, [u, w], true)).expect("within its range");
        let contact =
            if w > 1e-40 * element.normal_force { family.find(Given::Load, &family.real(w)).shift.f64() } else { 0.0 };
        let motion = (u - bank.displacement).abs();
        farthest = farthest.max(u.abs());
        let largest = contact.max(bank.contact);
        let [force, energy] = bank.step(u, contact);
        // Kinks of the elongation: at every knot and at the edge of the contact; pieces between are smooth and count as one each. Springs
        // round in every step.
        let kinks = (2 * (before + pieces(&state)) + 4) as f64;
        let rounding = (1e-12 + 4.0 * f64::EPSILON * (number + 1) as f64) * slip_force * farthest / slip;
        let error = kinks * bank.per_kink + rounding;
        let context = || format!("step {number}, {error:e} allowed; {:?}, path {:?}", case.input, &path[..=number]);
        assert!((force - step.force[0]).abs() <= error, "{:?}, by the bank {force:?}; {}", step.force, context());
        // Every part of the contact slips by at most the motion and the change of its limit.
        let bound = 2.0 * error * (motion + bank.friction * largest + slip);
        let off = (energy - step.dissipated).abs();
        assert!(off <= bound, "dissipated {:e}, by the bank {energy:e}; {}", step.dissipated, context());
    }
}
