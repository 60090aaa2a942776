//! Contacts of every kind: from the cylinder to a flat with a rounded share of 1e-12, short and long, of like and unlike bodies,
//! elliptical, and in units of any size.

use crate::library::Contact;
use microslip::parameters::{CENTRE_POINT, RIGID_STRIP};
use microslip::{EllipticParameters, Layer, Material, Parameters};
use reference::Input;
use reference::law::load_of_size;

const STEEL: Material = Material { young_modulus: 2.1e11, poisson_ratio: 0.29 };
const TITANIUM: Material = Material { young_modulus: 1.14e11, poisson_ratio: 0.32 };
const STIFF: Material = Material { young_modulus: 6e11, poisson_ratio: 0.0 };

/// A flat by its ratios: 1 - a/b, which is 1 for a cylinder, and L/b.
pub struct Shape {
    pub rounded: f64,
    pub length: f64,
    pub material: [Material; 2],
    pub reference: i32,
}

/// Parameters for a half-width of about 0.2 mm, in units of 2^length metres and 2^force newtons.
pub fn flat(shape: &Shape, length: i32, force: i32) -> Input {
    let (metre, newton) = (2f64.powi(length), 2f64.powi(force));
    let half_width = 2e-4 * metre;
    // w² = b² - a² as a product, free of cancellation.
    let w = half_width * (shape.rounded * (2.0 - shape.rounded)).sqrt();
    let flat_half_width = half_width * (1.0 - shape.rounded);
    let material =
        shape.material.map(|body| Material { young_modulus: body.young_modulus * newton / metre / metre, ..body });
    let composite =
        1.0 / material.iter().map(|body| (1.0 - body.poisson_ratio.powi(2)) / body.young_modulus).sum::<f64>();
    let edge_radius = 0.1 * metre;
    let length = shape.length * half_width;
    Input::Flat(Parameters {
        flat_half_width,
        edge_radius,
        length,
        normal_force: load_of_size(flat_half_width, w) * composite / (4.0 * edge_radius) * length,
        friction_coefficient: 0.37,
        material,
        displacement_reference: shape.reference,
        layer: Layer::none(),
        reserved: 0,
    })
}

/// Semi-axes in metres, of which there are `2^length`, and newtons of `2^force`.
pub fn ellipse(semi_axis_x: f64, semi_axis_y: f64, length: i32, force: i32) -> Input {
    let (metre, newton) = (2f64.powi(length), 2f64.powi(force));
    let material =
        [STEEL, TITANIUM].map(|body| Material { young_modulus: body.young_modulus * newton / metre / metre, ..body });
    Input::Ellipse(EllipticParameters {
        semi_axis_x: semi_axis_x * metre,
        semi_axis_y: semi_axis_y * metre,
        normal_force: 90.0 * newton,
        friction_coefficient: 0.61,
        material,
        ..EllipticParameters::default()
    })
}

/// The contact with a layer: its compliance over that of the contact, and N_c over the normal force.
fn with_layer(input: Input, share: f64, stiffening: f64) -> Input {
    let compliance = share / Contact::new("alone", input).stiffness();
    let layer = |normal_force: f64| Layer {
        normal_compliance: 0.5 * compliance,
        tangential_compliance: compliance,
        stiffening_load: stiffening * normal_force,
        reference_load: 0.0,
    };
    match input {
        Input::Flat(one) => Input::Flat(Parameters { layer: layer(one.normal_force), ..one }),
        Input::Ellipse(one) => Input::Ellipse(EllipticParameters { layer: layer(one.normal_force), ..one }),
    }
}

/// Whether there is a layer: the multi-precision law has none.
pub fn has_layer(input: &Input) -> bool {
    let (Input::Flat(Parameters { layer, .. }) | Input::Ellipse(EllipticParameters { layer, .. })) = input;
    layer.tangential_compliance > 0.0
}

pub fn all() -> Vec<Contact> {
    let like = [STEEL, STEEL];
    let shape = |rounded: f64, length: f64| Shape { rounded, length, material: like, reference: CENTRE_POINT };
    let unlike =
        |rounded: f64, reference: i32| Shape { material: [STEEL, TITANIUM], reference, ..shape(rounded, 40.0) };
    // Without Poisson's effect the compliance vanishes where 2L = b.
    let short = |excess: f64| Shape { material: [STIFF, STIFF], ..shape(1.0, 0.5 * (1.0 + excess)) };
    let inputs = [
        ("cylinder", flat(&unlike(1.0, CENTRE_POINT), 0, 0)),
        ("flat, a/b = 1e-6", flat(&shape(1.0 - 1e-6, 20.0), 0, 0)),
        ("flat, a/b = 0.3", flat(&unlike(0.7, RIGID_STRIP), 0, 0)),
        ("flat, a/b = 0.95", flat(&shape(0.05, 12.0), 0, 0)),
        ("flat, 1 - a/b = 1e-6", flat(&shape(1e-6, 30.0), 0, 0)),
        ("flat, 1 - a/b = 1e-12", flat(&shape(1e-12, 15.0), 0, 0)),
        ("cylinder, 2L/b = 1 + 1e-9", flat(&short(1e-9), 0, 0)),
        ("cylinder, 2L/b = 1.02", flat(&short(0.02), 0, 0)),
        ("flat, 2L/b = 1.001", flat(&Shape { rounded: 0.2, ..short(1e-3) }, 0, 0)),
        ("flat, L/b = 1e6", flat(&shape(0.4, 1e6), 0, 0)),
        ("ellipse 1:3", ellipse(1e-4, 3e-4, 0, 0)),
        ("ellipse 1000:1", ellipse(1e-3, 1e-6, 0, 0)),
        ("sphere", ellipse(2e-4, 2e-4, 0, 0)),
        ("flat, newtons of 2^400", flat(&unlike(0.5, CENTRE_POINT), 0, 400)),
        ("flat, newtons of 2^-400", flat(&unlike(0.5, CENTRE_POINT), 0, -400)),
        ("cylinder, metres of 2^200", flat(&unlike(1.0, RIGID_STRIP), 200, 400)),
        ("ellipse, metres of 2^-200", ellipse(1e-4, 3e-4, -200, -400)),
        ("cylinder with a layer", with_layer(flat(&shape(1.0, 20.0), 0, 0), 2.0, 0.0)),
        ("flat with a layer that stiffens", with_layer(flat(&shape(0.5, 20.0), 0, 0), 0.5, 0.3)),
        ("ellipse with a layer that stiffens", with_layer(ellipse(1e-4, 3e-4, 0, 0), 1.0, 0.05)),
    ];
    inputs.into_iter().map(|(name, input)| Contact::new(name, input)).collect()
}
