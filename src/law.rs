//! Common interface of all laws: states, steps, and load histories.

use crate::error::Error;
use crate::fourier::HarmonicOutput;
use crate::tag::Kind;

/// Result of a step, with vectors `[T, N]` or `[Tx, Ty, N]`, and tangents of 2 x 2 or 3 x 3 entries.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepResult<V, T> {
    /// Tangential forces and normal force \[N\].
    pub force: V,
    /// Derivatives of the force with respect to the tangential displacements \[N/m\] and the normal component, column by column.
    pub tangent: T,
    /// \[J\]; 0 unless requested.
    pub dissipated: f64,
}

impl<const M: usize, const MM: usize> StepResult<[f64; M], [f64; MM]> {
    pub(crate) const NONE: Self = StepResult { force: [0.0; M], tangent: [0.0; MM], dissipated: 0.0 };
}

/// Results of a step that are requested besides the force.
#[derive(Debug, Clone, Copy)]
pub struct Requested {
    /// The derivatives of the force.
    pub tangent: bool,
    /// The dissipated energy.
    pub energy: bool,
}

/// Result of a step of a law.
pub type LawStep<L> = StepResult<<L as Law>::Vector, <L as Law>::Tangent>;

/// A law that advances the state of a contact, or of an element with a number of directions.
///
/// A loop of a contact under a constant normal force closes:
///
/// ```
/// use microslip::Contact;
/// use microslip::constant_load::ConstantLoad;
/// use microslip::law::Law;
/// # use microslip::{Material, Parameters};
/// # let parameters = Parameters {
/// #     flat_half_width: 0.0,
/// #     edge_radius: 0.05,
/// #     length: 0.02,
/// #     normal_force: 800.0,
/// #     friction_coefficient: 0.5,
/// #     material: [Material { young_modulus: 2e11, poisson_ratio: 0.3 }; 2],
/// #     displacement_reference: 1,
/// #     ..Parameters::default()
/// # };
///
/// let contact = Contact::rounded_flat(&parameters)?;
/// let mut state = [0.0; 64];
/// ConstantLoad::state_init(&mut state)?;
/// let amplitude = 0.5 * contact.slip_displacement;
/// let first = ConstantLoad::step(&contact, &mut state, amplitude)?;
/// let back = ConstantLoad::step(&contact, &mut state, -amplitude)?;
/// let closed = ConstantLoad::step(&contact, &mut state, amplitude)?;
/// assert!((closed.force - first.force).abs() <= 1e-12 * first.force);
/// assert!(back.dissipated + closed.dissipated > 0.0);
/// # Ok::<(), microslip::Error>(())
/// ```
pub trait Law: Sized {
    /// A contact or an element.
    type Item: Copy;
    /// A displacement; a force has as many components.
    type Vector: Copy;
    /// Derivative of the force by the displacement, column-major.
    type Tangent: Copy;
    /// An opened workspace of harmonic forces.
    type Workspace<'a>;

    /// The least length of a state.
    const STATE_LENGTH: usize;
    /// Kind of the tag of a state. All other values of a new state, of a contact that is open or unloaded, are 0.
    const STATE: Kind;
    /// Kind of the tag of a state for the other number of directions.
    const OTHER_STATE: Option<Kind> = None;

    /// Checks that a contact or an element is initialised, and belongs to this law.
    fn check(item: &Self::Item) -> Result<(), Error>;
    /// Whether a state with a valid tag is as long as its counts require.
    fn fits_its_counts(_state: &[f64]) -> bool {
        true
    }
    /// Checks the end of a step.
    /// Errors: `BadDisplacement`, `BadNormalForce` or `LengthTooShort`.
    fn check_step(item: &Self::Item, displacement: &Self::Vector) -> Result<(), Error>;

    /// Validates a state in full: its values are finite and belong to a possible history. For states from outside the process.
    /// Errors: `StateTooShort`; `BadState` for an array that was not initialised, or whose values no history leads to.
    fn state_check(state: &[f64]) -> Result<(), Error>;
    /// A bound on the error of the force \[N\] due to merged parts of the history, in a state whose header was checked; 0 while
    /// none was merged, and again once gross slip or separation has erased the memory.
    fn force_error(_state: &[f64]) -> f64 {
        0.0
    }
    /// Copies a state whose header was checked, at least its used part, to another one of the same length.
    fn copy_used(from: &[f64], to: &mut [f64]) {
        to.iter_mut().zip(from).for_each(|(to, from)| *to = *from);
    }

    /// Applies steps to a copy of a state whose header was checked, which may be shorter.
    fn in_copy(item: &Self::Item, state: &[f64], steps: impl FnOnce(&mut [f64]));

    /// A step with checked arguments whose new state is discarded.
    fn trial(item: &Self::Item, old: &[f64], displacement: Self::Vector, requested: Requested) -> LawStep<Self>;
    /// A step in place with checked arguments.
    fn advance(item: &Self::Item, state: &mut [f64], displacement: Self::Vector, requested: Requested)
    -> LawStep<Self>;

    /// Checks the coefficients of a motion.
    /// Errors: those of [`Law::harmonic_force`].
    fn check_motion(item: &Self::Item, workspace: &mut Self::Workspace<'_>, motion: &[f64]) -> Result<(), Error>;
    /// Harmonic force of a motion that is given by its coefficients.
    /// Errors: those of the function of each law.
    fn harmonic_force(
        item: &Self::Item,
        workspace: &mut Self::Workspace<'_>,
        motion: &[f64],
        output: HarmonicOutput,
    ) -> Result<(), Error>;

    /// A step in place.
    /// Errors: `StateTooShort`, `BadState`, and those of [`Law::check_step`].
    fn step(item: &Self::Item, state: &mut [f64], displacement: Self::Vector) -> Result<LawStep<Self>, Error> {
        Self::check_header(state)?;
        Self::check_step(item, &displacement)?;
        Ok(Self::advance(item, state, displacement, Requested { tangent: true, energy: true }))
    }

    /// Initialises a state: open or unloaded, at displacement 0.
    /// Errors: `StateTooShort` for fewer than [`Law::STATE_LENGTH`] doubles.
    fn state_init(state: &mut [f64]) -> Result<(), Error> {
        if state.len() < Self::STATE_LENGTH {
            return Err(Error::StateTooShort);
        }
        state.fill(0.0);
        state.first_mut().into_iter().for_each(|tag| *tag = Self::STATE.tag());
        Ok(())
    }

    /// Checks length, tag and counts of a state.
    /// Errors: `StateTooShort`, `BadState`; `BadDirections` for a state for the other number of directions.
    fn check_header(state: &[f64]) -> Result<(), Error> {
        let has_tag_of = |kind: Kind| state.first().is_some_and(|tag| kind.is_tag(*tag));
        let is_short = state.len() < Self::STATE_LENGTH;
        if !is_short && has_tag_of(Self::STATE) && Self::fits_its_counts(state) {
            Ok(())
        } else if Self::OTHER_STATE.is_some_and(has_tag_of) {
            Err(Error::BadDirections)
        } else {
            Err(if is_short { Error::StateTooShort } else { Error::BadState })
        }
    }
}
