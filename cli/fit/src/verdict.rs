//! Intervals of confidence, and which parameters the data determine.
//!
//! The shape is varied over its whole range, with all other parameters fitted at each value: the profile. Its interval is where the
//! sum of squares exceeds the least one by no more than the quantile of chi squared. The intervals of the others follow from the
//! covariance, if the shape is determined, and otherwise enclose those at all admitted shapes.
//!
//! Three questions come first: whether the law explains the loops at all, whether they have a plateau of gross slip, and whether
//! they show more than a spring and a slider. The last two compare the best fit with the best one without a plateau, or without
//! microslip.

use crate::causes::{KINDS, LEAST_SHARE, causes, play};
use crate::error::Error;
use crate::input::Options;
use crate::least_squares::{Fit, Free};
use crate::misfit::{FACTOR, LoopMisfit};
use crate::model::{CONTACT, FRICTION, MOST_STIFFENING, PARALLEL, PARAMETERS, Prediction, SERIES, SHAPE, STIFFENING};
use crate::report::{CauseKind, Estimate, Explanation, ProfilePoint, Status};

/// 97.5 % quantile of the normal distribution; its square is the 95 % quantile of chi squared.
const QUANTILE: f64 = 1.96;
/// Number of shapes of the profile.
const SHAPES: usize = 10;
/// A parameter is determined if its interval is at most this wide: a/b by its whole interval, others by half of it as a fraction of
/// friction coefficient, total compliance (series compliance), factor of the contact, total compliance, and slope of a plateau that
/// rises by μN up to the amplitude (parallel stiffness).
const WIDEST_SHAPE: f64 = 0.3;
const WIDEST: [f64; COMBINATIONS] = [0.1, 0.1, 0.5, 0.1, 0.01];
/// The same for the half-width of the share of the series stiffness that grows with the load.
const WIDEST_STIFFENING: f64 = 0.1;

/// A best fit, and what it determines.
#[derive(Debug)]
pub(crate) struct Solution<'a> {
    pub fit: Fit<'a>,
    /// What was fitted.
    free: Free,
    /// Variance of the weighted residuals, with their correlation.
    unit: f64,
    pub estimates: [Estimate; PARAMETERS],
    /// Initial compliance of contact, rig and bodies.
    pub total_compliance: Estimate,
    pub profile: Vec<ProfilePoint>,
    pub explanation: Explanation,
    /// The best spring and slider, and whether it fits as well.
    pub slider: Fit<'a>,
    pub is_spring_slider: bool,
}

impl<'a> Solution<'a> {
    /// The fit in which friction coefficient, factor on the displacements and shape are neutral if the loops do not determine them,
    /// or have the nearest admitted value. Names of what is neutral.
    pub fn determined(&self, neutral: [f64; PARAMETERS]) -> Result<(Fit<'a>, Vec<&'static str>), Error> {
        let (mut fit, mut free, mut names) = (self.fit.clone(), self.free, Vec::new());
        for (i, name) in [(FRICTION, "friction_coefficient"), (CONTACT, "contact_compliance"), (SHAPE, "shape")] {
            let Estimate { lower, upper, status, .. } = self.estimates[i];
            let is_open = status == Status::NotDetermined || (i == FRICTION && status != Status::Determined);
            if !free[i] || !is_open {
                continue;
            }
            free[i] = false;
            names.push(name);
            let (value, target) = (fit.parameters[i], neutral[i].min(upper.unwrap_or(f64::INFINITY)).max(lower));
            // Microslip may contradict a coefficient of friction, which is only bounded from below.
            for part in if i == FRICTION { &TOWARDS_NEUTRAL[..] } else { &[1.0] } {
                let mut trial = fit.clone();
                trial.parameters[i] = value + part * (target - value);
                if free[SERIES] {
                    let rest = self.total_compliance.value - trial.parameters[CONTACT] * trial.law_compliance()[0];
                    trial.parameters[SERIES] = rest.max(1e-3 * self.total_compliance.value);
                }
                let trial = trial.minimized(free);
                if i != FRICTION || is_as_good_as(&trial, &self.fit, QUANTILE.powi(2) * self.unit) {
                    fit = trial;
                    break;
                }
            }
        }
        if !names.is_empty() {
            fit.settle(free);
        }
        Ok((fit, names))
    }
}

/// Parts of the way to a neutral value that are tried.
const TOWARDS_NEUTRAL: [f64; 6] = [1.0, 0.8, 0.6, 0.4, 0.2, 0.1];
/// Steps of the friction coefficient, as factors, towards fits without a plateau, and beyond.
const FRICTION_STEPS: [f64; 7] = [1.02, 1.05, 1.1, 1.2, 1.4, 2.0, 3.0];
/// A cause is significant if it explains the square of this times what a direction of no effect explains, one over the number of
/// independent residuals: by chance in one of 2000 fits, each of the eight causes in one of 16,000.
const SIGNIFICANT: f64 = 4.0;
/// Passes that remove what the causes explain from the forces, and fit the rest: their sizes are estimates at first.
const CORRECTIONS: usize = 3;
/// A cause that explains more than this share leaves nothing for a play.
const CLEAR: f64 = 0.9;
/// A plateau is seen if the displacement exceeds that of gross slip by this part. A shorter one is not distinguished from the bend
/// before it.
const SHORTEST_PLATEAU: f64 = 0.02;
/// A spring in parallel is looked for from this length on: in a shorter plateau it is not distinguished from microslip.
const LONG_PLATEAU: f64 = 0.2;
/// A contact that has less than this part of the total compliance, as it is given, is hidden by the rest.
const SMALL_PART: f64 = 0.1;
/// A plateau, and microslip, are claimed only beyond this multiple of the quantile: with a confidence of 0.9999.
const CLAIM: f64 = 2.0;

/// Whether a fit is as good as another one: it explains no less than by this part of the sum of squares, or by an error of the
/// model.
fn is_as_good_as(this: &Fit, other: &Fit, excess: f64) -> bool {
    let pairs = || misfits(this).into_iter().zip(misfits(other));
    this.chi_squared - other.chi_squared <= excess
        || pairs().all(|(this, other)| this.misfit.powi(2) <= other.misfit.powi(2) + other.of_model)
}

/// Loads that differ by less, as a factor, show nothing of a stiffness that grows with the load.
const DIFFERENT_LOADS: f64 = 1.2;

/// Fits all free parameters, from start values of the others than the shape. With several loads the stiffness in series may grow
/// with the load; it is constant if the data admit that.
pub(crate) fn solve<'a>(start: &Fit<'a>, options: &Options, range: Option<[f64; 2]>) -> Result<Solution<'a>, Error> {
    let constant = || solve_with(start, options, range, [false, true]);
    if options.series_compliance.is_some() || start.range_of_loads() < DIFFERENT_LOADS {
        return constant();
    }
    let mut growing = start.clone();
    growing.parameters[STIFFENING] = 0.5;
    let growing = solve_with(&growing, options, range, [true, true])?;
    let share = growing.estimates[STIFFENING];
    if share.lower > 0.0 {
        return Ok(growing);
    }
    let mut solution = constant()?;
    let status = if solution.explanation.explained { share.status } else { Status::NotDetermined };
    solution.estimates[STIFFENING] = Estimate { value: 0.0, status, ..share };
    Ok(solution)
}

/// Fits all free parameters, with or without the share of the stiffness that grows with the load and a spring in parallel. The
/// latter is the slope of plateaus: without gross slip it is not distinguished from the law.
fn solve_with<'a>(
    given: &Fit<'a>,
    options: &Options,
    range: Option<[f64; 2]>,
    [is_growing, with_spring]: [bool; 2],
) -> Result<Solution<'a>, Error> {
    let mut start = given.clone();
    let Options { friction_coefficient, series_compliance, contact_compliance, parallel_stiffness, .. } = options;
    let [friction, series, contact, spring] =
        [friction_coefficient, series_compliance, contact_compliance, parallel_stiffness].map(Option::is_none);
    let spring = spring && with_spring;
    let others: Free = [friction, series, contact, false, is_growing, spring];
    let all: Free = std::array::from_fn(|i| i == SHAPE || others[i]);
    start.settle(others);
    if spring && !slips(&start, LONG_PLATEAU) {
        return solve_with(given, options, range, [is_growing, false]);
    }
    let candidates = match range {
        None => vec![start.minimized(others)],
        Some(range) => along_shapes(&start, range, others, all)?,
    };
    let best = best_of(&candidates);
    let fit = candidates[best].clone();
    let chi_squared = fit.chi_squared;
    // As many independent residuals as correlation times; each parameter takes one.
    let residuals = fit.weighted_residuals();
    let independent = residuals.iter().map(Vec::len).sum::<usize>() as f64 / correlation(&residuals);
    let unit = chi_squared / (independent - fit.count() as f64).max(1.0);
    let points = candidates.iter().map(|candidate| {
        let excess = ((candidate.chi_squared - chi_squared).max(0.0) / unit).sqrt();
        let relative_rms = (candidate.chi_squared / chi_squared).sqrt();
        (ProfilePoint { shape: candidate.parameters[SHAPE], relative_rms, admitted: excess <= QUANTILE }, excess)
    });
    let (profile, excesses): (Vec<_>, Vec<_>) = points.unzip();

    let free = if range.is_some() { all } else { others };
    let excess = |candidate: &Fit| (candidate.chi_squared - chi_squared) / unit;
    let without_plateau = without_plateau(&fit, free, |candidate| excess(candidate).max(0.0).sqrt());
    let has_plateau = without_plateau.is_none();
    if spring && !has_plateau {
        return solve_with(given, options, range, [is_growing, false]);
    }
    let (explanation, corrected) = explain(&fit, [others, free], parallel_stiffness.is_none(), independent)?;

    let mut estimates = fit.parameters.map(fixed);
    let mut of_shapes = vec![(fit.clone(), others)];
    if let Some(range) = range {
        let mut refined = fit.clone();
        refined.free = all;
        let error = QUANTILE * (unit * refined.variances(&[unit_of(SHAPE)])[0]).sqrt();
        estimates[SHAPE] = shape_estimate(&profile, &excesses, best, error, range);
        widen_shape(&mut estimates[SHAPE], corrected.parameters[SHAPE], error, range);
        let Estimate { value, status, .. } = estimates[SHAPE];
        of_shapes = if status == Status::Determined && value > range[0] && value < range[1] {
            vec![(fit.clone(), all)]
        } else {
            let admitted = candidates.into_iter().zip(&profile).filter(|(_, point)| point.admitted);
            admitted.map(|(candidate, _)| (candidate, others)).collect()
        };
    }
    if let Some(candidate) = without_plateau {
        let [of_shape, free] = [others, free].map(|of| std::array::from_fn(|i| of[i] && i != FRICTION));
        let steps = FRICTION_STEPS.iter().filter(|_| others[FRICTION]).filter_map(|step| {
            let mut start = candidate.clone();
            start.parameters[FRICTION] = step * start.carried(0.0);
            let candidate = start.minimized(free);
            is_as_good_as(&candidate, &fit, QUANTILE.powi(2) * unit).then_some((candidate, of_shape))
        });
        of_shapes.extend(steps);
        of_shapes.push((candidate, others));
    }
    if corrected.parameters != fit.parameters {
        of_shapes.push((corrected, of_shapes[0].1));
    }
    let [values, lower, upper] = intervals(&fit, of_shapes, unit);
    let scales = [values[FRICTION], values[TOTAL], values[CONTACT], values[TOTAL], fit.plateau_slope()];
    let estimate = |i: usize| {
        let half_width = 0.5 * (upper[i] - lower[i]);
        let status = match i {
            _ if half_width <= WIDEST[i] * scales[i] => Status::Determined,
            SERIES if upper[i] < scales[i] => Status::Bounded,
            _ if lower[i] > 0.0 => Status::Bounded,
            _ => Status::NotDetermined,
        };
        let upper = Some(upper[i]).filter(|upper| upper.is_finite());
        Estimate { value: values[i], lower: lower[i].max(0.0), upper, status }
    };
    let places = [(FRICTION, FRICTION), (SERIES, SERIES), (CONTACT, CONTACT), (PARALLEL, SPRING)];
    places.into_iter().filter(|(i, _)| others[*i]).for_each(|(i, place)| estimates[i] = estimate(place));
    let is_fixed = !others[SERIES] && !others[CONTACT] && range.is_none();
    let mut total_compliance = if is_fixed { fixed(values[TOTAL]) } else { estimate(TOTAL) };
    let profile = if range.is_some() { profile } else { Vec::new() };
    if is_growing {
        estimates[STIFFENING] = stiffening(&fit, free, unit);
    }

    if !explanation.explained {
        let fitted = estimates.iter_mut().chain([&mut total_compliance]).filter(|one| one.status != Status::Fixed);
        fitted.for_each(|estimate| estimate.status = Status::NotDetermined);
    }
    if !has_plateau && others[FRICTION] {
        // A quarter of the residuals is near the largest force.
        let lower = fit.carried(2.0 * QUANTILE * explanation.misfit / independent.sqrt());
        estimates[FRICTION] = Estimate { lower, upper: None, status: Status::LowerBound, ..estimates[FRICTION] };
    }
    if parallel_stiffness.is_none() && !spring {
        estimates[PARALLEL] = Estimate { upper: None, status: Status::NotDetermined, ..fixed(0.0) };
    }
    let slider = spring_slider(&fit, others);
    // What the law explains beyond the slider is below the error of the model, or may be chance.
    let is_spring_slider = is_as_good_as(&slider, &fit, (CLAIM * QUANTILE).powi(2) * unit);
    let [law, _] = fit.law_compliance();
    let total = total_compliance.value;
    if is_spring_slider && !is_hidden(law, total) {
        // The sum of both is seen, but not its parts.
        for (i, upper) in [(SERIES, total), (CONTACT, total / law)].into_iter().filter(|(i, _)| others[*i]) {
            let estimate = estimates[i];
            let upper = estimate.upper.map(|most| most.max(upper));
            estimates[i] = Estimate { lower: 0.0, upper, status: Status::NotDetermined, ..estimate };
        }
    }
    if let Some([low, high]) = range.filter(|_| is_spring_slider) {
        let value = estimates[SHAPE].value;
        estimates[SHAPE] = Estimate { value, lower: low, upper: Some(high), status: Status::NotDetermined };
    }
    Ok(Solution { fit, free, unit, estimates, total_compliance, profile, explanation, slider, is_spring_slider })
}

/// Whether the law explains the loops, with the causes of what it does not, and the fit without the effect of small ones.
fn explain<'a>(
    fit: &Fit<'a>,
    [others, free]: [Free; 2],
    with_spring: bool,
    independent: f64,
) -> Result<(Explanation, Fit<'a>), Error> {
    let mut explanation = explanation(fit);
    // Residuals below the noise that digitiser and model explain are no evidence.
    let evidence = (explanation.noise / explanation.misfit).powi(2).max(1.0);
    let significant = SIGNIFICANT.powi(2) / independent * evidence;
    let least_share = if explanation.explained { significant } else { LEAST_SHARE };
    let found = |fit: &Fit, kinds: &[CauseKind], least_share: f64| {
        let mut released = fit.clone();
        released.release(free);
        causes(&released, kinds, least_share)
    };
    let (mut effects, mut corrected) = (found(fit, &KINDS, least_share), fit.clone());
    explanation.causes = effects.iter().map(|effect| effect.cause).collect();
    if !explanation.explained {
        let share = explanation.causes.first().map_or(0.0, |first| first.share);
        let free = std::array::from_fn(|i| if i == PARALLEL { with_spring } else { others[i] });
        let found = if share < CLEAR { play(fit, free, share)? } else { None };
        explanation.causes = found.unwrap_or(explanation.causes);
    }
    if explanation.explained && !effects.is_empty() {
        let kinds: Vec<_> = effects.iter().map(|effect| effect.cause.kind).collect();
        let weakest = effects.iter().map(|effect| effect.cause.share).fold(1.0, f64::min);
        for _ in 0..CORRECTIONS {
            effects.iter().for_each(|effect| corrected.remove(&effect.residuals));
            corrected.minimize(free);
            effects = found(&corrected, &kinds, 0.0);
        }
        corrected.extrapolate(&fit.parameters, QUANTILE / (weakest * independent).sqrt())?;
    }
    Ok((explanation, corrected))
}

/// Whether the contact, as it is given, has a small part of the total compliance.
pub(crate) fn is_hidden(law: f64, total: f64) -> bool {
    law < SMALL_PART * total
}

/// Whether a loop exceeds the displacement of gross slip by this part.
fn slips(fit: &Fit, part: f64) -> bool {
    fit.slip_ratios().iter().any(|ratio| *ratio > 1.0 + part)
}

/// The share of the stiffness that grows with the load: by the covariance, and 0 or the largest one as far as they are admitted.
fn stiffening(best: &Fit, free: Free, unit: f64) -> Estimate {
    let value = best.parameters[STIFFENING];
    let mut released = best.clone();
    released.release(free);
    // At 0 the error is that of the other side.
    released.free[STIFFENING] = true;
    let error = QUANTILE * (unit * released.variances(&[unit_of(STIFFENING)])[0]).sqrt();
    let others = std::array::from_fn(|i| free[i] && i != STIFFENING);
    let is_admitted = |share: f64| {
        let mut fit = best.clone();
        fit.parameters[STIFFENING] = share;
        let excess = fit.minimized(others).chi_squared - best.chi_squared;
        excess <= QUANTILE.powi(2) * unit
    };
    let least = value * 1e-3;
    let lower = if is_admitted(0.0) { 0.0 } else { (value - error).max(least) };
    let upper = if is_admitted(MOST_STIFFENING) { 1.0 } else { (value + error).min(MOST_STIFFENING) };
    let status = match 0.5 * (upper - lower) {
        half_width if half_width <= WIDEST_STIFFENING => Status::Determined,
        _ if lower > 0.0 || upper < 1.0 => Status::Bounded,
        _ => Status::NotDetermined,
    };
    Estimate { value, lower, upper: Some(upper), status }
}

/// The combination that is one parameter.
fn unit_of(parameter: usize) -> [f64; PARAMETERS] {
    std::array::from_fn(|i| if i == parameter { 1.0 } else { 0.0 })
}

/// The misfit of each loop.
fn misfits<'a>(fit: &'a Fit<'_>) -> Vec<LoopMisfit<'a>> {
    let stiffnesses = |of: &[(Prediction, f64)]| of.iter().map(|(at, _)| at.stiffness).collect::<Vec<_>>();
    let loops = fit.predictions().zip(fit.forces());
    loops.map(|((one, at), forces)| LoopMisfit::new(one, &forces, &stiffnesses(&at))).collect()
}

/// Compares the misfit of each loop with its noise.
fn explanation(fit: &Fit) -> Explanation {
    let worst = misfits(fit).into_iter().max_by(|one, other| one.ratio().total_cmp(&other.ratio()));
    let found = worst.expect("there are loops");
    Explanation {
        explained: found.ratio() <= FACTOR,
        name: found.one.name.clone(),
        misfit: found.misfit,
        relative_misfit: found.misfit / (fit.parameters[FRICTION] * found.one.normal_force),
        noise: found.noise,
        causes: Vec::new(),
    }
}

/// A fit without gross slip that the data admit: the best one, or one of larger friction coefficient. `None` if no
/// such fit is admitted: the loops have a plateau.
fn without_plateau<'a>(best: &Fit<'a>, free: Free, excess: impl Fn(&Fit) -> f64) -> Option<Fit<'a>> {
    let mut candidate = best.clone();
    let others = std::array::from_fn(|i| free[i] && i != FRICTION);
    let mut steps = FRICTION_STEPS.into_iter();
    while slips(&candidate, SHORTEST_PLATEAU) && excess(&candidate) <= CLAIM * QUANTILE {
        if !free[FRICTION] {
            return None;
        }
        candidate.parameters[FRICTION] = best.parameters[FRICTION] * steps.next()?;
        candidate.minimize(others);
    }
    (excess(&candidate) <= CLAIM * QUANTILE).then_some(candidate)
}

/// The best spring and slider.
fn spring_slider<'a>(best: &Fit<'a>, others: Free) -> Fit<'a> {
    let [_, series, contact, ..] = best.parameters;
    let mut fit = best.clone();
    fit.parameters[SERIES] = series + contact * best.law_compliance()[0];
    (fit.parameters[CONTACT], fit.parameters[STIFFENING]) = (0.0, 0.0);
    fit.minimized([others[FRICTION], true, false, false, false, others[PARALLEL]])
}

/// Fits at shapes over the whole range, each from the one beside it, and at the best shape, in the order of the shapes.
fn along_shapes<'a>(start: &Fit<'a>, [low, high]: [f64; 2], others: Free, all: Free) -> Result<Vec<Fit<'a>>, Error> {
    let shape = |k: usize| low + (high - low) * k as f64 / (SHAPES - 1) as f64;
    let first = (0..SHAPES).find(|k| shape(*k) >= start.parameters[SHAPE]).unwrap_or(SHAPES - 1);
    let mut candidates = Vec::new();
    let (upwards, downwards) = ((first..SHAPES).collect::<Vec<_>>(), (0..first).rev().collect());
    for shapes in [upwards, downwards] {
        let mut from = start.clone();
        for k in shapes {
            from.parameters[SHAPE] = shape(k);
            from.minimize(others);
            candidates.push(from.clone());
        }
    }
    let best = &candidates[best_of(&candidates)];
    let refined = best.clone().minimized(all);
    if refined.chi_squared < best.chi_squared {
        candidates.push(refined);
    }
    candidates.sort_by(|one, other| one.parameters[SHAPE].total_cmp(&other.parameters[SHAPE]));
    Ok(candidates)
}

fn best_of(candidates: &[Fit]) -> usize {
    let better = |i: &usize, j: &usize| candidates[*i].chi_squared.total_cmp(&candidates[*j].chi_squared);
    (0..candidates.len()).min_by(better).unwrap_or(0)
}

/// The interval of the shape: from the best one, with its error by the covariance, to where the root of the excess of the sum of
/// squares is the quantile. That root is nearly linear; next to the best shape the covariance is more accurate.
fn shape_estimate(
    profile: &[ProfilePoint],
    excesses: &[f64],
    best: usize,
    error: f64,
    [low, high]: [f64; 2],
) -> Estimate {
    let value = profile[best].shape;
    let end = |points: &mut dyn Iterator<Item = usize>, limit: f64| {
        let mut last = best;
        for k in points {
            let step = profile[k].shape - profile[last].shape;
            if profile[k].admitted {
                last = k;
            } else if last == best {
                return value + step.signum() * error.min(step.abs());
            } else {
                return profile[last].shape + step * (QUANTILE - excesses[last]) / (excesses[k] - excesses[last]);
            }
        }
        limit
    };
    let (lower, upper) = (end(&mut (0..best).rev(), low), end(&mut (best + 1..profile.len()), high));
    let status = if upper - lower <= WIDEST_SHAPE {
        Status::Determined
    } else if profile.iter().all(|point| point.admitted) {
        Status::NotDetermined
    } else {
        Status::Bounded
    };
    Estimate { value, lower, upper: Some(upper), status }
}

/// Includes the shape without the effect of the causes, and its error.
fn widen_shape(shape: &mut Estimate, corrected: f64, error: f64, [low, high]: [f64; 2]) {
    if corrected == shape.value {
        return;
    }
    let upper = shape.upper.unwrap_or(high).max(corrected + error).min(high);
    shape.lower = shape.lower.min(corrected - error).max(low);
    shape.upper = Some(upper);
    if shape.status == Status::Determined && upper - shape.lower > WIDEST_SHAPE {
        shape.status = Status::Bounded;
    }
}

/// Places of the total compliance C + f/k and of the parallel stiffness beside the three parameters.
const TOTAL: usize = 3;
const SPRING: usize = 4;
const COMBINATIONS: usize = 5;

/// Values of the best fit, and intervals that enclose those of fits at several shapes.
fn intervals(best: &Fit, of_shapes: Vec<(Fit, Free)>, unit: f64) -> [[f64; COMBINATIONS]; 3] {
    let values = |fit: &Fit| {
        let ([friction, series, contact, ..], [law, slope]) = (fit.parameters, fit.law_compliance());
        let total = [0.0, 1.0, law, contact * slope, 0.0, 0.0];
        let combinations = [unit_of(FRICTION), unit_of(SERIES), unit_of(CONTACT), total, unit_of(PARALLEL)];
        ([friction, series, contact, series + contact * law, fit.parameters[PARALLEL]], combinations)
    };
    let best = values(best).0;
    let (mut lower, mut upper) = (best, best);
    for (mut fit, free) in of_shapes {
        fit.free = free;
        let (values, combinations) = values(&fit);
        for (i, variance) in fit.variances(&combinations).into_iter().enumerate() {
            let error = QUANTILE * (unit * variance).sqrt();
            (lower[i], upper[i]) = (lower[i].min(values[i] - error), upper[i].max(values[i] + error));
        }
    }
    [best, lower, upper]
}

/// A value that is not fitted.
pub(crate) fn fixed(value: f64) -> Estimate {
    Estimate { value, lower: value, upper: Some(value), status: Status::Fixed }
}

/// Factor by which correlated residuals enlarge variances: the sum of their autocorrelation up to its first zero; beyond it, the
/// fit makes residuals of a cycle anticorrelated. The residuals of a wrong model are correlated over long parts of a cycle.
fn correlation(residuals: &[Vec<f64>]) -> f64 {
    let sum = |lag: usize| -> f64 {
        let of_loop =
            |one: &Vec<f64>| one.iter().zip(one.iter().skip(lag)).map(|(one, other)| one * other).sum::<f64>();
        residuals.iter().map(of_loop).sum()
    };
    let (variance, longest) = (sum(0).max(f64::MIN_POSITIVE), residuals.iter().map(Vec::len).max().unwrap_or(0));
    1.0 + 2.0 * (1..longest).map(|lag| sum(lag) / variance).take_while(|part| *part > 0.0).sum::<f64>()
}
