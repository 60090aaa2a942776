use super::*;
use crate::parameters::{CENTRE_POINT, Layer, Material, Pair, RIGID_STRIP};

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
    let ellipse = EllipticParameters {
        semi_axis_x: 1e-4,
        semi_axis_y: 2e-4,
        normal_force: 150.0,
        friction_coefficient: 0.4,
        material: [TITANIUM; 2],
        layer: layer(&ellipse(1e-4, 2e-4)),
    };
    std::vec![flat(0.0), flat(50e-6), flat(5e-3), Contact::elliptic(&ellipse).unwrap()]
}

/// A cylinder with a ratio 2L/b of `slenderness`.
pub(crate) fn cylinder(slenderness: f64, poisson_ratio: f64, reference: i32) -> Result<Contact, Error> {
    let body = Material { young_modulus: 2e11, poisson_ratio };
    let half_width = 2.0 * 0.01 / slenderness;
    let modulus = Pair::new(&[body; 2]).composite_modulus;
    Contact::rounded_flat(&Parameters {
        normal_force: PI * modulus * 0.01 * half_width * half_width / (4.0 * 5e-3),
        material: [body; 2],
        displacement_reference: reference,
        ..parameters(0.0)
    })
}

pub(crate) fn ellipse(semi_axis_x: f64, semi_axis_y: f64) -> Contact {
    Contact::elliptic(&EllipticParameters {
        semi_axis_x,
        semi_axis_y,
        normal_force: 150.0,
        friction_coefficient: 0.4,
        material: [TITANIUM; 2],
        ..EllipticParameters::default()
    })
    .unwrap()
}

/// Λ, from the initial stiffness.
fn compliance(contact: &Contact) -> f64 {
    contact.stiffness_scale / contact.initial_stiffness
}

#[test]
fn length_below_half_the_half_width_is_rejected() {
    for nu in [0.0, 0.3, 0.5] {
        for reference in [CENTRE_POINT, RIGID_STRIP] {
            // 2L = b to 1e-9, far above the rounding errors of both.
            let rejected = cylinder(1.0 - 1e-9, nu, reference).map(|_| ());
            assert_eq!(rejected, Err(Error::LengthTooShort), "{nu}");
            let shortest = cylinder(1.0 + 1e-9, nu, reference).unwrap();
            assert!(shortest.initial_stiffness > 0.0 && compliance(&shortest) > 0.0, "{nu}");
        }
    }
    // A flat wider than its length allows, whatever the load.
    let wide = Contact::rounded_flat(&parameters(20.1e-3)).map(|_| ());
    assert_eq!(wide, Err(Error::LengthTooShort));
}

/// For parameters of any magnitude: either rejected, or all results finite and positive.
#[test]
fn accepted_contacts_are_representable() {
    let sizes = [1e-300, 1e-120, 1e-30, 1e-3, 1e5, 1e40, 1e150, 1e300];
    let (mut accepted, mut rejected) = (0, 0);
    let mut check = |contact: Result<Contact, Error>| match contact {
        Ok(contact) => {
            accepted += 1;
            let Contact { half_width, slip_force, slip_displacement, initial_stiffness, slip_energy, .. } = contact;
            for value in [half_width, slip_force, slip_displacement, initial_stiffness] {
                assert!(value > 0.0 && value.is_finite(), "{contact:?}");
            }
            let work = slip_force * slip_displacement;
            assert!(slip_energy.is_normal() && slip_energy < 2.0 * work, "{contact:?}");
        }
        Err(error) => {
            rejected += 1;
            assert!(matches!(error, Error::OutOfRange | Error::LengthTooShort), "{error:?}");
        }
    };
    for one in sizes {
        for two in sizes {
            for three in sizes {
                for young_modulus in [1e-160, 1e11, 1e160] {
                    let material = [Material { young_modulus, poisson_ratio: 0.3 }; 2];
                    for flat in [0.0, 1e-200, 1e-4, 1e200] {
                        check(Contact::rounded_flat(&Parameters {
                            edge_radius: one,
                            length: two,
                            normal_force: three,
                            material,
                            ..parameters(flat)
                        }));
                    }
                    check(Contact::elliptic(&EllipticParameters {
                        semi_axis_x: one,
                        semi_axis_y: two,
                        normal_force: three,
                        friction_coefficient: 0.3,
                        material,
                        ..EllipticParameters::default()
                    }));
                }
            }
        }
    }
    assert!(accepted > 100 && rejected > 1000, "{accepted} {rejected}");
}

#[test]
fn open_and_frictionless_contacts_carry_no_force() {
    for flat in [0.0, 50e-6] {
        let open = Contact::rounded_flat(&Parameters { normal_force: 0.0, ..parameters(flat) }).unwrap();
        let frictionless =
            Contact::rounded_flat(&Parameters { friction_coefficient: 0.0, ..parameters(flat) }).unwrap();
        assert_eq!((open.half_width, open.pressure(0.0)), (0.0, 0.0));
        assert_eq!((frictionless.half_width, frictionless.pressure(0.0)), {
            let frictional = contact(flat);
            (frictional.half_width, frictional.pressure(0.0))
        });
        for contact in [open, frictionless] {
            assert!(contact.is_initialised() && contact.composite_modulus > 0.0);
            let Contact { slip_force, slip_displacement, initial_stiffness, slip_energy, .. } = contact;
            assert_eq!([slip_force, slip_displacement, initial_stiffness, slip_energy], [0.0; 4]);
            let point = contact.curve_at_displacement(1.0).unwrap();
            assert_eq!((point.force(), point.stiffness(), point.shear(0.0)), (0.0, 0.0, 0.0));
            let complex = contact.complex_stiffness(1.0).unwrap();
            assert_eq!((complex.real, complex.imaginary), (0.0, 0.0));
            assert_eq!((complex.d_real, complex.d_imag), (0.0, 0.0));
        }
    }
}

#[test]
fn negative_zero_is_zero() {
    let minus = Contact::rounded_flat(&Parameters { flat_half_width: -0.0, ..parameters(0.0) }).unwrap();
    assert_eq!(std::format!("{minus:?}"), std::format!("{:?}", contact(0.0)));
}

#[test]
fn uninitialised_memory_is_recognised() {
    for contact in [contact(0.0), ellipse(1e-4, 2e-4)] {
        assert!(contact.is_initialised());
        for bit in 0..64 {
            assert!(!Contact { tag: contact.tag ^ (1 << bit), ..contact }.is_initialised());
        }
    }
}

/// Products in range whose factors are not: no intermediate overflow, and no contact of NaNs.
#[test]
fn factors_out_of_range_are_rejected() {
    let body = Material { young_modulus: 5.5e85, poisson_ratio: 0.486 };
    let extreme = Parameters {
        flat_half_width: 0.0,
        edge_radius: 2.78e236,
        length: 4.8e-95,
        normal_force: 1.03e-171,
        friction_coefficient: 5.3e116,
        material: [body; 2],
        displacement_reference: 1,
        layer: Layer::none(),
        reserved: 0,
    };
    assert_eq!(Contact::rounded_flat(&extreme).map(|_| ()), Err(Error::OutOfRange));
}

#[test]
fn displacement_of_gross_slip_beyond_the_limit_is_rejected() {
    let (mut accepted, mut rejected) = (0, 0);
    let soft = Material { young_modulus: 7.4e-57, ..TITANIUM };
    for exponent in 285..305 {
        let parameters = EllipticParameters {
            semi_axis_x: 1e-4,
            semi_axis_y: 2e-4,
            normal_force: 100.0,
            friction_coefficient: 2f64.powi(exponent),
            material: [soft, TITANIUM],
            ..EllipticParameters::default()
        };
        match Contact::elliptic(&parameters) {
            Ok(contact) => {
                accepted += 1;
                assert!(contact.curve_at_displacement(contact.slip_displacement).is_ok());
            }
            Err(error) => {
                rejected += 1;
                assert_eq!(error, Error::OutOfRange);
            }
        }
    }
    assert!(accepted > 0 && rejected > 0);
}
