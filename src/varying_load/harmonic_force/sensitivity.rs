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

/// Blocks of four in a row over the coefficients 1, cos t, sin t, cos 2t, ...: 1, 3, 5, for which the loops are compiled separately, or more.
pub(super) fn row_blocks(harmonics: usize) -> usize {
    let blocks = (2 * harmonics + 1).div_ceil(4);
    if blocks <= 5 { blocks | 1 } else { blocks }
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
    /// Place of each sample in the following, or -1; φ of these samples, for each pair of functions; rows Y by u and by the input.
    pub places: &'a mut [f64],
    pub touched: usize,
    pub touched_pairs: &'a mut [[f64; 2]],
    pub by_displacement: &'a mut Blocks,
    pub by_input: &'a mut Blocks,
    /// Weights of φ ⊗ φ for the derivatives by u and by the input.
    pub own: [&'a mut [f64]; 2],
}

/// A row of an array of rows; N is their length if it is known to the compiler, otherwise 0.
#[inline(always)]
fn row_of<const N: usize>(blocks: &Blocks, index: usize, length: usize) -> Option<&Blocks> {
    if N > 0 {
        let row: &[[f64; 4]; N] = blocks.get(index * N..)?.first_chunk()?;
        Some(row)
    } else {
        blocks.get(index * length..)?.get(..length)
    }
}

#[inline(always)]
fn row_of_mut<const N: usize>(blocks: &mut Blocks, index: usize, length: usize) -> Option<&mut Blocks> {
    if N > 0 {
        let row: &mut [[f64; 4]; N] = blocks.get_mut(index * N..)?.first_chunk_mut()?;
        Some(row)
    } else {
        blocks.get_mut(index * length..)?.get_mut(..length)
    }
}

/// `target + scale row`. All values are loaded before one is stored: otherwise the compiler, which cannot exclude that they overlap, would
/// not combine them in a vector.
#[inline(always)]
pub(super) fn plus(target: [f64; 4], scale: f64, row: [f64; 4]) -> [f64; 4] {
    let ([a, b, c, d], [e, f, g, h]) = (target, row);
    [a + scale * e, b + scale * f, c + scale * g, d + scale * h]
}

#[inline(always)]
fn add_scaled(target: &mut Blocks, scale: f64, row: &Blocks) {
    for (target, row) in target.iter_mut().zip(row) {
        *target = plus(*target, scale, *row);
    }
}

#[inline(always)]
fn set_scaled(target: &mut Blocks, scale: f64, row: &Blocks) {
    for (target, row) in target.iter_mut().zip(row) {
        let [a, b, c, d] = *row;
        *target = [scale * a, scale * b, scale * c, scale * d];
    }
}

/// A part of the derivative of a piece: a sample, factors of the sums of both parts, and derivatives by u and by the input.
#[derive(Debug, Clone, Copy)]
struct Term {
    sample: usize,
    factors: [f64; 2],
    derivatives: [f64; 2],
}

/// 1/width of a stuck piece: S rises, or rounding made two values equal.
#[inline(always)]
fn inverse(width: f64) -> f64 {
    1.0 / width.max(1e-300)
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
        Ends { shift, load, stiffness, inverse_width: inverse(at(samples.shift, sample) - shift) }
    }
}

impl Sensitivity<'_> {
    /// Gathers the derivatives along the runs.
    #[inline(always)]
    pub fn gather(&mut self, context: &Context, tractions: &Tractions, cut_shift: &[f64], runs: Runs) {
        match self.row_blocks {
            1 => self.gather_rows::<1>(context, tractions, cut_shift, runs),
            3 => self.gather_rows::<3>(context, tractions, cut_shift, runs),
            5 => self.gather_rows::<5>(context, tractions, cut_shift, runs),
            _ => self.gather_rows::<0>(context, tractions, cut_shift, runs),
        }
    }

    #[inline(always)]
    fn gather_rows<const N: usize>(&mut self, context: &Context, tractions: &Tractions, cut_shift: &[f64], runs: Runs) {
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
                self.remove::<N>(context, tractions, depth, now);
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
                    self.cut::<N>(context, depth.saturating_sub(1), now, &run, &cuts);
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
            self.remove::<N>(context, tractions, depth, now);
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
            inner.inverse_width = inverse(shift - inner.shift);
            let weights = inner.weights_to(shift, load, stiffness);
            let piece = Piece { made, sample, weights, since: now + step, inner_stiffness: 0.0, stored: false };
            self.push(depth, &piece);
            inner = Ends { shift, load, stiffness, inverse_width: 0.0 };
            made = Made::BySticking;
        }
    }

    /// The sum of φ over the samples from `since` up to `now`, in `covered`.
    #[inline(always)]
    fn sum_covered<const N: usize>(&mut self, context: &Context, since: usize, now: usize) {
        let length = self.row_blocks;
        let to = row_of::<N>(self.antiderivatives, context.sample_at(now), length);
        let from = row_of::<N>(self.antiderivatives, context.sample_at(since), length);
        let covered = row_of_mut::<N>(self.covered, 0, length);
        let (Some(to), Some(from), Some(covered)) = (to, from, covered) else { return };
        for ((covered, to), from) in covered.iter_mut().zip(to).zip(from) {
            let ([a, b, c, d], [e, f, g, h]) = (*to, *from);
            *covered = [a - e, b - f, c - g, d - h];
        }
        if let Some([constant, ..]) = covered.first_mut() {
            *constant = (now - since) as f64;
        }
    }

    /// Adds the sums from `since` up to `now` with constant weights to those of a piece that is cut.
    #[inline(always)]
    fn gather_covered<const N: usize>(&mut self, context: &Context, index: usize, piece: &mut Piece, now: usize) {
        if piece.stored && now <= piece.since {
            return;
        }
        self.sum_covered::<N>(context, piece.since, now);
        let length = self.row_blocks;
        for (gathered, weight) in self.gathered.iter_mut().zip(piece.weights) {
            let (covered, gathered) = (row_of::<N>(self.covered, 0, length), row_of_mut::<N>(gathered, index, length));
            let (Some(covered), Some(gathered)) = (covered, gathered) else { return };
            if piece.stored {
                add_scaled(gathered, weight, covered);
            } else {
                set_scaled(gathered, weight, covered);
            }
        }
        piece.stored = true;
        piece.since = now;
    }

    /// Cuts a piece by a run of slip.
    #[inline(always)]
    fn cut<const N: usize>(&mut self, context: &Context, index: usize, now: usize, run: &Run, cuts: &Cuts) {
        let Some(mut piece) = self.pieces.get(index).copied().map(Piece::decoded) else { return };
        if piece.made == Made::Never {
            return;
        }
        self.gather_covered::<N>(context, index, &mut piece, now);
        let length = self.row_blocks;
        let [constant, linear] = &mut self.gathered;
        let (constant, linear) = (row_of_mut::<N>(constant, index, length), row_of_mut::<N>(linear, index, length));
        let (Some(constant), Some(linear)) = (constant, linear) else { return };
        if piece.is_stuck() {
            let ends = context.ends(piece.made, piece.sample);
            let boundaries = cuts.shifts.iter().zip(cuts.loads).zip(cuts.stiffnesses);
            for (sample, ((&shift, &load), &stiffness)) in (run.first..).zip(boundaries) {
                piece.weights = ends.weights_to(shift, load, stiffness);
                if let Some(row) = row_of::<N>(self.rows, sample, length) {
                    add_scaled(constant, piece.weights[0], row);
                    add_scaled(linear, piece.weights[1], row);
                }
            }
        } else {
            for (sample, &stiffness) in (run.first..).zip(cuts.stiffnesses) {
                piece.weights[0] = stiffness - piece.inner_stiffness;
                if let Some(row) = row_of::<N>(self.rows, sample, length) {
                    add_scaled(constant, piece.weights[0], row);
                }
            }
        }
        piece.since = now + run.count;
        if let Some(place) = self.pieces.get_mut(index) {
            *place = piece.encoded();
        }
    }

    /// Adds the sums of a piece that is removed to those of the samples that made it.
    #[inline(always)]
    fn remove<const N: usize>(&mut self, context: &Context, tractions: &Tractions, index: usize, now: usize) {
        let Context { element, samples, .. } = *context;
        let Some(mut piece) = self.pieces.get(index).copied().map(Piece::decoded) else { return };
        if piece.made == Made::Never || (!piece.stored && now <= piece.since) {
            return;
        }
        if piece.stored {
            self.gather_covered::<N>(context, index, &mut piece, now);
        } else {
            self.sum_covered::<N>(context, piece.since, now);
        }
        let sample = piece.sample;
        let before = samples.before(sample);
        let shift_slope = |sample| at(samples.shift_slope, sample);
        // dT = -V_1 e_i - V_2 (e_j - e_i): samples, factors of both V, and derivatives by u and by the input.
        let mut terms = [Term { sample, factors: [0.0, 1.0], derivatives: [-1.0, 0.0] }; 3];
        let [at_sample, at_before, closes] = &mut terms;
        let mut count = 2;
        match piece.made {
            Made::Never => {}
            Made::Forwards | Made::Backwards => {
                let mu = element.friction_coefficient * if piece.made == Made::Forwards { 1.0 } else { -1.0 };
                (at_sample.factors, at_sample.derivatives[1]) = ([1.0, 0.0], mu * shift_slope(sample));
                count = 1;
            }
            Made::BySticking => {
                let slope = at(tractions.slope, sample);
                at_sample.derivatives[1] = slope * shift_slope(sample);
                let derivatives = [1.0, -slope * shift_slope(before)];
                *at_before = Term { sample: before, factors: [-1.0, 1.0], derivatives };
            }
            Made::SinceClosing => {
                let closing = closing(samples, element.by_approach(), sample);
                at_sample.derivatives[1] = at(tractions.slope, sample) * shift_slope(sample);
                *at_before = Term { sample: before, factors: [-1.0, 1.0], derivatives: closing.before };
                *closes = Term { sample, factors: [-1.0, 1.0], derivatives: closing.after };
                count = 3;
            }
        }
        for term in terms.iter().take(count) {
            self.distribute::<N>(index, &piece, term);
        }
    }

    /// Adds a term to the rows of its sample. Unless the sums of the piece were stored, they are multiples of the row `covered`.
    #[inline(always)]
    fn distribute<const N: usize>(&mut self, index: usize, piece: &Piece, term: &Term) {
        let length = self.row_blocks;
        let place = self.touch::<N>(term.sample);
        let u_row = row_of_mut::<N>(self.by_displacement, place, length);
        let input_row = row_of_mut::<N>(self.by_input, place, length);
        let (Some(u_row), Some(input_row)) = (u_row, input_row) else { return };
        let [by_u, by_input] = term.derivatives;
        let [constant, linear] = term.factors;
        if piece.stored {
            let [one, two] = &self.gathered;
            let rows = (row_of::<N>(one, index, length), row_of::<N>(two, index, length));
            let (Some(one), Some(two)) = rows else { return };
            for (((u_row, input_row), one), two) in u_row.iter_mut().zip(input_row).zip(one).zip(two) {
                let ([a, b, c, d], two) = (*one, *two);
                let v = plus([constant * a, constant * b, constant * c, constant * d], linear, two);
                let (u, input) = (plus(*u_row, by_u, v), plus(*input_row, by_input, v));
                (*u_row, *input_row) = (u, input);
            }
        } else {
            let factor = constant * piece.weights[0] + linear * piece.weights[1];
            let Some(covered) = row_of::<N>(self.covered, 0, length) else { return };
            add_scaled(u_row, factor * by_u, covered);
            add_scaled(input_row, factor * by_input, covered);
        }
    }

    /// The place of a sample among those that have rows Y.
    #[inline(always)]
    fn touch<const N: usize>(&mut self, sample: usize) -> usize {
        let Some(place) = self.places.get_mut(sample) else { return 0 };
        if *place >= 0.0 {
            return *place as usize;
        }
        let (length, index) = (self.row_blocks, self.touched);
        *place = index as f64;
        self.touched += 1;
        for rows in [&mut *self.by_displacement, &mut *self.by_input] {
            if let Some(row) = row_of_mut::<N>(rows, index, length) {
                row.iter_mut().for_each(|block| *block = [0.0; 4]);
            }
        }
        if let Some(row) = row_of::<N>(self.rows, sample, length) {
            let columns = self.touched_pairs.chunks_exact_mut(self.places.len().max(1));
            for (column, pair) in columns.zip(row.as_flattened().as_chunks::<2>().0) {
                if let Some(place) = column.get_mut(index) {
                    *place = *pair;
                }
            }
        }
        index
    }

    /// `Σ Y_j ⊗ φ_j`, pairs of columns, for the derivatives by u (0) or by the input (1).
    #[inline(always)]
    pub fn products(&self, index: usize, products: &mut Blocks) {
        let length = self.row_blocks;
        let rows = if index == 0 { &*self.by_displacement } else { &*self.by_input };
        let rows = rows.get(..self.touched * length).unwrap_or(&[]);
        let columns = self.touched_pairs.chunks_exact(self.places.len().max(1));
        for (columns, phi) in products.chunks_exact_mut((2 * length).max(1)).zip(columns) {
            match length {
                1 => products_of::<1>(rows, phi, columns),
                3 => products_of::<3>(rows, phi, columns),
                5 => products_of::<5>(rows, phi, columns),
                _ => {
                    columns.fill([0.0; 4]);
                    let (one, two) = columns.split_at_mut_checked(length).unwrap_or((&mut [], &mut []));
                    for (row, &[a, b]) in rows.chunks_exact(length.max(1)).zip(phi) {
                        add_scaled(one, a, row);
                        add_scaled(two, b, row);
                    }
                }
            }
        }
    }
}

/// Boundaries of the slip zones of a run: S, N and f.
struct Cuts<'c> {
    shifts: &'c [f64],
    loads: &'c [f64],
    stiffnesses: &'c [f64],
}

/// A pair of columns of N blocks each.
#[inline(always)]
fn products_of<const N: usize>(rows: &Blocks, phi: &[[f64; 2]], columns: &mut Blocks) {
    let (mut one, mut two) = ([[0.0; 4]; N], [[0.0; 4]; N]);
    for (row, &[a, b]) in rows.as_chunks::<N>().0.iter().zip(phi) {
        for block in 0..N {
            for k in 0..4 {
                one[block][k] += a * row[block][k];
                two[block][k] += b * row[block][k];
            }
        }
    }
    for (column, sums) in columns.as_chunks_mut::<N>().0.iter_mut().zip([one, two]) {
        *column = sums;
    }
}
