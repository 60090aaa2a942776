//! Checked histories against a bank of 4,096 spring-sliders in parallel (Jenkins, Iwan), whose load history is the elongation of
//! each spring, without Masing's rule.
//!
//! A bank obeys Masing's rule with its own monotonic curve. If that has an error of ε, the force after a history with n remaining
//! reversals has one of (1 + 2n) ε at most: once on the initial loading curve and twice on each branch. The energy of a cycle of
//! amplitude x, `8 ∫ M - 4 x M`, has an error of 12 x ε at most, and one branch dissipates half of it.

use crate::checked::CheckedHistory;
use crate::library::{BRANCH_ROUNDING, Contact};
use crate::{Outcome, ensure, histories};
use rand::rngs::SmallRng;
use reference::Reference;

const SLIDERS: usize = 4096;

/// Points of the curve for each slider, between which its error is measured: midway on a parabola, so it is missed by a 64th.
const POINTS: usize = 8;

/// Sums that the processor may add side by side.
const LANES: usize = 8;

/// A point of the monotonic curve.
#[derive(Debug, Clone, Copy)]
struct CurvePoint {
    displacement: f64,
    force: f64,
}

/// Points of the exact curve from the unloaded state to gross slip. Stick zones shrink like a cosine, so that steps are small where
/// the compliance of a short contact grows from almost nothing; the last point is gross slip.
fn curve(contact: &Reference, pieces: usize) -> Vec<CurvePoint> {
    let law = contact.law(0);
    let w = law.w_range();
    let points = (0..=pieces).map(|k| match k {
        0 => law.at_w(&w),
        k if k == pieces => law.slip_point(),
        k => law.at_w(&(&w * (0.5 * std::f64::consts::PI * (1.0 - k as f64 / pieces as f64)).sin())),
    });
    points
        .map(|point| CurvePoint {
            displacement: (&law.displacement_unit * point.x).f64(),
            force: (&law.slip_force * point.tau).f64(),
        })
        .collect()
}

struct Bank {
    stiffness: Vec<f64>,
    /// Elongation at which each one slips.
    slip: Vec<f64>,
    elongation: Vec<f64>,
    displacement: f64,
}

impl Bank {
    /// The bank whose curve is the polygon through these points, the first of them the origin: one slider slips at each corner
    /// and has the change of slope there as its stiffness.
    fn polygon(corners: &[CurvePoint]) -> Bank {
        let slopes: Vec<f64> = corners
            .windows(2)
            .map(|side| (side[1].force - side[0].force) / (side[1].displacement - side[0].displacement))
            .collect();
        let next = slopes.iter().skip(1).chain([&0.0]);
        let mut stiffness: Vec<f64> = slopes.iter().zip(next).map(|(slope, next)| slope - next).collect();
        let mut slip: Vec<f64> = corners[1..].iter().map(|corner| corner.displacement).collect();
        let whole = stiffness.len().next_multiple_of(LANES);
        stiffness.resize(whole, 0.0);
        slip.resize(whole, 0.0);
        Bank { elongation: vec![0.0; whole], stiffness, slip, displacement: 0.0 }
    }

    /// Advances to a displacement: force, and energy dissipated.
    fn step(&mut self, displacement: f64) -> (f64, f64) {
        let way = displacement - self.displacement;
        self.displacement = displacement;
        let (mut force, mut energy) = ([0.0; LANES], [0.0; LANES]);
        let springs = self.stiffness.as_chunks::<LANES>().0.iter().zip(self.slip.as_chunks::<LANES>().0);
        for (elongation, (stiffness, slip)) in self.elongation.as_chunks_mut::<LANES>().0.iter_mut().zip(springs) {
            for i in 0..LANES {
                let free = elongation[i] + way;
                elongation[i] = free.max(-slip[i]).min(slip[i]);
                force[i] += stiffness[i] * elongation[i];
                energy[i] += stiffness[i] * slip[i] * (free - elongation[i]).abs();
            }
        }
        (force.iter().sum(), energy.iter().sum())
    }
}

/// Largest distance in force of the polygon through every `each`-th of these points from the others: the largest error of the
/// monotonic curve of a bank.
fn polygon_error(curve: &[CurvePoint], each: usize) -> f64 {
    let sides = (0..curve.len() - 1).step_by(each).map(|first| &curve[first..=first + each]);
    sides
        .flat_map(|side| {
            let (from, to) = (side[0], side[each]);
            let slope = (to.force - from.force) / (to.displacement - from.displacement);
            side.iter().map(move |point| point.force - from.force - slope * (point.displacement - from.displacement))
        })
        .fold(0.0, |worst, error| error.abs().max(worst))
}

/// Advances a contact and its bank through one kind of history after the other.
pub fn compare(contact: &Contact, steps: u64, rng: &mut SmallRng) -> Outcome {
    let curve = curve(&Reference::new(contact.input), SLIDERS * POINTS);
    let end = curve[curve.len() - 1];
    // The error of the library.
    let (force, slip) = (end.force / contact.slip_force() - 1.0, end.displacement / contact.slip() - 1.0);
    ensure!(force.abs() < 1e-13 && slip.abs() < 2e-13, "the curve ends at {end:?}, {force:e} {slip:e} off");
    let corners: Vec<CurvePoint> = curve.iter().copied().step_by(POINTS).collect();
    let mut bank = Bank::polygon(&corners);
    let error = polygon_error(&curve, POINTS) * 65.0 / 64.0 + BRANCH_ROUNDING * contact.slip_force();
    let slip = contact.slip();
    // But for the last two: to a bank their amplitudes are rounding.
    let mut kinds = histories::all(slip);
    kinds.truncate(kinds.len() - 2);
    let each = steps.div_ceil(kinds.len() as u64);
    let mut checked = CheckedHistory::new(contact);
    for step in 0..steps {
        let (name, history) = &mut kinds[(step / each) as usize];
        // Not so far that a step is below the rounding of displacements.
        let displacement = history(&checked.memory, rng).clamp(-100.0 * slip, 100.0 * slip);
        let (depth, from) = (checked.memory.depth(), checked.memory.now().displacement);
        checked.step(displacement, false).map_err(|failure| format!("step {step}, {name}: {failure}"))?;
        let (force, energy) = bank.step(displacement);
        // Springs that stick round their elongation and the step, at most twice as long, in each step. The ends of both curves
        // differ by at most 2e-13.
        let rounding = (2.0 * f64::EPSILON * (step + 1) as f64 + 1e-12) * contact.slip_force();
        let bound = (1 + 2 * checked.memory.depth()) as f64 * error + rounding;
        let found = checked.now;
        ensure!(
            (force - found.force).abs() <= bound,
            "step {step}, {name}: the force {:?} of the bank {force:?}, {bound:?} allowed",
            found.force
        );
        // A step may close every branch.
        let bound = (depth + 2) as f64 * 6.0 * slip * error + rounding * (slip + (displacement - from).abs());
        ensure!(
            (energy - found.dissipated).abs() <= bound,
            "step {step}, {name}: {:?} dissipated, by the bank {energy:?}, {bound:?} allowed",
            found.dissipated
        );
    }
    Ok(())
}
