//! The paper's claims, in the order of the page.

mod cycles;
mod loops;
mod stiffness;
mod tractions;

use crate::cases::{Case, POISSON};
use crate::drawings::{
    AFTER_REVERSAL, AMPLITUDES, FLATS_OVER_RADIUS, LARGEST_LOAD, LENGTH, LENGTH_OVER_RADIUS, LENGTHS, NEARLY_CYLINDER,
    NEARLY_FLAT, REVERSAL, SHAPE, SHAPES, even,
};
use crate::equations::{Tractions, integral, printed_load, printed_pressure, printed_relieved_traction};
use microslip::Material;
use std::f64::consts::PI;

/// The check of a claim: the computed values, and whether the verdict is true. Claim and verdict are on the page.
pub type Claim = (String, bool);

/// Two closed forms of one quantity.
const CLOSED_FORMS: f64 = 1e-12;
/// Quadrature: the rule omits 7e-14 of an interval at each end, where a logarithm is 30.
const QUADRATURE: f64 = 1e-11;
/// Other units: near the edge of the contact, at x/b = 0.999, rounding of its width is amplified a thousand times.
const OTHER_UNITS: f64 = 1e-11;

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

/// The area of the loop by the trapezoidal rule, to 1e-7.
fn area(case: &Case, amplitude: f64) -> f64 {
    let (x, y) = case.hysteresis_loop(amplitude, 20_000);
    0.5 * x.windows(2).zip(y.windows(2)).map(|(x, y)| (y[0] + y[1]) * (x[0] - x[1])).sum::<f64>().abs()
}

/// The claims of each table of the page.
pub fn all() -> Vec<(&'static str, Vec<Claim>)> {
    use {cycles::*, loops::*, stiffness::*, tractions::*};
    vec![
        ("fig03", vec![hertz(), pressure_by_shape(), two_limits_of_shape(), incomplete_contact()]),
        ("fig04", vec![slip_at_any_force(), full_stick(), shear_is_coulombs()]),
        (
            "fig07",
            vec![
                far_field(),
                displacement_of_tractions(),
                long_contact(),
                gross_slip_is_horizontal(),
                no_effect_of_frequency(),
            ],
        ),
        ("oscillating", vec![direct_tractions(), reloading(), mindlin()]),
        ("fig08", vec![curve_by_ratios(), area_by_shape(), slip_stays_on_the_edges()]),
        ("fig09", vec![length_is_a_spring(), area_by_length()]),
        ("fig10", vec![stiffness_by_load(), width_by_load()]),
        ("fig11", vec![slope_after_reversal(), common_tangent(), elliptic_dissipates_more(), end_of_microslip()]),
        (
            "fig13",
            vec![
                first_harmonic(),
                imaginary_part_dissipates(),
                imaginary_part_by_shape(),
                no_microslip_of_a_flat(),
                one_initial_stiffness(),
            ],
        ),
        ("fig14", vec![initial_stiffness_by_length()]),
        ("fig15", vec![cube_of_the_force(), work_of_slip(), unit_energy()]),
        ("printed", vec![width_of_contact(), load_of_pressure(), relieved_load(), slip_of_plane_problem()]),
    ]
}
