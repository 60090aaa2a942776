//! What is tested: the functions of the C interface, as a host calls them.

use crate::Outcome;
use crate::walk::BRANCH_ROUNDING;
use microslip::c_api::{self, mslip_contact};
use microslip::{EllipticParameters, Parameters};
use std::fmt::{self, Debug, Formatter};
use std::mem::MaybeUninit;
use std::ptr::{self, null, null_mut};
use std::sync::Arc;

/// `Ok` where the status of a call is 0.
pub fn accepted(status: i32) -> Outcome {
    if status == c_api::MSLIP_OK { Ok(()) } else { Err(format!("refused with status {status}")) }
}

/// What a contact was prepared from; displayed so that it can be written down as it is.
#[derive(Debug, Clone, Copy)]
pub enum Given {
    Flat(Parameters),
    Ellipse(EllipticParameters),
}

/// A prepared contact.
#[derive(Clone)]
pub struct Contact {
    pub given: Given,
    prepared: Arc<mslip_contact>,
}

impl Debug for Contact {
    fn fmt(&self, formatter: &mut Formatter) -> fmt::Result {
        self.given.fmt(formatter)
    }
}

impl Contact {
    pub fn new(given: Given) -> Result<Contact, String> {
        let mut prepared = Box::new(MaybeUninit::<mslip_contact>::uninit());
        let contact = prepared.as_mut_ptr();
        // SAFETY: both pointers are valid; a contact is initialised by the call that accepts it.
        let status = trapped(|| unsafe {
            match &given {
                Given::Flat(parameters) => c_api::mslip_contact_init(parameters, contact),
                Given::Ellipse(parameters) => c_api::mslip_contact_init_elliptic(parameters, contact),
            }
        });
        accepted(status)?;
        Ok(Contact { given, prepared: unsafe { prepared.assume_init() }.into() })
    }

    pub fn as_c(&self) -> &mslip_contact {
        &self.prepared
    }

    /// A copy of its bytes, as a host keeps it in an array.
    pub fn copied(&self) -> mslip_contact {
        // SAFETY: a contact is plain data that may be copied.
        unsafe { ptr::read(self.as_c()) }
    }

    /// mu N.
    pub fn limit(&self) -> f64 {
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
        // SAFETY: pointers to one number each.
        accepted(trapped(|| unsafe {
            c_api::mslip_monotonic_force(self.as_c(), 1, &displacement, &mut force, &mut stiffness, null_mut())
        }))?;
        Ok((force, stiffness))
    }

    /// Energy of a cycle between displacements -amplitude and +amplitude, and what the rounding of the force at its end, by
    /// which it is asked for, is worth: `dE/dF = 4 (F dδ/dF - δ)`.
    pub fn cycle_energy(&self, amplitude: f64) -> Result<(f64, f64), String> {
        let (mut force, mut stiffness, mut energy) = (0.0, 0.0, 0.0);
        let sticks = amplitude.min(self.slip());
        // SAFETY: pointers to one number each.
        accepted(trapped(|| unsafe {
            c_api::mslip_monotonic_force(self.as_c(), 1, &sticks, &mut force, &mut stiffness, null_mut())
        }))?;
        // SAFETY: as above.
        accepted(trapped(|| unsafe { c_api::mslip_dissipated_energy(self.as_c(), 1, &force, &mut energy) }))?;
        // At gross slip it is asked for mu N itself.
        let rounding =
            if sticks < self.slip() { 4.0 * (force / stiffness - sticks).abs() * BRANCH_ROUNDING * force } else { 0.0 };
        Ok((energy + 4.0 * self.limit() * (amplitude - sticks), rounding))
    }
}

/// What a step answers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    pub force: f64,
    pub stiffness: f64,
    pub dissipated: f64,
}

/// A state that belongs to its caller.
#[derive(Clone, PartialEq)]
pub struct State(pub Vec<f64>);

/// Doubles before the reversals of a state: seal, number of reversals, displacement, slid, force, origin.
const HEADER: usize = 6;

impl State {
    /// A virgin state for that many nested reversals.
    pub fn new(reversals: usize) -> State {
        let mut state = vec![f64::NAN; c_api::mslip_state_length(reversals)];
        // SAFETY: as long as said.
        let status = trapped(|| unsafe { c_api::mslip_state_init(state.len(), state.as_mut_ptr()) });
        assert_eq!(status, c_api::MSLIP_OK);
        State(state)
    }

    /// The state goes on in another array, longer or shorter.
    pub fn moved(&self, reversals: usize) -> State {
        let mut other = State::new(reversals);
        let used = self.used().len();
        other.0[..used].copy_from_slice(self.used());
        other
    }

    pub fn depth(&self) -> usize {
        self.0[1] as usize
    }

    /// Reversals that it may hold.
    pub fn capacity(&self) -> usize {
        (self.0.len() - HEADER) / 2
    }

    /// Whether the newest branch is that of gross slip.
    pub fn slides(&self) -> bool {
        self.depth() == 0 && self.0[3] != 0.0
    }

    pub fn displacement(&self) -> f64 {
        self.0[2]
    }

    /// What is read of it.
    pub fn used(&self) -> &[f64] {
        &self.0[..HEADER + 2 * self.depth()]
    }

    /// All of it to the bit, save the sign of a zero and the seal over it.
    pub fn bits(&self) -> Vec<u64> {
        self.used().iter().skip(1).map(|value| (value + 0.0).to_bits()).collect()
    }

    /// The state that the negative of a history leaves; the sign of a zero is no matter.
    pub fn is_mirror_of(&self, other: &State) -> bool {
        let (one, two) = (self.used(), other.used());
        one[1] == two[1] && one[2..].iter().zip(&two[2..]).all(|(a, b)| *a == -*b)
    }

    /// One step, in place.
    pub fn step(&mut self, contact: &Contact, displacement: f64) -> Result<Answer, String> {
        let mut answer = Answer { force: f64::NAN, stiffness: f64::NAN, dissipated: f64::NAN };
        let (state, Answer { force, stiffness, dissipated }) = (self.0.as_mut_ptr(), &mut answer);
        // SAFETY: pointers as long as said; the old state may be the new one.
        accepted(trapped(|| unsafe {
            let length = self.0.len();
            c_api::mslip_masing_update(contact.as_c(), length, state, displacement, state, force, stiffness, dissipated)
        }))?;
        Ok(answer)
    }

    /// One step in place, of which the force alone is wanted.
    #[inline]
    pub fn force_after(&mut self, contact: &Contact, displacement: f64) -> Result<f64, String> {
        let mut force = f64::NAN;
        let (state, length) = (self.0.as_mut_ptr(), self.0.len());
        // SAFETY: as above.
        accepted(trapped(|| unsafe {
            c_api::mslip_masing_update(
                contact.as_c(),
                length,
                state,
                displacement,
                state,
                &mut force,
                null_mut(),
                null_mut(),
            )
        }))?;
        Ok(force)
    }

    /// The force that a step would lead to; the state stays.
    pub fn force_at(&self, contact: &Contact, displacement: f64) -> Result<f64, String> {
        let mut force = f64::NAN;
        let (state, length) = (self.0.as_ptr(), self.0.len());
        // SAFETY: as above.
        accepted(trapped(|| unsafe {
            c_api::mslip_masing_update(
                contact.as_c(),
                length,
                state,
                displacement,
                null_mut(),
                &mut force,
                null_mut(),
                null_mut(),
            )
        }))?;
        Ok(force)
    }
}

/// Outputs of a path: force, stiffness and dissipated energy of each step, where wanted.
pub struct Path {
    pub outputs: [Option<Vec<f64>>; 3],
}

/// A path in one call; the state is led along where it is kept.
pub fn path(
    contact: &Contact,
    state: &mut State,
    displacement: &[f64],
    wanted: [bool; 3],
    kept: bool,
) -> Result<Path, i32> {
    let n = displacement.len();
    let mut outputs = wanted.map(|wanted| wanted.then(|| vec![f64::NAN; n]));
    let [force, stiffness, dissipated] =
        outputs.each_mut().map(|output| output.as_mut().map_or(null_mut(), |values| values.as_mut_ptr()));
    let state0 = state.0.as_mut_ptr();
    let state1 = if kept { state0 } else { null_mut() };
    let (length, path) = (state.0.len(), if n > 0 { displacement.as_ptr() } else { null() });
    // SAFETY: as long as said.
    let status = trapped(|| unsafe {
        c_api::mslip_masing_path(contact.as_c(), length, state0, n, path, state1, force, stiffness, dissipated)
    });
    if status == c_api::MSLIP_OK { Ok(Path { outputs }) } else { Err(status) }
}

/// Calls as a host does that traps invalid operations, divisions by zero and overflows: one of them ends the program.
#[inline]
pub fn trapped<T>(call: impl FnOnce() -> T) -> T {
    /// Control words of SSE: all exceptions masked, or all but those of subnormal, underflowing and inexact numbers.
    const MASKED: u32 = 0x1f80;
    const TRAPPED: u32 = 0x1f80 & !(0x080 | 0x200 | 0x400);
    set_control(TRAPPED);
    let answer = call();
    set_control(MASKED);
    answer
}

#[cfg(target_arch = "x86_64")]
fn set_control(word: u32) {
    // SAFETY: a valid word, which changes nothing but what is trapped.
    unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const word, options(nostack)) }
}

/// Elsewhere exceptions are not trapped.
#[cfg(not(target_arch = "x86_64"))]
fn set_control(_: u32) {}
