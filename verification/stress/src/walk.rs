//! A history, with checks on every step that every contact and every history must pass.

use crate::histories::divided;
use crate::library::{Answer, BRANCH_ROUNDING, Contact, State};
use crate::memory::{Memory, Point};
use crate::{Outcome, ensure};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use std::collections::VecDeque;

/// Steps that a failure shows.
const SHOWN: usize = 12;

pub struct Walk<'a> {
    contact: &'a Contact,
    pub memory: Memory,
    pub state: State,
    /// The negative of the history.
    mirrored: State,
    capacity: usize,
    pub now: Answer,
    recent: VecDeque<f64>,
    pub deepest: usize,
}

/// Expensive checks of a step.
#[derive(Debug, Clone, Copy, Default)]
pub struct Checks {
    /// The same displacement again.
    pub repeat: bool,
    /// The state is copied through the bytes of a file.
    pub restart: bool,
    /// The force by Masing's rule, and the same memory from an unloaded state by the shortest path.
    pub relive: bool,
    /// The same step in parts.
    pub divide: bool,
}

impl Checks {
    /// Each of them once in a while.
    pub fn now_and_then(rng: &mut ChaCha8Rng) -> Checks {
        let dice = rng.random::<u32>();
        Checks {
            repeat: dice & 7 == 0,
            restart: (dice >> 3) & 63 == 0,
            relive: (dice >> 9) & 63 == 0,
            divide: (dice >> 15) & 63 == 0,
        }
    }

    pub const ALL: Checks = Checks { repeat: true, restart: true, relive: true, divide: true };
}

impl<'a> Walk<'a> {
    /// A history that may nest the given number of reversals at first.
    pub fn new(contact: &'a Contact, capacity: usize) -> Walk<'a> {
        let state = State::new(capacity);
        Walk {
            contact,
            memory: Memory::new(contact.slip()),
            mirrored: state.clone(),
            state,
            capacity,
            now: Answer { force: 0.0, stiffness: contact.stiffness(), dissipated: 0.0 },
            recent: VecDeque::new(),
            deepest: 0,
        }
    }

    /// One step with its checks; a failure reports the history.
    pub fn step(&mut self, displacement: f64, checks: Checks, rng: &mut ChaCha8Rng) -> Outcome {
        if self.recent.len() == SHOWN {
            self.recent.pop_front();
        }
        self.recent.push_back(displacement);
        let path = self.memory.shortest_path();
        self.checked_step(displacement, checks, rng).map_err(|failure| {
            let recent = &self.recent;
            format!("{failure}\n  remembered before the step: {path:?}\n  last displacements: {recent:?}")
        })
    }

    fn checked_step(&mut self, displacement: f64, checks: Checks, rng: &mut ChaCha8Rng) -> Outcome {
        let contact = self.contact;
        let (before, was, depth) = (checks.divide.then(|| self.state.clone()), self.now, self.memory.depth());
        let from = self.memory.now().displacement;
        let answer = self.state.step(contact, displacement)?;
        let Answer { force, stiffness, dissipated } = answer;
        let limit = contact.limit();

        // Exactly, whatever rounding does: Coulomb's bound, and no energy gained.
        ensure!(force.abs() <= limit, "Coulomb's bound {limit:?} is exceeded: {force:?}");
        ensure!(dissipated >= 0.0 && dissipated.is_finite(), "dissipated {dissipated:?}");
        // The stiffness of a branch errs by as much as its curve.
        let stiffest = contact.stiffness() * (1.0 + 2e-15);
        ensure!(stiffness >= 0.0 && stiffness <= stiffest, "stiffness {stiffness:?}");

        // The memory.
        self.memory.visit(Point { displacement, force }, self.state.slips());
        self.deepest = self.deepest.max(self.memory.depth());
        ensure!(
            self.state.depth() == self.memory.depth(),
            "{} reversals are remembered, {} needed",
            self.state.depth(),
            self.memory.depth()
        );
        ensure!(self.state.displacement() == displacement, "the displacement is not kept");
        if self.state.slips() {
            ensure!(force == self.memory.slip_direction * limit, "gross slip with a force of {force:?}");
        }
        if let Some(old) = self.memory.returned {
            ensure!(force == old.force, "back at {displacement:?} the force is {force:?}, it was {:?}", old.force);
        }

        // The force follows the displacement, no steeper than at first. Rounding: of all branches before and after, and
        // of the displacements themselves at both ends.
        let way = (displacement - from).abs();
        let branches = (depth + self.memory.depth() + 2) as f64;
        let place = 4.0 * f64::EPSILON * (displacement.abs() + from.abs());
        let rounding = branches * BRANCH_ROUNDING * limit + (stiffest * place).min(2.0 * limit);
        let rise = (force - was.force) * if displacement < from { -1.0 } else { 1.0 };
        ensure!(rise >= -rounding, "the force goes against the displacement: {rise:?}");
        ensure!(rise <= stiffest * way + rounding, "the force jumps by {rise:?} on a way of {way:?}");
        // At most the energy of gross slip all the way.
        let energy_rounding = branches * BRANCH_ROUNDING * contact.slip_energy() + limit * place;
        ensure!(dissipated <= limit * way + energy_rounding, "dissipated {dissipated:?} on a way of {way:?}");

        // Odd symmetry, to the bit.
        let mirrored = self.mirrored.step(contact, -displacement)?;
        ensure!(
            mirrored == Answer { force: -force, ..answer } && self.state.is_mirror_of(&self.mirrored),
            "the mirrored history answers {mirrored:?}, not {answer:?}"
        );
        self.now = answer;

        if let Some(before) = before {
            self.divided(before, displacement, rng)?;
        }
        if checks.repeat {
            self.repeated()?;
        }
        if checks.relive {
            self.by_masings_rule()?;
            self.relived()?;
        }
        if checks.restart {
            let bytes: Vec<u8> = self.state.used().iter().flat_map(|value| value.to_le_bytes()).collect();
            self.capacity = self.memory.depth() + rng.random_range(1..=2 * self.capacity);
            let mut copy = State::new(self.capacity);
            for (place, bytes) in copy.0.iter_mut().zip(bytes.as_chunks().0) {
                *place = f64::from_le_bytes(*bytes);
            }
            self.state = copy;
        }
        // No reversal may be merged here.
        if self.memory.depth() + 1 >= self.capacity {
            self.capacity *= 2;
            self.state = self.state.moved(self.capacity);
        }
        if self.memory.depth() + 1 >= self.mirrored.capacity() {
            self.mirrored = self.mirrored.moved(2 * self.memory.depth() + 2);
        }
        Ok(())
    }

    /// The same displacement again changes nothing.
    fn repeated(&mut self) -> Outcome {
        let before = self.state.bits();
        let again = self.state.step(self.contact, self.state.displacement())?;
        let expected = Answer { dissipated: 0.0, ..self.now };
        ensure!(again == expected, "the same displacement again answers {again:?}, not {expected:?}");
        ensure!(self.state.bits() == before, "the same displacement again changes the state");
        Ok(())
    }

    /// Masing's rule as it is written: the monotonic curve to the first point, and twice the curve of half the way from each
    /// point to the next.
    fn by_masings_rule(&self) -> Outcome {
        let (contact, points) = (self.contact, &self.memory.points);
        let (mut force, mut stiffness) = match self.memory.slip_direction {
            0.0 => contact.monotonic(points[0].displacement)?,
            slip_direction => (slip_direction * contact.limit(), 0.0),
        };
        for ends in points.windows(2) {
            let half = 0.5 * (ends[1].displacement - ends[0].displacement);
            let (jump, tangent) = contact.monotonic(half.clamp(-contact.slip(), contact.slip()))?;
            (force, stiffness) = (force + 2.0 * jump, tangent);
        }
        // The same point of the same curve.
        ensure!(
            stiffness == self.now.stiffness,
            "the stiffness is {:?}, by Masing's rule {stiffness:?}",
            self.now.stiffness
        );
        // Both round. Ways that exceed gross slip by the rounding of displacements end there.
        let place = f64::EPSILON * points.iter().map(|point| point.displacement.abs()).fold(0.0, f64::max);
        let rounding = 2.0 * points.len() as f64 * BRANCH_ROUNDING * contact.limit() + contact.stiffness() * place;
        ensure!(
            (force - self.now.force).abs() <= rounding,
            "the force is {:?}, by Masing's rule {force:?}",
            self.now.force
        );
        Ok(())
    }

    /// The shortest path to the same memory leaves the same state, to the bit: of loops that closed and of steps that went on
    /// nothing is left.
    fn relived(&mut self) -> Outcome {
        let mut state = State::new(self.memory.depth());
        let mut answer = self.now;
        for displacement in self.memory.shortest_path() {
            answer = state.step(self.contact, displacement)?;
        }
        answer.dissipated = self.now.dissipated;
        ensure!(answer == self.now, "the shortest path answers {answer:?}, not {:?}", self.now);
        ensure!(
            state.bits() == self.state.bits(),
            "the shortest path leaves {:?}, not {:?}",
            state.used(),
            self.state.used()
        );
        Ok(())
    }

    /// A step in parts leads to the same state, to the bit, and dissipates the same.
    fn divided(&self, before: State, displacement: f64, rng: &mut ChaCha8Rng) -> Outcome {
        let (contact, from) = (self.contact, before.displacement());
        let parts = rng.random_range(2..40);
        let places = divided(from, displacement, parts, rng);
        let mut state = before.clone();
        let mut sum = 0.0;
        let mut answer = self.now;
        for place in places {
            answer = state.step(contact, place)?;
            sum += answer.dissipated;
        }
        let whole = self.now.dissipated;
        ensure!(
            answer == Answer { dissipated: answer.dissipated, ..self.now } && state.bits() == self.state.bits(),
            "in {parts} parts from {from:?} the step answers {answer:?} and leaves {:?}, not {:?}",
            state.used(),
            self.state.used()
        );
        // Each part is a difference of two energies of cycles that carry a rounding of their own.
        let limit = contact.limit();
        let scale = contact.slip_energy() + limit * (displacement - from).abs();
        let place = limit * f64::EPSILON * (displacement.abs() + from.abs());
        let bound = (parts + before.depth() + 2) as f64 * (BRANCH_ROUNDING * scale + place);
        ensure!((sum - whole).abs() <= bound, "in {parts} parts from {from:?} {sum:?} is dissipated, not {whole:?}");
        Ok(())
    }
}
