//! The memory of a contact: where its displacement turned, and which branch a further displacement leads to.
//!
//! A branch starts at a reversal. Reversals nest; a branch that comes back to the reversal before the one it left closes that
//! loop, and both are forgotten. The first reversal of all is closed at its mirror point on the virgin curve. Gross slip
//! forgets everything and carries the origin of the virgin curve along: from then on, to come back to that curve is to slide.
//!
//! All this is found by comparing displacements; no force is needed. A state is an array of doubles that belongs to the
//! caller:
//!
//! ```text
//! [seal, number of reversals, displacement, slid, force, origin,   displacement and force of each reversal, oldest first]
//! ```
//!
//! What is written by itself does not stand beside what it would be read with as one vector: a processor waits long for such
//! a pair.

use crate::contact::Contact;
use crate::error::Error;
use crate::seal::{Kind, of_places, of_whole, seal, whole};

pub(crate) const HEADER: usize = 6;
pub(crate) const PER_REVERSAL: usize = 2;

/// Doubles of a state that holds that many nested reversals.
#[must_use]
pub const fn state_length(reversals: usize) -> usize {
    reversals.saturating_mul(PER_REVERSAL).saturating_add(HEADER)
}

/// Makes a virgin state: no force, no displacement, no reversal.
///
/// # Errors
/// `StateTooShort` for fewer doubles than a state of no reversals has.
pub fn state_init(state: &mut [f64]) -> Result<(), Error> {
    if state.len() < HEADER {
        return Err(Error::StateTooShort);
    }
    state.fill(0.0);
    if let Some(seal) = state.first_mut() {
        *seal = seal_of([0.0; 5], core::iter::empty());
    }
    Ok(())
}

/// The seal of what a state begins with, from the number of reversals on, and of the reversals that it uses. What lies beyond
/// them may be anything.
#[inline(always)]
pub(crate) fn seal_of(header: [f64; HEADER - 1], reversals: impl Iterator<Item = f64>) -> f64 {
    seal(Kind::State, of_places(header.into_iter().chain(reversals)))
}

/// A turning point of the displacement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Reversal {
    pub displacement: f64,
    pub force: f64,
}

/// The virgin curve of a history.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Virgin {
    /// Displacement at which it starts.
    pub origin: f64,
    /// Direction, +1 or -1, in which gross slip carried it along last; 0 if it never did. Nothing but its ends, at mu N, can
    /// be reached again after that.
    pub slid: f64,
}

impl Virgin {
    pub const NEW: Virgin = Virgin { origin: 0.0, slid: 0.0 };

    /// The curve after a course; without friction every point is an origin.
    #[inline(always)]
    pub fn after(self, contact: &Contact, course: &Course, displacement: f64) -> Virgin {
        if contact.is_frictionless() {
            Virgin { origin: displacement, slid: 0.0 }
        } else if course.slides {
            Virgin { origin: displacement - course.direction * contact.slip_displacement, slid: course.direction }
        } else {
            self
        }
    }
}

/// A state as it is read.
#[derive(Debug, Clone, Copy)]
pub(crate) struct State<'a> {
    pub virgin: Virgin,
    pub now: Reversal,
    reversals: &'a [f64],
    /// How many reversals it may hold.
    pub capacity: usize,
}

impl<'a> State<'a> {
    /// A state kept elsewhere: pairs of displacement and force, oldest first.
    pub fn of(virgin: Virgin, now: Reversal, reversals: &'a [f64]) -> State<'a> {
        State { virgin, now, reversals, capacity: reversals.len() / PER_REVERSAL }
    }

    /// Reads a state.
    ///
    /// # Errors
    /// `StateTooShort` for an array that is no state, `BadState` for one that was not initialised or was changed.
    #[inline(always)]
    pub fn read(state: &'a [f64]) -> Result<State<'a>, Error> {
        let &[seal, count, displacement, slid, force, origin, ref reversals @ ..] = state else {
            return Err(Error::StateTooShort);
        };
        let capacity = reversals.len() / PER_REVERSAL;
        let depth = whole(count).filter(|depth| *depth <= capacity).ok_or(Error::BadState)?;
        let used = reversals.get(..PER_REVERSAL * depth).ok_or(Error::BadState)?;
        let expected = seal_of([count, displacement, slid, force, origin], used.iter().copied());
        if seal.to_bits() != expected.to_bits() {
            return Err(Error::BadState);
        }
        Ok(State { virgin: Virgin { origin, slid }, now: Reversal { displacement, force }, reversals: used, capacity })
    }

    #[inline(always)]
    pub fn depth(&self) -> usize {
        self.reversals.len() / PER_REVERSAL
    }

    /// Reversal 1 is the oldest.
    #[inline(always)]
    pub fn reversal(&self, number: usize) -> Option<Reversal> {
        let mut pair = self.reversals.get(PER_REVERSAL * number.checked_sub(1)?..)?.iter();
        Some(Reversal { displacement: *pair.next()?, force: *pair.next()? })
    }

    /// The reversals, oldest first.
    pub fn history(&self) -> impl Iterator<Item = Reversal> + 'a {
        let pairs = self.reversals.chunks_exact(PER_REVERSAL);
        pairs.filter_map(
            |pair| if let &[displacement, force] = pair { Some(Reversal { displacement, force }) } else { None },
        )
    }
}

/// A state that is led along a path: read once, and written at the end.
#[derive(Debug)]
pub(crate) struct Track<'s> {
    virgin: Virgin,
    now: Reversal,
    depth: usize,
    header: &'s mut [f64],
    reversals: &'s mut [f64],
}

impl<'s> Track<'s> {
    /// # Errors
    /// Those of [`State::read`].
    pub fn start(state: &'s mut [f64]) -> Result<Track<'s>, Error> {
        let read = State::read(state)?;
        let (virgin, now, depth) = (read.virgin, read.now, read.depth());
        let (header, reversals) = state.split_at_mut_checked(HEADER).ok_or(Error::StateTooShort)?;
        Ok(Track { virgin, now, depth, header, reversals })
    }

    #[inline(always)]
    pub fn state(&self) -> State<'_> {
        State {
            virgin: self.virgin,
            now: self.now,
            reversals: self.reversals.get(..PER_REVERSAL * self.depth).unwrap_or(&[]),
            capacity: self.reversals.len() / PER_REVERSAL,
        }
    }

    /// Goes where a course leads.
    #[inline(always)]
    pub fn go(&mut self, course: &Course, virgin: Virgin, end: Reversal) {
        if course.turned
            && let Some(newest) = self.reversals.as_chunks_mut().0.get_mut(course.depth.wrapping_sub(1))
        {
            *newest = [self.now.displacement, self.now.force];
        }
        (self.virgin, self.now, self.depth) = (virgin, end, course.depth);
    }

    /// Writes where it came to.
    pub fn finish(self) {
        let Reversal { displacement, force } = self.now;
        let header = [of_whole(self.depth), displacement, self.virgin.slid, force, self.virgin.origin];
        let seal = seal_of(header, self.reversals.iter().copied().take(PER_REVERSAL * self.depth));
        self.header.iter_mut().zip([seal].into_iter().chain(header)).for_each(|(place, value)| *place = value);
    }
}

/// Where a step leads, by displacements alone: no force is computed to find it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Course {
    /// Reversals that the step leaves behind it; the newest may be the point at which the step started.
    pub depth: usize,
    /// Start of the branch on which the step ends, none on the virgin curve.
    pub branch: Option<Reversal>,
    /// Whether the step turned round where it started, and that reversal is still open.
    pub turned: bool,
    /// +1 or -1.
    pub direction: f64,
    /// Whether the step ends in gross slip.
    pub slides: bool,
}

/// One stretch of a step along one branch, for the energy: both ends as displacements on the monotonic curve.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stretch {
    /// Two half-curves make a branch, one the virgin curve.
    pub halves: f64,
    pub from: f64,
    pub to: f64,
    /// Length of gross slip at its end.
    pub slipped: f64,
}

/// The course of a contact; without friction there is nothing to remember.
#[inline(always)]
pub(crate) fn course(contact: &Contact, state: &State, target: f64) -> Course {
    if contact.is_frictionless() {
        return Course { depth: 0, branch: None, turned: false, direction: 1.0, slides: false };
    }
    follow(state, contact.slip_displacement, target, |_| {})
}

/// Follows the memory from the present point to another displacement, closing the loops on the way. `passed` hears of each
/// stretch that is left.
#[inline(always)]
pub(crate) fn follow(state: &State, slip_displacement: f64, target: f64, mut passed: impl FnMut(Stretch)) -> Course {
    let start = state.now;
    let newest = state.reversal(state.depth());
    // Where the branch was going. In gross slip its origin may be too far away for a difference to tell.
    let heading = match newest {
        Some(reversal) => start.displacement - reversal.displacement,
        None if state.virgin.slid != 0.0 => state.virgin.slid,
        None => start.displacement - state.virgin.origin,
    };
    // A step of zero goes on.
    let way = if target == start.displacement { heading } else { target - start.displacement };
    let direction = if way < 0.0 { -1.0 } else { 1.0 };
    let reaches = |displacement: f64| direction * (target - displacement) >= 0.0;
    let mut turned = direction * heading < 0.0;
    let mut depth = state.depth() + usize::from(turned);
    let mut branch = if turned { Some(start) } else { newest };
    let mut from = start.displacement;

    while let Some(reversal) = branch {
        let half_way = |displacement: f64| 0.5 * (displacement - reversal.displacement).abs();
        // The end of this branch: the reversal before it, or the mirror point of the first one.
        let end = if depth >= 2 { state.reversal(depth - 1) } else { None };
        let end = end.map_or(2.0 * state.virgin.origin - reversal.displacement, |before| before.displacement);
        if !reaches(end) {
            passed(Stretch { halves: 2.0, from: half_way(from), to: half_way(target), slipped: 0.0 });
            return Course { depth, branch, turned, direction, slides: false };
        }
        passed(Stretch { halves: 2.0, from: half_way(from), to: half_way(end), slipped: 0.0 });
        from = end;
        turned = false;
        depth = depth.saturating_sub(2);
        branch = state.reversal(depth);
    }
    let Virgin { origin, slid } = state.virgin;
    let along = |displacement: f64| (displacement - origin).abs().min(slip_displacement);
    let (first, last, slipped) = if slid == 0.0 {
        (along(from), along(target), (direction * (target - origin) - slip_displacement).max(0.0))
    } else {
        (0.0, 0.0, (target - from).abs())
    };
    passed(Stretch { halves: 1.0, from: first, to: last, slipped });
    Course { depth: 0, branch: None, turned: false, direction, slides: slid != 0.0 || slipped > 0.0 }
}
