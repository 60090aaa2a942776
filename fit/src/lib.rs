//! Identification of the friction law from measured friction loops.
//!
//! [`fit`] takes loops of displacement and force and a contact, and returns friction coefficient, series compliance, contact
//! compliance and shape with intervals of confidence, and which of them the data determine.

mod error;
mod input;
mod report;

pub use error::Error;
pub use input::{Contact, DisplacementReference, Geometry, Material, Measurement, NormalForce, Options, ShapeParameter};
pub use report::{Estimate, FittedLoop, Misfit, ProfilePoint, Report, SpringSlider, Status};

use serde::Deserialize;

/// Fits the law to measured loops.
///
/// # Errors
/// A message if the data are not loops of friction, or do not suit the contact.
pub fn fit(_contact: &Contact, _loops: &[Measurement], _options: &Options) -> Result<Report, Error> {
    error::error("in preparation")
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
    let invalid = |reason: serde_json::Error| Error(reason.to_string());
    let Problem { contact, loops, options } = serde_json::from_str(problem).map_err(invalid)?;
    serde_json::to_string(&fit(&contact, &loops, &options)?).map_err(invalid)
}
