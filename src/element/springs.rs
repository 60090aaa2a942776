//! The springs of a shape: the family of sizes at nodes, as matrices that are independent of the load.
//!
//! A node j is a size s_j of the family, with the normal force N_j and the shifts S_j of both directions; shell j reaches from s_j to
//! s_{j+1}. Spring j carries the displacement v_j of the sizes from s_j on, with the stiffness w_j = W_j - W_{j-1} of the secants
//! `W_j = (N_{j+1} - N_j)/(S_{j+1} - S_j)`. At one point x_i of each shell the traction is a triangular map of the springs (Abel),
//!
//! ```text
//! q_i = Σ_{j≥i} (g_ij - g_i,j-1) v_j,      g_ij = F_ij/(S_{j+1} - S_j),      F_ij = ψ_j [sqrt(s_{j+1}² - x_i²) - sqrt(s_j² - x_i²)],
//! ```
//!
//! where F_ij is the pressure at x_i that shell j carries: `q_i = p_i = Σ F_ij` if all of the contact slides. Shells under a flat
//! carry no pressure; there `g_ij = W_j [acosh(s_{j+1}/x_i) - acosh(s_j/x_i)] g/(4 Δs_j)`.
//!
//! All is in units of the normal force N of the parameters, of the shift S across the line under that force, and of its w; tractions in
//! a unit of each point.

use crate::shape::{Plane, RoundedPunch, TINY};
use core::f64::consts::PI;

/// Nodes under the flat, nodes up to the normal force of the parameters, and nodes beyond.
const UNDER_FLAT: usize = 3;
const GRADED: usize = 16;
/// Sizes beyond that of the parameters, of which each node is the start of a shell.
const BEYOND: [f64; 5] = [1.0, 1.1, 1.3, 1.7, 2.5];
/// Springs of the law.
pub(crate) const SPRINGS: usize = UNDER_FLAT + GRADED + BEYOND.len();
/// Springs of the fine bank for each of the law.
pub(crate) const REFINEMENT: usize = 5;
/// Springs of the fine bank, in whole vectors.
pub(crate) const FINE: usize = (REFINEMENT * (GRADED + BEYOND.len())).next_multiple_of(4);
/// Share of the sine in the distribution of nodes: they are densest at the edge.
const GRADING: f64 = 0.8;
/// Position of x_i in its shell.
const POINT: f64 = 0.2;
/// The smallest flat over w that has springs: widths of smaller ones would round to equal values.
const SMALLEST_FLAT: f64 = 1e-9;
/// The least stiffness of a spring, relative to that of all together: above the rounding errors of differences.
pub(crate) const LEAST_STIFFNESS: f64 = 1e-12;
/// Nodes closer to the present size than this part of it do not count as inside: their shell would be lost in rounding.
const THINNEST: f64 = 1e-9;
/// A shift that no contact reaches: the largest node is at four times the size of the parameters, and its shift at most at 4³ times
/// theirs. Its products with the largest other values remain finite.
const NEVER: f64 = 1e30;

/// Values of both directions, one after the other.
pub(crate) type Both<T> = [T; 2];
/// One value per spring.
pub(crate) type Row = [f64; SPRINGS];

/// Normal state in the units of the springs: N, S of both directions, w².
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Pressed {
    pub load: f64,
    pub shift: Both<f64>,
    pub size: f64,
}

/// Derivatives of [`Pressed`].
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct PressedSlopes {
    pub load: f64,
    pub shift: Both<f64>,
    pub size: f64,
}

/// The springs of a shape.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub(crate) struct Springs {
    /// Springs in use, and those under the flat.
    pub used: usize,
    pub under_flat: usize,
    /// N_j and S_j; shifts beyond the largest size are never reached.
    pub load: Row,
    pub shift: Both<Row>,
    /// w_j², and x_i² - a².
    pub size: Row,
    pub point: Row,
    /// ψ_j of shell j, and the unit of the tractions at x_i.
    pub weight: Row,
    pub unit: Row,
    /// W_j, the root of w_j and its reciprocal.
    pub secant: Both<Row>,
    pub root: Both<Row>,
    pub per_root: Both<Row>,
    /// (g_ij - g_i,j-1)/sqrt(w_j): maps sqrt(w_j) v_j to the traction at x_i.
    pub traction: [Both<Row>; SPRINGS],
    /// The inverse of that map.
    pub inverse: [Both<Row>; SPRINGS],
    /// The bank of finer springs: S_j and N_j, W_j, and the difference of its stiffness from that of the bank of the law.
    pub fine_load: [f64; FINE],
    pub fine_shift: Both<[f64; FINE]>,
    pub fine_secant: Both<[f64; FINE]>,
    pub fine_stiffness: Both<[f64; FINE]>,
}

impl Springs {
    pub const EMPTY: Springs = Springs {
        used: 0,
        under_flat: 0,
        load: [0.0; SPRINGS],
        shift: [[0.0; SPRINGS]; 2],
        size: [0.0; SPRINGS],
        point: [0.0; SPRINGS],
        weight: [0.0; SPRINGS],
        unit: [0.0; SPRINGS],
        secant: [[0.0; SPRINGS]; 2],
        root: [[0.0; SPRINGS]; 2],
        per_root: [[0.0; SPRINGS]; 2],
        traction: [[[0.0; SPRINGS]; 2]; SPRINGS],
        inverse: [[[0.0; SPRINGS]; 2]; SPRINGS],
        fine_load: [0.0; FINE],
        fine_shift: [[0.0; FINE]; 2],
        fine_secant: [[0.0; FINE]; 2],
        fine_stiffness: [[0.0; FINE]; 2],
    };

    /// The shell at the edge of a contact with a shift.
    #[inline(always)]
    pub fn last_shell(&self, shift: f64) -> usize {
        let mut last = self.under_flat;
        for j in 0..SPRINGS {
            if j > self.under_flat && self.shift[0][j] < shift * (1.0 - THINNEST) {
                last = j;
            }
        }
        last.min(self.used.max(1) - 1).min(SPRINGS - 1)
    }

    /// The node of the fine bank at that of the law.
    #[inline(always)]
    pub fn fine_node(&self, j: usize) -> usize {
        (REFINEMENT * j.saturating_sub(self.under_flat)).min(FINE - 1)
    }

    /// The shell of the fine bank at the edge of a contact, from that of the law.
    #[inline(always)]
    pub fn last_fine_shell(&self, last: usize, shift: f64) -> usize {
        let coarse = self.fine_node(last);
        let mut last = coarse;
        for j in 0..FINE {
            if j > coarse && self.fine_shift[0][j] < shift * (1.0 - THINNEST) {
                last = j;
            }
        }
        last.min(FINE - 1)
    }

    /// Stiffness of a spring of the fine bank alone.
    #[inline(always)]
    pub fn fine_own(&self, k: usize, j: usize) -> f64 {
        let j = j.min(FINE - 1);
        self.fine_secant[k][j] - if j > 0 { self.fine_secant[k][j - 1] } else { 0.0 }
    }

    /// Computes the springs of a shape whose size under the normal force of the parameters is `w`.
    pub fn fill(&mut self, plane: &Plane, w: f64) {
        let Plane { shape, per_approach, per_load, flat, largest } = *plane;
        *self = Springs::EMPTY;
        let load_unit = shape.load(w);
        let shift_of = |direction: usize, w: f64| {
            per_approach[direction] * shape.approach(w) + per_load[direction] * shape.load(w)
        };
        let shift_unit = shift_of(0, w);
        for (k, ((load, shift_x), shift_y)) in {
            let [x, y] = &mut self.fine_shift;
            self.fine_load.iter_mut().zip(x).zip(y).enumerate()
        } {
            let size = w * node(k);
            // The size 0 stays at 0: the length over it may overflow.
            if k == 0 {
                continue;
            }
            if size < largest {
                *load = shape.load(size) / load_unit;
                *shift_x = shift_of(0, size) / shift_unit;
                *shift_y = shift_of(1, size) / shift_unit;
            } else {
                (*load, *shift_x, *shift_y) = (NEVER, NEVER, NEVER);
            }
        }
        // Nodes of the law, and the ends of their shells.
        let inner = if flat > SMALLEST_FLAT * w { UNDER_FLAT } else { 0 };
        self.under_flat = inner;
        self.used = inner + GRADED + BEYOND.len();
        let flat = flat / w;
        let half_width = |size: f64| (flat * flat + size * size).sqrt();
        for k in 0..2 {
            self.shift[k].iter_mut().skip(self.used).for_each(|shift| *shift = NEVER);
        }
        // Half-widths of the nodes.
        let mut width = [0.0; SPRINGS + 1];
        for j in 0..=self.used {
            if let Some(place) = width.get_mut(j) {
                *place = if j < inner {
                    flat * (PI * j as f64 / 6.0).sin()
                } else {
                    half_width(node(REFINEMENT * (j - inner)))
                };
            }
        }
        let punch = RoundedPunch::new(flat, 1.0).load();
        for j in 0..SPRINGS {
            if j >= self.used {
                break;
            }
            let (from, to) = (width[j], width[j + 1]);
            if j < inner {
                self.size[j] = -(flat - from) * (flat + from);
                let x = from + POINT * (to - from);
                self.point[j] = -(flat - x) * (flat + x);
                let compliance = shape.compliance_under_flat(w * 0.5 * (from + to));
                for k in 0..2 {
                    let compliance = per_approach[k] * compliance + per_load[k];
                    self.secant[k][j] = shift_unit / (load_unit * compliance);
                }
                continue;
            }
            let fine = REFINEMENT * (j - inner);
            let (lower, upper) = (node(fine), node(fine + REFINEMENT));
            let step = (upper - lower) * (upper + lower) / (to + from);
            self.size[j] = lower * lower;
            self.point[j] = lower * lower + POINT * step * (2.0 * from + POINT * step);
            self.weight[j] = shape.pressure_weight(w * 0.5 * (lower + upper));
            let fine = fine.min(FINE - 1);
            self.load[j] = self.fine_load[fine];
            for k in 0..2 {
                self.shift[k][j] = self.fine_shift[k][fine];
            }
        }
        self.secants();
        self.tractions(&width, 0.25 * punch);
        self.invert();
    }

    /// W_j and w_j of the law and of the fine bank.
    fn secants(&mut self) {
        let secant = |load: [f64; 2], shift: [f64; 2]| {
            if shift[1] < NEVER { (load[1] - load[0]) / (shift[1] - shift[0]).max(TINY) } else { 0.0 }
        };
        for k in 0..2 {
            for j in self.under_flat..self.used.min(SPRINGS - 1) {
                let shifts = [self.shift[k][j], self.shift[k][j + 1]];
                self.secant[k][j] = secant([self.load[j], self.load[j + 1]], shifts);
            }
            let mut before = 0.0;
            for j in 0..self.used.min(SPRINGS) {
                // If all sizes have the same stiffness, the differences are rounding errors. Shells that no load reaches have none.
                let stiffness = (self.secant[k][j] - before).max(LEAST_STIFFNESS * self.secant[k][j]).max(TINY);
                before = self.secant[k][j];
                self.root[k][j] = stiffness.sqrt();
                self.per_root[k][j] = 1.0 / self.root[k][j];
            }
            let mut before = [0.0; 2];
            for j in 0..FINE - 1 {
                let shifts = [self.fine_shift[k][j], self.fine_shift[k][j + 1]];
                let fine = secant([self.fine_load[j], self.fine_load[j + 1]], shifts);
                self.fine_secant[k][j] = fine;
                self.fine_stiffness[k][j] = fine - before[0];
                before[0] = fine;
                if j % REFINEMENT == 0 {
                    let coarse = self.secant[k].get(self.under_flat + j / REFINEMENT).copied().unwrap_or(0.0);
                    self.fine_stiffness[k][j] -= coarse - before[1];
                    before[1] = coarse;
                }
            }
        }
    }

    /// The maps to tractions, from the half-widths of the nodes and g/4, lengths in units of w.
    fn tractions(&mut self, width: &[f64; SPRINGS + 1], quarter_load: f64) {
        for i in 0..self.used.min(SPRINGS) {
            let point = self.point[i];
            let x = width[i] + POINT * (width[i + 1] - width[i]);
            let acosh = |s: f64| {
                let ratio = (s / x).max(1.0);
                (ratio + ((ratio - 1.0) * (ratio + 1.0)).sqrt()).ln()
            };
            let graded = self.under_flat + GRADED;
            let mut pressure = [0.0; SPRINGS];
            for j in i.max(self.under_flat)..self.used.min(SPRINGS - 1) {
                pressure[j] = self.weight[j] * root_difference(self.size[j + 1], self.size[j], point);
            }
            // The unit: the pressure under the normal force of the parameters.
            let unit: f64 = if i < graded { pressure.iter().take(graded).sum() } else { pressure[i] };
            if unit <= 0.0 {
                continue;
            }
            self.unit[i] = 1.0 / unit;
            for k in 0..2 {
                let mut before = 0.0;
                for j in i..self.used.min(SPRINGS - 1) {
                    let slope = if j < self.under_flat {
                        let arc = acosh(width[j + 1]) - if j > i { acosh(width[j]) } else { 0.0 };
                        quarter_load * self.secant[k][j] * arc / (width[j + 1] - width[j])
                    } else if self.shift[k][j + 1] < NEVER {
                        pressure[j] / (self.shift[k][j + 1] - self.shift[k][j]).max(TINY)
                    } else {
                        break;
                    };
                    self.traction[i][k][j] = (slope - before) * self.unit[i] * self.per_root[k][j];
                    before = slope;
                }
            }
        }
    }

    /// The inverse of the triangular map, from its last row on. Its leading blocks are the inverses of those of the map.
    fn invert(&mut self) {
        for i in (0..SPRINGS).rev() {
            for k in 0..2 {
                let row = self.traction[i][k];
                // Shells that no load reaches have none.
                if row[i] <= TINY {
                    continue;
                }
                let mut inverse = [0.0; SPRINGS];
                inverse[i] = 1.0;
                for j in i + 1..SPRINGS {
                    for c in j..SPRINGS {
                        inverse[c] -= row[j] * self.inverse[j][k][c];
                    }
                }
                self.inverse[i][k] = inverse.map(|value| value / row[i].max(TINY));
            }
        }
    }
}

/// Σ a_j b_j.
#[inline(always)]
pub(crate) fn dot(one: &Row, two: &Row) -> f64 {
    let mut sums = [0.0; 4];
    for (one, two) in one.as_chunks::<4>().0.iter().zip(two.as_chunks::<4>().0) {
        for lane in 0..4 {
            sums[lane] += one[lane] * two[lane];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// y += a x.
#[inline(always)]
pub(crate) fn add(y: &mut Row, a: f64, x: &Row) {
    let (mut sum, x) = (*y, *x);
    for j in 0..SPRINGS {
        sum[j] += a * x[j];
    }
    *y = sum;
}

/// `sqrt(upper - point) - sqrt(lower - point)`, the second one 0 if negative, free of cancellation.
#[inline(always)]
pub(crate) fn root_difference(upper: f64, lower: f64, point: f64) -> f64 {
    let (high, low) = ((upper - point).max(0.0), (lower - point).max(0.0));
    let difference = if low > 0.0 { upper - lower } else { high };
    difference / (high.sqrt() + low.sqrt()).max(TINY)
}

/// w of a node of the fine bank, in units of that under the normal force of the parameters.
fn node(k: usize) -> f64 {
    let graded = REFINEMENT * GRADED;
    if k <= graded {
        let part = k as f64 / graded as f64;
        return (1.0 - GRADING) * part + GRADING * (0.5 * PI * part).sin();
    }
    let (shell, part) = ((k - graded) / REFINEMENT, ((k - graded) % REFINEMENT) as f64 / REFINEMENT as f64);
    let at = |shell: usize| BEYOND.get(shell).copied().unwrap_or(4.0);
    at(shell) + part * (at(shell + 1) - at(shell))
}
