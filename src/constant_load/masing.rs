//! Masing's rule (Eq. 11, 12): force, tangent stiffness and dissipated energy along any history of displacements.
//!
//! A branch that leaves a reversal is the monotonic curve scaled by 2 and measured from its reversal: `|δ-δ_r| = 2 δ_m(|T-T_r|/2)`.

use crate::constant_load::ConstantLoad;
use crate::constant_load::contact::Contact;
use crate::constant_load::energy::Dissipation;
use crate::constant_load::evaluator::Response;
use crate::constant_load::harmonic_force::{HarmonicOutput, Workspace, harmonic_force};
use crate::constant_load::interpolant::piece_of;
use crate::constant_load::memory::{Branch, InitialCurve, Memory, Merge, Point, Transition, force_error, push, within};
use crate::constant_load::state::{self, HEADER, PER_REVERSAL};
use crate::error::Error;
use crate::law::{Law, LawStep, Requested, StepResult};
use crate::limits::{check_coefficients, check_displacement};
use crate::numerics::fp_class::is_finite;
use crate::numerics::lanes::Lanes;
use crate::numerics::slices::PanicFreeSlice;
use crate::tag::{Kind, is_count};

impl Branch {
    /// Force and stiffness at a displacement on the branch.
    pub fn response(&self, contact: &Contact, displacement: f64) -> Response {
        if self.gross_slip {
            return Response { force: self.direction * contact.slip_force, stiffness: 0.0 };
        }
        let distance = self.distance(contact.slip_displacement, displacement);
        let Response { force, stiffness } = contact.response(distance);
        let force = self.start.force + self.direction * self.scale * force;
        Response { force: within(contact.slip_force, force), stiffness }
    }

    /// Forces, and stiffnesses if requested, at `count` displacements in the order of the branch, which is not gross slip. Blocks
    /// of four values are read and written, beyond `count` too; the first two arrays are scratch memory.
    #[inline(never)]
    pub fn along<const STIFFNESS: bool>(
        &self,
        contact: &Contact,
        count: usize,
        displacement: &[f64],
        [distances, roots]: [&mut [f64]; 2],
        [forces, stiffnesses]: [&mut [f64]; 2],
    ) {
        let (slip, limit, factor) = (contact.slip_displacement, contact.slip_force, self.direction * self.scale);
        // Displacements behind the last of the branch may be in gross slip: they are limited to the distance of the last.
        let last = self.distance(slip, displacement.or_zero(count.saturating_sub(1)));
        let blocks = distances.blocks_mut().iter_mut().zip(roots.blocks_mut()).zip(displacement.blocks::<4>());
        for ((distances, roots), x) in blocks.take(count.div_ceil(4) + 1) {
            *distances = *Lanes(*x).map(|x| self.distance(last, x));
            *roots = *contact.roots(slip - Lanes(*distances));
        }
        let mut next = 0;
        while next < count
            && let (Some(&distances), Some(&roots)) =
                (distances.part(next..).first_chunk(), roots.part(next..).first_chunk())
            && let (Some(force), Some(stiffness)) =
                (forces.part_mut(next..).first_chunk_mut(), stiffnesses.part_mut(next..).first_chunk_mut())
        {
            let [piece, second, third, fourth] = roots.map(piece_of);
            let (distances, roots) = (Lanes(distances), Lanes(roots));
            let [on_curve, _, slopes] = contact.on_piece::<4, STIFFNESS>(piece, roots, distances, slip - distances);
            *force = *(self.start.force + factor * on_curve).map(|force| within(limit, force));
            if STIFFNESS {
                *stiffness = *slopes;
            }
            // In most cases all four are on one piece. The displacements behind the last of the branch may be on any piece.
            let same = [second, third].into_iter().take_while(|other| *other == piece).count();
            next += if fourth == piece && next + 4 <= count { 4 } else { 1 + same };
        }
    }
}

/// Relative change of a displacement by decimal text of 15 digits, at most.
const TEXT_ROUNDING: f64 = 1e-14;

/// The transition and the result of a step, with the energy if requested; state and displacement \[m\] are checked.
fn step(contact: &Contact, state: &[f64], displacement: f64, has_energy: bool) -> (Transition, LawStep<ConstantLoad>) {
    let memory = state::memory(state);
    let mut energy = has_energy.then(|| Dissipation::new(contact));
    let mut transition = memory.locate(contact, displacement, |segment| {
        if let Some(energy) = &mut energy {
            energy.add(segment);
        }
    });
    let mut is_full = transition.reversed && state::is_full(state);
    if is_full && (displacement - memory.now.displacement).abs() <= TEXT_ROUNDING * displacement.abs() {
        // A step of no length but for rounding: it continues the present branch, so that no reversals are removed.
        let branch = memory.branch(contact, memory.depth(), -transition.branch.direction);
        (transition, is_full) = (Transition { branch, reversed: false }, false);
    }
    let Response { mut force, stiffness } = transition.branch.response(contact, displacement);
    if is_full {
        let Merge { shift, .. } = Merge::new(contact, memory.initial.offset, memory.reversals, memory.now.displacement);
        force = within(contact.slip_force, force + shift);
    }
    (transition, StepResult { force, tangent: stiffness, dissipated: energy.map_or(0.0, Dissipation::total) })
}

impl Law for ConstantLoad {
    type Item = Contact;
    type Vector = f64;
    type Tangent = f64;
    type Workspace<'a> = Workspace<'a>;

    const STATE_LENGTH: usize = state::state_length(0);
    const STATE: Kind = Kind::State;

    fn check(contact: &Contact) -> Result<(), Error> {
        contact.check()
    }

    fn fits_its_counts(state: &[f64]) -> bool {
        state::depth(state).is_some_and(|depth| depth <= state.len().saturating_sub(HEADER) / PER_REVERSAL)
    }

    fn check_motion(_: &Contact, _: &mut Workspace, motion: &[f64]) -> Result<(), Error> {
        check_coefficients(motion)
    }

    fn harmonic_force(
        contact: &Contact,
        workspace: &mut Workspace,
        motion: &[f64],
        output: HarmonicOutput,
    ) -> Result<(), Error> {
        harmonic_force(contact, workspace, motion, output)
    }

    fn check_step(_: &Contact, displacement: &f64) -> Result<(), Error> {
        check_displacement(*displacement)
    }

    fn state_check(state: &[f64]) -> Result<(), Error> {
        let Memory { initial: InitialCurve { offset, slip_direction }, now, reversals } = state::read(state)?;
        let header = [now.displacement, now.force, offset, slip_direction];
        let finite = header.iter().chain(reversals.as_flattened()).all(|value| is_finite(*value));
        let whole = state.get(1).is_some_and(|depth| is_count(*depth));
        if !finite
            || !whole
            || ![-1.0, 0.0, 1.0].contains(&slip_direction)
            || reversals.iter().any(|[.., error]| *error < 0.0)
        {
            return Err(Error::BadState);
        }
        // Each reversal lies between the two before it; the oldest and its mirror point enclose all others. If rounding has moved a
        // reversal onto the one before it, the direction of the branch between them is lost.
        if let Some(([oldest, ..], later)) = reversals.split_first() {
            let (mut before, mut last) = (2.0 * offset - oldest, *oldest);
            for displacement in later.iter().map(|[displacement, ..]| *displacement).chain([now.displacement]) {
                if displacement < before.min(last) || displacement > before.max(last) || displacement == last {
                    return Err(Error::BadState);
                }
                (before, last) = (last, displacement);
            }
        }
        Ok(())
    }

    fn force_error(state: &[f64]) -> f64 {
        force_error(state::memory(state).reversals)
    }

    /// The copy holds at most 128 reversals.
    #[inline(never)]
    fn in_copy(contact: &Contact, state: &[f64], steps: impl FnOnce(&mut [f64])) {
        let mut copy = [0.0; state::state_length(128)];
        let length = state.len().min(copy.len());
        let copy = copy.part_mut(..length);
        state::copy(contact, state, copy);
        steps(copy);
    }

    fn trial(contact: &Contact, state: &[f64], displacement: f64, requested: Requested) -> LawStep<ConstantLoad> {
        step(contact, state, displacement, requested.energy).1
    }

    fn advance(contact: &Contact, state: &mut [f64], displacement: f64, requested: Requested) -> LawStep<ConstantLoad> {
        let memory = state::memory(state);
        let Memory { initial, now, .. } = memory;
        // Most steps only move the present point along its branch: without energy they need neither the stack nor the header.
        if !requested.energy
            && let Some(branch) = memory.branch_ahead(contact, displacement)
        {
            let Response { force, stiffness } = branch.response(contact, displacement);
            state::set_point(state, Point { displacement, force });
            return StepResult { force, tangent: stiffness, dissipated: 0.0 };
        }
        let (Transition { branch, reversed }, result) = step(contact, state, displacement, requested.energy);
        let (mut depth, now_after) = (branch.depth, Point { displacement, force: result.force });
        if reversed {
            (depth, _) = push(contact, initial.offset, state::reversals_mut(state), depth - 1, now);
        }
        state::write_header(state, depth, initial.after(contact, &branch, displacement), now_after);
        result
    }
}

/// Shear traction \[Pa\] at x \[m\] after any history: the traction of the initial loading, and twice that of half of each
/// reversal's change of force (Eq. 21 with Masing's rule).
/// Errors: `BadState`, `StateTooShort`; `ForceExceedsSlip` for a state of another contact. Nothing is written then.
pub fn shear_tractions(contact: &Contact, state: &[f64], x: &[f64], shear: &mut [f64]) -> Result<(), Error> {
    let memory = state::read(state)?;
    let forces = || memory.reversals.iter().map(|[_, force, _]| *force).chain([memory.now.force]);
    forces().try_for_each(|force| contact.check_force(force))?;
    shear.fill(0.0);
    let mut before = None;
    for force in forces() {
        let (scale, change) = before.map_or((1.0, force), |before: f64| (2.0, 0.5 * (force - before)));
        let point = contact.curve_at_force(change)?;
        shear.iter_mut().zip(x).for_each(|(shear, &x)| *shear += scale * point.shear(x));
        before = Some(force);
    }
    Ok(())
}
