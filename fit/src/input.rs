//! The input of a fit: the contact, measured loops, and what is fixed. All numbers are in one consistent set of units.

use crate::error::{Error, error};
use serde::{Deserialize, Serialize};

/// The contact, by the names of a parameter file. What is fitted is only a start value here.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// Geometry of the contact.
    #[serde(flatten)]
    pub geometry: Geometry,
    /// Normal force > 0 \[N\]: of the ratio a/b, of the semi-axes, and of measurements that have none.
    pub normal_force: f64,
    /// Start value of the friction coefficient > 0; not read if the data have gross slip.
    pub friction_coefficient: f64,
    /// The two bodies.
    pub material: [Material; 2],
}

/// Geometry of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Geometry {
    /// Flat with rounded edges; a cylinder if the flat has no width.
    Flat {
        /// Half-width a >= 0 of the flat \[m\].
        flat_half_width: f64,
        /// Radius R > 0 of the rounded edges \[m\].
        edge_radius: f64,
        /// Length L > 0 \[m\].
        length: f64,
        /// Reference of the displacement.
        #[serde(default)]
        displacement_reference: DisplacementReference,
    },
    /// Elliptical Hertz contact; a sphere if both semi-axes are equal.
    Ellipse {
        /// Semi-axis along the tangential force, under `normal_force` \[m\].
        semi_axis_x: f64,
        /// Semi-axis across the tangential force, under `normal_force` \[m\].
        semi_axis_y: f64,
    },
}

/// Reference of the displacement of a flat.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DisplacementReference {
    /// The centre of the contact, under a line of uniform traction.
    #[default]
    CentrePoint,
    /// A rigid strip, corrected to three-dimensional contact mechanics.
    RigidStrip,
}

/// Elastic constants of a body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Young's modulus E > 0 \[Pa\].
    pub young_modulus: f64,
    /// Poisson's ratio, 0 <= nu <= 0.5 \[-\].
    pub poisson_ratio: f64,
}

/// A record of displacement and tangential force, with at least one cycle.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measurement {
    /// Name in messages, for example that of its file.
    #[serde(default)]
    pub name: String,
    /// Displacement of the rig \[m\], in equal steps of time unless `time` is given.
    pub displacement: Vec<f64>,
    /// Tangential force \[N\]; it opposes the motion, so a loop has a positive area.
    pub force: Vec<f64>,
    /// Normal force \[N\]; by default that of the contact.
    #[serde(default)]
    pub normal_force: Option<NormalForce>,
    /// Time \[s\]; only to find gaps.
    #[serde(default)]
    pub time: Option<Vec<f64>>,
}

/// Normal force of a measurement \[N\].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum NormalForce {
    /// The same at all samples.
    Constant(f64),
    /// One value for each sample.
    Samples(Vec<f64>),
}

/// What is fixed; a parameter without a value is fitted.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Options {
    /// Friction coefficient.
    pub friction_coefficient: Option<f64>,
    /// Compliance of rig and bodies in series with the contact \[m/N\].
    pub series_compliance: Option<f64>,
    /// Factor on the displacements of the law; 1 is the law itself.
    pub contact_compliance: Option<f64>,
    /// The parameter of shape that is fitted.
    pub shape: ShapeParameter,
}

/// The parameter of shape that is fitted; an ellipse has none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ShapeParameter {
    /// Half-width of the flat.
    #[default]
    FlatHalfWidth,
    /// Radius of the edges, under a fixed half-width of the flat.
    EdgeRadius,
    /// None: the shape is that of the contact.
    Fixed,
}

impl Options {
    /// Checks the fixed values.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let positive = |value: f64| value.is_finite() && value > 0.0;
        let not_negative = |value: f64| value.is_finite() && value >= 0.0;
        if !self.friction_coefficient.is_none_or(positive) {
            return error("a fixed friction coefficient must be > 0");
        }
        if ![self.series_compliance, self.contact_compliance].iter().all(|value| value.is_none_or(not_negative)) {
            return error("a fixed compliance must be >= 0");
        }
        if self.series_compliance == Some(0.0) && self.contact_compliance == Some(0.0) {
            return error("both compliances are fixed at 0: a rigid slider");
        }
        Ok(())
    }
}
