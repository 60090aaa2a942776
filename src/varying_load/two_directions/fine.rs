//! The difference of two banks of springs, a fine one and that of the law, each spring with its own limit: added to the law, it makes
//! motion on a line as exact as the fine bank.

use super::edge::{Edge, Pressed};
use super::slip::product;
use super::springs::{Both, FINE, REFINEMENT, SPRINGS, Springs};
use crate::shape::TINY;

pub(super) type FineRow = [f64; FINE];

/// Stiffnesses of the springs under the present load: their difference from those of the bank of the law.
pub(super) struct FineEdge {
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
        let coarse = (REFINEMENT * edge.last.saturating_sub(springs.under_flat)).min(FINE - 1);
        let mut last = coarse;
        for j in 0..FINE {
            if j > coarse && springs.fine_shift[0][j] < now.shift[0] * (1.0 - 1e-9) {
                last = j;
            }
        }
        let last = last.min(FINE - 1);
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
pub(super) fn step(
    springs: &Springs,
    fine: &FineEdge,
    displacement: &mut Both<FineRow>,
    before: &Pressed,
    now: &Pressed,
    motion: &Both<f64>,
    constant_load: bool,
) -> (Both<f64>, f64) {
    let (mut force, mut energy) = ([0.0; 2], 0.0);
    let share = Share::new(before, now);
    for j in 0..FINE {
        if j > fine.last {
            break;
        }
        let limit = [now.shift[0] - springs.fine_shift[0][j], now.shift[1] - springs.fine_shift[1][j]];
        let old = [displacement[0][j], displacement[1][j]];
        let trial = [old[0] + motion[0] * share.of(0, limit[0]), old[1] + motion[1] * share.of(1, limit[1])];
        let (x, y) = (trial[0] * limit[1], trial[1] * limit[0]);
        let (over, bound) = (x * x + y * y, limit[0] * limit[1]);
        let mut new = trial;
        if over > bound * bound {
            let scale = bound / over.sqrt();
            new = [trial[0] * scale, trial[1] * scale];
            let mean = if constant_load { new } else { [0.5 * (old[0] + new[0]), 0.5 * (old[1] + new[1])] };
            let stiffness = [fine.stiffness[0][j], fine.stiffness[1][j]];
            energy += product(&stiffness, &[mean[0] * (trial[0] - new[0]), mean[1] * (trial[1] - new[1])]);
        }
        (displacement[0][j], displacement[1][j]) = (new[0], new[1]);
        force[0] += fine.stiffness[0][j] * new[0];
        force[1] += fine.stiffness[1][j] * new[1];
    }
    for row in displacement {
        for (j, value) in row.iter_mut().enumerate() {
            *value = if j <= fine.last { *value } else { 0.0 };
        }
    }
    (force, energy)
}

/// The part of a motion that a spring follows: all, unless the load rises to its size within the step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Share {
    /// 1/ΔS; 0 unless the load rises.
    pub per_rise: Both<f64>,
}

impl Share {
    #[inline(always)]
    pub fn new(before: &Pressed, now: &Pressed) -> Share {
        let per = |k: usize| {
            let rise = now.shift[k] - before.shift[k];
            if rise > 0.0 { 1.0 / rise.max(TINY) } else { 0.0 }
        };
        Share { per_rise: [per(0), per(1)] }
    }

    /// For the distance S_b - S_j.
    #[inline(always)]
    pub fn of(&self, k: usize, limit: f64) -> f64 {
        let share = limit * self.per_rise[k];
        if self.per_rise[k] > 0.0 && share < 1.0 { share } else { 1.0 }
    }
}
