//! Coulomb's law at the points: `r = r* - A σ` with |r| <= 1 and σ = 0, or |r| = 1 and σ parallel to `r + β r0`.
//!
//! r* is the traction of the trial state, σ the slip and r0 the traction at the start of the step: with β = 1 the slip has half the direction
//! at the start and half that at the end, the trapezoidal rule. β depends on r0 and on the trial state only, so that each point on its own has
//! exactly one slip: `|r* - s β a r0|/(1 + a s) = 1` has one root s > 0 if β |r0| <= 1. With K the inverse of A among the points that slip,
//! `σ = K (r* - r)`, and the residual is `(r + β r0) × σ`: Newton's method for the angles of r. Sweeps of the points, each to its own slip,
//! find the points that slip if Newton's method does not.

use super::contact::Contact;
use super::predict::{bend, slid};
use super::scalar::both;
use super::tables::{Both, Matrix, N, Row, Rows};
use super::trial::{Motion, ROUNDING, Trial, Values};
use crate::shape::TINY;
use crate::simd::dispatch;

/// Bits of points.
pub(crate) type Set = u32;

/// Newton steps, and changes of the set, after which a guess is given up.
const STEPS: usize = 60;
const CHANGES: usize = 12;
/// Changes of angles: the last one, up to which the inverse is renewed, and the largest one of a step. A step of the law ends with one
/// more step of Newton's method, so that the error is the square of the first one.
const CONVERGED: f64 = 1e-10;
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
const EXCESS: f64 = 1e-10;
const BACKWARDS: f64 = 1e-12;
/// |r|² from which on a point has slipped before.
pub(crate) const SLIPPED: f64 = 1.0 - 1e-9;
/// Cosine of the angle between the tractions before and of the trial state up to which the one before is the first guess.
const NEAR: f64 = 0.5;
/// Cosine of the angle between a motion and a traction from which on a point turns back.
const TURNS_BACK: f64 = -0.6;

/// Points that slip in a step, and what its derivatives need.
#[repr(align(32))]
pub(crate) struct Slip {
    /// The points, and those of which a part of the slip is predicted, with its share.
    pub set: Set,
    pub shares: Row<f64>,
    /// The part in which the contact slides far.
    pub slides: f64,
    /// r and σ of points that slip.
    pub e: Both<Row<f64>>,
    pub sigma: Both<Row<f64>>,
    /// K, and the inverse of the derivative of the residual by the angles as `[m][i]`.
    pub k: Both<Matrix>,
    pub inverse: Matrix,
    /// r of points that stick, and r at the start of the step before.
    pub r: Both<Row<f64>>,
    pub start: Both<Row<f64>>,
    /// The points and the load of K.
    known: (Set, f64),
}

/// First directions, and points that slip.
#[derive(Clone, Copy)]
struct Guess {
    e: Both<Row<f64>>,
    set: Set,
}

/// What a solution starts from.
#[derive(Clone, Copy)]
struct Problem<'a> {
    r: Both<Row<f64>>,
    start: Both<Row<f64>>,
    compliance: &'a Both<Matrix>,
    last: usize,
    load: f64,
}

impl Slip {
    pub const NONE: Slip = Slip {
        set: 0,
        shares: [0.0; N],
        slides: 0.0,
        e: [[0.0; N]; 2],
        sigma: [[0.0; N]; 2],
        k: [[[0.0; N]; N]; 2],
        inverse: [[0.0; N]; N],
        r: [[0.0; N]; 2],
        start: [[0.0; N]; 2],
        known: (0, 0.0),
    };

    #[inline(always)]
    pub fn contains(&self, i: usize) -> bool {
        self.set >> i & 1 == 1
    }

    /// The slip of a step whose trial state does not stick, from the springs at its start. The inverse of the derivatives is computed if they
    /// are requested.
    #[expect(clippy::too_many_arguments, reason = "parts of one step")]
    pub fn find(
        &mut self,
        t: &Rows,
        contact: &Contact<f64>,
        compliance: &Both<Matrix>,
        motion: &Motion<f64, f64>,
        trial: &Trial,
        old: &Values,
        derivatives: bool,
    ) {
        let slip = self;
        dispatch!(find_kernel(slip, t, contact, compliance, motion, trial, old, derivatives));
    }

    /// A step without slip.
    pub fn stick(&mut self, trial: &Trial, old: &Values) {
        (self.set, self.slides) = (0, 0.0);
        (self.r, self.start) = (trial.r, [old[2], old[3]]);
    }

    /// r of all points, from σ.
    #[inline(always)]
    fn relax(&mut self, Problem { r, compliance, last, .. }: &Problem, k: usize) {
        let mut r = r[k];
        for m in 0..=(*last).min(N - 1) {
            if self.contains(m) {
                let sigma = self.sigma[k][m];
                for i in 0..N {
                    r[i] -= compliance[k][m][i] * sigma;
                }
            }
        }
        self.r[k] = r;
    }

    /// A contact that slips on hardly turns; otherwise slip begins from the trial state.
    #[inline(always)]
    fn guesses(&self, trial: &Trial, start: &Both<Row<f64>>, by: &Both<f64>, last: usize) -> [Guess; 2] {
        let Trial { r, over_limit, .. } = trial;
        let (mut e, mut from_trial, mut continues) = (*r, *r, [0.0; N]);
        let (mut beyond, mut over) = ([0.0; N], [0.0; N]);
        let backwards = TURNS_BACK * (by[0] * by[0] + by[1] * by[1]).sqrt();
        for i in 0..N {
            let square = r[0][i] * r[0][i] + r[1][i] * r[1][i];
            beyond[i] = if square > ROUNDING { 1.0 } else { 0.0 };
            let (x, y) = (over_limit[0][i], over_limit[1][i]);
            let of_spring = x * x + y * y;
            let outside = of_spring > 1.0;
            over[i] = if outside { 1.0 } else { 0.0 };
            let (x, y) = if outside { (x, y) } else { (r[0][i], r[1][i]) };
            let square = if outside { of_spring } else { square };
            let length = (if square > TINY { square } else { TINY }).sqrt();
            let (x, y) = (x / length, y / length);
            (from_trial[0][i], from_trial[1][i]) = (x, y);
            let (r_x, r_y) = (start[0][i], start[1][i]);
            let slipped = r_x * r_x + r_y * r_y > SLIPPED;
            let near = slipped && x * r_x + y * r_y > NEAR;
            // A point that slipped in the step before as well turns on.
            let (b_x, b_y) = (self.start[0][i], self.start[1][i]);
            let (cos, sin) = (b_x * r_x + b_y * r_y, b_x * r_y - b_y * r_x);
            let turns = slipped && cos > NEAR && cos * cos + sin * sin > SLIPPED;
            let (cos, sin) = if turns { (cos, sin) } else { (1.0, 0.0) };
            let (on_x, on_y) = (cos * r_x - sin * r_y, cos * r_y + sin * r_x);
            let square = on_x * on_x + on_y * on_y;
            let length = (if near { square } else { 1.0 }).sqrt();
            (e[0][i], e[1][i]) = (if near { on_x / length } else { x }, if near { on_y / length } else { y });
            continues[i] = if slipped && r_x * by[0] + r_y * by[1] >= backwards { 1.0 } else { 0.0 };
        }
        let (mut set, mut outside) = (0, 0);
        for i in (0..=last.min(N - 1)).rev().map(|i| i.min(N - 1)) {
            outside |= Set::from(beyond[i] > 0.0) << i;
            // A point that slipped before continues if the next one outside does.
            let outer = set >> (i + 1) & 1 == 1;
            set |= Set::from(beyond[i] > 0.0 || over[i] > 0.0 || (continues[i] > 0.0 && outer)) << i;
        }
        [Guess { e, set }, Guess { e: from_trial, set: outside }]
    }

    /// Newton's method from a guess; whether it converged. The inverse at the end is computed if derivatives are requested.
    #[inline(always)]
    fn solve(&mut self, problem: &Problem, guess: &Guess, derivatives: bool) -> bool {
        let Problem { r: r_trial, start, compliance, last, load } = problem;
        let last = (*last).min(N - 1);
        (self.set, self.e) = (guess.set, guess.e);
        let mut steps = 0;
        'sets: for _ in 0..CHANGES {
            let set = self.set;
            let first = (set.trailing_zeros() as usize).min(last);
            let mut slips = [0.0; N];
            for i in 0..N {
                slips[i] = if set >> i & 1 == 1 { 1.0 } else { 0.0 };
            }
            let known = self.known == (set, *load);
            self.known = (set, *load);
            let mut constant = [[0.0; N]; 2];
            for k in 0..2 {
                if !known {
                    for i in first..=last {
                        for m in 0..N {
                            self.k[k][i][m] = compliance[k][i][m] * slips[m];
                        }
                    }
                    invert(&mut self.k[k], set, [first, last]);
                }
                constant[k] = times(&self.k[k], set, [first, last], &r_trial[k]);
            }
            let (mut turn, mut reviewed, mut done, mut fresh) = (9.0f64, false, false, false);
            loop {
                for k in 0..2 {
                    let own = times(&self.k[k], set, [first, last], &self.e[k]);
                    for i in 0..N {
                        self.sigma[k][i] = slips[i] * (constant[k][i] - own[i]);
                    }
                }
                let (mut residual, mut diagonal) = ([0.0; N], [0.0; N]);
                let mut n = self.e;
                let ([e_x, e_y], [s_x, s_y]) = (self.e, self.sigma);
                for i in 0..N {
                    for k in 0..2 {
                        n[k][i] += self.shares[i] * start[k][i];
                    }
                    residual[i] = n[0][i] * s_y[i] - n[1][i] * s_x[i];
                    diagonal[i] = e_x[i] * s_x[i] + e_y[i] * s_y[i];
                }
                if done || (turn <= 0.1 && !reviewed) {
                    reviewed = true;
                    if self.review(problem, done) {
                        continue 'sets;
                    }
                }
                if (done && derivatives) || (!done && (turn > RENEWED || !fresh)) {
                    for m in first..=last {
                        for i in 0..N {
                            let own = if i == m { diagonal[i] } else { 0.0 };
                            let (k_x, k_y) = (self.k[0][m][i], self.k[1][m][i]);
                            self.inverse[m][i] = slips[i] * (n[0][i] * e_x[m] * k_y + n[1][i] * e_y[m] * k_x + own);
                        }
                    }
                    invert(&mut self.inverse, set, [first, last]);
                }
                if done {
                    return true;
                }
                let turns = times(&self.inverse, set, [first, last], &residual);
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
    fn descend(&mut self, problem: &Problem, derivatives: bool) {
        let Problem { r, start, compliance, last, .. } = problem;
        let (mut guess, mut sigma, mut sweeps, mut r) = (Guess { e: *r, set: 0 }, [[0.0; N]; 2], 0, *r);
        while sweeps < MOST_SWEEPS {
            for _ in 0..sweeps.max(SWEEPS) {
                for i in (0..=(*last).min(N - 1)).rev().map(|i| i.min(N - 1)) {
                    let a = [compliance[0][i][i], compliance[1][i][i]];
                    let g = [r[0][i] + a[0] * sigma[0][i], r[1][i] + a[1] * sigma[1][i]];
                    guess.set &= !(1 << i);
                    let share = self.shares[i];
                    let before = [share * start[0][i], share * start[1][i]];
                    let (mut size, mut e) = (0.0, [0.0; 2]);
                    if g[0] * g[0] + g[1] * g[1] > 1.0 {
                        (size, e) = own_slip(g, a, before);
                        guess.set |= 1 << i;
                        (guess.e[0][i], guess.e[1][i]) = (e[0], e[1]);
                    }
                    for k in 0..2 {
                        let now = size * (e[k] + before[k]);
                        let change = now - sigma[k][i];
                        sigma[k][i] = now;
                        for m in 0..N {
                            r[k][m] -= compliance[k][i][m] * change;
                        }
                    }
                }
            }
            if self.solve(problem, &guess, derivatives) {
                return;
            }
            sweeps = 4 * sweeps.max(SWEEPS);
        }
    }

    /// Points beyond the limit slip; at the end of an iteration, those whose slip is against the traction stick. Whether any has changed.
    #[inline(always)]
    fn review(&mut self, problem: &Problem, done: bool) -> bool {
        let before = self.set;
        self.relax(problem, 0);
        self.relax(problem, 1);
        for i in 0..=problem.last.min(N - 1) {
            let (x, y) = (self.r[0][i], self.r[1][i]);
            let square = x * x + y * y;
            if before >> i & 1 == 1 {
                let along = self.sigma[0][i] * self.e[0][i] + self.sigma[1][i] * self.e[1][i];
                let scale = self.k[0][i][i] + self.k[1][i][i];
                self.set &= !(Set::from(done && along < -BACKWARDS * scale) << i);
            } else if square > 1.0 + EXCESS {
                let length = square.sqrt();
                self.set |= 1 << i;
                (self.e[0][i], self.e[1][i]) = (x / length, y / length);
            }
        }
        self.set != before
    }
}

#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "parts of one step")]
fn find_kernel(
    slip: &mut Slip,
    t: &Rows,
    contact: &Contact<f64>,
    compliance: &Both<Matrix>,
    motion: &Motion<f64, f64>,
    trial: &Trial,
    old: &Values,
    derivatives: bool,
) {
    let start = [old[2], old[3]];
    let guesses = slip.guesses(trial, &start, &motion.by, contact.last);
    slip.slides = slid(&t, contact, &trial.v);
    for i in 0..N {
        let (r, from) = (both!(|k| trial.r[k][i]), both!(|k| start[k][i]));
        let over_limit = both!(|k| trial.over_limit[k][i]);
        slip.shares[i] = bend(&from, &r, &over_limit);
    }
    let problem = Problem { r: trial.r, start, compliance, last: contact.last, load: contact.now.load };
    let mut converged = false;
    for guess in &guesses {
        converged = converged || slip.solve(&problem, guess, derivatives);
    }
    if !converged {
        slip.descend(&problem, derivatives);
    }
    slip.relax(&problem, 0);
    slip.relax(&problem, 1);
    slip.start = start;
}

/// Σ x_m matrix[m][i] over the points of a set.
#[inline(always)]
fn times(matrix: &Matrix, set: Set, [first, last]: [usize; 2], x: &Row<f64>) -> Row<f64> {
    let mut y = [0.0; N];
    for m in first..=last {
        if set >> m & 1 == 1 {
            for i in 0..N {
                y[i] += x[m] * matrix[m][i];
            }
        }
    }
    y
}

/// The inverse of the block of a set, in place, by Gauss and Jordan. Single elements are chosen by their place in the lanes: a vector that
/// is loaded right after one of its elements was stored would wait for it.
#[inline(always)]
fn invert(matrix: &mut Matrix, set: Set, [first, last]: [usize; 2]) {
    for p in first..=last {
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
        for i in first..=last {
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

/// The slip of a point on its own, whose traction without slip is g: its size over that of `r + β r0`, and r, by Newton's method for |r| = 1.
fn own_slip(g: Both<f64>, a: Both<f64>, before: Both<f64>) -> (f64, Both<f64>) {
    let (mut size, mut e) = (0.0, g);
    for _ in 0..40 {
        let d = [1.0 / (1.0 + a[0] * size), 1.0 / (1.0 + a[1] * size)];
        e = [0, 1].map(|k| (g[k] - a[k] * size * before[k]) * d[k]);
        let square = e[0] * e[0] + e[1] * e[1];
        let slope = [0, 1].map(|k| e[k] * a[k] * d[k] * (e[k] + before[k]));
        let by = (square.sqrt() - 1.0) * square / (slope[0] + slope[1]).max(TINY);
        size += by;
        if by.abs() <= 1e-14 * size {
            break;
        }
    }
    let length = (e[0] * e[0] + e[1] * e[1]).sqrt();
    (size, e.map(|e| e / length))
}
