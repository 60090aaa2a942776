//! The springs of a shape, aligned with a size: the family of sizes at N nodes, and the map between springs and tractions.
//!
//! A node j is a size s_j of the family, with the normal force N_j and the shifts S_j of both directions; shell j reaches from s_j to
//! s_{j+1}, the last one to the present size. The nodes end at a reference size, the largest one of a motion, near which they are
//! densest. Spring j carries the displacement v_j of the sizes from s_j on, with the stiffness w_j = W_j - W_{j-1} of the secants
//! `W_j = (N_{j+1} - N_j)/(S_{j+1} - S_j)`. At one point x_i of each shell the traction is that of the shells from there on (Abel):
//!
//! ```text
//! D_j = (v_j - v_{j+1})/(S_{j+1} - S_j),   q_i = Σ_{j≥i} F_ij D_j,   F_ij = ψ_j [sqrt(s_{j+1}² - x_i²) - sqrt(s_j² - x_i²)]
//! ```
//!
//! where F_ij is the pressure at x_i that shell j carries: `q_i = p_i = Σ F_ij` if all of the contact slides. Shells under a flat
//! carry no pressure; there `F_ij = [acosh(s_{j+1}/x_i) - acosh(s_j/x_i)] g/(4 Δs_j)`, and the compliance stands for the difference
//! of shifts. Per shift no shell carries more than the one before it, F_ij/ΔS_j <= F_i,j-1/ΔS_j-1 in both directions, to which F_ij
//! is cut: then points that slip with the contact have no slip against their traction (derivation, "Motion along an axis"). The
//! inverse of the map, `v_j = Σ_{i≥j} U_ji q_i`, is triangular too, and its leading blocks are the inverses of those of the map:
//! only the last column depends on the load.
//!
//! All is in units of the normal force N, of the shift S across the line and of w of the reference size; tractions in a unit of each
//! point.

use crate::element::{Element, Normal};
use crate::shape::{RoundedPunch, TINY};
use core::array::from_fn;
use core::f64::consts::PI;

/// The largest number of springs.
pub(crate) const MOST: usize = 16;
/// Nodes under the flat.
const UNDER_FLAT: usize = 2;
/// Parts of each shell in the fine correction.
pub(crate) const PARTS: usize = 5;
/// Parts of the last shell but the first, in units of the reference size: between that and the next alignment the fine correction makes up
/// for the one shell of the law.
const BEYOND: [f64; PARTS - 1] = [1.0, 1.04, 1.12, 1.4];
/// Load and shift that no contact reaches.
const NEVER: f64 = 1e30;
/// Share of the sine in the distribution of nodes: they are densest at the edge.
const GRADING: f64 = 0.8;
/// Position of x_i in its shell. In the inner half, F_ij/ΔS_j decreases with j, so that motion on a line keeps its sign of slip.
const POINT: f64 = 0.1;
/// The smallest flat over w that has springs: widths of smaller ones would round to equal values.
const SMALLEST_FLAT: f64 = 1e-9;
/// The least stiffness of a spring, relative to that of all together: above the rounding errors of differences.
pub(crate) const LEAST_STIFFNESS: f64 = 1e-12;
/// Nodes closer to the present size than this part of it do not count as inside: their shell would be lost in rounding.
const THINNEST: f64 = 1e-9;
/// The least reference load, relative to the normal force of the parameters: with a flat, shells of much smaller sizes are so stiff that
/// maps between them lose their digits.
const LEAST_REFERENCE: f64 = 1.0 / 4096.0;

/// Values of both directions, one after the other.
pub(crate) type Both<T> = [T; 2];
/// One value per spring, or per point.
pub(crate) type Row<const N: usize> = [f64; N];
pub(crate) type Matrix<const N: usize> = [[f64; N]; N];
/// A value per spring of the fine correction: part r of shell j at `[r][j]`.
pub(crate) type Fine<const N: usize> = [[f64; N]; PARTS];

/// Normal state in the units of the springs: N, S of both directions, w².
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Pressed {
    pub load: f64,
    pub shift: Both<f64>,
    pub size: f64,
}

/// Derivatives of [`Pressed`] with respect to the normal component.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct PressedSlopes {
    pub load: f64,
    pub shift: Both<f64>,
    pub size: f64,
}

/// A step, straight in S and in the displacement.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Increment {
    pub before: Pressed,
    pub now: Pressed,
    pub by: Both<f64>,
    /// 1/ΔS; 0 unless the load rises.
    pub per_rise: Both<f64>,
    /// Whether the load is that of the state.
    pub constant_load: bool,
}

impl Increment {
    pub fn new(before: Pressed, now: Pressed, by: Both<f64>, constant_load: bool) -> Increment {
        let per_rise = [0, 1].map(|k| {
            let rise = now.shift[k] - before.shift[k];
            if rise > 0.0 { 1.0 / rise.max(TINY) } else { 0.0 }
        });
        Increment { before, now, by, per_rise, constant_load }
    }

    /// The parts of the motion that springs with these distances S_b - S_j follow: all, unless the load rises to their size within the
    /// step.
    #[inline(always)]
    pub fn share(&self, limit_x: f64, limit_y: f64) -> Both<f64> {
        let [per_x, per_y] = self.per_rise;
        let (x, y) = (limit_x * per_x, limit_y * per_y);
        [if per_x > 0.0 && x < 1.0 { x } else { 1.0 }, if per_y > 0.0 && y < 1.0 { y } else { 1.0 }]
    }
}

/// The units of the springs: N, S across the line and w of the reference size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Units {
    pub load: f64,
    pub shift: f64,
    pub size: f64,
}

impl Units {
    pub const NONE: Units = Units { load: 1.0, shift: 1.0, size: 1.0 };

    /// For springs that are aligned with a load.
    pub fn of(element: &Element, load: f64) -> Units {
        let plane = element.plane();
        let size = plane.shape.at_load(load.max(LEAST_REFERENCE * element.normal_force));
        let [load, shift, _] = plane.load_and_shifts(size);
        Units { load, shift, size }
    }

    /// w² under a load > 0.
    pub fn size_under(&self, element: &Element, load: f64) -> f64 {
        let size = element.size_under(load) / self.size;
        size * size
    }

    /// The normal state in these units, from a load > 0, its shift and w².
    #[inline(always)]
    pub fn pressed(&self, element: &Element, load: f64, shift: f64, size: f64) -> Pressed {
        let per_shift = 1.0 / self.shift;
        let lateral = element.lateral_shift(load, shift);
        Pressed { load: load / self.load, shift: [shift * per_shift, lateral * per_shift], size }
    }

    /// Derivatives of the normal state with respect to the input.
    pub fn slopes(&self, element: &Element, normal: &Normal, size: f64) -> PressedSlopes {
        let per_shift = 1.0 / self.shift;
        let lateral = element.lateral_slope(normal);
        PressedSlopes {
            load: normal.load_slope / self.load,
            shift: [normal.shift_slope * per_shift, lateral * per_shift],
            size: element.shape().size_slope(size.sqrt() * self.size) * normal.load_slope / self.size / self.size,
        }
    }
}

/// Single rows of the tables, all rows, and numbers in them.
const SINGLE: usize = 13;

/// Number of doubles in the tables of springs.
pub(crate) const TABLES: usize = MOST * (SINGLE + 5 * PARTS + 3 * MOST);

/// The springs of a shape: a view of their tables, whose rows have room for the largest number of springs.
#[derive(Clone, Copy)]
pub(crate) struct Springs<'a> {
    /// Springs under the flat.
    pub under_flat: usize,
    /// N_j and S_j.
    pub load: &'a Row<MOST>,
    pub shift: Both<&'a Row<MOST>>,
    /// w_j², and x_i² - a².
    size: &'a Row<MOST>,
    pub point: &'a Row<MOST>,
    /// ψ of the shells, and the unit of the tractions at x_i.
    pub weight: &'a Row<MOST>,
    pub unit: &'a Row<MOST>,
    /// W_j, w_j and 1/(S_{j+1} - S_j).
    pub secant: Both<&'a Row<MOST>>,
    pub stiffness: Both<&'a Row<MOST>>,
    pub per_step: Both<&'a Row<MOST>>,
    /// N and S of the fine correction, and the difference of its stiffnesses from those of the law.
    pub fine_load: &'a Fine<MOST>,
    pub fine_shift: Both<&'a Fine<MOST>>,
    pub fine_stiffness: Both<&'a Fine<MOST>>,
    /// F_ij as `[j][i]`, and U_ji of whole shells as `[j][i]`.
    pub traction: &'a Matrix<MOST>,
    pub displacement: Both<&'a Matrix<MOST>>,
}

impl<'a> Springs<'a> {
    /// Of tables that were filled.
    #[inline(always)]
    pub fn new(under_flat: usize, tables: &'a [f64]) -> Option<Springs<'a>> {
        let (single, rest) = tables.as_chunks::<MOST>().0.split_first_chunk::<SINGLE>()?;
        let [load, x, y, size, point, weight, unit, secant_x, secant_y, stiffness_x, stiffness_y, step_x, step_y] =
            single;
        let (fine, rest) = rest.split_at_checked(5 * PARTS)?;
        let ([fine_load, shift_x, shift_y, fine_x, fine_y], _) = fine.as_chunks::<PARTS>().0.split_first_chunk()?;
        let ([traction, displacement_x, displacement_y], _) = rest.as_chunks::<MOST>().0.split_first_chunk()?;
        Some(Springs {
            under_flat,
            load,
            shift: [x, y],
            size,
            point,
            weight,
            unit,
            secant: [secant_x, secant_y],
            stiffness: [stiffness_x, stiffness_y],
            per_step: [step_x, step_y],
            fine_load,
            fine_shift: [shift_x, shift_y],
            fine_stiffness: [fine_x, fine_y],
            traction,
            displacement: [displacement_x, displacement_y],
        })
    }

    /// The shell at the edge of a contact with a shift.
    #[inline(always)]
    pub fn last_shell<const N: usize>(&self, shift: f64) -> usize {
        let (inside, mut count) = (shift * (1.0 - THINNEST), 0);
        for j in 0..N {
            count += usize::from(self.shift[0][j] < inside);
        }
        count.saturating_sub(1).max(self.under_flat).min(N - 1)
    }

    /// The part of the last shell at the edge.
    #[inline(always)]
    pub fn last_part(&self, last: usize, shift: f64) -> usize {
        let inside = shift * (1.0 - THINNEST);
        (1..PARTS).filter(|r| self.fine_shift[0][*r][last.min(MOST - 1)] < inside).count()
    }

    /// Pressure of the last shell at the points within, capped like that of the others, and its derivative by the normal component.
    #[inline(always)]
    pub fn reach<const N: usize>(&self, last: usize, now: &Pressed, slopes: &PressedSlopes) -> [Row<N>; 2] {
        let (mut reach, mut slope, last) = ([0.0; N], [0.0; N], last.min(N - 1));
        let (size, lower) = (now.size, self.size[last]);
        let (before, growth, [k, j]) = self.cap(last, now);
        let growth_slope = slopes.shift[k] * self.per_step[k][j];
        for i in 0..N {
            let (high, low) = (size - self.point[i], lower - self.point[i]);
            let (high, low) = (if high > TINY { high } else { TINY }, if low > 0.0 { low } else { 0.0 });
            let root = high.sqrt();
            // Free of cancellation.
            let difference = (size - lower) / (root + low.sqrt());
            let own = self.weight[last] * self.unit[i];
            let weight = if i < last { own } else { 0.0 };
            let (own, cap) = (weight * difference, before[i] * growth);
            reach[i] = if own > cap { cap } else { own };
            slope[i] = if own > cap { before[i] * growth_slope } else { 0.5 * weight / root * slopes.size };
        }
        [reach, slope]
    }

    /// The derivative of the pressure of the last shell by that of the tables, of which `slopes` is a view.
    #[inline(always)]
    pub fn reach_slope<const N: usize>(&self, slopes: &Springs, last: usize, now: &Pressed) -> Row<N> {
        let (mut reach, last) = ([0.0; N], last.min(N - 1));
        let (size, lower, lower_slope) = (now.size, self.size[last], slopes.size[last]);
        let (before, growth, [k, j]) = self.cap(last, now);
        let per_step = self.per_step[k][j];
        let growth_slope = growth / per_step * slopes.per_step[k][j] - slopes.shift[k][last] * per_step;
        for i in 0..N {
            let (high, low) = (size - self.point[i], lower - self.point[i]);
            let (high, low) = (if high > TINY { high } else { TINY }, if low > TINY { low } else { TINY });
            let (root, low_root) = (high.sqrt(), low.sqrt());
            let weight = self.weight[last] * self.unit[i];
            let weight_slope = slopes.weight[last] * self.unit[i] + self.weight[last] * slopes.unit[i];
            let difference = (size - lower) / (root + low_root);
            let by_point = (slopes.point[i] - lower_slope) / low_root - slopes.point[i] / root;
            let own_slope = weight_slope * difference + 0.5 * weight * by_point;
            let cap_slope = slopes.traction[j][i] * growth + before[i] * growth_slope;
            let slope = if weight * difference > before[i] * growth { cap_slope } else { own_slope };
            reach[i] = if i < last { slope } else { 0.0 };
        }
        reach
    }

    /// The shell before the last one, the growth of the cap from there, and the direction and the shell that it depends on.
    #[inline(always)]
    fn cap(&self, last: usize, now: &Pressed) -> (&'a Row<MOST>, f64, [usize; 2]) {
        let j = last.max(1) - 1;
        let [x, y] = [0, 1].map(|k| (now.shift[k] - self.shift[k][last]) * self.per_step[k][j]);
        (&self.traction[j], if y < x { y } else { x }, [usize::from(y < x), j])
    }
}

/// Number of springs under the flat, for a reference size.
pub(crate) fn under_flat(element: &Element, units: &Units) -> usize {
    if element.plane().flat > SMALLEST_FLAT * units.size { UNDER_FLAT } else { 0 }
}

/// Fills the tables of the springs of an element that are aligned with the size of the units times a number near 1.
#[expect(clippy::too_many_lines, reason = "the tables in their order")]
pub(crate) fn fill(tables: &mut [f64], element: &Element, units: &Units, reference: f64) {
    let (plane, inner) = (element.plane(), under_flat(element, units));
    // As the compiler cannot know: bounds are not checked below.
    let (n, inner) = (element.springs.clamp(UNDER_FLAT, MOST), inner.min(UNDER_FLAT));
    let graded = n - inner;
    let flat = plane.flat / units.size;
    let (rows, _) = tables.as_chunks_mut::<MOST>();
    let Some((single, rest)) = rows.split_first_chunk_mut::<SINGLE>() else { return };
    let Some((fine, rest)) = rest.split_at_mut_checked(5 * PARTS) else { return };
    let Some(([traction, displacement_x, displacement_y], _)) = rest.as_chunks_mut::<MOST>().0.split_first_chunk_mut()
    else {
        return;
    };
    let Some(([fine_load, fine_x, fine_y, fine_stiffness_x, fine_stiffness_y], _)) =
        fine.as_chunks_mut::<PARTS>().0.split_first_chunk_mut()
    else {
        return;
    };
    *single = [[0.0; MOST]; SINGLE];
    let [load, x, y, size, point, weight, unit, secant_x, secant_y, stiffness_x, stiffness_y, step_x, step_y] = single;
    let (shift, secant, step) = ([x, y], [secant_x, secant_y], [step_x, step_y]);
    let (fine_shift, stiffness) = ([fine_x, fine_y], [stiffness_x, stiffness_y]);
    // w of a part of shell j, in units of w.
    let node = |j: usize, r: usize| {
        if j + 1 == graded && r > 0 {
            return reference * BEYOND[r - 1];
        }
        let part = (j as f64 + r as f64 / PARTS as f64) / graded as f64;
        reference * ((1.0 - GRADING) * part + GRADING * (0.5 * PI * part).sin())
    };
    let half_width = |w: f64| (flat * flat + w * w).sqrt();
    // N and S at the nodes and at the end of the last shell.
    let at = |w: f64| {
        let w = w * units.size;
        // The same for slightly larger and smaller sizes.
        if w >= plane.largest * reference {
            return [NEVER; 3];
        }
        let [load, x, y] = plane.load_and_shifts(w);
        [load / units.load, x / units.shift, y / units.shift]
    };
    let mut width = [flat; MOST];
    let mut position = [0.0; MOST];
    for j in 0..inner {
        let (from, to) = (flat * (PI * j as f64 / (2 * inner) as f64).sin(), {
            if j + 1 == inner { flat } else { flat * (PI * (j + 1) as f64 / (2 * inner) as f64).sin() }
        });
        width[j] = from;
        size[j] = -(flat - from) * (flat + from);
        position[j] = from + POINT * (to - from);
        point[j] = -(flat - position[j]) * (flat + position[j]);
        for k in 0..2 {
            let compliance = plane.compliance_under_flat(k, units.size * 0.5 * (from + to));
            secant[k][j] = units.shift / (units.load * compliance);
            step[k][j] = secant[k][j];
        }
        for r in 0..PARTS {
            (fine_load[r][j], fine_shift[0][r][j], fine_shift[1][r][j]) = (0.0, 0.0, 0.0);
        }
    }
    for j in inner..n {
        let (lower, upper) = (node(j - inner, 0), node(j - inner + 1, 0));
        let (from, to) = (half_width(lower), half_width(upper));
        width[j] = from;
        let distance = (upper - lower) * (upper + lower) / (to + from);
        position[j] = from + POINT * distance;
        size[j] = lower * lower;
        point[j] = lower * lower + POINT * distance * (2.0 * from + POINT * distance);
        weight[j] = plane.shape.pressure_weight(units.size * 0.5 * (lower + upper));
        for r in 0..PARTS {
            let first = j == inner && r == 0;
            [fine_load[r][j], fine_shift[0][r][j], fine_shift[1][r][j]] =
                if first { [0.0; 3] } else { at(node(j - inner, r)) };
        }
        load[j] = fine_load[0][j];
        for k in 0..2 {
            shift[k][j] = fine_shift[k][0][j];
        }
    }
    let [end_load, end_x, end_y] = at(node(graded, 0));
    let end_size = reference * reference;
    for k in 0..2 {
        let end = [end_x, end_y][k];
        let next = |row: &Row<MOST>, j: usize, end: f64| if j + 1 < n { row[j + 1] } else { end };
        let (mut before, mut fine_before) = (0.0, 0.0);
        let fine_stiffness = if k == 0 { &mut *fine_stiffness_x } else { &mut *fine_stiffness_y };
        *fine_stiffness = [[0.0; MOST]; PARTS];
        for j in 0..n {
            if j >= inner {
                let rise = (next(shift[k], j, end) - shift[k][j]).max(TINY);
                step[k][j] = 1.0 / rise;
                secant[k][j] = (next(load, j, end_load) - load[j]) / rise;
            }
            // If all sizes have the same stiffness, the differences are rounding errors.
            stiffness[k][j] = (secant[k][j] - before).max(LEAST_STIFFNESS * secant[k][j]);
            if j >= inner {
                // The springs of the law under the flat are at the first node of the fine correction.
                let law = secant[k][j] - if j > inner { before } else { 0.0 };
                for r in 0..PARTS {
                    let last = r + 1 == PARTS;
                    let outer =
                        |rows: &Fine<MOST>, end: f64| if last { next(&rows[0], j, end) } else { rows[r + 1][j] };
                    let (upper, upper_load) = (outer(fine_shift[k], end), outer(fine_load, end_load));
                    // Not in use, and decreasing, behind the last node.
                    let own = (upper_load - fine_load[r][j]).max(0.0) / (upper - fine_shift[k][r][j]).max(TINY);
                    fine_stiffness[r][j] = own - fine_before - if r == 0 { law } else { 0.0 };
                    fine_before = own;
                }
            }
            before = secant[k][j];
        }
    }
    // The map, with the pressure of all shells as unit, and its inverse.
    *traction = [[0.0; MOST]; MOST];
    *displacement_x = [[0.0; MOST]; MOST];
    *displacement_y = [[0.0; MOST]; MOST];
    let quarter_load = 0.25 * RoundedPunch::new(flat, 1.0).load();
    let acosh = |s: f64, x: f64| {
        let ratio = (s / x).max(1.0);
        (ratio + ((ratio - 1.0) * (ratio + 1.0)).sqrt()).ln()
    };
    for j in 0..n {
        let outer = |row: &Row<MOST>, end: f64| if j + 1 < n { row[j + 1] } else { end };
        let (upper, to) = (outer(size, end_size), if j + 1 < n { width[j + 1] } else { flat });
        let [x, y] = [0, 1].map(|k| step[k][j.max(1) - 1] / step[k][j]);
        for i in 0..=j {
            let own = if j < inner {
                quarter_load * (acosh(to, position[i]) - acosh(width[j], position[i])) / (to - width[j])
            } else {
                weight[j] * root_difference(upper, size[j], point[i])
            };
            traction[j][i] = if i < j { own.min(traction[j - 1][i] * x.min(y)) } else { own };
            unit[i] += if j < inner { 0.0 } else { traction[j][i] };
        }
    }
    for i in 0..n {
        unit[i] = 1.0 / unit[i].max(TINY);
        for row in &mut traction[..n] {
            row[i] *= unit[i];
        }
    }
    for column in 0..n {
        // D by back substitution, and its sums from outside. The compiler cannot know that a decreasing index is within bounds.
        let mut density = [0.0; MOST];
        density[column] = 1.0 / traction[column][column].max(TINY);
        for j in (0..column).rev().map(|j| j.min(MOST - 2)) {
            // Column j + 1 of the map takes part in the rows before.
            let there = density[j + 1];
            for i in 0..=j {
                density[i] -= traction[j + 1][i] * there;
            }
            density[j] /= traction[j][j].max(TINY);
        }
        let [mut sum_x, mut sum_y] = [0.0; 2];
        for j in (0..=column).rev().map(|j| j.min(MOST - 1)) {
            sum_x += density[j] / step[0][j];
            sum_y += density[j] / step[1][j];
            (displacement_x[j][column], displacement_y[j][column]) = (sum_x, sum_y);
        }
    }
}

/// `sqrt(upper - point) - sqrt(lower - point)`, the second one 0 if negative, free of cancellation.
#[inline(always)]
fn root_difference(upper: f64, lower: f64, point: f64) -> f64 {
    let (high, low) = ((upper - point).max(0.0), (lower - point).max(0.0));
    let difference = if low > 0.0 { upper - lower } else { high };
    difference / (high.sqrt() + low.sqrt()).max(TINY)
}

/// The first N values of a row of the tables.
#[inline(always)]
pub(crate) fn used<const N: usize>(row: &Row<MOST>) -> &Row<N> {
    row.first_chunk().unwrap_or(&[0.0; N])
}

/// Σ a_j b_j.
#[inline(always)]
pub(crate) fn dot<const N: usize>(one: &Row<N>, two: &Row<N>) -> f64 {
    let mut sums = [0.0; 4];
    for (one, two) in one.as_chunks::<4>().0.iter().zip(two.as_chunks::<4>().0) {
        for lane in 0..4 {
            sums[lane] += one[lane] * two[lane];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// Σ a_j.
#[inline(always)]
pub(crate) fn total<const N: usize>(row: &Row<N>) -> f64 {
    let mut sums = [0.0; 4];
    for values in row.as_chunks::<4>().0 {
        for lane in 0..4 {
            sums[lane] += values[lane];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// The largest of values >= 0.
#[inline(always)]
pub(crate) fn largest<const N: usize>(row: &Row<N>) -> f64 {
    let mut largest = [0.0; 4];
    for values in row.as_chunks::<4>().0 {
        for lane in 0..4 {
            largest[lane] = if values[lane] > largest[lane] { values[lane] } else { largest[lane] };
        }
    }
    let [a, b, c, d] = largest;
    let (a, c) = (if a > b { a } else { b }, if c > d { c } else { d });
    if a > c { a } else { c }
}

/// y += a x.
#[inline(always)]
pub(crate) fn add<const N: usize>(y: &mut Row<N>, a: f64, x: &Row<N>) {
    let (mut sum, x) = (*y, *x);
    for j in 0..N {
        sum[j] += a * x[j];
    }
    *y = sum;
}

/// Values at a point.
#[inline(always)]
pub(crate) fn at<const N: usize>(rows: &Both<Row<N>>, i: usize) -> Both<f64> {
    from_fn(|k| rows[k][i])
}
