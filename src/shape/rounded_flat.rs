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

use crate::constant_load::interpolant::ForceInterpolant;
use crate::numerics::chebyshev::Interpolant;
use crate::shape::rounded_punch::{RoundedPunch, TINY};
use crate::shape::small_load::{RETAINED_TERMS, SmallLoadSeries};
use crate::shape::tractions;
use crate::shape::{Complement, QuadraturePoint, SizeFamily, StickZone, SurfacePoint};
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
    beta: f64,
    gamma: f64,
    slip_shift: f64,
    origin: SmallLoadSeries,
}

impl RoundedFlat {
    /// No contact.
    pub(crate) const EMPTY: RoundedFlat = RoundedFlat {
        flat: 0.0,
        w: 0.0,
        psi: 0.0,
        load: 0.0,
        beta: 0.0,
        gamma: 0.0,
        slip_shift: 0.0,
        origin: SmallLoadSeries::new(0.0, [0.0; RETAINED_TERMS]),
    };

    /// The contact `b` (lengths in units of its half-width), with the compliance Λ of its full stick.
    pub(crate) fn new(contact: &RoundedPunch, compliance: f64) -> RoundedFlat {
        let load = contact.load();
        let beta = contact.beta(load);
        RoundedFlat {
            flat: contact.flat,
            w: contact.w,
            psi: contact.psi,
            load,
            beta,
            gamma: contact.gamma(load),
            slip_shift: compliance + beta,
            origin: SmallLoadSeries::new(compliance, curvature(contact, load)),
        }
    }

    /// The inverse of its curve as polynomials. The points follow each other: near one lies the next.
    pub(crate) fn interpolant(&self) -> ForceInterpolant {
        let mut last: Option<(f64, f64, f64)> = None;
        ForceInterpolant::new(self.slip_shift, self.origin.compliance, |shift| {
            if shift.consumed <= self.origin.half_shift {
                return self.origin.at_shift(shift);
            }
            let remaining = shift.remaining;
            let start = match last {
                // w goes as a power of the rest, which changes slowly.
                Some((before, w, power)) => {
                    let change = power * (remaining / before - 1.0);
                    RoundedPunch::new(self.flat, w * (1.0 + change * (1.0 + 0.5 * (change - change / power))))
                }
                None => self.guess(remaining),
            };
            let (member, w, power) = self.refine_shift_remaining(remaining, start);
            last = Some((remaining, w, power));
            member
        })
    }

    /// The member with that rest of the approach, from one near it; its w, and the power of the rest with which w goes there.
    ///
    /// Halley's iteration on w cubes a distance of a few per cent each time; the last step is an expansion, in which third
    /// powers of 2e-5 are below rounding, over the square of the compliance where that is small.
    fn refine_shift_remaining(&self, remaining: f64, start: RoundedPunch) -> (StickZone, f64, f64) {
        let mut inner = start;
        let mut iterations_left = 8;
        loop {
            let (w, c2) = (inner.w, (inner.half_width * inner.half_width).max(TINY));
            let now = self.inner(&inner);
            let compliance = self.origin.compliance + now.compliance_increase;
            // Derivatives by w of the rest times the load of b, and of the compliance.
            let slope = (4.0 * w * inner.psi * compliance).max(TINY);
            let second_derivative = inner.second_derivative() * compliance - 4.0 * w * w * inner.psi / c2;
            let (rate, rate_change) = (-w / c2, (w - inner.flat) / c2 * ((w + inner.flat) / c2));
            let gap = remaining - now.shift.remaining;
            let newton = gap * self.load / slope;
            let step = newton / (1.0 + 0.5 * newton * second_derivative / slope).max(0.5);
            iterations_left -= 1;
            if step.abs() <= 2e-5 * compliance.min(1.0) * w || iterations_left == 0 {
                let load = now.load.remaining + gap / compliance * (1.0 - 0.5 * newton * rate / compliance);
                let compliance_increase = now.compliance_increase + step * (rate + 0.5 * step * rate_change);
                let member = StickZone {
                    load: Complement { consumed: 1.0 - load, remaining: load },
                    shift: Complement { consumed: self.slip_shift - remaining, remaining },
                    compliance_increase,
                    size_parameter: Some((w + step) / self.w),
                };
                return (member, w + step, (remaining * self.load / slope) / w.max(TINY));
            }
            inner = RoundedPunch::new(self.flat, (w + step).max(0.0));
        }
    }

    /// What turns the integrals over the family into tractions and slip.
    fn traction_scale(&self) -> f64 {
        4.0 / self.load.max(TINY)
    }

    /// ln(b/c), accurate also where c is near b.
    fn compliance_increase(&self, inner: &RoundedPunch) -> f64 {
        let size = inner.half_width * inner.half_width;
        if size < 0.5 {
            -0.5 * size.max(TINY).ln()
        } else {
            -0.5 * (-(self.w - inner.w) * (self.w + inner.w)).max(-0.5).ln_1p()
        }
    }

    /// What the formulas above make of a stick zone.
    fn inner(&self, inner: &RoundedPunch) -> StickZone {
        let load = inner.load();
        self.inner_of_load(inner, load, load / self.load)
    }

    /// The same for a stick zone whose load is known, and over that of b. Written as Λ τ + h, what is lost is not the difference of
    /// two large numbers where the curve is nearly straight.
    fn inner_of_load(&self, inner: &RoundedPunch, load: f64, remaining: f64) -> StickZone {
        let (full_stick, compliance_increase, mean) =
            (self.origin.compliance, self.compliance_increase(inner), inner.beta(load));
        StickZone {
            load: Complement { consumed: 1.0 - remaining, remaining },
            shift: Complement {
                consumed: full_stick * (1.0 - remaining)
                    + ((self.beta - remaining * mean) - remaining * compliance_increase),
                remaining: remaining * (full_stick + compliance_increase + mean),
            },
            compliance_increase,
            size_parameter: Some(inner.w / self.w),
        }
    }

    /// A stick zone near the one with that rest: Λ + λ + β is taken for constant, first at its smallest.
    fn guess(&self, remaining: f64) -> RoundedPunch {
        let w = RoundedPunch::initial_guess_w(self.flat, remaining / self.slip_shift * self.load);
        let compliance_increase = -0.5 * (self.flat * self.flat + w * w).clamp(TINY, 1.0).ln();
        let load = remaining / (self.slip_shift + compliance_increase) * self.load;
        RoundedPunch::new(self.flat, RoundedPunch::initial_guess_w(self.flat, load))
    }

    /// Dissipation and its derivative by τ at a stick zone of that rest of the load, λ being known to rounding of Λ + λ. With
    /// `h = β_b - s (λ + β_c)` the derivative `4 (τ λ - h)` is as short as this.
    pub(crate) fn cycle(&self, remaining: f64, compliance_increase: f64) -> (f64, f64) {
        let w =
            (self.w * self.w + (-2.0 * compliance_increase).exp_m1()).max(0.25 * self.w * self.w * remaining).sqrt();
        let load = remaining * self.load;
        let inner = RoundedPunch::newton_step_from(RoundedPunch::new(self.flat, w), load);
        let (mean, compliance_increase) = (inner.beta(load), self.compliance_increase(&inner));
        (
            self.dissipation_of(&inner, remaining, load, compliance_increase),
            4.0 * (compliance_increase - self.beta + remaining * mean),
        )
    }

    /// Eq. 13-16 for a stick zone.
    fn dissipation_of(&self, inner: &RoundedPunch, remaining: f64, load: f64, compliance_increase: f64) -> f64 {
        // At gross slip s vanishes faster than the logarithm of the cylinder grows.
        let work = remaining * compliance_increase.min(1e3);
        let (mean, square) = (inner.beta(load), inner.gamma(load));
        4.0 * ((1.0 + remaining) * (self.beta - remaining * mean)
            - work
            - (self.gamma - remaining * remaining * square))
    }

    fn stick(&self, member: &StickZone) -> RoundedPunch {
        RoundedPunch::new(self.flat, self.w * self.size_parameter(member))
    }
}

impl SizeFamily for RoundedFlat {
    fn origin(&self) -> &SmallLoadSeries {
        &self.origin
    }

    fn slip_shift(&self) -> f64 {
        self.slip_shift
    }

    fn at_load_remaining(&self, remaining: f64) -> StickZone {
        let load = remaining * self.load;
        let member = self.inner_of_load(&RoundedPunch::from_load(self.flat, load), load, remaining);
        let compliance_increase =
            if remaining > 0.0 || self.flat > 0.0 { member.compliance_increase } else { f64::INFINITY };
        StickZone { compliance_increase, ..member }
    }

    fn at_shift_remaining(&self, remaining: f64) -> StickZone {
        if remaining <= 0.0 {
            self.at_load_remaining(0.0)
        } else {
            self.refine_shift_remaining(remaining, self.guess(remaining)).0
        }
    }

    fn dissipation_beyond_half(&self, member: &StickZone) -> f64 {
        let inner = self.stick(member);
        self.dissipation_of(&inner, member.load.remaining, inner.load(), member.compliance_increase)
    }

    fn size(&self, member: &StickZone) -> f64 {
        match member.size_parameter {
            Some(size_parameter) => {
                let w = self.w * size_parameter;
                (self.flat * self.flat + w * w).sqrt().max(self.flat)
            }
            None => (-member.compliance_increase).exp(),
        }
    }

    fn size_parameter(&self, member: &StickZone) -> f64 {
        member.size_parameter.unwrap_or_else(|| {
            (1.0 + (-2.0 * member.compliance_increase).exp_m1() / (self.w * self.w).max(TINY)).max(0.0).sqrt()
        })
    }

    fn station(&self, size_parameter: f64) -> QuadraturePoint {
        let w = self.w * size_parameter;
        let inner = RoundedPunch::new(self.flat, w);
        let member = self.inner(&inner);
        let c2 = inner.half_width * inner.half_width;
        QuadraturePoint {
            shift: member.shift,
            compliance: self.compliance(&member),
            dload_dsigma: self.w * 4.0 * w * inner.psi / self.load,
            dcompliance_dsigma: self.w * w / c2.max(TINY),
        }
    }

    /// `arsinh(w_b/a)`: c vanishes at w = ± i a. A flat below 1e-5 is felt by no digit; far from it the spacing is even.
    fn log_branch_distance(&self) -> f64 {
        let ratio = (self.w / self.flat.max(1e-5)).max(0.5);
        (ratio + (ratio * ratio + 1.0).sqrt()).ln()
    }

    fn pressure(&self, place: &SurfacePoint) -> f64 {
        tractions::pressure_between(self.flat, 0.0, self.w, self.w * self.w, place) * self.traction_scale() / PI
    }

    fn shear(&self, place: &SurfacePoint, stick: &StickZone) -> f64 {
        let inner = self.w * self.size_parameter(stick);
        let squares = match stick.size_parameter {
            Some(_) => (self.w - inner) * (self.w + inner),
            None => -(-2.0 * stick.compliance_increase).exp_m1(),
        };
        tractions::pressure_between(self.flat, inner, self.w, squares, place) * self.traction_scale() / PI
    }

    fn slip(&self, place: &SurfacePoint, stick: &StickZone) -> Option<f64> {
        Some(tractions::slip_beyond(&self.stick(stick), place) * self.traction_scale())
    }
}

/// `h'' = g_b/(4 c² ψ_c)` as a polynomial in τ up to 1/2: positive, with its singularity as far beyond as the interval is long.
fn curvature(contact: &RoundedPunch, load: f64) -> [f64; RETAINED_TERMS] {
    let mut inner = *contact;
    let mut scale = 1.0;
    let interpolant = Interpolant::<RETAINED_TERMS>::through(|z| {
        inner = RoundedPunch::refine_from(inner, (0.75 - 0.25 * z) * load);
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
    use crate::constant_load::contact::tests::{FLATS, contact, cylinder};
    use crate::parameters::CENTRE_POINT;
    use crate::shape::{SizeFamily, integrate};

    /// A contact by its ψ, and a compliance of its own.
    fn family(psi: f64) -> RoundedFlat {
        RoundedFlat::new(&RoundedPunch { flat: psi.cos(), w: psi.sin(), half_width: 1.0, psi }, 3.0)
    }

    /// The cylinder, by its angle and by no flat at all, down to the nearly flat.
    fn families() -> impl Iterator<Item = RoundedFlat> {
        let cylinder = RoundedFlat::new(&RoundedPunch::new(0.0, 1.0), 3.0);
        [1.57, 1.2, 0.7, 0.05, 1e-4].map(family).into_iter().chain([cylinder])
    }

    fn at(family: &RoundedFlat, tau: f64) -> StickZone {
        family.at_load(Complement { consumed: tau, remaining: 1.0 - tau })
    }

    #[test]
    fn the_series_and_the_closed_form_are_one_curve() {
        for family in families() {
            for tau in [0.5, 0.45, 0.3, 0.1] {
                let (series, closed) = (at(&family, tau), family.at_load_remaining(1.0 - tau));
                // The closed form's differences are good to a few units of rounding of Λ = 3.
                assert!((series.shift.consumed - closed.shift.consumed).abs() < 4e-15, "{tau}");
                assert!((series.shift.remaining - closed.shift.remaining).abs() < 4e-15, "{tau}");
                assert!((series.compliance_increase - closed.compliance_increase).abs() < 4e-15, "{tau}");
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
                let beyond = family.dissipation_beyond_half(&family.at_load_remaining(1.0 - tau));
                // The closed form is a difference of terms of size ψ², λ and h, which go with the curvature.
                assert!((series - beyond).abs() < 1e-14 * kappa.max(1e-2), "{tau} {series} {beyond}");
                let panels = |t: f64| 4.0 * t * (tau - t) * family.origin().sums(t).curvature;
                let sum = crate::numerics::quadrature::gauss(tau, panels);
                assert!((series / sum - 1.0).abs() < 1e-13, "{tau} {series} {sum}");
            }
            // Gross slip: e = 4 ∫ t (1 - t) h'' dt over the whole family.
            let end = family.dissipation(&family.at_load_remaining(0.0));
            let sum = integrate(&family, 0.0, 1.0, |station| {
                let size = (family.slip_shift() - station.shift.consumed).max(0.0);
                let remaining = family.at_shift_remaining(size).load.remaining;
                4.0 * (1.0 - remaining) * remaining * station.dcompliance_dsigma
            });
            assert!((end / sum - 1.0).abs() < 1e-9, "{end} {sum}");
        }
    }

    #[test]
    fn a_station_is_the_member_of_its_measure() {
        for family in families() {
            for remaining in [1e-6, 0.01, 0.2, 0.4999] {
                let member = family.at_load_remaining(remaining);
                let size_parameter = family.size_parameter(&member);
                let station = family.station(size_parameter);
                assert!((station.shift.consumed - member.shift.consumed).abs() < 4e-15, "{remaining}");
                assert!((station.shift.remaining / member.shift.remaining - 1.0).abs() < 4e-15, "{remaining}");
                assert!((station.compliance - family.compliance(&member)).abs() < 4e-15, "{remaining}");
                // The rates, by central differences: (1e-4)²/6 times curvatures of order 1/measure².
                let h = 1e-4 * size_parameter;
                let (low, high) = (family.station(size_parameter - h), family.station(size_parameter + h));
                let shift = (high.shift.remaining - low.shift.remaining) / (2.0 * h);
                assert!((shift / (station.dload_dsigma * station.compliance) - 1.0).abs() < 1e-7, "{remaining}");
                let compliance_increase = (low.compliance - high.compliance) / (2.0 * h);
                // Rounding of the compliance, over the width of the difference.
                assert!(
                    (compliance_increase - station.dcompliance_dsigma).abs()
                        < 1e-7 * station.dcompliance_dsigma + 1e-15 / h,
                    "{remaining}"
                );
            }
        }
    }

    #[test]
    fn the_inverse_finds_the_member() {
        for family in families() {
            for remaining in [0.0, 1e-12, 1e-3, 0.3, 0.4999] {
                let member = family.at_load_remaining(remaining);
                let back = family.at_shift_remaining(member.shift.remaining);
                // A relative error of the approach's rest is one of the load's, as long as both shrink together.
                assert!(
                    (back.load.remaining - remaining).abs() <= 4e-15 * remaining,
                    "{remaining} {}",
                    back.load.remaining
                );
            }
        }
    }

    #[test]
    fn the_cylinder_has_an_elementary_curve() {
        let family = RoundedFlat::new(&RoundedPunch::new(0.0, 1.0), 3.0);
        for tau in [1e-8, 1e-3, 0.2, 0.499, 0.5, 0.501, 0.9, 0.999999] {
            let (member, remaining) = (at(&family, tau), 1.0 - tau);
            // h = ½ [τ + (1-τ) ln(1-τ)], its slope -½ ln(1-τ).
            let h = 0.5 * (tau + remaining * (-tau).ln_1p());
            assert!((member.shift.consumed - 3.0 * tau - h).abs() < 2e-15, "{tau}");
            assert!(
                (member.compliance_increase + 0.5 * (-tau).ln_1p()).abs() < 2e-15 * (1.0 + member.compliance_increase),
                "{tau}"
            );
            assert!((family.size(&member) - remaining.sqrt()).abs() < 2e-15, "{tau}");
            // e = τ (2-τ) + 2 (1-τ) ln(1-τ), a difference of terms of size 2τ.
            let energy = tau * (2.0 - tau) + 2.0 * remaining * (-tau).ln_1p();
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
            let half = family.slip_shift() - family.origin().half_shift;
            // Coarsely to far below, and finely, for what depends on where an iteration ends.
            for power in (0..=800).map(|k| -0.02 * f64::from(k)).chain((0..=4000).map(|k| -1e-4 * f64::from(k))) {
                let remaining = half * 10f64.powf(power);
                let found = family.at_shift_remaining(remaining);
                let member = family.at_load_remaining(found.load.remaining);
                assert!(
                    (member.shift.remaining / remaining - 1.0).abs() < 4e-15,
                    "{flat} {remaining}: {}",
                    member.shift.remaining
                );
                assert!(
                    (member.compliance_increase / found.compliance_increase - 1.0).abs() < 4e-15,
                    "{flat} {remaining}: {}",
                    member.compliance_increase
                );
            }
            let end = family.at_shift_remaining(0.0);
            assert!(
                end.load.remaining == 0.0 && end.shift.remaining == 0.0 && end.shift.consumed == family.slip_shift()
            );
            assert_eq!(end.compliance_increase.is_infinite(), flat == 0.0);
        }
    }
}
