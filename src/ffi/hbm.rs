//! Harmonic balance: workspaces and the harmonic force.

use super::mslip_contact;
use super::pointers::{self, check_alignment, check_length, input, output, status};
use super::simd_dispatch::dispatch_simd;
use super::{MSLIP_EVENT_DRIVEN, MSLIP_UNIFORM_SAMPLING};
use crate::constant_load::contact::Contact;
use crate::error::Error;
use crate::hbm::{self, HarmonicOutput, Rule, Workspace};
use libc::size_t;

/// The rule of that number.
fn rule_of(number: i32) -> Result<Rule, Error> {
    match number {
        MSLIP_UNIFORM_SAMPLING => Ok(Rule::UniformSampling),
        MSLIP_EVENT_DRIVEN => Ok(Rule::EventDriven),
        _ => Err(Error::BadRule),
    }
}

/// Number of doubles in a workspace for the given number of harmonics H >= 1, samples > 2H a period, and rule,
/// MSLIP_UNIFORM_SAMPLING or MSLIP_EVENT_DRIVEN; 0 if these are not allowed.
#[unsafe(no_mangle)]
pub extern "C" fn mslip_harmonic_workspace_length(harmonics: size_t, samples: size_t, rule: i32) -> size_t {
    rule_of(rule).map_or(0, |rule| rule.workspace_length(harmonics, samples))
}

/// Initialises a workspace: tables for one (harmonics, samples, rule), and scratch memory; one for each thread.
///
/// MSLIP_UNIFORM_SAMPLING takes `samples` uniformly spaced instants of a period; its error falls with the square of their number.
/// MSLIP_EVENT_DRIVEN finds the instants of reversals, loop closures and the onset of gross slip, and places about `samples`
/// Gauss-Legendre nodes a period between them, 8 at least between two; its error falls exponentially, and the energy is exact.
/// It searches for the events on a grid of `samples` instants, 16 H at least.
///
/// Returns MSLIP_BAD_RULE, MSLIP_BAD_HARMONICS, MSLIP_BAD_SAMPLES, MSLIP_NULL_POINTER or MSLIP_WORKSPACE_TOO_SHORT.
///
/// # Safety
/// `workspace` is NULL or valid for workspace_length doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_harmonic_workspace_init(
    harmonics: size_t,
    samples: size_t,
    rule: i32,
    workspace_length: size_t,
    workspace: *mut f64,
) -> i32 {
    let init = || {
        let rule = rule_of(rule)?;
        check_length::<f64>(workspace_length)?;
        if workspace.is_null() {
            return Err(Error::NullPointer);
        }
        // SAFETY: by the function's contract.
        let memory = unsafe { output(workspace, workspace_length) }?.unwrap_or(&mut []);
        rule.workspace_init(harmonics, samples, memory)
    };
    status(init())
}

/// What a workspace was initialised for; an output that is NULL is not written.
///
/// Returns MSLIP_NULL_POINTER or MSLIP_BAD_WORKSPACE.
///
/// # Safety
/// `workspace` is NULL or was initialised; the outputs are NULL or valid for one item.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_harmonic_workspace_size(
    workspace: *const f64,
    harmonics: *mut size_t,
    samples: *mut size_t,
    rule: *mut i32,
) -> i32 {
    let report = || {
        // SAFETY: by the function's contract.
        let header = unsafe { pointers::workspace_header(workspace) }?;
        [harmonics, samples].iter().try_for_each(|output| check_alignment(*output))?;
        check_alignment(rule)?;
        let (found_harmonics, found_samples, found_rule) = hbm::workspace_size(&header)?;
        let number = match found_rule {
            Rule::UniformSampling => MSLIP_UNIFORM_SAMPLING,
            Rule::EventDriven => MSLIP_EVENT_DRIVEN,
        };
        // SAFETY: aligned; NULL or valid for one item by the function's contract.
        unsafe {
            harmonics.as_mut().into_iter().for_each(|output| *output = found_harmonics);
            samples.as_mut().into_iter().for_each(|output| *output = found_samples);
            rule.as_mut().into_iter().for_each(|output| *output = number);
        }
        Ok(())
    };
    status(report())
}

pub(super) fn harmonic_force_dispatched(
    contact: &Contact,
    workspace: &mut Workspace,
    displacement: &[f64],
    output: HarmonicOutput,
) -> Result<(), Error> {
    dispatch_simd!(
        hbm::harmonic_force,
        contact: &Contact,
        workspace: &mut Workspace,
        displacement: &[f64],
        output: HarmonicOutput => Result<(), Error>
    )
}

/// Harmonic force by alternating frequency/time (AFT), in steady state (the second of two periods from the initial, unloaded
/// state), by the rule of the workspace. Coefficients \[c0, cos1, sin1, cos2, sin2, ...\], 2H+1 of them: displacement \[m\],
/// force \[N\]; jacobian \[N/m\] is d force_i / d displacement_j, (2H+1) x (2H+1), column-major. With MSLIP_UNIFORM_SAMPLING it is
/// exact for this discretisation, and one-sided if two samples are equally far at a reversal or one is at the onset of gross slip;
/// with MSLIP_EVENT_DRIVEN it is the rule applied to the exact derivative of the integrals, and as accurate as the force.
/// dissipated \[J\] is per period.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_WORKSPACE or MSLIP_BAD_DISPLACEMENT.
///
/// # Safety
/// `workspace` is NULL or was initialised; the others are NULL or of the lengths above; outputs must not alias any other argument.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_harmonic_force(
    contact: *const mslip_contact,
    workspace: *mut f64,
    displacement: *const f64,
    force: *mut f64,
    jacobian: *mut f64,
    dissipated: *mut f64,
) -> i32 {
    let compute = || {
        // SAFETY: by the function's contract.
        let (contact, mut workspace) = unsafe { (pointers::contact(contact)?, pointers::workspace(workspace)?) };
        let n = workspace.coefficients();
        // SAFETY: by the function's contract.
        let (displacement, force, jacobian, dissipated) =
            unsafe { (input(displacement, n)?, output(force, n)?, output(jacobian, n * n)?, output(dissipated, 1)?) };
        let output = HarmonicOutput { force, jacobian, dissipated: dissipated.and_then(<[f64]>::first_mut) };
        harmonic_force_dispatched(contact, &mut workspace, displacement, output)
    };
    status(compute())
}
