//! Slip at the points of a contact: Coulomb's law with the direction of slip, solved by Newton's method for the angles.
//!
//! The slip σ_i at the points relaxes the springs from their trial state v*. With U the map from tractions to springs, from the innermost
//! slipping point on, `v = U q` and `σ = U' w (v* - U q)`. A point sticks, σ_i = 0 and |q_i| <= p_i, or slips:
//!
//! ```text
//! q_i = p_i e_i,    σ_i || n_i = e_i + β_i r_i,    β_i = u_i² max(0, e_i·r_i)/(1 + τ_i/3),    u_i = max(0, 2 |r_i|² - 1)
//! ```
//!
//! where r_i is the traction over the pressure at the start of the step. A point that slips throughout a small step, |r_i| = 1, slips in the
//! mean direction of both ends: second order in the step. In a long step the direction follows the exponential `e^-τ`, the mean of which
//! gives the factor 1 - τ/3 to first order; τ is the overshoot of the trial state, relative to the limit of the spring. On a straight
//! path all directions agree and β has no effect. β and its derivatives vanish for |r_i|² <= 1/2.
//!
//! With `S = U' w U` the residual of a point is σ × n, and its Jacobian by the angles of e
//!
//! ```text
//! σ = U' w v* - S q,    J_im = p_m (n_x,i S^y_im e_x,m + n_y,i S^x_im e_y,m) + δ_im (σ × dn/dθ)
//! ```
//!
//! a positive definite matrix and small changes: it is inverted in place without pivoting. Points that stick between slipping ones are
//! eliminated from S.

use super::edge::Edge;
use super::springs::{Both, Matrix, Row, Springs, add, dot, largest};
use crate::shape::TINY;

/// Newton's steps, and changes of the set of slipping points, after which each spring returns to its own limit.
const STEPS: usize = 60;
const CHANGES: usize = 12;
/// Newton's steps after which the set is reviewed, which is at the end otherwise.
const REVIEW: usize = 15;
/// The error of the angles at which the iteration ends: some rounding errors, amplified by the condition of J.
const CONVERGED: f64 = 1e-12;
/// Turns up to this one show which further points slip.
const CLOSE: f64 = 0.1;
/// Turns up to this one need no new inverse.
const RENEWED: f64 = 1e-2;
/// The largest change of an angle.
pub(crate) const LARGEST_TURN: f64 = 0.8;
/// A turn of an iteration that diverges.
pub(crate) const LOST: f64 = 1e4;
/// Excess of the square of a traction by which a point that sticks may round.
const EXCESS: f64 = 1e-10;
/// Slip against the traction, relative to the terms whose difference it is, that is a rounding error.
const BACKWARDS: f64 = 1e-12;

/// Points as bits.
pub(crate) type Set = u32;

/// What the slip depends on besides the shells.
pub(crate) struct Problem<'a, const N: usize> {
    pub springs: &'a Springs<'a>,
    pub edge: &'a Edge<N>,
    /// Stiffnesses, and v*.
    pub stiffness: &'a Both<Row<N>>,
    pub trial: &'a Both<Row<N>>,
    /// r_i, and τ_i.
    pub start: &'a Both<Row<N>>,
    pub overshoot: &'a Row<N>,
}

/// Where Newton's method begins: directions of the tractions, points that slip, the turn from which on it is given up, and the share of β:
/// without it slip follows the traction at the end of the step alone, a convex problem.
#[derive(Clone, Copy)]
pub(crate) struct Guess<const N: usize> {
    pub e: Both<Row<N>>,
    pub set: Set,
    pub largest_turn: f64,
    pub bends: f64,
}

/// The slip at all points, and what its derivatives need.
#[derive(Debug, Clone, Copy)]
#[repr(align(32))]
pub(crate) struct Slip<const N: usize> {
    /// S after elimination, and the inverse of J as `[m][i]`.
    pub square: Both<Matrix<N>>,
    pub inverse: Matrix<N>,
    /// All that slip, also as 1 and 0.
    pub slips: Row<N>,
    /// Direction of the traction, of the slip, and σ.
    pub e: Both<Row<N>>,
    pub n: Both<Row<N>>,
    pub sigma: Both<Row<N>>,
    /// Tractions of the points from the first one on.
    pub q: Both<Row<N>>,
    /// β/(e·r).
    pub per_along: Row<N>,
    /// Reciprocals of the pivots of the points that were eliminated, whose rows of S are those of the elimination, and the constants there.
    pub pivots: Both<Row<N>>,
    constants: Both<Row<N>>,
    pub points: [usize; N],
    pub count: usize,
    /// The innermost point that slips.
    pub first: usize,
    pub set: Set,
    pub converged: bool,
}

impl<const N: usize> Slip<N> {
    pub const NONE: Slip<N> = Slip {
        square: [[[0.0; N]; N]; 2],
        inverse: [[0.0; N]; N],
        slips: [0.0; N],
        e: [[0.0; N]; 2],
        n: [[0.0; N]; 2],
        sigma: [[0.0; N]; 2],
        q: [[0.0; N]; 2],
        per_along: [0.0; N],
        pivots: [[0.0; N]; 2],
        constants: [[0.0; N]; 2],
        points: [0; N],
        count: 0,
        first: N,
        set: 0,
        converged: false,
    };

    #[inline(always)]
    pub fn contains(&self, i: usize) -> bool {
        self.set >> i & 1 == 1
    }

    /// Slip at a point, with the traction in a direction.
    #[inline(always)]
    pub fn begin(&mut self, i: usize, x: f64, y: f64) {
        self.set |= 1 << i;
        (self.e[0][i], self.e[1][i]) = (x, y);
    }

    /// Solves the problem: springs at the end. The inverse of J there is computed if it is requested.
    #[inline(always)]
    pub fn solve(&mut self, problem: &Problem<N>, guess: &Guess<N>, inverse: bool, end: &mut Both<Row<N>>) {
        let Problem { edge, start, overshoot, .. } = *problem;
        let last = edge.last.min(N - 1);
        (self.e, self.set, self.count, self.converged) = (guess.e, guess.set, 0, false);
        for i in 0..N {
            let square = start[0][i] * start[0][i] + start[1][i] * start[1][i];
            let u = 2.0 * square - 1.0;
            let u = if u > 0.0 { u } else { 0.0 };
            self.per_along[i] = guess.bends * u * u / (1.0 + overshoot[i] * (1.0 / 3.0));
        }
        let (mut changes, mut steps) = (0, 0);
        'sets: while changes <= CHANGES && self.set != 0 {
            changes += 1;
            let constant = self.prepare(problem);
            let first = self.first;
            let (mut turn, mut before, mut fresh, mut reviewed) = (9.0f64, 9.0, false, false);
            let mut done = false;
            loop {
                let mut q = self.e;
                for k in 0..2 {
                    for i in 0..N {
                        q[k][i] *= self.slips[i] * edge.pressure[i];
                    }
                }
                let (residual, diagonal) = self.residual(&constant, &q, start, last);
                if done || (turn <= CLOSE && !reviewed) {
                    if done || first > 0 || self.count > 0 {
                        self.springs(problem, &q, end);
                        if self.review(problem, &constant, end, done) {
                            continue 'sets;
                        }
                    }
                    reviewed = true;
                    if done && !inverse {
                        self.converged = true;
                        return;
                    }
                }
                if done || turn > RENEWED || turn > 0.1 * before {
                    self.linearise(&q, &diagonal, first, last);
                    invert(&mut self.inverse, first, last);
                    fresh = true;
                }
                if done {
                    self.converged = true;
                    return;
                }
                let mut turns = [0.0; N];
                for m in first..=last {
                    add(&mut turns, residual[m], &self.inverse[m]);
                }
                before = turn;
                let mut sizes = [0.0; N];
                for i in 0..N {
                    turns[i] *= self.slips[i];
                    sizes[i] = turns[i].abs();
                }
                turn = largest(&sizes);
                steps += 1;
                if steps > STEPS || turn > guess.largest_turn {
                    return;
                }
                // The angle of a point that hardly slips is undetermined: it may have to stick.
                if steps % REVIEW == 0 {
                    self.springs(problem, &q, end);
                    if self.review(problem, &constant, end, true) {
                        continue 'sets;
                    }
                }
                self.rotate(&turns, LARGEST_TURN / turn.max(LARGEST_TURN));
                // Newton's method converges quadratically with a new inverse, linearly with an old one.
                let rate = if fresh { turn } else { turn / before.max(TINY) };
                done = turn * rate.min(1.0) <= CONVERGED;
                fresh = false;
            }
        }
    }

    /// e turned by angles, by Cayley's formula.
    #[inline(always)]
    fn rotate(&mut self, turns: &Row<N>, damping: f64) {
        let (mut e_x, mut e_y) = (self.e[0], self.e[1]);
        for i in 0..N {
            let half = 0.5 * damping * turns[i];
            let square = half * half;
            let scale = 1.0 / (1.0 + square);
            let (cosine, sine) = ((1.0 - square) * scale, 2.0 * half * scale);
            let (x, y) = (e_x[i], e_y[i]);
            e_x[i] = cosine * x - sine * y;
            e_y[i] = cosine * y + sine * x;
        }
        self.e = [e_x, e_y];
    }

    /// S and `U' w v*` of the set.
    #[inline(always)]
    fn prepare(&mut self, problem: &Problem<N>) -> Both<Row<N>> {
        let Problem { springs, edge, stiffness, trial, .. } = *problem;
        let last = edge.last.min(N - 1);
        let first = (self.set.trailing_zeros() as usize).min(last);
        (self.first, self.count) = (first, 0);
        for i in 0..N {
            self.slips[i] = if self.set >> i & 1 == 1 { 1.0 } else { 0.0 };
        }
        let mut constant = [[0.0; N]; 2];
        for k in 0..2 {
            let (mut rows, mut weighted) = ([[0.0; N]; N], [[0.0; N]; N]);
            let mut sum = [0.0; N];
            for j in first..=last {
                let row = edge.displacement(springs, k, j);
                let w = stiffness[k][j];
                let mut heavy = [0.0; N];
                for i in 0..N {
                    heavy[i] = w * row[i];
                    sum[i] += heavy[i] * trial[k][j];
                }
                (rows[j], weighted[j]) = (row, heavy);
            }
            constant[k] = sum;
            for i in first..=last {
                let mut sum = [0.0; N];
                for j in first..=i {
                    let factor = weighted[j][i];
                    for m in 0..N {
                        sum[m] += factor * rows[j][m];
                    }
                }
                self.square[k][i] = sum;
            }
        }
        for t in first..=last {
            if !self.contains(t) {
                self.eliminate(t, last, &mut constant);
            }
        }
        constant
    }

    /// Eliminates a point that sticks.
    #[inline(always)]
    fn eliminate(&mut self, t: usize, last: usize, constant: &mut Both<Row<N>>) {
        for k in 0..2 {
            let row = self.square[k][t];
            let (pivot, there) = (1.0 / row[t].max(TINY), constant[k][t]);
            for i in self.first..=last {
                // Rows of points that were eliminated before remain.
                if i > t || self.contains(i) {
                    let factor = row[i] * pivot;
                    add(&mut self.square[k][i], -factor, &row);
                    constant[k][i] -= factor * there;
                    self.square[k][i][t] = 0.0;
                }
            }
            self.square[k][t] = row;
            constant[k][t] = 0.0;
            self.pivots[k][t] = pivot;
            self.constants[k][t] = there;
        }
        self.points[self.count.min(N - 1)] = t;
        self.count += 1;
    }

    /// Finds σ and n for the tractions q: the residuals, and the diagonal terms of J.
    #[inline(always)]
    fn residual(
        &mut self,
        constant: &Both<Row<N>>,
        q: &Both<Row<N>>,
        start: &Both<Row<N>>,
        last: usize,
    ) -> (Row<N>, Row<N>) {
        for k in 0..2 {
            let mut sigma = constant[k];
            for m in self.first..=last {
                for i in 0..N {
                    sigma[i] -= q[k][m] * self.square[k][m][i];
                }
            }
            self.sigma[k] = sigma;
        }
        let (mut residual, mut diagonal) = ([0.0; N], [0.0; N]);
        let ([e_x, e_y], [s_x, s_y]) = (self.e, self.sigma);
        let (mut n_x, mut n_y) = ([0.0; N], [0.0; N]);
        for i in 0..N {
            let (x, y, r_x, r_y) = (e_x[i], e_y[i], start[0][i], start[1][i]);
            let along = x * r_x + y * r_y;
            let factor = if along > 0.0 { self.per_along[i] } else { 0.0 };
            let (beta, slope) = (factor * along, factor * (x * r_y - y * r_x));
            (n_x[i], n_y[i]) = (x + beta * r_x, y + beta * r_y);
            residual[i] = self.slips[i] * (s_y[i] * n_x[i] - s_x[i] * n_y[i]);
            let turned = s_x[i] * (slope * r_y + x) - s_y[i] * (slope * r_x - y);
            diagonal[i] = if self.slips[i] > 0.0 { turned } else { 1.0 };
        }
        self.n = [n_x, n_y];
        (residual, diagonal)
    }

    /// J as `[m][i]`.
    #[inline(always)]
    fn linearise(&mut self, q: &Both<Row<N>>, diagonal: &Row<N>, first: usize, last: usize) {
        let [n_x, n_y] = self.n;
        for m in first..=last {
            let (q_x, q_y) = (q[0][m], q[1][m]);
            let (s_x, s_y) = (self.square[0][m], self.square[1][m]);
            let mut row = [0.0; N];
            for i in 0..N {
                let own = if i == m { diagonal[i] } else { 0.0 };
                row[i] = n_x[i] * (q_x * s_y[i]) + n_y[i] * (q_y * s_x[i]) + own;
            }
            self.inverse[m] = row;
        }
    }

    /// Springs at the end, and the tractions of the points between slipping ones.
    #[inline(always)]
    fn springs(&mut self, problem: &Problem<N>, q: &Both<Row<N>>, end: &mut Both<Row<N>>) {
        let last = problem.edge.last.min(N - 1);
        self.q = *q;
        for k in 0..2 {
            for n in (0..self.count.min(N)).rev() {
                let t = self.points[n].min(N - 1);
                self.q[k][t] = 0.0;
                self.q[k][t] = self.pivots[k][t] * (self.constants[k][t] - dot(&self.square[k][t], &self.q[k]));
            }
            end[k] = problem.trial[k];
            for j in self.first..=last {
                end[k][j] = dot(&problem.edge.displacement(problem.springs, k, j), &self.q[k]);
            }
        }
    }

    /// Points beyond Coulomb's limit slip; at the end of an iteration, those whose slip is against the traction stick. Whether any has
    /// changed.
    #[inline(always)]
    fn review(&mut self, problem: &Problem<N>, constant: &Both<Row<N>>, end: &Both<Row<N>>, done: bool) -> bool {
        let edge = problem.edge;
        let before = self.set;
        if done {
            for i in 0..N {
                let along = self.sigma[0][i] * self.e[0][i] + self.sigma[1][i] * self.e[1][i];
                let rounding = BACKWARDS * (constant[0][i].abs() + constant[1][i].abs());
                let sticks = self.slips[i] > 0.0 && along < -rounding;
                self.set &= !(Set::from(sticks) << i);
            }
        }
        if self.first > 0 || self.count > 0 {
            let q = [edge.tractions(problem.springs, 0, &end[0]), edge.tractions(problem.springs, 1, &end[1])];
            for i in 0..N {
                let square = q[0][i] * q[0][i] + q[1][i] * q[1][i];
                let outside = square > edge.pressure[i] * edge.pressure[i] * (1.0 + EXCESS);
                if outside && i <= edge.last && before >> i & 1 == 0 {
                    let per_length = 1.0 / square.max(TINY).sqrt();
                    self.begin(i, q[0][i] * per_length, q[1][i] * per_length);
                }
            }
        }
        self.set != before
    }
}

/// The inverse of the block from `first` to `last`, in place, by Gauss and Jordan. Single elements are chosen by their place in the lanes:
/// a vector that is loaded right after one of its elements was stored would wait for it.
#[inline(always)]
fn invert<const N: usize>(matrix: &mut Matrix<N>, first: usize, last: usize) {
    for p in first..=last {
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
