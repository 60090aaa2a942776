//! The slip of a step: twice Coulomb's law at the points, `r = r* - A σ` with |r| <= l and σ = 0, or |r| = l and σ parallel to r.
//!
//! The first time in the middle of the step, with the limits l of the load there. What slipped until then slips once more until the end,
//! where the second time returns the tractions to their limits: the midpoint rule. A contact that slides far takes the end for the middle.
//!
//! With K the inverse of A among the points that slip and e the direction of r, `σ = K (r* - l e)`, and the residual is `e × σ`: Newton's
//! method for the angles of e. Slip without gaps, of all points from one on to the edge, has the springs `v = C⁻¹ l e` there, and
//! `K = C⁻¹' w C⁻¹`, free of cancellation. σ is the minimum of the strictly convex `σ'Aσ/2 - σ·r* + Σ l |σ|`: there is one, it depends
//! continuously on r* and l, and sweeps of the points, each to its own minimum, find the points that slip if Newton's method does not.

use super::contact::Contact;
use super::scalar::both;
use super::tables::{Both, FINE, INSIDE, Matrix, N, Row, Rows, SHIFT};
use super::trial::{FINE_SPRING, Motion, ROUNDING, Trial, Values, direction, limits_before, moved, slid, tractions};
use crate::shape::TINY;
use crate::simd::dispatch;

/// Bits of points.
pub(crate) type Set = u32;

/// Newton steps, and changes of the set, after which a guess is given up.
const STEPS: usize = 60;
const CHANGES: usize = 12;
/// Changes of angles: the one that would be next, at the end, that up to which the inverse is renewed, and the largest one of a step.
const CONVERGED: f64 = 1e-12;
const RENEWED: f64 = 1e-2;
const LARGEST_TURN: f64 = 0.8;
/// Of two changes that are at most the first number, with a new inverse each, the second one is a rounding error from this part on.
const SMALL_TURN: f64 = 1e-9;
const STALLED: f64 = 0.5;
/// Beyond this a guess is lost.
const LOST: f64 = 1e4;
/// Sweeps of the points before Newton's method is tried again, at first, and attempts, of which the first two are without: in random steps, one
/// of two million needs sweeps, and few of these more than the first.
const SWEEPS: usize = 30;
const MOST_ATTEMPTS: usize = 8;
/// Newton steps after which points that slip backwards stick: the angle of a point that hardly slips is undetermined.
const REVIEW: usize = 15;
/// Excess of |r|² from which on a point slips, and slip against the traction, over its scale, from which on it sticks: rounding errors.
const EXCESS: f64 = 1e-12;
const BACKWARDS: f64 = 1e-14;
/// |r|² from which on a point has slipped before.
pub(crate) const SLIPPED: f64 = 1.0 - 1e-9;
/// Cosine of the angle between the tractions before and of the trial state up to which the one before is the first guess.
const NEAR: f64 = 0.5;
/// Cosine of the angle between a motion and a traction from which on a point turns back.
const TURNS_BACK: f64 = -0.6;

/// Both slips of a step.
pub(crate) struct Slips {
    pub middle: Slip,
    pub end: Slip,
    /// The part in which the contact slides far.
    pub slides: f64,
    /// The springs at the start and of the trial state, and at the end; the directions of those that leave.
    pub old: Both<Row<f64>>,
    pub leaves: [[f64; 3]; N],
    pub trial: Both<Row<f64>>,
    pub v: Both<Row<f64>>,
    pub fine: FineSlips,
    /// Tractions at the start of the step before.
    start: Both<Row<f64>>,
}

/// Fine springs, of which each slips on its own: e, the direction of v/limit, and 1/(x y |v/limit|) with the limits x and y, negative for a
/// spring that sticks.
pub(crate) struct FineSlips([[Row<f64>; FINE / N]; 3]);

impl FineSlips {
    const NONE: FineSlips = FineSlips([[[0.0; N]; FINE / N]; 3]);

    #[inline(always)]
    pub fn at(&self, f: usize) -> [f64; 3] {
        let [e_x, e_y, per_length] = &self.0;
        [e_x, e_y, per_length].map(|rows| rows.as_flattened().get(f).copied().unwrap_or(0.0))
    }

    #[inline(always)]
    fn find(&mut self, t: &Rows, c: &Contact<f64>, motion: &Motion<f64, f64>, springs: &Values) {
        const ROWS: usize = FINE / N;
        let (rise, inside) = (both!(|k| c.now.shift[k] - motion.before[k]), both!(|k| c.limit_inside(k)));
        for row in 0..ROWS {
            for j in 0..N {
                let at_edge = row * N + j == INSIDE;
                let limit = both!(|k| if at_edge { inside[k] } else { c.now.shift[k] - t[SHIFT + k * ROWS + row][j] });
                let before = both!(|k| springs[FINE_SPRING / N + k * ROWS + row][j]);
                let kept = !at_edge || motion.constant_load;
                let v = both!(|k| if kept { before[k] } else { 0.0 } + moved(limit[k], rise[k], motion.by[k]));
                let direction = direction(v, limit);
                for (rows, value) in self.0.iter_mut().zip(direction) {
                    rows[row][j] = value;
                }
            }
        }
    }
}

/// Points that slip, and what derivatives need.
#[repr(align(32))]
pub(crate) struct Slip {
    pub set: Set,
    /// The limits, the directions of r and σ.
    pub level: Row<f64>,
    pub e: Both<Row<f64>>,
    pub sigma: Both<Row<f64>>,
    /// The springs after slip, and r of the points that stick.
    pub v: Both<Row<f64>>,
    r: Both<Row<f64>>,
    /// K, and the inverse of the derivative of the residual by the angles, as `[m][i]`.
    pub k: Both<Matrix>,
    pub inverse: Matrix,
    /// The points and the load of K, and those of the inverse.
    known: (Set, f64),
    inverted: (Set, f64),
}

/// First directions, and points that slip.
#[derive(Clone, Copy)]
struct Guess {
    e: Both<Row<f64>>,
    set: Set,
}

/// Springs and r without slip, and what relates them: the contact and C⁻¹.
#[derive(Clone, Copy)]
struct Problem<'a> {
    v: Both<Row<f64>>,
    r: Both<Row<f64>>,
    t: &'a Rows,
    contact: &'a Contact<f64>,
    inverse: &'a Both<Matrix>,
    end: usize,
}

impl Slips {
    pub const NONE: Slips = Slips {
        middle: Slip::NONE,
        end: Slip::NONE,
        slides: 0.0,
        old: [[0.0; N]; 2],
        leaves: [[0.0; 3]; N],
        trial: [[0.0; N]; 2],
        v: [[0.0; N]; 2],
        fine: FineSlips::NONE,
        start: [[0.0; N]; 2],
    };

    /// Whether nothing slips.
    pub fn is_empty(&self) -> bool {
        self.middle.set | self.end.set == 0
    }

    /// The slip of a step from its trial state and the springs at its start, and what derivatives need if they are requested.
    pub fn find(
        &mut self,
        t: &Rows,
        contact: &Contact<f64>,
        inverse: &Both<Matrix>,
        motion: &Motion<f64, f64>,
        (trial, old): (&Trial, &Values),
        derivatives: bool,
    ) {
        let slips = self;
        dispatch!({
            let (end, start) = ((contact.last + 1).min(N), &trial.start);
            (slips.middle.set, slips.end.set, slips.slides, slips.v) = (0, 0, 0.0, trial.v);
            slips.fine.find(t, contact, motion, old);
            // Under a constant load, the middle sticks if the end does.
            if trial.sticks && motion.constant_load {
                return;
            }
            (slips.old, slips.leaves, slips.trial) = (trial.old, trial.leaves, trial.v);
            slips.slides = slid(&t, contact, &trial.v, &trial.v);
            let theta = 0.5 * (1.0 + slips.slides);
            (slips.middle.level, slips.end.level) = ([1.0; N], [1.0; N]);
            if !motion.constant_load {
                let before = limits_before(&t, contact, contact.now.shift[0] - motion.before[0]);
                for i in 0..N {
                    slips.middle.level[i] = if i < end { before[i] + theta * (1.0 - before[i]) } else { 1.0 };
                }
            }
            let mut problem = Problem { v: trial.v, r: *start, t, contact, inverse, end };
            for k in 0..2 {
                for i in 0..N {
                    problem.r[k][i] += theta * (trial.r[k][i] - start[k][i]);
                    problem.v[k][i] = trial.old[k][i] + theta * (trial.v[k][i] - trial.old[k][i]);
                }
            }
            let mut guesses = slips.guesses(&problem.r, start, &motion.by, end);
            for stage in 0..2 {
                let middle = stage == 0;
                let [slip, other] =
                    if middle { [&mut slips.middle, &mut slips.end] } else { [&mut slips.end, &mut slips.middle] };
                if !middle {
                    for i in 0..end {
                        let (x, y) = (problem.r[0][i], problem.r[1][i]);
                        let square = x * x + y * y;
                        let length = (if square > TINY { square } else { TINY }).sqrt();
                        (guesses[0].e[0][i], guesses[0].e[1][i]) = (x / length, y / length);
                        guesses[0].set |= Set::from(square > ROUNDING) << i;
                    }
                    guesses[1] = guesses[0];
                    guesses[0].set |= other.set;
                }
                if guesses[1].set != 0 {
                    let mut sweeps = Sweeps {
                        guess: Guess { e: problem.r, set: 0 },
                        sigma: [[0.0; N]; 2],
                        r: problem.r,
                        count: SWEEPS,
                    };
                    let mut attempt = 0;
                    while attempt < MOST_ATTEMPTS {
                        let guess = if attempt < 2 { guesses[attempt] } else { sweeps.next(&problem, &slip.level) };
                        if slip.solve(other, &problem, &guess, derivatives) {
                            break;
                        }
                        attempt += 1;
                    }
                }
                slips.v = if slip.set == 0 { problem.v } else { slip.v };
                if !middle || (theta >= 1.0 && slip.set.count_ones() as usize == end) {
                    // The middle of a contact that slides far is its end.
                    break;
                }
                // The rest of the step slips as the middle did.
                guesses[0].set = 0;
                let (v, r) = (problem.v, problem.r);
                (problem.v, problem.r) = (trial.v, trial.r);
                if slip.set != 0 {
                    let per = 1.0 / theta;
                    for k in 0..2 {
                        for i in 0..N {
                            problem.v[k][i] -= (v[k][i] - slip.v[k][i]) * per;
                            let slipped = start[k][i] + (slip.level[i] * slip.e[k][i] - start[k][i]) * per;
                            let sticks = problem.r[k][i] - (r[k][i] - slip.r[k][i]) * per;
                            problem.r[k][i] = if slip.contains(i) { slipped } else { sticks };
                        }
                    }
                }
            }
        });
    }

    /// Guesses for the middle: a contact that slips on hardly turns; otherwise slip begins from the trial state.
    #[inline(always)]
    fn guesses(&mut self, r: &Both<Row<f64>>, start: &Both<Row<f64>>, by: &Both<f64>, end: usize) -> [Guess; 2] {
        let (mut e, mut from_trial, mut continues) = (*r, *r, [0.0; N]);
        let mut beyond = [0.0; N];
        let backwards = TURNS_BACK * (by[0] * by[0] + by[1] * by[1]).sqrt();
        for i in 0..N {
            let (x, y) = (r[0][i], r[1][i]);
            let (square, limit) = (x * x + y * y, self.middle.level[i]);
            beyond[i] = if square > ROUNDING * limit * limit { 1.0 } else { 0.0 };
            let length = (if square > TINY { square } else { TINY }).sqrt();
            let (x, y) = (x / length, y / length);
            (from_trial[0][i], from_trial[1][i]) = (x, y);
            let (r_x, r_y) = (start[0][i], start[1][i]);
            let slipped = r_x * r_x + r_y * r_y > SLIPPED;
            let near = slipped && x * r_x + y * r_y > NEAR;
            // A point that slipped in the step before as well turns on, by half.
            let (b_x, b_y) = (self.start[0][i], self.start[1][i]);
            let (cos, sin) = (b_x * r_x + b_y * r_y, b_x * r_y - b_y * r_x);
            let turns = slipped && cos > NEAR && cos * cos + sin * sin > SLIPPED;
            let (cos, sin) = if turns { (1.0 + cos, sin) } else { (1.0, 0.0) };
            let (on_x, on_y) = (cos * r_x - sin * r_y, cos * r_y + sin * r_x);
            let square = on_x * on_x + on_y * on_y;
            let length = (if square > TINY { square } else { TINY }).sqrt();
            (e[0][i], e[1][i]) = (if near { on_x / length } else { x }, if near { on_y / length } else { y });
            continues[i] = if slipped && r_x * by[0] + r_y * by[1] >= backwards { 1.0 } else { 0.0 };
        }
        let (mut set, mut outside) = (0, 0);
        for i in (0..end.min(N)).rev() {
            outside |= Set::from(beyond[i] > 0.0) << i;
            // A point that slipped before continues if the next one outside does.
            let outer = set >> (i + 1) & 1 == 1;
            set |= Set::from(beyond[i] > 0.0 || (continues[i] > 0.0 && outer)) << i;
        }
        self.start = *start;
        [Guess { e, set }, Guess { e: from_trial, set: outside }]
    }
}

impl Slip {
    const NONE: Slip = Slip {
        set: 0,
        level: [1.0; N],
        e: [[0.0; N]; 2],
        sigma: [[0.0; N]; 2],
        v: [[0.0; N]; 2],
        r: [[0.0; N]; 2],
        k: [[[0.0; N]; N]; 2],
        inverse: [[0.0; N]; N],
        known: (0, 0.0),
        inverted: (0, 0.0),
    };

    #[inline(always)]
    pub fn contains(&self, i: usize) -> bool {
        self.set >> i & 1 == 1
    }

    /// Whether all points from the first one that slips to the edge do.
    #[inline(always)]
    pub fn without_gaps(&self, end: usize) -> bool {
        let first = self.set.trailing_zeros();
        (self.set >> first.min(31)).trailing_ones() as usize + first as usize == end
    }

    /// The springs after slip.
    #[inline(always)]
    fn springs(&self, problem: &Problem) -> Both<Row<f64>> {
        let Problem { mut v, t, contact, inverse, end, .. } = *problem;
        let end = end.min(N);
        let first = (self.set.trailing_zeros() as usize).min(end);
        if self.without_gaps(end) {
            for k in 0..2 {
                let mut limits = [0.0; N];
                for i in 0..N {
                    limits[i] = if self.contains(i) { self.level[i] * self.e[k][i] } else { 0.0 };
                }
                for j in first..end {
                    v[k][j] = dot(&inverse[k][j], &limits);
                }
            }
            return v;
        }
        for k in 0..2 {
            let mut per_slip = [0.0; N];
            for i in 0..N {
                per_slip[i] = if self.contains(i) { self.sigma[k][i] * contact.per_pressure[i] } else { 0.0 };
            }
            let mut before = 0.0;
            for j in first..end {
                let row = contact.row(t, k, j);
                let sum = dot(row, &per_slip);
                v[k][j] -= (sum - before) * contact.flexibility(&t, k, j);
                before = sum;
            }
        }
        v
    }

    /// K of the points that slip.
    #[inline(always)]
    fn stiffen(&mut self, problem: &Problem) {
        let &Problem { t, contact, inverse, end, .. } = problem;
        let end = end.min(N);
        let first = (self.set.trailing_zeros() as usize).min(end);
        if self.without_gaps(end) {
            for k in 0..2 {
                let mut sum = [[0.0; N]; N];
                for j in first..end {
                    let w = contact.stiffness(&t, k, j);
                    for m in j..end {
                        let scale = w * inverse[k][j][m];
                        for i in 0..N {
                            sum[m][i] += scale * inverse[k][j][i];
                        }
                    }
                }
                self.k[k] = sum;
            }
            return;
        }
        for k in 0..2 {
            let a = compliance(problem, k, first);
            for i in first..end {
                for m in 0..N {
                    self.k[k][i][m] = if self.contains(i) && self.contains(m) { a[i][m] } else { 0.0 };
                }
            }
            invert(&mut self.k[k], self.set, [first, end]);
        }
    }

    /// Newton's method from a guess; whether it converged. What derivatives need is computed if they are requested.
    #[inline(always)]
    fn solve(&mut self, other: &Slip, problem: &Problem, guess: &Guess, derivatives: bool) -> bool {
        let Problem { r: r_trial, contact, end, .. } = problem;
        let end = (*end).min(N);
        (self.set, self.e, self.v, self.r) = (guess.set, guess.e, problem.v, problem.r);
        let mut steps = 0;
        'sets: for _ in 0..CHANGES {
            let set = self.set;
            let first = (set.trailing_zeros() as usize).min(end);
            let mut slips = [0.0; N];
            for i in 0..N {
                slips[i] = if set >> i & 1 == 1 { 1.0 } else { 0.0 };
            }
            let of = (set, contact.now.load);
            if self.known != of {
                self.known = of;
                if other.known == of {
                    self.k = other.k;
                } else {
                    self.stiffen(problem);
                }
            }
            // The inverse of the step before holds while changes of angles fall to a tenth.
            let (mut turn, mut done, mut holds) = (f64::MAX, false, self.inverted == of);
            let mut renewed = [false; 2];
            loop {
                let ([e_x, e_y], level) = (self.e, self.level);
                let mut excess = *r_trial;
                for k in 0..2 {
                    for i in 0..N {
                        excess[k][i] = slips[i] * (excess[k][i] - level[i] * self.e[k][i]);
                    }
                }
                self.sigma = times([&self.k[0], &self.k[1]], [first, end], &excess);
                let (mut residual, mut diagonal) = ([0.0; N], [0.0; N]);
                let [s_x, s_y] = self.sigma;
                for i in 0..N {
                    residual[i] = e_x[i] * s_y[i] - e_y[i] * s_x[i];
                    diagonal[i] = e_x[i] * s_x[i] + e_y[i] * s_y[i];
                }
                let undetermined = steps % REVIEW == REVIEW - 1;
                if (done || undetermined) && self.review(problem) {
                    continue 'sets;
                }
                renewed = [renewed[1], !holds];
                if (done && derivatives) || (!done && renewed[1]) {
                    for m in first..end {
                        for i in 0..N {
                            let own = if i == m { diagonal[i] } else { 0.0 };
                            let (k_x, k_y) = (self.k[0][m][i], self.k[1][m][i]);
                            let turns = e_x[i] * e_x[m] * k_y + e_y[i] * e_y[m] * k_x;
                            self.inverse[m][i] = slips[i] * (turns * level[m] + own);
                        }
                    }
                    invert(&mut self.inverse, set, [first, end]);
                    self.inverted = of;
                }
                if done {
                    return true;
                }
                let [turns] = times([&self.inverse], [first, end], &[residual]);
                let (before, mut largest) = (turn, 0.0);
                for i in 0..N {
                    let size = slips[i] * turns[i].abs();
                    largest = if size > largest { size } else { largest };
                }
                turn = largest;
                steps += 1;
                if steps > STEPS || turn > LOST {
                    return false;
                }
                let damping = LARGEST_TURN / if turn > LARGEST_TURN { turn } else { LARGEST_TURN };
                let (mut x, mut y) = (e_x, e_y);
                for i in 0..N {
                    // Cayley's formula.
                    let half = 0.5 * damping * turns[i] * slips[i];
                    let scale = 1.0 / (1.0 + half * half);
                    let (cos, sin) = ((1.0 - half * half) * scale, 2.0 * half * scale);
                    (x[i], y[i]) = (cos * e_x[i] - sin * e_y[i], cos * e_y[i] + sin * e_x[i]);
                }
                self.e = [x, y];
                // Quadratic with a new inverse, linear with an old one, of which the first change tells nothing.
                let linear = turn / if before > TINY { before } else { TINY };
                let rate = if renewed[1] { turn } else { linear };
                let is_first = before > LOST && !renewed[1];
                let stalled = renewed == [true; 2] && before <= SMALL_TURN && turn >= STALLED * before;
                done = stalled || turn * (if rate < 1.0 && !is_first { rate } else { 1.0 }) <= CONVERGED;
                holds = turn <= 0.1 * before && turn <= RENEWED;
            }
        }
        false
    }

    /// The springs after slip. Points beyond the limit slip, and those whose slip is against the traction stick: whether any has changed.
    #[inline(always)]
    fn review(&mut self, problem: &Problem) -> bool {
        let (before, first) = (self.set, self.set.trailing_zeros() as usize);
        (self.v, self.r) = (problem.v, problem.r);
        if before != 0 {
            self.v = self.springs(problem);
        }
        if before != 0 && !(first == 0 && self.without_gaps(problem.end)) {
            for k in 0..2 {
                let mut relaxed = problem.v[k];
                for j in 0..N {
                    relaxed[j] -= self.v[k][j];
                }
                let relaxed = tractions(problem.t, problem.contact, k, &relaxed, first);
                for i in 0..N {
                    self.r[k][i] -= relaxed[i];
                }
            }
        }
        for i in 0..problem.end.min(N) {
            let (x, y, limit) = (self.r[0][i], self.r[1][i], self.level[i]);
            let square = x * x + y * y;
            if before >> i & 1 == 1 {
                let along = self.sigma[0][i] * self.e[0][i] + self.sigma[1][i] * self.e[1][i];
                let scale = self.k[0][i][i] + self.k[1][i][i];
                self.set &= !(Set::from(along < -BACKWARDS * scale) << i);
            } else if square > (1.0 + EXCESS) * limit * limit {
                let length = square.sqrt();
                self.set |= 1 << i;
                (self.e[0][i], self.e[1][i]) = (x / length, y / length);
            }
        }
        self.set != before
    }
}

/// Sweeps of the points: each slips to its own minimum, again and again.
struct Sweeps {
    guess: Guess,
    sigma: Both<Row<f64>>,
    r: Both<Row<f64>>,
    /// Of the next attempt.
    count: usize,
}

impl Sweeps {
    /// The guess after four times as many sweeps as before.
    #[cold]
    #[inline(never)]
    fn next(&mut self, problem: &Problem, level: &Row<f64>) -> Guess {
        let Sweeps { guess, sigma, r, count } = self;
        let compliance = both!(|k| compliance(problem, k, 0));
        for _ in 0..*count {
            for i in (0..problem.end.min(N)).rev() {
                let (a, limit) = ([compliance[0][i][i], compliance[1][i][i]], level[i]);
                let g = [r[0][i] + a[0] * sigma[0][i], r[1][i] + a[1] * sigma[1][i]];
                guess.set &= !(1 << i);
                let mut now = [0.0; 2];
                if g[0] * g[0] + g[1] * g[1] > limit * limit {
                    let (size, e) = own_slip(g.map(|g| g / limit), a.map(|a| a / limit));
                    now = e.map(|e| size * e);
                    guess.set |= 1 << i;
                    (guess.e[0][i], guess.e[1][i]) = (e[0], e[1]);
                }
                for k in 0..2 {
                    let change = now[k] - sigma[k][i];
                    sigma[k][i] = now[k];
                    for m in 0..N {
                        r[k][m] -= compliance[k][i][m] * change;
                    }
                }
            }
        }
        *count *= 4;
        *guess
    }
}

/// A = C w⁻¹ C' of the points from one on, `C_ij = (G_ij - G_i,j-1)/p_i`.
#[inline(always)]
fn compliance(problem: &Problem, k: usize, first: usize) -> Matrix {
    let &Problem { t, contact, end, .. } = problem;
    let (mut a, mut before) = ([[0.0; N]; N], [0.0; N]);
    for j in 0..end.min(N) {
        let row = contact.row(t, k, j);
        let mut column = [0.0; N];
        for i in 0..N {
            column[i] = (row[i] - before[i]) * contact.per_pressure[i];
        }
        before = *row;
        let flexibility = contact.flexibility(&t, k, j);
        for (row, own) in a.iter_mut().zip(column).skip(first) {
            for i in 0..N {
                row[i] += own * flexibility * column[i];
            }
        }
    }
    a
}

/// Σ x_i y_i, in an order of vectors.
#[inline(always)]
fn dot(x: &Row<f64>, y: &Row<f64>) -> f64 {
    let mut sums = [0.0; 4];
    for b in 0..N / 4 {
        for lane in 0..4 {
            sums[lane] += x[4 * b + lane] * y[4 * b + lane];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// Σ x_m matrix[m][i] of several matrices: rows of points that stick are 0.
#[inline(always)]
fn times<const K: usize>(matrices: [&Matrix; K], [first, end]: [usize; 2], x: &[Row<f64>; K]) -> [Row<f64>; K] {
    let mut y = [[0.0; N]; K];
    for m in first..end {
        for k in 0..K {
            for i in 0..N {
                y[k][i] += x[k][m] * matrices[k][m][i];
            }
        }
    }
    y
}

/// The inverse of the block of a set, in place, by Gauss and Jordan. Single elements are chosen by their place in the lanes: a vector that
/// is loaded right after one of its elements was stored would wait for it.
#[inline(always)]
fn invert(matrix: &mut Matrix, set: Set, [first, end]: [usize; 2]) {
    for p in first..end {
        if set >> p & 1 == 0 {
            continue;
        }
        let pivot = matrix[p][p];
        let reciprocal = 1.0 / if pivot.abs() > TINY { pivot } else { TINY };
        let (mut row, mut others) = (matrix[p], [0.0; N]);
        for j in 0..N {
            row[j] = if j == p { reciprocal } else { row[j] * reciprocal };
            others[j] = if j == p { 0.0 } else { 1.0 };
        }
        for i in first..end {
            let old = matrix[i];
            let (factor, mut values) = (matrix[i][p], [0.0; N]);
            for j in 0..N {
                values[j] = old[j] * others[j] - factor * row[j];
            }
            matrix[i] = values;
        }
        matrix[p] = row;
    }
}

/// The slip of a point on its own, whose traction without slip is g, over the limit: its size and direction, by Newton's method for the root
/// of `|g/(1 + a size)|² = 1`, of which 1/sqrt is concave.
fn own_slip(g: Both<f64>, a: Both<f64>) -> (f64, Both<f64>) {
    let (mut size, mut e) = (0.0, g);
    for _ in 0..40 {
        let d = [1.0 / (1.0 + a[0] * size), 1.0 / (1.0 + a[1] * size)];
        e = [g[0] * d[0], g[1] * d[1]];
        let square = e[0] * e[0] + e[1] * e[1];
        let slope = e[0] * e[0] * a[0] * d[0] + e[1] * e[1] * a[1] * d[1];
        let by = (square.sqrt() - 1.0) * square / slope.max(TINY);
        size += by;
        if by.abs() <= 1e-14 * size {
            break;
        }
    }
    let length = (e[0] * e[0] + e[1] * e[1]).sqrt();
    (size, e.map(|e| e / length))
}
