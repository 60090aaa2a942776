//! The inverse of the monotonic curve as polynomials, prepared once: force and stiffness at a displacement without
//! iteration.
//!
//! With x_s the approach at gross slip, the first 2/5 of the way are one polynomial in the approach. What is left until
//! gross slip, `ρ = (x_s - x)/(3/5 x_s)`, goes with its root v: the curve is singular at v = 0, where it may have any power of
//! ρ^(1/3) or a logarithm, and seen from the octave 2⁻ʲ⁻¹ < v < 2⁻ʲ that is three half-lengths away, so that every octave needs
//! the same few terms. What is interpolated is the tangent stiffness, of which the force is the integral: both keep their
//! digits; and of the stiffness only what it falls by, so that rounding is felt no more than the curve bends. Below the last octave, in the last 2000th of the way, the curve is solved as it stands.

use crate::numerics::chebyshev::{Interpolant, Polynomial, TERMS};
use crate::numerics::polynomial::{rows, value_and_slope};
use crate::shape::rounded_punch::TINY;
use crate::shape::{Complement, StickZone};

/// Share of x_s that the polynomial from the origin covers.
pub(crate) const INNER_FRACTION: f64 = 0.4;

/// Octaves of v.
const PIECES: usize = 5;

/// `(n+1) 8/π ∫ t^(n+1/2) (1-t)^(1/2) dt`: what K' makes of the power n of the secant stiffness.
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

/// The inverse of one curve.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ForceInterpolant {
    /// Λ τ/x over y = x/(2/5 x_s): the secant stiffness over the initial one.
    origin: Polynomial,
    /// 1 - τ over z = 2ʲ⁺² v - 3, from -1 to 1.
    pieces: [Polynomial; PIECES],
    /// 1 where all of them are accurate to rounding; 0 for a curve that bends too sharply, with Λ near 0.
    converged: f64,
}

impl ForceInterpolant {
    pub const NONE: ForceInterpolant =
        ForceInterpolant { origin: [[0.0; 4]; _], pieces: [[[0.0; 4]; _]; PIECES], converged: 0.0 };

    /// The inverse of the curve on which `at_shift` finds members, whose compliance is Λ + λ.
    pub fn new(
        slip_shift: f64,
        compliance: f64,
        mut at_shift: impl FnMut(Complement) -> StickZone,
    ) -> ForceInterpolant {
        let (first, remaining) = (INNER_FRACTION * slip_shift, (1.0 - INNER_FRACTION) * slip_shift);
        let fall = Interpolant::<TERMS>::through(|z| {
            let consumed = 0.5 * (1.0 + z) * first;
            let compliance_increase =
                at_shift(Complement { consumed, remaining: slip_shift - consumed }).compliance_increase;
            compliance_increase / (compliance + compliance_increase)
        });
        let mut converged = fall.is_converged(1e-15);
        let mut origin = fall.mean_from_end().map(|row| row.map(|coefficient| -coefficient));
        if let Some([first, ..]) = origin.first_mut() {
            *first = 1.0;
        }
        let mut pieces = [[[0.0; 4]; _]; PIECES];
        let mut scale = 0.25;
        for (j, piece) in pieces.iter_mut().enumerate() {
            let at = |z: f64| {
                let v = scale * (3.0 + z);
                let left = remaining * v * v;
                at_shift(Complement { consumed: slip_shift - left, remaining: left })
            };
            let unit = 2.0 * remaining * scale * scale;
            // What the stiffness can be known to grows by four from octave to octave: the later ones need fewer points.
            let tolerance = 1e-15 * (1.0 / (16.0 * scale * scale));
            let (polynomial, fine) = if j < 2 {
                interpolate::<TERMS>(compliance, unit, at, tolerance)
            } else {
                interpolate::<16>(compliance, unit, at, tolerance)
            };
            *piece = polynomial;
            converged &= fine;
            scale *= 0.5;
        }
        ForceInterpolant { origin, pieces, converged: if converged { 1.0 } else { 0.0 } }
    }

    /// Secant and tangent stiffness over the initial one at y = x/(2/5 x_s), at most 1.
    #[inline(always)]
    pub fn secant_and_tangent(&self, y: f64) -> Option<(f64, f64)> {
        let (mean, slope) = value_and_slope(&self.origin, y);
        (self.converged > 0.0).then_some((mean, mean + slope * y))
    }

    /// K' over the initial stiffness and its derivative by y, for cycles up to y = 1: `8/π ∫ sqrt(t (1-t)) tⁿ dt` of every power of
    /// the tangent stiffness.
    pub fn cycle(&self, y: f64) -> Option<(f64, f64)> {
        let mut powers = self.origin;
        for (row, weights) in powers.iter_mut().zip(&CYCLE_WEIGHTS) {
            row.iter_mut().zip(weights).for_each(|(power, weight)| *power *= weight);
        }
        (self.converged > 0.0).then_some(value_and_slope(&powers, y))
    }

    /// 1 - τ and its derivative by ρ; none where ρ is too small.
    #[inline(always)]
    pub fn complement_and_slope(&self, rho: f64) -> Option<(f64, f64)> {
        let v = rho.max(TINY).sqrt();
        // 2⁻ʲ is the next power of 2 above v; v = 1 belongs to the first octave.
        let exponent = (v.to_bits() >> 52).min(1022);
        let piece = self.pieces.get((1022 - exponent) as usize)?;
        let scale = f64::from_bits((2047 - 2 - exponent) << 52);
        let (remaining, slope) = value_and_slope(piece, 4.0 * (scale * v) - 3.0);
        (self.converged > 0.0).then_some((remaining, 2.0 * scale * slope / v))
    }
}

/// 1 - τ over an octave, and whether it is resolved: the integral of `unit (3+z)/(Λ + λ)`, placed by its own values. The
/// compliance at the first point makes a parabola of it, and what is interpolated is the way from there.
fn interpolate<const N: usize>(
    compliance: f64,
    unit: f64,
    mut at: impl FnMut(f64) -> StickZone,
    tolerance: f64,
) -> (Polynomial, bool) {
    let mut values = [0.0; N];
    let mut places = values.iter_mut();
    let mut first = None;
    let fall = Interpolant::<N>::through(|z| {
        let member = at(z);
        if let Some(place) = places.next() {
            *place = member.load.remaining;
        }
        (3.0 + z)
            * ((member.compliance_increase - *first.get_or_insert(member.compliance_increase))
                / (compliance + member.compliance_increase))
    });
    let stiffness = unit / (compliance + first.unwrap_or(0.0));
    let mut integral = fall.integral().map(|row| row.map(|coefficient| -stiffness * coefficient));
    if let Some([_, linear, square, _]) = integral.first_mut() {
        *linear += 3.0 * stiffness;
        *square += 0.5 * stiffness;
    }
    let points = const { &Interpolant::<N>::POINTS };
    let off = points.iter().zip(values).map(|(&z, value)| value - value_and_slope(&integral, z).0);
    let constant = off.sum::<f64>() / N as f64;
    if let Some([first, ..]) = integral.first_mut() {
        *first = constant;
    }
    (integral, fall.is_converged(tolerance * (3.0 - fall.mean())))
}

#[cfg(test)]
mod tests {
    use crate::constant_load::contact::tests::{FLATS, contact};

    /// The ends of the pieces: where the polynomial in the approach ends, and every octave of v.
    fn borders() -> impl Iterator<Item = f64> {
        (0..=super::PIECES as i32).map(|piece| 1.0 - (1.0 - super::INNER_FRACTION) * 0.25f64.powi(piece))
    }

    #[test]
    fn force_and_stiffness_are_those_of_the_stick_zone() {
        for contact in FLATS.map(contact) {
            let shares = (1..400).map(|k| f64::from(k) / 400.0).chain([1e-12, 1e-3, 0.9999]).chain(borders());
            for share in shares.filter(|share| *share < 1.0) {
                let displacement = share * contact.slip_displacement;
                let (found, stick) = (contact.response(displacement), contact.stick_zone_at_displacement(displacement));
                // Three polynomials' roundings of a unit each; near gross slip the stiffness has those of what is left.
                assert!((found.force / contact.force_of(&stick) - 1.0).abs() < 1.5e-15, "{share}");
                let bound = 2e-15 / (1.0 - share).min(1.0);
                assert!((found.stiffness / contact.stiffness_of(&stick) - 1.0).abs() < bound, "{share}");
            }
        }
    }

    #[test]
    fn pieces_meet_and_the_curve_ends() {
        for contact in FLATS.map(contact) {
            for border in borders() {
                let below = (border * contact.slip_displacement).next_down().next_down();
                let steps = std::iter::successors(Some(below), |x| Some(x.next_up())).take(5);
                let forces: std::vec::Vec<f64> = steps.map(|x| contact.response(x).force).collect();
                for pair in forces.windows(2) {
                    assert!((pair[1] / pair[0] - 1.0).abs() < 1.5e-15, "{border}");
                }
            }
            let end = contact.response(contact.slip_displacement);
            assert_eq!(end.force, contact.slip_force);
            let beyond = contact.response(contact.slip_displacement.next_up());
            assert_eq!((beyond.force, beyond.stiffness), (contact.slip_force, 0.0));
            assert_eq!(contact.response(0.0).stiffness, contact.initial_stiffness);
        }
    }

    /// Where the curve bends too sharply for polynomials it is solved, and as accurate.
    #[test]
    fn a_length_just_allowed_has_no_polynomials() {
        use crate::constant_load::contact::tests::cylinder;
        use crate::parameters::CENTRE_POINT;
        for compliance_increase in [1e-9, 1e-3, 0.02] {
            let contact = cylinder(1.0 + compliance_increase, 0.0, CENTRE_POINT).unwrap();
            assert_eq!(contact.interpolant().converged, 0.0);
            for share in (1..400).map(|k| f64::from(k) / 400.0).chain([1e-9, 0.9999]) {
                let displacement = share * contact.slip_displacement;
                let back = contact.curve_at_force(contact.response(displacement).force).unwrap().displacement();
                // A few units on both ways. Near gross slip a unit of the force is worth as much of the displacement.
                assert!(
                    (back / displacement - 1.0).abs() < 4e-15,
                    "{compliance_increase} {share} {}",
                    back / displacement - 1.0
                );
            }
        }
    }
}
