//! The family of the flat with rounded edges, cylinder included: the paper's contact.
//!
//! Lengths are in units of the contact's half-width b, loads in units of P, approaches in units of 2μP/(πE*). With the
//! functions of the indentation at the stick zone c (index c) and at b, and `s = g_c/g_b = 1 - τ`,
//!
//! ```text
//! compliance       dx/dτ = Λ + λ,             λ = ln(b/c),   Λ = ln(2L/b) + ν/(1-ν)          Eq. 8-10
//! until gross slip  rest = s (Λ + λ + β_c)                    x = Λ + β_b - rest
//! energy               e = 4 [(1+s)(β_b - s β_c) - s λ - (γ_b - s² γ_c)]                      Eq. 13-16
//! ```
//!
//! Beyond τ = 1/2 these are computed as they stand; below, the series at the origin takes over.

use crate::family::{ContactFamily, Member, Origin, Place, Split, Station, TERMS};
use crate::indentation::{Indentation, TINY};
use crate::traction;
use core::f64::consts::PI;

/// A flat with rounded edges under its load, lengths in units of b.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RoundedFlat {
    /// a/b, and `sqrt(1 - (a/b)²)` by itself.
    flat: f64,
    w: f64,
    psi: f64,
    load: f64,
    mean_load: f64,
    mean_square: f64,
    slip_approach: f64,
    origin: Origin,
}

impl RoundedFlat {
    /// No contact.
    pub(crate) const EMPTY: RoundedFlat = RoundedFlat {
        flat: 0.0,
        w: 0.0,
        psi: 0.0,
        load: 0.0,
        mean_load: 0.0,
        mean_square: 0.0,
        slip_approach: 0.0,
        origin: Origin::new(0.0, [0.0; TERMS]),
    };

    /// The contact `b` (lengths in units of its half-width), with the compliance Λ of its full stick.
    pub(crate) fn new(contact: &Indentation, compliance: f64) -> RoundedFlat {
        let load = contact.load();
        let mean_load = contact.mean_load(load);
        RoundedFlat {
            flat: contact.flat,
            w: contact.w,
            psi: contact.psi,
            load,
            mean_load,
            mean_square: contact.mean_square(load),
            slip_approach: compliance + mean_load,
            origin: Origin::new(compliance, curvature_series(contact, load)),
        }
    }

    /// ln(b/c), accurate also where c is near b.
    fn excess(&self, inner: &Indentation) -> f64 {
        let size = inner.half_width * inner.half_width;
        if size < 0.5 {
            -0.5 * size.max(TINY).ln()
        } else {
            -0.5 * (-(self.w - inner.w) * (self.w + inner.w)).max(-0.5).ln_1p()
        }
    }

    /// What the formulas above make of a stick zone.
    fn inner(&self, inner: &Indentation) -> Member {
        let load = inner.load();
        let (rest, excess) = (load / self.load, self.excess(inner));
        let left = rest * (self.origin.compliance + excess + inner.mean_load(load));
        Member {
            load: Split { lost: 1.0 - rest, rest },
            approach: Split { lost: self.slip_approach - left, rest: left },
            excess,
            measure: Some(inner.w / self.w),
        }
    }

    fn stick(&self, member: &Member) -> Indentation {
        Indentation::new(self.flat, self.w * self.measure(member))
    }
}

impl ContactFamily for RoundedFlat {
    fn origin(&self) -> &Origin {
        &self.origin
    }

    fn slip_approach(&self) -> f64 {
        self.slip_approach
    }

    fn at_load_rest(&self, rest: f64) -> Member {
        let inner = Indentation::of_load(self.flat, rest * self.load);
        let member = self.inner(&inner);
        let excess = if rest > 0.0 || self.flat > 0.0 { member.excess } else { f64::INFINITY };
        Member { load: Split { lost: 1.0 - rest, rest }, excess, ..member }
    }

    /// Halley's iteration on w. The guess takes Λ + λ + β for constant, once from τ = 1/2 and once from there.
    fn at_approach_rest(&self, rest: f64) -> Member {
        let half = self.slip_approach - self.origin.half_approach;
        let mut load = 0.5 * rest / half * self.load;
        let mut inner = Indentation::of_load_roughly(self.flat, load);
        load = rest / (self.origin.compliance + self.excess(&inner) + inner.mean_load(inner.load())) * self.load;
        inner = Indentation::of_load_roughly(self.flat, load);
        for _ in 0..6 {
            let (w, c2) = (inner.w, inner.half_width * inner.half_width);
            let now = self.inner(&inner);
            let compliance = self.origin.compliance + now.excess;
            let slope = (4.0 * w * inner.psi * compliance).max(TINY);
            let bend = inner.bend() * compliance - 4.0 * w * w * inner.psi / c2.max(TINY);
            let newton = (now.approach.rest - rest) * self.load / slope;
            let step = newton / (1.0 - 0.5 * newton * bend / slope).max(0.5);
            inner = Indentation::new(self.flat, (w - step).max(0.0));
            if step.abs() <= 1e-6 * w {
                break;
            }
        }
        let member = self.inner(&inner);
        let excess = if rest > 0.0 || self.flat > 0.0 { member.excess } else { f64::INFINITY };
        Member { approach: Split { lost: self.slip_approach - rest, rest }, excess, ..member }
    }

    fn dissipation_beyond_half(&self, member: &Member) -> f64 {
        let inner = self.stick(member);
        let load = inner.load();
        let s = member.load.rest;
        // At gross slip s vanishes faster than the logarithm of the cylinder grows.
        let work = s * member.excess.min(1e3);
        let (mean, square) = (inner.mean_load(load), inner.mean_square(load));
        4.0 * ((1.0 + s) * (self.mean_load - s * mean) - work - (self.mean_square - s * s * square))
    }

    fn size(&self, member: &Member) -> f64 {
        (-member.excess).exp()
    }

    fn measure(&self, member: &Member) -> f64 {
        member.measure.unwrap_or_else(|| (1.0 + (-2.0 * member.excess).exp_m1() / (self.w * self.w)).max(0.0).sqrt())
    }

    fn station(&self, measure: f64) -> Station {
        let w = self.w * measure;
        let inner = Indentation::new(self.flat, w);
        let member = self.inner(&inner);
        let c2 = inner.half_width * inner.half_width;
        Station {
            approach: member.approach,
            compliance: self.compliance(&member),
            load_rate: self.w * 4.0 * w * inner.psi / self.load,
            excess_rate: self.w * w / c2.max(TINY),
        }
    }

    fn pressure(&self, place: &Place) -> f64 {
        traction::pressure_between(self.flat, 0.0, self.w, place) * 4.0 / (PI * self.load)
    }

    fn shear(&self, place: &Place, stick: &Member) -> f64 {
        traction::pressure_between(self.flat, self.stick(stick).w, self.w, place) * 4.0 / (PI * self.load)
    }

    fn slip(&self, place: &Place, stick: &Member) -> Option<f64> {
        Some(traction::slip_beyond(&self.stick(stick), place) * 4.0 / self.load)
    }
}

/// Coefficients of h''(τ) at τ = 0.
///
/// With `q = 1/h'' = 4 c² ψ/g_b`, `k = cot ψ` and `r = 1/ψ` along the family,
///
/// ```text
/// q' = -(2 + k r),      k' = k (1 + k²)/q,      r' = r² k/q,
/// ```
///
/// so that 1/q, k and r have positive coefficients throughout: nothing cancels, whatever a/b is. All three are scaled by
/// the contact's own ψ to stay near 1 for the flattest contact.
fn curvature_series(contact: &Indentation, load: f64) -> [f64; TERMS] {
    let psi = contact.psi;
    let psi2 = psi * psi;
    let first = 4.0 * psi * psi2 / load;
    // In the order in which coefficient n of each follows from those before.
    let mut q_rate = Series::NEW; // -q'
    let mut q_less = Series::NEW; // -(q - q_0), coefficients from 1 on
    let (mut curvature, mut k, mut r) = (Series::NEW, Series::NEW, Series::NEW); // 1/q, k, r
    let (mut growth, mut k_square, mut r_square) = (Series::NEW, Series::NEW, Series::NEW); // k/q, ψ² + k², r²
    k.push(psi * contact.flat / contact.w);
    r.push(1.0);
    for n in 0..TERMS {
        let constant = |value: f64| if n == 0 { value } else { 0.0 };
        // From q (1/q) = 1.
        curvature.push((constant(1.0) + q_less.times(&curvature)) / first);
        q_rate.push(k.times(&r) + constant(2.0 * psi2));
        q_less.push(q_rate.last() / (n + 1) as f64);
        growth.push(k.times(&curvature));
        k_square.push(k.times(&k) + constant(psi2));
        r_square.push(r.times(&r));
        k.push(growth.times(&k_square) / (n + 1) as f64);
        r.push(r_square.times(&growth) / (n + 1) as f64);
    }
    curvature.coefficients.map(|coefficient| coefficient * psi2)
}

/// A power series as far as it is known.
struct Series {
    coefficients: [f64; TERMS],
    known: usize,
}

impl Series {
    const NEW: Series = Series { coefficients: [0.0; TERMS], known: 0 };

    fn known(&self) -> &[f64] {
        self.coefficients.get(..self.known).unwrap_or(&[])
    }

    fn last(&self) -> f64 {
        self.known().last().copied().unwrap_or(0.0)
    }

    /// The next coefficient; beyond the last that is kept it is dropped.
    fn push(&mut self, coefficient: f64) {
        if let Some(place) = self.coefficients.get_mut(self.known) {
            *place = coefficient;
            self.known += 1;
        }
    }

    /// The coefficient of the product that both, known equally far, have last in common.
    fn times(&self, other: &Series) -> f64 {
        self.known().iter().zip(other.known().iter().rev()).map(|(one, two)| one * two).sum()
    }
}
