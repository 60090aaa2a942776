//! A step under a constant load in which nothing slips: all springs follow the motion, which the state keeps as one offset.

use super::edge::Edge;
use super::fine;
use super::spring_state::{SpringState, StoredSprings};
use super::springs::{Both, PARTS, Pressed, Springs, largest};
use super::step::{ROUNDING, SLIPPED};
use crate::simd::dispatch;

/// Stiffness, and derivatives of the force with respect to the load and to the shift.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stuck {
    pub stiffness: Both<f64>,
    /// Whether a point is at its limit, so that another load makes it slip.
    pub at_limit: bool,
    pub per_load: Both<f64>,
    pub per_shift: Both<f64>,
}

/// The contact if nothing slips with the offset, from the state without.
#[inline(always)]
pub(crate) fn stuck<const N: usize>(
    springs: &Springs,
    state: &StoredSprings<N>,
    now: &Pressed,
    offset: &Both<f64>,
) -> Option<Stuck> {
    dispatch!(kernel(springs, state, now, offset))
}

#[inline(always)]
fn kernel<const N: usize>(
    springs: &Springs,
    state: &StoredSprings<N>,
    now: &Pressed,
    offset: &Both<f64>,
) -> Option<Stuck> {
    let edge: &Edge<N> = &state.edge();
    let last = edge.last.min(N - 1);
    let per_step = [offset[0] / edge.step[0], offset[1] / edge.step[1]];
    let (mut beyond, mut squares) = ([0.0; N], [0.0; N]);
    let [x, y] = state.tractions;
    for i in 0..N {
        let p = state.pressure[i];
        squares[i] = x[i] * x[i] + y[i] * y[i];
        let x = x[i] * p + state.reach[i] * per_step[0];
        let y = y[i] * p + state.reach[i] * per_step[1];
        beyond[i] = x * x + y * y - p * p * (1.0 + ROUNDING);
    }
    for r in 0..PARTS {
        let stop = if r <= edge.part { last + 1 } else { last };
        let limit = fine::limits(springs, edge, &now.shift, r);
        for j in 0..N {
            let inside = j >= springs.under_flat && j < stop;
            let (x, y) =
                ((state.fine[0][r][j] + offset[0]) * limit[1][j], (state.fine[1][r][j] + offset[1]) * limit[0][j]);
            let bound = limit[0][j] * limit[1][j];
            let excess = x * x + y * y - bound * bound;
            beyond[j] = if inside && excess > beyond[j] { excess } else { beyond[j] };
        }
    }
    if largest(&beyond) > 0.0 {
        return None;
    }
    let at_limit = largest(&squares) > SLIPPED;
    let mut stuck = Stuck { stiffness: edge.fine_secant, at_limit, per_load: [0.0; 2], per_shift: [0.0; 2] };
    for k in 0..2 {
        // Of the springs at the edge, which change with the load.
        let law = (state.v[k][last] - state.fine[k][0][last]) / edge.step[k];
        let fine = (state.fine[k][edge.part.min(PARTS - 1)][last] + offset[k]) / edge.fine_step[k];
        stuck.per_load[k] = law + fine;
        stuck.per_shift[k] = -(law * edge.secant[k] + fine * edge.fine_secant[k]);
    }
    Some(stuck)
}

/// Adds the offset to the state.
#[inline(never)]
pub(crate) fn settle<const N: usize>(springs: &Springs, state: &mut SpringState<N>, offset: &Both<f64>) {
    let edge = &state.edge;
    for k in 0..2 {
        for i in 0..=edge.last.min(N - 1) {
            state.v[k][i] += offset[k];
            state.tractions[k][i] += edge.reach[i] * offset[k] / edge.step[k] / edge.pressure[i];
        }
        for r in 0..PARTS {
            let stop = if r <= edge.part { edge.last + 1 } else { edge.last };
            for j in springs.under_flat..stop.min(N) {
                state.fine[k][r][j] += offset[k];
            }
        }
    }
}
