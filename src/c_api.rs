//! The C interface: a thin shell that turns pointers into slices, asks the modules, and writes what was wanted.
//!
//! The only module with `unsafe`. Every function follows one order: take the inputs, check them all, compute, write. What
//! is refused has written nothing.

#![allow(unsafe_code, non_camel_case_types)]

use crate::contact::Contact;
use crate::error::Error;
use crate::harmonic::check_amplitude;
use crate::harmonic_force::{self, HarmonicOutput, Workspace};
use crate::parameters::{EllipticParameters, Parameters};
use crate::{equivalent, masing};
use core::ptr;
use core::slice;
use libc::{c_char, size_t};

/// Raised whenever a name, a meaning or a size of this interface changes.
pub const MSLIP_ABI_VERSION: i32 = 1;

/// Displacement of the centre point under a line of uniform traction: the paper's Eq. 5-10.
pub const MSLIP_CENTRE_POINT: i32 = 0;
/// Displacement of a rigid strip, corrected to three-dimensional contact mechanics.
pub const MSLIP_RIGID_STRIP: i32 = 1;

/// All went well.
pub const MSLIP_OK: i32 = 0;
/// A required pointer is NULL.
pub const MSLIP_NULL_POINTER: i32 = 1;
/// flat_half_width is not a finite number >= 0.
pub const MSLIP_BAD_FLAT_HALF_WIDTH: i32 = 2;
/// edge_radius is not a finite number > 0.
pub const MSLIP_BAD_EDGE_RADIUS: i32 = 3;
/// length is not a finite number > 0.
pub const MSLIP_BAD_LENGTH: i32 = 4;
/// normal_force is not a finite number >= 0.
pub const MSLIP_BAD_NORMAL_FORCE: i32 = 5;
/// friction_coefficient is not a finite number >= 0.
pub const MSLIP_BAD_FRICTION_COEFFICIENT: i32 = 6;
/// A young_modulus is not a finite number > 0.
pub const MSLIP_BAD_YOUNG_MODULUS: i32 = 7;
/// A poisson_ratio is not in 0 <= nu <= 0.5.
pub const MSLIP_BAD_POISSON_RATIO: i32 = 8;
/// displacement_reference is neither MSLIP_CENTRE_POINT nor MSLIP_RIGID_STRIP.
pub const MSLIP_BAD_DISPLACEMENT_REFERENCE: i32 = 9;
/// semi_axis_x is not a finite number > 0.
pub const MSLIP_BAD_SEMI_AXIS_X: i32 = 10;
/// semi_axis_y is not a finite number > 0.
pub const MSLIP_BAD_SEMI_AXIS_Y: i32 = 11;
/// 2 length <= half-width, or the initial stiffness would not be positive.
pub const MSLIP_LENGTH_TOO_SHORT: i32 = 12;
/// Half-width, force, displacement or energy would be out of range.
pub const MSLIP_OUT_OF_RANGE: i32 = 13;
/// The contact was never prepared, or its memory was changed.
pub const MSLIP_BAD_CONTACT: i32 = 20;
/// The state was never initialised, or its memory was changed.
pub const MSLIP_BAD_STATE: i32 = 21;
/// The workspace was never initialised, or its memory was changed.
pub const MSLIP_BAD_WORKSPACE: i32 = 22;
/// state_length is below mslip_state_length(0).
pub const MSLIP_STATE_TOO_SHORT: i32 = 23;
/// The state holds no further reversal.
pub const MSLIP_STATE_FULL: i32 = 24;
/// workspace_length is below mslip_harmonic_workspace_length.
pub const MSLIP_WORKSPACE_TOO_SHORT: i32 = 25;
/// A force is not finite.
pub const MSLIP_BAD_FORCE: i32 = 30;
/// |force| exceeds mu N.
pub const MSLIP_FORCE_EXCEEDS_SLIP: i32 = 31;
/// A displacement is not finite, or beyond 1e150.
pub const MSLIP_BAD_DISPLACEMENT: i32 = 32;
/// A position x is not finite.
pub const MSLIP_BAD_POSITION: i32 = 33;
/// A displacement amplitude is not finite, negative, or beyond 1e150.
pub const MSLIP_BAD_AMPLITUDE: i32 = 34;
/// A force amplitude is not finite, or negative.
pub const MSLIP_BAD_FORCE_AMPLITUDE: i32 = 35;
/// The number of harmonics is 0, or too large.
pub const MSLIP_BAD_HARMONICS: i32 = 36;
/// The number of samples does not exceed twice the number of harmonics, or is too large.
pub const MSLIP_BAD_SAMPLES: i32 = 37;
/// The number of sliders is 0.
pub const MSLIP_BAD_COUNT: i32 = 38;
/// Not available for this kind of contact, or no equivalent exists.
pub const MSLIP_NOT_AVAILABLE: i32 = 40;
/// An array is too long to be addressed; in Fortran also: too short, or sizes that do not agree.
pub const MSLIP_BAD_ARRAY_SIZE: i32 = 90;

/// A contact: prepared once, then only read. Plain data of fixed size that may be copied, stored and sent.
/// An open contact (N = 0) has zero width, force and stiffness.
#[repr(C)]
pub struct mslip_contact {
    /// E*, Eq. 2 \[Pa\].
    pub composite_modulus: f64,
    /// Half-width b of the contact under its normal force \[m\]; elliptical: semi_axis_x.
    pub half_width: f64,
    /// mu N \[N\].
    pub slip_force: f64,
    /// Displacement at which gross slip starts on the monotonic curve \[m\].
    pub slip_displacement: f64,
    /// dT/d(displacement) at 0 \[N/m\].
    pub initial_stiffness: f64,
    /// Dissipated per cycle at incipient gross slip \[J\].
    pub slip_energy: f64,
    /// Prepared coefficients and marks: not to be read or written.
    pub reserved: [f64; 122],
}

const _: () = {
    assert!(size_of::<mslip_contact>() == size_of::<Contact>() && align_of::<mslip_contact>() == align_of::<Contact>());
    assert!(core::mem::offset_of!(mslip_contact, slip_energy) == core::mem::offset_of!(Contact, slip_energy));
    assert!(core::mem::offset_of!(Contact, composite_modulus) == 0 && core::mem::offset_of!(Contact, half_width) == 8);
    assert!(
        core::mem::offset_of!(Contact, slip_force) == 16 && core::mem::offset_of!(Contact, slip_displacement) == 24
    );
    assert!(
        core::mem::offset_of!(Contact, initial_stiffness) == 32 && core::mem::offset_of!(Contact, slip_energy) == 40
    );
    assert!(size_of::<Parameters>() == 80 && size_of::<EllipticParameters>() == 64);
    assert!(core::mem::offset_of!(Parameters, material) == 40);
    assert!(core::mem::offset_of!(Parameters, displacement_reference) == 72);
    assert!(core::mem::offset_of!(EllipticParameters, material) == 32);
};

// ---------------------------------------------------------------------------------------------------------------------
// Pointers and slices

fn status(result: Result<(), Error>) -> i32 {
    match result {
        Ok(()) => MSLIP_OK,
        Err(error) => error.code(),
    }
}

/// More numbers than memory can hold.
fn check_length<T>(n: usize) -> Result<(), Error> {
    if n <= isize::MAX as usize / size_of::<T>().max(1) { Ok(()) } else { Err(Error::BadArraySize) }
}

/// An input of n items.
///
/// # Safety
/// `pointer` is NULL or points to n items that are not written while the slice lives.
unsafe fn input<'a, T>(pointer: *const T, n: usize) -> Result<&'a [T], Error> {
    check_length::<T>(n)?;
    if n == 0 {
        Ok(&[])
    } else if pointer.is_null() {
        Err(Error::NullPointer)
    } else {
        Ok(unsafe { slice::from_raw_parts(pointer, n) })
    }
}

/// An output of n items; `None` is not wanted.
///
/// # Safety
/// `pointer` is NULL or points to n items that nobody else uses while the slice lives.
unsafe fn output<'a, T>(pointer: *mut T, n: usize) -> Option<&'a mut [T]> {
    if pointer.is_null() || n == 0 || check_length::<T>(n).is_err() {
        None
    } else {
        Some(unsafe { slice::from_raw_parts_mut(pointer, n) })
    }
}

/// A contact that was prepared.
///
/// # Safety
/// `pointer` is NULL or points to a contact.
unsafe fn contact<'a>(pointer: *const mslip_contact) -> Result<&'a Contact, Error> {
    let contact = unsafe { pointer.cast::<Contact>().as_ref() }.ok_or(Error::NullPointer)?;
    if contact.is_prepared() { Ok(contact) } else { Err(Error::BadContact) }
}

/// Sets item i of an output.
fn set(output: &mut Option<&mut [f64]>, i: usize, value: impl FnOnce() -> f64) {
    if let Some(place) = output.as_mut().and_then(|output| output.get_mut(i)) {
        *place = value();
    }
}

/// The items of an interface that take part: their numbers, each with its contact, all checked before the first is used.
///
/// # Safety
/// `contacts` and `active` are NULL or point to n items.
unsafe fn active_contacts<'a>(
    n: usize,
    contacts: *const mslip_contact,
    active: *const i32,
) -> Result<impl Iterator<Item = (usize, &'a Contact)> + Clone, Error> {
    let contacts = unsafe { input(contacts.cast::<Contact>(), n) }?;
    let active: Option<&'a [i32]> = if active.is_null() { None } else { Some(unsafe { input(active, n) }?) };
    let takes_part = move |i: usize| active.is_none_or(|active| active.get(i).is_none_or(|&flag| flag != 0));
    let items = contacts.iter().enumerate().filter(move |(i, _)| takes_part(*i));
    for (_, contact) in items.clone() {
        if !contact.is_prepared() {
            return Err(Error::BadContact);
        }
    }
    Ok(items)
}

// ---------------------------------------------------------------------------------------------------------------------
// Version and status

/// Version of the library, "1.2.3".
#[unsafe(no_mangle)]
pub extern "C" fn mslip_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

/// Version of this interface: equals MSLIP_ABI_VERSION of the header that belongs to the library.
#[unsafe(no_mangle)]
pub extern "C" fn mslip_abi_version() -> i32 {
    MSLIP_ABI_VERSION
}

/// What a status says is wrong, and what is allowed: a static sentence.
#[unsafe(no_mangle)]
pub extern "C" fn mslip_status_text(status: i32) -> *const c_char {
    if status == MSLIP_OK {
        return c"all went well".as_ptr();
    }
    let known = Error::ALL.iter().find(|error| error.code() == status);
    known.map_or(c"this status is not one of microslip's", |error| error.sentence()).as_ptr()
}

// ---------------------------------------------------------------------------------------------------------------------
// Parameters and contact

/// Parameters with every number unset (NaN), so that a forgotten one is refused by name; the centre point as reference.
/// NULL is ignored.
///
/// # Safety
/// `p` is NULL or points to parameters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_parameters_default(p: *mut Parameters) {
    if !p.is_null() {
        unsafe { p.write(Parameters::default()) }
    }
}

/// Elliptical parameters with every number unset (NaN). NULL is ignored.
///
/// # Safety
/// `p` is NULL or points to parameters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_elliptic_parameters_default(p: *mut EllipticParameters) {
    if !p.is_null() {
        unsafe { p.write(EllipticParameters::default()) }
    }
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
    let prepare = || {
        let parameters = unsafe { p.as_ref() }.ok_or(Error::NullPointer)?;
        if contact.is_null() {
            return Err(Error::NullPointer);
        }
        unsafe { contact.cast::<Contact>().write(Contact::rounded_flat(parameters)?) };
        Ok(())
    };
    status(prepare())
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
    let prepare = || {
        let parameters = unsafe { p.as_ref() }.ok_or(Error::NullPointer)?;
        if contact.is_null() {
            return Err(Error::NullPointer);
        }
        unsafe { contact.cast::<Contact>().write(Contact::elliptic(parameters)?) };
        Ok(())
    };
    status(prepare())
}

// ---------------------------------------------------------------------------------------------------------------------
// Tractions, slip and the monotonic curve

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
        let contact = unsafe { self::contact(contact) }?;
        let x = unsafe { input(x, n) }?;
        let point = contact.curve_at_force(force)?;
        check_positions(x)?;
        let (mut pressure, mut shear) = unsafe { (output(pressure, n), output(shear, n)) };
        for (i, &x) in x.iter().enumerate() {
            set(&mut pressure, i, || contact.pressure(x));
            set(&mut shear, i, || point.shear(x));
        }
        Ok(())
    };
    status(compute())
}

fn check_positions(x: &[f64]) -> Result<(), Error> {
    if x.iter().all(|x| x.is_finite()) { Ok(()) } else { Err(Error::BadPosition) }
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
        let contact = unsafe { self::contact(contact) }?;
        let x = unsafe { input(x, n) }?;
        let point = contact.curve_at_force(force)?;
        check_positions(x)?;
        point.slip(0.0)?;
        let (mut slip, mut damage) = unsafe { (output(slip, n), output(damage, n)) };
        for (i, &x) in x.iter().enumerate() {
            let here = point.slip(x)?;
            set(&mut slip, i, || here);
            set(&mut damage, i, || point.damage(x, here));
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
        let contact = unsafe { self::contact(contact) }?;
        let force = unsafe { input(force, n) }?;
        force.iter().try_for_each(|&force| contact.check_force(force))?;
        let (mut displacement, mut compliance) = unsafe { (output(displacement, n), output(compliance, n)) };
        let mut stick_half_width = unsafe { output(stick_half_width, n) };
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
        let contact = unsafe { self::contact(contact) }?;
        let displacement = unsafe { input(displacement, n) }?;
        displacement.iter().try_for_each(|&displacement| crate::curve::check_displacement(displacement))?;
        let (mut force, mut stiffness) = unsafe { (output(force, n), output(stiffness, n)) };
        let mut stick_half_width = unsafe { output(stick_half_width, n) };
        for (i, &displacement) in displacement.iter().enumerate() {
            let point = contact.curve_at_displacement(displacement)?;
            set(&mut force, i, || point.force());
            set(&mut stiffness, i, || point.stiffness());
            set(&mut stick_half_width, i, || point.stick_half_width());
        }
        Ok(())
    };
    status(compute())
}

// ---------------------------------------------------------------------------------------------------------------------
// Masing's rule with its memory

/// Doubles of a state that holds that many nested reversals.
#[unsafe(no_mangle)]
pub extern "C" fn mslip_state_length(reversals: size_t) -> size_t {
    masing::state_length(reversals)
}

/// Makes a virgin state: no force, no displacement.
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
        masing::state_init(unsafe { output(state, state_length) }.ok_or(Error::StateTooShort)?)
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
        let contact = unsafe { self::contact(contact) }?;
        unsafe { update_one(contact, state_length, state0, displacement, state1, [force, stiffness, dissipated]) }
    };
    status(update())
}

/// One update; nothing is written unless all is well.
///
/// # Safety
/// As `mslip_masing_update`; outputs in the order force, stiffness, dissipated.
unsafe fn update_one(
    contact: &Contact,
    state_length: usize,
    state0: *const f64,
    displacement: f64,
    state1: *mut f64,
    outputs: [*mut f64; 3],
) -> Result<(), Error> {
    let (step, energy) = {
        let state = unsafe { input(state0, state_length) }?;
        let step = masing::step(contact, state, displacement)?;
        let wanted = outputs.get(2).is_some_and(|dissipated| !dissipated.is_null());
        (step, if wanted { step.dissipated(state)? } else { 0.0 })
    };
    if !state1.is_null() {
        if !ptr::eq(state0, state1) {
            unsafe { ptr::copy(state0, state1, state_length) };
        }
        if let Some(state) = unsafe { output(state1, state_length) } {
            step.write(state);
        }
    }
    let [mut force, mut stiffness, mut dissipated] = outputs.map(|pointer| unsafe { output(pointer, 1) });
    set(&mut force, 0, || step.force());
    set(&mut stiffness, 0, || step.stiffness());
    set(&mut dissipated, 0, || energy);
    Ok(())
}

/// Leads a contact through n displacements \[m\]; force\[n\] \[N\], stiffness\[n\] \[N/m\] and dissipated\[n\] \[J\] are those of
/// each step. state1 holds the last state and may be state0.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_STATE, MSLIP_BAD_DISPLACEMENT, or
/// MSLIP_STATE_FULL where the path nests more reversals than the state holds, or more than 512 beyond which a path has to
/// be walked step by step.
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
        let contact = unsafe { self::contact(contact) }?;
        let path = unsafe { input(displacement, n) }?;
        masing::check_path(contact, unsafe { input(state0, state_length) }?, path)?;
        if state1.is_null() {
            return Err(Error::NullPointer);
        }
        if !ptr::eq(state0, state1) {
            unsafe { ptr::copy(state0, state1, state_length) };
        }
        let state = unsafe { output(state1, state_length) }.ok_or(Error::StateTooShort)?;
        let [mut force, mut stiffness, mut dissipated] =
            [force, stiffness, dissipated].map(|pointer| unsafe { output(pointer, n) });
        for (i, &displacement) in path.iter().enumerate() {
            let step = masing::step(contact, state, displacement)?;
            if dissipated.is_some() {
                let energy = step.dissipated(state)?;
                set(&mut dissipated, i, || energy);
            }
            step.write(state);
            set(&mut force, i, || step.force());
            set(&mut stiffness, i, || step.stiffness());
        }
        Ok(())
    };
    status(walk())
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
        let contact = unsafe { self::contact(contact) }?;
        let state = unsafe { input(state, state_length) }?;
        let x = unsafe { input(x, n) }?;
        check_positions(x)?;
        masing::shear_after(contact, state, 0.0)?;
        let (mut pressure, mut shear) = unsafe { (output(pressure, n), output(shear, n)) };
        for (i, &x) in x.iter().enumerate() {
            set(&mut pressure, i, || contact.pressure(x));
            if shear.is_some() {
                let here = masing::shear_after(contact, state, x)?;
                set(&mut shear, i, || here);
            }
        }
        Ok(())
    };
    status(compute())
}

// ---------------------------------------------------------------------------------------------------------------------
// Cycles of prescribed amplitude

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
        let contact = unsafe { self::contact(contact) }?;
        check_length::<f64>(n)?;
        check_amplitude(amplitude)?;
        let (mut displacement, mut force) = unsafe { (output(displacement, n), output(force, n)) };
        if displacement.is_none() && force.is_none() {
            return Ok(());
        }
        for i in 0..n {
            let (u, t) = contact.hysteresis_loop(amplitude, i as f64 / n as f64)?;
            set(&mut displacement, i, || u);
            set(&mut force, i, || t);
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
        let contact = unsafe { self::contact(contact) }?;
        let amplitude = unsafe { input(force_amplitude, n) }?;
        amplitude.iter().try_for_each(|&amplitude| contact.check_force_amplitude(amplitude))?;
        let Some(energy) = (unsafe { output(energy, n) }) else { return Ok(()) };
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
        let contact = unsafe { self::contact(contact) }?;
        let amplitude = unsafe { input(amplitude, n) }?;
        amplitude.iter().try_for_each(|&amplitude| check_amplitude(amplitude))?;
        let mut outputs = [k_real, k_imag, dk_real, dk_imag].map(|pointer| unsafe { output(pointer, n) });
        for (i, &amplitude) in amplitude.iter().enumerate() {
            write_complex_stiffness(contact, amplitude, i, &mut outputs)?;
        }
        Ok(())
    };
    status(compute())
}

/// The outputs that are wanted, in the order of `mslip_complex_stiffness`.
fn write_complex_stiffness(
    contact: &Contact,
    amplitude: f64,
    i: usize,
    outputs: &mut [Option<&mut [f64]>; 4],
) -> Result<(), Error> {
    if outputs.iter().all(Option::is_none) {
        return Ok(());
    }
    let stiffness = contact.complex_stiffness(amplitude)?;
    let [k_real, k_imag, dk_real, dk_imag] = outputs;
    set(k_real, i, || stiffness.real());
    set(k_imag, i, || stiffness.imaginary());
    set(dk_real, i, || stiffness.real_slope());
    set(dk_imag, i, || stiffness.imaginary_slope());
    Ok(())
}

// ---------------------------------------------------------------------------------------------------------------------
// Harmonic force

/// Doubles of a workspace for so many harmonics H >= 1 and samples > 2H a period; 0 where these are not allowed.
#[unsafe(no_mangle)]
pub extern "C" fn mslip_harmonic_workspace_length(harmonics: size_t, samples: size_t) -> size_t {
    harmonic_force::workspace_length(harmonics, samples)
}

/// Prepares a workspace: tables for one pair of harmonics and samples, and scratch memory. One for each thread.
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
    let init = || {
        check_length::<f64>(workspace_length)?;
        if workspace.is_null() {
            return Err(Error::NullPointer);
        }
        let workspace = unsafe { output(workspace, workspace_length) }.unwrap_or(&mut []);
        harmonic_force::workspace_init(harmonics, samples, workspace)
    };
    status(init())
}

/// Harmonic force by alternating between frequency and time, in steady state (the second of two periods from the virgin
/// state). Coefficients \[c0, cos1, sin1, cos2, sin2, ...\], 2H+1 of them: displacement \[m\], force \[N\]; jacobian \[N/m\] is
/// d force_i / d displacement_j, (2H+1) x (2H+1), column-major; dissipated \[J\] is per period.
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
        let contact = unsafe { self::contact(contact) }?;
        let mut workspace = unsafe { self::workspace(workspace) }?;
        let n = workspace.coefficients();
        let displacement = unsafe { input(displacement, n) }?;
        let output = HarmonicOutput {
            force: unsafe { output(force, n) },
            jacobian: unsafe { output(jacobian, n * n) },
            dissipated: unsafe { dissipated.as_mut() },
        };
        harmonic_force::harmonic_force(contact, &mut workspace, displacement, output)
    };
    status(compute())
}

/// A workspace that was initialised.
///
/// # Safety
/// `pointer` is NULL or points to three numbers at least, and to a whole workspace where these begin one.
unsafe fn workspace<'a>(pointer: *mut f64) -> Result<Workspace<'a>, Error> {
    if pointer.is_null() {
        return Err(Error::NullPointer);
    }
    let header = unsafe { pointer.cast::<[f64; 3]>().read() };
    let extent = harmonic_force::workspace_extent(&header)?;
    Workspace::new(unsafe { output(pointer, extent) }.ok_or(Error::BadWorkspace)?)
}

// ---------------------------------------------------------------------------------------------------------------------
// Many contacts at once

/// mslip_complex_stiffness of n contacts, one amplitude each. Items whose active flag is 0 are skipped.
///
/// Returns the codes of mslip_complex_stiffness; then no item has written anything.
///
/// # Safety
/// Pointers are NULL or point to n items; outputs overlap nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_interface_complex_stiffness(
    n: size_t,
    contacts: *const mslip_contact,
    active: *const i32,
    amplitude: *const f64,
    k_real: *mut f64,
    k_imag: *mut f64,
    dk_real: *mut f64,
    dk_imag: *mut f64,
) -> i32 {
    let compute = || {
        let items = unsafe { active_contacts(n, contacts, active) }?;
        let amplitude = unsafe { input(amplitude, n) }?;
        let items = items.filter_map(|(i, contact)| Some((i, contact, *amplitude.get(i)?)));
        items.clone().try_for_each(|(_, _, amplitude)| check_amplitude(amplitude))?;
        let mut outputs = [k_real, k_imag, dk_real, dk_imag].map(|pointer| unsafe { output(pointer, n) });
        for (i, contact, amplitude) in items {
            write_complex_stiffness(contact, amplitude, i, &mut outputs)?;
        }
        Ok(())
    };
    status(compute())
}

/// mslip_masing_update of n contacts: states hold state_length numbers an item, item after item; displacement, force,
/// stiffness and dissipated one. Items whose active flag is 0 are skipped, their states too. states1 may be states0.
///
/// Returns the codes of mslip_masing_update; then no item has written anything.
///
/// # Safety
/// Pointers are NULL or as long as said; states1 is states0 or overlaps nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_interface_masing_update(
    n: size_t,
    contacts: *const mslip_contact,
    active: *const i32,
    state_length: size_t,
    states0: *const f64,
    displacement: *const f64,
    states1: *mut f64,
    force: *mut f64,
    stiffness: *mut f64,
    dissipated: *mut f64,
) -> i32 {
    let update = || {
        let items = unsafe { active_contacts(n, contacts, active) }?;
        let displacement = unsafe { input(displacement, n) }?;
        let items = items.filter_map(|(i, contact)| Some((i, contact, *displacement.get(i)?)));
        let length = n.checked_mul(state_length).ok_or(Error::BadArraySize)?;
        {
            let states = unsafe { input(states0, length) }?;
            if n > 0 && state_length == 0 {
                return Err(Error::StateTooShort);
            }
            for (i, contact, displacement) in items.clone() {
                let state = states.get(i * state_length..(i + 1) * state_length).ok_or(Error::BadArraySize)?;
                masing::check_step(contact, state, displacement)?;
            }
        }
        let at =
            |pointer: *mut f64, offset: usize| if pointer.is_null() { pointer } else { pointer.wrapping_add(offset) };
        for (i, contact, displacement) in items {
            let outputs = [at(force, i), at(stiffness, i), at(dissipated, i)];
            let state0 = states0.wrapping_add(i * state_length);
            unsafe { update_one(contact, state_length, state0, displacement, at(states1, i * state_length), outputs) }?;
        }
        Ok(())
    };
    status(update())
}

/// mslip_harmonic_force of n contacts through one workspace: displacement and force hold 2H+1 numbers an item, jacobian
/// (2H+1)^2, dissipated one. Items whose active flag is 0 are skipped.
///
/// Returns the codes of mslip_harmonic_force; then no item has written anything.
///
/// # Safety
/// `workspace` is NULL or was initialised; the others are NULL or as long as said; outputs overlap nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_interface_harmonic_force(
    n: size_t,
    contacts: *const mslip_contact,
    active: *const i32,
    workspace: *mut f64,
    displacement: *const f64,
    force: *mut f64,
    jacobian: *mut f64,
    dissipated: *mut f64,
) -> i32 {
    let compute = || {
        let items = unsafe { active_contacts(n, contacts, active) }?;
        let mut workspace = unsafe { self::workspace(workspace) }?;
        let one = workspace.coefficients();
        let (all, square) = (n.checked_mul(one), n.checked_mul(one * one));
        let (all, square) = (all.ok_or(Error::BadArraySize)?, square.ok_or(Error::BadArraySize)?);
        let displacement = unsafe { input(displacement, all) }?;
        check_length::<f64>(square)?;
        let items = items.filter_map(|(i, contact)| Some((i, contact, displacement.get(i * one..(i + 1) * one)?)));
        items.clone().try_for_each(|(_, _, displacement)| harmonic_force::check_coefficients(displacement))?;
        let (mut force, mut jacobian) = unsafe { (output(force, all), output(jacobian, square)) };
        let mut dissipated = unsafe { output(dissipated, n) };
        for (i, contact, displacement) in items {
            let output = HarmonicOutput {
                force: force.as_mut().and_then(|force| force.get_mut(i * one..(i + 1) * one)),
                jacobian: jacobian.as_mut().and_then(|jacobian| jacobian.get_mut(i * one * one..(i + 1) * one * one)),
                dissipated: dissipated.as_mut().and_then(|dissipated| dissipated.get_mut(i)),
            };
            harmonic_force::harmonic_force(contact, &mut workspace, displacement, output)?;
        }
        Ok(())
    };
    status(compute())
}

// ---------------------------------------------------------------------------------------------------------------------
// Spring-sliders

/// The spring-slider with the same K' and K'' at a displacement amplitude \[m\]: stiffness \[N/m\] and slip force \[N\]. At the
/// amplitude 0: the initial stiffness, and mu N.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_CONTACT, MSLIP_BAD_AMPLITUDE, or MSLIP_NOT_AVAILABLE where the contact carries no
/// force.
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
        let slider = equivalent::jenkins(unsafe { self::contact(contact) }?, amplitude)?;
        let (mut stiffness, mut slip_force) = unsafe { (output(stiffness, 1), output(slip_force, 1)) };
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
        let contact = unsafe { self::contact(contact) }?;
        check_length::<f64>(n)?;
        let (mut stiffness, mut slip_force) = unsafe { (output(stiffness, n), output(slip_force, n)) };
        let mut i = 0;
        let error = equivalent::iwan(contact, n, |slider| {
            set(&mut stiffness, i, || slider.stiffness);
            set(&mut slip_force, i, || slider.slip_force);
            i += 1;
        })?;
        set(&mut unsafe { output(force_error, 1) }, 0, || error);
        Ok(())
    };
    status(compute())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The constants are written out for the header; here they are held against the errors.
    #[test]
    fn every_error_has_its_constant() {
        let constants = [
            MSLIP_NULL_POINTER,
            MSLIP_BAD_FLAT_HALF_WIDTH,
            MSLIP_BAD_EDGE_RADIUS,
            MSLIP_BAD_LENGTH,
            MSLIP_BAD_NORMAL_FORCE,
            MSLIP_BAD_FRICTION_COEFFICIENT,
            MSLIP_BAD_YOUNG_MODULUS,
            MSLIP_BAD_POISSON_RATIO,
            MSLIP_BAD_DISPLACEMENT_REFERENCE,
            MSLIP_BAD_SEMI_AXIS_X,
            MSLIP_BAD_SEMI_AXIS_Y,
            MSLIP_LENGTH_TOO_SHORT,
            MSLIP_OUT_OF_RANGE,
            MSLIP_BAD_CONTACT,
            MSLIP_BAD_STATE,
            MSLIP_BAD_WORKSPACE,
            MSLIP_STATE_TOO_SHORT,
            MSLIP_STATE_FULL,
            MSLIP_WORKSPACE_TOO_SHORT,
            MSLIP_BAD_FORCE,
            MSLIP_FORCE_EXCEEDS_SLIP,
            MSLIP_BAD_DISPLACEMENT,
            MSLIP_BAD_POSITION,
            MSLIP_BAD_AMPLITUDE,
            MSLIP_BAD_FORCE_AMPLITUDE,
            MSLIP_BAD_HARMONICS,
            MSLIP_BAD_SAMPLES,
            MSLIP_BAD_COUNT,
            MSLIP_NOT_AVAILABLE,
            MSLIP_BAD_ARRAY_SIZE,
        ];
        assert!(constants.iter().copied().eq(Error::ALL.iter().map(|error| error.code())));
        assert!(constants.windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!(
            [MSLIP_CENTRE_POINT, MSLIP_RIGID_STRIP],
            [crate::parameters::CENTRE_POINT, crate::parameters::RIGID_STRIP]
        );
    }
}
