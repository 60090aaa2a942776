//! Histories against a bank of 6,000 springs in parallel (Popov and Heß): spring j belongs to the size S_j, carries the displacement of
//! all sizes beyond it and slips at `mu (S_b - S_j)`. In one direction it is the law with its integral over the stiffness as a sum.

use super::{Element, KINDS, State, next};
use crate::{Outcome, ensure};
use rand::rngs::SmallRng;
use reference::Input;
use reference::family::{Family, Given};

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
    fn new(element: &Element, family: &Family) -> Bank {
        let largest = family.find(Given::Load, &family.real(element.library.normal_force));
        // The size that touches first has a stiffness if it is a flat.
        let touching = match &element.input {
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
        let friction = element.library.friction_coefficient;
        let width = cell.f64();
        Bank {
            friction,
            elongation: vec![0.0; size.len()],
            size,
            stiffness: springs,
            displacement: 0.0,
            contact: 0.0,
            per_kink: 0.25 * friction * width * width / family.curvature(&largest).f64(),
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
pub fn compare(element: &Element, steps: u64, rng: &mut SmallRng) -> Outcome {
    let family = Family::new(&element.input);
    let mut bank = Bank::new(element, &family);
    let mut state = State::new(500);
    let mut past: Vec<[f64; 2]> = vec![[0.0; 2]];
    let mut worst: f64 = 0.0;
    for number in 0..steps {
        let kind = KINDS[(number * 6 / steps) as usize];
        let to = next(kind, element, &past, rng);
        let pieces = state.knots().len();
        let step = state.step(element, to)?;
        let contact = if to[1] > 1e-40 * element.library.normal_force {
            family.find(Given::Load, &family.real(to[1])).shift.f64()
        } else {
            0.0
        };
        // An open contact moves freely.
        let motion = (to[0] - bank.displacement).abs();
        let [force, energy] = bank.step(to[0], contact);
        // Kinks of the elongation: at every knot and at the edge of the contact; pieces between are smooth and count as one each. Springs
        // round in every step.
        let kinks = (2 * (pieces + state.knots().len()) + 4) as f64;
        let rounding = 1e-12 * element.slip_force() + 4.0 * f64::EPSILON * number as f64 * element.slip_force();
        let error = kinks * bank.per_kink + rounding;
        let off = (force - step.force[0]).abs();
        worst = worst.max(off / element.slip_force());
        ensure!(
            off <= error,
            "step {number}, {kind}: {:?}, by the bank {force:?}, {error:e} allowed; {to:?}",
            step.force
        );
        // Every part of the contact slips by at most the motion and the change of its limit.
        let slip = motion + bank.friction * (contact.max(bank.contact) + element.slip() / bank.friction);
        let bound = 2.0 * error * slip;
        ensure!(
            (energy - step.dissipated).abs() <= bound,
            "step {number}, {kind}: dissipated {:e}, by the bank {energy:e}, {bound:e} allowed; {to:?}",
            step.dissipated
        );
        past.push(to);
        if past.len() > 32 {
            past.remove(0);
        }
    }
    println!("  bank of springs: worst {worst:.1e} mu N");
    Ok(())
}
