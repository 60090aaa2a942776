//! Equivalent spring-sliders, for solvers that have no other friction element.
//!
//! - Jenkins element: one spring with one slider, with the complex stiffness of the contact at one amplitude.
//! - Iwan model: n of them in parallel, whose force on the monotonic curve has the smallest possible maximum error.

use crate::constant_load::complex_stiffness::check_amplitude;
use crate::constant_load::contact::Contact;
use crate::error::{Error, ensure};
use crate::numerics::roots::logarithmic_newton;
use crate::shape::size::Size;
use crate::shape::stick_zone::StickZones;
use crate::shape::{Complement, ShapeKind};
use core::f64::consts::PI;

/// A spring in series with a Coulomb slider.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpringSlider {
    /// Stiffness of the spring \[N/m\].
    pub stiffness: f64,
    /// Force at which the slider slips \[N\].
    pub slip_force: f64,
}

/// The spring-slider that has the K' and K'' of the contact at a displacement amplitude \[m\].
///
/// A loop of amplitude δ_0 with slip force T_s and stiffness k has, with `cos θ = 1 - 2 T_s/(k δ_0)`,
/// `K' = (k/π) (θ - sin θ cos θ)` and `K'' = (k/π) sin² θ`. The quotient K''/K' gives θ. At amplitude 0 the slip force
/// is arbitrary, and the result is the initial stiffness with mu N; for a contact without friction both are 0.
/// Errors: `BadAmplitude`.
pub fn jenkins(contact: &Contact, amplitude: f64) -> Result<SpringSlider, Error> {
    check_amplitude(amplitude)?;
    if contact.is_frictionless() {
        return Ok(SpringSlider { stiffness: 0.0, slip_force: 0.0 });
    }
    // Beyond this amplitude the result no longer changes, and K' would underflow.
    let amplitude = amplitude.min(1e100 * contact.slip_displacement);
    let [real, imaginary, ..] = contact.stiffness_of_cycle(amplitude, [true; 2]);
    let ratio = imaginary / real.max(f64::MIN_POSITIVE);
    if amplitude <= 0.0 || ratio < 1e-300 {
        let slip_force = if amplitude > 0.0 { real * amplitude } else { contact.slip_force };
        return Ok(SpringSlider { stiffness: real, slip_force });
    }
    // With t = tan θ/2 the inverse of the quotient grows as 4t/3 for small t, as π t²/4 for large ones.
    let start = if ratio > 1.0 { 0.75 / ratio } else { (4.0 / (PI * ratio)).sqrt() };
    let sine_and_cosine = |t: f64| (2.0 * t / (1.0 + t * t), (1.0 - t * t) / (1.0 + t * t));
    let t = logarithmic_newton(1.0 / ratio, start, |t| {
        let (sine, cosine) = sine_and_cosine(t);
        // The load of a flat with rounded edges is this difference, free of cancellation for angles up to π/2.
        let difference = if t > 1.0 {
            2.0 * t.atan2(1.0) - sine * cosine
        } else {
            0.5 * Size::new(ShapeKind::RoundedFlat, cosine, sine).load()
        };
        let quotient = difference / (sine * sine);
        [quotient, 2.0 * (sine / quotient - cosine)]
    });
    let (sine, half) = (sine_and_cosine(t).0, t / (1.0 + t * t).sqrt());
    let stiffness = PI * imaginary / sine / sine;
    Ok(SpringSlider { stiffness, slip_force: (stiffness * half) * (amplitude * half) })
}

/// Largest number of sliders. With it the error is 4e-12 of mu N for a cylinder, and the computation takes seconds.
pub const MAX_SLIDERS: usize = 1 << 16;

/// Checks a number of sliders.
/// Errors: `BadCount` for 0 sliders, or more than [`MAX_SLIDERS`].
pub fn check_count(sliders: usize) -> Result<(), Error> {
    ensure((1..=MAX_SLIDERS).contains(&sliders), Error::BadCount)
}

/// n parallel spring-sliders with the contact's monotonic curve; `emit` is called for each. Returns the maximum error of the
/// force over mu N.
///
/// The monotonic curve of the sliders is a polygon from 0 to mu N. Its maximum error is smallest if every side is as far below the
/// curve of the contact as every corner is above it (equioscillation). For a given error the sides are constructed one after the
/// other: each is tangent to the curve lowered by the error and ends on the curve raised by the error. The error for which n sides
/// just reach mu N is found by bisection.
/// Errors: that of [`check_count`].
pub fn iwan(contact: &Contact, sliders: usize, mut emit: impl FnMut(SpringSlider)) -> Result<f64, Error> {
    check_count(sliders)?;
    if contact.is_frictionless() {
        (0..sliders).for_each(|_| emit(SpringSlider { stiffness: 0.0, slip_force: 0.0 }));
        return Ok(0.0);
    }
    let zones = &contact.zones;
    let (mut low, mut high) = (1e-18_f64, 1.0_f64);
    while high > low * (1.0 + 1e-6) {
        let error = (low * high).sqrt();
        let before_slip = |corner: Corner, _| Some(side(zones, &corner, error).1).filter(|next| next.force < 1.0);
        // Whether the given number of sides reaches mu N.
        if (0..sliders).try_fold(Corner::default(), before_slip).is_none() {
            high = error;
        } else {
            low = error;
        }
    }
    let (mut slope, mut corner) = side(zones, &Corner::default(), high);
    for _ in 0..sliders {
        let next = if corner.force < 1.0 { side(zones, &corner, high) } else { (0.0, corner) };
        let stiffness = (slope - next.0).max(0.0);
        emit(SpringSlider {
            stiffness: stiffness * contact.stiffness_scale,
            slip_force: stiffness * corner.shift * contact.slip_force,
        });
        (slope, corner) = next;
    }
    Ok(high)
}

/// A corner of the curve of the sliders: shift, and force over mu N.
#[derive(Clone, Copy, Default)]
struct Corner {
    shift: f64,
    force: f64,
    /// Force over mu N on the curve of the contact at this shift.
    on_curve: f64,
}

/// Shift and tangent stiffness of the monotonic curve at a force over mu N.
fn shift_and_slope(zones: &StickZones, force: f64) -> (f64, f64) {
    let zone = zones.at_load(Complement { consumed: force, remaining: 1.0 - force });
    (zone.shift.consumed, 1.0 / zones.compliance(&zone))
}

/// Slope and end of the side from a corner: tangent to the curve lowered by the error, up to the curve raised by it or to mu N.
fn side(zones: &StickZones, from: &Corner, error: f64) -> (f64, Corner) {
    let line = |slope: f64, shift: f64| from.force + slope * (shift - from.shift);
    let above_tangent = |force: f64| {
        let (shift, slope) = shift_and_slope(zones, force);
        force - error - line(slope, shift)
    };
    // The point of tangency: before gross slip, or at its onset.
    let (tangency, slope) = if above_tangent(1.0) > 0.0 {
        let force = root(above_tangent, from.on_curve, 1.0);
        (force, shift_and_slope(zones, force).1)
    } else {
        (1.0, (1.0 - error - from.force).max(0.0) / (zones.slip_shift - from.shift).max(f64::MIN_POSITIVE))
    };
    let above = |force: f64| line(slope, shift_and_slope(zones, force).0) - force - error;
    if tangency < 1.0 && above(1.0) > 0.0 {
        let on_curve = root(above, tangency, 1.0);
        if on_curve + error < 1.0 {
            let (shift, _) = shift_and_slope(zones, on_curve);
            return (slope, Corner { shift, force: on_curve + error, on_curve });
        }
    }
    let shift = from.shift + (1.0 - from.force) / slope.max(f64::MIN_POSITIVE);
    (slope, Corner { shift, force: 1.0, on_curve: 1.0 })
}

/// The root between `low`, at which the function is <= 0, and `high`, at which it is >= 0, by regula falsi. If an end is kept twice
/// in a row, its value is halved (Illinois method).
fn root(function: impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    let (mut low, mut high) = ((low, function(low)), (high, function(high)));
    let mut last = None;
    for _ in 0..100 {
        let secant = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1).max(f64::MIN_POSITIVE);
        let next = if secant > low.0 && secant < high.0 { secant } else { 0.5 * (low.0 + high.0) };
        let value = function(next);
        let raised_low = value < 0.0;
        if raised_low {
            low = (next, value);
            high.1 *= if last == Some(true) { 0.5 } else { 1.0 };
        } else {
            high = (next, value);
            low.1 *= if last == Some(false) { 0.5 } else { 1.0 };
        }
        last = Some(raised_low);
        if high.0 - low.0 <= 4.0 * f64::EPSILON * high.0 || value == 0.0 {
            break;
        }
    }
    if low.1.abs() < high.1.abs() { low.0 } else { high.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constant_load::contact::tests::{contact, ellipse, elliptic};
    use crate::parameters::{EllipticParameters, Material};
    use std::vec::Vec;

    fn sliders(contact: &Contact, n: usize) -> (Vec<SpringSlider>, f64) {
        let mut found = Vec::new();
        let error = iwan(contact, n, |slider| found.push(slider)).unwrap();
        (found, error)
    }

    /// A stiff contact under a small load: the amplitudes are up to 10²²⁰ times the displacement of gross slip.
    #[test]
    fn jenkins_is_constant_at_the_largest_amplitudes() {
        let contact = Contact::elliptic(&EllipticParameters {
            normal_force: 1e-10,
            friction_coefficient: 1e-10,
            material: [Material { young_modulus: 1e60, poisson_ratio: 0.3 }; 2],
            ..elliptic(1e-3, 1e-3)
        })
        .unwrap();
        let of = |times: f64| jenkins(&contact, times * contact.slip_displacement).unwrap();
        let large = of(1e40);
        for larger in [1e100, 1e150, 1e205, 1e210, 1e216, 1e222].map(of) {
            assert!((larger.stiffness / large.stiffness - 1.0).abs() < 1e-14, "{larger:?} {large:?}");
            assert!((larger.slip_force / contact.slip_force - 1.0).abs() < 1e-14, "{larger:?}");
        }
    }

    /// The distance of a chord from an arc scales as the square of its length.
    #[test]
    fn the_error_scales_as_the_inverse_square_of_the_number_of_sliders() {
        for contact in [contact(0.0), contact(50e-6), ellipse(1e-4, 2e-4)] {
            let [(few, error_few), (many, error_many)] = [8, 64].map(|n| sliders(&contact, n));
            assert!((48.0..80.0).contains(&(error_few / error_many)), "{error_few} {error_many}");
            for (sliders, error) in [(few, error_few), (many, error_many)] {
                // The error is the smallest if it is attained at every corner: at the last one, where the sliders reach mu N, the
                // 1e-6 of the bisection is amplified by 4 for each slider.
                let last = sliders.iter().map(|one| one.slip_force / one.stiffness).fold(0.0, f64::max);
                let at_last = 1.0 - contact.curve_at_displacement(last).unwrap().force() / contact.slip_force;
                assert!((at_last / error - 1.0).abs() < 4e-6 * sliders.len() as f64, "{at_last} {error}");
                // The initial stiffness of the sliders is the slope of their first side, a little less than that of the curve.
                let stiffness: f64 = sliders.iter().map(|one| one.stiffness).sum();
                assert!(stiffness <= contact.initial_stiffness && stiffness > 0.9 * contact.initial_stiffness);
            }
        }
    }
}
