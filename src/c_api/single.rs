//! One contact: preparation, tractions, monotonic curve and memory.

use super::mslip_contact;
use super::pointer::{self, check_alignment, check_length, input, item, output, outputs, set, status, wanted};
use super::widest::on_widest;
use crate::contact::Contact;
use crate::error::Error;
use crate::masing::{self, PathOutput};
use crate::memory;
use crate::number::is_finite;
use crate::parameters::{EllipticParameters, Parameters};
use core::ptr;
use libc::size_t;

/// Parameters with every number unset (NaN), so that a forgotten one is refused by name; the centre point as reference.
/// NULL is ignored.
///
/// # Safety
/// `p` is NULL or points to parameters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_parameters_default(p: *mut Parameters) {
    if !p.is_null() {
        // SAFETY: parameters, wherever they stand: there is no status to refuse them with.
        unsafe { p.write_unaligned(Parameters::default()) }
    }
}

/// Elliptical parameters with every number unset (NaN). NULL is ignored.
///
/// # Safety
/// `p` is NULL or points to parameters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_elliptic_parameters_default(p: *mut EllipticParameters) {
    if !p.is_null() {
        // SAFETY: parameters, wherever they stand: there is no status to refuse them with.
        unsafe { p.write_unaligned(EllipticParameters::default()) }
    }
}

/// Writes the contact that `make` makes of parameters.
///
/// # Safety
/// Both pointers are NULL or point to what their types say.
unsafe fn prepare<P>(
    parameters: *const P,
    contact: *mut mslip_contact,
    make: impl FnOnce(&P) -> Result<Contact, Error>,
) -> i32 {
    let prepare = || {
        // SAFETY: the caller's word.
        let parameters = unsafe { item(parameters) }?;
        if contact.is_null() {
            return Err(Error::NullPointer);
        }
        check_alignment(contact)?;
        let made = make(parameters)?.into();
        // SAFETY: aligned, not NULL, and a contact by the caller's word.
        unsafe { contact.write(made) };
        Ok(())
    };
    status(prepare())
}

/// Prepares the contact of a flat with rounded edges, or of a cylinder (Eq. 1, 2, 10).
///
/// Returns MSLIP_NULL_POINTER, the code of the first parameter that is not allowed, MSLIP_LENGTH_TOO_SHORT or
/// MSLIP_OUT_OF_RANGE; then the contact is unchanged.
///
/// # Safety
/// `p` and `contact` are NULL or point to what their types say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_contact_init(p: *const Parameters, contact: *mut mslip_contact) -> i32 {
    // SAFETY: what the caller was asked for above.
    unsafe { prepare(p, contact, Contact::rounded_flat) }
}

/// Prepares a contact as mslip_contact_init does, with the same numbers in it, but faster where `like` has the same shape: it
/// differs in the friction coefficient only, or in scale by powers of 2. Otherwise it takes as long. contact may be like.
///
/// Returns what mslip_contact_init returns, or MSLIP_BAD_CONTACT; then the contact is unchanged.
///
/// # Safety
/// All pointers are NULL or point to what their types say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_contact_init_like(
    p: *const Parameters,
    like: *const mslip_contact,
    contact: *mut mslip_contact,
) -> i32 {
    // SAFETY: what the caller was asked for above.
    unsafe { prepare(p, contact, |p| Contact::rounded_flat_like(p, pointer::contact(like)?)) }
}

/// Prepares an elliptical Hertz contact (section 3.3); a sphere when both semi-axes are equal.
///
/// Returns MSLIP_NULL_POINTER, the code of the first parameter that is not allowed, or MSLIP_OUT_OF_RANGE; then the contact
/// is unchanged.
///
/// # Safety
/// `p` and `contact` are NULL or point to what their types say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_contact_init_elliptic(p: *const EllipticParameters, contact: *mut mslip_contact) -> i32 {
    // SAFETY: what the caller was asked for above.
    unsafe { prepare(p, contact, Contact::elliptic) }
}

/// Tractions \[Pa\] at x\[n\] \[m\] along the width, under a monotonically grown force \[N\] (Eq. 17, 21-24); 0 outside the
/// contact. Elliptical: on the x axis.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE, MSLIP_FORCE_EXCEEDS_SLIP or MSLIP_BAD_POSITION.
///
/// # Safety
/// Pointers are NULL or point to n numbers; outputs overlap nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_tractions(
    contact: *const mslip_contact,
    force: f64,
    n: size_t,
    x: *const f64,
    pressure: *mut f64,
    shear: *mut f64,
) -> i32 {
    let compute = || {
        // SAFETY: what the caller was asked for above.
        let (contact, x, [mut pressure, mut shear]) =
            unsafe { (pointer::contact(contact)?, input(x, n)?, outputs([pressure, shear], n)?) };
        let point = contact.curve_at_force(force)?;
        check_positions(x)?;
        for (i, &x) in x.iter().enumerate() {
            set(&mut pressure, i, || contact.pressure(x));
            set(&mut shear, i, || point.shear(x));
        }
        Ok(())
    };
    status(compute())
}

fn check_positions(x: &[f64]) -> Result<(), Error> {
    if x.iter().all(|&x| is_finite(x)) { Ok(()) } else { Err(Error::BadPosition) }
}

/// Relative slip \[m\] (Eq. 15) and frictional damage parameter mu p |s| \[N/m\] (section 3.5) at x\[n\] \[m\], under a
/// monotonically grown force \[N\]; 0 in the stick zone and outside the contact.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE, MSLIP_FORCE_EXCEEDS_SLIP, MSLIP_BAD_POSITION, or
/// MSLIP_NOT_AVAILABLE for an elliptical contact.
///
/// # Safety
/// Pointers are NULL or point to n numbers; outputs overlap nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_slip(
    contact: *const mslip_contact,
    force: f64,
    n: size_t,
    x: *const f64,
    slip: *mut f64,
    damage: *mut f64,
) -> i32 {
    let compute = || {
        // SAFETY: what the caller was asked for above.
        let (contact, x, [mut slip, mut damage]) =
            unsafe { (pointer::contact(contact)?, input(x, n)?, outputs([slip, damage], n)?) };
        let point = contact.curve_at_force(force)?;
        check_positions(x)?;
        point.slip(0.0)?;
        if slip.is_none() && damage.is_none() {
            return Ok(());
        }
        for (i, &x) in x.iter().enumerate() {
            let here = point.slip(x)?;
            set(&mut slip, i, || here);
            set(&mut damage, i, || point.damage_of(x, here));
        }
        Ok(())
    };
    status(compute())
}

/// Monotonic curve (Eq. 10), odd in the force: displacement \[m\], compliance \[m/N\] and stick half-width \[m\] at
/// force\[n\] \[N\]. The compliance at mu N is infinite for a cylinder and an elliptical contact.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_FORCE or MSLIP_FORCE_EXCEEDS_SLIP.
///
/// # Safety
/// Pointers are NULL or point to n numbers; outputs overlap nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_monotonic_displacement(
    contact: *const mslip_contact,
    n: size_t,
    force: *const f64,
    displacement: *mut f64,
    compliance: *mut f64,
    stick_half_width: *mut f64,
) -> i32 {
    let compute = || {
        // SAFETY: what the caller was asked for above.
        let (contact, force, [mut displacement, mut compliance, mut stick_half_width]) = unsafe {
            let outputs = outputs([displacement, compliance, stick_half_width], n);
            (pointer::contact(contact)?, input(force, n)?, outputs?)
        };
        force.iter().try_for_each(|&force| contact.check_force(force))?;
        if displacement.is_none() && compliance.is_none() && stick_half_width.is_none() {
            return Ok(());
        }
        for (i, &force) in force.iter().enumerate() {
            let point = contact.curve_at_force(force)?;
            set(&mut displacement, i, || point.displacement());
            set(&mut compliance, i, || point.compliance());
            set(&mut stick_half_width, i, || point.stick_half_width());
        }
        Ok(())
    };
    status(compute())
}

/// Inverse of the monotonic curve, odd in the displacement: force \[N\], stiffness \[N/m\] and stick half-width \[m\] at
/// displacement\[n\] \[m\]. Beyond slip_displacement the force stays at mu N, and stiffness and stick half-width are 0.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT or MSLIP_BAD_DISPLACEMENT.
///
/// # Safety
/// Pointers are NULL or point to n numbers; outputs overlap nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_monotonic_force(
    contact: *const mslip_contact,
    n: size_t,
    displacement: *const f64,
    force: *mut f64,
    stiffness: *mut f64,
    stick_half_width: *mut f64,
) -> i32 {
    let compute = || {
        // SAFETY: what the caller was asked for above.
        let (contact, displacement, [force, stiffness, stick_half_width]) = unsafe {
            let outputs = outputs([force, stiffness, stick_half_width], n);
            (pointer::contact(contact)?, input(displacement, n)?, outputs?)
        };
        displacement.iter().try_for_each(|&displacement| crate::contact::check_displacement(displacement))?;
        responses(contact, displacement, force, stiffness);
        if let Some(stick_half_width) = stick_half_width {
            for (c, &displacement) in stick_half_width.iter_mut().zip(displacement) {
                *c = contact.curve_at_displacement(displacement)?.stick_half_width();
            }
        }
        Ok(())
    };
    status(compute())
}

fn responses(contact: &Contact, displacement: &[f64], force: Option<&mut [f64]>, stiffness: Option<&mut [f64]>) {
    on_widest!(
        Contact::responses,
        contact: &Contact,
        displacement: &[f64],
        force: Option<&mut [f64]>,
        stiffness: Option<&mut [f64]> => ()
    );
}

/// Doubles of a state that holds that many nested reversals.
#[unsafe(no_mangle)]
pub extern "C" fn mslip_state_length(reversals: size_t) -> size_t {
    memory::state_length(reversals)
}

/// Makes a virgin state: no force, no displacement. A state goes on wherever its numbers are copied: one that is full at the
/// beginning of a longer array, one with room to spare in a shorter, as long as that holds its reversals.
///
/// Returns MSLIP_NULL_POINTER or MSLIP_STATE_TOO_SHORT.
///
/// # Safety
/// `state` is NULL or points to state_length numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_state_init(state_length: size_t, state: *mut f64) -> i32 {
    let init = || {
        check_length::<f64>(state_length)?;
        if state.is_null() {
            return Err(Error::NullPointer);
        }
        // SAFETY: what the caller was asked for above.
        memory::state_init(unsafe { output(state, state_length) }?.ok_or(Error::StateTooShort)?)
    };
    status(init())
}

/// Leads a contact from a state to a displacement \[m\]: force \[N\], tangent stiffness \[N/m\], and energy dissipated by this
/// step \[J\] (Eq. 11, 12). state1 may be state0; where it is NULL the new state is not kept.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_STATE, MSLIP_BAD_DISPLACEMENT, or
/// MSLIP_STATE_FULL where a further reversal would have to be remembered than the state holds.
///
/// # Safety
/// Pointers are NULL or point to state_length numbers (states) or one; state1 is state0 or overlaps nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_masing_update(
    contact: *const mslip_contact,
    state_length: size_t,
    state0: *const f64,
    displacement: f64,
    state1: *mut f64,
    force: *mut f64,
    stiffness: *mut f64,
    dissipated: *mut f64,
) -> i32 {
    let update = || {
        // SAFETY: what the caller was asked for above.
        unsafe {
            let contact = pointer::contact(contact)?;
            [state1, force, stiffness, dissipated].iter().try_for_each(|output| check_alignment(*output))?;
            update_one(contact, state_length, state0, displacement, state1, [force, stiffness, dissipated])
        }
    };
    status(update())
}

/// One update; nothing is written unless all is well.
///
/// # Safety
/// As `mslip_masing_update`, and the new state and the outputs are aligned; these in the order force, stiffness, dissipated.
pub(super) unsafe fn update_one(
    contact: &Contact,
    state_length: usize,
    state0: *const f64,
    displacement: f64,
    state1: *mut f64,
    outputs: [*mut f64; 3],
) -> Result<(), Error> {
    let (step, energy) = {
        // SAFETY: the caller's word; the new state, which may be the same memory, is written when this reference has gone.
        let state = unsafe { input(state0, state_length) }?;
        if state1.is_null() && outputs.iter().all(|output| output.is_null()) {
            return masing::check_step(contact, state, displacement);
        }
        let step = masing::step(contact, state, displacement)?;
        let wanted = outputs.get(2).is_some_and(|dissipated| !dissipated.is_null());
        (step, if wanted { step.dissipated(state)? } else { 0.0 })
    };
    if !state1.is_null() {
        if !ptr::eq(state0, state1) {
            // SAFETY: aligned, and of that length by the caller's word.
            unsafe { ptr::copy(state0, state1, state_length) };
        }
        // SAFETY: the same.
        if let Some(state) = unsafe { wanted(state1, state_length) } {
            step.write(state);
        }
    }
    // SAFETY: aligned, and NULL or one number by the caller's word.
    let [mut force, mut stiffness, mut dissipated] = outputs.map(|pointer| unsafe { wanted(pointer, 1) });
    set(&mut force, 0, || step.force());
    set(&mut stiffness, 0, || step.stiffness());
    set(&mut dissipated, 0, || energy);
    Ok(())
}

/// Leads a contact through n displacements \[m\]; force\[n\] \[N\], stiffness\[n\] \[N/m\] and dissipated\[n\] \[J\] are those of
/// each step. state1 holds the last state and may be state0; where it is NULL the last state is not kept.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_STATE, MSLIP_BAD_DISPLACEMENT, or
/// MSLIP_STATE_FULL where the path nests more reversals than the state holds. A path with more turning points than the
/// state has room for, or one whose state is not kept, may nest 2048 at most, and takes 40 kB of stack.
///
/// # Safety
/// Pointers are NULL or point to state_length numbers (states) or n; state1 is state0 or overlaps nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_masing_path(
    contact: *const mslip_contact,
    state_length: size_t,
    state0: *const f64,
    n: size_t,
    displacement: *const f64,
    state1: *mut f64,
    force: *mut f64,
    stiffness: *mut f64,
    dissipated: *mut f64,
) -> i32 {
    let walk = || {
        // SAFETY: what the caller was asked for above.
        let (contact, path, start, [force, stiffness, dissipated]) = unsafe {
            let (contact, path) = (pointer::contact(contact)?, input(displacement, n)?);
            (contact, path, input(state0, state_length)?, outputs([force, stiffness, dissipated], n)?)
        };
        check_alignment(state1)?;
        let output = PathOutput { force, stiffness, dissipated };
        if state1.is_null() {
            // Checked and led in copies that follow each other: one at a time is on the stack.
            masing::in_copy(start, |copy| masing::check_path_in(contact, copy, path))?;
            return masing::in_copy(start, |copy| lead(contact, copy, path, output));
        }
        masing::check_path(contact, start, path)?;
        if !ptr::eq(state0, state1) {
            // SAFETY: as above, and aligned.
            unsafe { ptr::copy(state0, state1, state_length) };
        }
        // SAFETY: as above; the old state, which may be the same memory, is not looked at again.
        let state = unsafe { wanted(state1, state_length) }.ok_or(Error::StateTooShort)?;
        lead(contact, state, path, output)
    };
    status(walk())
}

fn lead(contact: &Contact, state: &mut [f64], path: &[f64], output: PathOutput) -> Result<(), Error> {
    on_widest!(
        masing::lead,
        contact: &Contact,
        state: &mut [f64],
        path: &[f64],
        output: PathOutput => Result<(), Error>
    )
}

/// Tractions \[Pa\] at x\[n\] \[m\] after any history (Eq. 21 superposed by Masing's rule).
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_STATE, MSLIP_BAD_POSITION, or
/// MSLIP_FORCE_EXCEEDS_SLIP for the state of another contact.
///
/// # Safety
/// Pointers are NULL or point to state_length numbers (the state) or n; outputs overlap nothing.
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
    let compute = || {
        // SAFETY: what the caller was asked for above.
        let (contact, state, x, [mut pressure, shear]) = unsafe {
            let (contact, state) = (pointer::contact(contact)?, input(state, state_length)?);
            (contact, state, input(x, n)?, outputs([pressure, shear], n)?)
        };
        check_positions(x)?;
        masing::shear_after(contact, state, x, shear.unwrap_or(&mut []))?;
        x.iter().enumerate().for_each(|(i, &x)| set(&mut pressure, i, || contact.pressure(x)));
        Ok(())
    };
    status(compute())
}
