//! Histories: updates along random paths, tractions at their end, and closed loops.

use crate::call;
use crate::curve::moved;
use crate::histories;
use crate::sampler::{Case, Sampler, text};
use crate::tally::Tally;
use reference::history::History;
use reference::law::bits_for;
use reference::{Point, Real};

/// Dimensionless tangent stiffness at the end of a branch, and its condition number with respect to the displacement and Λ.
fn stiffness(point: &Point) -> (Real, f64) {
    let stiffness = point.stiffness();
    if point.slips() {
        return (stiffness, 0.0);
    }
    let rate = ((&point.x + &point.tau) * &point.curvature * &stiffness).f64();
    let condition = stiffness.f64() * (1.0 + rate);
    (stiffness, condition)
}

/// Updates along a path, and tractions at its end.
pub fn along_a_path(case: &Case, sampler: &mut Sampler, tally: &mut Tally) {
    let kind = sampler.below(histories::OF_CONTACTS - 1);
    let path = histories::of_contact(sampler, case.contact.slip_displacement, kind, 48);
    let (history, state) = updates(case, &path, tally);
    shear(case, &history, &state, sampler, tally);
}

/// Updates along a path, and the history and the state at its end.
pub fn updates(case: &Case, path: &[f64], tally: &mut Tally) -> (History, Vec<f64>) {
    let Case { contact, reference, kind } = case;
    // Bits for the narrowest range between two displacements.
    let mut sorted: Vec<f64> = path.iter().copied().chain([0.0]).collect();
    sorted.sort_by(f64::total_cmp);
    let ranges = sorted.windows(2).map(|two| two[1] - two[0]).filter(|range| *range > 0.0);
    let narrowest = ranges.fold(contact.slip_displacement, f64::min) / contact.slip_displacement;
    let law = reference.law(50 + bits_for(&Real::new(64, narrowest)));
    let mut state = call::state(64);
    let mut history = History::new(law.clone());
    let soft = 1.0 / law.full_stick.f64();
    let energy_unit = law.energy_unit();
    let farthest = path.iter().fold(0.0, |far: f64, u| far.max(u.abs())) / contact.slip_displacement;
    for (i, &u) in path.iter().enumerate() {
        let got = call::update(contact, &mut state, u);
        let dissipated = history.go_with_energy(&law.x(u), i);
        let range = match history.reversals.len() {
            1 => "initial loading",
            2..5 => "1 to 3 reversals",
            _ => "4 and more",
        };
        let mut at = tally.at(kind, range, || format!("{} path {:?}", text(&reference.input), &path[..=i]));
        if u == 0.0 && history.reversals.len() == 1 {
            assert!(got[0] == 0.0 && got[2] == 0.0, "unloaded: {got:?}; {}", at.inputs());
            continue;
        }
        let [exact, scale] = history.force().map(|force| &law.slip_force * force);
        at.check_scaled("masing_force", got[0], &exact, &scale, soft);
        let point = &history.now().point;
        let (exact, condition) = stiffness(point);
        let exact = &law.stiffness_unit * exact;
        at.check_between("masing_stiffness", got[1], &exact, &exact, condition, || {
            // The range from the reversal is a difference of two displacements.
            let units = 8.0 * (2.0 + 1.0 / law.x_slip.f64()) * (1.0 + 2.0 * farthest);
            let around = [-units, units].map(|units| law.at_x(&(&point.x * moved(1.0, units))).stiffness());
            around.map(|stiffness| &law.stiffness_unit * stiffness).into()
        });
        let slip = if farthest > 1.0 { farthest * 4.0 * law.x_slip.f64() } else { 0.0 };
        let (exact, scale) = (&energy_unit * dissipated.energy, &energy_unit * (dissipated.size + slip));
        at.check_scaled("masing_dissipated", got[2], &exact, &scale, 3.0 * soft);
    }
    (history, state)
}

fn shear(case: &Case, history: &History, state: &[f64], sampler: &mut Sampler, tally: &mut Tally) {
    let Case { contact, reference, kind } = case;
    let law = &history.law;
    let x: Vec<f64> = (0..8).map(|_| contact.half_width * sampler.between(-1.0, 1.0)).collect();
    let unit = &law.friction * &law.pressure_unit;
    for (&x, got) in x.iter().zip(call::masing_shear(contact, state, &x)) {
        let spot = law.real(x.abs()) / &law.half_width;
        let (mut sum, mut size, mut condition) = (law.real(0.0), law.real(0.0), 0.0f64);
        for (i, reversal) in history.reversals.iter().enumerate() {
            let point = &reversal.point;
            let term = law.shear(&spot, point) * if i == 0 { 1.0 } else { 2.0 };
            size = size + &term;
            sum = if reversal.rises { sum + term } else { sum - term };
            // Rounding of position, force and half-width, near the edge of each stick zone.
            let gap = (&spot / (&spot - &point.size)).abs().f64();
            condition = condition.max((gap + 1.0 / law.full_stick.f64()) * (1.0 + point.rate()));
        }
        let edge = (&spot / (1.0 - &spot)).abs().f64();
        let inputs = || format!("{} state {state:?} x {x:e}", text(&reference.input));
        let mut at = tally.at(kind, "any history", inputs);
        at.check_scaled("masing_shear", got, &(&unit * sum), &(&unit * size), condition + edge);
    }
}

/// The closed loop of an amplitude.
pub fn closed_loop(case: &Case, sampler: &mut Sampler, tally: &mut Tally) {
    let n = [7, 16, 64, 100][sampler.below(4)];
    let (share, range) = match sampler.below(4) {
        0 => (sampler.power(-9.0, -1.0), "-> 0"),
        1 => (sampler.power(0.0, 3.0), "beyond slip"),
        2 => (1.0 - sampler.power(-16.0, -2.0), "-> slip"),
        _ => (sampler.unit(), "between"),
    };
    of_amplitude(case, share * case.contact.slip_displacement, n, range, tally);
}

pub fn of_amplitude(case: &Case, amplitude: f64, n: usize, range: &'static str, tally: &mut Tally) {
    let Case { contact, reference, kind } = case;
    let law = reference.law(50);
    let [u, t] = call::hysteresis_loop(contact, amplitude, n);
    let mut history = History::new(law.clone());
    let x = law.x(amplitude);
    let soft = 1.0 / law.full_stick.f64();
    history.go(&x, 0);
    for i in 0..n {
        let cosine = (2.0 * Real::pi(law.bits) * i as f64 / n as f64).sin_cos().1;
        let mut at = tally.at(kind, range, || format!("{} A {amplitude:e} instant {i} of {n}", text(&reference.input)));
        let exact = law.real(amplitude) * &cosine;
        at.check_scaled("loop_displacement", u[i], &exact, &law.real(amplitude), 0.0);
        if 2 * i >= n {
            history.go(&-&x, 0);
        }
        history.go(&(&x * &cosine), i);
        let [exact, scale] = history.force().map(|force| &law.slip_force * force);
        at.check_scaled("loop_force", t[i], &exact, &scale, soft);
    }
}
