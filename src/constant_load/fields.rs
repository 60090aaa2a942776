//! Fields along the width of the contact: pressure, and under a monotonically increased force shear traction, slip and damage.

use crate::constant_load::contact::Contact;
use crate::constant_load::curve::CurvePoint;
use crate::error::Error;
use crate::shape::stick_zone::StickZone;
use crate::shape::tractions::SurfacePoint;

impl CurvePoint<'_> {
    /// The stick zone; in gross slip the zone to which it had shrunk at the onset.
    fn stick_zone_or_smallest(&self) -> StickZone {
        self.stick_zone().unwrap_or_else(|| self.contact.stick_zone_at_force(self.contact.slip_force))
    }

    /// Shear traction \[Pa\] at x \[m\] (Eq. 21).
    pub fn shear(&self, x: f64) -> f64 {
        if self.contact.is_frictionless() {
            return 0.0;
        }
        let unit = self.contact.friction_coefficient * self.contact.pressure_scale;
        let point = self.contact.surface_point(x);
        self.sign * unit * self.contact.zones.shear(&point, &self.stick_zone_or_smallest())
    }

    /// Relative slip \[m\] at x \[m\] (Eq. 15), in gross slip that at its onset: 0 in the stick zone and outside the contact.
    /// Errors: `NotAvailable` for an elliptical contact.
    pub fn slip(&self, x: f64) -> Result<f64, Error> {
        let point = self.contact.surface_point(x);
        let zone = self.stick_zone_or_smallest();
        let slip = self.contact.zones.slip(&point, &zone).ok_or(Error::NotAvailable)?;
        let slips = point.from_edge >= 0.0 && !self.contact.is_frictionless();
        Ok(if slips { self.sign * self.contact.displacement_scale * slip } else { 0.0 })
    }

    /// Frictional damage parameter `mu p |s|` \[N/m\] at x \[m\] (section 3.5).
    /// Errors: `NotAvailable` for an elliptical contact.
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
    pub fn pressure(&self, x: f64) -> f64 {
        if self.half_width > 0.0 { self.pressure_scale * self.zones.pressure(&self.surface_point(x)) } else { 0.0 }
    }

    fn surface_point(&self, x: f64) -> SurfacePoint {
        SurfacePoint::new(x, self.half_width, self.flat_half_width)
    }
}
