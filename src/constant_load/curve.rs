//! The monotonic curve (Eq. 10): tangential force against tangential displacement of a contact first loaded, its inverse,
//! and the tractions and the slip that go with it.
//!
//! The curve is odd; its points below are those of its positive half, with the sign kept beside them.

use crate::constant_load::contact::{Contact, check_displacement};
use crate::constant_load::interpolant::ForceInterpolant;
use crate::error::Error;
use crate::law::Response;
use crate::numerics::fp_class::{abs_le, is_finite};
use crate::shape::stick_zone::{Complement, StickZone, SurfacePoint};

/// Relative excess over mu N that is taken for rounding.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A point of the monotonic curve. What is asked for is computed; what is not, is not.
#[derive(Debug, Clone, Copy)]
pub struct CurvePoint<'a> {
    contact: &'a Contact,
    sign: f64,
    given: Given,
}

/// By what a point is known.
#[derive(Debug, Clone, Copy)]
enum Given {
    /// The stick zone under a force.
    Stick(StickZone),
    /// A displacement up to that of gross slip.
    Displacement(f64),
    /// Gross slip, or no friction: there is no stick zone.
    Slip,
}

impl Contact {
    /// The point of the monotonic curve at a tangential force \[N\].
    ///
    /// # Errors
    /// `BadForce` for a force that is not finite, `ForceExceedsSlip` for one beyond mu N (a few units of rounding beyond
    /// are taken as mu N).
    pub fn curve_at_force(&self, force: f64) -> Result<CurvePoint<'_>, Error> {
        self.check_force(force)?;
        let given =
            if self.is_frictionless() { Given::Slip } else { Given::Stick(self.stick_zone_at_force(force.abs())) };
        Ok(CurvePoint { contact: self, sign: sign_of(force), given })
    }

    pub(crate) fn check_force(&self, force: f64) -> Result<(), Error> {
        if abs_le(force, self.slip_force * (1.0 + ROUNDING)) {
            Ok(())
        } else if is_finite(force) {
            Err(Error::ForceExceedsSlip)
        } else {
            Err(Error::BadForce)
        }
    }

    /// The point of the monotonic curve at a tangential displacement \[m\]; beyond `slip_displacement` the contact slips.
    ///
    /// # Errors
    /// `BadDisplacement` for a displacement that is not finite, or beyond 1e150.
    pub fn curve_at_displacement(&self, displacement: f64) -> Result<CurvePoint<'_>, Error> {
        check_displacement(displacement)?;
        let gross_slip = self.is_frictionless() || displacement.abs() > self.slip_displacement;
        let given = if gross_slip { Given::Slip } else { Given::Displacement(displacement.abs()) };
        Ok(CurvePoint { contact: self, sign: sign_of(displacement), given })
    }

    /// The stick zone under a force from 0 to mu N.
    pub(crate) fn stick_zone_at_force(&self, force: f64) -> StickZone {
        let (force, unit) = (force.min(self.slip_force), self.slip_force.max(f64::MIN_POSITIVE));
        let remaining = self.slip_force - force;
        // mu N to twice the digits: what rests near gross slip is then as good as the force given.
        let remaining = if remaining > 0.0 { (remaining + self.slip_force_rounding).max(0.0) } else { 0.0 };
        self.stick_zones().at_load(Complement { consumed: force / unit, remaining: remaining / unit })
    }

    /// The stick zone at a displacement from 0 to that of gross slip.
    pub(crate) fn stick_zone_at_displacement(&self, displacement: f64) -> StickZone {
        let unit = self.displacement_scale.max(f64::MIN_POSITIVE);
        let displacement = displacement.min(self.slip_displacement);
        self.stick_zones().at_shift(Complement {
            consumed: displacement / unit,
            remaining: (self.slip_displacement - displacement) / unit,
        })
    }

    /// Force and stiffness at a displacement >= 0; beyond that of gross slip mu N and 0, and 0 and 0 without friction.
    #[inline(always)]
    pub(crate) fn response(&self, displacement: f64) -> Response {
        self.evaluator().at(displacement)
    }

    /// The same, not inlined.
    #[inline(never)]
    pub(crate) fn response_at(&self, displacement: f64) -> Response {
        self.response(displacement)
    }

    /// What responses need, taken together once for many of them.
    #[inline(always)]
    pub(crate) fn evaluator(&self) -> CurveEvaluator<'_> {
        CurveEvaluator {
            contact: self,
            elliptic: self.is_elliptic(),
            interpolant: self.interpolant(),
            slip_force: self.slip_force,
            slip_displacement: self.slip_displacement,
            initial_stiffness: self.initial_stiffness,
            inner_scale: self.inner_scale,
            outer_scale: self.outer_scale,
            rest_stiffness: self.slip_force * self.outer_scale,
        }
    }

    /// Force and stiffness at displacements of either sign.
    #[inline(always)]
    pub(crate) fn responses(&self, displacement: &[f64], force: Option<&mut [f64]>, stiffness: Option<&mut [f64]>) {
        let evaluator = self.evaluator();
        let signed = |displacement: f64| {
            let Response { force, stiffness } = evaluator.at(displacement.abs());
            Response { force: sign_of(displacement) * force, stiffness }
        };
        match (force, stiffness) {
            (Some(force), Some(stiffness)) => {
                for ((force, stiffness), &displacement) in force.iter_mut().zip(stiffness).zip(displacement) {
                    Response { force: *force, stiffness: *stiffness } = signed(displacement);
                }
            }
            (Some(force), None) => {
                for (force, &displacement) in force.iter_mut().zip(displacement) {
                    *force = signed(displacement).force;
                }
            }
            (None, Some(stiffness)) => {
                for (stiffness, &displacement) in stiffness.iter_mut().zip(displacement) {
                    *stiffness = signed(displacement).stiffness;
                }
            }
            (None, None) => {}
        }
    }

    /// Force and stiffness where there is no polynomial.
    #[cold]
    #[inline(never)]
    fn solved_response(&self, displacement: f64) -> Response {
        if self.is_frictionless() {
            return Response { force: 0.0, stiffness: 0.0 };
        }
        let stick = self.stick_zone_at_displacement(displacement);
        Response { force: self.force_of(&stick), stiffness: self.stiffness_of(&stick) }
    }

    /// Force \[N\] of a stick zone.
    pub(crate) fn force_of(&self, stick: &StickZone) -> f64 {
        if stick.load.consumed > 0.5 {
            self.slip_force - self.slip_force * stick.load.remaining
        } else {
            self.slip_force * stick.load.consumed
        }
    }

    /// dT/d(displacement) \[N/m\] at a stick zone.
    pub(crate) fn stiffness_of(&self, stick: &StickZone) -> f64 {
        self.stiffness_scale / self.stick_zones().compliance(stick)
    }

    /// Energy \[J\] dissipated per cycle of a displacement amplitude up to gross slip, and its derivative \[N\].
    #[inline(always)]
    pub(crate) fn cycle_energy(&self, amplitude: f64) -> (f64, f64) {
        let family = self.stick_zones();
        if let Some((load, stiffness)) = self.evaluator().load_at(amplitude) {
            if load.consumed <= 0.5 {
                let (dissipation, slope) = family.small_load().dissipation_with_derivative(load.consumed);
                return (self.energy_scale() * dissipation, self.displacement_scale * slope * stiffness);
            }
            let compliance_increase =
                self.stiffness_scale / stiffness.max(f64::MIN_POSITIVE) - family.small_load().compliance;
            let (dissipation, slope) = self.rounded_flat_zones().cycle(load.remaining, compliance_increase);
            return (self.energy_scale() * dissipation, self.displacement_scale * slope * stiffness);
        }
        let stick = self.stick_zone_at_displacement(amplitude);
        let slope = self.slip_force * family.d_dissipation(&stick) / family.compliance(&stick);
        (self.energy_of(&stick), slope)
    }

    /// Energy \[J\] dissipated per cycle whose half-cycles end with that stick zone.
    pub(crate) fn energy_of(&self, stick: &StickZone) -> f64 {
        self.energy_scale() * self.stick_zones().dissipation(stick)
    }
}

/// Finds force and stiffness at displacements on the monotonic curve.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CurveEvaluator<'a> {
    contact: &'a Contact,
    elliptic: bool,
    interpolant: &'a ForceInterpolant,
    slip_force: f64,
    pub slip_displacement: f64,
    initial_stiffness: f64,
    inner_scale: f64,
    outer_scale: f64,
    rest_stiffness: f64,
}

impl CurveEvaluator<'_> {
    /// At a displacement >= 0.
    #[inline(always)]
    pub fn at(&self, displacement: f64) -> Response {
        let left = self.slip_displacement - displacement;
        if left < 0.0 {
            return Response { force: self.slip_force, stiffness: 0.0 };
        }
        if self.elliptic {
            return self.elliptic_at(displacement, left);
        }
        let y = displacement * self.inner_scale;
        if y <= 1.0 {
            if let Some((secant, tangent)) = self.interpolant.secant_and_tangent(y) {
                let first = self.initial_stiffness;
                return Response { force: first * displacement * secant, stiffness: first * tangent };
            }
        } else if let Some((remaining, rate)) = self.interpolant.complement_and_slope(left * self.outer_scale) {
            let force = self.slip_force - self.slip_force * remaining;
            return Response { force, stiffness: self.rest_stiffness * rate };
        }
        self.contact.solved_response(displacement)
    }

    /// The load at a displacement up to that of gross slip, both parts accurate, and the stiffness; none where there is no
    /// polynomial.
    #[inline(always)]
    pub fn load_at(&self, displacement: f64) -> Option<(Complement, f64)> {
        if self.elliptic {
            return None;
        }
        let y = displacement * self.inner_scale;
        if y <= 1.0 {
            let (secant, tangent) = self.interpolant.secant_and_tangent(y)?;
            let consumed = self.initial_stiffness * displacement / self.slip_force.max(f64::MIN_POSITIVE) * secant;
            Some((Complement { consumed, remaining: 1.0 - consumed }, self.initial_stiffness * tangent))
        } else {
            let left = self.slip_displacement - displacement;
            let (remaining, rate) = self.interpolant.complement_and_slope(left * self.outer_scale)?;
            Some((Complement { consumed: 1.0 - remaining, remaining }, self.rest_stiffness * rate))
        }
    }

    /// `x/x_s = 1 - σ²` and `τ = 1 - σ³`: the difference from the root, which loses nothing.
    #[inline(always)]
    fn elliptic_at(&self, displacement: f64, left: f64) -> Response {
        let size = (left * self.outer_scale).max(0.0).sqrt();
        let consumed = displacement * self.outer_scale / (1.0 + size);
        // Near gross slip rounding must not come out above mu N.
        let load = consumed * (1.0 + size * (1.0 + size));
        let force = self.slip_force * if load > 1.0 { 1.0 } else { load };
        Response { force, stiffness: self.initial_stiffness * size }
    }
}

fn sign_of(value: f64) -> f64 {
    if value < 0.0 { -1.0 } else { 1.0 }
}

impl CurvePoint<'_> {
    /// The stick zone; none in gross slip, and none without friction.
    pub(crate) fn stick(&self) -> Option<StickZone> {
        match self.given {
            Given::Stick(stick) => Some(stick),
            Given::Displacement(displacement) => Some(self.contact.stick_zone_at_displacement(displacement)),
            Given::Slip => None,
        }
    }

    /// Tangential force T \[N\].
    #[must_use]
    pub fn force(&self) -> f64 {
        self.sign
            * match &self.given {
                Given::Stick(stick) => self.contact.force_of(stick),
                Given::Displacement(displacement) => self.contact.response(*displacement).force,
                Given::Slip => self.contact.slip_force,
            }
    }

    /// Tangential displacement \[m\] of a point that sticks; in gross slip that at which it started.
    #[must_use]
    pub fn displacement(&self) -> f64 {
        self.sign
            * match self.given {
                Given::Stick(stick) => self.contact.displacement_scale * stick.shift.consumed,
                Given::Displacement(displacement) => displacement,
                Given::Slip => self.contact.slip_displacement,
            }
    }

    /// dT/d(displacement) \[N/m\]; 0 in gross slip.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        match &self.given {
            Given::Stick(stick) => self.contact.stiffness_of(stick),
            Given::Displacement(displacement) => self.contact.response(*displacement).stiffness,
            Given::Slip => 0.0,
        }
    }

    /// d(displacement)/dT \[m/N\]; infinite at mu N where the stick zone shrinks to nothing, and without friction.
    #[must_use]
    pub fn compliance(&self) -> f64 {
        let unit = self.contact.stiffness_scale.max(f64::MIN_POSITIVE);
        self.stick().map_or(f64::INFINITY, |stick| self.contact.stick_zones().compliance(&stick) / unit)
    }

    /// Half-width c of the stick zone \[m\]; 0 in gross slip, where nothing sticks.
    #[must_use]
    pub fn stick_half_width(&self) -> f64 {
        self.stick().map_or(0.0, |stick| self.contact.half_width * self.contact.stick_zones().size(&stick))
    }

    /// The stick zone, in gross slip the smallest member of the family, to which it has shrunk.
    fn stick_or_last(&self) -> StickZone {
        self.stick().unwrap_or_else(|| self.contact.stick_zone_at_force(self.contact.slip_force))
    }

    /// Shear traction \[Pa\] at x \[m\] (Eq. 21).
    #[must_use]
    pub fn shear(&self, x: f64) -> f64 {
        if self.contact.is_frictionless() {
            return 0.0;
        }
        let unit = self.contact.friction_coefficient * self.contact.pressure_scale;
        self.sign * unit * self.contact.stick_zones().shear(&self.contact.place(x), &self.stick_or_last())
    }

    /// Relative slip \[m\] at x \[m\] (Eq. 15), in gross slip that at its start: 0 in the stick zone and outside the contact.
    ///
    /// # Errors
    /// `NotAvailable` for an elliptical contact.
    pub fn slip(&self, x: f64) -> Result<f64, Error> {
        let place = self.contact.place(x);
        let slip = self.contact.stick_zones().slip(&place, &self.stick_or_last()).ok_or(Error::NotAvailable)?;
        let slips = place.from_edge >= 0.0 && !self.contact.is_frictionless();
        Ok(if slips { self.sign * self.contact.displacement_scale * slip } else { 0.0 })
    }

    /// Frictional damage parameter `mu p |s|` \[N/m\] at x \[m\] (section 3.5).
    ///
    /// # Errors
    /// `NotAvailable` for an elliptical contact.
    pub fn damage(&self, x: f64) -> Result<f64, Error> {
        Ok(self.damage_of(x, self.slip(x)?))
    }

    /// The damage parameter, given the slip at x.
    pub(crate) fn damage_of(&self, x: f64, slip: f64) -> f64 {
        self.contact.friction_coefficient * self.contact.pressure(x) * slip.abs()
    }
}

impl Contact {
    /// Normal pressure \[Pa\] at x \[m\] (Eq. 17); 0 outside the contact.
    #[must_use]
    pub fn pressure(&self, x: f64) -> f64 {
        if self.half_width > 0.0 { self.pressure_scale * self.stick_zones().pressure(&self.place(x)) } else { 0.0 }
    }

    /// Where x lies along the width; far outside is as good as twice the half-width.
    fn place(&self, x: f64) -> SurfacePoint {
        let (x, unit) = (x.abs().min(2.0 * self.half_width), self.half_width.max(f64::MIN_POSITIVE));
        SurfacePoint {
            x: x / unit,
            past_flat: (x - self.flat_half_width.min(x + unit)) / unit,
            from_edge: (self.half_width - x) / unit,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constant_load::contact::tests::{FLATS, TITANIUM, contact, ellipse};
    use crate::numerics::quadrature::gauss;
    use core::f64::consts::PI;

    /// Eq. 10, from the stick half-width, which enters through ln c: its digits are absolute here.
    #[test]
    fn the_compliance_is_that_of_the_stick_zone_and_adds_up_to_the_displacement() {
        for flat in FLATS {
            let contact = contact(flat);
            let nu = TITANIUM.poisson_ratio;
            let compliance = |force: f64| {
                let c = contact.curve_at_force(force).unwrap().stick_half_width();
                2.0 / (PI * contact.composite_modulus * 10e-3) * ((2.0 * 10e-3 / c).ln() + nu / (1.0 - nu))
            };
            for part in [1e-9, 0.1, 0.499, 0.501, 0.9, 0.99] {
                let force = part * contact.slip_force;
                let point = contact.curve_at_force(force).unwrap();
                let expected = compliance(force);
                // Each of a logarithm's few units.
                assert!((point.compliance() / expected - 1.0).abs() < 3e-15, "{flat} {part}");
                assert!((point.stiffness() * point.compliance() - 1.0).abs() < 3e-15, "{flat} {part}");
                // Panels of 1/64 keep the logarithm at mu N, 0.01 away, a panel's length off.
                let panels: f64 = (0..64)
                    .map(|panel| gauss(force / 64.0, |step| compliance(force / 64.0 * panel as f64 + step)))
                    .sum();
                assert!((point.displacement() / panels - 1.0).abs() < 1e-13, "{flat} {part}");
            }
        }
    }

    #[test]
    fn the_curve_ends_at_mu_n_and_a_flat_leaves_it_with_a_kink() {
        for flat in FLATS.into_iter().chain([1e-80, 1e-250]) {
            let contact = contact(flat);
            let end = contact.curve_at_force(contact.slip_force).unwrap();
            assert_eq!(end.displacement(), contact.slip_displacement);
            assert_eq!(end.stick_half_width() == 0.0, flat == 0.0);
            // A quotient, a root and a product.
            assert!((end.stick_half_width() - flat).abs() <= 4e-16 * flat, "{flat} {}", end.stick_half_width());
            assert_eq!(end.compliance().is_infinite(), flat == 0.0);
            let half = 0.5 * contact.slip_displacement;
            assert_eq!(contact.curve_at_displacement(-half).unwrap().displacement(), -half);
            let beyond = contact.curve_at_displacement(-2.0 * contact.slip_displacement).unwrap();
            assert_eq!((beyond.force(), beyond.stiffness()), (-contact.slip_force, 0.0));
            assert_eq!((beyond.displacement(), beyond.stick_half_width()), (-contact.slip_displacement, 0.0));
        }
    }

    #[test]
    fn all_of_the_contact_is_at_mu_p_under_mu_n_and_none_at_rest() {
        for flat in FLATS {
            let contact = contact(flat);
            let (end, remaining) =
                (contact.curve_at_force(-contact.slip_force).unwrap(), contact.curve_at_force(0.0).unwrap());
            for place in [0.0, 0.3, -0.7, 0.999, 1.0, 1.5] {
                let x = place * contact.half_width;
                let limit = 0.4 * contact.pressure(x);
                assert!((end.shear(x) + limit).abs() <= 4e-16 * limit, "{flat} {place}");
                assert_eq!((remaining.shear(x), remaining.slip(x)), (0.0, Ok(0.0)));
                let slip = end.slip(x).unwrap();
                assert!(slip <= 0.0);
                // mu p |s|, to the rounding of two products.
                assert!((end.damage(x).unwrap() + limit * slip).abs() <= 4e-16 * (limit * slip).abs());
            }
        }
    }

    #[test]
    fn force_and_displacement_are_refused_by_name() {
        let contact = contact(50e-6);
        let at_force = |force: f64| contact.curve_at_force(force).map(|point| point.force());
        let limit = contact.slip_force;
        assert_eq!(at_force(limit * (1.0 + 4.0 * f64::EPSILON)), Ok(limit));
        assert_eq!(at_force(-limit * (1.0 + 4.0 * f64::EPSILON)), Ok(-limit));
        assert_eq!(at_force(limit * (1.0 + 1e-13)), Err(Error::ForceExceedsSlip));
        assert_eq!(at_force(f64::NAN), Err(Error::BadForce));
        assert_eq!(at_force(f64::NEG_INFINITY), Err(Error::BadForce));
        let at_displacement = |x: f64| contact.curve_at_displacement(x).map(|point| point.force());
        assert_eq!(at_displacement(1e150), Ok(limit));
        assert_eq!(at_displacement(-1.1e150), Err(Error::BadDisplacement));
        assert_eq!(at_displacement(f64::NAN), Err(Error::BadDisplacement));
        assert_eq!(ellipse(1e-4, 1e-3).curve_at_force(1.0).unwrap().slip(0.0), Err(Error::NotAvailable));
    }

    /// Gross slip has the tractions and the slip with which it began, whichever way it is asked for.
    #[test]
    fn tractions_stay_in_gross_slip() {
        for contact in FLATS.map(contact) {
            let at_force = contact.curve_at_force(-contact.slip_force).unwrap();
            let beyond = contact.curve_at_displacement(-1.5 * contact.slip_displacement).unwrap();
            for x in [0.0, 0.5, 0.95, 1.0, 1.1].map(|place| place * contact.half_width) {
                assert_eq!(beyond.shear(x), at_force.shear(x));
                assert_eq!(beyond.slip(x), at_force.slip(x));
            }
            assert!(beyond.shear(0.0) < 0.0 && beyond.stick_half_width() == 0.0);
        }
    }
}
