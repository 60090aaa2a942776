//! Batches of contacts and of elements: all items are checked, in order, before the first output is written.

use super::pointers::{
    self, call, check_alignment, check_input, check_length, input, optional_output, output, outputs, requested, set,
    state_input, with_law, write,
};
use super::{mslip_contact, mslip_element};
use crate::constant_load::ConstantLoad;
use crate::constant_load::complex_stiffness::{check_amplitude, requested as stiffness_requested};
use crate::constant_load::harmonic_force::HarmonicOutput;
use crate::element::{Directions, Element};
use crate::error::Error;
use crate::fourier::workspace::Layout;
use crate::law::{Law, Requested};
use crate::numerics::slices::PanicFreeSlice;
use core::{ptr, slice};
use libc::size_t;

/// Length of a state, the old state and the new one.
type States = (usize, *const f64, *mut f64);

/// Force, tangent and dissipated energy.
type Outputs = [*mut f64; 3];

/// Evaluates one step with checked arguments, and writes it as item i of the outputs.
#[inline(always)]
unsafe fn step<L: Law>(
    item: &L::Item,
    (state_length, state_old, state_new): States,
    displacement: &L::Vector,
    [force, tangent, dissipated]: Outputs,
    i: usize,
) {
    let requested = Requested { tangent: !tangent.is_null(), energy: !dissipated.is_null() };
    // No reference to the old state is left when the new one, which may be the same memory, is written.
    let step = if state_new.is_null() {
        L::trial(item, slice::from_raw_parts(state_old, state_length), *displacement, requested)
    } else {
        let state = slice::from_raw_parts_mut(state_new, state_length);
        if !ptr::eq(state_old, state_new) {
            L::copy_used(slice::from_raw_parts(state_old, state_length), state);
        }
        L::advance(item, state, *displacement, requested)
    };
    set(item_of(force.cast::<L::Vector>(), i).as_mut(), || step.force);
    set(item_of(tangent.cast::<L::Tangent>(), i).as_mut(), || step.tangent);
    set(item_of(dissipated, i).as_mut(), || step.dissipated);
}

/// Writes the bound on the error of the force in a state.
pub(super) unsafe fn state_error<L: Law>(n: usize, state: *const f64, error: *mut f64) -> Result<(), Error> {
    let (state, error) = (state_input(n, state)?, optional_output(error)?);
    L::check_header(state)?;
    set(error, || L::force_error(state));
    Ok(())
}

/// Advances the state of a contact or element, which is checked, along a path.
#[inline(always)]
pub(super) unsafe fn path<L: Law>(
    item: &L::Item,
    (state_length, state_old, state_new): States,
    n: usize,
    displacement: *const f64,
    outputs: Outputs,
) -> Result<(), Error> {
    let path = input(displacement.cast::<L::Vector>(), n)?;
    check_length::<L::Tangent>(n)?;
    check_alignment(state_new)?;
    outputs.iter().try_for_each(|output| check_alignment(*output))?;
    L::check_header(state_input(state_length, state_old)?)?;
    path.iter().try_for_each(|displacement| L::check_step(item, displacement))?;
    let states = (state_length, state_old, state_new);
    match path {
        [displacement] => step::<L>(item, states, displacement, outputs, 0),
        [] if state_new.is_null() => {}
        [] => ptr::copy(state_old, state_new, state_length),
        _ if state_new.is_null() => {
            let state = slice::from_raw_parts(state_old, state_length);
            L::in_copy(item, state, |copy| {
                steps::<L>(item, (copy.len(), copy.as_ptr(), copy.as_mut_ptr()), path, outputs);
            });
        }
        _ => steps::<L>(item, states, path, outputs),
    }
    Ok(())
}

/// Steps along a path with checked arguments.
#[inline(never)]
unsafe fn steps<L: Law>(item: &L::Item, states: States, path: &[L::Vector], outputs: Outputs) {
    let (state_length, mut state_old, state_new) = states;
    for (i, displacement) in path.iter().enumerate() {
        step::<L>(item, (state_length, state_old, state_new), displacement, outputs, i);
        state_old = state_new;
    }
}

/// An error of a batch and, if it is the error of an item, its number.
struct Failure {
    error: Error,
    item: Option<usize>,
}

impl From<Error> for Failure {
    fn from(error: Error) -> Failure {
        Failure { error, item: None }
    }
}

/// The status of a batch of n items. On an error, `failed_item` is the item at fault, or n if the error is not the error of an
/// item.
unsafe fn call_batch(n: usize, failed_item: *mut size_t, batch: impl FnOnce() -> Result<(), Failure>) -> i32 {
    call(|| {
        let failed_item = optional_output(failed_item)?;
        batch().map_err(|failure| {
            set(failed_item, || failure.item.unwrap_or(n));
            failure.error
        })
    })
}

/// Items of a batch: their contacts or elements, and the flags of the active items.
#[derive(Clone, Copy)]
struct Items<'a, T> {
    n: usize,
    objects: &'a [T],
    index: Option<&'a [i32]>,
    active: Option<&'a [i32]>,
}

impl<'a, T: Copy> Items<'a, T> {
    #[inline(never)]
    unsafe fn new<P>(
        n: usize,
        n_objects: usize,
        objects: *const P,
        index: *const i32,
        active: *const i32,
    ) -> Result<Items<'a, T>, Error> {
        // Before the length of any other array is computed from n.
        check_length::<f64>(n)?;
        let optional = |flags: *const i32| if flags.is_null() { Ok(None) } else { input(flags, n).map(Some) };
        Ok(Items { n, objects: input(objects.cast(), n_objects)?, index: optional(index)?, active: optional(active)? })
    }

    /// Checks the contacts or elements of all active items, and with each the other arguments of the item.
    fn check<L: Law<Item = T>>(self, mut check: impl FnMut(usize, &T) -> Result<(), Error>) -> Result<(), Failure> {
        let mut check_item = |i, item: Option<&T>| {
            let item = item.ok_or(Error::BadIndex)?;
            L::check(item)?;
            check(i, item)
        };
        self.active().try_for_each(|(i, item)| {
            // The length is the same for all states.
            check_item(i, item).map_err(|error| Failure { error, item: (error != Error::StateTooShort).then_some(i) })
        })
    }

    /// The active items: number, and contact or element unless its index is invalid.
    fn active(self) -> impl Iterator<Item = (usize, Option<&'a T>)> {
        let is_active = move |i: &usize| self.active.is_none_or(|active| active.get(*i).is_none_or(|flag| *flag != 0));
        (0..self.n).filter(is_active).map(move |i| match self.index {
            None => (i, self.objects.get(i)),
            Some(index) => (i, index.get(i).and_then(|item| self.objects.get(usize::try_from(*item).ok()?))),
        })
    }

    /// The active items that were checked: number, and contact or element.
    fn checked(self) -> impl Iterator<Item = (usize, &'a T)> {
        self.active().filter_map(|(i, item)| Some((i, item?)))
    }
}

impl Items<'_, Element> {
    /// Directions of the element of the first active item, which those of all others must equal; one if no item is active.
    fn directions(self) -> Directions {
        let first = self.checked().next().map(|(_, element)| element);
        first.filter(|element| element.is_initialised()).map_or(Directions::One, Element::tangential_directions)
    }
}

/// Advances the states of all active items.
#[inline(never)]
unsafe fn update<L: Law>(
    items: Items<L::Item>,
    (state_length, states_old, states_new): States,
    displacement: *const f64,
    outputs: Outputs,
) -> Result<(), Failure> {
    let length = items.n.checked_mul(state_length).ok_or(Error::BadArraySize)?;
    check_length::<L::Tangent>(items.n)?;
    let displacement = input(displacement.cast::<L::Vector>(), items.n)?;
    check_alignment(states_new)?;
    outputs.iter().try_for_each(|output| check_alignment(*output))?;
    if items.n > 0 && states_old.is_null() {
        return Err(Error::NullPointer.into());
    }
    {
        // The reference ends before the new states, which may be the same memory, are written.
        let states = input(states_old, length)?;
        items.check::<L>(|i, item| {
            prefetch::<1>(states_old.wrapping_add((i + CHECKED_AHEAD) * state_length));
            L::check_header(states.part(i * state_length..(i + 1) * state_length))?;
            displacement.get(i).map_or(Ok(()), |displacement| L::check_step(item, displacement))
        })?;
    }
    for (i, item) in items.checked() {
        let Some(displacement) = displacement.get(i) else { break };
        let state_old = states_old.wrapping_add(i * state_length);
        prefetch::<4>(state_old.wrapping_add(PREFETCH_DISTANCE * state_length));
        let states = (state_length, state_old, item_of(states_new, i * state_length));
        step::<L>(item, states, displacement, outputs, i);
    }
    Ok(())
}

/// Item i of an output; NULL if that is.
fn item_of<T>(output: *mut T, i: usize) -> *mut T {
    if output.is_null() { output } else { output.wrapping_add(i) }
}

/// Numbers of items between the one that is computed, or checked, and the one whose state is fetched from main memory: an access
/// takes about the time of as many items.
const PREFETCH_DISTANCE: usize = 16;
const CHECKED_AHEAD: usize = 32;

/// Fetches the first cache lines of a state, its tag or also its first reversals or knots: the hardware does not, because states
/// are read in part only. Other processors than x86-64 have no stable intrinsic for it.
#[cfg_attr(not(target_arch = "x86_64"), expect(unused_variables))]
fn prefetch<const LINES: usize>(state: *const f64) {
    #[cfg(target_arch = "x86_64")]
    for line in 0..LINES {
        use core::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // SAFETY: every x86-64 processor has the instruction, and any address is allowed.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(state.wrapping_add(8 * line).cast()) };
    }
}

/// Harmonic forces of all active items, with displacements of `one` coefficients.
unsafe fn harmonic_forces<L: Law>(
    items: Items<L::Item>,
    workspace: &mut L::Workspace<'_>,
    one: usize,
    displacement: *const f64,
    [force, jacobian, dissipated, drift]: [*mut f64; 4],
) -> Result<(), Failure> {
    check_length::<f64>(items.n.checked_mul(one * one).ok_or(Error::BadArraySize)?)?;
    [force, jacobian, dissipated, drift].iter().try_for_each(|output| check_alignment(*output))?;
    check_input(displacement, items.n)?;
    // The arrays of an element with another number of directions are shorter: its coefficients are referenced after its check.
    let displacement_of = |i: usize| slice::from_raw_parts(displacement.wrapping_add(i * one), one);
    items.check::<L>(|i, item| L::check_motion(item, workspace, displacement_of(i)))?;
    items.checked().try_for_each(|(i, item)| {
        let output = HarmonicOutput {
            force: requested(item_of(force, i * one), one),
            jacobian: requested(item_of(jacobian, i * one * one), one * one),
            dissipated: item_of(dissipated, i).as_mut(),
            drift: item_of(drift, i).as_mut(),
        };
        Ok(L::harmonic_force(item, workspace, displacement_of(i), output)?)
    })
}

/// mslip_complex_stiffness for n items, one amplitude each.
///
/// Returns MSLIP_BAD_INDEX or the codes of mslip_complex_stiffness.
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
    failed_item: *mut size_t,
) -> i32 {
    call_batch(n, failed_item, || {
        let (items, amplitude, mut outputs) = (
            Items::new(n, n_contacts, contacts, index, active)?,
            input(amplitude, n)?,
            outputs([k_real, k_imag, dk_real, dk_imag], n)?,
        );
        items.check::<ConstantLoad>(|i, _| check_amplitude(amplitude.or_zero(i)))?;
        let requested = stiffness_requested(&outputs);
        for (i, contact) in items.checked() {
            let places = outputs.each_mut().map(|output| output.as_mut().and_then(|output| output.get_mut(i)));
            write(places, contact.stiffness_of_cycle(amplitude.or_zero(i), requested));
        }
        Ok(())
    })
}

/// mslip_masing_update for n items: states hold state_length doubles per item, contiguously; displacement, force, stiffness and
/// dissipated one. states_new may alias states_old.
///
/// Returns MSLIP_BAD_INDEX or the codes of mslip_masing_update.
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
    failed_item: *mut size_t,
) -> i32 {
    call_batch(n, failed_item, || {
        let items = Items::new(n, n_contacts, contacts, index, active)?;
        let states = (state_length, states_old, states_new);
        update::<ConstantLoad>(items, states, displacement, [force, stiffness, dissipated])
    })
}

/// mslip_harmonic_force for n items with one workspace: displacement and force hold 2H+1 doubles per item, jacobian (2H+1)^2,
/// dissipated one.
///
/// Returns MSLIP_BAD_INDEX or the codes of mslip_harmonic_force.
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
    failed_item: *mut size_t,
) -> i32 {
    call_batch(n, failed_item, || {
        let items = Items::new(n, n_contacts, contacts, index, active)?;
        let (mut workspace, outputs) =
            (pointers::workspace(workspace)?, [force, jacobian, dissipated, ptr::null_mut()]);
        let one = workspace.coefficients();
        harmonic_forces::<ConstantLoad>(items, &mut workspace, one, displacement, outputs)
    })
}

/// mslip_element_update for n items, all with the same number of tangential directions: states hold state_length doubles per item,
/// contiguously; with m = 2 components for one direction, 3 for two, displacement and force hold m doubles per item, tangent m x m,
/// dissipated one; m is that of the first item that is not skipped. states_new may alias states_old.
///
/// Returns MSLIP_BAD_INDEX, MSLIP_BAD_DIRECTIONS for elements or states of different numbers of directions, or the codes of
/// mslip_element_update.
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
    failed_item: *mut size_t,
) -> i32 {
    call_batch(n, failed_item, || {
        let items = Items::<Element>::new(n, n_elements, elements, index, active)?;
        let (states, outputs) = ((state_length, states_old, states_new), [force, tangent, dissipated]);
        with_law!(items.directions(), L => update::<L>(items, states, displacement, outputs))
    })
}

/// mslip_element_harmonic_force for n items with one workspace: with m = 2 components for a workspace of one tangential direction,
/// 3 for one of two, displacement and force hold m(2H+1) doubles per item, jacobian (m(2H+1))^2, dissipated and drift one.
///
/// Returns MSLIP_BAD_INDEX or the codes of mslip_element_harmonic_force, MSLIP_BAD_DIRECTIONS for an element with another number of
/// directions than the workspace.
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
    drift: *mut f64,
    failed_item: *mut size_t,
) -> i32 {
    call_batch(n, failed_item, || {
        let items = Items::<Element>::new(n, n_elements, elements, index, active)?;
        let (directions, size, extent) = pointers::element_workspace_size(workspace)?;
        let memory = output(workspace, extent)?.ok_or(Error::BadWorkspace)?;
        let (one, outputs) = ((directions as usize + 1) * size.coefficients(), [force, jacobian, dissipated, drift]);
        with_law!(directions, L => {
            harmonic_forces::<L>(items, &mut <L as Law>::Workspace::of_size(size, memory)?, one, displacement, outputs)
        })
    })
}
