//! Harmonic force of a periodic motion in two tangential directions, by uniform sampling.
//!
//! The motion is u, v and the normal component (the approach w or the normal force N), each
//! `c0 + Σ (a_k cos kt + b_k sin kt)`, at uniformly spaced samples from t = 0. Between the samples the path is that
//! of a step of the element. Steady state: the contact is first pressed by the largest normal force of the samples (the
//! first such sample), without tangential displacement, and then displaced to that sample under constant load. From
//! there it is advanced along a number of periods, and along one more that is evaluated. The nodes are those of the
//! largest normal force.
//!
//! A vibration relaxes static shear over many periods. Those before the last two are advanced by fewer samples, and
//! after the second of them the springs are extrapolated; the drift estimates the change that remains.
//!
//! The Jacobian is the exact derivative of all this: changes of the springs by all coefficients are propagated. What
//! the parameters of the contact add, the load at both ends and the reference size of the nodes, is computed once a
//! step; the changes are propagated for a few coefficients at once.

use super::matrix::dot;
use super::moving_nodes::{State, Step};
use super::nodes::{Nodes, PerAxis, Units, by_axis, length};
use super::path::ContactPath;
use super::step::{Displacements, LoadedContact, SolvedStep};
use super::tangent::{ContactSlopes, ParameterChanges, PerParameter, Propagation, StepTangent};
use crate::element::{Element, NORMAL_FORCE_ROUNDING, NormalState};
use crate::error::Error;
use crate::fourier::workspace::{Layout, Parts, SamplingSize};
use crate::fourier::{basis, normalise, work};
use crate::limits::check_coefficients;
use crate::numerics::guard::quotient;
use crate::numerics::lanes::Lanes;
use crate::numerics::record::{Record, doubles_mut, record};
use crate::numerics::slices::{PanicFreeSlice, Zero};
use crate::tag::Kind;
use core::iter;

pub use crate::fourier::HarmonicOutput;

/// Number of doubles in a workspace for the given number of harmonics and of samples per period; 0 if these are not
/// allowed.
pub fn workspace_length(harmonics: usize, samples: usize) -> usize {
    TwoDirectionsWorkspace::length_or_zero(SamplingSize { harmonics, samples, periods: 0 })
}

/// Initialises a workspace: tables for the given harmonics and samples, the number of periods before the one that
/// counts (0: the default, 4), and scratch memory.
/// Errors: `BadHarmonics` unless 1 <= harmonics <= 2^24, `BadSamples` unless 2 harmonics < samples <= 2^24,
/// `BadPeriods` for more than 65536; `WorkspaceTooShort`.
pub fn workspace_init(harmonics: usize, samples: usize, periods: usize, workspace: &mut [f64]) -> Result<(), Error> {
    TwoDirectionsWorkspace::init(SamplingSize { harmonics, samples, periods }, workspace)
}

/// Samples of a cycle of the highest harmonic, at least, in the periods that are advanced by fewer. With half of them a
/// sticking core may keep another force, which more periods do not correct.
const TRANSIENT_SAMPLES: usize = 32;

/// Factor of the extrapolation. After the second period the springs change by this factor times their change in that
/// period, if another period follows before the one that counts. So they would if each period changed them by 0.64 of
/// the change before.
const EXTRAPOLATION: f64 = 1.75;

/// Coefficients that are propagated at once, those of the normal component, of u and of v in a block each.
const BLOCK: usize = 4;
const COLUMNS: usize = 3 * BLOCK;
type Columns = Lanes<COLUMNS>;
record! {
    /// A sample of the motion, and the forces at it.
    struct Sample {
        displacement: [f64; 3],
        load: f64,
        load_slope: f64,
        /// Tangential forces.
        force: [f64; 2],
    }
}

/// An opened workspace.
#[derive(Debug)]
pub struct TwoDirectionsWorkspace<'a> {
    size: SamplingSize,
    /// Values of `[1, cos t, sin t, ...]`, sample after sample.
    basis: &'a mut [f64],
    samples: &'a mut [Sample],
    /// Changes of the springs and of both forces by the coefficients, in blocks of columns.
    spring_changes: &'a mut [Displacements<Columns>],
    force_changes: &'a mut [PerAxis<Columns>],
    /// Changes of the springs after the first period.
    earlier: &'a mut [Displacements<Columns>],
    /// Sums of the changes of the forces times each value of the basis, over the samples.
    sums: &'a mut [PerAxis<Columns>],
    force: &'a mut [f64],
}

impl<'a> Layout<'a> for TwoDirectionsWorkspace<'a> {
    const KIND: Kind = Kind::TwoDirectionsSampling;
    /// A vibration relaxes static shear over many periods: the table of `periods` in the guide has the errors.
    const PERIODS: usize = 4;

    fn max_rows(size: SamplingSize) -> usize {
        8 * size.samples + 256
    }

    fn take(size: SamplingSize, parts: &mut Parts<'a>) -> TwoDirectionsWorkspace<'a> {
        let (n, blocks) = (size.coefficients(), size.coefficients().div_ceil(BLOCK));
        TwoDirectionsWorkspace {
            size,
            basis: parts.take(n * size.samples),
            samples: parts.take_records(size.samples),
            spring_changes: parts.take_records(blocks),
            force_changes: parts.take_records(blocks),
            earlier: parts.take_records(blocks),
            sums: parts.take_records(n * blocks),
            force: parts.take(3 * n),
        }
    }

    fn fill(&mut self) {
        let (samples, n) = (self.size.samples, self.size.coefficients());
        for (sample, values) in self.basis.chunks_exact_mut(n.max(1)).enumerate() {
            values.iter_mut().enumerate().for_each(|(c, value)| *value = basis(c, sample, samples));
        }
    }
}

impl<'a> TwoDirectionsWorkspace<'a> {
    /// Opens an initialised workspace.
    /// Errors: `BadWorkspace` if uninitialised or too short.
    pub fn new(memory: &'a mut [f64]) -> Result<TwoDirectionsWorkspace<'a>, Error> {
        TwoDirectionsWorkspace::open(memory)
    }

    /// 2H + 1.
    pub fn coefficients(&self) -> usize {
        self.size.coefficients()
    }

    /// Checks a motion: all of a batch are checked before the first output is written.
    /// Errors: those of [`harmonic_force`].
    pub(crate) fn check(&mut self, element: &Element, displacement: &[f64]) -> Result<(), Error> {
        check_coefficients(displacement)?;
        if element.accepts_all_phases(displacement.part(2 * self.coefficients()..)) {
            return Ok(());
        }
        self.synthesise(element, displacement)
    }

    /// Computes and checks the motion at the samples.
    fn synthesise(&mut self, element: &Element, displacement: &[f64]) -> Result<(), Error> {
        let n = self.coefficients();
        let input = displacement.get(2 * n..).unwrap_or(&[]);
        let rounding = NORMAL_FORCE_ROUNDING * input.iter().map(|value| value.abs()).sum::<f64>();
        for (sample, basis) in self.samples.iter_mut().zip(self.basis.chunks_exact(n)) {
            for (coefficients, slot) in displacement.chunks_exact(n).zip(&mut sample.displacement) {
                *slot = coefficients.iter().zip(basis).map(|(value, basis)| value * basis).sum();
            }
            let input = &mut sample.displacement[2];
            if !element.by_approach() {
                if *input < -rounding {
                    return Err(Error::BadNormalForce);
                }
                *input = input.max(0.0);
            }
            element.check_input(*input)?;
        }
        Ok(())
    }
}

/// Harmonic force of a periodic motion, given by its 3 (2H + 1) coefficients: those of u, of v \[m\], and of
/// the normal component, the approach \[m\] or the normal force \[N\].
///
/// The force has 3 (2H + 1) coefficients \[N\], Tx, Ty, N. The Jacobian has (3 (2H + 1))² entries, column by column:
/// their derivatives with respect to the coefficients of the motion. The energy is the work of the tangential forces in
/// the period. The drift estimates the largest difference of the tangential force from the steady state, over μ times
/// the largest normal force; 0 if the contact opens.
/// Errors: `BadArraySize` if a length does not agree with the workspace; `BadDisplacement` if a coefficient is not
/// finite or exceeds 1e150; `BadNormalForce` if a sample of the normal force is negative by more than rounding;
/// `LengthTooShort` if the contact would become too wide for its length.
///
/// A circle under a constant normal force:
///
/// ```
/// use microslip::element::{Directions, Element, NormalInput};
/// use microslip::two_directions::harmonic_force::{
///     HarmonicOutput, TwoDirectionsWorkspace, harmonic_force, workspace_init, workspace_length,
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
/// let element = Element::rounded_flat(&parameters, Directions::Two, NormalInput::Force)?;
/// let mut memory = vec![0.0; workspace_length(1, 64)];
/// workspace_init(1, 64, 0, &mut memory)?;
/// let u = 200.0 / element.tangential_stiffness;
/// let motion = [0.0, u, 0.0, 0.0, 0.0, u, 800.0, 0.0, 0.0];
/// let mut force = [0.0; 9];
/// let output = HarmonicOutput { force: Some(&mut force), jacobian: None, dissipated: None, drift: None };
/// harmonic_force(&element, &mut TwoDirectionsWorkspace::new(&mut memory)?, &motion, output)?;
/// // Tx lags behind u.
/// assert!(force[1] > 0.0 && force[2] < 0.0);
/// # Ok::<(), microslip::Error>(())
/// ```
pub fn harmonic_force(
    element: &Element,
    workspace: &mut TwoDirectionsWorkspace,
    displacement: &[f64],
    output: HarmonicOutput,
) -> Result<(), Error> {
    let n = workspace.coefficients();
    output.check(3 * n, displacement)?;
    workspace.synthesise(element, displacement)?;
    let drift = integrate_periods(element, workspace, output.jacobian.is_some());
    write_outputs(workspace, displacement, output, drift);
    Ok(())
}

/// The integration along the samples of a motion.
struct PeriodIntegration<'a> {
    element: &'a Element,
    state: State,
    /// Derivatives of the nodes by the logarithm of the reference size.
    node_slopes: Nodes,
    /// The contact at the start and at the end of a step.
    contacts: [LoadedContact; 2],
    solved: SolvedStep,
    /// Derivatives of the contacts at the start and at the end, if they were computed.
    slopes: [Option<ContactSlopes>; 2],
    tangent: StepTangent,
}

impl PeriodIntegration<'_> {
    /// Advances to a sample that closes the contact.
    fn advance(&mut self, to: [f64; 3]) -> Step {
        let step = self.state.step_at_nodes(self.element, &mut self.contacts, to, &mut self.solved);
        if !step.path.constant_load {
            self.slopes = [self.slopes[1], None];
        }
        step
    }

    /// Opens the contact.
    fn open(&mut self, to: [f64; 3]) {
        (self.contacts[1], self.slopes) = (LoadedContact::default(), [None; 2]);
        let State { displacement, springs, normal_force, load_slope, .. } = &mut self.state;
        (*displacement, *springs, *normal_force, *load_slope) = (to, Displacements::ZERO, 0.0, 0.0);
    }

    /// The change of the force from other springs, over its bound.
    fn change(&self, from: &Displacements) -> f64 {
        let change = by_axis(|axis| {
            let differences = (Lanes(self.state.springs.v[axis]) - Lanes(from.v[axis])).map(f64::abs);
            dot(&self.solved.end_springs.stiffness[axis], &differences)
        });
        quotient(length(change), self.contacts[1].normal.load)
    }
}

/// Changes of the springs and of the forces after a step between samples: that at the start, that at the end, and that
/// of the largest load. `reference_by_input` is the change of the logarithm of the reference size by the largest normal
/// component over its scale.
fn differentiate(
    workspace: &mut TwoDirectionsWorkspace,
    integration: &mut PeriodIntegration,
    path: &ContactPath,
    reference_by_input: f64,
    samples: [Option<usize>; 3],
) {
    let n = workspace.coefficients();
    let [start, end, top] = samples.map(|index| index.map_or(&[][..], |index| row(workspace.basis, n, index)));
    let per_scale = 1.0 / integration.element.input_scale();
    let PeriodIntegration { state, node_slopes, contacts, solved, slopes: [first, second], tangent, .. } = integration;
    let (nodes, contacts) = (&state.nodes, contacts.each_ref());
    let slopes = |contact| ContactSlopes::new(nodes, Some(node_slopes), contact);
    let by_end = &*second.get_or_insert_with(|| slopes(contacts[1]));
    let by_start = if path.constant_load { by_end } else { &*first.get_or_insert_with(|| slopes(contacts[0])) };
    tangent.set((solved, path), contacts, [by_start, by_end], Some(node_slopes));
    for (block, (springs, forces)) in workspace.spring_changes.iter_mut().zip(&mut *workspace.force_changes).enumerate()
    {
        let (mut displacement, mut changes) = ([Columns::ZERO; 2], PerParameter::<Lanes<4>>::default());
        for lane in 0..BLOCK.min(n - BLOCK * block) {
            let [from, to, top] = [start, end, top].map(|basis| basis.or_zero(BLOCK * block + lane));
            for axis in 0..2 {
                let [per_start, per_end] = path.per_input[axis];
                displacement[axis][lane] = per_start * (per_scale * from) + per_end * (per_scale * to);
                displacement[axis][BLOCK * (axis + 1) + lane] = path.per_distance * (to - from);
            }
            // The load at the start of the first step is that of the largest one.
            changes.start[lane] = per_scale * if start.is_empty() { top } else { from };
            (changes.end[lane], changes.reference[lane]) = (per_scale * to, reference_by_input * (per_scale * top));
        }
        let parameters = ParameterChanges { tangent, changes };
        let propagation = Propagation { contacts, nodes, path, solved, parameters };
        *forces = propagation.propagate(&displacement, springs);
    }
}

/// Extrapolates values from those a period before.
fn extrapolate<T: Record>(record: &mut T, before: &mut T) {
    let pairs = doubles_mut(record).iter_mut().zip(doubles_mut(before));
    pairs.for_each(|(value, before)| *value += EXTRAPOLATION * (*value - *before));
}

/// Changes below this are set to 0: they would decay to subnormal numbers, which are slow.
const NEGLIGIBLE_CHANGE: f64 = 1e-200;

fn fade(changes: &mut Displacements<Columns>) {
    for x in doubles_mut(changes) {
        *x = if x.abs() > NEGLIGIBLE_CHANGE { *x } else { 0.0 };
    }
}

/// Integrates along the periods of a motion that was synthesised, up to the forces at the samples and the sums of their
/// derivatives: the drift. Not inlined, so that calls for one direction do not reserve its large stack frame.
#[inline(never)]
fn integrate_periods(element: &Element, workspace: &mut TwoDirectionsWorkspace, derivatives: bool) -> f64 {
    let SamplingSize { samples: count, harmonics, periods } = workspace.size;
    if derivatives {
        workspace.spring_changes.fill(Displacements::zero());
        workspace.sums.fill(Zero::zero());
    }
    let (mut largest, mut largest_input, mut opens) = (0, f64::MIN, false);
    for (index, sample) in workspace.samples.iter_mut().enumerate() {
        let [.., input] = sample.displacement;
        let normal = if element.is_closed(input) { element.normal(input) } else { NormalState::OPEN };
        (sample.load, sample.load_slope, sample.force) = (normal.load, normal.load_slope, [0.0; 2]);
        opens |= normal.load == 0.0;
        if input > largest_input {
            (largest, largest_input) = (index, input);
        }
    }
    if !(element.friction_coefficient > 0.0 && element.is_closed(largest_input)) {
        return 0.0;
    }
    // A contact that opens has no memory: whatever was before, the second period is the steady state.
    let periods = if opens { 1 } else { periods };
    let stride = count.checked_div(TRANSIENT_SAMPLES * harmonics).unwrap_or(1).max(1);
    let mut integration = PeriodIntegration {
        element,
        state: State::open([0.0, 0.0, largest_input]),
        node_slopes: Nodes::zero(),
        contacts: [LoadedContact::default(); 2],
        solved: SolvedStep::ZERO,
        slopes: [None; 2],
        tangent: StepTangent::ZERO,
    };
    let load = element.normal(largest_input).load;
    integration.state.set_nodes(element, load);
    integration.contacts[1] = integration.state.press(element, largest_input);
    let units = integration.state.units;
    let unit = element.friction_coefficient * units.load;
    if derivatives {
        integration.node_slopes = Nodes::slopes(element, &units);
    }
    // The reference size is not that of the largest load if this is below the least reference load.
    let is_reference = load >= units.load * 0.99;
    let reference_by_input = if is_reference { Units::logarithmic_slope(element, largest_input) } else { 0.0 };
    let mut previous = None;
    let (mut start, mut period_changes, mut extrapolated) = (integration.state.springs, [0.0; 2], 0.0);
    // The first step leads from no displacement to the sample of largest load.
    let steps = (0..=periods).flat_map(|period| (1..=count).map(move |place| (period, place)));
    for (period, place) in iter::once((0, 0)).chain(steps) {
        if period + 1 < periods && place < count && !place.is_multiple_of(stride) {
            continue;
        }
        let index = if largest + place < count { largest + place } else { largest + place - count };
        let to = workspace.samples.get(index).map_or([0.0; 3], |sample| sample.displacement);
        let was_closed = integration.contacts[1].normal.load > 0.0;
        let step = element.is_closed(to[2]).then(|| integration.advance(to));
        if step.is_none() {
            integration.open(to);
        }
        if derivatives {
            if step.is_none() || !was_closed {
                workspace.spring_changes.fill(Displacements::zero());
                workspace.force_changes.fill(Zero::zero());
            }
            workspace.spring_changes.iter_mut().for_each(fade);
            if let Some(step) = &step {
                differentiate(
                    workspace,
                    &mut integration,
                    &step.path,
                    reference_by_input,
                    [previous, Some(index), Some(largest)],
                );
            }
            if period == periods {
                accumulate(workspace, index, unit);
            }
        }
        previous = Some(index);
        if let (Some(sample), Some(step)) = (workspace.samples.get_mut(index), step) {
            sample.force = step.force.map(|force| unit * force);
        }
        if place == count {
            period_changes = [period_changes[1], integration.change(&start)];
            if period == 0 {
                workspace.earlier.copy_from(workspace.spring_changes);
            } else if period == 1 && periods > 2 {
                extrapolated = period_changes[1];
                extrapolate(&mut integration.state.springs, &mut start);
                let pairs = workspace.spring_changes.iter_mut().zip(&mut *workspace.earlier);
                pairs.for_each(|(changes, earlier)| extrapolate(changes, earlier));
            }
            start = integration.state.springs;
        }
    }
    if opens { 0.0 } else { remaining(period_changes).max(extrapolated.min(LEAST_DRIFT_FACTOR * period_changes[1])) }
}

fn write_outputs(
    workspace: &mut TwoDirectionsWorkspace,
    displacement: &[f64],
    HarmonicOutput { force, jacobian, dissipated, drift }: HarmonicOutput,
    own_drift: f64,
) {
    if let Some(jacobian) = jacobian {
        write_jacobian(workspace, jacobian);
    }
    if force.is_some() || dissipated.is_some() {
        transform_force(workspace);
    }
    if let Some(dissipated) = dissipated {
        let n = workspace.coefficients();
        *dissipated = work(n, displacement.part(..2 * n), workspace.force);
    }
    if let Some(force) = force {
        force.copy_from(workspace.force);
    }
    if let Some(drift) = drift {
        *drift = own_drift;
    }
}

/// An extrapolation cancels a part of the changes that follow. The drift is at least this factor times the last change,
/// or the change that was extrapolated if that is smaller.
const LEAST_DRIFT_FACTOR: f64 = 5.0;

/// The sum of the changes still to come, if they continue as a geometric sequence; these are the last two.
fn remaining([before, last]: [f64; 2]) -> f64 {
    let ratio = quotient(last.min(before), before).min(0.95);
    last * (ratio / (1.0 - ratio)).max(1.0)
}

/// The coefficients of the force, from the samples.
fn transform_force(workspace: &mut TwoDirectionsWorkspace) {
    let TwoDirectionsWorkspace { size, basis, samples, force, .. } = workspace;
    let n = size.coefficients();
    force.fill(0.0);
    for (sample, basis) in samples.iter().zip(basis.chunks_exact(n)) {
        let [x, y] = sample.force;
        for (places, value) in force.chunks_exact_mut(n).zip([x, y, sample.load]) {
            places.iter_mut().zip(basis).for_each(|(place, basis)| *place += basis * value);
        }
    }
    force.chunks_exact_mut(n).for_each(|sums| normalise(sums, 1.0 / size.samples as f64));
}

/// Writes the Jacobian of the tangential forces from the sums, and the Jacobian of the normal force.
fn write_jacobian(workspace: &TwoDirectionsWorkspace, jacobian: &mut [f64]) {
    let TwoDirectionsWorkspace { size, sums, samples, basis, spring_changes, .. } = workspace;
    let n = size.coefficients();
    jacobian.fill(0.0);
    for (j, column) in jacobian.chunks_exact_mut(3 * n).enumerate() {
        // The columns of a block are those of the normal component, of u and of v.
        let (component, coefficient) = ((j / n + 1) % 3, j % n);
        let (block, lane) = (coefficient / BLOCK, component * BLOCK + coefficient % BLOCK);
        for c in 0..n {
            for (axis, sum) in sums.or_zero(c * spring_changes.len() + block).iter().enumerate() {
                column.set(axis * n + c, sum.or_zero(lane));
            }
        }
    }
    let by_input = jacobian.part_mut(2 * n * 3 * n..);
    for (sample, basis) in samples.iter().zip(basis.chunks_exact(n)) {
        for (column, basis_j) in by_input.chunks_exact_mut(3 * n).zip(basis) {
            let places = column.part_mut(2 * n..).iter_mut().zip(basis);
            places.for_each(|(place, basis)| *place += sample.load_slope * basis_j * basis);
        }
    }
    jacobian.chunks_exact_mut(n).for_each(|sums| normalise(sums, 1.0 / size.samples as f64));
}

/// Row r of a matrix with rows of n columns.
fn row(matrix: &[f64], n: usize, r: usize) -> &[f64] {
    matrix.part(r * n..(r + 1) * n)
}

/// Adds the changes of both forces at a sample, times each value of the basis and a unit.
fn accumulate(workspace: &mut TwoDirectionsWorkspace, sample: usize, unit: f64) {
    let TwoDirectionsWorkspace { size, basis, force_changes, sums, .. } = workspace;
    let basis = row(basis, size.coefficients(), sample);
    for (sums, value) in sums.chunks_exact_mut(force_changes.len().max(1)).zip(basis) {
        for (sums, forces) in sums.iter_mut().zip(&**force_changes) {
            for axis in 0..2 {
                sums[axis] += unit * value * forces[axis];
            }
        }
    }
}
