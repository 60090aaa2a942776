//! Nodes, at which the family of sizes is divided into shells, and what does not depend on the present load.
//!
//! A node j is a size s_j of the family, with its normal force N_j and its shift S_j in both directions. Shell j reaches from s_j to s_{j+1},
//! the last one to the present size. Shells 0 and 1 are under the flat: they carry force, but no pressure. They are empty if there is no flat, so that
//! the nodes are continuous in a at a = 0.
//!
//! The density of the nodes is a sum of two parts. Slip reaches inwards from the edge: nodes graded in √S have the same relative distance to
//! the edge in every shape. And between nodes N(S) is a polygon, whose errors are equal if the nodes are uniform in ∫ √(N'') dS ~ √N ψ:
//!
//! ```text
//! 3/4 ln[1 - 0.98 √(S_j/S_r)]/ln 0.02 + 1/4 √(N_j/N_r) ψ(s_j)/ψ(s_r) = (j - 2)/18,   j = 2 ... 19
//! ```
//!
//! N_r, S_r and s_r are those of the reference size, the largest one of a motion. In one point x_i of each shell the shell j carries the pressure
//!
//! ```text
//! F_ij = ψ_j [√(s_{j+1}² - x_i²) - √(s_j² - x_i²)],
//! ```
//!
//! those under the flat, whose force is spread evenly over them, `[acosh(s_{j+1}/x_i) - acosh(s_j/x_i)] g/(4Δs_j)`, with their compliances in
//! place of ΔS. F_ij/ΔS_j must not increase with j: then the map from tractions to springs has no negative entry, and gross slip solves
//! Coulomb's law. Rough layers, whose compliance falls with the load, exceed this bound; F is cut at it.
//!
//! All is in units of N, of S across the line and of w of the reference size.

use crate::element::Element;
use crate::numerics::guard::{TINY, quotient, root};
use crate::numerics::lanes::Lanes;
use core::f64::consts::PI;

/// Springs, one a shell. The first two are under the flat.
pub(crate) const N: usize = 20;

/// A value of each spring, or of each point.
pub(crate) type Row = Lanes<N>;
/// Values of both directions, one after the other.
pub(crate) type Both<T> = [T; 2];
pub(crate) type Matrix = [Row; N];

/// The values of a function of the direction.
pub(crate) fn both<T>(value: impl Fn(usize) -> T) -> Both<T> {
    [value(0), value(1)]
}

/// The length of a vector.
pub(crate) fn length([x, y]: Both<f64>) -> f64 {
    (x * x + y * y).sqrt()
}

/// The first node under pressure: the edge of the flat.
pub(crate) const FLAT_EDGE: usize = 2;
/// The share of the nodes that is graded towards the edge: more of it makes circles more accurate, less of it motion on a line.
const EDGE_SHARE: f64 = 0.75;
/// The distance from the edge of the last node over that of the first one, in √S.
const GRADING: f64 = 0.02;
/// The position of x_i in its shell: in its inner half F_ij/ΔS_j decreases with j. Values from 0.02 to 0.2 are as good.
const POINT: f64 = 0.1;
/// Intervals in w in which the density of nodes is integrated: what follows from it need not be exact, but smooth.
const INTERVALS: usize = 48;
/// The smallest flat over w that has a spring: its points would round to one value.
const SMALLEST_FLAT: f64 = 1e-9;
/// The least reference load, relative to the normal force of the parameters: with a flat, shells of much smaller sizes are so stiff that
/// maps between them lose their digits.
const LEAST_REFERENCE: f64 = 1.0 / 4096.0;

/// Relative distance of the reference sizes by whose nodes these are differentiated: the error is the square of it times the third derivative,
/// up to 1e5 where nodes are close, and a rounding error over it.
pub(crate) const NEIGHBOUR: f64 = 1e-6;

/// Rows: N_j; S_j of both directions; w_j² = s_j² - a²; x_i² - a²; ψ_j.
pub(crate) const LOAD: usize = 0;
pub(crate) const SHIFT: usize = 1;
pub(crate) const SQUARE: usize = 3;
pub(crate) const POINTS: usize = 4;
const WEIGHT: usize = 5;
/// Rows: ΔN_j and ΔS_j of both directions of whole shells, 1 and the compliances of the shells under the flat; F_ij, a row for each shell but
/// the last one.
pub(crate) const LOAD_STEP: usize = 6;
pub(crate) const SHIFT_STEP: usize = 7;
pub(crate) const PRESSURE: usize = 9;
pub(crate) const ROWS: usize = PRESSURE + N - 1;

/// Tables of the nodes.
pub(crate) type Nodes = [[f64; N]; ROWS];

/// The units of the springs: N, S across the line and w of the reference size.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Units {
    pub load: f64,
    pub shift: f64,
    pub size: f64,
}

impl Units {
    /// For nodes with a reference load.
    pub fn at_load(element: &Element, load: f64) -> Units {
        let shape = element.shape();
        let size = shape.at_load(load.max(LEAST_REFERENCE * element.normal_force));
        let [load, shift, _] = shape.load_and_shifts(size);
        Units { load, shift, size }
    }
}

/// The first shell that is not empty.
pub(crate) fn first_shell(nodes: &Nodes) -> usize {
    if nodes[SQUARE][0] < 0.0 { 0 } else { FLAT_EDGE }
}

/// The outermost node whose shift across the line is less than the present one.
pub(crate) fn last_node(nodes: &Nodes, shift: f64) -> usize {
    FLAT_EDGE + nodes[SHIFT].iter().skip(FLAT_EDGE + 1).filter(|node| **node < shift).count()
}

/// Fills the tables of nodes whose reference size is that of the units times a number near 1.
#[inline(never)]
pub(crate) fn fill(nodes: &mut Nodes, element: &Element, units: &Units, reference: f64) {
    *nodes = [[0.0; N]; ROWS];
    let shape = element.shape();
    let mut flat = shape.flat / units.size;
    flat = if flat > SMALLEST_FLAT { flat } else { 0.0 };
    let half_width = |w: f64| (flat * flat + w * w).sqrt();
    let w = places(element, units, reference);
    for j in FLAT_EDGE..N {
        let [load, x, y] = if j > FLAT_EDGE { shape.load_and_shifts(w[j] * units.size) } else { [0.0; 3] };
        (nodes[LOAD][j], nodes[SQUARE][j]) = (load / units.load, w[j] * w[j]);
        (nodes[SHIFT][j], nodes[SHIFT + 1][j]) = (x / units.shift, y / units.shift);
        let to = if j + 1 < N { w[j + 1] } else { reference };
        nodes[POINTS][j] = w[j] * w[j] + {
            let distance = (to - w[j]) * (to + w[j]) / (half_width(to) + half_width(w[j]));
            POINT * distance * (2.0 * half_width(w[j]) + POINT * distance)
        };
        nodes[WEIGHT][j] = shape.pressure_weight(units.size * 0.5 * (w[j] + to));
    }
    for j in FLAT_EDGE..N - 1 {
        nodes[LOAD_STEP][j] = nodes[LOAD][j + 1] - nodes[LOAD][j];
        for k in 0..2 {
            nodes[SHIFT_STEP + k][j] = (nodes[SHIFT + k][j + 1] - nodes[SHIFT + k][j]).max(TINY);
        }
        for i in FLAT_EDGE..=j {
            nodes[PRESSURE + j][i] = pressure(nodes, j, nodes[SQUARE][j + 1], i);
        }
    }
    if flat > 0.0 {
        let square = units.load / shape.load_per_square() / (units.size * units.size);
        let ring = |j: usize| if j == FLAT_EDGE { flat } else { flat * (0.5 * PI * j as f64 / FLAT_EDGE as f64).sin() };
        for j in 0..FLAT_EDGE {
            let (from, to) = (ring(j), ring(j + 1));
            let point = |i: usize| ring(i) + POINT * (ring(i + 1) - ring(i));
            (nodes[SQUARE][j], nodes[POINTS][j]) =
                ((from - flat) * (from + flat), (point(j) - flat) * (point(j) + flat));
            nodes[LOAD_STEP][j] = 1.0;
            for k in 0..2 {
                let compliance = shape.compliance_under_flat(k, 0.5 * units.size * (from + to));
                nodes[SHIFT_STEP + k][j] = units.load / units.shift * compliance;
            }
            for i in 0..=j {
                let acosh = |s: f64| {
                    let ratio = (s / point(i)).max(1.0);
                    (ratio + ((ratio - 1.0) * (ratio + 1.0)).sqrt()).ln()
                };
                nodes[PRESSURE + j][i] = 0.25 * square * (acosh(to) - acosh(from)) / (to - from);
            }
        }
        for j in FLAT_EDGE..N - 1 {
            for i in 0..FLAT_EDGE {
                nodes[PRESSURE + j][i] = pressure(nodes, j, nodes[SQUARE][j + 1], i);
            }
        }
    }
    let first = first_shell(nodes);
    for j in first + 1..N - 1 {
        let steps = both(|k| nodes[SHIFT_STEP + k][j] / nodes[SHIFT_STEP + k][j - 1]);
        for i in first..j {
            nodes[PRESSURE + j][i] = bounded(nodes[PRESSURE + j][i], nodes[PRESSURE + j - 1][i], steps);
        }
    }
}

/// F_ij of shell j up to a size with w²: `ψ_j [√(w² - x²) - √(w_j² - x²)]`, the second root 0 if x is beyond, free of cancellation.
pub(crate) fn pressure(nodes: &Nodes, j: usize, to: f64, i: usize) -> f64 {
    let (upper, lower) = (to - nodes[POINTS][i], nodes[SQUARE][j] - nodes[POINTS][i]);
    let (height, inner) = (root(upper), root(lower));
    let sum = height + inner;
    let rise = quotient(to - nodes[SQUARE][j], sum);
    nodes[WEIGHT][j] * if lower > 0.0 { rise } else { height }
}

/// Its derivative by a parameter, from those of w² and of the nodes.
pub(crate) fn pressure_slope(nodes: &Nodes, slopes: Option<&Nodes>, j: usize, [to, by_to]: [f64; 2], i: usize) -> f64 {
    let slope = |row: usize, i: usize| slopes.map_or(0.0, |slopes| slopes[row][i]);
    let (upper, lower) = (to - nodes[POINTS][i], nodes[SQUARE][j] - nodes[POINTS][i]);
    let [by_upper, by_lower] = [by_to, slope(SQUARE, j)].map(|slope_of| slope_of - slope(POINTS, i));
    let inner = if lower > 0.0 { by_lower / lower.max(TINY).sqrt() } else { 0.0 };
    let own = 0.5 * nodes[WEIGHT][j] * (by_upper / upper.max(TINY).sqrt() - inner);
    own + quotient(slope(WEIGHT, j), nodes[WEIGHT][j]) * pressure(nodes, j, to, i)
}

/// F at the own point of the last shell, which lies at the same part of it as in a whole shell.
pub(crate) fn pressure_at_edge(nodes: &Nodes, j: usize, to: f64) -> f64 {
    let flat = -nodes[SQUARE][0];
    let [outer, inner] = [to, nodes[SQUARE][j]].map(|square| root(square + flat));
    let sum = outer + inner;
    let distance = quotient(to - nodes[SQUARE][j], sum);
    nodes[WEIGHT][j] * root((1.0 - POINT) * distance * (2.0 * inner + (1.0 + POINT) * distance))
}

/// Its derivative by a parameter, from those of w² and of the nodes.
pub(crate) fn pressure_at_edge_slope(nodes: &Nodes, slopes: Option<&Nodes>, j: usize, [to, by_to]: [f64; 2]) -> f64 {
    let slope = |row: usize, i: usize| slopes.map_or(0.0, |slopes| slopes[row][i]);
    let (flat, at) = (-nodes[SQUARE][0], pressure_at_edge(nodes, j, to));
    let [outer, inner] = [to, nodes[SQUARE][j]].map(|square| root(square + flat));
    let sum = outer + inner;
    let distance = quotient(to - nodes[SQUARE][j], sum);
    let [by_outer, by_inner] = [(by_to, outer), (slope(SQUARE, j), inner)].map(|(by, s)| quotient(0.5 * by, s));
    let by_distance = by_outer - if inner > 0.0 { by_inner } else { 0.0 };
    let weight = nodes[WEIGHT][j].max(TINY);
    let by_square = (1.0 - POINT)
        * (by_distance * (2.0 * inner + 2.0 * (1.0 + POINT) * distance)
            + 2.0 * distance * if inner > 0.0 { by_inner } else { 0.0 });
    quotient(0.5 * weight * weight * by_square, at) + slope(WEIGHT, j) / weight * at
}

/// F_ij cut so that F_ij/ΔS_j does not exceed that of the shell before, given the ratios of ΔS of both.
pub(crate) fn bounded(pressure: f64, before: f64, steps: Both<f64>) -> f64 {
    let bound = before * if steps[0] < steps[1] { steps[0] } else { steps[1] };
    if pressure < bound { pressure } else { bound }
}

/// w of the nodes, from their density.
fn places(element: &Element, units: &Units, reference: f64) -> Row {
    let at = |i: usize| reference * i as f64 / INTERVALS as f64;
    let shape = element.shape();
    let [load, shift, _] = shape.load_and_shifts(reference * units.size);
    let weight = shape.pressure_weight(reference * units.size);
    let density = |i: usize| {
        let [own_load, own_shift, _] = shape.load_and_shifts(at(i) * units.size);
        let distance = 1.0 - (1.0 - GRADING) * (own_shift / shift).sqrt();
        let curved = (own_load / load).sqrt() * shape.pressure_weight(at(i) * units.size) / weight;
        EDGE_SHARE * distance.max(GRADING).ln() / GRADING.ln() + (1.0 - EDGE_SHARE) * curved
    };
    let (mut w, mut j, mut before) = (Row::ZERO, FLAT_EDGE + 1, 0.0);
    for i in 1..=INTERVALS {
        let next = density(i);
        while j < N {
            let target = (j - FLAT_EDGE) as f64 / (N - FLAT_EDGE) as f64;
            if target > next {
                break;
            }
            w[j] = at(i - 1) + quotient((at(i) - at(i - 1)) * (target - before), next - before);
            j += 1;
        }
        before = next;
    }
    w
}
