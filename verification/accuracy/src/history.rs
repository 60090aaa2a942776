//! Histories: the law as a Prandtl-Ishlinskii operator. The force is a sum over the reversals that were not wiped out, with or
//! without gross slip in between: T = M(v1) + 2 M((v2-v1)/2) + ..., M odd and mu N beyond gross slip.

use crate::call;
use crate::cases::{Case, Dice, text};
use crate::curve::moved;
use crate::real::Real;
use crate::reference::{Law, Point, Reference};
use crate::tally::Tally;
use microslip::ffi::mslip_contact;
use std::rc::Rc;

/// A reversal: displacement and force in units, and the number of its sample.
#[derive(Clone)]
pub struct Reversal {
    pub displacement: Real,
    pub force: Real,
    pub sample: usize,
    /// Sum of the sizes of the terms of the force.
    pub size: Real,
    /// The point of the curve at half the range from the reversal before.
    pub point: Option<Point>,
}

/// The reversals since the unloaded state; the last one is the present point.
pub struct Memory<'a> {
    law: Rc<Law>,
    contact: &'a mslip_contact,
    pub reversals: Vec<Reversal>,
}

impl<'a> Memory<'a> {
    pub fn new(law: Rc<Law>, contact: &'a mslip_contact) -> Memory<'a> {
        let zero = || law.real(0.0);
        let reversals =
            vec![Reversal { displacement: zero(), force: zero(), sample: usize::MAX, size: zero(), point: None }];
        Memory { law, contact, reversals }
    }

    fn point(&self, range: &Real) -> Point {
        let near = call::force(self.contact, (range * &self.law.displacement_unit).f64())[0];
        self.law.at_approach(range, &(self.law.real(near) / &self.law.slip_force))
    }

    /// Energy, in units, of the first loading to a displacement.
    fn loading(&self, range: &Real) -> Real {
        if range.is_zero() {
            return self.law.real(0.0);
        }
        crate::cycle::cycle_energy(&self.law, range, &self.point(range)).0 / 4.0
    }

    fn scale(&self) -> f64 {
        if self.reversals.len() == 2 { 1.0 } else { 2.0 }
    }

    /// Advances to a displacement; the energy dissipated and the sum of its terms.
    pub fn go(&mut self, to: &Real, sample: usize, wants_energy: bool) -> (Real, Real) {
        let (mut energy, mut size) = (self.law.real(0.0), self.law.real(0.0));
        let here = self.reversals.last().unwrap().clone();
        if to == &here.displacement {
            return (energy, size);
        }
        let rises = to > &here.displacement;
        let goes_on = self.reversals.len() > 1 && {
            let before = &self.reversals[self.reversals.len() - 2];
            (here.displacement > before.displacement) == rises
        };
        if !goes_on {
            // A branch starts here.
            self.reversals.push(here.clone());
        }
        // The last one is now the moving end. A branch that reaches its end continues on the branch before it.
        loop {
            let n = self.reversals.len();
            let start = self.reversals[n - 2].displacement.clone();
            let end = match n {
                0..3 => None,
                3 => Some(-&start),
                _ => Some(self.reversals[n - 3].displacement.clone()),
            };
            let from = self.reversals[n - 1].displacement.clone();
            let passes = end.as_ref().is_some_and(|end| if rises { to >= end } else { to <= end });
            let stop = if passes { end.unwrap() } else { to.clone() };
            let scale = self.scale();
            if wants_energy {
                let upto = self.loading(&((&stop - &start).abs() / scale)) * scale;
                energy = energy + &upto - self.loading(&((&from - &start).abs() / scale)) * scale;
                size = size + upto;
            }
            if !passes {
                break;
            }
            // Both reversals of a closed loop are popped; the mirror point of the oldest is on the initial loading curve.
            self.reversals.truncate(if n == 3 { 1 } else { n - 3 });
            let moving = Reversal { displacement: stop, ..here.clone() };
            self.reversals.push(moving);
        }
        let n = self.reversals.len();
        let scale = self.scale();
        let start = &self.reversals[n - 2];
        let range = (to - &start.displacement).abs() / scale;
        let point = self.point(&range);
        let jump = &point.tau * scale;
        let force = if rises { &start.force + &jump } else { &start.force - &jump };
        let now = Reversal { displacement: to.clone(), force, sample, size: &start.size + jump, point: Some(point) };
        self.reversals[n - 1] = now;
        (energy, size)
    }

    pub fn now(&self) -> &Reversal {
        self.reversals.last().unwrap()
    }
}

/// Dimensionless tangent stiffness at the end of a branch, and its condition number with respect to the displacement and Λ.
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
        let range = match memory.reversals.len() {
            0..3 => "initial loading",
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
            let distance = &point.approach;
            tally.check_between(("masing_stiffness", kind, range), got[1], &exact, &exact, condition, place, || {
                // The range from the reversal is a difference of two displacements.
                let units = 8.0 * (2.0 + 1.0 / law.slip_approach.f64()) * (1.0 + 2.0 * farthest);
                let moved = [-units, units].map(|units| distance * moved(1.0, units));
                Some(moved.map(|range| &law.stiffness_unit * stiffness(&memory.point(&range)).0).into())
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
        for (i, reversal) in memory.reversals.iter().enumerate().skip(1) {
            let Some(point) = &reversal.point else { continue };
            let term = law.shear(&spot, point) * if i == 1 { 1.0 } else { 2.0 };
            size = size + &term;
            let rises = reversal.displacement > memory.reversals[i - 1].displacement;
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
