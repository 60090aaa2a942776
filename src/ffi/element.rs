//! Friction contact elements: initialisation, the normal law, load histories and tractions under a normal force that varies.

use super::pointers::{
    self, check_alignment, input, item, memory, output, outputs, requested, set, state_input, status,
};
use super::{MSLIP_APPROACH, MSLIP_NORMAL_FORCE, mslip_element};
use crate::error::Error;
use crate::parameters::{EllipticParameters, Parameters};
use crate::varying_load::element::{Element, NormalInput, NormalPoint};
use crate::varying_load::state::{self, PathOutput};
use crate::varying_load::tractions::tractions;
use core::{ptr, slice};
use libc::size_t;

/// Components of a displacement and of a force in one tangential direction.
const COMPONENTS: usize = 2;

/// Checks a number of tangential directions.
pub(super) fn check_directions(directions: i32) -> Result<(), Error> {
    match directions {
        1 => Ok(()),
        2 => Err(Error::NotAvailable),
        _ => Err(Error::BadDirections),
    }
}

/// Initialises an element in place.
///
/// # Safety
/// Both pointers are NULL or valid for their types.
unsafe fn initialise<P>(
    parameters: *const P,
    directions: i32,
    normal_input: i32,
    element: *mut mslip_element,
    init: fn(&mut Element, &P, NormalInput) -> Result<(), Error>,
) -> i32 {
    let initialise = || {
        // SAFETY: by the function's contract.
        let parameters = unsafe { item(parameters) }?;
        check_alignment(element)?;
        // SAFETY: aligned; valid by the function's contract. It may be uninitialised, and is written before it is read.
        let element = unsafe { element.cast::<Element>().as_mut() }.ok_or(Error::NullPointer)?;
        check_directions(directions)?;
        let normal_input = match normal_input {
            MSLIP_APPROACH => NormalInput::Approach,
            MSLIP_NORMAL_FORCE => NormalInput::Force,
            _ => return Err(Error::BadNormalInput),
        };
        init(element, parameters, normal_input)?;
        pointers::set_checksum(element);
        Ok(())
    };
    status(initialise())
}

/// Initialises the element of a flat with rounded edges, or of a cylinder. normal_force of the parameters, > 0, is the largest force for
/// which the element is tabulated; larger ones are exact, but slower. directions is the number of tangential directions, 1;
/// normal_input is MSLIP_APPROACH or MSLIP_NORMAL_FORCE.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_DIRECTIONS, MSLIP_NOT_AVAILABLE for two directions, MSLIP_BAD_NORMAL_INPUT, the code of the
/// first invalid parameter, MSLIP_LENGTH_TOO_SHORT or MSLIP_OUT_OF_RANGE; the element is unchanged then.
///
/// # Safety
/// `p` and `element` are NULL or valid for their types.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_element_init(
    p: *const Parameters,
    directions: i32,
    normal_input: i32,
    element: *mut mslip_element,
) -> i32 {
    // SAFETY: by the function's contract.
    unsafe { initialise(p, directions, normal_input, element, Element::init_rounded_flat) }
}

/// Initialises the element of an elliptical Hertz contact; a sphere if both semi-axes are equal. normal_force of the parameters, > 0, is
/// the force of the semi-axes and the largest one for which the element is tabulated; larger ones are exact, but slower. directions is
/// the number of tangential directions, 1; normal_input is MSLIP_APPROACH or MSLIP_NORMAL_FORCE.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_DIRECTIONS, MSLIP_NOT_AVAILABLE for two directions, MSLIP_BAD_NORMAL_INPUT, the code of the
/// first invalid parameter, or MSLIP_OUT_OF_RANGE; the element is unchanged then.
///
/// # Safety
/// `p` and `element` are NULL or valid for their types.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_element_init_elliptic(
    p: *const EllipticParameters,
    directions: i32,
    normal_input: i32,
    element: *mut mslip_element,
) -> i32 {
    // SAFETY: by the function's contract.
    unsafe { initialise(p, directions, normal_input, element, Element::init_elliptic) }
}

/// Validates an element that was read from a file or a message: its checksum must be that written at initialisation. Other functions
/// only check a tag.
///
/// Returns MSLIP_NULL_POINTER or MSLIP_BAD_ELEMENT.
///
/// # Safety
/// `element` is NULL or valid for an element.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_element_check(element: *const mslip_element) -> i32 {
    // SAFETY: by the function's contract.
    status(unsafe { pointers::element(element) }.and_then(pointers::check_element))
}

/// The normal law: normal force \[N\], normal stiffness \[N/m\] and half-width of the contact \[m\] at approach\[n\] \[m\]. An approach <= 0
/// gives 0, 0, 0. In Fortran it is named mslip_normal_force_at, because MSLIP_NORMAL_FORCE is a constant.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_ELEMENT, MSLIP_BAD_DISPLACEMENT, or MSLIP_LENGTH_TOO_SHORT for an approach at which the contact
/// would be too wide for its length.
///
/// # Safety
/// Each pointer is NULL or valid for n doubles; outputs must not alias any other argument.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_normal_force(
    element: *const mslip_element,
    n: size_t,
    approach: *const f64,
    normal_force: *mut f64,
    stiffness: *mut f64,
    half_width: *mut f64,
) -> i32 {
    // SAFETY: by the function's contract.
    unsafe {
        normal_law(
            element,
            n,
            approach,
            [normal_force, stiffness, half_width],
            Element::check_approach,
            Element::four_normal_forces,
            |_, value| value,
        )
    }
}

/// The inverse normal law: approach \[m\], compliance \[m/N\] and half-width \[m\] under normal_force\[n\] \[N\]. At 0 the compliance of a
/// cylinder and of an ellipse is infinite.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_ELEMENT, MSLIP_BAD_NORMAL_FORCE, or MSLIP_LENGTH_TOO_SHORT for a force under which the contact
/// would be too wide for its length.
///
/// # Safety
/// Each pointer is NULL or valid for n doubles; outputs must not alias any other argument.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_normal_approach(
    element: *const mslip_element,
    n: size_t,
    normal_force: *const f64,
    approach: *mut f64,
    compliance: *mut f64,
    half_width: *mut f64,
) -> i32 {
    // SAFETY: by the function's contract.
    unsafe {
        normal_law(
            element,
            n,
            normal_force,
            [approach, compliance, half_width],
            Element::check_normal_force,
            |element, given| given.map(|force| element.approach_under(force)),
            |given, _| given,
        )
    }
}

/// One direction of the normal law, four values at a time; `normal_force` selects the normal force from the given quantity and the one that is computed.
///
/// # Safety
/// Each pointer is NULL or valid for n doubles, the first one for an element; outputs must not alias any other argument.
#[inline(always)]
unsafe fn normal_law(
    element: *const mslip_element,
    n: usize,
    given: *const f64,
    results: [*mut f64; 3],
    check: impl Fn(&Element, f64) -> Result<(), Error>,
    law: impl Fn(&Element, &[f64; 4]) -> [NormalPoint; 4],
    normal_force: impl Fn(f64, f64) -> f64,
) -> i32 {
    let compute = || {
        // SAFETY: by the function's contract.
        let (element, given, [mut values, mut slopes, mut half_widths]) =
            unsafe { (pointers::element(element)?, input(given, n)?, outputs(results, n)?) };
        given.iter().try_for_each(|given| check(element, *given))?;
        for (block, given) in given.chunks(4).enumerate() {
            let mut four = [given.first().copied().unwrap_or(0.0); 4];
            four.iter_mut().zip(given).for_each(|(place, given)| *place = *given);
            for (i, (given, point)) in (4 * block..).zip(given.iter().zip(law(element, &four))) {
                let NormalPoint { value, slope } = point;
                set(&mut values, i, || value);
                set(&mut slopes, i, || slope);
                set(&mut half_widths, i, || element.half_width_under(normal_force(*given, value)));
            }
        }
        Ok(())
    };
    status(compute())
}

/// Number of doubles in the state of an element for one tangential direction with a capacity of `pieces` pieces of the memory diagram,
/// at least 4; 0 if directions is not 1. A state is never full: if the capacity is exceeded, the two adjacent pieces are merged for
/// which later forces change least.
#[unsafe(no_mangle)]
pub extern "C" fn mslip_element_state_length(directions: i32, pieces: size_t) -> size_t {
    check_directions(directions).map_or(0, |()| state::state_length(pieces))
}

/// Initialises the state of an element: open, at zero displacement.
///
/// Returns MSLIP_BAD_DIRECTIONS, MSLIP_NOT_AVAILABLE, MSLIP_NULL_POINTER or MSLIP_STATE_TOO_SHORT.
///
/// # Safety
/// `state` is NULL or valid for state_length doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_element_state_init(directions: i32, state_length: size_t, state: *mut f64) -> i32 {
    let init = || {
        check_directions(directions)?;
        // SAFETY: by the function's contract.
        state::state_init(unsafe { memory(state_length, state) }?)
    };
    status(init())
}

/// Validates the state of an element that was read from a file or a message: all values must be finite and the pieces nested. Other
/// functions only check a tag and the number of pieces.
///
/// Returns MSLIP_BAD_DIRECTIONS, MSLIP_NOT_AVAILABLE, MSLIP_NULL_POINTER, MSLIP_STATE_TOO_SHORT or MSLIP_BAD_STATE.
///
/// # Safety
/// `state` is NULL or valid for state_length doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_element_state_check(directions: i32, state_length: size_t, state: *const f64) -> i32 {
    let check = || {
        check_directions(directions)?;
        // SAFETY: by the function's contract.
        state::state_check(unsafe { state_input(state_length, state) }?)
    };
    status(check())
}

/// Bound on the error \[N\] of the tangential force due to merged pieces: 0 if none was merged since the last gross slip or separation.
///
/// Returns MSLIP_BAD_DIRECTIONS, MSLIP_NOT_AVAILABLE, MSLIP_NULL_POINTER, MSLIP_STATE_TOO_SHORT or MSLIP_BAD_STATE.
///
/// # Safety
/// `state` is NULL or valid for state_length doubles, `force_error` NULL or valid for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_element_state_error(
    directions: i32,
    state_length: size_t,
    state: *const f64,
    force_error: *mut f64,
) -> i32 {
    let compute = || {
        check_directions(directions)?;
        // SAFETY: by the function's contract.
        let (state, mut force_error) = unsafe { (state_input(state_length, state)?, output(force_error, 1)?) };
        state::check_header(state)?;
        set(&mut force_error, 0, || state::force_error(state));
        Ok(())
    };
    status(compute())
}

/// Advances the state of an element to displacement\[2\]: the tangential displacement \[m\], and the normal approach \[m\] or the normal
/// force \[N\]. force\[2\] \[N\] is the tangential and the normal force, tangent\[4\] \[N/m\] is d force_i / d displacement_j, 2 x 2,
/// column-major, consistent with the step and one-sided at corners, dissipated \[J\] the energy dissipated in this step. state_new may
/// alias state_old; if NULL, the new state is discarded. Only what is in use of it is written: initialise both states to store or
/// compare whole arrays. Within a step the path is straight in the tangential displacement and the tangential shift S of the contact
/// size.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_ELEMENT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_STATE, MSLIP_BAD_DISPLACEMENT,
/// MSLIP_BAD_NORMAL_FORCE, or MSLIP_LENGTH_TOO_SHORT if the contact would be too wide for its length.
///
/// # Safety
/// Each pointer is NULL or valid for state_length doubles (states) or the lengths above; state_new is state_old or, like the outputs,
/// does not alias any other argument.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_element_update(
    element: *const mslip_element,
    state_length: size_t,
    state_old: *const f64,
    displacement: *const f64,
    state_new: *mut f64,
    force: *mut f64,
    tangent: *mut f64,
    dissipated: *mut f64,
) -> i32 {
    let checked_update = || {
        // SAFETY: by the function's contract.
        let (element, displacement) = unsafe { (pointers::element(element)?, input(displacement, COMPONENTS)?) };
        [state_new, force, tangent, dissipated].iter().try_for_each(|output| check_alignment(*output))?;
        let displacement = displacement.first_chunk().ok_or(Error::NullPointer)?;
        {
            // SAFETY: by the function's contract; the reference ends before the new state, which may be the same memory, is written.
            state::check_header(unsafe { state_input(state_length, state_old) }?)?;
        }
        state::check_step(element, displacement)?;
        // SAFETY: checked, aligned; valid by the function's contract.
        unsafe { update(element, state_length, state_old, displacement, state_new, [force, tangent, dissipated]) };
        Ok(())
    };
    status(checked_update())
}

/// One update with checked inputs: evaluates the step, then writes.
///
/// # Safety
/// `state_old` is valid for state_length doubles; `state_new` is NULL, equal to it, or valid for as many doubles without overlap; the
/// outputs are NULL, or aligned and valid for two, four and one doubles.
#[inline(never)]
pub(super) unsafe fn update(
    element: &Element,
    state_length: usize,
    state_old: *const f64,
    displacement: &[f64; COMPONENTS],
    state_new: *mut f64,
    [force, tangent, dissipated]: [*mut f64; 3],
) {
    let with_energy = !dissipated.is_null();
    // SAFETY: by the function's contract; no reference to the old state is left when the new one, which may be the same memory, is
    // written.
    unsafe {
        let step = if state_new.is_null() {
            state::trial(element, slice::from_raw_parts(state_old, state_length), *displacement, with_energy)
        } else {
            let state = slice::from_raw_parts_mut(state_new, state_length);
            if !ptr::eq(state_old, state_new) {
                state::copy_used(slice::from_raw_parts(state_old, state_length), state);
            }
            state::advance_checked(element, state, *displacement, with_energy)
        };
        force.cast::<[f64; COMPONENTS]>().as_mut().into_iter().for_each(|force| *force = step.force);
        tangent
            .cast::<[f64; COMPONENTS * COMPONENTS]>()
            .as_mut()
            .into_iter()
            .for_each(|tangent| *tangent = step.tangent);
        dissipated.as_mut().into_iter().for_each(|dissipated| *dissipated = step.dissipated);
    }
}

/// Advances the state of an element through n displacements, two doubles each; force holds two doubles per step, tangent four,
/// dissipated one. state_new receives the last state and may alias state_old. If NULL, the new state is discarded; the path is then
/// evaluated with a capacity of at most 256 pieces.
///
/// Returns the codes of mslip_element_update; all outputs are unchanged then.
///
/// # Safety
/// Each pointer is NULL or valid for state_length doubles (states) or the lengths above; state_new is state_old or, like the outputs,
/// does not alias any other argument.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_element_path(
    element: *const mslip_element,
    state_length: size_t,
    state_old: *const f64,
    n: size_t,
    displacement: *const f64,
    state_new: *mut f64,
    force: *mut f64,
    tangent: *mut f64,
    dissipated: *mut f64,
) -> i32 {
    let advance = || {
        let times = |components: usize| n.checked_mul(components).ok_or(Error::BadArraySize);
        let (pairs, matrices) = (times(COMPONENTS)?, times(COMPONENTS * COMPONENTS)?);
        // SAFETY: by the function's contract.
        let (element, path, output) = unsafe {
            let (element, path) = (pointers::element(element)?, input(displacement, pairs)?);
            let (force, tangent) = (output(force, pairs)?, output(tangent, matrices)?);
            (element, path, PathOutput { force, tangent, dissipated: output(dissipated, n)? })
        };
        check_alignment(state_new)?;
        {
            // SAFETY: by the function's contract; the reference ends before the new state, which may be the same memory, is written.
            let start = unsafe { state_input(state_length, state_old) }?;
            state::check_header(start)?;
            state::check_path(element, path)?;
            if state_new.is_null() {
                return state::path_in_copy(element, start, path, output);
            }
        }
        if !ptr::eq(state_old, state_new) {
            // SAFETY: aligned; valid by the function's contract.
            unsafe { ptr::copy(state_old, state_new, state_length) };
        }
        // SAFETY: as above.
        let state = unsafe { requested(state_new, state_length) }.ok_or(Error::StateTooShort)?;
        state::path(element, state, path, output)
    };
    status(advance())
}

/// Pressure and shear traction \[Pa\] at x\[n\] \[m\] along the width after a load history; 0 outside the contact. Elliptical: on the x
/// axis.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_ELEMENT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_STATE or MSLIP_BAD_POSITION.
///
/// # Safety
/// Each pointer is NULL or valid for state_length doubles (the state) or n; outputs must not alias any other argument.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_element_tractions(
    element: *const mslip_element,
    state_length: size_t,
    state: *const f64,
    n: size_t,
    x: *const f64,
    pressure: *mut f64,
    shear: *mut f64,
) -> i32 {
    let compute = || {
        // SAFETY: by the function's contract.
        let (element, state, x, [pressure, shear]) = unsafe {
            let (element, state) = (pointers::element(element)?, state_input(state_length, state)?);
            (element, state, input(x, n)?, outputs([pressure, shear], n)?)
        };
        tractions(element, state, x, pressure, shear)
    };
    status(compute())
}
