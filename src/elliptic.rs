//! The family of the elliptical Hertz contact (section 3.3), a sphere when both semi-axes are equal.
//!
//! Sizes are σ, the stick ellipse's semi-axes over those of the contact; loads go with σ³, the approach with σ², so that
//!
//! ```text
//! x = (3/2) [1 - (1-τ)^(2/3)],      dx/dτ = (1-τ)^(-1/3) = 1/σ,      in units of C0 μ N,
//! ```
//!
//! with C0 the initial compliance. Cerruti's displacement at the centre (Eq. 5) under `T/(2πbl) (1 - x²/b² - y²/l²)^(-1/2)`
//! gives it as a sum over both bodies,
//!
//! ```text
//! C0 = Σ (1+ν)/(π E) [(1-ν) J + ν J_cos],     J = ∫ dθ/W,  J_cos = ∫ cos²θ dθ/W,     W² = l² cos²θ + b² sin²θ,
//! ```
//!
//! θ from 0 to π/2: complete elliptic integrals, taken from the arithmetic-geometric mean.

use crate::family::{ContactFamily, Member, Origin, Place, Split, Station, TERMS};
use crate::indentation::TINY;
use crate::parameters::Material;
use core::f64::consts::{FRAC_PI_2, PI};

/// Shape-free: every elliptical contact has the same curve in its own units.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Elliptic;

/// h'' = (1/3) (1-τ)^(-4/3).
const CURVATURE: [f64; TERMS] = {
    let mut table = [1.0 / 3.0; TERMS];
    let mut n = 1;
    while n < TERMS {
        table[n] = table[n - 1] * (n as f64 + 1.0 / 3.0) / n as f64;
        n += 1;
    }
    table
};

static ORIGIN: Origin = Origin::new(1.0, CURVATURE);

const SLIP_APPROACH: f64 = 1.5;

/// J and J_cos over the semi-axes along (b) and across (l) the force \[1/m\].
///
/// With M the mean of both axes, J = π/(2M). The share of J that goes with the smaller axis' direction is
/// `½ [1 + Σ 2ⁿ c_n²/c_0²]`, where c_n are the half-differences of the means and c_0² = 1 - k'²: positive terms.
fn cerruti_integrals(along: f64, across: f64) -> (f64, f64) {
    let (small, large) = (along.min(across), along.max(across));
    let ratio = small / large;
    let (mut mean, mut geometric) = (1.0, ratio);
    // c_1²/c_0², then the following ones from c_{n+1} = c_n²/(4 M_{n+1}).
    let mut half = 0.5 * (1.0 - ratio);
    let mut square = 0.25 * (1.0 - ratio) / (1.0 + ratio);
    let mut power = 2.0;
    let mut sum = 1.0;
    for _ in 0..12 {
        sum += power * square;
        let next = 0.5 * (mean + geometric);
        geometric = (mean * geometric).sqrt();
        mean = next;
        let following = half * half / (2.0 * (mean + geometric));
        square *= (following / half.max(TINY)) * (following / half.max(TINY));
        half = following;
        power *= 2.0;
        if square <= 1e-18 {
            break;
        }
    }
    let all = FRAC_PI_2 / (0.5 * (mean + geometric)) / large;
    let share = 0.5 * sum;
    // sin² goes with the smaller axis: W² = large² (1 - k² sin²) for b < l, and with cos and sin exchanged for b > l.
    (all, if along <= across { all * (1.0 - share) } else { all * share })
}

impl Elliptic {
    /// C0 \[m/N\]: displacement per force of the full stick.
    pub fn initial_compliance(along: f64, across: f64, material: &[Material; 2]) -> f64 {
        let (all, cosine) = cerruti_integrals(along, across);
        material
            .iter()
            .map(|body| {
                let nu = body.poisson_ratio;
                (1.0 + nu) / (PI * body.young_modulus) * ((1.0 - nu) * all + nu * cosine)
            })
            .sum()
    }
}

impl ContactFamily for Elliptic {
    fn origin(&self) -> &Origin {
        &ORIGIN
    }

    fn slip_approach(&self) -> f64 {
        SLIP_APPROACH
    }

    fn at_load_rest(&self, rest: f64) -> Member {
        let size = rest.cbrt();
        let left = SLIP_APPROACH * size * size;
        let excess = if size > 0.0 { 1.0 / size.max(TINY) - 1.0 } else { f64::INFINITY };
        Member {
            load: Split { lost: 1.0 - rest, rest },
            approach: Split { lost: SLIP_APPROACH - left, rest: left },
            excess,
            measure: Some(size),
        }
    }

    fn at_approach_rest(&self, rest: f64) -> Member {
        let size = (rest / SLIP_APPROACH).max(0.0).sqrt();
        let load = size * size * size;
        let excess = if size > 0.0 { 1.0 / size.max(TINY) - 1.0 } else { f64::INFINITY };
        Member {
            load: Split { lost: 1.0 - load, rest: load },
            approach: Split { lost: SLIP_APPROACH - rest, rest },
            excess,
            measure: Some(size),
        }
    }

    /// `(4/3) ∫ (1-u) (u-s) u^(-4/3) du` from s to 1.
    fn dissipation_beyond_half(&self, member: &Member) -> f64 {
        let s = member.load.rest;
        let size = self.size(member);
        let square = size * size;
        (4.0 / 3.0) * (1.5 * (1.0 + s) * (1.0 - square) - 0.6 * (1.0 - s * square) + 3.0 * (s - square))
    }

    fn size(&self, member: &Member) -> f64 {
        1.0 / (1.0 + member.excess)
    }

    fn measure(&self, member: &Member) -> f64 {
        member.measure.unwrap_or_else(|| self.size(member))
    }

    fn station(&self, size: f64) -> Station {
        let left = SLIP_APPROACH * size * size;
        let inverse = 1.0 / size.max(1e-100);
        Station {
            approach: Split { lost: SLIP_APPROACH - left, rest: left },
            compliance: inverse,
            load_rate: 3.0 * size * size,
            excess_rate: inverse * inverse,
        }
    }

    fn pressure(&self, place: &Place) -> f64 {
        SLIP_APPROACH / PI * (place.inside_edge * (1.0 + place.x)).max(0.0).sqrt()
    }

    fn shear(&self, place: &Place, stick: &Member) -> f64 {
        let (size, x) = (self.size(stick), place.x);
        let outer = (place.inside_edge * (1.0 + x)).max(0.0).sqrt();
        let inner = ((size - x) * (size + x)).max(0.0).sqrt();
        // The difference of both roots, where both exist, from the difference of their squares.
        let difference = if inner > 0.0 { lost_size(stick) * (1.0 + size) / (outer + inner).max(TINY) } else { outer };
        SLIP_APPROACH / PI * difference
    }

    fn slip(&self, _place: &Place, _stick: &Member) -> Option<f64> {
        None
    }
}

/// 1 - σ from λ = 1/σ - 1.
fn lost_size(member: &Member) -> f64 {
    if member.excess < 1e300 { member.excess / (1.0 + member.excess) } else { 1.0 }
}
