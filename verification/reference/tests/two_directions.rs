//! The slow reference of two directions: energies of circles by another program of the same equations, paths by boundary elements, and lines
//! under a varying load by the law of one direction in multi-precision.

#[path = "../../../tests/golden/table.rs"]
mod table;

use microslip::parameters::CENTRE_POINT;
use microslip::{EllipticParameters, Material, Parameters};
use reference::Input;
use reference::element::Element;
use reference::two_directions::Contact;
use std::f64::consts::TAU;

const BODY: Material = Material { young_modulus: 2e11, poisson_ratio: 0.3 };

/// b = 0.5 mm, 2L/b = 13, a/b.
fn flat(ratio: f64) -> Parameters {
    let (b, edge_radius) = (5e-4, 1e-2);
    let (flat_half_width, length) = (ratio * b, 6.5 * b);
    let modulus = 0.5 * BODY.young_modulus / (1.0 - BODY.poisson_ratio.powi(2));
    let area = b * b * ratio.acos() - flat_half_width * (b * b - flat_half_width * flat_half_width).sqrt();
    Parameters {
        flat_half_width,
        edge_radius,
        length,
        normal_force: modulus * length / (2.0 * edge_radius) * area,
        friction_coefficient: 0.5,
        displacement_reference: CENTRE_POINT,
        material: [BODY; 2],
        ..Parameters::default()
    }
}

fn sphere() -> EllipticParameters {
    let mut sphere = EllipticParameters { semi_axis_x: 5e-4, semi_axis_y: 5e-4, ..EllipticParameters::default() };
    (sphere.normal_force, sphere.friction_coefficient, sphere.material) = (100.0, 0.5, [BODY; 2]);
    sphere
}

/// Energies over mu N times the displacement of gross slip, by a program with means of the tractions over rings in place of points; with
/// points its energies differ by up to 0.4 %.
#[test]
fn circles() {
    for (ratio, radius, energy) in
        [(0.0, 0.3, 0.018_767), (0.001, 0.6, 0.1747), (0.5, 0.6, 0.082_978), (0.97, 0.3, 5.3304e-4)]
    {
        let parameters = flat(ratio);
        let load = parameters.normal_force;
        let contact = Contact::new(&Input::Flat(parameters), load, 60);
        let slip = 0.5 * contact.shift(load);
        let entry = (0..=12).map(|i| [radius * slip * f64::from(i) / 12.0, 0.0, load]);
        let orbits = (1..=192).map(|i| (TAU * f64::from(i) / 96.0).sin_cos());
        let path: Vec<[f64; 3]> =
            entry.chain(orbits.map(|(sin, cos)| [radius * slip * cos, radius * slip * sin, load])).collect();
        let points = contact.solve(&path, 1);
        let found = points[points.len() - 96..].iter().map(|point| point.dissipated).sum::<f64>() / (0.5 * load * slip);
        assert!((found / energy - 1.0).abs() < 4e-3, "a/b {ratio}, circle {radius}: {found:e}, not {energy:e}");
    }
}

/// Along x the law is that of one direction: the error is that of N(S) as a polygon between 120 nodes.
#[test]
fn lines() {
    for input in [Input::Flat(flat(0.0)), Input::Flat(flat(0.5)), Input::Ellipse(sphere())] {
        let (Input::Flat(Parameters { normal_force, .. }) | Input::Ellipse(EllipticParameters { normal_force, .. })) =
            input;
        let (contact, element) = (Contact::new(&input, normal_force, 120), Element::new(&input, true));
        let slip = 0.5 * contact.shift(normal_force);
        let place = |i: u32| {
            let t = 0.37 * f64::from(i);
            [slip * (0.6 * t.sin() + 0.3 * (0.6 * t).sin()), 0.0, normal_force * (0.525 + 0.475 * (1.7 * t).cos())]
        };
        let path: Vec<[f64; 3]> = (0..60).map(place).collect();
        let mut state = element.open();
        let mut energies = [0.0; 2];
        let mut step = |[u, _, load]: [f64; 3]| {
            let step = element.step(&mut state, &element.real(u), &element.real(load));
            [step.force.f64(), step.dissipated.f64()]
        };
        step([path[0][0], 0.0, 0.0]);
        step(path[0]);
        for (place, point) in path[1..].iter().zip(contact.solve(&path, 4)) {
            let [force, dissipated] = step(*place);
            let error = (point.force[0] - force).hypot(point.force[1]) / (0.5 * normal_force);
            assert!(error < 1e-4, "force {:e}, not {force:e}, error {error:.1e}", point.force[0]);
            energies = [energies[0] + point.dissipated, energies[1] + dissipated];
        }
        assert!((energies[0] / energies[1] - 1.0).abs() < 2e-3, "{energies:?}");
    }
}

/// Paths of a cylinder by boundary elements, whose error is up to 2e-3 μN, and 5e-3 of the energy.
#[test]
fn boundary_elements() {
    for name in ["circle0.6", "Lpath", "circle0.4_nearseparation"] {
        let of = |row: &table::Row| row.text("path") == name && row["a"] == 0.0;
        let rows: Vec<table::Row> = table::table("two_directions").into_iter().filter(of).collect();
        let normal_force = rows.iter().map(|row| row["N"]).fold(0.0, f64::max);
        let body = Material { young_modulus: rows[0]["E"], poisson_ratio: rows[0]["nu"] };
        let friction_coefficient = rows[0]["mu"];
        let parameters =
            Parameters { normal_force, friction_coefficient, material: [body; 2], ..table::geometry(&rows[0]) };
        let contact = Contact::new(&Input::Flat(parameters), normal_force, 60);
        let path: Vec<[f64; 3]> = rows.iter().map(|row| ["u", "v", "N"].map(|name| row[name])).collect();
        let mut energies = [0.0; 2];
        for (row, point) in rows[1..].iter().zip(contact.solve(&path, 4)) {
            let [x, y] = [row["Tx"] - point.force[0], row["Ty"] - point.force[1]];
            let error = x.hypot(y) / (friction_coefficient * normal_force);
            assert!(error < 5e-4, "{name}: force {:?}, error {error:.1e}", point.force);
            energies = [energies[0] + point.dissipated, energies[1] + row["dissipated"]];
        }
        assert!((energies[0] / energies[1] - 1.0).abs() < 5e-3, "{name}: {energies:?}");
    }
}
