//! States against a bank of 4,096 spring-sliders: one that holds all reversals, and one that holds four and reports the error of
//! those it merged.
//!
//! A bank obeys Masing's rule with its own monotonic curve. If that has an error of ε, the force after a history with n remaining
//! reversals has one of (1 + 2n) ε at most: once on the initial loading curve and twice on each branch. The energy of a cycle of
//! amplitude x, `8 ∫ M - 4 x M`, has an error of 12 x ε at most, and one branch dissipates half of it.

use crate::bank::{Bank, CurvePoint, curve, polygon_error};
use crate::checked::{CheckedHistory, Checks};
use crate::contacts::Named;
use crate::library::{BRANCH_ROUNDING, Contact, State};
use crate::{Case, Run, contacts, ensure, histories};
use reference::Reference;

const SLIDERS: usize = 4096;

/// Points of the curve for each slider, between which its error is measured: midway on a parabola, so it is missed by a 64th.
const POINTS: usize = 8;

/// Steps between two reports of progress.
const BATCH: u64 = 100;

pub fn cases(steps: u64) -> Vec<Case> {
    contacts::all().into_iter().map(|contact| exact(contact, steps)).collect()
}

fn exact(named: Named, steps: u64) -> Case {
    Case::new(format!("bank: {}: 4,096 sliders", named.name), steps, move |run| {
        let contact = &named.contact;
        let curve = curve(&Reference::new(contact.input), SLIDERS * POINTS);
        let end = curve[curve.len() - 1];
        // The error of the library.
        let (force, slip) = (end.force / contact.slip_force() - 1.0, end.displacement / contact.slip() - 1.0);
        ensure!(
            force.abs() < 1e-13 && slip.abs() < 2e-13,
            "the curve ends at {end:?}, {force:e} {slip:e} off\n  {contact:?}"
        );
        let corners: Vec<CurvePoint> = curve.iter().copied().step_by(POINTS).collect();
        let error = polygon_error(&curve, POINTS) * 65.0 / 64.0;
        compare(contact, Bank::polygon(&corners), error, steps, run)
    })
}

/// Advances all through a history; `error` is that of the bank's monotonic force.
fn compare(contact: &Contact, mut bank: Bank, error: f64, steps: u64, run: &mut Run) -> Result<String, String> {
    let slip = contact.slip();
    // One kind of history after the other, but for the last two: to a bank their amplitudes are rounding.
    let mut kinds = histories::all(slip);
    kinds.truncate(kinds.len() - 2);
    let each = steps.div_ceil(kinds.len() as u64);
    let (mut checked, mut short) = (CheckedHistory::new(contact, 64), State::new(4));
    let (mut worst_force, mut worst_energy) = (0.0_f64, 0.0_f64);
    for step in 0..steps {
        let (name, history) = &mut kinds[(step / each) as usize];
        // Not so far that a step is below the rounding of displacements.
        let displacement = history(&checked.memory, &mut run.rng).clamp(-100.0 * slip, 100.0 * slip);
        let (depth, from) = (checked.memory.depth(), checked.memory.now().displacement);
        checked
            .step(displacement, Checks::default(), &mut run.rng)
            .map_err(|failure| format!("step {step}: {failure}\n  {contact:?}"))?;
        let (force, energy) = bank.step(displacement);
        // Springs that stick round their elongation and the step, at most twice as long, in each step. The ends of both curves
        // differ by at most 2e-13.
        let rounding = 2.0 * f64::EPSILON * (step + 1) as f64 + 1e-12;
        let branches = (1 + 2 * checked.memory.depth()) as f64;
        let bound = branches * (error + BRANCH_ROUNDING * contact.slip_force()) + rounding * contact.slip_force();
        let off = (force - checked.now.force).abs();
        worst_force = worst_force.max(off / contact.slip_force());
        ensure!(
            off <= bound,
            "step {step}, {name}: the force {:?} of the bank {force:?}, {bound:?} allowed\n  {contact:?}",
            checked.now.force
        );
        let merged = short.force_after(contact, displacement)?;
        ensure!(
            (merged - force).abs() <= bound + short.error(),
            "step {step}, {name}: the force with merged reversals {merged:?}, of the bank {force:?}, {:?} reported\n  {contact:?}",
            short.error()
        );
        // A step may close every branch.
        let segments = (depth + 2) as f64;
        let distance = (displacement - from).abs();
        let bound = segments * 6.0 * slip * (error + BRANCH_ROUNDING * contact.slip_force())
            + rounding * contact.slip_force() * (slip + distance);
        let off = (energy - checked.now.dissipated).abs();
        worst_energy = worst_energy.max(off / (contact.slip_force() * slip));
        ensure!(
            off <= bound,
            "step {step}, {name}: {:?} dissipated, by the bank {energy:?}, {bound:?} allowed\n  {contact:?}",
            checked.now.dissipated
        );
        if step % BATCH == BATCH - 1 {
            run.done(BATCH);
        }
    }
    run.done(steps % BATCH);
    let error = error / contact.slip_force();
    Ok(format!("error of the curve {error:.0e} of mu N, force off by {worst_force:.0e}, energy by {worst_energy:.0e}"))
}
