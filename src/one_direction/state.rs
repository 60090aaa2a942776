//! The state of an element in the caller's memory, and steps from it.
//!
//! ```text
//! [tag, number of pieces, displacement, normal component, N, S, dN/d(input), dS/d(input), force error,
//!      ξ, η, N and T of each knot, from the centre outwards]
//! ```

use crate::element::{Directions, Element, NormalState};
use crate::error::{Error, ensure};
use crate::law::{Law, LawStep, Requested, StepResult};
use crate::limits::check_displacement;
use crate::numerics::fp_class::is_finite;
use crate::numerics::record::records;
use crate::numerics::slices::PanicFreeSlice;
use crate::one_direction::OneDirection;
use crate::one_direction::diagram::{Knot, Polygon};
use crate::one_direction::harmonic_force::{HarmonicOutput, OneDirectionWorkspace, harmonic_force};
use crate::one_direction::step::{StepStart, step};
use crate::tag::{Kind, count, is_count, stored};

const HEADER: usize = 9;
const PER_KNOT: usize = 4;
/// The least capacity of a state.
const MIN_PIECES: usize = 4;

/// Number of doubles in a state that holds `pieces` pieces of the diagram exactly; fewer than 4 count as 4.
pub const fn state_length(pieces: usize) -> usize {
    let pieces = if pieces < MIN_PIECES { MIN_PIECES } else { pieces };
    // One knot more than pieces.
    pieces.saturating_add(1).saturating_mul(PER_KNOT).saturating_add(HEADER)
}

const ERROR: usize = 8;

impl StepStart {
    fn read(&[_, _, displacement, input, load, shift, load_slope, shift_slope, error]: &[f64; HEADER]) -> StepStart {
        StepStart { displacement, input, normal: NormalState { load, shift, load_slope, shift_slope }, error }
    }
}

/// Number of knots in use: one more than pieces.
fn used_knots(&[_, pieces, ..]: &[f64; HEADER]) -> usize {
    count(pieces).unwrap_or(0) + 1
}

/// StepStart and knots in use of a state whose header was checked.
pub(crate) fn read(state: &[f64]) -> (StepStart, &[Knot]) {
    let (header, knots) = state.split_first_chunk().unwrap_or((&[0.0; HEADER], &[]));
    let knots = records(knots);
    (StepStart::read(header), knots.get(..used_knots(header)).unwrap_or(knots))
}

impl Law for OneDirection {
    type Item = Element;
    type Vector = [f64; 2];
    type Tangent = [f64; 4];
    type Workspace<'a> = OneDirectionWorkspace<'a>;

    const STATE_LENGTH: usize = state_length(0);
    const STATE: Kind = Kind::ElementState;
    const OTHER_STATE: Option<Kind> = Some(Kind::TwoDirectionsState);

    fn check(element: &Element) -> Result<(), Error> {
        element.check_directions(Directions::One)
    }

    fn fits_its_counts(state: &[f64]) -> bool {
        let pieces = state.get(1).copied().and_then(count);
        pieces.is_some_and(|pieces| pieces < state.len().saturating_sub(HEADER) / PER_KNOT)
    }

    fn check_motion(element: &Element, workspace: &mut OneDirectionWorkspace, motion: &[f64]) -> Result<(), Error> {
        workspace.check(element, motion)
    }

    fn harmonic_force(
        element: &Element,
        workspace: &mut OneDirectionWorkspace,
        motion: &[f64],
        output: HarmonicOutput,
    ) -> Result<(), Error> {
        harmonic_force(element, workspace, motion, output)
    }

    fn check_step(element: &Element, &[displacement, input]: &[f64; 2]) -> Result<(), Error> {
        check_displacement(displacement)?;
        element.check_input(input)
    }

    fn state_check(state: &[f64]) -> Result<(), Error> {
        OneDirection::check_header(state)?;
        let (StepStart { displacement, normal, error, .. }, knots) = read(state);
        let NormalState { load, shift, load_slope, shift_slope } = normal;
        let whole = state.get(1).is_some_and(|pieces| is_count(*pieces));
        let finite = state.iter().take(HEADER + PER_KNOT * knots.len()).all(|value| is_finite(*value));
        if !finite || !whole || error < 0.0 || [load, shift, load_slope, shift_slope].iter().any(|value| *value < 0.0) {
            return Err(Error::BadState);
        }
        let (Some(first), Some(last)) = (knots.first(), knots.last()) else {
            return Err(Error::BadState);
        };
        // N may fall from one knot to the next by rounding only. ξ and η of a knot each have an error of two roundings of the
        // larger coordinate, so that the error of S is at most 2 roundings times the largest coordinate over the size. The exponent
        // of N in S is at most 9; with a layer, of ln(1+x) (1+1/x) at x = N/N_c, at most 2^40 times 1000, it is at most 35. So the
        // error of N is at most 70 roundings at both ends of a piece. The tables of N(S) and S(N) have an error of 1e-13 in every
        // rounding mode, with a layer of the smallest N_c of 2.5e-10.
        let size = 0.5 * (last.eta - last.xi);
        let rounding = (140.0 * f64::EPSILON * last.xi.abs().max(last.eta.abs()) + 5e-10 * size) * load;
        let allowed = rounding.min(f64::MAX);
        let monotone = |pair: &[Knot]| match pair {
            [inner, outer] => {
                outer.xi <= inner.xi && outer.eta >= inner.eta && (inner.load - outer.load).max(0.0) * size <= allowed
            }
            _ => true,
        };
        let centred = first.xi == first.eta && first.load == 0.0 && last.load <= load;
        // The diagram of an open or frictionless contact is its centre.
        let complete = knots.len() == 1 || (last.load == load && last.xi <= displacement && last.eta >= displacement);
        ensure(centred && complete && knots.windows(2).all(monotone), Error::BadState)
    }

    fn force_error(state: &[f64]) -> f64 {
        state.or_zero(ERROR)
    }

    fn copy_used(from: &[f64], to: &mut [f64]) {
        let used = HEADER + PER_KNOT * read(from).1.len();
        if let (Some(from), Some(to)) = (from.get(..used), to.get_mut(..used)) {
            to.copy_from_slice(from);
        }
    }

    /// The copy has the capacity of the state, but at most 256 pieces.
    #[inline(never)]
    fn in_copy(element: &Element, state: &[f64], steps: impl FnOnce(&mut [f64])) {
        let mut copy = [0.0; COPY_LENGTH];
        let copy = copy.part_mut(..state.len().min(COPY_LENGTH));
        let (Some((header, knots)), Some(source)) = (copy.split_first_chunk_mut::<HEADER>(), state.first_chunk())
        else {
            return;
        };
        let mut polygon = Polygon::new(element.friction_coefficient, knots, 0);
        read(state).1.iter().for_each(|knot| polygon.push(*knot));
        *header = *source;
        header[1] = stored(polygon.used.saturating_sub(1));
        header[ERROR] += polygon.error;
        steps(copy);
    }

    fn trial(element: &Element, state: &[f64], displacement: [f64; 2], requested: Requested) -> LawStep<Self> {
        let (header, mut knots) = read(state);
        step(element, &header, &mut knots, displacement, requested.energy).0
    }

    #[inline(never)]
    fn advance(element: &Element, state: &mut [f64], displacement: [f64; 2], requested: Requested) -> LawStep<Self> {
        let Some((header, knots)) = state.split_first_chunk_mut::<HEADER>() else { return StepResult::NONE };
        let mut polygon = Polygon::new(element.friction_coefficient, knots, used_knots(header));
        let (step, to) = step(element, &StepStart::read(header), &mut polygon, displacement, requested.energy);
        let StepStart { displacement, input, normal: NormalState { load, shift, load_slope, shift_slope }, error } = to;
        let error = polygon.error + if polygon.anew { 0.0 } else { error };
        let pieces = stored(polygon.used.saturating_sub(1));
        *header = [Kind::ElementState.tag(), pieces, displacement, input, load, shift, load_slope, shift_slope, error];
        step
    }
}

/// Length of the copy of a state that a path uses if its new state is discarded.
const COPY_LENGTH: usize = state_length(256);
