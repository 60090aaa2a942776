//! The functions of many contacts at once: every item is checked before the first one writes.

use super::cycle::{widest_harmonic_force, write_complex_stiffness};
use super::mslip_contact;
use super::pointer::{self, check_alignment, input, output, outputs, status};
use super::single::update_one;
use crate::contact::Contact;
use crate::error::Error;
use crate::harmonic::check_amplitude;
use crate::harmonic_force::{self, HarmonicOutput};
use crate::masing;
use libc::size_t;

/// The items of an interface that take part: their numbers, each with its contact, all checked before the first is used.
///
/// # Safety
/// `contacts` and `active` are NULL or point to n items.
unsafe fn active_contacts<'a>(
    n: usize,
    contacts: *const mslip_contact,
    active: *const i32,
) -> Result<impl Iterator<Item = (usize, &'a Contact)> + Clone, Error> {
    // SAFETY: the caller's word.
    let contacts = unsafe { input(contacts.cast::<Contact>(), n) }?;
    // SAFETY: the caller's word.
    let active: Option<&'a [i32]> = if active.is_null() { None } else { Some(unsafe { input(active, n) }?) };
    let takes_part = move |i: usize| active.is_none_or(|active| active.get(i).is_none_or(|&flag| flag != 0));
    let items = contacts.iter().enumerate().filter(move |(i, _)| takes_part(*i));
    for (_, contact) in items.clone() {
        pointer::check_contact(contact)?;
    }
    Ok(items)
}

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
        // SAFETY: what the caller was asked for above.
        let (items, amplitude, mut outputs) = unsafe {
            let outputs = outputs([k_real, k_imag, dk_real, dk_imag], n);
            (active_contacts(n, contacts, active)?, input(amplitude, n)?, outputs?)
        };
        let items = items.filter_map(|(i, contact)| Some((i, contact, *amplitude.get(i)?)));
        items.clone().try_for_each(|(_, _, amplitude)| check_amplitude(amplitude))?;
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
        // SAFETY: what the caller was asked for above.
        let items = unsafe { active_contacts(n, contacts, active) }?;
        // SAFETY: as above.
        let displacement = unsafe { input(displacement, n) }?;
        let items = items.filter_map(|(i, contact)| Some((i, contact, *displacement.get(i)?)));
        [states1, force, stiffness, dissipated].iter().try_for_each(|output| check_alignment(*output))?;
        let length = n.checked_mul(state_length).ok_or(Error::BadArraySize)?;
        {
            // SAFETY: as above.
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
            // SAFETY: each item's, as above.
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
        // SAFETY: what the caller was asked for above.
        let (items, mut workspace) = unsafe { (active_contacts(n, contacts, active)?, pointer::workspace(workspace)?) };
        let one = workspace.coefficients();
        let (all, square) = (n.checked_mul(one), n.checked_mul(one * one));
        let (all, square) = (all.ok_or(Error::BadArraySize)?, square.ok_or(Error::BadArraySize)?);
        // SAFETY: as above.
        let (displacement, mut outputs) = unsafe {
            let outputs = Outputs {
                force: output(force, all)?,
                jacobian: output(jacobian, square)?,
                dissipated: output(dissipated, n)?,
            };
            (input(displacement, all)?, outputs)
        };
        let items = items.filter_map(|(i, contact)| Some((i, contact, displacement.get(i * one..(i + 1) * one)?)));
        items.clone().try_for_each(|(_, _, displacement)| harmonic_force::check_coefficients(displacement))?;
        for (i, contact, displacement) in items {
            widest_harmonic_force(contact, &mut workspace, displacement, outputs.of_item(i, one))?;
        }
        Ok(())
    };
    status(compute())
}

/// Outputs of many harmonic forces, item after item.
struct Outputs<'a> {
    force: Option<&'a mut [f64]>,
    jacobian: Option<&'a mut [f64]>,
    dissipated: Option<&'a mut [f64]>,
}

impl Outputs<'_> {
    /// Those of item i with so many coefficients. Apart from the loop over the items, which is short where they rest.
    #[inline(never)]
    fn of_item(&mut self, i: usize, coefficients: usize) -> HarmonicOutput<'_> {
        let Outputs { force, jacobian, dissipated } = self;
        HarmonicOutput {
            force: part(force, i, coefficients),
            jacobian: part(jacobian, i, coefficients * coefficients),
            dissipated: part(dissipated, i, 1).and_then(<[f64]>::first_mut),
        }
    }
}

/// What an output of so many numbers an item holds of item i.
fn part<'a>(output: &'a mut Option<&mut [f64]>, i: usize, numbers: usize) -> Option<&'a mut [f64]> {
    output.as_mut()?.get_mut(i * numbers..(i + 1) * numbers)
}
