use super::*;
use crate::parameters::{Layer, Material};

pub(crate) const TITANIUM: Material = Material { young_modulus: 114e9, poisson_ratio: 0.32 };

/// A small underplatform contact; half-widths of about 0.1 mm.
pub(crate) fn parameters(flat_half_width: f64) -> Parameters {
    Parameters {
        flat_half_width,
        edge_radius: 5e-3,
        length: 10e-3,
        normal_force: 150.0,
        friction_coefficient: 0.4,
        material: [TITANIUM; 2],
        displacement_reference: crate::parameters::CENTRE_POINT,
        ..Parameters::default()
    }
}

/// Cylinder, slightly flattened, flat, and nearly all flat.
pub(crate) const FLATS: [f64; 4] = [0.0, 1e-6, 50e-6, 5e-3];

pub(crate) fn contact(flat_half_width: f64) -> Contact {
    Contact::rounded_flat(&parameters(flat_half_width)).unwrap()
}

/// Contacts of all shapes with a layer of a compliance in units of that of the contact, and of N_c in units of the normal force.
pub(crate) fn layered(share: f64, ratio: f64) -> std::vec::Vec<Contact> {
    let layer = |alone: &Contact| Layer {
        normal_compliance: 0.0,
        tangential_compliance: share / alone.initial_stiffness,
        stiffening_load: 150.0 * ratio,
        reference_load: 0.0,
    };
    let flat = |a| Contact::rounded_flat(&Parameters { layer: layer(&contact(a)), ..parameters(a) }).unwrap();
    let ellipse = EllipticParameters { layer: layer(&ellipse(1e-4, 2e-4)), ..elliptic(1e-4, 2e-4) };
    std::vec![flat(0.0), flat(50e-6), flat(5e-3), Contact::elliptic(&ellipse).unwrap()]
}

pub(crate) fn elliptic(semi_axis_x: f64, semi_axis_y: f64) -> EllipticParameters {
    EllipticParameters {
        semi_axis_x,
        semi_axis_y,
        normal_force: 150.0,
        friction_coefficient: 0.4,
        material: [TITANIUM; 2],
        ..EllipticParameters::default()
    }
}

pub(crate) fn ellipse(semi_axis_x: f64, semi_axis_y: f64) -> Contact {
    Contact::elliptic(&elliptic(semi_axis_x, semi_axis_y)).unwrap()
}

#[test]
fn negative_zero_is_zero() {
    let minus = Contact::rounded_flat(&Parameters { flat_half_width: -0.0, ..parameters(0.0) }).unwrap();
    assert_eq!(std::format!("{minus:?}"), std::format!("{:?}", contact(0.0)));
}

/// Products in range whose factors are not: no intermediate overflow, and no contact of NaNs.
#[test]
fn factors_out_of_range_are_rejected() {
    let extreme = Parameters {
        edge_radius: 2.78e236,
        length: 4.8e-95,
        normal_force: 1.03e-171,
        friction_coefficient: 5.3e116,
        material: [Material { young_modulus: 5.5e85, poisson_ratio: 0.486 }; 2],
        displacement_reference: 1,
        ..parameters(0.0)
    };
    assert_eq!(Contact::rounded_flat(&extreme).map(|_| ()), Err(Error::OutOfRange));
}
