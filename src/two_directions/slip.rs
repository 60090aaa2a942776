//! Coulomb's law at the points of a contact.
//!
//! If nothing slips, the springs reach the trial state v*, with tractions q*. Slip r_i at the points relaxes them to
//!
//! ```text
//! v_j = v*_j - Σ_i C_ij r_i/k_j,   q = C v,   |q_i| <= 1 and r_i = 0,  or  q_i = e_i and r_i = |r_i| e_i.
//! ```
//!
//! C is triangular, so with `K = C⁻¹'k C⁻¹`, a sum of positive terms, `r = K (q* - q)`: among the tractions within
//! Coulomb's bound, q are the nearest ones to q* in the metric K. They are unique, and continuous in q*. The slipping
//! points and the angles of e are found by Newton's method with the residuals `e × r` and the matrix
//! `J = e × K e⊥ + e·r`. Springs from the innermost slipping point on are `v = C⁻¹ q`, without a difference from the
//! trial state. A point in between that sticks has r = 0; q of such points is eliminated from K.
//!
//! Derivatives are one more step of Newton's method from the solution, see [`Slip::differentiate`].

use super::matrix::{dot, eliminate, times};
use super::nodes::{Matrix, PerAxis, PointSet, Row, SPRINGS, length, mask_of, points_in};
use super::shells::Springs;
use crate::numerics::guard::{TINY, quotient};
use crate::numerics::lanes::Lanes;

/// Newton steps with a set of slipping points, and changes of the set, after which a guess is given up.
const MAX_STEPS: usize = 30;
const MAX_SET_CHANGES: usize = 12;
/// Newton's method has converged when the next changes of the angles would be at most this in sum.
const ROTATION_TOLERANCE: f64 = 1e-11;
/// The inverse of J is kept while the sum of the changes of the angles falls to a tenth, and is at most this.
const REUSE_ROTATION: f64 = 2e-1;
/// Newton's method is given up if the sum of the changes of the angles exceeds this: their squares could overflow.
const DIVERGED_ROTATION: f64 = 1e100;
/// Sweeps over all points after an attempt that failed.
const SWEEPS: usize = 30;
/// Attempts of Newton's method.
const ATTEMPTS: usize = 8;
/// After this number of steps with a set of slipping points the set is updated even if the angles have not converged:
/// the angle of a point that hardly slips is undetermined.
const UNDETERMINED_STEP: usize = 15;
/// Coulomb's bound of |q|², but for rounding: a point whose |q|² is larger slips.
const SQUARED_BOUND: Row = Lanes([1.0 + 1e-12; SPRINGS]);
/// A point sticks again if its slip is opposite to the traction by more than this part of the scale of slip, which is a
/// rounding error.
const BACKSLIP_TOLERANCE: f64 = 1e-14;
/// The first guess of Newton's method lets a point slip if its trial traction is more than this part of the bound.
const EXPECTED_SLIP: f64 = 0.5;
/// The angle from q* to q is the guess for the next step if its cosine is more than this.
const SAME_ROTATION_COSINE: f64 = 0.5;

/// Slip of a contact, from a trial state.
#[repr(align(32))]
pub(crate) struct Slip {
    pub points: Points,
    /// The trial state.
    pub trial: PerAxis<Row>,
    /// For each point that slips, the tangent of half the angle from q* to q: the first guess for the next step.
    pub rotation_guess: Row,
}

/// The metric K of a set of slipping points under a load: from the innermost one on, with the points that stick
/// eliminated.
#[repr(align(32))]
pub(crate) struct Metric {
    matrices: PerAxis<Matrix>,
    /// The set of slipping points and the load for which K was computed. It is computed anew if either differs, and
    /// always for `NEVER_REUSED`.
    computed_for: (PointSet, f64),
    /// -J⁻¹.
    inverse: Matrix,
}

impl Metric {
    /// The load of a K that is not used again: it equals no load.
    pub const NEVER_REUSED: f64 = f64::NAN;
    pub const ZERO: Metric =
        Metric { matrices: [[Row::ZERO; SPRINGS]; 2], computed_for: (0, 0.0), inverse: [Row::ZERO; SPRINGS] };
}

/// The points of a contact after slip.
pub(crate) struct Points {
    /// The set of the points that slip, the innermost one of them, and the set as a row of 1 and 0.
    pub set: PointSet,
    pub first: usize,
    slips: Row,
    /// Directions of the tractions of points that slip, tractions, slip, and displacements of the springs.
    pub e: PerAxis<Row>,
    pub q: PerAxis<Row>,
    pub r: PerAxis<Row>,
    pub v: PerAxis<Row>,
}

impl Slip {
    /// The points from the innermost one that slips to the edge.
    pub fn range(&self, springs: &Springs) -> [usize; 2] {
        [self.points.first.min(SPRINGS), springs.shells.range().end.min(SPRINGS)]
    }

    pub const ZERO: Slip = {
        let rows = [Row::ZERO; 2];
        let points = Points { set: 0, first: 0, slips: Row::ZERO, e: rows, q: rows, r: rows, v: rows };
        Slip { points, trial: rows, rotation_guess: Row::ZERO }
    };

    /// Finds the slip from a trial state of springs under a load.
    pub fn find(&mut self, metric: &mut Metric, springs: &Springs, trial: PerAxis<Row>, load: f64) {
        self.trial = trial;
        let q = springs.tractions(&trial);
        let [x, y] = directions(&q);
        let mut slipping = points_above(&square(&q), &SQUARED_BOUND);
        let points = &mut self.points;
        (points.set, points.v, points.q, points.r) = (slipping, trial, q, [Row::ZERO; 2]);
        if slipping == 0 {
            return;
        }
        // First guess: besides the points beyond their bound, those outside of one of them slip if they are near their
        // bound, and those next to them inside if they slipped in the step before.
        slipping |= points_above(&square(&q), &Lanes([EXPECTED_SLIP * EXPECTED_SLIP; SPRINGS]))
            & points_in([slipping.trailing_zeros() as usize, SPRINGS]);
        let rotated_before = points_above(&self.rotation_guess.map(f64::abs), &Row::ZERO);
        for _ in 0..SPRINGS {
            slipping |= slipping >> 1 & rotated_before;
        }
        (points.set, points.e) = (slipping, [x, y]);
        points.rotate(&(2.0 * (mask_of(slipping) * self.rotation_guess)));
        // Sweeps converge from any guess. If every attempt fails, the result of the last sweep is the solution.
        let mut swept = q;
        for _ in 0..ATTEMPTS {
            if self.newton(metric, springs, &q, load) {
                break;
            }
            self.points.sweep(springs, &q, &mut swept);
        }
        let Points { e, slips, .. } = &self.points;
        let (cos, sin) = (x * e[0] + y * e[1], x * e[1] - y * e[0]);
        let near = cos.map(|cos| if cos > SAME_ROTATION_COSINE { 1.0 } else { 0.0 });
        self.rotation_guess = near * *slips * sin / (1.0 + cos.max(0.0));
    }

    /// Newton's method from the present directions; whether it converged.
    fn newton(&mut self, metric: &mut Metric, springs: &Springs, q: &PerAxis<Row>, load: f64) -> bool {
        let Slip { points, trial, .. } = self;
        let Metric { matrices, computed_for, inverse } = metric;
        'sets: for _ in 0..MAX_SET_CHANGES {
            points.first = (points.set.trailing_zeros() as usize).min(SPRINGS);
            points.slips = mask_of(points.set);
            let range = [points.first, springs.shells.range().end];
            if *computed_for != (points.set, load) {
                set_metric(matrices, springs, range, points.set);
                *computed_for = (points.set, load);
            }
            let (mut rotation, mut converged, mut keeps_inverse) = (f64::MAX, false, false);
            for step in 0..MAX_STEPS {
                let across = points.residual(matrices, q, range);
                let undetermined = step == UNDETERMINED_STEP;
                if (converged || undetermined) && points.update_set(springs, matrices, trial, q) {
                    continue 'sets;
                }
                if converged {
                    return true;
                }
                let is_new = !keeps_inverse;
                if is_new {
                    points.invert(inverse, matrices, range);
                }
                let rotations = -times(inverse, range, &(points.slips * across));
                let before = rotation;
                rotation = dot(&rotations.map(f64::abs), &Lanes([1.0; SPRINGS]));
                if rotation > DIVERGED_ROTATION {
                    return false;
                }
                points.rotate(&rotations);
                // The next change of the angles: the square with a new inverse; with that of a step before, it falls as
                // the last one did.
                let rate = if is_new { rotation } else { quotient(rotation, before) };
                converged = rotation * rate.min(1.0) <= ROTATION_TOLERANCE;
                keeps_inverse = rotation <= 0.1 * before && rotation <= REUSE_ROTATION;
            }
            return false;
        }
        false
    }
}

impl Points {
    /// Sets the slip and the tractions for the present directions; the residuals e × r.
    fn residual(&mut self, metric: &PerAxis<Matrix>, q: &PerAxis<Row>, range: [usize; 2]) -> Row {
        let inside = mask_of(points_in(range)) * (1.0 - self.slips);
        for axis in 0..2 {
            let sum = times(&metric[axis], range, &(self.slips * (q[axis] - self.e[axis])));
            self.r[axis] = self.slips * sum;
            self.q[axis] = self.slips * self.e[axis] + (1.0 - self.slips) * q[axis] + inside * sum;
        }
        self.e[0] * self.r[1] - self.e[1] * self.r[0]
    }

    /// The slip along the directions of the tractions, e·r.
    fn along(&self) -> Row {
        self.e[0] * self.r[0] + self.e[1] * self.r[1]
    }

    /// -J⁻¹; J is the identity at points that stick.
    pub fn invert(&self, inverse: &mut Matrix, metric: &PerAxis<Matrix>, range: [usize; 2]) {
        let [x, y] = [self.slips * self.e[0], self.slips * self.e[1]];
        let diagonal = self.slips * self.along() + (1.0 - self.slips);
        for m in range[0]..range[1].min(SPRINGS) {
            inverse[m] = x * (x[m] * metric[1][m]) + y * (y[m] * metric[0][m]);
            inverse[m][m] += diagonal[m];
        }
        for m in range[0]..range[1] {
            eliminate(inverse, m, range);
        }
    }

    /// Rotates the directions by these angles, approximately: Cayley's formula keeps their length 1.
    fn rotate(&mut self, rotations: &Row) {
        let ([x, y], half) = (self.e, 0.5 * *rotations);
        let scale = 1.0 / (1.0 + half * half);
        let (cos, sin) = ((1.0 - half * half) * scale, 2.0 * half * scale);
        self.e = [cos * x - sin * y, cos * y + sin * x];
    }

    /// Sets the displacements of the springs from the innermost point that slips on, for the present tractions.
    fn set_springs(&mut self, springs: &Springs) {
        for axis in 0..2 {
            for j in self.first..springs.shells.range().end {
                self.v[axis][j] = dot(&springs.inverse[axis][j], &self.q[axis]);
            }
        }
    }

    /// Sets the springs after slip. Then points beyond their bound are made to slip, and those whose slip is opposite
    /// to the traction to stick: whether any point has changed.
    fn update_set(
        &mut self,
        springs: &Springs,
        metric: &PerAxis<Matrix>,
        trial: &PerAxis<Row>,
        q: &PerAxis<Row>,
    ) -> bool {
        let before = self.set;
        (self.v, self.q) = (*trial, if before == 0 { *q } else { self.q });
        if before != 0 {
            self.set_springs(springs);
            self.q = springs.tractions(&self.v);
        }
        let (directions, beyond) = (directions(&self.q), points_above(&square(&self.q), &SQUARED_BOUND));
        let mut scale = Row::ZERO;
        for i in 0..SPRINGS {
            scale[i] = metric[0][i][i] + metric[1][i][i];
        }
        let (backwards, slips) = (points_above(&(-self.along()), &(BACKSLIP_TOLERANCE * scale)), beyond & !before);
        self.set = before & !backwards | slips;
        for axis in 0..2 {
            self.e[axis] += mask_of(slips) * (directions[axis] - self.e[axis]);
        }
        self.set != before
    }

    /// Sweeps over the points, each of which moves its traction towards the nearest one within the bound. Sets the slip
    /// and the springs for the tractions that are reached.
    #[cold]
    #[inline(never)]
    pub fn sweep(&mut self, springs: &Springs, trial: &PerAxis<Row>, q: &mut PerAxis<Row>) {
        let (mut metric, range) = ([[Row::ZERO; SPRINGS]; 2], springs.shells.range());
        set_full_metric(&mut metric, springs, range.start);
        for _ in 0..SWEEPS {
            self.set = 0;
            for i in range.clone().rev().map(|i| i.min(SPRINGS - 1)) {
                // The stiffer direction bounds the curvature in both.
                let per = quotient(1.0, metric[0][i][i].max(metric[1][i][i]));
                let mut to = [0.0; 2];
                for axis in 0..2 {
                    to[axis] = q[axis][i] + per * dot(&metric[axis][i], &(trial[axis] - q[axis]));
                }
                let length = length(to);
                self.set |= PointSet::from(length > 1.0) << i;
                for axis in 0..2 {
                    q[axis][i] = to[axis] / length.max(1.0);
                }
            }
        }
        (self.first, self.slips, self.q, self.e) = (range.start, mask_of(self.set), *q, directions(q));
        for axis in 0..2 {
            let slip = times(&metric[axis], [range.start, range.end], &(trial[axis] - q[axis]));
            self.r[axis] = self.slips * slip;
        }
        self.set_springs(springs);
    }
}

/// Squares of the lengths of tractions, |q_i|².
fn square([x, y]: &PerAxis<Row>) -> Row {
    *x * *x + *y * *y
}

/// Directions of tractions; 0 where there is no traction.
fn directions(q: &PerAxis<Row>) -> PerAxis<Row> {
    let per_length = 1.0 / square(q).max(TINY).sqrt();
    q.map(|q| q * per_length)
}

/// The set of the points at which values exceed limits.
fn points_above(values: &Row, limits: &Row) -> PointSet {
    let mut set = 0;
    for i in 0..SPRINGS {
        set |= PointSet::from(values[i] > limits[i]) << i;
    }
    set
}

/// Sets `K = C⁻¹'k C⁻¹` of the springs from one on.
fn set_full_metric(metric: &mut PerAxis<Matrix>, springs: &Springs, first: usize) {
    for m in first..springs.shells.range().end {
        let mut rows = [Row::ZERO; 2];
        for j in first..=m {
            for axis in 0..2 {
                let inverse = &springs.inverse[axis][j];
                rows[axis] += (springs.stiffness[axis][j] * inverse[m]) * *inverse;
            }
        }
        for axis in 0..2 {
            metric[axis][m] = rows[axis];
        }
    }
}

/// Sets K of a set of slipping points, the innermost of which is the first of a range. Points of the range that stick
/// are eliminated.
pub(crate) fn set_metric(metric: &mut PerAxis<Matrix>, springs: &Springs, [first, end]: [usize; 2], set: PointSet) {
    set_full_metric(metric, springs, first);
    for axis in 0..2 {
        for i in first..end.min(SPRINGS) {
            if set >> i & 1 == 0 {
                eliminate(&mut metric[axis], i, [first, end]);
            }
        }
    }
}
