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

use crate::element::Element;
use crate::error::Error;
use crate::law::{ElementLaw, Law, Requested, StepResult};

pub use state::state_length;

/// Result of a step: forces `[T, N]`, tangent `[∂T/∂u, ∂N/∂u, ∂T/∂w, ∂N/∂w]` (column-major) and dissipated energy.
pub type Step = StepResult<[f64; 2], [f64; 4]>;

/// The law of elements with one tangential direction.
pub(crate) struct OneDirection;

impl ElementLaw for OneDirection {
    type Workspace<'a> = harmonic_force::Workspace<'a>;

    const COMPONENTS: usize = 2;

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

/// Initialises a state: open, at displacement 0 and normal component 0.
/// Errors: `StateTooShort` for fewer than [`state_length`]`(0)` doubles.
pub fn state_init(state: &mut [f64]) -> Result<(), Error> {
    OneDirection::state_init(state)
}

/// Validates a state in full: finite values, a monotone polygon from the centre to the present point. For states from outside the
/// process.
/// Errors: `StateTooShort`; `BadState` for an array that was not initialised, or whose values no history leads to.
pub fn state_check(state: &[f64]) -> Result<(), Error> {
    OneDirection::state_check(state)
}

/// A bound on the error of the force \[N\] from merging pieces; 0 while nothing was merged.
pub fn force_error(state: &[f64]) -> f64 {
    OneDirection::force_error(state)
}

/// A step in place.
/// Errors: `StateTooShort`, `BadState`, `BadDisplacement`, `BadNormalForce` or `LengthTooShort`.
pub fn advance(element: &Element, state: &mut [f64], displacement: [f64; 2], with_energy: bool) -> Result<Step, Error> {
    OneDirection::check_header(state)?;
    OneDirection::check_step(element, &displacement)?;
    Ok(OneDirection::advance(element, state, displacement, Requested { tangent: true, energy: with_energy }))
}
