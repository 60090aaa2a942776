//! The result of a fit.

use crate::cycles::Loop;
use crate::data::mean;
use crate::input::{Contact, DisplacementReference, Geometry};
use crate::model::PARAMETERS;
use serde::Serialize;

/// Result of a fit. All numbers are in the units of the input.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// Friction coefficient \[-\].
    pub friction_coefficient: Estimate,
    /// Compliance of rig and bodies in series with the contact, under its normal force \[m/N\].
    pub series_compliance: Estimate,
    /// Share of the series stiffness, under the normal force of the contact, that grows in proportion to the load \[-\]; fixed at
    /// 0 unless there are several loads.
    pub series_stiffening: Estimate,
    /// Factor on the displacements of the law \[-\].
    pub contact_compliance: Estimate,
    /// Stiffness of a spring in parallel with the contact \[N/m\]; 0 and not determined without a long plateau of gross slip.
    pub parallel_stiffness: Estimate,
    /// Initial compliance of contact, rig and bodies, under the normal force of the contact \[m/N\].
    pub total_compliance: Estimate,
    /// Half-width of the flat over that of the contact under the normal force of the contact \[-\]; none of an ellipse.
    pub shape: Option<Estimate>,
    /// Whether the law explains the loops. If not, no parameter is determined.
    pub explanation: Explanation,
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
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Estimate {
    /// Best value.
    pub value: f64,
    /// Lower end of the interval.
    pub lower: f64,
    /// Upper end of the interval; `None` if the interval is unbounded.
    pub upper: Option<f64>,
    /// Whether the data determine it.
    pub status: Status,
}

/// Whether the data determine a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// Fixed by an option, or of a shape without that parameter.
    Fixed,
    /// The interval is narrow.
    Determined,
    /// Only one end of the interval is narrow, or it excludes a part of the range.
    Bounded,
    /// Of the friction coefficient without a plateau of gross slip: the largest force over the normal force.
    LowerBound,
    /// The interval contains all values that make sense, or the law does not explain the loops.
    NotDetermined,
}

/// Misfit against noise, of the loop with the largest ratio of both.
#[derive(Debug, Clone, Serialize)]
pub struct Explanation {
    /// Whether the misfit is at most twice the noise.
    pub explained: bool,
    /// Name of the loop.
    pub name: String,
    /// Root mean square of the residuals \[N\].
    pub misfit: f64,
    /// The same over the slip force of the fit, mu N \[-\].
    pub relative_misfit: f64,
    /// Root mean square that noise, steps of a digitiser and errors of the model explain \[N\].
    pub noise: f64,
    /// What the residuals of loops that are not explained show, the cause that explains most first.
    pub causes: Vec<Cause>,
}

/// A cause of residuals.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Cause {
    /// Which.
    pub kind: CauseKind,
    /// Its size, see [`CauseKind`].
    pub size: f64,
    /// The part of the sum of squares of the residuals that it explains \[-\].
    pub share: f64,
}

/// Kinds of causes, with the meaning of their size.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum CauseKind {
    /// Plateaus of different height: relative change of positive forces.
    DifferentPlateaus,
    /// A force that depends on the amplitude: relative change from the smallest to the largest amplitude.
    Amplitude,
    /// A force that changes from cycle to cycle: relative change over the record.
    Cycle,
    /// Plateaus with a slope in speed: relative change up to the largest speed.
    Speed,
    /// Lag of the force: in samples of the measurement.
    Lag,
    /// Play around zero force: its displacement \[m\].
    Play,
    /// A viscous part: its force at the largest speed over mu N.
    Viscous,
    /// Plateaus with a slope in displacement that no spring in parallel has: the force at the largest amplitude over mu N.
    ParallelSpring,
}

/// Difference between measurement and model.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Misfit {
    /// Root mean square of the force \[N\].
    pub force_rms: f64,
    /// Largest difference of the force \[N\].
    pub force_max: f64,
    /// Root mean square over the loops of the relative error of the energy per cycle \[-\].
    pub energy: f64,
}

/// A spring in series with a slider, fitted to the same loops.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct SpringSlider {
    /// Friction coefficient \[-\].
    pub friction_coefficient: f64,
    /// Stiffness \[N/m\].
    pub stiffness: f64,
    /// Its misfit.
    pub misfit: Misfit,
}

/// Misfit at a value of the shape, with all other parameters fitted.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct ProfilePoint {
    /// Half-width of the flat over that of the contact \[-\].
    pub shape: f64,
    /// Root mean square of the weighted residuals over that of the best fit.
    pub relative_rms: f64,
    /// Whether the data admit this shape, with 95 % confidence.
    pub admitted: bool,
}

/// A measured loop and its fit; all vectors have the same length.
#[derive(Debug, Clone, Serialize)]
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
    /// Forces of the spring-slider \[N\].
    pub slider_force: Vec<f64>,
}

macro_rules! names {
    ($($kind:ty)*) => {
        $(impl $kind {
            /// Its name in JSON.
            pub fn name(self) -> String {
                serde_json::to_value(self).ok().and_then(|name| name.as_str().map(str::to_owned)).unwrap_or_default()
            }
        })*
    };
}
names!(Status CauseKind);

impl Misfit {
    /// Of measured and computed forces at the samples of each loop.
    pub(crate) fn new(loops: &[Loop], forces: &[Vec<[f64; 2]>]) -> Misfit {
        let differences = || forces.iter().flatten().map(|[measured, model]| measured - model);
        let energies: Vec<_> = loops.iter().zip(forces).map(|(one, forces)| energies(one, forces)).collect();
        let relative = |[measured, model]: &[f64; 2]| (model / measured - 1.0).powi(2);
        Misfit {
            force_rms: mean(differences().map(|difference| difference * difference)).sqrt(),
            force_max: differences().fold(0.0, |most: f64, difference| most.max(difference.abs())),
            energy: mean(energies.iter().map(relative)).sqrt(),
        }
    }
}

/// Energy per cycle, measured and computed.
fn energies(one: &Loop, forces: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|which| one.energy(&forces.iter().map(|pair| pair[which]).collect::<Vec<_>>()))
}

impl FittedLoop {
    pub(crate) fn new(one: &Loop, forces: &[[f64; 2]], slider: &[[f64; 2]]) -> FittedLoop {
        let [measured_energy, energy] = energies(one, forces);
        FittedLoop {
            name: one.name.clone(),
            normal_force: one.normal_force,
            amplitude: one.amplitude,
            measured_energy,
            energy,
            displacement: one.samples.iter().map(|sample| sample.displacement).collect(),
            measured_force: forces.iter().map(|pair| pair[0]).collect(),
            force: forces.iter().map(|pair| pair[1]).collect(),
            // Its offset differs a little from that of the law.
            slider_force: forces.iter().zip(slider).map(|(law, slider)| slider[1] + law[0] - slider[0]).collect(),
        }
    }
}

/// N_c: the stiffness, of which this share grows with the load under a normal force, is proportional to N + N_c.
pub(crate) fn stiffening_load(share: f64, normal_force: f64) -> f64 {
    normal_force * (1.0 / share - 1.0)
}

/// The fitted contact as a parameter file. A factor f on the displacements of the law is a modulus E/f, and a radius R/f so that
/// the contact has the same width.
pub(crate) fn contact_toml(
    contact: &Contact,
    geometry: &Geometry,
    parameters: &[f64; PARAMETERS],
    neutral: &[&str],
) -> String {
    let [friction, series, factor, _, share, _] = parameters;
    let mut text =
        "# Fitted to measured loops. tangential_compliance is that of all in series with the contact: rig, bodies, roughness.\n"
            .to_owned();
    if !neutral.is_empty() {
        let names = neutral.join(" and ");
        text += &format!(
            "# The loops do not determine {names}: as given, or nearest to that of what they admit; the others are fitted with \
             that.\n"
        );
    }
    if *factor != 1.0 {
        text += &format!(
            "# Young's moduli{} are divided by {factor}, the fitted factor on the displacements of the law.\n",
            match geometry {
                Geometry::Flat { .. } => " and edge_radius",
                Geometry::Ellipse { .. } => "",
            }
        );
    }
    match geometry {
        Geometry::Flat { flat_half_width, edge_radius, length, displacement_reference } => {
            let reference = match displacement_reference {
                DisplacementReference::CentrePoint => "centre_point",
                DisplacementReference::RigidStrip => "rigid_strip",
            };
            text += &format!(
                "flat_half_width = {flat_half_width:e}\nedge_radius = {:e}\nlength = {length:e}\n\
                 displacement_reference = \"{reference}\"\n",
                edge_radius / factor
            );
        }
        Geometry::Ellipse { semi_axis_x, semi_axis_y } => {
            text += &format!("semi_axis_x = {semi_axis_x:e}\nsemi_axis_y = {semi_axis_y:e}\n");
        }
    }
    text += &format!("normal_force = {:e}\nfriction_coefficient = {friction:e}\n", contact.normal_force);
    if *series > 0.0 {
        // As measured: under another normal_force the layer remains the same.
        text += &format!("tangential_compliance = {series:e}\nreference_load = {:e}\n", contact.normal_force);
        if *share > 0.0 {
            text += &format!("stiffening_load = {:e}\n", stiffening_load(*share, contact.normal_force));
        }
    }
    for body in &contact.material {
        let (modulus, ratio) = (body.young_modulus / factor, body.poisson_ratio);
        text += &format!("\n[[material]]\nyoung_modulus = {modulus:e}\npoisson_ratio = {ratio:e}\n");
    }
    text
}
