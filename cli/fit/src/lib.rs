//! Identification of the friction law from measured friction loops.
//!
//! [`fit`] takes loops of displacement and force and a contact, and returns friction coefficient, series compliance, contact
//! compliance and shape with intervals of confidence, whether the law explains the loops, and which parameters they determine.

mod causes;
mod cycles;
mod data;
mod error;
mod input;
mod least_squares;
mod misfit;
mod model;
mod plausibility;
mod report;
mod sentences;
mod verdict;

pub use error::Error;
pub use input::{
    Contact, ContactParameters, DisplacementReference, Geometry, Measurement, NormalForce, Options, ShapeParameter,
    missing_parameters,
};
pub use microslip::Material;
pub use report::{
    Cause, CauseKind, Estimate, Explanation, FittedLoop, Misfit, ProfilePoint, Report, SpringSlider, Status,
};

use data::Record;
use error::error;
use least_squares::{Fit, start_values};
use model::{Family, MOST_STIFFENING};
use serde::Deserialize;

/// Fits the law to measured loops.
///
/// # Errors
/// A message if the data are not loops of friction, or do not suit the contact.
pub fn fit(contact: &Contact, measurements: &[Measurement], options: &Options) -> Result<Report, Error> {
    if measurements.is_empty() {
        return error("no measured loops");
    }
    options.check()?;
    let family = Family::new(contact, options.shape)?;
    let (mut loops, mut warnings) = (Vec::new(), Vec::new());
    for (index, measurement) in measurements.iter().enumerate() {
        let record = Record::new(measurement, index, contact.normal_force)?;
        loops.extend(cycles::loops(&record)?);
        warnings.extend(record.warnings);
    }
    loops.iter().try_for_each(|one| one.check_direction(&loops))?;
    let shape = family.shape()?;
    let range = shape.filter(|_| options.shape != ShapeParameter::Fixed).map(|_| family.shape_range());

    let compliances = loops.iter().map(|one| family.compliance(shape.unwrap_or(0.0), one.normal_force));
    let compliances = compliances.collect::<Result<Vec<_>, _>>()?;
    let given = [options.friction_coefficient, options.series_compliance, options.contact_compliance];
    let [friction, series, contact_factor] = start_values(&loops, &compliances, given);
    let compliance = series + contact_factor * data::mean(compliances.iter().copied());
    warnings.extend(plausibility::check(&loops, &compliances, friction, compliance)?);

    let limit = [1e-3 * friction, 1e3 * friction];
    let spring = options.parallel_stiffness.unwrap_or(0.0);
    let positive = [0.0, f64::MAX];
    let limits =
        [limit, [1e-6 * compliance, f64::MAX], positive, range.unwrap_or_default(), [0.0, MOST_STIFFENING], positive];
    let in_range = |shape: f64| range.map_or(shape, |[low, high]| shape.clamp(low, high));
    let start = [friction, series, contact_factor, shape.map_or(0.0, in_range), 0.0, spring];
    let start = Fit::new(&family, &loops, start, limits)?;
    let solution = verdict::solve(&start, options, range)?;

    let ([friction_coefficient, compliance, ..], slider_forces) =
        (solution.slider.parameters, solution.slider.forces());
    let spring_slider =
        SpringSlider { friction_coefficient, stiffness: 1.0 / compliance, misfit: Misfit::new(&loops, &slider_forces) };

    let forces = solution.fit.forces();
    let [friction, series, contact_compliance, shape_estimate, series_stiffening, parallel_stiffness] =
        solution.estimates;
    let neutral = [contact.friction_coefficient, 0.0, 1.0, shape.map_or(0.0, in_range), 0.0, 0.0];
    let (determined, neutral) = solution.determined(neutral)?;
    let fitted_shape = determined.parameters[model::SHAPE];
    let geometry = if range.is_some() { family.geometry(fitted_shape) } else { contact.geometry };
    let shape = shape.map(|given| if range.is_some() { shape_estimate } else { verdict::fixed(given) });
    let fitted = |(one, (law, slider)): (&cycles::Loop, (&Vec<_>, &Vec<_>))| FittedLoop::new(one, law, slider);
    Ok(Report {
        friction_coefficient: friction,
        series_compliance: series,
        series_stiffening,
        contact_compliance,
        parallel_stiffness,
        total_compliance: solution.total_compliance,
        shape,
        explanation: solution.explanation.clone(),
        law: Misfit::new(&loops, &forces),
        spring_slider,
        verdict: sentences::sentences(&solution, range, contact.normal_force),
        profile: solution.profile,
        warnings,
        contact_toml: report::contact_toml(contact, &geometry, &determined.parameters, &neutral),
        loops: loops.iter().zip(forces.iter().zip(&slider_forces)).map(fitted).collect(),
    })
}

/// Input of [`fit_json`].
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Problem {
    contact: Contact,
    loops: Vec<Measurement>,
    #[serde(default)]
    options: Options,
}

/// [`fit`] of an object `{"contact": ..., "loops": [...], "options": {...}}`; returns the [`Report`], both as JSON.
///
/// # Errors
/// As [`fit`], and a message if the text is not such an object.
pub fn fit_json(problem: &str) -> Result<String, Error> {
    // The place in the text, which no user has seen, is left out.
    let invalid =
        |reason: serde_json::Error| Error(reason.to_string().split(" at line ").next().unwrap_or("").to_owned());
    let Problem { contact, loops, options } = serde_json::from_str(problem).map_err(invalid)?;
    serde_json::to_string(&fit(&contact, &loops, &options)?).map_err(invalid)
}
