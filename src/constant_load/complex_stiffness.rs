//! What a cycle of prescribed amplitude shows: the hysteresis loop (Eq. 11, 12), the energy dissipated (Eq. 13-16) and the
//! complex stiffness (section 3.4).
//!
//! With M the monotonic curve and δ0 the amplitude, `K = K' + iK''` is force over displacement in rotating-vector form:
//!
//! ```text
//! K'  = (8/(π δ0)) ∫ sqrt(X (1-X)) dQ,      X = M(Q)/δ0, from Q = 0 to that at δ0, at most μN
//! K'' = E/(π δ0²)
//! ```
//!
//! K' is the one quantity without a closed form. With the tangent stiffness k it is
//!
//! ```text
//! K' = (8/π) ∫ sqrt(t (1-t)) k(δ0 t) dt,     0 <= t <= 1, up to gross slip
//! ```
//!
//! - Where the inverse of the curve is one polynomial in the approach, so is K': the powers' integrals are known.
//! - Up to near gross slip few nodes do, in a variable that knows where k is singular (`cycle_rules`).
//! - In gross slip the nodes are the same for all amplitudes, and kept with the contact.
//! - Between, within a few per cent of gross slip, and for a curve that bends sharply at its origin, the stick zone's size is
//!   the variable and the tanh-sinh rule takes the roots at both ends, and what else is singular near them; up to τ = 1/2 the
//!   variable is τ.
//!
//! For these in microslip k falls from stick zone to stick zone,
//!
//! ```text
//! dK'/dδ0 = -(8/(π δ0)) ∫ k² X^(3/2) (1-X)^(1/2) dλ
//! ```
//!
//! is a sum of one sign; in gross slip the upper limit is fixed and K' is differentiated as it stands.

use crate::constant_load::contact::{Contact, MAX_DISPLACEMENT};
use crate::error::Error;
use crate::numerics::fp_class::in_0_to;
use crate::numerics::quadrature::TANH_SINH;
use crate::numerics::sn_midpoint::{GAUSS, RULES, Rule};
use crate::shape::stick_zone::{QuadraturePoint, StickZone, StickZones, integrate};
use core::f64::consts::PI;

/// Complex stiffness at one displacement amplitude; what is asked for is computed.
#[derive(Debug, Clone, Copy)]
pub struct ComplexStiffness<'a> {
    contact: &'a Contact,
    amplitude: f64,
    gross_slip: bool,
}

/// Nodes of K' in gross slip, the same for all amplitudes: x, and dτ with the weight.
pub(crate) type GrossSlipQuadrature = [[f64; GAUSS.len()]; 2];

pub(crate) const NO_QUADRATURE: GrossSlipQuadrature = [[0.0; GAUSS.len()]; 2];

/// Nodes over all stick zones: size parameters whose spacing grows in proportion to the distance from the branch points, and shrinks
/// towards b, where the integrands have square roots.
pub(crate) fn gross_slip_quadrature(zones: &dyn StickZones) -> GrossSlipQuadrature {
    let extent = zones.log_branch_distance();
    // σ = sinh(extent y)/sinh(extent), y = z (2-z).
    let scale = 0.5 / (0.5 * (extent.exp() - (-extent).exp()));
    let mut nodes = NO_QUADRATURE;
    let [shifts, weights] = &mut nodes;
    for ((shift, slip_weight), (z, weight)) in shifts.iter_mut().zip(weights).zip(GAUSS) {
        let (up, down) = ((extent * z * (2.0 - z)).exp(), (-extent * z * (2.0 - z)).exp());
        let rate = extent * scale * (up + down) * 2.0 * (1.0 - z);
        let point = zones.quadrature_point((scale * (up - down)).min(1.0));
        (*shift, *slip_weight) = (point.shift.consumed, weight * rate * point.dload_dsigma);
    }
    nodes
}

/// Fraction of the displacement of gross slip from which the contact's own nodes are enough.
const SLIP_NODES_FROM: f64 = 1.05;

impl Contact {
    /// The complex stiffness at a displacement amplitude \[m\]; at 0 it is the initial stiffness.
    ///
    /// # Errors
    /// `BadAmplitude` for an amplitude that is not finite, negative, or beyond 1e150.
    pub fn complex_stiffness(&self, amplitude: f64) -> Result<ComplexStiffness<'_>, Error> {
        check_amplitude(amplitude)?;
        let gross_slip = self.is_frictionless() || amplitude >= self.slip_displacement;
        Ok(ComplexStiffness { contact: self, amplitude, gross_slip })
    }
}

/// A sum in four sums.
#[inline(always)]
fn sum4(terms: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    for four in terms.as_chunks::<4>().0 {
        for k in 0..4 {
            sums[k] += four[k];
        }
    }
    (sums[0] + sums[2]) + (sums[1] + sums[3])
}

pub(crate) fn check_amplitude(amplitude: f64) -> Result<(), Error> {
    if in_0_to(MAX_DISPLACEMENT, amplitude) { Ok(()) } else { Err(Error::BadAmplitude) }
}

impl ComplexStiffness<'_> {
    /// No friction, or an amplitude so small that the curve's first bend is all there is, to far beyond rounding: smaller
    /// ones would only underflow.
    fn is_linear(&self) -> bool {
        self.contact.is_frictionless() || self.amplitude <= 1e-30 * self.contact.displacement_scale
    }

    /// The stick zone at the reversals; none in gross slip.
    fn stick(&self) -> Option<StickZone> {
        if self.gross_slip { None } else { Some(self.contact.stick_zone_at_displacement(self.amplitude)) }
    }

    /// δ0 in units of the approach.
    fn shift(&self) -> f64 {
        self.amplitude * self.contact.per_displacement_scale
    }

    fn amplitude_not_zero(&self) -> f64 {
        self.amplitude.max(f64::MIN_POSITIVE)
    }

    fn zones(&self) -> &dyn StickZones {
        self.contact.stick_zones()
    }

    /// K' \[N/m\].
    #[must_use]
    #[inline(always)]
    pub fn real(&self) -> f64 {
        self.real_with_derivative().0
    }

    /// K'' \[N/m\], not negative.
    #[must_use]
    #[inline(always)]
    pub fn imaginary(&self) -> f64 {
        self.imaginary_with_derivative().0
    }

    /// dK'/d(amplitude) \[N/m²\], not positive.
    #[must_use]
    #[inline(always)]
    pub fn d_real(&self) -> f64 {
        self.real_with_derivative().1
    }

    /// dK''/d(amplitude) \[N/m²\].
    #[must_use]
    #[inline(always)]
    pub fn d_imag(&self) -> f64 {
        self.imaginary_with_derivative().1
    }

    /// Energy \[J\] dissipated per cycle.
    #[must_use]
    pub fn dissipated(&self) -> f64 {
        self.energy_with_derivative().0
    }

    /// K' and its derivative.
    #[inline(always)]
    pub(crate) fn real_with_derivative(&self) -> (f64, f64) {
        let (contact, amplitude) = (self.contact, self.amplitude_not_zero());
        if self.is_linear() {
            return (contact.initial_stiffness, self.initial_slopes().0);
        }
        let y = amplitude * contact.inner_scale;
        if y <= 1.0
            && let Some((real, slope)) = contact.polynomial_cycle(y)
        {
            let initial = contact.initial_stiffness;
            return (initial * real, (initial * contact.inner_scale * slope).min(0.0));
        }
        let share = amplitude * contact.per_slip_displacement();
        // A curve that bends more sharply is singular near the origin too.
        if !contact.has_singularity_within(0.75) {
            let mut rules = RULES.iter().skip(usize::from(contact.has_singularity_within(1.5)));
            if let Some(rule) = rules.find(|rule| share <= rule.largest) {
                return self.real_by_rule(rule);
            }
            if share >= SLIP_NODES_FROM {
                return self.real_in_slip();
            }
        }
        let slope = contact.stiffness_scale / contact.displacement_scale * self.real_part_slope();
        (contact.stiffness_scale * self.real_part(), slope)
    }

    /// Both by a rule that knows where gross slip begins.
    #[inline(always)]
    fn real_by_rule(&self, rule: &Rule) -> (f64, f64) {
        let (evaluator, amplitude) = (self.contact.evaluator(), self.amplitude_not_zero());
        let (mut real, mut slope) = (0.0, 0.0);
        for (t, weight, slope_weight) in rule.nodes {
            let stiffness = evaluator.at(amplitude * t).stiffness;
            real += weight * stiffness;
            slope += slope_weight * stiffness;
        }
        (real, (slope / amplitude).min(0.0))
    }

    /// Both in gross slip, from the nodes that the contact keeps.
    #[inline(always)]
    fn real_in_slip(&self) -> (f64, f64) {
        let (contact, shift) = (self.contact, self.shift());
        let per_approach = 1.0 / shift;
        let [consumed, weights] = contact.gross_slip_quadrature();
        // Root and quotient of each node, in whole registers, then their sums.
        let (mut roots, mut quotients) = ([0.0; GAUSS.len()], [0.0; GAUSS.len()]);
        for i in 0..GAUSS.len() {
            let x = consumed[i] * per_approach;
            let remaining = (1.0 - x).max(f64::MIN_POSITIVE);
            roots[i] = weights[i] * (x * remaining).max(0.0).sqrt();
            quotients[i] = roots[i] / remaining;
        }
        let (real, slope) = (sum4(&roots), sum4(&quotients));
        let real = 8.0 / PI * real * per_approach;
        let slope = (4.0 / PI * slope * per_approach - 2.0 * real) * per_approach;
        (contact.stiffness_scale * real, (contact.stiffness_scale / contact.displacement_scale * slope).min(0.0))
    }

    /// K'' and its derivative.
    #[inline(always)]
    pub(crate) fn imaginary_with_derivative(&self) -> (f64, f64) {
        if self.is_linear() {
            let slope = self.initial_slopes().1;
            return (self.amplitude * slope, slope);
        }
        let amplitude = self.amplitude_not_zero();
        let (energy, slope) = self.energy_with_derivative();
        let imaginary = energy / amplitude / amplitude / PI;
        (imaginary, (slope / amplitude / PI - 2.0 * imaginary) / amplitude)
    }

    /// Energy dissipated per cycle, and its derivative by the amplitude.
    #[inline(always)]
    fn energy_with_derivative(&self) -> (f64, f64) {
        let contact = self.contact;
        if self.gross_slip {
            let slid = 4.0 * contact.slip_force;
            (contact.slip_energy + slid * (self.amplitude - contact.slip_displacement), slid)
        } else {
            contact.cycle_energy(self.amplitude)
        }
    }

    fn real_part(&self) -> f64 {
        let shift = self.shift();
        let sum = match &self.stick() {
            Some(stick) if stick.load.consumed <= 0.5 => self.integrate_small_tau(stick, |x, y, _| (x * y).sqrt()),
            stick => self.integrate_sigma(stick.as_ref(), |x, y, station| (x * y).sqrt() * station.dload_dsigma),
        };
        8.0 / PI / shift * sum
    }

    fn real_part_slope(&self) -> f64 {
        let shift = self.shift();
        let Some(stick) = &self.stick() else {
            let roots = self.integrate_sigma(None, |x, y, station| (x / y).sqrt() * station.dload_dsigma);
            return ((4.0 / PI / shift * roots - 2.0 * self.real_part()) / shift).min(0.0);
        };
        let sum = if stick.load.consumed <= 0.5 {
            self.integrate_small_tau(stick, |x, y, near| {
                x * (x * y).sqrt() * near.curvature / (near.compliance * near.compliance)
            })
        } else {
            self.integrate_sigma(Some(stick), |x, y, station| {
                x * (x * y).sqrt() * station.dcompliance_dsigma / (station.compliance * station.compliance)
            })
        };
        -8.0 / PI / shift * sum
    }

    /// `∫ f(X, 1-X, curve) dτ` from 0 to the τ0 of a stick zone near the origin.
    fn integrate_small_tau(&self, stick: &StickZone, f: impl Fn(f64, f64, &NearPoint) -> f64) -> f64 {
        let origin = self.zones().small_load();
        let (shift, top) = (self.shift(), stick.load.consumed);
        let sum: f64 = TANH_SINH
            .iter()
            .map(|node| {
                let tau = top * node.from_0;
                let sums = origin.sums(tau);
                let x = ((origin.compliance * tau + sums.shift) / shift).min(1.0);
                let near = NearPoint { compliance: origin.compliance + sums.compliance, curvature: sums.curvature };
                node.weight * f(x, 1.0 - x, &near)
            })
            .sum();
        sum * top
    }

    /// `∫ f(X, 1-X, station) dσ` from the stick zone, or from the smallest member in gross slip, to the contact.
    fn integrate_sigma(&self, stick: Option<&StickZone>, f: impl Fn(f64, f64, &QuadraturePoint) -> f64) -> f64 {
        let (family, shift) = (self.zones(), self.shift());
        let (from, remaining) = match stick {
            Some(stick) => (family.size_parameter(stick), stick.shift.remaining),
            None => (
                0.0,
                (self.contact.slip_displacement - self.amplitude)
                    / self.contact.displacement_scale.max(f64::MIN_POSITIVE),
            ),
        };
        let integrand = |station: &QuadraturePoint| {
            let x = (station.shift.consumed / shift).clamp(0.0, 1.0);
            let y = ((station.shift.remaining - remaining) / shift).max(f64::MIN_POSITIVE);
            f(x, y, station)
        };
        // Just beyond gross slip 1-X nearly vanishes at the inner end, on the scale of the member whose rest is the excess:
        // the integral is divided there.
        let compliance_increase = (-remaining).min(family.slip_shift() - family.small_load().half_shift);
        if compliance_increase > 0.0 {
            let middle = family.size_parameter(&family.at_shift_remaining(compliance_increase));
            integrate(family, 0.0, middle, integrand) + integrate(family, middle, 1.0, integrand)
        } else {
            integrate(family, from, 1.0, integrand)
        }
    }

    /// Both derivatives at the amplitude 0, from the curve's first bend: `-h_2/Λ³` and `4 h_2/(3πΛ³)`.
    fn initial_slopes(&self) -> (f64, f64) {
        if self.contact.is_frictionless() {
            return (0.0, 0.0);
        }
        let origin = self.zones().small_load();
        let second_derivative =
            0.5 * origin.initial_curvature() / (origin.compliance * origin.compliance * origin.compliance);
        let unit = self.contact.stiffness_scale / self.contact.displacement_scale.max(f64::MIN_POSITIVE);
        (-second_derivative * unit, 4.0 / (3.0 * PI) * second_derivative * unit)
    }
}

struct NearPoint {
    compliance: f64,
    curvature: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constant_load::contact::tests::{FLATS, contact, cylinder, ellipse, parameters};
    use crate::numerics::quadrature::TANH_SINH;
    use crate::parameters::{CENTRE_POINT, Material, Parameters};

    /// Λ = 3.4243 with h = ½ [τ + (1-τ) ln(1-τ)]: K' by adaptive quadrature and K'' in closed form, both to 20 digits.
    #[test]
    fn a_cylinder_has_the_stiffness_of_its_elementary_curve() {
        let contact = cylinder(3.4243_f64.exp(), 0.0, CENTRE_POINT).unwrap();
        for (part, real, imaginary) in [
            (0.5, 0.278_238_957_245_119_07, 0.006_342_425_455_761_636),
            (1.2, 0.224_534_706_493_106_57, 0.059_416_193_661_125_13),
        ] {
            let complex = contact.complex_stiffness(part * contact.slip_displacement).unwrap();
            let found = [complex.real(), complex.imaginary()].map(|k| k / contact.stiffness_scale);
            // A unit of rounding of Λ, which comes from the half-width, is one of both.
            assert!(
                (found[0] / real - 1.0).abs() < 4e-15 && (found[1] / imaginary - 1.0).abs() < 2e-14,
                "{part} {found:?}"
            );
        }
    }

    /// However little the edges carry: the difference of two compliances, by which stick zones are found, is then lost.
    #[test]
    fn the_energy_by_displacement_is_that_by_force() {
        for lightness in 0..60 {
            let normal_force = 150.0 * 0.1f64.powi(lightness);
            let contact = Contact::rounded_flat(&Parameters { normal_force, ..parameters(5e-3) }).unwrap();
            for part in [0.4, 0.6, 0.9, 0.975, 0.99, 0.998] {
                let amplitude = part * contact.slip_displacement;
                let force = contact.curve_at_displacement(amplitude).unwrap().force();
                let by_displacement = contact.complex_stiffness(amplitude).unwrap().dissipated();
                let by_force = contact.dissipated_energy(force).unwrap();
                // Of the difference of members near each other 1e-13 is left on either side.
                assert!(
                    (by_displacement / by_force - 1.0).abs() < 1e-12,
                    "{lightness} {part} {by_displacement} {by_force}"
                );
            }
        }
    }

    #[test]
    fn at_rest_it_starts_with_the_initial_stiffness_and_the_slopes_of_the_first_bend() {
        let titanium = Material { young_modulus: 1.14e11, poisson_ratio: 0.29 };
        let contact = Contact::rounded_flat(&Parameters {
            flat_half_width: 0.0,
            edge_radius: 5e-3,
            length: 3.67e-2,
            normal_force: 2.26849e3,
            friction_coefficient: 0.647,
            material: [titanium; 2],
            ..Parameters::default()
        })
        .unwrap();
        let remaining = contact.complex_stiffness(0.0).unwrap();
        assert_eq!((remaining.real(), remaining.imaginary()), (contact.initial_stiffness, 0.0));
        // The reference at 1e-6 of the slip displacement, to which the slopes change by as much.
        assert!((remaining.d_real() / -5.786_302_156_963_336e12 - 1.0).abs() < 1e-6);
        assert!((remaining.d_imag() / 2.455_783_688_472_798e12 - 1.0).abs() < 1e-6);
        for contact in FLATS.map(self::contact).into_iter().chain([ellipse(1e-4, 2e-4)]) {
            let remaining = contact.complex_stiffness(0.0).unwrap();
            let amplitude = 1e-5 * contact.slip_displacement;
            let small = contact.complex_stiffness(amplitude).unwrap();
            // The next terms are 1e-5 of the slopes; what K' falls by has the rounding of K' itself.
            let fall = (small.real() - remaining.real()) / amplitude;
            let rounding = 4.0 * f64::EPSILON * remaining.real() / amplitude;
            assert!((fall - remaining.d_real()).abs() < 2e-5 * remaining.d_real().abs() + rounding);
            assert!((small.imaginary() / amplitude / remaining.d_imag() - 1.0).abs() < 2e-5);
            assert!((small.d_real() / remaining.d_real() - 1.0).abs() < 4e-5);
            assert!((small.d_imag() / remaining.d_imag() - 1.0).abs() < 4e-5);
        }
    }

    /// From mu N/2 on another formula computes, and from the slip displacement on another law holds.
    #[test]
    fn nothing_jumps_where_the_formula_changes() {
        for contact in FLATS.map(contact).into_iter().chain([ellipse(1e-4, 2e-4)]) {
            let half = contact.curve_at_force(0.5 * contact.slip_force).unwrap().displacement();
            for (amplitude, step) in [(half, 1e-12), (contact.slip_displacement, 1e-9)] {
                let [low, high] =
                    [1.0 - step, 1.0 + step].map(|part| contact.complex_stiffness(part * amplitude).unwrap());
                let scale = low.real().hypot(low.imaginary());
                // K changes by less than K over an amplitude.
                let bound = 2.0 * step + 4e-15;
                assert!((low.real() - high.real()).abs() < bound * scale);
                assert!((low.imaginary() - high.imaginary()).abs() < bound * scale);
                if amplitude == half {
                    // The slopes are good to 1e-12 on either side.
                    let slope = scale / amplitude;
                    assert!((low.d_real() - high.d_real()).abs() < 4e-12 * slope);
                    assert!((low.d_imag() - high.d_imag()).abs() < 4e-12 * slope);
                }
            }
            let at_slip = contact.complex_stiffness(contact.slip_displacement).unwrap();
            assert!((at_slip.dissipated() / contact.slip_energy - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn the_stiffness_is_the_first_harmonic_of_the_loop() {
        // Lengths that are just allowed bend the curve near its origin.
        let short = [1.0001, 1.02, 1.2, 2.0].map(|slenderness| cylinder(slenderness, 0.0, CENTRE_POINT).unwrap());
        for contact in FLATS.map(contact).into_iter().chain([ellipse(1e-4, 2e-4)]).chain(short) {
            for part in [1e-3, 0.05, 0.3, 0.6, 0.79, 0.95, 0.99, 1.0, 1.5, 20.0] {
                let amplitude = part * contact.slip_displacement;
                // Half a period, in gross slip divided where amplitude (1 - cos t) is twice the slip displacement.
                let middle = if part > 1.0 { (1.0 - 2.0 / part).acos() / PI } else { 0.5 };
                let (mut real, mut imaginary) = (0.0, 0.0);
                for (from, to) in [(0.0, middle), (middle, 1.0)] {
                    for node in &TANH_SINH {
                        let turn: f64 = from + (to - from) * node.from_0;
                        let force = contact.hysteresis_loop(amplitude).unwrap().force_at((1.0, 0.5 * turn));
                        let share = 2.0 / amplitude * (to - from) * node.weight * force;
                        real += share * (PI * turn).cos();
                        imaginary -= share * (PI * turn).sin();
                    }
                }
                let complex = contact.complex_stiffness(amplitude).unwrap();
                // The sums have the rounding of forces up to the largest; K'' is what is left of them.
                let size = contact.initial_stiffness.min(4.0 * contact.slip_force / amplitude);
                assert!((complex.real() - real).abs() < 1e-13 * size, "{part} {} {real}", complex.real());
                assert!(
                    (complex.imaginary() - imaginary).abs() < 1e-13 * size,
                    "{part} {} {imaginary}",
                    complex.imaginary()
                );
            }
        }
    }

    #[test]
    fn amplitudes_are_refused_by_name() {
        let contact = contact(50e-6);
        for amplitude in [-1e-9, f64::NAN, f64::INFINITY, 1.1e150] {
            assert_eq!(contact.complex_stiffness(amplitude).map(|_| ()), Err(Error::BadAmplitude));
            assert_eq!(contact.hysteresis_loop(amplitude).map(|_| ()), Err(Error::BadAmplitude));
        }
        assert!(contact.complex_stiffness(1e150).is_ok());
        for force in [-1e-9, f64::NAN, f64::INFINITY] {
            assert_eq!(contact.dissipated_energy(force), Err(Error::BadForceAmplitude));
        }
        assert_eq!(contact.dissipated_energy(1.001 * contact.slip_force), Err(Error::ForceExceedsSlip));
        assert_eq!(contact.dissipated_energy(0.0), Ok(0.0));
    }
}
