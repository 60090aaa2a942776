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

/// The check of a claim. Its text and its verdict are on the page.
pub struct Claim {
    /// The table of the page.
    pub figure: &'static str,
    pub computed: String,
    /// Whether the verdict is true.
    pub stands: bool,
}

/// Two closed forms of one quantity.
const CLOSED_FORMS: f64 = 1e-12;
/// Quadrature: the rule omits 7e-14 of an interval at each end, where a logarithm is 30.
const QUADRATURE: f64 = 1e-11;
/// Other units: near the edge of the contact, at x/b = 0.999, rounding of its width is amplified a thousand times.
const OTHER_UNITS: f64 = 1e-11;

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

fn shapes() -> Vec<Case> {
    SHAPES.iter().map(|&shape| Case::flat(shape, LENGTH)).collect()
}

/// The area of the loop by the trapezoidal rule, to 1e-7.
fn area(case: &Case, amplitude: f64) -> f64 {
    let (x, y) = case.hysteresis_loop(amplitude, 20_000);
    0.5 * x.windows(2).zip(y.windows(2)).map(|(x, y)| (y[0] + y[1]) * (x[0] - x[1])).sum::<f64>().abs()
}

pub fn all() -> Vec<Claim> {
    vec![
        tractions::hertz(),
        tractions::pressure_by_shape(),
        tractions::two_limits_of_shape(),
        tractions::incomplete_contact(),
        tractions::slip_at_any_force(),
        tractions::full_stick(),
        tractions::shear_is_coulombs(),
        loops::far_field(),
        loops::displacement_of_tractions(),
        loops::long_contact(),
        loops::gross_slip_is_horizontal(),
        loops::no_effect_of_frequency(),
        loops::direct_tractions(),
        loops::reloading(),
        loops::mindlin(),
        loops::curve_by_ratios(),
        loops::area_by_shape(),
        loops::slip_stays_on_the_edges(),
        loops::length_is_a_spring(),
        loops::area_by_length(),
        stiffness::stiffness_by_load(),
        stiffness::width_by_load(),
        stiffness::slope_after_reversal(),
        stiffness::common_tangent(),
        stiffness::elliptic_dissipates_more(),
        cycles::end_of_microslip(),
        cycles::first_harmonic(),
        cycles::imaginary_part_dissipates(),
        cycles::imaginary_part_by_shape(),
        cycles::no_microslip_of_a_flat(),
        cycles::one_initial_stiffness(),
        cycles::initial_stiffness_by_length(),
        cycles::cube_of_the_force(),
        cycles::work_of_slip(),
        cycles::unit_energy(),
        tractions::width_of_contact(),
        tractions::load_of_pressure(),
        tractions::relieved_load(),
        tractions::slip_of_plane_problem(),
    ]
}
