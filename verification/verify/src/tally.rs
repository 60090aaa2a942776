//! The worst observed errors, by output, kind of contact and range of the argument.

use crate::bounds::{self, EPSILON};
use reference::Real;
use std::collections::BTreeMap;

/// Output, kind of contact, range of the argument.
pub type Key = (&'static str, &'static str, &'static str);

#[derive(Debug, Clone, Default)]
pub struct Cell {
    pub points: u64,
    /// Error over ε (1 + κ), and the error and κ where that was largest.
    pub worst: f64,
    pub error: f64,
    pub condition: f64,
    pub inputs: String,
    /// The largest error where κ <= 1.
    pub plain: f64,
    /// Points compared with the exact results of neighbouring inputs, because κ is large or changes from one to the next.
    pub between: u64,
    pub broken: u64,
}

#[derive(Debug, Default)]
pub struct Tally {
    pub cells: BTreeMap<Key, Cell>,
}

impl Tally {
    pub fn points(&self, output: &str) -> u64 {
        self.cells.iter().filter(|(key, _)| key.0 == output).map(|(_, cell)| cell.points).sum()
    }

    /// Comparisons at an input of a kind of contact, in a range of the argument.
    pub fn at<F: Fn() -> String>(&mut self, kind: &'static str, range: &'static str, inputs: F) -> At<'_, F> {
        At { tally: self, kind, range, inputs }
    }

    pub fn add(&mut self, other: Tally) {
        for (key, cell) in other.cells {
            let mine = self.cells.entry(key).or_default();
            let (points, between, broken) =
                (mine.points + cell.points, mine.between + cell.between, mine.broken + cell.broken);
            let plain = mine.plain.max(cell.plain);
            if cell.worst > mine.worst || mine.points == 0 {
                *mine = cell;
            }
            (mine.points, mine.between, mine.broken, mine.plain) = (points, between, broken, plain);
        }
    }
}

/// Compares the outputs at an input, which is printed with the worst of them.
pub struct At<'a, F> {
    tally: &'a mut Tally,
    kind: &'static str,
    range: &'static str,
    inputs: F,
}

impl<F: Fn() -> String> At<'_, F> {
    pub fn inputs(&self) -> String {
        (self.inputs)()
    }

    /// Compares a result with the exact one, relative to it.
    pub fn check(&mut self, output: &'static str, got: f64, exact: &Real, condition: f64) {
        self.check_scaled(output, got, exact, exact, condition);
    }

    /// Compares a result with the exact one, relative to a scale.
    pub fn check_scaled(&mut self, output: &'static str, got: f64, exact: &Real, scale: &Real, condition: f64) {
        self.check_between(output, got, exact, scale, condition, Vec::new);
    }

    /// The same; beyond the bound a result is accepted if it lies between the exact results of neighbouring inputs.
    pub fn check_between(
        &mut self,
        output: &'static str,
        got: f64,
        exact: &Real,
        scale: &Real,
        condition: f64,
        neighbours: impl FnOnce() -> Vec<Real>,
    ) {
        // Results near the subnormal range have fewer digits.
        if !exact.is_zero() && exact.exponent() < -1000 && exact.exponent() > -100_000 {
            return;
        }
        let k = bounds::find(output);
        let both = got == exact.f64() && (exact.is_zero() || got.is_infinite());
        let mut error = if both { 0.0 } else { ((Real::new(exact.bits(), got) - exact) / scale).abs().f64() };
        if error.is_nan() {
            error = f64::INFINITY;
        }
        let mut condition = if condition.is_finite() { condition.abs() } else { f64::INFINITY };
        let mut ratio = if error == 0.0 { 0.0 } else { error / EPSILON / (1.0 + condition) };
        let cell = self.tally.cells.entry((output, self.kind, self.range)).or_default();
        cell.points += 1;
        let is_beyond = ratio > k || condition.is_infinite() || condition > 1e12;
        let around = if is_beyond { neighbours() } else { Vec::new() };
        if !around.is_empty() {
            let low = around.iter().fold(exact.clone(), |low, one| low.min(one));
            let high = around.iter().fold(exact.clone(), |high, one| high.max(one));
            // Results of neighbours have the error that is promised here.
            let promised = if condition <= 1e12 { 1.0 + condition } else { 1.0 };
            let slack = scale.abs().max(&low.abs()).max(&high.abs()) * (k * EPSILON * promised);
            let value = Real::new(exact.bits(), got);
            cell.between += 1;
            if (value >= &low - &slack && value <= high + slack) || (ratio <= k && condition.is_finite()) {
                return;
            }
            (ratio, condition) = (f64::INFINITY, 0.0);
        }
        if ratio.is_nan() || ratio > k {
            cell.broken += 1;
        }
        if condition <= 1.0 {
            cell.plain = cell.plain.max(error);
        }
        if ratio > cell.worst || cell.points == 1 {
            (cell.worst, cell.error, cell.condition, cell.inputs) = (ratio, error, condition, (self.inputs)());
        }
    }
}
