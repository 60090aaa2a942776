//! Load histories: states, and Masing's rule with return-point memory.

use super::contact::check_positions;
use crate::constant_load::contact::Contact;
use crate::constant_load::masing::{self, PathOutput, Step, with_step};
use crate::constant_load::memory::Point;
use crate::constant_load::state;
use crate::error::Error;
use crate::ffi::MSLIP_OK;
use crate::ffi::mslip_contact;
use crate::ffi::pointers::{
    self, call, check_alignment, input, memory, output, outputs, requested, set, state_input, status,
};
use core::{ptr, slice};
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
    status(memory(state_length, state).and_then(state::state_init))
}

/// Validates a state that was read from a file or a message: all values must be finite and the reversals nested. Other functions only
/// check a tag and the number of reversals.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_STATE_TOO_SHORT or MSLIP_BAD_STATE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_state_check(state_length: size_t, state: *const f64) -> i32 {
    status(state_input(state_length, state).and_then(state::state_check))
}

/// Bound on the error \[N\] of the force due to removed reversals: 0 if none was removed since the last gross slip.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_STATE_TOO_SHORT or MSLIP_BAD_STATE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_state_error(state_length: size_t, state: *const f64, force_error: *mut f64) -> i32 {
    call(|| {
        let (state, mut force_error) = (state_input(state_length, state)?, output(force_error, 1)?);
        let error = state::state_error(state)?;
        set(&mut force_error, 0, || error);
        Ok(())
    })
}

/// Advances the contact state to a displacement \[m\]: force \[N\], tangent stiffness \[N/m\], and energy dissipated in this step \[J\]
/// (Eq. 11, 12). state_new may alias state_old; if NULL, the new state is discarded.
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
    let checked = || {
        let contact = pointers::contact(contact)?;
        [state_new, force, stiffness, dissipated].iter().try_for_each(|output| check_alignment(*output))?;
        // SAFETY: by the function's contract; the reference ends before the new state, which may be the same memory, is written.
        masing::check_step(unsafe { state_input(state_length, state_old) }?, displacement)?;
        Ok(contact)
    };
    match checked() {
        // SAFETY: checked, aligned; valid by the function's contract.
        Ok(contact) => unsafe {
            let state_old = ptr::slice_from_raw_parts(state_old, state_length);
            update(contact, state_old, displacement, state_new, force, stiffness, dissipated)
        },
        Err::<_, Error>(error) => error.code(),
    }
}

/// One update with checked inputs: evaluates the step, then writes. Returns `MSLIP_OK`.
///
/// # Safety
/// `state_old` is valid; `state_new` is NULL, equal to it, or valid for as many doubles without overlap; the outputs are NULL, or aligned
/// and valid for one double.
#[inline(always)]
pub(in crate::ffi) unsafe fn update(
    contact: &Contact,
    state_old: *const [f64],
    displacement: f64,
    state_new: *mut f64,
    force: *mut f64,
    stiffness: *mut f64,
    dissipated: *mut f64,
) -> i32 {
    if dissipated.is_null() {
        return update_without_energy(contact, state_old, displacement, state_new, force, stiffness);
    }
    let energy = masing::dissipated(contact, &*state_old, displacement);
    let status = update_without_energy(contact, state_old, displacement, state_new, force, stiffness);
    write(dissipated, energy);
    status
}

/// A step that continues its branch is inlined, and calls no other function before its results are written; all others are left to
/// [`general_update`].
///
/// # Safety
/// As for [`update`].
#[inline(always)]
unsafe fn update_without_energy(
    contact: &Contact,
    state_old: *const [f64],
    displacement: f64,
    state_new: *mut f64,
    force: *mut f64,
    stiffness: *mut f64,
) -> i32 {
    let Some(response) = masing::continued(contact, &*state_old, displacement) else {
        return general_update(contact, state_old, displacement, state_new, [force, stiffness]);
    };
    write(force, response.force);
    write(stiffness, response.stiffness);
    if !state_new.is_null() {
        copy(state_old, state_new);
        let now = Point { displacement, force: response.force };
        state::set_point(slice::from_raw_parts_mut(state_new, state_old.len()), now);
    }
    MSLIP_OK
}

/// # Safety
/// As for [`update`].
#[inline(never)]
unsafe fn general_update(
    contact: &Contact,
    state_old: *const [f64],
    displacement: f64,
    state_new: *mut f64,
    results: [*mut f64; 2],
) -> i32 {
    let state = &*state_old;
    with_step!(contact, state, displacement, |step| write_step(&step, state_old, state_new, results));
    MSLIP_OK
}

/// Copies a state unless the new one is the same memory.
///
/// # Safety
/// As for [`update`]; `state_new` is not NULL.
#[inline(always)]
unsafe fn copy(state_old: *const [f64], state_new: *mut f64) {
    if !ptr::eq(state_old.cast(), state_new) {
        ptr::copy_nonoverlapping(state_old.cast(), state_new, state_old.len());
    }
}

/// Writes a step: the new state, and force and stiffness.
///
/// # Safety
/// As for [`update`].
#[inline(always)]
unsafe fn write_step(step: &Step, state_old: *const [f64], state_new: *mut f64, [force, stiffness]: [*mut f64; 2]) {
    // SAFETY: by the function's contract; the states are different memory if one is copied.
    unsafe {
        if !state_new.is_null() {
            copy(state_old, state_new);
            step.write(slice::from_raw_parts_mut(state_new, state_old.len()));
        }
        write(force, step.force());
        write(stiffness, step.stiffness());
    }
}

/// Writes one value if it is requested.
///
/// # Safety
/// `output` is NULL, or aligned and valid for one double.
#[inline(always)]
unsafe fn write(output: *mut f64, value: f64) {
    if !output.is_null() {
        output.write(value);
    }
}

/// Advances the contact state through n displacements \[m\]; force\[n\] \[N\], stiffness\[n\] \[N/m\] and dissipated\[n\] \[J\] are those
/// of each step. state_new receives the last state and may alias state_old. If NULL, the new state is discarded; the path is then
/// evaluated with a capacity of at most 128 nested reversals.
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
        let (contact, path) = (pointers::contact(contact)?, input(displacement, n)?);
        let [force, stiffness, dissipated] = outputs([force, stiffness, dissipated], n)?;
        check_alignment(state_new)?;
        let start = state_input(state_length, state_old)?;
        let output = PathOutput { force, stiffness, dissipated };
        masing::check_path(start, path)?;
        if state_new.is_null() {
            masing::path_in_copy(contact, start, path, output);
            return Ok(());
        }
        if !ptr::eq(state_old, state_new) {
            // SAFETY: aligned; valid by the function's contract.
            unsafe { ptr::copy(state_old, state_new, state_length) };
        }
        // SAFETY: as above; the reference to the old state, which may be the same memory, is not used any more.
        let state = unsafe { requested(state_new, state_length) }.ok_or(Error::StateTooShort)?;
        masing::path(contact, state, path, output);
        Ok(())
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
        let [mut pressure, shear] = outputs([pressure, shear], n)?;
        check_positions(x)?;
        masing::shear_tractions(contact, state, x, shear.unwrap_or(&mut []))?;
        x.iter().enumerate().for_each(|(i, &x)| set(&mut pressure, i, || contact.pressure(x)));
        Ok(())
    })
}
