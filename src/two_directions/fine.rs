//! The difference of two banks of springs, a fine one and that of the law, each spring with its own limit: added to the law, it makes
//! motion on a line as exact as the fine bank.

use super::edge::{Edge, Share};
use crate::element::springs::{Both, FINE, Pressed, SPRINGS, Springs};
use crate::shape::TINY;

pub(crate) type FineRow = [f64; FINE];

/// Stiffnesses of the springs under the present load: their difference from those of the bank of the law.
pub(crate) struct FineEdge {
    pub last: usize,
    /// The node of the law whose spring has changed too.
    pub coarse: usize,
    pub stiffness: Both<FineRow>,
    pub secant: Both<f64>,
    pub step: Both<f64>,
}

impl FineEdge {
    pub const NONE: FineEdge =
        FineEdge { last: 0, coarse: 0, stiffness: [[0.0; FINE]; 2], secant: [0.0; 2], step: [1.0; 2] };

    #[inline(always)]
    pub fn new(springs: &Springs, now: &Pressed, edge: &Edge) -> FineEdge {
        let (coarse, last) = (springs.fine_node(edge.last), springs.last_fine_shell(edge.last, now.shift[0]));
        let mut fine = FineEdge { last, coarse, stiffness: [[0.0; FINE]; 2], secant: [0.0; 2], step: [0.0; 2] };
        for k in 0..2 {
            fine.step[k] = (now.shift[k] - springs.fine_shift[k][last]).max(TINY);
            fine.secant[k] = (now.load - springs.fine_load[last]) / fine.step[k];
            for j in 0..FINE {
                fine.stiffness[k][j] = if j < last { springs.fine_stiffness[k][j] } else { 0.0 };
            }
            let before = |secant: &[f64], j: usize| if j > 0 { secant[j - 1] } else { 0.0 };
            fine.stiffness[k][last] = fine.secant[k] - before(&springs.fine_secant[k], last);
            // The bank of the law has no springs under the flat: at its first spring begins all stiffness.
            let node = edge.last.min(SPRINGS - 1);
            let coarse_before = if node > springs.under_flat { springs.secant[k][node - 1] } else { 0.0 };
            let own = if coarse == last { fine.stiffness[k][last] } else { springs.fine_own(k, coarse) };
            fine.stiffness[k][coarse] = own - (edge.secant[k] - coarse_before);
        }
        fine
    }
}

/// A step of the bank.
#[inline(always)]
pub(crate) fn step(
    springs: &Springs,
    fine: &FineEdge,
    displacement: &mut Both<FineRow>,
    before: &Pressed,
    now: &Pressed,
    motion: &Both<f64>,
    constant_load: bool,
) -> (Both<f64>, f64) {
    let (mut forces, mut energy) = ([[0.0; 4]; 2], 0.0);
    let share = Share::new(before, now);
    // The fourth powers of large limits overflow.
    let per_shift = 1.0 / now.shift[1];
    let [x, y] = displacement;
    let (blocks_x, blocks_y) = (x.as_chunks_mut::<4>().0, y.as_chunks_mut::<4>().0);
    for (block, (x, y)) in blocks_x.iter_mut().zip(blocks_y).enumerate() {
        let at = |row: &FineRow| row.as_chunks::<4>().0.get(block).copied().unwrap_or([0.0; 4]);
        let shifts = [at(&springs.fine_shift[0]), at(&springs.fine_shift[1])];
        let stiffness = [at(&fine.stiffness[0]), at(&fine.stiffness[1])];
        let (old, mut trial, mut limit) = ([*x, *y], [[0.0; 4]; 2], [[0.0; 4]; 2]);
        let (mut over, mut bound) = ([0.0; 4], [0.0; 4]);
        let mut any = false;
        for lane in 0..4 {
            let inside = 4 * block + lane <= fine.last;
            for k in 0..2 {
                // Beyond the contact nothing moves.
                limit[k][lane] = if inside { now.shift[k] - shifts[k][lane] } else { 1.0 };
                let moved = old[k][lane] + motion[k] * share.of(k, limit[k][lane]);
                trial[k][lane] = if inside { moved } else { 0.0 };
            }
            let lateral = limit[1][lane] * per_shift;
            let (x, y) = (trial[0][lane] * lateral, trial[1][lane] * per_shift * limit[0][lane]);
            over[lane] = x * x + y * y;
            bound[lane] = limit[0][lane] * lateral;
            any |= over[lane] > bound[lane] * bound[lane];
        }
        let mut new = trial;
        if any {
            for lane in 0..4 {
                let square = bound[lane] * bound[lane];
                let scale = bound[lane] / over[lane].max(square).sqrt().max(TINY);
                for k in 0..2 {
                    let value = if over[lane] > square { trial[k][lane] * scale } else { trial[k][lane] };
                    new[k][lane] = value;
                    let mean = if constant_load { value } else { 0.5 * (old[k][lane] + value) };
                    energy += stiffness[k][lane] * mean * (trial[k][lane] - value);
                }
            }
        }
        (*x, *y) = (new[0], new[1]);
        for k in 0..2 {
            for lane in 0..4 {
                forces[k][lane] += stiffness[k][lane] * new[k][lane];
            }
        }
    }
    let force = forces.map(|sums| (sums[0] + sums[1]) + (sums[2] + sums[3]));
    (force, energy)
}
