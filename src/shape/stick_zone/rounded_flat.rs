//! Stick zones of the flat with rounded edges, cylinder included.
//!
//! Lengths are in units of the half-width b, loads in units of P, shifts in units of 2μP/(πE*). With g, β and γ of the rounded punch
//! at the stick zone c (index c) and at b, and `s = g_c/g_b = 1 - τ`,
//!
//! ```text
//! compliance       dx/dτ = Λ + λ,             λ = ln(b/c),   Λ = ln(2L/b) + ν/(1-ν)          Eq. 8-10
//! remaining shift  x_s - x = s (Λ + λ + β_c)               x = Λ τ + β_b - s (λ + β_c)
//! energy           e = 4 [(1+s)(β_b - s β_c) - s λ - (γ_b - s² γ_c)]                          Eq. 13-16
//! ```
//!
//! These formulas are evaluated for τ >= 1/2; for smaller τ they suffer cancellation and are replaced by the expansion of `small_load`. The size parameter is
//! `σ = w_c/w_b`.

use crate::numerics::chebyshev::{Interpolant, Tangent};
use crate::shape::rounded_punch::{InversePower, RoundedPunch, TINY};
use crate::shape::stick_zone::small_load::{RETAINED_TERMS, SmallLoadSeries, curvature_series};
use crate::shape::stick_zone::{Complement, LoadPoint, StickZone, StickZones, SurfacePoint};
use crate::shape::tractions;
use core::f64::consts::PI;

/// The stick zones of a flat with rounded edges under its load, lengths in units of b.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct RoundedFlatZones {
    /// a/b, and `sqrt(1 - (a/b)²)` computed without cancellation.
    flat: f64,
    w: f64,
    psi: f64,
    load: f64,
    beta: f64,
    gamma: f64,
    slip_shift: f64,
    small_load: SmallLoadSeries,
}

/// Moments of the curvature h'' over the load t from 0 to τ, each free of cancellation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moments {
    /// ∫ h'' dt = λ.
    pub increase: f64,
    /// ∫ t h'' dt = τ λ - h.
    pub first: f64,
    /// ∫ (1-t) h'' dt = β_b - s β_c.
    pub complement: f64,
    /// ∫ (4w/g_b) h'' dt.
    pub by_flat: f64,
}

impl RoundedFlatZones {
    /// The stick zones below the contact `b` (lengths in units of its half-width), with the compliance Λ of full stick.
    pub(crate) fn new(contact: &RoundedPunch, compliance: f64) -> RoundedFlatZones {
        let load = contact.load();
        let beta = contact.beta(load);
        RoundedFlatZones {
            flat: contact.flat,
            w: contact.w,
            psi: contact.psi,
            load,
            beta,
            gamma: contact.gamma(load),
            slip_shift: compliance + beta,
            small_load: SmallLoadSeries::new(compliance, curvature_of(contact, load)),
        }
    }

    /// Finds the points of the curve at a sequence of decreasing remaining shifts, the first of which is close to x_s. Each starts from
    /// the expansion about the one before, so that the closed forms are nearly always evaluated once.
    pub(crate) fn sequence(&self) -> impl FnMut(f64) -> LoadPoint {
        let mut last: Option<InversePower> = None;
        move |remaining| {
            let w = last.as_ref().map_or(self.w, |last| last.w(remaining));
            let (zone, punch, inverse) = self.refine_shift_remaining(remaining, RoundedPunch::new(self.flat, w));
            last = Some(inverse);
            LoadPoint {
                remaining: zone.load.remaining,
                compliance_increase: zone.compliance_increase,
                curvature: curvature(&punch, self.load),
            }
        }
    }

    /// The stick zone at a remaining shift, from one close to it; its contact, and the inverse of the remaining shift close to it.
    ///
    /// The iteration raises an error to its fourth power. The last step is an expansion in which fourth powers of 2e-5, over the
    /// cube of the compliance if that is small, are below rounding. Third powers are not: those of the load, `dg/dw = 4 w ψ`, are included.
    fn refine_shift_remaining(&self, remaining: f64, start: RoundedPunch) -> (StickZone, RoundedPunch, InversePower) {
        let mut punch = start;
        let mut iterations_left = 8;
        loop {
            let (w, c2) = (punch.w, (punch.half_width * punch.half_width).max(TINY));
            let now = self.zone(&punch);
            let compliance = self.small_load.compliance + now.compliance_increase;
            // Derivative with respect to ln w of the remaining shift times the load of b.
            let slope = 4.0 * w * w * punch.psi * compliance;
            let power = slope / (now.shift.remaining * self.load).max(TINY);
            let inverse = punch.inverse(now.shift.remaining, power, w * w / (c2 * compliance));
            let step = inverse.step(remaining);
            iterations_left -= 1;
            if step.abs() <= 2e-5 * compliance.min(1.0) * w || iterations_left == 0 {
                // Relative change of c², and -½ ln(1 + change).
                let change = step * (2.0 * w + step) / c2;
                let increase = -0.5 * change * (1.0 - change * (0.5 - change * (1.0 / 3.0)));
                let per_size = self.flat / c2;
                let square = 2.0 * (punch.psi + w * per_size) + step * (4.0 / 3.0) * self.flat * per_size * per_size;
                let load = now.load.remaining + step * (4.0 * w * punch.psi + step * square) / self.load.max(TINY);
                let zone = StickZone {
                    load: Complement { consumed: 1.0 - load, remaining: load },
                    shift: Complement { consumed: self.slip_shift - remaining, remaining },
                    compliance_increase: now.compliance_increase + increase,
                    size_parameter: Some((w + step) / self.w),
                };
                return (zone, punch.moved(step), inverse);
            }
            punch = RoundedPunch::new(self.flat, (w + step).max(0.0));
        }
    }

    /// Factor of the integrals of `tractions`.
    fn traction_scale(&self) -> f64 {
        4.0 / self.load.max(TINY)
    }

    /// λ = ln(b/c), accurate also for c close to b.
    fn compliance_increase(&self, punch: &RoundedPunch) -> f64 {
        let size = punch.half_width * punch.half_width;
        if size < 0.5 {
            -0.5 * size.max(TINY).ln()
        } else {
            -0.5 * (-(self.w - punch.w) * (self.w + punch.w)).max(-0.5).ln_1p()
        }
    }

    /// The formulas above for a stick zone.
    fn zone(&self, punch: &RoundedPunch) -> StickZone {
        let load = punch.load();
        self.zone_of_load(punch, load, load / self.load)
    }

    /// The same for a stick zone of known load g_c and `s = g_c/g_b`. In the form Λ τ + h the consumed shift is no difference of two
    /// large terms if the curve is nearly straight.
    fn zone_of_load(&self, punch: &RoundedPunch, load: f64, remaining: f64) -> StickZone {
        let (full_stick, increase, beta) =
            (self.small_load.compliance, self.compliance_increase(punch), punch.beta(load));
        StickZone {
            load: Complement { consumed: 1.0 - remaining, remaining },
            shift: Complement {
                consumed: full_stick * (1.0 - remaining) + ((self.beta - remaining * beta) - remaining * increase),
                remaining: remaining * (full_stick + increase + beta),
            },
            compliance_increase: increase,
            size_parameter: Some(punch.w / self.w),
        }
    }

    /// A stick zone close to the one at a remaining shift: with Λ + λ + β constant, first at its smallest value.
    fn initial_guess(&self, remaining: f64) -> RoundedPunch {
        let w = RoundedPunch::initial_guess_w(self.flat, remaining / self.slip_shift * self.load);
        let increase = -0.5 * (self.flat * self.flat + w * w).clamp(TINY, 1.0).ln();
        let load = remaining / (self.slip_shift + increase) * self.load;
        RoundedPunch::new(self.flat, RoundedPunch::initial_guess_w(self.flat, load))
    }

    /// Moments of the curvature at a load; λ, to the rounding of Λ + λ, is used for τ > 1/2.
    ///
    /// With C(w) = w - a ψ the fourth is 4 (C_b - C_c)/g_b, because dc/da at a constant load is w/(c ψ).
    pub(crate) fn moments(&self, load: Complement, compliance_increase: f64) -> Moments {
        let RoundedFlatZones { flat, w, .. } = *self;
        let tau = load.consumed;
        let (increase, first, complement, w_difference) = if tau <= 0.5 {
            let [increase, first] = self.small_load.moments(tau);
            let squares = -(-2.0 * increase).exp_m1();
            (increase, first, increase - first, squares / (w + (w * w - squares).max(0.0).sqrt()))
        } else {
            let (punch, load_c) = self.punch_near(load.remaining, compliance_increase);
            let increase = self.compliance_increase(&punch);
            let complement = self.beta - load.remaining * punch.beta(load_c);
            (increase, increase - complement, complement, w - punch.w)
        };
        let by_flat = if w * w <= 3.0 * flat * flat {
            // 2 ∫ (1-t) h'' dt + a ∫ 4w/g_b h'' dt = τ; the first term is the smaller one.
            (tau - 2.0 * complement) / flat
        } else {
            let angle = (flat * w_difference).atan2(flat * flat + w * (w - w_difference));
            4.0 / self.load * (w_difference - flat * angle)
        };
        Moments { increase, first, complement, by_flat }
    }

    /// d(ln b)/d(ln g_b), and db/da at a constant load.
    pub(crate) fn size_slopes(&self) -> [f64; 2] {
        [self.small_load.initial_curvature(), self.w / self.psi]
    }

    /// The stick zone with `1 - τ = remaining` and its load, λ given to the rounding of Λ + λ.
    #[inline(always)]
    fn punch_near(&self, remaining: f64, compliance_increase: f64) -> (RoundedPunch, f64) {
        let w =
            (self.w * self.w + (-2.0 * compliance_increase).exp_m1()).max(0.25 * self.w * self.w * remaining).sqrt();
        let load = remaining * self.load;
        (RoundedPunch::newton_step_from(RoundedPunch::new(self.flat, w), load), load)
    }

    /// Size parameter σ, from 0 for the smallest zone to 1 for b.
    fn size_parameter(&self, zone: &StickZone) -> f64 {
        zone.size_parameter.unwrap_or_else(|| {
            (1.0 + (-2.0 * zone.compliance_increase).exp_m1() / (self.w * self.w).max(TINY)).max(0.0).sqrt()
        })
    }

    fn punch(&self, zone: &StickZone) -> RoundedPunch {
        RoundedPunch::new(self.flat, self.w * self.size_parameter(zone))
    }
}

impl StickZones for RoundedFlatZones {
    fn small_load(&self) -> &SmallLoadSeries {
        &self.small_load
    }

    fn slip_shift(&self) -> f64 {
        self.slip_shift
    }

    fn at_load_remaining(&self, remaining: f64) -> StickZone {
        let load = remaining * self.load;
        let zone = self.zone_of_load(&RoundedPunch::from_load(self.flat, load), load, remaining);
        let vanishes = remaining <= 0.0 && self.flat <= 0.0;
        StickZone { compliance_increase: if vanishes { f64::INFINITY } else { zone.compliance_increase }, ..zone }
    }

    fn at_shift_remaining(&self, remaining: f64) -> StickZone {
        if remaining <= 0.0 {
            self.at_load_remaining(0.0)
        } else {
            self.refine_shift_remaining(remaining, self.initial_guess(remaining)).0
        }
    }

    /// Eq. 13-16; with `h = β_b - s (λ + β_c)` the derivative is `4 (τ λ - h)`.
    fn dissipation_beyond_half(&self, remaining: f64, compliance_increase: f64) -> (f64, f64) {
        let (punch, load) = self.punch_near(remaining, compliance_increase);
        let (beta, gamma, increase) = (punch.beta(load), punch.gamma(load), self.compliance_increase(&punch));
        // At gross slip s vanishes faster than the logarithm of the cylinder grows.
        let work = remaining * increase.min(1e3);
        let squares = self.gamma - remaining * remaining * gamma;
        let energy = 4.0 * ((1.0 + remaining) * (self.beta - remaining * beta) - work - squares);
        (energy, 4.0 * (increase - self.beta + remaining * beta))
    }

    fn size(&self, zone: &StickZone) -> f64 {
        match zone.size_parameter {
            Some(sigma) => {
                let w = self.w * sigma;
                (self.flat * self.flat + w * w).sqrt().max(self.flat)
            }
            None => (-zone.compliance_increase).exp(),
        }
    }

    fn pressure(&self, point: &SurfacePoint) -> f64 {
        tractions::pressure_between(self.flat, 0.0, self.w, self.w * self.w, point) * self.traction_scale() / PI
    }

    fn shear(&self, point: &SurfacePoint, zone: &StickZone) -> f64 {
        let w = self.w * self.size_parameter(zone);
        let squares = match zone.size_parameter {
            Some(_) => (self.w - w) * (self.w + w),
            None => -(-2.0 * zone.compliance_increase).exp_m1(),
        };
        tractions::pressure_between(self.flat, w, self.w, squares, point) * self.traction_scale() / PI
    }

    fn slip(&self, point: &SurfacePoint, zone: &StickZone) -> Option<f64> {
        Some(tractions::slip_beyond(&self.punch(zone), point) * self.traction_scale())
    }
}

/// `h'' = dλ/dτ = g_b/(4 c² ψ_c)` of a stick zone.
fn curvature(punch: &RoundedPunch, load: f64) -> f64 {
    load / (4.0 * punch.half_width * punch.half_width * punch.psi).max(TINY)
}

/// h'' as a polynomial in τ up to 1/2: positive, with its singularity as far beyond as the interval is long.
fn curvature_of(contact: &RoundedPunch, load: f64) -> [f64; RETAINED_TERMS] {
    let mut last: Option<InversePower> = None;
    let mut tangents = Interpolant::<{ RETAINED_TERMS / 2 }>::at_points(|z| {
        let remaining = (0.75 + 0.25 * z) * load;
        let w = last.as_ref().map_or(contact.w, |last| last.w(remaining));
        let (punch, inverse) = RoundedPunch::refine_from(RoundedPunch::new(contact.flat, w), remaining);
        last = Some(inverse);
        let RoundedPunch { flat, w, psi, half_width } = punch;
        let value = curvature(&punch, load);
        // Logarithmic derivative with respect to w, and the derivative of τ.
        let (decrease, dload) = ((2.0 * w + flat / psi) / (half_width * half_width), 4.0 * w * psi / load);
        Tangent { value, slope: 0.25 * value * decrease / dload }
    });
    // From τ = 0 on; the points are symmetric.
    tangents.reverse();
    curvature_series(&tangents)
}
