//! Flat with rounded edges, cylinder included: the geometry of Allara (2009) in absolute terms, free of the load.
//!
//! A size s is given by `leg = sqrt(s² - a²) = s sin ψ`, which is free of cancellation for nearly flat contacts. With
//! `ψ = atan2(leg, a)` and `Λ = ln(2L/s) + χ`,
//!
//! ```text
//! g = 2 s² ψ - 2 a leg,     N = L E* g/(4R)     Eq. 1, corrected
//! K_t = 2 Λ/(π E* L)                            Eq. 8, with χ = ν/(1-ν); K_n follows with χ = 0
//! S = g (Λ + β)/(2πR)                           U follows with χ = 0
//! M = L E* g² (Λ + γ)/(16πR²)
//! ```
//!
//! For unlike bodies χ is the mean of both bodies weighted by their compliances. `MSLIP_RIGID_STRIP` subtracts a constant from the
//! χ of K_t and from the χ of K_n: the correction by three-dimensional contact mechanics at the size under the normal force of the
//! parameters.
//!
//! β and γ are functions of ψ: they increase from ψ²/5 and ψ²/8 for the flat to 1/2 and 1/4 for the cylinder. The closed forms in ψ
//! suffer cancellation for a nearly flat contact (g ~ leg³, βg ~ leg⁵, γg² ~ leg⁸). Up to ψ = π/3, power series in
//! `t = tan²(ψ/2) = (leg/(a+s))² ≤ 1/3` are used instead; they converge for t < 1 and lose at most one bit.

use crate::error::Error;
use crate::limits::{LARGEST_EXPONENT, exponent_of, in_range, quotient_in_range};
use crate::numerics::const_math::tabulate;
use crate::numerics::guard::{TINY, quotient};
use crate::numerics::polynomial::{self, PolynomialRows, rows};
use crate::numerics::slices::PanicFreeSlice;
use crate::parameters::{CENTRE_POINT, Common, Pair, Parameters, RIGID_STRIP, not_negative, positive};
use crate::shape::series::{ORDER, Series, add_quotient_term, identity, product_term};
use crate::shape::size::Size;
pub(super) use crate::shape::tractions::{pressure, slip};
use crate::shape::{Geometry, Quantity, Shape};
use core::array::from_fn;
use core::f64::consts::{LN_2, PI};

/// Terms of the series; the first omitted term is below 3⁻³⁶ of the sum.
const TERMS: usize = 36;

type SeriesTable = PolynomialRows<{ TERMS / 4 }>;

/// `g = 8 leg³/(a+c) Σ l_k t^k`; from `(1+t)² (ψ - sin ψ cos ψ)` with ψ = 2 atan √t.
static LOAD: SeriesTable = rows(&tabulate!(TERMS, |k| {
    let n = 2.0 * k as f64;
    sign(k + 1) / ((n + 3.0) * (n + 1.0) * (n - 1.0))
}));

/// (-1)^k.
const fn sign(k: usize) -> f64 {
    if k.is_multiple_of(2) { 1.0 } else { -1.0 }
}

/// Coefficients of β (`order` 1) or γ (`order` 2) divided by t.
///
/// As functions of ln c both satisfy `df/d ln c = 1 - f d ln g^order / d ln c`. In terms of t this is
/// `t (1 - t²) load f' + order arc f = 2 t load` with `arc = ψ/(2 √t)` and `load = (ψ - sin ψ cos ψ)/(8 t √t)`.
const fn mean_over_ln_c(order: f64) -> SeriesTable {
    let atan = tabulate!(TERMS + 1, |k| sign(k) / (2.0 * k as f64 + 1.0));
    let load = tabulate!(TERMS + 1, |k| {
        let n = k as f64;
        sign(k) * (n + 1.0) * (n + 2.0) / (2.0 * n + 3.0)
    });
    // f_0 = 0; table[k - 1] is f_k.
    let mut table = [0.0; TERMS];
    let mut k = 1;
    while k <= TERMS {
        let mut sum = 2.0 * load[k - 1];
        let mut j = 1;
        while j < k {
            let i = k - j;
            let factor = load[i] - if i >= 2 { load[i - 2] } else { 0.0 };
            sum -= table[j - 1] * (j as f64 * factor + order * atan[i]);
            j += 1;
        }
        table[k - 1] = sum / (k as f64 * load[0] + order);
        k += 1;
    }
    rows(&table)
}

static BETA: SeriesTable = mean_over_ln_c(1.0);
static GAMMA: SeriesTable = mean_over_ln_c(2.0);

fn sum(table: &SeriesTable, t: f64) -> f64 {
    // The terms that are left out are below 2⁻⁵³: (1/16)¹⁶, (1/4)²⁸, (1/3)³⁶.
    let rows = match t {
        ..=0.0625 => 4,
        ..=0.25 => 7,
        _ => TERMS / 4,
    };
    polynomial::value(table.part(..rows), t)
}

/// t = tan²(ψ/2) if the series apply.
fn series_argument(size: &Size) -> Option<f64> {
    let root = quotient(size.leg, size.flat + size.half_width);
    (size.leg * size.leg <= 3.0 * size.flat * size.flat).then_some(root * root)
}

/// `leg - a ψ`. In terms of this difference the closed forms suffer the least cancellation near ψ = π/3.
fn leg_minus_arc(size: &Size) -> f64 {
    size.leg - size.flat * size.psi
}

/// The angle ψ between 0 and π/2; for a cylinder it is π/2 even at leg = 0.
pub fn angle(size: &Size) -> f64 {
    size.leg.max(if size.flat > 0.0 { 0.0 } else { TINY }).atan2(size.flat)
}

pub fn rates(size: &Size) -> [f64; 2] {
    let c2 = (size.half_width * size.half_width).max(TINY);
    let slope_of_psi = size.flat * size.leg / (c2 * size.psi).max(TINY);
    [slope_of_psi, slope_of_psi * (1.0 - 2.0 * (size.leg * size.leg / c2) - slope_of_psi)]
}

pub fn load(size: &Size) -> f64 {
    let Size { flat, leg, half_width, psi, .. } = *size;
    match series_argument(size) {
        Some(t) => 8.0 * leg * leg * quotient(leg, flat + half_width) * sum(&LOAD, t),
        None => 2.0 * (leg * leg * psi - flat * leg_minus_arc(size)),
    }
}

pub fn beta(size: &Size, load: f64) -> f64 {
    let Size { flat, leg, psi, .. } = *size;
    match series_argument(size) {
        Some(t) => t * sum(&BETA, t),
        None => quotient(leg * leg * psi - 3.0 * flat * leg_minus_arc(size), load),
    }
}

pub fn gamma(size: &Size, load: f64) -> f64 {
    let (a, leg) = (size.flat, size.leg);
    match series_argument(size) {
        Some(t) => t * sum(&GAMMA, t),
        None => {
            let c2 = (a * a + leg * leg).max(TINY);
            // cos² ψ, sin² ψ, and s²/g, which is below 1 here.
            let (cos2, sin2, unit) = (a * a / c2, leg * leg / c2, c2 / load.max(c2));
            // cos² ψ ln cos ψ vanishes with cos ψ; the lower bound keeps the logarithm finite.
            let elementary = cos2 * (sin2 * (1.0 + cos2) + 2.0 * cos2 * cos2.max(TINY).ln());
            0.25 - unit * ((2.0 / 3.0) * (a * leg / c2) * sin2 - (4.0 / 3.0) * unit * elementary)
        }
    }
}

/// The size under a load, from an initial guess with an error of at most 3 %. Each iteration raises the error to its fourth power.
pub fn at_load(size: &Size, load: f64) -> Size {
    let mut now = size.resized(estimated_leg(size, load));
    for _ in 0..4 {
        let found = now.load();
        let inverse = now.inverse(found, quotient(now.load_slope(), found), now.rates(), [0.0; 2]);
        let (leg, step) = (now.leg, inverse.step(load));
        now = now.resized(leg + step);
        if step.abs() <= 2e-5 * leg {
            break;
        }
    }
    now
}

/// An estimate of the leg under a load g, with an error of at most 3 %: the cube root of the sum of the cubes of both limits,
/// `sqrt(g/π)` of the cylinder and `(3ag/4)^(1/3)` of the flat.
pub fn estimated_leg(size: &Size, load: f64) -> f64 {
    let load = load.max(0.0);
    let hertz = load / PI;
    (hertz * hertz.sqrt() + 0.75 * size.flat * load).cbrt()
}

/// The series of a flat with rounded edges, from the differential equations, with ' the derivative with respect to ε and
/// `dN = 4 leg ψ d leg` times the load scale:
///
/// ```text
/// Λ N' = x   or   N' = x, S' = Λ N';   leg ψ leg' = N'/4;   s² ψ' = a leg';   s² Λ' = -leg leg' times the compliance scale
/// ```
#[inline(never)]
pub fn series(_: &Size, shape: &Shape, leg: f64, argument: Quantity) -> [Series; 3] {
    let punch = shape.size(leg);
    let (flat, by_load) = (shape.flat, argument == Quantity::Load);
    // The integrated compliance belongs to the argument; to S if the argument is N.
    let coefficients = shape.compliance_coefficients(if by_load { Quantity::Shift } else { argument });
    let [mut compliance, mut size, mut load, mut shift, mut angle] = [[0.0; ORDER]; 5];
    (size[0], load[0], angle[0]) = (leg, shape.load(leg), punch.psi);
    [shift[0], compliance[0]] = shape.own_sums(coefficients, &punch, punch.load());
    let [mut size_angle, mut half_width_2, mut load_1, mut size_1, mut angle_1, mut compliance_1] = [[0.0; ORDER]; 6];
    let (per_compliance, per_load_scale) = (1.0 / compliance[0], 0.25 / shape.load_scale);
    let (per_size_angle, per_half_width_2) = (1.0 / (leg * punch.psi), 1.0 / (leg * leg + flat * flat));
    for k in 0..ORDER {
        size_angle[k] = product_term(&angle, &size, k);
        half_width_2[k] = product_term(&size, &size, k) + if k == 0 { flat * flat } else { 0.0 };
        let first = |value: f64| if k == 0 { value } else { 0.0 };
        let load_growth = if by_load {
            load_1[k] = first(load[0]);
            load_1[k]
        } else {
            add_quotient_term(&mut load_1, first(shift[0]), &compliance, per_compliance, k)
        };
        let size_growth = add_quotient_term(&mut size_1, load_growth * per_load_scale, &size_angle, per_size_angle, k);
        let angle_growth = add_quotient_term(&mut angle_1, flat * size_growth, &half_width_2, per_half_width_2, k);
        let growth = -coefficients[0] * product_term(&size_1, &size, k);
        let compliance_growth = add_quotient_term(&mut compliance_1, growth, &half_width_2, per_half_width_2, k);
        let per_order = PER_ORDER[k];
        if by_load {
            shift.set(k + 1, per_order * product_term(&load_1, &compliance, k));
        }
        load.set(k + 1, per_order * load_growth);
        size.set(k + 1, per_order * size_growth);
        angle.set(k + 1, per_order * angle_growth);
        compliance.set(k + 1, per_order * compliance_growth);
    }
    if !by_load {
        shift = identity(shift[0]);
    }
    let [_, per_load] = shape.compliance_in_terms_of(1, 0);
    let other = |sign: f64| from_fn(|k| shift[k] + sign * per_load * load[k]);
    if argument == Quantity::Approach { [load, shift, other(1.0)] } else { [load, other(-1.0), shift] }
}

/// 1/(k + 1).
const PER_ORDER: [f64; ORDER] = tabulate!(ORDER, |k| 1.0 / (k + 1) as f64);

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
        let (reference_half_width, reference_size) = size_under_load(self, modulus)?;
        let slenderness = length / reference_half_width;
        let [normal, tangential] = match self.displacement_reference {
            CENTRE_POINT => [0.0; 2],
            // The kernels of Boussinesq and of Cerruti have the same mean over a rigid patch if ν = 0.
            _ => [1.0, pair.mean(cerruti_factor)].map(|factor| strip_correction(factor / slenderness)),
        };
        let chi = pair.mean(|nu| nu / (1.0 - nu));
        let end_correction = if self.displacement_reference == CENTRE_POINT { 0.0 } else { ACROSS / slenderness };
        let scale = 2.0 / (PI * modulus * length);
        // Along the line, the kernel of Cerruti has `ν y²` in place of `ν x²`: with the mean of 1/sqrt(x² + y²) over a line of
        // length L, that of Boussinesq, and that of x²/(x² + y²)^(3/2), which is 1, `Λ_y = (1+χ) Λ_n - χ` in units of `2/(πE*L)`.
        // `MSLIP_RIGID_STRIP` lowers the second mean by the end correction.
        let lateral = 1.0 + chi;
        let along = -normal - chi * (1.0 - end_correction) / lateral;
        let load_scale = length * modulus / (4.0 * edge_radius);
        let shape = Shape {
            flat,
            unit: 1.0,
            length: 2.0 * length,
            load_scale,
            compliances: [[scale, -normal], [scale, chi - tangential], [lateral * scale, along]],
            pressure_scale: 4.0 / PI * (load_scale / length),
            reference_half_width,
            reference_size,
            composite_modulus: modulus,
            ..Shape::default()
        };
        if slenderness <= 0.5 || shape.full_stick() <= 0.0 {
            return Err(Error::LengthTooShort);
        }
        quotient_in_range(&[normal_force], &[length, reference_half_width])?;
        Ok(shape)
    }

    /// The size at which the smallest Λ is 1/16; all vanish near s = 2L.
    fn largest_size(&self, shape: &Shape, directions: usize) -> Result<f64, Error> {
        // The load at b = 2L.
        quotient_in_range(&[self.length, self.length, self.length, shape.composite_modulus], &[self.edge_radius])?;
        let [[normal, _], ..] = shape.compliances;
        let exponent = |[scale, offset]: &[f64; 2]| offset - SMALLEST_COMPLIANCE * (normal / scale);
        let bound = shape.compliances.iter().take(directions + 1).map(exponent).fold(-SMALLEST_COMPLIANCE, f64::min);
        let half_width = shape.length * bound.exp();
        let (less, more) = (half_width - shape.flat, half_width + shape.flat);
        Ok(less.signum() * (less.abs() * more).sqrt())
    }
}

/// Smallest Λ for which the laws are inverted: the approach is largest at Λ = 0.
const SMALLEST_COMPLIANCE: f64 = 1.0 / 16.0;

/// Half-width b of the contact, and its size in units of b: Eq. 1, solved in a unit in which the flat and the root of the load are
/// at most 1.
pub(crate) fn size_under_load(parameters: &Parameters, modulus: f64) -> Result<(f64, Size), Error> {
    let Parameters { edge_radius, length, normal_force, .. } = *parameters;
    let flat = parameters.flat_half_width.abs();
    in_range(&[length])?;
    in_range(&[length, modulus])?;
    quotient_in_range(&[edge_radius], &[length])?;
    quotient_in_range(&[normal_force], &[modulus])?;
    quotient_in_range(&[edge_radius, normal_force], &[length, modulus])?;
    // The rounded edge of a flat that is too wide for its load carries less than the rounding of the load.
    let too_wide = exponent_of(&[edge_radius, normal_force], &[length, modulus, flat, flat]) < -900;
    if flat > 0.0 && (exponent_of(&[flat], &[]) > LARGEST_EXPONENT || too_wide) {
        return Err(Error::OutOfRange);
    }
    let load = 4.0 * ((edge_radius / length) * (normal_force / modulus));
    let unit = flat.max((load / PI).sqrt());
    let size = Size { flat: flat / unit, ..Size::default() }.at_load(load / unit / unit);
    let half_width = size.half_width;
    let scaled = Size { flat: size.flat / half_width, leg: size.leg / half_width, half_width: 1.0, ..size };
    Ok((unit * half_width, scaled))
}

/// `MSLIP_RIGID_STRIP`: mean of a displacement that grows as the square across the strip, over b/L.
const ACROSS: f64 = 8.0 / (PI * PI);

/// The derivative dχ/d(ln b) of the constant of the tangential compliance: 0 unless χ depends on b/L.
pub(crate) fn reference_slope(parameters: &Parameters, half_width: f64) -> f64 {
    match parameters.displacement_reference {
        CENTRE_POINT => 0.0,
        _ => ACROSS * Pair::new(&parameters.material).mean(cerruti_factor) * (half_width / parameters.length),
    }
}

/// Factor of Cerruti's kernel, relative to that of Boussinesq, in the correction across the strip.
fn cerruti_factor(nu: f64) -> f64 {
    (1.0 - 2.0 * nu) / (1.0 - nu)
}

/// Reduction of χ by three-dimensional contact mechanics. Two terms replace the displacement of the centre by the mean: 1 - ln 2
/// along the strip, and a multiple of `across`, which is b/L times a function of Poisson's ratio. The third is the redistribution
/// of traction along the strip, 0.093: fitted to boundary-element results for 16 strips, which scatter from 0.081 to 0.102.
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
            let shape = parameters.shape().unwrap();
            let [[x, x_constant], [y, y_constant]] = [1, 2].map(|k| shape.compliance_in_terms_of(k, 0));
            let chi = Pair::new(&parameters.material).mean(|nu| nu / (1.0 - nu));
            assert!((x + y - (2.0 + chi)).abs() < 1e-15);
            assert!((x_constant + y_constant).abs() < 1e-15 * shape.compliances[0][0], "{displacement_reference}");
        }
    }
}
