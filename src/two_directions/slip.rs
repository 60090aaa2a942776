//! The slip of a step: twice Coulomb's law at the points, `r = r* - A σ` with |r| <= l and σ = 0, or |r| = l and σ parallel to r.
//!
//! The first time in the middle of the step, with the limits l of the load there. What slipped until then slips once more until the end,
//! where the second time returns the tractions to their limits: the midpoint rule. A contact that slides far takes the end for the middle.
//!
//! With K the inverse of A among the points that slip and e the direction of r, `σ = K (r* - l e)`, and the residual is `e × σ`: Newton's
//! method for the angles of e. Slip without gaps, of all points from one on to the edge, has the springs `v = C⁻¹ l e` there, and
//! `K = C⁻¹' w C⁻¹`, free of cancellation. σ is the minimum of the strictly convex `σ'Aσ/2 - σ·r* + Σ l |σ|`: there is one, it depends
//! continuously on r* and l, and sweeps of the points, each towards its own minimum, find the points that slip if Newton's method does not.

use super::contact::Contact;
use super::matrix::{dot, invert, largest, times};
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
/// Changes of angles: the one that would be next, at the end, and that up to which the inverse is kept.
const CONVERGED: f64 = 1e-12;
const RENEWED: f64 = 1e-2;
/// The square of a larger one could overflow.
const LOST: f64 = 1e100;
/// Of two changes that are at most the first number, with a new inverse each, the second one is a rounding error from this part on.
const SMALL_TURN: f64 = 1e-9;
const STALLED: f64 = 0.5;
/// Sweeps of the points before Newton's method is tried again, and attempts, of which the first one is without: of random slips with rough
/// layers, one of 40,000 needs sweeps, and of 7e7 none needed them twice.
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
/// |r|² at the start, over that of the limit, from which on a point slipped then: after a change of the load it is less exact.
const HELD: f64 = 0.998;
/// Both slips of a step.
#[derive(Default)]
pub(crate) struct Slips {
    pub middle: Slip,
    pub end: Slip,
    /// The part in which the contact slides far.
    pub slides: f64,
    /// The trial state, and the springs at the end.
    pub trial: Trial,
    pub v: Both<Row<f64>>,
    pub fine: FineSlips,
    /// Tangents of the angles by which points turned until the middle, and by which the slip of the end turned them: first guesses of the next
    /// step.
    pub turned: Both<Row<f64>>,
}

/// Fine springs, of which each slips on its own: e, the direction of v/limit, and 1/(x y |v/limit|) with the limits x and y, negative for a
/// spring that sticks.
#[derive(Default)]
pub(crate) struct FineSlips([[Row<f64>; FINE / N]; 3]);

impl FineSlips {
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
#[derive(Default)]
#[repr(align(32))]
pub(crate) struct Slip {
    pub set: Set,
    /// 1 for the points of the set, 0 for others.
    slips: Row<f64>,
    /// The limits, the directions of r and σ.
    pub level: Row<f64>,
    pub e: Both<Row<f64>>,
    pub sigma: Both<Row<f64>>,
    /// The springs after slip, and r of the points that stick.
    pub v: Both<Row<f64>>,
    r: Both<Row<f64>>,
    /// K, and the inverse of the derivative of the residual by the angles times the limits: both are symmetric.
    pub k: Both<Matrix>,
    pub inverse: Matrix,
    /// The points and the load of K, and those of the inverse.
    known: (Set, f64),
    inverted: (Set, f64),
}

/// First directions, points that slip, and those beyond their limits.
#[derive(Clone, Copy)]
struct Guess {
    e: Both<Row<f64>>,
    set: Set,
    beyond: Set,
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

impl Problem<'_> {
    /// Points beyond their limits, and directions: points of a mask turn by these tangents from other tractions that are not far.
    #[inline(always)]
    fn guess(&self, level: &Row<f64>, from: &Both<Row<f64>>, mask: &Row<f64>, turned: &Row<f64>) -> Guess {
        let ([mut x, mut y], mut beyond) = (self.r, [0.0; N]);
        for i in 0..N {
            let (r_x, r_y) = (from[0][i], from[1][i]);
            let square = x[i] * x[i] + y[i] * y[i];
            beyond[i] = if square > ROUNDING * level[i] * level[i] { 1.0 } else { 0.0 };
            let near = mask[i] * (x[i] * r_x + y[i] * r_y) > NEAR * square.sqrt();
            let (on_x, on_y) = (r_x - turned[i] * r_y, r_y + turned[i] * r_x);
            let (r_x, r_y) = (if near { on_x } else { x[i] }, if near { on_y } else { y[i] });
            let square = r_x * r_x + r_y * r_y;
            let per = 1.0 / (if square > TINY { square } else { TINY }).sqrt();
            (x[i], y[i]) = (r_x * per, r_y * per);
        }
        let beyond = points(&beyond, self.end);
        Guess { e: [x, y], set: beyond, beyond }
    }

    /// From the middle of a step on to its trial state, slipping as until the middle.
    #[inline(always)]
    fn go_on(&mut self, middle: &Slip, trial: &Trial, theta: f64) {
        let (v, r, per) = (self.v, self.r, 1.0 / theta);
        (self.v, self.r) = (trial.v, trial.r);
        if middle.set == 0 {
            return;
        }
        for k in 0..2 {
            for i in 0..N {
                self.v[k][i] -= (v[k][i] - middle.v[k][i]) * per;
                let slipped = trial.start[k][i] + (middle.level[i] * middle.e[k][i] - trial.start[k][i]) * per;
                let sticks = self.r[k][i] - (r[k][i] - middle.r[k][i]) * per;
                self.r[k][i] = if middle.slips[i] > 0.0 { slipped } else { sticks };
            }
        }
    }
}

/// The points up to an end with positive values.
#[inline(always)]
fn points(values: &Row<f64>, end: usize) -> Set {
    let mut set = 0;
    for i in 0..end.min(N) {
        set |= Set::from(values[i] > 0.0) << i;
    }
    set
}

impl Slips {
    /// Whether nothing slips.
    pub fn is_empty(&self) -> bool {
        self.middle.set | self.end.set == 0
    }

    /// The slip of a step whose trial state is known, from the springs at its start, and what derivatives need if they are requested.
    pub fn find(
        &mut self,
        t: &Rows,
        contact: &Contact<f64>,
        inverse: &Both<Matrix>,
        motion: &Motion<f64, f64>,
        old: &Values,
        derivatives: bool,
    ) {
        let Slips { middle, end: last, slides, trial, v, fine, turned } = self;
        dispatch!({
            let end = (contact.last + 1).min(N);
            (middle.set, last.set, *slides, *v) = (0, 0, 0.0, trial.v);
            fine.find(t, contact, motion, old);
            // Under a constant load, the middle sticks if the end does.
            if trial.sticks && motion.constant_load {
                return;
            }
            *slides = slid(&t, contact, &trial.v, &trial.v);
            let theta = 0.5 * (1.0 + *slides);
            // The limits, and the points that slipped at the start.
            let before = limits_before(&t, contact, contact.now.shift[0] - motion.before[0]);
            let (start, mut slipped) = (&trial.start, [0.0; N]);
            last.level = [1.0; N];
            for i in 0..N {
                let square = start[0][i] * start[0][i] + start[1][i] * start[1][i];
                slipped[i] = if square > HELD * before[i] * before[i] { 1.0 } else { 0.0 };
                middle.level[i] = before[i] + theta * (1.0 - before[i]);
            }
            let mut problem = Problem { v: trial.v, r: *start, t, contact, inverse, end };
            for k in 0..2 {
                for i in 0..N {
                    problem.r[k][i] += theta * (trial.r[k][i] - start[k][i]);
                    problem.v[k][i] = trial.old[k][i] + theta * (trial.v[k][i] - trial.old[k][i]);
                }
            }
            let mut guess = problem.guess(&middle.level, start, &slipped, &turned[0]);
            // Points that slipped at the start and have one outside that slips continue.
            let slipped = points(&slipped, end);
            for _ in 0..N {
                guess.set |= guess.set >> 1 & slipped;
            }
            for stage in 0..2 {
                let (slip, other) = if stage == 0 { (&mut *middle, &mut *last) } else { (&mut *last, &mut *middle) };
                if guess.beyond != 0 {
                    slip.find(other, &problem, guess, derivatives);
                }
                *v = if slip.set == 0 { problem.v } else { slip.v };
                turned[stage] = slip.turned(if stage == 0 { start } else { &problem.r });
                if stage > 0 || (theta >= 1.0 && slip.set.count_ones() as usize == end) {
                    // The middle of a contact that slides far is its end.
                    break;
                }
                problem.go_on(slip, trial, theta);
                let from = problem.r;
                guess = problem.guess(&other.level, &from, &[1.0; N], &turned[1]);
                guess.set |= slip.set;
            }
        });
    }
}

impl Slip {
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

    /// K of the points that slip, and their load, unless it is known.
    #[inline(always)]
    fn stiffen(&mut self, other: &Slip, problem: &Problem, of: (Set, f64)) {
        if self.known == of {
            return;
        }
        self.known = of;
        if other.known == of {
            self.k = other.k;
            return;
        }
        let &Problem { t, contact, inverse, end, .. } = problem;
        let end = end.min(N);
        let first = (self.set.trailing_zeros() as usize).min(end);
        if self.without_gaps(end) {
            for k in 0..2 {
                let mut scaled = [[0.0; N]; N];
                for j in first..end {
                    let w = contact.stiffness(&t, k, j);
                    for m in 0..N {
                        scaled[j][m] = w * inverse[k][j][m];
                    }
                }
                for m in 0..N {
                    let mut sum = [0.0; N];
                    for j in first..(m + 1).min(end) {
                        for i in 0..N {
                            sum[i] += scaled[j][m] * inverse[k][j][i];
                        }
                    }
                    self.k[k][m] = sum;
                }
            }
            return;
        }
        for k in 0..2 {
            let (a, mut diagonal) = (compliance(problem, k, first), [0.0; N]);
            self.k[k] = [[0.0; N]; N];
            for i in 0..N {
                diagonal[i] = if self.contains(i) { 0.0 } else { 1.0 };
                for m in 0..N {
                    self.k[k][i][m] = if self.contains(i) && self.contains(m) { a[i][m] } else { 0.0 };
                }
            }
            invert(&mut self.k[k], &diagonal, [first, end]);
        }
    }

    /// The slip of a problem, from a guess.
    #[inline(always)]
    fn find(&mut self, other: &Slip, problem: &Problem, mut guess: Guess, derivatives: bool) {
        let mut swept = ([[0.0; N]; 2], problem.r);
        for _ in 0..MOST_ATTEMPTS {
            if self.solve(other, problem, &guess, derivatives) {
                return;
            }
            sweep(problem, &self.level, &mut swept, &mut guess);
        }
    }

    /// Tangents of the angles from tractions to those of points that slip, unless these are far from there.
    #[inline(always)]
    fn turned(&self, from: &Both<Row<f64>>) -> Row<f64> {
        let mut turned = [0.0; N];
        for i in 0..N {
            let (x, y, e_x, e_y) = (from[0][i], from[1][i], self.e[0][i], self.e[1][i]);
            let (cos, sin) = (x * e_x + y * e_y, x * e_y - y * e_x);
            let near = if cos > NEAR { cos } else { NEAR };
            turned[i] = if self.contains(i) && cos > NEAR { sin / near } else { 0.0 };
        }
        turned
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
            let points = [(set.trailing_zeros() as usize).min(end), end];
            let mut per_level = [0.0; N];
            for i in 0..N {
                self.slips[i] = if self.contains(i) { 1.0 } else { 0.0 };
                per_level[i] = self.slips[i] / self.level[i];
            }
            let of = (set, contact.now.load);
            self.stiffen(other, problem, of);
            // The inverse of the step before holds while changes of angles fall to a tenth.
            let (mut turn, mut done, mut holds) = (f64::MAX, false, self.inverted == of);
            let mut renewed = [false; 2];
            loop {
                let [residual, along] = self.residual(r_trial, points);
                let undetermined = steps % REVIEW == REVIEW - 1;
                if (done || undetermined) && self.review(problem) {
                    continue 'sets;
                }
                renewed = [renewed[1], !holds];
                if (done && derivatives) || (!done && renewed[1]) {
                    self.invert(&along, points);
                    self.inverted = of;
                }
                if done {
                    return true;
                }
                let [mut turns] = times([&self.inverse], points, &[residual]);
                for i in 0..N {
                    turns[i] *= per_level[i];
                }
                let before = turn;
                turn = largest(&turns);
                steps += 1;
                if steps > STEPS || turn > LOST {
                    return false;
                }
                self.turn(&turns);
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

    /// The slip of these directions, across and along them: the former is the residual.
    #[inline(always)]
    fn residual(&mut self, r_trial: &Both<Row<f64>>, points: [usize; 2]) -> [Row<f64>; 2] {
        let ([e_x, e_y], mut excess) = (self.e, *r_trial);
        for k in 0..2 {
            for i in 0..N {
                excess[k][i] = self.slips[i] * (excess[k][i] - self.level[i] * self.e[k][i]);
            }
        }
        self.sigma = times([&self.k[0], &self.k[1]], points, &excess);
        let ([s_x, s_y], mut across, mut along) = (self.sigma, [0.0; N], [0.0; N]);
        for i in 0..N {
            across[i] = e_x[i] * s_y[i] - e_y[i] * s_x[i];
            along[i] = e_x[i] * s_x[i] + e_y[i] * s_y[i];
        }
        [across, along]
    }

    /// The inverse of the derivative of the residual.
    #[inline(always)]
    fn invert(&mut self, along: &Row<f64>, [first, end]: [usize; 2]) {
        let ([mut x, mut y], mut diagonal) = (self.e, [1.0; N]);
        for i in 0..N {
            (x[i], y[i]) = (self.slips[i] * x[i], self.slips[i] * y[i]);
            diagonal[i] = if self.slips[i] > 0.0 { along[i] / self.level[i] } else { 1.0 };
        }
        for m in 2 * (first / 2)..N {
            let (k_x, k_y, mut row) = (self.k[0][m], self.k[1][m], [0.0; N]);
            for i in 0..N {
                row[i] = x[i] * (x[m] * k_y[i]) + y[i] * (y[m] * k_x[i]);
            }
            self.inverse[m] = row;
        }
        invert(&mut self.inverse, &diagonal, [first, end]);
    }

    /// Turns the directions, by Cayley's formula.
    #[inline(always)]
    fn turn(&mut self, turns: &Row<f64>) {
        let [mut x, mut y] = self.e;
        for i in 0..N {
            let half = 0.5 * turns[i];
            let scale = 1.0 / (1.0 + half * half);
            let (cos, sin) = ((1.0 - half * half) * scale, 2.0 * half * scale);
            (x[i], y[i]) = (cos * x[i] - sin * y[i], cos * y[i] + sin * x[i]);
        }
        self.e = [x, y];
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

/// Sweeps of the points, each of which slips towards its own minimum: σ and r, from which a guess follows.
#[cold]
#[inline(never)]
fn sweep(problem: &Problem, level: &Row<f64>, (sigma, r): &mut (Both<Row<f64>>, Both<Row<f64>>), guess: &mut Guess) {
    let compliance = both!(|k| compliance(problem, k, 0));
    for _ in 0..SWEEPS {
        for i in (0..problem.end.min(N)).rev() {
            // The softer direction bounds the curvature in both.
            let (a, limit) = (compliance[0][i][i].max(compliance[1][i][i]), level[i]);
            let g = [r[0][i] + a * sigma[0][i], r[1][i] + a * sigma[1][i]];
            let length = (g[0] * g[0] + g[1] * g[1]).sqrt();
            guess.set &= !(1 << i);
            let mut now = [0.0; 2];
            if length > limit {
                (guess.e[0][i], guess.e[1][i]) = (g[0] / length, g[1] / length);
                now = guess.e.map(|e| e[i] * ((length - limit) / a));
                guess.set |= 1 << i;
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
