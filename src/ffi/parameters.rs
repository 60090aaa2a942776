//! Parameters as the C interface has them: without a layer.

use crate::parameters::{self, Layer, Material};

/// Flat with rounded edges on a flat (Eq. 1-24); a cylinder if the flat has no width.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct mslip_parameters {
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
    /// `MSLIP_CENTRE_POINT` (0, as in the paper) or `MSLIP_RIGID_STRIP` (1, corrected to 3-D).
    pub displacement_reference: i32,
    /// Not read; set to 0.
    pub reserved: i32,
}

/// Elliptical Hertz contact (section 3.3); a sphere if both semi-axes are equal.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct mslip_elliptic_parameters {
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
}

impl From<parameters::Parameters> for mslip_parameters {
    fn from(parameters: parameters::Parameters) -> mslip_parameters {
        mslip_parameters {
            flat_half_width: parameters.flat_half_width,
            edge_radius: parameters.edge_radius,
            length: parameters.length,
            normal_force: parameters.normal_force,
            friction_coefficient: parameters.friction_coefficient,
            material: parameters.material,
            displacement_reference: parameters.displacement_reference,
            reserved: parameters.reserved,
        }
    }
}

impl From<&mslip_parameters> for parameters::Parameters {
    fn from(parameters: &mslip_parameters) -> parameters::Parameters {
        parameters::Parameters {
            flat_half_width: parameters.flat_half_width,
            edge_radius: parameters.edge_radius,
            length: parameters.length,
            normal_force: parameters.normal_force,
            friction_coefficient: parameters.friction_coefficient,
            material: parameters.material,
            layer: Layer::NONE,
            displacement_reference: parameters.displacement_reference,
            reserved: parameters.reserved,
        }
    }
}

impl From<parameters::EllipticParameters> for mslip_elliptic_parameters {
    fn from(parameters: parameters::EllipticParameters) -> mslip_elliptic_parameters {
        mslip_elliptic_parameters {
            semi_axis_x: parameters.semi_axis_x,
            semi_axis_y: parameters.semi_axis_y,
            normal_force: parameters.normal_force,
            friction_coefficient: parameters.friction_coefficient,
            material: parameters.material,
        }
    }
}

impl From<&mslip_elliptic_parameters> for parameters::EllipticParameters {
    fn from(parameters: &mslip_elliptic_parameters) -> parameters::EllipticParameters {
        parameters::EllipticParameters {
            semi_axis_x: parameters.semi_axis_x,
            semi_axis_y: parameters.semi_axis_y,
            normal_force: parameters.normal_force,
            friction_coefficient: parameters.friction_coefficient,
            material: parameters.material,
            layer: Layer::NONE,
        }
    }
}
