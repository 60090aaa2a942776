//! The paper's own equations, without the library: as they are printed, and as they hold. Integrals are done by quadrature.
//!
//! Lengths are in units of b, tractions in μP/b or P/b, displacements and slip in 2μP/(πE*).

use crate::cases::POISSON;
use quadrature::double_exponential;
use std::f64::consts::PI;

/// An equation as the paper prints it, or with its misprints mended.
#[derive(Clone, Copy, PartialEq)]
pub enum Reading {
    Printed,
    Mended,
}
use Reading::{Mended, Printed};

/// Right side of Eq. 1: `4PR/(a²E*)` for a/b.
pub fn load_of_flat(flat_over_width: f64, reading: Reading) -> f64 {
    let angle = flat_over_width.asin();
    let printed = (PI - 2.0 * angle) / (2.0 * angle.sin().powi(2)) - 1.0 / angle.tan();
    if reading == Printed { printed } else { 2.0 * printed }
}

/// Eq. 17: b p/P at x/b.
pub fn pressure(flat: f64, x: f64, reading: Reading) -> f64 {
    braces(flat, x, |sum, difference, edge| {
        // The printed exponents of the quotient: sin φ above, sin φ0 below.
        if reading == Printed { x * sum.ln() - edge * difference.ln() } else { x * (sum / difference).ln() }
    })
}

/// Eq. 22: c q*/(μP - Q) at x/c, with the flat a/c.
pub fn relieved_traction(flat: f64, x: f64, reading: Reading) -> f64 {
    match reading {
        // Without an exponent below the quotient.
        Printed => -braces(flat, x, |sum, difference, _| x * sum.ln() - difference.ln()),
        Mended => pressure(flat, x, Mended),
    }
}

/// What Eq. 17 and 22 share: the factor, and the braces with the given logarithm of the quotient.
fn braces(flat: f64, x: f64, quotient: impl Fn(f64, f64, f64) -> f64) -> f64 {
    if x.abs() > 1.0 {
        return 0.0;
    }
    let (angle, edge) = (x.asin(), flat.asin());
    let opening = PI - 2.0 * edge;
    let logarithm = quotient((angle + edge).sin().abs(), (angle - edge).sin().abs(), flat);
    let tangents = (((angle + edge) / 2.0).tan() * ((angle - edge) / 2.0).tan()).abs();
    // On the cylinder, whose logarithms vanish, their singularity remains at x = 0.
    let ends = if flat > 0.0 { logarithm + flat * tangents.ln() } else { 0.0 };
    2.0 / PI / (opening - (2.0 * edge).sin()) * (opening * angle.cos() + ends)
}

/// Half-width of the stick zone over b at Q/μP: Eq. 24 as it holds, by bisection.
pub fn stick_zone(flat: f64, force: f64) -> f64 {
    use crate::cases::load_of_size;
    let wanted = (1.0 - force) * load_of_size(flat, 1.0);
    let (mut low, mut high) = (flat, 1.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if load_of_size(flat, middle) < wanted { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// The tractions under a force that has turned once, or not yet.
pub struct Tractions {
    flat: f64,
    /// Stick zones with the traction μ(p - p*) of Eq. 21 that counts so many times; what it carries.
    terms: Vec<(f64, f64, f64)>,
}

impl Tractions {
    /// First loading to Q/μP.
    pub fn first(flat: f64, force: f64) -> Tractions {
        Tractions { flat, terms: vec![(1.0, stick_zone(flat, force), force)] }
    }

    /// After a reversal: on the way back slip starts anew from the edges, now against μp that the first loading left, so that
    /// it takes twice the traction, and half the change of the force decides how far it comes.
    pub fn after_reversal(flat: f64, reversal: f64, force: f64) -> Tractions {
        let half = (reversal - force) / 2.0;
        let mut tractions = Tractions::first(flat, reversal);
        tractions.terms.push((-2.0, stick_zone(flat, half), half));
        tractions
    }

    /// b q/(μP) at x/b.
    pub fn at(&self, x: f64) -> f64 {
        let traction = |&(times, stick, force): &(f64, f64, f64)| {
            // In gross slip nothing sticks.
            let kept =
                if force < 1.0 { (1.0 - force) / stick * pressure(self.flat / stick, x / stick, Mended) } else { 0.0 };
            times * (pressure(self.flat, x, Mended) - kept)
        };
        self.terms.iter().map(traction).sum()
    }

    /// Where the traction or its slope is singular, from 0 to 1.
    fn singular(&self) -> Vec<f64> {
        [0.0, self.flat, 1.0].into_iter().chain(self.terms.iter().map(|term| term.1)).collect()
    }

    /// ∫ q f(x) over the half x > 0 up to a limit; where f is singular is to be given too.
    fn integral(&self, limit: f64, also: f64, f: impl Fn(f64) -> f64) -> f64 {
        let mut points = self.singular();
        points.extend([also, limit]);
        integral(&points, limit, |x| self.at(x) * f(x))
    }

    /// Q/μP: twice the half.
    pub fn force(&self) -> f64 {
        2.0 * self.integral(1.0, 0.0, |_| 1.0)
    }

    /// Eq. 10, for L/b.
    pub fn displacement(&self, length: f64) -> f64 {
        2.0 * self.integral(1.0, 0.0, |x| (length / x).ln() + POISSON / (1.0 - POISSON))
    }

    /// The same with the inner integral of Eq. 7 as it is, before Eq. 8 makes L long.
    pub fn displacement_of_any_length(&self, length: f64) -> f64 {
        let ratio = POISSON / (1.0 - POISSON);
        2.0 * self
            .integral(1.0, 0.0, |x| (length / (2.0 * x)).asinh() + ratio / (1.0 + (2.0 * x / length).powi(2)).sqrt())
    }

    /// Eq. 3 at (0, 0, z), for L/b and z/b, over the displacement that their force makes there in one point.
    pub fn displacement_below(&self, length: f64, depth: f64) -> f64 {
        let kernel = |r: f64, s: f64| {
            let distance = (r * r + s * s + depth * depth).sqrt();
            let sum = distance + depth;
            1.0 / distance + (1.0 - 2.0 * POISSON) / sum + r * r / distance.powi(3)
                - (1.0 - 2.0 * POISSON) * r * r / (distance * sum * sum)
        };
        let half = length / 2.0;
        let quarter = self.integral(1.0, 0.0, |r| integral(&[0.0, half], half, |s| kernel(r, s)));
        4.0 * quarter / (self.force() * length * kernel(0.0, 0.0))
    }

    /// Eq. 15 at x/b > 0, positive along the force and 0 at the centre. The printed upper limit is the end of the flat.
    pub fn slip(&self, x: f64, reading: Reading) -> f64 {
        let limit = if reading == Printed { self.flat } else { 1.0 };
        let left = self.integral(1.0, 0.0, |r| ((x + r) / r).ln());
        left + self.integral(limit, x, |r| ((x - r) / r).abs().ln())
    }
}

/// ∫ f from 0 to a limit, piece by piece between the points.
pub fn integral(points: &[f64], limit: f64, f: impl Fn(f64) -> f64) -> f64 {
    let mut points: Vec<f64> = points.iter().copied().filter(|&point| point >= 0.0 && point <= limit).collect();
    points.sort_by(f64::total_cmp);
    points.dedup();
    points.windows(2).map(|piece| double_exponential::integrate(&f, piece[0], piece[1], 1e-14).integral).sum()
}
