//! Shapes in absolute terms against 25-digit values of the normal law: force, approach, size and tangential shift of one size, from
//! the force or from the approach.

#[path = "golden/table.rs"]
mod table;

use microslip::shape::{HertzEllipse, RoundedFlat, Shape};
use microslip::{EllipticParameters, Material, Parameters};
use table::{Row, table};

/// Relative errors of a shape at one row: half-width, the other of force and approach, shift, stiffness dN/dU, dS/dU.
fn errors(shape: &dyn Shape, row: &Row) -> [f64; 5] {
    let given_load = row.text("given") == "N";
    let w = if given_load { shape.at_load(row["N"]) } else { shape.at_approach(row["u_n"]) };
    let other = if given_load { shape.approach(w) / row["u_n"] } else { shape.load(w) / row["N"] };
    let (normal, tangential) = (shape.normal_compliance(w), shape.tangential_compliance(w));
    [
        shape.half_width(w) / row["size"],
        other,
        shape.shift(w) / row["tangential_approach"],
        1.0 / normal / row["dN_dun"],
        tangential / normal / row["dS_dun"],
    ]
    .map(|quotient| (quotient - 1.0).abs())
}

#[test]
fn normal_law_and_tangential_shift() {
    let rows = table("normal_law");
    assert!(rows.len() > 100);
    for row in rows {
        let body = |e, nu| Material { young_modulus: row[e], poisson_ratio: row[nu] };
        let material = [body("E1", "nu1"), body("E2", "nu2")];
        let friction_coefficient = 0.3;
        let errors = if row["semi_x"].is_nan() {
            let parameters =
                Parameters { normal_force: row["N"], friction_coefficient, material, ..table::geometry(&row) };
            errors(&RoundedFlat::new(&parameters).unwrap(), &row)
        } else {
            let [semi_axis_x, semi_axis_y, normal_force] = ["semi_x", "semi_y", "N_ref"].map(|name| row[name]);
            let parameters = EllipticParameters {
                semi_axis_x,
                semi_axis_y,
                normal_force,
                friction_coefficient,
                material,
                ..EllipticParameters::default()
            };
            errors(&HertzEllipse::new(&parameters).unwrap(), &row)
        };
        // A dozen roundings each; a force from its approach has up to 3/2 of the relative error of that.
        assert!(errors.iter().all(|error| *error < 4e-15), "{row:?}: {errors:?}");
    }
}
