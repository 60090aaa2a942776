//! Nodes, at which the family of sizes is divided into shells, and what does not depend on the present load.
//!
//! A node j is a size s_j of the family, with its normal force N_j and its shift S_j in both directions. Shell j reaches from s_j to s_{j+1},
//! the last one to the present size. Shell 0 is the flat: it carries force, but no pressure. It is empty if there is no flat, so that the nodes are
//! continuous in a at a = 0.
//!
//! The cumulative distribution of the nodes is a sum of two parts. Slip reaches inwards from the edge: nodes graded in √S have the same relative distance to
//! the edge in every shape. And between nodes N(S) is a polygon, whose errors are equal if the nodes are uniform in ∫ √(N'') dS ~ √N ψ:
//!
//! ```text
//! 0.765 ln[1 - 0.972 √(S_j/S_r)]/ln 0.028 + 0.235 √(N_j/N_r) ψ(s_j)/ψ(s_r) = (j - 1)/15,   j = 1 ... 15
//! ```
//!
//! N_r, S_r and s_r are those of the reference size, the largest one of a motion. In one point x_i of each shell the shell j carries the pressure
//!
//! ```text
//! F_ij = ψ_j [√(s_{j+1}² - x_i²) - √(s_j² - x_i²)],
//! ```
//!
//! The force of shell 0 is spread evenly over the sizes up to a, which gives `F_00 = load_unit acosh(a/x_i)/(4 a)` with `load_unit` as in `fill`;
//! the compliance of the flat, K_t(a), takes the place of ΔS_0: that of the contact as slip reaches the flat. F_ij/ΔS_j must not increase with j: then the map from tractions to springs
//! has no negative entry, and gross slip solves Coulomb's law. Rough layers, whose compliance falls with the load, exceed this bound; F is cut at it.
//!
//! All is in units of N, of S across the line and of the leg, √(s² - a²), of the reference size.

use crate::element::Element;
use crate::numerics::dual::Number;
use crate::numerics::guard::{TINY, quotient};
use crate::numerics::lanes::Lanes;

/// Springs, one a shell. The first one is under the flat.
pub(crate) const SPRINGS: usize = 16;

/// A value of each spring, or of each point.
pub(crate) type Row = Lanes<SPRINGS>;
/// Values of both directions, one after the other.
pub(crate) type PerAxis<T> = [T; 2];
pub(crate) type Matrix = [Row; SPRINGS];

/// The values of a function of the direction.
pub(crate) fn by_axis<T>(value: impl Fn(usize) -> T) -> PerAxis<T> {
    [value(0), value(1)]
}

/// The length of a vector.
pub(crate) fn length([x, y]: PerAxis<f64>) -> f64 {
    (x * x + y * y).sqrt()
}

/// The first node under pressure: the edge of the flat.
pub(crate) const FLAT_EDGE: usize = 1;
/// The share of the nodes that is graded towards the edge: more of it makes circles more accurate, less of it motion on a line.
const EDGE_SHARE: f64 = 0.765;
/// The distance from the edge of the last node over that of the first one, in √S.
const GRADING: f64 = 0.028;
/// The position of x_i in its shell: in its inner half F_ij/ΔS_j decreases with j. Values from 0.03 to 0.2 are nearly as good.
/// The rule is used in `fill`, three times, and in `pressure_at_edge`.
const POINT_FRACTION: f64 = 0.05;
/// Number of intervals in the leg on which the cumulative distribution of the nodes is inverted by linear interpolation. The nodes need not be
/// exact, but must depend smoothly on the load.
const INTERVALS: usize = 48;
/// The smallest flat over the leg that has a spring: its points would round to one value.
const SMALLEST_FLAT: f64 = 1e-9;
/// The least reference load, relative to the normal force of the parameters: with a flat, shells of much smaller sizes are so stiff that
/// maps between them lose their digits.
const LEAST_REFERENCE: f64 = 1.0 / 4096.0;

/// Relative step of the central difference of nodes by the reference size. The error is the square of the step times the third derivative,
/// up to 1e5 where nodes are close, and the rounding error over the step.
pub(crate) const DIFFERENCE_STEP: f64 = 1e-6;

// Rows of the tables. Those of S have one for each direction, `SHIFT + axis`.
/// N_j.
pub(crate) const LOAD: usize = 0;
/// S_j.
pub(crate) const SHIFT: usize = 1;
/// leg_j² = s_j² - a².
pub(crate) const LEG_SQUARED: usize = 3;
/// x_i² - a².
pub(crate) const POINT_SQUARED: usize = 4;
/// ψ_j in the middle of shell j.
const PSI: usize = 5;
/// ΔN_j of whole shells, 1 for those under the flat.
pub(crate) const LOAD_STEP: usize = 6;
/// ΔS_j of whole shells, the compliances of those under the flat.
pub(crate) const SHIFT_STEP: usize = 7;
/// F_ij of whole shells, a row for each shell j but the last one.
pub(crate) const PRESSURE: usize = 9;
pub(crate) const ROWS: usize = PRESSURE + SPRINGS - 1;

/// Tables of the nodes.
pub(crate) type Nodes = [[f64; SPRINGS]; ROWS];

/// The units of the springs: N, S across the line and the leg of the reference size.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Units {
    pub load: f64,
    pub shift: f64,
    pub leg: f64,
}

impl Units {
    /// For nodes with a reference load.
    pub fn at_load(element: &Element, load: f64) -> Units {
        let shape = element.shape();
        let leg = shape.at_load(load.max(LEAST_REFERENCE * element.normal_force));
        let [load, shift, _] = shape.load_and_shifts(leg);
        Units { load, shift, leg }
    }
}

/// The first shell that is not empty.
pub(crate) fn first_shell(nodes: &Nodes) -> usize {
    if nodes[LEG_SQUARED][0] < 0.0 { 0 } else { FLAT_EDGE }
}

/// The outermost node whose shift across the line is less than the present one.
pub(crate) fn last_node(nodes: &Nodes, shift: f64) -> usize {
    FLAT_EDGE + nodes[SHIFT].iter().skip(FLAT_EDGE + 1).filter(|node| **node < shift).count()
}

/// Fills the tables of nodes whose reference size is that of the units times a number near 1.
#[inline(never)]
pub(crate) fn fill(nodes: &mut Nodes, element: &Element, units: &Units, reference: f64) {
    *nodes = [[0.0; SPRINGS]; ROWS];
    let shape = element.shape();
    let mut flat = shape.flat / units.leg;
    flat = if flat > SMALLEST_FLAT { flat } else { 0.0 };
    let half_width = |leg: f64| (flat * flat + leg * leg).sqrt();
    let legs = legs_of_nodes(element, units, reference);
    for j in FLAT_EDGE..SPRINGS {
        let [load, x, y] = if j > FLAT_EDGE { shape.load_and_shifts(legs[j] * units.leg) } else { [0.0; 3] };
        (nodes[LOAD][j], nodes[LEG_SQUARED][j]) = (load / units.load, legs[j] * legs[j]);
        (nodes[SHIFT][j], nodes[SHIFT + 1][j]) = (x / units.shift, y / units.shift);
        let to = if j + 1 < SPRINGS { legs[j + 1] } else { reference };
        nodes[POINT_SQUARED][j] = legs[j] * legs[j] + {
            let distance = (to - legs[j]) * (to + legs[j]) / (half_width(to) + half_width(legs[j]));
            POINT_FRACTION * distance * (2.0 * half_width(legs[j]) + POINT_FRACTION * distance)
        };
        nodes[PSI][j] = shape.pressure_weight(units.leg * 0.5 * (legs[j] + to));
    }
    for j in FLAT_EDGE..SPRINGS - 1 {
        nodes[LOAD_STEP][j] = nodes[LOAD][j + 1] - nodes[LOAD][j];
        for axis in 0..2 {
            nodes[SHIFT_STEP + axis][j] = (nodes[SHIFT + axis][j + 1] - nodes[SHIFT + axis][j]).max(TINY);
        }
        for i in FLAT_EDGE..=j {
            nodes[PRESSURE + j][i] = pressure(|row, i| nodes[row][i], j, nodes[LEG_SQUARED][j + 1], i);
        }
    }
    if flat > 0.0 {
        let load_unit = units.load / shape.load_per_square() / (units.leg * units.leg);
        (nodes[LEG_SQUARED][0], nodes[POINT_SQUARED][0]) =
            (-flat * flat, (POINT_FRACTION - 1.0) * (POINT_FRACTION + 1.0) * flat * flat);
        nodes[LOAD_STEP][0] = 1.0;
        for axis in 0..2 {
            nodes[SHIFT_STEP + axis][0] = units.load / units.shift * shape.compliance_of_flat(axis);
        }
        nodes[PRESSURE][0] = 0.25 * load_unit * (1.0 / POINT_FRACTION).acosh() / flat;
        for j in FLAT_EDGE..SPRINGS - 1 {
            nodes[PRESSURE + j][0] = pressure(|row, i| nodes[row][i], j, nodes[LEG_SQUARED][j + 1], 0);
        }
    }
    let first = first_shell(nodes);
    for j in first + 1..SPRINGS - 1 {
        let steps = by_axis(|axis| nodes[SHIFT_STEP + axis][j] / nodes[SHIFT_STEP + axis][j - 1]);
        for i in first..j {
            nodes[PRESSURE + j][i] = monotone_pressure(nodes[PRESSURE + j][i], nodes[PRESSURE + j - 1][i], steps);
        }
    }
}

/// F_ij of shell j up to a size: `ψ_j [√(s² - x_i²) - √(s_j² - x_i²)]`, from leg² = s² - a² and x_i² - a². The second root is 0 if x_i is
/// beyond s_j. Free of cancellation. Values of the nodes are given by row and place.
pub(crate) fn pressure<T: Number>(node: impl Fn(usize, usize) -> T, j: usize, to: T, i: usize) -> T {
    let (upper, lower) = (to - node(POINT_SQUARED, i), node(LEG_SQUARED, j) - node(POINT_SQUARED, i));
    let height = upper.root();
    let rise = (to - node(LEG_SQUARED, j)).quotient(height + lower.root());
    node(PSI, j) * if lower.value() > 0.0 { rise } else { height }
}

/// F at the own point of the last shell, which lies at the same part of it as in a whole shell.
pub(crate) fn pressure_at_edge<T: Number>(node: impl Fn(usize, usize) -> T, j: usize, to: T) -> T {
    let flat = node(LEG_SQUARED, 0);
    let [outer, inner] = [to, node(LEG_SQUARED, j)].map(|square| (square - flat).root());
    let distance = (to - node(LEG_SQUARED, j)).quotient(outer + inner);
    let [inner_part, outer_part] = [1.0 - POINT_FRACTION, 1.0 + POINT_FRACTION].map(T::constant);
    node(PSI, j) * (inner_part * distance * (inner + inner + outer_part * distance)).root()
}

/// F_ij cut so that F_ij/ΔS_j does not exceed that of the shell before, given the ratios of ΔS of both.
pub(crate) fn monotone_pressure<T: Number>(pressure: T, before: T, [x, y]: PerAxis<T>) -> T {
    let bound = before * if x.value() < y.value() { x } else { y };
    if pressure.value() < bound.value() { pressure } else { bound }
}

/// The legs of the nodes, from their cumulative distribution.
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
