//! A measured loop of a tribometer, if its file is beside the repository: it is not part of it.

use microslip_fit::{Contact, Geometry, Material, Measurement, NormalForce, Options, Status, fit};
use std::fs;

/// Columns: time \[s\], normal force \[N\], displacement \[µm\], force \[N\].
const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/measured/tribometer_loop_mid.csv");

#[test]
fn a_tribometer_has_friction_that_one_coefficient_does_not_explain() {
    let Ok(text) = fs::read_to_string(FILE) else { return println!("skipped: no file {FILE}") };
    let rows = text.lines().filter(|line| !line.starts_with('#'));
    let rows: Vec<Vec<f64>> = rows.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    let column = |i: usize, unit: f64| rows.iter().map(|row| unit * row[i]).collect::<Vec<_>>();
    let measurement = Measurement {
        name: "tribometer".to_owned(),
        displacement: column(2, 1e-6),
        force: column(3, 1.0),
        normal_force: Some(NormalForce::Samples(column(1, 1.0))),
        time: Some(column(0, 1.0)),
    };
    // Any contact of steel of millimetres: it is a thousand times stiffer than the rig.
    let geometry = Geometry::Flat {
        flat_half_width: 1e-4,
        edge_radius: 5e-2,
        length: 2e-2,
        displacement_reference: microslip_fit::DisplacementReference::RigidStrip,
    };
    let material = [Material { young_modulus: 2e11, poisson_ratio: 0.3 }; 2];
    let contact = Contact { geometry, normal_force: 5.0, friction_coefficient: 0.5, material };
    for contact_compliance in [None, Some(1.0)] {
        let report =
            fit(&contact, std::slice::from_ref(&measurement), &Options { contact_compliance, ..Options::default() })
                .unwrap();
        let (friction, stiffness) = (report.friction_coefficient, 1e-6 / report.total_compliance.value);
        println!("mu {friction:?}, stiffness {stiffness:.4} N/µm, {:?}, {:?}", report.law, report.spring_slider);
        println!("{}", report.verdict.join("\n"));
        // Half the distance between the plateaus is 0.467 of N, the slope of the flanks 0.040 N/µm, read to some percent.
        assert!((friction.lower..=friction.upper.unwrap()).contains(&0.467), "{friction:?}");
        assert!((stiffness / 0.040 - 1.0).abs() < 0.05, "{stiffness}");
        // The force wanders by 6 % on the plateaus, which is more than its scatter between both directions.
        let statuses = [friction.status, report.total_compliance.status, report.shape.unwrap().status];
        assert_eq!(statuses, [Status::NotDetermined; 3]);
        assert!((0.05..0.07).contains(&report.explanation.relative_misfit), "{:?}", report.explanation);
        assert!(report.verdict[0].starts_with("The law does not explain these loops"), "{:?}", report.verdict);
    }
}
