//! The shells of a contact under a load, and the springs and maps that follow from them.
//!
//! Shell j has ΔN_j, ΔS_j in both directions and F_ij, its pressure at the points. Spring j carries the displacement
//! v_j of the sizes from s_j on. The displacements of springs beyond the edge are 0. So
//!
//! ```text
//! T = Σ k_j v_j,   k_j = Z_j - Z_{j-1},   Z_j = ΔN_j/ΔS_j
//! q_i = Σ_{j>=i} g_ij (v_j - v_{j+1}),   g_ij = F_ij/(p_i ΔS_j),   p_i = Σ_j F_ij without shell 0
//! ```
//!
//! q is the traction over μ times the pressure: |q_i| <= 1 is Coulomb's law. All of this depends on sums over shells
//! only, so the contact in the middle of a step is the one whose shells are the means of those at both ends.

use super::nodes::{
    FLAT_EDGE, Matrix, NodeValues, Nodes, NodesAndSlopes, PerAxis, Row, SPRINGS, Units, by_axis, monotone_pressure,
    pressure, pressure_at_edge,
};
use crate::element::{Element, NormalState, SMALLEST_LOAD};
use crate::numerics::dual::{Dual, Number};
use crate::numerics::guard::quotient;
use crate::numerics::lanes::Lanes;
use crate::numerics::record::record;
use core::ops::Range;

record! {
    /// The normal state in the units of the springs: N and S of both directions; N, S and leg² of a slightly smaller
    /// size, inside the edge.
    pub(crate) struct ScaledNormalState<T = f64> {
        pub load: T,
        pub shift: PerAxis<T>,
        pub inside: T,
        pub inside_leg_squared: T,
        pub inside_shift: PerAxis<T>,
    }
}

impl Default for ScaledNormalState {
    fn default() -> ScaledNormalState {
        ScaledNormalState::ZERO
    }
}

/// Number of values of a normal state.
const VALUES: usize = 7;

/// The normal component, w or N, of the size inside the edge over the present one. The spring between both sizes makes
/// the stiffness of a stuck contact exact, but for a relative error of about 8e-6.
const INSIDE_EDGE: f64 = 1.0 - 8e-6;
/// A node is not in use if it is closer to the size inside the edge than this part of its S: the shell between both
/// would be lost in rounding.
const THINNEST: f64 = 1e-9;
/// The least stiffness of a spring, relative to the secant: above the rounding errors of differences.
const LEAST_STIFFNESS: f64 = 1e-12;

impl ScaledNormalState {
    pub const ZERO: ScaledNormalState =
        ScaledNormalState { load: 0.0, shift: [0.0; 2], inside: 0.0, inside_leg_squared: 0.0, inside_shift: [0.0; 2] };

    /// The state of a contact that is closed, and its derivatives by the normal component over its scale.
    pub fn new(element: &Element, units: &Units, input: f64, normal: &NormalState) -> [ScaledNormalState; 2] {
        // Products instead of quotients, see `numerics/guard.rs`.
        let [per_load, per_shift, per_leg] = [units.load, units.shift, units.leg].map(f64::recip);
        let (inside, scale) = (element.normal(INSIDE_EDGE * input), element.input_scale());
        let [leg, slope] = element.shape().leg_and_slope_under(inside.load.max(SMALLEST_LOAD * element.normal_force));
        let (leg, slope) = (leg * per_leg, INSIDE_EDGE * slope * inside.load_slope * per_leg * per_leg);
        let [y, y_inside] = [normal, &inside].map(|normal| element.shift_y(normal));
        let per = [per_load, per_shift, per_shift, per_load, 1.0, per_shift, per_shift];
        let now = [normal.load, normal.shift, y[0], inside.load, leg * leg, inside.shift, y_inside[0]];
        let inner = [inside.load_slope, inside.shift_slope, y_inside[1]].map(|slope| INSIDE_EDGE * slope);
        let slopes = [normal.load_slope, normal.shift_slope, y[1], inner[0], slope, inner[1], inner[2]];
        [now, slopes.map(|slope| scale * slope)]
            .map(|values| ScaledNormalState::from_values(core::array::from_fn(|i| values[i] * per[i])))
    }

    pub fn values(&self) -> [f64; VALUES] {
        let ScaledNormalState { load, shift: [x, y], inside, inside_leg_squared, inside_shift: [inside_x, inside_y] } =
            *self;
        [load, x, y, inside, inside_leg_squared, inside_x, inside_y]
    }
}

impl<T: Number> ScaledNormalState<T> {
    /// The limits of the spring at the edge: S of the present size less that of the size inside.
    pub fn edge_limits(&self) -> PerAxis<T> {
        by_axis(|axis| self.shift[axis] - self.inside_shift[axis])
    }

    /// A normal state from its values in the order of [`ScaledNormalState::values`].
    pub fn from_values(
        [load, x, y, inside, inside_leg_squared, inside_x, inside_y]: [T; VALUES],
    ) -> ScaledNormalState<T> {
        ScaledNormalState { load, shift: [x, y], inside, inside_leg_squared, inside_shift: [inside_x, inside_y] }
    }
}

/// The shells `first..=last` of a contact; entries of other shells are 0. F_ij of all but the last shell are in the
/// tables of the nodes.
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(32))]
pub(crate) struct Shells {
    pub first: usize,
    pub last: usize,
    /// ΔN_j and ΔS_j for both directions.
    pub delta_load: PerAxis<Row>,
    pub delta_shift: PerAxis<Row>,
    /// F_ij of the last shell.
    last_pressure: Row,
    /// Stiffness of the spring at the edge, from the size inside on.
    pub edge_stiffness: PerAxis<f64>,
}

impl Shells {
    pub const ZERO: Shells = Shells {
        first: 0,
        last: 0,
        delta_load: [Row::ZERO; 2],
        delta_shift: [Row::ZERO; 2],
        last_pressure: Row::ZERO,
        edge_stiffness: [0.0; 2],
    };

    pub fn new(nodes: &Nodes, now: &ScaledNormalState) -> Shells {
        let last = nodes.last_node(now.inside_shift[0] * (1.0 - THINNEST)).min(SPRINGS - 1);
        let mut shells = Shells::whole(Some(nodes), nodes.first_shell(), last);
        let shell = LastShell::new([shells.first, last], nodes, now);
        shells.set_last(&shell, |value| value);
        shells
    }

    /// The shells from one to the one before the last one, which do not depend on the load; 0 without tables of nodes.
    fn whole(nodes: Option<&Nodes>, first: usize, last: usize) -> Shells {
        let mut shells = Shells { first, last: last.min(SPRINGS - 1), ..Shells::ZERO };
        if let Some(nodes) = nodes {
            for j in 0..shells.last {
                for axis in 0..2 {
                    shells.delta_load[axis][j] = nodes.delta_load[j];
                    shells.delta_shift[axis][j] = nodes.delta_shift[axis][j];
                }
            }
        }
        shells
    }

    /// Derivatives of the shells by one parameter, from those of the normal state and of the nodes.
    pub fn slopes(&self, nodes: NodesAndSlopes, [now, slopes]: [&ScaledNormalState; 2]) -> Shells {
        let mut shells = Shells::whole(nodes.1, self.first, self.last);
        let (now, slopes) = (now.values(), slopes.values());
        let dual = |i: usize| Dual { value: now[i], slopes: Lanes([slopes[i]]) };
        let now = ScaledNormalState::from_values(core::array::from_fn(dual));
        let shell = LastShell::new([self.first, self.last], &nodes, &now);
        shells.set_last(&shell, |value: Dual<1>| value.slopes[0]);
        shells
    }

    fn set_last<T: Number>(&mut self, shell: &LastShell<T>, part: impl Fn(T) -> f64) {
        let last = self.last.min(SPRINGS - 1);
        for axis in 0..2 {
            self.delta_load[axis][last] = part(shell.delta_load[axis]);
            self.delta_shift[axis][last] = part(shell.delta_shift[axis]);
            self.edge_stiffness[axis] = part(shell.edge_stiffness[axis]);
        }
        self.last_pressure = Lanes(shell.pressure.map(part));
    }

    /// F_ij of shell j; 0 for whole shells without tables of nodes, as derivatives that the nodes do not have.
    fn pressure(&self, nodes: Option<&Nodes>, j: usize) -> Row {
        match nodes {
            _ if j == self.last => self.last_pressure,
            Some(nodes) if j < self.last => nodes.pressure[j.min(SPRINGS - 2)],
            _ => Row::ZERO,
        }
    }

    /// F_ij of shell j in the middle of a step.
    pub fn middle_pressure([from, to]: [&Shells; 2], nodes: Option<&Nodes>, j: usize) -> Row {
        0.5 * (from.pressure(nodes, j) + to.pressure(nodes, j))
    }

    /// The contact in the middle of a step: the means of the shells at both ends.
    pub fn middle([from, to]: [&Shells; 2]) -> Shells {
        let mut middle = Shells { first: to.first, last: from.last.max(to.last), ..Shells::ZERO };
        for axis in 0..2 {
            middle.delta_load[axis] = 0.5 * (from.delta_load[axis] + to.delta_load[axis]);
            middle.delta_shift[axis] = 0.5 * (from.delta_shift[axis] + to.delta_shift[axis]);
        }
        middle
    }

    /// The shells, or springs, in use.
    pub fn range(&self) -> Range<usize> {
        self.innermost()..(self.last + 1).min(SPRINGS)
    }

    /// The innermost spring in use. The minimum shows the compiler that it is one of the springs.
    pub fn innermost(&self) -> usize {
        self.first.min(FLAT_EDGE)
    }

    /// k_j in a direction, given 1/ΔS_j; its derivatives are `stiffness_slopes` of [`tangent`](super::tangent).
    pub fn stiffness(&self, axis: usize, per_delta_shift: &Row) -> Row {
        let (secant, mut stiffness) = (self.delta_load[axis] * *per_delta_shift, Row::ZERO);
        let mut before = 0.0;
        for j in self.range() {
            let least = LEAST_STIFFNESS * secant[j];
            // If all sizes have the same stiffness, the differences are rounding errors.
            stiffness[j] = if secant[j] - before > least { secant[j] - before } else { least };
            before = secant[j];
        }
        stiffness
    }
}

/// The last shell: ΔN and ΔS for both directions, F at the points, and the stiffness of the spring at the edge.
struct LastShell<T> {
    delta_load: PerAxis<T>,
    delta_shift: PerAxis<T>,
    pressure: [T; SPRINGS],
    edge_stiffness: PerAxis<T>,
}

impl<T: Number> LastShell<T> {
    /// The last shell, given the first and the last one.
    fn new([first, last]: [usize; 2], nodes: &impl NodeValues<T>, now: &ScaledNormalState<T>) -> LastShell<T> {
        let last = last.min(SPRINGS - 1);
        let next_to_last = last.max(1) - 1;
        let (load, shift) =
            (nodes.get(|nodes| nodes.load[last]), by_axis(|axis| nodes.get(|nodes| nodes.shift[axis][last])));
        let delta_shift = by_axis(|axis| now.shift[axis] - shift[axis]);
        // The polygon of N(S) has its last corner at the size inside.
        let secant = by_axis(|axis| (now.inside - load).quotient(now.inside_shift[axis] - shift[axis]));
        let outer = by_axis(|axis| (now.load - now.inside).quotient(now.shift[axis] - now.inside_shift[axis]));
        let steps =
            by_axis(|axis| delta_shift[axis].quotient(nodes.get(|nodes| nodes.delta_shift[axis][next_to_last])));
        let mut pressures = [T::constant(0.0); SPRINGS];
        for i in first..last {
            let own = pressure(nodes, last, now.inside_leg_squared, i);
            let before = nodes.get(|nodes| nodes.pressure[next_to_last.min(SPRINGS - 2)][i]);
            pressures[i] = monotone_pressure(own, before, steps);
        }
        pressures[last] = pressure_at_edge(nodes, last, now.inside_leg_squared);
        LastShell {
            delta_load: by_axis(|axis| secant[axis] * delta_shift[axis]),
            delta_shift,
            pressure: pressures,
            edge_stiffness: by_axis(|axis| outer[axis] - secant[axis]),
        }
    }
}

/// v_j - v_{j+1}: the springs beyond the edge are 0.
pub(crate) fn minus_next(v: &Row) -> Row {
    let mut differences = *v;
    for j in 0..SPRINGS - 1 {
        differences[j] -= v[j + 1];
    }
    differences
}

/// The springs of a contact, and their maps from and to tractions.
#[derive(Debug, Clone, Copy)]
#[repr(align(32))]
pub(crate) struct Springs {
    pub shells: Shells,
    /// F_ij, a row for each shell, and 1/p_i.
    pub pressure: Matrix,
    pub per_pressure: Row,
    /// 1/ΔS_j and k_j.
    pub per_delta_shift: PerAxis<Row>,
    pub stiffness: PerAxis<Row>,
    /// C⁻¹, the inverse of the map from v to q, a row for each spring in use: no entry is negative.
    pub inverse: PerAxis<Matrix>,
}

impl Springs {
    pub const ZERO: Springs = Springs {
        shells: Shells::ZERO,
        pressure: [Row::ZERO; SPRINGS],
        per_pressure: Row::ZERO,
        per_delta_shift: [Row::ZERO; 2],
        stiffness: [Row::ZERO; 2],
        inverse: [[Row::ZERO; SPRINGS]; 2],
    };

    /// Sets the springs of the contact whose shells are the means of these; `SlipTerms::set` of
    /// [`tangent`](super::tangent) has the derivatives. The contact at the end of a step is the mean of twice the same
    /// shells.
    pub fn set(&mut self, nodes: &Nodes, ends: [&Shells; 2]) {
        let Springs { shells, pressure, per_pressure, per_delta_shift, stiffness, inverse } = self;
        *shells = Shells::middle(ends);
        let mut pressures = Row::ZERO;
        for j in 0..SPRINGS {
            pressure[j] = Shells::middle_pressure(ends, Some(nodes), j);
            if j >= FLAT_EDGE {
                pressures += pressure[j];
            }
        }
        *per_pressure = quotient(1.0, pressures);
        for axis in 0..2 {
            per_delta_shift[axis] = quotient(1.0, shells.delta_shift[axis]);
            stiffness[axis] = shells.stiffness(axis, &per_delta_shift[axis]);
        }
        for i in shells.range().rev().map(|i| i.min(SPRINGS - 1)) {
            // v_i = [p_i q_i + Σ_{j>i} (g_i,j-1 - g_ij) v_j]/g_ii, with p_i g_ij in place of g_ij.
            for axis in 0..2 {
                let (mut row, mut before) = (Row::ZERO, pressure[i][i] * per_delta_shift[axis][i]);
                let per_map = quotient(1.0, before);
                row[i] = pressures[i];
                for j in i + 1..shells.range().end {
                    let own = pressure[j][i] * per_delta_shift[axis][j];
                    row += (before - own) * inverse[axis][j];
                    before = own;
                }
                inverse[axis][i] = per_map * row;
            }
        }
    }

    /// The tractions q of springs with these displacements.
    pub fn tractions(&self, v: &PerAxis<Row>) -> PerAxis<Row> {
        let mut q = [Row::ZERO; 2];
        let gradients = by_axis(|axis| minus_next(&v[axis]) * self.per_delta_shift[axis]);
        for j in self.shells.range() {
            for axis in 0..2 {
                q[axis] += gradients[axis][j] * self.pressure[j];
            }
        }
        [self.per_pressure * q[0], self.per_pressure * q[1]]
    }
}
