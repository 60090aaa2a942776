//! The law for two tangential directions: state, steps and harmonic force. A displacement is `[u, v, w]` or `[u, v, N]`, a force
//! `[Tx, Ty, N]`.
//!
//! Provisional: one spring of the stiffness of the whole contact, with Coulomb's limit for the magnitude of its force.
//!
//! ```text
//! [tag, u, v, normal component, Tx, Ty, N, 0, ...]
//! ```

use crate::constant_load::contact::check_displacement;
use crate::error::Error;
use crate::numerics::fp_class::is_finite;
use crate::tag::Kind;
use crate::varying_load::element::{Element, Normal};
use crate::varying_load::path::{self, advance_along};

pub use crate::varying_load::path::PathOutput;

const LENGTH: usize = 260;
const HEADER: usize = 7;

/// Number of doubles in a state.
#[must_use]
pub const fn state_length() -> usize {
    LENGTH
}

/// Result of a step: forces `[Tx, Ty, N]`, tangent 3 x 3 (column-major), 0 unless requested, and dissipated energy.
pub type Step = path::StepResult<[f64; 3], [f64; 9]>;

/// Results of a step that are requested besides the force.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wanted {
    pub tangent: bool,
    pub energy: bool,
}

/// Initialises a state: open, at displacement 0 and normal component 0.
///
/// # Errors
/// `StateTooShort` for fewer than [`state_length`] doubles.
pub fn state_init(state: &mut [f64]) -> Result<(), Error> {
    let state = state.get_mut(..LENGTH).ok_or(Error::StateTooShort)?;
    state.fill(0.0);
    state.iter_mut().take(1).for_each(|tag| *tag = Kind::TwoDirectionsState.tag(0));
    Ok(())
}

/// Checks the length and the tag of a state.
///
/// # Errors
/// `StateTooShort` for fewer than [`state_length`] doubles; `BadState` for an array that is no state.
#[inline(always)]
pub(crate) fn check_header(state: &[f64]) -> Result<(), Error> {
    if state.len() < LENGTH {
        return Err(Error::StateTooShort);
    }
    check_tag(state.first().copied().unwrap_or(0.0), state.len())
}

/// Rejects the tag of what is no state of that length.
#[inline(always)]
pub(crate) fn check_tag(tag: f64, _state_length: usize) -> Result<(), Error> {
    if Kind::TwoDirectionsState.count(tag) == Some(0) { Ok(()) } else { Err(Error::BadState) }
}

/// Validates a state in full. For states from outside the process.
///
/// # Errors
/// `StateTooShort`; `BadState` for an array that was not initialised, or whose values no history leads to.
pub fn state_check(state: &[f64]) -> Result<(), Error> {
    check_header(state)?;
    if state.iter().take(LENGTH).all(|value| is_finite(*value)) { Ok(()) } else { Err(Error::BadState) }
}

/// A bound on the error of the force \[N\]; 0.
#[must_use]
pub fn force_error(_state: &[f64]) -> f64 {
    0.0
}

/// Checks the displacement of a step.
///
/// # Errors
/// `BadDisplacement`, `BadNormalForce` or `LengthTooShort`.
#[inline(always)]
pub(crate) fn check_step(element: &Element, &[u, v, input]: &[f64; 3]) -> Result<(), Error> {
    check_displacement(u)?;
    check_displacement(v)?;
    element.check_input(input)
}

/// A step whose new state is discarded, with a state and a displacement that were checked.
pub(crate) fn trial(element: &Element, old: &[f64], displacement: [f64; 3], wanted: Wanted) -> Step {
    let header = old.first_chunk::<HEADER>().unwrap_or(&[0.0; HEADER]);
    step(element, header, displacement, wanted)
}

/// A step in place, with a state and a displacement that were checked.
pub(crate) fn advance_checked(element: &Element, state: &mut [f64], displacement: [f64; 3], wanted: Wanted) -> Step {
    let step = trial(element, state, displacement, wanted);
    if let Some([_, header @ ..]) = state.first_chunk_mut::<HEADER>() {
        let ([u, v, input], [x, y, normal]) = (displacement, step.force);
        *header = [u, v, input, x, y, normal];
    }
    step
}

/// A step in place.
///
/// # Errors
/// `StateTooShort`, `BadState`, `BadDisplacement`, `BadNormalForce` or `LengthTooShort`.
pub fn advance(element: &Element, state: &mut [f64], displacement: [f64; 3]) -> Result<Step, Error> {
    check_header(state)?;
    check_step(element, &displacement)?;
    Ok(advance_checked(element, state, displacement, Wanted { tangent: true, energy: true }))
}

/// Checks a path: three doubles per step.
///
/// # Errors
/// Those of [`check_step`].
pub(crate) fn check_path(element: &Element, path: &[f64]) -> Result<(), Error> {
    path.as_chunks().0.iter().try_for_each(|displacement| check_step(element, displacement))
}

/// Advances a state through displacements, three doubles per step.
///
/// # Errors
/// `StateTooShort`, `BadState`, `BadDisplacement`, `BadNormalForce` or `LengthTooShort`; the state is unchanged then.
pub fn path(element: &Element, state: &mut [f64], path: &[f64], output: PathOutput) -> Result<(), Error> {
    check_header(state)?;
    check_path(element, path)?;
    let wanted = Wanted { tangent: output.tangent.is_some(), energy: output.dissipated.is_some() };
    advance_along(path, output, |displacement| advance_checked(element, state, displacement, wanted));
    Ok(())
}

/// As [`path`], from a copy of the state.
pub(crate) fn path_in_copy(element: &Element, state: &[f64], steps: &[f64], output: PathOutput) -> Result<(), Error> {
    let mut copy = [0.0; LENGTH];
    copy_used(state, &mut copy);
    path(element, &mut copy, steps, output)
}

/// Copies what is in use of a state whose header was checked to one that is as long.
#[inline(always)]
pub(crate) fn copy_used(from: &[f64], to: &mut [f64]) {
    if let (Some(from), Some(to)) = (from.first_chunk::<LENGTH>(), to.first_chunk_mut::<LENGTH>()) {
        *to = *from;
    }
}

fn step(element: &Element, old: &[f64; HEADER], [u, v, input]: [f64; 3], wanted: Wanted) -> Step {
    let &[_, old_u, old_v, _, old_x, old_y, _] = old;
    let normal = if element.is_closed(input) { element.normal(input) } else { Normal::OPEN };
    let (stiffness, limit) = (element.tangential_stiffness, element.friction_coefficient * normal.load);
    let trial = [old_x + stiffness * (u - old_u), old_y + stiffness * (v - old_v)];
    let magnitude = trial[0].hypot(trial[1]);
    let slips = magnitude > limit;
    // Compilers evaluate quotients also if they are not used.
    let divisor = magnitude.max(f64::MIN_POSITIVE);
    let [cos, sin] = if slips { trial.map(|force| force / divisor) } else { [0.0; 2] };
    let [x, y] = if slips { [limit * cos, limit * sin] } else { trial };
    let mut step = Step { force: [x, y, normal.load], tangent: [0.0; 9], dissipated: 0.0 };
    if wanted.energy {
        step.dissipated = limit * ((magnitude - limit).max(0.0) / stiffness);
    }
    if wanted.tangent {
        let slope = element.friction_coefficient * normal.load_slope;
        let across = if slips { stiffness * (limit.min(magnitude) / divisor) } else { stiffness };
        step.tangent = [
            across * (1.0 - cos * cos),
            -across * cos * sin,
            0.0,
            -across * cos * sin,
            across * (1.0 - sin * sin),
            0.0,
            slope * cos,
            slope * sin,
            normal.load_slope,
        ];
    }
    step
}

/// Harmonic force of a periodic motion, by uniform sampling.
pub mod harmonic_force {
    use super::{LENGTH, Step, Wanted, advance_checked, state_init};
    use crate::error::Error;
    use crate::hbm::check_coefficients;
    use crate::hbm::workspace::{HEADER, Parts, Size, TAGS, WorkspaceLayout};
    use crate::tag::Kind;
    use crate::varying_load::element::Element;
    use core::f64::consts::TAU;

    pub use crate::hbm::HarmonicOutput;

    /// Number of doubles in a workspace for the given number of harmonics and of samples per period; 0 if these are not allowed.
    #[must_use]
    pub fn workspace_length(harmonics: usize, samples: usize) -> usize {
        Layout::new(harmonics, samples).map_or(0, |layout| layout.length())
    }

    /// Initialises a workspace: tables for the given harmonics and samples, and scratch memory.
    ///
    /// # Errors
    /// `BadHarmonics` unless 1 <= harmonics <= 2^24, `BadSamples` unless 2 harmonics < samples <= 2^24; `WorkspaceTooShort`.
    pub fn workspace_init(harmonics: usize, samples: usize, workspace: &mut [f64]) -> Result<(), Error> {
        Layout::init(harmonics, samples, workspace)
    }

    /// Number of doubles in an initialised workspace, from its header.
    ///
    /// # Errors
    /// `BadWorkspace` if uninitialised.
    pub fn workspace_extent(header: &[f64; TAGS]) -> Result<usize, Error> {
        Layout::read(header).map(|layout| layout.length())
    }

    /// Harmonics and samples of an initialised workspace, from its header.
    ///
    /// # Errors
    /// `BadWorkspace` if uninitialised.
    pub fn workspace_size(header: &[f64; TAGS]) -> Result<(usize, usize), Error> {
        Layout::read(header).map(|Layout(size)| (size.harmonics, size.samples))
    }

    struct Layout(Size);

    impl WorkspaceLayout for Layout {
        const KIND: Kind = Kind::TwoDirectionsSampling;

        fn of(size: Size) -> Layout {
            Layout(size)
        }

        fn size(&self) -> Size {
            self.0
        }

        fn max_rows(&self) -> usize {
            2 * self.0.samples + 16
        }

        fn tables_length(&self) -> usize {
            0
        }

        fn length(&self) -> usize {
            HEADER + 4 * self.0.samples
        }

        fn fill_tables(&self, _tables: &mut Parts) -> Result<(), Error> {
            Ok(())
        }
    }

    /// An opened workspace.
    #[derive(Debug)]
    pub struct Workspace<'a> {
        size: Size,
        samples: &'a mut [[f64; 4]],
    }

    impl<'a> Workspace<'a> {
        /// Opens an initialised workspace.
        ///
        /// # Errors
        /// `BadWorkspace` if uninitialised or too short.
        pub fn new(memory: &'a mut [f64]) -> Result<Workspace<'a>, Error> {
            let (Layout(size), mut parts) = Layout::open(memory)?;
            Ok(Workspace { size, samples: parts.take_blocks(size.samples)? })
        }

        /// 2H + 1.
        #[must_use]
        pub fn coefficients(&self) -> usize {
            self.size.coefficients()
        }

        /// Checks a motion: all of a batch are checked before the first output is written.
        ///
        /// # Errors
        /// Those of [`harmonic_force`].
        pub(crate) fn check(&mut self, element: &Element, displacement: &[f64]) -> Result<(), Error> {
            check_coefficients(displacement)?;
            let input = displacement.get(2 * self.coefficients()..).unwrap_or(&[]);
            let mean = input.first().copied().unwrap_or(0.0);
            let swing: f64 = input.iter().skip(1).map(|value| value.abs()).sum();
            if (element.by_approach() || mean >= swing) && element.check_input(mean + swing).is_ok() {
                return Ok(());
            }
            self.synthesise(element, displacement)
        }

        fn synthesise(&mut self, element: &Element, displacement: &[f64]) -> Result<(), Error> {
            let (size, coefficients) = (self.size, self.coefficients());
            let input = displacement.get(2 * coefficients..).unwrap_or(&[]);
            let rounding = 8.0 * f64::EPSILON * input.iter().map(|value| value.abs()).sum::<f64>();
            for (index, sample) in self.samples.iter_mut().enumerate() {
                *sample = [0.0; 4];
                for (values, place) in displacement.chunks_exact(coefficients).zip(sample.iter_mut()) {
                    *place = values.iter().enumerate().map(|(c, value)| value * basis(c, index, size.samples)).sum();
                }
                if !element.by_approach() {
                    if sample[2] < -rounding {
                        return Err(Error::BadNormalForce);
                    }
                    sample[2] = sample[2].max(0.0);
                }
                element.check_input(sample[2])?;
            }
            Ok(())
        }
    }

    /// Function c of the order `[1, cos t, sin t, ...]` at a sample.
    fn basis(c: usize, index: usize, samples: usize) -> f64 {
        let angle = TAU * (c.div_ceil(2) * index).checked_rem(samples).unwrap_or(0) as f64 / samples as f64;
        if c.is_multiple_of(2) && c > 0 { angle.sin() } else { angle.cos() }
    }

    /// Harmonic force of a periodic motion, given by its 3 (2H + 1) coefficients: those of u, of v \[m\], and of the normal
    /// component, the approach \[m\] or the normal force \[N\].
    ///
    /// The force has 3 (2H + 1) coefficients \[N\], Tx, Ty, N. The Jacobian has (3 (2H + 1))² entries, column by column: their
    /// derivatives with respect to the coefficients of the motion.
    ///
    /// # Errors
    /// `BadArraySize` if a length does not agree with the workspace; `BadDisplacement` if a coefficient is not finite or exceeds
    /// 1e150; `BadNormalForce` if a sample of the normal force is negative by more than rounding; `LengthTooShort` if the contact
    /// would become too wide for its length.
    #[inline(always)]
    pub fn harmonic_force(
        element: &Element,
        workspace: &mut Workspace,
        displacement: &[f64],
        output: HarmonicOutput,
    ) -> Result<(), Error> {
        let (coefficients, count) = (workspace.coefficients(), workspace.size.samples);
        let HarmonicOutput { mut force, mut jacobian, dissipated } = output;
        let n = 3 * coefficients;
        let fits = |output: &Option<&mut [f64]>, length: usize| output.as_ref().is_none_or(|o| o.len() == length);
        if displacement.len() != n || !fits(&force, n) || !fits(&jacobian, n * n) {
            return Err(Error::BadArraySize);
        }
        check_coefficients(displacement)?;
        workspace.synthesise(element, displacement)?;
        let mut state = [0.0; LENGTH];
        state_init(&mut state)?;
        let wanted = Wanted { tangent: true, energy: true };
        force.as_deref_mut().unwrap_or(&mut []).fill(0.0);
        jacobian.as_deref_mut().unwrap_or(&mut []).fill(0.0);
        let mut energy = 0.0;
        for (index, position) in (0..count).chain(0..count).enumerate() {
            let &[u, v, input, _] = workspace.samples.get(position).unwrap_or(&[0.0; 4]);
            let Step { force: values, tangent, dissipated } =
                advance_checked(element, &mut state, [u, v, input], wanted);
            if index < count {
                continue;
            }
            energy += dissipated;
            let weight = |c: usize| if c == 0 { 1.0 } else { 2.0 } / count as f64 * basis(c, position, count);
            for (i, place) in force.as_deref_mut().unwrap_or(&mut []).iter_mut().enumerate() {
                *place += weight(i % coefficients) * values.get(i / coefficients).unwrap_or(&0.0);
            }
            for (k, place) in jacobian.as_deref_mut().unwrap_or(&mut []).iter_mut().enumerate() {
                let (i, j) = (k % n, k / n);
                let slope = tangent.get(i / coefficients + 3 * (j / coefficients)).unwrap_or(&0.0);
                *place += weight(i % coefficients) * slope * basis(j % coefficients, position, count);
            }
        }
        dissipated.into_iter().for_each(|place| *place = energy);
        Ok(())
    }
}
