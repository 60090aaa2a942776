//! Terms of the reversals of the Jacobian under uniform sampling.
//!
//! The force at reversal r on the stack has the derivative `dT_r = k_r (φ_r - φ_q) + dT_q`, with the reversal q before it; the
//! oldest reversal lies on the initial loading curve, `dT_r = k_r φ_r`. Let G_r be the sum of φ over all samples whose force
//! depends on dT_r. The terms of r in the Jacobian, `G_r ⊗ dT_r - (Σ k φ) ⊗ φ_r`, are outer products with φ_r and φ_q. The product
//! with φ_r is added when the reversal is removed from the stack, and the rest is passed to q:
//!
//! ```text
//! Y_r = k_r G_r - Σ k φ,     Y_q -= k_r G_r,     G_q += G_r.
//! ```

use crate::fourier::rows::{OuterProducts, RowStrips, Rows, Strip, StripTerms, add_scaled, row_blocks, with_strips};
use crate::fourier::workspace::Blocks;
use crate::numerics::record::record;
use crate::numerics::slices::{PanicFreeSlice, Zero};

record! {
    /// Consecutive samples on a branch.
    pub(super) struct BranchSamples {
        pub first: u64,
        pub count: u64,
        /// Number of reversals on the stack.
        pub depth: u64,
    }
}

record! {
    /// A reversal on the stack.
    pub(super) struct Entry {
        sample: u64,
        stiffness: f64,
    }
}

/// Tables and memory.
pub(super) struct ReversalTerms<'a> {
    pub rows: Rows<'a>,
    /// The reversals on the stack.
    pub entries: &'a mut [Entry],
    /// The rows G and Y of each reversal.
    pub sums: &'a mut Blocks,
    pub outer: OuterProducts<'a>,
}

impl ReversalTerms<'_> {
    /// Gathers the terms along the branches, with the stiffness at the samples of two periods.
    pub fn gather(&mut self, branches: &[BranchSamples], stiffness: &[f64]) {
        with_strips!(row_blocks(self.rows.harmonics), self.gather_strips(branches, stiffness));
    }

    fn gather_strips<const N: usize>(&mut self, branches: &[BranchSamples], stiffness: &[f64]) {
        let ReversalTerms { rows, entries, sums, outer } = self;
        let sums = sums.blocks_mut::<N>().blocks_mut();
        for strip in 0..outer.strips::<N>() {
            let (rows, terms) = (rows.strips::<N>(strip), outer.terms(strip));
            let mut stack = ReversalStack { rows, entries, sums, depth: 0, terms };
            for &BranchSamples { first, count, depth } in branches {
                let [first, count, depth] = [first, count, depth].map(|number| number as usize);
                stack.pop(depth);
                if depth > stack.depth {
                    let before = first - 1;
                    stack.push(before, stiffness.or_zero(before));
                }
                stack.add(first, count, stiffness);
            }
            stack.pop(0);
        }
    }
}

/// The stack of reversals with their sums, in strips of N blocks.
struct ReversalStack<'s, const N: usize> {
    rows: RowStrips<'s, N>,
    entries: &'s mut [Entry],
    sums: &'s mut [[Strip<N>; 2]],
    depth: usize,
    terms: StripTerms<'s, N, 1>,
}

impl<const N: usize> ReversalStack<'_, N> {
    /// The index in the first period of a sample of two periods.
    fn in_period(&self, sample: usize) -> usize {
        sample.checked_sub(self.rows.phi.len()).unwrap_or(sample)
    }

    fn push(&mut self, sample: usize, stiffness: f64) {
        let sample = self.in_period(sample);
        if self.entries.set(self.depth, Entry { sample: sample as u64, stiffness }) {
            self.sums.set(self.depth, Zero::zero());
            self.depth += 1;
        }
    }

    /// Removes reversals down to a depth.
    fn pop(&mut self, depth: usize) {
        while self.depth > depth {
            self.depth -= 1;
            let top = self.depth;
            let (Entry { sample, stiffness }, [covered, mut y]) = (self.entries.or_zero(top), self.sums.or_zero(top));
            add_scaled(&mut y, stiffness, &covered);
            if let Some(phi) = self.rows.phi.get(sample as usize) {
                self.terms.push([y], phi);
            }
            if let Some([covered_before, y_before]) = top.checked_sub(1).and_then(|index| self.sums.get_mut(index)) {
                add_scaled(covered_before, 1.0, &covered);
                add_scaled(y_before, -stiffness, &covered);
            }
        }
    }

    /// Adds the samples of a branch to the sums of the reversal that it leaves.
    fn add(&mut self, first: usize, count: usize, stiffness: &[f64]) {
        let (from, to) = (self.in_period(first), self.in_period(first + count));
        let Some([covered, y]) = self.depth.checked_sub(1).and_then(|top| self.sums.get_mut(top)) else { return };
        add_scaled(covered, 1.0, &self.rows.sum_between(from, to, count));
        let (rows, weights) = (self.rows.phi, stiffness.part(first..first + count));
        let (before_end, after_end) =
            weights.split_at_checked(rows.len().saturating_sub(from)).unwrap_or((weights, &[]));
        for (rows, weights) in [(rows.part(from..), before_end), (rows, after_end)] {
            rows.iter().zip(weights).for_each(|(row, weight)| add_scaled(y, -weight, row));
        }
    }
}
