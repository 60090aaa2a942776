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

use super::edge::Map;
use super::springs::{Both, Row, SPRINGS, Span, dot};
use crate::shape::TINY;

pub(crate) type Matrix = [Row; SPRINGS];

/// Newton's steps for one set of slipping points, and changes of that set.
const STEPS: usize = 20;
const ROUNDS: usize = 8;
/// The angle between σ and its required direction at which the iteration ends: a rounding error, amplified by the condition of S.
const CONVERGED: f64 = 1e-11;
/// The slip, relative to the terms whose difference it is, below which only that difference converges.
const ROUNDING: f64 = 1e-3;
/// A turn whose square is below that: the next iterate has converged.
const SMALL_TURN: f64 = 1e-6;
/// Overshoot from which on the springs lose more than three digits to cancellation.
const LONG_SLIP: f64 = 1e3;
/// The largest change of an angle.
const LARGEST_TURN: f64 = 0.8;

#[inline(always)]
pub(crate) fn product(one: &Both<f64>, two: &Both<f64>) -> f64 {
    one[0] * two[0] + one[1] * two[1]
}

#[inline(always)]
pub(crate) fn cross(one: &Both<f64>, two: &Both<f64>) -> f64 {
    one[0] * two[1] - one[1] * two[0]
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

/// Direction e + β r of the slip at a point, and its derivatives.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Direction {
    pub vector: Both<f64>,
    pub by_angle: Both<f64>,
    /// By r_i, both components of the vector for each, and by τ_i.
    pub by_start: Both<Both<f64>>,
    pub by_overshoot: Both<f64>,
}

impl Direction {
    /// For the traction p (cos, sin), and the start r.
    #[inline(always)]
    pub fn new(e: &Both<f64>, r: &Both<f64>, overshoot: f64) -> Direction {
        let square = product(r, r);
        let along = product(e, r);
        let tangent = [-e[1], e[0]];
        if along <= 0.0 {
            return Direction { vector: *e, by_angle: tangent, by_start: [[0.0; 2]; 2], by_overshoot: [0.0; 2] };
        }
        // β = |r|⁷ (e·r) f.
        let length = square.sqrt();
        let seventh = square * square * square * length;
        let factor = 1.0 / (1.0 + overshoot * (1.0 / 3.0));
        let (beta, per_along) = (seventh * along * factor, seventh * factor);
        let slope = per_along * product(&tangent, r);
        // dβ/dr = f (7 |r|⁵ (e·r) r + |r|⁷ e).
        let radial = 7.0 * square * square * length * along * factor;
        let by = [radial * r[0] + per_along * e[0], radial * r[1] + per_along * e[1]];
        let by_overshoot = -beta * factor * (1.0 / 3.0);
        Direction {
            vector: [e[0] + beta * r[0], e[1] + beta * r[1]],
            by_angle: [tangent[0] + slope * r[0], tangent[1] + slope * r[1]],
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
    pub e: [Both<f64>; SPRINGS],
    pub sigma: Both<Row>,
    /// S on the slipping points; the factors of the Jacobian of Newton's method.
    pub inverse: Both<Matrix>,
    pub factors: Matrix,
    pub converged: bool,
}

impl Slip {
    pub const NONE: Slip = Slip {
        first: SPRINGS,
        slips: [false; SPRINGS],
        e: [[0.0; 2]; SPRINGS],
        sigma: [[0.0; SPRINGS]; 2],
        inverse: [[[0.0; SPRINGS]; SPRINGS]; 2],
        factors: [[0.0; SPRINGS]; SPRINGS],
        converged: false,
    };

    /// Begins with slip at a point, the traction in a direction.
    #[inline(always)]
    pub fn begin(&mut self, i: usize, direction: Both<f64>) {
        self.slips[i] = true;
        self.e[i] = direction;
        self.first = self.first.min(i);
    }

    fn sigma_at(&self, i: usize) -> Both<f64> {
        [self.sigma[0][i], self.sigma[1][i]]
    }

    /// Solves the problem: springs and tractions at the end.
    #[inline(always)]
    pub fn solve(&mut self, problem: &Problem, factored: bool, [end, tractions]: [&mut Both<Row>; 2]) {
        let Problem { map, pressure, .. } = *problem;
        let last = map.last.min(SPRINGS - 1);
        for round in 0..ROUNDS {
            self.turn(problem, factored);
            let (z, q) = self.relaxed(problem);
            let mut changed = false;
            for i in 0..SPRINGS {
                if i > last {
                    break;
                }
                if self.slips[i] {
                    // Slip against the traction: the point sticks.
                    if product(&self.sigma_at(i), &self.e[i]) < 0.0 {
                        self.slips[i] = false;
                        changed = true;
                    }
                } else {
                    let length2 = q[0][i] * q[0][i] + q[1][i] * q[1][i];
                    if length2 > pressure[i] * pressure[i] * (1.0 + 1e-10) {
                        let length = length2.max(TINY).sqrt();
                        self.slips[i] = true;
                        self.e[i] = [q[0][i] / length, q[1][i] / length];
                        changed = true;
                    }
                }
            }
            if !changed || round + 1 == ROUNDS {
                self.converged &= !changed;
                (*end, *tractions) = (z, q);
                return;
            }
            self.first = (0..SPRINGS).find(|i| self.slips[*i]).unwrap_or(last);
        }
    }

    /// Springs and tractions after the slip.
    #[inline(always)]
    fn relaxed(&self, problem: &Problem) -> (Both<Row>, Both<Row>) {
        let Problem { map, trial, .. } = *problem;
        let mut z = *trial;
        for i in 0..SPRINGS {
            if self.slips[i] {
                for k in 0..2 {
                    Span::new(i, map.last).add(&mut z[k], -self.sigma[k][i], &map.row(k, i));
                }
            }
        }
        // The springs of a long slip are small differences: found again from the tractions, from outside.
        if problem.overshoot.iter().any(|over| *over > LONG_SLIP) {
            for i in (0..SPRINGS).rev() {
                if i <= map.last && self.slips[i] {
                    for k in 0..2 {
                        let rest = problem.pressure[i] * self.e[i][k] - dot(&map.row(k, i), &z[k]);
                        z[k][i] += rest / map.diagonal(k, i);
                    }
                }
            }
        }
        (z, map.tractions(&z, 0))
    }

    /// S and `S B z*` of the slipping points: with U the inverse of the block of B from the first one on, `S = U'U` without the points
    /// that stick.
    #[inline(always)]
    fn invert(&mut self, problem: &Problem) -> Both<Row> {
        let Problem { map, trial, .. } = *problem;
        let (first, last) = (self.first.min(SPRINGS - 1), map.last.min(SPRINGS - 1));
        let span = Span::new(first, last);
        let mut constant = [[0.0; SPRINGS]; 2];
        for k in 0..2 {
            let inverse = &mut self.factors;
            for i in (0..SPRINGS).rev() {
                if i < first || i > last {
                    continue;
                }
                let row = map.row(k, i);
                let mut sum = [0.0; SPRINGS];
                for j in i + 1..SPRINGS {
                    if j <= last {
                        span.add(&mut sum, -row[j], &inverse[j]);
                    }
                }
                sum[i] += 1.0;
                let reciprocal = 1.0 / map.diagonal(k, i);
                sum.iter_mut().for_each(|value| *value *= reciprocal);
                inverse[i] = sum;
            }
            let square = &mut self.inverse[k];
            *square = [[0.0; SPRINGS]; SPRINGS];
            for m in 0..SPRINGS {
                if m < first || m > last {
                    continue;
                }
                let row = inverse[m];
                span.add(&mut constant[k], trial[k][m], &row);
                for i in m..SPRINGS {
                    if i <= last {
                        span.add(&mut square[i], row[i], &row);
                    }
                }
            }
            for t in 0..SPRINGS {
                if t < first || t > last || self.slips[t] {
                    continue;
                }
                let row = square[t];
                let reciprocal = 1.0 / row[t].max(TINY);
                let constant_there = constant[k][t];
                for i in 0..SPRINGS {
                    if i >= first && i <= last {
                        let factor = row[i] * reciprocal;
                        span.add(&mut square[i], -factor, &row);
                        constant[k][i] -= factor * constant_there;
                    }
                }
            }
        }
        constant
    }

    /// Turns the tractions of the slipping points until the slip has its direction.
    #[inline(always)]
    fn turn(&mut self, problem: &Problem, factored: bool) {
        let Problem { map, pressure, start, overshoot, .. } = *problem;
        let constant = self.invert(problem);
        let (first, last) = (self.first.min(SPRINGS - 1), map.last.min(SPRINGS - 1));
        let span = Span::new(first, last);
        self.converged = false;
        self.sigma = [[0.0; SPRINGS]; 2];
        let mut last_turn = f64::MAX;
        for _ in 0..STEPS {
            // p e, and its derivative by the angle.
            let (mut q, mut by_angle) = ([[0.0; SPRINGS]; 2], [[0.0; SPRINGS]; 2]);
            for i in 0..SPRINGS {
                if self.slips[i] {
                    (q[0][i], q[1][i]) = (pressure[i] * self.e[i][0], pressure[i] * self.e[i][1]);
                    (by_angle[0][i], by_angle[1][i]) = (-q[1][i], q[0][i]);
                }
            }
            let finishes = last_turn <= SMALL_TURN;
            let mut residual = [0.0; SPRINGS];
            let mut largest: f64 = 0.0;
            for i in 0..SPRINGS {
                if i < first || i > last {
                    continue;
                }
                if !self.slips[i] {
                    self.factors[i] = [0.0; SPRINGS];
                    self.factors[i][i] = 1.0;
                    continue;
                }
                let rows = [&self.inverse[0][i], &self.inverse[1][i]];
                let free = [constant[0][i], constant[1][i]];
                let held = [span.dot(rows[0], &q[0]), span.dot(rows[1], &q[1])];
                let sigma = [free[0] - held[0], free[1] - held[1]];
                (self.sigma[0][i], self.sigma[1][i]) = (sigma[0], sigma[1]);
                if finishes && !factored {
                    continue;
                }
                let direction = Direction::new(&self.e[i], &[start[0][i], start[1][i]], overshoot[i]);
                let n = direction.vector;
                residual[i] = -cross(&sigma, &n);
                // A slip that is a difference of rounding errors has no direction.
                let rounding = ROUNDING * ROUNDING * (product(&free, &free) + product(&held, &held));
                let lengths = product(&sigma, &sigma).max(rounding) * product(&n, &n);
                largest = largest.max(residual[i] * residual[i] / lengths.max(TINY));
                let row = &mut self.factors[i];
                for j in 0..SPRINGS {
                    row[j] = n[0] * rows[1][j] * by_angle[1][j] - n[1] * rows[0][j] * by_angle[0][j];
                }
                row[i] += cross(&sigma, &direction.by_angle);
            }
            self.converged = finishes || largest <= CONVERGED * CONVERGED;
            if self.converged && !factored {
                return;
            }
            factorise(&mut self.factors, first, last);
            if self.converged {
                return;
            }
            solve(&self.factors, first, last, &mut residual);
            let largest = residual.iter().fold(0.0f64, |largest, turn| largest.max(turn.abs()));
            last_turn = largest;
            let damping = if largest > LARGEST_TURN { LARGEST_TURN / largest } else { 1.0 };
            for i in 0..SPRINGS {
                if self.slips[i] {
                    let [x, y] = self.e[i];
                    let turn = damping * residual[i];
                    let (x, y) = (x - turn * y, y + turn * x);
                    let scale = 1.0 / (x * x + y * y).max(TINY).sqrt();
                    self.e[i] = [x * scale, y * scale];
                }
            }
        }
    }
}

/// LU factors without pivoting, in place; the reciprocals of the pivots on the diagonal. The matrix is a positive definite one and small
/// changes.
#[inline(always)]
fn factorise(matrix: &mut Matrix, first: usize, last: usize) {
    for p in 0..SPRINGS {
        if p < first || p > last {
            continue;
        }
        let pivot = matrix[p][p];
        let reciprocal = 1.0 / if pivot.abs() > TINY { pivot } else { TINY };
        let mut row = matrix[p];
        row.iter_mut().take(p + 1).for_each(|entry| *entry = 0.0);
        matrix[p][p] = reciprocal;
        for i in p + 1..SPRINGS {
            if i <= last {
                let factor = matrix[i][p] * reciprocal;
                if factor != 0.0 {
                    Span::new(p, last).add(&mut matrix[i], -factor, &row);
                    matrix[i][p] = factor;
                }
            }
        }
    }
}

/// Solves with the factors.
#[inline(always)]
fn solve(factors: &Matrix, first: usize, last: usize, right: &mut Row) {
    for i in 0..SPRINGS {
        if i >= first && i <= last {
            let mut sum = right[i];
            for j in first..i {
                sum -= factors[i][j] * right[j];
            }
            right[i] = sum;
        }
    }
    for i in (0..SPRINGS).rev() {
        if i >= first && i <= last {
            let mut sum = right[i];
            for j in i + 1..SPRINGS {
                if j <= last {
                    sum -= factors[i][j] * right[j];
                }
            }
            right[i] = sum * factors[i][i];
        }
    }
}

/// Solves with the factors for rows of n columns.
#[inline(always)]
pub(crate) fn solve_columns(factors: &Matrix, first: usize, last: usize, rows: &mut [f64], n: usize) {
    let add = |rows: &mut [f64], to: usize, a: f64, from: usize| {
        let (low, high) = rows.split_at_mut((to.max(from) * n).min(rows.len()));
        let (one, two) = if to > from {
            (high.get_mut(..n), low.get(from * n..(from + 1) * n))
        } else {
            (low.get_mut(to * n..(to + 1) * n), high.get(..n))
        };
        for (to, from) in one.unwrap_or(&mut []).iter_mut().zip(two.unwrap_or(&[])) {
            *to += a * from;
        }
    };
    for i in first..SPRINGS {
        for j in first..i {
            if i <= last && factors[i][j] != 0.0 {
                add(rows, i, -factors[i][j], j);
            }
        }
    }
    for i in (first..SPRINGS).rev() {
        if i > last {
            continue;
        }
        for j in i + 1..SPRINGS {
            if j <= last && factors[i][j] != 0.0 {
                add(rows, i, -factors[i][j], j);
            }
        }
        let row = rows.get_mut(i * n..(i + 1) * n).unwrap_or(&mut []);
        row.iter_mut().for_each(|value| *value *= factors[i][i]);
    }
}
