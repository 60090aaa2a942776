//! Masing's rule with return-point memory, for any history of displacements (Eq. 11, 12).
//!
//! A branch that starts at a reversal is the monotonic curve twice as large, `|δ-δ_r| = 2 M(|T-T_r|/2)`, always measured
//! from its reversal. Reversals nest; a branch that comes back to the reversal before the one it left closes that loop, and
//! both are forgotten. The first reversal of all is closed at its mirror point on the virgin curve. Gross slip forgets
//! everything and carries the origin of the virgin curve along: from then on, to come back to that curve is to slide.
//!
//! A state is an array of doubles that belongs to the caller:
//!
//! ```text
//! [mark, number of reversals, origin, slid, displacement, force,   displacement and force of each reversal, oldest first]
//! ```
//!
//! An update is found from the old state ([`step`]) before anything is written ([`Step::write`]): the old state may be
//! read-only, a refused step leaves nothing behind, and both may be one array.

use crate::contact::Contact;
use crate::curve::check_displacement;
use crate::error::Error;
use crate::family::Member;

/// Tells a state from other memory.
const MARK: f64 = f64::from_bits(0x4d53_4c49_5053_5431);

const HEADER: usize = 6;
const PER_REVERSAL: usize = 2;

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
    if let Some(mark) = state.first_mut() {
        *mark = MARK;
    }
    Ok(())
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
    /// Whether gross slip has carried it along: nothing but its ends, at mu N, can then be reached again.
    pub slid: bool,
}

impl Virgin {
    pub const NEW: Virgin = Virgin { origin: 0.0, slid: false };

    /// The curve after a course; without friction every point is an origin.
    pub fn after(self, contact: &Contact, course: &Course, displacement: f64) -> Virgin {
        if contact.is_frictionless() {
            Virgin { origin: displacement, slid: false }
        } else if course.slides {
            Virgin { origin: displacement - course.direction * contact.slip_displacement, slid: true }
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
    capacity: usize,
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
    pub fn read(state: &'a [f64]) -> Result<State<'a>, Error> {
        let &[mark, count, origin, slid, displacement, force, ref reversals @ ..] = state else {
            return Err(Error::StateTooShort);
        };
        let numbers =
            [origin, displacement, force].iter().all(|value| value.is_finite()) && (slid == 0.0 || slid == 1.0);
        if mark.to_bits() != MARK.to_bits() || !numbers {
            return Err(Error::BadState);
        }
        let capacity = reversals.len() / PER_REVERSAL;
        // Compared as doubles: a conversion of what is no number would trap.
        if !(0.0..=capacity as f64).contains(&count) || count.floor() != count {
            return Err(Error::BadState);
        }
        let used = reversals.get(..PER_REVERSAL * count as usize).ok_or(Error::BadState)?;
        if used.iter().all(|value| value.is_finite()) {
            let virgin = Virgin { origin, slid: slid != 0.0 };
            Ok(State { virgin, now: Reversal { displacement, force }, reversals: used, capacity })
        } else {
            Err(Error::BadState)
        }
    }

    pub fn depth(&self) -> usize {
        self.reversals.len() / PER_REVERSAL
    }

    /// Reversal 1 is the oldest.
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
    halves: f64,
    from: f64,
    to: f64,
    /// Length of gross slip at its end.
    slipped: f64,
}

/// Sums the energy of stretches: one monotonic loading dissipates a quarter of its cycle's energy, one branch twice that
/// of its half.
#[derive(Debug)]
pub(crate) struct Dissipation<'a> {
    contact: &'a Contact,
    pub sum: f64,
    /// The end of the stretch before, where the next one mostly starts, and its energy.
    last: (f64, f64),
}

impl<'a> Dissipation<'a> {
    pub fn new(contact: &'a Contact) -> Dissipation<'a> {
        Dissipation { contact, sum: 0.0, last: (0.0, 0.0) }
    }

    pub fn add(&mut self, stretch: &Stretch) {
        let contact = self.contact;
        let energy = |way: f64| contact.energy_of(&contact.stick_at_displacement(way));
        if stretch.to > stretch.from {
            let from = if stretch.from == self.last.0 { self.last.1 } else { energy(stretch.from) };
            self.last = (stretch.to, energy(stretch.to));
            self.sum += 0.25 * stretch.halves * (self.last.1 - from).max(0.0);
        }
        self.sum += contact.slip_force * stretch.slipped;
    }
}

/// The course of a contact; without friction there is nothing to remember.
pub(crate) fn course(contact: &Contact, state: &State, target: f64) -> Course {
    if contact.is_frictionless() {
        return Course { depth: 0, branch: None, turned: false, direction: 1.0, slides: false };
    }
    follow(state, contact.slip_displacement, target, |_| {})
}

/// Follows the memory from the present point to another displacement, closing the loops on the way. `passed` hears of each
/// stretch that is left.
pub(crate) fn follow(state: &State, slip_displacement: f64, target: f64, mut passed: impl FnMut(Stretch)) -> Course {
    let start = state.now;
    let newest = state.reversal(state.depth());
    let heading = start.displacement - newest.map_or(state.virgin.origin, |reversal| reversal.displacement);
    // A step of zero goes on where the branch was going.
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
    let slipped =
        if slid { (target - from).abs() } else { (direction * (target - origin) - slip_displacement).max(0.0) };
    let (start, end) = if slid { (0.0, 0.0) } else { (along(from), along(target)) };
    passed(Stretch { halves: 1.0, from: start, to: end, slipped });
    Course { depth: 0, branch: None, turned: false, direction, slides: slid || slipped > 0.0 }
}

/// Force at the end of a course, and the stick zone on its branch; none in gross slip and without friction.
pub(crate) fn force_at(contact: &Contact, origin: f64, course: &Course, displacement: f64) -> (f64, Option<Member>) {
    let limit = contact.slip_force;
    if contact.is_frictionless() {
        return (0.0, None);
    }
    if course.slides {
        return (course.direction * limit, None);
    }
    let from = course.branch.unwrap_or(Reversal { displacement: origin, force: 0.0 });
    let halves = if course.branch.is_some() { 2.0 } else { 1.0 };
    let stick = contact.stick_at_displacement((displacement - from.displacement).abs() / halves);
    let force = from.force + course.direction * halves * contact.force_of(&stick);
    (force.max(-limit).min(limit), Some(stick))
}

/// A step that was found and may be written.
#[derive(Debug, Clone, Copy)]
pub struct Step<'a> {
    contact: &'a Contact,
    course: Course,
    virgin: Virgin,
    start: Reversal,
    end: Reversal,
    stick: Option<Member>,
}

/// Finds the step of a contact from a state to a displacement \[m\].
///
/// # Errors
/// `BadState`, `StateTooShort`, `BadDisplacement`; `StateFull` where a further reversal would have to be remembered than
/// the state holds.
pub fn step<'a>(contact: &'a Contact, state: &[f64], displacement: f64) -> Result<Step<'a>, Error> {
    let state = State::read(state)?;
    check_displacement(displacement)?;
    let course = course(contact, &state, displacement);
    if course.depth > state.capacity {
        return Err(Error::StateFull);
    }
    Ok(Step::along(contact, &state, course, displacement))
}

/// Whether [`step`] would find a step, without finding its force.
///
/// # Errors
/// Those of [`step`].
pub fn check_step(contact: &Contact, state: &[f64], displacement: f64) -> Result<(), Error> {
    let state = State::read(state)?;
    check_displacement(displacement)?;
    if course(contact, &state, displacement).depth > state.capacity { Err(Error::StateFull) } else { Ok(()) }
}

impl<'a> Step<'a> {
    fn along(contact: &'a Contact, state: &State, course: Course, displacement: f64) -> Step<'a> {
        let start = state.now;
        let (force, stick) = force_at(contact, state.virgin.origin, &course, displacement);
        let virgin = state.virgin.after(contact, &course, displacement);
        Step { contact, course, virgin, start, end: Reversal { displacement, force }, stick }
    }

    /// Tangential force \[N\] after the step.
    #[must_use]
    pub fn force(&self) -> f64 {
        self.end.force
    }

    /// dT/d(displacement) \[N/m\] on the branch on which the step ends; 0 in gross slip.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        self.stick.map_or(0.0, |stick| self.contact.stiffness_of(&stick))
    }

    /// Energy \[J\] dissipated by the step, not negative; `state` is the one from which it was found.
    ///
    /// # Errors
    /// `BadState`, `StateTooShort`: those of [`step`].
    pub fn dissipated(&self, state: &[f64]) -> Result<f64, Error> {
        let state = State::read(state)?;
        let contact = self.contact;
        if contact.is_frictionless() || self.end.displacement == self.start.displacement {
            return Ok(0.0);
        }
        let mut dissipation = Dissipation::new(contact);
        follow(&state, contact.slip_displacement, self.end.displacement, |stretch| dissipation.add(&stretch));
        Ok(dissipation.sum)
    }

    /// Writes the step into the state it was found from, or into a copy of it.
    pub fn write(&self, state: &mut [f64]) {
        let &mut [
            _,
            ref mut count,
            ref mut origin,
            ref mut slid,
            ref mut displacement,
            ref mut force,
            ref mut reversals @ ..,
        ] = state
        else {
            return;
        };
        *count = self.course.depth as f64;
        *origin = self.virgin.origin;
        *slid = f64::from(u8::from(self.virgin.slid));
        *displacement = self.end.displacement;
        *force = self.end.force;
        if self.course.turned {
            let newest = reversals.chunks_exact_mut(PER_REVERSAL).nth(self.course.depth.wrapping_sub(1));
            if let Some([displacement, force]) = newest {
                *displacement = self.start.displacement;
                *force = self.start.force;
            }
        }
    }
}

/// How many nested reversals a path may add before it has to be walked in parts: those of a dry run without memory of its own.
const DRY_REVERSALS: usize = 512;

/// Whether a state can take a whole path, found before anything is written.
///
/// # Errors
/// `BadState`, `StateTooShort`, `BadDisplacement`; `StateFull` where the path nests more reversals than the state, or
/// [`DRY_REVERSALS`], can hold.
pub fn check_path(contact: &Contact, state: &[f64], path: &[f64]) -> Result<(), Error> {
    let read = State::read(state)?;
    let (mut turns, mut last, mut falls) = (1, read.now.displacement, false);
    for &displacement in path {
        check_displacement(displacement)?;
        turns += usize::from((displacement < last) != falls);
        falls = displacement < last;
        last = displacement;
    }
    if read.depth().saturating_add(turns) <= read.capacity {
        return Ok(());
    }
    let mut dry = [0.0; state_length(DRY_REVERSALS)];
    let length = state.len().min(dry.len());
    let (Some(dry), Some(used)) = (dry.get_mut(..length), state.get(..length)) else { return Err(Error::StateFull) };
    if read.depth() > DRY_REVERSALS {
        return Err(Error::StateFull);
    }
    dry.iter_mut().zip(used).for_each(|(dry, used)| *dry = *used);
    for &displacement in path {
        let read = State::read(dry)?;
        let course = course(contact, &read, displacement);
        if course.depth > read.capacity {
            return Err(Error::StateFull);
        }
        // The memory needs displacements only.
        let virgin = read.virgin.after(contact, &course, displacement);
        let (start, end) = (read.now, Reversal { displacement, force: 0.0 });
        Step { contact, course, virgin, start, end, stick: None }.write(dry);
    }
    Ok(())
}

/// Shear traction \[Pa\] at x \[m\] after any history: the traction of the first loading, and twice that of half of each
/// reversal's jump of force (Eq. 21 with Masing's rule).
///
/// # Errors
/// `BadState`, `StateTooShort`; `ForceExceedsSlip` for a state of another contact.
pub fn shear_after(contact: &Contact, state: &[f64], x: f64) -> Result<f64, Error> {
    let state = State::read(state)?;
    let mut sum = 0.0;
    let mut before = None;
    for turn in state.history().map(|reversal| reversal.force).chain([state.now.force]) {
        sum += match before {
            None => contact.curve_at_force(turn)?.shear(x),
            Some(force) => 2.0 * contact.curve_at_force(0.5 * (turn - force))?.shear(x),
        };
        before = Some(turn);
    }
    Ok(sum)
}
