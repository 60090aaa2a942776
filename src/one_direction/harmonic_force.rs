//! Harmonic force of a periodic motion with varying normal force and separation, by uniform sampling.
//!
//! The motion is u and the normal component (the approach w or the normal force N), each `a_0 + Σ (a_k cos kt + b_k sin kt)`, at
//! uniformly spaced instants from t = 0. Between the samples the path is that of a step of the element. Steady state: the element
//! is pressed by the normal force of the sample at which that is largest (the first such sample) with no tangential displacement,
//! is displaced to that sample at constant normal force, and advanced along two periods from there; the second one counts. It is
//! known in closed form at one sample, so one period is evaluated, and half of one if it is half-wave symmetric.
//!
//! - `samples`: normal states, characteristic coordinates, entry into the steady state;
//! - `runs`: the memory diagram along the period, without evaluating any force;
//! - `forces`: the tangential forces;
//! - `jacobian`: their exact derivatives.

mod forces;
mod jacobian;
mod runs;
mod samples;

pub use crate::fourier::HarmonicOutput;

use crate::element::{Element, NORMAL_FORCE_ROUNDING};
use crate::error::Error;
use crate::fourier::folded::{FoldedFourier, sample_length};
use crate::fourier::rows::{OuterProducts, Rows, row_blocks};
use crate::fourier::sampled_jacobian::Assembly;
use crate::fourier::workspace::{Layout, Parts, SamplingSize};
use crate::fourier::{largest_of, normalise, work};
use crate::limits::check_coefficients;
use crate::numerics::slices::{PanicFreeSlice, Stack};
use crate::tag::Kind;
use forces::Forces;
use jacobian::{Context, JacobianMemory};
use runs::PeriodicPath;
use samples::{EvaluatedPart, Samples};

/// Number of doubles in a workspace for the given number of harmonics and of samples per period; 0 if these are not allowed.
pub fn workspace_length(harmonics: usize, samples: usize) -> usize {
    OneDirectionWorkspace::length_or_zero(SamplingSize { harmonics, samples, periods: 0 })
}

/// Initialises a workspace: tables for the given harmonics and samples, and scratch memory.
/// Errors: `BadHarmonics` unless 1 <= harmonics <= 2^24, `BadSamples` unless 2 harmonics < samples <= 2^24; `WorkspaceTooShort`.
pub fn workspace_init(harmonics: usize, samples: usize, workspace: &mut [f64]) -> Result<(), Error> {
    OneDirectionWorkspace::init(SamplingSize { harmonics, samples, periods: 0 }, workspace)
}

/// An opened workspace.
pub struct OneDirectionWorkspace<'a> {
    size: SamplingSize,
    fourier: FoldedFourier<'a>,
    samples: Samples<'a>,
    path: PeriodicPath<'a>,
    forces: Forces<'a>,
    jacobian_memory: JacobianMemory<'a>,
    assembly: Assembly<'a>,
}

impl<'a> OneDirectionWorkspace<'a> {
    /// Opens an initialised workspace.
    /// Errors: `BadWorkspace` if uninitialised or too short.
    pub fn new(memory: &'a mut [f64]) -> Result<OneDirectionWorkspace<'a>, Error> {
        OneDirectionWorkspace::open(memory)
    }

    /// 2H + 1.
    pub fn coefficients(&self) -> usize {
        self.size.coefficients()
    }
}

impl<'a> Layout<'a> for OneDirectionWorkspace<'a> {
    const KIND: Kind = Kind::ElementSampling;

    fn fill(&mut self) {
        self.fourier.fill();
        self.jacobian_memory.rows.fill();
    }

    fn take(size: SamplingSize, parts: &mut Parts<'a>) -> OneDirectionWorkspace<'a> {
        let SamplingSize { harmonics, samples: count, .. } = size;
        // At most one knot, piece and run per sample, and a few more.
        let capacity = count + 4;
        let fourier = FoldedFourier::take(parts, count, 2 * harmonics);
        let rows = Rows::take(parts, harmonics, count);
        let [displacement, input, load, shift, load_slope, shift_slope, stiffness, xi, eta] =
            parts.take_arrays(sample_length(count));
        let samples = Samples { count, displacement, input, load, shift, load_slope, shift_slope, stiffness, xi, eta };
        let [force, cut_shift, cut_load, cut_stiffness, slope, by_u, by_input, places] =
            parts.take_arrays(sample_length(count));
        let forces =
            Forces { force, cut_load, cut_stiffness, slope, last_cut: parts.take_records(sample_length(count)) };
        let (knots, runs) = (parts.take_records(capacity), parts.take_records(capacity));

        let (knots, runs) = (Stack { values: knots, depth: 0 }, Stack { values: runs, depth: 0 });
        let path = PeriodicPath { knots, runs, cut_shift, cut_count: 0 };
        let pieces = parts.take_records(capacity);
        let stored = parts.take_blocks(2 * row_blocks(harmonics) * capacity);
        let outer = OuterProducts::take(parts, harmonics, count, 2);
        let assembly = Assembly::take(parts, harmonics, 1.0 / count as f64);
        let jacobian_memory = JacobianMemory { rows, pieces, stored, places, outer, own: [by_u, by_input] };
        OneDirectionWorkspace { size, fourier, samples, path, forces, jacobian_memory, assembly }
    }
}

/// Harmonic force of a periodic motion, given by its 2 (2H + 1) coefficients: those of u \[m\], then those of the normal component,
/// the approach \[m\] or the normal force \[N\].
///
/// The force has 2 (2H + 1) coefficients \[N\], T then N. The Jacobian has (2 (2H + 1))² entries, column by column: their
/// derivatives with respect to the coefficients of the motion. It is the exact derivative of the discrete force, one-sided at
/// corners. The energy is the work of T. Errors: `BadArraySize` if a length does not agree with the workspace; `BadDisplacement` if
/// a coefficient is not finite or exceeds 1e150; `BadNormalForce` if a sample of the normal force is negative by more than
/// rounding; `LengthTooShort` if the contact would become too wide for its length.
///
/// A vibration while the normal force varies in phase:
///
/// ```
/// use microslip::element::{Directions, Element, NormalInput};
/// use microslip::one_direction::harmonic_force::{
///     HarmonicOutput, OneDirectionWorkspace, harmonic_force, workspace_init, workspace_length,
/// };
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
/// let element = Element::rounded_flat(&parameters, Directions::One, NormalInput::Force)?;
/// let mut memory = vec![0.0; workspace_length(1, 64)];
/// workspace_init(1, 64, &mut memory)?;
/// let u = 200.0 / element.tangential_stiffness;
/// let motion = [0.0, u, 0.0, 800.0, 300.0, 0.0];
/// let mut force = [0.0; 6];
/// let output = HarmonicOutput { force: Some(&mut force), jacobian: None, dissipated: None, drift: None };
/// harmonic_force(&element, &mut OneDirectionWorkspace::new(&mut memory)?, &motion, output)?;
/// // The second half is the normal force itself.
/// assert!(force[1] > 0.0 && (force[4] - 300.0).abs() < 1e-9);
/// # Ok::<(), microslip::Error>(())
/// ```
pub fn harmonic_force(
    element: &Element,
    workspace: &mut OneDirectionWorkspace,
    displacement: &[f64],
    output: HarmonicOutput,
) -> Result<(), Error> {
    let coefficients = workspace.coefficients();
    output.check(2 * coefficients, displacement)?;
    let HarmonicOutput { force, jacobian, dissipated, drift } = output;
    let (tangential, input) = displacement.split_at_checked(coefficients).unwrap_or((&[], &[]));
    let least_input = workspace.press(element, input, jacobian.is_some())?;
    let OneDirectionWorkspace { fourier, samples, path, forces, jacobian_memory, .. } = workspace;
    fourier.synthesise(tangential, samples.displacement);
    let has = |coefficients: &[f64], parity: usize| {
        coefficients.iter().enumerate().any(|(c, value)| c.div_ceil(2) % 2 == parity && *value != 0.0)
    };
    let half_wave = samples.count.is_multiple_of(2) && !has(tangential, 0) && !has(input, 1);
    let part = samples.enter_steady_state(element, half_wave, least_input);
    let (runs, cut_shift) = path.evaluate(element, samples, &part);
    if jacobian.is_none() {
        forces.evaluate::<false>(element, samples, cut_shift, runs);
    } else {
        forces.evaluate::<true>(element, samples, cut_shift, runs);
        let context = Context {
            element,
            samples,
            part: &part,
            cut_shifts: cut_shift.as_flattened(),
            cut_loads: forces.cut_load,
            cut_stiffnesses: forces.cut_stiffness,
            slopes: forces.slope,
        };
        jacobian_memory.gather(&context, runs);
    }
    if let Some(drift) = drift {
        *drift = 0.0;
    }
    let (to, normal) = force.and_then(|force| force.split_at_mut_checked(coefficients)).unzip();
    if to.is_some() || dissipated.is_some() {
        // The Jacobian has used the slopes.
        let to = to.unwrap_or(forces.slope.part_mut(..coefficients));
        fourier.sum_half_wave(part.start, half_wave.then_some(-1.0), forces.force, to);
        normalise(to, 1.0 / samples.count as f64);
        if let Some(dissipated) = dissipated {
            *dissipated = work(coefficients, tangential, to);
        }
    }
    if let Some(normal) = normal {
        if element.by_approach() {
            fourier.sum(samples.load, normal);
            normalise(normal, 1.0 / samples.count as f64);
        } else {
            normal.copy_from(input);
        }
    }
    if let Some(jacobian) = jacobian {
        workspace.write_jacobian(element, &part, jacobian);
    }
    Ok(())
}

impl OneDirectionWorkspace<'_> {
    /// Checks a motion: all of a batch are checked before the first output is written.
    pub(crate) fn check(&mut self, element: &Element, displacement: &[f64]) -> Result<(), Error> {
        check_coefficients(displacement)?;
        let (_, input) = displacement.split_at_checked(self.coefficients()).ok_or(Error::BadArraySize)?;
        if element.accepts_all_phases(input) {
            return Ok(());
        }
        self.press(element, input, false).map(|_| ())
    }

    /// Evaluates the normal states of the samples, and returns the least normal component.
    /// Errors: `BadNormalForce`, `LengthTooShort`.
    fn press(&mut self, element: &Element, input: &[f64], with_slopes: bool) -> Result<f64, Error> {
        let OneDirectionWorkspace { fourier, samples, .. } = self;
        let Some((&mean, harmonics)) = input.split_first() else { return Err(Error::BadArraySize) };
        let amplitude: f64 = harmonics.iter().map(|value| value.abs()).sum();
        fourier.synthesise(input, samples.input);
        let [least, largest] = [-largest_of(samples.input, |input| -input), largest_of(samples.input, |input| input)];
        if !element.by_approach() && least < -NORMAL_FORCE_ROUNDING * (mean.abs() + amplitude) {
            return Err(Error::BadNormalForce);
        }
        element.check_input(largest.max(0.0))?;
        if !element.is_closed(least) {
            let open = |input: f64| if element.is_closed(input) { input } else { input.min(0.0) };
            samples.input.iter_mut().for_each(|input| *input = open(*input));
        }
        if with_slopes {
            samples.press::<true>(element);
        } else {
            samples.press::<false>(element);
        }
        Ok(least)
    }

    fn write_jacobian(&mut self, element: &Element, part: &EvaluatedPart, jacobian: &mut [f64]) {
        let OneDirectionWorkspace { size, fourier, samples, jacobian_memory, assembly, .. } = self;
        let coefficients = size.coefficients();
        let (by_displacement, by_input) =
            jacobian.split_at_mut_checked(2 * coefficients * coefficients).unwrap_or((&mut [], &mut []));
        let parts = [(&mut *by_displacement, 1.0), (&mut *by_input, -1.0)];
        for (index, ((columns, sign), own)) in parts.into_iter().zip(&mut jacobian_memory.own).enumerate() {
            let symmetry = part.half_wave.then_some(sign);
            fourier.sum_half_wave(part.start, symmetry, own, assembly.sums);
            assembly.set_products(&jacobian_memory.outer, index);
            assembly.write(symmetry, columns, 2 * coefficients);
            for column in columns.chunks_exact_mut(2 * coefficients) {
                column.iter_mut().skip(coefficients).for_each(|value| *value = 0.0);
            }
        }
        if element.by_approach() {
            fourier.sum(samples.load_slope, assembly.sums);
            assembly.write_sums(by_input, 2 * coefficients, coefficients);
        } else {
            for (row, column) in (coefficients..).zip(by_input.chunks_exact_mut(2 * coefficients)) {
                column.set(row, 1.0);
            }
        }
    }
}
