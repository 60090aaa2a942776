//! Complex stiffness `K = K' + iK''` of a cycle of prescribed displacement amplitude (section 3.4), and its derivatives.
//!
//! With T the monotonic curve and δ_0 the amplitude, K is the ratio of force to displacement in rotating-vector form:
//!
//! ```text
//! K'  = (8/π) ∫ sqrt(t (1-t)) T'(δ_0 t) dt,     0 <= t <= 1, up to gross slip,          K'' = W/(π δ_0²)
//! ```
//!
//! with W the dissipated energy. K' has no closed form. Up to 2/5 of the displacement of gross slip, or 11/20, T(δ) is one
//! polynomial, and so is K': the integrals of the powers are known. Beyond, with displacement x and amplitude x_0 over that of
//! gross slip, `ρ = 1 - x` and `ρ_0 = 1 - x_0`,
//!
//! ```text
//! K' = (8/π) F/x_0²,     F = ∫ sqrt(x (ρ-ρ_0)) k dρ,     dF/dx_0 = ½ ∫ sqrt(x/(ρ-ρ_0)) k dρ     from max(ρ_0, 0) to 1.
//! ```
//!
//! The integrand has three singularities. The tangent stiffness k has one at ρ = 0: a power of `y = ρ^(1/3)`, the size of a stick
//! zone under a flat, or a logarithm. The roots have one at ρ = ρ_0, on either side of 0, and one at x = 0. Two substitutions
//! remove them:
//!
//! - `y = y_0 + scale sinh²(z/2)`, with the distance between the first two as the scale, moves both to |Im z| >= π/4 and makes the
//!   root at y_0 smooth. Two doublings of the angle give `sinh²(z/2)` as a polynomial of `sinh²(z/8)`.
//! - `sinh(z/8) = (1 - t²) sinh(z_end/8)` makes the root at x = 0 smooth, and the integrand even in t.
//!
//! For Λ near 0, k is nearly singular at x = 0 as well; then t is a hyperbolic sine. Gauss's rule for even functions converges for
//! all amplitudes.

use crate::constant_load::contact::{BLOCKS_IN_SLIP, Contact};
use crate::error::{Error, ensure};
use crate::limits::MAX_DISPLACEMENT;
use crate::numerics::fp_class::in_0_to;
use crate::numerics::lanes::Lanes;
use crate::numerics::polynomial::PolynomialRows;
use crate::numerics::quadrature::gauss_even;
use core::f64::consts::PI;

/// Complex stiffness at one displacement amplitude.
#[derive(Debug, Clone, Copy)]
pub struct ComplexStiffness {
    /// K' \[N/m\].
    pub real: f64,
    /// K'' \[N/m\], not negative.
    pub imaginary: f64,
    /// dK'/d(amplitude) \[N/m²\], not positive.
    pub d_real: f64,
    /// dK''/d(amplitude) \[N/m²\].
    pub d_imag: f64,
    /// Energy \[J\] dissipated per cycle.
    pub dissipated: f64,
}

/// Gauss's rules for `ρ_0 >= 1/50`, for 0 to 1/50, and for -0.05 to 0; below -0.05 the contact has weights. The last rule is for
/// all amplitudes of a curve without weights, which has a knee or is nearly singular. The error of F is 5e-15; the error of dF/dx_0
/// is 5e-15 before slip, 1e-13 in slip, and 1e-12 without weights.
static RULE_BEFORE_SLIP: [[[f64; 4]; 2]; 6] = gauss_even();
static RULE_NEAR_SLIP: [[[f64; 4]; 2]; 9] = gauss_even();
static RULE_AFTER_SLIP: [[[f64; 4]; 2]; 10] = gauss_even();
static RULE_WITHOUT_WEIGHTS: [[[f64; 4]; 2]; 23] = gauss_even();
/// The weights of the contact apply to smaller `ρ_0`.
const IN_SLIP: f64 = -0.05;

/// Smallest scale of the substitution: the cube root of the rounding of x_0.
const SMALLEST_SCALE: f64 = 1e-5;

/// The rule in gross slip, with `y = root²` and `root = 1 - t²`: for each block of nodes ρ, x, and the weights of an integral over
/// ρ.
static RULE_IN_SLIP: [[[f64; 4]; 3]; BLOCKS_IN_SLIP] = {
    let rule = gauss_even::<BLOCKS_IN_SLIP>();
    let (mut blocks, mut i) = ([[[0.0; 4]; 3]; _], 0);
    while i < 4 * rule.len() {
        let [t, weight] = [rule[i / 4][0][i % 4], rule[i / 4][1][i % 4]];
        let (square, root) = (t * t, 1.0 - t * t);
        blocks[i / 4][0][i % 4] = (root * root * root) * (root * root * root);
        blocks[i / 4][1][i % 4] = square * (2.0 - square) * (1.0 + root * root + (root * root) * (root * root));
        blocks[i / 4][2][i % 4] = weight * (12.0 * t * (root * root * root) * (root * root));
        i += 1;
    }
    blocks
};

/// The values `sinh²(4a)` and their derivatives with respect to `sinh²(a)`, given `square = sinh²(a)`.
fn two_doublings<const L: usize>(mut square: Lanes<L>) -> (Lanes<L>, Lanes<L>) {
    let mut rate = Lanes([1.0; L]);
    for _ in 0..2 {
        rate *= 4.0 + 8.0 * square;
        square *= 4.0 + 4.0 * square;
    }
    (square, rate)
}

/// F and dF/dx_0 as sums over blocks of nodes, given a function that returns the terms of F and of 2 dF/dx_0 at a block.
fn sum<B>(blocks: impl Iterator<Item = B>, at: impl Fn(B) -> [Lanes<4>; 2]) -> [f64; 2] {
    let mut sums = [Lanes::ZERO; 2];
    for block in blocks {
        let [terms, rates] = at(block);
        sums = [sums[0] + terms, sums[1] + 0.5 * rates];
    }
    sums.map(Lanes::sum)
}

/// Whether K' and K'', or their derivatives, are requested.
pub(crate) fn requested([k_real, k_imag, dk_real, dk_imag]: &[Option<&mut [f64]>; 4]) -> [bool; 2] {
    [k_real.is_some() || dk_real.is_some(), k_imag.is_some() || dk_imag.is_some()]
}

impl Contact {
    /// The complex stiffness at a displacement amplitude \[m\]; at 0 it is the initial stiffness.
    /// Errors: `BadAmplitude` if the amplitude is not finite, negative, or beyond 1e150.
    pub fn complex_stiffness(&self, amplitude: f64) -> Result<ComplexStiffness, Error> {
        check_amplitude(amplitude)?;
        let [real, imaginary, d_real, d_imag] = self.stiffness_of_cycle(amplitude, [true; 2]);
        Ok(ComplexStiffness { real, imaginary, d_real, d_imag, dissipated: self.energy_of_cycle(amplitude).0 })
    }

    /// F and dF/dx_0 at x_0 = 1 - ρ_0, in units of the initial stiffness.
    fn real_stiffness_integrals(&self, x_0: f64, rho_0: f64) -> [f64; 2] {
        if !self.has_weights_in_slip() {
            return self.integrals(&RULE_WITHOUT_WEIGHTS, x_0, rho_0);
        }
        if rho_0 > IN_SLIP {
            let rule: &[_] = match rho_0 {
                0.02.. => &RULE_BEFORE_SLIP,
                0.0.. => &RULE_NEAR_SLIP,
                _ => &RULE_AFTER_SLIP,
            };
            return self.integrals(rule, x_0, rho_0);
        }
        sum(self.weights_in_slip.iter().zip(&RULE_IN_SLIP), |(weights, [rho, ..])| {
            let (weights, roots) = (Lanes(*weights), (Lanes(*rho) - rho_0).sqrt());
            [weights * roots, weights / roots]
        })
    }

    /// F and dF/dx_0 by Gauss's rule.
    fn integrals(&self, rule: &[[[f64; 4]; 2]], x_0: f64, rho_0: f64) -> [f64; 2] {
        let (below, excess) = (rho_0.max(0.0), (-rho_0).max(0.0));
        let distance = rho_0.abs().cbrt();
        let (y_0, scale) = (if rho_0 > 0.0 { distance } else { 0.0 }, distance.clamp(SMALLEST_SCALE, 1.0));
        // The largest x; sinh²(z/8) at x = 0, by two half-angle formulas.
        let top = x_0.min(1.0);
        let mut end = top / (1.0 + y_0 * (1.0 + y_0)) / scale;
        for _ in 0..2 {
            end /= 2.0 + 2.0 * (1.0 + end).sqrt();
        }
        // The value of t at which x is the distance to the point of zero compliance: x is proportional to t² near 0.
        let bend = (self.relative_distance_of_zero_compliance()
            / (6.0 * scale * end * two_doublings(Lanes([end])).1.0[0]))
            .sqrt();
        let is_bent = bend < 0.4 && !self.has_weights_in_slip();
        let largest = if is_bent { (1.0 / bend).asinh() } else { 0.0 };
        sum(rule.iter(), |[nodes, weights]| {
            let (mut t, mut weights) = (Lanes(*nodes), Lanes(*weights));
            if is_bent {
                let sinh = (largest * t).map(f64::sinh);
                weights *= bend * largest * (1.0 + sinh * sinh).sqrt();
                t = bend * sinh;
            }
            let fraction = 1.0 - t * t;
            let (square, rate) = two_doublings(end * (fraction * fraction));
            let step = scale * square;
            let y = y_0 + step;
            // The difference between ρ and its smallest value.
            let rise = step * (y * y + y * y_0 + y_0 * y_0);
            let (rest, x, rho) = (rise + excess, (top - rise).max(0.0), below + rise);
            let weights = weights * ((x * rest).sqrt() * (12.0 * y * y) * (scale * end * rate * fraction * t));
            let stiffness = self.relative_stiffnesses(x, rho);
            [weights * stiffness, weights / rest * stiffness]
        })
    }

    /// The curve, continued to negative displacements, has a point of zero compliance, to first order at this distance from 0, in
    /// displacements of gross slip.
    fn relative_distance_of_zero_compliance(&self) -> f64 {
        let series = &self.zones.small_load;
        series.compliance * series.compliance / (2.0 * series.initial_curvature() * self.zones.slip_shift)
    }

    /// The weights of F in gross slip; 0 without an interpolant, or if Λ is so small that few nodes are not enough.
    #[inline(never)]
    pub(crate) fn weights_of_curve(&self) -> PolynomialRows<BLOCKS_IN_SLIP> {
        if !self.interpolant.is_converged() || self.relative_distance_of_zero_compliance() < 0.7 {
            return PolynomialRows::default();
        }
        RULE_IN_SLIP.map(|[rho, x, weights]| {
            let x = Lanes(x);
            (self.relative_stiffnesses(x, Lanes(rho)) * (Lanes(weights) * x.sqrt())).0
        })
    }

    fn has_weights_in_slip(&self) -> bool {
        self.weights_in_slip[0][0] > 0.0
    }
}

pub(crate) fn check_amplitude(amplitude: f64) -> Result<(), Error> {
    ensure(in_0_to(amplitude, MAX_DISPLACEMENT), Error::BadAmplitude)
}

impl Contact {
    /// K' and K'', then the derivatives of both, at a checked amplitude \[m\]; those of K' and those of K'' only if requested.
    pub(crate) fn stiffness_of_cycle(&self, amplitude: f64, [has_real, has_imaginary]: [bool; 2]) -> [f64; 4] {
        // K' and K'' are linear to far below rounding, and would underflow in the general formulas.
        if self.is_frictionless() || amplitude <= 1e-30 * self.displacement_scale {
            let (real, imaginary) = self.initial_slopes();
            return [self.initial_stiffness, amplitude * imaginary, real, imaginary];
        }
        let (mut values, not_zero) = ([0.0; 4], amplitude.max(f64::MIN_POSITIVE));
        if has_real {
            (values[0], values[2]) = self.real_stiffness(not_zero);
        }
        if has_imaginary {
            let (energy, slope) = self.energy_of_cycle(amplitude);
            // Factor by factor, because the square of an amplitude may overflow. One division only (see `numerics/guard`).
            let per = 1.0 / not_zero;
            let imaginary = energy * per * per / PI;
            (values[1], values[3]) = (imaginary, (slope * per / PI - 2.0 * imaginary) * per);
        }
        values
    }

    /// K' and its derivative.
    fn real_stiffness(&self, amplitude: f64) -> (f64, f64) {
        let (initial, y) = (self.initial_stiffness, amplitude * self.inner_scale);
        if y <= 1.0
            && let Some((real, slope)) = self.interpolant.cycle_stiffness(y)
        {
            return (initial * real, (initial * self.inner_scale * slope).min(0.0));
        }
        let per_slip = self.per_slip_displacement;
        let x_0 = amplitude * per_slip;
        let [integral, rate] = self.real_stiffness_integrals(x_0, (self.slip_displacement - amplitude) * per_slip);
        // Factor by factor, and one division only: as for K''.
        let per = 1.0 / x_0;
        let [real, slope] =
            [integral, rate - 2.0 * integral * per].map(|value| 8.0 / PI * initial * (value * per * per));
        (real, (slope * per_slip).min(0.0))
    }

    /// Both derivatives at the amplitude 0, from the initial curvature of the curve: `-h_2/Λ³` and `4 h_2/(3πΛ³)`.
    fn initial_slopes(&self) -> (f64, f64) {
        if self.is_frictionless() {
            return (0.0, 0.0);
        }
        let series = &self.zones.small_load;
        let slope = 0.5 * series.initial_curvature() / (series.compliance * series.compliance * series.compliance);
        let unit = self.stiffness_scale * self.per_displacement_scale;
        (-slope * unit, 4.0 / (3.0 * PI) * slope * unit)
    }
}
