//! The way of a contact through the steady state of a periodic displacement, as both rules walk it: on which branch it is, and
//! the energy on the way.

use super::Requested;
use crate::constant_load::contact::Contact;
use crate::constant_load::curve::{CurveEvaluator, Response};
use crate::constant_load::masing::Dissipation;
use crate::constant_load::memory::{Reversal, Segment, Virgin};

/// A branch of the walk: the virgin curve, one from a reversal, or gross slip.
#[derive(Debug, Clone, Copy)]
pub(super) struct Branch {
    /// Where it starts.
    pub from: Reversal,
    /// Direction +1 or -1, and the displacement at which it ends.
    pub direction: f64,
    pub end: f64,
    pub gross_slip: bool,
    /// Two half-curves make a branch, one the virgin curve.
    pub masing_scale: f64,
    /// Whether it starts at a reversal.
    pub reversed: bool,
}

impl Branch {
    pub const VIRGIN: Branch = Branch {
        // No force; with this sign a vector of both is no extension by zero, for which compilers have an instruction that
        // valgrind does not know.
        from: Reversal { displacement: 0.0, force: -0.0 },
        direction: 1.0,
        end: 0.0,
        gross_slip: false,
        masing_scale: 1.0,
        reversed: false,
    };

    /// The branch from the newest of so many reversals, or the virgin curve.
    #[inline(always)]
    pub fn newest(reversals: &[f64], depth: usize, origin: f64, direction: f64, slip_displacement: f64) -> Branch {
        let reversal = |depth: usize| reversals.as_chunks::<2>().0.get(depth.wrapping_sub(1));
        match reversal(depth) {
            Some(&[displacement, force]) => {
                let older = reversal(depth.wrapping_sub(1));
                let end = older.map_or(2.0 * origin - displacement, |[older, _]| *older);
                let from = Reversal { displacement, force };
                Branch { from, direction, end, gross_slip: false, masing_scale: 2.0, reversed: true }
            }
            None => Branch {
                from: Reversal { displacement: origin, ..Branch::VIRGIN.from },
                direction,
                end: origin + direction * slip_displacement,
                ..Branch::VIRGIN
            },
        }
    }

    /// Where a displacement lies on the monotonic curve.
    #[inline(always)]
    pub fn half_range(&self, slip_displacement: f64, displacement: f64) -> f64 {
        let half_range = (displacement - self.from.displacement).abs() / self.masing_scale;
        // One that reaches gross slip only by rounding ends where that begins.
        if half_range > slip_displacement { slip_displacement } else { half_range }
    }

    #[inline(always)]
    pub fn evaluator<'c>(&self, contact: &'c Contact) -> BranchEvaluator<'c> {
        let towards = self.direction * self.masing_scale;
        BranchEvaluator { branch: *self, towards, limit: contact.slip_force, curve: contact.evaluator() }
    }
}

/// Finds force and stiffness at displacements on a branch that does not slide.
#[derive(Debug, Clone, Copy)]
pub(super) struct BranchEvaluator<'c> {
    branch: Branch,
    /// Its direction, and twice that for a whole branch.
    towards: f64,
    limit: f64,
    curve: CurveEvaluator<'c>,
}

impl BranchEvaluator<'_> {
    #[inline(always)]
    pub fn at(&self, displacement: f64) -> Response {
        let BranchEvaluator { branch, towards, limit, curve } = self;
        let Response { force, stiffness } = curve.at(branch.half_range(curve.slip_displacement, displacement));
        let force = branch.from.force + towards * force;
        let force = if force > *limit { *limit } else { force };
        Response { force: if force < -limit { -limit } else { force }, stiffness }
    }
}

/// Where the walk is.
#[derive(Debug)]
pub(super) struct SteadyState<'c> {
    pub contact: &'c Contact,
    pub requested: Requested,
    /// Where the energy is wanted.
    pub energy: Option<Dissipation<'c>>,
    pub virgin: Virgin,
    /// How many reversals are remembered.
    pub depth: usize,
    pub branch: Branch,
}

impl<'c> SteadyState<'c> {
    pub fn new(contact: &'c Contact, requested: Requested, wants_energy: bool) -> SteadyState<'c> {
        SteadyState {
            contact,
            requested,
            energy: wants_energy.then(|| Dissipation::new(contact)),
            virgin: Virgin::NEW,
            depth: 0,
            branch: Branch::VIRGIN,
        }
    }

    /// Enters the steady state on the virgin curve, at the displacement farthest from 0.
    #[inline(always)]
    pub fn begin(&mut self, displacement: f64) -> Response {
        let slip = self.contact.slip_displacement;
        let direction = if displacement < 0.0 { -1.0 } else { 1.0 };
        let gross_slip = displacement.abs() > slip;
        self.branch = Branch { gross_slip, ..Branch::newest(&[], 0, self.virgin.origin, direction, slip) };
        if gross_slip {
            self.virgin = Virgin { origin: displacement - direction * slip, slid: direction };
        }
        self.response(displacement)
    }

    /// At a displacement on the branch.
    #[inline(always)]
    pub fn response(&self, displacement: f64) -> Response {
        if self.branch.gross_slip {
            return Response { force: self.branch.direction * self.contact.slip_force, stiffness: 0.0 };
        }
        self.branch.evaluator(self.contact).at(displacement)
    }

    /// The energy of a stretch within the branch; gross slip carries the virgin curve along.
    #[inline(always)]
    pub fn account_for(&mut self, from: f64, to: f64) {
        let slip = self.contact.slip_displacement;
        let Branch { gross_slip, direction, masing_scale, .. } = self.branch;
        if gross_slip {
            self.virgin = Virgin { origin: to - direction * slip, slid: direction };
        }
        if let Some(energy) = &mut self.energy {
            let half_range = |displacement: f64| self.branch.half_range(slip, displacement);
            energy.add(&if gross_slip {
                Segment { masing_scale: 1.0, from: 0.0, to: 0.0, slipped: (to - from).abs() }
            } else {
                Segment { masing_scale, from: half_range(from), to: half_range(to), slipped: 0.0 }
            });
        }
    }

    /// The energy \[J\] of the period, of which all or `half_wave_symmetric` a half was walked.
    #[inline(always)]
    pub fn energy_of_period(self, half_wave_symmetric: bool) -> Option<f64> {
        self.energy.map(|energy| if half_wave_symmetric { 2.0 * energy.total() } else { energy.total() })
    }
}
