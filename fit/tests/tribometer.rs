//! A measured loop of a pin on a disc, if its file is present beside the repository; it is not part of it.

mod common;
use common::*;
use microslip_fit::*;

#[test]
fn tribometer() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/measured/tribometer_loop_mid.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let rows: Vec<Vec<f64>> = text.lines().filter(|line| !line.starts_with('#')).map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    let column = |i: usize, factor: f64| rows.iter().map(|row| row[i] * factor).collect::<Vec<f64>>();
    let measurement = Measurement { name: "tribometer".into(), displacement: column(2, 1e-6), force: column(3, 1.0), normal_force: Some(NormalForce::Samples(column(1, 1.0))), time: Some(column(0, 1.0)) };
    for (geometry, options) in [(Geometry::Ellipse { semi_axis_x: 0.05e-3, semi_axis_y: 0.05e-3 }, Options::default()), (flat().geometry, Options::default()), (flat().geometry, Options { contact_compliance: Some(1.0), ..Options::default() })] {
        let contact = Contact { geometry, normal_force: 5.0, ..flat() };
        let started = std::time::Instant::now();
        let report = match fit(&contact, &[measurement.clone()], &options) { Ok(r) => r, Err(e) => { println!("{e}"); continue } };
        println!("\n{:?}", started.elapsed());
        println!("mu {:?}\n1/C {:e} N/m {:?}\nkappa {:?}\nshape {:?}", report.friction_coefficient, 1.0/report.series_compliance.value, report.series_compliance, report.contact_compliance, report.shape);
        println!("{:?}\n{:?}", report.law, report.spring_slider);
        for p in &report.profile { println!("  {:.3} {:.5} {}", p.shape, p.relative_rms, p.admitted); }
        println!("{:#?} {:?}", report.verdict, report.warnings);
        println!("{}", report.contact_toml);
    }
}
