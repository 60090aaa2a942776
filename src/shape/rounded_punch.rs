//! Load and size of a punch with a flat and rounded edges (Eq. 1, 19, 24), or of an ellipse.
//!
//! The contact with rounded edges has half-width c, the flat a. With `leg = sqrt(c² - a²) = c sin ψ` and `ψ = atan2(leg, a)` the
//! load is
//!
//! ```text
//! g(leg) = 2 c² ψ - 2 a leg  =  4 R P(c) / E*          Eq. 1, corrected
//! ```
//!
//! Shift and energy depend on the means of the load and of its square over ln c:
//!
//! ```text
//! β = (1/g) ∫ g dc/c,       γ = (1/g²) ∫ g² dc/c        from c = a (from 0 for a cylinder) to c.
//! ```
//!
//! Both are functions of ψ: they increase from ψ²/5 and ψ²/8 for the flat to 1/2 and 1/4 for the cylinder.
//!
//! The closed forms in ψ suffer cancellation for a nearly flat contact (g ~ leg³, βg ~ leg⁵, γg² ~ leg⁸). Up to ψ = π/3, power
//! series in `t = tan²(ψ/2) = (leg/(a+c))² ≤ 1/3` are used instead; they converge for t < 1 and lose at most one bit.
//!
//! An ellipse, in units of one of its family, has `g = leg³`, `β = 1/(2 leg)` and `γ = 1/(5 leg)`: means over its compliance 1/leg,
//! as ln c is that of the others. With `ψ = 3 leg/4` the load of both has the derivative `dg/d leg = 4 leg ψ`.

use crate::numerics::const_math::tabulate;
use crate::numerics::guard::{TINY, quotient};
use crate::numerics::polynomial::{self, PolynomialRows, rows};
use core::f64::consts::PI;

/// Terms of the series; the first omitted term is below 3⁻³⁶ of the sum.
const TERMS: usize = 36;

type SeriesTable = PolynomialRows<{ TERMS / 4 }>;

/// `g = 8 leg³/(a+c) Σ l_k t^k`; from `(1+t)² (ψ - sin ψ cos ψ)` with ψ = 2 atan √t.
static LOAD: SeriesTable = rows(&tabulate!(TERMS, |k| {
    let n = 2.0 * k as f64;
    sign(k + 1) / ((n + 3.0) * (n + 1.0) * (n - 1.0))
}));

/// (-1)^k.
const fn sign(k: usize) -> f64 {
    if k.is_multiple_of(2) { 1.0 } else { -1.0 }
}

/// Coefficients of β (`order` 1) or γ (`order` 2) divided by t.
///
/// As functions of ln c both satisfy `df/d ln c = 1 - f d ln g^order / d ln c`. In terms of t this is
/// `t (1 - t²) load f' + order arc f = 2 t load` with `arc = ψ/(2 √t)` and `load = (ψ - sin ψ cos ψ)/(8 t √t)`.
const fn mean_over_ln_c(order: f64) -> SeriesTable {
    let atan = tabulate!(TERMS + 1, |k| sign(k) / (2.0 * k as f64 + 1.0));
    let load = tabulate!(TERMS + 1, |k| {
        let n = k as f64;
        sign(k) * (n + 1.0) * (n + 2.0) / (2.0 * n + 3.0)
    });
    // f_0 = 0; table[k - 1] is f_k.
    let mut table = [0.0; TERMS];
    let mut k = 1;
    while k <= TERMS {
        let mut sum = 2.0 * load[k - 1];
        let mut j = 1;
        while j < k {
            let i = k - j;
            let factor = load[i] - if i >= 2 { load[i - 2] } else { 0.0 };
            sum -= table[j - 1] * (j as f64 * factor + order * atan[i]);
            j += 1;
        }
        table[k - 1] = sum / (k as f64 * load[0] + order);
        k += 1;
    }
    rows(&table)
}

static BETA: SeriesTable = mean_over_ln_c(1.0);
static GAMMA: SeriesTable = mean_over_ln_c(2.0);

fn sum(table: &SeriesTable, t: f64) -> f64 {
    let used = table.get(..polynomial::rows_for(t, TERMS / 4)).unwrap_or(table);
    polynomial::sum(used.iter().copied(), t)
}

/// A contact, given by the half-width a of the flat and by leg: lengths in any one unit, those of an ellipse in units of its
/// family.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct RoundedPunch {
    pub flat: f64,
    pub leg: f64,
    /// Half-width c of the contact.
    pub half_width: f64,
    /// ψ = atan2(leg, a), between 0 and π/2; of an ellipse 3 leg/4.
    pub psi: f64,
    /// 1 for an ellipse.
    pub elliptic: u64,
}

impl RoundedPunch {
    pub fn new(flat: f64, leg: f64) -> RoundedPunch {
        // For a cylinder ψ = π/2 even at leg = 0.
        RoundedPunch {
            flat,
            leg,
            half_width: (flat * flat + leg * leg).sqrt(),
            psi: leg.max(if flat > 0.0 { 0.0 } else { TINY }).atan2(flat),
            elliptic: 0,
        }
    }

    /// An ellipse.
    pub const fn ellipse(leg: f64) -> RoundedPunch {
        RoundedPunch { flat: 0.0, leg, half_width: leg, psi: 0.75 * leg, elliptic: 1 }
    }

    /// Another contact of the same family.
    pub fn resized(&self, leg: f64) -> RoundedPunch {
        if self.is_elliptic() { RoundedPunch::ellipse(leg) } else { RoundedPunch::new(self.flat, leg) }
    }

    /// Whether it is an ellipse.
    pub fn is_elliptic(&self) -> bool {
        self.elliptic != 0
    }

    /// t = tan²(ψ/2) if the series apply.
    fn series_argument(&self) -> Option<f64> {
        let root = quotient(self.leg, self.flat + self.half_width);
        (self.leg * self.leg <= 3.0 * self.flat * self.flat).then_some(root * root)
    }

    /// `leg - a ψ`. In terms of this difference the closed forms suffer the least cancellation near ψ = π/3.
    fn leg_minus_arc(&self) -> f64 {
        self.leg - self.flat * self.psi
    }

    /// g = 4RP/E* \[length²\], or leg³.
    pub fn load(&self) -> f64 {
        let (a, leg, c) = (self.flat, self.leg, self.half_width);
        match self.series_argument() {
            _ if self.is_elliptic() => leg * leg * leg,
            Some(t) => 8.0 * leg * leg * quotient(leg, a + c) * sum(&LOAD, t),
            None => 2.0 * (leg * leg * self.psi - a * self.leg_minus_arc()),
        }
    }

    /// Derivative of g with respect to ln leg.
    pub fn load_slope(&self) -> f64 {
        4.0 * self.leg * self.leg * self.psi
    }

    /// Decrease of the compliance with ln leg, and the derivative of this decrease with respect to ln leg.
    pub fn decrease(&self) -> [f64; 2] {
        if self.is_elliptic() {
            let compliance = quotient(1.0, self.leg);
            return [compliance, -compliance];
        }
        let share = self.leg * self.leg / (self.half_width * self.half_width).max(TINY);
        [share, 2.0 * share * (1.0 - share)]
    }

    /// β, the mean of the load over ln c, given the load g.
    pub fn beta(&self, load: f64) -> f64 {
        let (a, leg) = (self.flat, self.leg);
        match self.series_argument() {
            _ if self.is_elliptic() => quotient(0.5, leg),
            Some(t) => t * sum(&BETA, t),
            None => quotient(leg * leg * self.psi - 3.0 * a * self.leg_minus_arc(), load),
        }
    }

    /// γ, the mean of the squared load over ln c, given the load g.
    pub fn gamma(&self, load: f64) -> f64 {
        let (a, leg) = (self.flat, self.leg);
        match self.series_argument() {
            _ if self.is_elliptic() => quotient(0.2, leg),
            Some(t) => t * sum(&GAMMA, t),
            None => {
                let c2 = (a * a + leg * leg).max(TINY);
                // cos² ψ, sin² ψ, and c²/g, which is below 1 here.
                let (cos2, sin2, unit) = (a * a / c2, leg * leg / c2, c2 / load.max(c2));
                // cos² ψ ln cos ψ vanishes with cos ψ; the lower bound keeps the logarithm finite.
                let elementary = cos2 * (sin2 * (1.0 + cos2) + 2.0 * cos2 * cos2.max(TINY).ln());
                0.25 - unit * ((2.0 / 3.0) * (a * leg / c2) * sin2 - (4.0 / 3.0) * unit * elementary)
            }
        }
    }

    /// The contact that carries a load: the inverse of g (Eq. 1), from an initial guess with an error of at most 3 %. Each iteration
    /// raises the error to its fourth power.
    pub fn from_load(flat: f64, load: f64) -> RoundedPunch {
        let mut now = RoundedPunch::new(flat, RoundedPunch::initial_guess_leg(flat, load));
        for _ in 0..4 {
            let found = now.load();
            let inverse = now.inverse(found, quotient(now.load_slope(), found), now.rates(), [0.0; 2]);
            let (leg, step) = (now.leg, inverse.step(load));
            now = RoundedPunch::new(flat, leg + step);
            if step.abs() <= 2e-5 * leg {
                break;
            }
        }
        now
    }

    /// The contact after a step of leg: third powers of `step/leg` are below rounding.
    pub fn moved(&self, step: f64) -> RoundedPunch {
        let RoundedPunch { flat, leg, half_width, psi, .. } = *self;
        if self.is_elliptic() {
            return RoundedPunch::ellipse(leg + step);
        }
        // The tangent of the change of ψ.
        let change = flat * step / (half_width * half_width + leg * step).max(TINY);
        let leg = leg + step;
        RoundedPunch { leg, half_width: (flat * flat + leg * leg).sqrt(), psi: psi + change, ..*self }
    }

    /// d ln ψ/d ln leg and its derivative with respect to ln leg.
    pub fn rates(&self) -> [f64; 2] {
        if self.is_elliptic() {
            return [1.0, 0.0];
        }
        let c2 = (self.half_width * self.half_width).max(TINY);
        let slope_of_psi = self.flat * self.leg / (c2 * self.psi).max(TINY);
        [slope_of_psi, slope_of_psi * (1.0 - 2.0 * (self.leg * self.leg / c2) - slope_of_psi)]
    }

    /// The inverse close to this contact of a quantity with a derivative proportional to leg ψ Λ, given its value, its power
    /// (the derivative of its logarithm with respect to ln leg), and d ln ψ/d ln leg and -d ln Λ/d ln leg, both with derivatives.
    pub fn inverse(
        &self,
        value: f64,
        power: f64,
        slope_of_psi: [f64; 2],
        slope_of_compliance: [f64; 2],
    ) -> InversePower {
        // First and second derivative of the logarithm of the power with respect to ln leg.
        let first = 2.0 + slope_of_psi[0] - slope_of_compliance[0] - power;
        let second = slope_of_psi[1] - slope_of_compliance[1] - power * first;
        // The lower bound keeps the third power finite.
        let inverse = 1.0 / power.max(1e-20);
        let square = inverse * inverse;
        let cubic = inverse * (1.0 + square * (4.0 * first * first - 2.0 * second - 1.0)) * (1.0 / 3.0);
        InversePower { leg: self.leg, value, coefficients: [inverse, -square * first, cubic] }
    }

    /// The contact that carries a load, by one Newton step from a contact that is nearly always within 1e-9 of it; otherwise by
    /// [`RoundedPunch::from_load`].
    pub fn newton_step_from(start: RoundedPunch, load: f64) -> RoundedPunch {
        let RoundedPunch { leg, psi, half_width, flat, .. } = start;
        let step = quotient(load - start.load(), 4.0 * leg * psi);
        if step.abs() > 1e-9 * leg {
            return RoundedPunch::from_load(flat, load);
        }
        // The square of such a step is below rounding.
        let c = half_width.max(TINY);
        RoundedPunch {
            leg: leg + step,
            psi: psi + step * (flat / c) / c,
            half_width: half_width + step * (leg / c),
            ..start
        }
    }

    /// leg of the contact that carries a load, with an error of at most 3 %: the limits `sqrt(g/π)` of the cylinder and
    /// `(3ag/4)^(1/3)` of the flat, added as cubes.
    pub fn initial_guess_leg(flat: f64, load: f64) -> f64 {
        let load = load.max(0.0);
        let hertz = load / PI;
        (hertz * hertz.sqrt() + 0.75 * flat * load).cbrt()
    }
}

/// leg as a function of a quantity that scales nearly as a power of leg, close to leg_0: the expansion of
/// `(leg - leg_0)/(leg + leg_0)` in powers of `(value - value_0)/(value + value_0)`, up to the third.
///
/// These are the hyperbolic tangents of half the logarithms of leg/leg_0 and value/value_0. For a constant power of 2 to 3 the
/// error for a value 20 % away is below 2e-6 of leg.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct InversePower {
    leg: f64,
    value: f64,
    coefficients: [f64; 3],
}

impl InversePower {
    /// leg - leg_0.
    pub fn step(&self, value: f64) -> f64 {
        let [first, second, third] = self.coefficients;
        let x = quotient(value - self.value, value + self.value);
        // leg changes by at most a factor of 3.
        let ratio = (x * (first + x * (second + x * third))).clamp(-0.5, 0.5);
        2.0 * self.leg * ratio / (1.0 - ratio)
    }

    /// leg.
    pub fn leg(&self, value: f64) -> f64 {
        self.leg + self.step(value)
    }
}
