//! A compliant layer in series with a contact: roughness, a coating, the body around the contact, the rig.
//!
//! Contact and layer carry the same forces N and T, and have one friction coefficient. Then both have the same memory diagram over
//! the load, so that their displacements add up: the pair is the contact with the sums of U, S and M
//! ([derivation](../../../docs/derivation.md)). Under its reference load N_r the layer has the compliances c_n and c_t, and its
//! stiffness grows in proportion to N + N_c:
//!
//! ```text
//! U2 = c_n (N_r + N_c) ln(1 + N/N_c),   S2 = (c_t/c_n) U2,   M2 = ∫ N dS2 = c_t (N_r + N_c) [N - N_c ln(1 + N/N_c)]
//! ```
//!
//! For an infinite N_c these are U2 = c_n N and M2 = c_t N²/2. A shape adds them to its sums at a size, a stick zone to the
//! differences between two sizes.

use crate::error::{Error, ensure};
use crate::limits::in_range;
use crate::numerics::chebyshev::RECIPROCALS;
use crate::numerics::guard::{TINY, quotient};
use crate::parameters;
use crate::shape::series::{ORDER, Series};
use crate::shape::{Complement, Quantity};

/// The layer of a contact, in absolute terms.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct LayerCompliance {
    /// Normal and tangential compliance without load \[m/N\]: the compliances of the parameters times 1 + N_r/N_c.
    pub normal: f64,
    pub tangential: f64,
    /// 1/N_c \[1/N\]; 0 for a constant stiffness.
    stiffening: f64,
}

/// 2^40: a layer that is this many times as compliant as the contact hides it.
const MOST_COMPLIANT: f64 = (1u64 << 40) as f64;

impl LayerCompliance {
    /// The layer, and the ratio of its compliance under N to its compliance under the reference load; for checked parameters and N
    /// > 0.
    /// Errors: `BadReferenceLoad` if the compliance under N is more than 2^40 times that of the parameters; `BadNormalCompliance`,
    /// `BadTangentialCompliance` if it, or the displacement, is not representable.
    pub fn new(parameters: &parameters::Layer, normal_force: f64) -> Result<(LayerCompliance, f64), Error> {
        let parameters::Layer { normal_compliance, tangential_compliance, stiffening_load, reference_load } =
            *parameters;
        let reference = if reference_load > 0.0 { reference_load } else { normal_force };
        // Beyond 2^200 N the layer is linear to rounding.
        let is_linear = stiffening_load == 0.0 || stiffening_load > 2f64.powi(200) * normal_force.max(reference);
        let stiffening = if is_linear { 0.0 } else { 1.0 / stiffening_load };
        let unloaded = 1.0 + stiffening * reference;
        let compliance_under_load = unloaded / (1.0 + stiffening * normal_force);
        if compliance_under_load > MOST_COMPLIANT {
            return Err(Error::BadReferenceLoad);
        }
        for (compliance, error) in
            [(normal_compliance, Error::BadNormalCompliance), (tangential_compliance, Error::BadTangentialCompliance)]
        {
            if compliance > 0.0 {
                in_range(&[compliance, compliance_under_load]).map_err(|_| error)?;
                in_range(&[compliance, compliance_under_load, normal_force]).map_err(|_| error)?;
            }
        }
        let layer = LayerCompliance {
            normal: normal_compliance * unloaded,
            tangential: tangential_compliance * unloaded,
            stiffening,
        };
        Ok((layer, compliance_under_load))
    }

    pub fn is_none(&self) -> bool {
        self.normal == 0.0 && self.tangential == 0.0
    }

    /// Checks that the layer does not hide the contact, given the normal and tangential compliance of both together under a load.
    /// Errors: `BadNormalCompliance`, `BadTangentialCompliance`.
    pub fn check_share(&self, load: f64, [normal, tangential]: [f64; 2]) -> Result<(), Error> {
        let hides = |layer: f64, both: f64| layer * self.softness(load) > (1.0 - 1.0 / MOST_COMPLIANT) * both;
        ensure(!hides(self.normal, normal), Error::BadNormalCompliance)?;
        ensure(!hides(self.tangential, tangential), Error::BadTangentialCompliance)
    }

    /// The compliance without load that enters U or S; 0 for N.
    pub fn unloaded(&self, quantity: Quantity) -> f64 {
        [0.0, self.normal, self.tangential][quantity as usize]
    }

    /// `ln(1 + N/N_c) N_c`: U2 and S2 over their compliance without load \[N\].
    pub fn extent(&self, load: f64) -> f64 {
        let x = self.stiffening * load;
        // The next term of the series is x²/3.
        if x < 1e-8 { load * (1.0 - 0.5 * x) } else { quotient(x.ln_1p(), self.stiffening) }
    }

    /// The load at which [`LayerCompliance::extent`] has a given value; the exponential is bounded at the magnitude of the largest
    /// loads.
    pub fn load_of_extent(&self, extent: f64) -> f64 {
        let x = self.stiffening * extent;
        if x < 1e-8 { extent * (1.0 + 0.5 * x) } else { x.min(345.0).exp_m1() / self.stiffening.max(TINY) }
    }

    /// The compliance dU2/dN or dS2/dN under a load over the compliance without load.
    pub fn softness(&self, load: f64) -> f64 {
        1.0 / (1.0 + self.stiffening * load)
    }

    /// S2 \[m\].
    pub fn shift(&self, load: f64) -> f64 {
        if self.tangential > 0.0 { self.tangential * self.extent(load) } else { 0.0 }
    }

    /// dS2/dN \[m/N\].
    pub fn compliance(&self, load: f64) -> f64 {
        self.tangential * self.softness(load)
    }

    /// 1/(N + N_c): the derivative of the stiffness with respect to the load, over the stiffness.
    pub fn hardening(&self, load: f64) -> f64 {
        self.stiffening * self.softness(load)
    }

    /// Whether the stiffness is constant.
    pub fn is_linear(&self) -> bool {
        self.stiffening == 0.0
    }

    /// M2 \[J\].
    pub fn potential(&self, load: f64) -> f64 {
        // (N S2) without overflow of N².
        load * (self.tangential * load) * logarithm_remainder(self.stiffening * load)
    }

    /// Taylor coefficients of the extent at the load N (1 + ε): of `N_c ln(1 + ωε)`, with `ω = N/(N + N_c)`.
    pub fn series(&self, load: f64) -> Series {
        let mut series = [0.0; ORDER];
        let ratio = self.stiffening * load * self.softness(load);
        let mut power = load * self.softness(load);
        series[0] = self.extent(load);
        for (term, reciprocal) in series.iter_mut().skip(1).zip(&RECIPROCALS) {
            *term = power * reciprocal;
            power *= -ratio;
        }
        series
    }
}

/// The layer in the monotonic curve, with the constant normal force as the unit of loads. Under a tangential force τ it has the
/// shift that it would have alone under the load `z = τ/(1 + (1-τ) N/N_c)`:
///
/// ```text
/// x2 = S2(1) - S2(1-τ) = S2(z),      x_s - x2 = S2(1-τ),      λ2 = c_t ω z,      ∫ t dλ2 = (N/N_c) M2(z)
/// ```
///
/// These forms are free of cancellation. The unit of c_t, the compliance without load, is the compliance for which Λ + λ is 1.
impl LayerCompliance {
    /// The layer and the ratio of [`LayerCompliance::new`] in the units of stick zones, given the stiffness for a compliance of 1
    /// and the compliance of the contact in these units.
    /// Errors: those of [`LayerCompliance::new`]; `BadTangentialCompliance` if the layer hides the contact, or if its compliance in
    /// these units is not representable.
    pub fn relative(
        parameters: &parameters::Layer,
        normal_force: f64,
        stiffness_scale: f64,
        of_contact: f64,
    ) -> Result<(LayerCompliance, f64), Error> {
        let (LayerCompliance { tangential, stiffening, .. }, compliance_under_load) =
            LayerCompliance::new(parameters, normal_force)?;
        if tangential > 0.0 {
            in_range(&[tangential, stiffness_scale]).map_err(|_| Error::BadTangentialCompliance)?;
        }
        let (tangential, stiffening) = (tangential * stiffness_scale, stiffening * normal_force);
        let relative = LayerCompliance { normal: 0.0, tangential, stiffening };
        if relative.compliance(1.0) > MOST_COMPLIANT * of_contact {
            return Err(Error::BadTangentialCompliance);
        }
        Ok((relative, compliance_under_load))
    }

    /// The load z under which the layer alone has the consumed shift.
    pub fn consumed(&self, load: Complement) -> f64 {
        load.consumed * self.softness(load.remaining)
    }

    /// The compliance increase λ2.
    pub fn increase(&self, load: Complement) -> f64 {
        self.compliance(1.0) * (self.stiffening * self.consumed(load))
    }

    /// dλ2/dτ and its derivative.
    pub fn curvature(&self, load: Complement) -> [f64; 2] {
        let rate = self.stiffening * self.softness(load.remaining);
        let value = rate * self.compliance(load.remaining);
        [value, 2.0 * rate * value]
    }

    /// Whether the curve has a knee, a strong bend near gross slip: if N_c is less than a quarter of N. As a function of a complex
    /// displacement the curve is then singular near gross slip.
    pub fn has_knee(&self) -> bool {
        self.tangential > 0.0 && self.stiffening > 4.0
    }

    /// `4 ∫ t (τ-t) dλ2`.
    pub fn dissipation(&self, load: Complement) -> f64 {
        let y = self.stiffening * self.softness(1.0) * load.consumed;
        // [(2-y) ln(1/(1-y)) - 2y]/y³, with ln(1/(1-y)) = ln(1 + z N/N_c) = 2 artanh(y/(2-y)).
        let factor = if y > 0.6 {
            ((2.0 - y) * (self.stiffening * self.consumed(load)).ln_1p() - 2.0 * y) / (y * y * y)
        } else {
            2.0 * artanh_remainder(y / (2.0 - y)) / ((2.0 - y) * (2.0 - y))
        };
        4.0 * self.compliance(1.0) * y * (load.consumed * load.consumed) * factor
    }

    /// `∫ t dλ2`.
    pub fn first_moment(&self, load: Complement) -> f64 {
        self.stiffening * self.potential(self.consumed(load))
    }

    /// The derivative of the force over μN with respect to the compliance of the layer under N, at a fixed displacement, given the
    /// compliance of the contact at this force.
    pub fn slope_by_compliance(&self, load: Complement, of_contact: f64) -> f64 {
        -self.extent(self.consumed(load)) * (1.0 + self.stiffening) / (of_contact + self.compliance(load.remaining))
    }

    /// The parts of the layer in the derivatives with respect to N and to μ. The layer stays the same under another N.
    pub fn slopes_by_load_and_friction(&self, load: Complement, of_contact: f64) -> [f64; 2] {
        [self.increase(load), self.first_moment(load)].map(|part| part / (of_contact + self.compliance(load.remaining)))
    }
}

/// `(x - ln(1+x))/x²` for x >= 0, free of cancellation: 1/2 at 0.
pub(crate) fn logarithm_remainder(x: f64) -> f64 {
    if x > 1.0 {
        return (x - x.ln_1p()) / x / x;
    }
    // With z = x/(2+x) the logarithm is 2 artanh z, and x - 2z = xz.
    let z = x / (2.0 + x);
    (1.0 - 2.0 * z * artanh_remainder(z) / (2.0 + x)) / (2.0 + x)
}

/// `(artanh z - z)/z³` for z from 0 to 1/2.
pub(crate) fn artanh_remainder(z: f64) -> f64 {
    // The first term that is left out is below 2⁻⁵⁴ of the sum.
    const TERMS: u32 = 26;
    (0..TERMS).rev().fold(0.0, |sum, k| sum * (z * z) + 1.0 / f64::from(2 * k + 3))
}

#[cfg(test)]
mod tests;
