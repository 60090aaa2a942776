//! A step under a constant load in which nothing slips: all springs follow the motion, which the state keeps as one offset.

use super::spring_state::{SpringState, StoredSprings};
use super::step::ROUNDING;
use crate::element::springs::{Both, FINE, Pressed, SPRINGS, Springs};
use crate::shape::TINY;
use crate::simd::dispatch;

/// The spring at the edge of each bank: its stiffness is that of all springs together, W.
struct Edges {
    last: usize,
    fine_last: usize,
    /// S_b - S.
    step: Both<f64>,
    fine_step: Both<f64>,
}

impl Edges {
    #[inline(always)]
    fn new(springs: &Springs, now: &Pressed) -> Edges {
        let last = springs.last_shell(now.shift[0]);
        let fine_last = springs.last_fine_shell(last, now.shift[0]);
        let distance = |shift: &Both<f64>| [0, 1].map(|k| (now.shift[k] - shift[k]).max(TINY));
        let step = distance(&[springs.shift[0][last], springs.shift[1][last]]);
        let fine_step = distance(&[springs.fine_shift[0][fine_last], springs.fine_shift[1][fine_last]]);
        Edges { last, fine_last, step, fine_step }
    }
}

/// Stiffness, and derivatives of the force with respect to the load and to the shift.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stuck {
    pub stiffness: Both<f64>,
    pub per_load: Both<f64>,
    pub per_shift: Both<f64>,
}

/// The contact if nothing slips with the offset, from the state without.
#[inline(always)]
pub(crate) fn stuck(springs: &Springs, state: &StoredSprings, now: &Pressed, offset: &Both<f64>) -> Option<Stuck> {
    dispatch!(kernel, springs: &Springs, state: &StoredSprings, now: &Pressed, offset: &Both<f64> => Option<Stuck>)
}

#[inline(always)]
fn kernel(springs: &Springs, state: &StoredSprings, now: &Pressed, offset: &Both<f64>) -> Option<Stuck> {
    let Edges { last, fine_last, step, fine_step } = Edges::new(springs, now);
    let per_step = [offset[0] / step[0], offset[1] / step[1]];
    let mut slips = false;
    for i in 0..SPRINGS {
        let p = state.pressure[i];
        let x = state.tractions[0][i] * p + state.shell_pressure[i] * per_step[0];
        let y = state.tractions[1][i] * p + state.shell_pressure[i] * per_step[1];
        slips |= x * x + y * y > p * p * (1.0 + ROUNDING);
    }
    // The fourth powers of large limits overflow.
    let per_shift = 1.0 / now.shift[1];
    for j in 0..FINE {
        let inside = j <= fine_last;
        let limit = [0, 1].map(|k| if inside { now.shift[k] - springs.fine_shift[k][j] } else { 1.0 });
        let value = [0, 1].map(|k| if inside { state.fine[k][j] + offset[k] } else { 0.0 });
        let lateral = limit[1] * per_shift;
        let (x, y, bound) = (value[0] * lateral, value[1] * per_shift * limit[0], limit[0] * lateral);
        slips |= x * x + y * y > bound * bound;
    }
    if slips {
        return None;
    }
    let coarse = springs.fine_node(last);
    let mut stuck = Stuck { stiffness: [0.0; 2], per_load: [0.0; 2], per_shift: [0.0; 2] };
    for k in 0..2 {
        let secant = (now.load - springs.load[last]) / step[k];
        let fine_secant = (now.load - springs.fine_load[fine_last]) / fine_step[k];
        stuck.stiffness[k] = fine_secant;
        // Of the springs at the edge, which change with the load.
        let coarse = (state.springs[k][last] - state.fine[k][coarse]) / step[k];
        let fine = (state.fine[k][fine_last] + offset[k]) / fine_step[k];
        stuck.per_load[k] = coarse + fine;
        stuck.per_shift[k] = -(coarse * secant + fine * fine_secant);
    }
    Some(stuck)
}

/// Adds the offset to the state.
#[inline(always)]
pub(crate) fn settle(springs: &Springs, state: &mut SpringState, now: &Pressed, offset: &Both<f64>) {
    let Edges { last, fine_last, step, .. } = Edges::new(springs, now);
    for k in 0..2 {
        for i in 0..SPRINGS {
            if i <= last {
                state.springs[k][i] += offset[k];
                state.tractions[k][i] += state.shell_pressure[i] * offset[k] / step[k] / state.pressure[i].max(TINY);
            }
        }
        for j in 0..FINE {
            state.fine[k][j] += if j <= fine_last { offset[k] } else { 0.0 };
        }
    }
}
