//! A step under a constant load in which nothing slips: all springs follow the motion, which the state keeps as one offset.

use super::edge::Edge;
use super::spring_state::{SpringState, StoredSprings};
use super::springs::{Both, largest};
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
pub(crate) fn stuck<const N: usize>(state: &StoredSprings<N>, offset: &Both<f64>) -> Option<Stuck> {
    dispatch!(
        kernel,
        [const N: usize]
        state: &StoredSprings<N>,
        offset: &Both<f64> => Option<Stuck>
    )
}

#[inline(always)]
fn kernel<const N: usize>(state: &StoredSprings<N>, offset: &Both<f64>) -> Option<Stuck> {
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
    if largest(&beyond) > 0.0 {
        return None;
    }
    let at_limit = largest(&squares) > SLIPPED;
    let mut stuck = Stuck { stiffness: edge.secant, at_limit, per_load: [0.0; 2], per_shift: [0.0; 2] };
    for k in 0..2 {
        // Of the spring at the edge, which changes with the load.
        stuck.per_load[k] = (state.v[k][last] + offset[k]) / edge.step[k];
        stuck.per_shift[k] = -stuck.per_load[k] * edge.secant[k];
    }
    Some(stuck)
}

/// Adds the offset to the state.
#[inline(always)]
pub(crate) fn settle<const N: usize>(state: &mut SpringState<N>, offset: &Both<f64>) {
    let edge = &state.edge;
    for k in 0..2 {
        for i in 0..=edge.last.min(N - 1) {
            state.v[k][i] += offset[k];
            state.tractions[k][i] += edge.reach[i] * offset[k] / edge.step[k] / edge.pressure[i];
        }
    }
}
