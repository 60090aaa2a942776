//! Spring-sliders that stand in for a contact, for a solver that knows nothing else.
//!
//! - Jenkins: one spring with one slider, with the complex stiffness of the contact at one amplitude.
//! - Iwan: n of them in parallel, with the monotonic curve of the contact to the smallest error that n sliders allow.

use crate::constant_load::complex_stiffness::check_amplitude;
use crate::constant_load::contact::Contact;
use crate::error::Error;
use crate::shape::stick_zone::{Complement, StickZones};
use core::f64::consts::PI;

/// A spring of some stiffness that slips at some force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpringSlider {
    /// \[N/m\].
    pub stiffness: f64,
    /// \[N\].
    pub slip_force: f64,
}

/// The spring-slider with the contact's K' and K'' at a displacement amplitude \[m\].
///
/// A loop of amplitude A with slider force F and stiffness k has, with `cos Θ = 1 - 2 F/(kA)`,
/// `K' = (k/π) (Θ - sin Θ cos Θ)` and `K'' = (k/π) sin² Θ`: their quotient gives Θ. At the amplitude 0, where any slip force
/// does, it is the initial stiffness with mu N; where the contact carries no force both are 0.
///
/// # Errors
/// `BadAmplitude`.
pub fn jenkins(contact: &Contact, amplitude: f64) -> Result<SpringSlider, Error> {
    check_amplitude(amplitude)?;
    if contact.is_frictionless() {
        return Ok(SpringSlider { stiffness: 0.0, slip_force: 0.0 });
    }
    // The slider of a cycle so large is that of all larger ones, whose K' would underflow.
    let amplitude = amplitude.min(1e100 * contact.slip_displacement);
    let complex = contact.complex_stiffness(amplitude)?;
    let (real, imaginary) = (complex.real(), complex.imaginary());
    let ratio = imaginary / real.max(f64::MIN_POSITIVE);
    if amplitude <= 0.0 || ratio < f64::MIN_POSITIVE {
        let slip_force = if amplitude > 0.0 { real * amplitude } else { contact.slip_force };
        return Ok(SpringSlider { stiffness: real, slip_force });
    }
    let (sine, half) = if ratio > 1.0 { large_cycle(ratio) } else { small_cycle(ratio) };
    let stiffness = PI * imaginary / sine / sine;
    Ok(SpringSlider { stiffness, slip_force: (stiffness * half) * (amplitude * half) })
}

/// sin Θ and sin Θ/2 of a ratio up to 1, in which η = π - Θ is small: Newton's iteration on
/// `sin η/sqrt(π - η + sin η cos η) = sqrt(ratio)`, whose left side is nearly η/√π.
fn small_cycle(ratio: f64) -> (f64, f64) {
    let target = ratio.sqrt();
    let mut eta = PI.sqrt() * target;
    for _ in 0..6 {
        let (sine, cosine) = eta.sin_cos();
        let below = (PI - eta + sine * cosine).max(f64::MIN_POSITIVE);
        let slope = (cosine + sine * sine * sine / below) / below.sqrt();
        eta -= (sine / below.sqrt() - target) / slope;
    }
    (eta.sin(), (0.5 * eta).cos())
}

/// The same of a ratio above 1, in which Θ is small: Newton's iteration on `(Θ - sin Θ cos Θ)/sin² Θ = 1/ratio`, whose left side
/// is nearly 2Θ/3.
fn large_cycle(ratio: f64) -> (f64, f64) {
    let target = 1.0 / ratio;
    let mut angle = 1.5 * target;
    for _ in 0..6 {
        let (sine, cosine) = angle.sin_cos();
        let share = less_sine(2.0 * angle) / (2.0 * sine * sine).max(f64::MIN_POSITIVE);
        let slope = 2.0 - 2.0 * share * cosine / sine.max(f64::MIN_POSITIVE);
        angle -= (share - target) / slope;
    }
    (angle.sin(), (0.5 * angle).sin())
}

/// `s - sin s` for s up to 3.
fn less_sine(s: f64) -> f64 {
    if s > 1.2 {
        return s - s.sin();
    }
    // Each of ten terms over the one before it is -s²/((n+1)(n+2)).
    let mut sum = 1.0;
    let mut n = 23.0;
    while n > 5.0 {
        n -= 2.0;
        sum = 1.0 - s * s / ((n - 1.0) * n) * sum;
    }
    s * s * s / 6.0 * sum
}

/// So many sliders err by 4e-12 of mu N for a cylinder, and take seconds to find: more would only take longer.
pub const MOST_SLIDERS: usize = 1 << 16;

/// n parallel spring-sliders with the contact's monotonic curve; each is handed to `take`. Returns the largest error of the
/// force over mu N.
///
/// The sliders' curve is a polygon from the origin to mu N. It errs least when each of its sides dips below the contact's
/// curve by as much as its corners stand above it. For a given error the sides follow one after the other: a tangent to
/// the curve lowered by the error, up to the curve raised by it. The error with which n sides just reach mu N is found by
/// bisection.
///
/// # Errors
/// `BadCount` for no sliders, or more than [`MOST_SLIDERS`].
pub fn iwan(contact: &Contact, sliders: usize, mut take: impl FnMut(SpringSlider)) -> Result<f64, Error> {
    if !(1..=MOST_SLIDERS).contains(&sliders) {
        return Err(Error::BadCount);
    }
    if contact.is_frictionless() {
        (0..sliders).for_each(|_| take(SpringSlider { stiffness: 0.0, slip_force: 0.0 }));
        return Ok(0.0);
    }
    let curve = Curve::new(contact.stick_zones());
    let (mut low, mut high) = (1e-18_f64, 1.0_f64);
    for _ in 0..100 {
        let error = (low * high).sqrt();
        if curve.reaches_slip(error, sliders) {
            high = error;
        } else {
            low = error;
        }
        if high <= low * (1.0 + 1e-6) {
            break;
        }
    }
    let mut side = curve.side(&Corner::ORIGIN, high);
    for _ in 0..sliders {
        let corner = side.end;
        let next = if corner.force < 1.0 { curve.side(&corner, high) } else { Side { slope: 0.0, end: corner } };
        let stiffness = (side.slope - next.slope).max(0.0);
        take(SpringSlider {
            stiffness: stiffness * contact.stiffness_scale,
            slip_force: stiffness * corner.shift * contact.slip_force,
        });
        side = next;
    }
    Ok(high)
}

/// A corner of the sliders' curve: approach, and force over mu N.
#[derive(Debug, Clone, Copy)]
struct Corner {
    shift: f64,
    force: f64,
    /// Force over mu N of the contact's curve there.
    on_curve: f64,
}

impl Corner {
    const ORIGIN: Corner = Corner { shift: 0.0, force: 0.0, on_curve: 0.0 };
}

/// A side of the sliders' curve, by its slope and its end.
#[derive(Debug, Clone, Copy)]
struct Side {
    slope: f64,
    end: Corner,
}

/// The monotonic curve in its own units.
struct Curve<'a> {
    family: &'a dyn StickZones,
    /// Tangent stiffness just before gross slip.
    last_slope: f64,
}

impl<'a> Curve<'a> {
    fn new(family: &'a dyn StickZones) -> Curve<'a> {
        Curve { family, last_slope: 1.0 / family.compliance(&family.at_load_remaining(0.0)) }
    }

    /// Approach and tangent stiffness at a force over mu N.
    fn at(&self, force: f64) -> (f64, f64) {
        let stick = self.family.at_load(Complement { consumed: force, remaining: 1.0 - force });
        (stick.shift.consumed, 1.0 / self.family.compliance(&stick))
    }

    /// The side from a corner: tangent to the curve lowered by the error, up to the curve raised by it or to mu N.
    fn side(&self, from: &Corner, error: f64) -> Side {
        let slip = self.family.slip_shift();
        let lowered = |force: f64, shift: f64, slope: f64| force - error - from.force - slope * (shift - from.shift);
        let touch = |force: f64| {
            let (shift, slope) = self.at(force);
            lowered(force, shift, slope)
        };
        // Before the contact slips, or at the corner where it does.
        let (touching, slope) = if lowered(1.0, slip, self.last_slope) > 0.0 {
            let force = root(touch, from.on_curve, 1.0);
            (force, self.at(force).1)
        } else {
            (1.0, (1.0 - error - from.force).max(0.0) / (slip - from.shift).max(f64::MIN_POSITIVE))
        };
        let line = |shift: f64| from.force + slope * (shift - from.shift);
        let above = |force: f64| line(self.at(force).0) - force - error;
        if touching < 1.0 && above(1.0) > 0.0 {
            let on_curve = root(above, touching, 1.0);
            if on_curve + error < 1.0 {
                return Side { slope, end: Corner { shift: self.at(on_curve).0, force: on_curve + error, on_curve } };
            }
        }
        let shift = from.shift + (1.0 - from.force) / slope.max(f64::MIN_POSITIVE);
        Side { slope, end: Corner { shift, force: 1.0, on_curve: 1.0 } }
    }

    fn reaches_slip(&self, error: f64, sides: usize) -> bool {
        let mut corner = Corner::ORIGIN;
        for _ in 0..sides {
            corner = self.side(&corner, error).end;
            if corner.force >= 1.0 {
                return true;
            }
        }
        false
    }
}

/// The root between `low`, where the function is not positive, and `high`, where it is not negative: the secant between
/// both, with the value of an end that stays twice halved (Illinois' rule).
fn root(function: impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    let (mut low, mut high) = ((low, function(low)), (high, function(high)));
    let mut rose = None;
    for _ in 0..100 {
        let secant = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1).max(f64::MIN_POSITIVE);
        let next = if secant > low.0 && secant < high.0 { secant } else { 0.5 * (low.0 + high.0) };
        let value = function(next);
        let rises = value < 0.0;
        if rises {
            low = (next, value);
            high.1 *= if rose == Some(true) { 0.5 } else { 1.0 };
        } else {
            high = (next, value);
            low.1 *= if rose == Some(false) { 0.5 } else { 1.0 };
        }
        rose = Some(rises);
        if high.0 - low.0 <= 4.0 * f64::EPSILON * high.0 || value == 0.0 {
            break;
        }
    }
    if low.1.abs() < high.1.abs() { low.0 } else { high.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constant_load::contact::tests::{FLATS, contact, ellipse, parameters};
    use crate::parameters::{EllipticParameters, Material, Parameters};
    use std::vec::Vec;

    fn sliders(contact: &Contact, n: usize) -> (Vec<SpringSlider>, f64) {
        let mut found = Vec::new();
        let error = iwan(contact, n, |slider| found.push(slider)).unwrap();
        (found, error)
    }

    /// Largest error over mu N of parallel sliders, at all corners and on a grid of displacements to beyond gross slip.
    fn largest_error(contact: &Contact, sliders: &[SpringSlider]) -> f64 {
        let error = |displacement: f64| {
            let bank: f64 = sliders.iter().map(|one| (one.stiffness * displacement).min(one.slip_force)).sum();
            (bank - contact.curve_at_displacement(displacement).unwrap().force()).abs() / contact.slip_force
        };
        let grid = (0..=1500).map(|k| k as f64 / 1000.0 * contact.slip_displacement);
        grid.chain(sliders.iter().map(|one| one.slip_force / one.stiffness)).map(error).fold(0.0, f64::max)
    }

    #[test]
    fn a_spring_slider_at_rest_is_the_initial_stiffness_with_mu_n() {
        for contact in FLATS.map(contact) {
            let SpringSlider { stiffness, slip_force } = jenkins(&contact, 0.0).unwrap();
            assert_eq!((stiffness, slip_force), (contact.initial_stiffness, contact.slip_force));
            // A small cycle stretches the spring to little more than its slip force, the smaller the closer.
            for share in (9..100).map(|k| 10f64.powi(-k)) {
                let amplitude = share * contact.slip_displacement;
                let small = jenkins(&contact, amplitude).unwrap();
                assert!((small.stiffness / contact.initial_stiffness - 1.0).abs() < share + 4e-15);
                assert!((small.slip_force / (small.stiffness * amplitude) - 1.0).abs() < share + 4e-15);
            }
            // A large one is that of mu N: K'' = 4 F/(π A). Of a share u of the amplitude gross slip takes no notice.
            for u in [1e-6, 1e-12, 1e-100] {
                let large = jenkins(&contact, contact.slip_displacement / u).unwrap();
                assert!(
                    (large.slip_force / contact.slip_force - 1.0).abs() < 2.0 * u + 4e-15,
                    "{u} {}",
                    large.slip_force
                );
            }
        }
    }

    /// Stiff and hardly pressed: displacements of gross slip so small that amplitudes are 10²²⁰ of them.
    #[test]
    fn the_largest_cycles_have_one_spring_slider() {
        let contact = Contact::elliptic(&EllipticParameters {
            semi_axis_x: 1e-3,
            semi_axis_y: 1e-3,
            normal_force: 1e-10,
            friction_coefficient: 1e-10,
            material: [Material { young_modulus: 1e60, poisson_ratio: 0.3 }; 2],
        })
        .unwrap();
        let of = |times: f64| jenkins(&contact, times * contact.slip_displacement).unwrap();
        let large = of(1e40);
        for larger in [1e100, 1e150, 1e205, 1e210, 1e216, 1e222].map(of) {
            assert!((larger.stiffness / large.stiffness - 1.0).abs() < 1e-14, "{larger:?} {large:?}");
            assert!((larger.slip_force / contact.slip_force - 1.0).abs() < 1e-14, "{larger:?}");
        }
    }

    #[test]
    fn sliders_that_do_not_exist_are_refused_or_nothing() {
        let closed = contact(0.0);
        assert_eq!(jenkins(&closed, f64::NAN), Err(Error::BadAmplitude));
        for count in [0, MOST_SLIDERS + 1, usize::MAX] {
            assert_eq!(iwan(&closed, count, |_| unreachable!()), Err(Error::BadCount));
        }
        for without in [
            Parameters { normal_force: 0.0, ..parameters(0.0) },
            Parameters { friction_coefficient: 0.0, ..parameters(0.0) },
        ] {
            let contact = Contact::rounded_flat(&without).unwrap();
            assert_eq!(jenkins(&contact, 1e-6), Ok(SpringSlider { stiffness: 0.0, slip_force: 0.0 }));
            let (found, error) = sliders(&contact, 3);
            assert_eq!((found, error), ([SpringSlider { stiffness: 0.0, slip_force: 0.0 }; 3].to_vec(), 0.0));
        }
    }

    /// Every single slider of mu N, by its stiffness: none errs less.
    #[test]
    fn one_slider_is_the_best_there_is() {
        for contact in FLATS.map(contact).into_iter().chain([ellipse(1e-4, 2e-4)]) {
            let (found, error) = sliders(&contact, 1);
            assert!((found[0].slip_force / contact.slip_force - 1.0).abs() < 1e-12);
            let others = (0..=200).map(|k| {
                let stiffness = contact.initial_stiffness * (0.5 + 0.003 * k as f64);
                largest_error(&contact, &[SpringSlider { stiffness, slip_force: contact.slip_force }])
            });
            let best = others.fold(f64::INFINITY, f64::min);
            // The dip between the corners is smooth on the grid of displacements; that of stiffnesses has steps of 0.003.
            assert!(best >= error * (1.0 - 1e-4) - 1e-12 && best < error + 4e-3, "{best} {error}");
        }
    }

    /// A polygon's sides are as far from an arc as their length squared.
    #[test]
    fn the_error_of_many_sliders_falls_as_their_number_squared() {
        for contact in [contact(0.0), contact(50e-6), ellipse(1e-4, 2e-4)] {
            let [(few, error_few), (many, error_many)] = [8, 64].map(|n| sliders(&contact, n));
            assert!((48.0..80.0).contains(&(error_few / error_many)), "{error_few} {error_many}");
            for (sliders, error) in [(few, error_few), (many, error_many)] {
                let measured = largest_error(&contact, &sliders);
                // At a corner the error is reached.
                assert!((measured / error - 1.0).abs() < 1e-9, "{measured} {error}");
                // Their sum starts above the contact by less than a first side may.
                let stiffness: f64 = sliders.iter().map(|one| one.stiffness).sum();
                assert!(stiffness <= contact.initial_stiffness && stiffness > 0.9 * contact.initial_stiffness);
            }
        }
    }
}
