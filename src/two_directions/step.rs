//! A step of a closed contact.
//!
//! The springs stick at first; a load that rises engages new ones, which follow the part of the motion from there on. If |r| then exceeds 1
//! at a point, the points slip: `slip` finds which and how, and the springs, of values. Derivatives are those of one more step of Newton's
//! method from there: by what the contact depends on in dual numbers, by what the motion and the springs depend on as a linear function. The
//! end of the step is written once for values and derivatives: the fine springs, with limits of their own, and the force.

use super::contact::{Contact, Pressed};
use super::scalar::{Dual, Linear, Over, Real, both};
use super::slip::{SLIPPED, Slip, Slips};
use super::tables::{Both, DualRows, FINE, INSIDE, Matrix, N, Row, Rows, SHIFT, Tables, starts};
use super::trial::{
    Derivatives, FINE_SPRING, LEAST, Motion, ROUNDING, Springs, Values, leave, limits_before, moved, returned, slid,
    some_leave,
};
use crate::shape::TINY;
use crate::simd::dispatch;

/// The derivatives of a step whose slip is known, by parameters of the contact and by what the motion depends on: of the force, which is not
/// yet bounded, and of the springs.
#[inline(never)]
pub(crate) fn derivatives(
    t: &DualRows,
    contact: (&Contact<Dual<1>>, &Both<Matrix>),
    motion: &Motion<Dual<1>, Dual<1>>,
    slip: &Slips,
    springs: &mut Derivatives,
) -> Both<Dual<1>> {
    dispatch!(step(t, contact, motion, slip, springs))
}

/// A step whose slip is known, in numbers with derivatives, of a contact with its C⁻¹: the force, which is not yet bounded.
#[inline(always)]
pub(crate) fn step<A: Real, X: Over<A>, T: Tables<A>, S: Springs<X>>(
    t: &T,
    (c, inverse): (&Contact<A>, &Both<Matrix>),
    motion: &Motion<A, X>,
    slip: &Slips,
    s: &mut S,
) -> Both<X> {
    let (zero, start, end) = (X::constant(0.0), starts(c.under_flat), (c.last + 1).min(N));
    let rise = both!(|k| c.now.shift[k] - motion.before[k]);
    let mut v = [[zero; N]; 2];
    for k in 0..2 {
        for j in 0..end {
            v[k][j] = s.get(k * N + j) + moved(c.limit(t, k, start[j]), rise[k], motion.by[k]);
        }
    }
    let mut old = None;
    if some_leave(t, c, motion.before[0]) {
        let (mut springs, mut leaves) = ([[zero; N]; 2], slip.trial.leaves);
        for k in 0..2 {
            for j in 0..end {
                springs[k][j] = s.get(k * N + j);
            }
        }
        leave(t, c, motion, [&mut springs, &mut v], &mut leaves);
        old = Some(springs);
    }
    let far = slip.slides > 0.0;
    let slides = if far { slid(t, c, &v, &slip.trial.v) } else { zero };
    let part = 0.5 * (1.0 + slip.slides);
    let theta = slides.chain(part, 0.5);
    for stage in 0..2 {
        let (middle, now) = if stage == 0 { (true, &slip.middle) } else { (false, &slip.end) };
        if now.set == 0 {
            continue;
        }
        let first = (now.set.trailing_zeros() as usize).min(end);
        let mut level = None;
        if A::DERIVED || far {
            level = Some([X::constant(1.0); N]);
        }
        if middle {
            if let Some(level) = &mut level {
                let before = limits_before(t, c, rise[0]);
                for i in first..end {
                    level[i] = level[i].times(before[i]) + theta.times(A::constant(1.0) - before[i]);
                }
            }
            in_part(
                &mut v,
                [&slip.trial.v, &slip.trial.old],
                (old.as_ref(), s),
                (far.then_some(theta), part),
                [first, end],
            );
        }
        slide(t, c, inverse, level.as_ref(), &mut v, now);
        if middle {
            let per = 1.0 / part;
            let part = (far.then_some(theta.chain(per, -per * per)), per);
            in_part(&mut v, [&now.v, &slip.trial.old], (old.as_ref(), s), part, [first, end]);
        }
    }
    finish(t, c, motion, slip, slides, &mut v, s)
}

/// Springs, with these values and those at the start, after a part of their motion, which is a constant if only its value is given.
#[inline(always)]
fn in_part<A: Real, X: Over<A>, S: Springs<X>>(
    v: &mut Both<Row<X>>,
    [values, old_values]: [&Both<Row<f64>>; 2],
    (old, s): (Option<&Both<Row<X>>>, &S),
    (part, value): (Option<X>, f64),
    [first, end]: [usize; 2],
) {
    for k in 0..2 {
        for j in first..end.min(N) {
            let old = if let Some(old) = old { old[k][j] } else { s.get(k * N + j) };
            let by = v[k][j] - old;
            v[k][j] = old
                + match part {
                    Some(part) => by.product(part, [values[k][j] - old_values[k][j], value]),
                    None => by.scale(value),
                };
        }
    }
}

/// The end of a step, from its springs: those of a contact that slides far are blended, the fine springs advance; the force.
#[inline(always)]
fn finish<A: Real, X: Over<A>, T: Tables<A>, S: Springs<X>>(
    t: &T,
    c: &Contact<A>,
    motion: &Motion<A, X>,
    slip: &Slips,
    part: X,
    v: &mut Both<Row<X>>,
    s: &mut S,
) -> Both<X> {
    let (zero, start, end) = (X::constant(0.0), starts(c.under_flat), (c.last + 1).min(N));
    let rise = both!(|k| c.now.shift[k] - motion.before[k]);
    let mut force = [zero; 2];
    let far = if slip.slides > 0.0 { Some(Far::new(t, c, part, v, slip)) } else { None };
    for k in 0..2 {
        for j in 0..end {
            if let Some(far) = &far {
                v[k][j] = far.blend(k, v[k][j], slip.v[k][j], c.limit(t, k, start[j]));
            }
            force[k].add_product(&v[k][j], c.stiffness(t, k, j));
        }
        for j in 0..N {
            s.put(k * N + j, v[k][j]);
        }
    }
    let (part, end) = (c.part.min(INSIDE - 1), c.part.min(INSIDE - 1) + 1);
    for f in 0..end {
        let w = both!(|k| c.fine(t, k, f));
        let limit = both!(|k| c.limit(t, k, f));
        let mut v = both!(|k| s.get(FINE_SPRING + k * FINE + f) + moved(limit[k], rise[k], motion.by[k]));
        v = returned_far(v, &limit, slip.fine.at(f), far.as_ref());
        for k in 0..2 {
            force[k].add_product(&v[k], w[k]);
            s.put(FINE_SPRING + k * FINE + f, v[k]);
        }
    }
    // The spring at the edge is another one under another load.
    let limit = both!(|k| c.limit_inside(k));
    let mut v = both!(|k| moved(limit[k], rise[k], motion.by[k]));
    if motion.constant_load {
        v = both!(|k| v[k] + s.get(FINE_SPRING + k * FINE + INSIDE));
    }
    v = returned_far(v, &limit, slip.fine.at(INSIDE), far.as_ref());
    for k in 0..2 {
        force[k].add_product(&v[k], c.fine_inside(k));
        s.put(FINE_SPRING + k * FINE + INSIDE, v[k]);
        for f in part + 1..INSIDE {
            s.put(FINE_SPRING + k * FINE + f, zero);
        }
    }
    force
}

/// A force within Coulomb's bound: its derivatives are those of the bound if it is beyond by more than rounding.
#[inline(always)]
pub(crate) fn bounded<X: Real>(force: Both<X>, bound: X) -> Both<X> {
    let square = force[0] * force[0] + force[1] * force[1];
    let largest = if X::DERIVED { ROUNDING } else { 1.0 } * bound.value() * bound.value();
    if square.value() > largest {
        let scale = square.at_least(TINY).sqrt().inverse() * bound;
        return both!(|k| force[k] * scale);
    }
    force
}

/// Gross slip in the direction of the force, `v = (S_b - S) e`, into which springs of a contact that slides far are blended.
pub(crate) struct Far<X> {
    rest: (X, f64),
    slides: Both<X>,
}

impl<X: Linear> Far<X> {
    #[inline(always)]
    fn new<A: Real>(t: &impl Tables<A>, c: &Contact<A>, part: X, v: &Both<Row<X>>, slip: &Slips) -> Far<X>
    where
        X: Over<A>,
    {
        let (mut force, mut values) = ([X::constant(0.0); 2], [0.0; 2]);
        for k in 0..2 {
            for j in 0..(c.last + 1).min(N) {
                let stiffness = c.stiffness(t, k, j);
                force[k].add_product(&v[k][j], stiffness);
                values[k] += slip.v[k][j] * stiffness.value();
            }
        }
        let square = values[0] * values[0] + values[1] * values[1];
        let per = 1.0 / if square > TINY { square } else { TINY }.sqrt();
        let along = force[0].scale(values[0] * per) + force[1].scale(values[1] * per);
        let per_length = part.product(along.chain(per, -per * per), [slip.slides, per]);
        Far {
            rest: (X::constant(1.0) - part, 1.0 - slip.slides),
            slides: both!(|k| force[k].product(per_length, [values[k], slip.slides * per])),
        }
    }

    /// A spring with this value.
    #[inline(always)]
    fn blend<A: Real>(&self, k: usize, v: X, value: f64, limit: A) -> X
    where
        X: Over<A>,
    {
        v.product(self.rest.0, [value, self.rest.1]) + self.slides[k].times(limit)
    }
}

/// A fine spring, returned to its limit if it slips, and blended if the contact slides far.
#[inline(always)]
fn returned_far<A: Real, X: Over<A>>(
    v: Both<X>,
    limit: &Both<A>,
    direction: [f64; 3],
    far: Option<&Far<X>>,
) -> Both<X> {
    let v = returned(v, limit, direction);
    let Some(far) = far else { return v };
    let ([x, y], [e_x, e_y, per_length]) = (both!(|k| limit[k].value()), direction);
    let length = if per_length > 0.0 { x * y } else { -1.0 / per_length };
    let values = [e_x * length / y, e_y * length / x];
    both!(|k| far.blend(k, v[k], values[k], limit[k]))
}

/// Springs that slip to the limits of their points, if these have derivatives: by a step of Newton's method from the slip, with C⁻¹.
#[inline(always)]
fn slide<A: Real, X: Over<A>, T: Tables<A>>(
    t: &T,
    c: &Contact<A>,
    inverse: &Both<Matrix>,
    level: Option<&Row<X>>,
    v: &mut Both<Row<X>>,
    slip: &Slip,
) {
    let (zero, end) = (X::constant(0.0), (c.last + 1).min(N));
    let first = (slip.set.trailing_zeros() as usize).min(end);
    if !slip.without_gaps(end) {
        slide_with_gaps(t, c, level, v, slip, [first, end]);
        return;
    }
    let mut own = None;
    if let Some(level) = level {
        own = Some(springs_at_limits(t, c, inverse, level, slip, [first, end]));
    }
    // The forces of what slips.
    for k in 0..2 {
        for j in first..end {
            let mut by = v[k][j];
            if let Some((springs, _)) = &own {
                by = by - springs[k][j];
            }
            v[k][j] = by.times(c.stiffness(t, k, j));
            if let Some((_, relaxed)) = &own {
                v[k][j] = v[k][j].minus(relaxed[k][j]);
            }
        }
    }
    let mut residual = [zero; N];
    for i in first..end {
        let mut sum = [zero; 2];
        for j in first..(i + 1).min(N) {
            for k in 0..2 {
                sum[k].add_scaled(&v[k][j], inverse[k][j][i]);
            }
        }
        residual[i] = sum[1].scale(slip.e[0][i]) - sum[0].scale(slip.e[1][i]);
    }
    let turn = product(&slip.inverse, [first, end], &residual);
    for j in first..end {
        let mut sum = if let Some((springs, _)) = &own { both!(|k| springs[k][j]) } else { [zero; 2] };
        for i in j..end {
            sum[0].add_scaled(&turn[i], -slip.e[1][i] * inverse[0][j][i]);
            sum[1].add_scaled(&turn[i], slip.e[0][i] * inverse[1][j][i]);
        }
        (v[0][j], v[1][j]) = (sum[0], sum[1]);
    }
}

/// The springs whose tractions are the limits, and the forces `C'σ` of the slip: derivatives of what is known.
#[inline(always)]
fn springs_at_limits<A: Real, X: Over<A>, T: Tables<A>>(
    t: &T,
    c: &Contact<A>,
    inverse: &Both<Matrix>,
    level: &Row<X>,
    slip: &Slip,
    [first, end]: [usize; 2],
) -> (Both<Row<X>>, Both<Row<A>>) {
    let (zero, end) = (A::constant(0.0), end.min(N));
    let (mut springs, mut relaxed, mut before) = ([*level; 2], [[zero; N]; 2], [zero; 2]);
    let (mut tractions, mut slips) = ([[zero; N]; 2], [[zero; N]; 2]);
    for i in first..end {
        for k in 0..2 {
            slips[k][i] = c.per_pressure[i].scale(slip.sigma[k][i]);
        }
    }
    for j in first..end {
        let fall = both!(|k| slip.v[k][j] - if j + 1 < end { slip.v[k][j + 1] } else { 0.0 });
        let mut sum = [zero; 2];
        for i in first..(j + 1).min(N) {
            for k in 0..2 {
                let map = c.map(t, k, j, i);
                tractions[k][i].add_scaled(&map, fall[k]);
                sum[k] = sum[k] + slips[k][i] * map;
            }
        }
        (relaxed[0][j], relaxed[1][j]) = (sum[0] - before[0], sum[1] - before[1]);
        before = sum;
    }
    for i in first..end {
        for k in 0..2 {
            springs[k][i] = level[i].scale(slip.e[k][i]).minus(tractions[k][i] * c.per_pressure[i]);
        }
    }
    for j in first..end {
        let mut sum = both!(|k| X::constant(slip.v[k][j]));
        for i in j..end {
            for k in 0..2 {
                sum[k].add_scaled(&springs[k][i], inverse[k][j][i]);
            }
        }
        (springs[0][j], springs[1][j]) = (sum[0], sum[1]);
    }
    (springs, relaxed)
}

/// The same if a point sticks outside one that slips: `σ = K (r* - l e)`.
#[inline(never)]
fn slide_with_gaps<A: Real, X: Over<A>, T: Tables<A>>(
    t: &T,
    c: &Contact<A>,
    level: Option<&Row<X>>,
    v: &mut Both<Row<X>>,
    slip: &Slip,
    [first, end]: [usize; 2],
) {
    let (zero, end) = (X::constant(0.0), end.min(N));
    let (first, mut slips, mut residual) = (first.min(end), [[zero; N]; 2], [zero; N]);
    for k in 0..2 {
        let (mut sigma, mut excess) = ([zero; N], [zero; N]);
        for i in first..end {
            sigma[i] = X::constant(if slip.contains(i) { slip.sigma[k][i] } else { 0.0 });
        }
        relax(t, c, k, &sigma, &mut v[k], [first, end]);
        for i in first..end {
            if slip.contains(i) {
                let mut sum = zero;
                for j in i..end {
                    let above = if j + 1 < end { v[k][j + 1] } else { zero };
                    sum.add_product(&(v[k][j] - above), c.map(t, k, j, i));
                }
                excess[i] = sum.times(c.per_pressure[i]);
                if let Some(level) = level {
                    excess[i].add_scaled(&level[i], -slip.e[k][i]);
                }
            }
        }
        slips[k] = product(&slip.k[k], [first, end], &excess);
    }
    for i in first..end {
        residual[i] = slips[1][i].scale(slip.e[0][i]) - slips[0][i].scale(slip.e[1][i]);
    }
    let turn = product(&slip.inverse, [first, end], &residual);
    for k in 0..2 {
        let (across, sign) = if k == 0 { (&slip.e[1], 1.0) } else { (&slip.e[0], -1.0) };
        let mut change = [zero; N];
        for i in first..end {
            if slip.contains(i) {
                change[i] = turn[i].scale(sign * across[i]);
            }
        }
        let mut sigma = product(&slip.k[k], [first, end], &change);
        for i in first..end {
            sigma[i] = sigma[i] + slips[k][i];
        }
        relax(t, c, k, &sigma, &mut v[k], [first, end]);
    }
}

/// Takes what slip relaxes from the springs: `w⁻¹ C'σ`.
#[inline(always)]
fn relax<A: Real, X: Over<A>, T: Tables<A>>(
    t: &T,
    c: &Contact<A>,
    k: usize,
    sigma: &Row<X>,
    v: &mut Row<X>,
    [first, end]: [usize; 2],
) {
    let mut before = X::constant(0.0);
    for j in first..end.min(N) {
        let mut sum = X::constant(0.0);
        for i in first..(j + 1).min(N) {
            sum.add_product(&sigma[i].times(c.per_pressure[i]), c.map(t, k, j, i));
        }
        v[j] = v[j] - (sum - before).times(c.flexibility(t, k, j));
        before = sum;
    }
}

/// Σ x_m matrix[m][i]: rows of points that stick are 0.
#[inline(always)]
fn product<X: Linear>(matrix: &Matrix, [first, end]: [usize; 2], x: &Row<X>) -> Row<X> {
    let mut y = [X::constant(0.0); N];
    for i in first..end {
        let mut sum = X::constant(0.0);
        for m in first..end {
            sum.add_scaled(&x[m], matrix[m][i]);
        }
        y[i] = sum;
    }
    y
}

/// A step of values whose slip is known, in the units of the springs: force, not yet bounded, and dissipated energy if requested.
pub(crate) fn advance(
    t: &Rows,
    [from, c]: [&Contact<f64>; 2],
    motion: &Motion<f64, f64>,
    slip: &Slips,
    energy: bool,
    springs: &mut Values,
) -> (Both<f64>, f64) {
    dispatch!({
        let (old, mut v) = (if energy { Some(*springs) } else { None }, slip.v);
        let force = finish(&t, c, motion, slip, slip.slides, &mut v, &mut &mut *springs);
        let dissipated =
            if let Some(old) = &old { dissipated(t, [from, c], motion, slip, [old, springs]) } else { 0.0 };
        (force, dissipated)
    })
}

/// Energy that the springs dissipate in a step, each from where its path leaves its limit.
#[inline(always)]
fn dissipated(
    t: &Rows,
    [from, c]: [&Contact<f64>; 2],
    motion: &Motion<f64, f64>,
    slip: &Slips,
    [old, new]: [&Values; 2],
) -> f64 {
    let rise = both!(|k| c.now.shift[k] - motion.before[k]);
    let mut energy = if rise[0] < 0.0 { separated(t, from, &c.now, motion.by, old) } else { 0.0 };
    let start = starts(c.under_flat);
    if !slip.is_empty() {
        for j in 0..(c.last + 1).min(N) {
            let w = both!(|k| c.stiffness(&t, k, j));
            let places = [[old[0][j], old[1][j]], [new[0][j], new[1][j]]];
            energy += slipped(t, c, start[j], w, places, motion, slip.slides);
        }
    }
    let at = |springs: &Values, f: usize| {
        both!(|k| springs.as_flattened().get(FINE_SPRING + k * FINE + f).copied().unwrap_or(0.0))
    };
    for f in 0..=c.part.min(INSIDE - 1) {
        let [x, y] = both!(|k| at(new, f)[k] / c.limit(&t, k, f));
        if slip.slides > 0.0 || x * x + y * y > SLIPPED {
            let w = both!(|k| c.fine(&t, k, f));
            energy += slipped(t, c, f, w, [at(old, f), at(new, f)], motion, slip.slides);
        }
    }
    if energy > 0.0 { energy } else { 0.0 }
}

/// Energy of a spring of stiffness w: it follows its trial path until it is as far from 0, over its limit, as at its end, and slips from there:
/// neighbours that turn keep it within its limit, which changes evenly on the way. A spring that slides far does so in its last direction.
#[inline(always)]
fn slipped(
    t: &Rows,
    c: &Contact<f64>,
    f: usize,
    w: Both<f64>,
    [old, new]: [Both<f64>; 2],
    motion: &Motion<f64, f64>,
    slides: f64,
) -> f64 {
    let limit = both!(|k| c.limit(&t, k, f));
    let per_limit = both!(|k| 1.0 / if limit[k] > LEAST { limit[k] } else { LEAST });
    let trial = both!(|k| old[k] + moved(limit[k], c.now.shift[k] - motion.before[k], motion.by[k]));
    let before = motion.before[0] - Tables::<f64>::at(&t, SHIFT, f);
    let ratio: f64 = if before > 0.0 { before * per_limit[0] } else { 0.0 };
    let (x, y) = (old[0] * per_limit[0], old[1] * per_limit[1]);
    let (t_x, t_y) = (trial[0] * per_limit[0], trial[1] * per_limit[1]);
    let (dx, dy, change) = (t_x - x, t_y - y, ratio - 1.0);
    let (end_x, end_y) = (new[0] * per_limit[0], new[1] * per_limit[1]);
    let end = end_x * end_x + end_y * end_y;
    let (qa, qb) = (dx * dx + dy * dy - end * change * change, x * dx + y * dy + end * ratio * change);
    let part = exit(qa, qb, x * x + y * y - end * ratio * ratio);
    let limit_there = slides * (ratio - change * part);
    let of = |k: usize| {
        let leaves = (1.0 - slides) * (old[k] + part * (trial[k] - old[k])) + limit_there * new[k];
        w[k] * (leaves + new[k]) * (trial[k] - new[k])
    };
    0.5 * (of(0) + of(1))
}

/// Energy of springs that lose contact in a step to a lower load: each slips from where it reaches its limit, which falls to 0 within the
/// part `limit/fall` of the motion, to nothing.
pub(crate) fn separated(t: &Rows, from: &Contact<f64>, now: &Pressed<f64>, by: Both<f64>, old: &Values) -> f64 {
    let (start, mut energy) = (starts(from.under_flat), 0.0);
    let fall = both!(|k| from.now.shift[k] - now.shift[k]);
    let mut lost = |f: usize, w: Both<f64>, old: Both<f64>| {
        if now.load > 0.0 && Tables::<f64>::at(&t, SHIFT, f) < now.shift[0] {
            return;
        }
        let limit = both!(|k| from.limit(&t, k, f).max(LEAST));
        let rate = both!(|k| limit[k] / fall[k].max(limit[k]) * by[k]);
        let (x, y, dx, dy) = (old[0] / limit[0], old[1] / limit[1], rate[0] / limit[0], rate[1] / limit[1]);
        let part = exit(dx * dx + dy * dy - 1.0, x * dx + y * dy + 1.0, x * x + y * y - 1.0);
        for k in 0..2 {
            let leaves = old[k] + part * rate[k];
            energy += 0.5 * w[k] * leaves * ((1.0 - part) * rate[k] + leaves);
        }
    };
    for j in 0..(from.last + 1).min(N) {
        lost(start[j], both!(|k| from.stiffness(&t, k, j)), [old[0][j], old[1][j]]);
    }
    let fine = |k: usize, f: usize| old.as_flattened().get(FINE_SPRING + k * FINE + f).copied().unwrap_or(0.0);
    for f in 0..=from.part.min(INSIDE - 1) {
        lost(f, both!(|k| from.fine(&t, k, f)), both!(|k| fine(k, f)));
    }
    if energy > 0.0 { energy } else { 0.0 }
}

/// The first t in [0, 1] at which `qa t² + 2 qb t + qc` becomes positive.
#[inline(always)]
fn exit(qa: f64, qb: f64, qc: f64) -> f64 {
    let square = qb * qb - qa * qc;
    let root = if square > 0.0 { square } else { 0.0 }.sqrt();
    // Quotients are at most 1 by their divisors: others may overflow.
    let ratio = |numerator: f64, divisor: f64| {
        let positive = if numerator > TINY { numerator } else { TINY };
        positive / if divisor > positive { divisor } else { positive }
    };
    let outwards = if qc < 0.0 { ratio(-qc, qb + root) } else { 0.0 };
    let inwards = if qa > 0.0 { ratio(root - qb, qa) } else { 1.0 };
    let part = if qb >= 0.0 { outwards } else { inwards };
    if part > 0.0 { part } else { 0.0 }
}
