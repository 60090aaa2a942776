//! The shell at the edge of the contact, which ends at the present size: all of the springs that depends on the load.

use super::springs::{Both, Fine, LEAST_STIFFNESS, MOST, PARTS, Pressed, PressedSlopes, Row, Springs, add, dot, used};
use crate::shape::TINY;
use crate::simd::dispatch;

/// The last shell.
#[derive(Debug, Clone, Copy)]
#[repr(align(32))]
pub(crate) struct Edge<const N: usize> {
    /// F_i of the shell at the points x_i, and the pressure there; 0 and 1 outside.
    pub reach: Row<N>,
    pub pressure: Row<N>,
    /// U_jl.
    pub column: Both<Row<N>>,
    /// Its node, and its part at the edge.
    pub last: usize,
    pub part: usize,
    /// S_b - S, W and w.
    pub step: Both<f64>,
    pub secant: Both<f64>,
    pub stiffness: Both<f64>,
    /// The same of its part at the edge; stiffnesses of all its parts in the fine correction.
    pub fine_step: Both<f64>,
    pub fine_secant: Both<f64>,
    pub fine_stiffness: Both<[f64; PARTS]>,
}

/// Numbers of an edge besides rows.
pub(crate) const EDGE_NUMBERS: usize = 12 + 2 * PARTS;
/// Rows of an edge.
pub(crate) const EDGE_ROWS: usize = 4;

impl<const N: usize> Edge<N> {
    pub const NONE: Edge<N> = Edge {
        reach: [0.0; N],
        pressure: [1.0; N],
        column: [[0.0; N]; 2],
        last: 0,
        part: 0,
        step: [1.0; 2],
        secant: [0.0; 2],
        stiffness: [0.0; 2],
        fine_step: [1.0; 2],
        fine_secant: [0.0; 2],
        fine_stiffness: [[0.0; PARTS]; 2],
    };

    #[inline(always)]
    pub fn new(springs: &Springs, now: &Pressed) -> Edge<N> {
        let last = springs.last_shell::<N>(now.shift[0]);
        Edge::of_shell(springs, now, last, springs.last_part(last, now.shift[0]))
    }

    /// With the edge in a part of a shell.
    #[inline(always)]
    pub fn of_shell(springs: &Springs, now: &Pressed, last: usize, part: usize) -> Edge<N> {
        dispatch!(Edge::of_shell_kernel(springs, now, last, part))
    }

    #[inline(always)]
    fn of_shell_kernel(springs: &Springs, now: &Pressed, last: usize, part: usize) -> Edge<N> {
        let (last, part) = (last.min(N - 1), part.min(PARTS - 1));
        let first = last <= springs.under_flat;
        let mut edge = Edge { last, part, ..Edge::NONE };
        [edge.reach, _] = springs.reach(last, now, &PressedSlopes::default());
        let mut pressure = edge.reach;
        for row in &springs.traction[springs.under_flat.min(last)..last] {
            for i in 0..N {
                pressure[i] += row[i];
            }
        }
        for i in 0..N {
            edge.pressure[i] = if i < last { pressure[i] } else { 1.0 };
        }
        for k in 0..2 {
            edge.step[k] = distance(now.shift[k], springs.shift[k][last]);
            edge.secant[k] = (now.load - springs.load[last]) / edge.step[k];
            let before = if last > 0 { springs.secant[k][last - 1] } else { 0.0 };
            edge.stiffness[k] = (edge.secant[k] - before).max(LEAST_STIFFNESS * edge.secant[k]).max(TINY);
            for j in 0..=last {
                edge.column[k][j] = edge.step[k] - dot(used(&springs.displacement[k][j]), &edge.reach);
            }
            // The fine correction.
            edge.fine_step[k] = distance(now.shift[k], springs.fine_shift[k][part][last]);
            edge.fine_secant[k] = (now.load - springs.fine_load[part][last]) / edge.fine_step[k];
            let law = edge.secant[k] - if first { 0.0 } else { before };
            let secant = |upper: [usize; 2], lower: [usize; 2]| {
                let rise = |rows: &Fine<MOST>| rows[upper[0]][upper[1]] - rows[lower[0]][lower[1]];
                rise(springs.fine_load) / rise(springs.fine_shift[k]).max(TINY)
            };
            let mut before = if first { 0.0 } else { secant([0, last], [PARTS - 1, last - 1]) };
            for r in 0..PARTS {
                let own = if r < part { secant([r + 1, last], [r, last]) } else { edge.fine_secant[k] };
                let less = if r == 0 { law } else { 0.0 };
                edge.fine_stiffness[k][r] = if r > part { 0.0 } else { own - before - less };
                before = own;
            }
        }
        edge.reach[last] = 1.0;
        edge
    }

    /// Its derivatives by those of the tables, of which `slopes` is a view, at the same load.
    #[inline(always)]
    pub fn slope(&self, springs: &Springs, slopes: &Springs, now: &Pressed) -> Edge<N> {
        let (last, part) = (self.last.min(N - 1), self.part.min(PARTS - 1));
        let first = last <= springs.under_flat;
        let mut change = Edge { last, part, pressure: [0.0; N], ..Edge::NONE };
        change.reach = springs.reach_slope(slopes, last, now);
        let mut pressure = change.reach;
        for row in &slopes.traction[springs.under_flat.min(last)..last] {
            for i in 0..N {
                pressure[i] += row[i];
            }
        }
        let mut reach = self.reach;
        for i in 0..N {
            change.pressure[i] = if i < last { pressure[i] } else { 0.0 };
            reach[i] = if i < last { reach[i] } else { 0.0 };
        }
        for k in 0..2 {
            change.step[k] = -slopes.shift[k][last];
            change.secant[k] = (-slopes.load[last] - self.secant[k] * change.step[k]) / self.step[k];
            let [before, before_slope] =
                if last > 0 { [springs, slopes].map(|tables| tables.secant[k][last - 1]) } else { [0.0; 2] };
            let least = self.secant[k] - before <= LEAST_STIFFNESS * self.secant[k];
            change.stiffness[k] =
                if least { LEAST_STIFFNESS * change.secant[k] } else { change.secant[k] - before_slope };
            for j in 0..=last {
                let (row, row_slope) = (used(&springs.displacement[k][j]), used(&slopes.displacement[k][j]));
                change.column[k][j] = change.step[k] - dot(row_slope, &reach) - dot(row, &change.reach);
            }
            // The fine correction.
            change.fine_step[k] = -slopes.fine_shift[k][part][last];
            change.fine_secant[k] =
                (-slopes.fine_load[part][last] - self.fine_secant[k] * change.fine_step[k]) / self.fine_step[k];
            let law = change.secant[k] - if first { 0.0 } else { before_slope };
            let at = |rows: &Fine<MOST>, [r, j]: [usize; 2]| rows[r.min(PARTS - 1)][j.min(N - 1)];
            let secant = |upper: [usize; 2], lower: [usize; 2]| {
                let rise = |rows: &Fine<MOST>| at(rows, upper) - at(rows, lower);
                let per_shift = 1.0 / rise(springs.fine_shift[k]).max(TINY);
                let value = rise(springs.fine_load) * per_shift;
                (rise(slopes.fine_load) - value * rise(slopes.fine_shift[k])) * per_shift
            };
            let mut before = if first { 0.0 } else { secant([0, last], [PARTS - 1, last - 1]) };
            for r in 0..PARTS {
                let own = if r < part { secant([r + 1, last], [r, last]) } else { change.fine_secant[k] };
                let less = if r == 0 { law } else { 0.0 };
                change.fine_stiffness[k][r] = if r > part { 0.0 } else { own - before - less };
                before = own;
            }
        }
        change
    }

    /// Stiffnesses of the springs; 0 outside.
    #[inline(always)]
    pub fn stiffnesses(&self, springs: &Springs, k: usize) -> Row<N> {
        let mut row = [0.0; N];
        for j in 0..N {
            let inner = if j < self.last { springs.stiffness[k][j] } else { 0.0 };
            row[j] = if j == self.last { self.stiffness[k] } else { inner };
        }
        row
    }

    /// Row j of U; 0 outside.
    #[inline(always)]
    pub fn displacement(&self, springs: &Springs, k: usize, j: usize) -> Row<N> {
        let (mut row, fixed, at_edge) = ([0.0; N], &springs.displacement[k][j], self.column[k][j]);
        for i in 0..N {
            let inner = if i < self.last { fixed[i] } else { 0.0 };
            row[i] = if i == self.last { at_edge } else { inner };
        }
        row
    }

    /// Tractions of springs; 0 outside.
    #[inline(always)]
    pub fn tractions(&self, springs: &Springs, k: usize, v: &Row<N>) -> Row<N> {
        let last = self.last.min(N - 1);
        let (mut q, at_edge) = ([0.0; N], v[last] / self.step[k]);
        for i in 0..N {
            q[i] = self.reach[i] * at_edge;
        }
        for j in 0..last {
            let density = (v[j] - v[j + 1]) * springs.per_step[k][j];
            add(&mut q, density, used(&springs.traction[j]));
        }
        q
    }

    /// The derivative of the tractions of the same springs.
    #[inline(always)]
    pub fn tractions_slope(&self, [springs, slopes]: [&Springs; 2], change: &Edge<N>, k: usize, v: &Row<N>) -> Row<N> {
        let last = self.last.min(N - 1);
        let at_edge = v[last] / self.step[k];
        let at_edge_slope = -at_edge * change.step[k] / self.step[k];
        let mut q = [0.0; N];
        for i in 0..N {
            q[i] = change.reach[i] * at_edge + self.reach[i] * at_edge_slope;
        }
        for j in 0..last {
            let difference = v[j] - v[j + 1];
            add(&mut q, difference * slopes.per_step[k][j], used(&springs.traction[j]));
            add(&mut q, difference * springs.per_step[k][j], used(&slopes.traction[j]));
        }
        q
    }
}

/// The distance from a node to the edge, not 0: for springs of slightly larger sizes, whose derivatives are needed, it may be negative.
#[inline(always)]
fn distance(edge: f64, node: f64) -> f64 {
    let distance = edge - node;
    if distance.abs() > TINY { distance } else { TINY }
}
