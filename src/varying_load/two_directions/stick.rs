//! A step under a constant load in which nothing slips: all springs follow the motion, which the state keeps as one offset.

use super::edge::Pressed;
use super::fine::FineRow;
use super::springs::{Both, FINE, Row, SPRINGS, Springs};
use super::step::{Memory, ROUNDING};
use crate::shape::TINY;

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

/// A memory in a state.
pub(crate) struct Stored<'a> {
    pub springs: Both<&'a Row>,
    pub tractions: Both<&'a Row>,
    pub reach: &'a Row,
    pub pressure: &'a Row,
    pub fine: Both<&'a FineRow>,
}

impl<'a> Stored<'a> {
    /// From the values behind the header of a state.
    #[inline(always)]
    pub fn new(values: &'a [f64]) -> Option<Stored<'a>> {
        let (springs_x, rest) = values.split_first_chunk()?;
        let (springs_y, rest) = rest.split_first_chunk()?;
        let (tractions_x, rest) = rest.split_first_chunk()?;
        let (tractions_y, rest) = rest.split_first_chunk()?;
        let (reach, rest) = rest.split_first_chunk()?;
        let (pressure, rest) = rest.split_first_chunk()?;
        let (fine_x, rest) = rest.split_first_chunk()?;
        let fine_y = rest.first_chunk()?;
        Some(Stored {
            springs: [springs_x, springs_y],
            tractions: [tractions_x, tractions_y],
            reach,
            pressure,
            fine: [fine_x, fine_y],
        })
    }

    pub fn copy_to(&self, memory: &mut Memory) {
        for k in 0..2 {
            (memory.springs[k], memory.tractions[k]) = (*self.springs[k], *self.tractions[k]);
            memory.fine[k] = *self.fine[k];
        }
        (memory.reach, memory.pressure) = (*self.reach, *self.pressure);
    }
}

/// The contact if nothing slips with the offset, from the memory without.
#[inline(always)]
pub(crate) fn stuck(springs: &Springs, memory: &Stored, now: &Pressed, offset: &Both<f64>) -> Option<Stuck> {
    let Edges { last, fine_last, step, fine_step } = Edges::new(springs, now);
    let per_step = [offset[0] / step[0], offset[1] / step[1]];
    let mut slips = false;
    for i in 0..SPRINGS {
        let p = memory.pressure[i];
        let x = memory.tractions[0][i] * p + memory.reach[i] * per_step[0];
        let y = memory.tractions[1][i] * p + memory.reach[i] * per_step[1];
        slips |= x * x + y * y > p * p * (1.0 + ROUNDING);
    }
    // The fourth powers of large limits overflow.
    let per_shift = 1.0 / now.shift[1];
    for j in 0..FINE {
        let inside = j <= fine_last;
        let limit = [0, 1].map(|k| if inside { now.shift[k] - springs.fine_shift[k][j] } else { 1.0 });
        let value = [0, 1].map(|k| if inside { memory.fine[k][j] + offset[k] } else { 0.0 });
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
        let coarse = (memory.springs[k][last] - memory.fine[k][coarse]) / step[k];
        let fine = (memory.fine[k][fine_last] + offset[k]) / fine_step[k];
        stuck.per_load[k] = coarse + fine;
        stuck.per_shift[k] = -(coarse * secant + fine * fine_secant);
    }
    Some(stuck)
}

/// Adds the offset to the memory.
#[inline(always)]
pub(crate) fn settle(springs: &Springs, memory: &mut Memory, now: &Pressed, offset: &Both<f64>) {
    let Edges { last, fine_last, step, .. } = Edges::new(springs, now);
    for k in 0..2 {
        for i in 0..SPRINGS {
            if i <= last {
                memory.springs[k][i] += offset[k];
                memory.tractions[k][i] += memory.reach[i] * offset[k] / step[k] / memory.pressure[i].max(TINY);
            }
        }
        for j in 0..FINE {
            memory.fine[k][j] += if j <= fine_last { offset[k] } else { 0.0 };
        }
    }
}
