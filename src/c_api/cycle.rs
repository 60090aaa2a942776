//! One contact in cycles: loops, energy, complex stiffness, harmonic force, and the spring-sliders that stand in for it.

use super::mslip_contact;
use super::pointer::{self, check_length, input, output, outputs, set, status};
use super::widest::on_widest;
use super::{MSLIP_BETWEEN_REVERSALS, MSLIP_EQUIDISTANT};
use crate::contact::Contact;
use crate::equivalent;
use crate::error::Error;
use crate::harmonic::{ComplexStiffness, check_amplitude};
use crate::harmonic_force::{self, HarmonicOutput, Rule, Workspace};
use libc::size_t;

/// Closed loop between +amplitude and -amplitude \[m\]: displacement\[n\] \[m\] and force\[n\] \[N\] at n equidistant instants of one
/// period of amplitude cos(t), from t = 0.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT or MSLIP_BAD_AMPLITUDE.
///
/// # Safety
/// Pointers are NULL or point to n numbers; outputs overlap nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_hysteresis_loop(
    contact: *const mslip_contact,
    amplitude: f64,
    n: size_t,
    displacement: *mut f64,
    force: *mut f64,
) -> i32 {
    let compute = || {
        // SAFETY: what the caller was asked for above.
        let (contact, [mut displacement, mut force]) =
            unsafe { (pointer::contact(contact)?, outputs([displacement, force], n)?) };
        let cycle = contact.hysteresis_loop(amplitude)?;
        if displacement.is_none() && force.is_none() {
            return Ok(());
        }
        for i in 0..n {
            set(&mut displacement, i, || cycle.displacement(i, n));
            set(&mut force, i, || cycle.force(i, n));
        }
        Ok(())
    };
    status(compute())
}

/// Energy \[J\] dissipated per cycle between ± force_amplitude\[n\] \[N\], from 0 to mu N (Eq. 13-16).
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE_AMPLITUDE or MSLIP_FORCE_EXCEEDS_SLIP.
///
/// # Safety
/// Pointers are NULL or point to n numbers; outputs overlap nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_dissipated_energy(
    contact: *const mslip_contact,
    n: size_t,
    force_amplitude: *const f64,
    energy: *mut f64,
) -> i32 {
    let compute = || {
        // SAFETY: what the caller was asked for above.
        let (contact, amplitude, energy) =
            unsafe { (pointer::contact(contact)?, input(force_amplitude, n)?, output(energy, n)?) };
        amplitude.iter().try_for_each(|&amplitude| contact.check_force_amplitude(amplitude))?;
        let Some(energy) = energy else { return Ok(()) };
        for (energy, &amplitude) in energy.iter_mut().zip(amplitude) {
            *energy = contact.dissipated_energy(amplitude)?;
        }
        Ok(())
    };
    status(compute())
}

/// Complex (harmonic) stiffness K' + iK'' \[N/m\] at displacement amplitude\[n\] >= 0 \[m\] and its derivatives by the amplitude
/// \[N/m^2\] (section 3.4); an amplitude of 0 gives the initial stiffness.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT or MSLIP_BAD_AMPLITUDE.
///
/// # Safety
/// Pointers are NULL or point to n numbers; outputs overlap nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_complex_stiffness(
    contact: *const mslip_contact,
    n: size_t,
    amplitude: *const f64,
    k_real: *mut f64,
    k_imag: *mut f64,
    dk_real: *mut f64,
    dk_imag: *mut f64,
) -> i32 {
    let compute = || {
        // SAFETY: what the caller was asked for above.
        let (contact, amplitude, mut outputs) = unsafe {
            let outputs = outputs([k_real, k_imag, dk_real, dk_imag], n);
            (pointer::contact(contact)?, input(amplitude, n)?, outputs?)
        };
        amplitude.iter().try_for_each(|&amplitude| check_amplitude(amplitude))?;
        if outputs.iter().all(Option::is_none) {
            return Ok(());
        }
        for (i, &amplitude) in amplitude.iter().enumerate() {
            write_complex_stiffness(contact, amplitude, i, &mut outputs)?;
        }
        Ok(())
    };
    status(compute())
}

/// The outputs that are wanted, in the order of `mslip_complex_stiffness`.
pub(super) fn write_complex_stiffness(
    contact: &Contact,
    amplitude: f64,
    i: usize,
    outputs: &mut [Option<&mut [f64]>; 4],
) -> Result<(), Error> {
    if outputs.iter().all(Option::is_none) {
        return Ok(());
    }
    if contact.is_frictionless() {
        outputs.iter_mut().for_each(|output| set(output, i, || 0.0));
        return Ok(());
    }
    let stiffness = contact.complex_stiffness(amplitude)?;
    let [k_real, k_imag, dk_real, dk_imag] = outputs;
    if k_real.is_some() || dk_real.is_some() {
        let (real, slope) = real_and_slope(&stiffness);
        set(k_real, i, || real);
        set(dk_real, i, || slope);
    }
    if k_imag.is_some() || dk_imag.is_some() {
        let (imaginary, slope) = imaginary_and_slope(&stiffness);
        set(k_imag, i, || imaginary);
        set(dk_imag, i, || slope);
    }
    Ok(())
}

fn real_and_slope(stiffness: &ComplexStiffness) -> (f64, f64) {
    on_widest!(ComplexStiffness::real_and_slope, stiffness: &ComplexStiffness => (f64, f64))
}

fn imaginary_and_slope(stiffness: &ComplexStiffness) -> (f64, f64) {
    on_widest!(ComplexStiffness::imaginary_and_slope, stiffness: &ComplexStiffness => (f64, f64))
}

/// Doubles of a workspace for so many harmonics H >= 1 and samples > 2H a period; 0 where these are not allowed. The rule
/// is MSLIP_EQUIDISTANT.
#[unsafe(no_mangle)]
pub extern "C" fn mslip_harmonic_workspace_length(harmonics: size_t, samples: size_t) -> size_t {
    Rule::Equidistant.workspace_length(harmonics, samples)
}

/// Prepares a workspace: tables for one pair of harmonics and samples, and scratch memory. One for each thread. The rule is
/// MSLIP_EQUIDISTANT.
///
/// Returns MSLIP_BAD_HARMONICS, MSLIP_BAD_SAMPLES, MSLIP_NULL_POINTER or MSLIP_WORKSPACE_TOO_SHORT.
///
/// # Safety
/// `workspace` is NULL or points to workspace_length numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_harmonic_workspace_init(
    harmonics: size_t,
    samples: size_t,
    workspace_length: size_t,
    workspace: *mut f64,
) -> i32 {
    // SAFETY: what the caller was asked for above.
    unsafe { mslip_harmonic_workspace_init_rule(harmonics, samples, MSLIP_EQUIDISTANT, workspace_length, workspace) }
}

/// The rule of that number.
fn rule_of(number: i32) -> Result<Rule, Error> {
    match number {
        MSLIP_EQUIDISTANT => Ok(Rule::Equidistant),
        MSLIP_BETWEEN_REVERSALS => Ok(Rule::BetweenReversals),
        _ => Err(Error::BadRule),
    }
}

/// mslip_harmonic_workspace_length for a rule, MSLIP_EQUIDISTANT or MSLIP_BETWEEN_REVERSALS; 0 for another.
#[unsafe(no_mangle)]
pub extern "C" fn mslip_harmonic_workspace_length_rule(harmonics: size_t, samples: size_t, rule: i32) -> size_t {
    rule_of(rule).map_or(0, |rule| rule.workspace_length(harmonics, samples))
}

/// mslip_harmonic_workspace_init for a rule. MSLIP_EQUIDISTANT samples a period at equal distances: its error falls with the
/// square of their number. MSLIP_BETWEEN_REVERSALS finds the instants at which the displacement turns, a loop closes or gross
/// slip starts, and puts about as many Gauss-Legendre nodes as there are samples between them, 8 at least between two: its
/// error falls exponentially, and the energy is exact. It looks for the instants on a grid of `samples`, at least 16 H.
///
/// Returns MSLIP_BAD_RULE or the codes of mslip_harmonic_workspace_init.
///
/// # Safety
/// `workspace` is NULL or points to workspace_length numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_harmonic_workspace_init_rule(
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
        // SAFETY: what the caller was asked for above.
        let memory = unsafe { output(workspace, workspace_length) }?.unwrap_or(&mut []);
        rule.workspace_init(harmonics, samples, memory)
    };
    status(init())
}

pub(super) fn widest_harmonic_force(
    contact: &Contact,
    workspace: &mut Workspace,
    displacement: &[f64],
    output: HarmonicOutput,
) -> Result<(), Error> {
    on_widest!(
        harmonic_force::harmonic_force,
        contact: &Contact,
        workspace: &mut Workspace,
        displacement: &[f64],
        output: HarmonicOutput => Result<(), Error>
    )
}

/// Harmonic force by alternating between frequency and time, in steady state (the second of two periods from the virgin
/// state), by the rule of the workspace. Coefficients \[c0, cos1, sin1, cos2, sin2, ...\], 2H+1 of them: displacement \[m\],
/// force \[N\]; jacobian \[N/m\] is d force_i / d displacement_j, (2H+1) x (2H+1), column-major, exact for this definition;
/// where two samples are equally far at a turning point, or one is just at gross slip, it is that of one side. With
/// MSLIP_BETWEEN_REVERSALS it is the rule applied to the exact derivative of the integrals, and as good as the force.
/// dissipated \[J\] is per period.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_WORKSPACE or MSLIP_BAD_DISPLACEMENT.
///
/// # Safety
/// `workspace` is NULL or was initialised; the others are NULL or as long as said; outputs overlap nothing.
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
        // SAFETY: what the caller was asked for above.
        let (contact, mut workspace) = unsafe { (pointer::contact(contact)?, pointer::workspace(workspace)?) };
        let n = workspace.coefficients();
        // SAFETY: as above.
        let (displacement, force, jacobian, dissipated) =
            unsafe { (input(displacement, n)?, output(force, n)?, output(jacobian, n * n)?, output(dissipated, 1)?) };
        let output = HarmonicOutput { force, jacobian, dissipated: dissipated.and_then(<[f64]>::first_mut) };
        widest_harmonic_force(contact, &mut workspace, displacement, output)
    };
    status(compute())
}

/// The spring-slider with the same K' and K'' at a displacement amplitude \[m\]: stiffness \[N/m\] and slip force \[N\]. At the
/// amplitude 0: the initial stiffness, and mu N. Both are 0 for a contact that carries no force.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT or MSLIP_BAD_AMPLITUDE.
///
/// # Safety
/// Pointers are NULL or point to one item; outputs overlap nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_jenkins_equivalent(
    contact: *const mslip_contact,
    amplitude: f64,
    stiffness: *mut f64,
    slip_force: *mut f64,
) -> i32 {
    let compute = || {
        // SAFETY: what the caller was asked for above.
        let (contact, [mut stiffness, mut slip_force]) =
            unsafe { (pointer::contact(contact)?, outputs([stiffness, slip_force], 1)?) };
        let slider = equivalent::jenkins(contact, amplitude)?;
        set(&mut stiffness, 0, || slider.stiffness);
        set(&mut slip_force, 0, || slider.slip_force);
        Ok(())
    };
    status(compute())
}

/// n parallel spring-sliders with the contact's monotonic curve to the smallest error that n allow: stiffness\[n\] \[N/m\],
/// slip_force\[n\] \[N\], adding up to mu N, and force_error, the largest error of the force over mu N. All are 0 for a contact
/// that carries no force.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT or MSLIP_BAD_COUNT.
///
/// # Safety
/// Pointers are NULL or point to n numbers (force_error: one); outputs overlap nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_iwan_equivalent(
    contact: *const mslip_contact,
    n: size_t,
    stiffness: *mut f64,
    slip_force: *mut f64,
    force_error: *mut f64,
) -> i32 {
    let compute = || {
        // SAFETY: what the caller was asked for above.
        let (contact, [mut stiffness, mut slip_force], mut force_error) = unsafe {
            let outputs = outputs([stiffness, slip_force], n);
            (pointer::contact(contact)?, outputs?, output(force_error, 1)?)
        };
        let mut i = 0;
        let error = equivalent::iwan(contact, n, |slider| {
            set(&mut stiffness, i, || slider.stiffness);
            set(&mut slip_force, i, || slider.slip_force);
            i += 1;
        })?;
        set(&mut force_error, 0, || error);
        Ok(())
    };
    status(compute())
}
