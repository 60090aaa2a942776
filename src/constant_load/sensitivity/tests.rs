use super::*;
use crate::constant_load::contact::tests::{FLATS, ellipse, elliptic, parameters};
use crate::parameters::{CENTRE_POINT, EllipticParameters, Layer, Material, Parameters, RIGID_STRIP};
use std::vec::Vec;

const BODIES: [Material; 2] =
    [Material { young_modulus: 114e9, poisson_ratio: 0.32 }, Material { young_modulus: 2e11, poisson_ratio: 0.2 }];

/// Contacts as functions of N, the friction coefficient, a, R, L, the factor of both moduli, and the compliance of a layer, with
/// the values of these.
pub(crate) type Case = (std::boxed::Box<dyn Fn(Sensitivity) -> Contact>, Sensitivity);

fn flat(displacement_reference: i32, stiffening_load: f64) -> impl Fn(Sensitivity) -> Contact {
    move |[normal_force, friction_coefficient, flat_half_width, edge_radius, length, factor, tangential_compliance]| {
        Contact::rounded_flat(&Parameters {
            flat_half_width,
            edge_radius,
            length,
            normal_force,
            friction_coefficient,
            material: BODIES.map(|body| Material { young_modulus: factor * body.young_modulus, ..body }),
            layer: Layer { tangential_compliance, stiffening_load, reference_load: 80.0, ..Layer::none() },
            displacement_reference,
            reserved: 0,
        })
        .unwrap()
    }
}

fn sphere(stiffening_load: f64) -> impl Fn(Sensitivity) -> Contact {
    let modulus = ellipse(1e-4, 1e-4).composite_modulus;
    move |[normal_force, friction_coefficient, _, radius, _, factor, tangential_compliance]| {
        let young_modulus = factor * parameters(0.0).material[0].young_modulus;
        let semi_axis = (0.75 * normal_force * radius / (factor * modulus)).cbrt();
        Contact::elliptic(&EllipticParameters {
            normal_force,
            friction_coefficient,
            material: [Material { young_modulus, ..parameters(0.0).material[0] }; 2],
            layer: Layer { tangential_compliance, stiffening_load, reference_load: 80.0, ..Layer::none() },
            ..elliptic(semi_axis, semi_axis)
        })
        .unwrap()
    }
}

/// Line contacts with both displacement references, among them a short one, and a sphere; without a layer, and with linear and
/// stiffening ones, which remain the same under another normal force: their compliance is given under another load.
pub(crate) fn cases() -> Vec<Case> {
    let mut cases = Vec::<Case>::new();
    for half_width in FLATS {
        for (reference, length) in [(CENTRE_POINT, 10e-3), (RIGID_STRIP, 10e-3), (RIGID_STRIP, 8e-3)] {
            let values = [150.0, 0.4, half_width, 5e-3, length, 1.0, 0.0];
            cases.push((std::boxed::Box::new(flat(reference, 0.0)), values));
        }
    }
    for (stiffening_load, compliance) in [(0.0, 0.0), (15.0, 0.0), (0.0, 6e-9), (15.0, 6e-9), (1.5, 2e-9)] {
        let values = |half_width| [150.0, 0.4, half_width, 5e-3, 10e-3, 1.0, compliance];
        cases.push((std::boxed::Box::new(flat(CENTRE_POINT, stiffening_load)), values(50e-6)));
        cases.push((std::boxed::Box::new(sphere(stiffening_load)), values(0.0)));
    }
    cases
}

/// Differences of a function of the contact, one column per parameter, and the scale of each column: mu N over the parameter. The
/// derivative with respect to the factor is E* times that with respect to E*. Their errors are O(h²); they
/// are one-sided for a cylinder, which has no negative a, and without a layer.
pub(crate) fn differences(
    (contact, values): &Case,
    function: impl Fn(&Contact) -> Vec<f64>,
) -> [(Vec<f64>, f64); PARAMETERS] {
    let base = contact(*values);
    core::array::from_fn(|parameter| {
        let size = match parameter {
            2 => values[2].max(base.half_width),
            6 => values[6].max(1.0 / base.initial_stiffness),
            _ => values[parameter],
        };
        let h = 1e-5 * size;
        let at = |step: f64| {
            let mut values = *values;
            values[parameter] += step;
            function(&contact(values))
        };
        let unit = if parameter == 5 { base.composite_modulus } else { 1.0 };
        let quotient: Vec<f64> = if values[parameter] >= h {
            at(h).into_iter().zip(at(-h)).map(|(high, low)| (high - low) / (2.0 * h) / unit).collect()
        } else {
            let values = at(0.0).into_iter().zip(at(h)).zip(at(2.0 * h));
            values.map(|((first, second), third)| (4.0 * second - 3.0 * first - third) / (2.0 * h) / unit).collect()
        };
        (quotient, base.slip_force / size / unit)
    })
}
