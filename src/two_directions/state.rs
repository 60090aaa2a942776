//! The state of an element with two directions in the caller's memory.
//!
//! ```text
//! on a line:  [tag 0, v, state of one direction]
//! springs:    [tag 1, v, u, normal component, N, S, offset (2), force (2), key of the element, units of the springs (3), their number,
//!              those under the flat, w², 0, 0, 0,
//!              springs, tables]
//! ```
//!
//! The tables are those of the springs, aligned with a size: the state carries them, as they change with its history only.

use crate::element::Element;
use crate::error::Error;
use crate::numerics::fp_class::is_finite;
use crate::one_direction::state;
use crate::tag::Kind;
use crate::two_directions::spring_state::{LONGEST, SpringState, StoredSprings, springs_length};
use crate::two_directions::springs::{Both, MOST, Pressed, Springs, TABLES, Units};

const HEADER: usize = 20;
pub(super) const LENGTH: usize = HEADER + springs_length(MOST) + TABLES;
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
    let header = read_header(state);
    let Units { load, shift, size } = header.units;
    let loads = [header.load, header.shift, load, shift, size].iter().all(|value| *value > 0.0);
    let held = header.offset.iter().all(|offset| offset.abs() <= LONGEST);
    let within = match header.springs {
        8 => stored::<8>(state).is_some_and(|springs| springs.is_within()),
        12 => stored::<12>(state).is_some_and(|springs| springs.is_within()),
        16 => stored::<16>(state).is_some_and(|springs| springs.is_within()),
        _ => false,
    };
    if within && loads && held { Ok(()) } else { Err(Error::BadState) }
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
    /// w² in the units of the springs.
    pub size: f64,
    /// Motion of the springs since they last changed, and the sum of their forces then.
    pub offset: Both<f64>,
    pub sum: Both<f64>,
    /// Of the element whose tables these are, their units and the number of springs.
    pub key: f64,
    pub units: Units,
    pub springs: usize,
    /// Springs under the flat.
    pub under_flat: usize,
}

impl Header {
    /// Without springs.
    pub const NONE: Header = Header {
        displacement: [0.0; 2],
        input: 0.0,
        load: 0.0,
        shift: 0.0,
        size: 0.0,
        offset: [0.0; 2],
        sum: [0.0; 2],
        key: 0.0,
        units: Units::NONE,
        springs: 0,
        under_flat: 0,
    };

    /// The normal state in the units of the springs.
    #[inline(always)]
    pub fn pressed(&self, element: &Element) -> Pressed {
        self.units.pressed(element, self.load, self.shift, self.size)
    }

    /// Whether the tables are those of an element.
    #[inline(always)]
    pub fn belongs_to(&self, element: &Element) -> bool {
        self.key == element.key && self.springs == element.springs
    }
}

#[inline(always)]
pub(super) fn stored<const N: usize>(state: &[f64]) -> Option<StoredSprings<'_, N>> {
    StoredSprings::new(state.get(HEADER..)?)
}

/// The tables in a state.
#[inline(always)]
pub(super) fn tables<'a>(header: &Header, state: &'a [f64]) -> Option<Springs<'a>> {
    Springs::new(header.under_flat, state.get(HEADER + springs_length(MOST)..)?)
}

/// Writes the tables to a state.
pub(super) fn write_tables(state: &mut [f64], tables: &[f64; TABLES]) {
    if let Some(place) = state.get_mut(HEADER + springs_length(MOST)..).and_then(<[f64]>::first_chunk_mut) {
        *place = *tables;
    }
}

#[inline(always)]
pub(super) fn read_header(state: &[f64]) -> Header {
    let [
        _,
        v,
        u,
        input,
        load,
        shift,
        offset_x,
        offset_y,
        sum_x,
        sum_y,
        key,
        unit_load,
        unit_shift,
        unit_size,
        count,
        flat,
        size,
        ..,
    ] = *state.first_chunk::<HEADER>().unwrap_or(&[0.0; HEADER]);
    Header {
        displacement: [u, v],
        input,
        load,
        shift,
        size,
        offset: [offset_x, offset_y],
        sum: [sum_x, sum_y],
        key,
        units: Units { load: unit_load, shift: unit_shift, size: unit_size },
        springs: count as usize,
        under_flat: flat as usize,
    }
}

/// Writes a state of springs, except for the tables.
pub(super) fn write<const N: usize>(state: &mut [f64], header: &Header, springs: &SpringState<N>) {
    let Some((place, rest)) = state.split_first_chunk_mut::<HEADER>() else { return };
    let Header { displacement: [u, v], input, load, shift, offset: [x, y], sum: [sum_x, sum_y], key, units, .. } =
        *header;
    let under_flat = header.under_flat as f64;
    let tag = Kind::TwoDirectionsState.tag(SPRUNG);
    let Units { load: unit_load, shift: unit_shift, size: unit_size } = units;
    *place = [
        tag,
        v,
        u,
        input,
        load,
        shift,
        x,
        y,
        sum_x,
        sum_y,
        key,
        unit_load,
        unit_shift,
        unit_size,
        N as f64,
        under_flat,
        header.size,
        0.0,
        0.0,
        0.0,
    ];
    springs.write(rest);
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

/// Copies a state whose header was checked to one that is as long.
#[inline(always)]
pub(super) fn copy_used(from: &[f64], to: &mut [f64]) {
    if let (Some(from), Some(to)) = (from.first_chunk::<LENGTH>(), to.first_chunk_mut::<LENGTH>()) {
        *to = *from;
    }
}
