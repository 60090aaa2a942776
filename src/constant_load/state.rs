//! The state of a history in the caller's memory: an array of doubles.
//!
//! ```text
//! [tag with the number of reversals, displacement, slip direction, force, offset,
//!      displacement, force and error of each reversal, oldest first]
//! ```
//!
//! Values that are written one by one and read as one vector would make the processor wait: displacement and force of the present
//! point are not adjacent.

use crate::constant_load::ConstantLoad;
use crate::constant_load::contact::Contact;
use crate::constant_load::memory::{InitialCurve, Memory, Point, Reversal, push};
use crate::error::Error;
use crate::law::Law;
use crate::numerics::fp_class::is_finite;
use crate::tag::Kind;

const HEADER: usize = 5;
const PER_REVERSAL: usize = 3;
/// Reversals that every state holds: merging needs a pair.
const MIN_REVERSALS: usize = 2;

/// Number of doubles in a state that holds `reversals` nested reversals exactly; fewer than 2 count as 2.
pub const fn state_length(reversals: usize) -> usize {
    let reversals = if reversals < MIN_REVERSALS { MIN_REVERSALS } else { reversals };
    reversals.saturating_mul(PER_REVERSAL).saturating_add(HEADER)
}

/// Initialises a state: unloaded, at displacement 0.
/// Errors: `StateTooShort` for fewer than [`state_length`]`(0)` doubles.
pub fn state_init(state: &mut [f64]) -> Result<(), Error> {
    ConstantLoad::state_init(state)
}

/// Whether a state whose header was checked holds as many reversals as fit.
#[inline(always)]
pub(crate) fn is_full(state: &[f64]) -> bool {
    let depth = Kind::State.count(state.first().copied().unwrap_or(0.0)).unwrap_or(0);
    HEADER + PER_REVERSAL * (depth + 1) > state.len()
}

/// Rejects a tag that no state of that length has.
#[inline(always)]
pub(crate) fn check_tag(tag: f64, state_length: usize) -> Result<(), Error> {
    match Kind::State.count(tag) {
        Some(depth) if HEADER + PER_REVERSAL * depth <= state_length => Ok(()),
        _ => Err(Error::BadState),
    }
}

/// The memory in a state whose header was checked.
#[inline(always)]
pub(crate) fn memory(state: &[f64]) -> Memory<'_> {
    let &[tag, displacement, slip_direction, force, offset, ref reversals @ ..] = state else {
        return Memory::UNLOADED;
    };
    let used = PER_REVERSAL * Kind::State.count(tag).unwrap_or(0);
    let (initial, now) = (InitialCurve { offset, slip_direction }, Point { displacement, force });
    Memory { initial, now, reversals: reversals.get(..used).unwrap_or(&[]).as_chunks().0 }
}

/// Reads a state.
pub(crate) fn read(state: &[f64]) -> Result<Memory<'_>, Error> {
    ConstantLoad::check_header(state)?;
    Ok(memory(state))
}

/// Copies a state that was checked into one that may hold fewer reversals.
pub(crate) fn copy(contact: &Contact, from: &[f64], to: &mut [f64]) {
    let memory = memory(from);
    let reversals = reversals_mut(to);
    let (mut depth, mut shift) = (0, 0.0);
    for &[displacement, force, error] in memory.reversals {
        let reversal = Point { displacement, force: force + shift };
        let (pushed, change) = push(contact, memory.initial.offset, reversals, depth, reversal);
        (depth, shift) = (pushed, shift + change);
        if let Some([.., copied]) = reversals.get_mut(depth - 1) {
            *copied = error;
        }
    }
    let now = Point { force: memory.now.force + shift, ..memory.now };
    write_header(to, depth, memory.initial, now);
}

/// The reversals of a state, used or not.
#[inline(always)]
pub(crate) fn reversals_mut(state: &mut [f64]) -> &mut [Reversal] {
    state.get_mut(HEADER..).unwrap_or(&mut []).as_chunks_mut().0
}

/// Writes the header.
#[inline(always)]
pub(crate) fn write_header(state: &mut [f64], depth: usize, initial: InitialCurve, now: Point) {
    if let Some(header) = state.first_chunk_mut::<HEADER>() {
        let InitialCurve { offset, slip_direction } = initial;
        *header = [Kind::State.tag(depth), now.displacement, slip_direction, now.force, offset];
    }
}

/// Sets displacement and force in the header.
#[inline(always)]
pub(crate) fn set_point(state: &mut [f64], now: Point) {
    if let Some([_, displacement, _, force, _]) = state.first_chunk_mut::<HEADER>() {
        (*displacement, *force) = (now.displacement, now.force);
    }
}

/// Validates a state in full: all values are finite, and the reversals are nested. For states from outside the process.
/// Errors: `StateTooShort`; `BadState` for an array that was not initialised, or whose values no history leads to.
pub fn state_check(state: &[f64]) -> Result<(), Error> {
    let Memory { initial: InitialCurve { offset, slip_direction }, now, reversals } = read(state)?;
    let header = [now.displacement, now.force, offset, slip_direction];
    let finite = header.iter().chain(reversals.as_flattened()).all(|value| is_finite(*value));
    if !finite || ![-1.0, 0.0, 1.0].contains(&slip_direction) || reversals.iter().any(|[.., error]| *error < 0.0) {
        return Err(Error::BadState);
    }
    // Each lies between the two before it; the oldest and its mirror point enclose all others.
    let mut bounds = None;
    for displacement in reversals.iter().map(|[displacement, ..]| *displacement).chain([now.displacement]) {
        bounds = match bounds {
            None if reversals.is_empty() => None,
            None => Some((2.0 * offset - displacement, displacement)),
            Some((before, last)) => {
                let (low, high) = if before < last { (before, last) } else { (last, before) };
                if displacement < low || displacement > high {
                    return Err(Error::BadState);
                }
                Some((last, displacement))
            }
        };
    }
    Ok(())
}

/// Bound on the error \[N\] that merged reversals have caused in the force; 0 while none was merged, and again once gross slip has
/// erased the memory.
/// Errors: `StateTooShort`, `BadState`.
pub fn state_error(state: &[f64]) -> Result<f64, Error> {
    ConstantLoad::check_header(state)?;
    Ok(ConstantLoad::force_error(state))
}
