//! Claims of the paper, in the order of the page: those that hold as limits or with a corrected equation, and those that another
//! computation confirms.

use crate::cases::Case;
use crate::drawings::{LENGTH, LENGTHS, NEARLY_FLAT, REVERSAL, SHAPE, SHAPES, even};
use crate::equations::{Tractions, integral, printed_load, printed_pressure, printed_relieved_traction};
use std::f64::consts::PI;

/// The check of a claim: the computed values, and whether the verdict is true. Claim and verdict are on the page.
pub type Claim = (String, bool);

/// Two closed forms of one quantity.
const CLOSED_FORMS: f64 = 1e-12;
/// Quadrature: the rule omits 7e-14 of an interval at each end, where a logarithm is 30.
const QUADRATURE: f64 = 1e-11;

/// The claim that all errors are below a bound, with which the text ends.
fn to_within(bound: f64, text: &str, errors: impl IntoIterator<Item = f64>) -> Claim {
    (format!("{text} {bound:e}"), largest(errors) < bound)
}

/// The largest value, or NaN.
fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    // A NaN remains, and fails.
    values.into_iter().fold(0.0, |largest: f64, value| if value > largest || value.is_nan() { value } else { largest })
}

fn relative(value: f64, expected: f64) -> f64 {
    (value / expected - 1.0).abs()
}

fn falls(values: &[f64]) -> bool {
    values.windows(2).all(|pair| pair[1] < pair[0])
}

fn list(values: &[f64], digits: usize) -> String {
    values.iter().map(|value| format!("{value:.digits$}")).collect::<Vec<_>>().join(", ")
}

fn shapes() -> [Case; 5] {
    SHAPES.map(|shape| Case::flat(shape, LENGTH))
}

/// The claims of each table of the page.
pub fn all() -> Vec<(&'static str, Vec<Claim>)> {
    vec![
        ("fig07", vec![displacement_of_tractions()]),
        ("oscillating", vec![mindlin()]),
        ("fig11", vec![common_tangent(), end_of_microslip()]),
        ("fig13", vec![no_microslip_of_a_flat()]),
        ("fig15", vec![cube_of_the_force(), work_of_slip()]),
        ("printed", vec![width_of_contact(), load_of_pressure(), relieved_load(), slip_of_plane_problem()]),
    ]
}

fn displacement_of_tractions() -> Claim {
    let cases = [0.0, SHAPE, NEARLY_FLAT].iter().flat_map(|&shape| LENGTHS.map(|length| (shape, length)));
    let errors = cases.flat_map(|(shape, length)| {
        let case = Case::flat(shape, length);
        [0.1, 0.5, 0.9, 1.0]
            .map(|force| relative(case.displacement(force), Tractions::first(&case, force).displacement(length)))
    });
    to_within(QUADRATURE, "its quadrature and the library's closed form agree to", errors)
}

fn mindlin() -> Claim {
    let sphere = Case::sphere();
    let slip = sphere.slip_displacement();
    let errors = [0.3, 0.8, 1.0].into_iter().flat_map(|top: f64| {
        let amplitude = slip * (1.0 - (1.0 - top).powf(2.0 / 3.0));
        let (displacements, forces) = sphere.hysteresis_loop(amplitude, 64);
        // Unloading from Q* by Mindlin, Mason, Osmer and Deresiewicz.
        displacements.into_iter().zip(forces).take(33).map(move |(displacement, force)| {
            let half = 1.0 - (top - force) / 2.0;
            let expected = slip * (2.0 * half.clamp(0.0, 1.0).powf(2.0 / 3.0) - (1.0 - top).powf(2.0 / 3.0) - 1.0);
            (displacement - expected).abs() / slip
        })
    });
    // Near full reversal of the force the power 2/3 amplifies rounding of 1e-16 to 1e-11.
    to_within(QUADRATURE, "their equation and the loop of the elliptical contact of equal axes agree to", errors)
}

fn common_tangent() -> Claim {
    let lengths = [5.0, 10.0, 20.0, 40.0, 1e4];
    let ratios =
        lengths.map(|length| Case::ellipse(length).initial_stiffness() / Case::flat(0.0, length).initial_stiffness());
    let distances = ratios.map(|ratio| (ratio - 1.0).abs());
    (
        format!("quotient of the initial stiffnesses {} for L/b = 5, 10, 20, 40, 10⁴", list(&ratios, 4)),
        falls(&distances) && distances[1] < 0.02,
    )
}

fn end_of_microslip() -> Claim {
    let slope = |case: &Case, force: f64| case.at_force(force).stiffness() / case.contact.initial_stiffness;
    let (cylinder, ellipse, flat) = (Case::flat(0.0, LENGTH), Case::ellipse(LENGTH), Case::flat(NEARLY_FLAT, LENGTH));
    let slopes = [&ellipse, &cylinder].map(|case| slope(case, 1.0 - 1e-6));
    let ends = [&ellipse, &cylinder, &flat].map(|case| slope(case, 1.0));
    (
        format!(
            "stiffness at Q/μP = 1 - 10⁻⁶ over the initial one: ellipse {:.3}, cylinder {:.3}. The cylinder's does vanish at μP, \
             but only like 1/ln(1/c); that of a/b = {NEARLY_FLAT} ends at {:.3}",
            slopes[0], slopes[1], ends[2]
        ),
        slopes[0] < 0.02 && slopes[1] > 0.2 && ends[..2] == [0.0; 2] && ends[2] > 0.5,
    )
}

fn no_microslip_of_a_flat() -> Claim {
    let flats = [0.9, 0.99, 0.999, 0.9999];
    let energies = flats.map(|shape| Case::flat(shape, LENGTH).energy(1.0));
    // The largest K'' of a spring-slider: 1/π of its stiffness, at twice the displacement of slip.
    let flat = Case::flat(flats[3], LENGTH);
    let peak = PI * flat.complex_stiffness(2.0 * flat.slip_displacement()).1 / flat.initial_stiffness();
    (
        format!(
            "energy at incipient gross slip {} for a/b = 0.9, 0.99, 0.999, 0.9999; the largest K'' of the last is {peak:.4} of a \
             spring-slider's",
            energies.map(|energy| format!("{energy:.1e}")).join(", ")
        ),
        falls(&energies) && energies[3] < 1e-4 && relative(peak, 1.0) < 1e-3,
    )
}

fn cube_of_the_force() -> Claim {
    let slopes =
        |from: f64, to: f64| shapes().map(|case| (case.energy(to) / case.energy(from)).ln() / (to / from).ln());
    // The next term of the energy is of the fourth power, with about the same factor.
    let error = largest(slopes(1e-4, 1.01e-4).map(|slope| (slope - 3.0).abs()));
    let (lower, upper) = (slopes(0.01, 0.1), slopes(0.1, 1.0));
    let steeper = |slopes: &[f64]| slopes.iter().all(|&slope| slope > 3.0 && slope < 3.5) && falls(slopes);
    (
        format!(
            "slope 3 for small forces, to 10⁻³ at Q/μP = 10⁻⁴. Mean slope from 0.01 to 0.1: {}, from 0.1 to 1: {} for a/b = 0, \
             0.5, 0.75, 0.9, 0.99: steeper towards gross slip",
            list(&lower, 2),
            list(&upper, 2)
        ),
        error < 1e-3 && steeper(&lower) && steeper(&upper),
    )
}

fn work_of_slip() -> Claim {
    let cases = [0.0, SHAPE, NEARLY_FLAT].map(|shape| Case::flat(shape, LENGTH));
    let errors = cases.iter().flat_map(|case| {
        [0.3, REVERSAL, 1.0].map(|force| {
            let damage = |x| case.pressure(x) * case.slip(x, force);
            let points = [0.0, case.flat_over_width(), case.stick_zone(force), 1.0];
            // Both edges, and four quarters of a cycle.
            relative(8.0 * integral(&points, 1.0, damage), case.energy(force))
        })
    });
    to_within(QUADRATURE, "the integral of μp s over the slip zones and the area of the loop agree to", errors)
}

/// 4PR/(a²E*).
fn shape_parameter(case: &Case) -> f64 {
    4.0 * case.line_load() * case.edge_radius / (case.flat.powi(2) * case.contact.composite_modulus)
}

fn width_of_contact() -> Claim {
    // b/√(4PR/πE*) of a/b = 10⁻⁴, which has 2/π of that left: 1 for Hertz.
    let width = |factor: f64| (PI / (factor * printed_load(1e-4) * 1e-8)).sqrt();
    let (printed, corrected) = (width(1.0), width(2.0));
    let library = relative(2.0 * printed_load(SHAPE), shape_parameter(&Case::flat(SHAPE, LENGTH)));
    (
        format!(
            "b over that of Hertz at a/b = 10⁻⁴: corrected {corrected:.4}, printed {printed:.4}; the library's a/b = {SHAPE} from \
             the corrected one, to {CLOSED_FORMS:e}"
        ),
        relative(corrected, 1.0) < 1e-4 && relative(printed, 2f64.sqrt()) < 1e-4 && library < CLOSED_FORMS,
    )
}

/// Integral over both halves of the width.
fn both_halves(traction: impl Fn(f64) -> f64) -> f64 {
    integral(&[0.0, SHAPE, 1.0], 1.0, |x| traction(x) + traction(-x))
}

fn load_of_pressure() -> Claim {
    let case = Case::flat(SHAPE, LENGTH);
    let (printed, corrected) = (both_halves(|x| printed_pressure(SHAPE, x)), both_halves(|x| case.pressure(x)));
    (
        format!("a/b = {SHAPE}: corrected 1; printed {printed:.3}"),
        relative(corrected, 1.0) < QUADRATURE && relative(printed, 1.0) > 1e-3,
    )
}

/// Corrected, the relieved traction is the pressure of [`load_of_pressure`].
fn relieved_load() -> Claim {
    let printed = both_halves(|x| printed_relieved_traction(SHAPE, x));
    (format!("a/c = {SHAPE}: corrected 1; printed {printed:.3}, and infinite at x = a"), printed < 0.0)
}

fn slip_of_plane_problem() -> Claim {
    let case = Case::flat(SHAPE, LENGTH);
    let tractions = Tractions::first(&case, REVERSAL);
    let stick = case.stick_zone(REVERSAL);
    let outside = even(0.755, 0.995, 8).into_iter().map(|x| (tractions.slip(x, 1.0) - case.slip(x, REVERSAL)).abs());
    let in_stick = |limit| largest(even(0.05, 0.95 * stick, 8).iter().map(|&x| tractions.slip(x, limit).abs()));
    let edge = case.slip(1.0, REVERSAL);
    (
        format!(
            "with the upper limit b, to {QUADRATURE:e}; with the printed a the stick zone would slip up to {:.1} times as far as \
             the edge",
            in_stick(SHAPE) / edge
        ),
        largest(outside) < QUADRATURE && in_stick(1.0) < QUADRATURE && in_stick(SHAPE) > 0.1 * edge,
    )
}
