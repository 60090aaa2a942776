//! Steady state of a periodic displacement, as the quadrature rules of the harmonic balance advance along it.

use crate::constant_load::contact::Contact;
use crate::constant_load::energy::Dissipation;
use crate::constant_load::masing::BranchEvaluator;
use crate::constant_load::memory::{Branch, InitialCurve, Memory, push};
use crate::constant_load::sensitivity::{Sensitivity, times};
use crate::law::{BranchRange, Law, Point, Response, Reversal};

/// A contact with friction under a constant normal force in the steady state of a periodic displacement.
#[derive(Debug)]
pub(crate) struct SteadyState<'c, 's> {
    contact: &'c Contact,
    energy: Option<Dissipation<'c>>,
    initial: InitialCurve,
    branch: Branch,
    /// The stack of reversals; the first `depth` of them are used.
    reversals: &'s mut [Reversal],
    depth: usize,
}

impl<'c, 's> SteadyState<'c, 's> {
    #[inline(always)]
    pub fn new(contact: &'c Contact, reversals: &'s mut [Reversal], with_energy: bool) -> SteadyState<'c, 's> {
        let energy = with_energy.then(|| Dissipation::new(contact));
        let branch = Memory::UNLOADED.branch(contact, 0, 1.0);
        SteadyState { contact, energy, initial: InitialCurve::UNLOADED, branch, reversals, depth: 0 }
    }

    /// The branch that follows the present one at its end.
    #[inline(always)]
    fn continuation(&self) -> Branch {
        self.memory(self.branch.start).continuation(self.contact, &self.branch)
    }

    /// The memory with the present point at `now`.
    #[inline(always)]
    fn memory(&self, now: Point) -> Memory<'_> {
        Memory { initial: self.initial, now, reversals: self.reversals.get(..self.depth).unwrap_or(&[]) }
    }
}

impl<'c> Law for SteadyState<'c, '_> {
    type Evaluator = BranchEvaluator<'c>;

    #[inline(always)]
    fn begin(&mut self, displacement: f64) -> Response {
        let direction = if displacement < 0.0 { -1.0 } else { 1.0 };
        let initial_curve = self.memory(Point { displacement, force: 0.0 }).branch(self.contact, 0, direction);
        let gross_slip = displacement.abs() > self.contact.slip_displacement;
        self.branch = Branch { gross_slip, ..initial_curve };
        self.initial = self.initial.after_friction(self.contact, &self.branch, displacement);
        self.response(displacement)
    }

    #[inline(always)]
    fn branch(&self) -> BranchRange {
        let Branch { depth, direction, end, gross_slip, .. } = self.branch;
        BranchRange { depth, direction, end: if gross_slip { direction * f64::INFINITY } else { end }, gross_slip }
    }

    #[inline(always)]
    fn evaluator(&self) -> BranchEvaluator<'c> {
        self.branch.evaluator(self.contact)
    }

    #[inline(always)]
    fn response(&self, displacement: f64) -> Response {
        self.branch.response(self.contact, displacement)
    }

    fn sensitivity(&self, displacement: f64) -> Sensitivity {
        let Branch { direction, scale, gross_slip, .. } = self.branch;
        if gross_slip || self.contact.is_frictionless() {
            return times(direction, self.contact.slip_sensitivity());
        }
        let distance = self.branch.distance(self.contact.slip_displacement, displacement);
        times(direction * scale, self.contact.sensitivity(distance))
    }

    #[inline(always)]
    fn advance(&mut self, from: Point, displacement: f64) -> bool {
        let energy = &mut self.energy;
        let reversals = self.reversals.get(..self.depth).unwrap_or(&[]);
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
        self.initial = self.initial.after_friction(self.contact, &self.branch, displacement);
        transition.reversed
    }

    #[inline(always)]
    fn reverse(&mut self, at: Point, direction: f64) -> bool {
        let has_room = self.depth < self.reversals.len();
        if has_room {
            (self.depth, _) = push(self.contact, self.initial.offset, self.reversals, self.depth, at);
            self.branch = self.memory(at).branch(self.contact, self.depth, direction);
        }
        has_room
    }

    #[inline(always)]
    fn ends_in_gross_slip(&self) -> bool {
        self.continuation().gross_slip
    }

    #[inline(always)]
    fn pass_end(&mut self) {
        self.branch = self.continuation();
        self.depth = self.branch.depth;
    }

    #[inline(always)]
    fn account_for(&mut self, from: f64, to: f64) {
        self.initial = self.initial.after_friction(self.contact, &self.branch, to);
        if let Some(energy) = &mut self.energy {
            energy.add(self.branch.segment(self.contact.slip_displacement, from, to));
        }
    }

    fn dissipated(self) -> Option<f64> {
        self.energy.map(Dissipation::total)
    }
}
