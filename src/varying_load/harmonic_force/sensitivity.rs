//! Derivatives of the tangential forces by the motion, gathered piece by piece.
//!
//! With f = dN/dS = 1/K_t the force of a diagram P(S) is `T = ∫ f dP`. If P moves by δP(S) at fixed S,
//!
//! ```text
//! dT = f(S_b) du - Σ_pieces ∫ f' δP dS,     with f(0) δo added for the piece at the centre.
//! ```
//!
//! - A slip zone is a line of the sample j that made it last, δP = dλ, λ = ξ_j or η_j: `∫ = (f_2 - f_1) dλ`.
//! - A stuck piece from sample i to j has `δP = e_i + (e_j - e_i)(S - S_i)/(S_j - S_i)` with `e = du - D dS`:
//!   `∫ = (f_2 - f_i) e_i + g (e_j - e_i)`, `g = [(S_2 - S_i) f_2 - (N_2 - N_i)]/(S_j - S_i)`.
//! - The part with D = 0 never moves.
//!
//! S_2 is the outer end of the piece, which later samples cut. What depends on the sample itself is a weighted sum over
//! `φ ⊗ φ`, composed of Fourier sums of the weights. Everything else is gathered by pieces: each sums φ of the later samples times
//! its weight, which is constant while it is covered, so that differences of antiderivatives of φ give the sums. Once the piece is
//! removed, the sum is added to those of the one or two samples that made it; in the end `J += Σ Y_j ⊗ φ_j`.

use crate::hbm::fourier::angle;
use crate::hbm::workspace::Blocks;
use crate::varying_load::element::Element;
use crate::varying_load::harmonic_force::samples::{Part, Samples, at};
use crate::varying_load::harmonic_force::tractions::Tractions;
use crate::varying_load::harmonic_force::walk::{Kind, Run, Runs, closing};
use core::f64::consts::PI;

/// Doubles of a piece in the workspace.
pub(super) const PIECE: usize = 4;

/// Blocks of four in a row over the coefficients 1, cos t, sin t, cos 2t, ...
pub(super) fn row_blocks(harmonics: usize) -> usize {
    (2 * harmonics + 1).div_ceil(4)
}

/// Fills the rows φ of all samples, and of their antiderivatives A, which are 0 for the constant and otherwise
/// `A(n) - A(m) = φ(m) + ... + φ(n-1)`.
pub(super) fn fill_rows(rows: &mut [f64], antiderivatives: &mut [f64], harmonics: usize, samples: usize) {
    let stride = (4 * row_blocks(harmonics)).max(4);
    for (n, row) in rows.chunks_exact_mut(stride).enumerate() {
        row.fill(0.0);
        for (c, value) in row.iter_mut().take(2 * harmonics + 1).enumerate() {
            let angle = angle(c.div_ceil(2), n, samples);
            *value = if c % 2 == 0 && c > 0 { angle.sin() } else { angle.cos() };
        }
    }
    for (n, row) in antiderivatives.chunks_exact_mut(stride).enumerate() {
        row.fill(0.0);
        for (c, value) in row.iter_mut().take(2 * harmonics + 1).enumerate().skip(1) {
            let order = c.div_ceil(2);
            // Sums of a geometric series: the angle half a step before the sample.
            let angle = angle(order, 2 * n + 2 * samples - 1, 2 * samples);
            let scale = 0.5 / (PI * order as f64 / samples as f64).sin();
            *value = scale * if c % 2 == 0 { -angle.cos() } else { angle.sin() };
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Made {
    /// The part with D = 0.
    Never,
    /// By slip, forwards or backwards.
    Forwards,
    Backwards,
    /// By sticking, between two samples.
    BySticking,
    /// By sticking, since the contact closed after the sample before.
    SinceClosing,
}

/// A piece of the diagram, and its weights for the later samples.
#[derive(Debug, Clone, Copy)]
struct Piece {
    made: Made,
    /// The sample that made it.
    sample: usize,
    /// Weights of the constant part and of the linear part for samples from `since` on, counted along the walk.
    weights: [f64; 2],
    since: usize,
    /// f at the inner end of a slip zone.
    inner_stiffness: f64,
    /// Whether sums were stored.
    stored: bool,
}

impl Piece {
    #[inline(always)]
    fn encoded(&self) -> [f64; PIECE] {
        let word =
            self.made as u64 | u64::from(self.stored) << 3 | (self.sample as u64) << 4 | (self.since as u64) << 34;
        [f64::from_bits(word), self.weights[0], self.weights[1], self.inner_stiffness]
    }

    #[inline(always)]
    fn decoded([word, constant, linear, inner_stiffness]: [f64; PIECE]) -> Piece {
        let word = word.to_bits();
        Piece {
            made: match word & 7 {
                0 => Made::Never,
                1 => Made::Forwards,
                2 => Made::Backwards,
                3 => Made::BySticking,
                _ => Made::SinceClosing,
            },
            sample: ((word >> 4) & ((1 << 30) - 1)) as usize,
            weights: [constant, linear],
            since: (word >> 34) as usize,
            inner_stiffness,
            stored: word & 8 != 0,
        }
    }

    fn is_stuck(&self) -> bool {
        matches!(self.made, Made::BySticking | Made::SinceClosing)
    }
}

/// Ends of a stuck piece: S, N and f of the inner end, and 1/(S_j - S_i).
#[derive(Debug, Clone, Copy)]
struct Ends {
    shift: f64,
    load: f64,
    stiffness: f64,
    inverse_width: f64,
}

impl Ends {
    /// Weights of the constant and of the linear part if the outer end has the given S, N and f.
    #[inline(always)]
    fn weights_to(&self, shift: f64, load: f64, stiffness: f64) -> [f64; 2] {
        let linear = (shift - self.shift) * stiffness - (load - self.load);
        [stiffness - self.stiffness, linear * self.inverse_width]
    }
}

/// Tables and memory.
#[derive(Debug)]
pub(super) struct Sensitivity<'a> {
    pub row_blocks: usize,
    /// φ and A of each sample.
    pub rows: &'a Blocks,
    pub antiderivatives: &'a Blocks,
    pub pieces: &'a mut [[f64; PIECE]],
    /// Sums of φ times both weights of each piece, and a row for the sums of a piece that was never cut.
    pub gathered: [&'a mut Blocks; 2],
    pub covered: &'a mut Blocks,
    /// Place of each sample in the following, or -1; rows φ of these samples, and rows Y by u and by the input.
    pub places: &'a mut [f64],
    pub touched: usize,
    pub touched_rows: &'a mut Blocks,
    pub by_displacement: &'a mut Blocks,
    pub by_input: &'a mut Blocks,
    /// Weights of φ ⊗ φ for the derivatives by u and by the input.
    pub own: [&'a mut [f64]; 2],
}

/// A row of an array of rows.
#[inline(always)]
fn row_of(blocks: &Blocks, index: usize, length: usize) -> &Blocks {
    blocks.get(index * length..).and_then(|rows| rows.get(..length)).unwrap_or(&[])
}

#[inline(always)]
fn row_of_mut(blocks: &mut Blocks, index: usize, length: usize) -> &mut Blocks {
    blocks.get_mut(index * length..).and_then(|rows| rows.get_mut(..length)).unwrap_or(&mut [])
}

#[inline(always)]
fn add_scaled(target: &mut Blocks, scale: f64, row: &Blocks) {
    for (target, row) in target.iter_mut().zip(row) {
        for k in 0..4 {
            target[k] += scale * row[k];
        }
    }
}

/// The sum of φ over `count` samples, from A behind and before them.
#[inline(always)]
fn sum_between(target: &mut Blocks, to: &Blocks, from: &Blocks, count: usize) {
    for ((target, to), from) in target.iter_mut().zip(to).zip(from) {
        for k in 0..4 {
            target[k] = to[k] - from[k];
        }
    }
    if let Some([constant, ..]) = target.first_mut() {
        *constant = count as f64;
    }
}

/// The motion.
#[derive(Debug, Clone, Copy)]
pub(super) struct Context<'c> {
    pub element: &'c Element,
    pub samples: &'c Samples<'c>,
    pub part: &'c Part,
}

impl Context<'_> {
    /// The sample after the given number of samples from the start.
    #[inline(always)]
    fn sample_at(&self, step: usize) -> usize {
        let sample = self.part.start + step;
        if sample >= self.samples.count { sample - self.samples.count } else { sample }
    }

    /// The ends of the stuck piece that a sample made.
    #[inline(always)]
    fn ends(&self, made: Made, sample: usize) -> Ends {
        let samples = self.samples;
        let before = samples.before(sample);
        let [shift, load, stiffness] = if made == Made::SinceClosing {
            [0.0; 3]
        } else {
            [at(samples.shift, before), at(samples.load, before), at(samples.stiffness, before)]
        };
        Ends { shift, load, stiffness, inverse_width: 1.0 / (at(samples.shift, sample) - shift) }
    }
}

impl Sensitivity<'_> {
    /// Gathers the derivatives along the runs.
    #[inline(always)]
    pub fn gather(&mut self, context: &Context, tractions: &Tractions, cut_shift: &[f64], runs: Runs) {
        let Context { element, samples, .. } = *context;
        self.places.fill(-1.0);
        self.touched = 0;
        // Pieces are counted from the centre: piece k ends at knot k.
        let mut depth = 0;
        let mut now = 0;
        for run in runs {
            let range = run.first..run.first + run.count;
            let last = range.end.saturating_sub(1);
            let kept = match run.kind {
                Kind::Slip => run.kept,
                Kind::Stuck => run.kept.saturating_sub(1),
                Kind::Open | Kind::GrossSlip => 0,
            };
            while depth > kept {
                depth -= 1;
                self.remove(context, tractions, depth, now);
            }
            let [by_u, by_input] = &mut self.own;
            let by_u = by_u.get_mut(range.clone()).unwrap_or(&mut []);
            let by_input = by_input.get_mut(range.clone()).unwrap_or(&mut []);
            let mu = run.sign * element.friction_coefficient;
            let made = if run.sign > 0.0 { Made::Forwards } else { Made::Backwards };
            let line = Piece {
                made,
                sample: last,
                weights: [at(samples.stiffness, last), 0.0],
                since: now + run.count,
                inner_stiffness: 0.0,
                stored: false,
            };
            match run.kind {
                Kind::Open => {
                    by_u.fill(0.0);
                    by_input.fill(0.0);
                }
                Kind::GrossSlip => {
                    by_u.fill(0.0);
                    let slopes = samples.load_slope.get(range).unwrap_or(&[]);
                    by_input.iter_mut().zip(slopes).for_each(|(weight, slope)| *weight = mu * slope);
                    self.push(&mut depth, &line);
                }
                Kind::Stuck => {
                    by_input.fill(0.0);
                    let stiffnesses = samples.stiffness.get(range).unwrap_or(&[]);
                    by_u.iter_mut().zip(stiffnesses).for_each(|(weight, stiffness)| *weight = *stiffness);
                    self.stick(context, &run, now, &mut depth);
                }
                Kind::Slip => {
                    let packed = run.packed..run.packed + run.count;
                    let cuts = Cuts {
                        shifts: cut_shift.get(packed.clone()).unwrap_or(&[]),
                        loads: tractions.cut_load.get(packed.clone()).unwrap_or(&[]),
                        stiffnesses: tractions.cut_stiffness.get(packed).unwrap_or(&[]),
                    };
                    let stiffnesses = samples.stiffness.get(range.clone()).unwrap_or(&[]);
                    let slopes = samples.shift_slope.get(range).unwrap_or(&[]);
                    for ((((by_u, by_input), cut), stiffness), slope) in
                        by_u.iter_mut().zip(by_input).zip(cuts.stiffnesses).zip(stiffnesses).zip(slopes)
                    {
                        *by_u = *cut;
                        *by_input = mu * slope * (stiffness - cut);
                    }
                    if depth < run.kept {
                        self.push(&mut depth, &Piece { made: Made::Never, ..line });
                    }
                    self.cut(context, depth.saturating_sub(1), now, &run, &cuts);
                    let cut = cuts.stiffnesses.last().copied().unwrap_or(0.0);
                    self.push(
                        &mut depth,
                        &Piece { weights: [line.weights[0] - cut, 0.0], inner_stiffness: cut, ..line },
                    );
                }
            }
            now += run.count;
        }
        while depth > 0 {
            depth -= 1;
            self.remove(context, tractions, depth, now);
        }
    }

    #[inline(always)]
    fn push(&mut self, depth: &mut usize, piece: &Piece) {
        if let Some(place) = self.pieces.get_mut(*depth) {
            *place = piece.encoded();
            *depth += 1;
        }
    }

    /// Pushes a piece for each sample of a run that sticks.
    #[inline(always)]
    fn stick(&mut self, context: &Context, run: &Run, now: usize, depth: &mut usize) {
        let Context { samples, part, .. } = *context;
        let closes = part.opens && samples.is_open(samples.before(run.first));
        let mut made = if closes { Made::SinceClosing } else { Made::BySticking };
        let mut inner = context.ends(made, run.first);
        for step in 0..run.count {
            let sample = run.first + step;
            let [shift, load, stiffness] =
                [at(samples.shift, sample), at(samples.load, sample), at(samples.stiffness, sample)];
            inner.inverse_width = 1.0 / (shift - inner.shift);
            let weights = inner.weights_to(shift, load, stiffness);
            let piece = Piece { made, sample, weights, since: now + step, inner_stiffness: 0.0, stored: false };
            self.push(depth, &piece);
            inner = Ends { shift, load, stiffness, inverse_width: 0.0 };
            made = Made::BySticking;
        }
    }

    /// Adds the sums from `since` up to `now` with constant weights to those of a piece that is cut.
    #[inline(always)]
    fn gather_covered(&mut self, context: &Context, index: usize, piece: &mut Piece, now: usize) {
        let length = self.row_blocks;
        let parts = if piece.is_stuck() { 2 } else { 1 };
        if !piece.stored {
            self.gathered.iter_mut().take(parts).for_each(|rows| row_of_mut(rows, index, length).fill([0.0; 4]));
        }
        if now > piece.since {
            let to = row_of(self.antiderivatives, context.sample_at(now), length);
            let from = row_of(self.antiderivatives, context.sample_at(piece.since), length);
            sum_between(self.covered, to, from, now - piece.since);
            for (gathered, weight) in self.gathered.iter_mut().zip(piece.weights).take(parts) {
                add_scaled(row_of_mut(gathered, index, length), weight, self.covered);
            }
        }
        piece.stored = true;
        piece.since = now;
    }

    /// Cuts a piece by a run of slip.
    #[inline(always)]
    fn cut(&mut self, context: &Context, index: usize, now: usize, run: &Run, cuts: &Cuts) {
        let Some(mut piece) = self.pieces.get(index).copied().map(Piece::decoded) else { return };
        if piece.made == Made::Never {
            return;
        }
        self.gather_covered(context, index, &mut piece, now);
        let length = self.row_blocks;
        let [constant, linear] = &mut self.gathered;
        let (constant, linear) = (row_of_mut(constant, index, length), row_of_mut(linear, index, length));
        let rows = self.rows.get(run.first * length..).unwrap_or(&[]).chunks_exact(length.max(1));
        if piece.is_stuck() {
            let ends = context.ends(piece.made, piece.sample);
            for (((row, &shift), &load), &stiffness) in rows.zip(cuts.shifts).zip(cuts.loads).zip(cuts.stiffnesses) {
                piece.weights = ends.weights_to(shift, load, stiffness);
                let [by_constant, by_linear] = piece.weights;
                for ((constant, linear), row) in constant.iter_mut().zip(linear.iter_mut()).zip(row) {
                    for k in 0..4 {
                        constant[k] += by_constant * row[k];
                        linear[k] += by_linear * row[k];
                    }
                }
            }
        } else {
            for (row, &stiffness) in rows.zip(cuts.stiffnesses) {
                piece.weights[0] = stiffness - piece.inner_stiffness;
                add_scaled(constant, piece.weights[0], row);
            }
        }
        piece.since = now + run.count;
        if let Some(place) = self.pieces.get_mut(index) {
            *place = piece.encoded();
        }
    }

    /// Adds the sums of a piece that is removed to those of the samples that made it.
    #[inline(always)]
    fn remove(&mut self, context: &Context, tractions: &Tractions, index: usize, now: usize) {
        let Context { element, samples, .. } = *context;
        let Some(mut piece) = self.pieces.get(index).copied().map(Piece::decoded) else { return };
        if piece.made == Made::Never || (!piece.stored && now <= piece.since) {
            return;
        }
        // The sums of both parts: parts[0] times one row, and parts[1] times the other.
        let parts = if piece.stored {
            self.gather_covered(context, index, &mut piece, now);
            None
        } else {
            let length = self.row_blocks;
            let to = row_of(self.antiderivatives, context.sample_at(now), length);
            let from = row_of(self.antiderivatives, context.sample_at(piece.since), length);
            sum_between(self.covered, to, from, now - piece.since);
            Some(piece.weights)
        };
        let sample = piece.sample;
        let before = samples.before(sample);
        let shift_slope = |sample| at(samples.shift_slope, sample);
        // Derivatives -V_1 e_i - V_2 (e_j - e_i).
        match piece.made {
            Made::Never => {}
            Made::Forwards | Made::Backwards => {
                let sign = if piece.made == Made::Forwards { 1.0 } else { -1.0 };
                let by_input = sign * element.friction_coefficient * shift_slope(sample);
                self.distribute(index, parts, [1.0, 0.0], sample, [-1.0, by_input]);
            }
            Made::BySticking => {
                let slope = at(tractions.slope, sample);
                self.distribute(index, parts, [0.0, 1.0], sample, [-1.0, slope * shift_slope(sample)]);
                self.distribute(index, parts, [-1.0, 1.0], before, [1.0, -slope * shift_slope(before)]);
            }
            Made::SinceClosing => {
                let slope = at(tractions.slope, sample);
                let closing = closing(samples, element.by_approach(), sample);
                self.distribute(index, parts, [0.0, 1.0], sample, [-1.0, slope * shift_slope(sample)]);
                self.distribute(index, parts, [-1.0, 1.0], before, closing.before);
                self.distribute(index, parts, [-1.0, 1.0], sample, closing.after);
            }
        }
    }

    /// Adds `factors[0] V_1 + factors[1] V_2` times the derivatives by u and by the input to the rows of a sample. Given weights, both V are
    /// multiples of the row `covered`.
    #[inline(always)]
    fn distribute(
        &mut self,
        index: usize,
        weights: Option<[f64; 2]>,
        factors: [f64; 2],
        sample: usize,
        [by_u, by_input]: [f64; 2],
    ) {
        let length = self.row_blocks;
        let place = self.touch(sample);
        let u_row = row_of_mut(self.by_displacement, place, length);
        let input_row = row_of_mut(self.by_input, place, length);
        let [one, two] = &self.gathered;
        if let Some(weights) = weights {
            let factor = factors[0] * weights[0] + factors[1] * weights[1];
            let (by_u, by_input) = (factor * by_u, factor * by_input);
            for ((u_row, input_row), v) in u_row.iter_mut().zip(input_row).zip(self.covered.iter()) {
                for k in 0..4 {
                    u_row[k] += by_u * v[k];
                    input_row[k] += by_input * v[k];
                }
            }
        } else if factors[1] == 0.0 {
            let one = row_of(one, index, length);
            for ((u_row, input_row), v) in u_row.iter_mut().zip(input_row).zip(one) {
                for k in 0..4 {
                    u_row[k] += by_u * v[k];
                    input_row[k] += by_input * v[k];
                }
            }
        } else {
            let (one, two) = (row_of(one, index, length), row_of(two, index, length));
            for (((u_row, input_row), one), two) in u_row.iter_mut().zip(input_row).zip(one).zip(two) {
                for k in 0..4 {
                    let v = factors[0] * one[k] + factors[1] * two[k];
                    u_row[k] += by_u * v;
                    input_row[k] += by_input * v;
                }
            }
        }
    }

    /// The place of a sample among those that have rows Y.
    #[inline(always)]
    fn touch(&mut self, sample: usize) -> usize {
        let Some(place) = self.places.get_mut(sample) else { return 0 };
        if *place >= 0.0 {
            return *place as usize;
        }
        let (length, index) = (self.row_blocks, self.touched);
        *place = index as f64;
        self.touched += 1;
        row_of_mut(self.by_displacement, index, length).fill([0.0; 4]);
        row_of_mut(self.by_input, index, length).fill([0.0; 4]);
        let row = row_of(self.rows, sample, length);
        row_of_mut(self.touched_rows, index, length).iter_mut().zip(row).for_each(|(place, row)| *place = *row);
        index
    }

    /// `Σ Y_j ⊗ φ_j`, pairs of columns, for the derivatives by u (0) or by the input (1).
    #[inline(always)]
    pub fn products(&self, index: usize, products: &mut Blocks) {
        let length = self.row_blocks;
        let rows = if index == 0 { &*self.by_displacement } else { &*self.by_input };
        let used = self.touched * length;
        let (rows, phi) = (rows.get(..used).unwrap_or(&[]), self.touched_rows.get(..used).unwrap_or(&[]));
        let mut first = 0;
        while first < length {
            let columns = products.chunks_exact_mut((2 * length).max(1));
            match length - first {
                1 => products_of::<1>(rows, phi, length, first, columns),
                2 => products_of::<2>(rows, phi, length, first, columns),
                3 => products_of::<3>(rows, phi, length, first, columns),
                4 => products_of::<4>(rows, phi, length, first, columns),
                _ => products_of::<5>(rows, phi, length, first, columns),
            }
            first += 5;
        }
    }
}

/// Boundaries of the slip zones of a run: S, N and f.
struct Cuts<'c> {
    shifts: &'c [f64],
    loads: &'c [f64],
    stiffnesses: &'c [f64],
}

/// N blocks of pairs of columns, from the block `first` of each row on.
#[inline(always)]
fn products_of<'p, const N: usize>(
    rows: &Blocks,
    phi: &Blocks,
    length: usize,
    first: usize,
    columns: impl Iterator<Item = &'p mut Blocks>,
) {
    for (pair, columns) in columns.enumerate() {
        let (mut one, mut two) = ([[0.0; 4]; N], [[0.0; 4]; N]);
        for (row, phi) in rows.chunks_exact(length).zip(phi.chunks_exact(length)) {
            let row: Option<&[[f64; 4]; N]> = row.get(first..).and_then(<[_]>::first_chunk);
            let phi = phi.as_flattened().as_chunks::<2>().0.get(pair);
            let (Some(row), Some(&[a, b])) = (row, phi) else { continue };
            for block in 0..N {
                for k in 0..4 {
                    one[block][k] += a * row[block][k];
                    two[block][k] += b * row[block][k];
                }
            }
        }
        for (column, sums) in columns.chunks_exact_mut(length).zip([one, two]) {
            let column: Option<&mut [[f64; 4]; N]> = column.get_mut(first..).and_then(<[_]>::first_chunk_mut);
            if let Some(column) = column {
                *column = sums;
            }
        }
    }
}
