//! Input parameters: geometry, material and load (section 2.1 and Fig. 1 of the paper), and their validation.

use crate::error::{Error, ensure};
use crate::limits::in_range;
use crate::numerics::fp_class::{abs_le, in_0_to};

/// Displacement of the centre point of the contact under a line of uniform traction: Eq. 5-10 of the paper.
pub const CENTRE_POINT: i32 = 0;
/// Displacement of a rigid strip, corrected to three-dimensional contact mechanics.
pub const RIGID_STRIP: i32 = 1;

/// Isotropic, linearly elastic material of one body.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Young's modulus E > 0 \[Pa\].
    pub young_modulus: f64,
    /// Poisson's ratio, 0 <= nu <= 0.5 \[-\].
    pub poisson_ratio: f64,
}

/// A compliant layer in series with the contact: roughness, a coating, the body around the contact, the rig. It carries the forces
/// of the contact. Its compliances are at most 2^40 times those of the contact, and loads of an element with a layer at most 2^40
/// times the normal force of the parameters.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layer {
    /// Normal compliance c_n >= 0 under the reference load \[m/N\]; 0: none. A contact under a constant normal force does not use
    /// it.
    pub normal_compliance: f64,
    /// Tangential compliance c_t >= 0 under the reference load \[m/N\]; 0: none.
    pub tangential_compliance: f64,
    /// N_c \[N\]: the stiffness grows in proportion to N + N_c, N_c at least 1e-3 of the normal force of the parameters; 0 or
    /// infinite: the stiffness is constant.
    pub stiffening_load: f64,
    /// Reference load N_r, 0 <= N_r <= 1e150 \[N\]: the load under which the compliances were measured; 0: the normal force of the
    /// parameters. Under N they are c (N_r + N_c)/(N + N_c).
    pub reference_load: f64,
}

impl Layer {
    /// No layer.
    pub const fn none() -> Layer {
        Layer { normal_compliance: 0.0, tangential_compliance: 0.0, stiffening_load: 0.0, reference_load: 0.0 }
    }

    /// Smallest ratio of N_c to the normal force of the parameters: the curve of a layer has a knee at N_c before gross slip, which
    /// the polynomials of a contact resolve down to this ratio.
    const SMALLEST_STIFFENING: f64 = 1e-3;
}

impl Default for Layer {
    fn default() -> Self {
        Layer::none()
    }
}

/// Flat with rounded edges on a flat (Eq. 1-24); a cylinder if the flat has no width.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameters {
    /// Half-width a >= 0 of the flat \[m\]; 0 is a Hertzian cylinder.
    pub flat_half_width: f64,
    /// Radius R > 0 of the rounded edges (of the cylinder if a = 0) \[m\].
    pub edge_radius: f64,
    /// Length L > 0 of the contact along its line \[m\]; the model needs 2L > b and a positive initial stiffness.
    pub length: f64,
    /// Normal force N >= 0 on the whole contact \[N\]; 0 is an open contact: no force, no stiffness.
    pub normal_force: f64,
    /// Coulomb's friction coefficient mu >= 0 \[-\].
    pub friction_coefficient: f64,
    /// The two bodies.
    pub material: [Material; 2],
    /// A layer in series with the contact; all zero: none.
    pub layer: Layer,
    /// `MSLIP_RIGID_STRIP` (1, corrected to 3-D, for the contact of a machine) or `MSLIP_CENTRE_POINT` (0, as in the paper).
    pub displacement_reference: i32,
    /// Not read; set to 0.
    pub reserved: i32,
}

/// Elliptical Hertz contact (section 3.3); a sphere if both semi-axes are equal.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EllipticParameters {
    /// Semi-axis b > 0 of the contact ellipse along the tangential force \[m\].
    pub semi_axis_x: f64,
    /// Semi-axis l > 0 of the contact ellipse across the tangential force \[m\].
    pub semi_axis_y: f64,
    /// Normal force N >= 0 \[N\]; 0 is an open contact.
    pub normal_force: f64,
    /// Coulomb's friction coefficient mu >= 0 \[-\].
    pub friction_coefficient: f64,
    /// The two bodies.
    pub material: [Material; 2],
    /// A layer in series with the contact; all zero: none.
    pub layer: Layer,
}

/// Default of the numbers: NaN, and of the displacement reference: -1, so that an omitted parameter is rejected by its own error.
const UNSET: f64 = f64::NAN;

const UNSET_MATERIAL: Material = Material { young_modulus: UNSET, poisson_ratio: UNSET };

impl Default for Parameters {
    fn default() -> Self {
        Parameters {
            flat_half_width: UNSET,
            edge_radius: UNSET,
            length: UNSET,
            normal_force: UNSET,
            friction_coefficient: UNSET,
            material: [UNSET_MATERIAL; 2],
            layer: Layer::none(),
            displacement_reference: -1,
            reserved: 0,
        }
    }
}

impl Default for EllipticParameters {
    fn default() -> Self {
        EllipticParameters {
            semi_axis_x: UNSET,
            semi_axis_y: UNSET,
            normal_force: UNSET,
            friction_coefficient: UNSET,
            material: [UNSET_MATERIAL; 2],
            layer: Layer::none(),
        }
    }
}

/// Number of parameters that forces are differentiated by.
pub const PARAMETERS: usize = 7;

/// Derivatives with respect to the normal force N, the friction coefficient, the half-width a of the flat, the edge radius R, the
/// length L, E*, and the tangential compliance of the layer, in this order.
pub type Sensitivity = [f64; PARAMETERS];

/// A multiple.
pub(crate) fn times(factor: f64, sensitivity: Sensitivity) -> Sensitivity {
    sensitivity.map(|derivative| factor * derivative)
}

/// `Ok` if `value` is finite and >= 0.
pub(crate) fn not_negative(value: f64, error: Error) -> Result<(), Error> {
    ensure(in_0_to(value, f64::MAX), error)
}

/// `Ok` if `value` is finite and > 0.
pub(crate) fn positive(value: f64, error: Error) -> Result<(), Error> {
    ensure(in_0_to(value, f64::MAX) && !abs_le(value, 0.0), error)
}

/// The parameters that all shapes have.
pub(crate) struct Common {
    pub normal_force: f64,
    pub friction_coefficient: f64,
    pub material: [Material; 2],
    pub layer: Layer,
}

impl Common {
    /// The parameters, if they are within their ranges.
    /// Errors: the error of the first one that is not.
    pub fn checked(self) -> Result<Common, Error> {
        not_negative(self.normal_force, Error::BadNormalForce)?;
        not_negative(self.friction_coefficient, Error::BadFrictionCoefficient)?;
        for body in &self.material {
            positive(body.young_modulus, Error::BadYoungModulus)?;
            ensure(in_0_to(body.poisson_ratio, 0.5), Error::BadPoissonRatio)?;
        }
        let layer = &self.layer;
        not_negative(layer.normal_compliance, Error::BadNormalCompliance)?;
        not_negative(layer.tangential_compliance, Error::BadTangentialCompliance)?;
        let smallest = Layer::SMALLEST_STIFFENING * self.normal_force;
        let too_small = layer.stiffening_load > 0.0 && layer.stiffening_load < smallest;
        if too_small || !in_0_to(layer.stiffening_load, f64::INFINITY) {
            return Err(Error::BadStiffeningLoad);
        }
        // The bound keeps N_r/N_c and its products with compliances representable.
        if in_0_to(layer.reference_load, 1e150) { Ok(self) } else { Err(Error::BadReferenceLoad) }
    }

    /// E* of parameters that were checked.
    /// Errors: `OutOfRange` for a modulus of an unusable magnitude.
    pub fn composite_modulus(&self) -> Result<f64, Error> {
        self.material.iter().try_for_each(|body| in_range(&[body.young_modulus]))?;
        Ok(Pair::new(&self.material).composite_modulus)
    }
}

/// Combined elastic constants of the two bodies: `1/E* = Σ (1-ν²)/E` (Eq. 2) and the fraction of each body in it.
pub(crate) struct Pair {
    /// E*, Eq. 2 \[Pa\].
    pub composite_modulus: f64,
    /// Fraction of each body in 1/E*; the sum is 1.
    fraction: [f64; 2],
    poisson_ratio: [f64; 2],
}

impl Pair {
    pub fn new(material: &[Material; 2]) -> Pair {
        let compliance = |body: Material| (1.0 - body.poisson_ratio) * (1.0 + body.poisson_ratio) / body.young_modulus;
        let [first, second] = [compliance(material[0]), compliance(material[1])];
        let sum = first + second;
        Pair {
            composite_modulus: 1.0 / sum,
            fraction: [first / sum, second / sum],
            poisson_ratio: [material[0].poisson_ratio, material[1].poisson_ratio],
        }
    }

    /// Mean of a function of Poisson's ratio, weighted by the fraction of each body in the compliance; exactly the value of the
    /// function if both bodies are of the same material.
    pub fn mean(&self, function: impl Fn(f64) -> f64) -> f64 {
        let [first, second] = [function(self.poisson_ratio[0]), function(self.poisson_ratio[1])];
        first + self.fraction[1] * (second - first)
    }
}
