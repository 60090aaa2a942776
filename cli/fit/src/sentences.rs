//! The verdict in sentences.

use crate::causes::sentence;
use crate::report::{CauseKind, Estimate, Explanation, Status, stiffening_load};
use crate::verdict::{Solution, is_hidden};

/// The verdict in sentences.
pub(crate) fn sentences(solution: &Solution, range: Option<[f64; 2]>, normal_force: f64) -> Vec<String> {
    let ([friction, series, contact, shape, share, spring], explanation) = (&solution.estimates, &solution.explanation);
    let interval = |&Estimate { lower, upper, .. }: &Estimate| match upper {
        Some(upper) => format!("{lower:.4} to {upper:.4}"),
        None => format!("at least {lower:.4}"),
    };
    let mut sentences = Vec::new();
    if !explanation.explained {
        let Explanation { name, misfit, relative_misfit, noise, .. } = explanation;
        let percent = 100.0 * relative_misfit;
        sentences.push(format!(
            "The law does not explain these loops: the misfit of {name} is {misfit:.3e} N, {percent:.2} % of mu N, and noise \
             explains {noise:.3e} N. No parameter is determined."
        ));
        if explanation.causes.is_empty() {
            sentences.push("The residuals show none of the causes that are looked for.".to_owned());
        }
    }
    sentences.extend(explanation.causes.iter().map(sentence));
    if explanation.explained && !explanation.causes.is_empty() {
        // Beside a plateau that is too short, the size of this cause is only an estimate.
        let is_spring = explanation.causes.iter().any(|cause| cause.kind == CauseKind::ParallelSpring);
        let include = if is_spring { "do not include" } else { "include" };
        sentences.push(format!("That is below twice the noise; the intervals {include} its effect."));
    }
    match friction.status {
        Status::Fixed => {}
        Status::LowerBound => {
            let bound = friction.lower;
            sentences.push(format!(
                "No loop has a plateau of gross slip: the friction coefficient has only a lower bound, {bound:.4}."
            ));
        }
        Status::Determined => {
            sentences.push(format!("The friction coefficient is determined: {}.", interval(friction)));
        }
        _ if explanation.explained => {
            sentences.push(format!("The friction coefficient is only bounded: {}.", interval(friction)));
        }
        _ => {}
    }
    if !explanation.explained {
        return sentences;
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
            _ => sentences.push(format!("The {name} is not determined.")),
        }
    }
    sentences.extend(of_stiffening(share, normal_force));
    sentences.extend(of_spring(spring, solution.fit.plateau_slope()));
    let hides = is_hidden(solution.fit.law_compliance()[0], total.value);
    if solution.is_spring_slider && !hides {
        sentences.push("No microslip is seen: a spring and a slider fit as well.".to_owned());
    }
    if let Some([low, high]) = range {
        sentences.push(match shape.status {
            Status::Determined => format!("The shape is determined: a/b is {}.", interval(shape)),
            Status::NotDetermined if hides => {
                format!(
                    "The series compliance hides the microslip: every shape, a/b from {low} to {high}, fits equally."
                )
            }
            Status::NotDetermined => format!("The shape is not determined: a/b from {low} to {high} fit equally."),
            _ => format!("The shape is only bounded: a/b is {}.", interval(shape)),
        });
    }
    sentences
}

/// Whether the stiffness in series grows with the load; none if there is one load only.
fn of_stiffening(share: &Estimate, normal_force: f64) -> Option<String> {
    let [low, high] = [share.upper.unwrap_or(1.0), share.lower].map(|share| stiffening_load(share, normal_force));
    Some(match (share.lower > 0.0, share.upper.is_none_or(|upper| upper < 1.0)) {
        _ if share.status == Status::Fixed => return None,
        (true, true) => {
            format!("The series stiffness grows in proportion to N + N_c, N_c = {low:.3e} to {high:.3e} N.")
        }
        (true, false) => format!("The series stiffness grows in proportion to N + N_c, N_c at most {high:.3e} N."),
        (false, true) => {
            format!(
                "A constant series stiffness explains all loads; if it is proportional to N + N_c, N_c exceeds {low:.3e} N."
            )
        }
        (false, false) => {
            "The loads do not show whether the series stiffness grows with the load: it is taken as constant."
                .to_owned()
        }
    })
}

/// Whether there is a spring in parallel; none if it is given.
fn of_spring(spring: &Estimate, plateau_slope: f64) -> Option<String> {
    let [low, high] =
        [spring.lower, spring.upper.unwrap_or(f64::NAN)].map(|stiffness| 100.0 * stiffness / plateau_slope);
    Some(match spring.upper {
        _ if spring.status == Status::Fixed => return None,
        None => "Without a longer plateau of gross slip a spring in parallel is not distinguished from the contact: no interval \
                 contains its effect."
            .to_owned(),
        _ if low > 0.0 => format!(
            "A spring in parallel is seen: its force is {low:.2} to {high:.2} % of mu N at the largest amplitude, beside friction."
        ),
        _ => format!("No spring in parallel is seen: its force is at most {high:.2} % of mu N at the largest amplitude."),
    })
}
