//! The law under prescribed forces: the displacement that gives a tangential force, by Newton's method with the law's tangent.

use crate::histories::History;
use microslip::element::Element;
use microslip::one_direction::{self as state, Law, OneDirection};

/// Steps of the law for each row, straight in both forces.
pub const SUBSTEPS: u32 = 6;

/// The law at the end of a step.
#[derive(Debug, Clone, Copy)]
pub struct Point {
    pub displacement: f64,
    /// Energy dissipated so far \[J\].
    pub dissipated: f64,
}

/// The displacement between `low` and `high` at which a force that does not fall has a value: Newton's method from `start`, bisection
/// where it leaves the bracket.
pub fn displacement_at(target: f64, start: f64, mut low: f64, mut high: f64, law: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut u = start;
    for _ in 0..200 {
        let (force, stiffness) = law(u);
        if force < target {
            low = u;
        } else {
            high = u;
        }
        let next = u + (target - force) / stiffness;
        let next = if next > low && next < high { next } else { 0.5 * (low + high) };
        if (next - u).abs() <= 1e-15 * (high.abs() + low.abs()) || low.next_up() >= high {
            return next;
        }
        u = next;
    }
    u
}

/// The element along a history, at the end of each substep; the first row is one step from the open contact.
pub fn varying(element: &Element, history: &History) -> Vec<Point> {
    let mut memory = vec![0.0; state::state_length(256)];
    OneDirection::state_init(&mut memory).expect("a state");
    // Twice the shift under the largest force: beyond it there is gross slip.
    let reach = 4.0 * element.friction_coefficient * element.shift_under(element.normal_force);
    let mut now = Point { displacement: 0.0, dissipated: 0.0 };
    let mut last = history.rows[0];
    let mut points = Vec::new();
    for (i, row) in history.rows.iter().enumerate() {
        let parts = if i == 0 { 1 } else { SUBSTEPS };
        for part in 1..=parts {
            let along = |from: f64, to: f64| from + (to - from) * f64::from(part) / f64::from(parts);
            let normal_force = along(last.normal_force, row.normal_force);
            let target = along(last.tangential_force, row.tangential_force);
            let trial = |u: f64| {
                let step = OneDirection::step(element, &mut memory.clone(), [u, normal_force]).expect("a step");
                (step.force[0], step.tangent[0])
            };
            let (start, low, high) = (now.displacement, now.displacement - reach, now.displacement + reach);
            let displacement = displacement_at(target, start, low, high, trial);
            let step = OneDirection::step(element, &mut memory, [displacement, normal_force]).expect("a step");
            let dissipated = now.dissipated + step.dissipated;
            now = Point { displacement, dissipated };
            points.push(now);
        }
        last = *row;
    }
    points
}
