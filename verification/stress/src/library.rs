//! The functions of the C interface, with floating-point traps.

use crate::Outcome;
use microslip::ffi::{self, mslip_contact};
use reference::Input;
use std::mem::MaybeUninit;
use std::ptr::null_mut;

/// Rounding of a force over mu N for each branch: the curve has an error of 1.5e-15 (see the tests of the interpolant) and is
/// doubled, and sums round by a unit.
pub const BRANCH_ROUNDING: f64 = 4e-15;

/// A call with traps for invalid operations, divisions by zero and overflows, which end the program.
#[inline]
pub fn trapped<T>(call: impl FnOnce() -> T) -> T {
    /// Control words of SSE: all exceptions masked, or all but those of subnormal, underflowing and inexact numbers.
    const MASKED: u32 = 0x1f80;
    const TRAPPED: u32 = 0x1f80 & !(0x080 | 0x200 | 0x400);
    set_control(TRAPPED);
    let result = call();
    set_control(MASKED);
    result
}

/// `Ok` if the status of a call with traps is 0.
#[inline]
fn accepted(call: impl FnOnce() -> i32) -> Outcome {
    let status = trapped(call);
    if status == ffi::MSLIP_OK { Ok(()) } else { Err(format!("rejected with status {status}")) }
}

#[cfg(target_arch = "x86_64")]
fn set_control(word: u32) {
    // SAFETY: a valid word, which changes the trapped exceptions only.
    unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const word, options(nostack)) }
}

/// Elsewhere exceptions are not trapped.
#[cfg(not(target_arch = "x86_64"))]
fn set_control(_: u32) {}

/// An initialised contact.
pub struct Contact {
    pub name: &'static str,
    pub input: Input,
    prepared: mslip_contact,
}

impl Contact {
    pub fn new(name: &'static str, input: Input) -> Contact {
        let mut prepared = MaybeUninit::<mslip_contact>::uninit();
        let contact = prepared.as_mut_ptr();
        // SAFETY: both pointers are valid.
        let outcome = accepted(|| unsafe {
            match &input {
                Input::Flat(parameters) => ffi::mslip_contact_init(parameters, contact),
                Input::Ellipse(parameters) => ffi::mslip_contact_init_elliptic(parameters, contact),
            }
        });
        outcome.unwrap_or_else(|error| panic!("{name}: {error}: {input:?}"));
        // SAFETY: initialised by the call that accepts it.
        Contact { name, input, prepared: unsafe { prepared.assume_init() } }
    }

    /// mu N.
    pub fn slip_force(&self) -> f64 {
        self.prepared.slip_force
    }

    /// Displacement of gross slip.
    pub fn slip(&self) -> f64 {
        self.prepared.slip_displacement
    }

    pub fn stiffness(&self) -> f64 {
        self.prepared.initial_stiffness
    }

    /// Energy of a cycle at incipient gross slip.
    pub fn slip_energy(&self) -> f64 {
        self.prepared.slip_energy
    }

    /// Force and stiffness on the monotonic curve.
    pub fn monotonic(&self, displacement: f64) -> Result<(f64, f64), String> {
        let (mut force, mut stiffness) = (f64::NAN, f64::NAN);
        // SAFETY: pointers to one double each.
        accepted(|| unsafe {
            ffi::mslip_monotonic_force(&self.prepared, 1, &displacement, &mut force, &mut stiffness, null_mut())
        })?;
        Ok((force, stiffness))
    }
}

/// Results of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    pub force: f64,
    pub stiffness: f64,
    pub dissipated: f64,
}

/// A state.
#[derive(Clone)]
pub struct State(Vec<f64>);

/// Doubles before the reversals of a state: tag with the number of reversals, displacement, slip direction, force, offset.
const HEADER: usize = 5;
/// Displacement, force and error.
const PER_REVERSAL: usize = 3;

impl State {
    /// An unloaded state that holds the given number of nested reversals.
    pub fn new(reversals: usize) -> State {
        let mut state = vec![f64::NAN; ffi::mslip_state_length(reversals)];
        // SAFETY: as long as given.
        let outcome = accepted(|| unsafe { ffi::mslip_state_init(state.len(), state.as_mut_ptr()) });
        outcome.expect("a state");
        State(state)
    }

    pub fn depth(&self) -> usize {
        (self.0[0].to_bits() & 0xff_ffff_ffff) as usize
    }

    /// Whether the newest branch is that of gross slip.
    pub fn slips(&self) -> bool {
        self.depth() == 0 && self.0[2] != 0.0
    }

    pub fn displacement(&self) -> f64 {
        self.0[1]
    }

    /// The part that is in use.
    pub fn used(&self) -> &[f64] {
        &self.0[..HEADER + PER_REVERSAL * self.depth()]
    }

    /// Its bits, except for the sign of a zero.
    pub fn bits(&self) -> Vec<u64> {
        self.used().iter().map(|value| (value + 0.0).to_bits()).collect()
    }

    /// Whether it is the negative of another state, except for the sign of a zero.
    pub fn is_mirror_of(&self, other: &State) -> bool {
        let (one, two) = (self.used(), other.used());
        one[0] == two[0] && one[1..].iter().zip(&two[1..]).all(|(a, b)| *a == -*b)
    }

    /// One step, in place.
    pub fn step(&mut self, contact: &Contact, displacement: f64) -> Result<Response, String> {
        let mut response = Response { force: f64::NAN, stiffness: f64::NAN, dissipated: f64::NAN };
        let Response { force, stiffness, dissipated } = &mut response;
        let (length, state) = (self.0.len(), self.0.as_mut_ptr());
        // SAFETY: a state as long as given, updated in place; outputs of a double each.
        accepted(|| unsafe {
            ffi::mslip_masing_update(
                &contact.prepared,
                length,
                state,
                displacement,
                state,
                force,
                stiffness,
                dissipated,
            )
        })?;
        Ok(response)
    }
}
