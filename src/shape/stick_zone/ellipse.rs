//! Stick zones of the elliptical Hertz contact: nondimensionally the same for all elliptical contacts.
//!
//! The size parameter σ is the semi-axis of the stick ellipse over that of the contact. Loads scale as σ³, shifts as σ², so that, in
//! units of C_t μ N,
//!
//! ```text
//! x = (3/2) [1 - (1-τ)^(2/3)],      dx/dτ = (1-τ)^(-1/3) = 1/σ.
//! ```

use crate::shape::rounded_punch::TINY;
use crate::shape::stick_zone::small_load::{SmallLoadSeries, TERMS, economized};
use crate::shape::stick_zone::{Complement, LoadPoint, StickZone, StickZones, SurfacePoint};
use core::f64::consts::PI;

/// The stick zones of every elliptical contact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EllipseZones;

/// h'' = (1/3) (1-τ)^(-4/3).
const CURVATURE: [f64; TERMS] = {
    let mut table = [1.0 / 3.0; TERMS];
    let mut n = 1;
    while n < TERMS {
        table[n] = table[n - 1] * (n as f64 + 1.0 / 3.0) / n as f64;
        n += 1;
    }
    table
};

static SMALL_LOAD: SmallLoadSeries = SmallLoadSeries::new(1.0, economized(CURVATURE));

const SLIP_SHIFT: f64 = 1.5;

impl EllipseZones {
    /// The point of the curve at a remaining shift.
    pub(crate) fn at(remaining: f64) -> LoadPoint {
        let size = (remaining / SLIP_SHIFT).max(0.0).sqrt();
        let per_size = 1.0 / size.max(TINY);
        LoadPoint {
            remaining: size * size * size,
            compliance_increase: per_size - 1.0,
            curvature: 1.0 / 3.0 * (per_size * per_size) * (per_size * per_size),
        }
    }
}

impl StickZones for EllipseZones {
    fn small_load(&self) -> &SmallLoadSeries {
        &SMALL_LOAD
    }

    fn slip_shift(&self) -> f64 {
        SLIP_SHIFT
    }

    fn at_load_remaining(&self, remaining: f64) -> StickZone {
        let size = remaining.cbrt();
        zone(size, remaining, SLIP_SHIFT * size * size)
    }

    fn at_shift_remaining(&self, remaining: f64) -> StickZone {
        let size = (remaining / SLIP_SHIFT).max(0.0).sqrt();
        zone(size, size * size * size, remaining)
    }

    /// `(4/3) ∫ (1-u) (u-s) u^(-4/3) du` from s to 1; with σ the derivative is `4 (τ λ - h) = 2 (1-σ)² (2+σ)/σ`.
    fn dissipation_beyond_half(&self, s: f64, _: f64) -> (f64, f64) {
        let zone = self.at_load_remaining(s);
        let (size, consumed) = (self.size(&zone), consumed_size(&zone));
        let square = size * size;
        let energy = (4.0 / 3.0) * (1.5 * (1.0 + s) * (1.0 - square) - 0.6 * (1.0 - s * square) + 3.0 * (s - square));
        (energy, 2.0 * consumed * consumed * (2.0 + size) / size.max(TINY))
    }

    fn size(&self, zone: &StickZone) -> f64 {
        zone.size_parameter.unwrap_or_else(|| 1.0 / (1.0 + zone.compliance_increase))
    }

    fn pressure(&self, point: &SurfacePoint) -> f64 {
        SLIP_SHIFT / PI * (point.from_edge * (1.0 + point.x)).max(0.0).sqrt()
    }

    fn shear(&self, point: &SurfacePoint, zone: &StickZone) -> f64 {
        let (size, x) = (self.size(zone), point.x);
        let outer = (point.from_edge * (1.0 + x)).max(0.0).sqrt();
        let inner = ((size - x) * (size + x)).max(0.0).sqrt();
        // The difference of the two square roots, if both are real, from the difference of their squares.
        let difference =
            if inner > 0.0 { consumed_size(zone) * (1.0 + size) / (outer + inner).max(TINY) } else { outer };
        SLIP_SHIFT / PI * difference
    }

    fn slip(&self, _point: &SurfacePoint, _zone: &StickZone) -> Option<f64> {
        None
    }
}

/// The stick zone of a size, with its load and the remaining shift.
fn zone(size: f64, load: f64, shift: f64) -> StickZone {
    StickZone {
        load: Complement { consumed: 1.0 - load, remaining: load },
        shift: Complement { consumed: SLIP_SHIFT - shift, remaining: shift },
        compliance_increase: if size > 0.0 { 1.0 / size.max(TINY) - 1.0 } else { f64::INFINITY },
        size_parameter: Some(size),
    }
}

/// 1 - σ from the load, `τ = 1 - σ³`.
pub(crate) fn consumed_at(load: Complement) -> f64 {
    let size = load.remaining.cbrt();
    load.consumed / (1.0 + size * (1.0 + size))
}

/// 1 - σ from λ = 1/σ - 1.
fn consumed_size(zone: &StickZone) -> f64 {
    if zone.compliance_increase < 1e300 { zone.compliance_increase / (1.0 + zone.compliance_increase) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use crate::constant_load::contact::Contact;
    use crate::parameters::{EllipticParameters, Material};

    fn equal_bodies(young_modulus: f64, poisson_ratio: f64) -> [Material; 2] {
        [Material { young_modulus, poisson_ratio }; 2]
    }

    /// The example `cattaneo` of the program CONTACT; millimetres and newtons, results printed with five digits. The friction work is
    /// that of the initial loading, a quarter of that of a cycle.
    #[test]
    fn cattaneo_problem_has_the_published_shift_and_friction_work() {
        let (normal_force, radius, friction, ratio) = (9.1954, 50.0, 0.4, 0.42);
        let material = equal_bodies(200.0 * 2.0 * (1.0 + ratio), ratio);
        let modulus = 200.0 * (1.0 + ratio) / (1.0 - ratio * ratio);
        let size: f64 = (0.75 * normal_force * radius / modulus).cbrt();
        let contact = Contact::elliptic(&EllipticParameters {
            semi_axis_x: size,
            semi_axis_y: size,
            normal_force,
            friction_coefficient: friction,
            material,
            ..EllipticParameters::default()
        })
        .unwrap();
        let force = 7.0 / 8.0 * friction * normal_force;
        let point = contact.curve_at_force(force).unwrap();
        let work = 0.25 * contact.dissipated_energy(force).unwrap();
        assert!((point.displacement() - 8.1724e-3).abs() < 0.5e-7, "{}", point.displacement());
        assert!((work - 2.7554e-3).abs() < 0.5e-7, "{work}");
        // The stick ellipse has half the size of the contact: (1 - 7/8)^(1/3).
        assert!((point.stick_half_width() / size - 0.5).abs() < 4e-16);
    }
}
