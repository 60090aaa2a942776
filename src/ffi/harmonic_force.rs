//! Harmonic balance: workspaces and harmonic force.

use super::batch::{mslip_batch_element_harmonic_force, mslip_batch_harmonic_force};
use super::element::directions_of;
use super::pointers::{self, call, input, memory, optional_output, output, set, with_law};
use super::{mslip_contact, mslip_element};
use crate::constant_load::harmonic_force::{self, HarmonicOutput, Rule, harmonic_sensitivity, workspace_size};
use crate::element::Directions;
use crate::error::Error;
use crate::fourier::workspace::{Layout, SamplingSize};
use crate::law::Law;
use crate::parameters::PARAMETERS;
use core::ptr;
use libc::size_t;

/// The rule of a constant of the C interface.
fn rule_of(constant: i32) -> Result<Rule, Error> {
    [Rule::UniformSampling, Rule::EventDriven].into_iter().find(|rule| *rule as i32 == constant).ok_or(Error::BadRule)
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
/// nodes per period between them, at least 8 between two events; three times as many if a layer has an N_c below a quarter of the
/// normal force. Its error decreases exponentially, more slowly for more harmonics: 16 (H+1) nodes have worst measured errors of
/// 2e-6 of mu N in the force and 5e-4 of the initial stiffness in the Jacobian; the energy is exact to rounding. It searches for
/// reversals on a grid of at least `samples` and 16 H instants.
///
/// Returns MSLIP_BAD_RULE, MSLIP_BAD_HARMONICS, MSLIP_BAD_SAMPLES, MSLIP_NULL_POINTER or MSLIP_WORKSPACE_TOO_SHORT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_harmonic_workspace_init(
    harmonics: size_t,
    samples: size_t,
    rule: i32,
    workspace_length: size_t,
    workspace: *mut f64,
) -> i32 {
    call(|| {
        let rule = rule_of(rule)?;
        rule.workspace_init(harmonics, samples, memory(workspace_length, workspace)?)
    })
}

/// Number of harmonics and of samples, and rule, of an initialised workspace. Outputs may be NULL.
///
/// Returns MSLIP_NULL_POINTER or MSLIP_BAD_WORKSPACE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_harmonic_workspace_size(
    workspace: *const f64,
    harmonics: *mut size_t,
    samples: *mut size_t,
    rule: *mut i32,
) -> i32 {
    call(|| {
        let header = pointers::workspace_header(workspace)?;
        let (harmonics, samples, rule) =
            (optional_output(harmonics)?, optional_output(samples)?, optional_output(rule)?);
        let (found, size, _) = workspace_size(&header)?;
        set(harmonics, || size.harmonics);
        set(samples, || size.samples);
        set(rule, || found as i32);
        Ok(())
    })
}

/// Checks what a workspace of an element is made for. An event-driven rule is not available.
fn check_element_rule(directions: i32, rule: i32) -> Result<Directions, Error> {
    let directions = directions_of(directions)?;
    match rule_of(rule)? {
        Rule::UniformSampling => Ok(directions),
        Rule::EventDriven => Err(Error::NotAvailable),
    }
}

/// Number of doubles in a workspace of elements with 1 or 2 tangential directions for H harmonics, H >= 1, more than 2H samples per
/// period, and MSLIP_UNIFORM_SAMPLING; 0 if these are not allowed or not available.
#[unsafe(no_mangle)]
pub extern "C" fn mslip_element_workspace_length(
    directions: i32,
    harmonics: size_t,
    samples: size_t,
    rule: i32,
) -> size_t {
    let size = SamplingSize { harmonics, samples, periods: 0 };
    let length = |directions| with_law!(directions, L => <L as Law>::Workspace::length_or_zero(size));
    check_element_rule(directions, rule).map_or(0, length)
}

/// Initialises a workspace of elements: tables for one (directions, harmonics, samples, rule), and scratch memory. Each thread
/// needs its own. periods is the number of periods that are applied before the returned one, at most 65536. 0 is the default: 4
/// with two directions; 1 with one, where a larger number changes neither results nor time.
///
/// Returns MSLIP_BAD_DIRECTIONS, MSLIP_BAD_RULE, MSLIP_NOT_AVAILABLE for MSLIP_EVENT_DRIVEN, MSLIP_BAD_HARMONICS,
/// MSLIP_BAD_SAMPLES, MSLIP_BAD_PERIODS, MSLIP_NULL_POINTER or MSLIP_WORKSPACE_TOO_SHORT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_element_workspace_init(
    directions: i32,
    harmonics: size_t,
    samples: size_t,
    rule: i32,
    periods: size_t,
    workspace_length: size_t,
    workspace: *mut f64,
) -> i32 {
    call(|| {
        let directions = check_element_rule(directions, rule)?;
        let memory = memory(workspace_length, workspace)?;
        let size = SamplingSize { harmonics, samples, periods };
        with_law!(directions, L => <L as Law>::Workspace::init(size, memory))
    })
}

/// Number of directions, of harmonics and of samples, rule, and number of periods before the returned one (never 0), of an
/// initialised workspace of elements. Outputs may be NULL.
///
/// Returns MSLIP_NULL_POINTER or MSLIP_BAD_WORKSPACE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_element_workspace_size(
    workspace: *const f64,
    directions: *mut i32,
    harmonics: *mut size_t,
    samples: *mut size_t,
    rule: *mut i32,
    periods: *mut size_t,
) -> i32 {
    call(|| {
        let (directions, harmonics, samples) =
            (optional_output(directions)?, optional_output(harmonics)?, optional_output(samples)?);
        let (rule, periods) = (optional_output(rule)?, optional_output(periods)?);
        let (found, size, _) = pointers::element_workspace_size(workspace)?;
        set(directions, || found as i32);
        set(harmonics, || size.harmonics);
        set(samples, || size.samples);
        set(rule, || Rule::UniformSampling as i32);
        set(periods, || size.periods);
        Ok(())
    })
}

/// Harmonic force of an element in steady state, by alternating frequency/time (AFT). displacement and force hold component after
/// component, each 2H+1 coefficients \[c0, cos1, sin1, cos2, sin2, ...\]: with one tangential direction m = 2 components, u \[m\]
/// and w, T and N \[N\], with two directions m = 3, u, v \[m\] and w, Tx, Ty and N \[N\]. The normal component w of the
/// displacement is the approach \[m\] or the normal force \[N\]. jacobian is d force_i / d displacement_j, m(2H+1) x m(2H+1),
/// column-major: the exact derivative of the discrete force, one-sided at corners. dissipated \[J\] is the work of the tangential
/// force in the returned period, pi sum k (c_k s'_k - s_k c'_k) from the coefficients of force and displacement, over the
/// tangential directions; if rounding makes it negative, 0.
///
/// Steady state: at the first sample of the largest normal force the element is pressed without tangential displacement and then
/// displaced at constant normal force. It advances from there through the periods of the workspace and one more, which is returned.
/// The Jacobian is the derivative for a fixed start. If w is constant, any variation of w moves the start to another sample, and
/// the mean tangential force may depend on the start.
///
/// With one direction the returned period is the steady state. With two, a vibration across a mean tangential force reduces that
/// force over many periods. Before the last two, of which the second is returned, the motion advances by 32 samples for each cycle
/// of the highest harmonic, if there are more. With 3 periods or more, the memory after the second is extrapolated by 1.75 times
/// its change in that period. drift estimates the largest difference of the tangential force between the returned period and the
/// steady state, over mu times the largest normal force; 0 with one direction, and for a contact that opens, because that erases
/// its memory. A drift is not an error. While the force drifts, dissipated contains the change of the stored energy.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_ELEMENT, MSLIP_BAD_WORKSPACE, MSLIP_BAD_DIRECTIONS for the workspace of another number of
/// directions, MSLIP_BAD_DISPLACEMENT, MSLIP_BAD_NORMAL_FORCE if the normal force of a sample is negative, or
/// MSLIP_LENGTH_TOO_SHORT if the contact would be too wide for its length at a sample.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_element_harmonic_force(
    element: *const mslip_element,
    workspace: *mut f64,
    displacement: *const f64,
    force: *mut f64,
    jacobian: *mut f64,
    dissipated: *mut f64,
    drift: *mut f64,
) -> i32 {
    let (all, no_item) = (ptr::null(), ptr::null_mut());
    mslip_batch_element_harmonic_force(
        1,
        1,
        element,
        all,
        all,
        workspace,
        displacement,
        force,
        jacobian,
        dissipated,
        drift,
        no_item,
    )
}

/// Harmonic force in steady state (the second of two periods from the initial, unloaded state), by alternating frequency/time (AFT)
/// with the rule of the workspace. displacement \[m\] and force \[N\] are 2H+1 coefficients, \[c0, cos1, sin1, cos2, sin2, ...\];
/// jacobian \[N/m\] is d force_i / d displacement_j, (2H+1) x (2H+1), column-major; dissipated \[J\] is the energy per period.
///
/// With MSLIP_UNIFORM_SAMPLING the Jacobian is the exact derivative of the discrete force, one-sided if two samples at a reversal
/// are equal or a sample is at the onset of gross slip. With MSLIP_EVENT_DRIVEN it is the rule applied to the exact derivative of
/// the integrals; it converges more slowly than the force.
///
/// The contact is unloaded at displacement 0, so the mean force depends on the mean displacement c0 unless the motion slips
/// grossly. For displacements measured from another position, pass c0 minus the unloaded position.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_WORKSPACE or MSLIP_BAD_DISPLACEMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_harmonic_force(
    contact: *const mslip_contact,
    workspace: *mut f64,
    displacement: *const f64,
    force: *mut f64,
    jacobian: *mut f64,
    dissipated: *mut f64,
) -> i32 {
    let (all, no_item) = (ptr::null(), ptr::null_mut());
    mslip_batch_harmonic_force(1, 1, contact, all, all, workspace, displacement, force, jacobian, dissipated, no_item)
}

/// Derivatives of the harmonic force with respect to the parameters at fixed coefficients of the displacement: displacement \[m\]
/// and force \[N\] as of mslip_harmonic_force, and sensitivity, (2H+1) x MSLIP_PARAMETER_COUNT, column-major. The derivative of
/// force coefficient i is sensitivity\[i + (2H+1) MSLIP_BY_...\], in \[N\] over the unit of the parameter. The parameters are those
/// of mslip_monotonic_sensitivity.
///
/// With MSLIP_UNIFORM_SAMPLING the derivatives are the exact ones of the discrete force, one-sided if a sample is at the onset of
/// gross slip. With MSLIP_EVENT_DRIVEN they are the rule applied to the exact derivatives of the integrals, and converge more
/// slowly than the force.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_WORKSPACE or MSLIP_BAD_DISPLACEMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_harmonic_sensitivity(
    contact: *const mslip_contact,
    workspace: *mut f64,
    displacement: *const f64,
    force: *mut f64,
    sensitivity: *mut f64,
) -> i32 {
    call(|| {
        let (contact, mut workspace) = (pointers::contact(contact)?, pointers::workspace(workspace)?);
        let n = workspace.coefficients();
        let (displacement, force, sensitivity) =
            (input(displacement, n)?, output(force, n)?, output(sensitivity, PARAMETERS * n)?);
        let output = HarmonicOutput { force, jacobian: None, dissipated: None, drift: None };
        harmonic_force::harmonic_force(contact, &mut workspace, displacement, output)?;
        if let Some(sensitivity) = sensitivity {
            harmonic_sensitivity(contact, &mut workspace, displacement, sensitivity);
        }
        Ok(())
    })
}
