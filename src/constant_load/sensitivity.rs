//! Derivatives of the force with respect to the parameters of the contact, at a fixed displacement.
//!
//! With `1 - τ = g_c/g_b`, a displacement u fixes the integral of Λ over the loads between stick zone and contact, and the force
//! follows from the same loads:
//!
//! ```text
//! 2πR u/μ = ∫ Λ(c) dg, g from g_c to g_b,   T = μN τ,   g_b = 4RN/(LE*),   Λ(c) = ln(2L/c) + χ,   dc/da = sin ψ/ψ at constant g.
//! ```
//!
//! The differential of both, divided by μN, with Λ_c = Λ + λ, `χ' = dχ/d(ln b)`, `b' = d(ln b)/d(ln g_b)` and the moments of the
//! curvature h'' from 0 to τ, is
//!
//! ```text
//! N dT/dN   = [λ - b' τ χ'] / Λ_c
//! μ dT/dμ   = [∫ t h'' dt] / Λ_c
//! b dT/da   = [∫ (4 b c sin ψ/g_b) h'' dt - τ χ' sin ψ_b/ψ_b] / Λ_c
//! R dT/dR   = [∫ (1-t) h'' dt - b' τ χ'] / Λ_c
//! L dT/dL   = [τ (Λ - 1 + χ' (1 + b')) - (1-τ) λ] / Λ_c
//! E* dT/dE* = [τ Λ - (1-τ) λ + b' τ χ'] / Λ_c
//! ```
//!
//! No term is a difference of larger ones, so small displacements keep their accuracy. χ' is 0 for `MSLIP_CENTRE_POINT`. For an
//! ellipse of bodies with given shapes b scales as (NR/E*)^(1/3); N, μ, R and E* then have the same derivatives, with the moments
//! of the ellipse.

use crate::constant_load::contact::Contact;
use crate::constant_load::evaluator::sign_of;
use crate::error::Error;
use crate::limits::check_displacement;
use crate::parameters::{PARAMETERS, Sensitivity, times};

impl Contact {
    /// Derivatives of the force of the monotonic curve at a fixed displacement \[m\]; beyond `slip_displacement` those of mu N.
    /// Without friction or without normal force they are one-sided and equal to those of mu N.
    /// Errors: `BadDisplacement` if the displacement is not finite, or beyond 1e150.
    pub fn monotonic_sensitivity(&self, displacement: f64) -> Result<Sensitivity, Error> {
        check_displacement(displacement)?;
        Ok(times(sign_of(displacement), self.sensitivity(displacement.abs())))
    }

    /// Derivatives of mu N.
    pub(crate) fn slip_sensitivity(&self) -> Sensitivity {
        let [by_normal_force, by_friction, ..] = self.sensitivity_scales;
        [by_normal_force, by_friction, 0.0, 0.0, 0.0, 0.0, 0.0]
    }

    /// The derivatives of the force at a displacement >= 0.
    #[inline(never)]
    pub(crate) fn sensitivity(&self, displacement: f64) -> Sensitivity {
        if displacement > self.slip_displacement {
            return self.slip_sensitivity();
        }
        let shares = if self.is_frictionless() { [0.0; PARAMETERS] } else { self.shares(displacement) };
        core::array::from_fn(|parameter| shares[parameter] * self.sensitivity_scales[parameter])
    }

    /// The derivatives over the scales. A layer adds its compliance to the denominator of the derivatives of the contact at the
    /// same force, and its displacement adds terms of its own.
    fn shares(&self, displacement: f64) -> Sensitivity {
        let (zones, layer) = (&self.zones, &self.zones.layer);
        let (load, increase) = self.load_at(self.before_slip(displacement));
        let moments = zones.moments(load, increase);
        let (tau, full_stick) = (load.consumed, zones.small_load_without_layer.compliance);
        let [by_load, by_flat] = zones.size_slopes();
        let slope = self.reference_slope;
        let reference = slope * by_load * tau;
        let stuck = load.remaining * moments.increase;
        let of_contact = full_stick + moments.increase;
        let mut shares = if load.remaining <= 0.0 && self.flat_half_width <= 0.0 {
            [1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]
        } else {
            let shares = [
                moments.increase - reference,
                moments.first,
                moments.by_flat - tau * slope * by_flat,
                moments.complement - reference,
                tau * (full_stick - 1.0 + slope * (1.0 + by_load)) - stuck,
                tau * full_stick - stuck + reference,
                0.0,
            ];
            times(1.0 / of_contact, shares)
        };
        if zones.has_layer() {
            shares = times(1.0 / (1.0 + layer.compliance(load.remaining) / of_contact), shares);
            let [by_normal_force, by_friction] = layer.slopes_by_load_and_friction(load, of_contact);
            shares[0] += by_normal_force;
            shares[1] += by_friction;
        }
        shares[PARAMETERS - 1] = layer.slope_by_compliance(load, of_contact);
        shares
    }
}

#[cfg(test)]
pub(crate) mod tests;
