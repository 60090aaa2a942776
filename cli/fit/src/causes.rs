//! What the residuals show.
//!
//! Each cause has a direction: the derivative of the forces with respect to its size. What the parameters of the fit could take
//! of residuals and directions is removed, and the residuals are regressed on one direction after the other, the one that
//! explains most first. The direction is that at the fit, so that sizes of large effects are estimates.

use crate::cycles::{Loop, Sample};
use crate::data::{ends, mean};
use crate::error::Error;
use crate::least_squares::{Fit, Free};
use crate::model::{FRICTION, Prediction};
use crate::report::{Cause, CauseKind, CauseKind::*};
use nalgebra::{DMatrix, DVector};

/// A cause, and its residuals.
#[derive(Debug, Clone)]
pub(crate) struct Effect {
    pub cause: Cause,
    pub residuals: DVector<f64>,
}

/// A direction of which the parameters of the fit take all but this part is not distinguished from them.
const DISTINCT: f64 = 0.03;

/// A cause of residuals that noise does not explain is named if it explains this part of their squares, of which noise has a
/// quarter at most.
pub(crate) const LEAST_SHARE: f64 = 0.1;
/// Samples of a loop that a play leaves at least.
const LEAST_SAMPLES: usize = 20;

/// The model at a sample.
struct At<'a> {
    one: &'a Loop,
    sample: &'a Sample,
    /// Without offset and drift.
    prediction: Prediction,
    /// Change of the force per sample of the measurement.
    force_step: f64,
    /// Standard deviation of the residual.
    sigma: f64,
}

pub(crate) const KINDS: [CauseKind; 8] =
    [DifferentPlateaus, Amplitude, Cycle, Speed, Lag, Play, Viscous, ParallelSpring];

/// The model at all samples.
fn samples<'a>(fit: &'a Fit) -> Vec<At<'a>> {
    let of_loop = |(one, predictions): (&'a Loop, Vec<(Prediction, f64)>)| -> Vec<At> {
        let force = |i: usize| predictions[i].0.force;
        let at = |(i, sample): (usize, &'a Sample)| {
            let (before, after) = (i.saturating_sub(1), (i + 1).min(predictions.len() - 1));
            let (prediction, sigma) = predictions[i];
            let force_step = (force(after) - force(before)) / ((after - before) as f64 * one.interval);
            At { one, sample, prediction, force_step, sigma }
        };
        one.samples.iter().enumerate().map(at).collect()
    };
    fit.predictions().flat_map(of_loop).collect()
}

/// The causes of these kinds that explain more than this share of the residuals, the one that explains most first.
pub(crate) fn causes(fit: &Fit, kinds: &[CauseKind], least_share: f64) -> Vec<Effect> {
    let Some((residuals, parameters)) = fit.basis() else { return Vec::new() };
    let samples = samples(fit);
    let largest = |value: &dyn Fn(&At) -> f64| ends(samples.iter().map(value))[1];
    let slip_force = fit.parameters[FRICTION] * largest(&|at| at.one.normal_force);
    let highest_speed = largest(&|at| at.sample.velocity.abs());
    let [smallest, widest] = ends(samples.iter().map(|at| at.one.amplitude));
    // dF/d(size).
    let derivative = |kind: CauseKind, at: &At| {
        let (force, speed) = (at.prediction.force, at.sample.velocity / highest_speed);
        match kind {
            DifferentPlateaus => force.max(0.0),
            Amplitude => force * (at.one.amplitude - smallest) / (widest - smallest).max(f64::MIN_POSITIVE),
            Cycle => 0.5 * force * at.sample.time,
            Speed => force * speed.abs(),
            Lag => -at.force_step,
            // The displacement of the contact is less by half the play in the direction of the force.
            Play => {
                let [_, _, low, high] = at.prediction.nuisance_slopes;
                -0.5 * (low + high + at.prediction.stiffness * force.signum())
            }
            Viscous => slip_force * speed,
            ParallelSpring => slip_force * at.sample.displacement / widest,
        }
    };
    let remove = |vector: &mut DVector<f64>, basis: &DMatrix<f64>| *vector -= basis * basis.tr_mul(vector);
    let direction = |kind| {
        // The corrections of the reversals have residuals of their own, which no cause has.
        let mut direction = DVector::zeros(residuals.len());
        samples.iter().enumerate().for_each(|(row, at)| direction[row] = derivative(kind, at) / at.sigma);
        let whole = direction.clone();
        remove(&mut direction, &parameters);
        (direction.norm() > DISTINCT * whole.norm()).then_some((kind, direction, whole))
    };
    let mut directions: Vec<_> = kinds.iter().copied().filter_map(direction).collect();
    let (mut rest, mut found) = (residuals.clone(), Vec::new());
    remove(&mut rest, &parameters);
    let whole = rest.norm_squared();
    loop {
        let explained = |(kind, direction, raw): (CauseKind, DVector<f64>, DVector<f64>)| {
            let size = direction.dot(&rest) / direction.norm_squared();
            let share = size * size * direction.norm_squared() / whole;
            let is_possible = size > 0.0 || !matches!(kind, Play | Viscous);
            (is_possible && share > least_share)
                .then_some((Effect { cause: Cause { kind, size, share }, residuals: raw * size }, direction))
        };
        let effects = directions.iter().cloned().filter_map(explained);
        let largest = effects.max_by(|(one, _), (other, _)| one.cause.share.total_cmp(&other.cause.share));
        let Some((effect, direction)) = largest else { return found };
        rest -= &direction * effect.cause.size;
        directions.retain(|(kind, ..)| *kind != effect.cause.kind);
        let unit = DMatrix::from_columns(&[direction.normalize()]);
        directions.iter_mut().for_each(|(_, other, _)| remove(other, &unit));
        found.push(effect);
    }
}

/// The causes after a play, if its removal from the loops and another fit explain more than this share of the residuals: near a fit
/// that a large play has bent, the direction of another cause may explain more.
pub(crate) fn play(fit: &Fit, others: Free, least_share: f64) -> Result<Option<Vec<Cause>>, Error> {
    let largest = fit.loops().iter().max_by(|one, other| one.amplitude.total_cmp(&other.amplitude));
    let Some((size, forces)) = largest.and_then(Loop::play) else { return Ok(None) };
    let loops = fit.loops().iter().map(|one| one.without_play(size, forces));
    let loops: Vec<_> = loops.filter(|one| one.amplitude > 0.0 && one.samples.len() >= LEAST_SAMPLES).collect();
    if loops.is_empty() {
        return Ok(None);
    }
    let mean_square = |loops: &[Loop], fit: &Fit| {
        let of_loop = |(one, forces): (&Loop, Vec<[f64; 2]>)| {
            forces.into_iter().map(|[measured, law]| ((measured - law) / one.height()).powi(2)).collect::<Vec<_>>()
        };
        let squares: Vec<_> = loops.iter().zip(fit.forces()).flat_map(of_loop).collect();
        mean(squares.into_iter())
    };
    let mut rest = fit.of_loops(&loops, others)?;
    let share = 1.0 - mean_square(&loops, &rest) / mean_square(fit.loops(), fit);
    if share <= least_share {
        return Ok(None);
    }
    let kinds: Vec<_> = KINDS.into_iter().filter(|kind| *kind != Play).collect();
    rest.release(others);
    let rest = causes(&rest, &kinds, LEAST_SHARE / (1.0 - share).max(LEAST_SHARE));
    let rest = rest.iter().map(|effect| Cause { share: effect.cause.share * (1.0 - share), ..effect.cause });
    Ok(Some([Cause { kind: Play, size, share }].into_iter().chain(rest).collect()))
}

/// A cause in a sentence.
pub(crate) fn sentence(cause: &Cause) -> String {
    let percent = 100.0 * cause.size.abs();
    let changes = if cause.size > 0.0 { "grows" } else { "falls" };
    let what = match cause.kind {
        DifferentPlateaus => {
            let side = if cause.size > 0.0 { "positive" } else { "negative" };
            format!("different plateaus: the force is larger on the {side} side by {percent:.1} % (offset or wear)")
        }
        Amplitude => {
            format!("a force that {changes} by {percent:.1} % from the smallest to the largest amplitude")
        }
        Cycle => format!("a force that {changes} by {percent:.1} % from the first to the last cycle (wear)"),
        Speed => {
            format!("plateaus with a slope in speed: the force {changes} by {percent:.1} % up to the largest speed")
        }
        Lag => {
            let column = if cause.size > 0.0 { "force" } else { "displacement" };
            format!("a lag between the columns: the {column} is late by {:.1} samples", cause.size.abs())
        }
        Play => format!("play around zero force: {:.2e} of the displacement", cause.size),
        Viscous => format!("a viscous part: {percent:.1} % of mu N at the largest speed"),
        ParallelSpring => {
            let sign = if cause.size > 0.0 { "" } else { "-" };
            format!("plateaus with a slope in displacement: {sign}{percent:.1} % of mu N at the largest amplitude")
        }
    };
    format!("The residuals show {what}; this explains {:.0} % of their squares.", 100.0 * cause.share)
}
