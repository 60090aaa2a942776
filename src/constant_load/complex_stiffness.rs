//! Complex stiffness `K = K' + iK''` of a cycle of prescribed displacement amplitude (section 3.4), and its derivatives.
//!
//! With M the monotonic curve and δ0 the amplitude, K is the ratio of force to displacement in rotating-vector form:
//!
//! ```text
//! K'  = (8/(π δ0)) ∫ sqrt(X (1-X)) dQ,      X = M(Q)/δ0, from Q = 0 to that at δ0, at most μN
//! K'' = E/(π δ0²)
//! ```
//!
//! with E the dissipated energy. K' has no closed form. With the tangent stiffness k it is
//!
//! ```text
//! K' = (8/π) ∫ sqrt(t (1-t)) k(δ0 t) dt,     0 <= t <= 1, up to gross slip
//! ```
//!
//! - Up to 2/5 of the displacement of gross slip, or 11/20, T(δ) is one polynomial, and so is K': the integrals of the powers are known.
//! - Up to 0.999 of it: a midpoint rule in a variable that removes the singularity of k at gross slip (`sn_midpoint`).
//! - From 1.05 of it: a quadrature rule that is the same for all amplitudes and is stored in the contact.
//! - Between these: the tanh-sinh rule, which converges despite the square roots at both ends and other singularities close to them.
//! - With a layer there, and for Λ near 0, for which the curve is singular close to zero displacement: the same over the closed forms,
//!   in τ up to τ = 1/2 and in the size parameter beyond.
//!
//! For these amplitudes below gross slip
//!
//! ```text
//! dK'/dδ0 = -(8/(π δ0)) ∫ k² X^(3/2) (1-X)^(1/2) dλ
//! ```
//!
//! is an integral of one sign; in gross slip the upper limit is fixed, and the integral of K' is differentiated under the integral
//! sign.

use crate::constant_load::contact::Contact;
use crate::constant_load::evaluator::BEYOND;
use crate::error::Error;
use crate::limits::MAX_DISPLACEMENT;
use crate::numerics::fp_class::in_0_to;
use crate::numerics::quadrature::TANH_SINH;
use crate::numerics::sn_midpoint::{GAUSS, Quadrature, RULES, Rule};
use crate::shape::stick_zone::{QuadraturePoint, StickZone, StickZones, integrate};
use crate::simd::dispatch;
use core::array::from_fn;
use core::f64::consts::PI;

/// Complex stiffness at one displacement amplitude. Quantities are evaluated on demand.
#[derive(Debug, Clone, Copy)]
pub struct ComplexStiffness<'a> {
    contact: &'a Contact,
    amplitude: f64,
    gross_slip: bool,
}

/// Fraction of the displacement of gross slip from which the rule stored in the contact is accurate.
const GROSS_SLIP_RULE_FROM: f64 = 1.05;

/// Distance from gross slip, in displacements of gross slip, up to which there is an interpolant.
const END_OF_INTERPOLANT: f64 = 1.0 / 1700.0;

/// Nodes of rules in the time in which a table is made, and of K' next to gross slip.
pub(crate) const NODES_OF_TABLE: usize = 1500;
const NODES_NEAR_SLIP: usize = 1200;

impl Contact {
    /// Tangent stiffness at the onset of gross slip over the initial one.
    pub(crate) fn stiffness_at_slip(&self) -> f64 {
        let zone = self.stick_zones().at_shift_remaining(0.0);
        self.stick_zones().small_load().compliance / self.stick_zones().compliance(&zone)
    }

    /// The complex stiffness at a displacement amplitude \[m\]; at 0 it is the initial stiffness.
    ///
    /// # Errors
    /// `BadAmplitude` if the amplitude is not finite, negative, or beyond 1e150.
    pub fn complex_stiffness(&self, amplitude: f64) -> Result<ComplexStiffness<'_>, Error> {
        check_amplitude(amplitude)?;
        let gross_slip = self.is_frictionless() || amplitude >= self.slip_displacement;
        Ok(ComplexStiffness { contact: self, amplitude, gross_slip })
    }
}

/// The sum of all terms by four partial sums; their number is a multiple of four.
#[inline(always)]
fn sum4(terms: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    for row in terms.as_chunks::<4>().0 {
        for k in 0..4 {
            sums[k] += row[k];
        }
    }
    (sums[0] + sums[2]) + (sums[1] + sums[3])
}

pub(crate) fn check_amplitude(amplitude: f64) -> Result<(), Error> {
    if in_0_to(MAX_DISPLACEMENT, amplitude) { Ok(()) } else { Err(Error::BadAmplitude) }
}

impl ComplexStiffness<'_> {
    /// No friction, or an amplitude so small that K' and K'' are linear in it to far below rounding. Smaller amplitudes would underflow
    /// in the general formulas.
    fn is_linear(&self) -> bool {
        self.contact.is_frictionless() || self.amplitude <= 1e-30 * self.contact.displacement_scale
    }

    /// The stick zone at the reversals; `None` in gross slip.
    fn stick_zone(&self) -> Option<StickZone> {
        if self.gross_slip { None } else { Some(self.contact.stick_zone_at_displacement(self.amplitude)) }
    }

    /// δ0 in units of shift.
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
        let stiffness = self;
        dispatch!(ComplexStiffness::real_kernel, stiffness: &ComplexStiffness => (f64, f64))
    }

    #[inline(always)]
    fn real_kernel(&self) -> (f64, f64) {
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
        let fraction = amplitude * contact.per_slip_displacement();
        if contact.quadrature() != Quadrature::General {
            let rules = contact.quadrature().rules();
            if let Some(rule) = rules.iter().find(|rule| fraction <= rule.largest) {
                return self.real_by_rule(rule);
            }
            if fraction >= GROSS_SLIP_RULE_FROM {
                return self.real_in_gross_slip();
            }
            // Closer to gross slip the square roots of both are singular at nearly the same place.
            if !contact.is_layered() && (fraction == 1.0 || (fraction - 1.0).abs() > 1e-9) {
                return self.real_by_interpolant();
            }
        }
        self.real_by_tanh_sinh()
    }

    /// An estimate of the nodes at which the curve is evaluated for K'.
    pub(crate) fn nodes(&self) -> usize {
        let contact = self.contact;
        if self.is_linear() || self.amplitude * contact.inner_scale <= 1.0 {
            return 0;
        }
        let fraction = self.amplitude * contact.per_slip_displacement();
        let rules = match contact.quadrature() {
            Quadrature::General => return NODES_OF_TABLE,
            Quadrature::Knee => contact.quadrature().rules(),
            Quadrature::AllRules | Quadrature::LaterRules => &RULES,
        };
        match rules.iter().find(|rule| fraction <= rule.largest) {
            Some(rule) => rule.nodes.len(),
            None if fraction < GROSS_SLIP_RULE_FROM && contact.is_layered() => NODES_OF_TABLE,
            None if fraction < GROSS_SLIP_RULE_FROM => NODES_NEAR_SLIP,
            None => GAUSS.len() / 8,
        }
    }

    /// Both by a rule adapted to the singularity at gross slip.
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

    /// Both in gross slip, by the rule stored in the contact.
    #[inline(always)]
    fn real_in_gross_slip(&self) -> (f64, f64) {
        let (contact, shift) = (self.contact, self.shift());
        let per_shift = 1.0 / shift;
        let [consumed, weights] = contact.gross_slip_quadrature();
        // The terms of both integrals first, which the compiler vectorises, then their sums.
        let (mut roots, mut quotients) = ([0.0; GAUSS.len()], [0.0; GAUSS.len()]);
        for i in 0..GAUSS.len() {
            let x = consumed[i] * per_shift;
            let remaining = (1.0 - x).max(f64::MIN_POSITIVE);
            roots[i] = weights[i] * (x * remaining).max(0.0).sqrt();
            quotients[i] = roots[i] / remaining;
        }
        let (real, slope) = (sum4(&roots), sum4(&quotients));
        let real = 8.0 / PI * real * per_shift;
        let slope = (4.0 / PI * slope * per_shift - 2.0 * real) * per_shift;
        (contact.stiffness_scale * real, (contact.stiffness_scale / contact.displacement_scale * slope).min(0.0))
    }

    /// K'' and its derivative.
    #[inline(always)]
    pub(crate) fn imaginary_with_derivative(&self) -> (f64, f64) {
        let stiffness = self;
        dispatch!(ComplexStiffness::imaginary_kernel, stiffness: &ComplexStiffness => (f64, f64))
    }

    #[inline(always)]
    fn imaginary_kernel(&self) -> (f64, f64) {
        if self.is_linear() {
            let slope = self.initial_slopes().1;
            return (self.amplitude * slope, slope);
        }
        let amplitude = self.amplitude_not_zero();
        let (energy, slope) = self.energy_with_derivative();
        let imaginary = energy / amplitude / amplitude / PI;
        (imaginary, (slope / amplitude / PI - 2.0 * imaginary) / amplitude)
    }

    /// Energy dissipated per cycle, and its derivative with respect to the amplitude.
    #[inline(always)]
    fn energy_with_derivative(&self) -> (f64, f64) {
        let contact = self.contact;
        if self.gross_slip {
            let slope = 4.0 * contact.slip_force;
            (contact.slip_energy + slope * (self.amplitude - contact.slip_displacement), slope)
        } else {
            contact.cycle_energy(self.amplitude)
        }
    }

    /// Both next to gross slip: the tangent stiffness is that of the interpolant, and beyond its end that of the closed forms.
    #[inline(never)]
    fn real_by_interpolant(&self) -> (f64, f64) {
        const NODES: usize = TANH_SINH.len();
        const LENGTH: usize = (NODES + BEYOND).next_multiple_of(4);
        let (contact, amplitude) = (self.contact, self.amplitude);
        let top = amplitude.min(contact.slip_displacement);
        // 1 - t at the end of the integral.
        let excess = (amplitude - top) / amplitude;
        let share = top / amplitude;
        let (mut displacements, mut roots, mut forces, mut stiffnesses) =
            ([top; LENGTH], [0.0; LENGTH], [0.0; LENGTH], [0.0; LENGTH]);
        displacements.iter_mut().zip(&TANH_SINH).for_each(|(x, node)| *x = top * node.from_0);
        let interpolated = if contact.is_elementary() {
            NODES
        } else {
            let end = (1.0 - END_OF_INTERPOLANT) * contact.slip_displacement;
            displacements.iter().take(NODES).take_while(|x| **x < end).count()
        };
        contact.evaluator().along::<true>(interpolated, &displacements, &mut roots, &mut forces, &mut stiffnesses);
        if interpolated < NODES {
            let (per_slip, slip_shift) = (contact.per_slip_displacement(), self.zones().slip_shift());
            let (rest, part) = ((contact.slip_displacement - top) * per_slip, top * per_slip);
            let compliance = self.zones().small_load().compliance;
            let mut point_at = contact.layered_zones().flat.sequence();
            for (stiffness, mirrored) in
                stiffnesses.iter_mut().zip(TANH_SINH.iter().rev()).take(NODES).skip(interpolated)
            {
                let point = point_at(slip_shift * (rest + part * mirrored.from_0));
                *stiffness = contact.initial_stiffness * (compliance / (compliance + point.compliance_increase));
            }
        }
        let last = stiffnesses[NODES - 1];
        // In gross slip the upper end is fixed; just beyond it the integrand of a constant stiffness is nearly singular there, and its
        // integral is known. Otherwise by parts, for which the derivative of t^(3/2) (1-t)^(1/2) has the integral 0.
        let (mut real, mut slope) = (0.0, 0.0);
        if self.gross_slip {
            slope = 0.5 * last * (share.sqrt().atan2(excess.sqrt()) - (share * excess).sqrt()) / share;
        }
        for ((node, mirrored), stiffness) in TANH_SINH.iter().zip(TANH_SINH.iter().rev()).zip(&stiffnesses) {
            let (t, rest) = (share * node.from_0, excess + share * mirrored.from_0);
            let weight = node.weight * (t * rest).sqrt();
            real += weight * stiffness;
            let change = stiffness - last;
            slope += weight
                * if self.gross_slip { 0.5 * change / rest - 2.0 * stiffness } else { (0.5 * t / rest - 1.5) * change };
        }
        let unit = 8.0 / PI * share;
        (unit * real, (unit * slope / amplitude).min(0.0))
    }

    /// Both by the tanh-sinh rule over the closed forms.
    #[inline(never)]
    fn real_by_tanh_sinh(&self) -> (f64, f64) {
        let (contact, shift) = (self.contact, self.shift());
        let [real, slope] = match &self.stick_zone() {
            None => {
                let [roots, quotients] = self.integrate_sigma(None, |x, y, point| {
                    let root = (x * y).sqrt() * point.dload_dsigma;
                    [root, root / y]
                });
                [roots, (0.5 * quotients - 2.0 * roots) / shift]
            }
            Some(zone) if zone.load.consumed <= 0.5 => self.integrate_small_tau(zone, |x, y, point| {
                let root = (x * y).sqrt();
                [root, -root * x * point.curvature / (point.compliance * point.compliance)]
            }),
            zone => self.integrate_sigma(zone.as_ref(), |x, y, point| {
                let root = (x * y).sqrt();
                let slope = -root * x * point.dcompliance_dsigma / (point.compliance * point.compliance);
                [root * point.dload_dsigma, slope]
            }),
        };
        let (unit, slope) = (8.0 / PI / shift * contact.stiffness_scale, slope.min(0.0));
        (unit * real, unit / contact.displacement_scale * slope)
    }

    /// `∫ f(X, 1-X, curve) dτ` from 0 to the τ of a stick zone, τ <= 1/2.
    fn integrate_small_tau(&self, zone: &StickZone, f: impl Fn(f64, f64, &SmallLoadPoint) -> [f64; 2]) -> [f64; 2] {
        let series = self.zones().small_load();
        let (shift, top) = (self.shift(), zone.load.consumed);
        let mut sums = [0.0; 2];
        for node in &TANH_SINH {
            let tau = top * node.from_0;
            let values = series.evaluate(tau);
            let x = ((series.compliance * tau + values.shift) / shift).min(1.0);
            let point =
                SmallLoadPoint { compliance: series.compliance + values.compliance, curvature: values.curvature };
            let values = f(x, 1.0 - x, &point);
            sums = from_fn(|k| sums[k] + node.weight * values[k]);
        }
        sums.map(|sum| sum * top)
    }

    /// `∫ f(X, 1-X, point) dσ` from the stick zone, or from the smallest one in gross slip, to b.
    fn integrate_sigma(
        &self,
        zone: Option<&StickZone>,
        f: impl Fn(f64, f64, &QuadraturePoint) -> [f64; 2],
    ) -> [f64; 2] {
        let (zones, shift) = (self.zones(), self.shift());
        let (from, remaining) = match zone {
            Some(zone) => (zones.size_parameter(zone), zone.shift.remaining),
            None => (
                0.0,
                (self.contact.slip_displacement - self.amplitude)
                    / self.contact.displacement_scale.max(f64::MIN_POSITIVE),
            ),
        };
        let integrand = |point: &QuadraturePoint| {
            let x = (point.shift.consumed / shift).clamp(0.0, 1.0);
            let y = ((point.shift.remaining - remaining) / shift).max(f64::MIN_POSITIVE);
            f(x, y, point)
        };
        // Just beyond gross slip 1-X nearly vanishes at σ = 0: it doubles at the stick zone whose remaining shift equals the excess of the
        // amplitude, and the integral is split there.
        let excess = (-remaining).min(zones.slip_shift() - zones.small_load().half_shift);
        if excess > 0.0 {
            let middle = zones.size_parameter(&zones.at_shift_remaining(excess));
            let [one, other] = [[0.0, middle], [middle, 1.0]].map(|[from, to]| integrate(zones, from, to, integrand));
            from_fn(|k| one[k] + other[k])
        } else {
            integrate(zones, from, 1.0, integrand)
        }
    }

    /// Both derivatives at the amplitude 0, from the initial curvature of the curve: `-h_2/Λ³` and `4 h_2/(3πΛ³)`.
    fn initial_slopes(&self) -> (f64, f64) {
        if self.contact.is_frictionless() {
            return (0.0, 0.0);
        }
        let series = self.zones().small_load();
        let slope = 0.5 * series.initial_curvature() / (series.compliance * series.compliance * series.compliance);
        let unit = self.contact.stiffness_scale / self.contact.displacement_scale.max(f64::MIN_POSITIVE);
        (-slope * unit, 4.0 / (3.0 * PI) * slope * unit)
    }
}

/// A point of the curve for τ <= 1/2.
struct SmallLoadPoint {
    /// Λ + λ.
    compliance: f64,
    /// h''.
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
    fn the_cylinder_has_the_stiffness_of_its_elementary_curve() {
        let contact = cylinder(3.4243_f64.exp(), 0.0, CENTRE_POINT).unwrap();
        for (part, real, imaginary) in [
            (0.5, 0.278_238_957_245_119_07, 0.006_342_425_455_761_636),
            (1.2, 0.224_534_706_493_106_57, 0.059_416_193_661_125_13),
        ] {
            let complex = contact.complex_stiffness(part * contact.slip_displacement).unwrap();
            let found = [complex.real(), complex.imaginary()].map(|k| k / contact.stiffness_scale);
            // Λ is computed from the half-width; its relative rounding error is that of K' and K''.
            assert!(
                (found[0] / real - 1.0).abs() < 4e-15 && (found[1] / imaginary - 1.0).abs() < 2e-14,
                "{part} {found:?}"
            );
        }
    }

    /// Down to the smallest loads of the edges, for which the compliance increase is a cancelling difference.
    #[test]
    fn energy_at_an_amplitude_equals_energy_at_its_force() {
        for exponent in 0..60 {
            let normal_force = 150.0 * 0.1f64.powi(exponent);
            let contact = Contact::rounded_flat(&Parameters { normal_force, ..parameters(5e-3) }).unwrap();
            for part in [0.4, 0.6, 0.9, 0.975, 0.99, 0.998] {
                let amplitude = part * contact.slip_displacement;
                let force = contact.curve_at_displacement(amplitude).unwrap().force();
                let by_displacement = contact.complex_stiffness(amplitude).unwrap().dissipated();
                let by_force = contact.dissipated_energy(force).unwrap();
                // The difference of two nearly equal stick zones has a relative error of 1e-13 in both.
                assert!(
                    (by_displacement / by_force - 1.0).abs() < 1e-12,
                    "{exponent} {part} {by_displacement} {by_force}"
                );
            }
        }
    }

    #[test]
    fn zero_amplitude_gives_the_initial_stiffness_and_its_derivatives() {
        let titanium = Material { young_modulus: 1.14e11, poisson_ratio: 0.29 };
        let contact = Contact::rounded_flat(&Parameters {
            flat_half_width: 0.0,
            edge_radius: 5e-3,
            length: 3.67e-2,
            normal_force: 2.26849e3,
            friction_coefficient: 0.647,
            material: [titanium; 2],
            displacement_reference: crate::parameters::CENTRE_POINT,
            ..Parameters::default()
        })
        .unwrap();
        let initial = contact.complex_stiffness(0.0).unwrap();
        assert_eq!((initial.real(), initial.imaginary()), (contact.initial_stiffness, 0.0));
        // The reference values are at 1e-6 of the displacement of gross slip; the derivatives change by as much up to there.
        assert!((initial.d_real() / -5.786_302_156_963_336e12 - 1.0).abs() < 1e-6);
        assert!((initial.d_imag() / 2.455_783_688_472_798e12 - 1.0).abs() < 1e-6);
        for contact in FLATS.map(self::contact).into_iter().chain([ellipse(1e-4, 2e-4)]) {
            let initial = contact.complex_stiffness(0.0).unwrap();
            let amplitude = 1e-5 * contact.slip_displacement;
            let small = contact.complex_stiffness(amplitude).unwrap();
            // The next terms are 1e-5 of the derivatives; the difference of K' has the rounding error of K' itself.
            let slope = (small.real() - initial.real()) / amplitude;
            let rounding = 4.0 * f64::EPSILON * initial.real() / amplitude;
            assert!((slope - initial.d_real()).abs() < 2e-5 * initial.d_real().abs() + rounding);
            assert!((small.imaginary() / amplitude / initial.d_imag() - 1.0).abs() < 2e-5);
            assert!((small.d_real() / initial.d_real() - 1.0).abs() < 4e-5);
            assert!((small.d_imag() / initial.d_imag() - 1.0).abs() < 4e-5);
        }
    }

    /// The formula changes at mu N/2 and at the onset of gross slip.
    #[test]
    fn complex_stiffness_is_continuous_between_formulas() {
        for contact in FLATS.map(contact).into_iter().chain([ellipse(1e-4, 2e-4)]) {
            let half = contact.curve_at_force(0.5 * contact.slip_force).unwrap().displacement();
            for (amplitude, step) in [(half, 1e-12), (contact.slip_displacement, 1e-9)] {
                let [low, high] =
                    [1.0 - step, 1.0 + step].map(|part| contact.complex_stiffness(part * amplitude).unwrap());
                let scale = low.real().hypot(low.imaginary());
                // |dK/dδ0| < K/δ0.
                let bound = 2.0 * step + 4e-15;
                assert!((low.real() - high.real()).abs() < bound * scale);
                assert!((low.imaginary() - high.imaginary()).abs() < bound * scale);
                if amplitude == half {
                    // The derivatives have an error of 1e-12 on either side.
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
    fn complex_stiffness_is_the_first_harmonic_of_the_loop() {
        // Lengths just above the minimum: Λ is near 0.
        let short = [1.0001, 1.02, 1.2, 2.0].map(|slenderness| cylinder(slenderness, 0.0, CENTRE_POINT).unwrap());
        for contact in FLATS.map(contact).into_iter().chain([ellipse(1e-4, 2e-4)]).chain(short) {
            for part in [1e-3, 0.05, 0.3, 0.6, 0.79, 0.95, 0.99, 1.0, 1.5, 20.0] {
                let amplitude = part * contact.slip_displacement;
                // Half a period, in gross slip split where amplitude (1 - cos t) is twice the displacement of gross slip.
                let middle = if part > 1.0 { (1.0 - 2.0 / part).acos() / PI } else { 0.5 };
                let (mut real, mut imaginary) = (0.0, 0.0);
                for (from, to) in [(0.0, middle), (middle, 1.0)] {
                    for node in &TANH_SINH {
                        let phase: f64 = from + (to - from) * node.from_0;
                        let force = contact.hysteresis_loop(amplitude).unwrap().force_at((1.0, 0.5 * phase));
                        let part = 2.0 / amplitude * (to - from) * node.weight * force;
                        real += part * (PI * phase).cos();
                        imaginary -= part * (PI * phase).sin();
                    }
                }
                let complex = contact.complex_stiffness(amplitude).unwrap();
                // The sums have the rounding error of the largest force; K'' is a cancelling sum.
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
    fn invalid_amplitudes_are_rejected() {
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
