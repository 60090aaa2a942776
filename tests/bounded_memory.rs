//! A state of few reversals against one with the whole history: the forces are equal until reversals are merged, then differ by no
//! more than the error that the state reports.
//!
//! `MICROSLIP_CYCLES` sets the number of cycles of a decaying vibration; 1000000 is the full test.

mod common;

use common::{Random, step, unloaded};
use microslip::constant_load::state::{state_check, state_error};
use microslip::{Contact, EllipticParameters, Material, Parameters};
use std::sync::Mutex;

const REVERSALS: [usize; 3] = [2, 8, 32];
/// Displacement amplitudes over the displacement of gross slip.
const AMPLITUDES: [f64; 4] = [0.5, 0.75, 0.9, 1.0];
/// Relative decay over all cycles: 1e-9, 1e-6 and 1e-3 per cycle in 1e6 cycles.
const DECAYS: [f64; 3] = [1e-3, 1.0, 1e3];
/// Rounding of the force over mu N that the reported error need not cover.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

fn contacts() -> [(&'static str, Contact); 4] {
    let material = [Material { young_modulus: 2.1e11, poisson_ratio: 0.3 }; 2];
    let flat = |flat_half_width: f64, length: f64| {
        let parameters = Parameters {
            flat_half_width,
            edge_radius: 5e-3,
            length,
            normal_force: 1e5 * length,
            friction_coefficient: 0.5,
            material,
            displacement_reference: microslip::parameters::CENTRE_POINT,
            ..Parameters::default()
        };
        Contact::rounded_flat(&parameters).unwrap()
    };
    let cylinder = flat(0.0, 0.02);
    // ln(2L/b) + nu/(1 - nu) = 1.
    let slim = flat(0.0, 0.5 * cylinder.half_width * (1.0_f64 - 0.3 / 0.7).exp());
    let sphere = EllipticParameters {
        semi_axis_x: 2e-4,
        semi_axis_y: 2e-4,
        normal_force: 100.0,
        friction_coefficient: 0.5,
        material,
        ..EllipticParameters::default()
    };
    let sphere = Contact::elliptic(&sphere).unwrap();
    [("cylinder", cylinder), ("flat", flat(2e-4, 0.02)), ("slim cylinder", slim), ("sphere", sphere)]
}

/// A state of few reversals, and the largest values over mu N seen in it.
struct Bounded {
    state: Vec<f64>,
    reported: f64,
    difference: f64,
    /// Difference beyond the reported error.
    excess: f64,
}

/// The same history in a state that holds all reversals and in states that do not.
struct Histories<'c> {
    contact: &'c Contact,
    exact: Vec<f64>,
    bounded: Vec<Bounded>,
}

/// Advances a state; force and stiffness.
fn advance(contact: &Contact, state: &mut [f64], displacement: f64) -> [f64; 2] {
    let step = step(contact, state, displacement);
    step.write(state);
    [step.force(), step.stiffness()]
}

impl<'c> Histories<'c> {
    fn new(contact: &'c Contact, longest: usize, reversals: &[usize]) -> Histories<'c> {
        let bounded = |&reversals: &usize| Bounded {
            state: unloaded(reversals),
            reported: 0.0,
            difference: 0.0,
            excess: f64::NEG_INFINITY,
        };
        Histories { contact, exact: unloaded(longest), bounded: reversals.iter().map(bounded).collect() }
    }

    /// Advances all states to a displacement over that of gross slip.
    fn advance(&mut self, displacement: f64) {
        let displacement = displacement * self.contact.slip_displacement;
        let expected = advance(self.contact, &mut self.exact, displacement);
        for bounded in &mut self.bounded {
            let found = advance(self.contact, &mut bounded.state, displacement);
            let reported = state_error(&bounded.state).unwrap() / self.contact.slip_force;
            if reported == 0.0 {
                assert_eq!(found, expected, "no reversals were merged");
            }
            let difference = (found[0] - expected[0]).abs() / self.contact.slip_force;
            bounded.reported = bounded.reported.max(reported);
            bounded.difference = bounded.difference.max(difference);
            bounded.excess = bounded.excess.max(difference - reported);
        }
    }

    /// Asserts that no state remembers anything but the present point.
    fn assert_memory_is_erased(&self) {
        for bounded in &self.bounded {
            assert_eq!(state_error(&bounded.state), Ok(0.0));
            assert_eq!(bounded.state.first_chunk::<5>(), self.exact.first_chunk::<5>());
        }
    }
}

/// Amplitudes of half cycles: decaying from 1 over the given number of cycles, then growing through values in between, and
/// beyond 1 in the end.
fn decaying(cycles: usize, decay: f64) -> impl Iterator<Item = f64> {
    let amplitude = move |half_cycle: f64| (-decay * half_cycle / (2 * cycles) as f64).exp();
    (0..2 * cycles)
        .map(move |k| amplitude(k as f64))
        .chain((0..2 * cycles).rev().map(move |k| amplitude(k as f64 + 0.25)))
        .chain([1.0 + 1e-9, 1.0 + 2e-9])
        .zip([1.0, -1.0].into_iter().cycle())
        .map(|(amplitude, side)| amplitude * side)
}

#[test]
fn a_decaying_vibration() {
    let cycles = std::env::var("MICROSLIP_CYCLES").map_or(2000, |text| text.parse().unwrap());
    let contacts = contacts();
    let runs: Vec<(usize, f64, f64)> = (0..contacts.len())
        .flat_map(|contact| AMPLITUDES.map(|amplitude| (contact, amplitude)))
        .flat_map(|(contact, amplitude)| DECAYS.map(|decay| (contact, amplitude, decay)))
        .collect();
    let (next, results) = (Mutex::new(runs.iter()), Mutex::new(Vec::new()));
    let work = || {
        loop {
            let run = next.lock().unwrap().next();
            let Some(&(contact, amplitude, decay)) = run else { break };
            let mut histories = Histories::new(&contacts[contact].1, 2 * cycles, &REVERSALS);
            decaying(cycles, decay).for_each(|displacement| histories.advance(amplitude * displacement));
            histories.assert_memory_is_erased();
            for (reversals, bounded) in REVERSALS.into_iter().zip(&histories.bounded) {
                let Bounded { reported, difference, excess, .. } = *bounded;
                let case = (contacts[contact].0, amplitude, decay / cycles as f64, reversals);
                results.lock().unwrap().push((case, reported, difference, excess));
            }
        }
    };
    std::thread::scope(|scope| [(); 2].map(|()| scope.spawn(work)).map(|thread| thread.join().unwrap()));
    let mut results = results.into_inner().unwrap();
    results.sort_by(|one, other| one.partial_cmp(other).unwrap());
    println!(
        "over mu N: contact, amplitude, decay per cycle, reversals, reported error, difference, excess of the difference"
    );
    for ((contact, amplitude, decay, reversals), reported, difference, excess) in &results {
        println!(
            "{contact:14} {amplitude:4} {decay:6.0e} {reversals:2}  {reported:.1e} {difference:.1e} {excess:8.1e}"
        );
    }
    for ((contact, amplitude, decay, reversals), reported, _, excess) in results {
        assert!(excess <= ROUNDING, "{contact}, {amplitude}, {decay:e}, {reversals} reversals: {excess:e}");
        let limit = if reversals == 32 { 0.01 } else { f64::INFINITY };
        assert!(reported <= limit, "{contact}, {amplitude}, {decay:e}, {reversals} reversals: {reported:e}");
    }
}

#[test]
fn random_histories() {
    for (name, contact) in contacts() {
        let mut worst = f64::NEG_INFINITY;
        for seed in 0..3000 {
            let mut random = Random(seed);
            let reversals: Vec<usize> = (2..=8).collect();
            let steps = 20 + random.below(100);
            let mut histories = Histories::new(&contact, steps, &reversals);
            // Nested, nearly nested, or any reversals; in some histories after gross slip.
            let (mut low, mut high) = (-1.0, 1.0);
            if random.below(2) == 0 {
                histories.advance(3.0 * random.signed());
            }
            let kind = random.below(3);
            let mut displacement: f64 = 0.0;
            let mut path = Vec::new();
            for step in 0..steps {
                let share = random.next();
                let share = if kind == 1 { share.powi(4) } else { share };
                let target = match kind {
                    0 => random.signed(),
                    1 if step % 2 == 0 => high - share * (high - displacement).max(0.0),
                    1 => low + share * (displacement - low).max(0.0),
                    _ => (displacement + 0.5 * random.signed()).clamp(-1.0, 1.0),
                };
                (low, high) = if step % 2 == 0 { (low, target) } else { (target, high) };
                if random.below(30) == 0 {
                    (low, high) = (-1.0, 1.0);
                }
                displacement = target;
                path.push(target);
                histories.advance(target);
            }
            for bounded in &histories.bounded {
                assert_eq!(state_check(&bounded.state), Ok(()));
                assert!(
                    bounded.excess <= ROUNDING,
                    "{name}, seed {seed}: {:e} beyond {:e}, {path:?}",
                    bounded.excess,
                    bounded.reported
                );
                worst = worst.max(bounded.excess);
            }
            histories.advance(5.0);
            histories.assert_memory_is_erased();
        }
        println!("{name}: {worst:.1e} of mu N beyond the reported error");
    }
}
