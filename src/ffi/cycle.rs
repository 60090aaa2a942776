//! Cyclic loading: hysteresis loops, energy, complex stiffness, and equivalent spring-slider elements.

use crate::constant_load::complex_stiffness::{check_amplitude, requested};
use crate::constant_load::equivalents;
use crate::ffi::mslip_contact;
use crate::ffi::pointers::{self, call, each, input, optional_output, output, outputs, set, write};
use libc::size_t;

/// Hysteresis loop of the displacement amplitude cos(t), amplitude in \[m\]: displacement\[n\] \[m\] and force\[n\] \[N\] at n
/// uniformly spaced instants of one period, from t = 0.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT or MSLIP_BAD_AMPLITUDE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_hysteresis_loop(
    contact: *const mslip_contact,
    amplitude: f64,
    n: size_t,
    displacement: *mut f64,
    force: *mut f64,
) -> i32 {
    call(|| {
        let (contact, outputs) = (pointers::contact(contact)?, outputs([displacement, force], n)?);
        let cycle = contact.hysteresis_loop(amplitude)?;
        for (i, [displacement, force]) in each(0..n, outputs) {
            set(displacement, || cycle.displacement(i, n));
            set(force, || cycle.force(i, n));
        }
        Ok(())
    })
}

/// Energy \[J\] dissipated per cycle between +- force_amplitude\[n\] \[N\], each from 0 to mu N (Eq. 13-16).
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE_AMPLITUDE or MSLIP_FORCE_EXCEEDS_SLIP.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_dissipated_energy(
    contact: *const mslip_contact,
    n: size_t,
    force_amplitude: *const f64,
    energy: *mut f64,
) -> i32 {
    call(|| {
        let (contact, amplitude, energy) =
            (pointers::contact(contact)?, input(force_amplitude, n)?, output(energy, n)?);
        amplitude.iter().try_for_each(|&amplitude| contact.check_force_amplitude(amplitude))?;
        for (&amplitude, [energy]) in each(amplitude, [energy]) {
            let dissipated = contact.dissipated_energy(amplitude)?;
            set(energy, || dissipated);
        }
        Ok(())
    })
}

/// Complex (harmonic) stiffness K' + iK'' \[N/m\] at displacement amplitude\[n\] >= 0 \[m\] and its derivatives with respect to
/// the amplitude \[N/m^2\] (section 3.4); at amplitude 0: the initial stiffness.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT or MSLIP_BAD_AMPLITUDE.
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
    call(|| {
        let (contact, amplitude, outputs) =
            (pointers::contact(contact)?, input(amplitude, n)?, outputs([k_real, k_imag, dk_real, dk_imag], n)?);
        amplitude.iter().try_for_each(|&amplitude| check_amplitude(amplitude))?;
        let requested = requested(&outputs);
        for (&amplitude, outputs) in each(amplitude, outputs) {
            write(outputs, contact.stiffness_of_cycle(amplitude, requested));
        }
        Ok(())
    })
}

/// Jenkins element (spring and slider in series) with the same K' and K'' at a displacement amplitude \[m\]: stiffness \[N/m\] and
/// slip force \[N\]. At amplitude 0: the initial stiffness and mu N. Both are 0 if mu N = 0.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT or MSLIP_BAD_AMPLITUDE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_jenkins_equivalent(
    contact: *const mslip_contact,
    amplitude: f64,
    stiffness: *mut f64,
    slip_force: *mut f64,
) -> i32 {
    call(|| {
        let (contact, stiffness, slip_force) =
            (pointers::contact(contact)?, optional_output(stiffness)?, optional_output(slip_force)?);
        let slider = equivalents::jenkins(contact, amplitude)?;
        write([stiffness, slip_force], [slider.stiffness, slider.slip_force]);
        Ok(())
    })
}

/// Iwan model of n parallel Jenkins elements that approximates the monotonic curve with the smallest maximum error: stiffness\[n\]
/// \[N/m\], slip_force\[n\] \[N\] of sum mu N, and force_error, the maximum error of the force on the monotonic curve divided by
/// mu N. After m nested reversals the error is at most (1 + 2m) force_error; measured: 3 in loops, 10 to 15 in random
/// histories, 6 to 43 in decaying vibrations. All are 0 if mu N = 0.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT or MSLIP_BAD_COUNT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_iwan_equivalent(
    contact: *const mslip_contact,
    n: size_t,
    stiffness: *mut f64,
    slip_force: *mut f64,
    force_error: *mut f64,
) -> i32 {
    call(|| {
        pointers::check_length::<f64>(n)?;
        // Before arrays of that length are assumed.
        equivalents::check_count(n)?;
        let (contact, outputs, force_error) =
            (pointers::contact(contact)?, outputs([stiffness, slip_force], n)?, optional_output(force_error)?);
        let mut places = each(0..n, outputs).map(|(_, places)| places);
        let error = equivalents::iwan(contact, n, |slider| {
            write(places.next().unwrap_or_default(), [slider.stiffness, slider.slip_force]);
        })?;
        set(force_error, || error);
        Ok(())
    })
}
