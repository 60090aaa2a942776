//! The law under a varying normal force: reference histories, and the properties that it must have.

mod common;
#[path = "golden/table.rs"]
mod table;

use microslip::element::{Directions, Element, NormalInput};
use microslip::one_direction::tractions::tractions;
use microslip::one_direction::{Step, advance, force_error, state_init, state_length};
use microslip::{Contact, EllipticParameters, Error, Layer, Material, Parameters};
use proptest::prelude::*;
use table::{Row, geometry, table};

const STEEL: Material = Material { young_modulus: 2e11, poisson_ratio: 0.3 };

fn parameters(flat_half_width: f64) -> Parameters {
    Parameters {
        flat_half_width,
        edge_radius: 3e-3,
        length: 20e-3,
        normal_force: 800.0,
        friction_coefficient: 0.5,
        material: [STEEL; 2],
        displacement_reference: microslip::parameters::CENTRE_POINT,
        ..Parameters::default()
    }
}

const SPHERE: EllipticParameters = EllipticParameters {
    semi_axis_x: 2e-4,
    semi_axis_y: 2e-4,
    normal_force: 800.0,
    friction_coefficient: 0.5,
    material: [STEEL; 2],
    layer: Layer::none(),
};

/// Cylinder, flats with a/b of 0.5 and 0.97, sphere.
fn elements(input: NormalInput) -> Vec<Element> {
    let flat = |a| Element::rounded_flat(&parameters(a), Directions::One, input).unwrap();
    vec![flat(0.0), flat(6e-5), flat(5e-4), Element::elliptic(&SPHERE, Directions::One, input).unwrap()]
}

struct History<'a> {
    element: &'a Element,
    state: Vec<f64>,
}

impl History<'_> {
    fn new(element: &Element, pieces: usize) -> History<'_> {
        let mut state = vec![0.0; state_length(pieces)];
        state_init(&mut state).unwrap();
        History { element, state }
    }

    fn step(&mut self, u: f64, w: f64) -> Step {
        advance(self.element, &mut self.state, [u, w], true).unwrap()
    }
}

/// The element of a row of a table, under the given largest normal force.
fn element_of_row(row: &Row, normal_force: f64, input: NormalInput) -> Element {
    let body = |e, nu| Material { young_modulus: row[e], poisson_ratio: row[nu] };
    let material = [body("E1", "nu1"), body("E2", "nu2")];
    let friction_coefficient = if row.has("mu") { row["mu"] } else { 0.5 };
    let layer = if row.has("c_n") {
        let [normal_compliance, tangential_compliance, reference_load, stiffening_load] =
            ["c_n", "c_t", "N_layer", "N_c"].map(|name| row[name]);
        Layer { normal_compliance, tangential_compliance, stiffening_load, reference_load }
    } else {
        Layer::none()
    };
    let element = if row["a"].is_nan() {
        let [semi_axis_x, semi_axis_y, normal_force] = ["semi_x", "semi_y", "N_ref"].map(|name| row[name]);
        let ellipse = EllipticParameters {
            semi_axis_x,
            semi_axis_y,
            normal_force,
            friction_coefficient,
            material,
            layer,
            ..EllipticParameters::default()
        };
        Element::elliptic(&ellipse, Directions::One, input)
    } else {
        let flat = Parameters { normal_force, friction_coefficient, material, layer, ..geometry(row) };
        Element::rounded_flat(&flat, Directions::One, input)
    };
    element.unwrap()
}

/// The element of a history of the reference table, its normal input, and the largest normal force and displacement.
fn element_of(history: &[Row]) -> (Element, &'static str, [f64; 2]) {
    let first = &history[0];
    let largest = ["N", "delta"].map(|name| history.iter().map(|row| row[name].abs()).fold(0.0, f64::max));
    let (input, column) =
        if first.text("control") == "N" { (NormalInput::Force, "N") } else { (NormalInput::Approach, "u_n") };
    (element_of_row(first, largest[0], input), column, largest)
}

#[test]
fn reference_histories_are_reproduced() {
    check_histories("varying_load");
}

#[test]
fn reference_histories_with_a_layer_are_reproduced() {
    check_histories("layer_varying_load");
}

fn check_histories(name: &str) {
    // Error of T and N in units of the largest mu N and N, of the energy in mu N_max u_max, of the tangent in the stiffnesses
    // under the largest force. Forces and energies are sums of a few terms, each with a few roundings; slopes come from the
    // derivatives of polynomials, whose coefficients are rounded: 1e-14 of the present stiffness, divided by differences of
    // stiffnesses under small loads.
    // With a layer the second derivative of N(S), which the energy needs, loses a digit: its singularities are closer.
    let bounds = [1e-14, 1e-14, if name.starts_with("layer") { 1e-12 } else { 1e-13 }, 1e-11, 1e-11];
    let mut worst = [0.0_f64; 5];
    let rows = table(name);
    for history in rows.chunk_by(|one, other| one["history"] == other["history"]) {
        let (element, column, [normal_force, displacement]) = element_of(history);
        let slip_force = element.friction_coefficient * normal_force;
        let mut memory = History::new(&element, 64);
        for row in history {
            let step = memory.step(row["delta"], row[column]);
            let by_input = if column == "N" { row["dN_dun"] } else { 1.0 };
            let compare = [
                (step.force[0], row["T"], slip_force),
                (step.force[1], row["N"], normal_force),
                (step.dissipated, row["dissipated"], slip_force * displacement),
                (step.tangent[0], row["dT_ddelta"], element.tangential_stiffness),
                (step.tangent[2] * by_input, row["dT_dun"], element.friction_coefficient * element.normal_stiffness),
            ];
            for (worst, (computed, expected, scale)) in worst.iter_mut().zip(compare) {
                assert!(!computed.is_nan());
                // At corners the tangents of the table are NaN.
                if !expected.is_nan() {
                    *worst = worst.max((computed - expected).abs() / scale);
                }
            }
        }
    }
    assert!(worst.iter().zip(bounds).all(|(worst, bound)| *worst <= bound), "{worst:?}");
}

#[test]
fn a_constant_normal_force_gives_the_law_of_a_constant_normal_force() {
    let contacts = [0.0, 6e-5, 5e-4].map(|a| Contact::rounded_flat(&parameters(a)).unwrap());
    let contacts = contacts.into_iter().chain([Contact::elliptic(&SPHERE).unwrap()]);
    for (element, contact) in elements(NormalInput::Force).iter().zip(contacts) {
        let mut memory = History::new(element, 64);
        memory.step(0.0, 800.0);
        let mut state = common::unloaded(64);
        let mut phase = 0.7_f64;
        for _ in 0..500 {
            phase = (phase * 997.0).sin();
            let u = 1.3 * phase * contact.slip_displacement;
            let step = memory.step(u, 800.0);
            let (force, stiffness, dissipated) = common::advance(&contact, &mut state, u);
            // Both laws store and invert with rounding errors of a few units.
            assert!((step.force[0] - force).abs() < 4e-15 * contact.slip_force);
            assert!((step.tangent[0] - stiffness).abs() < 1e-11 * contact.initial_stiffness);
            assert!((step.dissipated - dissipated).abs() < 1e-13 * contact.slip_force * contact.slip_displacement);
        }
    }
}

/// Displacements over that of gross slip and normal components over those of the parameters.
fn random_history() -> impl Strategy<Value = Vec<(f64, f64)>> {
    prop::collection::vec((-2.0..2.0, -0.3..1.2), 2..40)
}

proptest! {
    #![proptest_config(common::random_cases(256))]

    /// A step is straight in (S, u): steps through points of that line change nothing, and dissipate the same in sum.
    #[test]
    fn substeps_change_nothing(history in random_history(), parts in 2..5_u32) {
        for element in &elements(NormalInput::Force) {
            let unit = 400.0 / element.tangential_stiffness;
            let (mut one, mut other) = (History::new(element, 64), History::new(element, 64));
            let mut from = (0.0, 0.0);
            for &(u, w) in &history {
                let to = (u * unit, w.max(0.0) * 800.0);
                let step = one.step(to.0, to.1);
                let (start, end) = (element.shift_under(from.1), element.shift_under(to.1));
                let (mut last, mut energy) = (step, 0.0);
                for part in 1..=parts {
                    let fraction = f64::from(part) / f64::from(parts);
                    let along = |from: f64, to: f64| if part == parts { to } else { from + fraction * (to - from) };
                    let load = if part == parts { to.1 } else { element.load_under(along(start, end)) };
                    last = other.step(along(from.0, to.0), load);
                    energy += last.dissipated;
                }
                prop_assert!((last.force[0] - step.force[0]).abs() < 1e-13 * 400.0);
                prop_assert!((energy - step.dissipated).abs() < 1e-12 * 400.0 * unit);
                from = to;
            }
        }
    }
}

#[test]
fn loads_beyond_the_tables_are_exact_up_to_the_largest_half_width() {
    let small = Parameters { normal_force: 800.0, ..parameters(6e-5) };
    let large = Parameters { normal_force: 800.0 * 64.0, ..small };
    for input in [NormalInput::Approach, NormalInput::Force] {
        let [one, other] =
            [small, large].map(|parameters| Element::rounded_flat(&parameters, Directions::One, input).unwrap());
        let (mut beyond, mut within) = (History::new(&one, 64), History::new(&other, 64));
        for (u, load) in [(0.1, 0.2), (0.5, 40.0), (0.4, 60.0), (0.45, 1e-3), (0.4, 64.0)] {
            let load = load * 800.0;
            let w = if input == NormalInput::Force { load } else { other.approach_under(load).value };
            let u = u * 4e4 / other.tangential_stiffness;
            let (step, expected) = (beyond.step(u, w), within.step(u, w));
            assert!((step.force[0] - expected.force[0]).abs() < 1e-14 * 0.5 * load.max(800.0), "{step:?} {expected:?}");
            assert!((step.force[1] / expected.force[1] - 1.0).abs() < 1e-14);
        }
        // The approach of a line contact has a maximum near b = 2L.
        let mut state = beyond.state.clone();
        let too_large = if input == NormalInput::Force { 1e12 } else { 1.0 };
        assert_eq!(advance(&one, &mut state, [0.0, too_large], true), Err(Error::LengthTooShort));
        assert_eq!(one.check_approach(1.0), Err(Error::LengthTooShort));
        assert_eq!(one.check_normal_force(1e12), Err(Error::LengthTooShort));
        assert_eq!(state, beyond.state);
    }
}

/// The squares of such loads and approaches underflow.
#[test]
fn energies_of_steps_to_vanishing_loads_are_finite() {
    for input in [NormalInput::Approach, NormalInput::Force] {
        for element in &elements(input) {
            let unit = 400.0 / element.tangential_stiffness;
            let largest = if input == NormalInput::Force { 800.0 } else { element.approach };
            for vanishing in [0.0, 5e-324, 1e-300, 1e-150, 1e-70, 1e-55] {
                let mut memory = History::new(element, 64);
                for (u, w) in [(0.1, 0.6), (0.3, 1.0), (0.3, 0.5), (0.3, 0.2), (0.3, vanishing), (0.3, vanishing)] {
                    let step = memory.step(u * unit, w * largest);
                    assert!(step.dissipated >= 0.0 && step.dissipated < 400.0 * unit, "{vanishing} {step:?}");
                    assert!(step.tangent.iter().all(|value| value.is_finite()), "{vanishing} {step:?}");
                }
                let [step, other] = [memory, History::new(element, 64)].map(|mut memory| {
                    memory.step(0.3 * unit, 0.0);
                    memory.step(0.4 * unit, largest)
                });
                assert_eq!(step.force, other.force);
            }
        }
    }
}

#[test]
fn a_contact_without_friction_has_a_normal_force_only() {
    let element = Element::rounded_flat(
        &Parameters { friction_coefficient: 0.0, ..parameters(6e-5) },
        Directions::One,
        NormalInput::Force,
    );
    let element = element.unwrap();
    let step = History::new(&element, 4).step(1e-6, 500.0);
    assert_eq!((step.force, step.dissipated), ([0.0, 500.0], 0.0));
}

/// The series of the tables would diverge near the largest approach.
#[test]
fn loads_up_to_the_largest_for_the_length_are_exact() {
    for flat_half_width in [0.0, 5e-4] {
        let with_load = |normal_force| {
            let parameters = Parameters { length: 1e-3, normal_force, ..parameters(flat_half_width) };
            Element::rounded_flat(&parameters, Directions::One, NormalInput::Approach)
        };
        let (mut low, mut high) = (1.0, 1e9);
        while high > low * (1.0 + 1e-12) {
            let middle = 0.5 * (low + high);
            *(if with_load(middle).is_ok() { &mut low } else { &mut high }) = middle;
        }
        let [element, exact] = [low, 1e-3 * low].map(|load| with_load(load).unwrap());
        for part in 1..=100 {
            let approach = element.approach * f64::from(part) / 100.0 * (1.0 - 1e-9);
            let [force, expected] = [&element, &exact].map(|element| element.normal_force_at(approach).value);
            assert!((force - expected).abs() < 1e-12 * low, "{part} {force} {expected}");
        }
    }
}

/// In units in which the load is about 1e150: an element that is accepted takes its own load.
#[test]
fn the_load_of_the_parameters_is_accepted() {
    for (normal_force, accepted) in [(0.99e150, true), (1.01e150, false), (4e150, false)] {
        let (flat_half_width, edge_radius, length) = (1e49, 1e50, 1e50);
        let material = [Material { young_modulus: 4e-100 * normal_force, poisson_ratio: 0.3 }; 2];
        let parameters = Parameters { edge_radius, length, normal_force, material, ..parameters(flat_half_width) };
        let element = Element::rounded_flat(&parameters, Directions::One, NormalInput::Force);
        assert_eq!(element.map(|element| element.check_normal_force(normal_force)).ok(), accepted.then_some(Ok(())));
    }
}

#[test]
fn tiny_loads_and_repeated_steps_are_regular() {
    for input in [NormalInput::Approach, NormalInput::Force] {
        for element in &elements(input) {
            let unit = 400.0 / element.tangential_stiffness;
            let mut memory = History::new(element, 64);
            for w in [5e-324, 1e-310, 1e-290, 1e-100, 1e-60, 1e-40] {
                for u in [0.3, 0.3, -0.2] {
                    let step = memory.step(u * unit, w);
                    assert!(step.force.iter().chain(&step.tangent).all(|value| value.is_finite()), "{w} {step:?}");
                    assert!(step.force[0].abs() <= 0.5 * step.force[1] && step.dissipated >= 0.0, "{w} {step:?}");
                    // The same step again changes nothing.
                    assert_eq!(memory.step(u * unit, w).force, step.force);
                }
            }
        }
    }
}

/// 2L = 1.07 b: approach and shift are nearly at their maximum, beyond which there is no size.
#[test]
fn the_tables_of_a_short_contact_are_its_law() {
    let rigid = Material { young_modulus: 2e11, poisson_ratio: 0.0 };
    let long = Parameters { material: [rigid; 2], ..parameters(6e-5) };
    let half_width = Element::rounded_flat(&long, Directions::One, NormalInput::Force).unwrap().half_width;
    let length = 0.535 * half_width;
    let short = Parameters { length, normal_force: 800.0 * length / long.length, ..long };
    let element = Element::rounded_flat(&short, Directions::One, NormalInput::Approach).unwrap();
    for share in [1.0, 0.95, 0.8, 0.5, 0.3, 0.1] {
        let load = share * short.normal_force;
        let approach = element.approach_under(load).value;
        // dN/dU is up to 15 N/U.
        assert!((element.normal_force_at(approach).value / load - 1.0).abs() < 5e-14, "{share}");
        assert!((element.load_under(element.shift_under(load)) / load - 1.0).abs() < 5e-14, "{share}");
    }
}

/// A load that falls at a constant displacement through a piece with D = 0, to rounding, into gross slip.
#[test]
fn a_falling_load_dissipates_at_a_constant_displacement() {
    for element in &elements(NormalInput::Force) {
        let unit = 400.0 / element.tangential_stiffness;
        let (mut one, mut other) = (History::new(element, 64), History::new(element, 64));
        for memory in [&mut one, &mut other] {
            memory.step(0.1 * unit, 200.0);
            memory.step(0.03 * unit, 150.0);
            memory.step(-0.07 * unit, 800.0 / 3.0);
            memory.step(-0.07 * unit, 800.0);
        }
        let whole = one.step(-0.07 * unit, 20.0);
        let parts: f64 =
            [500.0, 100.0, 50.0, 30.0, 20.0].map(|load| other.step(-0.07 * unit, load).dissipated).iter().sum();
        assert!(whole.dissipated > 0.0 && (parts / whole.dissipated - 1.0).abs() < 1e-10, "{parts} {whole:?}");
    }
}

#[test]
fn tractions_satisfy_coulomb_and_integrate_to_the_forces() {
    const VARYING: [(f64, f64); 6] = [(0.1, 0.4), (0.3, 0.9), (0.7, 0.8), (0.5, 1.1), (-0.2, 0.9), (0.3, 1.0)];
    // Six pieces in a state of four, and slip zones that cut back to knots beyond the merged ones.
    const MERGED: [(f64, f64); 9] =
        [(0.1, 0.4), (0.2, 0.5), (0.4, 0.6), (0.5, 0.9), (0.75, 1.0), (0.8, 1.2), (0.75, 1.2), (0.6, 1.2), (0.3, 1.2)];
    let elements = &elements(NormalInput::Force)[..3];
    for (element, (pieces, path)) in elements.iter().flat_map(|one| [(one, (64, &VARYING[..])), (one, (4, &MERGED))]) {
        let unit = 400.0 / element.tangential_stiffness;
        let mut memory = History::new(element, pieces);
        for &(u, w) in path {
            let step = memory.step(u * unit, w * 800.0);
            // Forces of a step are those before a merge; a restart from the state has those of the merged pieces.
            let again = memory.step(u * unit, w * 800.0);
            assert!((again.force[0] - step.force[0]).abs() <= force_error(&memory.state) + 1e-13 * 400.0);
            // The midpoint rule in the angle, x = b cos: its error is that of the logarithms at the edges of the pieces.
            let (n, half_width) = (20_000, element.half_width_under(w * 800.0));
            let angles: Vec<f64> = (0..n).map(|i| std::f64::consts::PI * (f64::from(i) + 0.5) / f64::from(n)).collect();
            let x: Vec<f64> = angles.iter().map(|angle| half_width * angle.cos()).collect();
            let (mut pressure, mut shear) = (vec![f64::NAN; x.len()], vec![f64::NAN; x.len()]);
            tractions(element, &memory.state, &x, Some(&mut pressure), Some(&mut shear)).unwrap();
            let integral = |values: &[f64]| -> f64 {
                let sum: f64 = values.iter().zip(&angles).map(|(value, angle)| value * angle.sin()).sum();
                sum * half_width * std::f64::consts::PI / f64::from(n) * 20e-3
            };
            assert!((integral(&pressure) - step.force[1]).abs() < 1e-6 * 800.0);
            assert!((integral(&shear) - again.force[0]).abs() < 1e-6 * 400.0);
            for (shear, pressure) in shear.iter().zip(&pressure) {
                assert!(shear.abs() <= 0.5 * pressure + 1e-13 * pressure.max(1e8));
            }
        }
        let mut outside = [1.0];
        tractions(element, &memory.state, &[2.0 * element.half_width], None, Some(&mut outside)).unwrap();
        assert_eq!(outside, [0.0]);
    }
}

#[test]
fn the_normal_law_of_the_reference_tables_is_reproduced() {
    ["normal_law", "layer_normal_law"].into_iter().for_each(check_normal_law);
}

fn check_normal_law(name: &str) {
    // Errors relative to the present values: roundings of the tables' coefficients, and of the argument.
    let mut worst = [0.0_f64; 5];
    let rows = table(name);
    for row in &rows {
        let geometry = |row: &Row| {
            let layer = if row.has("N_c") { [row.text("c_n"), row.text("N_c")] } else { [""; 2] };
            (["R", "L", "semi_x"].map(|name| row.text(name)), layer)
        };
        let of_geometry = rows.iter().filter(|other| geometry(other) == geometry(row));
        let largest = of_geometry.map(|row| row["N"]).fold(0.0, f64::max);
        for input in [NormalInput::Approach, NormalInput::Force] {
            let element = element_of_row(row, largest, input);
            let (load, approach) = (row["N"], row["u_n"]);
            let (at_load, at_approach) = (element.approach_under(load), element.normal_force_at(approach));
            // The given one is an exact double.
            let compare = [
                (at_load.value, approach),
                (at_approach.value, load),
                (at_load.slope, 1.0 / row["dN_dun"]),
                (at_approach.slope, row["dN_dun"]),
                (element.half_width_under(load), row["size"]),
            ];
            for (worst, (computed, expected)) in worst.iter_mut().zip(compare) {
                *worst = worst.max((computed / expected - 1.0).abs());
            }
        }
    }
    let bounds = [4e-15, 4e-15, 1e-13, 1e-13, 4e-15];
    assert!(worst.iter().zip(bounds).all(|(worst, bound)| *worst <= bound), "{worst:?}");
}
