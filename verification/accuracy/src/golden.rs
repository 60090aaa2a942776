//! The reference against the project's tables of 25 digits.

use crate::real::Real;
use crate::reference::{Given, Law, Reference};
use microslip::{EllipticParameters, Material, Parameters};
use std::collections::HashMap;

type Row = HashMap<String, String>;

pub fn table(name: &str) -> Vec<Row> {
    let path = format!("{}/../../tests/golden/{name}.csv", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap();
    let mut lines = text.lines();
    let names: Vec<String> = lines.next().unwrap().split(',').map(|name| name.trim().to_string()).collect();
    let row = |line: &str| names.iter().cloned().zip(line.split(',').map(|value| value.trim().to_string())).collect();
    lines.filter(|line| !line.trim().is_empty()).map(row).collect()
}

pub fn number(row: &Row, name: &str) -> f64 {
    row[name].parse().unwrap()
}

pub fn contacts() -> Vec<(Row, Reference)> {
    let body =
        |row: &Row, e: &str, nu: &str| Material { young_modulus: number(row, e), poisson_ratio: number(row, nu) };
    let given = |row: &Row| {
        Given::Flat(Parameters {
            flat_half_width: number(row, "a"),
            edge_radius: number(row, "R"),
            length: number(row, "L"),
            normal_force: number(row, "N"),
            friction_coefficient: number(row, "mu"),
            material: [body(row, "E1", "nu1"), body(row, "E2", "nu2")],
            ..Parameters::default()
        })
    };
    table("contacts").into_iter().map(|row| (Reference::new(given(&row)), row)).map(|(one, row)| (row, one)).collect()
}

/// To the 25 digits printed.
pub fn agree(found: &Real, row: &Row, name: &str, place: &str) {
    agree_to(1e-24, found, row, name, place);
}

fn agree_to(tolerance: f64, found: &Real, row: &Row, name: &str, place: &str) {
    if row[name].contains("inf") || row[name].contains("nan") {
        return;
    }
    let expected = Real::parse(256, &row[name]);
    let off = if expected.is_zero() { found.abs().f64() } else { ((found - &expected) / &expected).abs().f64() };
    assert!(off < tolerance, "{name} {place}: off by {off:e}: {} {expected:?}", found.f64());
}

#[test]
fn contact_and_curve() {
    let contacts = contacts();
    for (row, one) in &contacts {
        let law = one.law(0);
        agree(&law.composite_modulus, row, "E_star", "");
        agree(&law.half_width, row, "b", "");
        agree(&law.slip_force, row, "slip_force", "");
        agree(&(&law.displacement_unit * &law.slip_approach), row, "slip_displacement", "");
        agree(&(&law.stiffness_unit / &law.full_stick), row, "initial_stiffness", "");
        agree(&(law.energy_unit() * law.slip_point().energy), row, "slip_energy", "");
    }
    for row in table("monotonic") {
        let (law, point) = contacts[number(&row, "contact") as usize].1.at_force(number(&row, "T"));
        if number(&row, "T") >= law.slip_force.f64() {
            continue;
        }
        let place = format!("{row:?}");
        agree(&(&law.displacement_unit * &point.approach), &row, "displacement", &place);
        agree(&(&point.compliance / &law.stiffness_unit), &row, "compliance", &place);
        agree(&(&law.half_width * &point.size), &row, "stick_half_width", &place);
    }
    for row in table("monotonic_inverse") {
        let near = number(&row, "T") * 1.000001;
        let (law, point) =
            contacts[number(&row, "contact") as usize].1.at_displacement(number(&row, "displacement"), near);
        agree(&(&law.slip_force * &point.tau), &row, "T", &format!("{row:?}"));
    }
    for row in table("energy") {
        let (law, point) = contacts[number(&row, "contact") as usize].1.at_force(number(&row, "T"));
        agree(&(law.energy_unit() * &point.energy), &row, "dissipated_per_cycle", &format!("{row:?}"));
    }
}

#[test]
fn tractions_and_slip() {
    let contacts = contacts();
    for row in table("tractions").into_iter().chain(table("slip")) {
        let one = &contacts[number(&row, "contact") as usize].1;
        let (law, point) = one.at_force_with(number(&row, "T"), 150);
        let x = law.real(number(&row, "x")).abs() / &law.half_width;
        let place = format!("{row:?}");
        if row.contains_key("shear") {
            agree(&(&law.pressure_unit * law.pressure(&x, None)), &row, "pressure", &place);
            if number(&row, "T") == 0.0 {
                continue;
            }
            agree(&(&law.friction * &law.pressure_unit * law.shear(&x, &point)), &row, "shear", &place);
        } else {
            let slip = &law.displacement_unit * law.slip(&x, &point);
            agree(&(&slip * &law.friction * &law.pressure_unit * law.pressure(&x, None)), &row, "damage", &place);
            agree(&slip, &row, "slip", &place);
        }
    }
}

#[test]
fn ellipse() {
    for row in table("elliptic") {
        let body = Material { young_modulus: number(&row, "E"), poisson_ratio: number(&row, "nu") };
        let one = Reference::new(Given::Ellipse(EllipticParameters {
            semi_axis_x: number(&row, "semi_axis_x"),
            semi_axis_y: number(&row, "semi_axis_y"),
            normal_force: number(&row, "N"),
            friction_coefficient: number(&row, "mu"),
            material: [body; 2],
        }));
        let (law, point): (std::rc::Rc<Law>, _) = one.at_force(number(&row, "T"));
        agree(&law.stiffness_unit, &row, "initial_stiffness", "");
        if number(&row, "T") >= law.slip_force.f64() {
            continue;
        }
        agree(&(&law.displacement_unit * &point.approach), &row, "displacement", &format!("{row:?}"));
        agree(&(law.energy_unit() * &point.energy), &row, "dissipated_per_cycle", &format!("{row:?}"));
    }
}

#[test]
fn complex_stiffness() {
    let contacts = contacts();
    let rule = crate::cycle::Quadrature::new(256);
    let mut last = usize::MAX;
    for row in table("complex_stiffness") {
        let number_of = number(&row, "contact") as usize;
        let one = &contacts[number_of].1;
        let amplitude = number(&row, "amplitude");
        let contact = crate::call::prepare(&one.given).unwrap();
        let (law, point) = one.at_displacement(amplitude, crate::call::force(&contact, amplitude)[0]);
        let x = law.real(amplitude) / &law.displacement_unit;
        let energy = law.energy_unit() * crate::cycle::cycle_energy(&law, &x, &point).0;
        agree(&energy, &row, "dissipated_per_cycle", &format!("{row:?}"));
        // Three amplitudes of each contact: a quadrature takes its time.
        if number_of != last || amplitude > 0.5 * contact.slip_displacement {
            let law = one.law(120);
            let x = law.real(amplitude) / &law.displacement_unit;
            let near = crate::call::force(&contact, amplitude)[0] / contact.slip_force;
            if (amplitude / contact.slip_displacement - 1.0).abs() > 1e-6 {
                let real = crate::cycle::real_part(&law, &rule, &x, near) * &law.stiffness_unit;
                // Both are quadratures.
                agree_to(1e-20, &real, &row, "k_real", &format!("{row:?}"));
            }
        }
        last = number_of;
    }
}

#[test]
fn histories() {
    let contacts = contacts();
    let mut last = f64::NAN;
    let mut contact;
    let mut memory: Option<crate::history::Memory> = None;
    for row in table("histories") {
        let one = &contacts[number(&row, "contact") as usize].1;
        let law = one.law(60);
        if number(&row, "history") != last {
            contact = Box::leak(Box::new(crate::call::prepare(&one.given).unwrap()));
            memory = Some(crate::history::Memory::new(law.clone(), contact));
            last = number(&row, "history");
        }
        let memory = memory.as_mut().unwrap();
        memory.go(&(law.real(number(&row, "displacement")) / &law.displacement_unit), 0, false);
        let force = &law.slip_force * &memory.now().force;
        let expected = Real::parse(256, &row["T"]);
        // A force may be small against what it is a sum of.
        let off = ((force - expected) / &law.slip_force).abs().f64();
        assert!(off < 1e-24, "{row:?}: {off:e}");
    }
}

/// The closed forms are the integrals of the paper: Eq. 10, the area of Masing's loop (Eq. 13), the sum of flat punches under a
/// growing load (Eq. 17) and that of their displacements (Eq. 15).
#[test]
fn closed_forms_are_the_integrals() {
    let rule = crate::cycle::Quadrature::new(320);
    for (_, one) in contacts().iter().step_by(3) {
        let law = one.law(150);
        let crate::reference::Shape::Flat(flat) = &law.shape else { panic!() };
        let zero = law.real(0.0);
        for tau in [0.01, 0.5, 0.93] {
            let tau = law.real(tau);
            let point = law.at_load(&tau);
            let way = rule.integrate(&zero, &tau, |t| law.at_load(t).compliance);
            let work = rule.integrate(&zero, &tau, |t| t * law.at_load(t).compliance);
            let close = |found: Real, expected: &Real, what: &str| {
                let off = ((&found - expected) / expected).abs().f64();
                assert!(off < 1e-24, "{what}: {off:e}");
            };
            close(way, &point.approach, "displacement");
            close(8.0 * work - 4.0 * &tau * &point.approach, &point.energy, "energy");
            for share in [0.1, 0.6] {
                // A place between the stick zone's edge and b, and one inside the stick zone.
                let x = &point.size + (1.0 - &point.size) * share;
                let w_x = (x.square() - flat.a.square()).sqrt();
                let slip = rule.integrate(&point.w, &w_x, |w| {
                    let c = (flat.a.square() + w.square()).sqrt();
                    (&x / c).max(&law.real(1.0)).acosh() * w * law.at_w(w).psi
                });
                close(4.0 * slip / &flat.g, &law.slip(&x, &point), "slip");
                let punches = |x: &Real, from: &Real| {
                    let sum = rule.integrate(from, &flat.w, |w| {
                        let zeta = flat.a.square() + w.square() - x.square();
                        // Both ends are roots, where the last digits of the difference do not count.
                        if zeta.is_positive() { w * law.at_w(w).psi / zeta.sqrt() } else { law.real(0.0) }
                    });
                    4.0 / Real::pi(law.bits) * sum / &flat.g
                };
                let x = &point.size * share;
                close(punches(&x, &point.w), &law.shear(&x, &point), "shear");
            }
        }
    }
}
