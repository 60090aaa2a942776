//! The springs of a shape: tables that are aligned with a reference size, free of the present load.
//!
//! A node j is a size s_j of the family, with the normal force N_j and the shifts S_j of both directions; shell j reaches from s_j to
//! s_{j+1}, the last one to the present size. The nodes end at the reference size, the largest one of a motion, and the widths of the
//! shells decrease geometrically towards it: slip of any depth meets shells in proportion. Spring j carries the displacement v_j of the
//! sizes from s_j on, with the stiffness `w_j = W_j - W_{j-1}` of the secants `W_j = (N_{j+1} - N_j)/(S_{j+1} - S_j)`. At one point x_i of
//! each shell the traction over the pressure p_i is that of the shells from there on (Abel):
//!
//! ```text
//! r_i = Σ_{j≥i} G_ij (v_j - v_{j+1})/p_i,   G_ij = F_ij/(S_{j+1} - S_j),   F_ij = ψ_j [sqrt(s_{j+1}² - x_i²) - sqrt(s_j² - x_i²)]
//! ```
//!
//! where F_ij is the pressure at x_i that shell j carries. Shells under a flat carry no pressure; there
//! `F_ij = [acosh(s_{j+1}/x_i) - acosh(s_j/x_i)] g/(4 Δs_j)`, and the compliance stands for the difference of shifts.
//!
//! G_ij must not increase with j: the map from slip to springs is then an inverse of positive entries, and gross slip a solution
//! of Coulomb's law. Rough layers, whose compliance falls with the load, exceed this bound; G is cut at it.
//!
//! The fine springs divide each shell in parts. Their stiffness is that of a bank of these parts less that of the springs above: they
//! make motion on a line as exact as the finer bank.
//!
//! All is in units of the normal force N, of the shift S across the line and of w of the reference size.

use super::scalar::{Dual, Real};
use crate::element::Element;
use crate::shape::{RoundedPunch, TINY};
use core::f64::consts::PI;

/// Springs, and fine springs.
pub(crate) const N: usize = 12;
pub(crate) const FINE: usize = 60;

/// Values of both directions, one after the other.
pub(crate) type Both<T> = [T; 2];
/// A value per spring, or per point.
pub(crate) type Row<A> = [A; N];
pub(crate) type Matrix = [Row<f64>; N];

/// Springs under the flat.
const UNDER_FLAT: usize = 2;
/// Width of the shell at the edge over that of the innermost one: any value from 0.02 to 0.1 is as good.
const GRADING: f64 = 0.035;
/// Position of x_i in its shell: in the inner half, for which G decreases with j. Values from 0.02 to 0.2 are as good.
const POINT: f64 = 0.1;
/// Parts of the shells from the innermost one under pressure, each less than N, with which rows have room for those of a last shell.
const PARTS: [usize; N - 1] = [9, 9, 8, 7, 6, 5, 3, 3, 2, 2, 1];
/// Where the parts of the last shell begin, over its width: some are beyond the reference size, for loads up to the next alignment.
pub(crate) const BEYOND: [f64; 4] = [0.0, 0.5, 1.0, 3.0];
/// The fine spring at the edge, between the size inside and the present one.
pub(crate) const INSIDE: usize = FINE - 1;
/// Load and shift that no contact reaches.
const NEVER: f64 = 1e30;
/// The smallest flat over w that has springs: widths of smaller ones would round to equal values.
const SMALLEST_FLAT: f64 = 1e-9;
/// The least stiffness of a spring, relative to the secant: above the rounding errors of differences.
pub(crate) const LEAST_STIFFNESS: f64 = 1e-12;
/// Nodes closer to the present size than this part of it do not count as inside: their shell would be lost in rounding.
pub(crate) const THINNEST: f64 = 1e-9;
/// The least reference load, relative to the normal force of the parameters: with a flat, shells of much smaller sizes are so stiff that
/// maps between them lose their digits.
const LEAST_REFERENCE: f64 = 1.0 / 4096.0;

/// First rows of N and S at the parts, of the stiffness of whole parts, and of the mean error of N along the secants there.
pub(crate) const LOAD: usize = 0;
pub(crate) const SHIFT: usize = LOAD + FINE / N;
pub(crate) const FINE_STIFFNESS: usize = SHIFT + 2 * FINE / N;
pub(crate) const BIAS: usize = FINE_STIFFNESS + 2 * FINE / N;
/// Rows of w_j², x_i² - a² and ψ_j; in both directions of W_j and w_j.
pub(crate) const FINE_SECANT: usize = BIAS + FINE / N;
pub(crate) const SIZE: usize = FINE_SECANT + 2 * FINE / N;
pub(crate) const POINTS: usize = SIZE + 1;
pub(crate) const WEIGHT: usize = SIZE + 2;
pub(crate) const SECANT: usize = SIZE + 3;
pub(crate) const STIFFNESS: usize = SECANT + 2;
/// First rows of the pressure that the shells within one carry, as `[shell][point]`, and of G as `[direction][shell][point]`.
pub(crate) const PRESSURE: usize = STIFFNESS + 2;
pub(crate) const MAP: usize = PRESSURE + N;
pub(crate) const ROWS: usize = MAP + 2 * (N - 1);

pub(crate) type Rows = [Row<f64>; ROWS];

/// The first part of each shell and the number of all, for the given number of springs under the flat.
pub(crate) fn starts(under_flat: usize) -> &'static [usize; N + 1] {
    const fn of(under_flat: usize) -> [usize; N + 1] {
        let mut start = [0; N + 1];
        let mut j = under_flat;
        while j < N {
            start[j + 1] = start[j] + if j + 1 == N { BEYOND.len() } else { PARTS[j - under_flat] };
            j += 1;
        }
        start
    }
    const STARTS: [[usize; N + 1]; 2] = [of(0), of(UNDER_FLAT)];
    if under_flat == 0 { &STARTS[0] } else { &STARTS[1] }
}

/// Tables as numbers of a kind.
pub(crate) trait Tables<A> {
    /// Value i of a row, or beyond it of the next ones.
    fn at(&self, row: usize, i: usize) -> A;
}

impl Tables<f64> for &Rows {
    #[inline(always)]
    fn at(&self, row: usize, i: usize) -> f64 {
        self.as_flattened().get(row * N + i).copied().unwrap_or(0.0)
    }
}

/// Tables, and a factor of others that are their derivatives by the alignment, 0 if these are not requested.
pub(crate) struct DualRows<'a> {
    pub values: &'a Rows,
    pub slopes: (f64, &'a Rows),
}

impl<'a> DualRows<'a> {
    pub fn without_slopes(values: &'a Rows) -> DualRows<'a> {
        DualRows { values, slopes: (0.0, values) }
    }
}

impl Tables<Dual<1>> for DualRows<'_> {
    #[inline(always)]
    fn at(&self, row: usize, i: usize) -> Dual<1> {
        let [value, slope] = [self.values, self.slopes.1].map(|rows| Tables::<f64>::at(&rows, row, i));
        Dual([[0.0, 0.0, self.slopes.0 * slope, value]])
    }
}

/// Derivatives of the numbers of a contact: by the normal component at the end and at the start of a step, and by the alignment.
pub(crate) const END: usize = 0;
pub(crate) const START: usize = 1;
pub(crate) const ALIGNMENT: usize = 2;
pub(crate) const PARAMETERS: usize = 3;

/// The units of the springs: N, S across the line and w of the reference size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Units {
    pub load: f64,
    pub shift: f64,
    pub size: f64,
}

impl Units {
    /// For springs that are aligned with a load.
    pub fn of(element: &Element, load: f64) -> Units {
        let plane = element.shape();
        let size = plane.at_load(load.max(LEAST_REFERENCE * element.normal_force));
        let [load, shift, _] = plane.load_and_shifts(size);
        Units { load, shift, size }
    }
}

/// Number of springs under the flat, for a reference size.
pub(crate) fn under_flat(element: &Element, units: &Units) -> usize {
    if element.shape().flat > SMALLEST_FLAT * units.size { UNDER_FLAT } else { 0 }
}

/// The shell and the part at the edge of a contact with a shift.
#[inline(always)]
pub(crate) fn at_edge(rows: &Rows, under_flat: usize, shift: f64) -> [usize; 2] {
    let (start, inside) = (starts(under_flat), shift * (1.0 - THINNEST));
    let nodes = &rows[SHIFT..SHIFT + FINE / N].as_flattened();
    let part = nodes.iter().skip(1).take(start[N] - 1).filter(|node| **node < inside).count();
    let last = start.iter().take(N).skip(under_flat + 1).filter(|first| **first <= part).count() + under_flat;
    [last.min(N - 1), part.min(FINE - 1)]
}

/// Fills the tables of the springs of an element that are aligned with the size of the units times a number near 1.
#[inline(never)]
pub(crate) fn fill(rows: &mut Rows, element: &Element, units: &Units, reference: f64) {
    let inner = under_flat(element, units).min(UNDER_FLAT);
    let flat = element.shape().flat / units.size;
    let mut shells = Shells { inner, reference, flat, width: [0.0; N], position: [0.0; N], per_step: [[0.0; N]; 2] };
    *rows = [[0.0; N]; ROWS];
    shells.fill_nodes(rows, element, units);
    shells.fill_points(rows, element, units);
    shells.fill_stiffness(rows);
    shells.fill_maps(rows);
}

/// Sets value i of a row, or beyond it of the next ones.
fn put(rows: &mut Rows, row: usize, i: usize, value: f64) {
    rows.as_flattened_mut().get_mut(row * N + i).into_iter().for_each(|place| *place = value);
}

/// The shells of tables while these are filled, in units of the reference size: how many are under the flat, its half-width; of those under
/// it widths and points, and 1/ΔS in both directions.
struct Shells {
    inner: usize,
    reference: f64,
    flat: f64,
    width: Row<f64>,
    position: Row<f64>,
    per_step: Both<Row<f64>>,
}

impl Shells {
    /// The size at a part of a shell under pressure.
    fn node(&self, j: usize, part: f64) -> f64 {
        let exponent = (j as f64 - self.inner as f64 + part) / (N - self.inner) as f64;
        self.reference * (1.0 - (exponent * GRADING.ln()).exp()) / (1.0 - GRADING)
    }

    /// Where a shell under the flat begins.
    fn ring(&self, j: usize) -> f64 {
        if j == UNDER_FLAT { self.flat } else { self.flat * (0.5 * PI * j as f64 / UNDER_FLAT as f64).sin() }
    }

    /// N and S at the parts.
    fn fill_nodes(&self, rows: &mut Rows, element: &Element, units: &Units) {
        let (plane, start) = (element.shape(), starts(self.inner));
        rows[LOAD..SHIFT + 2 * FINE / N].fill([NEVER; N]);
        for j in self.inner..N {
            let count = start[j + 1] - start[j];
            for r in 0..count {
                let part = if j + 1 == N { BEYOND[r.min(3)] } else { r as f64 / count as f64 };
                let (f, w) = (start[j] + r, self.node(j, part) * units.size);
                let [load, x, y] = match f {
                    0 => [0.0; 3],
                    // The same for slightly larger and smaller sizes.
                    _ if w >= plane.largest * self.reference => continue,
                    _ => plane.load_and_shifts(w),
                };
                put(rows, LOAD, f, load / units.load);
                put(rows, SHIFT, f, x / units.shift);
                put(rows, SHIFT + FINE / N, f, y / units.shift);
            }
        }
    }

    /// Sizes, points and weights.
    fn fill_points(&mut self, rows: &mut Rows, element: &Element, units: &Units) {
        let (plane, flat) = (element.shape(), self.flat);
        for j in 0..self.inner.min(UNDER_FLAT) {
            let (from, to) = (self.ring(j), self.ring(j + 1));
            (self.position[j], self.width[j]) = (from + POINT * (to - from), to - from);
            rows[SIZE][j] = -(flat - from) * (flat + from);
            rows[POINTS][j] = -(flat - self.position[j]) * (flat + self.position[j]);
            for k in 0..2 {
                let compliance = plane.compliance_under_flat(k, units.size * 0.5 * (from + to));
                self.per_step[k][j] = units.shift / (units.load * compliance);
            }
        }
        let half_width = |w: f64| (flat * flat + w * w).sqrt();
        for j in self.inner..N {
            let (lower, upper) = (self.node(j, 0.0), if j + 1 < N { self.node(j + 1, 0.0) } else { self.reference });
            let distance = (upper - lower) * (upper + lower) / (half_width(upper) + half_width(lower));
            rows[SIZE][j] = lower * lower;
            rows[POINTS][j] = lower * lower + POINT * distance * (2.0 * half_width(lower) + POINT * distance);
            rows[WEIGHT][j] = plane.pressure_weight(units.size * 0.5 * (lower + upper));
        }
    }

    /// Secants and stiffnesses.
    fn fill_stiffness(&mut self, rows: &mut Rows) {
        let (start, inner, nodes) = (starts(self.inner), self.inner, *rows);
        let at = |row: usize, f: usize| Tables::<f64>::at(&&nodes, row, f);
        let rise = |k: usize, from: usize, to: usize| {
            let [lower, upper] = [from, to].map(|f| at(SHIFT + k * FINE / N, f));
            [at(LOAD, to) - at(LOAD, from), (upper - lower).max(TINY)]
        };
        // Secants lie above N, by h² N''/12 on average.
        let bias = |f: usize| {
            if f <= start[inner.min(N)] || f + 1 >= start[N] {
                return 0.0;
            }
            let [[load_before, before], [load, step]] = [rise(0, f - 1, f), rise(0, f, f + 1)];
            let curved =
                (before * before + step * step) / (before + step) / 12.0 * (load / step - load_before / before);
            if step < NEVER / 2.0 { curved } else { 0.0 }
        };
        (0..FINE).for_each(|f| put(rows, BIAS, f, bias(f)));
        for k in 0..2 {
            let (mut before, mut fine_before) = (0.0, 0.0);
            for j in 0..N - 1 {
                let mut own = self.per_step[k][j];
                if j >= inner {
                    let [load, step] = rise(k, start[j], start[j + 1]);
                    (self.per_step[k][j], own) = (1.0 / step, load / step);
                }
                // If all sizes have the same stiffness, the differences are rounding errors.
                let stiffness = (own - before).max(LEAST_STIFFNESS * own);
                (rows[SECANT + k][j], rows[STIFFNESS + k][j]) = (own, stiffness);
                // The springs under the flat are at the first node of the fine ones.
                let law = own - if j > inner { before } else { 0.0 };
                for (r, f) in (start[j]..start[j + 1]).enumerate() {
                    let [load, step] = rise(k, f, f + 1);
                    let secant = (load - (bias(f + 1) - bias(f))) / step;
                    let fine = secant - fine_before - if r == 0 { law } else { 0.0 };
                    put(rows, FINE_STIFFNESS + k * FINE / N, f, fine);
                    put(rows, FINE_SECANT + k * FINE / N, f, secant);
                    fine_before = secant;
                }
                before = own;
            }
        }
    }

    /// F, cut so that G does not increase in either direction.
    fn fill_maps(&self, rows: &mut Rows) {
        let quarter_load = 0.25 * RoundedPunch::new(self.flat, 1.0).load();
        let acosh = |s: f64, x: f64| {
            let ratio = (s / x).max(1.0);
            (ratio + ((ratio - 1.0) * (ratio + 1.0)).sqrt()).ln()
        };
        for j in 0..N - 1 {
            for i in 0..=j {
                let mut traction = if j < self.inner {
                    let [from, to] = [j, j + 1].map(|j| acosh(self.ring(j), self.position[i]));
                    quarter_load * (to - from) / self.width[j].max(TINY)
                } else {
                    rows[WEIGHT][j] * root_difference(rows[SIZE][j + 1], rows[SIZE][j], rows[POINTS][i])
                };
                for k in 0..2 {
                    let bound = if i < j { rows[MAP + k * (N - 1) + j - 1][i] / self.per_step[k][j] } else { traction };
                    traction = traction.min(bound);
                }
                for k in 0..2 {
                    rows[MAP + k * (N - 1) + j][i] = traction * self.per_step[k][j];
                }
                rows[PRESSURE + j + 1][i] = rows[PRESSURE + j][i] + if j < self.inner { 0.0 } else { traction };
            }
        }
    }
}

/// `sqrt(upper - point) - sqrt(lower - point)`, the second one 0 if negative, free of cancellation.
#[inline(always)]
pub(crate) fn root_difference<A: Real>(upper: A, lower: A, point: A) -> A {
    let (high, low) = (upper - point, lower - point);
    let root = high.at_least(TINY).sqrt();
    if low.value() > 0.0 { (upper - lower) * (root + low.at_least(TINY).sqrt()).inverse() } else { root }
}
