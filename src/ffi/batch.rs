//! Batches of contacts: all items are checked before the first output is written.

use super::cycle::write_complex_stiffness;
use super::hbm::{element_harmonic_force_dispatched, harmonic_force_dispatched};
use super::history;
use super::pointers::{self, check_alignment, check_length, input, optional_input, output, outputs, status};
use super::{element, mslip_contact, mslip_element};
use crate::constant_load::complex_stiffness::check_amplitude;
use crate::constant_load::contact::{Contact, check_displacement};
use crate::constant_load::state;
use crate::error::Error;
use crate::hbm::{self, HarmonicOutput};
use crate::varying_load::element::Element;
use crate::varying_load::state as element_state;
use libc::size_t;

/// A contact or an element.
trait Law {
    fn check(&self) -> Result<(), Error>;
}

impl Law for Contact {
    #[inline(always)]
    fn check(&self) -> Result<(), Error> {
        if self.is_initialised() { Ok(()) } else { Err(Error::BadContact) }
    }
}

impl Law for Element {
    #[inline(always)]
    fn check(&self) -> Result<(), Error> {
        if self.is_initialised() { Ok(()) } else { Err(Error::BadElement) }
    }
}

/// Items of a batch: their contacts or elements, and the flags of the active items.
struct Items<'a, L> {
    n: usize,
    laws: &'a [L],
    index: Option<&'a [i32]>,
    active: Option<&'a [i32]>,
}

impl<L> Clone for Items<'_, L> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L> Copy for Items<'_, L> {}

impl<'a, L: Law> Items<'a, L> {
    /// Checks the contacts or elements of all active items.
    ///
    /// # Safety
    /// `laws` is NULL or valid for n_laws of them, which any bytes are; `index` and `active` are NULL or valid for n integers.
    #[inline(never)]
    unsafe fn new(
        n: usize,
        n_laws: usize,
        laws: *const L,
        index: *const i32,
        active: *const i32,
    ) -> Result<Items<'a, L>, Error> {
        // SAFETY: by the function's contract.
        let (laws, index, active) =
            unsafe { (input(laws, n_laws)?, optional_input(index, n)?, optional_input(active, n)?) };
        check_length::<f64>(n)?;
        let items = Items { n, laws, index, active };
        items.active().try_for_each(|i| items.law(i).ok_or(Error::BadIndex)?.check())?;
        Ok(items)
    }

    /// Indices of the active items.
    #[inline(always)]
    fn active(self) -> impl Iterator<Item = usize> {
        (0..self.n).filter(move |i| self.active.is_none_or(|active| active.get(*i).is_none_or(|flag| *flag != 0)))
    }

    #[inline(always)]
    fn law(&self, i: usize) -> Option<&'a L> {
        match self.index {
            None => self.laws.get(i),
            Some(index) => self.laws.get(usize::try_from(*index.get(i)?).ok()?),
        }
    }

    /// Active items: index, contact or element, and the part of an input of `length` values per item.
    #[inline(always)]
    fn with<'d>(self, values: &'d [f64], length: usize) -> impl Iterator<Item = (usize, &'a L, &'d [f64])> {
        self.active().filter_map(move |i| Some((i, self.law(i)?, values.get(i * length..(i + 1) * length)?)))
    }
}

/// mslip_complex_stiffness for n items, one amplitude each. Item i uses contacts\[index\[i\]\], or contacts\[i\] if index is NULL. If
/// active is not NULL and active\[i\] is 0, item i is skipped.
///
/// Returns MSLIP_BAD_INDEX or the codes of mslip_complex_stiffness; all outputs are unchanged then.
///
/// # Safety
/// `contacts` is NULL or valid for n_contacts contacts, the others NULL or valid for n items; outputs must not alias any other
/// argument.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_batch_complex_stiffness(
    n: size_t,
    n_contacts: size_t,
    contacts: *const mslip_contact,
    index: *const i32,
    active: *const i32,
    amplitude: *const f64,
    k_real: *mut f64,
    k_imag: *mut f64,
    dk_real: *mut f64,
    dk_imag: *mut f64,
) -> i32 {
    let compute = || {
        // SAFETY: by the function's contract.
        let (items, amplitude, mut outputs) = unsafe {
            let outputs = outputs([k_real, k_imag, dk_real, dk_imag], n);
            (Items::new(n, n_contacts, contacts.cast::<Contact>(), index, active)?, input(amplitude, n)?, outputs?)
        };
        items.with(amplitude, 1).flat_map(|(_, _, amplitude)| amplitude).try_for_each(|a| check_amplitude(*a))?;
        for (i, contact, amplitude) in items.with(amplitude, 1) {
            amplitude.iter().try_for_each(|a| write_complex_stiffness(contact, *a, i, &mut outputs))?;
        }
        Ok(())
    };
    status(compute())
}

/// mslip_masing_update for n items: states hold state_length doubles per item, contiguously; displacement, force, stiffness and
/// dissipated one. states_new may alias states_old. Item i uses contacts\[index\[i\]\], or contacts\[i\] if index is NULL. If active is
/// not NULL and active\[i\] is 0, item i is skipped, and its state is not written.
///
/// Returns MSLIP_BAD_INDEX or the codes of mslip_masing_update; all outputs are unchanged then.
///
/// # Safety
/// `contacts` is NULL or valid for n_contacts contacts, the others NULL or valid for the lengths above; states_new is states_old or,
/// like the outputs, does not alias any other argument.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_batch_masing_update(
    n: size_t,
    n_contacts: size_t,
    contacts: *const mslip_contact,
    index: *const i32,
    active: *const i32,
    state_length: size_t,
    states_old: *const f64,
    displacement: *const f64,
    states_new: *mut f64,
    force: *mut f64,
    stiffness: *mut f64,
    dissipated: *mut f64,
) -> i32 {
    let update = || {
        // SAFETY: by the function's contract.
        let (items, displacement) =
            unsafe { (Items::new(n, n_contacts, contacts.cast::<Contact>(), index, active)?, input(displacement, n)?) };
        [states_new, force, stiffness, dissipated].iter().try_for_each(|output| check_alignment(*output))?;
        let length = n.checked_mul(state_length).ok_or(Error::BadArraySize)?;
        if n > 0 && state_length < state::state_length(0) {
            return Err(Error::StateTooShort);
        }
        {
            // SAFETY: by the function's contract.
            let states = unsafe { input(states_old, length) }?;
            for i in items.active() {
                let tag = states.get(i * state_length).ok_or(Error::BadArraySize)?;
                state::check_tag(*tag, state_length)?;
                check_displacement(displacement.get(i).copied().unwrap_or(0.0))?;
            }
        }
        let at =
            |pointer: *mut f64, offset: usize| if pointer.is_null() { pointer } else { pointer.wrapping_add(offset) };
        for (i, contact, target) in items.with(displacement, 1) {
            let (state_old, state_new) = (states_old.wrapping_add(i * state_length), at(states_new, i * state_length));
            let [force, stiffness, dissipated] = [at(force, i), at(stiffness, i), at(dissipated, i)];
            for &target in target {
                // SAFETY: checked, aligned; those of item i are valid by the function's contract.
                unsafe {
                    history::update(contact, state_length, state_old, target, state_new, force, stiffness, dissipated)
                };
            }
        }
        Ok(())
    };
    status(update())
}

/// mslip_harmonic_force for n items with one workspace: displacement and force hold 2H+1 doubles per item, jacobian (2H+1)^2,
/// dissipated one. Item i uses contacts\[index\[i\]\], or contacts\[i\] if index is NULL. If active is not NULL and active\[i\] is 0, item i
/// is skipped.
///
/// Returns MSLIP_BAD_INDEX or the codes of mslip_harmonic_force; all outputs are unchanged then.
///
/// # Safety
/// `workspace` is NULL or was initialised; `contacts` is NULL or valid for n_contacts contacts, the others NULL or valid for the
/// lengths above; outputs must not alias any other argument.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_batch_harmonic_force(
    n: size_t,
    n_contacts: size_t,
    contacts: *const mslip_contact,
    index: *const i32,
    active: *const i32,
    workspace: *mut f64,
    displacement: *const f64,
    force: *mut f64,
    jacobian: *mut f64,
    dissipated: *mut f64,
) -> i32 {
    let compute = || {
        // SAFETY: by the function's contract.
        let (items, mut workspace) = unsafe {
            (Items::new(n, n_contacts, contacts.cast::<Contact>(), index, active)?, pointers::workspace(workspace)?)
        };
        let one = workspace.coefficients();
        let (all, square) = (n.checked_mul(one), n.checked_mul(one * one));
        let (all, square) = (all.ok_or(Error::BadArraySize)?, square.ok_or(Error::BadArraySize)?);
        // SAFETY: by the function's contract.
        let (displacement, mut outputs) = unsafe {
            let outputs = Outputs {
                force: output(force, all)?,
                jacobian: output(jacobian, square)?,
                dissipated: output(dissipated, n)?,
            };
            (input(displacement, all)?, outputs)
        };
        items.with(displacement, one).try_for_each(|(_, _, displacement)| hbm::check_coefficients(displacement))?;
        for (i, contact, displacement) in items.with(displacement, one) {
            harmonic_force_dispatched(contact, &mut workspace, displacement, outputs.of_item(i, one))?;
        }
        Ok(())
    };
    status(compute())
}

/// mslip_element_update for n items: states hold state_length doubles per item, contiguously; displacement and force two, tangent four,
/// dissipated one. states_new may alias states_old. Item i uses elements\[index\[i\]\], or elements\[i\] if index is NULL. If active is
/// not NULL and active\[i\] is 0, item i is skipped, and its state is not written.
///
/// Returns MSLIP_BAD_INDEX or the codes of mslip_element_update; all outputs are unchanged then.
///
/// # Safety
/// `elements` is NULL or valid for n_elements elements, the others NULL or valid for the lengths above; states_new is states_old or,
/// like the outputs, does not alias any other argument.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_batch_element_update(
    n: size_t,
    n_elements: size_t,
    elements: *const mslip_element,
    index: *const i32,
    active: *const i32,
    state_length: size_t,
    states_old: *const f64,
    displacement: *const f64,
    states_new: *mut f64,
    force: *mut f64,
    tangent: *mut f64,
    dissipated: *mut f64,
) -> i32 {
    let update = || {
        let length = n.checked_mul(state_length).ok_or(Error::BadArraySize)?;
        let components = n.checked_mul(2).ok_or(Error::BadArraySize)?;
        check_length::<[f64; 4]>(n)?;
        // SAFETY: by the function's contract; an element consists of doubles and integers.
        let (items, displacement) = unsafe {
            let items = Items::new(n, n_elements, elements.cast::<Element>(), index, active)?;
            (items, input(displacement, components)?)
        };
        [states_new, force, tangent, dissipated].iter().try_for_each(|output| check_alignment(*output))?;
        if n > 0 && state_length < element_state::state_length(0) {
            return Err(Error::StateTooShort);
        }
        {
            // SAFETY: by the function's contract.
            let states = unsafe { input(states_old, length) }?;
            for (i, element, displacement) in items.with(displacement, 2) {
                let tag = states.get(i * state_length).ok_or(Error::BadArraySize)?;
                element_state::check_tag(*tag, state_length)?;
                element_state::check_step(element, displacement.first_chunk().ok_or(Error::BadArraySize)?)?;
            }
        }
        let at =
            |pointer: *mut f64, offset: usize| if pointer.is_null() { pointer } else { pointer.wrapping_add(offset) };
        for (i, element, displacement) in items.with(displacement, 2) {
            let (state_old, state_new) = (states_old.wrapping_add(i * state_length), at(states_new, i * state_length));
            prefetch(state_old.wrapping_add(AHEAD * state_length));
            let outputs = [at(force, 2 * i), at(tangent, 4 * i), at(dissipated, i)];
            if let Some(displacement) = displacement.first_chunk() {
                // SAFETY: checked, aligned; those of item i are valid by the function's contract.
                unsafe { element::update(element, state_length, state_old, displacement, state_new, outputs) };
            }
        }
        Ok(())
    };
    status(update())
}

/// mslip_element_harmonic_force for n items with one workspace: displacement and force hold 2(2H+1) doubles per item, jacobian
/// (2(2H+1))^2, dissipated one. Item i uses elements\[index\[i\]\], or elements\[i\] if index is NULL. If active is not NULL and
/// active\[i\] is 0, item i is skipped.
///
/// Returns MSLIP_BAD_INDEX or the codes of mslip_element_harmonic_force; all outputs are unchanged then.
///
/// # Safety
/// `workspace` is NULL or was initialised; `elements` is NULL or valid for n_elements elements, the others NULL or valid for the
/// lengths above; outputs must not alias any other argument.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mslip_batch_element_harmonic_force(
    n: size_t,
    n_elements: size_t,
    elements: *const mslip_element,
    index: *const i32,
    active: *const i32,
    workspace: *mut f64,
    displacement: *const f64,
    force: *mut f64,
    jacobian: *mut f64,
    dissipated: *mut f64,
) -> i32 {
    let compute = || {
        // SAFETY: by the function's contract; an element consists of doubles and integers.
        let (items, mut workspace) = unsafe {
            let items = Items::new(n, n_elements, elements.cast::<Element>(), index, active)?;
            (items, pointers::element_workspace(workspace)?)
        };
        let one = 2 * workspace.coefficients();
        let (all, square) = (n.checked_mul(one), n.checked_mul(one * one));
        let (all, square) = (all.ok_or(Error::BadArraySize)?, square.ok_or(Error::BadArraySize)?);
        // SAFETY: by the function's contract.
        let (displacement, mut outputs) = unsafe {
            let outputs = Outputs {
                force: output(force, all)?,
                jacobian: output(jacobian, square)?,
                dissipated: output(dissipated, n)?,
            };
            (input(displacement, all)?, outputs)
        };
        for (_, element, displacement) in items.with(displacement, one) {
            workspace.check(element, displacement)?;
        }
        for (i, element, displacement) in items.with(displacement, one) {
            element_harmonic_force_dispatched(element, &mut workspace, displacement, outputs.of_item(i, one))?;
        }
        Ok(())
    };
    status(compute())
}

/// Items between the one that is computed and the one whose state is fetched from main memory.
const AHEAD: usize = 8;

/// Fetches the header and the first knots of a state into the cache: the hardware does not, because states are read in part only.
#[inline(always)]
fn prefetch(state: *const f64) {
    #[cfg(target_arch = "x86_64")]
    for line in 0..3 {
        use core::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // SAFETY: every x86-64 processor has the instruction, and any address is allowed.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(state.wrapping_add(8 * line).cast()) };
    }
}

/// Outputs of a batch of harmonic forces.
struct Outputs<'a> {
    force: Option<&'a mut [f64]>,
    jacobian: Option<&'a mut [f64]>,
    dissipated: Option<&'a mut [f64]>,
}

impl Outputs<'_> {
    /// Outputs of item i. Not inlined, to keep the loop over the items small.
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

/// Part of item i of an output of `length` values per item.
fn part<'a>(output: &'a mut Option<&mut [f64]>, i: usize, length: usize) -> Option<&'a mut [f64]> {
    output.as_mut()?.get_mut(i * length..(i + 1) * length)
}
