//! Derivatives of the tangential forces by the motion, gathered piece by piece.
//!
//! With dN = dS/K_t the force of a diagram u(S) is `T = ∫ du/K_t`. If u(S) moves by δu(S) at fixed S,
//!
//! ```text
//! δT = δu/K_t at S_b - Σ_pieces ∫ δu d(1/K_t),     with δo/K_t at S = 0 added for the piece at the centre.
//! ```
//!
//! - A slip zone is a line of the sample j that made it last, δu = δξ_j or δη_j: the integral is δu times the rise of 1/K_t along
//!   it.
//! - A stuck piece from sample i to j has `δu = m_i + (m_j - m_i)(S - S_i)/(S_j - S_i)` with the motion `m = δu - D δS` of a
//!   sample: the integral is m_i times the rise of 1/K_t from S_i to S_2 (the constant weight), and m_j - m_i times the linear
//!   weight, `[(S_2 - S_i)/K_t(S_2) - (N_2 - N_i)]/(S_j - S_i)`.
//! - The core of the contact, which keeps D = 0 throughout the period, never moves.
//!
//! S_2 is the outer end of the piece, which later samples cut. What depends on the sample itself is a weighted sum over `φ ⊗ φ`,
//! composed of Fourier sums of the weights. Everything else is gathered by pieces. Each piece adds up φ of the later samples times
//! its weight. While later slip zones cover the piece its weight is constant, and the sum is a difference of antiderivatives of φ.
//! Once the piece is removed, the sum is added to those of the one or two samples that made it; in the end the Jacobian grows by
//! `Σ Y_j ⊗ φ_j`.

use crate::element::Element;
use crate::fourier::rows::{
    OuterProducts, RowStrips, Rows, Strip, StripTerms, add_scaled, row_blocks, scaled, with_strips,
};
use crate::fourier::workspace::Blocks;
use crate::numerics::guard::quotient;
use crate::numerics::record::record;
use crate::numerics::slices::{PanicFreeSlice, Stack, Zero};
use crate::one_direction::harmonic_force::runs::{Run, closing};
use crate::one_direction::harmonic_force::samples::{EvaluatedPart, Samples};
use crate::one_direction::step::Crossing;

record! {
    /// A piece of the diagram, and its weights for the later samples.
    #[derive(Default)]
    pub(super) struct Piece {
        /// [`Piece::CORE`], [`Piece::FORWARDS`] and so on: how the piece was made.
        made: u64,
        /// The sample that made the piece.
        sample: u64,
        /// Weights of the constant part and of the linear part for samples from `since` on, counted along the path.
        weights: [f64; 2],
        since: u64,
        /// Slip zone: 1/K_t at the inner end; stuck: 1/(S_j - S_i).
        parameter: f64,
        /// 1 if sums of earlier samples are stored.
        stored: u64,
    }
}

impl Piece {
    /// The core of the contact, which keeps D = 0 throughout the period.
    const CORE: u64 = 0;
    /// A slip zone of forward or backward slip.
    const FORWARDS: u64 = 1;
    const BACKWARDS: u64 = 2;
    /// The piece was loaded between two samples while everything stuck.
    const BY_STICKING: u64 = 3;
    /// The same after the contact closed between the two samples.
    const SINCE_CLOSING: u64 = 4;

    fn is_stuck(&self) -> bool {
        self.made >= Piece::BY_STICKING
    }
}

/// Weights of the constant and of the linear part of a stuck piece, with S, N and 1/K_t at its inner and at its outer end.
fn weights_of_stuck(
    inverse_width: f64,
    [s_i, n_i, stiffness_i]: [f64; 3],
    [shift, load, stiffness]: [f64; 3],
) -> [f64; 2] {
    [stiffness - stiffness_i, ((shift - s_i) * stiffness - (load - n_i)) * inverse_width]
}

/// Tables and scratch memory of the Jacobian.
pub(super) struct JacobianMemory<'a> {
    pub rows: Rows<'a>,
    pub pieces: &'a mut [Piece],
    /// Sums of φ times both weights of pieces that were cut, up to the last cut.
    pub stored: &'a mut Blocks,
    /// Index of the term of each sample among the outer products, or -1 without one.
    pub places: &'a mut [f64],
    /// Rows Y by u and by the input.
    pub outer: OuterProducts<'a>,
    /// Weights of φ ⊗ φ for the derivatives by u and by the input.
    pub own: [&'a mut [f64]; 2],
}

/// The motion, and the boundaries of its slip zones, packed: S, N and 1/K_t.
pub(super) struct Context<'c> {
    pub element: &'c Element,
    pub samples: &'c Samples<'c>,
    pub part: &'c EvaluatedPart,
    pub cut_shifts: &'c [f64],
    pub cut_loads: &'c [f64],
    pub cut_stiffnesses: &'c [f64],
    /// D of the pieces that were loaded between two samples while everything stuck.
    pub slopes: &'c [f64],
}

impl Context<'_> {
    /// The sample after the given number of samples from the start.
    fn sample_at(&self, step: usize) -> usize {
        let sample = self.part.start + step;
        if sample >= self.samples.count { sample - self.samples.count } else { sample }
    }

    /// S, N and 1/K_t of the whole contact at a sample: 0 if it is open.
    fn contact_at(&self, sample: usize) -> [f64; 3] {
        let Samples { shift, load, stiffness, .. } = self.samples;
        [shift.or_zero(sample), load.or_zero(sample), stiffness.or_zero(sample)]
    }
}

impl JacobianMemory<'_> {
    /// Gathers the derivatives along the runs.
    #[inline(never)]
    pub fn gather(&mut self, context: &Context, runs: &[Run]) {
        runs.iter().for_each(|run| self.write_own(context, run));
        with_strips!(row_blocks(self.rows.harmonics), self.gather_strips(context, runs));
    }

    /// Writes the weights of φ ⊗ φ of the samples of a run.
    fn write_own(&mut self, context: &Context, run: &Run) {
        let Context { element, samples, cut_stiffnesses, .. } = *context;
        let [by_u, by_input] = &mut self.own;
        let (by_u, by_input) = (by_u.part_mut(run.samples()), by_input.part_mut(run.samples()));
        let slip_slope = run.sign * element.friction_coefficient;
        match run.kind {
            Run::OPEN | Run::GROSS_SLIP => {
                by_u.fill(0.0);
                by_input
                    .iter_mut()
                    .zip(run.part_of(samples.load_slope))
                    .for_each(|(weight, slope)| *weight = slip_slope * slope);
            }
            Run::STUCK => {
                by_input.fill(0.0);
                by_u.copy_from(run.part_of(samples.stiffness));
            }
            _ => {
                let cuts = cut_stiffnesses.part(run.cuts());
                let values = cuts.iter().zip(run.part_of(samples.stiffness)).zip(run.part_of(samples.shift_slope));
                for ((by_u, by_input), ((cut, stiffness), slope)) in by_u.iter_mut().zip(by_input).zip(values) {
                    *by_u = *cut;
                    *by_input = slip_slope * slope * (stiffness - cut);
                }
            }
        }
    }

    fn gather_strips<const N: usize>(&mut self, context: &Context, runs: &[Run]) {
        let JacobianMemory { rows, pieces, stored, places, outer, .. } = self;
        let stored = stored.blocks_mut::<N>().blocks_mut();
        for strip in 0..outer.strips::<N>() {
            places.fill(-1.0);
            let (rows, terms) = (rows.strips(strip), outer.terms(strip));
            let stack = Stack { values: pieces, depth: 0 };
            let mut gathering = Gathering { context, rows, stack, stored, places, terms };
            gathering.gather(runs);
        }
    }
}

/// Pieces of the diagram: piece k ends at knot k, counted from the centre.
type Pieces<'c> = Stack<'c, Piece>;

impl Pieces<'_> {
    /// Pushes a piece for each sample of a run that sticks. Compiled once, not for each length of a row.
    #[inline(never)]
    fn stick(&mut self, context: &Context, run: &Run, now: usize) {
        let Context { samples, part, .. } = *context;
        let range = run.samples();
        let closes = part.opens && samples.is_open(samples.before(range.start));
        let mut made = if closes { Piece::SINCE_CLOSING } else { Piece::BY_STICKING };
        let mut inner = context.contact_at(samples.before(range.start));
        for (since, sample) in (now..).zip(range) {
            let outer = context.contact_at(sample);
            // S rises between samples that stick, but rounding may make both values equal.
            let parameter = quotient(1.0, outer[0] - inner[0]);
            let weights = weights_of_stuck(parameter, inner, outer);
            let (sample, since) = (sample as u64, since as u64);
            self.push(Piece { made, sample, weights, since, parameter, ..Piece::default() });
            inner = outer;
            made = Piece::BY_STICKING;
        }
    }
}

/// The derivatives in strips of N blocks.
struct Gathering<'c, const N: usize> {
    context: &'c Context<'c>,
    rows: RowStrips<'c, N>,
    stack: Pieces<'c>,
    stored: &'c mut [[Strip<N>; 2]],
    places: &'c mut [f64],
    terms: StripTerms<'c, N, 2>,
}

impl<const N: usize> Gathering<'_, N> {
    fn gather(&mut self, runs: &[Run]) {
        let samples = self.context.samples;
        let mut now = 0;
        for run in runs.iter().chain([&Run::default()]) {
            let range = run.samples();
            let (count, last) = (range.len(), range.end.saturating_sub(1));
            let kept = match run.kind {
                Run::SLIP => run.kept(),
                Run::STUCK => run.kept().saturating_sub(1),
                _ => 0,
            };
            self.remove_beyond(kept, now);
            let line = Piece {
                made: if run.sign > 0.0 { Piece::FORWARDS } else { Piece::BACKWARDS },
                sample: last as u64,
                weights: [samples.stiffness.or_zero(last), 0.0],
                since: (now + count) as u64,
                ..Piece::default()
            };
            match run.kind {
                Run::OPEN => {}
                Run::GROSS_SLIP => self.stack.push(line),
                Run::STUCK => self.stack.stick(self.context, run, now),
                _ => {
                    if self.stack.depth < run.kept() {
                        self.stack.push(Piece { made: Piece::CORE, ..line });
                    }
                    self.cut(run, now);
                    let cut = self.context.cut_stiffnesses.or_zero(run.cuts().end.saturating_sub(1));
                    self.stack.push(Piece { weights: [line.weights[0] - cut, 0.0], parameter: cut, ..line });
                }
            }
            now += count;
        }
    }

    /// Adds the sum of φ over steps with constant weights.
    fn add_covered(&self, sums: &mut [Strip<N>; 2], weights: [f64; 2], since: usize, now: usize) {
        if now <= since {
            return;
        }
        let covered = self.rows.sum_between(self.context.sample_at(since), self.context.sample_at(now), now - since);
        let [constant, linear] = sums;
        add_scaled(constant, weights[0], &covered);
        add_scaled(linear, weights[1], &covered);
    }

    /// The sums of a piece over the samples before a step.
    #[inline(always)]
    fn sums(&self, index: usize, piece: &Piece, now: usize) -> [Strip<N>; 2] {
        let mut sums = if piece.stored > 0 { self.stored.or_zero(index) } else { Zero::zero() };
        self.add_covered(&mut sums, piece.weights, piece.since as usize, now);
        sums
    }

    /// Cuts the last piece by a run of slip: each sample has weights of its own.
    fn cut(&mut self, run: &Run, now: usize) {
        let index = self.stack.depth.saturating_sub(1);
        let mut piece = self.stack.values.or_zero(index);
        if piece.made == Piece::CORE {
            return;
        }
        let mut sums = self.sums(index, &piece, now);
        let Context { samples, cut_shifts, cut_loads, cut_stiffnesses, .. } = *self.context;
        let rows = self.rows.phi.part(run.samples());
        let [shifts, loads, stiffnesses] = [cut_shifts, cut_loads, cut_stiffnesses].map(|cuts| cuts.part(run.cuts()));
        let [constant, linear] = &mut sums;
        if piece.is_stuck() {
            let inner = self.context.contact_at(samples.before(piece.sample as usize));
            for (((row, &shift), &load), &stiffness) in rows.iter().zip(shifts).zip(loads).zip(stiffnesses) {
                piece.weights = weights_of_stuck(piece.parameter, inner, [shift, load, stiffness]);
                add_scaled(constant, piece.weights[0], row);
                add_scaled(linear, piece.weights[1], row);
            }
        } else {
            for (row, &stiffness) in rows.iter().zip(stiffnesses) {
                piece.weights[0] = stiffness - piece.parameter;
                add_scaled(constant, piece.weights[0], row);
            }
        }
        (piece.stored, piece.since) = (1, (now + run.samples().len()) as u64);
        self.stored.set(index, sums);
        self.stack.values.set(index, piece);
    }

    /// Removes all pieces but the given number.
    fn remove_beyond(&mut self, kept: usize, now: usize) {
        while self.stack.depth > kept {
            let index = self.stack.depth - 1;
            self.stack.depth = index;
            let piece = self.stack.values.or_zero(index);
            if piece.made != Piece::CORE && (piece.stored > 0 || now > piece.since as usize) {
                let sums = self.sums(index, &piece, now);
                self.distribute(&piece, &sums);
            }
        }
    }

    /// Adds the sums of a piece that is removed to those of the samples i and j that made it, with the opposite sign: the constant
    /// sum times m_i, the linear one times m_j - m_i.
    fn distribute(&mut self, piece: &Piece, [constant, linear]: &[Strip<N>; 2]) {
        let Context { element, samples, slopes, .. } = *self.context;
        let (made, sample) = (piece.made, piece.sample as usize);
        let shift_slope = samples.shift_slope.or_zero(sample);
        let mut difference = *linear;
        add_scaled(&mut difference, -1.0, constant);
        let (before, slope) = (samples.before(sample), slopes.or_zero(sample));
        let own = (sample, linear, [-1.0, slope * shift_slope]);
        // The parts are added in a loop, so that the compiler inlines `add` once: it is long.
        let (parts, count) = if !piece.is_stuck() {
            let slip_slope = element.friction_coefficient * if made == Piece::FORWARDS { 1.0 } else { -1.0 };
            ([(sample, constant, [-1.0, slip_slope * shift_slope]), own, own], 1)
        } else if made == Piece::BY_STICKING {
            let inner = (before, &difference, [1.0, -slope * samples.shift_slope.or_zero(before)]);
            ([own, inner, own], 2)
        } else {
            let Crossing { before: to_crossing, after, slope, .. } = closing(samples, element, sample);
            let [inner, outer] = [after, to_crossing].map(|share| [share, -share * slope]);
            ([own, (before, &difference, inner), (sample, &difference, outer)], 3)
        };
        for (sample, row, factors) in parts.into_iter().take(count) {
            self.add(sample, row, factors);
        }
    }

    /// Adds a row times the derivatives by u and by the input to the rows Y of a sample.
    fn add(&mut self, sample: usize, row: &Strip<N>, [by_u, by_input]: [f64; 2]) {
        let place = self.places.or_zero(sample);
        if place < 0.0 {
            self.places.set(sample, *self.terms.count as f64);
            self.terms.push([scaled(by_u, row), scaled(by_input, row)], &self.rows.phi.or_zero(sample));
        } else {
            let [mut u_row, mut input_row] = self.terms.y.or_zero(place as usize);
            add_scaled(&mut u_row, by_u, row);
            add_scaled(&mut input_row, by_input, row);
            self.terms.y.set(place as usize, [u_row, input_row]);
        }
    }
}
