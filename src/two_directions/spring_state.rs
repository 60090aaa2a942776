//! The state of the springs: what a step changes.

use super::edge::{EDGE_NUMBERS, EDGE_ROWS, Edge};
use super::springs::{Both, Fine, PARTS, Row};

/// Displacements of the springs, tractions over the pressure at the points, the springs of the fine correction, and the edge.
#[derive(Debug, Clone, Copy)]
#[repr(align(32))]
pub(crate) struct SpringState<const N: usize> {
    pub v: Both<Row<N>>,
    pub tractions: Both<Row<N>>,
    pub fine: Both<Fine<N>>,
    pub edge: Edge<N>,
}

/// Rows of a state besides the edge.
const ROWS: usize = 4 + 2 * PARTS;

/// Number of doubles in a state of N springs.
pub(crate) const fn springs_length(n: usize) -> usize {
    n * (ROWS + EDGE_ROWS) + EDGE_NUMBERS.next_multiple_of(4)
}

/// The same in an array.
pub(crate) struct StoredSprings<'a, const N: usize> {
    pub v: &'a Both<Row<N>>,
    pub tractions: &'a Both<Row<N>>,
    pub fine: &'a Both<Fine<N>>,
    pub reach: &'a Row<N>,
    pub pressure: &'a Row<N>,
    column: &'a Both<Row<N>>,
    numbers: &'a [f64; EDGE_NUMBERS],
}

impl<'a, const N: usize> StoredSprings<'a, N> {
    #[inline(always)]
    pub fn new(values: &'a [f64]) -> Option<StoredSprings<'a, N>> {
        let (numbers, rows) = values.split_at_checked(EDGE_NUMBERS.next_multiple_of(4))?;
        let ([v, tractions, [reach, pressure], column], _) =
            rows.as_chunks::<N>().0.as_chunks::<2>().0.split_first_chunk()?;
        let fine = rows.as_chunks::<N>().0.get(4 + EDGE_ROWS..)?.as_chunks::<PARTS>().0.first_chunk()?;
        Some(StoredSprings { v, tractions, fine, reach, pressure, column, numbers: numbers.first_chunk()? })
    }

    /// The edge without its rows.
    #[inline(always)]
    pub fn edge(&self) -> Edge<N> {
        let [last, part, step_x, step_y, secant_x, secant_y, w_x, w_y, fine_x, fine_y, fine_w_x, fine_w_y, own @ ..] =
            self.numbers;
        let mut fine_stiffness = [[0.0; PARTS]; 2];
        fine_stiffness.as_flattened_mut().iter_mut().zip(own).for_each(|(to, from)| *to = *from);
        // Counts from outside the process may be too large.
        Edge {
            last: (*last as usize).min(N - 1),
            part: (*part as usize).min(PARTS - 1),
            step: [*step_x, *step_y],
            secant: [*secant_x, *secant_y],
            stiffness: [*w_x, *w_y],
            fine_step: [*fine_x, *fine_y],
            fine_secant: [*fine_w_x, *fine_w_y],
            fine_stiffness,
            ..Edge::NONE
        }
    }

    /// Whether tractions and pressures are within their limits.
    pub fn is_within(&self) -> bool {
        let [x, y] = self.tractions;
        let bounded = |x: f64, y: f64| x.abs() <= 2.0 && y.abs() <= 2.0 && x * x + y * y <= 1.0 + 1e-9;
        let edge = self.edge();
        x.iter().zip(y).all(|(x, y)| bounded(*x, *y))
            && self.reach.iter().all(|value| *value >= 0.0)
            && self.pressure.iter().all(|value| *value > 0.0)
            && edge.step.iter().chain(&edge.fine_step).all(|value| *value > 0.0)
    }

    #[inline(never)]
    pub fn copied(&self) -> SpringState<N> {
        let edge = Edge { reach: *self.reach, pressure: *self.pressure, column: *self.column, ..self.edge() };
        SpringState { v: *self.v, tractions: *self.tractions, fine: *self.fine, edge }
    }
}

impl<const N: usize> SpringState<N> {
    pub const RELAXED: SpringState<N> =
        SpringState { v: [[0.0; N]; 2], tractions: [[0.0; N]; 2], fine: [[[0.0; N]; PARTS]; 2], edge: Edge::NONE };

    /// Writes the state to an array.
    pub fn write(&self, values: &mut [f64]) {
        let Edge { step, secant, stiffness, fine_step, fine_secant, fine_stiffness, .. } = &self.edge;
        let mut rest = values;
        let mut put = |from: &[f64]| {
            if let Some((values, behind)) = core::mem::take(&mut rest).split_at_mut_checked(from.len()) {
                values.copy_from_slice(from);
                rest = behind;
            }
        };
        put(&[self.edge.last as f64, self.edge.part as f64]);
        [step, secant, stiffness, fine_step, fine_secant].into_iter().for_each(|pair| put(pair));
        put(fine_stiffness.as_flattened());
        put(&[0.0; EDGE_NUMBERS.next_multiple_of(4) - EDGE_NUMBERS]);
        put(self.v.as_flattened());
        put(self.tractions.as_flattened());
        put(&self.edge.reach);
        put(&self.edge.pressure);
        put(self.edge.column.as_flattened());
        put(self.fine.as_flattened().as_flattened());
    }
}

/// A motion over more than this many slip displacements is shortened to it: the force does not depend on the rest, and the energy is
/// proportional.
pub(super) const LONGEST: f64 = 1e9;
