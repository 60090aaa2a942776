//! Tractions and slip of the rounded flat (Eq. 15, 17, 21-24), as integrals over the contact size.
//!
//! Each contact size c' adds the pressure of a flat punch, `dP/(π sqrt(c'² - x²))`, with `dP ∝ ψ c' dc' = ψ leg' d leg'`. The
//! pressure of a contact and, by superposition of two, the shear traction with the stick zone c are therefore the same integral
//!
//! ```text
//! the integral = ∫ ψ c' dc'/sqrt(c'² - x²)          from max(c, |x|) to b.
//! ```
//!
//! Slip at x is the same superposition of the surface displacements outside the punches, `∫ acosh(|x|/c') ψ c' dc'` from c to |x|.
//! Both have elementary antiderivatives; Eq. 17 and 22, corrected, are the first. If their difference loses more than six bits to
//! cancellation (a narrow slip zone, a nearly flat contact), the integral is computed by 16-point Gauss-Legendre quadrature, which
//! is accurate to rounding: the integrand is smooth and positive.

use crate::numerics::guard::{TINY, root};
use crate::numerics::quadrature::gauss;
use crate::shape::size::Size;

/// A point along the width. Its differences are computed from the dimensional lengths, because for a nearly flat contact the
/// rounding error of x/b may exceed the distance from flat to edge.
pub(crate) struct SurfacePoint {
    /// |x|/b.
    pub x: f64,
    /// (|x| - a)/b.
    pub past_flat: f64,
    /// (b - |x|)/b.
    pub from_edge: f64,
}

impl SurfacePoint {
    /// The point x in units of the half-width b, at most 2: all points outside the contact are equivalent.
    pub fn new(x: f64, half_width: f64, flat: f64) -> SurfacePoint {
        let (x, unit) = (x.abs().min(2.0 * half_width), half_width.max(f64::MIN_POSITIVE));
        SurfacePoint { x: x / unit, past_flat: (x - flat.min(x + unit)) / unit, from_edge: (half_width - x) / unit }
    }
}

/// Ratio of a sum to its terms below which quadrature is used: six bits lost to cancellation.
const CANCELLATION_LIMIT: f64 = 1.0 / 64.0;

/// `∫ ψ c' dc'/sqrt(c'² - x²)` over the sizes with leg between `from` and `to`, lengths in the units of the flat. `square_difference` is the
/// difference `to² - from²`, computed without cancellation for a narrow slip zone.
pub(crate) fn pressure(size: &Size, [from, to, square_difference]: [f64; 3], point: &SurfacePoint) -> f64 {
    let outside = outside(size.flat, point);
    let edge = root(outside);
    if edge >= to {
        return 0.0;
    }
    let (upper, upper_magnitude) = antiderivative(size, to, point);
    // The antiderivative is 0 if the integral starts at leg = 0 or at c' = |x|.
    let (start, lower, lower_magnitude) = if from > edge {
        let (lower, size) = antiderivative(size, from, point);
        (from, lower, size)
    } else {
        (edge, 0.0, 0.0)
    };
    let closed = upper - lower;
    if closed.abs() >= CANCELLATION_LIMIT * (upper_magnitude + lower_magnitude) {
        return closed;
    }
    let root_inside = |leg: f64| root(leg * leg - outside);
    let square_difference = if from > edge { square_difference } else { to * to - edge * edge };
    if outside < 0.0 {
        gauss(square_difference / (to + start), |step| {
            let leg = start + step;
            leg.atan2(size.flat) * leg / root_inside(leg).max(TINY)
        })
    } else {
        // The substitution root_inside removes the square root at c' = |x|.
        let first = if from > edge { root_inside(from) } else { 0.0 };
        // root_inside(to)² >= to² - from²; the bound matters only if root_inside(to) vanishes, with rounding downward.
        let length = square_difference / (root_inside(to) + first).max(0.5 * root(square_difference)).max(TINY);
        gauss(length, |step| {
            let root_inside = first + step;
            (root_inside * root_inside + outside).sqrt().atan2(size.flat)
        })
    }
}

/// x² - a²: leg² of the contact of half-width |x|, if not negative.
fn outside(flat: f64, point: &SurfacePoint) -> f64 {
    point.past_flat * (point.x + flat)
}

/// The antiderivative at leg and the size of its terms. With `root_inside = sqrt(c² - x²)`,
///
/// ```text
/// ψ root_inside + x ln[(a root_inside + x leg)/(c (leg + root_inside))] - (a - x) ln[(leg + root_inside)/sqrt|a² - x²|]
/// ```
///
/// which vanishes at leg = 0 inside the flat and at c = x outside it, and is finite at x = a.
fn antiderivative(size: &Size, leg: f64, point: &SurfacePoint) -> (f64, f64) {
    let Size { flat, half_width: c, psi, .. } = size.resized(leg);
    let outside = outside(flat, point);
    let root_inside = root(leg * leg - outside);
    let sum = (leg + root_inside).max(TINY);
    let c = c.max(TINY);
    let decrease = leg * leg / (c * (flat + c)) - point.past_flat * leg / (c * sum);
    let terms = [
        psi * root_inside,
        point.x * (-decrease).max(-1.0 + 1e-16).ln_1p(),
        point.past_flat * log_ratio(leg, root_inside, outside),
    ];
    (terms.iter().sum(), terms.iter().map(|term| term.abs()).sum())
}

/// `ln[(leg + root_inside)/sqrt|outside|]` with `root_inside² = leg² - outside`, accurate also for a quotient close to 1.
fn log_ratio(leg: f64, root_inside: f64, outside: f64) -> f64 {
    let edge = outside.abs().sqrt().max(1e-150);
    let excess =
        if outside < 0.0 { leg + leg * leg / (root_inside + edge) } else { (leg - edge).max(0.0) + root_inside };
    (excess / edge).ln_1p()
}

/// `∫ acosh(x/c') ψ c' dc'` from the stick zone to |x|; 0 inside the stick zone. With `root_outside = sqrt(x² - c²)` it is half of
///
/// ```text
/// x ψ root_outside + (x² + a²) atan2(a root_outside, x leg) - 2 a x atan2(root_outside, leg) - (g_c/2) acosh(x/c).
/// ```
pub(crate) fn slip(stick: &Size, point: &SurfacePoint) -> f64 {
    let Size { flat: a, leg, half_width: c, psi, .. } = *stick;
    let x = point.x;
    let leg_at_x = root(outside(a, point));
    if leg_at_x <= leg {
        return 0.0;
    }
    let root_outside = ((leg_at_x - leg) * (leg_at_x + leg)).sqrt();
    let log = acosh_ratio((leg_at_x - leg) * (leg_at_x + leg), x, c.max(1e-100));
    let terms = [
        x * psi * root_outside,
        (x * x + a * a) * (a * root_outside).atan2(x * leg),
        -2.0 * a * x * root_outside.atan2(leg),
        -0.5 * stick.load() * log,
    ];
    let closed: f64 = 0.5 * terms.iter().sum::<f64>();
    if closed >= CANCELLATION_LIMIT * terms.iter().map(|term| term.abs()).sum::<f64>() {
        return closed;
    }
    // The substitution leg' = leg_at_x - (leg_at_x - leg) z² removes the square root at c' = |x|.
    let length = leg_at_x - leg;
    gauss(1.0, |z| {
        let gap = length * z * z;
        let punch = stick.resized(leg_at_x - gap);
        acosh_ratio(gap * (leg_at_x + punch.leg), x, punch.half_width.max(TINY))
            * punch.psi
            * punch.leg
            * 2.0
            * z
            * length
    })
}

/// acosh(x/c), given `x² - c²`.
fn acosh_ratio(difference: f64, x: f64, c: f64) -> f64 {
    let excess = difference / (c * (x + c)); // x/c - 1
    (excess + (excess * (2.0 + excess)).sqrt()).ln_1p()
}

#[cfg(test)]
mod tests {
    use crate::Contact;
    use crate::constant_load::contact::tests::contact;

    /// For a flat far below the rounding error of b the slip is that of a cylinder, although ψ is 0 on the flat in gross slip.
    #[test]
    fn slip_of_a_tiny_flat_is_that_of_the_cylinder() {
        let cylinder = contact(0.0);
        let slip = |contact: &Contact, x: f64| contact.curve_at_force(contact.slip_force).unwrap().slip(x).unwrap();
        for flat in [1e-200, 1e-300, 3e-304, 1e-306] {
            for x in [0.1, 0.7, 1.0].map(|share| share * cylinder.half_width) {
                let quotient = slip(&contact(flat), x) / slip(&cylinder, x);
                assert!((quotient - 1.0).abs() < 1e-15, "{flat} {x}: {quotient}");
            }
        }
    }
}
