//! The laws of elements with one and with two tangential directions, as one trait: each function of the interface exists once.

use crate::error::Error;
use crate::hbm::HarmonicOutput;
use crate::tag::Kind;
use crate::varying_load::element::{Directions, Element};
use crate::varying_load::harmonic_force;
use crate::varying_load::path::{PathOutput, StepResult};
use crate::varying_load::state;
use crate::varying_load::two_directions::{self, Requested, harmonic_force as harmonic_force_2};

/// Result of a step of a law.
type StepOf<L> = StepResult<<L as ElementLaw>::Vector, <L as ElementLaw>::Tangent>;

/// The law of elements with a number of tangential directions.
pub(super) trait ElementLaw: Sized {
    /// A displacement; a force has as many components.
    type Vector: Copy;
    /// Derivative of the force by the displacement, column-major.
    type Tangent: Copy;
    /// An opened workspace of the harmonic force.
    type Workspace<'a>;

    const DIRECTIONS: Directions;
    /// Components of a displacement.
    const COMPONENTS: usize;
    /// The least length of a state.
    const STATE_LENGTH: usize;
    /// Kind of the tag of a state for the other number of directions.
    const OTHER_STATE: Kind;

    fn state_init(state: &mut [f64]) -> Result<(), Error>;
    fn state_check(state: &[f64]) -> Result<(), Error>;
    fn check_header(state: &[f64]) -> Result<(), Error>;
    fn check_tag(tag: f64, state_length: usize) -> Result<(), Error>;
    fn force_error(state: &[f64]) -> f64;
    /// Copies what is in use of a state whose header was checked to one of the same length.
    fn copy_used(from: &[f64], to: &mut [f64]);

    fn check_step(element: &Element, displacement: &Self::Vector) -> Result<(), Error>;
    /// A step with checked arguments whose new state is discarded.
    fn trial(element: &Element, old: &[f64], displacement: Self::Vector, requested: Requested) -> StepOf<Self>;
    /// The same in place.
    fn advance(element: &Element, state: &mut [f64], displacement: Self::Vector, requested: Requested) -> StepOf<Self>;
    fn check_path(element: &Element, path: &[f64]) -> Result<(), Error>;
    fn path(element: &Element, state: &mut [f64], path: &[f64], output: PathOutput) -> Result<(), Error>;
    /// A path whose new state is discarded.
    fn path_in_copy(element: &Element, state: &[f64], path: &[f64], output: PathOutput) -> Result<(), Error>;

    fn workspace_length(harmonics: usize, samples: usize) -> usize;
    fn workspace_init(harmonics: usize, samples: usize, workspace: &mut [f64]) -> Result<(), Error>;
    fn workspace(memory: &mut [f64]) -> Result<Self::Workspace<'_>, Error>;
    /// Coefficients of one component, 2H + 1.
    fn coefficients(workspace: &Self::Workspace<'_>) -> usize;
    fn check_motion(workspace: &mut Self::Workspace<'_>, element: &Element, displacement: &[f64]) -> Result<(), Error>;
    fn harmonic_force(
        element: &Element,
        workspace: &mut Self::Workspace<'_>,
        displacement: &[f64],
        output: HarmonicOutput,
    ) -> Result<(), Error>;

    /// The error of a state that was rejected: the state of the other number of directions is distinguished.
    #[cold]
    fn state_error(error: Error, tag: f64) -> Error {
        match error {
            Error::BadState if Self::OTHER_STATE.count(tag).is_some() => Error::BadDirections,
            _ => error,
        }
    }
}

/// One tangential direction.
pub(super) struct OneDirection;

/// Two tangential directions.
pub(super) struct TwoDirections;

/// Implements [`ElementLaw`] by the functions of the modules of a law.
macro_rules! implement {
    ($law:ident, $state:ident, $harmonic_force:ident, $components:literal, $requested:expr, {$($constants:tt)*}) => {
        impl ElementLaw for $law {
            type Vector = [f64; $components];
            type Tangent = [f64; $components * $components];
            type Workspace<'a> = $harmonic_force::Workspace<'a>;

            const COMPONENTS: usize = $components;
            $($constants)*

            fn state_init(state: &mut [f64]) -> Result<(), Error> {
                $state::state_init(state)
            }

            fn state_check(state: &[f64]) -> Result<(), Error> {
                $state::state_check(state)
            }

            #[inline(always)]
            fn check_header(state: &[f64]) -> Result<(), Error> {
                $state::check_header(state)
            }

            #[inline(always)]
            fn check_tag(tag: f64, state_length: usize) -> Result<(), Error> {
                $state::check_tag(tag, state_length)
            }

            fn force_error(state: &[f64]) -> f64 {
                $state::force_error(state)
            }

            #[inline(always)]
            fn copy_used(from: &[f64], to: &mut [f64]) {
                $state::copy_used(from, to);
            }

            #[inline(always)]
            fn check_step(element: &Element, displacement: &Self::Vector) -> Result<(), Error> {
                $state::check_step(element, displacement)
            }

            #[inline(always)]
            fn trial(element: &Element, old: &[f64], displacement: Self::Vector, requested: Requested) -> StepOf<Self> {
                $state::trial(element, old, displacement, $requested(requested))
            }

            #[inline(always)]
            fn advance(
                element: &Element,
                state: &mut [f64],
                displacement: Self::Vector,
                requested: Requested,
            ) -> StepOf<Self> {
                $state::advance_checked(element, state, displacement, $requested(requested))
            }

            fn check_path(element: &Element, path: &[f64]) -> Result<(), Error> {
                $state::check_path(element, path)
            }

            fn path(element: &Element, state: &mut [f64], path: &[f64], output: PathOutput) -> Result<(), Error> {
                $state::path(element, state, path, output)
            }

            fn path_in_copy(element: &Element, state: &[f64], path: &[f64], output: PathOutput) -> Result<(), Error> {
                $state::path_in_copy(element, state, path, output)
            }

            fn workspace_length(harmonics: usize, samples: usize) -> usize {
                $harmonic_force::workspace_length(harmonics, samples)
            }

            fn workspace_init(harmonics: usize, samples: usize, workspace: &mut [f64]) -> Result<(), Error> {
                $harmonic_force::workspace_init(harmonics, samples, workspace)
            }

            #[inline(always)]
            fn workspace(memory: &mut [f64]) -> Result<Self::Workspace<'_>, Error> {
                $harmonic_force::Workspace::new(memory)
            }

            #[inline(always)]
            fn coefficients(workspace: &Self::Workspace<'_>) -> usize {
                workspace.coefficients()
            }

            fn check_motion(
                workspace: &mut Self::Workspace<'_>,
                element: &Element,
                displacement: &[f64],
            ) -> Result<(), Error> {
                workspace.check(element, displacement)
            }

            fn harmonic_force(
                element: &Element,
                workspace: &mut Self::Workspace<'_>,
                displacement: &[f64],
                output: HarmonicOutput,
            ) -> Result<(), Error> {
                $harmonic_force::harmonic_force(element, workspace, displacement, output)
            }
        }
    };
}

implement!(OneDirection, state, harmonic_force, 2, |requested: Requested| requested.energy, {
    const DIRECTIONS: Directions = Directions::One;
    const STATE_LENGTH: usize = state::state_length(0);
    const OTHER_STATE: Kind = Kind::TwoDirectionsState;
});

implement!(TwoDirections, two_directions, harmonic_force_2, 3, |requested| requested, {
    const DIRECTIONS: Directions = Directions::Two;
    const STATE_LENGTH: usize = two_directions::state_length();
    const OTHER_STATE: Kind = Kind::ElementState;
});

/// Evaluates an expression in which `$law` is the law for a number of directions.
macro_rules! with_law {
    ($directions:expr, $law:ident => $result:expr) => {
        match $directions {
            $crate::varying_load::element::Directions::One => {
                type $law = $crate::ffi::directions::OneDirection;
                $result
            }
            $crate::varying_load::element::Directions::Two => {
                type $law = $crate::ffi::directions::TwoDirections;
                $result
            }
        }
    };
}

pub(super) use with_law;

/// Directions, length, harmonics and samples of a workspace, from its header.
pub(super) struct WorkspaceSize {
    pub directions: Directions,
    pub extent: usize,
    pub harmonics: usize,
    pub samples: usize,
}

impl WorkspaceSize {
    /// # Errors
    /// `BadWorkspace` if uninitialised.
    #[inline(always)]
    pub fn read(header: &[f64; 2]) -> Result<WorkspaceSize, Error> {
        let (directions, extent, (harmonics, samples)) = match harmonic_force::workspace_extent(header) {
            Ok(extent) => (Directions::One, extent, harmonic_force::workspace_size(header)?),
            Err(_) => {
                let extent = harmonic_force_2::workspace_extent(header)?;
                (Directions::Two, extent, harmonic_force_2::workspace_size(header)?)
            }
        };
        Ok(WorkspaceSize { directions, extent, harmonics, samples })
    }
}
