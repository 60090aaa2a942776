//! Harmonic force of a periodic displacement in steady state: Fourier coefficients, exact Jacobian and dissipated energy.
//!
//! The displacement is `c0 + Σ (a_k cos kt + b_k sin kt)`. From the initial (unloaded) state, the second period is the steady
//! state. At the displacement of largest magnitude no reversal is on the stack, whatever the history: one period is integrated from
//! that instant. If only odd harmonics are present, displacement and force change their signs after half a period (half-wave
//! symmetry), and half a period is enough.
//!
//! There are two quadrature rules. `uniform_sampling` advances the steady state from sample to sample. `event_driven` finds the
//! instants at which the force is not smooth (`motion`) and integrates between them (`segments`). Let φ be the row 1, cos t, sin t,
//! cos 2t, ... at an instant. Then the force on a branch that leaves reversal r has the derivative
//!
//! ```text
//! dT = k (φ - φ_r) + dT_r
//! ```
//!
//! with respect to the coefficients of the displacement, with the tangent stiffness k; `dT_r` is stored when the motion reverses.

mod event_driven;
mod motion;
mod reversal_terms;
mod segments;
mod sensitivity;
mod uniform_sampling;

use crate::constant_load::contact::Contact;
use crate::error::Error;
use crate::fourier::workspace::{HEADER, Layout, SamplingSize};

use event_driven::EventWorkspace;
use uniform_sampling::UniformWorkspace;

pub use crate::fourier::HarmonicOutput;

/// Quadrature rule for the integrals over a period, with the constant of the C interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    /// Uniformly spaced samples.
    UniformSampling = 0,
    /// Gauss-Legendre nodes between the events of the force.
    EventDriven = 1,
}

impl Rule {
    /// Number of doubles in a workspace for the given number of harmonics and of samples, or nodes, per period; 0 if these are not
    /// allowed.
    pub fn workspace_length(self, harmonics: usize, samples: usize) -> usize {
        let size = SamplingSize { harmonics, samples, periods: 0 };
        match self {
            Rule::UniformSampling => UniformWorkspace::length_or_zero(size),
            Rule::EventDriven => EventWorkspace::length_or_zero(size),
        }
    }

    /// Initialises a workspace: tables for the given harmonics and samples, and scratch memory.
    /// Errors: `BadHarmonics` unless 1 <= harmonics <= 2^24, `BadSamples` unless 2 harmonics < samples <= 2^24;
    /// `WorkspaceTooShort`.
    pub fn workspace_init(self, harmonics: usize, samples: usize, workspace: &mut [f64]) -> Result<(), Error> {
        let size = SamplingSize { harmonics, samples, periods: 0 };
        match self {
            Rule::UniformSampling => UniformWorkspace::init(size, workspace),
            Rule::EventDriven => EventWorkspace::init(size, workspace),
        }
    }
}

/// Rule, size and number of doubles of an initialised workspace, from its header.
///
/// Errors: `BadWorkspace` if uninitialised.
pub(crate) fn workspace_size(header: &[f64; HEADER]) -> Result<(Rule, SamplingSize, usize), Error> {
    let (rule, (size, length)) = if EventWorkspace::KIND.is_tag(header[0]) {
        (Rule::EventDriven, EventWorkspace::read(header)?)
    } else {
        (Rule::UniformSampling, UniformWorkspace::read(header)?)
    };
    Ok((rule, size, length))
}

/// An opened workspace.
pub struct Workspace<'a> {
    size: SamplingSize,
    by_rule: ByRule<'a>,
}

enum ByRule<'a> {
    UniformSampling(UniformWorkspace<'a>),
    EventDriven(EventWorkspace<'a>),
}

impl<'a> Workspace<'a> {
    /// Opens an initialised workspace.
    /// Errors: `BadWorkspace` if uninitialised or too short.
    pub fn new(memory: &'a mut [f64]) -> Result<Workspace<'a>, Error> {
        let (rule, size, _) = workspace_size(memory.first_chunk().ok_or(Error::BadWorkspace)?)?;
        Workspace::of_size(rule, size, memory)
    }

    /// A workspace of this rule and size, which were read from its header.
    /// Errors: `BadWorkspace` if too short.
    pub(crate) fn of_size(rule: Rule, size: SamplingSize, memory: &'a mut [f64]) -> Result<Workspace<'a>, Error> {
        let by_rule = match rule {
            Rule::UniformSampling => ByRule::UniformSampling(UniformWorkspace::of_size(size, memory)?),
            Rule::EventDriven => ByRule::EventDriven(EventWorkspace::of_size(size, memory)?),
        };
        Ok(Workspace { size, by_rule })
    }

    /// 2H + 1.
    pub fn coefficients(&self) -> usize {
        self.size.coefficients()
    }
}

/// Harmonic force of a periodic displacement given by its 2H + 1 coefficients \[m\], by the rule of the workspace.
/// Errors: `BadDisplacement` if a coefficient is not finite or exceeds 1e150; `BadArraySize` if a length does not agree with the
/// workspace.
///
/// The friction force of one harmonic by 64 samples:
///
/// ```
/// use microslip::Contact;
/// use microslip::constant_load::harmonic_force::{HarmonicOutput, Rule, Workspace, harmonic_force};
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
/// let mut memory = vec![0.0; Rule::UniformSampling.workspace_length(1, 64)];
/// Rule::UniformSampling.workspace_init(1, 64, &mut memory)?;
/// let motion = [0.0, 0.5 * contact.slip_displacement, 0.0];
/// let (mut force, mut energy) = ([0.0; 3], 0.0);
/// let output = HarmonicOutput { force: Some(&mut force), jacobian: None, dissipated: Some(&mut energy), drift: None };
/// harmonic_force(&contact, &mut Workspace::new(&mut memory)?, &motion, output)?;
/// // The displacement has no sine: that of the force dissipates.
/// assert!(force[2] < 0.0 && energy > 0.0);
/// # Ok::<(), microslip::Error>(())
/// ```
pub fn harmonic_force(
    contact: &Contact,
    workspace: &mut Workspace,
    displacement: &[f64],
    mut output: HarmonicOutput,
) -> Result<(), Error> {
    output.check(workspace.coefficients(), displacement)?;
    if let Some(drift) = &mut output.drift {
        **drift = 0.0;
    }
    if contact.is_frictionless() {
        [output.force, output.jacobian].into_iter().flatten().for_each(|output| output.fill(0.0));
        if let Some(dissipated) = output.dissipated {
            *dissipated = 0.0;
        }
    } else {
        match &mut workspace.by_rule {
            ByRule::UniformSampling(of_rule) => {
                uniform_sampling::harmonic_force(contact, of_rule, displacement, output);
            }
            ByRule::EventDriven(of_rule) => event_driven::harmonic_force(contact, of_rule, displacement, output),
        }
    }
    Ok(())
}

/// Derivatives of the harmonic force with respect to the parameters of [`Sensitivity`](crate::Sensitivity) at fixed coefficients of
/// the displacement, by the rule of the workspace: the derivative of force i with respect to parameter j is at `i + (2H + 1) j`.
///
/// Uniform sampling gives the exact derivatives of the discrete force. The event-driven rule is applied to the exact derivatives of
/// the integrands. Without friction or without normal force the derivatives are one-sided. The displacement must be one that
/// [`harmonic_force`] accepts.
pub(crate) fn harmonic_sensitivity(
    contact: &Contact,
    workspace: &mut Workspace,
    displacement: &[f64],
    sensitivity: &mut [f64],
) {
    if displacement.iter().all(|&coefficient| coefficient == 0.0) {
        sensitivity.fill(0.0);
        return;
    }
    match &mut workspace.by_rule {
        ByRule::UniformSampling(of_rule) => {
            uniform_sampling::harmonic_sensitivity(contact, of_rule, displacement, sensitivity);
        }
        ByRule::EventDriven(of_rule) => {
            event_driven::harmonic_sensitivity(contact, of_rule, displacement, sensitivity);
        }
    }
}

/// Quantities requested at each point of the curve.
#[derive(Clone, Copy, Default)]
struct RequestedOfCurve {
    force: bool,
    stiffness: bool,
}

#[cfg(test)]
pub(crate) mod tests;
