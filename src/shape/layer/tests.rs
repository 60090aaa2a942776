use super::*;
use crate::constant_load::contact::tests::{FLATS, TITANIUM, parameters};
use crate::parameters::EllipticParameters;
use crate::shape::{HertzEllipse, RoundedFlat};
use std::vec::Vec;

/// Compliances in units of those of the contact, and N_c in units of the normal force: linear, hardly and strongly stiffening, and in
/// one direction only.
const LAYERS: [[f64; 3]; 5] =
    [[0.3, 0.3, 0.0], [3.0, 2.0, f64::INFINITY], [1.0, 1.0, 0.3], [0.0, 3.0, 1e-3], [100.0, 30.0, 0.01]];

/// A layer of the parameters with compliances in units of those of a shape under a load of 150 N.
fn layer_of(shape: &dyn Shape, [normal, tangential, ratio]: [f64; 3]) -> parameters::Layer {
    let w = shape.at_load(150.0);
    parameters::Layer {
        normal_compliance: normal * shape.compliance(Quantity::Approach, w),
        tangential_compliance: tangential * shape.compliance(Quantity::Shift, w),
        stiffening_load: ratio * 150.0,
        reference_load: 0.0,
    }
}

fn with_layers<S: Shape + Copy + 'static>(shape: S) -> impl Iterator<Item = std::boxed::Box<dyn Shape>> {
    LAYERS.into_iter().chain([[0.0; 3]]).map(move |layer| {
        let layer = Layer::new(&layer_of(&shape, layer), 150.0).unwrap().0;
        std::boxed::Box::new(Layered { shape, layer }) as std::boxed::Box<dyn Shape>
    })
}

/// The shapes of all kinds, each with all layers.
fn shapes() -> Vec<std::boxed::Box<dyn Shape>> {
    let ellipse = EllipticParameters {
        semi_axis_x: 1e-4,
        semi_axis_y: 2e-4,
        normal_force: 150.0,
        friction_coefficient: 0.4,
        material: [TITANIUM; 2],
        ..EllipticParameters::default()
    };
    let flats = FLATS.into_iter().map(|flat| RoundedFlat::new(&parameters(flat)).unwrap());
    flats.flat_map(with_layers).chain(with_layers(HertzEllipse::new(&ellipse).unwrap())).collect()
}

/// The logarithms and their series for a small argument, on both sides of the place where one takes over.
#[test]
fn logarithms_join_their_series() {
    let layer = Layer { normal: 0.0, tangential: 1.0, stiffening: 0.4 };
    let joins = |ratio: &dyn Fn(f64) -> f64| {
        let [below, above] = [1.0 - 1e-12, 1.0 + 1e-12].map(|part| ratio(part * 1e-8 / layer.stiffening));
        assert!((above / below - 1.0).abs() < 1e-15, "{below:e} {above:e}");
    };
    joins(&|load| layer.extent(load) / load);
    joins(&|extent| layer.load_of_extent(extent) / extent);
}

/// A ninth of the argument beside the middle, as in the tables.
#[test]
fn series_are_the_functions() {
    for shape in shapes() {
        for load in [1e-3, 0.1, 1.0, 30.0, 150.0] {
            let sizes = [load, 1.05 * load].map(|load| shape.at_load(load));
            for argument in Quantity::ALL {
                let [x, other] = sizes.map(|w| shape.value(argument, w));
                for (quantity, series) in Quantity::ALL.into_iter().zip(shape.series(sizes[0], argument)) {
                    let sum = series.iter().rev().fold(0.0, |sum, term| sum * (other / x - 1.0) + term);
                    let error = sum / shape.value(quantity, sizes[1]) - 1.0;
                    // The argument has rounding errors, of which one enters with the power of a nearly flat contact.
                    assert!(error.abs() < 1e-14, "{load} {quantity:?} of {argument:?}: {error}");
                }
            }
        }
    }
}

#[test]
fn remainders_have_no_cancellation() {
    for k in -30..=3 {
        let x = 10f64.powi(k);
        // ∫ t/(1 + t x) dt, t from 0 to 1, is the remainder.
        let panels = |f: &dyn Fn(f64) -> f64| -> f64 {
            (0..256).map(|i| crate::numerics::quadrature::gauss(1.0 / 256.0, |t| f(f64::from(i) / 256.0 + t))).sum()
        };
        let exact = panels(&|t| t / (1.0 + t * x));
        assert!((logarithm_remainder(x) / exact - 1.0).abs() < 4e-15, "{x}");
    }
    for z in [0.0, 1e-9, 0.1, 0.3, 0.5_f64] {
        let exact = if z > 0.05 { (z.atanh() - z) / (z * z * z) } else { 1.0 / 3.0 + z * z / 5.0 };
        assert!((artanh_remainder(z) / exact - 1.0).abs() < 3e-14, "{z}");
    }
}
