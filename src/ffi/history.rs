//! Load histories: states, and Masing's rule with return-point memory.

use crate::constant_load::{ConstantLoad, Law, masing, state};
use crate::ffi::batch::{path, state_error};
use crate::ffi::mslip_contact;
use crate::ffi::pointers::{self, call, each, input, memory, outputs, set, state_input};
use crate::limits::check_positions;
use libc::size_t;

/// Number of doubles in a state with a capacity of `reversals` nested reversals, at least 2. A state is never full: if the capacity
/// is exceeded, the pair of adjacent reversals whose removal changes later forces least is removed.
#[unsafe(no_mangle)]
pub extern "C" fn mslip_state_length(reversals: size_t) -> size_t {
    state::state_length(reversals)
}

/// Initialises a state: unloaded, with zero force and displacement.
///
/// Returns MSLIP_NULL_POINTER or MSLIP_STATE_TOO_SHORT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_state_init(state_length: size_t, state: *mut f64) -> i32 {
    call(|| ConstantLoad::state_init(memory(state_length, state)?))
}

/// Validates a state that was read from a file or a message: all values must be finite and the reversals nested. Other functions
/// only check a tag and the number of reversals.
///
/// A state that was decimal text of 17 significant digits has every bit. With 15 or 16 digits later forces are right to 1e-12 mu N
/// (if reversals were removed, within mslip_state_error), or the state is rejected, because rounding has moved one reversal onto
/// another; with fewer digits it is rejected. Not detected: values that another history leads to, such as a force or a displacement
/// of which one bit has changed. A file needs a checksum of its own against that.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_STATE_TOO_SHORT or MSLIP_BAD_STATE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_state_check(state_length: size_t, state: *const f64) -> i32 {
    call(|| ConstantLoad::state_check(state_input(state_length, state)?))
}

/// Bound on the error \[N\] of the force due to removed reversals: 0 if none was removed since the last gross slip.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_STATE_TOO_SHORT or MSLIP_BAD_STATE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_state_error(state_length: size_t, state: *const f64, force_error: *mut f64) -> i32 {
    call(|| state_error::<ConstantLoad>(state_length, state, force_error))
}

/// Advances the contact state to a displacement \[m\]: force \[N\], tangent stiffness \[N/m\], and energy dissipated in this step
/// \[J\] (Eq. 11, 12). state_new may alias state_old; if NULL, the new state is discarded.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_STATE or MSLIP_BAD_DISPLACEMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_masing_update(
    contact: *const mslip_contact,
    state_length: size_t,
    state_old: *const f64,
    displacement: f64,
    state_new: *mut f64,
    force: *mut f64,
    stiffness: *mut f64,
    dissipated: *mut f64,
) -> i32 {
    call(|| {
        let (states, outputs) = ((state_length, state_old, state_new), [force, stiffness, dissipated]);
        path::<ConstantLoad>(pointers::contact(contact)?, states, 1, &raw const displacement, outputs)
    })
}

/// Advances the contact state through n displacements \[m\]; force\[n\] \[N\], stiffness\[n\] \[N/m\] and dissipated\[n\] \[J\] are
/// those of each step. state_new receives the last state and may alias state_old. If NULL, the new state is discarded; the path is
/// then evaluated with a capacity of at most 128 nested reversals.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_STATE or MSLIP_BAD_DISPLACEMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_masing_path(
    contact: *const mslip_contact,
    state_length: size_t,
    state_old: *const f64,
    n: size_t,
    displacement: *const f64,
    state_new: *mut f64,
    force: *mut f64,
    stiffness: *mut f64,
    dissipated: *mut f64,
) -> i32 {
    call(|| {
        let (states, outputs) = ((state_length, state_old, state_new), [force, stiffness, dissipated]);
        path::<ConstantLoad>(pointers::contact(contact)?, states, n, displacement, outputs)
    })
}

/// Tractions \[Pa\] at x\[n\] \[m\] after an arbitrary load history (Eq. 21, superposed by Masing's rule).
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_STATE, MSLIP_BAD_POSITION, or
/// MSLIP_FORCE_EXCEEDS_SLIP for the state of another contact.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_masing_tractions(
    contact: *const mslip_contact,
    state_length: size_t,
    state: *const f64,
    n: size_t,
    x: *const f64,
    pressure: *mut f64,
    shear: *mut f64,
) -> i32 {
    call(|| {
        let (contact, state, x) = (pointers::contact(contact)?, state_input(state_length, state)?, input(x, n)?);
        let [pressure, shear] = outputs([pressure, shear], n)?;
        check_positions(x)?;
        masing::shear_tractions(contact, state, x, shear.unwrap_or(&mut []))?;
        each(x, [pressure]).for_each(|(&x, [pressure])| set(pressure, || contact.pressure(x)));
        Ok(())
    })
}
