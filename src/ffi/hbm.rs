//! Harmonic balance: workspaces and harmonic force.

use super::mslip_contact;
use super::pointers::{self, check_alignment, check_length, input, output, status};
use super::simd_dispatch::dispatch_simd;
use super::{MSLIP_EVENT_DRIVEN, MSLIP_UNIFORM_SAMPLING};
use crate::constant_load::contact::Contact;
use crate::error::Error;
use crate::hbm::{self, HarmonicOutput, Rule, Workspace};
use libc::size_t;

/// The rule of a constant of the C interface.
fn rule_of(constant: i32) -> Result<Rule, Error> {
    match constant {
        MSLIP_UNIFORM_SAMPLING => Ok(Rule::UniformSampling),
        MSLIP_EVENT_DRIVEN => Ok(Rule::EventDriven),
        _ => Err(Error::BadRule),
    }
}

/// Number of doubles in a workspace for H harmonics, H >= 1, more than 2H samples per period, and a rule, MSLIP_UNIFORM_SAMPLING or
/// MSLIP_EVENT_DRIVEN; 0 if these are not allowed.
#[unsafe(no_mangle)]
pub extern "C" fn mslip_harmonic_workspace_length(harmonics: size_t, samples: size_t, rule: i32) -> size_t {
    rule_of(rule).map_or(0, |rule| rule.workspace_length(harmonics, samples))
}

/// Initialises a workspace: tables for one (harmonics, samples, rule), and scratch memory. Each thread needs its own.
///
/// MSLIP_UNIFORM_SAMPLING evaluates `samples` uniformly spaced instants of a period; its error decreases as samples^-2.
/// MSLIP_EVENT_DRIVEN locates reversals, loop closures and the onset of gross slip, and distributes about `samples` Gauss-Legendre
/// nodes per period between them, at least 8 between two events. Its error decreases exponentially, more slowly for more harmonics:
/// 16 (H+1) nodes have worst measured errors of 1e-7 of mu N in the force and 1e-4 of the initial stiffness in the Jacobian; the
/// energy is exact to rounding. It searches for reversals on a grid of at least `samples` and 16 H instants.
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

/// Number of harmonics and of samples, and rule, of an initialised workspace. Outputs may be NULL.
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
    let read = || {
        // SAFETY: by the function's contract.
        let header = unsafe { pointers::workspace_header(workspace) }?;
        [harmonics, samples].iter().try_for_each(|output| check_alignment(*output))?;
        check_alignment(rule)?;
        let (harmonics_found, samples_found, rule_found) = hbm::workspace_size(&header)?;
        let constant = match rule_found {
            Rule::UniformSampling => MSLIP_UNIFORM_SAMPLING,
            Rule::EventDriven => MSLIP_EVENT_DRIVEN,
        };
        // SAFETY: aligned; NULL or valid for one item by the function's contract.
        unsafe {
            harmonics.as_mut().into_iter().for_each(|output| *output = harmonics_found);
            samples.as_mut().into_iter().for_each(|output| *output = samples_found);
            rule.as_mut().into_iter().for_each(|output| *output = constant);
        }
        Ok(())
    };
    status(read())
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

/// Harmonic force in steady state (the second of two periods from the initial, unloaded state), by alternating frequency/time (AFT)
/// with the rule of the workspace. displacement \[m\] and force \[N\] are 2H+1 coefficients, \[c0, cos1, sin1, cos2, sin2, ...\];
/// jacobian \[N/m\] is d force_i / d displacement_j, (2H+1) x (2H+1), column-major; dissipated \[J\] is the energy per period.
///
/// With MSLIP_UNIFORM_SAMPLING the Jacobian is the exact derivative of the discrete force, one-sided if two samples at a reversal are
/// equal or a sample is at the onset of gross slip. With MSLIP_EVENT_DRIVEN it is the rule applied to the exact derivative of the
/// integrals; it converges more slowly than the force.
///
/// The contact is unloaded at displacement 0, so the mean force depends on the mean displacement c0 unless the motion slips grossly.
/// For displacements measured from another position, pass c0 minus the unloaded position.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_WORKSPACE or MSLIP_BAD_DISPLACEMENT.
///
/// # Safety
/// `workspace` is NULL or was initialised; the others are NULL or valid for the lengths above; outputs must not alias any other argument.
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
