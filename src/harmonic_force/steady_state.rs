//! The way of a contact through the steady state of a periodic displacement, as both rules walk it: on which branch it is, and
//! the energy on the way.

use super::Wanted;
use crate::contact::Contact;
use crate::curve::{Responder, Response};
use crate::masing::Dissipation;
use crate::memory::{Reversal, Stretch, Virgin};

/// A branch of the walk: the virgin curve, one from a reversal, or gross slip.
#[derive(Debug, Clone, Copy)]
pub(super) struct Branch {
    /// Where it starts.
    pub from: Reversal,
    /// Direction +1 or -1, and the displacement at which it ends.
    pub direction: f64,
    pub end: f64,
    pub slides: bool,
    /// Two half-curves make a branch, one the virgin curve.
    pub halves: f64,
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
        slides: false,
        halves: 1.0,
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
                Branch { from, direction, end, slides: false, halves: 2.0, reversed: true }
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
    pub fn way(&self, slip_displacement: f64, displacement: f64) -> f64 {
        let way = (displacement - self.from.displacement).abs() / self.halves;
        // One that reaches gross slip only by rounding ends where that begins.
        if way > slip_displacement { slip_displacement } else { way }
    }

    #[inline(always)]
    pub fn responder<'c>(&self, contact: &'c Contact) -> BranchResponder<'c> {
        let towards = self.direction * self.halves;
        BranchResponder { branch: *self, towards, limit: contact.slip_force, curve: contact.responder() }
    }
}

/// Finds force and stiffness at displacements on a branch that does not slide.
#[derive(Debug, Clone, Copy)]
pub(super) struct BranchResponder<'c> {
    branch: Branch,
    /// Its direction, and twice that for a whole branch.
    towards: f64,
    limit: f64,
    curve: Responder<'c>,
}

impl BranchResponder<'_> {
    #[inline(always)]
    pub fn at(&self, displacement: f64) -> Response {
        let BranchResponder { branch, towards, limit, curve } = self;
        let Response { force, stiffness } = curve.at(branch.way(curve.slip_displacement, displacement));
        let force = branch.from.force + towards * force;
        let force = if force > *limit { *limit } else { force };
        Response { force: if force < -limit { -limit } else { force }, stiffness }
    }
}

/// Where the walk is.
#[derive(Debug)]
pub(super) struct SteadyState<'c> {
    pub contact: &'c Contact,
    pub wanted: Wanted,
    /// Where the energy is wanted.
    pub energy: Option<Dissipation<'c>>,
    pub virgin: Virgin,
    /// How many reversals are remembered.
    pub depth: usize,
    pub branch: Branch,
}

impl<'c> SteadyState<'c> {
    pub fn new(contact: &'c Contact, wanted: Wanted, wants_energy: bool) -> SteadyState<'c> {
        SteadyState {
            contact,
            wanted,
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
        let slides = displacement.abs() > slip;
        self.branch = Branch { slides, ..Branch::newest(&[], 0, self.virgin.origin, direction, slip) };
        if slides {
            self.virgin = Virgin { origin: displacement - direction * slip, slid: direction };
        }
        self.response(displacement)
    }

    /// At a displacement on the branch.
    #[inline(always)]
    pub fn response(&self, displacement: f64) -> Response {
        if self.branch.slides {
            return Response { force: self.branch.direction * self.contact.slip_force, stiffness: 0.0 };
        }
        self.branch.responder(self.contact).at(displacement)
    }

    /// The energy of a stretch within the branch; gross slip carries the virgin curve along.
    #[inline(always)]
    pub fn account_for(&mut self, from: f64, to: f64) {
        let slip = self.contact.slip_displacement;
        let Branch { slides, direction, halves, .. } = self.branch;
        if slides {
            self.virgin = Virgin { origin: to - direction * slip, slid: direction };
        }
        if let Some(energy) = &mut self.energy {
            let way = |displacement: f64| self.branch.way(slip, displacement);
            energy.add(&if slides {
                Stretch { halves: 1.0, from: 0.0, to: 0.0, slipped: (to - from).abs() }
            } else {
                Stretch { halves, from: way(from), to: way(to), slipped: 0.0 }
            });
        }
    }

    /// The energy \[J\] of the period, of which all or `mirrored` a half was walked.
    #[inline(always)]
    pub fn energy_of_period(self, mirrored: bool) -> Option<f64> {
        self.energy.map(|energy| if mirrored { 2.0 * energy.total() } else { energy.total() })
    }
}
