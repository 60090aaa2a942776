//! Physical invariants of a valid contact under any load history.
#![no_main]

use libfuzzer_sys::arbitrary::{self, Arbitrary};
use libfuzzer_sys::{Corpus, fuzz_target};
use microslip::ffi::*;
use microslip_fuzz::{Choice, Path};
use std::ptr::null_mut;

#[derive(Arbitrary, Debug)]
struct Input {
    contact: Choice,
    path: Path,
    parts: u8,
}

/// A state and its contact.
struct Stepper<'a> {
    contact: &'a mslip_contact,
    state: Vec<f64>,
}

impl Stepper<'_> {
    fn new(contact: &mslip_contact, reversals: usize) -> Stepper<'_> {
        let mut state = vec![f64::NAN; mslip_state_length(reversals)];
        assert!(unsafe { mslip_state_init(state.len(), state.as_mut_ptr()) } == MSLIP_OK);
        Stepper { contact, state }
    }

    /// Force, tangent stiffness and dissipated energy of each step of a path, in one call; the last state may be discarded.
    fn path(&mut self, path: &[f64], kept: bool) -> Vec<[f64; 3]> {
        let mut outputs = [(); 3].map(|()| vec![f64::NAN; path.len()]);
        let [force, stiffness, dissipated] = outputs.each_mut().map(|output| output.as_mut_ptr());
        let (n, old) = (self.state.len(), self.state.as_mut_ptr());
        let new = if kept { old } else { null_mut() };
        let status = unsafe {
            mslip_masing_path(self.contact, n, old, path.len(), path.as_ptr(), new, force, stiffness, dissipated)
        };
        assert!(status == MSLIP_OK, "{status}");
        (0..path.len()).map(|i| outputs.each_ref().map(|output| output[i])).collect()
    }

    /// One step.
    fn step(&mut self, displacement: f64) -> [f64; 3] {
        let [mut force, mut stiffness, mut dissipated] = [f64::NAN; 3];
        let (n, state) = (self.state.len(), self.state.as_mut_ptr());
        let (f, k, d) = (&mut force, &mut stiffness, &mut dissipated);
        let status = unsafe { mslip_masing_update(self.contact, n, state, displacement, state, f, k, d) };
        assert!(status == MSLIP_OK, "{status}");
        [force, stiffness, dissipated]
    }

    /// The values in use: a header of 5 doubles, whose first holds the number of reversals in its last 40 bits, and 3 for each.
    fn used(&self) -> &[f64] {
        &self.state[..5 + 3 * (self.state[0].to_bits() & 0xff_ffff_ffff) as usize]
    }

    /// Bound on the error of the force due to removed reversals.
    fn error(&self) -> f64 {
        let mut error = f64::NAN;
        assert!(unsafe { mslip_state_error(self.state.len(), self.state.as_ptr(), &mut error) } == MSLIP_OK);
        error
    }
}

// Coulomb's bound, dissipation, steps in parts, one call for all steps, and small states.
fuzz_target!(|input: Input| -> Corpus {
    let Some((_, contact)) = input.contact.contact() else { return Corpus::Reject };
    if contact.slip_force <= 0.0 {
        return Corpus::Reject;
    }
    let mut path = input.path.displacements(contact.slip_displacement);
    path.retain(|displacement| displacement.abs() <= 1e150);
    let c_contact = mslip_contact::from(contact);
    let parts = usize::from(input.parts % 4) + 1;
    let [mut whole, mut divided, mut at_once] = [(); 3].map(|()| Stepper::new(&c_contact, path.len()));
    let mut small = Stepper::new(&c_contact, 2 + path.len() % 7);
    let (limit, stiffest) = (contact.slip_force, contact.initial_stiffness);
    let farthest = path.iter().fold(0.0, |farthest: f64, displacement| farthest.max(displacement.abs()));
    let mut steps = Vec::new();
    let mut last = 0.0;
    for &displacement in &path {
        let step = whole.step(displacement);
        let [force, stiffness, energy] = step;
        assert!(force.abs() <= limit, "{force:e} exceeds {limit:e}");
        assert!(stiffness >= 0.0 && stiffness <= stiffest * (1.0 + 1e-15), "{stiffness:e} exceeds {stiffest:e}");
        assert!(energy >= 0.0 && energy.is_finite(), "dissipated {energy:e}");
        steps.push(step);

        let ([merged, ..], error) = (small.step(displacement), small.error());
        assert!(whole.error() == 0.0 && (error > 0.0 || merged == force), "{merged:e} instead of {force:e}");
        // Displacements far from the initial one round the ranges of their branches.
        let rounding = 4e-15 * limit + 4.0 * f64::EPSILON * farthest * stiffest;
        assert!((merged - force).abs() <= error + rounding, "{merged:e} instead of {force:e}, bound {error:e}");
        let checked = unsafe { mslip_state_check(small.state.len(), small.state.as_ptr()) };
        assert!(checked == MSLIP_OK, "{:?}", small.state);

        let mut sum = 0.0;
        for part in 1..parts {
            let between = last + (displacement - last) * (part as f64 / parts as f64);
            sum += divided.step(between.max(last.min(displacement)).min(last.max(displacement)))[2];
        }
        let end = divided.step(displacement);
        sum += end[2];
        assert_eq!(end[..2], [force, stiffness], "in parts");
        assert_eq!(divided.used(), whole.used(), "in parts");
        // The energies are differences of those of loops.
        let scale = limit * (contact.slip_displacement + (displacement - last).abs());
        assert!((sum - energy).abs() <= 1e-12 * scale, "dissipated {sum:e} in parts, {energy:e} in one step");
        last = displacement;
    }
    // A path whose last state is discarded has room for 128 reversals.
    assert!(path.len() > 128 || at_once.path(&path, false) == steps, "in one call, discarded");
    assert_eq!(at_once.path(&path, true), steps, "in one call");
    assert_eq!(at_once.used(), whole.used(), "in one call");
    Corpus::Keep
});
