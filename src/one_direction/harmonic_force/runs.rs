//! The memory diagram along a period: runs of samples that change it in the same way.
//!
//! Only the characteristic coordinates of the samples are needed. The normal forces at the boundaries of the slip zones are
//! evaluated afterwards, all at once: the shifts of these boundaries are packed in the order of the samples that slip.

use crate::element::Element;
use crate::numerics::record::record;
use crate::numerics::slices::{PanicFreeSlice, Stack};
use crate::one_direction::diagram::slope;
use crate::one_direction::harmonic_force::samples::{EvaluatedPart, Samples, ranges};
use crate::one_direction::step::Crossing;
use core::ops::Range;

record! {
    /// End of a piece of the diagram: 0 for the centre of the contact; otherwise twice the number of samples up to one, and one
    /// more for the whole contact than for the boundary of the slip zone.
    #[derive(PartialEq, Default)]
    pub(super) struct PieceEnd {
        code: u64,
    }
}

impl PieceEnd {
    /// The centre of the contact.
    pub const CENTRE: PieceEnd = PieceEnd { code: 0 };

    /// The whole contact at a sample.
    fn end(sample: usize) -> PieceEnd {
        PieceEnd { code: 2 * sample as u64 + 3 }
    }

    /// The boundary of the slip zone at a sample.
    fn cut(sample: usize) -> PieceEnd {
        PieceEnd { code: 2 * sample as u64 + 2 }
    }

    pub fn is_end(self) -> bool {
        self.code % 2 == 1
    }

    /// The sample; no sample has the index of the centre.
    pub fn sample(self) -> usize {
        (self.code as usize / 2).wrapping_sub(1)
    }
}

record! {
    /// Consecutive samples that change the diagram in the same way.
    #[derive(Default)]
    pub(super) struct Run {
        /// [`Run::OPEN`], [`Run::STUCK`], [`Run::SLIP`] or [`Run::GROSS_SLIP`].
        pub kind: u64,
        first: u64,
        count: u64,
        /// Number of knots that remain, and the last of these.
        kept: u64,
        pub inner: PieceEnd,
        /// Slip: index of the first packed boundary.
        packed: u64,
        /// Slip: +1 or -1. Stuck: 1.
        pub sign: f64,
        /// Slip: D/mu of the piece that is cut. Stuck from the centre: displacement of the centre.
        pub parameter: f64,
    }
}

impl Run {
    pub const OPEN: u64 = 0;
    /// Everything sticks: each sample adds a piece to the diagram.
    pub const STUCK: u64 = 1;
    /// A slip zone grows along one piece of the diagram.
    pub const SLIP: u64 = 2;
    pub const GROSS_SLIP: u64 = 3;

    pub fn samples(&self) -> Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }

    /// The values of the samples.
    pub fn part_of<'v>(&self, values: &'v [f64]) -> &'v [f64] {
        values.part(self.samples())
    }

    /// The places of the boundaries of the slip zones of a run of slip among all packed ones.
    pub fn cuts(&self) -> Range<usize> {
        self.packed as usize..(self.packed + self.count) as usize
    }

    pub fn kept(&self) -> usize {
        self.kept as usize
    }
}

record! {
    /// A knot of the diagram.
    #[derive(Default)]
    pub(super) struct RunKnot {
        xi: f64,
        eta: f64,
        end: PieceEnd,
    }
}

impl RunKnot {
    const fn centre(displacement: f64) -> RunKnot {
        RunKnot { xi: displacement, eta: displacement, end: PieceEnd::CENTRE }
    }

    /// The outer end of the core of the contact, which keeps D = 0 throughout the period: beyond the coordinates of all samples, so
    /// that every slip zone cuts it.
    const CORE: RunKnot = RunKnot { xi: -1e200, eta: 1e200, end: PieceEnd::CENTRE };
}

/// The state of a pass along the samples: the stack of knots, and the runs and packed boundaries so far.
pub(super) struct PeriodicPath<'a> {
    pub knots: Stack<'a, RunKnot>,
    pub runs: Stack<'a, Run>,
    /// S at the boundaries of the slip zones.
    pub cut_shift: &'a mut [f64],
    pub cut_count: usize,
}

impl PeriodicPath<'_> {
    /// Replaces the diagram by its centre at a displacement.
    fn restart(&mut self, displacement: f64) {
        self.knots.depth = 0;
        self.knots.push(RunKnot::centre(displacement));
    }

    fn knot(&self, index: usize) -> RunKnot {
        self.knots.values.or_zero(index)
    }

    /// Advances along samples, run by run.
    fn advance(&mut self, element: &Element, samples: &Samples, part: &EvaluatedPart, range: Range<usize>) {
        let end = range.end;
        let (Some(xi), Some(eta), Some(inputs)) =
            (samples.xi.get(..end), samples.eta.get(..end), samples.input.get(..end))
        else {
            return;
        };
        let mut next = range.start;
        while let (Some(&x), Some(&y), Some(&input)) = (xi.get(next), eta.get(next), inputs.get(next))
            && self.runs.depth < self.runs.values.len()
        {
            let mut run = if part.opens && input <= 0.0 {
                let closes = inputs.iter().skip(next).position(|input| *input > 0.0);
                Run { count: closes.unwrap_or(end - next) as u64, ..Run::default() }
            } else {
                if part.opens && samples.is_open(samples.before(next)) {
                    self.restart(closing(samples, element, next).displacement);
                }
                if !self.close_loops(x, y) {
                    self.stick(next, [xi, eta])
                } else if self.knots.depth == 0 {
                    self.slip_grossly(next, x, [xi, eta, inputs])
                } else {
                    self.slip(next, [xi, eta], [x, y], element.per_two_mu)
                }
            };
            (run.first, run.packed) = (next as u64, self.cut_count as u64);
            next += run.count as usize;
            self.cut_count += if run.kind == Run::SLIP { run.count as usize } else { 0 };
            self.runs.push(run);
        }
    }

    /// Removes the knots outside the quadrant of the new ξ and η: the loops that the step closes. Returns whether any was removed.
    fn close_loops(&mut self, to_xi: f64, to_eta: f64) -> bool {
        let before = self.knots.depth;
        while let Some(&RunKnot { xi, eta, .. }) =
            self.knots.depth.checked_sub(1).and_then(|top| self.knots.values.get(top))
            && !(xi > to_xi && eta < to_eta)
        {
            self.knots.depth -= 1;
        }
        self.knots.depth < before
    }

    /// Samples that stick.
    fn stick(&mut self, first: usize, [xi, eta]: [&[f64]; 2]) -> Run {
        let kept = self.knots.depth;
        let inner = self.knot(kept - 1);
        let (mut last, mut sample) = (inner, first);
        while let (Some(&x), Some(&y)) = (xi.get(sample), eta.get(sample))
            && x < last.xi
            && y > last.eta
        {
            last = RunKnot { xi: x, eta: y, end: PieceEnd::end(sample) };
            self.knots.push(last);
            sample += 1;
        }
        Run {
            kind: Run::STUCK,
            count: (self.knots.depth - kept) as u64,
            kept: kept as u64,
            inner: inner.end,
            sign: 1.0,
            parameter: inner.xi,
            ..Run::default()
        }
    }

    /// Samples of gross slip in one direction. The stack is empty, but its memory still holds the centre.
    fn slip_grossly(&mut self, first: usize, x: f64, [xi, eta, inputs]: [&[f64]; 3]) -> Run {
        let (sign, moving) = if self.knot(0).xi <= x { (1.0, xi) } else { (-1.0, eta) };
        let later = |values| <[f64]>::get(values, first + 1..).unwrap_or(&[]).iter();
        let mut before = sign * moving.or_zero(first);
        let continues = |(moving, input): &(&f64, &f64)| {
            let continues = sign * *moving >= before && **input > 0.0;
            before = sign * *moving;
            continues
        };
        let last = first + later(moving).zip(later(inputs)).take_while(continues).count();
        self.knots.push(RunKnot::centre(moving.or_zero(last)));
        self.knots.push(RunKnot { xi: xi.or_zero(last), eta: eta.or_zero(last), end: PieceEnd::end(last) });
        Run { kind: Run::GROSS_SLIP, count: (last + 1 - first) as u64, sign, ..Run::default() }
    }

    /// Samples whose slip zone grows in one direction, along the piece above the last knot that stays.
    fn slip(&mut self, first: usize, [xi, eta]: [&[f64]; 2], [to_xi, to_eta]: [f64; 2], per_two_mu: f64) -> Run {
        let kept = self.knots.depth;
        let (inner, outer) = (self.knot(kept - 1), self.knot(kept));
        let (falling, rising) = (inner.xi - outer.xi, outer.eta - inner.eta);
        // The piece leaves the quadrant through ξ = to_xi unless it crosses η = to_eta first: the quotient is at most 1.
        let is_forward = outer.xi <= to_xi
            && (rising <= 0.0 || inner.eta + rising * ((inner.xi - to_xi) / falling.max(SMALLEST)) <= to_eta);
        // Coordinates such that slip in either direction is forward slip, and the change of the other coordinate along the piece,
        // which is 0 for a slip zone.
        let (sign, [moving, other], [inner_x, inner_y], [by, change]) = if is_forward {
            (1.0, [xi, eta], [inner.xi, inner.eta], [falling, rising])
        } else {
            (-1.0, [eta, xi], [-inner.eta, -inner.xi], [rising, falling])
        };
        let ratio = if change > 0.0 { change / by.max(SMALLEST) } else { 0.0 };
        let (mut sample, mut last, mut last_cut) = (first, [f64::MIN; 2], 0.0);
        let places = self.cut_shift.part_mut(self.cut_count..);
        for place in places {
            let (Some(moving), Some(other)) = (moving.get(sample), other.get(sample)) else { break };
            let (forward, across) = (sign * moving, sign * other);
            let cut = inner_y + ratio * (inner_x - forward);
            if sample > first && (forward < last[0] || forward >= inner_x || cut > across) {
                break;
            }
            *place = ((cut - forward) * per_two_mu).max(0.0);
            (last, last_cut) = ([forward, across], cut);
            sample += 1;
        }
        let [forward, across] = last;
        let [cut, end] = [[forward, last_cut], [forward, across]]
            .map(|[forward, across]| if is_forward { [forward, across] } else { [-across, -forward] });
        self.knots.push(RunKnot { xi: cut[0], eta: cut[1], end: PieceEnd::cut(sample - 1) });
        self.knots.push(RunKnot { xi: end[0], eta: end[1], end: PieceEnd::end(sample - 1) });
        Run {
            kind: Run::SLIP,
            count: (sample - first) as u64,
            kept: kept as u64,
            inner: inner.end,
            sign,
            parameter: slope(falling, rising),
            ..Run::default()
        }
    }
}

/// Lower bound of divisors, which keeps quotients of displacements finite (`numerics/guard.rs`).
const SMALLEST: f64 = 1e-150;

impl PeriodicPath<'_> {
    /// Starts from the diagram before the first sample of a part.
    fn begin(&mut self, part: &EvaluatedPart) {
        (self.runs.depth, self.cut_count) = (0, 0);
        self.restart(0.0);
        if !part.opens {
            self.knots.push(RunKnot::CORE);
        }
    }

    /// Finds the runs along a part of the period, and the packed boundaries in blocks of four.
    #[inline(never)]
    pub fn evaluate(&mut self, element: &Element, samples: &Samples, part: &EvaluatedPart) -> (&[Run], &[[f64; 4]]) {
        self.begin(part);
        for range in ranges(part, samples.count) {
            self.advance(element, samples, part, range);
        }
        let cuts = self.cut_count;
        // Fills the last block of four.
        let last = cuts.checked_sub(1).map_or(0.0, |last| self.cut_shift.or_zero(last));
        self.cut_shift.iter_mut().skip(cuts).take(3).for_each(|place| *place = last);
        let cut_shift = self.cut_shift.blocks().get(..cuts.div_ceil(4));
        (self.runs.values.part(..self.runs.depth), cut_shift.unwrap_or(&[]))
    }
}

/// The crossing of zero load on the path from the open sample before a sample.
pub(super) fn closing(samples: &Samples, element: &Element, sample: usize) -> Crossing {
    let motion = |sample| [samples.displacement.or_zero(sample), samples.input.or_zero(sample)];
    Crossing::between(element, motion(samples.before(sample)), motion(sample))
}
