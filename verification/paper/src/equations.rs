//! The paper's equations as printed, where they have a misprint, and its integrals over the library's tractions.
//!
//! Lengths are in units of b, tractions in μP/b or P/b, displacements and slip in 2μP/(πE*).

use crate::cases::{Case, POISSON};
use quadrature::double_exponential;
use std::f64::consts::PI;

/// Right side of Eq. 1, `4PR/(a²E*)` for a/b, as printed: half of the correct value.
pub fn printed_load(flat: f64) -> f64 {
    let angle = flat.asin();
    (PI - 2.0 * angle) / (2.0 * flat * flat) - 1.0 / angle.tan()
}

/// Eq. 17 as printed, b p/P at x/b: the exponents of the quotient are sin φ above and sin φ0 below.
pub fn printed_pressure(flat: f64, x: f64) -> f64 {
    braces(flat, x, |sum, difference| x * sum.ln() - flat * difference.ln())
}

/// Eq. 22 as printed, c q*/(μP - Q) at x/c: no exponent below the quotient, and a minus in front.
pub fn printed_relieved_traction(flat: f64, x: f64) -> f64 {
    -braces(flat, x, |sum, difference| x * sum.ln() - difference.ln())
}

/// The factor and the braces of Eq. 17 and 22, with the given logarithm of the quotient.
fn braces(flat: f64, x: f64, quotient: impl Fn(f64, f64) -> f64) -> f64 {
    let (angle, edge) = (x.asin(), flat.asin());
    let opening = PI - 2.0 * edge;
    let logarithm = quotient((angle + edge).sin().abs(), (angle - edge).sin().abs());
    let tangents = (((angle + edge) / 2.0).tan() * ((angle - edge) / 2.0).tan()).abs();
    2.0 / PI / (opening - (2.0 * edge).sin()) * (opening * angle.cos() + logarithm + flat * tangents.ln())
}

/// The library's tractions under a force before or after a reversal, and the paper's integrals over them.
pub struct Tractions<'a> {
    case: &'a Case,
    state: Vec<f64>,
    /// Where the traction or its slope is singular, from 0 to 1.
    singular: Vec<f64>,
}

impl Tractions<'_> {
    /// First loading to Q/μP.
    pub fn first(case: &Case, force: f64) -> Tractions<'_> {
        Tractions {
            state: case.state_after(&[case.displacement(force)]),
            singular: vec![0.0, case.flat_over_width(), case.stick_zone(force), 1.0],
            case,
        }
    }

    /// Loaded to one Q/μP and brought back to another: half of the change of force determines the new stick zone.
    pub fn after_reversal(case: &Case, reversal: f64, force: f64) -> Tractions<'_> {
        let half = (reversal - force) / 2.0;
        let top = case.displacement(reversal);
        let zones = [0.0, case.flat_over_width(), case.stick_zone(reversal), case.stick_zone(half), 1.0];
        let state = case.state_after(&[top, top - 2.0 * case.displacement(half)]);
        Tractions { state, singular: zones.into(), case }
    }

    /// b q/(μP) at x/b.
    pub fn at(&self, x: f64) -> f64 {
        self.case.shear_of_state(&self.state, x)
    }

    /// ∫ q f(x) over x > 0 up to a limit; `also` is a singular point of f.
    fn integral(&self, limit: f64, also: f64, f: impl Fn(f64) -> f64) -> f64 {
        let points: Vec<f64> = self.singular.iter().copied().chain([also, limit]).collect();
        integral(&points, limit, |x| self.at(x) * f(x))
    }

    /// Eq. 10, for L/b.
    pub fn displacement(&self, length: f64) -> f64 {
        2.0 * self.integral(1.0, 0.0, |x| (length / x).ln() + POISSON / (1.0 - POISSON))
    }

    /// Eq. 15 at x/b > 0, positive along the force and 0 at the centre; the printed upper limit is a/b instead of 1.
    pub fn slip(&self, x: f64, limit: f64) -> f64 {
        let left = self.integral(1.0, 0.0, |r| ((x + r) / r).ln());
        left + self.integral(limit, x, |r| ((x - r) / r).abs().ln())
    }
}

/// ∫ f from 0 to a limit, piecewise between the points.
pub fn integral(points: &[f64], limit: f64, f: impl Fn(f64) -> f64) -> f64 {
    let mut points: Vec<f64> = points.iter().copied().filter(|&point| point >= 0.0 && point <= limit).collect();
    points.sort_by(f64::total_cmp);
    points.dedup();
    points.windows(2).map(|piece| double_exponential::integrate(&f, piece[0], piece[1], 1e-14).integral).sum()
}
