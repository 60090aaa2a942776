//! Event-driven harmonic force: piecewise Gauss-Legendre quadrature between the events of a period.
//!
//! The force of a periodic displacement is smooth except at events: reversals, closures of loops, the onset of gross slip. Uniform
//! samples miss them, with an error of O(samples⁻²). Here the events are found as roots of the rate and as crossings of the ends of
//! branches, and each segment between two events has its own rule: the error decreases exponentially with the number of nodes.
//! The energy depends on the reversals only and has no quadrature error.
//!
//! The Jacobian is the same rule applied to the exact derivative of the integrals,
//!
//! ```text
//! dF = ∫ φ dT dt,
//! ```
//!
//! which does not contain the derivatives of the events because the force is continuous there. The derivative of the quadrature sum
//! would in addition contain the derivative of the quadrature error times that of the events, `dt_e = -φ'/ü`, which is unbounded
//! as two reversals merge. The two differ by the error of the rule.

use super::motion::{Grid, Instant, Motion, fill_integrals, fill_phi};
use super::segments::{NodalFourier, PANEL, Segment};
use super::sensitivity::ReversalSensitivities;
use super::{HarmonicOutput, RequestedOfCurve};
use crate::constant_load::contact::Contact;
use crate::constant_load::evaluator::Response;
use crate::constant_load::memory::{Point, Reversal};
use crate::constant_load::steady_state::SteadyState;
use crate::fourier::folded::{FoldedFourier, sample_length};
use crate::fourier::rows::row_blocks;
use crate::fourier::sampled_jacobian::Assembly;
use crate::fourier::workspace::{Blocks, Layout, Parts, SamplingSize};
use crate::fourier::{complete_half_wave, normalise};
use crate::numerics::slices::PanicFreeSlice;
use crate::parameters::PARAMETERS;
use crate::tag::Kind;
use core::f64::consts::PI;

/// Number of points of the search grid: even, and at least sixteen per period of the highest harmonic. Three reversals within two
/// grid steps h may be counted as one; the missed loop is `h⁴/24` times the fourth derivative wide, at most a thousandth of the
/// amplitude.
fn grid_points(size: SamplingSize) -> usize {
    (size.samples.max(16 * size.harmonics) + 1) & !1
}

/// Capacity for reversals: a displacement has at most 2H per period; more are due to rounding.
fn most_reversals(size: SamplingSize) -> usize {
    4 * size.harmonics + 8
}

/// An opened workspace.
pub(super) struct EventWorkspace<'a> {
    /// The stack of reversals of the steady state.
    reversals: &'a mut [Reversal],
    buffers: Buffers<'a>,
}

/// Tables, events and integrals.
struct Buffers<'a> {
    harmonics: usize,
    grid: Grid<'a>,
    /// Instant and displacement of each reversal of the motion.
    instants: &'a mut [Instant],
    nodes: NodalFourier<'a>,
    /// The rows φ_r and dT_r over the coefficients, for each reversal on the stack.
    gradients: &'a mut Blocks,
    /// ∫ φ over a segment, up to the order H.
    phi_integrals: &'a mut Blocks,
    /// ∫ k φ over a segment, up to the order 2H.
    segment_stiffness: &'a mut Blocks,
    /// Integrals of the force over the period, times φ.
    force: &'a mut [f64],
    /// The Jacobian under assembly: integrals of the stiffness over the period, and outer products of the reversals.
    assembly: Assembly<'a>,
}

impl<'a> Layout<'a> for EventWorkspace<'a> {
    const KIND: Kind = Kind::EventDriven;

    fn max_rows(size: SamplingSize) -> usize {
        grid_points(size) + most_reversals(size) + PANEL
    }

    fn fill(&mut self) {
        self.buffers.grid.fourier.fill();
    }

    fn take(size: SamplingSize, parts: &mut Parts<'a>) -> EventWorkspace<'a> {
        let (points, row, reversals) = (grid_points(size), row_blocks(size.harmonics), most_reversals(size));
        let buffers = Buffers {
            harmonics: size.harmonics,
            grid: Grid {
                points,
                fourier: FoldedFourier::take(parts, points, size.harmonics.next_multiple_of(2)),
                coefficients: parts.take(size.coefficients()),
                rate: parts.take(sample_length(points)),
            },
            instants: parts.take_records(points),
            nodes: NodalFourier::take(parts, size),
            gradients: parts.take_blocks(2 * row * reversals),
            phi_integrals: parts.take_blocks(row),
            segment_stiffness: parts.take_blocks(2 * row),
            force: parts.take(size.coefficients()),
            assembly: Assembly::take(parts, size.harmonics, 0.5 / PI),
        };
        EventWorkspace { reversals: parts.take(3 * reversals).blocks_mut(), buffers }
    }
}

/// Computes the requested outputs.
pub(super) fn harmonic_force(
    contact: &Contact,
    workspace: &mut EventWorkspace,
    displacement: &[f64],
    output: HarmonicOutput,
) {
    let EventWorkspace { reversals, buffers } = workspace;
    let HarmonicOutput { force, jacobian, dissipated, .. } = output;
    let steady_state = SteadyState::new(contact, reversals, dissipated.is_some());
    let requested = RequestedOfCurve { force: force.is_some(), stiffness: jacobian.is_some() };
    let mut period = Period {
        steady_state,
        requested,
        motion: Motion::new(displacement),
        now: Response::default(),
        sensitivity: None,
    };
    let half_wave_symmetric = period.integrate(buffers);
    if let (Some(dissipated), Some(energy)) = (dissipated, period.steady_state.dissipated()) {
        *dissipated = if half_wave_symmetric { 2.0 * energy } else { energy };
    }
    if let Some(force) = force {
        force.copy_from(buffers.force);
        complete(force, half_wave_symmetric);
    }
    if let Some(jacobian) = jacobian {
        if half_wave_symmetric {
            complete_half_wave(buffers.assembly.sums, 1.0);
        }
        buffers.assembly.write(half_wave_symmetric.then_some(1.0), jacobian, buffers.coefficients());
    }
}

/// Computes the derivatives with respect to the parameters.
pub(super) fn harmonic_sensitivity(
    contact: &Contact,
    workspace: &mut EventWorkspace,
    displacement: &[f64],
    sensitivity: &mut [f64],
) {
    let EventWorkspace { reversals, buffers } = workspace;
    sensitivity.fill(0.0);
    let steady_state = SteadyState::new(contact, reversals, false);
    let (requested, motion, now) = (RequestedOfCurve::default(), Motion::new(displacement), Response::default());
    let mut period = Period { steady_state, requested, motion, now, sensitivity: Some(&mut *sensitivity) };
    let half_wave_symmetric = period.integrate(buffers);
    for column in sensitivity.chunks_exact_mut(buffers.coefficients()) {
        complete(column, half_wave_symmetric);
    }
}

/// Scales integrals of a force, those over half a period if `half_wave_symmetric`, to coefficients.
fn complete(integrals: &mut [f64], half_wave_symmetric: bool) {
    if half_wave_symmetric {
        complete_half_wave(integrals, -1.0);
    }
    normalise(integrals, 0.5 / PI);
}

/// Adds a row times a factor.
fn add_scaled(sums: &mut [f64], factor: f64, row: &Blocks) {
    sums.iter_mut().zip(row.as_flattened()).for_each(|(sum, value)| *sum += factor * value);
}

impl Buffers<'_> {
    /// 2H + 1.
    fn coefficients(&self) -> usize {
        2 * self.harmonics + 1
    }

    /// Blocks of a row over the coefficients.
    fn row(&self) -> usize {
        self.phi_integrals.len().max(1)
    }

    fn instant(&self, index: usize) -> Instant {
        self.instants.or_zero(index)
    }
}

/// Integration over a period, event by event.
struct Period<'m, 'c, 's> {
    steady_state: SteadyState<'c, 's>,
    requested: RequestedOfCurve,
    motion: Motion<'m>,
    /// Force and stiffness at the present instant.
    now: Response,
    /// Integrals of the derivatives with respect to the parameters, if requested.
    sensitivity: Option<&'m mut [f64]>,
}

impl Period<'_, '_, '_> {
    /// Integrates a period, or half of it if it is half-wave symmetric, from the farthest reversal. Returns whether it is half-wave
    /// symmetric.
    fn integrate(&mut self, buffers: &mut Buffers) -> bool {
        let (count, half_wave_symmetric) = self.motion.find_reversals(&mut buffers.grid, buffers.instants);
        let span = if half_wave_symmetric { PI } else { 2.0 * PI };
        buffers.force.fill(0.0);
        buffers.assembly.clear();
        if count == 0 {
            self.integrate_constant(buffers, span);
            return half_wave_symmetric;
        }
        let distance = |index: usize| buffers.instant(index).displacement.abs();
        let first = (1..count).fold(0, |first, index| if distance(index) > distance(first) { index } else { first });
        let mut from = buffers.instant(first);
        self.now = self.steady_state.begin(from.displacement);
        for index in (first + 1..count).chain(0..=first) {
            let Instant { t, displacement } = buffers.instant(index);
            let to = if index > first {
                Instant { t, displacement }
            } else {
                Instant { t: t + span, displacement: if half_wave_symmetric { -displacement } else { displacement } }
            };
            self.integrate_half_cycle(buffers, from, to);
            from = to;
        }
        half_wave_symmetric
    }

    /// Integrates a constant displacement.
    fn integrate_constant(&mut self, buffers: &mut Buffers, span: f64) {
        self.now = self.steady_state.begin(self.motion.mean);
        buffers.force.set(0, span * self.now.force);
        buffers.assembly.sums.set(0, span * self.now.stiffness);
        if let Some(sums) = &mut self.sensitivity {
            let derivatives = self.steady_state.sensitivity(self.motion.mean);
            for (column, derivative) in sums.chunks_exact_mut(buffers.coefficients()).zip(derivatives) {
                column.set(0, span * derivative);
            }
        }
    }

    /// Integrates from one reversal of the motion to the next, along one branch and its continuations.
    fn integrate_half_cycle(&mut self, buffers: &mut Buffers, from: Instant, to: Instant) {
        let present = self.steady_state.branch().direction;
        let change = to.displacement - from.displacement;
        let direction = if change == 0.0 { present } else { change.signum() };
        if direction != present {
            self.reverse(buffers, from, direction);
        }
        let mut at = from;
        loop {
            let branch = self.steady_state.branch();
            let end = branch.end;
            if branch.gross_slip || direction * (to.displacement - end) < 0.0 {
                self.integrate_segment(buffers, at, to, false);
                break;
            }
            let t = if to.displacement == end { to.t } else { self.motion.crossing(at, from, to, end) };
            let event = Instant { t, displacement: end };
            let next = self.steady_state.continuation();
            self.integrate_segment(buffers, at, event, next.gross_slip);
            self.steady_state.enter(next);
            at = event;
        }
        self.now = self.steady_state.branch().response(self.steady_state.contact, to.displacement);
    }

    /// Makes an instant the newest reversal on the stack and stores its derivatives.
    fn reverse(&mut self, buffers: &mut Buffers, at: Instant, direction: f64) {
        let left = self.steady_state.branch().depth;
        let mut stack = ReversalSensitivities::new(buffers.gradients.as_flattened_mut());
        let sensitivity = self.sensitivity.is_some().then(|| stack.sensitivity(&self.steady_state, at.displacement));
        self.steady_state.reverse(Point { displacement: at.displacement, force: self.now.force }, direction);
        if let Some(sensitivity) = sensitivity {
            return stack.store(&self.steady_state, sensitivity);
        }
        let row = buffers.row();
        let mut stack = buffers.gradients.chunks_exact_mut((2 * row).max(1)).skip(left.saturating_sub(1));
        let older = if left > 0 { stack.next() } else { None };
        if self.requested.stiffness
            && let Some((phi, gradient)) = stack.next().and_then(|rows| rows.split_at_mut_checked(row))
        {
            let k = self.now.stiffness;
            let (phi, gradient) = (phi.as_flattened_mut(), gradient.as_flattened_mut());
            fill_phi(phi.part_mut(..2 * buffers.harmonics + 1), at.t);
            gradient.iter_mut().zip(phi.iter()).for_each(|(gradient, phi)| *gradient = k * phi);
            if let Some((phi, before)) = older.and_then(|rows| rows.split_at_checked(row)) {
                add_scaled(gradient, 1.0, before);
                add_scaled(gradient, -k, phi);
            }
        }
    }

    /// Adds a segment of the present branch to the integrals and the energy. `to_slip`: gross slip starts at its end.
    fn integrate_segment(&mut self, buffers: &mut Buffers, from: Instant, to: Instant, to_slip: bool) {
        self.steady_state.account_for(from.displacement, to.displacement);
        let RequestedOfCurve { force, stiffness } = self.requested;
        if to.t <= from.t || !(force || stiffness || self.sensitivity.is_some()) {
            return;
        }
        let branch = self.steady_state.branch();
        let coefficients = buffers.coefficients();
        let segment = Segment { from: from.t, to: to.t, to_slip, has_knee: self.steady_state.contact.has_knee() };
        if let Some(sums) = &mut self.sensitivity {
            let stack = ReversalSensitivities::new(buffers.gradients.as_flattened_mut());
            let mut columns = sums.chunks_exact_mut(coefficients);
            let sums: [_; PARAMETERS] = core::array::from_fn(|_| columns.next().unwrap_or_default());
            let derivatives = |displacement| stack.sensitivity(&self.steady_state, displacement);
            return buffers.nodes.integrate(&self.motion, segment, buffers.harmonics, derivatives, sums);
        }
        let orders = if stiffness { 2 * buffers.harmonics } else { buffers.harmonics };
        let Buffers { nodes, segment_stiffness, assembly, force: force_sums, .. } = buffers;
        let sums = segment_stiffness.as_flattened_mut().part_mut(..2 * coefficients - 1);
        sums.fill(0.0);
        let values = |displacement| {
            let Response { force, stiffness } = branch.response(self.steady_state.contact, displacement);
            [force, stiffness]
        };
        let requested = [if force { &mut **force_sums } else { &mut [] }, if stiffness { &mut *sums } else { &mut [] }];
        nodes.integrate(&self.motion, segment, orders, values, requested);
        if stiffness {
            assembly.sums.iter_mut().zip(sums).for_each(|(sum, segment)| *sum += *segment);
            let Buffers { gradients, phi_integrals, segment_stiffness, assembly, .. } = buffers;
            fill_integrals(phi_integrals.as_flattened_mut().part_mut(..coefficients), from.t, to.t);
            let row = phi_integrals.len().max(1);
            let rows = gradients.chunks_exact((2 * row).max(1)).nth(branch.depth.wrapping_sub(1));
            if let Some((phi, gradient)) = rows.and_then(|rows| rows.split_at_checked(row)) {
                let columns = [gradient, phi].map(<[_]>::as_flattened);
                assembly.add_products(columns, [phi_integrals, segment_stiffness.part(..row)]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Contact;
    use crate::constant_load::contact::tests::{FLATS, contact, ellipse};
    use crate::constant_load::harmonic_force::Rule;
    use crate::constant_load::harmonic_force::tests::{All, ODD, SHAPE, compute, scaled, workspace};
    use std::vec::Vec;

    fn all(contact: &Contact, nodes: usize, displacement: &[f64]) -> All {
        compute(contact, &mut workspace(Rule::EventDriven, displacement.len() / 2, nodes), displacement)
    }

    const FIVE: [f64; 11] = [0.1, 0.7, 0.0, 0.1, 0.3, -0.2, 0.2, 0.15, -0.1, 0.1, 0.2];

    fn contacts() -> impl Iterator<Item = Contact> {
        FLATS.map(contact).into_iter().chain([ellipse(1e-4, 2e-4)])
    }

    /// Coefficients of the function shifted in time: each pair is rotated by its order times the shift.
    fn shift(vector: &[f64], by: f64) -> Vec<f64> {
        let mut shifted = vector.to_vec();
        for k in 1..=vector.len() / 2 {
            let (sine, cosine) = (k as f64 * by).sin_cos();
            let (a, b) = (vector[2 * k - 1], vector[2 * k]);
            shifted[2 * k - 1] = cosine * a + sine * b;
            shifted[2 * k] = cosine * b - sine * a;
        }
        shifted
    }

    /// Force, Jacobian and energy of the motion shifted in time: rows and columns of the matrix are rotated.
    fn shift_all((force, jacobian, energy): &All, by: f64) -> All {
        let n = force.len();
        let columns = |matrix: &[f64]| matrix.chunks(n).flat_map(|column| shift(column, by)).collect::<Vec<_>>();
        let transposed = |matrix: Vec<f64>| (0..n * n).map(|i| matrix[i / n + n * (i % n)]).collect::<Vec<_>>();
        (shift(force, by), transposed(columns(&transposed(columns(jacobian)))), *energy)
    }

    /// Compares force over mu N, Jacobian over the initial stiffness and energy over itself.
    fn check(contact: &Contact, found: &All, expected: &All, tolerances: [f64; 3], what: &str) {
        let distance =
            |one: &[f64], two: &[f64]| one.iter().zip(two).fold(0.0, |most, (a, b)| f64::max(most, (a - b).abs()));
        let errors = [
            distance(&found.0, &expected.0) / contact.slip_force,
            distance(&found.1, &expected.1) / contact.initial_stiffness,
            (found.2 - expected.2).abs() / expected.2.max(f64::MIN_POSITIVE),
        ];
        assert!(errors.iter().zip(tolerances).all(|(error, tolerance)| *error <= tolerance), "{what}: {errors:?}");
    }

    #[test]
    fn the_jacobian_agrees_with_finite_differences() {
        for (contact, size) in contacts().flat_map(|contact| [0.3, 0.9, 1.2, 4.0].map(|size| (contact, size))) {
            for shape in [&SHAPE[..], &ODD, &FIVE] {
                let motion = scaled(&contact, shape, size);
                let (force, jacobian, energy) = all(&contact, 64, &motion);
                // If two reversals are equally far the second derivative is discontinuous: the error is O(h).
                let h = 1e-7 * contact.slip_displacement;
                let differences = (0..motion.len()).flat_map(|j| {
                    let [low, high] = [-h, h].map(|step| {
                        let mut motion = motion.clone();
                        motion[j] += step;
                        all(&contact, 64, &motion).0
                    });
                    high.into_iter().zip(low).map(|(high, low)| (high - low) / (2.0 * h)).collect::<Vec<_>>()
                });
                let expected = (force.clone(), differences.collect(), energy);
                check(&contact, &(force, jacobian, energy), &expected, [0.0, 2e-7, 0.0], "differences");
            }
        }
    }

    #[test]
    fn a_shift_in_time_shifts_force_and_jacobian() {
        for (contact, size) in contacts().flat_map(|contact| [(contact, 0.5), (contact, 0.9), (contact, 2.5)]) {
            for shape in [&SHAPE[..], &ODD, &FIVE] {
                let displacement = scaled(&contact, shape, size);
                let expected = all(&contact, 128, &displacement);
                for by in [1e-9, 0.7, PI, 4.4] {
                    let shifted = all(&contact, 128, &shift(&displacement, by));
                    // Near gross slip rounding errors of the displacement are amplified in the energy.
                    check(&contact, &shifted, &shift_all(&expected, by), [1e-13, 1e-11, 1e-12], "shifted");
                }
                let minus = |vector: &[f64]| -> Vec<f64> { vector.iter().map(|value| -value).collect() };
                let opposite = all(&contact, 128, &minus(&displacement));
                assert_eq!(opposite, (minus(&expected.0), expected.1, expected.2));
            }
        }
    }

    #[test]
    fn constant_displacements_and_degenerate_reversals() {
        for contact in contacts() {
            let slip = contact.slip_displacement;
            for constant in [0.0, 0.4 * slip, -0.4 * slip, 2.0 * slip, -1e100] {
                let found = all(&contact, 16, &[constant, 0.0, 0.0, 0.0, 0.0]);
                let point = contact.curve_at_displacement(constant).unwrap();
                let diagonal = (0..25).map(|i| if i % 6 == 0 { point.stiffness() } else { 0.0 }).collect();
                let expected = ([point.force(), 0.0, 0.0, 0.0, 0.0].to_vec(), diagonal, 0.0);
                check(&contact, &found, &expected, [1e-15, 1e-14, 0.0], "constant");
                assert_eq!(found.0[1..], [0.0; 4]);
            }
            // cos t - cos(2t)/4 has a reversal at which three derivatives vanish; a perturbation makes one reversal or three.
            for (perturbation, size) in [-1e-3, -1e-9, -1e-17, 0.0, 1e-17, 1e-9, 1e-3]
                .into_iter()
                .flat_map(|perturbation| [0.5, 1.0, 3.0].map(|size| (perturbation, size * slip)))
            {
                let motion = [0.0, size, 0.0, -(0.25 + perturbation) * size, 0.0];
                let one = all(&contact, 128, &motion);
                check(&contact, &one, &all(&contact, 4096, &motion), [1e-9, f64::INFINITY, 1e-13], "more nodes");
                // The error of the instants is the cube root of the unit of rounding.
                let shifted = all(&contact, 128, &shift(&motion, 0.77));
                check(&contact, &shifted, &shift_all(&one, 0.77), [1e-9, f64::INFINITY, f64::INFINITY], "shifted");
            }
        }
    }

    /// A negative cosine reverses exactly at the boundary of the half period that is searched.
    #[test]
    fn reversals_at_the_start_of_the_period_are_found() {
        for (contact, size) in contacts().flat_map(|contact| [(contact, 0.3), (contact, 2.0)]) {
            for [one, two, three] in [[1.0, 0.0, 0.0], [1.0, 0.0, 0.05], [0.0, 0.0, 1.0], [1.0, 0.0, -0.3]] {
                let [up, mut down] = [-size, size]
                    .map(|size| all(&contact, 64, &scaled(&contact, &[0.0, one, 0.0, two, 0.0, three, 0.0], size)));
                down.0.iter_mut().for_each(|force| *force = -*force);
                check(&contact, &up, &down, [1e-12, 1e-9, 1e-12], "start");
                assert!(down.2 > 0.0);
            }
        }
    }
}
