//! Properties of every contact and every history that a comparison with exact values does not show: symmetry, memory of divided
//! steps, and both rules of the harmonic force. `verification/accuracy` has the values, `verification/stress` the bounds.

mod common;

use common::{advance, harmonic, unloaded};
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
    #![proptest_config(common::random_cases(400))]

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
    fn odd_symmetry_and_steps_of_zero(contact in contact(), path in path(30)) {
        let (mut one, mut mirrored) = (Stepper::new(&contact), Stepper::new(&contact));
        for displacement in path {
            let (force, stiffness, energy) = one.step(displacement);
            prop_assert_eq!(mirrored.step(-displacement), (-force, stiffness, energy));
            let state = one.state.clone();
            prop_assert_eq!(one.step(displacement), (force, stiffness, 0.0));
            prop_assert_eq!(&one.state, &state);
            let [up, down] = [displacement, -displacement].map(|u| contact.curve_at_displacement(u * contact.slip_displacement).unwrap());
            prop_assert_eq!(down.force(), -up.force());
            let [up, down] = [force, -force].map(|force| contact.curve_at_force(force).unwrap().displacement());
            prop_assert_eq!(down, -up);
        }
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
}
