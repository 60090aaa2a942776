//! A step under a constant load in which nothing slips: all springs follow the motion.

use super::contact::{Contact, Pressed};
use super::scalar::{Dual, Linear, Over, both};
use super::tables::{Both, DualRows, END, FINE, INSIDE, N, Rows, SHIFT};
use super::trial::{FINE_SPRING, ROUNDING, Values, direction, returned, tractions};
use crate::simd::dispatch;

/// Moves the springs and their force, unless a point or a fine spring would slip or the force exceeds its bound; the displacement of the fine
/// spring at the edge, which may slip, before it returns to its limit.
pub(crate) fn stick(
    t: &Rows,
    c: &Contact<f64>,
    by: &Both<f64>,
    springs: &mut Values,
    force: &mut Both<f64>,
) -> Option<Both<f64>> {
    dispatch!({
        let mut largest = [0.0; N];
        let mut r = both!(|k| tractions(t, c, k, &springs[k], 0));
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
                let inside = row * N + j <= c.part;
                let (limit_x, limit_y) =
                    (c.now.shift[0] - t[SHIFT + row][j], c.now.shift[1] - t[SHIFT + rows + row][j]);
                let (x, y) =
                    (springs[FINE_SPRING / N + row][j] + by[0], springs[FINE_SPRING / N + rows + row][j] + by[1]);
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
            return None;
        }
        let edge = both!(|k| springs[(FINE_SPRING + k * FINE + INSIDE) / N][INSIDE % N] + by[k]);
        let limit = both!(|k| c.limit_inside(k));
        let ends = returned(edge, &limit, direction(edge, limit));
        let moved = both!(|k| force[k] + by[k] * c.total(k) + c.fine_inside(k) * (ends[k] - edge[k]));
        if moved[0] * moved[0] + moved[1] * moved[1] > c.now.load * c.now.load {
            return None;
        }
        *force = moved;
        for k in 0..2 {
            for j in 0..=c.last.min(N - 1) {
                fine[k][j] += by[k];
            }
            fine[(FINE_SPRING + k * FINE + INSIDE) / N][INSIDE % N] = ends[k];
        }
        *springs = fine;
        Some(edge)
    })
}

/// Derivatives of the force of such a step: by the normal component, of which `slopes` are those of the contact, and by both displacements of
/// the springs.
pub(crate) fn tangent(
    t: &Rows,
    c: &Contact<f64>,
    slopes: &Pressed<f64>,
    edge: &Both<f64>,
    springs: &Values,
) -> Both<[f64; 4]> {
    let springs = springs.as_flattened();
    let at = |place: usize| springs.get(place).copied().unwrap_or(0.0);
    let rows = DualRows::without_slopes(t);
    let derived = c.derived(&rows, slopes);
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
