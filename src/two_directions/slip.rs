//! Coulomb's law at the points: `r = r* - A σ` with |r| <= 1 and σ = 0, or |r| = 1 and σ parallel to `n = r + β r0`.
//!
//! r* is the traction of the trial state, in which all springs stick, r0 that at the start of the step, and σ the slip. β turns the
//! direction of slip to its mean over the step: `β = u² (r·r0)/(1 + τ/3)`, `u = 2|r0|² - 1` (0 if negative), with the excess τ of the trial
//! state of the spring over its own limit. With K the inverse of A among the points that slip, `σ = K (r* - r)`, and the residual is
//! `n × σ`: Newton's method for the angles of r.

use super::tables::{Both, Matrix, N, Row};
use super::trial::{ROUNDING, Trial};
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
    /// The points; none if no solution was found.
    pub set: Set,
    /// r and σ of points that slip.
    pub e: Both<Row<f64>>,
    pub sigma: Both<Row<f64>>,
    /// K, and the inverse of the derivative of the residual by the angles as `[m][i]`.
    pub k: Both<Matrix>,
    pub inverse: Matrix,
    /// r of points that stick, r at the start of the step before, and τ.
    pub r: Both<Row<f64>>,
    pub start: Both<Row<f64>>,
    pub over: Row<f64>,
    pub bends: bool,
    /// Whether each spring returns to its own limit, as no solution was found.
    pub lost: bool,
    /// The points and the load of K.
    known: (Set, f64),
}

/// First directions, and points that slip.
#[derive(Clone, Copy)]
struct Guess {
    e: Both<Row<f64>>,
    set: Set,
    bends: bool,
}

/// What a solution starts from.
#[derive(Clone, Copy)]
struct Problem<'a> {
    trial: &'a Trial,
    compliance: &'a Both<Matrix>,
    start: &'a Both<Row<f64>>,
}

impl Slip {
    pub const NONE: Slip = Slip {
        set: 0,
        e: [[0.0; N]; 2],
        sigma: [[0.0; N]; 2],
        k: [[[0.0; N]; N]; 2],
        inverse: [[0.0; N]; N],
        r: [[0.0; N]; 2],
        start: [[0.0; N]; 2],
        over: [0.0; N],
        bends: true,
        lost: false,
        known: (0, 0.0),
    };

    #[inline(always)]
    pub fn contains(&self, i: usize) -> bool {
        self.set >> i & 1 == 1
    }

    /// The slip of a step, from r at its start.
    pub fn find(&mut self, trial: &Trial, compliance: &Both<Matrix>, start: &Both<Row<f64>>, derivatives: bool) {
        let slip = self;
        dispatch!(
            find_kernel,
            slip: &mut Slip, trial: &Trial, compliance: &Both<Matrix>, start: &Both<Row<f64>>, derivatives: bool => ()
        );
    }

    /// A step without slip.
    pub fn stick(&mut self, trial: &Trial, start: &Both<Row<f64>>) {
        (self.set, self.lost, self.r, self.start) = (0, false, trial.r, *start);
    }

    /// r of all points, from σ.
    #[inline(always)]
    fn relax(&mut self, Problem { trial, compliance, .. }: Problem, k: usize) {
        let mut r = trial.r[k];
        for m in 0..=trial.last.min(N - 1) {
            if self.contains(m) {
                let sigma = self.sigma[k][m];
                for i in 0..N {
                    r[i] -= compliance[k][m][i] * sigma;
                }
            }
        }
        self.r[k] = r;
    }

    /// A contact that slips on hardly turns; otherwise slip begins from the trial state. If neither converges, slip without β does.
    #[inline(always)]
    fn guesses(&mut self, Problem { trial, start, .. }: Problem) -> [Guess; 3] {
        let Trial { r, over_limit, by, last, .. } = trial;
        let (mut e, mut from_trial, mut continues, mut beyond) = (*r, *r, [0.0; N], [0.0; N]);
        let backwards = TURNS_BACK * (by[0] * by[0] + by[1] * by[1]).sqrt();
        for i in 0..N {
            let square = r[0][i] * r[0][i] + r[1][i] * r[1][i];
            beyond[i] = if square > ROUNDING { 1.0 } else { 0.0 };
            let (x, y) = (over_limit[0][i], over_limit[1][i]);
            let of_spring = x * x + y * y;
            let outside = of_spring > 1.0;
            let (x, y) = if outside { (x, y) } else { (r[0][i], r[1][i]) };
            let square = if outside { of_spring } else { square };
            let length = (if square > TINY { square } else { TINY }).sqrt();
            let (x, y) = (x / length, y / length);
            self.over[i] = if outside { length - 1.0 } else { 0.0 };
            (from_trial[0][i], from_trial[1][i]) = (x, y);
            let (r_x, r_y) = (start[0][i], start[1][i]);
            let slipped = r_x * r_x + r_y * r_y > SLIPPED;
            let near = slipped && x * r_x + y * r_y > NEAR;
            // A point that slipped in the step before as well turns on.
            let (b_x, b_y) = (self.start[0][i], self.start[1][i]);
            let (cos, sin) = (b_x * r_x + b_y * r_y, b_x * r_y - b_y * r_x);
            let square = cos * cos + sin * sin;
            let turns = slipped && cos > NEAR && square > SLIPPED;
            let (cos, sin) = if turns { (cos, sin) } else { (1.0, 0.0) };
            let (on_x, on_y) = (cos * r_x - sin * r_y, cos * r_y + sin * r_x);
            let square = on_x * on_x + on_y * on_y;
            let length = (if near { square } else { 1.0 }).sqrt();
            (e[0][i], e[1][i]) = (if near { on_x / length } else { x }, if near { on_y / length } else { y });
            continues[i] = if slipped && r_x * by[0] + r_y * by[1] >= backwards { 1.0 } else { 0.0 };
        }
        let (mut set, mut outside) = (0, 0);
        for i in (0..=(*last).min(N - 1)).rev() {
            outside |= Set::from(beyond[i] > 0.0) << i;
            // A point that slipped before continues if the next one outside does.
            let outer = set >> (i + 1) & 1 == 1;
            set |= Set::from(beyond[i] > 0.0 || self.over[i] > 0.0 || (continues[i] > 0.0 && outer)) << i;
        }
        let of_trial = Guess { e: from_trial, set: outside, bends: true };
        [Guess { e, set, bends: true }, of_trial, Guess { bends: false, ..of_trial }]
    }

    /// Newton's method from a guess; whether it converged. The inverse at the end is computed if derivatives are requested.
    #[inline(always)]
    fn solve(&mut self, problem: Problem, guess: &Guess, derivatives: bool) -> bool {
        let Problem { trial: Trial { r: r_trial, last, load, .. }, compliance, start } = problem;
        let last = (*last).min(N - 1);
        (self.set, self.e, self.bends) = (guess.set, guess.e, guess.bends);
        let mut factor = [0.0; N];
        for i in 0..N {
            let u = 2.0 * (start[0][i] * start[0][i] + start[1][i] * start[1][i]) - 1.0;
            let u = if guess.bends && u > 0.0 { u } else { 0.0 };
            factor[i] = u * u / (1.0 + self.over[i] * (1.0 / 3.0));
        }
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
                let (mut residual, mut diagonal, mut n) = ([0.0; N], [0.0; N], [[0.0; N]; 2]);
                let ([e_x, e_y], [s_x, s_y]) = (self.e, self.sigma);
                for i in 0..N {
                    let (x, y, r_x, r_y) = (e_x[i], e_y[i], start[0][i], start[1][i]);
                    let along = x * r_x + y * r_y;
                    let f = if along > 0.0 { factor[i] } else { 0.0 };
                    let (beta, slope) = (f * along, f * (x * r_y - y * r_x));
                    (n[0][i], n[1][i]) = (x + beta * r_x, y + beta * r_y);
                    residual[i] = n[0][i] * s_y[i] - n[1][i] * s_x[i];
                    diagonal[i] = s_x[i] * (slope * r_y + x) - s_y[i] * (slope * r_x - y);
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

    /// Points beyond the limit slip; at the end of an iteration, those whose slip is against the traction stick. Whether any has changed.
    #[inline(always)]
    fn review(&mut self, problem: Problem, done: bool) -> bool {
        let before = self.set;
        self.relax(problem, 0);
        self.relax(problem, 1);
        for i in 0..=problem.trial.last.min(N - 1) {
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
fn find_kernel(slip: &mut Slip, trial: &Trial, compliance: &Both<Matrix>, start: &Both<Row<f64>>, derivatives: bool) {
    let problem = Problem { trial, compliance, start };
    let guesses = slip.guesses(problem);
    slip.lost = true;
    for guess in guesses {
        if slip.solve(problem, &guess, derivatives) {
            slip.lost = false;
            break;
        }
    }
    slip.set = if slip.lost { 0 } else { slip.set };
    slip.r = trial.r;
    if !slip.lost {
        slip.relax(problem, 0);
        slip.relax(problem, 1);
    }
    slip.start = *start;
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
