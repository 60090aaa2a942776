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
use crate::varying_load::harmonic_force::walk::{Kind, Run, Runs, closing};
use core::f64::consts::PI;

/// Doubles of a piece in the workspace.
pub(super) const PIECE: usize = 6;

/// Blocks of four in a row over the coefficients 1, cos t, sin t, cos 2t, ...
pub(super) fn row_blocks(harmonics: usize) -> usize {
    let blocks = (2 * harmonics + 1).div_ceil(4);
    if blocks <= 5 { blocks | 1 } else { blocks.next_multiple_of(4) }
}

/// Blocks of a row that are gathered together, and kept in registers: all up to 5.
fn strip_blocks(row_blocks: usize) -> usize {
    if row_blocks <= 5 { row_blocks } else { 4 }
}

/// A strip of a row.
type Strip<const N: usize> = [[f64; 4]; N];

/// Fills the rows φ of all samples, and of their antiderivatives A, which are 0 for the constant and otherwise
/// `A(n) - A(m) = φ(m) + ... + φ(n-1)`. The first strips of all samples come first.
pub(super) fn fill_rows(rows: &mut [f64], antiderivatives: &mut [f64], harmonics: usize, samples: usize) {
    let width = (4 * strip_blocks(row_blocks(harmonics))).max(4);
    let fill = |values: &mut [f64], function: &dyn Fn(usize, usize) -> f64| {
        for (index, strip) in values.chunks_exact_mut(width).enumerate() {
            let (first, n) = (index / samples.max(1) * width, index % samples.max(1));
            for (c, value) in (first..).zip(strip) {
                *value = if c <= 2 * harmonics { function(c, n) } else { 0.0 };
            }
        }
    };
    let is_sine = |c: usize| c > 0 && c.is_multiple_of(2);
    fill(rows, &|c, n| {
        let angle = angle(c.div_ceil(2), n, samples);
        if is_sine(c) { angle.sin() } else { angle.cos() }
    });
    fill(antiderivatives, &|c, n| {
        let order = c.div_ceil(2);
        if order == 0 {
            return 0.0;
        }
        // Sums of a geometric series: the angle half a step before the sample.
        let angle = angle(order, 2 * n + 2 * samples - 1, 2 * samples);
        let scale = 0.5 / (PI * order as f64 / samples as f64).sin();
        scale * if is_sine(c) { -angle.cos() } else { angle.sin() }
    });
}

/// How a piece was made, in 3 bits.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Made(u64);

impl Made {
    /// The part with D = 0.
    const NEVER: Made = Made(0);
    /// By slip, forwards or backwards.
    const FORWARDS: Made = Made(1);
    const BACKWARDS: Made = Made(2);
    /// By sticking, between two samples.
    const BY_STICKING: Made = Made(3);
    /// By sticking, since the contact closed after the sample before.
    const SINCE_CLOSING: Made = Made(4);
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
    /// Slip zone: f at the inner end; stuck: 1/(S_j - S_i).
    parameter: f64,
    /// A run of slip that cut it, not yet added to its sums.
    cut: Cut,
    /// Whether sums were stored.
    stored: bool,
}

/// A run that cuts a piece: its samples, counted along the walk, and the first of its packed boundaries.
#[derive(Debug, Clone, Copy)]
struct Cut {
    step: usize,
    count: usize,
    packed: usize,
}

const NO_CUT: Cut = Cut { step: 0, count: 0, packed: 0 };

impl Piece {
    #[inline(always)]
    fn encoded(&self) -> [f64; PIECE] {
        let word = self.made.0 | u64::from(self.stored) << 3 | (self.sample as u64) << 4 | (self.since as u64) << 34;
        let Cut { step, count, packed } = self.cut;
        let cut = [(step as u64) | (count as u64) << 32, packed as u64].map(f64::from_bits);
        [f64::from_bits(word), self.weights[0], self.weights[1], self.parameter, cut[0], cut[1]]
    }

    #[inline(always)]
    fn decoded([word, constant, linear, parameter, cut, packed]: [f64; PIECE]) -> Piece {
        let (word, cut) = (word.to_bits(), cut.to_bits());
        Piece {
            made: Made(word & 7),
            sample: ((word >> 4) & ((1 << 30) - 1)) as usize,
            weights: [constant, linear],
            since: (word >> 34) as usize,
            parameter,
            cut: Cut { step: cut as u32 as usize, count: (cut >> 32) as usize, packed: packed.to_bits() as usize },
            stored: word & 8 != 0,
        }
    }

    fn is_stuck(&self) -> bool {
        self.made.0 >= Made::BY_STICKING.0
    }
}

/// Inner end of a stuck piece.
#[derive(Debug, Clone, Copy)]
struct InnerEnd {
    shift: f64,
    load: f64,
    stiffness: f64,
}

impl InnerEnd {
    /// Weights of the constant and of the linear part if the outer end has the given S, N and f.
    #[inline(always)]
    fn weights_to(&self, inverse_width: f64, [shift, load, stiffness]: [f64; 3]) -> [f64; 2] {
        let linear = (shift - self.shift) * stiffness - (load - self.load);
        [stiffness - self.stiffness, linear * inverse_width]
    }
}

/// Tables and memory. Of rows, the first strips of all come first.
#[derive(Debug)]
pub(super) struct Sensitivity<'a> {
    pub row_blocks: usize,
    /// φ and A of each sample.
    pub rows: &'a Blocks,
    pub antiderivatives: &'a Blocks,
    pub pieces: &'a mut [[f64; PIECE]],
    /// Sums of φ times both weights of pieces that were cut repeatedly.
    pub stored: &'a mut Blocks,
    /// Place of each sample among those touched, or -1; for each of these the rows Y by u and by the input, and φ.
    pub places: &'a mut [f64],
    pub touched: usize,
    pub derivatives: &'a mut Blocks,
    pub touched_rows: &'a mut Blocks,
    /// Weights of φ ⊗ φ for the derivatives by u and by the input.
    pub own: [&'a mut [f64]; 2],
}

/// `target + scale row`. All values are loaded before one is stored: otherwise the compiler, which cannot exclude that they overlap, would
/// not combine them in a vector.
#[inline(always)]
pub(super) fn plus(target: [f64; 4], scale: f64, row: [f64; 4]) -> [f64; 4] {
    let ([a, b, c, d], [e, f, g, h]) = (target, row);
    [a + scale * e, b + scale * f, c + scale * g, d + scale * h]
}

#[inline(always)]
fn add_scaled<const N: usize>(target: &mut Strip<N>, scale: f64, row: &Strip<N>) {
    for block in 0..N {
        for k in 0..4 {
            target[block][k] += scale * row[block][k];
        }
    }
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

    /// The inner end of the stuck piece that a sample made.
    #[inline(always)]
    fn inner_end(&self, made: Made, sample: usize) -> InnerEnd {
        let samples = self.samples;
        let before = samples.before(sample);
        if made == Made::SINCE_CLOSING {
            return InnerEnd { shift: 0.0, load: 0.0, stiffness: 0.0 };
        }
        let (shift, load) = (at(samples.shift, before), at(samples.load, before));
        InnerEnd { shift, load, stiffness: at(samples.stiffness, before) }
    }
}

impl Sensitivity<'_> {
    /// Gathers the derivatives along the runs.
    #[inline(always)]
    pub fn gather(&mut self, context: &Context, cuts: &Cuts, runs: &Runs) {
        match self.row_blocks {
            1 => self.gather_strips::<1>(context, cuts, runs),
            3 => self.gather_strips::<3>(context, cuts, runs),
            5 => self.gather_strips::<5>(context, cuts, runs),
            _ => self.gather_strips::<4>(context, cuts, runs),
        }
    }

    #[inline(always)]
    fn gather_strips<const N: usize>(&mut self, context: &Context, cuts: &Cuts, runs: &Runs) {
        let samples = context.samples.count.max(1);
        for strip in 0..(self.row_blocks / N).max(1) {
            let range = strip * samples..(strip + 1) * samples;
            let (Some(rows), Some(antiderivatives), Some(derivatives), Some(touched_rows)) = (
                self.rows.as_chunks().0.get(range.clone()),
                self.antiderivatives.as_chunks().0.get(range.clone()),
                self.derivatives.as_chunks_mut::<N>().0.as_chunks_mut().0.get_mut(range.clone()),
                self.touched_rows.as_chunks_mut().0.get_mut(range),
            ) else {
                return;
            };
            self.places.fill(-1.0);
            let [own_by_u, own_by_input] = &mut self.own;
            let mut gathering = Gathering {
                context,
                cuts,
                is_first: strip == 0,
                rows,
                antiderivatives,
                pieces: self.pieces,
                depth: 0,
                stored: self.stored.as_chunks_mut::<N>().0.as_chunks_mut().0,
                places: self.places,
                touched: 0,
                derivatives,
                touched_rows,
            };
            gathering.gather(runs.clone(), own_by_u, own_by_input);
            self.touched = gathering.touched;
        }
    }

    /// `Σ Y_j ⊗ φ_j`, columns for the derivatives by u (0) or by the input (1).
    #[inline(always)]
    pub fn products(&self, index: usize, products: &mut Blocks) {
        match self.row_blocks {
            1 => self.products_of::<1>(index, products),
            3 => self.products_of::<3>(index, products),
            5 => self.products_of::<5>(index, products),
            _ => self.products_of::<4>(index, products),
        }
    }

    #[inline(always)]
    fn products_of<const N: usize>(&self, index: usize, products: &mut Blocks) {
        let derivatives = self.derivatives.as_chunks::<N>().0.as_chunks::<2>().0;
        let touched_rows = self.touched_rows.as_chunks::<N>().0;
        let strips = (self.row_blocks / N).max(1);
        let samples = derivatives.len() / strips;
        let touched = |strip: usize| strip * samples..strip * samples + self.touched;
        for (strip, columns) in products.as_chunks_mut::<N>().0.chunks_mut((4 * N * strips).max(1)).enumerate() {
            columns.fill([[0.0; 4]; N]);
            let phi = touched_rows.get(touched(strip)).unwrap_or(&[]);
            for row_strip in 0..strips {
                let derivatives = derivatives.get(touched(row_strip)).unwrap_or(&[]);
                for block in 0..derivatives.len().div_ceil(IN_CACHE) {
                    let (derivatives, phi) = (in_cache(derivatives, block), in_cache(phi, block));
                    for pair in 0..2 * N {
                        let (mut one, mut two) = ([[0.0; 4]; N], [[0.0; 4]; N]);
                        for ([by_displacement, by_input], phi) in derivatives.iter().zip(phi) {
                            let row = if index == 0 { by_displacement } else { by_input };
                            let phi = phi.as_flattened();
                            add_scaled(&mut one, phi[2 * pair], row);
                            add_scaled(&mut two, phi[2 * pair + 1], row);
                        }
                        for (column, sums) in [(2 * pair, one), (2 * pair + 1, two)] {
                            if let Some(place) = columns.get_mut(column * strips + row_strip) {
                                add_scaled(place, 1.0, &sums);
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Touched samples whose rows stay in the first cache.
const IN_CACHE: usize = 32;

/// A block of [`IN_CACHE`] values, or what is left of them.
#[inline(always)]
fn in_cache<T>(values: &[T], block: usize) -> &[T] {
    let rest = values.get(block * IN_CACHE..).unwrap_or(&[]);
    rest.get(..IN_CACHE).unwrap_or(rest)
}

/// Boundaries of the slip zones, packed: S, N and f.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cuts<'c> {
    pub shifts: &'c [f64],
    pub loads: &'c [f64],
    pub stiffnesses: &'c [f64],
    /// D of the pieces that samples made by sticking.
    pub slopes: &'c [f64],
}

/// The derivatives in strips of N blocks.
struct Gathering<'c, const N: usize> {
    context: &'c Context<'c>,
    cuts: &'c Cuts<'c>,
    /// Whether the strips hold the constant.
    is_first: bool,
    rows: &'c [Strip<N>],
    antiderivatives: &'c [Strip<N>],
    /// Piece k ends at knot k: pieces are counted from the centre.
    pieces: &'c mut [[f64; PIECE]],
    depth: usize,
    stored: &'c mut [[Strip<N>; 2]],
    places: &'c mut [f64],
    touched: usize,
    derivatives: &'c mut [[Strip<N>; 2]],
    touched_rows: &'c mut [Strip<N>],
}

impl<const N: usize> Gathering<'_, N> {
    #[inline(always)]
    fn gather(&mut self, runs: Runs, by_u: &mut [f64], by_input: &mut [f64]) {
        let Context { element, samples, .. } = *self.context;
        let mut now = 0;
        for run in runs {
            let range = run.first..run.first + run.count;
            let last = range.end.saturating_sub(1);
            let kept = match run.kind {
                Kind::Slip => run.kept,
                Kind::Stuck => run.kept.saturating_sub(1),
                Kind::Open | Kind::GrossSlip => 0,
            };
            self.remove_beyond(kept, now);
            let by_u = by_u.get_mut(range.clone()).unwrap_or(&mut []);
            let by_input = by_input.get_mut(range.clone()).unwrap_or(&mut []);
            let mu = run.sign * element.friction_coefficient;
            let made = if run.sign > 0.0 { Made::FORWARDS } else { Made::BACKWARDS };
            let line = Piece {
                made,
                sample: last,
                weights: [at(samples.stiffness, last), 0.0],
                since: now + run.count,
                parameter: 0.0,
                cut: NO_CUT,
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
                    self.push(&line);
                }
                Kind::Stuck => {
                    by_input.fill(0.0);
                    let stiffnesses = samples.stiffness.get(range).unwrap_or(&[]);
                    by_u.iter_mut().zip(stiffnesses).for_each(|(weight, stiffness)| *weight = *stiffness);
                    self.stick(&run, now);
                }
                Kind::Slip => {
                    let cuts = self.cuts.stiffnesses.get(run.packed..run.packed + run.count).unwrap_or(&[]);
                    let stiffnesses = samples.stiffness.get(range.clone()).unwrap_or(&[]);
                    let slopes = samples.shift_slope.get(range).unwrap_or(&[]);
                    for ((((by_u, by_input), cut), stiffness), slope) in
                        by_u.iter_mut().zip(by_input).zip(cuts).zip(stiffnesses).zip(slopes)
                    {
                        *by_u = *cut;
                        *by_input = mu * slope * (stiffness - cut);
                    }
                    if self.depth < run.kept {
                        self.push(&Piece { made: Made::NEVER, ..line });
                    }
                    self.cut(self.depth.saturating_sub(1), Cut { step: now, count: run.count, packed: run.packed });
                    let cut = cuts.last().copied().unwrap_or(0.0);
                    self.push(&Piece { weights: [line.weights[0] - cut, 0.0], parameter: cut, ..line });
                }
            }
            now += run.count;
        }
        self.remove_beyond(0, now);
    }

    #[inline(always)]
    fn piece(&self, index: usize) -> Option<Piece> {
        self.pieces.get(index).copied().map(Piece::decoded)
    }

    #[inline(always)]
    fn push(&mut self, piece: &Piece) {
        if let Some(place) = self.pieces.get_mut(self.depth) {
            *place = piece.encoded();
            self.depth += 1;
        }
    }

    /// Pushes a piece for each sample of a run that sticks.
    #[inline(always)]
    fn stick(&mut self, run: &Run, now: usize) {
        let Context { samples, part, .. } = *self.context;
        let closes = part.opens && samples.is_open(samples.before(run.first));
        let mut made = if closes { Made::SINCE_CLOSING } else { Made::BY_STICKING };
        let mut inner = self.context.inner_end(made, run.first);
        for step in 0..run.count {
            let sample = run.first + step;
            let [shift, load, stiffness] =
                [at(samples.shift, sample), at(samples.load, sample), at(samples.stiffness, sample)];
            let parameter = inverse(shift - inner.shift);
            let weights = inner.weights_to(parameter, [shift, load, stiffness]);
            self.push(&Piece { made, sample, weights, since: now + step, parameter, cut: NO_CUT, stored: false });
            inner = InnerEnd { shift, load, stiffness };
            made = Made::BY_STICKING;
        }
    }

    /// Adds the sum of φ over steps with constant weights.
    #[inline(always)]
    fn add_covered(&self, sums: &mut [Strip<N>; 2], weights: [f64; 2], since: usize, now: usize) {
        if now <= since {
            return;
        }
        let row = |step| self.antiderivatives.get(self.context.sample_at(step));
        let (Some(to), Some(from)) = (row(now), row(since)) else { return };
        let mut covered = *to;
        add_scaled(&mut covered, -1.0, from);
        if let (true, Some([constant, ..])) = (self.is_first, covered.first_mut()) {
            *constant = (now - since) as f64;
        }
        let [constant, linear] = sums;
        add_scaled(constant, weights[0], &covered);
        add_scaled(linear, weights[1], &covered);
    }

    /// The sums of a piece before a step; updates its weights to those at its last cut.
    #[inline(always)]
    fn sums(&self, index: usize, piece: &mut Piece, now: usize) -> [Strip<N>; 2] {
        let mut sums = [[[0.0; 4]; N]; 2];
        if let (true, Some(stored)) = (piece.stored, self.stored.get(index)) {
            sums = *stored;
        }
        let Cut { step, count, packed } = piece.cut;
        if count == 0 {
            self.add_covered(&mut sums, piece.weights, piece.since, now);
            return sums;
        }
        self.add_covered(&mut sums, piece.weights, piece.since, step);
        let first = self.context.sample_at(step);
        let rows = self.rows.get(first..first + count).unwrap_or(&[]);
        let packed = packed..packed + count;
        let stiffnesses = self.cuts.stiffnesses.get(packed.clone()).unwrap_or(&[]);
        let [constant, linear] = &mut sums;
        if piece.is_stuck() {
            let inner = self.context.inner_end(piece.made, piece.sample);
            let (shifts, loads) =
                (self.cuts.shifts.get(packed.clone()).unwrap_or(&[]), self.cuts.loads.get(packed).unwrap_or(&[]));
            for (((row, &shift), &load), &stiffness) in rows.iter().zip(shifts).zip(loads).zip(stiffnesses) {
                piece.weights = inner.weights_to(piece.parameter, [shift, load, stiffness]);
                add_scaled(constant, piece.weights[0], row);
                add_scaled(linear, piece.weights[1], row);
            }
        } else {
            for (row, &stiffness) in rows.iter().zip(stiffnesses) {
                piece.weights[0] = stiffness - piece.parameter;
                add_scaled(constant, piece.weights[0], row);
            }
        }
        self.add_covered(&mut sums, piece.weights, step + count, now);
        sums
    }

    /// Cuts a piece by a run of slip.
    #[inline(always)]
    fn cut(&mut self, index: usize, cut: Cut) {
        let Some(mut piece) = self.piece(index) else { return };
        if piece.made == Made::NEVER {
            return;
        }
        if piece.cut.count > 0 {
            let sums = self.sums(index, &mut piece, cut.step);
            if let Some(place) = self.stored.get_mut(index) {
                *place = sums;
            }
            (piece.stored, piece.since) = (true, cut.step);
        }
        piece.cut = cut;
        if let Some(place) = self.pieces.get_mut(index) {
            *place = piece.encoded();
        }
    }

    #[inline(always)]
    fn remove_beyond(&mut self, kept: usize, now: usize) {
        while self.depth > kept {
            self.depth -= 1;
            self.remove(self.depth, now);
        }
    }

    /// Adds the sums of a piece that is removed to those of the samples that made it: `dT = -V_1 e_i - V_2 (e_j - e_i)`.
    #[inline(always)]
    fn remove(&mut self, index: usize, now: usize) {
        let Context { element, samples, .. } = *self.context;
        let Some(mut piece) = self.piece(index) else { return };
        if piece.made == Made::NEVER || (!piece.stored && piece.cut.count == 0 && now <= piece.since) {
            return;
        }
        let [constant, linear] = self.sums(index, &mut piece, now);
        let (made, sample) = (piece.made, piece.sample);
        let shift_slope = at(samples.shift_slope, sample);
        if !piece.is_stuck() {
            let mu = element.friction_coefficient * if made == Made::FORWARDS { 1.0 } else { -1.0 };
            self.add(sample, &constant, [-1.0, mu * shift_slope]);
            return;
        }
        let slope = at(self.cuts.slopes, sample);
        self.add(sample, &linear, [-1.0, slope * shift_slope]);
        let mut difference = linear;
        add_scaled(&mut difference, -1.0, &constant);
        let before = samples.before(sample);
        if made == Made::BY_STICKING {
            self.add(before, &difference, [1.0, -slope * at(samples.shift_slope, before)]);
        } else {
            let closing = closing(samples, element.by_approach(), sample);
            self.add(before, &difference, closing.before);
            self.add(sample, &difference, closing.after);
        }
    }

    /// Adds a row times the derivatives by u and by the input to the rows Y of a sample.
    #[inline(always)]
    fn add(&mut self, sample: usize, row: &Strip<N>, [by_u, by_input]: [f64; 2]) {
        let Some(place) = self.places.get_mut(sample) else { return };
        let is_new = *place < 0.0;
        if is_new {
            *place = self.touched as f64;
        }
        let index = *place as usize;
        let Some(derivatives) = self.derivatives.get_mut(index) else { return };
        if !is_new {
            let [mut u_row, mut input_row] = *derivatives;
            add_scaled(&mut u_row, by_u, row);
            add_scaled(&mut input_row, by_input, row);
            *derivatives = [u_row, input_row];
        } else if let (Some(phi), Some(own)) = (self.touched_rows.get_mut(index), self.rows.get(sample)) {
            (*derivatives, *phi) = ([scaled(by_u, row), scaled(by_input, row)], *own);
            self.touched += 1;
        }
    }
}

#[inline(always)]
fn scaled<const N: usize>(scale: f64, row: &Strip<N>) -> Strip<N> {
    let mut scaled = *row;
    scaled.as_flattened_mut().iter_mut().for_each(|value| *value *= scale);
    scaled
}
