//! The monotonic curve (Eq. 10): tangential force against tangential displacement of initial loading, and its inverse.
//!
//! The curve is odd: its points are computed on the positive half, and the sign is stored separately.

use crate::constant_load::contact::Contact;
use crate::constant_load::evaluator::{Response, sign_of};
use crate::error::Error;
use crate::limits::{check_displacement, check_force};
use crate::shape::Complement;
use crate::shape::stick_zone::StickZone;

/// A point of the monotonic curve. Quantities are evaluated on demand.
#[derive(Debug, Clone, Copy)]
pub struct CurvePoint<'a> {
    pub(super) contact: &'a Contact,
    pub(super) sign: f64,
    known_by: KnownBy,
}

/// The quantity that determines a point.
#[derive(Debug, Clone, Copy)]
enum KnownBy {
    /// The stick zone under a force.
    StickZone(StickZone),
    /// A displacement up to that at the onset of gross slip.
    Displacement(f64),
    /// Gross slip, or no friction: there is no stick zone.
    GrossSlip,
}

impl Contact {
    /// The point of the monotonic curve at a tangential force \[N\].
    /// Errors: `BadForce` if the force is not finite, `ForceExceedsSlip` if it exceeds mu N (an excess of a few units of rounding
    /// is treated as mu N).
    pub fn curve_at_force(&self, force: f64) -> Result<CurvePoint<'_>, Error> {
        self.check_force(force)?;
        let known_by = if self.is_frictionless() {
            KnownBy::GrossSlip
        } else {
            KnownBy::StickZone(self.stick_zone_at_force(force.abs()))
        };
        Ok(CurvePoint { contact: self, sign: sign_of(force), known_by })
    }

    pub(crate) fn check_force(&self, force: f64) -> Result<(), Error> {
        check_force(force, self.slip_force)
    }

    /// The point of the monotonic curve at a tangential displacement \[m\]; the contact is in gross slip beyond
    /// `slip_displacement`.
    /// Errors: `BadDisplacement` if the displacement is not finite, or beyond 1e150.
    pub fn curve_at_displacement(&self, displacement: f64) -> Result<CurvePoint<'_>, Error> {
        check_displacement(displacement)?;
        let gross_slip = self.is_frictionless() || displacement.abs() > self.slip_displacement;
        let known_by = if gross_slip { KnownBy::GrossSlip } else { KnownBy::Displacement(displacement.abs()) };
        Ok(CurvePoint { contact: self, sign: sign_of(displacement), known_by })
    }

    /// The stick zone under a force from 0 to mu N.
    pub(crate) fn stick_zone_at_force(&self, force: f64) -> StickZone {
        let (force, unit) = (force.min(self.slip_force), self.slip_force.max(f64::MIN_POSITIVE));
        let remaining = self.slip_force - force;
        // mu N in twice the precision: the distance to gross slip is then as accurate as the force.
        let remaining = if remaining > 0.0 { (remaining + self.slip_force_rounding).max(0.0) } else { 0.0 };
        self.zones.at_load(Complement { consumed: force / unit, remaining: remaining / unit })
    }

    /// The stick zone at a displacement up to that of gross slip.
    pub(crate) fn stick_zone_before_slip(&self, displacement: Complement) -> StickZone {
        let unit = self.displacement_scale.max(f64::MIN_POSITIVE);
        let Complement { consumed, remaining } = displacement;
        self.zones.at_shift(Complement { consumed: consumed / unit, remaining: remaining / unit })
    }

    /// Force \[N\] of a stick zone.
    pub(crate) fn force_of(&self, zone: &StickZone) -> f64 {
        if zone.load.consumed > 0.5 {
            self.slip_force - self.slip_force * zone.load.remaining
        } else {
            self.slip_force * zone.load.consumed
        }
    }

    /// dT/d(displacement) \[N/m\] at a stick zone.
    pub(crate) fn stiffness_of(&self, zone: &StickZone) -> f64 {
        self.stiffness_scale / self.zones.compliance(zone)
    }
}

impl CurvePoint<'_> {
    /// The stick zone; `None` in gross slip, and without friction.
    pub(crate) fn stick_zone(&self) -> Option<StickZone> {
        match self.known_by {
            KnownBy::StickZone(zone) => Some(zone),
            KnownBy::Displacement(displacement) => {
                let (load, _) = self.contact.load_at(self.contact.before_slip(displacement));
                Some(self.contact.zones.at_load(load))
            }
            KnownBy::GrossSlip => None,
        }
    }

    /// Tangential force T \[N\].
    pub fn force(&self) -> f64 {
        self.force_and_stiffness().0
    }

    /// Tangential displacement \[m\]; in gross slip the displacement at its onset.
    pub fn displacement(&self) -> f64 {
        self.sign
            * match self.known_by {
                KnownBy::StickZone(zone) => self.contact.displacement_scale * zone.shift.consumed,
                KnownBy::Displacement(displacement) => displacement,
                KnownBy::GrossSlip => self.contact.slip_displacement,
            }
    }

    /// dT/d(displacement) \[N/m\]; 0 in gross slip.
    pub fn stiffness(&self) -> f64 {
        self.force_and_stiffness().1
    }

    /// [`force`](CurvePoint::force) and [`stiffness`](CurvePoint::stiffness).
    pub fn force_and_stiffness(&self) -> (f64, f64) {
        let (force, stiffness) = match &self.known_by {
            KnownBy::StickZone(zone) => (self.contact.force_of(zone), self.contact.stiffness_of(zone)),
            KnownBy::Displacement(displacement) => {
                let Response { force, stiffness } = self.contact.response(*displacement);
                (force, stiffness)
            }
            KnownBy::GrossSlip => (self.contact.slip_force, 0.0),
        };
        (self.sign * force, stiffness)
    }

    /// d(displacement)/dT \[m/N\]; infinite in gross slip, without friction, and at mu N if the stick zone shrinks to a point.
    pub fn compliance(&self) -> f64 {
        let unit = self.contact.stiffness_scale.max(f64::MIN_POSITIVE);
        self.stick_zone().map_or(f64::INFINITY, |zone| self.contact.zones.compliance(&zone) / unit)
    }

    /// Half-width c of the stick zone \[m\]. At the onset of gross slip (a force of mu N or a displacement of `slip_displacement`)
    /// it is the half-width a of the flat, 0 for a cylinder and an ellipse. Beyond that displacement it is 0.
    pub fn stick_half_width(&self) -> f64 {
        self.stick_zone().map_or(0.0, |zone| self.contact.half_width * self.contact.zones.size(&zone))
    }
}
