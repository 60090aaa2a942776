//! Event-driven harmonic force: piecewise Gauss-Legendre quadrature between the events of a period.
//!
//! The force of a periodic displacement is smooth except at events: reversals, closures of loops, the onset of gross slip. Uniform
//! samples miss them, with an error of O(samples⁻²). Here the events are located, as roots of the rate and as crossings of the ends of
//! branches, and each segment between two of them has its own rule: the error decreases exponentially with the number of nodes.
//! Segments of gross slip are integrated in closed form, and the energy is that between reversals: it is exact.
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

use super::columns::{clear_opposite_parity, fill_columns};
use super::motion::{Grid, Instant, Motion, fill_integrals, fill_phi};
use super::segments::{Integrals, PANEL, Segment};
use super::sensitivity::{self, ReversalSensitivities};
use super::{HarmonicOutput, Requested, jacobian};
use crate::constant_load::contact::Contact;
use crate::constant_load::evaluator::Response;
use crate::constant_load::memory::{Point, Reversal};
use crate::constant_load::steady_state::SteadyState;
use crate::error::Error;
use crate::fourier::normalise;
use crate::fourier::workspace::{HEADER, Parts, Size, WorkspaceLayout, padded};
use crate::tag::Kind;
use core::f64::consts::PI;

/// Lengths of the parts of a workspace.
pub(super) struct Layout(Size);

impl Layout {
    /// Points of the search grid: an even number, at least sixteen per period of the highest harmonic. Three reversals within two grid
    /// steps h may be taken for one: the width of the missed loop is `h⁴/24` times the fourth derivative, at most a thousandth of the
    /// amplitude.
    fn grid(&self) -> usize {
        (self.0.samples.max(16 * self.0.harmonics) + 1) & !1
    }

    /// Capacity for reversals: a displacement has at most 2H per period; more are due to rounding.
    fn reversals(&self) -> usize {
        4 * self.0.harmonics + 8
    }
}

impl WorkspaceLayout for Layout {
    const KIND: Kind = Kind::EventDriven;

    fn of(size: Size) -> Layout {
        Layout(size)
    }

    fn size(&self) -> Size {
        self.0
    }

    fn max_rows(&self) -> usize {
        self.grid() + self.reversals() + PANEL
    }

    fn tables_length(&self) -> usize {
        padded(self.grid() / 2 * self.0.coefficients())
    }

    fn length(&self) -> usize {
        let (n, grid, reversals) = (self.0.coefficients(), self.grid(), self.reversals());
        let stack = padded(3 * reversals) + padded(2 * n * reversals);
        let sums = 3 * padded(n) + 2 * padded(2 * n - 1);
        HEADER + self.tables_length() + padded(grid) + padded(2 * grid) + stack + 4 * self.0.harmonics * PANEL + sums
    }

    fn fill_tables(&self, tables: &mut Parts) -> Result<(), Error> {
        fill_columns(tables.take(self.grid() / 2 * self.0.coefficients())?, self.grid(), self.grid() / 2);
        Ok(())
    }
}

/// An opened workspace.
#[derive(Debug)]
pub(super) struct Workspace<'a> {
    /// The stack of reversals of the law.
    reversals: &'a mut [Reversal],
    buffers: Buffers<'a>,
}

/// Tables, events and integrals.
#[derive(Debug)]
struct Buffers<'a> {
    /// Columns 1, cos t, sin t, cos 2t, ... over the first half of the grid.
    columns: &'a [f64],
    /// The rate of the displacement on the grid.
    rate: &'a mut [f64],
    /// Instant and displacement of each reversal of the motion.
    instants: &'a mut [[f64; 2]],
    /// φ_r and dT_r of each reversal on the stack, rows over the coefficients.
    gradients: &'a mut [f64],
    integrals: Integrals<'a>,
    /// Rows over the coefficients: ∫ φ over a segment, and the coefficients of the rate.
    phi_integrals: &'a mut [f64],
    row: &'a mut [f64],
}

impl<'a> Workspace<'a> {
    /// Opens an initialised workspace.
    ///
    /// # Errors
    /// `BadWorkspace` if uninitialised or too short.
    #[inline(always)]
    pub fn new(workspace: &'a mut [f64]) -> Result<Workspace<'a>, Error> {
        let (layout, mut parts) = Layout::open(workspace)?;
        let (grid, n) = (layout.grid(), layout.0.coefficients());
        let buffers = Buffers {
            columns: parts.take(grid / 2 * n)?,
            rate: parts.take(grid)?,
            instants: parts.take(2 * grid)?.as_chunks_mut().0,
            gradients: parts.take(2 * n * layout.reversals())?,
            integrals: Integrals {
                harmonics: layout.0.harmonics,
                nodes_per_period: layout.0.samples,
                basis: parts.take(4 * layout.0.harmonics * PANEL)?,
                force: parts.take(n)?,
                segment_stiffness: parts.take(2 * n - 1)?,
                stiffness: parts.take(2 * n - 1)?,
            },
            phi_integrals: parts.take(n)?,
            row: parts.take(n)?,
        };
        Ok(Workspace { reversals: parts.take(3 * layout.reversals())?.as_chunks_mut().0, buffers })
    }

    /// 2H + 1.
    pub fn coefficients(&self) -> usize {
        self.buffers.coefficients()
    }
}

/// Computes the requested outputs.
pub(super) fn harmonic_force(
    contact: &Contact,
    workspace: &mut Workspace,
    displacement: &[f64],
    output: HarmonicOutput,
) {
    let Workspace { reversals, buffers } = workspace;
    let HarmonicOutput { force, mut jacobian, dissipated, .. } = output;
    let mut period = Period {
        law: SteadyState::new(contact, reversals, dissipated.is_some()),
        requested: Requested { force: force.is_some(), stiffness: jacobian.is_some() },
        motion: Motion::new(displacement),
        now: Response { force: 0.0, stiffness: 0.0 },
        jacobian: jacobian.as_deref_mut(),
        sensitivity: None,
    };
    let (span, half_wave_symmetric) = period.integrate(buffers);
    if let (Some(dissipated), Some(energy)) = (dissipated, period.law.dissipated()) {
        *dissipated = if half_wave_symmetric { 2.0 * energy } else { energy };
    }
    if let Some(force) = force {
        force.iter_mut().zip(buffers.integrals.force.iter()).for_each(|(force, sum)| *force = *sum);
        normalise(force, 1.0 / span);
        if half_wave_symmetric {
            clear_opposite_parity(1, force);
        }
    }
    if let Some(jacobian) = jacobian {
        let Integrals { harmonics, stiffness, .. } = &buffers.integrals;
        jacobian::complete(jacobian, *harmonics, stiffness, 1.0 / span, half_wave_symmetric);
    }
}

/// Computes the derivatives with respect to the parameters.
pub(super) fn harmonic_sensitivity(
    contact: &Contact,
    workspace: &mut Workspace,
    displacement: &[f64],
    sensitivity: &mut [f64],
) {
    let Workspace { reversals, buffers } = workspace;
    sensitivity.fill(0.0);
    let mut period = Period {
        law: SteadyState::new(contact, reversals, false),
        requested: Requested { force: false, stiffness: false },
        motion: Motion::new(displacement),
        now: Response { force: 0.0, stiffness: 0.0 },
        jacobian: None,
        sensitivity: Some(&mut *sensitivity),
    };
    let (span, half_wave_symmetric) = period.integrate(buffers);
    sensitivity::complete(sensitivity, 1.0 / span, half_wave_symmetric);
}

impl Buffers<'_> {
    /// 2H + 1.
    fn coefficients(&self) -> usize {
        2 * self.integrals.harmonics + 1
    }

    #[inline(always)]
    fn instant(&self, index: usize) -> Instant {
        match self.instants.get(index) {
            Some(&[t, displacement]) => Instant { t, displacement },
            None => Instant { t: 0.0, displacement: 0.0 },
        }
    }
}

/// Integration over a period, event by event.
struct Period<'m, 'c, 's> {
    law: SteadyState<'c, 's>,
    requested: Requested,
    motion: Motion<'m>,
    /// Response at the present instant.
    now: Response,
    /// Terms of the reversals, and integrals of the derivatives with respect to the parameters, if requested.
    jacobian: Option<&'m mut [f64]>,
    sensitivity: Option<&'m mut [f64]>,
}

impl Period<'_, '_, '_> {
    /// Integrates a constant displacement.
    fn integrate_constant(&mut self, buffers: &mut Buffers, span: f64) {
        self.now = self.law.begin(self.motion.mean);
        let Integrals { force, stiffness, .. } = &mut buffers.integrals;
        if let (Some(force), Some(stiffness)) = (force.first_mut(), stiffness.first_mut()) {
            (*force, *stiffness) = (span * self.now.force, span * self.now.stiffness);
        }
        if let Some(sums) = &mut self.sensitivity {
            fill_integrals(buffers.row, 0.0, span);
            sensitivity::add(sums, 1.0, buffers.row, self.law.sensitivity(self.motion.mean));
        }
    }

    /// Integrates a period, or half of it if it is half-wave symmetric, from the farthest reversal. Returns its length, and which it is.
    #[inline(always)]
    fn integrate(&mut self, buffers: &mut Buffers) -> (f64, bool) {
        let grid = Grid { columns: buffers.columns, rate: buffers.rate, coefficients: buffers.row };
        let (count, half_wave_symmetric) = self.motion.find_reversals(grid, buffers.instants);
        let span = if half_wave_symmetric { PI } else { 2.0 * PI };
        buffers.integrals.clear();
        if count == 0 {
            self.integrate_constant(buffers, span);
            return (span, half_wave_symmetric);
        }
        let (mut first, mut farthest) = (0, -1.0);
        for index in 0..count {
            let distance = buffers.instant(index).displacement.abs();
            if distance > farthest {
                (first, farthest) = (index, distance);
            }
        }
        let mut from = buffers.instant(first);
        self.now = self.law.begin(from.displacement);
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
        (span, half_wave_symmetric)
    }

    /// Integrates from one reversal of the motion to the next, along one branch and its continuations.
    fn integrate_half_cycle(&mut self, buffers: &mut Buffers, from: Instant, to: Instant) {
        let present = self.law.branch().direction;
        let direction = if to.displacement == from.displacement {
            present
        } else if to.displacement < from.displacement {
            -1.0
        } else {
            1.0
        };
        if direction != present {
            self.reverse(buffers, from, direction);
        }
        let mut at = from;
        loop {
            let branch = self.law.branch();
            let end = branch.end;
            if branch.gross_slip || direction * (to.displacement - end) < 0.0 {
                self.integrate_segment(buffers, at, to, false);
                break;
            }
            let t = if to.displacement == end { to.t } else { self.motion.crossing(at, from, to, end) };
            let event = Instant { t, displacement: end };
            self.integrate_segment(buffers, at, event, self.law.ends_in_gross_slip());
            self.law.pass_end();
            at = event;
        }
        self.now = self.law.response(to.displacement);
    }

    /// Makes an instant the newest reversal on the stack and stores its gradient.
    fn reverse(&mut self, buffers: &mut Buffers, at: Instant, direction: f64) {
        let left = self.law.branch().depth;
        if self.sensitivity.is_some() {
            let mut stack = ReversalSensitivities::new(buffers.gradients);
            let sensitivity = stack.at(&self.law, at.displacement);
            if self.law.reverse(Point { displacement: at.displacement, force: 0.0 }, direction) {
                stack.store(&self.law, sensitivity);
            }
            return;
        }
        if !self.law.reverse(Point { displacement: at.displacement, force: self.now.force }, direction) {
            return;
        }
        let (n, depth) = (buffers.coefficients(), self.law.branch().depth);
        if self.requested.stiffness
            && let Some((older, newer)) = buffers.gradients.split_at_mut_checked(2 * n * (depth - 1))
            && let Some((phi, gradient)) = newer.get_mut(..2 * n).and_then(|row| row.split_at_mut_checked(n))
        {
            let k = self.now.stiffness;
            fill_phi(phi, at.t);
            gradient.iter_mut().zip(phi.iter()).for_each(|(gradient, phi)| *gradient = k * phi);
            if left > 0
                && let Some((phi, before)) = older.chunks_exact((2 * n).max(1)).last().map(|row| row.split_at(n))
            {
                for ((gradient, phi), before) in gradient.iter_mut().zip(phi).zip(before) {
                    *gradient += before - k * phi;
                }
            }
        }
    }

    /// Adds a segment of the present branch to the integrals, the Jacobian and the energy. `to_slip`: gross slip starts at its end.
    fn integrate_segment(&mut self, buffers: &mut Buffers, from: Instant, to: Instant, to_slip: bool) {
        self.law.account_for(from.displacement, to.displacement);
        if self.sensitivity.is_some() {
            return self.integrate_sensitivity(buffers, Segment { from: from.t, to: to.t, to_slip });
        }
        let Requested { force, stiffness } = self.requested;
        if to.t <= from.t || !(force || stiffness) {
            return;
        }
        let branch = self.law.branch();
        if branch.gross_slip {
            if force {
                fill_integrals(buffers.phi_integrals, from.t, to.t);
                let limit = self.law.response(to.displacement).force;
                let sums = buffers.integrals.force.iter_mut();
                sums.zip(buffers.phi_integrals.iter()).for_each(|(sum, integral)| *sum += limit * integral);
            }
            return;
        }
        let segment = Segment { from: from.t, to: to.t, to_slip };
        buffers.integrals.add(&self.law.evaluator(), &self.motion, segment, self.requested);
        let Some(jacobian) = &mut self.jacobian else { return };
        let Integrals { stiffness, segment_stiffness, .. } = &mut buffers.integrals;
        stiffness.iter_mut().zip(segment_stiffness.iter()).for_each(|(sum, segment)| *sum += segment);
        let n = buffers.coefficients();
        let row = buffers.gradients.chunks_exact((2 * n).max(1)).nth(branch.depth.wrapping_sub(1));
        if let Some((phi, gradient)) = row.and_then(|row| row.split_at_checked(n)) {
            fill_integrals(buffers.phi_integrals, from.t, to.t);
            let up_to_h = buffers.integrals.segment_stiffness.get(..n).unwrap_or(&[]);
            jacobian::add_reversal_term(jacobian, phi, gradient, buffers.phi_integrals, up_to_h);
        }
    }

    /// Adds a segment of the present branch to the integrals of the derivatives with respect to the parameters.
    #[inline(never)]
    fn integrate_sensitivity(&mut self, buffers: &mut Buffers, segment: Segment) {
        let Some(sums) = &mut self.sensitivity else { return };
        let stack = ReversalSensitivities::new(buffers.gradients);
        if segment.to <= segment.from {
        } else if self.law.branch().gross_slip {
            fill_integrals(buffers.row, segment.from, segment.to);
            sensitivity::add(sums, 1.0, buffers.row, stack.at(&self.law, 0.0));
        } else {
            segment.panels(buffers.integrals.nodes_per_period).for_each(|t, weight| {
                fill_phi(buffers.row, t);
                let [displacement, ..] = self.motion.derivatives(t);
                sensitivity::add(sums, weight, buffers.row, stack.at(&self.law, displacement));
            });
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

    fn distance(one: &[f64], two: &[f64]) -> f64 {
        one.iter().zip(two).fold(0.0, |most, (one, two)| f64::max(most, (one - two).abs()))
    }

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

    #[test]
    fn one_harmonic_agrees_with_the_complex_stiffness() {
        for contact in contacts() {
            for (ratio, bound) in
                [(1e-6, 1e-14), (0.3, 1e-14), (0.8, 1e-13), (0.95, 1e-12), (1.1, 1e-12), (3.0, 1e-12), (1e3, 1e-12)]
            {
                let amplitude = ratio * contact.slip_displacement;
                let exact = contact.complex_stiffness(amplitude).unwrap();
                let size = exact.real().hypot(exact.imaginary());
                for phase in [0.0, 0.3, 2.0, 4.0] {
                    let (sine, cosine) = f64::sin_cos(phase);
                    let (force, _, energy) = all(&contact, 64, &[0.0, amplitude * cosine, amplitude * sine]);
                    let real = (cosine * force[1] + sine * force[2]) / amplitude;
                    let imaginary = (sine * force[1] - cosine * force[2]) / amplitude;
                    let error = (real - exact.real()).hypot(imaginary - exact.imaginary());
                    assert!(error < bound * size, "{ratio} {phase}: {:e}", error / size);
                    // The energy of small loops is a difference of forces, with their absolute error.
                    assert!((energy / exact.dissipated() - 1.0).abs() < 1e-12, "{ratio} {energy}");
                }
            }
        }
    }

    #[test]
    fn the_jacobian_agrees_with_finite_differences() {
        for contact in contacts() {
            for (shape, size) in
                [&SHAPE[..], &ODD, &FIVE].into_iter().flat_map(|shape| [0.3, 0.9, 1.2, 4.0].map(|size| (shape, size)))
            {
                let motion = scaled(&contact, shape, size);
                let n = motion.len();
                let (_, jacobian, _) = all(&contact, 64, &motion);
                for j in 0..n {
                    let force_at = |step: f64| {
                        let mut motion = motion.clone();
                        motion[j] += step;
                        all(&contact, 64, &motion).0
                    };
                    // If two reversals are equally far the second derivative is discontinuous: the error is O(h).
                    let h = 1e-7 * contact.slip_displacement;
                    let (low, high) = (force_at(-h), force_at(h));
                    for i in 0..n {
                        let error =
                            (jacobian[i + n * j] - (high[i] - low[i]) / (2.0 * h)).abs() / contact.initial_stiffness;
                        assert!(error < 2e-7, "{size} {i} {j}: {error:e}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_shift_in_time_shifts_force_and_jacobian() {
        for (contact, size) in contacts().flat_map(|contact| [(contact, 0.5), (contact, 0.9), (contact, 2.5)]) {
            for shape in [&SHAPE[..], &ODD, &FIVE] {
                let displacement = scaled(&contact, shape, size);
                let n = shape.len();
                let (force, jacobian, energy) = all(&contact, 128, &displacement);
                for by in [1e-9, 0.7, PI, 4.4] {
                    let (shifted, shifted_jacobian, shifted_energy) = all(&contact, 128, &shift(&displacement, by));
                    // Near gross slip rounding errors of the displacement are amplified in the energy.
                    assert!((shifted_energy / energy - 1.0).abs() < 1e-12, "{by}");
                    let error = distance(&shifted, &shift(&force, by)) / contact.slip_force;
                    assert!(error < 1e-13, "{by} {error:e}");
                    for j in 0..n {
                        let unit: Vec<f64> = (0..n).map(|i| if i == j { 1.0 } else { 0.0 }).collect();
                        let times = |matrix: &[f64], vector: &[f64]| -> Vec<f64> {
                            (0..n).map(|i| (0..n).map(|k| matrix[i + n * k] * vector[k]).sum()).collect()
                        };
                        let one = times(&shifted_jacobian, &shift(&unit, by));
                        let two = shift(&times(&jacobian, &unit), by);
                        assert!(
                            distance(&one, &two) < 1e-11 * contact.initial_stiffness,
                            "{by} {j} {:e}",
                            distance(&one, &two) / contact.initial_stiffness
                        );
                    }
                }
                let minus = |vector: &[f64]| -> Vec<f64> { vector.iter().map(|value| -value).collect() };
                let (opposite, opposite_jacobian, opposite_energy) = all(&contact, 128, &minus(&displacement));
                assert_eq!((opposite, opposite_energy), (minus(&force), energy));
                assert_eq!(opposite_jacobian, jacobian);
            }
        }
    }

    #[test]
    fn constant_displacements_and_degenerate_reversals() {
        for contact in contacts() {
            let slip = contact.slip_displacement;
            for constant in [0.0, 0.4 * slip, -0.4 * slip, 2.0 * slip, -1e100] {
                let (force, jacobian, energy) = all(&contact, 16, &[constant, 0.0, 0.0, 0.0, 0.0]);
                let point = contact.curve_at_displacement(constant).unwrap();
                assert!((force[0] - point.force()).abs() < 1e-15 * contact.slip_force && energy == 0.0);
                assert!(force.iter().skip(1).all(|&force| force == 0.0));
                let stiffness = point.stiffness();
                for (index, value) in jacobian.iter().enumerate() {
                    let expected = if index % 6 == 0 { stiffness } else { 0.0 };
                    assert!((value - expected).abs() < 1e-14 * contact.initial_stiffness, "{index}");
                }
            }
            // cos t - cos(2t)/4 has a reversal at which three derivatives vanish; a perturbation makes one reversal or three.
            for (perturbation, size) in [-1e-3, -1e-9, -1e-17, 0.0, 1e-17, 1e-9, 1e-3]
                .into_iter()
                .flat_map(|perturbation| [0.5, 1.0, 3.0].map(|size| (perturbation, size * slip)))
            {
                let motion = [0.0, size, 0.0, -(0.25 + perturbation) * size, 0.0];
                let (one, two) = (all(&contact, 128, &motion), all(&contact, 4096, &motion));
                assert!(
                    distance(&one.0, &two.0) < 1e-9 * contact.slip_force,
                    "{perturbation} {:e}",
                    distance(&one.0, &two.0)
                );
                assert!((one.2 / two.2 - 1.0).abs() < 1e-13);
                let shifted = all(&contact, 128, &shift(&motion, 0.77));
                // The error of the instants is the cube root of the unit of rounding.
                assert!(distance(&shifted.0, &shift(&one.0, 0.77)) < 1e-9 * contact.slip_force);
            }
        }
    }

    /// A negative cosine reverses exactly at the boundary of the half period that is searched.
    #[test]
    fn reversals_at_the_start_of_the_period_are_found() {
        for contact in contacts() {
            for size in [0.3, 2.0].map(|ratio| ratio * contact.slip_displacement) {
                let shapes = [[1.0, 0.0, 0.0], [1.0, 0.0, 0.05], [0.0, 0.0, 1.0], [1.0, 0.0, -0.3]];
                for shape in shapes {
                    let motion = |sign: f64| {
                        let [one, two, three] = shape.map(|ratio| sign * size * ratio);
                        [0.0, one, 0.0, two, 0.0, three, 0.0]
                    };
                    let (up, down) = (all(&contact, 64, &motion(-1.0)), all(&contact, 64, &motion(1.0)));
                    for (one, two) in up.0.iter().zip(&down.0) {
                        assert!((one + two).abs() < 1e-12 * contact.slip_force, "{shape:?} {one} {two}");
                    }
                    for (one, two) in up.1.iter().zip(&down.1) {
                        assert!((one - two).abs() < 1e-9 * contact.initial_stiffness, "{shape:?}");
                    }
                    assert!(down.2 > 0.0 && (up.2 / down.2 - 1.0).abs() < 1e-12, "{shape:?}");
                }
            }
        }
    }

    /// Three reversals, equally far up to rounding, at the instant at which the steady state is entered.
    #[test]
    fn a_flat_maximum_at_the_start_is_integrated() {
        let contact = contact(50e-6);
        let size = 0.3 * contact.slip_displacement;
        for (steps, by) in (6..14).flat_map(|tenths| [0.0, 1.1, 2.2].map(|by| (f64::from(tenths) / 10.0, by))) {
            // cos t - (1/9 + ε) cos 3t has three reversals within `steps` grid steps, at displacements equal up to rounding.
            let step = 2.0 * PI / f64::from(1 << 17);
            let epsilon = (steps * step) * (steps * step) / 6.75;
            let motion = shift(&[0.0, size, 0.0, 0.0, 0.0, -(1.0 / 9.0 + epsilon) * size, 0.0], by);
            let (one, two) = (all(&contact, 1 << 17, &motion), all(&contact, 256, &motion));
            assert!(distance(&one.0, &two.0) < 1e-9 * contact.slip_force, "{steps} {by}");
            assert!((one.2 / two.2 - 1.0).abs() < 1e-12, "{steps} {by}: {} {}", one.2, two.2);
        }
    }

    #[test]
    fn the_force_of_a_large_motion_is_a_square_wave() {
        let contact = contact(0.0);
        let huge = 1e9 * contact.slip_displacement;
        let (force, _, energy) = all(&contact, 16, &[0.0, 0.0, huge, 0.0, 0.0, 0.0, 0.0]);
        // The contact sticks for 1e-4 of the period.
        assert!((force[1] / contact.slip_force * PI / 4.0 - 1.0).abs() < 1e-4);
        assert!((energy / (4.0 * contact.slip_force * huge) - 1.0).abs() < 1e-8);
        let square: f64 = force.iter().map(|force| force * force).sum();
        assert!((square.sqrt() / contact.slip_force / (4.0 / PI * (1.0 + 1.0 / 9.0f64).sqrt()) - 1.0).abs() < 1e-4);
    }
}
