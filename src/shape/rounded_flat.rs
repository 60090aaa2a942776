//! Flat with rounded edges, cylinder included: the geometry of Allara (2009) in absolute terms, free of the load.
//!
//! A size s is given by `leg = sqrt(s² - a²)`, which is free of cancellation for nearly flat contacts. With g, β and γ of the
//! rounded punch and `Λ = ln(2L/s) + χ`,
//!
//! ```text
//! N = L E* g/(4R)                               Eq. 1
//! K_t = 2 Λ/(π E* L)                            Eq. 8, with χ = ν/(1-ν); K_n the same with χ = 0
//! S = g (Λ + β)/(2πR)                           U the same with χ = 0
//! M = L E* g² (Λ + γ)/(16πR²)
//! ```
//!
//! For unlike bodies χ is the mean weighted by their compliances. With `MSLIP_RIGID_STRIP` a constant is taken off both χ: the one
//! that three-dimensional contact mechanics gives at the size under the normal force of the parameters.

use crate::error::Error;
use crate::limits::{LARGEST_EXPONENT, exponent_of, in_range};
use crate::parameters::{CENTRE_POINT, Common, Pair, Parameters, RIGID_STRIP, not_negative, positive};
use crate::shape::{Geometry, LayerCompliance, RoundedPunch, Shape};
use core::f64::consts::{LN_2, PI};

impl Geometry for Parameters {
    fn checked(&self) -> Result<Common, Error> {
        let Parameters { normal_force, friction_coefficient, material, layer, .. } = *self;
        not_negative(self.flat_half_width, Error::BadFlatHalfWidth)?;
        positive(self.edge_radius, Error::BadEdgeRadius)?;
        positive(self.length, Error::BadLength)?;
        let common = Common { normal_force, friction_coefficient, material, layer }.checked()?;
        match self.displacement_reference {
            CENTRE_POINT | RIGID_STRIP => Ok(common),
            _ => Err(Error::BadDisplacementReference),
        }
    }

    fn shape(&self) -> Result<Shape, Error> {
        // A zero without its sign, which would show in results.
        let flat = self.flat_half_width.abs();
        let Parameters { edge_radius, length, normal_force, .. } = *self;
        let pair = Pair::new(&self.material);
        let modulus = pair.composite_modulus;
        let reference = size_under_load(self, modulus)?;
        let slenderness = length / reference.0;
        let [normal, tangential] = match self.displacement_reference {
            CENTRE_POINT => [0.0; 2],
            // The kernels of Boussinesq and of Cerruti have the same mean over a rigid patch if ν = 0.
            _ => [1.0, pair.mean(cerruti_factor)].map(|factor| strip_correction(factor / slenderness)),
        };
        let chi = pair.mean(|nu| nu / (1.0 - nu));
        let end_correction = if self.displacement_reference == CENTRE_POINT { 0.0 } else { ACROSS / slenderness };
        let compliance_scale = 2.0 / (PI * modulus * length);
        let constants = [-normal, chi - tangential];
        // Along the line, the kernel of Cerruti has `ν y²` in place of `ν x²`: with the mean of 1/sqrt(x² + y²) over a line of
        // length L, that of Boussinesq, and that of x²/(x² + y²)^(3/2), which is 1, `Λ_y = (1+χ) Λ_n - χ` in units of `2/(πE*L)`.
        // `MSLIP_RIGID_STRIP` lowers the second mean by the end correction.
        let along = -chi * (1.0 - end_correction);
        let load_scale = length * modulus / (4.0 * edge_radius);
        let shape = Shape {
            flat,
            length,
            load_scale,
            compliance_scale,
            constants,
            per_approach: [1.0, 1.0 + chi],
            per_load: [constants[1] - constants[0], along].map(|part| compliance_scale * part),
            pressure_scale: 4.0 / PI * (load_scale / length),
            reference,
            composite_modulus: modulus,
            layer: LayerCompliance::default(),
            ..Shape::default()
        };
        if slenderness <= 0.5 || shape.full_stick() <= 0.0 {
            return Err(Error::LengthTooShort);
        }
        in_range(&[normal_force], &[length, reference.0])?;
        Ok(shape)
    }

    /// The load at b = 2L.
    fn check_element(&self, modulus: f64) -> Result<(), Error> {
        in_range(&[self.length, self.length, self.length, modulus], &[self.edge_radius])
    }
}

impl Shape {
    /// Λ of Eq. 10: that of b.
    pub fn full_stick(&self) -> f64 {
        (2.0 * (self.length / self.reference.0)).ln() + self.constants[1]
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
    let scaled = RoundedPunch { flat: punch.flat / size, leg: punch.leg / size, half_width: 1.0, ..punch };
    Ok((unit * size, scaled))
}

/// `MSLIP_RIGID_STRIP`: mean of a displacement that grows as the square across the strip, over b/L.
const ACROSS: f64 = 8.0 / (PI * PI);

/// dχ/d(ln b) of S: 0 unless χ depends on b/L.
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

/// Reduction of χ by three-dimensional contact mechanics: the mean instead of the centre of the displacement along and across the
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

    /// The kernels of Cerruti in x and y sum to (2-ν)/sqrt(x² + y²): S_x + S_y = (2+χ) U, with no term in N but the rounding of
    /// three constants.
    #[test]
    fn the_shifts_in_both_directions_have_the_sum_of_their_kernels() {
        for (flat, displacement_reference) in
            FLATS.into_iter().flat_map(|flat| [(flat, CENTRE_POINT), (flat, RIGID_STRIP)])
        {
            let parameters = Parameters { displacement_reference, ..parameters(flat) };
            let Shape { per_approach, per_load, compliance_scale, .. } = parameters.shape().unwrap();
            let chi = Pair::new(&parameters.material).mean(|nu| nu / (1.0 - nu));
            assert!((per_approach[0] + per_approach[1] - (2.0 + chi)).abs() < 1e-15);
            assert!((per_load[0] + per_load[1]).abs() < 1e-15 * compliance_scale, "{displacement_reference}");
        }
    }
}
