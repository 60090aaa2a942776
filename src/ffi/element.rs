//! Friction contact elements: initialisation, the normal law, load histories and tractions under a normal force that varies.

use super::batch::{path, state_error};
use super::mslip_element;
use super::pointers::{
    self, call, each, input, item, memory, optional_output, outputs, set, state_input, sum, with_law, write,
};
use crate::element::{Components, Directions, Element, NormalInput};
use crate::error::{Error, ensure};
use crate::law::Law;
use crate::one_direction::tractions::tractions;
use crate::one_direction::{self, OneDirection};
use crate::parameters::{EllipticParameters, Parameters};
use crate::two_directions::TwoDirections;
use libc::size_t;

/// The number of tangential directions of a constant of the C interface.
pub(super) fn directions_of(constant: i32) -> Result<Directions, Error> {
    let all = [Directions::One, Directions::Two];
    all.into_iter().find(|directions| *directions as i32 == constant).ok_or(Error::BadDirections)
}

/// Initialises an element in place.
unsafe fn initialise<P>(
    parameters: *const P,
    directions: i32,
    normal_input: i32,
    element: *mut mslip_element,
    init: fn(&mut Element, &P, Components) -> Result<(), Error>,
) -> i32 {
    call(|| {
        // The element may be uninitialised, and is written before it is read.
        let (parameters, element) =
            (item(parameters)?, optional_output(element.cast::<Element>())?.ok_or(Error::NullPointer)?);
        let directions = directions_of(directions)?;
        let input = [NormalInput::Approach, NormalInput::Force].into_iter().find(|input| *input as i32 == normal_input);
        init(element, parameters, (directions, input.ok_or(Error::BadNormalInput)?))?;
        element.checksum = sum(element).wrapping_neg();
        Ok(())
    })
}

/// Initialises the element of a flat with rounded edges, or of a cylinder. normal_force of the parameters, > 0, is the largest
/// force for which the element is tabulated. Larger ones are exact, but a step takes several times as long, with its energy tens of
/// times, and with two directions it is less accurate. directions is the number of tangential directions, 1 or 2: a displacement is
/// \[u, w\] or \[u, v, w\], a force \[T, N\] or \[Tx, Ty, N\]. normal_input is MSLIP_INPUT_APPROACH, w is the normal approach
/// \[m\], or MSLIP_INPUT_NORMAL_FORCE, w is the normal force \[N\].
///
/// In a step the contact is open if w is at most 2^-150 of its value under normal_force, with two directions 2^-80. With two
/// directions forces beyond 2^150 and approaches beyond 2^100 times that value are rejected as those of a contact too wide for its
/// length.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_DIRECTIONS, MSLIP_BAD_NORMAL_INPUT, the code of the first invalid parameter,
/// MSLIP_LENGTH_TOO_SHORT, or MSLIP_OUT_OF_RANGE; the element is unchanged then.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_element_init(
    p: *const Parameters,
    directions: i32,
    normal_input: i32,
    element: *mut mslip_element,
) -> i32 {
    initialise(p, directions, normal_input, element, Element::init)
}

/// Initialises the element of an elliptical Hertz contact; a sphere if both semi-axes are equal. normal_force of the parameters, >
/// 0, is the force of the semi-axes and the largest one for which the element is tabulated, as in mslip_element_init. directions
/// and normal_input are those of mslip_element_init.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_DIRECTIONS, MSLIP_BAD_NORMAL_INPUT, the code of the first invalid parameter,
/// or MSLIP_OUT_OF_RANGE; the element is unchanged then.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_element_init_elliptic(
    p: *const EllipticParameters,
    directions: i32,
    normal_input: i32,
    element: *mut mslip_element,
) -> i32 {
    initialise(p, directions, normal_input, element, Element::init)
}

/// Validates an element that was read from a file or a message: its checksum must be that written at initialisation, which detects
/// any single changed bit. Text needs 17 digits; initialise it again instead. Other functions only check a tag.
///
/// Returns MSLIP_NULL_POINTER or MSLIP_BAD_ELEMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_element_check(element: *const mslip_element) -> i32 {
    call(|| ensure(sum(pointers::element(element)?) == 0, Error::BadElement))
}

/// The normal law: normal force \[N\], normal stiffness \[N/m\] and half-width of the contact \[m\] at approach\[n\] \[m\]. An
/// approach <= 0 gives 0, 0, 0.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_ELEMENT, MSLIP_BAD_DISPLACEMENT, or MSLIP_LENGTH_TOO_SHORT for an approach at which the
/// contact would be too wide for its length.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_normal_force(
    element: *const mslip_element,
    n: size_t,
    approach: *const f64,
    normal_force: *mut f64,
    stiffness: *mut f64,
    half_width: *mut f64,
) -> i32 {
    normal_law::<false>(element, n, approach, [normal_force, stiffness, half_width])
}

/// The inverse normal law: approach \[m\], compliance \[m/N\] and half-width \[m\] under normal_force\[n\] \[N\]. At 0 the
/// compliance of a cylinder and of an ellipse is infinite.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_ELEMENT, MSLIP_BAD_NORMAL_FORCE, or MSLIP_LENGTH_TOO_SHORT for a force under which the
/// contact would be too wide for its length.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_normal_approach(
    element: *const mslip_element,
    n: size_t,
    normal_force: *const f64,
    approach: *mut f64,
    compliance: *mut f64,
    half_width: *mut f64,
) -> i32 {
    normal_law::<true>(element, n, normal_force, [approach, compliance, half_width])
}

/// The monotonic curve of an element at a constant normal force: the displacement \[m\] that carries force\[n\] \[N\], at most mu N
/// in magnitude, under normal_force\[n\] \[N\], and the compliance \[m/N\] there, in the direction 0 (x) or, of an element with two
/// directions, 1 (y). At mu N the compliance of a cylinder and of an ellipse is infinite; so it is without friction and without a
/// normal force.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_ELEMENT, MSLIP_BAD_DIRECTIONS for another direction, MSLIP_BAD_NORMAL_FORCE,
/// MSLIP_LENGTH_TOO_SHORT for a normal force under which the contact would be too wide for its length, MSLIP_BAD_FORCE or
/// MSLIP_FORCE_EXCEEDS_SLIP.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_element_displacement(
    element: *const mslip_element,
    direction: i32,
    n: size_t,
    force: *const f64,
    normal_force: *const f64,
    displacement: *mut f64,
    compliance: *mut f64,
) -> i32 {
    call(|| {
        let (element, force, normal_force) = (pointers::element(element)?, input(force, n)?, input(normal_force, n)?);
        let outputs = outputs([displacement, compliance], n)?;
        let direction = usize::try_from(direction).map_err(|_| Error::BadDirections)?;
        element.check_direction(direction)?;
        let pairs = force.iter().zip(normal_force);
        pairs.clone().try_for_each(|(&force, &normal_force)| element.check_static(force, normal_force))?;
        for ((&force, &normal_force), outputs) in each(pairs, outputs) {
            let point = element.displacement_under(direction, force, normal_force);
            write(outputs, [point.value, point.slope]);
        }
        Ok(())
    })
}

/// The normal law, or its inverse.
unsafe fn normal_law<const INVERSE: bool>(
    element: *const mslip_element,
    n: usize,
    given: *const f64,
    results: [*mut f64; 3],
) -> i32 {
    call(|| {
        let (element, given, results) = (pointers::element(element)?, input(given, n)?, outputs(results, n)?);
        let check = if INVERSE { Element::check_normal_force } else { Element::check_approach };
        given.iter().try_for_each(|given| check(element, *given))?;
        for (&given, [value, slope, half_width]) in each(given, results) {
            let point = if INVERSE { element.approach_under(given) } else { element.normal_force_at(given) };
            write([value, slope], [point.value, point.slope]);
            set(half_width, || element.half_width_under(if INVERSE { given } else { point.value }));
        }
        Ok(())
    })
}

/// Number of doubles in the state of an element; 0 if directions is neither 1 nor 2. For one tangential direction it has a capacity
/// of `pieces` pieces of the memory diagram, at least 4, and is never full: if the capacity is exceeded, the two adjacent pieces
/// are merged for which later forces change least. For two directions the length is fixed, and `pieces` is ignored.
#[unsafe(no_mangle)]
pub extern "C" fn mslip_element_state_length(directions: i32, pieces: size_t) -> size_t {
    match directions_of(directions) {
        Ok(Directions::One) => one_direction::state_length(pieces),
        Ok(Directions::Two) => TwoDirections::STATE_LENGTH,
        Err(_) => 0,
    }
}

/// Initialises the state of an element with 1 or 2 tangential directions: open, at zero displacement.
///
/// Returns MSLIP_BAD_DIRECTIONS, MSLIP_NULL_POINTER or MSLIP_STATE_TOO_SHORT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_element_state_init(directions: i32, state_length: size_t, state: *mut f64) -> i32 {
    call(|| with_law!(directions_of(directions)?, L => L::state_init(memory(state_length, state)?)))
}

/// Validates the state of an element that was read from a file or a message: all values must be finite and possible, for one
/// direction the pieces nested. Other functions only check a tag and the number of pieces.
///
/// A state that was decimal text of 17 significant digits has every bit. With 15 or 16 digits later forces of one direction are
/// right to 1e-12 mu N (if pieces were merged, within mslip_element_state_error); two directions need 17 digits unless the contact
/// is open. A state of fewer digits is rejected. Not detected: values that another history leads to, such as a force or a
/// displacement of which one bit has changed. A file needs a checksum of its own against that.
///
/// Returns MSLIP_BAD_DIRECTIONS, also for the state of another number of directions, MSLIP_NULL_POINTER, MSLIP_STATE_TOO_SHORT or
/// MSLIP_BAD_STATE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_element_state_check(directions: i32, state_length: size_t, state: *const f64) -> i32 {
    call(|| with_law!(directions_of(directions)?, L => L::state_check(state_input(state_length, state)?)))
}

/// Bound on the error \[N\] of the tangential force due to merged pieces: 0 if none was merged since the last gross slip or
/// separation. For two directions it is 0: the error of their law is not included.
///
/// Returns MSLIP_BAD_DIRECTIONS, also for the state of another number of directions, MSLIP_NULL_POINTER, MSLIP_STATE_TOO_SHORT or
/// MSLIP_BAD_STATE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_element_state_error(
    directions: i32,
    state_length: size_t,
    state: *const f64,
    force_error: *mut f64,
) -> i32 {
    call(|| with_law!(directions_of(directions)?, L => state_error::<L>(state_length, state, force_error)))
}

/// Advances the state of an element to a displacement: \[u, w\] with one tangential direction, \[u, v, w\] with two, tangential
/// displacements \[m\] and the normal approach \[m\] or the normal force \[N\]. With m = 2 or 3 components, force\[m\] \[N\] is
/// \[T, N\] or \[Tx, Ty, N\], tangent\[m m\] \[N/m\] is d force_i / d displacement_j, m x m, column-major, consistent with the step
/// and one-sided at corners, dissipated \[J\] the energy dissipated in this step. state_new may alias state_old; if NULL, the new
/// state is discarded. Only the used part of the new state is written: initialise both states to store or compare whole arrays.
/// Within a step the path is straight in the tangential displacement and the tangential shift S of the contact size. A step of no
/// length changes neither force nor state; its tangent is with one direction the tangent of the step before, with two that of the
/// stuck contact.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_ELEMENT, MSLIP_STATE_TOO_SHORT, MSLIP_BAD_DIRECTIONS for the state of another number of
/// directions, MSLIP_BAD_STATE, MSLIP_BAD_DISPLACEMENT, MSLIP_BAD_NORMAL_FORCE, or MSLIP_LENGTH_TOO_SHORT if the contact would be
/// too wide for its length.
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
    call(|| {
        let element = pointers::element(element)?;
        let (states, outputs) = ((state_length, state_old, state_new), [force, tangent, dissipated]);
        with_law!(element.tangential_directions(), L => path::<L>(element, states, 1, displacement, outputs))
    })
}

/// Advances the state of an element through n displacements. With m = 2 components for one tangential direction, \[u, w\], and m =
/// 3 for two, \[u, v, w\], displacement and force hold m doubles per step, tangent m x m, dissipated one; units are those of
/// mslip_element_update. state_new receives the last state and may alias state_old. If NULL, the new state is discarded; for one
/// direction the path is then evaluated with a capacity of at most 256 pieces.
///
/// Returns the codes of mslip_element_update.
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
    call(|| {
        let element = pointers::element(element)?;
        let (states, outputs) = ((state_length, state_old, state_new), [force, tangent, dissipated]);
        with_law!(element.tangential_directions(), L => path::<L>(element, states, n, displacement, outputs))
    })
}

/// Pressure and shear traction \[Pa\] at x\[n\] \[m\] along the width after a load history; 0 outside the contact. Elliptical: on
/// the x axis. For one tangential direction.
///
/// Returns MSLIP_NULL_POINTER, MSLIP_BAD_ELEMENT, MSLIP_NOT_AVAILABLE for two directions, MSLIP_STATE_TOO_SHORT,
/// MSLIP_BAD_DIRECTIONS for the state of two directions, MSLIP_BAD_STATE or MSLIP_BAD_POSITION.
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
    call(|| {
        let element = pointers::element(element)?;
        ensure(element.tangential_directions() != Directions::Two, Error::NotAvailable)?;
        let (state, x, [pressure, shear]) =
            (state_input(state_length, state)?, input(x, n)?, outputs([pressure, shear], n)?);
        OneDirection::check_header(state)?;
        tractions(element, state, x, pressure, shear)
    })
}
