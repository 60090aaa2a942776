//! Tractions and slip of the rounded flat (Eq. 15, 17, 21-24), as integrals over the family.
//!
//! Each size of contact c' that the load runs through adds the pressure of a flat punch, `dP/(π sqrt(c'² - x²))`, with
//! `dP ∝ ψ c' dc' = ψ w' dw'`. The pressure of a contact and, by superposition of two, the shear traction with stick zone c
//! are therefore one integral between two members of the family,
//!
//! ```text
//! I = ∫ ψ c' dc'/sqrt(c'² - x²)          from max(c, |x|) to b.
//! ```
//!
//! Slip at x is the same superposition of the surface displacement beside the punches, `∫ acosh(|x|/c') ψ c' dc'` from c to
//! |x|. Both have elementary antiderivatives; Eq. 17 and 22 are the first, mended. Where the antiderivative cancels (a
//! narrow slip zone, a nearly flat contact), the integrand is smooth and positive, and 16 Gauss points give all digits.

use crate::numerics::quadrature::gauss;
use crate::shape::rounded_punch::{RoundedPunch, TINY};
use crate::shape::stick_zone::SurfacePoint;

/// How much smaller than its terms a sum may be before the quadrature takes over: six bits lost.
const CANCELLED: f64 = 1.0 / 64.0;

/// `∫ ψ c' dc'/sqrt(c'² - x²)` over the members with w between `from` and `to`, lengths in the units of the flat. A narrow
/// slip zone needs the difference of their squares, `squares`, by itself.
pub(crate) fn pressure_between(flat: f64, from: f64, to: f64, squares: f64, place: &SurfacePoint) -> f64 {
    let outside = outside(flat, place);
    let edge = outside.max(0.0).sqrt();
    if edge >= to {
        return 0.0;
    }
    let (outer, outer_size) = antiderivative(flat, to, place);
    // The antiderivative vanishes where the integral starts at the middle of the flat or at x itself.
    let (start, inner, inner_size) = if from > edge {
        let (inner, size) = antiderivative(flat, from, place);
        (from, inner, size)
    } else {
        (edge, 0.0, 0.0)
    };
    let closed = outer - inner;
    if closed.abs() >= CANCELLED * (outer_size + inner_size) {
        return closed;
    }
    let zeta = |w: f64| (w * w - outside).max(0.0).sqrt();
    let squares = if from > edge { squares } else { to * to - edge * edge };
    if outside < 0.0 {
        gauss(squares / (to + start), |step| {
            let w = start + step;
            w.atan2(flat) * w / zeta(w).max(TINY)
        })
    } else {
        // In ζ the root at c' = x is gone.
        let first = if from > edge { zeta(from) } else { 0.0 };
        let length = squares / (zeta(to) + first).max(TINY);
        gauss(length, |step| {
            let zeta = first + step;
            (zeta * zeta + outside).sqrt().atan2(flat)
        })
    }
}

/// x² - a²: w² of the member of size x, where there is one.
fn outside(flat: f64, place: &SurfacePoint) -> f64 {
    place.past_flat * (place.x + flat)
}

/// The antiderivative at w and the size of its terms. With `ζ = sqrt(c² - x²)`,
///
/// ```text
/// ψ ζ + x ln[(a ζ + x w)/(c (w + ζ))] - (a - x) ln[(w + ζ)/sqrt|a² - x²|]
/// ```
///
/// which vanishes at w = 0 inside the flat and at c = x outside it, and is finite at x = a.
fn antiderivative(flat: f64, w: f64, place: &SurfacePoint) -> (f64, f64) {
    let RoundedPunch { half_width: c, psi, .. } = RoundedPunch::new(flat, w);
    let outside = outside(flat, place);
    let zeta = (w * w - outside).max(0.0).sqrt();
    let sum = (w + zeta).max(TINY);
    let c = c.max(TINY);
    let less = w * w / (c * (flat + c)) - place.past_flat * w / (c * sum);
    let terms =
        [psi * zeta, place.x * (-less).max(-1.0 + 1e-16).ln_1p(), place.past_flat * log_ratio(w, zeta, outside)];
    (terms.iter().sum(), terms.iter().map(|term| term.abs()).sum())
}

/// `ln[(w + ζ)/sqrt|outside|]` with `ζ² = w² - outside`, accurate also where the quotient is near 1.
fn log_ratio(w: f64, zeta: f64, outside: f64) -> f64 {
    let edge = outside.abs().sqrt().max(1e-150);
    let above = if outside < 0.0 { w + w * w / (zeta + edge) } else { (w - edge).max(0.0) + zeta };
    (above / edge).ln_1p()
}

/// `∫ acosh(x/c') ψ c' dc'` from the stick zone to |x|; 0 inside the stick zone. With `ξ = sqrt(x² - c²)` it is half of
///
/// ```text
/// x ψ ξ + (x² + a²) atan2(a ξ, x w) - 2 a x atan2(ξ, w) - (g_c/2) acosh(x/c).
/// ```
pub(crate) fn slip_beyond(stick: &RoundedPunch, place: &SurfacePoint) -> f64 {
    let RoundedPunch { flat: a, w, half_width: c, psi } = *stick;
    let x = place.x;
    let w_x = outside(a, place).max(0.0).sqrt();
    if w_x <= w {
        return 0.0;
    }
    let xi = ((w_x - w) * (w_x + w)).sqrt();
    let log = acosh_ratio((w_x - w) * (w_x + w), x, c.max(1e-100));
    let terms =
        [x * psi * xi, (x * x + a * a) * (a * xi).atan2(x * w), -2.0 * a * x * xi.atan2(w), -0.5 * stick.load() * log];
    let closed: f64 = 0.5 * terms.iter().sum::<f64>();
    if closed >= CANCELLED * terms.iter().map(|term| term.abs()).sum::<f64>() {
        return closed;
    }
    // w = w_x - (w_x - w) z², which takes the root at c' = x away.
    let length = w_x - w;
    gauss(1.0, |z| {
        let gap = length * z * z;
        let now = RoundedPunch::new(a, w_x - gap);
        acosh_ratio(gap * (w_x + now.w), x, now.half_width.max(TINY)) * now.psi * now.w * 2.0 * z * length
    })
}

/// acosh(x/c), given `x² - c²`.
fn acosh_ratio(difference: f64, x: f64, c: f64) -> f64 {
    let above = difference / (c * (x + c)); // x/c - 1
    (above + (above * (2.0 + above)).sqrt()).ln_1p()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constant_load::contact::tests::{FLATS, contact};
    use crate::numerics::quadrature::TANH_SINH;
    use crate::{Contact, Material, Parameters};

    /// `∫ f` over (0, 1) by the tanh-sinh rule.
    fn unit(f: impl Fn(f64) -> f64) -> f64 {
        TANH_SINH.iter().map(|node| node.weight * f(node.from_0)).sum()
    }

    /// `∫ f` over both halves of the width, divided where f or its slope is singular.
    fn over_the_width(places: &[f64], f: impl Fn(f64) -> f64) -> f64 {
        places
            .iter()
            .zip(places.iter().skip(1))
            .map(|(from, to)| 2.0 * (to - from) * unit(|t| f(from + (to - from) * t)))
            .sum()
    }

    #[test]
    fn the_pressure_carries_the_load_and_the_shear_the_force() {
        for flat in FLATS {
            let contact = contact(flat);
            let b = contact.half_width;
            let load = over_the_width(&[0.0, flat, b], |x| contact.pressure(x)) * 10e-3;
            assert!((load / 150.0 - 1.0).abs() < 4e-15, "{flat}: {load}");
            for part in [1e-3, 0.3, 0.6, 0.999] {
                let force = part * contact.slip_force;
                let point = contact.curve_at_force(force).unwrap();
                let places = [0.0, flat, point.stick_half_width(), b];
                let sum = over_the_width(&places, |x| point.shear(x)) * 10e-3;
                // The slip zone's width, a part of b, is known to a unit of rounding of b.
                let bound = 4e-15 + 4.0 * f64::EPSILON / part.min(1.0 - part).min(0.1);
                assert!((sum / force - 1.0).abs() < bound, "{flat} {part}: {sum} {force}");
            }
        }
    }

    /// Bands of the family, narrow ones among them, as `w` over that of b.
    const BANDS: [(f64, f64); 6] = [(0.0, 1.0), (0.0, 0.1), (0.3, 1.0), (0.7, 0.72), (0.99, 1.0), (0.999999, 1.0)];
    /// a/b.
    const SHAPES: [f64; 5] = [0.0, 1e-3, 0.4, 0.9, 0.999];

    fn width(flat: f64) -> f64 {
        ((1.0 - flat) * (1.0 + flat)).sqrt()
    }

    #[test]
    fn closed_form_and_quadrature_are_the_integral_of_punches() {
        for flat in SHAPES {
            for (low, high) in BANDS {
                let (from, to) = (low * width(flat), high * width(flat));
                let squares = (high - low) * (high + low) * width(flat) * width(flat);
                // Positions by w: inside the flat to its middle, at its end, and beyond.
                let outside = [-1.0, -0.5, -1e-6, 0.0, 1e-6, 0.01, 0.09, 0.5, 0.9801, 0.999];
                for outside in
                    outside.map(|share: f64| share * if share < 0.0 { flat * flat } else { 1.0 - flat * flat })
                {
                    let x = (flat * flat + outside).max(0.0).sqrt();
                    let past_flat = if outside == 0.0 { 0.0 } else { outside / (x + flat) };
                    let place = SurfacePoint { x, past_flat, from_edge: 1.0 - x };
                    let edge = outside.max(0.0).sqrt();
                    let start = edge.max(from);
                    // The root at c' = x is gone with w' = start + (to - start) t².
                    let (length, above) = if from > edge {
                        (squares / (to + from), from * from - outside)
                    } else {
                        (to - edge, (-outside).max(0.0))
                    };
                    let expected = if length <= 0.0 {
                        0.0
                    } else {
                        unit(|t| {
                            let step = length * t * t;
                            let root = (step * (2.0 * start + step) + above).sqrt();
                            2.0 * length * t * (start + step).atan2(flat) * (start + step) / root
                        })
                    };
                    let found = pressure_between(flat, from, to, squares, &place);
                    // Six bits lost at most, and a place just inside the band is known to the rounding of its squares.
                    let band = (to * to - outside).abs().min((from * from - outside).abs()).max(1e-300);
                    let bound = 64.0 * f64::EPSILON * 8.0 + 8.0 * f64::EPSILON / band.max(1e-12);
                    assert!(
                        (found - expected).abs() <= bound * expected,
                        "{flat} {low} {high} {x}: {found} {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn slip_is_the_integral_of_the_punches_displacement() {
        for flat in SHAPES {
            for (low, high) in BANDS {
                let (w_c, w_x) = (low * width(flat), high * width(flat));
                let x = flat.hypot(w_x);
                let place = SurfacePoint { x, past_flat: w_x * w_x / (x + flat), from_edge: 1.0 - x };
                let stick = RoundedPunch::new(flat, w_c);
                let expected = (w_x - w_c)
                    * unit(|t| {
                        let gap = (w_x - w_c) * t;
                        let now = RoundedPunch::new(flat, w_x - gap);
                        // acosh(x/c') from x² - c'².
                        let root = (gap * (w_x + now.w)).sqrt();
                        (root / now.half_width.max(TINY)).asinh().min(1e3) * now.psi * now.w
                    });
                let found = slip_beyond(&stick, &place);
                // Six bits lost at most; the band's width to the rounding of both ends, as (w_x - w_c)^(3/2).
                let bound = 64.0 * f64::EPSILON * 8.0 + 8.0 * f64::EPSILON / (high - low);
                assert!((found / expected - 1.0).abs() < bound, "{flat} {low} {high}: {found} {expected}");
            }
        }
    }

    #[test]
    fn slip_grows_from_the_stick_edge_to_the_edge_of_contact() {
        for flat in FLATS {
            let contact = contact(flat);
            let b = contact.half_width;
            for part in [0.01, 0.5, 0.9, 1.0] {
                let point = contact.curve_at_force(part * contact.slip_force).unwrap();
                let c = point.stick_half_width();
                let mut last = 0.0;
                for k in 0..=40 {
                    let x = c + (b - c) * k as f64 / 40.0;
                    let slip = point.slip(if k == 40 { b } else { x }).unwrap();
                    // At the stick edge itself rounding may leave a sliver, (1e-13)^(3/2) of the slip beyond.
                    assert!(
                        if k == 0 { slip <= 1e-15 * contact.slip_displacement } else { slip > last },
                        "{flat} {part} {k}"
                    );
                    assert_eq!(point.slip(-x), point.slip(x));
                    last = slip;
                }
                assert_eq!((point.slip(0.999 * c), point.slip(b * (1.0 + 1e-15))), (Ok(0.0), Ok(0.0)));
                // The edge slips against the centre by less than the centre moves.
                assert!(last < point.displacement(), "{flat} {part}: {last}");
            }
        }
    }

    #[test]
    fn tractions_are_continuous_at_the_flat_the_stick_edge_and_the_edge() {
        for flat in FLATS {
            let contact = contact(flat);
            let b = contact.half_width;
            let (peak, step) = (contact.pressure(0.0), 1e-10 * (b - flat));
            // Steps of 1e-10, or of rounding where the contact is nearly all flat.
            let part = step.max(2.0 * f64::EPSILON * b) / (b - flat);
            let [below, at, above] = [-1.0, 0.0, 1.0].map(|side| contact.pressure(flat + side * part * (b - flat)));
            // The slope there is a logarithm of the distance.
            assert!((below - at).abs().max((above - at).abs()) < 40.0 * part * peak.max(at), "{flat}");
            // A root of the distance, and at b of its rounding.
            assert!(contact.pressure(b - part * (b - flat)) < 4.0 * part.sqrt() * at);
            assert!(contact.pressure(b) < 4.0 * (2.0 * f64::EPSILON * b / (b - flat)).sqrt() * at);
            assert_eq!(contact.pressure(b * (1.0 + 1e-15)), 0.0);
            let point = contact.curve_at_force(0.6 * contact.slip_force).unwrap();
            let c = point.stick_half_width();
            let [below, at, above] = [-1.0, 0.0, 1.0].map(|side| point.shear(c + side * part * (b - flat)));
            // A root on the inner side.
            assert!((below - at).abs().max((above - at).abs()) < 4.0 * part.sqrt() * at, "{flat} {below} {at} {above}");
            // Coulomb's limit holds throughout the slip zone.
            for x in [c * (1.0 + 1e-12), 0.5 * (b + c), b - 1e-3 * (b - c)] {
                assert!((point.shear(x) / (0.4 * contact.pressure(x)) - 1.0).abs() < 1e-12, "{flat} {x}");
            }
        }
    }

    /// A flat that no digit feels: in gross slip ψ is 0 on it, however small it is.
    #[test]
    fn slip_of_the_smallest_flat_is_that_of_the_cylinder() {
        let cylinder = contact(0.0);
        let slip = |contact: &Contact, x: f64| contact.curve_at_force(contact.slip_force).unwrap().slip(x).unwrap();
        for flat in [1e-200, 1e-300, 3e-304, 1e-306] {
            for x in [0.1, 0.7, 1.0].map(|share| share * cylinder.half_width) {
                let quotient = slip(&contact(flat), x) / slip(&cylinder, x);
                assert!((quotient - 1.0).abs() < 1e-15, "{flat} {x}: {quotient}");
            }
        }
    }

    /// Edges so sharp that nothing is left of them: the flat punch, `p = P/(π sqrt(a² - x²))`.
    #[test]
    fn the_flattest_contact_has_the_pressure_of_a_flat_punch() {
        for radius in [1e-30, 1e-44, 1e-60] {
            let (flat, length, normal_force) = (5e-3, 1e-2, 150.0);
            let body = Material { young_modulus: 2e11, poisson_ratio: 0.3 };
            let parameters = Parameters {
                flat_half_width: flat,
                edge_radius: radius,
                length,
                normal_force,
                friction_coefficient: 0.4,
                material: [body; 2],
                ..Parameters::default()
            };
            let contact = Contact::rounded_flat(&parameters).unwrap();
            let end = contact.curve_at_force(contact.slip_force).unwrap();
            for place in 0..100 {
                let x = 0.0099 * flat * place as f64;
                let punch = normal_force / length / (core::f64::consts::PI * ((flat - x) * (flat + x)).sqrt());
                assert!((contact.pressure(x) / punch - 1.0).abs() < 1e-14, "{radius} {place}");
                assert!((end.shear(x) / (0.4 * punch) - 1.0).abs() < 1e-14, "{radius} {place}");
            }
        }
    }
}
