//! A step under a constant load in which nothing slips: all springs follow the motion.

use super::contact::Contact;
use super::matrix::largest;
use super::scalar::{Dual, Linear, Over, both};
use super::tables::{Both, DualRows, END, FINE, INSIDE, N, Rows, SHIFT, THINNEST};
use super::trial::{FINE_SPRING, ROUNDING, Values, direction, returned};
use crate::simd::dispatch;

/// Moves the springs and their force if no point slips, unless a fine spring would slip or the force exceeds its bound; the displacement of the
/// fine spring at the edge, which may slip, before it returns to its limit.
pub(crate) fn stick(
    t: &Rows,
    c: &Contact<f64>,
    by: &Both<f64>,
    springs: &mut Values,
    force: &mut Both<f64>,
) -> Option<Both<f64>> {
    dispatch!({
        // Rows of fine springs, and the nodes up to the part at the edge.
        let (rows, first, inside) = (FINE / N, FINE_SPRING / N, c.now.inside[1] * (1.0 - THINNEST));
        // 1 for the springs in use, 0 for others.
        let (mut most, mut parts) = ([0.0; N], [[0.0; N]; FINE / N + 1]);
        for j in 0..N {
            parts[rows][j] = if j <= c.last { 1.0 } else { 0.0 };
        }
        for row in 0..rows {
            let nodes = [&t[SHIFT + row], &t[SHIFT + rows + row]];
            for j in 0..N {
                let limit = both!(|k| c.now.shift[k] - nodes[k][j]);
                let v = both!(|k| springs[first + k * rows + row][j] + by[k]);
                let (across, along, bound) = (v[0] * limit[1], v[1] * limit[0], limit[0] * limit[1]);
                let excess = across * across + along * along - ROUNDING * (bound * bound);
                parts[row][j] = if nodes[0][j] < inside { 1.0 } else { 0.0 };
                let excess = parts[row][j] * excess;
                most[j] = if excess > most[j] { excess } else { most[j] };
            }
        }
        let edge = both!(|k| springs[(FINE_SPRING + k * FINE + INSIDE) / N][INSIDE % N] + by[k]);
        let limit = both!(|k| c.limit_inside(k));
        let ends = returned(edge, &limit, direction(edge, limit));
        let moved = both!(|k| force[k] + by[k] * c.total(k) + c.fine_inside(k) * (ends[k] - edge[k]));
        if largest(&most) > 0.0 || moved[0] * moved[0] + moved[1] * moved[1] > ROUNDING * c.now.load * c.now.load {
            return None;
        }
        *force = moved;
        for k in 0..2 {
            for row in 0..=rows {
                let place = if row < rows { first + k * rows + row } else { k };
                let mut v = springs[place];
                for j in 0..N {
                    v[j] += parts[row][j] * by[k];
                }
                springs[place] = v;
            }
        }
        for k in 0..2 {
            springs[(FINE_SPRING + k * FINE + INSIDE) / N][INSIDE % N] = ends[k];
        }
        Some(edge)
    })
}

/// Derivatives of the force of such a step: by the normal component and by both displacements of the springs.
pub(crate) fn tangent(t: &Rows, c: &Contact<f64>, edge: &Both<f64>, springs: &Values) -> Both<[f64; 4]> {
    let springs = springs.as_flattened();
    let at = |place: usize| springs.get(place).copied().unwrap_or(0.0);
    let rows = DualRows::without_slopes(t);
    let derived = c.derived(&rows, false);
    let edge = [Dual([[0.0, 1.0, 0.0, edge[0]]]), Dual([[0.0, 0.0, 1.0, edge[1]]])];
    let limit = both!(|k| derived.limit_inside(k));
    let direction = direction(edge.map(|x| x.value()), both!(|k| c.limit_inside(k)));
    let ends = returned(edge, &limit, direction);
    both!(|k| {
        let fine = |f: usize| derived.fine(&rows, k, f).0[0][END] * at(FINE_SPRING + k * FINE + f);
        let [mut slopes] = ends[k].times(derived.fine_inside(k)).0;
        slopes[END] += derived.stiffness[k].0[0][END] * at(k * N + c.last);
        slopes[END] += (c.first_edge()..=c.part).map(fine).sum::<f64>();
        slopes[1 + k] += c.total(k) - c.fine_inside(k);
        slopes
    })
}
