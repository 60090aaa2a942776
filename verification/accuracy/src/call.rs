//! The functions of the C interface.

use microslip::ffi::*;
use reference::Input;
use std::mem::MaybeUninit;
use std::ptr::null_mut;

pub fn prepare(input: &Input) -> Result<mslip_contact, i32> {
    let mut contact = MaybeUninit::uninit();
    let status = unsafe {
        match input {
            Input::Flat(p) => mslip_contact_init(p, contact.as_mut_ptr()),
            Input::Ellipse(p) => mslip_contact_init_elliptic(p, contact.as_mut_ptr()),
        }
    };
    if status == MSLIP_OK { Ok(unsafe { contact.assume_init() }) } else { Err(status) }
}

fn ok(status: i32, what: &str) {
    assert!(status == MSLIP_OK, "{what} returned {status}");
}

/// Displacement, compliance, stick half-width.
pub fn displacement(contact: &mslip_contact, force: f64) -> [f64; 3] {
    let [mut u, mut c, mut s] = [f64::NAN; 3];
    ok(unsafe { mslip_monotonic_displacement(contact, 1, &force, &mut u, &mut c, &mut s) }, "monotonic_displacement");
    [u, c, s]
}

/// Force, stiffness, stick half-width.
pub fn force(contact: &mslip_contact, displacement: f64) -> [f64; 3] {
    let [mut t, mut k, mut s] = [f64::NAN; 3];
    ok(unsafe { mslip_monotonic_force(contact, 1, &displacement, &mut t, &mut k, &mut s) }, "monotonic_force");
    [t, k, s]
}

pub fn energy(contact: &mslip_contact, force: f64) -> f64 {
    let mut energy = f64::NAN;
    ok(unsafe { mslip_dissipated_energy(contact, 1, &force, &mut energy) }, "dissipated_energy");
    energy
}

/// Pressure and shear.
pub fn tractions(contact: &mslip_contact, force: f64, x: &[f64]) -> [Vec<f64>; 2] {
    let [mut p, mut q] = [vec![f64::NAN; x.len()], vec![f64::NAN; x.len()]];
    let status = unsafe { mslip_tractions(contact, force, x.len(), x.as_ptr(), p.as_mut_ptr(), q.as_mut_ptr()) };
    ok(status, "tractions");
    [p, q]
}

/// Slip and damage.
pub fn slip(contact: &mslip_contact, force: f64, x: &[f64]) -> [Vec<f64>; 2] {
    let [mut s, mut d] = [vec![f64::NAN; x.len()], vec![f64::NAN; x.len()]];
    ok(unsafe { mslip_slip(contact, force, x.len(), x.as_ptr(), s.as_mut_ptr(), d.as_mut_ptr()) }, "slip");
    [s, d]
}

/// K', K'', dK', dK''.
pub fn complex_stiffness(contact: &mslip_contact, amplitude: f64) -> [f64; 4] {
    let [mut a, mut b, mut c, mut d] = [f64::NAN; 4];
    let status = unsafe { mslip_complex_stiffness(contact, 1, &amplitude, &mut a, &mut b, &mut c, &mut d) };
    ok(status, "complex_stiffness");
    [a, b, c, d]
}

/// Stiffness and slip force.
pub fn jenkins(contact: &mslip_contact, amplitude: f64) -> [f64; 2] {
    let [mut k, mut f] = [f64::NAN; 2];
    ok(unsafe { mslip_jenkins_equivalent(contact, amplitude, &mut k, &mut f) }, "jenkins_equivalent");
    [k, f]
}

/// Stiffnesses, slip forces and the error.
pub fn iwan(contact: &mslip_contact, n: usize) -> (Vec<f64>, Vec<f64>, f64) {
    let (mut k, mut f, mut error) = (vec![f64::NAN; n], vec![f64::NAN; n], f64::NAN);
    ok(unsafe { mslip_iwan_equivalent(contact, n, k.as_mut_ptr(), f.as_mut_ptr(), &mut error) }, "iwan_equivalent");
    (k, f, error)
}

pub fn state(reversals: usize) -> Vec<f64> {
    let mut state = vec![0.0; mslip_state_length(reversals)];
    ok(unsafe { mslip_state_init(state.len(), state.as_mut_ptr()) }, "state_init");
    state
}

/// Advances a state by one step: force, stiffness and dissipated energy.
pub fn update(contact: &mslip_contact, state: &mut [f64], displacement: f64) -> [f64; 3] {
    let [mut t, mut k, mut e] = [f64::NAN; 3];
    let place = state.as_mut_ptr();
    let status =
        unsafe { mslip_masing_update(contact, state.len(), place, displacement, place, &mut t, &mut k, &mut e) };
    ok(status, "masing_update");
    [t, k, e]
}

pub fn masing_shear(contact: &mslip_contact, state: &[f64], x: &[f64]) -> Vec<f64> {
    let mut shear = vec![f64::NAN; x.len()];
    let status = unsafe {
        mslip_masing_tractions(
            contact,
            state.len(),
            state.as_ptr(),
            x.len(),
            x.as_ptr(),
            null_mut(),
            shear.as_mut_ptr(),
        )
    };
    ok(status, "masing_tractions");
    shear
}

/// Displacement and force of the loop.
pub fn hysteresis_loop(contact: &mslip_contact, amplitude: f64, n: usize) -> [Vec<f64>; 2] {
    let [mut u, mut t] = [vec![f64::NAN; n], vec![f64::NAN; n]];
    ok(unsafe { mslip_hysteresis_loop(contact, amplitude, n, u.as_mut_ptr(), t.as_mut_ptr()) }, "hysteresis_loop");
    [u, t]
}

pub fn workspace(harmonics: usize, samples: usize, rule: i32) -> Vec<f64> {
    let mut workspace = vec![0.0; mslip_harmonic_workspace_length(harmonics, samples, rule)];
    let status =
        unsafe { mslip_harmonic_workspace_init(harmonics, samples, rule, workspace.len(), workspace.as_mut_ptr()) };
    ok(status, "harmonic_workspace_init");
    workspace
}

/// Force, Jacobian and dissipated energy.
pub fn harmonic(contact: &mslip_contact, workspace: &mut [f64], displacement: &[f64]) -> (Vec<f64>, Vec<f64>, f64) {
    let n = displacement.len();
    let (mut f, mut j, mut e) = (vec![f64::NAN; n], vec![f64::NAN; n * n], f64::NAN);
    let status = unsafe {
        mslip_harmonic_force(
            contact,
            workspace.as_mut_ptr(),
            displacement.as_ptr(),
            f.as_mut_ptr(),
            j.as_mut_ptr(),
            &mut e,
        )
    };
    ok(status, "harmonic_force");
    (f, j, e)
}
