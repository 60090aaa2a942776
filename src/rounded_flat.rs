//! The family of the flat with rounded edges, cylinder included: the paper's contact.
//!
//! Lengths are in units of the contact's half-width b, loads in units of P, approaches in units of 2μP/(πE*). With the
//! functions of the indentation at the stick zone c (index c) and at b, and `s = g_c/g_b = 1 - τ`,
//!
//! ```text
//! compliance       dx/dτ = Λ + λ,             λ = ln(b/c),   Λ = ln(2L/b) + ν/(1-ν)          Eq. 8-10
//! until gross slip  rest = s (Λ + λ + β_c)                    x = Λ τ + β_b - s (λ + β_c)
//! energy               e = 4 [(1+s)(β_b - s β_c) - s λ - (γ_b - s² γ_c)]                      Eq. 13-16
//! ```
//!
//! Beyond τ = 1/2 these are computed as they stand; below, the series at the origin takes over.

use crate::chebyshev::Interpolant;
use crate::family::{ContactFamily, Member, Place, Split, Station};
use crate::indentation::{Indentation, TINY};
use crate::inverse::Inverse;
use crate::origin::{KEPT, Origin};
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
        origin: Origin::new(0.0, [0.0; KEPT]),
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
            origin: Origin::new(compliance, curvature(contact, load)),
        }
    }

    /// Whether it is the family of that contact and that compliance, to the last digit.
    pub(crate) fn is_of(&self, contact: &Indentation, compliance: f64) -> bool {
        [self.flat, self.w, self.psi, self.origin.compliance] == [contact.flat, contact.w, contact.psi, compliance]
    }

    /// The inverse of its curve as polynomials. The points follow each other: near one lies the next.
    pub(crate) fn inverse(&self) -> Inverse {
        let mut last: Option<(f64, f64, f64)> = None;
        Inverse::new(self.slip_approach, self.origin.compliance, |approach| {
            if approach.lost <= self.origin.half_approach {
                return self.origin.at_approach(approach);
            }
            let rest = approach.rest;
            let start = match last {
                // w goes as a power of the rest, which changes slowly.
                Some((before, w, power)) => {
                    let change = power * (rest / before - 1.0);
                    Indentation::new(self.flat, w * (1.0 + change * (1.0 + 0.5 * (change - change / power))))
                }
                None => self.guess(rest),
            };
            let (member, w, power) = self.near_approach_rest(rest, start);
            last = Some((rest, w, power));
            member
        })
    }

    /// The member with that rest of the approach, from one near it; its w, and the power of the rest with which w goes there.
    ///
    /// Halley's iteration on w cubes a distance of a few per cent each time; the last step is an expansion, in which third
    /// powers of 2e-5 are below rounding, over the square of the compliance where that is small.
    fn near_approach_rest(&self, rest: f64, start: Indentation) -> (Member, f64, f64) {
        let mut inner = start;
        let mut iterations_left = 8;
        loop {
            let (w, c2) = (inner.w, (inner.half_width * inner.half_width).max(TINY));
            let now = self.inner(&inner);
            let compliance = self.origin.compliance + now.excess;
            // Derivatives by w of the rest times the load of b, and of the compliance.
            let slope = (4.0 * w * inner.psi * compliance).max(TINY);
            let bend = inner.bend() * compliance - 4.0 * w * w * inner.psi / c2;
            let (rate, rate_change) = (-w / c2, (w - inner.flat) / c2 * ((w + inner.flat) / c2));
            let gap = rest - now.approach.rest;
            let newton = gap * self.load / slope;
            let step = newton / (1.0 + 0.5 * newton * bend / slope).max(0.5);
            iterations_left -= 1;
            if step.abs() <= 2e-5 * compliance.min(1.0) * w || iterations_left == 0 {
                let load = now.load.rest + gap / compliance * (1.0 - 0.5 * newton * rate / compliance);
                let excess = now.excess + step * (rate + 0.5 * step * rate_change);
                let member = Member {
                    load: Split { lost: 1.0 - load, rest: load },
                    approach: Split { lost: self.slip_approach - rest, rest },
                    excess,
                    measure: Some((w + step) / self.w),
                };
                return (member, w + step, (rest * self.load / slope) / w.max(TINY));
            }
            inner = Indentation::new(self.flat, (w + step).max(0.0));
        }
    }

    /// What turns the integrals over the family into tractions and slip.
    fn traction_unit(&self) -> f64 {
        4.0 / self.load.max(TINY)
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
        self.inner_of_load(inner, load, load / self.load)
    }

    /// The same for a stick zone whose load is known, and over that of b. Written as Λ τ + h, what is lost is not the difference of
    /// two large numbers where the curve is nearly straight.
    fn inner_of_load(&self, inner: &Indentation, load: f64, rest: f64) -> Member {
        let (full_stick, excess, mean) = (self.origin.compliance, self.excess(inner), inner.mean_load(load));
        Member {
            load: Split { lost: 1.0 - rest, rest },
            approach: Split {
                lost: full_stick * (1.0 - rest) + ((self.mean_load - rest * mean) - rest * excess),
                rest: rest * (full_stick + excess + mean),
            },
            excess,
            measure: Some(inner.w / self.w),
        }
    }

    /// A stick zone near the one with that rest: Λ + λ + β is taken for constant, first at its smallest.
    fn guess(&self, rest: f64) -> Indentation {
        let w = Indentation::w_roughly(self.flat, rest / self.slip_approach * self.load);
        let excess = -0.5 * (self.flat * self.flat + w * w).clamp(TINY, 1.0).ln();
        let load = rest / (self.slip_approach + excess) * self.load;
        Indentation::new(self.flat, Indentation::w_roughly(self.flat, load))
    }

    /// Dissipation and its derivative by τ at a stick zone of that rest of the load, λ being known to rounding of Λ + λ. With
    /// `h = β_b - s (λ + β_c)` the derivative `4 (τ λ - h)` is as short as this.
    pub(crate) fn cycle(&self, rest: f64, excess: f64) -> (f64, f64) {
        let w = (self.w * self.w + (-2.0 * excess).exp_m1()).max(0.25 * self.w * self.w * rest).sqrt();
        let load = rest * self.load;
        let inner = Indentation::close_to_load(Indentation::new(self.flat, w), load);
        let (mean, excess) = (inner.mean_load(load), self.excess(&inner));
        (self.dissipation_of(&inner, rest, load, excess), 4.0 * (excess - self.mean_load + rest * mean))
    }

    /// Eq. 13-16 for a stick zone.
    fn dissipation_of(&self, inner: &Indentation, rest: f64, load: f64, excess: f64) -> f64 {
        // At gross slip s vanishes faster than the logarithm of the cylinder grows.
        let work = rest * excess.min(1e3);
        let (mean, square) = (inner.mean_load(load), inner.mean_square(load));
        4.0 * ((1.0 + rest) * (self.mean_load - rest * mean) - work - (self.mean_square - rest * rest * square))
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
        let load = rest * self.load;
        let member = self.inner_of_load(&Indentation::of_load(self.flat, load), load, rest);
        let excess = if rest > 0.0 || self.flat > 0.0 { member.excess } else { f64::INFINITY };
        Member { excess, ..member }
    }

    fn at_approach_rest(&self, rest: f64) -> Member {
        if rest <= 0.0 { self.at_load_rest(0.0) } else { self.near_approach_rest(rest, self.guess(rest)).0 }
    }

    fn dissipation_beyond_half(&self, member: &Member) -> f64 {
        let inner = self.stick(member);
        self.dissipation_of(&inner, member.load.rest, inner.load(), member.excess)
    }

    fn size(&self, member: &Member) -> f64 {
        match member.measure {
            Some(measure) => {
                let w = self.w * measure;
                (self.flat * self.flat + w * w).sqrt().max(self.flat)
            }
            None => (-member.excess).exp(),
        }
    }

    fn measure(&self, member: &Member) -> f64 {
        member
            .measure
            .unwrap_or_else(|| (1.0 + (-2.0 * member.excess).exp_m1() / (self.w * self.w).max(TINY)).max(0.0).sqrt())
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

    /// `arsinh(w_b/a)`: c vanishes at w = ± i a. A flat below 1e-5 is felt by no digit; far from it the spacing is even.
    fn spread(&self) -> f64 {
        let ratio = (self.w / self.flat.max(1e-5)).max(0.5);
        (ratio + (ratio * ratio + 1.0).sqrt()).ln()
    }

    fn pressure(&self, place: &Place) -> f64 {
        traction::pressure_between(self.flat, 0.0, self.w, self.w * self.w, place) * self.traction_unit() / PI
    }

    fn shear(&self, place: &Place, stick: &Member) -> f64 {
        let inner = self.w * self.measure(stick);
        let squares = match stick.measure {
            Some(_) => (self.w - inner) * (self.w + inner),
            None => -(-2.0 * stick.excess).exp_m1(),
        };
        traction::pressure_between(self.flat, inner, self.w, squares, place) * self.traction_unit() / PI
    }

    fn slip(&self, place: &Place, stick: &Member) -> Option<f64> {
        Some(traction::slip_beyond(&self.stick(stick), place) * self.traction_unit())
    }
}

/// `h'' = g_b/(4 c² ψ_c)` as a polynomial in τ up to 1/2: positive, with its singularity as far beyond as the interval is long.
fn curvature(contact: &Indentation, load: f64) -> [f64; KEPT] {
    let mut inner = *contact;
    let mut scale = 1.0;
    let interpolant = Interpolant::<KEPT>::through(|z| {
        inner = Indentation::near_load(inner, (0.75 - 0.25 * z) * load);
        load / (4.0 * inner.half_width * inner.half_width * inner.psi)
    });
    interpolant.powers_from_end().map(|power| {
        let coefficient = scale * power;
        scale *= 2.0;
        coefficient
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::tests::{FLATS, contact, cylinder};
    use crate::family::{ContactFamily, integrate};
    use crate::parameters::CENTRE_POINT;

    /// A contact by its ψ, and a compliance of its own.
    fn family(psi: f64) -> RoundedFlat {
        RoundedFlat::new(&Indentation { flat: psi.cos(), w: psi.sin(), half_width: 1.0, psi }, 3.0)
    }

    /// The cylinder, by its angle and by no flat at all, down to the nearly flat.
    fn families() -> impl Iterator<Item = RoundedFlat> {
        let cylinder = RoundedFlat::new(&Indentation::new(0.0, 1.0), 3.0);
        [1.57, 1.2, 0.7, 0.05, 1e-4].map(family).into_iter().chain([cylinder])
    }

    fn at(family: &RoundedFlat, tau: f64) -> Member {
        family.at_load(Split { lost: tau, rest: 1.0 - tau })
    }

    #[test]
    fn the_series_and_the_closed_form_are_one_curve() {
        for family in families() {
            for tau in [0.5, 0.45, 0.3, 0.1] {
                let (series, closed) = (at(&family, tau), family.at_load_rest(1.0 - tau));
                // The closed form's differences are good to a few units of rounding of Λ = 3.
                assert!((series.approach.lost - closed.approach.lost).abs() < 4e-15, "{tau}");
                assert!((series.approach.rest - closed.approach.rest).abs() < 4e-15, "{tau}");
                assert!((series.excess - closed.excess).abs() < 4e-15, "{tau}");
                assert!((family.size(&series) - family.size(&closed)).abs() < 4e-15, "{tau}");
            }
        }
    }

    #[test]
    fn both_formulas_give_the_energy() {
        for family in families() {
            let kappa = family.origin().sums(0.0).curvature;
            for tau in [0.5, 0.4, 0.25] {
                let member = at(&family, tau);
                let series = family.dissipation(&member);
                let beyond = family.dissipation_beyond_half(&family.at_load_rest(1.0 - tau));
                // The closed form is a difference of terms of size ψ², λ and h, which go with the curvature.
                assert!((series - beyond).abs() < 1e-14 * kappa.max(1e-2), "{tau} {series} {beyond}");
                let panels = |t: f64| 4.0 * t * (tau - t) * family.origin().sums(t).curvature;
                let sum = crate::quadrature::gauss(tau, panels);
                assert!((series / sum - 1.0).abs() < 1e-13, "{tau} {series} {sum}");
            }
            // Gross slip: e = 4 ∫ t (1 - t) h'' dt over the whole family.
            let end = family.dissipation(&family.at_load_rest(0.0));
            let sum = integrate(&family, 0.0, 1.0, |station| {
                let size = (family.slip_approach() - station.approach.lost).max(0.0);
                let rest = family.at_approach_rest(size).load.rest;
                4.0 * (1.0 - rest) * rest * station.excess_rate
            });
            assert!((end / sum - 1.0).abs() < 1e-9, "{end} {sum}");
        }
    }

    #[test]
    fn a_station_is_the_member_of_its_measure() {
        for family in families() {
            for rest in [1e-6, 0.01, 0.2, 0.4999] {
                let member = family.at_load_rest(rest);
                let measure = family.measure(&member);
                let station = family.station(measure);
                assert!((station.approach.lost - member.approach.lost).abs() < 4e-15, "{rest}");
                assert!((station.approach.rest / member.approach.rest - 1.0).abs() < 4e-15, "{rest}");
                assert!((station.compliance - family.compliance(&member)).abs() < 4e-15, "{rest}");
                // The rates, by central differences: (1e-4)²/6 times curvatures of order 1/measure².
                let h = 1e-4 * measure;
                let (low, high) = (family.station(measure - h), family.station(measure + h));
                let approach = (high.approach.rest - low.approach.rest) / (2.0 * h);
                assert!((approach / (station.load_rate * station.compliance) - 1.0).abs() < 1e-7, "{rest}");
                let excess = (low.compliance - high.compliance) / (2.0 * h);
                // Rounding of the compliance, over the width of the difference.
                assert!((excess - station.excess_rate).abs() < 1e-7 * station.excess_rate + 1e-15 / h, "{rest}");
            }
        }
    }

    #[test]
    fn the_inverse_finds_the_member() {
        for family in families() {
            for rest in [0.0, 1e-12, 1e-3, 0.3, 0.4999] {
                let member = family.at_load_rest(rest);
                let back = family.at_approach_rest(member.approach.rest);
                // A relative error of the approach's rest is one of the load's, as long as both shrink together.
                assert!((back.load.rest - rest).abs() <= 4e-15 * rest, "{rest} {}", back.load.rest);
            }
        }
    }

    #[test]
    fn the_cylinder_has_an_elementary_curve() {
        let family = RoundedFlat::new(&Indentation::new(0.0, 1.0), 3.0);
        for tau in [1e-8, 1e-3, 0.2, 0.499, 0.5, 0.501, 0.9, 0.999999] {
            let (member, rest) = (at(&family, tau), 1.0 - tau);
            // h = ½ [τ + (1-τ) ln(1-τ)], its slope -½ ln(1-τ).
            let h = 0.5 * (tau + rest * (-tau).ln_1p());
            assert!((member.approach.lost - 3.0 * tau - h).abs() < 2e-15, "{tau}");
            assert!((member.excess + 0.5 * (-tau).ln_1p()).abs() < 2e-15 * (1.0 + member.excess), "{tau}");
            assert!((family.size(&member) - rest.sqrt()).abs() < 2e-15, "{tau}");
            // e = τ (2-τ) + 2 (1-τ) ln(1-τ), a difference of terms of size 2τ.
            let energy = tau * (2.0 - tau) + 2.0 * rest * (-tau).ln_1p();
            assert!((family.dissipation(&member) - energy).abs() < 2e-15 * tau.max(0.5), "{tau}");
        }
    }

    /// The inverse, wherever the approach rests, against the formula of the rest itself.
    #[test]
    fn what_rests_is_found_again() {
        let short = cylinder(1.005, 0.0, CENTRE_POINT).unwrap();
        // The last one bends sharply: Λ = 0.005.
        for (flat, shape) in FLATS.map(|flat| (flat, contact(flat))).into_iter().chain([(0.0, short)]) {
            let family = shape.family();
            let half = family.slip_approach() - family.origin().half_approach;
            // Coarsely to far below, and finely, for what depends on where an iteration ends.
            for power in (0..=800).map(|k| -0.02 * f64::from(k)).chain((0..=4000).map(|k| -1e-4 * f64::from(k))) {
                let rest = half * 10f64.powf(power);
                let found = family.at_approach_rest(rest);
                let member = family.at_load_rest(found.load.rest);
                assert!((member.approach.rest / rest - 1.0).abs() < 4e-15, "{flat} {rest}: {}", member.approach.rest);
                assert!((member.excess / found.excess - 1.0).abs() < 4e-15, "{flat} {rest}: {}", member.excess);
            }
            let end = family.at_approach_rest(0.0);
            assert!(end.load.rest == 0.0 && end.approach.rest == 0.0 && end.approach.lost == family.slip_approach());
            assert_eq!(end.excess.is_infinite(), flat == 0.0);
        }
    }
}
