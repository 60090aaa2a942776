//! The monotonic curve up to τ = 1/2 as one polynomial: `x = Λ τ + Σ h_n τⁿ`, n from 2.
//!
//! For small τ the formulas of `stick_zone` are differences of nearly equal terms. The curvature h'' is positive, and its integrals
//! are free of cancellation. All quantities follow from the coefficients of `h'' = Σ c_m τᵐ`:
//!
//! ```text
//! h = Σ h_n τⁿ,     λ = h',     W = 4 ∫ t (τ-t) h''(t) dt = 4 Σ (n-1)/(n+1) h_n τⁿ⁺¹,     dW/dτ = 4 Σ (n-1) h_n τⁿ,
//! ```
//!
//! Each is `Σ c_m f_m τᵐ` times a power of τ, with factors f_m independent of the shape.

use crate::numerics::chebyshev::{Interpolant, SeriesPoint};
use crate::numerics::const_math::tabulate;
use crate::numerics::polynomial::{self, PolynomialRows, rows};
use crate::shape::Complement;
use crate::shape::stick_zone::StickZone;

/// Terms of the polynomial up to τ = 1/2.
pub(crate) const RETAINED_TERMS: usize = 20;

type SeriesTerms = PolynomialRows<{ RETAINED_TERMS / 4 }>;

// The factors f_m of integrals of τᵐ.
const COMPLIANCE_FACTORS: SeriesTerms = rows(&tabulate!(RETAINED_TERMS, |m| 1.0 / (m + 1) as f64));
const SHIFT_FACTORS: SeriesTerms = rows(&tabulate!(RETAINED_TERMS, |m| 1.0 / ((m + 1) * (m + 2)) as f64));
const DISSIPATION_FACTORS: SeriesTerms = rows(&tabulate!(RETAINED_TERMS, |m| 4.0 / ((m + 2) * (m + 3)) as f64));

/// The expansion of the monotonic curve for τ <= 1/2.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct SmallLoadSeries {
    /// Λ, the compliance in full stick.
    pub(crate) compliance: f64,
    /// x at τ = 1/2.
    pub(crate) half_shift: f64,
    /// Coefficients c_m of h''.
    curvature: SeriesTerms,
}

impl SmallLoadSeries {
    /// The series of a curve with the compliance Λ, given values and slopes of its curvature h'' as a function of z at τ = (1+z)/4.
    pub(crate) fn new(compliance: f64, curvature: &[SeriesPoint; RETAINED_TERMS / 2]) -> SmallLoadSeries {
        let mut scale = 1.0;
        let curvature = Interpolant::<RETAINED_TERMS>::osculating(curvature).powers_from_end().map(|power| {
            let coefficient = scale * power;
            scale *= 2.0;
            coefficient
        });
        let mut series = SmallLoadSeries { compliance, half_shift: 0.0, curvature: rows(&curvature) };
        series.half_shift = 0.5 * compliance + 0.25 * series.sum(&SHIFT_FACTORS, 0.5);
        series
    }

    /// h'' at τ = 0.
    pub fn initial_curvature(&self) -> f64 {
        let [[first, ..], ..] = self.curvature;
        first
    }

    /// `Σ c_m f_m τᵐ`.
    fn sum(&self, factors: &SeriesTerms, tau: f64) -> f64 {
        polynomial::value(&self.terms(factors), tau)
    }

    /// The coefficients c_m f_m.
    fn terms(&self, factors: &SeriesTerms) -> SeriesTerms {
        let mut terms = self.curvature;
        for (row, factors) in terms.iter_mut().zip(factors) {
            row.iter_mut().zip(factors).for_each(|(term, factor)| *term *= factor);
        }
        terms
    }

    /// λ = ∫ h'' dt and ∫ t h'' dt from 0 to τ.
    pub fn moments(&self, tau: f64) -> [f64; 2] {
        [self.sum(&COMPLIANCE_FACTORS, tau) * tau, 0.25 * self.dissipation(tau).1]
    }

    /// W and dW/dτ at τ.
    pub fn dissipation(&self, tau: f64) -> (f64, f64) {
        let (sum, slope) = polynomial::value_and_slope(&self.terms(&DISSIPATION_FACTORS), tau);
        let square = tau * tau;
        (sum * tau * square, (3.0 * sum + slope * tau) * square)
    }

    /// The stick zone at a load τ <= 1/2.
    pub fn at_load(&self, load: Complement, slip_shift: f64) -> StickZone {
        let consumed =
            self.compliance * load.consumed + self.sum(&SHIFT_FACTORS, load.consumed) * load.consumed * load.consumed;
        let compliance_increase = self.sum(&COMPLIANCE_FACTORS, load.consumed) * load.consumed;
        StickZone {
            load,
            shift: Complement { consumed, remaining: slip_shift - consumed },
            compliance_increase,
            leg: None,
        }
    }

    /// The stick zone at a shift up to that of τ = 1/2, by Halley's iteration. The first estimate is the root of the first two
    /// terms of the series, which is too large by less than 5 %.
    pub fn at_shift(&self, shift: Complement) -> StickZone {
        let linear = self.compliance;
        let second_derivative = 2.0 * self.initial_curvature() * shift.consumed;
        let mut tau = 2.0 * shift.consumed / (linear + (linear * linear + second_derivative).sqrt());
        let mut compliance_increase = 0.0;
        let [compliance, shift_terms] = [&COMPLIANCE_FACTORS, &SHIFT_FACTORS].map(|factors| self.terms(factors));
        for _ in 0..5 {
            // λ/τ and its derivative give λ and h''.
            let (compliance, change) = polynomial::value_and_slope(&compliance, tau);
            let (compliance, curvature) = (compliance * tau, compliance + change * tau);
            let (h, slope) = (polynomial::value_and_slope(&shift_terms, tau).0 * tau * tau, linear + compliance);
            let newton = (linear * tau + h - shift.consumed) / slope;
            let step = newton / (1.0 - 0.5 * newton * curvature / slope);
            tau -= step;
            // λ after the step to first order: the square of the last step is below rounding.
            compliance_increase = compliance - step * curvature;
            if step.abs() <= 1e-8 * tau {
                break;
            }
        }
        StickZone { load: Complement { consumed: tau, remaining: 1.0 - tau }, shift, compliance_increase, leg: None }
    }
}
