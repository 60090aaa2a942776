//! Harmonic force of a periodic displacement in steady state: Fourier coefficients, exact Jacobian and dissipated energy.
//!
//! The displacement is `c0 + Σ (a_k cos kt + b_k sin kt)`. The steady state is that of the second of two periods from the initial
//! (unloaded) state. It is entered at the displacement of largest magnitude, at which no reversal is on the stack whatever the history:
//! one period is integrated from that instant. If only odd harmonics are present, displacement and force change their sign after half
//! a period (half-wave symmetry), and half a period is enough.
//!
//! There are two quadrature rules. `uniform_sampling` advances the law from sample to sample; `event_driven` locates the instants at
//! which the force is not smooth, by `motion`, and integrates between them, by `segments`. With φ the row 1, cos t, sin t, cos 2t, ...
//! at an instant, the force on a branch that leaves reversal r has the derivative
//!
//! ```text
//! dT = k (φ - φ_r) + dT_r
//! ```
//!
//! by the coefficients of the displacement, with k the tangent stiffness; `dT_r` is stored when the reversal is passed.

mod event_driven;
mod motion;
mod reversal_terms;
mod segments;
mod sensitivity;
mod uniform_sampling;

use crate::constant_load::contact::Contact;
use crate::error::Error;
use crate::fourier::workspace::{Size, TAGS, WorkspaceLayout};
use crate::limits::check_coefficients;
use crate::parameters::PARAMETERS;

pub use crate::fourier::HarmonicOutput;

/// Quadrature rule for the integrals over a period.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    /// Uniformly spaced samples.
    UniformSampling,
    /// Gauss-Legendre nodes between the events of the force.
    EventDriven,
}

impl Rule {
    /// Number of doubles in a workspace for the given number of harmonics and of samples, or nodes, per period; 0 if these are not
    /// allowed.
    #[must_use]
    pub fn workspace_length(self, harmonics: usize, samples: usize) -> usize {
        match self {
            Rule::UniformSampling => {
                uniform_sampling::Layout::new(Size::new(harmonics, samples)).map_or(0, |layout| layout.length())
            }
            Rule::EventDriven => {
                event_driven::Layout::new(Size::new(harmonics, samples)).map_or(0, |layout| layout.length())
            }
        }
    }

    /// Initialises a workspace: tables for the given harmonics and samples, and scratch memory.
    ///
    /// # Errors
    /// `BadHarmonics` unless 1 <= harmonics <= 2^24, `BadSamples` unless 2 harmonics < samples <= 2^24; `WorkspaceTooShort`.
    pub fn workspace_init(self, harmonics: usize, samples: usize, workspace: &mut [f64]) -> Result<(), Error> {
        match self {
            Rule::UniformSampling => uniform_sampling::Layout::init(Size::new(harmonics, samples), workspace),
            Rule::EventDriven => event_driven::Layout::init(Size::new(harmonics, samples), workspace),
        }
    }

    /// The rule of a workspace, from its tag.
    fn of_workspace([tag, ..]: &[f64; TAGS]) -> Rule {
        if event_driven::Layout::KIND.count(*tag).is_some() { Rule::EventDriven } else { Rule::UniformSampling }
    }
}

/// Number of doubles in an initialised workspace, from its header.
///
/// # Errors
/// `BadWorkspace` if uninitialised.
pub fn workspace_extent(header: &[f64; TAGS]) -> Result<usize, Error> {
    match Rule::of_workspace(header) {
        Rule::UniformSampling => uniform_sampling::Layout::read(header).map(|layout| layout.length()),
        Rule::EventDriven => event_driven::Layout::read(header).map(|layout| layout.length()),
    }
}

/// Harmonics, samples and rule of an initialised workspace, from its header.
///
/// # Errors
/// `BadWorkspace` if uninitialised.
pub fn workspace_size(header: &[f64; TAGS]) -> Result<(usize, usize, Rule), Error> {
    let rule = Rule::of_workspace(header);
    let size = match rule {
        Rule::UniformSampling => uniform_sampling::Layout::read(header)?.size(),
        Rule::EventDriven => event_driven::Layout::read(header)?.size(),
    };
    Ok((size.harmonics, size.samples, rule))
}

/// An opened workspace.
#[derive(Debug)]
pub struct Workspace<'a>(ByRule<'a>);

#[derive(Debug)]
enum ByRule<'a> {
    UniformSampling(uniform_sampling::Workspace<'a>),
    EventDriven(event_driven::Workspace<'a>),
}

impl<'a> Workspace<'a> {
    /// Opens an initialised workspace.
    ///
    /// # Errors
    /// `BadWorkspace` if uninitialised or too short.
    pub fn new(memory: &'a mut [f64]) -> Result<Workspace<'a>, Error> {
        Ok(Workspace(match Rule::of_workspace(memory.first_chunk().ok_or(Error::BadWorkspace)?) {
            Rule::UniformSampling => ByRule::UniformSampling(uniform_sampling::Workspace::new(memory)?),
            Rule::EventDriven => ByRule::EventDriven(event_driven::Workspace::new(memory)?),
        }))
    }

    /// 2H + 1.
    #[must_use]
    pub fn coefficients(&self) -> usize {
        match &self.0 {
            ByRule::UniformSampling(workspace) => workspace.coefficients(),
            ByRule::EventDriven(workspace) => workspace.coefficients(),
        }
    }
}

/// Harmonic force of a periodic displacement given by its 2H + 1 coefficients \[m\], by the rule of the workspace.
///
/// # Errors
/// `BadDisplacement` if a coefficient is not finite or exceeds 1e150; `BadArraySize` if a length does not agree with the workspace.
pub fn harmonic_force(
    contact: &Contact,
    workspace: &mut Workspace,
    displacement: &[f64],
    mut output: HarmonicOutput,
) -> Result<(), Error> {
    output.check(workspace.coefficients(), displacement)?;
    if let Some(jacobian) = &mut output.jacobian {
        jacobian.fill(0.0);
    }
    if let Some(drift) = &mut output.drift {
        **drift = 0.0;
    }
    if contact.is_frictionless() {
        if let Some(force) = output.force {
            force.fill(0.0);
        }
        if let Some(dissipated) = output.dissipated {
            *dissipated = 0.0;
        }
    } else if output.is_requested() {
        match &mut workspace.0 {
            ByRule::UniformSampling(of_rule) => {
                uniform_sampling::harmonic_force(contact, of_rule, displacement, output);
            }
            ByRule::EventDriven(of_rule) => event_driven::harmonic_force(contact, of_rule, displacement, output),
        }
    }
    Ok(())
}

/// Derivatives of the harmonic force with respect to the parameters of [`Sensitivity`](crate::Sensitivity) at fixed coefficients of the
/// displacement, by the rule of the workspace: derivative of force i by parameter j at `i + (2H + 1) j`.
///
/// With uniform sampling they are the exact derivatives of the discrete force; event-driven, the rule applied to the exact derivatives
/// of the integrals. Without friction or without normal force they are one-sided.
///
/// # Errors
/// `BadDisplacement` if a coefficient is not finite or exceeds 1e150; `BadArraySize` if a length does not agree with the workspace.
pub fn harmonic_sensitivity(
    contact: &Contact,
    workspace: &mut Workspace,
    displacement: &[f64],
    sensitivity: &mut [f64],
) -> Result<(), Error> {
    let n = workspace.coefficients();
    if displacement.len() != n || sensitivity.len() != PARAMETERS * n {
        return Err(Error::BadArraySize);
    }
    check_coefficients(displacement)?;
    if displacement.iter().all(|&coefficient| coefficient == 0.0) {
        sensitivity.fill(0.0);
        return Ok(());
    }
    match &mut workspace.0 {
        ByRule::UniformSampling(of_rule) => {
            uniform_sampling::harmonic_sensitivity(contact, of_rule, displacement, sensitivity);
        }
        ByRule::EventDriven(of_rule) => {
            event_driven::harmonic_sensitivity(contact, of_rule, displacement, sensitivity);
        }
    }
    Ok(())
}

/// Quantities requested at each point of the curve.
#[derive(Debug, Clone, Copy)]
struct Requested {
    force: bool,
    stiffness: bool,
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::constant_load::contact::tests::contact;
    use std::vec;
    use std::vec::Vec;

    const RULES: [Rule; 2] = [Rule::UniformSampling, Rule::EventDriven];

    /// Coefficients of a motion with nested loops, and of one with odd harmonics only.
    pub(super) const SHAPE: [f64; 7] = [0.2, 0.5, -0.1, 0.05, 0.3, -0.35, 0.2];
    pub(super) const ODD: [f64; 7] = [0.0, 0.8, 0.1, 0.0, 0.0, -0.2, 0.3];

    pub(super) fn scaled(contact: &Contact, shape: &[f64], size: f64) -> Vec<f64> {
        shape.iter().map(|c| c * size * contact.slip_displacement).collect()
    }

    pub(super) fn workspace(rule: Rule, harmonics: usize, samples: usize) -> Vec<f64> {
        let mut memory = vec![0.0; rule.workspace_length(harmonics, samples)];
        rule.workspace_init(harmonics, samples, &mut memory).unwrap();
        memory
    }

    /// Force, Jacobian and energy.
    pub(super) type All = (Vec<f64>, Vec<f64>, f64);

    pub(super) fn compute(contact: &Contact, memory: &mut [f64], displacement: &[f64]) -> All {
        let n = displacement.len();
        let (mut force, mut jacobian, mut energy) = (vec![f64::NAN; n], vec![f64::NAN; n * n], f64::NAN);
        let output = HarmonicOutput {
            force: Some(&mut force),
            jacobian: Some(&mut jacobian),
            dissipated: Some(&mut energy),
            drift: None,
        };
        evaluate(contact, memory, displacement, output).unwrap();
        (force, jacobian, energy)
    }

    /// Compiled once for all tests: the function itself is inlined into every caller.
    #[inline(never)]
    fn evaluate(
        contact: &Contact,
        memory: &mut [f64],
        displacement: &[f64],
        output: HarmonicOutput,
    ) -> Result<(), Error> {
        harmonic_force(contact, &mut Workspace::new(memory).unwrap(), displacement, output)
    }

    #[test]
    fn an_invalid_header_or_length_of_a_workspace_is_rejected() {
        for rule in RULES {
            let good = workspace(rule, 3, 16);
            for (index, value) in
                [(0, 0.0), (0, f64::NAN), (0, good[1]), (1, 0.0), (1, 16.0), (1, f64::INFINITY), (1, good[0])]
            {
                let mut bad = good.clone();
                bad[index] = value;
                assert_eq!(Workspace::new(&mut bad).map(|_| ()), Err(Error::BadWorkspace), "{index} {value}");
            }
            let mut short = good.clone();
            short.pop();
            assert_eq!(Workspace::new(&mut short).map(|_| ()), Err(Error::BadWorkspace));
            assert_eq!(Workspace::new(&mut []).map(|_| ()), Err(Error::BadWorkspace));
            let header = good.first_chunk().unwrap();
            assert_eq!(workspace_extent(header), Ok(good.len()));
            assert_eq!(workspace_size(header), Ok((3, 16, rule)));
            // Memory beyond the extent is not written.
            let mut long = vec![-1.0; good.len() + 2];
            rule.workspace_init(3, 16, &mut long).unwrap();
            let contact = contact(50e-6);
            compute(&contact, &mut long, &scaled(&contact, &SHAPE, 1.0));
            assert_eq!(long.get(good.len()..), Some(&[-1.0, -1.0][..]));
        }
        // Neither rule accepts a workspace of the other.
        let [mut one, mut two] = RULES.map(|rule| workspace(rule, 3, 16));
        assert!(matches!(event_driven::Workspace::new(&mut one), Err(Error::BadWorkspace)));
        assert!(matches!(uniform_sampling::Workspace::new(&mut two), Err(Error::BadWorkspace)));
    }

    #[test]
    fn results_do_not_depend_on_earlier_use_of_the_workspace() {
        for rule in RULES {
            let (contact, mut memory) = (contact(50e-6), workspace(rule, 3, 32));
            let motion = |size: f64| scaled(&contact, &SHAPE, size);
            let first = compute(&contact, &mut memory, &motion(0.8));
            compute(&contact, &mut memory, &motion(-3.0));
            assert_eq!(compute(&contact, &mut memory, &motion(0.8)), first);
            // Omitted outputs do not change the others.
            let mut force = vec![0.0; 7];
            let output = HarmonicOutput { force: Some(&mut force), jacobian: None, dissipated: None, drift: None };
            evaluate(&contact, &mut memory, &motion(0.8), output).unwrap();
            assert_eq!(force, first.0);
        }
    }
}
