//! Masing's rule (Eq. 11, 12): force, tangent and energy along any history of displacements.
//!
//! A branch that starts at a reversal is the monotonic curve twice as large, `|δ-δ_r| = 2 M(|T-T_r|/2)`, always measured
//! from its reversal; the memory says from which.
//!
//! An update is found from the old state ([`step`]) before anything is written ([`Step::write`]): the old state may be
//! read-only, a refused step leaves nothing behind, and both may be one array.

use crate::contact::{Contact, check_displacement};
use crate::curve::Response;
use crate::error::Error;
use crate::memory::{
    Course, PER_REVERSAL, Reversal, State, Stretch, Track, Virgin, course, follow, seal_of, state_length,
};
use crate::seal::of_whole;

/// Force and stiffness at the end of a course.
#[inline(always)]
pub(crate) fn response_at(contact: &Contact, origin: f64, course: &Course, displacement: f64) -> Response {
    let limit = contact.slip_force;
    if contact.is_frictionless() {
        return Response { force: 0.0, stiffness: 0.0 };
    }
    if course.slides {
        return Response { force: course.direction * limit, stiffness: 0.0 };
    }
    let from = course.branch.unwrap_or(Reversal { displacement: origin, force: 0.0 });
    let halves = if course.branch.is_some() { 2.0 } else { 1.0 };
    // A way that reaches gross slip only by rounding ends where that begins.
    let way = ((displacement - from.displacement).abs() / halves).min(contact.slip_displacement);
    let Response { force, stiffness } = contact.response(way);
    let force = from.force + course.direction * halves * force;
    Response { force: force.max(-limit).min(limit), stiffness }
}

/// Sums the energy of stretches: one monotonic loading dissipates a quarter of its cycle's energy, one branch twice that
/// of its half. Stretches that follow each other on one branch are one stretch, and only its ends are looked at.
#[derive(Debug)]
pub(crate) struct Dissipation<'a> {
    contact: &'a Contact,
    sum: f64,
    open: Stretch,
}

impl<'a> Dissipation<'a> {
    pub fn new(contact: &'a Contact) -> Dissipation<'a> {
        Dissipation { contact, sum: 0.0, open: Stretch { halves: 0.0, from: 0.0, to: 0.0, slipped: 0.0 } }
    }

    pub fn add(&mut self, stretch: &Stretch) {
        if stretch.halves == self.open.halves && stretch.from == self.open.to {
            self.open.to = stretch.to;
            self.open.slipped += stretch.slipped;
        } else {
            self.close();
            self.open = *stretch;
        }
    }

    /// Takes the open stretch into the sum.
    fn close(&mut self) {
        let contact = self.contact;
        let Stretch { halves, from, to, slipped } = self.open;
        let energy = |way: f64| {
            if way <= 0.0 {
                0.0
            } else if way >= contact.slip_displacement {
                contact.slip_energy
            } else {
                contact.cycle_energy(way).0
            }
        };
        if to > from {
            self.sum += 0.25 * halves * (energy(to) - energy(from)).max(0.0);
        }
        self.sum += contact.slip_force * slipped;
    }

    /// The energy \[J\] of all stretches.
    pub fn total(mut self) -> f64 {
        self.close();
        self.sum
    }
}

/// The course of a step that the state has room for.
#[inline(always)]
fn admitted_course(contact: &Contact, state: &State, displacement: f64) -> Result<Course, Error> {
    check_displacement(displacement)?;
    let course = course(contact, state, displacement);
    if course.depth > state.capacity { Err(Error::StateFull) } else { Ok(course) }
}

/// A step that was found and may be written.
#[derive(Debug, Clone, Copy)]
pub struct Step<'a> {
    contact: &'a Contact,
    course: Course,
    virgin: Virgin,
    start: Reversal,
    end: Reversal,
    stiffness: f64,
}

/// Finds the step of a contact from a state to a displacement \[m\].
///
/// # Errors
/// `BadState`, `StateTooShort`, `BadDisplacement`; `StateFull` where a further reversal would have to be remembered than
/// the state holds.
#[inline(always)]
pub fn step<'a>(contact: &'a Contact, state: &[f64], displacement: f64) -> Result<Step<'a>, Error> {
    let state = State::read(state)?;
    let course = admitted_course(contact, &state, displacement)?;
    Ok(Step::along(contact, &state, course, displacement))
}

/// Whether [`step`] would find a step, without finding its force.
///
/// # Errors
/// Those of [`step`].
#[inline(never)]
pub fn check_step(contact: &Contact, state: &[f64], displacement: f64) -> Result<(), Error> {
    admitted_course(contact, &State::read(state)?, displacement).map(|_| ())
}

impl<'a> Step<'a> {
    #[inline(always)]
    fn along(contact: &'a Contact, state: &State, course: Course, displacement: f64) -> Step<'a> {
        let start = state.now;
        let Response { force, stiffness } = response_at(contact, state.virgin.origin, &course, displacement);
        let virgin = state.virgin.after(contact, &course, displacement);
        Step { contact, course, virgin, start, end: Reversal { displacement, force }, stiffness }
    }

    /// Tangential force \[N\] after the step.
    #[must_use]
    pub fn force(&self) -> f64 {
        self.end.force
    }

    /// dT/d(displacement) \[N/m\] on the branch on which the step ends; 0 in gross slip.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// Energy \[J\] dissipated by the step, not negative; `state` is the one from which it was found.
    ///
    /// # Errors
    /// `BadState`, `StateTooShort`: those of [`step`].
    pub fn dissipated(&self, state: &[f64]) -> Result<f64, Error> {
        Ok(dissipation(self.contact, &State::read(state)?, self.end.displacement))
    }

    /// Writes the step into the state it was found from, or into a copy of it.
    #[inline(always)]
    pub fn write(&self, state: &mut [f64]) {
        let &mut [
            ref mut seal,
            ref mut count,
            ref mut displacement,
            ref mut slid,
            ref mut force,
            ref mut origin,
            ref mut reversals @ ..,
        ] = state
        else {
            return;
        };
        // Before the newest reversal is written: reading at once what was just written makes the processor wait.
        let newest = self.course.turned.then_some([self.start.displacement, self.start.force]);
        let kept = PER_REVERSAL * self.course.depth.saturating_sub(usize::from(self.course.turned));
        let used = reversals.iter().copied().take(kept).chain(newest.into_iter().flatten());
        let header =
            [of_whole(self.course.depth), self.end.displacement, self.virgin.slid, self.end.force, self.virgin.origin];
        *seal = seal_of(header, used);
        [*count, *displacement, *slid, *force, *origin] = header;
        if let Some(newest) = newest
            && let Some(place) = reversals.as_chunks_mut().0.get_mut(self.course.depth.wrapping_sub(1))
        {
            *place = newest;
        }
    }
}

/// Reversals that a copy of a state holds at most.
const REVERSALS_OF_COPY: usize = 2048;

/// Walks in a copy of a state, which leaves no trace.
///
/// # Errors
/// `BadState`, `StateTooShort`; `StateFull` for a state that nests more reversals than the copy holds; those of the walk.
pub fn in_copy(state: &[f64], walk: impl FnOnce(&mut [f64]) -> Result<(), Error>) -> Result<(), Error> {
    if State::read(state)?.depth() > REVERSALS_OF_COPY { Err(Error::StateFull) } else { in_copy_of_valid(state, walk) }
}

/// The copy lies on the stack, by far the largest piece there. It is not inlined, so that only walks which need it pay; and it
/// has nothing before the copy: where a large frame is not made at a function's entry, LLVM overwrites a register in use.
#[inline(never)]
#[expect(clippy::large_stack_arrays, reason = "there is no heap")]
fn in_copy_of_valid(state: &[f64], walk: impl FnOnce(&mut [f64]) -> Result<(), Error>) -> Result<(), Error> {
    let mut memory = [0.0; state_length(REVERSALS_OF_COPY)];
    memory.iter_mut().zip(state).for_each(|(copy, value)| *copy = *value);
    let used = state.len().min(memory.len());
    walk(memory.get_mut(..used).unwrap_or(&mut []))
}

/// Whether a state has room for a path whatever it closes: for all of its turns.
///
/// # Errors
/// `BadState`, `StateTooShort`, `BadDisplacement`.
fn has_room(state: &[f64], path: &[f64]) -> Result<bool, Error> {
    let read = State::read(state)?;
    let (mut turns, mut last, mut falls) = (1, read.now.displacement, false);
    for &displacement in path {
        check_displacement(displacement)?;
        turns += usize::from((displacement < last) != falls);
        falls = displacement < last;
        last = displacement;
    }
    Ok(read.depth().saturating_add(turns) <= read.capacity)
}

/// Walks a path without forces: the memory needs displacements only.
fn walk_dry(contact: &Contact, state: &mut [f64], path: &[f64]) -> Result<(), Error> {
    let mut dry = Track::start(state)?;
    for &displacement in path {
        let course = admitted_course(contact, &dry.state(), displacement)?;
        let virgin = dry.state().virgin.after(contact, &course, displacement);
        dry.go(&course, virgin, Reversal { displacement, force: 0.0 });
    }
    Ok(())
}

/// Whether a state can take a whole path, found before anything is written.
///
/// # Errors
/// `BadState`, `StateTooShort`, `BadDisplacement`; `StateFull` where the path nests more reversals than the state holds. A
/// path that turns more often than there is room is walked without forces [`in_copy`], which must hold it too.
pub fn check_path(contact: &Contact, state: &[f64], path: &[f64]) -> Result<(), Error> {
    if has_room(state, path)? { Ok(()) } else { in_copy(state, |copy| walk_dry(contact, copy, path)) }
}

/// [`check_path`] in a copy that may be spoilt.
///
/// # Errors
/// Those of [`check_path`].
pub fn check_path_in(contact: &Contact, copy: &mut [f64], path: &[f64]) -> Result<(), Error> {
    if has_room(copy, path)? { Ok(()) } else { walk_dry(contact, copy, path) }
}

/// Where the numbers of each step of a path go; `None` is not computed.
#[derive(Debug)]
pub struct PathOutput<'a> {
    /// Force \[N\] after each step.
    pub force: Option<&'a mut [f64]>,
    /// Tangent stiffness \[N/m\].
    pub stiffness: Option<&'a mut [f64]>,
    /// Energy \[J\] dissipated by each step.
    pub dissipated: Option<&'a mut [f64]>,
}

/// Leads a state through a path that it has room for. Where nothing of each step is wanted, forces are found where the path
/// turns, which is where they are remembered, and at its end.
///
/// # Errors
/// Those of [`step`].
#[inline(always)]
pub fn lead(contact: &Contact, state: &mut [f64], path: &[f64], output: PathOutput) -> Result<(), Error> {
    let PathOutput { mut force, mut stiffness, mut dissipated } = output;
    let (silent, mut track) = (force.is_none() && stiffness.is_none(), Track::start(state)?);
    for (i, &displacement) in path.iter().enumerate() {
        let state = track.state();
        let course = admitted_course(contact, &state, displacement)?;
        let (virgin, last) = (state.virgin.after(contact, &course, displacement), state.now.displacement);
        if let Some(place) = dissipated.as_mut().and_then(|dissipated| dissipated.get_mut(i)) {
            *place = dissipation(contact, &state, displacement);
        }
        // Neither turning here nor before: the next step goes on where this one goes.
        let goes_on = path.get(i + 1).is_some_and(|next| (next - displacement) * (displacement - last) > 0.0);
        let mut response = Response { force: 0.0, stiffness: 0.0 };
        if !(silent && goes_on) {
            response = response_at(contact, state.virgin.origin, &course, displacement);
        }
        for (output, value) in [(&mut force, response.force), (&mut stiffness, response.stiffness)] {
            if let Some(place) = output.as_mut().and_then(|output| output.get_mut(i)) {
                *place = value;
            }
        }
        track.go(&course, virgin, Reversal { displacement, force: response.force });
    }
    track.finish();
    Ok(())
}

/// Energy \[J\] dissipated on the way to a displacement.
fn dissipation(contact: &Contact, state: &State, displacement: f64) -> f64 {
    if contact.is_frictionless() || displacement == state.now.displacement {
        return 0.0;
    }
    let mut dissipation = Dissipation::new(contact);
    follow(state, contact.slip_displacement, displacement, |stretch| dissipation.add(&stretch));
    dissipation.total()
}

/// Shear traction \[Pa\] at x \[m\] after any history: the traction of the first loading, and twice that of half of each
/// reversal's jump of force (Eq. 21 with Masing's rule).
///
/// # Errors
/// `BadState`, `StateTooShort`; `ForceExceedsSlip` for a state of another contact. Nothing is written then.
pub fn shear_after(contact: &Contact, state: &[f64], x: &[f64], shear: &mut [f64]) -> Result<(), Error> {
    let state = State::read(state)?;
    let forces = || state.history().map(|reversal| reversal.force).chain([state.now.force]);
    forces().try_for_each(|force| contact.check_force(force))?;
    shear.fill(0.0);
    let mut before = None;
    for force in forces() {
        let (times, jump) = before.map_or((1.0, force), |before: f64| (2.0, 0.5 * (force - before)));
        let point = contact.curve_at_force(jump)?;
        shear.iter_mut().zip(x).for_each(|(shear, &x)| *shear += times * point.shear(x));
        before = Some(force);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::tests::{FLATS, contact, ellipse, parameters};
    use crate::memory::{HEADER, state_init};
    use crate::parameters::Parameters;
    use std::vec;
    use std::vec::Vec;

    fn virgin(reversals: usize) -> Vec<f64> {
        let mut state = vec![0.0; state_length(reversals)];
        state_init(&mut state).unwrap();
        state
    }

    /// Leads a state to displacements over that of gross slip; the force at the end.
    fn lead(contact: &Contact, state: &mut [f64], path: &[f64]) -> f64 {
        let mut force = f64::NAN;
        for displacement in path {
            let step = step(contact, state, displacement * contact.slip_displacement).unwrap();
            step.write(state);
            force = step.force();
        }
        force
    }

    fn on_curve(contact: &Contact, displacement: f64) -> f64 {
        contact.curve_at_displacement(displacement * contact.slip_displacement).unwrap().force()
    }

    /// Numbers from -1 to 1 without a pattern, the same every time.
    fn scattered(count: usize, seed: u64) -> impl Iterator<Item = f64> {
        let mut bits = seed;
        (0..count).map(move |_| {
            bits = bits.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (bits >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        })
    }

    #[test]
    fn memory_that_is_no_state_is_refused() {
        let contact = contact(50e-6);
        let mut good = virgin(3);
        lead(&contact, &mut good, &[0.5, -0.2, 0.1]);
        assert_eq!(good.get(1), Some(&2.0));
        let refuses = |state: &[f64], error: Error| {
            assert_eq!(step(&contact, state, 0.0).map(|_| ()), Err(error));
            assert_eq!(check_step(&contact, state, 0.0), Err(error));
            assert_eq!(check_path(&contact, state, &[0.0]), Err(error));
            assert_eq!(shear_after(&contact, state, &[0.0], &mut [0.0]), Err(error));
        };
        for (place, value) in [
            (0, 0.0),
            (0, f64::NAN),
            (1, f64::NAN),
            (1, 1.5),
            (1, -1.0),
            (1, 4.0),
            (1, 1e300),
            (2, f64::NAN),
            (3, 0.5),
            (4, f64::INFINITY),
            (5, f64::NAN),
            (6, f64::NAN),
            (9, f64::NEG_INFINITY),
        ] {
            let mut bad = good.clone();
            bad[place] = value;
            refuses(&bad, Error::BadState);
        }
        for (place, bit) in (0..HEADER + 4).flat_map(|place| (0..64).map(move |bit| (place, bit))) {
            let mut bad = good.clone();
            bad[place] = f64::from_bits(bad[place].to_bits() ^ (1 << bit));
            refuses(&bad, Error::BadState);
        }
        refuses(good.get(..HEADER - 1).unwrap(), Error::StateTooShort);
        // One that was cut holds fewer reversals than it says; what lies beyond them is not read.
        refuses(good.get(..HEADER + 2).unwrap(), Error::BadState);
        good[10] = f64::NAN;
        assert!(step(&contact, &good, 0.0).is_ok());
        assert_eq!(state_init(&mut [0.0; HEADER - 1]), Err(Error::StateTooShort));
        assert_eq!(step(&contact, &good, f64::NAN).map(|_| ()), Err(Error::BadDisplacement));
    }

    #[test]
    fn a_full_state_refuses_the_step_and_goes_on_with_others() {
        let contact = contact(50e-6);
        let mut state = virgin(2);
        lead(&contact, &mut state, &[0.6, -0.4, 0.3]);
        let before = state.clone();
        let slip = contact.slip_displacement;
        assert_eq!(step(&contact, &state, 0.1 * slip).map(|_| ()), Err(Error::StateFull));
        assert_eq!(check_step(&contact, &state, 0.1 * slip), Err(Error::StateFull));
        assert_eq!(state, before);
        // Forth there is room, and beyond the reversal at 0.6 the loops are forgotten.
        lead(&contact, &mut state, &[0.4]);
        assert_eq!(state.get(1), Some(&2.0));
        assert_eq!(lead(&contact, &mut state, &[0.7]), on_curve(&contact, 0.7));
        assert_eq!(state.get(1), Some(&0.0));
        // A state of no reversals follows the virgin curve, and slides.
        let mut none = virgin(0);
        lead(&contact, &mut none, &[0.2, 0.9, 3.0]);
        assert_eq!(check_step(&contact, &none, 2.5 * slip), Err(Error::StateFull));
        // Back by more than two slip displacements nothing is left to remember.
        assert_eq!(check_step(&contact, &none, 0.9 * slip), Ok(()));
    }

    #[test]
    fn the_mirror_of_the_first_reversal_leads_back_to_the_virgin_curve() {
        for flat in FLATS {
            let contact = contact(flat);
            for beyond in [0.5, 0.500001, 0.7, 0.999] {
                let mut state = virgin(8);
                let force = lead(&contact, &mut state, &[0.5, -0.1, 0.3, 0.2, -beyond]);
                // At the mirror point itself the closed branch is the virgin curve, too.
                assert!((force + on_curve(&contact, beyond)).abs() <= 4e-16 * contact.slip_force, "{flat} {beyond}");
                assert_eq!((state[1], state[5]), (0.0, 0.0));
            }
        }
    }

    #[test]
    fn gross_slip_forgets_everything() {
        for contact in FLATS.map(contact).into_iter().chain([ellipse(1e-4, 2e-4)]) {
            let (mut rich, mut poor) = (virgin(64), virgin(64));
            lead(&contact, &mut rich, &[0.5, -0.3, 0.9, -0.8, 0.1, 0.0, 0.05]);
            for state in [&mut rich, &mut poor] {
                assert_eq!(lead(&contact, state, &[2.5]), contact.slip_force);
            }
            assert_eq!(rich.get(..HEADER), poor.get(..HEADER));
            for path in [&[2.4][..], &[1.0, 1.3], &[-0.4], &[0.6]] {
                let [one, two] = [&mut rich, &mut poor].map(|state| lead(&contact, state, path));
                assert_eq!(one, two);
            }
            // From the end of a slip the way back is twice the curve, and slides again after twice its length.
            let mut state = virgin(2);
            let back = lead(&contact, &mut state, &[2.5, 2.5 - 1.2]);
            let expected = contact.slip_force - 2.0 * on_curve(&contact, 0.6);
            assert!((back - expected).abs() <= 4e-15 * contact.slip_force);
            assert_eq!(lead(&contact, &mut state, &[0.499]), -contact.slip_force);
        }
    }

    #[test]
    fn a_step_of_zero_changes_nothing() {
        let contact = contact(1e-6);
        let mut state = virgin(64);
        for (number, displacement) in scattered(200, 3).enumerate() {
            // Up to gross slip and beyond, from the virgin state on.
            let target = if number == 0 { 0.0 } else { 1.6 * displacement * contact.slip_displacement };
            let first = step(&contact, &state, target).unwrap();
            first.write(&mut state);
            let again = step(&contact, &state, target).unwrap();
            assert_eq!(again.dissipated(&state), Ok(0.0));
            assert_eq!((again.force(), again.stiffness()), (first.force(), first.stiffness()), "{number}");
            let before = state.clone();
            again.write(&mut state);
            assert_eq!(state, before);
        }
    }

    #[test]
    fn a_path_is_refused_where_its_steps_are() {
        let contact = contact(50e-6);
        let slip = contact.slip_displacement;
        let (mut fits, mut full) = (0, 0);
        for seed in 0..300 {
            let capacity = seed as usize % 7;
            // Spirals nest as deep as they are long; sometimes beyond gross slip.
            let width = |k: usize| 1.3 * 0.8f64.powi(k as i32 % 9);
            let path: Vec<f64> = scattered(24, seed).enumerate().map(|(k, x)| x * width(k) * slip).collect();
            let mut state = virgin(capacity);
            for start in [0, 8] {
                // The second part starts from what the first one left.
                let part = path.get(start..start + 8).unwrap();
                let mut walked = state.clone();
                let one_by_one = part.iter().try_for_each(|&displacement| {
                    step(&contact, &walked, displacement).map(|step| step.write(&mut walked))
                });
                assert_eq!(check_path(&contact, &state, part), one_by_one, "{seed} {start}");
                match one_by_one {
                    Ok(()) => fits += 1,
                    Err(_) => full += 1,
                }
                state = walked;
            }
        }
        assert!(fits > 50 && full > 50, "{fits} {full}");
        assert_eq!(check_path(&contact, &virgin(2), &[0.0, f64::NAN]), Err(Error::BadDisplacement));
    }

    #[test]
    fn a_deep_spiral_fits_as_far_as_the_state_goes() {
        let contact = contact(0.0);
        let spiral: Vec<f64> = (0..400)
            .map(|k| (if k % 2 == 0 { 0.9 } else { -0.9 }) * (1.0 - k as f64 / 401.0) * contact.slip_displacement)
            .collect();
        assert_eq!(check_path(&contact, &virgin(399), &spiral), Ok(()));
        assert_eq!(check_path(&contact, &virgin(398), &spiral), Err(Error::StateFull));
        // Unwound at once.
        let mut state = virgin(399);
        spiral.iter().for_each(|&displacement| step(&contact, &state, displacement).unwrap().write(&mut state));
        assert_eq!(lead(&contact, &mut state, &[0.95]), on_curve(&contact, 0.95));
        assert_eq!(state[1], 0.0);
    }

    #[test]
    fn a_closed_loop_dissipates_the_energy_of_its_amplitude() {
        for contact in FLATS.map(contact).into_iter().chain([ellipse(1e-4, 2e-4)]) {
            for amplitude in [0.01, 0.3, 0.8, 0.9999] {
                let mut state = virgin(4);
                let force = lead(&contact, &mut state, &[amplitude]);
                let mut sum = 0.0;
                for target in [-0.3 * amplitude, -amplitude, amplitude] {
                    let step = step(&contact, &state, target * contact.slip_displacement).unwrap();
                    sum += step.dissipated(&state).unwrap();
                    step.write(&mut state);
                }
                let expected = contact.dissipated_energy(force).unwrap();
                // Near gross slip the rounding of the force itself, a unit in 1e-4 of mu N, is worth the most.
                assert!((sum / expected - 1.0).abs() < 1e-13, "{amplitude} {sum} {expected}");
                // A small loop within, on the way: the same energy wherever it hangs, to the rounding of its place.
                lead(&contact, &mut state, &[0.0, -0.2 * amplitude]);
                let part = 0.1 * amplitude;
                let mut inner = 0.0;
                for target in [part - 0.2 * amplitude, -0.2 * amplitude] {
                    let step = step(&contact, &state, target * contact.slip_displacement).unwrap();
                    inner += step.dissipated(&state).unwrap();
                    step.write(&mut state);
                }
                let alone = contact.dissipated_energy(on_curve(&contact, 0.5 * part)).unwrap();
                assert!((inner / alone - 1.0).abs() < 1e-13, "{amplitude} {inner} {alone}");
            }
        }
    }

    #[test]
    fn tractions_after_a_history_obey_coulomb_and_add_up_to_the_force() {
        let contact = contact(50e-6);
        let mut state = virgin(8);
        let force = lead(&contact, &mut state, &[0.9, -0.6, 0.4, -0.1, 0.2]);
        // Between the stick edges of all jumps of force, flat and edge, where the traction has its roots.
        let turns: Vec<f64> = State::read(&state).unwrap().history().map(|turn| turn.force).chain([force]).collect();
        let edge = |jump: f64| contact.curve_at_force(jump).unwrap().stick_half_width();
        let mut places: Vec<f64> = turns.windows(2).map(|pair| edge(0.5 * (pair[1] - pair[0]))).collect();
        assert_eq!(places.len(), 4);
        places.extend([0.0, 50e-6, contact.half_width, edge(turns[0])]);
        places.sort_by(f64::total_cmp);
        let mut sum = 0.0;
        for (from, to) in places.iter().zip(places.iter().skip(1)) {
            for node in &crate::quadrature::TANH_SINH {
                let x = from + (to - from) * node.from_0;
                let mut shear = [0.0];
                shear_after(&contact, &state, &[x], &mut shear).unwrap();
                let [shear] = shear;
                // Rounding of five terms.
                assert!(shear.abs() <= 0.4 * contact.pressure(x) * (1.0 + 1e-12));
                sum += 2.0 * 10e-3 * (to - from) * node.weight * shear;
            }
        }
        // The rule's nodes next to an edge are rounded to it.
        assert!((sum / force - 1.0).abs() < 1e-7, "{sum} {force}");
        // The force of a stronger contact.
        let stronger = Contact::rounded_flat(&Parameters { normal_force: 225.0, ..parameters(50e-6) }).unwrap();
        lead(&stronger, &mut state, &[-3.0]);
        assert_eq!(shear_after(&contact, &state, &[0.0], &mut [0.0]), Err(Error::ForceExceedsSlip));
    }

    /// So far in gross slip that the origin cannot be told from the displacement, the direction is still known.
    #[test]
    fn a_step_of_zero_far_in_gross_slip_changes_nothing() {
        let contact = contact(0.0);
        for displacement in [-1e17 * contact.slip_displacement, -1e150, 1e150] {
            let mut state = virgin(3);
            let forces = [(); 3].map(|()| {
                let step = step(&contact, &state, displacement).unwrap();
                step.write(&mut state);
                step.force()
            });
            assert_eq!(forces, [contact.slip_force.copysign(displacement); 3]);
        }
    }
}
