//! The functions of the C interface.

use microslip::ffi::*;
use reference::Input;
use std::mem::MaybeUninit;
use std::ptr::null_mut;

/// The contact, if its parameters are accepted.
pub fn prepare(input: &Input) -> Option<mslip_contact> {
    let mut contact = MaybeUninit::uninit();
    let status = quiet("contact_init", || unsafe {
        match input {
            Input::Flat(p) => mslip_contact_init(p, contact.as_mut_ptr()),
            Input::Ellipse(p) => mslip_contact_init_elliptic(p, contact.as_mut_ptr()),
        }
    });
    (status == MSLIP_OK).then(|| unsafe { contact.assume_init() })
}

/// A call that raises no exception that an application may trap: invalid operation, division by zero, overflow.
pub fn quiet<T>(what: &str, call: impl FnOnce() -> T) -> T {
    let (result, raised) = flags_of(call);
    assert!(raised == 0, "{what} raised the exceptions {raised:#x}");
    result
}

/// The result of a call, and the exceptions of that kind that it raised.
#[cfg(target_arch = "x86_64")]
pub fn flags_of<T>(call: impl FnOnce() -> T) -> (T, u32) {
    let mut word = 0x1f80u32;
    // SAFETY: the word of the default environment, without flags.
    unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const word, options(nostack)) };
    let result = call();
    // SAFETY: writes the word.
    unsafe { std::arch::asm!("stmxcsr [{}]", in(reg) &raw mut word, options(nostack)) };
    (result, word & 0x0d)
}

/// Elsewhere exceptions are not seen.
#[cfg(not(target_arch = "x86_64"))]
pub fn flags_of<T>(call: impl FnOnce() -> T) -> (T, u32) {
    (call(), 0)
}

fn ok(what: &str, call: impl FnOnce() -> i32) {
    let status = quiet(what, call);
    assert!(status == MSLIP_OK, "{what} returned {status}");
}

/// The outputs of a call, of the given length each.
fn outputs<const K: usize>(n: usize, what: &str, call: impl FnOnce([*mut f64; K]) -> i32) -> [Vec<f64>; K] {
    let mut outputs = [(); K].map(|()| vec![f64::NAN; n]);
    let places = outputs.each_mut().map(|output| output.as_mut_ptr());
    ok(what, || call(places));
    outputs
}

/// The same, of one value each.
fn values<const K: usize>(what: &str, call: impl FnOnce([*mut f64; K]) -> i32) -> [f64; K] {
    outputs(1, what, call).map(|output| output[0])
}

/// Displacement, compliance, stick half-width.
pub fn displacement(contact: &mslip_contact, force: f64) -> [f64; 3] {
    values("monotonic_displacement", |[u, c, s]| unsafe { mslip_monotonic_displacement(contact, 1, &force, u, c, s) })
}

/// Force, stiffness, stick half-width.
pub fn force(contact: &mslip_contact, displacement: f64) -> [f64; 3] {
    values("monotonic_force", |[t, k, s]| unsafe { mslip_monotonic_force(contact, 1, &displacement, t, k, s) })
}

/// Force and its derivatives with respect to the parameters.
pub fn sensitivity(contact: &mslip_contact, displacement: f64) -> (f64, [f64; MSLIP_PARAMETER_COUNT as usize]) {
    let (mut force, mut sensitivity) = (f64::NAN, [f64::NAN; _]);
    let place = sensitivity.as_mut_ptr();
    ok("monotonic_sensitivity", || unsafe {
        mslip_monotonic_sensitivity(contact, 1, &displacement, &mut force, place)
    });
    (force, sensitivity)
}

pub fn energy(contact: &mslip_contact, force: f64) -> f64 {
    let [energy] = values("dissipated_energy", |[e]| unsafe { mslip_dissipated_energy(contact, 1, &force, e) });
    energy
}

/// Pressure and shear.
pub fn tractions(contact: &mslip_contact, force: f64, x: &[f64]) -> [Vec<f64>; 2] {
    let n = x.len();
    outputs(n, "tractions", |[p, q]| unsafe { mslip_tractions(contact, force, n, x.as_ptr(), p, q) })
}

/// Slip and damage.
pub fn slip(contact: &mslip_contact, force: f64, x: &[f64]) -> [Vec<f64>; 2] {
    let n = x.len();
    outputs(n, "slip", |[s, d]| unsafe { mslip_slip(contact, force, n, x.as_ptr(), s, d) })
}

/// K', K'', dK', dK''.
pub fn complex_stiffness(contact: &mslip_contact, amplitude: f64) -> [f64; 4] {
    let call = |[a, b, c, d]: [_; 4]| unsafe { mslip_complex_stiffness(contact, 1, &amplitude, a, b, c, d) };
    values("complex_stiffness", call)
}

/// Stiffness and slip force.
pub fn jenkins(contact: &mslip_contact, amplitude: f64) -> [f64; 2] {
    values("jenkins_equivalent", |[k, f]| unsafe { mslip_jenkins_equivalent(contact, amplitude, k, f) })
}

/// Stiffnesses, slip forces and the error.
pub fn iwan(contact: &mslip_contact, n: usize) -> ([Vec<f64>; 2], f64) {
    let mut error = f64::NAN;
    let sliders =
        outputs(n, "iwan_equivalent", |[k, f]| unsafe { mslip_iwan_equivalent(contact, n, k, f, &mut error) });
    (sliders, error)
}

pub fn state(reversals: usize) -> Vec<f64> {
    let mut state = vec![0.0; mslip_state_length(reversals)];
    ok("state_init", || unsafe { mslip_state_init(state.len(), state.as_mut_ptr()) });
    state
}

/// Advances a state by one step: force, stiffness and dissipated energy.
pub fn update(contact: &mslip_contact, state: &mut [f64], u: f64) -> [f64; 3] {
    let (n, place) = (state.len(), state.as_mut_ptr());
    values("masing_update", |[t, k, e]| unsafe { mslip_masing_update(contact, n, place, u, place, t, k, e) })
}

pub fn masing_shear(contact: &mslip_contact, state: &[f64], x: &[f64]) -> Vec<f64> {
    let (n, place, length, old) = (x.len(), x.as_ptr(), state.len(), state.as_ptr());
    let [shear] = outputs(n, "masing_tractions", |[q]| unsafe {
        mslip_masing_tractions(contact, length, old, n, place, null_mut(), q)
    });
    shear
}

/// Displacement and force of the loop.
pub fn hysteresis_loop(contact: &mslip_contact, amplitude: f64, n: usize) -> [Vec<f64>; 2] {
    outputs(n, "hysteresis_loop", |[u, t]| unsafe { mslip_hysteresis_loop(contact, amplitude, n, u, t) })
}

/// Force, Jacobian and dissipated energy.
pub fn harmonic(contact: &mslip_contact, samples: usize, displacement: &[f64]) -> (Vec<f64>, Vec<f64>, f64) {
    let rule = MSLIP_UNIFORM_SAMPLING;
    let (n, u) = (displacement.len(), displacement.as_ptr());
    let mut workspace = vec![0.0; mslip_harmonic_workspace_length(n / 2, samples, rule)];
    let (length, memory) = (workspace.len(), workspace.as_mut_ptr());
    ok("harmonic_workspace_init", || unsafe { mslip_harmonic_workspace_init(n / 2, samples, rule, length, memory) });
    let (mut f, mut j, mut e) = (vec![f64::NAN; n], vec![f64::NAN; n * n], f64::NAN);
    let (force, jacobian) = (f.as_mut_ptr(), j.as_mut_ptr());
    ok("harmonic_force", || unsafe { mslip_harmonic_force(contact, memory, u, force, jacobian, &mut e) });
    (f, j, e)
}
