//! Flat with rounded edges, cylinder included: the geometry of Allara (2009) in absolute terms, free of the load.
//!
//! A size s is given by `w = sqrt(s² - a²)`, which is free of cancellation for nearly flat contacts. With g, β and γ of the rounded
//! punch and `K = ln(2L/s) + κ`,
//!
//! ```text
//! N = L E* g/(4R)                               Eq. 1
//! K_t = 2 K/(π E* L)                            Eq. 8, with κ = ν/(1-ν); K_n the same with κ = 0
//! S = g (K + β)/(2πR)                           U the same with κ = 0
//! M = L E* g² (K + γ)/(16πR²)
//! ```
//!
//! For unlike bodies κ is the mean weighted by their compliances. With `MSLIP_RIGID_STRIP` a constant is taken off both κ: the one
//! that three-dimensional contact mechanics gives at the size under the normal force of the parameters.

use crate::error::Error;
use crate::limits::{LARGEST_EXPONENT, exponent_of, in_range};
use crate::numerics::const_math::tabulate;
use crate::numerics::roots::logarithmic_newton;
use crate::parameters::{CENTRE_POINT, Pair, Parameters};
use crate::shape::rounded_punch::{RoundedPunch, TINY};
use crate::shape::tractions::SurfacePoint;
use crate::shape::{Layer, ORDER, Plane, Quantity, Reversed, Series, Shape, identity, tractions};
use core::array::from_fn;
use core::f64::consts::{LN_2, PI};

/// Smallest K for which the laws are inverted: the approach is largest where its K is 0.
const SMALLEST_COMPLIANCE: f64 = 1.0 / 16.0;
/// A flat with rounded edges pressed on a flat.
#[derive(Debug, Clone, Copy, Default)]
pub struct RoundedFlat {
    flat: f64,
    length: f64,
    /// N/g \[N/m²\].
    load_scale: f64,
    /// K_t/K \[m/N\].
    compliance_scale: f64,
    /// κ of U and of S.
    normal_constant: f64,
    tangential_constant: f64,
    /// S along the line from U and N: S_y = `lateral[0]` U + `lateral[1]` N K_t/K.
    lateral: [f64; 2],
    /// The size under the normal force of the parameters: its half-width b, and the punch with lengths over b.
    reference: (f64, RoundedPunch),
}

impl RoundedFlat {
    /// (S - U)/N = K_t - K_n, the same for all sizes \[m/N\].
    pub(crate) fn shift_less_approach(&self) -> f64 {
        self.compliance_scale * (self.tangential_constant - self.normal_constant)
    }

    /// The shape of parameters that were checked, N > 0.
    /// Errors: `OutOfRange` if derived quantities are not representable; `LengthTooShort` if 2L <= b or if the tangential stiffness
    /// at b would not be positive.
    pub fn new(parameters: &Parameters) -> Result<RoundedFlat, Error> {
        // A zero without its sign, which would show in results.
        let flat = parameters.flat_half_width.abs();
        let Parameters { edge_radius, length, normal_force, .. } = *parameters;
        let pair = Pair::new(&parameters.material);
        let modulus = pair.composite_modulus;
        let reference = size_under_load(parameters, modulus)?;
        let slenderness = length / reference.0;
        let [normal, tangential] = match parameters.displacement_reference {
            CENTRE_POINT => [0.0; 2],
            // The kernels of Boussinesq and of Cerruti have the same mean over a rigid patch if ν = 0.
            _ => [1.0, pair.mean(cerruti_factor)].map(|factor| strip_correction(factor / slenderness)),
        };
        let kappa = pair.mean(|nu| nu / (1.0 - nu));
        let end_correction = if parameters.displacement_reference == CENTRE_POINT { 0.0 } else { ACROSS / slenderness };
        let shape = RoundedFlat {
            flat,
            length,
            load_scale: length * modulus / (4.0 * edge_radius),
            compliance_scale: 2.0 / (PI * modulus * length),
            normal_constant: -normal,
            tangential_constant: kappa - tangential,
            lateral: [1.0 + kappa, -kappa * (1.0 - end_correction)],
            reference,
        };
        if slenderness <= 0.5 || shape.reference_compliance() <= 0.0 {
            return Err(Error::LengthTooShort);
        }
        in_range(&[normal_force], &[length, reference.0])?;
        Ok(shape)
    }

    /// Half-width b under the normal force of the parameters \[m\].
    pub(crate) fn half_width(&self) -> f64 {
        self.reference.0
    }

    /// The size under the normal force of the parameters, lengths in units of b.
    pub(crate) fn punch(&self) -> &RoundedPunch {
        &self.reference.1
    }

    /// Λ of Eq. 10: K at b.
    pub(crate) fn reference_compliance(&self) -> f64 {
        (2.0 * (self.length / self.half_width())).ln() + self.tangential_constant
    }

    /// κ of U or of S.
    fn constant(&self, quantity: Quantity) -> f64 {
        if quantity == Quantity::Approach { self.normal_constant } else { self.tangential_constant }
    }

    fn punch_at(&self, w: f64) -> RoundedPunch {
        RoundedPunch::new(self.flat, w)
    }

    /// `ln(2L/s) + constant`.
    fn log_compliance(&self, punch: &RoundedPunch, constant: f64) -> f64 {
        (2.0 * self.length / punch.half_width.max(TINY * self.length).max(TINY)).ln() + constant
    }

    /// `g (K + β)`.
    fn integrated_compliance(&self, punch: &RoundedPunch, constant: f64) -> f64 {
        let load = punch.load();
        load * (self.log_compliance(punch, constant) + punch.beta(load))
    }

    /// The size at which [`RoundedFlat::integrated_compliance`] has a value: in logarithms it has slopes from 1.7 to 3.
    fn size_of(&self, value: f64, constant: f64) -> f64 {
        if value <= 0.0 {
            return 0.0;
        }
        let load = value / self.log_compliance(self.punch(), constant).max(1.0);
        logarithmic_newton(value, RoundedPunch::initial_guess_w(self.flat, load), f64::INFINITY, |w| {
            let punch = self.punch_at(w);
            let compliance = self.log_compliance(&punch, constant);
            if compliance <= 0.0 {
                // Beyond the largest size, half of it. The steps from below do not overshoot, because the logarithm is concave.
                return [2.0 * value, 1.0];
            }
            let found = self.integrated_compliance(&punch, constant);
            [found, 4.0 * w * w * punch.psi * compliance / found]
        })
    }
}

impl Shape for RoundedFlat {
    /// Both directions in the plane of contact, x across the line. Along it, the kernel of Cerruti `(1-ν)/r + ν y²/r³` is `1/r - ν x²/r³`:
    /// with the mean of 1/r over a line of length L, that of Boussinesq, and that of x²/r³, which is 1,
    /// `K_y = (1+κ) K_n - κ` in units of `2/(πE*L)`. `MSLIP_RIGID_STRIP` lowers the second mean by the end correction.
    fn plane(&self) -> Plane<'_> {
        let [per_approach, per_load] = self.lateral;
        // K_y = 1/16 or more, as for the other two.
        let bound = (SMALLEST_COMPLIANCE - per_load) / per_approach - self.normal_constant;
        let (half_width, flat) = (2.0 * self.length * (-bound).exp(), self.flat);
        let (less, more) = (half_width - flat, half_width + flat);
        Plane {
            shape: self,
            layer: &Layer::NONE,
            per_approach: [1.0, per_approach],
            per_load: [self.shift_less_approach(), per_load * self.compliance_scale],
            flat,
            largest: self.largest_size().min(less.signum() * (less.abs() * more).sqrt()),
        }
    }

    fn half_width(&self, w: f64) -> f64 {
        self.punch_at(w).half_width
    }

    fn value(&self, quantity: Quantity, w: f64) -> f64 {
        let punch = self.punch_at(w);
        self.load_scale
            * match quantity {
                Quantity::Load => punch.load(),
                _ => self.compliance_scale * self.integrated_compliance(&punch, self.constant(quantity)),
            }
    }

    fn compliance(&self, quantity: Quantity, w: f64) -> f64 {
        match quantity {
            Quantity::Load => 1.0,
            _ => self.compliance_scale * self.log_compliance(&self.punch_at(w), self.constant(quantity)),
        }
    }

    fn potential(&self, w: f64) -> f64 {
        let punch = self.punch_at(w);
        let load = punch.load();
        let compliance = self.log_compliance(&punch, self.tangential_constant) + punch.gamma(load);
        // The square of a small load would underflow.
        0.5 * (self.load_scale * load) * (self.load_scale * load * self.compliance_scale * compliance)
    }

    fn compliance_under_flat(&self, half_width: f64) -> f64 {
        self.compliance_scale * ((2.0 * self.length / half_width.max(TINY)).ln() + self.normal_constant)
    }

    fn pressure_weight(&self, w: f64) -> f64 {
        self.punch_at(w).psi
    }

    fn size_slope(&self, w: f64) -> f64 {
        0.5 / (self.load_scale * self.punch_at(w).psi).max(TINY)
    }

    fn size_at(&self, quantity: Quantity, value: f64) -> f64 {
        match quantity {
            Quantity::Load => RoundedPunch::from_load(self.flat, value / self.load_scale).w,
            _ => self.size_of(value / (self.load_scale * self.compliance_scale), self.constant(quantity)),
        }
    }

    /// The half-width at which the smaller one of both K is 1/16; both vanish near s = 2L. Negative if that is less than a.
    fn largest_size(&self) -> f64 {
        let constant = self.normal_constant.min(self.tangential_constant).min(0.0);
        let half_width = 2.0 * self.length * (constant - SMALLEST_COMPLIANCE).exp();
        let (less, more) = (half_width - self.flat, half_width + self.flat);
        less.signum() * (less.abs() * more).sqrt()
    }

    /// Eq. 17 between two sizes: `dp = E* ψ w dw/(πR sqrt(s² - x²))`, with lengths in units of the larger half-width.
    fn pressure_between(&self, from: f64, to: f64, x: f64) -> f64 {
        let half_width = Shape::half_width(self, to);
        let unit = half_width.max(TINY);
        let point = SurfacePoint::new(x, half_width, self.flat);
        let squares = ((to - from) / unit) * ((to + from) / unit);
        let integral = tractions::pressure_between(self.flat / unit, from / unit, to / unit, squares, &point);
        4.0 / PI * (self.load_scale / self.length) * unit * integral
    }

    /// From the differential equations, with ' the derivative with respect to ρ and `dN = 4 w ψ dw` times the load scale:
    ///
    /// ```text
    /// K N' = x   or   N' = x, S' = K N';     w ψ w' = N'/4;     s² ψ' = a w';     s² K' = -w w' times the compliance scale
    /// ```
    fn series(&self, w: f64, argument: Quantity) -> [Series; 3] {
        let punch = self.punch_at(w);
        let (flat, constant, by_load) = (self.flat, self.constant(argument), argument == Quantity::Load);
        let [mut compliance, mut size, mut load, mut shift] = [[0.0; ORDER]; 4];
        compliance[0] = self.compliance_scale * self.log_compliance(&punch, constant);
        (size[0], load[0]) = (w, self.load_scale * punch.load());
        shift[0] = self.load_scale * self.compliance_scale * self.integrated_compliance(&punch, constant);
        let [mut size_angle, mut half_width_2] = [[0.0; ORDER]; 2];
        let [mut size_reversed, mut angle, mut load_1, mut size_1, mut angle_1, mut compliance_1] = [Reversed::ZERO; 6];
        let (per_compliance, per_load_scale) = (1.0 / compliance[0], 0.25 / self.load_scale);
        let (per_size_angle, per_half_width_2) = (1.0 / (w * punch.psi), 1.0 / (w * w + flat * flat));
        size_reversed.set(0, w);
        angle.set(0, punch.psi);
        for k in 0..ORDER {
            size_angle[k] = angle.product_term(&size, k);
            half_width_2[k] = size_reversed.product_term(&size, k) + if k == 0 { flat * flat } else { 0.0 };
            let load_growth = if by_load {
                let growth = if k == 0 { load[0] } else { 0.0 };
                load_1.set(k, growth);
                growth
            } else {
                load_1.quotient_term(if k == 0 { shift[0] } else { 0.0 }, &compliance, per_compliance, k)
            };
            let size_growth = size_1.quotient_term(load_growth * per_load_scale, &size_angle, per_size_angle, k);
            let angle_growth = angle_1.quotient_term(flat * size_growth, &half_width_2, per_half_width_2, k);
            let growth = -self.compliance_scale * size_1.product_term(&size, k);
            let compliance_growth = compliance_1.quotient_term(growth, &half_width_2, per_half_width_2, k);
            let per_order = PER_ORDER[k];
            if by_load {
                set(&mut shift, k + 1, per_order * load_1.product_term(&compliance, k));
            }
            set(&mut load, k + 1, per_order * load_growth);
            set(&mut size, k + 1, per_order * size_growth);
            set(&mut compliance, k + 1, per_order * compliance_growth);
            size_reversed.set(k + 1, per_order * size_growth);
            angle.set(k + 1, per_order * angle_growth);
        }
        if !by_load {
            shift = identity(shift[0]);
        }
        let other = |sign: f64| from_fn(|k| shift[k] + sign * self.shift_less_approach() * load[k]);
        if argument == Quantity::Approach { [load, shift, other(1.0)] } else { [load, other(-1.0), shift] }
    }
}

/// 1/(k + 1).
const PER_ORDER: [f64; ORDER] = tabulate!(ORDER, |k| 1.0 / (k + 1) as f64);

/// Sets a coefficient that the next round requires, if there is one.
fn set(series: &mut Series, k: usize, value: f64) {
    if let Some(coefficient) = series.get_mut(k) {
        *coefficient = value;
    }
}

/// Half-width b, and the punch in units of it: Eq. 1 in units that keep both the flat and the load at most 1.
pub(crate) fn size_under_load(parameters: &Parameters, modulus: f64) -> Result<(f64, RoundedPunch), Error> {
    let Parameters { edge_radius, length, normal_force, .. } = *parameters;
    let flat = parameters.flat_half_width.abs();
    in_range(&[length], &[])?;
    in_range(&[length, modulus], &[])?;
    in_range(&[edge_radius], &[length])?;
    in_range(&[normal_force], &[modulus])?;
    in_range(&[edge_radius, normal_force], &[length, modulus])?;
    // The rounded edge of a flat that is too wide for its load carries less than the rounding of the load.
    let too_wide = exponent_of(&[edge_radius, normal_force], &[length, modulus, flat, flat]) < -900;
    if flat > 0.0 && (exponent_of(&[flat], &[]) > LARGEST_EXPONENT || too_wide) {
        return Err(Error::OutOfRange);
    }
    let load = 4.0 * ((edge_radius / length) * (normal_force / modulus));
    let unit = flat.max((load / PI).sqrt());
    let punch = RoundedPunch::from_load(flat / unit, load / unit / unit);
    let size = punch.half_width;
    let scaled = RoundedPunch { flat: punch.flat / size, w: punch.w / size, half_width: 1.0, ..punch };
    Ok((unit * size, scaled))
}

/// `MSLIP_RIGID_STRIP`: mean of a displacement that grows as the square across the strip, over b/L.
const ACROSS: f64 = 8.0 / (PI * PI);

/// dκ/d(ln b) of S: 0 unless κ depends on b/L.
pub(crate) fn reference_slope(parameters: &Parameters, half_width: f64) -> f64 {
    match parameters.displacement_reference {
        CENTRE_POINT => 0.0,
        _ => ACROSS * (Pair::new(&parameters.material).mean(cerruti_factor) / (parameters.length / half_width)),
    }
}

/// Factor of Cerruti's kernel, relative to that of Boussinesq, in the correction across the strip.
fn cerruti_factor(nu: f64) -> f64 {
    (1.0 - 2.0 * nu) / (1.0 - nu)
}

/// Reduction of κ by three-dimensional contact mechanics: the mean instead of the centre of the displacement along and across the
/// strip (1 - ln 2, and `across`, b/L times a function of Poisson's ratio), and the redistribution of traction along it (0.093,
/// fitted to boundary-element results for 16 strips, which scatter from 0.081 to 0.102).
fn strip_correction(across: f64) -> f64 {
    const REDISTRIBUTION: f64 = 0.093;
    (1.0 - LN_2) + REDISTRIBUTION - ACROSS * across
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constant_load::contact::tests::{FLATS, parameters};
    use crate::parameters::RIGID_STRIP;

    /// The kernels of Cerruti in x and y sum to (2-ν)/r: S_x + S_y = (2+κ) U, with no term in N but the rounding of three constants.
    #[test]
    fn the_shifts_in_both_directions_have_the_sum_of_their_kernels() {
        for (flat, displacement_reference) in
            FLATS.into_iter().flat_map(|flat| [(flat, CENTRE_POINT), (flat, RIGID_STRIP)])
        {
            let parameters = Parameters { displacement_reference, ..parameters(flat) };
            let shape = RoundedFlat::new(&parameters).unwrap();
            let Plane { per_approach, per_load, .. } = shape.plane();
            let kappa = Pair::new(&parameters.material).mean(|nu| nu / (1.0 - nu));
            assert!((per_approach[0] + per_approach[1] - (2.0 + kappa)).abs() < 1e-15);
            assert!((per_load[0] + per_load[1]).abs() < 1e-15 * shape.compliance_scale, "{displacement_reference}");
        }
    }
}
