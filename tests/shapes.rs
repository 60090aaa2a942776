//! Shapes in absolute terms against 25-digit values of the normal law: force, approach, size and tangential shift of one size, from
//! the force or from the approach.

use microslip::shape::{HertzEllipse, RoundedFlat, Shape};
use microslip::{EllipticParameters, Material, Parameters};

/// Relative errors of a shape at one row: half-width, the other of force and approach, shift, stiffness dN/dU, dS/dU.
fn errors(shape: &dyn Shape, row: &[f64; 6], given_load: bool) -> [f64; 5] {
    let [load, approach, size, shift, stiffness, ratio] = *row;
    let w = if given_load { shape.at_load(load) } else { shape.at_approach(approach) };
    let other = if given_load { shape.approach(w) / approach } else { shape.load(w) / load };
    let (normal, tangential) = (shape.normal_compliance(w), shape.tangential_compliance(w));
    [shape.half_width(w) / size, other, shape.shift(w) / shift, 1.0 / normal / stiffness, tangential / normal / ratio]
        .map(|quotient| (quotient - 1.0).abs())
}

#[test]
fn normal_law_and_tangential_shift() {
    let table = std::fs::read_to_string("tests/golden/normal_law.csv").unwrap();
    let (mut rows, mut worst) = (0, [0.0_f64; 5]);
    for line in table.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let value = |i: usize| -> f64 { fields[i].parse().unwrap() };
        let material = [(7, 8), (9, 10)].map(|(e, nu)| Material { young_modulus: value(e), poisson_ratio: value(nu) });
        let row = [12, 13, 14, 15, 16, 17].map(value);
        let given_load = fields[11] == "N";
        let errors = if value(4).is_nan() {
            let parameters = Parameters {
                flat_half_width: value(1),
                edge_radius: value(2),
                length: value(3),
                normal_force: row[0],
                friction_coefficient: 0.3,
                material,
                ..Parameters::default()
            };
            errors(&RoundedFlat::new(&parameters).unwrap(), &row, given_load)
        } else {
            let parameters = EllipticParameters {
                semi_axis_x: value(4),
                semi_axis_y: value(5),
                normal_force: value(6),
                friction_coefficient: 0.3,
                material,
            };
            errors(&HertzEllipse::new(&parameters).unwrap(), &row, given_load)
        };
        rows += 1;
        for (worst, error) in worst.iter_mut().zip(errors) {
            *worst = worst.max(error);
        }
        // A dozen roundings each; a force from its approach has up to 3/2 of the relative error of that.
        assert!(errors.iter().all(|error| *error < 4e-15), "{line}: {errors:?}");
    }
    assert!(rows > 100, "{rows} rows, worst {worst:?}");
}
