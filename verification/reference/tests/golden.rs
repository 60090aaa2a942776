//! The reference against the tables of 25 digits, which an independent program has computed, and against its own limits.

#[path = "../../../tests/golden/table.rs"]
mod table;

use microslip::{EllipticParameters, Layer, Material, Parameters};
use reference::element::Element;
use reference::family::{Family, Given};
use reference::harmonic::sampled;
use reference::history::History;
use reference::stiffness::{cycle_energy, imaginary_part, real_part};
use reference::{Input, Real, Reference};
use table::{Row, ellipse, flat, geometry, table};

fn contacts() -> Vec<Reference> {
    table("contacts").iter().map(|row| Reference::new(Input::Flat(flat(row)))).collect()
}

/// The contact of a row.
fn of<'a>(contacts: &'a [Reference], row: &Row) -> &'a Reference {
    &contacts[row["contact"] as usize]
}

/// Compares with all digits of a cell.
fn exact(row: &Row, found: &[(&str, &Real)]) {
    agree(1e-24, row, found, None);
}

/// Compares with all digits of a cell, or with fewer of a quadrature's, on the scale of the value or of a larger one.
fn agree(tolerance: f64, row: &Row, found: &[(&str, &Real)], scale: Option<&Real>) {
    for (name, found) in found {
        if !row[name].is_finite() {
            continue;
        }
        let expected = Real::parse(256, row.text(name));
        let scale = scale.unwrap_or(if expected.is_zero() { found } else { &expected });
        let off = if found.is_zero() { expected.abs().f64() } else { ((*found - &expected) / scale).abs().f64() };
        assert!(off < tolerance, "{name}: off by {off:e}: {}, {row:?}", found.f64());
    }
}

#[test]
fn contact_and_curve() {
    for row in table("contacts") {
        let law = Reference::new(Input::Flat(flat(&row))).law(0);
        let found = [
            ("E_star", &law.composite_modulus),
            ("b", &law.half_width),
            ("slip_force", &law.slip_force),
            ("slip_displacement", &(&law.displacement_unit * &law.x_slip)),
            ("initial_stiffness", &(&law.stiffness_unit / &law.full_stick)),
            ("slip_energy", &(law.energy_unit() * law.slip_point().energy)),
        ];
        exact(&row, &found);
    }
    let contacts = contacts();
    for row in table("monotonic") {
        let (law, point) = of(&contacts, &row).at_force(row["T"]);
        if !point.slips() {
            let found = [
                ("displacement", &(&law.displacement_unit * &point.x)),
                ("compliance", &(&point.compliance / &law.stiffness_unit)),
                ("stick_half_width", &(&law.half_width * &point.size)),
            ];
            exact(&row, &found);
        }
    }
    for row in table("monotonic_inverse") {
        let (law, point) = of(&contacts, &row).at_displacement(row["displacement"]);
        exact(&row, &[("T", &(&law.slip_force * &point.tau))]);
    }
    for row in table("energy") {
        let (law, point) = of(&contacts, &row).at_force(row["T"]);
        exact(&row, &[("dissipated_per_cycle", &(law.energy_unit() * &point.energy))]);
    }
    for row in table("elliptic") {
        let (law, point) = Reference::new(Input::Ellipse(ellipse(&row))).at_force(row["T"]);
        exact(&row, &[("initial_stiffness", &law.stiffness_unit)]);
        if !point.slips() {
            let displacement = &law.displacement_unit * &point.x;
            let energy = law.energy_unit() * &point.energy;
            exact(&row, &[("displacement", &displacement), ("dissipated_per_cycle", &energy)]);
        }
    }
}

#[test]
fn tractions_and_slip() {
    let contacts = contacts();
    for row in table("tractions").into_iter().chain(table("slip")) {
        let (law, point) = of(&contacts, &row).at_force_with(row["T"], 150);
        let x = law.real(row["x"]).abs() / &law.half_width;
        let pressure = &law.pressure_unit * law.pressure(&x, None);
        let shear_unit = &law.friction * &law.pressure_unit;
        if row.has("slip") {
            let slip = &law.displacement_unit * law.slip(&x, &point);
            let damage = &slip * &law.friction * pressure;
            exact(&row, &[("slip", &slip), ("damage", &damage)]);
            continue;
        }
        exact(&row, &[("pressure", &pressure)]);
        if row["T"] != 0.0 {
            exact(&row, &[("shear", &(shear_unit * law.shear(&x, &point)))]);
        }
    }
}

#[test]
fn complex_stiffness_and_energy() {
    let contacts = contacts();
    for row in table("complex_stiffness") {
        let (law, point) = of(&contacts, &row).at_displacement(row["amplitude"]);
        let x = law.x(row["amplitude"]);
        let energy = law.energy_unit() * cycle_energy(&law, &x, &point).0;
        exact(&row, &[("dissipated_per_cycle", &energy)]);
        // Both are quadratures.
        let share = (&x / &law.x_slip).f64();
        if share > 0.4 && (share - 1.0).abs() > 1e-6 {
            let ([real, d_real], [imaginary, d_imaginary]) =
                (real_part(of(&contacts, &row), &x), imaginary_part(&law, &x, &point));
            let [real, imaginary] = [real, imaginary].map(|part| &law.stiffness_unit * part);
            let [d_real, d_imaginary] =
                [d_real, d_imaginary].map(|slope| &law.stiffness_unit / &law.displacement_unit * slope);
            agree(1e-20, &row, &[("k_real", &real), ("k_imag", &imaginary)], None);
            let scale = &real / row["amplitude"];
            agree(1e-19, &row, &[("dk_real", &d_real), ("dk_imag", &d_imaginary)], Some(&scale));
        }
    }
}

#[test]
fn histories_and_harmonics() {
    let contacts = contacts();
    let mut last = f64::NAN;
    let mut history = History::new(contacts[0].law(60));
    for row in table("histories") {
        if row["history"] != last {
            history = History::new(of(&contacts, &row).law(60));
            last = row["history"];
        }
        history.go(&history.law.x(row["displacement"]), 0);
        let slip_force = &history.law.slip_force;
        agree(1e-24, &row, &[("T", &(slip_force * &history.force()[0]))], Some(slip_force));
    }
    for row in table("harmonic_force").iter().step_by(4) {
        let column = |kind, k| format!("{kind}{k}");
        let law = of(&contacts, row).law(50);
        let u: Vec<Real> = (0..7).map(|k| law.x(row[&column("u", k)])).collect();
        for (k, force) in sampled(&law, &u, row["samples"] as usize, |_| ()).force.iter().enumerate() {
            agree(1e-24, row, &[(&column("f", k), &(force * &law.slip_force))], Some(&law.slip_force));
        }
    }
}

/// The shape of a row of the tables of a varying load, whose functions do not depend on the load of the parameters.
fn shape(row: &Row) -> Input {
    let body = |e, nu| Material { young_modulus: row[e], poisson_ratio: row[nu] };
    let material = [body("E1", "nu1"), body("E2", "nu2")];
    let friction_coefficient = if row.has("mu") { row["mu"] } else { 0.5 };
    let layer = if row.has("c_t") {
        let [normal_compliance, tangential_compliance, stiffening_load, reference_load] =
            ["c_n", "c_t", "N_c", "N_layer"].map(|name| row[name]);
        Layer { normal_compliance, tangential_compliance, stiffening_load, reference_load }
    } else {
        Layer::none()
    };
    if row["a"].is_nan() {
        let [semi_axis_x, semi_axis_y, normal_force] = ["semi_x", "semi_y", "N_ref"].map(|name| row[name]);
        Input::Ellipse(EllipticParameters {
            semi_axis_x,
            semi_axis_y,
            normal_force,
            friction_coefficient,
            material,
            layer,
        })
    } else {
        Input::Flat(Parameters { normal_force: row["N"], friction_coefficient, material, layer, ..geometry(row) })
    }
}

#[test]
fn normal_law() {
    let rows = ["normal_law", "layer_normal_law"].map(table).into_iter().flatten();
    for row in rows.filter(|row| row["N"] > 0.0) {
        let row = &row;
        let family = Family::new(&shape(row));
        let (given, value) = if row.text("given") == "N" { (Given::Load, "N") } else { (Given::Approach, "u_n") };
        let size = family.find(given, &family.real(row[value]));
        let other = if given == Given::Load { ("u_n", &size.approach) } else { ("N", &size.load) };
        let found = [
            other,
            ("size", &size.half_width),
            ("tangential_approach", &size.shift),
            ("dN_dun", &(1.0 / &size.normal_compliance)),
            ("dS_dun", &(&size.tangential_compliance / &size.normal_compliance)),
        ];
        agree(2e-24, row, &found, None);
        for (given, value) in [(Given::Approach, &size.approach), (Given::Shift, &size.shift)] {
            let back = family.find(given, value);
            let off = ((&back.load - &size.load) / &size.load).abs().f64();
            assert!(off < 1e-60, "{given:?} of a load: {off:e}");
        }
    }
}

/// Histories under a varying load; tangents except at corners, where the table has none.
#[test]
fn varying_load() {
    let tables = ["varying_load", "layer_varying_load"].map(table);
    for history in tables.iter().flat_map(|rows| rows.chunk_by(|one, other| one["history"] == other["history"])) {
        let largest = |name: &str| history.iter().map(|row| row[name].abs()).fold(0.0, f64::max);
        let heaviest = history.iter().max_by(|one, other| one["N"].total_cmp(&other["N"])).unwrap();
        let by_force = history[0].text("control") == "N";
        let element = Element::new(&shape(heaviest), by_force);
        let mut state = element.open();
        let slip_force = &element.family.friction * largest("N");
        let energy = &slip_force * largest("delta");
        for row in history {
            let input = element.real(row[if by_force { "N" } else { "u_n" }]);
            let step = element.step(&mut state, &element.real(row["delta"]), &input);
            if !by_force {
                agree(1e-24, row, &[("N", &step.load)], Some(&element.real(largest("N"))));
            }
            agree(1e-24, row, &[("T", &step.force)], Some(&slip_force));
            agree(1e-23, row, &[("dissipated", &step.dissipated), ("stored", &element.stored(&state))], Some(&energy));
            let by_approach = if by_force { &step.tangent[1] * row["dN_dun"] } else { step.tangent[1].clone() };
            let stiffness = element.real(row["dN_dun"].max(row["dT_ddelta"]));
            let scale = (!stiffness.is_zero()).then_some(&stiffness);
            agree(1e-15, row, &[("dT_dun", &by_approach)], scale); // dN_dun as a double
            agree(2e-21, row, &[("dT_ddelta", &step.tangent[0])], scale);
        }
    }
}
