//! A step under a constant load in which nothing slips: all springs follow the motion.

use super::contact::{Contact, Pressed};
use super::tables::{Both, FINE, INSIDE, LOAD, N, Rows, SHIFT, Tables};
use super::trial::{FINE_SPRING, ROUNDING, Values};
use crate::simd::dispatch;

/// Moves the springs, unless a point or a fine spring would slip.
pub(crate) fn stick(t: &Rows, c: &Contact<f64>, by: &Both<f64>, springs: &mut Values) -> bool {
    dispatch!(kernel, t: &Rows, c: &Contact<f64>, by: &Both<f64>, springs: &mut Values => bool)
}

#[inline(always)]
fn kernel(t: &Rows, c: &Contact<f64>, by: &Both<f64>, springs: &mut Values) -> bool {
    let (mut r, mut largest) = ([springs[2], springs[3]], [0.0; N]);
    for k in 0..2 {
        for i in 0..N {
            r[k][i] += c.edge[k][i] * c.per_pressure[i] * by[k];
        }
    }
    for i in 0..N {
        largest[i] = r[0][i] * r[0][i] + r[1][i] * r[1][i] - ROUNDING;
    }
    // Rows of fine springs, up to that of the part at the edge, whose last ones are not in use.
    let rows = FINE / N;
    let mut fine = *springs;
    for row in 0..rows {
        for j in 0..N {
            let edge = row * N + j == INSIDE;
            let inside = row * N + j <= c.part || edge;
            let (limit_x, limit_y) = (c.now.shift[0] - t[SHIFT + row][j], c.now.shift[1] - t[SHIFT + rows + row][j]);
            let (limit_x, limit_y) = if edge { (c.limit_inside(0), c.limit_inside(1)) } else { (limit_x, limit_y) };
            let (x, y) = (springs[FINE_SPRING / N + row][j] + by[0], springs[FINE_SPRING / N + rows + row][j] + by[1]);
            let (x, y) = (if inside { x } else { 0.0 }, if inside { y } else { 0.0 });
            let (across, along, bound) = (x * limit_y, y * limit_x, limit_x * limit_y);
            let excess = across * across + along * along - bound * bound;
            largest[j] = if inside && excess > largest[j] { excess } else { largest[j] };
            (fine[FINE_SPRING / N + row][j], fine[FINE_SPRING / N + rows + row][j]) = (x, y);
        }
    }
    let mut most = largest[0];
    for i in 1..N {
        most = if largest[i] > most { largest[i] } else { most };
    }
    if most > 0.0 {
        return false;
    }
    for k in 0..2 {
        for j in 0..N {
            fine[k][j] += if j <= c.last { by[k] } else { 0.0 };
        }
        fine[2 + k] = r[k];
    }
    *springs = fine;
    true
}

/// Stiffness of all springs together, and the derivatives of their force by the normal component, of which `slopes` are those of the contact.
pub(crate) fn tangent(t: &Rows, c: &Contact<f64>, slopes: &Pressed<f64>, springs: &Values) -> [Both<f64>; 2] {
    let mut derivatives = [[0.0; 2]; 2];
    let springs = springs.as_flattened();
    let at = |place: usize| springs.get(place).copied().unwrap_or(0.0);
    for k in 0..2 {
        // Secants that end at the edge and inside, and their derivatives.
        let secant = |from: [f64; 2], to: [f64; 2], to_slopes: [f64; 2], from_slopes: [f64; 2]| {
            let step = to[1] - from[1];
            let secant = (to[0] - from[0]) / step;
            [secant, (to_slopes[0] - from_slopes[0] - secant * (to_slopes[1] - from_slopes[1])) / step]
        };
        let node = |f: usize| [Tables::<f64>::at(&t, LOAD, f), Tables::<f64>::at(&t, SHIFT + k * FINE / N, f)];
        let of = |now: &Pressed<f64>| [[now.load, now.shift[k]], [now.inside[0], now.inside[1 + k]]];
        let ([edge, inside], [edge_slopes, inside_slopes]) = (of(&c.now), of(slopes));
        let [_, law] = secant(node(c.first_part), edge, edge_slopes, [0.0; 2]);
        let [_, fine] = secant(node(c.part), inside, inside_slopes, [0.0; 2]);
        let [stiffness, outer] = secant(inside, edge, edge_slopes, inside_slopes);
        let place = FINE_SPRING + k * FINE;
        derivatives[0][k] = stiffness;
        derivatives[1][k] = law * (at(k * N + c.last) - at(place + c.first_part))
            + fine * (at(place + c.part) - at(place + INSIDE))
            + outer * at(place + INSIDE);
    }
    derivatives
}
