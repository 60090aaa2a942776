//! The slip of a step: twice Coulomb's law at the points, `r = r* - A σ` with |r| <= l and σ = 0, or |r| = l and σ parallel to r.
//!
//! The first time in the middle of the step, with the limits l of the load there. What slipped until then slips once more until the end,
//! where the second time returns the tractions to their limits: the midpoint rule. A contact that slides far takes the end for the middle.
//!
//! With K the inverse of A among the points that slip and e the direction of r, `σ = K (r* - l e)`, and the residual is `e × σ`: Newton's
//! method for the angles of e. σ is the minimum of the strictly convex `σ'Aσ/2 - σ·r* + Σ l |σ|`: there is one, it depends continuously on
//! r* and l, and sweeps of the points, each to its own minimum, find the points that slip if Newton's method does not.

use super::contact::Contact;
use super::scalar::both;
use super::tables::{Both, MAP, Matrix, N, Row, Rows};
use super::trial::{Motion, ROUNDING, Trial, limits_before, slid};
use crate::shape::TINY;
use crate::simd::dispatch;

/// Bits of points.
pub(crate) type Set = u32;

/// Newton steps, and changes of the set, after which a guess is given up.
const STEPS: usize = 60;
const CHANGES: usize = 12;
/// Changes of angles: the one that would be next, at the end, that up to which the inverse is renewed, and the largest one of a step.
const CONVERGED: f64 = 1e-14;
const RENEWED: f64 = 1e-2;
const LARGEST_TURN: f64 = 0.8;
/// Beyond this a guess is lost.
const LOST: f64 = 1e4;
/// Sweeps of the points before Newton's method is tried again, at first, and the most: the first ones have always been enough.
const SWEEPS: usize = 30;
const MOST_SWEEPS: usize = 100_000;
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
    /// The springs at the end.
    pub v: Both<Row<f64>>,
    /// Tractions at the start of the step before.
    start: Both<Row<f64>>,
}

/// Points that slip, and what derivatives need.
#[repr(align(32))]
pub(crate) struct Slip {
    pub set: Set,
    /// The limits, the directions of r and σ.
    pub level: Row<f64>,
    pub e: Both<Row<f64>>,
    pub sigma: Both<Row<f64>>,
    /// K, and the inverse of the derivative of the residual by the angles, as `[m][i]`.
    pub k: Both<Matrix>,
    pub inverse: Matrix,
    /// The points and the load of K.
    known: (Set, f64),
}

/// First directions, and points that slip.
#[derive(Clone, Copy)]
struct Guess {
    e: Both<Row<f64>>,
    set: Set,
}

/// r without slip, A, and the load.
#[derive(Clone, Copy)]
struct Problem<'a> {
    r: Both<Row<f64>>,
    compliance: &'a Both<Matrix>,
    end: usize,
    load: f64,
}

impl Slips {
    pub const NONE: Slips =
        Slips { middle: Slip::NONE, end: Slip::NONE, slides: 0.0, v: [[0.0; N]; 2], start: [[0.0; N]; 2] };

    /// Whether nothing slips.
    pub fn is_empty(&self) -> bool {
        self.middle.set | self.end.set == 0
    }

    /// The slip of a step from its trial state, and what derivatives need if they are requested.
    pub fn find(
        &mut self,
        t: &Rows,
        contact: &Contact<f64>,
        compliance: &Both<Matrix>,
        motion: &Motion<f64, f64>,
        trial: &Trial,
        derivatives: bool,
    ) {
        let slips = self;
        dispatch!(find_kernel(slips, t, contact, compliance, motion, trial, derivatives));
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

#[inline(always)]
fn find_kernel(
    slips: &mut Slips,
    t: &Rows,
    contact: &Contact<f64>,
    compliance: &Both<Matrix>,
    motion: &Motion<f64, f64>,
    trial: &Trial,
    derivatives: bool,
) {
    let (end, start) = ((contact.last + 1).min(N), &trial.start);
    (slips.middle.set, slips.end.set, slips.slides, slips.v) = (0, 0, 0.0, trial.v);
    if trial.sticks {
        return;
    }
    slips.slides = slid(&t, contact, &trial.v);
    let theta = 0.5 * (1.0 + slips.slides);
    (slips.middle.level, slips.end.level) = ([1.0; N], [1.0; N]);
    if !motion.constant_load {
        let before = limits_before(&t, contact, contact.now.shift[0] - motion.before[0]);
        for i in 0..N {
            slips.middle.level[i] = if i < end { before[i] + theta * (1.0 - before[i]) } else { 1.0 };
        }
    }
    let mut r = *start;
    for k in 0..2 {
        for i in 0..N {
            r[k][i] += theta * (trial.r[k][i] - start[k][i]);
        }
    }
    let mut v = trial.v;
    let mut guesses = slips.guesses(&r, start, &motion.by, end);
    for stage in 0..2 {
        let middle = stage == 0;
        let [slip, other] =
            if middle { [&mut slips.middle, &mut slips.end] } else { [&mut slips.end, &mut slips.middle] };
        if !middle {
            // The rest of the step slips as the middle did.
            (r, guesses[0].set) = (trial.r, 0);
            other.relax(&mut r, compliance, end, 1.0 / theta);
            for i in 0..end {
                let square = r[0][i] * r[0][i] + r[1][i] * r[1][i];
                let length = (if square > TINY { square } else { TINY }).sqrt();
                (guesses[0].e[0][i], guesses[0].e[1][i]) = (r[0][i] / length, r[1][i] / length);
                guesses[0].set |= Set::from(square > ROUNDING) << i;
            }
            guesses[1] = guesses[0];
            guesses[0].set |= other.set;
        }
        if guesses[1].set == 0 {
            continue;
        }
        let problem = Problem { r, compliance, end, load: contact.now.load };
        let mut converged = false;
        for guess in &guesses {
            converged = converged || slip.solve(other, &problem, guess, derivatives);
        }
        if !converged {
            slip.descend(other, &problem, derivatives);
        }
        if middle && theta >= 1.0 && slip.set.count_ones() as usize == end {
            // The middle of a contact that slides far is its end. Tractions give the springs without cancellation.
            for k in 0..2 {
                let (mut d, mut above) = ([0.0; N], 0.0);
                for j in (0..end).rev() {
                    let mut sum = slip.level[j] * slip.e[k][j] / contact.per_pressure[j].max(TINY);
                    for m in j + 1..end {
                        sum -= d[m] * contact.map(&t, k, m, j);
                    }
                    d[j] = sum * contact.per_map(&t, k, j);
                    above += d[j];
                    v[k][j] = above;
                }
            }
            break;
        }
        for k in 0..2 {
            let mut sigma = [0.0; N];
            for i in 0..N {
                let scale = contact.per_pressure[i] / if middle { theta } else { 1.0 };
                sigma[i] = if slip.set >> i & 1 == 1 { slip.sigma[k][i] * scale } else { 0.0 };
            }
            let mut before = 0.0;
            for j in 0..end {
                let row = if j < contact.last { &t[MAP + k * N + j] } else { &contact.edge[k] };
                let mut products = [0.0; N];
                for i in 0..N {
                    products[i] = row[i] * sigma[i];
                }
                let sum = products.iter().sum::<f64>();
                v[k][j] -= (sum - before) * contact.flexibility(&t, k, j);
                before = sum;
            }
        }
    }
    slips.v = v;
}

impl Slip {
    const NONE: Slip = Slip {
        set: 0,
        level: [1.0; N],
        e: [[0.0; N]; 2],
        sigma: [[0.0; N]; 2],
        k: [[[0.0; N]; N]; 2],
        inverse: [[0.0; N]; N],
        known: (0, 0.0),
    };

    #[inline(always)]
    pub fn contains(&self, i: usize) -> bool {
        self.set >> i & 1 == 1
    }

    /// Takes what slips, times a factor, from the tractions of all points.
    #[inline(always)]
    fn relax(&self, r: &mut Both<Row<f64>>, compliance: &Both<Matrix>, end: usize, factor: f64) {
        for k in 0..2 {
            for m in 0..end.min(N) {
                if self.contains(m) {
                    let sigma = self.sigma[k][m] * factor;
                    for i in 0..N {
                        r[k][i] -= compliance[k][m][i] * sigma;
                    }
                }
            }
        }
    }

    /// Newton's method from a guess; whether it converged. What derivatives need is computed if they are requested.
    #[inline(always)]
    fn solve(&mut self, other: &Slip, problem: &Problem, guess: &Guess, derivatives: bool) -> bool {
        let Problem { r: r_trial, compliance, end, load } = problem;
        let end = (*end).min(N);
        (self.set, self.e) = (guess.set, guess.e);
        let mut steps = 0;
        'sets: for _ in 0..CHANGES {
            let set = self.set;
            let first = (set.trailing_zeros() as usize).min(end);
            let mut slips = [0.0; N];
            for i in 0..N {
                slips[i] = if set >> i & 1 == 1 { 1.0 } else { 0.0 };
            }
            if self.known != (set, *load) {
                self.known = (set, *load);
                if other.known == self.known {
                    self.k = other.k;
                } else {
                    for k in 0..2 {
                        for i in first..end {
                            for m in 0..N {
                                self.k[k][i][m] = compliance[k][i][m] * (slips[i] * slips[m]);
                            }
                        }
                        invert(&mut self.k[k], set, [first, end]);
                    }
                }
            }
            let constant = both!(|k| times(&self.k[k], [first, end], &r_trial[k]));
            let (mut turn, mut reviewed, mut done, mut fresh) = (9.0f64, false, false, false);
            loop {
                let ([e_x, e_y], level) = (self.e, self.level);
                for k in 0..2 {
                    let mut r = self.e[k];
                    for i in 0..N {
                        r[i] *= level[i];
                    }
                    let own = times(&self.k[k], [first, end], &r);
                    for i in 0..N {
                        self.sigma[k][i] = slips[i] * (constant[k][i] - own[i]);
                    }
                }
                let (mut residual, mut diagonal) = ([0.0; N], [0.0; N]);
                let [s_x, s_y] = self.sigma;
                for i in 0..N {
                    residual[i] = e_x[i] * s_y[i] - e_y[i] * s_x[i];
                    diagonal[i] = e_x[i] * s_x[i] + e_y[i] * s_y[i];
                }
                if done || (turn <= 0.1 && !reviewed) {
                    reviewed = true;
                    if self.review(problem, done) {
                        continue 'sets;
                    }
                }
                if (done && derivatives) || (!done && (turn > RENEWED || !fresh)) {
                    for m in first..end {
                        for i in 0..N {
                            let own = if i == m { diagonal[i] } else { 0.0 };
                            let (k_x, k_y) = (self.k[0][m][i], self.k[1][m][i]);
                            let turns = e_x[i] * e_x[m] * k_y + e_y[i] * e_y[m] * k_x;
                            self.inverse[m][i] = slips[i] * (turns * level[m] + own);
                        }
                    }
                    invert(&mut self.inverse, set, [first, end]);
                }
                if done {
                    return true;
                }
                let turns = times(&self.inverse, [first, end], &residual);
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
                if steps % REVIEW == 0 && self.review(problem, true) {
                    continue 'sets;
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
                // Quadratic with a new inverse, linear with an old one.
                let linear = turn / if before > TINY { before } else { TINY };
                let rate = if turn > RENEWED || before > RENEWED { turn } else { linear };
                done = turn * (if rate < 1.0 { rate } else { 1.0 }) <= CONVERGED;
                fresh = turn <= 0.1 * before && turn <= RENEWED;
            }
        }
        false
    }

    /// From sweeps of the points.
    #[cold]
    #[inline(never)]
    fn descend(&mut self, other: &Slip, problem: &Problem, derivatives: bool) {
        let Problem { r, compliance, end, .. } = problem;
        let (mut guess, mut sigma, mut sweeps, mut r) = (Guess { e: *r, set: 0 }, [[0.0; N]; 2], SWEEPS, *r);
        while sweeps < MOST_SWEEPS {
            for _ in 0..sweeps {
                for i in (0..(*end).min(N)).rev() {
                    let (a, limit) = ([compliance[0][i][i], compliance[1][i][i]], self.level[i]);
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
            if self.solve(other, problem, &guess, derivatives) {
                return;
            }
            sweeps *= 4;
        }
    }

    /// Points beyond the limit slip; at the end of an iteration, those whose slip is against the traction stick. Whether any has changed.
    #[inline(always)]
    fn review(&mut self, problem: &Problem, done: bool) -> bool {
        let (before, mut r) = (self.set, problem.r);
        self.relax(&mut r, problem.compliance, problem.end, 1.0);
        for i in 0..problem.end.min(N) {
            let (x, y, limit) = (r[0][i], r[1][i], self.level[i]);
            let square = x * x + y * y;
            if before >> i & 1 == 1 {
                let along = self.sigma[0][i] * self.e[0][i] + self.sigma[1][i] * self.e[1][i];
                let scale = self.k[0][i][i] + self.k[1][i][i];
                self.set &= !(Set::from(done && along < -BACKWARDS * scale) << i);
            } else if square > (1.0 + EXCESS) * limit * limit {
                let length = square.sqrt();
                self.set |= 1 << i;
                (self.e[0][i], self.e[1][i]) = (x / length, y / length);
            }
        }
        self.set != before
    }
}

/// Σ x_m matrix[m][i]: rows of points that stick are 0.
#[inline(always)]
fn times(matrix: &Matrix, [first, end]: [usize; 2], x: &Row<f64>) -> Row<f64> {
    let mut y = [0.0; N];
    for m in first..end {
        for i in 0..N {
            y[i] += x[m] * matrix[m][i];
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
