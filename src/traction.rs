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

use crate::family::Place;
use crate::indentation::{Indentation, TINY};
use crate::quadrature::gauss;

/// How much smaller than its terms a sum may be before the quadrature takes over: six bits lost.
const CANCELLED: f64 = 1.0 / 64.0;

/// `∫ ψ c' dc'/sqrt(c'² - x²)` over the members with w between `from` and `to`, lengths in the units of the flat. A narrow
/// slip zone needs the difference of their squares, `squares`, by itself.
pub(crate) fn pressure_between(flat: f64, from: f64, to: f64, squares: f64, place: &Place) -> f64 {
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
fn outside(flat: f64, place: &Place) -> f64 {
    place.beyond_flat * (place.x + flat)
}

/// The antiderivative at w and the size of its terms. With `ζ = sqrt(c² - x²)`,
///
/// ```text
/// ψ ζ + x ln[(a ζ + x w)/(c (w + ζ))] + (a - x) ln[sqrt|a² - x²|/(w + ζ)]
/// ```
///
/// which vanishes at w = 0 inside the flat and at c = x outside it, and is finite at x = a.
fn antiderivative(flat: f64, w: f64, place: &Place) -> (f64, f64) {
    let Indentation { half_width: c, psi, .. } = Indentation::new(flat, w);
    let outside = outside(flat, place);
    let zeta = (w * w - outside).max(0.0).sqrt();
    let sum = (w + zeta).max(TINY);
    let c = c.max(TINY);
    let less = w * w / (c * (flat + c)) - place.beyond_flat * w / (c * sum);
    let terms = [
        psi * zeta,
        place.x * (-less).max(-1.0 + 1e-16).ln_1p(),
        -place.beyond_flat * (outside.abs().sqrt().max(TINY) / sum).ln(),
    ];
    (terms.iter().sum(), terms.iter().map(|term| term.abs()).sum())
}

/// `∫ acosh(x/c') ψ c' dc'` from the stick zone to |x|; 0 inside the stick zone. With `ξ = sqrt(x² - c²)` it is half of
///
/// ```text
/// x ψ ξ + (x² + a²) atan2(a ξ, x w) - 2 a x atan2(ξ, w) - (g_c/2) acosh(x/c).
/// ```
pub(crate) fn slip_beyond(stick: &Indentation, place: &Place) -> f64 {
    let Indentation { flat: a, w, half_width: c, psi } = *stick;
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
        let now = Indentation::new(a, w_x - gap);
        acosh_ratio(gap * (w_x + now.w), x, now.half_width.max(TINY)) * now.psi * now.w * 2.0 * z * length
    })
}

/// acosh(x/c), given `x² - c²`.
fn acosh_ratio(difference: f64, x: f64, c: f64) -> f64 {
    let above = difference / (c * (x + c)); // x/c - 1
    (above + (above * (2.0 + above)).sqrt()).ln_1p()
}
