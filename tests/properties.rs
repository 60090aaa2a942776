//! Properties of every contact and every history: Coulomb's bound, dissipation, memory, symmetry, tangents.

mod common;

use common::{advance, harmonic, unloaded};
use microslip::constant_load::equivalents;
use microslip::constant_load::harmonic_force::Rule;
use microslip::{Contact, EllipticParameters, Material, Parameters};
use proptest::prelude::*;
use std::f64::consts::PI;

/// Contacts from the cylinder to the nearly flat, from short to long, of different materials, and elliptical ones.
fn contact() -> impl Strategy<Value = Contact> {
    let flat = prop_oneof![Just(0.0), (-9.0..-1.0f64).prop_map(|e| 10f64.powf(e))];
    let body = (9.0..12.0f64, 0.0..0.5f64)
        .prop_map(|(modulus, poisson_ratio)| Material { young_modulus: 10f64.powf(modulus), poisson_ratio });
    let load = (-3.0..5.0f64).prop_map(|e| 10f64.powf(e));
    let rounded = (flat, -6.0..-1.0f64, 0.7..6.0f64, load.clone(), 0.01..1.5f64, [body.clone(), body.clone()])
        .prop_filter_map(
            "fits its length",
            |(flat_half_width, radius, slenderness, normal_force, friction_coefficient, material)| {
                let mut parameters = Parameters {
                    flat_half_width,
                    edge_radius: 10f64.powf(radius),
                    length: 1.0,
                    normal_force,
                    friction_coefficient,
                    material,
                    ..Parameters::default()
                };
                // The half-width depends on the length: iterate to the requested ratio.
                for _ in 0..3 {
                    let half_width = Contact::rounded_flat(&parameters).map_or(1e-3, |contact| contact.half_width);
                    parameters.length = half_width * 10f64.powf(slenderness);
                }
                Contact::rounded_flat(&parameters).ok()
            },
        );
    let elliptic = (-6.0..-1.0f64, -6.0..-1.0f64, load, 0.01..1.5f64, [body.clone(), body]).prop_map(
        |(x, y, normal_force, friction_coefficient, material)| {
            let parameters = EllipticParameters {
                semi_axis_x: 10f64.powf(x),
                semi_axis_y: 10f64.powf(y),
                normal_force,
                friction_coefficient,
                material,
                ..EllipticParameters::default()
            };
            Contact::elliptic(&parameters).unwrap()
        },
    );
    prop_oneof![3 => rounded, 1 => elliptic]
}

/// Displacements over that of gross slip, mostly below.
fn path(length: usize) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(prop_oneof![4 => -1.0..1.0f64, 1 => -3.0..3.0f64], 1..length)
}

struct Stepper<'a> {
    contact: &'a Contact,
    state: Vec<f64>,
}

impl<'a> Stepper<'a> {
    fn new(contact: &'a Contact) -> Stepper<'a> {
        Stepper { contact, state: unloaded(64) }
    }

    /// The part of the state that is used: its first double holds the number of reversals in its last 40 bits.
    fn used(&self) -> &[f64] {
        &self.state[..5 + 3 * (self.state[0].to_bits() & 0xff_ffff_ffff) as usize]
    }

    /// Force, stiffness and dissipated energy of a step to a displacement over that of gross slip.
    fn step(&mut self, displacement: f64) -> (f64, f64, f64) {
        advance(self.contact, &mut self.state, displacement * self.contact.slip_displacement)
    }
}

/// Rounding of forces over mu N: a few units for each nested branch.
const ROUNDING: f64 = 1e-13;

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn force_and_displacement_are_inverse_and_odd(contact in contact(), exponent in -12.0..0.0f64, near_slip in any::<bool>()) {
        let part = if near_slip { 1.0 - 10f64.powf(exponent) } else { 10f64.powf(exponent) };
        let force = part * contact.slip_force;
        let point = contact.curve_at_force(force).unwrap();
        let back = contact.curve_at_displacement(point.displacement()).unwrap();
        prop_assert!((back.force() / force - 1.0).abs() < 1e-13, "{} {}", back.force(), force);
        prop_assert_eq!(contact.curve_at_force(-force).unwrap().displacement(), -point.displacement());
        prop_assert_eq!(contact.curve_at_displacement(-point.displacement()).unwrap().force(), -back.force());
        prop_assert!(back.stiffness() <= contact.initial_stiffness * (1.0 + 1e-15) && back.stiffness() >= 0.0);
    }

    /// The displacement increases with the force, across the change of formula at mu N/2 and anywhere.
    #[test]
    fn the_curve_rises(contact in contact(), part in prop_oneof![Just(0.5), 1e-6..0.999f64]) {
        let at = |part: f64| contact.curve_at_force(part * contact.slip_force).unwrap();
        let (low, high) = (at(part * (1.0 - 1e-14)), at(part * (1.0 + 1e-14)));
        prop_assert!(low.displacement() < high.displacement());
        prop_assert!(low.compliance() <= high.compliance() * (1.0 + 1e-14));
        let energy = |part: f64| contact.dissipated_energy(part * contact.slip_force).unwrap();
        // 1e-13: error of either energy.
        prop_assert!(energy(part * (1.0 - 1e-14)) <= energy(part * (1.0 + 1e-14)) * (1.0 + 1e-13));
    }

    #[test]
    fn the_tangent_is_the_slope(contact in contact(), part in 0.01..0.97f64) {
        let slip = contact.slip_displacement;
        let h = 1e-5;
        let force = |part: f64| contact.curve_at_displacement(part * slip).unwrap().force();
        let difference = (force(part + h) - force(part - h)) / (2.0 * h * slip);
        let tangent = contact.curve_at_displacement(part * slip).unwrap().stiffness();
        // Truncation h² f'''/6 with f''' up to 1/(1-part)² of the slope, and rounding 1e-16/h.
        prop_assert!((difference - tangent).abs() < 1e-6 * contact.initial_stiffness, "{difference} {tangent}");
    }

    #[test]
    fn tractions_obey_coulomb_and_carry_the_force(contact in contact(), part in 0.0..1.0f64, place in -1.2..1.2f64) {
        let point = contact.curve_at_force(part * contact.slip_force).unwrap();
        let x = place * contact.half_width;
        let (pressure, shear) = (contact.pressure(x), point.shear(x));
        let mu = contact.curve_at_force(contact.slip_force).unwrap().shear(0.0) / contact.pressure(0.0);
        prop_assert!(pressure >= 0.0 && shear >= 0.0);
        prop_assert!(shear <= mu * pressure * (1.0 + 1e-11), "{shear} {}", mu * pressure);
        prop_assert!(place.abs() <= 1.0 || (pressure == 0.0 && shear == 0.0));
    }

    #[test]
    fn coulomb_and_dissipation_in_any_history(contact in contact(), path in path(60)) {
        let mut stepper = Stepper::new(&contact);
        for displacement in path {
            let (force, stiffness, energy) = stepper.step(displacement);
            prop_assert!(force.abs() <= contact.slip_force);
            prop_assert!(energy >= 0.0);
            prop_assert!(stiffness >= 0.0 && stiffness <= contact.initial_stiffness * (1.0 + 1e-15));
        }
    }

    /// The work of a closed loop is the dissipated energy, which is computed separately.
    #[test]
    fn work_around_a_loop_is_dissipated(contact in contact(), amplitude in 0.05..2.0f64) {
        let mut stepper = Stepper::new(&contact);
        stepper.step(amplitude);
        let (mut work, mut dissipated, mut last) = (0.0, 0.0, stepper.step(amplitude).0);
        let steps = 4000;
        for step in 1..=2 * steps {
            // Uniform steps of the phase refine both ends of the branch.
            let phase = PI * step as f64 / steps as f64;
            let before = PI * (step - 1) as f64 / steps as f64;
            let change = amplitude * (phase.cos() - before.cos()) * contact.slip_displacement;
            let (force, _, energy) = stepper.step(amplitude * phase.cos());
            work += 0.5 * (force + last) * change;
            dissipated += energy;
            last = force;
        }
        let expected = contact.complex_stiffness(amplitude * contact.slip_displacement).unwrap().dissipated();
        prop_assert!((dissipated / expected - 1.0).abs() < 1e-10, "{dissipated} {expected}");
        // The error of the trapezoidal rule is (pi/4000)² of the elastic work.
        let elastic = contact.slip_force * amplitude * contact.slip_displacement;
        prop_assert!((work - expected).abs() < 5e-6 * elastic, "{work} {expected}");
    }

    #[test]
    fn steps_may_be_divided(contact in contact(), path in path(20), parts in 2..7usize) {
        let (mut whole, mut divided) = (Stepper::new(&contact), Stepper::new(&contact));
        let mut last = 0.0;
        for displacement in path {
            let (force, _, energy) = whole.step(displacement);
            let mut sum = 0.0;
            let mut end = (0.0, 0.0, 0.0);
            for part in 1..=parts {
                let between = last + (displacement - last) * part as f64 / parts as f64;
                end = divided.step(if part == parts { displacement } else { between });
                sum += end.2;
            }
            prop_assert!((end.0 - force).abs() <= ROUNDING * contact.slip_force);
            let scale = contact.slip_energy + contact.slip_force * contact.slip_displacement;
            prop_assert!((sum - energy).abs() <= ROUNDING * scale * (1.0 + displacement.abs()));
            last = displacement;
        }
        // Only reversals are stored.
        prop_assert_eq!(whole.used(), divided.used());
    }

    #[test]
    fn a_closed_loop_is_erased(contact in contact(), path in path(12), inner in 0.01..0.9f64) {
        let mut stepper = Stepper::new(&contact);
        let mut before = 0.0;
        let mut last = 0.0;
        for displacement in path {
            stepper.step(displacement);
            (before, last) = (last, displacement);
        }
        prop_assume!(last != before);
        let (force, stiffness, _) = stepper.step(last);
        let memory = stepper.used().to_vec();
        // An inner loop leaves the memory as it was, to the bit.
        stepper.step(last + inner * (before - last));
        let (again, same, _) = stepper.step(last);
        let gross_slip = force.abs() >= contact.slip_force;
        prop_assert!((again - force).abs() <= ROUNDING * contact.slip_force);
        prop_assert!(gross_slip || (same - stiffness).abs() <= 1e-9 * contact.initial_stiffness);
        prop_assert!(gross_slip || stepper.used() == memory);
    }

    #[test]
    fn odd_symmetry_and_steps_of_zero(contact in contact(), path in path(30)) {
        let (mut one, mut mirrored) = (Stepper::new(&contact), Stepper::new(&contact));
        for displacement in path {
            let (force, stiffness, energy) = one.step(displacement);
            prop_assert_eq!(mirrored.step(-displacement), (-force, stiffness, energy));
            let state = one.state.clone();
            prop_assert_eq!(one.step(displacement), (force, stiffness, 0.0));
            prop_assert_eq!(&one.state, &state);
        }
    }

    #[test]
    fn the_loop_is_the_memory_in_steady_state(contact in contact(), amplitude in 0.01..3.0f64) {
        let mut stepper = Stepper::new(&contact);
        let n = 64;
        for i in 0..2 * n {
            let cycle = contact.hysteresis_loop(amplitude * contact.slip_displacement).unwrap();
            let (displacement, force) = (cycle.displacement(i, n), cycle.force(i, n));
            let (stepped, ..) = stepper.step(displacement / contact.slip_displacement);
            if i > n {
                prop_assert!((stepped - force).abs() <= 1e-12 * contact.slip_force, "{i}: {stepped} {force}");
            }
        }
    }

    #[test]
    fn the_complex_stiffness_is_the_first_harmonic(contact in contact(), amplitude in 0.02..2.5f64) {
        let amplitude = amplitude * contact.slip_displacement;
        let (force, _, energy) = harmonic(&contact, Rule::UniformSampling, 512, &[0.0, amplitude, 0.0]);
        let stiffness = contact.complex_stiffness(amplitude).unwrap();
        let size = contact.initial_stiffness;
        // The sampling error is O(samples⁻²).
        prop_assert!((force[1] / amplitude - stiffness.real()).abs() < 2e-4 * size);
        prop_assert!((-force[2] / amplitude - stiffness.imaginary()).abs() < 2e-4 * size);
        prop_assert!((energy / stiffness.dissipated() - 1.0).abs() < 1e-9);
    }

    /// One harmonic of any amplitude and phase by the event-driven rule: the complex stiffness, and the energy.
    #[test]
    fn the_event_driven_first_harmonic_is_exact(
        contact in contact(), amplitude in 0.02..2.5f64, phase in 0.0..6.3f64, harmonics in 1..6usize,
    ) {
        let amplitude = amplitude * contact.slip_displacement;
        let (sine, cosine) = phase.sin_cos();
        let mut displacement = vec![0.0; 2 * harmonics + 1];
        (displacement[1], displacement[2]) = (amplitude * cosine, amplitude * sine);
        let (force, _, energy) = harmonic(&contact, Rule::EventDriven, 64, &displacement);
        let stiffness = contact.complex_stiffness(amplitude).unwrap();
        let real = (cosine * force[1] + sine * force[2]) / amplitude;
        let imaginary = (sine * force[1] - cosine * force[2]) / amplitude;
        // Largest for a reversal just before gross slip: the integrand is nearly singular.
        let size = contact.initial_stiffness;
        prop_assert!((real - stiffness.real()).abs() < 1e-8 * size, "{} {}", real / size, stiffness.real() / size);
        prop_assert!((imaginary - stiffness.imaginary()).abs() < 1e-8 * size);
        prop_assert!((energy / stiffness.dissipated() - 1.0).abs() < 1e-9);
    }

    #[test]
    fn derivatives_of_the_complex_stiffness(contact in contact(), amplitude in prop_oneof![0.02..0.9f64, 1.1..4.0f64]) {
        let slip = contact.slip_displacement;
        let h = 1e-5 * amplitude;
        let at = |amplitude: f64| contact.complex_stiffness(amplitude * slip).unwrap();
        let (low, here, high) = (at(amplitude - h), at(amplitude), at(amplitude + h));
        let scale = contact.initial_stiffness / slip / amplitude;
        let real = (high.real() - low.real()) / (2.0 * h * slip);
        let imaginary = (high.imaginary() - low.imaginary()) / (2.0 * h * slip);
        // Truncation (1e-5)² times a third derivative of up to 1e3, and rounding 1e-15/1e-5.
        prop_assert!((here.d_real() - real).abs() < 1e-6 * scale, "{} {real}", here.d_real());
        prop_assert!((here.d_imag() - imaginary).abs() < 1e-6 * scale, "{} {imaginary}", here.d_imag());
        prop_assert!(here.d_real() <= 0.0);
    }

    /// The definition: the second of two periods from the unloaded state, step by step.
    #[test]
    fn the_harmonic_force_is_that_of_the_second_period(
        contact in contact(),
        shape in prop::collection::vec(-1.0..1.0f64, 9),
        size in 0.05..3.0f64,
        samples in 9..70usize,
        odd in any::<bool>(),
    ) {
        let present = |k: usize| !odd || k.div_ceil(2) % 2 == 1;
        let displacement: Vec<f64> = (0..9)
            .map(|k| if present(k) { size * shape[k] / 3.0 * contact.slip_displacement } else { 0.0 })
            .collect();
        let (force, _, energy) = harmonic(&contact, Rule::UniformSampling, samples, &displacement);
        let row = |sample: usize| -> Vec<f64> {
            (0..9usize)
                .map(|k| {
                    let periods = (k.div_ceil(2) * (sample % samples) % samples) as f64 / samples as f64;
                    let (sine, cosine) = (2.0 * PI * periods).sin_cos();
                    if k == 0 || k % 2 == 1 { cosine } else { sine }
                })
                .collect()
        };
        let mut stepper = Stepper::new(&contact);
        let (mut sums, mut dissipated) = ([0.0; 9], 0.0);
        for sample in 0..2 * samples {
            let row = row(sample);
            let displacement: f64 = row.iter().zip(&displacement).map(|(table, c)| table * c).sum();
            let (now, _, energy_of_step) = stepper.step(displacement / contact.slip_displacement);
            if sample >= samples {
                sums.iter_mut().zip(&row).for_each(|(sum, table)| *sum += now * table);
                dissipated += energy_of_step;
            }
        }
        for (k, (sum, force)) in sums.iter().zip(force).enumerate() {
            let mean = if k == 0 { 1.0 } else { 2.0 } / samples as f64;
            // Displacements are summed in another order; near gross slip that changes the force by more than its rounding error.
            prop_assert!((sum * mean - force).abs() < 1e-11 * contact.slip_force, "{k}: {} {force}", sum * mean);
        }
        prop_assert!((dissipated - energy).abs() < 1e-9 * (energy + 1e-3 * contact.slip_energy), "{dissipated} {energy}");
    }

    /// The Jacobian of a history that nests and slips, against central differences.
    #[test]
    fn the_jacobian_is_exact(contact in contact(), shape in prop::collection::vec(-1.0..1.0f64, 7), size in 0.1..1.5f64) {
        let slip = contact.slip_displacement;
        let displacement: Vec<f64> = shape.iter().map(|c| c * size * slip).collect();
        let evaluate = |displacement: &[f64]| harmonic(&contact, Rule::UniformSampling, 48, displacement);
        let (_, jacobian, _) = evaluate(&displacement);
        let mut off = 0;
        for j in 0..7 {
            let h = 1e-7 * slip;
            let moved = |sign: f64| {
                let mut moved = displacement.clone();
                moved[j] += sign * h;
                moved
            };
            let (low, high) = (evaluate(&moved(-1.0)).0, evaluate(&moved(1.0)).0);
            for i in 0..7 {
                let difference = (high[i] - low[i]) / (2.0 * h);
                // One sample of 48 at a kink (start or end of gross slip) makes a one-sided derivative of the difference.
                off += usize::from((difference - jacobian[i + 7 * j]).abs() > 1e-5 * contact.initial_stiffness);
            }
        }
        prop_assert!(off <= 7, "{off} of 49: {:?}", displacement.iter().map(|c| c/slip).collect::<Vec<_>>());
    }

    #[test]
    fn jenkins_has_the_complex_stiffness(contact in contact(), amplitude in 0.001..20.0f64) {
        let amplitude = amplitude * contact.slip_displacement;
        let stiffness = contact.complex_stiffness(amplitude).unwrap();
        let slider = equivalents::jenkins(&contact, amplitude).unwrap();
        let part = slider.slip_force / (slider.stiffness * amplitude);
        prop_assert!((0.0..=1.0).contains(&part));
        let theta = 2.0 * part.sqrt().asin();
        let real = slider.stiffness / PI * (theta - theta.sin() * theta.cos());
        let imaginary = 4.0 * slider.stiffness / PI * part * (1.0 - part);
        prop_assert!((real - stiffness.real()).abs() < 1e-12 * slider.stiffness);
        prop_assert!((imaginary - stiffness.imaginary()).abs() < 1e-12 * slider.stiffness);
    }

    #[test]
    fn iwan_has_the_reported_error(contact in contact(), n in 1..40usize) {
        let mut sliders = Vec::new();
        let error = equivalents::iwan(&contact, n, |slider| sliders.push(slider)).unwrap();
        prop_assert_eq!(sliders.len(), n);
        let total: f64 = sliders.iter().map(|slider| slider.slip_force).sum();
        prop_assert!((total / contact.slip_force - 1.0).abs() < 1e-9, "{}", total / contact.slip_force);
        let bank = |u: f64| sliders.iter().map(|slider| (slider.stiffness * u).min(slider.slip_force)).sum::<f64>();
        let mut worst: f64 = 0.0;
        for k in 0..=2000 {
            let u = k as f64 / 1000.0 * contact.slip_displacement;
            let force = contact.curve_at_displacement(u).unwrap().force();
            worst = worst.max((bank(u) - force).abs() / contact.slip_force);
        }
        prop_assert!(worst <= error * (1.0 + 1e-6) + 1e-12, "{worst} {error}");
        prop_assert!(worst >= 0.5 * error - 1e-9, "{worst} {error}");
    }
}
