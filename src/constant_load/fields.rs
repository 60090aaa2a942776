//! Fields along the width of the contact: pressure, and under a monotonically increased force shear traction, slip and damage.

use crate::constant_load::contact::Contact;
use crate::constant_load::curve::CurvePoint;
use crate::error::Error;
use crate::shape::stick_zone::StickZone;
use crate::shape::tractions::SurfacePoint;

impl CurvePoint<'_> {
    /// The stick zone; in gross slip the smallest one, to which it has shrunk.
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
        self.sign * unit * self.contact.stick_zones().shear(&point, &self.stick_zone_or_smallest())
    }

    /// Relative slip \[m\] at x \[m\] (Eq. 15), in gross slip that at its onset: 0 in the stick zone and outside the contact.
    /// Errors: `NotAvailable` for an elliptical contact.
    pub fn slip(&self, x: f64) -> Result<f64, Error> {
        let point = self.contact.surface_point(x);
        let zone = self.stick_zone_or_smallest();
        let slip = self.contact.stick_zones().slip(&point, &zone).ok_or(Error::NotAvailable)?;
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
        if self.half_width > 0.0 {
            self.pressure_scale * self.stick_zones().pressure(&self.surface_point(x))
        } else {
            0.0
        }
    }

    fn surface_point(&self, x: f64) -> SurfacePoint {
        SurfacePoint::new(x, self.half_width, self.flat_half_width)
    }
}

#[cfg(test)]
mod tests {
    use crate::constant_load::contact::tests::{FLATS, contact, ellipse, layered};

    #[test]
    fn shear_is_mu_p_under_mu_n_and_zero_without_force() {
        for flat in FLATS {
            let contact = contact(flat);
            let (end, unloaded) =
                (contact.curve_at_force(-contact.slip_force).unwrap(), contact.curve_at_force(0.0).unwrap());
            for ratio in [0.0, 0.3, -0.7, 0.999, 1.0, 1.5] {
                let x = ratio * contact.half_width;
                let limit = 0.4 * contact.pressure(x);
                assert!((end.shear(x) + limit).abs() <= 4e-16 * limit, "{flat} {ratio}");
                assert_eq!((unloaded.shear(x), unloaded.slip(x)), (0.0, Ok(0.0)));
                let slip = end.slip(x).unwrap();
                assert!(slip <= 0.0);
                // mu p |s|, with the rounding errors of two products.
                assert!((end.damage(x).unwrap() + limit * slip).abs() <= 4e-16 * (limit * slip).abs());
            }
        }
    }

    /// Contact and layer carry the same force.
    #[test]
    fn a_layer_changes_no_field_under_a_force() {
        let alone = [contact(0.0), contact(50e-6), contact(5e-3), ellipse(1e-4, 2e-4)];
        for (both, alone) in layered(1.0, 0.3).iter().zip(&alone) {
            for share in [0.1, 0.6, 0.95] {
                let [one, other] =
                    [both, alone].map(|contact| contact.curve_at_force(share * alone.slip_force).unwrap());
                for x in [0.0, 0.5, 0.9, 0.99].map(|share| share * alone.half_width) {
                    assert!((one.shear(x) - other.shear(x)).abs() < 1e-15 * alone.pressure(0.0), "{share} {x}");
                    let [one, other] = [&one, &other].map(|point| point.slip(x).unwrap_or(0.0));
                    assert!((one - other).abs() <= 1e-13 * alone.slip_displacement, "{share} {x}: {one} {other}");
                }
            }
        }
    }
}
