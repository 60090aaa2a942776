//! The state of an element with two directions in the caller's memory.
//!
//! ```text
//! on a line:  [tag 0, v, state of one direction]
//! springs:    [tag 1, v, u, normal component, N, S, offset (2), force (2), 0, 0,
//!              displacements, tractions, edge and whole pressure, fine bank]
//! ```

use crate::element::springs::{Both, FINE, SPRINGS};
use crate::error::Error;
use crate::numerics::fp_class::is_finite;
use crate::one_direction::state;
use crate::tag::Kind;
use crate::two_directions::spring_state::{LONGEST, SpringState, StoredSprings};

const HEADER: usize = 12;
pub(super) const LENGTH: usize = HEADER + 6 * SPRINGS + 2 * FINE;
/// Values before the state of one direction.
const LINE: usize = 2;

/// Number of doubles in a state.
#[must_use]
pub const fn state_length() -> usize {
    LENGTH
}

/// Initialises a state: open, at displacement 0 and normal component 0.
///
/// # Errors
/// `StateTooShort` for fewer than [`state_length`] doubles.
pub fn state_init(state: &mut [f64]) -> Result<(), Error> {
    let state = state.get_mut(..LENGTH).ok_or(Error::StateTooShort)?;
    state.fill(0.0);
    let Some(([tag, _], line)) = state.split_first_chunk_mut::<LINE>() else { return Err(Error::StateTooShort) };
    *tag = Kind::TwoDirectionsState.tag(ON_LINE);
    state::state_init(line)
}

/// Counts in the tag: the two kinds of states.
const ON_LINE: usize = 0;
const SPRUNG: usize = 1;

/// Checks the length and the tag of a state.
///
/// # Errors
/// `StateTooShort` for fewer than [`state_length`] doubles; `BadState` for an array that is no state.
#[inline(always)]
pub(super) fn check_header(state: &[f64]) -> Result<(), Error> {
    if state.len() < LENGTH {
        return Err(Error::StateTooShort);
    }
    check_tag(state.first().copied().unwrap_or(0.0))?;
    match line_of(state) {
        Some(line) => state::check_header(line),
        None => Ok(()),
    }
}

/// Rejects the tag of what is no state.
#[inline(always)]
pub(super) fn check_tag(tag: f64) -> Result<(), Error> {
    match Kind::TwoDirectionsState.count(tag) {
        Some(ON_LINE | SPRUNG) => Ok(()),
        _ => Err(Error::BadState),
    }
}

/// The state of one direction in a state on a line.
pub(super) fn line_of(state: &[f64]) -> Option<&[f64]> {
    let on_line = Kind::TwoDirectionsState.count(*state.first()?) == Some(ON_LINE);
    state.get(LINE..LENGTH).filter(|_| on_line)
}

/// Validates a state in full: finite values, springs and tractions within their limits. For states from outside the process.
///
/// # Errors
/// `StateTooShort`; `BadState` for an array that was not initialised, or whose values no history leads to.
pub fn state_check(state: &[f64]) -> Result<(), Error> {
    check_header(state)?;
    let used = state.get(..LENGTH).ok_or(Error::StateTooShort)?;
    if !used.iter().all(|value| is_finite(*value)) {
        return Err(Error::BadState);
    }
    if let Some(line) = line_of(state) {
        return state::state_check(line);
    }
    let (header, Some(springs)) = (read_header(state), stored(state)) else { return Err(Error::StateTooShort) };
    let bounded = |x: f64, y: f64| x * x + y * y <= 1.0 + 1e-9;
    let [x, y] = springs.tractions;
    let within = x.iter().zip(y).all(|(x, y)| x.abs() <= 2.0 && y.abs() <= 2.0 && bounded(*x, *y));
    let positive = springs.shell_pressure.iter().chain(springs.pressure).all(|value| *value >= 0.0);
    let loads = header.load > 0.0 && header.shift > 0.0;
    let held = header.offset.iter().all(|offset| offset.abs() <= LONGEST);
    if within && positive && loads && held { Ok(()) } else { Err(Error::BadState) }
}

/// A bound on the error of the force \[N\] from merging pieces of the diagram on a line; 0 otherwise.
#[must_use]
pub fn force_error(state: &[f64]) -> f64 {
    line_of(state).map_or(0.0, state::force_error)
}

/// Where a contact with springs is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Header {
    pub displacement: Both<f64>,
    pub input: f64,
    pub load: f64,
    pub shift: f64,
    /// Motion of the springs since they last changed, and the sum of their forces then.
    pub offset: Both<f64>,
    pub sum: Both<f64>,
}

impl Header {
    /// Without springs.
    pub const NONE: Header =
        Header { displacement: [0.0; 2], input: 0.0, load: 0.0, shift: 0.0, offset: [0.0; 2], sum: [0.0; 2] };
}

#[inline(always)]
pub(super) fn stored(state: &[f64]) -> Option<StoredSprings<'_>> {
    StoredSprings::new(state.get(HEADER..)?)
}

#[inline(always)]
pub(super) fn read_header(state: &[f64]) -> Header {
    let [_, v, u, input, load, shift, offset_x, offset_y, sum_x, sum_y, ..] =
        *state.first_chunk::<HEADER>().unwrap_or(&[0.0; HEADER]);
    Header { displacement: [u, v], input, load, shift, offset: [offset_x, offset_y], sum: [sum_x, sum_y] }
}

/// Writes a state of springs.
pub(super) fn write(state: &mut [f64], header: &Header, springs: &SpringState) {
    let Some((place, mut rest)) = state.split_first_chunk_mut::<HEADER>() else { return };
    let Header { displacement: [u, v], input, load, shift, offset: [x, y], sum: [sum_x, sum_y] } = *header;
    *place = [Kind::TwoDirectionsState.tag(SPRUNG), v, u, input, load, shift, x, y, sum_x, sum_y, 0.0, 0.0];
    let mut put = |from: &[f64]| {
        if let Some((values, behind)) = core::mem::take(&mut rest).split_at_mut_checked(from.len()) {
            values.copy_from_slice(from);
            rest = behind;
        }
    };
    springs.springs.iter().for_each(|row| put(row));
    springs.tractions.iter().for_each(|row| put(row));
    put(&springs.shell_pressure);
    put(&springs.pressure);
    springs.fine.iter().for_each(|row| put(row));
}

/// Moves the springs of a state in which nothing slipped.
pub(super) fn move_springs(state: &mut [f64], [u, v]: Both<f64>, offset: Both<f64>) {
    if let Some([_, v_place, u_place, _, _, _, offset_x, offset_y, ..]) = state.first_chunk_mut::<HEADER>() {
        (*v_place, *u_place, [*offset_x, *offset_y]) = (v, u, offset);
    }
}

/// The state of one direction in a state on a line, and its v.
pub(super) fn line_mut(state: &mut [f64]) -> Option<(&mut f64, &mut [f64])> {
    let ([_, v], line) = state.get_mut(..LENGTH)?.split_first_chunk_mut::<LINE>()?;
    Some((v, line))
}

/// Copies what is in use of a state whose header was checked to one that is as long.
#[inline(always)]
pub(super) fn copy_used(from: &[f64], to: &mut [f64]) {
    if let (Some(from), Some(to)) = (from.first_chunk::<LENGTH>(), to.first_chunk_mut::<LENGTH>()) {
        *to = *from;
    }
}
