//! Histories: the law as the operator of Prandtl and Ishlinskii. The force is a sum over the turning points that are not wiped
//! out, whatever the contact slid in between: T = M(v1) + 2 M((v2-v1)/2) + ..., M odd and mu N beyond gross slip.

use crate::call;
use crate::cases::{Case, Dice, text};
use crate::curve::moved;
use crate::real::Real;
use crate::reference::{Law, Point, Reference};
use crate::tally::Tally;
use microslip::c_api::mslip_contact;
use std::rc::Rc;

/// A turning point: displacement and force in units, and the number of its sample.
#[derive(Clone)]
pub struct Turn {
    pub displacement: Real,
    pub force: Real,
    pub sample: usize,
    /// Sum of the sizes of the terms of the force.
    pub size: Real,
    /// The point of the curve halfway back to the turn before.
    pub point: Option<Point>,
}

/// The turning points from the virgin state on; the last one is the present.
pub struct Memory<'a> {
    law: Rc<Law>,
    contact: &'a mslip_contact,
    pub turns: Vec<Turn>,
}

impl<'a> Memory<'a> {
    pub fn new(law: Rc<Law>, contact: &'a mslip_contact) -> Memory<'a> {
        let zero = || law.real(0.0);
        let turns = vec![Turn { displacement: zero(), force: zero(), sample: usize::MAX, size: zero(), point: None }];
        Memory { law, contact, turns }
    }

    fn point(&self, way: &Real) -> Point {
        let near = call::force(self.contact, (way * &self.law.displacement_unit).f64())[0];
        self.law.at_approach(way, &(self.law.real(near) / &self.law.slip_force))
    }

    /// Energy, in units, of the first loading to a displacement.
    fn loading(&self, way: &Real) -> Real {
        if way.is_zero() {
            return self.law.real(0.0);
        }
        crate::cycle::cycle_energy(&self.law, way, &self.point(way)).0 / 4.0
    }

    fn halves(&self) -> f64 {
        if self.turns.len() == 2 { 1.0 } else { 2.0 }
    }

    /// Goes to a displacement; the energy dissipated and the sum of its terms.
    pub fn go(&mut self, to: &Real, sample: usize, wants_energy: bool) -> (Real, Real) {
        let (mut energy, mut size) = (self.law.real(0.0), self.law.real(0.0));
        let here = self.turns.last().unwrap().clone();
        if to == &here.displacement {
            return (energy, size);
        }
        let rises = to > &here.displacement;
        let goes_on = self.turns.len() > 1 && {
            let before = &self.turns[self.turns.len() - 2];
            (here.displacement > before.displacement) == rises
        };
        if !goes_on {
            // A branch starts here.
            self.turns.push(here.clone());
        }
        // The last turn is now the moving end; each branch that it ends gives way to the one before.
        loop {
            let n = self.turns.len();
            let start = self.turns[n - 2].displacement.clone();
            let end = match n {
                0..3 => None,
                3 => Some(-&start),
                _ => Some(self.turns[n - 3].displacement.clone()),
            };
            let from = self.turns[n - 1].displacement.clone();
            let passes = end.as_ref().is_some_and(|end| if rises { to >= end } else { to <= end });
            let stop = if passes { end.unwrap() } else { to.clone() };
            let halves = self.halves();
            if wants_energy {
                let upto = self.loading(&((&stop - &start).abs() / halves)) * halves;
                energy = energy + &upto - self.loading(&((&from - &start).abs() / halves)) * halves;
                size = size + upto;
            }
            if !passes {
                break;
            }
            // Both turns of the closed loop are forgotten; of the first one its mirror point is on the virgin curve.
            self.turns.truncate(if n == 3 { 1 } else { n - 3 });
            let moving = Turn { displacement: stop, ..here.clone() };
            self.turns.push(moving);
        }
        let n = self.turns.len();
        let halves = self.halves();
        let start = &self.turns[n - 2];
        let way = (to - &start.displacement).abs() / halves;
        let point = self.point(&way);
        let jump = &point.tau * halves;
        let force = if rises { &start.force + &jump } else { &start.force - &jump };
        let now = Turn { displacement: to.clone(), force, sample, size: &start.size + jump, point: Some(point) };
        self.turns[n - 1] = now;
        (energy, size)
    }

    pub fn now(&self) -> &Turn {
        self.turns.last().unwrap()
    }
}

/// Tangent stiffness over the unit at the end of a branch, and how much it changes with the way and with Λ.
pub fn stiffness(point: &Point) -> (Real, f64) {
    if point.rest.is_zero() {
        return (Real::new(128, 0.0), 0.0);
    }
    let soft = 1.0 / &point.compliance;
    let rate = ((&point.approach + &point.tau) * &point.curvature * &soft).f64();
    let condition = soft.f64() * (1.0 + rate);
    (soft, condition)
}

/// A path of displacements over that of gross slip.
fn path(dice: &mut Dice, steps: usize) -> Vec<f64> {
    let top = match dice.below(4) {
        0 => dice.power(-6.0, 0.0),
        1 => dice.power(0.0, 2.0),
        _ => dice.between(0.1, 1.5),
    };
    let shape = dice.below(3);
    let mut last = 0.0;
    (0..steps)
        .map(|i| {
            last = match shape {
                // Nested ever deeper, and out again.
                0 if i % 24 < 20 => top * (if i % 2 == 0 { 1.0 } else { -1.0 }) * 0.85f64.powi((i % 24) as i32),
                0 => top * dice.between(-1.0, 1.0),
                1 => top * dice.between(-1.0, 1.0),
                _ => last + top * 0.3 * dice.between(-1.0, 1.0),
            };
            last
        })
        .collect()
}

/// Updates along a path, and tractions at its end.
pub fn along_a_path(case: &Case, dice: &mut Dice, steps: usize, tally: &mut Tally) {
    let Case { contact, reference, kind } = case;
    let law = reference.law(50);
    let mut state = call::state(64);
    let mut memory = Memory::new(law.clone(), contact);
    let soft = 1.0 / law.full_stick.f64();
    let energy_unit = law.energy_unit();
    let path: Vec<f64> = path(dice, steps).iter().map(|share| share * contact.slip_displacement).collect();
    let farthest = path.iter().fold(0.0, |far: f64, u| far.max(u.abs())) / contact.slip_displacement;
    for (i, &u) in path.iter().enumerate() {
        let got = call::update(contact, &mut state, u);
        let (energy, size) = memory.go(&(law.real(u) / &law.displacement_unit), i, true);
        let now = memory.now();
        let range = match memory.turns.len() {
            0..3 => "virgin",
            3..6 => "1 to 3 reversals",
            _ => "4 and more",
        };
        let place = || format!("{} path {:?}", text(&reference.given), &path[..=i]);
        let exact = &law.slip_force * &now.force;
        let scale = &law.slip_force * &now.size;
        tally.check_scaled(("masing_force", kind, range), got[0], &exact, &scale, soft, place);
        if let Some(point) = &now.point {
            let (exact, condition) = stiffness(point);
            let exact = &law.stiffness_unit * exact;
            let way = &point.approach;
            tally.check_between(("masing_stiffness", kind, range), got[1], &exact, &exact, condition, place, || {
                // The way back to the reversal is a difference of two displacements.
                let units = 8.0 * (2.0 + 1.0 / law.slip_approach.f64()) * (1.0 + 2.0 * farthest);
                let moved = [-units, units].map(|units| way * moved(1.0, units));
                Some(moved.map(|way| &law.stiffness_unit * stiffness(&memory.point(&way)).0).into())
            });
        }
        let scale = &energy_unit * (size + if farthest > 1.0 { farthest * 4.0 * law.slip_approach.f64() } else { 0.0 });
        tally.check_scaled(
            ("masing_dissipated", kind, range),
            got[2],
            &(&energy_unit * energy),
            &scale,
            3.0 * soft,
            place,
        );
    }
    shear(reference, contact, kind, &memory, &state, dice, tally);
}

fn shear(
    reference: &Reference,
    contact: &mslip_contact,
    kind: &'static str,
    memory: &Memory,
    state: &[f64],
    dice: &mut Dice,
    tally: &mut Tally,
) {
    let law = &memory.law;
    let x: Vec<f64> = (0..8).map(|_| contact.half_width * dice.between(-1.0, 1.0)).collect();
    let got = call::masing_shear(contact, state, &x);
    let unit = &law.friction * &law.pressure_unit;
    for (&x, got) in x.iter().zip(got) {
        let spot = law.real(x.abs()) / &law.half_width;
        let (mut sum, mut size, mut condition) = (law.real(0.0), law.real(0.0), 0.0f64);
        for (i, turn) in memory.turns.iter().enumerate().skip(1) {
            let Some(point) = &turn.point else { continue };
            let term = law.shear(&spot, point) * if i == 1 { 1.0 } else { 2.0 };
            size = size + &term;
            let rises = turn.displacement > memory.turns[i - 1].displacement;
            sum = if rises { sum + term } else { sum - term };
            // What position, force and half-width bring by their rounding: near each stick zone's edge, and at b.
            let gap = |edge: &Real| (&spot / (&spot - edge)).abs().f64();
            let rate = if point.rest.is_zero() { 0.0 } else { (&point.tau * &point.curvature).f64() };
            condition = condition.max((gap(&point.size) + 1.0 / law.full_stick.f64()) * (1.0 + rate));
        }
        let edge = (&spot / (1.0 - &spot)).abs().f64();
        let range = "any history";
        let place = || format!("{} state {state:?} x {x:e}", text(&reference.given));
        tally.check_scaled(
            ("masing_shear", kind, range),
            got,
            &(&unit * sum),
            &(&unit * size),
            condition + edge,
            place,
        );
    }
}

/// The closed loop of an amplitude.
pub fn closed_loop(case: &Case, dice: &mut Dice, tally: &mut Tally) -> i64 {
    let Case { contact, reference, kind } = case;
    let law = reference.law(50);
    let n = [7, 16, 64, 100][dice.below(4)];
    let (share, range) = match dice.below(4) {
        0 => (dice.power(-9.0, -1.0), "-> 0"),
        1 => (dice.power(0.0, 3.0), "beyond slip"),
        2 => (1.0 - dice.power(-16.0, -2.0), "-> slip"),
        _ => (dice.unit(), "between"),
    };
    let amplitude = share * contact.slip_displacement;
    let [u, t] = call::hysteresis_loop(contact, amplitude, n);
    let mut memory = Memory::new(law.clone(), contact);
    let x = law.real(amplitude) / &law.displacement_unit;
    let soft = 1.0 / law.full_stick.f64();
    memory.go(&x, 0, false);
    for i in 0..n {
        let cosine = (2.0 * Real::pi(law.bits) * i as f64 / n as f64).sin_cos().1;
        let place = || format!("{} A {amplitude:e} instant {i} of {n}", text(&reference.given));
        let exact = law.real(amplitude) * &cosine;
        tally.check_scaled(("loop_displacement", kind, range), u[i], &exact, &law.real(amplitude), 0.0, place);
        if 2 * i >= n {
            memory.go(&-&x, 0, false);
        }
        memory.go(&(&x * &cosine), i, false);
        let now = memory.now();
        tally.check_scaled(
            ("loop_force", kind, range),
            t[i],
            &(&law.slip_force * &now.force),
            &(&law.slip_force * &now.size),
            soft,
            place,
        );
    }
    n as i64
}
