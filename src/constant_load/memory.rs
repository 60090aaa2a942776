//! Return-point memory: the stack of displacement reversals, and the branch on which a displacement lies.
//!
//! Every reversal opens a branch. A branch that returns to the displacement of the reversal before its own closes that loop, and
//! both reversals are popped. The branch of the oldest reversal ends at the mirror point of that reversal on the initial loading
//! curve. Gross slip clears the stack and shifts the initial loading curve along with the slider. This module is the only one that
//! contains these rules: time steps and both quadrature rules of the harmonic balance apply them through [`Memory`].
//!
//! Branches are located by comparing displacements only; no force is evaluated.
//!
//! A reversal is stored as `[displacement, force, error]`. The error bounds what reversals that were merged away would change in
//! the force of the branch that leaves this reversal; it is 0 unless the stack was full (see [`Merge`]).

use crate::constant_load::contact::Contact;
use crate::numerics::slices::PanicFreeSlice;

/// A point of a load history.
#[derive(Clone, Copy, Default)]
pub(crate) struct Point {
    pub displacement: f64,
    pub force: f64,
}

/// A reversal on the stack: displacement, force, and the error from merged reversals.
pub(crate) type Reversal = [f64; 3];

fn point([displacement, force, _]: Reversal) -> Point {
    Point { displacement, force }
}

/// The initial loading (backbone) curve of a history; by default that of an unloaded contact.
#[derive(Clone, Copy, Default)]
pub(crate) struct InitialCurve {
    /// Displacement at which it starts.
    pub offset: f64,
    /// Direction, +1 or -1, of the last gross slip; 0 if there was none. After gross slip only the ends of the curve, at mu N,
    /// can be reached again.
    pub slip_direction: f64,
}

impl InitialCurve {
    /// The curve after a step that ends on `branch` at `displacement`. Without friction it starts at every displacement.
    pub fn after(self, contact: &Contact, branch: &Branch, displacement: f64) -> InitialCurve {
        if contact.is_frictionless() {
            InitialCurve { offset: displacement, slip_direction: 0.0 }
        } else if branch.gross_slip {
            let offset = displacement - branch.direction * contact.slip_displacement;
            InitialCurve { offset, slip_direction: branch.direction }
        } else {
            self
        }
    }
}

/// A branch of the force-displacement curve: it leaves a reversal, or is the initial loading curve, or gross slip.
#[derive(Clone, Copy)]
pub(crate) struct Branch {
    /// Number of reversals on the stack, up to the reversal that this branch leaves; 0 on the initial loading curve.
    pub depth: usize,
    /// The reversal that it leaves, or the start of the initial loading curve.
    pub start: Point,
    /// +1 or -1.
    pub direction: f64,
    /// Displacement at which it ends: of the reversal before its own, of a mirror point, or at the onset of gross slip.
    pub end: f64,
    /// Masing scale: 2 after a reversal, 1 on the initial loading curve.
    pub scale: f64,
    /// 1/`scale`.
    pub inverse_scale: f64,
    pub gross_slip: bool,
}

impl Branch {
    /// The branch that leaves reversal number `depth` of the stack, given also the reversal before it.
    fn from_reversal(depth: usize, start: Point, before: Option<Point>, offset: f64, direction: f64) -> Branch {
        let end = before.map_or(2.0 * offset - start.displacement, |before| before.displacement);
        Branch { depth, start, direction, end, scale: 2.0, inverse_scale: 0.5, gross_slip: false }
    }

    /// Whether a displacement in the direction of the branch lies before its end. The end of the initial loading curve belongs to
    /// it: gross slip starts beyond.
    pub fn contains(&self, displacement: f64) -> bool {
        let beyond = self.direction * (displacement - self.end);
        self.gross_slip || beyond < 0.0 || (beyond == 0.0 && self.depth == 0)
    }

    /// Displacement on the monotonic curve that corresponds to a displacement on the branch: `|δ-δ_r|/2` after a reversal. A
    /// distance that exceeds that of gross slip by rounding is cut off there.
    pub fn distance(&self, slip_displacement: f64, displacement: f64) -> f64 {
        let distance = (displacement - self.start.displacement).abs() * self.inverse_scale;
        if distance > slip_displacement { slip_displacement } else { distance }
    }
}

/// One segment of a step, on one branch: both ends as displacements on the monotonic curve.
pub(crate) struct StepSegment {
    /// Masing scale of the branch.
    pub scale: f64,
    pub start: f64,
    pub end: f64,
    /// Length of gross slip after the end.
    pub slip_length: f64,
}

/// The memory of one history, for reading; by default that of an unloaded contact.
#[derive(Clone, Copy, Default)]
pub(crate) struct Memory<'a> {
    pub initial: InitialCurve,
    pub now: Point,
    /// The reversals on the stack, oldest first.
    pub reversals: &'a [Reversal],
}

/// The branch on which a step ends.
pub(crate) struct Transition {
    /// The branch on which the step ends.
    pub branch: Branch,
    /// Whether the point at which the step starts becomes the newest reversal, which that branch leaves.
    pub reversed: bool,
}

impl Memory<'_> {
    pub fn depth(&self) -> usize {
        self.reversals.len()
    }

    /// A reversal of the stack; 1 is the oldest.
    fn reversal(&self, number: usize) -> Option<Point> {
        self.reversals.get(number.wrapping_sub(1)).map(|reversal| point(*reversal))
    }

    /// The branch that leaves reversal `depth` of the stack; the initial loading curve for 0.
    pub fn branch(&self, contact: &Contact, depth: usize, direction: f64) -> Branch {
        let InitialCurve { offset, slip_direction } = self.initial;
        match self.reversal(depth) {
            Some(start) => Branch::from_reversal(depth, start, self.reversal(depth - 1), offset, direction),
            None => Branch {
                depth: 0,
                // The sign of the zero keeps compilers from an instruction that valgrind does not know.
                start: Point { displacement: offset, force: -0.0 },
                direction,
                end: offset + direction * contact.slip_displacement,
                scale: 1.0,
                inverse_scale: 1.0,
                gross_slip: slip_direction != 0.0,
            },
        }
    }

    /// The branch that continues a branch at its end. The end of a loop is continued by the branch of the enclosing loop, the
    /// mirror point by the initial loading curve, and the initial loading curve by gross slip.
    pub fn continuation(&self, contact: &Contact, branch: &Branch) -> Branch {
        if branch.depth == 0 {
            Branch { gross_slip: true, ..*branch }
        } else {
            self.branch(contact, branch.depth.saturating_sub(2), branch.direction)
        }
    }

    /// Direction of the branch at the present point; 0 at the start of the initial loading curve.
    fn heading(&self) -> f64 {
        match self.reversals.last() {
            Some(newest) => self.now.displacement - point(*newest).displacement,
            // In gross slip the offset may be too far away for a difference.
            None if self.initial.slip_direction != 0.0 => self.initial.slip_direction,
            None => self.now.displacement - self.initial.offset,
        }
    }

    /// The branch of the present point, if a displacement lies on it ahead of that point and before its end, without gross slip.
    /// The result is that of [`Memory::locate`], without its other cases; `None` in these, and without friction.
    pub fn branch_ahead(&self, contact: &Contact, target: f64) -> Option<Branch> {
        let is_gross_slip = self.reversals.is_empty() && self.initial.slip_direction != 0.0;
        if is_gross_slip || contact.is_frictionless() {
            return None;
        }
        let heading = self.heading();
        let branch = self.branch(contact, self.depth(), if heading < 0.0 { -1.0 } else { 1.0 });
        let advance = target - self.now.displacement;
        (heading * advance > 0.0 && (branch.end - target) * advance > 0.0).then_some(branch)
    }

    /// Locates the branch on which a displacement lies, closing loops on the way; `on_segment` is called for each segment. A step
    /// of zero continues the present branch. Without friction the result is the initial loading curve, and there are no segments.
    pub fn locate(&self, contact: &Contact, target: f64, mut on_segment: impl FnMut(StepSegment)) -> Transition {
        let from = self.now.displacement;
        let heading = self.heading();
        let change = if target == from { heading } else { target - from };
        let direction = if change < 0.0 { -1.0 } else { 1.0 };
        if contact.is_frictionless() {
            let branch = Branch { gross_slip: false, ..self.branch(contact, 0, direction) };
            return Transition { branch, reversed: false };
        }
        let reversed = direction * heading < 0.0;
        let branch = if reversed {
            let (depth, offset) = (self.depth(), self.initial.offset);
            Branch::from_reversal(depth + 1, self.now, self.reversal(depth), offset, direction)
        } else {
            self.branch(contact, self.depth(), direction)
        };
        if branch.contains(target) {
            on_segment(branch.segment(contact.slip_displacement, from, target));
            return Transition { branch, reversed };
        }
        Transition { branch: self.close_loops(contact, branch, target, on_segment), reversed: false }
    }

    /// The branch on which a displacement beyond the end of `branch` lies. Its depth leaves out the reversals of the closed loops.
    #[inline(never)]
    fn close_loops(
        &self,
        contact: &Contact,
        mut branch: Branch,
        target: f64,
        mut on_segment: impl FnMut(StepSegment),
    ) -> Branch {
        let (mut at, slip_displacement) = (self.now.displacement, contact.slip_displacement);
        while !branch.contains(target) {
            let segment = branch.segment(slip_displacement, at, branch.end);
            // The initial loading curve ends at gross slip exactly.
            on_segment(StepSegment { end: if branch.depth == 0 { slip_displacement } else { segment.end }, ..segment });
            at = branch.end;
            branch = self.continuation(contact, &branch);
        }
        on_segment(branch.segment(slip_displacement, at, target));
        branch
    }
}

impl Branch {
    /// The segment of the branch between two displacements.
    pub fn segment(&self, slip_displacement: f64, from: f64, to: f64) -> StepSegment {
        if self.gross_slip {
            return StepSegment { scale: 1.0, start: 0.0, end: 0.0, slip_length: (to - from).abs() };
        }
        let start = self.distance(slip_displacement, from);
        StepSegment { scale: self.scale, start, end: self.distance(slip_displacement, to), slip_length: 0.0 }
    }
}

/// A force within ± a limit.
pub(crate) fn within(limit: f64, force: f64) -> f64 {
    let force = if force > limit { limit } else { force };
    if force < -limit { -limit } else { force }
}

/// Pushes a reversal on a stack of the given depth. The length of the stack is its capacity, at least 2; two reversals of a full
/// stack are merged first. Returns the new depth, and by how much the merge has shifted the force.
pub(crate) fn push(
    contact: &Contact,
    offset: f64,
    reversals: &mut [Reversal],
    depth: usize,
    newest: Point,
) -> (usize, f64) {
    let (mut depth, mut shift) = (depth, 0.0);
    if depth >= reversals.len() {
        let merge = Merge::new(contact, offset, reversals, newest.displacement);
        depth = merge.apply(offset, reversals);
        shift = merge.shift;
    }
    reversals.set(depth, [newest.displacement, within(contact.slip_force, newest.force + shift), 0.0]);
    (depth + 1, shift)
}

/// The removal of a pair of neighbouring reversals from a full stack, to make room for one more.
///
/// Let the pair (2, 3) be removed between its neighbours 1 and 4, with the ranges A, B, C from 1 to 2, 2 to 3 and 3 to 4, and let
/// `F(x) = 2 T(x/2)` be the branch curve. In the equivalent bank of spring-sliders the two memories differ by slider forces of one
/// sign, the direction from 1 to 2, that add up to
///
/// ```text
/// [F(B) - F(C)] - [F(A) - F(A - B + C)]  >= 0,
/// ```
///
/// by which all forces from 4 on are shifted. Under any later motion each of these slider forces can only shrink, until the loop of
/// reversal 1 is closed. So this sum, plus the errors of the branches that leave 1 and 3, bounds the error of the branch that
/// leaves 1 from now on. The branch that leaves 2 is gone with its error. The oldest reversal has no neighbour before it; its
/// mirror point takes that place, because both describe the same memory.
pub(crate) struct Merge {
    /// Index of the first reversal of the pair.
    pair: usize,
    /// Error of the branch that leaves the reversal before the pair.
    error: f64,
    /// Change of all later forces.
    pub shift: f64,
}

/// The mirror point of the oldest reversal on the initial loading curve. It is rounded outwards, so that it and its own mirror
/// point enclose all other reversals.
fn mirror(offset: f64, [displacement, force, _]: Reversal) -> Reversal {
    let mirrored = 2.0 * offset - displacement;
    let exact = 2.0 * offset - mirrored == displacement;
    let rounding = if exact { 0.0 } else { 4.0 * f64::EPSILON * (offset.abs() + displacement.abs()) };
    [mirrored + if mirrored < displacement { -rounding } else { rounding }, -force, 0.0]
}

impl Merge {
    /// The pair whose removal gives the smallest bound on the error of the force, if a reversal at `newest` is stored next.
    #[cold]
    #[inline(never)]
    pub fn new(contact: &Contact, offset: f64, reversals: &[Reversal], newest: f64) -> Merge {
        let range = |[from, ..]: Reversal, [to, ..]: Reversal| (to - from).abs();
        // The rounding errors of some forces of up to mu N, and of the mirror point.
        let mirrored = contact.initial_stiffness * (offset.abs() + reversals.first().map_or(0.0, |[d, ..]| d.abs()));
        let rounding = 16.0 * f64::EPSILON * (contact.slip_force + mirrored);
        let at = |i: usize| reversals.get(i).copied().unwrap_or([newest, 0.0, 0.0]);
        let sums = error_sums(reversals);
        let (mut best, mut least) = (Merge { pair: 0, error: 0.0, shift: 0.0 }, f64::INFINITY);
        let mut before = mirror(offset, at(0));
        for pair in 0..reversals.len().saturating_sub(1) {
            let [one, two, next] = [pair, pair + 1, pair + 2].map(at);
            let (a, b, c) = (range(before, one), range(one, two), range(two, next));
            let [inner, outer] =
                [(b, c), (a, (a - (b - c)).max(0.0))].map(|(long, short)| branch_force_between(contact, short, long));
            let change = if inner > outer { inner - outer } else { 0.0 };
            // Errors of the direction of the branch before the pair, and of the other one, to which the branch that leaves `one`
            // belongs.
            let (same, other) = (sums[(pair + 1) % 2] + change + rounding, sums[pair % 2] - one[2]);
            if same < least && other < least {
                let shift = if one[0] < before[0] { -change } else { change };
                (best, least) = (Merge { pair, error: before[2] + two[2] + change + rounding, shift }, same.max(other));
            }
            before = one;
        }
        best
    }

    /// Removes the pair from the stack; returns the new depth.
    pub fn apply(&self, offset: f64, reversals: &mut [Reversal]) -> usize {
        let Merge { pair, error, shift } = *self;
        for [_, force, _] in reversals.iter_mut().skip(pair + 2) {
            *force += shift;
        }
        if pair > 0 {
            if let Some([.., previous]) = reversals.get_mut(pair - 1) {
                *previous = error;
            }
            return remove(reversals, pair, 2);
        }
        if let Some(oldest) = reversals.first_mut() {
            let [displacement, force, _] = mirror(offset, *oldest);
            *oldest = [displacement, force, error];
        }
        remove(reversals, 1, 1)
    }
}

/// Removes a number of reversals from a full stack, the first at the index `from`; returns the new depth.
fn remove(reversals: &mut [Reversal], from: usize, count: usize) -> usize {
    let mut to = from;
    while let Some(&reversal) = reversals.get(to + count) {
        reversals.set(to, reversal);
        to += 1;
    }
    to
}

/// `F(long) - F(short)` of the branch curve.
fn branch_force_between(contact: &Contact, short: f64, long: f64) -> f64 {
    let [short, long] = [short, long].map(|range| contact.response(0.5 * range).force);
    2.0 * (long - short)
}

/// Bound on the error \[N\] of the force that merged reversals cause. Errors of branches of one direction add up; the sums for the
/// two directions have opposite signs.
pub(crate) fn force_error(reversals: &[Reversal]) -> f64 {
    let [one, other] = error_sums(reversals);
    if one > other { one } else { other }
}

/// Sums of the errors of the branches of either direction.
fn error_sums(reversals: &[Reversal]) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for (number, [.., error]) in reversals.iter().enumerate() {
        sums[number % 2] += error;
    }
    sums
}
