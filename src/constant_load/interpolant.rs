//! Piecewise Chebyshev interpolant of the monotonic curve T(δ), built once per contact: force and stiffness at a displacement
//! without iteration.
//!
//! With the shift x and its value x_s at gross slip:
//!
//! - `x <= 2/5 x_s`: one polynomial in x for the secant stiffness. If a layer bends the curve too strongly for this, the fraction
//!   is 11/20 instead of 2/5, here and below;
//! - beyond: polynomials in sqrt(ρ), `ρ = (x_s - x)/(3/5 x_s)`, one per dyadic interval 2⁻ʲ⁻¹ < √ρ <= 2⁻ʲ, j = 0 to 4. The curve is
//!   singular at ρ = 0 (any power of ρ^(1/3), or a logarithm), which lies three half-lengths from every interval, so that all
//!   converge at the same rate;
//! - the last 1/1707 of x_s: no interpolant; the closed form is inverted by iteration. For integrals, to which this range adds
//!   little, there are polynomials in `z = (1024 ρ)^(1/8)` for (1-τ)/ρ, with an error of 1e-13 in the worst case, a flat of b/100.
//!   On a dyadic interval of z, ρ falls by a factor of 256: six intervals reach down to 2e-18 x_s.
//!
//! The decrease of the tangent stiffness is interpolated and the force obtained by integration, so that the rounding errors of both
//! scale with the curvature of the curve and not with the stiffness.

use crate::numerics::chebyshev::{Interpolant, Polynomial, SeriesPoint, TERMS, powers};
use crate::numerics::guard::TINY;
use crate::numerics::lanes::Lanes;
use crate::numerics::polynomial::{rows, value_and_slope, values_and_slopes};
use crate::shape::stick_zone::{StickZone, StickZones};

/// Fraction of x_s that the first polynomial covers.
pub(crate) const INNER_FRACTION: f64 = 0.4;

/// The fraction of the first polynomial if a layer bends the curve strongly: with 0.5 fewer curves converge.
pub(crate) const KNEE_FRACTION: f64 = 0.55;

/// Number of dyadic intervals of √ρ.
pub(crate) const PIECES: u64 = 5;
/// Number of dyadic intervals of z.
const LAST_PIECES: usize = 6;
/// The smallest ρ of the dyadic intervals of √ρ.
const END_OF_PIECES: f64 = 1.0 / (1 << (2 * PIECES)) as f64;

/// `(n+1) 8/π ∫ t^(n+1/2) (1-t)^(1/2) dt`: K' of the power n of the secant stiffness.
static CYCLE_WEIGHTS: Polynomial = {
    let mut weights = [1.0; TERMS];
    let mut integral = 1.0;
    let mut n = 1;
    while n < TERMS {
        integral *= (n as f64 + 0.5) / (n as f64 + 2.0);
        weights[n] = (n as f64 + 1.0) * integral;
        n += 1;
    }
    rows(&weights)
};

/// The interpolant of one curve.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ForceInterpolant {
    /// First the secant stiffness over the initial stiffness, Λ τ/x, as a function of y = x/(2/5 x_s), or with the other fraction.
    /// Then 1 - τ on the dyadic intervals, as functions of 2ʲ⁺² √ρ - 3, which goes from -1 to 1.
    pieces: [Polynomial; 1 + PIECES as usize],
    /// (1 - τ)/ρ on the dyadic intervals of z, as functions of 2ʲ⁺² z - 3.
    last: [Polynomial; LAST_PIECES],
    /// 1 if all polynomials are accurate to rounding; 0 if the curvature is too strong, for Λ near 0 or with a layer.
    converged: u64,
}

impl ForceInterpolant {
    /// The interpolant of a curve, given the fraction of its first polynomial.
    #[inline(never)]
    pub fn new(inner_fraction: f64, zones: &StickZones) -> ForceInterpolant {
        let (slip_shift, compliance) = (zones.slip_shift, zones.small_load.compliance);
        let at_remaining: &mut dyn FnMut(f64) -> (StickZone, f64) = &mut zones.sequence();
        let (first, remaining) = (inner_fraction * slip_shift, (1.0 - inner_fraction) * slip_shift);
        let mut tangents = Interpolant::<{ TERMS / 2 }>::at_points(|z| {
            let (StickZone { compliance_increase: increase, .. }, curvature) =
                at_remaining(slip_shift - 0.5 * (1.0 - z) * first);
            let stiffness = 1.0 / (compliance + increase);
            let slope = 0.5 * first * compliance * curvature * stiffness * stiffness * stiffness;
            SeriesPoint { value: increase * stiffness, slope }
        });
        // From x = 0 on; the points are symmetric.
        tangents.reverse();
        let decrease = Interpolant::<TERMS>::osculating(&tangents);
        let accuracy = 1e-15;
        let mut converged = decrease.is_converged(accuracy);
        let mut pieces = [[[0.0; 4]; _]; 1 + PIECES as usize];
        pieces[0] = rows(&decrease.mean_from_end().map(|coefficient| -coefficient));
        pieces[0][0][0] = 1.0;
        let mut scale = 0.25;
        for piece in pieces.iter_mut().skip(1) {
            let mut at = |z: f64| {
                let root = scale * (3.0 + z);
                at_remaining(remaining * root * root)
            };
            let unit = 2.0 * remaining * scale * scale;
            // The rounding error of the stiffness grows by 4 from interval to interval.
            let tolerance = accuracy * (1.0 / (16.0 * scale * scale));
            let (polynomial, piece_converged) = interpolate(compliance, unit, &mut at, tolerance);
            *piece = polynomial;
            converged &= piece_converged;
            scale *= 0.5;
        }
        let last = last_pieces(compliance, remaining, at_remaining);
        ForceInterpolant { pieces, last, converged: converged as u64 }
    }

    pub fn is_converged(&self) -> bool {
        self.converged != 0
    }

    /// K' over the initial stiffness and its derivative with respect to y, for cycles up to y = 1: each power of the tangent
    /// stiffness contributes `8/π ∫ sqrt(t (1-t)) tⁿ dt`.
    pub fn cycle_stiffness(&self, y: f64) -> Option<(f64, f64)> {
        let mut powers = self.pieces[0];
        for (row, weights) in powers.iter_mut().zip(&CYCLE_WEIGHTS) {
            *row = (Lanes(*row) * Lanes(*weights)).0;
        }
        self.is_converged().then_some(value_and_slope(&powers, y))
    }

    /// The polynomial of the secant stiffness over the initial stiffness for y up to 1, if converged.
    pub fn secant(&self) -> &Polynomial {
        &self.pieces[0]
    }

    /// 1 - τ and, if requested, its derivative with respect to ρ at roots √ρ on one piece, if converged. At other roots the results
    /// have no meaning.
    #[inline(always)]
    pub fn complements_and_slopes<const L: usize, const SLOPES: bool>(
        &self,
        piece: u64,
        root: Lanes<L>,
    ) -> (Lanes<L>, Lanes<L>) {
        let (power, piece) = (power_of_2(piece), self.pieces.get(piece as usize).unwrap_or(self.secant()));
        let (remaining, slope) = values_and_slopes::<L, SLOPES>(piece, 2.0 * (power * root) - 3.0);
        (remaining, if SLOPES { power * slope / root } else { slope })
    }

    /// (1 - τ)/ρ, and the derivatives of 1 - τ with respect to ρ, at roots √ρ on one piece for integrals, a result of
    /// [`piece_in_integral`] above `PIECES`, if converged. At other roots the results have no meaning.
    #[inline(never)]
    pub fn last_values_and_slopes<const L: usize>(&self, piece: u64, roots: Lanes<L>) -> [Lanes<L>; 2] {
        let j = (piece - 1 - PIECES) / 4;
        let z = (roots * (1 << PIECES) as f64).sqrt().sqrt().max(1.0 / (1 << LAST_PIECES) as f64);
        let argument = 4.0 * (power_of_2(j) * z) - 3.0;
        let piece = self.last.get(j as usize).unwrap_or(self.secant());
        let (value, slope) = values_and_slopes::<L, true>(piece, argument);
        // With f = (1 - τ)/ρ and ρ ~ z⁸, d(ρ f)/dρ = f + z/8 df/dz.
        [value, value + (0.125 * (3.0 + argument)) * slope]
    }
}

/// The root √ρ, positive also for ρ = 0.
pub(crate) fn root_of(rho: f64) -> f64 {
    rho.max(TINY).sqrt()
}

/// The number of the piece of the first polynomial. The pieces of the dyadic intervals of √ρ have the numbers 1 to `PIECES`.
pub(crate) const INNER: u64 = 0;

/// The piece of a root √ρ, from its binary exponent: √ρ falls by a factor of 2 on each piece.
pub(crate) fn piece_of(root: f64) -> u64 {
    1023u64.wrapping_sub(root.to_bits() >> 52)
}

/// The piece of a root √ρ in an integral. Above `PIECES`, four numbers belong to one piece, on which ρ falls by a factor of 256; it
/// has the first of them. The last piece has all smaller roots.
pub(crate) fn piece_in_integral(root: f64) -> u64 {
    let piece = piece_of(root);
    if piece > PIECES { PIECES + 1 + ((piece - 1 - PIECES).min(4 * LAST_PIECES as u64 - 1) & !3) } else { piece }
}

/// 2 to the power of an exponent.
pub(crate) fn power_of_2(exponent: u64) -> f64 {
    f64::from_bits((1023 + exponent) << 52)
}

/// The polynomials of (1 - τ)/ρ beyond the dyadic intervals of √ρ.
fn last_pieces(
    compliance: f64,
    remaining: f64,
    at_remaining: &mut dyn FnMut(f64) -> (StickZone, f64),
) -> [Polynomial; LAST_PIECES] {
    let mut last = [[[0.0; 4]; _]; LAST_PIECES];
    for (piece, polynomial) in last.iter_mut().enumerate() {
        let tangent = |z: f64| {
            let root = 0.25 * (3.0 + z) * f64::from_bits((1023 - piece as u64) << 52);
            let square = root * root;
            let rho = END_OF_PIECES * ((square * square) * (square * square));
            let (zone, _) = at_remaining(remaining * rho);
            let value = zone.load.remaining / rho;
            let tangent = remaining / (compliance + zone.compliance_increase);
            SeriesPoint { value, slope: 8.0 / (3.0 + z) * (tangent - value) }
        };
        *polynomial = powers(Interpolant::<16>::osculating(&Interpolant::<8>::at_points(tangent)).terms());
    }
    last
}

/// The polynomial of 1 - τ on a dyadic interval, and whether it has converged. It is the integral of `unit (3+z)/(Λ + λ)`, with the
/// constant that fits the values of 1 - τ. The compliance at the first point gives a parabola, and the difference from it is
/// interpolated.
#[inline(never)]
fn interpolate(
    compliance: f64,
    unit: f64,
    at: &mut dyn FnMut(f64) -> (StickZone, f64),
    tolerance: f64,
) -> (Polynomial, bool) {
    let (mut sum, mut first) = (0.0, None);
    let tangents = Interpolant::<{ TERMS / 2 }>::at_points(|z| {
        let (StickZone { load, compliance_increase: increase, .. }, curvature) = at(z);
        sum += load.remaining;
        let first = *first.get_or_insert(increase);
        let stiffness = 1.0 / (compliance + increase);
        let (r, ratio) = (3.0 + z, (increase - first) * stiffness);
        let slope = (compliance + first) * curvature * stiffness * stiffness * stiffness;
        SeriesPoint { value: r * ratio, slope: ratio - r * r * unit * slope }
    });
    let decrease = Interpolant::<TERMS>::osculating(&tangents);
    let stiffness = unit / (compliance + first.unwrap_or(0.0));
    let mut integral: Polynomial =
        rows(&decrease.integral().powers_from_middle().map(|coefficient| -stiffness * coefficient));
    // The mean of z²/2 over the points is 1/4.
    let parabola = [sum * (2.0 / TERMS as f64) - 0.25 * stiffness, 3.0 * stiffness, 0.5 * stiffness, 0.0];
    integral[0] = (Lanes(integral[0]) + Lanes(parabola)).0;
    (integral, decrease.is_converged(tolerance * (3.0 - decrease.mean())))
}
