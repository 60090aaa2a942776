//! Nodes, at which the family of sizes is divided into shells, and what does not depend on the present load.
//!
//! A node j is a size s_j of the family, with its normal force N_j and its shift S_j in both directions. Shell j
//! reaches from s_j to s_{j+1}, the last one to the present size. Shell 0 is the flat: it carries force, but no
//! pressure. It is empty if there is no flat, so that the nodes are continuous in a at a = 0.
//!
//! The cumulative distribution of the nodes is a sum of two parts. Slip reaches inwards from the edge: nodes graded in
//! √S have the same relative distance to the edge in every shape. And between nodes N(S) is a polygon, whose errors are
//! equal if the nodes are uniform in ∫ √(N'') dS ~ √N ψ:
//!
//! ```text
//! 0.765 ln[1 - 0.972 √(S_j/S_r)]/ln 0.028 + 0.235 √(N_j/N_r) ψ(s_j)/ψ(s_r) = (j - 1)/15,   j = 1 ... 15
//! ```
//!
//! N_r, S_r and s_r are those of the reference size, the largest one of a motion. In one point x_i of each shell the
//! shell j carries the pressure
//!
//! ```text
//! F_ij = ψ_j [√(s_{j+1}² - x_i²) - √(s_j² - x_i²)],
//! ```
//!
//! The force of shell 0 is spread evenly over the sizes up to a, which gives `F_00 = load_unit acosh(a/x_i)/(4 a)` with
//! `load_unit` as in `fill`; the compliance of the flat, K_t(a), takes the place of ΔS_0: that of the contact as slip
//! reaches the flat. F_ij/ΔS_j must not increase with j: then the map from tractions to springs has no negative entry,
//! and gross slip solves Coulomb's law. Rough layers, whose compliance falls with the load, exceed this bound; F is cut
//! at it.
//!
//! All is in units of N, of S across the line and of the leg, √(s² - a²), of the reference size.

use crate::element::Element;
use crate::numerics::dual::{Dual, Number};
use crate::numerics::guard::{TINY, quotient};
use crate::numerics::lanes::Lanes;
use crate::numerics::record::{doubles_mut, record};
use crate::numerics::slices::Zero;

/// Number of springs: one for each shell. The first one is that of the flat.
pub(crate) const SPRINGS: usize = 16;

/// A value for each spring, or for each point.
pub(crate) type Row = Lanes<SPRINGS>;
/// A value for each tangential direction, x across the line and y along it.
pub(crate) type PerAxis<T> = [T; 2];
pub(crate) type Matrix = [Row; SPRINGS];

/// The values of a function for both directions, 0 and 1.
pub(crate) fn by_axis<T>(value: impl Fn(usize) -> T) -> PerAxis<T> {
    [value(0), value(1)]
}

/// The length of a vector.
pub(crate) fn length<T: Number>([x, y]: PerAxis<T>) -> T {
    (x * x + y * y).root()
}

/// A set of points, or of springs: bit i stands for point i.
pub(crate) type PointSet = u32;

/// 1 at the points of a set, 0 at others.
pub(crate) fn mask_of(set: PointSet) -> Row {
    let mut row = Row::ZERO;
    for i in 0..SPRINGS {
        row[i] = if set >> i & 1 == 1 { 1.0 } else { 0.0 };
    }
    row
}

/// The set of the points of a range.
pub(crate) fn points_in([first, end]: [usize; 2]) -> PointSet {
    ((1 << end.min(31)) - 1) & !((1 << first.min(31)) - 1)
}

/// The first node whose shell carries pressure: the edge of the flat.
pub(crate) const FLAT_EDGE: usize = 1;
/// The share of the nodes that is graded towards the edge: more of it makes circles more accurate, less of it motion on
/// a line.
const EDGE_SHARE: f64 = 0.765;
/// The distance from the edge of the last node over that of the first one, in √S.
const GRADING: f64 = 0.028;
/// The position of x_i in its shell, see [`point_in_shell`]: in its inner half F_ij/ΔS_j decreases with j. Values from
/// 0.03 to 0.2 are nearly as good.
const POINT_FRACTION: f64 = 0.05;
/// Number of intervals in the leg on which the cumulative distribution of the nodes is inverted by linear
/// interpolation. The nodes need not be exact, but must depend smoothly on the load.
const INTERVALS: usize = 48;
/// A flat that is smaller than this part of the leg has no spring: sizes on it would round to one value.
const SMALLEST_FLAT: f64 = 1e-9;
/// The least reference load, relative to the normal force of the parameters: with a flat, shells of much smaller sizes
/// are so stiff that maps between them lose their digits.
const LEAST_REFERENCE: f64 = 1.0 / 4096.0;

/// Relative step of the central difference of nodes by the reference size. The error is the square of the step times
/// the third derivative, up to 1e5 where nodes are close, and the rounding error over the step.
const DIFFERENCE_STEP: f64 = 1e-6;

record! {
    /// Tables of the nodes and shells, in the order of j, and of the points in them.
    pub(crate) struct Nodes {
        /// N_j.
        pub load: Row,
        /// S_j in both directions.
        pub shift: PerAxis<Row>,
        /// leg_j² = s_j² - a².
        pub leg_squared: Row,
        /// x_i² - a².
        pub point_squared: Row,
        /// ψ_j in the middle of shell j.
        pub psi: Row,
        /// ΔN_j of whole shells, 1 for the flat.
        pub delta_load: Row,
        /// ΔS_j of whole shells in both directions, the compliances for the flat.
        pub delta_shift: PerAxis<Row>,
        /// F_ij of whole shells, a row for each shell j but the last one.
        pub pressure: [Row; SPRINGS - 1],
    }
}

record! {
    /// The units of the springs: N, S across the line and the leg of the reference size.
    pub(crate) struct Units {
        pub load: f64,
        pub shift: f64,
        pub leg: f64,
    }
}

impl Units {
    /// The units for nodes of a reference load.
    pub fn at_load(element: &Element, load: f64) -> Units {
        let shape = element.shape();
        let leg = shape.at_load(load.max(LEAST_REFERENCE * element.normal_force));
        let [load, shift, _] = shape.load_and_shifts(leg);
        Units { load, shift, leg }
    }

    /// Derivative of the logarithm of the reference size by the normal component over its scale, if it is the size
    /// under this normal component.
    pub fn logarithmic_slope(element: &Element, input: f64) -> f64 {
        let normal = element.normal(input);
        let [leg, slope] = element.shape().leg_and_slope_under(normal.load);
        element.input_scale() * quotient(0.5 * slope * normal.load_slope, leg * leg)
    }
}

impl Nodes {
    /// The first shell that is not empty.
    pub fn first_shell(&self) -> usize {
        if self.leg_squared[0] < 0.0 { 0 } else { FLAT_EDGE }
    }

    /// The outermost node whose shift across the line is less than the present one.
    pub fn last_node(&self, shift: f64) -> usize {
        FLAT_EDGE + self.shift[0].iter().skip(FLAT_EDGE + 1).filter(|node| **node < shift).count()
    }

    /// Fills the tables for a reference size, given as its leg over that of the units, a number near 1.
    #[inline(never)]
    pub fn fill(&mut self, element: &Element, units: &Units, reference: f64) {
        *self = Nodes::zero();
        let shape = element.shape();
        let mut flat = shape.flat / units.leg;
        flat = if flat > SMALLEST_FLAT { flat } else { 0.0 };
        let half_width = |leg: f64| (flat * flat + leg * leg).sqrt();
        let legs = legs_of_nodes(element, units, reference);
        for j in FLAT_EDGE..SPRINGS {
            let [load, x, y] = if j > FLAT_EDGE { shape.load_and_shifts(legs[j] * units.leg) } else { [0.0; 3] };
            (self.load[j], self.leg_squared[j]) = (load / units.load, legs[j] * legs[j]);
            (self.shift[0][j], self.shift[1][j]) = (x / units.shift, y / units.shift);
            let to = if j + 1 < SPRINGS { legs[j + 1] } else { reference };
            let distance = (to - legs[j]) * (to + legs[j]) / (half_width(to) + half_width(legs[j]));
            self.point_squared[j] = legs[j] * legs[j] + point_in_shell(half_width(legs[j]), distance)[0];
            self.psi[j] = shape.pressure_weight(units.leg * 0.5 * (legs[j] + to));
        }
        for j in FLAT_EDGE..SPRINGS - 1 {
            self.delta_load[j] = self.load[j + 1] - self.load[j];
            for axis in 0..2 {
                self.delta_shift[axis][j] = (self.shift[axis][j + 1] - self.shift[axis][j]).max(TINY);
            }
        }
        if flat > 0.0 {
            let [inner, outer] = point_in_shell(0.0, flat);
            (self.leg_squared[0], self.point_squared[0]) = (-flat * flat, -outer);
            self.delta_load[0] = 1.0;
            for axis in 0..2 {
                self.delta_shift[axis][0] = units.load / units.shift * shape.compliance_of_flat(axis);
            }
            let load_unit = units.load / shape.load_per_square() / (units.leg * units.leg);
            self.pressure[0][0] = 0.25 * load_unit * (flat / inner.sqrt()).acosh() / flat;
        }
        let first = self.first_shell();
        for j in FLAT_EDGE..SPRINGS - 1 {
            for i in first..=j {
                self.pressure[j][i] = pressure(self, j, self.leg_squared[j + 1], i);
            }
            if j > first {
                let steps = by_axis(|axis| self.delta_shift[axis][j] / self.delta_shift[axis][j - 1]);
                for i in first..j {
                    self.pressure[j][i] = monotone_pressure(self.pressure[j][i], self.pressure[j - 1][i], steps);
                }
            }
        }
    }

    /// Derivatives of nodes by the logarithm of the reference size.
    #[inline(never)]
    pub fn slopes(element: &Element, units: &Units) -> Nodes {
        let [mut larger, mut smaller] = [Nodes::zero(); 2];
        larger.fill(element, units, 1.0 + DIFFERENCE_STEP);
        smaller.fill(element, units, 1.0 - DIFFERENCE_STEP);
        for (slope, smaller) in doubles_mut(&mut larger).iter_mut().zip(doubles_mut(&mut smaller)) {
            *slope = (*slope - *smaller) * (0.5 / DIFFERENCE_STEP);
        }
        larger
    }
}

/// Reads values of the nodes as numbers with derivatives or without.
pub(crate) trait NodeValues<T> {
    fn get(&self, value: impl Fn(&Nodes) -> f64) -> T;
}

impl NodeValues<f64> for Nodes {
    fn get(&self, value: impl Fn(&Nodes) -> f64) -> f64 {
        value(self)
    }
}

/// Nodes and their derivatives by one parameter, if they have any.
pub(crate) type NodesAndSlopes<'a> = (&'a Nodes, Option<&'a Nodes>);

impl NodeValues<Dual<1>> for NodesAndSlopes<'_> {
    fn get(&self, value: impl Fn(&Nodes) -> f64) -> Dual<1> {
        let (nodes, slopes) = self;
        Dual { value: value(nodes), slopes: Lanes([slopes.map_or(0.0, value)]) }
    }
}

/// The point x_i of a shell from a half-width s over a distance d: `[x_i² - s², (s + d)² - x_i²]`.
fn point_in_shell<T: Number>(half_width: T, distance: T) -> [T; 2] {
    let (to_point, from_point) = (distance * POINT_FRACTION, distance * (1.0 - POINT_FRACTION));
    let twice = half_width + half_width + to_point;
    [to_point * twice, from_point * (twice + distance)]
}

/// F_ij of shell j up to a size: `ψ_j [√(s² - x_i²) - √(s_j² - x_i²)]`, from leg² = s² - a². The second root is 0 if
/// x_i is beyond s_j. Free of cancellation.
pub(crate) fn pressure<T: Number>(nodes: &impl NodeValues<T>, j: usize, to: T, i: usize) -> T {
    let [point, inner, psi] = [
        nodes.get(|nodes| nodes.point_squared[i]),
        nodes.get(|nodes| nodes.leg_squared[j]),
        nodes.get(|nodes| nodes.psi[j]),
    ];
    let (height, lower) = ((to - point).root(), inner - point);
    let rise = (to - inner).quotient(height + lower.root());
    psi * if lower.value() > 0.0 { rise } else { height }
}

/// F_jj of the last shell j, which reaches up to leg² = s² - a²: the pressure at its own point, which moves with the
/// load.
pub(crate) fn pressure_at_edge<T: Number>(nodes: &impl NodeValues<T>, j: usize, to: T) -> T {
    let [flat, inner, psi] = [
        nodes.get(|nodes| nodes.leg_squared[0]),
        nodes.get(|nodes| nodes.leg_squared[j]),
        nodes.get(|nodes| nodes.psi[j]),
    ];
    let [outer_width, half_width] = [to, inner].map(|square| (square - flat).root());
    psi * point_in_shell(half_width, (to - inner).quotient(outer_width + half_width))[1].root()
}

/// F_ij, bounded so that F_ij/ΔS_j does not exceed that of shell j - 1, given F_i,j-1 and the ratios ΔS_j/ΔS_{j-1} of
/// both directions.
pub(crate) fn monotone_pressure<T: Number>(pressure: T, before: T, [x, y]: PerAxis<T>) -> T {
    let bound = before * if x.value() < y.value() { x } else { y };
    if pressure.value() < bound.value() { pressure } else { bound }
}

/// The legs of the nodes over that of the units: the cumulative distribution of the nodes, inverted.
fn legs_of_nodes(element: &Element, units: &Units, reference: f64) -> Row {
    let at = |i: usize| reference * i as f64 / INTERVALS as f64;
    let shape = element.shape();
    let [load, shift, _] = shape.load_and_shifts(reference * units.leg);
    let weight = shape.pressure_weight(reference * units.leg);
    let cumulative = |i: usize| {
        let [own_load, own_shift, _] = shape.load_and_shifts(at(i) * units.leg);
        let distance = 1.0 - (1.0 - GRADING) * (own_shift / shift).sqrt();
        let curved = (own_load / load).sqrt() * shape.pressure_weight(at(i) * units.leg) / weight;
        EDGE_SHARE * distance.max(GRADING).ln() / GRADING.ln() + (1.0 - EDGE_SHARE) * curved
    };
    let (mut legs, mut j, mut before) = (Row::ZERO, FLAT_EDGE + 1, 0.0);
    for i in 1..=INTERVALS {
        let next = cumulative(i);
        while j < SPRINGS {
            let target = (j - FLAT_EDGE) as f64 / (SPRINGS - FLAT_EDGE) as f64;
            if target > next {
                break;
            }
            legs[j] = at(i - 1) + quotient((at(i) - at(i - 1)) * (target - before), next - before);
            j += 1;
        }
        before = next;
    }
    legs
}
