//! Intervals of confidence, and which parameters the data determine.
//!
//! The shape is varied over its whole range, with all other parameters fitted at each value: the profile. Its interval is where the
//! sum of squares exceeds the least one by no more than the quantile of chi squared. The intervals of the others follow from the
//! covariance, if the shape is determined, and otherwise enclose those at all admitted shapes.

use crate::error::Error;
use crate::input::Options;
use crate::least_squares::{Fit, Free};
use crate::model::{CONTACT, FRICTION, PARAMETERS, SERIES, SHAPE};
use crate::report::{Estimate, ProfilePoint, Status};

/// 97.5 % quantile of the normal distribution; its square is the 95 % quantile of chi squared.
const QUANTILE: f64 = 1.96;
/// Number of shapes of the profile.
const SHAPES: usize = 10;
/// Widest interval of a/b, and half-widths of the others as fractions, of a parameter that is determined.
const WIDEST_SHAPE: f64 = 0.3;
const WIDEST: [f64; 3] = [0.1, 0.1, 0.5];

/// A best fit, and what it determines.
#[derive(Debug)]
pub(crate) struct Solution<'a> {
    pub fit: Fit<'a>,
    pub estimates: [Estimate; PARAMETERS],
    /// Initial compliance of contact, rig and bodies.
    pub total_compliance: Estimate,
    pub profile: Vec<ProfilePoint>,
    pub slips: bool,
}

/// A fit at one shape.
#[derive(Clone)]
struct Candidate<'a> {
    fit: Fit<'a>,
    chi_squared: f64,
}

impl<'a> Candidate<'a> {
    fn new(mut fit: Fit<'a>, free: Free) -> Candidate<'a> {
        fit.minimize(free);
        let chi_squared = fit.chi_squared();
        Candidate { fit, chi_squared }
    }
}

/// Fits all free parameters, from start values of the others than the shape.
pub(crate) fn solve<'a>(mut start: Fit<'a>, options: &Options, range: Option<[f64; 2]>) -> Result<Solution<'a>, Error> {
    let given = [options.friction_coefficient, options.series_compliance, options.contact_compliance];
    let others: Free = std::array::from_fn(|i| i != SHAPE && given[i].is_none());
    let all: Free = std::array::from_fn(|i| i == SHAPE || others[i]);
    start.settle(others);
    let mut candidates = Vec::new();
    match range {
        None => candidates.push(Candidate::new(start, others)),
        Some([low, high]) => {
            let shape = |k: usize| low + (high - low) * k as f64 / (SHAPES - 1) as f64;
            let nearest = (0..SHAPES).min_by(|i, j| {
                let distance = |k: usize| (shape(k) - start.parameters[SHAPE]).abs();
                distance(*i).total_cmp(&distance(*j))
            });
            let nearest = nearest.unwrap_or_default();
            let mut from = start.clone();
            let mut along = |shapes: &mut dyn Iterator<Item = usize>, from: &mut Fit<'a>| {
                for k in shapes {
                    from.set_shape(shape(k))?;
                    let found = Candidate::new(from.clone(), others);
                    *from = found.fit.clone();
                    candidates.push(found);
                }
                Ok::<(), Error>(())
            };
            along(&mut (nearest..SHAPES), &mut from)?;
            from = start;
            along(&mut (0..nearest).rev(), &mut from)?;
        }
    }
    candidates.sort_by(|one, other| one.fit.parameters[SHAPE].total_cmp(&other.fit.parameters[SHAPE]));
    let best_of = |candidates: &[Candidate]| {
        (0..candidates.len())
            .min_by(|i, j| candidates[*i].chi_squared.total_cmp(&candidates[*j].chi_squared))
            .unwrap_or(0)
    };
    let mut best = best_of(&candidates);
    if range.is_some() {
        let refined = Candidate::new(candidates[best].fit.clone(), all);
        if refined.chi_squared < candidates[best].chi_squared {
            candidates.push(refined);
            candidates.sort_by(|one, other| one.fit.parameters[SHAPE].total_cmp(&other.fit.parameters[SHAPE]));
            best = best_of(&candidates);
        }
    }

    // Variance of the residuals, and how much their correlation enlarges that of the parameters.
    let fit = candidates[best].fit.clone();
    let residuals = fit.weighted_residuals();
    // As many independent residuals as correlation times; each parameter takes one.
    let correlation = correlation(&residuals);
    let independent = residuals.iter().map(Vec::len).sum::<usize>() as f64 / correlation;
    let unit = candidates[best].chi_squared / (independent - fit.count() as f64).max(1.0);
    let excess = |candidate: &Candidate| (candidate.chi_squared - candidates[best].chi_squared).max(0.0) / unit;
    let admitted: Vec<_> = candidates.iter().map(|candidate| excess(candidate) <= QUANTILE.powi(2)).collect();
    let profile = candidates.iter().zip(&admitted).map(|(candidate, &admitted)| ProfilePoint {
        shape: candidate.fit.parameters[SHAPE],
        relative_rms: (candidate.chi_squared / candidates[best].chi_squared).sqrt(),
        admitted,
    });
    let profile = if range.is_some() { profile.collect() } else { Vec::new() };

    let slips = fit.slip_ratios().iter().any(|ratio| *ratio > 1.0);
    let mut estimates = fit.parameters.map(fixed);
    let mut at_shapes = vec![(fit.clone(), others)];
    if let Some([low, high]) = range {
        let shapes: Vec<_> = candidates.iter().map(|one| (one.fit.parameters[SHAPE], excess(one).sqrt())).collect();
        let mut refined = fit.clone();
        refined.free = all;
        let error = QUANTILE * (unit * refined.variances(&[[0.0, 0.0, 0.0, 1.0]])[0]).sqrt();
        let value = fit.parameters[SHAPE];
        let end = |range: &mut dyn Iterator<Item = usize>, limit: f64, sign: f64| {
            let mut last = shapes[best];
            for k in range {
                if !admitted[k] {
                    // The root of the excess is nearly linear; next to the minimum the covariance is more accurate.
                    let part = (QUANTILE - last.1) / (shapes[k].1 - last.1);
                    let crossing = last.0 + part * (shapes[k].0 - last.0);
                    return if last.0 == value {
                        value + sign * error.min((shapes[k].0 - value).abs())
                    } else {
                        crossing
                    };
                }
                last = shapes[k];
            }
            limit
        };
        let (lower, upper) = (end(&mut (0..best).rev(), low, -1.0), end(&mut (best + 1..shapes.len()), high, 1.0));
        let status = if upper - lower <= WIDEST_SHAPE {
            Status::Determined
        } else if admitted.iter().all(|admitted| *admitted) {
            Status::NotDetermined
        } else {
            Status::Bounded
        };
        estimates[SHAPE] = Estimate { value, lower, upper: Some(upper), status };
        if status == Status::Determined && value > low && value < high {
            at_shapes = vec![(fit.clone(), all)];
        } else {
            let admitted = candidates.iter().zip(&admitted).filter(|(_, admitted)| **admitted);
            at_shapes = admitted.map(|(candidate, _)| (candidate.fit.clone(), others)).collect();
        }
    }
    // The three parameters, and the total compliance C + κ/k.
    let values = |fit: &Fit| {
        let ([friction, series, contact, _], [law, slope]) = (fit.parameters, fit.law_compliance());
        let combinations =
            [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 1.0, law, contact * slope]];
        ([friction, series, contact, series + contact * law], combinations)
    };
    let best_values = values(&fit).0;
    let (mut lower, mut upper) = (best_values, best_values);
    for (fit, free) in &mut at_shapes {
        fit.free = *free;
        let (values, combinations) = values(fit);
        for (i, variance) in fit.variances(&combinations).into_iter().enumerate() {
            let error = QUANTILE * (unit * variance).sqrt();
            (lower[i], upper[i]) = (lower[i].min(values[i] - error), upper[i].max(values[i] + error));
        }
    }
    let estimate = |i: usize, scale: f64, widest: f64| {
        let half_width = 0.5 * (upper[i] - lower[i]);
        let status = match i {
            FRICTION if !slips => Status::Bounded,
            _ if half_width <= widest * scale => Status::Determined,
            SERIES if upper[i] < scale => Status::Bounded,
            _ if lower[i] > 0.0 => Status::Bounded,
            _ => Status::NotDetermined,
        };
        Estimate { value: best_values[i], lower: lower[i].max(0.0), upper: Some(upper[i]), status }
    };
    let scales = [best_values[FRICTION], best_values[SHAPE], best_values[CONTACT]];
    for i in (0..SHAPE).filter(|i| given[*i].is_none()) {
        estimates[i] = estimate(i, scales[i], WIDEST[i]);
    }
    let total_compliance = match given {
        [_, Some(_), Some(_)] if range.is_none() => fixed(best_values[SHAPE]),
        _ => estimate(SHAPE, best_values[SHAPE], WIDEST[SERIES]),
    };
    Ok(Solution { fit, estimates, total_compliance, profile, slips })
}

fn fixed(value: f64) -> Estimate {
    Estimate { value, lower: value, upper: Some(value), status: Status::Fixed }
}

/// Factor by which correlated residuals enlarge variances: the sum of their autocorrelation up to its first zero; beyond it, the fit
/// makes residuals of a cycle anticorrelated. The residuals of a wrong model are correlated over long parts of a cycle.
fn correlation(residuals: &[Vec<f64>]) -> f64 {
    let sum = |lag: usize| -> f64 {
        let of_loop =
            |one: &Vec<f64>| one.iter().zip(one.iter().skip(lag)).map(|(one, other)| one * other).sum::<f64>();
        residuals.iter().map(of_loop).sum()
    };
    let (variance, longest) = (sum(0).max(f64::MIN_POSITIVE), residuals.iter().map(Vec::len).max().unwrap_or(0));
    1.0 + 2.0 * (1..longest).map(|lag| sum(lag) / variance).take_while(|part| *part > 0.0).sum::<f64>()
}

/// The verdict in sentences.
pub(crate) fn sentences(solution: &Solution, friction: &Estimate, range: Option<[f64; 2]>) -> Vec<String> {
    let [_, series, contact, shape] = &solution.estimates;
    let interval =
        |estimate: &Estimate| format!("{:.4} to {:.4}", estimate.lower, estimate.upper.unwrap_or(f64::INFINITY));
    let mut sentences = Vec::new();
    if friction.status != Status::Fixed {
        sentences.push(match friction.status {
            _ if !solution.slips => {
                let bound = friction.lower;
                format!("No loop reaches gross slip: the friction coefficient has only a lower bound, {bound:.4}.")
            }
            Status::Determined => format!("The friction coefficient is determined: {}.", interval(friction)),
            _ => format!("The friction coefficient is only bounded: {}.", interval(friction)),
        });
    }
    let total = &solution.total_compliance;
    let part = (1.0 - series.value / total.value).max(0.0);
    let percent = 100.0 * part;
    sentences.push(match total.status {
        Status::Determined | Status::Fixed => {
            let stiffness = 1.0 / total.value;
            format!("The initial stiffness of contact, rig and bodies together is determined: {stiffness:.4e}.")
        }
        _ => "The initial stiffness of contact, rig and bodies together is not determined.".to_owned(),
    });
    sentences.push(format!("In the best fit the contact has {percent:.1} % of the compliance."));
    for (name, estimate) in [("series compliance", series), ("compliance of the contact", contact)] {
        match estimate.status {
            Status::Fixed => {}
            Status::Determined => sentences.push(format!("The {name} is determined.")),
            Status::Bounded => sentences.push(format!("The {name} is known only roughly.")),
            Status::NotDetermined => sentences.push(format!("The {name} is not determined.")),
        }
    }
    if let Some([low, high]) = range {
        sentences.push(match shape.status {
            Status::Determined => format!("The shape is determined: a/b is {}.", interval(shape)),
            Status::NotDetermined if contact.status == Status::NotDetermined || part < 0.1 => format!(
                "The series compliance hides the microslip: every shape, a/b from {low} to {high}, fits equally."
            ),
            Status::NotDetermined => format!("The shape is not determined: a/b from {low} to {high} fit equally."),
            _ => format!("The shape is only bounded: a/b is {}.", interval(shape)),
        });
    }
    sentences
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Noise of which neighbours have the correlation ρ: the sum of ρ^|lag| over all lags is (1 + ρ)/(1 - ρ). The estimate from 1e5
    /// samples has a standard error of some percent.
    #[test]
    fn correlation_is_that_of_an_autoregressive_process() {
        let mut state = 1_u64;
        let mut uniform = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        for rho in [0.0, 0.5, 0.9] {
            let mut last = 0.0;
            let mut next = || {
                last = rho * last + uniform();
                last
            };
            let residuals: [Vec<f64>; 2] = std::array::from_fn(|_| (0..50_000).map(|_| next()).collect());
            let expected = (1.0 + rho) / (1.0 - rho);
            assert!((correlation(&residuals) / expected - 1.0).abs() < 0.1, "{rho}: {}", correlation(&residuals));
        }
    }
}
