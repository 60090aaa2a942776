//! The memory diagram along a period: runs of samples that change it in the same way.
//!
//! Only the characteristic coordinates of the samples are needed. The normal forces at the boundaries of the slip zones are evaluated
//! afterwards, all at once: the shifts of these boundaries are packed in the order of the samples that slip.

use crate::element::Element;
use crate::fourier::workspace::record;
use crate::one_direction::diagram::slope;
use crate::one_direction::energy::{self, Path};
use crate::one_direction::harmonic_force::samples::{Part, Samples, at, ranges};
use crate::one_direction::step::Crossing;
use core::ops::Range;

record! {
    /// What the samples of a run do.
    #[derive(PartialEq, Eq)]
    pub(super) struct Kind {
        code: u64,
    }
}

impl Kind {
    pub const OPEN: Kind = Kind { code: 0 };
    /// Everything sticks: each sample adds a piece to the diagram.
    pub const STUCK: Kind = Kind { code: 1 };
    /// A slip zone grows along one piece of the diagram.
    pub const SLIP: Kind = Kind { code: 2 };
    pub const GROSS_SLIP: Kind = Kind { code: 3 };
}

record! {
    /// End of a piece of the diagram: twice the sample, and one more for the whole contact than for the boundary of the slip zone.
    #[derive(PartialEq)]
    pub(super) struct Place {
        code: f64,
    }
}

impl Place {
    /// The centre of the contact.
    pub const CENTRE: Place = Place { code: -1.0 };

    /// The whole contact at a sample.
    fn end(sample: usize) -> Place {
        Place { code: (2 * sample as u32 + 1).into() }
    }

    /// The boundary of the slip zone at a sample.
    fn cut(sample: usize) -> Place {
        Place { code: (2 * sample as u32).into() }
    }

    pub fn is_end(self) -> bool {
        self.code as u32 % 2 == 1
    }

    pub fn sample(self) -> usize {
        (self.code as u32 / 2) as usize
    }
}

record! {
    /// Consecutive samples that change the diagram in the same way.
    pub(super) struct Run {
        pub kind: Kind,
        first: u64,
        count: u64,
        /// Number of knots that stay, and the last of these.
        kept: u64,
        pub inner: Place,
        /// Slip: index of the first packed boundary.
        packed: u64,
        /// Slip: +1 or -1.
        pub sign: f64,
        /// Slip: D/mu of the piece that is cut. Stuck from the centre: displacement of the centre.
        pub parameter: f64,
    }
}

impl Run {
    pub const EMPTY: Run = Run {
        kind: Kind::OPEN,
        first: 0,
        count: 0,
        kept: 0,
        inner: Place::CENTRE,
        packed: 0,
        sign: 1.0,
        parameter: 0.0,
    };

    pub fn samples(&self) -> Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }

    /// The values of the samples.
    #[inline(always)]
    pub fn of<'v>(&self, values: &'v [f64]) -> &'v [f64] {
        values.get(self.samples()).unwrap_or(&[])
    }

    /// Slip: the packed boundaries.
    pub fn cuts(&self) -> Range<usize> {
        self.packed as usize..(self.packed + self.count) as usize
    }

    pub fn kept(&self) -> usize {
        self.kept as usize
    }
}

/// A knot of the diagram.
#[derive(Debug, Clone, Copy)]
struct Knot {
    xi: f64,
    eta: f64,
    place: Place,
}

impl Knot {
    const fn centre(displacement: f64) -> Knot {
        Knot { xi: displacement, eta: displacement, place: Place::CENTRE }
    }

    /// The far end of the part with D = 0.
    const CORE: Knot = Knot { xi: -1e200, eta: 1e200, place: Place::CENTRE };

    /// A knot as in other diagrams, which have forces.
    fn numbers(&self) -> [f64; 4] {
        [self.xi, self.eta, self.place.code, 0.0]
    }
}

/// Memory of the diagram and the runs along a periodic path.
#[derive(Debug)]
pub(super) struct PeriodicPath<'a> {
    pub knots: &'a mut [[f64; 4]],
    pub runs: &'a mut [Run],
    /// S at the boundaries of the slip zones.
    pub cut_shift: &'a mut [f64],
}

/// Number of runs, and of packed boundaries.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    pub runs: usize,
    pub cuts: usize,
}

/// The stack of knots.
struct Stack<'a> {
    knots: &'a mut [[f64; 4]],
    depth: usize,
}

impl<'a> Stack<'a> {
    /// The diagram before the first sample of a part.
    fn new(knots: &'a mut [[f64; 4]], part: &Part) -> Stack<'a> {
        let mut stack = Stack { knots, depth: 0 };
        stack.restart(0.0);
        if !part.opens {
            stack.push(Knot::CORE);
        }
        stack
    }

    /// Starts anew from the displacement of the centre.
    fn restart(&mut self, displacement: f64) {
        self.depth = 0;
        self.push(Knot::centre(displacement));
    }

    fn used(&self) -> &[[f64; 4]] {
        self.knots.get(..self.depth).unwrap_or(&[])
    }

    /// Advances along the leading samples of a range that change the diagram in the same way; `cuts` receives the boundaries of their
    /// slip zones.
    fn advance(
        &mut self,
        element: &Element,
        samples: &Samples,
        part: &Part,
        range: Range<usize>,
        cuts: &mut [f64],
    ) -> Run {
        let (first, span) = (range.start, Span::of(samples, range));
        let run = if part.opens && samples.is_open(first) {
            let closes = span.inputs.iter().position(|input| *input > 0.0);
            Run { count: closes.unwrap_or(span.inputs.len()) as u64, ..Run::EMPTY }
        } else {
            if part.opens && samples.is_open(samples.before(first)) {
                self.restart(closing(samples, element, first).displacement);
            }
            if !self.close_loops(at(span.xi, 0), at(span.eta, 0)) {
                stick(self, span)
            } else if self.depth == 0 {
                slip_grossly(self, span)
            } else {
                slip(self, span, element.per_two_mu, cuts)
            }
        };
        Run { first: first as u64, ..run }
    }

    fn knot(&self, index: usize) -> Knot {
        let [xi, eta, code, _] = self.knots.get(index).copied().unwrap_or([0.0; 4]);
        Knot { xi, eta, place: Place { code } }
    }

    fn push(&mut self, knot: Knot) {
        if let Some(place) = self.knots.get_mut(self.depth) {
            *place = knot.numbers();
            self.depth += 1;
        }
    }

    /// Closes the loops that a step to ξ = x, η = y passes: removes the knots outside the quadrant ξ > x, η < y. Returns whether
    /// one was removed.
    fn close_loops(&mut self, x: f64, y: f64) -> bool {
        let before = self.depth;
        while let Some(&[xi, eta, ..]) = self.depth.checked_sub(1).and_then(|top| self.knots.get(top))
            && !(xi > x && eta < y)
        {
            self.depth -= 1;
        }
        self.depth < before
    }
}

/// Samples that follow each other in memory.
#[derive(Clone, Copy)]
struct Span<'a> {
    first: usize,
    xi: &'a [f64],
    eta: &'a [f64],
    inputs: &'a [f64],
}

impl<'a> Span<'a> {
    fn of(samples: &'a Samples, range: Range<usize>) -> Span<'a> {
        let [xi, eta, inputs] =
            [&*samples.xi, samples.eta, samples.input].map(|values| values.get(range.clone()).unwrap_or(&[]));
        Span { first: range.start, xi, eta, inputs }
    }
}

impl PeriodicPath<'_> {
    /// The packed boundaries in blocks of four.
    pub fn cuts(&self, extent: Extent) -> &[[f64; 4]] {
        self.cut_shift.as_chunks().0.get(..extent.cuts.div_ceil(4)).unwrap_or(&[])
    }

    /// Finds the runs along a part of the period.
    #[inline(never)]
    pub fn evaluate(&mut self, element: &Element, samples: &Samples, part: &Part) -> Extent {
        let mut stack = Stack::new(self.knots, part);
        let mut runs = self.runs.iter_mut();
        let mut extent = Extent { runs: 0, cuts: 0 };
        for range in ranges(part, samples.count) {
            let mut next = range.start;
            while next < range.end {
                let Some(place) = runs.next() else { break };
                let cuts = self.cut_shift.get_mut(extent.cuts..).unwrap_or(&mut []);
                let run = stack.advance(element, samples, part, next..range.end, cuts);
                *place = Run { packed: extent.cuts as u64, ..run };
                extent.cuts += if run.kind == Kind::SLIP { run.count as usize } else { 0 };
                extent.runs += 1;
                next += run.count as usize;
            }
        }
        // Fills the last block of four.
        let last = extent.cuts.checked_sub(1).map_or(0.0, |last| at(self.cut_shift, last));
        self.cut_shift.iter_mut().skip(extent.cuts).take(3).for_each(|place| *place = last);
        extent
    }

    /// Energy \[J\] dissipated in the steps along a part of the period.
    #[inline(never)]
    pub fn dissipated(&mut self, element: &Element, samples: &Samples, part: &Part) -> f64 {
        let mut stack = Stack::new(self.knots, part);
        let mut energy = 0.0;
        // The step to the first sample (or to its counterpart half a period later) is the last.
        let steps = ranges(&Part { length: part.length + 1, ..*part }, samples.count).into_iter().flatten();
        for (step, sample) in steps.enumerate() {
            let before = samples.before(sample);
            let [was_open, is_open] = [before, sample].map(|sample| part.opens && samples.is_open(sample));
            if step > 0 && !(was_open && is_open) {
                let [mut start, mut end] = [before, sample].map(|sample| at(samples.displacement, sample));
                let shift = [before, sample].map(|sample| at(samples.shift, sample));
                if was_open {
                    start = closing(samples, element, sample).displacement;
                    stack.restart(start);
                } else if is_open {
                    end = closing(samples, element, sample).displacement;
                }
                energy += energy::dissipated(element, stack.used(), &Path { shift, displacement: end - start });
            }
            stack.advance(element, samples, part, sample..sample + 1, self.cut_shift);
        }
        energy
    }
}

/// Samples that stick.
fn stick(stack: &mut Stack, span: Span) -> Run {
    let kept = stack.depth;
    let inner = stack.knot(kept.saturating_sub(1));
    let (mut xi, mut eta, mut count) = (inner.xi, inner.eta, 0);
    let places = stack.knots.get_mut(kept..).unwrap_or(&mut []);
    for ((&x, &y), place) in span.xi.iter().zip(span.eta).zip(places) {
        if x >= xi || y <= eta {
            break;
        }
        *place = Knot { xi: x, eta: y, place: Place::end(span.first + count) }.numbers();
        (xi, eta) = (x, y);
        count += 1;
    }
    stack.depth += count;
    Run {
        kind: Kind::STUCK,
        count: count as u64,
        kept: kept as u64,
        inner: inner.place,
        parameter: inner.xi,
        ..Run::EMPTY
    }
}

/// Samples of gross slip in one direction, from an empty stack that still holds the centre in its memory.
fn slip_grossly(stack: &mut Stack, span: Span) -> Run {
    let is_forward = span.xi.first().is_some_and(|x| stack.knot(0).xi <= *x);
    let (count, [xi, eta]) = if is_forward { count_gross_slip::<true>(span) } else { count_gross_slip::<false>(span) };
    stack.push(Knot::centre(if is_forward { xi } else { eta }));
    stack.push(Knot { xi, eta, place: Place::end(span.first + count - 1) });
    Run { kind: Kind::GROSS_SLIP, count: count as u64, sign: if is_forward { 1.0 } else { -1.0 }, ..Run::EMPTY }
}

/// Lower bound of divisors: compilers may divide before they compare.
const SMALLEST: f64 = 1e-150;

/// Samples whose slip zone grows in one direction, along the piece above the last knot that stays.
fn slip(stack: &mut Stack, span: Span, per_two_mu: f64, places: &mut [f64]) -> Run {
    let kept = stack.depth;
    let (inner, outer) = (stack.knot(kept - 1), stack.knot(kept));
    let (falling, rising) = (inner.xi - outer.xi, outer.eta - inner.eta);
    let (x, y) = (span.xi.first().copied().unwrap_or(0.0), span.eta.first().copied().unwrap_or(0.0));
    // The piece leaves the quadrant through ξ = x unless it crosses η = y first: the quotient is at most 1.
    let is_forward =
        outer.xi <= x && (rising <= 0.0 || inner.eta + rising * ((inner.xi - x) / falling.max(SMALLEST)) <= y);
    // Changes of the other coordinate along the piece; 0 for a slip zone.
    let ratio = |change: f64, by: f64| if change > 0.0 { change / by.max(SMALLEST) } else { 0.0 };
    let (count, [xi, eta], cut) = if is_forward {
        count_slip::<true>(span, &inner, ratio(rising, falling), per_two_mu, places)
    } else {
        count_slip::<false>(span, &inner, ratio(falling, rising), per_two_mu, places)
    };
    let last = span.first + count - 1;
    stack.push(Knot { xi: cut[0], eta: cut[1], place: Place::cut(last) });
    stack.push(Knot { xi, eta, place: Place::end(last) });
    Run {
        kind: Kind::SLIP,
        count: count as u64,
        kept: kept as u64,
        inner: inner.place,
        sign: if is_forward { 1.0 } else { -1.0 },
        parameter: slope(falling, rising),
        ..Run::EMPTY
    }
}

/// Where the path from the open sample before a sample closes the contact.
pub(super) fn closing(samples: &Samples, element: &Element, sample: usize) -> Crossing {
    Crossing::between(element, samples.motion(samples.before(sample)), samples.motion(sample))
}

/// Coordinates such that slip in either direction is forward slip.
fn mirrored<const FORWARD: bool>(xi: f64, eta: f64) -> [f64; 2] {
    if FORWARD { [xi, eta] } else { [-eta, -xi] }
}

/// Number of samples of a run of gross slip, and the coordinates of the last.
fn count_gross_slip<const FORWARD: bool>(span: Span) -> (usize, [f64; 2]) {
    let mut count = 0;
    let (mut end, mut last) = ([0.0; 2], f64::MIN);
    for ((&xi, &eta), &input) in span.xi.iter().zip(span.eta).zip(span.inputs) {
        let [x, _] = mirrored::<FORWARD>(xi, eta);
        if count > 0 && (x < last || input <= 0.0) {
            break;
        }
        (last, end) = (x, [xi, eta]);
        count += 1;
    }
    (count, end)
}

/// Number of samples of a run of slip that cut one piece, the coordinates of the last, and its cut.
fn count_slip<const FORWARD: bool>(
    span: Span,
    inner: &Knot,
    ratio: f64,
    per_two_mu: f64,
    places: &mut [f64],
) -> (usize, [f64; 2], [f64; 2]) {
    let [inner_x, inner_y] = mirrored::<FORWARD>(inner.xi, inner.eta);
    let mut count = 0;
    let (mut end, mut last, mut last_cut) = ([0.0; 2], f64::MIN, 0.0);
    for ((&xi, &eta), place) in span.xi.iter().zip(span.eta).zip(places) {
        let [x, y] = mirrored::<FORWARD>(xi, eta);
        let cut = inner_y + ratio * (inner_x - x);
        if count > 0 && (x < last || x >= inner_x || cut > y) {
            break;
        }
        *place = ((cut - x) * per_two_mu).max(0.0);
        (last, last_cut, end) = (x, cut, [xi, eta]);
        count += 1;
    }
    (count, end, mirrored::<FORWARD>(last, last_cut))
}
