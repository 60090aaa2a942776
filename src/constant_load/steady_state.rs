//! Steady state of a periodic displacement, as the quadrature rules of the harmonic balance advance along it.

use crate::constant_load::contact::Contact;
use crate::constant_load::energy::Dissipation;
use crate::constant_load::evaluator::Response;
use crate::constant_load::memory::{Branch, InitialCurve, Memory, Point, Reversal, push};
use crate::numerics::slices::PanicFreeSlice;
use crate::parameters::{Sensitivity, times};

/// A contact with friction under a constant normal force in the steady state of a periodic displacement.
pub(crate) struct SteadyState<'c, 's> {
    pub contact: &'c Contact,
    energy: Option<Dissipation<'c>>,
    initial: InitialCurve,
    branch: Branch,
    /// The stack of reversals; the first `depth` of them are used.
    reversals: &'s mut [Reversal],
    depth: usize,
}

impl<'c, 's> SteadyState<'c, 's> {
    pub fn new(contact: &'c Contact, reversals: &'s mut [Reversal], with_energy: bool) -> SteadyState<'c, 's> {
        let energy = with_energy.then(|| Dissipation::new(contact));
        let branch = Memory::default().branch(contact, 0, 1.0);
        SteadyState { contact, energy, initial: InitialCurve::default(), branch, reversals, depth: 0 }
    }

    /// The branch that follows the present branch at its end.
    pub fn continuation(&self) -> Branch {
        self.memory(self.branch.start).continuation(self.contact, &self.branch)
    }

    /// The memory with the present point at `now`.
    fn memory(&self, now: Point) -> Memory<'_> {
        Memory { initial: self.initial, now, reversals: self.reversals.part(..self.depth) }
    }

    /// Enters the steady state, with an empty stack, at the displacement of largest magnitude.
    pub fn begin(&mut self, displacement: f64) -> Response {
        let direction = if displacement < 0.0 { -1.0 } else { 1.0 };
        self.branch = self.memory(self.branch.start).branch(self.contact, 0, direction);
        self.branch.gross_slip = displacement.abs() > self.contact.slip_displacement;
        self.initial = self.initial.after(self.contact, &self.branch, displacement);
        self.branch.response(self.contact, displacement)
    }

    /// The present branch; gross slip has no end.
    pub fn branch(&self) -> Branch {
        let Branch { direction, end, gross_slip, .. } = self.branch;
        Branch { end: if gross_slip { direction * f64::INFINITY } else { end }, ..self.branch }
    }

    /// Derivatives of the force at a displacement on the present branch, less those at the reversal that it leaves.
    pub fn sensitivity(&self, displacement: f64) -> Sensitivity {
        let Branch { direction, scale, gross_slip, .. } = self.branch;
        if gross_slip || self.contact.is_frictionless() {
            return times(direction, self.contact.slip_sensitivity());
        }
        let distance = self.branch.distance(self.contact.slip_displacement, displacement);
        times(direction * scale, self.contact.sensitivity(distance))
    }

    /// Applies a step from a point of the present branch, which may reverse, close loops and enter gross slip. Returns whether the
    /// point is now a reversal on the stack.
    pub fn advance(&mut self, from: Point, displacement: f64) -> bool {
        let energy = &mut self.energy;
        let reversals = self.reversals.part(..self.depth);
        let memory = Memory { initial: self.initial, now: from, reversals };
        let transition = memory.locate(self.contact, displacement, |segment| {
            if let Some(energy) = energy {
                energy.add(segment);
            }
        });
        self.branch = transition.branch;
        if transition.reversed {
            push(self.contact, self.initial.offset, self.reversals, self.depth, from);
        }
        self.depth = self.branch.depth;
        self.initial = self.initial.after(self.contact, &self.branch, displacement);
        transition.reversed
    }

    /// Pushes a point of the present branch as the newest reversal.
    pub fn reverse(&mut self, at: Point, direction: f64) {
        (self.depth, _) = push(self.contact, self.initial.offset, self.reversals, self.depth, at);
        self.branch = self.memory(at).branch(self.contact, self.depth, direction);
    }

    /// Enters the branch that follows at the end of the present one.
    pub fn enter(&mut self, continuation: Branch) {
        self.branch = continuation;
        self.depth = continuation.depth;
    }

    /// Adds the energy dissipated along the present branch and, in gross slip, moves the slider.
    pub fn account_for(&mut self, from: f64, to: f64) {
        self.initial = self.initial.after(self.contact, &self.branch, to);
        if let Some(energy) = &mut self.energy {
            energy.add(self.branch.segment(self.contact.slip_displacement, from, to));
        }
    }

    /// Energy \[J\] dissipated since `begin`, if requested.
    pub fn dissipated(self) -> Option<f64> {
        self.energy.map(Dissipation::total)
    }
}
