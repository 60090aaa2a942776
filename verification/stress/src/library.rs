//! The functions of the C interface, with floating-point traps.

use crate::Outcome;
use microslip::ffi::{self, mslip_contact};
use reference::Input;
use std::fmt::{self, Debug, Formatter};
use std::mem::MaybeUninit;
use std::ptr::{self, null, null_mut};
use std::sync::Arc;

/// Rounding of a force over mu N for each branch: the curve has an error of 1.5e-15 (see the tests of the interpolant) and is
/// doubled, and sums round by a unit.
pub const BRANCH_ROUNDING: f64 = 4e-15;

/// `Ok` if the status of a call is 0.
pub fn accepted(status: i32) -> Outcome {
    if status == ffi::MSLIP_OK { Ok(()) } else { Err(format!("rejected with status {status}")) }
}

/// An initialised contact.
#[derive(Clone)]
pub struct Contact {
    pub input: Input,
    prepared: Arc<mslip_contact>,
}

impl Debug for Contact {
    fn fmt(&self, formatter: &mut Formatter) -> fmt::Result {
        self.input.fmt(formatter)
    }
}

impl Contact {
    pub fn new(input: Input) -> Result<Contact, String> {
        let mut prepared = Box::new(MaybeUninit::<mslip_contact>::uninit());
        let contact = prepared.as_mut_ptr();
        // SAFETY: both pointers are valid; a contact is initialised by the call that accepts it.
        let status = trapped(|| unsafe {
            match &input {
                Input::Flat(parameters) => ffi::mslip_contact_init(parameters, contact),
                Input::Ellipse(parameters) => ffi::mslip_contact_init_elliptic(parameters, contact),
            }
        });
        accepted(status)?;
        Ok(Contact { input, prepared: unsafe { prepared.assume_init() }.into() })
    }

    pub fn as_c(&self) -> &mslip_contact {
        &self.prepared
    }

    /// A copy of its bytes, as applications keep it in an array.
    pub fn copied(&self) -> mslip_contact {
        // SAFETY: a contact is plain data that may be copied.
        unsafe { ptr::read(self.as_c()) }
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
        accepted(trapped(|| unsafe {
            ffi::mslip_monotonic_force(self.as_c(), 1, &displacement, &mut force, &mut stiffness, null_mut())
        }))?;
        Ok((force, stiffness))
    }

    /// Energy of a cycle of an amplitude, and its error by the rounding of the force amplitude: `dE/dF = 4 (F dδ/dF - δ)`.
    pub fn cycle_energy(&self, amplitude: f64) -> Result<(f64, f64), String> {
        let (mut force, mut stiffness, mut energy) = (0.0, 0.0, 0.0);
        let sticks = amplitude.min(self.slip());
        // SAFETY: pointers to one double each.
        accepted(trapped(|| unsafe {
            ffi::mslip_monotonic_force(self.as_c(), 1, &sticks, &mut force, &mut stiffness, null_mut())
        }))?;
        // SAFETY: as above.
        accepted(trapped(|| unsafe { ffi::mslip_dissipated_energy(self.as_c(), 1, &force, &mut energy) }))?;
        // At gross slip the force amplitude is mu N exactly.
        let rounding =
            if sticks < self.slip() { 4.0 * (force / stiffness - sticks).abs() * BRANCH_ROUNDING * force } else { 0.0 };
        Ok((energy + 4.0 * self.slip_force() * (amplitude - sticks), rounding))
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
#[derive(Clone, PartialEq)]
pub struct State(pub Vec<f64>);

/// Doubles before the reversals of a state: tag with the number of reversals, displacement, slip direction, force, offset.
const HEADER: usize = 5;
/// Displacement, force and error.
const PER_REVERSAL: usize = 3;

impl State {
    /// An unloaded state that holds the given number of nested reversals.
    pub fn new(reversals: usize) -> State {
        let mut state = vec![f64::NAN; ffi::mslip_state_length(reversals)];
        // SAFETY: as long as given.
        let status = trapped(|| unsafe { ffi::mslip_state_init(state.len(), state.as_mut_ptr()) });
        assert_eq!(status, ffi::MSLIP_OK);
        State(state)
    }

    /// The same state in an array of another length.
    pub fn moved(&self, reversals: usize) -> State {
        let mut other = State::new(reversals);
        let used = self.used().len();
        other.0[..used].copy_from_slice(self.used());
        other
    }

    pub fn depth(&self) -> usize {
        (self.0[0].to_bits() & 0xff_ffff_ffff) as usize
    }

    /// Reversals that it can hold.
    pub fn capacity(&self) -> usize {
        (self.0.len() - HEADER) / PER_REVERSAL
    }

    /// Whether the newest branch is that of gross slip.
    pub fn slips(&self) -> bool {
        self.depth() == 0 && self.0[2] != 0.0
    }

    pub fn displacement(&self) -> f64 {
        self.0[1]
    }

    /// Bound on the error of the force by merged reversals, as reported.
    pub fn error(&self) -> f64 {
        let mut error = f64::NAN;
        // SAFETY: pointers to as many doubles as given.
        let status = trapped(|| unsafe { ffi::mslip_state_error(self.0.len(), self.0.as_ptr(), &mut error) });
        assert_eq!(status, ffi::MSLIP_OK);
        error
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

    /// One step from this state; without `new` the new state is discarded, without an output that is not computed.
    #[inline]
    fn update(
        &self,
        contact: &Contact,
        displacement: f64,
        new: *mut f64,
        [force, stiffness, dissipated]: [*mut f64; 3],
    ) -> Outcome {
        let (length, old) = (self.0.len(), self.0.as_ptr());
        // SAFETY: states as long as given, the new one may alias the old one; outputs are null or valid for a double.
        accepted(trapped(|| unsafe {
            ffi::mslip_masing_update(contact.as_c(), length, old, displacement, new, force, stiffness, dissipated)
        }))
    }

    /// One step, in place.
    pub fn step(&mut self, contact: &Contact, displacement: f64) -> Result<Response, String> {
        let mut response = Response { force: f64::NAN, stiffness: f64::NAN, dissipated: f64::NAN };
        let outputs: [*mut f64; 3] = [&mut response.force, &mut response.stiffness, &mut response.dissipated];
        let new = self.0.as_mut_ptr();
        self.update(contact, displacement, new, outputs).map(|()| response)
    }

    /// The force after one step, in place.
    #[inline]
    pub fn force_after(&mut self, contact: &Contact, displacement: f64) -> Result<f64, String> {
        let mut force = f64::NAN;
        let new = self.0.as_mut_ptr();
        self.update(contact, displacement, new, [&mut force, null_mut(), null_mut()]).map(|()| force)
    }

    /// The force after a step whose state is discarded.
    pub fn force_at(&self, contact: &Contact, displacement: f64) -> Result<f64, String> {
        let mut force = f64::NAN;
        self.update(contact, displacement, null_mut(), [&mut force, null_mut(), null_mut()]).map(|()| force)
    }
}

/// Outputs of a path: force, stiffness and dissipated energy of each step, if requested.
pub type PathOutputs = [Option<Vec<f64>>; 3];

/// A path in one call; the new state is discarded unless `kept`.
pub fn path(
    contact: &Contact,
    state: &mut State,
    displacement: &[f64],
    requested: [bool; 3],
    kept: bool,
) -> Result<PathOutputs, String> {
    let n = displacement.len();
    let mut outputs = requested.map(|requested| requested.then(|| vec![f64::NAN; n]));
    let [force, stiffness, dissipated] =
        outputs.each_mut().map(|output| output.as_mut().map_or(null_mut(), |values| values.as_mut_ptr()));
    let state_old = state.0.as_mut_ptr();
    let state_new = if kept { state_old } else { null_mut() };
    let (length, path) = (state.0.len(), if n > 0 { displacement.as_ptr() } else { null() });
    // SAFETY: as long as given.
    let status = trapped(|| unsafe {
        ffi::mslip_masing_path(contact.as_c(), length, state_old, n, path, state_new, force, stiffness, dissipated)
    });
    accepted(status).map(|()| outputs)
}

/// A call with traps for invalid operations, divisions by zero and overflows, which end the program.
#[inline]
pub fn trapped<T>(call: impl FnOnce() -> T) -> T {
    /// Control words of SSE: all exceptions masked, or all but those of subnormal, underflowing and inexact numbers.
    const MASKED: u32 = 0x1f80;
    const TRAPPED: u32 = 0x1f80 & !(0x080 | 0x200 | 0x400);
    set_control(TRAPPED);
    let response = call();
    set_control(MASKED);
    response
}

#[cfg(target_arch = "x86_64")]
fn set_control(word: u32) {
    // SAFETY: a valid word, which changes the trapped exceptions only.
    unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const word, options(nostack)) }
}

/// Elsewhere exceptions are not trapped.
#[cfg(not(target_arch = "x86_64"))]
fn set_control(_: u32) {}
