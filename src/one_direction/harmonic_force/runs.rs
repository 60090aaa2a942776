//! The memory diagram along a period: runs of samples that change it in the same way.
//!
//! Only the characteristic coordinates of the samples are needed. The normal forces at the boundaries of the slip zones are evaluated
//! afterwards, all at once: the shifts of these boundaries are packed in the order of the samples that slip.

use crate::element::Element;
use crate::one_direction::diagram::slope;
use crate::one_direction::harmonic_force::samples::{Part, Samples, at, ranges};
use crate::one_direction::step::Crossing;

/// Doubles of a knot and of a run in the workspace.
pub(super) const KNOT: usize = 4;
pub(super) const RUN: usize = 3;

/// What the samples of a run do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Open,
    /// Everything sticks: each sample adds a piece to the diagram.
    Stuck,
    /// A slip zone grows along one piece of the diagram.
    Slip,
    GrossSlip,
}

/// End of a piece of the diagram, as the bits of a double.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Place(u64);

impl Place {
    /// The centre of the contact.
    pub const CENTRE: Place = Place(1 << 40);

    /// The whole contact at a sample.
    fn end(sample: usize) -> Place {
        Place((sample as u64) << 1 | 1)
    }

    /// The boundary of the slip zone at a sample.
    fn cut(sample: usize) -> Place {
        Place((sample as u64) << 1)
    }

    pub fn is_end(self) -> bool {
        self.0 & 1 == 1
    }

    pub fn sample(self) -> usize {
        (self.0 >> 1) as usize
    }
}

/// Consecutive samples that change the diagram in the same way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Run {
    pub kind: Kind,
    pub first: usize,
    pub count: usize,
    /// Number of knots that stay, and the last of these.
    pub kept: usize,
    pub inner: Place,
    /// Slip: index of the first packed boundary.
    pub packed: usize,
    /// Slip: +1 or -1.
    pub sign: f64,
    /// Slip: D/mu of the piece that is cut. Stuck from the centre: displacement of the centre.
    pub parameter: f64,
}

impl Run {
    /// In the workspace: kind, direction and counts in one word, the inner place, the parameter. First sample and packed index follow
    /// from the runs before.
    fn encoded(&self) -> [f64; RUN] {
        let backward = u64::from(self.sign < 0.0);
        let word = self.kind as u64 | backward << 2 | (self.count as u64) << 3 | (self.kept as u64) << 32;
        [f64::from_bits(word), f64::from_bits(self.inner.0), self.parameter]
    }
}

/// The runs of a path.
#[derive(Debug, Clone)]
pub(super) struct Runs<'a> {
    encoded: core::slice::Iter<'a, [f64; RUN]>,
    first: usize,
    packed: usize,
    samples: usize,
}

impl Iterator for Runs<'_> {
    type Item = Run;

    fn next(&mut self) -> Option<Run> {
        let &[word, inner, parameter] = self.encoded.next()?;
        let word = word.to_bits();
        let kind = match word & 3 {
            0 => Kind::Open,
            1 => Kind::Stuck,
            2 => Kind::Slip,
            _ => Kind::GrossSlip,
        };
        let count = ((word >> 3) & ((1 << 29) - 1)) as usize;
        let run = Run {
            kind,
            first: self.first,
            count,
            kept: (word >> 32) as usize,
            inner: Place(inner.to_bits()),
            packed: self.packed,
            sign: if word & 4 == 0 { 1.0 } else { -1.0 },
            parameter,
        };
        self.first += count;
        if self.first >= self.samples {
            self.first = 0;
        }
        self.packed += if kind == Kind::Slip { count } else { 0 };
        Some(run)
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

    fn encoded(&self) -> [f64; KNOT] {
        [self.xi, self.eta, f64::from_bits(self.place.0), 0.0]
    }
}

/// Memory of the diagram and the runs along a periodic path.
#[derive(Debug)]
pub(super) struct PeriodicPath<'a> {
    pub knots: &'a mut [[f64; KNOT]],
    pub runs: &'a mut [[f64; RUN]],
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
    knots: &'a mut [[f64; KNOT]],
    depth: usize,
}

impl Stack<'_> {
    fn knot(&self, index: usize) -> Knot {
        let [xi, eta, place, _] = self.knots.get(index).copied().unwrap_or([0.0; KNOT]);
        Knot { xi, eta, place: Place(place.to_bits()) }
    }

    fn push(&mut self, knot: Knot) {
        if let Some(place) = self.knots.get_mut(self.depth) {
            *place = knot.encoded();
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

impl PeriodicPath<'_> {
    /// The memory of the knots, for a diagram with forces.
    pub fn diagram(&mut self) -> &mut [[f64; 4]] {
        self.knots
    }

    /// The packed boundaries in blocks of four.
    pub fn cuts(&self, extent: Extent) -> &[[f64; 4]] {
        self.cut_shift.as_chunks().0.get(..extent.cuts.div_ceil(4)).unwrap_or(&[])
    }

    /// The runs along a part of the period.
    pub fn runs(&self, extent: Extent, part: &Part, samples: usize) -> Runs<'_> {
        let encoded = self.runs.get(..extent.runs).unwrap_or(&[]).iter();
        Runs { encoded, first: part.start, packed: 0, samples }
    }

    #[inline(never)]
    pub fn evaluate(&mut self, element: &Element, samples: &Samples, part: &Part) -> Extent {
        let mut stack = Stack { knots: self.knots, depth: 0 };
        stack.push(Knot::centre(0.0));
        if !part.opens {
            stack.push(Knot::CORE);
        }
        let mut runs = self.runs.iter_mut();
        let mut extent = Extent { runs: 0, cuts: 0 };
        let mut was_open = part.opens;
        for range in ranges(part, samples.count) {
            let mut next = range.start;
            while next < range.end {
                let span = Span {
                    first: next,
                    xi: samples.xi.get(next..range.end).unwrap_or(&[]),
                    eta: samples.eta.get(next..range.end).unwrap_or(&[]),
                    inputs: samples.input.get(next..range.end).unwrap_or(&[]),
                };
                let (Some(&x), Some(&y), Some(place)) = (span.xi.first(), span.eta.first(), runs.next()) else { break };
                let run = if part.opens && samples.is_open(next) {
                    was_open = true;
                    let closes = span.inputs.iter().position(|input| *input > 0.0);
                    Run { count: closes.unwrap_or(span.inputs.len()), ..EMPTY_RUN }
                } else {
                    if was_open {
                        stack.depth = 0;
                        stack.push(Knot::centre(closing(samples, element, next).displacement));
                        was_open = false;
                    }
                    if !stack.close_loops(x, y) {
                        stick(&mut stack, span)
                    } else if stack.depth == 0 {
                        slip_grossly(&mut stack, span)
                    } else {
                        let places = self.cut_shift.get_mut(extent.cuts..).unwrap_or(&mut []);
                        let run = slip(&mut stack, span, element.per_two_mu, places);
                        extent.cuts += run.count;
                        run
                    }
                };
                *place = run.encoded();
                extent.runs += 1;
                next += run.count;
            }
        }
        // Fills the last block of four.
        let last = extent.cuts.checked_sub(1).map_or(0.0, |last| at(self.cut_shift, last));
        self.cut_shift.iter_mut().skip(extent.cuts).take(3).for_each(|place| *place = last);
        extent
    }
}

pub(super) const EMPTY_RUN: Run =
    Run { kind: Kind::Open, first: 0, count: 1, kept: 0, inner: Place::CENTRE, packed: 0, sign: 1.0, parameter: 0.0 };

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
        *place = Knot { xi: x, eta: y, place: Place::end(span.first + count) }.encoded();
        (xi, eta) = (x, y);
        count += 1;
    }
    stack.depth += count;
    Run { kind: Kind::Stuck, count, kept, inner: inner.place, parameter: inner.xi, ..EMPTY_RUN }
}

/// Samples of gross slip in one direction, from an empty stack that still holds the centre in its memory.
fn slip_grossly(stack: &mut Stack, span: Span) -> Run {
    let is_forward = span.xi.first().is_some_and(|x| stack.knot(0).xi <= *x);
    let (count, [xi, eta]) = if is_forward { count_gross_slip::<true>(span) } else { count_gross_slip::<false>(span) };
    stack.push(Knot::centre(if is_forward { xi } else { eta }));
    stack.push(Knot { xi, eta, place: Place::end(span.first + count - 1) });
    Run { kind: Kind::GrossSlip, count, sign: if is_forward { 1.0 } else { -1.0 }, ..EMPTY_RUN }
}

/// Lower bound of divisors: compilers may divide before they compare.
const SMALLEST: f64 = 1e-150;

/// Samples whose slip zone grows in one direction, along the piece above the last knot that stays.
fn slip(stack: &mut Stack, span: Span, per_two_mu: f64, places: &mut [f64]) -> Run {
    let kept = stack.depth;
    let (inner, outer) = (stack.knot(kept - 1), stack.knot(kept));
    let (falling, rising) = (inner.xi - outer.xi, outer.eta - inner.eta);
    let (x, y) = (span.xi.first().copied().unwrap_or(0.0), span.eta.first().copied().unwrap_or(0.0));
    // The piece leaves the quadrant through ξ = x unless it crosses η = y first.
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
        kind: Kind::Slip,
        count,
        kept,
        inner: inner.place,
        sign: if is_forward { 1.0 } else { -1.0 },
        parameter: slope(falling, rising),
        ..EMPTY_RUN
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
