//! Derivatives of the force with respect to the parameters of the contact, at a fixed displacement.
//!
//! With `s = 1 - τ = g_c/g_b`, a displacement u fixes the integral of K over the loads between stick zone and contact, and the force
//! follows from the same loads:
//!
//! ```text
//! 2πR u/μ = ∫ K dg, g from g_c to g_b,     T = μN τ,     g_b = 4RN/(LE*),     K = ln(2L/c) + κ,     dc/da = w/(c ψ) at constant g.
//! ```
//!
//! The differential of both, divided by μN, with K_c = Λ + λ, K_b = Λ and the moments of the curvature h'' from 0 to τ:
//!
//! ```text
//! N dT/dN   = [λ - ρ] / K_c                               ρ = σ β τ: σ = dκ/d(ln b), β = d(ln b)/d(ln g_b)
//! μ dT/dμ   = [∫ t h'' dt] / K_c
//! b dT/da   = [∫ (4 b w/g_b) h'' dt - τ σ w_b/(b ψ_b)] / K_c
//! R dT/dR   = [∫ (1-t) h'' dt - ρ] / K_c
//! L dT/dL   = [τ (Λ - 1 + σ (1 + β)) - s λ] / K_c
//! E* dT/dE* = [τ Λ - s λ + ρ] / K_c
//! ```
//!
//! No term is a difference of larger ones, so small displacements keep their accuracy. σ is 0 for `MSLIP_CENTRE_POINT`. For an ellipse
//! of bodies with given shapes b scales as (NR/E*)^(1/3), and all is elementary in the size c/b.

use crate::constant_load::contact::Contact;
use crate::constant_load::curve::sign_of;
use crate::error::Error;
use crate::limits::check_displacement;
use crate::parameters::{PARAMETERS, Sensitivity, times};

impl Contact {
    /// Derivatives of the force of the monotonic curve at a fixed displacement \[m\]; beyond `slip_displacement` those of mu N. Without
    /// friction or without normal force they are one-sided: those of mu N.
    ///
    /// # Errors
    /// `BadDisplacement` if the displacement is not finite, or beyond 1e150.
    pub fn monotonic_sensitivity(&self, displacement: f64) -> Result<Sensitivity, Error> {
        check_displacement(displacement)?;
        Ok(times(sign_of(displacement), self.sensitivity(displacement.abs())))
    }

    /// Derivatives of mu N.
    pub(crate) fn slip_sensitivity(&self) -> Sensitivity {
        let [by_normal_force, by_friction, ..] = self.sensitivity_scales;
        [by_normal_force, by_friction, 0.0, 0.0, 0.0, 0.0]
    }

    /// The derivatives at a displacement >= 0.
    #[inline(never)]
    pub(crate) fn sensitivity(&self, displacement: f64) -> Sensitivity {
        if displacement > self.slip_displacement {
            return self.slip_sensitivity();
        }
        let shares = if self.is_frictionless() {
            [0.0; PARAMETERS]
        } else if self.is_elliptic() {
            self.elliptic_shares(displacement)
        } else {
            self.rounded_flat_shares(displacement)
        };
        core::array::from_fn(|parameter| shares[parameter] * self.sensitivity_scales[parameter])
    }

    /// The derivatives over the scales, with σ the size of the stick ellipse: `T/(μN) = 1 - σ³`, and `1 - σ²` is the displacement over that
    /// of gross slip.
    fn elliptic_shares(&self, displacement: f64) -> Sensitivity {
        let per_slip = self.per_slip_displacement();
        let size = ((self.slip_displacement - displacement) * per_slip).max(0.0).sqrt();
        let consumed = displacement * per_slip / (1.0 + size);
        let by_modulus = size * consumed * (1.0 + size);
        [consumed, 0.5 * consumed * consumed * (2.0 + size), 0.0, 0.5 * by_modulus, 0.0, by_modulus]
    }

    fn rounded_flat_shares(&self, displacement: f64) -> Sensitivity {
        let zones = self.rounded_flat_zones();
        let full_stick = self.stick_zones().small_load().compliance;
        let (load, increase) = match self.evaluator().load_at(displacement) {
            Some((load, stiffness)) => (load, self.stiffness_scale / stiffness - full_stick),
            None => {
                let zone = self.stick_zone_at_displacement(displacement);
                (zone.load, zone.compliance_increase)
            }
        };
        if load.remaining <= 0.0 && self.flat_half_width <= 0.0 {
            return [1.0, 1.0, 0.0, 0.0, 0.0, 0.0];
        }
        let moments = zones.moments(load, increase);
        let [by_load, by_flat] = zones.size_slopes();
        let (tau, slope) = (load.consumed, self.reference_slope);
        let reference = slope * by_load * tau;
        let stuck = load.remaining * moments.increase;
        let stiffness = 1.0 / (full_stick + moments.increase);
        let shares = [
            moments.increase - reference,
            moments.first,
            moments.by_flat - tau * slope * by_flat,
            moments.complement - reference,
            tau * (full_stick - 1.0 + slope * (1.0 + by_load)) - stuck,
            tau * full_stick - stuck + reference,
        ];
        times(stiffness, shares)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::constant_load::contact::tests::{FLATS, ellipse, parameters};
    use crate::parameters::{CENTRE_POINT, EllipticParameters, Material, Parameters, RIGID_STRIP};
    use std::vec::Vec;

    const BODIES: [Material; 2] =
        [Material { young_modulus: 114e9, poisson_ratio: 0.32 }, Material { young_modulus: 2e11, poisson_ratio: 0.2 }];

    /// Contacts as functions of N, the friction coefficient, a, R, L and the factor of both moduli, with the values of these.
    pub(crate) type Case = (std::boxed::Box<dyn Fn(Sensitivity) -> Contact>, Sensitivity);

    /// Line contacts with both displacement references, among them a short one, and a sphere.
    pub(crate) fn cases() -> Vec<Case> {
        let mut cases = Vec::<Case>::new();
        for flat in FLATS {
            for (displacement_reference, length) in [(CENTRE_POINT, 10e-3), (RIGID_STRIP, 10e-3), (RIGID_STRIP, 8e-3)] {
                let contact = move |[
                    normal_force,
                    friction_coefficient,
                    flat_half_width,
                    edge_radius,
                    length,
                    factor,
                ]: Sensitivity| {
                    let material = BODIES.map(|body| Material { young_modulus: factor * body.young_modulus, ..body });
                    Contact::rounded_flat(&Parameters {
                        flat_half_width,
                        edge_radius,
                        length,
                        normal_force,
                        friction_coefficient,
                        material,
                        displacement_reference,
                        springs: 0,
                    })
                    .unwrap()
                };
                cases.push((std::boxed::Box::new(contact), [150.0, 0.4, flat, 5e-3, length, 1.0]));
            }
        }
        let modulus = ellipse(1e-4, 1e-4).composite_modulus;
        let sphere = move |[normal_force, friction_coefficient, _, radius, _, factor]: Sensitivity| {
            let young_modulus = factor * parameters(0.0).material[0].young_modulus;
            let semi_axis = (0.75 * normal_force * radius / (factor * modulus)).cbrt();
            Contact::elliptic(&EllipticParameters {
                semi_axis_x: semi_axis,
                semi_axis_y: semi_axis,
                normal_force,
                friction_coefficient,
                material: [Material { young_modulus, ..parameters(0.0).material[0] }; 2],
                ..EllipticParameters::default()
            })
            .unwrap()
        };
        cases.push((std::boxed::Box::new(sphere), [150.0, 0.4, 0.0, 5e-3, 10e-3, 1.0]));
        cases
    }

    /// Differences of a function of the contact, one column per parameter, and the scale of each column: mu N over the parameter. The
    /// derivative with respect to the factor is E* times that with respect to E*. Central, with an error of O(h²); one-sided and O(h) for a
    /// cylinder, which has no negative a.
    pub(crate) fn differences(
        (contact, values): &Case,
        function: impl Fn(&Contact) -> Vec<f64>,
    ) -> [(Vec<f64>, f64); PARAMETERS] {
        let base = contact(*values);
        core::array::from_fn(|parameter| {
            let size = if parameter == 2 { values[2].max(base.half_width) } else { values[parameter] };
            let h = 1e-5 * size;
            let at = |step: f64| {
                let mut values = *values;
                values[parameter] += step;
                function(&contact(values))
            };
            let (low, high) = if values[parameter] >= h { (-h, h) } else { (0.0, h) };
            let unit = if parameter == 5 { base.composite_modulus } else { 1.0 };
            let quotient = at(high)
                .into_iter()
                .zip(at(low))
                .map(|(high_value, low_value)| (high_value - low_value) / (high - low) / unit);
            (quotient.collect(), base.slip_force / size / unit)
        })
    }

    #[test]
    fn derivatives_agree_with_differences() {
        for case in cases() {
            let contact = case.0(case.1);
            for part in [1e-9, -1e-3, 0.1, 0.39, -0.41, 0.6, 0.8, 0.9, 0.99, 1.1, -5.0] {
                let displacement = part * contact.slip_displacement;
                let exact = contact.monotonic_sensitivity(displacement).unwrap();
                let found = differences(&case, |contact| {
                    Vec::from([contact.curve_at_displacement(displacement).unwrap().force()])
                });
                let small = f64::abs(part).min(1.0);
                for (parameter, (difference, scale)) in found.iter().enumerate() {
                    let error = (difference[0] - exact[parameter]) / scale / small;
                    // One-sided differences have an error of h/2 = 5e-6 times the second derivative.
                    assert!(
                        error.abs() < 1e-4,
                        "{:?} {part} {parameter}: {error:e} {} {}",
                        case.1,
                        difference[0],
                        exact[parameter]
                    );
                }
            }
        }
    }
}
