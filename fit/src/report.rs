//! The result of a fit.

use serde::{Deserialize, Serialize};

/// Result of a fit. All numbers are in the units of the input.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Friction coefficient \[-\].
    pub friction_coefficient: Estimate,
    /// Compliance of rig and bodies in series with the contact \[m/N\].
    pub series_compliance: Estimate,
    /// Factor on the displacements of the law \[-\].
    pub contact_compliance: Estimate,
    /// Half-width of the flat over that of the contact under the normal force of the contact \[-\]; none of an ellipse.
    pub shape: Option<Estimate>,
    /// Misfit of the law.
    pub law: Misfit,
    /// The best spring-slider, and its misfit.
    pub spring_slider: SpringSlider,
    /// Misfit of the law over the whole range of the shape.
    pub profile: Vec<ProfilePoint>,
    /// Which parameters the data determine and which not, in sentences.
    pub verdict: Vec<String>,
    /// Remarks about the data.
    pub warnings: Vec<String>,
    /// The fitted contact as a parameter file.
    pub contact_toml: String,
    /// Measured and fitted loops, without offset and drift.
    pub loops: Vec<FittedLoop>,
}

/// A parameter and its interval of 95 % confidence.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Best value.
    pub value: f64,
    /// Lower end of the interval.
    pub lower: f64,
    /// Upper end of the interval; `None` if there is none.
    pub upper: Option<f64>,
    /// Whether the data determine it.
    pub status: Status,
}

/// Whether the data determine a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// Fixed by an option, or of a shape without that parameter.
    Fixed,
    /// The interval is narrow.
    Determined,
    /// Only one end of the interval is narrow, or it excludes a part of the range.
    Bounded,
    /// The interval contains all values that make sense.
    NotDetermined,
}

/// Difference between measurement and model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Misfit {
    /// Root mean square of the force \[N\].
    pub force_rms: f64,
    /// Largest difference of the force \[N\].
    pub force_max: f64,
    /// Root mean square over the loops of the relative error of the energy per cycle \[-\].
    pub energy: f64,
}

/// A spring in series with a slider, fitted to the same loops.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SpringSlider {
    /// Friction coefficient \[-\].
    pub friction_coefficient: f64,
    /// Stiffness \[N/m\].
    pub stiffness: f64,
    /// Its misfit.
    pub misfit: Misfit,
}

/// Misfit at a value of the shape, with all other parameters fitted.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ProfilePoint {
    /// Half-width of the flat over that of the contact \[-\].
    pub shape: f64,
    /// Root mean square of the weighted residuals over that of the best fit.
    pub relative_rms: f64,
    /// Whether the data admit this shape, with 95 % confidence.
    pub admitted: bool,
}

/// A measured loop and its fit; all vectors have the same length.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FittedLoop {
    /// Name of the measurement.
    pub name: String,
    /// Mean normal force \[N\].
    pub normal_force: f64,
    /// Half range of the displacement \[m\].
    pub amplitude: f64,
    /// Energy per cycle, measured \[J\].
    pub measured_energy: f64,
    /// Energy per cycle of the law \[J\].
    pub energy: f64,
    /// Displacements of the samples \[m\].
    pub displacement: Vec<f64>,
    /// Measured forces \[N\].
    pub measured_force: Vec<f64>,
    /// Forces of the law \[N\].
    pub force: Vec<f64>,
}
