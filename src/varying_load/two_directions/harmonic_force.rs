//! Harmonic force of a periodic motion, by uniform sampling.

use super::{LENGTH, Requested, Step, advance_checked, state_init};
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
    let requested = Requested { tangent: true, energy: true };
    force.as_deref_mut().unwrap_or(&mut []).fill(0.0);
    jacobian.as_deref_mut().unwrap_or(&mut []).fill(0.0);
    let mut energy = 0.0;
    for (index, position) in (0..count).chain(0..count).enumerate() {
        let &[u, v, input, _] = workspace.samples.get(position).unwrap_or(&[0.0; 4]);
        let Step { force: values, tangent, dissipated } =
            advance_checked(element, &mut state, [u, v, input], requested);
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
