//! Every row of the reference tables (inputs exact doubles, outputs 25 digits) through the Rust interface.

use microslip::{Contact, EllipticParameters, Error, Material, Parameters};
use std::collections::HashMap;

type Row = HashMap<String, f64>;

fn table(name: &str) -> Vec<Row> {
    let path = format!("{}/tests/golden/{name}.csv", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let mut lines = text.lines();
    let names: Vec<String> = lines.next().unwrap().split(',').map(|name| name.trim().to_string()).collect();
    let row = |line: &str| {
        let values = line.split(',').map(|value| value.trim().parse::<f64>().unwrap_or(f64::NAN));
        names.iter().cloned().zip(values).collect()
    };
    lines.filter(|line| !line.trim().is_empty()).map(row).collect()
}

fn contacts() -> Vec<(Row, Contact)> {
    table("contacts")
        .into_iter()
        .map(|row| {
            let body = |e: &str, nu: &str| Material { young_modulus: row[e], poisson_ratio: row[nu] };
            let parameters = Parameters {
                flat_half_width: row["a"],
                edge_radius: row["R"],
                length: row["L"],
                normal_force: row["N"],
                friction_coefficient: row["mu"],
                material: [body("E1", "nu1"), body("E2", "nu2")],
                ..Parameters::default()
            };
            let contact = Contact::rounded_flat(&parameters).unwrap();
            (row, contact)
        })
        .collect()
}

/// The worst relative error seen, and where; a bound given with its reason.
struct Worst {
    what: &'static str,
    bound: f64,
    seen: f64,
    place: String,
    rows: usize,
}

impl Worst {
    fn new(what: &'static str, bound: f64) -> Worst {
        Worst { what, bound, seen: 0.0, place: String::new(), rows: 0 }
    }

    fn check(&mut self, place: &str, computed: f64, expected: f64, scale: f64) {
        self.rows += 1;
        let error = if computed == expected { 0.0 } else { (computed - expected).abs() / scale };
        // Written so that a NaN counts.
        if !(error <= self.seen) {
            self.seen = error;
            self.place = format!("{place}: {computed:e}, expected {expected:e}");
        }
    }

    fn relative(&mut self, place: &str, computed: f64, expected: f64) {
        self.check(place, computed, expected, expected.abs());
    }

    fn report(self) {
        println!("{:28} {:5} rows, worst {:.1e} (bound {:.0e}) at {}", self.what, self.rows, self.seen, self.bound, self.place);
        assert!(self.rows > 0 && self.seen <= self.bound, "{}: {:e} at {}", self.what, self.seen, self.place);
    }
}

#[test]
fn contacts_are_sized() {
    for (name, value) in [
        ("E_star", (|c| c.composite_modulus) as fn(&Contact) -> f64),
        ("b", |c| c.half_width),
        ("slip_force", |c| c.slip_force),
        ("slip_displacement", |c| c.slip_displacement),
        ("initial_stiffness", |c| c.initial_stiffness),
        ("slip_energy", |c| c.slip_energy),
    ] {
        let mut worst = Worst::new(name, 1e-13);
        for (row, contact) in contacts() {
            worst.relative(&format!("contact {}", row["contact"]), value(&contact), row[name]);
        }
        worst.report();
    }
}

#[test]
fn monotonic_curve() {
    let contacts = contacts();
    let mut displacement = Worst::new("displacement", 1e-13);
    let mut compliance = Worst::new("compliance", 1e-13);
    let mut stick = Worst::new("stick half-width", 1e-13);
    for row in table("monotonic") {
        let (parameters, contact) = &contacts[row["contact"] as usize];
        let point = contact.curve_at_force(row["T"]).unwrap();
        let place = format!("contact {} T/muN {}", row["contact"], row["T"] / contact.slip_force);
        displacement.relative(&place, point.displacement(), row["displacement"]);
        // Near mu N both follow 1 - tau, which carries the rounding of T and of mu N themselves: three units.
        let rest = 1.0 - row["T"] / contact.slip_force;
        if rest.abs() > 1e-15 {
            let conditioning = 1.0 + 1e-13_f64.recip() * 4.0 * f64::EPSILON / rest;
            compliance.check(&place, point.compliance(), row["compliance"], row["compliance"].abs() * conditioning);
            stick.check(&place, point.stick_half_width(), row["stick_half_width"], parameters["b"] * conditioning);
        }
    }
    displacement.report();
    compliance.report();
    stick.report();
}

#[test]
fn monotonic_inverse() {
    let contacts = contacts();
    let mut force = Worst::new("force", 1e-13);
    for row in table("monotonic_inverse") {
        let (_, contact) = &contacts[row["contact"] as usize];
        let point = contact.curve_at_displacement(row["displacement"]).unwrap();
        let place = format!("contact {} d/dslip {}", row["contact"], row["displacement"] / contact.slip_displacement);
        force.relative(&place, point.force(), row["T"]);
    }
    force.report();
}

#[test]
fn tractions() {
    let contacts = contacts();
    let mut pressure = Worst::new("pressure", 1e-11);
    let mut shear = Worst::new("shear", 1e-11);
    for row in table("tractions") {
        let (parameters, contact) = &contacts[row["contact"] as usize];
        let point = contact.curve_at_force(row["T"]).unwrap();
        let x = row["x"];
        let place = format!("contact {} T/muN {} x/b {}", row["contact"], row["T"] / contact.slip_force, x / parameters["b"]);
        // At the very edge the pressure goes with the root of b - x, and carries the rounding of x and b.
        let edge = 1.0 + 4.0 * f64::EPSILON / (1.0 - x.abs() / parameters["b"]).abs().max(1e-17) / 1e-11;
        pressure.check(&place, contact.pressure(x), row["pressure"], row["pressure"].abs().max(1e-300) * edge);
        let peak = parameters["mu"] * contact.pressure(0.0);
        shear.check(&place, point.shear(x), row["shear"], peak * edge);
    }
    pressure.report();
    shear.report();
}

#[test]
fn slip_and_damage() {
    let contacts = contacts();
    let mut slip = Worst::new("slip", 1e-10);
    for row in table("slip") {
        let (parameters, contact) = &contacts[row["contact"] as usize];
        let point = contact.curve_at_force(row["T"]).unwrap();
        let place = format!("contact {} T/muN {} x/b {}", row["contact"], row["T"] / contact.slip_force, row["x"] / parameters["b"]);
        slip.check(&place, point.slip(row["x"]).unwrap(), row["slip"], row["slip"].abs());
    }
    slip.report();
}

#[test]
fn energy() {
    let contacts = contacts();
    let mut energy = Worst::new("energy", 1e-13);
    for row in table("energy") {
        let (_, contact) = &contacts[row["contact"] as usize];
        let place = format!("contact {} T/muN {}", row["contact"], row["T"] / contact.slip_force);
        energy.relative(&place, contact.dissipated_energy(row["T"]).unwrap(), row["dissipated_per_cycle"]);
    }
    energy.report();
}

#[test]
fn complex_stiffness() {
    let contacts = contacts();
    let mut real = Worst::new("K'", 1e-13);
    let mut imaginary = Worst::new("K''", 1e-13);
    let mut real_slope = Worst::new("dK'", 1e-12);
    let mut imaginary_slope = Worst::new("dK''", 1e-12);
    let mut dissipated = Worst::new("dissipated", 1e-13);
    for row in table("complex_stiffness") {
        let (_, contact) = &contacts[row["contact"] as usize];
        let amplitude = row["amplitude"];
        let place = format!("contact {} d/dslip {}", row["contact"], amplitude / contact.slip_displacement);
        let stiffness = contact.complex_stiffness(amplitude).unwrap();
        real.relative(&place, stiffness.real(), row["k_real"]);
        imaginary.relative(&place, stiffness.imaginary(), row["k_imag"]);
        dissipated.relative(&place, stiffness.dissipated(), row["dissipated_per_cycle"]);
        let scale = row["k_real"].hypot(row["k_imag"]) / amplitude;
        if row["dk_real"].is_finite() {
            real_slope.check(&place, stiffness.real_slope(), row["dk_real"], scale);
        }
        if row["dk_imag"].is_finite() {
            imaginary_slope.check(&place, stiffness.imaginary_slope(), row["dk_imag"], scale);
        }
    }
    real.report();
    imaginary.report();
    dissipated.report();
    real_slope.report();
    imaginary_slope.report();
}

#[test]
fn elliptic_contacts() {
    let mut stiffness = Worst::new("elliptic stiffness", 1e-13);
    let mut displacement = Worst::new("elliptic displacement", 1e-13);
    let mut energy = Worst::new("elliptic energy", 1e-13);
    for row in table("elliptic") {
        let body = Material { young_modulus: row["E"], poisson_ratio: row["nu"] };
        let parameters = EllipticParameters {
            semi_axis_x: row["semi_axis_x"],
            semi_axis_y: row["semi_axis_y"],
            normal_force: row["N"],
            friction_coefficient: row["mu"],
            material: [body, body],
        };
        let contact = Contact::elliptic(&parameters).unwrap();
        let place = format!("case {} T/muN {}", row["case"], row["T"] / contact.slip_force);
        stiffness.relative(&place, contact.initial_stiffness, row["initial_stiffness"]);
        let point = contact.curve_at_force(row["T"]).unwrap();
        displacement.relative(&place, point.displacement(), row["displacement"]);
        energy.relative(&place, contact.dissipated_energy(row["T"]).unwrap(), row["dissipated_per_cycle"]);
        assert_eq!(point.slip(0.0), Err(Error::NotAvailable));
    }
    stiffness.report();
    displacement.report();
    energy.report();
}
