//! The shell at the edge of the contact, which ends at the present size, and the map from springs to tractions with it.

use crate::element::springs::{Both, LEAST_STIFFNESS, Pressed, Row, SPRINGS, Springs, add, dot, root_difference};
use crate::shape::TINY;

/// The part of a motion that a spring follows: all, unless the load rises to its size within the step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Share {
    /// 1/ΔS; 0 unless the load rises.
    pub per_rise: Both<f64>,
}

impl Share {
    #[inline(always)]
    pub fn new(before: &Pressed, now: &Pressed) -> Share {
        let per = |k: usize| {
            let rise = now.shift[k] - before.shift[k];
            if rise > 0.0 { 1.0 / rise.max(TINY) } else { 0.0 }
        };
        Share { per_rise: [per(0), per(1)] }
    }

    /// For the distance S_b - S_j.
    #[inline(always)]
    pub fn of(&self, k: usize, limit: f64) -> f64 {
        // Negative for springs outside, of which some have a shift near the largest double.
        let share = limit.max(0.0) * self.per_rise[k];
        if self.per_rise[k] > 0.0 && share < 1.0 { share } else { 1.0 }
    }
}

/// The last shell.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Edge {
    /// Its node.
    pub last: usize,
    /// S_b - S and the root of the stiffness of its spring.
    pub step: Both<f64>,
    pub root: Both<f64>,
    /// W of the shell.
    pub secant: Both<f64>,
    /// F_i of the shell at the points x_i, and the pressure there.
    pub shell_pressure: Row,
    pub pressure: Row,
}

impl Edge {
    pub const NONE: Edge = Edge {
        last: 0,
        step: [1.0; 2],
        root: [1.0; 2],
        secant: [0.0; 2],
        shell_pressure: [0.0; SPRINGS],
        pressure: [0.0; SPRINGS],
    };

    /// The edge of a contact; `cached` are both pressures under the same load.
    #[inline(always)]
    pub fn new(springs: &Springs, now: &Pressed, cached: Option<(&Row, &Row)>) -> Edge {
        let last = springs.last_shell(now.shift[0]);
        let mut edge = Edge {
            last,
            step: [0.0; 2],
            root: [0.0; 2],
            secant: [0.0; 2],
            shell_pressure: [0.0; SPRINGS],
            pressure: [0.0; SPRINGS],
        };
        for k in 0..2 {
            edge.step[k] = (now.shift[k] - springs.shift[k][last]).max(TINY);
            edge.secant[k] = (now.load - springs.load[last]) / edge.step[k];
            let before = if last > 0 { springs.secant[k][last - 1] } else { 0.0 };
            edge.root[k] = (edge.secant[k] - before).max(LEAST_STIFFNESS * edge.secant[k]).max(TINY).sqrt();
        }
        if let Some((shell_pressure, pressure)) = cached {
            (edge.shell_pressure, edge.pressure) = (*shell_pressure, *pressure);
            return edge;
        }
        let mut weights = [0.0; SPRINGS];
        for j in 0..SPRINGS {
            let distance = springs.shift[0][last] - springs.shift[0][j];
            weights[j] = springs.root[0][j] * if j < last { distance } else { 0.0 };
        }
        for i in 0..SPRINGS {
            if i < last {
                let difference = root_difference(now.size, springs.size[last], springs.point[i]);
                edge.shell_pressure[i] = springs.weight[last] * difference * springs.unit[i];
                edge.pressure[i] = dot(&springs.traction[i][0], &weights) + edge.shell_pressure[i];
            }
        }
        (edge.shell_pressure[last], edge.pressure[last]) = (1.0, 1.0);
        edge
    }

    /// g of the last shell at a point.
    #[inline(always)]
    pub fn slope(&self, k: usize, i: usize) -> f64 {
        self.shell_pressure[i] / self.step[k]
    }
}

/// The map from `sqrt(w_j) v_j` to the tractions q_i under the present load.
pub(crate) struct Map<'a> {
    springs: &'a Springs,
    pub last: usize,
    /// Roots of the stiffnesses, 0 beyond the contact.
    pub root: Both<Row>,
    /// Entries of the last spring.
    pub column: Both<Row>,
    /// 1 for the springs before the last one, 0 for others.
    inside: Row,
}

impl Map<'_> {
    #[inline(always)]
    pub fn new<'a>(springs: &'a Springs, edge: &Edge) -> Map<'a> {
        let last = edge.last.min(SPRINGS - 1);
        let mut map = Map { springs, last, root: springs.root, column: [[0.0; SPRINGS]; 2], inside: [0.0; SPRINGS] };
        for j in 0..SPRINGS {
            map.inside[j] = if j < last { 1.0 } else { 0.0 };
        }
        for k in 0..2 {
            let mut inner = [0.0; SPRINGS];
            for j in 0..SPRINGS {
                map.root[k][j] = springs.root[k][j] * map.inside[j];
                inner[j] = map.root[k][j];
            }
            map.root[k][last] = edge.root[k];
            let per_root = 1.0 / edge.root[k];
            for i in 0..SPRINGS {
                if i < last {
                    let slope = dot(&springs.traction[i][k], &inner);
                    map.column[k][i] = (edge.slope(k, i) - slope) * per_root;
                }
            }
            map.column[k][last] = edge.slope(k, last) * per_root;
        }
        map
    }

    /// Row i for direction k.
    #[inline(always)]
    pub fn row(&self, k: usize, i: usize) -> Row {
        let mut row = [0.0; SPRINGS];
        let fixed = &self.springs.traction[i][k];
        if i < self.last {
            for j in 0..SPRINGS {
                row[j] = fixed[j] * self.inside[j];
            }
        }
        row[self.last.min(SPRINGS - 1)] = self.column[k][i];
        row
    }

    /// Row i of the inverse for direction k, from its entry in the last column.
    #[inline(always)]
    pub fn inverse_row(&self, k: usize, i: usize, entry: f64) -> Row {
        let mut row = [0.0; SPRINGS];
        let fixed = &self.springs.inverse[i][k];
        for j in 0..SPRINGS {
            row[j] = fixed[j] * self.inside[j];
        }
        row[self.last.min(SPRINGS - 1)] = entry;
        row
    }

    /// The last column of the inverse from row `first` on.
    #[inline(always)]
    pub fn inverse_column(&self, k: usize, first: usize) -> Row {
        let last = self.last.min(SPRINGS - 1);
        let mut inner = self.column[k];
        for j in 0..SPRINGS {
            inner[j] *= self.inside[j];
        }
        let reciprocal = 1.0 / self.column[k][last];
        let mut column = [0.0; SPRINGS];
        for i in first..last {
            column[i] = -reciprocal * dot(&self.springs.inverse[i][k], &inner);
        }
        column[last] = reciprocal;
        column
    }

    /// Entry (i, i).
    #[inline(always)]
    pub fn diagonal(&self, k: usize, i: usize) -> f64 {
        if i < self.last { self.springs.traction[i][k][i] } else { self.column[k][i] }
    }

    /// B'σ, of the points from `first` on.
    #[inline(always)]
    pub fn transposed(&self, k: usize, first: usize, sigma: &Row) -> Row {
        let last = self.last.min(SPRINGS - 1);
        let mut sum = [0.0; SPRINGS];
        for i in first..last {
            add(&mut sum, sigma[i], &self.springs.traction[i][k]);
        }
        for j in 0..SPRINGS {
            sum[j] *= self.inside[j];
        }
        sum[last] = dot(&self.column[k], sigma);
        sum
    }

    /// The tractions at the points that are not to be skipped.
    #[inline(always)]
    pub fn tractions(&self, z: &Both<Row>, skipped: &[bool; SPRINGS], tractions: &mut Both<Row>) {
        let last = self.last.min(SPRINGS - 1);
        for k in 0..2 {
            let mut inner = z[k];
            for j in 0..SPRINGS {
                inner[j] *= self.inside[j];
            }
            for i in 0..SPRINGS {
                if i <= last && !skipped[i] {
                    let fixed = if i < last { dot(&self.springs.traction[i][k], &inner) } else { 0.0 };
                    tractions[k][i] = fixed + self.column[k][i] * z[k][last];
                }
            }
        }
    }
}
