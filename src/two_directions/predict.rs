//! The direction of a slip: the weight β of the traction at the start of a step, and the part in which a contact slides far.
//!
//! Points that slipped before, |r0| near 1, turn during a step: β is `(2 |r0|² - 1)²` times the cosine of the angle between r0 and the traction
//! r* of the trial state, 0 if that is negative, and falls with the displacement of the spring over its limit. All are known before the
//! slip is found. From 5 slip displacements on the springs end in gross slip in one direction.

use super::contact::Contact;
use super::scalar::{Over, Real, both};
use super::tables::{Both, N, Row, Tables};

/// Displacements of the innermost spring over its limit between which a contact that slides forgets.
const FAR: [f64; 2] = [2.5, 5.0];

/// The weight β of r0 in the direction `r + β r0` of the slip of a point, whose traction is r* and whose spring is that far over its limit in
/// the trial state.
#[inline(always)]
pub(crate) fn bend<X: Real>(start: &Both<X>, trial: &Both<X>, over_limit: &Both<X>) -> X {
    let from = both!(|k| start[k].value());
    let to = both!(|k| trial[k].value());
    let at = both!(|k| over_limit[k].value());
    let u = 2.0 * (from[0] * from[0] + from[1] * from[1]) - 1.0;
    let along = from[0] * to[0] + from[1] * to[1];
    if u <= 0.0 || along <= 0.0 {
        return X::constant(0.0);
    }
    let square = to[0] * to[0] + to[1] * to[1];
    let length = (at[0] * at[0] + at[1] * at[1]).sqrt();
    let over = if length > 1.0 { length - 1.0 } else { 0.0 };
    let farther = 1.0 / (1.0 + FARTHER * over);
    let value = u * u * along / square.sqrt() * farther;
    let mut bend = X::constant(value);
    for k in 0..2 {
        bend.add_slopes(&start[k], value * (8.0 * from[k] / u + to[k] / along));
        bend.add_slopes(&trial[k], value * (from[k] / along - to[k] / square));
        if over > 0.0 {
            bend.add_slopes(&over_limit[k], -value * FARTHER * farther * at[k] / length);
        }
    }
    bend
}

/// Fall of β with the excess of a spring over its limit.
const FARTHER: f64 = 1.0 / 3.0;

/// The part in which a contact that slides far forgets, from its trial state.
#[inline(always)]
pub(crate) fn slid<A: Real, X: Over<A>, T: Tables<A>>(t: &T, c: &Contact<A>, v: &Both<Row<X>>) -> X {
    let over = length(&both!(|k| v[k][0]), &both!(|k| c.limit(t, k, 0)));
    if over.value() <= FAR[0] {
        return X::constant(0.0);
    }
    if over.value() >= FAR[1] {
        return X::constant(1.0);
    }
    let part = (over - X::constant(FAR[0])).scale(1.0 / (FAR[1] - FAR[0]));
    part * part * (X::constant(3.0) - part.scale(2.0))
}

/// The size of a vector in units of both directions; 0 without derivatives.
#[inline(always)]
fn length<A: Real, X: Over<A>>(v: &Both<X>, unit: &Both<A>) -> X {
    let [x, y] = both!(|k| v[k].times(unit[k].inverse()));
    let square = x * x + y * y;
    if square.value() > f64::MIN_POSITIVE { square.sqrt() } else { X::constant(0.0) }
}

/// Removes a slip from the springs: `v - w⁻¹ C' σ`, from σ over the pressure.
#[inline(always)]
pub(crate) fn release<A: Real, X: Over<A>, T: Tables<A>>(
    t: &T,
    c: &Contact<A>,
    k: usize,
    sigma: &Row<X>,
    set: u32,
    v: &mut Row<X>,
) {
    let last = c.last.min(N - 1);
    let first = (set.trailing_zeros() as usize).min(last);
    let mut before = X::constant(0.0);
    for j in first..=last {
        let mut sum = X::constant(0.0);
        for i in first..=j {
            if set >> i & 1 == 1 {
                sum.add_product(&sigma[i], c.map(t, k, j, i));
            }
        }
        v[j] = v[j] - (sum - before).times(c.flexibility(t, k, j));
        before = sum;
    }
}
