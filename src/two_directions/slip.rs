//! Slip at the points of a contact: Coulomb's law with the direction of slip, solved by Newton's method.
//!
//! With `B` the map from the springs z to the tractions q, the slip σ_i at the points relaxes the springs, `z = z* - B'σ` from the trial
//! state z*. A point sticks, σ_i = 0 and |q_i| <= p_i, or slips:
//!
//! ```text
//! q_i = p_i e_i,      σ_i || e_i + β_i r_i,       β_i = |r_i|⁸ max(0, cos(e_i, r_i))/(1 + τ_i/3)
//! ```
//!
//! where r_i is the traction over the pressure at the start of the step. A point that slips throughout a small step, |r_i| = 1, slips in the mean
//! direction of both ends: second order in the step. In a long step the direction follows the exponential `e^-τ`, the mean of which
//! gives the factor 1 - τ/3 to first order; τ is the overshoot of the trial state, relative to the limit of the spring. On a straight
//! path all directions agree and β has no effect.
//!
//! For slipping points `σ = S (B z* - q)` with S the inverse of `B B'` on them, so the angles of e_i are the only unknowns.

use super::columns::{add_row, row_mut, scale};
use super::edge::Map;
use crate::element::springs::{Both, Row, SPRINGS, add, dot};
use crate::shape::TINY;
use core::f64::consts::PI;

pub(crate) type Matrix = [Row; SPRINGS];

/// Newton's steps, and changes of the set of slipping points.
const STEPS: usize = 60;
const CHANGES: usize = 8;
/// A set of points that has not converged after this number of steps is reviewed anyway.
const STALLED: usize = 10;
/// The angle between σ and its required direction at which the iteration ends: a rounding error, amplified by the condition of S.
const CONVERGED: f64 = 1e-11;
/// The slip, relative to the terms whose difference it is, below which only that difference converges.
const ROUNDING: f64 = 1e-3;
/// A next turn below that is a rounding error.
const SMALL_TURN: f64 = 1e-12;
/// Turns up to this one need no new factors of the Jacobian, and show which further points slip.
const CLOSE: f64 = 1e-1;
/// The largest change of an angle.
const LARGEST_TURN: f64 = 0.8;
/// Overshoot from which on the springs lose more than three digits to cancellation.
const LONG_SLIP: f64 = 1e3;

#[inline(always)]
pub(crate) fn product(one: &Both<f64>, two: &Both<f64>) -> f64 {
    one[0] * two[0] + one[1] * two[1]
}

/// Values at a point.
#[inline(always)]
pub(crate) fn at(rows: &Both<Row>, i: usize) -> Both<f64> {
    [rows[0][i], rows[1][i]]
}

/// What the slip depends on besides the map.
pub(crate) struct Problem<'a> {
    pub map: &'a Map<'a>,
    /// z*.
    pub trial: &'a Both<Row>,
    pub pressure: &'a Row,
    /// r_i, and τ_i.
    pub start: &'a Both<Row>,
    pub overshoot: &'a Row,
}

/// Directions n = e + β r of the slip at all points, and their derivatives by the angle of e.
struct Directions {
    vector: Both<Row>,
    by_angle: Both<Row>,
}

impl Directions {
    /// For the tractions p e, and β/(e·r).
    #[inline(always)]
    fn new(e: &Both<Row>, r: &Both<Row>, per_along: &Row) -> Directions {
        let mut directions = Directions { vector: *e, by_angle: [[0.0; SPRINGS]; 2] };
        let Directions { vector, by_angle } = &mut directions;
        for i in 0..SPRINGS {
            let along = e[0][i] * r[0][i] + e[1][i] * r[1][i];
            let factor = if along > 0.0 { per_along[i] } else { 0.0 };
            let (beta, slope) = (factor * along, factor * (e[0][i] * r[1][i] - e[1][i] * r[0][i]));
            vector[0][i] += beta * r[0][i];
            vector[1][i] += beta * r[1][i];
            by_angle[0][i] = slope * r[0][i] - e[1][i];
            by_angle[1][i] = slope * r[1][i] + e[0][i];
        }
        directions
    }
}

/// β/(e·r) = |r|⁷/(1 + τ/3).
#[inline(always)]
fn per_along(start: &Both<Row>, overshoot: &Row) -> Row {
    let mut factors = [0.0; SPRINGS];
    for i in 0..SPRINGS {
        let square = start[0][i] * start[0][i] + start[1][i] * start[1][i];
        factors[i] = square * square * square * square.sqrt() / (1.0 + overshoot[i] * (1.0 / 3.0));
    }
    factors
}

/// Derivatives of the direction of slip at a point by r and by τ, where e·r is positive.
pub(crate) struct DirectionSlopes {
    pub vector: Both<f64>,
    /// Both components of the vector for each of r.
    pub by_start: Both<Both<f64>>,
    pub by_overshoot: Both<f64>,
}

impl DirectionSlopes {
    #[inline(always)]
    pub fn new(e: &Both<f64>, r: &Both<f64>, overshoot: f64) -> DirectionSlopes {
        let (square, along) = (product(r, r), product(e, r));
        if along <= 0.0 {
            return DirectionSlopes { vector: *e, by_start: [[0.0; 2]; 2], by_overshoot: [0.0; 2] };
        }
        let factor = 1.0 / (1.0 + overshoot * (1.0 / 3.0));
        let fifth = square * square * square.sqrt() * factor;
        let beta = fifth * square * along;
        // dβ/dr = (7 |r|⁵ (e·r) r + |r|⁷ e)/(1 + τ/3).
        let by = [0, 1].map(|k| fifth * (7.0 * along * r[k] + square * e[k]));
        let by_overshoot = -beta * factor * (1.0 / 3.0);
        DirectionSlopes {
            vector: [e[0] + beta * r[0], e[1] + beta * r[1]],
            by_start: [[by[0] * r[0] + beta, by[0] * r[1]], [by[1] * r[0], by[1] * r[1] + beta]],
            by_overshoot: [by_overshoot * r[0], by_overshoot * r[1]],
        }
    }
}

/// The slip at all points.
pub(crate) struct Slip {
    /// The innermost point that may slip, and which ones do.
    pub first: usize,
    pub slips: [bool; SPRINGS],
    /// Direction of the traction, and σ.
    pub e: Both<Row>,
    pub sigma: Both<Row>,
    /// S on the slipping points, 0 elsewhere; the factors of the Jacobian of Newton's method.
    pub inverse: Both<Matrix>,
    pub factors: Matrix,
    pub converged: bool,
}

impl Slip {
    /// Zeros.
    pub const ZERO: Slip = Slip {
        first: 0,
        slips: [false; SPRINGS],
        e: [[0.0; SPRINGS]; 2],
        sigma: [[0.0; SPRINGS]; 2],
        inverse: [[[0.0; SPRINGS]; SPRINGS]; 2],
        factors: [[0.0; SPRINGS]; SPRINGS],
        converged: false,
    };

    /// Slip at a point, with the traction in a direction.
    #[inline(always)]
    pub fn begin(&mut self, i: usize, [x, y]: Both<f64>) {
        self.slips[i] = true;
        (self.e[0][i], self.e[1][i]) = (x, y);
        self.first = self.first.min(i);
    }

    /// Whether all points slip from the first one on.
    #[inline(always)]
    fn all_slip(&self, last: usize) -> bool {
        (self.first..=last).all(|i| self.slips[i.min(SPRINGS - 1)])
    }

    /// Solves the problem: springs and tractions at the end.
    #[inline(always)]
    pub fn solve(&mut self, problem: &Problem, factored: bool, [end, tractions]: [&mut Both<Row>; 2]) {
        let Problem { map, start, overshoot, .. } = *problem;
        let last = map.last.min(SPRINGS - 1);
        let per_along = per_along(start, overshoot);
        let mut constant = [[0.0; SPRINGS]; 2];
        self.invert(problem, SPRINGS, &mut constant);
        let (mut turn, mut before) = (PI, PI);
        let (mut changes, mut tried, mut reviewed) = (0, 0, false);
        for _ in 0..STEPS {
            tried += 1;
            // p e of the slipping points.
            let mut limit = [0.0; SPRINGS];
            for i in 0..SPRINGS {
                limit[i] = if self.slips[i] { problem.pressure[i] } else { 0.0 };
            }
            let mut q = self.e;
            q.iter_mut().for_each(|q| q.iter_mut().zip(&limit).for_each(|(q, limit)| *q *= limit));
            let directions = Directions::new(&self.e, start, &per_along);
            let (residual, largest) = self.multipliers(&constant, &q, &directions.vector, last);
            self.converged = largest <= CONVERGED * CONVERGED || turn * turn <= SMALL_TURN * before;
            let ends = self.converged || tried == STALLED;
            if ends || (turn <= CLOSE && !reviewed) {
                reviewed = true;
                let known = self.all_slip(last).then_some(self.first);
                (*end, *tractions) = self.relaxed(problem, &q);
                if self.review(problem, tractions, ends) {
                    changes += 1;
                    if changes > CHANGES {
                        self.converged = false;
                        return;
                    }
                    // Further points within add to the sums; otherwise these begin anew.
                    let grows = known.is_some_and(|known| known > self.first) && self.all_slip(last);
                    if !grows {
                        self.inverse.as_flattened_mut().fill([0.0; SPRINGS]);
                        constant = [[0.0; SPRINGS]; 2];
                    }
                    self.invert(problem, known.filter(|_| grows).unwrap_or(SPRINGS), &mut constant);
                    (turn, before, tried, reviewed) = (PI, PI, 0, false);
                    continue;
                }
            }
            if if self.converged { factored } else { turn > CLOSE || turn > 0.1 * before } {
                self.linearise(&q, &directions, last);
                factorise(&mut self.factors, self.first, last);
            }
            if self.converged {
                return;
            }
            let turns = solve(&self.factors, self.first, last, &residual);
            before = turn;
            turn = turns.iter().fold(0.0, |largest: f64, turn| largest.max(turn.abs()));
            let damping = if turn > LARGEST_TURN { LARGEST_TURN / turn } else { 1.0 };
            for i in 0..SPRINGS {
                let (x, y, turn) = (self.e[0][i], self.e[1][i], damping * turns[i]);
                let (x, y) = (x - turn * y, y + turn * x);
                let scale = 1.0 / (x * x + y * y).max(TINY).sqrt();
                (self.e[0][i], self.e[1][i]) = (x * scale, y * scale);
            }
        }
    }

    /// S and `S B z*` of the slipping points: with U the inverse of the block of B from the first one on, `S = U'U` without the points
    /// that stick. The sums over the points from `known` on are there already.
    #[inline(always)]
    fn invert(&mut self, problem: &Problem, known: usize, constant: &mut Both<Row>) {
        let Problem { map, trial, .. } = *problem;
        let (first, end) = (self.first.min(SPRINGS - 1), map.last.min(SPRINGS - 1) + 1);
        for k in 0..2 {
            let square = &mut self.inverse[k];
            let column = map.inverse_column(k, first);
            for m in first..known.min(end) {
                let row = map.inverse_row(k, m, column[m]);
                add(&mut constant[k], trial[k][m], &row);
                for i in m..end {
                    add(&mut square[i], row[i], &row);
                }
            }
            for t in first..end {
                if self.slips[t] {
                    continue;
                }
                let row = square[t];
                let reciprocal = 1.0 / row[t].max(TINY);
                let constant_there = constant[k][t];
                for i in first..end {
                    let factor = row[i] * reciprocal;
                    add(&mut square[i], -factor, &row);
                    constant[k][i] -= factor * constant_there;
                }
            }
        }
    }

    /// Finds σ for the tractions q; the residuals of its directions n, and the square of the largest angle between both.
    #[inline(always)]
    fn multipliers(&mut self, constant: &Both<Row>, q: &Both<Row>, n: &Both<Row>, last: usize) -> (Row, f64) {
        let (mut held, end) = ([[0.0; SPRINGS]; 2], last.min(SPRINGS - 1) + 1);
        for k in 0..2 {
            for i in self.first..end {
                held[k][i] = dot(&self.inverse[k][i], &q[k]);
            }
        }
        let (mut residual, mut largest) = ([0.0; SPRINGS], 0.0f64);
        for i in 0..SPRINGS {
            let (x, y) = (constant[0][i] - held[0][i], constant[1][i] - held[1][i]);
            let slips = self.slips[i];
            (self.sigma[0][i], self.sigma[1][i]) = if slips { (x, y) } else { (0.0, 0.0) };
            residual[i] = if slips { y * n[0][i] - x * n[1][i] } else { 0.0 };
            // A slip that is a difference of rounding errors has no direction.
            let (free, held) = (at(constant, i), at(&held, i));
            let rounding = ROUNDING * ROUNDING * (product(&free, &free) + product(&held, &held));
            let lengths = (x * x + y * y).max(rounding) * (n[0][i] * n[0][i] + n[1][i] * n[1][i]);
            largest = largest.max(residual[i] * residual[i] / lengths.max(TINY));
        }
        (residual, largest)
    }

    /// The Jacobian of the residuals by the angles, of opposite sign.
    #[inline(always)]
    fn linearise(&mut self, q: &Both<Row>, directions: &Directions, last: usize) {
        let (Directions { vector: n, by_angle }, end) = (directions, last.min(SPRINGS - 1) + 1);
        for i in self.first..end {
            let row = &mut self.factors[i];
            let [x, y] = [&self.inverse[0][i], &self.inverse[1][i]];
            for j in 0..SPRINGS {
                row[j] = n[0][i] * y[j] * q[0][j] + n[1][i] * x[j] * q[1][j];
            }
            let diagonal = self.sigma[0][i] * by_angle[1][i] - self.sigma[1][i] * by_angle[0][i];
            row[i] += if self.slips[i] { diagonal } else { 1.0 };
        }
    }

    /// Springs and tractions after the slip.
    #[inline(always)]
    fn relaxed(&self, problem: &Problem, q: &Both<Row>) -> (Both<Row>, Both<Row>) {
        let Problem { map, trial, .. } = *problem;
        let mut z = *trial;
        for k in 0..2 {
            let slip = map.transposed(k, self.first, &self.sigma[k]);
            z[k].iter_mut().zip(slip).for_each(|(z, slip)| *z -= slip);
        }
        // The springs of a long slip are small differences: found again from the tractions, from outside.
        if problem.overshoot.iter().any(|over| *over > LONG_SLIP) {
            for i in (0..=map.last.min(SPRINGS - 1)).rev() {
                for k in 0..2 {
                    if self.slips[i] {
                        z[k][i] += (q[k][i] - dot(&map.row(k, i), &z[k])) / map.diagonal(k, i);
                    }
                }
            }
        }
        let mut tractions = *q;
        map.tractions(&z, &self.slips, &mut tractions);
        (z, tractions)
    }

    /// Points beyond Coulomb's limit slip; at the end of an iteration, those whose slip is against the traction stick. Whether any has
    /// changed.
    #[inline(always)]
    fn review(&mut self, problem: &Problem, tractions: &Both<Row>, ends: bool) -> bool {
        let mut changed = false;
        for i in 0..=problem.map.last.min(SPRINGS - 1) {
            if self.slips[i] {
                if ends && product(&at(&self.sigma, i), &at(&self.e, i)) < 0.0 {
                    self.slips[i] = false;
                    changed = true;
                }
                continue;
            }
            let [x, y] = at(tractions, i);
            let square = x * x + y * y;
            if square > problem.pressure[i] * problem.pressure[i] * (1.0 + 1e-10) {
                let length = square.max(TINY).sqrt();
                self.begin(i, [x / length, y / length]);
                changed = true;
            }
        }
        if changed {
            self.first = (0..SPRINGS).find(|i| self.slips[*i]).unwrap_or(problem.map.last);
        }
        changed
    }
}

/// LU factors without pivoting, in place; the reciprocals of the pivots on the diagonal. The matrix is a positive definite one and small
/// changes. An angle whose pivot is lost in rounding does not turn.
#[inline(always)]
fn factorise(matrix: &mut Matrix, first: usize, last: usize) {
    let end = last.min(SPRINGS - 1) + 1;
    for p in first..end {
        let pivot = matrix[p][p];
        let reciprocal = 1.0 / if pivot.abs() > TINY { pivot } else { 1.0 / TINY };
        let mut row = matrix[p];
        for j in 0..SPRINGS {
            row[j] = if j > p { row[j] } else { 0.0 };
        }
        matrix[p][p] = reciprocal;
        for i in p + 1..end {
            let factor = matrix[i][p] * reciprocal;
            add(&mut matrix[i], -factor, &row);
            matrix[i][p] = factor;
        }
    }
}

/// Solves with the factors.
#[inline(always)]
fn solve(factors: &Matrix, first: usize, last: usize, right: &Row) -> Row {
    let end = last.min(SPRINGS - 1) + 1;
    let (mut forward, mut solution) = ([0.0; SPRINGS], [0.0; SPRINGS]);
    for i in first..end {
        forward[i] = right[i] - dot(&factors[i], &forward);
    }
    for i in (first..end).rev() {
        solution[i] = (forward[i] - dot(&factors[i], &solution)) * factors[i][i];
    }
    solution
}

/// Solves with the factors for rows of n columns.
#[inline(always)]
pub(crate) fn solve_columns(factors: &Matrix, first: usize, last: usize, rows: &mut [f64], n: usize) {
    let end = last.min(SPRINGS - 1) + 1;
    for i in first..end {
        for j in first..i {
            if factors[i][j] != 0.0 {
                add_row(rows, n, i, -factors[i][j], j);
            }
        }
    }
    for i in (first..end).rev() {
        for j in i + 1..end {
            if factors[i][j] != 0.0 {
                add_row(rows, n, i, -factors[i][j], j);
            }
        }
        scale(row_mut(rows, n, i), factors[i][i]);
    }
}
