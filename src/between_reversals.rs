//! Harmonic force by quadrature between the reversals: few points of the curve, and hardly any error.
//!
//! The force of a periodic displacement is smooth but for a few instants, where the displacement turns, where a loop closes,
//! and where gross slip starts. Equidistant samples miss them, and err by samples⁻². Here they are found, as roots of the
//! displacement's rate and as crossings of a level, and each piece between two of them has its own Gauss-Legendre rule. On a
//! piece the force is analytic: after a reversal it depends on `u - u_r ~ (t - t_r)²` alone. So the error falls
//! exponentially with the number of nodes, but for a piece that ends where gross slip starts: there the curve has any power of
//! the cube root of the way that is left, and the nodes are those of the cube root. While the contact slides, the integrals are
//! closed.
//!
//! The steady state is entered at the farthest turning point, as in `harmonic_force`; it needs half a period where there are
//! only odd harmonics. All energies are those between reversals, so that the energy of the period is exact.
//!
//! The Jacobian is the same rule applied to the exact derivative of the integrals,
//!
//! ```text
//! dF = ∫ φ dT dt,     dT = k (φ - φ_r) + dT_r,
//! ```
//!
//! in which the motion of the instants has no part: the force is continuous there. The derivative of the rule's sum would add
//! to it the derivative of the rule's error times that of the instants, `dt_e = -φ'/ü`, which grows without bound where
//! two reversals merge, and says nothing of the contact. The two differ by the error of the rule.

use crate::contact::Contact;
use crate::curve::Response;
use crate::error::Error;
use crate::harmonic_force::{Branch, HarmonicOutput};
use crate::masing::Dissipation;
use crate::memory::{Stretch, Virgin};
use crate::quadrature::{GAUSS_FOURS, gauss_rule};
use crate::seal::Kind;
use crate::waves::{add_products, clear_other_parity, fill_columns, sample, scale};
use crate::workspace::{HEADER, Size, read_header, says, sealed_parts};
use core::f64::consts::PI;

/// Fewest nodes of a piece, in fours.
const LEAST_FOURS: usize = 2;
const LEAST_FOURS_TO_SLIP: usize = 4;

/// Nodes that are taken together.
const PANEL: usize = 4 * GAUSS_FOURS;

/// Numbers in fours, of a panel.
type Nodes = [[f64; 4]; GAUSS_FOURS];

/// Numbers of doubles in the parts of a workspace.
struct Layout(Size);

impl Layout {
    fn new(harmonics: usize, samples: usize) -> Result<Layout, Error> {
        let rows = |size| {
            let layout = Layout(size);
            layout.grid() + layout.reversals() + PANEL
        };
        Size::new(harmonics, samples, rows).map(Layout)
    }

    /// Instants at which the rate is looked at: an even number, sixteen for the shortest wave at least. Three turning points
    /// within two steps could be taken for one; their loops are so small that their squares count for nothing.
    fn grid(&self) -> usize {
        (self.0.samples.max(16 * self.0.harmonics) + 1) & !1
    }

    /// A displacement turns 2H times a period at most; what exceeds that is rounding.
    fn reversals(&self) -> usize {
        4 * self.0.harmonics + 8
    }

    fn tables(&self) -> usize {
        self.grid() / 2 * self.0.coefficients()
    }

    fn length(&self) -> usize {
        let (n, grid) = (self.0.coefficients(), self.grid());
        HEADER + self.tables() + 3 * grid + self.reversals() * (2 + 2 * n) + 4 * self.0.harmonics * PANEL + 8 * n
    }
}

/// Doubles of a workspace for so many harmonics H and nodes a period; 0 where there is none (H = 0, or too few nodes).
#[must_use]
pub fn workspace_length(harmonics: usize, samples: usize) -> usize {
    Layout::new(harmonics, samples).map_or(0, |layout| layout.length())
}

/// Prepares a workspace: the table of one pair of harmonics and samples, and scratch memory.
///
/// # Errors
/// `BadHarmonics` for none, `BadSamples` for samples <= 2H, `WorkspaceTooShort`.
pub fn workspace_init(harmonics: usize, samples: usize, workspace: &mut [f64]) -> Result<(), Error> {
    let layout = Layout::new(harmonics, samples)?;
    let Some(memory) = workspace.get_mut(..layout.length()) else { return Err(Error::WorkspaceTooShort) };
    layout.0.begin(Kind::BetweenReversals, memory, layout.tables(), |columns| {
        fill_columns(columns.take(layout.tables())?, layout.grid(), layout.grid() / 2);
        Ok(())
    })
}

/// Doubles that a prepared workspace occupies, from what it begins with; none for memory that is no workspace of this rule.
///
/// # Errors
/// `BadWorkspace` for one that was changed.
#[must_use]
pub fn workspace_extent(header: &[f64; HEADER]) -> Option<Result<usize, Error>> {
    says(Kind::BetweenReversals, header).then(|| layout_of(header).map(|layout| layout.length()))
}

fn layout_of(header: &[f64; HEADER]) -> Result<Layout, Error> {
    let (harmonics, samples) = read_header(Kind::BetweenReversals, header)?;
    Layout::new(harmonics, samples).map_err(|_| Error::BadWorkspace)
}

/// A workspace as it is used.
#[derive(Debug)]
pub struct Workspace<'a> {
    harmonics: usize,
    samples: usize,
    /// Over the grid's first half, for each coefficient: 1, cos t, sin t, cos 2t, ...
    columns: &'a [f64],
    /// The displacement's rate on the grid.
    rate: &'a mut [f64],
    /// Instant and displacement of each turning point.
    turns: &'a mut [f64],
    /// Displacement and force of each reversal.
    reversals: &'a mut [f64],
    /// φ_r and dT_r of each reversal, rows over the coefficients.
    gradients: &'a mut [f64],
    /// cos and sin of each order up to 2H at the nodes of a panel.
    waves: &'a mut [f64],
    /// Fourier sums: of the force, of the stiffness on one piece and, up to the order 2H, on all.
    force_sums: &'a mut [f64],
    piece_sums: &'a mut [f64],
    stiffness_sums: &'a mut [f64],
    /// Integrals of φ over a piece, and one more row.
    integrals: &'a mut [f64],
    row: &'a mut [f64],
}

impl<'a> Workspace<'a> {
    /// Takes a prepared workspace into use.
    ///
    /// # Errors
    /// `BadWorkspace` for memory that was not initialised, or was changed.
    #[inline(always)]
    pub fn new(workspace: &'a mut [f64]) -> Result<Workspace<'a>, Error> {
        let layout = layout_of(workspace.first_chunk::<HEADER>().ok_or(Error::BadWorkspace)?)?;
        let (grid, n) = (layout.grid(), layout.0.coefficients());
        let mut parts = sealed_parts(workspace, layout.length(), layout.tables())?;
        Ok(Workspace {
            harmonics: layout.0.harmonics,
            samples: layout.0.samples,
            columns: parts.take(layout.tables())?,
            rate: parts.take(grid)?,
            turns: parts.take(2 * grid)?,
            reversals: parts.take(2 * layout.reversals())?,
            gradients: parts.take(2 * n * layout.reversals())?,
            waves: parts.take(4 * layout.0.harmonics * PANEL)?,
            force_sums: parts.take(n)?,
            piece_sums: parts.take(2 * n - 1)?,
            stiffness_sums: parts.take(2 * n - 1)?,
            integrals: parts.take(n)?,
            row: parts.take(n)?,
        })
    }

    /// 2H + 1.
    #[must_use]
    pub fn coefficients(&self) -> usize {
        2 * self.harmonics + 1
    }
}

/// Harmonic force of a periodic displacement given by its 2H + 1 coefficients \[m\].
///
/// # Errors
/// `BadDisplacement` for a coefficient that is not finite, `BadArraySize` where a length is not that of the workspace.
#[inline(always)]
pub fn harmonic_force(
    contact: &Contact,
    workspace: &mut Workspace,
    displacement: &[f64],
    output: HarmonicOutput,
) -> Result<(), Error> {
    let n = workspace.coefficients();
    let mut output = output;
    if output.is_trivial(contact, n, displacement)? {
        return Ok(());
    }
    let HarmonicOutput { force, mut jacobian, dissipated } = output;
    let Some((&constant, pairs)) = displacement.split_first() else { return Ok(()) };
    let motion = Motion { constant, pairs: pairs.as_chunks().0 };
    let (turns, mirrored) = workspace.find_turns(&motion);
    workspace.force_sums.fill(0.0);
    workspace.stiffness_sums.fill(0.0);
    let span = if mirrored { PI } else { 2.0 * PI };
    let mut walk = Walk {
        contact,
        motion,
        wanted: Wanted { force: force.is_some(), stiffness: jacobian.is_some() },
        fours_per_radian: workspace.samples as f64 / (8.0 * PI),
        energy: dissipated.is_some().then(|| Dissipation::new(contact)),
        virgin: Virgin::NEW,
        depth: 0,
        branch: Branch::VIRGIN,
        now: Response { force: 0.0, stiffness: 0.0 },
    };
    if turns == 0 {
        walk.rest(workspace, span);
    } else {
        walk.through_period(workspace, turns, span, mirrored, &mut jacobian);
    }
    if let (Some(dissipated), Some(energy)) = (dissipated, walk.energy) {
        *dissipated = if mirrored { 2.0 * energy.total() } else { energy.total() };
    }
    if let Some(force) = force {
        force.iter_mut().zip(workspace.force_sums.iter()).for_each(|(force, sum)| *force = *sum);
        scale(force, 1.0 / span);
        if mirrored {
            clear_other_parity(1, force);
        }
    }
    if let Some(jacobian) = jacobian {
        add_products(jacobian, workspace.harmonics, |order| of_order(workspace.stiffness_sums, order));
        for (c, column) in jacobian.chunks_exact_mut(n.max(1)).enumerate() {
            scale(column, 1.0 / span);
            if mirrored {
                clear_other_parity(c, column);
            }
        }
    }
    Ok(())
}

/// Cosine and sine sum of an order.
#[inline(always)]
fn of_order(sums: &[f64], order: usize) -> (f64, f64) {
    let at = |place: usize| sums.get(place).copied().unwrap_or(0.0);
    if order == 0 { (at(0), 0.0) } else { (at(2 * order - 1), at(2 * order)) }
}

/// A periodic displacement.
#[derive(Debug, Clone, Copy)]
struct Motion<'a> {
    constant: f64,
    pairs: &'a [[f64; 2]],
}

impl Motion<'_> {
    /// The displacement and its first three derivatives.
    fn at(&self, t: f64) -> [f64; 4] {
        let (sine, cosine) = t.sin_cos();
        let (mut c, mut s, mut k) = (cosine, sine, 1.0);
        let [mut u, mut rate, mut second, mut third] = [self.constant, 0.0, 0.0, 0.0];
        for [a, b] in self.pairs {
            let (along, across) = (a * c + b * s, k * (b * c - a * s));
            u += along;
            rate += across;
            second -= k * k * along;
            third -= k * k * across;
            (c, s) = (c * cosine - s * sine, s * cosine + c * sine);
            k += 1.0;
        }
        [u, rate, second, third]
    }
}

/// φ of an instant.
#[inline(always)]
fn fill_phi(row: &mut [f64], t: f64) {
    let (sine, cosine) = t.sin_cos();
    let (mut c, mut s) = (cosine, sine);
    let Some((constant, pairs)) = row.split_first_mut() else { return };
    *constant = 1.0;
    for pair in pairs.as_chunks_mut::<2>().0 {
        *pair = [c, s];
        (c, s) = (c * cosine - s * sine, s * cosine + c * sine);
    }
}

/// ∫ φ dt from one instant to another.
#[inline(always)]
fn fill_integrals(row: &mut [f64], from: f64, to: f64) {
    let ((sine0, cosine0), (sine1, cosine1)) = (from.sin_cos(), to.sin_cos());
    let (mut c0, mut s0, mut c1, mut s1, mut k) = (cosine0, sine0, cosine1, sine1, 1.0);
    let Some((constant, pairs)) = row.split_first_mut() else { return };
    *constant = to - from;
    for pair in pairs.as_chunks_mut::<2>().0 {
        *pair = [(s1 - s0) / k, (c0 - c1) / k];
        (c0, s0) = (c0 * cosine0 - s0 * sine0, s0 * cosine0 + c0 * sine0);
        (c1, s1) = (c1 * cosine1 - s1 * sine1, s1 * cosine1 + c1 * sine1);
        k += 1.0;
    }
}

/// Where a function that is negative at `low` and not at `high` has its root: Newton's method, and bisection where that
/// leaves the bracket. `evaluate` gives value and slope.
fn root(low: f64, high: f64, start: f64, evaluate: impl Fn(f64) -> (f64, f64)) -> f64 {
    let (mut low, mut high, mut at) = (low, high, start);
    for _ in 0..80 {
        let (value, slope) = evaluate(at);
        if value < 0.0 {
            low = at;
        } else {
            high = at;
        }
        // Where Newton's step would be longer than any bracket, no division by what may be zero.
        let slope = if slope > 0.0 { slope } else { 0.0 };
        let newton = at - value / slope.max(0.01 * value.abs()).max(f64::MIN_POSITIVE);
        let inside = newton >= low && newton <= high;
        let next = if inside { newton } else { 0.5 * (low + high) };
        let step = (next - at).abs();
        at = next;
        // Newton's next step would be about as long as this one squared.
        if (inside && step < 1e-9) || high - low < 1e-15 {
            break;
        }
    }
    at
}

impl Workspace<'_> {
    /// Finds the turning points in the order of time: their number, and whether they are those of half a period, because there
    /// are odd harmonics only.
    #[inline(always)]
    fn find_turns(&mut self, motion: &Motion) -> (usize, bool) {
        let Some((constant, pairs)) = self.row.split_first_mut() else { return (0, false) };
        *constant = 0.0;
        let mut k = 1.0;
        for (pair, &[a, b]) in pairs.as_chunks_mut::<2>().0.iter_mut().zip(motion.pairs) {
            *pair = [k * b, -k * a];
            k += 1.0;
        }
        let half = self.rate.len() / 2;
        let mirrored = sample(self.columns, half, self.rate, self.row) && motion.constant == 0.0;
        let points = if mirrored { half } else { 2 * half };
        // A rate of 0 counts as positive. At the seam of a mirrored half it is minus itself on the other side: with a rate of
        // exactly 0 there, the other half's has to count as negative where this half ends positive.
        if mirrored
            && self.rate.first() == Some(&0.0)
            && half.checked_sub(1).and_then(|last| self.rate.get(last)).is_some_and(|rate| *rate > 0.0)
            && let Some(opposite) = self.rate.get_mut(half)
        {
            *opposite = -f64::MIN_POSITIVE;
        }
        let step = PI / half.max(1) as f64;
        let mut turns = Turns { places: self.turns, count: 0, motion };
        let (Some(&last), Some(&first)) = (self.rate.last(), self.rate.first()) else { return (0, false) };
        let nexts = self.rate.iter().skip(1).chain([&first]);
        let mut before = last;
        for (j, (&here, &next)) in self.rate.iter().zip(nexts).enumerate().take(points) {
            let t = j as f64 * step;
            let sign = if here < 0.0 { -1.0 } else { 1.0 };
            if (next < 0.0) != (here < 0.0) {
                let part = here.abs() / (here.abs() + next.abs()).max(f64::MIN_POSITIVE);
                turns.add(t, t + step, t + part * step, -sign);
            } else if (before < 0.0) == (here < 0.0) {
                let (left, middle, right) = (before.abs(), here.abs(), next.abs());
                // A parabola through the three dips below the middle one by an eighth of this bend at most.
                let bend = left + right - 2.0 * middle;
                if middle < left && middle <= right && middle <= 0.25 * bend {
                    turns.add_two(t - step, t, t + step, sign);
                }
            }
            before = here;
        }
        (turns.count, mirrored)
    }

    #[inline(always)]
    fn turn(&self, number: usize) -> (f64, f64) {
        match self.turns.as_chunks::<2>().0.get(number) {
            Some(&[t, displacement]) => (t, displacement),
            None => (0.0, 0.0),
        }
    }

    /// cos and sin of all orders up to `orders` at the nodes of a panel, and the displacement there.
    #[inline(always)]
    fn fill_waves(&mut self, motion: &Motion, orders: usize, times: &[[f64; 4]], displacement: &mut Nodes) {
        let rows = self.waves.as_chunks_mut::<4>().0.as_chunks_mut::<{ 2 * GAUSS_FOURS }>().0;
        for (four, (times, displacement)) in times.iter().zip(displacement.iter_mut()).enumerate() {
            let (mut cosine, mut sine) = ([0.0; 4], [0.0; 4]);
            for k in 0..4 {
                (sine[k], cosine[k]) = times[k].sin_cos();
            }
            let (mut c, mut s) = (cosine, sine);
            let mut u = [motion.constant; 4];
            let mut pairs = motion.pairs.iter();
            for row in rows.iter_mut().take(orders) {
                let (cosines, sines) = row.split_at_mut(GAUSS_FOURS);
                if let (Some(cosines), Some(sines)) = (cosines.get_mut(four), sines.get_mut(four)) {
                    (*cosines, *sines) = (c, s);
                }
                if let Some(&[a, b]) = pairs.next() {
                    for k in 0..4 {
                        u[k] += a * c[k] + b * s[k];
                    }
                }
                for k in 0..4 {
                    (c[k], s[k]) = (c[k] * cosine[k] - s[k] * sine[k], s[k] * cosine[k] + c[k] * sine[k]);
                }
            }
            *displacement = u;
        }
    }
}

/// Adds to Fourier sums the values at the nodes of a panel.
#[inline(always)]
fn add_sums(sums: &mut [f64], waves: &[f64], values: &[[f64; 4]]) {
    let total = |four: [f64; 4]| {
        let [one, two, three, four] = four;
        (one + two) + (three + four)
    };
    let Some((constant, pairs)) = sums.split_first_mut() else { return };
    let mut sum = [0.0; 4];
    for value in values {
        for k in 0..4 {
            sum[k] += value[k];
        }
    }
    *constant += total(sum);
    let rows = waves.as_chunks::<4>().0.as_chunks::<{ 2 * GAUSS_FOURS }>().0;
    for ([by_cosine, by_sine], row) in pairs.as_chunks_mut::<2>().0.iter_mut().zip(rows) {
        let (cosines, sines) = row.split_at(GAUSS_FOURS);
        let (mut c, mut s) = ([0.0; 4], [0.0; 4]);
        for ((value, cosine), sine) in values.iter().zip(cosines).zip(sines) {
            for k in 0..4 {
                c[k] += value[k] * cosine[k];
                s[k] += value[k] * sine[k];
            }
        }
        *by_cosine += total(c);
        *by_sine += total(s);
    }
}

/// Turning points as they are found.
struct Turns<'a, 'm> {
    places: &'a mut [f64],
    count: usize,
    motion: &'m Motion<'m>,
}

impl Turns<'_, '_> {
    /// One between two instants, where the rate times `sign` rises through zero.
    fn add(&mut self, low: f64, high: f64, start: f64, sign: f64) {
        let t = root(low, high, start, |t| {
            let [_, rate, second, _] = self.motion.at(t);
            (sign * rate, sign * second)
        });
        let [displacement, ..] = self.motion.at(t);
        if let Some(place) = self.places.as_chunks_mut::<2>().0.get_mut(self.count) {
            *place = [t, displacement];
            self.count += 1;
        }
    }

    /// Two of them, if the rate times `sign`, positive at `low` and `high`, dips below zero between them.
    #[cold]
    fn add_two(&mut self, low: f64, middle: f64, high: f64, sign: f64) {
        let bottom = root(low, high, middle, |t| {
            let [_, _, second, third] = self.motion.at(t);
            (sign * second, sign * third)
        });
        let [_, rate, ..] = self.motion.at(bottom);
        if sign * rate < 0.0 {
            self.add(low, bottom, 0.5 * (low + bottom), -sign);
            self.add(bottom, high, 0.5 * (bottom + high), sign);
        }
    }
}

/// What is needed.
#[derive(Debug, Clone, Copy)]
struct Wanted {
    force: bool,
    stiffness: bool,
}

/// A point of the motion.
#[derive(Debug, Clone, Copy)]
struct Point {
    t: f64,
    displacement: f64,
}

/// The walk through the steady state.
struct Walk<'c> {
    contact: &'c Contact,
    motion: Motion<'c>,
    wanted: Wanted,
    fours_per_radian: f64,
    energy: Option<Dissipation<'c>>,
    virgin: Virgin,
    depth: usize,
    branch: Branch,
    /// At the end of what was walked.
    now: Response,
}

impl Walk<'_> {
    /// A displacement that does not move.
    #[inline(always)]
    fn rest(&mut self, workspace: &mut Workspace, span: f64) {
        self.begin(self.motion.constant);
        if let (Some(force), Some(stiffness)) = (workspace.force_sums.first_mut(), workspace.stiffness_sums.first_mut())
        {
            (*force, *stiffness) = (span * self.now.force, span * self.now.stiffness);
        }
    }

    /// The virgin curve at the farthest turning point.
    #[inline(always)]
    fn begin(&mut self, displacement: f64) {
        let slip = self.contact.slip_displacement;
        let direction = if displacement < 0.0 { -1.0 } else { 1.0 };
        let slides = displacement.abs() > slip;
        self.branch = Branch { slides, ..Branch::newest(&[], 0, self.virgin.origin, direction, slip) };
        if slides {
            self.virgin = Virgin { origin: displacement - direction * slip, slid: direction };
        }
        self.now = self.response(displacement);
    }

    #[inline(always)]
    fn response(&self, displacement: f64) -> Response {
        if self.branch.slides {
            return Response { force: self.branch.direction * self.contact.slip_force, stiffness: 0.0 };
        }
        self.branch.responder(self.contact).at(displacement)
    }

    /// From the farthest turning point through a period, or half of it.
    #[inline(always)]
    fn through_period(
        &mut self,
        workspace: &mut Workspace,
        turns: usize,
        span: f64,
        mirrored: bool,
        jacobian: &mut Option<&mut [f64]>,
    ) {
        let (mut first, mut farthest) = (0, -1.0);
        for number in 0..turns {
            let (_, displacement) = workspace.turn(number);
            if displacement.abs() > farthest {
                (first, farthest) = (number, displacement.abs());
            }
        }
        let (t, displacement) = workspace.turn(first);
        let mut from = Point { t, displacement };
        self.begin(displacement);
        for number in (first + 1..turns).chain(0..=first) {
            let (t, displacement) = workspace.turn(number);
            let to = if number > first {
                Point { t, displacement }
            } else {
                Point { t: t + span, displacement: if mirrored { -displacement } else { displacement } }
            };
            self.swing(workspace, from, to, jacobian);
            from = to;
        }
    }

    /// From one turning point to the next: along one branch, or along those before it once it has closed its loop.
    #[inline(always)]
    fn swing(&mut self, workspace: &mut Workspace, from: Point, to: Point, jacobian: &mut Option<&mut [f64]>) {
        let slip = self.contact.slip_displacement;
        let direction = if to.displacement == from.displacement {
            self.branch.direction
        } else if to.displacement < from.displacement {
            -1.0
        } else {
            1.0
        };
        if direction != self.branch.direction && self.remember(workspace, from) {
            self.branch = Branch::newest(workspace.reversals, self.depth, self.virgin.origin, direction, slip);
        }
        let mut at = from;
        loop {
            let end = self.branch.end;
            if self.branch.slides || direction * (to.displacement - end) < 0.0 {
                self.piece(workspace, at, to, false, jacobian);
                break;
            }
            let t = if to.displacement == end { to.t } else { self.crossing(at, from, to, end) };
            let crossing = Point { t, displacement: end };
            // Where the loop is closed the branch before it goes on; none is before the virgin curve.
            let depth = self.depth.saturating_sub(2);
            let next = Branch::newest(workspace.reversals, depth, self.virgin.origin, direction, slip);
            let slides = depth == 0 && (self.virgin.slid != 0.0 || !self.branch.reversed);
            self.piece(workspace, at, crossing, slides, jacobian);
            (self.depth, self.branch) = (depth, Branch { slides, ..next });
            at = crossing;
        }
        self.now = self.response(to.displacement);
    }

    /// When a swing crosses a displacement, not before it is `at`.
    fn crossing(&self, at: Point, from: Point, to: Point, level: f64) -> f64 {
        let way = (level - from.displacement).abs();
        let part = way / (to.displacement - from.displacement).abs().max(way).max(f64::MIN_POSITIVE);
        // As if the swing were half a wave.
        let start = from.t + (to.t - from.t) * ((1.0 - 2.0 * part).acos() / PI);
        let sign = if to.displacement < from.displacement { -1.0 } else { 1.0 };
        root(at.t, to.t, if start < at.t { at.t } else { start }, |t| {
            let [u, rate, ..] = self.motion.at(t);
            (sign * (u - level), sign * rate)
        })
    }

    /// Keeps a point as the newest reversal; whether there was room for it.
    #[inline(always)]
    fn remember(&mut self, workspace: &mut Workspace, at: Point) -> bool {
        let n = workspace.coefficients();
        let Some(place) = workspace.reversals.as_chunks_mut::<2>().0.get_mut(self.depth) else { return false };
        *place = [at.displacement, self.now.force];
        if self.wanted.stiffness
            && let Some((older, newer)) = workspace.gradients.split_at_mut_checked(2 * n * self.depth)
            && let Some((phi, gradient)) = newer.get_mut(..2 * n).and_then(|row| row.split_at_mut_checked(n))
        {
            let k = self.now.stiffness;
            fill_phi(phi, at.t);
            gradient.iter_mut().zip(phi.iter()).for_each(|(gradient, phi)| *gradient = k * phi);
            if self.branch.reversed
                && let Some((from, before)) = older.chunks_exact((2 * n).max(1)).last().map(|row| row.split_at(n))
            {
                for ((gradient, from), before) in gradient.iter_mut().zip(from).zip(before) {
                    *gradient += before - k * from;
                }
            }
        }
        self.depth += 1;
        true
    }

    /// One piece of a branch: its part of the integrals, of the Jacobian beyond `∫ k φ ⊗ φ`, and of the energy. `to_slip`: it
    /// ends where gross slip starts.
    #[inline(always)]
    fn piece(
        &mut self,
        workspace: &mut Workspace,
        from: Point,
        to: Point,
        to_slip: bool,
        jacobian: &mut Option<&mut [f64]>,
    ) {
        self.account_for(from, to);
        let Wanted { force, stiffness } = self.wanted;
        if to.t <= from.t || !(force || stiffness) {
            return;
        }
        if self.branch.slides {
            if force {
                fill_integrals(workspace.integrals, from.t, to.t);
                let limit = self.branch.direction * self.contact.slip_force;
                let sums = workspace.force_sums.iter_mut();
                sums.zip(workspace.integrals.iter()).for_each(|(sum, integral)| *sum += limit * integral);
            }
            return;
        }
        self.integrate(workspace, from.t, to.t, to_slip);
        let Some(jacobian) = jacobian else { return };
        let sums = workspace.stiffness_sums.iter_mut();
        sums.zip(workspace.piece_sums.iter()).for_each(|(sum, piece)| *sum += piece);
        let n = workspace.coefficients();
        let rows = workspace.gradients.chunks_exact((2 * n).max(1)).nth(self.depth.wrapping_sub(1));
        if let Some((phi, gradient)) = rows.and_then(|row| row.split_at_checked(n))
            && self.branch.reversed
        {
            fill_integrals(workspace.integrals, from.t, to.t);
            for ((column, phi), gradient) in jacobian.chunks_exact_mut(n.max(1)).zip(phi).zip(gradient) {
                let rows = workspace.integrals.iter().zip(workspace.piece_sums.iter());
                for (j, (integral, weighted)) in column.iter_mut().zip(rows) {
                    *j += gradient * integral - phi * weighted;
                }
            }
        }
    }

    /// The energy of a piece; gross slip carries the virgin curve along.
    #[inline(always)]
    fn account_for(&mut self, from: Point, to: Point) {
        let slip = self.contact.slip_displacement;
        let Branch { slides, direction, halves, .. } = self.branch;
        if slides {
            self.virgin = Virgin { origin: to.displacement - direction * slip, slid: direction };
        }
        if let Some(energy) = &mut self.energy {
            let way = |point: Point| self.branch.way(slip, point.displacement);
            energy.add(&if slides {
                Stretch { halves: 1.0, from: 0.0, to: 0.0, slipped: (to.displacement - from.displacement).abs() }
            } else {
                Stretch { halves, from: way(from), to: way(to), slipped: 0.0 }
            });
        }
    }

    /// Fourier sums over a piece: of the force, and of the stiffness into those of the piece.
    #[inline(always)]
    fn integrate(&self, workspace: &mut Workspace, from: f64, to: f64, to_slip: bool) {
        let Wanted { force, stiffness } = self.wanted;
        let length = to - from;
        // Those of the cube root are three times as far apart at the piece's start.
        let (denser, least) = if to_slip { (2.0, LEAST_FOURS_TO_SLIP) } else { (1.0, LEAST_FOURS) };
        let fours = ((denser * length * self.fours_per_radian + 0.5) as usize).max(least);
        let panels = fours.div_ceil(GAUSS_FOURS);
        let rule = gauss_rule(fours.div_ceil(panels.max(1)));
        let share = 1.0 / panels as f64;
        let responder = self.branch.responder(self.contact);
        let orders = if stiffness { 2 * workspace.harmonics } else { workspace.harmonics };
        if stiffness {
            workspace.piece_sums.fill(0.0);
        }
        for panel in 0..panels {
            let mut times: Nodes = [[0.0; 4]; _];
            let mut weights: Nodes = [[0.0; 4]; _];
            for ((times, weights), [nodes, rule_weights]) in times.iter_mut().zip(weights.iter_mut()).zip(rule) {
                for k in 0..4 {
                    let s = (panel as f64 + nodes[k]) * share;
                    let weight = length * share * rule_weights[k];
                    if to_slip {
                        let left = 1.0 - s;
                        times[k] = to - length * (left * left * left);
                        weights[k] = 3.0 * left * left * weight;
                    } else {
                        times[k] = from + length * s;
                        weights[k] = weight;
                    }
                }
            }
            let times = times.get(..rule.len()).unwrap_or(&[]);
            let mut forces: Nodes = [[0.0; 4]; _];
            let mut stiffnesses = weights;
            let mut displacement: Nodes = [[0.0; 4]; _];
            workspace.fill_waves(&self.motion, orders, times, &mut displacement);
            let places = displacement.iter().zip(&weights).take(rule.len());
            for ((forces, stiffnesses), (displacement, weights)) in
                forces.iter_mut().zip(stiffnesses.iter_mut()).zip(places)
            {
                for k in 0..4 {
                    let response = responder.at(displacement[k]);
                    forces[k] = weights[k] * response.force;
                    stiffnesses[k] = weights[k] * response.stiffness;
                }
            }
            if force {
                let values = forces.get(..rule.len()).unwrap_or(&[]);
                add_sums(workspace.force_sums, workspace.waves, values);
            }
            if stiffness {
                let values = stiffnesses.get(..rule.len()).unwrap_or(&[]);
                add_sums(workspace.piece_sums, workspace.waves, values);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::tests::{FLATS, contact, ellipse};
    use crate::harmonic_force as equidistant;
    use std::vec;
    use std::vec::Vec;

    type All = (Vec<f64>, Vec<f64>, f64);

    fn all(contact: &Contact, samples: usize, displacement: &[f64]) -> All {
        let n = displacement.len();
        let mut memory = vec![0.0; workspace_length(n / 2, samples)];
        workspace_init(n / 2, samples, &mut memory).unwrap();
        let (mut force, mut jacobian, mut energy) = (vec![f64::NAN; n], vec![f64::NAN; n * n], f64::NAN);
        let output =
            HarmonicOutput { force: Some(&mut force), jacobian: Some(&mut jacobian), dissipated: Some(&mut energy) };
        harmonic_force(contact, &mut Workspace::new(&mut memory).unwrap(), displacement, output).unwrap();
        (force, jacobian, energy)
    }

    fn all_equidistant(contact: &Contact, samples: usize, displacement: &[f64]) -> All {
        let n = displacement.len();
        let mut memory = vec![0.0; equidistant::workspace_length(n / 2, samples)];
        equidistant::workspace_init(n / 2, samples, &mut memory).unwrap();
        let (mut force, mut jacobian, mut energy) = (vec![f64::NAN; n], vec![f64::NAN; n * n], f64::NAN);
        let output =
            HarmonicOutput { force: Some(&mut force), jacobian: Some(&mut jacobian), dissipated: Some(&mut energy) };
        let mut workspace = equidistant::Workspace::new(&mut memory).unwrap();
        equidistant::harmonic_force(contact, &mut workspace, displacement, output).unwrap();
        (force, jacobian, energy)
    }

    const SHAPE: [f64; 7] = [0.2, 0.5, -0.1, 0.05, 0.3, -0.35, 0.2];
    const ODD: [f64; 7] = [0.0, 0.8, 0.1, 0.0, 0.0, -0.2, 0.3];
    const FIVE: [f64; 11] = [0.1, 0.7, 0.0, 0.1, 0.3, -0.2, 0.2, 0.15, -0.1, 0.1, 0.2];

    fn scaled(contact: &Contact, shape: &[f64], size: f64) -> Vec<f64> {
        shape.iter().map(|c| c * size * contact.slip_displacement).collect()
    }

    fn off(one: &[f64], two: &[f64]) -> f64 {
        one.iter().zip(two).fold(0.0, |most, (one, two)| f64::max(most, (one - two).abs()))
    }

    fn contacts() -> impl Iterator<Item = Contact> {
        FLATS.map(contact).into_iter().chain([ellipse(1e-4, 2e-4)])
    }

    /// A turn of all waves by an angle.
    fn turn(vector: &[f64], by: f64) -> Vec<f64> {
        let mut turned = vector.to_vec();
        for k in 1..=vector.len() / 2 {
            let (sine, cosine) = (k as f64 * by).sin_cos();
            let (a, b) = (vector[2 * k - 1], vector[2 * k]);
            turned[2 * k - 1] = cosine * a + sine * b;
            turned[2 * k] = cosine * b - sine * a;
        }
        turned
    }

    #[test]
    fn memory_that_is_no_workspace_is_refused() {
        let mut good = vec![0.0; workspace_length(3, 16)];
        workspace_init(3, 16, &mut good).unwrap();
        for (place, value) in [(0, 0.0), (1, 0.0), (1, 2.5), (1, f64::NAN), (1, 8.0), (2, 6.0), (2, f64::INFINITY)] {
            let mut bad = good.clone();
            bad[place] = value;
            assert_eq!(Workspace::new(&mut bad).map(|_| ()), Err(Error::BadWorkspace), "{place} {value}");
        }
        let tables = Layout::new(3, 16).unwrap().tables();
        for (place, bit) in (0..HEADER + tables).flat_map(|place| (0..64).map(move |bit| (place, bit))) {
            let mut bad = good.clone();
            bad[place] = f64::from_bits(bad[place].to_bits() ^ (1 << bit));
            assert_eq!(Workspace::new(&mut bad).map(|_| ()), Err(Error::BadWorkspace), "{place} {bit}");
        }
        assert_eq!(workspace_extent(good.first_chunk().unwrap()), Some(Ok(good.len())));
        good.pop();
        assert_eq!(Workspace::new(&mut good).map(|_| ()), Err(Error::BadWorkspace));
        assert_eq!(Workspace::new(&mut []).map(|_| ()), Err(Error::BadWorkspace));
        // Neither rule takes the other's workspace.
        let mut other = vec![0.0; equidistant::workspace_length(3, 16)];
        equidistant::workspace_init(3, 16, &mut other).unwrap();
        assert_eq!(workspace_extent(other.first_chunk().unwrap()), None);
        assert_eq!(Workspace::new(&mut other).map(|_| ()), Err(Error::BadWorkspace));
        for (harmonics, samples, error) in [
            (0, 16, Error::BadHarmonics),
            (1 << 25, 1 << 26, Error::BadHarmonics),
            (3, 6, Error::BadSamples),
            (3, 1 << 25, Error::BadSamples),
        ] {
            assert_eq!(workspace_length(harmonics, samples), 0);
            assert_eq!(workspace_init(harmonics, samples, &mut good), Err(error));
        }
        assert_eq!(workspace_init(3, 16, &mut good), Err(Error::WorkspaceTooShort));
    }

    #[test]
    fn one_harmonic_is_the_complex_stiffness() {
        for contact in contacts() {
            for (part, bound) in
                [(1e-6, 1e-14), (0.3, 1e-14), (0.8, 1e-13), (0.95, 1e-12), (1.1, 1e-12), (3.0, 1e-12), (1e3, 1e-12)]
            {
                let amplitude = part * contact.slip_displacement;
                let exact = contact.complex_stiffness(amplitude).unwrap();
                let size = exact.real().hypot(exact.imaginary());
                for phase in [0.0, 0.3, 2.0, 4.0] {
                    let (sine, cosine) = f64::sin_cos(phase);
                    let (force, _, energy) = all(&contact, 64, &[0.0, amplitude * cosine, amplitude * sine]);
                    let real = (cosine * force[1] + sine * force[2]) / amplitude;
                    let imaginary = (sine * force[1] - cosine * force[2]) / amplitude;
                    let off = (real - exact.real()).hypot(imaginary - exact.imaginary());
                    assert!(off < bound * size, "{part} {phase}: {:e}", off / size);
                    // Small loops are differences of forces to the accuracy of these.
                    assert!((energy / exact.dissipated() - 1.0).abs() < 1e-12, "{part} {energy}");
                }
            }
        }
    }

    /// Three and five harmonics, odd ones alone, one; nested loops in microslip up to gross slip for most of the time.
    #[test]
    fn few_nodes_beat_many_samples() {
        for contact in contacts() {
            for (shape, size) in [&SHAPE[..], &ODD, &FIVE, &[0.0, 1.0, 0.3]]
                .into_iter()
                .flat_map(|shape| [0.3, 0.9, 1.2, 4.0].map(|size| (shape, size)))
            {
                let motion = scaled(&contact, shape, size);
                let reference = all(&contact, 4096, &motion);
                let (one, two) = (all(&contact, 64, &motion), all_equidistant(&contact, 64, &motion));
                let (force, stiffness) = (contact.slip_force, contact.initial_stiffness);
                // Samples converge to the same, by their square.
                let samples = all_equidistant(&contact, 1 << 16, &motion);
                assert!(
                    off(&reference.0, &samples.0) < 1e-8 * force && off(&reference.1, &samples.1) < 1e-4 * stiffness
                );
                assert!((samples.2 / reference.2 - 1.0).abs() < 3e-8);
                assert!(off(&one.0, &reference.0) < 1e-8 * force, "{:e}", off(&one.0, &reference.0) / force);
                let jacobian = off(&one.1, &reference.1) / stiffness;
                assert!(jacobian < 1e-7, "{jacobian:e}");
                assert!((one.2 / reference.2 - 1.0).abs() < 1e-14, "{} {}", one.2, reference.2);
                let (error, samples) = (off(&one.0, &reference.0), off(&two.0, &reference.0));
                assert!(100.0 * error < samples + 1e-13 * force, "{shape:?} {size}: {error} {samples}");
            }
        }
    }

    #[test]
    fn the_jacobian_is_the_derivative() {
        for contact in contacts() {
            for (shape, size) in
                [&SHAPE[..], &ODD, &FIVE].into_iter().flat_map(|shape| [0.3, 0.9, 1.2, 4.0].map(|size| (shape, size)))
            {
                let motion = scaled(&contact, shape, size);
                let n = motion.len();
                let (_, jacobian, _) = all(&contact, 64, &motion);
                for j in 0..n {
                    let moved = |step: f64| {
                        let mut moved = motion.clone();
                        moved[j] += step;
                        all(&contact, 64, &moved).0
                    };
                    // Where both turning points are equally far, the second derivative jumps: an error of one order in h.
                    let h = 1e-7 * contact.slip_displacement;
                    let (low, high) = (moved(-h), moved(h));
                    for i in 0..n {
                        let off =
                            (jacobian[i + n * j] - (high[i] - low[i]) / (2.0 * h)).abs() / contact.initial_stiffness;
                        assert!(off < 2e-7, "{size} {i} {j}: {off:e}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_shift_in_time_shifts_force_and_jacobian() {
        for (contact, size) in contacts().flat_map(|contact| [(contact, 0.5), (contact, 0.9), (contact, 2.5)]) {
            for shape in [&SHAPE[..], &ODD, &FIVE] {
                let displacement = scaled(&contact, shape, size);
                let n = shape.len();
                let (force, jacobian, energy) = all(&contact, 128, &displacement);
                for by in [1e-9, 0.7, PI, 4.4] {
                    let (shifted, its_jacobian, same) = all(&contact, 128, &turn(&displacement, by));
                    // Near gross slip a unit of rounding of the displacement is worth many of the energy.
                    assert!((same / energy - 1.0).abs() < 1e-12, "{by}");
                    let away = off(&shifted, &turn(&force, by)) / contact.slip_force;
                    assert!(away < 1e-13, "{by} {away:e}");
                    for j in 0..n {
                        let unit: Vec<f64> = (0..n).map(|i| if i == j { 1.0 } else { 0.0 }).collect();
                        let times = |matrix: &[f64], vector: &[f64]| -> Vec<f64> {
                            (0..n).map(|i| (0..n).map(|k| matrix[i + n * k] * vector[k]).sum()).collect()
                        };
                        let one = times(&its_jacobian, &turn(&unit, by));
                        let two = turn(&times(&jacobian, &unit), by);
                        assert!(
                            off(&one, &two) < 1e-11 * contact.initial_stiffness,
                            "{by} {j} {:e}",
                            off(&one, &two) / contact.initial_stiffness
                        );
                    }
                }
                let minus = |vector: &[f64]| -> Vec<f64> { vector.iter().map(|value| -value).collect() };
                let (odd, its_jacobian, same) = all(&contact, 128, &minus(&displacement));
                assert_eq!((odd, same), (minus(&force), energy));
                assert_eq!(its_jacobian, jacobian);
            }
        }
    }

    #[test]
    fn rest_and_motions_that_are_flat_where_they_turn() {
        for contact in contacts() {
            let slip = contact.slip_displacement;
            for constant in [0.0, 0.4 * slip, -0.4 * slip, 2.0 * slip, -1e100] {
                let (force, jacobian, energy) = all(&contact, 16, &[constant, 0.0, 0.0, 0.0, 0.0]);
                let point = contact.curve_at_displacement(constant).unwrap();
                assert!((force[0] - point.force()).abs() < 1e-15 * contact.slip_force && energy == 0.0);
                assert!(force.iter().skip(1).all(|&force| force == 0.0));
                let stiffness = point.stiffness();
                for (place, value) in jacobian.iter().enumerate() {
                    let expected = if place % 6 == 0 { stiffness } else { 0.0 };
                    assert!((value - expected).abs() < 1e-14 * contact.initial_stiffness, "{place}");
                }
            }
            // cos t - cos(2t)/4 has its turn where three derivatives vanish; a little less or more makes one turn or three.
            for (part, size) in [-1e-3, -1e-9, -1e-17, 0.0, 1e-17, 1e-9, 1e-3]
                .into_iter()
                .flat_map(|part| [0.5, 1.0, 3.0].map(|size| (part, size * slip)))
            {
                let motion = [0.0, size, 0.0, -(0.25 + part) * size, 0.0];
                let (one, two) = (all(&contact, 128, &motion), all(&contact, 4096, &motion));
                assert!(off(&one.0, &two.0) < 1e-9 * contact.slip_force, "{part} {:e}", off(&one.0, &two.0));
                assert!((one.2 / two.2 - 1.0).abs() < 1e-13);
                let turned = all(&contact, 128, &turn(&motion, 0.77));
                // Instants known to the cube root of rounding.
                assert!(off(&turned.0, &turn(&one.0, 0.77)) < 1e-9 * contact.slip_force);
            }
        }
    }

    /// A cosine that starts upwards turns exactly at the seam of the half that is looked at.
    #[test]
    fn cosines_turn_where_the_period_begins() {
        for contact in contacts() {
            for size in [0.3, 2.0].map(|part| part * contact.slip_displacement) {
                let shapes = [[1.0, 0.0, 0.0], [1.0, 0.0, 0.05], [0.0, 0.0, 1.0], [1.0, 0.0, -0.3]];
                for shape in shapes {
                    let motion = |sign: f64| {
                        let [one, two, three] = shape.map(|part| sign * size * part);
                        [0.0, one, 0.0, two, 0.0, three, 0.0]
                    };
                    let (up, down) = (all(&contact, 64, &motion(-1.0)), all(&contact, 64, &motion(1.0)));
                    for (one, two) in up.0.iter().zip(&down.0) {
                        assert!((one + two).abs() < 1e-12 * contact.slip_force, "{shape:?} {one} {two}");
                    }
                    for (one, two) in up.1.iter().zip(&down.1) {
                        assert!((one - two).abs() < 1e-9 * contact.initial_stiffness, "{shape:?}");
                    }
                    assert!(down.2 > 0.0 && (up.2 / down.2 - 1.0).abs() < 1e-12, "{shape:?}");
                }
            }
        }
    }

    /// Two turning points between neighbours of the grid, which sees the same sign on both sides.
    #[test]
    fn turns_between_the_points_of_the_grid_are_found() {
        let contact = contact(50e-6);
        // Its rate cos t + 1.001 cos 2t dips through zero for 0.05 about t = π; the grid's step is 0.1.
        let size = 0.5 * contact.slip_displacement;
        let motion = |by: f64| turn(&[0.0, 0.0, size, 0.0, 0.5005 * size, 0.0, 0.0, 0.0, 0.0], by);
        for by in [0.0, 0.02, 0.05, 0.1, 0.5] {
            let mut memory = vec![0.0; workspace_length(4, 9)];
            workspace_init(4, 9, &mut memory).unwrap();
            let mut workspace = Workspace::new(&mut memory).unwrap();
            let coefficients = motion(by);
            let walked = Motion { constant: 0.0, pairs: coefficients[1..].as_chunks().0 };
            assert_eq!(workspace.find_turns(&walked), (4, false), "{by}");
        }
    }

    /// Turning points at the top, all equally far to rounding: what comes after the first of them has not turned.
    #[test]
    fn a_flat_top_is_where_the_walk_begins() {
        let contact = contact(50e-6);
        let size = 0.3 * contact.slip_displacement;
        for (distance, by) in (6..14).flat_map(|tenths| [0.0, 1.1, 2.2].map(|by| (f64::from(tenths) / 10.0, by))) {
            // cos t - (1/9 + part) cos 3t turns three times within so many steps of the grid, and ε⁴ is below rounding.
            let step = 2.0 * PI / f64::from(1 << 17);
            let part = (distance * step) * (distance * step) / 6.75;
            let motion = turn(&[0.0, size, 0.0, 0.0, 0.0, -(1.0 / 9.0 + part) * size, 0.0], by);
            let (one, two) = (all(&contact, 1 << 17, &motion), all(&contact, 256, &motion));
            assert!(off(&one.0, &two.0) < 1e-9 * contact.slip_force, "{distance} {by}");
            assert!((one.2 / two.2 - 1.0).abs() < 1e-12, "{distance} {by}: {} {}", one.2, two.2);
        }
    }

    #[test]
    fn a_large_motion_meets_a_square_wave() {
        let contact = contact(0.0);
        let huge = 1e9 * contact.slip_displacement;
        let (force, _, energy) = all(&contact, 16, &[0.0, 0.0, huge, 0.0, 0.0, 0.0, 0.0]);
        // What sticks does so for 1e-4 of the period.
        assert!((force[1] / contact.slip_force * PI / 4.0 - 1.0).abs() < 1e-4);
        assert!((energy / (4.0 * contact.slip_force * huge) - 1.0).abs() < 1e-8);
        let square: f64 = force.iter().map(|force| force * force).sum();
        assert!((square.sqrt() / contact.slip_force / (4.0 / PI * (1.0 + 1.0 / 9.0f64).sqrt()) - 1.0).abs() < 1e-4);
    }

    #[test]
    fn nothing_depends_on_what_the_workspace_did_before() {
        let contact = contact(50e-6);
        let mut memory = vec![0.0; workspace_length(3, 32)];
        workspace_init(3, 32, &mut memory).unwrap();
        let mut force_of = |size: f64| {
            let mut force = vec![0.0; 7];
            let output = HarmonicOutput { force: Some(&mut force), jacobian: None, dissipated: None };
            let mut workspace = Workspace::new(&mut memory).unwrap();
            harmonic_force(&contact, &mut workspace, &scaled(&contact, &SHAPE, size), output).unwrap();
            force
        };
        let first = force_of(0.8);
        force_of(-3.0);
        assert_eq!(force_of(0.8), first);
        // Outputs that are not wanted change nothing in the others.
        assert_eq!(all(&contact, 32, &scaled(&contact, &SHAPE, 0.8)).0, first);
    }
}
