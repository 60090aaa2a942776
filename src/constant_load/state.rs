//! The state of a history in the caller's memory: an array of doubles.
//!
//! ```text
//! [tag, number of reversals, displacement, slip direction, force, offset,
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
use crate::numerics::slices::PanicFreeSlice;
use crate::tag::{Kind, count, stored};

pub(crate) const HEADER: usize = 6;
pub(crate) const PER_REVERSAL: usize = 3;
/// Reversals that every state holds: merging needs a pair.
const MIN_REVERSALS: usize = 2;

/// Number of doubles in a state that holds `reversals` nested reversals exactly; fewer than 2 count as 2.
pub const fn state_length(reversals: usize) -> usize {
    let reversals = if reversals < MIN_REVERSALS { MIN_REVERSALS } else { reversals };
    reversals.saturating_mul(PER_REVERSAL).saturating_add(HEADER)
}

/// The number of reversals in a state.
pub(crate) fn depth(state: &[f64]) -> Option<usize> {
    state.get(1).copied().and_then(count)
}

/// Whether a state whose header was checked holds as many reversals as fit.
pub(crate) fn is_full(state: &[f64]) -> bool {
    HEADER + PER_REVERSAL * (depth(state).unwrap_or(0) + 1) > state.len()
}

/// The memory in a state whose header was checked.
pub(crate) fn memory(state: &[f64]) -> Memory<'_> {
    let &[_, depth, displacement, slip_direction, force, offset, ref reversals @ ..] = state else {
        return Memory::default();
    };
    let used = PER_REVERSAL * count(depth).unwrap_or(0);
    let (initial, now) = (InitialCurve { offset, slip_direction }, Point { displacement, force });
    Memory { initial, now, reversals: reversals.part(..used).blocks() }
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
pub(crate) fn reversals_mut(state: &mut [f64]) -> &mut [Reversal] {
    state.part_mut(HEADER..).blocks_mut()
}

/// Writes the header.
pub(crate) fn write_header(state: &mut [f64], depth: usize, initial: InitialCurve, now: Point) {
    if let Some(header) = state.first_chunk_mut::<HEADER>() {
        let InitialCurve { offset, slip_direction } = initial;
        *header = [Kind::State.tag(), stored(depth), now.displacement, slip_direction, now.force, offset];
    }
}

/// Sets displacement and force in the header.
pub(crate) fn set_point(state: &mut [f64], now: Point) {
    if let Some([_, _, displacement, _, force, _]) = state.first_chunk_mut::<HEADER>() {
        (*displacement, *force) = (now.displacement, now.force);
    }
}
