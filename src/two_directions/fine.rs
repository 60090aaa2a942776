//! The fine correction: the difference of two banks of springs, a fine one and that of the nodes of the law, each spring with its own
//! limit. Added to the law, it makes motion on a line as exact as the fine bank.

use super::edge::Edge;
use super::energy;
use super::springs::{Both, Fine, Increment, PARTS, Row, Springs, total};

/// Limits of a part of the shells; 1 outside.
#[inline(always)]
pub(crate) fn limits<const N: usize>(springs: &Springs, edge: &Edge<N>, shift: &Both<f64>, r: usize) -> Both<Row<N>> {
    let (first, stop) = (springs.under_flat, if r <= edge.part { edge.last + 1 } else { edge.last });
    let mut limits = [[1.0; N]; 2];
    for k in 0..2 {
        for j in 0..N {
            let limit = shift[k] - springs.fine_shift[k][r][j];
            limits[k][j] = if j >= first && j < stop { limit } else { 1.0 };
        }
    }
    limits
}

/// Stiffnesses of a part of the shells under the present load, less those of the springs of the law; 0 outside.
#[inline(always)]
pub(crate) fn stiffnesses<const N: usize>(springs: &Springs, edge: &Edge<N>, k: usize, r: usize) -> Row<N> {
    let mut row = [0.0; N];
    for j in 0..N {
        // Products, not choices: of a part of a vector these would be branches.
        let (inner, at_edge) = (if j < edge.last { 1.0 } else { 0.0 }, if j == edge.last { 1.0 } else { 0.0 });
        row[j] = inner * springs.fine_stiffness[k][r][j] + at_edge * edge.fine_stiffness[k][r];
    }
    row
}

/// Factors by which springs return to their limits, below 1 by more than roundings, which the mode of rounding may leave.
pub(crate) const SLIPS: f64 = 1.0 - 4.0 * f64::EPSILON;

/// A step of the correction: force, and dissipated energy if requested.
#[inline(always)]
pub(crate) fn step<const N: usize>(
    springs: &Springs,
    edge: &Edge<N>,
    v: &mut Both<Fine<N>>,
    motion: &Increment,
    energy: bool,
    scales: &mut Fine<N>,
) -> (Both<f64>, f64) {
    let (mut sums, mut loss) = ([[0.0; N]; 2], 0.0);
    let last = edge.last;
    let [v_x, v_y] = v;
    for r in 0..PARTS {
        let (old_x, old_y) = (v_x[r], v_y[r]);
        let (first, stop) = (springs.under_flat, if r <= edge.part { last + 1 } else { last });
        let limit = limits(springs, edge, &motion.now.shift, r);
        let (mut trial_x, mut trial_y, mut scale) = ([0.0; N], [0.0; N], [1.0; N]);
        for j in 0..N {
            let inside = j >= first && j < stop;
            let share = motion.share(limit[0][j], limit[1][j]);
            let (x, y) = (old_x[j] + motion.by[0] * share[0], old_y[j] + motion.by[1] * share[1]);
            (trial_x[j], trial_y[j]) = (if inside { x } else { 0.0 }, if inside { y } else { 0.0 });
            // A quotient whose divisor is positive in any case: the compiler may evaluate it in all lanes.
            let (x, y, area) = (trial_x[j] * limit[1][j], trial_y[j] * limit[0][j], limit[0][j] * limit[1][j]);
            let (square, bound) = (x * x + y * y, area * area);
            scale[j] = area / (if square > bound { square } else { bound }).sqrt();
        }
        let (mut x, mut y) = ([0.0; N], [0.0; N]);
        for j in 0..N {
            (x[j], y[j]) = (trial_x[j] * scale[j], trial_y[j] * scale[j]);
        }
        let stiffness = [stiffnesses(springs, edge, 0, r), stiffnesses(springs, edge, 1, r)];
        if energy {
            let mut losses = [0.0; N];
            for j in 0..N {
                let before = motion.before.shift[0] - springs.fine_shift[0][r][j];
                let before = if before > 0.0 { before } else { 0.0 };
                let places = [[old_x[j], old_y[j]], [trial_x[j], trial_y[j]], [x[j], y[j]]];
                let w = [stiffness[0][j], stiffness[1][j]];
                let of_spring = energy::slipped(w, places, [limit[0][j], limit[1][j]], before, 1.0);
                losses[j] = if scale[j] < SLIPS { of_spring } else { 0.0 };
            }
            loss += total(&losses);
        }
        for j in 0..N {
            sums[0][j] += stiffness[0][j] * x[j];
            sums[1][j] += stiffness[1][j] * y[j];
        }
        (v_x[r], v_y[r], scales[r]) = (x, y, scale);
    }
    ([total(&sums[0]), total(&sums[1])], loss)
}
