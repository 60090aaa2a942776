//! The memory diagram along a period: runs of samples that change it in the same way.
//!
//! Only the characteristic coordinates of the samples are needed. The normal forces at the boundaries of the slip zones are evaluated
//! afterwards, all at once: the shifts of these boundaries are packed in the order of the samples that slip.

use crate::varying_load::harmonic_force::samples::{Part, Samples, at, ranges};

/// Doubles of a knot and of a run in the workspace.
pub(super) const KNOT: usize = 6;
pub(super) const RUN: usize = 10;

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

/// End of a piece of the diagram: the centre of the contact, or a point that a sample made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    Centre,
    /// The whole contact at a sample.
    End(usize),
    /// The boundary of the slip zone at a sample.
    Cut(usize),
}

impl Place {
    fn to_number(self) -> f64 {
        match self {
            Place::Centre => -1.0,
            Place::Cut(sample) => (2 * sample) as f64,
            Place::End(sample) => (2 * sample + 1) as f64,
        }
    }

    fn from_number(number: f64) -> Place {
        if number < 0.0 {
            return Place::Centre;
        }
        let number = number as usize;
        if number % 2 == 0 { Place::Cut(number / 2) } else { Place::End(number / 2) }
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
    /// Slip: D/mu of the piece that is cut.
    pub slope: f64,
    /// Stuck: coordinates of the last knot that stays.
    pub xi: f64,
    pub eta: f64,
}

impl From<Run> for [f64; RUN] {
    fn from(run: Run) -> [f64; RUN] {
        let kind = f64::from(run.kind as u8);
        let (first, count, kept, packed) = (run.first as f64, run.count as f64, run.kept as f64, run.packed as f64);
        [kind, first, count, kept, run.inner.to_number(), packed, run.sign, run.slope, run.xi, run.eta]
    }
}

impl From<[f64; RUN]> for Run {
    fn from([kind, first, count, kept, inner, packed, sign, slope, xi, eta]: [f64; RUN]) -> Run {
        Run {
            kind: match kind as u8 {
                0 => Kind::Open,
                1 => Kind::Stuck,
                2 => Kind::Slip,
                _ => Kind::GrossSlip,
            },
            first: first as usize,
            count: count as usize,
            kept: kept as usize,
            inner: Place::from_number(inner),
            packed: packed as usize,
            sign,
            slope,
            xi,
            eta,
        }
    }
}

/// A knot of the diagram, and the direction of the piece that ends at it: decrease of ξ and increase of η.
#[derive(Debug, Clone, Copy)]
struct Knot {
    xi: f64,
    eta: f64,
    falling: f64,
    rising: f64,
    place: Place,
}

impl From<Knot> for [f64; KNOT] {
    fn from(knot: Knot) -> [f64; KNOT] {
        [knot.xi, knot.eta, knot.falling, knot.rising, knot.place.to_number(), 0.0]
    }
}

impl From<[f64; KNOT]> for Knot {
    fn from([xi, eta, falling, rising, place, _]: [f64; KNOT]) -> Knot {
        Knot { xi, eta, falling, rising, place: Place::from_number(place) }
    }
}

impl Knot {
    const fn centre(displacement: f64) -> Knot {
        Knot { xi: displacement, eta: displacement, falling: 0.0, rising: 0.0, place: Place::Centre }
    }

    /// The far end of the part with D = 0.
    const CORE: Knot = Knot { xi: f64::MIN, eta: f64::MAX, falling: 1.0, rising: 1.0, place: Place::Centre };
}

/// Memory of a walk.
#[derive(Debug)]
pub(super) struct Walk<'a> {
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
    #[inline(always)]
    fn knot(&self, index: usize) -> Knot {
        self.knots.get(index).copied().unwrap_or([0.0; KNOT]).into()
    }

    #[inline(always)]
    fn push(&mut self, knot: Knot) {
        if let Some(place) = self.knots.get_mut(self.depth) {
            *place = knot.into();
            self.depth += 1;
        }
    }

    /// Removes the knots outside the quadrant ξ > x, η < y; returns whether there were any.
    #[inline(always)]
    fn pop(&mut self, x: f64, y: f64) -> bool {
        let inside = |&[xi, eta, ..]: &[f64; KNOT]| xi > x && eta < y;
        let kept =
            self.knots.get(..self.depth).and_then(|knots| knots.iter().rposition(inside)).map_or(0, |last| last + 1);
        let popped = kept < self.depth;
        self.depth = kept;
        popped
    }
}

impl Walk<'_> {
    /// The memory of the knots, for a diagram with forces.
    pub fn diagram(&mut self) -> &mut [[f64; 4]] {
        self.knots.as_flattened_mut().as_chunks_mut().0
    }

    #[inline(always)]
    pub fn evaluate(&mut self, friction_coefficient: f64, by_approach: bool, samples: &Samples, part: &Part) -> Extent {
        let mut stack = Stack { knots: self.knots, depth: 0 };
        stack.push(Knot::centre(0.0));
        if !part.opens {
            stack.push(Knot::CORE);
        }
        let mut runs = self.runs.iter_mut();
        let (mut count, mut cuts) = (0, 0);
        let mut was_open = part.opens;
        let half_over_mu = 0.5 / friction_coefficient;
        for range in ranges(part, samples.count) {
            let mut next = range.start;
            while next < range.end {
                let xi = samples.xi.get(next..range.end).unwrap_or(&[]);
                let eta = samples.eta.get(next..range.end).unwrap_or(&[]);
                let (Some(&x), Some(&y), Some(place)) = (xi.first(), eta.first(), runs.next()) else { break };
                let mut run = Run {
                    kind: Kind::Open,
                    first: next,
                    count: 1,
                    kept: 0,
                    inner: Place::Centre,
                    packed: cuts,
                    sign: 1.0,
                    slope: 0.0,
                    xi: 0.0,
                    eta: 0.0,
                };
                if part.opens && samples.is_open(next) {
                    let input = samples.input.get(next..range.end).unwrap_or(&[]);
                    run.count = input.iter().position(|input| *input > 0.0).unwrap_or(input.len());
                    was_open = true;
                } else {
                    if was_open {
                        stack.depth = 0;
                        stack.push(Knot::centre(closing(samples, by_approach, next).displacement));
                        was_open = false;
                    }
                    if stack.pop(x, y) {
                        if stack.depth == 0 {
                            run.kind = Kind::GrossSlip;
                            let centre = stack.knot(0).xi;
                            let inputs = samples.input.get(next..range.end).unwrap_or(&[]);
                            let (count, end) = if centre <= x {
                                gross_slip::<true>(xi, eta, inputs)
                            } else {
                                run.sign = -1.0;
                                gross_slip::<false>(xi, eta, inputs)
                            };
                            run.count = count;
                            let origin = if run.sign > 0.0 { end.0 } else { end.1 };
                            stack.push(Knot::centre(origin));
                            stack.push(line_end(end, run.sign, next + count - 1));
                        } else {
                            run.kind = Kind::Slip;
                            run.kept = stack.depth;
                            let (inner, outer) = (stack.knot(run.kept - 1), stack.knot(run.kept));
                            run.inner = inner.place;
                            let sum = outer.falling + outer.rising;
                            let (falling, rising) = (outer.falling / sum, outer.rising / sum);
                            run.slope = rising - falling;
                            let places = self.cut_shift.get_mut(cuts..).unwrap_or(&mut []);
                            let (count, end, cut);
                            if falling * (y - inner.eta) >= rising * (inner.xi - x) {
                                let ratio = rising / falling;
                                (count, end, cut) = slip::<true>(xi, eta, &inner, ratio, half_over_mu, places);
                            } else {
                                run.sign = -1.0;
                                let ratio = falling / rising;
                                (count, end, cut) = slip::<false>(xi, eta, &inner, ratio, half_over_mu, places);
                            }
                            run.count = count;
                            cuts += count;
                            let last = next + count - 1;
                            let (cut_xi, cut_eta) = cut;
                            stack.push(Knot { xi: cut_xi, eta: cut_eta, falling, rising, place: Place::Cut(last) });
                            stack.push(line_end(end, run.sign, last));
                        }
                    } else {
                        run.kind = Kind::Stuck;
                        run.kept = stack.depth;
                        let mut inner = stack.knot(run.kept - 1);
                        (run.inner, run.xi, run.eta) = (inner.place, inner.xi, inner.eta);
                        let mut count = 0;
                        for (&x, &y) in xi.iter().zip(eta) {
                            if x >= inner.xi || y <= inner.eta {
                                break;
                            }
                            inner = Knot {
                                xi: x,
                                eta: y,
                                falling: inner.xi - x,
                                rising: y - inner.eta,
                                place: Place::End(next + count),
                            };
                            stack.push(inner);
                            count += 1;
                        }
                        run.count = count;
                    }
                }
                *place = run.into();
                count += 1;
                next += run.count;
            }
        }
        Extent { runs: count, cuts }
    }
}

/// Where the path from the open sample before a sample closes the contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Closing {
    pub displacement: f64,
    /// Derivatives of this displacement by displacement and input of the sample before and of the sample.
    pub before: [f64; 2],
    pub after: [f64; 2],
}

pub(super) fn closing(samples: &Samples, by_approach: bool, sample: usize) -> Closing {
    let before = samples.before(sample);
    let [u0, u1] = [before, sample].map(|sample| at(samples.displacement, sample));
    if !by_approach {
        return Closing { displacement: u0, before: [1.0, 0.0], after: [0.0, 0.0] };
    }
    let [w0, w1] = [before, sample].map(|sample| at(samples.input, sample));
    // w0 <= 0 < w1.
    let (fraction, rest) = (-w0 / (w1 - w0), w1 / (w1 - w0));
    let slope = (u1 - u0) / (w1 - w0);
    Closing {
        displacement: u0 + fraction * (u1 - u0),
        before: [rest, -rest * slope],
        after: [fraction, -fraction * slope],
    }
}

/// The whole contact after slip: a piece parallel to an axis.
fn line_end((xi, eta): (f64, f64), sign: f64, sample: usize) -> Knot {
    let (falling, rising) = if sign > 0.0 { (0.0, 1.0) } else { (1.0, 0.0) };
    Knot { xi, eta, falling, rising, place: Place::End(sample) }
}

/// Coordinates such that slip in either direction is forward slip.
#[inline(always)]
fn mirrored<const FORWARD: bool>(xi: f64, eta: f64) -> (f64, f64) {
    if FORWARD { (xi, eta) } else { (-eta, -xi) }
}

/// Number of samples of a run of gross slip, and the coordinates of the last.
#[inline(always)]
fn gross_slip<const FORWARD: bool>(xi: &[f64], eta: &[f64], inputs: &[f64]) -> (usize, (f64, f64)) {
    let mut count = 0;
    let (mut end, mut last) = ((0.0, 0.0), f64::MIN);
    for ((&xi, &eta), &input) in xi.iter().zip(eta).zip(inputs) {
        let (x, _) = mirrored::<FORWARD>(xi, eta);
        if count > 0 && (x < last || input <= 0.0) {
            break;
        }
        (last, end) = (x, (xi, eta));
        count += 1;
    }
    (count, end)
}

/// Number of samples of a run of slip that cut one piece, the coordinates of the last, and its cut.
#[inline(always)]
fn slip<const FORWARD: bool>(
    xi: &[f64],
    eta: &[f64],
    inner: &Knot,
    ratio: f64,
    half_over_mu: f64,
    places: &mut [f64],
) -> (usize, (f64, f64), (f64, f64)) {
    let (inner_x, inner_y) = mirrored::<FORWARD>(inner.xi, inner.eta);
    let mut count = 0;
    let (mut end, mut last, mut last_cut) = ((0.0, 0.0), f64::MIN, 0.0);
    for ((&xi, &eta), place) in xi.iter().zip(eta).zip(places) {
        let (x, y) = mirrored::<FORWARD>(xi, eta);
        let cut = inner_y + ratio * (inner_x - x);
        if count > 0 && !(x >= last && x < inner_x && cut <= y) {
            break;
        }
        *place = (cut - x) * half_over_mu;
        (last, last_cut, end) = (x, cut, (xi, eta));
        count += 1;
    }
    (count, end, mirrored::<FORWARD>(last, last_cut))
}
