//! The law for one tangential direction under a normal force that varies, with separation. A displacement is `[u, w]` or `[u, N]`, a
//! force `[T, N]`.
//!
//! As the load rises and falls the contact runs through its family of sizes. The state is a diagram D(S)
//! with |D| <= mu over the tangential shifts S of the sizes inside the contact: `T = ∫ D dN` and `u = o + ∫ D dS`. For a path that
//! is straight in (S, u) Coulomb's law determines the diagram at the end in closed form (Jäger 1998), and this is exact for
//! elastically similar half-planes.
//!
//! - `diagram`: the diagram in characteristic coordinates, and a step in it;
//! - `step`, `energy`: a step of a contact that may open or close, and the energy dissipated in it;
//! - `state`: the caller's array that holds a diagram;
//! - [`harmonic_force`]: Fourier coefficients of the forces of a periodic motion;
//! - [`tractions`]: pressure and shear traction of a diagram.

pub mod harmonic_force;
pub mod tractions;

mod diagram;
mod energy;
pub(crate) mod state;
mod step;

use crate::element::{Directions, Element};
use crate::error::Error;
use crate::law::{self, ElementLaw, PathOutput, Requested};
use crate::limits::check_displacement;
use crate::tag::Kind;

pub use state::{force_error, state_check, state_init, state_length};

/// Result of a step: forces `[T, N]`, tangent `[∂T/∂u, ∂N/∂u, ∂T/∂w, ∂N/∂w]` (column-major) and dissipated energy.
pub type Step = law::StepResult<[f64; 2], [f64; 4]>;

/// The law of elements with one tangential direction.
pub(crate) struct OneDirection;

impl ElementLaw for OneDirection {
    type Vector = [f64; 2];
    type Tangent = [f64; 4];
    type Workspace<'a> = harmonic_force::Workspace<'a>;

    const DIRECTIONS: Directions = Directions::One;
    const COMPONENTS: usize = 2;
    const STATE_LENGTH: usize = state::state_length(0);
    const OTHER_STATE: Kind = Kind::TwoDirectionsState;

    fn state_init(state: &mut [f64]) -> Result<(), Error> {
        state::state_init(state)
    }

    fn state_check(state: &[f64]) -> Result<(), Error> {
        state::state_check(state)
    }

    #[inline(always)]
    fn check_tag(tag: f64, state_length: usize) -> Result<(), Error> {
        state::check_tag(tag, state_length)
    }

    fn force_error(state: &[f64]) -> f64 {
        state::force_error(state)
    }

    #[inline(always)]
    fn copy_used(from: &[f64], to: &mut [f64]) {
        state::copy_used(from, to);
    }

    #[inline(always)]
    fn check_step(element: &Element, &[displacement, input]: &[f64; 2]) -> Result<(), Error> {
        check_displacement(displacement)?;
        element.check_input(input)
    }

    #[inline(always)]
    fn trial(element: &Element, old: &[f64], displacement: [f64; 2], requested: Requested) -> Step {
        state::trial(element, old, displacement, requested.energy)
    }

    #[inline(always)]
    fn advance(element: &Element, state: &mut [f64], displacement: [f64; 2], requested: Requested) -> Step {
        state::advance_checked(element, state, displacement, requested.energy)
    }

    fn path_in_copy(element: &Element, state: &[f64], path: &[[f64; 2]], output: PathOutput<[f64; 2], [f64; 4]>) {
        let mut buffer = [0.0; state::COPY_LENGTH];
        Self::path(element, state::copy_of(element, state, &mut buffer), path, output);
    }

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
pub fn advance(element: &Element, state: &mut [f64], displacement: [f64; 2], with_energy: bool) -> Result<Step, Error> {
    OneDirection::check_header(state)?;
    OneDirection::check_step(element, &displacement)?;
    Ok(OneDirection::advance(element, state, displacement, Requested { tangent: true, energy: with_energy }))
}
