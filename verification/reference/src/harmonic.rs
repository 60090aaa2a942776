//! Harmonic coefficients of the steady force under u(t) = u0 + Σ (u_c cos kt + u_s sin kt), in units; order [0, c1, s1, c2, ...].

use crate::history::{Dissipated, History};
use crate::quadrature::Quadrature;
use crate::{Law, Real, Reference};
use std::rc::Rc;

/// 1, cos t, sin t, cos 2t, ...
fn basis(harmonics: usize, t: &Real) -> Vec<Real> {
    let waves = (1..=harmonics).flat_map(|k| {
        let (sine, cosine) = (t * k as f64).sin_cos();
        [cosine, sine]
    });
    [Real::new(t.bits(), 1.0)].into_iter().chain(waves).collect()
}

pub(crate) fn basis_at_samples(bits: u32, harmonics: usize, samples: usize) -> Vec<Vec<Real>> {
    let angle = |i: usize| 2.0 * Real::pi(bits) * (i as f64) / samples as f64;
    (0..samples).map(|i| basis(harmonics, &angle(i))).collect()
}

pub(crate) fn dot(one: &[Real], two: &[Real]) -> Real {
    one.iter().zip(two).fold(Real::new(one[0].bits(), 0.0), |sum, (a, b)| sum + a * b)
}

/// The result of the alternating frequency/time procedure.
pub struct Sampled {
    pub force: Vec<Real>,
    /// By columns.
    pub jacobian: Vec<Real>,
    pub dissipated: Dissipated,
    /// Largest sum of the sizes of the terms of a force.
    pub size: f64,
}

/// By its definition: the second period from the unloaded state at uniformly spaced samples, each of which is passed on.
pub fn sampled(law: &Rc<Law>, coefficients: &[Real], samples: usize, mut each: impl FnMut(&History)) -> Sampled {
    let width = coefficients.len();
    let rows = basis_at_samples(law.bits, width / 2, samples);
    let zero = || law.real(0.0);
    let mut history = History::new(law.clone());
    let mut sums = Sampled {
        force: vec![zero(); width],
        jacobian: vec![zero(); width * width],
        dissipated: Dissipated { energy: zero(), size: zero() },
        size: 0.0,
    };
    for (i, row) in rows.iter().enumerate() {
        history.go(&dot(row, coefficients), i);
    }
    for (i, row) in rows.iter().enumerate() {
        let Dissipated { energy, size } = history.go_with_energy(&dot(row, coefficients), i);
        sums.dissipated = Dissipated { energy: sums.dissipated.energy + energy, size: sums.dissipated.size + size };
        let [force, size] = history.force();
        sums.size = sums.size.max(size.f64());
        let mut slope = vec![zero(); width];
        for (n, reversal) in history.reversals.iter().enumerate() {
            let stiffness = reversal.point.stiffness();
            for (j, slope) in slope.iter_mut().enumerate() {
                let before = if n == 0 { zero() } else { rows[history.reversals[n - 1].sample][j].clone() };
                *slope = &*slope + &stiffness * (&rows[reversal.sample][j] - before);
            }
        }
        for (l, wave) in row.iter().enumerate() {
            let weight = wave * if l == 0 { 1.0 } else { 2.0 } / samples as f64;
            sums.force[l] = &sums.force[l] + &weight * &force;
            for (j, slope) in slope.iter().enumerate() {
                sums.jacobian[l + width * j] = &sums.jacobian[l + width * j] + &weight * slope;
            }
        }
        each(&history);
    }
    sums
}

/// The exact integrals over a period, by quadrature of each branch between its events.
pub fn exact(law: &Rc<Law>, coefficients: &[Real]) -> Vec<Real> {
    let (width, harmonics) = (coefficients.len(), coefficients.len() / 2);
    let u = |t: &Real| dot(&basis(harmonics, t), coefficients);
    let rates: Vec<Real> = (0..width)
        .map(|j| match j {
            0 => law.real(0.0),
            j if j % 2 == 1 => &coefficients[j + 1] * (j.div_ceil(2) as f64),
            j => -&coefficients[j - 1] * ((j / 2) as f64),
        })
        .collect();
    let rate = |t: &Real| dot(&basis(harmonics, t), &rates);
    // Times of the reversals: changes of sign of du/dt, found by a scan in steps far shorter than the shortest wave.
    let scan = 256 * harmonics;
    let times: Vec<Real> = (0..=scan).map(|i| Real::pi(law.bits) * (2.0 * i as f64 / scan as f64) + 1.0).collect();
    let reversals = times.windows(2).filter(|step| rate(&step[0]).is_positive() != rate(&step[1]).is_positive());
    let mut reversals: Vec<(Real, Real)> =
        reversals.map(|step| root(&step[0], &step[1], &rate)).map(|t| (t.clone(), u(&t))).collect();
    let (first, top) = reversals.first().expect("a motion").clone();
    reversals.push((first + Real::pi(law.bits) * 2.0, top));

    // One period from the unloaded state to the steady cycle.
    let mut history = History::new(law.clone());
    reversals.iter().for_each(|(_, u)| history.go(u, 0));
    let rule = Quadrature::new(law.bits);
    let mut sums = vec![law.real(0.0); width];
    for half_cycle in reversals.windows(2) {
        let (mut from, (last, end)) = (half_cycle[0].0.clone(), &half_cycle[1]);
        while history.now().displacement != *end {
            let (branch, stop) = Branch::to(&history, end);
            let to = if stop == *end { last.clone() } else { root(&from, last, &|t| u(t) - &stop) };
            let integrals = rule.integrals(1e-19, &from, &to, |t| {
                let basis = basis(harmonics, t);
                let force = branch.force(&dot(&basis, coefficients));
                basis.iter().map(|wave| wave * &force).collect()
            });
            for (l, (sum, integral)) in sums.iter_mut().zip(integrals).enumerate() {
                *sum = &*sum + integral / Real::pi(law.bits) / if l == 0 { 2.0 } else { 1.0 };
            }
            history.go(&stop, 0);
            from = to;
        }
    }
    sums
}

/// A curve that starts at a reversal, or the initial loading curve.
struct Branch {
    law: Rc<Law>,
    start: Real,
    force: Real,
    scale: f64,
}

impl Branch {
    /// The branch towards a displacement, and where it ends or slips first.
    fn to(history: &History, end: &Real) -> (Branch, Real) {
        let now = &history.now().displacement;
        let rises = end > now;
        let mut start = history.clone();
        if history.now().rises == rises {
            start.reversals.pop();
        }
        let law = history.law.clone();
        let scale = if start.reversals.is_empty() { 1.0 } else { 2.0 };
        let force = start.force()[0].clone();
        let places: Vec<Real> = start.reversals.iter().rev().take(2).map(|one| one.displacement.clone()).collect();
        let (start, closes) = match &places[..] {
            [] => (law.real(0.0), None),
            [start] => (start.clone(), Some(-start)),
            [start, before, ..] => (start.clone(), Some(before.clone())),
        };
        let distance = scale * &law.x_slip;
        let slip = if rises { &start + distance } else { &start - distance };
        let ahead = |place: &Real| if rises { place > now && place < end } else { place < now && place > end };
        let events = [Some(slip), closes].into_iter().flatten().filter(ahead);
        let stop = events.fold(end.clone(), |stop, event| if rises { stop.min(&event) } else { stop.max(&event) });
        (Branch { law, start, force, scale }, stop)
    }

    fn force(&self, u: &Real) -> Real {
        let half_range = (u - &self.start) / self.scale;
        let x = half_range.abs();
        // At both ends of the curve its tangent, to the square of this share: the inverse would need more bits.
        let share = (&x / &self.law.x_slip).f64();
        let tau = if share < 1e-15 {
            x / &self.law.full_stick
        } else if (1.0 - &x / &self.law.x_slip).abs().f64() < 1e-26 {
            self.law.real(1.0)
        } else {
            self.law.at_x(&x).tau
        };
        let jump = tau * self.scale;
        if half_range.is_positive() { &self.force + jump } else { &self.force - jump }
    }
}

/// The root between two arguments at which f has different signs, by the Illinois variant of the secant method.
fn root(from: &Real, to: &Real, f: &dyn Fn(&Real) -> Real) -> Real {
    let (mut one, mut two) = ((from.clone(), f(from)), (to.clone(), f(to)));
    for _ in 0..200 {
        let step = &two.1 * (&two.0 - &one.0) / (&two.1 - &one.1);
        let next = &two.0 - &step;
        if two.1.is_zero() || step.is_zero() || step.exponent() < next.exponent() - from.bits() as i32 + 8 {
            return next;
        }
        let value = f(&next);
        if value.is_positive() == two.1.is_positive() {
            one.1 = one.1 / 2.0;
        } else {
            one = two;
        }
        two = (next, value);
    }
    two.0
}

/// Coefficients \[N\] for coefficients \[m\]: by sampling, or exact with 0 samples.
pub fn force(contact: &Reference, displacement: &[f64], samples: usize) -> Vec<Real> {
    let law = contact.law(50);
    let u: Vec<Real> = displacement.iter().map(|u| law.x(*u)).collect();
    let force = if samples == 0 { exact(&law, &u) } else { sampled(&law, &u, samples, |_| ()).force };
    force.iter().map(|force| force * &law.slip_force).collect()
}
