//! A history with checks on every step.

use crate::library::{BRANCH_ROUNDING, Contact, Response, State};
use crate::memory::{Memory, Point};
use crate::{Outcome, ensure};

/// Reversals that a state holds: none are merged.
const REVERSALS: usize = 1000;

pub struct CheckedHistory<'a> {
    contact: &'a Contact,
    pub memory: Memory,
    state: State,
    /// The state after the negative of the history.
    mirrored: State,
    pub now: Response,
}

impl<'a> CheckedHistory<'a> {
    /// From the unloaded state.
    pub fn new(contact: &'a Contact) -> CheckedHistory<'a> {
        let state = State::new(REVERSALS);
        let now = Response { force: 0.0, stiffness: contact.stiffness(), dissipated: 0.0 };
        CheckedHistory { contact, memory: Memory::new(contact.slip()), mirrored: state.clone(), state, now }
    }

    /// One step with its checks, also the expensive one if `thorough`; a failure reports the memory before.
    pub fn step(&mut self, displacement: f64, thorough: bool) -> Outcome {
        let before = self.memory.clone();
        self.checked_step(displacement, thorough).map_err(|failure| {
            format!("{failure}\n  path to the state before: {:?}\n  then: {displacement:?}", before.shortest_path())
        })
    }

    fn checked_step(&mut self, displacement: f64, thorough: bool) -> Outcome {
        let contact = self.contact;
        let depth = self.memory.depth();
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

        // At most the energy of gross slip over the whole step. Rounding: of all branches before and after, and of the
        // displacements at both ends.
        let distance = (displacement - from).abs();
        let branches = (depth + self.memory.depth() + 2) as f64;
        let place = 4.0 * f64::EPSILON * (displacement.abs() + from.abs());
        let energy_rounding = branches * BRANCH_ROUNDING * contact.slip_energy() + slip_force * place;
        ensure!(dissipated <= slip_force * distance + energy_rounding, "dissipated {dissipated:?} over {distance:?}");

        // Odd symmetry, to the bit.
        let mirrored = self.mirrored.step(contact, -displacement)?;
        ensure!(
            mirrored == Response { force: -force, ..response } && self.state.is_mirror_of(&self.mirrored),
            "the mirrored history gives {mirrored:?}, not {response:?}"
        );
        self.now = response;

        if thorough {
            self.by_shortest_path()?;
        }
        self.by_masings_rule()
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
    fn by_shortest_path(&self) -> Outcome {
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
}
