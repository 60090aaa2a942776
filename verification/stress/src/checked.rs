//! A history with checks on every step.

use crate::histories::divided;
use crate::library::{BRANCH_ROUNDING, Contact, Response, State};
use crate::memory::{Memory, Point};
use crate::{Outcome, ensure};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use std::collections::VecDeque;

/// Steps that a failure shows.
const SHOWN: usize = 12;

pub struct CheckedHistory<'a> {
    contact: &'a Contact,
    pub memory: Memory,
    pub state: State,
    /// The state after the negative of the history.
    mirrored: State,
    capacity: usize,
    pub now: Response,
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
    /// The force by Masing's rule, and the same state by the shortest path.
    pub by_definition: bool,
    /// The same step in parts.
    pub divide: bool,
}

impl Checks {
    /// Each of them from time to time.
    pub fn now_and_then(rng: &mut ChaCha8Rng) -> Checks {
        let bits = rng.random::<u32>();
        Checks {
            repeat: bits & 7 == 0,
            restart: (bits >> 3) & 63 == 0,
            by_definition: (bits >> 9) & 63 == 0,
            divide: (bits >> 15) & 63 == 0,
        }
    }

    pub const ALL: Checks = Checks { repeat: true, restart: true, by_definition: true, divide: true };
}

impl<'a> CheckedHistory<'a> {
    /// From the unloaded state, at first with room for the given number of reversals.
    pub fn new(contact: &'a Contact, capacity: usize) -> CheckedHistory<'a> {
        let state = State::new(capacity);
        CheckedHistory {
            contact,
            memory: Memory::new(contact.slip()),
            mirrored: state.clone(),
            state,
            capacity,
            now: Response { force: 0.0, stiffness: contact.stiffness(), dissipated: 0.0 },
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
            format!("{failure}\n  path to the state before: {path:?}\n  last displacements: {recent:?}")
        })
    }

    fn checked_step(&mut self, displacement: f64, checks: Checks, rng: &mut ChaCha8Rng) -> Outcome {
        let contact = self.contact;
        let (before, was, depth) = (checks.divide.then(|| self.state.clone()), self.now, self.memory.depth());
        let from = self.memory.now().displacement;
        let response = self.state.step(contact, displacement)?;
        let Response { force, stiffness, dissipated } = response;
        let slip_force = contact.slip_force();

        // Without rounding errors: Coulomb's bound, and no energy gained.
        ensure!(force.abs() <= slip_force, "Coulomb's bound {slip_force:?} is exceeded: {force:?}");
        ensure!(dissipated >= 0.0 && dissipated.is_finite(), "dissipated {dissipated:?}");
        // The stiffness of a branch has the error of its curve.
        let stiffest = contact.stiffness() * (1.0 + 2e-15);
        ensure!(stiffness >= 0.0 && stiffness <= stiffest, "stiffness {stiffness:?}");

        self.memory.visit(Point { displacement, force }, self.state.slips());
        self.deepest = self.deepest.max(self.memory.depth());
        ensure!(
            self.state.depth() == self.memory.depth(),
            "the state has {} reversals, by definition {}",
            self.state.depth(),
            self.memory.depth()
        );
        ensure!(self.state.displacement() == displacement, "the state has another displacement");
        if self.state.slips() {
            ensure!(force == self.memory.slip_direction * slip_force, "gross slip with a force of {force:?}");
        }
        if let Some(old) = self.memory.returned {
            ensure!(force == old.force, "back at {displacement:?} the force is {force:?}, before {:?}", old.force);
        }

        // The force increases with the displacement, with at most the initial stiffness. Rounding: of all branches before and
        // after, and of the displacements at both ends.
        let distance = (displacement - from).abs();
        let branches = (depth + self.memory.depth() + 2) as f64;
        let place = 4.0 * f64::EPSILON * (displacement.abs() + from.abs());
        let rounding = branches * BRANCH_ROUNDING * slip_force + (stiffest * place).min(2.0 * slip_force);
        let rise = (force - was.force) * if displacement < from { -1.0 } else { 1.0 };
        ensure!(rise >= -rounding, "the force decreases with the displacement: {rise:?}");
        ensure!(rise <= stiffest * distance + rounding, "the force changes by {rise:?} over {distance:?}");
        // At most the energy of gross slip over the whole step.
        let energy_rounding = branches * BRANCH_ROUNDING * contact.slip_energy() + slip_force * place;
        ensure!(dissipated <= slip_force * distance + energy_rounding, "dissipated {dissipated:?} over {distance:?}");

        // Odd symmetry, to the bit.
        let mirrored = self.mirrored.step(contact, -displacement)?;
        ensure!(
            mirrored == Response { force: -force, ..response } && self.state.is_mirror_of(&self.mirrored),
            "the mirrored history gives {mirrored:?}, not {response:?}"
        );
        self.now = response;

        if let Some(before) = before {
            self.divided(before, displacement, rng)?;
        }
        if checks.repeat {
            self.repeated()?;
        }
        if checks.by_definition {
            self.by_masings_rule()?;
            self.by_shortest_path()?;
        }
        if checks.restart {
            // Through the bytes of a file, into a state of another size.
            let bytes: Vec<u8> = self.state.used().iter().flat_map(|value| value.to_le_bytes()).collect();
            self.capacity = self.memory.depth() + rng.random_range(1..=2 * self.capacity);
            let mut copy = State::new(self.capacity);
            for (place, bytes) in copy.0.iter_mut().zip(bytes.as_chunks().0) {
                *place = f64::from_le_bytes(*bytes);
            }
            self.state = copy;
        }
        // Keep room, so that no reversal is merged.
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
        let expected = Response { dissipated: 0.0, ..self.now };
        ensure!(again == expected, "the same displacement again gives {again:?}, not {expected:?}");
        ensure!(self.state.bits() == before, "the same displacement again changes the state");
        Ok(())
    }

    /// Masing's rule: the monotonic curve to the first point, and twice the curve of half the distance from each point to the next.
    fn by_masings_rule(&self) -> Outcome {
        let (contact, points) = (self.contact, &self.memory.points);
        let (mut force, mut stiffness) = match self.memory.slip_direction {
            0.0 => contact.monotonic(points[0].displacement)?,
            slip_direction => (slip_direction * contact.slip_force(), 0.0),
        };
        for ends in points.windows(2) {
            let half = 0.5 * (ends[1].displacement - ends[0].displacement);
            let (jump, tangent) = contact.monotonic(half.clamp(-contact.slip(), contact.slip()))?;
            (force, stiffness) = (force + 2.0 * jump, tangent);
        }
        ensure!(
            stiffness == self.now.stiffness,
            "the stiffness is {:?}, by Masing's rule {stiffness:?}",
            self.now.stiffness
        );
        // Both round; displacements too.
        let place = f64::EPSILON * points.iter().map(|point| point.displacement.abs()).fold(0.0, f64::max);
        let rounding = 2.0 * points.len() as f64 * BRANCH_ROUNDING * contact.slip_force() + contact.stiffness() * place;
        ensure!(
            (force - self.now.force).abs() <= rounding,
            "the force is {:?}, by Masing's rule {force:?}",
            self.now.force
        );
        Ok(())
    }

    /// The shortest path to the same memory gives the same state, to the bit: closed loops leave no trace.
    fn by_shortest_path(&mut self) -> Outcome {
        let mut state = State::new(self.memory.depth());
        let mut response = self.now;
        for displacement in self.memory.shortest_path() {
            response = state.step(self.contact, displacement)?;
        }
        response.dissipated = self.now.dissipated;
        ensure!(response == self.now, "the shortest path gives {response:?}, not {:?}", self.now);
        ensure!(
            state.bits() == self.state.bits(),
            "the shortest path gives the state {:?}, not {:?}",
            state.used(),
            self.state.used()
        );
        Ok(())
    }

    /// A step in parts gives the same state, to the bit, and the same dissipated energy.
    fn divided(&self, before: State, displacement: f64, rng: &mut ChaCha8Rng) -> Outcome {
        let (contact, from) = (self.contact, before.displacement());
        let parts = rng.random_range(2..40);
        let places = divided(from, displacement, parts, rng);
        let mut state = before.clone();
        let mut sum = 0.0;
        let mut response = self.now;
        for place in places {
            response = state.step(contact, place)?;
            sum += response.dissipated;
        }
        let whole = self.now.dissipated;
        ensure!(
            response == Response { dissipated: response.dissipated, ..self.now } && state.bits() == self.state.bits(),
            "in {parts} parts from {from:?} the step gives {response:?} and the state {:?}, not {:?}",
            state.used(),
            self.state.used()
        );
        // Each part is a difference of two cycle energies, each with its own rounding.
        let slip_force = contact.slip_force();
        let scale = contact.slip_energy() + slip_force * (displacement - from).abs();
        let place = slip_force * f64::EPSILON * (displacement.abs() + from.abs());
        let bound = (parts + before.depth() + 2) as f64 * (BRANCH_ROUNDING * scale + place);
        ensure!((sum - whole).abs() <= bound, "in {parts} parts from {from:?} {sum:?} is dissipated, not {whole:?}");
        Ok(())
    }
}
