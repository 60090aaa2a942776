//! The law for two tangential directions. A displacement is `[u, v, w]` or `[u, v, N]`, a force `[Tx, Ty, N]`.
//!
//! The contact is a family of nested sizes, as in one direction, but slip has a direction of its own at each point. Springs at nodes of
//! the family carry the displacement of the sizes within; the tractions at one point of each shell are a triangular map of them, and
//! Coulomb's law holds at these points, with slip in the direction of the traction.
//!
//! - `scalar`: numbers over which the law is written, values and duals;
//! - `tables`, `contact`: the springs of a shape, aligned with a size, and under a present load;
//! - `trial`, `slip`, `step`: a step without slip, Coulomb's law at the points in its middle and at its end, and the step itself with its
//!   energy;
//! - `stick`: a step under a constant load without slip;
//! - `path`, `state`: a step between contacts that may be open, and the state in the caller's memory;
//! - [`harmonic_force`]: Fourier coefficients of the forces of a periodic motion.

pub mod harmonic_force;

mod contact;
mod path;
mod scalar;
mod slip;
mod state;
mod step;
mod stick;
mod tables;
mod trial;

use crate::element::{Directions, Element};
use crate::error::Error;
use crate::law::{self, ElementLaw, Law, PathOutput, Requested};
use crate::limits::check_displacement;
use crate::tag::Kind;

pub use state::{state_check, state_init, state_length};

/// Result of a step: forces `[Tx, Ty, N]`, tangent 3 x 3 (column-major), 0 unless requested, and dissipated energy.
pub type Step = law::StepResult<[f64; 3], [f64; 9]>;

/// The law of elements with two tangential directions.
pub(crate) struct TwoDirections;

impl Law for TwoDirections {
    type Item = Element;
    type Vector = [f64; 3];
    type Tangent = [f64; 9];

    const STATE_LENGTH: usize = state_length();
    const NEW_STATE: f64 = Kind::TwoDirectionsState.tag(0);
    const OTHER_STATE: Option<Kind> = Some(Kind::ElementState);

    #[inline(always)]
    fn check(element: &Element) -> Result<(), Error> {
        element.check_directions(Directions::Two)
    }

    #[inline(always)]
    fn check_tag(tag: f64, _state_length: usize) -> Result<(), Error> {
        state::check_tag(tag)
    }

    #[inline(always)]
    fn check_step(element: &Element, &[u, v, input]: &[f64; 3]) -> Result<(), Error> {
        check_displacement(u)?;
        check_displacement(v)?;
        element.check_input(input)
    }

    fn state_check(state: &[f64]) -> Result<(), Error> {
        state_check(state)
    }

    fn force_error(_: &[f64]) -> f64 {
        0.0
    }

    #[inline(always)]
    fn copy_used(from: &[f64], to: &mut [f64]) {
        state::copy_used(from, to);
    }

    #[inline(always)]
    fn trial(element: &Element, old: &[f64], displacement: [f64; 3], requested: Requested) -> Step {
        state::trial_step(element, old, displacement, requested)
    }

    #[inline(always)]
    fn advance(element: &Element, state: &mut [f64], displacement: [f64; 3], requested: Requested) -> Step {
        state::advance_state(element, state, displacement, requested)
    }

    #[inline(never)]
    fn path_in_copy(element: &Element, state: &[f64], path: &[[f64; 3]], output: PathOutput<[f64; 3], [f64; 9]>) {
        let mut copy = [0.0; state_length()];
        state::copy_used(state, &mut copy);
        Self::path(element, &mut copy, path, output);
    }
}

impl ElementLaw for TwoDirections {
    type Workspace<'a> = harmonic_force::Workspace<'a>;

    const COMPONENTS: usize = 3;

    fn check_motion(workspace: &mut Self::Workspace<'_>, element: &Element, motion: &[f64]) -> Result<(), Error> {
        workspace.check(element, motion)
    }

    fn harmonic_force(
        element: &Element,
        workspace: &mut Self::Workspace<'_>,
        motion: &[f64],
        output: harmonic_force::HarmonicOutput,
    ) -> Result<(), Error> {
        harmonic_force::harmonic_force(element, workspace, motion, output)
    }
}

/// A step in place.
/// Errors: `StateTooShort`, `BadState`, `BadDisplacement`, `BadNormalForce` or `LengthTooShort`.
pub fn advance(element: &Element, state: &mut [f64], displacement: [f64; 3]) -> Result<Step, Error> {
    TwoDirections::check_header(state)?;
    TwoDirections::check_step(element, &displacement)?;
    Ok(TwoDirections::advance(element, state, displacement, Requested { tangent: true, energy: true }))
}
