//! Harmonic force by quadrature between the reversals: few points of the curve, and hardly any error.
//!
//! The force of a periodic displacement is smooth but for a few instants, where the displacement turns, where a loop closes,
//! and where gross slip starts. Equidistant samples miss them, and err by samples⁻². Here they are found, as roots of the
//! displacement's rate and as crossings of a level, and each piece between two of them has its own Gauss-Legendre rule. On a
//! piece the force is analytic: after a reversal it depends on `u - u_r ~ (t - t_r)²` alone. So the error falls
//! exponentially with the number of nodes, but for a piece that ends where gross slip starts: there the curve has any power of
//! the cube root of the way that is left, and the nodes are those of the cube root. While the contact slides, the integrals are
//! closed.
//!
//! All energies are those between reversals, so that the energy of the period is exact.
//!
//! The Jacobian is the same rule applied to the exact derivative of the integrals,
//!
//! ```text
//! dF = ∫ φ dT dt,
//! ```
//!
//! in which the motion of the instants has no part: the force is continuous there. The derivative of the rule's sum would add
//! to it the derivative of the rule's error times that of the instants, `dt_e = -φ'/ü`, which grows without bound where
//! two reversals merge, and says nothing of the contact. The two differ by the error of the rule.

use super::fourier::{clear_other_parity, complete_jacobian, fill_columns, scale};
use super::motion::{Grid, Instant, Motion, fill_integrals, fill_phi};
use super::workspace::{HEADER, Parts, Size, WorkspaceLayout, padded};
use super::{HarmonicOutput, Requested};
use crate::error::Error;
use crate::law::{Evaluator, Law, Point, Response, Reversal};
use crate::numerics::quadrature::{MAX_GAUSS_BLOCKS, gauss_rule};
use crate::tag::Kind;
use core::f64::consts::PI;

/// Fewest nodes of a piece, in fours.
const MIN_BLOCKS: usize = 2;
const MIN_BLOCKS_TO_SLIP: usize = 4;

/// Nodes that are taken together.
const PANEL: usize = 4 * MAX_GAUSS_BLOCKS;

/// Numbers in fours, of a panel.
type Nodes = [[f64; 4]; MAX_GAUSS_BLOCKS];

/// Doubles of the parts of a workspace.
pub(super) struct Layout(Size);

impl Layout {
    /// Instants at which the rate is looked at: an even number, sixteen for the shortest wave at least. Three turning points
    /// within two steps h may be taken for one: the loop that is missed is `h⁴/24` of the fourth derivative wide, a thousandth of
    /// the amplitude at most.
    fn grid(&self) -> usize {
        (self.0.samples.max(16 * self.0.harmonics) + 1) & !1
    }

    /// A displacement turns 2H times a period at most; what exceeds that is rounding.
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

    fn rows(&self) -> usize {
        self.grid() + self.reversals() + PANEL
    }

    fn tables(&self) -> usize {
        padded(self.grid() / 2 * self.0.coefficients())
    }

    fn length(&self) -> usize {
        let (n, grid, reversals) = (self.0.coefficients(), self.grid(), self.reversals());
        let stack = padded(3 * reversals) + padded(2 * n * reversals);
        let sums = 3 * padded(n) + 2 * padded(2 * n - 1);
        HEADER + self.tables() + padded(grid) + padded(2 * grid) + stack + 4 * self.0.harmonics * PANEL + sums
    }

    fn fill_tables(&self, tables: &mut Parts) -> Result<(), Error> {
        fill_columns(tables.take(self.grid() / 2 * self.0.coefficients())?, self.grid(), self.grid() / 2);
        Ok(())
    }
}

/// A workspace as it is used.
#[derive(Debug)]
pub(super) struct Workspace<'a> {
    /// The stack of reversals of the law.
    reversals: &'a mut [Reversal],
    buffers: Buffers<'a>,
}

/// Tables, events and sums.
#[derive(Debug)]
struct Buffers<'a> {
    harmonics: usize,
    samples: usize,
    /// Over the grid's first half, for each coefficient: 1, cos t, sin t, cos 2t, ...
    columns: &'a [f64],
    /// The displacement's rate on the grid.
    rate: &'a mut [f64],
    /// Instant and displacement of each reversal of the motion.
    instants: &'a mut [[f64; 2]],
    /// φ_r and dT_r of each reversal, rows over the coefficients.
    gradients: &'a mut [f64],
    /// cos and sin of each order up to 2H at the nodes of a panel.
    waves: &'a mut [f64],
    /// Fourier sums: of the force, of the stiffness on one piece and, up to the order 2H, on all.
    force_sums: &'a mut [f64],
    segment_sums: &'a mut [f64],
    stiffness_sums: &'a mut [f64],
    /// Integrals of φ over a piece, and one more row.
    integrals: &'a mut [f64],
    row: &'a mut [f64],
}

impl<'a> Workspace<'a> {
    /// Takes a prepared workspace into use.
    ///
    /// # Errors
    /// `BadWorkspace` for memory that was not initialised, or was changed.
    #[inline(always)]
    pub fn new(workspace: &'a mut [f64]) -> Result<Workspace<'a>, Error> {
        let (layout, mut parts) = Layout::open(workspace)?;
        let (grid, n) = (layout.grid(), layout.0.coefficients());
        let buffers = Buffers {
            harmonics: layout.0.harmonics,
            samples: layout.0.samples,
            columns: parts.take(grid / 2 * n)?,
            rate: parts.take(grid)?,
            instants: parts.take(2 * grid)?.as_chunks_mut().0,
            gradients: parts.take(2 * n * layout.reversals())?,
            waves: parts.take(4 * layout.0.harmonics * PANEL)?,
            force_sums: parts.take(n)?,
            segment_sums: parts.take(2 * n - 1)?,
            stiffness_sums: parts.take(2 * n - 1)?,
            integrals: parts.take(n)?,
            row: parts.take(n)?,
        };
        Ok(Workspace { reversals: parts.take(3 * layout.reversals())?.as_chunks_mut().0, buffers })
    }

    /// 2H + 1.
    pub fn coefficients(&self) -> usize {
        self.buffers.coefficients()
    }
}

/// The requested outputs.
#[inline(always)]
pub(super) fn harmonic_force<'w, L: Law>(
    law: impl FnOnce(&'w mut [Reversal], bool) -> L,
    workspace: &'w mut Workspace,
    displacement: &[f64],
    output: HarmonicOutput,
) {
    let Workspace { reversals, buffers } = workspace;
    let requested = output.requested();
    let HarmonicOutput { force, mut jacobian, dissipated } = output;
    let motion = Motion::of(displacement);
    let grid = Grid { columns: buffers.columns, rate: buffers.rate, row: buffers.row };
    let (count, half_wave_symmetric) = motion.find_reversals(grid, buffers.instants);
    buffers.force_sums.fill(0.0);
    buffers.stiffness_sums.fill(0.0);
    let span = if half_wave_symmetric { PI } else { 2.0 * PI };
    let mut walk = Walk {
        law: law(reversals, dissipated.is_some()),
        requested,
        motion,
        blocks_per_radian: buffers.samples as f64 / (8.0 * PI),
        now: Response { force: 0.0, stiffness: 0.0 },
    };
    if count == 0 {
        walk.motionless(buffers, span);
    } else {
        walk.through_period(buffers, count, span, half_wave_symmetric, &mut jacobian);
    }
    if let (Some(dissipated), Some(energy)) = (dissipated, walk.law.dissipated()) {
        *dissipated = if half_wave_symmetric { 2.0 * energy } else { energy };
    }
    if let Some(force) = force {
        force.iter_mut().zip(buffers.force_sums.iter()).for_each(|(force, sum)| *force = *sum);
        scale(force, 1.0 / span);
        if half_wave_symmetric {
            clear_other_parity(1, force);
        }
    }
    if let Some(jacobian) = jacobian {
        let sums = |order| of_order(buffers.stiffness_sums, order);
        complete_jacobian(jacobian, buffers.harmonics, sums, 1.0 / span, half_wave_symmetric);
    }
}

/// Cosine and sine sum of an order.
#[inline(always)]
fn of_order(sums: &[f64], order: usize) -> (f64, f64) {
    let at = |place: usize| sums.get(place).copied().unwrap_or(0.0);
    if order == 0 { (at(0), 0.0) } else { (at(2 * order - 1), at(2 * order)) }
}

impl Buffers<'_> {
    /// 2H + 1.
    fn coefficients(&self) -> usize {
        2 * self.harmonics + 1
    }

    #[inline(always)]
    fn instant(&self, number: usize) -> Instant {
        match self.instants.get(number) {
            Some(&[t, displacement]) => Instant { t, displacement },
            None => Instant { t: 0.0, displacement: 0.0 },
        }
    }

    /// cos and sin of all orders up to `orders` at the nodes of a panel, and the displacement there.
    #[inline(always)]
    fn fill_waves(&mut self, motion: &Motion, orders: usize, times: &[[f64; 4]], displacement: &mut Nodes) {
        let rows = self.waves.as_chunks_mut::<4>().0.as_chunks_mut::<{ 2 * MAX_GAUSS_BLOCKS }>().0;
        for (four, (times, displacement)) in times.iter().zip(displacement.iter_mut()).enumerate() {
            let (mut cosine, mut sine) = ([0.0; 4], [0.0; 4]);
            for k in 0..4 {
                (sine[k], cosine[k]) = times[k].sin_cos();
            }
            let (mut c, mut s) = (cosine, sine);
            let mut u = [motion.mean; 4];
            let mut pairs = motion.pairs.iter();
            for row in rows.iter_mut().take(orders) {
                let (cosines, sines) = row.split_at_mut(MAX_GAUSS_BLOCKS);
                if let (Some(cosines), Some(sines)) = (cosines.get_mut(four), sines.get_mut(four)) {
                    (*cosines, *sines) = (c, s);
                }
                if let Some(&[a, b]) = pairs.next() {
                    for k in 0..4 {
                        u[k] += a * c[k] + b * s[k];
                    }
                }
                for k in 0..4 {
                    (c[k], s[k]) = (c[k] * cosine[k] - s[k] * sine[k], s[k] * cosine[k] + c[k] * sine[k]);
                }
            }
            *displacement = u;
        }
    }
}

/// Adds to Fourier sums the values at the nodes of a panel.
#[inline(always)]
fn add_sums(sums: &mut [f64], waves: &[f64], values: &[[f64; 4]]) {
    let total = |four: [f64; 4]| {
        let [one, two, three, four] = four;
        (one + two) + (three + four)
    };
    let Some((constant, pairs)) = sums.split_first_mut() else { return };
    let mut sum = [0.0; 4];
    for value in values {
        for k in 0..4 {
            sum[k] += value[k];
        }
    }
    *constant += total(sum);
    let rows = waves.as_chunks::<4>().0.as_chunks::<{ 2 * MAX_GAUSS_BLOCKS }>().0;
    for ([by_cosine, by_sine], row) in pairs.as_chunks_mut::<2>().0.iter_mut().zip(rows) {
        let (cosines, sines) = row.split_at(MAX_GAUSS_BLOCKS);
        let (mut c, mut s) = ([0.0; 4], [0.0; 4]);
        for ((value, cosine), sine) in values.iter().zip(cosines).zip(sines) {
            for k in 0..4 {
                c[k] += value[k] * cosine[k];
                s[k] += value[k] * sine[k];
            }
        }
        *by_cosine += total(c);
        *by_sine += total(s);
    }
}

/// The period, from event to event.
struct Walk<'m, L> {
    law: L,
    requested: Requested,
    motion: Motion<'m>,
    blocks_per_radian: f64,
    /// Response at the end of what was integrated.
    now: Response,
}

impl<L: Law> Walk<'_, L> {
    /// A constant displacement.
    #[inline(always)]
    fn motionless(&mut self, buffers: &mut Buffers, span: f64) {
        self.now = self.law.begin(self.motion.mean);
        if let (Some(force), Some(stiffness)) = (buffers.force_sums.first_mut(), buffers.stiffness_sums.first_mut()) {
            (*force, *stiffness) = (span * self.now.force, span * self.now.stiffness);
        }
    }

    /// From the farthest of `count` reversals through a period, or half of it.
    #[inline(always)]
    fn through_period(
        &mut self,
        buffers: &mut Buffers,
        count: usize,
        span: f64,
        half_wave_symmetric: bool,
        jacobian: &mut Option<&mut [f64]>,
    ) {
        let (mut first, mut farthest) = (0, -1.0);
        for number in 0..count {
            let distance = buffers.instant(number).displacement.abs();
            if distance > farthest {
                (first, farthest) = (number, distance);
            }
        }
        let mut from = buffers.instant(first);
        self.now = self.law.begin(from.displacement);
        for number in (first + 1..count).chain(0..=first) {
            let Instant { t, displacement } = buffers.instant(number);
            let to = if number > first {
                Instant { t, displacement }
            } else {
                Instant { t: t + span, displacement: if half_wave_symmetric { -displacement } else { displacement } }
            };
            self.integrate_half_cycle(buffers, from, to, jacobian);
            from = to;
        }
    }

    /// From one reversal of the motion to the next: along one branch, or along its continuations once it has ended.
    #[inline(always)]
    fn integrate_half_cycle(
        &mut self,
        buffers: &mut Buffers,
        from: Instant,
        to: Instant,
        jacobian: &mut Option<&mut [f64]>,
    ) {
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
            let end = self.law.branch().end;
            if direction * (to.displacement - end) < 0.0 {
                self.integrate_segment(buffers, at, to, false, jacobian);
                break;
            }
            let t = if to.displacement == end { to.t } else { self.motion.crossing(at, from, to, end) };
            let event = Instant { t, displacement: end };
            self.integrate_segment(buffers, at, event, self.law.ends_in_gross_slip(), jacobian);
            self.law.pass_end();
            at = event;
        }
        self.now = self.law.response(to.displacement);
    }

    /// Makes an instant the newest reversal, with its gradient.
    #[inline(always)]
    fn reverse(&mut self, buffers: &mut Buffers, at: Instant, direction: f64) {
        let left = self.law.branch().depth;
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
                && let Some((from, before)) = older.chunks_exact((2 * n).max(1)).last().map(|row| row.split_at(n))
            {
                for ((gradient, from), before) in gradient.iter_mut().zip(from).zip(before) {
                    *gradient += before - k * from;
                }
            }
        }
    }

    /// A segment of a branch: its contribution to the integrals, to the Jacobian beyond `∫ k φ ⊗ φ`, and to the energy.
    /// `to_slip`: gross slip starts at its end.
    #[inline(always)]
    fn integrate_segment(
        &mut self,
        buffers: &mut Buffers,
        from: Instant,
        to: Instant,
        to_slip: bool,
        jacobian: &mut Option<&mut [f64]>,
    ) {
        self.law.account_for(from.displacement, to.displacement);
        let Requested { force, stiffness } = self.requested;
        if to.t <= from.t || !(force || stiffness) {
            return;
        }
        let branch = self.law.branch();
        if branch.gross_slip {
            if force {
                fill_integrals(buffers.integrals, from.t, to.t);
                let limit = self.law.response(to.displacement).force;
                let sums = buffers.force_sums.iter_mut();
                sums.zip(buffers.integrals.iter()).for_each(|(sum, integral)| *sum += limit * integral);
            }
            return;
        }
        self.integrate(buffers, from.t, to.t, to_slip);
        let Some(jacobian) = jacobian else { return };
        let sums = buffers.stiffness_sums.iter_mut();
        sums.zip(buffers.segment_sums.iter()).for_each(|(sum, segment)| *sum += segment);
        let n = buffers.coefficients();
        let row = buffers.gradients.chunks_exact((2 * n).max(1)).nth(branch.depth.wrapping_sub(1));
        if let Some((phi, gradient)) = row.and_then(|row| row.split_at_checked(n)) {
            fill_integrals(buffers.integrals, from.t, to.t);
            for ((column, phi), gradient) in jacobian.chunks_exact_mut(n.max(1)).zip(phi).zip(gradient) {
                let rows = buffers.integrals.iter().zip(buffers.segment_sums.iter());
                for (j, (integral, weighted)) in column.iter_mut().zip(rows) {
                    *j += gradient * integral - phi * weighted;
                }
            }
        }
    }

    /// Fourier sums over a segment: of the force, and of the stiffness into those of the segment.
    #[inline(always)]
    fn integrate(&self, buffers: &mut Buffers, from: f64, to: f64, to_slip: bool) {
        let Requested { force, stiffness } = self.requested;
        let length = to - from;
        // Those of the cube root are three times as far apart at the piece's start.
        let (density, least) = if to_slip { (2.0, MIN_BLOCKS_TO_SLIP) } else { (1.0, MIN_BLOCKS) };
        let blocks = ((density * length * self.blocks_per_radian + 0.5) as usize).max(least);
        let panels = blocks.div_ceil(MAX_GAUSS_BLOCKS);
        let rule = gauss_rule(blocks.div_ceil(panels.max(1)));
        let share = 1.0 / panels as f64;
        let evaluator = self.law.evaluator();
        let orders = if stiffness { 2 * buffers.harmonics } else { buffers.harmonics };
        if stiffness {
            buffers.segment_sums.fill(0.0);
        }
        for panel in 0..panels {
            let mut times: Nodes = [[0.0; 4]; _];
            let mut weights: Nodes = [[0.0; 4]; _];
            for ((times, weights), [nodes, rule_weights]) in times.iter_mut().zip(weights.iter_mut()).zip(rule) {
                for k in 0..4 {
                    let s = (panel as f64 + nodes[k]) * share;
                    let weight = length * share * rule_weights[k];
                    if to_slip {
                        let left = 1.0 - s;
                        times[k] = to - length * (left * left * left);
                        weights[k] = 3.0 * left * left * weight;
                    } else {
                        times[k] = from + length * s;
                        weights[k] = weight;
                    }
                }
            }
            let times = times.get(..rule.len()).unwrap_or(&[]);
            let mut forces: Nodes = [[0.0; 4]; _];
            let mut stiffnesses = weights;
            let mut displacement: Nodes = [[0.0; 4]; _];
            buffers.fill_waves(&self.motion, orders, times, &mut displacement);
            let places = displacement.iter().zip(&weights).take(rule.len());
            for ((forces, stiffnesses), (displacement, weights)) in
                forces.iter_mut().zip(stiffnesses.iter_mut()).zip(places)
            {
                for k in 0..4 {
                    let response = evaluator.at(displacement[k]);
                    forces[k] = weights[k] * response.force;
                    stiffnesses[k] = weights[k] * response.stiffness;
                }
            }
            if force {
                let values = forces.get(..rule.len()).unwrap_or(&[]);
                add_sums(buffers.force_sums, buffers.waves, values);
            }
            if stiffness {
                let values = stiffnesses.get(..rule.len()).unwrap_or(&[]);
                add_sums(buffers.segment_sums, buffers.waves, values);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Contact;
    use crate::constant_load::contact::tests::{FLATS, contact, ellipse};
    use crate::hbm::Rule;
    use crate::hbm::tests::{All, ODD, SHAPE, compute, scaled, workspace};
    use std::vec::Vec;

    fn all(contact: &Contact, nodes: usize, displacement: &[f64]) -> All {
        compute(contact, &mut workspace(Rule::EventDriven, displacement.len() / 2, nodes), displacement)
    }

    fn all_equidistant(contact: &Contact, samples: usize, displacement: &[f64]) -> All {
        compute(contact, &mut workspace(Rule::UniformSampling, displacement.len() / 2, samples), displacement)
    }

    const FIVE: [f64; 11] = [0.1, 0.7, 0.0, 0.1, 0.3, -0.2, 0.2, 0.15, -0.1, 0.1, 0.2];

    fn off(one: &[f64], two: &[f64]) -> f64 {
        one.iter().zip(two).fold(0.0, |most, (one, two)| f64::max(most, (one - two).abs()))
    }

    fn contacts() -> impl Iterator<Item = Contact> {
        FLATS.map(contact).into_iter().chain([ellipse(1e-4, 2e-4)])
    }

    /// A turn of all waves by an angle.
    fn turn(vector: &[f64], by: f64) -> Vec<f64> {
        let mut turned = vector.to_vec();
        for k in 1..=vector.len() / 2 {
            let (sine, cosine) = (k as f64 * by).sin_cos();
            let (a, b) = (vector[2 * k - 1], vector[2 * k]);
            turned[2 * k - 1] = cosine * a + sine * b;
            turned[2 * k] = cosine * b - sine * a;
        }
        turned
    }

    #[test]
    fn one_harmonic_is_the_complex_stiffness() {
        for contact in contacts() {
            for (part, bound) in
                [(1e-6, 1e-14), (0.3, 1e-14), (0.8, 1e-13), (0.95, 1e-12), (1.1, 1e-12), (3.0, 1e-12), (1e3, 1e-12)]
            {
                let amplitude = part * contact.slip_displacement;
                let exact = contact.complex_stiffness(amplitude).unwrap();
                let size = exact.real().hypot(exact.imaginary());
                for phase in [0.0, 0.3, 2.0, 4.0] {
                    let (sine, cosine) = f64::sin_cos(phase);
                    let (force, _, energy) = all(&contact, 64, &[0.0, amplitude * cosine, amplitude * sine]);
                    let real = (cosine * force[1] + sine * force[2]) / amplitude;
                    let imaginary = (sine * force[1] - cosine * force[2]) / amplitude;
                    let off = (real - exact.real()).hypot(imaginary - exact.imaginary());
                    assert!(off < bound * size, "{part} {phase}: {:e}", off / size);
                    // Small loops are differences of forces to the accuracy of these.
                    assert!((energy / exact.dissipated() - 1.0).abs() < 1e-12, "{part} {energy}");
                }
            }
        }
    }

    /// Three and five harmonics, odd ones alone, one; nested loops in microslip up to gross slip for most of the time.
    #[test]
    fn few_nodes_beat_many_samples() {
        for contact in contacts() {
            for (shape, size) in [&SHAPE[..], &ODD, &FIVE, &[0.0, 1.0, 0.3]]
                .into_iter()
                .flat_map(|shape| [0.3, 0.9, 1.2, 4.0].map(|size| (shape, size)))
            {
                let motion = scaled(&contact, shape, size);
                let reference = all(&contact, 4096, &motion);
                let (one, two) = (all(&contact, 64, &motion), all_equidistant(&contact, 64, &motion));
                let (force, stiffness) = (contact.slip_force, contact.initial_stiffness);
                // Samples converge to the same, by their square.
                let samples = all_equidistant(&contact, 1 << 16, &motion);
                assert!(
                    off(&reference.0, &samples.0) < 1e-8 * force && off(&reference.1, &samples.1) < 1e-4 * stiffness
                );
                assert!((samples.2 / reference.2 - 1.0).abs() < 3e-8);
                assert!(off(&one.0, &reference.0) < 1e-8 * force, "{:e}", off(&one.0, &reference.0) / force);
                let jacobian = off(&one.1, &reference.1) / stiffness;
                assert!(jacobian < 1e-7, "{jacobian:e}");
                assert!((one.2 / reference.2 - 1.0).abs() < 1e-14, "{} {}", one.2, reference.2);
                let (error, samples) = (off(&one.0, &reference.0), off(&two.0, &reference.0));
                assert!(100.0 * error < samples + 1e-13 * force, "{shape:?} {size}: {error} {samples}");
            }
        }
    }

    #[test]
    fn the_jacobian_is_the_derivative() {
        for contact in contacts() {
            for (shape, size) in
                [&SHAPE[..], &ODD, &FIVE].into_iter().flat_map(|shape| [0.3, 0.9, 1.2, 4.0].map(|size| (shape, size)))
            {
                let motion = scaled(&contact, shape, size);
                let n = motion.len();
                let (_, jacobian, _) = all(&contact, 64, &motion);
                for j in 0..n {
                    let moved = |step: f64| {
                        let mut moved = motion.clone();
                        moved[j] += step;
                        all(&contact, 64, &moved).0
                    };
                    // Where both turning points are equally far, the second derivative jumps: an error of one order in h.
                    let h = 1e-7 * contact.slip_displacement;
                    let (low, high) = (moved(-h), moved(h));
                    for i in 0..n {
                        let off =
                            (jacobian[i + n * j] - (high[i] - low[i]) / (2.0 * h)).abs() / contact.initial_stiffness;
                        assert!(off < 2e-7, "{size} {i} {j}: {off:e}");
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
                    let (shifted, its_jacobian, same) = all(&contact, 128, &turn(&displacement, by));
                    // Near gross slip a unit of rounding of the displacement is worth many of the energy.
                    assert!((same / energy - 1.0).abs() < 1e-12, "{by}");
                    let away = off(&shifted, &turn(&force, by)) / contact.slip_force;
                    assert!(away < 1e-13, "{by} {away:e}");
                    for j in 0..n {
                        let unit: Vec<f64> = (0..n).map(|i| if i == j { 1.0 } else { 0.0 }).collect();
                        let times = |matrix: &[f64], vector: &[f64]| -> Vec<f64> {
                            (0..n).map(|i| (0..n).map(|k| matrix[i + n * k] * vector[k]).sum()).collect()
                        };
                        let one = times(&its_jacobian, &turn(&unit, by));
                        let two = turn(&times(&jacobian, &unit), by);
                        assert!(
                            off(&one, &two) < 1e-11 * contact.initial_stiffness,
                            "{by} {j} {:e}",
                            off(&one, &two) / contact.initial_stiffness
                        );
                    }
                }
                let minus = |vector: &[f64]| -> Vec<f64> { vector.iter().map(|value| -value).collect() };
                let (odd, its_jacobian, same) = all(&contact, 128, &minus(&displacement));
                assert_eq!((odd, same), (minus(&force), energy));
                assert_eq!(its_jacobian, jacobian);
            }
        }
    }

    #[test]
    fn rest_and_motions_that_are_flat_where_they_turn() {
        for contact in contacts() {
            let slip = contact.slip_displacement;
            for constant in [0.0, 0.4 * slip, -0.4 * slip, 2.0 * slip, -1e100] {
                let (force, jacobian, energy) = all(&contact, 16, &[constant, 0.0, 0.0, 0.0, 0.0]);
                let point = contact.curve_at_displacement(constant).unwrap();
                assert!((force[0] - point.force()).abs() < 1e-15 * contact.slip_force && energy == 0.0);
                assert!(force.iter().skip(1).all(|&force| force == 0.0));
                let stiffness = point.stiffness();
                for (place, value) in jacobian.iter().enumerate() {
                    let expected = if place % 6 == 0 { stiffness } else { 0.0 };
                    assert!((value - expected).abs() < 1e-14 * contact.initial_stiffness, "{place}");
                }
            }
            // cos t - cos(2t)/4 has its turn where three derivatives vanish; a little less or more makes one turn or three.
            for (part, size) in [-1e-3, -1e-9, -1e-17, 0.0, 1e-17, 1e-9, 1e-3]
                .into_iter()
                .flat_map(|part| [0.5, 1.0, 3.0].map(|size| (part, size * slip)))
            {
                let motion = [0.0, size, 0.0, -(0.25 + part) * size, 0.0];
                let (one, two) = (all(&contact, 128, &motion), all(&contact, 4096, &motion));
                assert!(off(&one.0, &two.0) < 1e-9 * contact.slip_force, "{part} {:e}", off(&one.0, &two.0));
                assert!((one.2 / two.2 - 1.0).abs() < 1e-13);
                let turned = all(&contact, 128, &turn(&motion, 0.77));
                // Instants known to the cube root of rounding.
                assert!(off(&turned.0, &turn(&one.0, 0.77)) < 1e-9 * contact.slip_force);
            }
        }
    }

    /// A cosine that starts upwards turns exactly at the seam of the half that is looked at.
    #[test]
    fn cosines_turn_where_the_period_begins() {
        for contact in contacts() {
            for size in [0.3, 2.0].map(|part| part * contact.slip_displacement) {
                let shapes = [[1.0, 0.0, 0.0], [1.0, 0.0, 0.05], [0.0, 0.0, 1.0], [1.0, 0.0, -0.3]];
                for shape in shapes {
                    let motion = |sign: f64| {
                        let [one, two, three] = shape.map(|part| sign * size * part);
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

    /// Turning points at the top, all equally far to rounding: what comes after the first of them has not turned.
    #[test]
    fn a_flat_top_is_where_the_walk_begins() {
        let contact = contact(50e-6);
        let size = 0.3 * contact.slip_displacement;
        for (distance, by) in (6..14).flat_map(|tenths| [0.0, 1.1, 2.2].map(|by| (f64::from(tenths) / 10.0, by))) {
            // cos t - (1/9 + part) cos 3t turns three times within so many steps of the grid, and ε⁴ is below rounding.
            let step = 2.0 * PI / f64::from(1 << 17);
            let part = (distance * step) * (distance * step) / 6.75;
            let motion = turn(&[0.0, size, 0.0, 0.0, 0.0, -(1.0 / 9.0 + part) * size, 0.0], by);
            let (one, two) = (all(&contact, 1 << 17, &motion), all(&contact, 256, &motion));
            assert!(off(&one.0, &two.0) < 1e-9 * contact.slip_force, "{distance} {by}");
            assert!((one.2 / two.2 - 1.0).abs() < 1e-12, "{distance} {by}: {} {}", one.2, two.2);
        }
    }

    #[test]
    fn a_large_motion_meets_a_square_wave() {
        let contact = contact(0.0);
        let huge = 1e9 * contact.slip_displacement;
        let (force, _, energy) = all(&contact, 16, &[0.0, 0.0, huge, 0.0, 0.0, 0.0, 0.0]);
        // What sticks does so for 1e-4 of the period.
        assert!((force[1] / contact.slip_force * PI / 4.0 - 1.0).abs() < 1e-4);
        assert!((energy / (4.0 * contact.slip_force * huge) - 1.0).abs() < 1e-8);
        let square: f64 = force.iter().map(|force| force * force).sum();
        assert!((square.sqrt() / contact.slip_force / (4.0 / PI * (1.0 + 1.0 / 9.0f64).sqrt()) - 1.0).abs() < 1e-4);
    }
}
