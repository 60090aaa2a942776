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
use crate::varying_load::harmonic_force::walk::{Kind, RUN, Run, closing};
use core::f64::consts::PI;

/// Doubles of a piece in the workspace.
pub(super) const PIECE: usize = 12;

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
    /// By slip, with a sign.
    BySlip(f64),
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
    /// f, N and S at the inner end, 1/(S_j - S_i) and D.
    inner_stiffness: f64,
    inner_load: f64,
    inner_shift: f64,
    inverse_width: f64,
    slope: f64,
    /// Whether sums were stored.
    stored: bool,
}

impl From<Piece> for [f64; PIECE] {
    fn from(piece: Piece) -> [f64; PIECE] {
        let (made, sign) = match piece.made {
            Made::Never => (0.0, 0.0),
            Made::BySlip(sign) => (1.0, sign),
            Made::BySticking => (2.0, 0.0),
            Made::SinceClosing => (3.0, 0.0),
        };
        let [constant, linear] = piece.weights;
        [
            made,
            sign,
            piece.sample as f64,
            constant,
            linear,
            piece.since as f64,
            piece.inner_stiffness,
            piece.inner_load,
            piece.inner_shift,
            piece.inverse_width,
            piece.slope,
            f64::from(u8::from(piece.stored)),
        ]
    }
}

impl From<[f64; PIECE]> for Piece {
    fn from(values: [f64; PIECE]) -> Piece {
        let [made, sign, sample, constant, linear, since, rest @ ..] = values;
        let [inner_stiffness, inner_load, inner_shift, inverse_width, slope, stored] = rest;
        Piece {
            made: match made as u8 {
                0 => Made::Never,
                1 => Made::BySlip(sign),
                2 => Made::BySticking,
                _ => Made::SinceClosing,
            },
            sample: sample as usize,
            weights: [constant, linear],
            since: since as usize,
            inner_stiffness,
            inner_load,
            inner_shift,
            inverse_width,
            slope,
            stored: stored != 0.0,
        }
    }
}

impl Piece {
    /// A piece of which only the constant part is used.
    fn line(made: Made, sample: usize, since: usize, weight: f64, inner_stiffness: f64) -> Piece {
        Piece {
            made,
            sample,
            weights: [weight, 0.0],
            since,
            inner_stiffness,
            inner_load: 0.0,
            inner_shift: 0.0,
            inverse_width: 0.0,
            slope: 0.0,
            stored: false,
        }
    }

    fn is_stuck(&self) -> bool {
        matches!(self.made, Made::BySticking | Made::SinceClosing)
    }

    /// Weights if the outer end has the given S, N and f.
    #[inline(always)]
    fn weights_to(&self, shift: f64, load: f64, stiffness: f64) -> [f64; 2] {
        let linear = (shift - self.inner_shift) * stiffness - (load - self.inner_load);
        [stiffness - self.inner_stiffness, linear * self.inverse_width]
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
    /// Sums of φ times both weights of each piece.
    pub gathered: [&'a mut Blocks; 2],
    /// Place of each sample in the following, or -1; the samples themselves; rows Y by u and by the input.
    pub places: &'a mut [f64],
    pub touched: &'a mut [f64],
    pub touched_count: usize,
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

/// The motion.
#[derive(Debug, Clone, Copy)]
pub(super) struct Context<'c> {
    pub element: &'c Element,
    pub samples: &'c Samples<'c>,
    pub part: &'c Part,
}

impl Sensitivity<'_> {
    /// Gathers the derivatives along the runs.
    #[inline(always)]
    pub fn gather(&mut self, context: &Context, tractions: &Tractions, cut_shift: &[f64], runs: &[[f64; RUN]]) {
        let Context { element, samples, part } = *context;
        self.places.fill(-1.0);
        self.touched_count = 0;
        // Pieces are counted from the centre: piece k ends at knot k.
        let mut depth = 0;
        let mut now = 0;
        let stiffness = |sample| at(samples.stiffness, sample);
        for run in runs {
            let run = Run::from(*run);
            let range = run.first..run.first + run.count;
            let last = range.end.saturating_sub(1);
            let kept = match run.kind {
                Kind::Slip => run.kept,
                Kind::Stuck => run.kept.saturating_sub(1),
                Kind::Open | Kind::GrossSlip => 0,
            };
            while depth > kept {
                depth -= 1;
                self.remove(context, depth, now);
            }
            let [by_u, by_input] = &mut self.own;
            let by_u = by_u.get_mut(range.clone()).unwrap_or(&mut []);
            let by_input = by_input.get_mut(range.clone()).unwrap_or(&mut []);
            let mu = run.sign * element.friction_coefficient;
            match run.kind {
                Kind::Open => {
                    by_u.fill(0.0);
                    by_input.fill(0.0);
                }
                Kind::GrossSlip => {
                    by_u.fill(0.0);
                    let slopes = samples.load_slope.get(range).unwrap_or(&[]);
                    by_input.iter_mut().zip(slopes).for_each(|(weight, slope)| *weight = mu * slope);
                    let made = Made::BySlip(run.sign);
                    self.push(&mut depth, Piece::line(made, last, now + run.count, stiffness(last), 0.0));
                }
                Kind::Stuck => {
                    by_input.fill(0.0);
                    let before = samples.before(run.first);
                    let closes = part.opens && samples.is_open(before);
                    let [mut shift_before, mut load_before, mut stiffness_before] = if closes {
                        [0.0; 3]
                    } else {
                        [at(samples.shift, before), at(samples.load, before), stiffness(before)]
                    };
                    let mut made = if closes { Made::SinceClosing } else { Made::BySticking };
                    by_u.iter_mut().zip(range.clone()).for_each(|(weight, sample)| *weight = stiffness(sample));
                    for (step, sample) in range.enumerate() {
                        let (shift, load, stiffness) =
                            (at(samples.shift, sample), at(samples.load, sample), stiffness(sample));
                        let mut piece = Piece {
                            inner_load: load_before,
                            inner_shift: shift_before,
                            inverse_width: 1.0 / (shift - shift_before),
                            slope: at(tractions.slope, sample),
                            ..Piece::line(made, sample, now + step, 0.0, stiffness_before)
                        };
                        piece.weights = piece.weights_to(shift, load, stiffness);
                        self.push(&mut depth, piece);
                        (shift_before, load_before, stiffness_before) = (shift, load, stiffness);
                        made = Made::BySticking;
                    }
                }
                Kind::Slip => {
                    let packed = run.packed..run.packed + run.count;
                    let cuts = (
                        cut_shift.get(packed.clone()).unwrap_or(&[]),
                        tractions.cut_load.get(packed.clone()).unwrap_or(&[]),
                        tractions.cut_stiffness.get(packed).unwrap_or(&[]),
                    );
                    let stiffnesses = samples.stiffness.get(range.clone()).unwrap_or(&[]);
                    let slopes = samples.shift_slope.get(range.clone()).unwrap_or(&[]);
                    for ((((by_u, by_input), cut), stiffness), slope) in
                        by_u.iter_mut().zip(by_input).zip(cuts.2).zip(stiffnesses).zip(slopes)
                    {
                        *by_u = *cut;
                        *by_input = mu * slope * (stiffness - cut);
                    }
                    if depth < run.kept {
                        self.push(&mut depth, Piece::line(Made::Never, 0, now, 0.0, 0.0));
                    }
                    self.cut(depth.saturating_sub(1), now, &run, part.start, samples.count, cuts);
                    let cut = cuts.2.last().copied().unwrap_or(0.0);
                    let made = Made::BySlip(run.sign);
                    self.push(&mut depth, Piece::line(made, last, now + run.count, stiffness(last) - cut, cut));
                }
            }
            now += run.count;
        }
        while depth > 0 {
            depth -= 1;
            self.remove(context, depth, now);
        }
    }

    #[inline(always)]
    fn push(&mut self, depth: &mut usize, piece: Piece) {
        if let Some(place) = self.pieces.get_mut(*depth) {
            *place = piece.into();
            *depth += 1;
        }
    }

    /// Adds the sums from `since` up to `now` with constant weights.
    #[inline(always)]
    fn gather_covered(&mut self, index: usize, piece: &mut Piece, now: usize, start: usize, samples: usize) {
        let length = self.row_blocks;
        let parts = if piece.is_stuck() { 2 } else { 1 };
        for (gathered, weight) in self.gathered.iter_mut().zip(piece.weights).take(parts) {
            let gathered = row_of_mut(gathered, index, length);
            if !piece.stored {
                gathered.fill([0.0; 4]);
            }
            if now > piece.since {
                let wrapped = |step: usize| {
                    let sample = start + step;
                    if sample >= samples { sample - samples } else { sample }
                };
                let to = row_of(self.antiderivatives, wrapped(now), length);
                let from = row_of(self.antiderivatives, wrapped(piece.since), length);
                if let Some([constant, ..]) = gathered.first_mut() {
                    *constant += weight * (now - piece.since) as f64;
                }
                for ((gathered, to), from) in gathered.iter_mut().zip(to).zip(from) {
                    for k in 0..4 {
                        gathered[k] += weight * (to[k] - from[k]);
                    }
                }
            }
        }
        piece.stored = true;
        piece.since = now;
    }

    /// Cuts a piece by a run of slip.
    #[inline(always)]
    fn cut(
        &mut self,
        index: usize,
        now: usize,
        run: &Run,
        start: usize,
        samples: usize,
        (shifts, loads, stiffnesses): (&[f64], &[f64], &[f64]),
    ) {
        let Some(mut piece) = self.pieces.get(index).copied().map(Piece::from) else { return };
        if piece.made == Made::Never {
            return;
        }
        self.gather_covered(index, &mut piece, now, start, samples);
        let length = self.row_blocks;
        let is_stuck = piece.is_stuck();
        let [constant, linear] = &mut self.gathered;
        let (constant, linear) = (row_of_mut(constant, index, length), row_of_mut(linear, index, length));
        let rows = self.rows.chunks_exact(length.max(1)).skip(run.first);
        for (((row, &shift), &load), &stiffness) in rows.zip(shifts).zip(loads).zip(stiffnesses) {
            piece.weights = piece.weights_to(shift, load, stiffness);
            add_scaled(constant, piece.weights[0], row);
            if is_stuck {
                add_scaled(linear, piece.weights[1], row);
            }
        }
        piece.since = now + run.count;
        if let Some(place) = self.pieces.get_mut(index) {
            *place = piece.into();
        }
    }

    /// Adds the sums of a piece that is removed to those of the samples that made it.
    #[inline(always)]
    fn remove(&mut self, context: &Context, index: usize, now: usize) {
        let Context { element, samples, part } = *context;
        let Some(mut piece) = self.pieces.get(index).copied().map(Piece::from) else { return };
        if piece.made == Made::Never || (!piece.stored && now <= piece.since) {
            return;
        }
        self.gather_covered(index, &mut piece, now, part.start, samples.count);
        let sample = piece.sample;
        let before = samples.before(sample);
        let shift_slope = |sample| at(samples.shift_slope, sample);
        // Derivatives -V_1 e_i - V_2 (e_j - e_i).
        match piece.made {
            Made::Never => {}
            Made::BySlip(sign) => {
                let by_input = sign * element.friction_coefficient * shift_slope(sample);
                self.distribute(index, [1.0, 0.0], sample, [-1.0, by_input]);
            }
            Made::BySticking => {
                let by_input = |sample| piece.slope * shift_slope(sample);
                self.distribute(index, [0.0, 1.0], sample, [-1.0, by_input(sample)]);
                self.distribute(index, [-1.0, 1.0], before, [1.0, -by_input(before)]);
            }
            Made::SinceClosing => {
                let closing = closing(samples, element.by_approach(), sample);
                self.distribute(index, [0.0, 1.0], sample, [-1.0, piece.slope * shift_slope(sample)]);
                self.distribute(index, [-1.0, 1.0], before, closing.before);
                if element.by_approach() {
                    self.distribute(index, [-1.0, 1.0], sample, closing.after);
                }
            }
        }
    }

    /// Adds `parts[0] V_1 + parts[1] V_2` times two factors to the rows of a sample.
    #[inline(always)]
    fn distribute(&mut self, index: usize, parts: [f64; 2], sample: usize, factors: [f64; 2]) {
        let length = self.row_blocks;
        let Some(place) = self.places.get_mut(sample) else { return };
        let is_new = *place < 0.0;
        if is_new {
            *place = self.touched_count as f64;
            if let Some(entry) = self.touched.get_mut(self.touched_count) {
                *entry = sample as f64;
            }
            self.touched_count += 1;
        }
        let place = *place as usize;
        let [constant, linear] = &self.gathered;
        let (constant, linear) = (row_of(constant, index, length), row_of(linear, index, length));
        for (rows, factor) in [(&mut *self.by_displacement, factors[0]), (&mut *self.by_input, factors[1])] {
            let row = row_of_mut(rows, place, length);
            if is_new {
                row.fill([0.0; 4]);
            }
            if parts[0] != 0.0 {
                add_scaled(row, factor * parts[0], constant);
            }
            if parts[1] != 0.0 {
                add_scaled(row, factor * parts[1], linear);
            }
        }
    }

    /// `Σ Y_j ⊗ φ_j` column by column, for the derivatives by u (0) or by the input (1).
    #[inline(always)]
    pub fn products(&self, index: usize, products: &mut Blocks) {
        let length = self.row_blocks.max(1);
        let rows = if index == 0 { &*self.by_displacement } else { &*self.by_input };
        for (column, product) in products.chunks_exact_mut(length).enumerate() {
            product.fill([0.0; 4]);
            for (row, sample) in rows.chunks_exact(length).zip(self.touched.iter().take(self.touched_count)) {
                let phi = row_of(self.rows, *sample as usize, length).as_flattened();
                add_scaled(product, at(phi, column), row);
            }
        }
    }
}
