//! The springs under a present load: the shell at the edge, which ends at the present size, and the springs by the tractions.

use super::scalar::{Dual, Linear, Real, both};
use super::tables::{
    BIAS, Both, DualRows, END, FINE, FINE_SECANT, FINE_STIFFNESS, LEAST_STIFFNESS, LOAD, MAP, Matrix, N, POINTS,
    PRESSURE, Row, Rows, SECANT, SHIFT, SIZE, STIFFNESS, Tables, Units, WEIGHT, at_edge, root_difference, starts,
};
use crate::element::{Element, Normal, SMALLEST_LOAD};
use crate::shape::TINY;
use crate::simd::dispatch;

/// Normal state in the units of the springs: N, S of both directions, w²; N and S of a slightly smaller size, inside the edge.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Pressed<A> {
    pub load: A,
    pub shift: Both<A>,
    pub size: A,
    pub inside: [A; 3],
}

/// The normal component over that of the size inside the edge: the spring between both has the stiffness of the contact, to this part.
const INSIDE_EDGE: f64 = 1.0 - 2e-5;

impl Pressed<f64> {
    /// The state of a contact that is closed, and its derivatives by the normal component over its scale.
    pub fn new(element: &Element, units: &Units, input: f64, normal: &Normal) -> [Pressed<f64>; 2] {
        let Normal { load, shift, load_slope, shift_slope } = *normal;
        // Products only: the compiler may divide by what is beside a number in its vector register.
        let [per_load, per_shift, per_size] = [units.load, units.shift, units.size].map(f64::recip);
        let [w, slope] = element.shape().size_under(load.max(SMALLEST_LOAD * element.normal_force));
        let (size, slope) = (w * per_size, slope * load_slope * per_size * per_size);
        let (inner, scale) = (element.normal(INSIDE_EDGE * input), element.input_scale());
        let [lateral, lateral_inside] = [normal, &inner].map(|normal| element.lateral(normal));
        let per = [per_load, per_shift, per_shift, 1.0, per_load, per_shift, per_shift];
        let now = [load, shift, lateral[0], size * size, inner.load, inner.shift, lateral_inside[0]];
        let inside = [inner.load_slope, inner.shift_slope, lateral_inside[1]].map(|slope| INSIDE_EDGE * slope);
        let slopes = [load_slope, shift_slope, lateral[1], slope, inside[0], inside[1], inside[2]];
        [now, slopes.map(|slope| scale * slope)]
            .map(|numbers| Pressed::of(core::array::from_fn(|i| numbers[i] * per[i])))
    }

    /// With derivatives by the normal component over its scale.
    pub fn dual(&self, slopes: &Pressed<f64>) -> Pressed<Dual<1>> {
        let (values, slopes) = (self.values(), slopes.values());
        Pressed::of(core::array::from_fn(|i| {
            let mut dual = Dual::constant(values[i]);
            dual.0[0][END] = slopes[i];
            dual
        }))
    }
}

impl<A: Copy> Pressed<A> {
    /// From all its numbers, in order.
    pub fn of([load, x, y, size, inner_load, inner_x, inner_y]: [A; 7]) -> Pressed<A> {
        Pressed { load, shift: [x, y], size, inside: [inner_load, inner_x, inner_y] }
    }

    pub fn values(self) -> [A; 7] {
        let Pressed { load, shift: [x, y], size, inside: [inner_load, inner_x, inner_y] } = self;
        [load, x, y, size, inner_load, inner_x, inner_y]
    }
}

/// What depends on the present load.
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(32))]
pub(crate) struct Contact<A> {
    /// G of the last shell.
    pub edge: Both<Row<A>>,
    /// p_i and 1/p_i; 0 outside.
    pub pressure: Row<A>,
    pub per_pressure: Row<A>,
    /// Stiffnesses of the last spring, and those of the fine springs in its shell.
    pub stiffness: Both<A>,
    pub fine: Both<Row<A>>,
    pub now: Pressed<A>,
    /// The derivatives of the normal state by the normal component over its scale.
    pub slopes: Pressed<f64>,
    /// The last shell and part, the first part of that shell, and the springs under the flat.
    pub last: usize,
    pub part: usize,
    pub first_part: usize,
    pub under_flat: usize,
}

impl Contact<f64> {
    /// The contact in a normal state with derivatives, and C⁻¹ as `[spring][point]`.
    pub fn press(
        rows: &Rows,
        [now, slopes]: &[Pressed<f64>; 2],
        under_flat: usize,
        inverse: &mut Both<Matrix>,
    ) -> Contact<f64> {
        dispatch!({
            let edge = at_edge(rows, under_flat, now.inside[1]);
            let contact = Contact::new(&rows, now, slopes, edge, under_flat, true);
            let last = contact.last.min(N - 1);
            for k in 0..2 {
                inverse[k] = [[0.0; N]; N];
                for i in (0..=last).rev() {
                    // v_i = [p_i r_i + Σ_{j>i} (G_i,j-1 - G_ij) v_j]/G_ii: all positive.
                    let mut row = [0.0; N];
                    row[i] = contact.pressure[i];
                    let mut before = contact.map(&rows, k, i, i);
                    for j in i + 1..=last {
                        let g = contact.map(&rows, k, j, i);
                        let fall = before - g;
                        for m in 0..N {
                            row[m] += fall * inverse[k][j][m];
                        }
                        before = g;
                    }
                    let per_map = 1.0 / contact.map(&rows, k, i, i);
                    for m in 0..N {
                        inverse[k][i][m] = row[m] * per_map;
                    }
                }
            }
            contact
        })
    }

    /// G of a shell.
    #[inline(always)]
    pub fn row<'a>(&'a self, t: &'a Rows, k: usize, j: usize) -> &'a Row<f64> {
        t.get(MAP + k * (N - 1) + j).filter(|_| j < self.last).unwrap_or(&self.edge[k])
    }

    /// The contact with derivatives, of the stiffnesses of springs, and of tractions if these are requested.
    #[inline(never)]
    pub fn derived(&self, tables: &DualRows, tractions: bool) -> Contact<Dual<1>> {
        let now = self.now.dual(&self.slopes);
        Contact::new(tables, &now, &self.slopes, [self.last, self.part], self.under_flat, tractions)
    }
}

impl<A: Real> Contact<A> {
    #[inline(always)]
    fn new(
        t: &impl Tables<A>,
        now: &Pressed<A>,
        slopes: &Pressed<f64>,
        [last, part]: [usize; 2],
        under_flat: usize,
        tractions: bool,
    ) -> Contact<A> {
        let (zero, one, last) = (A::constant(0.0), A::constant(1.0), last.min(N - 1));
        let first_part = starts(under_flat)[last];
        let before = last.max(1) - 1;
        let mut contact = Contact {
            edge: [[zero; N]; 2],
            pressure: [zero; N],
            per_pressure: [zero; N],
            stiffness: [zero; 2],
            fine: [[zero; N]; 2],
            now: *now,
            slopes: *slopes,
            last,
            part,
            first_part,
            under_flat,
        };
        let step = both!(|k| now.shift[k] - t.at(SHIFT + k * FINE / N, first_part));
        let per_step = both!(|k| step[k].inverse());
        // At its own point the last shell carries all, in any unit.
        (contact.pressure[last], contact.per_pressure[last]) = (one, one);
        contact.edge[0][last] = per_step[0];
        contact.edge[1][last] = per_step[1];
        let (weight, lower) = (t.at(WEIGHT, last), t.at(SIZE, last));
        for i in 0..if tractions { last } else { 0 } {
            let mut traction = weight * root_difference(now.size, lower, t.at(POINTS, i));
            for k in 0..2 {
                let bound = t.at(MAP + k * (N - 1) + before, i) * step[k];
                traction = if bound.value() < traction.value() { bound } else { traction };
            }
            contact.pressure[i] = t.at(PRESSURE + last, i) + traction;
            contact.per_pressure[i] = contact.pressure[i].inverse();
            contact.edge[0][i] = traction * per_step[0];
            contact.edge[1][i] = traction * per_step[1];
        }
        for k in 0..2 {
            let own = (now.load - t.at(LOAD, first_part)) * per_step[k];
            let inner = if last > 0 { t.at(SECANT + k, before) } else { zero };
            let (rise, least) = (own - inner, own.scale(LEAST_STIFFNESS));
            contact.stiffness[k] = if rise.value() > least.value() { rise } else { least };
            contact.press_fine(t, k, [own, inner]);
        }
        contact
    }

    /// Fine springs from the last one of the shell before, from the secants of the last shell and of those within.
    #[inline(always)]
    fn press_fine(&mut self, t: &impl Tables<A>, k: usize, [own, inner]: [A; 2]) {
        let (zero, start, before) = (A::constant(0.0), starts(self.under_flat), self.last.max(1) - 1);
        let (load, shift, part, from) = (LOAD, SHIFT + k * FINE / N, self.part, self.first_edge());
        let inside = [self.now.inside[0], self.now.inside[1 + k]];
        // N of the outermost part is unbiased when the edge passes it.
        let per_part = (t.at(shift, part + 1) - t.at(shift, part)).inverse();
        let passed = (inside[1] - t.at(shift, part)) * per_part;
        let corner = |f: usize| {
            let bias = t.at(BIAS, f);
            [t.at(load, f) - if f < part { bias } else { bias * passed }, t.at(shift, f)]
        };
        let mut slope = if from > 0 { t.at(FINE_SECANT + k * FINE / N, from - 1) } else { zero };
        let mut lower = corner(from);
        for f in from..=part {
            let upper = if f < part { corner(f + 1) } else { inside };
            let secant = (upper[0] - lower[0]) * (upper[1] - lower[1]).inverse();
            let mut law = zero;
            if f == self.first_part {
                law = own - if self.last <= self.under_flat { zero } else { inner };
            } else if f == start[before.min(N)] {
                law = t.at(if before > self.under_flat { STIFFNESS } else { SECANT } + k, before);
            }
            self.fine[k][(f - from).min(N - 1)] = secant - slope - law;
            (slope, lower) = (secant, upper);
        }
        self.fine[k][(part + 1 - from).min(N - 1)] = self.total(k) - slope;
    }

    /// G of a shell at a point.
    #[inline(always)]
    pub fn map(&self, t: &impl Tables<A>, k: usize, j: usize, i: usize) -> A {
        if j < self.last { t.at(MAP + k * (N - 1) + j, i) } else { self.edge[k][i] }
    }

    #[inline(always)]
    pub fn stiffness(&self, t: &impl Tables<A>, k: usize, j: usize) -> A {
        if j < self.last { t.at(STIFFNESS + k, j) } else { self.stiffness[k] }
    }

    /// 1/w_j.
    #[inline(always)]
    pub fn flexibility(&self, t: &impl Tables<A>, k: usize, j: usize) -> A {
        self.stiffness(t, k, j).at_least(TINY).inverse()
    }

    /// Stiffness of a fine spring.
    #[inline(always)]
    pub fn fine(&self, t: &impl Tables<A>, k: usize, f: usize) -> A {
        let edge = self.first_edge();
        if f < edge { t.at(FINE_STIFFNESS + k * FINE / N, f) } else { self.fine[k][(f - edge).min(N - 1)] }
    }

    /// The first fine spring whose stiffness depends on the load.
    #[inline(always)]
    pub fn first_edge(&self) -> usize {
        self.first_part.max(1) - 1
    }

    /// Stiffness of the fine spring at the edge.
    #[inline(always)]
    pub fn fine_inside(&self, k: usize) -> A {
        self.fine[k][(self.part + 1 - self.first_edge().min(self.part)).min(N - 1)]
    }

    /// Stiffness of all springs together: the secant at the edge.
    #[inline(always)]
    pub fn total(&self, k: usize) -> A {
        (self.now.load - self.now.inside[0]) * self.limit_inside(k).inverse()
    }

    /// The limit of the fine spring at the edge.
    #[inline(always)]
    pub fn limit_inside(&self, k: usize) -> A {
        self.now.shift[k] - self.now.inside[1 + k]
    }

    /// S_b - S of the first size that a fine spring carries.
    #[inline(always)]
    pub fn limit(&self, t: &impl Tables<A>, k: usize, f: usize) -> A {
        self.now.shift[k] - t.at(SHIFT + k * FINE / N, f)
    }
}
