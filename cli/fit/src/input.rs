//! The input of a fit: the contact, measured loops, and what is fixed. All numbers are in one consistent set of units.

use crate::error::{Error, error};
use microslip::parameters::{CENTRE_POINT, RIGID_STRIP};
use microslip::{EllipticParameters, Layer, Material, Parameters};
use serde::{Deserialize, Deserializer, Serialize};

/// The contact. Fitted parameters are only start values here. It is read from the keys of a parameter file.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(try_from = "ParameterFile")]
pub struct Contact {
    /// Geometry of the contact.
    pub geometry: Geometry,
    /// Normal force > 0 \[N\]: of the ratio a/b, of the semi-axes, and of measurements that have none.
    pub normal_force: f64,
    /// Start value of the friction coefficient > 0; not read if the data have gross slip.
    pub friction_coefficient: f64,
    /// The two bodies.
    pub material: [Material; 2],
}

/// Geometry of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum), value(rename_all = "snake_case"))]
pub enum DisplacementReference {
    /// A rigid strip, corrected to three-dimensional contact mechanics: the contact of a machine
    RigidStrip,
    /// The centre of the contact, under a line of uniform traction: as in the paper, 7 to 13 % more compliant
    CentrePoint,
}

/// The parameters of a contact as the library takes them.
#[derive(Debug, Clone, Copy)]
pub enum ContactParameters {
    /// Of a [`Geometry::Flat`].
    Flat(Parameters),
    /// Of a [`Geometry::Ellipse`].
    Ellipse(EllipticParameters),
}

impl Contact {
    /// The parameters with a layer in series.
    pub fn parameters(&self, layer: Layer) -> ContactParameters {
        let Contact { geometry, normal_force, friction_coefficient, material } = *self;
        match geometry {
            Geometry::Flat { flat_half_width, edge_radius, length, displacement_reference } => {
                ContactParameters::Flat(Parameters {
                    flat_half_width,
                    edge_radius,
                    length,
                    normal_force,
                    friction_coefficient,
                    material,
                    displacement_reference: match displacement_reference {
                        DisplacementReference::CentrePoint => CENTRE_POINT,
                        DisplacementReference::RigidStrip => RIGID_STRIP,
                    },
                    layer,
                    ..Parameters::default()
                })
            }
            Geometry::Ellipse { semi_axis_x, semi_axis_y } => ContactParameters::Ellipse(EllipticParameters {
                semi_axis_x,
                semi_axis_y,
                normal_force,
                friction_coefficient,
                material,
                layer,
            }),
        }
    }
}

impl ContactParameters {
    /// The contact under a constant normal force.
    ///
    /// # Errors
    /// The status of the library.
    pub fn contact(&self) -> Result<microslip::Contact, microslip::Error> {
        match self {
            ContactParameters::Flat(parameters) => microslip::Contact::rounded_flat(parameters),
            ContactParameters::Ellipse(parameters) => microslip::Contact::elliptic(parameters),
        }
    }
}

/// The keys of a parameter file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ParameterFile {
    flat_half_width: Option<f64>,
    edge_radius: Option<f64>,
    length: Option<f64>,
    semi_axis_x: Option<f64>,
    semi_axis_y: Option<f64>,
    normal_force: Option<f64>,
    friction_coefficient: Option<f64>,
    displacement_reference: Option<DisplacementReference>,
    #[serde(default)]
    material: Vec<MaterialTable>,
}

/// A table `[[material]]`.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct MaterialTable {
    young_modulus: Option<f64>,
    poisson_ratio: Option<f64>,
}

impl TryFrom<ParameterFile> for Contact {
    type Error = Error;

    fn try_from(file: ParameterFile) -> Result<Contact, Error> {
        let of_both = |value: fn(&MaterialTable) -> Option<f64>| match &file.material[..] {
            [both] => value(both).map(|value| [value; 2]),
            [first, second] => value(first).zip(value(second)).map(|(first, second)| [first, second]),
            _ => None,
        };
        let [young_modulus, poisson_ratio] = [of_both(|body| body.young_modulus), of_both(|body| body.poisson_ratio)];
        let keys = serde_json::to_value(&file).unwrap_or_default();
        let missing = missing_parameters(|name| match name {
            "young_modulus" => young_modulus.is_some(),
            "poisson_ratio" => poisson_ratio.is_some(),
            name => !keys[name].is_null(),
        })?;
        if !missing.is_empty() {
            return error(format!("missing parameters: {}", missing.join(", ")));
        }
        // None is missing.
        let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
        let friction_coefficient = number(file.friction_coefficient);
        // The law is evaluated for a coefficient of 1, so this one is not checked there.
        if !(friction_coefficient.is_finite() && friction_coefficient >= 0.0) {
            return error(format!("{}, not {friction_coefficient:e}", microslip::Error::BadFrictionCoefficient));
        }
        let geometry = if file.semi_axis_x.is_some() {
            Geometry::Ellipse { semi_axis_x: number(file.semi_axis_x), semi_axis_y: number(file.semi_axis_y) }
        } else {
            Geometry::Flat {
                flat_half_width: number(file.flat_half_width),
                edge_radius: number(file.edge_radius),
                length: number(file.length),
                displacement_reference: file.displacement_reference.unwrap_or(DisplacementReference::RigidStrip),
            }
        };
        let [moduli, ratios] = [young_modulus, poisson_ratio].map(|values| values.unwrap_or([f64::NAN; 2]));
        let body = |i: usize| Material { young_modulus: moduli[i], poisson_ratio: ratios[i] };
        Ok(Contact {
            geometry,
            normal_force: number(file.normal_force),
            friction_coefficient,
            material: [0, 1].map(body),
        })
    }
}

/// Names of the parameters that a contact needs beside the given ones, which are to be those of one shape.
///
/// # Errors
/// A message if parameters of two shapes are given.
pub fn missing_parameters(is_given: impl Fn(&str) -> bool) -> Result<Vec<&'static str>, Error> {
    const FLAT: [&str; 4] = ["flat_half_width", "edge_radius", "length", "displacement_reference"];
    const ELLIPSE: [&str; 2] = ["semi_axis_x", "semi_axis_y"];
    const COMMON: [&str; 4] = ["normal_force", "friction_coefficient", "young_modulus", "poisson_ratio"];
    let is_ellipse = ELLIPSE.into_iter().any(&is_given);
    if is_ellipse && FLAT.into_iter().any(&is_given) {
        return error(
            "parameters of two shapes: flat_half_width, edge_radius, length and displacement_reference define a flat or a \
             cylinder, semi_axis_x and semi_axis_y an ellipse",
        );
    }
    let shape = if is_ellipse { &ELLIPSE[..] } else { &FLAT[..] };
    Ok(shape.iter().chain(&COMMON).copied().filter(|name| !is_given(name)).collect())
}

/// A record of displacement and tangential force, with at least one cycle. Samples in which a number is missing, NaN, or infinite
/// are left out; in JSON it is null.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measurement {
    /// Name in messages, for example that of its file.
    #[serde(default)]
    pub name: String,
    /// Displacement of the rig \[m\], in equal steps of time unless `time` is given.
    #[serde(deserialize_with = "samples")]
    pub displacement: Vec<f64>,
    /// Tangential force \[N\]; it opposes the motion, so a loop has a positive area.
    #[serde(deserialize_with = "samples")]
    pub force: Vec<f64>,
    /// Normal force \[N\]; by default that of the contact.
    #[serde(default)]
    pub normal_force: Option<NormalForce>,
    /// Time \[s\]; only to find gaps.
    #[serde(default, deserialize_with = "optional_samples")]
    pub time: Option<Vec<f64>>,
}

/// Normal force of a measurement \[N\].
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
pub enum NormalForce {
    /// The same at all samples.
    Constant(f64),
    /// One value for each sample.
    Samples(#[serde(deserialize_with = "samples")] Vec<f64>),
}

/// Numbers, of which null is NaN.
fn samples<'de, D: Deserializer<'de>>(source: D) -> Result<Vec<f64>, D::Error> {
    let values: Vec<Option<f64>> = Deserialize::deserialize(source)?;
    Ok(values.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect())
}

fn optional_samples<'de, D: Deserializer<'de>>(source: D) -> Result<Option<Vec<f64>>, D::Error> {
    samples(source).map(Some)
}

/// What is fixed; a parameter without a value is fitted.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Options {
    /// Friction coefficient.
    pub friction_coefficient: Option<f64>,
    /// Compliance of rig and bodies in series with the contact \[m/N\].
    pub series_compliance: Option<f64>,
    /// Factor on the displacements of the law; 1 is the law itself.
    pub contact_compliance: Option<f64>,
    /// Stiffness of a spring in parallel with the contact \[N/m\].
    pub parallel_stiffness: Option<f64>,
    /// The parameter of shape that is fitted.
    pub shape: ShapeParameter,
}

/// The parameter of shape that is fitted; an ellipse has none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
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
        let others = [self.series_compliance, self.contact_compliance, self.parallel_stiffness];
        if !others.iter().all(|value| value.is_none_or(not_negative)) {
            return error("a fixed compliance or stiffness must be >= 0");
        }
        if self.series_compliance == Some(0.0) && self.contact_compliance == Some(0.0) {
            return error("both compliances are fixed at 0: a rigid slider");
        }
        Ok(())
    }
}
